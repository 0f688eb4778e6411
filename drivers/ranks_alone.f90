!> The processes of a parallel run where there is no MPI: one, that nobody sends messages to.
module mfv_ranks
   use, intrinsic :: iso_fortran_env, only: int8
   implicit none
   private
   public :: message_type, has_ranks, start_ranks, end_ranks, share_number, send_message, receive_message

   !> Whether there can be several processes.
   logical, parameter :: has_ranks = .false.

   type :: message_type
      !> Rank of the sender, what kind of message, a number and bytes that go with it.
      integer :: from = 0, kind = 0, number = 0
      integer(int8), allocatable :: bytes(:)
   end type message_type

contains

   !> Join the other processes. `rank`: number of this one, from 0; `ranks`: how many there are.
   subroutine start_ranks(rank, ranks)
      integer, intent(out) :: rank, ranks

      rank = 0
      ranks = 1
   end subroutine start_ranks

   !> Leave the other processes.
   subroutine end_ranks()
   end subroutine end_ranks

   !> Give a number of rank 0 to all.
   subroutine share_number(number)
      integer, intent(inout) :: number
   end subroutine share_number

   !> Send a message.
   subroutine send_message(to, kind, number, bytes)
      integer, intent(in) :: to, kind, number
      integer(int8), intent(in) :: bytes(:)
   end subroutine send_message

   !> The next message, where one `is_there`; does not wait.
   subroutine receive_message(message, is_there)
      type(message_type), intent(out) :: message
      logical, intent(out) :: is_there

      is_there = .false.
   end subroutine receive_message

end module mfv_ranks
