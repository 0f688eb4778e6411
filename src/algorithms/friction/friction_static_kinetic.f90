!> Static and kinetic friction (the dissertation's two-parameter friction, sections 3.4, 3.7 and 5.2): a node holds up to
!> mu_s p and slips with mu_k p.
!>
!> Where a node begins to slip, |tau| must fall from mu_s p to mu_k p at an unchanged load. The excess r = |tau| - mu_k p
!> is carried and let go as a path of its own, on which every inequality holds (mfv_first_violation).
!>
!> The edge of the stick zone is singular under this law, and the strength that resists it vanishes with the interval: the
!> stick ratio depends on the mesh (docs/theory.md). Weakening friction is the law that converges.
module mfv_friction_static_kinetic
   use mfv_friction_law
   use mfv_kinds, only: wp
   use mfv_node_status, only: slip_sign
   implicit none
   private
   public :: static_kinetic_law_type, new_static_kinetic_law

   type, extends(friction_law_type) :: static_kinetic_law_type
   contains
      procedure :: row
      procedure :: strength
   end type static_kinetic_law_type

contains

   pure function new_static_kinetic_law() result(law)
      type(static_kinetic_law_type) :: law

      law%drops = .true.
   end function new_static_kinetic_law

   !> See mfv_friction_law: |tau| = mu_k p + r.
   pure function row(self, status, before, after)
      class(static_kinetic_law_type), intent(in) :: self
      integer, intent(in) :: status
      type(friction_point_type), intent(in) :: before, after
      type(friction_row_type) :: row

      row%slope = -slip_sign(status)*before%kinetic
      row%offset = -slip_sign(status)*before%excess
   end function row

   !> See mfv_friction_law.
   pure real(wp) function strength(self, point)
      class(static_kinetic_law_type), intent(in) :: self
      type(friction_point_type), intent(in) :: point

      strength = point%kinetic*point%pressure + point%excess
   end function strength

end module mfv_friction_static_kinetic
