!> What is kept of one case of a sweep: a row of the table, and as bytes.
module mfv_sweep_record
   use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
   use, intrinsic :: iso_fortran_env, only: int8
   use mfv_error, only: error_type
   use mfv_kinds, only: wp
   use mfv_observables
   use mfv_simulation, only: simulation_type
   implicit none
   private
   public :: record_type, record_of, record_of_error, pack_record, unpack_record, is_record, record_number, record_layout

   !> Number of the layout of the bytes of a record: to be raised whenever pack_record changes.
   integer, parameter :: record_layout = 1

   type :: record_type
      !> Number of the case; 0: the case has not been computed.
      integer :: number = 0
      !> See simulation_type; `nodes` of the mesh.
      integer :: outcome = 0, steps_done = 0, events = 0, linear_solves = 0, nodes = 0
      real(wp) :: largest_residual = 0.0_wp
      real(wp) :: observables(observable_count) = 0.0_wp
      character(:), allocatable :: message
      !> Tractions at the moments of mfv_observables, where cases are compared; else none.
      type(tractions_type), allocatable :: tractions(:)
   end type record_type

   integer, parameter :: bytes_of_whole = storage_size(1)/8, bytes_of_real = storage_size(1.0_wp)/8
   integer, parameter :: whole_values = 8

