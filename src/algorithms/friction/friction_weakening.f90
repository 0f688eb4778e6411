!> Slip-weakening friction: the coefficient decreases from mu_s to mu_k, linearly over a slip distance D; a node that sticks again
!> has mu_s again. For D -> 0 it becomes static and kinetic friction. For D > 0 it has a length scale, so that results converge
!> with the mesh. (Source: the linear law of fault mechanics, Ida 1972, J. Geophys. Res. 77, 3796; there tau against slip, here mu
!> against slip.)
!>
!> tau = -+ mu(slip) p is bilinear if p changes with the load: the line is linearised about the expected end of the increment
!> (Newton) and exact if that is right.
!>
!> If the bodies cannot unload as fast as friction decreases, slip cannot begin in equilibrium: an instability. As under static and
!> kinetic friction the traction then relaxes at a fixed load, until the law is satisfied again or friction has decreased to mu_k.
module mfv_friction_weakening
   use mfv_friction_drop, only: dropping_law_type, find_drop_events, over, pass_drop_event, remember_drop, slipped
   use mfv_friction_law
   use mfv_kinds, only: wp
   use mfv_node_status
   use mfv_tolerances, only: certified, significant
   implicit none
   private
   public :: weakening_law_type, weakening_law

   type, extends(dropping_law_type) :: weakening_law_type
      !> Slip over which mu decreases from its static to its kinetic value, length, > 0.
      real(wp) :: distance = huge(1.0_wp)
   contains
      procedure :: set_parameter
      procedure :: depends_on_end
      procedure :: row
      procedure :: strength
      procedure :: secant
      procedure :: find_events
      procedure :: pass_event
      procedure :: remember
      procedure :: can_become_unstable
      procedure :: slip_of_fall
   end type weakening_law_type

   !> The law, without its parameters.
   type(weakening_law_type), parameter :: weakening_law = &
                                          weakening_law_type(name='weakening', needed_keys='weakening_distance', &
                                                             has_two_coefficients=.true., is_linear=.false., has_memory=.true., &
                                                             has_events=.true.)

