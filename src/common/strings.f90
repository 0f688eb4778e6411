!> Text utilities: numbers as text, lower case, C strings, nearest known name.
!>
!> A function in this library specifies the length of its text by a specification function; other texts come from subroutines:
!> gfortran stores the length of a deferred-length function result in static memory, which is not thread-safe.
module mfv_strings
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
   use, intrinsic :: iso_c_binding, only: c_char, c_null_char
   use mfv_kinds, only: wp
   implicit none
   private
   public :: string_type, to_text, lower_case, find_nearest_name, from_c, copy_to_c, quoted, shortened, add_text, &
             list_of_words, word_of, has_word, line_feed, carriage_return, tab, decimal_digits

   !> A text of any length, for arrays of texts.
   type :: string_type
      character(:), allocatable :: text
   end type string_type

   !> Shortest readable text of an integer or real number.
   interface to_text
      module procedure integer_to_text
      module procedure real_to_text
      module procedure real_to_text_digits
   end interface to_text

   character(*), parameter :: line_feed = achar(10), carriage_return = achar(13), tab = achar(9), decimal_digits = '0123456789'
   !> Default number of significant digits.
   integer, parameter :: usual_digits = 6
   !> Length that any number fits.
   integer, parameter :: longest_number = 48
   !> Longest text, bytes, that is quoted in a message.
   integer, parameter :: longest_shown = 80
   character(*), parameter :: cut_mark = '...'

