!> A symmetric linear system with constraints that are added and removed.
!>
!> The system A x = b + sum over c of lambda(c) e(slot(c)) has an unknown lambda on the right side of the rows `slot`, and an equal
!> number of constraints,
!>
!>     x(slot) - slope x(partner) - stiffness lambda = value.
!>
!> For one solution lambda may also act on other rows, in proportion (spread). With the inverse T of A (mfv_updated_inverse) and its
!> columns Q = T e(slot), the unknowns lambda follow from the small system S
!> = Q(slot, :) - slope Q(partner, :) - stiffness, whose inverse is stored and updated too. A constraint costs a column of T and a
!> number of operations proportional to the entries of S; removing all constraints costs nothing.
module mfv_constrained_inverse
   use mfv_kinds, only: wp
   use mfv_lapack, only: dgemv, dger, dgetrf, dgetri
   use mfv_updated_inverse, only: updated_inverse_type
   implicit none
   private
   public :: constrained_inverse_type

   !> A constraint; partner 0: none.
   type :: constraint_type
      integer :: slot = 0, partner = 0
      real(wp) :: slope = 0.0_wp, stiffness = 0.0_wp
   end type constraint_type

   type :: constrained_inverse_type
      type(updated_inverse_type) :: inverse
      !> The constraints, shape (capacity); the first `constraints` ones are in use.
      integer :: constraints = 0
      type(constraint_type), allocatable :: constraint(:)
      !> Columns of the inverse, shape (rows, constraints), and the inverse of S, shape (constraints, constraints); leading parts.
      !> `stale`: the inverse of S must be recomputed.
      real(wp), allocatable, private :: columns(:, :), small(:, :)
      logical, private :: stale = .false.
   contains
      procedure :: clear
      procedure :: add_unknowns
      procedure :: remove_unknown
      procedure :: add_constraint
      procedure :: release
      procedure :: release_all
      procedure :: postpone
      procedure :: change_constraint
      procedure :: spread
      procedure :: refresh
      procedure :: solve
   end type constrained_inverse_type

   !> Pivots below this fraction of their terms count as zero.
   real(wp), parameter :: no_pivot = 1.0e-12_wp

