!> What every friction law tells the algorithms. Each law is a file of its own that extends `friction_law_type`.
!>
!> All laws share the friction limit of a node that holds, |tau| <= mu_s p. They differ in what a node does that slips (or
!> creeps): over an increment of the load its shear traction is the line
!>
!>     tau = slope*p + stiffness*s + offset,
!>
!> a row of the augmented system (dissertation eq. 2.2, B.2). Laws for which no such line is exact give a secant, from where
!> the node is to where the increment is expected to take it; the algorithm then controls the error.
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
      !> What is remembered of the node: the excess of |tau| over its kinetic limit (force/length^2) where the law `drops`;
      !> else how far it has slipped since it last held (length).
      real(wp) :: memory = 0.0_wp
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
      !> Stiffness that creeping nodes have left there, force/length^3.
      real(wp) :: limit_stiffness = 0.0_wp
   contains
      procedure(row_interface), deferred :: row
      procedure(strength_interface), deferred :: strength
      procedure :: holding_status
      procedure :: slip_begins
      procedure :: memory_after
      procedure :: room
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

   !> Status of a node that holds, and that moves to `direction` (its sign, 0: not known) if it moves at all.
   pure integer function holding_status(self, direction)
      class(friction_law_type), intent(in) :: self
      integer, intent(in) :: direction

      holding_status = node_stick
      if (.not. self%sticks) holding_status = merge(node_creep_left, node_creep_right, direction < 0)
   end function holding_status

   !> The memory of a node that begins to slip.
   pure real(wp) function slip_begins(self, point)
      class(friction_law_type), intent(in) :: self
      type(friction_point_type), intent(in) :: point

      slip_begins = 0.0_wp
      if (self%drops) slip_begins = max(abs(point%shear) - point%kinetic*point%pressure, 0.0_wp)
   end function slip_begins

   !> The memory of a slipping node after an increment. (An excess is led by the algorithm, not here.)
   pure real(wp) function memory_after(self, before, after) result(memory)
      class(friction_law_type), intent(in) :: self
      type(friction_point_type), intent(in) :: before, after

      memory = before%memory
      if (.not. self%drops) memory = min(memory + abs(after%slip - before%slip), self%weakening_distance)
   end function memory_after

   !> How much further a slipping node can slip until its line has a corner, length.
   pure real(wp) function room(self, point)
      class(friction_law_type), intent(in) :: self
      type(friction_point_type), intent(in) :: point
      real(wp), parameter :: round_off = 1.0e-12_wp

      room = huge(1.0_wp)
      if (self%weakening_distance < huge(1.0_wp) .and. point%memory < self%weakening_distance*(1.0_wp - round_off)) &
         room = self%weakening_distance - point%memory
   end function room

end module mfv_friction_law
