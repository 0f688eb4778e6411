!> Replacing a file safely: it is written beside the old one, under a name that no other run and no other thread takes, brought
!> to the disk, and renamed. Whatever happens, a kill or a power cut, there is the old file or the new one under the name.
!>
!>     call begin_replacement(path, replacement, error)
!>     call write_replacement(replacement, bytes, error)     ! as often as wanted
!>     call finish_replacement(replacement, error)
!>
!> What fails leaves the old file; drop_replacement ends what shall not be finished. The part may also be opened by its name,
!> written and closed in between.
!>
!> A symbolic link stays one: the file that it names is replaced. The new file has the mode (and owner, where that may be)
!> of the old one. Parts that killed processes have left, PATH.part and a number, are removed by the next run that writes PATH,
!> when they are an hour old.
module mfv_safe_file
   use, intrinsic :: iso_c_binding
   use, intrinsic :: iso_fortran_env, only: int8, int64
   use mfv_error, only: error_type, set_error
   use mfv_status, only: MFV_FILE_ERROR
   use mfv_strings, only: from_c
   implicit none
   private
   public :: replacement_type, begin_replacement, write_replacement, finish_replacement, drop_replacement, &
             identify_file, identity_length, write_all, delete_path

   !> Numbers by which a file is known.
   integer, parameter :: identity_length = 5

   !> A file that is being written and will take the place of another.
   type :: replacement_type
      !> Name to write under.
      character(:), allocatable :: part
      !> Name that was asked for, and the file behind it.
      character(:), allocatable, private :: path, target
      integer(c_int), private :: descriptor = -1
   end type replacement_type

   interface
      function c_begin(path, target, part, descriptor) bind(C, name='mfv_begin_replacement') result(code)
         import :: c_char, c_int, c_ptr
         character(kind=c_char), intent(in) :: path(*)
         type(c_ptr), intent(out) :: target, part
         integer(c_int), intent(out) :: descriptor
         integer(c_int) :: code
      end function c_begin

      function c_write(descriptor, bytes, count) bind(C, name='mfv_write_all') result(code)
         import :: c_int, c_int8_t, c_size_t
         integer(c_int), value :: descriptor
         integer(c_int8_t), intent(in) :: bytes(*)
         integer(c_size_t), value :: count
         integer(c_int) :: code
      end function c_write

      subroutine c_identify(path, identity) bind(C, name='mfv_identify_file')
         import :: c_char, c_int64_t, identity_length
         character(kind=c_char), intent(in) :: path(*)
         integer(c_int64_t), intent(out) :: identity(identity_length)
      end subroutine c_identify

      function c_finish(descriptor, part, target, expected, is_in_place) bind(C, name='mfv_finish_replacement') result(code)
         import :: c_char, c_int, c_int64_t, identity_length
         integer(c_int), value :: descriptor
         character(kind=c_char), intent(in) :: part(*), target(*)
         integer(c_int64_t), intent(in), optional :: expected(identity_length)
         integer(c_int), intent(out) :: is_in_place
         integer(c_int) :: code
      end function c_finish

      subroutine c_drop(descriptor, part) bind(C, name='mfv_drop_replacement')
         import :: c_char, c_int
         integer(c_int), value :: descriptor
         character(kind=c_char), intent(in) :: part(*)
      end subroutine c_drop

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

      subroutine c_free(memory) bind(C, name='free')
         import :: c_ptr
         type(c_ptr), value :: memory
      end subroutine c_free
   end interface

