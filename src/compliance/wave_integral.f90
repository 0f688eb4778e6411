!> Integrals over waves exp(i k x), k > 0, of functions that are analytic in k, smooth over a length `scale` in x, for all 0 <= x <=
!> `reach` by one sum: along a ray into the complex plane, where exp(i k x) decays, by Gauss quadrature in intervals in proportion
!> to k. Waves that are shifted along x against their decay (`slant`) allow a small angle only.
module mfv_wave_integral
   use mfv_kinds, only: pi, wp
   use mfv_quadrature, only: gauss_points
   implicit none
   private
   public :: new_wave_integral, last_exponent

   integer, parameter :: points = 20
   !> exp(-k scale) at the end of the integrals; the largest angle and its least distance, as a ratio of tangents, from where
   !> shifted waves no longer decay; what an interval may have of oscillation, over the decay up to its end.
   real(wp), parameter :: last_exponent = 44.0_wp, largest_angle = pi/8.0_wp, part_of_slant = 0.4_wp, part_of_decay = 1.1_wp

contains

   !> Points `k`, 1/length, and weights of the sum; `part`: of the usual angle.
   pure subroutine new_wave_integral(scale, reach, slant, part, k, weight)
      real(wp), intent(in) :: scale, reach, slant, part
      complex(wp), allocatable, intent(out) :: k(:), weight(:)
      real(wp) :: angle, from, to, ratio, place(points), here(points), last
      integer :: i, intervals

      angle = part*min(largest_angle, atan(part_of_slant/max(slant, tiny(1.0_wp))))
      ratio = 1.0_wp + part_of_decay*sin(angle)
      last = last_exponent/(scale*(cos(angle) - slant*sin(angle)))
      to = min(1.0_wp/reach, 1.0e-4_wp/scale)
      intervals = 1 + max(ceiling(log(last/to)/log(ratio)), 0)
      allocate (k(points*intervals), weight(points*intervals))
      from = 0.0_wp
      do i = 1, intervals
         call gauss_points(from, to, place, here)
         k(points*(i - 1) + 1:points*i) = place*exp(cmplx(0.0_wp, angle, wp))
         weight(points*(i - 1) + 1:points*i) = here*exp(cmplx(0.0_wp, angle, wp))
         from = to
         to = ratio*to
      end do
   end subroutine new_wave_integral

end module mfv_wave_integral
