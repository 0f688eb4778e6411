!> Chebyshev series, and functions of a distance as such series over intervals (Trefethen 2013, chapters 2 to 5).
module mfv_chebyshev
   use mfv_kinds, only: pi, wp
   implicit none
   private
   public :: piecewise_type, chebyshev_points, chebyshev_coefficients, lagrange_weights

   !> Functions of a distance from 0 on.
   type :: piecewise_type
      !> Ends of the intervals, from 0, and the coefficients of the series, shape (terms, functions, intervals).
      real(wp), allocatable :: ends(:), series(:, :, :)
   contains
      procedure :: values_at
      procedure :: append
   end type piecewise_type

contains

   !> The Chebyshev points between `from` and `to`, from the last one back.
   pure function chebyshev_points(number, from, to) result(points)
      integer, intent(in) :: number
      real(wp), intent(in) :: from, to
      real(wp) :: points(number)
      integer :: j

      points = [(from + 0.5_wp*(to - from)*(1.0_wp + cos(pi*(j - 0.5_wp)/number)), j=1, number)]
   end function chebyshev_points

   !> Coefficients of the series with the given `values` at the Chebyshev points; both of shape (terms, functions).
   pure function chebyshev_coefficients(values) result(coefficients)
      real(wp), intent(in) :: values(:, :)
      real(wp) :: coefficients(size(values, 1), size(values, 2)), turn(size(values, 1), size(values, 1))
      integer :: i, j, n

      n = size(values, 1)
      turn = reshape([((cos(pi*(i - 1)*(j - 0.5_wp)/n), i=1, n), j=1, n)], [n, n])
      coefficients = matmul(turn, values)*(2.0_wp/n)
      coefficients(1, :) = 0.5_wp*coefficients(1, :)
   end function chebyshev_coefficients

   !> Weights of values at the Chebyshev points between -1 and 1 for that of their polynomial at t (barycentric formula).
   pure function lagrange_weights(number, t) result(weight)
      integer, intent(in) :: number
      real(wp), intent(in) :: t
      real(wp) :: weight(number), away(number)
      integer :: j

      away = t - chebyshev_points(number, -1.0_wp, 1.0_wp)
      j = minloc(abs(away), dim=1)
      weight = 0.0_wp
      weight(j) = 1.0_wp
      if (.not. abs(away(j)) > 0.0_wp) return
      weight = [((-1)**j*sin(pi*(j - 0.5_wp)/number), j=1, number)]/away
      weight = weight/sum(weight)
   end function lagrange_weights

   !> The functions from the number `first` on at a distance within the intervals, shape (number).
   pure function values_at(self, distance, first, number) result(values)
      class(piecewise_type), intent(in) :: self
      real(wp), intent(in) :: distance
      integer, intent(in) :: first, number
      real(wp) :: values(number), before(number), next, t
      integer :: here, beyond, middle, i, k

      here = 1
      beyond = size(self%ends)
      do while (beyond - here > 1)
         middle = (here + beyond)/2
         if (distance < self%ends(middle)) then
            beyond = middle
         else
            here = middle
         end if
      end do
      t = (2.0_wp*distance - self%ends(here) - self%ends(beyond))/(self%ends(beyond) - self%ends(here))
      values = 0.0_wp
      before = 0.0_wp
      ! Clenshaw's recurrence, without copies of short arrays.
      do k = size(self%series, 1), 1, -1
         if (k == 1) t = 0.5_wp*t
         do i = 1, number
            next = 2.0_wp*t*values(i) - before(i) + self%series(k, first + i - 1, here)
            before(i) = values(i)
            values(i) = next
         end do
      end do
   end function values_at

   !> Append an interval up to `to` with these coefficients, shape (terms, functions).
   pure subroutine append(self, to, coefficients)
      class(piecewise_type), intent(inout) :: self
      real(wp), intent(in) :: to, coefficients(:, :)
      real(wp), allocatable :: longer(:, :, :)
      integer :: n

      n = size(self%ends)
      allocate (longer(size(coefficients, 1), size(coefficients, 2), n))
      longer(:, :, :n - 1) = self%series
      longer(:, :, n) = coefficients
      call move_alloc(longer, self%series)
      self%ends = [self%ends, to]
   end subroutine append

end module mfv_chebyshev
