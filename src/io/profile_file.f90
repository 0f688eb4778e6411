!> Reading the profile of a body from a text file with two columns.
module mfv_profile_file
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use mfv_error, only: error_type, set_error
   use mfv_body, only: body_type, new_profile
   use mfv_kinds, only: wp
   use mfv_status, only: MFV_INPUT_ERROR
   use mfv_strings, only: string_type, to_text
   use mfv_text_file, only: read_text, split_lines
   implicit none
   private
   public :: read_profile, read_two_columns

   !> Steffen's interpolation needs as many points.
   integer, parameter :: fewest_points = 3

contains

   !> The profile in the file `path`: x and height above the flat surface (lengths) in every line, x increasing; blank
   !> lines and lines that begin with # or ! do not count. Error MFV_INPUT_ERROR with the line and what is right.
   subroutine read_profile(path, body, error)
      character(*), intent(in) :: path
      type(body_type), intent(out) :: body
      type(error_type), allocatable, intent(out) :: error
      real(wp), allocatable :: x(:), height(:)

      call read_two_columns(path, 'x and height', .true., x, height, error)
      if (allocated(error)) return
      if (size(x) < fewest_points) then
         call set_error(error, MFV_INPUT_ERROR, path//': needs at least '//to_text(fewest_points)//' points, and has '// &
                        to_text(size(x)))
         return
      end if
      body = new_profile(x, height)
   end subroutine read_profile

   !> Two columns of numbers from a text file; blank lines and comments do not count. `names`: what they are, for messages;
   !> `increasing`: whether the first must increase. Error MFV_INPUT_ERROR with the line and what is right.
   subroutine read_two_columns(path, names, increasing, first, second, error)
      character(*), intent(in) :: path, names
      logical, intent(in) :: increasing
      real(wp), allocatable, intent(out) :: first(:), second(:)
      type(error_type), allocatable, intent(out) :: error
      character(:), allocatable :: text
      type(string_type), allocatable :: lines(:)
      real(wp) :: columns(2)
      integer :: i

      call read_text(path, text, error)
      if (allocated(error)) return
      lines = split_lines(text)
      allocate (first(0), second(0))
      do i = 1, size(lines)
         if (is_comment(lines(i)%text)) cycle
         call read_columns(lines(i)%text, names, columns, error)
         if (.not. allocated(error) .and. increasing .and. size(first) > 0) then
            if (columns(1) <= first(size(first))) call set_error(error, MFV_INPUT_ERROR, 'x must increase from line to line')
         end if
         if (allocated(error)) then
            error%message = path//':'//to_text(i)//': '//error%message
            return
         end if
         first = [first, columns(1)]
         second = [second, columns(2)]
      end do
   end subroutine read_two_columns

   pure logical function is_comment(line)
      character(*), intent(in) :: line

      is_comment = verify(line, ' '//achar(9)) == 0
      if (.not. is_comment) is_comment = scan(adjustl(line), '#!') == 1
   end function is_comment

   !> Two finite numbers, and nothing else.
   subroutine read_columns(line, names, columns, error)
      character(*), intent(in) :: line, names
      real(wp), intent(out) :: columns(2)
      type(error_type), allocatable, intent(out) :: error
      character(*), parameter :: characters = '0123456789+-.eEdD ,'//achar(9)
      character(len=1) :: third
      integer :: code, after

      columns = 0.0_wp
      code = 1
      if (verify(line, characters) == 0) read (line, *, iostat=code) columns
      if (code == 0) then
         read (line, *, iostat=after) columns, third
         if (after == 0) code = 1
      end if
      if (code == 0 .and. .not. all(ieee_is_finite(columns))) code = 1
      if (code /= 0) call set_error(error, MFV_INPUT_ERROR, 'must be two numbers, '//names//', not '''//trim(line)//'''')
   end subroutine read_columns

end module mfv_profile_file
