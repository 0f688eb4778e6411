!> The result file: HDF5, for people. Named datasets with units and descriptions, dimension scales, the input text,
!> versions and the certificate. It is written under another name and renamed at the end, so that a failed run leaves
!> an earlier result as it was and nothing half-written. docs/file-format.md describes it.
module mfv_result_file
   use, intrinsic :: iso_c_binding, only: c_char, c_int, c_loc, c_null_char, c_ptr
   use hdf5
   use h5ds
   use mfv_case, only: case_type
   use mfv_error, only: error_type, set_error
   use mfv_result_fields
   use mfv_simulation, only: simulation_type
   use mfv_status, only: MFV_FILE_ERROR, MFV_INPUT_ERROR
   use mfv_strings, only: string_type, to_text
   implicit none
   private
   public :: write_result, check_writable

   !> An open file.
   type :: writer_type
      integer(hid_t) :: file = -1
      !> First failure of an HDF5 call, 0 for none.
      integer :: code = 0
   end type writer_type

   interface
      function c_rename(from, to) bind(C, name='rename') result(code)
         import :: c_char, c_int
         character(kind=c_char), intent(in) :: from(*), to(*)
         integer(c_int) :: code
      end function c_rename

      function c_getpid() bind(C, name='getpid') result(id)
         import :: c_int
         integer(c_int) :: id
      end function c_getpid
   end interface

