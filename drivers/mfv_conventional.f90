!> mfv_conventional CASE.nml: solve one case with the conventional algorithm (dissertation section 2.2), whatever algorithm it
!> names, to compare with mfv_run.
program run_conventional
   use mfv_command_line, only: get_argument, refuse, refuse_option
   use mfv_conventional_help, only: help, usage
   use mfv_output, only: begin_program
   use mfv_run_case, only: run_case
   use mfv_scene, only: algorithm_conventional
   implicit none
   save  ! the standard says so of a program; gfortran's -frecursive loses what they hold, which the leak sanitizer tells

   character(:), allocatable :: argument
   logical :: resume

   call begin_program('mfv_conventional', usage, help)
   call get_argument(1, argument)
   resume = argument == '--resume'
   if (index(argument, '-') == 1 .and. .not. resume) call refuse_option('mfv_conventional', usage, help, argument)
   if (command_argument_count() /= merge(2, 1, resume)) call refuse('mfv_conventional', usage, 'one case file is wanted')
   if (resume) call get_argument(2, argument)
   if (index(argument, '-') == 1) call refuse_option('mfv_conventional', usage, help, argument)
   call run_case(argument, resume, .false., .false., algorithm_conventional, '_conventional')

end program run_conventional
