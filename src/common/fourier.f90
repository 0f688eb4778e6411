!> Real Fourier sums through FFTW.
!>
!> FFTW's planner is not safe in several threads, its execution is. Plans are therefore made under a mutex and kept: they
!> are constant once made, belong to a size and to no data, and serve all objects and threads. This cache is the only
!> thing in the library that outlives an object. When it is full, plans are made and thrown away.
module mfv_fourier
   use, intrinsic :: iso_c_binding
   use mfv_kinds, only: wp
   implicit none
   private
   public :: fourier_sum, fourier_coefficients, plans_kept

   include 'fftw3.f03'

   integer, parameter :: to_values = 1, to_coefficients = 2
   integer, parameter :: most_plans = 64

   type :: plan_type
      integer :: size = 0, direction = 0
      type(c_ptr) :: plan = c_null_ptr
   end type plan_type

   type(plan_type) :: plans(most_plans)
   integer :: plan_count = 0

   !> Storage of a pthread_mutex_t, which is ready for use when it is zero; 40 bytes on Linux, 64 on macOS.
   integer(c_long), target :: mutex(16) = 0

   interface
      function pthread_mutex_lock(mutex) bind(C, name='pthread_mutex_lock') result(code)
         import :: c_int, c_ptr
         type(c_ptr), value :: mutex
         integer(c_int) :: code
      end function pthread_mutex_lock

      function pthread_mutex_unlock(mutex) bind(C, name='pthread_mutex_unlock') result(code)
         import :: c_int, c_ptr
         type(c_ptr), value :: mutex
         integer(c_int) :: code
      end function pthread_mutex_unlock
   end interface

contains

   !> `values(k+1)` = sum over m of a_m cos(2 pi m k/N) + b_m sin(2 pi m k/N), for k = 0 to N-1 and m = 0 to N/2, with
   !> `coefficients(m+1)` = (a_m, -b_m). N = size(values) >= 1; size(coefficients) = N/2 + 1.
   !> `coefficients` is used as work space.
   subroutine fourier_sum(coefficients, values)
      complex(wp), intent(inout) :: coefficients(:)
      real(wp), intent(out) :: values(:)
      type(c_ptr) :: plan
      logical :: kept
      integer :: n

      n = size(values)
      ! FFTW adds the mirror image of every coefficient but the first and, for even N, the last.
      coefficients(2:(n + 1)/2) = 0.5_wp*coefficients(2:(n + 1)/2)
      call get_plan(n, to_values, plan, kept)
      call fftw_execute_dft_c2r(plan, coefficients, values)
      if (.not. kept) call throw_away(plan)
   end subroutine fourier_sum

   !> The coefficients (a_m, -b_m), m = 0 to N/2, of the sum that takes `values`: the inverse of fourier_sum.
   !> `values` is used as work space.
   subroutine fourier_coefficients(values, coefficients)
      real(wp), intent(inout) :: values(:)
      complex(wp), intent(out) :: coefficients(:)
      type(c_ptr) :: plan
      logical :: kept
      integer :: n

      n = size(values)
      call get_plan(n, to_coefficients, plan, kept)
      call fftw_execute_dft_r2c(plan, values, coefficients)
      if (.not. kept) call throw_away(plan)
      coefficients = coefficients/n
      coefficients(2:(n + 1)/2) = 2.0_wp*coefficients(2:(n + 1)/2)
   end subroutine fourier_coefficients

   !> Number of plans in the cache.
   integer function plans_kept()
      integer(c_int) :: code

      code = pthread_mutex_lock(c_loc(mutex))
      plans_kept = plan_count
      code = pthread_mutex_unlock(c_loc(mutex))
   end function plans_kept

   !> A plan for a size and a direction. `kept`: whether it stays in the cache.
   subroutine get_plan(size, direction, plan, kept)
      integer, intent(in) :: size, direction
      type(c_ptr), intent(out) :: plan
      logical, intent(out) :: kept
      integer(c_int) :: code
      integer :: i

      code = pthread_mutex_lock(c_loc(mutex))
      plan = c_null_ptr
      kept = .true.
      do i = 1, plan_count
         if (plans(i)%size == size .and. plans(i)%direction == direction) plan = plans(i)%plan
      end do
      if (.not. c_associated(plan)) then
         plan = new_plan(size, direction)
         kept = plan_count < most_plans
         if (kept) then
            plan_count = plan_count + 1
            plans(plan_count) = plan_type(size, direction, plan)
         end if
      end if
      code = pthread_mutex_unlock(c_loc(mutex))
   end subroutine get_plan

   !> A plan that fits arrays of any alignment and measures nothing.
   function new_plan(size, direction) result(plan)
      integer, intent(in) :: size, direction
      type(c_ptr) :: plan
      complex(wp), allocatable :: coefficients(:)
      real(wp), allocatable :: values(:)
      integer(c_int), parameter :: flags = ior(FFTW_ESTIMATE, FFTW_UNALIGNED)

      allocate (coefficients(size/2 + 1), values(size))
      if (direction == to_values) then
         plan = fftw_plan_dft_c2r_1d(int(size, c_int), coefficients, values, flags)
      else
         plan = fftw_plan_dft_r2c_1d(int(size, c_int), values, coefficients, flags)
      end if
   end function new_plan

   subroutine throw_away(plan)
      type(c_ptr), intent(in) :: plan
      integer(c_int) :: code

      code = pthread_mutex_lock(c_loc(mutex))
      call fftw_destroy_plan(plan)
      code = pthread_mutex_unlock(c_loc(mutex))
   end subroutine throw_away

end module mfv_fourier
