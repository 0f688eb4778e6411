!> Reading HDF5 files of others and of our own: every failure is an error with words.
module mfv_hdf5_reader
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use, intrinsic :: iso_c_binding, only: c_char, c_f_pointer, c_loc, c_ptr
   use hdf5
   use mfv_error, only: error_type, set_error
   use mfv_kinds, only: wp
   use mfv_status, only: MFV_INPUT_ERROR
   use mfv_strings, only: from_c, to_text
   use mfv_text_file, only: check_is_file
   implicit none
   private
   public :: open_to_read, close_read, has, read_vector, read_matrix, read_text_attribute, read_whole_attribute

   interface
      subroutine c_free(memory) bind(C, name='free')
         import :: c_ptr
         type(c_ptr), value :: memory
      end subroutine c_free
   end interface

contains

   !> Open the HDF5 file `path`. Error MFV_INPUT_ERROR.
   subroutine open_to_read(path, file, error)
      character(*), intent(in) :: path
      integer(hid_t), intent(out) :: file
      type(error_type), allocatable, intent(out) :: error
      integer :: code
      logical :: is_there, is_hdf5

      file = -1
      call check_is_file(path, error)
      if (allocated(error)) return
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
      if (code /= 0) call set_error(error, MFV_INPUT_ERROR, path//' cannot be opened')
   end subroutine open_to_read

   subroutine close_read(file)
      integer(hid_t), intent(in) :: file
      integer :: code

      call h5fclose_f(file, code)
   end subroutine close_read

   !> A text attribute of the file, as the result file has them. Error MFV_INPUT_ERROR.
   subroutine read_text_attribute(file, name, text, error)
      integer(hid_t), intent(in) :: file
      character(*), intent(in) :: name
      character(:), allocatable, intent(out) :: text
      type(error_type), allocatable, intent(out) :: error
      integer(hid_t) :: attribute, text_type, root
      type(c_ptr), target :: pointer_to_text
      type(c_ptr) :: buffer
      character(kind=c_char), pointer :: characters(:)
      integer, parameter :: any_size = 1
      integer :: code
      logical :: is_there, is_variable

      call h5aexists_f(file, name, is_there, code)
      if (code /= 0 .or. .not. is_there) then
         call set_error(error, MFV_INPUT_ERROR, 'attribute '//name//' is missing: no result of MFV')
         return
      end if
      call h5gopen_f(file, '/', root, code)
      call h5aopen_f(root, name, attribute, code)
      call h5aget_type_f(attribute, text_type, code)
      call h5tis_variable_str_f(text_type, is_variable, code)
      if (code == 0 .and. is_variable) then
         buffer = c_loc(pointer_to_text)
         call h5aread_f(attribute, text_type, buffer, code)
         if (code == 0) then
            call c_f_pointer(pointer_to_text, characters, [any_size])
            text = from_c(characters)
            call c_free(pointer_to_text)
         end if
      end if
      if (.not. allocated(text)) call set_error(error, MFV_INPUT_ERROR, 'attribute '//name//' is no text of MFV')
      call h5tclose_f(text_type, code)
      call h5aclose_f(attribute, code)
      call h5gclose_f(root, code)
   end subroutine read_text_attribute

   !> A whole number that is an attribute of the file. Error MFV_INPUT_ERROR.
   subroutine read_whole_attribute(file, name, value, error)
      integer(hid_t), intent(in) :: file
      character(*), intent(in) :: name
      integer, intent(out) :: value
      type(error_type), allocatable, intent(out) :: error
      integer(hid_t) :: attribute, root
      integer :: code
      logical :: is_there

      value = 0
      call h5aexists_f(file, name, is_there, code)
      if (code /= 0 .or. .not. is_there) then
         call set_error(error, MFV_INPUT_ERROR, 'attribute '//name//' is missing')
         return
      end if
      call h5gopen_f(file, '/', root, code)
      call h5aopen_f(root, name, attribute, code)
      call h5aread_f(attribute, H5T_NATIVE_INTEGER, value, [1_hsize_t], code)
      if (code /= 0) call set_error(error, MFV_INPUT_ERROR, 'attribute '//name//' is no whole number')
      call h5aclose_f(attribute, code)
      call h5gclose_f(root, code)
   end subroutine read_whole_attribute

   !> Whether a dataset or group is there.
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
      else if (extent(1) > huge(1)) then
         call set_error(error, MFV_INPUT_ERROR, name//' has too many values')
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

   !> A matrix of at most `most` rows and columns.
   subroutine read_matrix(file, name, most, values, error)
      integer(hid_t), intent(in) :: file
      character(*), intent(in) :: name
      integer, intent(in) :: most
      real(wp), allocatable, intent(out) :: values(:, :)
      type(error_type), allocatable, intent(out) :: error
      integer(hsize_t) :: extent(2)
      integer(hid_t) :: dataset

      call open_dataset(file, name, dataset, extent, error)
      if (allocated(error)) return
      if (any(extent > most)) then
         call set_error(error, MFV_INPUT_ERROR, name//' has more than '//to_text(most)//' rows or columns')
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

end module mfv_hdf5_reader
