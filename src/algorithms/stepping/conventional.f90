!> The conventional algorithm, for comparison: dissertation section 2.2 and Fig. 2.2 (Algorithm I, after Ahn and Barber).
!>
!> The load advances by nominal steps dL0. At the new load all nodes that were in contact are assumed to stick. Then one status is
!> repaired at a time, the worst violation of the first of these types: interpenetration, negative pressure, shear beyond the
!> friction limit, slip in the wrong direction (not listed in the figure, but in Table 2.1). The augmented system is solved again
!> after every repair. Neither termination nor the correct state is guaranteed: a repeated set of statuses means cycling, and too
!> many repairs, or a repaired state whose certificate fails, mean that no admissible state was found.
module mfv_conventional
   use mfv_certificate, only: residual_descriptions
   use mfv_contact_fields, only: contact_fields_type
   use mfv_contact_path
   use mfv_contact_system
   use mfv_error, only: error_type
   use mfv_first_violation, only: most_residual
   use mfv_friction_law, only: memory_size
   use mfv_inequalities, only: is_required, slack, status_after
   use mfv_kinds, only: wp
   use mfv_motions, only: motion_approach, motion_shift, control_force, control_displacement
   use mfv_node_status
   use mfv_observer, only: observer_type
   use mfv_status
   use mfv_strings, only: to_text
   use mfv_tolerances, only: significant
   implicit none
   private
   public :: apply_conventionally

   !> Violations below this fraction of the largest magnitude of their type are round-off.
   real(wp), parameter :: round_off = 1.0e-11_wp

   !> The next repair.
   type :: repair_type
      integer :: kind = event_none, node = 0
   end type repair_type

