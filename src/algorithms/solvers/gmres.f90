!> The method of generalised minimal residuals (Saad and Schultz 1986); the caller multiplies by the matrix:
!>
!>     call gmres%start(residual)
!>     do while (gmres%residual() > target .and. .not. gmres%is_full())
!>        call gmres%direction(v)
!>        w = matrix*v
!>        call gmres%extend(w)
!>     end do
!>     call gmres%add_solution(x)
module mfv_gmres
   use mfv_kinds, only: wp
   use mfv_tolerances, only: rounding
   implicit none
   private
   public :: gmres_type

   !> Most steps before a restart.
   integer, parameter :: most_steps = 60

   type :: gmres_type
      private
      integer :: size = 0, steps = 0
      logical :: complete = .false.
      !> Orthonormal basis, shape (at least size, most_steps + 1).
      real(wp), allocatable :: basis(:, :)
      !> Triangular factor of the Hessenberg matrix, Givens rotations and the rotated right-hand side.
      real(wp) :: triangle(most_steps + 1, most_steps) = 0.0_wp
      real(wp) :: cosine(most_steps) = 0.0_wp, sine(most_steps) = 0.0_wp, right(most_steps + 1) = 0.0_wp
   contains
      procedure :: start
      procedure :: residual
      procedure :: is_full
      procedure :: direction
      procedure :: extend
      procedure :: add_solution
   end type gmres_type

contains

   !> Start from the residual of the first guess, any shape (n).
   subroutine start(self, first)
      class(gmres_type), intent(inout) :: self
      real(wp), intent(in) :: first(:)

      self%size = size(first)
      self%steps = 0
      self%complete = .false.
      if (allocated(self%basis)) then
         if (size(self%basis, 1) < self%size) deallocate (self%basis)
      end if
      if (.not. allocated(self%basis)) allocate (self%basis(self%size + self%size/4, most_steps + 1))
      self%right = 0.0_wp
      self%right(1) = norm2(first)
      if (self%right(1) > 0.0_wp) self%basis(:self%size, 1) = first/self%right(1)
      self%complete = .not. self%right(1) > 0.0_wp
   end subroutine start

   !> The 2-norm of the present residual.
   pure real(wp) function residual(self)
      class(gmres_type), intent(in) :: self

      residual = abs(self%right(self%steps + 1))
   end function residual

   !> Whether no further step is possible: the memory is full, or the solution cannot be improved.
   pure logical function is_full(self)
      class(gmres_type), intent(in) :: self

      is_full = self%complete .or. self%steps == most_steps
   end function is_full

   !> The next vector to be multiplied by the matrix, shape (n).
   pure subroutine direction(self, vector)
      class(gmres_type), intent(in) :: self
      real(wp), intent(out) :: vector(:)

      vector = self%basis(:self%size, self%steps + 1)
   end subroutine direction

   !> Extend the basis by the product with the matrix, shape (n), which is used as work space.
   subroutine extend(self, image)
      class(gmres_type), intent(inout) :: self
      real(wp), intent(inout) :: image(:)
      real(wp) :: column(most_steps + 1), length, before, turned
      integer :: i, k

      k = self%steps + 1
      associate (n => self%size)
         before = norm2(image)
         do i = 1, k
            column(i) = dot_product(self%basis(:n, i), image)
            image = image - column(i)*self%basis(:n, i)
         end do
         length = norm2(image)
         self%complete = .not. length > rounding*before
         if (.not. self%complete) self%basis(:n, k + 1) = image/length
      end associate
      do i = 1, k - 1
         turned = self%cosine(i)*column(i) + self%sine(i)*column(i + 1)
         column(i + 1) = self%cosine(i)*column(i + 1) - self%sine(i)*column(i)
         column(i) = turned
      end do
      turned = hypot(column(k), length)
      ! The direction yields no new vector: the matrix is singular.
      if (.not. turned > rounding*before) return
      self%cosine(k) = column(k)/turned
      self%sine(k) = length/turned
      column(k) = turned
      self%triangle(:k, k) = column(:k)
      self%right(k + 1) = -self%sine(k)*self%right(k)
      self%right(k) = self%cosine(k)*self%right(k)
      self%steps = k
   end subroutine extend

   !> Add the present correction to `solution`, shape (n).
   subroutine add_solution(self, solution)
      class(gmres_type), intent(in) :: self
      real(wp), intent(inout) :: solution(:)
      real(wp) :: weight(most_steps)
      integer :: i, k

      k = self%steps
      do i = k, 1, -1
         weight(i) = (self%right(i) - dot_product(self%triangle(i, i + 1:k), weight(i + 1:k)))/self%triangle(i, i)
      end do
      do i = 1, k
         solution = solution + weight(i)*self%basis(:self%size, i)
      end do
   end subroutine add_solution

end module mfv_gmres
