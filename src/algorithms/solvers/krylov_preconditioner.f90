!> Approximate inverses of the diagonal blocks C_wp and C_ut on the nodes of a contact, each in O(n log n).
!>
!> The surface of every elastic body responds to nearby tractions like a half-plane, by the logarithm of the distance. On
!> consecutive nodes this is a Toeplitz matrix with a known exact inverse (mfv_toeplitz_inverse), on several patches a matrix of
!> such blocks, whose coupling is of small rank (mfv_patched_inverse). On a half-plane the iteration then only resolves the coupling
!> of pressure and shear, whose strength does not depend on the mesh.
!>
!> Nodes held by bristles (softness c > 0, mfv_krylov_system) need 1/(C_ut + c): their rows are interpolated between circulant
!> inverses for a few values of c. Nodes whose friction decreases with slip (c < 0) are treated as independent: where the bodies
!> can unload as fast as friction decreases, |c| dominates C_ut + c.
module mfv_krylov_preconditioner
   use mfv_compliance, only: block_ut, block_wp, compliance_type
   use mfv_fourier, only: back_transform, fast_length, real_transform
   use mfv_half_plane, only: log_kernel
   use mfv_kinds, only: wp
   use mfv_patched_inverse, only: patched_inverse_type
   implicit none
   private
   public :: krylov_preconditioner_type

   !> Inverse on a set of nodes.
   type :: block_type
      type(patched_inverse_type) :: inverse
      !> The nodes, and the number of the node before the first.
      integer, allocatable :: nodes(:)
      integer :: before = 0
   end type block_type

   type :: krylov_preconditioner_type
      private
      !> Entries by distance, length^3/force in the units of the system.
      real(wp), allocatable :: kernel(:)
      !> C_ut is the kernel times this. What the entries of C_wp and C_ut next to the diagonal, and all of those of half-planes,
      !> have beyond these.
      real(wp) :: shear_ratio = 1.0_wp
      real(wp), public :: constant = 0.0_wp, shear_constant = 0.0_wp
      logical :: is_logarithmic = .false.
      !> (Both allocatable: otherwise gfortran 12 does not free the components of the second.)
      type(block_type), allocatable :: contact, held
      !> Softness of the held nodes, shape (held), if any is nonzero; weights of the levels, shape (held, 0 to levels), and the
      !> inverses of the levels, shape (length/2 + 1, levels).
      logical :: soft = .false.
      real(wp), allocatable :: softness(:), weight(:, :), symbol(:, :)
   contains
      procedure :: prepare
      procedure :: set_contact
      procedure :: set_held
      procedure :: apply_contact
      procedure :: apply_held
      procedure :: smallest
      procedure :: is_exact
   end type krylov_preconditioner_type

