!> The Method of First Violation (dissertation section 2.3).
!>
!> At fixed statuses everything is linear in the load. One solve gives the state and its rates per unit of load. The load advances
!> exactly to the first inequality that would be violated, that node changes its status, and so on. Every state between events
!> satisfies every equality and inequality as well.
!>
!> Several changes can occur at one load (at a corner of the load history, or after a change of status): they are increments of
!> zero length in the same loop. All simultaneous violations change together, so that symmetry is preserved. The status sets tried
!> at one load are stored to detect cycling: then only the fastest violation changes at a time. If the statuses still cycle, the
!> rates of all nodes are solved for at once (mfv_rate_problem). If that fails too, there is no admissible continuation (Klarbring
!> 1990).
!>
!> Under static and kinetic friction a node that begins to slip has more shear traction than kinetic friction allows. The
!> over-stress relaxes at a fixed load, as an internal load with the same search for events. Every state of a stress drop is
!> therefore admissible, and the events of a cascade occur in their order.
module mfv_first_violation
   use mfv_accumulation, only: pass_accumulation
   use mfv_contact_path
   use mfv_contact_system
   use mfv_derivative_increments, only: differentiate_increment
   use mfv_error, only: error_type
   use mfv_inequalities, only: status_after
   use mfv_increment
   use mfv_kinds, only: wp
   use mfv_motions, only: motion_approach, control_force
   use mfv_node_status
   use mfv_observer, only: observer_type
   use mfv_rate_problem, only: find_statuses_by_rates
   use mfv_status
   use mfv_strings, only: to_text
   use mfv_tolerances, only: rounding, significant, visible
   implicit none
   private
   public :: apply_by_violations, most_residual

   !> Most consecutive steps of zero length, and most below the tie tolerance, plus ten for each node.
   integer, parameter :: most_tiny_steps = 200
   !> Most increments within `milestone_spacing`, a fraction of a segment, plus ten for each node (endless stick-slip).
   integer, parameter :: most_events = 5000
   real(wp), parameter :: milestone_spacing = 1.0e-5_wp
   !> Increments within that fraction after which events may accumulate at a finite load.
   integer, parameter :: many_events = 100
   !> Changes at one load, plus one for each node, before the rates of all nodes are solved for at once.
   integer, parameter :: many_changes = 30
   !> Tolerance of rates after cycling, which suggests that some of them are round-off.
   real(wp), parameter :: larger_rate_tolerance = significant
   !> The shortest trial increment, as a fraction of a segment.
   real(wp), parameter :: shortest_trial = 1.0e-8_wp
   !> A state with a larger certificate is rejected.
   real(wp), parameter :: failed_certificate = visible
   !> The largest admissible jump of the tractions, relative to the largest traction.
   real(wp), parameter :: largest_jump = visible
   !> Both are at least this factor times the tolerance of the linear solver.
   real(wp), parameter :: tolerance_factor = 1.0e3_wp

   !> Progress in a segment.
   type :: event_progress_type
      !> Fraction of the segment that is done; whether the last increment had a length, and whether it has reached the end.
      real(wp) :: done = 0.0_wp
      logical :: moved = .false., at_end = .false.
      !> Whether the segment begins without load.
      logical :: from_nothing = .false.
      !> The iteration at the present load, and the increment from there.
      type(iteration_type) :: iteration
      type(increment_type) :: increment
      !> Consecutive increments of zero length, consecutive tiny ones, and increments since the last milestone.
      integer :: standing = 0, tiny = 0, since = 0
      real(wp) :: milestone = 0.0_wp
   end type event_progress_type

