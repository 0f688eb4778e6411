!> Reading columns of numbers from text files: the profile of a body, places, coefficients of friction.
module mfv_profile_file
   use mfv_error, only: error_type, set_error
   use mfv_body, only: body_type, interpolation_unset, new_profile
   use mfv_case_data, only: case_data_type
   use mfv_keys, only: is_reasonable, largest_size, reasonable_sizes
   use mfv_kinds, only: wp
   use mfv_numbers, only: read_real
   use mfv_status, only: MFV_INPUT_ERROR
   use mfv_strings, only: lower_case, shortened, string_type, to_text
   use mfv_text_file, only: read_text, split_lines
   use mfv_utf8, only: byte_order_mark
   implicit none
   private
   public :: read_profile, profile_of_data, read_table, trace_type, level_none, level_mean, level_line

   !> What is taken off heights: nothing, their mean, or the straight line with the least squares.
   integer, parameter :: level_none = 0, level_mean = 1, level_line = 2

   !> How the points of a file become a profile.
   type :: trace_type
      !> Lengths of the case per unit of the file; a negative one for heights turns outward heights into recess.
      real(wp) :: position_scale = 1.0_wp, height_scale = 1.0_wp
      !> One of level_...; one of interpolation_... (mfv_body).
      integer :: level = level_none, interpolation = interpolation_unset
      !> Whether the middle of the positions is put at x = 0.
      logical :: centred = .false.
   end type trace_type

   !> Steffen's interpolation needs as many points.
   integer, parameter :: fewest_points = 3
   character(*), parameter :: blanks = ' '//achar(9), separators = ',;'

