!> Certificate: how well every state of the load history satisfies elasticity, equilibrium and the equalities and inequalities
!> of dissertation Table 2.1. Computed independently of the solver, from tractions, displacements and statuses with the full
!> compliance. Residuals are relative to the largest magnitude of their kind so far; the largest over all increments is
!> recorded.
module mfv_certificate
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use mfv_compliance, only: block_up, block_ut, block_wp, block_wt
   use mfv_contact_fields, only: contact_fields_type
   use mfv_contact_model, only: contact_model_type
   use mfv_contact_state, only: contact_state_type
   use mfv_friction_law, only: friction_point_type
   use mfv_inequalities, only: slack
   use mfv_kinds, only: wp
   use mfv_motions, only: motions, motion_count, motion_approach, motion_shift
   use mfv_node_status
   use mfv_scene, only: algorithm_mfv, integration_explicit
   use mfv_tolerances, only: visible
   implicit none
   private
   public :: certificate_type, residual_count, residual_names, residual_descriptions

   integer, parameter :: elasticity_normal = 1, elasticity_tangential = 2, normal_force_balance = 3, &
                         tangential_force_balance = 4, contact_gap = 5, open_traction = 6, stick_slip = 7, &
                         slip_traction = 8, pressure_sign = 9, gap_sign = 10, friction_limit = 11, &
                         slip_direction = 12, continuity = 13, energy_balance = 14
   integer :: motion
   !> Number of residuals. The force balances of optional motions (all but approach and shift) come last.
   integer, parameter :: residual_count = energy_balance + motion_count - motion_shift
   !> Force balance of every motion.
   integer, parameter :: force_balance(motion_count) = [normal_force_balance, tangential_force_balance, &
                                                        (energy_balance + motion - motion_shift, &
                                                         motion=motion_shift + 1, motion_count)]

   !> Names of the residuals in the result file, and the quantities that they measure.
   character(*), parameter :: residual_names(residual_count) = &
                              [character(26) :: 'elasticity_normal', 'elasticity_tangential', motions(:motion_shift)%balance, &
                     'contact_gap', 'open_traction', 'stick_slip', 'slip_traction', 'pressure_sign', 'gap_sign', 'friction_limit', &
                                               'slip_direction', 'continuity', 'energy_balance', motions(motion_shift + 1:)%balance]
   character(*), parameter :: residual_descriptions(residual_count) = &
                       [character(80) :: 'w - C_wp p - C_wt tau', 'u - C_up p - C_ut tau', motions(:motion_shift)%balance_meaning, &
                                                 'gap of nodes in contact', 'tractions of open nodes', 'slip of stuck nodes', &
                                        'distance of slipping nodes from the friction limit', 'negative pressure', 'negative gap', &
                                       'shear traction beyond the friction limit', 'slip with the traction instead of against it', &
                                  'jump of the tractions where statuses change', 'work of the loads - stored - dissipated energy', &
                                                 motions(motion_shift + 1:)%balance_meaning]

   !> Gaps, and work through differences of them, have the round-off of lengths that exist without load: undeformed gaps and the
   !> approach. Two nodes beside a tip can have gaps that differ by round-off; the first displacements are not larger than that.
   !> Scales are at least this part of those lengths, or of a force times them.
   real(wp), parameter :: least_scale = visible

   type :: certificate_type
      !> Largest relative residuals over all increments, by kind.
      real(wp) :: residual(residual_count) = 0.0_wp
      !> Whether each kind applies to this scene.
      logical :: applies(residual_count) = .true.
      !> Number of increments so far.
      integer :: increments = 0
      !> Number of large increments: nothing is checked between their ends.
      integer :: large_increments = 0
      !> Largest estimated errors of large increments: of the tractions relative to the largest traction so far, and of the
      !> dissipated energy relative to the dissipation of the interval.
      real(wp) :: increment_traction_error = 0.0_wp, increment_dissipation_error = 0.0_wp
      !> Whether the former is a root mean square, that of a rough contact.
      logical :: by_mean_square = .false.
      !> Sum of the estimated errors of the dissipated energy by large increments, force.
      real(wp) :: dissipation_error = 0.0_wp
      !> Largest traction so far, force/length^2; largest force of every motion so far.
      real(wp) :: traction_scale = 0.0_wp, force_scale(motion_count) = 0.0_wp
      !> Largest displacements and energy so far.
      real(wp) :: normal = 0.0_wp
      real(wp), private :: tangential = 0.0_wp, energy = 0.0_wp
      !> Work of the loads so far (energy per unit thickness, force), and the sum of its magnitudes by load and increment. In
      !> rolling, the works of tangential force and moment nearly cancel.
      real(wp) :: work = 0.0_wp, gross_work = 0.0_wp
   contains
      procedure :: largest
      procedure :: find_applicable
      procedure :: check_increment
      procedure :: note_jump
      procedure :: note_large_increment
   end type certificate_type

