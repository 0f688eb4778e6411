!> mfv_conventional CASE.nml: solve one case with the conventional algorithm (dissertation section 2.2), whatever algorithm it
!> names, to compare with mfv_run.
program mfv_conventional
   use, intrinsic :: iso_fortran_env, only: output_unit
   use mfv_run_case, only: run_case
   use mfv_scene, only: algorithm_conventional
   use mfv_terminal
   use mfv_version, only: library_version
   implicit none

   character(len=1), parameter :: line_feed = achar(10)
   character(*), parameter :: usage = &
      'usage: mfv_conventional CASE.nml  solve the case with the conventional algorithm, for comparison with mfv_run'// &
      line_feed// &
      '       mfv_conventional --version'//line_feed// &
      '       mfv_conventional --help'//line_feed
   character(*), parameter :: teaching = line_feed// &
      'The load goes on by &solver load_step, a part of each straight part of the load history; at every load statuses are'// &
      line_feed//'repaired one at a time, at most &solver iterations times. Outcomes of its own, with exit code 3: cycling (the'// &
      line_feed//'repairs go round in circles) and inadmissible (they do not end, or the system is singular). The case is'// &
      line_feed//"mfv_run's; '_conventional' comes to the name of its result file. algorithm='conventional' in &solver does the"// &
      line_feed//'same in mfv_run.'
   character(:), allocatable :: argument

   if (command_argument_count() /= 1) call refuse('mfv_conventional', usage, 'one case file is wanted')
   call get_argument(1, argument)
   select case (argument)
   case ('--help', '-h')
      write (output_unit, '(a)') usage//teaching
   case ('--version')
      write (output_unit, '(a)') 'mfv_conventional '//library_version
   case default
      if (index(argument, '-') == 1) call refuse('mfv_conventional', usage, "unknown option '"//argument//"'")
      call run_case(argument, algorithm_conventional, '_conventional')
   end select

end program mfv_conventional
