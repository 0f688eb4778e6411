!> Errors are values: a procedure that can fail has `type(error_type), allocatable, intent(out) :: error`,
!> unallocated when all went well. Library code never stops and never prints.
module mfv_error
   implicit none
   private
   public :: error_type, set_error

   !> An error: a status of `mfv_status` and a message for the user.
   type :: error_type
      integer :: status = 0
      character(:), allocatable :: message
   end type error_type

contains

   !> Fill `error` with a status (see mfv_status) and a message.
   subroutine set_error(error, status, message)
      type(error_type), allocatable, intent(out) :: error
      integer, intent(in) :: status
      character(*), intent(in) :: message

      allocate (error)
      error%status = status
      error%message = message
   end subroutine set_error

end module mfv_error
