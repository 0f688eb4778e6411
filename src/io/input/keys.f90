!> What a list of keys is made of: kinds, defaults, ranges and meanings of keys, in groups. A reader checks against such a list
!> (mfv_key_reader), and the reference is printed from it.
module mfv_keys
   use mfv_kinds, only: wp
   use mfv_strings, only: add_text, list_of_words, quoted, string_type, to_text
   implicit none
   private
   public :: key_type, catalogue_type, kind_real, kind_integer, kind_logical, kind_text, kind_choice, &
             add_text_key, add_logical_key, add_choice_key, add_integer_key, add_real_key, add_positive_key, &
             list_keys_as_markdown, describe_allowed, is_reasonable, largest_size, reasonable_sizes

   integer, parameter :: kind_real = 1, kind_integer = 2, kind_logical = 3, kind_text = 4, kind_choice = 5

   !> Sizes of reals that are taken, whatever the unit; beyond them squares and products overflow, or vanish.
   real(wp), parameter :: smallest_size = 1.0e-100_wp, largest_size = 1.0e100_wp
   character(*), parameter :: reasonable_sizes = 'a number other than 0 must be of a size from 1e-100 to 1e100'

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
      procedure :: repeats
      procedure :: place
      procedure :: has_group
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

   !> A real without a default, from `lower` (itself allowed unless `lower_open`) to `upper`, each where present.
   subroutine add_real_key(keys, group, name, unit, meaning, lower, lower_open, upper)
      type(key_type), allocatable, intent(inout) :: keys(:)
      character(*), intent(in) :: group, name, unit, meaning
      real(wp), intent(in), optional :: lower, upper
      logical, intent(in), optional :: lower_open

      call add_key(keys, group, name, kind_real, '', unit, meaning)
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
         call move_key(keys(i), longer(i))
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

      select case (key%kind)
      case (kind_choice)
         call join_alternatives(list_of_words(key%choices), text)
      case (kind_logical)
         text = '.true. or .false.'
      case (kind_text)
         text = 'a text between quotes'
      case (kind_integer)
         text = 'a whole number from '//to_text(nint(key%lower))//' to '//to_text(nint(key%upper))
      case default
         text = 'a number'
         call add_range(key, text)
      end select
   end subroutine describe_allowed

   !> Whether a real is of a size that is taken.
   elemental logical function is_reasonable(value)
      real(wp), intent(in) :: value

      is_reasonable = .not. abs(value) > 0.0_wp .or. (abs(value) >= smallest_size .and. abs(value) <= largest_size)
   end function is_reasonable

   !> Append the range of a key to a text.
   subroutine add_range(key, text)
      type(key_type), intent(in) :: key
      character(:), allocatable, intent(inout) :: text

      if (key%lower > -huge(1.0_wp)) &
         text = text//trim(merge(' above   ', ' at least', key%lower_open))//' '//to_text(key%lower)
      if (key%upper < huge(1.0_wp)) text = text//' and at most '//to_text(key%upper)
   end subroutine add_range

   !> 'a', 'b' or 'c'
   subroutine join_alternatives(words, text)
      type(string_type), intent(in) :: words(:)
      character(:), allocatable, intent(out) :: text
      integer :: i

      text = quoted(words(1)%text)
      do i = 2, size(words)
         if (i < size(words)) text = text//', '//quoted(words(i)%text)
         if (i == size(words)) text = text//' or '//quoted(words(i)%text)
      end do
   end subroutine join_alternatives

   subroutine move_key(from, to)
      type(key_type), intent(inout) :: from
      type(key_type), intent(out) :: to

      call move_alloc(from%group, to%group)
      call move_alloc(from%name, to%name)
      call move_alloc(from%default, to%default)
      call move_alloc(from%choices, to%choices)
      call move_alloc(from%unit, to%unit)
      call move_alloc(from%meaning, to%meaning)
      to%kind = from%kind
      to%lower = from%lower
      to%upper = from%upper
      to%lower_open = from%lower_open
      to%is_list = from%is_list
   end subroutine move_key

   !> Names of the groups.
   pure function groups(self)
      class(catalogue_type), intent(in) :: self
      type(string_type), allocatable :: groups(:)

      groups = list_of_words(self%group_list)
   end function groups

   !> Whether a group may come more than once.
   pure logical function repeats(self, group)
      class(catalogue_type), intent(in) :: self
      character(*), intent(in) :: group

      repeats = index(' '//self%repeated_groups//' ', ' '//group//' ') > 0
   end function repeats

   !> Place of a key in the list of keys, 0 for none.
   pure integer function place(self, group, name)
      class(catalogue_type), intent(in) :: self
      character(*), intent(in) :: group, name

      do place = size(self%keys), 1, -1
         if (self%keys(place)%group == group .and. self%keys(place)%name == name) return
      end do
   end function place

   !> Whether there is a group of this name.
   pure logical function has_group(self, group)
      class(catalogue_type), intent(in) :: self
      character(*), intent(in) :: group

      has_group = index(' '//self%group_list//' ', ' '//group//' ') > 0 .and. group /= ''
   end function has_group

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
         if (catalogue%repeats(groups(i)%text)) text = text//' (may come more than once)'
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
