!> What fretting fatigue reads off at contact edges: the intensities of the tractions, the slip zones and what the asymptotes say
!> of them.
!>
!> With K_T the change of the shear since the last turning point of the loads, if nothing slipped, dK_N that of the pressure (both
!> as 1/sqrt(s)), and q = phi mu p the shear there before in the direction of K_T, a slip zone next to the edge has the width
!> d = 2 (|K_T| - mu dK_N)/((1 - phi) mu K_N) from the edge before, which moves outwards by 2 dK_N/K_N. First loading: phi = 0;
!> reversal of a slip: phi = -1 (docs/theory.md, intensities at edges).
module mfv_edge_fields
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan, ieee_quiet_nan, ieee_value
   use mfv_compliance, only: block_up, block_wt
   use mfv_contact_fields, only: contact_fields_type
   use mfv_contact_model, only: contact_model_type
   use mfv_contact_state, only: contact_state_type
   use mfv_contact_system, only: constraints_type, contact_system_type, load_type, response_type
   use mfv_edge_intensity, only: find_root_intensity, samples, singular_intensities
   use mfv_kinds, only: wp
   use mfv_motions, only: control_displacement, control_force, motion_approach, motion_count, motion_rotation, motions
   use mfv_node_status, only: holds, in_contact, node_open, node_stick
   use mfv_tolerances, only: significant
   use mfv_zone_edges, only: is_beyond_corner, patch_type
   implicit none
   private
   public :: edge_field_type, edge_fields_of, edge_quantities, is_in_cycles, most_patches, undefined_edge

   !> A contact edge. NaN where something is not defined.
   type :: edge_field_type
      !> Exponent of the distance from the edge in the pressure: 1/2; -1/2 at a corner; others with full coupling and slip.
      real(wp) :: exponent = 0.0_wp
      !> K_N, force/length^(5/2); of the pressure at a corner, force/length^(3/2); K_T, the change of the shear since the last
      !> turning point if nothing slipped, force/length^(3/2).
      real(wp) :: normal = 0.0_wp, corner = 0.0_wp, shear = 0.0_wp
      !> Width of the slip zone next to the edge, from the stick zone and by the asymptotes; distance at which the pressure differs
      !> from its asymptote by a tenth; lengths.
      real(wp) :: slip_zone = 0.0_wp, asymptotic_slip_zone = 0.0_wp, reach = 0.0_wp
   contains
      procedure :: values => values_of_edge
   end type edge_field_type

   !> Names of the observables of an edge after its side, in the order of its values.
   character(*), parameter :: edge_quantities(7) = [character(21) :: 'normal_intensity', 'shear_intensity', 'slip_zone', &
                                                          'asymptotic_slip_zone', 'edge_reach', 'edge_exponent', 'corner_intensity']
   !> Whether cycles have them too, at their turning points: not what says how far the asymptotes hold.
   logical, parameter :: is_in_cycles(size(edge_quantities)) = [.true., .true., .true., .false., .false., .false., .true.]

   !> Most contact patches of which intensities are found.
   integer, parameter :: most_patches = 20
   integer, parameter :: sides(2) = [-1, 1]

