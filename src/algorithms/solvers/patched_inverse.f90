!> The inverse of a matrix C(i, j) = c(|i - j|) on a set of nodes with gaps, exact up to a small error.
!>
!> c is the logarithmic kernel of mfv_krylov_preconditioner. The set is divided into groups of nodes, D: the diagonal blocks of
!> the groups. Other groups displace a group smoothly, so that their block is interpolated between a few of its nodes (points) by
!> polynomials, C = D + U B U^T, U: the polynomials, B: the kernel between the points of different groups. The inverse is then
!> (Woodbury's formula)
!>
!>     C^-1 = D^-1 - V (1 + B M)^-1 B V^T,   V = D^-1 U,   M = U^T V.
!>
!> With one point per group this is the correction for the resultants of the groups; two add their moments, and so on. If h is the
!> half-length of a group and the next one is at a distance g from its end, the error of k points is r^k with
!> r = 1/(d + sqrt(d^2 - 1)), d = 1 + g/h (Bernstein's ellipse through the nearest singularity of the kernel; Trefethen,
!> Approximation Theory and Approximation Practice, 2013, chapter 8). Patches that would need many points, because the gap between
!> them is narrow, are in one group.
!>
!> The block of a group is inverted exactly: small groups by Cholesky's method; others by the inverse T^-1 on all nodes between
!> the ends (mfv_toeplitz_inverse), with displacements of the nodes in gaps (G) for which their pressures vanish:
!>
!>     D^-1 = T^-1 - T^-1(:, G) T^-1(G, G)^-1 T^-1(G, :).
!>
!> When nodes change, only the groups that contain them are updated, and the small matrix 1 + B M is factorised again.
module mfv_patched_inverse
   use mfv_kinds, only: pi, wp
   use mfv_lapack, only: dgemm, dgemv, dgetrf, dgetrs, dpotrf, dpotri
   use mfv_toeplitz_inverse, only: toeplitz_inverse_type
   implicit none
   private
   public :: patched_inverse_type

   !> Most nodes of a group with gaps, and without, for a stored inverse.
   integer, parameter :: most_stored = 96, most_stored_patch = 24
   !> Most nodes in gaps of a larger group; number of points from which patches are joined; most points of a group.
   integer, parameter :: most_in_gaps = 32, many_points = 8, most_points = 20
   !> Error of the interpolation, and most points of all groups before a larger error is accepted.
   real(wp), parameter :: interpolation_error = 1.0e-3_wp
   integer, parameter :: most_points_of_all = 600

   type :: node_group_type
      !> Nodes, ascending, and nodes between the ends that are not in the set.
      integer, allocatable :: nodes(:), gaps(:)
      !> The inverse of the block of a small group, shape (nodes, nodes); of T^-1(G, G), shape (gaps, gaps).
      real(wp), allocatable :: stored(:, :), of_gaps(:, :)
      !> T^-1 on all nodes between the ends, and work space for it.
      type(toeplitz_inverse_type), allocatable :: inverse
      real(wp), allocatable :: work(:), others(:)
      !> Points, shape (points); V, shape (nodes, points); U^T V, shape (points, points).
      integer, allocatable :: points(:)
      real(wp), allocatable :: columns(:, :), products(:, :)
      !> Number of nodes and of points in the groups before this one.
      integer :: nodes_before = 0, points_before = 0
   end type node_group_type

   type :: patched_inverse_type
      private
      type(node_group_type), allocatable :: groups(:)
      !> Number of nodes; and of points of all groups, 0: one group.
      integer :: order = 0, points = 0
      !> B and the factors of 1 + B M, shape (points, points).
      real(wp), allocatable :: coupling(:, :), factors(:, :)
      integer, allocatable :: pivots(:)
      !> Work space, shape (points).
      real(wp), allocatable :: weights(:), forces(:)
   contains
      procedure :: set_nodes
      procedure :: apply
      procedure :: group_count
      procedure :: point_count
   end type patched_inverse_type

contains

   !> Number of groups.
   pure integer function group_count(self)
      class(patched_inverse_type), intent(in) :: self

      group_count = 0
      if (allocated(self%groups)) group_count = size(self%groups)
   end function group_count

   !> Number of points of all groups; 0: one group.
   pure integer function point_count(self)
      class(patched_inverse_type), intent(in) :: self

      point_count = self%points
   end function point_count

   !> Set the nodes, ascending. `kernel`: entries by distance + 1, shape (more than the distance between the ends), the same in all
   !> calls. `other`: an inverse with the same kernel, from which groups can be copied.
   subroutine set_nodes(self, kernel, nodes, other)
      class(patched_inverse_type), intent(inout) :: self
      real(wp), intent(in) :: kernel(:)
      integer, intent(in) :: nodes(:)
      type(patched_inverse_type), intent(in), optional :: other
      type(node_group_type), allocatable :: old(:)
      integer, allocatable :: last(:)
      integer :: i, first

      if (.not. allocated(self%groups)) allocate (self%groups(0))
      if (same_nodes(self, nodes)) return
      call find_groups(nodes, last)
      call move_alloc(self%groups, old)
      allocate (self%groups(size(last)))
      first = 1
      do i = 1, size(last)
         self%groups(i)%nodes_before = first - 1
         call adopt_same(self%groups(i), old, nodes(first:last(i)))
         first = last(i) + 1
      end do
      do i = 1, size(last)
         if (allocated(self%groups(i)%nodes)) cycle
         first = self%groups(i)%nodes_before + 1
         call adopt_nearest(self%groups(i), old, nodes(last(i)) - nodes(first) + 1, other)
         call set_group(self%groups(i), kernel, nodes(first:last(i)))
      end do
      self%order = size(nodes)
      call set_points(self, kernel)
   end subroutine set_nodes

   !> Whether these are the present nodes.
   pure logical function same_nodes(self, nodes)
      class(patched_inverse_type), intent(in) :: self
      integer, intent(in) :: nodes(:)
      integer :: i

      same_nodes = size(nodes) == self%order
      do i = 1, size(self%groups)
         if (.not. same_nodes) return
         associate (group => self%groups(i))
            same_nodes = all(group%nodes == nodes(group%nodes_before + 1:group%nodes_before + size(group%nodes)))
         end associate
      end do
   end function same_nodes

   !> Divide nodes into groups. `last`: place of the last node of each group, ascending.
   pure subroutine find_groups(nodes, last)
      integer, intent(in) :: nodes(:)
      integer, allocatable, intent(out) :: last(:)
      integer :: ends(size(nodes)), groups, first, i, next
      logical :: joined

      groups = 0
      first = 1
      i = end_of_patch(nodes, 1)
      do while (i <= size(nodes))
         next = size(nodes) + 1
         joined = i < size(nodes)
         if (joined) next = end_of_patch(nodes, i + 1)
         if (joined) joined = belong_together(nodes, first, i, next)
         if (.not. joined) then
            groups = groups + 1
            ends(groups) = i
            first = i + 1
         end if
         i = next
      end do
      last = ends(:groups)
   end subroutine find_groups

   !> Place of the last of the consecutive nodes from the place `first`.
   pure integer function end_of_patch(nodes, first) result(last)
      integer, intent(in) :: nodes(:), first

      last = first
      do while (last < size(nodes))
         if (nodes(last + 1) > nodes(last) + 1) return
         last = last + 1
      end do
   end function end_of_patch

   !> Whether the group from the place `first` to `last` and the next patch, up to the place `next`, are one group.
   pure logical function belong_together(nodes, first, last, next)
      integer, intent(in) :: nodes(:), first, last, next
      integer :: distance, points

      belong_together = next - first + 1 <= most_stored
      if (belong_together .or. nodes(next) - nodes(first) - (next - first) > most_in_gaps) return
      distance = nodes(last + 1) - nodes(last)
      points = max(points_needed(nodes(last) - nodes(first) + 1, distance, interpolation_error), &
                   points_needed(nodes(next) - nodes(last + 1) + 1, distance, interpolation_error))
      belong_together = points > many_points
   end function belong_together

   !> Number of points for an interpolation with an error of `tolerance` on a group of a `length` (between the ends), at a
   !> `distance` from the next one.
   pure integer function points_needed(length, distance, tolerance) result(points)
      integer, intent(in) :: length, distance
      real(wp), intent(in) :: tolerance
      real(wp) :: d

      d = 1.0_wp + 2.0_wp*distance/length
      points = ceiling(-log(tolerance)/log(d + sqrt(d**2 - 1.0_wp)))
   end function points_needed

   !> Move the `old` group with the same nodes, if there is one.
   subroutine adopt_same(group, old, nodes)
      type(node_group_type), intent(inout) :: group, old(:)
      integer, intent(in) :: nodes(:)
      integer :: i

      do i = 1, size(old)
         if (.not. allocated(old(i)%nodes)) cycle
         if (size(old(i)%nodes) /= size(nodes)) cycle
         if (any(old(i)%nodes /= nodes)) cycle
         call move_group(old(i), group)
         return
      end do
   end subroutine adopt_same

   !> Start with the T^-1 of the nearest order to `length` from an `old` group or from `other`.
   subroutine adopt_nearest(group, old, length, other)
      type(node_group_type), intent(inout) :: group, old(:)
      integer, intent(in) :: length
      type(patched_inverse_type), intent(in), optional :: other
      integer :: nearest

      nearest = nearest_order(old, length)
      if (nearest > 0) call move_alloc(old(nearest)%inverse, group%inverse)
      if (nearest == 0) allocate (group%inverse)
      if (.not. present(other)) return
      if (.not. allocated(other%groups)) return
      nearest = nearest_order(other%groups, length)
      if (nearest == 0) return
      if (abs(other%groups(nearest)%inverse%order - length) < abs(group%inverse%order - length)) &
         call group%inverse%copy_order(other%groups(nearest)%inverse)
   end subroutine adopt_nearest

   !> Number of the group whose T^-1 has the nearest order to `length`; 0: none has one.
   pure integer function nearest_order(groups, length) result(nearest)
      type(node_group_type), intent(in) :: groups(:)
      integer, intent(in) :: length
      integer :: i

      nearest = 0
      do i = 1, size(groups)
         if (.not. allocated(groups(i)%inverse)) cycle
         if (groups(i)%inverse%order == 0) cycle
         if (nearest == 0) nearest = i
         if (abs(groups(i)%inverse%order - length) < abs(groups(nearest)%inverse%order - length)) nearest = i
      end do
   end function nearest_order

   !> Move a group, except its place in the set.
   subroutine move_group(from, to)
      type(node_group_type), intent(inout) :: from, to

      call move_alloc(from%nodes, to%nodes)
      call move_alloc(from%gaps, to%gaps)
      call move_alloc(from%stored, to%stored)
      call move_alloc(from%of_gaps, to%of_gaps)
      call move_alloc(from%work, to%work)
      call move_alloc(from%others, to%others)
      call move_alloc(from%points, to%points)
      call move_alloc(from%columns, to%columns)
      call move_alloc(from%products, to%products)
      call move_alloc(from%inverse, to%inverse)
   end subroutine move_group

   !> Whether the inverse of a group of some `nodes` on a `length` is stored.
   pure logical function is_stored(length, nodes)
      integer, intent(in) :: length, nodes

      is_stored = nodes <= merge(most_stored_patch, most_stored, length == nodes)
   end function is_stored

   !> Prepare the inverse of the block of a group for its nodes.
   subroutine set_group(group, kernel, nodes)
      type(node_group_type), intent(inout) :: group
      real(wp), intent(in) :: kernel(:)
      integer, intent(in) :: nodes(:)
      logical :: is_gap(nodes(1):nodes(size(nodes)))
      integer :: i, length

      length = nodes(size(nodes)) - nodes(1) + 1
      allocate (group%nodes, source=nodes)
      is_gap = .true.
      is_gap(nodes) = .false.
      group%gaps = pack([(i, i=nodes(1), nodes(size(nodes)))], is_gap)
      if (is_stored(length, size(nodes))) then
         allocate (group%stored(size(nodes), size(nodes)))
         do i = 1, size(nodes)
            group%stored(:, i) = kernel(abs(nodes - nodes(i)) + 1)
         end do
         call invert(group%stored)
         return
      end if
      call group%inverse%set_order(kernel, length)
      if (size(group%gaps) == 0) return
      allocate (group%work(length), group%others(length), group%of_gaps(size(group%gaps), size(group%gaps)))
      call group%inverse%entries(group%gaps - nodes(1) + 1, group%of_gaps)
      call invert(group%of_gaps)
   end subroutine set_group

   !> Invert a symmetric positive definite matrix, or, if round-off spoils this, its diagonal.
   subroutine invert(matrix)
      real(wp), intent(inout), contiguous :: matrix(:, :)
      real(wp) :: diagonal(size(matrix, 1))
      integer :: i, info, n

      n = size(matrix, 1)
      diagonal = [(matrix(i, i), i=1, n)]
      call dpotrf('L', n, matrix, n, info)
      if (info == 0) call dpotri('L', n, matrix, n, info)
      if (info /= 0) matrix = 0.0_wp
      do i = 1, n
         if (info /= 0) matrix(i, i) = 1.0_wp/diagonal(i)
         matrix(i, i + 1:) = matrix(i + 1:, i)
      end do
   end subroutine invert

   !> Pressures of a group by its displacements, shape (nodes), both in `values`, without the other groups.
   subroutine apply_group(group, values)
      type(node_group_type), intent(inout) :: group
      real(wp), intent(inout), contiguous :: values(:)
      real(wp) :: given(size(values))

      if (allocated(group%stored)) then
         given = values
         call dgemv('N', size(values), size(values), 1.0_wp, group%stored, size(values), given, 1, 0.0_wp, values, 1)
         return
      end if
      if (size(group%gaps) == 0) then
         call group%inverse%apply(values)
         return
      end if
      associate (before => group%nodes(1) - 1)
         group%work = 0.0_wp
         group%work(group%nodes - before) = values
         call group%inverse%apply(group%work)
         group%others = 0.0_wp
         group%others(group%gaps - before) = matmul(group%of_gaps, group%work(group%gaps - before))
         call group%inverse%apply(group%others)
         values = group%work(group%nodes - before) - group%others(group%nodes - before)
      end associate
   end subroutine apply_group

   !> Choose the points of all groups and factorise 1 + B M.
   subroutine set_points(self, kernel)
      type(patched_inverse_type), intent(inout) :: self
      real(wp), intent(in) :: kernel(:)
      real(wp), parameter :: largest_error = 0.3_wp
      integer, allocatable :: counts(:)
      real(wp) :: tolerance
      integer :: i

      self%points = 0
      if (size(self%groups) < 2) return
      tolerance = interpolation_error
      do
         counts = [(point_count_of(self, i, tolerance), i=1, size(self%groups))]
         if (sum(counts) <= most_points_of_all .or. tolerance > largest_error) exit
         tolerance = sqrt(tolerance)
      end do
      do i = 1, size(self%groups)
         self%groups(i)%points_before = self%points
         self%points = self%points + counts(i)
         call set_columns(self%groups(i), counts(i))
      end do
      call make_room(self)
      call set_coupling(self, kernel)
   end subroutine set_points

   !> Number of points of group `i`.
   pure integer function point_count_of(self, i, tolerance) result(points)
      type(patched_inverse_type), intent(in) :: self
      integer, intent(in) :: i
      real(wp), intent(in) :: tolerance
      integer, parameter :: far = 2**28
      integer :: distance, m

      associate (nodes => self%groups(i)%nodes)
         m = size(nodes)
         distance = far
         if (i > 1) distance = nodes(1) - last_node(self%groups(i - 1))
         if (i < size(self%groups)) distance = min(distance, self%groups(i + 1)%nodes(1) - nodes(m))
         points = min(points_needed(nodes(m) - nodes(1) + 1, distance, tolerance), most_points, m)
      end associate
   end function point_count_of

   pure integer function last_node(group)
      type(node_group_type), intent(in) :: group

      last_node = group%nodes(size(group%nodes))
   end function last_node

   !> Set the points of a group, if their number has changed, with V and U^T V.
   subroutine set_columns(group, points)
      type(node_group_type), intent(inout) :: group
      integer, intent(in) :: points
      real(wp) :: polynomials(size(group%nodes), points)
      integer :: i, n

      if (allocated(group%points)) then
         if (size(group%points) == points) return
         deallocate (group%points, group%columns, group%products)
      end if
      allocate (group%points(points), group%columns(size(group%nodes), points))
      call choose_points(group%nodes, group%points)
      call set_polynomials(group%nodes, group%points, polynomials)
      n = size(group%nodes)
      if (allocated(group%stored)) then
         call dgemm('N', 'N', n, points, n, 1.0_wp, group%stored, n, polynomials, n, 0.0_wp, group%columns, n)
      else
         group%columns = polynomials
         do i = 1, points
            call apply_group(group, group%columns(:, i))
         end do
      end if
      allocate (group%products(points, points))
      call dgemm('T', 'N', points, points, n, 1.0_wp, polynomials, n, group%columns, n, 0.0_wp, group%products, points)
   end subroutine set_columns

   !> Choose nodes next to the zeros of a Chebyshev polynomial on the length of a group; all nodes if they are enough.
   pure subroutine choose_points(nodes, points)
      integer, intent(in) :: nodes(:)
      integer, intent(out) :: points(:)
      real(wp) :: middle, half
      integer :: first, i, k, last, least

      k = size(points)
      points = nodes(:k)
      if (k == size(nodes)) return
      first = nodes(1)
      last = nodes(size(nodes))
      middle = 0.5_wp*(first + last)
      half = 0.5_wp*(last - first + 1)
      least = first
      do i = 1, k
         points(i) = nint(middle - half*cos(pi*(i - 0.5_wp)/k))
         points(i) = max(points(i), least)
         least = points(i) + 1
      end do
      ! Different points, none beyond the end.
      do i = k, 1, -1
         points(i) = min(points(i), last - (k - i))
      end do
   end subroutine choose_points

   !> Values at the nodes, shape (nodes, points), of the polynomials that are 1 at one point and 0 at the others (Lagrange).
   pure subroutine set_polynomials(nodes, points, polynomials)
      integer, intent(in) :: nodes(:), points(:)
      real(wp), intent(out) :: polynomials(:, :)
      real(wp) :: distance(size(nodes), size(points)), scale
      integer :: i, j

      do j = 1, size(points)
         distance(:, j) = real(nodes - points(j), wp)
      end do
      do i = 1, size(points)
         polynomials(:, i) = 1.0_wp
         do j = 1, size(points)
            if (j == i) cycle
            scale = 1.0_wp/(points(i) - points(j))
            polynomials(:, i) = scale*distance(:, j)*polynomials(:, i)
         end do
      end do
   end subroutine set_polynomials

   !> Reserve storage for all points.
   subroutine make_room(self)
      type(patched_inverse_type), intent(inout) :: self

      if (allocated(self%weights)) then
         if (size(self%weights) == self%points) return
         deallocate (self%coupling, self%factors, self%pivots, self%weights, self%forces)
      end if
      allocate (self%coupling(self%points, self%points), self%factors(self%points, self%points))
      allocate (self%pivots(self%points), self%weights(self%points), self%forces(self%points))
   end subroutine make_room

   !> B and the factors of 1 + B M.
   subroutine set_coupling(self, kernel)
      type(patched_inverse_type), intent(inout) :: self
      real(wp), intent(in) :: kernel(:)
      integer :: all_points(self%points), i, info, j

      do i = 1, size(self%groups)
         associate (group => self%groups(i))
            all_points(group%points_before + 1:group%points_before + size(group%points)) = group%points
         end associate
      end do
      do j = 1, self%points
         do i = 1, self%points
            self%coupling(i, j) = kernel(abs(all_points(i) - all_points(j)) + 1)
         end do
      end do
      do i = 1, size(self%groups)
         associate (group => self%groups(i), first => self%groups(i)%points_before + 1, &
                    last => self%groups(i)%points_before + size(self%groups(i)%points))
            self%coupling(first:last, first:last) = 0.0_wp
            call dgemm('N', 'N', self%points, size(group%points), size(group%points), 1.0_wp, self%coupling(1, first), &
                       self%points, group%products, size(group%points), 0.0_wp, self%factors(1, first), self%points)
         end associate
      end do
      do i = 1, self%points
         self%factors(i, i) = self%factors(i, i) + 1.0_wp
      end do
      call dgetrf(self%points, self%points, self%factors, self%points, self%pivots, info)
      ! Groups without correction are still a preconditioner.
      if (info /= 0) self%points = 0
   end subroutine set_coupling

   !> Pressures by displacements, shape (nodes), both in `values`.
   subroutine apply(self, values)
      class(patched_inverse_type), intent(inout) :: self
      real(wp), intent(inout) :: values(:)
      integer :: i, info

      if (self%points > 0) then
         do i = 1, size(self%groups)
            associate (group => self%groups(i))
               call dgemv('T', size(group%nodes), size(group%points), 1.0_wp, group%columns, size(group%nodes), &
                          values(group%nodes_before + 1:), 1, 0.0_wp, self%weights(group%points_before + 1:), 1)
            end associate
         end do
         call dgemv('N', self%points, self%points, 1.0_wp, self%coupling, self%points, self%weights, 1, 0.0_wp, self%forces, 1)
         call dgetrs('N', self%points, 1, self%factors, self%points, self%pivots, self%forces, self%points, info)
      end if
      do i = 1, size(self%groups)
         associate (group => self%groups(i))
            associate (own => values(group%nodes_before + 1:group%nodes_before + size(group%nodes)))
               call apply_group(group, own)
               if (self%points > 0) &
                  call dgemv('N', size(group%nodes), size(group%points), -1.0_wp, group%columns, size(group%nodes), &
                             self%forces(group%points_before + 1:), 1, 1.0_wp, own, 1)
            end associate
         end associate
      end do
   end subroutine apply

end module mfv_patched_inverse
