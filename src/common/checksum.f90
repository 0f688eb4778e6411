!> The checksum CRC-64 of ECMA-182 (reflected, as in xz), for detecting changed or corrupted bytes.
module mfv_checksum
   use, intrinsic :: iso_fortran_env, only: int8, int64
   implicit none
   private
   public :: add_to_checksum, add_text_to_checksum

   !> The polynomial, lowest power first: C96C5795D7870F42 in hexadecimal.
   integer(int64), parameter :: polynomial = ior(shiftl(int(z'C96C5795', int64), 32), int(z'D7870F42', int64))

contains

   !> Update a checksum by the bytes that follow; its initial value is 0.
   pure subroutine add_to_checksum(bytes, checksum)
      integer(int8), intent(in) :: bytes(:)
      integer(int64), intent(inout) :: checksum
      integer(int64) :: rest, i, table(0:15)
      integer :: bit, half, nibble

      ! What four bits do to the rest.
      table = [(int(nibble, int64), nibble=0, 15)]
      do bit = 1, 4
         table = merge(ieor(shiftr(table, 1), polynomial), shiftr(table, 1), btest(table, 0))
      end do
      rest = not(checksum)
      do i = 1, size(bytes, kind=int64)
         rest = ieor(rest, iand(int(bytes(i), int64), 255_int64))
         do half = 1, 2
            rest = ieor(shiftr(rest, 4), table(iand(rest, 15_int64)))
         end do
      end do
      checksum = not(rest)
   end subroutine add_to_checksum

   !> The same for a text and its length, so that the split between two texts matters.
   pure subroutine add_text_to_checksum(text, checksum)
      character(*), intent(in) :: text
      integer(int64), intent(inout) :: checksum
      integer(int8) :: mold(1)

      call add_to_checksum(transfer(int(len(text), int64), mold), checksum)
      call add_to_checksum(transfer(text, mold, len(text)), checksum)
   end subroutine add_text_to_checksum

end module mfv_checksum
