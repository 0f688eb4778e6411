!> From the text of a case to a valid scene, or to a message that names file, line, group, key, value and what is right.
module mfv_case_reader
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use mfv_body
   use mfv_case, only: case_type
   use mfv_circle, only: kernel_exact, kernel_fourier
   use mfv_case_keys
   use mfv_discretisation_error, only: has_coarser_meshes
   use mfv_error, only: error_type, set_error
   use mfv_friction
   use mfv_compliance, only: coupling_full, coupling_goodman, coupling_none
   use mfv_contact_model, only: choose_mesh
   use mfv_kinds, only: pi, wp
   use mfv_material, only: new_material, plane_strain, plane_stress
   use mfv_matrix_file, only: read_matrix_body
   use mfv_namelist, only: entry_type, group_type, parse_namelists
   use mfv_profile_file, only: read_profile, read_table
   use mfv_scene
   use mfv_simulation, only: history_events, history_none, history_steps
   use mfv_status, only: MFV_INPUT_ERROR
   use mfv_strings, only: add_text, list_of_words, lower_case, nearest_name, quoted, string_type, to_text
   use mfv_text_file, only: directory_of, read_text
   implicit none
   private
   public :: read_case_file, read_case_text

   !> A text taken apart, with the list of keys to read it by.
   type :: reader_type
      character(:), allocatable :: source
      type(group_type), allocatable :: groups(:)
      type(key_type), allocatable :: keys(:)
      logical :: without_steps = .false.
   contains
      procedure :: has
      procedure :: real_value
      procedure :: real_values
      procedure :: integer_value
      procedure :: logical_value
      procedure :: text_value
      procedure :: complain
      procedure :: need
      procedure, private :: entry_of
      procedure, private :: key_of
   end type reader_type

