!> The inverse of a symmetric positive definite Toeplitz matrix T(i, j) = t(|i - j|) of variable order, in memory O(n).
!>
!> The inverse is determined by one vector (Gohberg and Semencul 1972): with the monic predictor a, T a = (E, 0, ..., 0), a(1) = 1,
!>
!>     T^-1 = [ L(a) L(a)^T - L(b) L(b)^T ]/E,    b = (0, a(m), ..., a(2)),
!>
!> L(a): the lower triangular Toeplitz matrix with the first column a. A product with it takes transforms of twice the order.
!> Levinson's recursion changes the order of the predictor by one in O(m), up and down (Golub and Van Loan, Matrix
!> Computations, 4th edition, section 4.7), which is cheap for a contact that changes by single nodes. For larger changes the
!> predictor is computed in O(m log m) by conjugate gradients with a circulant preconditioner (Chan and Ng, SIAM Review 38, 1996).
!> For the logarithmic kernel of mfv_krylov_preconditioner this takes 13 to 15 iterations from 500 to 65,536 nodes.
module mfv_toeplitz_inverse
   use mfv_fourier, only: back_transform, backward, complex_transform, fast_length, forward, real_transform
   use mfv_kinds, only: wp
   implicit none
   private
   public :: toeplitz_inverse_type

   type :: toeplitz_inverse_type
      integer :: order = 0
      !> The predictor a, shape (at least order), and E.
      real(wp), allocatable :: predictor(:)
      real(wp) :: error = 1.0_wp
      !> Length of the transforms; 0: the spectra of a and b, shape (length/2 + 1), are not up to date.
      integer :: length = 0
      complex(wp), allocatable :: forward(:), backward(:)
      !> Work space, shapes (length) and (length/2 + 1).
      real(wp), allocatable :: values(:)
      complex(wp), allocatable :: pairs(:), others(:), spectrum(:)
   contains
      procedure :: set_order
      procedure :: apply
      procedure :: copy_order
   end type toeplitz_inverse_type

