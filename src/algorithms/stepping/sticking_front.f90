!> The slip at which nodes hold that have stuck within a large increment.
!>
!> While a stick zone grows, each of its new nodes holds at the slip S(x) that it had when the edge of the zone passed. E is the
!> first node beyond the zone; next to the edge c the slip differs from S by (x - c)^(5/2) only, so that S(E) is about the slip of E
!> at the end. Near the edge c0 at the start, the slip since the start is the integral of (x - c)^(3/2) over the way of c: S - s0
!> grows as (x - c0)^(5/2), s0 the slip at the start, even if the edge rests before it moves (then with a part in (x - c0)^(3/2)).
!> So it is taken where the zone grows within the nearer part of what slipped at the start. Beyond that S is the cubic through E and
!> three nodes that have held: the outermost one, and two at equal distances further in, as far as E is further out. A contact that
!> begins within the increment grows in proportion to its shape (exactly so for a power of x, under loads that grow in proportion):
!> there S follows the undeformed gap. If it has begun in an increment before and still does, S is that cubic everywhere, with held
!> nodes on one side of where contact began.
!>
!> S depends on the slip of E, an unknown of the same increment: slip(E) = s + sum of r theta over the slips theta that are assumed
!> for the outer nodes, r the responses to unit slips. The fronts to the left and to the right of all stick zones are two groups,
!> whose responses are solved for; the two fronts of a zone follow from a system of two equations. This is exact for one zone; the
!> effects of other zones are iterated.
module mfv_sticking_front
   use mfv_contact_fields, only: contact_fields_type
   use mfv_contact_system, only: front_type
   use mfv_kinds, only: wp
   use mfv_node_status
   use mfv_zone_edges, only: zone_type, zones_of
   implicit none
   private
   public :: fronts_type, find_fronts, left, right

   !> Groups of fronts.
   integer, parameter :: left = 1, right = 2

   !> The fronts of all stick zones.
   type :: fronts_type
      !> The first node beyond the fronts of each zone, 0 for none, shape (2, zones); and the slip that is assumed for it, length.
      integer, allocatable :: outer(:, :)
      real(wp), allocatable :: slip(:, :)
      !> For each node its zone, 0 for none, and its group, shape (nodes).
      integer, allocatable :: zone(:), group(:)
      !> The node holds at base + weight*slip; length; shape (nodes).
      real(wp), allocatable :: base(:), weight(:)
   contains
      procedure :: number
      procedure :: set_hold
      procedure :: of_nodes
      procedure :: group_weight
      procedure :: assume
      procedure :: correct
   end type fronts_type