contains

   !> Find out which residuals apply. No energy balance under Goodman's coupling with friction: its compliance is not
   !> symmetric. Nothing tangential before friction acts. Only the end states of large increments and of the conventional
   !> algorithm's load steps.
   subroutine find_applicable(self, model)
      class(certificate_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model

      self%applies([continuity, energy_balance]) = model%scene%method%algorithm == algorithm_mfv
      self%applies(energy_balance) = self%applies(continuity) .and. (.not. model%tangential .or. &
                                                                     .not. model%compliance%one_way())
      if (self%large_increments > 0 .and. self%large_increments == self%increments) &
         self%applies([continuity, energy_balance]) = .false.
      self%applies(force_balance) = model%moves
      self%applies([elasticity_tangential, tangential_force_balance, stick_slip, slip_traction, friction_limit, &
                    slip_direction]) = model%tangential
   end subroutine find_applicable

   !> Largest residual that applies.
   pure real(wp) function largest(self)
      class(certificate_type), intent(in) :: self

      largest = maxval(self%residual, mask=self%applies)
   end function largest

   !> Check the increment from `before` to `after`, with the statuses of `after`. `is_large`: large increment; only its end is
   !> checked.
   subroutine check_increment(self, model, before, after, is_large)
      class(certificate_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: before, after
      logical, intent(in) :: is_large

      self%increments = self%increments + 1
      if (is_large) self%large_increments = self%large_increments + 1
      call check_equilibrium(self, model, after%fields)
      call check_normal_contact(self, model, before%fields, after)
      if (self%applies(slip_traction)) call check_friction(self, model, before, after, is_large)
      call check_energy(self, model, before%fields, after, is_large)
      if (self%large_increments > 0) call self%find_applicable(model)
   end subroutine check_increment

   !> Record the jump of the tractions at an unchanged load, relative to `scale`, force/length^2: the largest traction so far or,
   !> where contact begins at next to no load, to come.
   subroutine note_jump(self, before, after, scale)
      class(certificate_type), intent(inout) :: self
      type(contact_fields_type), intent(in) :: before, after
      real(wp), intent(in) :: scale
      real(wp) :: jump
      integer :: i

      jump = 0.0_wp
      do i = 1, size(before%pressure)
         jump = largest_or_nan(jump, after%pressure(i) - before%pressure(i))
         jump = largest_or_nan(jump, after%shear(i) - before%shear(i))
      end do
      if (self%traction_scale > 0.0_wp) call note(self, continuity, jump, scale)
   end subroutine note_jump

   !> Record the estimated errors of an interval of large increments: of the tractions at its end and of the dissipated energy, with
   !> what they are relative to: `traction`, force/length^2, and `work`, force. `by_mean_square`: whether the former is a root mean
   !> square.
   pure subroutine note_large_increment(self, traction_error, traction, work_error, work, by_mean_square)
      class(certificate_type), intent(inout) :: self
      real(wp), intent(in) :: traction_error, traction, work_error, work
      logical, intent(in) :: by_mean_square

      self%by_mean_square = self%by_mean_square .or. by_mean_square
      if (traction > 0.0_wp) self%increment_traction_error = max(self%increment_traction_error, traction_error/traction)
      self%dissipation_error = self%dissipation_error + work_error
      if (work > 0.0_wp) self%increment_dissipation_error = max(self%increment_dissipation_error, work_error/work)
   end subroutine note_large_increment

   !> Elasticity with the full compliance, and balance of forces. The tangential scale is at least the friction limit: a shear
   !> that should be zero is not judged by its own rounding errors.
   subroutine check_equilibrium(self, model, fields)
      class(certificate_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      type(contact_fields_type), intent(in) :: fields
      real(wp) :: by_block(size(fields%pressure), 4)
      real(wp), dimension(size(fields%pressure)) :: rigid_normal, rigid_tangential
      real(wp) :: pressure_force, shear_force, normal_rest, tangential_rest
      integer :: i

      ! Sum of magnitudes by pressure and by shear, which may cancel.
      call model%compliance%products(fields%pressure, fields%shear, by_block)
      rigid_normal = 0.0_wp
      rigid_tangential = 0.0_wp
      if (model%has_rigid_parts()) then
         rigid_normal = model%rigid_normal(fields)
         rigid_tangential = model%rigid_tangential(fields)
      end if
      pressure_force = 0.0_wp
      shear_force = 0.0_wp
      normal_rest = 0.0_wp
      tangential_rest = 0.0_wp
      do i = 1, size(fields%pressure)
         self%traction_scale = max(self%traction_scale, abs(fields%pressure(i)), abs(fields%shear(i)))
         self%normal = max(self%normal, abs(by_block(i, block_wp)), abs(by_block(i, block_wt)))
         self%tangential = max(self%tangential, abs(by_block(i, block_up)), abs(by_block(i, block_ut)), abs(rigid_tangential(i)))
         pressure_force = pressure_force + model%width(i)*abs(fields%pressure(i))
         shear_force = shear_force + model%width(i)*abs(fields%shear(i))
       normal_rest = largest_or_nan(normal_rest, fields%normal(i) + rigid_normal(i) - by_block(i, block_wp) - by_block(i, block_wt))
         tangential_rest = largest_or_nan(tangential_rest, fields%tangential(i) + rigid_tangential(i) - by_block(i, block_up) &
                                          - by_block(i, block_ut))
      end do
      self%tangential = max(self%tangential, model%friction_scale*self%normal, abs(fields%motion(motion_shift)))
      self%force_scale(motion_approach) = max(self%force_scale(motion_approach), abs(fields%force(motion_approach)), pressure_force)
      self%force_scale(motion_shift) = max(self%force_scale(motion_shift), model%friction_scale*self%force_scale(motion_approach), &
                                           shear_force, abs(fields%force(motion_shift)))
      call note(self, elasticity_normal, normal_rest, max(self%normal, maxval(abs(rigid_normal))))
      call note(self, elasticity_tangential, tangential_rest, self%tangential)
      do i = 1, motion_count
         if (motions(i)%optional) then
            if (.not. self%applies(force_balance(i))) cycle
            self%force_scale(i) = max(self%force_scale(i), abs(fields%force(i)), &
                                      self%force_scale(motion_approach)*model%unit_of_arm(i), &
                                      model%force(abs(model%normal_arm(:, i)*fields%pressure)) &
                                      + model%force(abs(model%tangential_arm(:, i)*fields%shear)))
         end if
         call note(self, force_balance(i), abs(fields%force(i) - model%resultant(i, fields%pressure, fields%shear)), &
                   self%force_scale(i))
      end do
   end subroutine check_equilibrium

   !> Larger of a magnitude so far and the magnitude of a number; NaN if that is NaN.
   elemental real(wp) function largest_or_nan(so_far, number)
      real(wp), intent(in) :: so_far, number

      largest_or_nan = so_far
      if (.not. abs(number) <= so_far) largest_or_nan = abs(number)
   end function largest_or_nan

   !> Equalities and inequalities of gap and pressure. Before any contact gaps are compared with those of the undeformed bodies and
   !> with the approach, also with that `before`, which flat faces at zero have come from; later with at least a part of those of
   !> the nodes in contact (`least_scale`).
   subroutine check_normal_contact(self, model, before, state)
      class(certificate_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      type(contact_fields_type), intent(in) :: before
      type(contact_state_type), intent(in) :: state
      real(wp) :: gap, closed_gap, open_gap, open_traction_size, negative_pressure, scale, undeformed
      integer :: i

      closed_gap = 0.0_wp
      open_gap = 0.0_wp
      open_traction_size = 0.0_wp
      negative_pressure = 0.0_wp
      undeformed = abs(state%fields%motion(motion_approach))
      do i = 1, size(state%status)
         gap = model%initial_gap(i) - state%fields%motion(motion_approach) + state%fields%normal(i)
         if (state%status(i) /= node_open) then
            closed_gap = largest_or_nan(closed_gap, gap)
            undeformed = max(undeformed, abs(model%initial_gap(i)))
            negative_pressure = max(negative_pressure, -slack_of(event_open))
         else
            if (model%can_touch(i)) open_gap = max(open_gap, -slack_of(event_close))
            open_traction_size = max(open_traction_size, abs(state%fields%pressure(i)) + abs(state%fields%shear(i)))
         end if
      end do
      scale = max(self%normal, least_scale*undeformed)
      if (.not. self%normal > 0.0_wp) scale = max(maxval(abs(model%initial_gap)), abs(before%motion(motion_approach)), &
                                                  abs(state%fields%motion(motion_approach)))
      call note(self, contact_gap, closed_gap, scale)
      call note(self, gap_sign, open_gap, scale)
      call note(self, open_traction, open_traction_size, self%traction_scale)
      call note(self, pressure_sign, negative_pressure, self%traction_scale)

   contains

      pure real(wp) function slack_of(event)
         integer, intent(in) :: event

         slack_of = slack(event, gap, state%fields%pressure(i), 0.0_wp, 0.0_wp, 0.0_wp)
      end function slack_of
   end subroutine check_normal_contact

   !> Equalities and inequalities of slip and shear traction. Over a large increment slip counts from its own reference, which
   !> includes nodes that came into contact within it.
   subroutine check_friction(self, model, before, after, is_large)
      class(certificate_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: before, after
      logical, intent(in) :: is_large
      real(wp) :: sliding, law_defect, beyond_limit, wrong_way, slipped, limit
      type(friction_point_type) :: here, there
      logical :: explicit
      integer :: i, status

      sliding = 0.0_wp
      law_defect = 0.0_wp
      beyond_limit = 0.0_wp
      wrong_way = 0.0_wp
      explicit = model%scene%method%integration == integration_explicit .and. model%scene%method%algorithm == algorithm_mfv
      associate (law => model%scene%friction%law)
         do i = 1, size(after%status)
            status = after%status(i)
            if (status == node_open) cycle
            limit = model%static_friction(i)*after%fields%pressure(i)
            if (status == node_frictionless) limit = 0.0_wp
            beyond_limit = max(beyond_limit, -minval(slack([event_slip_right, event_slip_left], 0.0_wp, 0.0_wp, &
                                                           after%fields%shear(i), limit, 0.0_wp)))
            slipped = after%fields%tangential(i) - after%fields%motion(motion_shift) &
                      - (before%fields%tangential(i) - before%fields%motion(motion_shift))
            if (is_large) then
               ! Within the increment nodes may have stuck, at the slip in stuck_slip; when they touched is not known.
               if (status == node_stick) &
                  slipped = after%fields%tangential(i) - after%fields%motion(motion_shift) - before%stuck_slip(i)
               if (slips(status) .and. .not. before%fields%pressure(i) > 0.0_wp) slipped = 0.0_wp
            end if
            if (status == node_stick) then
               sliding = largest_or_nan(sliding, slipped)
            else if (status == node_frictionless) then
               law_defect = largest_or_nan(law_defect, after%fields%shear(i))
            else
               here = before%friction_point(before%fields, i, model%static_friction(i), model%kinetic_friction(i))
               there = after%friction_point(after%fields, i, model%static_friction(i), model%kinetic_friction(i))
               law_defect = largest_or_nan(law_defect, law%defect(status, here, there, explicit))
               if (slips(status)) wrong_way = max(wrong_way, law%wrong_motion( &
                                                  slip_sign(status)*slipped, model%static_friction(i) &
                                                  *(after%fields%pressure(i) - before%fields%pressure(i))*law%limit_fraction))
            end if
         end do
         call note(self, stick_slip, sliding, self%tangential)
         call note(self, slip_traction, law_defect, self%traction_scale)
         call note(self, friction_limit, beyond_limit, self%traction_scale)
         call note(self, slip_direction, wrong_way, merge(self%tangential, self%traction_scale, law%sticks))
      end associate
   end subroutine check_friction

   !> Energy balance: work of the loads = stored + dissipated energy. Between events everything is linear and the trapezoidal
   !> rule exact. Over a large increment the work is unknown: it is set to the stored and dissipated energy, without a
   !> residual.
   subroutine check_energy(self, model, before, after, is_large)
      class(certificate_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      type(contact_fields_type), intent(in) :: before
      type(contact_state_type), intent(in) :: after
      logical, intent(in) :: is_large
      real(wp) :: stored, dissipated, works(motion_count), own(motion_count), least
      integer :: i

      associate (now => after%fields)
         works = 0.5_wp*((before%force + now%force)*(now%motion - before%motion))
         self%work = self%work + sum(works)
         self%gross_work = self%gross_work + sum(abs(works))
         stored = 0.0_wp
         do i = 1, size(now%pressure)
            stored = stored + model%width(i)*(now%pressure(i)*now%normal(i) + now%shear(i)*now%tangential(i))
         end do
         stored = 0.5_wp*stored
         if (model%has_rigid_parts()) then
            ! The work of approach and shift through the deformation is in the sum above.
            own = 0.0_wp
            own(motion_approach) = model%force(now%pressure)
            own(motion_shift) = model%force(now%shear)
            stored = stored + 0.5_wp*sum([(now%motion(i)*(model%resultant(i, now%pressure, now%shear) - own(i)), &
                                           i=1, motion_count)])
         end if
      end associate
      dissipated = after%dissipation - after%skipped_dissipation
      if (is_large) self%work = stored + dissipated
      self%energy = max(self%energy, self%gross_work, abs(stored), dissipated)
      least = least_scale*abs(after%fields%force(motion_approach)*after%fields%motion(motion_approach))
      if (.not. is_large) call note(self, energy_balance, abs(self%work - stored - dissipated), max(self%energy, least))
   end subroutine check_energy

   !> Record a residual if it is the largest of its kind; `scale` is its reference magnitude.
   subroutine note(self, kind, residual, scale)
      class(certificate_type), intent(inout) :: self
      integer, intent(in) :: kind
      real(wp), intent(in) :: residual, scale

      if (ieee_is_finite(residual) .and. ieee_is_finite(scale)) then
         if (residual <= scale*self%residual(kind)) return
         self%residual(kind) = huge(1.0_wp)
         if (scale > 0.0_wp) self%residual(kind) = residual/scale
      else
         self%residual(kind) = huge(1.0_wp)
      end if
   end subroutine note

end module mfv_certificate
