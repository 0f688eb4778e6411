!> Common part of laws whose friction decreases from a static to a kinetic coefficient: stress drops.
!>
!> If |tau| must decrease at a fixed load, the over-stress r = |tau| - mu_k p is stored and relaxes along a path of its own, on
!> which every inequality is satisfied (mfv_first_violation). If the pressure decreases faster than r, r reaches the static limit
!> and decreases with it: it is capped.
module mfv_friction_drop
   use mfv_friction_law
   use mfv_kinds, only: wp
   use mfv_node_status, only: event_capped, event_caught, slip_sign, slips
   implicit none
   private
   public :: dropping_law_type, find_drop_events, pass_drop_event, remember_drop, slipped, over

   !> Memory of a node: its slip since it last held, length; the over-stress, force/length^2; whether that is capped (0 or 1).
   integer, parameter :: slipped = 1, over = 2, capped = 3

   type, abstract, extends(friction_law_type) :: dropping_law_type
   contains
      procedure :: find_events => find_drop_events
      procedure :: pass_event => pass_drop_event
      procedure :: change_status
      procedure :: remember => remember_drop
      procedure :: is_releasing
      procedure :: release_rate
      procedure :: release
      procedure, non_overridable :: releasing_row
   end type dropping_law_type

contains

   !> The over-stress with which a node begins to slip, force/length^2.
   pure real(wp) function first_over_stress(point)
      type(friction_point_type), intent(in) :: point

      first_over_stress = 0.0_wp
      if (point%kinetic < point%static) first_over_stress = max(abs(point%shear) - point%kinetic*point%pressure, 0.0_wp)
   end function first_over_stress

   !> The line |tau| = mu_k p + r of a node whose over-stress relaxes; of a capped one |tau| = mu_s p.
   pure function releasing_row(self, status, point) result(row)
      class(dropping_law_type), intent(in) :: self
      integer, intent(in) :: status
      type(friction_point_type), intent(in) :: point
      type(friction_row_type) :: row

      if (point%memory(capped) > 0.0_wp) then
         row%slope = -slip_sign(status)*point%static
      else
         row%slope = -slip_sign(status)*point%kinetic
         row%offset = -slip_sign(status)*point%memory(over)
      end if
   end function releasing_row

   !> Event: the over-stress of a slipping node reaches the static limit.
   pure subroutine find_drop_events(self, status, here, there, events)
      class(dropping_law_type), intent(in) :: self
      integer, intent(in) :: status
      type(friction_point_type), intent(in) :: here, there
      type(friction_event_type), intent(out) :: events(most_events)
      real(wp) :: fall

      if (.not. slips(status) .or. .not. here%memory(over) > 0.0_wp .or. here%memory(capped) > 0.0_wp) return
      fall = here%static - here%kinetic
      events(2) = friction_event_type(event_capped, slack=max(fall*here%pressure - here%memory(over), 0.0_wp), &
                                      rate=here%memory(over), by_pressure=fall)
   end subroutine find_drop_events

   pure subroutine pass_drop_event(self, kind, memory)
      class(dropping_law_type), intent(in) :: self
      integer, intent(in) :: kind
      real(wp), intent(inout) :: memory(:)

      if (kind == event_caught) memory([over, capped]) = 0.0_wp
      if (kind == event_capped .and. memory(over) > 0.0_wp) memory(capped) = 1.0_wp
   end subroutine pass_drop_event

   pure subroutine change_status(self, from, to, point, memory)
      class(dropping_law_type), intent(in) :: self
      integer, intent(in) :: from, to
      type(friction_point_type), intent(in) :: point
      real(wp), intent(inout) :: memory(:)
      logical :: begins

      begins = slips(to) .and. to /= from
      if (begins .or. .not. slips(to)) memory = 0.0_wp
      if (begins .and. self%drops) memory(over) = first_over_stress(point)
   end subroutine change_status

   pure subroutine remember_drop(self, status, before, after, released, memory)
      class(dropping_law_type), intent(in) :: self
      integer, intent(in) :: status
      type(friction_point_type), intent(in) :: before, after
      real(wp), intent(in) :: released
      real(wp), intent(inout) :: memory(:)

      if (slips(status)) memory(slipped) = memory(slipped) + abs(after%slip - before%slip)
      if (memory(capped) > 0.0_wp) then
         memory(over) = (after%static - after%kinetic)*max(after%pressure, 0.0_wp)
      else
         memory(over) = memory(over)*(1.0_wp - released)
      end if
      if (released >= 1.0_wp .or. .not. memory(over) > 0.0_wp) memory(capped) = 0.0_wp
   end subroutine remember_drop

   pure logical function is_releasing(self, memory)
      class(dropping_law_type), intent(in) :: self
      real(wp), intent(in) :: memory(:)

      is_releasing = memory(over) > 0.0_wp
   end function is_releasing

   pure real(wp) function release_rate(self, memory)
      class(dropping_law_type), intent(in) :: self
      real(wp), intent(in) :: memory(:)

      release_rate = 0.0_wp
      if (.not. memory(capped) > 0.0_wp) release_rate = memory(over)
   end function release_rate

   pure subroutine release(self, point, memory)
      class(dropping_law_type), intent(in) :: self
      type(friction_point_type), intent(in) :: point
      real(wp), intent(inout) :: memory(:)

      memory(over) = first_over_stress(point)
   end subroutine release

end module mfv_friction_drop
