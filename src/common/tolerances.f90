!> Levels below which numbers count as nothing, or two numbers as one: parts of the problem's own scale, such as the largest
!> traction or displacement of a state.
module mfv_tolerances
   use mfv_kinds, only: wp
   implicit none
   private
   public :: rounding, certified, significant, visible

   !> Errors of a few operations: a pivot, a norm or a load of this size is zero.
   real(wp), parameter :: rounding = 1.0e-14_wp
   !> Certified accuracy of a solution (docs/trust.md): tractions and slips that are smaller than this part of the largest traction
   !> or displacement of a state are zero to any quantity that is derived from them.
   real(wp), parameter :: certified = 1.0e-10_wp
   !> Ten times that: quantities found in two ways, as in cycles that repeat, in other units or by another solver, agree to this
   !> part.
   real(wp), parameter :: significant = 1.0e-9_wp
   !> What no reader of a result would see: parts as small as this decide nothing.
   real(wp), parameter :: visible = 1.0e-6_wp
end module mfv_tolerances
