!> A short rest for a thread that looks again and again.
module mfv_pause
   use, intrinsic :: iso_c_binding, only: c_int
   implicit none
   private
   public :: pause_briefly

   interface
      function c_usleep(microseconds) bind(C, name='usleep') result(code)
         import :: c_int
         integer(c_int), value :: microseconds
         integer(c_int) :: code
      end function c_usleep
   end interface

contains

   !> Sleep for 0.2 ms: little of a case, and little work to look that often.
   subroutine pause_briefly()
      integer(c_int), parameter :: microseconds = 200
      integer(c_int) :: code

      code = c_usleep(microseconds)
   end subroutine pause_briefly

end module mfv_pause
