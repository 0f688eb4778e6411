!> Friction laws: how much shear traction a node in contact can carry (f(p) of dissertation Table 2.1).
module mfv_friction
   use mfv_kinds, only: wp
   implicit none
   private
   public :: friction_type, no_friction, coulomb_friction

   !> Coulomb's law |tau| <= mu p, with tau = mu p against the slip. mu = 0 is no friction and costs no more: the
   !> tangential problem is then not modelled.
   type :: friction_type
      !> Coefficient of friction mu.
      real(wp) :: coefficient = 0.0_wp
   contains
      procedure :: acts
   end type friction_type

contains

   pure type(friction_type) function no_friction()
      no_friction = friction_type()
   end function no_friction

   !> Coulomb's law with the coefficient of friction mu >= 0.
   pure type(friction_type) function coulomb_friction(mu)
      real(wp), intent(in) :: mu

      coulomb_friction = friction_type(mu)
   end function coulomb_friction

   !> Whether there can be any shear traction.
   pure logical function acts(self)
      class(friction_type), intent(in) :: self

      acts = self%coefficient > 0.0_wp
   end function acts

end module mfv_friction
