!> The first violation: the inequality of dissertation Table 2.1 that is violated first at the given rates per unit of load, and
!> the step to it. Equations 2.3 to 2.5 with rates in place of a trial state. A slip rate in the wrong direction is a violation
!> after a step of zero.
module mfv_event_search
   use mfv_contact_fields, only: contact_fields_type
   use mfv_contact_model, only: contact_model_type
   use mfv_friction_law, only: friction_event_type, most_events
   use mfv_kinds, only: wp
   use mfv_motions, only: motion_approach, motion_shift
   use mfv_node_status
   use mfv_scene, only: integration_explicit
   implicit none
   private
   public :: violations_type, find_violations, status_after

   !> For every node the inequality that is violated first.
   type :: violations_type
      !> The event at the node (see mfv_node_status), `event_none` if there is none, shape (nodes).
      integer, allocatable :: kind(:)
      !> Step to the event, in units of the load parameter, and the same if a traction lacks less to its limit by its round-off,
      !> shape (nodes). Where a load returns to an earlier extreme, all nodes that slipped there reach their limits together.
      real(wp), allocatable :: step(:), soonest(:)
      !> Rate at which the inequality is violated, relative to the largest rate of its type, shape (nodes).
      real(wp), allocatable :: speed(:)
   end type violations_type

