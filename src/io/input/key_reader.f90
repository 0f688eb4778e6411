!> Check a parsed text against a catalogue of keys (mfv_keys) and read it value by value. Every message names file, line, group,
!> key, value and what would be right.
module mfv_key_reader
   use mfv_case_data, only: case_data_type
   use mfv_error, only: error_type, set_error
   use mfv_keys
   use mfv_kinds, only: wp
   use mfv_namelist, only: entry_type, group_type, show_entry
   use mfv_numbers, only: is_reasonable, read_real, reasonable_sizes
   use mfv_status, only: MFV_INPUT_ERROR
   use mfv_strings, only: decimal_digits, has_word, list_of_words, lower_case, shortened, string_type, to_text
   implicit none
   private
   public :: reader_type, check_groups, check_entries, count_groups, line_of, find_file, fail, decimal_point, needs_friction

   !> Advice at the end of a message about 50,5, which is two values.
   character(*), parameter :: decimal_point = '; write decimals with a point'
   !> Fault of a value that acts through friction only.
   character(*), parameter :: needs_friction = 'needs a &friction law with a coefficient above 0'
   character(*), parameter :: comment_mark = '; a comment begins with !'
   !> Groups of a study, which is no case.
   character(*), parameter :: groups_of_studies = ' sweep vary '
   character(*), parameter :: words_for_true = ' .true. t true .t. ', words_for_false = ' .false. f false .f. '

   !> A parsed text with its catalogue of keys.
   type :: reader_type
      !> Name of the text for messages, and the directory, with its final slash, in which the files that it names are.
      character(:), allocatable :: source, directory
      type(group_type), allocatable :: groups(:)
      !> Which of the groups of its name each of them is, from 1.
      integer, allocatable :: number(:)
      type(catalogue_type) :: catalogue
      logical :: without_steps = .false.
      !> Data in memory instead of files.
      type(case_data_type) :: data
   contains
      procedure :: has
      procedure :: real_value
      procedure :: real_values
      procedure :: integer_value
      procedure :: logical_value
      procedure :: text_value
      procedure :: choice
      procedure :: complain
      procedure :: need
   end type reader_type

