!> mfv_run CASE.nml: solve one case and write its result.
program mfv_run
   use, intrinsic :: iso_fortran_env, only: output_unit
   use mfv_advise_case, only: advise_case
   use mfv_case, only: case_type
   use mfv_case_keys, only: case_catalogue
   use mfv_case_reader, only: read_case_file
   use mfv_error, only: error_type
   use mfv_keys, only: list_keys_as_markdown
   use mfv_run_case, only: run_case
   use mfv_summary, only: summarize_check
   use mfv_terminal
   use mfv_version, only: library_version
   implicit none

   character(len=1), parameter :: line_feed = achar(10)
   character(*), parameter :: usage = &
      'usage: mfv_run CASE.nml          solve the case, write its result file, print a summary'//line_feed// &
      '       mfv_run --estimate CASE.nml   the same, with error bars: the case is solved on coarser meshes too'//line_feed// &
      '       mfv_run --advise error=1e-2 [of=pressure,stick_ratio,...] CASE.nml'//line_feed// &
      '                                 how many nodes, and which solver, this error takes; of: pressure, shear,'// &
      line_feed// &
      '                                 half_width, stick_ratio, dissipation; all unless told'//line_feed// &
      '       mfv_run --check CASE.nml  read and validate the case only'//line_feed// &
      '       mfv_run --keys            print every group and key of a case (Markdown)'//line_feed// &
      '       mfv_run --version'//line_feed// &
      '       mfv_run --help'//line_feed
   character(*), parameter :: teaching = line_feed// &
      'A case is a text of namelist groups:'//line_feed//line_feed// &
      "  &scene    title='Mindlin', coupling='goodman' /                        ! full | goodman | none"//line_feed// &
      "  &body     shape='half_plane', shear_modulus=1.0, poisson_ratio=0.3 /   ! first body: below"//line_feed// &
      "  &body     shape='disk', radius=0.25, rigid=.true. /                    ! second body: above"//line_feed// &
      "  &friction law='coulomb', mu=0.7 /"//line_feed// &
      "  &step     normal_force=1.0e-3, friction=.false. /                      ! press"//line_feed// &
      "  &step     tangential_force=2.8e-4 /                                    ! shear"//line_feed// &
      "  &output   file='mindlin.h5' /"//line_feed//line_feed// &
      'Exit codes: 0 complete; 2 the input cannot be used; 3 the computation ended early (gross sliding, no'//line_feed// &
      'admissible continuation, separated, inadmissible step, mesh exceeded; conventional: cycling, inadmissible),'//line_feed// &
      'with the result up to there; 4 the result could not be written; 130 interrupted, with the result up to'//line_feed// &
      'there.'//line_feed//line_feed// &
      'Draw a result with: python -m mfv plot RESULT.h5 -o PICTURE.png'
   character(:), allocatable :: argument, option, text

   call get_argument(1, option)
   select case (option)
   case ('--help', '-h')
      write (output_unit, '(a)') usage//teaching
   case ('--version')
      write (output_unit, '(a)') 'mfv_run '//library_version
   case ('--keys')
      call list_keys_as_markdown(case_catalogue(), text)
      write (output_unit, '(a)', advance='no') text
   case ('--estimate')
      call get_argument(2, argument)
      call expect_arguments(2)
      call run_case(argument, estimate=.true.)
   case ('--advise')
      call advise_case(usage)
   case ('--check')
      call get_argument(2, argument)
      call expect_arguments(2)
      call check_case(argument)
   case default
      call expect_arguments(1)
      if (index(option, '-') == 1) call refuse('mfv_run', usage, "unknown option '"//option//"'")
      call run_case(option)
   end select

contains

   !> Refuse any other number of arguments.
   subroutine expect_arguments(number)
      integer, intent(in) :: number
      character(:), allocatable :: surplus

      if (command_argument_count() < number) call refuse('mfv_run', usage, 'a case file is missing')
      if (command_argument_count() <= number) return
      call get_argument(number + 1, surplus)
      call refuse('mfv_run', usage, "too many arguments: '"//surplus//"'")
   end subroutine expect_arguments

   subroutine check_case(path)
      character(*), intent(in) :: path
      type(case_type) :: case
      type(error_type), allocatable :: error

      call read_case_file(path, case, error)
      if (allocated(error)) call fail(error)
      call summarize_check(case, text)
      write (output_unit, '(a)', advance='no') text
   end subroutine check_case

end program mfv_run