contains

   !> Apply the loads of a segment in nominal steps. `observer` is notified of every load step.
   !> Errors, each with the last converged state left in place: MFV_CYCLING, MFV_INADMISSIBLE, MFV_GROSS_SLIDING, MFV_SEPARATED,
   !> MFV_MESH_EXCEEDED, MFV_INADMISSIBLE_STEP, MFV_INTERRUPTED.
   subroutine apply_conventionally(path, segment, observer, error)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      class(observer_type), intent(inout), optional :: observer
      type(error_type), allocatable, intent(out) :: error
      integer, allocatable :: converged(:)
      real(wp), allocatable :: memory(:, :)
      real(wp) :: done
      logical :: again

      call path%switch_friction(segment, error)
      done = 0.0_wp
      do while (done < 1.0_wp .and. .not. allocated(error))
         done = done + path%model%scene%method%load_step
         if (done > 1.0_wp - significant) done = 1.0_wp
         again = .true.
         do while (again)
            converged = path%state%status
            memory = path%state%memory
            call solve_load(path, segment, done, again, error)
            if (.not. allocated(error)) cycle
            path%state%status = converged
            path%state%memory = memory
            return
         end do
         call path%notify(segment, done, observer, error)
      end do
   end subroutine apply_conventionally

   !> Repair statuses at the fraction `done` of the segment until no inequality is violated, and accept the state. `again`: repeat
   !> this load, since the mesh has grown or the bodies have just touched.
   subroutine solve_load(path, segment, done, again, error)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      real(wp), intent(in) :: done
      logical, intent(out) :: again
      type(error_type), allocatable, intent(out) :: error
      type(iteration_type) :: iteration
      type(constraints_type) :: constraints
      type(response_type) :: response
      type(repair_type) :: repair
      type(contact_fields_type) :: expected
      integer, allocatable :: tried(:, :), start(:)
      integer :: repairs, n
      logical :: singular, touched

      again = .false.
      n = size(path%state%status)
      start = path%state%status
      call touch(path, segment, done, touched)
      if (touched) call path%extend_mesh_if_reached(iteration, error)
      if (allocated(error)) return
      again = size(path%state%status) /= n
      if (again) return
      call stick_all(path)
      allocate (tried(n, 0))
      expected = path%state%fields
      do repairs = 1, path%model%scene%method%most_iterations
         call find_trial_constraints(path, segment, done, expected, constraints, error)
         if (allocated(error)) return
         call path%system%solve(path%model, constraints, path%state%fields, response, singular)
         if (singular .and. path%system%gave_up) then
            call path%not_converged(error)
            return
         else if (singular) then
            call path%end_here(MFV_INADMISSIBLE, 'inadmissible: the linear system is singular', error)
            return
         end if
         repair = worst_violation(path, response%state)
         if (repair%kind == event_none .and. .not. agrees(path, expected, response%state)) then
            expected = response%state
            cycle
         else if (repair%kind == event_none) then
            call accept(path, segment, response%state, iteration, error)
            return
         end if
         tried = reshape([tried, path%state%status], [n, size(tried, 2) + 1])
         call apply_repair(path, segment, repair, iteration)
         if (is_among(path%state%status, tried)) then
            path%state%status = start
            call path%end_here(MFV_CYCLING, 'cycling: the statuses are repeated after '//to_text(repairs)// &
                               ' repairs at one load; last repaired: node '//to_text(repair%node), error)
            return
         end if
         call path%extend_mesh_if_reached(iteration, error)
         again = size(path%state%status) /= n
         if (again .or. allocated(error)) return
      end do
      path%state%status = start
      call path%end_here(MFV_INADMISSIBLE, 'inadmissible: '//to_text(path%model%scene%method%most_iterations)// &
                         ' repairs at one load left an inequality violated at node '//to_text(repair%node), error)
   end subroutine solve_load

   !> An increasing normal force without contact: the bodies touch first.
   subroutine touch(path, segment, done, touched)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      real(wp), intent(in) :: done
      logical, intent(out) :: touched
      type(iteration_type) :: iteration

      touched = .not. any(in_contact(path%state%status)) .and. segment%load(motion_approach)%control == control_force .and. &
                segment%load(motion_approach)%value + done*segment%load(motion_approach)%rate > 0.0_wp
      if (touched) call path%close_nearest(segment, iteration)
   end subroutine touch

   !> Let all slipping nodes stick at their present slip; creeping nodes continue.
   subroutine stick_all(path)
      class(contact_path_type), intent(inout) :: path
      integer :: status(size(path%state%status))

      status = path%holding(real(motion_sign(path%state%status), wp))
      call change(path, slips(path%state%status), status)
   end subroutine stick_all

   !> Change statuses; the memory of friction is unchanged during repairs.
   subroutine change(path, mask, status)
      class(contact_path_type), intent(inout) :: path
      logical, intent(in) :: mask(:)
      integer, intent(in) :: status(:)
      real(wp) :: memory(memory_size, size(mask))

      memory = path%state%memory
      call path%set_status(mask, status)
      path%state%memory = memory
   end subroutine change

   !> Whether the lines of nonlinear friction, made for `expected`, are right at the end of the load step.
   logical function agrees(path, expected, fields)
      class(contact_path_type), intent(in) :: path
      type(contact_fields_type), intent(in) :: expected, fields

      agrees = .true.
      if (.not. path%model%tangential) return
      if (path%model%scene%friction%law%is_linear) return
      agrees = max(maxval(abs(fields%shear - expected%shear)), maxval(abs(fields%pressure - expected%pressure))) &
               <= 0.1_wp*round_off*maxval(abs(fields%pressure))
   end function agrees

   !> The constraints at the fraction `done` of the segment, with the statuses of `path` (trial ones; its fields and memory are
   !> those of the last load step) and friction lines for the fields `expected`. (The rates of the loads are not used.)
   !> Errors MFV_GROSS_SLIDING, MFV_SEPARATED: nothing balances the tangential force.
   subroutine find_trial_constraints(path, segment, done, expected, constraints, error)
      class(contact_path_type), intent(in) :: path
      type(segment_type), intent(in) :: segment
      real(wp), intent(in) :: done
      type(contact_fields_type), intent(in) :: expected
      type(constraints_type), intent(out) :: constraints
      type(error_type), allocatable, intent(out) :: error
      real(wp), parameter :: no_force = 1.0e-12_wp
      real(wp) :: scale

      call path%loads_at(segment, done, constraints)
      call path%set_rows(constraints, .false., expected)
      if (.not. any(in_contact(path%state%status)) .and. constraints%load(motion_approach)%control == control_force) &
         constraints%load(motion_approach) = load_type(control_displacement, path%state%fields%motion(motion_approach), 0.0_wp)
      if (any(holds(path%state%status)) .or. constraints%load(motion_shift)%control /= control_force) return
      scale = max(path%state%fields%force(motion_approach), abs(constraints%load(motion_approach)%value))
      if (any(slips(path%state%status))) then
         call path%end_here(MFV_GROSS_SLIDING, 'gross sliding: every contact node slips', error)
      else if (abs(constraints%load(motion_shift)%value) > no_force*scale .and. any(in_contact(path%state%status))) then
         call path%end_here(MFV_GROSS_SLIDING, 'no node in contact has friction to balance the tangential force', error)
      else if (abs(constraints%load(motion_shift)%value) > no_force*scale) then
         call path%end_here(MFV_SEPARATED, 'no node is in contact to balance the tangential force', error)
      end if
      constraints%load(motion_shift) = load_type(control_displacement, path%state%fields%motion(motion_shift), 0.0_wp)
   end subroutine find_trial_constraints

   !> The worst violation of the first violated type, and its repair.
   function worst_violation(path, trial) result(repair)
      class(contact_path_type), intent(in) :: path
      type(contact_fields_type), intent(in) :: trial
      type(repair_type) :: repair
      real(wp), dimension(size(path%state%status)) :: gap, limit, slipped
      real(wp) :: traction, motion

      associate (status => path%state%status)
         traction = round_off*max(maxval(abs(trial%pressure)), maxval(abs(trial%shear)), path%certificate%traction_scale)
         motion = round_off*max(maxval(abs(trial%normal)), maxval(abs(trial%tangential)), &
                                abs(trial%motion(motion_approach)), abs(trial%motion(motion_shift)))
         gap = path%model%gap(trial)
         limit = path%model%static_friction*trial%pressure
         slipped = trial%slip() - path%state%fields%slip()
         repair = worst(event_close, slack_of(event_close), path%model%can_touch .and. is_required(event_close, status), motion)
         if (repair%kind == event_none) repair = worst(event_open, slack_of(event_open), is_required(event_open, status), traction)
         if (repair%kind /= event_none) return
         repair = worst(event_slip_right, min(slack_of(event_slip_right), slack_of(event_slip_left)), &
                        is_required(event_slip_right, status), traction)
         if (repair%kind /= event_none) then
            if (trial%shear(repair%node) > 0.0_wp) repair%kind = event_slip_left
            return
         end if
         if (path%model%tangential .and. any(slips(status))) call mend_bristles(path, trial, slipped, repair, traction)
        if (repair%kind == event_none) repair = worst(event_stick, slack_of(event_stick), slips(status) .or. creeps(status), motion)
      end associate

   contains

      function slack_of(event)
         integer, intent(in) :: event
         real(wp) :: slack_of(size(gap))

         slack_of = slack(event, gap, trial%pressure, trial%shear, limit, motion_sign(path%state%status)*slipped)
      end function slack_of
   end function worst_violation

   !> Repair of slipping nodes whose bristles take up the load again, for laws with creep. Their `slipped` is then set to zero.
   subroutine mend_bristles(path, trial, slipped, repair, allowed)
      class(contact_path_type), intent(in) :: path
      type(contact_fields_type), intent(in) :: trial
      real(wp), intent(inout) :: slipped(:)
      type(repair_type), intent(inout) :: repair
      real(wp), intent(in) :: allowed
      real(wp), dimension(size(slipped)) :: yields

      associate (law => path%model%scene%friction%law, status => path%state%status)
         if (law%sticks) return
         yields = law%over_stress(motion_sign(status)*slipped, law%limit_fraction*path%model%static_friction &
                                  *(trial%pressure - path%state%fields%pressure))
         repair = worst(event_stick, yields, slips(status), allowed)
         where (slips(status)) slipped = 0.0_wp
      end associate
   end subroutine mend_bristles

   !> The node of `mask` with the least slack, if that is negative beyond `allowed`.
   pure type(repair_type) function worst(kind, slacks, mask, allowed)
      integer, intent(in) :: kind
      real(wp), intent(in) :: slacks(:), allowed
      logical, intent(in) :: mask(:)

      if (.not. any(mask)) return
      if (.not. minval(slacks, mask=mask) < -allowed) return
      worst%kind = kind
      worst%node = minloc(slacks, mask=mask, dim=1)
   end function worst

   !> Make a repair.
   subroutine apply_repair(path, segment, repair, iteration)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      type(repair_type), intent(in) :: repair
      type(iteration_type), intent(inout) :: iteration
      logical :: mask(size(path%state%status))
      logical :: friction

      mask = .false.
      mask(repair%node) = .true.
      friction = segment%friction .and. path%model%tangential
      call note_change(iteration, repair%kind, mask)
      call change(path, mask, status_after(repair%kind, path%state%status, friction, path%state%slip_direction, &
                                           path%holding(real(-motion_sign(path%state%status), wp))))
   end subroutine apply_repair

   !> No inequality is violated: accept the state, count and record. Error MFV_INADMISSIBLE: its certificate fails, since a friction
   !> law is followed over a load step that is too long; `path` is then unchanged but for statuses.
   subroutine accept(path, segment, fields, iteration, error)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      type(contact_fields_type), intent(in) :: fields
      type(iteration_type), intent(in) :: iteration
      type(error_type), allocatable, intent(out) :: error
      type(path_position_type) :: position

      position = path%path_position_type
      call path%take_increment(fields, fields%slip() - path%state%fields%slip(), 0.0_wp)
      call path%remember_status(.not. slips(path%state%status))
      associate (certificate => path%certificate)
         if (certificate%largest() > most_residual(path)) &
            call path%end_here(MFV_INADMISSIBLE, 'inadmissible: the repaired state is not a solution (certificate '// &
                               to_text(certificate%largest(), 2)//': '// &
                               trim(residual_descriptions(maxloc(certificate%residual, dim=1, mask=certificate%applies)))// &
                               '); use a smaller load_step', error)
      end associate
      if (allocated(error)) path%path_position_type = position
      if (.not. allocated(error)) call path%record_changes(segment, iteration)
   end subroutine accept

end module mfv_conventional
