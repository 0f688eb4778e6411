!> Interior of a body in a contact state, with edges between the nodes.
module mfv_state_interior
   use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
   use mfv_contact_model, only: contact_model_type
   use mfv_contact_state, only: contact_state_type
   use mfv_corners, only: corner_type, corners_of, is_stretched_at
   use mfv_interior, only: has_interior, interior_type
   use mfv_kinds, only: wp
   use mfv_motions, only: bulk_motions
   use mfv_stress_search, only: largest_tension, largest_type, largest_von_mises
   use mfv_tolerances, only: certified
   use mfv_zone_edges, only: find_patches, find_zones_below_limit, nodes_across, patch_type, zone_type
   implicit none
   private
   public :: state_interior, find_edges_at_nodes, find_largest_tension, find_largest_von_mises, surface_stress_at

contains

   !> The lower or `upper` body under the tractions and the bulk stress of a state; `available`: false for a rigid body and a
   !> matrix. `fewest_elements`: see mfv_surface_tractions.
   subroutine state_interior(model, state, upper, interior, available, fewest_elements)
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: state
      logical, intent(in) :: upper
      type(interior_type), intent(out) :: interior
      logical, intent(out) :: available
      integer, intent(in), optional :: fewest_elements
      real(wp), dimension(model%nodes()) :: contact_edge, stick_edge
      type(corner_type), allocatable :: corners(:)
      integer :: i

      available = has_interior(model%scene%lower)
      if (upper) available = has_interior(model%scene%upper)
      if (.not. available) return
      call find_edges_at_nodes(model, state, contact_edge, stick_edge)
      call model%scene%interior(upper, model%arc, model%width, state%fields%pressure, state%fields%shear, contact_edge, &
                                stick_edge, state%fields%motion(bulk_motions(merge(2, 1, upper))), interior, &
                                available, fewest_elements)
      corners = corners_of(model, state)
      allocate (interior%unresolved(2, size(corners)))
      do i = 1, size(corners)
         interior%unresolved(:, i) = corners(i)%place + corners(i)%reach*[-1.0_wp, 1.0_wp]
         interior%elements%singular = interior%elements%singular .or. is_stretched_at(model, state, corners(i), upper)
      end do
   end subroutine state_interior

   !> The largest tension along the surface of a body in a state; `available`: see state_interior.
   subroutine find_largest_tension(model, state, upper, largest, available)
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: state
      logical, intent(in) :: upper
      type(largest_type), intent(out) :: largest
      logical, intent(out) :: available
      type(interior_type) :: interior
      logical :: stretches

      ! Pressure only compresses most straight surfaces.
      stretches = model%scene%lower%elasticity%pressure_stretches()
      if (upper) stretches = model%scene%upper%elasticity%pressure_stretches()
      available = model%scene%can_have_bulk_stress(upper) .and. .not. stretches .and. &
                  .not. maxval(abs(state%fields%shear)) > certified*maxval(state%fields%pressure)
      if (available) then
         largest%value = max(state%fields%motion(bulk_motions(merge(2, 1, upper))), 0.0_wp)
         largest%x = ieee_value(1.0_wp, ieee_quiet_nan)
         largest%y = largest%x
         return
      end if
      call state_interior(model, state, upper, interior, available)
      if (available) largest = largest_tension(interior)
   end subroutine find_largest_tension

   !> Stress along the surface of a body at x in a state, force/length^2; NaN without stresses, and beyond a circle.
   real(wp) function surface_stress_at(model, state, upper, x) result(stress)
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: state
      logical, intent(in) :: upper
      real(wp), intent(in) :: x
      type(interior_type) :: interior
      logical :: available

      stress = ieee_value(1.0_wp, ieee_quiet_nan)
      call state_interior(model, state, upper, interior, available)
      if (.not. available) return
      associate (body => interior%body)
         if (.not. body%deforms_as_circle()) then
            stress = interior%surface_stress(x)
         else if (abs(x) <= body%radius) then
            stress = interior%surface_stress(body%radius*asin(x/body%radius))
         end if
      end associate
   end function surface_stress_at

   !> The largest von Mises stress in a body in a state; `available`: see state_interior.
   subroutine find_largest_von_mises(model, state, upper, largest, available)
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: state
      logical, intent(in) :: upper
      type(largest_type), intent(out) :: largest
      logical, intent(out) :: available
      type(interior_type) :: interior

      ! The value is flat at its maximum: few elements suffice.
      call state_interior(model, state, upper, interior, available, fewest_elements=60)
      if (.not. available) return
      call interior%prepare()
      largest = largest_von_mises(interior)
   end subroutine find_largest_von_mises

   !> Edges of contact and stick zones, arc lengths from the origin of x, at the first and last node of each zone; NaN
   !> elsewhere; shape (nodes). A zone of one node has the width of its interval. Stick zones only with a sharp friction
   !> limit, and without nodes at it.
   subroutine find_edges_at_nodes(model, state, contact_edge, stick_edge)
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: state
      real(wp), intent(out) :: contact_edge(:), stick_edge(:)
      type(patch_type), allocatable :: patches(:)
      type(zone_type), allocatable :: zones(:)
      integer :: i, j

      contact_edge = ieee_value(1.0_wp, ieee_quiet_nan)
      stick_edge = contact_edge
      call find_patches(model, state, patches)
      do i = 1, size(patches)
         associate (patch => patches(i))
            call store(contact_edge, patch%first, patch%last, patch%left, patch%right)
            if (.not. model%scene%friction%is_coulomb()) cycle
            call find_zones_below_limit(model, state, patch, zones)
            do j = 1, size(zones)
               associate (zone => zones(j))
                  call store(stick_edge, zone%first, zone%last, zone%left, zone%right)
               end associate
            end do
         end associate
      end do

   contains

      !> Both edges of a zone; of one with a single node that which is not where it continues at the other end of the mesh.
      subroutine store(edges, first, last, left, right)
         real(wp), intent(inout) :: edges(:)
         integer, intent(in) :: first, last
         real(wp), intent(in) :: left, right

         if (last > first) then
            edges([first, last]) = [left, right]
         else if (nodes_across(model, state, first, -1) > 0) then
            edges(first) = right
         else if (nodes_across(model, state, first, 1) > 0) then
            edges(first) = left
         end if
      end subroutine store
   end subroutine find_edges_at_nodes

end module mfv_state_interior
