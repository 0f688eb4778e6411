!> Tractions between the nodes: continuous, from the values at nodes and the edges of contact and stick zones between them.
!>
!> A pressure vanishes at a smooth edge as the root of the distance, and so does, at the edge of a stick zone, the remaining
!> friction |mu p| - |tau| (Hertz; Cattaneo and Mindlin, dissertation eqs. 3.1, 3.7). Both, divided by their roots, are
!> smooth: they are interpolated linearly and extrapolated to the edges. Nodal values are corrected for the discretisation
!> error where it is known (mfv_edge_solutions); those within two intervals of an edge are not used. On unequal intervals they are
!> means, and so are those of the interpolated tractions. Resultant forces (with radial normals:
!> and the moment) are those of the nodal values. The result is projected onto linear elements that are graded towards the edges;
!> the projection preserves the integrals of tractions with smooth functions, on which stresses depend.
module mfv_surface_tractions
   use mfv_edge_solutions, only: discrete_over_exact, graded_solution_type, least_power, most_power, new_graded_solution, &
                                 find_solved_distance
   use mfv_element_tree, only: last_not_above
   use mfv_kinds, only: pi, wp
   use mfv_lapack, only: dgesv
   use mfv_near_field, only: near_field_type
   use mfv_quadrature, only: gauss_points
   use mfv_tolerances, only: certified, significant, visible
   implicit none
   private
   public :: find_closed_elements, zone_list_type, traction_elements_type, find_traction_elements, merged, root_shift

   !> Within half an interval, and not at its end, where edges lie that cannot be located: round-off must not decide.
   real(wp), parameter :: half_interval = 0.5_wp*(1.0_wp - significant)

   !> Edges, arc lengths, left one first; shapes (2, zones). At a sharp edge the pressure does not vanish: the end of a body's
   !> surface. `pair`: near field of both bodies, 0 without coupling. `turn`: angle by which the normals turn per arc length,
   !> radians per length: with radial normals 1/R for a disk, -1/R for a hole; 0 for parallel normals.
   type :: zone_list_type
      real(wp), allocatable :: contact(:, :), stick(:, :)
      logical, allocatable :: sharp(:, :)
      type(near_field_type) :: pair
      real(wp) :: turn = 0.0_wp
      !> Length after which the surface repeats if all sharp edges are ends of it, else 0; its middle, length; whether a circle is
      !> loaded all around.
      real(wp) :: period = 0.0_wp, middle = 0.0_wp
      logical :: closed = .false.
      !> Minimum of elements in all contact zones: with fewer, the point of the largest von Mises stress, a flat maximum, would
      !> move to their ends.
      integer :: fewest_elements = 300
   end type zone_list_type

   !> Elements from `from` to `to`, lengths, in ascending order, with p + i tau linear from `first` to `last`, force/length^2;
   !> shapes (elements). `edges`: of contact and stick zones, ascending. `sharp`: tractions at a sharp edge, near which
   !> stresses are unbounded. `singular`: shear among them, with which the
   !> tangential stress diverges.
   type :: traction_elements_type
      real(wp), allocatable :: from(:), to(:), edges(:)
      complex(wp), allocatable :: first(:), last(:)
      logical :: sharp = .false., singular = .false.
   end type traction_elements_type

   !> A piecewise linear function.
   type :: interpolant_type
      real(wp), allocatable :: x(:), value(:)
      !> Whether it is extrapolated from points as far apart as the distance from them, not from neighbours: on unequal intervals.
      logical :: far_apart = .false.
   contains
      procedure :: at
      procedure :: continued
   end type interpolant_type

   !> A zone: the sides (left, right) where the function vanishes as a root, the exponents there, and the function divided by
   !> these roots.
   type :: fitted_zone_type
      real(wp) :: edge(2) = 0.0_wp, power(2) = 0.5_wp
      logical :: rooted(2) = .true.
      !> Whether the discretisation error at the edges is known.
      logical :: known(2) = .false.
      type(interpolant_type) :: rest
   contains
      procedure :: contains_place
      procedure :: roots
   end type fitted_zone_type

   !> One contact zone: the pressure; `limit` tau/p in slip zones, linear between them; in stick zones the remaining friction,
   !> over the pressure where a stick zone ends with the contact. If nodes without pressure have shear, `shear` instead of
   !> these.
   type :: fitted_patch_type
      real(wp), allocatable :: arc(:), width(:), pressure(:), shear(:)
      type(fitted_zone_type) :: contact
      type(fitted_zone_type), allocatable :: stick(:)
      type(interpolant_type) :: limit, shear_rest
      logical :: has_ratio = .true.
      !> See zone_list_type.
      real(wp) :: turn = 0.0_wp
      !> Whether the contact edges are ends of intervals, to be located between the nodes; and whether intervals are unequal.
      logical :: counted = .false., graded = .false.
      !> Tractions up to this are zero, force/length^2.
      real(wp) :: nothing = 0.0_wp
   contains
      procedure :: tractions
   end type fitted_patch_type

