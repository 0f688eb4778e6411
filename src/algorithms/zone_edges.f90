!> Edges of contact and stick zones between the nodes.
!>
!> Numbers of nodes know an edge to an interval. The tractions know it better: where a smooth contact ends, the pressure goes
!> to zero as a root of the distance, and where a stick zone ends, so does what the shear traction lacks of the friction limit
!> (Hertz; Cattaneo and Mindlin, dissertation eqs. 3.1, 3.7). The root is the square root but for full coupling of slipping
!> nodes: there p goes with the power 1/2 + l towards +x and 1/2 - l towards -x, tan(pi l) = beta tau/p, tau/p that of the
!> slipping nodes (the exponent of a sliding contact: Johnson 1985, section 8.1; Comninou 1977 at the end of a stick zone,
!> from the other side). Where a stick zone grows, what lacks has come about bit by bit behind its edge, and goes with a power
!> larger by one (integrate the root; so do the closed forms of Spence): the straighter of the two tells. So the traction raised
!> to the inverse power is nearly a straight line, which a parabola through a few nodes follows to its zero. The outermost node,
!> which carries the error of the discretisation, is left out.
module mfv_zone_edges
   use mfv_archive, only: archive_type
   use mfv_compliance, only: block_wt
   use mfv_contact_model, only: contact_model_type
   use mfv_contact_state, only: contact_state_type
   use mfv_kinds, only: pi, wp
   use mfv_node_status, only: holds, in_contact, node_open, slip_sign, slips
   implicit none
   private
   public :: zone_edges_type, find_zone_edges, ends_with_body

   !> Edges of the contact and of what sticks in it, lengths along the surface from the pole, to the right positive.
   type :: zone_edges_type
      !> Whether anything is in contact; and whether anything holds.
      logical :: contact = .false., stick = .false.
      !> The outermost edges, and the length of all zones together.
      real(wp) :: contact_left = 0.0_wp, contact_right = 0.0_wp, contact_length = 0.0_wp
      real(wp) :: stick_left = 0.0_wp, stick_right = 0.0_wp, stick_length = 0.0_wp
   contains
      procedure :: half_width
      procedure :: centre
      procedure :: stick_ratio
      procedure :: carry
   end type zone_edges_type

   !> A zone of nodes from `first` to `last`.
   type :: zone_type
      integer :: first = 0, last = 0
   end type zone_type

