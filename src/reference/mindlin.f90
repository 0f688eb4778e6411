!> Closed form: a cylinder pressed without shear and then sheared at constant normal force, elastically decoupled (Cattaneo
!> 1938, Mindlin 1949; dissertation eqs. 3.7, 3.8), for any history of the tangential force: between turning points the
!> traction changes by twice the first-loading traction of half the change (Mindlin and Deresiewicz 1953).
!>
!> On half-planes the same holds for every shape: the shear traction of first loading is mu times the pressure, minus mu times
!> the pressure at the smaller normal force P - |Q|/mu, whose contact is the stick zone (Jaeger 1998, Ciavarella 1998).
module mfv_reference_mindlin
   use mfv_kinds, only: pi, wp
   use mfv_numerics, only: gauss_legendre
   use mfv_reference_hertz, only: hertz_pressure
   use mfv_reference_indenter, only: indenter_type, power_indenter
   implicit none
   private
   public :: mindlin_stick_ratio, mindlin_slip, mindlin_dissipation, mindlin_history_type, new_mindlin_history

   !> A contact of a cylinder (radius: length) or of any indenter.
   interface new_mindlin_history
      module procedure new_history_of_cylinder, new_history_of_indenter
   end interface new_mindlin_history

   !> A sheared contact with its load history.
   type :: mindlin_history_type
      type(indenter_type) :: indenter
      !> Normal force (force/length), contact half-width, datum (lengths), coefficient of friction.
      real(wp) :: normal_force, half_width, datum, friction_coefficient
      !> Turning points of the tangential force outside closed loops, and the present force as the last one, force/length.
      real(wp), allocatable :: turning(:)
   contains
      procedure :: load
      procedure :: stick_half_width
      procedure :: shear
      procedure :: shift
   end type mindlin_history_type

   integer, parameter :: quadrature_points = 200

