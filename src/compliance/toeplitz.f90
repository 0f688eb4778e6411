!> Products with symmetric Toeplitz matrices by FFTW, of order n log n. The matrix is embedded in a circulant one, which the
!> Fourier transform diagonalises (Golub and Van Loan, Matrix Computations, section 4.8).
!>
!> Two real vectors x and y share one complex transform, as z = x + i y. With the transform Z and its mirror image
!> Z*(k) = conj(Z(N-k)), that of x is (Z + Z*)/2 and that of y (Z - Z*)/(2 i), so that
!>
!>     X = A x - B y,    Y = B x + C y     (A, C even, B odd in the distance)
!>
!> is the inverse transform of [(A^ + C^)/2 - B^] Z + (A^ - C^)/2 Z*, X its real and Y its imaginary part, with the real
!> numbers A^, C^ (cosine sums) and B^ (sine sum).
module mfv_toeplitz
   use mfv_fourier, only: back_transform, backward, complex_transform, fast_length, forward, is_fast, real_transform
   use mfv_kinds, only: wp
   implicit none
   private
   public :: toeplitz_type, new_toeplitz

   type :: toeplitz_type
      private
      !> Vectors of `nodes` values, transforms of `length`.
      integer :: nodes = 0, length = 0
      !> Multipliers of the transform and of its mirror image, divided by the length; the second is unallocated if zero. Shape
      !> (length).
      real(wp), allocatable :: straight(:), mirrored(:)
      !> Whether there is a B: X depends on y, and Y on x.
      logical :: coupled = .false.
   contains
      procedure :: multiply
      procedure :: multiply_odd
   end type toeplitz_type

