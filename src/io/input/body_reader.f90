!> The bodies of a case, from its text.
module mfv_body_reader
   use mfv_body
   use mfv_circle, only: kernel_exact, kernel_fourier
   use mfv_error, only: error_type
   use mfv_key_reader
   use mfv_kinds, only: pi, wp
   use mfv_material, only: new_material
   use mfv_matrix_file, only: read_matrix_body
   use mfv_profile_file, only: level_line, level_mean, profile_of_data, read_profile, trace_type
   use mfv_reference_indenter, only: indenter_type
   use mfv_scene, only: scene_type
   use mfv_scene_indenter, only: half_width_of_forces, indenter_of
   use mfv_strings, only: list_of_words, string_type, to_text
   implicit none
   private
   public :: check_bodies, read_body, check_pair, check_matrix, read_datums

contains

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
      end if
      allowed = 'shape rigid'
      allowed = allowed//' '//trim(needed_keys(shape))
      if (shape == 'profile') allowed = allowed//' interpolation position_scale height_scale level centred'
      if (shape /= 'matrix' .and. .not. rigid) allowed = allowed//' shear_modulus youngs_modulus poisson_ratio '// &
                                                         'yield_strength datum'
      if ((shape == 'disk' .or. shape == 'hole') .and. .not. rigid) allowed = allowed//' kernel harmonics'
      keys = reader%catalogue%names('body')
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
      character(:), allocatable :: shape
      type(string_type), allocatable :: needed(:)
      real(wp), parameter :: degree = pi/180.0_wp
      integer :: i

      shape = reader%text_value('body', number, 'shape')
      needed = list_of_words(needed_keys(shape))
      do i = 1, size(needed)
         call reader%need('body', number, needed(i)%text, error)
         if (allocated(error)) return
      end do
      select case (shape)
      case ('half_plane')
         body = new_half_plane_body()
      case ('disk')
         body = new_disk(reader%real_value('body', number, 'radius'))
      case ('hole')
         body = new_hole(reader%real_value('body', number, 'radius'))
      case ('flat_punch')
         body = new_flat_punch(reader%real_value('body', number, 'half_width'))
      case ('rounded_punch')
         body = new_rounded_punch(reader%real_value('body', number, 'half_width'), reader%real_value('body', number, 'edge_radius'))
      case ('wedge')
         body = new_power(tan(degree*reader%real_value('body', number, 'angle')), 1.0_wp)
      case ('power')
         body = new_power(reader%real_value('body', number, 'coefficient'), reader%real_value('body', number, 'exponent'))
      case default
         call read_body_file(reader, number, body, error)
      end select
   end subroutine read_shape

   !> The keys that a shape cannot do without, separated by blanks and padded with them.
   pure function needed_keys(shape) result(keys)
      character(*), intent(in) :: shape
      character(len=40) :: keys

      select case (shape)
      case ('disk', 'hole')
         keys = 'radius'
      case ('flat_punch')
         keys = 'half_width'
      case ('rounded_punch')
         keys = 'half_width edge_radius'
      case ('wedge')
         keys = 'angle'
      case ('power')
         keys = 'coefficient exponent'
      case ('profile', 'matrix')
         keys = 'file'
      case default
         keys = ''
      end select
   end function needed_keys

   !> The file of a profile or a matrix, beside the case.
   subroutine read_body_file(reader, number, body, error)
      type(reader_type), intent(in) :: reader
      integer, intent(in) :: number
      type(body_type), intent(out) :: body
      type(error_type), allocatable, intent(out) :: error
      type(error_type), allocatable :: file_error
      character(:), allocatable :: path
      type(trace_type) :: trace
      logical :: is_profile

      is_profile = reader%text_value('body', number, 'shape') == 'profile'
      if (is_profile) call read_trace(reader, number, trace, error)
      if (allocated(error)) return
      call find_file(reader, 'body', number, 'file', path)
      if (reader%data%has_file(reader%text_value('body', number, 'file'))) then
         path = reader%text_value('body', number, 'file')
         if (is_profile) then
            call profile_of_data(reader%data, path, trace, body, file_error)
         else
            call reader%data%read_matrix_body(path, body, file_error)
         end if
      else if (is_profile) then
         call read_profile(path, trace, body, file_error)
      else
         call read_matrix_body(path, body, file_error)
      end if
      if (allocated(file_error)) call reader%complain('body', number, 'file', file_error%message, error)
   end subroutine read_body_file

   !> How the file of a profile is to be taken.
   subroutine read_trace(reader, number, trace, error)
      type(reader_type), intent(in) :: reader
      integer, intent(in) :: number
      type(trace_type), intent(out) :: trace
      type(error_type), allocatable, intent(out) :: error

      trace%position_scale = reader%real_value('body', number, 'position_scale')
      trace%height_scale = reader%real_value('body', number, 'height_scale')
      trace%centred = reader%logical_value('body', number, 'centred')
      select case (reader%text_value('body', number, 'level'))
      case ('mean')
         trace%level = level_mean
      case ('line')
         trace%level = level_line
      end select
      if (reader%has('body', number, 'interpolation')) &
         trace%interpolation = merge(interpolation_cubic, interpolation_linear, &
                                     reader%text_value('body', number, 'interpolation') == 'monotone_cubic')
      if (.not. abs(trace%height_scale) > 0.0_wp) &
         call reader%complain('body', number, 'height_scale', 'must not be 0', error)
   end subroutine read_trace

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
      type(indenter_type) :: indenter
      integer :: number

      indenter = indenter_of(scene)
      if (any([scene%lower%shape, scene%upper%shape] == shape_profile) .or. scene%lower%shape == shape_matrix) return
      number = 2
      if (scene%lower%shape == shape_hole) number = 1
      if (scene%lower%shape == shape_hole .or. scene%upper%shape == shape_hole) then
         if (.not. scene%curvature() > 0.0_wp) &
            call reader%complain('body', number, 'radius', 'a hole needs a disk of a smaller radius in it', error)
      else if (.not. scene%curvature() > 0.0_wp .and. &
               .not. any([scene%lower%shape, scene%upper%shape] == shape_flat_punch) .and. indenter%is_flat()) then
         call reader%complain('body', 2, 'shape', 'two half-planes touch everywhere; one body must have another shape', error)
      end if
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

   !> Where the displacements of the elastic bodies are measured: by default at a length of the shapes or, where they have none, at the
   !> half-width of the contact that the closed form expects, else at that of the mesh.
   subroutine read_datums(reader, scene, error)
      type(reader_type), intent(in) :: reader
      type(scene_type), intent(inout) :: scene
      type(error_type), allocatable, intent(out) :: error

      call read_datum(1, scene%lower, scene%upper)
      if (.not. allocated(error)) call read_datum(2, scene%upper, scene%lower)

   contains

      subroutine read_datum(number, body, other)
         integer, intent(in) :: number
         type(body_type), intent(inout) :: body
         type(body_type), intent(in) :: other

         body%datum = merge(body%radius, min(body%size_of_shape(), other%size_of_shape()), body%circular())
         if (reader%has('body', number, 'datum')) body%datum = reader%real_value('body', number, 'datum')
         if (body%datum < huge(1.0_wp)) return
         body%datum = half_width_of_forces(scene)
         if (.not. body%datum > 0.0_wp .and. reader%has('mesh', 1, 'half_width')) &
            body%datum = reader%real_value('mesh', 1, 'half_width')
         if (body%rigid .or. body%datum > 0.0_wp) return
         call reader%complain('body', number, 'datum', 'is needed: the shapes have no length, and there is neither a '// &
                              'normal_force nor the half_width of a &mesh to take it from', error)
      end subroutine read_datum
   end subroutine read_datums

end module mfv_body_reader
