!> A scene and its run through the load history: steps, reversals, the state at the end of each, and the outcome.
module mfv_simulation
   use, intrinsic :: iso_fortran_env, only: int64, int8
   use mfv_checksum, only: add_to_checksum
   use mfv_contact_model, only: new_contact_model
   use mfv_contact_path, only: contact_path_type, new_contact_path
   use mfv_error, only: error_type
   use mfv_extreme_states, only: note_extremes
   use mfv_kinds, only: wp
   use mfv_load_cycles, only: begin_cycles, complete_cycle_segment, is_steady, restart_cycle, wears
   use mfv_load_segment, only: reach_targets, start_of, target_of
   use mfv_motions, only: motion_count, motion_approach, motion_shift, control_displacement, control_keep
   use mfv_node_status, only: event_none, event_step_end, event_stopped
   use mfv_observer, only: observer_type
   use mfv_run_state
   use mfv_scene, only: most_of_datum, scene_type, step_type
   use mfv_state_interior, only: find_largest_tension, surface_stress_at
   use mfv_status, only: MFV_COMPLETE, MFV_INPUT_ERROR, MFV_NO_CONTINUATION, MFV_SEPARATED
   use mfv_stress_search, only: largest_type
   use mfv_strings, only: to_text
   use mfv_wear_cycles, only: apply_block, block_failed, block_is_due, plan_block, shorten_block
   implicit none
   private
   public :: simulation_type, new_simulation, sensitivity_type
   public :: history_events, history_steps, history_none
   public :: states_auto, states_reversals, states_steps, states_none, states_last_cycle
   public :: mark_loading, mark_reversal, mark_return, mark_cycle_start

   type, extends(run_state_type) :: simulation_type
      !> Segments of the scene before each step, and of all steps, for progress, shape (steps + 1).
      integer, allocatable, private :: segments_before(:)
   contains
      procedure :: run
      procedure :: advance
      procedure :: has_segments_left
      procedure :: run_segment
      procedure :: resume
      procedure :: history_checksum
      procedure :: passed_through
   end type simulation_type