contains

   !> From the entries by distance 0, 1, ..., n-1, shape (n): the even A, the odd B (its sign that of row minus column) and
   !> the even C; if omitted, B is zero and C equals A. `repeats`: whether distances 1 and n-1, 2 and n-2, ... have the same entries
   !> (only with A alone), so that the matrix is circulant itself.
   type(toeplitz_type) function new_toeplitz(even, odd, other, repeats) result(self)
      real(wp), intent(in) :: even(:)
      real(wp), intent(in), optional :: odd(:), other(:)
      logical, intent(in), optional :: repeats
      complex(wp), allocatable :: work(:), spectrum(:)
      integer :: n

      n = size(even)
      self%nodes = n
      self%length = fast_length(2*n - 1)
      if (present(repeats)) then
         if (repeats .and. is_fast(n)) self%length = n
      end if
      allocate (work(self%length), spectrum(self%length))
      work = 0.0_wp
      work(:n) = even
      work(self%length:self%length - n + 2:-1) = even(2:)
      if (present(other)) then
         work(:n) = work(:n) + cmplx(0.0_wp, other, wp)
         work(self%length:self%length - n + 2:-1) = work(self%length:self%length - n + 2:-1) + cmplx(0.0_wp, other(2:), wp)
      end if
      call complex_transform(forward, work, spectrum)
      if (present(other)) then
         self%straight = 0.5_wp*(real(spectrum, wp) + aimag(spectrum))/self%length
         self%mirrored = 0.5_wp*(real(spectrum, wp) - aimag(spectrum))/self%length
      else
         self%straight = real(spectrum, wp)/self%length
      end if
      self%coupled = present(odd)
      if (.not. self%coupled) return
      work = 0.0_wp
      work(2:n) = odd(2:)
      work(self%length:self%length - n + 2:-1) = -odd(2:)
      call complex_transform(forward, work, spectrum)
      ! The transform of an odd sequence is i times B^.
      self%straight = self%straight - aimag(spectrum)/self%length
   end function new_toeplitz

   !> X and Y of x and y, all of shape (nodes).
   subroutine multiply(self, x, by_x, y, by_y)
      class(toeplitz_type), intent(in) :: self
      real(wp), intent(in) :: x(:), y(:)
      real(wp), intent(out) :: by_x(:), by_y(:)
      integer, parameter :: short = 512
      complex(wp) :: nearby(short, 2)
      complex(wp), allocatable :: work(:, :)

      if (do_not_mix(self) .and. .not. any(abs(x) > 0.0_wp)) then
         by_x = 0.0_wp
         call multiply_one(self, .false., y, by_y)
      else if (do_not_mix(self) .and. .not. any(abs(y) > 0.0_wp)) then
         by_y = 0.0_wp
         call multiply_one(self, .false., x, by_x)
      else if (self%length <= short) then
         call multiply_in(self, nearby(:self%length, 1), nearby(:self%length, 2), x, by_x, y, by_y)
      else
         allocate (work(self%length, 2))
         call multiply_in(self, work(:, 1), work(:, 2), x, by_x, y, by_y)
      end if
   end subroutine multiply

   !> Whether x and y do not mix: A = C and B = 0.
   pure logical function do_not_mix(self)
      class(toeplitz_type), intent(in) :: self

      do_not_mix = .not. (allocated(self%mirrored) .or. self%coupled)
   end function do_not_mix

   !> -B y, of shape (nodes), of a matrix with B only (A and C are zero).
   subroutine multiply_odd(self, y, by_y)
      class(toeplitz_type), intent(in) :: self
      real(wp), intent(in) :: y(:)
      real(wp), intent(out) :: by_y(:)

      call multiply_one(self, .true., y, by_y)
   end subroutine multiply_odd

   !> A times x or, if `odd`, -B times x, both of shape (nodes), by transforms of half the length.
   subroutine multiply_one(self, odd, x, by_x)
      class(toeplitz_type), intent(in) :: self
      logical, intent(in) :: odd
      real(wp), intent(in) :: x(:)
      real(wp), intent(out) :: by_x(:)
      real(wp) :: values(self%length)
      complex(wp) :: spectrum(self%length/2 + 1)
      integer :: k

      values(:self%nodes) = x
      values(self%nodes + 1:) = 0.0_wp
      call real_transform(values, spectrum)
      do k = 1, size(spectrum)
         spectrum(k) = cmplx(self%straight(k)*real(spectrum(k), wp), self%straight(k)*aimag(spectrum(k)), wp)
         if (odd) spectrum(k) = cmplx(-aimag(spectrum(k)), real(spectrum(k), wp), wp)
      end do
      call back_transform(spectrum, values)
      by_x = values(:self%nodes)
   end subroutine multiply_one

   !> The same as multiply with the work spaces `values` and `work`, shape (length).
   subroutine multiply_in(self, values, work, x, by_x, y, by_y)
      class(toeplitz_type), intent(in) :: self
      complex(wp), intent(inout), contiguous :: values(:), work(:)
      real(wp), intent(in) :: x(:), y(:)
      real(wp), intent(out) :: by_x(:), by_y(:)
      complex(wp) :: here, there
      real(wp) :: factor, largest_x, largest_y
      logical :: alike
      integer :: k, n, length

      n = self%nodes
      length = self%length
      alike = do_not_mix(self)
      factor = 1.0_wp
      largest_x = 1.0_wp
      largest_y = 1.0_wp
      if (alike) call find_evening(x, y, largest_x, largest_y, factor)
      values(:n) = cmplx(x, factor*y, wp)
      values(n + 1:) = 0.0_wp
      call complex_transform(forward, values, work)
      if (allocated(self%mirrored)) then
         work(1) = self%straight(1)*work(1) + self%mirrored(1)*conjg(work(1))
         do k = 2, length/2 + 1
            here = work(k)
            there = work(length + 2 - k)
            work(length + 2 - k) = self%straight(length + 2 - k)*there + self%mirrored(length + 2 - k)*conjg(here)
            work(k) = self%straight(k)*here + self%mirrored(k)*conjg(there)
         end do
      else
         ! Real times complex numbers, which the compiler would multiply as complex ones.
         work = cmplx(self%straight*real(work, wp), self%straight*aimag(work), wp)
      end if
      call complex_transform(backward, work, values)
      by_x = real(values(:n), wp)
      by_y = aimag(values(:n))/factor
      if (.not. largest_x > 0.0_wp) by_x = 0.0_wp
      if (.not. largest_y > 0.0_wp) by_y = 0.0_wp
   end subroutine multiply_in

   !> Largest magnitudes in x and y, and a power of two that scales y to the magnitude of x, so that the smaller one keeps its
   !> digits.
   pure subroutine find_evening(x, y, largest_x, largest_y, factor)
      real(wp), intent(in) :: x(:), y(:)
      real(wp), intent(out) :: largest_x, largest_y, factor
      integer, parameter :: most = 500
      integer :: i

      largest_x = 0.0_wp
      largest_y = 0.0_wp
      do i = 1, size(x)
         largest_x = max(largest_x, abs(x(i)))
         largest_y = max(largest_y, abs(y(i)))
      end do
      factor = 1.0_wp
      if (largest_x > 0.0_wp .and. largest_y > 0.0_wp) &
         factor = scale(1.0_wp, min(max(exponent(largest_x) - exponent(largest_y), -most), most))
   end subroutine find_evening

end module mfv_toeplitz
