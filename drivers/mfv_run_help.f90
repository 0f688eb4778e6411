!> Usage and help of mfv_run.
module mfv_run_help
   implicit none
   private
   public :: usage, help

   !> Printed by --help: the usage, then the help, one line per element. The manual page is made from both (docs/man).
   character(*), parameter :: usage(*) = [character(len=100) :: &
      'usage: mfv_run [--accuracy E] [--estimate] [--sensitivity] [--resume] CASE.nml', &
      '       mfv_run --advise error=1e-2 [of=stick_ratio,dissipation] CASE.nml', &
      '       mfv_run --check CASE.nml', &
      '       mfv_run --keys | --version | --help' &
      ]
   character(*), parameter :: help(*) = [character(len=100) :: &
      '', &
      'Solve one case of two-dimensional frictional contact of elastic bodies: apply the loads of the', &
      'steps of the case from event to event (a node touches, separates, slips or sticks), write the', &
      'result file and print a summary.', &
      '', &
      'A case is a text file of namelist groups. A complete one, a rigid cylinder on an elastic plane:', &
      '', &
      "  &body shape='half_plane', shear_modulus=1.0, poisson_ratio=0.3 /   ! first body: below", &
      "  &body shape='disk', radius=0.25, rigid=.true. /                    ! second body: above", &
      '  &step normal_force=1.0e-3 /                                        ! press', &
      '', &
      'Add a coefficient of friction and one more step to shear it as well:', &
      '', &
      "  &friction law='coulomb', mu=0.7 /", &
      '  &step     tangential_force=2.8e-4 /', &
      '', &
      'Use any consistent units; forces are per unit thickness. All other keys have defaults: the mesh,', &
      'for example, is chosen from an estimate of the contact. Options may follow the case.', &
      '', &
      'Options:', &
      '  --accuracy   allowed error of the tractions and of the dissipation, such as 1e-3, in place of', &
      '               accuracy in &solver: large increments where they cost less than events, and the', &
      '               number of nodes where the case leaves the mesh to the program', &
      '  --estimate   also solve the case on coarser meshes, for error bars of half-width, stick ratio,', &
      '               peak tractions, dissipation, largest tension and loops; takes about twice the time', &
      '  --sensitivity  solve the case once more with all coefficients of friction times 1 + 1e-12,', &
      '               and print by how much tractions, dissipation and stick ratio change: static and', &
      '               kinetic friction can be chaotic', &
      '  --resume     continue an interrupted or killed run of the case from the last load segment that', &
      '               it finished; start from step 1 if there is no such run', &
      '  --advise     print the number of nodes and the linear solver needed for an error, estimated on', &
      '               coarse meshes; the case itself is not solved. error=E: the relative error wanted,', &
      '               such as 1e-2. of=LIST: its quantities, separated by commas: pressure, shear,', &
      '               half_width, stick_ratio, dissipation; all by default', &
      '  --check      read and validate the case only; nothing is solved or written', &
      '  --keys       print every group and key of a case, as tables in Markdown', &
      '  --version    print the version', &
      '  -h, --help   print this text', &
      '', &
      'Files:', &
      '  The result is written to the file named in &output; by default to the working directory, under', &
      '  the name of the case with the extension .h5. It is an HDF5 file with tractions, displacements,', &
      '  slip and status of every node, the load history and the certificate. It is written under a', &
      '  temporary name and renamed when complete; a run that fails does not change an older result.', &
      '  The result of an unfinished run is written when it is interrupted, and at most every 10 minutes', &
      '  (checkpoint_minutes in &output). It does not overwrite the result of a finished run: it is', &
      '  then written next to it, with .partial in its name.', &
      '', &
      'Output:', &
      '  The summary is printed to standard output, messages to standard error; so is progress, if that', &
      '  is a terminal: how much of the load history is done, and the time left if the rest goes on as', &
      '  the last half did. Ctrl-C or SIGTERM ends the run at its next event; the result is written.', &
      '', &
      'Exit codes:', &
      '  0     complete: every step was reached', &
      '  2     the input cannot be used; the message names file, line, group, key and value', &
      '  3     the computation ended early; the result up to that load is written: gross sliding, no', &
      '        admissible continuation, separated, inadmissible step, mesh exceeded, not converged;', &
      '        with the conventional algorithm also cycling, inadmissible', &
      '  4     a file could not be read or written', &
      '  130   interrupted; the result up to that load is written, and --resume continues', &
      '', &
      'Examples:', &
      '  mfv_run --check case.nml                      # is it valid, and what will be solved?', &
      '  mfv_run case.nml                              # solve it, write case.h5', &
      '  mfv plot case.h5                              # draw it', &
      '  mfv_stress case.h5                            # stresses inside the lower body, into case.h5', &
      '  mfv_run --estimate case.nml                   # with error bars', &
      '  mfv_run --sensitivity case.nml                # does the result depend on round-off?', &
      '  mfv_run --advise error=1e-2 of=shear case.nml # how fine a mesh?', &
      '', &
      'See also:', &
      '  mfv_case(5) and mfv_run --keys: all keys of a case. docs/guide.md: tasks with pictures.', &
      '  examples/*.nml: cases to start from. mfv_stress(1), mfv_conventional(1).' &
      ]

end module mfv_run_help