contains

   !> The values of an edge, in the order of edge_quantities.
   pure function values_of_edge(self) result(values)
      class(edge_field_type), intent(in) :: self
      real(wp) :: values(size(edge_quantities))

      values = [self%normal, self%shear, self%slip_zone, self%asymptotic_slip_zone, self%reach, self%exponent, self%corner]
   end function values_of_edge

   !> An edge of which nothing is known.
   type(edge_field_type) function undefined_edge() result(edge)
      real(wp) :: none

      none = ieee_value(1.0_wp, ieee_quiet_nan)
      edge = edge_field_type(none, none, none, none, none, none, none)
   end function undefined_edge

   !> The left and right edge of every patch of a state, shape (2, patches). `system`: a solver of its model; `load`: controls
   !> of the loads; `before`: the state at their last turning point, if there is one.
   function edge_fields_of(model, system, state, load, patches, before) result(edges)
      type(contact_model_type), intent(in) :: model
      class(contact_system_type), intent(in) :: system
      type(contact_state_type), intent(in) :: state
      type(load_type), intent(in) :: load(motion_count)
      type(patch_type), intent(in) :: patches(:)
      type(contact_state_type), intent(in), optional :: before
      type(edge_field_type) :: edges(2, size(patches))
      type(response_type) :: response
      logical :: known, turns
      integer :: i, j

      edges = undefined_edge()
      if (size(patches) > most_patches .or. size(patches) == 0) return
      turns = model%moves(motion_rotation) .and. load(motion_rotation)%control == control_force
      known = present(before)
      if (known) call find_change_if_stuck(model, system, state, load, before, response, known)
      do i = 1, size(patches)
         if (model%tangential) edges(:, i)%slip_zone = slip_zones_of(patches(i))
         do j = 1, size(sides)
            call find_root_intensity(model, state, patches(i), sides(j), edges(j, i)%normal, edges(j, i)%reach)
         end do
         call add_exponents(model, state, patches(i), turns, edges(:, i))
         if (known) call add_shear(model, before, response, patches(i), turns, edges(:, i))
         ! No edges: the surfaces repeat.
         if (i == 1 .and. any(patches%to_first > 0.0_wp)) edges(1, i) = undefined_edge()
         if (patches(i)%to_first > 0.0_wp) edges(2, i) = undefined_edge()
      end do
   end function edge_fields_of

   !> Widths of the slip zones next to the left and right edge of a patch, lengths; NaN if no node of it sticks.
   pure function slip_zones_of(patch) result(widths)
      type(patch_type), intent(in) :: patch
      real(wp) :: widths(2)

      widths = ieee_value(1.0_wp, ieee_quiet_nan)
      associate (zones => patch%stick)
         if (size(zones) > 0) widths = [zones(1)%left - patch%left, patch%right - zones(size(zones))%right]
      end associate
   end function slip_zones_of

   !> Exponents of the pressure at the edges of a patch, and its intensities at corners. Of different bodies of which a node beside
   !> the edge sticks these are not known: at a corner the pressure oscillates, and elsewhere the slip zone is too narrow for the
   !> mesh. `turns`: whether the moment is prescribed.
   subroutine add_exponents(model, state, patch, turns, edges)
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: state
      type(patch_type), intent(in) :: patch
      logical, intent(in) :: turns
      type(edge_field_type), intent(inout) :: edges(2)
      logical :: ends(2), unknown(2)
      real(wp) :: powers(2)

      ends = [patch%left_ends, patch%right_ends]
      powers = [patch%left_power, patch%right_power]
      edges%exponent = merge(powers - 1.0_wp, powers, ends)
      if (any(ends)) edges%corner = singular_intensities(model, state%fields%pressure, patch, powers, ends, turns)
      where (.not. ends) edges%corner = ieee_value(1.0_wp, ieee_quiet_nan)
      ! Other surfaces that end there are cut off.
      unknown = ends .and. .not. [is_corner(model, patch%first, -1), is_corner(model, patch%last, 1)]
      if (model%couples(block_wt)) then
         associate (last => min(patch%first + samples, patch%last), first => max(patch%last - samples, patch%first))
            unknown = unknown .or. [any(holds(state%status(patch%first:last))), any(holds(state%status(first:patch%last)))]
         end associate
      end if
      where (unknown)
         edges%exponent = ieee_value(1.0_wp, ieee_quiet_nan)
         edges%corner = edges%exponent
         edges%normal = edges%exponent
         edges%reach = edges%exponent
      end where
   end subroutine add_exponents

   !> Whether a sharp punch ends beyond a node on a side.
   logical function is_corner(model, node, side)
      type(contact_model_type), intent(in) :: model
      integer, intent(in) :: node, side

      is_corner = is_beyond_corner(model, model%arc(node) + side*model%width(node))
   end function is_corner

   !> Intensities of the changes at the edges of a patch, and the slip zones that follow. `before`: the state at the last turning
   !> point; `response`: the change since then; `turns`: as above.
   subroutine add_shear(model, before, response, patch, turns, edges)
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: before
      type(response_type), intent(in) :: response
      type(patch_type), intent(in) :: patch
      logical, intent(in) :: turns
      type(edge_field_type), intent(inout) :: edges(2)
      real(wp), parameter :: powers(2) = 0.5_wp
      logical, parameter :: both(2) = .true.
      real(wp) :: pressure(2)
      integer :: i

      if (.not. any(in_contact(before%status(patch%first:patch%last)))) return
      edges%shear = singular_intensities(model, response%rate%shear, patch, powers, both, .false.)
      if (.not. model%scene%friction%is_coulomb()) return
      pressure = singular_intensities(model, response%rate%pressure, patch, powers, both, turns)
      do i = 1, size(sides)
         edges(i)%asymptotic_slip_zone = asymptotic_slip_zone(model, before, patch, sides(i), edges(i), pressure(i))
      end do
   end subroutine add_shear

   !> Width of the slip zone at an edge by the asymptotes, length; `pressure`: dK_N. NaN at corners, where nothing sticks now, where
   !> the shear before is no constant part of its limit over the zone, or is nearly at it in this direction, where an unloading
   !> alone makes it slip, and beyond half the patch.
   real(wp) function asymptotic_slip_zone(model, before, patch, side, edge, pressure) result(width)
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: before
      type(patch_type), intent(in) :: patch
      integer, intent(in) :: side
      type(edge_field_type), intent(in) :: edge
      real(wp), intent(in) :: pressure
      !> The outer part of the zone in which the shear before must be a constant part of its limit.
      real(wp), parameter :: nearly_at_limit = 0.95_wp, constant = 0.1_wp, inner = 0.9_wp
      integer, parameter :: rounds = 3
      real(wp) :: friction, ratio, found
      integer :: node, last, i
      real(wp), allocatable :: limit(:), shear(:)

      width = ieee_value(1.0_wp, ieee_quiet_nan)
      node = patch%first - 1 + findloc(in_contact(before%status(patch%first:patch%last)), .true., dim=1, back=side > 0)
      friction = model%kinetic_friction(node)
      if (ieee_is_nan(edge%normal) .or. ieee_is_nan(edge%shear) .or. .not. friction > 0.0_wp .or. size(patch%stick) == 0) return
      if (pressure < 0.0_wp .and. abs(edge%shear) < friction*abs(pressure)) return
      last = node
      do i = 1, rounds
         limit = friction*before%fields%pressure(node:last:-side)
         shear = sign(1.0_wp, edge%shear)*before%fields%shear(node:last:-side)
         ratio = max(sum(shear)/max(sum(limit), tiny(1.0_wp)), -1.0_wp)
         if (ratio > nearly_at_limit) return
         found = max(2.0_wp*(abs(edge%shear) - friction*pressure)/((1.0_wp - ratio)*friction*edge%normal), 0.0_wp)
         ! From the present edge.
         if (found > 0.0_wp) found = max(found + 2.0_wp*pressure/edge%normal, 0.0_wp)
         last = node
         do
            if (last - side < patch%first .or. last - side > patch%last) exit
            if (abs(model%arc(last - side) - merge(patch%right, patch%left, side > 0)) > inner*found) exit
            last = last - side
         end do
      end do
      if (maxval(abs(shear - ratio*limit)) > constant*maxval(limit)) return
      if (found <= 0.5_wp*patch%length()) width = found
   end function asymptotic_slip_zone

   !> The change of the tractions since the last turning point of the loads, as rates of `response`, if all nodes that are now in
   !> contact had been so and stuck; `before`: the state there. Not `known` without friction or contact, before the first turning
   !> point, and where the tractions oscillate next to an edge (bodies of different materials with full coupling, or with Goodman's
   !> where the normal force changes); nor while the bodies roll.
   subroutine find_change_if_stuck(model, solver, state, load, before, response, known)
      type(contact_model_type), intent(in) :: model
      class(contact_system_type), intent(in) :: solver
      type(contact_state_type), intent(in) :: state, before
      type(load_type), intent(in) :: load(motion_count)
      type(response_type), intent(out) :: response
      logical, intent(out) :: known
      class(contact_system_type), allocatable :: system
      type(constraints_type) :: constraints
      logical :: singular

      known = model%tangential .and. .not. model%couples(block_wt) .and. .not. (model%moves(motion_rotation) .and. model%rolls())
      if (.not. known) return
      constraints%load = changes_of_loads(model, state%fields, before%fields, load)
      if (model%couples(block_up)) &
         known = .not. abs(constraints%load(motion_approach)%rate) > significant*abs(state%fields%force(motion_approach))
      if (.not. known) return
      constraints%status = merge(node_stick, node_open, in_contact(state%status))
      constraints%stuck_slip = state%stuck_slip
      allocate (constraints%row(model%nodes()), constraints%offset_rate(model%nodes()))
      constraints%offset_rate = 0.0_wp
      constraints%rates_only = .true.
      allocate (system, source=solver)
      call system%solve(model, constraints, state%fields, response, singular)
      known = .not. singular
   end subroutine find_change_if_stuck

   !> Changes of the loads since the fields `before`: of forces, and of a rotation and of bulk stresses that are prescribed.
   function changes_of_loads(model, now, before, controls) result(load)
      type(contact_model_type), intent(in) :: model
      type(contact_fields_type), intent(in) :: now, before
      type(load_type), intent(in) :: controls(motion_count)
      type(load_type) :: load(motion_count)
      integer :: i

      do i = 1, motion_count
         if (motions(i)%is_known .or. .not. model%moves(i) .or. &
             (i == motion_rotation .and. controls(i)%control == control_displacement)) then
            load(i) = load_type(control_displacement, now%motion(i), now%motion(i) - before%motion(i))
         else
            load(i) = load_type(control_force, now%force(i), now%force(i) - before%force(i))
         end if
      end do
   end function changes_of_loads

end module mfv_edge_fields