contains

   !> Remove all unknowns and constraints.
   subroutine clear(self)
      class(constrained_inverse_type), intent(inout) :: self

      call self%inverse%clear()
      call self%release_all()
   end subroutine clear

   !> Append unknowns; `borders`: see mfv_updated_inverse. `singular`: not possible; the object is then invalid.
   subroutine add_unknowns(self, borders, singular)
      class(constrained_inverse_type), intent(inout) :: self
      real(wp), intent(in) :: borders(:, :)
      logical, intent(out) :: singular
      integer :: i

      singular = .false.
      call reserve(self, size(borders, 1), self%constraints)
      call self%inverse%prepare(borders)
      do i = 1, size(borders, 2)
         call self%inverse%add_prepared(singular)
         if (singular) return
         self%columns(self%inverse%order, :self%constraints) = 0.0_wp
         call apply_change(self, self%inverse%order)
      end do
   end subroutine add_unknowns

   !> Remove unknown `row`, which no constraint refers to; the last one takes its place.
   subroutine remove_unknown(self, row, singular)
      class(constrained_inverse_type), intent(inout) :: self
      integer, intent(in) :: row
      logical, intent(out) :: singular
      integer :: last

      last = self%inverse%order
      call self%inverse%remove(row, singular)
      if (singular) return
      call apply_change(self, last)
      associate (k => self%constraints)
         if (k == 0) return
         self%columns(row, :k) = self%columns(last, :k)
         where (self%constraint(:k)%slot == last) self%constraint(:k)%slot = row
         where (self%constraint(:k)%partner == last) self%constraint(:k)%partner = row
      end associate
   end subroutine remove_unknown

   !> Apply the last change of the inverse, of `rows` rows, to the columns and to S.
   subroutine apply_change(self, rows)
      class(constrained_inverse_type), intent(inout) :: self
      integer, intent(in) :: rows
      real(wp), dimension(self%constraints) :: left, right, by_left, by_right
      real(wp) :: pivot
      integer :: c, k

      k = self%constraints
      if (k == 0) return
      associate (change => self%inverse%change, weight => self%inverse%change_weight)
         right = [(change(self%constraint(c)%slot), c=1, k)]
         call dger(rows, k, weight, change, 1, right, 1, self%columns, size(self%columns, 1))
         if (self%stale) return
         left = functional(self, change)
         call dgemv('N', k, k, 1.0_wp, self%small, size(self%small, 1), left, 1, 0.0_wp, by_left, 1)
         call dgemv('T', k, k, 1.0_wp, self%small, size(self%small, 1), right, 1, 0.0_wp, by_right, 1)
         pivot = 1.0_wp + weight*dot_product(right, by_left)
         self%stale = abs(pivot) < no_pivot*max(1.0_wp, abs(pivot - 1.0_wp))
         if (self%stale) return
         call dger(k, k, -weight/pivot, by_left, 1, by_right, 1, self%small, size(self%small, 1))
      end associate
   end subroutine apply_change

   !> x(slot) - slope x(partner) of every constraint.
   pure function functional(self, x) result(values)
      class(constrained_inverse_type), intent(in) :: self
      real(wp), intent(in) :: x(:)
      real(wp) :: values(self%constraints)
      integer :: c

      do c = 1, self%constraints
         associate (constraint => self%constraint(c))
            values(c) = x(constraint%slot)
            if (constraint%partner > 0) values(c) = values(c) - constraint%slope*x(constraint%partner)
         end associate
      end do
   end function functional

   !> Append a constraint: see constraint_type.
   subroutine add_constraint(self, slot, partner, slope, stiffness)
      class(constrained_inverse_type), intent(inout) :: self
      integer, intent(in) :: slot, partner
      real(wp), intent(in) :: slope, stiffness
      real(wp) :: row(self%constraints)
      integer :: k, n

      n = self%inverse%order
      k = self%constraints
      call reserve(self, n, k + 1)
      self%constraint(k + 1) = constraint_type(slot, partner, slope, stiffness)
      call self%inverse%column(slot, self%columns(:n, k + 1))
      self%constraints = k + 1
      if (self%stale) return
      row = self%columns(slot, :k)
      if (partner > 0) row = row - slope*self%columns(partner, :k)
      call border_small(self, row)
   end subroutine add_constraint

   !> Update the inverse of S for a new last row and column.
   subroutine border_small(self, row)
      class(constrained_inverse_type), intent(inout) :: self
      real(wp), intent(in) :: row(:)
      real(wp), dimension(size(row)) :: by_column, by_row
      real(wp) :: diagonal, pivot, column(size(row) + 1)
      integer :: k, capacity

      k = size(row)
      capacity = size(self%small, 1)
      column = functional(self, self%columns(:self%inverse%order, k + 1))
      diagonal = column(k + 1) - self%constraint(k + 1)%stiffness
      call dgemv('N', k, k, 1.0_wp, self%small, capacity, column, 1, 0.0_wp, by_column, 1)
      call dgemv('T', k, k, 1.0_wp, self%small, capacity, row, 1, 0.0_wp, by_row, 1)
      pivot = diagonal - dot_product(row, by_column)
      self%stale = abs(pivot) <= no_pivot*max(abs(diagonal), abs(diagonal - pivot))
      if (self%stale) return
      call dger(k, k, 1.0_wp/pivot, by_column, 1, by_row, 1, self%small, capacity)
      self%small(:k, k + 1) = -by_column/pivot
      self%small(k + 1, :k) = -by_row/pivot
      self%small(k + 1, k + 1) = 1.0_wp/pivot
   end subroutine border_small

   !> Remove constraint `number`; the last one takes its place.
   subroutine release(self, number)
      class(constrained_inverse_type), intent(inout) :: self
      integer, intent(in) :: number
      real(wp), dimension(self%constraints) :: column, row
      real(wp) :: pivot
      integer :: k, n

      k = self%constraints
      n = self%inverse%order
      if (.not. self%stale) then
         pivot = self%small(number, number)
         self%stale = abs(pivot) <= no_pivot*maxval(abs(self%small(:k, number)))
         if (.not. self%stale) then
            column = self%small(:k, number)
            row = self%small(number, :k)
            call dger(k, k, -1.0_wp/pivot, column, 1, row, 1, self%small, size(self%small, 1))
            self%small(:k, number) = self%small(:k, k)
            self%small(number, :k) = self%small(k, :k)
         end if
      end if
      self%constraint(number) = self%constraint(k)
      self%columns(:n, number) = self%columns(:n, k)
      self%constraints = k - 1
      if (k == 1) self%stale = .false.
   end subroutine release

   !> Remove all constraints.
   subroutine release_all(self)
      class(constrained_inverse_type), intent(inout) :: self

      self%constraints = 0
      self%stale = .false.
   end subroutine release_all

   !> Recompute the inverse of S when it is next needed, before many constraints are removed.
   subroutine postpone(self)
      class(constrained_inverse_type), intent(inout) :: self

      self%stale = self%constraints > 0
   end subroutine postpone

   !> Change the coefficients of constraint `number`.
   subroutine change_constraint(self, number, slope, stiffness)
      class(constrained_inverse_type), intent(inout) :: self
      integer, intent(in) :: number
      real(wp), intent(in) :: slope, stiffness

      self%constraint(number)%slope = slope
      self%constraint(number)%stiffness = stiffness
      self%stale = .true.
   end subroutine change_constraint

   !> Let the unknown of constraint `number` act on all rows with these `weights`, shape (rows), instead of on its slot alone
   !> (weight 1). Unknowns and constraints can be changed only while all of them act on their slots alone.
   subroutine spread(self, number, weights)
      class(constrained_inverse_type), intent(inout) :: self
      integer, intent(in) :: number
      real(wp), intent(in) :: weights(:)
      real(wp) :: column(size(weights)), row(self%constraints), by_column(self%constraints), pivot
      integer :: k

      k = self%constraints
      column = self%columns(:size(weights), number)
      call self%inverse%multiply(weights, self%columns(:size(weights), number))
      if (self%stale) return
      call dgemv('N', k, k, 1.0_wp, self%small, size(self%small, 1), &
                 functional(self, self%columns(:size(weights), number) - column), 1, 0.0_wp, by_column, 1)
      pivot = 1.0_wp + by_column(number)
      self%stale = abs(pivot) < no_pivot*max(1.0_wp, abs(pivot - 1.0_wp))
      if (self%stale) return
      row = self%small(number, :k)
      call dger(k, k, -1.0_wp/pivot, by_column, 1, row, 1, self%small, size(self%small, 1))
   end subroutine spread

   !> Recompute the inverse of `matrix`, shape (unknowns, unknowns), its columns and S. `singular`: it has no inverse.
   subroutine refresh(self, matrix, singular)
      class(constrained_inverse_type), intent(inout) :: self
      real(wp), intent(in) :: matrix(:, :)
      logical, intent(out) :: singular
      integer :: c

      call self%inverse%rebuild(matrix, singular)
      if (singular) return
      call reserve(self, self%inverse%order, self%constraints)
      do c = 1, self%constraints
         call self%inverse%column(self%constraint(c)%slot, self%columns(:self%inverse%order, c))
      end do
      self%stale = self%constraints > 0
   end subroutine refresh

   !> Solve for x with the right side `right`, shape (unknowns), and the values of the constraints, shape (constraints).
   !> `singular`: the constraints do not determine x.
   subroutine solve(self, right, values, x, singular)
      class(constrained_inverse_type), intent(inout) :: self
      real(wp), intent(in) :: right(:), values(:)
      real(wp), intent(out) :: x(:)
      logical, intent(out) :: singular
      real(wp), dimension(self%constraints) :: missing, lambda
      integer :: k, n

      singular = .false.
      n = self%inverse%order
      k = self%constraints
      call self%inverse%multiply(right, x)
      if (k == 0) return
      if (self%stale) call rebuild_small(self, singular)
      if (singular) return
      missing = values - functional(self, x)
      call dgemv('N', k, k, 1.0_wp, self%small, size(self%small, 1), missing, 1, 0.0_wp, lambda, 1)
      call dgemv('N', n, k, 1.0_wp, self%columns, size(self%columns, 1), lambda, 1, 1.0_wp, x, 1)
   end subroutine solve

   !> The inverse of S from the columns.
   subroutine rebuild_small(self, singular)
      class(constrained_inverse_type), intent(inout) :: self
      logical, intent(out) :: singular
      integer, parameter :: block = 32
      integer :: pivots(self%constraints), c, info, k
      real(wp) :: work(block*self%constraints)

      k = self%constraints
      do c = 1, k
         self%small(:k, c) = functional(self, self%columns(:, c))
         self%small(c, c) = self%small(c, c) - self%constraint(c)%stiffness
      end do
      call dgetrf(k, k, self%small, size(self%small, 1), pivots, info)
      if (info == 0) call dgetri(k, self%small, size(self%small, 1), pivots, work, size(work), info)
      singular = info /= 0
      self%stale = singular
   end subroutine rebuild_small

   !> Reserve storage for `rows` unknowns and `constraints` constraints.
   subroutine reserve(self, rows, constraints)
      class(constrained_inverse_type), intent(inout) :: self
      integer, intent(in) :: rows, constraints
      integer, parameter :: least = 32
      type(constraint_type), allocatable :: constraint(:)
      real(wp), allocatable :: columns(:, :), small(:, :)
      integer :: capacity(2), wanted(2), k, n

      capacity = 0
      if (allocated(self%columns)) capacity = shape(self%columns)
      wanted = [rows, constraints]
      if (all(wanted <= capacity)) return
      n = min(self%inverse%order, capacity(1))
      where (wanted > capacity) capacity = max(wanted + wanted/4, least)
      k = self%constraints
      allocate (columns(capacity(1), capacity(2)), small(capacity(2), capacity(2)), constraint(capacity(2)))
      if (k > 0) then
         columns(:n, :k) = self%columns(:n, :k)
         small(:k, :k) = self%small(:k, :k)
         constraint(:k) = self%constraint(:k)
      end if
      call move_alloc(columns, self%columns)
      call move_alloc(small, self%small)
      call move_alloc(constraint, self%constraint)
   end subroutine reserve

end module mfv_constrained_inverse
