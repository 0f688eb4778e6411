!> Bodies given by a matrix, from datasets of any source:
!>
!>     x           (n)             positions of the surface nodes, increasing
!>     gap         (n), optional   initial distance of the surface from y = 0
!>     width       (n), optional   surface length of each node; default: between the midpoints to its neighbours
!>     compliance  (n, n) or (2n, 2n): displacements by nodal forces; or
!>     stiffness   its inverse: nodal forces by displacements, the other nodes condensed out
!>
!> Rows and columns: normal components (into the body), then tangential ones (to the right).
module mfv_matrix_body
   use mfv_body, only: body_type, new_matrix_body
   use mfv_error, only: error_type, set_error
   use mfv_kinds, only: wp
   use mfv_matrix_compliance, only: check_compliance, inverse_of
   use mfv_status, only: MFV_INPUT_ERROR
   use mfv_strings, only: to_text
   implicit none
   private
   public :: matrix_data_type, check_positions, most_matrix_nodes

   !> Largest supported number of nodes.
   integer, parameter :: most_matrix_nodes = 20000

   !> The datasets; `name` of the matrix: compliance or stiffness.
   type :: matrix_data_type
      real(wp), allocatable :: x(:), gap(:), width(:), matrix(:, :)
      character(:), allocatable :: name
   contains
      procedure :: make_body
   end type matrix_data_type

contains

   !> Check the positions of nodes; `has_width`: their widths are given. Error MFV_INPUT_ERROR.
   subroutine check_positions(x, has_width, error)
      real(wp), intent(in) :: x(:)
      logical, intent(in) :: has_width
      type(error_type), allocatable, intent(out) :: error

      if (size(x) < 1 .or. size(x) > most_matrix_nodes) then
         call set_error(error, MFV_INPUT_ERROR, 'x has '//to_text(size(x))//' nodes; allowed are 1 to '//to_text(most_matrix_nodes))
      else if (any(x(2:) <= x(:size(x) - 1))) then
         call set_error(error, MFV_INPUT_ERROR, 'x is not increasing at node '// &
                        to_text(findloc(x(2:) <= x(:size(x) - 1), .true., dim=1) + 1))
      else if (.not. has_width .and. size(x) < 2) then
         call set_error(error, MFV_INPUT_ERROR, 'width is missing; it is required with a single node')
      end if
   end subroutine check_positions

   !> Make the body from data whose sizes and x have been checked. Error MFV_INPUT_ERROR.
   subroutine make_body(self, body, error)
      class(matrix_data_type), intent(inout) :: self
      type(body_type), intent(out) :: body
      type(error_type), allocatable, intent(out) :: error
      real(wp), allocatable :: stiffness(:, :)

      if (.not. allocated(self%gap)) allocate (self%gap(size(self%x)), source=0.0_wp)
      if (.not. allocated(self%width)) call tributary(self%x, self%width)
      if (any(self%width <= 0.0_wp)) then
         call set_error(error, MFV_INPUT_ERROR, 'width is not positive at node '// &
                        to_text(findloc(self%width <= 0.0_wp, .true., dim=1)))
         return
      end if
      call check_compliance(self%matrix, size(self%x), self%name, error)
      if (.not. allocated(error) .and. self%name == 'stiffness') then
         call move_alloc(self%matrix, stiffness)
         call inverse_of(stiffness, self%matrix, error)
      end if
      if (.not. allocated(error)) body = new_matrix_body(self%x, self%gap, self%width, self%matrix)
   end subroutine make_body

   !> Half the distance to either neighbour; an end node is symmetric.
   pure subroutine tributary(x, width)
      real(wp), intent(in) :: x(:)
      real(wp), allocatable, intent(out) :: width(:)
      integer :: n

      n = size(x)
      allocate (width(n))
      width(2:n - 1) = 0.5_wp*(x(3:) - x(:n - 2))
      width(1) = x(2) - x(1)
      width(n) = x(n) - x(n - 1)
   end subroutine tributary

end module mfv_matrix_body
