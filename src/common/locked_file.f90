!> A file that one process at a time appends to: opened under a lock of the operating system, which a process that dies gives
!> back, and written so that what has been appended survives the process.
module mfv_locked_file
   use, intrinsic :: iso_c_binding
   use, intrinsic :: iso_fortran_env, only: int8, int64
   implicit none
   private
   public :: locked_file_type, open_locked, read_bytes, append_bytes, sync_file, sync_name, cut_file, close_file, delete_path, &
             make_directory, opened, not_opened, in_use, cannot_lock

   !> What open_locked comes to.
   integer, parameter :: opened = 0, not_opened = 1, in_use = 2, cannot_lock = 3

   type :: locked_file_type
      private
      type(c_ptr) :: stream = c_null_ptr
   end type locked_file_type

   integer(c_int), parameter :: from_start = 0, from_end = 2
   !> See try_lock.c.
   integer(c_int), parameter :: locked_by_another = 1

   interface
      function c_fopen(path, mode) bind(C, name='fopen') result(stream)
         import :: c_char, c_ptr
         character(kind=c_char), intent(in) :: path(*), mode(*)
         type(c_ptr) :: stream
      end function c_fopen

      function c_fclose(stream) bind(C, name='fclose') result(code)
         import :: c_int, c_ptr
         type(c_ptr), value :: stream
         integer(c_int) :: code
      end function c_fclose

      function c_fread(buffer, size, count, stream) bind(C, name='fread') result(done)
         import :: c_int8_t, c_ptr, c_size_t
         integer(c_int8_t), intent(out) :: buffer(*)
         integer(c_size_t), value :: size, count
         type(c_ptr), value :: stream
         integer(c_size_t) :: done
      end function c_fread

      function c_fwrite(buffer, size, count, stream) bind(C, name='fwrite') result(done)
         import :: c_int8_t, c_ptr, c_size_t
         integer(c_int8_t), intent(in) :: buffer(*)
         integer(c_size_t), value :: size, count
         type(c_ptr), value :: stream
         integer(c_size_t) :: done
      end function c_fwrite

      function c_fflush(stream) bind(C, name='fflush') result(code)
         import :: c_int, c_ptr
         type(c_ptr), value :: stream
         integer(c_int) :: code
      end function c_fflush

      function c_fseek(stream, offset, origin) bind(C, name='fseek') result(code)
         import :: c_int, c_long, c_ptr
         type(c_ptr), value :: stream
         integer(c_long), value :: offset
         integer(c_int), value :: origin
         integer(c_int) :: code
      end function c_fseek

      function c_ftell(stream) bind(C, name='ftell') result(position)
         import :: c_long, c_ptr
         type(c_ptr), value :: stream
         integer(c_long) :: position
      end function c_ftell

      function c_fileno(stream) bind(C, name='fileno') result(descriptor)
         import :: c_int, c_ptr
         type(c_ptr), value :: stream
         integer(c_int) :: descriptor
      end function c_fileno

      function c_ftruncate(descriptor, length) bind(C, name='ftruncate') result(code)
         import :: c_int, c_long
         integer(c_int), value :: descriptor
         integer(c_long), value :: length
         integer(c_int) :: code
      end function c_ftruncate

      function c_try_lock(descriptor) bind(C, name='mfv_try_lock') result(code)
         import :: c_int
         integer(c_int), value :: descriptor
         integer(c_int) :: code
      end function c_try_lock

      function c_sync(descriptor) bind(C, name='mfv_sync') result(code)
         import :: c_int
         integer(c_int), value :: descriptor
         integer(c_int) :: code
      end function c_sync

      function c_sync_folder(path) bind(C, name='mfv_sync_folder') result(code)
         import :: c_char, c_int
         character(kind=c_char), intent(in) :: path(*)
         integer(c_int) :: code
      end function c_sync_folder

      function c_remove(path) bind(C, name='remove') result(code)
         import :: c_char, c_int
         character(kind=c_char), intent(in) :: path(*)
         integer(c_int) :: code
      end function c_remove

      function c_mkdir(path, mode) bind(C, name='mkdir') result(code)
         import :: c_char, c_int
         character(kind=c_char), intent(in) :: path(*)
         integer(c_int), value :: mode
         integer(c_int) :: code
      end function c_mkdir
   end interface

