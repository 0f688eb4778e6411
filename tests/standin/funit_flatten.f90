!> Scalars and arrays of rank 1 and 2 as arrays of rank 1, in array element order, for the pFUnit stand-in.
module funit_flatten
   use, intrinsic :: iso_fortran_env, only: int32, int64, real128, real32, real64
   implicit none (type, external)
   private

   public :: flatten

   interface flatten
      module procedure flatten_int32, flatten_int64, flatten_real32, flatten_real64, flatten_real128, flatten_logical
   end interface flatten

contains

   function flatten_int32(x) result(flat)
      integer(int32), intent(in) :: x(..)
      integer(int64), allocatable :: flat(:)
      include 'flatten.inc'
   end function flatten_int32

   function flatten_int64(x) result(flat)
      integer(int64), intent(in) :: x(..)
      integer(int64), allocatable :: flat(:)
      include 'flatten.inc'
   end function flatten_int64

   function flatten_real32(x) result(flat)
      real(real32), intent(in) :: x(..)
      real(real32), allocatable :: flat(:)
      include 'flatten.inc'
   end function flatten_real32

   function flatten_real64(x) result(flat)
      real(real64), intent(in) :: x(..)
      real(real64), allocatable :: flat(:)
      include 'flatten.inc'
   end function flatten_real64

   function flatten_real128(x) result(flat)
      real(real128), intent(in) :: x(..)
      real(real128), allocatable :: flat(:)
      include 'flatten.inc'
   end function flatten_real128

   function flatten_logical(x) result(flat)
      logical, intent(in) :: x(..)
      logical, allocatable :: flat(:)
      include 'flatten.inc'
   end function flatten_logical

end module funit_flatten
