!> Catalogues of keys: kinds, defaults, ranges and meanings of keys, in groups. A reader checks against a catalogue
!> (mfv_key_reader), and the reference is printed from it. Names of keys with their groups: `friction%mu`, `body(2)%radius`.
module mfv_keys
   use mfv_kinds, only: wp
   use mfv_strings, only: add_text, find_nearest_name, has_word, line_feed, list_of_words, lower_case, quoted, string_type, &
                          to_text
   implicit none
   private
   public :: key_type, catalogue_type, kind_real, kind_integer, kind_logical, kind_text, kind_choice, &
             most_keys, list_keys_as_markdown, describe_allowed, suggest, read_key_name

   integer, parameter :: kind_real = 1, kind_integer = 2, kind_logical = 3, kind_text = 4, kind_choice = 5

   !> One key.
   type :: key_type
      character(:), allocatable :: group, name
      integer :: kind = 0
      !> Default as it would be written; empty: none, the key is optional or needed, as the meaning says.
      character(:), allocatable :: default
      !> Choices, separated by blanks.
      character(:), allocatable :: choices
      !> Allowed range of a number, each end open or closed.
      real(wp) :: lower = -huge(1.0_wp), upper = huge(1.0_wp)
      logical :: lower_open = .false.
      !> Whether there may be several values.
      logical :: is_list = .false.
      character(:), allocatable :: unit, meaning
   contains
      procedure :: names_file
   end type key_type

   !> All keys of a text; groups in the order of the reference, and those that may be repeated, separated by blanks.
   type :: catalogue_type
      character(:), allocatable :: group_list, repeated_groups
      type(key_type), allocatable :: keys(:)
      !> Keys that have been added.
      integer :: size = 0
   contains
      procedure :: add => add_key
      procedure :: groups
      procedure :: place
      procedure :: names
   end type catalogue_type

   !> Room for keys while they are added.
   integer, parameter :: most_keys = 128

