!> What mfv_stress says about itself.
module mfv_stress_help
   implicit none
   private
   public :: usage, help

   !> How it is used, and what --help adds: one line per element. The manual page is made from both (docs/man).
   character(*), parameter :: usage(*) = [character(len=100) :: &
      'usage: mfv_stress RESULT.h5 [--body lower|upper] [--step N] [--width W] [--depth D] [--points NX NY]', &
      '       mfv_stress RESULT.h5 --at POINTS.txt [--body lower|upper] [--step N]', &
      '       mfv_stress --version | --help' &
      ]
   character(*), parameter :: help(*) = [character(len=100) :: &
      '', &
      'Compute the stresses inside a body from the surface tractions of a result, by closed forms for', &
      'half-planes, disks and holes, and put them into the result file, under /stress/last/lower and so', &
      'on, with the largest von Mises stress, the largest tension along the surface and their places.', &
      '', &
      'A result is what mfv_run has written:', &
      '', &
      '  mfv_run examples/disk_on_plane.nml', &
      '  mfv_stress disk_on_plane.h5', &
      '  python -m mfv plot disk_on_plane.h5 --stress von_mises', &
      '', &
      'Options:', &
      '  --body lower|upper   which body; lower by default', &
      '  --step N             in the state kept in /steps/000N; by default the last one', &
      '  --width W            on a grid that goes W contact half-widths to either side of the contact; 2', &
      '                       by default', &
      '  --depth D            and D contact half-widths deep, along the surface; 2 by default', &
      '  --points NX NY       of NX by NY points; 161 81 by default', &
      '  --at POINTS.txt      at the points of a text file instead, x and y a line, y up from the contact;', &
      '                       the stresses there are printed too', &
      '  --version            print the version', &
      '  -h, --help           print this text', &
      '', &
      'Quantities:', &
      '  sigma_xx, sigma_yy, sigma_xy               Cartesian components, positive in tension', &
      '  sigma_zz                                   across the plane', &
      '  principal_1, principal_2                   principal stresses in the plane', &
      '  principal_angle                            direction of principal_1 from the x axis, radians', &
      '  von_mises, tresca                          equivalent stresses; sigma_zz counts in both', &
      '  sigma_rr, sigma_thetatheta, sigma_rtheta   polar components, of disks and holes', &
      '', &
      'Exit codes:', &
      '  0     done', &
      '  2     the arguments or the result cannot be used: a rigid body, a state that is not there', &
      '  4     the file could not be written; it then stays as it was', &
      '', &
      'Examples:', &
      '  mfv_stress two_cylinders.h5 --body upper --step 1', &
      '  mfv_stress two_cylinders.h5 --width 3 --depth 1 --points 301 101', &
      '  mfv_stress two_cylinders.h5 --at points.txt', &
      '', &
      'See also:', &
      '  docs/guide.md, section Stresses inside; docs/theory.md for how they are computed. mfv_run(1).' &
      ]

end module mfv_stress_help
