!> Assertions on real(real32).
module funit_real32
   use, intrinsic :: iso_fortran_env, only: rk => real32
   include 'assert_real.inc'
end module funit_real32

!> Assertions on real(real64).
module funit_real64
   use, intrinsic :: iso_fortran_env, only: rk => real64
   include 'assert_real.inc'
end module funit_real64

!> Assertions on real(real128).
module funit_real128
   use, intrinsic :: iso_fortran_env, only: rk => real128
   include 'assert_real.inc'
end module funit_real128

!> Assertions on integer(int32).
module funit_int32
   use, intrinsic :: iso_fortran_env, only: ek => int32, ak => int32
   include 'assert_integer.inc'
end module funit_int32

!> Assertions on integer(int64).
module funit_int64
   use, intrinsic :: iso_fortran_env, only: ek => int64, ak => int64
   include 'assert_integer.inc'
end module funit_int64

!> Assertions on integer(int64) where a plain integer is expected.
module funit_int32_int64
   use, intrinsic :: iso_fortran_env, only: ek => int32, ak => int64
   include 'assert_integer.inc'
end module funit_int32_int64

!> The part of pFUnit's module of this name that our tests use, for machines without pFUnit. What it takes, pFUnit 4.14
!> takes too; pFUnit takes more (other kinds, ranks and assertions, and `message` without its keyword).
module funit
   use funit_core, only: SourceLocation, anyExceptions, assertExceptionRaised, assertFail, at_index, conformable, &
      & detail, fail, standin_disable, standin_enter, standin_finish, standin_leave, standin_start
   use funit_flatten, only: flatten
   use funit_int32
   use funit_int32_int64
   use funit_int64
   use funit_real128
   use funit_real32
   use funit_real64
   implicit none(type, external)
   private

   public :: SourceLocation, anyExceptions
   public :: assertEqual, assertRelativelyEqual, assertIsFinite, assertIsNaN
   public :: assertLessThan, assertLessThanOrEqual, assertGreaterThan, assertGreaterThanOrEqual
   public :: assertTrue, assertFalse, assertAll, assertAny, assertFail, assertExceptionRaised
   public :: standin_disable, standin_enter, standin_finish, standin_leave, standin_start

   !> Names of pFUnit's own, taken here as well so that a suite that reuses one fails with either.
   integer, parameter, public :: catch = 0, disable = 0, finalize = 0, initialize = 0, run = 0, stub = 0, test = 0

   interface assertEqual
      module procedure equal_logical, equal_character
   end interface assertEqual

contains

   !> Logical values are the same in every element.
   subroutine equal_logical(expected, actual, location, message)
      logical, intent(in) :: expected(..), actual(..)
      type(SourceLocation), intent(in), optional :: location
      character(len=*), intent(in), optional :: message
      logical :: e(size(actual)), a(size(actual))
      integer :: i

      if (.not. conformable(shape(expected), shape(actual), 'assertEqual', location, message)) return
      a = flatten(actual, size(a))
      e = flatten(expected, size(e))
      i = findloc(a .eqv. e, .false., dim=1)
      if (i == 0) return
      call fail('assertEqual', detail('expected', merge('T', 'F', e(i)))//detail('actual', merge('T', 'F', a(i))) &
         & //at_index(i, shape(actual)), location, message)
   end subroutine equal_logical

   !> Strings are the same but for blanks before and after.
   subroutine equal_character(expected, actual, location, message)
      character(len=*), intent(in) :: expected, actual
      type(SourceLocation), intent(in), optional :: location
      character(len=*), intent(in), optional :: message

      if (adjustl(expected) == adjustl(actual)) return
      call fail('assertEqual', detail('expected', trim(expected))//detail('actual', trim(actual)), location, message)
   end subroutine equal_character

   !> Every condition is true.
   subroutine assertTrue(condition, message, location)
      logical, intent(in) :: condition(..)
      character(len=*), intent(in), optional :: message
      type(SourceLocation), intent(in), optional :: location

      call judge('assertTrue', all(flatten(condition, size(condition))), rank(condition), message, location)
   end subroutine assertTrue

   !> No condition is true.
   subroutine assertFalse(condition, message, location)
      logical, intent(in) :: condition(..)
      character(len=*), intent(in), optional :: message
      type(SourceLocation), intent(in), optional :: location

      call judge('assertFalse',.not. any(flatten(condition, size(condition))), rank(condition), message, location)
   end subroutine assertFalse

   !> Every condition is true.
   subroutine assertAll(conditions, message, location)
      logical, intent(in) :: conditions(..)
      character(len=*), intent(in), optional :: message
      type(SourceLocation), intent(in), optional :: location

      call judge('assertAll', all(flatten(conditions, size(conditions))), rank(conditions), message, location)
   end subroutine assertAll

   !> At least one condition is true.
   subroutine assertAny(conditions, message, location)
      logical, intent(in) :: conditions(..)
      character(len=*), intent(in), optional :: message
      type(SourceLocation), intent(in), optional :: location

      call judge('assertAny', any(flatten(conditions, size(conditions))), rank(conditions), message, location)
   end subroutine assertAny

   !> Fail unless `holds`, and where pFUnit would not take conditions of that rank.
   subroutine judge(assertion, holds, rank_of_conditions, message, location)
      character(len=*), intent(in) :: assertion
      logical, intent(in) :: holds
      integer, intent(in) :: rank_of_conditions
      character(len=*), intent(in), optional :: message
      type(SourceLocation), intent(in), optional :: location

      if (rank_of_conditions > 1) then
         call fail(assertion, detail('takes', 'a scalar or an array of rank 1'), location, message)
      else if (.not. holds) then
         call fail(assertion, '', location, message)
      end if
   end subroutine judge

end module funit
