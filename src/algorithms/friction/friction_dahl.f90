!> Dahl's friction, dissertation eq. 3.9 and appendix B: bristles of stiffness sigma give way the more, the nearer the
!> traction is to its limit mu p,
!>
!>     df/ds = sigma (1 - f/(mu p) sgn(s'))^gamma,   f = -tau,
!>
!> so that a node below the limit creeps (Table B.1's partial slip). At the limit it slips as under Coulomb's law; and there
!> it is when mu p falls below |f|, whichever way it then moves. While mu p grows faster than the bristles load, they take over
!> again.
!>
!> A creeping node's tau1 = tau0 - K (s1 - s0) has K at the start of the increment (appendix B) or, in second order, half way
!> to where the increment ends. The line is this equation linearised about the expected end (Newton): exact where it is right.
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
      procedure :: secant
      procedure, private :: creeping_row
   end type dahl_law_type

contains

   !> `stiffness`: sigma > 0, force/length^3; `exponent`: gamma >= 0.
   pure function new_dahl_law(stiffness, exponent) result(law)
      real(wp), intent(in) :: stiffness, exponent
      type(dahl_law_type) :: law

      law%is_linear = .false.
      law%sticks = .false.
      ! Dahl's traction comes to its limit only after endless slip: this near it is there.
      law%full_part = 1.0_wp - 1.0e-6_wp
      law%stiffness = stiffness
      law%exponent = exponent
      law%soft_limit = exponent > 0.0_wp
      law%limit_stiffness = stiffness
      law%back_stiffness = stiffness
      if (exponent > 0.0_wp) then
         law%limit_stiffness = stiffness*(1.0_wp - law%full_part)**exponent
         law%back_stiffness = stiffness*(1.0_wp + law%full_part)**exponent
      end if
   end function new_dahl_law

   !> See mfv_friction_law.
   pure function row(self, status, before, after)
      class(dahl_law_type), intent(in) :: self
      integer, intent(in) :: status
      type(friction_point_type), intent(in) :: before, after
      type(friction_row_type) :: row

      if (creeps(status)) then
         row = self%creeping_row(motion_sign(status), before, after)
      else
         row%slope = -slip_sign(status)*before%static*self%full_part
      end if
   end function row

   !> See mfv_friction_law: tau = tau0 - K (s - s0).
   pure function secant(self, status, before, after) result(row)
      class(dahl_law_type), intent(in) :: self
      integer, intent(in) :: status
      type(friction_point_type), intent(in) :: before, after
      type(friction_row_type) :: row
      real(wp) :: force, limit, steepness

      if (creeps(status)) then
         call find_stiffness(self, motion_sign(status), before, after, force, limit, row%stiffness, steepness)
         row%stiffness = -row%stiffness
         row%offset = before%shear - row%stiffness*before%slip
      else
         row = self%row(status, before, before)
      end if
   end function secant

   !> The line of a creeping node: F = tau1 - tau0 + K (s1 - s0) = 0, linearised.
   pure function creeping_row(self, direction, before, after) result(row)
      class(dahl_law_type), intent(in) :: self
      integer, intent(in) :: direction
      type(friction_point_type), intent(in) :: before, after
      type(friction_row_type) :: row
      real(wp) :: force, limit, stiffness, steepness, slipped, by_shear, by_pressure

      call find_stiffness(self, direction, before, after, force, limit, stiffness, steepness)
      slipped = after%slip - before%slip
      by_shear = 0.0_wp
      by_pressure = 0.0_wp
      if (limit > 0.0_wp) then
         by_shear = 0.5_wp*steepness*direction/limit*slipped
         by_pressure = 0.5_wp*steepness*before%static*force/limit**2*slipped
      end if
      by_shear = max(by_shear, 0.0_wp)
      row%stiffness = -stiffness/(1.0_wp + by_shear)
      row%slope = -by_pressure/(1.0_wp + by_shear)
      row%offset = (before%shear + stiffness*before%slip + by_shear*after%shear + by_pressure*after%pressure) &
                   /(1.0_wp + by_shear)
   end function creeping_row

   !> See mfv_friction_law.
   pure real(wp) function strength(self, point)
      class(dahl_law_type), intent(in) :: self
      type(friction_point_type), intent(in) :: point

      strength = point%static*point%pressure*self%full_part
   end function strength

   !> K of eq. B.2 half way between two points and minus its derivative by f/(mu p), force/length^3; and f and mu p there.
   pure subroutine find_stiffness(self, direction, before, after, force, limit, stiffness, steepness)
      class(dahl_law_type), intent(in) :: self
      integer, intent(in) :: direction
      type(friction_point_type), intent(in) :: before, after
      real(wp), intent(out) :: force, limit, stiffness, steepness
      real(wp), parameter :: least_slope = 0.05_wp, most_slope = 1.0e3_wp, farthest = 10.0_wp
      real(wp) :: room

      force = -0.5_wp*(before%shear + after%shear)*direction
      limit = 0.5_wp*before%static*(before%pressure + after%pressure)
      room = 1.0_wp
      if (abs(force) < farthest*limit) room = min(1.0_wp - force/limit, 2.0_wp)
      if (.not. abs(force) < farthest*limit .and. abs(force) > 0.0_wp) room = merge(1.0_wp - farthest, 2.0_wp, force > 0.0_wp)
      stiffness = self%stiffness
      steepness = 0.0_wp
      if (self%exponent > 0.0_wp) then
         ! The law goes on beyond the limit with its sign (eq. 3.9), for the iterations; where they end it is not beyond.
         stiffness = self%stiffness*sign(abs(room)**self%exponent, room)
         steepness = self%stiffness*self%exponent &
                     *min(max(max(abs(room), 1.0e-9_wp)**(self%exponent - 1.0_wp), least_slope), most_slope)
      end if
   end subroutine find_stiffness

end module mfv_friction_dahl
