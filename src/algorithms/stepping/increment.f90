!> One increment of the Method of First Violation at fixed statuses: the rates, the length of the increment, and the inequalities
!> that are violated at its end.
!>
!> `event` stepping obtains the rates from the linear solve itself. `nominal` stepping is that of the dissertation (section 2.3):
!> it solves a trial load step dL0, finds the first violation by interpolation (2.3 to 2.5) and solves again there. Both give the
!> same states with different numbers of linear solves. The dissertation finds a wrong slip direction by bisection. Rates are
!> constant at fixed statuses: a wrong direction is wrong from the start, and rates of shorter steps only have more round-off.
!>
!> If friction is not linear (Dahl, weakening), a predictor with tangents is followed by a corrector (Newton) until the friction
!> lines agree with the end of the increment; for Dahl's law this is the implicit midpoint rule, of second order. The difference of
!> predictor and corrector estimates a first-order error. The increment is shortened until it is within the method's
!> `allowed_in_friction`, so that the error of the result decreases with the tolerance, and until the work of friction is as
!> accurate: where bristles are stiffer than the bodies, tractions are accurate long before their work is.
module mfv_increment
   use mfv_contact_fields, only: contact_fields_type
   use mfv_contact_path, only: contact_path_type
   use mfv_contact_system
   use mfv_friction_law, only: friction_event_type, friction_point_type, friction_row_type
   use mfv_inequalities, only: find_violations, violations_type
   use mfv_kinds, only: wp
   use mfv_motions, only: motion_approach, motion_interference, motion_shift
   use mfv_node_status
   use mfv_scene, only: friction_tolerance_part, integration_explicit, stepping_nominal
   use mfv_tolerances, only: certified, rounding, significant, visible
   implicit none
   private
   public :: increment_type, find_increment, has_no_length, shortest_step, tie_tolerance

   !> Steps below `zero_step`, a fraction of increment%unit_step, count as zero; steps that differ by less than the fraction
   !> `least_tie` are tied.
   real(wp), parameter :: zero_step = 1.0e-13_wp, least_tie = certified

   type :: increment_type
      type(response_type) :: response
      type(violations_type) :: violations
      !> What short steps are compared with, as a part of the segment: all of it, or, where it began without load, what is done.
      !> Flat tips touch node after node at loads that are tiny parts of it.
      real(wp) :: unit_step = 1.0_wp
      !> Length as a fraction of the segment (of the stress drop); and whether a violation ends the increment.
      real(wp) :: step = 0.0_wp
      !> Violations that occur up to this step, within their round-off, occur together at its end.
      real(wp) :: reach = 0.0_wp
      logical :: ends_in_event = .false.
      !> Whether the linear system is singular, or the corrector diverges; the increment is then invalid.
      logical :: singular = .false., diverges = .false.
   end type increment_type

