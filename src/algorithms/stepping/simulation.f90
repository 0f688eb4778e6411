!> A scene and its run through the load history: steps, reversals, the state at the end of each, and the outcome.
module mfv_simulation
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite, ieee_is_nan, ieee_quiet_nan, ieee_value
   use, intrinsic :: iso_fortran_env, only: int64, int8
   use mfv_checksum, only: add_to_checksum
   use mfv_compliance, only: block_wt
   use mfv_contact_model, only: new_contact_model
   use mfv_contact_state, only: contact_state_type
   use mfv_contact_system, only: initial_loads, load_type
   use mfv_cycle, only: append_cycle, cycle_type, new_turning_point, turning_point_type
   use mfv_edge_fields, only: edge_field_type, edge_fields_of, undefined_edge
   use mfv_derivative_increments, only: differentiate_end
   use mfv_error, only: error_type
   use mfv_contact_path, only: contact_path_type, new_contact_path, path_position_type, saved_path_type, segment_type
   use mfv_conventional, only: apply_conventionally
   use mfv_error_bar, only: error_estimate_type
   use mfv_frictionless, only: apply_directly
   use mfv_kinds, only: wp
   use mfv_load_extremes, only: add_estimate, candidate_count, candidate_tension, candidate_von_mises, extreme_type, &
                                is_same_estimate, load_extremes_type, most_rows, over_cycle, over_rows, over_steps, &
                                slip_range_type
   use mfv_leap, only: apply_by_large_increments
   use mfv_load_summary, only: load_summary_type
   use mfv_motions, only: motions, motion_count, motion_approach, motion_shift, motion_wear, control_keep, &
                          control_force, control_displacement
   use mfv_node_status, only: event_none, event_step_end, event_stopped, in_contact
   use mfv_observer, only: observer_type
   use mfv_scene
   use mfv_slip_zones, only: segment_start_type, slip_record_type
   use mfv_state_interior, only: find_largest_tension, find_largest_von_mises, surface_stress_at
   use mfv_status, only: MFV_COMPLETE, MFV_INPUT_ERROR, MFV_INTERRUPTED, MFV_NO_CONTINUATION, MFV_SEPARATED
   use mfv_stress_search, only: largest_type
   use mfv_zone_edges, only: find_patches, patch_type
   use mfv_wear_block, only: find_wear_block, wear_block_type, widened, work_of_wear
   use mfv_strings, only: to_text
   implicit none
   private
   public :: simulation_type, position_type, restart_type, trial_type, new_simulation, snapshot_type, sensitivity_type
   public :: history_events, history_steps, history_none
   public :: states_reversals, states_steps, states_none, states_last_cycle
   public :: mark_loading, mark_reversal, mark_return, mark_cycle_start, mark_yield, mark_turn, mark_of, mark_count

   !> Records of the load history, in the order of the key &output history: one for every event, one for every step end, none.
   integer, parameter :: history_events = 1, history_steps = 2, history_none = 3
   !> Snapshots, in the order of the key &output states: at the ends of steps and at every turning point of a step with cycles; of
   !> steps alone; none; or at the ends of steps and the turning points of the last cycle of a step.
   integer, parameter :: states_reversals = 1, states_steps = 2, states_none = 3, states_last_cycle = 4

   !> States stored for the last step with cycles: the start of the step, the reversal of its last complete cycle, the end of that
   !> cycle (with `reversal` 0 before the first: the start of the step), and its start.
   integer, parameter :: mark_loading = 1, mark_reversal = 2, mark_return = 3, mark_cycle_start = 4
   !> The reversal of the incomplete cycle. From the next ones on, most_rows for each (mark_of): the states of the present stretch
   !> that may have the largest stresses (candidate_tension and so on); those of the last complete cycle, and of the whole load
   !> history, for the von Mises stress of each body. And the number of marks.
   integer, parameter :: mark_pending = 5, mark_candidate = mark_pending + 1
   integer, parameter :: mark_last_cycle = mark_candidate + most_rows*candidate_count
   integer, parameter :: mark_yield = mark_last_cycle + 2*most_rows
   !> The last turning point of the loads: the start of the last segments in which each went on in one direction.
   integer, parameter :: mark_turn = mark_yield + 2*most_rows, mark_count = mark_turn
   !> Rows in which the largest von Mises stress of the whole load history is searched for.
   integer, parameter :: rows_of_yield = 3
   !> An estimate is not smaller than this part of a stress that is among the largest.
   real(wp), parameter :: least_estimate = 0.85_wp

   !> The state at the end of a step, or of one reversal of a step with cycles.
   type :: snapshot_type
      type(contact_state_type) :: state
      !> Number of the step, and of the reversal in it (1 for a step without cycles).
      integer :: step = 0, reversal = 0
      !> Nodes added to the mesh at either end at that time.
      integer :: added = 0
   end type snapshot_type

   !> State of a simulation, except for its contact and for what grows with the number of records.
   type :: position_type
      !> Numbers of snapshots and cycles so far, see simulation_type; and of complete cycles of all steps.
      integer :: snapshot_count = 0, cycle_count = 0, cycles_done = 0
      !> See mark_loading and so on, shape (mark_count); `step` is 0 if not set.
      type(snapshot_type), allocatable :: marks(:)
      !> Outcome (see mfv_status): MFV_COMPLETE as long as no error has occurred; and its explanation.
      integer :: outcome = MFV_COMPLETE
      character(:), allocatable :: message
      !> Step that was not reached, 0 for none; and number of completed steps.
      integer :: failed_step = 0, steps_done = 0
      !> The same for the steps of the scene only; other steps may come between them.
      integer :: failed_scene_step = 0, scene_steps_done = 0
      !> Slip zones of all segments so far.
      type(slip_record_type) :: slip
      !> Extremes and slip of the present stretch: since the start of a cycle, the first row of &history, or the start.
      type(load_extremes_type) :: extremes
      type(slip_range_type) :: slip_range
      !> Estimates of the largest von Mises stress of both bodies in the states of mark_yield, force/length^2.
      real(wp) :: yield_estimate(rows_of_yield, 2) = -1.0_wp
      !> Summary of the steps taken, the last one possibly incomplete.
      type(load_summary_type) :: load_summary
      !> The present controls and loads.
      type(load_type) :: load(motion_count) = initial_loads
   end type position_type

   !> Change of the final state if all coefficients of friction are multiplied by 1 + `perturbation` (see mfv_sensitivity).
   type :: sensitivity_type
      !> Outcome of the perturbed run (see mfv_status); and why there is no comparison, else empty.
      integer :: status = 0
      character(:), allocatable :: message
      real(wp) :: perturbation = 1.0e-12_wp
      !> The largest change of a pressure and of a shear traction, relative to the largest traction; relative change of the
      !> dissipation; change of the stick ratio between nodes.
      real(wp) :: pressure = 0.0_wp, shear = 0.0_wp, dissipation = 0.0_wp, stick_ratio = 0.0_wp
   end type sensitivity_type

   !> The current step: the loads at both of its ends, its cycle, and the next or current load segment.
   type :: leg_type
      !> 0: no current step.
      integer :: number = 0
      type(load_type) :: there(motion_count), back(motion_count)
      type(cycle_type) :: cycle
      type(segment_type) :: segment
      type(segment_start_type) :: start
   end type leg_type

   !> Complete restart state, taken at the start of a segment: the contact, the number of history records, the work of the linear
   !> solver, the number of the segment in its step, the nodes added to the mesh, the slip zones and the loads.
   type :: restart_type
      type(path_position_type) :: path
      integer :: records = 0, solves = 0, leg = 1, added = 0
      integer(int64) :: iterations = 0, products = 0
      type(slip_record_type) :: slip
      type(load_type) :: load(motion_count)
   end type restart_type

   !> A block of cycles of wear that the next computed cycle will judge, and all that it takes to try a shorter one.
   type :: trial_type
      !> Cycles of the block; 0: as many as the predicted change allows.
      integer :: cycles = 0
      !> Correction of the block before, which is worn with this one, length, shape (nodes).
      real(wp), allocatable :: correction(:)
      !> Whether its wear has begun; `block` and what follows are then known.
      logical :: is_worn = .false.
      type(wear_block_type) :: block
      !> Depth that the first cycle after the block wears, length, shape (nodes); and whether it is to be worn off.
      real(wp), allocatable :: settling(:)
      logical :: settles = .false.
      !> The start of the block: the state at the end of its first cycle. The last cycle only if there is no load history.
      type(saved_path_type) :: contact
      type(position_type) :: position
      type(leg_type) :: leg
      type(cycle_type), allocatable :: last_cycle
   end type trial_type

   type, extends(position_type) :: simulation_type
      type(contact_path_type) :: contact
      !> States at the end of every step and reversal so far; the first `snapshot_count` entries are in use.
      type(snapshot_type), allocatable :: snapshots(:)
      !> Complete cycles so far, the first `cycle_count` entries are in use; without a load history only the last cycle.
      type(cycle_type), allocatable :: cycles(:)
      integer :: keep_history = history_events
      !> See states_reversals and so on.
      integer :: keep_states = states_reversals
      !> x at which history records have the stress along the surface, with the largest tension; unallocated: none.
      real(wp), allocatable :: stress_at
      !> Checksums of the load history up to the end of every step, if history or states are kept; the first `load_summary%steps`
      !> are in use.
      integer(int64), allocatable, private :: history_checksums(:)
      !> The discretisation error of the present state, if estimated (see mfv_discretisation_error).
      type(error_estimate_type), allocatable :: estimate
      !> The sensitivity of the present state to round-off, if computed (see mfv_sensitivity).
      type(sensitivity_type), allocatable :: sensitivity
      !> The current step.
      type(leg_type) :: leg
      !> The present block of cycles of wear, if there is one.
      type(trial_type), allocatable :: trial
      !> Whether the start of each segment is stored in `restart`.
      logical :: keep_restart = .false.
      type(restart_type) :: restart
   contains
      procedure :: run
      procedure :: advance
      procedure :: has_segments_left
      procedure :: run_segment
      procedure :: note_restart
      procedure :: resume
      procedure :: history_checksum
      procedure :: passed_through
      procedure :: padded
      procedure :: stretch
      procedure :: ends_with_cycle
      procedure :: edge_fields
      procedure :: find_extremes
      procedure :: find_largest_of_history
   end type simulation_type

