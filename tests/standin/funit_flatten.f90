!> flatten(x, n), for the pFUnit stand-in: the n elements of an array x of rank 1 or 2, in array element order, or n
!> times a scalar x.
module funit_flatten
   use, intrinsic :: iso_fortran_env, only: int32, int64, real128, real32, real64
   implicit none(type, external)
   private

   public :: flatten

   interface flatten
      module procedure flatten_int32, flatten_int64, flatten_real32, flatten_real64, flatten_real128, flatten_logical
   end interface flatten

contains

   function flatten_int32(x, n) result(flat)
      integer(int32), intent(in) :: x(..)
      integer, intent(in) :: n
      integer(int64) :: flat(n)
      include 'flatten.inc'
   end function flatten_int32

   function flatten_int64(x, n) result(flat)
      integer(int64), intent(in) :: x(..)
      integer, intent(in) :: n
      integer(int64) :: flat(n)
      include 'flatten.inc'
   end function flatten_int64

   function flatten_real32(x, n) result(flat)
      real(real32), intent(in) :: x(..)
      integer, intent(in) :: n
      real(real32) :: flat(n)
      include 'flatten.inc'
   end function flatten_real32

   function flatten_real64(x, n) result(flat)
      real(real64), intent(in) :: x(..)
      integer, intent(in) :: n
      real(real64) :: flat(n)
      include 'flatten.inc'
   end function flatten_real64

   function flatten_real128(x, n) result(flat)
      real(real128), intent(in) :: x(..)
      integer, intent(in) :: n
      real(real128) :: flat(n)
      include 'flatten.inc'
   end function flatten_real128

   function flatten_logical(x, n) result(flat)
      logical, intent(in) :: x(..)
      integer, intent(in) :: n
      logical :: flat(n)
      include 'flatten.inc'
   end function flatten_logical

end module funit_flatten
