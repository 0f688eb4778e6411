!> Columns of numbers from text files as instruments, spreadsheets and programs write them.
!>
!> Encodings: UTF-8, with or without a byte-order mark, UTF-16, and any other that keeps ASCII in texts that are not read. Lines end
!> with LF, CR LF, CR CR LF or CR. Between numbers: blanks, tabs, a comma or a semicolon; with semicolons, tabs, blanks or quotation
!> marks a decimal comma is recognised. Skipped: blank lines, comments (#, !, %, //), lines of text before the numbers, and a line
!> with the number of rows. Separators at the end of lines are ignored.
module mfv_table_file
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan, ieee_quiet_nan, ieee_value
   use mfv_error, only: error_type, set_error
   use mfv_kinds, only: wp
   use mfv_numbers, only: is_reasonable, read_real, reasonable_sizes
   use mfv_status, only: MFV_INPUT_ERROR
   use mfv_strings, only: add_text, carriage_return, decimal_digits, line_feed, lower_case, shortened, string_type, tab, to_text
   use mfv_text_file, only: byte_order_mark, find_fault_of_text, read_text
   use mfv_tolerances, only: significant
   implicit none
   private
   public :: read_table, read_named_table

   character(*), parameter :: blanks = ' '//tab, quotation_marks = '"'''
   !> Cells without a value.
   character(len=4), parameter :: no_values(11) = [character(4) :: '', 'nan', 'na', 'n/a', 'null', 'bad', '-', '--', '---', '*', &
                                                                                                                   '***']
   !> Lines among which columns and decimal marks are recognised.
   integer, parameter :: lines_of_sample = 1000
   !> A line with more cells than this has no names of columns.
   integer, parameter :: most_names = 1000

   !> The lines of a file and how they are divided.
   type :: text_type
      character(:), allocatable :: path, text
      !> First and last byte of each line, without its end.
      integer, allocatable :: first(:), last(:)
      !> For messages: of the columns.
      character(:), allocatable :: names
      logical :: decimal_comma = .false.
   contains
      procedure :: line
      procedure :: find_lines
      procedure :: best_run
      procedure :: first_row
      procedure :: parse
      procedure :: refuse_row
   end type text_type

contains

   !> Columns of numbers from a text file, without comments and lines of text before the numbers; a first column of row numbers,
   !> followed by a column that increases, is dropped. `names`: of the columns, for messages; `columns`: their number; `increasing`:
   !> whether the first must increase; rows in which it decreases are reversed. `table`: shape (columns, rows).
   !> `is_trace`: cells may have no value, NaN then, and the last column may be alone: shape (1, rows). `heading`: names of columns
   !> in the file, none without.
   !> Error MFV_INPUT_ERROR with line, column and what would be right.
   subroutine read_table(path, names, columns, increasing, table, error, is_trace, heading)
      character(*), intent(in) :: path, names
      integer, intent(in) :: columns
      logical, intent(in) :: increasing
      real(wp), allocatable, intent(out) :: table(:, :)
      type(error_type), allocatable, intent(out) :: error
      logical, intent(in), optional :: is_trace
      type(string_type), allocatable, intent(out), optional :: heading(:)
      type(text_type) :: text, copy
      integer, allocatable :: rows(:)
      real(wp), allocatable :: alone(:, :)
      type(error_type), allocatable :: fault
      logical :: with_gaps, plain
      integer :: found, header

      with_gaps = .false.
      if (present(is_trace)) with_gaps = is_trace
      call read_lines(path, text, error)
      if (allocated(error)) return
      text%names = names
      if (present(heading)) then
         copy = text
         call find_header(copy, header, heading)
         if (.not. allocated(heading)) allocate (heading(0))
      end if
      found = columns
      plain = starts_with_row(text, columns)
      if (plain) then
         call text%parse(1, columns, with_gaps, table, rows, error)
         plain = .not. allocated(error)
      end if
      if (.not. plain) then
         call recognise(text, columns, with_gaps, found)
         if (found < columns) text%names = 'a height, or two, '//names
         call text%parse(1, found, with_gaps, table, rows, error)
      end if
      if (allocated(error)) return
      if (found == columns + 1) call drop_row_numbers(text, rows, table, error)
      if (found == 1 .and. columns > 1) call drop_count(text, rows, table)
      if (allocated(error) .or. .not. increasing .or. size(table, 1) < columns) return
      call order(text, rows, table, error)
      if (.not. (allocated(error) .and. with_gaps) .or. text%decimal_comma) return
      ! 0,5 in a line is two columns only if the first increases.
      text%decimal_comma = .true.
      call text%parse(1, 1, with_gaps, alone, rows, fault)
      if (allocated(fault)) return
      call move_alloc(alone, table)
      deallocate (error)
   end subroutine read_table

   !> Whether the first line that is no comment is a row of `columns` numbers. If all others are too, nothing else can be meant.
   logical function starts_with_row(text, columns)
      type(text_type), intent(in) :: text
      integer, intent(in) :: columns
      real(wp) :: values(columns)
      integer :: i, bad

      starts_with_row = .false.
      do i = 1, size(text%first)
         if (is_comment(text%line(i))) cycle
         call read_row(text%line(i), text%decimal_comma, values, bad)
         starts_with_row = bad == 0
         return
      end do
   end function starts_with_row

   !> Columns of numbers from a text file under a line with their names, which may be a comment. `table`: shape (columns, rows).
   !> Error MFV_INPUT_ERROR with line, column and what would be right.
   subroutine read_named_table(path, names, table, error)
      character(*), intent(in) :: path
      type(string_type), allocatable, intent(out) :: names(:)
      real(wp), allocatable, intent(out) :: table(:, :)
      type(error_type), allocatable, intent(out) :: error
      type(text_type) :: text
      integer, allocatable :: rows(:)
      integer :: header, i

      call read_lines(path, text, error)
      if (allocated(error)) return
      call find_header(text, header, names)
      if (header == 0) then
         do i = 1, size(text%first)
            if (.not. is_comment(text%line(i))) exit
         end do
         i = max(1, min(i, size(text%first)))
         call set_error(error, MFV_INPUT_ERROR, path//':'//to_text(i)//': must have the names of the columns, such as '// &
                        "normal_force,tangential_force, not '"//shown(text%line(i))//"'")
         return
      end if
      text%names = 'one for each name in line '//to_text(header)
      call text%parse(header + 1, size(names), .false., table, rows, error)
   end subroutine read_named_table

   !> The lines of a file. Error MFV_INPUT_ERROR where it is not a text.
   subroutine read_lines(path, text, error)
      character(*), intent(in) :: path
      type(text_type), intent(out) :: text
      type(error_type), allocatable, intent(out) :: error
      character(:), allocatable :: bytes

      text%path = path
      call read_text(path, bytes, error)
      if (allocated(error)) return
      call widen(bytes)
      call plain_text(bytes, text%text, error)
      if (allocated(error)) error%message = path//':'//error%message
      if (.not. allocated(error)) call text%find_lines()
   end subroutine read_lines

   !> Make UTF-8 of UTF-16, which has a byte-order mark or zeros in every second byte of its first two characters.
   subroutine widen(bytes)
      character(:), allocatable, intent(inout) :: bytes
      character(:), allocatable :: narrow
      character(len=4) :: start
      integer :: i, n, length, high, code

      start = bytes
      if (len(bytes) < 4) return
      if (start(:2) == char(255)//char(254) .or. (is_zero(2) .and. is_zero(4) .and. .not. is_zero(1) .and. .not. is_zero(3))) then
         high = 1
      else if (start(:2) == char(254)//char(255) .or. &
               (is_zero(1) .and. is_zero(3) .and. .not. is_zero(2) .and. .not. is_zero(4))) then
         high = 0
      else
         return
      end if
      allocate (character(len=2*len(bytes)) :: narrow)
      n = 0
      i = 1
      do while (i < len(bytes))
         code = unit_at(i)
         i = i + 2
         if (code >= 55296 .and. code < 56320 .and. i < len(bytes)) then ! a pair of surrogates
            code = 65536 + 1024*(code - 55296) + iand(unit_at(i), 1023)
            i = i + 2
         end if
         call encode(code, narrow(n + 1:), length)
         n = n + length
      end do
      bytes = narrow(:n)

   contains

      pure logical function is_zero(place)
         integer, intent(in) :: place

         is_zero = start(place:place) == char(0)
      end function is_zero

      !> The number of two bytes.
      pure integer function unit_at(place)
         integer, intent(in) :: place

         unit_at = 256*ichar(bytes(place + high:place + high)) + ichar(bytes(place + 1 - high:place + 1 - high))
      end function unit_at
   end subroutine widen

   !> Write the UTF-8 of a character at the start of a text; `length`: its bytes.
   pure subroutine encode(code, text, length)
      integer, intent(in) :: code
      character(*), intent(inout) :: text
      integer, intent(out) :: length
      integer, parameter :: limits(4) = [128, 2048, 65536, huge(1)], leads(4) = [0, 192, 224, 240]
      integer :: rest, i

      length = findloc(code < limits, .true., dim=1)
      rest = code
      do i = length, 2, -1
         text(i:i) = char(128 + iand(rest, 63))
         rest = rest/64
      end do
      text(1:1) = char(leads(length) + rest)
   end subroutine encode

   !> A text whose lines end with LF, without byte-order mark and with ASCII for a minus sign and a no-break space. Error
   !> MFV_INPUT_ERROR with line and column for control characters.
   subroutine plain_text(bytes, text, error)
      character(*), intent(in) :: bytes
      character(:), allocatable, intent(out) :: text
      type(error_type), allocatable, intent(out) :: error
      character(*), parameter :: minus = char(226)//char(136)//char(146), no_break = char(194)//char(160), end_of_file = char(26)
      integer :: i, n, line, start, code, length

      length = len(bytes)
      if (length > 0) then
         if (bytes(length:) == end_of_file) length = length - 1
      end if
      allocate (character(len=length) :: text)
      i = 1
      if (index(bytes, byte_order_mark) == 1) i = 1 + len(byte_order_mark)
      n = 0
      line = 1
      start = 0
      do while (i <= length)
         code = ichar(bytes(i:i))
         n = n + 1
         text(n:n) = bytes(i:i)
         if (bytes(i:i) == carriage_return) then
            do while (i < length .and. bytes(min(i + 1, length):min(i + 1, length)) == carriage_return)
               i = i + 1
            end do
            if (i < length .and. bytes(min(i + 1, length):min(i + 1, length)) == line_feed) i = i + 1
            text(n:n) = line_feed
         else if (code > 127) then
            if (bytes(i:min(i + 2, length)) == minus) then
               text(n:n) = '-'
               i = i + 2
            else if (bytes(i:min(i + 1, length)) == no_break) then
               text(n:n) = ' '
               i = i + 1
            end if
         else if (code == 12) then ! form feed
            text(n:n) = ' '
         else if ((code < 32 .and. scan(bytes(i:i), tab//line_feed) == 0) .or. code == 127) then
            call set_error(error, MFV_INPUT_ERROR, to_text(line)//':'//to_text(characters(text(start + 1:n)))// &
                           ': not a text file: control character '//to_text(code))
            return
         end if
         if (text(n:n) == line_feed) then
            line = line + 1
            start = n
         end if
         i = i + 1
      end do
      text = text(:n)
   end subroutine plain_text

   !> Number of characters in UTF-8, or of bytes after ASCII that are none.
   pure integer function characters(text)
      character(*), intent(in) :: text
      integer :: i

      characters = 0
      do i = 1, len(text)
         if (i == 1 .or. iand(ichar(text(i:i)), 192) /= 128 .or. ichar(text(max(i - 1, 1):max(i - 1, 1))) < 128) &
            characters = characters + 1
      end do
   end function characters

   !> Find the lines of the text.
   subroutine find_lines(self)
      class(text_type), intent(inout) :: self
      integer :: i, n

      n = 1
      do i = 1, len(self%text)
         if (self%text(i:i) == line_feed) n = n + 1
      end do
      allocate (self%first(n), self%last(n))
      n = 1
      self%first(1) = 1
      do i = 1, len(self%text)
         if (self%text(i:i) /= line_feed) cycle
         self%last(n) = i - 1
         n = n + 1
         self%first(n) = i + 1
      end do
      self%last(n) = len(self%text)
   end subroutine find_lines

   !> A line without its end.
   pure function line(self, number)
      class(text_type), intent(in) :: self
      integer, intent(in) :: number
      character(len=self%last(number) - self%first(number) + 1) :: line

      line = self%text(self%first(number):self%last(number))
   end function line

   !> A line for a message: shortened, and without bytes that cannot be printed.
   pure function shown(line)
      character(*), intent(in) :: line
      character(len=len(shortened(trim(adjustl(line))))) :: shown
      character(:), allocatable :: why
      integer :: i, number

      shown = shortened(trim(adjustl(line)))
      call find_fault_of_text(shown, number, why)
      do i = 1, len(shown)
         if (shown(i:i) == tab) shown(i:i) = ' '
         if (ichar(shown(i:i)) < 32 .or. ichar(shown(i:i)) == 127 .or. (why /= '' .and. ichar(shown(i:i)) > 127)) shown(i:i) = '?'
      end do
   end function shown

   !> How the rows of a text are divided: its decimal mark, and the number of columns `found` with the longest run of rows:
   !> `columns`, one more (row numbers), or for `is_trace` 1 (heights alone).
   subroutine recognise(text, columns, is_trace, found)
      type(text_type), intent(inout) :: text
      integer, intent(in) :: columns
      logical, intent(in) :: is_trace
      integer, intent(out) :: found
      integer :: choices(3), i, mark, run, longest, rows
      logical :: decimal_comma

      rows = count([(.not. is_comment(text%line(i)), i=1, min(size(text%first), lines_of_sample))])
      choices = [columns, columns + 1, 1]
      found = columns
      decimal_comma = .false.
      longest = 0
      do i = 1, merge(3, 2, is_trace)
         do mark = 1, 2
            if (longest == rows) exit
            text%decimal_comma = mark == 2
            run = text%best_run(choices(i))
            if (run <= longest) cycle
            longest = run
            found = choices(i)
            decimal_comma = text%decimal_comma
         end do
      end do
      text%decimal_comma = decimal_comma
   end subroutine recognise

   !> Most successive rows of `columns` numbers in the sample.
   integer function best_run(self, columns)
      class(text_type), intent(in) :: self
      integer, intent(in) :: columns
      real(wp) :: values(columns)
      integer :: i, run, bad

      best_run = 0
      run = 0
      do i = 1, min(size(self%first), lines_of_sample)
         if (is_comment(self%line(i))) cycle
         call read_row(self%line(i), self%decimal_comma, values, bad)
         run = run + 1
         if (bad > 0) run = 0
         best_run = max(best_run, run)
      end do
   end function best_run

   !> The first line at or after `start` that is a row of `columns` numbers; 0 for none.
   integer function first_row(self, start, columns)
      class(text_type), intent(in) :: self
      integer, intent(in) :: start, columns
      real(wp) :: values(columns)
      integer :: bad

      do first_row = start, size(self%first)
         if (is_comment(self%line(first_row))) cycle
         call read_row(self%line(first_row), self%decimal_comma, values, bad)
         if (bad == 0) return
      end do
      first_row = 0
   end function first_row

   !> The rows of `columns` numbers from the line `start` on, shape (columns, rows), and their lines. Lines of text may come before
   !> them, and a count of rows. `with_gaps`: whether cells may have no value.
   subroutine parse(self, start, columns, with_gaps, table, rows, error)
      class(text_type), intent(in) :: self
      integer, intent(in) :: start, columns
      logical, intent(in) :: with_gaps
      real(wp), allocatable, intent(out) :: table(:, :)
      integer, allocatable, intent(out) :: rows(:)
      type(error_type), allocatable, intent(out) :: error
      real(wp) :: values(columns), counted
      integer :: i, n, first, bad, count_line

      first = self%first_row(start, columns)
      call check_head(self, start, first, columns, counted, count_line, error)
      allocate (table(columns, 0), rows(0))
      if (allocated(error) .or. first == 0) return
      deallocate (table, rows)
      allocate (table(columns, size(self%first) - first + 1), rows(size(self%first) - first + 1))
      n = 0
      do i = first, size(self%first)
         if (is_comment(self%line(i))) cycle
         call read_row(self%line(i), self%decimal_comma, values, bad)
         if (bad > 0) then
            call self%refuse_row(i, bad, columns, error)
         else if (any(ieee_is_nan(values)) .and. .not. with_gaps) then
            call set_error(error, MFV_INPUT_ERROR, self%path//':'//to_text(i)//': must have a value in every column, '// &
                           self%names//", not '"//shown(self%line(i))//"'")
         else if (.not. all(is_reasonable(values))) then
            call set_error(error, MFV_INPUT_ERROR, self%path//':'//to_text(i)//': '//reasonable_sizes)
         end if
         if (allocated(error)) return
         n = n + 1
         table(:, n) = values
         rows(n) = i
      end do
      table = table(:, :n)
      rows = rows(:n)
      if (count_line > 0 .and. abs(counted - n) > 1.5_wp) &
         call set_error(error, MFV_INPUT_ERROR, self%path//':'//to_text(count_line)//': the file has '//to_text(n)// &
                        ' rows, not '//shown(self%line(count_line))//'; complete it, or correct the number')
   end subroutine parse

   !> Error unless the lines from `start` to the `first` row of numbers (0 if the file has no row) are text, except for one whole
   !> number below the text, the number of rows: `counted`, in the line `count_line`, 0 if it is not given.
   subroutine check_head(text, start, first, columns, counted, count_line, error)
      class(text_type), intent(in) :: text
      integer, intent(in) :: start, first, columns
      real(wp), intent(out) :: counted
      integer, intent(out) :: count_line
      type(error_type), allocatable, intent(out) :: error
      real(wp) :: single(1), values(columns)
      logical :: is_number
      integer :: i, bad, last

      counted = 0.0_wp
      count_line = 0
      last = size(text%first)
      if (first > 0) last = first - 1
      do i = last, start, -1
         if (is_comment(text%line(i))) cycle
         if (is_text(text%line(i)) .and. first > 0) exit
         call read_row(text%line(i), text%decimal_comma, single, bad)
         is_number = bad == 0 .and. verify(trim(adjustl(text%line(i))), decimal_digits) == 0
         if (is_number .and. first > 0 .and. count_line == 0) then
            count_line = i
            counted = single(1)
            cycle
         end if
         if (allocated(error)) deallocate (error)
         call read_row(text%line(i), text%decimal_comma, values, bad)
         call text%refuse_row(i, bad, columns, error)
      end do
   end subroutine check_head

   !> Error about a line that is not a row of numbers. `bad`: the byte of a cell that is not a number, beyond the line for another
   !> number of cells.
   subroutine refuse_row(self, number, bad, columns, error)
      class(text_type), intent(in) :: self
      integer, intent(in) :: number, bad, columns
      type(error_type), allocatable, intent(out) :: error
      character(len=5), parameter :: words(3) = [character(5) :: 'one', 'two', 'three']
      character(:), allocatable :: how_many, place, row

      how_many = to_text(columns)
      if (columns <= size(words)) how_many = trim(words(columns))
      row = self%line(number)
      place = self%path//':'//to_text(number)
      if (bad <= len(row)) place = place//':'//to_text(characters(row(:bad)))
      call set_error(error, MFV_INPUT_ERROR, place//': must be '//how_many//' number'// &
                     trim(merge('s', ' ', columns > 1))//', '//self%names//", not '"//shown(row)//"'")
   end subroutine refuse_row

   !> Drop a first column of row numbers. Error unless it is one and the second column increases or decreases.
   subroutine drop_row_numbers(text, rows, table, error)
      type(text_type), intent(in) :: text
      integer, intent(in) :: rows(:)
      real(wp), allocatable, intent(inout) :: table(:, :)
      type(error_type), allocatable, intent(out) :: error
      integer :: n, i
      logical :: are_numbers

      n = size(table, 2)
      are_numbers = n > 1 .and. abs(table(1, 1)*(table(1, 1) - 1.0_wp)) < significant
      are_numbers = are_numbers .and. all([(abs(table(1, i) - table(1, 1) - (i - 1)) < significant, i=1, n)])
      are_numbers = are_numbers .and. (all(table(2, 2:) > table(2, :n - 1)) .or. all(table(2, 2:) < table(2, :n - 1)))
      if (are_numbers) then
         table = table(2:, :)
      else
         call text%refuse_row(rows(1), len(text%line(rows(1))) + 1, size(table, 1) - 1, error)
      end if
   end subroutine drop_row_numbers

   !> Drop a whole number above heights that is their number.
   subroutine drop_count(text, rows, table)
      type(text_type), intent(in) :: text
      integer, intent(in) :: rows(:)
      real(wp), allocatable, intent(inout) :: table(:, :)
      integer :: n

      n = size(rows) - 1
      if (n < 1) return
      if (verify(trim(adjustl(text%line(rows(1)))), decimal_digits) > 0) return
      if (verify(trim(adjustl(text%line(rows(2)))), decimal_digits) == 0) return
      if (abs(table(1, 1) - n) < 1.5_wp) table = table(:, 2:)
   end subroutine drop_count

   !> Reverse rows in which x decreases. Error unless it then increases from row to row; rows without x do not count.
   subroutine order(text, rows, table, error)
      type(text_type), intent(in) :: text
      integer, intent(in) :: rows(:)
      real(wp), allocatable, intent(inout) :: table(:, :)
      type(error_type), allocatable, intent(out) :: error
      integer, allocatable :: given(:)
      real(wp) :: direction
      integer :: i

      given = pack([(i, i=1, size(rows))],.not. ieee_is_nan(table(1, :)))
      if (size(given) < 2) return
      direction = sign(1.0_wp, table(1, given(2)) - table(1, given(1)))
      do i = 2, size(given)
         associate (x => table(1, given(i)), before => table(1, given(i - 1)))
            if (direction*(x - before) > 0.0_wp) cycle
            call set_error(error, MFV_INPUT_ERROR, text%path//':'//to_text(rows(given(i)))//': x must increase from line to '// &
                           'line, or decrease; it is '//to_text(x)//' after '//to_text(before))
         end associate
         return
      end do
      if (direction < 0.0_wp) table = table(:, size(rows):1:-1)
   end subroutine order

   !> The line with the names of the columns, 0 for none, and the decimal mark of the rows below it: the last line of text that has
   !> as many names as the first row has numbers, or else the last one; or, without lines of text, a comment of that kind.
   subroutine find_header(text, header, names)
      type(text_type), intent(inout) :: text
      integer, intent(out) :: header
      type(string_type), allocatable, intent(out) :: names(:)
      integer, allocatable :: lines(:)
      integer :: i, mark, row, first

      lines = [integer ::]
      do i = 1, size(text%first)
         if (is_comment(text%line(i))) cycle
         if (.not. is_text(text%line(i))) exit
         lines = [lines, i]
      end do
      if (size(lines) == 0) lines = pack([(row, row=1, i - 1)], [(is_comment(text%line(row)), row=1, i - 1)])
      do mark = 1, 2
         text%decimal_comma = mark == 2
         do row = size(lines), 1, -1
            header = lines(row)
            call read_names(text%line(header), names)
            if (size(names) == 0) cycle
            if (i > size(text%first)) cycle
            first = text%first_row(i, size(names))
            if (first == i) return
         end do
      end do
      text%decimal_comma = .false.
      header = 0
      if (size(lines) == 0) return
      if (is_comment(text%line(lines(1)))) return
      header = lines(size(lines))
      call read_names(text%line(header), names)
   end subroutine find_header

   !> The names in a line, without the sign of a comment, quotation marks and bytes that cannot be printed.
   subroutine read_names(line, names)
      character(*), intent(in) :: line
      type(string_type), allocatable, intent(out) :: names(:)
      integer :: from(most_names), to(most_names), cells, spare, start, i

      start = 1
      if (is_comment(line)) start = max(1, verify(line, blanks//'#!%/'))
      call divide(line(start:), .true., .false., from, to, cells, spare)
      allocate (names(0))
      if (cells > most_names) return
      do i = 1, cells
         call add_text(names, shown(line(start + from(i) - 1:start + to(i) - 1)))
      end do
   end subroutine read_names

   !> Whether a line before the numbers is text: it has a letter, and its first word does not begin like a number.
   pure logical function is_text(line)
      character(*), intent(in) :: line
      character(*), parameter :: letters = 'abcdefghijklmnopqrstuvwxyz'
      character(:), allocatable :: word
      integer :: first

      first = max(1, verify(line, blanks//quotation_marks))
      word = lower_case(line(first:first + scan(line(first:)//' ', blanks//',;"''') - 2))
      is_text = scan(lower_case(line), letters) > 0 .and. scan(word, decimal_digits//'+-.') /= 1 .and. &
                .not. any(word == [character(8) :: 'nan', 'inf', 'infinity'])
   end function is_text

   !> Whether a line is blank, has only separators, or is a comment.
   pure logical function is_comment(line)
      character(*), intent(in) :: line

      is_comment = verify(line, blanks//',;') == 0
      if (is_comment) return
      associate (first => verify(line, blanks))
         is_comment = scan(line(first:first), '#!%') == 1 .or. index(line(first:), '//') == 1
      end associate
   end function is_comment

   !> The numbers in a line, NaN for cells without a value. `bad`: 0, or the first byte of a cell that is not a number, beyond the
   !> line if there are fewer or more cells.
   subroutine read_row(line, decimal_comma, values, bad)
      character(*), intent(in) :: line
      logical, intent(in) :: decimal_comma
      real(wp), intent(out) :: values(:)
      integer, intent(out) :: bad
      integer :: from(size(values)), to(size(values)), length, cells, spare, i
      logical :: is_right

      length = scan(line, '#') - 1
      if (length < 0) length = len(line)
      values = ieee_value(values, ieee_quiet_nan)
      call divide(line(:length), decimal_comma, .false., from, to, cells, spare)
      if (cells /= size(values) .and. index(line(:length), tab) > 0) &
         call divide(line(:length), decimal_comma, .true., from, to, cells, spare)
      bad = 0
      do i = 1, min(cells, size(values))
         call read_cell(line(from(i):to(i)), decimal_comma, is_quoted(), values(i), is_right)
         if (.not. is_right .and. bad == 0) bad = from(i)
      end do
      if (bad > 0) return
      if (cells == 0 .or. cells > size(values) .or. cells + spare < size(values)) bad = len(line) + 1
      ! Dashes alone may be a line of units.
      if (size(values) > 1 .and. all(ieee_is_nan(values)) .and. index(lower_case(line), 'nan') == 0) bad = len(line) + 1

   contains

      !> Whether the cell is in quotation marks.
      pure logical function is_quoted()
         is_quoted = .false.
         if (from(i) > 1) is_quoted = scan(line(from(i) - 1:from(i) - 1), quotation_marks) == 1
      end function is_quoted
   end subroutine read_row

   !> A number, or NaN for a cell without a value. In quotation marks, and with `decimal_comma`, a comma is a decimal mark.
   subroutine read_cell(cell, decimal_comma, is_quoted, value, is_right)
      character(*), intent(in) :: cell
      logical, intent(in) :: decimal_comma, is_quoted
      real(wp), intent(out) :: value
      logical, intent(out) :: is_right
      character(len=len(cell)) :: digits_of
      integer :: comma

      digits_of = cell
      comma = index(cell, ',')
      is_right = .not. (index(cell, '.') > 0 .and. (comma > 0 .or. decimal_comma))
      if (comma > 0 .and. (decimal_comma .or. is_quoted)) digits_of(comma:comma) = '.'
      if (is_right) call read_real(digits_of, value, is_right)
      if (is_right) return
      value = ieee_value(value, ieee_quiet_nan)
      if (len(cell) <= len(no_values)) is_right = any(lower_case(cell) == no_values)
   end subroutine read_cell

   !> The cells of a line, without blanks and quotation marks around them: first and last byte of each, and how many there are,
   !> at most one more than fit. Between them is one semicolon, or one tab if `by_tabs`, or one comma unless `decimal_comma`, or
   !> blanks: the first of these that the line has before its end. `spare`: separators at the end of the line.
   pure subroutine divide(line, decimal_comma, by_tabs, from, to, cells, spare)
      character(*), intent(in) :: line
      logical, intent(in) :: decimal_comma, by_tabs
      integer, intent(out) :: from(:), to(:), cells, spare
      character(len=1) :: mark
      integer :: length, at, next

      from = 1
      to = 0
      cells = 0
      length = verify(line, blanks//',;', back=.true.)
      spare = 0
      if (length < len(line)) spare = count([(scan(line(at:at), ',;'//tab) == 1, at=length + 1, len(line))])
      mark = ' '
      if (has(';')) then
         mark = ';'
      else if (by_tabs .and. has(tab)) then
         mark = tab
      else if (has(',') .and. .not. (decimal_comma .and. .not. is_list())) then
         mark = ','
      end if
      at = 1
      do while (at <= length .or. (at == length + 1 .and. cells == 0 .and. length > 0))
         at = skip(at)
         next = end_of_cell(at)
         cells = cells + 1
         if (cells > size(from)) return
         call trim_cell(at, next - 1, from(cells), to(cells))
         at = next + 1
         if (mark == ' ' .and. at <= length) at = skip(at)
      end do

   contains

      !> Whether a character is in the line outside quotation marks.
      pure logical function has(character)
         character(len=1), intent(in) :: character
         integer :: i
         character(len=1) :: open

         has = .false.
         if (index(line(:length), character) == 0) return
         open = ' '
         do i = 1, length
            if (open /= ' ') then
               if (line(i:i) == open) open = ' '
            else if (scan(line(i:i), quotation_marks) == 1 .and. begins_cell(i)) then
               open = line(i:i)
            else if (line(i:i) == character) then
               has = .true.
               return
            end if
         end do
      end function has

      !> Whether the cells of a line with commas are names or in quotation marks.
      pure logical function is_list()
         is_list = is_text(line) .or. scan(line, quotation_marks) > 0
      end function is_list

      !> Whether a cell may begin at a place.
      pure logical function begins_cell(i)
         integer, intent(in) :: i

         begins_cell = i == 1
         if (i > 1) begins_cell = scan(line(i - 1:i - 1), blanks//',;') == 1
      end function begins_cell

      !> The next place that is not blank; tabs that are separators are not skipped.
      pure integer function skip(place)
         integer, intent(in) :: place

         skip = place
         do while (skip <= length)
            if (line(skip:skip) /= ' ' .and. (line(skip:skip) /= tab .or. mark == tab)) return
            skip = skip + 1
         end do
      end function skip

      !> The place after the cell that begins at one.
      pure integer function end_of_cell(place)
         integer, intent(in) :: place
         integer :: i

         i = place
         if (i <= length) then
            if (scan(line(i:i), quotation_marks) == 1) then
               i = i + index(line(i + 1:length), line(i:i)) + 1
            end if
         end if
         do while (i <= length)
            if (line(i:i) == mark .or. (mark == ' ' .and. line(i:i) == tab)) exit
            i = i + 1
         end do
         end_of_cell = i
      end function end_of_cell

      !> The place of a cell without blanks and quotation marks around it.
      pure subroutine trim_cell(first, last, from, to)
         integer, intent(in) :: first, last
         integer, intent(out) :: from, to

         from = first
         to = last
         do while (from <= to)
            if (scan(line(to:to), blanks) == 0) exit
            to = to - 1
         end do
         if (to <= from) return
         if (scan(line(from:from), quotation_marks) == 1 .and. line(from:from) == line(to:to)) then
            from = from + 1
            to = to - 1
         end if
      end subroutine trim_cell
   end subroutine divide

end module mfv_table_file
