!> Usage and help of mfv_stress.
module mfv_stress_help
   implicit none
   private
   public :: usage, help

   !> Printed by --help: the usage, then the help, one line per element. The manual page is made from both (docs/man).
   character(*), parameter :: usage(*) = [character(len=100) :: &
      'usage: mfv_stress RESULT.h5 [--body lower|upper] [--step N] [--width W] [--depth D] [--points NX NY]', &
      '       mfv_stress RESULT.h5 --at POINTS.txt [--body lower|upper] [--step N]', &
      '       mfv_stress --version | --help' &
      ]
   character(*), parameter :: help(*) = [character(len=100) :: &
      '', &
      'Compute the stresses inside a body from the surface tractions of a result, by closed forms for', &
      'half-planes, disks and holes, and add them to the result file, under /stress/last/lower and so', &
      'on, with the positions of the largest von Mises stress and the largest tension along the surface.', &
      '', &
      'A result is a file written by mfv_run:', &
      '', &
      '  mfv_run examples/disk_on_plane.nml', &
      '  mfv_stress disk_on_plane.h5', &
      '  mfv plot disk_on_plane.h5 --stress von_mises', &
      '', &
      'Options:', &
      '  --body lower|upper   the body; lower by default', &
      '  --step N             the state saved in /steps/000N; the last one by default', &
      '  --width W            half-width of the grid, in contact half-widths; 2 by default', &
      '  --depth D            depth of the grid below the surface, in contact half-widths; 2 by default', &
      '  --points NX NY       number of points of the grid; 161 81 by default', &
      '  --at POINTS.txt      points of a text file instead of a grid, x and y on each line, y upwards from', &
      '                       the contact; their stresses are also printed', &
      '  --version            print the version', &
      '  -h, --help           print this text', &
      '', &
      'Quantities:', &
      '  sigma_xx, sigma_yy, sigma_xy               Cartesian components, positive in tension', &
      '  sigma_zz                                   out-of-plane stress', &
      '  principal_1, principal_2                   principal stresses in the plane', &
      '  principal_angle                            direction of principal_1 from the x axis, radians', &
      '  von_mises, tresca                          equivalent stresses, with sigma_zz', &
      '  sigma_rr, sigma_thetatheta, sigma_rtheta   polar components, of disks and holes', &
      '', &
      'Exit codes:', &
      '  0     done', &
      '  2     the arguments or the result cannot be used: a rigid body, a missing state', &
      '  4     the file could not be written; it is unchanged', &
      '', &
      'Examples:', &
      '  mfv_stress two_cylinders.h5 --body upper --step 1', &
      '  mfv_stress two_cylinders.h5 --width 3 --depth 1 --points 301 101', &
      '  mfv_stress two_cylinders.h5 --at points.txt', &
      '', &
      'See also:', &
      '  docs/guide.md, section Stresses inside; docs/theory.md: how they are computed. mfv_run(1).' &
      ]

end module mfv_stress_help
