!> Two half-planes of one anisotropic material in one direction, oblique to their surface, one of them with a round gap: B cancels,
!> M does not (mfv_near_field). With p' = p + (M/A) tau the equations are those of uncoupled bodies with the compliances A and
!> At - M^2/A, and |tau| <= mu p is |tau| <= mu p'/(1 +- mu M/A): Hertz's, Cattaneo's and Mindlin's problem (docs/theory.md).
module mfv_reference_oblique
   use mfv_kinds, only: wp
   use mfv_reference_hertz, only: hertz_half_width
   implicit none
   private
   public :: oblique_half_width, oblique_stick_ratio

contains

   !> Half-width (length) of the contact under a normal and a tangential force, force/length, for a relative `radius` (length):
   !> Hertz's under P + (M/A) Q. `modulus`: 1/A of both bodies, force/length^2; `mixed_ratio`: M/A of both; positive forces.
   pure real(wp) function oblique_half_width(normal_force, tangential_force, radius, modulus, mixed_ratio) result(half_width)
      real(wp), intent(in) :: normal_force, tangential_force, radius, modulus, mixed_ratio

      half_width = hertz_half_width(normal_force + mixed_ratio*tangential_force, radius, modulus)
   end function oblique_half_width

   !> Width of the stick zone over that of the contact, pressed without shear, then sheared by a growing force: the stick zone is
   !> the contact under P - |Q|/mu. 0 if everything slides.
   pure real(wp) function oblique_stick_ratio(tangential_force, normal_force, friction_coefficient, mixed_ratio) result(ratio)
      real(wp), intent(in) :: tangential_force, normal_force, friction_coefficient, mixed_ratio

      ratio = sqrt(max(friction_coefficient*normal_force - abs(tangential_force), 0.0_wp) &
                   /(friction_coefficient*(normal_force + mixed_ratio*tangential_force)))
   end function oblique_stick_ratio

end module mfv_reference_oblique
