!> Reading columns of numbers from text files: the profile of a body, places, coefficients of friction.
module mfv_profile_file
   use mfv_error, only: error_type, set_error
   use mfv_body, only: body_type, new_profile
   use mfv_case_data, only: case_data_type
   use mfv_keys, only: is_reasonable, reasonable_sizes
   use mfv_kinds, only: wp
   use mfv_numbers, only: read_real
   use mfv_status, only: MFV_INPUT_ERROR
   use mfv_strings, only: shortened, string_type, to_text
   use mfv_text_file, only: read_text, split_lines
   use mfv_utf8, only: byte_order_mark
   implicit none
   private
   public :: read_profile, profile_of_data, read_table

   !> Steffen's interpolation needs as many points.
   integer, parameter :: fewest_points = 3

contains

   !> The profile in the file `path`: x and height above the flat surface (lengths) in every line, x increasing; blank
   !> lines and lines that begin with # or ! do not count. Error MFV_INPUT_ERROR with the line and what is right.
   subroutine read_profile(path, body, error)
      character(*), intent(in) :: path
      type(body_type), intent(out) :: body
      type(error_type), allocatable, intent(out) :: error
      real(wp), allocatable :: table(:, :)

      call read_table(path, 'x and height', 2, .true., table, error)
      if (.not. allocated(error)) call make_profile(path, table, body, error)
   end subroutine read_profile

   !> The profile in the datasets x and height of the data for a file. Error MFV_INPUT_ERROR.
   subroutine profile_of_data(data, file, body, error)
      type(case_data_type), intent(in) :: data
      character(*), intent(in) :: file
      type(body_type), intent(out) :: body
      type(error_type), allocatable, intent(out) :: error
      real(wp), allocatable :: table(:, :)

      call data%read_columns(file, 'x height', table, error)
      if (.not. allocated(error)) call make_profile(file, table, body, error)
   end subroutine profile_of_data

   !> The profile of a table of x and height, shape (2, points). Error MFV_INPUT_ERROR.
   subroutine make_profile(name, table, body, error)
      character(*), intent(in) :: name
      real(wp), intent(in) :: table(:, :)
      type(body_type), intent(out) :: body
      type(error_type), allocatable, intent(out) :: error

      if (size(table, 2) < fewest_points) then
         call set_error(error, MFV_INPUT_ERROR, name//': needs at least '//to_text(fewest_points)//' points, and has '// &
                        to_text(size(table, 2)))
      else
         body = new_profile(table(1, :), table(2, :))
      end if
   end subroutine make_profile

   !> Columns of numbers from a text file; blank lines and comments do not count. `names`: what they are, for messages;
   !> `columns`: how many; `increasing`: whether the first must increase. `table`: shape (columns, lines).
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
      integer :: i, n

      call read_text(path, text, error)
      if (allocated(error)) return
      if (index(text, byte_order_mark) == 1) text(:len(byte_order_mark)) = ''
      lines = split_lines(text)
      allocate (table(columns, size(lines)))
      n = 0
      do i = 1, size(lines)
         if (is_comment(lines(i)%text)) cycle
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
   end subroutine read_table

   pure logical function is_comment(line)
      character(*), intent(in) :: line

      is_comment = verify(line, ' '//achar(9)) == 0
      if (.not. is_comment) is_comment = scan(adjustl(line), '#!') == 1
   end function is_comment

   !> Finite numbers with blanks, tabs or one comma between them, and nothing else.
   subroutine read_columns(line, names, columns, error)
      character(*), intent(in) :: line, names
      real(wp), intent(out) :: columns(:)
      type(error_type), allocatable, intent(out) :: error
      character(*), parameter :: blanks = ' '//achar(9)
      character(len=5), parameter :: counts(3) = [character(5) :: 'one', 'two', 'three']
      integer :: at, length, i
      logical :: is_right

      columns = 0.0_wp
      at = 1
      is_right = .true.
      do i = 1, size(columns)
         call skip(blanks)
         if (i > 1 .and. line(at:min(at, len(line))) == ',') then
            at = at + 1
            call skip(blanks)
         end if
         length = scan(line(at:)//' ', blanks//',') - 1
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
