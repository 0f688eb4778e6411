!> Logarithms of ratios near one to full relative accuracy (Fortran has no log1p).
module mfv_logarithms
   use mfv_kinds, only: wp
   implicit none
   private
   public :: log_ratio, log_of_one_less

contains

   !> ln(last/first) of two positive numbers whose difference last - first is known more accurately than by subtraction.
   elemental real(wp) function log_ratio(first, last, difference)
      real(wp), intent(in) :: first, last, difference

      if (abs(difference) < 0.5_wp*(first + last)) then
         log_ratio = 2.0_wp*atanh(difference/(first + last))
      else
         log_ratio = log(last/first)
      end if
   end function log_ratio

   !> ln(1 - x) for 0 <= x < 1.
   elemental real(wp) function log_of_one_less(x)
      real(wp), intent(in) :: x

      log_of_one_less = log_ratio(1.0_wp, 1.0_wp - x, -x)
   end function log_of_one_less

end module mfv_logarithms
