!> Bodies given by a matrix, from an HDF5 file with the datasets
!>
!>     x           (n)             positions of the surface nodes, increasing
!>     gap         (n), optional   how far the undeformed surface recedes from y = 0
!>     width       (n), optional   surface that belongs to each node; else from the midpoints between the nodes
!>     compliance  (n, n) or (2n, 2n): displacements by nodal forces; or
!>     stiffness   the same inverted: nodal forces by displacements, the other nodes condensed out
!>
!> Rows and columns: normal components (into the body), then tangential ones (to the right).
module mfv_matrix_file
   use hdf5, only: hid_t
   use mfv_body, only: body_type, new_matrix_body
   use mfv_error, only: error_type, set_error
   use mfv_hdf5_reader
   use mfv_kinds, only: wp
   use mfv_matrix_compliance, only: check_compliance, inverse_of
   use mfv_status, only: MFV_INPUT_ERROR
   use mfv_strings, only: to_text
   implicit none
   private
   public :: read_matrix_body

   !> More nodes than this make matrices beyond reason.
   integer, parameter :: most_nodes = 20000

contains

   !> The body in the file `path`. Error MFV_INPUT_ERROR, which names the file and what is wrong in it.
   subroutine read_matrix_body(path, body, error)
      character(*), intent(in) :: path
      type(body_type), intent(out) :: body
      type(error_type), allocatable, intent(out) :: error
      integer(hid_t) :: file

      call open_to_read(path, file, error)
      if (allocated(error)) return
      call read_datasets(file, body, error)
      call close_read(file)
      if (allocated(error)) error%message = path//': '//error%message
   end subroutine read_matrix_body

   !> All datasets of an open file.
   subroutine read_datasets(file, body, error)
      integer(hid_t), intent(in) :: file
      type(body_type), intent(out) :: body
      type(error_type), allocatable, intent(out) :: error
      real(wp), allocatable :: x(:), gap(:), width(:), matrix(:, :), stiffness(:, :)
      character(:), allocatable :: name

      call read_vector(file, 'x', -1, x, error)
      if (allocated(error)) return
      if (size(x) < 1 .or. size(x) > most_nodes) then
         call set_error(error, MFV_INPUT_ERROR, 'x has '//to_text(size(x))//' nodes; 1 to '//to_text(most_nodes)//' can be')
      else if (any(x(2:) <= x(:size(x) - 1))) then
         call set_error(error, MFV_INPUT_ERROR, 'x is not increasing at node '// &
                        to_text(findloc(x(2:) <= x(:size(x) - 1), .true., dim=1) + 1))
      else if (.not. has(file, 'width') .and. size(x) < 2) then
         call set_error(error, MFV_INPUT_ERROR, 'width is missing, which one node alone needs')
      end if
      if (allocated(error)) return
      allocate (gap(size(x)), source=0.0_wp)
      if (has(file, 'gap')) call read_vector(file, 'gap', size(x), gap, error)
      if (allocated(error)) return
      if (has(file, 'width')) then
         call read_vector(file, 'width', size(x), width, error)
         if (.not. allocated(error)) then
            if (any(width <= 0.0_wp)) call set_error(error, MFV_INPUT_ERROR, 'width is not positive at node '// &
                                                     to_text(findloc(width <= 0.0_wp, .true., dim=1)))
         end if
         if (allocated(error)) return
      else
         call tributary(x, width)
      end if

      if (has(file, 'compliance') .eqv. has(file, 'stiffness')) then
         call set_error(error, MFV_INPUT_ERROR, 'either compliance or stiffness must be there')
         return
      end if
      name = 'stiffness'
      if (has(file, 'compliance')) name = 'compliance'
      call read_matrix(file, name, 2*most_nodes, matrix, error)
      if (.not. allocated(error)) call check_compliance(matrix, size(x), name, error)
      if (.not. allocated(error) .and. name == 'stiffness') then
         call move_alloc(matrix, stiffness)
         call inverse_of(stiffness, matrix, error)
      end if
      if (.not. allocated(error)) body = new_matrix_body(x, gap, width, matrix)
   end subroutine read_datasets

   !> Half the way to either neighbour; an end node has as much on its outer side as on its inner one.
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

end module mfv_matrix_file
