!> The wall clock.
module mfv_clock
   use, intrinsic :: iso_fortran_env, only: int64
   use mfv_kinds, only: wp
   implicit none
   private
   public :: seconds_now

contains

   !> Wall-clock time in seconds, with an arbitrary origin.
   real(wp) function seconds_now()
      integer(int64) :: count, rate

      call system_clock(count, rate)
      seconds_now = real(count, wp)/real(rate, wp)
   end function seconds_now

end module mfv_clock
