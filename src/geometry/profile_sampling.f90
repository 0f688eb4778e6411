!> What the nodes of a mesh miss of a profile that has more points than the mesh has nodes.
module mfv_profile_sampling
   use mfv_geometry, only: geometry_type, interpolation_cubic
   use mfv_kinds, only: pi, wp
   implicit none
   private
   public :: find_missed, pressure_of_wave, largest_jumps, sufficient_interval, negligible_pressure

   !> Changes of the pressure by what lies between nodes below this fraction of the peak do not matter.
   real(wp), parameter :: negligible_pressure = 0.02_wp

contains

   !> The points of a profile between nodes at `x` (increasing, lengths) that are closer together than these nodes: `left`: the
   !> node to the left of each; `fraction`: of the distance to the next node; `height`: distance of the point from a curve through
   !> the profile at the nodes, length, positive away from the other body. Cubic polynomials interpolate the profile between points
   !> and the curve between nodes, so that a smooth profile departs little from its curve.
   subroutine find_missed(body, x, left, fraction, height)
      class(geometry_type), intent(in) :: body
      real(wp), intent(in) :: x(:)
      integer, allocatable, intent(out) :: left(:)
      real(wp), allocatable, intent(out) :: fraction(:), height(:)
      !> Points per interval that are not more than one, within rounding errors.
      real(wp), parameter :: one = 1.0_wp - 1.0e-6_wp
      real(wp), allocatable :: position(:), heights(:)
      real(wp) :: at_nodes(size(x))
      logical, allocatable :: is_missed(:)
      integer, allocatable :: below(:)
      integer :: i, k, points

      call body%get_points(position, heights)
      points = size(position)
      at_nodes = 0.0_wp
      if (size(x) >= 4 .and. points >= 4) at_nodes = through(position, heights, x)
      allocate (is_missed(points), source=.false.)
      allocate (below(points), source=0)
      i = 1
      do k = 2, points - 1
         if (position(k) < x(1) .or. min(size(x), points) < 4) cycle
         do while (i < size(x))
            if (x(i + 1) > position(k)) exit
            i = i + 1
         end do
         if (i == size(x)) exit
         below(k) = i
         is_missed(k) = 0.5_wp*(position(k + 1) - position(k - 1)) < one*(x(i + 1) - x(i))
      end do
      left = pack(below, is_missed)
      height = pack(position, is_missed)
      fraction = (height - x(left))/(x(left + 1) - x(left))
      if (size(left) > 0) height = pack(heights, is_missed) - through(x, at_nodes, height)
   end subroutine find_missed

   !> Piecewise cubic interpolation of y at increasing `at`, each by the nearest four x; at least four, increasing.
   pure function through(x, y, at) result(values)
      real(wp), intent(in) :: x(:), y(:), at(:)
      real(wp) :: values(size(at))
      integer :: i, k, first

      k = 1
      do i = 1, size(at)
         do while (k < size(x) - 1)
            if (x(k + 1) > at(i)) exit
            k = k + 1
         end do
         first = min(max(k - 1, 1), size(x) - 3)
         values(i) = cubic(x(first:first + 3), y(first:first + 3), at(i))
      end do
   end function through

   !> The cubic polynomial through four points at `at` (Lagrange).
   pure real(wp) function cubic(x, y, at)
      real(wp), intent(in) :: x(4), y(4), at
      integer :: i, j

      cubic = 0.0_wp
      do i = 1, 4
         cubic = cubic + y(i)*product([((at - x(j))/(x(i) - x(j)), j=1, i - 1), ((at - x(j))/(x(i) - x(j)), j=i + 1, 4)])
      end do
   end function cubic

   !> Pressure that flattens a bump of a height and a width, lengths: pi m height/width (Johnson 1985, section 13.2: pi E* (e/2)/h
   !> of a sinusoid, E* = 2 m). `modulus`: m.
   elemental real(wp) function pressure_of_wave(modulus, height, width) result(pressure)
      real(wp), intent(in) :: modulus, height, width

      pressure = pi*modulus*height/width
   end function pressure_of_wave

   !> Largest jump of the slope, J, at points of a profile around each `x` that intervals of this `width` (lengths, shape of x)
   !> do not resolve; 0 of other bodies. Where the slope jumps by J the pressure grows by m J/pi whenever intervals are shorter by a
   !> factor e (Johnson 1985, section 5.2); piecewise cubics spread J over the distance of the points, and with shorter intervals it
   !> matters less, in second order.
   pure function largest_jumps(body, x, width) result(jumps)
      class(geometry_type), intent(in) :: body
      real(wp), intent(in) :: x(:), width(:)
      real(wp) :: jumps(size(x))
      real(wp), allocatable :: position(:), height(:)
      real(wp) :: left, right, jump
      logical :: is_cubic
      integer :: k

      jumps = 0.0_wp
      if (.not. body%is_sampled()) return
      is_cubic = body%interpolation == interpolation_cubic
      call body%get_points(position, height)
      do k = 2, size(position) - 1
         left = position(k) - position(k - 1)
         right = position(k + 1) - position(k)
         jump = abs((height(k + 1) - height(k))/right - (height(k) - height(k - 1))/left)
         where (position(k) >= x - max(width, right) .and. position(k) <= x + max(width, left))
            jumps = max(jumps, jump*merge(min(1.0_wp, 2.0_wp*width/(left + right))**2, 1.0_wp, is_cubic))
         end where
      end do
   end function largest_jumps

   !> Interval, at most `longest`, with which nodes miss nothing of a profile that changes the pressure by a fraction
   !> negligible_pressure of `pressure`, or that is a quarter of the mean spacing of its points; lengths.
   real(wp) function sufficient_interval(body, modulus, pressure, longest) result(interval)
      class(geometry_type), intent(in) :: body
      real(wp), intent(in) :: modulus, pressure, longest
      real(wp), parameter :: finer = sqrt(2.0_wp), nodes_per_point = 4.0_wp
      integer, allocatable :: left(:)
      real(wp), allocatable :: fraction(:), height(:)
      real(wp) :: shortest
      integer :: i, n

      interval = longest
      if (.not. body%is_sampled()) return
      shortest = (body%to - body%from)/(nodes_per_point*(size(body%position) - 1))
      do while (interval > shortest)
         n = ceiling((body%to - body%from)/interval)
         call find_missed(body, [(body%from + (i - 0.5_wp)*(body%to - body%from)/n, i=1, n)], left, fraction, height)
         if (size(left) == 0) exit
         if (all(pressure_of_wave(modulus, abs(height), interval) <= negligible_pressure*pressure)) return
         interval = interval/finer
      end do
      if (interval < longest) interval = shortest
   end function sufficient_interval

end module mfv_profile_sampling
