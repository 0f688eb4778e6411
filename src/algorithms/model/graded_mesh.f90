!> Unequal intervals that are small at given points: edges of contact and stick zones, where tractions are roots of the distance.
!>
!> From a point to the middle between two points, L away, the number of intervals up to the distance d grows as (d/L)**(1/3) plus a
!> smaller part d/L: widths grow as d**(2/3) up to a largest one. Every such piece gets intervals in proportion to L**(1/3) and L,
!> so that the intervals are equally small at all points. Tractions then converge with second order in the mean although they are
!> roots at the points (docs/verification.md).
module mfv_graded_mesh
   use mfv_kinds, only: wp
   implicit none
   private
   public :: graded_ends

   !> From a point to the left (side -1) or right (1).
   type :: piece_type
      real(wp) :: point = 0.0_wp, length = 0.0_wp, density = 1.0_wp
      integer :: side = 1
   end type piece_type

   !> Inverse of the exponent above; part of the intervals that is uniform; density beyond the outermost points.
   real(wp), parameter :: grading = 3.0_wp, uniform_part = 0.25_wp, density_outside = 1.0_wp
   !> Fewest intervals for a point.
   integer, parameter :: fewest_intervals = 8

contains

   !> Ends of about `nodes` intervals from `left` to `right` that are small at the `points` in between, of which there is at least
   !> one: of two that are too close for this number of intervals, that of the higher rank is not used, and their middle is if the
   !> ranks are equal. Lengths; ranks of shape (points).
   pure subroutine graded_ends(points, rank, left, right, nodes, ends)
      real(wp), intent(in) :: points(:), left, right
      integer, intent(in) :: rank(:), nodes
      real(wp), allocatable, intent(out) :: ends(:)
      type(piece_type), allocatable :: pieces(:)
      real(wp), allocatable :: used(:)
      real(wp) :: at_ends(size(points)), graded, even, shared, smallest
      integer :: i, k, last

      ! Points at an end up to round-off, such as edges at corners of a body, are there: no interval fits between.
      smallest = (right - left)/real(nodes, wp)**grading
      at_ends = merge(left, merge(right, points, abs(points - right) <= smallest), abs(points - left) <= smallest)
      call choose_points(at_ends, rank, left, right, nodes, used)
      call find_pieces(used, left, right, pieces)
      ends = [left]
      do i = 1, size(pieces)
         associate (piece => pieces(i))
            graded = (1.0_wp - uniform_part)*nodes*weight(piece, 1.0_wp/grading)/sum(weight(pieces, 1.0_wp/grading))
            even = uniform_part*nodes*weight(piece, 1.0_wp)/sum(weight(pieces, 1.0_wp))
            ! The pieces that meet in the middle of all share an interval: the node there can stick where the others slip away from
            ! it. Without one, which node of a symmetric contact sticks would be decided by round-off.
            shared = merge(0.5_wp, 0.0_wp, size(pieces) == merge(2*i, 2*(i - 1), piece%side > 0))
            last = max(1, nint(graded + even - shared))
            do k = merge(1, merge(last, last - 1, shared > 0.0_wp), piece%side > 0), merge(last, 0, piece%side > 0), piece%side
               ends = [ends, piece%point + piece%side*piece%length*distance_at(k/(last + shared), even/(graded + even))]
            end do
         end associate
      end do
   end subroutine graded_ends

   !> Density times a power of the length.
   elemental real(wp) function weight(piece, power)
      type(piece_type), intent(in) :: piece
      real(wp), intent(in) :: power

      weight = piece%density*piece%length**power
   end function weight

   !> Distance d/L at which the part `t` of the intervals of a piece is reached: the root of t = (1 - even) s + even s**3, s the
   !> cube root of d/L (by the hyperbolic solution of the cubic equation).
   elemental real(wp) function distance_at(t, even) result(distance)
      real(wp), intent(in) :: t, even
      real(wp) :: scale

      scale = sqrt((1.0_wp - even)/(3.0_wp*even))
      distance = (2.0_wp*scale*sinh(asinh(0.5_wp*t/(even*scale**3))/3.0_wp))**3
      if (t >= 1.0_wp) distance = 1.0_wp
   end function distance_at

   !> The pieces between the points, from left to right.
   pure subroutine find_pieces(points, left, right, pieces)
      real(wp), intent(in) :: points(:), left, right
      type(piece_type), allocatable, intent(out) :: pieces(:)
      real(wp) :: half
      integer :: i, n

      n = size(points)
      allocate (pieces(0))
      if (points(1) > left) pieces = [piece_type(points(1), points(1) - left, density_outside, -1)]
      do i = 1, n - 1
         half = 0.5_wp*(points(i + 1) - points(i))
         pieces = [pieces, piece_type(points(i), half, 1.0_wp, 1), piece_type(points(i + 1), half, 1.0_wp, -1)]
      end do
      if (points(n) < right) pieces = [pieces, piece_type(points(n), right - points(n), density_outside, 1)]
   end subroutine find_pieces

   !> The points that are used, increasing: not beyond the ends, not closer to each other than the smallest interval, and not too
   !> many.
   pure subroutine choose_points(points, rank, left, right, nodes, used)
      real(wp), intent(in) :: points(:), left, right
      integer, intent(in) :: rank(:), nodes
      real(wp), allocatable, intent(out) :: used(:)
      type(piece_type), allocatable :: pieces(:)
      integer, allocatable :: order(:), ranks(:)
      real(wp), parameter :: alike = 1.0e-3_wp
      real(wp), allocatable :: apart(:)
      real(wp) :: smallest

      order = sorted(points, points >= left .and. points <= right)
      used = points(order)
      ranks = rank(order)
      do while (size(used) > 1)
         call find_pieces(used, left, right, pieces)
         smallest = (sum(weight(pieces, 1.0_wp/grading))/nodes)**grading
         apart = used(2:) - used(:size(used) - 1)
         if (minval(apart) > smallest .and. size(used)*fewest_intervals <= nodes) return
         ! Pairs that are equally close together, so that the mesh of a symmetric contact is symmetric.
         call join_pairs(apart <= (1.0_wp + alike)*minval(apart), used, ranks)
      end do
   end subroutine choose_points

   !> Replace neighbouring points, of which `joined` (points - 1) are pairs, by one point for each pair, which in a row of pairs
   !> does not depend on the side from which it is read.
   pure subroutine join_pairs(joined, points, ranks)
      logical, intent(in) :: joined(:)
      real(wp), allocatable, intent(inout) :: points(:)
      integer, allocatable, intent(inout) :: ranks(:)
      real(wp) :: place(2*size(points))
      integer :: level(2*size(points)), i, n
      logical :: padded(0:size(points))

      padded = [.false., joined, .false.]
      n = 0
      do i = 1, size(points)
         if (padded(i)) then
            n = n + 1
            level(n) = minval(ranks(i:i + 1))
            place(n) = points(i + minloc(ranks(i:i + 1), dim=1) - 1)
            if (ranks(i) == ranks(i + 1)) place(n) = 0.5_wp*(points(i) + points(i + 1))
         else if (.not. padded(i - 1)) then
            n = n + 1
            level(n) = ranks(i)
            place(n) = points(i)
         end if
      end do
      points = place(:n)
      ranks = level(:n)
   end subroutine join_pairs

   !> Indices of the values to keep, by value.
   pure function sorted(values, keep) result(order)
      real(wp), intent(in) :: values(:)
      logical, intent(in) :: keep(:)
      integer, allocatable :: order(:)
      logical :: left(size(values))
      integer :: i, next

      left = keep
      allocate (order(count(keep)))
      do i = 1, size(order)
         next = minloc(values, dim=1, mask=left)
         order(i) = next
         left(next) = .false.
      end do
   end function sorted

end module mfv_graded_mesh
