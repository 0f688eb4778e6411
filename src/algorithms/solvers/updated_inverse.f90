!> The inverse of a symmetric matrix to which rows (with their columns) are added and removed, in O(n^2) each.
!>
!> With a column b and a diagonal d, the inverse T of the matrix becomes (bordering; Golub and Van Loan, Matrix Computations,
!> section 2.1.4; Higham, Accuracy and Stability of Numerical Algorithms, section 14.2)
!>
!>     [ T  0 ]   1 [ y ]
!>     [ 0  0 ] + - [-1 ] [ y' -1 ],    y = T b,  s = d - b' y,
!>                s
!>
!> and without row j it becomes T - q q'/q(j), q its column j. Both changes have rank one. They are stored as pending until there
!> are `most_pending` of them, and then added together by a matrix product.
module mfv_updated_inverse
   use mfv_kinds, only: wp
   use mfv_lapack, only: dgemm, dgemv, dgetrf, dgetri
   use mfv_tolerances, only: rounding
   implicit none
   private
   public :: updated_inverse_type

   integer, parameter :: most_pending = 32

   type :: updated_inverse_type
      !> Present number of rows.
      integer :: order = 0
      !> Number of times the inverse was recomputed.
      integer :: rebuilds = 0
      !> The inverse except for the pending changes: base + sum of weight(k) vector(:, k) vector(:, k)'; leading parts of shapes
      !> (capacity, capacity), (capacity, most_pending), (most_pending).
      real(wp), allocatable, private :: base(:, :), vector(:, :), weight(:), weighed(:, :)
      integer, private :: pending = 0
      !> Rows to be added: their entries, shape (rows including these, number), products of the inverse with them, and the changes
      !> by those added so far; number of rows added so far.
      real(wp), allocatable, private :: borders(:, :), products(:, :), changes(:, :), weights(:)
      integer, private :: prepared = 0
      !> The last change: its vector and weight; the leading `order` values (before rows moved) are in use.
      real(wp), allocatable :: change(:)
      real(wp) :: change_weight = 0.0_wp
   contains
      procedure :: clear
      procedure :: prepare
      procedure :: add_prepared
      procedure :: remove
      procedure :: column
      procedure :: multiply
      procedure :: rebuild
   end type updated_inverse_type

contains

   !> Remove all rows; the storage is retained.
   subroutine clear(self)
      class(updated_inverse_type), intent(inout) :: self

      self%order = 0
      self%pending = 0
   end subroutine clear

   !> Prepare to add `number` rows: products with all of them together cost little more than with one. `borders`: their entries in
   !> the present and the new rows, shape (order + number, number). Must be followed by `number` calls of add_prepared, without
   !> other changes in between.
   subroutine prepare(self, borders)
      class(updated_inverse_type), intent(inout) :: self
      real(wp), intent(in) :: borders(:, :)
      integer, parameter :: panel = 32
      integer :: c, first, n, number, rows, total

      n = self%order
      total = size(borders, 1)
      number = size(borders, 2)
      call reserve(self, total)
      self%prepared = 0
      self%borders = borders
      if (allocated(self%products)) deallocate (self%products, self%changes, self%weights)
      allocate (self%products(total, number), self%changes(total, number), source=0.0_wp)
      allocate (self%weights(number))
      if (n == 0) return
      rows = size(self%base, 1)
      ! Panels of columns that fit into the cache are faster than one narrow matrix product.
      do first = 1, n, panel
         do c = 1, number
            call dgemv('N', n, min(panel, n - first + 1), 1.0_wp, self%base(1, first), rows, self%borders(first, c), 1, 1.0_wp, &
                       self%products(1, c), 1)
         end do
      end do
      do c = 1, number
         call add_pending(self, self%borders(:n, c), self%products(:n, c))
      end do
   end subroutine prepare

   !> Append the next prepared row. `singular`: the larger matrix has no inverse; nothing is changed.
   subroutine add_prepared(self, singular)
      class(updated_inverse_type), intent(inout) :: self
      logical, intent(out) :: singular
      real(wp) :: pivot
      integer :: c, d, n

      n = self%order
      c = self%prepared + 1
      associate (product => self%products(:n, c), border => self%borders(:n, c))
         do d = 1, c - 1
            product = product + self%weights(d)*dot_product(self%changes(:n, d), border)*self%changes(:n, d)
         end do
         pivot = self%borders(n + 1, c) - dot_product(border, product)
         singular = abs(pivot) <= rounding*max(abs(self%borders(n + 1, c)), abs(self%borders(n + 1, c) - pivot))
         if (singular) return
         self%change(:n) = product
      end associate
      self%change(n + 1) = -1.0_wp
      self%changes(:n + 1, c) = self%change(:n + 1)
      self%weights(c) = 1.0_wp/pivot
      self%prepared = c
      self%base(:n + 1, n + 1) = 0.0_wp
      self%base(n + 1, :n) = 0.0_wp
      self%vector(n + 1, :self%pending) = 0.0_wp
      self%order = n + 1
      call append(self, 1.0_wp/pivot)
   end subroutine add_prepared

   !> Remove row `row`; the last row takes its place. `singular`: the smaller matrix has no inverse.
   subroutine remove(self, row, singular)
      class(updated_inverse_type), intent(inout) :: self
      integer, intent(in) :: row
      logical, intent(out) :: singular
      real(wp), parameter :: nothing = 1.0e-15_wp
      integer :: n

      n = self%order
      call self%column(row, self%change(:n))
      singular = abs(self%change(row)) <= nothing*maxval(abs(self%change(:n)))
      if (singular) return
      call append(self, -1.0_wp/self%change(row))
      if (row < n) then
         self%base(:n, row) = self%base(:n, n)
         self%base(row, :n) = self%base(n, :n)
         self%vector(row, :self%pending) = self%vector(n, :self%pending)
      end if
      self%order = n - 1
   end subroutine remove

   !> Column `number` of the inverse, shape (order).
   subroutine column(self, number, values)
      class(updated_inverse_type), intent(in) :: self
      integer, intent(in) :: number
      real(wp), intent(out) :: values(:)
      integer :: n

      n = self%order
      values = self%base(:n, number)
      if (self%pending == 0) return
      associate (factors => self%weight(:self%pending)*self%vector(number, :self%pending))
         call dgemv('N', n, self%pending, 1.0_wp, self%vector, size(self%vector, 1), factors, 1, 1.0_wp, values, 1)
      end associate
   end subroutine column

   !> The inverse times `right`, shapes (order). A right side with few nonzero entries costs only their columns.
   subroutine multiply(self, right, product)
      class(updated_inverse_type), intent(in) :: self
      real(wp), intent(in) :: right(:)
      real(wp), intent(out) :: product(:)
      integer, parameter :: few = 6
      integer :: j, n, filled

      n = self%order
      product = 0.0_wp
      if (n == 0) return
      filled = count(abs(right) > 0.0_wp)
      if (filled <= few) then
         do j = 1, n
            if (abs(right(j)) > 0.0_wp) product = product + right(j)*self%base(:n, j)
         end do
      else
         call dgemv('N', n, n, 1.0_wp, self%base, size(self%base, 1), right, 1, 0.0_wp, product, 1)
      end if
      call add_pending(self, right, product)
   end subroutine multiply

   !> Add the pending products times `right` to `product`, shapes (order).
   subroutine add_pending(self, right, product)
      class(updated_inverse_type), intent(in) :: self
      real(wp), intent(in) :: right(:)
      real(wp), intent(inout) :: product(:)
      real(wp) :: coefficients(most_pending)

      if (self%pending == 0) return
      associate (n => self%order, rows => size(self%vector, 1), k => self%pending)
         call dgemv('T', n, k, 1.0_wp, self%vector, rows, right, 1, 0.0_wp, coefficients, 1)
         coefficients(:k) = self%weight(:k)*coefficients(:k)
         call dgemv('N', n, k, 1.0_wp, self%vector, rows, coefficients, 1, 1.0_wp, product, 1)
      end associate
   end subroutine add_pending

   !> Compute the inverse of `matrix`, shape (n, n). `singular`: it has none.
   subroutine rebuild(self, matrix, singular)
      class(updated_inverse_type), intent(inout) :: self
      real(wp), intent(in) :: matrix(:, :)
      logical, intent(out) :: singular
      integer, allocatable :: pivots(:)
      real(wp), allocatable :: work(:)
      integer, parameter :: block = 64
      integer :: info, n

      n = size(matrix, 1)
      call self%clear()
      call reserve(self, max(n, 1))
      self%rebuilds = self%rebuilds + 1
      singular = .false.
      if (n == 0) return
      allocate (pivots(n), work(block*n))
      self%base(:n, :n) = matrix
      call dgetrf(n, n, self%base, size(self%base, 1), pivots, info)
      if (info == 0) call dgetri(n, self%base, size(self%base, 1), pivots, work, size(work), info)
      singular = info /= 0
      if (singular) return
      self%base(:n, :n) = 0.5_wp*(self%base(:n, :n) + transpose(self%base(:n, :n)))
      self%order = n
   end subroutine rebuild

   !> Reserve storage for `rows` rows.
   subroutine reserve(self, rows)
      class(updated_inverse_type), intent(inout) :: self
      integer, intent(in) :: rows
      integer, parameter :: least = 32
      real(wp), allocatable :: wider(:, :), longer(:, :)
      integer :: capacity, n

      capacity = 0
      if (allocated(self%base)) capacity = size(self%base, 1)
      if (rows <= capacity) return
      n = self%order
      capacity = max(rows + rows/4, least)
      allocate (wider(capacity, capacity), longer(capacity, most_pending))
      if (n > 0) then
         wider(:n, :n) = self%base(:n, :n)
         longer(:n, :self%pending) = self%vector(:n, :self%pending)
      end if
      call move_alloc(wider, self%base)
      call move_alloc(longer, self%vector)
      if (allocated(self%change)) deallocate (self%change, self%weighed)
      allocate (self%change(capacity), self%weighed(capacity, most_pending))
      if (.not. allocated(self%weight)) allocate (self%weight(most_pending))
   end subroutine reserve

   !> Add the rank-one change of `change` to the pending ones; apply these when there are many.
   subroutine append(self, weight)
      class(updated_inverse_type), intent(inout) :: self
      real(wp), intent(in) :: weight
      integer :: k, n, rows

      n = self%order
      self%change_weight = weight
      self%pending = self%pending + 1
      self%weight(self%pending) = weight
      self%vector(:n, self%pending) = self%change(:n)
      if (self%pending < most_pending) return
      do k = 1, most_pending
         self%weighed(:n, k) = self%weight(k)*self%vector(:n, k)
      end do
      rows = size(self%base, 1)
      call dgemm('N', 'T', n, n, most_pending, 1.0_wp, self%weighed, rows, self%vector, rows, 1.0_wp, self%base, rows)
      self%pending = 0
   end subroutine append

end module mfv_updated_inverse