contains

   !> The record of a case that has been solved as far as it goes. `with_tractions`: whether tractions are kept.
   subroutine record_of(number, simulation, with_tractions, record)
      integer, intent(in) :: number
      type(simulation_type), intent(in) :: simulation
      logical, intent(in) :: with_tractions
      type(record_type), intent(out) :: record
      integer :: i

      record%number = number
      record%outcome = simulation%outcome
      record%message = simulation%message
      record%steps_done = simulation%steps_done
      record%events = simulation%contact%events
      record%linear_solves = simulation%contact%system%solves
      record%nodes = simulation%contact%model%nodes()
      record%largest_residual = simulation%contact%certificate%largest()
      call observables_of(simulation, record%observables)
      allocate (record%tractions(merge(moment_count, 0, with_tractions)))
      do i = 1, size(record%tractions)
         call observed_tractions(simulation, i, record%tractions(i))
      end do
   end subroutine record_of

   !> The record of a case that could not be begun.
   subroutine record_of_error(number, error, record)
      integer, intent(in) :: number
      type(error_type), intent(in) :: error
      type(record_type), intent(out) :: record

      record%number = number
      record%outcome = error%status
      record%message = error%message
      record%largest_residual = ieee_value(1.0_wp, ieee_quiet_nan)
      record%observables = ieee_value(1.0_wp, ieee_quiet_nan)
      allocate (record%tractions(0))
   end subroutine record_of_error

   !> A record as bytes.
   subroutine pack_record(record, bytes)
      type(record_type), intent(in) :: record
      integer(int8), allocatable, intent(out) :: bytes(:)
      integer :: i, at, length

      length = whole_values*bytes_of_whole + (1 + observable_count)*bytes_of_real + len(record%message)
      do i = 1, size(record%tractions)
         length = length + bytes_of_whole + bytes_of_real*(1 + 2*nodes_of(record%tractions(i)))
      end do
      allocate (bytes(length))
      at = 0
      call put_whole(bytes, at, [record%number, record%outcome, record%steps_done, record%events, record%linear_solves, &
                                 record%nodes, len(record%message), size(record%tractions)])
      call put_reals(bytes, at, [record%largest_residual, record%observables])
      bytes(at + 1:at + len(record%message)) = transfer(record%message, bytes, len(record%message))
      at = at + len(record%message)
      do i = 1, size(record%tractions)
         call put_whole(bytes, at, [nodes_of(record%tractions(i))])
         call put_reals(bytes, at, [record%tractions(i)%interval])
         if (nodes_of(record%tractions(i)) == 0) cycle
         call put_reals(bytes, at, record%tractions(i)%pressure)
         call put_reals(bytes, at, record%tractions(i)%shear)
      end do
   end subroutine pack_record

   !> The record in some bytes; they must be those of pack_record, see is_record.
   subroutine unpack_record(bytes, record)
      integer(int8), intent(in) :: bytes(:)
      type(record_type), intent(out) :: record
      integer :: whole(whole_values), nodes(1), i, at
      real(wp) :: reals(1 + observable_count), interval(1)

      at = 0
      call get_whole(bytes, at, whole)
      call get_reals(bytes, at, reals)
      record%number = whole(1)
      record%outcome = whole(2)
      record%steps_done = whole(3)
      record%events = whole(4)
      record%linear_solves = whole(5)
      record%nodes = whole(6)
      record%largest_residual = reals(1)
      record%observables = reals(2:)
      allocate (character(len=whole(7)) :: record%message)
      do i = 1, whole(7)
         record%message(i:i) = transfer(bytes(at + i), 'a')
      end do
      at = at + whole(7)
      allocate (record%tractions(whole(8)))
      do i = 1, whole(8)
         call get_whole(bytes, at, nodes)
         call get_reals(bytes, at, interval)
         record%tractions(i)%interval = interval(1)
         allocate (record%tractions(i)%pressure(nodes(1)))
         allocate (record%tractions(i)%shear(nodes(1)))
         call get_reals(bytes, at, record%tractions(i)%pressure)
         call get_reals(bytes, at, record%tractions(i)%shear)
      end do
   end subroutine unpack_record

   !> Whether some bytes have the lengths that pack_record gives them, so that unpack_record can read them.
   logical function is_record(bytes)
      integer(int8), intent(in) :: bytes(:)
      integer, parameter :: fixed = whole_values*bytes_of_whole + (1 + observable_count)*bytes_of_real
      integer :: whole(whole_values), nodes(1), i, at, rest

      is_record = .false.
      if (size(bytes) < fixed) return
      at = 0
      call get_whole(bytes, at, whole)
      if (whole(7) < 0 .or. whole(7) > size(bytes) - fixed) return
      if (all(whole(8) /= [0, moment_count])) return
      at = fixed + whole(7)
      do i = 1, whole(8)
         if (size(bytes) - at < bytes_of_whole + bytes_of_real) return
         call get_whole(bytes, at, nodes)
         at = at + bytes_of_real
         rest = size(bytes) - at
         if (nodes(1) < 0 .or. nodes(1) > rest/(2*bytes_of_real)) return
         at = at + 2*bytes_of_real*nodes(1)
      end do
      is_record = at == size(bytes)
   end function is_record

   !> Number of the case in such bytes, without the rest.
   pure integer function record_number(bytes)
      integer(int8), intent(in) :: bytes(:)

      record_number = transfer(bytes(:bytes_of_whole), 0)
   end function record_number

   !> Nodes of tractions that may not be there.
   pure integer function nodes_of(tractions) result(nodes)
      type(tractions_type), intent(in) :: tractions

      nodes = 0
      if (allocated(tractions%pressure)) nodes = size(tractions%pressure)
   end function nodes_of

   !> Put whole numbers behind the first `at` bytes.
   subroutine put_whole(bytes, at, values)
      integer(int8), intent(inout) :: bytes(:)
      integer, intent(inout) :: at
      integer, intent(in) :: values(:)
      integer :: length

      length = size(values)*bytes_of_whole
      bytes(at + 1:at + length) = transfer(values, bytes, length)
      at = at + length
   end subroutine put_whole

   !> Put reals behind the first `at` bytes.
   subroutine put_reals(bytes, at, values)
      integer(int8), intent(inout) :: bytes(:)
      integer, intent(inout) :: at
      real(wp), intent(in) :: values(:)
      integer :: length

      length = size(values)*bytes_of_real
      bytes(at + 1:at + length) = transfer(values, bytes, length)
      at = at + length
   end subroutine put_reals

   !> Get whole numbers from behind the first `at` bytes.
   subroutine get_whole(bytes, at, values)
      integer(int8), intent(in) :: bytes(:)
      integer, intent(inout) :: at
      integer, intent(out) :: values(:)
      integer :: length

      length = size(values)*bytes_of_whole
      values = transfer(bytes(at + 1:at + length), values, size(values))
      at = at + length
   end subroutine get_whole

   !> Get reals from behind the first `at` bytes.
   subroutine get_reals(bytes, at, values)
      integer(int8), intent(in) :: bytes(:)
      integer, intent(inout) :: at
      real(wp), intent(out) :: values(:)
      integer :: length

      length = size(values)*bytes_of_real
      values = transfer(bytes(at + 1:at + length), values, size(values))
      at = at + length
   end subroutine get_reals

end module mfv_sweep_record
