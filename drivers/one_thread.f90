!> One thread for OpenBLAS: a second one slows small systems down and changes the last digits of sums. The programs set this
!> whatever OPENBLAS_NUM_THREADS says; the library leaves it to its host.
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

   !> Set OpenBLAS to one thread; no effect with another BLAS.
   subroutine use_one_thread()
      type(c_funptr) :: address
      procedure(set_threads), pointer :: set

      address = c_dlsym(c_null_ptr, 'openblas_set_num_threads'//c_null_char)
      if (.not. c_associated(address)) return
      call c_f_procpointer(address, set)
      call set(1_c_int)
   end subroutine use_one_thread

end module mfv_one_thread
