!> Convex corners of the undeformed surfaces in contact, such as the tip of a wedge, where the pressure has no limit.
!>
!> Where the slope of the surfaces jumps by J the pressure is -(m J/pi) ln|x| and smooth terms, m = 1/A of mfv_near_field (wedge:
!> Johnson 1985, section 5.2), or 1/(A + M f) where oblique surfaces slip with tau = f p. The stress along the surface is c p - a
!> tau + b T - d N, N and T the integrals of p/(t - x) dt/pi and tau/(t - x) dt/pi (surface_stress_of in mfv_interior_half_plane).
!> Two equations have bounded right sides: A N + M T + B tau is the slope of the gap and, where the surfaces stick, At T + M N - B
!> p the difference e of the strains. With tau = r p next to the corner N = -B (r At + M) p/D and T = B (A + M r) p/D, D = A At -
!> M^2, where they stick; N = -B f p/(A + M f), T = f N where they slip. An isotropic surface, pressed only (r = 0), is compressed
!> by 1 - 2 beta or 1 + 2 beta f^2 times p, without limit; others, such as auxetic ones that stick, can be stretched.
module mfv_corners
   use mfv_compliance, only: block_up, block_wt
   use mfv_contact_model, only: contact_model_type
   use mfv_contact_state, only: contact_state_type
   use mfv_interior_half_plane, only: surface_stress_of
   use mfv_kinds, only: pi, wp
   use mfv_material, only: material_type
   use mfv_near_field, only: near_field_type
   use mfv_node_status, only: holds, in_contact
   use mfv_tolerances, only: significant
   implicit none
   private
   public :: corner_type, find_corner, corners_of, is_stretched_at

   !> A corner at the arc length `place` from the origin of x, near a node, and the distance within which tractions between the
   !> nodes are not resolved; lengths.
   type :: corner_type
      integer :: node = 0
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
      corner%node = node
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

   !> Whether the stress along the surface of the lower or `upper` body at a corner is a tension without limit.
   logical function is_stretched_at(model, state, corner, upper)
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: state
      type(corner_type), intent(in) :: corner
      logical, intent(in) :: upper
      type(near_field_type) :: pair
      type(material_type) :: material
      real(wp) :: ratio, of_pressure, of_shear

      pair = model%scene%near_field()
      material = model%scene%lower%elasticity%material
      ratio = state%fields%shear(corner%node)/state%fields%pressure(corner%node)
      if (upper) then
         pair = pair%with_reversed_shear()
         material = model%scene%upper%elasticity%material
         ratio = -ratio
      end if
      if (.not. model%compliance%elastic_block(block_up)) pair = near_field_type(pair%normal, pair%tangential)
      associate (a => pair%normal, at => pair%tangential, b => pair%coupling, m => pair%mixed)
         of_pressure = 0.0_wp
         of_shear = 0.0_wp
         if (.not. holds(state%status(corner%node))) then
            if (model%compliance%elastic_block(block_wt)) of_pressure = -pair%edge_product(ratio)
            of_shear = ratio*of_pressure
         else if (model%compliance%elastic_block(block_wt)) then
            of_pressure = -b*(ratio*at + m)/(a*at - m**2)
            of_shear = b*(a + m*ratio)/(a*at - m**2)
         else
            of_shear = b/at
         end if
      end associate
      is_stretched_at = surface_stress_of(material, 1.0_wp, ratio, of_pressure, of_shear) > significant
   end function is_stretched_at

end module mfv_corners