contains

   !> Append a key to a list with room for it. `above`, `lower`, `upper`: range of a number, for which the first is an open end.
   subroutine add_key(self, group, name, kind, meaning, default, unit, choices, above, lower, upper)
      class(catalogue_type), intent(inout) :: self
      character(*), intent(in) :: group, name, meaning
      integer, intent(in) :: kind
      character(*), intent(in), optional :: default, unit, choices
      real(wp), intent(in), optional :: above, lower, upper

      self%size = self%size + 1
      associate (key => self%keys(self%size))
         key%group = group
         key%name = trim(name)
         key%kind = kind
         key%meaning = meaning
         key%default = ''
         key%unit = ''
         key%choices = ''
         if (present(default)) key%default = default
         if (present(unit)) key%unit = unit
         if (present(choices)) key%choices = choices
         if (present(lower)) key%lower = lower
         if (present(above)) key%lower = above
         key%lower_open = present(above)
         if (present(upper)) key%upper = upper
      end associate
   end subroutine add_key

   !> The allowed values of a key, for messages and the reference.
   subroutine describe_allowed(key, text)
      type(key_type), intent(in) :: key
      character(:), allocatable, intent(out) :: text
      type(string_type), allocatable :: words(:)
      integer :: i

      select case (key%kind)
      case (kind_choice)
         words = list_of_words(key%choices)
         text = quoted(words(1)%text)
         do i = 2, size(words)
            text = text//trim(merge(' or', ',  ', i == size(words)))//' '//quoted(words(i)%text)
         end do
      case (kind_logical)
         text = '.true. or .false.'
      case (kind_text)
         text = 'a text between quotes'
      case (kind_integer)
         text = 'a whole number from '//to_text(nint(key%lower))//' to '//to_text(nint(key%upper))
      case default
         text = 'a number'
         if (key%lower > -huge(1.0_wp)) &
            text = text//trim(merge(' above   ', ' at least', key%lower_open))//' '//to_text(key%lower)
         if (key%upper < huge(1.0_wp)) text = text//' and at most '//to_text(key%upper)
      end select
   end subroutine describe_allowed

   !> Whether the value is the name of a file, which is not empty.
   pure logical function names_file(self)
      class(key_type), intent(in) :: self

      names_file = self%kind == kind_text .and. index(self%name, 'file', back=.true.) == len(self%name) - len('file') + 1
   end function names_file

   !> '; did you mean ...?' where a known name is near, else empty.
   pure subroutine suggest(name, names, prefix, text)
      character(*), intent(in) :: name, prefix
      type(string_type), intent(in) :: names(:)
      character(:), allocatable, intent(out) :: text

      call find_nearest_name(name, names, text)
      if (text /= '') text = '; did you mean '//prefix//text//'?'
   end subroutine suggest

   !> Names of the groups.
   pure function groups(self)
      class(catalogue_type), intent(in) :: self
      type(string_type), allocatable :: groups(:)

      groups = list_of_words(self%group_list)
   end function groups

   !> Place of a key in the list of keys, 0 for none.
   pure integer function place(self, group, name)
      class(catalogue_type), intent(in) :: self
      character(*), intent(in) :: group, name
      integer :: length

      length = len_trim(name)
      do place = size(self%keys), 1, -1
         if (len(self%keys(place)%name) /= length) cycle
         if (self%keys(place)%name /= name) cycle
         if (self%keys(place)%group == group) return
      end do
   end function place

   !> Names of the keys of a group.
   pure function names(self, group)
      class(catalogue_type), intent(in) :: self
      character(*), intent(in) :: group
      type(string_type), allocatable :: names(:)
      integer :: i

      allocate (names(0))
      do i = 1, size(self%keys)
         if (self%keys(i)%group == group) call add_text(names, self%keys(i)%name)
      end do
   end function names

   !> The reference of all keys as Markdown tables.
   subroutine list_keys_as_markdown(catalogue, text)
      type(catalogue_type), intent(in) :: catalogue
      character(:), allocatable, intent(out) :: text
      type(string_type), allocatable :: groups(:)
      integer :: i, j

      groups = catalogue%groups()
      text = ''
      do i = 1, size(groups)
         text = text//'### &'//groups(i)%text
         if (has_word(catalogue%repeated_groups, groups(i)%text)) text = text//' (may be repeated)'
         text = text//line_feed//line_feed//'| key | value | default | unit | meaning |'//line_feed// &
                '| --- | --- | --- | --- | --- |'//line_feed
         do j = 1, size(catalogue%keys)
            if (catalogue%keys(j)%group == groups(i)%text) call add_row(catalogue%keys(j), text)
         end do
         if (i < size(groups)) text = text//line_feed
      end do
   end subroutine list_keys_as_markdown

   !> Append the row of a key to a Markdown table.
   subroutine add_row(key, text)
      type(key_type), intent(in) :: key
      character(:), allocatable, intent(inout) :: text
      character(:), allocatable :: allowed, default

      call describe_allowed(key, allowed)
      if (key%is_list) allowed = allowed//', or a list'
      default = '-'
      if (key%default /= '') default = '`'//key%default//'`'
      if (key%default /= '' .and. any(key%kind == [kind_text, kind_choice])) default = '`'//quoted(key%default)//'`'
      text = text//'| `'//key%name//'` | '//allowed//' | '//default//' | '//key%unit//' | '//key%meaning//' |'//line_feed
   end subroutine add_row

   !> Group, number of the group (1 by default) and key of a name, in lower case. `why`: what is wrong with it, such as an unknown
   !> key; empty if it is valid. The caller checks whether a group of this number exists.
   subroutine read_key_name(written, catalogue, group, number, key, why)
      character(*), intent(in) :: written
      type(catalogue_type), intent(in) :: catalogue
      character(:), allocatable, intent(out) :: group, key, why
      integer, intent(out) :: number
      character(:), allocatable :: text
      integer :: percent, bracket
      logical :: repeats

      why = ''
      text = lower_case(written)
      percent = index(text, '%')
      bracket = index(text(:max(percent - 1, 0))//'(', '(')
      group = text(:bracket - 1)
      key = text(percent + 1:)
      repeats = has_word(catalogue%repeated_groups, group)
      number = 1
      if (bracket < percent) number = number_in(text(bracket:percent - 1))
      if (percent == 0) then
         why = "must be 'group%key', 'group(number)%key'"
      else if (number < 0) then
         why = quoted(text(bracket:percent - 1))//' is not a group number, such as (2)'
      else if (.not. has_word(catalogue%group_list, group)) then
         call suggest(group, catalogue%groups(), '', why)
         why = 'unknown group'//why//'; groups are '//catalogue%group_list
      else if (catalogue%place(group, key) == 0) then
         call suggest(key, catalogue%names(group), '', why)
         why = 'unknown key of &'//group//why
      else if (repeats .and. bracket == percent) then
         why = 'which &'//group//'? write '//group//'(1)%'//key
      else if (.not. repeats .and. number /= 1) then
         why = 'there is only one &'//group
      end if
      if (why /= '') why = quoted(written)//': '//why
   end subroutine read_key_name

   !> The number in a pair of brackets, -1 where there is none.
   pure integer function number_in(text)
      character(*), intent(in) :: text
      integer, parameter :: longest = 11
      integer :: last

      number_in = -1
      last = len(text)
      if (last < 3 .or. last > longest) return
      if (text(last:) == ')' .and. verify(text(2:last - 1), '0123456789') == 0) read (text(2:last - 1), *) number_in
   end function number_in

end module mfv_keys
