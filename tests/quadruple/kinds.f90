!> Replaces src/common/kinds.f90 in quadruple precision, for suites that differentiate numerically.
module mfv_kinds
   use, intrinsic :: iso_fortran_env, only: real128
   implicit none
   private
   public :: wp, pi

   integer, parameter :: wp = real128
   real(wp), parameter :: pi = acos(-1.0_wp)
end module mfv_kinds
