!> Text files: reading, checks of their encoding, and paths.
module mfv_text_file
   use, intrinsic :: iso_c_binding, only: c_associated, c_char, c_int, c_null_char, c_ptr, c_size_t
   use, intrinsic :: iso_fortran_env, only: int64
   use mfv_error, only: error_type, set_error
   use mfv_status, only: MFV_INPUT_ERROR
   use mfv_strings, only: from_c, to_text
   implicit none
   private
   public :: read_text, check_is_file, find_fault_of_text, byte_order_mark, directory_of, find_working_directory, path_from

   interface
      function c_getcwd(buffer, size) bind(C, name='getcwd') result(path)
         import :: c_char, c_ptr, c_size_t
         character(kind=c_char), intent(out) :: buffer(*)
         integer(c_size_t), value :: size
         type(c_ptr) :: path
      end function c_getcwd

      integer(c_int) function c_file_kind(path) bind(C, name='mfv_file_kind')
         import :: c_char, c_int
         character(kind=c_char), intent(in) :: path(*)
      end function c_file_kind
   end interface

   !> Largest size of a text file, bytes; coefficients of a million nodes take a quarter of it.
   integer(int64), parameter :: most_bytes = 100000000_int64

   !> UTF-8 byte-order mark.
   character(*), parameter :: byte_order_mark = char(239)//char(187)//char(191)

contains

   !> The bytes of a file. Error MFV_INPUT_ERROR, naming the file, where it cannot be read or, without `any_length`, is too long for
   !> a text; `text` is then not allocated.
   subroutine read_text(path, text, error, any_length)
      character(*), intent(in) :: path
      character(:), allocatable, intent(out) :: text
      type(error_type), allocatable, intent(out) :: error
      logical, intent(in), optional :: any_length
      character(len=256) :: why
      integer :: code, unit
      integer(int64) :: length
      logical :: is_any

      call check_is_file(path, error)
      if (allocated(error)) return
      is_any = .false.
      if (present(any_length)) is_any = any_length
      open (newunit=unit, file=path, access='stream', form='unformatted', action='read', status='old', &
            iostat=code, iomsg=why)
      if (code == 0) then
         inquire (unit, size=length)
         length = max(length, 0_int64)
         if (length > most_bytes .and. .not. is_any) then
            call set_error(error, MFV_INPUT_ERROR, path//': too long; a text file may have at most '// &
                           to_text(int(most_bytes))//' bytes')
         else
            allocate (character(len=length) :: text, stat=code)
            why = 'out of memory'
            if (code == 0) read (unit, iostat=code, iomsg=why) text
            if (code /= 0 .and. allocated(text)) deallocate (text)
         end if
         close (unit)
      end if
      if (code /= 0) call set_error(error, MFV_INPUT_ERROR, path//': cannot be read: '//trim(why))
   end subroutine read_text

   !> Error MFV_INPUT_ERROR for directories, pipes (reading would wait) and devices (may have no end). A missing file is no error
   !> here.
   subroutine check_is_file(path, error)
      character(*), intent(in) :: path
      type(error_type), allocatable, intent(out) :: error

      if (path == '') then
         call set_error(error, MFV_INPUT_ERROR, 'the name of a file is empty')
         return
      end if
      select case (c_file_kind(trim(path)//c_null_char))
      case (1)
         call set_error(error, MFV_INPUT_ERROR, path//': cannot be read: it is a directory')
      case (2)
         call set_error(error, MFV_INPUT_ERROR, path//': cannot be read: it is a pipe or a device; save its content to '// &
                        'a regular file')
      end select
   end subroutine check_is_file

   !> Why `text` is not UTF-8 (RFC 3629) without control characters, in lines that end with LF or CR LF; empty if it is. `line`: the
   !> line of the error.
   pure subroutine find_fault_of_text(text, line, why)
      character(*), intent(in) :: text
      integer, intent(out) :: line
      character(:), allocatable, intent(out) :: why
      integer, parameter :: tab = 9, line_feed = 10, carriage_return = 13, blank = 32, delete = 127
      integer :: i, code, length

      why = ''
      line = 1
      i = 1
      if (index(text, char(137)//'HDF') == 1) then
         why = 'an HDF5 file, such as a result; a text is needed'
         return
      end if
      do while (i <= len(text))
         code = ichar(text(i:i))
         length = 1
         if (code == carriage_return) then
            if (text(i + 1:min(i + 1, len(text))) /= achar(line_feed)) &
               why = 'a carriage return without a line feed; lines must end with LF or CR LF'
         else if (code == line_feed) then
            line = line + 1
         else if ((code < blank .and. code /= tab) .or. code == delete) then
            why = 'control character '//to_text(code)//': not a text file'
         else if (code > delete) then
            length = length_of_character(text(i:min(i + 3, len(text))))
            if (length == 0) why = 'byte '//to_text(code)//' is not UTF-8; save the file as UTF-8'
         end if
         if (why /= '') return
         i = i + length
      end do
   end subroutine find_fault_of_text

   !> Length of the multi-byte character at the start of `bytes`; 0 if invalid.
   pure integer function length_of_character(bytes) result(length)
      character(*), intent(in) :: bytes
      integer :: lowest, highest, i

      ! Range of the second byte: no overlong forms, no surrogates, nothing above U+10FFFF.
      lowest = 128
      highest = 191
      select case (ichar(bytes(1:1)))
      case (194:223)
         length = 2
      case (224:239)
         length = 3
         if (bytes(1:1) == char(224)) lowest = 160
         if (bytes(1:1) == char(237)) highest = 159
      case (240:244)
         length = 4
         if (bytes(1:1) == char(240)) lowest = 144
         if (bytes(1:1) == char(244)) highest = 143
      case default
         length = 0
      end select
      if (length > len(bytes)) length = 0
      do i = 2, length
         if (ichar(bytes(i:i)) < lowest .or. ichar(bytes(i:i)) > highest) length = 0
         lowest = 128
         highest = 191
      end do
   end function length_of_character

   !> The directory part of a path with its final slash; empty for a bare name.
   pure function directory_of(path) result(directory)
      character(*), intent(in) :: path
      character(len=index(path, '/', back=.true.)) :: directory

      directory = path
   end function directory_of

   !> The working directory; empty if unknown.
   subroutine find_working_directory(path)
      character(:), allocatable, intent(out) :: path
      integer(c_size_t), parameter :: longest = 4096
      character(kind=c_char) :: buffer(longest)

      buffer = c_null_char
      path = ''
      if (c_associated(c_getcwd(buffer, longest))) path = from_c(buffer)
   end subroutine find_working_directory

   !> A path relative to another directory.
   pure function path_from(directory, path) result(whole)
      character(*), intent(in) :: directory, path
      character(len=len(path) + merge(len(directory) + 1, 0, directory /= '' .and. index(path, '/') /= 1)) :: whole

      whole = path
      if (len(whole) > len(path)) whole = directory//'/'//path
   end function path_from

end module mfv_text_file
