!> Stresses inside the bodies of a result, added to its file under /stress/<state>/<body>, on a grid or at points.
module mfv_stress_file
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite, ieee_is_nan, ieee_quiet_nan, ieee_value
   use hdf5
   use mfv_case, only: case_type
   use mfv_case_reader, only: read_case_text
   use mfv_error, only: error_type, set_error
   use mfv_hdf5_reader
   use mfv_hdf5_writer
   use mfv_interior
   use mfv_kinds, only: wp
   use mfv_motions, only: motions, bulk_motions
   use mfv_numbers, only: largest_size
   use mfv_result_fields, only: along_nodes, list_type, step_group
   use mfv_status, only: MFV_FILE_ERROR, MFV_INPUT_ERROR
   use mfv_stress_search, only: largest_tension, largest_type, largest_von_mises
   use mfv_strings, only: list_of_words, string_type
   use mfv_text_file, only: path_from, read_text
   implicit none
   private
   public :: stress_request_type, stress_result_type, add_stresses

   !> Request: state, body and points.
   type :: stress_request_type
      !> State after this step or reversal (as in /steps), 0 for the last one.
      integer :: step = 0
      !> Whether the body is the upper one.
      logical :: upper = .false.
      !> Grid: half-width about the middle of the contact and depth, in contact half-widths, and numbers of points.
      real(wp) :: width = 2.0_wp, depth = 2.0_wp
      integer :: across = 161, down = 81
      !> Points instead of the grid, lengths.
      real(wp), allocatable :: x(:), y(:)
   end type stress_request_type

   !> Stresses in the order of stress_names (mfv_interior), shape (stress_count, points); x fastest in a grid. Grid: x, depth below
   !> the surface, and y of every point; points: x and y.
   type :: stress_result_type
      real(wp), allocatable :: x(:), depth(:), y(:), stress(:, :)
      type(largest_type) :: largest
      !> The largest tension along the surface.
      type(largest_type) :: tension
      real(wp) :: half_width = 0.0_wp, largest_pressure = 0.0_wp, yield_strength = 0.0_wp
      !> Group of the file they are in, and the names of the units there.
      character(:), allocatable :: group, length_unit, stress_unit
   end type stress_result_type

