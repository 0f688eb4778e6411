!> Writing HDF5 files atomically: HDF5 writes to memory, and the bytes then replace the file (mfv_safe_file). A failed run leaves an
!> earlier file unchanged. On a full disk HDF5 itself would end the process with a segmentation fault at exit.
module mfv_hdf5_writer
   use, intrinsic :: iso_c_binding, only: c_char, c_int, c_loc, c_null_char, c_null_ptr, c_ptr, c_size_t
   use, intrinsic :: iso_fortran_env, only: int8
   use hdf5
   use h5ds
   use mfv_error, only: error_type, set_error
   use mfv_hdf5_reader, only: read_text_attribute
   use mfv_hdf5_start, only: start_hdf5
   use mfv_result_fields, only: along_nothing, field_named, field_type
   use mfv_safe_file, only: check_replaceable, replace_file
   use mfv_status, only: MFV_FILE_ERROR, MFV_INPUT_ERROR, MFV_INTERRUPTED, status_outcome
   use mfv_strings, only: to_text
   use mfv_text_file, only: read_text
   implicit none
   private
   public :: writer_type, check_writable, create_file, open_copy, finish_file, write_group, &
             write_text, write_hdf5_version, note, along_grid

   !> A field along all scales of its group (see along_nothing in mfv_result_fields).
   integer, parameter :: along_grid = -1

   !> An open file.
   type :: writer_type
      integer(hid_t) :: file = -1
      !> First failure of an HDF5 call, 0 for none.
      integer :: code = 0
      !> Type and dataspace of every text attribute.
      integer(hid_t), private :: text_type = -1, scalar = -1
      !> Bytes that the file must still have when it is replaced, for a copy with additions.
      character(:), allocatable, private :: expected
   end type writer_type

   !> A dataset along a scale, and which of its dimensions, the slowest is 0.
   type, bind(c) :: scale_member_type
      integer(haddr_t) :: dataset
      integer(c_int) :: dimension
   end type scale_member_type

   !> An array of variable length, as H5T's hvl_t.
   type, bind(c) :: vlen_type
      integer(c_size_t) :: length
      type(c_ptr) :: values
   end type vlen_type

   !> Every result has this attribute of the root, and no other file.
   character(*), parameter :: mark_of_result = 'outcome'
   !> Appended to a path: not the name of a file.
   character(*), parameter :: in_memory_only = '/in_memory'

