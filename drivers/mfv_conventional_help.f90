!> Usage and help of mfv_conventional.
module mfv_conventional_help
   implicit none
   private
   public :: usage, help

   !> Printed by --help: the usage, then the help, one line per element. The manual page is made from both (docs/man).
   character(*), parameter :: usage(*) = [character(len=100) :: &
      'usage: mfv_conventional [--resume] CASE.nml', &
      '       mfv_conventional --version | --help' &
      ]
   character(*), parameter :: help(*) = [character(len=100) :: &
      '', &
      'Solve one case with the conventional algorithm, whatever its &solver says, to compare with', &
      "mfv_run. The case is as for mfv_run; '_conventional' is added to the name of its result file.", &
      '', &
      'The load grows by load_step of &solver, a fraction of each load segment; at every load the', &
      'statuses of nodes are corrected one at a time, at most iterations times. Only the ends of load', &
      'steps are admissible, and even there the result depends on the load step. mfv_run does the same', &
      "with algorithm='conventional' in &solver. Options may follow the case.", &
      '', &
      'Options:', &
      '  --resume     continue an interrupted or killed run, as mfv_run', &
      '  --version    print the version', &
      '  -h, --help   print this text', &
      '', &
      'Exit codes:', &
      '  0     complete: the states at the ends of load steps are admissible', &
      '  2     the input cannot be used; the message names file, line, group, key and value', &
      '  3     the computation ended early; the result up to that load is written: as mfv_run, and', &
      '        cycling (the corrections repeat) or inadmissible (they do not end, or the system is', &
      '        singular)', &
      '  4     a file could not be read or written', &
      '  130   interrupted; the result up to that load is written, and --resume continues', &
      '', &
      'Examples:', &
      '  mfv_run case.nml                        # writes case.h5', &
      '  mfv_conventional case.nml               # writes case_conventional.h5', &
      '  mfv plot case_conventional.h5           # draws it', &
      '', &
      'See also:', &
      '  docs/guide.md, section Comparing with the conventional algorithm. mfv_run(1), mfv_case(5).' &
      ]

end module mfv_conventional_help
