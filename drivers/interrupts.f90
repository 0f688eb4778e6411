!> Ctrl-C and termination requests: a flag that ends the run at its next increment.
module mfv_interrupts
   use, intrinsic :: iso_c_binding, only: c_funloc, c_funptr, c_int
   implicit none
   private
   public :: catch_interrupts, is_interrupted

   !> Set by the signal handler.
   logical, volatile :: interrupted = .false.

   integer(c_int), parameter :: signal_interrupt = 2, signal_terminate = 15

   interface
      function c_signal(number, handler) bind(C, name='signal') result(previous)
         import :: c_funptr, c_int
         integer(c_int), value :: number
         type(c_funptr), value :: handler
         type(c_funptr) :: previous
      end function c_signal
   end interface

contains

   !> Have Ctrl-C and termination requests end the run at its next increment, with its result written.
   subroutine catch_interrupts()
      type(c_funptr) :: previous

      previous = c_signal(signal_interrupt, c_funloc(handle_signal))
      previous = c_signal(signal_terminate, c_funloc(handle_signal))
   end subroutine catch_interrupts

   !> Whether the program has been asked to end.
   logical function is_interrupted()
      is_interrupted = interrupted
   end function is_interrupted

   subroutine handle_signal(number) bind(C)
      integer(c_int), value :: number

      interrupted = interrupted .or. number > 0
   end subroutine handle_signal

end module mfv_interrupts
