!> Wear of the surfaces: how much of them a sliding contact removes.
module mfv_wear
   use mfv_kinds, only: wp
   implicit none
   private
   public :: wear_type, wear_archard

   !> Depth of wear in proportion to pressure times slip (Archard 1953), or to the work of friction per unit of surface; the
   !> number of the first in the order of the key &wear law.
   integer, parameter :: wear_archard = 1

   type :: wear_type
      integer :: law = wear_archard
      !> Depth of both surfaces together over pressure times slip, or over work per unit of surface: length^2/force; 0: no wear.
      real(wp) :: coefficient = 0.0_wp
      !> Largest change of the pressure in a block of cycles: the integral of its magnitude over the normal force.
      real(wp) :: tolerance = 0.0_wp
      !> Cycles in a block; 0: as many as the tolerance allows.
      integer :: block = 0
   contains
      procedure :: acts
   end type wear_type

contains

   !> Whether anything is worn off.
   elemental logical function acts(self)
      class(wear_type), intent(in) :: self

      acts = self%coefficient > 0.0_wp
   end function acts

end module mfv_wear