contains

   !> All violations at the given rates. `status`: shape (nodes). `events`: those of the friction law, shape (most_events, nodes);
   !> not allocated if there are none. `state`, `rate`: present fields and their rates per unit of the load parameter. Rates below
   !> the fraction `rate_tolerance` of the largest of their type count as zero. `tolerance`: that of the tractions, relative to the
   !> largest. `violations`: its storage is reused.
   subroutine find_violations(model, status, events, state, rate, rate_tolerance, tolerance, violations)
      type(contact_model_type), intent(in) :: model
      integer, intent(in) :: status(:)
      type(friction_event_type), allocatable, intent(in) :: events(:, :)
      type(contact_fields_type), intent(in) :: state, rate
      real(wp), intent(in) :: rate_tolerance, tolerance
      type(violations_type), intent(inout) :: violations
      real(wp) :: traction_scale, motion_scale, mu, full, gap_rate, slip_rate, least_rate, noise(size(status))
      logical :: soft_limit, sticks
      real(wp), parameter :: secant_tolerance = 100.0_wp
      integer :: i, n

      n = size(status)
      if (allocated(violations%kind)) then
         if (size(violations%kind) /= n) deallocate (violations%kind, violations%step, violations%soonest, violations%speed)
      end if
      if (.not. allocated(violations%kind)) &
         allocate (violations%kind(n), violations%step(n), violations%soonest(n), violations%speed(n))
      violations%kind = event_none
      violations%speed = 0.0_wp
      violations%step = huge(1.0_wp)
      violations%soonest = huge(1.0_wp)
      full = 1.0_wp
      sticks = .true.
      soft_limit = .false.
      if (allocated(model%scene%friction%law)) then
         ! Explicit tangents do not determine the limit at first contact; the rates of the corrector do.
         soft_limit = model%scene%friction%law%has_soft_limit() .and. model%scene%method%integration == integration_explicit
         full = model%scene%friction%law%limit_fraction
         sticks = model%scene%friction%law%sticks
      end if
      call find_scales(rate, traction_scale, motion_scale)
      least_rate = rate_tolerance*traction_scale
      noise = max(traction_noise(model, status), tolerance)*max(maxval(abs(state%pressure)), maxval(abs(state%shear)))
      do i = 1, n
         slip_rate = rate%tangential(i) - rate%motion(motion_shift)
         select case (status(i))
         case (node_open)
            gap_rate = rate%normal(i) - rate%motion(motion_approach)
            if (gap_rate < 0.0_wp .and. model%can_touch(i)) &
               call consider(event_close, model%initial_gap(i) - state%motion(motion_approach) + state%normal(i), gap_rate, &
                             motion_scale, 0.0_wp)
            cycle
         case (node_stick, node_creep_right, node_creep_left)
            mu = full*model%static_friction(i)
            if (mu*rate%pressure(i) - abs(rate%shear(i)) < 0.0_wp) then
               if (.not. (soft_limit .and. .not. state%pressure(i) > 0.0_wp .and. rate%pressure(i) > least_rate)) then
                  call consider(event_slip_right, below_limit(mu*state%pressure(i), -state%shear(i)), &
                                mu*rate%pressure(i) + rate%shear(i), max(mu, 1.0_wp)*traction_scale, noise(i))
                  call consider(event_slip_left, below_limit(mu*state%pressure(i), state%shear(i)), &
                                mu*rate%pressure(i) - rate%shear(i), max(mu, 1.0_wp)*traction_scale, noise(i))
               end if
            end if
         case (node_slip_right, node_slip_left)
            if (sticks) then
               if (merge(slip_rate, -slip_rate, status(i) == node_slip_right) < 0.0_wp) &
                  call consider(event_stick, 0.0_wp, -abs(slip_rate), motion_scale, 0.0_wp)
            else
               call consider(event_stick, 0.0_wp, &
                             model%scene%friction%law%over_stress(slip_sign(status(i))*slip_rate, &
                                                                  full*model%static_friction(i)*rate%pressure(i)), &
                             secant_tolerance*traction_scale, 0.0_wp)
            end if
         end select
         if (allocated(events)) call consider_events(i)
         if (rate%pressure(i) < 0.0_wp) call consider(event_open, state%pressure(i), rate%pressure(i), traction_scale, noise(i))
      end do

   contains

      !> Events of the friction law at node `i`.
      subroutine consider_events(i)
         integer, intent(in) :: i
         integer :: k

         do k = 1, most_events
            associate (event => events(k, i))
               if (event%kind == event_none) cycle
               call consider(event%kind, event%slack, event%rate + event%by_pressure*rate%pressure(i) &
                             + event%by_motion*(motion_sign(status(i))*slip_rate), &
                             event%tolerance_factor*merge(motion_scale, traction_scale, event%is_length), &
                             merge(0.0_wp, noise(i), event%is_length))
            end associate
         end do
      end subroutine consider_events

      !> Note a violation of `slack` >= 0 with its `round_off`, which changes at `slack_rate`, if it is earlier than those found so
      !> far.
      subroutine consider(kind, slack, slack_rate, scale, round_off)
         integer, intent(in) :: kind
         real(wp), intent(in) :: slack, slack_rate, scale, round_off
         real(wp) :: step, speed

         if (.not. slack_rate < -rate_tolerance*scale) return
         step = max(slack, 0.0_wp)/(-slack_rate)
         if (step > violations%step(i)) return
         ! No rate is a scale where every node slides at its limit.
         speed = huge(1.0_wp)
         if (scale > -slack_rate*tiny(1.0_wp)) speed = -slack_rate/scale
         if (.not. step < violations%step(i) .and. speed < violations%speed(i)) return
         violations%kind(i) = kind
         violations%step(i) = step
         violations%soonest(i) = max(slack - round_off, 0.0_wp)/(-slack_rate)
         violations%speed(i) = speed
      end subroutine consider
   end subroutine find_violations

   !> Round-off of the traction of each node in contact, relative to the largest: that of displacements, which are those of the
   !> whole contact, times the stiffness of its interval, but at most that of equal intervals; shape (nodes).
   pure function traction_noise(model, status) result(noise)
      type(contact_model_type), intent(in) :: model
      integer, intent(in) :: status(:)
      real(wp) :: noise(size(status))
      real(wp), parameter :: round_off = 4.0_wp*epsilon(1.0_wp)
      logical :: contact(size(status))

      contact = in_contact(status)
      noise = round_off*min(sum(model%width, mask=contact)/model%width, real(count(contact), wp))
   end function traction_noise

   !> What a traction lacks to a limit; none within its round-off, where a node that approaches its limit slowly (Dahl's law) would
   !> stay for ever.
   pure real(wp) function below_limit(limit, traction)
      real(wp), intent(in) :: limit, traction
      real(wp), parameter :: round_off = 8.0_wp*epsilon(1.0_wp)

      below_limit = limit - traction
      if (below_limit <= round_off*limit) below_limit = 0.0_wp
   end function below_limit

   !> The largest rates of tractions and of motions.
   pure subroutine find_scales(rate, traction_scale, motion_scale)
      type(contact_fields_type), intent(in) :: rate
      real(wp), intent(out) :: traction_scale, motion_scale
      integer :: i

      traction_scale = 0.0_wp
      motion_scale = abs(rate%motion(motion_shift))
      do i = 1, size(rate%pressure)
         traction_scale = max(traction_scale, abs(rate%pressure(i)), abs(rate%shear(i)))
         motion_scale = max(motion_scale, abs(rate%normal(i)), abs(rate%tangential(i)), &
                            abs(rate%normal(i) - rate%motion(motion_approach)))
      end do
   end subroutine find_scales

   !> Status of a node with this `status` after an event. `friction`: whether friction acts; `direction`: sign of the slip rate of
   !> a closing node while it was open, 0 for none: it continues to slip that way or, without one, holds (dissertation 2.3.3).
   !> `holding`: the status of a node that holds.
   elemental integer function status_after(event, status, friction, direction, holding)
      integer, intent(in) :: event, status, direction, holding
      logical, intent(in) :: friction

      select case (event)
      case (event_close)
         status_after = node_frictionless
         if (friction .and. direction > 0) status_after = node_slip_right
         if (friction .and. direction < 0) status_after = node_slip_left
         if (friction .and. (direction == 0 .or. holding /= node_stick)) status_after = holding
      case (event_slip_right)
         status_after = node_slip_right
      case (event_slip_left)
         status_after = node_slip_left
      case (event_stick, event_reverse)
         status_after = holding
      case (event_open)
         status_after = node_open
      case default
         status_after = status
      end select
   end function status_after

end module mfv_event_search
