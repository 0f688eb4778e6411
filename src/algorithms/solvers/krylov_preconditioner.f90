!> Approximate inverses of the diagonal blocks C_wp and C_ut on the nodes of a contact, each in O(n log n).
!>
!> The surface of every elastic body responds to nearby tractions like a half-plane, by the logarithm of the distance. On
!> consecutive nodes this, or the kernel of layers, is a Toeplitz matrix with a known exact inverse (mfv_toeplitz_inverse): on
!> half-planes and layers the iteration then only resolves the coupling of pressure and shear, whose strength does not depend on
!> the mesh. On other sets of nodes, and where nodes are held by bristles (softness c > 0, mfv_krylov_system), which need 1/(C_ut +
!> c), it is an approximate sparse inverse (mfv_sparse_inverse). Nodes whose friction decreases with slip (c < 0) are treated as
!> independent: where the bodies can unload as fast as friction decreases, |c| dominates C_ut + c.
module mfv_krylov_preconditioner
   use mfv_compliance, only: block_ut, block_wp, compliance_type
   use mfv_half_plane, only: log_kernel
   use mfv_kinds, only: wp
   use mfv_sparse_inverse, only: sparse_inverse_type
   use mfv_toeplitz_inverse, only: toeplitz_inverse_type
   implicit none
   private
   public :: krylov_preconditioner_type

   !> Inverse on a set of nodes: of a Toeplitz matrix if they are consecutive and hard, else sparse.
   type :: block_type
      logical :: is_toeplitz = .true.
      type(toeplitz_inverse_type) :: toeplitz
      type(sparse_inverse_type) :: sparse
   end type block_type

   type :: krylov_preconditioner_type
      private
      !> Entries by distance, length^3/force in the units of the system.
      real(wp), allocatable :: kernel(:)
      !> C_ut is the kernel times this; of layers the other kernel, if there is one. What the entries of C_wp and C_ut next to the
      !> diagonal, and all of those of half-planes and layers (`by_distance`), have beyond these.
      real(wp), allocatable :: held_kernel(:)
      real(wp) :: shear_ratio = 1.0_wp
      real(wp), public :: constant = 0.0_wp, shear_constant = 0.0_wp
      logical :: by_distance = .false., has_shear = .false.
      !> (Both allocatable: otherwise gfortran 12 does not free the components of the second.)
      type(block_type), allocatable :: contact, held
      !> Softness of the held nodes where it is negative, else 0, shape (held).
      real(wp), allocatable :: softness(:)
   contains
      procedure :: prepare
      procedure :: set_contact
      procedure :: set_held
      procedure :: apply_contact
      procedure :: apply_held
      procedure :: smallest
      procedure :: is_exact
      procedure :: on_one_patch
   end type krylov_preconditioner_type

