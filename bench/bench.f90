!> Measurements for bench/measure.py.
!>
!>     bench run REPEATS CASE.nml ...        solve cases in turn, a line of JSON each (bench_runs)
!>     bench tractions REPEATS CASE.nml ...  the same, and write the tractions beside the cases
!>     bench circle                          kernels of disk and hole (bench_circle)
program bench
   use, intrinsic :: iso_fortran_env, only: error_unit
   use bench_circle, only: measure_circle_kernels
   use bench_runs, only: run_cases
   implicit none
   integer, parameter :: longest = 1024
   character(len=longest) :: command, argument
   character(len=longest), allocatable :: paths(:)
   integer :: i, repeats, status

   call get_command_argument(1, command)
   select case (command)
   case ('circle')
      call measure_circle_kernels()
   case ('run', 'tractions')
      call get_command_argument(2, argument)
      read (argument, *, iostat=status) repeats
      if (status /= 0 .or. command_argument_count() < 3) call refuse()
      allocate (paths(command_argument_count() - 2))
      do i = 1, size(paths)
         call get_command_argument(i + 2, paths(i))
      end do
      call run_cases(paths, repeats, command == 'tractions')
   case default
      call refuse()
   end select

contains

   subroutine refuse()
      write (error_unit, '(a)') 'usage: bench run|tractions REPEATS CASE.nml ... | bench circle'
      error stop 2, quiet = .true.
   end subroutine refuse

end program bench
