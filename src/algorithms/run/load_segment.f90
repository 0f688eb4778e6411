!> A load segment: from the present loads to the next targets, by the algorithm of the scene.
module mfv_load_segment
   use mfv_contact_path, only: contact_path_type, segment_type
   use mfv_contact_system, only: load_type
   use mfv_conventional, only: apply_conventionally
   use mfv_derivative_increments, only: differentiate_end
   use mfv_error, only: error_type
   use mfv_frictionless, only: apply_directly
   use mfv_kinds, only: wp
   use mfv_leap, only: apply_by_large_increments
   use mfv_motions, only: motions, motion_count, motion_approach, motion_shift, control_force, control_displacement, control_keep
   use mfv_node_status, only: in_contact
   use mfv_observer, only: observer_type
   use mfv_run_state, only: mark_turn, run_state_type
   use mfv_scene, only: algorithm_conventional, step_type, stepping_leap
   use mfv_slip_zones, only: segment_start_type
   implicit none
   private
   public :: reach_targets, apply_segment, begin_segment, start_of, target_of

contains

   !> Reach the targets of the current segment of a step.
   subroutine reach_targets(self, step, before, segments, observer, error)
      class(run_state_type), intent(inout) :: self
      type(step_type), intent(in) :: step
      integer, intent(in) :: before, segments
      class(observer_type), intent(inout), optional :: observer
      type(error_type), allocatable, intent(out) :: error
      type(load_type) :: targets(motion_count)
      type(segment_start_type) :: start

      targets = merge(self%current%there, self%current%back, mod(self%current%number, 2) == 1)
      if (allocated(step%path)) targets = target_of(self%current%there, step%control, &
                                                    step%path(:, 1 + mod(self%current%number - 1, step%turns())))
      if (allocated(self%contact%derivatives)) &
         call self%contact%derivatives%begin_segment(mod(self%current%number, 2) == 0 .and. .not. allocated(step%path), &
                                                     targets%control)
      associate (state => self%contact%state)
         start = segment_start_type(state%dissipation, state%fields%force, state%fields%shear)
      end associate
      call begin_segment(self, targets, step, before, segments)
      if (self%contact%model%tangential .and. self%slip%turns_with(changes_of(self))) &
         call self%set_mark(mark_turn, self%current%number)
      call apply_segment(self, observer, error)
      if (.not. allocated(error)) call reach_exactly(self%contact, targets)
      if (allocated(self%contact%derivatives)) then
         if (allocated(error)) then
            call self%contact%derivatives%fail('the last step ended early')
         else if (.not. (step%friction .and. self%contact%model%scene%friction%acts())) then
            call differentiate_end(self%contact, self%segment)
         end if
      end if
      call self%slip%add_segment(self%contact%model, start, self%contact%state, changes_of(self), &
                                 self%contact%slip_zone_nodes, self%contact%system%tolerance)
      self%load = targets
      associate (fields => self%contact%state%fields)
         if (allocated(error)) self%load = start_of(fields%force, fields%motion, targets)
      end associate
   end subroutine reach_targets

   !> Give the prescribed motions of a path the values of its `targets`, which they have reached but for round-off: another segment
   !> to the same targets is then without change. Without normal force, or pressures in a neat fit, nothing remains in contact.
   subroutine reach_exactly(path, targets)
      class(contact_path_type), intent(inout) :: path
      type(load_type), intent(in) :: targets(motion_count)

      where (path%model%moves .and. targets%control == control_displacement) path%state%fields%motion = targets%value
      associate (normal => targets(motion_approach))
         if (path%model%scene%is_neat() .or. (normal%control == control_force .and. .not. normal%value > 0.0_wp)) &
            call path%separate()
      end associate
   end subroutine reach_exactly

   !> The load segment from the present state to `targets`.
   subroutine begin_segment(self, targets, step, before, segments)
      class(run_state_type), intent(inout) :: self
      type(load_type), intent(in) :: targets(motion_count)
      type(step_type), intent(in) :: step
      integer, intent(in) :: before, segments
      integer :: i
      real(wp) :: force(motion_count)

      force = self%contact%certificate%force_scale(motion_approach)*self%contact%model%unit_of_arm([(i, i=1, motion_count)])
      associate (segment => self%segment, fields => self%contact%state%fields)
         segment%load = load_towards(start_of(fields%force, fields%motion, targets), targets, force)
         segment%friction = step%friction
         segment%step = self%steps_done + 1
         segment%number = before + self%current%number
         segment%segments = segments
      end associate
      call self%contact%note_start(self%segment%load)
   end subroutine begin_segment

   !> Apply the loads of the current segment, which begin_segment has set, by the algorithm of the scene. Nothing changes while
   !> they are held: the rates of events would be round-off.
   subroutine apply_segment(self, observer, error)
      class(run_state_type), intent(inout) :: self
      class(observer_type), intent(inout), optional :: observer
      type(error_type), allocatable, intent(out) :: error

      associate (method => self%contact%model%scene%method)
         if (is_held(self)) then
            call self%contact%switch_friction(self%segment, error)
            if (.not. allocated(error)) call self%contact%notify(self%segment, 1.0_wp, observer, error)
         else if (method%algorithm == algorithm_conventional) then
            call apply_conventionally(self%contact, self%segment, observer, error)
         else if (method%stepping == stepping_leap .and. .not. strains(self%segment)) then
            call apply_by_large_increments(self%contact, self%segment, observer, error)
         else
            call apply_directly(self%contact, self%segment, observer, error)
         end if
      end associate
   end subroutine apply_segment

   !> Whether all loads of a contact are held in the current segment. (Derivatives by its targets are found from increments.)
   pure logical function is_held(self)
      class(run_state_type), intent(in) :: self

      is_held = any(in_contact(self%contact%state%status)) .and. .not. allocated(self%contact%derivatives) .and. &
                .not. any(abs(self%segment%load%rate) > 0.0_wp)
   end function is_held

   !> Whether a bulk stress or the wear changes in a segment. They move the stick zone while the shear narrows it, so that an edge
   !> may turn within the segment, which large increments do not resolve.
   pure logical function strains(segment)
      type(segment_type), intent(in) :: segment

      strains = any(motions%is_known .and. abs(segment%load%rate) > 0.0_wp)
   end function strains

   !> Changes of the loads in the present segment, to be compared with each other in how they make nodes slip: as tangential forces,
   !> displacements times the modulus, and what presses times the coefficient of friction.
   pure function changes_of(self) result(changes)
      class(run_state_type), intent(in) :: self
      real(wp) :: changes(motion_count), unit(motion_count)
      integer :: i

      associate (load => self%segment%load, model => self%contact%model)
         unit = model%unit_of_arm([(i, i=1, motion_count)])
         changes = load%rate*merge(1.0_wp/unit, unit*model%compliance%modulus, load%control == control_force)
         where (.not. (motions%is_stress .or. [(i == motion_shift, i=1, motion_count)])) &
            changes = changes*model%scene%friction%static%largest()
      end associate
   end function changes_of

   !> The load from `start` to `goal`, with its rate per segment. A change of force within round-off of the largest force so far,
   !> `scale`, counts as zero.
   elemental type(load_type) function load_towards(start, goal, scale)
      type(load_type), intent(in) :: start, goal
      real(wp), intent(in) :: scale

      load_towards = load_type(start%control, start%value, goal%value - start%value)
      if (start%control == control_force .and. abs(load_towards%rate) <= epsilon(scale)*scale) load_towards%rate = 0.0_wp
   end function load_towards

   !> The load at the end of a step: `value` is its target; a load that the step does not control is unchanged.
   elemental type(load_type) function target_of(load, control, value)
      type(load_type), intent(in) :: load
      integer, intent(in) :: control
      real(wp), intent(in) :: value

      target_of = load
      if (control /= control_keep) target_of = load_type(control, value)
   end function target_of

   !> The same control with the present value of its force or motion.
   elemental type(load_type) function start_of(force, motion, load)
      real(wp), intent(in) :: force, motion
      type(load_type), intent(in) :: load

      start_of = load_type(load%control, merge(force, motion, load%control == control_force))
   end function start_of

end module mfv_load_segment
