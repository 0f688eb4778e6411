!> Stresses inside a solid disk, or around a hole in an infinite plane, under tractions that are linear on elements of the
!> circle, in closed form.
!>
!> Kolosov's potentials on the unit circle (Muskhelishvili 1953, chapters 14 and 15): with the Cauchy integrals
!>
!>     I+(z) = 1/(2 pi i) int (sigma_rr + i sigma_rtheta)/(s - z) ds,   I-(z) the same with - i,
!>
!> disk and hole have
!>
!> disk: Phi = J+ - i M/(2 pi) - N/2 - F/(2 pi (1+kappa) z),  z^2 Psi = J+ - J- - i M/(2 pi) - z J+' + kappa F* z/(2 pi
!> (1+kappa))
!>           J+ = I+ + F* z/(pi (1+kappa)),  J- = I- + F* z/(2 pi)
!>     hole: Phi = -I+ + kappa F/(2 pi (1+kappa) z),  z^2 Psi = I- + Phi - z Phi' + kappa F* z/(2 pi (1+kappa)) - N + i T
!>
!> with F the force that the disk's centre, or the tractions in the hole, exert on the body, M the integral and N, T the means
!> of sigma_rr and sigma_rtheta: the singular terms of dissertation eqs. 4.9 and 4.13 together. Sums of the series of C.2.1
!> and D.2.1, whose n = 0 terms are misprinted (docs/theory.md).
!>
!> The traction of an element is linear in u = sin(theta - middle)/sin(half its angle), the coordinate on its chord; u is a
!> sum of s and 1/s on the circle, so that the integrals are elementary. For elements that are short compared with their
!> distance, power series in their length avoid cancellation; groups of distant elements act together (mfv_element_tree).
!>
!> Points are relative to z = 1 (theta = 0), not to the centre, to avoid cancellation close to the contact; Phi' occurs only
!> times |z|^2 - 1, which vanishes on the surface.
module mfv_interior_circle
   use mfv_element_tree, only: element_tree_type, last_not_above, new_element_tree
   use mfv_kinds, only: pi, wp
   use mfv_logarithms, only: log_ratio
   use mfv_quadrature, only: gauss_points
   use mfv_tolerances, only: visible
   implicit none
   private
   public :: circle_load_type, new_circle_load, longest_element

   !> Longest element, radians, without loss of digits anywhere.
   real(wp), parameter :: longest_element = 0.1_wp
   !> Terms of the power series, enough for the kind of real numbers.
   integer, parameter :: terms = int(0.25_wp*digits(1.0_wp)) + 2
   !> Quadrature points of an element for its moments, exact for the highest moment that matters.
   integer, parameter :: most_points = ceiling(0.25_wp*digits(1.0_wp))

   !> One element: its ends, radians; its ends and its middle relative to theta = 0; direction of the middle; sine of half its
   !> angle, and the chord of that; sigma_rr + i sigma_rtheta in the middle, and half of its change.
   type :: element_type
      complex(wp) :: first, last, middle, turn, mean, tilt
      real(wp) :: from, to, half, sine, chord
   end type element_type

   !> A disk or hole of radius 1 under tractions.
   type :: circle_load_type
      private
      logical :: disk = .true.
      real(wp) :: kappa = 1.0_wp
      type(element_type), allocatable :: elements(:)
      !> Where they begin, radians.
      real(wp), allocatable :: from(:)
      type(element_tree_type) :: tree
      !> Resultant F, and means N + i T of sigma_rr + i sigma_rtheta.
      complex(wp) :: force = 0.0_wp, mean = 0.0_wp
      !> The whole circle, radians, as the ends of the elements have it.
      real(wp) :: around = 0.0_wp
   contains
      procedure :: stress
      procedure :: surface_stress
      procedure :: traction
   end type circle_load_type

