!> Read a valid scene from the text of a case. Messages name file, line, group, key, value and what would be right.
module mfv_case_reader
   use mfv_body_reader
   use mfv_case, only: case_type
   use mfv_case_data, only: case_data_type
   use mfv_case_keys, only: case_catalogue
   use mfv_discretisation_error, only: has_coarser_meshes
   use mfv_edge_reader, only: form_edge
   use mfv_error, only: error_type
   use mfv_friction, only: friction_type, new_friction_law
   use mfv_friction_reader
   use mfv_history_reader, only: read_history
   use mfv_key_reader
   use mfv_kinds, only: wp
   use mfv_mesh_reader, only: read_mesh, read_period
   use mfv_namelist, only: group_type, parse_namelists
   use mfv_scene
   use mfv_simulation, only: states_auto, states_steps
   use mfv_step_reader, only: check_held, read_steps
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
      case%keep_history = reader%choice('output', 1, 'history')
      case%keep_states = reader%choice('output', 1, 'states')
      if (count_groups(reader, 'history') > 0 .and. case%keep_states == states_auto) case%keep_states = states_steps
      if (reader%has('output', 1, 'stress_at')) case%stress_at = reader%real_value('output', 1, 'stress_at')
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
      scene%plane = reader%choice('scene', 1, 'plane')
      scene%coupling = reader%choice('scene', 1, 'coupling')
      call check_bodies(reader, error)
      if (.not. allocated(error)) call read_body(reader, 1, scene%plane, scene%lower, error)
      if (.not. allocated(error)) call read_body(reader, 2, scene%plane, scene%upper, error)
      scene%mesh%radial = reader%text_value('mesh', 1, 'normals') == 'radial'
      if (.not. allocated(error)) call check_pair(reader, scene, error)
      if (.not. allocated(error)) call form_edge(reader, scene, error)
      if (.not. allocated(error)) call read_period(reader, scene, error)
      if (allocated(error)) return
      call read_friction(reader, scene, error)
      if (.not. allocated(error)) call read_steps(reader, scene, error)
      if (.not. allocated(error)) call read_history(reader, scene, error)
      if (.not. allocated(error)) call check_held(reader, scene, error)
      if (.not. allocated(error)) call read_wear(reader, scene, error)
      if (.not. allocated(error)) call read_datums(reader, scene, error)
      if (.not. allocated(error)) call check_matrix(reader, scene, error)
      if (.not. allocated(error)) call read_mesh(reader, scene, error)
      if (.not. allocated(error)) call check_coefficients_a_node(reader, scene, error)
      if (allocated(error)) return
      call read_method(reader, scene%method)
      call scene%set_accuracy(scene%method%accuracy)
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
      else if (method%accuracy > 0.0_wp .and. .not. method%takes_accuracy()) then
         call reader%complain('solver', 1, 'accuracy', "has an effect with stepping='auto' or 'leap' only; remove it", error)
      end if
   end subroutine check_method

   !> How the scene is to be solved.
   subroutine read_method(reader, method)
      type(reader_type), intent(in) :: reader
      type(method_type), intent(out) :: method

      method%algorithm = reader%choice('solver', 1, 'algorithm')
      method%stepping = reader%choice('solver', 1, 'stepping')
      method%linear_solver = reader%choice('solver', 1, 'linear_solver')
      method%linear_tolerance = reader%real_value('solver', 1, 'linear_tolerance')
      method%accuracy = accuracy_by_mesh
      if (reader%has('solver', 1, 'accuracy')) method%accuracy = reader%real_value('solver', 1, 'accuracy')
      method%integration = reader%choice('solver', 1, 'integration')
      method%load_step = reader%real_value('solver', 1, 'load_step')
      if (reader%has('solver', 1, 'friction_tolerance')) &
         method%friction_tolerance = reader%real_value('solver', 1, 'friction_tolerance')
      method%most_iterations = reader%integer_value('solver', 1, 'iterations')
   end subroutine read_method

end module mfv_case_reader
