!> mfv_conventional CASE.nml: solve one case with the conventional algorithm (dissertation section 2.2), whatever its &solver says,
!> to compare with mfv_run.
program run_conventional
   use mfv_command_line, only: get_argument, refuse, refuse_option
   use mfv_conventional_help, only: help, usage
   use mfv_output, only: begin_program
   use mfv_run_case, only: run_case
   use mfv_scene, only: algorithm_conventional
   use mfv_strings, only: shortened
   implicit none
   save  ! implied by the standard; without it gfortran's -frecursive leaks the variables of a program

   character(:), allocatable :: argument, path
   logical :: resume
   integer :: i

   call begin_program('mfv_conventional', usage, help)
   resume = .false.
   do i = 1, command_argument_count()
      call get_argument(i, argument)
      if (argument == '--resume') then
         resume = .true.
      else if (index(argument, '-') == 1) then
         call refuse_option('mfv_conventional', usage, help, argument)
      else if (allocated(path)) then
         call refuse('mfv_conventional', usage, "too many arguments: '"//shortened(argument)//"'")
      else
         path = argument
      end if
   end do
   if (.not. allocated(path)) call refuse('mfv_conventional', usage, 'a case file is missing')
   call run_case(path, resume, .false., .false., algorithm=algorithm_conventional, suffix='_conventional')

end program run_conventional
