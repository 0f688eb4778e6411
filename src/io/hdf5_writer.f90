!> Writing HDF5 files so that nothing half-written is left behind: under another name, renamed at the end. What a failed
!> run leaves of an earlier file is that file.
module mfv_hdf5_writer
   use, intrinsic :: iso_c_binding, only: c_char, c_int, c_loc, c_null_char, c_ptr
   use, intrinsic :: iso_fortran_env, only: int8, int64
   use hdf5
   use mfv_error, only: error_type, set_error
   use mfv_kinds, only: wp
   use mfv_result_fields, only: along_nothing, field_type
   use mfv_status, only: MFV_INPUT_ERROR
   use mfv_strings, only: string_type, to_text
   implicit none
   private
   public :: writer_type, check_writable, create_file, copy_and_open, finish_file, create_group, write_dataset, write_values, &
             write_text, write_texts, write_whole, write_hdf5_version, note

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

      pure function c_getpid() bind(C, name='getpid') result(id)
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

   !> Create the file that is to become `path`, empty. Whether it went well is in `writer%code`.
   subroutine create_file(path, writer)
      character(*), intent(in) :: path
      type(writer_type), intent(out) :: writer
      integer :: code

      call h5open_f(code)
      call h5eset_auto_f(0, code)
      call h5fcreate_f(temporary_name(path), H5F_ACC_TRUNC_F, writer%file, writer%code)
   end subroutine create_file

   !> Copy the HDF5 file at `path` and open the copy, which is to take its place.
   subroutine copy_and_open(path, writer)
      character(*), intent(in) :: path
      type(writer_type), intent(out) :: writer
      integer(int8), allocatable :: bytes(:)
      integer(int64) :: length
      integer :: code, unit

      open (newunit=unit, file=path, access='stream', form='unformatted', action='read', status='old', iostat=writer%code)
      if (writer%code /= 0) return
      inquire (unit=unit, size=length)
      allocate (bytes(length))
      read (unit, iostat=writer%code) bytes
      close (unit)
      if (writer%code /= 0) return
      open (newunit=unit, file=temporary_name(path), access='stream', form='unformatted', action='write', status='replace', &
            iostat=writer%code)
      if (writer%code /= 0) return
      write (unit, iostat=writer%code) bytes
      close (unit, iostat=code)
      call note(writer, code)
      if (writer%code /= 0) return
      call h5open_f(code)
      call h5eset_auto_f(0, code)
      call h5fopen_f(temporary_name(path), H5F_ACC_RDWR_F, writer%file, writer%code)
   end subroutine copy_and_open

   !> Close the file and, where all went well, give it the name `path`; else delete it.
   subroutine finish_file(path, writer)
      character(*), intent(in) :: path
      type(writer_type), intent(inout) :: writer
      integer :: code

      if (writer%file >= 0) then
         call h5fclose_f(writer%file, code)
         call note(writer, code)
      end if
      if (writer%code == 0) writer%code = c_rename(temporary_name(path)//c_null_char, path//c_null_char)
      if (writer%code /= 0) call delete_file(temporary_name(path))
   end subroutine finish_file

   !> Name under which a result is written, in the same directory, of this process alone.
   pure function temporary_name(path) result(name)
      character(*), intent(in) :: path
      character(len=len(path) + len_trim(part_of_process())) :: name

      name = path//part_of_process()
   end function temporary_name

   !> Ending of the name of a file that this process is writing.
   pure function part_of_process() result(ending)
      character(len=16) :: ending

      ending = '.part'//to_text(int(c_getpid()))
   end function part_of_process

   subroutine delete_file(path)
      character(*), intent(in) :: path
      integer :: code, unit

      open (newunit=unit, file=path, status='old', iostat=code)
      if (code == 0) close (unit, status='delete', iostat=code)
   end subroutine delete_file

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

   !> A dataset of real values with its unit and description; `extent`: its dimensions, the fastest first, none for a
   !> scalar. It is left open.
   subroutine write_values(writer, path, values, extent, unit, description, dataset)
      type(writer_type), intent(inout) :: writer
      character(*), intent(in) :: path, unit, description
      real(wp), intent(in) :: values(:)
      integer, intent(in) :: extent(:)
      integer(hid_t), intent(out) :: dataset
      integer(hid_t) :: space
      integer :: code

      if (size(extent) == 0) then
         call h5screate_f(H5S_SCALAR_F, space, code)
      else
         call h5screate_simple_f(size(extent), int(extent, hsize_t), space, code)
      end if
      call note(writer, code)
      call h5dcreate_f(writer%file, path, H5T_IEEE_F64LE, space, dataset, code)
      call note(writer, code)
      if (code /= 0) return
      call h5dwrite_f(dataset, H5T_NATIVE_DOUBLE, values, [int(size(values), hsize_t)], code)
      call note(writer, code)
      call h5sclose_f(space, code)
      call write_text(writer, dataset, 'units', unit)
      call write_text(writer, dataset, 'long_name', description)
   end subroutine write_values

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
      type(c_ptr) :: pointers(1)
      integer(hid_t) :: space
      integer :: code

      terminated = text//c_null_char
      pointers = c_loc(terminated)
      call h5screate_f(H5S_SCALAR_F, space, code)
      call write_terminated(writer, object, name, space, pointers)
   end subroutine write_text

   !> An attribute of several texts, as write_text has one.
   subroutine write_texts(writer, object, name, texts)
      type(writer_type), intent(inout) :: writer
      integer(hid_t), intent(in) :: object
      character(*), intent(in) :: name
      type(string_type), intent(in) :: texts(:)
      character(kind=c_char), allocatable, target :: letters(:)
      type(c_ptr) :: pointers(size(texts))
      integer(hid_t) :: space
      integer :: code, i, j, at

      allocate (letters(sum([(len(texts(i)%text) + 1, i=1, size(texts))])))
      at = 0
      do i = 1, size(texts)
         pointers(i) = c_loc(letters(at + 1))
         do j = 1, len(texts(i)%text)
            letters(at + j) = texts(i)%text(j:j)
         end do
         at = at + len(texts(i)%text) + 1
         letters(at) = c_null_char
      end do
      call h5screate_simple_f(1, [size(texts, kind=hsize_t)], space, code)
      call write_terminated(writer, object, name, space, pointers)
   end subroutine write_texts

   !> An attribute of null-terminated texts at the addresses `pointers`, of the extent of `space`, which is closed.
   subroutine write_terminated(writer, object, name, space, pointers)
      type(writer_type), intent(inout) :: writer
      integer(hid_t), intent(in) :: object, space
      character(*), intent(in) :: name
      type(c_ptr), intent(in), target :: pointers(:)
      integer(hid_t) :: text_type, attribute
      integer :: code

      call h5tcopy_f(H5T_STRING, text_type, code)
      call h5tset_cset_f(text_type, H5T_CSET_UTF8_F, code)
      call h5acreate_f(object, name, text_type, space, attribute, code)
      call note(writer, code)
      if (code == 0) then
         call h5awrite_f(attribute, text_type, c_loc(pointers), code)
         call note(writer, code)
         call h5aclose_f(attribute, code)
      end if
      call h5sclose_f(space, code)
      call h5tclose_f(text_type, code)
   end subroutine write_terminated

   !> The version of HDF5 that writes, as an attribute of the file.
   subroutine write_hdf5_version(writer)
      type(writer_type), intent(inout) :: writer
      integer :: major, minor, release, code

      call h5get_libversion_f(major, minor, release, code)
      call write_text(writer, writer%file, 'hdf5_version', to_text(major)//'.'//to_text(minor)//'.'//to_text(release))
   end subroutine write_hdf5_version

   !> An attribute that is a whole number.
   subroutine write_whole(writer, object, name, value)
      type(writer_type), intent(inout) :: writer
      integer(hid_t), intent(in) :: object
      character(*), intent(in) :: name
      integer, intent(in) :: value
      integer(hid_t) :: space, attribute
      integer :: code

      call h5screate_f(H5S_SCALAR_F, space, code)
      call h5acreate_f(object, name, H5T_STD_I32LE, space, attribute, code)
      call note(writer, code)
      if (code == 0) then
         call h5awrite_f(attribute, H5T_NATIVE_INTEGER, value, [1_hsize_t], code)
         call note(writer, code)
         call h5aclose_f(attribute, code)
      end if
      call h5sclose_f(space, code)
   end subroutine write_whole

   subroutine note(writer, code)
      type(writer_type), intent(inout) :: writer
      integer, intent(in) :: code

      if (writer%code == 0 .and. code /= 0) writer%code = code
   end subroutine note

end module mfv_hdf5_writer
