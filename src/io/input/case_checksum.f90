!> A checksum that identifies a case: of its text, and of the model with its files and data in memory.
module mfv_case_checksum
   use, intrinsic :: iso_fortran_env, only: int64, int8
   use mfv_case, only: case_type
   use mfv_checksum, only: add_text_to_checksum, add_to_checksum
   use mfv_contact_model, only: contact_model_type
   use mfv_kinds, only: wp
   implicit none
   private
   public :: find_case_checksum

contains

   !> The checksum of a case. `model`: its contact model before the first step.
   subroutine find_case_checksum(case, model, checksum)
      type(case_type), intent(in) :: case
      type(contact_model_type), intent(in) :: model
      integer(int64), intent(out) :: checksum
      integer(int8) :: mold(1)
      integer :: i

      checksum = 0
      call add_text_to_checksum(case%text, checksum)
      call add_to_checksum(transfer([folded(model%x), folded(model%initial_gap), folded(model%width), &
                                     folded(model%static_friction), folded(model%kinetic_friction)], mold), checksum)
      call add_to_checksum(transfer(model%compliance%modulus, mold), checksum)
      do i = 1, size(case%scene%steps)
         call add_to_checksum(transfer(case%scene%steps(i)%target, mold), checksum)
         if (allocated(case%scene%steps(i)%path)) call add_to_checksum(transfer(case%scene%steps(i)%path, mold), checksum)
      end do
      ! A product in place of the matrix; every entry contributes.
      if (.not. allocated(model%scene%lower%elasticity%matrix)) return
      associate (matrix => model%scene%lower%elasticity%matrix)
         call add_to_checksum(transfer(matmul(matrix, sqrt([(real(i, wp), i=1, size(matrix, 2))])), mold), checksum)
      end associate
   end subroutine find_case_checksum

   !> All bits of some values: each number is combined with what came before, turned by some bits.
   pure integer(int64) function folded(values)
      real(wp), intent(in) :: values(:)
      integer, parameter :: turn = 7
      integer :: i

      folded = 0
      do i = 1, size(values)
         folded = ieor(ishftc(folded, turn), transfer(values(i), folded))
      end do
   end function folded

end module mfv_case_checksum