contains

   !> Open a file to read and append, made where it is not there, and lock it. `outcome`: opened, not_opened, in_use by
   !> another process, or cannot_lock where the file system does not know locks.
   subroutine open_locked(path, file, outcome)
      character(*), intent(in) :: path
      type(locked_file_type), intent(out) :: file
      integer, intent(out) :: outcome
      integer :: code

      outcome = not_opened
      file%stream = c_fopen(path//c_null_char, 'a+b'//c_null_char)
      if (.not. c_associated(file%stream)) return
      outcome = opened
      code = c_fseek(file%stream, 0_c_long, from_start)
      if (code == 0) code = c_try_lock(c_fileno(file%stream))
      if (code == 0) return
      outcome = merge(in_use, cannot_lock, code == locked_by_another)
      call close_file(file)
   end subroutine open_locked

   !> All bytes of the file.
   subroutine read_bytes(file, bytes)
      type(locked_file_type), intent(in) :: file
      integer(int8), allocatable, intent(out) :: bytes(:)
      integer(c_size_t) :: done
      integer :: code

      code = c_fseek(file%stream, 0_c_long, from_end)
      allocate (bytes(c_ftell(file%stream)))
      code = c_fseek(file%stream, 0_c_long, from_start)
      done = c_fread(bytes, 1_c_size_t, size(bytes, kind=c_size_t), file%stream)
      if (done < size(bytes)) bytes = bytes(:done)
      code = c_fseek(file%stream, 0_c_long, from_end)
   end subroutine read_bytes

   !> Append bytes and hand them to the operating system: they are then safe from the end of the process. `code` is not 0 where
   !> that failed.
   subroutine append_bytes(file, bytes, code)
      type(locked_file_type), intent(in) :: file
      integer(int8), intent(in) :: bytes(:)
      integer, intent(out) :: code

      code = 1
      if (c_fwrite(bytes, 1_c_size_t, size(bytes, kind=c_size_t), file%stream) < size(bytes)) return
      code = c_fflush(file%stream)
   end subroutine append_bytes

   !> Have the operating system write to the disk what it has: it is then safe from the end of the machine. `code` is
   !> the system's where that failed, else 0 (see describe_code of mfv_safe_file).
   subroutine sync_file(file, code)
      type(locked_file_type), intent(in) :: file
      integer, intent(out) :: code

      code = c_sync(c_fileno(file%stream))
   end subroutine sync_file

   !> The same for the name of a file or directory that has been made.
   subroutine sync_name(path, code)
      character(*), intent(in) :: path
      integer, intent(out) :: code

      code = c_sync_folder(path//c_null_char)
   end subroutine sync_name

   !> Cut the file after `length` bytes.
   subroutine cut_file(file, length, code)
      type(locked_file_type), intent(in) :: file
      integer(int64), intent(in) :: length
      integer, intent(out) :: code

      code = c_fflush(file%stream)
      if (code == 0) code = c_ftruncate(c_fileno(file%stream), int(length, c_long))
      if (code == 0) code = c_fseek(file%stream, 0_c_long, from_end)
   end subroutine cut_file

   !> Close the file and give its lock back.
   subroutine close_file(file)
      type(locked_file_type), intent(inout) :: file
      integer :: code

      if (c_associated(file%stream)) code = c_fclose(file%stream)
      file%stream = c_null_ptr
   end subroutine close_file

   !> Delete a file, if it is there.
   subroutine delete_path(path)
      character(*), intent(in) :: path
      integer :: code

      code = c_remove(path//c_null_char)
   end subroutine delete_path

   !> Make a directory, if it is not there.
   subroutine make_directory(path)
      character(*), intent(in) :: path
      integer(c_int), parameter :: for_all = int(o'777', c_int)
      integer :: code

      code = c_mkdir(path//c_null_char, for_all)
   end subroutine make_directory

end module mfv_locked_file
