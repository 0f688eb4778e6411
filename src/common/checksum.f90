!> The checksum CRC-64 of ECMA-182 (reflected, as in the program xz): tells whether bytes are the same as before, and whether
!> what was written is what is read.
module mfv_checksum
   use, intrinsic :: iso_fortran_env, only: int8, int64
   implicit none
   private
   public :: add_to_checksum, add_text_to_checksum

   !> The polynomial, its lowest power first: C96C5795D7870F42 in hexadecimal digits.
   integer(int64), parameter :: polynomial = ior(shiftl(int(z'C96C5795', int64), 32), int(z'D7870F42', int64))

contains

   !> From the checksum of what came before to that with these bytes after it; it begins with 0.
   pure subroutine add_to_checksum(bytes, checksum)
      integer(int8), intent(in) :: bytes(:)
      integer(int64), intent(inout) :: checksum
      integer(int64) :: rest, i
      integer :: bit
      logical :: is_odd

      rest = not(checksum)
      do i = 1, size(bytes, kind=int64)
         rest = ieor(rest, iand(int(bytes(i), int64), 255_int64))
         do bit = 1, 8
            is_odd = btest(rest, 0)
            rest = shiftr(rest, 1)
            if (is_odd) rest = ieor(rest, polynomial)
         end do
      end do
      checksum = not(rest)
   end subroutine add_to_checksum

   !> The same for a text, with its length: two texts in a row are not their sum.
   pure subroutine add_text_to_checksum(text, checksum)
      character(*), intent(in) :: text
      integer(int64), intent(inout) :: checksum
      integer(int8) :: mold(1)

      call add_to_checksum(transfer(int(len(text), int64), mold), checksum)
      call add_to_checksum(transfer(text, mold, len(text)), checksum)
   end subroutine add_text_to_checksum

end module mfv_checksum
