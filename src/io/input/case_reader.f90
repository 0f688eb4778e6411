!> Read a valid scene from the text of a case. Messages name file, line, group, key, value and what would be right.
module mfv_case_reader
   use mfv_body_reader
   use mfv_case, only: case_type
   use mfv_case_data, only: case_data_type
   use mfv_case_keys, only: case_catalogue
   use mfv_compliance, only: coupling_full, coupling_goodman, coupling_none
   use mfv_discretisation_error, only: has_coarser_meshes
   use mfv_error, only: error_type
   use mfv_friction, only: friction_type, new_friction_law
   use mfv_friction_reader
   use mfv_history_reader, only: check_bulk_stress, read_history
   use mfv_key_reader
   use mfv_kinds, only: wp
   use mfv_material, only: plane_strain, plane_stress
   use mfv_mesh_reader, only: read_mesh
   use mfv_motions, only: motions, motion_count, motion_approach, motion_shift, motion_upper_bulk, control_keep, &
                          control_force, control_displacement, controlled_key
   use mfv_namelist, only: group_type, parse_namelists
   use mfv_scene
   use mfv_simulation, only: history_events, history_none, history_steps, states_last_cycle, states_none, &
                             states_reversals, states_steps
   use mfv_strings, only: to_text
   use mfv_text_file, only: directory_of, read_text
   implicit none
   private
   public :: read_case_file, read_case_text, read_case_groups