contains

   !> Half the length of the contact, length.
   elemental real(wp) function half_width(self)
      class(zone_edges_type), intent(in) :: self

      half_width = 0.5_wp*self%contact_length
   end function half_width

   !> Middle of the contact, length from the pole.
   elemental real(wp) function centre(self)
      class(zone_edges_type), intent(in) :: self

      centre = 0.5_wp*(self%contact_left + self%contact_right)
   end function centre

   !> Length of what sticks over that of the contact; 0 without contact.
   elemental real(wp) function stick_ratio(self)
      class(zone_edges_type), intent(in) :: self

      stick_ratio = 0.0_wp
      if (self%contact_length > 0.0_wp) stick_ratio = self%stick_length/self%contact_length
   end function stick_ratio

   !> The edges in a state. Where tractions do not tell (a few nodes, sharp corners, laws of friction without a corner at the limit)
   !> an edge is in the middle between two nodes, as their numbers have it.
   subroutine find_zone_edges(model, state, edges)
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: state
      type(zone_edges_type), intent(out) :: edges
      type(zone_type), allocatable :: zones(:)
      real(wp) :: left, right
      integer :: i

      call find_zones(in_contact(state%status), zones)
      do i = 1, size(zones)
         left = contact_edge(model, state, zones(i), -1)
         right = contact_edge(model, state, zones(i), 1)
         edges%contact_length = edges%contact_length + (right - left)
         if (i == 1) edges%contact_left = left
         edges%contact_right = right
      end do
      edges%contact = size(zones) > 0
      call find_zones(held(state), zones)
      do i = 1, size(zones)
         ! What sticks is in contact, wherever the tractions of a few nodes may point.
         left = max(stick_edge(model, state, zones(i), -1), contact_edge(model, state, whole_contact(state, zones(i)%first), -1))
         right = min(stick_edge(model, state, zones(i), 1), contact_edge(model, state, whole_contact(state, zones(i)%last), 1))
         right = max(left, right)
         edges%stick_length = min(edges%stick_length + (right - left), edges%contact_length)
         if (i == 1) edges%stick_left = left
         edges%stick_right = right
      end do
      edges%stick = size(zones) > 0
   end subroutine find_zone_edges

   !> Which nodes hold; those too that may slip from now on and have not done so yet. (Where a cycle repeats the tractions of one
   !> before, many nodes come to their limit together at the very end, and round-off decides how many of them are called slipping.)
   pure function held(state)
      type(contact_state_type), intent(in) :: state
      logical :: held(size(state%status))
      real(wp), parameter :: nothing = 1.0e-6_wp
      real(wp) :: slipped(size(state%status))

      slipped = 0.0_wp
      held = .false.
      if (.not. any(holds(state%status))) return
      where (slips(state%status)) slipped = abs(state%fields%tangential - state%fields%shift - state%stuck_slip)
      held = holds(state%status) .or. (slips(state%status) .and. slipped <= nothing*maxval(slipped))
   end function held

   !> The zones where `inside` is true.
   pure subroutine find_zones(inside, zones)
      logical, intent(in) :: inside(:)
      type(zone_type), allocatable, intent(out) :: zones(:)
      logical :: padded(0:size(inside) + 1)
      integer :: i, n, number

      n = size(inside)
      padded = .false.
      padded(1:n) = inside
      allocate (zones(count(padded(1:n) .and. .not. padded(:n - 1))))
      number = 0
      do i = 1, n
         if (.not. padded(i)) cycle
         if (.not. padded(i - 1)) number = number + 1
         if (.not. padded(i - 1)) zones(number)%first = i
         zones(number)%last = i
      end do
   end subroutine find_zones

   !> Edge of a contact zone on `side` (-1 left, 1 right), length from the pole.
   real(wp) function contact_edge(model, state, zone, side) result(edge)
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: state
      type(zone_type), intent(in) :: zone
      integer, intent(in) :: side
      real(wp) :: values(0:6), power
      integer :: last, nodes, i

      last = merge(zone%last, zone%first, side > 0)
      nodes = min(zone%last - zone%first + 1, size(values))
      edge = model%arc(last) + 0.5_wp*side*model%interval()
      if (ends_with_body(model, last, side)) return
      power = 0.5_wp
      if (slips(state%status(last)) .and. state%fields%pressure(last) > 0.0_wp) &
         power = 0.5_wp + side*lean(model, state%fields%shear(last)/state%fields%pressure(last))
      do i = 0, nodes - 1
         values(i) = state%fields%pressure(last - side*i)
      end do
      edge = edge + side*model%interval()*distance_to_zero(straightened(values(:nodes - 1), power), .false.)
   end function contact_edge

   !> Edge of a zone that holds, on `side` (-1 left, 1 right), length from the pole: that of the contact where the next node is
   !> open, else where the shear traction comes to the friction limit.
   real(wp) function stick_edge(model, state, zone, side) result(edge)
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: state
      type(zone_type), intent(in) :: zone
      integer, intent(in) :: side
      real(wp) :: values(0:6), power, direction
      integer :: last, nodes, next, i
      logical :: grown

      last = merge(zone%last, zone%first, side > 0)
      next = min(max(last + side, 1), size(state%status))
      edge = model%arc(last) + 0.5_wp*side*model%interval()
      if (next == last .or. state%status(next) == node_open) then
         edge = contact_edge(model, state, whole_contact(state, last), side)
         return
      end if
      if (.not. (slips(state%status(next)) .and. model%scene%friction%is_coulomb())) return
      direction = -slip_sign(state%status(next))
      power = 0.5_wp - side*lean(model, direction*model%kinetic_friction(next))
      nodes = zone%last - zone%first + 1
      if (nodes > 1 .and. at_its_limit(last)) then
         if (at_its_limit(last - side)) then
            edge = edge + side*model%interval()*distance_by_slip(state, next, side)
            return
         end if
         ! One node may hold or slip: the edge must not depend on that.
         last = last - side
         nodes = nodes - 1
         edge = edge - side*model%interval()
      end if
      nodes = min(nodes, size(values))
      do i = 0, nodes - 1
         values(i) = lack(last - side*i)
      end do
      grown = bend(straightened(values(:nodes - 1), power + 1.0_wp)) < bend(straightened(values(:nodes - 1), power))
      if (grown) power = power + 1.0_wp
      edge = edge + side*model%interval()*distance_to_zero(straightened(values(:nodes - 1), power), grown)

   contains

      !> Whether a node holds at its friction limit to within round-off.
      pure logical function at_its_limit(node)
         integer, intent(in) :: node
         real(wp), parameter :: round_off = 1.0e-9_wp

         at_its_limit = lack(node) <= round_off*model%static_friction(node)*state%fields%pressure(node)
      end function at_its_limit

      !> What the shear traction of a node lacks of the friction limit, force/length^2.
      pure real(wp) function lack(node)
         integer, intent(in) :: node

         lack = model%static_friction(node)*state%fields%pressure(node) - direction*state%fields%shear(node)
      end function lack
   end function stick_edge

   !> How far from a straight line the second to fourth of some values are, in parts of their change; large where there are fewer or
   !> where they do not grow.
   pure real(wp) function bend(values)
      real(wp), intent(in) :: values(0:)

      bend = huge(1.0_wp)
      if (size(values) < 4) return
      if (values(3) > values(1)) bend = abs(values(1) - 2.0_wp*values(2) + values(3))/(values(3) - values(1))
   end function bend

   !> The edge of a stick zone whose nodes hold at their limit, as in a cycle that repeats the tractions of one before: tractions do
   !> not tell it, but what the nodes beyond it have slipped since they last held, which grows with the power 3/2 of the distance
   !> (Mindlin). In intervals outwards from half an interval before node `next`, the first one that slips; 0 where that does not
   !> tell either.
   pure real(wp) function distance_by_slip(state, next, side) result(distance)
      type(contact_state_type), intent(in) :: state
      integer, intent(in) :: next, side
      real(wp), parameter :: farthest = 1.5_wp
      real(wp) :: values(0:1)
      integer :: i, node

      distance = 0.0_wp
      if (next + side < 1 .or. next + side > size(state%status)) return
      if (state%status(next + side) /= state%status(next)) return
      do i = 0, 1
         node = next + side*i
         values(i) = abs(state%fields%tangential(node) - state%fields%shift - state%stuck_slip(node))**(2.0_wp/3.0_wp)
      end do
      if (.not. values(1) > values(0)) return
      if (values(0) <= farthest*(values(1) - values(0))) distance = 0.5_wp - values(0)/(values(1) - values(0))
   end function distance_by_slip

   !> Tractions that go as a power of the distance, raised to the inverse power, in parts of the largest.
   pure function straightened(tractions, power) result(values)
      real(wp), intent(in) :: tractions(:), power
      real(wp) :: values(size(tractions))
      real(wp) :: largest

      values = 0.0_wp
      largest = maxval(tractions)
      if (largest > 0.0_wp) values = max(tractions/largest, 0.0_wp)**(1.0_wp/power)
   end function straightened

   !> The contact zone around a node.
   pure function whole_contact(state, node) result(zone)
      type(contact_state_type), intent(in) :: state
      integer, intent(in) :: node
      type(zone_type) :: zone

      zone = zone_type(node, node)
      do while (zone%first > 1)
         if (.not. in_contact(state%status(zone%first - 1))) exit
         zone%first = zone%first - 1
      end do
      do while (zone%last < size(state%status))
         if (.not. in_contact(state%status(zone%last + 1))) exit
         zone%last = zone%last + 1
      end do
   end function whole_contact

   !> By how much the exponent of the root is off 1/2 where nodes slip with shear traction over pressure `ratio`: only under full
   !> coupling, between -1/2 and 1/2.
   pure real(wp) function lean(model, ratio)
      type(contact_model_type), intent(in) :: model
      real(wp), intent(in) :: ratio

      lean = 0.0_wp
      if (model%compliance%has_block(block_wt)) lean = atan(model%scene%dundurs_beta()*ratio)/pi
   end function lean

   !> Where nearly straight values, the outermost first, are zero, in intervals outwards from half an interval beyond the first
   !> one. The second to fourth node tell, the outermost one carrying the largest error; where the third, fifth and seventh say
   !> nearly the same (near edges of other zones they do not), these tell better. The tractions of a zone that has `grown` node by
   !> node are ragged: there the second to seventh tell together. Where there are only two or three nodes, a line through the
   !> outermost; 0 where all this leads nowhere within one interval.
   pure real(wp) function distance_to_zero(values, grown) result(distance)
      real(wp), intent(in) :: values(0:)
      logical, intent(in) :: grown
      real(wp), parameter :: nearly = 0.3_wp
      real(wp) :: farther
      logical :: found, agree

      found = .false.
      distance = 0.0_wp
      if (grown .and. size(values) > 6) call find_zero_of_many(values(1:6), distance, found)
      if (found) return
      if (size(values) > 3) call find_zero_of_three(values, 1, 1, distance, found)
      if (found .and. size(values) > 6) then
         call find_zero_of_three(values, 2, 2, farther, agree)
         if (agree .and. abs(farther - distance) <= nearly) distance = farther
      end if
      if (found) return
      distance = 0.0_wp
      if (size(values) < 2) return
      if (values(1) > values(0)) distance = values(0)/(values(1) - values(0)) - 0.5_wp
      if (abs(distance) > 1.0_wp) distance = 0.0_wp
   end function distance_to_zero

   !> The same for the parabola through the values `first`, `first` + `apart` and `first` + 2 `apart`.
   pure subroutine find_zero_of_three(values, first, apart, distance, found)
      real(wp), intent(in) :: values(0:)
      integer, intent(in) :: first, apart
      real(wp), intent(out) :: distance
      logical, intent(out) :: found
      real(wp) :: bend

      bend = (values(first + 2*apart) - 2.0_wp*values(first + apart) + values(first))/(2.0_wp*apart**2)
      call find_zero(values(first), (values(first + apart) - values(first))/apart - apart*bend, bend, first, distance, found)
   end subroutine find_zero_of_three

   !> The same for the parabola that is nearest to six values, the first one interval inwards from the outermost node: by the
   !> orthogonal polynomials of six equidistant points.
   pure subroutine find_zero_of_many(values, distance, found)
      real(wp), intent(in) :: values(6)
      real(wp), intent(out) :: distance
      logical, intent(out) :: found
      real(wp), parameter :: line(6) = [-2.5_wp, -1.5_wp, -0.5_wp, 0.5_wp, 1.5_wp, 2.5_wp], &
                             parabola(6) = line**2 - 35.0_wp/12.0_wp
      real(wp) :: mean, slope, bend

      mean = sum(values)/6
      slope = sum(line*values)/sum(line**2)
      bend = sum(parabola*values)/sum(parabola**2)
      call find_zero(mean + slope*line(1) + bend*parabola(1), slope + 2.0_wp*bend*line(1), bend, 1, distance, found)
   end subroutine find_zero_of_many

   !> Zero of the parabola near + slope*t + bend*t^2, t intervals inwards from node `first` (0: the outermost), the one nearest to
   !> the edge; `distance` as in distance_to_zero. `found`: it is within one interval.
   pure subroutine find_zero(near, slope, bend, first, distance, found)
      real(wp), intent(in) :: near, slope, bend
      integer, intent(in) :: first
      real(wp), intent(out) :: distance
      logical, intent(out) :: found
      real(wp) :: discriminant

      distance = 0.0_wp
      found = .false.
      discriminant = slope**2 - 4.0_wp*bend*near
      if (.not. (slope > 0.0_wp .and. discriminant > 0.0_wp)) return
      distance = 2.0_wp*near/(slope + sqrt(discriminant)) - first - 0.5_wp
      found = abs(distance) <= 1.0_wp
   end subroutine find_zero

   !> Whether the surface of a body ends where the interval of a node does, on `side` (-1 left, 1 right).
   pure logical function ends_with_body(model, node, side)
      type(contact_model_type), intent(in) :: model
      integer, intent(in) :: node, side
      real(wp), parameter :: near = 1.0e-6_wp
      real(wp) :: half

      half = 0.5_wp*model%interval()
      ends_with_body = model%scene%touchable(model%arc(node) + side*half*(1.0_wp - near)) .and. &
                       .not. model%scene%touchable(model%arc(node) + side*half*(1.0_wp + near))
   end function ends_with_body

   !> See mfv_archive.
   subroutine carry(self, archive)
      class(zone_edges_type), intent(inout) :: self
      type(archive_type), intent(inout) :: archive

      call archive%carry(self%contact)
      call archive%carry(self%stick)
      call archive%carry(self%contact_left)
      call archive%carry(self%contact_right)
      call archive%carry(self%contact_length)
      call archive%carry(self%stick_left)
      call archive%carry(self%stick_right)
      call archive%carry(self%stick_length)
   end subroutine carry

end module mfv_zone_edges
