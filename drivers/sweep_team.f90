!> The threads of one process that solve the cases of a sweep, and what passes between them and the thread that manages them:
!> numbers of cases one way, records the other.
module mfv_sweep_team
   use, intrinsic :: iso_fortran_env, only: int8
   use mfv_error, only: error_type
   use mfv_pause, only: pause_briefly
   use mfv_solve_sweep_case, only: solve_sweep_case
   use mfv_sweep_plan, only: sweep_type
   use mfv_terminal, only: is_interrupted, request_interrupt
   implicit none
   private
   public :: team_type, new_team, give_case, take_record, work, work_once, dismiss, is_idle

   !> A record of mfv_sweep_record as bytes.
   type :: bytes_type
      integer(int8), allocatable :: bytes(:)
   end type bytes_type

   !> All of it is touched by one thread at a time, in the critical section mfv_team. Dummy arguments of this type are targets:
   !> the compiler must not take it for granted that nobody else changes them.
   type :: team_type
      private
      !> Cases that wait, the first `waiting` in use; and how many are being solved.
      integer, allocatable :: cases(:)
      integer :: waiting = 0, running = 0
      !> Records that nobody has fetched yet, the first `done` in use.
      type(bytes_type), allocatable :: records(:)
      integer :: done = 0
      logical :: dismissed = .false.
      !> Why a result could not be kept.
      type(error_type), allocatable :: error
   end type team_type

contains

   !> A team without work. `capacity`: cases that may be with it at a time.
   subroutine new_team(capacity, team)
      integer, intent(in) :: capacity
      type(team_type), intent(out), target :: team

      allocate (team%cases(capacity))
      allocate (team%records(capacity))
   end subroutine new_team

   !> Give a case to the team.
   subroutine give_case(team, number)
      type(team_type), intent(inout), target :: team
      integer, intent(in) :: number

      !$omp critical (mfv_team)
      team%waiting = team%waiting + 1
      team%cases(team%waiting) = number
      !$omp end critical (mfv_team)
   end subroutine give_case

   !> Fetch a record from the team; not allocated where there is none. Error where a result could not be kept.
   subroutine take_record(team, bytes, error)
      type(team_type), intent(inout), target :: team
      integer(int8), allocatable, intent(out) :: bytes(:)
      type(error_type), allocatable, intent(inout) :: error

      !$omp critical (mfv_team)
      if (team%done > 0) then
         call move_alloc(team%records(team%done)%bytes, bytes)
         team%done = team%done - 1
      end if
      if (allocated(team%error) .and. .not. allocated(error)) error = team%error
      !$omp end critical (mfv_team)
   end subroutine take_record

   !> Whether the team has nothing to do and nothing to hand in.
   logical function is_idle(team)
      type(team_type), intent(in), target :: team

      !$omp critical (mfv_team)
      is_idle = team%waiting + team%running + team%done == 0
      !$omp end critical (mfv_team)
   end function is_idle

   !> No more cases will come: threads go home, and forget those that wait after an interrupt.
   subroutine dismiss(team)
      type(team_type), intent(inout), target :: team

      !$omp critical (mfv_team)
      team%dismissed = .true.
      if (is_interrupted()) team%waiting = 0
      !$omp end critical (mfv_team)
   end subroutine dismiss

   !> What a thread of the team does, until it is dismissed.
   subroutine work(team, sweep)
      type(team_type), intent(inout), target :: team
      type(sweep_type), intent(in) :: sweep
      logical :: worked, over
      integer :: rests

      rests = 0
      do
         call work_once(team, sweep, worked, over)
         if (over) return
         if (worked) rests = 0
         if (.not. worked) call pause_briefly(rests)
      end do
   end subroutine work

   !> Solve the next case, where there is one. `over`: whether there never will be.
   subroutine work_once(team, sweep, worked, over)
      type(team_type), intent(inout), target :: team
      type(sweep_type), intent(in) :: sweep
      logical, intent(out) :: worked, over
      integer(int8), allocatable :: bytes(:)
      type(error_type), allocatable :: error
      integer :: number
      logical :: is_wrong

      call take_case(team, number, over)
      worked = number > 0
      if (.not. worked) return
      call solve_sweep_case(sweep, number, bytes, error)
      is_wrong = allocated(error)
      ! First the error, then the end: who sees that it is over finds out why.
      call hand_in(team, bytes, error)
      if (is_wrong) call request_interrupt()
   end subroutine work_once

   !> The case that has waited longest, 0 for none.
   subroutine take_case(team, number, over)
      type(team_type), intent(inout), target :: team
      integer, intent(out) :: number
      logical, intent(out) :: over

      !$omp critical (mfv_team)
      number = 0
      if (team%waiting > 0 .and. .not. is_interrupted()) then
         number = team%cases(1)
         team%cases(:team%waiting - 1) = team%cases(2:team%waiting)
         team%waiting = team%waiting - 1
         team%running = team%running + 1
      end if
      over = team%dismissed .and. number == 0
      !$omp end critical (mfv_team)
   end subroutine take_case

   subroutine hand_in(team, bytes, error)
      type(team_type), intent(inout), target :: team
      integer(int8), allocatable, intent(inout) :: bytes(:)
      type(error_type), allocatable, intent(inout) :: error

      !$omp critical (mfv_team)
      team%running = team%running - 1
      if (allocated(bytes)) then
         team%done = team%done + 1
         call move_alloc(bytes, team%records(team%done)%bytes)
      end if
      if (allocated(error) .and. .not. allocated(team%error)) call move_alloc(error, team%error)
      !$omp end critical (mfv_team)
   end subroutine hand_in

end module mfv_sweep_team
