!> What a list of keys is made of: kinds, defaults, ranges and meanings of keys, in groups. A reader checks against such a list
!> (mfv_key_reader), and the reference is printed from it.
module mfv_keys
   use mfv_kinds, only: wp
   use mfv_strings, only: add_text, has_word, list_of_words, nearest_name, quoted, string_type, to_text
   implicit none
   private
   public :: key_type, catalogue_type, kind_real, kind_integer, kind_logical, kind_text, kind_choice, &
             add_text_key, add_logical_key, add_choice_key, add_integer_key, add_real_key, add_positive_key, &
             list_keys_as_markdown, describe_allowed, suggest

   integer, parameter :: kind_real = 1, kind_integer = 2, kind_logical = 3, kind_text = 4, kind_choice = 5

   !> One key.
   type :: key_type
      character(:), allocatable :: group, name
      integer :: kind = 0
      !> Default as it would be written; empty: none, the key is left out or needed, as the meaning says.
      character(:), allocatable :: default
      !> Choices, separated by blanks.
      character(:), allocatable :: choices
      !> Allowed range of a number, each end open or closed.
      real(wp) :: lower = -huge(1.0_wp), upper = huge(1.0_wp)
      logical :: lower_open = .false.
      !> Whether there may be several values.
      logical :: is_list = .false.
      character(:), allocatable :: unit, meaning
   end type key_type

   !> All keys of a text, with its groups in the order of the reference and those that may come more than once, separated by
   !> blanks.
   type :: catalogue_type
      character(:), allocatable :: group_list, repeated_groups
      type(key_type), allocatable :: keys(:)
   contains
      procedure :: groups
      procedure :: place
      procedure :: names
   end type catalogue_type

   character(len=1), parameter :: line_feed = achar(10)

contains

   subroutine add_text_key(keys, group, name, default, meaning)
      type(key_type), allocatable, intent(inout) :: keys(:)
      character(*), intent(in) :: group, name, default, meaning

      call add_key(keys, group, name, kind_text, default, '', meaning)
   end subroutine add_text_key

   subroutine add_logical_key(keys, group, name, default, meaning)
      type(key_type), allocatable, intent(inout) :: keys(:)
      character(*), intent(in) :: group, name, default, meaning

      call add_key(keys, group, name, kind_logical, default, '', meaning)
   end subroutine add_logical_key

   subroutine add_choice_key(keys, group, name, default, choices, meaning)
      type(key_type), allocatable, intent(inout) :: keys(:)
      character(*), intent(in) :: group, name, default, choices, meaning

      call add_key(keys, group, name, kind_choice, default, '', meaning)
      keys(size(keys))%choices = choices
   end subroutine add_choice_key

   !> A whole number from `lower` to `upper`.
   subroutine add_integer_key(keys, group, name, default, meaning, lower, upper)
      type(key_type), allocatable, intent(inout) :: keys(:)
      character(*), intent(in) :: group, name, default, meaning
      real(wp), intent(in) :: lower, upper

      call add_key(keys, group, name, kind_integer, default, '', meaning)
      keys(size(keys))%lower = lower
      keys(size(keys))%upper = upper
   end subroutine add_integer_key

   !> A real from `lower` (itself allowed unless `lower_open`) to `upper`, and with a default, each where present.
   subroutine add_real_key(keys, group, name, unit, meaning, lower, lower_open, upper, default)
      type(key_type), allocatable, intent(inout) :: keys(:)
      character(*), intent(in) :: group, name, unit, meaning
      real(wp), intent(in), optional :: lower, upper
      logical, intent(in), optional :: lower_open
      character(*), intent(in), optional :: default

      call add_key(keys, group, name, kind_real, '', unit, meaning)
      if (present(default)) keys(size(keys))%default = default
      if (present(lower)) keys(size(keys))%lower = lower
      if (present(lower_open)) keys(size(keys))%lower_open = lower_open
      if (present(upper)) keys(size(keys))%upper = upper
   end subroutine add_real_key

   subroutine add_positive_key(keys, group, name, unit, meaning)
      type(key_type), allocatable, intent(inout) :: keys(:)
      character(*), intent(in) :: group, name, unit, meaning

      call add_real_key(keys, group, name, unit, meaning, lower=0.0_wp, lower_open=.true.)
   end subroutine add_positive_key

   !> Append a key. By move_alloc: a list of keys is made for every case that is read, and gfortran leaks the components of
   !> arrays that a constructor joins.
   subroutine add_key(keys, group, name, kind, default, unit, meaning)
      type(key_type), allocatable, intent(inout) :: keys(:)
      character(*), intent(in) :: group, name, default, unit, meaning
      integer, intent(in) :: kind
      type(key_type), allocatable :: longer(:)
      integer :: i, n

      n = size(keys)
      allocate (longer(n + 1))
      do i = 1, n
         call move_alloc(keys(i)%group, longer(i)%group)
         call move_alloc(keys(i)%name, longer(i)%name)
         call move_alloc(keys(i)%default, longer(i)%default)
         call move_alloc(keys(i)%choices, longer(i)%choices)
         call move_alloc(keys(i)%unit, longer(i)%unit)
         call move_alloc(keys(i)%meaning, longer(i)%meaning)
         longer(i)%kind = keys(i)%kind
         longer(i)%lower = keys(i)%lower
         longer(i)%upper = keys(i)%upper
         longer(i)%lower_open = keys(i)%lower_open
         longer(i)%is_list = keys(i)%is_list
      end do
      longer(n + 1)%group = group
      longer(n + 1)%name = name
      longer(n + 1)%kind = kind
      longer(n + 1)%default = default
      longer(n + 1)%choices = ''
      longer(n + 1)%unit = unit
      longer(n + 1)%meaning = meaning
      call move_alloc(longer, keys)
   end subroutine add_key

   !> What values a key takes, in words, for messages and the reference.
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

   !> '; did you mean ...?' where a known name is near, else empty.
   pure subroutine suggest(name, names, prefix, text)
      character(*), intent(in) :: name, prefix
      type(string_type), intent(in) :: names(:)
      character(:), allocatable, intent(out) :: text

      text = nearest_name(name, names)
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

      do place = size(self%keys), 1, -1
         if (self%keys(place)%group == group .and. self%keys(place)%name == name) return
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
         if (has_word(catalogue%repeated_groups, groups(i)%text)) text = text//' (may come more than once)'
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
      default = '-'
      if (key%default /= '') default = '`'//key%default//'`'
      if (key%default /= '' .and. any(key%kind == [kind_text, kind_choice])) default = '`'//quoted(key%default)//'`'
      text = text//'| `'//key%name//'` | '//allowed//' | '//default//' | '//key%unit//' | '//key%meaning//' |'//line_feed
   end subroutine add_row

end module mfv_keys
