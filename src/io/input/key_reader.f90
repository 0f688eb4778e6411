!> A text taken apart into groups and keys, checked against a list of keys (mfv_keys), and read value by value; every
!> message names file, line, group, key, value and what is right.
module mfv_key_reader
   use mfv_case_data, only: case_data_type
   use mfv_error, only: error_type, set_error
   use mfv_keys
   use mfv_kinds, only: wp
   use mfv_namelist, only: entry_type, group_type, groups_of_name, show_entry
   use mfv_numbers, only: read_real, read_whole
   use mfv_status, only: MFV_INPUT_ERROR
   use mfv_strings, only: list_of_words, lower_case, nearest_name, shortened, string_type, to_text
   use mfv_text_file, only: path_beside
   implicit none
   private
   public :: reader_type, check_groups, check_entries, count_groups, line_of, find_file, merge_text, suggest, fail

   !> Places of the groups of one name.
   type :: places_type
      character(:), allocatable :: name
      integer, allocatable :: place(:)
   end type places_type

   !> A text taken apart, with the list of keys to read it by.
   type :: reader_type
      !> Name of the text for messages, and the directory, with its final slash, in which the files that it names are.
      character(:), allocatable :: source, directory
      type(group_type), allocatable :: groups(:)
      type(catalogue_type) :: catalogue
      !> Where the groups of each name are, in the order of the catalogue's groups: a load history may have many steps.
      type(places_type), allocatable :: places(:)
      logical :: without_steps = .false.
      !> Data in memory in place of files.
      type(case_data_type) :: data
   contains
      procedure :: has
      procedure :: real_value
      procedure :: real_values
      procedure :: integer_value
      procedure :: logical_value
      procedure :: text_value
      procedure :: complain
      procedure :: need
      procedure :: entry_of
   end type reader_type

