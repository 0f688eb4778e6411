!> Edges of contact and stick zones between the nodes.
!>
!> Statuses locate an edge to an interval, tractions more precisely. At a smooth contact edge the pressure vanishes as the
!> square root of the distance, and so does, at the edge of a stick zone, the remaining friction |mu p| - |tau| (Hertz;
!> Cattaneo and Mindlin, dissertation eqs. 3.1, 3.7). With full coupling and slip the exponent of p is 1/2 + l towards +x and
!> 1/2 - l towards -x, tan(pi l) = beta tau/p (sliding contact: Johnson 1985, section 8.1; Comninou 1977 at the end of a stick
!> zone). Behind the edge of a growing stick zone the exponent is larger by one, the integral of the root, as in Spence's
!> closed forms; the exponent with the straighter fit is used. A traction raised to the inverse exponent is nearly linear: a
!> parabola through a few nodes is extrapolated to its zero. The outermost node has the largest discretisation error and is
!> not used; the error of the others is known and corrected (mfv_edge_solutions). On a graded mesh the discrete solutions of the
!> outermost intervals are fitted to their tractions; without one, the integral of the traction from the edge is extrapolated,
!> whose exponent is larger by one.
module mfv_zone_edges
   use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
   use mfv_compliance, only: block_wp, block_wt
   use mfv_contact_model, only: contact_model_type
   use mfv_contact_state, only: contact_state_type
   use mfv_edge_solutions, only: graded_solution_type, least_power, most_power, new_graded_solution, find_solved_distance
   use mfv_kinds, only: pi, wp
   use mfv_motions, only: bulk_motions, control_keep, motion_approach, motion_rotation, motion_shift
   use mfv_near_field, only: near_field_type
   use mfv_node_status, only: holds, in_contact, slip_sign, slips
   use mfv_surface_tractions, only: root_shift
   use mfv_tolerances, only: certified, significant, visible
   implicit none
   private
   public :: nodes_across, zone_type, patch_type, zone_edges_type, find_patches, find_zone_edges, outermost_edges, largest_shear, &
             find_zones_below_limit, zones_of, held, ends_with_body, is_beyond_corner, rises_at_end, slipping_run, has_known_error

   !> A zone of neighbouring nodes, from `first` to `last`, and its edges: arc lengths from the origin of x, positive to the
   !> right; and the uncertainty of these edges, lengths.
   type :: zone_type
      integer :: first = 0, last = 0
      real(wp) :: left = 0.0_wp, right = 0.0_wp
      real(wp) :: left_error = 0.0_wp, right_error = 0.0_wp
   contains
      procedure :: length
   end type zone_type

   !> A contact patch: neighbouring nodes in contact, between open ones.
   type, extends(zone_type) :: patch_type
      !> Whether the patch ends with the surface of a body, or with an interval there, where the pressure may be singular. At other
      !> edges it vanishes as the distance to the power `left_power` or `right_power`.
      logical :: left_ends = .false., right_ends = .false.
      !> Length after which the surfaces repeat if the patch ends there and continues in the first one, which can be itself, else 0.
      real(wp) :: to_first = 0.0_wp
      real(wp) :: left_power = 0.5_wp, right_power = 0.5_wp
      !> Its stick zones from left to right; size 0 without any.
      type(zone_type), allocatable :: stick(:)
   end type patch_type

   !> Summary of all patches.
   type :: zone_edges_type
      !> Whether any node is in contact; whether any node sticks.
      logical :: contact = .false., stick = .false.
      !> Number of contact patches.
      integer :: patches = 0
      !> The outermost edges, and the total length of the zones.
      real(wp) :: contact_left = 0.0_wp, contact_right = 0.0_wp, contact_length = 0.0_wp
      real(wp) :: stick_left = 0.0_wp, stick_right = 0.0_wp, stick_length = 0.0_wp
   contains
      procedure :: half_width
      procedure :: centre
      procedure :: stick_ratio
   end type zone_edges_type

   !> Largest number of nodes to extrapolate from.
   integer, parameter :: most_samples = 7
   real(wp), parameter :: unknown_bend = 1.0e10_wp
   !> Uncertainty of an edge, intervals (docs/verification.md): at least; of an edge that cannot be located between nodes.
   real(wp), parameter :: least_error = 0.001_wp, error_if_unknown = 0.5_wp

   !> A traction near an edge: values at the outermost nodes of a zone, outermost first, and their distances from the first
   !> one, in intervals; or the integrals of the traction from the edge to the inner ends of these intervals.
   type :: edge_samples_type
      !> Number of values, and of nodes in the whole zone.
      integer :: number = 0, zone = 0
      real(wp) :: inwards(0:most_samples - 1) = 0.0_wp, value(0:most_samples - 1) = 0.0_wp
      !> Tractions of the outermost nodes; of unequal intervals those of the whole zone, and widths, in intervals.
      real(wp), allocatable :: traction(:), width(:)
      !> Width of the interval beyond the outermost one, in which the edge can be.
      real(wp) :: beyond = 0.0_wp
      !> Exponent of the distance, whether the discretisation error is known, and whether values are integrals of the traction.
      real(wp) :: power = 0.5_wp
      logical :: is_regular = .false., is_integral = .false.
   end type edge_samples_type

