!> Reading one number from a text. Fortran's own reading takes more than anybody means: 1.5+3 for 1500, 1e400 for infinity.
module mfv_numbers
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use, intrinsic :: ieee_exceptions, only: ieee_flag_type, ieee_get_flag, ieee_get_halting_mode, ieee_inexact, ieee_overflow, &
                                            ieee_set_flag, ieee_set_halting_mode, ieee_underflow
   use mfv_kinds, only: wp
   implicit none
   private
   public :: read_real, read_whole

   character(*), parameter :: digits = '0123456789'

contains

   !> A finite number such as 3, -0.5, 1e-3 or 2.5D+3. `is_right`: whether the text is one; `value` is 0 where it is not.
   pure subroutine read_real(text, value, is_right)
      character(*), intent(in) :: text
      real(wp), intent(out) :: value
      logical, intent(out) :: is_right
      type(ieee_flag_type), parameter :: of_reading(3) = [ieee_overflow, ieee_underflow, ieee_inexact]
      logical :: halts(3), flags(3)
      integer :: mark, code

      value = 0.0_wp
      mark = scan(text//'e', 'eEdD')
      is_right = is_decimal(text(:mark - 1))
      if (is_right .and. mark <= len(text)) is_right = is_signed(text(mark + 1:))
      if (.not. is_right) return
      ! 1e400 raises an overflow, which must not end a program that traps it.
      call ieee_get_halting_mode(of_reading, halts)
      call ieee_get_flag(of_reading, flags)
      call ieee_set_halting_mode(of_reading, .false.)
      read (text, *, iostat=code) value
      call ieee_set_flag(of_reading, flags)
      call ieee_set_halting_mode(of_reading, halts)
      is_right = code == 0
      if (is_right) is_right = ieee_is_finite(value)
      if (.not. is_right) value = 0.0_wp
   end subroutine read_real

   !> A whole number that a default integer holds; the rest as above.
   pure subroutine read_whole(text, value, is_right)
      character(*), intent(in) :: text
      integer, intent(out) :: value
      logical, intent(out) :: is_right
      integer :: code

      value = 0
      is_right = is_signed(text)
      if (.not. is_right) return
      read (text, *, iostat=code) value
      is_right = code == 0
      if (.not. is_right) value = 0
   end subroutine read_whole

   !> Digits with a point before, between or after them, or none, and perhaps a sign before them.
   pure logical function is_decimal(text)
      character(*), intent(in) :: text
      integer :: point

      point = index(text//'.', '.')
      is_decimal = scan(text, digits) > 0 .and. verify(text(point + 1:), digits) == 0
      if (is_decimal) is_decimal = is_signed(text(:point - 1)//'0')
   end function is_decimal

   !> Digits, and perhaps a sign before them.
   pure logical function is_signed(text)
      character(*), intent(in) :: text
      integer :: first

      first = 1
      if (scan(text, '+-') == 1) first = 2
      is_signed = len(text) >= first .and. verify(text(min(first, len(text) + 1):), digits) == 0
   end function is_signed

end module mfv_numbers
