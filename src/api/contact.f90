!> A case with its simulation in one object, the basis of the Fortran interface (module mfv) and the C interface (mfv_c).
module mfv_contact
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use, intrinsic :: iso_fortran_env, only: int64
   use mfv_case, only: case_type
   use mfv_case_checksum, only: find_case_checksum
   use mfv_case_parameters, only: read_parameters
   use mfv_case_reader, only: read_case_file, read_case_text
   use mfv_clock, only: seconds_now
   use mfv_contact_fields, only: contact_fields_type
   use mfv_contact_state, only: contact_state_type
   use mfv_discretisation_error, only: estimate_error, has_coarser_meshes
   use mfv_motions, only: motions, motion_count, user_motions, motion_approach, motion_shift, motion_rotation, motion_lower_bulk, &
                          motion_upper_bulk, motion_interference, control_keep, control_force, control_displacement
   use mfv_derivatives, only: parameter_type
   use mfv_sensitivity, only: find_sensitivity
   use mfv_draft, only: draft_type
   use mfv_error, only: error_type, set_error
   use mfv_features, only: has_hdf5
   use mfv_interior, only: interior_type
   use mfv_kept_state, only: kept_state_type
   use mfv_kinds, only: wp
   use mfv_observer, only: observer_type
   use mfv_observables, only: observe, observed_type
   use mfv_result_fields, only: field_named, field_type, group_fields, result_attributes, result_groups
   use mfv_refinement, only: follow_patches, refine_at_edges
   use mfv_result_file, only: check_writable, resume_result, write_result
   use mfv_safe_file, only: delete_path
   use mfv_scene, only: most_cycles, scene_type, step_type
   use mfv_simulation, only: new_simulation, simulation_type
   use mfv_state_interior, only: state_interior
   use mfv_status
   use mfv_strings, only: add_text, string_type, to_text
   use mfv_summary, only: summarize
   use mfv_tangent, only: find_tangent
   use mfv_validity, only: validity_warnings
   implicit none
   private
   public :: contact_type, loads_type, derivative_type, read_contact, read_contact_text, new_contact, step_to, count_values, &
             body_lower, body_upper

   integer, parameter :: body_lower = 0, body_upper = 1
   !> Invalid control: a force and a displacement for one direction.
   integer, parameter :: control_both = -huge(1)

   !> Loads and motions of a state, of motion_approach, motion_shift, motion_rotation, motion_lower_bulk, motion_upper_bulk and
   !> motion_interference: forces [force/length], moment [force], areas [length^2]; lengths, radians, bulk stresses
   !> [force/length^2]; dissipation [force]; and counts.
   type :: loads_type
      real(wp) :: force(user_motions) = 0.0_wp, motion(user_motions) = 0.0_wp, dissipation = 0.0_wp
      integer :: contact_nodes = 0, stick_nodes = 0, slip_nodes = 0, events = 0, linear_solves = 0
   end type loads_type

   !> Derivatives of a state with respect to a parameter: of the loads and motions, as in loads_type, of the dissipation, and of the
   !> pressure and shear traction of every node, shape (nodes); units: of these over that of the parameter.
   type :: derivative_type
      real(wp) :: force(user_motions) = 0.0_wp, motion(user_motions) = 0.0_wp, dissipation = 0.0_wp
      real(wp), allocatable :: pressure(:), shear(:)
      !> Number of loads so far at which several nodes changed their status together, but would not at another value of the
      !> parameter: if it is not 0 the derivative is approximate. Linear solves so far for derivatives, which those of loads_type do
      !> not contain.
      integer :: separated_events = 0, linear_solves = 0
   end type derivative_type

   !> Cache until the state changes: paths of all fields, one group of them, observables, warnings, attributes.
   type :: cache_type
      private
      type(string_type), allocatable :: paths(:)
      character(:), allocatable :: group
      type(field_type), allocatable :: fields(:)
      type(observed_type), allocatable :: observed
      type(string_type), allocatable :: warnings(:), attribute_names(:), attribute_texts(:)
   end type cache_type

   type, extends(cache_type) :: contact_type
      type(case_type) :: case
      type(simulation_type) :: simulation
      !> Checksum by which saved states identify their scene.
      integer(int64), private :: scene = 0
      logical, private :: is_made = .false.
      !> Checkpoints: the file, seconds between them (0: none), and when the next one is due.
      character(:), allocatable :: checkpoint_path
      real(wp), private :: checkpoint_seconds = 0.0_wp, next_checkpoint = 0.0_wp
   contains
      procedure :: ask_for
      procedure :: keep_checkpoints
      procedure :: resume
      procedure :: run
      procedure :: is_unfinished
      procedure :: save
      procedure :: summarize => summarize_contact
      procedure :: advance
      procedure :: status
      procedure :: get_message
      procedure :: loads
      procedure :: get_tangent
      procedure :: differentiate
      procedure :: get_derivative
      procedure :: keep
      procedure :: come_back
      procedure :: field_paths
      procedure :: find_field
      !> Copy out a field: `call contact%get('state/pressure', pressure, error)`, into an allocatable of reals or whole numbers.
      !> Error MFV_BAD_ARGUMENT.
      generic :: get => get_reals, get_integers, get_real, get_integer
      procedure :: attributes
      procedure :: find_interior
      procedure :: make_interior
      procedure :: write
      procedure, private :: get_reals, get_integers, get_real, get_integer, begin, refine, expect_made, write_checkpoint
   end type contact_type

