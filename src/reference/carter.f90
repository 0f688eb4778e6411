!> Closed form: two elastically similar cylinders in steady rolling under constant normal and tangential forces (Carter 1926;
!> Johnson 1985, section 8.3). The contact rolls to the right, x is measured from its middle: the stick zone adjoins the
!> leading edge x = a. For rolling to the left use the shear at -x, and the negative creepage.
module mfv_reference_carter
   use mfv_kinds, only: wp
   use mfv_reference_hertz, only: hertz_pressure
   use mfv_reference_mindlin, only: mindlin_stick_ratio
   implicit none
   private
   public :: carter_creepage, carter_shear

contains

   !> Creepage (mu a/R) (1 - sqrt(1 - |Q|/(mu P))), of the sign of Q: sliding of the upper surface over the lower one per
   !> rolled distance, both to the right. Q, P: force/length; half-width a and radius R: length, 1/R = 1/R1 + 1/R2. In gross
   !> sliding the creepage is undetermined; the largest value mu a/R is returned.
   elemental real(wp) function carter_creepage(tangential_force, normal_force, half_width, radius, friction_coefficient) &
      result(creepage)
      real(wp), intent(in) :: tangential_force, normal_force, half_width, radius, friction_coefficient

      creepage = sign(friction_coefficient*half_width/radius &
                      *(1.0_wp - mindlin_stick_ratio(tangential_force, normal_force, friction_coefficient)), tangential_force)
   end function carter_creepage

   !> Shear traction at x (length), force/length^2: mu times Hertz's pressure, minus, in the stick zone of half-width b = a
   !> sqrt(1 - |Q|/(mu P)) and middle a - b, the same ellipse scaled by b/a.
   elemental real(wp) function carter_shear(x, tangential_force, normal_force, half_width, friction_coefficient) result(shear)
      real(wp), intent(in) :: x, tangential_force, normal_force, half_width, friction_coefficient
      real(wp) :: ratio

      ratio = mindlin_stick_ratio(tangential_force, normal_force, friction_coefficient)
      shear = hertz_pressure(x, normal_force, half_width)
      ! Hertz's pressure of the force P (b/a)^2 on the half-width b has the peak p0 b/a.
      if (ratio > 0.0_wp) shear = shear - hertz_pressure(x - half_width*(1.0_wp - ratio), normal_force*ratio**2, half_width*ratio)
      shear = sign(friction_coefficient*shear, tangential_force)
      if (.not. abs(tangential_force) > 0.0_wp) shear = 0.0_wp
   end function carter_shear

end module mfv_reference_carter