contains

   !> Error MFV_INPUT_ERROR if a result cannot be written to `path`; to be called before a long run. Only a result is overwritten,
   !> not the case itself, a matrix or other data. `is_whole`: there is the result of a run that was not interrupted.
   subroutine check_writable(path, error, is_whole)
      character(*), intent(in) :: path
      type(error_type), allocatable, intent(out) :: error
      logical, intent(out), optional :: is_whole
      logical :: is_there, has_ended

      call check_replaceable(path, error)
      inquire (file=path, exist=is_there)
      has_ended = .false.
      if (is_there .and. .not. allocated(error)) call check_is_result(path, has_ended, error)
      if (present(is_whole)) is_whole = has_ended
      if (allocated(error)) error%status = MFV_INPUT_ERROR
   end subroutine check_writable

   !> Error MFV_FILE_ERROR if an existing file is not a result. `has_ended`: that of a run that was not interrupted.
   subroutine check_is_result(path, has_ended, error)
      character(*), intent(in) :: path
      logical, intent(out) :: has_ended
      type(error_type), allocatable, intent(out) :: error
      character(*), parameter :: so = '; not overwritten: choose another name, or move this file away'
      type(error_type), allocatable :: unmarked
      character(:), allocatable :: outcome
      integer(hid_t) :: file
      logical :: is_hdf5
      integer :: code

      has_ended = .false.
      call start_hdf5()
      call h5fopen_f(path, H5F_ACC_RDONLY_F, file, code)
      if (code /= 0) then
         call h5fis_hdf5_f(path, is_hdf5, code)
         if (code /= 0 .or. .not. is_hdf5) then
            call set_error(error, MFV_FILE_ERROR, path//' exists and is not an HDF5 file'//so)
         else
            call set_error(error, MFV_FILE_ERROR, path//' exists and cannot be read: it is damaged, or another program has it '// &
                           'open for writing'//so)
         end if
         return
      end if
      call read_text_attribute(file, mark_of_result, outcome, unmarked)
      if (allocated(unmarked)) then
         call set_error(error, MFV_FILE_ERROR, path//' exists and is not a result of MFV (no attribute '//mark_of_result//')'//so)
      else
         has_ended = outcome /= status_outcome(MFV_INTERRUPTED)
      end if
      call h5fclose_f(file, code)
   end subroutine check_is_result

   !> Begin an empty file that will replace `path`. Error MFV_FILE_ERROR if check_writable refuses a file that is there.
   subroutine create_file(path, writer, error)
      character(*), intent(in) :: path
      type(writer_type), intent(out) :: writer
      type(error_type), allocatable, intent(out) :: error
      integer(hid_t) :: access
      logical :: is_there
      integer :: code

      inquire (file=path, exist=is_there)
      if (is_there) call check_writable(path, error)
      if (allocated(error)) then
         error%status = MFV_FILE_ERROR
         return
      end if
      call start_hdf5()
      call in_memory(access, writer)
      call h5fcreate_f(path//in_memory_only, H5F_ACC_TRUNC_F, writer%file, code, access_prp=access)
      call note(writer, code)
      call h5pclose_f(access, code)
      call make_text_type(writer)
   end subroutine create_file

   !> Open a copy of a file, given by its `bytes`; it replaces the file if that is still unchanged.
   subroutine open_copy(path, bytes, writer)
      character(*), intent(in) :: path
      character(*), intent(in), target :: bytes
      type(writer_type), intent(out) :: writer
      integer(hid_t) :: access
      integer :: code

      writer%expected = bytes
      call start_hdf5()
      call in_memory(access, writer)
      call h5pset_file_image_f(access, c_loc(bytes), len(bytes, kind=size_t), code)
      call note(writer, code)
      call h5fopen_f(path//in_memory_only, H5F_ACC_RDWR_F, writer%file, code, access_prp=access)
      call note(writer, code)
      call h5pclose_f(access, code)
      call make_text_type(writer)
   end subroutine open_copy

   !> Access properties of a file in memory; the caller closes them.
   subroutine in_memory(access, writer)
      integer(hid_t), intent(out) :: access
      type(writer_type), intent(inout) :: writer
      integer(size_t), parameter :: growth = 262144
      logical, parameter :: is_written_at_the_end = .false.
      integer :: code

      call h5pcreate_f(H5P_FILE_ACCESS_F, access, code)
      call note(writer, code)
      call h5pset_fapl_core_f(access, growth, is_written_at_the_end, code)
      call note(writer, code)
   end subroutine in_memory

   !> Make the type and the dataspace of text attributes: UTF-8 of variable length.
   subroutine make_text_type(writer)
      type(writer_type), intent(inout) :: writer
      integer :: code

      call h5tcopy_f(H5T_STRING, writer%text_type, code)
      call note(writer, code)
      call h5tset_cset_f(writer%text_type, H5T_CSET_UTF8_F, code)
      call note(writer, code)
      call h5screate_f(H5S_SCALAR_F, writer%scalar, code)
      call note(writer, code)
   end subroutine make_text_type

   !> Close the file and replace the one at `path`, unless writing has failed. `what`: its name for messages. Error MFV_FILE_ERROR.
   subroutine finish_file(path, what, writer, error)
      character(*), intent(in) :: path, what
      type(writer_type), intent(inout) :: writer
      type(error_type), allocatable, intent(out) :: error
      integer(int8), allocatable, target :: bytes(:)
      integer :: code

      call h5sclose_f(writer%scalar, code)
      call h5tclose_f(writer%text_type, code)
      if (writer%file >= 0) then
         call find_bytes(writer, bytes)
         call h5fclose_f(writer%file, code)
         call note(writer, code)
      end if
      if (writer%code /= 0) then
         call set_error(error, MFV_FILE_ERROR, path//': HDF5 could not write '//what//' (out of memory?)')
      else if (has_changed(path, writer)) then
         call set_error(error, MFV_FILE_ERROR, path//' cannot be written: another process has replaced it in the meantime; '// &
                        'run again')
      else
         call replace_file(path, bytes, error)
      end if
   end subroutine finish_file

   !> Whether a file has changed since it was copied.
   logical function has_changed(path, writer)
      character(*), intent(in) :: path
      type(writer_type), intent(in) :: writer
      character(:), allocatable :: bytes
      type(error_type), allocatable :: error

      has_changed = allocated(writer%expected)
      if (.not. has_changed) return
      call read_text(path, bytes, error, any_length=.true.)
      if (.not. allocated(bytes)) return
      if (len(bytes) == len(writer%expected)) has_changed = bytes /= writer%expected
   end function has_changed

   !> The bytes of the file in memory.
   subroutine find_bytes(writer, bytes)
      type(writer_type), intent(inout) :: writer
      integer(int8), allocatable, target, intent(out) :: bytes(:)
      type(c_ptr) :: place
      integer(size_t) :: length
      integer :: code

      call h5fflush_f(writer%file, H5F_SCOPE_GLOBAL_F, code)
      call note(writer, code)
      if (writer%code /= 0) return
      place = c_null_ptr
      call h5fget_file_image_f(writer%file, place, 0_size_t, code, length)
      call note(writer, code)
      if (writer%code /= 0) return
      allocate (bytes(length), stat=code)
      call note(writer, code)
      if (writer%code /= 0) return
      place = c_loc(bytes)
      call h5fget_file_image_f(writer%file, place, length, code)
      call note(writer, code)
   end subroutine find_bytes

   !> Create a group, and those above it; the caller closes it.
   subroutine create_group(writer, group, id)
      type(writer_type), intent(inout) :: writer
      character(*), intent(in) :: group
      integer(hid_t), intent(out) :: id
      integer(hid_t) :: creation
      integer :: code

      call h5pcreate_f(H5P_LINK_CREATE_F, creation, code)
      call note(writer, code)
      call h5pset_create_inter_group_f(creation, 1, code)
      call note(writer, code)
      call h5gcreate_f(writer%file, group, id, code, lcpl_id=creation)
      call note(writer, code)
      call h5pclose_f(creation, code)
   end subroutine create_group

   !> A group with its own dimension scales: HDF5 limits the list of datasets of a scale to 64 KiB, too little for a long load
   !> history. scales(i) is that of fields with along = i; fields with along_grid have all of them, the first one fastest.
   subroutine write_group(writer, group, fields, scales)
      type(writer_type), intent(inout) :: writer
      character(*), intent(in) :: group
      type(field_type), intent(in) :: fields(:), scales(:)
      integer(hid_t) :: place, dataset, scale(size(scales))
      type(scale_member_type) :: members(size(fields), size(scales))
      integer :: count(size(scales)), code, i, j

      call create_group(writer, group, place)
      if (writer%code /= 0) return
      scale = -1
      count = 0
      do i = 1, size(scales)
         if (.not. any(fields%along == i .or. fields%along == along_grid)) cycle
         call write_dataset(writer, place, scales(i), scale(i))
         call h5dsset_scale_f(scale(i), code, scales(i)%name)
         call note(writer, code)
      end do
      do i = 1, size(fields)
         if (field_named(scales, fields(i)%name) > 0) cycle
         if (fields(i)%along == along_grid) then
            call write_dataset(writer, place, fields(i), dataset, [(size(scales(j)%values), j=1, size(scales))])
            call attach(size(scales), [(j, j=size(scales), 1, -1)])
         else
            call write_dataset(writer, place, fields(i), dataset)
            if (fields(i)%along > 0 .and. fields(i)%along <= size(scales)) call attach(1, [fields(i)%along])
         end if
         call h5dclose_f(dataset, code)
      end do
      do i = 1, size(scales)
         if (count(i) > 0) call write_members(writer, scale(i), members(:count(i), i))
         if (scale(i) >= 0) call h5dclose_f(scale(i), code)
      end do
      call h5gclose_f(place, code)

   contains

      !> Attach scales to the dimensions of fields(i), the slowest first.
      subroutine attach(dimensions, which)
         integer, intent(in) :: dimensions, which(dimensions)
         type(hobj_ref_t_f) :: reference
         integer(haddr_t) :: along(dimensions)
         integer :: k

         do k = 1, dimensions
            call h5rcreate_f(place, scales(which(k))%name, reference, code)
            call note(writer, code)
            along(k) = reference%ref
         end do
         call write_scales(writer, dataset, along)
         call h5rcreate_f(place, fields(i)%name, reference, code)
         call note(writer, code)
         do k = 1, dimensions
            count(which(k)) = count(which(k)) + 1
            members(count(which(k)), which(k)) = scale_member_type(reference%ref, k - 1)
         end do
      end subroutine attach
   end subroutine write_group

   !> The scales of a dataset, references by dimension, the slowest first. As H5DSattach_scale, which writes the lists of both
   !> sides anew for every dataset and takes a fifth of the time of a small run.
   subroutine write_scales(writer, dataset, along)
      type(writer_type), intent(inout) :: writer
      integer(hid_t), intent(in) :: dataset
      integer(haddr_t), intent(in), target :: along(:)
      type(vlen_type), target :: lists(size(along))
      integer(hid_t) :: type
      integer :: code, i

      do i = 1, size(along)
         lists(i) = vlen_type(1_c_size_t, c_loc(along(i)))
      end do
      call h5tvlen_create_f(H5T_STD_REF_OBJ, type, code)
      call note(writer, code)
      call write_list(writer, dataset, 'DIMENSION_LIST', type, size(along), c_loc(lists))
      call h5tclose_f(type, code)
   end subroutine write_scales

   !> The datasets of a scale.
   subroutine write_members(writer, scale, members)
      type(writer_type), intent(inout) :: writer
      integer(hid_t), intent(in) :: scale
      type(scale_member_type), intent(in), target :: members(:)
      integer(hid_t) :: type
      integer :: code

      call h5tcreate_f(H5T_COMPOUND_F, int(storage_size(members)/8, size_t), type, code)
      call note(writer, code)
      call h5tinsert_f(type, 'dataset', 0_size_t, H5T_STD_REF_OBJ, code)
      call note(writer, code)
      call h5tinsert_f(type, 'dimension', h5offsetof(c_loc(members(1)), c_loc(members(1)%dimension)), H5T_NATIVE_INTEGER, code)
      call note(writer, code)
      call write_list(writer, scale, 'REFERENCE_LIST', type, size(members), c_loc(members))
      call h5tclose_f(type, code)
   end subroutine write_members

   !> An attribute of `length` values of a `type`.
   subroutine write_list(writer, object, name, type, length, values)
      type(writer_type), intent(inout) :: writer
      integer(hid_t), intent(in) :: object, type
      character(*), intent(in) :: name
      integer, intent(in) :: length
      type(c_ptr), intent(in) :: values
      integer(hid_t) :: space, attribute
      integer :: code

      call h5screate_simple_f(1, [int(length, hsize_t)], space, code)
      call h5acreate_f(object, name, type, space, attribute, code)
      call note(writer, code)
      call h5awrite_f(attribute, type, values, code)
      call note(writer, code)
      call h5aclose_f(attribute, code)
      call h5sclose_f(space, code)
   end subroutine write_list

   !> Write a field into the group `place`, with its unit, description and flags; the dataset stays open. `shape`: its dimensions,
   !> the fastest first, if it has more than one.
   subroutine write_dataset(writer, place, field, dataset, shape)
      type(writer_type), intent(inout) :: writer
      integer(hid_t), intent(in) :: place
      type(field_type), intent(in) :: field
      integer(hid_t), intent(out) :: dataset
      integer, intent(in), optional :: shape(:)
      integer(hid_t) :: space, stored_type
      integer(hsize_t), allocatable :: extent(:)
      integer :: code

      if (allocated(field%whole)) then
         extent = [size(field%whole, kind=hsize_t)]
         stored_type = H5T_STD_I32LE
      else
         extent = [size(field%values, kind=hsize_t)]
         stored_type = H5T_IEEE_F64LE
      end if
      if (present(shape)) extent = int(shape, hsize_t)
      if (field%along == along_nothing .and. extent(1) == 1) then
         call h5screate_f(H5S_SCALAR_F, space, code)
      else
         call h5screate_simple_f(size(extent), extent, space, code)
      end if
      call note(writer, code)
      call h5dcreate_f(place, field%name, stored_type, space, dataset, code)
      call note(writer, code)
      if (code /= 0) return
      if (allocated(field%whole)) then
         call h5dwrite_f(dataset, H5T_NATIVE_INTEGER, field%whole, extent, code)
      else
         call h5dwrite_f(dataset, H5T_NATIVE_DOUBLE, field%values, [product(extent)], code)
      end if
      call note(writer, code)
      call h5sclose_f(space, code)
      call write_text(writer, dataset, 'units', field%unit)
      call write_text(writer, dataset, 'long_name', field%description)
      if (field%flags /= '') call write_flags(writer, dataset, field%flags)
   end subroutine write_dataset

   !> The meaning of coded values, by the CF conventions: flag_values and flag_meanings.
   subroutine write_flags(writer, dataset, flags)
      type(writer_type), intent(inout) :: writer
      integer(hid_t), intent(in) :: dataset
      character(*), intent(in) :: flags
      integer, allocatable, target :: values(:)
      integer :: i, last

      last = count([(flags(i:i) == ' ', i=1, len(flags))])
      values = [(i, i=0, last)]
      call write_text(writer, dataset, 'flag_meanings', flags)
      call write_list(writer, dataset, 'flag_values', H5T_STD_I32LE, size(values), c_loc(values))
   end subroutine write_flags

   !> A text attribute.
   subroutine write_text(writer, object, name, text)
      type(writer_type), intent(inout) :: writer
      integer(hid_t), intent(in) :: object
      character(*), intent(in) :: name, text
      character(len=:, kind=c_char), allocatable, target :: terminated
      type(c_ptr), target :: pointers(1)
      integer(hid_t) :: attribute
      integer :: code

      terminated = text//c_null_char
      pointers = c_loc(terminated)
      call h5acreate_f(object, name, writer%text_type, writer%scalar, attribute, code)
      call note(writer, code)
      if (code == 0) then
         call h5awrite_f(attribute, writer%text_type, c_loc(pointers), code)
         call note(writer, code)
         call h5aclose_f(attribute, code)
      end if
   end subroutine write_text

   !> The version of HDF5, as an attribute of the file.
   subroutine write_hdf5_version(writer)
      type(writer_type), intent(inout) :: writer
      integer :: major, minor, release, code

      call h5get_libversion_f(major, minor, release, code)
      call write_text(writer, writer%file, 'hdf5_version', to_text(major)//'.'//to_text(minor)//'.'//to_text(release))
   end subroutine write_hdf5_version

   subroutine note(writer, code)
      type(writer_type), intent(inout) :: writer
      integer, intent(in) :: code

      if (writer%code == 0 .and. code /= 0) writer%code = code
   end subroutine note

end module mfv_hdf5_writer
