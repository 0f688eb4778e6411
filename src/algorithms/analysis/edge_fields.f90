!> What fretting fatigue reads off at contact edges: the intensities of the tractions, the slip zones and what the asymptotes say
!> of them, and the permanent stick zone of steady cycles.
!>
!> With K_T the change of the shear since the last turning point of the loads, if nothing slipped, dK_N that of the pressure (both
!> as 1/sqrt(s)), and q = phi mu p the shear there before in the direction of K_T, a slip zone next to the edge has the width
!> d = 2 (|K_T| - mu dK_N)/((1 - phi) mu K_N) from the edge before, which moves outwards by 2 dK_N/K_N. First loading: phi = 0;
!> reversal of a slip: phi = -1 (docs/theory.md, intensities at edges).
module mfv_edge_fields
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan, ieee_quiet_nan, ieee_value
   use mfv_closed_form, only: alike
   use mfv_compliance, only: block_up, block_wt
   use mfv_contact_path, only: contact_path_type, new_contact_path, segment_type
   use mfv_contact_state, only: contact_state_type
   use mfv_contact_system, only: constraints_type, contact_system_type, load_type, response_type
   use mfv_cycle, only: cycle_type
   use mfv_edge_intensity, only: find_root_intensity, singular_intensities
   use mfv_error, only: error_type
   use mfv_frictionless, only: apply_directly
   use mfv_kinds, only: wp
   use mfv_motions, only: control_displacement, control_force, motion_approach, motion_count, motion_rotation, motion_shift, motions
   use mfv_node_status, only: holds, in_contact, node_open, node_stick
   use mfv_simulation, only: mark_turn, simulation_type
   use mfv_tolerances, only: certified, significant
   use mfv_zone_edges, only: find_zone_edges, is_beyond_corner, patch_type, zone_edges_type
   implicit none
   private
   public :: edge_field_type, edge_fields_of, edge_quantities, permanent_stick_length, steady_stick_length

   !> A contact edge. NaN where something is not defined.
   type :: edge_field_type
      !> Exponent of the distance from the edge in the pressure: 1/2; -1/2 at a corner; others with full coupling and slip.
      real(wp) :: exponent
      !> K_N, force/length^(5/2); of the pressure at a corner, force/length^(3/2); K_T, the change of the shear since the last
      !> turning point if nothing slipped, force/length^(3/2).
      real(wp) :: normal, corner, shear
      !> Width of the slip zone next to the edge, from the stick zone and by the asymptotes; distance at which the pressure differs
      !> from its asymptote by a tenth; lengths.
      real(wp) :: slip_zone, asymptotic_slip_zone, reach
   contains
      procedure :: values => values_of_edge
   end type edge_field_type

   !> Names of the observables of an edge after its side, in the order of its values.
   character(*), parameter :: edge_quantities(7) = [character(21) :: 'normal_intensity', 'shear_intensity', 'slip_zone', &
                                                          'asymptotic_slip_zone', 'edge_reach', 'edge_exponent', 'corner_intensity']

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

   !> The left and right edge of every patch of the present state, shape (2, patches).
   function edge_fields_of(simulation, patches) result(edges)
      type(simulation_type), intent(in) :: simulation
      type(patch_type), intent(in) :: patches(:)
      type(edge_field_type) :: edges(2, size(patches)), undefined
      type(contact_state_type) :: before
      type(response_type) :: response
      logical :: known, turns
      integer :: i, j

      associate (model => simulation%contact%model, state => simulation%contact%state, none => ieee_value(1.0_wp, ieee_quiet_nan))
         undefined = edge_field_type(none, none, none, none, none, none, none)
         edges = undefined
         if (size(patches) > most_patches) return
         turns = model%moves(motion_rotation) .and. simulation%load(motion_rotation)%control == control_force
         call find_change_if_stuck(simulation, before, response, known)
         do i = 1, size(patches)
            if (model%tangential) edges(:, i)%slip_zone = slip_zones_of(patches(i))
            do j = 1, size(sides)
               call find_root_intensity(model, state, patches(i), sides(j), edges(j, i)%normal, edges(j, i)%reach)
            end do
            call add_exponents(simulation%contact, patches(i), turns, edges(:, i))
            if (known) call add_shear(simulation%contact, before, response, patches(i), turns, edges(:, i))
            ! No edges: the surfaces repeat.
            if (i == 1 .and. any(patches%to_first > 0.0_wp)) edges(1, i) = undefined
            if (patches(i)%to_first > 0.0_wp) edges(2, i) = undefined
         end do
      end associate
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

   !> Exponents of the pressure at the edges of a patch, and its intensities at corners. Of different bodies whose outermost node
   !> sticks the edge is not known: the pressure oscillates at a corner, and elsewhere there is a slip zone without a node. `turns`:
   !> whether the moment is prescribed.
   subroutine add_exponents(path, patch, turns, edges)
      type(contact_path_type), intent(in) :: path
      type(patch_type), intent(in) :: patch
      logical, intent(in) :: turns
      type(edge_field_type), intent(inout) :: edges(2)
      logical :: ends(2), unknown(2)
      real(wp) :: powers(2)

      ends = [patch%left_ends, patch%right_ends]
      powers = [patch%left_power, patch%right_power]
      unknown = holds(path%state%status([patch%first, patch%last])) .and. is_coupled(path)
      edges%exponent = merge(powers - 1.0_wp, powers, ends)
      ! Other surfaces that end there are cut off.
      unknown = unknown .or. ends .and. .not. [is_corner(path, patch%first, -1), is_corner(path, patch%last, 1)]
      if (any(ends)) edges%corner = singular_intensities(path%model, path%state%fields%pressure, patch, powers, ends, turns)
      where (.not. ends .or. unknown) edges%corner = ieee_value(1.0_wp, ieee_quiet_nan)
      where (unknown)
         edges%exponent = edges%corner
         edges%normal = edges%corner
         edges%reach = edges%corner
      end where
   end subroutine add_exponents

   !> Whether a sharp punch ends beyond a node on a side.
   logical function is_corner(path, node, side)
      type(contact_path_type), intent(in) :: path
      integer, intent(in) :: node, side

      is_corner = is_beyond_corner(path%model, path%model%arc(node) + side*path%model%width(node))
   end function is_corner

   !> Whether pressure and shear of nodes that stick depend on each other next to an edge.
   logical function is_coupled(path)
      type(contact_path_type), intent(in) :: path

      is_coupled = path%model%compliance%elastic_block(block_wt) .and. .not. alike(path%model%scene)
   end function is_coupled

   !> Intensities of the changes at the edges of a patch, and the slip zones that follow. `before`: the state at the last turning
   !> point; `response`: the change since then; `turns`: as above.
   subroutine add_shear(path, before, response, patch, turns, edges)
      type(contact_path_type), intent(in) :: path
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
      edges%shear = singular_intensities(path%model, response%rate%shear, patch, powers, both, .false.)
      if (.not. path%model%scene%friction%is_coulomb()) return
      pressure = singular_intensities(path%model, response%rate%pressure, patch, powers, both, turns)
      do i = 1, size(sides)
         edges(i)%asymptotic_slip_zone = asymptotic_slip_zone(path, before, patch, sides(i), edges(i), pressure(i))
      end do
   end subroutine add_shear

   !> Width of the slip zone at an edge by the asymptotes, length; `pressure`: dK_N. NaN at corners, where nothing sticks now, where
   !> the shear before is no constant part of its limit over the zone, or is nearly at it in this direction, where an unloading
   !> alone makes it slip, and beyond half the patch.
   real(wp) function asymptotic_slip_zone(path, before, patch, side, edge, pressure) result(width)
      type(contact_path_type), intent(in) :: path
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
      friction = path%model%kinetic_friction(node)
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
            if (abs(path%model%arc(last - side) - merge(patch%right, patch%left, side > 0)) > inner*found) exit
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
   subroutine find_change_if_stuck(simulation, before, response, known)
      type(simulation_type), intent(in) :: simulation
      type(contact_state_type), intent(out) :: before
      type(response_type), intent(out) :: response
      logical, intent(out) :: known
      class(contact_system_type), allocatable :: system
      type(constraints_type) :: constraints
      logical :: singular

      associate (path => simulation%contact)
         known = path%model%tangential .and. any(in_contact(path%state%status)) .and. simulation%marks(mark_turn)%step > 0 .and. &
                 .not. is_coupled(path) .and. .not. (path%model%moves(motion_rotation) .and. path%model%rolls())
         if (.not. known) return
         before = simulation%padded(simulation%marks(mark_turn))
         call path%set_rows(constraints, .false.)
         constraints%status = merge(node_stick, node_open, in_contact(path%state%status))
         constraints%load = changes_of_loads(simulation, before)
         if (path%model%compliance%elastic_block(block_up) .and. .not. alike(path%model%scene)) &
            known = .not. abs(constraints%load(motion_approach)%rate) > significant*abs(path%state%fields%force(motion_approach))
         if (.not. known) return
         constraints%rates_only = .true.
         allocate (system, source=path%system)
         call system%solve(path%model, constraints, path%state%fields, response, singular)
         known = .not. singular
      end associate
   end subroutine find_change_if_stuck

   !> Changes of the loads since the state `before`: of forces, and of a rotation and of bulk stresses that are prescribed.
   function changes_of_loads(simulation, before) result(load)
      type(simulation_type), intent(in) :: simulation
      type(contact_state_type), intent(in) :: before
      type(load_type) :: load(motion_count)
      integer :: i

      associate (fields => simulation%contact%state%fields, now => simulation%load)
         do i = 1, motion_count
            if (motions(i)%is_known .or. .not. simulation%contact%model%moves(i) .or. &
                (i == motion_rotation .and. now(i)%control == control_displacement)) then
               load(i) = load_type(control_displacement, fields%motion(i), fields%motion(i) - before%fields%motion(i))
            else
               load(i) = load_type(control_force, fields%force(i), fields%force(i) - before%fields%force(i))
            end if
         end do
      end associate
   end function changes_of_loads

   !> Length of the part that sticks both at the far end of a cycle and at its end; NaN with several patches or stick zones, and
   !> with turning points between these two.
   elemental real(wp) function permanent_stick_length(cycle) result(length)
      type(cycle_type), intent(in) :: cycle

      associate (there => cycle%reversal%edges, back => cycle%return%edges)
         length = 0.0_wp
         if (.not. (is_one_zone(there) .and. is_one_zone(back)) .or. cycle%turns /= 2) length = ieee_value(1.0_wp, ieee_quiet_nan)
         if (there%stick .and. back%stick) &
            length = length + max(min(there%stick_right, back%stick_right) - max(there%stick_left, back%stick_left), 0.0_wp)
      end associate
   end function permanent_stick_length

   !> Whether one patch has one stick zone, or none.
   elemental logical function is_one_zone(edges)
      type(zone_edges_type), intent(in) :: edges

      is_one_zone = edges%patches == 1 .and. &
                    abs(edges%stick_right - edges%stick_left - edges%stick_length) <= certified*edges%contact_length
   end function is_one_zone

   !> Length of the permanent stick zone of steady cycles on a straight load path, by superposition: the contact under the normal
   !> force (P1 + P2)/2 - |Q2 - Q1|/(2 mu), where |Q2 - Q1| > mu |P2 - P1| (Barber, Davies and Hills 2011; half-planes without
   !> coupling, of any profiles). NaN for other bodies and load histories, where nothing would stick, and above most_patches.
   function steady_stick_length(simulation, cycle) result(length)
      type(simulation_type), intent(in) :: simulation
      type(cycle_type), intent(in) :: cycle
      real(wp) :: length
      type(contact_path_type) :: path
      type(segment_type) :: segment
      type(error_type), allocatable :: error
      type(zone_edges_type) :: edges
      real(wp) :: normal, change(2), friction

      length = ieee_value(1.0_wp, ieee_quiet_nan)
      if (cycle%return%edges%patches > most_patches .or. .not. superposes(simulation, cycle)) return
      associate (there => cycle%reversal%force, back => cycle%return%force)
         friction = simulation%contact%model%scene%friction%static%largest()
         change = abs([back(motion_approach) - there(motion_approach), back(motion_shift) - there(motion_shift)])
         if (.not. change(2) > friction*change(1)) return
         normal = 0.5_wp*(there(motion_approach) + back(motion_approach)) - 0.5_wp*change(2)/friction
      end associate
      if (.not. normal > 0.0_wp) return
      call new_contact_path(simulation%contact%model, .false., path)
      segment%friction = .false.
      segment%load(motion_approach) = load_type(control_force, 0.0_wp, normal)
      call apply_directly(path, segment, error=error)
      if (allocated(error)) return
      call find_zone_edges(path%model, path%state, edges)
      length = edges%contact_length
   end function steady_stick_length

   !> Whether tangential problems are superpositions of normal ones over a cycle: half-planes without coupling or wear under normal
   !> and tangential forces on a straight line, one coefficient of friction.
   logical function superposes(simulation, cycle)
      type(simulation_type), intent(in) :: simulation
      type(cycle_type), intent(in) :: cycle
      real(wp) :: normal(3)
      integer :: i

      superposes = .false.
      associate (model => simulation%contact%model, scene => simulation%contact%model%scene)
         if (.not. (model%tangential .and. model%upright) .or. cycle%turns /= 2) return
         if (scene%lower%deforms_as_circle() .or. scene%upper%deforms_as_circle() .or. scene%lower%is_matrix()) return
         if (scene%is_layered() .or. scene%wear%acts() .or. .not. scene%friction%is_coulomb()) return
         if (model%compliance%elastic_block(block_up) .and. .not. alike(scene)) return
         if (maxval(model%static_friction) - minval(model%kinetic_friction, mask=model%can_touch) > certified) return
         do i = 1, motion_count
            if (motions(i)%optional .and. model%moves(i)) return
         end do
         normal = [cycle%start%force(motion_approach), cycle%lowest_force(motion_approach), cycle%highest_force(motion_approach)]
         superposes = maxval(normal) - minval(normal) <= significant*maxval(normal) .or. &
                      all(simulation%load([motion_approach, motion_shift])%control == control_force)
      end associate
   end function superposes

end module mfv_edge_fields
