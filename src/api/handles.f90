!> The table of live handles, see handles.h.
module mfv_handles
   use, intrinsic :: iso_c_binding, only: c_int, c_ptr
   implicit none
   private
   public :: mfv_handle_issue, mfv_handle_enter, mfv_handle_leave, mfv_handle_remove
   public :: kind_scene, kind_case, kind_state, use_alone, use_reading

   integer(c_int), parameter :: kind_scene = 1, kind_case = 2, kind_state = 3
   integer(c_int), parameter :: use_alone = 0, use_reading = 1

   interface
      type(c_ptr) function mfv_handle_issue(kind, object) bind(C)
         import :: c_int, c_ptr
         integer(c_int), value :: kind
         type(c_ptr), value :: object
      end function mfv_handle_issue

      integer(c_int) function mfv_handle_enter(handle, kind, use, object) bind(C)
         import :: c_int, c_ptr
         type(c_ptr), value :: handle
         integer(c_int), value :: kind, use
         type(c_ptr), intent(out) :: object
      end function mfv_handle_enter

      subroutine mfv_handle_leave(handle) bind(C)
         import :: c_ptr
         type(c_ptr), value :: handle
      end subroutine mfv_handle_leave

      integer(c_int) function mfv_handle_remove(handle, kind, object) bind(C)
         import :: c_int, c_ptr
         type(c_ptr), intent(inout), optional :: handle
         integer(c_int), value :: kind
         type(c_ptr), intent(out) :: object
      end function mfv_handle_remove
   end interface

end module mfv_handles
