!> Derivatives of the state with respect to parameters across one increment of the Method of First Violation, and at the end of a
!> segment without friction; see mfv_derivatives and docs/theory.md. One linear solve for every parameter, with the statuses of the
!> increment.
module mfv_derivative_increments
   use mfv_contact_fields, only: contact_fields_type
   use mfv_contact_path, only: contact_path_type, iteration_type, segment_type
   use mfv_contact_system
   use mfv_derivatives, only: explicit_derivatives, explicit_type
   use mfv_error, only: error_type
   use mfv_increment, only: increment_type
   use mfv_kinds, only: wp
   use mfv_motions, only: motion_count, motion_approach, motion_shift, control_force
   use mfv_node_status
   use mfv_tolerances, only: visible
   implicit none
   private
   public :: differentiate_increment, differentiate_end

   !> What determines the increment: the constraints at its end, and the fraction of the segment there.
   type :: setting_type
      type(constraints_type) :: constraints
      real(wp) :: done = 0.0_wp
   end type setting_type

contains

   !> After an increment to the fraction `done` of the segment, before statuses change. `constraints`: those at its start.
   !> `at_end`: whether it ends with the segment, else at an event.
   subroutine differentiate_increment(path, segment, constraints, increment, done, at_end)
      type(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      type(constraints_type), intent(in) :: constraints
      type(increment_type), intent(in) :: increment
      real(wp), intent(in) :: done
      logical, intent(in) :: at_end
      type(setting_type) :: setting
      type(contact_fields_type) :: change
      type(explicit_type) :: explicit
      logical :: singular, separates
      integer :: k

      if (path%derivatives%fault /= '') return
      setting%constraints = constraints
      setting%constraints%load%value = setting%constraints%load%value + increment%step*setting%constraints%load%rate
      setting%done = segment%from + (segment%to - segment%from)*done
      do k = 1, size(path%parameters)
         call explicit_derivatives(path%parameters(k), path%model, path%state%fields, explicit)
         call differentiate(path, segment, setting, explicit, k, change, singular)
         if (singular) then
            call path%derivatives%fail('the linear system of an increment is singular')
            return
         end if
         separates = .false.
         if (increment%ends_in_event .and. .not. at_end) call displace_event(path, increment, explicit, change, separates)
         if (separates) path%derivatives%separated(k) = path%derivatives%separated(k) + 1
         call find_forces(path, explicit, change)
         associate (dissipation => path%derivatives%dissipation(k))
            dissipation = dissipation + dissipated(path, explicit, path%derivatives%fields(k), change)
         end associate
         path%derivatives%fields(k) = change
      end do
   end subroutine differentiate_increment

   !> At the end of a segment without friction, which has no memory: with the statuses there.
   subroutine differentiate_end(path, segment)
      type(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      type(iteration_type) :: iteration
      type(setting_type) :: setting
      type(contact_fields_type) :: change
      type(explicit_type) :: explicit
      type(error_type), allocatable :: error
      logical :: ready, singular
      integer :: k

      if (path%derivatives%fault /= '') return
      setting%done = 1.0_wp
      call path%find_constraints(segment, 1.0_wp, iteration, setting%constraints, ready, error)
      singular = allocated(error) .or. .not. ready
      do k = 1, size(path%parameters)
         if (singular) exit
         call explicit_derivatives(path%parameters(k), path%model, path%state%fields, explicit)
         call differentiate(path, segment, setting, explicit, k, change, singular)
         if (singular) exit
         call find_forces(path, explicit, change)
         path%derivatives%fields(k) = change
      end do
      if (singular) call path%derivatives%fail('the linear system at the end of a step is singular')
   end subroutine differentiate_end

   !> The derivative of the fields with respect to parameter `k` at a fixed fraction of the segment and fixed statuses. `path` is at
   !> the end of the increment, its derivatives still at the start. The counts and tolerances of the solver are left as they
   !> were, so that the path does not depend on whether it is differentiated.
   subroutine differentiate(path, segment, setting, explicit, k, change, singular)
      type(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      type(setting_type), intent(in) :: setting
      type(explicit_type), intent(in) :: explicit
      integer, intent(in) :: k
      type(contact_fields_type), intent(out) :: change
      logical, intent(out) :: singular
      type(constraints_type) :: lines
      type(response_type) :: response
      real(wp) :: tolerance(2)
      integer :: i, solves

      lines = setting%constraints
      lines%kind = rates_of_derivatives
      associate (derivatives => path%derivatives, fields => path%state%fields)
         do i = 1, motion_count
            if (lines%load(i)%control /= segment%load(i)%control) then
               ! Nothing determines this motion: it is held where it was.
               lines%load(i)%rate = derivatives%fields(k)%motion(i)
            else
               lines%load(i)%rate = derivatives%start(i, k) + setting%done*(derivatives%goal(i, k) - derivatives%start(i, k))
               if (lines%load(i)%control == control_force) lines%load(i)%rate = lines%load(i)%rate - explicit%resultant(i)
            end if
         end do
         lines%gap_rate = -explicit%gap
         lines%slip_rate = derivatives%stuck_slip(:, k) - explicit%slip
         lines%offset_rate = -slip_sign(lines%status)*explicit%friction*fields%pressure
         solves = path%system%solves
         tolerance = [path%system%tolerance, path%system%rate_tolerance]
         call path%system%solve(path%model, lines, fields, response, singular)
         derivatives%solves = derivatives%solves + path%system%solves - solves
      end associate
      path%system%solves = solves
      path%system%tolerance = tolerance(1)
      path%system%rate_tolerance = tolerance(2)
      if (singular) return
      change = response%rate
      change%normal = change%normal + explicit%gap
      change%tangential = change%tangential + explicit%slip
   end subroutine differentiate

   !> Add what the displacement of the event at the end of an increment changes: the fields of the increment are continued to where
   !> the inequality is violated now. Nodes whose inequalities are violated together may be displaced by different steps: the mean
   !> is taken, and for the slip of each closing node its own step. `separates`: whether the steps differ.
   subroutine displace_event(path, increment, explicit, change, separates)
      type(contact_path_type), intent(in) :: path
      type(increment_type), intent(in) :: increment
      type(explicit_type), intent(in) :: explicit
      type(contact_fields_type), intent(inout) :: change
      logical, intent(out) :: separates
      real(wp) :: step(size(increment%violations%step)), mean
      logical :: ends(size(increment%violations%step))
      integer :: i

      associate (rate => increment%response%rate, violations => increment%violations)
         ends = violations%soonest <= increment%reach
         step = 0.0_wp
         do i = 1, size(step)
            if (ends(i)) step(i) = displacement(path, increment, explicit, change, i)
         end do
         mean = sum(step)/count(ends)
         separates = any(ends .and. abs(step - mean) > visible*maxval(abs(step)))
         where (ends .and. violations%kind == event_close) &
            change%tangential = change%tangential + (step - mean)*(rate%tangential - rate%motion(motion_shift))
         call change%move(mean, rate)
      end associate
   end subroutine displace_event

   !> The derivative of the step to the event at node `i`: its inequality is satisfied as an equality before and after.
   pure real(wp) function displacement(path, increment, explicit, change, i)
      type(contact_path_type), intent(in) :: path
      type(increment_type), intent(in) :: increment
      type(explicit_type), intent(in) :: explicit
      type(contact_fields_type), intent(in) :: change
      integer, intent(in) :: i
      real(wp) :: side, slack, slack_rate

      associate (rate => increment%response%rate, mu => path%model%static_friction(i), pressure => path%state%fields%pressure(i))
         select case (increment%violations%kind(i))
         case (event_close)
            slack = change%normal(i) - change%motion(motion_approach)
            slack_rate = rate%normal(i) - rate%motion(motion_approach)
         case (event_open)
            slack = change%pressure(i)
            slack_rate = rate%pressure(i)
         case default
            side = merge(1.0_wp, -1.0_wp, increment%violations%kind(i) == event_slip_right)
            slack = explicit%friction(i)*pressure + mu*change%pressure(i) + side*change%shear(i)
            slack_rate = mu*rate%pressure(i) + side*rate%shear(i)
         end select
      end associate
      displacement = -slack/slack_rate
   end function displacement

   !> The derivatives of the forces from those of the tractions.
   subroutine find_forces(path, explicit, change)
      type(contact_path_type), intent(in) :: path
      type(explicit_type), intent(in) :: explicit
      type(contact_fields_type), intent(inout) :: change
      integer :: i

      do i = 1, motion_count
         change%force(i) = path%model%resultant(i, change%pressure, change%shear) + explicit%resultant(i)
      end do
   end subroutine find_forces

   !> The derivative of what an increment dissipates, -sum(width*(tau before + tau after)/2*(slip)), from those of the fields before
   !> and after it.
   real(wp) function dissipated(path, explicit, before, after)
      type(contact_path_type), intent(in) :: path
      type(explicit_type), intent(in) :: explicit
      type(contact_fields_type), intent(in) :: before, after
      real(wp), dimension(size(after%shear)) :: slipped, shear

      associate (old => path%before%fields, new => path%state%fields)
         slipped = new%slip() - old%slip()
         shear = 0.5_wp*(old%shear + new%shear)
         dissipated = -path%model%force(0.5_wp*(before%shear + after%shear)*slipped + shear*(after%slip() - before%slip())) - &
                      dot_product(explicit%width, shear*slipped)
      end associate
   end function dissipated

end module mfv_derivative_increments
