!> One thread for the BLAS. The systems of a contact are small: a second thread costs more than it does, on a busy machine
!> hundreds of times more, and what is added up in two threads has other last digits. With one the digits are the same
!> whatever OPENBLAS_NUM_THREADS says. A library must not decide this for its host; a program may.
module mfv_one_thread
   use, intrinsic :: iso_c_binding
   implicit none
   private
   public :: use_one_thread

   interface
      function c_dlsym(handle, name) bind(C, name='dlsym') result(address)
         import :: c_char, c_funptr, c_ptr
         type(c_ptr), value :: handle
         character(kind=c_char), intent(in) :: name(*)
         type(c_funptr) :: address
      end function c_dlsym
   end interface

   abstract interface
      subroutine set_threads(number) bind(C)
         import :: c_int
         integer(c_int), value :: number
      end subroutine set_threads
   end interface

contains

   !> Tell OpenBLAS, where that is the BLAS (another one is left as it is).
   subroutine use_one_thread()
      type(c_funptr) :: address
      procedure(set_threads), pointer :: set

      address = c_dlsym(c_null_ptr, 'openblas_set_num_threads'//c_null_char)
      if (.not. c_associated(address)) return
      call c_f_procpointer(address, set)
      call set(1_c_int)
   end subroutine use_one_thread

end module mfv_one_thread