contains

   !> See mfv_friction_law, as for all that follow.
   pure subroutine set_parameter(self, key, value)
      class(weakening_law_type), intent(inout) :: self
      character(*), intent(in) :: key
      real(wp), intent(in) :: value

      self%distance = value
   end subroutine set_parameter

   pure logical function depends_on_end(self, status, point)
      class(weakening_law_type), intent(in) :: self
      integer, intent(in) :: status
      type(friction_point_type), intent(in) :: point

      depends_on_end = slips(status) .and. room(self, point) < huge(1.0_wp)
   end function depends_on_end

   pure function row(self, status, before, after)
      class(weakening_law_type), intent(in) :: self
      integer, intent(in) :: status
      type(friction_point_type), intent(in) :: before, after
      type(friction_row_type) :: row
      real(wp) :: fall
      integer :: direction

      if (before%memory(over) > 0.0_wp) then
         row = self%releasing_row(status, before)
         return
      end if
      direction = slip_sign(status)
      fall = slope_of_coefficient(self, before)
      row%slope = -direction*(coefficient(self, before) - fall*direction*(after%slip - before%slip))
      row%stiffness = after%pressure*fall
      row%offset = -row%stiffness*after%slip
   end function row

   !> The increment of f = mu p is mean(mu) dp + mean(p) dmu, exactly.
   pure function secant(self, status, before, after) result(row)
      class(weakening_law_type), intent(in) :: self
      integer, intent(in) :: status
      type(friction_point_type), intent(in) :: before, after
      type(friction_row_type) :: row

      row = self%row(status, before, before)
      if (.not. room(self, before) < huge(1.0_wp)) return
      row%slope = row%slope + 0.5_wp*(before%static - before%kinetic)/self%distance*(after%slip - before%slip)
      row%stiffness = 0.5_wp*(before%pressure + after%pressure)*(before%static - before%kinetic)/self%distance
      row%offset = -slip_sign(status)*self%strength(before) - row%slope*before%pressure - row%stiffness*before%slip
   end function secant

   pure real(wp) function strength(self, point)
      class(weakening_law_type), intent(in) :: self
      type(friction_point_type), intent(in) :: point

      strength = coefficient(self, point)*point%pressure
      if (point%memory(over) > 0.0_wp) strength = point%kinetic*point%pressure + point%memory(over)
   end function strength

   !> mu after the slip of the point.
   pure real(wp) function coefficient(self, point)
      class(weakening_law_type), intent(in) :: self
      type(friction_point_type), intent(in) :: point
      real(wp) :: fraction

      coefficient = point%static
      if (.not. point%kinetic < point%static) return
      fraction = min(point%memory(slipped)/self%distance, 1.0_wp)
      coefficient = (1.0_wp - fraction)*point%static + fraction*point%kinetic
   end function coefficient

   !> Decrease of mu per slip, 1/length; 0 at and beyond the distance.
   pure real(wp) function slope_of_coefficient(self, point) result(fall)
      class(weakening_law_type), intent(in) :: self
      type(friction_point_type), intent(in) :: point

      fall = 0.0_wp
      if (room(self, point) < huge(1.0_wp)) fall = (point%static - point%kinetic)/self%distance
   end function slope_of_coefficient

   !> Remaining slip of a slipping node until its friction no longer decreases, length; huge if it does not decrease.
   pure real(wp) function room(self, point)
      class(weakening_law_type), intent(in) :: self
      type(friction_point_type), intent(in) :: point
      real(wp), parameter :: round_off = 1.0e-12_wp

      room = huge(1.0_wp)
      if (point%kinetic < point%static .and. .not. point%memory(over) > 0.0_wp .and. &
          point%memory(slipped) < self%distance*(1.0_wp - round_off)) room = self%distance - point%memory(slipped)
   end function room

   !> Events: friction no longer decreases; a relaxing node satisfies the law again, (mu - mu_k) p above kinetic friction. Up to
   !> round-off it does where relaxation begins, so that a stress drop that is not needed ends there.
   pure subroutine find_events(self, status, here, there, events)
      class(weakening_law_type), intent(in) :: self
      integer, intent(in) :: status
      type(friction_point_type), intent(in) :: here, there
      type(friction_event_type), intent(out) :: events(most_events)
      real(wp) :: fall, lawful, by_slip, slack

      if (.not. slips(status)) return
      call find_drop_events(self, status, here, there, events)
      if (room(self, here) < huge(1.0_wp)) &
         events(1) = friction_event_type(event_weakened, slack=room(self, here), by_motion=-1.0_wp, is_length=.true.)
      if (.not. here%memory(over) > 0.0_wp) return
      fall = (here%static - here%kinetic)/self%distance
      lawful = max(self%distance - here%memory(slipped), 0.0_wp)*fall
      by_slip = 0.0_wp
      if (lawful > 0.0_wp) by_slip = -fall*here%pressure
      slack = here%memory(over) - lawful*here%pressure
      if (slack <= certified*here%static*here%pressure) slack = 0.0_wp
      events(3) = friction_event_type(event_caught, slack=slack, &
                                      rate=-self%release_rate(here%memory), by_pressure=-lawful, by_motion=-by_slip)
   end subroutine find_events

   pure subroutine pass_event(self, kind, memory)
      class(weakening_law_type), intent(in) :: self
      integer, intent(in) :: kind
      real(wp), intent(inout) :: memory(:)

      if (kind == event_weakened) memory(slipped) = self%distance
      call pass_drop_event(self, kind, memory)
   end subroutine pass_event

   !> Slip beyond the distance does not count.
   pure subroutine remember(self, status, before, after, released, memory)
      class(weakening_law_type), intent(in) :: self
      integer, intent(in) :: status
      type(friction_point_type), intent(in) :: before, after
      real(wp), intent(in) :: released
      real(wp), intent(inout) :: memory(:)

      call remember_drop(self, status, before, after, released, memory)
      memory(slipped) = min(memory(slipped), self%distance)
   end subroutine remember

   !> Whether the node is at its static limit, or between static and kinetic friction.
   pure logical function can_become_unstable(self, status, point)
      class(weakening_law_type), intent(in) :: self
      integer, intent(in) :: status
      type(friction_point_type), intent(in) :: point

      can_become_unstable = in_contact(status) .and. point%pressure > 0.0_wp .and. .not. point%memory(over) > 0.0_wp .and. &
                            point%kinetic < point%static .and. &
                            (abs(point%shear) >= point%static*point%pressure*(1.0_wp - significant) .or. &
                             (slips(status) .and. point%memory(slipped) < self%distance))
   end function can_become_unstable

   pure real(wp) function slip_of_fall(self)
      class(weakening_law_type), intent(in) :: self

      slip_of_fall = self%distance
   end function slip_of_fall

end module mfv_friction_weakening