contains

   !> An integer.
   pure function integer_to_text(value) result(text)
      integer, intent(in) :: value
      character(len=len_trim(padded_integer(value))) :: text

      text = padded_integer(value)
   end function integer_to_text

   !> An integer, padded with blanks.
   pure function padded_integer(value) result(text)
      integer, intent(in) :: value
      character(len=longest_number) :: text

      write (text, '(i0)') value
   end function padded_integer

   !> A real number with up to `usual_digits` significant digits.
   pure function real_to_text(value) result(text)
      real(wp), intent(in) :: value
      character(len=len_trim(padded_real(value, usual_digits))) :: text

      text = padded_real(value, usual_digits)
   end function real_to_text

   !> A real number with up to `digits` significant digits.
   pure function real_to_text_digits(value, digits) result(text)
      real(wp), intent(in) :: value
      integer, intent(in) :: digits
      character(len=len_trim(padded_real(value, digits))) :: text

      text = padded_real(value, digits)
   end function real_to_text_digits

   !> A real number with up to `digits` significant digits, without trailing zeros; padded with blanks.
   pure function padded_real(value, digits) result(text)
      real(wp), intent(in) :: value
      integer, intent(in) :: digits
      character(len=longest_number) :: text

      if (ieee_is_nan(value)) then
         text = 'NaN'
      else if (abs(value) <= 0.0_wp) then
         text = '0'
      else if (abs(value) >= 1.0e-3_wp .and. abs(value) < 10.0_wp**min(digits, 6)) then
         text = without_exponent(value, digits)
      else
         text = with_exponent(value, digits)
      end if
   end function padded_real

   !> A real number in the form 0.25 or -100; padded with blanks.
   pure function without_exponent(value, digits) result(text)
      real(wp), intent(in) :: value
      integer, intent(in) :: digits
      character(len=longest_number) :: text
      character(len=16) :: edit

      write (edit, '(a,i0,a)') '(f0.', decimals_for(value, digits), ')'
      write (text, edit) value
      call cut_trailing_zeros(text)
      if (text(1:1) == '.') text = '0'//text(:longest_number - 1)
      if (text(1:2) == '-.') text = '-0'//text(2:longest_number - 1)
   end function without_exponent

   !> A real number in the form 2.8e-4 or 1e6; NaN and Infinity; padded with blanks.
   pure function with_exponent(value, digits) result(text)
      real(wp), intent(in) :: value
      integer, intent(in) :: digits
      character(len=longest_number) :: text, mantissa
      character(len=16) :: edit
      integer :: mark, exponent

      write (edit, '(a,i0,a)') '(es32.', max(digits - 1, 0), 'e3)'
      write (text, edit) value
      text = adjustl(text)
      mark = index(text, 'E')
      if (mark == 0) return
      mantissa = text(:mark - 1)
      call cut_trailing_zeros(mantissa)
      read (text(mark + 1:), '(i8)') exponent
      write (text, '(2a,i0)') trim(mantissa), 'e', exponent
   end function with_exponent

   !> Decimals for `digits` significant digits of a value of moderate magnitude.
   pure integer function decimals_for(value, digits) result(decimals)
      real(wp), intent(in) :: value
      integer, intent(in) :: digits

      decimals = 1
      if (abs(value) > 0.0_wp) decimals = max(digits - 1 - floor(log10(abs(value))), 0)
   end function decimals_for

   !> Remove trailing zeros: '2.500' to '2.5', '3.' to '3', '.0' to '0'.
   pure subroutine cut_trailing_zeros(number)
      character(*), intent(inout) :: number
      integer :: last

      if (index(number, '.') > 0) then
         last = verify(number, '0 ', back=.true.)
         if (number(last:last) == '.') last = last - 1
         number(last + 1:) = ''
      end if
      if (number == '' .or. number == '-') number = '0'
   end subroutine cut_trailing_zeros

   !> `text` in lower case.
   pure function lower_case(text) result(lower)
      character(*), intent(in) :: text
      character(len=len(text)) :: lower
      integer :: i

      lower = text
      do i = 1, len(text)
         if (text(i:i) >= 'A' .and. text(i:i) <= 'Z') lower(i:i) = achar(iachar(text(i:i)) + 32)
      end do
   end function lower_case

   !> Append `text` to a list of texts. By move_alloc: gfortran leaks the components of concatenated arrays.
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

   !> Word `number` of a list of words; padded with blanks.
   pure function word_of(words, number) result(text)
      character(*), intent(in) :: words
      integer, intent(in) :: number
      character(len=len(words)) :: text
      type(string_type), allocatable :: list(:)

      list = list_of_words(words)
      text = list(number)%text
   end function word_of

   !> Whether a word is in a list of words separated by blanks.
   pure logical function has_word(words, word)
      character(*), intent(in) :: words, word

      has_word = word /= '' .and. index(trim(word), ' ') == 0 .and. index(' '//words//' ', ' '//trim(word)//' ') > 0
   end function has_word

   !> `text` in single quotation marks.
   pure function quoted(text) result(with_quotes)
      character(*), intent(in) :: text
      character(len=len(text) + 2) :: with_quotes

      with_quotes = "'"//text//"'"
   end function quoted

   !> `text` for a message: truncated if long, between two UTF-8 characters.
   pure function shortened(text) result(short)
      character(*), intent(in) :: text
      character(len=length_of_shortened(text)) :: short

      short = text
      if (len(short) < len(text)) short(len(short) - len(cut_mark) + 1:) = cut_mark
   end function shortened

   pure integer function length_of_shortened(text) result(length)
      character(*), intent(in) :: text
      integer, parameter :: first_continuation = 128, first_lead = 192
      integer :: code

      length = len(text)
      if (length <= longest_shown + len(cut_mark)) return
      length = longest_shown
      do while (length > 1)
         code = ichar(text(length + 1:length + 1))
         if (code < first_continuation .or. code >= first_lead) exit
         length = length - 1
      end do
      length = length + len(cut_mark)
   end function length_of_shortened

   !> The entry of `names` with the fewest letter changes (Levenshtein) from `name`; empty without a similar one.
   pure subroutine find_nearest_name(name, names, nearest)
      character(*), intent(in) :: name
      type(string_type), intent(in) :: names(:)
      character(:), allocatable, intent(out) :: nearest
      integer :: i, distance, best

      nearest = ''
      best = max(len(name)/2, 2) + 1
      do i = 1, size(names)
         distance = edit_distance(name, names(i)%text)
         if (distance >= best) cycle
         best = distance
         nearest = names(i)%text
      end do
   end subroutine find_nearest_name

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
      character(len=length_of_c(c_text)) :: text
      integer :: i

      do i = 1, len(text)
         text(i:i) = c_text(i)
      end do
   end function from_c

   !> Number of characters before the null.
   pure integer function length_of_c(c_text) result(length)
      character(kind=c_char), intent(in) :: c_text(*)

      length = 0
      do while (c_text(length + 1) /= c_null_char)
         length = length + 1
      end do
   end function length_of_c

   !> Copy `text` into a C buffer of `capacity` characters, truncated if necessary, always null-terminated.
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
