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
   public :: read_profile

   !> Steffen's interpolation needs as many points.
   integer, parameter :: fewest_points = 3

contains

   !> The profile in the file `path`: x and height above the flat surface (lengths) in every line, x increasing; blank
   !> lines and lines that begin with # or ! do not count. Error MFV_INPUT_ERROR with the line and what is right.
   subroutine read_profile(path, body, error)
      character(*), intent(in) :: path
      type(body_type), intent(out) :: body
      type(error_type), allocatable, intent(out) :: error
      character(:), allocatable :: text
      type(string_type), allocatable :: lines(:)
      real(wp), allocatable :: x(:), height(:)
      real(wp) :: columns(2)
      integer :: i

      call read_text(path, text, error)
      if (allocated(error)) return
      lines = split_lines(text)
      allocate (x(0), height(0))
      do i = 1, size(lines)
         if (is_comment(lines(i)%text)) cycle
         call read_columns(lines(i)%text, columns, error)
         if (.not. allocated(error) .and. size(x) > 0) then
            if (columns(1) <= x(size(x))) call set_error(error, MFV_INPUT_ERROR, 'x must increase from line to line')
         end if
         if (allocated(error)) then
            error%message = path//':'//to_text(i)//': '//error%message
            return
         end if
         x = [x, columns(1)]
         height = [height, columns(2)]
      end do
      if (size(x) < fewest_points) then
         call set_error(error, MFV_INPUT_ERROR, path//': needs at least '//to_text(fewest_points)//' points, and has '// &
                        to_text(size(x)))
         return
      end if
      body = new_profile(x, height)
   end subroutine read_profile

   pure logical function is_comment(line)
      character(*), intent(in) :: line

      is_comment = verify(line, ' '//achar(9)) == 0
      if (.not. is_comment) is_comment = scan(adjustl(line), '#!') == 1
   end function is_comment

   !> Two finite numbers, and nothing else.
   subroutine read_columns(line, columns, error)
      character(*), intent(in) :: line
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
      if (code /= 0) call set_error(error, MFV_INPUT_ERROR, 'must be two numbers, x and height, not '''//trim(line)//'''')
   end subroutine read_columns

end module mfv_profile_file