contains

   !> Check that every group is known and repeated only where allowed. Call this before values are read.
   subroutine check_groups(reader, error)
      type(reader_type), intent(inout) :: reader
      type(error_type), allocatable, intent(out) :: error
      character(:), allocatable :: why
      integer :: i, j

      allocate (reader%number(size(reader%groups)), source=1)
      do i = 1, size(reader%groups)
         associate (group => reader%groups(i))
            if (.not. has_word(reader%catalogue%group_list, group%name)) then
               call suggest(group%name, reader%catalogue%groups(), '&', why)
               if (has_word(groups_of_studies, group%name)) why = "; this is a study: solve it with 'mfv study'"
               call fail(reader, group%line, '&'//shortened(group%name)//': unknown group'// &
                         why//'; groups are '//reader%catalogue%group_list, error)
               return
            end if
            do j = i - 1, 1, -1
               if (reader%groups(j)%name == group%name) exit
            end do
            if (j == 0) cycle
            reader%number(i) = reader%number(j) + 1
            if (has_word(reader%catalogue%repeated_groups, group%name)) cycle
            call fail(reader, group%line, '&'//group%name//': may be given only once; it is already in line '// &
                      to_text(reader%groups(j)%line), error)
            return
         end associate
      end do
   end subroutine check_groups

   !> Place of the `number`-th group of a name, 0 for none.
   pure integer function place_of(reader, name, number) result(place)
      type(reader_type), intent(in) :: reader
      character(*), intent(in) :: name
      integer, intent(in) :: number

      ! Group `number` of a name cannot come earlier; a load history may have many steps.
      do place = number, size(reader%groups)
         if (reader%number(place) == number .and. reader%groups(place)%name == name) return
      end do
      place = 0
   end function place_of

   !> Check that every key is known and given once, with values of the right kind and in range.
   subroutine check_entries(reader, error)
      type(reader_type), intent(in) :: reader
      type(error_type), allocatable, intent(out) :: error
      character(:), allocatable :: why, written
      integer :: i, j, k, place

      do i = 1, size(reader%groups)
         do j = 1, size(reader%groups(i)%entries)
            associate (group => reader%groups(i)%name, entry => reader%groups(i)%entries(j))
               place = reader%catalogue%place(group, entry%key)
               if (place == 0) then
                  call suggest(entry%key, reader%catalogue%names(group), '', why)
                  do k = size(reader%catalogue%keys), 1, -1
                     if (reader%catalogue%keys(k)%name == entry%key) why = '; it is one of &'//reader%catalogue%keys(k)%group
                  end do
                  why = 'unknown key'//why
               else if (any([(reader%groups(i)%entries(k)%key == entry%key, k=1, j - 1)])) then
                  why = 'the key is given twice'
               else
                  call find_fault(reader%catalogue%keys(place), entry, why)
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

   !> What is wrong with the value of an entry; empty if it is valid.
   subroutine find_fault(key, entry, why)
      type(key_type), intent(in) :: key
      type(entry_type), intent(in) :: entry
      character(:), allocatable, intent(out) :: why
      real(wp) :: value
      logical :: right, reasonable, is_text
      integer :: i

      is_text = key%kind == kind_text .or. key%kind == kind_choice
      reasonable = .true.
      right = size(entry%values) == 1 .or. (key%is_list .and. size(entry%values) > 1)
      do i = 1, size(entry%values)
         if (right) right = entry%is_quoted(i) .eqv. is_text
         if (.not. right) exit
         associate (text => entry%values(i)%text)
            select case (key%kind)
            case (kind_choice)
               right = has_word(key%choices, text)
            case (kind_logical)
               right = has_word(words_for_true//words_for_false, lower_case(text))
            case (kind_integer, kind_real)
               call read_real(text, value, right)
               if (key%kind == kind_integer) right = right .and. verify(text, '+-0123456789') == 0
               right = right .and. value >= key%lower .and. value <= key%upper
               if (key%lower_open) right = right .and. value > key%lower
               reasonable = .not. right .or. is_reasonable(value)
               right = right .and. reasonable
            end select
         end associate
      end do
      why = ''
      if (right .and. key%names_file()) then
         if (entry%values(1)%text == '') why = 'must not be empty: name a file, or remove the key'
      end if
      if (right) return
      if (size(entry%values) > 1 .and. .not. key%is_list .and. all(entry%is_quoted .eqv. is_text)) then
         why = 'one value expected, found '//to_text(size(entry%values))
         if (key%kind == kind_real .and. has_decimal_comma(entry)) then
            why = why//decimal_point
         else if (has_number_sign(entry)) then
            why = why//comment_mark
         else if (any(key%kind == [kind_integer, kind_real]) .and. starts_with_letter(entry%values(2)%text)) then
            why = why//'; write numbers without units'
         end if
         return
      end if
      call describe_allowed(key, why)
      why = 'must be '//why
      if (key%unit /= '') why = why//' ('//key%unit//')'
      if (.not. reasonable) why = why//'; '//reasonable_sizes
      if (has_number_sign(entry)) then
         why = why//comment_mark
      else if (key%kind == kind_choice .and. .not. all(entry%is_quoted)) then
         why = why//', between quotes'
      end if
   end subroutine find_fault

   !> Whether the values end in a comment that begins with #, as in other languages.
   pure logical function has_number_sign(entry)
      type(entry_type), intent(in) :: entry
      integer :: i

      has_number_sign = any([(.not. entry%is_quoted(i) .and. index(entry%values(i)%text, '#') == 1, i=1, size(entry%values))])
   end function has_number_sign

   !> Whether the values may be a single number with a decimal comma.
   pure logical function has_decimal_comma(entry)
      type(entry_type), intent(in) :: entry

      has_decimal_comma = size(entry%values) == 2 .and. .not. any(entry%is_quoted)
      if (has_decimal_comma) has_decimal_comma = verify(entry%values(1)%text, '+-'//decimal_digits) == 0 .and. &
                                                 verify(entry%values(2)%text, decimal_digits//'eEdD+-') == 0
   end function has_decimal_comma

   !> Whether a text starts with a letter or a per cent sign, as a unit does.
   elemental logical function starts_with_letter(text)
      character(*), intent(in) :: text

      starts_with_letter = scan(text(:min(1, len(text))), 'abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ%') == 1
   end function starts_with_letter

   !> Path of the file that a key names, relative to the case; `in_memory`: the name of data in memory.
   subroutine find_file(reader, group, number, name, path, in_memory)
      type(reader_type), intent(in) :: reader
      character(*), intent(in) :: group, name
      integer, intent(in) :: number
      character(:), allocatable, intent(out) :: path
      logical, intent(out) :: in_memory

      path = reader%text_value(group, number, name)
      in_memory = reader%data%has_file(path)
      if (.not. in_memory .and. index(path, '/') /= 1) path = reader%directory//path
   end subroutine find_file

   !> Where a key is in the `number`-th group of a name: group and entry; entry 0 where it is not written.
   pure subroutine find_entry(reader, group, number, name, i, j)
      class(reader_type), intent(in) :: reader
      character(*), intent(in) :: group, name
      integer, intent(in) :: number
      integer, intent(out) :: i, j

      j = 0
      i = place_of(reader, group, number)
      if (i == 0) return
      do j = size(reader%groups(i)%entries), 1, -1
         if (reader%groups(i)%entries(j)%key == name) return
      end do
   end subroutine find_entry

   !> Whether a key is written in the `number`-th group of a name.
   pure logical function has(self, group, number, name)
      class(reader_type), intent(in) :: self
      character(*), intent(in) :: group, name
      integer, intent(in) :: number
      integer :: i, j

      call find_entry(self, group, number, name, i, j)
      has = j > 0
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

   !> The value as written, or the default, as an allocatable.
   pure subroutine find_value(reader, group, number, name, value)
      class(reader_type), intent(in) :: reader
      character(*), intent(in) :: group, name
      integer, intent(in) :: number
      character(:), allocatable, intent(out) :: value
      integer :: i, j

      call find_entry(reader, group, number, name, i, j)
      if (j > 0) then
         value = reader%groups(i)%entries(j)%values(1)%text
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
      logical :: is_right

      call find_value(self, group, number, name, text)
      call read_real(text, real_value, is_right)
   end function real_value

   !> All values of a key that is written, as numbers.
   pure subroutine real_values(self, group, number, name, values)
      class(reader_type), intent(in) :: self
      character(*), intent(in) :: group, name
      integer, intent(in) :: number
      real(wp), allocatable, intent(out) :: values(:)
      logical :: is_right
      integer :: i, j, k

      call find_entry(self, group, number, name, i, j)
      if (j == 0) return
      associate (texts => self%groups(i)%entries(j)%values)
         allocate (values(size(texts)))
         do k = 1, size(values)
            call read_real(texts(k)%text, values(k), is_right)
         end do
      end associate
   end subroutine real_values

   !> The value of a key for a whole number.
   pure integer function integer_value(self, group, number, name)
      class(reader_type), intent(in) :: self
      character(*), intent(in) :: group, name
      integer, intent(in) :: number

      integer_value = nint(self%real_value(group, number, name))
   end function integer_value

   !> The value of a key for .true. or .false.
   pure logical function logical_value(self, group, number, name)
      class(reader_type), intent(in) :: self
      character(*), intent(in) :: group, name
      integer, intent(in) :: number

      logical_value = has_word(words_for_true, lower_case(self%text_value(group, number, name)))
   end function logical_value

   !> Position of the value of a key among its choices (mfv_case_keys).
   pure integer function choice(self, group, number, name)
      class(reader_type), intent(in) :: self
      character(*), intent(in) :: group, name
      integer, intent(in) :: number
      type(string_type), allocatable :: choices(:)

      choices = list_of_words(self%catalogue%keys(self%catalogue%place(group, name))%choices)
      do choice = size(choices), 2, -1
         if (choices(choice)%text == self%text_value(group, number, name)) return
      end do
   end function choice

   !> Error if a key is not given.
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
      type(error_type), allocatable, intent(out) :: error
      character(:), allocatable :: written
      integer :: i, j, line

      call find_entry(self, group, number, name, i, j)
      line = line_of(self, group, number)
      written = name
      if (j > 0) then
         line = self%groups(i)%entries(j)%line
         call show_entry(self%groups(i)%entries(j), written)
      end if
      call fail(self, line, '&'//group//trim(numbered(self, group, number))//' '//written//': '//why, error)
   end subroutine complain

   !> Number of a group that may be repeated, after a blank; padded with blanks.
   pure function numbered(reader, group, number) result(text)
      class(reader_type), intent(in) :: reader
      character(*), intent(in) :: group
      integer, intent(in) :: number
      character(len=12) :: text

      text = ''
      if (has_word(reader%catalogue%repeated_groups, group)) text = ' '//to_text(number)
   end function numbered

   !> Number of groups of a name.
   pure integer function count_groups(reader, name)
      type(reader_type), intent(in) :: reader
      character(*), intent(in) :: name
      integer :: i

      count_groups = count([(reader%groups(i)%name == name, i=1, size(reader%groups))])
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

   subroutine fail(reader, line, message, error)
      type(reader_type), intent(in) :: reader
      integer, intent(in) :: line
      character(*), intent(in) :: message
      type(error_type), allocatable, intent(out) :: error
      character(:), allocatable :: place

      place = reader%source//':'
      if (line > 0) place = place//to_text(line)//':'
      call set_error(error, MFV_INPUT_ERROR, place//' '//message)
   end subroutine fail

end module mfv_key_reader
