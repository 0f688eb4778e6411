!> Cauchy integrals of tractions that repeat along a straight surface, sigma times (pi/l) cot(pi (t - z)/l) over one period l:
!> beside the nearest images, which are elements like others.
!>
!> Near the surface the distant images add a function without singularities within 2.5 periods,
!>
!>     sum over |m| > 2 of 1/(y + m l) = -(2/l) sum over k >= 0 of a_k (y/l)^(2k+1),  a_k = sum over m > 2 of m^-(2k+2),  y = t - z,
!>
!> a polynomial in z with coefficients from the moments of sigma. Deeper the whole is -(i pi/l) [f_0 + 2 sum over k > 0 of
!> f_k exp(-2 pi i k z/l)] with the Fourier coefficients f_k = integral of sigma exp(2 pi i k t/l) dt. All with divided differences
!> between two points (mfv_interior_half_plane).
module mfv_periodic_images
   use mfv_kinds, only: pi, wp
   use mfv_quadrature, only: gauss_points
   implicit none
   private
   public :: periodic_images_type, new_periodic_images, images_each_side

   !> Images to either side that are not in the sums; terms a_k; largest k of the Fourier series; points of a quadrature.
   integer, parameter :: images_each_side = 2, terms = ceiling(0.8_wp*digits(1.0_wp))
   integer, parameter :: most_modes = ceiling(0.12_wp*digits(1.0_wp)) + 2, points = ceiling(0.25_wp*digits(1.0_wp))
   !> Where the polynomial holds: distances from the middle, in periods; and depths of the Fourier series.
   real(wp), parameter :: near = 1.25_wp, deep = 1.1_wp

   type :: periodic_images_type
      !> 0: the surface does not repeat.
      real(wp) :: period = 0.0_wp
      !> Coefficients of z/period, and Fourier coefficients, of sigma and of its imaginary part.
      complex(wp), private :: polynomial(0:2*terms - 1, 2) = 0.0_wp, mode(0:most_modes, 2) = 0.0_wp
   contains
      procedure :: move_into_period
      procedure :: is_deep
      procedure :: is_near
      procedure :: add_distant
      procedure :: whole
   end type periodic_images_type

