!> Kinds and mathematical constants shared by every module.
module mfv_kinds
   use, intrinsic :: iso_fortran_env, only: real64
   implicit none
   private
   public :: wp, pi

   !> Working precision of the library.
   integer, parameter :: wp = real64
   real(wp), parameter :: pi = acos(-1.0_wp)
end module mfv_kinds
