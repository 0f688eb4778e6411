!> Reading columns of numbers from text files: profiles, points, coefficients of friction.
module mfv_profile_file
   use mfv_body, only: body_type
   use mfv_case_data, only: case_data_type
   use mfv_error, only: error_type, set_error
   use mfv_kinds, only: wp
   use mfv_numbers, only: is_reasonable, read_real, reasonable_sizes
   use mfv_profile, only: profile_of_points, trace_type
   use mfv_status, only: MFV_INPUT_ERROR
   use mfv_strings, only: add_text, lower_case, shortened, string_type, to_text
   use mfv_text_file, only: byte_order_mark, read_text
   implicit none
   private
   public :: read_profile, read_table, read_named_table

   character(*), parameter :: line_feed = achar(10), carriage_return = achar(13)
   character(*), parameter :: blanks = ' '//achar(9), separators = ',;'

contains

   !> The profile in the file `path`, see read_table: x, increasing, and height in every line. `trace`: options; `data`: has the
   !> datasets x and height if they are in memory. Error MFV_INPUT_ERROR with the line and what would be right.
   subroutine read_profile(path, trace, body, error, data)
      character(*), intent(in) :: path
      type(trace_type), intent(in) :: trace
      type(body_type), intent(out) :: body
      type(error_type), allocatable, intent(out) :: error
      type(case_data_type), intent(in), optional :: data
      real(wp), allocatable :: table(:, :)

      if (present(data)) then
         call data%read_columns(path, 'x height', table, error)
      else
         call read_table(path, 'x and height', 2, .true., table, error)
      end if
      if (allocated(error)) return
      call profile_of_points(table(1, :), table(2, :), trace, body, error)
      if (allocated(error)) error%message = path//': '//error%message
   end subroutine read_profile

   !> Columns of numbers from a text file, without blank lines, comments and headers. `names`: of the columns, for messages;
   !> `columns`: their number; `increasing`: whether the first must increase. `table`: shape (columns, lines).
   !> Error MFV_INPUT_ERROR with the line and what would be right.
   subroutine read_table(path, names, columns, increasing, table, error)
      character(*), intent(in) :: path, names
      integer, intent(in) :: columns
      logical, intent(in) :: increasing
      real(wp), allocatable, intent(out) :: table(:, :)
      type(error_type), allocatable, intent(out) :: error
      character(:), allocatable :: text

      call read_lines(path, text, error)
      if (.not. allocated(error)) call parse_table(text, path, names, columns, increasing, table, error)
   end subroutine read_table

   !> The text of a file, with blanks in place of a byte-order mark. Error MFV_INPUT_ERROR.
   subroutine read_lines(path, text, error)
      character(*), intent(in) :: path
      character(:), allocatable, intent(out) :: text
      type(error_type), allocatable, intent(out) :: error

      call read_text(path, text, error)
      if (allocated(error)) return
      if (index(text, byte_order_mark) == 1) text(:len(byte_order_mark)) = ''
   end subroutine read_lines

   !> The same of the text of the file `path`.
   subroutine parse_table(text, path, names, columns, increasing, table, error)
      character(*), intent(in) :: text, path, names
      integer, intent(in) :: columns
      logical, intent(in) :: increasing
      real(wp), allocatable, intent(out) :: table(:, :)
      type(error_type), allocatable, intent(out) :: error
      type(error_type), allocatable :: fault_of_header
      character(:), allocatable :: line
      real(wp) :: numbers(columns)
      integer :: first, number, n

      allocate (table(columns, lines_of(text)))
      n = 0
      first = 1
      do number = 1, size(table, 2)
         call take_line(text, first, line)
         if (is_comment(line)) cycle
         call read_columns(line, names, numbers, error)
         if (.not. allocated(error) .and. increasing .and. n > 0) then
            if (numbers(1) <= table(1, n)) call set_error(error, MFV_INPUT_ERROR, 'x must increase from line to line')
         end if
         if (allocated(error)) error%message = path//':'//to_text(number)//': '//error%message
         if (n == 0 .and. is_header(line)) then
            if (.not. allocated(fault_of_header)) call move_alloc(error, fault_of_header)
            cycle
         end if
         if (allocated(error)) return
         n = n + 1
         table(:, n) = numbers
      end do
      table = table(:, :n)
      if (allocated(error)) deallocate (error)
      if (n == 0) call move_alloc(fault_of_header, error)
   end subroutine parse_table

   !> Columns of numbers from a text file whose first line, but for comments, has their names. `table`: shape (columns, lines).
   !> Error MFV_INPUT_ERROR with the line and what would be right.
   subroutine read_named_table(path, names, table, error)
      character(*), intent(in) :: path
      type(string_type), allocatable, intent(out) :: names(:)
      real(wp), allocatable, intent(out) :: table(:, :)
      type(error_type), allocatable, intent(out) :: error
      character(:), allocatable :: text, line
      integer :: first, number

      call read_lines(path, text, error)
      if (allocated(error)) return
      first = 1
      number = 0
      line = ''
      do while (first <= len(text) .and. is_comment(line))
         call take_line(text, first, line)
         number = number + 1
      end do
      if (is_header(line) .and. .not. is_comment(line)) then
         call read_names(line, names)
         call parse_table(text, path, 'one for each name in line '//to_text(number), size(names), .false., table, error)
      else
         call set_error(error, MFV_INPUT_ERROR, path//':'//to_text(number)//': must have the names of the columns, such as '// &
                        "normal_force,tangential_force, not '"//shortened(trim(line))//"'")
      end if
   end subroutine read_named_table

   !> The names in a header, without quotation marks: between commas or semicolons if it has any, else between blanks.
   subroutine read_names(line, names)
      character(*), intent(in) :: line
      type(string_type), allocatable, intent(out) :: names(:)
      character(len=len(line)) :: words
      character(:), allocatable :: ends, name
      integer :: first, length

      words = line
      ends = separators
      if (scan(line, separators) == 0) then
         ends = blanks
         words = adjustl(words)
      end if
      allocate (names(0))
      first = 1
      do while (first <= len_trim(words))
         length = scan(words(first:)//ends(1:1), ends) - 1
         call strip(words(first:first + length - 1), name)
         call add_text(names, name)
         first = first + length + 1
         if (scan(line, separators) == 0) first = first + max(verify(words(first:)//'x', blanks) - 1, 0)
      end do
   end subroutine read_names

   !> A name without blanks and quotation marks around it.
   pure subroutine strip(name, bare)
      character(*), intent(in) :: name
      character(:), allocatable, intent(out) :: bare
      character(*), parameter :: around = blanks//'"'''
      integer :: first

      bare = ''
      first = verify(name, around)
      if (first > 0) bare = name(first:verify(name, around, back=.true.))
   end subroutine strip

   !> Number of the lines of a text.
   pure integer function lines_of(text)
      character(*), intent(in) :: text
      integer :: i

      lines_of = 1 + count([(text(i:i) == line_feed, i=1, len(text))])
   end function lines_of

   !> The line that begins at `first`, without its end (LF or CR LF); `first` moves to the next line.
   pure subroutine take_line(text, first, line)
      character(*), intent(in) :: text
      integer, intent(inout) :: first
      character(:), allocatable, intent(out) :: line
      integer :: length

      length = index(text(first:), line_feed) - 1
      if (length < 0) length = len(text) - first + 1
      line = text(first:first + length - 1)
      first = first + length + 1
      if (index(line, carriage_return, back=.true.) == length) line = line(:length - 1)
   end subroutine take_line

   !> Whether a line before the numbers is a header: its first word does not look like a number.
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
      character(len=5), parameter :: words(3) = [character(5) :: 'one', 'two', 'three']
      character(:), allocatable :: how_many
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
      if (.not. is_right .or. verify(line(at:), blanks) > 0) then
         how_many = to_text(size(columns))
         if (size(columns) <= size(words)) how_many = trim(words(size(columns)))
         call set_error(error, MFV_INPUT_ERROR, 'must be '//how_many//' number'//trim(merge('s', ' ', size(columns) > 1))//', '// &
                        names//', not '''//shortened(trim(line))//'''')
         return
      end if
      if (.not. all(is_reasonable(columns))) call set_error(error, MFV_INPUT_ERROR, reasonable_sizes)

   contains

      !> Skip characters.
      subroutine skip(characters)
         character(*), intent(in) :: characters

         length = verify(line(at:), characters) - 1
         if (length < 0) length = len(line) - at + 1
         at = at + length
      end subroutine skip
   end subroutine read_columns

end module mfv_profile_file
