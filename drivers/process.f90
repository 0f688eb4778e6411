!> The process of a program, see process.c.
module mfv_process
   use, intrinsic :: iso_c_binding, only: c_char, c_int, c_null_char
   implicit none
   private
   public :: begin_streams, find_small_limit, use_one_thread, catch_interrupts, begin_saving, is_interrupted

   interface
      subroutine begin_streams() bind(C, name='mfv_begin_streams')
      end subroutine begin_streams

      subroutine use_one_thread() bind(C, name='mfv_use_one_thread')
      end subroutine use_one_thread

      subroutine catch_interrupts(code) bind(C, name='mfv_catch_interrupts')
         import :: c_int
         integer(c_int), value :: code
      end subroutine catch_interrupts

      subroutine begin_saving() bind(C, name='mfv_begin_saving')
      end subroutine begin_saving

      integer(c_int) function c_find_small_limit(message, size) bind(C, name='mfv_find_small_limit')
         import :: c_char, c_int
         character(kind=c_char), intent(inout) :: message(*)
         integer(c_int), value :: size
      end function c_find_small_limit

      integer(c_int) function is_interrupted() bind(C, name='mfv_is_interrupted')
         import :: c_int
      end function is_interrupted
   end interface

contains

   !> `why` the limits of the process are too small; unallocated if they suffice.
   subroutine find_small_limit(why)
      character(:), allocatable, intent(out) :: why
      integer, parameter :: longest = 200
      character(kind=c_char) :: message(longest)
      integer :: i

      if (c_find_small_limit(message, int(longest, c_int)) == 0) return
      why = ''
      do i = 1, longest
         if (message(i) == c_null_char) exit
         why = why//message(i)
      end do
   end subroutine find_small_limit

end module mfv_process
