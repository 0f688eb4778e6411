!> Gauss-Legendre quadrature.
module mfv_quadrature
   use mfv_kinds, only: pi, wp
   implicit none
   private
   public :: gauss_points

contains

   !> Points and weights of Gauss-Legendre quadrature from `lower` to `upper`, ascending: the roots of the Legendre polynomial by
   !> Newton's method (Abramowitz and Stegun 1964, eqs. 25.4.29, 8.5.3 and 8.5.4).
   pure subroutine gauss_points(lower, upper, point, weight)
      real(wp), intent(in) :: lower, upper
      real(wp), intent(out) :: point(:), weight(:)
      integer, parameter :: most_iterations = 10
      real(wp) :: x, step, values(2), slope
      integer :: i, iteration, n

      n = size(point)
      do i = 1, n
         x = -cos(pi*(i - 0.25_wp)/(n + 0.5_wp))
         do iteration = 1, most_iterations
            values = legendre(n, x)
            slope = n*(x*values(1) - values(2))/(x**2 - 1.0_wp)
            step = values(1)/slope
            x = x - step
            if (abs(step) <= epsilon(x)) exit
         end do
         values = legendre(n, x)
         slope = n*(x*values(1) - values(2))/(x**2 - 1.0_wp)
         point(i) = 0.5_wp*(lower + upper) + 0.5_wp*(upper - lower)*x
         weight(i) = (upper - lower)/((1.0_wp - x**2)*slope**2)
      end do
   end subroutine gauss_points

   !> The Legendre polynomials of the degrees n and n - 1 at x.
   pure function legendre(n, x) result(values)
      integer, intent(in) :: n
      real(wp), intent(in) :: x
      real(wp) :: values(2)
      integer :: k

      values = [x, 1.0_wp]
      do k = 2, n
         values = [((2*k - 1)*x*values(1) - (k - 1)*values(2))/k, values(1)]
      end do
   end function legendre

end module mfv_quadrature
