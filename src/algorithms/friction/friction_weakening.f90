!> Slip-weakening friction: the coefficient falls from mu_s to mu_k, linearly over a slip distance D; a node that holds again
!> has mu_s again. With D against zero it becomes static and kinetic friction; other than that it has a length of its own, so
!> that results converge with the mesh. (Source: the linear law of fracture mechanics of faults, Ida 1972, J. Geophys. Res. 77,
!> 3796; there tau against slip, here mu against slip.)
!>
!> tau = -+ mu(slip) p is bilinear where p changes with the load: the line is linearised about the expected end of the
!> increment (Newton) and exact where that is right.
!>
!> Where the bodies cannot unload as fast as friction falls, no slip in equilibrium begins: the node snaps. As under static and
!> kinetic friction its traction then falls at a fixed load, until the law holds again or the node is at mu_k.
module mfv_friction_weakening
   use mfv_friction_law
   use mfv_kinds, only: wp
   use mfv_node_status, only: slip_sign
   implicit none
   private
   public :: weakening_law_type, new_weakening_law

   type, extends(friction_law_type) :: weakening_law_type
   contains
      procedure :: row
      procedure :: strength
      procedure :: secant
      procedure, private :: coefficient
   end type weakening_law_type

contains

   !> `distance`: slip over which mu falls from its static to its kinetic value, length, > 0.
   pure function new_weakening_law(distance) result(law)
      real(wp), intent(in) :: distance
      type(weakening_law_type) :: law

      law%is_linear = .false.
      law%weakening_distance = distance
   end function new_weakening_law

   !> See mfv_friction_law.
   pure function row(self, status, before, after)
      class(weakening_law_type), intent(in) :: self
      integer, intent(in) :: status
      type(friction_point_type), intent(in) :: before, after
      type(friction_row_type) :: row
      real(wp) :: fall
      integer :: direction

      direction = slip_sign(status)
      if (before%excess > 0.0_wp) then
         row%slope = -direction*before%kinetic
         row%offset = -direction*before%excess
         return
      end if
      fall = 0.0_wp
      if (self%room(before) < huge(1.0_wp)) fall = (before%static - before%kinetic)/self%weakening_distance
      row%slope = -direction*(self%coefficient(before) - fall*direction*(after%slip - before%slip))
      row%stiffness = after%pressure*fall
      row%offset = -row%stiffness*after%slip
   end function row

   !> See mfv_friction_law: the increment of f = mu p is mean(mu) dp + mean(p) dmu, exactly.
   pure function secant(self, status, before, after) result(row)
      class(weakening_law_type), intent(in) :: self
      integer, intent(in) :: status
      type(friction_point_type), intent(in) :: before, after
      type(friction_row_type) :: row

      row = self%row(status, before, before)
      if (.not. self%room(before) < huge(1.0_wp)) return
      row%slope = row%slope + 0.5_wp*(before%static - before%kinetic)/self%weakening_distance*(after%slip - before%slip)
      row%stiffness = 0.5_wp*(before%pressure + after%pressure)*(before%static - before%kinetic)/self%weakening_distance
      row%offset = -slip_sign(status)*self%strength(before) - row%slope*before%pressure - row%stiffness*before%slip
   end function secant

   !> See mfv_friction_law.
   pure real(wp) function strength(self, point)
      class(weakening_law_type), intent(in) :: self
      type(friction_point_type), intent(in) :: point

      strength = self%coefficient(point)*point%pressure
      if (point%excess > 0.0_wp) strength = point%kinetic*point%pressure + point%excess
   end function strength

   !> mu after the slip that the point remembers.
   pure real(wp) function coefficient(self, point)
      class(weakening_law_type), intent(in) :: self
      type(friction_point_type), intent(in) :: point
      real(wp) :: part

      coefficient = point%static
      if (.not. point%kinetic < point%static) return
      part = min(point%slipped/self%weakening_distance, 1.0_wp)
      coefficient = (1.0_wp - part)*point%static + part*point%kinetic
   end function coefficient

end module mfv_friction_weakening
