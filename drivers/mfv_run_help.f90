!> What mfv_run says about itself.
module mfv_run_help
   implicit none
   private
   public :: usage, help

   !> How it is used, and what --help adds: one line per element. The manual page is made from both (docs/man).
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
      '  --resume     continue an interrupted or killed run of the case from the last load segment that', &
      '               it finished; without one, start from step 1', &
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
      '  The result of an unfinished run is written when it is interrupted, and at most every 10 minutes', &
      '  (checkpoint_minutes in &output). If the result of a finished run is in its place, that stays,', &
      '  and the unfinished one is beside it, with .partial in its name.', &
      '', &
      'Output:', &
      '  The summary goes to standard output; messages go to standard error, and so does progress, on a', &
      '  terminal only. Ctrl-C or SIGTERM ends the run at its next event, with the result up to there.', &
      '', &
      'Exit codes:', &
      '  0     complete: every step was reached', &
      '  2     the input cannot be used; the message names file, line, group, key and value', &
      '  3     the computation ended early, with the result up to there: gross sliding, no admissible', &
      '        continuation, separated, inadmissible step, mesh exceeded; of the conventional algorithm', &
      '        also cycling, inadmissible', &
      '  4     a file could not be read or written', &
      '  130   interrupted, with the result up to there; --resume continues', &
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

end module mfv_run_help
