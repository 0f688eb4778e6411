!> The state of a run: its contact, what is kept on the way, and the position in the load history. A saved_run_type is what it was
!> at an earlier time, whether a host restores it, a block of wear is taken again, or a restart file has it.
!>
!> Restart files save path_record_type (mfv_contact_path) and run_record_type whole: what is added there, of a fixed size, is not
!> lost.
module mfv_run_state
   use, intrinsic :: iso_fortran_env, only: int64
   use mfv_contact_path, only: contact_path_type, saved_path_type, segment_type
   use mfv_contact_state, only: contact_state_type
   use mfv_contact_system, only: initial_loads, load_type
   use mfv_cycle, only: cycle_type
   use mfv_error_bar, only: error_estimate_type
   use mfv_kinds, only: wp
   use mfv_load_extremes, only: candidate_count, load_extremes_type, most_rows, slip_range_type
   use mfv_load_summary, only: load_summary_type
   use mfv_motions, only: motion_count
   use mfv_slip_zones, only: slip_record_type
   use mfv_status, only: MFV_COMPLETE
   use mfv_wear_block, only: wear_block_type
   implicit none
   private
   public :: run_state_type, run_record_type, saved_run_type, snapshot_type, wear_trial_type, sensitivity_type
   public :: history_events, history_steps, history_none
   public :: states_auto, states_reversals, states_steps, states_none, states_last_cycle, most_turning_points
   public :: mark_loading, mark_reversal, mark_return, mark_cycle_start, mark_pending, mark_candidate, mark_last_cycle, &
             mark_yield, mark_turn, mark_count, mark_of, rows_of_yield

   !> Records of the load history, in the order of the key &output history: one for every event, one for every step end, none.
   integer, parameter :: history_events = 1, history_steps = 2, history_none = 3
   !> Snapshots, in the order of the key &output states: at the ends of steps and at every turning point of a step with cycles, or
   !> of its last cycle if there are more than most_turning_points; at every turning point; of steps alone; none; or at the ends of
   !> steps and the turning points of the last cycle of a step.
   integer, parameter :: states_auto = 1, states_reversals = 2, states_steps = 3, states_none = 4, states_last_cycle = 5
   integer, parameter :: most_turning_points = 100

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

   !> The state at the end of a step, or of one reversal of a step with cycles.
   type :: snapshot_type
      type(contact_state_type) :: state
      !> Number of the step, and of the reversal in it (1 for a step without cycles).
      integer :: step = 0, reversal = 0
      !> Nodes added to the mesh at either end at that time.
      integer :: added = 0
   end type snapshot_type

   !> The current step: the loads at both of its ends, and its cycle.
   type :: current_step_type
      !> The next or current of its load segments; 0: no current step.
      integer :: number = 0
      type(load_type) :: there(motion_count), back(motion_count)
      type(cycle_type) :: cycle
   end type current_step_type

   !> What a run carries along besides states and texts, of a fixed size.
   type :: run_record_type
      !> Numbers of snapshots and cycles so far, see run_state_type; and of complete cycles of all steps.
      integer :: snapshot_count = 0, cycle_count = 0, cycles_done = 0
      !> Outcome (see mfv_status): MFV_COMPLETE as long as no error has occurred.
      integer :: outcome = MFV_COMPLETE
      !> Step that was not reached, 0 for none; and number of completed steps.
      integer :: failed_step = 0, steps_done = 0
      !> The same for the steps of the scene only; other steps may come between them.
      integer :: failed_scene_step = 0, scene_steps_done = 0
      type(current_step_type) :: current
      !> Slip zones of all segments so far.
      type(slip_record_type) :: slip
      !> Extremes of the present stretch: since the start of a cycle, the first row of &history, or the start.
      type(load_extremes_type) :: extremes
      !> Estimates of the largest von Mises stress of both bodies in the states of mark_yield, force/length^2.
      real(wp) :: yield_estimate(rows_of_yield, 2) = -1.0_wp
      !> Summary of the steps taken, the last one possibly incomplete.
      type(load_summary_type) :: load_summary
      !> The present controls and loads.
      type(load_type) :: load(motion_count) = initial_loads
   end type run_record_type

   !> The position of a run in its load history: all but its contact and what grows with the number of records.
   type, extends(run_record_type) :: position_type
      !> See mark_loading and so on, shape (mark_count); `step` is 0 if not set.
      type(snapshot_type), allocatable :: marks(:)
      !> Slip of the present stretch, see `extremes`.
      type(slip_range_type) :: slip_range
      !> Explanation of the outcome.
      character(:), allocatable :: message
   end type position_type

   !> A run at an earlier time. What it has recorded since then is dropped when it is restored. The last cycle only if there is no
   !> load history.
   type :: saved_run_type
      type(saved_path_type) :: contact
      type(position_type) :: position
      type(cycle_type), allocatable :: last_cycle
   end type saved_run_type

   !> A block of cycles of wear that the next computed cycle will judge, and all that it takes to try a shorter one.
   type :: wear_trial_type
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
      !> The start of the block: the end of its first cycle.
      type(saved_run_type) :: start
   end type wear_trial_type

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

   type, extends(position_type) :: run_state_type
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
      !> The current load segment.
      type(segment_type) :: segment
      !> Checksums of the load history up to the end of every step, if history or states are kept; the first `load_summary%steps`
      !> are in use.
      integer(int64), allocatable :: history_checksums(:)
      !> The discretisation error of the present state, if estimated (see mfv_discretisation_error).
      type(error_estimate_type), allocatable :: estimate
      !> The sensitivity of the present state to round-off, if computed (see mfv_sensitivity).
      type(sensitivity_type), allocatable :: sensitivity
      !> The present block of cycles of wear, if there is one.
      type(wear_trial_type), allocatable :: wear_trial
      !> Whether the start of each segment is stored in `restart`: its path, its record and its message. The slip range and the
      !> marks that segments before it have set do not change within a segment; others are set again.
      logical :: keep_restart = .false.
      type(saved_run_type) :: restart
   contains
      procedure :: save_to
      procedure :: restore
      procedure :: note_restart
      procedure :: take_snapshot
      procedure :: drop_snapshots
      procedure :: set_mark
      procedure :: padded
      procedure :: keeps_last_cycle
      procedure :: ends_with_cycle
      procedure :: latest_extremes
      procedure :: stretch
   end type run_state_type

