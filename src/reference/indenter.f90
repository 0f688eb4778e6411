!> Closed form: two bodies with a symmetric gap g(x) = sum of C |x|^n and of (|x| - b)^2/(2 R) beyond |x| = b, pressed on each
!> other without friction: wedge (n = 1), cylinder (n = 2), power law, flat punch with rounded edges, and sums of them.
!>
!> A growing contact is a sequence of flat punches of half-width s, each with the force P'(s) ds (Johnson 1985, section 2.8;
!> Jaeger 2005). The gap's slope at x < a requires P(a) = 2 m F(a) with F(a) = integral of x g'(x)/sqrt(a^2 - x^2) from 0 to
!> a, m the modulus of mfv_reference_hertz; then p(x) = integral of P'(s)/(pi sqrt(s^2 - x^2)) from |x| to a. Both are linear
!> in g for a given a: gaps can be added. Rounded edges: Ciavarella, Hills and Monno 1998.
module mfv_reference_indenter
   use mfv_kinds, only: pi, wp
   use mfv_numerics, only: gauss_legendre
   implicit none
   private
   public :: indenter_type, flat_indenter, power_indenter, rounded_punch_indenter

   !> A gap between two bodies. Without terms: flat.
   type :: indenter_type
      !> Terms C |x|^n: C >= 0, length^(1 - n), and n >= 1.
      real(wp), allocatable :: coefficient(:), exponent(:)
      !> Rounded edges: half-widths b of the flats and radii R, lengths.
      real(wp), allocatable :: flat(:), radius(:)
   contains
      procedure :: add
      procedure :: is_flat
      procedure :: is_pointed
      procedure :: force
      procedure :: half_width
      procedure :: half_width_at_approach
      procedure :: approach
      procedure :: pressure
   end type indenter_type

   integer, parameter :: quadrature_points = 128

