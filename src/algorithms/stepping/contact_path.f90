!> The path of a contact through its load history: the model, the present state, and what all algorithms share: starting a segment,
!> holding undetermined motions, changing statuses, recording.
module mfv_contact_path
   use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
   use mfv_certificate, only: certificate_type
   use mfv_compliance, only: block_wt
   use mfv_contact_fields, only: contact_fields_type
   use mfv_contact_model, only: adapt_model, contact_model_type
   use mfv_contact_state, only: contact_state_type, new_contact_state
   use mfv_contact_system
   use mfv_derivatives, only: derivatives_type, parameter_type
   use mfv_error, only: error_type, set_error
   use mfv_friction_law, only: friction_event_type, friction_point_type, most_events
   use mfv_history, only: history_type
   use mfv_inequalities, only: status_after
   use mfv_kinds, only: wp
   use mfv_linear_solvers, only: choose_stepping, new_contact_system
   use mfv_motions, only: motions, motion_count, motion_approach, motion_shift, motion_rotation, motion_interference, motion_wear, &
                          control_force, control_displacement
   use mfv_near_field, only: near_field_type
   use mfv_node_status
   use mfv_observer, only: observer_type
   use mfv_recent_intervals, only: recent_intervals_type
   use mfv_rolling, only: rolling_type
   use mfv_scene, only: algorithm_mfv, stepping_event, stepping_leap
   use mfv_slip_zones, only: widest_slip_zone
   use mfv_status
   use mfv_strings, only: to_text
   use mfv_tolerances, only: certified, rounding, significant, visible
   implicit none
   private
   public :: contact_path_type, path_record_type, path_position_type, saved_path_type, new_contact_path, segment_type, &
             iteration_type, note_change, first_true

   !> A load segment: a linear change of the controlled loads.
   type :: segment_type
      type(load_type) :: load(motion_count) = initial_loads
      logical :: friction = .true.
      !> Number of this segment, number of segments, and the step that it belongs to; for records and progress.
      integer :: number = 1, segments = 1, step = 1
      !> Relative errors that iterative solvers may leave (constraints_type).
      real(wp) :: allowed = 0.0_wp, allowed_in_rates = 0.0_wp
      !> Start and end as fractions of the whole segment that this one belongs to; for progress.
      real(wp) :: from = 0.0_wp, to = 1.0_wp
   end type segment_type

   !> The first increment after a turning point of the tangential load, whatever the segments that follow it one way.
   type :: leaving_type
      !> Tangential stiffness, force/length^2. NaN: not yet known (`pending`), or not defined (nominal load steps, large
      !> increments whose rates at the start are not known).
      real(wp) :: stiffness = 0.0_wp
      !> Tangential force and shift at the turning point; the control of the load, negative where it decreases, 0: it is held.
      real(wp) :: force = 0.0_wp, shift = 0.0_wp
      integer :: direction = 0
      logical :: pending = .false.
   end type leaving_type

   !> What a contact carries along besides its state, of a fixed size: restart files have it whole.
   type :: path_record_type
      type(certificate_type) :: certificate
      !> Events so far: loads at which statuses changed.
      integer :: events = 0
      !> Trial length of the next increment where friction is not linear, as a fraction of a segment; 0: not yet known.
      real(wp) :: trial = 0.0_wp
      type(leaving_type) :: leaving
      !> Rolling of the bodies on each other.
      type(rolling_type) :: rolling
      !> Nodes of the widest slip zone that has dissipated in this segment, see mfv_slip_zones.
      integer :: slip_zone_nodes = 0
      !> Work of the force of every motion so far, per unit thickness: force. Over a cycle it is the area of the loop of force and
      !> motion.
      real(wp) :: work(motion_count) = 0.0_wp
      !> Estimated error of these works by large increments over the accuracy, force: the dissipation that it would be accurate for.
      real(wp) :: work_error = 0.0_wp
   end type path_record_type

   !> The position of a contact on its path: all but the model, the linear solver and the history records.
   type, extends(path_record_type) :: path_position_type
      type(contact_state_type) :: state
      !> Derivatives with respect to the parameters of the path; not allocated if there are none.
      type(derivatives_type), allocatable :: derivatives
   end type path_position_type

   type, extends(path_position_type) :: contact_path_type
      type(contact_model_type) :: model
      class(contact_system_type), allocatable :: system
      !> The state before the last increment.
      type(contact_state_type) :: before
      type(parameter_type), allocatable :: parameters(:)
      type(history_type) :: history
      !> Large increments: first guesses for intervals that repeat.
      type(recent_intervals_type) :: recent
      !> Whether every event is recorded, or only what the caller records.
      logical :: record_events = .true.
      !> Dissipation at the start of the segment, force.
      real(wp), private :: start_dissipation = 0.0_wp
   contains
      procedure :: copy_without_history
      procedure :: differentiate
      procedure :: save_to
      procedure :: restore
      procedure :: notify
      procedure :: note_start
      procedure :: note_stiffness
      procedure :: begin_motion
      procedure :: begin_wear
      procedure :: wear_at_once
      procedure :: end_wear
      procedure :: record
      procedure :: switch_friction
      procedure :: find_constraints
      procedure :: loads_at
      procedure :: has_over_stress
      procedure :: is_releasing
      procedure :: point
      procedure :: find_events
      procedure :: can_become_unstable
      procedure :: remember_status
      procedure :: begin_stress_drop
      procedure :: set_rows
      procedure :: set_status
      procedure :: separate
      procedure :: holding
      procedure :: take_increment
      procedure :: record_changes
      procedure :: record_increment
      procedure :: extend_mesh_if_reached
      procedure :: widen
      procedure :: lengthens_for
      procedure :: half_width
      procedure :: no_continuation
      procedure :: not_converged
      procedure :: end_here
      procedure :: close_nearest
   end type contact_path_type

   !> A saved position, with the sizes of the history and the mesh and the modelled problem at that time. The linear solver may be
   !> omitted: it then goes on without what it has stored.
   type :: saved_path_type
      type(path_position_type) :: position
      class(contact_system_type), allocatable :: system
      type(solver_work_type) :: work
      type(recent_intervals_type) :: recent
      integer :: records = 0, added = 0
      logical :: tangential = .false., moves(motion_count) = .false.
   end type saved_path_type

   !> The iteration of statuses at one load.
   type :: iteration_type
      !> Status sets tried at this load, shape (nodes, at least `tries`).
      integer, allocatable :: tried(:, :)
      integer :: tries = 0
      !> Rates below this fraction of the largest count as zero.
      real(wp) :: rate_tolerance = 1.0e-12_wp
      !> Whether one node changes at a time, after cycling.
      logical :: one_at_a_time = .false.
      !> Whether stress drops have begun at this load, and whether the rates of all nodes have been solved for.
      logical :: dropped = .false., solved = .false.
      !> First change at this load: event, node, and number of nodes that changed with it.
      integer :: event = event_none, node = 0, count = 0
   end type iteration_type