contains

   !> Stick ratio b/a = sqrt(1 - |Q|/(mu P)) on first loading; 0 in gross sliding. Equation 3.7.
   elemental real(wp) function mindlin_stick_ratio(tangential_force, normal_force, friction_coefficient) result(ratio)
      real(wp), intent(in) :: tangential_force, normal_force, friction_coefficient

      ratio = sqrt(max(1.0_wp - abs(tangential_force)/(friction_coefficient*normal_force), 0.0_wp))
   end function mindlin_stick_ratio

   !> A cylinder in contact, before shear. Arguments as the components of the type; radius: length.
   pure function new_history_of_cylinder(normal_force, half_width, radius, datum, friction_coefficient) result(history)
      real(wp), intent(in) :: normal_force, half_width, radius, datum, friction_coefficient
      type(mindlin_history_type) :: history

      history = new_history_of_indenter(normal_force, half_width, power_indenter(0.5_wp/radius, 2.0_wp), datum, &
                                        friction_coefficient)
   end function new_history_of_cylinder

   !> An indenter in contact, before shear. Arguments as the components of the type.
   pure function new_history_of_indenter(normal_force, half_width, indenter, datum, friction_coefficient) result(history)
      real(wp), intent(in) :: normal_force, half_width, datum, friction_coefficient
      type(indenter_type), intent(in) :: indenter
      type(mindlin_history_type) :: history

      history = mindlin_history_type(indenter, normal_force, half_width, datum, friction_coefficient, [real(wp) ::])
   end function new_history_of_indenter

   !> Change the tangential force (force/length) monotonically to `tangential_force`. Closed loops are removed.
   pure subroutine load(self, tangential_force)
      class(mindlin_history_type), intent(inout) :: self
      real(wp), intent(in) :: tangential_force
      integer :: n

      self%turning = [self%turning, tangential_force]
      do
         n = size(self%turning)
         if (n < 2) return
         if (abs(self%turning(n)) >= abs(self%turning(1))) then
            self%turning = [tangential_force]
         else if (n >= 3) then
            associate (t => self%turning)
               if ((t(n) - t(n - 1))*(t(n - 1) - t(n - 2)) >= 0.0_wp) then
                  self%turning = [t(:n - 2), t(n)]
               else if (abs(t(n) - t(n - 1)) >= abs(t(n - 1) - t(n - 2))) then
                  self%turning = [t(:n - 3), t(n)]
               else
                  return
               end if
            end associate
         else
            return
         end if
      end do
   end subroutine load

   !> Half-width of the stick zone on first loading to a tangential force (force/length), length: that of the contact at the normal
   !> force P - |Q|/mu.
   pure real(wp) function stick_half_width(self, tangential_force)
      class(mindlin_history_type), intent(in) :: self
      real(wp), intent(in) :: tangential_force
      real(wp) :: fraction

      fraction = max(1.0_wp - abs(tangential_force)/(self%friction_coefficient*self%normal_force), 0.0_wp)
      stick_half_width = 0.0_wp
      if (fraction > 0.0_wp) stick_half_width = min(self%indenter%half_width(fraction*self%indenter%force(self%half_width)), &
                                                    self%half_width)
   end function stick_half_width

   !> Shear traction at x (length), force/length^2. Equation 3.8 (whose second line misprints sqrt(1 - x^2/b^2)) on first
   !> loading of a cylinder.
   function shear(self, x)
      class(mindlin_history_type), intent(in) :: self
      real(wp), intent(in) :: x(:)
      real(wp) :: shear(size(x))
      integer :: i

      shear = 0.0_wp
      if (size(self%turning) == 0) return
      shear = first_shear(self, x, self%turning(1))
      do i = 2, size(self%turning)
         shear = shear + 2.0_wp*first_shear(self, x, 0.5_wp*(self%turning(i) - self%turning(i - 1)))
      end do
   end function shear

   function first_shear(self, x, tangential_force) result(shear)
      class(mindlin_history_type), intent(in) :: self
      real(wp), intent(in) :: x(:), tangential_force
      real(wp) :: shear(size(x))

      shear = self%indenter%pressure(x, self%half_width) &
              - self%indenter%pressure(x, self%stick_half_width(tangential_force))
      shear = sign(self%friction_coefficient, tangential_force)*self%normal_force/self%indenter%force(self%half_width)*shear
   end function first_shear

   !> Shift of the upper body, length: mu times the difference of the approaches of two contacts, of half-widths a and b
   !> (Jaeger 1998, Ciavarella 1998).
   pure real(wp) function shift(self)
      class(mindlin_history_type), intent(in) :: self
      integer :: i

      shift = 0.0_wp
      if (size(self%turning) == 0) return
      shift = first_shift(self, self%turning(1))
      do i = 2, size(self%turning)
         shift = shift + 2.0_wp*first_shift(self, 0.5_wp*(self%turning(i) - self%turning(i - 1)))
      end do
   end function shift

   pure real(wp) function first_shift(self, tangential_force) result(shift)
      class(mindlin_history_type), intent(in) :: self
      real(wp), intent(in) :: tangential_force

      shift = sign(self%friction_coefficient, tangential_force) &
              *(self%indenter%approach(self%half_width, self%datum) &
                - self%indenter%approach(self%stick_half_width(tangential_force), self%datum))
   end function first_shift

   !> Magnitude of the slip on first loading at the distance x from the centre (length), for the stick half-width b (length):
   !> mu b^2/(2R) [xi sqrt(xi^2 - 1) - arcosh xi], xi = x/b, length.
   pure real(wp) function mindlin_slip(x, stick_half_width, radius, friction_coefficient) result(slip)
      real(wp), intent(in) :: x, stick_half_width, radius, friction_coefficient
      real(wp), parameter :: near = 0.3_wp
      real(wp) :: v

      if (.not. stick_half_width > 0.0_wp) then
         slip = 0.5_wp*friction_coefficient*x**2/radius
         return
      end if
      slip = 0.0_wp
      if (abs(x) <= stick_half_width) return
      ! arcosh(|x|/b) without cancellation.
      v = 2.0_wp*asinh(sqrt(0.5_wp*(abs(x)/stick_half_width - 1.0_wp)))
      if (v < near) then
         slip = sinh_less_argument(2.0_wp*v)/2.0_wp
      else
         slip = 0.5_wp*sinh(2.0_wp*v) - v
      end if
      slip = 0.5_wp*friction_coefficient*stick_half_width**2/radius*slip
   end function mindlin_slip

   !> sinh(y) - y by its series, for small y.
   pure real(wp) function sinh_less_argument(y) result(total)
      real(wp), intent(in) :: y
      integer, parameter :: terms = 9
      integer :: k

      total = 0.0_wp
      do k = terms, 1, -1
         total = (total + 1.0_wp)*y**2/((2*k)*(2*k + 1.0_wp))
      end do
      total = total*y
   end function sinh_less_argument

   !> Energy dissipated in one full cycle of the tangential force between -Q and Q at constant normal force, force (energy per
   !> unit thickness): 4 times the integral of mu p s over the slip zones (dissertation eq. 6.4, with a misprinted integrand;
   !> Fleury et al. 2017).
   function mindlin_dissipation(tangential_force, normal_force, half_width, radius, friction_coefficient) result(dissipation)
      real(wp), intent(in) :: tangential_force, normal_force, half_width, radius, friction_coefficient
      real(wp) :: dissipation
      real(wp) :: b

      b = half_width*mindlin_stick_ratio(tangential_force, normal_force, friction_coefficient)
      dissipation = 8.0_wp*gauss_legendre(friction_work, [normal_force, half_width, b, radius, friction_coefficient], &
                                          0.0_wp, 0.5_wp*pi, quadrature_points)
   end function mindlin_dissipation

   !> mu p s dx/dphi at x = b + (a - b) sin^2(phi), a substitution that removes the square roots at both ends; parameters: P,
   !> a, b, R, mu.
   pure real(wp) function friction_work(x, parameters) result(value)
      real(wp), intent(in) :: x, parameters(:)
      real(wp) :: position

      associate (a => parameters(2), b => parameters(3), phi => x)
         position = b + (a - b)*sin(phi)**2
         value = parameters(5)*hertz_pressure(position, parameters(1), a) &
                 *mindlin_slip(position, b, parameters(4), parameters(5))*2.0_wp*(a - b)*sin(phi)*cos(phi)
      end associate
   end function friction_work

end module mfv_reference_mindlin
