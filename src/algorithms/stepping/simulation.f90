!> A scene led through its load history: steps, their reversals, the state at the end of each, and how it all ended.
module mfv_simulation
   use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
   use, intrinsic :: iso_fortran_env, only: int64, int8
   use mfv_checksum, only: add_to_checksum
   use mfv_contact_model, only: new_contact_model
   use mfv_contact_state, only: contact_state_type
   use mfv_contact_system, only: initial_loads, load_type
   use mfv_cycle, only: append_cycle, cycle_type, new_turning_point
   use mfv_error, only: error_type
   use mfv_contact_path, only: contact_path_type, new_contact_path, path_position_type, segment_type
   use mfv_conventional, only: lead_conventionally
   use mfv_error_bar, only: error_estimate_type
   use mfv_kinds, only: wp
   use mfv_leap, only: lead_by_leaps
   use mfv_load_way, only: load_way_type
   use mfv_motions, only: motion_count, control_keep, control_force, arm_unit
   use mfv_node_status, only: event_none, event_step_end, event_stopped
   use mfv_observer, only: observer_type
   use mfv_scene
   use mfv_slip_zones, only: segment_start_type, slip_record_type
   use mfv_status, only: MFV_COMPLETE
   use mfv_straight, only: lead_straight
   use mfv_strings, only: to_text
   implicit none
   private
   public :: simulation_type, position_type, restart_type, new_simulation, snapshot_type, sensitivity_type, history_events, &
             history_steps, history_none
   public :: states_reversals, states_steps, states_none
   public :: mark_loading, mark_reversal, mark_return, mark_cycle_start, mark_count

   !> What the load history keeps: a record an event, a record a step end, nothing.
   integer, parameter :: history_events = 1, history_steps = 2, history_none = 3
   !> Of which states a snapshot is kept: at the ends of steps and of every reversal of a step with cycles, of steps alone, none.
   integer, parameter :: states_reversals = 1, states_steps = 2, states_none = 3

   !> States that the last step with cycles leaves: where the step began, the far end of its last whole cycle, the end of that
   !> (with `reversal` 0 while there is none: where the step began), and its start.
   integer, parameter :: mark_loading = 1, mark_reversal = 2, mark_return = 3, mark_cycle_start = 4
   !> The far end of the cycle that is not whole yet; and how many marks there are.
   integer, parameter :: mark_pending = 5, mark_count = 5

   !> The state at the end of a step, or of one reversal of a step with cycles.
   type :: snapshot_type
      type(contact_state_type) :: state
      !> Number of the step, and of the reversal in it (1 for a step without cycles).
      integer :: step = 0, reversal = 0
      !> Nodes added to the mesh at either end when it was taken.
      integer :: added = 0
   end type snapshot_type

   !> Where a simulation stands, but for its contact and what only grows on the way.
   type :: position_type
      !> Snapshots and cycles so far, see simulation_type; and whole cycles of all steps.
      integer :: snapshot_count = 0, cycle_count = 0, cycles_done = 0
      !> See mark_loading and so on; `step` is 0 where there is none.
      type(snapshot_type) :: marks(mark_count)
      !> How it ended (see mfv_status): MFV_COMPLETE while nothing has gone wrong, and why in words.
      integer :: outcome = MFV_COMPLETE
      character(:), allocatable :: message
      !> Step that could not be reached, 0 for none; and steps done.
      integer :: failed_step = 0, steps_done = 0
      !> The same of the steps of the scene alone, which other steps may come between.
      integer :: failed_scene_step = 0, scene_steps_done = 0
      !> What is known of the slip zones of all straight segments so far.
      type(slip_record_type) :: slip
      !> What is known of the steps that were taken, the last one perhaps not to its end.
      type(load_way_type) :: way
      !> What the loads control now.
      type(load_type) :: load(motion_count) = initial_loads
   end type position_type

   !> By how much the final state changes with all coefficients of friction times 1 + `perturbation` (see mfv_sensitivity).
   type :: sensitivity_type
      !> How the perturbed run went (see mfv_status); and in words why there is nothing to compare, else empty.
      integer :: status = 0
      character(:), allocatable :: message
      real(wp) :: perturbation = 1.0e-12_wp
      !> The largest change of a pressure and of a shear traction, in parts of the largest traction; relative change of the
      !> dissipation;
      !> change of the stick ratio between nodes.
      real(wp) :: pressure = 0.0_wp, shear = 0.0_wp, dissipation = 0.0_wp, stick_ratio = 0.0_wp
   end type sensitivity_type

   !> The step that is being taken: where its loads lead and come from, its cycle, and the straight
   !> part of it that is next or under way.
   type :: leg_type
      !> 0: no step is under way.
      integer :: number = 0
      type(load_type) :: there(motion_count), back(motion_count)
      type(cycle_type) :: cycle
      type(segment_type) :: segment
      type(segment_start_type) :: start
   end type leg_type

   !> The start of a segment, from which an interrupted run continues: the contact, the records of the load history so far, the work
   !> of the linear solver so far, the segment's number in its step, the nodes added to the mesh, and what is known of the slip
   !> zones.
   type :: restart_type
      type(path_position_type) :: path
      integer :: records = 0, solves = 0, leg = 1, added = 0
      integer(int64) :: iterations = 0, products = 0
      type(slip_record_type) :: slip
      type(load_type) :: load(motion_count)
   end type restart_type

   type, extends(position_type) :: simulation_type
      type(contact_path_type) :: contact
      !> States at the end of every step and reversal so far: the first `snapshot_count` entries are in use.
      type(snapshot_type), allocatable :: snapshots(:)
      !> Whole cycles so far, the first `cycle_count` entries in use; without a load history the last one only.
      type(cycle_type), allocatable :: cycles(:)
      integer :: keep_history = history_events
      !> See states_reversals and so on.
      integer :: keep_states = states_reversals
      !> Checksums of the way up to the end of every step taken, where something is kept of it; the first `way%steps` are in use.
      integer(int64), allocatable, private :: trails(:)
      !> The discretisation error of the present state, where it has been estimated (see mfv_discretisation_error).
      type(error_estimate_type), allocatable :: estimate
      !> How much the present state depends on round-off, where that has been found out (see mfv_sensitivity).
      type(sensitivity_type), allocatable :: sensitivity
      !> The step under way.
      type(leg_type) :: leg
      !> Whether the start of each segment is kept in `restart`.
      logical :: keep_restart = .false.
      type(restart_type) :: restart
   contains
      procedure :: run
      procedure :: advance
      procedure :: has_segments_left
      procedure :: run_segment
      procedure :: note_restart
      procedure :: resume
      procedure :: trail
      procedure :: came_through
      procedure :: padded_state
      procedure :: padded
      procedure, private :: advance_segment
      procedure, private :: lead_to
      procedure, private :: begin_segment
      procedure, private :: take_snapshot
      procedure, private :: begin_cycles
      procedure, private :: end_of_leg
      procedure, private :: set_mark
      procedure, private :: change_since
      procedure, private :: note_trail
      procedure, private :: begin_step
      procedure, private :: end_step_early
   end type simulation_type

