!> The Method of First Violation (dissertation section 2.3) with event stepping.
!>
!> With all statuses fixed everything is linear in the load. One solve gives the state and its rates per unit of load;
!> the load advances exactly to the first inequality that would break, that node changes its status, and so on. Every
!> state on the way, not only at the events, satisfies every equality and inequality.
!>
!> At one load several changes can follow each other (a corner of the load path, a node that has just changed): they are
!> increments of zero length in the same loop. All violations of one moment change together, so that what is symmetric
!> stays symmetric. The status sets tried at one load are remembered; a repeated one means a cycle: then only the fastest
!> violation changes at a time, and when that repeats too there is no admissible continuation (Klarbring 1990).
module mfv_first_violation
   use mfv_certificate, only: certificate_type, new_certificate
   use mfv_contact_fields, only: contact_fields_type
   use mfv_contact_model, only: along_rotation, along_shift, contact_model_type
   use mfv_contact_state, only: contact_state_type, new_contact_state
   use mfv_contact_system
   use mfv_error, only: error_type, set_error
   use mfv_event_search, only: find_violations, status_after, violations_type
   use mfv_history, only: history_type
   use mfv_kinds, only: wp
   use mfv_node_status
   use mfv_observer, only: observer_type
   use mfv_scene, only: control_displacement, control_force
   use mfv_status
   use mfv_strings, only: to_text
   implicit none
   private
   public :: first_violation_type, new_first_violation, segment_type

   !> A straight part of the load history: the controlled loads with their targets, and whether friction acts.
   type :: segment_type
      type(load_type) :: normal, tangential
      type(load_type) :: rotational = load_type(control_displacement)
      logical :: friction = .true.
      !> Number of this segment, how many there are, and the step that it belongs to: for records and progress.
      integer :: number = 1, segments = 1, step = 1
   end type segment_type

   !> A contact under a load history: the model, its state now, and what is known of the way there.
   type :: first_violation_type
      type(contact_model_type) :: model
      class(contact_system_type), allocatable :: system
      type(contact_state_type) :: state
      type(history_type) :: history
      type(certificate_type) :: certificate
      !> Whether every event is recorded, or only what the caller records.
      logical :: record_events = .true.
      !> Events so far: loads at which statuses changed.
      integer :: events = 0
   contains
      procedure :: lead
      procedure :: record
      procedure, private :: start_segment
      procedure, private :: begin_tangential
      procedure :: begin_rotation
      procedure, private :: settle_loads
      procedure, private :: advance
      procedure, private :: change_statuses
      procedure, private :: close_nearest
      procedure, private :: widen
      procedure, private :: where_it_is
   end type first_violation_type

   !> What is known at one load while statuses settle.
   type :: moment_type
      !> Status sets tried here, shape (nodes, tried).
      integer, allocatable :: tried(:, :)
      !> Rates below this part of the largest are round-off.
      real(wp) :: round_off = 1.0e-12_wp
      !> One change at a time, after a cycle.
      logical :: one_at_a_time = .false.
      !> First change at this load: event and node; and how many nodes changed with it.
      integer :: event = event_none, node = 0, count = 0
   end type moment_type

   !> Steps below this part of the segment are none; steps this much longer than the first, in parts of it, are equal.
   real(wp), parameter :: no_step = 1.0e-13_wp, tie = 1.0e-10_wp
   !> So many steps in a row below the tie are no progress.
   integer, parameter :: most_tiny_steps = 1000
   !> The rates' round-off where a cycle of statuses suggests that some of them are noise.
   real(wp), parameter :: larger_round_off = 1.0e-9_wp
   !> A certificate beyond this is no result.
   real(wp), parameter :: failed_certificate = 1.0e-6_wp
   !> A jump of the tractions beyond this, in parts of the largest, is no continuation.
   real(wp), parameter :: largest_jump = 1.0e-6_wp

