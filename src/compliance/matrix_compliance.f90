!> A body with a stored compliance matrix: given by the user, for example from finite elements, or that of a half-plane or circle on
!> unequal intervals.
!>
!> Given matrices relate nodal forces and nodal displacements of the surface nodes, force/length and length per unit thickness.
!> Rows and columns: normal components of all nodes (into the body) and, for problems with shear, all tangential ones (to the
!> right).
module mfv_matrix_compliance
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use mfv_compliance
   use mfv_error, only: error_type, set_error
   use mfv_kinds, only: wp
   use mfv_lapack, only: dgemv, dpotrf, dpotri
   use mfv_status, only: MFV_INPUT_ERROR
   use mfv_strings, only: to_text
   implicit none
   private
   public :: matrix_compliance_type, new_matrix_compliance, matrix_of, check_compliance, inverse_of

   type, extends(compliance_type) :: matrix_compliance_type
      private
      !> Displacements by unit tractions, shape (n or 2n, n or 2n).
      real(wp), allocatable :: matrix(:, :)
      !> See signature.
      real(wp), allocatable :: constants(:)
   contains
      procedure :: signature
      procedure :: resize
      procedure :: entries
      procedure :: products
   end type matrix_compliance_type

   !> Relative tolerance of the symmetry check.
   real(wp), parameter :: symmetry_tolerance = 1.0e-8_wp

