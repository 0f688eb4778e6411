!> Coulomb friction, dissertation Table 2.1: |tau| <= mu p, with tau = mu p against the slip.
module mfv_friction_coulomb
   use mfv_friction_law
   use mfv_kinds, only: wp
   use mfv_node_status, only: slip_sign
   implicit none
   private
   public :: coulomb_law

   type, extends(friction_law_type) :: coulomb_law_type
   contains
      procedure :: row
      procedure :: strength
   end type coulomb_law_type

   !> The law.
   type(coulomb_law_type), parameter :: coulomb_law = coulomb_law_type(name='coulomb', is_proportional=.true.)

contains

   !> See mfv_friction_law, as for all that follow. tau = -mu p (slip right) or mu p (slip left).
   pure function row(self, status, before, after)
      class(coulomb_law_type), intent(in) :: self
      integer, intent(in) :: status
      type(friction_point_type), intent(in) :: before, after
      type(friction_row_type) :: row

      row%slope = -slip_sign(status)*before%static
   end function row

   pure real(wp) function strength(self, point)
      class(coulomb_law_type), intent(in) :: self
      type(friction_point_type), intent(in) :: point

      strength = point%static*point%pressure
   end function strength

end module mfv_friction_coulomb