contains

   !> An unloaded contact, the indenter just touching. `system`: the linear solver to use.
   function new_first_violation(model, system, record_events) result(self)
      type(contact_model_type), intent(in) :: model
      class(contact_system_type), intent(in) :: system
      logical, intent(in) :: record_events
      type(first_violation_type) :: self
      real(wp), dimension(model%nodes()) :: normal, tangential

      self%model = model
      allocate (self%system, source=system)
      self%state = new_contact_state(model%nodes())
      self%state%fields%approach = model%nearest_approach(model%initial_gap)
      call model%relative_displacements(self%state%fields, normal, tangential)
      self%state%fields%normal = normal
      self%state%fields%tangential = tangential
      self%certificate = new_certificate(model)
      self%record_events = record_events
   end function new_first_violation

   !> Lead the loads along one segment. `observer` is told of every increment.
   !> Errors, each leaving the last admissible state in place: MFV_GROSS_SLIDING, MFV_NO_CONTINUATION,
   !> MFV_MESH_EXCEEDED, MFV_INADMISSIBLE_STEP, MFV_INTERRUPTED.
   subroutine lead(self, segment, observer, error)
      class(first_violation_type), intent(inout) :: self
      type(segment_type), intent(in) :: segment
      class(observer_type), intent(inout), optional :: observer
      type(error_type), allocatable, intent(out) :: error
      type(moment_type) :: moment
      type(constraints_type) :: constraints
      type(response_type) :: response
      type(violations_type) :: violations
      real(wp) :: done, step
      integer :: creeping
      logical :: singular, settled, stop_wanted, last

      call self%start_segment(segment, error)
      if (allocated(error)) return
      done = 0.0_wp
      creeping = 0
      do
         call self%settle_loads(segment, done, moment, constraints, settled, error)
         if (allocated(error)) return
         if (.not. settled) cycle
         call self%system%solve(self%model, constraints, response, singular)
         if (singular) then
            call no_continuation(self, 'the linear system is singular', error)
            return
         end if
         violations = find_violations(self%model, self%state%status, self%state%fields, response%rate, moment%round_off)
         step = min(minval(violations%step), 2.0_wp)
         if (step > no_step) then
            call keep_settled(self, segment, moment)
            last = step*(1.0_wp + tie) + no_step >= 1.0_wp - done
            if (last) step = 1.0_wp - done
            call self%advance(response, step, error)
            if (allocated(error)) return
            done = done + step
            if (present(observer)) then
               call observer%notify(self%state, segment%number, segment%segments, done, stop_wanted)
               if (stop_wanted) call set_error(error, MFV_INTERRUPTED, 'stopped on request '//self%where_it_is())
               if (allocated(error)) return
            end if
            if (last) return
            moment = moment_type()
            creeping = merge(creeping + 1, 0, step < tie)
            if (creeping > most_tiny_steps) then
               call no_continuation(self, 'the load does not advance', error)
               return
            end if
         end if
         call self%change_statuses(segment, violations, moment, error)
         if (allocated(error)) return
      end do
   end subroutine lead

   !> Turn friction on or off in the nodes that touch; with the first friction the tangential problem begins to be
   !> modelled. Error MFV_INADMISSIBLE_STEP: friction off where there is shear.
   subroutine start_segment(self, segment, error)
      class(first_violation_type), intent(inout) :: self
      type(segment_type), intent(in) :: segment
      type(error_type), allocatable, intent(out) :: error
      integer :: status(size(self%state%status))

      if (segment%friction .and. self%model%scene%friction%acts()) then
         if (.not. self%model%tangential .or. any(self%state%status == node_frictionless)) call self%begin_tangential()
         status = node_stick
         call self%state%set_status(self%state%status == node_frictionless, status)
         return
      end if
      if (any(abs(self%state%fields%shear) > 0.0_wp)) then
         call set_error(error, MFV_INADMISSIBLE_STEP, 'friction cannot be switched off while there is shear traction '// &
                        self%where_it_is())
         return
      end if
      status = node_frictionless
      call self%state%set_status(in_contact(self%state%status), status)
   end subroutine start_segment

   !> Friction comes on: model the tangential problem if that has not been done yet, and begin it from the present
   !> pressures.
   subroutine begin_tangential(self)
      class(first_violation_type), intent(inout) :: self
      real(wp) :: normal(self%model%nodes())

      if (.not. self%model%tangential) call self%model%add_tangential()
      call self%certificate%claim(self%model)
      call self%model%relative_displacements(self%state%fields, normal, self%state%fields%tangential)
   end subroutine begin_tangential

   !> Model the rotation from now on, from the moment that the tractions have.
   subroutine begin_rotation(self)
      class(first_violation_type), intent(inout) :: self

      if (self%model%rotational) return
      call self%model%add_rotation()
      call self%certificate%claim(self%model)
      self%state%fields%moment = self%model%resultant(along_rotation, self%state%fields%pressure, self%state%fields%shear)
   end subroutine begin_rotation

   !> The constraints at the part `done` of the segment. A load that nothing in the present contact determines is held
   !> (its displacement stays): the tangential one without friction, all without contact; the rotation while no two nodes
   !> are in contact.
   !> `settled`: false when statuses changed here and the loads must be looked at again.
   !> Error MFV_GROSS_SLIDING: a tangential force that nothing can carry.
   subroutine settle_loads(self, segment, done, moment, constraints, settled, error)
      class(first_violation_type), intent(inout) :: self
      type(segment_type), intent(in) :: segment
      real(wp), intent(in) :: done
      type(moment_type), intent(inout) :: moment
      type(constraints_type), intent(out) :: constraints
      logical, intent(out) :: settled
      type(error_type), allocatable, intent(out) :: error
      type(load_type) :: load
      logical :: contact, slides

      settled = .true.
      constraints%normal = at_part(segment%normal, done)
      constraints%tangential = at_part(segment%tangential, done)
      constraints%rotational = at_part(segment%rotational, done)
      contact = any(in_contact(self%state%status))
      if (.not. contact .and. constraints%normal%control == control_force) then
         if (constraints%normal%rate > 0.0_wp) then
            call self%close_nearest(segment, moment)
            settled = .false.
            return
         end if
         constraints%normal = load_type(control_displacement, self%state%fields%approach, 0.0_wp)
      end if

      slides = .not. any(self%state%status == node_stick)
      if (slides .and. constraints%tangential%control == control_force) then
         load = constraints%tangential
         call hold_motion(self, constraints, load, along_shift, settled, error)
         constraints%tangential = load
         if (allocated(error) .or. .not. settled) return
      end if
      if (self%model%rotational .and. constraints%rotational%control == control_force) then
         call settle_moment(self, slides, constraints, settled, error)
         if (allocated(error) .or. .not. settled) return
      end if
      constraints%status = self%state%status
      constraints%stuck_slip = self%state%stuck_slip
   end subroutine settle_loads

   !> A prescribed moment. While no two nodes are in contact nothing determines the rotation: it is held, which only a moment of
   !> zero allows (a tangential force at the surface makes another one). The same where normals are along the radius and no node sticks: rotation then only slides.
   !> Errors MFV_NO_CONTINUATION: the moment tips the upper body over; MFV_GROSS_SLIDING.
   subroutine settle_moment(self, slides, constraints, settled, error)
      class(first_violation_type), intent(inout) :: self
      logical, intent(in) :: slides
      type(constraints_type), intent(inout) :: constraints
      logical, intent(inout) :: settled
      type(error_type), allocatable, intent(out) :: error
      real(wp), parameter :: no_moment = 1.0e-14_wp
      type(load_type) :: load
      real(wp) :: scale

      if (self%state%contact_nodes() < 2) then
         scale = self%model%compliance%modulus*self%model%length()**2
         if (max(abs(constraints%rotational%value), abs(constraints%rotational%rate), &
                 abs(self%state%fields%moment - constraints%rotational%value)) > no_moment*scale) &
            call no_continuation(self, 'fewer than two nodes are in contact, and the moment tips the upper body over', error)
         constraints%rotational = load_type(control_displacement, self%state%fields%rotation, 0.0_wp)
      else if (slides .and. self%model%scene%mesh%radial) then
         load = constraints%rotational
         call hold_motion(self, constraints, load, along_rotation, settled, error)
         constraints%rotational = load
      end if
   end subroutine settle_moment

   !> No node is stuck and the tangential force (or moment) `load` is prescribed, so that no equation determines the shift (the
   !> rotation). Hold it where friction balances the force all the same: no friction, no contact, or equal slip to both
   !> sides. Otherwise the upper body moves towards the missing force; nodes that slip with it will stick first: let them
   !> (`settled` is then false). Error MFV_GROSS_SLIDING where there are none: every contact node already gives all it has
   !> against the force.
   subroutine hold_motion(self, constraints, load, along, settled, error)
      class(first_violation_type), intent(inout) :: self
      type(constraints_type), intent(in) :: constraints
      type(load_type), intent(inout) :: load
      integer, intent(in) :: along
      logical, intent(inout) :: settled
      type(error_type), allocatable, intent(out) :: error
      real(wp), parameter :: balanced = 1.0e-9_wp
      type(constraints_type) :: trial
      type(response_type) :: response
      real(wp) :: wanted, missing, scale
      integer :: stuck(size(self%state%status))
      logical :: yielding(size(self%state%status)), singular

      wanted = load%rate
      load = load_type(control_displacement, merge(self%state%fields%shift, self%state%fields%rotation, along == along_shift), &
                       0.0_wp)
      if (.not. any(slips(self%state%status))) then
         scale = self%state%fields%normal_force*merge(1.0_wp, self%model%length(), along == along_shift)
         if (abs(wanted) > balanced*scale) &
            call set_error(error, MFV_GROSS_SLIDING, 'no node in contact has friction to carry a '// &
                           force_name(along)//' '//self%where_it_is())
         return
      end if
      trial = constraints
      if (along == along_shift) then
         trial%tangential = load
         if (self%model%scene%mesh%radial .and. trial%rotational%control == control_force) &
            trial%rotational = load_type(control_displacement, self%state%fields%rotation, 0.0_wp)
      else
         trial%rotational = load
      end if
      trial%status = self%state%status
      trial%stuck_slip = self%state%stuck_slip
      call self%system%solve(self%model, trial, response, singular)
      missing = wanted
      scale = abs(wanted)
      if (.not. singular) then
         missing = wanted - self%model%resultant(along, response%rate%pressure, response%rate%shear)
         scale = max(scale, self%model%force(abs(response%rate%shear*self%model%tangential_arm(:, along))))
         if (abs(missing) <= balanced*scale) return
      end if
      yielding = slips(self%state%status)
      if (.not. singular) yielding = yielding .and. &
                                     slip_sign(self%state%status)*self%model%tangential_arm(:, along)*missing > 0.0_wp
      if (any(yielding)) then
         stuck = node_stick
         call self%state%set_status(yielding, stuck)
         settled = .false.
      else
         call set_error(error, MFV_GROSS_SLIDING, 'gross sliding: every contact node slips '//self%where_it_is())
      end if
   end subroutine hold_motion

   !> What a motion's force is called.
   pure function force_name(along) result(name)
      integer, intent(in) :: along
      character(:), allocatable :: name

      name = 'tangential force'
      if (along == along_rotation) name = 'moment'
   end function force_name

   !> Force control without contact: move the upper body, free of load, until its nearest nodes touch.
   subroutine close_nearest(self, segment, moment)
      class(first_violation_type), intent(inout) :: self
      type(segment_type), intent(in) :: segment
      type(moment_type), intent(inout) :: moment
      real(wp), dimension(self%model%nodes()) :: gap, normal, tangential
      real(wp) :: smallest, round_off
      integer :: status(self%model%nodes())
      logical :: touching(self%model%nodes())

      gap = self%model%gap(self%state%fields)
      self%state%fields%approach = self%state%fields%approach + self%model%nearest_approach(gap)
      call self%model%relative_displacements(self%state%fields, normal, tangential)
      self%state%fields%normal = normal
      if (self%model%tangential) self%state%fields%tangential = tangential
      gap = self%model%gap(self%state%fields)
      smallest = minval(gap, mask=self%model%can_touch)
      round_off = 8*epsilon(1.0_wp)*max(maxval(abs(self%model%initial_gap)), abs(self%state%fields%approach))
      touching = self%model%can_touch .and. gap - smallest <= round_off
      status = status_after(event_close, segment%friction .and. self%model%tangential, 0)
      call note_change(moment, event_close, touching)
      call self%state%set_status(touching, status)
   end subroutine close_nearest

   !> Take a step of the load with the rates of `response`, and check the increment.
   !> Errors MFV_NO_CONTINUATION: the statuses would make the tractions jump, or the certificate fails by far (loads out of
   !> all proportion, for example).
   subroutine advance(self, response, step, error)
      class(first_violation_type), intent(inout) :: self
      type(response_type), intent(in) :: response
      real(wp), intent(in) :: step
      type(error_type), allocatable, intent(out) :: error
      real(wp), parameter :: moving = 1.0e-9_wp
      type(contact_fields_type) :: before
      real(wp), dimension(size(self%state%status)) :: slipped, slip_rate
      real(wp) :: scale

      before = self%state%fields
      scale = max(self%certificate%traction_scale(), &
                  maxval(abs(response%rate%pressure)), maxval(abs(response%rate%shear)))
      if (max(maxval(abs(response%state%pressure - before%pressure)), &
              maxval(abs(response%state%shear - before%shear))) > largest_jump*scale) then
         call no_continuation(self, 'the tractions would have to jump', error)
         return
      end if
      call self%certificate%note_jump(before, response%state)
      self%state%fields = response%state%plus(step, response%rate)
      slipped = self%state%fields%slip() - before%slip()
      self%state%dissipation = self%state%dissipation &
                               - 0.5_wp*self%model%force((before%shear + self%state%fields%shear)*slipped)
      slip_rate = response%rate%slip()
      self%state%slip_direction = 0
      where (abs(slip_rate) > moving*maxval(abs(slip_rate))) &
         self%state%slip_direction = nint(sign(1.0_wp, slip_rate))
      call self%certificate%check_increment(self%model, before, self%state)
      if (self%certificate%largest() > failed_certificate) &
         call no_continuation(self, 'the equations are no longer satisfied (certificate '// &
                              to_text(self%certificate%largest())//')', error)
   end subroutine advance

   !> Change the statuses of the nodes whose inequalities break first, together.
   !> Errors MFV_NO_CONTINUATION: every way out has been tried at this load; MFV_MESH_EXCEEDED.
   subroutine change_statuses(self, segment, violations, moment, error)
      class(first_violation_type), intent(inout) :: self
      type(segment_type), intent(in) :: segment
      type(violations_type), intent(in) :: violations
      type(moment_type), intent(inout) :: moment
      type(error_type), allocatable, intent(out) :: error
      logical :: changing(size(violations%kind))
      integer :: fastest

      if (was_tried(moment, self%state%status)) then
         if (moment%one_at_a_time .and. moment%round_off >= larger_round_off) then
            call no_continuation(self, 'no set of statuses has consistent rates; node '// &
                                 to_text(maxloc(violations%speed, dim=1))//' cannot decide', error)
            return
         end if
         moment%one_at_a_time = moment%round_off >= larger_round_off
         moment%round_off = larger_round_off
         deallocate (moment%tried)
      end if
      call remember(moment, self%state%status)

      changing = violations%step <= minval(violations%step)*(1.0_wp + tie) + no_step
      if (moment%one_at_a_time) then
         fastest = maxloc(violations%speed, dim=1, mask=changing)
         changing = .false.
         changing(fastest) = .true.
      end if
      call note_change(moment, violations%kind(first_true(changing)), changing)
      call self%state%set_status(changing, status_after(violations%kind, segment%friction .and. &
                                                        self%model%tangential, self%state%slip_direction))
      if (.not. self%model%reaches_end(in_contact(self%state%status))) return
      if (self%model%growing) then
         call self%widen(moment)
      else
         call set_error(error, MFV_MESH_EXCEEDED, 'the contact reached the end of the mesh, '// &
                        to_text(self%model%length())//' from the pole '//self%where_it_is())
      end if
   end subroutine change_statuses

   !> Lengthen the mesh by a quarter on either side.
   subroutine widen(self, moment)
      class(first_violation_type), intent(inout) :: self
      type(moment_type), intent(inout) :: moment
      integer, parameter :: fewest = 4
      integer :: extra, n

      n = self%model%nodes()
      extra = min(max(n/4, fewest), self%model%spare_nodes())
      if (extra == 0) return
      call self%model%grow(extra)
      call self%state%widen(extra)
      call self%history%move_nodes(extra)
      if (moment%node > 0) moment%node = moment%node + extra
      if (allocated(moment%tried)) deallocate (moment%tried)
      call fill_ends(self%model, self%state%fields, extra)
   end subroutine widen

   !> Displacements of the `extra` new nodes at either end.
   subroutine fill_ends(model, fields, extra)
      type(contact_model_type), intent(in) :: model
      type(contact_fields_type), intent(inout) :: fields
      integer, intent(in) :: extra
      real(wp) :: normal(model%nodes()), tangential(model%nodes())
      logical :: new(model%nodes())

      call model%relative_displacements(fields, normal, tangential)
      new = .true.
      new(extra + 1:model%nodes() - extra) = .false.
      where (new) fields%normal = normal
      where (new) fields%tangential = tangential
   end subroutine fill_ends

   !> Record the state after an event.
   subroutine record(self, kind, node, count, step)
      class(first_violation_type), intent(inout) :: self
      integer, intent(in) :: kind, node, count, step

      call self%history%append(self%state, kind, node, count, step, self%system%solves)
   end subroutine record

   !> The statuses at this load have settled: count and record what changed them.
   subroutine keep_settled(self, segment, moment)
      class(first_violation_type), intent(inout) :: self
      type(segment_type), intent(in) :: segment
      type(moment_type), intent(in) :: moment

      if (moment%event == event_none) return
      self%events = self%events + 1
      if (self%record_events) call self%record(moment%event, moment%node, moment%count, segment%step)
   end subroutine keep_settled

   !> The load at the part `done` of its way.
   pure type(load_type) function at_part(load, done)
      type(load_type), intent(in) :: load
      real(wp), intent(in) :: done

      at_part = load_type(load%control, load%value + done*load%rate, load%rate)
   end function at_part

   !> Keep the first change at a load.
   subroutine note_change(moment, event, changing)
      type(moment_type), intent(inout) :: moment
      integer, intent(in) :: event
      logical, intent(in) :: changing(:)

      if (moment%event /= event_none) return
      moment%event = event
      moment%node = first_true(changing)
      moment%count = count(changing)
   end subroutine note_change

   pure integer function first_true(mask)
      logical, intent(in) :: mask(:)

      first_true = findloc(mask, .true., dim=1)
   end function first_true

   pure logical function was_tried(moment, status)
      type(moment_type), intent(in) :: moment
      integer, intent(in) :: status(:)
      integer :: i

      was_tried = .false.
      if (.not. allocated(moment%tried)) return
      do i = 1, size(moment%tried, 2)
         was_tried = was_tried .or. all(moment%tried(:, i) == status)
      end do
   end function was_tried

   subroutine remember(moment, status)
      type(moment_type), intent(inout) :: moment
      integer, intent(in) :: status(:)
      integer :: tried

      tried = 0
      if (allocated(moment%tried)) tried = size(moment%tried, 2)
      if (tried == 0) then
         moment%tried = reshape(status, [size(status), 1])
      else
         moment%tried = reshape([moment%tried, status], [size(status), tried + 1])
      end if
   end subroutine remember

   subroutine no_continuation(self, why, error)
      type(first_violation_type), intent(in) :: self
      character(*), intent(in) :: why
      type(error_type), allocatable, intent(out) :: error

      call set_error(error, MFV_NO_CONTINUATION, 'no admissible continuation: '//why//' '//self%where_it_is())
   end subroutine no_continuation

   !> The load and contact now, for messages.
   function where_it_is(self) result(text)
      class(first_violation_type), intent(in) :: self
      character(:), allocatable :: text

      text = '(normal force '//to_text(self%state%fields%normal_force, 10)//', tangential force '// &
             to_text(self%state%fields%tangential_force, 10)//', '//to_text(self%state%contact_nodes())// &
             ' nodes in contact, '//to_text(self%state%stick_nodes())//' stuck)'
   end function where_it_is

end module mfv_first_violation
