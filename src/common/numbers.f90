!> Real numbers as text: reading, writing, and the accepted range.
module mfv_numbers
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use, intrinsic :: iso_fortran_env, only: int64
   use, intrinsic :: ieee_exceptions, only: ieee_flag_type, ieee_get_flag, ieee_get_halting_mode, ieee_inexact, ieee_overflow, &
                                                                               ieee_set_flag, ieee_set_halting_mode, ieee_underflow
   use mfv_kinds, only: wp
   use mfv_strings, only: to_text
   implicit none
   private
   public :: read_real, write_real, is_reasonable, largest_size, reasonable_sizes

   !> Accepted magnitudes, in any unit; outside, squares and products overflow or underflow.
   real(wp), parameter :: smallest_size = 1.0e-100_wp, largest_size = 1.0e100_wp
   !> Before an exponent.
   character(*), parameter :: letters = 'eEdD'
   character(*), parameter :: reasonable_sizes = 'numbers other than 0 must have a magnitude from 1e-100 to 1e100'

contains

   !> Read a finite number such as 3, -0.5, 1e-3 or 2.5D+3. `is_right`: whether the text is one; otherwise `value` is 0.
   pure subroutine read_real(text, value, is_right)
      character(*), intent(in) :: text
      real(wp), intent(out) :: value
      logical, intent(out) :: is_right
      type(ieee_flag_type), parameter :: of_reading(3) = [ieee_overflow, ieee_underflow, ieee_inexact]
      logical :: halts(3), flags(3), is_extreme
      integer :: code

      call read_short(text, value, is_right)
      if (is_right) return
      is_right = is_plain(text)
      if (.not. is_right) return
      ! 1e400 raises an overflow, which must not end a program that traps it; setting modes takes longer than reading.
      is_extreme = scan(text, letters) > 0 .or. len(text) > maxexponent(value)/4
      if (is_extreme) then
         call ieee_get_halting_mode(of_reading, halts)
         call ieee_get_flag(of_reading, flags)
         call ieee_set_halting_mode(of_reading, .false.)
      end if
      read (text, *, iostat=code) value
      if (is_extreme) then
         call ieee_set_flag(of_reading, flags)
         call ieee_set_halting_mode(of_reading, halts)
      end if
      is_right = code == 0
      if (is_right) is_right = ieee_is_finite(value)
      if (.not. is_right) value = 0.0_wp
   end subroutine read_real

   !> Read a short number without an exponent, such as -0.5: its digits and the power of ten by which they are divided are exact, so
   !> that the quotient is rounded as by Fortran's own input, which takes much longer. `is_short`: whether the text is one.
   pure subroutine read_short(text, value, is_short)
      character(*), intent(in) :: text
      real(wp), intent(out) :: value
      logical, intent(out) :: is_short
      integer, parameter :: longest = 18
      integer(int64), parameter :: largest = 2_int64**digits(value)
      integer(int64) :: whole
      integer :: first, i, point

      value = 0.0_wp
      is_short = .false.
      if (len(text) == 0 .or. len(text) > longest) return
      first = merge(2, 1, scan(text(1:1), '+-') == 1)
      whole = 0
      point = 0
      do i = first, len(text)
         if (text(i:i) == '.' .and. point == 0) then
            point = i
         else if (text(i:i) >= '0' .and. text(i:i) <= '9') then
            whole = 10*whole + iachar(text(i:i)) - iachar('0')
         else
            return
         end if
      end do
      is_short = len(text) - first >= merge(1, 0, point > 0) .and. whole <= largest
      if (is_short) value = whole/10.0_wp**merge(len(text) - point, 0, point > 0)
      if (is_short .and. text(1:1) == '-') value = -value
   end subroutine read_short

   !> Whether a text consists of the characters of a number, with signs only first and after the exponent letter. Fortran's
   !> own input also accepts 2*3 (two numbers) and 1.5+3 (1500).
   pure logical function is_plain(text)
      character(*), intent(in) :: text
      integer :: i

      is_plain = verify(text, '0123456789.+-'//letters) == 0
      do i = 2, len(text)
         if (text(i:i) == '+' .or. text(i:i) == '-') is_plain = is_plain .and. scan(text(i - 1:i - 1), letters) > 0
      end do
   end function is_plain

   !> Shortest text that is read as this finite number, without trailing zeros; of 15 digits where these suffice.
   pure subroutine write_real(value, text)
      real(wp), intent(in) :: value
      character(:), allocatable, intent(out) :: text
      integer, parameter :: enough = 17
      real(wp) :: again
      logical :: is_right
      integer :: digits

      do digits = precision(value), enough
         text = to_text(value, digits)
         call read_real(text, again, is_right)
         if (is_right .and. .not. abs(again - value) > 0.0_wp) return
      end do
   end subroutine write_real

   !> Whether a real number is within the accepted range.
   elemental logical function is_reasonable(value)
      real(wp), intent(in) :: value

      is_reasonable = .not. abs(value) > 0.0_wp .or. (abs(value) >= smallest_size .and. abs(value) <= largest_size)
   end function is_reasonable

end module mfv_numbers
