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

   !> Sleep for 0.1 ms, and twice as long for every rest that came before this one in a row, up to 3.2 ms: looking for messages
   !> takes time from the thread that solves on the same processor. `rests`: in a row so far; 0 where there was something to do.
   subroutine pause_briefly(rests)
      integer, intent(inout) :: rests
      integer(c_int), parameter :: shortest = 100
      integer, parameter :: most_doublings = 5
      integer(c_int) :: code

      code = c_usleep(shortest*2_c_int**min(rests, most_doublings))
      rests = min(rests, most_doublings) + 1
   end subroutine pause_briefly

end module mfv_pause