contains

   !> Compliance by `compliance`, displacements by nodal forces, checked by check_compliance; shape (n, n) or (2n, 2n).
   !> `width`: surface length of each node, shape (n); traction times width is the nodal force. `tangential`: friction can
   !> act; it requires the larger matrix.
   type(matrix_compliance_type) function new_matrix_compliance(compliance, width, coupling, tangential) result(self)
      real(wp), intent(in) :: compliance(:, :), width(:)
      integer, intent(in) :: coupling
      logical, intent(in) :: tangential
      integer :: j, n

      n = size(width)
      self%nodes = n
      self%interval = sum(width)/n
      call self%choose_blocks(coupling, tangential)
      self%matrix = compliance(:merge(2*n, n, tangential), :merge(2*n, n, tangential))
      do j = 1, size(self%matrix, 2)
         self%matrix(:, j) = self%matrix(:, j)*width(modulo(j - 1, n) + 1)
      end do
      self%modulus = sum(width)/maxval(abs(self%matrix(:n, :n)))/n
      self%block_values = size(self%matrix)
   end function new_matrix_compliance

   !> The compliance of a body that has entries, as a stored matrix.
   type(matrix_compliance_type) function matrix_of(body) result(self)
      class(compliance_type), intent(in) :: body
      integer :: block, before(2), i, n
      integer, allocatable :: all_nodes(:)

      n = body%nodes
      self%nodes = n
      self%interval = body%interval
      self%modulus = body%modulus
      self%kernel_error = body%kernel_error
      self%has_block = body%has_block
      self%elastic_block = body%elastic_block
      self%constants = body%signature()
      all_nodes = [(i, i=1, n)]
      n = merge(2*n, n, body%has_block(block_ut))
      allocate (self%matrix(n, n), source=0.0_wp)
      do block = 1, 4
         if (.not. body%has_block(block)) cycle
         before = origin(self, block)
         call body%entries(block, all_nodes, all_nodes, self%matrix(before(1) + 1:before(1) + self%nodes, &
                                                                    before(2) + 1:before(2) + self%nodes))
      end do
      self%block_values = size(self%matrix)
   end function matrix_of

   !> See mfv_compliance.
   pure function signature(self)
      class(matrix_compliance_type), intent(in) :: self
      real(wp) :: signature(4)

      signature = huge(1.0_wp)/max(self%nodes, 1)
      if (allocated(self%constants)) signature = self%constants
   end function signature

   !> Check a matrix of nodal compliances or stiffnesses for `nodes` nodes, called `name` in messages. Error MFV_INPUT_ERROR.
   subroutine check_compliance(matrix, nodes, name, error)
      real(wp), intent(in) :: matrix(:, :)
      integer, intent(in) :: nodes
      character(*), intent(in) :: name
      type(error_type), allocatable, intent(out) :: error
      real(wp), allocatable :: factor(:, :)
      real(wp) :: difference
      integer :: info, block, place(2)

      if (size(matrix, 1) /= size(matrix, 2) .or. (size(matrix, 1) /= nodes .and. size(matrix, 1) /= 2*nodes)) then
         call set_error(error, MFV_INPUT_ERROR, name//' has the shape '//to_text(size(matrix, 1))//' x '// &
                        to_text(size(matrix, 2))//'; with '//to_text(nodes)//' positions in x it must be '// &
                        to_text(nodes)//' x '//to_text(nodes)//', or '//to_text(2*nodes)//' x '//to_text(2*nodes)// &
                        ' with the tangential components')
         return
      end if
      if (.not. all(ieee_is_finite(matrix))) then
         place = findloc(ieee_is_finite(matrix), .false.)
         call set_error(error, MFV_INPUT_ERROR, name//' is not finite in row '//to_text(place(1))//', column '// &
                        to_text(place(2)))
         return
      end if
      difference = maxval(abs(matrix - transpose(matrix)))
      if (difference > symmetry_tolerance*maxval(abs(matrix))) then
         place = maxloc(abs(matrix - transpose(matrix)))
         call set_error(error, MFV_INPUT_ERROR, name//' is not symmetric: row '//to_text(place(1))//', column '// &
                        to_text(place(2))//' has '//to_text(matrix(place(1), place(2)))//', its mirror image '// &
                        to_text(matrix(place(2), place(1))))
         return
      end if
      do block = 1, size(matrix, 1)/nodes
         factor = matrix((block - 1)*nodes + 1:block*nodes, (block - 1)*nodes + 1:block*nodes)
         call dpotrf('L', nodes, factor, nodes, info)
         if (info == 0) cycle
         call set_error(error, MFV_INPUT_ERROR, name//' is not positive definite in its '// &
                        trim(merge('normal    ', 'tangential', block == 1))//' part (rows and columns '// &
                        to_text((block - 1)*nodes + 1)//' to '//to_text(block*nodes)//'; found at row '//to_text(max(info, 1))//')')
         return
      end do
   end subroutine check_compliance

   !> Inverse of a symmetric stiffness (shape (m, m)). Error MFV_INPUT_ERROR if it is not positive definite, for example
   !> because of rigid-body motions.
   subroutine inverse_of(stiffness, compliance, error)
      real(wp), intent(in) :: stiffness(:, :)
      real(wp), allocatable, intent(out) :: compliance(:, :)
      type(error_type), allocatable, intent(out) :: error
      integer :: info, j, n

      n = size(stiffness, 1)
      compliance = 0.5_wp*(stiffness + transpose(stiffness))
      call dpotrf('L', n, compliance, n, info)
      if (info == 0) call dpotri('L', n, compliance, n, info)
      if (info /= 0) then
         call set_error(error, MFV_INPUT_ERROR, 'stiffness is not positive definite (found at row '//to_text(max(info, 1))// &
                        '): is the body supported?')
         return
      end if
      do j = 2, n
         compliance(:j - 1, j) = compliance(j, :j - 1)
      end do
   end subroutine inverse_of

   !> See mfv_compliance: the nodes of a matrix are fixed.
   subroutine resize(self, nodes)
      class(matrix_compliance_type), intent(inout) :: self
      integer, intent(in) :: nodes

      self%nodes = min(nodes, self%nodes)
   end subroutine resize

   !> Rows and columns before a block.
   pure function origin(self, block)
      class(matrix_compliance_type), intent(in) :: self
      integer, intent(in) :: block
      integer :: origin(2)

      origin = 0
      if (block == block_up .or. block == block_ut) origin(1) = self%nodes
      if (block == block_wt .or. block == block_ut) origin(2) = self%nodes
   end function origin

   !> See mfv_compliance.
   pure subroutine entries(self, block, rows, columns, matrix)
      class(matrix_compliance_type), intent(in) :: self
      integer, intent(in) :: block, rows(:), columns(:)
      real(wp), intent(out) :: matrix(:, :)
      integer :: before(2)

      before = origin(self, block)
      matrix = self%matrix(before(1) + rows, before(2) + columns)
   end subroutine entries

   !> See mfv_compliance; only the columns between the outermost loaded ones are used.
   subroutine products(self, pressure, shear, by_block)
      class(matrix_compliance_type), intent(in) :: self
      real(wp), intent(in) :: pressure(:), shear(:)
      real(wp), intent(out) :: by_block(:, :)
      integer :: block

      by_block = 0.0_wp
      do block = 1, 4
         if (.not. self%has_block(block)) cycle
         if (block == block_wp .or. block == block_up) then
            call multiply(self, block, pressure, by_block(:, block))
         else
            call multiply(self, block, shear, by_block(:, block))
         end if
      end do
   end subroutine products

   !> The product of a block with a traction.
   subroutine multiply(self, block, traction, displacement)
      class(matrix_compliance_type), intent(in) :: self
      integer, intent(in) :: block
      real(wp), contiguous, intent(in) :: traction(:)
      real(wp), contiguous, intent(inout) :: displacement(:)
      integer :: before(2), first, last

      first = findloc(abs(traction) > 0.0_wp, .true., dim=1)
      if (first == 0) return
      last = findloc(abs(traction) > 0.0_wp, .true., dim=1, back=.true.)
      before = origin(self, block)
      call dgemv('N', self%nodes, last - first + 1, 1.0_wp, self%matrix(before(1) + 1, before(2) + first), size(self%matrix, 1), &
                 traction(first:), 1, 0.0_wp, displacement, 1)
   end subroutine multiply

end module mfv_matrix_compliance