contains

   !> Whether a result could be written to `path`: error MFV_INPUT_ERROR where not, found out before a long run. A file that
   !> is no HDF5 file, the case itself for one, is not replaced.
   subroutine check_writable(path, error)
      character(*), intent(in) :: path
      type(error_type), allocatable, intent(out) :: error
      character(len=200) :: why
      logical :: is_directory, is_there, is_hdf5
      integer :: code, unit

      inquire (file=path//'/.', exist=is_directory)
      if (is_directory) then
         call set_error(error, MFV_INPUT_ERROR, path//' is a directory')
         return
      end if
      inquire (file=path, exist=is_there)
      if (is_there) then
         call h5open_f(code)
         call h5eset_auto_f(0, code)
         call h5fis_hdf5_f(path, is_hdf5, code)
         if (code /= 0 .or. .not. is_hdf5) then
            call set_error(error, MFV_INPUT_ERROR, path//' is there and is no HDF5 file; it is not replaced')
            return
         end if
      end if
      open (newunit=unit, file=temporary_name(path), action='write', status='replace', iostat=code, iomsg=why)
      if (code /= 0) then
         call set_error(error, MFV_INPUT_ERROR, path//' cannot be written: '//trim(why))
      else
         close (unit, status='delete')
      end if
   end subroutine check_writable

   !> Write the result of a case to `path`. Error MFV_FILE_ERROR; what was at `path` before is then still there. See
   !> check_writable for what is not replaced.
   subroutine write_result(path, case, simulation, error)
      character(*), intent(in) :: path
      type(case_type), intent(in) :: case
      type(simulation_type), intent(in) :: simulation
      type(error_type), allocatable, intent(out) :: error
      type(writer_type) :: writer
      integer :: code

      call check_writable(path, error)
      if (allocated(error)) then
         error%status = MFV_FILE_ERROR
         return
      end if
      call h5open_f(code)
      call h5eset_auto_f(0, code)
      call h5fcreate_f(temporary_name(path), H5F_ACC_TRUNC_F, writer%file, writer%code)
      if (writer%code == 0) then
         call write_attributes(writer, case, simulation)
         call write_groups(writer, case, simulation)
         call h5fclose_f(writer%file, code)
         call note(writer, code)
      end if
      if (writer%code == 0) writer%code = c_rename(temporary_name(path)//c_null_char, path//c_null_char)
      if (writer%code == 0) return
      call delete_file(temporary_name(path))
      call set_error(error, MFV_FILE_ERROR, path//': the result could not be written')
   end subroutine write_result

   !> Name under which a result is written, in the same directory, of this process alone.
   function temporary_name(path) result(name)
      character(*), intent(in) :: path
      character(:), allocatable :: name

      name = path//'.part'//to_text(int(c_getpid()))
   end function temporary_name

   subroutine delete_file(path)
      character(*), intent(in) :: path
      integer :: code, unit

      open (newunit=unit, file=path, status='old', iostat=code)
      if (code == 0) close (unit, status='delete', iostat=code)
   end subroutine delete_file

   !> Attributes of the whole file.
   subroutine write_attributes(writer, case, simulation)
      type(writer_type), intent(inout) :: writer
      type(case_type), intent(in) :: case
      type(simulation_type), intent(in) :: simulation
      type(string_type), allocatable :: names(:), texts(:)
      integer :: i, major, minor, release, code

      call result_attributes(case, simulation, names, texts)
      do i = 1, size(names)
         call write_text(writer, writer%file, names(i)%text, texts(i)%text)
      end do
      call h5get_libversion_f(major, minor, release, code)
      call write_text(writer, writer%file, 'hdf5_version', to_text(major)//'.'//to_text(minor)//'.'//to_text(release))
   end subroutine write_attributes

   !> All groups with their datasets.
   subroutine write_groups(writer, case, simulation)
      type(writer_type), intent(inout) :: writer
      type(case_type), intent(in) :: case
      type(simulation_type), intent(in) :: simulation
      type(string_type), allocatable :: groups(:)
      type(field_type), allocatable :: fields(:), scales(:)
      integer :: i

      call find_scales(case, simulation, scales)
      groups = result_groups(simulation)
      if (simulation%snapshot_count > 0) call create_group(writer, 'steps')
      do i = 1, size(groups)
         call group_fields(case, simulation, groups(i)%text, fields)
         if (size(fields) > 0) call write_group(writer, groups(i)%text, fields, scales)
      end do
   end subroutine write_groups

   !> The fields that are dimension scales: x of the nodes, record of the load history.
   subroutine find_scales(case, simulation, scales)
      type(case_type), intent(in) :: case
      type(simulation_type), intent(in) :: simulation
      type(field_type), allocatable, intent(out) :: scales(:)
      type(field_type), allocatable :: fields(:)

      allocate (scales(2))
      call group_fields(case, simulation, 'mesh', fields)
      scales(along_nodes) = fields(field_named(fields, 'x'))
      call group_fields(case, simulation, 'history', fields)
      scales(along_records)%name = ''
      if (size(fields) > 0) scales(along_records) = fields(field_named(fields, 'record'))
   end subroutine find_scales

   !> One group, with dimension scales of its own: a group can be read alone, and no scale has to list all the datasets of a
   !> long load history (HDF5 allows 64 KiB for that).
   subroutine write_group(writer, group, fields, scales)
      type(writer_type), intent(inout) :: writer
      character(*), intent(in) :: group
      type(field_type), intent(in) :: fields(:), scales(:)
      integer(hid_t) :: dataset, scale(size(scales))
      integer :: code, i

      call create_group(writer, group)
      scale = -1
      do i = 1, size(scales)
         if (.not. any(fields%along == i)) cycle
         call write_dataset(writer, group, scales(i), scale(i))
         call h5dsset_scale_f(scale(i), code, scales(i)%name)
         call note(writer, code)
      end do
      do i = 1, size(fields)
         if (field_named(scales, fields(i)%name) > 0) cycle
         call write_dataset(writer, group, fields(i), dataset)
         if (fields(i)%along /= along_nothing) then
            call h5dsattach_scale_f(dataset, scale(fields(i)%along), 1, code)
            call note(writer, code)
         end if
         call h5dclose_f(dataset, code)
      end do
      do i = 1, size(scales)
         if (scale(i) >= 0) call h5dclose_f(scale(i), code)
      end do
   end subroutine write_group

   subroutine create_group(writer, group)
      type(writer_type), intent(inout) :: writer
      character(*), intent(in) :: group
      integer(hid_t) :: id
      integer :: code

      call h5gcreate_f(writer%file, '/'//group, id, code)
      call note(writer, code)
      if (code == 0) call h5gclose_f(id, code)
   end subroutine create_group

   !> One dataset with its unit, description and flags; it is left open.
   subroutine write_dataset(writer, group, field, dataset)
      type(writer_type), intent(inout) :: writer
      character(*), intent(in) :: group
      type(field_type), intent(in) :: field
      integer(hid_t), intent(out) :: dataset
      integer(hid_t) :: space, stored_type
      integer(hsize_t) :: extent(1)
      integer :: code

      if (allocated(field%whole)) then
         extent = size(field%whole)
         stored_type = H5T_STD_I32LE
      else
         extent = size(field%values)
         stored_type = H5T_IEEE_F64LE
      end if
      if (field%along == along_nothing) then
         call h5screate_f(H5S_SCALAR_F, space, code)
      else
         call h5screate_simple_f(1, extent, space, code)
      end if
      call note(writer, code)
      call h5dcreate_f(writer%file, '/'//group//'/'//field%name, stored_type, space, dataset, code)
      call note(writer, code)
      if (code /= 0) return
      if (allocated(field%whole)) then
         call h5dwrite_f(dataset, H5T_NATIVE_INTEGER, field%whole, extent, code)
      else
         call h5dwrite_f(dataset, H5T_NATIVE_DOUBLE, field%values, extent, code)
      end if
      call note(writer, code)
      call h5sclose_f(space, code)
      call write_text(writer, dataset, 'units', field%unit)
      call write_text(writer, dataset, 'long_name', field%description)
      if (field%flags /= '') call write_flags(writer, dataset, field%flags)
   end subroutine write_dataset

   !> The meaning of coded values, as the CF conventions have it: flag_values and flag_meanings.
   subroutine write_flags(writer, dataset, flags)
      type(writer_type), intent(inout) :: writer
      integer(hid_t), intent(in) :: dataset
      character(*), intent(in) :: flags
      integer(hid_t) :: space, attribute
      integer(hsize_t) :: extent(1)
      integer :: code, i, flag

      extent = 1 + count([(flags(i:i) == ' ', i=1, len(flags))])
      call write_text(writer, dataset, 'flag_meanings', flags)
      call h5screate_simple_f(1, extent, space, code)
      call h5acreate_f(dataset, 'flag_values', H5T_STD_I32LE, space, attribute, code)
      call note(writer, code)
      call h5awrite_f(attribute, H5T_NATIVE_INTEGER, [(flag, flag=0, int(extent(1)) - 1)], extent, code)
      call note(writer, code)
      call h5aclose_f(attribute, code)
      call h5sclose_f(space, code)
   end subroutine write_flags

   !> A text attribute, UTF-8 of variable length.
   subroutine write_text(writer, object, name, text)
      type(writer_type), intent(inout) :: writer
      integer(hid_t), intent(in) :: object
      character(*), intent(in) :: name, text
      character(len=:, kind=c_char), allocatable, target :: terminated
      type(c_ptr), target :: pointer_to_text
      integer(hid_t) :: text_type, space, attribute
      integer :: code

      terminated = text//c_null_char
      pointer_to_text = c_loc(terminated)
      call h5tcopy_f(H5T_STRING, text_type, code)
      call h5tset_cset_f(text_type, H5T_CSET_UTF8_F, code)
      call h5screate_f(H5S_SCALAR_F, space, code)
      call h5acreate_f(object, name, text_type, space, attribute, code)
      call note(writer, code)
      if (code == 0) then
         call h5awrite_f(attribute, text_type, c_loc(pointer_to_text), code)
         call note(writer, code)
         call h5aclose_f(attribute, code)
      end if
      call h5sclose_f(space, code)
      call h5tclose_f(text_type, code)
   end subroutine write_text

   subroutine note(writer, code)
      type(writer_type), intent(inout) :: writer
      integer, intent(in) :: code

      if (writer%code == 0 .and. code /= 0) writer%code = code
   end subroutine note

end module mfv_result_file
