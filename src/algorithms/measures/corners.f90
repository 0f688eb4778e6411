!> Convex corners of the undeformed surfaces in contact, such as the tip of a wedge, where the pressure has no limit.
!>
!> Where the slope of the surfaces jumps by J the pressure is -(m J/pi) ln|x| and smooth terms, m = scene%modulus() (wedge: Johnson
!> 1985, section 5.2). The stress along the surface is -p - (2/pi) PV int tau/(x - s) ds. There, for a body with Dundurs' beta (of
!> the other sign for the upper one), it is -(1 - 2 beta) p + m e where the surfaces stick, e the difference of their strains,
!> and -(1 + 2 beta mu^2) p + a bounded term where they slip (docs/theory.md): a surface is compressed without limit, or e is its
!> limit. It would be stretched without limit for beta > 1/2 (an auxetic body) where a corner
!> has not slipped, and for -2 beta mu^2 > 1 where it slips; this is not looked for.
module mfv_corners
   use mfv_contact_model, only: contact_model_type
   use mfv_contact_state, only: contact_state_type
   use mfv_kinds, only: pi, wp
   use mfv_node_status, only: in_contact
   implicit none
   private
   public :: corner_type, find_corner, corners_of

   !> A corner at the arc length `place` from the origin of x, and the distance within which tractions between the nodes are not
   !> resolved; lengths.
   type :: corner_type
      real(wp) :: place = 0.0_wp, reach = 0.0_wp
   end type corner_type

   !> A corner lies within `near` nodes; there is no other curvature within `far` nodes. Nodes to either side that are not resolved.
   integer, parameter :: near = 1, far = 5, unresolved = 4

contains

   !> The corner at a node, `found`: if there is one. Corners nearer to each other than a few intervals stand for a smooth surface,
   !> and so does one with which the pressure grows by less than a hundredth where intervals are halved, by (m J/pi) ln 2.
   pure subroutine find_corner(model, pressure, node, corner, found)
      type(contact_model_type), intent(in) :: model
      real(wp), intent(in) :: pressure(:)
      integer, intent(in) :: node
      type(corner_type), intent(out) :: corner
      logical, intent(out) :: found
      real(wp), parameter :: other = 0.25_wp, least_growth = 0.01_wp
      real(wp) :: slope(-far - 1:far), change(-far:far), span(-far:far), curvature, jump

      found = .false.
      if (node <= far + 1 .or. node >= size(pressure) - far) return
      associate (gap => model%initial_gap(node - far - 1:node + far + 1), arc => model%arc(node - far - 1:node + far + 1))
         slope = (gap(2:) - gap(:2*far + 2))/(arc(2:) - arc(:2*far + 2))
         span = 0.5_wp*(arc(3:) - arc(:2*far + 1))
      end associate
      change = slope(-far:) - slope(:far - 1)
      ! Without the curvature beside it.
      curvature = 0.5_wp*(change(-far)/span(-far) + change(far)/span(far))
      jump = sum(change(-near:near)) - curvature*sum(span(-near:near))
      if (.not. jump > 0.0_wp) return
      if (sum(abs(change(-far:-near - 1))) + sum(abs(change(near + 1:far))) > other*jump) return
      if (.not. model%scene%modulus()*jump/pi*log(2.0_wp) > least_growth*pressure(node)) return
      found = .true.
      corner%place = sum(change(-near:near)*model%arc(node - near:node + near))/sum(change(-near:near))
      corner%reach = max(model%arc(node + unresolved) - corner%place, corner%place - model%arc(node - unresolved))
   end subroutine find_corner

   !> All corners in contact.
   pure function corners_of(model, state) result(corners)
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: state
      type(corner_type), allocatable :: corners(:)
      type(corner_type) :: corner
      logical :: found
      integer :: node

      allocate (corners(0))
      do node = 1, model%nodes()
         if (.not. in_contact(state%status(node))) cycle
         call find_corner(model, state%fields%pressure, node, corner, found)
         if (found) corners = [corners, corner]
      end do
   end function corners_of

end module mfv_corners