contains

   !> Every group known, and those that must be alone alone. The reader can then be asked for values.
   subroutine check_groups(reader, error)
      type(reader_type), intent(inout) :: reader
      type(error_type), allocatable, intent(out) :: error
      character(:), allocatable :: why
      integer :: i, j

      do i = 1, size(reader%groups)
         associate (group => reader%groups(i))
            if (.not. reader%catalogue%has_group(group%name)) then
               call suggest(group%name, reader%catalogue%groups(), '&', why)
               call fail(reader, group%line, '&'//shortened(group%name)//': unknown group'// &
                         why//'; groups are '//reader%catalogue%group_list, error)
               return
            end if
            if (reader%catalogue%repeats(group%name)) cycle
            do j = 1, i - 1
               if (reader%groups(j)%name /= group%name) cycle
               call fail(reader, group%line, '&'//group%name//': may come only once, and is already in line '// &
                         to_text(reader%groups(j)%line), error)
               return
            end do
         end associate
      end do
      call find_places(reader)
   end subroutine check_groups

   !> Find the groups of every name.
   subroutine find_places(reader)
      type(reader_type), intent(inout) :: reader
      type(string_type), allocatable :: names(:)
      integer :: i, j

      names = reader%catalogue%groups()
      allocate (reader%places(size(names)))
      do i = 1, size(names)
         reader%places(i)%name = names(i)%text
         reader%places(i)%place = pack([(j, j=1, size(reader%groups))], &
                                       [(reader%groups(j)%name == names(i)%text, j=1, size(reader%groups))])
      end do
   end subroutine find_places

   !> Place of the `number`-th group of a name, 0 for none.
   pure integer function place_of(reader, name, number) result(place)
      type(reader_type), intent(in) :: reader
      character(*), intent(in) :: name
      integer, intent(in) :: number
      integer :: i

      place = 0
      do i = 1, size(reader%places)
         if (reader%places(i)%name /= name) cycle
         if (number <= size(reader%places(i)%place)) place = reader%places(i)%place(number)
         return
      end do
   end function place_of

   !> Every key known, there once, with one value of the right kind in the right range.
   subroutine check_entries(reader, error)
      type(reader_type), intent(in) :: reader
      type(error_type), allocatable, intent(out) :: error
      character(:), allocatable :: why, written, other
      integer :: i, j, k

      do i = 1, size(reader%groups)
         do j = 1, size(reader%groups(i)%entries)
            associate (group => reader%groups(i)%name, entry => reader%groups(i)%entries(j))
               k = reader%catalogue%place(group, entry%key)
               if (k == 0) then
                  call suggest(entry%key, reader%catalogue%names(group), '', why)
                  call find_group_of(reader%catalogue, entry%key, other)
                  if (other /= '') why = '; it is one of &'//other
                  why = 'unknown key'//why
               else if (any([(reader%groups(i)%entries(k)%key == entry%key, k=1, j - 1)])) then
                  why = 'the key is there twice'
               else
                  call find_fault(reader%catalogue%keys(reader%catalogue%place(group, entry%key)), entry, why)
               end if
               if (why /= '') then
                  call show_entry(entry, written)
                  call fail(reader, entry%line, '&'//group//' '//written//': '//why, error)
                  return
               end if
            end associate
         end do
      end do
   end subroutine check_entries

   !> The first group that has a key of this name, empty for none.
   pure subroutine find_group_of(catalogue, name, group)
      type(catalogue_type), intent(in) :: catalogue
      character(*), intent(in) :: name
      character(:), allocatable, intent(out) :: group
      integer :: i

      group = ''
      do i = 1, size(catalogue%keys)
         if (catalogue%keys(i)%name == name .and. group == '') group = catalogue%keys(i)%group
      end do
   end subroutine find_group_of

   !> What is wrong with the value of an entry; empty when nothing is.
   subroutine find_fault(key, entry, why)
      type(key_type), intent(in) :: key
      type(entry_type), intent(in) :: entry
      character(:), allocatable, intent(out) :: why
      real(wp) :: value
      integer :: code
      logical :: right, reasonable
      integer :: i

      reasonable = .true.
      right = size(entry%values) == 1 .or. (key%is_list .and. size(entry%values) > 1)
      do i = 1, size(entry%values)
         if (.not. right) exit
         right = entry%is_quoted(i) .eqv. (key%kind == kind_text .or. key%kind == kind_choice)
         if (.not. right) exit
         select case (key%kind)
         case (kind_choice)
            right = any_equal(list_of_words(key%choices), entry%values(i)%text)
         case (kind_logical)
            right = logical_code(entry%values(i)%text) >= 0
         case (kind_integer, kind_real)
            call read_number(entry%values(i)%text, key%kind, value, code)
            right = code == 0 .and. value >= key%lower .and. value <= key%upper
            if (right .and. key%lower_open) right = value > key%lower
            if (right .and. key%kind == kind_real) reasonable = is_reasonable(value)
            right = right .and. reasonable
         end select
      end do
      why = ''
      if (right) return
      call describe_allowed(key, why)
      why = 'must be '//why
      if (key%unit /= '') why = why//' ('//key%unit//')'
      if (.not. reasonable) why = why//'; '//reasonable_sizes
   end subroutine find_fault

   !> A finite number; `code` is not 0 where the text is none.
   pure subroutine read_number(text, kind, value, code)
      character(*), intent(in) :: text
      integer, intent(in) :: kind
      real(wp), intent(out) :: value
      integer, intent(out) :: code
      integer :: whole
      logical :: is_right

      if (kind == kind_integer) then
         call read_whole(text, whole, is_right)
         value = whole
      else
         call read_real(text, value, is_right)
      end if
      code = merge(0, 1, is_right)
   end subroutine read_number

   !> 1 for true, 0 for false, -1 for neither.
   pure integer function logical_code(text)
      character(*), intent(in) :: text

      select case (lower_case(text))
      case ('.true.', 't', 'true', '.t.')
         logical_code = 1
      case ('.false.', 'f', 'false', '.f.')
         logical_code = 0
      case default
         logical_code = -1
      end select
   end function logical_code

   !> Path of a file that a key names, beside the case.
   subroutine find_file(reader, group, number, name, path)
      type(reader_type), intent(in) :: reader
      character(*), intent(in) :: group, name
      integer, intent(in) :: number
      character(:), allocatable, intent(out) :: path

      path = reader%text_value(group, number, name)
      path = path_beside(reader%directory, path)
   end subroutine find_file

   !> The entry of a key in the `number`-th group of a name; `found` false where it is not written.
   pure subroutine entry_of(self, group, number, name, entry, found)
      class(reader_type), intent(in) :: self
      character(*), intent(in) :: group, name
      integer, intent(in) :: number
      type(entry_type), intent(out) :: entry
      logical, intent(out) :: found
      integer :: place, i

      found = .false.
      place = place_of(self, group, number)
      if (place == 0) return
      do i = 1, size(self%groups(place)%entries)
         found = self%groups(place)%entries(i)%key == name
         if (found) entry = self%groups(place)%entries(i)
         if (found) return
      end do
   end subroutine entry_of

   !> Whether a key is written in the `number`-th group of a name.
   pure logical function has(self, group, number, name)
      class(reader_type), intent(in) :: self
      character(*), intent(in) :: group, name
      integer, intent(in) :: number
      type(entry_type) :: entry

      call self%entry_of(group, number, name, entry, has)
   end function has

   !> The value as written, or the default.
   pure function text_value(self, group, number, name) result(text)
      class(reader_type), intent(in) :: self
      character(*), intent(in) :: group, name
      integer, intent(in) :: number
      character(len=length_of_value(self, group, number, name)) :: text
      character(:), allocatable :: value

      call find_value(self, group, number, name, value)
      text = value
   end function text_value

   !> Length of the value as written, or of the default.
   pure integer function length_of_value(reader, group, number, name) result(length)
      class(reader_type), intent(in) :: reader
      character(*), intent(in) :: group, name
      integer, intent(in) :: number
      character(:), allocatable :: value

      call find_value(reader, group, number, name, value)
      length = len(value)
   end function length_of_value

   !> The value as written, or the default: text_value for a caller who has a variable for it.
   pure subroutine find_value(reader, group, number, name, value)
      class(reader_type), intent(in) :: reader
      character(*), intent(in) :: group, name
      integer, intent(in) :: number
      character(:), allocatable, intent(out) :: value
      type(entry_type) :: entry
      logical :: found

      call reader%entry_of(group, number, name, entry, found)
      if (found) then
         value = entry%values(1)%text
      else
         value = reader%catalogue%keys(reader%catalogue%place(group, name))%default
      end if
   end subroutine find_value

   !> The value of a key for a number.
   pure real(wp) function real_value(self, group, number, name)
      class(reader_type), intent(in) :: self
      character(*), intent(in) :: group, name
      integer, intent(in) :: number
      character(:), allocatable :: text
      integer :: code

      call find_value(self, group, number, name, text)
      call read_number(text, kind_real, real_value, code)
   end function real_value

   !> All values of a key that is written, as numbers.
   pure subroutine real_values(self, group, number, name, values)
      class(reader_type), intent(in) :: self
      character(*), intent(in) :: group, name
      integer, intent(in) :: number
      real(wp), allocatable, intent(out) :: values(:)
      type(entry_type) :: entry
      logical :: found
      integer :: i, code

      call self%entry_of(group, number, name, entry, found)
      if (.not. found) return
      allocate (values(size(entry%values)))
      do i = 1, size(values)
         call read_number(entry%values(i)%text, kind_real, values(i), code)
      end do
   end subroutine real_values

   !> The value of a key for a whole number.
   pure integer function integer_value(self, group, number, name)
      class(reader_type), intent(in) :: self
      character(*), intent(in) :: group, name
      integer, intent(in) :: number
      character(:), allocatable :: text
      real(wp) :: value
      integer :: code

      call find_value(self, group, number, name, text)
      call read_number(text, kind_integer, value, code)
      integer_value = nint(value)
   end function integer_value

   !> The value of a key for .true. or .false.
   pure logical function logical_value(self, group, number, name)
      class(reader_type), intent(in) :: self
      character(*), intent(in) :: group, name
      integer, intent(in) :: number
      character(:), allocatable :: text

      call find_value(self, group, number, name, text)
      logical_value = logical_code(text) == 1
   end function logical_value

   !> Error where a key is not written.
   subroutine need(self, group, number, name, error)
      class(reader_type), intent(in) :: self
      character(*), intent(in) :: group, name
      integer, intent(in) :: number
      type(error_type), allocatable, intent(out) :: error
      character(:), allocatable :: allowed

      if (self%has(group, number, name)) return
      call describe_allowed(self%catalogue%keys(self%catalogue%place(group, name)), allowed)
      call fail(self, line_of(self, group, number), '&'//group//trim(numbered(self, group, number))//': '//name// &
                ' is missing; it must be '//allowed, error)
   end subroutine need

   !> Error about a key of the `number`-th group of a name.
   subroutine complain(self, group, number, name, why, error)
      class(reader_type), intent(in) :: self
      character(*), intent(in) :: group, name, why
      integer, intent(in) :: number
      type(error_type), allocatable, intent(inout) :: error
      character(:), allocatable :: written
      type(entry_type) :: entry
      logical :: found
      integer :: line

      call self%entry_of(group, number, name, entry, found)
      line = merge(entry%line, line_of(self, group, number), found)
      written = name
      if (found) call show_entry(entry, written)
      call fail(self, line, '&'//group//trim(numbered(self, group, number))//' '//written//': '//why, error)
   end subroutine complain

   !> One of two texts, without the blanks that merge wants.
   pure function merge_text(condition, yes, no) result(text)
      logical, intent(in) :: condition
      character(*), intent(in) :: yes, no
      character(len=merge(len(yes), len(no), condition)) :: text

      text = no
      if (condition) text = yes
   end function merge_text

   !> Number of a group that may come more than once, after a blank; padded with blanks.
   pure function numbered(reader, group, number) result(text)
      class(reader_type), intent(in) :: reader
      character(*), intent(in) :: group
      integer, intent(in) :: number
      character(len=12) :: text

      text = ''
      if (reader%catalogue%repeats(group)) text = ' '//to_text(number)
   end function numbered

   !> Number of groups of a name.
   pure integer function count_groups(reader, name)
      type(reader_type), intent(in) :: reader
      character(*), intent(in) :: name

      count_groups = groups_of_name(reader%groups, name)
   end function count_groups

   !> Line of the `number`-th group of a name, 0 for none.
   pure integer function line_of(reader, name, number)
      type(reader_type), intent(in) :: reader
      character(*), intent(in) :: name
      integer, intent(in) :: number
      integer :: place

      line_of = 0
      place = place_of(reader, name, number)
      if (place > 0) line_of = reader%groups(place)%line
   end function line_of

   pure logical function any_equal(words, text)
      type(string_type), intent(in) :: words(:)
      character(*), intent(in) :: text
      integer :: i

      any_equal = .false.
      do i = 1, size(words)
         any_equal = any_equal .or. words(i)%text == text
      end do
   end function any_equal

   !> '; did you mean ...?' where a known name is near, else empty.
   pure subroutine suggest(name, names, prefix, text)
      character(*), intent(in) :: name, prefix
      type(string_type), intent(in) :: names(:)
      character(:), allocatable, intent(out) :: text

      text = nearest_name(name, names)
      if (text /= '') text = '; did you mean '//prefix//text//'?'
   end subroutine suggest

   subroutine fail(reader, line, message, error)
      type(reader_type), intent(in) :: reader
      integer, intent(in) :: line
      character(*), intent(in) :: message
      type(error_type), allocatable, intent(inout) :: error
      character(:), allocatable :: place

      place = reader%source//':'
      if (line > 0) place = place//to_text(line)//':'
      if (allocated(error)) deallocate (error)
      call set_error(error, MFV_INPUT_ERROR, place//' '//message)
   end subroutine fail

end module mfv_key_reader
