!> Safe replacement of a file: the new file is written beside the old one, flushed to disk and renamed. After a kill or power
!> cut there is the old or the new file. A kill may leave PATH.part and a number, which can be deleted.
!>
!> A symbolic link is preserved: its target is replaced. The new file has the mode, and if permitted the owner, of the old
!> one.
module mfv_safe_file
   use, intrinsic :: iso_c_binding
   use, intrinsic :: iso_fortran_env, only: int8
   use mfv_error, only: error_type, set_error
   use mfv_status, only: MFV_FILE_ERROR
   use mfv_strings, only: from_c
   implicit none
   private
   public :: check_replaceable, replace_file, write_all, delete_path

   interface
      function c_replace(path, bytes, count, is_in_place) bind(C, name='mfv_replace_file') result(code)
         import :: c_char, c_int, c_int8_t, c_size_t
         character(kind=c_char), intent(in) :: path(*)
         integer(c_int8_t), intent(in), optional :: bytes(*)
         integer(c_size_t), value :: count
         integer(c_int), intent(out) :: is_in_place
         integer(c_int) :: code
      end function c_replace

      function c_write(descriptor, bytes, count) bind(C, name='mfv_write_all') result(code)
         import :: c_char, c_int, c_size_t
         integer(c_int), value :: descriptor
         character(kind=c_char), intent(in) :: bytes(*)
         integer(c_size_t), value :: count
         integer(c_int) :: code
      end function c_write

      subroutine c_describe(code, text, length) bind(C, name='mfv_describe_error')
         import :: c_char, c_int, c_size_t
         integer(c_int), value :: code
         character(kind=c_char), intent(out) :: text(*)
         integer(c_size_t), value :: length
      end subroutine c_describe

      function c_remove(path) bind(C, name='remove') result(code)
         import :: c_char, c_int
         character(kind=c_char), intent(in) :: path(*)
         integer(c_int) :: code
      end function c_remove
   end interface

contains

   !> Check that a file can be written at `path`. Error MFV_FILE_ERROR, 'PATH cannot be written: ' and the reason: missing
   !> folder, no permission (for folder or existing file), a directory, not a regular file.
   subroutine check_replaceable(path, error)
      character(*), intent(in) :: path
      type(error_type), allocatable, intent(out) :: error

      call replace_file(path, error=error)
   end subroutine check_replaceable

   !> Replace the file at `path` by these bytes; without them only check_replaceable. MFV_FILE_ERROR, as there, or a full disk:
   !> the old file is unchanged; or, as the message says, the new file exists but may be lost in a power cut.
   subroutine replace_file(path, bytes, error)
      character(*), intent(in) :: path
      integer(int8), intent(in), optional :: bytes(:)
      type(error_type), allocatable, intent(out) :: error
      character(:), allocatable :: why
      integer(c_int) :: code, is_in_place

      if (present(bytes)) then
         code = c_replace(path//c_null_char, bytes, size(bytes, kind=c_size_t), is_in_place)
      else
         code = c_replace(path//c_null_char, count=0_c_size_t, is_in_place=is_in_place)
      end if
      if (code == 0) return
      call describe_code(code, why)
      if (is_in_place /= 0) then
         call set_error(error, MFV_FILE_ERROR, path//' is written, but may be lost in a power cut: its folder cannot '// &
                        'be flushed to disk: '//why)
      else
         call set_error(error, MFV_FILE_ERROR, path//' cannot be written: '//why)
      end if
   end subroutine replace_file

   !> Write a text to a file descriptor. `why`: the reason of a failure, by the operating system; else unallocated.
   subroutine write_all(descriptor, text, why)
      integer, intent(in) :: descriptor
      character(*), intent(in) :: text
      character(:), allocatable, intent(out) :: why
      integer(c_int) :: code

      code = c_write(int(descriptor, c_int), text, len(text, kind=c_size_t))
      if (code /= 0) call describe_code(code, why)
   end subroutine write_all

   !> Delete a file if it exists.
   subroutine delete_path(path)
      character(*), intent(in) :: path
      integer :: code

      code = c_remove(path//c_null_char)
   end subroutine delete_path

   !> Description of an error `code` by the operating system.
   subroutine describe_code(code, words)
      integer(c_int), intent(in) :: code
      character(:), allocatable, intent(out) :: words
      integer(c_size_t), parameter :: longest = 200
      character(kind=c_char) :: buffer(longest)

      call c_describe(code, buffer, longest)
      words = from_c(buffer)
   end subroutine describe_code

end module mfv_safe_file
