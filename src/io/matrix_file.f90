!> Bodies given by a matrix, from an HDF5 file with the datasets
!>
!>     x           (n)             positions of the surface nodes, increasing
!>     gap         (n), optional   how far the undeformed surface recedes from y = 0
!>     width       (n), optional   surface that belongs to each node; else from the midpoints between the nodes
!>     compliance  (n, n) or (2n, 2n): displacements by nodal forces; or
!>     stiffness   the same inverted: nodal forces by displacements, the other nodes condensed out
!>
!> Rows and columns: normal components (into the body), then tangential ones (to the right).
module mfv_matrix_file
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use hdf5
   use mfv_body, only: body_type, new_matrix_body
   use mfv_error, only: error_type, set_error
   use mfv_kinds, only: wp
   use mfv_matrix_compliance, only: check_compliance, inverse_of
   use mfv_status, only: MFV_INPUT_ERROR
   use mfv_strings, only: to_text
   implicit none
   private
   public :: read_matrix_body

   !> More nodes than this make matrices beyond reason.
   integer, parameter :: most_nodes = 20000

contains

   !> The body in the file `path`. Error MFV_INPUT_ERROR, which names the file and what is wrong in it.
   subroutine read_matrix_body(path, body, error)
      character(*), intent(in) :: path
      type(body_type), intent(out) :: body
      type(error_type), allocatable, intent(out) :: error
      integer(hid_t) :: file
      integer :: code
      logical :: is_there, is_hdf5

      inquire (file=path, exist=is_there)
      is_hdf5 = .false.
      if (is_there) then
         call h5open_f(code)
         call h5eset_auto_f(0, code)
         call h5fis_hdf5_f(path, is_hdf5, code)
      end if
      if (.not. is_hdf5) then
         call set_error(error, MFV_INPUT_ERROR, path//trim(merge(' is no HDF5 file       ', ': there is no such file', is_there)))
         return
      end if
      call h5fopen_f(path, H5F_ACC_RDONLY_F, file, code)
      if (code /= 0) then
         call set_error(error, MFV_INPUT_ERROR, path//' cannot be opened')
         return
      end if
      call read_datasets(file, body, error)
      call h5fclose_f(file, code)
      if (allocated(error)) error%message = path//': '//error%message
   end subroutine read_matrix_body

   !> All datasets of an open file.
   subroutine read_datasets(file, body, error)
      integer(hid_t), intent(in) :: file
      type(body_type), intent(out) :: body
      type(error_type), allocatable, intent(out) :: error
      real(wp), allocatable :: x(:), gap(:), width(:), matrix(:, :), stiffness(:, :)
      character(:), allocatable :: name

      call read_vector(file, 'x', -1, x, error)
      if (allocated(error)) return
      if (size(x) < 1 .or. size(x) > most_nodes) then
         call set_error(error, MFV_INPUT_ERROR, 'x has '//to_text(size(x))//' nodes; 1 to '//to_text(most_nodes)//' can be')
      else if (any(x(2:) <= x(:size(x) - 1))) then
         call set_error(error, MFV_INPUT_ERROR, 'x is not increasing at node '// &
                        to_text(findloc(x(2:) <= x(:size(x) - 1), .true., dim=1) + 1))
      else if (.not. has(file, 'width') .and. size(x) < 2) then
         call set_error(error, MFV_INPUT_ERROR, 'width is missing, which one node alone needs')
      end if
      if (allocated(error)) return
      allocate (gap(size(x)), source=0.0_wp)
      if (has(file, 'gap')) call read_vector(file, 'gap', size(x), gap, error)
      if (allocated(error)) return
      if (has(file, 'width')) then
         call read_vector(file, 'width', size(x), width, error)
         if (.not. allocated(error)) then
            if (any(width <= 0.0_wp)) call set_error(error, MFV_INPUT_ERROR, 'width is not positive at node '// &
                                                     to_text(findloc(width <= 0.0_wp, .true., dim=1)))
         end if
         if (allocated(error)) return
      else
         call tributary(x, width)
      end if

      if (has(file, 'compliance') .eqv. has(file, 'stiffness')) then
         call set_error(error, MFV_INPUT_ERROR, 'either compliance or stiffness must be there')
         return
      end if
      name = 'stiffness'
      if (has(file, 'compliance')) name = 'compliance'
      call read_matrix(file, name, matrix, error)
      if (.not. allocated(error)) call check_compliance(matrix, size(x), name, error)
      if (.not. allocated(error) .and. name == 'stiffness') then
         call move_alloc(matrix, stiffness)
         call inverse_of(stiffness, matrix, error)
      end if
      if (.not. allocated(error)) body = new_matrix_body(x, gap, width, matrix)
   end subroutine read_datasets

   !> Half the way to either neighbour; an end node has as much on its outer side as on its inner one.
   pure subroutine tributary(x, width)
      real(wp), intent(in) :: x(:)
      real(wp), allocatable, intent(out) :: width(:)
      integer :: n

      n = size(x)
      allocate (width(n))
      width(2:n - 1) = 0.5_wp*(x(3:) - x(:n - 2))
      width(1) = x(2) - x(1)
      width(n) = x(n) - x(n - 1)
   end subroutine tributary

   logical function has(file, name)
      integer(hid_t), intent(in) :: file
      character(*), intent(in) :: name
      integer :: code

      call h5lexists_f(file, name, has, code)
      has = has .and. code == 0
   end function has

   !> A finite vector of `length` values, of any length where that is negative.
   subroutine read_vector(file, name, length, values, error)
      integer(hid_t), intent(in) :: file
      character(*), intent(in) :: name
      integer, intent(in) :: length
      real(wp), allocatable, intent(inout) :: values(:)
      type(error_type), allocatable, intent(out) :: error
      integer(hsize_t) :: extent(1)
      integer(hid_t) :: dataset

      call open_dataset(file, name, dataset, extent, error)
      if (allocated(error)) return
      if (length >= 0 .and. extent(1) /= length) then
         call set_error(error, MFV_INPUT_ERROR, name//' has '//to_text(int(extent(1)))//' values, x has '//to_text(length))
      else if (extent(1) > most_nodes) then
         call set_error(error, MFV_INPUT_ERROR, name//' has more than '//to_text(most_nodes)//' values')
      else
         if (allocated(values)) deallocate (values)
         allocate (values(extent(1)))
         call read_values(dataset, name, values, extent, error)
      end if
      call close_dataset(dataset)
      if (allocated(error)) return
      if (.not. all(ieee_is_finite(values))) call set_error(error, MFV_INPUT_ERROR, name//' is not finite at node '// &
                                                            to_text(findloc(ieee_is_finite(values), .false., dim=1)))
   end subroutine read_vector

   subroutine read_matrix(file, name, values, error)
      integer(hid_t), intent(in) :: file
      character(*), intent(in) :: name
      real(wp), allocatable, intent(out) :: values(:, :)
      type(error_type), allocatable, intent(out) :: error
      integer(hsize_t) :: extent(2)
      integer(hid_t) :: dataset

      call open_dataset(file, name, dataset, extent, error)
      if (allocated(error)) return
      if (any(extent > 2*most_nodes)) then
         call set_error(error, MFV_INPUT_ERROR, name//' has more than '//to_text(2*most_nodes)//' rows or columns')
      else
         allocate (values(extent(1), extent(2)))
         call read_values(dataset, name, values, extent, error)
      end if
      call close_dataset(dataset)
   end subroutine read_matrix

   !> Open a dataset of numbers with as many dimensions as `extent` has places.
   subroutine open_dataset(file, name, dataset, extent, error)
      integer(hid_t), intent(in) :: file
      character(*), intent(in) :: name
      integer(hid_t), intent(out) :: dataset
      integer(hsize_t), intent(out) :: extent(:)
      type(error_type), allocatable, intent(out) :: error
      integer(hid_t) :: space
      integer(hsize_t) :: most(size(extent))
      integer :: code, dimensions

      if (.not. has(file, name)) then
         call set_error(error, MFV_INPUT_ERROR, 'dataset '//name//' is missing')
         return
      end if
      call h5dopen_f(file, name, dataset, code)
      if (code /= 0) then
         call set_error(error, MFV_INPUT_ERROR, name//' is no dataset')
         return
      end if
      call h5dget_space_f(dataset, space, code)
      call h5sget_simple_extent_ndims_f(space, dimensions, code)
      if (dimensions == size(extent)) then
         call h5sget_simple_extent_dims_f(space, extent, most, code)
      else
         call set_error(error, MFV_INPUT_ERROR, name//' has '//to_text(dimensions)//' dimensions, not '//to_text(size(extent)))
         call h5dclose_f(dataset, code)
      end if
      call h5sclose_f(space, code)
   end subroutine open_dataset

   subroutine read_values(dataset, name, values, extent, error)
      integer(hid_t), intent(in) :: dataset
      character(*), intent(in) :: name
      real(wp), intent(out) :: values(*)
      integer(hsize_t), intent(in) :: extent(:)
      type(error_type), allocatable, intent(out) :: error
      integer :: code

      call h5dread_f(dataset, H5T_NATIVE_DOUBLE, values(:product(extent)), [product(extent)], code)
      if (code /= 0) call set_error(error, MFV_INPUT_ERROR, name//' does not hold numbers')
   end subroutine read_values

   subroutine close_dataset(dataset)
      integer(hid_t), intent(in) :: dataset
      integer :: code

      call h5dclose_f(dataset, code)
   end subroutine close_dataset

end module mfv_matrix_file