contains

   !> An unloaded contact; the bodies just touch.
   subroutine new_contact_path(model, record_events, self)
      type(contact_model_type), intent(in) :: model
      logical, intent(in) :: record_events
      type(contact_path_type), intent(out) :: self

      self%model = model
      call choose_stepping(self%model)
      call new_contact_system(self%model, self%system)
      self%state = new_contact_state(model%nodes(), model%scene%wear%acts())
      associate (fields => self%state%fields)
         fields%motion(motion_approach) = model%nearest_approach(model%initial_gap)
         ! Without tractions, displacements are those by motions.
         fields%normal = fields%normal - model%rigid_normal(fields)
         fields%tangential = fields%tangential - model%rigid_tangential(fields)
      end associate
      call self%certificate%find_applicable(model)
      self%record_events = record_events
   end subroutine new_contact_path

   !> Derive with respect to `parameters` from now on, through every event. Keys: only before the first step.
   subroutine differentiate(self, parameters)
      class(contact_path_type), intent(inout) :: self
      type(parameter_type), intent(in) :: parameters(:)

      if (allocated(self%parameters)) deallocate (self%parameters)
      if (allocated(self%derivatives)) deallocate (self%derivatives)
      if (size(parameters) == 0) return
      allocate (self%parameters, source=parameters)
      allocate (self%derivatives)
      call self%derivatives%begin(self%parameters, self%model, self%state%fields)
      associate (stepping => self%model%scene%method%stepping)
         if (stepping == stepping_leap) stepping = stepping_event
      end associate
   end subroutine differentiate

   !> Derivatives of the displacements after the mesh or the problem has changed.
   subroutine refresh_derivatives(self)
      class(contact_path_type), intent(inout) :: self

      if (allocated(self%derivatives)) call self%derivatives%refresh(self%parameters, self%model, self%state%fields)
   end subroutine refresh_derivatives

   !> A copy for trial increments, without history records and derivatives.
   subroutine copy_without_history(self, copy)
      class(contact_path_type), intent(in) :: self
      type(contact_path_type), intent(out) :: copy

      copy%model = self%model
      copy%path_position_type = self%path_position_type
      if (allocated(copy%derivatives)) deallocate (copy%derivatives)
      allocate (copy%system, source=self%system)
      copy%record_events = .false.
   end subroutine copy_without_history

   !> Save the state of the contact between two segments. `with_solver`: also what the linear solver and large increments can use
   !> again.
   subroutine save_to(self, saved, with_solver)
      class(contact_path_type), intent(in) :: self
      type(saved_path_type), intent(inout) :: saved
      logical, intent(in) :: with_solver

      saved%position = self%path_position_type
      ! Explicit deallocation: gfortran 12 leaks a polymorphic component on assignment.
      if (allocated(saved%system)) deallocate (saved%system)
      if (with_solver) then
         allocate (saved%system, source=self%system)
         saved%recent = self%recent
      end if
      saved%work = self%system%solver_work_type
      saved%records = self%history%records
      saved%added = self%model%added
      saved%tangential = self%model%tangential
      saved%moves = self%model%moves
   end subroutine save_to

   !> Restore a saved state of this contact, or of one with the same scene. Later history records are dropped. The model is rebuilt
   !> if its mesh or problem has changed since.
   subroutine restore(self, saved)
      class(contact_path_type), intent(inout) :: self
      type(saved_path_type), intent(in) :: saved

      call self%history%move_nodes(saved%added - self%model%added)
      call adapt_model(self%model, saved%added, saved%tangential, saved%moves)
      self%path_position_type = saved%position
      call self%model%set_worn(self%state%worn)
      if (allocated(self%derivatives)) then
         if (.not. self%derivatives%are_of(self%parameters)) deallocate (self%derivatives)
      end if
      if (allocated(saved%system)) then
         deallocate (self%system)
         allocate (self%system, source=saved%system)
      end if
      self%system%solver_work_type = saved%work
      self%recent = saved%recent
      self%history%records = min(saved%records, self%history%records)
   end subroutine restore

   !> Notify the observer, if present, of the load at the fraction `done` of a segment. Error MFV_INTERRUPTED: it requests a stop.
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

   !> Note the start of a segment with its loads: for slip_zone_nodes, and for the stiffness on leaving a turning point.
   subroutine note_start(self, load)
      class(contact_path_type), intent(inout) :: self
      type(load_type), intent(in) :: load(motion_count)
      integer :: direction

      self%start_dissipation = self%state%dissipation
      self%slip_zone_nodes = 0
      if (.not. any(abs(load%rate) > 0.0_wp)) return
      associate (shift => load(motion_shift), fields => self%state%fields, method => self%model%scene%method)
         direction = 0
         if (abs(shift%rate) > 0.0_wp) direction = nint(sign(real(shift%control, wp), shift%rate))
         if (direction /= 0 .and. direction == self%leaving%direction) return
         self%leaving = leaving_type(ieee_value(1.0_wp, ieee_quiet_nan), fields%force(motion_shift), fields%motion(motion_shift), &
                                     direction, method%algorithm == algorithm_mfv)
      end associate
   end subroutine note_start

   !> Set the pending stiffness on leaving a turning point, if the change of the tangential force since then is more than round-off.
   !> It is undefined for a held shift. `force`, force, and `shift`, length: changes, or rates over the load segment.
   subroutine note_stiffness(self, force, shift)
      class(contact_path_type), intent(inout) :: self
      real(wp), intent(in) :: force, shift

      if (.not. self%leaving%pending) return
      if (.not. abs(force) > self%model%friction_scale*max(visible*self%state%fields%force(motion_approach), &
                                                           certified*self%certificate%force_scale(motion_approach))) return
      self%leaving%pending = .false.
      if (abs(force) < self%model%largest_stiffness()*abs(shift)) self%leaving%stiffness = force/shift
   end subroutine note_stiffness

   !> Switch friction on or off at the nodes in contact. The first friction starts the tangential problem. Error
   !> MFV_INADMISSIBLE_STEP: friction is switched off under shear traction.
   subroutine switch_friction(self, segment, error)
      class(contact_path_type), intent(inout) :: self
      type(segment_type), intent(in) :: segment
      type(error_type), allocatable, intent(out) :: error
      integer :: status(size(self%state%status))

      if (segment%friction .and. self%model%scene%friction%acts()) then
         if (.not. self%model%tangential .or. any(self%state%status == node_frictionless)) call begin_tangential(self)
         call self%set_status(self%state%status == node_frictionless, self%holding(self%state%fields%shear))
         return
      end if
      if (any(abs(self%state%fields%shear) > certified*self%certificate%traction_scale)) then
         call self%end_here(MFV_INADMISSIBLE_STEP, 'friction cannot be switched off while there is shear traction; '// &
                            'keep friction on in this step', error)
         return
      end if
      status = node_frictionless
      call self%set_status(in_contact(self%state%status), status)
   end subroutine switch_friction

   !> Start the tangential problem from the present pressures, if it is not modelled yet.
   subroutine begin_tangential(self)
      class(contact_path_type), intent(inout) :: self
      real(wp) :: normal(self%model%nodes())

      if (.not. self%model%tangential) call self%model%add_tangential()
      call self%certificate%find_applicable(self%model)
      call self%model%relative_displacements(self%state%fields, normal, self%state%fields%tangential)
      call refresh_derivatives(self)
   end subroutine begin_tangential

   !> Model a motion from now on; its force is the resultant of the present tractions.
   subroutine begin_motion(self, motion)
      class(contact_path_type), intent(inout) :: self
      integer, intent(in) :: motion

      if (self%model%moves(motion)) return
      self%model%moves(motion) = .true.
      call self%certificate%find_applicable(self%model)
      associate (fields => self%state%fields)
         fields%force(motion) = self%model%resultant(motion, fields%pressure, fields%shear)
      end associate
   end subroutine begin_motion

   !> Begin to wear the surfaces by `depth`, length, shape (nodes), while the motion motion_wear goes from 0 to 1.
   subroutine begin_wear(self, depth)
      class(contact_path_type), intent(inout) :: self
      real(wp), intent(in) :: depth(:)

      call self%model%begin_wear(depth)
      call self%begin_motion(motion_wear)
      associate (fields => self%state%fields)
         fields%force(motion_wear) = self%model%resultant(motion_wear, fields%pressure, fields%shear)
      end associate
   end subroutine begin_wear

   !> Wear separated surfaces: only the gaps change.
   subroutine wear_at_once(self)
      class(contact_path_type), intent(inout) :: self

      self%state%fields%motion(motion_wear) = 1.0_wp
      call self%model%displace(self%state%fields)
   end subroutine wear_at_once

   !> Make the present wear part of the gaps.
   subroutine end_wear(self)
      class(contact_path_type), intent(inout) :: self

      associate (fields => self%state%fields, wear => self%model%wear)
         fields%normal = fields%normal - fields%motion(motion_wear)*wear
         self%state%worn = self%state%worn + fields%motion(motion_wear)*wear
         fields%motion(motion_wear) = 0.0_wp
         fields%force(motion_wear) = 0.0_wp
         wear = 0.0_wp
      end associate
      call self%model%set_worn(self%state%worn)
   end subroutine end_wear

   !> The prescribed loads at the fraction `done` of the segment, and the errors that it allows.
   subroutine loads_at(self, segment, done, constraints)
      class(contact_path_type), intent(in) :: self
      type(segment_type), intent(in) :: segment
      real(wp), intent(in) :: done
      type(constraints_type), intent(inout) :: constraints

      constraints%load = load_at(segment%load, done)
      constraints%allowed = segment%allowed
      constraints%allowed_in_rates = segment%allowed_in_rates
   end subroutine loads_at

   !> The constraints at the fraction `done` of the segment. Motions that the present contact does not determine are held: the
   !> shift without friction, all motions without contact, the rotation with fewer than two nodes in contact.
   !> `ready`: false if statuses changed here and the constraints must be determined again.
   !> Error MFV_GROSS_SLIDING: friction cannot balance the tangential force.
   subroutine find_constraints(self, segment, done, iteration, constraints, ready, error)
      class(contact_path_type), intent(inout) :: self
      type(segment_type), intent(in) :: segment
      real(wp), intent(in) :: done
      type(iteration_type), intent(inout) :: iteration
      type(constraints_type), intent(inout) :: constraints
      logical, intent(out) :: ready
      type(error_type), allocatable, intent(out) :: error
      logical :: contact, slides, lifted, relaxing
      integer :: i

      ready = .true.
      call self%loads_at(segment, done, constraints)
      relaxing = self%has_over_stress()
      if (relaxing) constraints%load%rate = 0.0_wp
      call self%set_rows(constraints, relaxing)
      contact = any(in_contact(self%state%status))
      if (.not. contact .and. constraints%load(motion_approach)%control == control_force) then
         if (constraints%load(motion_approach)%rate > 0.0_wp .or. (self%model%scene%is_neat() .and. presses(constraints))) then
            call self%close_nearest(segment, iteration)
            ready = .false.
            return
         end if
         constraints%load(motion_approach) = load_type(control_displacement, self%state%fields%motion(motion_approach), 0.0_wp)
      end if

      constraints%one_by_one = .true.
      slides = .not. any(holds(self%state%status))
      ! Where normals of slipping nodes are inclined, pressure determines the shift.
      lifted = self%model%lifts(motion_shift) .and. any(slips(self%state%status)) .and. self%state%contact_nodes() > 1
      if (slides .and. .not. lifted .and. constraints%load(motion_shift)%control == control_force) then
         call hold_motion(self, constraints, motion_shift, ready, error)
         if (allocated(error) .or. .not. ready) return
      end if
      do i = 1, motion_count
         if (.not. (motions(i)%optional .and. self%model%moves(i)) .or. constraints%load(i)%control /= control_force) cycle
         call hold_if_undetermined(self, i, slides, constraints, ready, error)
         if (allocated(error) .or. .not. ready) return
      end do
   end subroutine find_constraints

   !> Whether a force that is to change, in whatever direction, or a growing interference would press a neat fit together.
   pure logical function presses(constraints)
      type(constraints_type), intent(in) :: constraints

      associate (load => constraints%load([motion_approach, motion_shift]))
         presses = any(load%control == control_force .and. abs(load%rate) > 0.0_wp) .or. &
                   constraints%load(motion_interference)%rate > 0.0_wp
      end associate
   end function presses

   !> Hold a motion with a prescribed force (such as the rotation under a moment) if nothing determines it: with fewer than two
   !> nodes in contact, where only a zero force is possible; or if no node sticks and the motion only slides.
   !> Errors MFV_NO_CONTINUATION: the moment tips the upper body over; MFV_GROSS_SLIDING.
   subroutine hold_if_undetermined(self, motion, slides, constraints, ready, error)
      class(contact_path_type), intent(inout) :: self
      integer, intent(in) :: motion
      logical, intent(in) :: slides
      type(constraints_type), intent(inout) :: constraints
      logical, intent(inout) :: ready
      type(error_type), allocatable, intent(out) :: error
      real(wp) :: scale

      if (self%state%contact_nodes() < 2) then
         associate (load => constraints%load(motion), model => self%model)
            scale = model%compliance%modulus*(model%length()*model%unit_of_arm(motion))
            if (max(abs(load%value), abs(load%rate), abs(self%state%fields%force(motion) - load%value)) > rounding*scale) then
               if (model%lifts(motion)) then
                  call no_continuation(self, 'fewer than two nodes are in contact; the '//trim(motions(motion)%force_name)// &
                                       ' tips the upper body over', error)
               else
                  call self%end_here(MFV_SEPARATED, 'the bodies are not pressed together; nothing balances the '// &
                                     trim(motions(motion)%force_name), error)
               end if
            end if
         end associate
         constraints%load(motion) = load_type(control_displacement, self%state%fields%motion(motion), 0.0_wp)
      else if (slides .and. .not. self%model%lifts(motion)) then
         call hold_motion(self, constraints, motion, ready, error)
      end if
   end subroutine hold_if_undetermined

   !> No node is stuck and the force of a sliding motion is prescribed, so that no equation determines the motion. Hold it where
   !> friction balances the force anyway: without friction, without contact, or with equal slip to both sides. Otherwise the nodes
   !> that slip with the unbalanced force stick first (`ready` is then false).
   !> Error MFV_GROSS_SLIDING: there are no such nodes; every contact node is at its sliding limit.
   subroutine hold_motion(self, constraints, motion, ready, error)
      class(contact_path_type), intent(inout) :: self
      type(constraints_type), intent(inout) :: constraints
      integer, intent(in) :: motion
      logical, intent(inout) :: ready
      type(error_type), allocatable, intent(out) :: error
      real(wp), parameter :: nothing = 1.0e-12_wp, tolerance_factor = 10.0_wp
      type(constraints_type) :: trial
      type(response_type) :: response
      real(wp) :: wanted, missing, scale, arm, negligible, none
      logical :: pressed
      logical :: yielding(size(self%state%status)), singular
      integer :: i

      wanted = constraints%load(motion)%rate
      none = max(nothing, tolerance_factor*self%system%tolerance)
      constraints%load(motion) = load_type(control_displacement, self%state%fields%motion(motion), 0.0_wp)
      arm = self%model%unit_of_arm(motion)
      negligible = none*self%certificate%force_scale(motion_approach)*arm
      pressed = self%model%force(self%state%fields%pressure) > none*self%certificate%force_scale(motion_approach)
      if (.not. any(slips(self%state%status))) then
         if (abs(wanted) > max(significant*self%state%fields%force(motion_approach)*arm, negligible)) &
            call self%end_here(merge(MFV_GROSS_SLIDING, MFV_SEPARATED, pressed), &
                               'no node in contact has friction to balance the '//trim(motions(motion)%force_name), error)
         return
      end if
      ! Bodies about to separate: the remaining pressure is round-off.
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
         if (abs(missing) <= max(significant*scale, tolerance_factor*self%system%tolerance*scale, negligible)) return
      end if
      yielding = slips(self%state%status)
      if (.not. singular) yielding = yielding .and. &
                                     slip_sign(self%state%status)*self%model%tangential_arm(:, motion)*missing > 0.0_wp
      if (any(yielding)) then
         call self%set_status(yielding, self%holding(real(-slip_sign(self%state%status), wp)))
         ready = .false.
      else if (pressed .or. constraints%load(motion_approach)%rate > 0.0_wp) then
         call self%end_here(MFV_GROSS_SLIDING, 'gross sliding: every contact node slips', error)
      else
         call self%end_here(MFV_SEPARATED, 'the bodies are no longer pressed together; nothing balances the '// &
                            trim(motions(motion)%force_name), error)
      end if
   end subroutine hold_motion

   !> Force control without contact: move the upper body, without load, until its nearest nodes touch. Together touch nodes
   !> whose gaps agree within the round-off of the largest gap and of the displacements so far, and to a part `alike`: the gaps
   !> beside a flat tip differ by much less than that round-off, and the positions of graded meshes are less accurate than their
   !> gaps are small.
   subroutine close_nearest(self, segment, iteration)
      class(contact_path_type), intent(inout) :: self
      type(segment_type), intent(in) :: segment
      type(iteration_type), intent(inout) :: iteration
      real(wp), parameter :: alike = 1.0e-8_wp
      real(wp), dimension(self%model%nodes()) :: gap, terms, normal, tangential
      real(wp) :: smallest, round_off
      integer :: status(self%model%nodes())
      logical :: touching(self%model%nodes())

      gap = self%model%gap(self%state%fields)
      self%state%fields%motion(motion_approach) = self%state%fields%motion(motion_approach) + self%model%nearest_approach(gap)
      call self%model%relative_displacements(self%state%fields, normal, tangential)
      self%state%fields%normal = normal
      if (self%model%tangential) self%state%fields%tangential = tangential
      gap = self%model%gap(self%state%fields)
      if (allocated(self%derivatives)) call self%derivatives%touch(self%model, minloc(gap, mask=self%model%can_touch, dim=1))
      call refresh_derivatives(self)
      smallest = minval(gap, mask=self%model%can_touch)
      round_off = 8*epsilon(1.0_wp)*max(maxval(abs(self%model%initial_gap)), abs(self%state%fields%motion(motion_approach)), &
                                        self%certificate%normal)
      terms = self%model%gap_terms(self%state%fields)
      touching = self%model%can_touch .and. gap - smallest <= min(round_off, alike*terms)
      status = status_after(event_close, node_open, segment%friction .and. self%model%tangential, 0, &
                            self%holding(self%state%fields%shear))
      call note_change(iteration, event_close, touching)
      call self%set_status(touching, status)
   end subroutine close_nearest

   !> Whether the over-stress of some node must relax before the load continues.
   pure logical function has_over_stress(self)
      class(contact_path_type), intent(in) :: self

      has_over_stress = has_memory(self)
      if (has_over_stress) has_over_stress = any(self%is_releasing())
   end function has_over_stress

   !> Nodes whose over-stress must relax.
   pure function is_releasing(self)
      class(contact_path_type), intent(in) :: self
      logical :: is_releasing(size(self%state%status))
      integer :: i

      is_releasing = .false.
      if (.not. has_memory(self)) return
      do i = 1, size(is_releasing)
         is_releasing(i) = self%model%scene%friction%law%is_releasing(self%state%memory(:, i))
      end do
   end function is_releasing

   !> The state of node `node` for the friction law, with the given fields.
   pure function point(self, node, fields)
      class(contact_path_type), intent(in) :: self
      integer, intent(in) :: node
      type(contact_fields_type), intent(in) :: fields
      type(friction_point_type) :: point

      point = self%state%friction_point(fields, node, self%model%static_friction(node), self%model%kinetic_friction(node))
   end function point

   !> Whether the friction law has memory.
   pure logical function has_memory(self)
      class(contact_path_type), intent(in) :: self

      has_memory = .false.
      if (allocated(self%model%scene%friction%law)) has_memory = self%model%scene%friction%law%has_memory
   end function has_memory

   !> Events of the friction law in an increment with the expected end `after`, shape (most_events, nodes); not allocated for laws
   !> without events.
   subroutine find_events(self, after, events)
      class(contact_path_type), intent(in) :: self
      type(contact_fields_type), intent(in) :: after
      type(friction_event_type), allocatable, intent(out) :: events(:, :)
      integer :: i

      if (.not. self%model%scene%friction%acts()) return
      associate (law => self%model%scene%friction%law)
         if (.not. law%has_events) return
         allocate (events(most_events, size(self%state%status)))
         do i = 1, size(self%state%status)
            call law%find_events(self%state%status(i), self%point(i, self%state%fields), self%point(i, after), events(:, i))
         end do
      end associate
   end subroutine find_events

   !> Nodes that may have no equilibrium nearby once they slip.
   pure function can_become_unstable(self) result(unstable)
      class(contact_path_type), intent(in) :: self
      logical :: unstable(size(self%state%status))
      integer :: i

      unstable = .false.
      if (.not. has_memory(self)) return
      do i = 1, size(unstable)
         unstable(i) = self%model%scene%friction%law%can_become_unstable(self%state%status(i), self%point(i, self%state%fields))
      end do
   end function can_become_unstable

   !> Begin stress drops, where an increment has no solution or all statuses have been tried: nodes that may have no equilibrium
   !> nearby once they slip (can_become_unstable) slip in the direction of their shear, and their over-stress must relax before the
   !> load continues. `dropped`: whether there are any.
   subroutine begin_stress_drop(self, iteration, dropped)
      class(contact_path_type), intent(inout) :: self
      type(iteration_type), intent(inout) :: iteration
      logical, intent(out) :: dropped
      logical :: mask(size(self%state%status))
      integer :: status(size(self%state%status)), i

      mask = self%can_become_unstable()
      dropped = any(mask)
      if (.not. dropped) return
      status = merge(node_slip_left, node_slip_right, self%state%fields%shear > 0.0_wp)
      call note_change(iteration, merge(event_slip_left, event_slip_right, status(first_true(mask)) == node_slip_left), mask)
      call self%set_status(mask, status)
      do i = 1, size(mask)
         if (mask(i)) call self%model%scene%friction%law%release(self%point(i, self%state%fields), self%state%memory(:, i))
      end do
   end subroutine begin_stress_drop

   !> Statuses and friction lines as constraints: tangents; or lines linearised about the expected fields `after`; or, if `secants`
   !> is present, the secants to these. `relaxing`: whether over-stress relaxes, by all of it per unit of load.
   subroutine set_rows(self, constraints, relaxing, after, secants)
      class(contact_path_type), intent(in) :: self
      type(constraints_type), intent(inout) :: constraints
      logical, intent(in) :: relaxing
      type(contact_fields_type), intent(in), optional :: after
      logical, intent(in), optional :: secants
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
         if (present(secants)) then
            constraints%row(i) = self%model%scene%friction%law%secant(self%state%status(i), here, there)
         else
            constraints%row(i) = self%model%scene%friction%law%row(self%state%status(i), here, there)
         end if
         if (relaxing) constraints%offset_rate(i) = slip_sign(self%state%status(i)) &
                                                    *self%model%scene%friction%law%release_rate(self%state%memory(:, i))
      end do
   end subroutine set_rows

   !> Set the statuses of the nodes of `mask` and update the memory of friction.
   subroutine set_status(self, mask, status)
      class(contact_path_type), intent(inout) :: self
      logical, intent(in) :: mask(:)
      integer, intent(in) :: status(:)
      integer :: i

      if (has_memory(self)) then
         do i = 1, size(mask)
            if (mask(i)) call self%model%scene%friction%law%change_status(self%state%status(i), status(i), &
                                                                          self%point(i, self%state%fields), self%state%memory(:, i))
         end do
      end if
      if (allocated(self%derivatives)) then
         do i = 1, size(mask)
            if (mask(i) .and. status(i) == node_stick .and. self%state%status(i) /= node_stick) call self%derivatives%note_stuck(i)
         end do
      end if
      call self%state%set_status(mask, status)
   end subroutine set_status

   !> Open all nodes if their pressures are round-off: from here contact begins anew. (A pin in a bore can have pressures without a
   !> normal force. Derivatives are followed through these nodes.)
   subroutine separate(self)
      class(contact_path_type), intent(inout) :: self

      if (allocated(self%derivatives)) return
      if (any(abs(self%state%fields%pressure) > certified*self%certificate%traction_scale)) return
      call self%set_status(in_contact(self%state%status), spread(node_open, 1, size(self%state%status)))
      self%state%fields%pressure = 0.0_wp
      self%state%fields%shear = 0.0_wp
   end subroutine separate

   !> Set the memory of the nodes of `mask` as if they had slipped until now.
   subroutine remember_status(self, mask)
      class(contact_path_type), intent(inout) :: self
      logical, intent(in) :: mask(:)
      integer :: i

      if (.not. has_memory(self)) return
      do i = 1, size(mask)
         if (mask(i)) call self%model%scene%friction%law%change_status(node_slip_right, self%state%status(i), &
                                                                       self%point(i, self%state%fields), self%state%memory(:, i))
      end do
   end subroutine remember_status

   !> The status of each node if it holds, with the given slip rates (any unit), shape (nodes).
   pure function holding(self, slip_rate) result(status)
      class(contact_path_type), intent(in) :: self
      real(wp), intent(in) :: slip_rate(:)
      integer :: status(size(slip_rate))
      integer :: i

      status = node_stick
      if (.not. allocated(self%model%scene%friction%law)) return
      if (self%model%scene%friction%law%sticks) return
      do i = 1, size(status)
         status(i) = self%model%scene%friction%law%holding_status(merge(-1, 1, slip_rate(i) < 0.0_wp))
      end do
   end function holding

   !> Advance to the fields `after`; update memory, dissipation, slip directions and certificate. `slip_rate`: any unit, shape
   !> (nodes). `dropped`: the fraction of the over-stress that has relaxed. `friction_work`: dissipation of a large increment,
   !> force/length, shape (nodes); if absent, all fields are linear over the increment.
   subroutine take_increment(self, after, slip_rate, dropped, friction_work)
      class(contact_path_type), intent(inout) :: self
      type(contact_fields_type), intent(in) :: after
      real(wp), intent(in) :: slip_rate(:), dropped
      real(wp), intent(in), optional :: friction_work(:)
      real(wp) :: loss, part, fastest
      integer :: i

      call self%before%copy_from(self%state)
      call remember_slip(self, after, dropped)
      call self%state%fields%copy_from(after)
      do i = 1, motion_count
         if (.not. self%model%moves(i)) self%state%fields%force(i) = self%model%resultant(i, after%pressure, after%shear)
      end do
      associate (before => self%before%fields, now => self%state%fields)
         self%work = self%work + 0.5_wp*(before%force + now%force)*(now%motion - before%motion)
      end associate
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
      if (self%model%scene%wear%acts()) call self%state%add_cycle_work(self%before)
      fastest = maxval(abs(slip_rate))
      do i = 1, size(slip_rate)
         self%state%slip_direction(i) = 0
         if (abs(slip_rate(i)) > significant*fastest) self%state%slip_direction(i) = merge(1, -1, slip_rate(i) > 0.0_wp)
      end do
      call self%certificate%check_increment(self%model, self%before, self%state, present(friction_work))
      if (present(friction_work)) self%leaving%pending = .false.
      associate (fields => self%state%fields, leaving => self%leaving)
         call self%note_stiffness(fields%force(motion_shift) - leaving%force, fields%motion(motion_shift) - leaving%shift)
      end associate
      call note_slip_zones(self)
      if (.not. self%model%moves(motion_rotation) .or. dropped > 0.0_wp) return
      associate (before => self%before%fields)
         call self%rolling%follow(self%model%interval(), [self%model%rolled(before), self%model%rolled(after)], &
                                  [self%model%slid(before), self%model%slid(after)], forces_stay(before, after))
      end associate
   end subroutine take_increment

   !> Whether the normal and the tangential force are constant, up to round-off of the normal force.
   pure logical function forces_stay(before, after)
      type(contact_fields_type), intent(in) :: before, after

     forces_stay = maxval(abs(after%force(:motion_shift) - before%force(:motion_shift))) <= significant*after%force(motion_approach)
   end function forces_stay

   !> Update slip_zone_nodes, except by slip zones of round-off: in a repeated cycle many nodes reach their limit together at the
   !> very end.
   subroutine note_slip_zones(self)
      class(contact_path_type), intent(inout) :: self

      if (.not. self%model%tangential) return
      if (self%state%dissipation - self%before%dissipation > visible*(self%state%dissipation - self%start_dissipation)) &
         self%slip_zone_nodes = max(self%slip_zone_nodes, widest_slip_zone(self%state%status))
   end subroutine note_slip_zones

   !> Update the memory of friction after an increment to the fields `after`.
   subroutine remember_slip(self, after, dropped)
      class(contact_path_type), intent(inout) :: self
      type(contact_fields_type), intent(in) :: after
      real(wp), intent(in) :: dropped
      integer :: i

      if (.not. has_memory(self)) return
      do i = 1, size(self%state%status)
         call self%model%scene%friction%law%remember(self%state%status(i), self%point(i, self%state%fields), self%point(i, after), &
                                                     dropped, self%state%memory(:, i))
      end do
   end subroutine remember_slip

   !> Lengthen the mesh if the contact has reached its end. Error MFV_MESH_EXCEEDED: it may not grow.
   subroutine extend_mesh_if_reached(self, iteration, error)
      class(contact_path_type), intent(inout) :: self
      type(iteration_type), intent(inout) :: iteration
      type(error_type), allocatable, intent(out) :: error
      logical :: too_short

      if (.not. self%model%reaches_end(in_contact(self%state%status))) return
      associate (model => self%model)
         too_short = .not. model%growing .or. (model%spare_nodes() == 0 .and. model%scene%mesh%half_width > 0.0_wp)
      end associate
      if (.not. too_short) then
         call self%widen(iteration)
      else
         call self%end_here(MFV_MESH_EXCEEDED, 'the contact reached the end of the mesh, '// &
                            to_text(self%model%length())//' from the origin of x', error)
      end if
   end subroutine extend_mesh_if_reached

   !> Whether the mesh has been lengthened for a contact (`contact`, shape (nodes)) that would reach its end.
   logical function lengthens_for(self, contact)
      class(contact_path_type), intent(inout) :: self
      logical, intent(in) :: contact(:)
      type(iteration_type) :: iteration
      integer :: nodes

      lengthens_for = self%model%reaches_end(contact) .and. self%model%growing
      if (.not. lengthens_for) return
      nodes = self%model%nodes()
      call self%widen(iteration)
      lengthens_for = self%model%nodes() > nodes
   end function lengthens_for

   !> Lengthen the mesh by a quarter on either side.
   subroutine widen(self, iteration)
      class(contact_path_type), intent(inout) :: self
      type(iteration_type), intent(inout) :: iteration
      integer, parameter :: fewest = 4
      integer :: extra, n

      n = self%model%nodes()
      extra = min(max(n/4, fewest), self%model%spare_nodes())
      if (extra == 0) return
      call self%model%grow(extra)
      call self%state%widen(extra)
      call self%history%move_nodes(extra)
      if (iteration%node > 0) iteration%node = iteration%node + extra
      iteration%tries = 0
      call fill_ends(self%model, self%state%fields, extra)
      if (allocated(self%derivatives)) call self%derivatives%widen(extra)
      call refresh_derivatives(self)
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

   !> Record the end of a large increment of a segment, unless the end of the segment is recorded there.
   subroutine record_increment(self, segment, reached)
      class(contact_path_type), intent(inout) :: self
      type(segment_type), intent(in) :: segment
      real(wp), intent(in) :: reached

      if (self%record_events .and. segment%from + reached*(segment%to - segment%from) < 1.0_wp) &
         call self%record(event_increment, 0, 0, segment%step)
   end subroutine record_increment

   !> The statuses at this load are final: count and record the change.
   subroutine record_changes(self, segment, iteration)
      class(contact_path_type), intent(inout) :: self
      type(segment_type), intent(in) :: segment
      type(iteration_type), intent(in) :: iteration

      if (iteration%event == event_none) return
      self%events = self%events + 1
      if (self%record_events) call self%record(iteration%event, iteration%node, iteration%count, segment%step)
   end subroutine record_changes

   !> The load at the fraction `done` of the segment.
   elemental type(load_type) function load_at(load, done)
      type(load_type), intent(in) :: load
      real(wp), intent(in) :: done

      load_at = load_type(load%control, load%value + done*load%rate, load%rate)
   end function load_at

   !> Note the first change at a load.
   subroutine note_change(iteration, event, changing)
      type(iteration_type), intent(inout) :: iteration
      integer, intent(in) :: event
      logical, intent(in) :: changing(:)

      if (iteration%event /= event_none) return
      iteration%event = event
      iteration%node = first_true(changing)
      iteration%count = count(changing)
   end subroutine note_change

   pure integer function first_true(mask)
      logical, intent(in) :: mask(:)

      first_true = findloc(mask, .true., dim=1)
   end function first_true

   !> Half-width of the contact between its outermost nodes, length.
   pure real(wp) function half_width(self)
      class(contact_path_type), intent(in) :: self

      half_width = 0.0_wp
      associate (arc => self%model%arc, touching => in_contact(self%state%status))
         if (any(touching)) half_width = 0.5_wp*(maxval(arc, mask=touching) - minval(arc, mask=touching))
      end associate
   end function half_width

   !> Error: there is no admissible continuation, and why.
   subroutine no_continuation(self, why, error)
      class(contact_path_type), intent(in) :: self
      character(*), intent(in) :: why
      type(error_type), allocatable, intent(out) :: error
      character(:), allocatable :: hint

      hint = ''
      associate (friction => self%model%scene%friction)
         if (friction%acts()) hint = trim(friction%law%explain_failure(self%model%compliance%modulus/self%model%interval()))
         if (hint == '' .and. friction%acts()) hint = trim(hint_of_jamming(self))
         if (hint == '' .and. .not. friction%is_linear()) hint = '; another friction_tolerance in &solver may find one'
      end associate
      call self%end_here(MFV_NO_CONTINUATION, 'no admissible continuation: '//why//hint, error)
   end subroutine no_continuation

   !> On oblique anisotropic bodies slip to one side raises the pressure. Where A - mu |M| of mfv_near_field is negative, friction
   !> grows by more than the shear that it resists, on any mesh.
   pure function hint_of_jamming(self) result(hint)
      class(contact_path_type), intent(in) :: self
      character(len=240) :: hint
      type(near_field_type) :: pair

      hint = ''
      pair = self%model%scene%near_field()
      if (.not. self%model%compliance%elastic_block(block_wt)) return
      if (self%model%scene%friction%static%largest()*abs(pair%mixed) < pair%normal .or. .not. pair%normal > 0.0_wp) return
      hint = '; mu times contact_mixed_ratio of these oblique bodies is '// &
             to_text(self%model%scene%friction%static%largest()*pair%mixed/pair%normal, 3)// &
             ': beyond 1 in magnitude slip to one side jams, and no mesh helps'
   end function hint_of_jamming

   !> Error: the iteration of the linear solver failed, and no other solver can take over.
   subroutine not_converged(self, error)
      class(contact_path_type), intent(in) :: self
      type(error_type), allocatable, intent(out) :: error

      call self%end_here(MFV_NOT_CONVERGED, 'not converged: the iteration of the linear solver fails; use linear_solver='// &
                         '''reduced'' in &solver', error)
   end subroutine not_converged

   !> Error with the reason and the present load and contact.
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
