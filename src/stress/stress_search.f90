!> Largest stresses in a body: the von Mises stress, and the tension at the surface.
module mfv_stress_search
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite, ieee_quiet_nan, ieee_value
   use mfv_interior, only: interior_type, von_mises_stress
   use mfv_kinds, only: pi, wp
   use mfv_minimum, only: minimum_near, objective_type
   use mfv_surface_tractions, only: merged
   use mfv_tolerances, only: certified, visible
   implicit none
   private
   public :: largest_type, largest_von_mises, largest_tension, find_largest_at_interfaces, estimate_in_layers, &
             depths_below

   !> Depths over the half-width, up to that of the largest stress under an ellipse of pressure.
   real(wp), parameter :: depths_below(6) = [0.1_wp, 0.2_wp, 0.3_wp, 0.4_wp, 0.55_wp, 0.7_wp]

   !> What is searched for along a line.
   integer, parameter :: surface_tension = 1, surface_von_mises = 2, interface_tension = 3, interface_shear = 4

   !> A largest stress, force/length^2, and where it is: x and y, length. Of the tension also the largest maximum at another place,
   !> farther than an interval, if there is one, and its x.
   type :: largest_type
      real(wp) :: value = 0.0_wp, x = 0.0_wp, y = 0.0_wp
      real(wp) :: rival = -huge(1.0_wp), rival_x = 0.0_wp
   end type largest_type

   type, extends(objective_type) :: search_type
      type(interior_type) :: interior
      real(wp) :: deepest = 0.0_wp
   contains
      procedure :: value => negative_von_mises
   end type search_type

