!> Small text helpers: numbers to text, lower case, C strings, the nearest known name.
module mfv_strings
   use, intrinsic :: iso_c_binding, only: c_char, c_null_char
   use mfv_kinds, only: wp
   implicit none
   private
   public :: string_type, to_text, lower_case, nearest_name, from_c, copy_to_c, quoted, add_text, list_of_words

   !> A text of any length, for arrays of texts.
   type :: string_type
      character(:), allocatable :: text
   end type string_type

   !> Shortest readable text of an integer or a real.
   interface to_text
      module procedure integer_to_text
      module procedure real_to_text
   end interface to_text

contains

   pure function integer_to_text(value) result(text)
      integer, intent(in) :: value
      character(:), allocatable :: text
      character(len=24) :: buffer

      write (buffer, '(i0)') value
      text = trim(buffer)
   end function integer_to_text

   !> A real with up to `digits` significant digits (6 unless told), without trailing zeros.
   pure function real_to_text(value, digits) result(text)
      real(wp), intent(in) :: value
      integer, intent(in), optional :: digits
      character(:), allocatable :: text
      character(len=48) :: buffer
      character(len=16) :: edit
      integer :: significant, exponent_at, last

      significant = 6
      if (present(digits)) significant = digits
      if (abs(value) >= 1.0e-3_wp .and. abs(value) < 10.0_wp**min(significant, 6) .or. .not. abs(value) > 0.0_wp) then
         write (edit, '(a,i0,a)') '(f0.', decimals_for(value, significant), ')'
         write (buffer, edit) value
         text = without_trailing_zeros(trim(adjustl(buffer)))
         if (text(1:1) == '.') text = '0'//text
         if (len(text) > 1) then
            if (text(1:2) == '-.') text = '-0'//text(2:)
         end if
      else
         write (edit, '(a,i0,a)') '(es32.', max(significant - 1, 0), 'e3)'
         write (buffer, edit) value
         buffer = adjustl(buffer)
         exponent_at = index(buffer, 'E')
         if (exponent_at == 0) then
            text = trim(buffer)   ! NaN, Infinity
         else
            last = len_trim(buffer)
            text = without_trailing_zeros(buffer(:exponent_at - 1))//'e'//short_exponent(buffer(exponent_at + 1:last))
         end if
      end if
   end function real_to_text

   !> Decimals that leave `significant` digits of a value of moderate size.
   pure integer function decimals_for(value, significant) result(decimals)
      real(wp), intent(in) :: value
      integer, intent(in) :: significant

      decimals = 1
      if (abs(value) > 0.0_wp) decimals = max(significant - 1 - floor(log10(abs(value))), 0)
   end function decimals_for

   pure function without_trailing_zeros(text) result(short)
      character(*), intent(in) :: text
      character(:), allocatable :: short
      integer :: last

      last = len(text)
      if (index(text, '.') > 0) then
         last = verify(text, '0', back=.true.)
         if (text(last:last) == '.') last = last - 1
      end if
      short = text(:last)
      if (short == '' .or. short == '-') short = '0'
   end function without_trailing_zeros

   !> '+003' to '3', '-012' to '-12'.
   pure function short_exponent(text) result(short)
      character(*), intent(in) :: text
      character(:), allocatable :: short
      integer :: first

      first = verify(text(2:), '0')
      if (first == 0) then
         short = '0'
      else
         short = text(first + 1:)
      end if
      if (text(1:1) == '-') short = '-'//short
   end function short_exponent

   !> `text` with A-Z turned into a-z.
   pure function lower_case(text) result(lower)
      character(*), intent(in) :: text
      character(len=len(text)) :: lower
      integer :: i

      lower = text
      do i = 1, len(text)
         if (text(i:i) >= 'A' .and. text(i:i) <= 'Z') lower(i:i) = achar(iachar(text(i:i)) + 32)
      end do
   end function lower_case

   !> Append `text` to a list of texts. By move_alloc: gfortran leaks the components of arrays that a constructor joins.
   pure subroutine add_text(texts, text)
      type(string_type), allocatable, intent(inout) :: texts(:)
      character(*), intent(in) :: text
      type(string_type), allocatable :: longer(:)
      integer :: i, n

      n = 0
      if (allocated(texts)) n = size(texts)
      allocate (longer(n + 1))
      do i = 1, n
         call move_alloc(texts(i)%text, longer(i)%text)
      end do
      longer(n + 1)%text = text
      call move_alloc(longer, texts)
   end subroutine add_text

   !> The words of a text separated by blanks.
   pure function list_of_words(text) result(words)
      character(*), intent(in) :: text
      type(string_type), allocatable :: words(:)
      integer :: first, length

      allocate (words(0))
      first = 1
      do while (first <= len(text))
         length = index(text(first:)//' ', ' ') - 1
         if (length > 0) call add_text(words, text(first:first + length - 1))
         first = first + length + 1
      end do
   end function list_of_words

   !> `text` between apostrophes.
   pure function quoted(text) result(with_quotes)
      character(*), intent(in) :: text
      character(:), allocatable :: with_quotes

      with_quotes = "'"//text//"'"
   end function quoted

   !> The entry of `names` that is fewest letter changes (Levenshtein) away from `name`; empty when none is near.
   pure function nearest_name(name, names) result(nearest)
      character(*), intent(in) :: name
      type(string_type), intent(in) :: names(:)
      character(:), allocatable :: nearest
      integer :: i, distance, best

      nearest = ''
      best = max(len(name)/2, 2) + 1
      do i = 1, size(names)
         distance = edit_distance(name, names(i)%text)
         if (distance < best) then
            best = distance
            nearest = names(i)%text
         end if
      end do
   end function nearest_name

   pure integer function edit_distance(a, b) result(distance)
      character(*), intent(in) :: a, b
      integer :: row(0:len(b)), diagonal, above, i, j

      row = [(j, j=0, len(b))]
      do i = 1, len(a)
         diagonal = row(0)
         row(0) = i
         do j = 1, len(b)
            above = row(j)
            row(j) = min(row(j) + 1, row(j - 1) + 1, diagonal + merge(0, 1, a(i:i) == b(j:j)))
            diagonal = above
         end do
      end do
      distance = row(len(b))
   end function edit_distance

   !> Fortran text of a null-terminated C string.
   pure function from_c(c_text) result(text)
      character(kind=c_char), intent(in) :: c_text(*)
      character(:), allocatable :: text
      integer :: i, length

      length = 0
      do while (c_text(length + 1) /= c_null_char)
         length = length + 1
      end do
      allocate (character(len=length) :: text)
      do i = 1, length
         text(i:i) = c_text(i)
      end do
   end function from_c

   !> Copy `text` into a C buffer of `capacity` characters, cut where it does not fit, always null-terminated.
   pure subroutine copy_to_c(text, buffer, capacity)
      character(*), intent(in) :: text
      integer, intent(in) :: capacity
      character(kind=c_char), intent(inout) :: buffer(capacity)
      integer :: i, length

      if (capacity < 1) return
      length = min(len(text), capacity - 1)
      do i = 1, length
         buffer(i) = text(i:i)
      end do
      buffer(length + 1) = c_null_char
   end subroutine copy_to_c

end module mfv_strings
