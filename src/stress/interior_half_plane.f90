!> Stresses inside a half-plane under tractions that are linear on elements of its surface, in closed form.
!>
!> Muskhelishvili's potentials of the lower half-plane with sigma_yy = -p, sigma_xy = tau on y = 0 (Muskhelishvili 1953,
!> sections 90 to 93; Johnson 1985, section 2.5, for uniform and triangular tractions): Phi(z) = 1/(2 pi i) integral of (p + i
!> tau)/(t - z) dt, sigma_xx + sigma_yy = 4 Re Phi, sigma_yy - sigma_xx + 2 i sigma_xy = -4 i y Phi' - 2/pi integral of tau/(t
!> - z) dt. The integrals over an element are elementary; for elements that are short compared with their distance, series
!> avoid cancellation.
module mfv_interior_half_plane
   use mfv_kinds, only: pi, wp
   use mfv_logarithms, only: log_ratio
   implicit none
   private
   public :: half_plane_stress, half_plane_surface_stress

   !> Terms of the power series, which converge at least as 1/25^k: enough for the kind of real numbers.
   integer, parameter :: most_terms = int(0.25_wp*digits(1.0_wp)) + 2

contains

   !> Stresses (sigma_xx, sigma_yy, sigma_xy), force/length^2, at the depth `depth` >= 0 below the surface point `x`. Elements
   !> from `from` to `to` (lengths) with the traction p + i tau linear from `first` to `last`; shapes (elements). At jumps of
   !> the tractions the singular term of sigma_xx on the surface is omitted.
   pure function half_plane_stress(from, to, first, last, x, depth) result(stress)
      real(wp), intent(in) :: from(:), to(:), x, depth
      complex(wp), intent(in) :: first(:), last(:)
      real(wp) :: stress(3)
      complex(wp), parameter :: i = (0.0_wp, 1.0_wp)
      complex(wp) :: potential, slope, shear, mean, tilt, integral(2), derivative(2)
      integer :: j

      potential = 0.0_wp
      slope = 0.0_wp
      shear = 0.0_wp
      do j = 1, size(from)
         mean = 0.5_wp*(first(j) + last(j))
         tilt = 0.5_wp*(last(j) - first(j))
         call element_integrals(from(j) - x, to(j) - x, depth, integral, derivative)
         potential = potential + mean*integral(1) + tilt*integral(2)
         slope = slope + mean*derivative(1) + tilt*derivative(2)
         shear = shear + aimag(mean)*integral(1) + aimag(tilt)*integral(2)
      end do
      potential = potential/(2.0_wp*pi*i)
      shear = depth*slope/pi - shear/pi
      stress(1) = 2.0_wp*real(potential, wp) - real(shear, wp)
      stress(2) = 2.0_wp*real(potential, wp) + real(shear, wp)
      stress(3) = aimag(shear)
   end function half_plane_stress

   !> sigma_xx at the surface point `x`, equal to that of half_plane_stress, in real numbers: -p(x) + 2/pi integral of tau/(t
   !> - x) dt.
   pure real(wp) function half_plane_surface_stress(from, to, first, last, x) result(stress)
      real(wp), intent(in) :: from(:), to(:), x
      complex(wp), intent(in) :: first(:), last(:)
      real(wp) :: pressure, sum, middle, half, ratio, square, power, growth, tilted
      integer :: j, k
      !> Factors of the series of the distant elements.
      real(wp), parameter :: factor(most_terms) = [(2.0_wp/(2*k + 1), k=1, most_terms)]

      pressure = 0.0_wp
      sum = 0.0_wp
      do j = 1, size(from)
         middle = 0.5_wp*(from(j) + to(j)) - x
         half = 0.5_wp*(to(j) - from(j))
         if (abs(middle) > 100.0_wp*half) then
            ! Four terms of the series below.
            ratio = half/middle
            square = ratio**2
            tilted = -square*(2.0_wp/3.0_wp + square*(2.0_wp/5.0_wp + square*(2.0_wp/7.0_wp + square*(2.0_wp/9.0_wp))))
            growth = ratio*(2.0_wp - tilted)
         else if (abs(middle) > 5.0_wp*half) then
            ratio = half/middle
            square = ratio**2
            power = 1.0_wp
            tilted = 0.0_wp
            do k = 1, most_terms
               if (power <= 0.1_wp*epsilon(1.0_wp)) exit
               power = power*square
               tilted = tilted - factor(k)*power
            end do
            growth = ratio*(2.0_wp - tilted)
         else
            growth = 0.0_wp
            if (abs(from(j) - x) > 0.0_wp) growth = -log(abs(from(j) - x))
            if (abs(to(j) - x) > 0.0_wp) growth = growth + log(abs(to(j) - x))
            tilted = 2.0_wp - growth*middle/half
            if (x >= from(j) .and. x <= to(j)) &
               pressure = max(pressure, real(first(j), wp) + (x - from(j))/(to(j) - from(j))*real(last(j) - first(j), wp))
         end if
         sum = sum + 0.5_wp*(aimag(first(j) + last(j))*growth + aimag(last(j) - first(j))*tilted)
      end do
      stress = 2.0_wp/pi*sum - pressure
   end function half_plane_surface_stress

   !> Integrals over an element of 1/(t - z) and u/(t - z) dt, u from -1 to 1, and their derivatives with respect to z (zero
   !> on the surface, where they are not needed). `left`, `right`: its ends relative to the point; `depth` of the point.
   pure subroutine element_integrals(left, right, depth, integral, derivative)
      real(wp), intent(in) :: left, right, depth
      complex(wp), intent(out) :: integral(2), derivative(2)
      real(wp), parameter :: short = 0.04_wp
      real(wp) :: middle, half, square_left, square_right
      complex(wp) :: place

      middle = 0.5_wp*(left + right)
      half = 0.5_wp*(right - left)
      place = cmplx(-middle, -depth, wp)/half
      if (short*(middle**2 + depth**2) > half**2) then
         call distant_integrals(half, place, integral, derivative)
         return
      end if
      square_left = left**2 + depth**2
      square_right = right**2 + depth**2
      integral(1) = cmplx(0.0_wp, -atan2(2.0_wp*half*depth, depth**2 + left*right), wp)
      derivative = 0.0_wp
      if (min(square_left, square_right) > (epsilon(1.0_wp)*half)**2) then
         integral(1) = integral(1) + 0.5_wp*log_ratio(square_left, square_right, 4.0_wp*half*middle)
         if (depth > 0.0_wp) derivative(1) = 2.0_wp*half/(cmplx(left, depth, wp)*cmplx(right, depth, wp))
      else
         ! At an end on the surface the singular logarithm cancels with that of the next element.
         integral(1) = cmplx(merge(1.0_wp, -1.0_wp, middle > 0.0_wp)*log(2.0_wp*half), -0.5_wp*pi, wp)
      end if
      integral(2) = place*integral(1) + 2.0_wp
      if (depth > 0.0_wp) derivative(2) = integral(1)/half + place*derivative(1)
   end subroutine element_integrals

   !> The same as power series, for elements that are short compared with their distance. `place`: the point relative to the
   !> middle, over half the length of the element.
   pure subroutine distant_integrals(half, place, integral, derivative)
      real(wp), intent(in) :: half
      complex(wp), intent(in) :: place
      complex(wp), intent(out) :: integral(2), derivative(2)
      complex(wp) :: ratio, square, power
      real(wp) :: size_of_power
      integer :: k

      ratio = 1.0_wp/place
      square = ratio**2
      power = 1.0_wp
      size_of_power = 1.0_wp
      integral(2) = 0.0_wp
      derivative(2) = 0.0_wp
      do k = 1, most_terms
         if (size_of_power <= 0.1_wp*epsilon(1.0_wp)) exit
         power = power*square
         size_of_power = abs(real(power, wp)) + abs(aimag(power))
         integral(2) = integral(2) - 2.0_wp*power/(2*k + 1)
         derivative(2) = derivative(2) + 2.0_wp*power*(2*k)/(2*k + 1)
      end do
      integral(1) = ratio*(integral(2) - 2.0_wp)
      derivative(1) = 2.0_wp*square/(half*(1.0_wp - square))
      derivative(2) = derivative(2)*ratio/half
   end subroutine distant_integrals

end module mfv_interior_half_plane