contains

   !> Save a run between two segments.
   subroutine save_to(self, saved)
      class(run_state_type), intent(in) :: self
      type(saved_run_type), intent(inout) :: saved

      call self%contact%save_to(saved%contact, with_solver=.true.)
      saved%position = self%position_type
      if (allocated(saved%last_cycle)) deallocate (saved%last_cycle)
      if (self%cycle_count > 0 .and. self%keep_history == history_none) saved%last_cycle = self%cycles(1)
   end subroutine save_to

   !> Restore a run, or one of the same scene. The caller knows that it passed through this position, or keeps no records.
   subroutine restore(self, saved)
      class(run_state_type), intent(inout) :: self
      type(saved_run_type), intent(in) :: saved

      call self%contact%restore(saved%contact)
      self%position_type = saved%position
      if (allocated(saved%last_cycle) .and. self%keep_history == history_none) self%cycles = [saved%last_cycle]
   end subroutine restore

   !> Store the restart state between two segments, unless that of a block of wear that is not judged yet counts. Cycles, history
   !> records and snapshots are written as they are then: those of this time are the first of them.
   subroutine note_restart(self)
      class(run_state_type), intent(inout) :: self

      if (allocated(self%wear_trial)) then
         if (self%wear_trial%is_worn) return
      end if
      call self%contact%save_to(self%restart%contact, with_solver=.false.)
      self%restart%position%run_record_type = self%run_record_type
      self%restart%position%message = self%message
   end subroutine note_restart

   !> Keep the present state as a snapshot.
   subroutine take_snapshot(self, step, reversal)
      class(run_state_type), intent(inout) :: self
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

   !> Remove the snapshots of the present step, also from a restart and from the start of a block of wear: others take their places.
   subroutine drop_snapshots(self)
      class(run_state_type), intent(inout) :: self

      do while (self%snapshot_count > 0)
         if (self%snapshots(self%snapshot_count)%step /= self%steps_done + 1) exit
         self%snapshot_count = self%snapshot_count - 1
      end do
      associate (restart => self%restart%position)
         restart%snapshot_count = min(restart%snapshot_count, self%snapshot_count)
      end associate
      if (.not. allocated(self%wear_trial)) return
      associate (start => self%wear_trial%start%position)
         start%snapshot_count = min(start%snapshot_count, self%snapshot_count)
      end associate
   end subroutine drop_snapshots

   !> Store the present state as mark `mark`.
   subroutine set_mark(self, mark, reversal)
      class(run_state_type), intent(inout) :: self
      integer, intent(in) :: mark, reversal

      self%marks(mark)%state = self%contact%state
      self%marks(mark)%step = self%steps_done + 1
      self%marks(mark)%reversal = reversal
      self%marks(mark)%added = self%contact%model%added
   end subroutine set_mark

   !> The mark of a row: `first` is that of the first row of the first stress, `number` that of the stress.
   pure integer function mark_of(first, number, row) result(mark)
      integer, intent(in) :: first, number, row

      mark = first + (number - 1)*most_rows + row - 1
   end function mark_of

   !> The state of a snapshot on the present mesh, with the nodes added since.
   function padded(self, snapshot) result(state)
      class(run_state_type), intent(in) :: self
      type(snapshot_type), intent(in) :: snapshot
      type(contact_state_type) :: state

      state = snapshot%state
      if (self%contact%model%added == snapshot%added) return
      call state%widen(self%contact%model%added - snapshot%added)
      call self%contact%model%displace(state%fields)
   end function padded

   !> Whether only the states of the last cycle of the current step are kept.
   pure logical function keeps_last_cycle(self)
      class(run_state_type), intent(in) :: self

      keeps_last_cycle = self%keep_states == states_last_cycle .or. &
                         (self%keep_states == states_auto .and. self%current%number > most_turning_points)
   end function keeps_last_cycle

   !> Whether the extremes are those of the last complete cycle.
   pure logical function ends_with_cycle(self)
      class(run_state_type), intent(in) :: self

      ends_with_cycle = self%cycle_count > 0
      if (ends_with_cycle) ends_with_cycle = self%cycles(self%cycle_count)%step >= self%extremes%step
   end function ends_with_cycle

   !> The extremes of the last complete cycle or, where the run does not end with one, of the present stretch (load_extremes_type).
   pure type(load_extremes_type) function latest_extremes(self)
      class(run_state_type), intent(in) :: self

      latest_extremes = self%extremes
      if (self%ends_with_cycle()) latest_extremes = self%cycles(self%cycle_count)%extremes
   end function latest_extremes

   !> What the extremes are taken over, see mfv_load_extremes.
   pure integer function stretch(self)
      class(run_state_type), intent(in) :: self

      stretch = self%extremes%stretch
      if (ends_with_cycle(self)) stretch = self%cycles(self%cycle_count)%extremes%stretch
   end function stretch

end module mfv_run_state
