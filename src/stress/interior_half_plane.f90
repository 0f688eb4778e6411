!> Stresses inside a half-plane under tractions that are linear on elements of its surface, in closed form.
!>
!> Muskhelishvili's potentials of the lower half-plane with sigma_yy = -p, sigma_xy = tau on y = 0 (Muskhelishvili 1953,
!> sections 90 to 93; Johnson 1985, section 2.5, for uniform and triangular tractions): Phi(z) = 1/(2 pi i) integral of (p + i
!> tau)/(t - z) dt, sigma_xx + sigma_yy = 4 Re Phi, sigma_yy - sigma_xx + 2 i sigma_xy = -4 i y Phi' - 2/pi integral of tau/(t
!> - z) dt. The integrals over an element are elementary; for elements that are short compared with their distance, series
!> avoid cancellation. Distant blocks of elements act through their moments M_k about the middle c of the block:
!>
!>     integral of (p + i tau)/(t - z) dt = - sum over k >= 0 of M_k/(z - c)^(k+1),  M_k = integral of (p + i tau) (t - c)^k dt.
module mfv_interior_half_plane
   use mfv_kinds, only: pi, wp
   use mfv_logarithms, only: log_ratio
   implicit none
   private
   public :: half_plane_load_type, new_half_plane_load

   !> Terms of the power series, which converge at least as 1/25^k: enough for the kind of real numbers.
   integer, parameter :: most_terms = int(0.25_wp*digits(1.0_wp)) + 2
   !> Elements of a block; half-lengths beyond which it acts through its moments; the highest moment.
   integer, parameter :: block_size = 32
   real(wp), parameter :: distant = 4.0_wp
   integer, parameter :: most_moments = ceiling(0.5_wp*digits(1.0_wp))

   !> A half-plane under tractions p + i tau that are linear on elements.
   type :: half_plane_load_type
      private
      !> Ends of the elements, lengths, and tractions there, force/length^2; shapes (elements).
      real(wp), allocatable :: from(:), to(:)
      complex(wp), allocatable :: first(:), last(:)
      !> Blocks of elements: middles and half-lengths, shapes (blocks), and moments over half-length^k, shape (0:most_moments,
      !> blocks).
      real(wp), allocatable :: middle(:), half(:)
      complex(wp), allocatable :: moments(:, :)
   contains
      procedure :: stress
      procedure :: surface_stress
   end type half_plane_load_type