contains

   !> `disk`: disk or hole. `kappa`: Kolosov's constant. `from`, `to`: ends of the elements, radians, at most `longest_element`
   !> apart; `first`, `last`: sigma_rr + i sigma_rtheta there, force/length^2; shapes (elements).
   pure type(circle_load_type) function new_circle_load(disk, kappa, from, to, first, last) result(self)
      logical, intent(in) :: disk
      real(wp), intent(in) :: kappa, from(:), to(:)
      complex(wp), intent(in) :: first(:), last(:)
      complex(wp), parameter :: i = (0.0_wp, 1.0_wp)
      integer :: j

      self%disk = disk
      self%kappa = kappa
      allocate (self%elements(size(from)))
      do j = 1, size(from)
         associate (e => self%elements(j), middle => 0.5_wp*(from(j) + to(j)))
            e%from = from(j)
            e%to = to(j)
            e%first = from_origin_to(from(j))
            e%last = from_origin_to(to(j))
            e%middle = from_origin_to(middle)
            e%turn = cmplx(cos(middle), sin(middle), wp)
            e%half = 0.5_wp*(to(j) - from(j))
            e%sine = sin(e%half)
            e%chord = 2.0_wp*sin(0.5_wp*e%half)
            e%mean = 0.5_wp*(first(j) + last(j))
            e%tilt = 0.5_wp*(last(j) - first(j))
            self%force = self%force + i*(e%mean*(e%last - e%first) - e%tilt*e%turn*sum_of_squares(e%chord)/e%sine)
            self%mean = self%mean + e%mean*e%half/pi
         end associate
      end do
      self%from = from
      self%around = 2.0_wp*pi
      if (size(to) > 0) then
         if (abs(to(size(to)) - from(1) - self%around) < visible) self%around = to(size(to)) - from(1)
      end if
      self%tree = tree_of(self%elements)
   end function new_circle_load

   !> The elements in groups. sigma_rr + i sigma_rtheta is linear in u, see above.
   pure type(element_tree_type) function tree_of(elements) result(tree)
      type(element_type), intent(in) :: elements(:)
      complex(wp), dimension(most_points, size(elements)) :: place, sigma, weight
      complex(wp), parameter :: i = (0.0_wp, 1.0_wp)
      real(wp) :: point(most_points), weights(most_points)
      integer :: j, k

      call gauss_points(-1.0_wp, 1.0_wp, point, weights)
      do j = 1, size(elements)
         associate (e => elements(j), middle => 0.5_wp*(elements(j)%from + elements(j)%to))
            place(:, j) = [(from_origin_to(middle + e%half*point(k)), k=1, most_points)]
            sigma(:, j) = e%mean + e%tilt*sin(e%half*point)/e%sine
            weight(:, j) = i*(1.0_wp + place(:, j))*e%half*weights
         end associate
      end do
      tree = new_element_tree(transpose(reshape([elements%first, elements%last], [size(elements), 2])), place, sigma, weight)
   end function tree_of

   !> Integral of sin^2 phi from -half to half, from the chord of half.
   pure real(wp) function sum_of_squares(chord)
      real(wp), intent(in) :: chord
      real(wp) :: root, power
      integer :: k

      root = 1.0_wp
      power = 2.0_wp*chord**3
      sum_of_squares = 0.0_wp
      do k = 0, terms
         sum_of_squares = sum_of_squares + root*power/(2*k + 3)
         root = next_of_root(root, k)
         power = power*chord**2
      end do
   end function sum_of_squares

   !> Coefficient k + 1 of the power series of sqrt(1 - v^2/4) in v^2 from coefficient k.
   pure real(wp) function next_of_root(root, k)
      real(wp), intent(in) :: root
      integer, intent(in) :: k

      next_of_root = -0.25_wp*root*(0.5_wp - k)/(k + 1)
   end function next_of_root

   !> Stresses (sigma_XX, sigma_YY, sigma_XY), force/length^2, at the point `from_origin` = (X, Y), relative to theta = 0 and in
   !> radii, X in the outward direction. The point must be on or inside the disk, on or outside the hole; the centre of a disk
   !> is singular. At jumps of the tractions the singular term of the tangential stress is omitted.
   pure function stress(self, from_origin)
      class(circle_load_type), intent(in) :: self
      real(wp), intent(in) :: from_origin(2)
      real(wp) :: stress(3)
      complex(wp), parameter :: i = (0.0_wp, 1.0_wp)
      real(wp), parameter :: tolerance = 8.0_wp*epsilon(1.0_wp)
      complex(wp) :: zeta, z, plus, minus, slope, integral(2), derivative(2), potential, potential_slope, rest, force, distant(4)
      real(wp) :: beyond, kelvin
      integer :: near(2, self%tree%leaves()), number, j, k

      zeta = cmplx(from_origin(1), from_origin(2), wp)
      z = 1.0_wp + zeta
      beyond = 2.0_wp*real(zeta, wp) + abs(zeta)**2
      if (abs(beyond) <= tolerance*(2.0_wp*abs(real(zeta, wp)) + abs(zeta)**2)) beyond = 0.0_wp
      call self%tree%find_distant([zeta, zeta], distant, near, number)
      plus = distant(1)
      minus = distant(1) - 2.0_wp*i*distant(3)
      slope = distant(2)
      do k = 1, number
         do j = near(1, k), near(2, k)
            call element_integrals(self%elements(j), self%disk, zeta, integral, derivative)
            associate (e => self%elements(j))
               plus = plus + e%mean*integral(1) + e%tilt*integral(2)
               minus = minus + conjg(e%mean)*integral(1) + conjg(e%tilt)*integral(2)
               slope = slope + e%mean*derivative(1) + e%tilt*derivative(2)
            end associate
         end do
      end do
      plus = plus/(2.0_wp*pi*i)
      minus = minus/(2.0_wp*pi*i)
      slope = slope/(2.0_wp*pi*i)
      force = self%force
      kelvin = 1.0_wp/(2.0_wp*pi*(1.0_wp + self%kappa))
      if (self%disk) then
         plus = plus + 2.0_wp*kelvin*conjg(force)*z
         slope = slope + 2.0_wp*kelvin*conjg(force)
         minus = minus + conjg(force)*z/(2.0_wp*pi)
         potential = plus - i*aimag(self%mean) - 0.5_wp*real(self%mean, wp) - kelvin*force/z
         rest = beyond/z*slope + (plus - minus - i*aimag(self%mean))/z**2 &
                + conjg(z)*kelvin*force/z**2 + self%kappa*kelvin*conjg(force)/z
      else
         potential = -plus + self%kappa*kelvin*force/z
         potential_slope = -slope - self%kappa*kelvin*force/z**2
         rest = beyond/z*potential_slope &
                + (minus + potential + self%kappa*kelvin*conjg(force)*z - conjg(self%mean))/z**2
      end if
      stress(1) = 2.0_wp*real(potential, wp) - real(rest, wp)
      stress(2) = 2.0_wp*real(potential, wp) + real(rest, wp)
      stress(3) = aimag(rest)
   end function stress

   !> Tangential stress at an angle from theta = 0, radians, equal to that of `stress`. On the circle the integrals are real
   !> except for the traction itself, and only those of the shear remain: disk: 2/pi S + sigma_rr + 2 Re(F/z)/(pi (1+kappa)),
   !> hole: -2/pi S + sigma_rr - 2 N + 2 kappa Re(F/z)/(pi (1+kappa)).
   pure real(wp) function surface_stress(self, angle) result(stress)
      class(circle_load_type), intent(in) :: self
      real(wp), intent(in) :: angle
      real(wp) :: from, to, growth, sum, radial, kelvin, part
      complex(wp) :: distant(4)
      integer :: near(2, self%tree%leaves()), number, j, k

      call self%tree%find_distant(spread(from_origin_to(angle), 1, 2), distant, near, number)
      sum = real(distant(3), wp)
      radial = 0.0_wp
      do k = 1, number
         do j = near(1, k), near(2, k)
            associate (e => self%elements(j))
               from = 2.0_wp*sin(0.5_wp*nearest(e%from - angle))
               to = 2.0_wp*sin(0.5_wp*nearest(e%to - angle))
               ! At an end the logarithm cancels with that of the next element.
               growth = 0.0_wp
               if (abs(from) > 0.0_wp) growth = -log(abs(from))
               if (abs(to) > 0.0_wp) growth = growth + log(abs(to))
               sum = sum + aimag(e%mean)*growth + aimag(e%tilt)*tilted_part(e, angle, growth)
               if (angle >= e%from .and. angle <= e%to) then
                  part = sin(angle - 0.5_wp*(e%from + e%to))/e%sine
                  radial = min(radial, real(e%mean, wp) + part*real(e%tilt, wp))
               end if
            end associate
         end do
      end do
      kelvin = 2.0_wp/(pi*(1.0_wp + self%kappa))*real(self%force*cmplx(cos(angle), -sin(angle), wp), wp)
      if (self%disk) then
         stress = 2.0_wp/pi*sum + radial + kelvin
      else
         stress = -2.0_wp/pi*sum + radial - 2.0_wp*real(self%mean, wp) + self%kappa*kelvin
      end if

   contains

      !> The same angle within half the circle. Elements all around it end where they begin, without a difference by round-off.
      pure real(wp) function nearest(away)
         real(wp), intent(in) :: away

         nearest = away
         if (abs(away) > pi) nearest = away - sign(self%around, away)
      end function nearest
   end function surface_stress

   !> sigma_rr + i sigma_rtheta at an angle from theta = 0, radians; 0 outside all elements.
   pure complex(wp) function traction(self, angle)
      class(circle_load_type), intent(in) :: self
      real(wp), intent(in) :: angle
      integer :: j

      traction = 0.0_wp
      j = last_not_above(self%from, angle)
      if (j == 0) return
      associate (e => self%elements(j))
         if (angle > e%to .or. .not. e%half > 0.0_wp) return
         traction = e%mean + e%tilt*(sin(angle - 0.5_wp*(e%from + e%to))/e%sine)
      end associate
   end function traction

   !> The real part of the integral of u/(s - z) ds over an element at an angle on the circle, from that of 1/(s - z).
   pure real(wp) function tilted_part(element, angle, growth) result(tilted)
      type(element_type), intent(in) :: element
      real(wp), intent(in) :: angle, growth
      real(wp) :: away, square, term, root, power
      integer :: k

      away = angle - 0.5_wp*(element%from + element%to)
      square = 4.0_wp*sin(0.5_wp*away)**2
      if (0.04_wp*square > element%chord**2) then
         root = 1.0_wp
         term = 0.0_wp
         power = -2.0_wp*element%chord**3/element%sine
         tilted = 0.0_wp
         do k = 0, terms
            term = root*power/square + term*(element%chord**2/square)
            tilted = tilted + term/(2*k + 3)
            if (abs(term) <= 0.1_wp*epsilon(1.0_wp)*abs(tilted)) exit
            root = next_of_root(root, k)
            power = power*element%chord**2
         end do
      else
         tilted = (sin(away)*growth + element%half*cos(away))/element%sine + 1.0_wp
      end if
   end function tilted_part

   !> Integrals over an element of 1/(s - z) and u/(s - z) ds, and their derivatives with respect to z (not at its ends, where
   !> they are multiplied by zero). `zeta`: the point relative to theta = 0; the logarithm is continuous on the body's side.
   pure subroutine element_integrals(element, disk, zeta, integral, derivative)
      type(element_type), intent(in) :: element
      logical, intent(in) :: disk
      complex(wp), intent(in) :: zeta
      complex(wp), intent(out) :: integral(2), derivative(2)
      real(wp), parameter :: short = 0.04_wp
      complex(wp), parameter :: i = (0.0_wp, 1.0_wp)
      complex(wp) :: first, last, nearer, step, place, away, along
      real(wp) :: turn

      first = element%first - zeta
      last = element%last - zeta
      step = element%last - element%first
      nearer = merge(first, last, square_of(first) < square_of(last))
      turn = atan2(aimag(conjg(nearer)*step), real(conjg(first)*last, wp))
      ! By round-off, points of the surface can lie on the other side of the chord.
      if (disk .and. turn < -0.5_wp*pi) turn = turn + 2.0_wp*pi
      if (.not. disk .and. turn > 0.5_wp*pi) turn = turn - 2.0_wp*pi
      derivative = 0.0_wp
      if (min(square_of(first), square_of(last)) > (epsilon(1.0_wp)*(2.0_wp*element%sine + 8.0_wp*sqrt(square_of(zeta))))**2) then
         integral(1) = cmplx(0.5_wp*log_ratio(square_of(first), square_of(last), real(step*conjg(first + last), wp)), turn, wp)
         derivative(1) = step/(first*last)
      else
         ! At an end on the surface the singular logarithm cancels with that of the next element.
         turn = merge(0.5_wp*pi + element%half, element%half - 0.5_wp*pi, disk)
         integral(1) = cmplx(merge(1.0_wp, -1.0_wp, abs(first) < abs(last))*log(abs(step)), turn, wp)
      end if
      ! The point relative to the middle of the element, in units in which the middle is 1; and its distance from it.
      place = (1.0_wp + zeta)*conjg(element%turn)
      away = (element%middle - zeta)*conjg(element%turn)
      if (element%chord**2*sqrt(max(1.0_wp, square_of(place))) < short*square_of(away)) then
         call distant_integrals(element, place, away, integral(2), derivative(2))
         return
      end if
      along = 0.5_wp*i*away*(1.0_wp + place)/(place*element%sine)
      integral(2) = along*integral(1) + 1.0_wp + element%half/(element%sine*place)
      derivative(2) = along*derivative(1) - conjg(element%turn)/(place**2*element%sine) &
                      *(0.5_wp*i*(1.0_wp + place**2)*integral(1) + element%half)
   end subroutine element_integrals

   !> Integral of u/(s - z) ds and its derivative for an element that is short compared with its distance: with v = 2
   !> sin(phi/2) those of v^2 sqrt(1 - v^2/4) over away^2 + place v^2, and over the square of that.
   pure subroutine distant_integrals(element, place, away, integral, derivative)
      type(element_type), intent(in) :: element
      complex(wp), intent(in) :: place, away
      complex(wp), intent(out) :: integral, derivative
      complex(wp) :: inverse, ratio, once, twice
      real(wp) :: root, power
      integer :: k

      inverse = 1.0_wp/away**2
      ratio = place*(element%chord/away)**2
      root = 1.0_wp
      power = 2.0_wp*element%chord**3/element%sine
      once = 0.0_wp
      twice = 0.0_wp
      integral = 0.0_wp
      derivative = 0.0_wp
      do k = 0, terms
         once = inverse*root*power - ratio*once
         twice = inverse*once - ratio*twice
         integral = integral + once/(2*k + 3)
         derivative = derivative + twice/(2*k + 3)
         if (square_of(twice) < (0.1_wp*epsilon(1.0_wp))**2*square_of(derivative)) exit
         root = next_of_root(root, k)
         power = power*element%chord**2
      end do
      integral = place*integral
      derivative = conjg(element%turn)*away*(1.0_wp + place)*derivative
   end subroutine distant_integrals

   !> |z|^2; abs takes many times as long.
   pure real(wp) function square_of(z)
      complex(wp), intent(in) :: z

      square_of = real(z, wp)**2 + aimag(z)**2
   end function square_of

   !> exp(i theta) - 1.
   pure complex(wp) function from_origin_to(theta)
      real(wp), intent(in) :: theta

      from_origin_to = 2.0_wp*sin(0.5_wp*theta)*cmplx(-sin(0.5_wp*theta), cos(0.5_wp*theta), wp)
   end function from_origin_to

end module mfv_interior_circle
