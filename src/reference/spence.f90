!> Closed form: a rigid cylinder or flat punch pressed on a half-plane with Coulomb friction, under Goodman's
!> approximation (Spence 1973; dissertation eqs. 3.4 to 3.6; derivation in docs/theory.md).
!>
!> The stick ratio c = b/a is the same for both indenters and all loads. Under the punch the shear traction is that of the
!> slipping punch times F(asin(x/b), c)/K(c) in the stick zone. (The logarithm in eq. 3.6 as printed belongs to the cylinder
!> alone: with it the strain is not constant over the stick zone. A test checks the singular integral.) The cylinder's follows
!> by superposing punches of increasing width, which gives eq. 3.5 as printed.
module mfv_reference_spence
   use mfv_gsl, only: GSL_PREC_DOUBLE, gsl_sf_ellint_RF
   use mfv_kinds, only: pi, wp
   use mfv_numerics, only: root_between
   implicit none
   private
   public :: spence_stick_ratio, spence_cylinder_shear, spence_flat_punch_shear, elliptic_k, elliptic_f

   !> Range of the search for stick ratios, exp(-300) to 1 - 1e-290, where elliptic integrals do not overflow.
   real(wp), parameter :: log_smallest = -300.0_wp, log_largest = -1.0e-290_wp
   !> Lower limit for arguments of R_F, inside the domain outside of which GSL would abort.
   real(wp), parameter :: domain_edge = 1.0e-300_wp

contains

   !> Stick ratio c from beta K(c) = mu K'(c), equation 3.4. 1 for beta = 0 (full stick), 0 for mu = 0. `beta`: Dundurs'
   !> parameter of the half-plane against a rigid body, of either sign.
   real(wp) function spence_stick_ratio(friction_coefficient, beta) result(ratio)
      real(wp), intent(in) :: friction_coefficient, beta

      ratio = 1.0_wp
      if (.not. abs(beta) > 0.0_wp) return
      ratio = 0.0_wp
      if (.not. friction_coefficient > 0.0_wp) return
      ratio = exp(root_between(spence_balance, [friction_coefficient, abs(beta)], log_smallest, log_largest))
   end function spence_stick_ratio

   !> beta K(c) - mu K'(c) at c = exp(x); parameters: mu, beta.
   pure real(wp) function spence_balance(x, parameters) result(value)
      real(wp), intent(in) :: x, parameters(:)

      value = parameters(2)*elliptic_k(one_less_square(x)) - parameters(1)*elliptic_k(exp(2.0_wp*x))
   end function spence_balance

   !> 1 - exp(2x) for x < 0, without cancellation near 0.
   pure real(wp) function one_less_square(x)
      real(wp), intent(in) :: x
      real(wp), parameter :: near = 1.0e-5_wp

      if (abs(x) < near) then
         one_less_square = -2.0_wp*x*(1.0_wp + x*(1.0_wp + 2.0_wp*x/3.0_wp))
      else
         one_less_square = 1.0_wp - exp(2.0_wp*x)
      end if
   end function one_less_square

   !> Complete elliptic integral of the first kind by its complementary parameter, K = R_F(0, 1 - k^2, 1), for
   !> 1 - k^2 in [0, 1]; at 0, where K is infinite, about 346.
   pure real(wp) function elliptic_k(complementary_parameter)
      real(wp), intent(in) :: complementary_parameter

      elliptic_k = gsl_sf_ellint_RF(0.0_wp, max(complementary_parameter, domain_edge), 1.0_wp, GSL_PREC_DOUBLE)
   end function elliptic_k

   !> Incomplete elliptic integral of the first kind F(asin(s), k), for s in [-1, 1] and k in [0, 1].
   pure real(wp) function elliptic_f(sine, modulus)
      real(wp), intent(in) :: sine, modulus

      elliptic_f = sine*gsl_sf_ellint_RF(max((1.0_wp - sine)*(1.0_wp + sine), domain_edge), &
                                         max((1.0_wp - modulus*sine)*(1.0_wp + modulus*sine), domain_edge), 1.0_wp, &
                                         GSL_PREC_DOUBLE)
   end function elliptic_f

   !> Shear traction under a cylinder pressed with the normal force P (force/length) to the contact half-width a
   !> (length), at x (length), force/length^2. Equation 3.5.
   function spence_cylinder_shear(x, normal_force, half_width, friction_coefficient, beta) result(shear)
      real(wp), intent(in) :: x(:), normal_force, half_width, friction_coefficient, beta
      real(wp) :: shear(size(x))
      real(wp) :: ratio, b, complete, peak, distance
      integer :: i

      ratio = spence_stick_ratio(friction_coefficient, beta)
      b = ratio*half_width
      complete = stick_ratio_k(ratio, friction_coefficient, beta)
      peak = 2.0_wp*friction_coefficient*normal_force/(pi*half_width)
      shear = 0.0_wp
      if (.not. abs(beta) > 0.0_wp) return
      do i = 1, size(x)
         distance = abs(x(i))
         if (.not. distance < half_width) cycle
         shear(i) = peak*sqrt((1.0_wp - distance/half_width)*(1.0_wp + distance/half_width))
         if (distance < b) shear(i) = (shear(i)*elliptic_f(distance/b, ratio) + peak*growth_term(distance/b))/complete
         shear(i) = sign(shear(i), beta*x(i))
      end do
   end function spence_cylinder_shear

   !> Shear traction under a flat punch, as spence_cylinder_shear. Equation 3.6 without its logarithm.
   function spence_flat_punch_shear(x, normal_force, half_width, friction_coefficient, beta) result(shear)
      real(wp), intent(in) :: x(:), normal_force, half_width, friction_coefficient, beta
      real(wp) :: shear(size(x))
      real(wp) :: ratio, b, complete, distance
      integer :: i

      ratio = spence_stick_ratio(friction_coefficient, beta)
      b = ratio*half_width
      complete = stick_ratio_k(ratio, friction_coefficient, beta)
      shear = 0.0_wp
      if (.not. abs(beta) > 0.0_wp) return
      do i = 1, size(x)
         distance = abs(x(i))
         if (.not. distance < half_width) cycle
         shear(i) = friction_coefficient*normal_force/(pi*sqrt((half_width - distance)*(half_width + distance)))
         if (distance < b) shear(i) = shear(i)*elliptic_f(distance/b, ratio)/complete
         shear(i) = sign(shear(i), beta*x(i))
      end do
   end function spence_flat_punch_shear

   !> K(c) at the stick ratio c: by equation 3.4 it equals mu K'(c)/beta, which stays accurate where c rounds to 1.
   pure real(wp) function stick_ratio_k(ratio, friction_coefficient, beta)
      real(wp), intent(in) :: ratio, friction_coefficient, beta

      stick_ratio_k = 1.0_wp
      if (abs(beta) > 0.0_wp) stick_ratio_k = friction_coefficient*elliptic_k(ratio**2)/abs(beta)
   end function stick_ratio_k

   !> xi arcosh(1/xi) = -(xi/2) ln[(1 - sqrt(1 - xi^2))/(1 + sqrt(1 - xi^2))], with its limit 0 at 0.
   pure real(wp) function growth_term(xi)
      real(wp), intent(in) :: xi

      growth_term = 0.0_wp
      if (xi > 0.0_wp) growth_term = xi*acosh(max(1.0_wp/xi, 1.0_wp))
   end function growth_term

end module mfv_reference_spence
