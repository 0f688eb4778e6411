!> A contact on its way through a load history: the model, its state now, and what every algorithm does with them: begin a
!> straight part of the history, hold what nothing determines, change statuses, record.
module mfv_contact_path
   use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
   use mfv_certificate, only: certificate_type, new_certificate
   use mfv_contact_fields, only: contact_fields_type
   use mfv_contact_model, only: contact_model_type, new_contact_model
   use mfv_contact_state, only: contact_state_type, new_contact_state
   use mfv_contact_system
   use mfv_error, only: error_type, set_error
   use mfv_event_search, only: status_after
   use mfv_friction_law, only: friction_event_type, friction_point_type, most_events
   use mfv_history, only: history_type
   use mfv_kinds, only: wp
   use mfv_linear_solvers, only: new_contact_system
   use mfv_motions, only: motions, motion_count, motion_approach, motion_shift, motion_rotation, control_force, &
                          control_displacement, arm_unit
   use mfv_node_status
   use mfv_observer, only: observer_type
   use mfv_rolling, only: rolling_type
   use mfv_scene, only: algorithm_mfv, stepping_leap
   use mfv_slip_zones, only: widest_slip_zone
   use mfv_status
   use mfv_strings, only: to_text
   implicit none
   private
   public :: contact_path_type, path_position_type, kept_path_type, new_contact_path, segment_type, moment_type, note_change, &
             first_true

   !> A straight part of the load history: the controlled loads with their targets, and whether friction acts.
   type :: segment_type
      type(load_type) :: load(motion_count) = initial_loads
      logical :: friction = .true.
      !> Number of this segment, how many there are, and the step that it belongs to: for records and progress.
      integer :: number = 1, segments = 1, step = 1
      !> Where this one begins and ends in parts of the whole that it belongs to, for progress.
      real(wp) :: from = 0.0_wp, to = 1.0_wp
   end type segment_type

   !> What a contact needs to continue from here, besides the work of the linear solver and what only grows (history records).
   type :: path_position_type
      type(contact_state_type) :: state
      type(certificate_type) :: certificate
      !> Events so far: loads at which statuses changed.
      integer :: events = 0
      !> Length of the increment to try next where friction is not linear, in parts of a segment; 0: not known yet.
      real(wp) :: trial = 0.0_wp
      !> Tangential force over shift on the first increment of this segment, force/length^2; NaN where there is none yet, and of
      !> load steps and leaps, which are no first increments.
      real(wp) :: first_stiffness = 0.0_wp
      !> How the bodies roll on each other.
      type(rolling_type) :: rolling
      !> Nodes of the widest slip zone that has dissipated in this segment, see mfv_slip_zones.
      integer :: slip_zone_nodes = 0
   end type path_position_type

   type, extends(path_position_type) :: contact_path_type
      type(contact_model_type) :: model
      class(contact_system_type), allocatable :: system
      !> The state before the last increment.
      type(contact_state_type), private :: before
      type(history_type) :: history
      !> Whether every event is recorded, or only what the caller records.
      logical :: record_events = .true.
      !> Tangential force and shift where the segment begins, while the first increment is waited for.
      real(wp), private :: start_force = 0.0_wp, start_shift = 0.0_wp
      !> The dissipation where the segment begins, force.
      real(wp), private :: start_dissipation = 0.0_wp
      logical, private :: awaits_increment = .false.
   contains
      procedure :: copy_without_history
      procedure :: keep
      procedure :: come_back
      procedure :: resume
      procedure :: notify
      procedure, private :: model_as
      procedure :: await_increment
      procedure :: begin_motion
      procedure :: record
      procedure :: start_segment
      procedure :: settle_loads
      procedure :: loads_at
      procedure :: dropping
      procedure :: is_releasing
      procedure :: point
      procedure, private :: has_memory
      procedure :: find_events
      procedure :: friction_limits
      procedure :: can_become_unstable
      procedure :: remember_status
      procedure :: snap
      procedure :: set_rows
      procedure :: set_status
      procedure :: holding
      procedure :: take_increment
      procedure :: keep_settled
      procedure :: keep_on_mesh
      procedure :: widen
      procedure :: no_continuation
      procedure :: end_here
      procedure, private :: begin_tangential
      procedure :: close_nearest
   end type contact_path_type

   !> A position that was kept, with what tells how much had grown by then, and what was modelled.
   type :: kept_path_type
      private
      type(path_position_type) :: position
      class(contact_system_type), allocatable :: system
      integer :: records = 0, added = 0
      logical :: tangential = .false., moves(motion_count) = .false.
   end type kept_path_type

   !> What is known at one load while statuses settle.
   type :: moment_type
      !> Status sets tried here, shape (nodes, at least `tries`).
      integer, allocatable :: tried(:, :)
      integer :: tries = 0
      !> Rates below this part of the largest are round-off.
      real(wp) :: round_off = 1.0e-12_wp
      !> One change at a time, after a cycle.
      logical :: one_at_a_time = .false.
      !> Whether nodes have been let snap here, and whether the rates of all have been solved for.
      logical :: snapped = .false., solved = .false.
      !> First change at this load: event and node; and how many nodes changed with it.
      integer :: event = event_none, node = 0, count = 0
   end type moment_type