contains

   !> Elements from `from` to `to`, lengths (blocks are short if they ascend), with tractions p + i tau linear from `first` to
   !> `last`, force/length^2; shapes (elements).
   pure type(half_plane_load_type) function new_half_plane_load(from, to, first, last) result(self)
      real(wp), intent(in) :: from(:), to(:)
      complex(wp), intent(in) :: first(:), last(:)
      integer :: block, blocks, j

      self%from = from
      self%to = to
      self%first = first
      self%last = last
      blocks = (size(from) + block_size - 1)/block_size
      allocate (self%middle(blocks), self%half(blocks), self%moments(0:most_moments, blocks))
      self%moments = 0.0_wp
      do block = 1, blocks
         associate (left => minval(from(begin_of(block):end_of(self, block))), &
                    right => maxval(to(begin_of(block):end_of(self, block))))
            self%middle(block) = 0.5_wp*(left + right)
            self%half(block) = 0.5_wp*(right - left)
         end associate
         do j = begin_of(block), end_of(self, block)
            if (.not. to(j) > from(j)) cycle
            call add_moments((from(j) - self%middle(block))/self%half(block), (to(j) - self%middle(block))/self%half(block), &
                             self%half(block)*first(j), self%half(block)*last(j), self%moments(:, block))
         end do
      end do
   end function new_half_plane_load

   !> First element of a block.
   pure integer function begin_of(block)
      integer, intent(in) :: block

      begin_of = (block - 1)*block_size + 1
   end function begin_of

   !> Last element of a block.
   pure integer function end_of(self, block)
      type(half_plane_load_type), intent(in) :: self
      integer, intent(in) :: block

      end_of = min(block*block_size, size(self%from))
   end function end_of

   !> Add the moments of an element on a block from -1 to 1, with tractions times its half-length. Errors are some hundred times
   !> the round-off in the moments of the block.
   pure subroutine add_moments(from, to, first, last, moments)
      real(wp), intent(in) :: from, to
      complex(wp), intent(in) :: first, last
      complex(wp), intent(inout) :: moments(0:)
      real(wp) :: powers(2), integral, next
      integer :: k

      powers = [from, to]
      integral = to - from
      do k = 0, most_moments
         powers = powers*[from, to]
         next = (powers(2) - powers(1))/(k + 2)
         moments(k) = moments(k) + first*integral + (last - first)*((next - from*integral)/(to - from))
         integral = next
      end do
   end subroutine add_moments

   !> Terms of the series of a block at `distance` half-lengths from its middle.
   elemental integer function terms_at(distance)
      real(wp), intent(in) :: distance

      terms_at = min(most_moments, ceiling(digits(1.0_wp)*log(2.0_wp)/log(distance)))
   end function terms_at

   !> Stresses (sigma_xx, sigma_yy, sigma_xy), force/length^2, at the depth `depth` >= 0 below the surface point `x`, lengths. At
   !> jumps of the tractions the singular term of sigma_xx on the surface is omitted.
   pure function stress(self, x, depth)
      class(half_plane_load_type), intent(in) :: self
      real(wp), intent(in) :: x, depth
      real(wp) :: stress(3), distance
      complex(wp), parameter :: i = (0.0_wp, 1.0_wp)
      complex(wp) :: potential, slope, shear, mean, tilt, integral(2), derivative(2)
      integer :: block, j

      potential = 0.0_wp
      slope = 0.0_wp
      shear = 0.0_wp
      do block = 1, size(self%middle)
         distance = sqrt((x - self%middle(block))**2 + depth**2)/self%half(block)
         if (distance > distant) then
            call add_block(cmplx(x - self%middle(block), -depth, wp), self%half(block), &
                           self%moments(:terms_at(distance), block), potential, slope, shear)
            cycle
         end if
         do j = begin_of(block), end_of(self, block)
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

   !> Add the integrals of (p + i tau)/(t - z), its derivative, and of tau/(t - z) over a distant block, with z relative to its
   !> middle.
   pure subroutine add_block(z, half, moments, potential, slope, shear)
      complex(wp), intent(in) :: z, moments(0:)
      real(wp), intent(in) :: half
      complex(wp), intent(inout) :: potential, slope, shear
      complex(wp) :: ratio, sums(3)
      integer :: k

      ratio = half/z
      sums = 0.0_wp
      do k = ubound(moments, 1), 0, -1
         sums = sums*ratio + [moments(k), (k + 1)*moments(k), cmplx(aimag(moments(k)), 0.0_wp, wp)]
      end do
      potential = potential - sums(1)/z
      slope = slope + sums(2)/z**2
      shear = shear - sums(3)/z
   end subroutine add_block

   !> sigma_xx at the surface point `x`, equal to that of `stress`, in real numbers: -p(x) + 2/pi integral of tau/(t - x) dt.
   pure real(wp) function surface_stress(self, x)
      class(half_plane_load_type), intent(in) :: self
      real(wp), intent(in) :: x
      real(wp) :: pressure, sum, part, ratio, place
      integer :: block, j, k

      pressure = 0.0_wp
      sum = 0.0_wp
      do block = 1, size(self%middle)
         place = x - self%middle(block)
         if (abs(place) > distant*self%half(block)) then
            ratio = self%half(block)/place
            part = 0.0_wp
            do k = terms_at(abs(place)/self%half(block)), 0, -1
               part = part*ratio + aimag(self%moments(k, block))
            end do
            sum = sum - part/place
            cycle
         end if
         do j = begin_of(block), end_of(self, block)
            call add_surface_element(self%from(j) - x, self%to(j) - x, self%first(j), self%last(j), sum, pressure)
         end do
      end do
      surface_stress = 2.0_wp/pi*sum - pressure
   end function surface_stress

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
