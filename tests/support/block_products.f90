!> Products of single compliance blocks.
module block_products
   use mfv_compliance, only: block_up, block_wp, compliance_type
   use mfv_kinds, only: wp
   implicit none
   private
   public :: add_product

contains

   !> Add a block times `traction` to `displacement`, both of shape (nodes).
   subroutine add_product(compliance, block, traction, displacement)
      class(compliance_type), intent(in) :: compliance
      integer, intent(in) :: block
      real(wp), intent(in) :: traction(:)
      real(wp), intent(inout) :: displacement(:)
      real(wp) :: by_block(size(traction), 4), nothing(size(traction))

      nothing = 0.0_wp
      if (block == block_wp .or. block == block_up) then
         call compliance%products(traction, nothing, by_block)
      else
         call compliance%products(nothing, traction, by_block)
      end if
      displacement = displacement + by_block(:, block)
   end subroutine add_product

end module block_products
