!> Parser of case files, which have the form of Fortran namelists: groups, keys, values and their lines.
!>
!> Unlike the namelist input of the compiler, it can name file, line, group, key and value of an
!> error. Form: `&group key=value, key=value /`, comments after
!> `!`, texts between ' or ", several values after one key, `5*0.3` for five times 0.3, keys and groups in upper or lower
!> case. The text is UTF-8, with or without a byte-order mark; lines end with LF or CR LF.
module mfv_namelist
   use mfv_error, only: error_type, set_error
   use mfv_status, only: MFV_INPUT_ERROR
   use mfv_strings, only: carriage_return, decimal_digits, line_feed, lower_case, shortened, string_type, tab, to_text
   use mfv_text_file, only: byte_order_mark, find_fault_of_text
   implicit none
   private
   public :: entry_type, group_type, parse_namelists, write_entry, show_entry, write_namelists, resize_groups, resize_entries

   !> One key with its value as written.
   type :: entry_type
      character(:), allocatable :: key
      !> Values as written, texts without their quotes; and which of them were quoted.
      type(string_type), allocatable :: values(:)
      logical, allocatable :: is_quoted(:)
      integer :: line = 0
   end type entry_type

   !> One group, from & to /.
   type :: group_type
      character(:), allocatable :: name
      type(entry_type), allocatable :: entries(:)
      integer :: line = 0
   end type group_type

   !> Position in a text.
   type :: cursor_type
      character(:), allocatable :: text, source
      integer :: at = 1, line = 1
      !> Commas skipped before it.
      integer :: commas = 0
   end type cursor_type

   character(*), parameter :: blanks = ' '//tab//carriage_return//line_feed
   !> What ends a value without quotes, besides blanks; the last two are quote and ampersand.
   character(*), parameter :: value_ends = ",/!='"//achar(34)//achar(38)
   character(*), parameter :: name_characters = 'abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_'

   !> Limits of groups in a text and of values of a key; more would take gigabytes.
   integer, parameter :: most_groups = 1000000, most_values = 10000000

