!> The processes of a parallel run, by MPI. One thread of each process calls this module, the one that started it. A process
!> that no launcher has started stays alone, without MPI: some implementations take seconds to find out that there is nobody else.
module mfv_ranks
   use, intrinsic :: iso_fortran_env, only: int8
   use mpi_f08
   implicit none
   private
   public :: message_type, has_ranks, start_ranks, end_ranks, share_number, send_message, receive_message

   !> Whether there can be several processes.
   logical, parameter :: has_ranks = .true.
   integer, parameter :: bytes_of_number = storage_size(1)/8
   !> Variables of the environment that launchers set: Open MPI, PMIx (srun too), PMI (MPICH, Intel MPI, srun), MVAPICH, PALS.
   character(*), parameter :: launcher_variables(6) = [character(24) :: 'OMPI_COMM_WORLD_SIZE', 'PMIX_RANK', 'PMI_RANK', &
                                                       'PMI_SIZE', 'MV2_COMM_WORLD_SIZE', 'PALS_RANKID']

   !> Whether MPI is in use; a program's state, not the library's.
   logical :: joined = .false.

   type :: message_type
      !> Rank of the sender, what kind of message, a number and bytes that go with it.
      integer :: from = 0, kind = 0, number = 0
      integer(int8), allocatable :: bytes(:)
   end type message_type

contains

   !> Join the other processes. `rank`: number of this one, from 0; `ranks`: how many there are.
   subroutine start_ranks(rank, ranks)
      integer, intent(out) :: rank, ranks
      integer :: provided

      rank = 0
      ranks = 1
      joined = has_launcher()
      if (.not. joined) return
      call MPI_Init_thread(MPI_THREAD_FUNNELED, provided)
      call MPI_Comm_rank(MPI_COMM_WORLD, rank)
      call MPI_Comm_size(MPI_COMM_WORLD, ranks)
   end subroutine start_ranks

   !> Whether a launcher has started this process.
   logical function has_launcher()
      integer :: i, code

      has_launcher = .false.
      do i = 1, size(launcher_variables)
         call get_environment_variable(trim(launcher_variables(i)), status=code)
         has_launcher = has_launcher .or. code /= 1
      end do
   end function has_launcher

   !> Leave the other processes.
   subroutine end_ranks()
      if (joined) call MPI_Finalize()
   end subroutine end_ranks

   !> Give a number of rank 0 to all.
   subroutine share_number(number)
      integer, intent(inout) :: number

      if (joined) call MPI_Bcast(number, 1, MPI_INTEGER, 0, MPI_COMM_WORLD)
   end subroutine share_number

   !> Send a message.
   subroutine send_message(to, kind, number, bytes)
      integer, intent(in) :: to, kind, number
      integer(int8), intent(in) :: bytes(:)
      integer(int8) :: buffer(bytes_of_number + size(bytes))

      buffer(:bytes_of_number) = transfer(number, buffer)
      buffer(bytes_of_number + 1:) = bytes
      call MPI_Send(buffer, size(buffer), MPI_BYTE, to, kind, MPI_COMM_WORLD)
   end subroutine send_message

   !> The next message, where one `is_there`; does not wait.
   subroutine receive_message(message, is_there)
      type(message_type), intent(out) :: message
      logical, intent(out) :: is_there
      type(MPI_Status) :: status
      integer(int8), allocatable :: buffer(:)
      integer :: length

      is_there = .false.
      if (.not. joined) return
      call MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, is_there, status)
      if (.not. is_there) return
      call MPI_Get_count(status, MPI_BYTE, length)
      allocate (buffer(length))
      call MPI_Recv(buffer, length, MPI_BYTE, status%MPI_SOURCE, status%MPI_TAG, MPI_COMM_WORLD, MPI_STATUS_IGNORE)
      message%from = status%MPI_SOURCE
      message%kind = status%MPI_TAG
      message%number = transfer(buffer(:bytes_of_number), message%number)
      message%bytes = buffer(bytes_of_number + 1:)
   end subroutine receive_message

end module mfv_ranks
