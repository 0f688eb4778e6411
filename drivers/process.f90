!> The process of a program, see process.c.
module mfv_process
   use, intrinsic :: iso_c_binding, only: c_int
   implicit none
   private
   public :: begin_streams, use_one_thread, catch_interrupts, is_interrupted

   interface
      subroutine begin_streams() bind(C, name='mfv_begin_streams')
      end subroutine begin_streams

      subroutine use_one_thread() bind(C, name='mfv_use_one_thread')
      end subroutine use_one_thread

      subroutine catch_interrupts() bind(C, name='mfv_catch_interrupts')
      end subroutine catch_interrupts

      integer(c_int) function is_interrupted() bind(C, name='mfv_is_interrupted')
         import :: c_int
      end function is_interrupted
   end interface

end module mfv_process