contains

   !> Largest von Mises stress. The largest maxima of a coarse grid below the contact, graded towards the surface, and the most
   !> stressed of points below the middles of the loaded zones are refined by a simplex search (GSL), those on the surface along it.
   !> A disk is searched to half its radius: the force that holds it acts at its centre. NaN where tractions end at a sharp edge,
   !> near which stresses are unbounded. Zero without load; of the bulk stress, with `x` and `y` NaN, if the contact raises it
   !> nowhere.
   type(largest_type) function largest_von_mises(interior) result(largest)
      type(interior_type), intent(in) :: interior
      integer, parameter :: starts = 6
      real(wp), allocatable :: place(:, :), step(:, :), found(:)
      real(wp) :: length, reach, arc, value, weight
      type(search_type) :: search
      integer :: best, start

      call find_largest_remote(interior, largest%value, weight)
      if (largest%value > 0.0_wp) largest%x = ieee_value(1.0_wp, ieee_quiet_nan)
      largest%y = largest%x
      length = 2.0_wp*interior%half_width()
      if (.not. length > 0.0_wp) then
         if (weight > 0.0_wp) largest%value = largest%value/weight
         return
      end if
      if (interior%elements%sharp) then
         largest%value = ieee_value(1.0_wp, ieee_quiet_nan)
         largest%x = largest%value
         largest%y = largest%value
         return
      end if
      reach = length
      if (interior%body%deforms_as_circle()) reach = min(reach, 0.5_wp*interior%body%radius)
      call find_starts(interior, length, reach, place, step, found)
      search%interior = interior
      search%deepest = reach
      do start = 1, min(starts, size(found))
         best = maxloc(found, dim=1)
         if (.not. found(best) > 0.0_wp) exit
         found(best) = -1.0_wp
         call minimum_near(search, step(:, best), place(:, best), value)
         call keep_larger(interior, largest, place(1, best), min(max(place(2, best), 0.0_wp), search%deepest))
      end do
      call refine_on_line(interior, interior%knots(), surface_von_mises, arc, value)
      call keep_larger(interior, largest, arc, 0.0_wp)
      ! Of the layer in which it is the largest part of the yield strength.
      if (ieee_is_finite(largest%y)) weight = interior%weight_at(abs(largest%y))
      if (weight > 0.0_wp) largest%value = largest%value/weight
   end function largest_von_mises

   !> The largest von Mises stress far from the contact of all layers, force/length^2, times its `weight` as in the search.
   subroutine find_largest_remote(interior, largest, weight)
      type(interior_type), intent(in) :: interior
      real(wp), intent(out) :: largest, weight
      real(wp) :: value, depth, here
      integer :: i

      largest = 0.0_wp
      weight = 1.0_wp
      associate (elasticity => interior%body%elasticity)
         do i = 1, elasticity%layer_count() + 1
            depth = 2.0_wp*elasticity%thickness()
            if (i <= elasticity%layer_count()) depth = elasticity%depth_of(i)
            here = interior%weight_at(depth)
            value = von_mises_stress(interior%remote_stress(i))*here
            if (.not. value > largest) cycle
            largest = value
            weight = here
         end do
      end associate
   end subroutine find_largest_remote

   !> Starting points of the search below a contact of the length `length`, to the depth `reach`: arc lengths and depths `place` and
   !> first steps `step`, shapes (2, points), with the von Mises stresses `found` there. They are the local maxima of a grid; and,
   !> of several loaded zones, the most stressed of those under the middles, at the depth of the maximum under Hertz's pressure.
   subroutine find_starts(interior, length, reach, place, step, found)
      type(interior_type), intent(in) :: interior
      real(wp), intent(in) :: length, reach
      real(wp), allocatable, intent(out) :: place(:, :), step(:, :), found(:)
      integer, parameter :: across = 41, down = 21
      real(wp), parameter :: shallowest = 1.0e-3_wp, hertz_depth = 0.35_wp
      real(wp) :: net(across, down), positions(across), depths(down)
      real(wp), allocatable :: zones(:, :)
      integer :: i, j

      positions = [(interior%middle() + length*((i - 1)/(across - 1.0_wp) - 0.5_wp), i=1, across)]
      depths = [(reach*shallowest**((down - j)/(down - 1.0_wp)), j=1, down)]
      allocate (place(2, 0), step(2, 0), found(0))
      do j = 1, down
         do i = 1, across
            net(i, j) = von_mises_at(interior, positions(i), depths(j))
         end do
      end do
      do j = 1, down
         do i = 1, across
            if (net(i, j) < maxval(net(max(1, i - 1):min(across, i + 1), max(1, j - 1):min(down, j + 1)))) cycle
            call add([positions(i), depths(j)], [length/across, 0.2_wp*depths(j)], net(i, j))
         end do
      end do
      zones = interior%zones()
      if (size(zones, 2) == 1) return
      do i = 1, size(zones, 2)
         associate (width => zones(2, i) - zones(1, i), middle => 0.5_wp*(zones(1, i) + zones(2, i)))
            if (.not. hertz_depth*width < reach) cycle
            call add([middle, hertz_depth*width], [0.1_wp*width, 0.1_wp*width], von_mises_at(interior, middle, hertz_depth*width))
         end associate
      end do

   contains

      subroutine add(point, its_step, value)
         real(wp), intent(in) :: point(2), its_step(2), value

         place = reshape([place, point], [2, size(found) + 1])
         step = reshape([step, its_step], [2, size(found) + 1])
         found = [found, value]
      end subroutine add
   end subroutine find_starts

   !> Negative von Mises stress at an arc length and a depth, the objective of the search.
   real(wp) function negative_von_mises(self, x) result(value)
      class(search_type), intent(in) :: self
      real(wp), intent(in) :: x(:)

      value = -von_mises_at(self%interior, x(1), min(max(x(2), 0.0_wp), self%deepest))
   end function negative_von_mises

   !> Largest tension at the surface, force/length^2: at edges of contact and stick zones, where it has cusps, between them
   !> and beside the contact (on a circle, everywhere), but not next to corners, where the pressure compresses the surface without
   !> limit. NaN where it has no limit, as at the end of a surface under shear; `x` and `y` are NaN without any tension,
   !> and if the bulk stress is the largest.
   type(largest_type) function largest_tension(interior) result(largest)
      type(interior_type), intent(in) :: interior
      real(wp) :: place, point(2), value, rival, rival_place

      largest%x = ieee_value(1.0_wp, ieee_quiet_nan)
      largest%y = largest%x
      largest%value = max(interior%bulk_of(1), 0.0_wp)
      if (.not. interior%half_width() > 0.0_wp) return
      if (.not. (interior%body%deforms_as_circle() .or. interior%is_sheared() .or. &
                 interior%body%elasticity%pressure_stretches())) return
      if (interior%elements%singular .or. &
          (interior%elements%sharp .and. interior%body%elasticity%material%pressure_stretches())) then
         largest%value = ieee_value(1.0_wp, ieee_quiet_nan)
         return
      end if
      call refine_on_line(interior, candidates(interior), surface_tension, place, value, rival=rival, rival_place=rival_place)
      if (.not. value > largest%value + certified*interior%peak) return
      point = interior%point_at(place, 0.0_wp)
      largest = largest_type(value, point(1), point(2), rival)
      point = interior%point_at(rival_place, 0.0_wp)
      largest%rival_x = point(1)
   end function largest_tension

   !> The largest normal traction that opens an interface of the layers, and the largest size of the shear there, force/length^2.
   subroutine find_largest_at_interfaces(interior, tension, shear)
      type(interior_type), intent(in) :: interior
      type(largest_type), intent(out) :: tension, shear
      real(wp), allocatable :: places(:)
      integer :: layer

      if (.not. interior%half_width() > 0.0_wp) return
      do layer = 1, interior%body%elasticity%layer_count()
         places = places_at_depth(interior, interior%body%elasticity%depth_of(layer))
         call keep(interface_tension, tension)
         call keep(interface_shear, shear)
      end do

   contains

      subroutine keep(kind, largest)
         integer, intent(in) :: kind
         type(largest_type), intent(inout) :: largest
         real(wp) :: place, point(2), value

         call refine_on_line(interior, places, kind, place, value, layer)
         if (.not. value > largest%value) return
         point = interior%point_at(place, interior%body%elasticity%depth_of(layer))
         largest = largest_type(value, point(1), point(2))
      end subroutine keep
   end subroutine find_largest_at_interfaces

   !> Estimates of the largest tension along the surface of a body with layers, and of the largest von Mises stress in it, as in the
   !> search for it, -1 without a yield strength; force/length^2.
   subroutine estimate_in_layers(interior, tension, von_mises)
      type(interior_type), intent(in) :: interior
      real(wp), intent(out) :: tension, von_mises
      integer, parameter :: across = 24
      real(wp), allocatable :: places(:), below(:)
      integer :: i, j

      tension = max(interior%bulk_of(1), 0.0_wp)
      von_mises = -1.0_wp
      if (interior%body%has_strength()) von_mises = 0.0_wp
      if (.not. interior%half_width() > 0.0_wp) return
      ! Layers are stretched beside the contact, too.
      places = candidates(interior)
      tension = max(tension, maxval([(interior%surface_stress(places(i)), i=1, size(places))]))
      if (.not. interior%body%has_strength()) return
      places = interior%zone_edges(most_between=across)
      associate (elasticity => interior%body%elasticity)
         below = [0.0_wp, interior%half_width()*depths_below, (elasticity%depth_of(i), i=1, elasticity%layer_count())]
      end associate
      do j = 1, size(below)
         von_mises = max(von_mises, maxval([(von_mises_at(interior, places(i), below(j)), i=1, size(places))]))
      end do
   end subroutine estimate_in_layers

   !> Points at a depth, ascending: below the edges of zones, between them, and at distances from them in proportion to the depth.
   function places_at_depth(interior, depth) result(places)
      type(interior_type), intent(in) :: interior
      real(wp), intent(in) :: depth
      real(wp), allocatable :: places(:), edges(:), contact(:, :)
      real(wp), parameter :: steps(15) = [-32.0_wp, -16.0_wp, -8.0_wp, -4.0_wp, -2.0_wp, -1.0_wp, -0.5_wp, 0.0_wp, &
                                          0.5_wp, 1.0_wp, 2.0_wp, 4.0_wp, 8.0_wp, 16.0_wp, 32.0_wp]
      integer :: i

      edges = interior%zone_edges(most_between=24)
      contact = interior%zones()
      places = edges
      do i = 1, size(steps)
         places = merged(places, contact(1, :) + steps(i)*depth)
         places = merged(places, contact(2, :) + steps(i)*depth)
      end do
      places = pack(places, [.true., places(2:) - places(:size(places) - 1) > visible*depth])
      ! Where the stresses are known at once; there is nothing beyond.
      associate (farthest => interior%layers%table%reach - 2.0_wp*interior%half_width())
         places = pack(places, abs(places - interior%middle()) <= farthest)
      end associate
   end function places_at_depth

   !> Candidate points for the largest tension, ascending: zone edges, some points between them, kinks of the shear, and points
   !> beside the contact at increasing distances.
   function candidates(interior) result(places)
      type(interior_type), intent(in) :: interior
      real(wp), allocatable :: places(:)
      real(wp), allocatable :: edges(:), inner(:), inside(:), beside(:)
      integer, parameter :: steps = 10
      real(wp) :: farthest, nearest
      integer :: i

      ! Two points that differ by round-off would leave one side of a cusp out of the search; it is at the zone edge.
      allocate (inner, source=interior%kinks())
      allocate (edges, source=interior%zone_edges(most_between=16))
      inner = merged(edges, pack(inner, [(minval(abs(edges - inner(i))) > certified*interior%half_width(), i=1, size(inner))]))
      allocate (inside, source=pack(inner, [.true., inner(2:) - inner(:size(inner) - 1) > certified*interior%half_width()]))
      nearest = 1.0e-3_wp*interior%half_width()
      farthest = 4.0_wp*interior%half_width()
      if (interior%body%deforms_as_circle()) farthest = max(farthest, pi*interior%body%radius)
      beside = [(nearest*(farthest/nearest)**((i - 1)/(steps - 1.0_wp)), i=1, steps)]
      if (interior%body%deforms_as_circle()) &
         beside = pack(beside, beside <= pi*interior%body%radius - max(abs(inside(1)), abs(inside(size(inside)))))
      places = [inside(1) - beside(size(beside):1:-1), inside, inside(size(inside)) + beside]
      ! Beside the contact there is another one.
      associate (half => 0.5_wp*interior%body%elasticity%period, middle => interior%middle())
         if (half > 0.0_wp) places = [middle - half, pack(places, abs(places - middle) < half), middle + half]
      end associate
   end function candidates

   !> Largest stress along the surface or an interface: the best local maxima of ascending points, refined between their neighbours
   !> by golden-section search. `kind`: surface_tension and so on; `layer`: above the interface; `rival`, `rival_place`: the largest
   !> of those farther than an interval from `place`, -huge(rival) if there are none.
   subroutine refine_on_line(interior, places, kind, place, value, layer, rival, rival_place)
      type(interior_type), intent(in) :: interior
      real(wp), intent(in) :: places(:)
      integer, intent(in) :: kind
      real(wp), intent(out) :: place, value
      integer, intent(in), optional :: layer
      real(wp), intent(out), optional :: rival, rival_place
      integer, parameter :: starts = 6
      real(wp) :: values(size(places)), found(starts), found_at(starts)
      logical :: is_start(size(places)), is_elsewhere(starts)
      integer :: best, i, n, start

      n = size(places)
      values = [(stress_at(places(i)), i=1, n)]
      is_start = [(values(i) >= maxval(values(max(i - 1, 1):min(i + 1, n))), i=1, n)]
      found = -huge(found)
      found_at = places(1)
      do start = 1, starts
         if (.not. any(is_start)) exit
         best = maxloc(values, dim=1, mask=is_start)
         is_start(best) = .false.
         found(start) = values(best)
         found_at(start) = places(best)
         call refine_between(places(max(best - 1, 1)), places(min(best + 1, n)), found_at(start), found(start))
      end do
      best = maxloc(found, dim=1)
      place = found_at(best)
      value = found(best)
      call climb(place, value)
      if (.not. present(rival)) return
      is_elsewhere = abs(found_at - place) > maxval(interior%knots_apart())
      rival = maxval(found, mask=is_elsewhere)
      rival_place = place
      if (any(is_elsewhere)) rival_place = found_at(maxloc(found, dim=1, mask=is_elsewhere))

   contains

      real(wp) function stress_at(arc)
         real(wp), intent(in) :: arc
         real(wp) :: tractions(2)

         select case (kind)
         case (surface_von_mises)
            stress_at = interior%surface_von_mises(arc)*interior%weight_at(0.0_wp)
         case (surface_tension)
            stress_at = interior%surface_stress(arc)
            if (interior%is_unresolved(arc)) stress_at = -huge(stress_at)
         case default
            tractions = interior%interface_tractions(arc, layer)
            stress_at = merge(tractions(1), abs(tractions(2)), kind == interface_tension)
         end select
      end function stress_at

      !> Take the largest stress between two points if it is larger.
      subroutine refine_between(from, to, place, value)
         real(wp), intent(in) :: from, to
         real(wp), intent(inout) :: place, value
         real(wp), parameter :: golden = 0.6180339887498949_wp, nearly = 1.0e-5_wp
         real(wp) :: left, right, inner(2), found(2), least

         left = from
         right = to
         least = nearly*interior%half_width()
         inner = [right - golden*(right - left), left + golden*(right - left)]
         found = [stress_at(inner(1)), stress_at(inner(2))]
         do while (right - left > max(least, 4.0_wp*epsilon(left)*max(abs(left), abs(right))))
            if (found(1) >= found(2)) then
               right = inner(2)
               inner = [right - golden*(right - left), inner(1)]
               found = [stress_at(inner(1)), found(1)]
            else
               left = inner(1)
               inner = [inner(2), left + golden*(right - left)]
               found = [found(2), stress_at(inner(2))]
            end if
         end do
         if (.not. maxval(found) > value) return
         value = maxval(found)
         place = inner(maxloc(found, dim=1))
      end subroutine refine_between

      !> Go on to larger maxima in the intervals beside a maximum between edges: tractions on straight lines give the stress a small
      !> maximum of its own in every interval, and which of them are nearest to the points of the search is a matter of round-off.
      subroutine climb(place, value)
         real(wp), intent(inout) :: place, value
         integer, parameter :: most_steps = 20, beside = 2
         real(wp), allocatable :: knots(:)
         real(wp) :: before
         integer :: step, here, side

         knots = interior%knots()
         associate (edges => interior%elements%edges)
            if (minval(abs(edges - place)) <= maxval(interior%knots_apart())) return
         end associate
         do step = 1, most_steps
            before = place
            here = count(knots <= place)
            do side = max(here - beside, 1), min(here + beside, size(knots) - 1)
               call refine_between(knots(side), knots(side + 1), place, value)
            end do
            if (abs(place - before) <= visible*interior%half_width()) exit
         end do
      end subroutine climb
   end subroutine refine_on_line

   !> Von Mises stress at a depth below the arc length `arc`, -1 outside the body.
   real(wp) function von_mises_at(interior, arc, depth)
      type(interior_type), intent(in) :: interior
      real(wp), intent(in) :: arc, depth
      real(wp) :: point(2), values(4)

      point = interior%point_at(arc, depth)
      values = interior%stress(point(1), point(2))
      von_mises_at = -1.0_wp
      if (ieee_is_finite(values(1))) von_mises_at = von_mises_stress(values)*interior%weight_at(depth)
   end function von_mises_at

   subroutine keep_larger(interior, largest, arc, depth)
      type(interior_type), intent(in) :: interior
      type(largest_type), intent(inout) :: largest
      real(wp), intent(in) :: arc, depth
      real(wp) :: value, point(2)

      value = von_mises_at(interior, arc, depth)
      if (.not. value > largest%value) return
      point = interior%point_at(arc, depth)
      largest = largest_type(value, point(1), point(2))
   end subroutine keep_larger

end module mfv_stress_search
