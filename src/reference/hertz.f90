!> Closed form: a cylinder pressed on a half-plane, or two cylinders on each other, without friction (Hertz; Johnson 1985,
!> section 4.2; dissertation eqs. 3.1, 3.2).
module mfv_reference_hertz
   use mfv_kinds, only: pi, wp
   implicit none
   private
   public :: hertz_half_width, hertz_force, hertz_pressure, hertz_approach

contains

   !> Contact half-width a = sqrt(2 P R/(pi m)), length, for the normal force P (force/length), the radius R (length; of
   !> two bodies 1/R = 1/R1 + 1/R2) and the modulus m (force/length^2): 4 G/(kappa + 1) of the elastic body, of two bodies
   !> 1/m = 1/m1 + 1/m2. Equations 3.1, 5.1.
   pure real(wp) function hertz_half_width(normal_force, radius, modulus) result(a)
      real(wp), intent(in) :: normal_force, radius, modulus

      a = sqrt(max(normal_force, 0.0_wp)*2.0_wp*radius/(pi*modulus))
   end function hertz_half_width

   !> Normal force (force/length) for a contact half-width a (length); radius and modulus as above.
   pure real(wp) function hertz_force(half_width, radius, modulus) result(normal_force)
      real(wp), intent(in) :: half_width, radius, modulus

      normal_force = half_width**2*pi*modulus/(2.0_wp*radius)
   end function hertz_force

   !> Pressure 2 P sqrt(a^2 - x^2)/(pi a^2) at x (length), force/length^2; zero outside the contact. Equation 3.2.
   elemental real(wp) function hertz_pressure(x, normal_force, half_width) result(pressure)
      real(wp), intent(in) :: x, normal_force, half_width

      pressure = 0.0_wp
      if (abs(x) < half_width) pressure = 2.0_wp*normal_force/(pi*half_width) &
                                          *sqrt((1.0_wp - x/half_width)*(1.0_wp + x/half_width))
   end function hertz_pressure

   !> Approach a^2/(2R) [ln(2D/a) + 1/2], length, measured from the surface point at the distance D (`datum`): the
   !> displacement of the centre under Hertz's pressure and the kernel of mfv_half_plane.
   elemental real(wp) function hertz_approach(half_width, radius, datum) result(approach)
      real(wp), intent(in) :: half_width, radius, datum

      approach = 0.0_wp
      if (half_width > 0.0_wp) approach = half_width**2/(2.0_wp*radius)*(log(2.0_wp*datum/half_width) + 0.5_wp)
   end function hertz_approach

end module mfv_reference_hertz
