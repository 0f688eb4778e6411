!> mfv_run CASE.nml: solve one case and write its result.
program mfv_run
   use mfv_advise_case, only: advise_case
   use mfv_case, only: case_type
   use mfv_case_keys, only: case_catalogue
   use mfv_case_reader, only: read_case_file
   use mfv_error, only: error_type
   use mfv_help, only: print_lines, refuse, refuse_option
   use mfv_keys, only: list_keys_as_markdown
   use mfv_output, only: begin_program, print_line, print_text
   use mfv_run_case, only: run_case
   use mfv_strings, only: shortened
   use mfv_summary, only: summarize_check
   use mfv_terminal
   use mfv_version, only: library_version
   implicit none
   save  ! the standard says so of a program; gfortran's -frecursive loses what they hold, which the leak sanitizer tells

   !> How it is used, and what --help adds: one line an element. The manual page is made from both (docs/man).
   character(*), parameter :: usage(*) = [character(len=100) :: &
      'usage: mfv_run [--estimate] [--sensitivity] [--resume] CASE.nml', &
      '       mfv_run --advise error=1e-2 [of=stick_ratio,dissipation] CASE.nml', &
      '       mfv_run --check CASE.nml', &
      '       mfv_run --keys | --version | --help' &
      ]
   character(*), parameter :: help(*) = [character(len=100) :: &
      '', &
      'Solve one case of two-dimensional frictional contact of elastic bodies: lead the loads through', &
      'the steps of the case from event to event (a node touches, parts, slips or sticks), write the', &
      'result file, print a summary.', &
      '', &
      'A case is a text of namelist groups. This is a whole one, a rigid cylinder on an elastic plane:', &
      '', &
      "  &body shape='half_plane', shear_modulus=1.0, poisson_ratio=0.3 /   ! first body: below", &
      "  &body shape='disk', radius=0.25, rigid=.true. /                    ! second body: above", &
      '  &step normal_force=1.0e-3 /                                        ! press', &
      '', &
      'With a coefficient of friction and one step more it is sheared as well:', &
      '', &
      "  &friction law='coulomb', mu=0.7 /", &
      '  &step     tangential_force=2.8e-4 /', &
      '', &
      'Any consistent units will do; forces are per unit thickness. What is not said has a default: the', &
      'mesh, for one, is chosen from an estimate of the contact.', &
      '', &
      'Options:', &
      '  --estimate   solve the case on coarser meshes too, and put error bars on half-width, stick ratio,', &
      '               peak tractions and dissipation; takes about twice the time', &
      '  --sensitivity  solve the case once more with all coefficients of friction times 1 + 1e-12,', &
      '               and print by how much tractions, dissipation and stick ratio change: static and', &
      '               kinetic friction can be chaotic', &
      '  --resume     go on from the checkpoint that an interrupted or killed run of the case has left,', &
      '               with the same digits as if it had not stopped; where there is none, from its', &
      '               beginning', &
      '  --advise     print the number of nodes, and the linear solver, that an error takes, from coarse', &
      '               meshes; the case itself is not solved. error=E: the wanted error, relative, such as', &
      '               1e-2. of=LIST: quantities that it is for, separated by commas: pressure, shear,', &
      '               half_width, stick_ratio, dissipation; all by default', &
      '  --check      read and validate the case only; nothing is solved or written', &
      '  --keys       print every group and key of a case, as tables in Markdown', &
      '  --version    print the version', &
      '  -h, --help   print this text', &
      '', &
      'Files:', &
      '  The result goes into the file that &output names, else into the working directory, under the name', &
      '  of the case with .h5 for its extension. It is HDF5: tractions, displacements, slip and status of', &
      '  every node, the history of the loads, the certificate. It is written under another name and', &
      '  renamed when it is whole; a run that fails leaves an older result as it was.', &
      '  A checkpoint is beside it, with .checkpoint in place of .h5: written every 10 minutes (the', &
      '  checkpoint_minutes of &output), and when the run is interrupted; removed when it is complete.', &
      '', &
      'Output:', &
      '  The summary goes to standard output; messages go to standard error, and so does progress, on a', &
      '  terminal only. Ctrl-C or SIGTERM ends the run at its next event, with the result up to there and', &
      '  a checkpoint.', &
      '', &
      'Exit codes:', &
      '  0     complete: every step was reached', &
      '  2     the input cannot be used; the message names file, line, group, key and value', &
      '  3     the computation ended early, with the result up to there: gross sliding, no admissible', &
      '        continuation, separated, inadmissible step, mesh exceeded; of the conventional algorithm', &
      '        also cycling, inadmissible', &
      '  4     a file could not be read or written', &
      '  130   interrupted, with a checkpoint (--resume goes on) and, where no whole result is, the result', &
      '        up to there', &
      '', &
      'Examples:', &
      '  mfv_run --check case.nml                      # is it valid, and what will be solved?', &
      '  mfv_run case.nml                              # solve it, write case.h5', &
      '  python -m mfv plot case.h5 -o case.png        # draw it', &
      '  mfv_stress case.h5                            # stresses inside the lower body, into case.h5', &
      '  mfv_run --estimate case.nml                   # with error bars', &
      '  mfv_run --sensitivity case.nml                # does round-off decide the result?', &
      '  mfv_run --advise error=1e-2 of=shear case.nml # how fine a mesh?', &
      '', &
      'See also:', &
      '  mfv_case(5) has every key of a case, as mfv_run --keys. docs/guide.md goes from a question to a', &
      '  picture; examples/*.nml are cases to begin with. mfv_stress(1), mfv_conventional(1).' &
      ]
   character(:), allocatable :: option, text

   call begin_program()
   call get_argument(1, option)
   select case (option)
   case ('--help', '-h')
      call print_lines([usage, help])
   case ('--version')
      call print_line('mfv_run '//library_version)
   case ('--keys')
      call list_keys_as_markdown(case_catalogue(), text)
      call print_text(text)
   case ('--advise')
      call advise_case(usage)
   case ('--check')
      call check_case()
   case default
      call solve_case()
   end select

contains

   !> Solve the case that is the last argument, after options in any order.
   subroutine solve_case()
      character(:), allocatable :: path, argument
      logical :: estimate, sensitivity, resume
      integer :: i

      estimate = .false.
      sensitivity = .false.
      resume = .false.
      do i = 1, command_argument_count() - 1
         call get_argument(i, argument)
         select case (argument)
         case ('--estimate')
            estimate = .true.
         case ('--sensitivity')
            sensitivity = .true.
         case ('--resume')
            resume = .true.
         case default
            if (index(argument, '-') == 1) call refuse_option('mfv_run', usage, help, argument)
            call expect_arguments(i)
         end select
      end do
      call get_case(max(command_argument_count(), 1), path)
      call run_case(path, estimate=estimate, sensitivity=sensitivity, resume=resume)
   end subroutine solve_case

   !> Argument `number`, which must be the case and the last one.
   subroutine get_case(number, path)
      integer, intent(in) :: number
      character(:), allocatable, intent(out) :: path

      call expect_arguments(number)
      call get_argument(number, path)
      if (any(path == [character(13) :: '--estimate', '--sensitivity', '--resume'])) &
         call refuse('mfv_run', usage, 'a case file is missing')
      if (index(path, '-') == 1) call refuse_option('mfv_run', usage, help, path)
   end subroutine get_case

   !> Refuse any other number of arguments.
   subroutine expect_arguments(number)
      integer, intent(in) :: number
      character(:), allocatable :: surplus

      if (command_argument_count() < number) call refuse('mfv_run', usage, 'a case file is missing')
      if (command_argument_count() <= number) return
      call get_argument(number + 1, surplus)
      call refuse('mfv_run', usage, "too many arguments: '"//shortened(surplus)//"'")
   end subroutine expect_arguments

   subroutine check_case()
      character(:), allocatable :: path
      type(case_type) :: case
      type(error_type), allocatable :: error

      call get_case(2, path)

      call read_case_file(path, case, error)
      if (allocated(error)) call fail(error)
      call summarize_check(case, text)
      call print_text(text)
   end subroutine check_case

end program mfv_run
