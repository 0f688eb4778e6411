!> Closed form: a pin in a bore of nearly its radius, both of one material, without friction (Persson 1964; Ciavarella and
!> Decuzzi 2001, International Journal of Solids and Structures 38, for alpha = beta = 0).
module mfv_reference_persson
   use mfv_kinds, only: pi, wp
   implicit none
   private
   public :: persson_force

contains

   !> Normal force (force/length) at which the contact reaches the angle `half_angle` (radians) to either side: E* dR/P = (2 -
   !> ln(b^2 + 1) - 2 b^4)/(pi (b^2 + 1) b^2), b = tan(half_angle/2). `clearance`: dR, the difference of the radii, length;
   !> `youngs_modulus`: E* = E/(1 - nu^2) in plane strain, E in plane stress, force/length^2. Beyond 84.83 degrees, where the
   !> numerator vanishes, the contact of a pin without clearance, no finite force: huge.
   elemental real(wp) function persson_force(half_angle, clearance, youngs_modulus) result(normal_force)
      real(wp), intent(in) :: half_angle, clearance, youngs_modulus
      real(wp) :: square, numerator

      square = tan(0.5_wp*half_angle)**2
      numerator = 2.0_wp - log(square + 1.0_wp) - 2.0_wp*square**2
      normal_force = huge(1.0_wp)
      if (numerator > 0.0_wp) normal_force = youngs_modulus*clearance*pi*(square + 1.0_wp)*square/numerator
   end function persson_force

end module mfv_reference_persson
