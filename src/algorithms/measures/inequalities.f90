!> The inequalities of dissertation Table 2.1 at a node, each by the event at which it is first violated, and the status that
!> follows. The search for the first violation, large increments, the conventional algorithm, the rates of all nodes at once and
!> the certificate take them from here; friction laws add their own events (mfv_friction_law).
!>
!> The first violation: the inequality that is violated first at the given rates per unit of load, and the step to it. Equations 2.3
!> to 2.5 with rates in place of a trial state. A slip rate in the wrong direction is a violation after a step of zero.
module mfv_inequalities
   use mfv_contact_fields, only: contact_fields_type
   use mfv_contact_model, only: contact_model_type
   use mfv_friction_law, only: friction_event_type, most_events, secant_tolerance
   use mfv_kinds, only: wp
   use mfv_motions, only: motion_approach, motion_shift
   use mfv_node_status
   use mfv_scene, only: integration_explicit
   implicit none
   private
   public :: inequalities, is_required, slack, status_after, violations_type, find_violations

   !> The events of the inequalities, in the order in which the conventional algorithm repairs them (dissertation Fig. 2.2).
   integer, parameter :: inequalities(5) = [event_close, event_open, event_slip_right, event_slip_left, event_stick]

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

   !> Whether a status requires the inequality of an event.
   elemental logical function is_required(event, status)
      integer, intent(in) :: event, status

      select case (event)
      case (event_close)
         is_required = .not. in_contact(status)
      case (event_open)
         is_required = in_contact(status)
      case (event_slip_right, event_slip_left)
         is_required = holds(status)
      case (event_stick)
         is_required = slips(status)
      case default
         is_required = .false.
      end select
   end function is_required

   !> What a node lacks until the inequality of an event is violated, or its rate: negative where it is. `gap`: length; `pressure`,
   !> `shear` and the friction `limit`, force/length^2; `moved`: slip in the direction of the status, length.
   elemental real(wp) function slack(event, gap, pressure, shear, limit, moved)
      integer, intent(in) :: event
      real(wp), intent(in) :: gap, pressure, shear, limit, moved

      select case (event)
      case (event_close)
         slack = gap
      case (event_open)
         slack = pressure
      case (event_slip_right)
         slack = limit + shear
      case (event_slip_left)
         slack = limit - shear
      case (event_stick)
         slack = moved
      case default
         slack = huge(slack)
      end select
   end function slack

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
      real(wp) :: traction_scale, motion_scale, limit_fraction, full, slip_rate, least_rate, uncertain(size(status))
      logical :: soft_limit, sticks
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
      uncertain = max(traction_tolerance(model, status), tolerance)*max(maxval(abs(state%pressure)), maxval(abs(state%shear)))
      do i = 1, n
         limit_fraction = full*model%static_friction(i)
         slip_rate = rate%tangential(i) - rate%motion(motion_shift)
         select case (status(i))
         case (node_open)
            if (model%can_touch(i)) call consider_inequality(event_close, motion_scale, 0.0_wp)
            cycle
         case (node_stick, node_creep_right, node_creep_left)
            if (.not. (soft_limit .and. .not. state%pressure(i) > 0.0_wp .and. rate%pressure(i) > least_rate)) then
               call consider_inequality(event_slip_right, max(limit_fraction, 1.0_wp)*traction_scale, uncertain(i))
               call consider_inequality(event_slip_left, max(limit_fraction, 1.0_wp)*traction_scale, uncertain(i))
            end if
         case (node_slip_right, node_slip_left)
            if (sticks) then
               call consider_inequality(event_stick, motion_scale, 0.0_wp)
            else
               call consider(event_stick, 0.0_wp, &
                             model%scene%friction%law%over_stress(slip_sign(status(i))*slip_rate, &
                                                                  limit_fraction*rate%pressure(i)), &
                             secant_tolerance*traction_scale, 0.0_wp)
            end if
         end select
         if (allocated(events)) call consider_events()
         call consider_inequality(event_open, traction_scale, uncertain(i))
      end do

   contains

      !> An inequality of node `i`, at present and by its rate. A node slips the right way until its rate turns.
      subroutine consider_inequality(event, scale, round_off)
         integer, intent(in) :: event
         real(wp), intent(in) :: scale, round_off
         real(wp) :: slack_rate, present_slack

         slack_rate = slack(event, rate%normal(i) - rate%motion(motion_approach), rate%pressure(i), rate%shear(i), &
                            limit_fraction*rate%pressure(i), slip_sign(status(i))*slip_rate)
         if (.not. slack_rate < 0.0_wp) return
         present_slack = slack(event, model%initial_gap(i) - state%motion(motion_approach) + state%normal(i), state%pressure(i), &
                               state%shear(i), limit_fraction*state%pressure(i), 0.0_wp)
         if (any(event == [event_slip_right, event_slip_left])) &
            present_slack = beyond_round_off(present_slack, limit_fraction*state%pressure(i))
         call consider(event, present_slack, slack_rate, scale, round_off)
      end subroutine consider_inequality

      !> Events of the friction law at node `i`.
      subroutine consider_events()
         integer :: k

         do k = 1, most_events
            associate (event => events(k, i))
               if (event%kind == event_none) cycle
               call consider(event%kind, event%slack, event%rate + event%by_pressure*rate%pressure(i) &
                             + event%by_motion*(motion_sign(status(i))*slip_rate), &
                             event%tolerance_factor*merge(motion_scale, traction_scale, event%is_length), &
                             merge(0.0_wp, uncertain(i), event%is_length))
            end associate
         end do
      end subroutine consider_events

      !> Note the violation of an inequality of node `i` with this slack, its `round_off` and its rate, if it is earlier than those
      !> found so far.
      subroutine consider(kind, present_slack, slack_rate, scale, round_off)
         integer, intent(in) :: kind
         real(wp), intent(in) :: present_slack, slack_rate, scale, round_off
         real(wp) :: step, speed

         if (.not. slack_rate < -rate_tolerance*scale) return
         step = max(present_slack, 0.0_wp)/(-slack_rate)
         if (step > violations%step(i)) return
         ! No rate is a scale where every node slides at its limit.
         speed = huge(1.0_wp)
         if (scale > -slack_rate*tiny(1.0_wp)) speed = -slack_rate/scale
         if (.not. step < violations%step(i) .and. speed < violations%speed(i)) return
         violations%kind(i) = kind
         violations%step(i) = step
         violations%soonest(i) = max(present_slack - round_off, 0.0_wp)/(-slack_rate)
         violations%speed(i) = speed
      end subroutine consider
   end subroutine find_violations

   !> Round-off of the traction of each node in contact, relative to the largest: that of displacements, which are those of the
   !> whole contact, times the stiffness of its interval, but at most that of equal intervals; shape (nodes).
   pure function traction_tolerance(model, status) result(tolerance)
      type(contact_model_type), intent(in) :: model
      integer, intent(in) :: status(:)
      real(wp) :: tolerance(size(status))
      real(wp), parameter :: round_off = 4.0_wp*epsilon(1.0_wp)
      logical :: contact(size(status))

      contact = in_contact(status)
      tolerance = round_off*min(sum(model%width, mask=contact)/model%width, real(count(contact), wp))
   end function traction_tolerance

   !> What a traction lacks to a limit; none within its round-off, where a node that approaches its limit slowly (Dahl's law) would
   !> stay for ever.
   pure real(wp) function beyond_round_off(present_slack, limit)
      real(wp), intent(in) :: present_slack, limit
      real(wp), parameter :: round_off = 8.0_wp*epsilon(1.0_wp)

      beyond_round_off = merge(0.0_wp, present_slack, present_slack <= round_off*limit)
   end function beyond_round_off

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

end module mfv_inequalities