contains

   !> The fronts for statuses at the end of an increment, shape (nodes). `held`: nodes that hold from its start, at the slip `hold`
   !> (length); `start`: the fields there; `open`: nodes that were open there; `gap`: the gaps there or, if
   !> `in_proportion`, before deformation, length; `ahead`: how far nodes slip after the end of the increment until they stick,
   !> length; all shape (nodes). `in_proportion`: whether zones have grown in proportion to their size, since the contact began.
   subroutine find_fronts(status, held, open, hold, start, gap, ahead, in_proportion, fronts)
      integer, intent(in) :: status(:)
      logical, intent(in) :: held(:), open (:)
      real(wp), intent(in) :: hold(:), gap(:), ahead(:)
      logical, intent(in) :: in_proportion
      type(contact_fields_type), intent(in) :: start
      type(fronts_type), intent(out) :: fronts
      type(zone_type), allocatable :: zones(:)
      integer :: first, last, zone, n

      n = size(status)
      zones = zones_of(status == node_stick)
      allocate (fronts%outer(2, size(zones)), source=0)
      allocate (fronts%slip(2, size(zones)), source=0.0_wp)
      allocate (fronts%zone(n), fronts%group(n), source=0)
      allocate (fronts%base(n), fronts%weight(n), source=0.0_wp)
      do zone = 1, size(zones)
         first = zones(zone)%first
         last = zones(zone)%last
         if (any(held(first:last))) then
            call grown_zone
         else if (all(open (first:last))) then
            call new_zone
         end if
      end do
      do first = 1, n
         if (fronts%zone(first) > 0) fronts%base(first) = fronts%base(first) + fronts%weight(first) &
                                                          *ahead(fronts%outer(fronts%group(first), fronts%zone(first)))
      end do

   contains

      !> A zone that has grown from nodes that have held.
      subroutine grown_zone
         integer :: inner(2), reach

         inner = [findloc(held(first:last), .true., dim=1), findloc(held(first:last), .true., dim=1, back=.true.)] + first - 1
         reach = inner(2) - inner(1)
         if (reach == 0) return
         if (inner(1) > first .and. first > 1) call add_front(left, first, inner(1) - 1, inner(1), first - 1, reach)
         if (inner(2) < last .and. last < n) call add_front(right, inner(2) + 1, last, inner(2), last + 1, reach)
      end subroutine grown_zone

      !> A front of the nodes `from` to `to`, between the outermost held node `near` and the node `outer` beyond the zone. `reach`:
      !> from the first to the last held node. Near the edge the slip since the start is a power of the distance, further away S is
      !> a cubic; in between it is a mean of both, so that statuses do not alternate.
      subroutine add_front(group, from, to, near, outer, reach)
         integer, intent(in) :: group, from, to, near, outer, reach
         !> The parts of the slip zone up to which a zone grows by the power, and from which by the cubic.
         real(wp), parameter :: near_edge = 0.25_wp, far = 0.75_wp
         real(wp), dimension(from:to) :: base, weight, by_power
         real(wp) :: power, slip(size(gap))
         integer :: outwards, width, step, inner, first, last, i

         outwards = sign(1, outer - near)
         width = 0
         do while (near + (width + 1)*outwards > 1 .and. near + (width + 1)*outwards < n)
            if (open (near + (width + 1)*outwards)) exit
            width = width + 1
         end do
         power = min(max((far*width - abs(outer - near))/((far - near_edge)*max(width, 1)), 0.0_wp), 1.0_wp)
         if (in_proportion) power = 0.0_wp
         slip = start%slip()
         inner = reach
         if (in_proportion) then
            ! On one side of where contact began.
            first = min(near, near - outwards*reach)
            last = first - 1 + minloc(gap(first:first + reach), dim=1, back=.true.)
            first = first - 1 + minloc(gap(first:first + reach), dim=1)
            inner = min(reach, abs(2*near - first - last))
         end if
         step = min(abs(outer - near), max((inner - inner/2)/2, 1))
         call interpolate(from, to, outer, near - outwards*step*[(i, i=0, min(2, reach/step))], base, weight)
         by_power = powers(from, to, near + 0.5_wp*outwards, outer)
         call add_nodes(group, from, to, outer)
         fronts%weight(from:to) = (1.0_wp - power)*weight + power*by_power
         fronts%base(from:to) = (1.0_wp - power)*base + power*(slip(from:to) - by_power*slip(outer))
      end subroutine add_front

      !> The power 5/2 of the distances of the nodes `from` to `to` from the `edge` of the held nodes, over that of `outer`.
      pure function powers(from, to, edge, outer)
         integer, intent(in) :: from, to, outer
         real(wp), intent(in) :: edge
         real(wp) :: powers(from:to)
         integer :: i

         powers = [((real(i, wp) - edge)/(outer - edge), i=from, to)]
         powers = powers**2*sqrt(powers)
      end function powers

      !> The slip base + weight*slip(outer) of the nodes `from` to `to` by the polynomial through `outer` and `held` nodes.
      pure subroutine interpolate(from, to, outer, nodes, base, weight)
         integer, intent(in) :: from, to, outer, nodes(:)
         real(wp), intent(out) :: base(from:to), weight(from:to)
         integer :: i, j

         base = 0.0_wp
         do i = from, to
            weight(i) = product(real(i - nodes, wp)/real(outer - nodes, wp))
            do j = 1, size(nodes)
               associate (others => pack(nodes, nodes /= nodes(j)))
                  base(i) = base(i) + hold(nodes(j))*real(i - outer, wp)/real(nodes(j) - outer, wp) &
                            *product(real(i - others, wp)/real(nodes(j) - others, wp))
               end associate
            end do
         end do
      end subroutine interpolate

      !> A front of the nodes `from` to `to`, and the node beyond it.
      subroutine add_nodes(group, from, to, outer)
         integer, intent(in) :: group, from, to, outer

         fronts%outer(group, zone) = outer
         fronts%zone(from:to) = zone
         fronts%group(from:to) = group
      end subroutine add_nodes

      !> A zone of nodes that were open: both fronts from the node that was nearest, which belongs to either of them.
      subroutine new_zone
         integer :: middle, from

         middle = first - 1 + minloc(gap(first:last), dim=1)
         if (first == 1 .or. last == n) return
         call add_scaled(left, first, middle, first - 1, middle)
         from = merge(middle + 1, middle, fronts%zone(middle) > 0)
         if (from <= last) call add_scaled(right, from, last, last + 1, middle)
      end subroutine new_zone

      !> A front whose slip since the start is in proportion to the gap there, above that of the node `middle`.
      subroutine add_scaled(group, from, to, outer, middle)
         integer, intent(in) :: group, from, to, outer, middle
         real(wp) :: slip(size(gap))

         if (.not. gap(outer) > gap(middle)) return
         call add_nodes(group, from, to, outer)
         slip = start%slip()
         fronts%weight(from:to) = (gap(from:to) - gap(middle))/(gap(outer) - gap(middle))
         fronts%base(from:to) = slip(from:to) - fronts%weight(from:to)*slip(outer)
      end subroutine add_scaled
   end subroutine find_fronts

   !> Number of fronts of a group.
   pure integer function number(self, group)
      class(fronts_type), intent(in) :: self
      integer, intent(in) :: group

      number = count(self%outer(group, :) > 0)
   end function number

   !> Set the slip at which the nodes of fronts hold, length, shape (nodes); that of others is unchanged.
   pure subroutine set_hold(self, hold)
      class(fronts_type), intent(in) :: self
      real(wp), intent(inout) :: hold(:)
      integer :: i

      do i = 1, size(hold)
         if (self%zone(i) > 0) hold(i) = self%base(i) + self%weight(i)*self%slip(self%group(i), self%zone(i))
      end do
   end subroutine set_hold

   !> What the slip of all nodes depends on, shape (nodes).
   pure function of_nodes(self) result(front)
      class(fronts_type), intent(in) :: self
      type(front_type) :: front(size(self%zone))
      integer :: i

      do i = 1, size(front)
         if (self%zone(i) > 0) front(i) = front_type(self%outer(self%group(i), self%zone(i)), self%weight(i), &
                                                     self%slip(self%group(i), self%zone(i)))
      end do
   end function of_nodes

   !> The change of the slip of all nodes with that of the outer nodes of a group, shape (nodes).
   pure function group_weight(self, group) result(weight)
      class(fronts_type), intent(in) :: self
      integer, intent(in) :: group
      real(wp) :: weight(size(self%weight))

      weight = merge(self%weight, 0.0_wp, self%group == group)
   end function group_weight

   !> Assume the slip of `fields` for the outer nodes.
   pure subroutine assume(self, fields)
      class(fronts_type), intent(inout) :: self
      type(contact_fields_type), intent(in) :: fields
      real(wp) :: slip(size(self%zone))
      integer :: group, zone

      slip = fields%slip()
      do zone = 1, size(self%outer, 2)
         do group = left, right
            if (self%outer(group, zone) > 0) self%slip(group, zone) = slip(self%outer(group, zone))
         end do
      end do
   end subroutine assume

   !> Correct the assumed slips. `fields`: the fields that follow from them; `response`: their changes with the slip of the outer
   !> nodes of each group, shape (2). `change`: the corrections, length, shape (2, zones).
   pure subroutine correct(self, fields, response, change)
      class(fronts_type), intent(inout) :: self
      type(contact_fields_type), intent(in) :: fields, response(2)
      real(wp), allocatable, intent(out) :: change(:, :)
      real(wp) :: slip(size(self%zone)), responses(size(self%zone), 2), matrix(2, 2), wrong(2), determinant
      integer :: group, zone, other

      allocate (change, mold=self%slip)
      slip = fields%slip()
      do group = left, right
         responses(:, group) = 0.0_wp
         if (self%number(group) > 0) responses(:, group) = response(group)%slip()
      end do
      do zone = 1, size(self%outer, 2)
         wrong = 0.0_wp
         matrix = reshape([1.0_wp, 0.0_wp, 0.0_wp, 1.0_wp], [2, 2])
         do group = left, right
            if (self%outer(group, zone) == 0) cycle
            wrong(group) = slip(self%outer(group, zone)) - self%slip(group, zone)
            do other = left, right
               if (self%outer(other, zone) > 0) &
                  matrix(group, other) = matrix(group, other) - responses(self%outer(group, zone), other)
            end do
         end do
         determinant = matrix(1, 1)*matrix(2, 2) - matrix(1, 2)*matrix(2, 1)
         change(:, zone) = 0.0_wp
         if (.not. abs(determinant) > 0.0_wp) cycle
         change(left, zone) = (matrix(2, 2)*wrong(1) - matrix(1, 2)*wrong(2))/determinant
         change(right, zone) = (matrix(1, 1)*wrong(2) - matrix(2, 1)*wrong(1))/determinant
      end do
      self%slip = self%slip + change
   end subroutine correct

end module mfv_sticking_front
