!> Reading HDF5 files; every failure is an error with a message.
module mfv_hdf5_reader
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use, intrinsic :: iso_c_binding, only: c_associated, c_char, c_f_pointer, c_funloc, c_funptr, c_int, c_loc, c_null_ptr, &
                                                                             c_ptr
   use hdf5
   use mfv_error, only: error_type, set_error
   use mfv_hdf5_start, only: start_hdf5
   use mfv_kinds, only: wp
   use mfv_status, only: MFV_INPUT_ERROR
   use mfv_strings, only: from_c, to_text
   use mfv_text_file, only: check_is_file
   implicit none
   private
   public :: open_to_read, close_read, has, read_vector, read_matrix, read_text_attribute

   interface
      subroutine c_free(memory) bind(C, name='free')
         import :: c_ptr
         type(c_ptr), value :: memory
      end subroutine c_free

      function c_set_elink_callback(access, callback, user) bind(C, name='H5Pset_elink_cb') result(code)
         import :: c_funptr, c_int, c_ptr, hid_t
         integer(hid_t), value :: access
         type(c_funptr), value :: callback
         type(c_ptr), value :: user
         integer(c_int) :: code
      end function c_set_elink_callback
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
         call start_hdf5()
         call h5fis_hdf5_f(path, is_hdf5, code)
      end if
      if (.not. is_hdf5) then
         if (.not. is_there) then
            call set_error(error, MFV_INPUT_ERROR, path//': no such file')
         else if (index(path, '.nml', back=.true.) > max(len(path) - 4, 0)) then
            call set_error(error, MFV_INPUT_ERROR, path//" is a case, not a result; solve it first with 'mfv run', "// &
                           'which writes the result')
         else
            call set_error(error, MFV_INPUT_ERROR, path//' is not an HDF5 file')
         end if
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

   !> A text attribute of a result file, of variable length. Error MFV_INPUT_ERROR.
   subroutine read_text_attribute(file, name, text, error)
      integer(hid_t), intent(in) :: file
      character(*), intent(in) :: name
      character(:), allocatable, intent(out) :: text
      type(error_type), allocatable, intent(out) :: error
      integer(hid_t) :: attribute, text_type
      type(c_ptr), target :: pointer_to_text
      type(c_ptr) :: buffer
      character(kind=c_char), pointer :: characters(:)
      integer, parameter :: any_size = 1
      integer :: code, ignored
      logical :: is_variable

      call open_attribute(file, name, attribute, error)
      if (allocated(error)) then
         error%message = error%message//': not a result of MFV'
         return
      end if
      is_variable = .false.
      call h5aget_type_f(attribute, text_type, code)
      if (code == 0) then
         call h5tis_variable_str_f(text_type, is_variable, code)
         if (code == 0 .and. is_variable) then
            pointer_to_text = c_null_ptr
            buffer = c_loc(pointer_to_text)
            call h5aread_f(attribute, text_type, buffer, code)
            if (code == 0) text = ''
            if (c_associated(pointer_to_text)) then
               call c_f_pointer(pointer_to_text, characters, [any_size])
               if (code == 0) text = from_c(characters)
               call c_free(pointer_to_text)
            end if
         end if
         call h5tclose_f(text_type, ignored)
      end if
      if (.not. allocated(text)) call set_error(error, MFV_INPUT_ERROR, 'attribute '//name//' is not a text')
      call h5aclose_f(attribute, ignored)
   end subroutine read_text_attribute

   !> Open an attribute of the file that has one value. Error MFV_INPUT_ERROR.
   subroutine open_attribute(file, name, attribute, error)
      integer(hid_t), intent(in) :: file
      character(*), intent(in) :: name
      integer(hid_t), intent(out) :: attribute
      type(error_type), allocatable, intent(out) :: error
      integer(hid_t) :: space
      integer(hsize_t) :: values
      integer :: code, ignored
      logical :: is_there

      call h5aexists_f(file, name, is_there, code)
      if (code /= 0 .or. .not. is_there) then
         call set_error(error, MFV_INPUT_ERROR, 'attribute '//name//' is missing')
         return
      end if
      call h5aopen_f(file, name, attribute, code)
      if (code /= 0) then
         call set_error(error, MFV_INPUT_ERROR, 'attribute '//name//' cannot be opened')
         return
      end if
      values = 0
      call h5aget_space_f(attribute, space, code)
      if (code == 0) then
         call h5sget_simple_extent_npoints_f(space, values, code)
         call h5sclose_f(space, ignored)
      end if
      if (values == 1) return
      call set_error(error, MFV_INPUT_ERROR, 'attribute '//name//' must have one value')
      call h5aclose_f(attribute, ignored)
   end subroutine open_attribute

   !> Whether a dataset or group exists.
   logical function has(file, name)
      integer(hid_t), intent(in) :: file
      character(*), intent(in) :: name
      integer :: code

      call h5lexists_f(file, name, has, code)
      has = has .and. code == 0
   end function has

   !> A finite vector of `length` values (any number if negative). `gaps`: NaN is allowed.
   subroutine read_vector(file, name, length, values, error, gaps)
      integer(hid_t), intent(in) :: file
      character(*), intent(in) :: name
      integer, intent(in) :: length
      real(wp), allocatable, intent(inout) :: values(:)
      type(error_type), allocatable, intent(out) :: error
      logical, intent(in), optional :: gaps
      integer(hsize_t) :: extent(1)
      integer(hid_t) :: dataset
      integer :: code

      call open_dataset(file, name, dataset, extent, error)
      if (allocated(error)) return
      if (extent(1) > huge(1)) then
         call set_error(error, MFV_INPUT_ERROR, name//' has too many values')
      else if (length >= 0 .and. extent(1) /= length) then
         call set_error(error, MFV_INPUT_ERROR, name//' has '//to_text(int(extent(1)))//' values, x has '//to_text(length))
      else
         if (allocated(values)) deallocate (values)
         allocate (values(extent(1)), stat=code)
         if (code == 0) then
            call h5dread_f(dataset, H5T_NATIVE_DOUBLE, values, extent, code)
            if (code /= 0) call set_error(error, MFV_INPUT_ERROR, name//' does not hold numbers')
         else
            call set_error(error, MFV_INPUT_ERROR, name//' does not fit into memory')
         end if
      end if
      call h5dclose_f(dataset, code)
      if (allocated(error) .or. present(gaps)) return
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
      integer :: code

      call open_dataset(file, name, dataset, extent, error)
      if (allocated(error)) return
      if (any(extent > most)) then
         call set_error(error, MFV_INPUT_ERROR, name//' has more than '//to_text(most)//' rows or columns')
      else
         allocate (values(extent(1), extent(2)), stat=code)
         if (code == 0) then
            call h5dread_f(dataset, H5T_NATIVE_DOUBLE, values, extent, code)
            if (code /= 0) call set_error(error, MFV_INPUT_ERROR, name//' does not hold numbers')
         else
            call set_error(error, MFV_INPUT_ERROR, name//' does not fit into memory')
         end if
      end if
      call h5dclose_f(dataset, code)
   end subroutine read_matrix

   !> Open a dataset of numbers with as many dimensions as `extent` has places, whose values are in this file.
   subroutine open_dataset(file, name, dataset, extent, error)
      integer(hid_t), intent(in) :: file
      character(*), intent(in) :: name
      integer(hid_t), intent(out) :: dataset
      integer(hsize_t), intent(out) :: extent(:)
      type(error_type), allocatable, intent(out) :: error
      integer(hid_t) :: type
      integer :: class, code, ignored

      extent = 0
      if (.not. has(file, name)) then
         call set_error(error, MFV_INPUT_ERROR, 'dataset '//name//' is missing')
         return
      end if
      call open_in_file(file, name, dataset, code)
      if (code /= 0) then
         call set_error(error, MFV_INPUT_ERROR, name//' is not a dataset of this file')
         return
      end if
      class = -1
      call h5dget_type_f(dataset, type, code)
      if (code == 0) then
         call h5tget_class_f(type, class, code)
         call h5tclose_f(type, ignored)
      end if
      if (code /= 0 .or. .not. any(class == [H5T_INTEGER_F, H5T_FLOAT_F])) &
         call set_error(error, MFV_INPUT_ERROR, name//' does not hold numbers')
      if (.not. allocated(error)) call find_extent(dataset, name, extent, error)
      if (.not. allocated(error)) call check_storage(dataset, name, extent, error)
      if (allocated(error)) call h5dclose_f(dataset, code)
   end subroutine open_dataset

   !> Open a dataset without following links to other files. `code`: not 0 on failure.
   subroutine open_in_file(file, name, dataset, code)
      integer(hid_t), intent(in) :: file
      character(*), intent(in) :: name
      integer(hid_t), intent(out) :: dataset
      integer, intent(out) :: code
      integer(hid_t) :: access
      integer :: ignored

      dataset = -1
      call h5pcreate_f(H5P_DATASET_ACCESS_F, access, code)
      if (code /= 0) return
      code = c_set_elink_callback(access, c_funloc(refuse_link), c_null_ptr)
      if (code == 0) call h5dopen_f(file, name, dataset, code, dapl_id=access)
      call h5pclose_f(access, ignored)
   end subroutine open_in_file

   !> Callback of HDF5 before it follows a link to another file (H5L_elink_traverse_t); negative: refuse.
   integer(c_int) function refuse_link(file, group, other_file, object, flags, access, user) bind(C)
      type(c_ptr), value :: file, group, other_file, object, flags, user
      integer(hid_t), value :: access

      refuse_link = -1
   end function refuse_link

   !> Size of a dataset; a scalar counts as a vector. Error if the number of dimensions is not that of `extent`.
   subroutine find_extent(dataset, name, extent, error)
      integer(hid_t), intent(in) :: dataset
      character(*), intent(in) :: name
      integer(hsize_t), intent(out) :: extent(:)
      type(error_type), allocatable, intent(out) :: error
      integer(hid_t) :: space
      integer(hsize_t) :: most(size(extent))
      integer :: code, dimensions, ignored

      extent = 0
      dimensions = -1
      call h5dget_space_f(dataset, space, code)
      if (code == 0) then
         call h5sget_simple_extent_ndims_f(space, dimensions, code)
         if (dimensions == size(extent)) call h5sget_simple_extent_dims_f(space, extent, most, code)
         if (dimensions == 0 .and. size(extent) == 1) then
            extent = 1
            dimensions = 1
         end if
         call h5sclose_f(space, ignored)
      end if
      if (dimensions >= 0 .and. dimensions /= size(extent)) then
         call set_error(error, MFV_INPUT_ERROR, name//' has '//to_text(dimensions)//' dimensions, not '//to_text(size(extent)))
      else if (code < 0 .or. dimensions < 0) then
         call set_error(error, MFV_INPUT_ERROR, 'the size of '//name//' cannot be read')
      end if
   end subroutine find_extent

   !> Error if values of a dataset are missing in the file, before memory is allocated for them. Values in other files (virtual
   !> datasets, external raw data) are not read.
   subroutine check_storage(dataset, name, extent, error)
      integer(hid_t), intent(in) :: dataset
      character(*), intent(in) :: name
      integer(hsize_t), intent(in) :: extent(:)
      type(error_type), allocatable, intent(out) :: error
      !> Largest expansion by deflate (zlib's documented limit); a value takes at least one byte.
      real(wp), parameter :: most_values_a_byte = 1032.0_wp
      integer(hid_t) :: properties
      integer(hsize_t) :: bytes
      integer :: code, files, ignored, layout

      files = 0
      layout = -1
      call h5dget_create_plist_f(dataset, properties, code)
      if (code == 0) then
         call h5pget_layout_f(properties, layout, code)
         if (code == 0 .and. layout /= H5D_VIRTUAL_F) call h5pget_external_count_f(properties, files, code)
         call h5pclose_f(properties, ignored)
      end if
      ! An empty dataset is an error for this call.
      bytes = 0
      if (code == 0) call h5dget_storage_size_f(dataset, bytes, ignored)
      if (code /= 0) then
         call set_error(error, MFV_INPUT_ERROR, name//' cannot be read')
      else if (files > 0 .or. layout == H5D_VIRTUAL_F) then
         call set_error(error, MFV_INPUT_ERROR, name//' has its values in another file; copy them into this one')
      else if (product(real(extent, wp)) > most_values_a_byte*real(bytes, wp)) then
         call set_error(error, MFV_INPUT_ERROR, name//' is truncated: the file has fewer values than its size says')
      end if
   end subroutine check_storage

end module mfv_hdf5_reader