contains

   !> An unloaded contact, the bodies just touching.
   subroutine new_contact_path(model, record_events, self)
      type(contact_model_type), intent(in) :: model
      logical, intent(in) :: record_events
      type(contact_path_type), intent(out) :: self

      self%model = model
      call new_contact_system(model, self%system)
      self%state = new_contact_state(model%nodes())
      self%state%fields%motion(motion_approach) = model%nearest_approach(model%initial_gap)
      call model%displace(self%state%fields)
      self%certificate = new_certificate(model)
      self%record_events = record_events
   end subroutine new_contact_path

   !> A copy to try something on, that records nothing.
   subroutine copy_without_history(self, copy)
      class(contact_path_type), intent(in) :: self
      type(contact_path_type), intent(out) :: copy

      copy%model = self%model
      copy%path_position_type = self%path_position_type
      allocate (copy%system, source=self%system)
      copy%record_events = .false.
   end subroutine copy_without_history

   !> Keep the contact as it is between segments.
   subroutine keep(self, kept)
      class(contact_path_type), intent(in) :: self
      type(kept_path_type), intent(inout) :: kept

      kept%position = self%path_position_type
      ! By hand: gfortran 12 leaks what a polymorphic component held before an assignment.
      if (allocated(kept%system)) deallocate (kept%system)
      allocate (kept%system, source=self%system)
      kept%records = self%history%records
      kept%added = self%model%added
      kept%tangential = self%model%tangential
      kept%moves = self%model%moves
   end subroutine keep

   !> Come back to what was kept of this contact, or of one with the same scene. History records since then are dropped. A mesh
   !> that has grown, or a problem that has come to be modelled since, is modelled anew as it was.
   subroutine come_back(self, kept)
      class(contact_path_type), intent(inout) :: self
      type(kept_path_type), intent(in) :: kept

      call self%history%move_nodes(kept%added - self%model%added)
      call self%model_as(kept%added, kept%tangential, kept%moves)
      self%path_position_type = kept%position
      deallocate (self%system)
      allocate (self%system, source=kept%system)
      self%history%records = min(kept%records, self%history%records)
   end subroutine come_back

   !> Model the contact with so many nodes added at either end, and with the problems and motions that are named; anew where it was
   !> otherwise.
   subroutine model_as(self, added, tangential, moves)
      class(contact_path_type), intent(inout) :: self
      integer, intent(in) :: added
      logical, intent(in) :: tangential, moves(motion_count)
      integer :: i

      if (self%model%added == added .and. (self%model%tangential .eqv. tangential) .and. &
          all(self%model%moves .eqv. moves)) return
      self%model = new_contact_model(self%model%scene)
      if (tangential .and. .not. self%model%tangential) call self%model%add_tangential()
      do i = 1, motion_count
         if (moves(i)) call self%model%add_motion(i)
      end do
      if (added > 0) call self%model%grow(added)
   end subroutine model_as

   !> Continue from a position that a contact of the same scene has reached, with `added` nodes more at either end. The linear
   !> solver
   !> starts anew.
   subroutine resume(self, position, added)
      class(contact_path_type), intent(inout) :: self
      type(path_position_type), intent(in) :: position
      integer, intent(in) :: added

      call self%model_as(added, self%model%tangential, self%model%moves)
      self%path_position_type = position
      call self%certificate%find_applicable(self%model)
   end subroutine resume

   !> Notify an observer, if there is one, of the load at the part `done` of a segment. Error MFV_INTERRUPTED: it stops the run.
   subroutine notify(self, segment, done, observer, error)
      class(contact_path_type), intent(in) :: self
      type(segment_type), intent(in) :: segment
      real(wp), intent(in) :: done
      class(observer_type), intent(inout), optional :: observer
      type(error_type), allocatable, intent(out) :: error
      logical :: stop_wanted

      if (.not. present(observer)) return
      call observer%notify(self%state, segment%number, segment%segments, segment%from + (segment%to - segment%from)*done, &
                           stop_wanted)
      if (stop_wanted) call self%end_here(MFV_INTERRUPTED, 'stopped on request', error)
   end subroutine notify

   !> A segment begins: have its first_stiffness and slip_zone_nodes found.
   subroutine await_increment(self)
      class(contact_path_type), intent(inout) :: self

      self%first_stiffness = ieee_value(1.0_wp, ieee_quiet_nan)
      self%start_force = self%state%fields%force(motion_shift)
      self%start_shift = self%state%fields%motion(motion_shift)
      self%start_dissipation = self%state%dissipation
      self%slip_zone_nodes = 0
      self%awaits_increment = self%model%scene%method%algorithm == algorithm_mfv .and. &
                              self%model%scene%method%stepping /= stepping_leap
   end subroutine await_increment

   !> Find first_stiffness where the tangential force has changed by more than round-off. A held shift has none.
   subroutine find_first_stiffness(self)
      class(contact_path_type), intent(inout) :: self
      real(wp), parameter :: visible = 1.0e-6_wp
      real(wp) :: force, shift

      force = self%state%fields%force(motion_shift) - self%start_force
      shift = self%state%fields%motion(motion_shift) - self%start_shift
      if (.not. abs(force) > visible*self%model%grip*self%state%fields%force(motion_approach)) return
      self%awaits_increment = .false.
      if (abs(force) < self%model%largest_stiffness()*abs(shift)) self%first_stiffness = force/shift
   end subroutine find_first_stiffness

   !> Turn friction on or off in the nodes that touch; with the first friction the tangential problem begins to be
   !> modelled. Error MFV_INADMISSIBLE_STEP: friction off where there is shear.
   subroutine start_segment(self, segment, error)
      class(contact_path_type), intent(inout) :: self
      type(segment_type), intent(in) :: segment
      type(error_type), allocatable, intent(out) :: error
      integer :: status(size(self%state%status))

      if (segment%friction .and. self%model%scene%friction%acts()) then
         if (.not. self%model%tangential .or. any(self%state%status == node_frictionless)) call self%begin_tangential()
         call self%set_status(self%state%status == node_frictionless, self%holding(self%state%fields%shear))
         return
      end if
      if (any(abs(self%state%fields%shear) > 0.0_wp)) then
         call self%end_here(MFV_INADMISSIBLE_STEP, 'friction cannot be switched off while there is shear traction', error)
         return
      end if
      status = node_frictionless
      call self%set_status(in_contact(self%state%status), status)
   end subroutine start_segment

   !> Friction comes on: model the tangential problem if that has not been done yet, and begin it from the present
   !> pressures.
   subroutine begin_tangential(self)
      class(contact_path_type), intent(inout) :: self
      real(wp) :: normal(self%model%nodes())

      if (.not. self%model%tangential) call self%model%add_tangential()
      call self%certificate%find_applicable(self%model)
      call self%model%relative_displacements(self%state%fields, normal, self%state%fields%tangential)
   end subroutine begin_tangential

   !> Model a motion from now on, from the force that the tractions have.
   subroutine begin_motion(self, motion)
      class(contact_path_type), intent(inout) :: self
      integer, intent(in) :: motion

      if (self%model%moves(motion)) return
      call self%model%add_motion(motion)
      call self%certificate%find_applicable(self%model)
      associate (fields => self%state%fields)
         fields%force(motion) = self%model%resultant(motion, fields%pressure, fields%shear)
      end associate
   end subroutine begin_motion

   !> The loads at the part `done` of the segment, as they are prescribed.
   subroutine loads_at(self, segment, done, constraints)
      class(contact_path_type), intent(in) :: self
      type(segment_type), intent(in) :: segment
      real(wp), intent(in) :: done
      type(constraints_type), intent(inout) :: constraints

      constraints%load = at_part(segment%load, done)
   end subroutine loads_at

   !> The constraints at the part `done` of the segment. A load that nothing in the present contact determines is held
   !> (its displacement stays): the tangential one without friction, all without contact; the rotation while no two nodes
   !> are in contact.
   !> `settled`: false when statuses changed here and the loads must be looked at again.
   !> Error MFV_GROSS_SLIDING: a tangential force that nothing can carry.
   subroutine settle_loads(self, segment, done, moment, constraints, settled, error)
      class(contact_path_type), intent(inout) :: self
      type(segment_type), intent(in) :: segment
      real(wp), intent(in) :: done
      type(moment_type), intent(inout) :: moment
      type(constraints_type), intent(inout) :: constraints
      logical, intent(out) :: settled
      type(error_type), allocatable, intent(out) :: error
      logical :: contact, slides, drop
      integer :: i

      settled = .true.
      call self%loads_at(segment, done, constraints)
      drop = self%dropping()
      if (drop) constraints%load%rate = 0.0_wp
      call self%set_rows(constraints, drop)
      contact = any(in_contact(self%state%status))
      if (.not. contact .and. constraints%load(motion_approach)%control == control_force) then
         if (constraints%load(motion_approach)%rate > 0.0_wp) then
            call self%close_nearest(segment, moment)
            settled = .false.
            return
         end if
         constraints%load(motion_approach) = load_type(control_displacement, self%state%fields%motion(motion_approach), 0.0_wp)
      end if

      slides = .not. any(holds(self%state%status))
      if (slides .and. constraints%load(motion_shift)%control == control_force) then
         call hold_motion(self, constraints, motion_shift, settled, error)
         if (allocated(error) .or. .not. settled) return
      end if
      do i = 1, motion_count
         if (.not. (motions(i)%optional .and. self%model%moves(i)) .or. constraints%load(i)%control /= control_force) cycle
         call settle_optional(self, i, slides, constraints, settled, error)
         if (allocated(error) .or. .not. settled) return
      end do
   end subroutine settle_loads

   !> A prescribed moment, or force of another motion besides approach and shift. While no two nodes are in contact nothing
   !> determines the rotation: it is held, which only a moment of zero allows (a tangential force at the surface makes another
   !> one). The same where no node sticks and the motion only slides: a rotation where normals are along the radius.
   !> Errors MFV_NO_CONTINUATION: the moment tips the upper body over; MFV_GROSS_SLIDING.
   subroutine settle_optional(self, motion, slides, constraints, settled, error)
      class(contact_path_type), intent(inout) :: self
      integer, intent(in) :: motion
      logical, intent(in) :: slides
      type(constraints_type), intent(inout) :: constraints
      logical, intent(inout) :: settled
      type(error_type), allocatable, intent(out) :: error
      real(wp), parameter :: no_moment = 1.0e-14_wp
      real(wp) :: scale

      if (self%state%contact_nodes() < 2) then
         associate (load => constraints%load(motion), length => self%model%length())
            scale = self%model%compliance%modulus*(length*arm_unit(motion, length))
            if (max(abs(load%value), abs(load%rate), abs(self%state%fields%force(motion) - load%value)) > no_moment*scale) &
               call no_continuation(self, 'fewer than two nodes are in contact, and the '//trim(motions(motion)%force_name)// &
                                    ' tips the upper body over', error)
         end associate
         constraints%load(motion) = load_type(control_displacement, self%state%fields%motion(motion), 0.0_wp)
      else if (slides .and. .not. self%model%lifts(motion)) then
         call hold_motion(self, constraints, motion, settled, error)
      end if
   end subroutine settle_optional

   !> No node is stuck and the force of a motion that slides (shift, rotation) is prescribed, so that no equation determines the
   !> motion. Hold it where friction balances the force all the same: no friction, no contact, or equal slip to both
   !> sides. Otherwise the upper body moves towards the missing force; nodes that slip with it will stick first: let them
   !> (`settled` is then false). Error MFV_GROSS_SLIDING where there are none: every contact node already gives all it has
   !> against the force.
   subroutine hold_motion(self, constraints, motion, settled, error)
      class(contact_path_type), intent(inout) :: self
      type(constraints_type), intent(inout) :: constraints
      integer, intent(in) :: motion
      logical, intent(inout) :: settled
      type(error_type), allocatable, intent(out) :: error
      real(wp), parameter :: balanced = 1.0e-9_wp, nothing = 1.0e-12_wp, noises = 10.0_wp
      type(constraints_type) :: trial
      type(response_type) :: response
      real(wp) :: wanted, missing, scale, arm, negligible, none
      logical :: pressed
      logical :: yielding(size(self%state%status)), singular
      integer :: i

      wanted = constraints%load(motion)%rate
      none = max(nothing, noises*self%system%noise)
      constraints%load(motion) = load_type(control_displacement, self%state%fields%motion(motion), 0.0_wp)
      arm = arm_unit(motion, self%model%length())
      negligible = none*self%certificate%force_scale()*arm
      pressed = self%state%fields%force(motion_approach) > none*self%certificate%force_scale()
      if (.not. any(slips(self%state%status))) then
         if (abs(wanted) > max(balanced*self%state%fields%force(motion_approach)*arm, negligible)) &
            call self%end_here(merge(MFV_GROSS_SLIDING, MFV_SEPARATED, pressed), &
                               'no node in contact has friction to carry a '//trim(motions(motion)%force_name), error)
         return
      end if
      ! What is lifted off opens next; its last round-off of pressure slides nothing.
      if (.not. pressed .and. abs(wanted) <= negligible .and. constraints%load(motion_approach)%rate < 0.0_wp) return
      trial = constraints
      do i = 1, motion_count
         if (i /= motion .and. motions(i)%optional .and. trial%load(i)%control == control_force .and. .not. self%model%lifts(i)) &
            trial%load(i) = load_type(control_displacement, self%state%fields%motion(i), 0.0_wp)
      end do
      call self%system%solve(self%model, trial, self%state%fields, response, singular)
      missing = wanted
      scale = abs(wanted)
      if (.not. singular) then
         missing = wanted - self%model%resultant(motion, response%rate%pressure, response%rate%shear)
         scale = max(scale, self%model%force(abs(response%rate%shear*self%model%tangential_arm(:, motion))))
         if (abs(missing) <= max(balanced*scale, noises*self%system%noise*scale, negligible)) return
      end if
      yielding = slips(self%state%status)
      if (.not. singular) yielding = yielding .and. &
                                     slip_sign(self%state%status)*self%model%tangential_arm(:, motion)*missing > 0.0_wp
      if (any(yielding)) then
         call self%set_status(yielding, self%holding(real(-slip_sign(self%state%status), wp)))
         settled = .false.
      else if (pressed) then
         call self%end_here(MFV_GROSS_SLIDING, 'gross sliding: every contact node slips', error)
      else
         call self%end_here(MFV_SEPARATED, 'the bodies are no longer pressed together to carry a '// &
                            trim(motions(motion)%force_name), error)
      end if
   end subroutine hold_motion

   !> Force control without contact: move the upper body, free of load, until its nearest nodes touch.
   subroutine close_nearest(self, segment, moment)
      class(contact_path_type), intent(inout) :: self
      type(segment_type), intent(in) :: segment
      type(moment_type), intent(inout) :: moment
      real(wp), dimension(self%model%nodes()) :: gap, normal, tangential
      real(wp) :: smallest, round_off
      integer :: status(self%model%nodes())
      logical :: touching(self%model%nodes())

      gap = self%model%gap(self%state%fields)
      self%state%fields%motion(motion_approach) = self%state%fields%motion(motion_approach) + self%model%nearest_approach(gap)
      call self%model%relative_displacements(self%state%fields, normal, tangential)
      self%state%fields%normal = normal
      if (self%model%tangential) self%state%fields%tangential = tangential
      gap = self%model%gap(self%state%fields)
      smallest = minval(gap, mask=self%model%can_touch)
      round_off = 8*epsilon(1.0_wp)*max(maxval(abs(self%model%initial_gap)), abs(self%state%fields%motion(motion_approach)))
      touching = self%model%can_touch .and. gap - smallest <= round_off
      status = status_after(event_close, node_open, segment%friction .and. self%model%tangential, 0, &
                            self%holding(self%state%fields%shear))
      call note_change(moment, event_close, touching)
      call self%set_status(touching, status)
   end subroutine close_nearest

   !> Whether over-stress of some node must relax before the load goes on.
   pure logical function dropping(self)
      class(contact_path_type), intent(in) :: self

      dropping = self%has_memory()
      if (dropping) dropping = any(self%is_releasing())
   end function dropping

   !> Nodes whose over-stress must relax.
   pure function is_releasing(self)
      class(contact_path_type), intent(in) :: self
      logical :: is_releasing(size(self%state%status))
      integer :: i

      is_releasing = .false.
      if (.not. self%has_memory()) return
      do i = 1, size(is_releasing)
         is_releasing(i) = self%model%scene%friction%law%is_releasing(self%state%memory(:, i))
      end do
   end function is_releasing

   !> What the friction law knows of node `node` where the fields are `fields`.
   pure function point(self, node, fields)
      class(contact_path_type), intent(in) :: self
      integer, intent(in) :: node
      type(contact_fields_type), intent(in) :: fields
      type(friction_point_type) :: point

      point = self%state%friction_point(fields, node, self%model%static_friction(node), self%model%kinetic_friction(node))
   end function point

   !> Whether the friction law remembers anything.
   pure logical function has_memory(self)
      class(contact_path_type), intent(in) :: self

      has_memory = .false.
      if (allocated(self%model%scene%friction%law)) has_memory = self%model%scene%friction%law%has_memory()
   end function has_memory

   !> Events of the friction law's own in an increment that is expected to lead to the fields `after`, shape (most_events, nodes);
   !> not
   !> allocated where it has none.
   subroutine find_events(self, after, events)
      class(contact_path_type), intent(in) :: self
      type(contact_fields_type), intent(in) :: after
      type(friction_event_type), allocatable, intent(out) :: events(:, :)
      integer :: i

      if (.not. self%model%scene%friction%acts()) return
      associate (law => self%model%scene%friction%law)
         if (.not. law%has_events()) return
         allocate (events(most_events, size(self%state%status)))
         do i = 1, size(self%state%status)
            call law%find_events(self%state%status(i), self%point(i, self%state%fields), self%point(i, after), events(:, i))
         end do
      end associate
   end subroutine find_events

   !> Coefficients of the friction limit, shape (nodes).
   pure function friction_limits(self) result(limit)
      class(contact_path_type), intent(in) :: self
      real(wp) :: limit(size(self%state%status))
      integer :: i

      limit = self%model%static_friction
      if (.not. allocated(self%model%scene%friction%law)) return
      associate (law => self%model%scene%friction%law)
         if (.not. law%limit_varies()) return
         do i = 1, size(limit)
            limit(i) = law%limit(self%point(i, self%state%fields))
         end do
      end associate
   end function friction_limits

   !> Nodes that may have no equilibrium nearby once they slip.
   pure function can_become_unstable(self) result(unstable)
      class(contact_path_type), intent(in) :: self
      logical :: unstable(size(self%state%status))
      integer :: i

      unstable = .false.
      if (.not. self%has_memory()) return
      do i = 1, size(unstable)
         unstable(i) = self%model%scene%friction%law%can_become_unstable(self%state%status(i), self%point(i, self%state%fields))
      end do
   end function can_become_unstable

   !> Where nodes can neither hold nor slip on in equilibrium, have them slip and their traction relax. `snapped`: whether there are
   !> any;
   !> the first of them is then what changes at this load, unless something else has changed before.
   subroutine snap(self, moment, snapped)
      class(contact_path_type), intent(inout) :: self
      type(moment_type), intent(inout) :: moment
      logical, intent(out) :: snapped
      logical :: mask(size(self%state%status))
      integer :: status(size(self%state%status)), i

      mask = self%can_become_unstable()
      snapped = any(mask)
      if (.not. snapped) return
      status = merge(node_slip_left, node_slip_right, self%state%fields%shear > 0.0_wp)
      call note_change(moment, merge(event_slip_left, event_slip_right, status(first_true(mask)) == node_slip_left), mask)
      call self%set_status(mask, status)
      do i = 1, size(mask)
         if (mask(i)) call self%model%scene%friction%law%release(self%point(i, self%state%fields), self%state%memory(:, i))
      end do
   end subroutine snap

   !> Statuses and lines of friction as constraints: tangents, or lines for where the fields are expected to be `after` an
   !> increment; with `straight` the secants to there. `drop`: whether over-stress relaxes, all of it per unit of load.
   subroutine set_rows(self, constraints, drop, after, straight)
      class(contact_path_type), intent(in) :: self
      type(constraints_type), intent(inout) :: constraints
      logical, intent(in) :: drop
      type(contact_fields_type), intent(in), optional :: after
      logical, intent(in), optional :: straight
      type(friction_point_type) :: here, there
      integer :: i, n

      n = size(self%state%status)
      constraints%status = self%state%status
      constraints%stuck_slip = self%state%stuck_slip
      if (allocated(constraints%row)) then
         if (size(constraints%row) /= n) deallocate (constraints%row, constraints%offset_rate)
      end if
      if (.not. allocated(constraints%row)) allocate (constraints%row(n), constraints%offset_rate(n))
      constraints%offset_rate = 0.0_wp
      if (.not. self%model%tangential) return
      do i = 1, n
         if (.not. slips(self%state%status(i)) .and. .not. creeps(self%state%status(i))) cycle
         here = self%point(i, self%state%fields)
         there = here
         if (present(after)) there = self%point(i, after)
         if (present(straight)) then
            constraints%row(i) = self%model%scene%friction%law%secant(self%state%status(i), here, there)
         else
            constraints%row(i) = self%model%scene%friction%law%row(self%state%status(i), here, there)
         end if
         if (drop) constraints%offset_rate(i) = slip_sign(self%state%status(i)) &
                                                *self%model%scene%friction%law%release_rate(self%state%memory(:, i))
      end do
   end subroutine set_rows

   !> Give the nodes of `mask` the new statuses, with what their friction then remembers.
   subroutine set_status(self, mask, status)
      class(contact_path_type), intent(inout) :: self
      logical, intent(in) :: mask(:)
      integer, intent(in) :: status(:)
      integer :: i

      if (self%has_memory()) then
         do i = 1, size(mask)
            if (mask(i)) call self%model%scene%friction%law%change_status(self%state%status(i), status(i), &
                                                                          self%point(i, self%state%fields), self%state%memory(:, i))
         end do
      end if
      call self%state%set_status(mask, status)
   end subroutine set_status

   !> What the law remembers of the nodes of `mask` as if they had slipped until they got their statuses.
   subroutine remember_status(self, mask)
      class(contact_path_type), intent(inout) :: self
      logical, intent(in) :: mask(:)
      integer :: i

      if (.not. self%has_memory()) return
      do i = 1, size(mask)
         if (mask(i)) call self%model%scene%friction%law%change_status(node_slip_right, self%state%status(i), &
                                                                       self%point(i, self%state%fields), self%state%memory(:, i))
      end do
   end subroutine remember_status

   !> The status that each node has if it holds; `slip_rate`: with which rates it moves, any unit, shape (nodes).
   pure function holding(self, slip_rate) result(status)
      class(contact_path_type), intent(in) :: self
      real(wp), intent(in) :: slip_rate(:)
      integer :: status(size(slip_rate))
      integer :: i

      status = node_stick
      if (.not. allocated(self%model%scene%friction%law)) return
      if (self%model%scene%friction%law%sticks()) return
      do i = 1, size(status)
         status(i) = self%model%scene%friction%law%holding_status(merge(-1, 1, slip_rate(i) < 0.0_wp))
      end do
   end function holding

   !> Go to the fields `after`: memories, dissipation, directions and the certificate go along. `slip_rate`: rates of slip on
   !> the way, any unit, shape (nodes); `dropped`: part of the over-stress that has relaxed. `friction_work`: what
   !> friction dissipates over a large increment, whose path is not known (force/length, shape (nodes)); else everything is linear
   !> on the way.
   subroutine take_increment(self, after, slip_rate, dropped, friction_work)
      class(contact_path_type), intent(inout) :: self
      type(contact_fields_type), intent(in) :: after
      real(wp), intent(in) :: slip_rate(:), dropped
      real(wp), intent(in), optional :: friction_work(:)
      real(wp), parameter :: moving = 1.0e-9_wp
      real(wp) :: loss, part, fastest
      integer :: i

      call self%before%take(self%state)
      call remember_slip(self, after, dropped)
      call self%state%fields%take(after)
      do i = 1, motion_count
         if (.not. self%model%moves(i)) self%state%fields%force(i) = self%model%resultant(i, after%pressure, after%shear)
      end do
      if (present(friction_work)) then
         self%state%dissipation = self%state%dissipation + self%model%force(friction_work)
         self%state%friction_work = self%state%friction_work + friction_work
      else
         loss = 0.0_wp
         associate (before => self%before%fields)
            do i = 1, size(slip_rate)
               part = (before%shear(i) + after%shear(i)) &
                      *((after%tangential(i) - after%motion(motion_shift)) - (before%tangential(i) - before%motion(motion_shift)))
               loss = loss - self%model%width(i)*part
               self%state%friction_work(i) = self%state%friction_work(i) - 0.5_wp*part
            end do
         end associate
         self%state%dissipation = self%state%dissipation + 0.5_wp*loss
      end if
      fastest = maxval(abs(slip_rate))
      do i = 1, size(slip_rate)
         self%state%slip_direction(i) = 0
         if (abs(slip_rate(i)) > moving*fastest) self%state%slip_direction(i) = merge(1, -1, slip_rate(i) > 0.0_wp)
      end do
      call self%certificate%check_increment(self%model, self%before, self%state, present(friction_work))
      if (self%awaits_increment) call find_first_stiffness(self)
      call note_slip_zones(self)
      if (.not. self%model%moves(motion_rotation) .or. dropped > 0.0_wp) return
      associate (before => self%before%fields)
         call self%rolling%follow(self%model%interval(), [self%model%rolled(before), self%model%rolled(after)], &
                                  [self%model%slid(before), self%model%slid(after)], forces_stay(before, after))
      end associate
   end subroutine take_increment

   !> Whether the normal and the tangential force stay as they are, to round-off of the normal force.
   pure logical function forces_stay(before, after)
      type(contact_fields_type), intent(in) :: before, after
      real(wp), parameter :: round_off = 1.0e-9_wp

      forces_stay = maxval(abs(after%force(:motion_shift) - before%force(:motion_shift))) <= round_off*after%force(motion_approach)
   end function forces_stay

   !> Keep slip_zone_nodes, but for slip zones of round-off: where a cycle repeats the tractions of one before, many nodes come to
   !> their limit together at the very end.
   subroutine note_slip_zones(self)
      class(contact_path_type), intent(inout) :: self
      real(wp), parameter :: round_off = 1.0e-6_wp

      if (.not. self%model%tangential) return
      if (self%state%dissipation - self%before%dissipation > round_off*(self%state%dissipation - self%start_dissipation)) &
         self%slip_zone_nodes = max(self%slip_zone_nodes, widest_slip_zone(self%state%status))
   end subroutine note_slip_zones

   !> What the friction law remembers after an increment to the fields `after`.
   subroutine remember_slip(self, after, dropped)
      class(contact_path_type), intent(inout) :: self
      type(contact_fields_type), intent(in) :: after
      real(wp), intent(in) :: dropped
      integer :: i

      if (.not. self%has_memory()) return
      do i = 1, size(self%state%status)
         call self%model%scene%friction%law%remember(self%state%status(i), self%point(i, self%state%fields), self%point(i, after), &
                                                     dropped, self%state%memory(:, i))
      end do
   end subroutine remember_slip

   !> Where the contact has reached an end of the mesh, lengthen it. Error MFV_MESH_EXCEEDED: it may not grow.
   subroutine keep_on_mesh(self, moment, error)
      class(contact_path_type), intent(inout) :: self
      type(moment_type), intent(inout) :: moment
      type(error_type), allocatable, intent(out) :: error

      if (.not. self%model%reaches_end(in_contact(self%state%status))) return
      if (self%model%growing) then
         call self%widen(moment)
      else
         call self%end_here(MFV_MESH_EXCEEDED, 'the contact reached the end of the mesh, '// &
                            to_text(self%model%length())//' from the pole', error)
      end if
   end subroutine keep_on_mesh

   !> Lengthen the mesh by a quarter on either side.
   subroutine widen(self, moment)
      class(contact_path_type), intent(inout) :: self
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
      moment%tries = 0
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
      class(contact_path_type), intent(inout) :: self
      integer, intent(in) :: kind, node, count, step

      call self%history%append(self%state, kind, node, count, step, self%system%solves)
   end subroutine record

   !> The statuses at this load have settled: count and record what changed them.
   subroutine keep_settled(self, segment, moment)
      class(contact_path_type), intent(inout) :: self
      type(segment_type), intent(in) :: segment
      type(moment_type), intent(in) :: moment

      if (moment%event == event_none) return
      self%events = self%events + 1
      if (self%record_events) call self%record(moment%event, moment%node, moment%count, segment%step)
   end subroutine keep_settled

   !> The load at the part `done` of its way.
   elemental type(load_type) function at_part(load, done)
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

   !> Nothing consistent leads on from here, and why.
   subroutine no_continuation(self, why, error)
      class(contact_path_type), intent(in) :: self
      character(*), intent(in) :: why
      type(error_type), allocatable, intent(out) :: error

      character(:), allocatable :: hint

      hint = ''
      if (self%model%scene%friction%acts()) &
         hint = trim(self%model%scene%friction%law%explain_failure(self%model%compliance%modulus/self%model%interval()))
      call self%end_here(MFV_NO_CONTINUATION, 'no admissible continuation: '//why//hint, error)
   end subroutine no_continuation

   !> An early end: why, and the load and contact now.
   subroutine end_here(self, status, why, error)
      class(contact_path_type), intent(in) :: self
      integer, intent(in) :: status
      character(*), intent(in) :: why
      type(error_type), allocatable, intent(out) :: error

      call set_error(error, status, why//' (normal force '//to_text(self%state%fields%force(motion_approach), 10)// &
                     ', tangential force '//to_text(self%state%fields%force(motion_shift), 10)//', '// &
                     to_text(self%state%contact_nodes())//' nodes in contact, '//to_text(self%state%stick_nodes())//' stuck)')
   end subroutine end_here

end module mfv_contact_path