contains

   !> The contact of the case in a namelist file. `needs_steps`: whether a case without steps is an error. `algorithm`: replaces
   !> that of the case, as does `accuracy`; `suffix`: inserted in the name of the result file. Error MFV_INPUT_ERROR.
   subroutine read_contact(path, contact, error, needs_steps, algorithm, suffix, accuracy)
      character(*), intent(in) :: path
      type(contact_type), intent(out) :: contact
      type(error_type), allocatable, intent(out) :: error
      logical, intent(in), optional :: needs_steps
      integer, intent(in), optional :: algorithm
      character(*), intent(in), optional :: suffix
      real(wp), intent(in), optional :: accuracy
      logical :: without_steps

      without_steps = .true.
      if (present(needs_steps)) without_steps = .not. needs_steps
      call read_case_file(path, contact%case, error, without_steps)
      if (allocated(error)) return
      if (present(algorithm)) contact%case%scene%method%algorithm = algorithm
      if (present(accuracy)) then
         if (.not. contact%case%scene%method%takes_accuracy()) then
            call set_error(error, MFV_INPUT_ERROR, contact%case%source//": --accuracy has an effect with algorithm='mfv' and "// &
                           "stepping='auto' or 'leap' only")
            return
         end if
         call contact%case%scene%set_accuracy(accuracy)
         contact%case%options = '--accuracy '//to_text(accuracy)
      end if
      if (present(suffix)) contact%case%result_path = with_suffix(contact%case%result_path, suffix)
      call contact%begin(error)
   end subroutine read_contact

   !> The name of a file with a suffix before its extension.
   pure function with_suffix(path, suffix) result(name)
      character(*), intent(in) :: path, suffix
      character(len=len(path) + len(suffix)) :: name
      integer :: dot

      dot = index(path, '.', back=.true.)
      if (dot <= index(path, '/', back=.true.) + 1) dot = len(path) + 1
      name = path(:dot - 1)//suffix//path(dot:)
   end function with_suffix

   !> The same of a text. `source`: its name for messages, and the path to which file names are relative.
   subroutine read_contact_text(text, source, contact, error)
      character(*), intent(in) :: text, source
      type(contact_type), intent(out) :: contact
      type(error_type), allocatable, intent(out) :: error

      call read_case_text(text, source, contact%case, error, without_steps=.true.)
      if (.not. allocated(error)) call contact%begin(error)
   end subroutine read_contact_text

   !> The contact of a scene that was built by calls. Error MFV_INPUT_ERROR.
   subroutine new_contact(draft, contact, error)
      type(draft_type), intent(in) :: draft
      type(contact_type), intent(out) :: contact
      type(error_type), allocatable, intent(out) :: error

      call draft%make_case(contact%case, error)
      if (.not. allocated(error)) call contact%begin(error)
   end subroutine new_contact

   !> The unloaded contact of the case. Error MFV_INPUT_ERROR: the scene cannot be modelled.
   subroutine begin(self, error)
      class(contact_type), intent(inout) :: self
      type(error_type), allocatable, intent(out) :: error

      self%simulation = new_simulation(self%case%scene, self%case%keep_history, self%case%keep_states)
      if (self%simulation%outcome /= MFV_COMPLETE) then
         call set_error(error, self%simulation%outcome, self%simulation%message)
         return
      end if
      if (allocated(self%case%stress_at)) self%simulation%stress_at = self%case%stress_at
      call find_case_checksum(self%case, self%simulation%contact%model, self%scene)
      self%is_made = .true.
   end subroutine begin

   !> Error MFV_BAD_HANDLE for an empty contact.
   subroutine expect_made(self, error)
      class(contact_type), intent(in) :: self
      type(error_type), allocatable, intent(out) :: error

      if (.not. self%is_made) call set_error(error, MFV_BAD_HANDLE, 'the contact is empty: call new_contact or read_contact')
   end subroutine expect_made

   !> Have run compute error bars and the sensitivity to round-off, even if the case does not request them. Error MFV_INPUT_ERROR
   !> for a case that cannot have them.
   subroutine ask_for(self, estimate, sensitivity, error)
      class(contact_type), intent(inout) :: self
      logical, intent(in) :: estimate, sensitivity
      type(error_type), allocatable, intent(out) :: error

      if (estimate .and. .not. has_coarser_meshes(self%case%scene)) then
         call set_error(error, MFV_INPUT_ERROR, self%case%source//": --estimate: a body with shape='matrix' has no coarser mesh")
      else if (sensitivity .and. .not. self%case%scene%friction%acts()) then
         call set_error(error, MFV_INPUT_ERROR, self%case%source//': --sensitivity: the case has no friction to perturb')
      end if
      if (estimate) self%case%options = trim(self%case%options)//' --estimate'
      if (sensitivity) self%case%options = trim(self%case%options)//' --sensitivity'
      self%case%options = adjustl(self%case%options)
      self%case%error_estimate = self%case%error_estimate .or. estimate
      self%case%sensitivity = self%case%sensitivity .or. sensitivity
   end subroutine ask_for

   !> Have run write checkpoints at ends of segments, from which another process can continue (see resume): to the file of &output,
   !> or next to it, with .partial in its name, if it is the result of a finished run. Error MFV_INPUT_ERROR: not writable.
   subroutine keep_checkpoints(self, error)
      class(contact_type), intent(inout) :: self
      type(error_type), allocatable, intent(out) :: error
      real(wp), parameter :: seconds_of_a_minute = 60.0_wp
      logical :: is_whole

      if (.not. has_hdf5) return
      call check_writable(self%case%result_path, error, is_whole)
      if (allocated(error)) then
         error%message = self%case%source//": &output file='"//self%case%result_path//"': "//error%message
         return
      end if
      self%checkpoint_path = self%case%result_path
      if (is_whole) self%checkpoint_path = with_suffix(self%case%result_path, '.partial')
      self%checkpoint_seconds = self%case%checkpoint_minutes*seconds_of_a_minute
      self%next_checkpoint = seconds_now() + self%checkpoint_seconds
      self%simulation%keep_restart = .true.
   end subroutine keep_checkpoints

   !> Continue from the checkpoint of an interrupted run of the case, after its last finished segment. `message`: what is done.
   !> `is_finished`: the result is complete. Error MFV_INPUT_ERROR: the checkpoint cannot be used.
   subroutine resume(self, message, is_finished, error)
      class(contact_type), intent(inout) :: self
      character(:), allocatable, intent(out) :: message
      logical, intent(out) :: is_finished
      type(error_type), allocatable, intent(out) :: error
      character(:), allocatable :: path
      logical :: exists

      path = with_suffix(self%case%result_path, '.partial')
      inquire (file=path, exist=exists)
      if (.not. exists) path = self%case%result_path
      if (.not. exists) inquire (file=path, exist=exists)
      is_finished = .false.
      message = 'no checkpoint found; starting from step 1'
      if (.not. exists) return
      call self%refine()
      call resume_result(path, self%case, self%simulation, is_finished, error)
      if (allocated(error)) return
      if (is_finished) then
         message = path//' is complete; there is nothing to resume'
      else
         message = 'resuming from '//path//': '//to_text(self%simulation%scene_steps_done)//' of '// &
                   to_text(size(self%case%scene%steps))//' steps done'
         self%checkpoint_path = path
      end if
   end subroutine resume

   !> Run the steps of the case that have not been run; see status for the outcome.
   subroutine run(self, observer)
      class(contact_type), intent(inout) :: self
      class(observer_type), intent(inout), optional :: observer

      call self%refine(observer)
      if (self%status() /= MFV_COMPLETE) return
      self%cache_type = cache_type()
      do while (self%simulation%has_segments_left())
         call self%simulation%run_segment(observer)
         if (self%simulation%outcome == MFV_COMPLETE) call self%write_checkpoint(observer)
      end do
      if (self%simulation%keep_restart .and. self%simulation%outcome == MFV_COMPLETE) call self%simulation%note_restart()
      if (self%case%error_estimate) then
         if (present(observer)) call observer%begin_work('coarser meshes')
         call estimate_error(self%simulation, observer)
      end if
      if (self%case%sensitivity .and. .not. self%is_unfinished()) then
         if (present(observer)) call observer%begin_work('perturbed friction')
         call find_sensitivity(self%simulation, observer)
      end if
      if (self%simulation%outcome /= MFV_COMPLETE) call self%case%explain(self%simulation)
   end subroutine run

   !> Refine the mesh of a case that asks for it, before its first step.
   subroutine refine(self, observer)
      class(contact_type), intent(inout) :: self
      class(observer_type), intent(inout), optional :: observer
      type(error_type), allocatable :: error
      logical :: keep_restart, interrupted

      if (self%status() /= MFV_COMPLETE) return
      if (.not. (self%case%scene%mesh%refined .or. self%case%scene%mesh%nodes_by_patches)) return
      if (present(observer)) call observer%begin_work('coarser meshes')
      if (self%case%scene%mesh%refined) then
         call refine_at_edges(self%case%scene, interrupted, observer)
      else
         call follow_patches(self%case%scene, interrupted, observer)
      end if
      if (interrupted) then
         self%simulation%outcome = MFV_INTERRUPTED
         self%simulation%message = 'interrupted before step 1, on the coarser meshes that locate the edges'
         self%checkpoint_path = ''
         return
      end if
      if (present(observer)) call observer%begin_work('')
      self%case%scene%mesh%refined = .false.
      self%case%scene%mesh%nodes_by_patches = .false.
      keep_restart = self%simulation%keep_restart
      self%cache_type = cache_type()
      call self%begin(error)  ! also the outcome
      self%simulation%keep_restart = keep_restart
   end subroutine refine

   !> Write a checkpoint if one is due. If that fails the observer is warned and the run continues.
   subroutine write_checkpoint(self, observer)
      class(contact_type), intent(inout) :: self
      class(observer_type), intent(inout), optional :: observer
      type(error_type), allocatable :: error
      character(:), allocatable :: message

      if (.not. self%checkpoint_seconds > 0.0_wp) return
      if (seconds_now() < self%next_checkpoint) return
      message = self%simulation%message
      call self%simulation%note_restart()
      self%simulation%outcome = MFV_INTERRUPTED
      self%simulation%message = 'checkpoint of an unfinished run; '//message
      call self%save(error)
      self%simulation%outcome = MFV_COMPLETE
      self%simulation%message = message
      self%cache_type = cache_type()
      if (allocated(error) .and. present(observer)) call observer%warn('checkpoint not written: '//error%message)
      self%next_checkpoint = seconds_now() + self%checkpoint_seconds
   end subroutine write_checkpoint

   !> Whether the run, its error bars or its sensitivity were interrupted.
   pure logical function is_unfinished(self)
      class(contact_type), intent(in) :: self

      is_unfinished = self%simulation%outcome == MFV_INTERRUPTED
      if (allocated(self%simulation%estimate)) is_unfinished = is_unfinished .or. self%simulation%estimate%status == MFV_INTERRUPTED
      if (allocated(self%simulation%sensitivity)) &
         is_unfinished = is_unfinished .or. self%simulation%sensitivity%status == MFV_INTERRUPTED
   end function is_unfinished

   !> Write the result of a run with checkpoints: to the file of &output if it is finished, else as its checkpoint. Error
   !> MFV_FILE_ERROR.
   subroutine save(self, error)
      class(contact_type), intent(inout) :: self
      type(error_type), allocatable, intent(out) :: error
      type(error_type), allocatable :: not_ours
      character(:), allocatable :: partial
      logical :: exists

      if (self%is_unfinished() .and. self%checkpoint_path == '') return
      call find_warnings(self)
      if (self%is_unfinished()) then
         call write_result(self%checkpoint_path, self%case, self%simulation, self%warnings, error, with_restart=.true., &
                           observed=self%observed)
         return
      end if
      call write_result(self%case%result_path, self%case, self%simulation, self%warnings, error, observed=self%observed)
      if (allocated(error)) return
      partial = with_suffix(self%case%result_path, '.partial')
      inquire (file=partial, exist=exists)
      if (exists) call check_writable(partial, not_ours)
      if (exists .and. .not. allocated(not_ours)) call delete_path(partial)
   end subroutine save

   !> The summary of the result, for a terminal. `seconds`: wall-clock time of the run.
   subroutine summarize_contact(self, seconds, text)
      class(contact_type), intent(inout) :: self
      real(wp), intent(in) :: seconds
      character(:), allocatable, intent(out) :: text

      call find_warnings(self)
      call summarize(self%case, self%simulation, self%warnings, self%observed, seconds, text)
   end subroutine summarize_contact

   !> Apply one more step, linearly from the present loads: a force or a displacement in every direction that changes, units as in
   !> step_type. `relative`: targets are increments of the present loads. After an interruption by an observer the contact continues
   !> from its present state. See status for the outcome. Errors MFV_BAD_ARGUMENT (invalid step, nothing is done), MFV_BAD_HANDLE.
   subroutine advance(self, step, error, relative, observer)
      class(contact_type), intent(inout) :: self
      type(step_type), intent(in) :: step
      type(error_type), allocatable, intent(out) :: error
      logical, intent(in), optional :: relative
      class(observer_type), intent(inout), optional :: observer
      type(step_type) :: absolute

      call self%expect_made(error)
      if (allocated(error)) return
      absolute = step
      where (step%control == control_keep) absolute%target = 0.0_wp
      if (present(relative)) then
         if (relative) call add_present(self%simulation%contact%state%fields, absolute)
      end if
      call check_step(absolute, self%case%scene, error)
      if (.not. allocated(error)) call check_held(self%case%scene, step%control, &
                                                  self%simulation%load(motion_approach)%control, error)
      if (allocated(error)) return
      if (self%simulation%outcome == MFV_INTERRUPTED) then
         self%simulation%outcome = MFV_COMPLETE
         self%simulation%failed_step = 0
         self%simulation%failed_scene_step = 0
      end if
      call self%refine(observer)
      if (self%simulation%outcome /= MFV_COMPLETE) return
      self%cache_type = cache_type()
      call self%simulation%advance(absolute, observer=observer)
   end subroutine advance

   !> A step to the given targets: normal_force or approach, tangential_force or shift, moment or rotation, bulk stresses,
   !> interference; units and the rest as in step_type.
   pure function step_to(normal_force, approach, tangential_force, shift, moment, rotation, friction, cycles, steady_tolerance, &
                         lower_bulk_stress, upper_bulk_stress, interference) result(step)
      real(wp), intent(in), optional :: normal_force, approach, tangential_force, shift, moment, rotation, steady_tolerance, &
                                        lower_bulk_stress, upper_bulk_stress, interference
      logical, intent(in), optional :: friction
      integer, intent(in), optional :: cycles
      type(step_type) :: step

      call choose(normal_force, approach, step%control(motion_approach), step%target(motion_approach))
      call choose(tangential_force, shift, step%control(motion_shift), step%target(motion_shift))
      call choose(moment, rotation, step%control(motion_rotation), step%target(motion_rotation))
      call choose(displacement=lower_bulk_stress, control=step%control(motion_lower_bulk), target=step%target(motion_lower_bulk))
      call choose(displacement=upper_bulk_stress, control=step%control(motion_upper_bulk), target=step%target(motion_upper_bulk))
      call choose(displacement=interference, control=step%control(motion_interference), target=step%target(motion_interference))
      if (present(friction)) step%friction = friction
      if (present(cycles)) step%cycles = cycles
      if (present(steady_tolerance)) step%steady_tolerance = steady_tolerance
   end function step_to

   !> Control and target of one motion.
   pure subroutine choose(force, displacement, control, target)
      real(wp), intent(in), optional :: force, displacement
      integer, intent(inout) :: control
      real(wp), intent(inout) :: target

      if (present(force)) then
         control = control_force
         target = force
      end if
      if (.not. present(displacement)) return
      control = merge(control_both, control_displacement, present(force))
      target = displacement
   end subroutine choose

   !> Add the forces and motions of a state to the targets of a step.
   pure subroutine add_present(fields, step)
      type(contact_fields_type), intent(in) :: fields
      type(step_type), intent(inout) :: step

      where (step%control == control_force) step%target = step%target + fields%force
      where (step%control == control_displacement) step%target = step%target + fields%motion
   end subroutine add_present

   !> Error MFV_BAD_ARGUMENT for a step that is not possible in `scene`.
   subroutine check_step(step, scene, error)
      type(step_type), intent(in) :: step
      type(scene_type), intent(in) :: scene
      type(error_type), allocatable, intent(out) :: error
      character(*), parameter :: why_not = ': it must be elastic and deform like a half-plane, not a disk, hole or matrix'
      integer :: i, wrong
      logical :: strains(motion_count)

      strains = motions%is_stress .and. step%control /= control_keep
      wrong = findloc(scene%cannot_be_negative([(i, i=1, motion_count)], step%control) .and. step%target < 0.0_wp, .true., dim=1)
      if (any(step%control == control_both)) then
         call set_error(error, MFV_BAD_ARGUMENT, 'prescribe either the force or the displacement of a direction, not both')
      else if (any(step%control < control_keep .or. step%control > control_displacement)) then
         call set_error(error, MFV_BAD_ARGUMENT, 'a control must be MFV_KEEP, MFV_FORCE or MFV_DISPLACEMENT')
      else if (any(motions%is_known .and. step%control == control_force)) then
         call set_error(error, MFV_BAD_ARGUMENT, 'the control of a bulk stress or an interference must be MFV_KEEP or '// &
                        'MFV_DISPLACEMENT, which prescribes it')
      else if (strains(motion_lower_bulk) .and. .not. scene%can_have_bulk_stress(.false.)) then
         call set_error(error, MFV_BAD_ARGUMENT, 'the lower body cannot have a bulk stress'//why_not)
      else if (strains(motion_upper_bulk) .and. .not. scene%can_have_bulk_stress(.true.)) then
         call set_error(error, MFV_BAD_ARGUMENT, 'the upper body cannot have a bulk stress'//why_not)
      else if (step%control(motion_interference) /= control_keep .and. .not. scene%can_interfere()) then
         call set_error(error, MFV_BAD_ARGUMENT, 'an interference needs a disk and a hole of one radius')
      else if (any([(step%control(i) /= control_keep .and. .not. scene%can_repeat(i), i=1, motion_count)])) then
         call set_error(error, MFV_BAD_ARGUMENT, 'surfaces that repeat (period in &mesh) have no rotation and no bulk stress')
      else if (.not. all(ieee_is_finite(step%target))) then
         call set_error(error, MFV_BAD_ARGUMENT, 'a target is not finite')
      else if (wrong > 0) then
         call set_error(error, MFV_BAD_ARGUMENT, 'the '//trim(merge(motions(wrong)%key, motions(wrong)%force_name, &
                                                                    motions(wrong)%is_known))//' must not be negative')
      else if (.not. ieee_is_finite(step%steady_tolerance) .or. step%steady_tolerance < 0.0_wp) then
         call set_error(error, MFV_BAD_ARGUMENT, 'steady_tolerance must be a number and not negative')
      else if (step%cycles < 0 .or. step%cycles > most_cycles) then
         call set_error(error, MFV_BAD_ARGUMENT, 'cycles must be from 0 to '//to_text(most_cycles))
      end if
   end subroutine check_step

   !> Error MFV_BAD_ARGUMENT for an interference with vertical normals at a given normal force, which would only lift the upper
   !> body.
   !> `controls`: of the step; `kept`: that of the approach before it.
   subroutine check_held(scene, controls, kept, error)
      type(scene_type), intent(in) :: scene
      integer, intent(in) :: controls(motion_count), kept
      type(error_type), allocatable, intent(out) :: error

      if (controls(motion_interference) == control_keep) return
      if (scene%holds_for_interference(merge(kept, controls(motion_approach), controls(motion_approach) == control_keep))) return
      call set_error(error, MFV_BAD_ARGUMENT, 'an interference with vertical normals needs a prescribed approach, which '// &
                     'holds the upper body in its place')
   end subroutine check_held

   !> Outcome so far, see mfv_status: MFV_COMPLETE without failure; MFV_BAD_HANDLE for an empty contact.
   pure integer function status(self)
      class(contact_type), intent(in) :: self

      status = MFV_BAD_HANDLE
      if (self%is_made) status = self%simulation%outcome
   end function status

   !> Message of the outcome.
   pure subroutine get_message(self, message)
      class(contact_type), intent(in) :: self
      character(:), allocatable, intent(out) :: message

      message = 'the contact is empty'
      if (self%is_made) message = self%simulation%message
   end subroutine get_message

   !> Present loads and motions.
   pure type(loads_type) function loads(self)
      class(contact_type), intent(in) :: self

      if (.not. self%is_made) return
      associate (f => self%simulation%contact%state%fields, state => self%simulation%contact%state)
         loads%force = f%force(:user_motions)
         loads%motion = f%motion(:user_motions)
         loads%dissipation = state%dissipation
         loads%contact_nodes = state%contact_nodes()
         loads%stick_nodes = state%stick_nodes()
         loads%slip_nodes = state%slip_nodes()
      end associate
      loads%events = self%simulation%contact%events
      loads%linear_solves = self%simulation%contact%system%solves
   end function loads

   !> The consistent tangent at the present state, see mfv_tangent. `tangent`: of the first 2 motions, or more, up to user_motions;
   !> `direction` of further motion: of the same motions. Error MFV_BAD_ARGUMENT.
   subroutine get_tangent(self, tangent, error, direction)
      class(contact_type), intent(in) :: self
      real(wp), intent(out) :: tangent(:, :)
      type(error_type), allocatable, intent(out) :: error
      real(wp), intent(in), optional :: direction(:)

      tangent = 0.0_wp
      call self%expect_made(error)
      if (allocated(error)) return
      if (size(tangent, 1) /= size(tangent, 2) .or. size(tangent, 1) < 2 .or. size(tangent, 1) > user_motions) then
         call set_error(error, MFV_BAD_ARGUMENT, 'the tangent must have from 2 to '//to_text(user_motions)//' motions')
         return
      end if
      if (present(direction)) then
         if (size(direction) /= size(tangent, 1)) then
            call set_error(error, MFV_BAD_ARGUMENT, 'the direction of the tangent must have as many motions as the tangent')
         else if (.not. all(ieee_is_finite(direction))) then
            call set_error(error, MFV_BAD_ARGUMENT, 'the direction of the tangent is not finite')
         end if
         if (allocated(error)) return
      end if
      call find_tangent(self%simulation%contact, tangent, error, direction)
   end subroutine get_tangent

   !> Derive all further states with respect to parameters, in place of those of an earlier call: keys of &body and &friction, such
   !> as body(2)%radius, before the first step; targets of steps to come, such as step(2)%shift, or shift for the next step. None:
   !> no derivatives. Until then the state is taken to be independent of them. Error MFV_BAD_ARGUMENT.
   subroutine differentiate(self, names, error)
      class(contact_type), intent(inout) :: self
      type(string_type), intent(in) :: names(:)
      type(error_type), allocatable, intent(out) :: error
      type(parameter_type), allocatable :: parameters(:)

      call self%expect_made(error)
      if (allocated(error)) return
      call self%refine()
      call read_parameters(self%case, self%simulation, names, parameters, error)
      if (.not. allocated(error)) call self%simulation%contact%differentiate(parameters)
   end subroutine differentiate

   !> The derivatives of the present state with respect to parameter `number` of differentiate. Error MFV_BAD_ARGUMENT: there are
   !> none.
   subroutine get_derivative(self, number, derivative, error)
      class(contact_type), intent(in) :: self
      integer, intent(in) :: number
      type(derivative_type), intent(out) :: derivative
      type(error_type), allocatable, intent(out) :: error

      call self%expect_made(error)
      if (allocated(error)) return
      if (.not. allocated(self%simulation%contact%derivatives)) then
         call set_error(error, MFV_BAD_ARGUMENT, 'there are no derivatives; name their parameters first')
         return
      end if
      associate (derivatives => self%simulation%contact%derivatives)
         if (derivatives%fault /= '') then
            call set_error(error, MFV_BAD_ARGUMENT, 'the derivatives are not known: '//derivatives%fault)
         else if (number < 1 .or. number > size(derivatives%fields)) then
            call set_error(error, MFV_BAD_ARGUMENT, 'there is no parameter '//to_text(number)//'; there are '// &
                           to_text(size(derivatives%fields)))
         else
            associate (fields => derivatives%fields(number))
               derivative%force = fields%force(:user_motions)
               derivative%motion = fields%motion(:user_motions)
               derivative%dissipation = derivatives%dissipation(number)
               derivative%pressure = fields%pressure
               derivative%shear = fields%shear
               derivative%separated_events = derivatives%separated(number)
               derivative%linear_solves = derivatives%solves
            end associate
         end if
      end associate
   end subroutine get_derivative

   !> Save the present state.
   subroutine keep(self, kept)
      class(contact_type), intent(in) :: self
      type(kept_state_type), intent(inout) :: kept

      if (self%is_made) call kept%keep(self%simulation, self%scene)
   end subroutine keep

   !> Restore a saved state, see mfv_kept_state. Error MFV_BAD_ARGUMENT.
   subroutine come_back(self, kept, error)
      class(contact_type), intent(inout) :: self
      type(kept_state_type), intent(in) :: kept
      type(error_type), allocatable, intent(out) :: error

      call self%expect_made(error)
      if (.not. allocated(error)) call kept%come_back(self%simulation, self%scene, error)
      if (.not. allocated(error)) self%cache_type = cache_type()
   end subroutine come_back

   !> Paths of all present fields, such as state/pressure, as in the result file; valid until the state changes.
   subroutine field_paths(self, paths)
      class(contact_type), intent(inout), target :: self
      type(string_type), pointer, intent(out) :: paths(:)
      type(string_type), allocatable :: groups(:)
      type(field_type), allocatable :: fields(:)
      integer :: i, j

      if (.not. allocated(self%paths)) then
         call find_observables(self)
         groups = result_groups(self%simulation)
         do i = 1, size(groups)
            call group_fields(self%case, self%simulation, groups(i)%text, fields, self%observed)
            do j = 1, size(fields)
               call add_text(self%paths, groups(i)%text//'/'//fields(j)%name)
            end do
         end do
      end if
      paths => self%paths
   end subroutine field_paths

   !> The field at a path; `whole`: whether it must have integers or reals; `single`: it must have one value. Its group is cached:
   !> the pointer is valid until another group is requested or the state changes. Error MFV_BAD_ARGUMENT.
   subroutine find_field(self, path, field, error, whole, single)
      class(contact_type), intent(inout), target :: self
      character(*), intent(in) :: path
      type(field_type), pointer, intent(out) :: field
      type(error_type), allocatable, intent(out) :: error
      logical, intent(in), optional :: whole, single
      logical :: is_cached
      integer :: number, slash

      nullify (field)
      call self%expect_made(error)
      if (allocated(error)) return
      number = 0
      slash = index(path, '/', back=.true.)
      if (slash > 1) then
         is_cached = allocated(self%group)
         if (is_cached) is_cached = self%group == path(:slash - 1)
         if (.not. is_cached) then
            if (path(:slash - 1) == 'observables') call find_observables(self)
            call group_fields(self%case, self%simulation, path(:slash - 1), self%fields, self%observed)
            self%group = path(:slash - 1)
         end if
         if (len_trim(path) == len(path)) number = field_named(self%fields, path(slash + 1:))
      end if
      if (number == 0) then
         call set_error(error, MFV_BAD_ARGUMENT, "there is no field '"//path//"'")
         return
      end if
      field => self%fields(number)
      if (.not. present(whole)) return
      if (allocated(field%whole) .neqv. whole) then
         call set_error(error, MFV_BAD_ARGUMENT, path//' has '//trim(merge('reals        ', 'whole numbers', whole)))
      else if (present(single) .and. count_values(field) /= 1) then
         call set_error(error, MFV_BAD_ARGUMENT, path//' has '//to_text(int(count_values(field)))//' values, not one')
      end if
   end subroutine find_field

   !> Number of values of a field.
   pure integer(int64) function count_values(field)
      type(field_type), intent(in) :: field

      if (allocated(field%whole)) then
         count_values = size(field%whole, kind=int64)
      else
         count_values = size(field%values, kind=int64)
      end if
   end function count_values

   !> See get, as for the next three.
   subroutine get_reals(self, path, values, error)
      class(contact_type), intent(inout), target :: self
      character(*), intent(in) :: path
      real(wp), allocatable, intent(out) :: values(:)
      type(error_type), allocatable, intent(out) :: error
      type(field_type), pointer :: field

      call self%find_field(path, field, error, whole=.false.)
      if (.not. allocated(error)) values = field%values
   end subroutine get_reals

   subroutine get_integers(self, path, values, error)
      class(contact_type), intent(inout), target :: self
      character(*), intent(in) :: path
      integer, allocatable, intent(out) :: values(:)
      type(error_type), allocatable, intent(out) :: error
      type(field_type), pointer :: field

      call self%find_field(path, field, error, whole=.true.)
      if (.not. allocated(error)) values = field%whole
   end subroutine get_integers

   subroutine get_real(self, path, value, error)
      class(contact_type), intent(inout), target :: self
      character(*), intent(in) :: path
      real(wp), intent(out) :: value
      type(error_type), allocatable, intent(out) :: error
      type(field_type), pointer :: field

      value = 0.0_wp
      call self%find_field(path, field, error, whole=.false., single=.true.)
      if (.not. allocated(error)) value = field%values(1)
   end subroutine get_real

   subroutine get_integer(self, path, value, error)
      class(contact_type), intent(inout), target :: self
      character(*), intent(in) :: path
      integer, intent(out) :: value
      type(error_type), allocatable, intent(out) :: error
      type(field_type), pointer :: field

      value = 0
      call self%find_field(path, field, error, whole=.true., single=.true.)
      if (.not. allocated(error)) value = field%whole(1)
   end subroutine get_integer

   !> Names and texts of the attributes of the result: title, outcome, input and so on; valid until the state changes.
   subroutine attributes(self, names, texts)
      class(contact_type), intent(inout), target :: self
      type(string_type), pointer, intent(out) :: names(:), texts(:)

      if (.not. allocated(self%attribute_names)) then
         call find_warnings(self)
         call result_attributes(self%case, self%simulation, self%warnings, self%attribute_names, self%attribute_texts, &
                                self%observed)
      end if
      names => self%attribute_names
      texts => self%attribute_texts
   end subroutine attributes

   !> Find what a result needs and the cache has not: observables and warnings.
   subroutine find_warnings(self)
      class(contact_type), intent(inout) :: self

      if (allocated(self%warnings)) return
      call find_observables(self)
      call validity_warnings(self%simulation, self%observed, self%warnings)
      call self%case%check_moduli(self%warnings)
   end subroutine find_warnings

   !> Find the observables, if they are not cached.
   subroutine find_observables(self)
      class(contact_type), intent(inout) :: self

      if (allocated(self%observed)) return
      allocate (self%observed, source=observe(self%simulation))
   end subroutine find_observables

   !> A body (body_lower, body_upper) under the tractions of the state steps/000N, N = `step`, or of the present state (0, the
   !> default): for interior%all_stresses(x, y), largest_von_mises, largest_tension; see mfv_interior. Error MFV_BAD_ARGUMENT: a
   !> rigid body, a matrix or an unknown step.
   subroutine find_interior(self, body, interior, error, step)
      class(contact_type), intent(in) :: self
      integer, intent(in) :: body
      type(interior_type), intent(out) :: interior
      type(error_type), allocatable, intent(out) :: error
      integer, intent(in), optional :: step
      type(contact_state_type) :: state
      integer :: number
      logical :: available

      call self%expect_made(error)
      if (allocated(error)) return
      number = 0
      if (present(step)) number = step
      if (number < 0 .or. number > self%simulation%snapshot_count) then
         call set_error(error, MFV_BAD_ARGUMENT, 'there is no step '//to_text(number)//'; the result has '// &
                        to_text(self%simulation%snapshot_count))
         return
      end if
      state = self%simulation%contact%state
      if (number > 0) state = self%simulation%padded(self%simulation%snapshots(number))
      call state_interior(self%simulation%contact%model, state, body == body_upper, interior, available)
      call expect_inside(body, available, error)
   end subroutine find_interior

   !> A body under tractions (on the lower body, to the right; force/length^2) at nodes with the intervals `width` around `arc`
   !> along the surface; `contact_edge`, `stick_edge`: edges between them, as in the state of a result, NaN if there is
   !> none; shapes (nodes). `bulk_stress`: see step_to. Error MFV_BAD_ARGUMENT: no such body, a rigid one or a matrix; a bulk stress
   !> in a disk or hole.
   subroutine make_interior(self, body, arc, width, pressure, shear, contact_edge, stick_edge, bulk_stress, interior, error)
      class(contact_type), intent(in) :: self
      integer, intent(in) :: body
      real(wp), intent(in), dimension(:) :: arc, width, pressure, shear, contact_edge, stick_edge
      real(wp), intent(in) :: bulk_stress
      type(interior_type), intent(out) :: interior
      type(error_type), allocatable, intent(out) :: error
      logical :: available

      call self%case%scene%interior(body == body_upper, arc, width, pressure, shear, contact_edge, stick_edge, bulk_stress, &
                                    interior, available)
      call expect_inside(body, available, error)
      if (abs(bulk_stress) > 0.0_wp .and. .not. self%case%scene%can_have_bulk_stress(body == body_upper) .and. &
          .not. allocated(error)) call set_error(error, MFV_BAD_ARGUMENT, 'a disk or hole cannot have a bulk stress')
   end subroutine make_interior

   !> Error MFV_BAD_ARGUMENT for an invalid body number or a body without interior stresses.
   subroutine expect_inside(body, available, error)
      integer, intent(in) :: body
      logical, intent(in) :: available
      type(error_type), allocatable, intent(out) :: error

      if (body /= body_lower .and. body /= body_upper) then
         call set_error(error, MFV_BAD_ARGUMENT, 'the body must be MFV_LOWER or MFV_UPPER')
      else if (.not. available) then
         call set_error(error, MFV_BAD_ARGUMENT, 'the '//merge('upper', 'lower', body == body_upper)// &
                        ' body is rigid or given by a matrix: its stresses cannot be computed')
      end if
   end subroutine expect_inside

   !> Write the result file to `path`, or to the file of &output if that is empty. Errors MFV_FILE_ERROR, MFV_BAD_ARGUMENT.
   subroutine write (self, path, error)
      class(contact_type), intent(inout) :: self
      character(*), intent(in) :: path
      type(error_type), allocatable, intent(out) :: error
      character(:), allocatable :: where_to

      call self%expect_made(error)
      if (allocated(error)) return
      where_to = path
      if (path == '') where_to = self%case%result_path
      if (where_to == '') then
         call set_error(error, MFV_BAD_ARGUMENT, 'no path is given, and the case has no &output file')
         return
      end if
      call find_warnings(self)
      call write_result(where_to, self%case, self%simulation, self%warnings, error, observed=self%observed)
   end subroutine write

end module mfv_contact
