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
!> S depends on the slip of E, an unknown of the same increment: it is in the rows of the nodes that hold at S (front_type).
module mfv_sticking_front
   use mfv_contact_fields, only: contact_fields_type
   use mfv_contact_system, only: front_type
   use mfv_kinds, only: wp
   use mfv_node_status
   use mfv_zone_edges, only: zone_type, zones_of
   implicit none
   private
   public :: find_fronts

contains

   !> The fronts for statuses at the end of an increment. `held`: nodes that hold from its start; `open`: nodes that were open then;
   !> `start`: the fields there; `gap`: the gaps there or, if `in_proportion`, before deformation, length; `ahead`: how far nodes
   !> slip after the end of the increment until they stick, length; `hold`: the slip at which nodes hold, length; at a front it
   !> becomes what is added to the part in proportion to the slip of another node (front_type); all shape (nodes).
   !> `in_proportion`: whether zones have grown in proportion to their size, since the contact began.
   subroutine find_fronts(status, held, open, start, gap, ahead, in_proportion, hold, front)
      integer, intent(in) :: status(:)
      logical, intent(in) :: held(:), open (:)
      real(wp), intent(in) :: gap(:), ahead(:)
      logical, intent(in) :: in_proportion
      type(contact_fields_type), intent(in) :: start
      real(wp), intent(inout) :: hold(:)
      type(front_type), intent(out) :: front(:)
      type(zone_type), allocatable :: zones(:)
      integer :: first, last, zone, n

      n = size(status)
      zones = zones_of(status == node_stick)
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
         if (front(first)%node > 0) hold(first) = hold(first) + front(first)%weight*ahead(front(first)%node)
      end do

   contains

      !> A zone that has grown from nodes that have held.
      subroutine grown_zone
         integer :: inner(2), reach

         inner = [findloc(held(first:last), .true., dim=1), findloc(held(first:last), .true., dim=1, back=.true.)] + first - 1
         reach = inner(2) - inner(1)
         if (reach == 0) return
         if (inner(1) > first .and. first > 1) call add_front(first, inner(1) - 1, inner(1), first - 1, reach)
         if (inner(2) < last .and. last < n) call add_front(inner(2) + 1, last, inner(2), last + 1, reach)
      end subroutine grown_zone

      !> A front of the nodes `from` to `to`, between the outermost held node `near` and the node `outer` beyond the zone. `reach`:
      !> from the first to the last held node. Near the edge the slip since the start is a power of the distance, further away S is
      !> a cubic; in between it is a mean of both, so that statuses do not alternate.
      subroutine add_front(from, to, near, outer, reach)
         integer, intent(in) :: from, to, near, outer, reach
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
         front(from:to) = front_type(outer, 0.0_wp)
         front(from:to)%weight = (1.0_wp - power)*weight + power*by_power
         hold(from:to) = (1.0_wp - power)*base + power*(slip(from:to) - by_power*slip(outer))
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

      !> A zone of nodes that were open: both fronts from the node that was nearest, which belongs to either of them.
      subroutine new_zone
         integer :: middle, from

         middle = first - 1 + minloc(gap(first:last), dim=1)
         if (first == 1 .or. last == n) return
         call add_scaled(first, middle, first - 1, middle)
         from = merge(middle + 1, middle, front(middle)%node > 0)
         if (from <= last) call add_scaled(from, last, last + 1, middle)
      end subroutine new_zone

      !> A front whose slip since the start is in proportion to the gap there, above that of the node `middle`.
      subroutine add_scaled(from, to, outer, middle)
         integer, intent(in) :: from, to, outer, middle
         real(wp) :: slip(size(gap))

         if (.not. gap(outer) > gap(middle)) return
         slip = start%slip()
         front(from:to) = front_type(outer, 0.0_wp)
         front(from:to)%weight = (gap(from:to) - gap(middle))/(gap(outer) - gap(middle))
         hold(from:to) = slip(from:to) - front(from:to)%weight*slip(outer)
      end subroutine add_scaled
   end subroutine find_fronts

end module mfv_sticking_front
