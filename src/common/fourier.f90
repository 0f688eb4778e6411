!> Fourier sums and transforms through FFTW.
!>
!> FFTW's planner is not thread-safe, its execution is. Plans are made under a mutex and cached: they are constant, depend on
!> a size only, and serve all objects and threads. This cache is the only global state of the library. When it is full, plans
!> are made for one use.
module mfv_fourier
   use, intrinsic :: iso_c_binding
   use mfv_kinds, only: pi, wp
   implicit none
   private
   public :: fourier_sum, complex_transform, real_transform, back_transform, fast_length, &
             is_fast, forward, backward, plans_kept

   include 'fftw3.f03'

   !> Directions of transforms: from coefficients to real values; complex_transform with exp(-2 pi i j k/N) and exp(2 pi i j
   !> k/N).
   integer, parameter :: to_values = 1, forward = 2, backward = 3
   integer, parameter :: most_plans = 256
   !> Alignment of arrays, bytes.
   integer(c_intptr_t), parameter :: boundary = 16

   type :: plan_type
      integer :: size = 0, direction = 0
      logical :: aligned = .false.
      type(c_ptr) :: plan = c_null_ptr
   end type plan_type

   !> Factors between a real transform and the complex one of half the length.
   type :: turns_type
      integer :: half = 0
      complex(wp), pointer, contiguous :: turns(:) => null()
   end type turns_type

   type(plan_type) :: plans(most_plans)
   type(turns_type) :: all_turns(most_plans)
   integer :: plan_count = 0, turn_count = 0

   !> Storage of a pthread_mutex_t, initialised by zeros; 40 bytes on Linux, 64 on macOS.
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
      logical :: is_cached
      integer :: n

      n = size(values)
      ! FFTW adds the mirror image of every coefficient but the first and, for even N, the last.
      coefficients(2:(n + 1)/2) = 0.5_wp*coefficients(2:(n + 1)/2)
      call get_plan(n, to_values, plan, is_cached, .false.)
      call fftw_execute_dft_c2r(plan, coefficients, values)
      if (.not. is_cached) call discard(plan)
   end subroutine fourier_sum

   !> `transformed(k+1)` = sum over j = 0 to N-1 of values(j+1) exp(-/+ 2 pi i j k/N), N = size(values) = size(transformed);
   !> `direction`: forward (-) or backward (+). Both in turn multiply by N. `values` is used as work space.
   subroutine complex_transform(direction, values, transformed)
      integer, intent(in) :: direction
      complex(wp), intent(inout), contiguous, target :: values(:)
      complex(wp), intent(out), contiguous, target :: transformed(:)
      type(c_ptr) :: plan
      logical :: is_cached

      call get_plan(size(values), direction, plan, is_cached, is_aligned(c_loc(values)) .and. is_aligned(c_loc(transformed)))
      call fftw_execute_dft(plan, values, transformed)
      if (.not. is_cached) call discard(plan)
   end subroutine complex_transform

   !> `spectrum(m+1)` = sum over k of values(k+1) exp(-2 pi i m k/N), m = 0 to N/2; N = size(values), even, size(spectrum) =
   !> N/2 + 1. By a complex transform of half the length (even values real, odd ones imaginary), which FFTW plans ten times
   !> faster than a real one. `values` is used as work space.
   subroutine real_transform(values, spectrum)
      real(wp), intent(inout), contiguous, target :: values(:)
      complex(wp), intent(out), contiguous, target :: spectrum(:)
      complex(wp), pointer, contiguous :: turns(:), pairs(:)
      real(wp) :: even(2), odd(2), sums(2), differences(2)
      logical :: is_cached
      integer :: k, l, half

      half = size(values)/2
      call c_f_pointer(c_loc(values), pairs, [half])
      call complex_transform(forward, pairs, spectrum(:half))
      call get_turns(half, turns, is_cached)
      spectrum(half + 1) = real(spectrum(1), wp) - aimag(spectrum(1))
      spectrum(1) = real(spectrum(1), wp) + aimag(spectrum(1))
      do k = 2, half/2 + 1
         l = half - k + 2
         sums = 0.5_wp*[real(spectrum(k), wp) + real(spectrum(l), wp), aimag(spectrum(k)) + aimag(spectrum(l))]
         differences = 0.5_wp*[real(spectrum(k), wp) - real(spectrum(l), wp), aimag(spectrum(k)) - aimag(spectrum(l))]
         even = [sums(1), differences(2)]
         odd(1) = differences(1)*real(turns(k - 1), wp) - sums(2)*aimag(turns(k - 1))
         odd(2) = differences(1)*aimag(turns(k - 1)) + sums(2)*real(turns(k - 1), wp)
         spectrum(k) = cmplx(even(1) + odd(1), even(2) + odd(2), wp)
         spectrum(l) = cmplx(even(1) - odd(1), odd(2) - even(2), wp)
      end do
      if (.not. is_cached) deallocate (turns)
   end subroutine real_transform

   !> N times the values of which `spectrum` is the real_transform; N = size(values), even, size(spectrum) = N/2 + 1. `spectrum`
   !> is used as work space.
   subroutine back_transform(spectrum, values)
      complex(wp), intent(inout), contiguous, target :: spectrum(:)
      real(wp), intent(out), contiguous, target :: values(:)
      complex(wp), pointer, contiguous :: turns(:), pairs(:)
      real(wp) :: even(2), odd(2), sums(2), differences(2), first, last
      logical :: is_cached
      integer :: k, l, half

      half = size(values)/2
      call get_turns(half, turns, is_cached)
      first = real(spectrum(1), wp)
      last = real(spectrum(half + 1), wp)
      spectrum(1) = cmplx(first + last, first - last, wp)
      do k = 2, half/2 + 1
         l = half - k + 2
         sums = [real(spectrum(k), wp) + real(spectrum(l), wp), aimag(spectrum(k)) + aimag(spectrum(l))]
         differences = [real(spectrum(k), wp) - real(spectrum(l), wp), aimag(spectrum(k)) - aimag(spectrum(l))]
         even = [sums(1), differences(2)]
         odd(1) = differences(1)*real(turns(k - 1), wp) + sums(2)*aimag(turns(k - 1))
         odd(2) = sums(2)*real(turns(k - 1), wp) - differences(1)*aimag(turns(k - 1))
         spectrum(k) = cmplx(even(1) + odd(1), even(2) + odd(2), wp)
         spectrum(l) = cmplx(even(1) - odd(1), odd(2) - even(2), wp)
      end do
      call c_f_pointer(c_loc(values), pairs, [half])
      call complex_transform(backward, spectrum(:half), pairs)
      if (.not. is_cached) deallocate (turns)
   end subroutine back_transform

   !> Whether an address is aligned for vector instructions.
   logical function is_aligned(address)
      type(c_ptr), intent(in) :: address

      is_aligned = modulo(transfer(address, boundary), boundary) == 0
   end function is_aligned

   !> Smallest length, at least `at_least` and 16, that is 1, 5, 15, 25 or 75 times a power of 2: few plans serve many lengths, and
   !> 3, 7 and 9 times a power are slower in FFTW than the next longer one.
   pure integer function fast_length(at_least)
      integer, intent(in) :: at_least
      integer, parameter :: odd(5) = [1, 5, 15, 25, 75]
      integer :: i, length

      fast_length = huge(1)
      do i = 1, size(odd)
         length = 2*odd(i)
         do while (length < max(at_least, 16))
            length = 2*length
         end do
         fast_length = min(fast_length, length)
      end do
   end function fast_length

   !> Whether a transform of this length is fast: it is even, and has no prime factors beyond 7.
   pure logical function is_fast(length)
      integer, intent(in) :: length
      integer, parameter :: factors(4) = [2, 3, 5, 7]
      integer :: i, rest

      rest = length
      do i = 1, size(factors)
         do while (rest > 1 .and. modulo(rest, factors(i)) == 0)
            rest = rest/factors(i)
         end do
      end do
      is_fast = rest == 1 .and. modulo(length, 2) == 0
   end function is_fast

   !> Number of plans in the cache.
   integer function plans_kept()
      integer(c_int) :: code

      code = pthread_mutex_lock(c_loc(mutex))
      plans_kept = plan_count
      code = pthread_mutex_unlock(c_loc(mutex))
   end function plans_kept

   !> Get a plan for a size and a direction. `is_cached`: it must not be destroyed. `aligned`: its arrays are aligned to 16
   !> bytes.
   subroutine get_plan(size, direction, plan, is_cached, aligned)
      integer, intent(in) :: size, direction
      type(c_ptr), intent(out) :: plan
      logical, intent(out) :: is_cached
      logical, intent(in) :: aligned
      integer(c_int) :: code
      integer :: i

      code = pthread_mutex_lock(c_loc(mutex))
      plan = c_null_ptr
      is_cached = .true.
      do i = 1, plan_count
         if (plans(i)%size /= size .or. plans(i)%direction /= direction .or. (plans(i)%aligned .neqv. aligned)) cycle
         plan = plans(i)%plan
         exit
      end do
      if (.not. c_associated(plan)) then
         plan = new_plan(size, direction, aligned)
         is_cached = plan_count < most_plans
         if (is_cached) then
            plan_count = plan_count + 1
            plans(plan_count) = plan_type(size, direction, aligned, plan)
         end if
      end if
      code = pthread_mutex_unlock(c_loc(mutex))
   end subroutine get_plan

   !> The factors -i exp(-pi i k/half), k = 1 to half/2. `is_cached`: they must not be deallocated.
   subroutine get_turns(half, turns, is_cached)
      integer, intent(in) :: half
      complex(wp), pointer, contiguous, intent(out) :: turns(:)
      logical, intent(out) :: is_cached
      integer(c_int) :: code
      integer :: i, k

      code = pthread_mutex_lock(c_loc(mutex))
      turns => null()
      is_cached = .true.
      do i = 1, turn_count
         if (all_turns(i)%half == half) turns => all_turns(i)%turns
      end do
      if (.not. associated(turns)) then
         allocate (turns(half/2))
         do k = 1, half/2
            turns(k) = -cmplx(sin(pi*k/half), cos(pi*k/half), wp)
         end do
         is_cached = turn_count < most_plans
         if (is_cached) then
            turn_count = turn_count + 1
            all_turns(turn_count) = turns_type(half, turns)
         end if
      end if
      code = pthread_mutex_unlock(c_loc(mutex))
   end subroutine get_turns

   !> A plan without measurements of speed.
   function new_plan(size, direction, aligned) result(plan)
      integer, intent(in) :: size, direction
      logical, intent(in) :: aligned
      type(c_ptr) :: plan
      complex(wp), allocatable :: coefficients(:), transformed(:)
      real(wp), allocatable :: values(:)
      integer(c_int) :: flags

      flags = FFTW_ESTIMATE
      if (.not. aligned) flags = ior(FFTW_ESTIMATE, FFTW_UNALIGNED)
      if (direction == to_values) then
         allocate (coefficients(size/2 + 1), values(size))
         plan = fftw_plan_dft_c2r_1d(int(size, c_int), coefficients, values, flags)
      else
         allocate (coefficients(size), transformed(size))
         plan = fftw_plan_dft_1d(int(size, c_int), coefficients, transformed, &
                                 merge(FFTW_FORWARD, FFTW_BACKWARD, direction == forward), flags)
      end if
   end function new_plan

   subroutine discard(plan)
      type(c_ptr), intent(in) :: plan
      integer(c_int) :: code

      code = pthread_mutex_lock(c_loc(mutex))
      call fftw_destroy_plan(plan)
      code = pthread_mutex_unlock(c_loc(mutex))
   end subroutine discard

end module mfv_fourier
