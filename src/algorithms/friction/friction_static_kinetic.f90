!> Static and kinetic friction (the two-parameter friction of the dissertation, sections 3.4, 3.7 and 5.2): a node sticks up to
!> mu_s p and slips with mu_k p. When it begins to slip, |tau| drops: see mfv_friction_drop.
!>
!> The edge of the stick zone is singular under this law, and the resistance to it vanishes with the interval: the stick ratio
!> depends on the mesh (docs/theory.md). Weakening friction converges with the mesh.
module mfv_friction_static_kinetic
   use mfv_friction_drop, only: dropping_law_type, over
   use mfv_friction_law
   use mfv_kinds, only: wp
   implicit none
   private
   public :: static_kinetic_law

   type, extends(dropping_law_type) :: static_kinetic_law_type
   contains
      procedure :: row
      procedure :: strength
   end type static_kinetic_law_type

   !> The law.
   type(static_kinetic_law_type), parameter :: static_kinetic_law = &
                                               static_kinetic_law_type(name='static_kinetic', has_two_coefficients=.true., &
                                                                       drops=.true., has_memory=.true., has_events=.true.)

contains

   !> See mfv_friction_law, as for all that follow. |tau| = mu_k p + r.
   pure function row(self, status, before, after)
      class(static_kinetic_law_type), intent(in) :: self
      integer, intent(in) :: status
      type(friction_point_type), intent(in) :: before, after
      type(friction_row_type) :: row

      row = self%releasing_row(status, before)
   end function row

   pure real(wp) function strength(self, point)
      class(static_kinetic_law_type), intent(in) :: self
      type(friction_point_type), intent(in) :: point

      strength = point%kinetic*point%pressure + point%memory(over)
   end function strength

end module mfv_friction_static_kinetic
