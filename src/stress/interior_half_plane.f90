!> Stresses inside a half-plane under tractions that are linear on elements of its surface, in closed form.
!>
!> Muskhelishvili's potentials of the lower half-plane with sigma_yy = -p, sigma_xy = tau on y = 0 (Muskhelishvili 1953,
!> sections 90 to 93; Johnson 1985, section 2.5, for uniform and triangular tractions): Phi(z) = 1/(2 pi i) integral of (p + i
!> tau)/(t - z) dt, sigma_xx + sigma_yy = 4 Re Phi, sigma_yy - sigma_xx + 2 i sigma_xy = -4 i y Phi' - 2/pi integral of tau/(t
!> - z) dt. The integrals over an element are elementary; for elements that are short compared with their distance, series
!> avoid cancellation; groups of distant elements act together (mfv_element_tree).
module mfv_interior_half_plane
   use mfv_element_tree, only: element_tree_type, last_not_above, new_straight_tree
   use mfv_kinds, only: pi, wp
   use mfv_logarithms, only: log_ratio
   implicit none
   private
   public :: half_plane_load_type, new_half_plane_load

   !> Terms of the power series, which converge at least as 1/25^k: enough for the kind of real numbers.
   integer, parameter :: most_terms = int(0.25_wp*digits(1.0_wp)) + 2

   !> A half-plane under tractions p + i tau that are linear on elements.
   type :: half_plane_load_type
      private
      !> Ends of the elements, lengths, and tractions there, force/length^2; shapes (elements).
      real(wp), allocatable :: from(:), to(:)
      complex(wp), allocatable :: first(:), last(:)
      type(element_tree_type) :: tree
   contains
      procedure :: stress
      procedure :: surface_stress
      procedure :: traction
   end type half_plane_load_type

contains

   !> Elements from `from` to `to`, lengths (ascending, for speed), with tractions p + i tau linear from `first` to `last`,
   !> force/length^2; shapes (elements).
   pure type(half_plane_load_type) function new_half_plane_load(from, to, first, last) result(self)
      real(wp), intent(in) :: from(:), to(:)
      complex(wp), intent(in) :: first(:), last(:)

      self%from = from
      self%to = to
      self%first = first
      self%last = last
      self%tree = new_straight_tree(from, to, first, last)
   end function new_half_plane_load

   !> Stresses (sigma_xx, sigma_yy, sigma_xy), force/length^2, at the depth `depth` >= 0 below the surface point `x`, lengths. At
   !> jumps of the tractions the singular term of sigma_xx on the surface is omitted.
   pure function stress(self, x, depth)
      class(half_plane_load_type), intent(in) :: self
      real(wp), intent(in) :: x, depth
      real(wp) :: stress(3)
      complex(wp), parameter :: i = (0.0_wp, 1.0_wp)
      complex(wp) :: potential, slope, shear, mean, tilt, integral(2), derivative(2), distant(3)
      integer :: near(2, self%tree%leaves()), number, j, k

      call self%tree%find_distant(cmplx(x, -depth, wp), distant, near, number)
      potential = distant(1)
      slope = distant(2)
      shear = distant(3)
      do k = 1, number
         do j = near(1, k), near(2, k)
            mean = 0.5_wp*(self%first(j) + self%last(j))
            tilt = 0.5_wp*(self%last(j) - self%first(j))
            call element_integrals(self%from(j) - x, self%to(j) - x, depth, integral, derivative)
            potential = potential + mean*integral(1) + tilt*integral(2)
            slope = slope + mean*derivative(1) + tilt*derivative(2)
            shear = shear + aimag(mean)*integral(1) + aimag(tilt)*integral(2)
         end do
      end do
      potential = potential/(2.0_wp*pi*i)
      shear = depth*slope/pi - shear/pi
      stress(1) = 2.0_wp*real(potential, wp) - real(shear, wp)
      stress(2) = 2.0_wp*real(potential, wp) + real(shear, wp)
      stress(3) = aimag(shear)
   end function stress

   !> sigma_xx at the surface point `x`, equal to that of `stress`, in real numbers: -p(x) + 2/pi integral of tau/(t - x) dt.
   pure real(wp) function surface_stress(self, x)
      class(half_plane_load_type), intent(in) :: self
      real(wp), intent(in) :: x
      real(wp) :: pressure, sum
      complex(wp) :: distant(3)
      integer :: near(2, self%tree%leaves()), number, j, k

      call self%tree%find_distant(cmplx(x, 0.0_wp, wp), distant, near, number)
      pressure = 0.0_wp
      sum = real(distant(3), wp)
      do k = 1, number
         do j = near(1, k), near(2, k)
            call add_surface_element(self%from(j) - x, self%to(j) - x, self%first(j), self%last(j), sum, pressure)
         end do
      end do
      surface_stress = 2.0_wp/pi*sum - pressure
   end function surface_stress

   !> p + i tau at the surface point `x`, 0 outside all elements.
   pure complex(wp) function traction(self, x)
      class(half_plane_load_type), intent(in) :: self
      real(wp), intent(in) :: x
      integer :: j

      traction = 0.0_wp
      j = last_not_above(self%from, x)
      if (j == 0) return
      if (x > self%to(j) .or. .not. self%to(j) > self%from(j)) return
      traction = self%first(j) + (self%last(j) - self%first(j))*((x - self%from(j))/(self%to(j) - self%from(j)))
   end function traction

   !> Add the integral of tau/t over an element from `left` to `right`, and the pressure at 0 if it is there.
   pure subroutine add_surface_element(left, right, first, last, sum, pressure)
      real(wp), intent(in) :: left, right
      complex(wp), intent(in) :: first, last
      real(wp), intent(inout) :: sum, pressure
      real(wp) :: middle, half, ratio, square, power, growth, tilted
      integer :: k
      !> Factors of the series of the distant elements.
      real(wp), parameter :: factor(most_terms) = [(2.0_wp/(2*k + 1), k=1, most_terms)]

      middle = 0.5_wp*(left + right)
      half = 0.5_wp*(right - left)
      if (abs(middle) > 5.0_wp*half) then
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
         if (abs(left) > 0.0_wp) growth = -log(abs(left))
         if (abs(right) > 0.0_wp) growth = growth + log(abs(right))
         tilted = 2.0_wp - growth*middle/half
         if (left <= 0.0_wp .and. right >= 0.0_wp) &
            pressure = max(pressure, real(first, wp) - left/(right - left)*real(last - first, wp))
      end if
      sum = sum + 0.5_wp*(aimag(first + last)*growth + aimag(last - first)*tilted)
   end subroutine add_surface_element

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