contains

   !> A zero gap.
   pure type(indenter_type) function flat_indenter() result(indenter)

      allocate (indenter%coefficient(0), indenter%exponent(0), indenter%flat(0), indenter%radius(0))
   end function flat_indenter

   !> The gap C |x|^n (C: length^(1 - n)).
   pure type(indenter_type) function power_indenter(coefficient, exponent) result(indenter)
      real(wp), intent(in) :: coefficient, exponent

      indenter%coefficient = [coefficient]
      indenter%exponent = [exponent]
      allocate (indenter%flat(0), indenter%radius(0))
   end function power_indenter

   !> The gap of a punch that is flat over |x| < half_width, with edges of a radius, lengths.
   pure type(indenter_type) function rounded_punch_indenter(half_width, radius) result(indenter)
      real(wp), intent(in) :: half_width, radius

      indenter%flat = [half_width]
      indenter%radius = [radius]
      allocate (indenter%coefficient(0), indenter%exponent(0))
   end function rounded_punch_indenter

   !> Add the gap of another pair.
   pure subroutine add(self, other)
      class(indenter_type), intent(inout) :: self
      type(indenter_type), intent(in) :: other

      self%coefficient = [self%coefficient, other%coefficient]
      self%exponent = [self%exponent, other%exponent]
      self%flat = [self%flat, other%flat]
      self%radius = [self%radius, other%radius]
   end subroutine add

   !> Whether the gap is zero everywhere.
   pure logical function is_flat(self)
      class(indenter_type), intent(in) :: self

      is_flat = size(self%coefficient) == 0 .and. size(self%flat) == 0
   end function is_flat

   !> Whether there is a sharp tip, where the pressure has a logarithmic singularity.
   pure logical function is_pointed(self)
      class(indenter_type), intent(in) :: self

      is_pointed = any(self%exponent <= 1.0_wp)
   end function is_pointed

   !> Force over 2 m, length, at a contact half-width a (length). Of C |x|^n: C n B a^n with B = integral of t^n/sqrt(1 - t^2)
   !> from 0 to 1; of a rounded punch: a^2 (2 psi - sin 2 psi)/(4 R) with cos psi = b/a (Ciavarella, Hills and Monno 1998).
   pure real(wp) function force(self, a)
      class(indenter_type), intent(in) :: self
      real(wp), intent(in) :: a
      integer :: i

      force = 0.0_wp
      do i = 1, size(self%coefficient)
         force = force + self%coefficient(i)*self%exponent(i)*wallis(self%exponent(i))*a**self%exponent(i)
      end do
      do i = 1, size(self%flat)
         force = force + a**2*less_sine(2.0_wp*opening(self%flat(i), a))/(4.0_wp*self%radius(i))
      end do
   end function force

   !> Derivative of `force` with respect to a, dimensionless.
   pure real(wp) function slope(self, a)
      class(indenter_type), intent(in) :: self
      real(wp), intent(in) :: a
      integer :: i

      slope = 0.0_wp
      do i = 1, size(self%coefficient)
         slope = slope + self%coefficient(i)*self%exponent(i)**2*wallis(self%exponent(i))*a**(self%exponent(i) - 1.0_wp)
      end do
      do i = 1, size(self%flat)
         slope = slope + a*opening(self%flat(i), a)/self%radius(i)
      end do
   end function slope

   !> Contact half-width, length, at a force over 2 m (length). The force is convex in the half-width: Newton's iteration
   !> converges monotonically from the half-width at which one term alone has the whole force.
   pure real(wp) function half_width(self, force) result(a)
      class(indenter_type), intent(in) :: self
      real(wp), intent(in) :: force
      integer, parameter :: most_iterations = 200
      real(wp) :: next
      integer :: i

      a = smallest(self)
      if (.not. force > 0.0_wp .or. self%is_flat()) return
      a = huge(1.0_wp)
      do i = 1, size(self%coefficient)
         a = min(a, (force/(self%coefficient(i)*self%exponent(i)*wallis(self%exponent(i))))**(1.0_wp/self%exponent(i)))
      end do
      if (size(self%coefficient) == 1 .and. size(self%flat) == 0) return
      do i = 1, size(self%flat)
         a = min(a, self%flat(i) + 2.0_wp*sqrt(force*self%radius(i)))
      end do
      do i = 1, most_iterations
         if (.not. slope(self, a) > 0.0_wp) exit
         next = a - (self%force(a) - force)/slope(self, a)
         if (.not. next < a) exit
         a = next
      end do
   end function half_width

   !> Half-width, length, at first contact: that of the flat.
   pure real(wp) function smallest(self)
      class(indenter_type), intent(in) :: self

      smallest = 0.0_wp
      if (size(self%coefficient) == 0 .and. size(self%flat) > 0) smallest = minval(self%flat)
   end function smallest

   !> Approach, length, at the half-width a, measured from the surface point at the distance D (`datum`):
   !> 2/pi [F ln(2 D/a) + integral of F(s)/s from 0 to a].
   pure real(wp) function approach(self, a, datum)
      class(indenter_type), intent(in) :: self
      real(wp), intent(in) :: a, datum
      real(wp) :: inner, psi
      integer :: i

      approach = 0.0_wp
      if (.not. a > 0.0_wp) return
      inner = 0.0_wp
      do i = 1, size(self%coefficient)
         inner = inner + self%coefficient(i)*wallis(self%exponent(i))*a**self%exponent(i)
      end do
      do i = 1, size(self%flat)
         psi = opening(self%flat(i), a)
         inner = inner + ((0.5_wp*a**2 + self%flat(i)**2)*psi - 0.75_wp*a**2*sin(2.0_wp*psi))/(2.0_wp*self%radius(i))
      end do
      approach = 2.0_wp/pi*(self%force(a)*log(2.0_wp*datum/a) + inner)
   end function approach

   !> Contact half-width, length, at an approach (length), by bisection; at most `largest` (length; not above the datum).
   pure real(wp) function half_width_at_approach(self, approach, datum, largest) result(a)
      class(indenter_type), intent(in) :: self
      real(wp), intent(in) :: approach, datum, largest
      real(wp) :: lower, upper

      lower = smallest(self)
      upper = max(lower, min(datum, largest))
      a = lower
      if (.not. approach > 0.0_wp) return
      do
         a = 0.5_wp*(lower + upper)
         if (.not. (a > lower .and. a < upper)) exit
         if (self%approach(a, datum) < approach) then
            lower = a
         else
            upper = a
         end if
      end do
   end function half_width_at_approach

   !> Pressure over 2 m at x (length) for a contact half-width a (length), dimensionless; zero outside, large at a sharp tip.
   function pressure(self, x, a)
      class(indenter_type), intent(in) :: self
      real(wp), intent(in) :: x(:), a
      real(wp) :: pressure(size(x))
      real(wp), parameter :: nearest = 1.0e-150_wp
      real(wp) :: distance
      integer :: i, j

      pressure = 0.0_wp
      do i = 1, size(x)
         if (.not. abs(x(i)) < a) cycle
         distance = max(abs(x(i)), nearest*a)
         do j = 1, size(self%coefficient)
            pressure(i) = pressure(i) + self%coefficient(j)*self%exponent(j)**2*wallis(self%exponent(j))/pi &
                          *punches(distance, a, self%exponent(j))
         end do
         do j = 1, size(self%flat)
            pressure(i) = pressure(i) + a/(2.0_wp*pi*self%radius(j))*rounded(distance/a, opening(self%flat(j), a))
         end do
      end do
   end function pressure

   !> Integral of t^n/sqrt(1 - t^2) from 0 to 1.
   elemental real(wp) function wallis(n)
      real(wp), intent(in) :: n

      wallis = 0.5_wp*sqrt(pi)*exp(log_gamma(0.5_wp*(n + 1.0_wp)) - log_gamma(0.5_wp*n + 1.0_wp))
   end function wallis

   !> arccos(b/a), without cancellation; 0 for a <= b.
   elemental real(wp) function opening(b, a)
      real(wp), intent(in) :: b, a

      opening = 0.0_wp
      if (a > b) opening = atan2(sqrt((a - b)*(a + b)), b)
   end function opening

   !> y - sin(y), by its series where it cancels.
   elemental real(wp) function less_sine(y)
      real(wp), intent(in) :: y
      real(wp), parameter :: small = 0.5_wp
      integer, parameter :: terms = 7
      integer :: k

      less_sine = y - sin(y)
      if (abs(y) > small) return
      less_sine = 0.0_wp
      do k = terms, 1, -1
         less_sine = (1.0_wp - less_sine)*y**2/((2*k)*(2*k + 1.0_wp))
      end do
      less_sine = less_sine*y
   end function less_sine

   !> Integral of s^(n-1)/sqrt(s^2 - x^2) from x > 0 to a: by parts down to n = 1 or 2, else by quadrature in v, s = x cosh(v).
   real(wp) function punches(x, a, n)
      real(wp), intent(in) :: x, a, n
      real(wp) :: root, first
      integer :: k

      root = sqrt((a - x)*(a + x))
      first = 2.0_wp*asinh(sqrt(0.5_wp*(a - x)/x))
      if (abs(n - anint(n)) > 0.0_wp) then
         punches = gauss_legendre(power_of_cosh, [x, n - 1.0_wp], 0.0_wp, first, quadrature_points)
         return
      end if
      punches = merge(first, root, modulo(nint(n), 2) == 1)
      do k = merge(3, 4, modulo(nint(n), 2) == 1), nint(n), 2
         punches = (a**(k - 2)*root + (k - 2)*x**2*punches)/(k - 1)
      end do
   end function punches

   !> (x cosh(v))^power; parameters: x, power.
   pure real(wp) function power_of_cosh(x, parameters) result(value)
      real(wp), intent(in) :: x, parameters(:)

      value = (parameters(1)*cosh(x))**parameters(2)
   end function power_of_cosh

   !> Pressure of a rounded punch over a/(2 pi R) 2 m at |x|/a = sin(phi), with cos(psi) = b/a (Ciavarella, Hills and Monno 1998;
   !> phi0 = pi/2 - psi): 2 psi cos(phi) + ln{|sin(phi + phi0)/sin(phi - phi0)|^sin(phi)
   !> |tan((phi + phi0)/2) tan((phi - phi0)/2)|^sin(phi0)}, with the logarithms at phi = phi0 taken together.
   elemental real(wp) function rounded(ratio, psi)
      real(wp), intent(in) :: ratio, psi
      real(wp) :: phi, phi0, apart

      phi = asin(ratio)
      phi0 = 0.5_wp*pi - psi
      apart = abs(phi - phi0)
      rounded = 2.0_wp*psi*cos(phi) - 2.0_wp*sin(phi0)*log(2.0_wp*cos(0.5_wp*(phi + phi0))*cos(0.5_wp*apart))
      if (phi + phi0 > 0.0_wp) rounded = rounded + (sin(phi) + sin(phi0))*log(sin(phi + phi0))
      if (apart > 0.0_wp) rounded = rounded - (sin(phi) - sin(phi0))*log(sin(apart))
   end function rounded

end module mfv_reference_indenter