contains

   !> Set the order of the matrix with the entries `kernel`(distance + 1), shape (at least order). The kernel must be the same in
   !> all calls, unless the order was set to 0 in between.
   subroutine set_order(self, kernel, order)
      class(toeplitz_inverse_type), intent(inout) :: self
      real(wp), intent(in) :: kernel(:)
      integer, intent(in) :: order

      if (order == self%order) return
      self%length = 0
      call make_room(self, order)
      if (is_far(self%order, order)) call find_predictor(self, kernel, order)
      ! To much lower orders from the first one.
      if (real(self%order, wp)**2 > 2.0_wp*real(order, wp)**2) self%order = 0
      if (self%order == 0 .and. order > 0) then
         self%order = 1
         self%predictor(1) = 1.0_wp
         self%error = kernel(1)
      end if
      do while (self%order < order)
         call step_up(self, kernel)
      end do
      do while (self%order > order .and. self%order > 0)
         call step_down(self)
      end do
   end subroutine set_order

   !> Copy the order of another inverse with the same kernel.
   subroutine copy_order(self, other)
      class(toeplitz_inverse_type), intent(inout) :: self
      class(toeplitz_inverse_type), intent(in) :: other

      call make_room(self, other%order)
      self%predictor(:other%order) = other%predictor(:other%order)
      self%order = other%order
      self%error = other%error
      self%length = 0
   end subroutine copy_order

   !> Reserve storage for a predictor of `order` with a margin; its values are retained.
   subroutine make_room(self, order)
      class(toeplitz_inverse_type), intent(inout) :: self
      integer, intent(in) :: order
      real(wp), allocatable :: wider(:)

      if (allocated(self%predictor)) then
         if (size(self%predictor) >= order) return
      end if
      allocate (wider(order + order/4 + 8), source=0.0_wp)
      if (self%order > 0) wider(:self%order) = self%predictor(:self%order)
      call move_alloc(wider, self%predictor)
   end subroutine make_room

   !> Whether Levinson's recursion from the order `from` to `to` takes longer than conjugate gradients, as measured: a step of the
   !> recursion to the order m takes m units, the iteration `transforms`*m*log2(m) units.
   pure logical function is_far(from, to)
      integer, intent(in) :: from, to
      real(wp), parameter :: transforms = 65.0_wp
      integer, parameter :: least = 300
      real(wp) :: steps

      steps = 0.5_wp*abs(real(to, wp)**2 - real(from, wp)**2)
      is_far = to >= least
      if (is_far) is_far = steps > transforms*to*log(real(to, wp))/log(2.0_wp)
   end function is_far

   !> Find the predictor of `order` by conjugate gradients, from scratch. If they do not converge, the order becomes 0.
   !> The matrix and its preconditioner are the parts, of this order, of one circulant matrix of at least twice the order and of the
   !> inverse of that matrix.
   subroutine find_predictor(self, kernel, order)
      class(toeplitz_inverse_type), intent(inout) :: self
      real(wp), intent(in) :: kernel(:)
      integer, intent(in) :: order
      integer, parameter :: most_iterations = 60
      real(wp), parameter :: enough = 1.0e-16_wp
      real(wp), allocatable :: symbol(:), inverse(:), work(:), residual(:), direction(:), image(:), solution(:)
      complex(wp), allocatable :: spectrum(:)
      real(wp) :: first, last, now, curvature
      integer :: iteration

      call make_symbol(kernel, order, symbol)
      self%order = 0
      if (.not. all(symbol > 0.0_wp)) return
      inverse = 1.0_wp/symbol
      allocate (work(2*(size(symbol) - 1)), spectrum(size(symbol)))
      allocate (residual(order), direction(order), image(order), solution(order), source=0.0_wp)
      residual(1) = 1.0_wp
      last = 1.0_wp
      first = 0.0_wp
      do iteration = 1, most_iterations
         call multiply(inverse, residual, image)
         now = dot_product(residual, image)
         if (iteration == 1) first = now
         direction = image + merge(now/last, 0.0_wp, iteration > 1)*direction
         last = now
         call multiply(symbol, direction, image)
         curvature = dot_product(direction, image)
         if (.not. (now > 0.0_wp .and. curvature > 0.0_wp)) return
         solution = solution + now/curvature*direction
         residual = residual - now/curvature*image
         if (norm2(residual) <= enough .or. now <= enough**2*first) exit
      end do
      if (iteration > most_iterations .or. .not. solution(1) > 0.0_wp) return
      self%order = order
      self%error = 1.0_wp/solution(1)
      self%predictor(:order) = solution/solution(1)

   contains

      !> Multiply by the part of a circulant matrix with the eigenvalues `factor`.
      subroutine multiply(factor, vector, image)
         real(wp), intent(in) :: factor(:), vector(:)
         real(wp), intent(out) :: image(:)

         work(:order) = vector
         work(order + 1:) = 0.0_wp
         call real_transform(work, spectrum)
         spectrum = cmplx(factor*real(spectrum, wp), factor*aimag(spectrum), wp)
         call back_transform(spectrum, work)
         image = work(:order)/size(work)
      end subroutine multiply
   end subroutine find_predictor

   !> Eigenvalues of a circulant matrix with the entries `kernel`(distance + 1) up to half its order, a fast length of at least
   !> 2*order. Shape (half its order + 1).
   subroutine make_symbol(kernel, order, symbol)
      real(wp), intent(in) :: kernel(:)
      integer, intent(in) :: order
      real(wp), allocatable, intent(out) :: symbol(:)
      real(wp), allocatable :: entries(:)
      complex(wp), allocatable :: spectrum(:)
      integer :: given, half

      half = fast_length(2*order)/2
      given = min(half + 1, size(kernel))
      allocate (entries(2*half), spectrum(half + 1))
      entries(:given) = kernel(:given)
      entries(given + 1:half + 1) = kernel(given)
      entries(half + 2:) = entries(half:2:-1)
      call real_transform(entries, spectrum)
      symbol = real(spectrum, wp)
   end subroutine make_symbol

   !> Increase the order from m to m + 1.
   subroutine step_up(self, kernel)
      class(toeplitz_inverse_type), intent(inout) :: self
      real(wp), intent(in) :: kernel(:)
      real(wp) :: reflection, low, high
      integer :: i, m

      m = self%order
      reflection = 0.0_wp
      do i = 1, m
         reflection = reflection - kernel(m + 2 - i)*self%predictor(i)
      end do
      reflection = reflection/self%error
      associate (a => self%predictor)
         a(m + 1) = 0.0_wp
         do i = 1, (m + 1)/2
            low = a(i)
            high = a(m + 2 - i)
            a(i) = low + reflection*high
            a(m + 2 - i) = high + reflection*low
         end do
         if (modulo(m, 2) == 0) a(m/2 + 1) = (1.0_wp + reflection)*a(m/2 + 1)
      end associate
      self%error = self%error*(1.0_wp - reflection)*(1.0_wp + reflection)
      self%order = m + 1
   end subroutine step_up

   !> Decrease the order from m to m - 1: the inverse recursion.
   subroutine step_down(self)
      class(toeplitz_inverse_type), intent(inout) :: self
      real(wp) :: reflection, factor, low, high
      integer :: i, m

      m = self%order
      reflection = self%predictor(m)
      factor = 1.0_wp/((1.0_wp - reflection)*(1.0_wp + reflection))
      if (m == 1) factor = 1.0_wp
      associate (a => self%predictor)
         do i = 1, m/2
            low = a(i)
            high = a(m + 1 - i)
            a(i) = factor*(low - reflection*high)
            a(m + 1 - i) = factor*(high - reflection*low)
         end do
         if (modulo(m, 2) == 1) a(m/2 + 1) = a(m/2 + 1)/(1.0_wp + reflection)
      end associate
      self%error = self%error*factor
      self%order = m - 1
   end subroutine step_down

   !> Multiply `vector`, shape (order), by the inverse. The products with L(a)^T and L(b)^T are the real and the imaginary part of
   !> one complex transform.
   subroutine apply(self, vector)
      class(toeplitz_inverse_type), intent(inout) :: self
      real(wp), intent(inout) :: vector(:)
      complex(wp) :: by_a, by_b, mirrored
      integer :: k, l, m

      m = self%order
      if (m == 0) return
      if (self%length == 0) call make_spectra(self)
      self%values(:m) = vector(:m)
      self%values(m + 1:) = 0.0_wp
      call real_transform(self%values, self%spectrum)
      do k = 1, self%length/2 + 1
         by_a = conjg(self%forward(k))*self%spectrum(k)
         by_b = conjg(self%backward(k))*self%spectrum(k)
         self%pairs(k) = cmplx(real(by_a) - aimag(by_b), aimag(by_a) + real(by_b), wp)
         if (k > 1) self%pairs(self%length + 2 - k) = cmplx(real(by_a) + aimag(by_b), real(by_b) - aimag(by_a), wp)
      end do
      call complex_transform(backward, self%pairs, self%others)
      self%others(m + 1:) = 0.0_wp
      call complex_transform(forward, self%others, self%pairs)
      do k = 1, self%length/2 + 1
         l = merge(1, self%length + 2 - k, k == 1)
         mirrored = conjg(self%pairs(l))
         by_a = 0.5_wp*(self%pairs(k) + mirrored)
         by_b = self%pairs(k) - mirrored
         by_b = 0.5_wp*cmplx(aimag(by_b), -real(by_b), wp)
         self%spectrum(k) = self%forward(k)*by_a - self%backward(k)*by_b
      end do
      call back_transform(self%spectrum, self%values)
      vector(:m) = self%values(:m)/(self%error*real(self%length, wp)**2)
   end subroutine apply

   !> Spectra of a and b.
   subroutine make_spectra(self)
      class(toeplitz_inverse_type), intent(inout) :: self
      integer :: length, m

      m = self%order
      length = fast_length(2*m)
      if (allocated(self%values)) then
         if (size(self%values) /= length) deallocate (self%values, self%pairs, self%others, self%spectrum, self%forward, &
                                                      self%backward)
      end if
      if (.not. allocated(self%values)) &
         allocate (self%values(length), self%pairs(length), self%others(length), self%spectrum(length/2 + 1), &
                   self%forward(length/2 + 1), self%backward(length/2 + 1))
      self%length = length
      self%values = 0.0_wp
      self%values(:m) = self%predictor(:m)
      call real_transform(self%values, self%forward)
      self%values = 0.0_wp
      self%values(2:m) = self%predictor(m:2:-1)
      call real_transform(self%values, self%backward)
   end subroutine make_spectra

end module mfv_toeplitz_inverse