contains

   !> The profile in the file `path`: x and recess in every line, x increasing, to be treated as `trace` says; what read_table passes
   !> over does not count. Error MFV_INPUT_ERROR with the line and what is right.
   subroutine read_profile(path, trace, body, error)
      character(*), intent(in) :: path
      type(trace_type), intent(in) :: trace
      type(body_type), intent(out) :: body
      type(error_type), allocatable, intent(out) :: error
      real(wp), allocatable :: table(:, :)

      call read_table(path, 'x and height', 2, .true., table, error)
      if (.not. allocated(error)) call make_profile(path, trace, table, body, error)
   end subroutine read_profile

   !> The profile in the datasets x and height of the data for a file. Error MFV_INPUT_ERROR.
   subroutine profile_of_data(data, file, trace, body, error)
      type(case_data_type), intent(in) :: data
      character(*), intent(in) :: file
      type(trace_type), intent(in) :: trace
      type(body_type), intent(out) :: body
      type(error_type), allocatable, intent(out) :: error
      real(wp), allocatable :: table(:, :)

      call data%read_columns(file, 'x height', table, error)
      if (.not. allocated(error)) call make_profile(file, trace, table, body, error)
   end subroutine profile_of_data

   !> The profile of a table of x and height, shape (2, points). Error MFV_INPUT_ERROR.
   subroutine make_profile(name, trace, table, body, error)
      character(*), intent(in) :: name
      type(trace_type), intent(in) :: trace
      real(wp), intent(inout) :: table(:, :)
      type(body_type), intent(out) :: body
      type(error_type), allocatable, intent(out) :: error
      integer :: n

      n = size(table, 2)
      if (n < fewest_points) then
         call set_error(error, MFV_INPUT_ERROR, name//': needs at least '//to_text(fewest_points)//' points, and has '//to_text(n))
         return
      end if
      if (any(abs(table(1, :)) > largest_size/max(trace%position_scale, 1.0_wp)) .or. &
          any(abs(table(2, :)) > largest_size/max(abs(trace%height_scale), 1.0_wp))) then
         call set_error(error, MFV_INPUT_ERROR, name//': with position_scale and height_scale, '//reasonable_sizes)
         return
      end if
      associate (x => table(1, :), height => table(2, :))
         x = trace%position_scale*x
         height = trace%height_scale*height
         if (trace%centred) x = x - 0.5_wp*(x(1) + x(n))
         if (trace%level == level_mean) height = height - sum(height)/n
         if (trace%level == level_line) call remove_line(x, height)
         if (all(x(2:) > x(:n - 1))) then
            body = new_profile(x, height, trace%interpolation)
         else
            call set_error(error, MFV_INPUT_ERROR, name//': position_scale or centred leaves no distance between points')
         end if
      end associate
   end subroutine make_profile

   !> Take the straight line with the least squares off some heights.
   pure subroutine remove_line(x, height)
      real(wp), intent(in) :: x(:)
      real(wp), intent(inout) :: height(:)
      real(wp) :: from_middle(size(x)), scale

      scale = maxval(abs(x))
      from_middle = x/scale - sum(x/scale)/size(x)
      height = height - sum(height)/size(x)
      height = height - sum(from_middle*height)/sum(from_middle**2)*from_middle
   end subroutine remove_line

   !> Columns of numbers from a text file; blank lines, comments and header lines do not count. `names`: what they are, for
   !> messages; `columns`: how many; `increasing`: whether the first must increase. `table`: shape (columns, lines).
   !> Error MFV_INPUT_ERROR with the line and what is right.
   subroutine read_table(path, names, columns, increasing, table, error)
      character(*), intent(in) :: path, names
      integer, intent(in) :: columns
      logical, intent(in) :: increasing
      real(wp), allocatable, intent(out) :: table(:, :)
      type(error_type), allocatable, intent(out) :: error
      character(:), allocatable :: text
      type(string_type), allocatable :: lines(:)
      real(wp) :: numbers(columns)
      integer :: i, n, header

      call read_text(path, text, error)
      if (allocated(error)) return
      if (index(text, byte_order_mark) == 1) text(:len(byte_order_mark)) = ''
      lines = split_lines(text)
      allocate (table(columns, size(lines)))
      n = 0
      header = 0
      do i = 1, size(lines)
         if (is_comment(lines(i)%text)) cycle
         if (n == 0 .and. is_header(lines(i)%text)) then
            if (header == 0) header = i
            cycle
         end if
         call read_columns(lines(i)%text, names, numbers, error)
         if (.not. allocated(error) .and. increasing .and. n > 0) then
            if (numbers(1) <= table(1, n)) call set_error(error, MFV_INPUT_ERROR, 'x must increase from line to line')
         end if
         if (allocated(error)) then
            error%message = path//':'//to_text(i)//': '//error%message
            return
         end if
         n = n + 1
         table(:, n) = numbers
      end do
      table = table(:, :n)
      if (n > 0 .or. header == 0) return
      call read_columns(lines(header)%text, names, numbers, error)
      error%message = path//':'//to_text(header)//': '//error%message
   end subroutine read_table

   !> Whether a line before the numbers is a heading of theirs: its first word is no attempt at a number.
   pure logical function is_header(line)
      character(*), intent(in) :: line
      character(*), parameter :: letters = 'abcdefghijklmnopqrstuvwxyz'
      character(:), allocatable :: word
      integer :: first

      first = max(1, verify(line, blanks))
      word = lower_case(line(first:first + scan(line(first:)//' ', blanks//separators) - 2))
      is_header = scan(lower_case(line), letters) > 0 .and. scan(word, '0123456789+-.') /= 1 .and. &
                  .not. any(word == [character(8) :: 'nan', 'inf', 'infinity'])
   end function is_header

   pure logical function is_comment(line)
      character(*), intent(in) :: line

      is_comment = verify(line, blanks) == 0
      if (.not. is_comment) is_comment = scan(adjustl(line), '#!') == 1
   end function is_comment

   !> Finite numbers with blanks, tabs, one comma or one semicolon between them, and nothing else.
   subroutine read_columns(line, names, columns, error)
      character(*), intent(in) :: line, names
      real(wp), intent(out) :: columns(:)
      type(error_type), allocatable, intent(out) :: error
      character(len=5), parameter :: counts(3) = [character(5) :: 'one', 'two', 'three']
      integer :: at, length, i
      logical :: is_right

      columns = 0.0_wp
      at = 1
      is_right = .true.
      do i = 1, size(columns)
         call skip(blanks)
         if (i > 1 .and. scan(line(at:min(at, len(line))), separators) == 1) then
            at = at + 1
            call skip(blanks)
         end if
         length = scan(line(at:)//' ', blanks//separators) - 1
         if (is_right) call read_real(line(at:at + length - 1), columns(i), is_right)
         at = at + length
      end do
      if (.not. is_right .or. verify(line(at:), blanks) > 0) &
         call set_error(error, MFV_INPUT_ERROR, 'must be '//trim(counts(size(columns)))//' numbers, '//names//', not '''// &
                        shortened(trim(line))//'''')
      if (allocated(error)) return
      if (.not. all(is_reasonable(columns))) call set_error(error, MFV_INPUT_ERROR, reasonable_sizes)

   contains

      !> Go past characters.
      subroutine skip(characters)
         character(*), intent(in) :: characters

         length = verify(line(at:), characters) - 1
         if (length < 0) length = len(line) - at + 1
         at = at + length
      end subroutine skip
   end subroutine read_columns

end module mfv_profile_file
