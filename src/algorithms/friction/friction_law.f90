!> What every friction law tells the algorithms. Each law is a file of its own that extends `friction_law_type`.
!>
!> All laws share the friction limit of a node that holds, |tau| <= mu_s p. They differ in what a node does that slips (or
!> creeps): over an increment of the load its shear traction is the line
!>
!>     tau = slope*p + stiffness*s + offset,
!>
!> a row of the augmented system (dissertation eq. 2.2, B.2). Laws that are not linear give a line that is right
!> where the increment is expected to take the node; the algorithm iterates, and controls the error.
module mfv_friction_law
   use mfv_kinds, only: wp
   use mfv_node_status
   implicit none
   private
   public :: friction_law_type, friction_point_type, friction_row_type

   !> What a law knows of one node.
   type :: friction_point_type
      !> Static and kinetic coefficient of friction at the node.
      real(wp) :: static = 0.0_wp, kinetic = 0.0_wp
      !> Pressure p and shear traction tau, force/length^2; slip s = u - U, length.
      real(wp) :: pressure = 0.0_wp, shear = 0.0_wp, slip = 0.0_wp
      !> How far the node has slipped since it last held, length; and by how much its |tau| is still beyond mu_k p while that
      !> falls at a fixed load, force/length^2.
      real(wp) :: slipped = 0.0_wp, excess = 0.0_wp
   end type friction_point_type

   !> The line tau = slope*p + stiffness*s + offset: no unit, force/length^3, force/length^2.
   type :: friction_row_type
      real(wp) :: slope = 0.0_wp, stiffness = 0.0_wp, offset = 0.0_wp
   end type friction_row_type

   type, abstract :: friction_law_type
      !> Whether the lines are exact over increments of any length.
      logical :: is_linear = .true.
      !> Whether a node below its limit does not move at all; else it creeps, held by bristles.
      logical :: sticks = .true.
      !> Whether |tau| falls at once where a node begins to slip: the excess is let go at a fixed load, as a path of its own.
      logical :: drops = .false.
      !> Slip after which the line has a corner, length.
      real(wp) :: weakening_distance = huge(1.0_wp)
      !> Part of the limit mu_s p at which a holding node slips.
      real(wp) :: full_part = 1.0_wp
      !> Whether creeping nodes come to the limit without a corner: a node that has just touched then has a part of it.
      logical :: soft_limit = .false.
      !> Stiffness that creeping nodes have there, on and back, force/length^3.
      real(wp) :: limit_stiffness = 0.0_wp, back_stiffness = 0.0_wp
   contains
      procedure(row_interface), deferred :: row
      procedure(strength_interface), deferred :: strength
      procedure :: secant
      procedure :: holding_status
      procedure :: first_excess
      procedure :: slipped_after
      procedure :: lawful_excess
      procedure :: room
      procedure :: turning
      procedure :: yields
   end type friction_law_type

   abstract interface
      !> The line of a slipping or creeping node with this `status` over the increment from `before` to `after`; the same
      !> point twice gives the tangent.
      pure function row_interface(self, status, before, after) result(row)
         import :: friction_law_type, friction_point_type, friction_row_type
         class(friction_law_type), intent(in) :: self
         integer, intent(in) :: status
         type(friction_point_type), intent(in) :: before, after
         type(friction_row_type) :: row
      end function row_interface

      !> |tau| of a node that slips, force/length^2.
      pure real(wp) function strength_interface(self, point)
         import :: friction_law_type, friction_point_type, wp
         class(friction_law_type), intent(in) :: self
         type(friction_point_type), intent(in) :: point
      end function strength_interface
   end interface

contains

   !> The line through both ends of an increment at which `after` obeys the law; of a linear law its only line.
   pure function secant(self, status, before, after) result(row)
      class(friction_law_type), intent(in) :: self
      integer, intent(in) :: status
      type(friction_point_type), intent(in) :: before, after
      type(friction_row_type) :: row

      row = self%row(status, before, before)
   end function secant

   !> Status of a node that holds, and that moves to `direction` (its sign, 0: not known) if it moves at all.
   pure integer function holding_status(self, direction)
      class(friction_law_type), intent(in) :: self
      integer, intent(in) :: direction

      holding_status = node_stick
      if (.not. self%sticks) holding_status = merge(node_creep_left, node_creep_right, direction < 0)
   end function holding_status

   !> The excess of |tau| over mu_k p with which a node begins to slip where the law drops, force/length^2.
   pure real(wp) function first_excess(self, point)
      class(friction_law_type), intent(in) :: self
      type(friction_point_type), intent(in) :: point

      first_excess = 0.0_wp
      if (point%kinetic < point%static) first_excess = max(abs(point%shear) - point%kinetic*point%pressure, 0.0_wp)
   end function first_excess

   !> How far a slipping node has slipped after an increment, length; not counted beyond the weakening distance.
   pure real(wp) function slipped_after(self, before, after) result(slipped)
      class(friction_law_type), intent(in) :: self
      type(friction_point_type), intent(in) :: before, after

      slipped = min(before%slipped + abs(after%slip - before%slip), self%weakening_distance)
   end function slipped_after

   !> What the excess of a falling node is by the law itself, (mu - mu_k) p: where the two meet the fall is over. And how it
   !> changes with pressure (no unit) and with slip (force/length^3). Zero unless the law weakens with slip.
   pure subroutine lawful_excess(self, point, excess, by_pressure, by_slip)
      class(friction_law_type), intent(in) :: self
      type(friction_point_type), intent(in) :: point
      real(wp), intent(out) :: excess, by_pressure, by_slip
      real(wp) :: fall

      fall = 0.0_wp
      if (self%weakening_distance < huge(1.0_wp)) fall = (point%static - point%kinetic)/self%weakening_distance
      by_pressure = max(self%weakening_distance - point%slipped, 0.0_wp)*fall
      excess = by_pressure*point%pressure
      by_slip = 0.0_wp
      if (by_pressure > 0.0_wp) by_slip = -fall*point%pressure
   end subroutine lawful_excess

   !> How much further a slipping node can slip until its line has a corner, length.
   pure real(wp) function room(self, point)
      class(friction_law_type), intent(in) :: self
      type(friction_point_type), intent(in) :: point
      real(wp), parameter :: round_off = 1.0e-12_wp

      room = huge(1.0_wp)
      if (self%weakening_distance < huge(1.0_wp) .and. point%kinetic < point%static .and. .not. point%excess > 0.0_wp .and. &
          point%slipped < self%weakening_distance*(1.0_wp - round_off)) room = self%weakening_distance - point%slipped
   end function room

   !> By how much the stiffness of a node that holds depends on the direction in which it moves, force/length^3.
   pure real(wp) function turning(self, point)
      class(friction_law_type), intent(in) :: self
      type(friction_point_type), intent(in) :: point
      type(friction_row_type) :: right, left

      turning = 0.0_wp
      if (self%sticks) return
      right = self%row(node_creep_right, point, point)
      left = self%row(node_creep_left, point, point)
      turning = abs(right%stiffness - left%stiffness)
   end function turning

   !> By how much more bristles at the limit would load than it grows, force/length^2: while this is not negative they give way,
   !> and the node slips. `moved`: motion in the direction of the slip, length; `growth`: of the limit, force/length^2; or
   !> their rates.
   elemental real(wp) function yields(self, moved, growth)
      class(friction_law_type), intent(in) :: self
      real(wp), intent(in) :: moved, growth

      yields = merge(self%limit_stiffness, self%back_stiffness, moved > 0.0_wp)*moved - growth
   end function yields

end module mfv_friction_law