contains

   !> All groups of a text. `source`: name of the file for messages. Error MFV_INPUT_ERROR with file and line.
   subroutine parse_namelists(text, source, groups, error)
      character(*), intent(in) :: text, source
      type(group_type), allocatable, intent(out) :: groups(:)
      type(error_type), allocatable, intent(out) :: error
      type(cursor_type) :: cursor
      character(:), allocatable :: why
      integer :: ended_in_line, n

      cursor%text = text
      cursor%source = source
      allocate (groups(0))
      n = 0
      ended_in_line = 0
      call find_fault_of_text(text, cursor%line, why)
      if (why /= '') then
         call complain(cursor, why, error)
         return
      end if
      cursor%line = 1
      if (index(text, byte_order_mark) == 1) cursor%at = len(byte_order_mark) + 1
      do
         call skip_blanks(cursor)
         if (cursor%at > len(cursor%text)) exit
         if (next(cursor) /= '&') then
            why = "'"//rest_of_line(cursor)//"' is outside a group; a group begins with &name"
            if (next(cursor) == '#') why = why//', a comment with !'
            if (ended_in_line == cursor%line) why = why//', and the / before it ended &'//groups(n)%name// &
                                                    ' (write numbers without units, texts with / between quotes)'
            call complain(cursor, why, error)
            return
         end if
         if (n == most_groups) then
            call complain(cursor, 'more than '//to_text(most_groups)//' groups', error)
            return
         end if
         if (n == size(groups)) call resize_groups(groups, 2*n + 1)
         n = n + 1
         call read_group(cursor, groups(n), error)
         if (allocated(error)) return
         ended_in_line = cursor%line
      end do
      call resize_groups(groups, n)
   end subroutine parse_namelists

   !> One group; the cursor is at its &.
   subroutine read_group(cursor, group, error)
      type(cursor_type), intent(inout) :: cursor
      type(group_type), intent(out) :: group
      type(error_type), allocatable, intent(out) :: error
      integer :: n

      group%line = cursor%line
      cursor%at = cursor%at + 1
      call read_name(cursor, group%name)
      allocate (group%entries(0))
      n = 0
      if (group%name == '') then
         call complain(cursor, 'a group name must follow &', error)
         return
      end if
      do
         call skip_separators(cursor)
         if (cursor%at > len(cursor%text) .or. next(cursor) == '&') then
            call complain(cursor, '&'//shortened(group%name)//' (line '//to_text(group%line)//') has no / at its end', error)
            return
         end if
         if (next(cursor) == '/') exit
         if (n == size(group%entries)) call resize_entries(group%entries, 2*n + 1)
         n = n + 1
         call read_entry(cursor, group%name, group%entries(n), error)
         if (allocated(error)) return
      end do
      cursor%at = cursor%at + 1
      call resize_entries(group%entries, n)
   end subroutine read_group

   !> Resize a list of groups; by move_alloc, here and below, because gfortran leaks components in array constructors.
   subroutine resize_groups(groups, length)
      type(group_type), allocatable, intent(inout) :: groups(:)
      integer, intent(in) :: length
      type(group_type), allocatable :: resized(:)
      integer :: i

      if (length == size(groups)) return
      allocate (resized(length))
      do i = 1, min(length, size(groups))
         call move_alloc(groups(i)%name, resized(i)%name)
         call move_alloc(groups(i)%entries, resized(i)%entries)
         resized(i)%line = groups(i)%line
      end do
      call move_alloc(resized, groups)
   end subroutine resize_groups

   !> Resize a list of entries.
   subroutine resize_entries(entries, length)
      type(entry_type), allocatable, intent(inout) :: entries(:)
      integer, intent(in) :: length
      type(entry_type), allocatable :: resized(:)
      integer :: i

      if (length == size(entries)) return
      allocate (resized(length))
      do i = 1, min(length, size(entries))
         call move_alloc(entries(i)%key, resized(i)%key)
         call move_alloc(entries(i)%values, resized(i)%values)
         call move_alloc(entries(i)%is_quoted, resized(i)%is_quoted)
         resized(i)%line = entries(i)%line
      end do
      call move_alloc(resized, entries)
   end subroutine resize_entries

   !> One key=value.
   subroutine read_entry(cursor, group, entry, error)
      type(cursor_type), intent(inout) :: cursor
      character(*), intent(in) :: group
      type(entry_type), intent(out) :: entry
      type(error_type), allocatable, intent(out) :: error

      entry%line = cursor%line
      call read_name(cursor, entry%key)
      if (entry%key == '') then
         call complain(cursor, '&'//group//": expected key=value, not '"//rest_of_line(cursor)//"'", error)
         return
      end if
      call skip_blanks(cursor)
      if (next(cursor) == '(' .or. next(cursor) == '%') then
         call complain(cursor, '&'//group//' '//shortened(entry%key)//rest_of_line(cursor)//': a key takes no index or '// &
                       'component; list all values after the key, as in mu=0.3, 0.4', error)
         return
      else if (next(cursor) /= '=') then
         call complain(cursor, '&'//group//' '//shortened(entry%key)//": expected '=' after the key", error)
         return
      end if
      cursor%at = cursor%at + 1
      call read_values(cursor, group, entry, error)
   end subroutine read_entry

   !> The values after a key: up to the next key or the end of the group.
   subroutine read_values(cursor, group, entry, error)
      type(cursor_type), intent(inout) :: cursor
      character(*), intent(in) :: group
      type(entry_type), intent(inout) :: entry
      type(error_type), allocatable, intent(out) :: error
      character(:), allocatable :: value, place
      character(len=1) :: mark
      logical :: at_end, is_quoted, is_closed
      integer :: i, n, repeats

      allocate (entry%values(0))
      allocate (entry%is_quoted(0))
      n = 0
      place = '&'//shortened(group)//' '//shortened(entry%key)
      do
         call skip_separators(cursor)
         at_end = values_end(cursor)
         if (at_end .or. cursor%commas > min(n, 1)) exit
         call read_repeats(cursor, repeats)
         if (repeats < 1 .or. repeats > most_values - n) then
            call complain(cursor, place//": '"//rest_of_line(cursor)//"': the number before * must be a whole number from "// &
                          '1 to '//to_text(most_values - n), error)
            return
         end if
         mark = next(cursor)
         is_quoted = mark == "'" .or. mark == '"'
         if (is_quoted) then
            call read_quoted(cursor, mark, value, is_closed)
         else
            call read_bare(cursor, value)
         end if
         if (is_quoted .and. .not. is_closed) then
            cursor%line = entry%line
            call complain(cursor, place//': the text has no closing '//mark, error)
            return
         else if (value == '' .and. .not. is_quoted) then
            call complain(cursor, place//': a value is missing after *', error)
            return
         end if
         if (n + repeats > size(entry%values)) call resize_values(entry, 2*n + repeats)
         do i = n + 1, n + repeats
            entry%values(i)%text = value
         end do
         entry%is_quoted(n + 1:n + repeats) = is_quoted
         n = n + repeats
      end do
      if (cursor%commas > merge(1, min(n, 1), at_end)) &
         call complain(cursor, place//': a value is missing next to a comma', error)
      call resize_values(entry, n)
   end subroutine read_values

   !> Whether the values of a key end at the cursor: there is the next key, or the end of the group or of the text.
   pure logical function values_end(cursor)
      type(cursor_type), intent(in) :: cursor

      values_end = cursor%at > len(cursor%text) .or. scan(next(cursor), '/&=') == 1 .or. key_follows(cursor)
   end function values_end

   !> Resize the list of values.
   subroutine resize_values(entry, length)
      type(entry_type), intent(inout) :: entry
      integer, intent(in) :: length
      type(string_type), allocatable :: values(:)
      logical, allocatable :: is_quoted(:)
      integer :: i, n

      if (length == size(entry%values)) return
      allocate (values(length))
      allocate (is_quoted(length), source=.false.)
      n = min(length, size(entry%values))
      do i = 1, n
         call move_alloc(entry%values(i)%text, values(i)%text)
      end do
      is_quoted(:n) = entry%is_quoted(:n)
      call move_alloc(values, entry%values)
      call move_alloc(is_quoted, entry%is_quoted)
   end subroutine resize_values

   !> The repeat count before the next value, as the 5 in 5*0.3; 1 by default, and 0 if it cannot be read. The cursor moves to the
   !> value, unless the count cannot be read.
   subroutine read_repeats(cursor, repeats)
      type(cursor_type), intent(inout) :: cursor
      integer, intent(out) :: repeats
      integer :: length, code

      repeats = 1
      length = verify(cursor%text(cursor%at:), decimal_digits) - 1
      if (length < 1) return
      if (cursor%text(cursor%at + length:cursor%at + length) /= '*') return
      read (cursor%text(cursor%at:cursor%at + length - 1), *, iostat=code) repeats
      if (code /= 0 .or. repeats < 1) repeats = 0
      if (repeats > 0) cursor%at = cursor%at + length + 1
   end subroutine read_repeats

   !> A text between quotes; a doubled quote stands for one. `is_closed`: whether there is a quote at its end.
   subroutine read_quoted(cursor, mark, text, is_closed)
      type(cursor_type), intent(inout) :: cursor
      character(len=1), intent(in) :: mark
      character(:), allocatable, intent(out) :: text
      logical, intent(out) :: is_closed
      integer :: length

      text = ''
      cursor%at = cursor%at + 1
      do
         length = index(cursor%text(cursor%at:), mark) - 1
         is_closed = length >= 0
         if (is_closed) is_closed = index(cursor%text(cursor%at:cursor%at + length - 1), line_feed) == 0
         if (.not. is_closed) return
         text = text//cursor%text(cursor%at:cursor%at + length - 1)
         cursor%at = cursor%at + length + 1
         if (next(cursor) /= mark) return
         text = text//mark
         cursor%at = cursor%at + 1
      end do
   end subroutine read_quoted

   !> A value without quotes: up to a blank, a comma, a comment or the end of the group.
   subroutine read_bare(cursor, text)
      type(cursor_type), intent(inout) :: cursor
      character(:), allocatable, intent(out) :: text
      integer :: length

      length = scan(cursor%text(cursor%at:), blanks//value_ends) - 1
      if (length < 0) length = len(cursor%text) - cursor%at + 1
      text = cursor%text(cursor%at:cursor%at + length - 1)
      cursor%at = cursor%at + length
   end subroutine read_bare

   !> Whether a name and '=' follow; the name may have an index or component, which read_entry refuses.
   pure logical function key_follows(cursor)
      type(cursor_type), intent(in) :: cursor
      integer :: after, length

      length = verify(cursor%text(cursor%at:), name_characters//'(:)%') - 1
      key_follows = .false.
      if (length < 1 .or. scan(next(cursor), name_characters) == 0) return
      after = verify(cursor%text(cursor%at + length:), blanks)
      if (after > 0) key_follows = cursor%text(cursor%at + length + after - 1:cursor%at + length + after - 1) == '='
   end function key_follows

   !> A name of a group or a key, in lower case; empty if there is none.
   subroutine read_name(cursor, name)
      type(cursor_type), intent(inout) :: cursor
      character(:), allocatable, intent(out) :: name
      integer :: length

      length = verify(cursor%text(cursor%at:), name_characters) - 1
      if (length < 0) length = len(cursor%text) - cursor%at + 1
      name = lower_case(cursor%text(cursor%at:cursor%at + length - 1))
      cursor%at = cursor%at + length
   end subroutine read_name

   !> The character at the cursor, a blank at the end.
   pure character(len=1) function next(cursor)
      type(cursor_type), intent(in) :: cursor

      next = ' '
      if (cursor%at <= len(cursor%text)) next = cursor%text(cursor%at:cursor%at)
   end function next

   !> Skip blanks, line ends and comments.
   subroutine skip_blanks(cursor)
      type(cursor_type), intent(inout) :: cursor
      integer :: length

      do while (cursor%at <= len(cursor%text))
         if (next(cursor) == '!') then
            length = index(cursor%text(cursor%at:), line_feed) - 1
            if (length < 0) length = len(cursor%text) - cursor%at + 1
            cursor%at = cursor%at + length
         else if (scan(next(cursor), blanks) == 1) then
            if (next(cursor) == line_feed) cursor%line = cursor%line + 1
            cursor%at = cursor%at + 1
         else
            return
         end if
      end do
   end subroutine skip_blanks

   !> Skip blanks, comments and commas.
   subroutine skip_separators(cursor)
      type(cursor_type), intent(inout) :: cursor

      call skip_blanks(cursor)
      cursor%commas = 0
      do while (next(cursor) == ',')
         cursor%commas = cursor%commas + 1
         cursor%at = cursor%at + 1
         call skip_blanks(cursor)
      end do
   end subroutine skip_separators

   !> The rest of the line, for messages, shortened and with printable characters only.
   pure function rest_of_line(cursor) result(text)
      type(cursor_type), intent(in) :: cursor
      character(len=length_of_rest(cursor)) :: text
      integer :: i

      text = cursor%text(cursor%at:cursor%at + len(text) - 1)
      do i = 1, len(text)
         if (iachar(text(i:i)) < 32 .or. iachar(text(i:i)) == 127) text(i:i) = '?'
      end do
   end function rest_of_line

   !> Length of the rest of the line, shortened.
   pure integer function length_of_rest(cursor) result(length)
      type(cursor_type), intent(in) :: cursor
      integer, parameter :: longest = 40

      length = index(cursor%text(cursor%at:), line_feed) - 1
      if (length < 0) length = len(cursor%text) - cursor%at + 1
      length = min(length, longest)
   end function length_of_rest

   !> key=value as the user wrote it, texts between apostrophes.
   pure subroutine write_entry(entry, text)
      type(entry_type), intent(in) :: entry
      character(:), allocatable, intent(out) :: text
      integer :: i

      text = entry%key//'='
      do i = 1, size(entry%values)
         if (i > 1) text = text//', '
         if (entry%is_quoted(i)) then
            call add_quoted(entry%values(i)%text, text)
         else
            text = text//entry%values(i)%text
         end if
      end do
   end subroutine write_entry

   !> Append `words` between apostrophes to a text; an apostrophe in it is doubled.
   pure subroutine add_quoted(words, text)
      character(*), intent(in) :: words
      character(:), allocatable, intent(inout) :: text
      integer :: first, length

      text = text//"'"
      first = 1
      do
         length = index(words(first:), "'")
         if (length == 0) exit
         text = text//words(first:first + length - 1)//"'"
         first = first + length
      end do
      text = text//words(first:)//"'"
   end subroutine add_quoted

   !> The same for a message, with long texts and lists of values shortened.
   pure subroutine show_entry(entry, text)
      type(entry_type), intent(in) :: entry
      character(:), allocatable, intent(out) :: text
      integer, parameter :: shown = 5
      type(entry_type) :: part
      integer :: i, n

      n = min(size(entry%values), shown)
      part%key = shortened(entry%key)
      allocate (part%values(n))
      do i = 1, n
         part%values(i)%text = shortened(entry%values(i)%text)
      end do
      part%is_quoted = entry%is_quoted(:n)
      call write_entry(part, text)
      if (n < size(entry%values)) text = text//', ... ('//to_text(size(entry%values))//' values)'
   end subroutine show_entry

   !> Groups as a text, one per line; parse_namelists reads the same groups from it.
   pure subroutine write_namelists(groups, text)
      type(group_type), intent(in) :: groups(:)
      character(:), allocatable, intent(out) :: text
      character(:), allocatable :: written
      integer :: i, j

      text = ''
      do i = 1, size(groups)
         text = text//'&'//groups(i)%name//' '
         do j = 1, size(groups(i)%entries)
            call write_entry(groups(i)%entries(j), written)
            if (j > 1) text = text//', '
            text = text//written
         end do
         text = text//' /'//line_feed
      end do
   end subroutine write_namelists

   subroutine complain(cursor, message, error)
      type(cursor_type), intent(in) :: cursor
      character(*), intent(in) :: message
      type(error_type), allocatable, intent(out) :: error

      call set_error(error, MFV_INPUT_ERROR, cursor%source//':'//to_text(cursor%line)//': '//message)
   end subroutine complain

end module mfv_namelist