contains

   !> Begin a file that is to become `path`. Error MFV_FILE_ERROR, 'PATH cannot be written: ' and why: no such folder, no
   !> permission (for the folder, or for a file that is there), a directory, no regular file, a full disk.
   subroutine begin_replacement(path, replacement, error)
      character(*), intent(in) :: path
      type(replacement_type), intent(out) :: replacement
      type(error_type), allocatable, intent(out) :: error
      type(c_ptr) :: target, part
      integer(c_int) :: code

      code = c_begin(path//c_null_char, target, part, replacement%descriptor)
      replacement%path = path
      if (code == 0) then
         call take_text(target, replacement%target)
         call take_text(part, replacement%part)
      else
         call explain(path//' cannot be written', code, error)
      end if
      call c_free(target)
      call c_free(part)
   end subroutine begin_replacement

   !> Append bytes. Error MFV_FILE_ERROR, a full disk for one: the part is then removed.
   subroutine write_replacement(replacement, bytes, error)
      type(replacement_type), intent(inout) :: replacement
      integer(int8), intent(in) :: bytes(:)
      type(error_type), allocatable, intent(out) :: error
      integer(c_int) :: code

      code = c_write(replacement%descriptor, bytes, size(bytes, kind=c_size_t))
      if (code == 0) return
      call drop_replacement(replacement)
      call explain(replacement%path//' cannot be written', code, error)
   end subroutine write_replacement

   !> Write a text to an open file of the system. `why`: allocated where that failed, in the system's words.
   subroutine write_all(descriptor, text, why)
      integer, intent(in) :: descriptor
      character(*), intent(in) :: text
      character(:), allocatable, intent(out) :: why
      integer(c_int) :: code

      code = c_write(int(descriptor, c_int), transfer(text, [0_c_int8_t]), len(text, kind=c_size_t))
      if (code /= 0) call describe_code(code, why)
   end subroutine write_all

   !> By what the file at `path` is known until something changes or replaces it; the same for all that is not there.
   subroutine identify_file(path, identity)
      character(*), intent(in) :: path
      integer(int64), intent(out) :: identity(identity_length)

      call c_identify(path//c_null_char, identity)
   end subroutine identify_file

   !> Have the disk take the part, and give it its name. Error MFV_FILE_ERROR: the file that was there still is, and the part
   !> is removed; or, as the message then says, the new one is there and only its entry in the folder is perhaps not on the disk.
   !> `expected`: the file that must still be there, as identify_file has found it; else that it is not is an error.
   subroutine finish_replacement(replacement, error, expected)
      type(replacement_type), intent(inout) :: replacement
      type(error_type), allocatable, intent(out) :: error
      integer(int64), intent(in), optional :: expected(identity_length)
      integer(c_int) :: code, is_in_place

      code = c_finish(replacement%descriptor, replacement%part//c_null_char, replacement%target//c_null_char, expected, &
                      is_in_place)
      replacement%descriptor = -1
      if (code == 0) return
      if (is_in_place /= 0) then
         call explain(replacement%path//' is written, but a power cut could still undo that: its folder cannot be brought '// &
                      'to the disk', code, error)
      else
         call explain(replacement%path//' cannot be written', code, error)
      end if
   end subroutine finish_replacement

   !> Remove the part; what was there stays. Nothing where there is no part.
   subroutine drop_replacement(replacement)
      type(replacement_type), intent(inout) :: replacement

      if (replacement%descriptor >= 0) call c_drop(replacement%descriptor, replacement%part//c_null_char)
      replacement%descriptor = -1
   end subroutine drop_replacement

   !> Delete a file, if it is there.
   subroutine delete_path(path)
      character(*), intent(in) :: path
      integer :: code

      code = c_remove(path//c_null_char)
   end subroutine delete_path

   !> Error MFV_FILE_ERROR: `what`, and the words of the system for its error `code`.
   subroutine explain(what, code, error)
      character(*), intent(in) :: what
      integer(c_int), intent(in) :: code
      type(error_type), allocatable, intent(out) :: error
      character(:), allocatable :: why

      call describe_code(code, why)
      call set_error(error, MFV_FILE_ERROR, what//': '//why)
   end subroutine explain

   !> The words of the system for its error `code`.
   subroutine describe_code(code, words)
      integer(c_int), intent(in) :: code
      character(:), allocatable, intent(out) :: words
      integer(c_size_t), parameter :: longest = 200
      character(kind=c_char) :: buffer(longest)

      call c_describe(code, buffer, longest)
      words = from_c(buffer)
   end subroutine describe_code

   !> A text of C.
   subroutine take_text(text_of_c, text)
      type(c_ptr), intent(in) :: text_of_c
      character(:), allocatable, intent(out) :: text
      character(kind=c_char), pointer :: letters(:)
      integer, parameter :: any_size = 1

      call c_f_pointer(text_of_c, letters, [any_size])
      text = from_c(letters)
   end subroutine take_text

end module mfv_safe_file