contains

   !> Of elements from `from` to `to` (lengths, within half a period of 0) with sigma linear from `first` to `last`; shapes
   !> (elements).
   pure type(periodic_images_type) function new_periodic_images(period, from, to, first, last) result(self)
      real(wp), intent(in) :: period, from(:), to(:)
      complex(wp), intent(in) :: first(:), last(:)
      !> Elements up to this part of the period need fewer points: the highest powers of z that matter there are about 20.
      real(wp), parameter :: short = 0.005_wp
      integer, parameter :: fewer_points = 4
      real(wp) :: point(points, 2), weight(points, 2), place
      complex(wp) :: moment(0:2*terms - 1), part, turn, power(2)
      real(wp) :: binomial(0:2*terms - 1), a
      integer :: i, j, k, element, rule

      self%period = period
      call gauss_points(0.0_wp, 1.0_wp, point(:, 1), weight(:, 1))
      call gauss_points(0.0_wp, 1.0_wp, point(:fewer_points, 2), weight(:fewer_points, 2))
      moment = 0.0_wp
      do element = 1, size(from)
         rule = merge(2, 1, to(element) - from(element) <= short*period)
         do i = 1, merge(fewer_points, points, rule == 2)
            place = (from(element) + point(i, rule)*(to(element) - from(element)))/period
            part = (first(element) + point(i, rule)*(last(element) - first(element)))*weight(i, rule)*(to(element) - from(element))
            turn = exp(cmplx(0.0_wp, 2.0_wp*pi*place, wp))
            power = [part, cmplx(aimag(part), 0.0_wp, wp)]
            do k = 0, most_modes
               self%mode(k, :) = self%mode(k, :) + power
               power = power*turn
            end do
            do k = 0, 2*terms - 1
               moment(k) = moment(k) + part
               part = part*place
            end do
         end do
      end do
      binomial = 0.0_wp
      binomial(0) = 1.0_wp
      do k = 1, 2*terms - 1
         binomial(1:k) = binomial(1:k) + binomial(0:k - 1)
         if (modulo(k, 2) == 0) cycle
         a = sum_of_powers(k + 1)
         do j = 0, k
            self%polynomial(j, 1) = self%polynomial(j, 1) - 2.0_wp/period*a*(-1)**j*binomial(j)*moment(k - j)
         end do
      end do
      self%polynomial(:, 2) = aimag(self%polynomial(:, 1))
   end function new_periodic_images

   !> Sum of m^-s over m > images_each_side, s >= 2: the first terms, and the others by the formula of Euler and Maclaurin.
   pure real(wp) function sum_of_powers(s) result(total)
      integer, intent(in) :: s
      integer, parameter :: first_left = 400
      real(wp) :: m
      integer :: i

      m = first_left
      total = m**(1 - s)/(s - 1) + 0.5_wp*m**(-s) + s*m**(-s - 1)/12.0_wp - s*(s + 1.0_wp)*(s + 2.0_wp)*m**(-s - 3)/720.0_wp
      do i = first_left - 1, images_each_side + 1, -1
         total = total + real(i, wp)**(-s)
      end do
   end function sum_of_powers

   !> Points moved by a common number of periods so that their middle is within half a period of 0.
   pure function move_into_period(self, z) result(moved)
      class(periodic_images_type), intent(in) :: self
      complex(wp), intent(in) :: z(:)
      complex(wp) :: moved(size(z))

      moved = z - self%period*anint(sum(real(z, wp))/(size(z)*self%period))
   end function move_into_period

   !> Whether all points are so deep that the Fourier series converges quickly.
   pure logical function is_deep(self, z)
      class(periodic_images_type), intent(in) :: self
      complex(wp), intent(in) :: z(:)

      is_deep = all(-aimag(z) > deep*self%period)
   end function is_deep

   !> Whether the distant images are a polynomial at all points.
   pure logical function is_near(self, z)
      class(periodic_images_type), intent(in) :: self
      complex(wp), intent(in) :: z(:)

      is_near = all(real(z, wp)**2 + aimag(z)**2 <= (near*self%period)**2)
   end function is_near

   !> Add the integrals over the distant images to those at z1 and their divided differences between z1 and z2, of sigma and of its
   !> imaginary part in turn.
   pure subroutine add_distant(self, z, sums)
      class(periodic_images_type), intent(in) :: self
      complex(wp), intent(in) :: z(2)
      complex(wp), intent(inout) :: sums(4)
      complex(wp) :: values(2), differences(2)
      integer :: k

      values = 0.0_wp
      differences = 0.0_wp
      do k = 2*terms - 1, 0, -1
         differences = differences*(z(2)/self%period) + values
         values = values*(z(1)/self%period) + self%polynomial(k, :)
      end do
      sums = sums + [values(1), differences(1)/self%period, values(2), differences(2)/self%period]
   end subroutine add_distant

   !> The same integrals over all images, deep below the surface.
   pure function whole(self, z) result(sums)
      class(periodic_images_type), intent(in) :: self
      complex(wp), intent(in) :: z(2)
      complex(wp) :: sums(4), wave, step, factor
      integer :: k

      factor = cmplx(0.0_wp, -pi/self%period, wp)
      sums = factor*[self%mode(0, 1), (0.0_wp, 0.0_wp), self%mode(0, 2), (0.0_wp, 0.0_wp)]
      do k = 1, most_modes
         wave = cmplx(0.0_wp, -2.0_wp*pi*k/self%period, wp)
         step = wave*exp(0.5_wp*wave*(z(1) + z(2)))*sinh_over(0.5_wp*wave*(z(2) - z(1)))
         sums = sums + 2.0_wp*factor*[self%mode(k, 1)*exp(wave*z(1)), self%mode(k, 1)*step, &
                                      self%mode(k, 2)*exp(wave*z(1)), self%mode(k, 2)*step]
      end do
   end function whole

   !> sinh(w)/w; 1 at 0.
   pure complex(wp) function sinh_over(w)
      complex(wp), intent(in) :: w
      integer :: k

      if (abs(w) > 0.5_wp) then
         sinh_over = (exp(w) - exp(-w))/(2.0_wp*w)
         return
      end if
      sinh_over = 1.0_wp
      do k = ceiling(0.25_wp*digits(1.0_wp)), 1, -1
         sinh_over = 1.0_wp + sinh_over*w**2/((2*k)*(2*k + 1))
      end do
   end function sinh_over

end module mfv_periodic_images