contains

   !> A simulation of a scene, at its start. Its outcome is MFV_INPUT_ERROR if the scene has a fault. `keep_history`:
   !> history_events, history_steps or history_none. `keep_states`: see states_auto and so on; states_reversals by default.
   function new_simulation(scene, keep_history, keep_states) result(self)
      type(scene_type), intent(in) :: scene
      integer, intent(in) :: keep_history
      integer, intent(in), optional :: keep_states
      type(simulation_type) :: self
      integer :: i

      allocate (self%marks(mark_count), self%segments_before(size(scene%steps) + 1))
      self%segments_before(1) = 0
      do i = 1, size(scene%steps)
         self%segments_before(i + 1) = self%segments_before(i) + scene%steps(i)%segments()
      end do
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

   !> Run the next segment of the steps of the scene: a step, or to the next turning point of its cycles.
   subroutine run_segment(self, observer)
      class(simulation_type), intent(inout) :: self
      class(observer_type), intent(inout), optional :: observer
      type(step_type) :: step
      integer :: i

      i = self%scene_steps_done + 1
      step = self%contact%model%scene%steps(i)  ! a copy, since the model may be replaced
      call advance_segment(self, step, self%segments_before(i), self%segments_before(size(self%segments_before)), observer)
      if (self%outcome /= MFV_COMPLETE) then
         self%failed_scene_step = i
      else if (self%current%number == 0) then
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
         if (self%current%number == 0) exit
      end do
   end subroutine advance

   !> Apply the loads of the next segment of a step; the step is complete when current%number is 0. `before`, `segments`: number of
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
      if (self%current%number == 0) call begin_step(self, step)
      if (.not. block_is_due(self)) call complete_segment(self, step, before, segments, observer, error)
      if (block_is_due(self) .and. .not. allocated(error)) call apply_block(self, step, before, segments, observer, error)
      if (allocated(error)) then
         if (block_failed(self, error)) then
            call shorten_block(self, shorter)
            return
         end if
      end if
      if (self%keep_history /= history_none) &
         call self%contact%record(merge(event_stopped, event_step_end, allocated(error)), 0, 0, self%steps_done + 1)
      if (allocated(error)) then
         call end_step_early(self, step, error)
         return
      end if
      if (allocated(self%stress_at) .and. self%keep_history /= history_none) call record_surface(self%contact, self%stress_at)
      associate (i => self%current%number)
         is_last = i == step%segments()
         if (.not. is_last .and. mod(i, step%turns()) == 0 .and. step%steady_tolerance > 0.0_wp) is_last = is_steady(self, step)
         if (keeps_state(self, step, is_last)) call self%take_snapshot(self%steps_done + 1, i)
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

      if (step%cycles > 0 .and. self%current%number > 1 .and. mod(self%current%number, step%turns()) == 1 .and. &
          self%contact%model%scene%wear%acts()) call restart_cycle(self)
      call reach_targets(self, step, before, segments, observer, error)
      if (allocated(error)) return
      call note_extremes(self, step)
      if (step%cycles == 0) return
      call complete_cycle_segment(self, step%turns())
      if (wears(self, step)) call plan_block(self, step)
   end subroutine complete_segment

   !> Begin a step at the present state.
   subroutine begin_step(self, step)
      class(simulation_type), intent(inout) :: self
      type(step_type), intent(in) :: step
      integer :: i

      if (allocated(self%wear_trial)) deallocate (self%wear_trial)
      call self%load_summary%add(step)
      self%current%number = 1
      do i = 1, motion_count
         if (step%control(i) /= control_keep) call self%contact%begin_motion(i)
      end do
      call set_ends(self, step)
      if (step%cycles > 0) call begin_cycles(self)
   end subroutine begin_step

   !> The loads at both ends of a step that begins here: its targets, and the loads to which its cycles return.
   subroutine set_ends(self, step)
      class(simulation_type), intent(inout) :: self
      type(step_type), intent(in) :: step

      associate (contact => self%contact, fields => self%contact%state%fields)
         self%current%there = target_of(self%load, step%control, step%target)
         self%current%back = start_of(fields%force, fields%motion, self%current%there)
         if (allocated(contact%derivatives)) &
            call contact%derivatives%begin_step(contact%parameters, self%steps_done + 1, step%control, allocated(step%path), &
                                                self%current%there%control)
      end associate
   end subroutine set_ends

   !> Whether the state at the end of the present segment is saved. Only the last row of a load history counts as the end of a step.
   !> States of an earlier cycle are removed where only those of the last one are saved.
   logical function keeps_state(self, step, is_last)
      class(simulation_type), intent(inout) :: self
      type(step_type), intent(in) :: step
      logical, intent(in) :: is_last

      keeps_state = any(self%keep_states == [states_auto, states_reversals]) .or. &
                    (self%keep_states == states_steps .and. is_last .and. .not. step%is_passed)
      if (.not. self%keeps_last_cycle()) return
      keeps_state = .not. step%is_passed
      if (step%cycles > 0 .and. mod(self%current%number, step%turns()) == 1) call self%drop_snapshots()
   end function keeps_state

   !> Complete a step.
   subroutine end_step(self, step)
      class(simulation_type), intent(inout) :: self
      type(step_type), intent(in) :: step
      integer :: cycles

      if (allocated(self%wear_trial)) deallocate (self%wear_trial)
      cycles = (self%current%number - 1)/step%turns()
      self%current%number = 0
      self%steps_done = self%steps_done + 1
      self%message = 'step '//to_text(self%steps_done)//' was reached'
      if (step%cycles > cycles) self%message = self%message//', steady after '//to_text(cycles)//' of '// &
                                               to_text(step%cycles)//' cycles'
      if (step%cycles > cycles .and. self%current%cycle%walks()) &
         self%message = self%message//' but walking: each moves the upper body by '// &
                        to_text(self%current%cycle%drift(motion_shift), 4)
      call note_history_checksum(self, step)
   end subroutine end_step

   !> End a step early with an error.
   subroutine end_step_early(self, step, error)
      class(simulation_type), intent(inout) :: self
      type(step_type), intent(in) :: step
      type(error_type), intent(in) :: error

      self%outcome = error%status
      self%message = error%message//trim(hint_of_datum(self))
      associate (number => self%current%number, turns => step%turns())
         if (allocated(step%path)) self%message = 'row '//to_text(step%row + mod(number - 1, turns))//', cycle '// &
                                                  to_text(1 + (number - 1)/turns)//': '//self%message
      end associate
      self%current%number = 0
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
         if (self%segment%load(motion_approach)%control /= control_displacement .or. .not. scene%has_datum()) return
         half_width = self%contact%half_width() + 0.5_wp*self%contact%model%interval()
         if (half_width > most_of_datum*scene%datum()) &
            hint = '; the contact half-width of '//to_text(half_width, 3)//' exceeds the datum '//to_text(scene%datum(), 3)// &
                   ', which ends the approach: set a larger datum in &body, or prescribe normal_force'
      end associate
   end function hint_of_datum

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

   !> Continue from `restart`, which another run of the scene has stored, on the mesh of that time. The record, snapshots, cycles,
   !> marks, history and slip ranges are those of that run already. The linear solver starts without history.
   subroutine resume(self)
      class(simulation_type), intent(inout) :: self
      integer :: i

      call self%contact%restore(self%restart%contact)
      self%history_checksums = [(0_int64, i=1, self%load_summary%steps)]
      self%message = self%restart%position%message
   end subroutine resume

   !> Add a completed step to the checksum of the load history: its controls and targets, and its final state.
   subroutine note_history_checksum(self, step)
      class(simulation_type), intent(inout) :: self
      type(step_type), intent(in) :: step
      integer(int64), allocatable :: longer(:)
      integer(int64) :: checksum
      integer(int8) :: mold(1)

      if (self%keep_history == history_none .and. self%keep_states == states_none) return
      if (.not. allocated(self%history_checksums)) allocate (self%history_checksums(0))
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

end module mfv_simulation
