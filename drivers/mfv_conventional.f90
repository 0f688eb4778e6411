!> mfv_conventional CASE.nml: solve one case with the conventional algorithm (dissertation section 2.2), whatever algorithm it
!> names, to compare with mfv_run.
program run_conventional
   use mfv_help, only: print_lines, refuse, refuse_option
   use mfv_output, only: begin_program, print_line
   use mfv_run_case, only: run_case
   use mfv_scene, only: algorithm_conventional
   use mfv_terminal
   use mfv_version, only: library_version
   implicit none
   save  ! the standard says so of a program; gfortran's -frecursive loses what they hold, which the leak sanitizer tells

   !> How it is used, and what --help adds: one line an element. The manual page is made from both (docs/man).
   character(*), parameter :: usage(*) = [character(len=100) :: &
      'usage: mfv_conventional [--resume] CASE.nml', &
      '       mfv_conventional --version | --help' &
      ]
   character(*), parameter :: help(*) = [character(len=100) :: &
      '', &
      'Solve one case with the conventional algorithm, whatever algorithm it names, to compare with', &
      "mfv_run. The case is one for mfv_run; '_conventional' comes to the name of its result file.", &
      '', &
      'The load goes on by the load_step of &solver, a part of each load segment; at', &
      'every load the statuses of nodes are repaired one at a time, at most iterations times. Only the', &
      'ends of load steps are admissible, and even there the result depends on the load step. The same is', &
      "done by mfv_run with algorithm='conventional' in &solver.", &
      '', &
      'Options:', &
      '  --resume     go on from the checkpoint that an interrupted or killed run has left, as mfv_run', &
      '  --version    print the version', &
      '  -h, --help   print this text', &
      '', &
      'Exit codes:', &
      '  0     complete: the states at the ends of load steps break no inequality', &
      '  2     the input cannot be used; the message names file, line, group, key and value', &
      '  3     the computation ended early, with the result up to there: as mfv_run, and cycling (the', &
      '        repairs go round in circles) or inadmissible (they do not end, or the system is singular)', &
      '  4     a file could not be read or written', &
      '  130   interrupted, with the result up to there and a checkpoint; --resume goes on', &
      '', &
      'Examples:', &
      '  mfv_run case.nml                        # writes case.h5', &
      '  mfv_conventional case.nml               # writes case_conventional.h5', &
      '  python -m mfv plot case_conventional.h5 # draws it', &
      '', &
      'See also:', &
      '  docs/guide.md, section Comparing with the conventional algorithm. mfv_run(1), mfv_case(5).' &
      ]
   character(:), allocatable :: argument
   logical :: resume

   call begin_program()
   call get_argument(1, argument)
   resume = argument == '--resume'
   if (index(argument, '-') == 1 .and. all(argument /= ['--resume ', '--help   ', '-h       ', '--version'])) &
      call refuse_option('mfv_conventional', usage, help, argument)
   if (command_argument_count() /= merge(2, 1, resume)) call refuse('mfv_conventional', usage, 'one case file is wanted')
   if (resume) call get_argument(2, argument)
   select case (argument)
   case ('--help', '-h')
      call print_lines([usage, help])
   case ('--version')
      call print_line('mfv_conventional '//library_version)
   case default
      if (index(argument, '-') == 1) call refuse_option('mfv_conventional', usage, help, argument)
      call run_case(argument, algorithm_conventional, '_conventional', resume=resume)
   end select

end program run_conventional