contains

   !> Elements under `pressure` and `shear` (on the lower body, force/length^2) at the nodes `arc` with the intervals `width`,
   !> lengths; shapes (nodes). `zones`: known edges; other contact zones are located from their nodes. `longest`: upper limit
   !> of the element length.
   subroutine find_traction_elements(arc, width, pressure, shear, zones, longest, elements)
      real(wp), intent(in) :: arc(:), width(:), pressure(:), shear(:), longest
      type(zone_list_type), intent(in) :: zones
      type(traction_elements_type), intent(out) :: elements
      type(fitted_patch_type) :: patch
      real(wp), allocatable :: edges(:, :)
      logical, allocatable :: sharp(:, :)
      integer, allocatable :: owner(:)
      integer, parameter :: fewest_in_zone = 24
      integer, allocatable :: nodes(:), last(:)
      type(traction_elements_type), allocatable :: parts(:)
      integer :: fewest, i, j, k, number

      patch%turn = zones%turn
      patch%graded = maxval(width) - minval(width) > visible*maxval(width)
      patch%nothing = certified*max(maxval(abs(pressure)), maxval(abs(shear)))
      call assign_nodes(arc, width, max(abs(pressure), abs(shear)) > patch%nothing, zones, edges, sharp, owner)
      fewest = max(zones%fewest_elements/max(size(edges, 2), 1), min(zones%fewest_elements, fewest_in_zone))
      allocate (last(size(edges, 2)), source=0)
      do j = 1, size(arc)
         if (owner(j) > 0) last(owner(j)) = j
      end do
      allocate (parts(size(edges, 2)))
      number = 0
      do j = 1, size(arc)
         ! Each patch at its first node: from left to right.
         i = owner(j)
         if (i == 0) cycle
         if (last(i) == 0) cycle
         nodes = pack([(k, k=j, last(i))], owner(j:last(i)) == i)
         last(i) = 0
         patch%arc = arc(nodes)
         patch%width = width(nodes)
         patch%pressure = pressure(nodes)
         patch%shear = shear(nodes)
         patch%contact = fitted_zone_type(edge=edges(:, i), rooted=.not. sharp(:, i), rest=interpolant_type())
         patch%counted = i > size(zones%contact, 2)
         call fit_patch(patch, zones)
         number = number + 1
         call find_elements(patch, min(longest, (patch%contact%edge(2) - patch%contact%edge(1))/fewest), parts(number))
      end do
      elements%from = [(parts(k)%from, k=1, number)]
      elements%to = [(parts(k)%to, k=1, number)]
      elements%first = [(parts(k)%first, k=1, number)]
      elements%last = [(parts(k)%last, k=1, number)]
      elements%edges = [(parts(k)%edges, k=1, number)]
      elements%sharp = any(parts%sharp)
      elements%singular = any(parts%singular)
   end subroutine find_traction_elements

   !> Elements all around a circle, with the forces and the moment of the nodes, as find_traction_elements: linear between the
   !> nodes. `turn`: see zone_list_type.
   subroutine find_closed_elements(arc, width, pressure, shear, turn, longest, elements)
      real(wp), intent(in) :: arc(:), width(:), pressure(:), shear(:), turn, longest
      type(traction_elements_type), intent(out) :: elements
      complex(wp) :: traction(0:size(arc)), force
      complex(wp), parameter :: i = (0.0_wp, 1.0_wp)
      real(wp), allocatable :: knots(:)
      real(wp) :: half
      integer :: n, parts, j, k

      n = size(arc)
      traction(1:) = cmplx(pressure, shear, wp)
      ! Linear interpolation reduces the force, the first harmonic, by the square of sin(half)/half.
      half = 0.5_wp*turn*width(1)
      force = sum(traction(1:)*exp(-i*turn*arc))/n
      traction(1:) = traction(1:) + ((half/sin(half))**2 - 1.0_wp)*force*exp(i*turn*arc)
      traction(0) = traction(n)
      parts = max(1, ceiling(width(1)/longest))
      allocate (elements%first(n*parts), elements%last(n*parts))
      knots = [(arc(1) + (real(j, wp)/parts - 1.0_wp)*width(1), j=0, n*parts)]
      elements%from = knots(:n*parts)
      elements%to = knots(2:)
      do j = 1, n
         do k = 1, parts
            associate (e => (j - 1)*parts + k, a => real(k - 1, wp)/parts, b => real(k, wp)/parts)
               elements%first(e) = traction(j - 1) + a*(traction(j) - traction(j - 1))
               elements%last(e) = traction(j - 1) + b*(traction(j) - traction(j - 1))
            end associate
         end do
      end do
      elements%edges = [knots(1), knots(n*parts + 1)]
   end subroutine find_closed_elements

   !> Contact zone of each loaded node, 0 without load: the nearest; nodes outside all zones, or with a node without load between,
   !> form new ones.
   subroutine assign_nodes(arc, width, loaded, zones, edges, sharp, owner)
      real(wp), intent(in) :: arc(:), width(:)
      logical, intent(in) :: loaded(:)
      type(zone_list_type), intent(in) :: zones
      real(wp), allocatable, intent(out) :: edges(:, :)
      logical, allocatable, intent(out) :: sharp(:, :)
      integer, allocatable, intent(out) :: owner(:)
      real(wp), allocatable :: left(:)
      real(wp) :: distance
      integer :: i, nearest

      edges = zones%contact
      sharp = zones%sharp
      left = zones%contact(1, :)
      allocate (owner(size(arc)), source=0)
      do i = 1, size(arc)
         if (.not. loaded(i)) cycle
         nearest = nearest_zone(arc(i))
         distance = huge(1.0_wp)
         if (nearest > 0) distance = away(nearest)
         if (distance > 0.75_wp*width(i) .or. (distance > 0.5_wp*width(i) .and. is_apart())) then
            edges = reshape([edges, arc(i) - 0.5_wp*width(i), arc(i) + 0.5_wp*width(i)], [2, size(edges, 2) + 1])
            sharp = reshape([sharp, .false., .false.], [2, size(edges, 2)])
            nearest = size(edges, 2)
         else if (nearest > size(zones%contact, 2)) then
            edges(2, nearest) = arc(i) + 0.5_wp*width(i)
         end if
         owner(i) = nearest
      end do

   contains

      !> Number of the zone nearest to a place: one of the two given ones beside it (these are in ascending order), or the one
      !> formed last; 0 if there is no zone yet.
      pure integer function nearest_zone(x) result(nearest)
         real(wp), intent(in) :: x
         integer :: candidates(3), i, k

         k = last_not_above(left, x)
         candidates = [k, min(k + 1, size(edges, 2)), size(edges, 2)]
         nearest = candidates(3)
         do i = 1, size(candidates)
            if (candidates(i) < 1) cycle
            if (away(candidates(i)) < away(nearest) .or. (candidates(i) < nearest .and. &
                                                          away(candidates(i)) <= away(nearest))) nearest = candidates(i)
         end do
      end function nearest_zone

      !> Distance of the node from a zone, negative inside.
      pure real(wp) function away(zone)
         integer, intent(in) :: zone

         away = max(edges(1, zone) - arc(i), arc(i) - edges(2, zone))
      end function away

      !> Whether the next node towards the nearest zone has no load.
      pure logical function is_apart()
         integer :: next

         is_apart = .true.
         if (nearest == 0) return
         next = i + merge(1, -1, arc(i) < edges(1, nearest))
         if (next >= 1 .and. next <= size(loaded)) is_apart = .not. loaded(next)
      end function is_apart
   end subroutine assign_nodes

   !> Fit a patch to its nodes and edges.
   subroutine fit_patch(patch, zones)
      type(fitted_patch_type), intent(inout) :: patch
      type(zone_list_type), intent(in) :: zones
      real(wp) :: values(size(patch%arc))
      integer :: i

      patch%has_ratio = all(patch%pressure > patch%nothing)
      if (allocated(patch%stick)) deallocate (patch%stick)
      if (patch%has_ratio) then
         patch%stick = stick_zones(patch, zones)
         call find_limit(patch)
         call find_powers(patch, zones%pair)
      else
         allocate (patch%stick(0))
         call fit_zone(patch, patch%shear, patch%contact)
         patch%shear_rest = patch%contact%rest
      end if
      call find_known(patch, zones%pair)
      if (patch%counted) call locate_edges(patch)
      values = patch%pressure
      call correct_error(patch, patch%contact, values)
      call fit_zone(patch, values, patch%contact)
      do i = 1, size(patch%stick)
         values = patch%limit%at(patch%arc)*patch%pressure - patch%shear
         call correct_error(patch, patch%stick(i), values)
         if (.not. all(patch%stick(i)%rooted)) values = values/patch%pressure
         call fit_zone(patch, values, patch%stick(i))
      end do
   end subroutine fit_patch

   !> Contact edges between the nodes, if the discretisation error is known.
   subroutine locate_edges(patch)
      type(fitted_patch_type), intent(inout) :: patch
      real(wp) :: distance
      integer :: nodes(size(patch%arc)), i, n, side
      logical :: found

      n = size(patch%arc)
      do side = 1, 2
         if (.not. (patch%contact%rooted(side) .and. patch%contact%known(side))) cycle
         nodes = [(merge(i, n + 1 - i, side == 1), i=1, n)]
         distance = 0.5_wp
         call find_solved_distance(patch%pressure(nodes), patch%contact%power(side), 0, distance, found)
         patch%contact%edge(side) = patch%arc(nodes(1)) + (2*side - 3)*patch%width(nodes(1))*distance
      end do
   end subroutine locate_edges

   !> Find edges with a known discretisation error: of contact zones with enough slipping nodes, and of stick zones without
   !> coupling of the `pair`.
   subroutine find_known(patch, pair)
      type(fitted_patch_type), intent(inout) :: patch
      type(near_field_type), intent(in) :: pair
      integer, parameter :: fewest_nodes = 5, fewest_slipping = 4
      logical :: slips(size(patch%arc))
      integer :: i, n

      n = size(patch%arc)
      patch%contact%known = patch%has_ratio .and. n >= fewest_nodes .and. patch%contact%power > least_power .and. &
                            patch%contact%power < most_power
      if (.not. patch%has_ratio) return
      if (pair%coupling_ratio() > 0.0_wp) then
         slips = outside_stick_zones(patch)
         patch%contact%known = patch%contact%known .and. &
                               [all(slips(:min(n, fewest_slipping))), all(slips(max(1, n - fewest_slipping + 1):))]
      else
         do i = 1, size(patch%stick)
            patch%stick(i)%known = count(patch%stick(i)%contains_place(patch%arc)) >= fewest_nodes
         end do
      end if
   end subroutine find_known

   !> Exponents at edges next to slipping nodes: see mfv_zone_edges.
   subroutine find_powers(patch, pair)
      type(fitted_patch_type), intent(inout) :: patch
      type(near_field_type), intent(in) :: pair
      integer :: i, side, outermost

      do side = 1, 2
         outermost = merge(1, size(patch%arc), side == 1)
         if (any(patch%stick%contains_place(patch%arc(outermost)))) cycle
         patch%contact%power(side:side) = 0.5_wp + (2*side - 3)*exponent_shift(patch%arc(outermost:outermost))
      end do
      do i = 1, size(patch%stick)
         patch%stick(i)%power = 0.5_wp + [1, -1]*exponent_shift(patch%stick(i)%edge)
      end do

   contains

      pure function exponent_shift(places)
         real(wp), intent(in) :: places(:)
         real(wp) :: exponent_shift(size(places))

         exponent_shift = root_shift(pair%edge_product(patch%limit%at(places)))
      end function exponent_shift
   end subroutine find_powers

   !> Deviation of the exponent from 1/2 at the edge of a slip zone, for the `product` of mfv_near_field. Below 1/2 in magnitude, so
   !> that exponents remain positive.
   elemental real(wp) function root_shift(product)
      real(wp), intent(in) :: product
      real(wp), parameter :: most = 0.49_wp

      root_shift = min(max(atan(product)/pi, -most), most)
   end function root_shift

   !> The stick zones of a patch that contain nodes, those without a node between them as one; `rooted` on sides with slipping
   !> nodes.
   function stick_zones(patch, zones) result(stick)
      type(fitted_patch_type), intent(in) :: patch
      type(zone_list_type), intent(in) :: zones
      type(fitted_zone_type), allocatable :: stick(:)
      type(fitted_zone_type) :: zone
      real(wp) :: before, next
      integer :: i, last

      allocate (stick(0))
      do i = 1, size(zones%stick, 2)
         zone%edge = [max(zones%stick(1, i), patch%contact%edge(1)), min(zones%stick(2, i), patch%contact%edge(2))]
         if (.not. any(zone%contains_place(patch%arc))) cycle
         last = size(stick)
         if (last > 0) then
            if (.not. any(patch%arc >= stick(last)%edge(2) .and. patch%arc <= zone%edge(1))) then
               stick(last)%edge(2) = zone%edge(2)
               cycle
            end if
         end if
         stick = [stick, zone]
      end do
      do i = 1, size(stick)
         before = -huge(1.0_wp)
         next = huge(1.0_wp)
         if (i > 1) before = stick(i - 1)%edge(2)
         if (i < size(stick)) next = stick(i + 1)%edge(1)
         stick(i)%rooted = [any(patch%arc > before .and. patch%arc <= stick(i)%edge(1)), &
                            any(patch%arc >= stick(i)%edge(2) .and. patch%arc < next)]
      end do
   end function stick_zones

   !> tau/p of the slipping nodes, also at the rooted edges of the adjacent stick zones.
   subroutine find_limit(patch)
      type(fitted_patch_type), intent(inout) :: patch
      logical :: slips(size(patch%arc))
      real(wp), dimension(size(patch%arc) + 2*size(patch%stick)) :: x, value
      integer :: i, node, number

      slips = slipping_nodes(patch)
      number = 0
      node = 0
      do i = 1, size(patch%stick)
         associate (zone => patch%stick(i))
            call add_nodes_before(zone%edge(1))
            if (zone%rooted(1)) call add(zone%edge(1), findloc(slips(:node), .true., dim=1, back=.true.))
            node = max(node, count(patch%arc < zone%edge(2)))
            if (zone%rooted(2)) call add(zone%edge(2), node + findloc(slips(node + 1:), .true., dim=1))
         end associate
      end do
      call add_nodes_before(huge(1.0_wp))
      patch%limit = interpolant_type()
      patch%limit%x = x(:number)
      patch%limit%value = value(:number)

   contains

      subroutine add_nodes_before(place)
         real(wp), intent(in) :: place

         do while (node < size(patch%arc))
            if (patch%arc(node + 1) > place) exit
            node = node + 1
            if (slips(node)) call add(patch%arc(node), node)
         end do
      end subroutine add_nodes_before

      !> Add a point with tau/p of a node.
      subroutine add(place, from)
         real(wp), intent(in) :: place
         integer, intent(in) :: from

         number = number + 1
         x(number) = place
         value(number) = patch%shear(from)/patch%pressure(from)
      end subroutine add
   end subroutine find_limit

   !> Nodes outside all stick zones.
   pure function outside_stick_zones(patch) result(outside)
      type(fitted_patch_type), intent(in) :: patch
      logical :: outside(size(patch%arc))
      integer :: i

      outside = [(.not. any(patch%stick%contains_place(patch%arc(i))), i=1, size(outside))]
   end function outside_stick_zones

   !> Slipping nodes: those outside all stick zones, except within half an interval of an edge if there is another such node
   !> behind, which is not itself as near to the next edge: an edge may be this far inside the last sticking node.
   pure function slipping_nodes(patch) result(slips)
      type(fitted_patch_type), intent(in) :: patch
      logical, dimension(size(patch%arc)) :: slips, outside
      integer :: behind(size(patch%arc)), i, side, beside

      outside = outside_stick_zones(patch)
      behind = 0
      do i = 1, size(patch%stick)
         do side = 1, 2
            if (.not. patch%stick(i)%rooted(side)) cycle
            beside = merge(count(patch%arc <= patch%stick(i)%edge(1)), count(patch%arc < patch%stick(i)%edge(2)) + 1, side == 1)
            associate (next => beside + 2*side - 3)
               if (next < 1 .or. next > size(outside)) cycle
               if (outside(next) .and. abs(patch%arc(beside) - patch%stick(i)%edge(side)) < half_interval*patch%width(beside)) &
                  behind(beside) = next
            end associate
         end do
      end do
      slips = outside
      do i = 1, size(slips)
         if (behind(i) == 0) cycle
         slips(i) = behind(behind(i)) == i
      end do
   end function slipping_nodes

   !> Correct the `values` at the nodes of a zone for the discretisation error, next to edges where it is known. The outermost
   !> node may be slightly outside its edge.
   subroutine correct_error(patch, zone, values)
      type(fitted_patch_type), intent(in) :: patch
      type(fitted_zone_type), intent(in) :: zone
      real(wp), intent(inout) :: values(:)
      integer, allocatable :: nodes(:)
      type(graded_solution_type) :: solution
      real(wp) :: distance, inside(size(values))
      logical :: is_solved(size(values))
      integer :: i, side

      if (patch%graded) inside = values + missed_by_grading(patch, values)
      is_solved = .not. zone%contains_place(patch%arc)
      do side = 1, 2
         if (.not. (zone%rooted(side) .and. zone%known(side))) cycle
         nodes = pack([(i, i=1, size(values))], zone%contains_place(patch%arc) .or. &
                      (abs(patch%arc - zone%edge(side)) < half_interval*patch%width .and. abs(values) > patch%nothing))
         if (side == 2) nodes = nodes(size(nodes):1:-1)
         distance = (2*side - 3)*(zone%edge(side) - patch%arc(nodes(1)))
         if (patch%graded) then
            solution = new_graded_solution(patch%width(nodes), zone%power(side))
            is_solved(nodes(:min(size(nodes), solution%intervals()))) = .true.
            values(nodes) = values(nodes)/solution%over_exact(distance - 0.5_wp*patch%width(nodes(1)), size(nodes))
         else
            distance = distance/patch%width(nodes(1))
            nodes = nodes(2:)
            values(nodes) = values(nodes)/discrete_over_exact(zone%power(side), distance, size(nodes))
         end if
      end do
      if (patch%graded .and. all(zone%rooted .and. zone%known)) values = merge(values, inside, is_solved)
   end subroutine correct_error

   !> What the discrete tractions at nodes far from edges miss of the means of the exact ones, in the unit of the `values`. Within
   !> an interval of the width h the exact ones differ by p' (x - x_j) from their mean, a dipole of p' h^3/12. The displacements
   !> by the dipoles are those by tractions -(p' h^2/12)', which the discrete ones have in excess: where h changes in first order.
   pure function missed_by_grading(patch, values) result(missed)
      type(fitted_patch_type), intent(in) :: patch
      real(wp), intent(in) :: values(:)
      real(wp) :: missed(size(values)), dipoles(size(values) - 1)
      integer :: n

      n = size(values)
      missed = 0.0_wp
      if (n < 3) return
      dipoles = (values(2:) - values(:n - 1))/(patch%arc(2:) - patch%arc(:n - 1))*patch%width(2:)*patch%width(:n - 1)/12.0_wp
      missed(2:n - 1) = (dipoles(2:) - dipoles(:n - 2))/patch%width(2:n - 1)
   end function missed_by_grading

   !> Intervals next to each edge that are not used: two, or, without other edges nearby and without coupling, a fraction of
   !> many more, so that the remaining discretisation error vanishes with mesh refinement. They are fewer where the `values` at
   !> the nodes have a maximum near the edge, as on a rounded punch or beside the tip of a wedge. On unequal intervals, of which
   !> many are between, they are two, or one with a known discretisation error and the power 1/2.
   pure function skipped_intervals(patch, zone, values) result(skipped)
      type(fitted_patch_type), intent(in) :: patch
      type(fitted_zone_type), intent(in) :: zone
      real(wp), intent(in) :: values(:)
      integer :: skipped(2), nodes(size(values)), i, n, side
      real(wp) :: reach, nothing
      logical :: many

      skipped = merge(1, 2, zone%known .and. .not. abs(zone%power - 0.5_wp) > 0.0_wp)
      if (patch%graded) return
      skipped = 0
      many = all(zone%known .or. .not. zone%rooted) .and. .not. any(abs(zone%power - 0.5_wp) > 0.0_wp)
      n = count(zone%contains_place(patch%arc))
      if (n == 0) return
      nodes(:n) = pack([(i, i=1, size(values))], zone%contains_place(patch%arc))
      nothing = certified*maxval(abs(values))
      do side = 1, 2
         do i = 1, n - 1
            ! Nodes that slip beside the edge have values that vanish up to round-off.
            if (size_of(i) > nothing .and. size_of(i + 1) <= size_of(i)*(1.0_wp + certified)) exit
         end do
         reach = 2.0_wp*abs(patch%arc(nodes(i)) - zone%edge(side))/patch%width(nodes(i))
         skipped(side) = min(2, int(0.25_wp*reach))
         if (many) skipped(side) = max(skipped(side), nint(0.4_wp*sqrt(min(reach, real(n, wp)))))
         nodes(:n) = nodes(n:1:-1)
      end do

   contains

      pure real(wp) function size_of(number)
         integer, intent(in) :: number

         size_of = abs(values(nodes(number)))
      end function size_of
   end function skipped_intervals

   !> `values` at the nodes of a patch over the roots of a zone, as a table of its nodes, except those nearer to a rooted edge
   !> than skipped_intervals, if any remain.
   subroutine fit_zone(patch, values, zone)
      type(fitted_patch_type), intent(in) :: patch
      real(wp), intent(in) :: values(:)
      type(fitted_zone_type), intent(inout) :: zone
      logical :: used(size(values))
      integer :: intervals(2), i

      intervals = skipped_intervals(patch, zone, values)
      do i = maxval(intervals), 0, -1
         intervals = min(intervals, i)
         used = zone%contains_place(patch%arc)
         if (zone%rooted(1)) used = used .and. patch%arc - zone%edge(1) > intervals(1)*width_from(zone%edge(1))
         if (zone%rooted(2)) used = used .and. zone%edge(2) - patch%arc > intervals(2)*width_from(zone%edge(2))
         if (count(used) > merge(1, 0, i > 0)) exit
      end do
      if (.not. any(used)) then
         ! The only nodes are outside the edges: set the resultant.
         zone%rest%x = [0.5_wp*sum(zone%edge)]
         zone%rest%value = [sum(values)/size(values)/max(zone%roots(zone%rest%x(1)), tiny(1.0_wp))]
         return
      end if
      zone%rest%x = pack(patch%arc, used)
      zone%rest%far_apart = patch%graded
      zone%rest%value = pack(values, used)/zone%roots(zone%rest%x)
      if (patch%graded) call fit_means(zone, pack(patch%width, used), pack(values, used))

   contains

      !> Widths of the intervals; of unequal ones at least half the distance of the third node from the edge: the mesh may be finest
      !> elsewhere.
      function width_from(edge) result(width)
         real(wp), intent(in) :: edge
         real(wp) :: width(size(values))
         integer, parameter :: few = 2
         integer :: farther

         width = patch%width
         if (.not. patch%graded) return
         farther = minloc(abs(patch%arc - edge), dim=1) + merge(few, -few, edge < zone%edge(2))
         width = max(width, 0.5_wp*abs(patch%arc(max(1, min(farther, size(width)))) - edge))
      end function width_from
   end subroutine fit_zone

   !> Whether a place is inside a zone.
   elemental logical function contains_place(self, x)
      class(fitted_zone_type), intent(in) :: self
      real(wp), intent(in) :: x

      contains_place = x > self%edge(1) .and. x < self%edge(2)
   end function contains_place

   !> Roots of the distances from the rooted edges, over the length of the zone; 0 outside.
   elemental real(wp) function roots(self, x)
      class(fitted_zone_type), intent(in) :: self
      real(wp), intent(in) :: x

      roots = 1.0_wp
      associate (length => max(self%edge(2) - self%edge(1), tiny(1.0_wp)))
         if (self%rooted(1)) roots = roots*root(max(x - self%edge(1), 0.0_wp)/length, self%power(1))
         if (self%rooted(2)) roots = roots*root(max(self%edge(2) - x, 0.0_wp)/length, self%power(2))
      end associate
   end function roots

   !> A power, faster for 1/2, that of most edges.
   elemental real(wp) function root(x, power)
      real(wp), intent(in) :: x, power

      if (abs(power - 0.5_wp) > 0.0_wp) then
         root = x**power
      else
         root = sqrt(x)
      end if
   end function root

   !> Set the table of a zone so that the means over intervals of a `width` about its points are `values`, by iteration from the
   !> values in the middle.
   subroutine fit_means(zone, width, values)
      type(fitted_zone_type), intent(inout) :: zone
      real(wp), intent(in) :: width(:), values(:)
      integer, parameter :: points = 4, iterations = 4
      real(wp) :: t(points), weight(points), x(points, size(values)), traction(points, size(values))
      integer :: i

      call gauss_points(-0.5_wp, 0.5_wp, t, weight)
      do i = 1, size(values)
         x(:, i) = zone%rest%x(i) + width(i)*t
      end do
      do i = 1, iterations
         traction = reshape(zone%roots([x])*zone%rest%continued([x]), shape(x))
         zone%rest%value = zone%rest%value + (values - matmul(weight, traction))/zone%roots(zone%rest%x)
      end do
   end subroutine fit_means

   !> Linear interpolation in a table at ascending `x`, constant outside; 0 for an empty one.
   pure function at(self, x) result(values)
      class(interpolant_type), intent(in) :: self
      real(wp), intent(in) :: x(:)
      real(wp) :: values(size(x))
      integer :: before(size(x)), i, n

      values = 0.0_wp
      n = size(self%x)
      if (n == 0) return
      before = last_before(self%x, x)
      do i = 1, size(x)
         if (before(i) == 0 .or. before(i) == n) then
            values(i) = self%value(max(1, before(i)))
         else
            values(i) = along(self, before(i), before(i) + 1, x(i))
         end if
      end do
   end function at

   !> The same with linear extrapolation, limited to between half and twice the last value.
   pure function continued(self, x) result(values)
      class(interpolant_type), intent(in) :: self
      real(wp), intent(in) :: x(:)
      real(wp) :: values(size(x)), bounds(2)
      integer :: i, last, other, inwards, n

      values = self%at(x)
      n = size(self%x)
      if (n < 2) return
      do i = 1, size(x)
         if (x(i) >= self%x(1) .and. x(i) < self%x(n)) cycle
         last = merge(1, n, x(i) < self%x(1))
         inwards = merge(1, -1, last == 1)
         other = last + inwards
         if (self%far_apart) then
            do while (other > 1 .and. other < n .and. abs(self%x(other) - self%x(last)) < abs(x(i) - self%x(last)))
               other = other + inwards
            end do
         end if
         bounds = [0.5_wp, 2.0_wp]*self%value(last)
         values(i) = min(max(along(self, last, other, x(i)), minval(bounds)), maxval(bounds))
      end do
   end function continued

   !> The straight line through the points i and j of a table.
   pure real(wp) function along(self, i, j, x)
      type(interpolant_type), intent(in) :: self
      integer, intent(in) :: i, j
      real(wp), intent(in) :: x

      along = self%value(i) + (self%value(j) - self%value(i))*(x - self%x(i))/(self%x(j) - self%x(i))
   end function along

   !> Indices of the last of ascending positions not beyond ascending `x`, 0 for none.
   pure function last_before(positions, x) result(last)
      real(wp), intent(in) :: positions(:), x(:)
      integer :: last(size(x)), i, j

      j = 0
      do i = 1, size(x)
         do while (j < size(positions))
            if (positions(j + 1) > x(i)) exit
            j = j + 1
         end do
         last(i) = j
      end do
   end function last_before

   !> p + i tau of a patch at ascending places.
   pure function tractions(self, x)
      class(fitted_patch_type), intent(in) :: self
      real(wp), intent(in) :: x(:)
      complex(wp) :: tractions(size(x))
      real(wp) :: pressure(size(x)), shear(size(x))
      integer :: i

      pressure = self%contact%roots(x)*self%contact%rest%continued(x)
      if (self%has_ratio) then
         shear = self%limit%at(x)*pressure
         do i = 1, size(self%stick)
            associate (zone => self%stick(i), first => count(x <= self%stick(i)%edge(1)) + 1, &
                       last => count(x < self%stick(i)%edge(2)))
               associate (lack => zone%roots(x(first:last))*zone%rest%continued(x(first:last)))
                  if (all(zone%rooted)) then
                     shear(first:last) = shear(first:last) - lack
                  else
                     shear(first:last) = shear(first:last) - lack*pressure(first:last)
                  end if
               end associate
            end associate
         end do
      else
         shear = self%contact%roots(x)*self%shear_rest%continued(x)
      end if
      tractions = cmplx(pressure, shear, wp)
   end function tractions

   !> Find the elements of a patch.
   subroutine find_elements(patch, longest, elements)
      type(fitted_patch_type), intent(in) :: patch
      real(wp), intent(in) :: longest
      type(traction_elements_type), intent(inout) :: elements
      real(wp), allocatable :: knots(:)
      complex(wp), allocatable :: values(:)
      integer :: n

      knots = knots_of(patch, longest)
      n = size(knots)
      allocate (values(n), source=(0.0_wp, 0.0_wp))
      allocate (elements%edges(0))
      if (n > 1) then
         values(:) = projected(patch, knots)
         call balance(patch, knots, values)
         if (abs(patch%turn)*(knots(n) - knots(1)) > 0.0_wp) call balance_inclined(patch, knots, values)
         elements%edges = [patch%contact%edge(1), stick_edges(patch), patch%contact%edge(2)]
      end if
      elements%from = knots(:n - 1)
      elements%to = knots(2:)
      elements%first = values(:n - 1)
      elements%last = values(2:)
      elements%sharp = abs(values(1)) > 0.0_wp .or. abs(values(n)) > 0.0_wp
      elements%singular = max(abs(aimag(values(1))), abs(aimag(values(n)))) > patch%nothing
   end subroutine find_elements

   !> Ends of the elements of a patch: its nodes and edges, and points between them so that no element is longer than half its
   !> distance from the next rooted edge or than `longest`: sigma_xx on the surface has a kink at each end. Symmetric with respect
   !> to left and right.
   function knots_of(patch, longest) result(knots)
      type(fitted_patch_type), intent(in) :: patch
      real(wp), intent(in) :: longest
      real(wp), allocatable :: knots(:)
      real(wp), allocatable :: roots(:), points(:)
      logical :: is_knot(size(patch%arc))
      !> Nodes nearer to an edge, in intervals, are not used as ends; edges at interval ends are half an interval away.
      real(wp), parameter :: apart = 0.4_wp
      real(wp) :: left
      integer :: i, number

      roots = [stick_edges(patch), pack(patch%contact%edge, patch%contact%rooted)]
      points = [patch%contact%edge(1), stick_edges(patch), patch%contact%edge(2)]
      do i = 1, size(is_knot)
         is_knot(i) = all(abs(patch%arc(i) - points) > apart*patch%width(i)) .and. &
                      patch%contact%contains_place(patch%arc(i))
      end do
      points = merged(points, pack(patch%arc, is_knot))
      allocate (knots(2*size(points)))
      knots(1) = points(1)
      number = 1
      do i = 2, size(points)
         left = knots(number)
         if (.not. points(i) > left) cycle
         call append_between(left, points(i), roots, longest, knots, number)
         call append(knots, number, points(i:i))
      end do
      ! Between edges that differ by round-off there is no room for points.
      knots = pack(knots(:number), [.true., knots(2:number) > knots(:number - 1)])
   end function knots_of

   !> Append values to the first `number` of a list, whose storage grows with a margin.
   pure subroutine append(list, number, values)
      real(wp), allocatable, intent(inout) :: list(:)
      integer, intent(inout) :: number
      real(wp), intent(in) :: values(:)
      real(wp), allocatable :: longer(:)

      if (number + size(values) > size(list)) then
         allocate (longer(2*(number + size(values))))
         longer(:number) = list(:number)
         call move_alloc(longer, list)
      end if
      list(number + 1:number + size(values)) = values
      number = number + size(values)
   end subroutine append

   !> Edges of the stick zones of a patch next to slipping nodes, ascending.
   pure function stick_edges(patch) result(edges)
      type(fitted_patch_type), intent(in) :: patch
      real(wp), allocatable :: edges(:)
      integer :: i

      allocate (edges(0))
      do i = 1, size(patch%stick)
         edges = [edges, pack(patch%stick(i)%edge, patch%stick(i)%rooted)]
      end do
   end function stick_edges

   !> Merge two ascending lists.
   pure function merged(one, other) result(both)
      real(wp), intent(in) :: one(:), other(:)
      real(wp) :: both(size(one) + size(other))
      integer :: i, j, k

      i = 1
      j = 1
      do k = 1, size(both)
         if (j > size(other)) then
            both(k) = one(i)
            i = i + 1
         else if (i > size(one)) then
            both(k) = other(j)
            j = j + 1
         else if (one(i) <= other(j)) then
            both(k) = one(i)
            i = i + 1
         else
            both(k) = other(j)
            j = j + 1
         end if
      end do
   end function merged

   !> Append the knots between two points: see knots_of. Beside a rooted edge their distances from it grow as the fifth power of
   !> their number: the error of the stress at the edge, where tractions go as a root, falls with the number to the power 2.5, as
   !> the root of the shortest element.
   pure recursive subroutine append_between(left, right, roots, longest, knots, number)
      real(wp), intent(in) :: left, right, roots(:), longest
      real(wp), allocatable, intent(inout) :: knots(:)
      integer, intent(inout) :: number
      real(wp), parameter :: most = 1000.0_wp
      integer, parameter :: parts = 32, power = 5
      real(wp) :: distance, middle
      logical :: is_root(2)
      integer :: i, pieces

      is_root = [any(abs(roots - left) <= 0.0_wp), any(abs(roots - right) <= 0.0_wp)]
      if (all(is_root)) then
         middle = 0.5_wp*(left + right)
         if (.not. (middle > left .and. middle < right)) return
         call append_between(left, middle, roots, longest, knots, number)
         call append(knots, number, [middle])
         call append_between(middle, right, roots, longest, knots, number)
      else if (is_root(1)) then
         call append(knots, number, [(left + (right - left)*(real(i, wp)/parts)**power, i=1, parts - 1)])
      else if (is_root(2)) then
         call append(knots, number, [(right - (right - left)*(real(i, wp)/parts)**power, i=parts - 1, 1, -1)])
      else
         distance = longest
         if (size(roots) > 0) distance = min(distance, 0.5_wp*minval(abs(left - roots)), 0.5_wp*minval(abs(right - roots)))
         if (.not. distance < right - left) return
         pieces = ceiling(min((right - left)/distance, most)*(1.0_wp - 1.0e-9_wp))
         call append(knots, number, [(left + (right - left)*i/pieces, i=1, pieces - 1)])
      end if
   end subroutine append_between

   !> Values at the knots of the continuous piecewise linear function with the least mean square distance to the tractions;
   !> zero at rooted ends.
   function projected(patch, knots) result(values)
      type(fitted_patch_type), intent(in) :: patch
      real(wp), intent(in) :: knots(:)
      complex(wp) :: values(size(knots))
      real(wp), parameter :: place(4) = [-0.86113631159405258_wp, -0.33998104358485626_wp, 0.33998104358485626_wp, &
                                         0.86113631159405258_wp], &
                             weight(4) = [0.34785484513745386_wp, 0.65214515486254614_wp, 0.65214515486254614_wp, &
                                          0.34785484513745386_wp]
      real(wp) :: diagonal(size(knots)), beside(size(knots) - 1), factor
      complex(wp), dimension(4, size(knots) - 1) :: there
      integer :: i, n

      n = size(knots)
      there = reshape(patch%tractions([(knots(i) + 0.5_wp*(knots(i + 1) - knots(i))*(1.0_wp + place), i=1, n - 1)]), shape(there))
      diagonal = 0.0_wp
      values = 0.0_wp
      do i = 1, n - 1
         associate (length => knots(i + 1) - knots(i))
            there(:, i) = there(:, i)*weight*length
            values(i) = values(i) + 0.25_wp*sum(there(:, i)*(1.0_wp - place))
            values(i + 1) = values(i + 1) + 0.25_wp*sum(there(:, i)*(1.0_wp + place))
            diagonal(i:i + 1) = diagonal(i:i + 1) + length/3.0_wp
            beside(i) = length/6.0_wp
         end associate
      end do
      if (patch%contact%rooted(1)) call fix(1, 1)
      if (patch%contact%rooted(2)) call fix(n, n - 1)
      do i = 2, n
         factor = beside(i - 1)/diagonal(i - 1)
         diagonal(i) = diagonal(i) - factor*beside(i - 1)
         values(i) = values(i) - factor*values(i - 1)
      end do
      values(n) = values(n)/diagonal(n)
      do i = n - 1, 1, -1
         values(i) = (values(i) - beside(i)*values(i + 1))/diagonal(i)
      end do

   contains

      subroutine fix(knot, neighbour)
         integer, intent(in) :: knot, neighbour

         diagonal(knot) = 1.0_wp
         beside(neighbour) = 0.0_wp
         values(knot) = 0.0_wp
      end subroutine fix
   end function projected

   !> Give the elements of a patch the resultants of its nodes: tractions are scaled by the normal force, and the missing
   !> tangential force is added in stick zones, or everywhere without any.
   subroutine balance(patch, knots, values)
      type(fitted_patch_type), intent(in) :: patch
      real(wp), intent(in) :: knots(:)
      complex(wp), intent(inout) :: values(:)
      real(wp) :: shape(size(knots)), wanted(2), there(2), area(2)

      wanted = [sum(patch%pressure*patch%width), sum(patch%shear*patch%width)]
      there = integrals(values)
      if (abs(there(1)) > 0.0_wp .and. patch%has_ratio) values = values*(wanted(1)/there(1))
      shape = shape_of_correction(patch, knots, values)
      there = integrals(values)
      area = integrals(cmplx(shape, 0.0_wp, wp))
      area = max(area(1), tiny(1.0_wp))
      values = values + cmplx(0.0_wp, shape*(wanted(2) - there(2))/area(1), wp)
      if (.not. patch%has_ratio) values = values + shape*(wanted(1) - there(1))/area(1)

   contains

      !> Integrals of p and tau.
      pure function integrals(of)
         complex(wp), intent(in) :: of(:)
         real(wp) :: integrals(2)
         complex(wp) :: total

         total = 0.5_wp*sum((of(2:) + of(:size(of) - 1))*(knots(2:) - knots(:size(of) - 1)))
         integrals = [real(total, wp), aimag(total)]
      end function integrals
   end subroutine balance

   !> What is added to the shear of a patch at the knots, up to a factor: see balance.
   pure function shape_of_correction(patch, knots, values) result(shape)
      type(fitted_patch_type), intent(in) :: patch
      real(wp), intent(in) :: knots(:)
      complex(wp), intent(in) :: values(:)
      real(wp) :: shape(size(knots))
      integer :: i

      shape = patch%contact%roots(knots)
      if (patch%has_ratio) shape = real(values, wp)
      if (size(patch%stick) == 0) return
      shape = 0.0_wp
      do i = 1, size(patch%stick)
         where (patch%stick(i)%contains_place(knots)) shape = patch%stick(i)%roots(knots)*real(values, wp)
      end do
   end function shape_of_correction

   !> With normals that turn along the surface the integrals of p and tau are not the forces. Give the elements both forces of
   !> the nodes and the moment of the shear about the centre of the normals: tractions are multiplied by a sine of the angle,
   !> which has a force on any arc, even around the whole circle, and shear is added as in balance.
   subroutine balance_inclined(patch, knots, values)
      type(fitted_patch_type), intent(in) :: patch
      real(wp), intent(in) :: knots(:)
      complex(wp), intent(inout) :: values(:)
      complex(wp) :: changes(size(knots), 3)
      real(wp) :: angle(size(knots)), middle, half, matrix(3, 3), missing(3), wanted(3)
      complex(wp) :: force
      integer :: i, n, pivot(3), code

      n = size(knots)
      middle = 0.5_wp*(knots(1) + knots(n))
      half = 0.5_wp*(knots(n) - knots(1))
      angle = patch%turn*(knots - middle)
      changes(:, 1) = values
      if (.not. patch%has_ratio) changes(:, 1) = patch%contact%roots(knots)
      changes(:, 2) = sin(angle)/(patch%turn*half)*changes(:, 1)
      changes(:, 1) = cos(angle)*changes(:, 1)
      changes(:, 3) = cmplx(0.0_wp, shape_of_correction(patch, knots, values), wp)
      associate (tractions => cmplx(patch%pressure, patch%shear, wp)*patch%width)
         force = sum(tractions*exp(cmplx(0.0_wp, -patch%turn*(patch%arc - middle), wp)))
         wanted = conditions(force, sum(aimag(tractions)))
      end associate
      missing = wanted - of_elements(values)
      do i = 1, 3
         matrix(:, i) = of_elements(changes(:, i))
      end do
      call dgesv(3, 1, matrix, 3, pivot, missing, 3, code)
      if (code == 0) values = values + matmul(changes, missing)

   contains

      !> Of the force along and across the normal in the middle and the integral of the shear: the first, the last, and their
      !> difference, in proportion to a first moment of the pressure.
      pure function conditions(force, shear)
         complex(wp), intent(in) :: force
         real(wp), intent(in) :: shear
         real(wp) :: conditions(3)

         conditions = [real(force, wp), (shear - aimag(force))/(patch%turn*half), shear]
      end function conditions

      !> The same of elements with ends `of`, which are linear in the sine of the angle from their middles (mfv_interior_circle).
      pure function of_elements(of)
         complex(wp), intent(in) :: of(:)
         real(wp) :: of_elements(3)
         complex(wp), dimension(size(of) - 1) :: mean, tilt, along
         real(wp), dimension(size(of) - 1) :: angle

         angle = 0.5_wp*patch%turn*(knots(2:) - knots(:n - 1))
         mean = 0.5_wp*(of(2:) + of(:n - 1))
         tilt = 0.5_wp*(of(2:) - of(:n - 1))
         along = 2.0_wp*mean*sin(angle) - cmplx(0.0_wp, 1.0_wp, wp)*tilt*(angle - sin(angle)*cos(angle))/sin(angle)
         along = along*exp(cmplx(0.0_wp, -patch%turn*(0.5_wp*(knots(2:) + knots(:n - 1)) - middle), wp))
         of_elements = conditions(sum(along)/patch%turn, sum(2.0_wp*aimag(mean)*angle)/patch%turn)
      end function of_elements
   end subroutine balance_inclined

end module mfv_surface_tractions