contains

   !> Length of a zone.
   elemental real(wp) function length(self)
      class(zone_type), intent(in) :: self

      length = self%right - self%left
   end function length

   !> Half the length of a contact of one patch, length; NaN for several patches.
   elemental real(wp) function half_width(self)
      class(zone_edges_type), intent(in) :: self

      half_width = 0.5_wp*self%contact_length
      if (self%patches > 1) half_width = ieee_value(1.0_wp, ieee_quiet_nan)
   end function half_width

   !> Middle between the outermost contact edges, arc length from the origin of x.
   elemental real(wp) function centre(self)
      class(zone_edges_type), intent(in) :: self

      centre = 0.5_wp*(self%contact_left + self%contact_right)
   end function centre

   !> Length of the stick zones over that of the contact; 0 without contact.
   elemental real(wp) function stick_ratio(self)
      class(zone_edges_type), intent(in) :: self

      stick_ratio = 0.0_wp
      if (self%contact_length > 0.0_wp) stick_ratio = self%stick_length/self%contact_length
   end function stick_ratio

   !> The outermost edges and total lengths in a state; see find_patches.
   subroutine find_zone_edges(model, state, edges)
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: state
      type(zone_edges_type), intent(out) :: edges
      type(patch_type), allocatable :: patches(:)

      call find_patches(model, state, patches)
      edges = outermost_edges(patches)
   end subroutine find_zone_edges

   !> The outermost edges and total lengths of patches. What spans an end of a period is one patch.
   pure type(zone_edges_type) function outermost_edges(patches) result(edges)
      type(patch_type), intent(in) :: patches(:)
      integer :: i, j

      edges%contact = size(patches) > 0
      edges%patches = size(patches)
      do i = 1, size(patches)
         if (i == 1) edges%contact_left = patches(i)%left
         edges%contact_right = patches(i)%right
         edges%contact_length = edges%contact_length + patches(i)%length()
         do j = 1, size(patches(i)%stick)
            associate (zone => patches(i)%stick(j))
               if (.not. edges%stick) edges%stick_left = zone%left
               edges%stick = .true.
               edges%stick_right = zone%right
               edges%stick_length = min(edges%stick_length + zone%length(), edges%contact_length)
            end associate
         end do
      end do
      if (.not. edges%contact) return
      associate (last => patches(size(patches)))
         if (.not. last%to_first > 0.0_wp) return
         if (size(patches) == 1) then
            edges%contact_left = -0.5_wp*last%to_first
            edges%contact_right = 0.5_wp*last%to_first
            return
         end if
         edges%patches = edges%patches - 1
         if (edges%patches > 1) return
         edges%contact_left = last%left
         edges%contact_right = patches(1)%right + last%to_first
         ! The middle is within half a length from the origin.
         if (.not. edges%centre() > 0.5_wp*last%to_first*(1.0_wp + visible)) return
         edges%contact_left = edges%contact_left - last%to_first
         edges%contact_right = edges%contact_right - last%to_first
      end associate
   end function outermost_edges

   !> The contact patches in a state, from left to right. Where tractions cannot be extrapolated (few nodes, sharp corners,
   !> friction laws without a sharp limit) the edge is the end of the outermost node's surface.
   subroutine find_patches(model, state, patches)
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: state
      type(patch_type), allocatable, intent(out) :: patches(:)
      type(zone_type), allocatable :: zones(:)
      integer :: i

      zones = zones_of(in_contact(state%status))
      allocate (patches(size(zones)))
      do i = 1, size(zones)
         patches(i)%first = zones(i)%first
         patches(i)%last = zones(i)%last
         patches(i)%left_ends = ends_with_body(model, state, zones(i)%first, -1)
         patches(i)%right_ends = ends_with_body(model, state, zones(i)%last, 1)
         patches(i)%left_power = contact_power(model, state, zones(i)%first, -1)
         patches(i)%right_power = contact_power(model, state, zones(i)%last, 1)
         call find_contact_edge(model, state, -1, patches(i))
         call find_contact_edge(model, state, 1, patches(i))
         if (i == 1) cycle
         ! Extrapolated edges of neighbouring patches must not overlap.
         if (patches(i - 1)%right <= patches(i)%left) cycle
         patches(i - 1)%right = 0.5_wp*(patches(i - 1)%right + patches(i)%left)
         patches(i)%left = patches(i - 1)%right
      end do
      i = size(patches)
      if (i > 0) then
         if (model%scene%repeats_beyond(patches(1)%left) .and. model%scene%repeats_beyond(patches(i)%right)) &
            patches(i)%to_first = model%scene%repeat_length()
      end if
      zones = zones_of(held(model, state))
      do i = 1, size(patches)
         call find_stick_zones(model, state, pack(zones, zones%first >= patches(i)%first .and. zones%last <= patches(i)%last), &
                               patches(i))
      end do
   end subroutine find_patches

   !> The edges of the stick zones of a patch.
   subroutine find_stick_zones(model, state, zones, patch)
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: state
      type(zone_type), intent(in) :: zones(:)
      type(patch_type), intent(inout) :: patch
      real(wp) :: left, right
      integer :: i

      patch%stick = zones
      do i = 1, size(zones)
         ! A stick zone is inside the contact.
         call find_stick_edge(model, state, zones(i), patch, -1, left, patch%stick(i)%left_error)
         call find_stick_edge(model, state, zones(i), patch, 1, right, patch%stick(i)%right_error)
         left = max(left, patch%left)
         right = min(right, patch%right)
         if (left > right) left = 0.5_wp*(left + right)
         patch%stick(i)%left = left
         patch%stick(i)%right = max(left, right)
      end do
   end subroutine find_stick_zones

   !> The parts of the stick zones of a patch in which the shear is below the friction limit. Where loads return to former ones, as
   !> in every cycle that repeats, nodes stick at their limit beside a stick zone of the former loads: tractions have its edges.
   subroutine find_zones_below_limit(model, state, patch, zones)
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: state
      type(patch_type), intent(in) :: patch
      type(zone_type), allocatable, intent(out) :: zones(:)
      !> A single node at its limit is left to find_stick_edge.
      integer, parameter :: fewest = 2
      logical :: below(patch%first:patch%last)
      integer :: i, first, last
      logical :: trimmed(2)

      associate (f => patch%first, l => patch%last)
         below = abs(state%fields%shear(f:l)) < (1.0_wp - significant)*model%static_friction(f:l)*state%fields%pressure(f:l)
      end associate
      zones = patch%stick
      do i = 1, size(zones)
         associate (zone => zones(i))
            first = zone%first - 1 + findloc(below(zone%first:zone%last), .true., dim=1)
            last = zone%first - 1 + findloc(below(zone%first:zone%last), .true., dim=1, back=.true.)
            trimmed = [first - zone%first, zone%last - last] >= fewest
            if (last < zone%first) then
               ! All nodes are at their limit.
               if (zone%last - zone%first + 1 >= fewest) zone%last = zone%first - 1
               cycle
            end if
            if (trimmed(1)) zone%first = first
            if (trimmed(2)) zone%last = last
            if (trimmed(1)) call find_stick_edge(model, state, zone, patch, -1, zone%left, zone%left_error)
            if (trimmed(2)) call find_stick_edge(model, state, zone, patch, 1, zone%right, zone%right_error)
         end associate
      end do
      zones = pack(zones, zones%last >= zones%first)
   end subroutine find_zones_below_limit

   !> Nodes that stick, and those that are called slipping but rest at their limit (see rests): when a cycle repeats its tractions,
   !> many nodes reach their limit together, and rounding errors or the mesh decide which of them slip, by next to nothing. (Not
   !> with wear, which adds up such slips.) If no node is called sticking, the last few at rest before all slide do not count.
   pure function held(model, state)
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: state
      integer, parameter :: last_before_sliding = 4
      logical :: held(size(state%status))
      type(zone_type), allocatable :: zones(:), patches(:)
      real(wp) :: slipped(size(state%status)), scale
      integer :: i, patch

      associate (shift => state%fields%motion(motion_shift), tangential => state%fields%tangential)
         scale = max(maxval(abs(tangential)), abs(shift))
         slipped = abs(tangential - shift - state%stuck_slip)
      end associate
      held = holds(state%status) .or. (slips(state%status) .and. slipped <= certified*scale)
      zones = zones_of(slips(state%status) .and. .not. model%scene%wear%acts())
      patches = zones_of(in_contact(state%status))
      patch = 1
      do i = 1, size(zones)
         do while (patches(patch)%last < zones(i)%last)
            patch = patch + 1
         end do
         associate (first => zones(i)%first, last => zones(i)%last, from => patches(patch)%first, to => patches(patch)%last)
            held(first:last) = held(first:last) .or. &
                               rests(slipped(first:last), maxval(slipped(from:to), mask=slips(state%status(from:to))), &
                                     model%width(first:last))
         end associate
      end do
      if (.not. any(holds(state%status)) .and. count(held) <= last_before_sliding) held = .false.
   end function held

   !> Whether nodes of a slip zone rest: the slip since their last stick, `slipped`, is next to nothing beside the largest in the
   !> zone, or all of it even less beside that in the patch, `largest`, and of one size over more neighbouring nodes and a larger
   !> part of the zone than where it grows with the power 3/2 of the distance from a stick zone, or faster: the power 3/2 has these
   !> slips over `nothing`^(2/3) of the zone, 5/2 over three equal intervals. All slips, and the `width` of the intervals: lengths.
   pure function rests(slipped, largest, width)
      real(wp), intent(in) :: slipped(:), largest, width(:)
      logical :: rests(size(slipped))
      real(wp), parameter :: nothing = 0.005_wp, nothing_in_patch = 0.001_wp, alike = 100.0_wp, least_part = 0.1_wp
      integer, parameter :: fewest = 4
      type(zone_type), allocatable :: runs(:)
      integer :: i

      rests = .false.
      runs = zones_of(slipped <= nothing*maxval(slipped) .or. maxval(slipped) <= nothing_in_patch*largest)
      do i = 1, size(runs)
         associate (first => runs(i)%first, last => runs(i)%last)
            rests(first:last) = slipped(first:last) <= alike*minval(slipped(first:last))
            if (count(rests(first:last)) < fewest .or. &
                sum(width(first:last), mask=rests(first:last)) < least_part*sum(width)) rests(first:last) = .false.
         end associate
      end do
   end function rests

   !> Largest size of the shear traction in a patch, force/length^2: at its nodes, and at the edges of stick zones between nodes,
   !> beyond which it is mu p. At nodes alone it would be too small by the root of the interval (Mindlin 1949: the remaining
   !> friction inside the edge). `arc`: where it is; the leftmost of places that differ by less than the certified accuracy.
   real(wp) function largest_shear(model, state, patch, arc) result(largest)
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: state
      type(patch_type), intent(in) :: patch
      real(wp), intent(out), optional :: arc
      integer :: i

      associate (shear => abs(state%fields%shear(patch%first:patch%last)))
         i = patch%first - 1 + findloc(shear >= maxval(shear)*(1.0_wp - certified), .true., dim=1)
      end associate
      largest = abs(state%fields%shear(i))
      if (present(arc)) arc = model%arc(i)
      if (.not. model%scene%friction%is_coulomb()) return
      do i = 1, size(patch%stick)
         call compare(patch%stick(i)%left, patch%stick(i)%first, -1)
         call compare(patch%stick(i)%right, patch%stick(i)%last, 1)
      end do

   contains

      !> The friction limit at the `edge` of a stick zone, if the node beyond its outermost one on `side` slips: between these two,
      !> or between the outermost one and the next inside.
      subroutine compare(edge, outermost, side)
         real(wp), intent(in) :: edge
         integer, intent(in) :: outermost, side
         real(wp) :: part, limit
         integer :: other

         associate (next => outermost + side, pressure => state%fields%pressure)
            if (next < patch%first .or. next > patch%last) return
            if (.not. slips(state%status(next))) return
            other = merge(next, outermost - side, side*(edge - model%arc(outermost)) > 0.0_wp)
            if (other < patch%first .or. other > patch%last) return
            part = min(max((edge - model%arc(outermost))/(model%arc(other) - model%arc(outermost)), 0.0_wp), 1.0_wp)
            limit = model%kinetic_friction(next)*(pressure(outermost) + part*(pressure(other) - pressure(outermost)))
            if (.not. limit > largest*(1.0_wp + certified)) return
            largest = limit
            if (present(arc)) arc = edge
         end associate
      end subroutine compare
   end function largest_shear

   !> The zones where `inside` is true, without edges.
   pure function zones_of(inside) result(zones)
      logical, intent(in) :: inside(:)
      type(zone_type), allocatable :: zones(:)
      integer :: first(size(inside)), last(size(inside)), i, number
      logical :: before

      number = 0
      before = .false.
      do i = 1, size(inside)
         if (inside(i) .and. .not. before) then
            number = number + 1
            first(number) = i
         end if
         if (inside(i)) last(number) = i
         before = inside(i)
      end do
      allocate (zones(number))
      zones%first = first(:number)
      zones%last = last(:number)
   end function zones_of

   !> Find the edge of a patch on `side` (-1 left, 1 right), its uncertainty, and whether it is the end of a surface.
   subroutine find_contact_edge(model, state, side, patch)
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: state
      integer, intent(in) :: side
      type(patch_type), intent(inout) :: patch
      type(edge_samples_type) :: samples
      real(wp) :: distance, error
      logical :: solved, rises, ends
      integer :: outermost, other

      outermost = merge(patch%last, patch%first, side > 0)
      other = merge(patch%first, patch%last, side > 0)
      ends = nodes_across(model, state, outermost, side) > 0
      if (ends) then
         distance = 0.5_wp
         error = 0.0_wp
      else
         samples = sampled(model, state%fields%pressure, outermost, other, side, nodes_across(model, state, other, -side))
         samples%is_regular = has_known_error(model, outermost, samples%number)
         call find_distance(straightened(samples, merge(patch%right_power, patch%left_power, side > 0)), distance, error, solved)
         rises = .false.
         if (patch%last > patch%first) rises = state%fields%pressure(outermost) >= state%fields%pressure(outermost - side)
         if (.not. model%repeats_beyond(outermost, side)) &
            call end_with_surface(model, outermost, side, rises, solved, distance, error, ends)
      end if
      if (side < 0) then
         patch%left = model%arc(outermost) - model%width(outermost)*distance
         patch%left_error = model%width(outermost)*error
         patch%left_ends = patch%left_ends .or. ends
      else
         patch%right = model%arc(outermost) + model%width(outermost)*distance
         patch%right_error = model%width(outermost)*error
         patch%right_ends = patch%right_ends .or. ends
      end if
   end subroutine find_contact_edge

   !> Put a contact edge at the end of a surface on `side` that is nearer than the edge or, if the pressure `rises` towards it, than
   !> the next node; not if the edge is known to lie before the end (`solved`). `distance` of the edge from the `outermost` node
   !> and its `error`, intervals; `ends`: whether it is now at the end.
   subroutine end_with_surface(model, outermost, side, rises, solved, distance, error, ends)
      type(contact_model_type), intent(in) :: model
      integer, intent(in) :: outermost, side
      logical, intent(in) :: rises, solved
      real(wp), intent(inout) :: distance, error
      logical, intent(out) :: ends
      !> The pressure vanishes at the end if not farther before it than this, in intervals.
      real(wp), parameter :: nearest = 0.1_wp
      real(wp) :: last, next

      associate (arc => model%arc(outermost), width => model%width(outermost))
         next = 1.0_wp
         if (outermost + side >= 1 .and. outermost + side <= model%nodes()) next = abs(model%arc(outermost + side) - arc)/width
         ends = is_beyond_surface(model, arc + side*width*max(distance, merge(next, 0.5_wp*(1.0_wp + visible), rises)))
         if (.not. ends) return
         last = abs(model%scene%last_touchable(arc, arc + side*max(distance, next)*width) - arc)/width
         ends = .not. (solved .and. distance < last - nearest)
         if (.not. ends) return
         ! An interval should end there.
         if (abs(last - 0.5_wp) < visible) last = 0.5_wp
         distance = last
         error = abs(last - 0.5_wp)
      end associate
   end subroutine end_with_surface

   !> Whether the largest pressure of a finer mesh is probably at the end of a surface that is no corner by design, where it grows
   !> as the inverse root of the interval.
   pure logical function rises_at_end(model, state, patches)
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: state
      type(patch_type), intent(in) :: patches(:)
      real(wp) :: largest
      integer :: i

      largest = maxval(state%fields%pressure)
      rises_at_end = .false.
      do i = 1, size(patches)
         rises_at_end = rises_at_end .or. rises(patches(i)%left, patches(i)%first, -1) .or. &
                        rises(patches(i)%right, patches(i)%last, 1)
      end do

   contains

      pure logical function rises(edge, node, side)
         real(wp), intent(in) :: edge
         integer, intent(in) :: node, side
         real(wp), parameter :: growth = 3.0_wp

         associate (beyond => edge + side*visible*model%width(node))
            rises = growth*state%fields%pressure(node) > largest .and. &
                    is_beyond_surface(model, beyond) .and. .not. is_beyond_corner(model, beyond) .and. &
                    .not. model%scene%repeats_beyond(beyond)
         end associate
      end function rises
   end function rises_at_end

   !> Whether a surface has ended at an arc length. That of a matrix ends with the interval of its last node.
   pure logical function is_beyond_surface(model, arc)
      type(contact_model_type), intent(in) :: model
      real(wp), intent(in) :: arc

      is_beyond_surface = .not. (model%scene%lower%is_matrix() .or. model%scene%touchable(arc))
   end function is_beyond_surface

   !> Whether the surface of a body with corners by design, a flat punch, has ended at an arc length.
   pure logical function is_beyond_corner(model, arc)
      type(contact_model_type), intent(in) :: model
      real(wp), intent(in) :: arc
      real(wp) :: x

      x = model%scene%x_of_arc(arc)
      is_beyond_corner = (model%scene%lower%has_sharp_ends() .and. .not. model%scene%lower%has_surface(x)) .or. &
                         (model%scene%upper%has_sharp_ends() .and. .not. model%scene%upper%has_surface(x))
   end function is_beyond_corner

   !> Number of neighbouring nodes that slip in one direction, from a node to the left (-1) or right (1).
   pure integer function slipping_run(state, from, direction) result(nodes)
      type(contact_state_type), intent(in) :: state
      integer, intent(in) :: from, direction
      integer :: node

      nodes = 0
      if (.not. slips(state%status(from))) return
      node = from
      do while (node >= 1 .and. node <= size(state%status))
         if (state%status(node) /= state%status(from)) return
         nodes = nodes + 1
         node = node + direction
      end do
   end function slipping_run

   !> Exponent with which the pressure vanishes beyond an outermost node on `side`.
   real(wp) function contact_power(model, state, node, side) result(power)
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: state
      integer, intent(in) :: node, side

      power = 0.5_wp
      if (slips(state%status(node)) .and. state%fields%pressure(node) > 0.0_wp) &
         power = 0.5_wp + side*exponent_shift(model, node, state%fields%shear(node)/state%fields%pressure(node))
   end function contact_power

   !> Edge of a stick zone on `side` (-1 left, 1 right), arc length from the origin of x, and its uncertainty, length: where the
   !> shear traction reaches the friction limit. If the next node is open, the edge is that of the patch or, with a slip zone
   !> narrower than an interval, inside it.
   subroutine find_stick_edge(model, state, zone, patch, side, edge, error)
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: state
      type(zone_type), intent(in) :: zone
      type(patch_type), intent(in) :: patch
      integer, intent(in) :: side
      real(wp), intent(out) :: edge, error
      real(wp) :: lack(size(state%status)), power, direction, widest, least, distance
      type(edge_samples_type) :: samples
      integer :: last, next, other, patch_end

      patch_end = merge(patch%last, patch%first, side > 0)
      last = merge(zone%last, zone%first, side > 0)
      other = merge(zone%first, zone%last, side > 0)
      next = last + side
      edge = model%arc(last) + 0.5_wp*side*model%width(last)
      error = error_if_unknown*model%width(last)
      widest = huge(widest)
      least = 0.0_wp
      if (last == patch_end) then
         edge = merge(patch%right, patch%left, side > 0)
         if (merge(patch%right_ends, patch%left_ends, side > 0) .or. last == other) return
         next = last
         direction = sign(1.0_wp, state%fields%shear(last))
         widest = widest_hidden_slip()
      else
         direction = -slip_sign(state%status(next))
         if (holds(state%status(next))) direction = sign(1.0_wp, state%fields%shear(next))
      end if
      if (.not. (abs(direction) > 0.0_wp .and. model%scene%friction%is_coulomb())) return
      associate (i => zone%first, j => zone%last)
         lack(i:j) = model%static_friction(i:j)*state%fields%pressure(i:j) - direction*state%fields%shear(i:j)
      end associate
      if (last /= other .and. at_its_limit(last)) then
         if (at_its_limit(last - side)) then
            if (next /= last) edge = edge_by_slip(model, state, next, side, edge)
            return
         end if
         ! One node may stick or slip: the edge must not depend on that. Where a load returns to a former one, the slip of this
         ! segment ends there, that of the former one here.
         least = model%width(last)
         last = last - side
      end if
      power = 0.5_wp - side*exponent_shift(model, next, direction*model%kinetic_friction(next))
      samples = sampled(model, lack, last, other, side, 0)
      samples%is_regular = has_known_error(model, last, samples%number)
      call find_distance_of_lack(samples, power, distance, error)
      edge = model%arc(last) + side*model%width(last)*distance
      error = max(least, model%width(last)*error)
      if (last == patch_end) then
         associate (end => merge(patch%right, patch%left, side > 0))
            edge = side*max(side*edge, side*end - widest)
            ! The width of a slip zone without a node is no better known than itself.
            error = max(error, min(abs(end - edge), error_if_unknown*model%width(last)))
         end associate
      end if
      call correct_by_slip(edge, error)

   contains

      !> Upper limit of a slip zone of the width c inside the outermost interval, length: at the distance d from the contact's edge
      !> tau is mu p (1 - sqrt(1 - c/d)), at least mu p c/(2 d); twice that c for the discretisation error, with d at least half
      !> an interval. Without shear there is no such zone, whatever the sign of its rounding errors.
      pure real(wp) function widest_hidden_slip() result(width)
         real(wp), parameter :: allowance = 2.0_wp
         real(wp) :: limit

         limit = model%static_friction(last)*state%fields%pressure(last)
         width = 2.0_wp*allowance*max(abs(edge - model%arc(last)), 0.5_wp*model%width(last))
         if (limit > 0.0_wp) width = width*min(abs(state%fields%shear(last))/limit, 1.0_wp)
      end function widest_hidden_slip

      !> Behind an older stick zone that ended nearby, the remaining friction nearly vanishes twice within a few intervals: if the
      !> slip disagrees with the traction, it locates the edge.
      subroutine correct_by_slip(edge, error)
         real(wp), intent(inout) :: edge, error
         !> In intervals, the wider one at the edge; unequal ones have mean slips.
         real(wp), parameter :: agreement(2) = [0.35_wp, 1.0_wp], straight = 0.3_wp
         integer :: node, i
         real(wp) :: by_slip, values(0:2)

         if (abs(patch_end - next) < 2 .or. holds(state%status(next))) return
         do i = 0, 2
            node = next + side*i
            if (state%status(node) /= state%status(next)) return
            values(i) = slip_measure(state, node)
         end do
         ! Nodes that rest at their limit have slipped by rounding errors.
         if (values(2)**1.5_wp <= certified*max(abs(state%fields%tangential(node)), abs(state%fields%motion(motion_shift)))) return
         if (abs(values(2) - 2.0_wp*values(1) + values(0)) > straight*(values(1) - values(0))) return
         by_slip = edge_by_slip(model, state, next, side, edge)
         if (abs(by_slip - edge) <= agreement(merge(2, 1, samples%is_integral))*maxval(model%width([last, next]))) then
            ! An older edge in the same interval is not seen in the tractions.
            if (has_older_edges(model)) error = max(error, abs(by_slip - edge))
            return
         end if
         error = max(error, min(abs(by_slip - edge), error_if_unknown*model%width(last)))
         edge = by_slip
      end subroutine correct_by_slip

      !> Whether a sticking node is at its friction limit within tolerance.
      pure logical function at_its_limit(node)
         integer, intent(in) :: node

         at_its_limit = lack(node) <= significant*model%static_friction(node)*state%fields%pressure(node)
      end function at_its_limit
   end subroutine find_stick_edge

   !> Whether stick zones can have older edges than those of one shear, or of the two ends of a cycle that are alike: shear by the
   !> tangential force or the shift, the rotation, or a bulk stress.
   pure logical function has_older_edges(model)
      type(contact_model_type), intent(in) :: model
      integer, parameter :: shearing(*) = [motion_shift, motion_rotation, bulk_motions]
      integer :: i, number, motion, first, control
      real(wp) :: target(2)

      number = 0
      has_older_edges = .true.
      if (model%scene%wear%acts()) return
      do i = 1, size(model%scene%steps)
         associate (step => model%scene%steps(i))
            if (number > 0 .and. step%control(motion_approach) /= control_keep) return
            if (.not. step%friction .or. all(step%control(shearing) == control_keep)) cycle
            motion = shearing(findloc(step%control(shearing) /= control_keep, .true., dim=1))
            if (count(step%control(shearing) /= control_keep) > 1 .or. allocated(step%path)) return
            if (number == 0) then
               first = motion
               control = step%control(motion)
               if (step%cycles > 0) return
            else if (number == 2 .or. motion /= first .or. step%control(motion) /= control) then
               return
            end if
            number = number + 1
            target(number) = step%target(motion)
         end associate
      end do
      has_older_edges = .false.
      if (number == 2) has_older_edges = abs(sum(target)) > visible*maxval(abs(target))
   end function has_older_edges

   !> The outermost values of a traction in a zone from node `outermost`, with its edge on `side`, to node `other` and, where the
   !> surfaces repeat, to the `across` nodes at the other end of the mesh; shape of the traction (nodes).
   pure type(edge_samples_type) function sampled(model, traction, outermost, other, side, across) result(samples)
      type(contact_model_type), intent(in) :: model
      real(wp), intent(in) :: traction(:)
      integer, intent(in) :: outermost, other, side, across
      real(wp) :: total
      integer :: i, node

      samples%zone = abs(other - outermost) + 1 + across
      samples%number = min(samples%zone, most_samples)
      associate (unit => model%width(outermost))
         do i = 0, samples%number - 1
            node = modulo(outermost - side*i - 1, size(traction)) + 1
            samples%value(i) = traction(node)
            samples%inwards(i) = abs(model%arc(node) - model%arc(outermost))/unit
            if (i > abs(other - outermost)) samples%inwards(i) = i
         end do
         samples%is_integral = allocated(model%scene%mesh%ends)
         samples%traction = samples%value(:samples%number - 1)
         if (.not. samples%is_integral) return
         samples%traction = traction(outermost:other:-side)
         samples%width = model%width(outermost:other:-side)/unit
         samples%beyond = model%width(min(max(outermost + side, 1), model%nodes()))/unit
         total = 0.0_wp
         do i = 0, samples%number - 1
            total = total + samples%value(i)*model%width(outermost - side*i)/unit
            samples%value(i) = total
            samples%inwards(i) = samples%inwards(i) + 0.5_wp*model%width(outermost - side*i)/unit
         end do
      end associate
   end function sampled

   !> Where the remaining friction vanishes, in intervals outwards from the outermost node, and the uncertainty of that. The
   !> exponent is `power` or, behind a growing stick zone, larger by one: in long zones that with the straighter fit, and in between
   !> a weighted mean, so that rounding errors do not decide. Short zones, and unequal intervals with a discrete solution: `power`.
   subroutine find_distance_of_lack(samples, power, distance, error)
      type(edge_samples_type), intent(in) :: samples
      real(wp), intent(in) :: power
      real(wp), intent(out) :: distance, error
      integer, parameter :: short = 8, steepness = 4
      real(wp), parameter :: clearly = 2.0_wp
      type(edge_samples_type) :: straight
      real(wp) :: steady, grown, weight, of_grown
      logical :: solved

      straight = straightened(samples, power)
      call find_distance(straight, distance, error, solved)
      if (straight%is_integral .and. solved) return
      steady = bend(straight)
      grown = clearly*bend(straightened(samples, power + 1.0_wp))
      weight = 0.0_wp
      if (min(steady, grown) < unknown_bend) weight = min(max((samples%zone - short)/real(short, wp), 0.0_wp), 1.0_wp) &
                                                      *steady**steepness/(steady**steepness + grown**steepness)
      if (.not. weight > 0.0_wp) return
      of_grown = distance_to_zero(straightened(samples, power + 1.0_wp), .true.)
      error = max((1.0_wp - weight)*(error + weight*abs(of_grown - distance)), least_error)
      distance = distance + weight*(of_grown - distance)
   end subroutine find_distance_of_lack

   !> Deviation of the second to fourth value from a straight line, relative to their change; `unknown_bend` for fewer or
   !> decreasing values.
   pure real(wp) function bend(samples)
      type(edge_samples_type), intent(in) :: samples
      real(wp) :: first, second

      bend = unknown_bend
      if (samples%number < 4) return
      associate (t => samples%inwards, value => samples%value)
         if (.not. value(3) > value(1)) return
         first = (value(2) - value(1))/(t(2) - t(1))
         second = (value(3) - value(2))/(t(3) - t(2))
         bend = min(0.5_wp*abs(second - first)*(t(3) - t(1)), unknown_bend*(value(3) - value(1)))/(value(3) - value(1))
      end associate
   end function bend

   !> Edge of a stick zone whose nodes are at the friction limit, as in a cycle that repeats its tractions. It follows from
   !> the slip beyond the zone since the last stick, which grows with the power 3/2 of the distance (Mindlin). `next`: first
   !> slipping node; `otherwise`: the edge if that fails.
   pure real(wp) function edge_by_slip(model, state, next, side, otherwise) result(edge)
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: state
      integer, intent(in) :: next, side
      real(wp), intent(in) :: otherwise
      real(wp), parameter :: farthest = 1.5_wp
      real(wp) :: values(0:1), distance

      edge = otherwise
      if (next + side < 1 .or. next + side > size(state%status)) return
      if (state%status(next + side) /= state%status(next)) return
      values = [slip_measure(state, next), slip_measure(state, next + side)]
      if (.not. values(1) > values(0)) return
      distance = values(0)/(values(1) - values(0))
      if (distance <= farthest) edge = model%arc(next) - distance*(model%arc(next + side) - model%arc(next))
   end function edge_by_slip

   !> The slip of a node since its last stick to the power 2/3: linear in the distance from the edge of the stick zone.
   pure real(wp) function slip_measure(state, node)
      type(contact_state_type), intent(in) :: state
      integer, intent(in) :: node

      slip_measure = abs(state%fields%tangential(node) - state%fields%motion(motion_shift) - state%stuck_slip(node)) &
                     **(2.0_wp/3.0_wp)
   end function slip_measure

   !> Tractions raised to the inverse of their exponent, relative to the largest.
   pure type(edge_samples_type) function straightened(samples, power) result(straight)
      type(edge_samples_type), intent(in) :: samples
      real(wp), intent(in) :: power
      real(wp) :: largest

      straight = samples
      straight%power = power
      straight%is_regular = samples%is_regular .and. power > least_power .and. power < most_power
      largest = maxval(samples%value(:samples%number - 1))
      straight%value = 0.0_wp
      if (largest > 0.0_wp) straight%value = max(samples%value/largest, 0.0_wp)**(1.0_wp/merge(power + 1.0_wp, power, &
                                                                                               samples%is_integral))
   end function straightened

   !> Deviation of the exponent from 1/2 where nodes near `node` slip with shear traction over pressure `ratio`: nonzero with
   !> full coupling only, between -1/2 and 1/2.
   real(wp) function exponent_shift(model, node, ratio)
      type(contact_model_type), intent(in) :: model
      integer, intent(in) :: node
      real(wp), intent(in) :: ratio
      type(near_field_type) :: pair

      exponent_shift = 0.0_wp
      if (.not. model%compliance%elastic_block(block_wt)) return
      if (model%scene%lower%is_matrix()) then
         exponent_shift = root_shift(local_beta(model, node)*ratio)
      else
         pair = model%scene%near_field()
         exponent_shift = root_shift(pair%edge_product(ratio))
      end if
   end function exponent_shift

   !> Dundurs' beta of bodies given by a matrix, from the entries about a node. Next to a force P, w is -A ln(r) P/pi; next to
   !> a force Q it jumps from -B Q to B Q; beta = 2 B/A as for half-planes (A the sum of (kappa + 1)/(4 G), B the difference
   !> of (kappa - 1)/(8 G)). Regular terms cancel between the two sides. 0 with too few nodes or without such a logarithm.
   real(wp) function local_beta(model, node) result(beta)
      type(contact_model_type), intent(in) :: model
      integer, intent(in) :: node
      integer, parameter :: apart = 3
      real(wp) :: by_pressure(1, 4), by_shear(1, 4), slope, r(4)
      integer :: middle, columns(4), n

      beta = 0.0_wp
      n = model%nodes()
      if (n < 4*apart + 1) return
      middle = min(max(node, 1 + 2*apart), n - 2*apart)
      columns = middle + [-2, -1, 1, 2]*apart
      call model%compliance%entries(block_wp, [middle], columns, by_pressure)
      call model%compliance%entries(block_wt, [middle], columns, by_shear)
      by_pressure(1, :) = by_pressure(1, :)/model%width(columns)
      by_shear(1, :) = by_shear(1, :)/model%width(columns)
      r = abs(model%arc(columns) - model%arc(middle))
      slope = pi*(by_pressure(1, 2) + by_pressure(1, 3) - by_pressure(1, 1) - by_pressure(1, 4))/log(r(1)*r(4)/(r(2)*r(3)))
      if (slope > 0.0_wp) beta = min(max((by_shear(1, 2) - by_shear(1, 3))/slope, -1.0_wp), 1.0_wp)
   end function local_beta

   !> Whether the equations about a node are those of mfv_edge_solutions: uniform tractions on equal intervals, normal
   !> displacements -ln(r) P at their middles. Matrices are judged by their entries. Under layers the displacements differ from that
   !> by smooth ones (docs/verification.md). `samples`: number of values.
   logical function has_known_error(model, node, samples)
      type(contact_model_type), intent(in) :: model
      integer, intent(in) :: node, samples
      integer, parameter :: about = 2, fewest = 3
      !> Of widths, and of entries of matrices; of entries of circles, which differ by (h/R)^2.
      real(wp), parameter :: near = 5.0e-3_wp, alike = 0.05_wp
      !> (C(0) - C(1))/(C(1) - C(2)), C(j) = (j - 1/2) ln|j - 1/2| - (j + 1/2) ln(j + 1/2).
      real(wp), parameter :: ratio = 1.5_wp*log(3.0_wp)/(2.5_wp*log(2.5_wp) - 3.0_wp*log(1.5_wp) - 0.5_wp*log(2.0_wp))
      real(wp) :: entries(1, -about:about), steps(2)
      integer :: middle, j

      has_known_error = allocated(model%scene%mesh%ends) .and. samples >= fewest
      if (allocated(model%scene%mesh%ends)) return
      if (samples < fewest .or. model%nodes() < 2*about + 1) return
      middle = min(max(node, about + 1), model%nodes() - about)
      call model%compliance%entries(block_wp, [middle], [(middle + j, j=-about, about)], entries)
      entries(1, :) = entries(1, :)/model%width(middle - about:middle + about)
      steps = [2.0_wp*entries(1, 0) - entries(1, -1) - entries(1, 1), &
               entries(1, -1) + entries(1, 1) - entries(1, -2) - entries(1, 2)]
      has_known_error = (model%scene%is_layered() .or. &
                         abs(steps(1) - ratio*steps(2)) <= merge(near, alike, model%scene%lower%is_matrix())*abs(steps(1))) .and. &
                        maxval(abs(model%width(middle - about:middle + about) - model%width(node))) <= near*model%width(node)
   end function has_known_error

   !> Where straightened tractions vanish, in intervals outwards from the outermost node, and the uncertainty of that, intervals.
   !> `solved`: by the discrete solution, where the discretisation error is known, and not as the zero of nearly linear values.
   subroutine find_distance(samples, distance, error, solved)
      type(edge_samples_type), intent(in) :: samples
      real(wp), intent(out) :: distance, error
      logical, intent(out) :: solved
      !> By the largest of unequal intervals: their discretisation error moves the edge (docs/verification.md).
      real(wp), parameter :: by_largest = 0.005_wp
      !> Beyond it the next node would be in contact: the traction does not vanish as a root.
      real(wp), parameter :: farthest = 1.35_wp
      !> The errors of two fits are in proportion to the products of the distances of their nodes from the edge: that of the
      !> outermost three, the first at the distance d, is d/3 of the difference from that of the second to fourth, or more.
      real(wp), parameter :: of_difference = 0.4_wp, least_distance = 0.5_wp
      real(wp) :: farther
      logical :: found

      solved = .false.
      if (.not. samples%is_regular) then
         error = uncertainty_of_zero(samples)
      else if (samples%is_integral) then
         error = least_error + by_largest*maxval(samples%width)**2/sum(samples%width)
         call find_graded_distance(samples, distance, solved)
      else
         error = error_if_unknown
         call find_solved_distance(samples%traction, samples%power, 0, distance, solved)
         call find_solved_distance(samples%traction, samples%power, 1, farther, found)
         solved = solved .and. distance < farthest
         if (solved .and. found) &
            error = min(max(least_error, of_difference*max(distance, least_distance)*abs(farther - distance)), error_if_unknown)
      end if
      if (.not. solved) distance = distance_to_zero(samples, .false.)
   end subroutine find_distance

   !> The distance by the discrete solution of unequal intervals, if `found`.
   subroutine find_graded_distance(samples, distance, found)
      type(edge_samples_type), intent(in) :: samples
      real(wp), intent(out) :: distance
      logical, intent(out) :: found
      type(graded_solution_type) :: solution

      solution = new_graded_solution(samples%width, samples%power)
      call solution%edge_beyond(samples%traction, samples%beyond, distance, found)
      distance = distance + 0.5_wp
   end subroutine find_graded_distance

   !> Uncertainty of the zero of nearly linear values, intervals: the distance of the zeros by nearer and by farther values.
   pure real(wp) function uncertainty_of_zero(samples) result(uncertainty)
      type(edge_samples_type), intent(in) :: samples
      real(wp) :: near, farther
      logical :: found(2)

      uncertainty = error_if_unknown
      if (samples%number < most_samples) return
      call find_zero_of_three(samples%inwards(1:3), samples%value(1:3), near, found(1))
      call find_zero_of_three(samples%inwards(2:6:2), samples%value(2:6:2), farther, found(2))
      if (all(found)) uncertainty = min(max(abs(farther - near), least_error), error_if_unknown)
   end function uncertainty_of_zero

   !> Zero of nearly linear values, outermost first, in intervals outwards from the outermost node. Used are the second to
   !> fourth node, because the outermost one has the largest discretisation error; the third, fifth and seventh if the third
   !> to seventh are smooth (not near other edges); the second to seventh by least squares in a zone that has `grown` node by
   !> node; all of three nodes; a line through two. 1/2 if the zero is not within one interval of that.
   pure real(wp) function distance_to_zero(samples, grown) result(distance)
      type(edge_samples_type), intent(in) :: samples
      logical, intent(in) :: grown
      real(wp), parameter :: smooth = 0.04_wp
      real(wp) :: farther, trust
      logical :: found, found_farther

      found = .false.
      found_farther = .false.
      associate (n => samples%number, t => samples%inwards, values => samples%value)
         if (grown .and. n == most_samples) call find_zero_of_many(t(1:), values(1:), distance, found)
         if (found) return
         if (n == 3) call find_zero_of_three(t(0:2), values(0:2), distance, found)
         if (n > 3) call find_zero_of_three(t(1:3), values(1:3), distance, found)
         if (n == most_samples) call find_zero_of_three(t(2:6:2), values(2:6:2), farther, found_farther)
         if (found_farther) then
            trust = min(max(2.0_wp - off_parabola(t, values)/smooth, 0.0_wp), 1.0_wp)
            if (.not. found) distance = farther
            if (found .or. trust > 0.0_wp) distance = distance + trust*(farther - distance)
            found = found .or. trust > 0.0_wp
         end if
         if (found) return
         distance = 0.5_wp
         if (n < 2) return
         if (values(1) > values(0)) distance = values(0)*t(1)/(values(1) - values(0))
         if (abs(distance - 0.5_wp) > 1.0_wp) distance = 0.5_wp
      end associate
   end function distance_to_zero

   !> Deviation of the fourth and sixth value from the parabola through the third, fifth and seventh, in intervals by their
   !> slope.
   pure real(wp) function off_parabola(t, values) result(off)
      real(wp), intent(in) :: t(0:most_samples - 1), values(0:most_samples - 1)
      real(wp) :: first, second, bend, slope
      integer :: i

      first = (values(4) - values(2))/(t(4) - t(2))
      second = (values(6) - values(4))/(t(6) - t(4))
      bend = (second - first)/(t(6) - t(2))
      slope = first - bend*(t(4) - t(2))
      off = unknown_bend
      if (.not. slope > 0.0_wp) return
      off = 0.0_wp
      do i = 3, 5, 2
         off = max(off, min(abs(values(i) - values(2) - (t(i) - t(2))*(first + bend*(t(i) - t(4)))), unknown_bend*slope)/slope)
      end do
   end function off_parabola

   !> The same for the parabola through three values.
   pure subroutine find_zero_of_three(t, values, distance, found)
      real(wp), intent(in) :: t(3), values(3)
      real(wp), intent(out) :: distance
      logical, intent(out) :: found
      real(wp) :: first, second, bend

      first = (values(2) - values(1))/(t(2) - t(1))
      second = (values(3) - values(2))/(t(3) - t(2))
      bend = (second - first)/(t(3) - t(1))
      call find_zero(values(1), first - bend*(t(2) - t(1)), bend, t(1), distance, found)
   end subroutine find_zero_of_three

   !> The same for the least-squares parabola of several values, by orthogonal polynomials.
   pure subroutine find_zero_of_many(t, values, distance, found)
      real(wp), intent(in) :: t(:), values(:)
      real(wp), intent(out) :: distance
      logical, intent(out) :: found
      real(wp), dimension(size(t)) :: line, parabola
      real(wp) :: mean, slope, bend, skewness

      line = t - sum(t)/size(t)
      skewness = sum(line**3)/sum(line**2)
      parabola = line**2 - skewness*line - sum(line**2)/size(t)
      mean = sum(values)/size(t)
      slope = sum(line*values)/sum(line**2)
      bend = sum(parabola*values)/sum(parabola**2)
      call find_zero(mean + slope*line(1) + bend*parabola(1), slope + bend*(2.0_wp*line(1) - skewness), bend, t(1), distance, found)
   end subroutine find_zero_of_many

   !> Zero nearest to the edge of the parabola near + slope*t + bend*t^2, t intervals inwards from a point `inwards` of the
   !> outermost node; `distance` as in distance_to_zero. `found`: within one interval of the outermost node's end.
   pure subroutine find_zero(near, slope, bend, inwards, distance, found)
      real(wp), intent(in) :: near, slope, bend, inwards
      real(wp), intent(out) :: distance
      logical, intent(out) :: found
      real(wp) :: discriminant

      distance = 0.5_wp
      found = .false.
      discriminant = slope**2 - 4.0_wp*bend*near
      if (.not. (slope > 0.0_wp .and. discriminant > 0.0_wp)) return
      distance = 2.0_wp*near/(slope + sqrt(discriminant)) - inwards
      found = abs(distance - 0.5_wp) <= 1.0_wp
   end subroutine find_zero

   !> Number of nodes in which a contact that ends with the mesh at a node on `side` (-1 left, 1 right) continues at its other end,
   !> where the surfaces repeat.
   pure integer function nodes_across(model, state, node, side) result(nodes)
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: state
      integer, intent(in) :: node, side
      integer, allocatable :: order(:)
      integer :: i, n

      nodes = 0
      if (.not. model%repeats_beyond(node, side)) return
      n = model%nodes()
      order = [(merge(i, n + 1 - i, side > 0), i=1, n)]
      nodes = findloc([in_contact(state%status(order)), .false.], .false., dim=1) - 1
   end function nodes_across

   !> Whether the surface of a body ends with the interval of a node, on `side` (-1 left, 1 right).
   pure logical function ends_with_body(model, state, node, side)
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: state
      integer, intent(in) :: node, side
      real(wp) :: half

      half = 0.5_wp*model%width(node)
      ends_with_body = model%scene%touchable(model%arc(node) + side*half*(1.0_wp - visible)) .and. &
                       .not. model%scene%touchable(model%arc(node) + side*half*(1.0_wp + visible)) .and. &
                       (nodes_across(model, state, node, side) > 0 .or. .not. model%repeats_beyond(node, side))
   end function ends_with_body

end module mfv_zone_edges
