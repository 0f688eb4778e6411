!> In place of src/common/kinds.f90: the same names in quadruple precision, for suites that differentiate by differences.
module mfv_kinds
   use, intrinsic :: iso_fortran_env, only: real128
   implicit none
   private
   public :: wp, pi

   integer, parameter :: wp = real128
   real(wp), parameter :: pi = acos(-1.0_wp)
end module mfv_kinds
