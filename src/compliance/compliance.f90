!> Interface of the compliance of every body: entries of the four blocks of
!>
!>     w = C_wp p + C_wt tau,    u = C_up p + C_ut tau        (dissertation eq. 2.1)
!>
!> between surface intervals of equal width, and products with them. Only required blocks exist: C_wt only under full
!> coupling, C_up unless there is no coupling, C_ut and C_up only where friction can act. With radial normals all four exist
!> where friction can act: even without coupling C_wt and C_up contain the effect of inclined normals on translations and on
!> displacements in the direction of a load (docs/theory.md).
module mfv_compliance
   use, intrinsic :: iso_fortran_env, only: int64
   use mfv_kinds, only: wp
   implicit none
   private
   public :: compliance_type, coupling_full, coupling_goodman, coupling_none, coupling_names
   public :: block_wp, block_wt, block_up, block_ut

   !> Elastic coupling of the normal and the tangential problem: full; without the effect of shear on the normal problem
   !> (Goodman 1962); none.
   integer, parameter :: coupling_full = 1, coupling_goodman = 2, coupling_none = 3
   character(*), parameter :: coupling_names = 'full goodman none'

   !> The four blocks.
   integer, parameter :: block_wp = 1, block_wt = 2, block_up = 3, block_ut = 4

   type, abstract :: compliance_type
      !> Number of intervals (nodes) on the surface.
      integer :: nodes = 0
      !> Width of an interval, length.
      real(wp) :: interval = 0.0_wp
      !> Stress scale of the blocks: tractions of this size on a length cause displacements of this length.
      real(wp) :: modulus = 1.0_wp
      !> Which blocks exist; and which would with vertical normals: only these contain elastic coupling.
      logical :: has_block(4) = .false., elastic_block(4) = .false.
      !> Whether it is the same everywhere along the surface: blocks depend on the distance only, and C_ut is C_wp times
      !> `shear_ratio`, up to a constant. Half-planes in equal intervals.
      logical :: is_homogeneous = .false.
      !> Whether blocks depend on the distance only: half-planes (then as its logarithm, up to a constant) and layers in equal
      !> intervals, not on a surface that repeats.
      logical :: by_distance = .false.
      !> C_ut over C_wp next to a load.
      real(wp) :: shear_ratio = 1.0_wp
      !> Estimated error of numerical kernels, over their largest value.
      real(wp) :: kernel_error = 0.0_wp
      !> Reals stored for the blocks that exist.
      integer :: block_values = 0
   contains
      procedure(resize_interface), deferred :: resize
      procedure(entries_interface), deferred :: entries
      procedure(products_interface), deferred :: products
      procedure :: displacements
      procedure :: normal_by_shear
      procedure :: tangential_displacements
      procedure :: signature
      procedure :: choose_blocks
      procedure :: one_way
      procedure :: bytes
   end type compliance_type

   abstract interface
      !> Change the number of intervals, not their width.
      subroutine resize_interface(self, nodes)
         import :: compliance_type
         class(compliance_type), intent(inout) :: self
         integer, intent(in) :: nodes
      end subroutine resize_interface

      !> `matrix(i, j)`: displacement at node `rows(i)` by a unit traction on interval `columns(j)`, length^3/force. Only for
      !> existing blocks.
      pure subroutine entries_interface(self, block, rows, columns, matrix)
         import :: compliance_type, wp
         class(compliance_type), intent(in) :: self
         integer, intent(in) :: block, rows(:), columns(:)
         real(wp), intent(out) :: matrix(:, :)
      end subroutine entries_interface

      !> `by_block(:, block)`: product of each block with `pressure` or `shear`, force/length^2, shape (nodes): displacements,
      !> length; zero for blocks that do not exist. Cost of order n log n if the kernel depends on the distance only.
      subroutine products_interface(self, pressure, shear, by_block)
         import :: compliance_type, wp
         class(compliance_type), intent(in) :: self
         real(wp), intent(in) :: pressure(:), shear(:)
         real(wp), intent(out) :: by_block(:, :)
      end subroutine products_interface
   end interface

contains

   !> Surface displacements w (into the body) and u (to the right), length, of every node by the tractions `pressure` and
   !> `shear`, force/length^2, all of shape (nodes).
   subroutine displacements(self, pressure, shear, normal, tangential)
      class(compliance_type), intent(in) :: self
      real(wp), intent(in) :: pressure(:), shear(:)
      real(wp), intent(out) :: normal(:), tangential(:)
      real(wp) :: by_block(size(pressure), 4)

      call self%products(pressure, shear, by_block)
      normal = by_block(:, block_wp) + by_block(:, block_wt)
      tangential = by_block(:, block_ut) + by_block(:, block_up)
   end subroutine displacements

   !> The normal displacements of every node by `shear` alone, length, shape (nodes): the product with C_wt.
   subroutine normal_by_shear(self, shear, normal)
      class(compliance_type), intent(in) :: self
      real(wp), intent(in) :: shear(:)
      real(wp), intent(out) :: normal(:)
      real(wp) :: by_block(size(shear), 4)

      call self%products(0.0_wp*shear, shear, by_block)
      normal = by_block(:, block_wt)
   end subroutine normal_by_shear

   !> The tangential displacements alone, see displacements.
   subroutine tangential_displacements(self, pressure, shear, tangential)
      class(compliance_type), intent(in) :: self
      real(wp), intent(in) :: pressure(:), shear(:)
      real(wp), intent(out) :: tangential(:)
      real(wp) :: normal(size(pressure))

      call self%displacements(pressure, shear, normal, tangential)
   end subroutine tangential_displacements

   !> Constants of the coupling blocks: two bodies with equal signatures do not couple. Zero without coupling; huge by
   !> default, which no other body's signature equals.
   pure function signature(self)
      class(compliance_type), intent(in) :: self
      real(wp) :: signature(4)

      signature = huge(1.0_wp)/max(self%nodes, 1)
   end function signature

   !> Choose the required blocks. `tangential`: friction can act. `radial`: normals differ from node to node.
   pure subroutine choose_blocks(self, coupling, tangential, radial)
      class(compliance_type), intent(inout) :: self
      integer, intent(in) :: coupling
      logical, intent(in) :: tangential
      logical, intent(in), optional :: radial

      self%elastic_block(block_wp) = .true.
      self%elastic_block(block_ut) = tangential
      self%elastic_block(block_up) = tangential .and. coupling /= coupling_none
      self%elastic_block(block_wt) = tangential .and. coupling == coupling_full
      self%has_block = self%elastic_block
      if (.not. present(radial)) return
      if (radial) self%has_block([block_wt, block_up]) = tangential
   end subroutine choose_blocks

   !> Whether pressure causes tangential displacements but shear no normal ones (Goodman): the compliance is not symmetric.
   pure logical function one_way(self)
      class(compliance_type), intent(in) :: self

      one_way = self%elastic_block(block_up) .and. .not. self%elastic_block(block_wt)
   end function one_way

   !> Memory of the stored kernels or matrices, bytes.
   pure integer(int64) function bytes(self)
      class(compliance_type), intent(in) :: self

      bytes = int(self%block_values, int64)*(storage_size(1.0_wp)/8)
   end function bytes

end module mfv_compliance
