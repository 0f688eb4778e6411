!> Whether a mesh resolves the slip zones of partial slip.
!>
!> The dissipation of a load segment grows with the third power of the slip zone width. A widest slip zone of c intervals
!> gives it a relative error of at most dissipation_constant/c^2 (measured against Mindlin's closed form,
!> docs/verification.md). If no node slips, the width follows from the tractions. At a distance d from the contact edge the
!> friction limit is M sqrt(d) (M = mu L on first loading, 2 mu L after a reversal, L sqrt(d) the pressure), and with full
!> stick the shear traction changes by K/sqrt(d). The slip zone of Cattaneo and Mindlin, M (sqrt(d) - sqrt(d - c)), has the
!> same far field for c = 2 K/M: for small forces, c/a = Q/(2 mu P). It dissipates pi mu L M c^3/(24 m), m the contact
!> modulus.
module mfv_slip_zones
   use mfv_compliance, only: block_up, coupling_full
   use mfv_contact_model, only: contact_model_type
   use mfv_contact_state, only: contact_state_type
   use mfv_kinds, only: pi, wp
   use mfv_motions, only: motion_count, motion_approach, motion_shift
   use mfv_near_field, only: near_field_type
   use mfv_node_status, only: holds, in_contact, motion_sign, node_frictionless, slip_sign
   use mfv_reference_spence, only: spence_stick_ratio
   use mfv_strings, only: to_text
   use mfv_tolerances, only: significant
   use mfv_zone_edges, only: ends_with_body, find_zone_edges, zone_edges_type, zone_type, zones_of
   implicit none
   private
   public :: slip_record_type, segment_start_type, widest_slip_zone, nodes_at_edge, hidden_width_at_edge, &
             resolved_nodes, needed_mesh, contact_interval, is_narrow_stick_zone, largest_resolved_error

   !> Nodes of a resolved slip zone.
   integer, parameter :: resolved_nodes = 4
   !> Width in intervals of a zone with this many nodes.
   real(wp), parameter :: resolving_intervals = 4.5_wp
   !> See the head of this file.
   real(wp), parameter :: dissipation_constant = 0.7_wp
   !> Largest relative error of the dissipation in slip zones that are just resolved.
   real(wp), parameter :: largest_resolved_error = dissipation_constant/resolving_intervals**2
   !> Segments with too few nodes matter to the dissipation above this fraction of it.
   real(wp), parameter :: coarse_share = 0.05_wp
   !> Hidden slip zones narrower than this fraction of an interval affect the dissipation only; narrower than this fraction of
   !> the contact half-width, nothing.
   real(wp), parameter :: visible = 0.05_wp, negligible = 1.0e-6_wp
   !> The same for pressing with friction, where slip zones shrink exponentially with mu.
   real(wp), parameter :: negligible_pressing = 1.0e-4_wp
   !> Widest slip zone without a node, in intervals.
   real(wp), parameter :: widest_hidden = 1.5_wp

   !> State at the start of a load segment.
   type :: segment_start_type
      real(wp) :: dissipation = 0.0_wp
      !> As in contact_fields_type.
      real(wp) :: force(motion_count) = 0.0_wp
      !> Shear traction, force/length^2, shape (nodes).
      real(wp), allocatable :: shear(:)
   end type segment_start_type

   !> Sums over load segments.
   type :: slip_sums_type
      !> Energy per unit thickness (force): dissipation, with an estimate for slip zones without a node; dissipation of
      !> segments whose slip zones have too few nodes.
      real(wp) :: work = 0.0_wp, coarse_work = 0.0_wp
      !> Sums over these segments: work times nodes (force), and work times slip zone width (force*length).
      real(wp) :: nodes = 0.0_wp, width = 0.0_wp
      !> Sum over all segments of work over squared slip zone width, force/length^2.
      real(wp) :: sharpness = 0.0_wp
   end type slip_sums_type

   !> Record of the slip zones of all load segments so far. The difference of its sums from those of another record is the sum over
   !> the segments between them. Successive segments in which all loads go on in their directions count as one, so that a load in
   !> many increments has the record of a load at once.
   type, extends(slip_sums_type) :: slip_record_type
      !> Widest slip zone now: its nodes and its width, length. Width 0: none.
      integer :: nodes_now = 0
      real(wp) :: width_now = 0.0_wp
      !> The sums before the segments that count as one with the last; the direction of each load in them: -1, 0 or 1.
      type(slip_sums_type) :: before
      integer :: direction(motion_count) = 0
      !> Of these segments: most nodes of a slip zone; dissipation, force; width (length) and dissipation (force) of slip zones
      !> without a node.
      integer :: most_nodes = 0
      real(wp) :: dissipation = 0.0_wp, hidden_width = 0.0_wp, hidden_work = 0.0_wp
      !> Largest slip of a node in contact and largest contact half-width at the end of a segment, lengths.
      real(wp) :: farthest = 0.0_wp, half_width = 0.0_wp
   contains
      procedure :: add_segment
      procedure :: turns_with
      procedure :: since
      procedure :: is_coarse
      procedure :: error_number
      procedure :: mean_nodes
      procedure :: mean_width
      procedure :: is_coarse_now
   end type slip_record_type