contains

   !> The case in a file. `without_steps`: whether it may have no &step. Error MFV_INPUT_ERROR.
   subroutine read_case_file(path, case, error, without_steps)
      character(*), intent(in) :: path
      type(case_type), intent(out) :: case
      type(error_type), allocatable, intent(out) :: error
      logical, intent(in), optional :: without_steps
      character(:), allocatable :: text, name

      call read_text(path, text, error)
      if (allocated(error)) return
      call read_case_text(text, path, case, error, without_steps)
      if (allocated(error)) return
      name = path(index(path, '/', back=.true.) + 1:)
      if (index(name, '.', back=.true.) > 1) name = name(:index(name, '.', back=.true.) - 1)
      if (case%result_path == '') case%result_path = name//'.h5'
   end subroutine read_case_file

   !> The case in a text. `source`: its name for messages; files it names are looked for beside it. `without_steps`:
   !> whether it may have no &step, for callers who take steps of their own. Error MFV_INPUT_ERROR.
   subroutine read_case_text(text, source, case, error, without_steps)
      character(*), intent(in) :: text, source
      type(case_type), intent(out) :: case
      type(error_type), allocatable, intent(out) :: error
      logical, intent(in), optional :: without_steps
      type(reader_type) :: reader

      if (present(without_steps)) reader%without_steps = without_steps
      reader%source = source
      reader%keys = case_keys()
      call parse_namelists(text, source, reader%groups, error)
      if (.not. allocated(error)) call check_groups(reader, error)
      if (.not. allocated(error)) call check_entries(reader, error)
      if (.not. allocated(error)) call check_friction_keys(reader, error)
      if (.not. allocated(error)) call check_friction_of_steps(reader, error)
      if (.not. allocated(error)) call read_scene(reader, case%scene, error)
      if (allocated(error)) return
      case%text = text
      case%source = source
      case%length_unit = reader%text_value('scene', 1, 'length_unit')
      case%force_unit = reader%text_value('scene', 1, 'force_unit')
      case%result_path = reader%text_value('output', 1, 'file')
      case%keep_history = history_events
      if (reader%text_value('output', 1, 'history') == 'steps') case%keep_history = history_steps
      if (reader%text_value('output', 1, 'history') == 'none') case%keep_history = history_none
      case%keep_reversals = reader%text_value('output', 1, 'states') == 'reversals'
      case%error_estimate = reader%logical_value('output', 1, 'error_estimate')
      if (case%error_estimate .and. .not. has_coarser_meshes(case%scene)) &
         call reader%complain('output', 1, 'error_estimate', "must be .false. with shape='matrix', which has no coarser mesh", &
                              error)
   end subroutine read_case_text

   !> Every group known, and those that must be alone alone.
   subroutine check_groups(reader, error)
      type(reader_type), intent(in) :: reader
      type(error_type), allocatable, intent(out) :: error
      character(:), allocatable :: why
      integer :: i, j

      do i = 1, size(reader%groups)
         associate (group => reader%groups(i))
            if (.not. any_equal(case_groups(), group%name)) then
               call suggest(group%name, case_groups(), '&', why)
               call fail(reader, group%line, '&'//group%name//': unknown group'// &
                         why//'; groups are '//group_list, error)
               return
            end if
            do j = 1, i - 1
               if (reader%groups(j)%name /= group%name .or. group_repeats(group%name)) cycle
               call fail(reader, group%line, '&'//group%name//': may come only once, and is already in line '// &
                         to_text(reader%groups(j)%line), error)
               return
            end do
         end associate
      end do
   end subroutine check_groups

   !> Every key known, there once, with one value of the right kind in the right range.
   subroutine check_entries(reader, error)
      type(reader_type), intent(in) :: reader
      type(error_type), allocatable, intent(out) :: error
      character(:), allocatable :: why, written
      integer :: i, j, k

      do i = 1, size(reader%groups)
         do j = 1, size(reader%groups(i)%entries)
            associate (group => reader%groups(i)%name, entry => reader%groups(i)%entries(j))
               k = reader%key_of(group, entry%key)
               if (k == 0) then
                  call suggest(entry%key, keys_of(reader, group), '', why)
                  why = 'unknown key'//why
               else if (any([(reader%groups(i)%entries(k)%key == entry%key, k=1, j - 1)])) then
                  why = 'the key is there twice'
               else
                  call find_fault(reader%keys(reader%key_of(group, entry%key)), entry, why)
               end if
               if (why /= '') then
                  call write_entry(entry, written)
                  call fail(reader, entry%line, '&'//group//' '//written//': '//why, error)
                  return
               end if
            end associate
         end do
      end do
   end subroutine check_entries

   !> What is wrong with the value of an entry; empty when nothing is.
   subroutine find_fault(key, entry, why)
      type(key_type), intent(in) :: key
      type(entry_type), intent(in) :: entry
      character(:), allocatable, intent(out) :: why
      real(wp) :: value
      integer :: code
      logical :: right
      integer :: i

      right = size(entry%values) == 1 .or. (key%is_list .and. size(entry%values) > 1)
      do i = 1, size(entry%values)
         if (.not. right) exit
         right = entry%is_quoted(i) .eqv. (key%kind == kind_text .or. key%kind == kind_choice)
         if (.not. right) exit
         select case (key%kind)
         case (kind_choice)
            right = any_equal(list_of_words(key%choices), entry%values(i)%text)
         case (kind_logical)
            right = logical_code(entry%values(i)%text) >= 0
         case (kind_integer, kind_real)
            call read_number(entry%values(i)%text, key%kind, value, code)
            right = code == 0 .and. value >= key%lower .and. value <= key%upper
            if (right .and. key%lower_open) right = value > key%lower
         end select
      end do
      why = ''
      if (right) return
      call describe_allowed(key, why)
      why = 'must be '//why
      if (key%unit /= '') why = why//' ('//key%unit//')'
   end subroutine find_fault

   !> A finite number; `code` is not 0 where the text is none.
   pure subroutine read_number(text, kind, value, code)
      character(*), intent(in) :: text
      integer, intent(in) :: kind
      real(wp), intent(out) :: value
      integer, intent(out) :: code
      character(*), parameter :: digits = '0123456789+-'
      integer :: whole

      value = 0.0_wp
      code = 1
      if (kind == kind_integer) then
         if (verify(text, digits) > 0) return
         read (text, *, iostat=code) whole
         if (code == 0) value = whole
      else
         if (verify(text, digits//'.eEdD') > 0 .or. scan(text, '0123456789') == 0) return
         read (text, *, iostat=code) value
         if (code == 0 .and. .not. ieee_is_finite(value)) code = 1
      end if
   end subroutine read_number

   !> 1 for true, 0 for false, -1 for neither.
   pure integer function logical_code(text)
      character(*), intent(in) :: text

      select case (lower_case(text))
      case ('.true.', 't', 'true', '.t.')
         logical_code = 1
      case ('.false.', 'f', 'false', '.f.')
         logical_code = 0
      case default
         logical_code = -1
      end select
   end function logical_code

   !> The scene that the groups describe.
   subroutine read_scene(reader, scene, error)
      type(reader_type), intent(in) :: reader
      type(scene_type), intent(out) :: scene
      type(error_type), allocatable, intent(out) :: error

      scene%title = reader%text_value('scene', 1, 'title')
      scene%plane = merge(plane_stress, plane_strain, reader%text_value('scene', 1, 'plane') == 'stress')
      select case (reader%text_value('scene', 1, 'coupling'))
      case ('full')
         scene%coupling = coupling_full
      case ('goodman')
         scene%coupling = coupling_goodman
      case ('none')
         scene%coupling = coupling_none
      end select
      call check_bodies(reader, error)
      if (.not. allocated(error)) call read_body(reader, 1, scene%plane, scene%lower, error)
      if (.not. allocated(error)) call read_body(reader, 2, scene%plane, scene%upper, error)
      if (.not. allocated(error)) call check_pair(reader, scene, error)
      if (allocated(error)) return
      call read_datums(reader, scene)
      call read_friction(reader, scene, error)
      if (.not. allocated(error)) call read_steps(reader, scene, error)
      if (.not. allocated(error)) call check_matrix(reader, scene, error)
      if (.not. allocated(error)) call read_mesh(reader, scene, error)
      if (.not. allocated(error)) call check_coefficients_a_node(reader, scene, error)
      if (.not. allocated(error)) call check_method(reader, error)
      call read_method(reader, scene%method)
   end subroutine read_scene

   !> Two bodies with a shape each, of which one at least is elastic.
   subroutine check_bodies(reader, error)
      type(reader_type), intent(in) :: reader
      type(error_type), allocatable, intent(out) :: error
      integer :: body

      if (count_groups(reader, 'body') /= 2) then
         call fail(reader, 0, '&body: two bodies are needed, the first below and the second above; there are '// &
                   to_text(count_groups(reader, 'body')), error)
         return
      end if
      do body = 1, 2
         call reader%need('body', body, 'shape', error)
         if (allocated(error)) return
      end do
      if (reader%logical_value('body', 1, 'rigid') .and. reader%logical_value('body', 2, 'rigid')) then
         call reader%complain('body', 2, 'rigid', 'both bodies are rigid; one at least must be elastic', error)
      else if (reader%text_value('body', 2, 'shape') == 'matrix') then
         call reader%complain('body', 2, 'shape', 'a matrix must be the first body, below', error)
      else if (reader%text_value('body', 1, 'shape') == 'matrix' .and. .not. reader%logical_value('body', 2, 'rigid')) then
         call reader%complain('body', 2, 'rigid', 'must be .true. above a matrix; put the compliance of both bodies '// &
                              'into the matrix instead', error)
      end if
      do body = 1, 2
         if (.not. allocated(error)) call check_body_keys(reader, body, error)
      end do
   end subroutine check_bodies

   !> Keys that mean nothing for the shape of their body are mistakes.
   subroutine check_body_keys(reader, body, error)
      type(reader_type), intent(in) :: reader
      integer, intent(in) :: body
      type(error_type), allocatable, intent(out) :: error
      type(string_type), allocatable :: keys(:)
      character(:), allocatable :: shape, allowed
      logical :: rigid
      integer :: i

      shape = reader%text_value('body', body, 'shape')
      rigid = reader%logical_value('body', body, 'rigid')
      if (shape == 'flat_punch' .and. .not. rigid) then
         call reader%complain('body', body, 'rigid', 'must be .true. for a flat_punch', error)
         return
      else if (shape == 'matrix' .and. rigid) then
         call reader%complain('body', body, 'rigid', 'a matrix is elastic', error)
         return
      end if
      allowed = 'shape rigid'
      if (shape == 'disk' .or. shape == 'hole') allowed = allowed//' radius'
      if (shape == 'flat_punch') allowed = allowed//' half_width'
      if (shape == 'profile' .or. shape == 'matrix') allowed = allowed//' file'
      if (shape /= 'matrix' .and. .not. rigid) allowed = allowed//' shear_modulus youngs_modulus poisson_ratio '// &
                                                         'yield_strength datum'
      if ((shape == 'disk' .or. shape == 'hole') .and. .not. rigid) allowed = allowed//' kernel harmonics'
      keys = keys_of(reader, 'body')
      do i = 1, size(keys)
         if (.not. reader%has('body', body, keys(i)%text)) cycle
         if (index(' '//allowed//' ', ' '//keys(i)%text//' ') > 0) cycle
         call reader%complain('body', body, keys(i)%text, 'means nothing for a '//merge_text(rigid, 'rigid ', '')//shape// &
                              '; its keys are '//allowed, error)
         return
      end do
   end subroutine check_body_keys

   !> One body: shape, then what it is made of.
   subroutine read_body(reader, number, plane, body, error)
      type(reader_type), intent(in) :: reader
      integer, intent(in) :: number, plane
      type(body_type), intent(out) :: body
      type(error_type), allocatable, intent(out) :: error

      call read_shape(reader, number, body, error)
      if (allocated(error)) return
      body%rigid = reader%logical_value('body', number, 'rigid')
      if (body%rigid .or. body%shape == shape_matrix) return
      call read_material(reader, number, plane, body, error)
      if (allocated(error)) return
      if (reader%has('body', number, 'yield_strength')) &
         body%yield_strength = reader%real_value('body', number, 'yield_strength')
      body%kernel = merge(kernel_fourier, kernel_exact, reader%text_value('body', number, 'kernel') == 'fourier')
      if (.not. reader%has('body', number, 'harmonics')) return
      body%harmonics = reader%integer_value('body', number, 'harmonics')
      if (body%kernel /= kernel_fourier) call reader%complain('body', number, 'harmonics', &
                                                              "means nothing without kernel='fourier'", error)
   end subroutine read_body

   subroutine read_shape(reader, number, body, error)
      type(reader_type), intent(in) :: reader
      integer, intent(in) :: number
      type(body_type), intent(out) :: body
      type(error_type), allocatable, intent(out) :: error
      character(:), allocatable :: shape, needed

      shape = reader%text_value('body', number, 'shape')
      needed = ''
      if (shape == 'disk' .or. shape == 'hole') needed = 'radius'
      if (shape == 'flat_punch') needed = 'half_width'
      if (shape == 'profile' .or. shape == 'matrix') needed = 'file'
      if (needed /= '') call reader%need('body', number, needed, error)
      if (allocated(error)) return
      select case (shape)
      case ('half_plane')
         body = new_half_plane_body()
      case ('disk')
         body = new_disk(reader%real_value('body', number, 'radius'))
      case ('hole')
         body = new_hole(reader%real_value('body', number, 'radius'))
      case ('flat_punch')
         body = new_flat_punch(reader%real_value('body', number, 'half_width'))
      case default
         call read_body_file(reader, number, body, error)
      end select
   end subroutine read_shape

   !> The file of a profile or a matrix, beside the case.
   subroutine read_body_file(reader, number, body, error)
      type(reader_type), intent(in) :: reader
      integer, intent(in) :: number
      type(body_type), intent(out) :: body
      type(error_type), allocatable, intent(out) :: error
      type(error_type), allocatable :: file_error
      character(:), allocatable :: path

      call find_file(reader, 'body', number, 'file', path)
      if (reader%text_value('body', number, 'shape') == 'profile') then
         call read_profile(path, body, file_error)
      else
         call read_matrix_body(path, body, file_error)
      end if
      if (allocated(file_error)) call reader%complain('body', number, 'file', file_error%message, error)
   end subroutine read_body_file

   !> The elastic material.
   subroutine read_material(reader, number, plane, body, error)
      type(reader_type), intent(in) :: reader
      integer, intent(in) :: number, plane
      type(body_type), intent(inout) :: body
      type(error_type), allocatable, intent(out) :: error
      real(wp) :: modulus, ratio

      call reader%need('body', number, 'poisson_ratio', error)
      if (allocated(error)) return
      ratio = reader%real_value('body', number, 'poisson_ratio')
      if (reader%has('body', number, 'youngs_modulus')) then
         if (reader%has('body', number, 'shear_modulus')) then
            call reader%complain('body', number, 'youngs_modulus', 'shear_modulus is there too; give one of them', error)
            return
         end if
         modulus = reader%real_value('body', number, 'youngs_modulus')/(2.0_wp*(1.0_wp + ratio))
      else
         call reader%need('body', number, 'shear_modulus', error)
         if (allocated(error)) return
         modulus = reader%real_value('body', number, 'shear_modulus')
      end if
      body%material = new_material(modulus, ratio, plane)
   end subroutine read_material

   !> Two bodies that touch at their poles and part from there.
   subroutine check_pair(reader, scene, error)
      type(reader_type), intent(in) :: reader
      type(scene_type), intent(in) :: scene
      type(error_type), allocatable, intent(out) :: error
      integer :: number

      if (any([scene%lower%shape, scene%upper%shape] == shape_profile) .or. scene%lower%shape == shape_matrix) return
      number = 2
      if (scene%lower%shape == shape_hole) number = 1
      if (scene%lower%shape == shape_hole .or. scene%upper%shape == shape_hole) then
         if (.not. scene%curvature() > 0.0_wp) &
            call reader%complain('body', number, 'radius', 'a hole needs a disk of a smaller radius in it', error)
      else if (.not. scene%curvature() > 0.0_wp .and. &
               .not. any([scene%lower%shape, scene%upper%shape] == shape_flat_punch)) then
         call reader%complain('body', 2, 'shape', 'two half-planes touch everywhere; one body must be curved or a profile', error)
      end if
      if (allocated(error) .or. scene%lower%shape /= shape_flat_punch .or. scene%upper%shape /= shape_flat_punch) return
      call reader%complain('body', 2, 'shape', 'two flat punches make no contact of elastic bodies', error)
   end subroutine check_pair

   !> Friction needs the tangential components of a matrix.
   subroutine check_matrix(reader, scene, error)
      type(reader_type), intent(in) :: reader
      type(scene_type), intent(in) :: scene
      type(error_type), allocatable, intent(out) :: error

      if (scene%lower%shape /= shape_matrix .or. .not. scene%friction%acts()) return
      if (size(scene%lower%matrix, 1) > size(scene%lower%position)) return
      call reader%complain('body', 1, 'file', 'the matrix has normal components only; friction needs the tangential ones too', &
                           error)
   end subroutine check_matrix

   !> Where the displacements of the elastic bodies are measured.
   subroutine read_datums(reader, scene)
      type(reader_type), intent(in) :: reader
      type(scene_type), intent(inout) :: scene

      call read_datum(1, scene%lower, scene%upper)
      call read_datum(2, scene%upper, scene%lower)

   contains

      subroutine read_datum(number, body, other)
         integer, intent(in) :: number
         type(body_type), intent(inout) :: body
         type(body_type), intent(in) :: other

         body%datum = merge(body%radius, min(body%half_extent(), other%half_extent()), body%circular())
         if (reader%has('body', number, 'datum')) body%datum = reader%real_value('body', number, 'datum')
      end subroutine read_datum
   end subroutine read_datums

   !> The mesh, which must see both bodies, and fit the circle of a Fourier series.
   subroutine read_mesh(reader, scene, error)
      type(reader_type), intent(in) :: reader
      type(scene_type), intent(inout) :: scene
      type(error_type), allocatable, intent(out) :: error
      character(*), parameter :: keys(3) = [character(10) :: 'nodes', 'half_width', 'half_angle']
      integer, parameter :: most_carried = 1000000
      integer :: i

      scene%mesh%nodes = reader%integer_value('mesh', 1, 'nodes')
      scene%mesh%parabolic = reader%text_value('mesh', 1, 'gap') == 'parabolic'
      if (reader%has('mesh', 1, 'gap') .and. .not. (scene%lower%circular() .or. scene%upper%circular())) then
         call reader%complain('mesh', 1, 'gap', 'means nothing without a disk', error)
         return
      end if
      scene%mesh%radial = reader%text_value('mesh', 1, 'normals') == 'radial'
      if (scene%mesh%radial .and. .not. (scene%lower%circular() .and. scene%upper%circular() .and. &
                                         scene%lower%shape /= scene%upper%shape)) then
         call reader%complain('mesh', 1, 'normals', 'means nothing without a disk in a hole', error)
      else if (scene%mesh%radial .and. scene%mesh%parabolic) then
         call reader%complain('mesh', 1, 'normals', "must be 'vertical' with gap='parabolic'", error)
      end if
      if (allocated(error)) return
      do i = 1, size(keys)
         if (scene%lower%shape /= shape_matrix .or. .not. reader%has('mesh', 1, trim(keys(i)))) cycle
         call reader%complain('mesh', 1, trim(keys(i)), 'means nothing for a matrix, which has its own nodes', error)
         return
      end do
      if (reader%has('mesh', 1, 'half_width')) scene%mesh%half_width = reader%real_value('mesh', 1, 'half_width')
      if (reader%has('mesh', 1, 'half_angle')) call read_half_angle(reader, scene, error)
      if (allocated(error)) return
      if (scene%mesh%nodes > most_carried .and. .not. scene%mesh%whole_circle) then
         call reader%complain('mesh', 1, 'nodes', 'can be more than '//to_text(most_carried)//' only with half_angle=180', &
                              error)
         return
      end if
      call check_mesh_is_under(reader, scene, error)
      if (.not. allocated(error)) call check_circle(reader, 1, scene, scene%lower, error)
      if (.not. allocated(error)) call check_circle(reader, 2, scene, scene%upper, error)
   end subroutine read_mesh

   subroutine read_half_angle(reader, scene, error)
      type(reader_type), intent(in) :: reader
      type(scene_type), intent(inout) :: scene
      type(error_type), allocatable, intent(out) :: error
      real(wp), parameter :: half_turn = 180.0_wp
      real(wp) :: half_angle

      half_angle = reader%real_value('mesh', 1, 'half_angle')
      if (reader%has('mesh', 1, 'half_width')) then
         call reader%complain('mesh', 1, 'half_angle', 'half_width is there too; give one of them', error)
      else if (.not. scene%arc_radius() > 0.0_wp) then
         call reader%complain('mesh', 1, 'half_angle', 'means nothing without an elastic disk or hole; use half_width', &
                              error)
      else
         scene%mesh%whole_circle = .not. half_angle < half_turn
         if (.not. scene%mesh%whole_circle) scene%mesh%half_width = scene%arc_radius()*pi*half_angle/half_turn
      end if
   end subroutine read_half_angle

   !> A node at least that both bodies can touch.
   subroutine check_mesh_is_under(reader, scene, error)
      type(reader_type), intent(in) :: reader
      type(scene_type), intent(in) :: scene
      type(error_type), allocatable, intent(out) :: error
      real(wp) :: interval
      integer :: i, nodes
      logical :: growing

      if (scene%lower%shape == shape_matrix) then
         if (any(scene%touchable(scene%lower%position))) return
         call reader%complain('body', 1, 'file', 'no node of this body is under the indenter', error)
         return
      end if
      call choose_mesh(scene, nodes, interval, growing)
      do i = 1, nodes
         if (scene%touchable(0.5_wp*interval*(2*i - nodes - 1))) return
      end do
      call reader%complain('mesh', 1, trim(mesh_key(reader)), 'no node of this mesh is under the indenter', error)
   end subroutine check_mesh_is_under

   !> The key of the mesh to complain about; padded with blanks.
   pure function mesh_key(reader) result(key)
      type(reader_type), intent(in) :: reader
      character(len=10) :: key

      key = 'nodes'
      if (reader%has('mesh', 1, 'half_width')) key = 'half_width'
      if (reader%has('mesh', 1, 'half_angle')) key = 'half_angle'
   end function mesh_key

   !> A Fourier series needs a circle of a whole number of intervals, and no more of it than there is.
   subroutine check_circle(reader, number, scene, body, error)
      type(reader_type), intent(in) :: reader
      integer, intent(in) :: number
      type(scene_type), intent(in) :: scene
      type(body_type), intent(in) :: body
      type(error_type), allocatable, intent(out) :: error
      real(wp), parameter :: whole = 1.0e-9_wp, most_intervals = 5.0e7_wp
      real(wp) :: interval, intervals
      integer :: nodes
      logical :: growing

      if (body%rigid .or. .not. body%circular()) return
      call choose_mesh(scene, nodes, interval, growing)
      intervals = 2.0_wp*pi*body%radius/interval
      if (nodes > intervals*(1.0_wp + whole)) then
         call reader%complain('mesh', 1, trim(mesh_key(reader)), &
                              'goes more than once round body '//to_text(number), error)
      else if (body%kernel == kernel_fourier .and. intervals > most_intervals) then
         call reader%complain('body', number, 'kernel', 'the circle would have '//to_text(intervals, 3)// &
                              ' intervals, more than '//to_text(most_intervals)//"; use kernel='exact'", error)
      else if (body%kernel == kernel_fourier .and. abs(intervals - anint(intervals)) > whole*intervals) then
         call reader%complain('body', number, 'kernel', 'needs a whole number of intervals on the circle, there are '// &
                              to_text(intervals, 10)//"; make 180*nodes/half_angle whole, or use kernel='exact'", error)
      end if
   end subroutine check_circle

   !> The friction law; its keys have been checked.
   subroutine read_friction(reader, scene, error)
      type(reader_type), intent(in) :: reader
      type(scene_type), intent(inout) :: scene
      type(error_type), allocatable, intent(out) :: error
      real(wp) :: exponent

      select case (reader%text_value('friction', 1, 'law'))
      case ('coulomb')
         scene%friction = coulomb_friction(0.0_wp)
      case ('static_kinetic')
         scene%friction = static_kinetic_friction(0.0_wp, 0.0_wp)
      case ('weakening')
         scene%friction = weakening_friction(0.0_wp, 0.0_wp, reader%real_value('friction', 1, 'weakening_distance'))
      case ('dahl')
         exponent = 1.0_wp
         if (reader%has('friction', 1, 'exponent')) exponent = reader%real_value('friction', 1, 'exponent')
         scene%friction = dahl_friction(0.0_wp, reader%real_value('friction', 1, 'stiffness'), exponent)
      case default
         scene%friction = no_friction()
         return
      end select
      call read_coefficients(reader, scene%friction, error)
   end subroutine read_friction

   !> Keys that the law needs, and none that mean nothing to it.
   subroutine check_friction_keys(reader, error)
      type(reader_type), intent(in) :: reader
      type(error_type), allocatable, intent(out) :: error
      character(:), allocatable :: law, coefficients, needed
      type(string_type), allocatable :: keys(:)
      integer :: i

      law = reader%text_value('friction', 1, 'law')
      call keys_of_law(law, coefficients, needed)
      keys = keys_of(reader, 'friction')
      do i = 1, size(keys)
         if (.not. reader%has('friction', 1, keys(i)%text)) cycle
         if (index(' law '//coefficients//' '//needed//' exponent mu_file ', ' '//keys(i)%text//' ') == 0 .or. &
             (keys(i)%text == 'exponent' .and. law /= 'dahl') .or. (keys(i)%text == 'mu_file' .and. law == 'none')) then
            call reader%complain('friction', 1, keys(i)%text, "means nothing with law='"//law//"'", error)
         else if (index(' '//coefficients//' ', ' '//keys(i)%text//' ') > 0 .and. reader%has('friction', 1, 'mu_file')) then
            call reader%complain('friction', 1, keys(i)%text, 'mu_file is there too; give one of them', error)
         end if
         if (allocated(error)) return
      end do
      if (.not. reader%has('friction', 1, 'mu_file')) needed = coefficients//' '//needed
      keys = list_of_words(needed)
      do i = 1, size(keys)
         call reader%need('friction', 1, keys(i)%text, error)
         if (allocated(error)) return
      end do
   end subroutine check_friction_keys

   !> Keys of a law's coefficients, and what else it needs; separated by blanks.
   subroutine keys_of_law(law, coefficients, needed)
      character(*), intent(in) :: law
      character(:), allocatable, intent(out) :: coefficients, needed

      coefficients = ''
      needed = ''
      if (law == 'coulomb' .or. law == 'dahl') coefficients = 'mu'
      if (has_two_coefficients(law)) coefficients = 'mu_static mu_kinetic'
      if (law == 'weakening') needed = 'weakening_distance'
      if (law == 'dahl') needed = 'stiffness'
   end subroutine keys_of_law

   pure logical function has_two_coefficients(law)
      character(*), intent(in) :: law

      has_two_coefficients = law == 'static_kinetic' .or. law == 'weakening'
   end function has_two_coefficients

   !> Coefficients of friction: numbers, one number a node, or a file.
   subroutine read_coefficients(reader, friction, error)
      type(reader_type), intent(in) :: reader
      type(friction_type), intent(inout) :: friction
      type(error_type), allocatable, intent(out) :: error

      if (reader%has('friction', 1, 'mu_file')) then
         call read_mu_file(reader, friction, error)
      else if (reader%has('friction', 1, 'mu')) then
         call reader%real_values('friction', 1, 'mu', friction%static%value)
         friction%kinetic = friction%static
      else
         call reader%real_values('friction', 1, 'mu_static', friction%static%value)
         call reader%real_values('friction', 1, 'mu_kinetic', friction%kinetic%value)
         call spread_single(friction%kinetic%value, size(friction%static%value))
         call spread_single(friction%static%value, size(friction%kinetic%value))
         if (size(friction%static%value) /= size(friction%kinetic%value)) then
            call reader%complain('friction', 1, 'mu_kinetic', 'must have one value or as many as mu_static', error)
         else if (any(friction%kinetic%value > friction%static%value)) then
            call reader%complain('friction', 1, 'mu_kinetic', 'must not be above mu_static', error)
         end if
      end if
   end subroutine read_coefficients

   !> Make `number` values of a single one.
   subroutine spread_single(values, number)
      real(wp), allocatable, intent(inout) :: values(:)
      integer, intent(in) :: number

      if (size(values) == 1 .and. number > 1) values = spread(values(1), 1, number)
   end subroutine spread_single

   !> Coefficients along x from the file of &friction mu_file.
   subroutine read_mu_file(reader, friction, error)
      type(reader_type), intent(in) :: reader
      type(friction_type), intent(inout) :: friction
      type(error_type), allocatable, intent(out) :: error
      type(error_type), allocatable :: file_error
      character(:), allocatable :: path
      real(wp), allocatable :: table(:, :)

      call find_file(reader, 'friction', 1, 'mu_file', path)
      if (has_two_coefficients(reader%text_value('friction', 1, 'law'))) then
         call read_table(path, 'x, mu_static and mu_kinetic', 3, .true., table, file_error)
      else
         call read_table(path, 'x and mu', 2, .true., table, file_error)
      end if
      if (allocated(file_error)) then
         call reader%complain('friction', 1, 'mu_file', file_error%message, error)
      else if (size(table, 2) < 2) then
         call reader%complain('friction', 1, 'mu_file', path//': needs at least 2 lines of numbers', error)
      else if (any(table(2:, :) < 0.0_wp)) then
         call reader%complain('friction', 1, 'mu_file', path//': coefficients must not be negative', error)
      else if (any(table(size(table, 1), :) > table(2, :))) then
         call reader%complain('friction', 1, 'mu_file', path//': mu_kinetic must not be above mu_static', error)
      end if
      if (allocated(error)) return
      ! Component by component: gfortran 12 makes garbage of a constructor with sections of an array.
      friction%static%value = table(2, :)
      friction%static%position = table(1, :)
      friction%kinetic%value = table(size(table, 1), :)
      friction%kinetic%position = table(1, :)
   end subroutine read_mu_file

   !> Path of a file that a key names, beside the case.
   subroutine find_file(reader, group, number, name, path)
      type(reader_type), intent(in) :: reader
      character(*), intent(in) :: group, name
      integer, intent(in) :: number
      character(:), allocatable, intent(out) :: path

      path = reader%text_value(group, number, name)
      if (path(1:min(1, len(path))) /= '/') path = directory_of(reader%source)//path
   end subroutine find_file

   !> Coefficients given one a node need a mesh that is fixed, and as many nodes.
   subroutine check_coefficients_a_node(reader, scene, error)
      type(reader_type), intent(in) :: reader
      type(scene_type), intent(in) :: scene
      type(error_type), allocatable, intent(out) :: error
      character(:), allocatable :: key
      integer :: nodes

      if (.not. allocated(scene%friction%static%value) .or. allocated(scene%friction%static%position)) return
      if (size(scene%friction%static%value) == 1) return
      key = 'mu_static'
      if (reader%has('friction', 1, 'mu')) key = 'mu'
      nodes = scene%mesh%nodes
      if (scene%lower%shape == shape_matrix) nodes = size(scene%lower%position)
      if (scene%lower%shape /= shape_matrix .and. .not. scene%mesh%half_width > 0.0_wp) then
         call reader%complain('friction', 1, key, 'one value a node needs a mesh with half_width or half_angle', error)
      else if (size(scene%friction%static%value) /= nodes) then
         call reader%complain('friction', 1, key, 'must have one value or one a node, '//to_text(nodes)//', not '// &
                              to_text(size(scene%friction%static%value)), error)
      end if
   end subroutine check_coefficients_a_node

   !> Choices of the solver that do not go together, or with the friction law.
   subroutine check_method(reader, error)
      type(reader_type), intent(in) :: reader
      type(error_type), allocatable, intent(out) :: error
      character(:), allocatable :: law

      law = reader%text_value('friction', 1, 'law')
      if (reader%text_value('solver', 1, 'stepping') == 'nominal') then
         if (reader%text_value('solver', 1, 'algorithm') == 'conventional') &
            call reader%complain('solver', 1, 'stepping', "means nothing with algorithm='conventional'", error)
         if (law == 'weakening' .or. law == 'dahl') &
            call reader%complain('solver', 1, 'stepping', "must be 'event' with law='"//law//"', which is not linear "// &
                                 'between events', error)
      end if
      if (reader%text_value('solver', 1, 'stepping') == 'leap') then
         if (reader%text_value('solver', 1, 'algorithm') == 'conventional') then
            call reader%complain('solver', 1, 'stepping', "means nothing with algorithm='conventional'", error)
         else if (law /= 'coulomb' .and. law /= 'none') then
            call reader%complain('solver', 1, 'stepping', "'leap' needs law='coulomb' or 'none', not '"//law//"'", error)
         end if
      end if
      if (reader%real_value('solver', 1, 'event_tolerance') > 0.0_wp) then
         if (reader%text_value('solver', 1, 'algorithm') == 'conventional' .or. &
             reader%text_value('solver', 1, 'stepping') /= 'event') then
            call reader%complain('solver', 1, 'event_tolerance', "means nothing without algorithm='mfv' and stepping='event'", &
                                 error)
         else if (law /= 'coulomb' .and. law /= 'none') then
            call reader%complain('solver', 1, 'event_tolerance', "needs law='coulomb' or 'none', not '"//law//"'", error)
         end if
      end if
      if (reader%text_value('solver', 1, 'integration') == 'explicit' .and. law /= 'dahl') &
         call reader%complain('solver', 1, 'integration', "means nothing without law='dahl'", error)
   end subroutine check_method

   !> How the scene is to be solved.
   subroutine read_method(reader, method)
      type(reader_type), intent(in) :: reader
      type(method_type), intent(out) :: method

      method%algorithm = merge(algorithm_conventional, algorithm_mfv, &
                               reader%text_value('solver', 1, 'algorithm') == 'conventional')
      select case (reader%text_value('solver', 1, 'stepping'))
      case ('nominal')
         method%stepping = stepping_nominal
      case ('leap')
         method%stepping = stepping_leap
      case default
         method%stepping = stepping_event
      end select
      select case (reader%text_value('solver', 1, 'linear_solver'))
      case ('dgesv')
         method%linear_solver = solver_dgesv
      case ('reduced')
         method%linear_solver = solver_reduced
      case ('fft')
         method%linear_solver = solver_fft
      case default
         method%linear_solver = solver_auto
      end select
      method%linear_tolerance = reader%real_value('solver', 1, 'linear_tolerance')
      method%event_tolerance = reader%real_value('solver', 1, 'event_tolerance')
      method%leap_tolerance = reader%real_value('solver', 1, 'leap_tolerance')
      method%integration = merge(integration_explicit, integration_second_order, &
                                 reader%text_value('solver', 1, 'integration') == 'explicit')
      method%load_step = reader%real_value('solver', 1, 'load_step')
      method%friction_tolerance = reader%real_value('solver', 1, 'friction_tolerance')
      method%most_iterations = reader%integer_value('solver', 1, 'iterations')
   end subroutine read_method

   !> The steps of the load history.
   subroutine read_steps(reader, scene, error)
      type(reader_type), intent(in) :: reader
      type(scene_type), intent(inout) :: scene
      type(error_type), allocatable, intent(out) :: error
      integer :: i

      if (count_groups(reader, 'step') == 0 .and. .not. reader%without_steps) then
         call fail(reader, 0, '&step: at least one step is needed', error)
         return
      end if
      allocate (scene%steps(count_groups(reader, 'step')))
      do i = 1, size(scene%steps)
         associate (step => scene%steps(i))
            call read_target(reader, i, 'normal_force', 'approach', step%normal_control, step%normal_target, error)
            if (allocated(error)) return
            call read_target(reader, i, 'tangential_force', 'shift', step%tangential_control, step%tangential_target, error)
            if (allocated(error)) return
            call read_target(reader, i, 'moment', 'rotation', step%rotational_control, step%rotational_target, error)
            if (allocated(error)) return
            step%friction = reader%logical_value('step', i, 'friction')
            step%cycles = reader%integer_value('step', i, 'cycles')
            if (reader%has('step', i, 'steady_tolerance')) then
               step%steady_tolerance = reader%real_value('step', i, 'steady_tolerance')
               if (step%cycles < 2) call reader%complain('step', i, 'steady_tolerance', 'means nothing without cycles of 2 or '// &
                                                         'more', error)
               if (allocated(error)) return
            end if
            if (all([step%normal_control, step%tangential_control, step%rotational_control] == control_keep)) then
               call fail(reader, line_of(reader, 'step', i), '&step '//to_text(i)//': needs a target: normal_force or '// &
                         'approach, tangential_force or shift, moment or rotation', error)
               return
            end if
         end associate
      end do
   end subroutine read_steps

   !> The target of one direction of step `number`: a force or a displacement.
   subroutine read_target(reader, number, force, displacement, control, target, error)
      type(reader_type), intent(in) :: reader
      integer, intent(in) :: number
      character(*), intent(in) :: force, displacement
      integer, intent(out) :: control
      real(wp), intent(out) :: target
      type(error_type), allocatable, intent(out) :: error

      control = control_keep
      target = 0.0_wp
      if (reader%has('step', number, force)) then
         control = control_force
         target = reader%real_value('step', number, force)
      end if
      if (.not. reader%has('step', number, displacement)) return
      if (control /= control_keep) then
         call reader%complain('step', number, displacement, force//' is there too; a step controls one of them', error)
         return
      end if
      control = control_displacement
      target = reader%real_value('step', number, displacement)
   end subroutine read_target

   !> Without friction no tangential force can be carried.
   subroutine check_friction_of_steps(reader, error)
      type(reader_type), intent(in) :: reader
      type(error_type), allocatable, intent(out) :: error
      real(wp), allocatable :: coefficients(:)
      logical :: law
      integer :: i

      law = reader%text_value('friction', 1, 'law') /= 'none'
      if (law .and. reader%has('friction', 1, 'mu')) then
         call reader%real_values('friction', 1, 'mu', coefficients)
         law = any(coefficients > 0.0_wp)
      else if (law .and. reader%has('friction', 1, 'mu_static')) then
         call reader%real_values('friction', 1, 'mu_static', coefficients)
         law = any(coefficients > 0.0_wp)
      end if
      do i = 1, count_groups(reader, 'step')
         if (.not. reader%has('step', i, 'tangential_force')) cycle
         if (.not. abs(reader%real_value('step', i, 'tangential_force')) > 0.0_wp) cycle
         if (law .and. reader%logical_value('step', i, 'friction')) cycle
         call reader%complain('step', i, 'tangential_force', 'must be 0 in a step without friction (or where every '// &
                              'coefficient is 0)', error)
         return
      end do
   end subroutine check_friction_of_steps

   !> Place of a key in the list of keys, 0 for none.
   pure integer function key_of(self, group, name)
      class(reader_type), intent(in) :: self
      character(*), intent(in) :: group, name

      do key_of = size(self%keys), 1, -1
         if (self%keys(key_of)%group == group .and. self%keys(key_of)%name == name) return
      end do
   end function key_of

   !> The entry of a key in the `number`-th group of a name; `found` false where it is not written.
   pure subroutine entry_of(self, group, number, name, entry, found)
      class(reader_type), intent(in) :: self
      character(*), intent(in) :: group, name
      integer, intent(in) :: number
      type(entry_type), intent(out) :: entry
      logical, intent(out) :: found
      integer :: i, j, seen

      found = .false.
      seen = 0
      do i = 1, size(self%groups)
         if (self%groups(i)%name == group) seen = seen + 1
         if (self%groups(i)%name /= group .or. seen /= number) cycle
         do j = 1, size(self%groups(i)%entries)
            found = self%groups(i)%entries(j)%key == name
            if (found) entry = self%groups(i)%entries(j)
            if (found) return
         end do
      end do
   end subroutine entry_of

   !> Whether a key is written in the `number`-th group of a name.
   pure logical function has(self, group, number, name)
      class(reader_type), intent(in) :: self
      character(*), intent(in) :: group, name
      integer, intent(in) :: number
      type(entry_type) :: entry

      call self%entry_of(group, number, name, entry, has)
   end function has

   !> The value as written, or the default.
   pure function text_value(self, group, number, name) result(text)
      class(reader_type), intent(in) :: self
      character(*), intent(in) :: group, name
      integer, intent(in) :: number
      character(len=length_of_value(self, group, number, name)) :: text
      character(:), allocatable :: value

      call find_value(self, group, number, name, value)
      text = value
   end function text_value

   !> Length of the value as written, or of the default.
   pure integer function length_of_value(reader, group, number, name) result(length)
      class(reader_type), intent(in) :: reader
      character(*), intent(in) :: group, name
      integer, intent(in) :: number
      character(:), allocatable :: value

      call find_value(reader, group, number, name, value)
      length = len(value)
   end function length_of_value

   !> The value as written, or the default: text_value for a caller who has a variable for it.
   pure subroutine find_value(reader, group, number, name, value)
      class(reader_type), intent(in) :: reader
      character(*), intent(in) :: group, name
      integer, intent(in) :: number
      character(:), allocatable, intent(out) :: value
      type(entry_type) :: entry
      logical :: found

      call reader%entry_of(group, number, name, entry, found)
      if (found) then
         value = entry%values(1)%text
      else
         value = reader%keys(reader%key_of(group, name))%default
      end if
   end subroutine find_value

   !> The value of a key for a number.
   pure real(wp) function real_value(self, group, number, name)
      class(reader_type), intent(in) :: self
      character(*), intent(in) :: group, name
      integer, intent(in) :: number
      character(:), allocatable :: text
      integer :: code

      call find_value(self, group, number, name, text)
      call read_number(text, kind_real, real_value, code)
   end function real_value

   !> All values of a key that is written, as numbers.
   pure subroutine real_values(self, group, number, name, values)
      class(reader_type), intent(in) :: self
      character(*), intent(in) :: group, name
      integer, intent(in) :: number
      real(wp), allocatable, intent(out) :: values(:)
      type(entry_type) :: entry
      logical :: found
      integer :: i, code

      call self%entry_of(group, number, name, entry, found)
      if (.not. found) return
      allocate (values(size(entry%values)))
      do i = 1, size(values)
         call read_number(entry%values(i)%text, kind_real, values(i), code)
      end do
   end subroutine real_values

   !> The value of a key for a whole number.
   pure integer function integer_value(self, group, number, name)
      class(reader_type), intent(in) :: self
      character(*), intent(in) :: group, name
      integer, intent(in) :: number
      character(:), allocatable :: text
      real(wp) :: value
      integer :: code

      call find_value(self, group, number, name, text)
      call read_number(text, kind_integer, value, code)
      integer_value = nint(value)
   end function integer_value

   !> The value of a key for .true. or .false.
   pure logical function logical_value(self, group, number, name)
      class(reader_type), intent(in) :: self
      character(*), intent(in) :: group, name
      integer, intent(in) :: number
      character(:), allocatable :: text

      call find_value(self, group, number, name, text)
      logical_value = logical_code(text) == 1
   end function logical_value

   !> Error where a key is not written.
   subroutine need(self, group, number, name, error)
      class(reader_type), intent(in) :: self
      character(*), intent(in) :: group, name
      integer, intent(in) :: number
      type(error_type), allocatable, intent(out) :: error
      character(:), allocatable :: allowed

      if (self%has(group, number, name)) return
      call describe_allowed(self%keys(self%key_of(group, name)), allowed)
      call fail(self, line_of(self, group, number), '&'//group//trim(numbered(group, number))//': '//name// &
                ' is missing; it must be '//allowed, error)
   end subroutine need

   !> Error about a key of the `number`-th group of a name.
   subroutine complain(self, group, number, name, why, error)
      class(reader_type), intent(in) :: self
      character(*), intent(in) :: group, name, why
      integer, intent(in) :: number
      type(error_type), allocatable, intent(inout) :: error
      character(:), allocatable :: written
      type(entry_type) :: entry
      logical :: found
      integer :: line

      call self%entry_of(group, number, name, entry, found)
      line = merge(entry%line, line_of(self, group, number), found)
      written = name
      if (found) call write_entry(entry, written)
      call fail(self, line, '&'//group//trim(numbered(group, number))//' '//written//': '//why, error)
   end subroutine complain

   !> One of two texts, without the blanks that merge wants.
   pure function merge_text(condition, yes, no) result(text)
      logical, intent(in) :: condition
      character(*), intent(in) :: yes, no
      character(len=merge(len(yes), len(no), condition)) :: text

      text = no
      if (condition) text = yes
   end function merge_text

   !> Number of a group that may come more than once, after a blank; padded with blanks.
   pure function numbered(group, number) result(text)
      character(*), intent(in) :: group
      integer, intent(in) :: number
      character(len=12) :: text

      text = ''
      if (group_repeats(group)) text = ' '//to_text(number)
   end function numbered

   !> key=value as the user wrote it.
   pure subroutine write_entry(entry, text)
      type(entry_type), intent(in) :: entry
      character(:), allocatable, intent(out) :: text
      integer :: i

      text = entry%key//'='
      do i = 1, size(entry%values)
         if (i > 1) text = text//', '
         text = text//merge_text(entry%is_quoted(i), quoted(entry%values(i)%text), entry%values(i)%text)
      end do
   end subroutine write_entry

   !> Number of groups of a name.
   pure integer function count_groups(reader, name)
      type(reader_type), intent(in) :: reader
      character(*), intent(in) :: name
      integer :: i

      count_groups = 0
      do i = 1, size(reader%groups)
         if (reader%groups(i)%name == name) count_groups = count_groups + 1
      end do
   end function count_groups

   !> Line of the `number`-th group of a name, 0 for none.
   pure integer function line_of(reader, name, number)
      type(reader_type), intent(in) :: reader
      character(*), intent(in) :: name
      integer, intent(in) :: number
      integer :: i, seen

      line_of = 0
      seen = 0
      do i = 1, size(reader%groups)
         if (reader%groups(i)%name == name) seen = seen + 1
         if (reader%groups(i)%name == name .and. seen == number) line_of = reader%groups(i)%line
      end do
   end function line_of

   !> Names of the keys of a group.
   pure function keys_of(reader, group) result(names)
      type(reader_type), intent(in) :: reader
      character(*), intent(in) :: group
      type(string_type), allocatable :: names(:)
      integer :: i

      do i = 1, size(reader%keys)
         if (reader%keys(i)%group == group) call add_text(names, reader%keys(i)%name)
      end do
   end function keys_of

   pure logical function any_equal(words, text)
      type(string_type), intent(in) :: words(:)
      character(*), intent(in) :: text
      integer :: i

      any_equal = .false.
      do i = 1, size(words)
         any_equal = any_equal .or. words(i)%text == text
      end do
   end function any_equal

   !> '; did you mean ...?' where a known name is near, else empty.
   pure subroutine suggest(name, names, prefix, text)
      character(*), intent(in) :: name, prefix
      type(string_type), intent(in) :: names(:)
      character(:), allocatable, intent(out) :: text

      text = nearest_name(name, names)
      if (text /= '') text = '; did you mean '//prefix//text//'?'
   end subroutine suggest

   subroutine fail(reader, line, message, error)
      type(reader_type), intent(in) :: reader
      integer, intent(in) :: line
      character(*), intent(in) :: message
      type(error_type), allocatable, intent(inout) :: error
      character(:), allocatable :: place

      place = reader%source//':'
      if (line > 0) place = place//to_text(line)//':'
      if (allocated(error)) deallocate (error)
      call set_error(error, MFV_INPUT_ERROR, place//' '//message)
   end subroutine fail

end module mfv_case_reader
