!> Reading whole files, and the names of files.
module mfv_text_file
   use, intrinsic :: iso_c_binding, only: c_associated, c_char, c_int, c_null_char, c_ptr, c_size_t
   use, intrinsic :: iso_fortran_env, only: int64
   use mfv_error, only: error_type, set_error
   use mfv_status, only: MFV_INPUT_ERROR
   use mfv_strings, only: from_c, string_type, to_text
   implicit none
   private
   public :: read_text, read_bytes, check_is_file, split_lines, directory_of, stem_of, find_working_directory, path_from, &
             path_beside

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

   !> Bytes that a text file can have; coefficients of a million nodes take a quarter of it.
   integer(int64), parameter :: most_bytes = 100000000_int64

contains

   !> The bytes of a text file. Error MFV_INPUT_ERROR, naming the file, where it cannot be read or is too long for a text.
   subroutine read_text(path, text, error)
      character(*), intent(in) :: path
      character(:), allocatable, intent(out) :: text
      type(error_type), allocatable, intent(out) :: error

      call read_bytes(path, text, error, most_bytes)
   end subroutine read_text

   !> The bytes of a file, of `most` bytes at most unless that is left out. Error MFV_INPUT_ERROR, naming the file.
   subroutine read_bytes(path, bytes, error, most)
      character(*), intent(in) :: path
      character(:), allocatable, intent(out) :: bytes
      type(error_type), allocatable, intent(out) :: error
      integer(int64), intent(in), optional :: most
      character(len=256) :: why
      integer :: code, unit
      integer(int64) :: length

      call check_is_file(path, error)
      if (allocated(error)) return
      open (newunit=unit, file=path, access='stream', form='unformatted', action='read', status='old', &
            iostat=code, iomsg=why)
      if (code == 0) then
         inquire (unit, size=length)
         length = max(length, 0_int64)
         if (present(most)) then
            if (length > most) call set_error(error, MFV_INPUT_ERROR, path//': is too long for a text: it has more than '// &
                                              to_text(int(most))//' bytes')
         end if
         if (.not. allocated(error)) then
            allocate (character(len=length) :: bytes, stat=code)
            if (code == 0) then
               read (unit, iostat=code, iomsg=why) bytes
            else
               why = 'there is no memory for it'
            end if
         end if
         close (unit)
      end if
      if (code /= 0) call set_error(error, MFV_INPUT_ERROR, path//': cannot be read: '//trim(why))
   end subroutine read_bytes

   !> Whether a path leads to a regular file, or to none, which opening it then tells: a pipe would keep the program waiting,
   !> a device may have no end. Error MFV_INPUT_ERROR, naming the path.
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
         call set_error(error, MFV_INPUT_ERROR, path//': cannot be read: it is no regular file, but a pipe or a device; '// &
                        'put what it gives into a file')
      end select
   end subroutine check_is_file

   !> The lines of a text, without their ends (LF or CR LF).
   pure function split_lines(text) result(lines)
      character(*), intent(in) :: text
      type(string_type), allocatable :: lines(:)
      character(*), parameter :: line_feed = achar(10), carriage_return = achar(13)
      integer :: i, first, length, n

      n = 0
      do i = 1, len(text)
         if (text(i:i) == line_feed) n = n + 1
      end do
      allocate (lines(n + 1))
      first = 1
      do i = 1, n + 1
         length = index(text(first:), line_feed) - 1
         if (length < 0) length = len(text) - first + 1
         lines(i)%text = text(first:first + length - 1)
         first = first + length + 1
         length = len(lines(i)%text)
         if (length > 0) then
            if (lines(i)%text(length:length) == carriage_return) lines(i)%text = lines(i)%text(:length - 1)
         end if
      end do
   end function split_lines

   !> The directory part of a path with its final slash; empty for a bare name.
   pure function directory_of(path) result(directory)
      character(*), intent(in) :: path
      character(len=index(path, '/', back=.true.)) :: directory

      directory = path
   end function directory_of

   !> The name of a file without its directory and without what follows its last dot, unless it begins with that.
   pure function stem_of(path) result(stem)
      character(*), intent(in) :: path
      character(len=length_of_stem(path)) :: stem

      stem = path(index(path, '/', back=.true.) + 1:)
   end function stem_of

   pure integer function length_of_stem(path) result(length)
      character(*), intent(in) :: path
      integer :: first, dot

      first = index(path, '/', back=.true.) + 1
      dot = index(path(first:), '.', back=.true.)
      length = len(path) - first + 1
      if (dot > 1) length = dot - 1
   end function length_of_stem

   !> The directory the process works in, empty where it cannot be told.
   subroutine find_working_directory(path)
      character(:), allocatable, intent(out) :: path
      integer(c_size_t), parameter :: longest = 4096
      character(kind=c_char) :: buffer(longest)

      buffer = c_null_char
      path = ''
      if (c_associated(c_getcwd(buffer, longest))) path = from_c(buffer)
   end subroutine find_working_directory

   !> A path that was given in another directory.
   pure function path_from(directory, path) result(whole)
      character(*), intent(in) :: directory, path
      character(len=len(path) + merge(len(directory) + 1, 0, given_within(directory, path))) :: whole

      whole = path
      if (given_within(directory, path)) whole = directory//'/'//path
   end function path_from

   !> A path that a text in `directory` names; the directory with its final slash, or empty, as directory_of gives it.
   pure function path_beside(directory, path) result(whole)
      character(*), intent(in) :: directory, path
      character(len=len(path) + merge(len(directory), 0, given_within(directory, path))) :: whole

      whole = path
      if (given_within(directory, path)) whole = directory//path
   end function path_beside

   !> Whether a path has to be looked for in a directory: there is one, and the path does not begin at the root.
   pure logical function given_within(directory, path)
      character(*), intent(in) :: directory, path

      given_within = directory /= '' .and. path(1:min(1, len(path))) /= '/'
   end function given_within

end module mfv_text_file