contains

   !> Nodes of the widest slip zone: neighbouring slipping nodes next to sticking ones; 0 without any. A contact patch in
   !> gross sliding has no zone to resolve: it counts with its nodes, and as resolved.
   pure integer function widest_slip_zone(status) result(widest)
      integer, intent(in) :: status(:)
      type(zone_type), allocatable :: zones(:)
      integer :: i, nodes

      zones = zones_of(motion_sign(status) /= 0)
      widest = 0
      do i = 1, size(zones)
         nodes = zones(i)%last - zones(i)%first + 1
         if (.not. (holds_at(zones(i)%first - 1) .or. holds_at(zones(i)%last + 1))) nodes = max(nodes, resolved_nodes)
         widest = max(widest, nodes)
      end do

   contains

      pure logical function holds_at(node)
         integer, intent(in) :: node

         holds_at = .false.
         if (node >= 1 .and. node <= size(status)) holds_at = holds(status(node))
      end function holds_at
   end function widest_slip_zone

   !> Number of nodes at the left (`side` -1) or right (1) edge of a contact of one patch that slip next to sticking ones, or that
   !> have slipped against the shear traction of the nodes further in; the smaller number, 0 without such nodes.
   pure integer function nodes_at_edge(model, state, side) result(nodes)
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: state
      integer, intent(in) :: side
      !> Part of the friction limit beyond which a traction is one of slip.
      real(wp), parameter :: nearly = 0.5_wp
      type(zone_type), allocatable :: patches(:)
      integer :: edge, length, slipping, reversed
      integer, allocatable :: inwards(:)
      integer :: i

      nodes = 0
      patches = zones_of(in_contact(state%status))
      if (size(patches) /= 1) return
      edge = merge(patches(1)%first, patches(1)%last, side < 0)
      length = patches(1)%last - patches(1)%first + 1
      inwards = [(edge - side*i, i=0, length - 1)]
      slipping = findloc(motion_sign(state%status(inwards)) /= 0, .false., dim=1) - 1
      if (slipping > 0) then
         if (holds(state%status(inwards(slipping + 1)))) nodes = slipping
      end if
      associate (shear => state%fields%shear(inwards))
         if (abs(shear(1)) < nearly*model%static_friction(edge)*state%fields%pressure(edge)) return
         reversed = findloc(shear*shear(1) < 0.0_wp, .true., dim=1) - 1
      end associate
      if (reversed > 0) nodes = merge(min(nodes, reversed), reversed, nodes > 0)
   end function nodes_at_edge

   !> Width (length) of a slip zone without a node at the left (`side` -1) or right (1) edge of a contact of one patch whose
   !> outermost node sticks although others slip; 0 without one. Next to the edge the shear traction of a stick zone is K/sqrt(d) +
   !> B sqrt(d), the friction limit M sqrt(d): d times their ratio is linear in the distance d, K/M at the edge, and the slip zone
   !> 2 K/M wide (see the head of this file). The outermost nodes have the largest errors and are not used. Pressing bodies of
   !> different materials with full coupling changes the shear, too, which is then not such a sum: 0.
   real(wp) function hidden_width_at_edge(model, state, side) result(width)
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: state
      integer, intent(in) :: side
      integer, parameter :: first = 2, last = 4
      !> Coupling of bodies that hardly differ.
      real(wp), parameter :: similar = 0.01_wp
      type(near_field_type) :: pair
      type(zone_edges_type) :: edges
      real(wp), dimension(first:last) :: distance, times_ratio
      integer :: edge, node(0:last), i

      width = 0.0_wp
      pair = model%scene%near_field()
      if (model%scene%coupling == coupling_full .and. pair%coupling_ratio() > similar) return
      edge = findloc(in_contact(state%status), .true., dim=1, back=side > 0)
      node = [(edge - side*i, i=0, last)]
      if (minval(node) < 1 .or. maxval(node) > size(state%status)) return
      if (.not. model%scene%friction%law%sticks .or. .not. all(holds(state%status(node)))) return
      if (size(zones_of(in_contact(state%status))) /= 1 .or. ends_with_body(model, state, edge, side)) return
      call find_zone_edges(model, state, edges)
      associate (inner => node(first:))
         distance = abs(model%arc(inner) - merge(edges%contact_left, edges%contact_right, side < 0))
         times_ratio = distance*state%fields%shear(inner)/(model%static_friction(inner)*state%fields%pressure(inner))
      end associate
      associate (slope => (times_ratio(last) - times_ratio(first))/(distance(last) - distance(first)))
         width = 2.0_wp*abs(sum(times_ratio - slope*distance)/size(distance))
      end associate
      if (width < visible*model%width(edge) .or. width > widest_hidden*model%width(edge)) width = 0.0_wp
   end function hidden_width_at_edge

   !> Add the load segment from `start` to `state`. `changes`: of the loads, see turns_with; `nodes`: largest number of nodes
   !> in a slip zone on it. `tolerance`: relative tolerance of the linear solver.
   subroutine add_segment(self, model, start, state, changes, nodes, tolerance)
      class(slip_record_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      type(segment_start_type), intent(in) :: start
      type(contact_state_type), intent(in) :: state
      real(wp), intent(in) :: changes(motion_count), tolerance
      integer, intent(in) :: nodes
      integer :: direction(motion_count)
      real(wp) :: work, width

      if (.not. model%tangential .or. .not. allocated(model%scene%friction%law)) return
      if (state%contact_nodes() > 0) then
         self%farthest = max(self%farthest, maxval(abs(state%fields%slip()), mask=in_contact(state%status)))
         self%half_width = max(self%half_width, 0.5_wp*sum(model%width, mask=in_contact(state%status)))
      end if
      direction = directions_of(changes)
      if (all(direction == 0)) return
      if (self%turns_with(changes)) call begin_direction(self, direction)
      self%most_nodes = max(self%most_nodes, nodes)
      self%dissipation = self%dissipation + (state%dissipation - start%dissipation)
      if (self%most_nodes == 0) then
         call estimate_hidden_slip(model, start, state, tolerance, width, work)
         call add_hidden_slip(self, width, work, widest_hidden*contact_interval(model, state))
         work = self%hidden_work
         width = merge(self%hidden_width, 0.0_wp, work > 0.0_wp)
         if (.not. work > 0.0_wp .and. widest_slip_zone(state%status) > 0) return
      else
         work = self%dissipation
         width = max(mean_slip_width(model, state), (self%most_nodes - 1)*contact_interval(model, state))
      end if
      self%nodes_now = self%most_nodes
      self%width_now = width
      self%slip_sums_type = self%before
      self%work = self%work + work
      if (width > 0.0_wp) self%sharpness = self%sharpness + work/width**2
      if (self%most_nodes >= resolved_nodes) return
      self%coarse_work = self%coarse_work + work
      self%nodes = self%nodes + self%most_nodes*work
      self%width = self%width + width*work
   end subroutine add_segment

   !> Whether loads with these changes, as tangential forces, do not all go on in their directions: the last segments end at a
   !> turning point.
   pure logical function turns_with(self, changes)
      class(slip_record_type), intent(in) :: self
      real(wp), intent(in) :: changes(motion_count)
      integer :: direction(motion_count)

      direction = directions_of(changes)
      turns_with = any(direction /= 0) .and. any(direction /= self%direction)
   end function turns_with

   !> Directions of loads with these changes: -1, 0 or 1. A load that changes far less than another one does not turn the slip, as
   !> the noise of a normal force under a changing tangential one.
   pure function directions_of(changes) result(directions)
      real(wp), intent(in) :: changes(motion_count)
      integer :: directions(motion_count)
      real(wp), parameter :: far_less = 0.1_wp

      directions = merge(int(sign(1.0_wp, changes)), 0, abs(changes) > far_less*maxval(abs(changes)))
   end function directions_of

   !> Begin segments in other directions of the loads.
   pure subroutine begin_direction(self, direction)
      class(slip_record_type), intent(inout) :: self
      integer, intent(in) :: direction(motion_count)

      self%before = self%slip_sums_type
      self%direction = direction
      self%most_nodes = 0
      self%dissipation = 0.0_wp
      self%hidden_width = 0.0_wp
      self%hidden_work = 0.0_wp
   end subroutine begin_direction

   !> Add the slip zones without a node of one segment, of a width (length) and a dissipation (force), to those of the segments that
   !> count as one with it: widths add up, and the dissipation grows with their third power. Wider than `widest` (length) they would
   !> have nodes: the theory does not hold.
   pure subroutine add_hidden_slip(self, width, work, widest)
      class(slip_record_type), intent(inout) :: self
      real(wp), intent(in) :: width, work, widest

      if (.not. work > 0.0_wp) return
      self%hidden_width = self%hidden_width + width
      self%hidden_work = work*(self%hidden_width/width)**3
      if (self%hidden_width > widest) self%hidden_work = 0.0_wp
   end subroutine add_hidden_slip

   !> Mean width of the slip zones next to stick zones, length.
   real(wp) function mean_slip_width(model, state) result(width)
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: state
      real(wp), parameter :: narrowest = 0.1_wp
      type(zone_edges_type) :: edges
      logical :: moves(0:size(state%status))

      moves(0) = .false.
      moves(1:) = motion_sign(state%status) /= 0
      call find_zone_edges(model, state, edges)
      width = (edges%contact_length - edges%stick_length)/max(count(moves(1:) .and. .not. moves(:size(state%status) - 1)), 1)
      width = max(width, narrowest*contact_interval(model, state))
   end function mean_slip_width

   !> Width (length) of a slip zone without a slipping node, and its dissipation, force. Both 0 if the theory has no slip or
   !> does not hold: a wider zone would have slipping nodes.
   subroutine estimate_hidden_slip(model, start, state, tolerance, width, missing)
      type(contact_model_type), intent(in) :: model
      type(segment_start_type), intent(in) :: start
      type(contact_state_type), intent(in) :: state
      real(wp), intent(in) :: tolerance
      real(wp), intent(out) :: width, missing
      integer, parameter :: fewest = 6
      !> Relative to the friction limit, smaller changes of the shear traction are within tolerance.
      real(wp), parameter :: least_tolerance = significant, margin = 100.0_wp
      real(wp) :: change(size(state%status)), one_width, one_work
      integer :: added, first, last, side

      width = 0.0_wp
      missing = 0.0_wp
      if (.not. model%scene%friction%law%sticks .or. any(state%status == node_frictionless)) return
      first = findloc(in_contact(state%status), .true., dim=1)
      last = findloc(in_contact(state%status), .true., dim=1, back=.true.)
      if (last - first + 1 < fewest) return
      if (.not. start%force(motion_approach) > 0.0_wp) then
         call add_pressing
         return
      end if
      if (presses_within_friction(model, start, state)) return
      ! The mesh may have grown at both ends.
      added = (size(change) - size(start%shear))/2
      change = state%fields%shear
      change(added + 1:added + size(start%shear)) = change(added + 1:added + size(start%shear)) - start%shear
      if (.not. maxval(abs(change)) > max(least_tolerance, margin*tolerance)*model%scene%friction%static%largest() &
          *maxval(state%fields%pressure)) return
      do side = -1, 1, 2
         call hidden_at_edge(model, state, change, merge(first, last, side < 0), side, one_width, one_work)
         width = max(width, one_width)
         missing = missing + one_work
      end do
      if (width > widest_hidden*contact_interval(model, state)) missing = 0.0_wp
      if (.not. missing > 0.0_wp) width = 0.0_wp

   contains

      !> With coupling, pressing with friction always causes slip next to the edge (Spence 1973).
      subroutine add_pressing
         type(near_field_type) :: pair
         real(wp) :: ratio, half_width

         if (.not. model%compliance%has_block(block_up) .or. .not. model%scene%modulus() > 0.0_wp) return
         half_width = 0.5_wp*sum(model%width(first:last))
         pair = model%scene%near_field_over(half_width)
         ratio = spence_stick_ratio(sqrt(pair%shear_ratio())*model%scene%friction%static%largest(), pair%beta())
         width = half_width*(1.0_wp - ratio)
         if (width > negligible_pressing*half_width .and. width <= widest_hidden*contact_interval(model, state)) &
            missing = model%scene%friction%static%largest()**2*pair%tangential*state%fields%force(motion_approach)**2 &
                      *(width/half_width)**3
         if (.not. missing > 0.0_wp) width = 0.0_wp
      end subroutine add_pressing
   end subroutine estimate_hidden_slip

   !> Whether the pressure grows by more than the tangential force needs. Then nothing slips: newly touching nodes keep the
   !> shear traction below the friction limit (Mindlin and Deresiewicz 1953).
   pure logical function presses_within_friction(model, start, state)
      type(contact_model_type), intent(in) :: model
      type(segment_start_type), intent(in) :: start
      type(contact_state_type), intent(in) :: state
      real(wp) :: pressed, sheared

      pressed = state%fields%force(motion_approach) - start%force(motion_approach)
      sheared = abs(state%fields%force(motion_shift) - start%force(motion_shift))
      presses_within_friction = pressed > significant*state%fields%force(motion_approach) .and. &
                                sheared <= model%scene%friction%static%largest()*pressed*(1.0_wp + significant)
   end function presses_within_friction

   !> Width (length) and dissipation (force) of the slip zone that the `change` of the shear traction, force/length^2, causes
   !> at the contact edge on `side` (-1 left, 1 right), whose outermost node `edge` sticks. Next to the edge the squares of
   !> friction limit and remaining friction are linear; the distance of their zeros is the width. `room` for the change over
   !> the friction limit: 2 after a reversal.
   subroutine hidden_at_edge(model, state, change, edge, side, width, work)
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: state
      real(wp), intent(in) :: change(:)
      integer, intent(in) :: edge, side
      real(wp), intent(out) :: width, work
      real(wp), parameter :: largest_room = 2.0_wp, least_room = 0.05_wp, tolerance = 1.0e-6_wp
      real(wp), dimension(3) :: limit, before, towards, room
      real(wp) :: room_number, slope, lack_slope, apart
      integer :: node(3), i

      width = 0.0_wp
      work = 0.0_wp
      node = [(edge - side*i, i=1, 3)]
      if (ends_with_body(model, state, edge, side) .or. .not. all(in_contact(state%status(node)))) return
      limit = model%static_friction(node)*state%fields%pressure(node)
      ! A peak of the pressure next to the edge (rounded punches): only nodes outside it follow the line.
      if (limit(3)**2 - limit(2)**2 < 0.5_wp*(limit(2)**2 - limit(1)**2)) then
         node = node + side
         limit = model%static_friction(node)*state%fields%pressure(node)
      end if
      if (.not. (all(limit > 0.0_wp) .and. limit(3) > limit(1))) return
      towards = sign(1.0_wp, change(node(2)))*change(node)
      before = sign(1.0_wp, change(node(2)))*(state%fields%shear(node) - change(node))
      room_number = min(max(1.0_wp - sum(before/limit)/3, least_room), largest_room)
      if (before(2) < 0.0_wp .and. towards(2) <= 2.0_wp*abs(before(2))*(1.0_wp + tolerance)) room_number = largest_room
      room = room_number*limit
      apart = abs(model%arc(node(3)) - model%arc(node(1)))
      slope = (room(3)**2 - room(1)**2)/apart
      room(1) = max(room(1) - towards(1), 0.0_wp)
      room(3) = max(room(3) - towards(3), 0.0_wp)
      lack_slope = (room(3)**2 - room(1)**2)/apart
      if (.not. lack_slope > 0.0_wp) return
      width = (room_number*limit(1))**2/slope - room(1)**2/lack_slope
      if (.not. width > negligible*model%width(edge)) then
         width = 0.0_wp
         return
      end if
      work = pi*slope*width**3/(24.0_wp*room_number*model%compliance%modulus)*model%compliance%shear_ratio
   end subroutine hidden_at_edge

   !> Record of the segments since another record of the same run.
   elemental type(slip_record_type) function since(self, before)
      class(slip_record_type), intent(in) :: self
      type(slip_record_type), intent(in) :: before
      !> Rounding errors of the sums, relative to the work.
      real(wp), parameter :: round_off = 1.0e-13_wp

      since = self
      since%work = self%work - before%work
      since%coarse_work = self%coarse_work - before%coarse_work
      since%nodes = self%nodes - before%nodes
      since%width = self%width - before%width
      since%sharpness = self%sharpness - before%sharpness
      if (abs(since%coarse_work) <= round_off*abs(self%work)) since%coarse_work = 0.0_wp
   end function since

   !> Whether slip zones with too few nodes matter to the dissipation.
   elemental logical function is_coarse(self)
      class(slip_record_type), intent(in) :: self

      is_coarse = self%coarse_work > coarse_share*max(self%work, 0.0_wp)
   end function is_coarse

   !> Relative error of the dissipation over the squared interval, 1/length^2; 0 without slip.
   elemental real(wp) function error_number(self)
      class(slip_record_type), intent(in) :: self

      error_number = 0.0_wp
      if (self%work > 0.0_wp) error_number = dissipation_constant*self%sharpness/self%work
   end function error_number

   !> Mean number of nodes of these slip zones, weighted by dissipation.
   elemental integer function mean_nodes(self)
      class(slip_record_type), intent(in) :: self

      mean_nodes = 0
      if (self%coarse_work > 0.0_wp) mean_nodes = nint(self%nodes/self%coarse_work)
   end function mean_nodes

   !> Mean width of these slip zones, length, weighted by dissipation.
   elemental real(wp) function mean_width(self)
      class(slip_record_type), intent(in) :: self

      mean_width = 0.0_wp
      if (self%coarse_work > 0.0_wp) mean_width = self%width/self%coarse_work
   end function mean_width

   !> Whether the slip zones at the end of the last segment have too few nodes for the stick ratio. `interval`: length.
   elemental logical function is_coarse_now(self, interval)
      class(slip_record_type), intent(in) :: self
      real(wp), intent(in) :: interval

      is_coarse_now = self%nodes_now < resolved_nodes .and. &
                      (self%nodes_now > 0 .or. self%width_now > visible*interval)
   end function is_coarse_now

   !> Whether a stick zone has few nodes between opposite slip: the shear traction changes its sign in it.
   pure logical function is_narrow_stick_zone(status, zone)
      integer, intent(in) :: status(:)
      class(zone_type), intent(in) :: zone

      is_narrow_stick_zone = .false.
      if (zone%first == 1 .or. zone%last == size(status) .or. zone%last - zone%first + 1 >= resolved_nodes) return
      is_narrow_stick_zone = slip_sign(status(zone%first - 1))*slip_sign(status(zone%last + 1)) < 0
   end function is_narrow_stick_zone

   !> Mean width of the intervals in contact, length; of all intervals without contact.
   pure real(wp) function contact_interval(model, state)
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: state

      contact_interval = model%interval()
      if (state%contact_nodes() > 0) contact_interval = sum(model%width, mask=in_contact(state%status))/state%contact_nodes()
   end function contact_interval

   !> The mesh that has `wanted` nodes in zones of a width (length), in words.
   function needed_mesh(model, state, width, wanted) result(words)
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: state
      real(wp), intent(in) :: width
      integer, intent(in) :: wanted
      character(len=80) :: words
      !> A zone is that much wider than its nodes, in intervals; most nodes that are worth a number.
      real(wp), parameter :: margin = 0.5_wp, countable = 1.0e8_wp
      real(wp) :: nodes, digits

      words = 'intervals of '//to_text(width/(wanted + margin), 2)
      if (model%scene%lower%is_matrix()) return
      nodes = model%scene%mesh%nodes*(wanted + margin)*contact_interval(model, state)/width
      digits = 10.0_wp**(floor(log10(nodes)) - 1)
      if (nodes < countable) words = 'about '//to_text(nint(digits*ceiling(nodes/digits)))//' nodes ('//trim(words)//')'
   end function needed_mesh

end module mfv_slip_zones