contains

   !> Prepare for a compliance, whose number of nodes may have changed, or its blocks, with the first step with friction. `unit`: of
   !> the entries of the blocks, length^3/force.
   subroutine prepare(self, compliance, unit)
      class(krylov_preconditioner_type), intent(inout) :: self
      class(compliance_type), intent(in) :: compliance
      real(wp), intent(in) :: unit
      logical :: layers

      layers = compliance%by_distance .and. .not. compliance%is_homogeneous
      if (allocated(self%kernel)) then
         if ((2*compliance%nodes <= size(self%kernel) .or. (layers .and. size(self%kernel) == compliance%nodes)) .and. &
             (self%has_shear .eqv. compliance%has_block(block_ut))) return
         deallocate (self%kernel)
      end if
      if (allocated(self%held_kernel)) deallocate (self%held_kernel)
      self%has_shear = compliance%has_block(block_ut)
      self%by_distance = compliance%by_distance
      self%shear_ratio = compliance%shear_ratio
      if (layers) then
         call find_kernel(compliance, block_wp, unit, self%kernel, self%constant)
         if (self%has_shear) &
            call find_kernel(compliance, block_ut, unit*self%shear_ratio, self%held_kernel, self%shear_constant)
         self%shear_constant = self%shear_ratio*self%shear_constant
      else
         call find_logarithm(self, compliance, unit)
      end if
      if (allocated(self%contact)) deallocate (self%contact, self%held)
      allocate (self%contact, self%held)
   end subroutine prepare

   !> The logarithm of the distance and what the entries have beyond it, see prepare.
   subroutine find_logarithm(self, compliance, unit)
      class(krylov_preconditioner_type), intent(inout) :: self
      class(compliance_type), intent(in) :: compliance
      real(wp), intent(in) :: unit
      integer :: distance, middle, n
      real(wp) :: near(1, 2), factor, least

      n = compliance%nodes
      middle = (n + 1)/2
      near = 0.0_wp
      call compliance%entries(block_wp, [middle], [middle], near(:, 1:1))
      call compliance%entries(block_wp, [middle], [min(middle + 1, n)], near(:, 2:2))
      factor = (near(1, 1) - near(1, 2))/log_kernel(2.0_wp)
      if (.not. factor > 0.0_wp) factor = near(1, 1)/log_kernel(2.0_wp)
      ! Positive definite on surfaces shorter than four times the distance at which a force leaves no displacement.
      least = factor*(2.0_wp*log(16.0_wp*n) + 2.0_wp)
      allocate (self%kernel(4*n + 1))
      do distance = 0, 4*n
         self%kernel(distance + 1) = (max(near(1, 1), least) - factor*log_kernel(2.0_wp*distance))/unit
      end do
      self%constant = near(1, 1)/unit - self%kernel(1)
      self%shear_constant = 0.0_wp
      if (compliance%has_block(block_ut)) then
         call compliance%entries(block_ut, [middle], [middle], near(:, 1:1))
         self%shear_constant = near(1, 1)/unit - self%shear_ratio*self%kernel(1)
      end if
   end subroutine find_logarithm

   !> The `kernel` by distance of a block of layers over `unit`, shape (nodes), without the `constant` that its entries have beyond
   !> it: the displacement at the most distant node becomes at least as large as its difference to the nearest one.
   subroutine find_kernel(compliance, block, unit, kernel, constant)
      class(compliance_type), intent(in) :: compliance
      integer, intent(in) :: block
      real(wp), intent(in) :: unit
      real(wp), allocatable, intent(out) :: kernel(:)
      real(wp), intent(out) :: constant
      real(wp) :: row(1, compliance%nodes)
      integer :: i

      call compliance%entries(block, [1], [(i, i=1, size(row))], row)
      kernel = row(1, :)/unit
      constant = -max(kernel(1) - 2.0_wp*minval(kernel), 0.0_wp)
      kernel = kernel - constant
   end subroutine find_kernel

   !> Whether the inverses are those of the blocks without the `constant` in their entries, up to round-off.
   pure logical function is_exact(self)
      class(krylov_preconditioner_type), intent(in) :: self

      is_exact = self%by_distance .and. self%contact%is_toeplitz .and. self%held%is_toeplitz
      if (is_exact) is_exact = all(self%softness >= 0.0_wp)
   end function is_exact

   !> Whether the nodes in contact are consecutive.
   pure logical function on_one_patch(self)
      class(krylov_preconditioner_type), intent(in) :: self

      on_one_patch = self%contact%is_toeplitz
   end function on_one_patch

   !> Approximate smallest eigenvalue of the blocks, in the units of the system.
   pure real(wp) function smallest(self)
      class(krylov_preconditioner_type), intent(in) :: self

      smallest = 0.5_wp*(self%kernel(1) - self%kernel(2))
   end function smallest

   !> Set the nodes in contact, ascending.
   subroutine set_contact(self, nodes)
      class(krylov_preconditioner_type), intent(inout) :: self
      integer, intent(in) :: nodes(:)

      call set_block(self%contact, self%kernel, nodes, 0.0_wp*nodes)
   end subroutine set_contact

   !> Set the nodes whose shear is unknown, ascending, and their softness, shape (held). (r K + c)^-1 is (K + c/r)^-1/r.
   subroutine set_held(self, nodes, softness)
      class(krylov_preconditioner_type), intent(inout) :: self
      integer, intent(in) :: nodes(:)
      real(wp), intent(in) :: softness(:)
      logical :: firm(size(nodes))

      firm = softness >= 0.0_wp
      self%softness = min(softness, 0.0_wp)
      if (allocated(self%held_kernel)) then
         call set_block(self%held, self%held_kernel, pack(nodes, firm), pack(softness/self%shear_ratio, firm))
      else
         call set_block(self%held, self%kernel, pack(nodes, firm), pack(softness/self%shear_ratio, firm), self%contact)
      end if
   end subroutine set_held

   !> Set the nodes of a block, ascending, and their softness. `other`: a block whose inverse may be a start.
   subroutine set_block(block, kernel, nodes, softness, other)
      type(block_type), intent(inout) :: block
      real(wp), intent(in) :: kernel(:), softness(:)
      integer, intent(in) :: nodes(:)
      type(block_type), intent(in), optional :: other
      integer :: n

      n = size(nodes)
      block%is_toeplitz = n == 0
      if (n > 0) block%is_toeplitz = nodes(n) - nodes(1) == n - 1 .and. .not. any(softness > 0.0_wp)
      if (.not. block%is_toeplitz) then
         call block%sparse%set_nodes(kernel, nodes, softness)
         return
      end if
      if (present(other)) then
         if (other%is_toeplitz .and. abs(other%toeplitz%order - n) < abs(block%toeplitz%order - n)) &
            call block%toeplitz%copy_order(other%toeplitz)
      end if
      call block%toeplitz%set_order(kernel, n)
   end subroutine set_block

   !> Tractions of the nodes in contact by displacements, shape (contact), both in `values`.
   subroutine apply_contact(self, values)
      class(krylov_preconditioner_type), intent(inout) :: self
      real(wp), intent(inout) :: values(:)

      call apply_block(self%contact, values)
   end subroutine apply_contact

   !> Tractions of the held nodes by displacements, shape (held), both in `values`.
   subroutine apply_held(self, values)
      class(krylov_preconditioner_type), intent(inout) :: self
      real(wp), intent(inout) :: values(:)
      real(wp), allocatable :: firm(:)

      firm = pack(values, self%softness >= 0.0_wp)/self%shear_ratio
      call apply_block(self%held, firm)
      where (self%softness < 0.0_wp) values = values/self%softness
      values = unpack(firm, self%softness >= 0.0_wp, values)
   end subroutine apply_held

   subroutine apply_block(block, values)
      type(block_type), intent(inout) :: block
      real(wp), intent(inout) :: values(:)

      if (block%is_toeplitz) then
         if (size(values) > 0) call block%toeplitz%apply(values)
      else
         call block%sparse%apply(values)
      end if
   end subroutine apply_block

end module mfv_krylov_preconditioner