contains

   !> Relative difference of steps below which they are tied.
   pure real(wp) function tie_tolerance(path)
      class(contact_path_type), intent(in) :: path

      tie_tolerance = max(least_tie, path%system%tolerance)
   end function tie_tolerance

   !> Steps below this part of the segment count as zero: the tolerance of the linear solver, but at most `least_tie`, since
   !> the first events of a fine mesh are close to each other.
   pure real(wp) function shortest_step(path, unit_step)
      class(contact_path_type), intent(in) :: path
      real(wp), intent(in) :: unit_step

      shortest_step = unit_step*max(zero_step, min(path%system%tolerance, least_tie))
   end function shortest_step

   !> Whether an increment has no length, within the tolerance.
   pure logical function has_no_length(path, increment)
      class(contact_path_type), intent(in) :: path
      type(increment_type), intent(in) :: increment

      has_no_length = increment%step <= shortest_step(path, increment%unit_step)
   end function has_no_length

   !> Find an increment. `constraints`: from contact_path_type%find_constraints. `left`: the rest of the segment (1 in a stress
   !> drop). `relaxing`: whether over-stress relaxes at a fixed load. `rate_tolerance`: rates below this fraction of the largest
   !> count as zero. `increment`: its storage is reused.
   subroutine find_increment(path, constraints, left, relaxing, rate_tolerance, increment)
      class(contact_path_type), intent(inout) :: path
      type(constraints_type), intent(in) :: constraints
      real(wp), intent(in) :: left, rate_tolerance
      logical, intent(in) :: relaxing
      type(increment_type), intent(inout) :: increment

      increment%step = 0.0_wp
      increment%reach = 0.0_wp
      increment%ends_in_event = .false.
      increment%singular = .false.
      increment%diverges = .false.
      if (path%model%scene%method%stepping == stepping_nominal) then
         call nominal_increment(path, constraints, min(left, path%model%scene%method%load_step), relaxing, rate_tolerance, &
                                increment)
      else
         call path%system%solve(path%model, constraints, path%state%fields, increment%response, &
                                increment%singular)
         if (increment%singular) return
         call search(path, rate_tolerance, left, increment)
         if (depends_on_end(path)) call integrate_friction(path, constraints, left, relaxing, rate_tolerance, increment)
      end if
   end subroutine find_increment

   !> Whether the friction line of some node depends on the end of the increment.
   logical function depends_on_end(path)
      class(contact_path_type), intent(in) :: path
      integer :: i

      depends_on_end = .false.
      if (.not. path%model%tangential) return
      associate (law => path%model%scene%friction%law)
         if (law%is_linear) return
         do i = 1, size(path%state%status)
            depends_on_end = law%depends_on_end(path%state%status(i), path%point(i, path%state%fields))
            if (depends_on_end) return
         end do
      end associate
   end function depends_on_end

   !> Violations from the rates, and the step to the first of them, at most `longest`.
   subroutine search(path, rate_tolerance, longest, increment)
      class(contact_path_type), intent(in) :: path
      real(wp), intent(in) :: rate_tolerance, longest
      type(increment_type), intent(inout) :: increment
      ! A step that is never reached; twice its value does not overflow.
      real(wp), parameter :: never = 0.25_wp*huge(1.0_wp)
      type(friction_event_type), allocatable :: events(:, :)
      real(wp) :: first

      call path%find_events(path%state%fields%plus(longest, increment%response%rate), events)
      call find_violations(path%model, path%state%status, events, path%state%fields, &
                           increment%response%rate, max(rate_tolerance, path%system%tolerance), path%system%tolerance, &
                           increment%violations)
      first = min(minval(increment%violations%step), never)
      increment%step = min(first, longest)
      increment%reach = first*(1.0_wp + tie_tolerance(path)) + shortest_step(path, increment%unit_step)
      increment%ends_in_event = first*(1.0_wp - tie_tolerance(path)) - shortest_step(path, increment%unit_step) <= longest
   end subroutine search

   !> Integrate friction that is not linear over an increment, with a controlled error or explicitly.
   subroutine integrate_friction(path, constraints, left, relaxing, rate_tolerance, increment)
      class(contact_path_type), intent(inout) :: path
      type(constraints_type), intent(in) :: constraints
      real(wp), intent(in) :: left, rate_tolerance
      logical, intent(in) :: relaxing
      type(increment_type), intent(inout) :: increment
      integer, parameter :: most_attempts = 40
      real(wp), parameter :: safety = 0.9_wp, most_growth = 4.0_wp, least_shrink = 0.1_wp, first_trial = 1.0e-3_wp, &
                             shortest = 1.0e-9_wp
      type(increment_type) :: predicted
      type(contact_fields_type) :: guess, after
      real(wp) :: length, error, error_of_work, change, tolerance
      logical :: agrees, accepted, touched, misled, law_sticks
      integer :: attempt

      if (path%model%scene%method%integration == integration_explicit .and. &
          .not. path%model%scene%friction%law%sticks) then
         call search(path, rate_tolerance, min(left, path%model%scene%method%load_step), increment)
         return
      end if
      ! The tangent is undefined at first contact; the traction follows from the increment itself.
      touched = any(creeps(path%state%status) .and. .not. path%state%fields%pressure > 0.0_wp)
      if (has_no_length(path, increment) .and. .not. touched) return
      if (.not. path%trial > 0.0_wp) path%trial = first_trial
      tolerance = path%model%scene%method%allowed_in_friction()*part_of_segment(path, increment%response%rate)
      law_sticks = path%model%scene%friction%law%sticks
      predicted = increment
      length = min(left, path%trial)
      do attempt = 1, most_attempts
         increment = predicted
         call correct(path, constraints, length, relaxing, rate_tolerance, increment, agrees)
         if (increment%singular) return
         guess = path%state%fields%plus(increment%step, predicted%response%rate)
         call guess_touching(path, guess)
         after = path%state%fields%plus(increment%step, increment%response%rate)
         error = difference(path, guess, after, maxval(abs(increment%response%rate%pressure)))
         error_of_work = missed_work(path, after, increment)/(path%model%scene%method%allowed_in_friction()/friction_tolerance_part)
         change = most_growth
         if (error > 0.0_wp) change = min(most_growth, safety*sqrt(tolerance/error))
         if (error_of_work > 0.0_wp) change = min(change, safety/sqrt(error_of_work))
         if (.not. agrees) change = min(change, 0.25_wp)
         ! The tangents allow a step: an event before any is due to the length.
         misled = agrees .and. law_sticks .and. has_no_length(path, increment) .and. .not. (touched .or. length < shortest)
         if (misled) change = least_shrink
         accepted = agrees .and. error <= tolerance .and. error_of_work <= 1.0_wp .and. .not. misled
         if (accepted .or. length < shortest) exit
         ! The error is that of the step, and an event may have ended this far before the length.
         if (agrees .and. .not. has_no_length(path, increment)) length = min(length, increment%step)
         length = length*max(change, least_shrink)
      end do
      increment%diverges = .not. accepted
      if (has_no_length(path, increment)) return
      if (was_cut_too_short(increment, length)) then
         path%trial = max(increment%step*change, 10*shortest)
         return
      end if
      ! An increment cut short by an event is no reason for a shorter next one.
      length = max(length, increment%step)*max(change, least_shrink)
      path%trial = max(length, merge(path%trial, 10*shortest, attempt == 1))
   end subroutine integrate_friction

   !> Error of the work of creeping nodes over an increment to the fields `after`, relative to its part of what they dissipate over
   !> the whole segment at the present rates: (1 - K/sigma) f ds with the stiffness K = df/ds and its value sigma at f = 0. The work
   !> on straight lines lacks (slip)^2/12 times the change of K (Euler and Maclaurin), which the law knows at both ends.
   real(wp) function missed_work(path, after, increment) result(missed)
      class(contact_path_type), intent(in) :: path
      type(contact_fields_type), intent(in) :: after
      type(increment_type), intent(in) :: increment
      type(friction_point_type) :: points(3)
      type(friction_row_type) :: rows(3)
      real(wp) :: slip(size(path%state%status)), work, force, largest
      integer :: i, j

      slip = increment%response%rate%slip()
      missed = 0.0_wp
      work = 0.0_wp
      if (increment%step*maxval(abs(slip)) <= certified*size_of_displacements(after)) return
      do i = 1, size(slip)
         if (.not. creeps(path%state%status(i))) cycle
         points = [path%point(i, path%state%fields), path%point(i, after), path%point(i, after)]
         points(3)%shear = 0.0_wp
         rows = [(path%model%scene%friction%law%row(path%state%status(i), points(j), points(j)), j=1, size(rows))]
         associate (stiffness => rows%stiffness, width => path%model%width(i))
            force = maxval(abs(points%shear))
            largest = max(force, 0.5_wp*abs(increment%response%rate%shear(i)))
            if (.not. force > 0.0_wp) cycle
            missed = missed + width*(increment%step*slip(i))**2*abs(stiffness(2) - stiffness(1))/12.0_wp
            work = work + width*abs(slip(i))*largest*min(maxval(abs(stiffness(:2) - stiffness(3)))/abs(stiffness(3)) &
                                                         *largest/force, 1.0_wp)
         end associate
      end do
      if (missed > 0.0_wp) missed = missed/max(increment%step*work, tiny(1.0_wp))
   end function missed_work

   !> The largest displacement or motion of some fields, length.
   pure real(wp) function size_of_displacements(fields) result(largest)
      type(contact_fields_type), intent(in) :: fields

      largest = max(maxval(abs(fields%tangential)), maxval(abs(fields%normal)), &
                    maxval(abs(fields%motion([motion_approach, motion_shift, motion_interference]))))
   end function size_of_displacements

   !> Whether an increment of the trial length `length` was shortened by a violation that, with the rates of the shorter one, is far
   !> beyond its end. Friction over the longer one differed too much: others of this length would end too early again and again.
   pure logical function was_cut_too_short(increment, length)
      type(increment_type), intent(in) :: increment
      real(wp), intent(in) :: length
      real(wp), parameter :: far = 2.0_wp

      was_cut_too_short = .not. increment%ends_in_event .and. &
                          min(length, minval(increment%violations%step)) > far*increment%step
   end function was_cut_too_short

   !> Friction lines that are right at the end of the increment; a violation shortens it. `agrees`: whether they were found. The
   !> rates are those of the straight line from start to end.
   subroutine correct(path, constraints, length, relaxing, rate_tolerance, increment, agrees)
      class(contact_path_type), intent(inout) :: path
      type(constraints_type), intent(in) :: constraints
      real(wp), intent(in) :: length, rate_tolerance
      logical, intent(in) :: relaxing
      type(increment_type), intent(inout) :: increment
      logical, intent(out) :: agrees
      integer, parameter :: most_passes = 12
      real(wp), parameter :: tolerance_factor = 10.0_wp
      real(wp) :: same
      type(constraints_type) :: secants
      type(contact_fields_type) :: after
      real(wp) :: step
      integer :: pass

      step = length
      same = max(significant, tolerance_factor*path%system%tolerance)
      secants = constraints
      after = path%state%fields%plus(step, increment%response%rate)
      call guess_touching(path, after)
      do pass = 1, most_passes
         call find_end(path, constraints, step, relaxing, after, agrees)
         if (.not. agrees) return
         call path%set_rows(secants, relaxing, after, secants=.true.)
         call path%system%solve(path%model, secants, path%state%fields, increment%response, increment%singular)
         if (increment%singular) return
         call search(path, rate_tolerance, step, increment)
  if (abs(increment%step - step) <= same*step + shortest_step(path, increment%unit_step) .or. has_no_length(path, increment)) return
         step = increment%step
         after = path%state%fields%plus(step, increment%response%rate)
      end do
      agrees = .false.
   end subroutine correct

   !> Newton's iteration for the fields `after` a step, which contain a first guess. `converges`: whether it converged.
   subroutine find_end(path, constraints, step, relaxing, after, converges)
      class(contact_path_type), intent(inout) :: path
      type(constraints_type), intent(in) :: constraints
      real(wp), intent(in) :: step
      logical, intent(in) :: relaxing
      type(contact_fields_type), intent(inout) :: after
      logical, intent(out) :: converges
      integer, parameter :: most_iterations = 50
      real(wp), parameter :: close_enough = 1.0e-12_wp
      type(constraints_type) :: lines
      type(response_type) :: response
      type(contact_fields_type) :: before
      logical :: singular
      integer :: iteration

      converges = .false.
      lines = constraints
      do iteration = 1, most_iterations
         before = after
         call path%set_rows(lines, relaxing, after)
         call path%system%solve(path%model, lines, path%state%fields, response, singular)
         if (singular) return
         after = response%state%plus(step, response%rate)
         converges = difference(path, before, after, 0.0_wp) <= max(close_enough, path%system%tolerance) .and. &
                     have_same_slip(path, before, after)
         if (converges) return
      end do
   end subroutine find_end

   !> Whether two fields have the same slip since the start of the increment, to a part of it or to the rounding errors of the
   !> displacements. (Where all other nodes slide, equilibrium gives the traction of the last one, and the slip follows from its law
   !> alone.)
   logical function have_same_slip(path, one, other)
      class(contact_path_type), intent(in) :: path
      type(contact_fields_type), intent(in) :: one, other
      real(wp) :: change

      associate (start => path%state%fields%slip())
         change = maxval(abs(other%slip() - start))
      end associate
      have_same_slip = maxval(abs(one%slip() - other%slip())) <= max(certified, path%system%tolerance)*change + &
                       rounding*size_of_displacements(other)
   end function have_same_slip

   !> A guess for creeping nodes that have just touched: at most half the friction limit.
   subroutine guess_touching(path, fields)
      class(contact_path_type), intent(in) :: path
      type(contact_fields_type), intent(inout) :: fields
      real(wp), parameter :: half = 0.5_wp

      where (creeps(path%state%status) .and. .not. path%state%fields%pressure > 0.0_wp) &
         fields%shear = sign(min(abs(fields%shear), half*path%model%static_friction*max(fields%pressure, 0.0_wp)), fields%shear)
   end subroutine guess_touching

   !> Change of the shear over a whole segment at its present rate, relative to the largest traction so far or at the end of the
   !> segment, at most 1. Errors relative to it keep the dissipation of small cycles, whose area is of third order in their shear.
   pure real(wp) function part_of_segment(path, rate)
      class(contact_path_type), intent(in) :: path
      type(contact_fields_type), intent(in) :: rate
      real(wp), parameter :: least = 1.0e-4_wp
      real(wp) :: scale, change

      scale = max(path%certificate%traction_scale, maxval(abs(rate%pressure)))
      change = maxval(abs(rate%shear))
      part_of_segment = 1.0_wp
      if (change < scale) part_of_segment = max(change/scale, least)
   end function part_of_segment

   !> Difference of the tractions of two fields, relative to the largest traction so far, of the second one, or `elsewhere`.
   pure real(wp) function difference(path, one, other, elsewhere)
      class(contact_path_type), intent(in) :: path
      type(contact_fields_type), intent(in) :: one, other
      real(wp), intent(in) :: elsewhere
      real(wp) :: scale

      scale = max(path%certificate%traction_scale, maxval(abs(other%pressure)), elsewhere)
      difference = max(maxval(abs(one%shear - other%shear)), maxval(abs(one%pressure - other%pressure)))
      if (scale > 0.0_wp) difference = difference/scale
   end function difference

   !> A nominal load step: a trial state, and the first violation on the line to it.
   subroutine nominal_increment(path, constraints, length, relaxing, rate_tolerance, increment)
      class(contact_path_type), intent(inout) :: path
      type(constraints_type), intent(in) :: constraints
      real(wp), intent(in) :: length, rate_tolerance
      logical, intent(in) :: relaxing
      type(increment_type), intent(inout) :: increment
      real(wp), parameter :: shortest_secant = visible
      real(wp) :: longest, trial

      longest = merge(1.0_wp, length, relaxing)
      ! The rest of a segment may be too short for rates that are differences.
      trial = max(longest, path%model%scene%method%load_step, shortest_secant)
      call solve_trial(path, constraints, trial, increment)
      if (increment%singular) return
      call search(path, rate_tolerance, longest, increment)
      if (increment%step < shortest_secant .or. .not. increment%ends_in_event) return
      if (increment%step < trial) call solve_trial(path, constraints, increment%step, increment)
   end subroutine nominal_increment

   !> The state after a step at fixed statuses; the rates are differences.
   subroutine solve_trial(path, constraints, step, increment)
      class(contact_path_type), intent(inout) :: path
      type(constraints_type), intent(in) :: constraints
      real(wp), intent(in) :: step
      type(increment_type), intent(inout) :: increment
      type(constraints_type) :: target
      integer :: i

      target = constraints
      target%load%value = target%load%value + step*target%load%rate
      do i = 1, size(target%row)
         target%row(i)%offset = target%row(i)%offset + step*target%offset_rate(i)
      end do
      call path%system%solve(path%model, target, path%state%fields, increment%response, increment%singular)
      if (.not. increment%singular) call set_secant_rates(path, increment%response%state, step, increment%response)
   end subroutine solve_trial

   !> Rates of the straight line from the present fields to the fields `after` a step.
   subroutine set_secant_rates(path, after, step, response)
      class(contact_path_type), intent(in) :: path
      type(contact_fields_type), intent(in) :: after
      real(wp), intent(in) :: step
      type(response_type), intent(inout) :: response
      type(contact_fields_type) :: change

      change = after%plus(-1.0_wp, path%state%fields)
      response%rate = scaled(change, 1.0_wp/step)
      response%state = path%state%fields
   end subroutine set_secant_rates

   !> The fields times a factor.
   pure function scaled(fields, factor) result(product)
      type(contact_fields_type), intent(in) :: fields
      real(wp), intent(in) :: factor
      type(contact_fields_type) :: product

      product = fields%plus(factor - 1.0_wp, fields)
   end function scaled

end module mfv_increment