contains

   !> A simulation of a valid scene, at its start. `keep_history`: history_events, history_steps or history_none.
   !> `keep_states`: states_reversals (unless told), states_steps or states_none.
   function new_simulation(scene, keep_history, keep_states) result(self)
      type(scene_type), intent(in) :: scene
      integer, intent(in) :: keep_history
      integer, intent(in), optional :: keep_states
      type(simulation_type) :: self

      call new_contact_path(new_contact_model(scene), keep_history == history_events, self%contact)
      self%keep_history = keep_history
      if (present(keep_states)) self%keep_states = keep_states
      self%message = 'nothing has been computed yet'
      allocate (self%snapshots(8))
      if (keep_history /= history_none) call self%contact%record(event_none, 0, 0, 0)
   end function new_simulation

   !> Run the steps of the scene that have not been run yet. The outcome is in the object; `observer` watches.
   subroutine run(self, observer)
      class(simulation_type), intent(inout) :: self
      class(observer_type), intent(inout), optional :: observer

      do while (self%has_segments_left())
         call self%run_segment(observer)
      end do
   end subroutine run

   !> Whether steps of the scene are left, and nothing has gone wrong.
   pure logical function has_segments_left(self)
      class(simulation_type), intent(in) :: self

      has_segments_left = self%outcome == MFV_COMPLETE .and. self%scene_steps_done < size(self%contact%model%scene%steps)
   end function has_segments_left

   !> Run the next segment of the scene's steps: a step, or one way of a cycle.
   subroutine run_segment(self, observer)
      class(simulation_type), intent(inout) :: self
      class(observer_type), intent(inout), optional :: observer
      integer :: i

      i = self%scene_steps_done + 1
      associate (steps => self%contact%model%scene%steps)
         call self%advance_segment(steps(i), sum(reversals(steps(:i - 1))), sum(reversals(steps)), observer)
      end associate
      if (self%outcome /= MFV_COMPLETE) then
         self%failed_scene_step = i
      else if (self%leg%number == 0) then
         self%scene_steps_done = i
      end if
   end subroutine run_segment

   !> Straight parts of the load history in a step: one, or there and back for every cycle.
   elemental integer function reversals(step)
      type(step_type), intent(in) :: step

      reversals = max(1, 2*step%cycles)
   end function reversals

   !> Apply the loads of one more step, from the present state.
   subroutine advance(self, step, observer)
      class(simulation_type), intent(inout) :: self
      type(step_type), intent(in) :: step
      class(observer_type), intent(inout), optional :: observer

      do while (self%outcome == MFV_COMPLETE)
         call self%advance_segment(step, 0, reversals(step), observer)
         if (self%leg%number == 0) exit
      end do
   end subroutine advance

   !> Apply the loads of the next segment of a step; it is done when leg%number is 0. `before`, `segments`: for progress, how many
   !> segments there are before this step, and how many in all.
   subroutine advance_segment(self, step, before, segments, observer)
      class(simulation_type), intent(inout) :: self
      type(step_type), intent(in) :: step
      integer, intent(in) :: before, segments
      class(observer_type), intent(inout), optional :: observer
      type(error_type), allocatable :: error
      logical :: is_last

      if (allocated(self%estimate)) deallocate (self%estimate)
      if (allocated(self%sensitivity)) deallocate (self%sensitivity)
      if (self%keep_restart) call self%note_restart()
      if (self%leg%number == 0) call self%begin_step(step)
      call self%lead_to(step, before, segments, observer, error)
      if (allocated(error)) then
         call self%end_step_early(step, error)
         return
      end if
      associate (i => self%leg%number)
         is_last = i == reversals(step)
         if (step%cycles > 0) call self%end_of_leg(i, self%leg%cycle)
         if (mod(i, 2) == 0 .and. i > 2 .and. step%steady_tolerance > 0.0_wp) &
            is_last = is_last .or. self%leg%cycle%change <= step%steady_tolerance
         if (is_last .and. self%keep_states /= states_none .or. self%keep_states == states_reversals) &
            call self%take_snapshot(self%steps_done + 1, i)
         i = i + 1
      end associate
      if (is_last) call end_step(self, step)
   end subroutine advance_segment

   !> A step has reached its end.
   subroutine end_step(self, step)
      class(simulation_type), intent(inout) :: self
      type(step_type), intent(in) :: step
      integer :: cycles

      cycles = (self%leg%number - 1)/2
      self%leg%number = 0
      self%steps_done = self%steps_done + 1
      self%message = 'step '//to_text(self%steps_done)//' was reached'
      if (step%cycles > cycles) self%message = self%message//', steady after '//to_text(cycles)//' of '// &
                                               to_text(step%cycles)//' cycles'
      call self%note_trail(step)
   end subroutine end_step

   !> Keep what it takes to continue from here, the start of a segment.
   subroutine note_restart(self)
      class(simulation_type), intent(inout) :: self

      associate (r => self%restart, system => self%contact%system)
         r%path = self%contact%path_position_type
         r%records = self%contact%history%records
         r%leg = max(self%leg%number, 1)
         r%added = self%contact%model%added
         r%solves = system%solves
         r%iterations = system%iterations
         r%products = system%products
         r%slip = self%slip
         r%load = self%load
      end associate
   end subroutine note_restart

   !> Continue from `restart`, which another run of the scene has kept; snapshots, cycles, marks, history and the numbers of
   !> position_type
   !> are those of that run already. The linear solver starts anew.
   subroutine resume(self)
      class(simulation_type), intent(inout) :: self
      integer :: i

      associate (r => self%restart, steps => self%contact%model%scene%steps)
         call self%contact%resume(r%path, r%added)
         self%contact%system%solves = r%solves
         self%contact%system%iterations = r%iterations
         self%contact%system%products = r%products
         self%slip = r%slip
         self%load = r%load
         self%steps_done = self%scene_steps_done
         do i = 1, self%scene_steps_done
            call self%way%add(steps(i))
            call self%note_trail(steps(i))
         end do
         if (self%scene_steps_done > 0) self%message = 'step '//to_text(self%scene_steps_done)//' was reached'
         if (r%leg > 1) call continue_step(self, steps(self%scene_steps_done + 1), r%leg)
      end associate
   end subroutine resume

   !> The step in which a run was interrupted goes on with segment `leg`; its cycles began at mark_loading.
   subroutine continue_step(self, step, leg)
      class(simulation_type), intent(inout) :: self
      type(step_type), intent(in) :: step
      integer, intent(in) :: leg

      call self%way%add(step)
      self%leg%number = leg
      call set_ends(self, step, self%marks(mark_loading)%state)
   end subroutine continue_step

   !> A step begins at the present state.
   subroutine begin_step(self, step)
      class(simulation_type), intent(inout) :: self
      type(step_type), intent(in) :: step
      integer :: i

      call self%way%add(step)
      self%leg%number = 1
      do i = 1, motion_count
         if (step%control(i) /= control_keep) call self%contact%begin_motion(i)
      end do
      call set_ends(self, step, self%contact%state)
      if (step%cycles > 0) call self%begin_cycles(self%leg%cycle)
   end subroutine begin_step

   !> The loads at both ends of a step that begins at a state: its targets, and where its cycles return to.
   subroutine set_ends(self, step, start)
      class(simulation_type), intent(inout) :: self
      type(step_type), intent(in) :: step
      type(contact_state_type), intent(in) :: start

      self%leg%there = target_of(self%load, step%control, step%target)
      self%leg%back = start_of(start%fields%force, start%fields%motion, self%leg%there)
   end subroutine set_ends

   !> The step cannot be led to its end, and why.
   subroutine end_step_early(self, step, error)
      class(simulation_type), intent(inout) :: self
      type(step_type), intent(in) :: step
      type(error_type), intent(in) :: error

      self%leg%number = 0
      self%outcome = error%status
      self%message = error%message
      self%failed_step = self%steps_done + 1
      call self%note_trail(step)
   end subroutine end_step_early

   !> Add the step that has just been taken to the checksum of the way: what it was to do, and where it led.
   subroutine note_trail(self, step)
      class(simulation_type), intent(inout) :: self
      type(step_type), intent(in) :: step
      integer, parameter :: first_capacity = 16
      integer(int64), allocatable :: longer(:)
      integer(int64) :: checksum
      integer(int8) :: mold(1)

      if (self%keep_history == history_none .and. self%keep_states == states_none) return
      if (.not. allocated(self%trails)) allocate (self%trails(first_capacity), source=0_int64)
      if (self%way%steps > size(self%trails)) then
         allocate (longer(2*self%way%steps), source=0_int64)
         longer(:size(self%trails)) = self%trails
         call move_alloc(longer, self%trails)
      end if
      checksum = 0
      if (self%way%steps > 1) checksum = self%trails(self%way%steps - 1)
      call add_to_checksum(transfer([step%control, step%cycles, &
                                     merge(1, 0, step%friction), self%contact%events], mold), checksum)
      associate (f => self%contact%state%fields)
         call add_to_checksum(transfer([step%target, step%steady_tolerance, f%force, f%motion, self%contact%state%dissipation], &
                                       mold), checksum)
      end associate
      self%trails(self%way%steps) = checksum
   end subroutine note_trail

   !> The checksum of the way up to now; 0 at its start, and where nothing is kept of it.
   pure integer(int64) function trail(self)
      class(simulation_type), intent(in) :: self

      trail = 0
      if (allocated(self%trails) .and. self%way%steps > 0) trail = self%trails(self%way%steps)
   end function trail

   !> Whether the way up to now led through a state after so many steps with this trail; where nothing is kept of it, through any.
   pure logical function came_through(self, steps, trail)
      class(simulation_type), intent(in) :: self
      integer, intent(in) :: steps
      integer(int64), intent(in) :: trail

      came_through = self%keep_history == history_none .and. self%keep_states == states_none
      if (came_through) return
      came_through = steps <= self%way%steps
      if (came_through .and. steps > 0) came_through = self%trails(steps) == trail
   end function came_through

   !> The cycles of a step begin from the present state.
   subroutine begin_cycles(self, cycle)
      class(simulation_type), intent(inout) :: self
      type(cycle_type), intent(out) :: cycle
      integer :: i

      do i = 1, mark_count
         self%marks(i)%step = 0
      end do
      cycle%step = self%steps_done + 1
      cycle%return = new_turning_point(self%contact%model, self%contact%state, self%slip, &
                                       ieee_value(1.0_wp, ieee_quiet_nan))
      cycle%loading_slip = self%slip
      call self%set_mark(mark_loading, 0)
      call self%set_mark(mark_return, 0)
   end subroutine begin_cycles

   !> Leg `leg` of the cycles is done: there where it is odd, back where it is even. Keep the states and, after a whole cycle,
   !> the cycle.
   subroutine end_of_leg(self, leg, cycle)
      class(simulation_type), intent(inout) :: self
      integer, intent(in) :: leg
      type(cycle_type), intent(inout) :: cycle
      type(contact_state_type) :: before

      if (mod(leg, 2) == 1) then
         cycle%reversal = new_turning_point(self%contact%model, self%contact%state, self%slip, self%contact%first_stiffness)
         call self%set_mark(mark_pending, leg)
         return
      end if
      self%cycles_done = self%cycles_done + 1
      cycle%number = leg/2
      cycle%overall = self%cycles_done
      cycle%start = cycle%return
      self%marks(mark_cycle_start) = self%marks(mark_return)
      self%marks(mark_reversal) = self%marks(mark_pending)
      cycle%return = new_turning_point(self%contact%model, self%contact%state, self%slip, self%contact%first_stiffness)
      before = self%padded(self%marks(mark_cycle_start))
      cycle%change = self%change_since(before)
      call self%set_mark(mark_return, leg)
      if (cycle%number == 1) cycle%first_dissipation = cycle%dissipation()
      if (cycle%number == 1) cycle%first_slip = cycle%slip()
      call append_cycle(self%cycles, self%cycle_count, cycle, self%keep_history == history_none)
   end subroutine end_of_leg

   !> Largest change of a traction since the state `before`, on the same mesh, in parts of the largest traction so far.
   pure real(wp) function change_since(self, before)
      class(simulation_type), intent(in) :: self
      type(contact_state_type), intent(in) :: before
      real(wp) :: scale

      change_since = 0.0_wp
      scale = self%contact%certificate%traction_scale()
      associate (now => self%contact%state%fields, then => before%fields)
         if (scale > 0.0_wp) change_since = max(maxval(abs(now%pressure - then%pressure)), &
                                                maxval(abs(now%shear - then%shear)))/scale
      end associate
   end function change_since

   !> Keep the present state as mark `mark`.
   subroutine set_mark(self, mark, reversal)
      class(simulation_type), intent(inout) :: self
      integer, intent(in) :: mark, reversal

      self%marks(mark)%state = self%contact%state
      self%marks(mark)%step = self%steps_done + 1
      self%marks(mark)%reversal = reversal
      self%marks(mark)%added = self%contact%model%added
   end subroutine set_mark

   !> The load that a step leads to: `value` is its target; an absent one stays as it is.
   elemental type(load_type) function target_of(load, control, value)
      type(load_type), intent(in) :: load
      integer, intent(in) :: control
      real(wp), intent(in) :: value

      target_of = load
      if (control /= control_keep) target_of = load_type(control, value)
   end function target_of

   !> The same load with the value that it has where the force and the motion are these.
   elemental type(load_type) function start_of(force, motion, load)
      real(wp), intent(in) :: force, motion
      type(load_type), intent(in) :: load

      start_of = load_type(load%control, merge(force, motion, load%control == control_force))
   end function start_of

   !> Apply the loads of the leg, straight to where it goes.
   subroutine lead_to(self, step, before, segments, observer, error)
      class(simulation_type), intent(inout) :: self
      type(step_type), intent(in) :: step
      integer, intent(in) :: before, segments
      class(observer_type), intent(inout), optional :: observer
      type(error_type), allocatable, intent(out) :: error
      type(load_type) :: targets(motion_count)

      targets = merge(self%leg%there, self%leg%back, mod(self%leg%number, 2) == 1)
      call self%begin_segment(targets, step, before, segments)
      associate (method => self%contact%model%scene%method)
         if (method%algorithm == algorithm_conventional) then
            call lead_conventionally(self%contact, self%leg%segment, observer, error)
         else if (method%stepping == stepping_leap) then
            call lead_by_leaps(self%contact, self%leg%segment, observer, error)
         else
            call lead_straight(self%contact, self%leg%segment, observer, error)
         end if
      end associate
      call self%slip%add_segment(self%contact%model, self%leg%start, self%contact%state, self%contact%slip_zone_nodes, &
                                 self%contact%system%noise)
      self%load%control = targets%control
      self%load%value = targets%value
      if (self%keep_history /= history_none) &
         call self%contact%record(merge(event_stopped, event_step_end, allocated(error)), 0, 0, self%leg%segment%step)
   end subroutine lead_to

   !> The segment from the present state to `targets`.
   subroutine begin_segment(self, targets, step, before, segments)
      class(simulation_type), intent(inout) :: self
      type(load_type), intent(in) :: targets(motion_count)
      type(step_type), intent(in) :: step
      integer, intent(in) :: before, segments
      integer :: i
      real(wp) :: force(motion_count)

      force = [(self%contact%certificate%force_scale()*arm_unit(i, self%contact%model%length()), i=1, motion_count)]
      associate (segment => self%leg%segment, fields => self%contact%state%fields)
         segment%load = load_towards(start_of(fields%force, fields%motion, targets), targets, force)
         segment%friction = step%friction
         segment%step = self%steps_done + 1
         segment%number = before + self%leg%number
         segment%segments = segments
      end associate
      associate (state => self%contact%state)
         self%leg%start = segment_start_type(state%dissipation, state%fields%force, state%fields%shear)
      end associate
      call self%contact%await_increment()
   end subroutine begin_segment

   !> From the load `start` to `goal`, at a rate per segment. A change of a force that is round-off of the largest one so far,
   !> `scale`, is none: what it would do to bodies just apart is noise.
   elemental type(load_type) function load_towards(start, goal, scale)
      type(load_type), intent(in) :: start, goal
      real(wp), intent(in) :: scale

      load_towards = load_type(start%control, start%value, goal%value - start%value)
      if (start%control == control_force .and. abs(load_towards%rate) <= epsilon(scale)*scale) load_towards%rate = 0.0_wp
   end function load_towards

   subroutine take_snapshot(self, step, reversal)
      class(simulation_type), intent(inout) :: self
      integer, intent(in) :: step, reversal
      type(snapshot_type), allocatable :: longer(:)

      if (self%snapshot_count == size(self%snapshots)) then
         allocate (longer(2*self%snapshot_count))
         longer(:self%snapshot_count) = self%snapshots
         call move_alloc(longer, self%snapshots)
      end if
      self%snapshot_count = self%snapshot_count + 1
      self%snapshots(self%snapshot_count) = snapshot_type(self%contact%state, step, reversal, self%contact%model%added)
   end subroutine take_snapshot

   !> The state of snapshot `number`, see padded.
   function padded_state(self, number) result(state)
      class(simulation_type), intent(in) :: self
      integer, intent(in) :: number
      type(contact_state_type) :: state

      state = self%padded(self%snapshots(number))
   end function padded_state

   !> The state of a snapshot on the mesh as it is now: when the mesh has grown since, with its new nodes.
   function padded(self, snapshot) result(state)
      class(simulation_type), intent(in) :: self
      type(snapshot_type), intent(in) :: snapshot
      type(contact_state_type) :: state

      state = snapshot%state
      if (self%contact%model%added == snapshot%added) return
      call state%widen(self%contact%model%added - snapshot%added)
      call self%contact%model%displace(state%fields)
   end function padded

end module mfv_simulation