contains

   !> Apply the loads of a segment. `observer` is notified of every increment, and also while the mesh grows or statuses change at
   !> one load.
   !> Errors, each with the last admissible state left in place: MFV_GROSS_SLIDING, MFV_SEPARATED, MFV_NO_CONTINUATION,
   !> MFV_MESH_EXCEEDED, MFV_INADMISSIBLE_STEP, MFV_INTERRUPTED.
   subroutine apply_by_violations(path, segment, observer, error)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      class(observer_type), intent(inout), optional :: observer
      type(error_type), allocatable, intent(out) :: error
      type(event_progress_type) :: progress
      type(constraints_type) :: constraints
      integer :: nodes

      call path%switch_friction(segment, error)
      if (allocated(error)) return
      progress%from_nothing = .not. any(path%state%fields%pressure > 0.0_wp)
      nodes = size(path%state%status)
      do
         call make_increment(path, segment, progress, constraints, error)
         if (allocated(error)) return
         if (progress%moved .or. progress%standing > many_changes .or. size(path%state%status) > nodes) &
            call path%notify(segment, progress%done, observer, error)
         if (allocated(error)) return
         nodes = size(path%state%status)
         if (progress%moved .and. progress%at_end) return
         if (progress%tiny > most_tiny_steps + 10*nodes .or. progress%since > most_events + 10*nodes) then
            call path%no_continuation('the load does not advance', error)
            return
         end if
         if (.not. progress%increment%ends_in_event) cycle
         call change_statuses(path, segment, progress%done, progress%increment, progress%iteration, error)
         if (allocated(error)) return
      end do
   end subroutine apply_by_violations

   !> Find the next increment at fixed statuses and take it. If its length is zero (`progress%moved` is false), only statuses
   !> change. Errors as apply_by_violations.
   subroutine make_increment(path, segment, progress, constraints, error)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      type(event_progress_type), intent(inout) :: progress
      type(constraints_type), intent(inout) :: constraints
      type(error_type), allocatable, intent(out) :: error
      logical :: relaxing, ready, passed
      logical, allocatable :: relaxing_nodes(:)

      progress%moved = .false.
      do
         progress%standing = progress%standing + 1
         if (progress%standing > most_tiny_steps + 10*size(path%state%status)) then
            call path%no_continuation('the load does not advance', error)
            return
         end if
         if (progress%standing == many_changes + size(path%state%status) .and. .not. progress%iteration%solved) then
            call find_statuses_at_once(path, segment, progress%done, ready)
            progress%iteration%solved = .true.
            if (ready) progress%iteration%tries = 0
         end if
         relaxing = path%has_over_stress()
         call path%find_constraints(segment, progress%done, progress%iteration, constraints, ready, error)
         if (allocated(error)) return
         if (.not. ready) cycle
         progress%increment%unit_step = merge(progress%done, 1.0_wp, progress%from_nothing)
         passed = .false.
         if (progress%since > many_events) call pass_accumulation(path, constraints, 1.0_wp - progress%done, milestone_spacing, &
                                                                  progress%iteration%rate_tolerance, progress%increment, passed)
         if (.not. passed) call find_increment(path, constraints, merge(1.0_wp, 1.0_wp - progress%done, relaxing), relaxing, &
                                               progress%iteration%rate_tolerance, progress%increment)
         call look_for_solution(path, progress, ready, error)
         if (allocated(error)) return
         if (ready) exit
      end do
      if (has_no_length(path, progress%increment)) return
      call path%record_changes(segment, progress%iteration)
      associate (step => progress%increment%step, unit_step => progress%increment%unit_step)
         progress%at_end = .not. relaxing .and. step*(1.0_wp + tie_tolerance(path)) &
                           + last_step(path, segment, unit_step) >= 1.0_wp - progress%done
         if (progress%at_end) step = 1.0_wp - progress%done
         if (relaxing .and. step*(1.0_wp + tie_tolerance(path)) + shortest_step(path, unit_step) >= 1.0_wp) step = 1.0_wp
         relaxing_nodes = path%is_releasing()
         call advance(path, progress%increment, relaxing, error)
         if (allocated(error)) return
         if (relaxing .and. .not. path%has_over_stress() .and. path%record_events) &
            call path%record(event_dropped, first_true(relaxing_nodes), count(relaxing_nodes), segment%step)
         progress%moved = .true.
         if (.not. relaxing) progress%done = progress%done + step
         if (allocated(path%derivatives) .and. path%model%scene%friction%acts() .and. segment%friction) &
            call differentiate_increment(path, segment, constraints, progress%increment, progress%done, progress%at_end)
         if (progress%at_end) return
         call renew(progress%iteration)
         progress%standing = 0
         if (.not. relaxing) progress%tiny = merge(progress%tiny + 1, 0, step < unit_step*tie_tolerance(path))
      end associate
      progress%since = progress%since + 1
      if (progress%done > progress%milestone + milestone_spacing) then
         progress%milestone = progress%done
         progress%since = 0
      end if
   end subroutine make_increment

   !> The shortest step at the end of a segment. Where the normal force decreases to zero, its rest can be round-off of the largest
   !> force so far; the load then advances to the end.
   pure real(wp) function last_step(path, segment, unit_step)
      class(contact_path_type), intent(in) :: path
      type(segment_type), intent(in) :: segment
      real(wp), intent(in) :: unit_step
      real(wp) :: negligible

      last_step = shortest_step(path, unit_step)
      negligible = max(rounding, path%system%tolerance)*path%certificate%force_scale(motion_approach)
      associate (normal => segment%load(motion_approach))
         if (normal%control /= control_force .or. .not. normal%rate < 0.0_wp) return
         if (abs(normal%value + normal%rate) <= negligible) last_step = max(last_step, min(negligible/(-normal%rate), visible))
      end associate
   end function last_step

   !> Check that the increment was found. If `found` is false, stress drops have begun and the increment is to be found again.
   !> Errors MFV_NO_CONTINUATION, MFV_NOT_CONVERGED.
   subroutine look_for_solution(path, progress, found, error)
      class(contact_path_type), intent(inout) :: path
      type(event_progress_type), intent(inout) :: progress
      logical, intent(out) :: found
      type(error_type), allocatable, intent(out) :: error
      logical :: dropped

      found = .not. (progress%increment%singular .or. progress%increment%diverges)
      if (found) return
      if (progress%increment%singular .and. path%system%gave_up) then
         call path%not_converged(error)
         return
      else if (progress%increment%singular) then
         call path%no_continuation('the linear system is singular', error)
         return
      end if
      dropped = .false.
      if (.not. progress%iteration%dropped) call path%begin_stress_drop(progress%iteration, dropped)
      progress%iteration%dropped = dropped
      if (.not. dropped) call path%no_continuation('the equations of friction have no solution nearby', error)
   end subroutine look_for_solution

   !> Take a step of the load (of the stress drop) with the rates of the increment, and check it; the state of the increment is
   !> updated.
   !> Errors MFV_NO_CONTINUATION: the statuses would make the tractions jump, or the certificate is far too large (for example
   !> under extreme loads).
   subroutine advance(path, increment, relaxing, error)
      class(contact_path_type), intent(inout) :: path
      type(increment_type), intent(inout) :: increment
      logical, intent(in) :: relaxing
      type(error_type), allocatable, intent(out) :: error
      real(wp) :: jump, scale
      integer :: i

      associate (before => path%state%fields, response => increment%response)
         scale = path%certificate%traction_scale
         jump = 0.0_wp
         do i = 1, size(before%pressure)
            scale = max(scale, abs(response%rate%pressure(i)), abs(response%rate%shear(i)))
            jump = max(jump, abs(response%state%pressure(i) - before%pressure(i)), &
                       abs(response%state%shear(i) - before%shear(i)))
         end do
         if (jump > max(largest_jump, tolerance_factor*path%system%tolerance)*scale) then
            call path%no_continuation('the tractions would have to jump', error)
            return
         end if
         call path%certificate%note_jump(before, response%state, scale)
         call response%state%move(increment%step, response%rate)
      end associate
      call path%take_increment(increment%response%state, increment%response%rate%slip(), merge(increment%step, 0.0_wp, relaxing))
      if (path%certificate%largest() > most_residual(path)) &
         call path%no_continuation('the equations are no longer satisfied (certificate '// &
                                   to_text(path%certificate%largest())//')', error)
   end subroutine advance

   !> The largest admissible residual of the certificate.
   pure real(wp) function most_residual(path)
      class(contact_path_type), intent(in) :: path

      most_residual = max(failed_certificate, tolerance_factor*path%system%tolerance)
   end function most_residual

   !> Change the statuses of the nodes whose inequalities are violated first, together.
   !> Errors MFV_NO_CONTINUATION: all alternatives have been tried at this load; MFV_MESH_EXCEEDED.
   subroutine change_statuses(path, segment, done, increment, iteration, error)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      real(wp), intent(in) :: done
      type(increment_type), intent(in) :: increment
      type(iteration_type), intent(inout) :: iteration
      type(error_type), allocatable, intent(out) :: error
      logical :: changing(size(path%state%status)), dropped, found, passed
      integer :: fastest

      if (was_tried(iteration, path%state%status)) then
         if (path%trial > shortest_trial) then
            ! Nonlinear friction may have consistent rates over a shorter increment.
            path%trial = 0.1_wp*path%trial
            iteration%tries = 0
            return
         end if
         if (iteration%one_at_a_time .and. iteration%rate_tolerance >= larger_rate_tolerance) then
            if (.not. iteration%solved) then
               call find_statuses_at_once(path, segment, done, found)
               if (found) then
                  call renew(iteration, iteration%event, iteration%node, iteration%count)
                  iteration%solved = .true.
                  return
               end if
            end if
            if (.not. iteration%dropped) call path%begin_stress_drop(iteration, dropped)
            if (dropped) then
               call renew(iteration, iteration%event, iteration%node, iteration%count)
               iteration%dropped = .true.
               return
            end if
            call path%no_continuation('no consistent status for node '// &
                                      to_text(maxloc(increment%violations%speed, dim=1)), error)
            return
         end if
         iteration%one_at_a_time = iteration%rate_tolerance >= larger_rate_tolerance
         iteration%rate_tolerance = larger_rate_tolerance
         iteration%tries = 0
      end if
      call remember(iteration, path%state%status)

      associate (violations => increment%violations)
         changing = violations%soonest <= increment%reach
         if (iteration%one_at_a_time) then
            fastest = maxloc(violations%speed, dim=1, mask=changing)
            changing = .false.
            changing(fastest) = .true.
         end if
         call note_change(iteration, violations%kind(first_true(changing)), changing)
         call path%set_status(changing, status_after(violations%kind, path%state%status, segment%friction .and. &
                                                     path%model%tangential, path%state%slip_direction, &
                                                     path%holding(increment%response%rate%slip())))
         call pass_law_events(path, violations%kind, changing, passed)
         ! The memory of friction has changed: statuses tried before may be consistent now.
         if (passed) iteration%tries = 0
      end associate
      call path%extend_mesh_if_reached(iteration, error)
   end subroutine change_statuses

   !> Pass events of the friction law to the nodes of `changing`. `passed`: whether there are any that change no status.
   subroutine pass_law_events(path, kind, changing, passed)
      class(contact_path_type), intent(inout) :: path
      integer, intent(in) :: kind(:)
      logical, intent(in) :: changing(:)
      logical, intent(out) :: passed
      integer :: i

      passed = .false.
      if (.not. path%model%scene%friction%acts()) return
      do i = 1, size(kind)
         if (.not. changing(i)) cycle
         call path%model%scene%friction%law%pass_event(kind(i), path%state%memory(:, i))
         passed = passed .or. keeps_status(kind(i))
      end do
   end subroutine pass_law_events

   !> Statuses of all undecided nodes at once. `found`: whether there are any.
   subroutine find_statuses_at_once(path, segment, done, found)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      real(wp), intent(in) :: done
      logical, intent(out) :: found
      type(constraints_type) :: constraints

      call path%loads_at(segment, done, constraints)
      call path%set_rows(constraints, .false.)
      constraints%one_by_one = .true.
      call find_statuses_by_rates(path, constraints, found)
   end subroutine find_statuses_at_once

   !> Begin the iteration at a new load, in the same storage; optionally with the first change.
   pure subroutine renew(iteration, event, node, number)
      type(iteration_type), intent(inout) :: iteration
      integer, intent(in), optional :: event, node, number
      type(iteration_type) :: fresh

      if (present(event)) fresh%event = event
      if (present(node)) fresh%node = node
      if (present(number)) fresh%count = number
      call move_alloc(iteration%tried, fresh%tried)
      iteration%tries = fresh%tries
      iteration%rate_tolerance = fresh%rate_tolerance
      iteration%one_at_a_time = fresh%one_at_a_time
      iteration%dropped = fresh%dropped
      iteration%solved = fresh%solved
      iteration%event = fresh%event
      iteration%node = fresh%node
      iteration%count = fresh%count
      call move_alloc(fresh%tried, iteration%tried)
   end subroutine renew

   pure logical function was_tried(iteration, status)
      type(iteration_type), intent(in) :: iteration
      integer, intent(in) :: status(:)

      was_tried = iteration%tries > 0
      if (was_tried) was_tried = is_among(status, iteration%tried(:, :iteration%tries))
   end function was_tried

   !> Note that `status` has been tried; earlier notes with another number of nodes are discarded.
   pure subroutine remember(iteration, status)
      type(iteration_type), intent(inout) :: iteration
      integer, intent(in) :: status(:)
      integer, parameter :: some = 8
      integer, allocatable :: wider(:, :)

      if (allocated(iteration%tried)) then
         if (size(iteration%tried, 1) /= size(status)) deallocate (iteration%tried)
      end if
      if (.not. allocated(iteration%tried)) then
         allocate (iteration%tried(size(status), some))
         iteration%tries = 0
      else if (iteration%tries == size(iteration%tried, 2)) then
         allocate (wider(size(status), 2*iteration%tries))
         wider(:, :iteration%tries) = iteration%tried
         call move_alloc(wider, iteration%tried)
      end if
      iteration%tries = iteration%tries + 1
      iteration%tried(:, iteration%tries) = status
   end subroutine remember

end module mfv_first_violation
