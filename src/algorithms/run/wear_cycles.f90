!> Cycles whose friction wears the surfaces: in blocks (mfv_wear_block) that the cycles after them judge and that are taken again,
!> shorter, if they err.
module mfv_wear_cycles
   use mfv_contact_state, only: contact_state_type
   use mfv_contact_system, only: load_type, solver_work_type
   use mfv_error, only: error_type
   use mfv_kinds, only: wp
   use mfv_load_segment, only: apply_segment, begin_segment
   use mfv_motions, only: motion_count, motion_approach, motion_wear, control_displacement, control_force
   use mfv_node_status, only: in_contact
   use mfv_observer, only: observer_type
   use mfv_run_state, only: mark_cycle_start, run_state_type, wear_trial_type
   use mfv_scene, only: step_type
   use mfv_status, only: MFV_INTERRUPTED
   use mfv_wear_block, only: find_wear_block, wear_block_type, widened, work_of_wear
   implicit none
   private
   public :: plan_block, apply_block, block_is_due, block_failed, shorten_block

contains

   !> Judge the block of cycles of wear before the present cycle by this cycle. If its error is above the tolerance, go back to its
   !> start and plan a shorter one, else plan the block that begins with this cycle. The first cycle of a step wears alone, since it
   !> often dissipates otherwise than those that follow; so do the two after each block: the slip that the wear of a block causes at
   !> once is not that of the cycles that follow. A block may err by the part `part` of the tolerance, since errors add up.
   subroutine plan_block(self, step)
      class(run_state_type), intent(inout) :: self
      type(step_type), intent(in) :: step
      real(wp), parameter :: safety = 0.9_wp, smallest = 0.1_wp, largest = 5.0_wp, part = 0.5_wp
      real(wp), allocatable :: correction(:)
      type(wear_block_type) :: next
      real(wp) :: error, factor
      integer :: cycles

      cycles = 0
      allocate (correction(self%contact%model%nodes()), source=0.0_wp)
      associate (wear => self%contact%model%scene%wear)
         if (allocated(self%wear_trial)) then
            call find_wear_block(self%contact, cycle_work(self), 1, 1, is_pressed(self), next)
            if (self%wear_trial%block%cycles > 1 .and. .not. allocated(self%wear_trial%settling)) then
               self%wear_trial%settling = next%depth
               self%wear_trial%settles = .true.
               return
            end if
            call judge_block(self, next, correction, error)
            factor = largest
            if (error > 0.0_wp) factor = min(max(safety*sqrt(part*wear%tolerance/error), smallest), largest)
            cycles = max(int(factor*max(self%wear_trial%block%cycles, 2)), 1)
            if (self%wear_trial%block%cycles > 1 .and. wear%block > 0) then
               self%contact%state%wear_error = self%contact%state%wear_error + error*self%current%cycle%worn_area
            else if (self%wear_trial%block%cycles > 1 .and. error > part*wear%tolerance) then
               call shorten_block(self, factor)
               return
            end if
            deallocate (self%wear_trial)
         end if
         if (wear%block > 0) cycles = wear%block
         if (self%current%cycle%number == 1) cycles = 1
      end associate
      allocate (self%wear_trial)
      self%wear_trial%cycles = min(cycles, most_worn_at_once(self, step))
      call move_alloc(correction, self%wear_trial%correction)
   end subroutine plan_block

   !> Correction of the depth of the last block, length, shape (nodes), and its error relative to all that is worn; `next`: of the
   !> present cycle.
   subroutine judge_block(self, next, correction, error)
      class(run_state_type), intent(in) :: self
      type(wear_block_type), intent(in) :: next
      real(wp), allocatable, intent(out) :: correction(:)
      real(wp), intent(out) :: error
      real(wp) :: settling(size(next%depth))

      settling = 0.0_wp
      if (allocated(self%wear_trial%settling)) settling = widened(self%wear_trial%settling, size(settling))
      call self%wear_trial%block%judge(settling, next%depth, self%contact%state%worn, self%contact%model%width, correction, error)
   end subroutine judge_block

   !> Most cycles of the block that begins with the present one.
   pure integer function most_worn_at_once(self, step) result(most)
      class(run_state_type), intent(in) :: self
      type(step_type), intent(in) :: step

      most = max(step%cycles - self%current%number/step%turns() - 1, 1)
   end function most_worn_at_once

   !> Friction work of the cycle that ends here per unit of surface, force/length, shape (nodes).
   function cycle_work(self) result(work)
      class(run_state_type), intent(in) :: self
      real(wp), allocatable :: work(:)
      type(contact_state_type) :: start

      start = self%padded(self%marks(mark_cycle_start))
      work = self%contact%state%friction_work - start%friction_work
   end function cycle_work

   !> Whether the normal force is given.
   pure logical function is_pressed(self)
      class(run_state_type), intent(in) :: self

      is_pressed = self%load(motion_approach)%control == control_force
   end function is_pressed

   !> Whether a planned block of wear is to be worn off.
   pure logical function block_is_due(self)
      class(run_state_type), intent(in) :: self

      block_is_due = .false.
      if (allocated(self%wear_trial)) block_is_due = self%wear_trial%settles .or. .not. self%wear_trial%is_worn
   end function block_is_due

   !> Whether a shorter block may do without an error in the wear or the cycle after it.
   pure logical function block_failed(self, error)
      class(run_state_type), intent(in) :: self
      type(error_type), intent(in) :: error

      block_failed = .false.
      if (allocated(self%wear_trial)) block_failed = self%wear_trial%is_worn .and. self%wear_trial%block%cycles > 1 .and. &
                                                     self%contact%model%scene%wear%block == 0 .and. error%status /= MFV_INTERRUPTED
   end function block_failed

   !> Go back to the start of the present block, and plan one whose cycles are the part `factor` of it.
   subroutine shorten_block(self, factor)
      class(run_state_type), intent(inout) :: self
      real(wp), intent(in) :: factor
      type(wear_trial_type), allocatable :: trial
      type(solver_work_type) :: work

      call move_alloc(self%wear_trial, trial)
      work = self%contact%system%solver_work_type
      call self%restore(trial%start)
      self%contact%system%solver_work_type = work
      self%cycles(self%cycle_count)%block = 1
      trial%cycles = max(int(factor*trial%block%cycles), 1)
      trial%is_worn = .false.
      trial%settles = .false.
      if (allocated(trial%settling)) deallocate (trial%settling)
      call move_alloc(trial, self%wear_trial)
   end subroutine shorten_block

   !> Note the start of the present block in `wear_trial`, for shorter ones and for a restart.
   subroutine note_block(self)
      class(run_state_type), intent(inout) :: self

      if (self%keep_restart) call self%note_restart()
      call self%save_to(self%wear_trial%start)
      self%wear_trial%is_worn = .true.
   end subroutine note_block

   !> Wear the surfaces by the planned block of cycles that the present one begins, under constant loads, and by the correction of
   !> the block before. Skip the cycles that are not computed; they dissipate what wears the surfaces.
   subroutine apply_block(self, step, before, segments, observer, error)
      class(run_state_type), intent(inout) :: self
      type(step_type), intent(in) :: step
      integer, intent(in) :: before, segments
      class(observer_type), intent(inout), optional :: observer
      type(error_type), allocatable, intent(out) :: error
      real(wp), allocatable :: depth(:), skipped(:)
      integer :: turns

      turns = step%turns()
      associate (trial => self%wear_trial, contact => self%contact)
         if (trial%settles) then
            trial%settles = .false.
            call wear_by(self, widened(trial%settling, contact%model%nodes()), step, before, segments, observer, error)
            return
         end if
         do
            call find_wear_block(contact, cycle_work(self), trial%cycles, most_worn_at_once(self, step), is_pressed(self), &
                                 trial%block, trial%correction)
            if (.not. contact%lengthens_for(trial%block%depth > 0.0_wp)) exit
            trial%correction = widened(trial%correction, contact%model%nodes())
         end do
         call note_block(self)
         depth = max(trial%block%depth + trial%correction, -contact%state%worn)
         call wear_by(self, depth, step, before, segments, observer, error)
         if (allocated(error)) return
         ! The mesh may have grown meanwhile.
         skipped = widened(depth - trial%block%first, contact%model%nodes())
         depth = widened(trial%block%depth, contact%model%nodes())
         call contact%state%skip(contact%model%width, work_of_wear(contact%model, skipped))
         associate (cycles => trial%block%cycles)
            if (cycles == 1 .and. trial%block%change > contact%model%scene%wear%tolerance) &
               contact%state%coarsely_worn = contact%state%coarsely_worn + contact%model%force(depth)
            self%cycles_done = self%cycles_done + cycles - 1
            self%current%number = self%current%number + turns*(cycles - 1)
            self%cycles(self%cycle_count)%block = cycles
         end associate
      end associate
      if (self%current%cycle%number == 1 .or. self%current%number == step%segments() .or. &
          self%contact%model%scene%wear%block == 1) deallocate (self%wear_trial)
   end subroutine apply_block

   !> Wear the surfaces by `depth`, length, shape (nodes), under the present loads.
   subroutine wear_by(self, depth, step, before, segments, observer, error)
      class(run_state_type), intent(inout) :: self
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

end module mfv_wear_cycles
