!> Dahl's friction, dissertation eq. 3.9 and appendix B: bristles of stiffness sigma, which yield more the nearer the traction is
!> to its limit mu p,
!>
!>     df/ds = sigma (1 - f/(mu p) sgn(s'))^gamma,   f = -tau,
!>
!> so that a node below the limit creeps (partial slip of Table B.1). At the limit it slips as under Coulomb's law. It is also at
!> the limit when mu p decreases below |f|, whichever way it then moves. While mu p increases faster than the bristle load, the
!> bristles take up the load again.
!>
!> For a creeping node tau1 = tau0 - K (s1 - s0) with K at the start of the increment (appendix B) or, in second order, at its
!> midpoint. The line is the tangent of tau1(s1, p1) by this equation at the expected end (Newton), and exact if that is right: the
!> bristle load is solved for at the slip of the guess, whose own load may be far beyond the limit.
module mfv_friction_dahl
   use mfv_friction_law
   use mfv_kinds, only: wp
   use mfv_node_status
   use mfv_strings, only: to_text
   implicit none
   private
   public :: dahl_law

   !> Dahl's traction reaches its limit only after infinite slip; beyond this fraction it counts as at the limit.
   real(wp), parameter :: full_fraction = 1.0_wp - 1.0e-6_wp

   type, extends(friction_law_type) :: dahl_law_type
      !> Stiffness sigma > 0 of the bristles, force/length^3 (traction over slip), and exponent gamma >= 0.
      real(wp) :: stiffness = 0.0_wp, exponent = 1.0_wp
   contains
      procedure :: set_parameter
      procedure :: depends_on_end
      procedure :: has_soft_limit
      procedure :: holding_status
      procedure :: over_stress
      procedure :: row
      procedure :: strength
      procedure :: secant
      procedure :: find_events
      procedure :: defect
      procedure :: wrong_motion
      procedure :: explain_failure
   end type dahl_law_type

   !> The law, without its parameters.
   type(dahl_law_type), parameter :: dahl_law = &
                                     dahl_law_type(name='dahl', needed_keys='stiffness', optional_keys='exponent', &
                                                   is_linear=.false., sticks=.false., has_events=.true., &
                                                   limit_fraction=full_fraction)

contains

   !> See mfv_friction_law, as for all that follow.
   pure subroutine set_parameter(self, key, value)
      class(dahl_law_type), intent(inout) :: self
      character(*), intent(in) :: key
      real(wp), intent(in) :: value

      if (key == 'stiffness') self%stiffness = value
      if (key == 'exponent') self%exponent = value
   end subroutine set_parameter

   pure logical function depends_on_end(self, status, point)
      class(dahl_law_type), intent(in) :: self
      integer, intent(in) :: status
      type(friction_point_type), intent(in) :: point

      depends_on_end = creeps(status)
   end function depends_on_end

   pure logical function has_soft_limit(self)
      class(dahl_law_type), intent(in) :: self

      has_soft_limit = self%exponent > 0.0_wp
   end function has_soft_limit

   pure integer function holding_status(self, direction)
      class(dahl_law_type), intent(in) :: self
      integer, intent(in) :: direction

      holding_status = merge(node_creep_left, node_creep_right, direction < 0)
   end function holding_status

   !> At the limit the stiffness of the bristles depends on the direction of motion.
   elemental real(wp) function over_stress(self, moved, growth)
      class(dahl_law_type), intent(in) :: self
      real(wp), intent(in) :: moved, growth
      real(wp) :: stiffness

      stiffness = self%stiffness
      if (self%exponent > 0.0_wp) &
         stiffness = self%stiffness*merge(1.0_wp - full_fraction, 1.0_wp + full_fraction, moved > 0.0_wp)**self%exponent
      over_stress = stiffness*moved - growth
   end function over_stress

   !> Event: a creeping node reverses its direction, on which its stiffness depends.
   pure subroutine find_events(self, status, here, there, events)
      class(dahl_law_type), intent(in) :: self
      integer, intent(in) :: status
      type(friction_point_type), intent(in) :: here, there
      type(friction_event_type), intent(out) :: events(most_events)
      real(wp) :: change

      if (.not. creeps(status)) return
      change = max(turning(self, here), turning(self, there))
      if (change > 0.0_wp) events(1) = friction_event_type(event_reverse, by_motion=change, tolerance_factor=secant_tolerance)
   end subroutine find_events

   !> Difference of the stiffness of a creeping node between the two directions, force/length^3.
   pure real(wp) function turning(self, point)
      class(dahl_law_type), intent(in) :: self
      type(friction_point_type), intent(in) :: point
      type(friction_row_type) :: right, left

      right = self%row(node_creep_right, point, point)
      left = self%row(node_creep_left, point, point)
      turning = abs(right%stiffness - left%stiffness)
   end function turning

   !> For a creeping node: the residual of its increment, and the effect of a motion against its direction on the traction.
   pure real(wp) function defect(self, status, before, after, explicit)
      class(dahl_law_type), intent(in) :: self
      integer, intent(in) :: status
      type(friction_point_type), intent(in) :: before, after
      logical, intent(in) :: explicit
      type(friction_row_type) :: row

      if (.not. creeps(status)) then
         defect = after%shear + slip_sign(status)*self%strength(after)
         return
      end if
      if (explicit) then
         row = self%row(status, before, before)
      else
         row = self%row(status, before, after)
      end if
      defect = abs(after%shear - row%slope*after%pressure - row%stiffness*after%slip - row%offset) &
               + max(turning(self, before), turning(self, after))*max(-motion_sign(status)*(after%slip - before%slip), 0.0_wp)
   end function defect

   pure real(wp) function wrong_motion(self, moved, growth)
      class(dahl_law_type), intent(in) :: self
      real(wp), intent(in) :: moved, growth

      wrong_motion = -self%over_stress(moved, growth)
   end function wrong_motion

   !> Explains bristles far stiffer than an interval of the surface. Such friction differs from Coulomb's by about the ratio of
   !> these stiffnesses.
   pure function explain_failure(self, interval_stiffness) result(text)
      class(dahl_law_type), intent(in) :: self
      real(wp), intent(in) :: interval_stiffness
      character(len=260) :: text
      real(wp), parameter :: largest = 10.0_wp

      text = ''
      if (self%stiffness > largest*interval_stiffness) &
         text = '; the bristles are too stiff for this mesh: &friction stiffness='//to_text(self%stiffness)// &
                ' should be at most '//to_text(largest*interval_stiffness, 2)//', ten times the contact modulus over the '// &
                "interval; law='coulomb' is the limit of stiff bristles"
   end function explain_failure

   pure function row(self, status, before, after)
      class(dahl_law_type), intent(in) :: self
      integer, intent(in) :: status
      type(friction_point_type), intent(in) :: before, after
      type(friction_row_type) :: row

      if (creeps(status)) then
         row = creeping_row(self, motion_sign(status), before, after)
      else
         row%slope = -slip_sign(status)*before%static*full_fraction
      end if
   end function row

   !> tau = tau0 - K (s - s0).
   pure function secant(self, status, before, after) result(row)
      class(dahl_law_type), intent(in) :: self
      integer, intent(in) :: status
      type(friction_point_type), intent(in) :: before, after
      type(friction_row_type) :: row
      real(wp) :: force, limit, steepness

      if (creeps(status)) then
         call find_stiffness(self, guessed_direction(motion_sign(status), before, after), before, after, force, limit, &
                             row%stiffness, steepness)
         row%stiffness = -row%stiffness
         row%offset = before%shear - row%stiffness*before%slip
      else
         row = self%row(status, before, before)
      end if
   end function secant

   !> The direction of a guess, which is that of the motion, `direction`, or against it. With the stiffness of the wrong one the
   !> equations may have no solution, and the reversal would not be found.
   pure integer function guessed_direction(direction, before, after)
      integer, intent(in) :: direction
      type(friction_point_type), intent(in) :: before, after

      guessed_direction = merge(-direction, direction, direction*(after%slip - before%slip) < 0.0_wp)
   end function guessed_direction

   !> The tangent of tau1(s1, p1) of a creeping node, from F = tau1 - tau0 + K (s1 - s0) = 0.
   pure function creeping_row(self, direction, before, after) result(row)
      class(dahl_law_type), intent(in) :: self
      integer, intent(in) :: direction
      type(friction_point_type), intent(in) :: before, after
      type(friction_row_type) :: row
      type(friction_point_type) :: at_guess
      real(wp) :: force, limit, stiffness, steepness, slipped, by_shear, by_pressure
      integer :: side

      slipped = after%slip - before%slip
      side = guessed_direction(direction, before, after)
      at_guess = after
      at_guess%shear = -side*force_after(self, abs(slipped), -side*before%shear, mean_limit(before, after))
      call find_stiffness(self, side, before, at_guess, force, limit, stiffness, steepness)
      by_shear = 0.0_wp
      by_pressure = 0.0_wp
      if (limit > 0.0_wp) then
         by_shear = 0.5_wp*steepness*abs(slipped)/limit
         by_pressure = 0.5_wp*steepness*before%static*force/limit**2*slipped
      end if
      row%stiffness = -stiffness/(1.0_wp + by_shear)
      row%slope = -by_pressure/(1.0_wp + by_shear)
      row%offset = at_guess%shear - row%stiffness*at_guess%slip - row%slope*at_guess%pressure
   end function creeping_row

   !> Mean of mu p at two points, force/length^2.
   elemental real(wp) function mean_limit(before, after)
      type(friction_point_type), intent(in) :: before, after

      mean_limit = 0.5_wp*before%static*(before%pressure + after%pressure)
   end function mean_limit

   !> The bristle load f1 after a slip s >= 0 in the direction of f, from f0 by the implicit midpoint rule, force/length^2:
   !> f1 - f0 - sigma (1 - (f0 + f1)/(2 limit))^gamma s = 0, which increases with f1. By Newton's method within bounds.
   elemental real(wp) function force_after(self, slip, force, limit) result(after)
      class(dahl_law_type), intent(in) :: self
      real(wp), intent(in) :: slip, force, limit
      integer, parameter :: most_iterations = 100
      real(wp) :: bounds(2), room, stiffness, steepness, residual, next
      integer :: iteration

      after = force
      if (.not. self%exponent > 0.0_wp) then
         after = force + self%stiffness*slip
         return
      end if
      ! A guess without pressure says nothing about the load there: it stays.
      if (.not. limit > 0.0_wp) return
      bounds = [min(force, 2.0_wp*limit - force), max(force, 2.0_wp*limit - force)]
      do iteration = 1, most_iterations
         room = 1.0_wp - 0.5_wp*(force + after)/limit
         call find_slope(self, room, stiffness, steepness)
         residual = after - force - stiffness*slip
         if (residual > 0.0_wp) then
            bounds(2) = after
         else
            bounds(1) = after
         end if
         next = after - residual/(1.0_wp + 0.5_wp*steepness*slip/limit)
         if (next < bounds(1) .or. next > bounds(2)) next = 0.5_wp*(bounds(1) + bounds(2))
         if (abs(next - after) <= spacing(limit)) exit
         after = next
      end do
   end function force_after

   pure real(wp) function strength(self, point)
      class(dahl_law_type), intent(in) :: self
      type(friction_point_type), intent(in) :: point

      strength = point%static*point%pressure*full_fraction
   end function strength

   !> K of eq. B.2 half way between two points and minus its derivative by f/(mu p), force/length^3; and f and mu p there.
   pure subroutine find_stiffness(self, direction, before, after, force, limit, stiffness, steepness)
      class(dahl_law_type), intent(in) :: self
      integer, intent(in) :: direction
      type(friction_point_type), intent(in) :: before, after
      real(wp), intent(out) :: force, limit, stiffness, steepness
      real(wp), parameter :: farthest = 10.0_wp
      real(wp) :: room

      force = -0.5_wp*(before%shear + after%shear)*direction
      limit = mean_limit(before, after)
      room = 1.0_wp
      if (abs(force) < farthest*limit) then
         room = 1.0_wp - force/limit
      else if (limit > 0.0_wp) then
         room = merge(1.0_wp - farthest, 2.0_wp, force > 0.0_wp)
      end if
      call find_slope(self, room, stiffness, steepness)
   end subroutine find_stiffness

   !> K and minus its derivative by f/(mu p), force/length^3, where `room` = 1 - f/(mu p). The law is continued beyond the limit
   !> with its sign (eq. 3.9); beyond the limit against the motion, room > 2, K is that of room = 2. Converged states are not there.
   elemental subroutine find_slope(self, room, stiffness, steepness)
      class(dahl_law_type), intent(in) :: self
      real(wp), intent(in) :: room
      real(wp), intent(out) :: stiffness, steepness
      real(wp), parameter :: least_slope = 0.05_wp, most_slope = 1.0e3_wp

      stiffness = self%stiffness
      steepness = 0.0_wp
      if (.not. self%exponent > 0.0_wp) return
      associate (inside => min(room, 2.0_wp))
         stiffness = self%stiffness*sign(abs(inside)**self%exponent, inside)
         steepness = self%stiffness*self%exponent &
                     *min(max(max(abs(inside), 1.0e-9_wp)**(self%exponent - 1.0_wp), least_slope), most_slope)
      end associate
   end subroutine find_slope

end module mfv_friction_dahl
