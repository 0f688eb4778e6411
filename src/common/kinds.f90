!> Kinds and mathematical constants shared by every module.
module mfv_kinds
   use, intrinsic :: iso_fortran_env, only: real64
   implicit none
   private
   public :: wp, pi, certified

   !> Working precision of the library.
   integer, parameter :: wp = real64
   real(wp), parameter :: pi = acos(-1.0_wp)
   !> Certified accuracy of a solution (docs/trust.md): tractions and slips that are smaller than this part of the largest traction
   !> or displacement of a state are zero to any quantity that is derived from them.
   real(wp), parameter :: certified = 1.0e-10_wp
end module mfv_kinds