contains

   !> A simulation of a scene, at its start. Its outcome is MFV_INPUT_ERROR if the scene has a fault. `keep_history`:
   !> history_events, history_steps or history_none. `keep_states`: states_reversals (default), states_steps or states_none.
   function new_simulation(scene, keep_history, keep_states) result(self)
      type(scene_type), intent(in) :: scene
      integer, intent(in) :: keep_history
      integer, intent(in), optional :: keep_states
      type(simulation_type) :: self

      allocate (self%marks(mark_count))
      self%message = trim(scene%fault())
      if (self%message /= '') then
         self%outcome = MFV_INPUT_ERROR
         self%contact%model%scene = scene
         return
      end if
      call new_contact_path(new_contact_model(scene), keep_history == history_events, self%contact)
      self%keep_history = keep_history
      if (present(keep_states)) self%keep_states = keep_states
      self%message = 'nothing has been computed yet'
      allocate (self%snapshots(8))
      if (keep_history /= history_none) call self%contact%record(event_none, 0, 0, 0)
   end function new_simulation

   !> Run the remaining steps of the scene; the outcome is stored in the object.
   subroutine run(self, observer)
      class(simulation_type), intent(inout) :: self
      class(observer_type), intent(inout), optional :: observer

      do while (self%has_segments_left())
         call self%run_segment(observer)
      end do
   end subroutine run

   !> Whether steps of the scene are left and no error has occurred.
   pure logical function has_segments_left(self)
      class(simulation_type), intent(in) :: self

      has_segments_left = self%outcome == MFV_COMPLETE .and. self%scene_steps_done < size(self%contact%model%scene%steps)
   end function has_segments_left

   !> Run the next segment of the steps of the scene: a step, or half a cycle.
   subroutine run_segment(self, observer)
      class(simulation_type), intent(inout) :: self
      class(observer_type), intent(inout), optional :: observer
      type(step_type) :: step
      integer :: before, i, segments

      i = self%scene_steps_done + 1
      associate (steps => self%contact%model%scene%steps)
         step = steps(i)  ! a copy, since the model may be replaced
         before = sum(steps(:i - 1)%segments())
         segments = sum(steps%segments())
      end associate
      call advance_segment(self, step, before, segments, observer)
      if (self%outcome /= MFV_COMPLETE) then
         self%failed_scene_step = i
      else if (self%leg%number == 0) then
         self%scene_steps_done = i
      end if
   end subroutine run_segment

   !> Apply the loads of another step, from the present state.
   subroutine advance(self, step, observer)
      class(simulation_type), intent(inout) :: self
      type(step_type), intent(in) :: step
      class(observer_type), intent(inout), optional :: observer

      do while (self%outcome == MFV_COMPLETE)
         call advance_segment(self, step, 0, step%segments(), observer)
         if (self%leg%number == 0) exit
      end do
   end subroutine advance

   !> Apply the loads of the next segment of a step; the step is complete when leg%number is 0. `before`, `segments`: number of
   !> segments before this step and of all segments, for progress.
   subroutine advance_segment(self, step, before, segments, observer)
      class(simulation_type), intent(inout) :: self
      type(step_type), intent(in) :: step
      integer, intent(in) :: before, segments
      class(observer_type), intent(inout), optional :: observer
      type(error_type), allocatable :: error
      real(wp), parameter :: shorter = 0.25_wp
      logical :: is_last

      if (allocated(self%estimate)) deallocate (self%estimate)
      if (allocated(self%sensitivity)) deallocate (self%sensitivity)
      if (self%keep_restart) call self%note_restart()
      if (self%leg%number == 0) call begin_step(self, step)
      if (.not. block_is_due(self)) call complete_segment(self, step, before, segments, observer, error)
      if (block_is_due(self) .and. .not. allocated(error)) call apply_block(self, step, before, segments, observer, error)
      if (allocated(error)) then
         if (block_failed(self, error)) then
            call shorten_block(self, shorter)
            return
         end if
      end if
      if (self%keep_history /= history_none) &
         call self%contact%record(merge(event_stopped, event_step_end, allocated(error)), 0, 0, self%leg%segment%step)
      if (allocated(error)) then
         call end_step_early(self, step, error)
         return
      end if
      if (allocated(self%stress_at) .and. self%keep_history /= history_none) call record_surface(self%contact, self%stress_at)
      associate (i => self%leg%number)
         is_last = i == step%segments()
         if (.not. is_last .and. mod(i, step%turns()) == 0 .and. step%steady_tolerance > 0.0_wp) is_last = is_steady(self, step)
         if (keeps_state(self, step, is_last)) call take_snapshot(self, self%steps_done + 1, i)
         i = i + 1
      end associate
      if (is_last) call end_step(self, step)
   end subroutine advance_segment

   !> Apply the loads of the present segment; note the extremes, complete the cycle that it ends, and plan its wear.
   subroutine complete_segment(self, step, before, segments, observer, error)
      class(simulation_type), intent(inout) :: self
      type(step_type), intent(in) :: step
      integer, intent(in) :: before, segments
      class(observer_type), intent(inout), optional :: observer
      type(error_type), allocatable, intent(out) :: error

      call apply_leg(self, step, before, segments, observer, error)
      if (allocated(error)) return
      call note_extremes(self, step)
      if (step%cycles == 0) return
      call complete_leg(self, self%leg%number, step%turns(), self%leg%cycle)
      if (wears(self, step)) call plan_block(self, step)
   end subroutine complete_segment

   !> Whether the present segment ends a cycle whose wear changes the gaps.
   pure logical function wears(self, step)
      class(simulation_type), intent(in) :: self
      type(step_type), intent(in) :: step

      wears = step%cycles > 0 .and. mod(self%leg%number, step%turns()) == 0 .and. self%contact%model%scene%wear%acts() .and. &
              self%contact%model%tangential
   end function wears

   !> Judge the block of cycles of wear before the present cycle by this cycle. If its error is above the tolerance, go back to its
   !> start and plan a shorter one, else plan the block that begins with this cycle. The first cycle of a step wears alone, since it
   !> often dissipates otherwise than those that follow; so do the two after each block: the slip that the wear of a block causes at
   !> once is not that of the cycles that follow. A block may err by the part `part` of the tolerance, since errors add up.
   subroutine plan_block(self, step)
      class(simulation_type), intent(inout) :: self
      type(step_type), intent(in) :: step
      real(wp), parameter :: safety = 0.9_wp, smallest = 0.1_wp, largest = 5.0_wp, part = 0.5_wp
      real(wp), allocatable :: correction(:)
      type(wear_block_type) :: next
      real(wp) :: error, factor
      integer :: cycles

      cycles = 0
      allocate (correction(self%contact%model%nodes()), source=0.0_wp)
      associate (wear => self%contact%model%scene%wear)
         if (allocated(self%trial)) then
            call find_wear_block(self%contact, cycle_work(self), 1, 1, is_pressed(self), next)
            if (self%trial%block%cycles > 1 .and. .not. allocated(self%trial%settling)) then
               self%trial%settling = next%depth
               self%trial%settles = .true.
               return
            end if
            call judge_block(self, next, correction, error)
            factor = largest
            if (error > 0.0_wp) factor = min(max(safety*sqrt(part*wear%tolerance/error), smallest), largest)
            cycles = max(int(factor*max(self%trial%block%cycles, 2)), 1)
            if (self%trial%block%cycles > 1 .and. wear%block > 0) then
               self%contact%state%wear_error = self%contact%state%wear_error + error*self%leg%cycle%worn_area
            else if (self%trial%block%cycles > 1 .and. error > part*wear%tolerance) then
               call shorten_block(self, factor)
               return
            end if
            deallocate (self%trial)
         end if
         if (wear%block > 0) cycles = wear%block
         if (self%leg%cycle%number == 1) cycles = 1
      end associate
      allocate (self%trial)
      self%trial%cycles = min(cycles, most_worn_at_once(self, step))
      call move_alloc(correction, self%trial%correction)
   end subroutine plan_block

   !> Correction of the depth of the last block, length, shape (nodes), and its error relative to all that is worn; `next`: of the
   !> present cycle.
   subroutine judge_block(self, next, correction, error)
      class(simulation_type), intent(in) :: self
      type(wear_block_type), intent(in) :: next
      real(wp), allocatable, intent(out) :: correction(:)
      real(wp), intent(out) :: error
      real(wp) :: settling(size(next%depth))

      settling = 0.0_wp
      if (allocated(self%trial%settling)) settling = widened(self%trial%settling, size(settling))
      call self%trial%block%judge(settling, next%depth, self%contact%state%worn, self%contact%model%width, correction, error)
   end subroutine judge_block

   !> Most cycles of the block that begins with the present one.
   pure integer function most_worn_at_once(self, step) result(most)
      class(simulation_type), intent(in) :: self
      type(step_type), intent(in) :: step

      most = max(step%cycles - self%leg%number/step%turns() - 1, 1)
   end function most_worn_at_once

   !> Friction work of the cycle that ends here per unit of surface, force/length, shape (nodes).
   function cycle_work(self) result(work)
      class(simulation_type), intent(in) :: self
      real(wp), allocatable :: work(:)
      type(contact_state_type) :: start

      start = self%padded(self%marks(mark_cycle_start))
      work = self%contact%state%friction_work - start%friction_work
   end function cycle_work

   !> Whether the normal force is given.
   pure logical function is_pressed(self)
      class(simulation_type), intent(in) :: self

      is_pressed = self%load(motion_approach)%control == control_force
   end function is_pressed

   !> Whether a planned block of wear is to be worn off.
   pure logical function block_is_due(self)
      class(simulation_type), intent(in) :: self

      block_is_due = .false.
      if (allocated(self%trial)) block_is_due = self%trial%settles .or. .not. self%trial%is_worn
   end function block_is_due

   !> Whether a shorter block may do without an error in the wear or the cycle after it.
   pure logical function block_failed(self, error)
      class(simulation_type), intent(in) :: self
      type(error_type), intent(in) :: error

      block_failed = .false.
      if (allocated(self%trial)) block_failed = self%trial%is_worn .and. self%trial%block%cycles > 1 .and. &
                                                self%contact%model%scene%wear%block == 0 .and. error%status /= MFV_INTERRUPTED
   end function block_failed

   !> Go back to the start of the present block, and plan one whose cycles are the part `factor` of it.
   subroutine shorten_block(self, factor)
      class(simulation_type), intent(inout) :: self
      real(wp), intent(in) :: factor
      integer(int64) :: iterations, products
      integer :: solves

      associate (trial => self%trial, contact => self%contact)
         solves = contact%system%solves
         iterations = contact%system%iterations
         products = contact%system%products
         call contact%restore(trial%contact)
         contact%system%solves = solves
         contact%system%iterations = iterations
         contact%system%products = products
         self%position_type = trial%position
         self%leg = trial%leg
         if (allocated(trial%last_cycle)) self%cycles = [trial%last_cycle]
         if (self%keep_states == states_last_cycle) call drop_snapshots(self)
         trial%cycles = max(int(factor*trial%block%cycles), 1)
         trial%is_worn = .false.
         trial%settles = .false.
         if (allocated(trial%settling)) deallocate (trial%settling)
      end associate
   end subroutine shorten_block

   !> Note the start of the present block in `trial`, for shorter ones and for a restart.
   subroutine note_block(self)
      class(simulation_type), intent(inout) :: self

      if (self%keep_restart) call self%note_restart()
      associate (trial => self%trial)
         call self%contact%save_to(trial%contact)
         trial%position = self%position_type
         trial%leg = self%leg
         if (self%keep_history == history_none) trial%last_cycle = self%cycles(1)
         trial%is_worn = .true.
      end associate
   end subroutine note_block

   !> Wear the surfaces by the planned block of cycles that the present one begins, under constant loads, and by the correction of
   !> the block before. Skip the cycles that are not computed; they dissipate what wears the surfaces.
   subroutine apply_block(self, step, before, segments, observer, error)
      class(simulation_type), intent(inout) :: self
      type(step_type), intent(in) :: step
      integer, intent(in) :: before, segments
      class(observer_type), intent(inout), optional :: observer
      type(error_type), allocatable, intent(out) :: error
      real(wp), allocatable :: depth(:), skipped(:)
      integer :: turns

      turns = step%turns()
      associate (trial => self%trial, contact => self%contact)
         if (trial%settles) then
            trial%settles = .false.
            call wear_by(self, widened(trial%settling, contact%model%nodes()), step, before, segments, observer, error)
            return
         end if
         do
            call find_wear_block(contact, cycle_work(self), trial%cycles, most_worn_at_once(self, step), is_pressed(self), &
                                 trial%block)
            if (.not. contact%lengthens_for(trial%block%depth > 0.0_wp)) exit
            trial%correction = widened(trial%correction, contact%model%nodes())
         end do
         call note_block(self)
         call wear_by(self, max(trial%block%depth + trial%correction, -contact%state%worn), step, before, segments, observer, error)
         if (allocated(error)) return
         ! The mesh may have grown meanwhile.
         depth = widened(trial%block%depth, contact%model%nodes())
         skipped = widened(trial%block%depth - trial%block%first + trial%correction, contact%model%nodes())
         call contact%state%skip(contact%model%width, work_of_wear(contact%model, skipped))
         associate (cycles => trial%block%cycles)
            if (cycles == 1 .and. trial%block%change > contact%model%scene%wear%tolerance) &
               contact%state%coarsely_worn = contact%state%coarsely_worn + contact%model%force(depth)
            self%cycles_done = self%cycles_done + cycles - 1
            self%leg%number = self%leg%number + turns*(cycles - 1)
            self%cycles(self%cycle_count)%block = cycles
         end associate
      end associate
      if (self%leg%cycle%number == 1 .or. self%leg%number == step%segments() .or. self%contact%model%scene%wear%block == 1) &
         deallocate (self%trial)
   end subroutine apply_block

   !> Wear the surfaces by `depth`, length, shape (nodes), under the present loads.
   subroutine wear_by(self, depth, step, before, segments, observer, error)
      class(simulation_type), intent(inout) :: self
      real(wp), intent(in) :: depth(:)
      type(step_type), intent(in) :: step
      integer, intent(in) :: before, segments
      class(observer_type), intent(inout), optional :: observer
      type(error_type), allocatable, intent(out) :: error
      type(load_type) :: targets(motion_count)

      call self%contact%begin_wear(depth)
      targets = self%load
      targets(motion_wear) = load_type(control_displacement, 1.0_wp)
      if (any(in_contact(self%contact%state%status))) then
         call begin_segment(self, targets, step, before, segments)
         call apply_segment(self, observer, error)
      else
         call self%contact%wear_at_once()
      end if
      call self%contact%end_wear()
   end subroutine wear_by

   !> Whether the cycles of a step have become steady. With wear also the change that the remaining cycles would make, each as much
   !> as those of this block, must be within the tolerance: that of the tractions, and that of the worn area relative to itself.
   logical function is_steady(self, step)
      class(simulation_type), intent(in) :: self
      type(step_type), intent(in) :: step
      type(contact_state_type) :: start
      real(wp) :: blocks, worn

      associate (cycle => self%leg%cycle, tolerance => step%steady_tolerance)
         is_steady = cycle%number > 1 .and. cycle%change <= tolerance
         if (.not. (is_steady .and. wears(self, step))) return
         blocks = real(step%cycles - self%leg%number/step%turns(), wp)/real(self%cycles(self%cycle_count)%block, wp)
         worn = self%contact%model%force(self%contact%state%worn)
         start = self%padded(self%marks(mark_cycle_start))
         is_steady = blocks*change_since(self, start) <= tolerance .and. blocks*(worn - cycle%worn_area) <= tolerance*worn
      end associate
   end function is_steady

   !> Begin the next cycle at the present state: the first one, or one after wear.
   subroutine restart_cycle(self)
      class(simulation_type), intent(inout) :: self

      self%leg%cycle%return = turning_point_here(self, ieee_value(1.0_wp, ieee_quiet_nan))
      call self%contact%state%begin_cycle_work()
      call set_mark(self, mark_return, self%leg%number - 1)
   end subroutine restart_cycle

   !> Whether the state at the end of the present segment is saved. Only the last row of a load history counts as the end of a step.
   !> States of an earlier cycle are removed where only those of the last one are saved.
   logical function keeps_state(self, step, is_last)
      class(simulation_type), intent(inout) :: self
      type(step_type), intent(in) :: step
      logical, intent(in) :: is_last

      keeps_state = self%keep_states == states_reversals .or. &
                    (self%keep_states == states_steps .and. is_last .and. .not. step%is_passed)
      if (self%keep_states /= states_last_cycle) return
      keeps_state = .not. step%is_passed
      if (step%cycles > 0 .and. mod(self%leg%number, step%turns()) == 1) call drop_snapshots(self)
   end function keeps_state

   !> Remove the states of the present step.
   subroutine drop_snapshots(self)
      class(simulation_type), intent(inout) :: self

      do while (self%snapshot_count > 0)
         if (self%snapshots(self%snapshot_count)%step /= self%steps_done + 1) exit
         self%snapshot_count = self%snapshot_count - 1
      end do
   end subroutine drop_snapshots

   !> Complete a step.
   subroutine end_step(self, step)
      class(simulation_type), intent(inout) :: self
      type(step_type), intent(in) :: step
      integer :: cycles

      if (allocated(self%trial)) deallocate (self%trial)
      cycles = (self%leg%number - 1)/step%turns()
      self%leg%number = 0
      self%steps_done = self%steps_done + 1
      self%message = 'step '//to_text(self%steps_done)//' was reached'
      if (step%cycles > cycles) self%message = self%message//', steady after '//to_text(cycles)//' of '// &
                                               to_text(step%cycles)//' cycles'
      if (step%cycles > cycles .and. self%leg%cycle%walks()) &
         self%message = self%message//' but walking: each moves the upper body by '//to_text(self%leg%cycle%drift(motion_shift), 4)
      call note_history_checksum(self, step)
   end subroutine end_step

   !> Store the restart state at the start of a segment, unless that of a block of wear still counts.
   subroutine note_restart(self)
      class(simulation_type), intent(inout) :: self

      if (allocated(self%trial)) then
         if (self%trial%is_worn) return
      end if
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

   !> Continue from `restart`, which another run of the scene has stored. Snapshots, cycles, marks, history and the components of
   !> position_type are those of that run already. The linear solver starts without history.
   subroutine resume(self)
      class(simulation_type), intent(inout) :: self
      integer :: i

      ! This may rebuild the model, with its scene.
      call self%contact%resume(self%restart%path, self%restart%added)
      associate (r => self%restart, steps => self%contact%model%scene%steps)
         self%contact%system%solves = r%solves
         self%contact%system%iterations = r%iterations
         self%contact%system%products = r%products
         self%slip = r%slip
         self%load = r%load
         self%steps_done = self%scene_steps_done
         do i = 1, self%scene_steps_done
            call self%load_summary%add(steps(i))
            call note_history_checksum(self, steps(i))
         end do
         if (self%scene_steps_done > 0) self%message = 'step '//to_text(self%scene_steps_done)//' was reached'
         if (r%leg > 1) call continue_step(self, steps(self%scene_steps_done + 1), r%leg)
      end associate
   end subroutine resume

   !> Continue an interrupted step with segment `leg`; its cycles began at mark_loading.
   subroutine continue_step(self, step, leg)
      class(simulation_type), intent(inout) :: self
      type(step_type), intent(in) :: step
      integer, intent(in) :: leg

      call self%load_summary%add(step)
      self%leg%number = leg
      call set_ends(self, step, self%marks(mark_loading)%state)
   end subroutine continue_step

   !> Begin a step at the present state.
   subroutine begin_step(self, step)
      class(simulation_type), intent(inout) :: self
      type(step_type), intent(in) :: step
      integer :: i

      if (allocated(self%trial)) deallocate (self%trial)
      call self%load_summary%add(step)
      self%leg%number = 1
      do i = 1, motion_count
         if (step%control(i) /= control_keep) call self%contact%begin_motion(i)
      end do
      call set_ends(self, step, self%contact%state)
      if (step%cycles > 0) call begin_cycles(self)
   end subroutine begin_step

   !> The loads at both ends of a step that begins at the state `start`: its targets, and the loads to which its cycles return.
   subroutine set_ends(self, step, start)
      class(simulation_type), intent(inout) :: self
      type(step_type), intent(in) :: step
      type(contact_state_type), intent(in) :: start

      self%leg%there = target_of(self%load, step%control, step%target)
      self%leg%back = start_of(start%fields%force, start%fields%motion, self%leg%there)
      associate (contact => self%contact)
         if (allocated(contact%derivatives)) &
            call contact%derivatives%begin_step(contact%parameters, self%steps_done + 1, step%control, allocated(step%path), &
                                                self%leg%there%control)
      end associate
   end subroutine set_ends

   !> End a step early with an error.
   subroutine end_step_early(self, step, error)
      class(simulation_type), intent(inout) :: self
      type(step_type), intent(in) :: step
      type(error_type), intent(in) :: error

      self%outcome = error%status
      self%message = error%message//trim(hint_of_datum(self))
      if (allocated(step%path)) self%message = 'row '//to_text(step%row + mod(self%leg%number - 1, step%turns()))//', cycle '// &
                                               to_text(1 + (self%leg%number - 1)/step%turns())//': '//self%message
      self%leg%number = 0
      self%failed_step = self%steps_done + 1
      call note_history_checksum(self, step)
   end subroutine end_step_early

   !> A prescribed approach ends where the contact is wider than its datum: the compliance of a flat contact of the half-width a is
   !> proportional to ln(2 d/a), and where it vanishes, the contact grows without approach.
   pure function hint_of_datum(self) result(hint)
      class(simulation_type), intent(in) :: self
      character(len=200) :: hint
      real(wp) :: half_width

      hint = ''
      associate (scene => self%contact%model%scene)
         if (self%outcome /= MFV_NO_CONTINUATION .and. self%outcome /= MFV_SEPARATED) return
         if (self%leg%segment%load(motion_approach)%control /= control_displacement .or. .not. scene%has_datum()) return
         half_width = self%contact%half_width() + 0.5_wp*self%contact%model%interval()
         if (half_width > most_of_datum*scene%datum()) &
            hint = '; the contact half-width of '//to_text(half_width, 3)//' exceeds the datum '//to_text(scene%datum(), 3)// &
                   ', which ends the approach: set a larger datum in &body, or prescribe normal_force'
      end associate
   end function hint_of_datum

   !> Add a completed step to the checksum of the load history: its controls and targets, and its final state.
   subroutine note_history_checksum(self, step)
      class(simulation_type), intent(inout) :: self
      type(step_type), intent(in) :: step
      integer, parameter :: first_capacity = 16
      integer(int64), allocatable :: longer(:)
      integer(int64) :: checksum
      integer(int8) :: mold(1)

      if (self%keep_history == history_none .and. self%keep_states == states_none) return
      if (.not. allocated(self%history_checksums)) allocate (self%history_checksums(first_capacity), source=0_int64)
      if (self%load_summary%steps > size(self%history_checksums)) then
         allocate (longer(2*self%load_summary%steps), source=0_int64)
         longer(:size(self%history_checksums)) = self%history_checksums
         call move_alloc(longer, self%history_checksums)
      end if
      checksum = 0
      if (self%load_summary%steps > 1) checksum = self%history_checksums(self%load_summary%steps - 1)
      call add_to_checksum(transfer([step%control, step%cycles, &
                                     merge(1, 0, step%friction), self%contact%events], mold), checksum)
      associate (f => self%contact%state%fields)
         call add_to_checksum(transfer([step%target, step%steady_tolerance, f%force, f%motion, self%contact%state%dissipation], &
                                       mold), checksum)
      end associate
      if (allocated(step%path)) call add_to_checksum(transfer(step%path, mold), checksum)
      self%history_checksums(self%load_summary%steps) = checksum
   end subroutine note_history_checksum

   !> The checksum of the load history so far; 0 at the start, and if neither history nor states are kept.
   pure integer(int64) function history_checksum(self)
      class(simulation_type), intent(in) :: self

      history_checksum = 0
      if (allocated(self%history_checksums) .and. self%load_summary%steps > 0) &
         history_checksum = self%history_checksums(self%load_summary%steps)
   end function history_checksum

   !> Whether the load history passed through a state after `steps` steps with this checksum; true if neither history nor states
   !> are kept.
   pure logical function passed_through(self, steps, history_checksum)
      class(simulation_type), intent(in) :: self
      integer, intent(in) :: steps
      integer(int64), intent(in) :: history_checksum

      passed_through = self%keep_history == history_none .and. self%keep_states == states_none
      if (passed_through) return
      passed_through = steps <= self%load_summary%steps
      if (passed_through .and. steps > 0) passed_through = self%history_checksums(steps) == history_checksum
   end function passed_through

   !> Begin the cycles of a step at the present state.
   subroutine begin_cycles(self)
      class(simulation_type), intent(inout) :: self
      integer :: i

      do i = 1, mark_pending
         self%marks(i)%step = 0
      end do
      self%leg%cycle = cycle_type()
      self%leg%cycle%step = self%steps_done + 1
      self%leg%cycle%loading_slip = self%slip
      call set_mark(self, mark_loading, 0)
      call restart_cycle(self)
   end subroutine begin_cycles

   !> The present state as a turning point. `stiffness`: see turning_point_type.
   type(turning_point_type) function turning_point_here(self, stiffness) result(point)
      class(simulation_type), intent(in) :: self
      real(wp), intent(in) :: stiffness

      associate (contact => self%contact)
         point = new_turning_point(contact%model, contact%state, self%slip, contact%work, contact%work_error, stiffness)
      end associate
   end function turning_point_here

   !> Complete leg `leg` of cycles of `turns` legs. Store its end if it is the farthest of its cycle so far and, after a complete
   !> cycle, the cycle.
   subroutine complete_leg(self, leg, turns, cycle)
      class(simulation_type), intent(inout) :: self
      integer, intent(in) :: leg, turns
      type(cycle_type), intent(inout) :: cycle
      type(contact_state_type) :: before
      type(turning_point_type) :: point
      logical :: is_farthest

      point = turning_point_here(self, self%contact%leaving%stiffness)
      call cycle%add_point(point, is_first=mod(leg, turns) == 1)
      if (mod(leg, turns) /= 0) then
         is_farthest = mod(leg, turns) == 1
         if (.not. is_farthest) is_farthest = cycle%is_farther(point)
         if (.not. is_farthest) return
         call add_edge_fields(self, point)
         cycle%reversal = point
         call set_mark(self, mark_pending, leg)
         return
      end if
      self%cycles_done = self%cycles_done + 1
      cycle%number = leg/turns
      cycle%turns = turns
      cycle%worn_area = self%contact%model%force(self%contact%state%worn)
      cycle%overall = self%cycles_done
      cycle%start = cycle%return
      self%marks(mark_cycle_start) = self%marks(mark_return)
      self%marks(mark_reversal) = self%marks(mark_pending)
      call add_edge_fields(self, point)
      cycle%return = point
      before = self%padded(self%marks(mark_cycle_start))
      cycle%change = change_since(self, before)
      call set_mark(self, mark_return, leg)
      if (cycle%number == 1) cycle%first_dissipation = cycle%dissipation()
      if (cycle%number == 1) cycle%first_slip = cycle%slip()
      call complete_extremes(self, cycle)
      call append_cycle(self%cycles, self%cycle_count, cycle, self%keep_history == history_none)
   end subroutine complete_leg

   !> The left and right edge of the patches of the present state, shape (2, patches).
   function edge_fields(self, patches) result(edges)
      class(simulation_type), intent(in) :: self
      type(patch_type), intent(in) :: patches(:)
      type(edge_field_type) :: edges(2, size(patches))
      type(contact_state_type), allocatable :: before

      if (self%marks(mark_turn)%step > 0) allocate (before, source=self%padded(self%marks(mark_turn)))
      associate (contact => self%contact)
         edges = edge_fields_of(contact%model, contact%system, contact%state, self%load, patches, before)
      end associate
   end function edge_fields

   !> Add the outermost edges of the present state to its turning point; not where the surfaces wear, whose edges are as fine as
   !> what wears away in a cycle, nor of coupled bodies, whose edges are known at one of both ends only: where they slip.
   subroutine add_edge_fields(self, point)
      class(simulation_type), intent(in) :: self
      type(turning_point_type), intent(inout) :: point
      type(patch_type), allocatable :: patches(:)
      type(edge_field_type), allocatable :: edges(:, :)

      point%left = undefined_edge()
      point%right = point%left
      if (self%contact%model%scene%wear%acts() .or. self%contact%model%couples(block_wt)) return
      call find_patches(self%contact%model, self%contact%state, patches)
      if (size(patches) == 0) return
      edges = self%edge_fields(patches)
      point%left = edges(1, 1)
      point%right = edges(2, size(patches))
   end subroutine add_edge_fields

   !> Note what the state at the end of the present segment adds to the extremes of its stretch.
   subroutine note_extremes(self, step)
      class(simulation_type), intent(inout) :: self
      type(step_type), intent(in) :: step
      integer :: i, turn
      integer :: place(candidate_count), yield_place

      turn = 1 + mod(self%leg%number - 1, step%turns())
      if (merge(turn, 0, step%cycles > 0) == 1 .or. (step%row == 1 .and. self%leg%number == 1)) then
         self%extremes = load_extremes_type(stretch=over_cycle, step=self%steps_done + 1)
         if (step%row > 0) self%extremes%stretch = over_rows
         self%slip_range = slip_range_type()
      end if
      associate (extremes => self%extremes, contact => self%contact)
         i = turn
         if (extremes%stretch == over_rows) i = step%row + turn - 1
         if (extremes%stretch == over_steps) i = self%steps_done + 1
         call extremes%add_state(contact%model, contact%state, self%slip_range, i, step%friction, place)
         do i = 1, candidate_count
            if (place(i) > 0) call set_mark(self, mark_of(mark_candidate, i, place(i)), self%leg%number)
         end do
         do i = 1, size(candidate_von_mises)
            associate (candidate => candidate_von_mises(i))
               if (place(candidate) == 0) cycle
               call add_estimate(self%yield_estimate(:, i), extremes%estimate(place(candidate), candidate), yield_place)
               if (yield_place > 0) call set_mark(self, mark_of(mark_yield, i, yield_place), self%leg%number)
            end associate
         end do
      end associate
   end subroutine note_extremes

   !> Add the largest tensions, and the stresses along the surface at `x`, to the last history record.
   subroutine record_surface(contact, x)
      type(contact_path_type), intent(inout) :: contact
      real(wp), intent(in) :: x
      type(largest_type) :: largest
      logical :: available
      integer :: side

      associate (record => contact%history%record(contact%history%records))
         do side = 1, size(record%tension)
            record%surface_stress(side) = surface_stress_at(contact%model, contact%state, side == 2, x)
            call find_largest_tension(contact%model, contact%state, side == 2, largest, available)
            if (.not. available) cycle
            record%tension(side) = largest%value
            record%tension_x(side) = largest%x
         end do
      end associate
   end subroutine record_surface

   !> The extremes of a complete cycle. The search for the largest tensions is skipped if they repeat those of the cycle before.
   subroutine complete_extremes(self, cycle)
      class(simulation_type), intent(inout) :: self
      type(cycle_type), intent(inout) :: cycle
      integer :: i, j, candidate

      cycle%extremes = self%extremes
      do i = 1, size(candidate_tension)
         candidate = candidate_tension(i)
         if (cycle%number > 1) then
            associate (before => self%cycles(self%cycle_count)%extremes)
               cycle%extremes%searched(candidate) = before%searched(candidate)
               if (self%extremes%is_repeated(before, candidate)) cycle
            end associate
         end if
         call search(self, mark_of(mark_candidate, candidate, 1), candidate, cycle%extremes)
      end do
      do i = 1, size(candidate_von_mises)
         do j = 1, count(cycle%extremes%row(:, candidate_von_mises(i)) > 0)
            self%marks(mark_of(mark_last_cycle, i, j)) = self%marks(mark_of(mark_candidate, candidate_von_mises(i), j))
         end do
      end do
   end subroutine complete_extremes

   !> The mark of a row: `first` is that of the first row of the first stress, `number` that of the stress.
   pure integer function mark_of(first, number, row) result(mark)
      integer, intent(in) :: first, number, row

      mark = first + (number - 1)*most_rows + row - 1
   end function mark_of

   !> Search for a largest stress in the states of its marks from `first` on, the most promising ones first; none where no state has
   !> it.
   subroutine search(self, first, candidate, extremes)
      class(simulation_type), intent(in) :: self
      integer, intent(in) :: first, candidate
      type(load_extremes_type), intent(inout) :: extremes
      type(largest_type) :: largest
      logical :: available, is_left(most_rows)
      integer :: i, number

      associate (found => extremes%searched(candidate), estimates => extremes%estimate(:, candidate))
         found = extreme_type()
         is_left = extremes%row(:, candidate) > 0
         do number = 1, count(is_left)
            i = maxloc(estimates, dim=1, mask=is_left)
            is_left(i) = .false.
            if (found%row > 0) then
               if (ieee_is_nan(found%value)) exit
               ! The last state, if it is among these, has a value of its own among the observables, which must not be larger.
               if (estimates(i) < least_estimate*found%value .and. extremes%row(i, candidate) /= extremes%last_row) cycle
            end if
            call find_largest(self%padded(self%marks(first + i - 1)))
            if (.not. available) exit
            associate (interval => self%contact%model%interval())
               call found%raise_with_rival(largest%value, extremes%row(i, candidate), interval, largest%x, largest%y)
               call found%compete(largest%rival, largest%rival_x, interval)
            end associate
         end do
      end associate

   contains

      subroutine find_largest(state)
         type(contact_state_type), intent(in) :: state

         if (any(candidate == candidate_tension)) then
            call find_largest_tension(self%contact%model, state, candidate == candidate_tension(2), largest, available)
         else
            call find_largest_von_mises(self%contact%model, state, candidate == candidate_von_mises(2), largest, available)
         end if
      end subroutine find_largest
   end subroutine search

   !> Whether the extremes are those of the last complete cycle.
   pure logical function ends_with_cycle(self)
      class(simulation_type), intent(in) :: self

      ends_with_cycle = self%cycle_count > 0
      if (ends_with_cycle) ends_with_cycle = self%cycles(self%cycle_count)%step >= self%extremes%step
   end function ends_with_cycle

   !> What the extremes are taken over, see mfv_load_extremes.
   pure integer function stretch(self)
      class(simulation_type), intent(in) :: self

      stretch = self%extremes%stretch
      if (ends_with_cycle(self)) stretch = self%cycles(self%cycle_count)%extremes%stretch
   end function stretch

   !> The extremes of the last complete cycle or, without one, of the rows of &history or all steps so far; of rows that follow the
   !> cycles, or a first cycle that is not complete: of these.
   subroutine find_extremes(self, extremes)
      class(simulation_type), intent(in) :: self
      type(load_extremes_type), intent(out) :: extremes
      integer :: i

      extremes = self%extremes
      if (ends_with_cycle(self)) then
         extremes = self%cycles(self%cycle_count)%extremes
      else
         do i = 1, size(candidate_tension)
            call search(self, mark_of(mark_candidate, candidate_tension(i), 1), candidate_tension(i), extremes)
         end do
      end if
      do i = 1, size(candidate_von_mises)
         call search(self, first_of_von_mises(self, i), candidate_von_mises(i), extremes)
      end do
   end subroutine find_extremes

   !> The first mark of the states in which find_extremes searches for the largest von Mises stress of a body.
   pure integer function first_of_von_mises(self, body) result(mark)
      class(simulation_type), intent(in) :: self
      integer, intent(in) :: body

      mark = mark_of(mark_candidate, candidate_von_mises(body), 1)
      if (ends_with_cycle(self)) mark = mark_of(mark_last_cycle, body, 1)
   end function first_of_von_mises

   !> The largest von Mises stress of the lower or `upper` body over the whole load history, at the ends of its segments; of layers,
   !> as a part of their yield strengths. `extremes`: of find_extremes; what is known of their states is not searched for again.
   !> `mark`: of the state; 0 without any.
   subroutine find_largest_of_history(self, upper, extremes, largest, mark)
      class(simulation_type), intent(in) :: self
      logical, intent(in) :: upper
      type(load_extremes_type), intent(in) :: extremes
      type(largest_type), intent(out) :: largest
      integer, intent(out) :: mark
      type(largest_type) :: other
      logical :: available
      integer :: i, body, found, next

      body = merge(2, 1, upper)
      mark = 0
      associate (known => extremes%searched(candidate_von_mises(body)), rows => extremes%row(:, candidate_von_mises(body)), &
                 estimates => extremes%estimate(:, candidate_von_mises(body)))
         if (known%row > 0) then
            largest = largest_type(known%value, known%x, known%y)
            found = findloc(rows, known%row, dim=1)
            mark = first_of_von_mises(self, body) + found - 1
            ! The first one of equal states.
            i = findloc(is_same_estimate(self%yield_estimate(:, body), estimates(found)), .true., dim=1)
            if (i > 0) mark = mark_of(mark_yield, body, i)
         end if
         do i = 1, rows_of_yield
            next = mark_of(mark_yield, body, i)
            if (self%marks(next)%step == 0) cycle
            if (mark > 0) then
               if (.not. ieee_is_finite(largest%value)) exit
               if (any(rows > 0 .and. is_same_estimate(estimates, self%yield_estimate(i, body)))) cycle
               if (self%yield_estimate(i, body) < least_estimate*largest%value) cycle
            end if
            call find_largest_von_mises(self%contact%model, self%padded(self%marks(next)), upper, other, available)
            if (.not. available) exit
            if (mark > 0) then
               if (other%value*strength_at(largest) <= largest%value*strength_at(other)) cycle
            end if
            largest = other
            mark = next
         end do
      end associate

   contains

      !> The yield strength where a stress is.
      pure real(wp) function strength_at(stress)
         type(largest_type), intent(in) :: stress

         associate (scene => self%contact%model%scene)
            if (upper) then
               strength_at = scene%upper%strength_at(stress%y)
            else
               strength_at = scene%lower%strength_at(stress%y)
            end if
         end associate
      end function strength_at
   end subroutine find_largest_of_history

   !> Largest change of a traction since the state `before` on the same mesh, relative to the largest traction so far.
   pure real(wp) function change_since(self, before)
      class(simulation_type), intent(in) :: self
      type(contact_state_type), intent(in) :: before
      real(wp) :: scale

      change_since = 0.0_wp
      scale = self%contact%certificate%traction_scale
      associate (now => self%contact%state%fields, then => before%fields)
         if (scale > 0.0_wp) change_since = max(maxval(abs(now%pressure - then%pressure)), &
                                                maxval(abs(now%shear - then%shear)))/scale
      end associate
   end function change_since

   !> Store the present state as mark `mark`.
   subroutine set_mark(self, mark, reversal)
      class(simulation_type), intent(inout) :: self
      integer, intent(in) :: mark, reversal

      self%marks(mark)%state = self%contact%state
      self%marks(mark)%step = self%steps_done + 1
      self%marks(mark)%reversal = reversal
      self%marks(mark)%added = self%contact%model%added
   end subroutine set_mark

   !> The load at the end of a step: `value` is its target; a load that the step does not control is unchanged.
   elemental type(load_type) function target_of(load, control, value)
      type(load_type), intent(in) :: load
      integer, intent(in) :: control
      real(wp), intent(in) :: value

      target_of = load
      if (control /= control_keep) target_of = load_type(control, value)
   end function target_of

   !> The same control with the present value of its force or motion.
   elemental type(load_type) function start_of(force, motion, load)
      real(wp), intent(in) :: force, motion
      type(load_type), intent(in) :: load

      start_of = load_type(load%control, merge(force, motion, load%control == control_force))
   end function start_of

   !> Apply the loads of the current leg.
   subroutine apply_leg(self, step, before, segments, observer, error)
      class(simulation_type), intent(inout) :: self
      type(step_type), intent(in) :: step
      integer, intent(in) :: before, segments
      class(observer_type), intent(inout), optional :: observer
      type(error_type), allocatable, intent(out) :: error
      type(load_type) :: targets(motion_count)

      if (step%cycles > 0 .and. self%leg%number > 1 .and. mod(self%leg%number, step%turns()) == 1 .and. &
          self%contact%model%scene%wear%acts()) call restart_cycle(self)
      targets = merge(self%leg%there, self%leg%back, mod(self%leg%number, 2) == 1)
      if (allocated(step%path)) targets = target_of(self%leg%there, step%control, &
                                                    step%path(:, 1 + mod(self%leg%number - 1, step%turns())))
      if (allocated(self%contact%derivatives)) &
         call self%contact%derivatives%begin_segment(mod(self%leg%number, 2) == 0 .and. .not. allocated(step%path), &
                                                     targets%control)
      call begin_segment(self, targets, step, before, segments)
      if (self%contact%model%tangential .and. self%slip%turns_with(changes_of(self))) &
         call set_mark(self, mark_turn, self%leg%number)
      call apply_segment(self, observer, error)
      if (.not. allocated(error)) call reach_exactly(self%contact, targets)
      if (allocated(self%contact%derivatives)) then
         if (allocated(error)) then
            call self%contact%derivatives%fail('the last step ended early')
         else if (.not. (step%friction .and. self%contact%model%scene%friction%acts())) then
            call differentiate_end(self%contact, self%leg%segment)
         end if
      end if
      call self%slip%add_segment(self%contact%model, self%leg%start, self%contact%state, changes_of(self), &
                                 self%contact%slip_zone_nodes, self%contact%system%tolerance)
      self%load%control = targets%control
      self%load%value = targets%value
   end subroutine apply_leg

   !> Give the prescribed motions of a path the values of its `targets`, which they have reached but for round-off: another segment
   !> to the same targets is then without change. Without normal force, or pressures in a neat fit, nothing remains in contact.
   subroutine reach_exactly(path, targets)
      class(contact_path_type), intent(inout) :: path
      type(load_type), intent(in) :: targets(motion_count)

      where (path%model%moves .and. targets%control == control_displacement) path%state%fields%motion = targets%value
      associate (normal => targets(motion_approach))
         if (path%model%scene%is_neat() .or. (normal%control == control_force .and. .not. normal%value > 0.0_wp)) &
            call path%separate()
      end associate
   end subroutine reach_exactly

   !> Apply the loads of the current segment by the algorithm of the scene. Nothing changes while they are held: the rates of events
   !> would be round-off.
   subroutine apply_segment(self, observer, error)
      class(simulation_type), intent(inout) :: self
      class(observer_type), intent(inout), optional :: observer
      type(error_type), allocatable, intent(out) :: error

      associate (method => self%contact%model%scene%method)
         if (is_held(self)) then
            call self%contact%start_segment(self%leg%segment, error)
            if (.not. allocated(error)) call self%contact%notify(self%leg%segment, 1.0_wp, observer, error)
         else if (method%algorithm == algorithm_conventional) then
            call apply_conventionally(self%contact, self%leg%segment, observer, error)
         else if (method%stepping == stepping_leap .and. .not. strains(self%leg%segment)) then
            call apply_by_large_increments(self%contact, self%leg%segment, observer, error)
         else
            call apply_directly(self%contact, self%leg%segment, observer, error)
         end if
      end associate
   end subroutine apply_segment

   !> Whether all loads of a contact are held in the current segment. (Derivatives by its targets are found from increments.)
   pure logical function is_held(self)
      class(simulation_type), intent(in) :: self

      is_held = any(in_contact(self%contact%state%status)) .and. .not. allocated(self%contact%derivatives) .and. &
                .not. any(abs(self%leg%segment%load%rate) > 0.0_wp)
   end function is_held

   !> Whether a bulk stress or the wear changes in a segment. They move the stick zone while the shear narrows it, so that an edge
   !> may turn within the segment, which large increments do not resolve.
   pure logical function strains(segment)
      type(segment_type), intent(in) :: segment

      strains = any(motions%is_known .and. abs(segment%load%rate) > 0.0_wp)
   end function strains

   !> The load segment from the present state to `targets`.
   subroutine begin_segment(self, targets, step, before, segments)
      class(simulation_type), intent(inout) :: self
      type(load_type), intent(in) :: targets(motion_count)
      type(step_type), intent(in) :: step
      integer, intent(in) :: before, segments
      integer :: i
      real(wp) :: force(motion_count)

      force = self%contact%certificate%force_scale(motion_approach)*self%contact%model%unit_of_arm([(i, i=1, motion_count)])
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
      call self%contact%note_start(self%leg%segment%load)
   end subroutine begin_segment

   !> Changes of the loads in the present segment, to be compared with each other in how they make nodes slip: as tangential forces,
   !> displacements times the modulus, and what presses times the coefficient of friction.
   pure function changes_of(self) result(changes)
      class(simulation_type), intent(in) :: self
      real(wp) :: changes(motion_count), unit(motion_count)
      integer :: i

      associate (load => self%leg%segment%load, model => self%contact%model)
         unit = model%unit_of_arm([(i, i=1, motion_count)])
         changes = load%rate*merge(1.0_wp/unit, unit*model%compliance%modulus, load%control == control_force)
         where (.not. (motions%is_stress .or. [(i == motion_shift, i=1, motion_count)])) &
            changes = changes*model%scene%friction%static%largest()
      end associate
   end function changes_of

   !> The load from `start` to `goal`, with its rate per segment. A change of force within round-off of the largest force so far,
   !> `scale`, counts as zero.
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

   !> The state of a snapshot on the present mesh, with the nodes added since.
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
