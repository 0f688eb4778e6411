!> Dahl's friction, dissertation eq. 3.9 and appendix B: bristles of stiffness sigma give way the more, the nearer the
!> traction is to its limit mu p,
!>
!>     df/ds = sigma (1 - f/(mu p) sgn(s'))^gamma,   f = -tau,
!>
!> so that a node below the limit creeps (Table B.1's partial slip). At the limit it slips as under Coulomb's law; and there
!> it is when mu p falls below |f|. While mu p grows the bristles, without stiffness at the limit, take over again.
!>
!> The line of a creeping node is tau = tau0 - K (s - s0) with K at the start of the increment (appendix B) or, when the
!> end is expected somewhere, half way there: the error is then of second order.
module mfv_friction_dahl
   use mfv_friction_law
   use mfv_kinds, only: wp
   use mfv_node_status, only: creeps, motion_sign, slip_sign
   implicit none
   private
   public :: dahl_law_type, new_dahl_law

   type, extends(friction_law_type) :: dahl_law_type
      !> Stiffness sigma of the bristles, force/length^3 (traction over slip), and exponent gamma.
      real(wp) :: stiffness = 0.0_wp, exponent = 1.0_wp
   contains
      procedure :: row
      procedure :: strength
      procedure, private :: bristle_stiffness
   end type dahl_law_type

contains

   !> `stiffness`: sigma > 0, force/length^3; `exponent`: gamma >= 0.
   pure function new_dahl_law(stiffness, exponent) result(law)
      real(wp), intent(in) :: stiffness, exponent
      type(dahl_law_type) :: law

      law%is_linear = .false.
      law%sticks = .false.
      ! Dahl's traction comes to its limit only after endless slip: this near it is there.
      law%full_part = 1.0_wp - 1.0e-9_wp
      law%stiffness = stiffness
      law%exponent = exponent
      law%limit_stiffness = stiffness
      if (exponent > 0.0_wp) law%limit_stiffness = stiffness*(1.0_wp - law%full_part)**exponent
   end function new_dahl_law

   !> See mfv_friction_law.
   pure function row(self, status, before, after)
      class(dahl_law_type), intent(in) :: self
      integer, intent(in) :: status
      type(friction_point_type), intent(in) :: before, after
      type(friction_row_type) :: row

      if (creeps(status)) then
         row%stiffness = -self%bristle_stiffness(motion_sign(status), before, after)
         row%offset = before%shear - row%stiffness*before%slip
      else
         row%slope = -slip_sign(status)*before%static*self%full_part
      end if
   end function row

   !> See mfv_friction_law.
   pure real(wp) function strength(self, point)
      class(dahl_law_type), intent(in) :: self
      type(friction_point_type), intent(in) :: point

      strength = point%static*point%pressure*self%full_part
   end function strength

   !> K of eq. B.2 half way between two points, force/length^3.
   pure real(wp) function bristle_stiffness(self, direction, before, after)
      class(dahl_law_type), intent(in) :: self
      integer, intent(in) :: direction
      type(friction_point_type), intent(in) :: before, after
      real(wp) :: force, limit, room

      force = -0.5_wp*(before%shear + after%shear)*direction
      limit = 0.5_wp*before%static*(before%pressure + after%pressure)
      room = 1.0_wp
      if (limit > 0.0_wp) room = min(max(1.0_wp - force/limit, 0.0_wp), 2.0_wp)
      bristle_stiffness = self%stiffness
      if (abs(self%exponent) > 0.0_wp) bristle_stiffness = self%stiffness*room**self%exponent
   end function bristle_stiffness

end module mfv_friction_dahl