contains

   !> Compute the stresses of the result file `path` and add them to it, replacing those of the same state and body. Errors, which
   !> leave the file unchanged: MFV_INPUT_ERROR, MFV_FILE_ERROR.
   subroutine add_stresses(path, request, result, error)
      character(*), intent(in) :: path
      type(stress_request_type), intent(in) :: request
      type(stress_result_type), intent(out) :: result
      type(error_type), allocatable, intent(out) :: error
      type(interior_type) :: interior
      type(case_type) :: case
      character(:), allocatable :: bytes
      integer(hid_t) :: file

      call read_text(path, bytes, error, any_length=.true.)
      ! A file that cannot be read is no HDF5 file either; this message names it.
      call open_to_read(path, file, error)
      if (allocated(error)) return
      call read_interior(file, request, case, interior, result, error)
      if (allocated(error)) then
         error%message = path//': '//error%message
         return
      end if
      result%half_width = interior%half_width()
      result%largest_pressure = interior%peak
      result%length_unit = case%length_unit
      result%stress_unit = case%force_unit//'/'//case%length_unit//'^2'
      if (.not. result%half_width > 0.0_wp) then
         call set_error(error, MFV_INPUT_ERROR, path//': no load acts in this state')
         return
      end if
      call compute(request, interior, result)
      call write_stresses(path, bytes, request, case, result, error)
   end subroutine add_stresses

   !> The body and its tractions from the open file, which is closed.
   subroutine read_interior(file, request, case, interior, result, error)
      integer(hid_t), intent(in) :: file
      type(stress_request_type), intent(in) :: request
      type(case_type), intent(out) :: case
      type(interior_type), intent(out) :: interior
      type(stress_result_type), intent(inout) :: result
      type(error_type), allocatable, intent(out) :: error
      character(:), allocatable :: text, source, directory, state, position, bulk_path
      real(wp), allocatable, dimension(:) :: arc, width, pressure, shear, contact_edge, stick_edge, bulk
      real(wp) :: none
      logical :: available

      state = 'state'
      bulk_path = 'summary'
      if (request%step > 0) then
         state = step_group(request%step)
         bulk_path = state
      end if
      bulk_path = bulk_path//'/'//trim(motions(bulk_motions(merge(2, 1, request%upper)))%key)
      call read_text_attribute(file, 'input', text, error)
      if (.not. allocated(error)) call read_text_attribute(file, 'input_file', source, error)
      if (.not. allocated(error)) call read_text_attribute(file, 'working_directory', directory, error)
      if (.not. allocated(error)) then
         if (.not. has(file, state)) call set_error(error, MFV_INPUT_ERROR, 'the result has no state '//state)
      end if
      position = 'mesh/x'
      if (has(file, 'mesh/arc')) position = 'mesh/arc'
      if (.not. allocated(error)) call read_vector(file, position, -1, arc, error)
      if (.not. allocated(error)) call read_vector(file, 'mesh/width', size(arc), width, error)
      if (.not. allocated(error)) call read_vector(file, state//'/pressure', size(arc), pressure, error)
      if (.not. allocated(error)) call read_vector(file, state//'/shear', size(arc), shear, error)
      none = ieee_value(1.0_wp, ieee_quiet_nan)
      if (.not. allocated(error)) call read_or_default(file, state//'/contact_edge', size(arc), none, contact_edge, error, .true.)
      if (.not. allocated(error)) call read_or_default(file, state//'/stick_edge', size(arc), none, stick_edge, error, .true.)
      if (.not. allocated(error)) call read_or_default(file, bulk_path, 1, 0.0_wp, bulk, error)
      call close_read(file)
      if (.not. allocated(error)) then
         if (any(abs([arc, width, pressure, shear, bulk, pack(contact_edge,.not. ieee_is_nan(contact_edge)), &
                      pack(stick_edge,.not. ieee_is_nan(stick_edge))]) > largest_size)) &
            call set_error(error, MFV_INPUT_ERROR, 'mesh or '//state//' has values beyond 1e100')
      end if
      if (.not. allocated(error)) call read_case_text(text, path_from(directory, source), case, error, &
                                                      without_steps=.true.)
      if (allocated(error)) return
      call case%scene%interior(request%upper, arc, width, pressure, shear, contact_edge, stick_edge, bulk(1), &
                               interior, available)
      if (.not. available) call set_error(error, MFV_INPUT_ERROR, 'the '//body_name(request)//' body is rigid or given by a '// &
                                          'matrix: its stresses cannot be computed')
   end subroutine read_interior

   !> A finite vector, with `default` for every value if the file has none. `gaps`: NaN is allowed.
   subroutine read_or_default(file, path, length, default, values, error, gaps)
      integer(hid_t), intent(in) :: file
      character(*), intent(in) :: path
      integer, intent(in) :: length
      real(wp), intent(in) :: default
      real(wp), allocatable, intent(out) :: values(:)
      type(error_type), allocatable, intent(inout) :: error
      logical, intent(in), optional :: gaps

      if (has(file, path)) then
         call read_vector(file, path, length, values, error, gaps)
      else
         allocate (values(length), source=default)
      end if
   end subroutine read_or_default

   !> lower or upper.
   pure function body_name(request) result(name)
      type(stress_request_type), intent(in) :: request
      character(5) :: name

      name = merge('upper', 'lower', request%upper)
   end function body_name

   !> Stresses on the grid or at the points, and the largest von Mises stress.
   subroutine compute(request, interior, result)
      type(stress_request_type), intent(in) :: request
      type(interior_type), intent(inout) :: interior
      type(stress_result_type), intent(inout) :: result
      real(wp) :: sign
      integer :: i, j, k

      if (allocated(request%x)) then
         call interior%prepare(maxval(abs(request%y)))
      else
         call interior%prepare(result%half_width*request%depth)
      end if
      result%largest = largest_von_mises(interior)
      result%tension = largest_tension(interior)
      result%yield_strength = interior%body%strength_of(1)
      if (ieee_is_finite(result%largest%y)) result%yield_strength = interior%body%strength_at(result%largest%y)
      if (allocated(request%x)) then
         result%x = request%x
         result%y = request%y
         allocate (result%stress(stress_count, size(request%x)))
         do i = 1, size(request%x)
            result%stress(:, i) = interior%all_stresses(request%x(i), request%y(i))
         end do
         return
      end if
      sign = merge(1.0_wp, -1.0_wp, request%upper)
      result%x = [(interior%middle() + result%half_width*request%width*(2*(i - 1)/(request%across - 1.0_wp) - 1.0_wp), &
                   i=1, request%across)]
      result%depth = [(result%half_width*request%depth*(j - 1)/(request%down - 1.0_wp), j=1, request%down)]
      allocate (result%y(request%across*request%down), result%stress(stress_count, request%across*request%down))
      k = 0
      do j = 1, request%down
         do i = 1, request%across
            k = k + 1
            result%y(k) = interior%surface(result%x(i)) + sign*result%depth(j)
            result%stress(:, k) = interior%all_stresses(result%x(i), result%y(k))
         end do
      end do
   end subroutine compute

   !> Write the stresses to a copy of the file, which replaces it if it still has these `bytes`.
   subroutine write_stresses(path, bytes, request, case, result, error)
      character(*), intent(in) :: path
      character(:), allocatable, intent(in) :: bytes
      type(stress_request_type), intent(in) :: request
      type(case_type), intent(in) :: case
      type(stress_result_type), intent(inout) :: result
      type(error_type), allocatable, intent(out) :: error
      type(writer_type) :: writer
      type(list_type) :: fields, scales
      character(:), allocatable :: state

      if (.not. allocated(bytes)) then
         call set_error(error, MFV_FILE_ERROR, path//' cannot be read')
         return
      end if
      state = 'stress/last'
      if (request%step > 0) then
         state = step_group(request%step)
         state = 'stress/'//state(index(state, '/') + 1:)
      end if
      result%group = state//'/'//body_name(request)
      if (allocated(request%x)) result%group = result%group//'_points'
      call open_copy(path, bytes, writer)
      if (writer%code == 0) then
         call remove_group(writer, result%group)
         call collect_fields(case, result, fields, scales)
         call write_group(writer, result%group, fields%fields, scales%fields)
      end if
      call finish_file(path, 'the stresses', writer, error)
   end subroutine write_stresses

   !> Remove earlier stresses.
   subroutine remove_group(writer, group)
      type(writer_type), intent(inout) :: writer
      character(*), intent(in) :: group
      integer :: code

      if (.not. has(writer%file, group)) return
      call h5ldelete_f(writer%file, group, code)
      call note(writer, code)
   end subroutine remove_group

   !> The fields of a group, and the dimension scales of a grid.
   subroutine collect_fields(case, result, fields, scales)
      type(case_type), intent(in) :: case
      type(stress_result_type), intent(in) :: result
      type(list_type), intent(out) :: fields, scales
      character(*), parameter :: stress_unit = 'force/length^2'
      character(len=len(stress_unit)) :: unit
      type(string_type), allocatable :: names(:)
      integer :: along, i

      allocate (fields%fields(0), scales%fields(0))
      fields%length_unit = case%length_unit
      fields%force_unit = case%force_unit
      along = along_nodes
      call fields%add('x', result%x, along_nodes, 'length', 'position to the right of the origin')
      if (allocated(result%depth)) then
         along = along_grid
         scales = fields
         call scales%add('depth', result%depth, along_nodes, 'length', 'depth below the surface')
      end if
      names = list_of_words(stress_names)
      call fields%add('y', result%y, along, 'length', 'height above the origin')
      do i = 1, stress_count
         unit = stress_unit
         if (names(i)%text == 'principal_angle') unit = '1'
         call fields%add(names(i)%text, result%stress(i, :), along, trim(unit), trim(meaning(names(i)%text)))
      end do
      call fields%add('largest_von_mises', result%largest%value, stress_unit, 'largest von Mises stress in the body, by '// &
                      'refinement; NaN where it is unbounded')
      call fields%add('largest_x', result%largest%x, 'length', 'its position: x')
      call fields%add('largest_y', result%largest%y, 'length', 'its position: y')
      call fields%add('largest_tension', result%tension%value, stress_unit, 'largest tension along the surface; NaN '// &
                      'where it is singular')
      call fields%add('tension_x', result%tension%x, 'length', 'its position: x; NaN where there is no tension')
      call fields%add('tension_y', result%tension%y, 'length', 'its position: y')
      call fields%add('half_width', result%half_width, 'length', 'half the length of the loaded surface, from edges between nodes')
      call fields%add('largest_pressure', result%largest_pressure, stress_unit, 'largest pressure')
   end subroutine collect_fields

   !> Description of a stress of stress_names (mfv_interior); padded with blanks.
   pure function meaning(name) result(text)
      character(*), intent(in) :: name
      character(len=120) :: text

      select case (name)
      case ('sigma_zz')
         text = 'out-of-plane stress: nu (sigma_xx + sigma_yy) in plane strain, 0 in plane stress'
      case ('principal_1', 'principal_2')
         text = 'principal stress in the plane, the '//trim(merge('larger ', 'smaller', name == 'principal_1'))
      case ('von_mises')
         text = 'von Mises stress'
      case ('tresca')
         text = 'Tresca stress: the largest difference of the three principal stresses, including sigma_zz'
      case ('principal_angle')
         text = 'direction of principal_1 from the x axis, counterclockwise, in radians'
      case ('sigma_rr', 'sigma_thetatheta', 'sigma_rtheta')
         text = 'stress in polar components about the centre of the disk or hole, counterclockwise; NaN in a half-plane'
      case default
         text = 'stress, positive in tension'
      end select
   end function meaning

end module mfv_stress_file