contains

   !> Prepare for a compliance, whose number of nodes may have changed. `unit`: of the entries of the blocks, length^3/force.
   subroutine prepare(self, compliance, unit)
      class(krylov_preconditioner_type), intent(inout) :: self
      class(compliance_type), intent(in) :: compliance
      real(wp), intent(in) :: unit
      integer :: distance, middle, n
      real(wp) :: near(1, 2), factor, least

      if (allocated(self%kernel)) then
         if (2*compliance%nodes <= size(self%kernel)) return
      end if
      n = compliance%nodes
      middle = (n + 1)/2
      near = 0.0_wp
      call compliance%entries(block_wp, [middle], [middle], near(:, 1:1))
      call compliance%entries(block_wp, [middle], [min(middle + 1, n)], near(:, 2:2))
      factor = (near(1, 1) - near(1, 2))/log_kernel(2.0_wp)
      if (.not. factor > 0.0_wp) factor = near(1, 1)/log_kernel(2.0_wp)
      ! Positive definite on surfaces shorter than four times the distance at which a force leaves no displacement.
      least = factor*(2.0_wp*log(16.0_wp*n) + 2.0_wp)
      if (allocated(self%kernel)) deallocate (self%kernel)
      allocate (self%kernel(4*n + 1))
      do distance = 0, 4*n
         self%kernel(distance + 1) = (max(near(1, 1), least) - factor*log_kernel(2.0_wp*distance))/unit
      end do
      self%constant = near(1, 1)/unit - self%kernel(1)
      self%shear_ratio = compliance%shear_ratio
      self%shear_constant = 0.0_wp
      if (compliance%has_block(block_ut)) then
         call compliance%entries(block_ut, [middle], [middle], near(:, 1:1))
         self%shear_constant = near(1, 1)/unit - self%shear_ratio*self%kernel(1)
      end if
      self%is_logarithmic = compliance%is_logarithmic
      if (allocated(self%contact)) deallocate (self%contact, self%held)
      allocate (self%contact, self%held)
   end subroutine prepare

   !> Whether the inverses are those of the blocks without the `constant` in their entries, up to round-off.
   pure logical function is_exact(self)
      class(krylov_preconditioner_type), intent(in) :: self

      is_exact = self%is_logarithmic .and. .not. self%soft
      if (is_exact) is_exact = self%contact%inverse%group_count() <= 1 .and. self%held%inverse%group_count() <= 1
   end function is_exact

   !> Approximate smallest eigenvalue of the blocks, in the units of the system.
   pure real(wp) function smallest(self)
      class(krylov_preconditioner_type), intent(in) :: self

      smallest = 0.5_wp*(self%kernel(1) - self%kernel(2))
   end function smallest

   !> Set the nodes in contact, ascending.
   subroutine set_contact(self, nodes)
      class(krylov_preconditioner_type), intent(inout) :: self
      integer, intent(in) :: nodes(:)

      call place_nodes(self%contact, nodes)
      call self%contact%inverse%set_nodes(self%kernel, nodes)
   end subroutine set_contact

   !> Set the nodes whose shear is unknown, ascending, and their softness, shape (held). (r K + c)^-1 is (K + c/r)^-1/r.
   subroutine set_held(self, nodes, softness)
      class(krylov_preconditioner_type), intent(inout) :: self
      integer, intent(in) :: nodes(:)
      real(wp), intent(in) :: softness(:)

      call place_nodes(self%held, nodes)
      call self%held%inverse%set_nodes(self%kernel, nodes, self%contact%inverse)
      self%soft = any(abs(softness) > 0.0_wp)
      if (self%soft) call set_levels(self, softness/self%shear_ratio)
   end subroutine set_held

   subroutine place_nodes(block, nodes)
      type(block_type), intent(inout) :: block
      integer, intent(in) :: nodes(:)

      block%nodes = nodes
      if (size(nodes) > 0) block%before = nodes(1) - 1
   end subroutine place_nodes

   !> Levels of softness with a constant ratio, from negligible to dominant softness, and the weights for interpolation between
   !> them.
   subroutine set_levels(self, softness)
      type(krylov_preconditioner_type), intent(inout) :: self
      real(wp), intent(in) :: softness(:)
      real(wp), parameter :: ratio = 6.0_wp, margin = 10.0_wp
      real(wp), allocatable :: values(:)
      complex(wp), allocatable :: spectrum(:)
      real(wp) :: first, place
      integer :: i, level, levels, length

      self%softness = softness
      length = fast_length(2*(self%held%nodes(size(softness)) - self%held%before))
      allocate (values(length), spectrum(length/2 + 1))
      values(:length/2 + 1) = self%kernel(:length/2 + 1)
      values(length/2 + 2:) = self%kernel(length/2:2:-1)
      call real_transform(values, spectrum)
      first = self%smallest()/margin
      levels = 1 + ceiling(log(margin*maxval(abs(real(spectrum, wp)))/first)/log(ratio))
      if (allocated(self%weight)) deallocate (self%weight, self%symbol)
      allocate (self%weight(size(softness), 0:levels), source=0.0_wp)
      allocate (self%symbol(length/2 + 1, levels))
      do level = 1, levels
         self%symbol(:, level) = 1.0_wp/(length*(max(real(spectrum, wp), self%smallest()) + first*ratio**(level - 1)))
      end do
      do i = 1, size(softness)
         place = 0.0_wp
         if (softness(i) > first/ratio) place = 1.0_wp + log(softness(i)/first)/log(ratio)
         level = min(int(place), levels)
         if (place >= levels .or. softness(i) < 0.0_wp) cycle
         self%weight(i, level) = 1.0_wp - (place - level)
         self%weight(i, level + 1) = place - level
      end do
   end subroutine set_levels

   !> Tractions of the nodes in contact by displacements, shape (contact), both in `values`.
   subroutine apply_contact(self, values)
      class(krylov_preconditioner_type), intent(inout) :: self
      real(wp), intent(inout) :: values(:)

      call self%contact%inverse%apply(values)
   end subroutine apply_contact

   !> Tractions of the held nodes by displacements, shape (held), both in `values`.
   subroutine apply_held(self, values)
      class(krylov_preconditioner_type), intent(inout) :: self
      real(wp), intent(inout) :: values(:)
      real(wp), allocatable :: right(:)

      if (.not. self%soft) then
         call self%held%inverse%apply(values)
         values = values/self%shear_ratio
         return
      end if
      values = values/self%shear_ratio
      right = values
      ! Independent nodes do not contribute to the displacements of the others.
      where (sum(self%weight, dim=2) <= 0.0_wp) values = 0.0_wp
      right = merge(right/merge(self%softness, 1.0_wp, abs(self%softness) > 0.0_wp), values, &
                    sum(self%weight, dim=2) <= 0.0_wp)
      call add_levels(self, values)
      where (sum(self%weight, dim=2) <= 0.0_wp) values = right
   end subroutine apply_held

   !> The weighted sum of the inverses of all levels.
   subroutine add_levels(self, values)
      type(krylov_preconditioner_type), intent(inout) :: self
      real(wp), intent(inout) :: values(:)
      complex(wp) :: spectrum(size(self%symbol, 1)), product(size(self%symbol, 1))
      real(wp) :: work(2*(size(self%symbol, 1) - 1))
      integer :: level

      work = 0.0_wp
      work(self%held%nodes - self%held%before) = values
      call real_transform(work, spectrum)
      if (any(self%weight(:, 0) > 0.0_wp)) call self%held%inverse%apply(values)
      values = self%weight(:, 0)*values
      do level = 1, size(self%symbol, 2)
         if (.not. any(self%weight(:, level) > 0.0_wp)) cycle
         product = self%symbol(:, level)*spectrum
         call back_transform(product, work)
         values = values + self%weight(:, level)*work(self%held%nodes - self%held%before)
      end do
   end subroutine add_levels

end module mfv_krylov_preconditioner