contains

   !> The case in a file. `without_steps`: whether it may have no &step. Error MFV_INPUT_ERROR.
   subroutine read_case_file(path, case, error, without_steps)
      character(*), intent(in) :: path
      type(case_type), intent(out) :: case
      type(error_type), allocatable, intent(out) :: error
      logical, intent(in), optional :: without_steps
      character(:), allocatable :: text
      integer :: first, dot

      call read_text(path, text, error)
      if (allocated(error)) return
      call read_case_text(text, path, case, error, without_steps)
      if (allocated(error)) return
      if (case%result_path /= '') return
      ! The name of the file with the extension .h5; a leading dot does not begin an extension.
      first = index(path, '/', back=.true.) + 1
      dot = index(path(first:), '.', back=.true.)
      if (dot < 2) dot = len(path(first:)) + 1
      case%result_path = path(first:first + dot - 2)//'.h5'
   end subroutine read_case_file

   !> The case in a text. `source`: its name for messages, and the path to which file names are relative. `without_steps`: whether
   !> it may have no &step, for callers who apply their own steps. Error MFV_INPUT_ERROR.
   subroutine read_case_text(text, source, case, error, without_steps)
      character(*), intent(in) :: text, source
      type(case_type), intent(out) :: case
      type(error_type), allocatable, intent(out) :: error
      logical, intent(in), optional :: without_steps
      type(group_type), allocatable :: groups(:)

      call parse_namelists(text, source, groups, error)
      if (allocated(error)) return
      call read_case_groups(groups, source, directory_of(source), case, error, without_steps)
      case%text = text
   end subroutine read_case_text

   !> The case in a parsed text; the caller sets `case%text`. `directory`: of the files that it names, with its final slash; `data`:
   !> data in memory instead of such files. For the rest see read_case_text.
   subroutine read_case_groups(groups, source, directory, case, error, without_steps, data)
      type(group_type), intent(in) :: groups(:)
      character(*), intent(in) :: source, directory
      type(case_type), intent(out) :: case
      type(error_type), allocatable, intent(out) :: error
      logical, intent(in), optional :: without_steps
      type(case_data_type), intent(in), optional :: data
      type(reader_type) :: reader

      if (present(data)) reader%data = data
      if (present(without_steps)) reader%without_steps = without_steps
      reader%source = source
      reader%directory = directory
      reader%catalogue = case_catalogue()
      reader%groups = groups
      call check_groups(reader, error)
      if (.not. allocated(error)) call check_entries(reader, error)
      if (.not. allocated(error)) call check_friction_keys(reader, error)
      if (.not. allocated(error)) call check_friction_of_steps(reader, error)
      if (.not. allocated(error)) call read_scene(reader, case%scene, error)
      if (allocated(error)) return
      case%source = source
      case%length_unit = reader%text_value('scene', 1, 'length_unit')
      case%force_unit = reader%text_value('scene', 1, 'force_unit')
      case%result_path = reader%text_value('output', 1, 'file')
      case%keep_history = reader%constant('output', 1, 'history', [history_events, history_steps, history_none])
      case%keep_states = reader%constant('output', 1, 'states', [states_reversals, states_steps, states_none, states_last_cycle])
      if (count_groups(reader, 'history') > 0 .and. .not. reader%has('output', 1, 'states')) case%keep_states = states_steps
      case%checkpoint_minutes = reader%real_value('output', 1, 'checkpoint_minutes')
      case%error_estimate = reader%logical_value('output', 1, 'error_estimate')
      case%sensitivity = reader%logical_value('output', 1, 'sensitivity')
      if (case%sensitivity .and. .not. case%scene%friction%acts()) &
         call reader%complain('output', 1, 'sensitivity', 'must be .false. in a case without friction: it perturbs the '// &
                              'coefficients of friction', error)
      if (allocated(error)) return
      if (case%error_estimate .and. .not. has_coarser_meshes(case%scene)) &
         call reader%complain('output', 1, 'error_estimate', "must be .false. with shape='matrix', which has no coarser mesh", &
                              error)
   end subroutine read_case_groups

   !> The scene that the groups describe.
   subroutine read_scene(reader, scene, error)
      type(reader_type), intent(in) :: reader
      type(scene_type), intent(out) :: scene
      type(error_type), allocatable, intent(out) :: error

      scene%title = reader%text_value('scene', 1, 'title')
      scene%plane = reader%constant('scene', 1, 'plane', [plane_strain, plane_stress])
      scene%coupling = reader%constant('scene', 1, 'coupling', [coupling_full, coupling_goodman, coupling_none])
      call check_bodies(reader, error)
      if (.not. allocated(error)) call read_body(reader, 1, scene%plane, scene%lower, error)
      if (.not. allocated(error)) call read_body(reader, 2, scene%plane, scene%upper, error)
      if (.not. allocated(error)) call check_pair(reader, scene, error)
      if (allocated(error)) return
      call read_friction(reader, scene, error)
      if (.not. allocated(error)) call read_steps(reader, scene, error)
      if (.not. allocated(error)) call read_history(reader, scene, error)
      if (.not. allocated(error)) call read_wear(reader, scene, error)
      if (.not. allocated(error)) call read_datums(reader, scene, error)
      if (.not. allocated(error)) call check_matrix(reader, scene, error)
      if (.not. allocated(error)) call read_mesh(reader, scene, error)
      if (.not. allocated(error)) call check_coefficients_a_node(reader, scene, error)
      if (allocated(error)) return
      call read_method(reader, scene%method)
      call check_method(reader, scene%method, error)
   end subroutine read_scene

   !> Error for choices of the solver that exclude each other or the friction law.
   subroutine check_method(reader, method, error)
      type(reader_type), intent(in) :: reader
      type(method_type), intent(in) :: method
      type(error_type), allocatable, intent(out) :: error
      character(:), allocatable :: law
      type(friction_type) :: friction
      logical :: is_mfv

      law = reader%text_value('friction', 1, 'law')
      call new_friction_law(law, friction%law)
      is_mfv = method%algorithm == algorithm_mfv
      if (method%integration == integration_explicit .and. friction%sticks()) then
         call reader%complain('solver', 1, 'integration', "has no effect without law='dahl'; remove it", error)
      else if (method%stepping == stepping_nominal .and. .not. friction%is_linear()) then
         call reader%complain('solver', 1, 'stepping', "must be 'event' with law='"//law//"', which is not linear "// &
                              'between events', error)
      else if (method%stepping /= stepping_auto .and. .not. is_mfv) then
         call reader%complain('solver', 1, 'stepping', "has no effect with algorithm='conventional'; remove it", error)
      else if (method%stepping == stepping_leap .and. allocated(friction%law) .and. .not. friction%is_proportional()) then
         call reader%complain('solver', 1, 'stepping', "'leap' needs law='coulomb' or 'none', not '"//law//"'", error)
      else if (method%stepping == stepping_leap .and. .not. method%accuracy > 0.0_wp) then
         call reader%complain('solver', 1, 'stepping', "'leap' needs an accuracy above 0", error)
      else if (method%accuracy > 0.0_wp .and. .not. method%takes_accuracy()) then
         call reader%complain('solver', 1, 'accuracy', "has an effect with stepping='auto' or 'leap' only; remove it", error)
      end if
   end subroutine check_method

   !> How the scene is to be solved.
   subroutine read_method(reader, method)
      type(reader_type), intent(in) :: reader
      type(method_type), intent(out) :: method

      method%algorithm = reader%constant('solver', 1, 'algorithm', [algorithm_mfv, algorithm_conventional])
      method%stepping = reader%constant('solver', 1, 'stepping', [stepping_auto, stepping_event, stepping_nominal, &
                                                                  stepping_leap])
      method%linear_solver = reader%constant('solver', 1, 'linear_solver', &
                                             [solver_auto, solver_dgesv, solver_reduced, solver_fft])
      method%linear_tolerance = reader%real_value('solver', 1, 'linear_tolerance')
      method%accuracy = reader%real_value('solver', 1, 'accuracy')
      method%integration = reader%constant('solver', 1, 'integration', [integration_second_order, integration_explicit])
      method%load_step = reader%real_value('solver', 1, 'load_step')
      method%friction_tolerance = reader%real_value('solver', 1, 'friction_tolerance')
      method%most_iterations = reader%integer_value('solver', 1, 'iterations')
   end subroutine read_method

   !> The steps of the load history.
   subroutine read_steps(reader, scene, error)
      type(reader_type), intent(in) :: reader
      type(scene_type), intent(inout) :: scene
      type(error_type), allocatable, intent(out) :: error
      integer :: i, j

      if (count_groups(reader, 'step') + count_groups(reader, 'history') == 0 .and. .not. reader%without_steps) then
         call fail(reader, 0, '&step: at least one step is needed', error)
         return
      end if
      allocate (scene%steps(count_groups(reader, 'step')))
      do i = 1, size(scene%steps)
         associate (step => scene%steps(i))
            do j = 1, motion_count
               call read_target(reader, i, j, step%control(j), step%target(j), error)
               if (motions(j)%is_stress .and. step%control(j) /= control_keep .and. .not. allocated(error)) &
                  call check_bulk_stress(reader, 'step', i, j, scene, error)
               if (j == motion_shift .and. .not. allocated(error)) call read_force_ratio(reader, i, scene, error)
               if (allocated(error)) return
            end do
            step%friction = reader%logical_value('step', i, 'friction')
            step%cycles = reader%integer_value('step', i, 'cycles')
            if (reader%has('step', i, 'steady_tolerance')) then
               step%steady_tolerance = reader%real_value('step', i, 'steady_tolerance')
               if (step%cycles < 2) call reader%complain('step', i, 'steady_tolerance', 'has no effect without cycles of 2 '// &
                                                         'or more; remove it', error)
               if (allocated(error)) return
            end if
            if (all(step%control == control_keep)) then
               call fail(reader, line_of(reader, 'step', i), '&step '//to_text(i)//': needs a target: normal_force or '// &
                         'approach, tangential_force, force_ratio or shift, moment or rotation, lower_bulk_stress, '// &
                         'upper_bulk_stress', error)
               return
            end if
         end associate
      end do
   end subroutine read_steps

   !> The tangential target of step `number` as a fraction of the sliding limit mu P. The normal targets up to this step are known.
   subroutine read_force_ratio(reader, number, scene, error)
      type(reader_type), intent(in) :: reader
      integer, intent(in) :: number
      type(scene_type), intent(inout) :: scene
      type(error_type), allocatable, intent(inout) :: error
      integer :: last

      if (.not. reader%has('step', number, 'force_ratio')) return
      ! A step with cycles ends at its initial loads. The cycles of this step are read later.
      last = findloc(scene%steps(:number)%control(motion_approach) /= control_keep .and. scene%steps(:number)%cycles == 0, .true., &
                     dim=1, back=.true.)
      if (scene%steps(number)%control(motion_shift) /= control_keep) then
         call reader%complain('step', number, 'force_ratio', 'tangential_force or shift is also given; prescribe only one '// &
                              'of them', error)
      else if (.not. scene%friction%acts()) then
         call reader%complain('step', number, 'force_ratio', "needs a &friction law with a coefficient above 0", error)
      else if (.not. reader%logical_value('step', number, 'friction')) then
         call reader%complain('step', number, 'force_ratio', 'has no effect in a step without friction; remove it', error)
      else if (last == 0) then
         call reader%complain('step', number, 'force_ratio', 'needs a normal_force, in this step or in an earlier one '// &
                              'without cycles', error)
      else if (scene%steps(last)%control(motion_approach) /= control_force) then
         call reader%complain('step', number, 'force_ratio', 'needs a normal_force, but step '//to_text(last)// &
                              ' prescribes an approach', error)
      else
         scene%steps(number)%control(motion_shift) = control_force
         scene%steps(number)%target(motion_shift) = reader%real_value('step', number, 'force_ratio') &
                                                    *scene%friction%static%largest()*scene%steps(last)%target(motion_approach)
      end if
   end subroutine read_force_ratio

   !> The target of one motion of step `number`: a force or a displacement.
   subroutine read_target(reader, number, motion, control, target, error)
      type(reader_type), intent(in) :: reader
      integer, intent(in) :: number, motion
      integer, intent(out) :: control
      real(wp), intent(out) :: target
      type(error_type), allocatable, intent(out) :: error
      integer :: i

      control = control_keep
      target = 0.0_wp
      do i = merge(control_displacement, control_force, motions(motion)%is_stress), control_displacement
         if (.not. reader%has('step', number, trim(controlled_key(motion, i)))) cycle
         if (control /= control_keep) then
            call reader%complain('step', number, trim(motions(motion)%key), trim(motions(motion)%force_key)// &
                                 ' is also given; prescribe only one of '//trim(motions(motion)%force_key)//' and '// &
                                 trim(motions(motion)%key), error)
            return
         end if
         control = i
         target = reader%real_value('step', number, trim(controlled_key(motion, i)))
      end do
   end subroutine read_target

end module mfv_case_reader
