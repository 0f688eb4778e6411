!> Which quantities of a simulation its mesh does not resolve, and why: few nodes in contact patches, profiles with more points
!> than the mesh has nodes, rounded edges, slip zones. Warnings and error bars take it from here.
module mfv_resolution
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
   use mfv_body, only: body_names, body_type
   use mfv_compliance, only: block_wt
   use mfv_contact_model, only: contact_model_type, gap_at, needs_equal_intervals
   use mfv_contact_state, only: contact_state_type
   use mfv_edge_fields, only: edge_quantities
   use mfv_extreme_states, only: has_largest_tension
   use mfv_interior, only: has_interior
   use mfv_kinds, only: pi, wp
   use mfv_layers, only: layers_type
   use mfv_load_extremes, only: load_extremes_type
   use mfv_motions, only: controlled_key, motion_approach, motion_count, motion_interference, motion_shift
   use mfv_node_status, only: holds, in_contact, slip_sign
   use mfv_observables, only: observable_count, observables, observed_type
   use mfv_profile_sampling, only: find_missed, negligible_pressure, pressure_of_wave
   use mfv_simulation, only: simulation_type
   use mfv_slip_zones, only: contact_interval, hidden_width_at_edge, is_narrow_stick_zone, needed_mesh, nodes_at_edge, &
                             resolved_nodes, slip_record_type
   use mfv_strings, only: has_word, to_text
   use mfv_tolerances, only: certified, visible
   use mfv_zone_edges, only: find_patches, find_zone_edges, held, is_beyond_corner, patch_type, rises_at_end, zone_edges_type, &
                             zone_type, zones_of
   implicit none
   private
   public :: find_unresolved, unresolved_type, add_unresolved, is_unresolved, all_quantities, undersampling, poorest_patch, &
             fewest_patch_nodes, find_unresolved_observables, refinement_for_layers, nodes_in, is_prescribed

   !> What a mesh does not resolve.
   type :: unresolved_type
      !> Names of observables, separated by blanks, and a sentence for the user that names them.
      character(:), allocatable :: quantities, text
   end type unresolved_type

   !> Fewest nodes of a contact patch for half-width, stick ratio and tractions.
   integer, parameter :: fewest_patch_nodes = 10

contains

   !> What the mesh of a simulation does not resolve in its present state and last cycle, one entry for each cause.
   subroutine find_unresolved(simulation, unresolved)
      type(simulation_type), intent(in) :: simulation
      type(unresolved_type), allocatable, intent(out) :: unresolved(:)

      allocate (unresolved(0))
      if (simulation%contact%state%contact_nodes() > 0) then
         call check_patches(simulation, unresolved)
         call check_profile(simulation, .false., unresolved)
         call check_profile(simulation, .true., unresolved)
         call check_rounded_edges(simulation, .false., unresolved)
         call check_rounded_edges(simulation, .true., unresolved)
         call check_thin_layers(simulation, .false., unresolved)
         call check_thin_layers(simulation, .true., unresolved)
         call check_beyond_mesh(simulation, unresolved)
      end if
      call check_surface_ends(simulation, unresolved)
      call check_fall(simulation, unresolved)
      call check_slip_zones(simulation, unresolved)
      call check_largest_shear(simulation, unresolved)
      call check_stick_zones(simulation, unresolved)
      call check_shakedown(simulation, unresolved)
      call check_increments(simulation, unresolved)
      call check_rolling(simulation, unresolved)
      call check_worn_shape(simulation, unresolved)
   end subroutine find_unresolved

   !> Add a cause: `quantities` (names of observables, separated by blanks), why they are not resolved, and what to do.
   subroutine add_unresolved(unresolved, quantities, why, remedy)
      type(unresolved_type), allocatable, intent(inout) :: unresolved(:)
      character(*), intent(in) :: quantities, why, remedy
      character(:), allocatable :: list, names, rest, word

      list = ''
      names = ''
      rest = trim(quantities)//' '
      do while (rest /= '')
         word = rest(:index(rest, ' ') - 1)
         rest = rest(len(word) + 2:)
         if (has_word(names, word)) cycle
         names = names//' '//word
         list = list//', '//word
      end do
      ! Variables: gfortran 12 keeps the length of an untrimmed text in trim() within these constructors.
      names = names(2:)
      unresolved = [unresolved, unresolved_type(names, why//'; not resolved: '//list(3:)//'; '//remedy)]
   end subroutine add_unresolved

   !> Whether an observable is among those that are not resolved, by its name or by that of a quantity or a group that it belongs
   !> to.
   pure recursive logical function is_unresolved(unresolved, name) result(is_there)
      type(unresolved_type), intent(in) :: unresolved(:)
      character(*), intent(in) :: name
      character(len=36) :: group
      integer :: i

      is_there = .false.
      if (size(unresolved) == 0) return
      is_there = any([(has_word(unresolved(i)%quantities, name), i=1, size(unresolved))])
      group = named_as(name)
      if (.not. is_there .and. group /= '') is_there = is_unresolved(unresolved, trim(group))
   end function is_unresolved

   !> Names of the observables that the mesh of a simulation, or a coarser one of its error bars, does not resolve, separated by
   !> blanks; prescribed loads are resolved. `observed`: what is read off the simulation, if it is known: without observables that
   !> are not available.
   subroutine find_unresolved_observables(simulation, names, observed)
      type(simulation_type), intent(in) :: simulation
      character(:), allocatable, intent(out) :: names
      type(observed_type), intent(in), optional :: observed
      type(unresolved_type), allocatable :: unresolved(:)
      integer :: place

      call find_unresolved(simulation, unresolved)
      if (allocated(simulation%estimate)) then
         do place = 1, size(simulation%estimate%bar)
            if (.not. simulation%estimate%bar(place)%resolved) &
               call add_unresolved(unresolved, observables(place)%name, '', '')
         end do
      end if
      names = ''
      do place = 1, observable_count
         if (present(observed)) then
            if (ieee_is_nan(observed%values(place))) cycle
         end if
         if (is_prescribed(simulation, trim(observables(place)%name))) cycle
         if (is_unresolved(unresolved, trim(observables(place)%name))) names = names//' '//trim(observables(place)%name)
      end do
      names = names(min(2, len(names) + 1):)
   end subroutine find_unresolved_observables

   !> Whether an observable is a load that is prescribed now.
   pure logical function is_prescribed(simulation, name)
      type(simulation_type), intent(in) :: simulation
      character(*), intent(in) :: name
      integer :: i

      is_prescribed = .false.
      do i = 1, motion_count
         is_prescribed = is_prescribed .or. controlled_key(i, simulation%load(i)%control) == name
      end do
   end function is_prescribed

   !> The quantity or group whose name stands for an observable where quantities are not resolved, padded with blanks: for a
   !> dimensionless number its uncertain factor.
   pure function named_as(name)
      character(*), intent(in) :: name
      character(len=36) :: named_as

      select case (name)
      case ('contact_centre')
         named_as = 'contact_length'
      case ('half_width_number')
         named_as = 'contact_half_width'
      case ('pressure_number', 'shear_number')
         named_as = 'peak_'//name(:len(name) - len('_number'))
      case ('force_number', 'shift_number')
         named_as = name(:len(name) - len('_number'))//'_amplitude'
      case ('dissipation_number')
         named_as = 'cycle_dissipation'
      case ('stiffness_number')
         named_as = 'tangential_stiffness'
      case ('creepage_number')
         named_as = 'creepage'
      case ('normal_force', 'moment', 'rotation')
         named_as = 'approach'
      case ('tangential_force', 'shift_drift', 'creepage', 'lower_contraction', 'upper_contraction')
         named_as = 'shift'
      case ('worn_area', 'wear_depth')
         named_as = 'dissipation'
      case ('lower_tension_x', 'upper_tension_x')
         named_as = name(:13)
      case default
         named_as = ''
         if (index(name, 'largest_') == 1 .or. index(name, 'smallest_') == 1) then
            named_as = 'extremes'
            ! Where it is.
            if (any(name(len(name) - 1:) == ['_x', '_y'])) named_as = name(:len(name) - 2)
         end if
         associate (ending => name(index(name, '_', back=.true.) + 1:))
            if (any([character(9) :: 'loading', 'reversal', 'return', 'amplitude'] == ending) .or. &
                name == 'first_cycle_dissipation' .or. name == 'permanent_stick_length') named_as = 'turning_points'
            if (any([character(9) :: 'intensity', 'reach', 'zone'] == ending) .or. name == 'steady_stick_length') &
               named_as = 'contact_length'
            if (name == 'left_slip_zone' .or. name == 'right_slip_zone') named_as = 'stick_ratio'
         end associate
      end select
   end function named_as

   !> The quantities that depend on all contact patches, separated by blanks and padded with them; for the groups see `named_as`.
   function all_quantities(simulation) result(names)
      type(simulation_type), intent(in) :: simulation
      character(len=240) :: names

      names = 'contact_half_width contact_length peak_pressure approach extremes'
      if (simulation%contact%model%tangential) names = trim(names)//' '//quantities_of_shear(simulation)
   end function all_quantities

   !> Those of them that depend on friction.
   function quantities_of_shear(simulation) result(names)
      type(simulation_type), intent(in) :: simulation
      character(len=160) :: names

      names = 'shift stick_ratio peak_shear dissipation extremes'//tensions(simulation)
      if (simulation%cycle_count > 0) names = trim(names)//' cycle_dissipation tangential_stiffness '// &
                                              'secant_stiffness loss_factor turning_points'
   end function quantities_of_shear

   !> Names of the tensions of the bodies that have any, after blanks and padded with them.
   function tensions(simulation) result(names)
      type(simulation_type), intent(in) :: simulation
      character(len=28) :: names

      names = ''
      if (has_interior(simulation%contact%model%scene%lower)) names = ' lower_tension'
      if (has_interior(simulation%contact%model%scene%upper)) names = trim(names)//' upper_tension'
   end function tensions

   !> These and the largest over the history.
   function largest_tensions(simulation) result(names)
      type(simulation_type), intent(in) :: simulation
      character(len=72) :: names

      names = tensions(simulation)
      if (has_interior(simulation%contact%model%scene%lower)) names = trim(names)//' largest_lower_tension'
      if (has_interior(simulation%contact%model%scene%upper)) names = trim(names)//' largest_upper_tension'
   end function largest_tensions

   !> The tensions at the end and, where that may be the largest one, over the history or its last cycle.
   function tensions_at_end(simulation) result(names)
      type(simulation_type), intent(in) :: simulation
      character(len=72) :: names
      integer :: i

      names = tensions(simulation)
      do i = 1, size(body_names)
         if (index(names, body_names(i)) > 0 .and. has_largest_tension(simulation, i)) &
            names = trim(names)//' largest_'//body_names(i)//'_tension'
      end do
   end function tensions_at_end

   !> The contact patches. Where the surfaces repeat, the ends of the mesh are neighbours: a last patch that continues in the first
   !> one contains its nodes as those after the last node.
   function patches_of(simulation) result(patches)
      type(simulation_type), intent(in) :: simulation
      type(zone_type), allocatable :: patches(:)

      associate (model => simulation%contact%model)
         patches = zones_of(in_contact(simulation%contact%state%status))
         associate (n => model%nodes(), m => size(patches))
            if (m < 2 .or. .not. ends_are_neighbours(model)) return
            if (patches(1)%first > 1 .or. patches(m)%last < n) return
            patches(m)%last = n + patches(1)%last
         end associate
      end associate
      patches = patches(2:)
   end function patches_of

   !> Whether the surfaces repeat beyond both ends of the mesh.
   pure logical function ends_are_neighbours(model)
      type(contact_model_type), intent(in) :: model

      ends_are_neighbours = model%repeats_beyond(1, -1) .and. model%repeats_beyond(model%nodes(), 1)
   end function ends_are_neighbours

   !> The nodes of a zone, also of one across the ends of a mesh of `n` nodes.
   pure function nodes_of(zone, n) result(nodes)
      type(zone_type), intent(in) :: zone
      integer, intent(in) :: n
      integer :: nodes(zone%last - zone%first + 1), i

      nodes = [(modulo(i - 1, n) + 1, i=zone%first, zone%last)]
   end function nodes_of

   !> The contact patch with the fewest nodes among those that matter: that carry a part of the normal force, or the peak pressure.
   function poorest_patch(simulation) result(poorest)
      type(simulation_type), intent(in) :: simulation
      type(zone_type) :: poorest
      real(wp), parameter :: least_part = 0.01_wp
      type(zone_type), allocatable :: patches(:)
      integer :: i, peak

      associate (model => simulation%contact%model, state => simulation%contact%state)
         patches = patches_of(simulation)
         peak = maxloc(state%fields%pressure, dim=1)
         poorest = zone_type(1, size(state%status))
         do i = 1, size(patches)
            if (patches(i)%last - patches(i)%first >= poorest%last - poorest%first) cycle
            associate (nodes => nodes_of(patches(i), model%nodes()))
               if (sum(state%fields%pressure(nodes)*model%width(nodes)) < least_part*state%fields%force(motion_approach) &
                   .and. .not. any(nodes == peak)) cycle
            end associate
            poorest = patches(i)
         end do
      end associate
   end function poorest_patch

   !> Number of nodes of a patch.
   pure integer function nodes_in(patch)
      type(zone_type), intent(in) :: patch

      nodes_in = patch%last - patch%first + 1
   end function nodes_in

   !> Contact patches with few nodes. With coupling the exponents at the edges depend on whether the outermost nodes slip, even if
   !> the outermost patches carry next to nothing.
   subroutine check_patches(simulation, unresolved)
      type(simulation_type), intent(in) :: simulation
      type(unresolved_type), allocatable, intent(inout) :: unresolved(:)
      character(:), allocatable :: advice, names
      type(zone_type), allocatable :: patches(:)
      type(zone_type) :: poorest
      logical :: couples, poor(2)

      poorest = poorest_patch(simulation)
      patches = patches_of(simulation)
      associate (model => simulation%contact%model, outer => patches([1, size(patches)]))
         ! A patch across the ends of the mesh has no outermost edges.
         couples = model%couples(block_wt) .and. all(patches%last <= model%nodes())
         if (nodes_in(poorest) < fewest_patch_nodes) then
            advice = ''
            call advise_on_heights(model%scene%lower, 'lower', advice)
            call advise_on_heights(model%scene%upper, 'upper', advice)
            names = trim(all_quantities(simulation))
            if (couples) names = names//' left_edge_exponent right_edge_exponent'
            call add_patch(poorest, names, advice)
         else if (couples) then
            poor = [nodes_in(outer(1)), nodes_in(outer(2))] < fewest_patch_nodes
            names = 'left_edge_exponent'
            if (.not. poor(1)) names = 'right_edge_exponent'
            if (all(poor)) names = names//' right_edge_exponent'
            if (any(poor)) call add_patch(outer(merge(1, 2, poor(1))), names, '')
         end if
      end associate

   contains

      !> Add the quantities that a patch does not resolve; `advice` comes before that on the mesh.
      subroutine add_patch(patch, quantities, advice)
         type(zone_type), intent(in) :: patch
         character(*), intent(in) :: quantities, advice
         character(:), allocatable :: why

         associate (model => simulation%contact%model, state => simulation%contact%state, &
                    nodes => nodes_of(patch, simulation%contact%model%nodes()))
            why = 'only '//to_text(size(nodes))//trim(merge(' node is  ', ' nodes are', size(nodes) == 1))//' in contact'
            if (size(patches) > 1) why = why//' in the patch near x = '//to_text(model%x(nodes((size(nodes) + 1)/2)), 4)// &
                                         ', one of '//to_text(size(patches))//' patches with '// &
                                         to_text(count(in_contact(state%status)))//' nodes'
            call add_unresolved(unresolved, quantities, why, advice//'use '// &
                                trim(needed_mesh(model, state, sum(model%width(nodes)), fewest_patch_nodes))//' for '// &
                                to_text(fewest_patch_nodes)//' nodes in each patch')
         end associate
      end subroutine add_patch
   end subroutine check_patches

   !> Add to `advice` what to do about a profile so steep that its heights are probably in another unit than its positions.
   subroutine advise_on_heights(body, name, advice)
      type(body_type), intent(in) :: body
      character(*), intent(in) :: name
      character(:), allocatable, intent(inout) :: advice
      real(wp), parameter :: steep = 1.0_wp
      real(wp) :: slope
      integer :: n

      if (.not. body%is_sampled()) return
      n = size(body%position)
      slope = sum(abs(body%height(2:) - body%height(:n - 1)))/(body%position(n) - body%position(1))
      if (slope > steep) advice = advice//'check height_scale of the '//name//' body, whose heights change by '// &
                                  to_text(slope, 2)//' per unit of x, or '
   end subroutine advise_on_heights

   !> A profile with more points than the mesh has nodes, which changes the pressures between them.
   subroutine check_profile(simulation, upper, unresolved)
      type(simulation_type), intent(in) :: simulation
      logical, intent(in) :: upper
      type(unresolved_type), allocatable, intent(inout) :: unresolved(:)
      real(wp) :: part
      integer :: nodes, points

      call undersampling(simulation, upper, part, points)
      if (.not. part > negligible_pressure) return
      nodes = simulation%contact%model%scene%nodes_for_profile()
      call add_unresolved(unresolved, all_quantities(simulation), 'the mesh is coarser than the profile of the '// &
                          merge('upper', 'lower', upper)//' body, which has up to '//to_text(points + 1)// &
                          ' points per interval: what is between the nodes changes the pressure by about '// &
                          to_text(100.0_wp*part, 2)//' % of its peak', 'use at least '// &
                          to_text(max(nodes, (points + 1)*simulation%contact%model%scene%mesh%nodes))//' nodes')
   end subroutine check_profile

   !> The pressure over the peak that is due to points of the profile of a body between the nodes, at which it protrudes from, or
   !> recedes behind, a smooth curve through the nodes in contact, or penetrates the other body where nodes are open (the
   !> deformation is interpolated). `points`: most points between two nodes.
   subroutine undersampling(simulation, upper, part, points)
      type(simulation_type), intent(in) :: simulation
      logical, intent(in) :: upper
      real(wp), intent(out) :: part
      integer, intent(out) :: points
      integer, allocatable :: left(:), in_interval(:)
      real(wp), allocatable :: fraction(:), height(:), gap(:)
      logical, allocatable :: touching(:)
      real(wp) :: peak
      integer :: i

      part = 0.0_wp
      points = 0
      associate (model => simulation%contact%model, state => simulation%contact%state)
         peak = maxval(state%fields%pressure)
         if (.not. merge(model%scene%upper%is_sampled(), model%scene%lower%is_sampled(), upper) .or. .not. peak > 0.0_wp) return
         if (upper) then
            call find_missed(model%scene%upper, model%x, left, fraction, height)
         else
            call find_missed(model%scene%lower, model%x, left, fraction, height)
         end if
         if (size(left) == 0) return
         touching = in_contact(state%status)
         gap = max(model%gap(state%fields), 0.0_wp)
         gap = gap(left) + fraction*(gap(left + 1) - gap(left))
         where (touching(left) .and. touching(left + 1))
            height = abs(height)
         elsewhere
            height = max(-height - gap, 0.0_wp)
         end where
         part = maxval(pressure_of_wave(model%scene%modulus(), height, model%width(left)))/peak
         allocate (in_interval(maxval(left)), source=0)
         do i = 1, size(left)
            in_interval(left(i)) = in_interval(left(i)) + 1
         end do
         points = maxval(in_interval(left), mask=height > 0.0_wp)
      end associate
   end subroutine undersampling

   !> From the flat of a punch to the contact edge the pressure rises to its peak and vanishes.
   subroutine check_rounded_edges(simulation, upper, unresolved)
      type(simulation_type), intent(in) :: simulation
      logical, intent(in) :: upper
      type(unresolved_type), allocatable, intent(inout) :: unresolved(:)
      type(zone_edges_type) :: edges
      !> Of an edge so near to where the pressure begins to vanish; and the width of an edge that a coarse mesh misses; intervals.
      real(wp), parameter :: edge_uncertainty = 0.5_wp, least_width = 0.25_wp
      type(body_type) :: body
      real(wp) :: width, interval

      associate (model => simulation%contact%model, state => simulation%contact%state)
         body = model%scene%lower
         if (upper) body = model%scene%upper
         if (.not. body%flat_half_width > 0.0_wp) return
         call find_zone_edges(model, state, edges)
         width = 0.5_wp*(edges%contact_right - edges%contact_left) - body%flat_half_width
         interval = minval(model%width, mask=in_contact(state%status))
         ! The contact of a coarse mesh may end on the flat.
         if (.not. edges%contact .or. .not. width > -interval .or. width >= resolved_nodes*interval) return
         width = max(width, least_width*interval)
         call add_unresolved(unresolved, all_quantities(simulation), 'the rounded edges of the '// &
                             merge('upper', 'lower', upper)//' body are in contact over a width of '//to_text(width, 3)//', '// &
                             to_text(width/interval, 2)//' intervals', 'use '// &
                             trim(needed_mesh(model, state, max(width - edge_uncertainty*interval, 0.5_wp*width), resolved_nodes)))
      end associate
   end subroutine check_rounded_edges

   !> Layers thinner than a few intervals.
   subroutine check_thin_layers(simulation, upper, unresolved)
      type(simulation_type), intent(in) :: simulation
      logical, intent(in) :: upper
      type(unresolved_type), allocatable, intent(inout) :: unresolved(:)
      character(:), allocatable :: names
      real(wp) :: intervals

      call measure_first_layer(simulation, upper, names, intervals)
      if (names == '' .or. intervals >= resolved_nodes) return
      associate (model => simulation%contact%model, state => simulation%contact%state)
         associate (thickness => intervals*minval(model%width, mask=in_contact(state%status)))
            call add_unresolved(unresolved, names, 'the first layer of the '//trim(merge('upper', 'lower', upper))//' body is '// &
                                to_text(intervals, 2)//' intervals thick', &
                                'use '//trim(needed_mesh(model, state, thickness, resolved_nodes)))
         end associate
      end associate
   end subroutine check_thin_layers

   !> Intervals in the thickness of a body's first layer, and the names of what depends on them: stresses change over the
   !> thickness at the edges of the contact; nearly incompressible layers on a rigid body are squeezed out from where the mesh
   !> sees no difference of pressure. No names: no layers, or they do not matter.
   subroutine measure_first_layer(simulation, upper, names, intervals)
      type(simulation_type), intent(in) :: simulation
      logical, intent(in) :: upper
      character(:), allocatable, intent(out) :: names
      real(wp), intent(out) :: intervals
      !> Shear compliance over the normal one of a strip that is nearly incompressible; relative change of compliance that matters.
      real(wp), parameter :: incompressible = 10.0_wp, least_change = 0.01_wp
      type(body_type) :: body
      type(layers_type) :: layers
      character(:), allocatable :: name

      names = ''
      intervals = huge(intervals)
      if (.not. simulation%contact%model%scene%has_layers(upper)) return
      associate (model => simulation%contact%model, state => simulation%contact%state)
         body = model%scene%lower
         if (upper) body = model%scene%upper
         name = trim(merge('upper', 'lower', upper))
         layers = body%elasticity%layers()
         intervals = body%elasticity%depth_of(1)/minval(model%width, mask=in_contact(state%status))
      end associate
      associate (below => layers%compliance((0.0_wp, 0.0_wp)), endless => layers%layer(1)%endless)
         if (maxval(abs(below - endless)) > least_change*maxval(abs(endless))) &
            names = name//'_tension largest_'//name//'_tension largest_'//name//'_interface_tension largest_'//name// &
                    '_interface_shear'
      end associate
      if (layers%rigid_base .and. layers%uniform(1, 1) > incompressible*layers%uniform(2, 2)) names = all_quantities(simulation)
   end subroutine measure_first_layer

   !> Factor by which the mesh must be refined for the layers of both bodies; at most 1 if it resolves them.
   real(wp) function refinement_for_layers(simulation) result(factor)
      type(simulation_type), intent(in) :: simulation
      character(:), allocatable :: names
      real(wp) :: intervals
      integer :: body

      factor = 0.0_wp
      do body = 1, 2
         call measure_first_layer(simulation, body == 2, names, intervals)
         if (names /= '') factor = max(factor, resolved_nodes/intervals)
      end do
   end function refinement_for_layers

   !> Surfaces that overlap beyond the mesh, which is lengthened next to the contact only: another patch is missed there. Looked for
   !> where the gap falls again beyond the mesh, within as many intervals to either side as the mesh has.
   subroutine check_beyond_mesh(simulation, unresolved)
      type(simulation_type), intent(in) :: simulation
      type(unresolved_type), allocatable, intent(inout) :: unresolved(:)
      type(contact_model_type) :: model
      type(contact_state_type) :: state
      logical, allocatable :: overlap(:)
      integer :: extra, n, first

      associate (mesh => simulation%contact%model, scene => simulation%contact%model%scene)
         if (scene%lower%is_matrix() .or. allocated(scene%mesh%ends) .or. scene%repeat_length() > 0.0_wp) return
         n = mesh%nodes()
         extra = min(mesh%spare_nodes(), n)
         if (extra < 1) return
         if (.not. (falls(mesh%arc(1), -1) .or. falls(mesh%arc(n), 1))) return
         model = mesh
      end associate
      call model%grow(extra)
      state = simulation%contact%state
      call state%widen(extra)
      call model%displace(state%fields)
      overlap = model%can_touch .and. model%gap(state%fields) < -visible*abs(state%fields%motion(motion_approach))
      overlap(extra + 1:extra + n) = .false.
      first = findloc(overlap, .true., dim=1)
      if (first == 0) return
      call add_unresolved(unresolved, trim(all_quantities(simulation)), 'the surfaces overlap beyond the mesh, near x = '// &
                          to_text(model%x(first), 4), 'give a larger half_width in &mesh')

   contains

      !> Whether the gap falls again somewhere on the surfaces beyond the last node, at `arc`, on `side` (-1 left, 1 right).
      logical function falls(arc, side)
         real(wp), intent(in) :: arc
         integer, intent(in) :: side
         real(wp), dimension(0:extra) :: place, gap
         integer :: i

         associate (scene => simulation%contact%model%scene)
            place = [(arc + side*i*simulation%contact%model%interval(), i=0, extra)]
            gap = gap_at(scene, place)
            falls = any(gap(1:) < gap(:extra - 1) .and. scene%touchable(place(1:)))
         end associate
      end function falls
   end subroutine check_beyond_mesh

   !> The end of a surface that is no corner by design: the pressure there has no limit.
   subroutine check_surface_ends(simulation, unresolved)
      type(simulation_type), intent(in) :: simulation
      type(unresolved_type), allocatable, intent(inout) :: unresolved(:)
      type(patch_type), allocatable :: patches(:)
      type(load_extremes_type) :: extremes
      character(:), allocatable :: names
      logical :: now

      extremes = simulation%latest_extremes()
      call find_patches(simulation%contact%model, simulation%contact%state, patches)
      now = rises_at_end(simulation%contact%model, simulation%contact%state, patches)
      names = 'extremes'
      if (now) names = 'peak_pressure '//names
      if (now .and. simulation%contact%model%tangential) names = 'peak_shear '//names
      if (now .or. extremes%at_end) &
         call add_unresolved(unresolved, names, 'the contact reaches the end of a surface, where the pressure has no limit', &
                             'extend the surface, or round its end')
   end subroutine check_surface_ends

   !> Friction that falls at once when a node begins to slip, or over less slip than intervals resolve. Over a slip D it falls
   !> within a length M D/((mu_s - mu_k) p0) next to a stick zone, with the modulus M and the largest pressure p0 (docs/guide.md).
   subroutine check_fall(simulation, unresolved)
      type(simulation_type), intent(in) :: simulation
      type(unresolved_type), allocatable, intent(inout) :: unresolved(:)
      !> Intervals within that length from which on results converge.
      integer, parameter :: enough = 10
      character(:), allocatable :: why, remedy
      real(wp) :: length, drop

      associate (model => simulation%contact%model, friction => simulation%contact%model%scene%friction, &
                 state => simulation%contact%state)
         if (.not. (model%tangential .and. allocated(friction%law)) .or. .not. any(state%friction_work > 0.0_wp)) return
         drop = maxval((model%static_friction - model%kinetic_friction)*state%fields%pressure)
         if (.not. drop > 0.0_wp .or. friction%law%slip_of_fall() >= huge(length)) return
         length = model%compliance%modulus/model%compliance%shear_ratio*friction%law%slip_of_fall()/drop
         if (length >= contact_interval(model, state)) return
         why = 'stick zones under static and kinetic friction depend on the mesh, however fine'
         remedy = "compare them on equal intervals only, or use law='weakening'"
         if (length > 0.0_wp) then
            why = 'friction falls by slips of weakening_distance within '//to_text(length, 2)//', less than an interval'
            remedy = 'use intervals of '//to_text(length/enough, 2)//', or a longer weakening_distance'
         end if
         call add_unresolved(unresolved, quantities_of_shear(simulation), why, remedy)
      end associate
   end subroutine check_fall

   !> Slip zones with too few nodes.
   subroutine check_slip_zones(simulation, unresolved)
      type(simulation_type), intent(in) :: simulation
      type(unresolved_type), allocatable, intent(inout) :: unresolved(:)
      character(:), allocatable :: names, text, remedy
      integer :: nodes
      real(wp) :: width, interval

      names = ''
      nodes = resolved_nodes
      width = huge(width)
      interval = contact_interval(simulation%contact%model, simulation%contact%state)
      call add_work(simulation%slip, 'dissipation largest_slip_range')
      ! The tension behind a contact depends on the root of its slip zone: without one it would have no limit.
      call add_zones(simulation%slip, 'stick_ratio peak_shear extremes'//tensions(simulation))
      ! The pressure has a maximum where the worn part of the surface ends.
      if (simulation%contact%model%scene%wear%acts()) call add_zones(simulation%slip, 'peak_pressure')
      if (.not. simulation%slip%is_coarse_now(interval)) then
         call add_edge(-1)
         call add_edge(1)
      end if
      if (simulation%cycle_count > 0) then
         associate (cycle => simulation%cycles(simulation%cycle_count))
            call add_work(cycle%slip(), 'cycle_dissipation loss_factor nonlinear_shift largest_slip_range')
            call add_work(cycle%first_slip, 'first_cycle_dissipation')
            call add_zones(cycle%loading_slip, 'stick_ratio_loading')
            ! What the slip of one half cycle does not erase remains in the other.
            call add_zones(cycle%reversal%slip, 'stick_ratio_reversal extremes stick_ratio_return permanent_stick_length')
            call add_zones(cycle%return%slip, 'stick_ratio_return stick_ratio_reversal permanent_stick_length')
         end associate
      end if
      if (names == '') return
      text = 'slip zones have only '//to_text(nodes)//trim(merge(' node ', ' nodes', nodes == 1))
      if (nodes == 0) text = 'a slip zone has no node: it is narrower than the mesh resolves'
      remedy = trim(needed_mesh(simulation%contact%model, simulation%contact%state, width, resolved_nodes))
      if (can_refine(simulation)) remedy = "refine='edges' in &mesh, or "//remedy
      call add_unresolved(unresolved, names(2:), text//' ('//to_text(width/interval, 2)//' intervals)', 'use '//remedy//' for '// &
                          to_text(resolved_nodes)//' nodes in each')

   contains

      subroutine add_work(slip, quantities)
         type(slip_record_type), intent(in) :: slip
         character(*), intent(in) :: quantities

         if (slip%is_coarse()) call add(quantities, slip%mean_nodes(), slip%mean_width())
      end subroutine add_work

      subroutine add_zones(slip, quantities)
         type(slip_record_type), intent(in) :: slip
         character(*), intent(in) :: quantities

         if (slip%is_coarse_now(interval)) then
            call add(quantities, slip%nodes_now, slip%width_now)
         else if (slip%nodes_now == 0 .and. slip%width_now > 0.0_wp) then
            ! The largest shear may be at the edge of the slip zone too.
            call add('largest_shear'//largest_tensions(simulation), 0, slip%width_now)
            if (index(quantities, 'peak_shear') > 0) call add('peak_shear', 0, slip%width_now)
         end if
      end subroutine add_zones

      !> A slip zone at an edge with too few nodes, or none, although the widest one is resolved.
      subroutine add_edge(side)
         integer, intent(in) :: side
         real(wp) :: hidden
         integer :: zone, edge

         associate (model => simulation%contact%model, state => simulation%contact%state)
            zone = nodes_at_edge(model, state, side)
            hidden = 0.0_wp
            if (simulation%slip%nodes_now > 0) hidden = hidden_width_at_edge(model, state, side)
            edge = findloc(in_contact(state%status), .true., dim=1, back=side > 0)
            if (zone > 0 .and. zone < resolved_nodes) then
               if (causes_tension(simulation, edge, side)) &
                  call add(adjustl(tensions_at_end(simulation)), zone, zone*model%width(edge))
            else if (hidden > 0.0_wp) then
               call add('stick_ratio'//tensions_at_end(simulation), 0, hidden)
            end if
         end associate
      end subroutine add_edge

      subroutine add(quantities, its_nodes, its_width)
         character(*), intent(in) :: quantities
         integer, intent(in) :: its_nodes
         real(wp), intent(in) :: its_width

         if (quantities == '') return
         if (index(names//' ', ' '//trim(quantities)//' ') == 0) names = names//' '//trim(quantities)
         nodes = min(nodes, its_nodes)
         width = min(width, its_width)
      end subroutine add
   end subroutine check_slip_zones

   !> Whether the shear at the outermost `node` of a contact causes tension beyond it, on the left (`side` -1) or right (1), in a
   !> body of which stresses are known: in that on which it points into the contact.
   logical function causes_tension(simulation, node, side)
      type(simulation_type), intent(in) :: simulation
      integer, intent(in) :: node, side

      associate (scene => simulation%contact%model%scene, shear => simulation%contact%state%fields%shear(node))
         causes_tension = merge(has_interior(scene%lower), has_interior(scene%upper), side*shear < 0.0_wp)
      end associate
   end function causes_tension

   !> Whether the mesh of a simulation could be refined at edges.
   logical function can_refine(simulation)
      type(simulation_type), intent(in) :: simulation

      associate (scene => simulation%contact%model%scene)
         can_refine = .not. (allocated(scene%mesh%ends) .or. scene%lower%is_matrix() .or. scene%is_neat() .or. &
                             needs_equal_intervals(scene))
      end associate
   end function can_refine

   !> What resolves what is narrow at an edge.
   function finer_mesh(simulation) result(remedy)
      type(simulation_type), intent(in) :: simulation
      character(len=44) :: remedy

      remedy = 'use more nodes'
      if (can_refine(simulation)) remedy = "use refine='edges' in &mesh, or more nodes"
   end function finer_mesh

   !> A largest shear at the outermost node of a patch: it lies in the last interval, where the pressure vanishes and limits it. It
   !> is resolved if it hardly changes from node to node. Nor is a largest shear resolved within few nodes of an edge that sticks
   !> now, if slip zones had too few nodes, nor one near a corner of a flat punch, where it has no limit; there its error bar
   !> says so.
   subroutine check_largest_shear(simulation, unresolved)
      type(simulation_type), intent(in) :: simulation
      type(unresolved_type), allocatable, intent(inout) :: unresolved(:)
      real(wp), parameter :: least_fall = 0.1_wp
      character(len=96) :: names
      character(:), allocatable :: remedy
      type(zone_type), allocatable :: zones(:)
      integer :: node, side, distance, inner(0:2), i

      associate (model => simulation%contact%model, state => simulation%contact%state)
         if (.not. model%tangential) return
         node = maxloc(abs(state%fields%shear), dim=1)
         zones = zones_of(in_contact(state%status))
         zones = pack(zones, zones%first <= node .and. zones%last >= node .and. abs(state%fields%shear(node)) > 0.0_wp)
         if (size(zones) == 0) return
         remedy = trim(finer_mesh(simulation))
         do side = -1, 1, 2
            distance = merge(node - zones(1)%first, zones(1)%last - node, side < 0)
            if (distance >= resolved_nodes) cycle
            associate (edge => node + side*distance)
               if (is_beyond_corner(model, model%arc(edge) + side*model%width(edge))) then
                  if (distance == 0) cycle
                  call add_unresolved(unresolved, 'peak_shear largest_shear', 'the largest shear is near a corner, x = '// &
                                      to_text(model%x(edge) + side*0.5_wp*model%width(edge), 4)//', where it has no limit', remedy)
                  return
               end if
               if (simulation%slip%is_coarse() .and. holds(state%status(edge))) then
                  call add_unresolved(unresolved, trim(merge('peak_shear largest_shear', 'peak_shear              ', &
                                                             distance == 0))//tensions_at_end(simulation), 'the largest shear '// &
                                      'is where slip zones had too few nodes, near x = '//to_text(model%x(node), 4), remedy)
                  return
               end if
            end associate
            if (distance > 0 .or. (model%repeats_beyond(node, side) .and. &
                                   in_contact(state%status(merge(1, model%nodes(), side > 0))))) cycle
            inner = [(min(max(node - side*i, 1), model%nodes()), i=0, 2)]
            associate (shear => abs(state%fields%shear(inner)))
               if (maxval(shear(:2) - shear(2:)) <= least_fall*shear(1)) cycle
            end associate
            names = 'peak_shear largest_shear'
            ! Without a sharp limit all nodes slip, most where the pressure vanishes.
            if (.not. model%scene%friction%sticks()) names = trim(names)//' largest_slip_range'
            if (causes_tension(simulation, node, side)) names = trim(names)//largest_tensions(simulation)
            call add_unresolved(unresolved, trim(names), 'the largest shear is in the outermost interval of a '// &
                                'contact, near x = '//to_text(model%x(node), 4), remedy)
            return
         end do
      end associate
   end subroutine check_largest_shear

   !> Stick zones without a node, between neighbouring nodes that slip in opposite directions, which change their number. (A maximum
   !> of the shear near the friction limit inside a stick zone is no sign of a slip zone: former edges have one on any mesh.) And
   !> stick zones with few nodes between opposite slip, in which the shear traction changes its sign: the stress along the surface
   !> would have no limit without them. The text names the first of them. Where the surfaces repeat, the ends of the mesh are
   !> neighbours.
   subroutine check_stick_zones(simulation, unresolved)
      type(simulation_type), intent(in) :: simulation
      type(unresolved_type), allocatable, intent(inout) :: unresolved(:)
      type(zone_type), allocatable :: zones(:)
      character(:), allocatable :: names
      !> The nodes, and where the surfaces repeat the first ones (`repeated`) once more; their statuses.
      integer, allocatable :: order(:), status(:)
      integer :: i, last, n, nodes, repeated

      associate (model => simulation%contact%model)
         if (.not. model%tangential .or. .not. allocated(model%scene%friction%law)) return
         n = model%nodes()
         repeated = merge(resolved_nodes + 1, 0, ends_are_neighbours(model))
         order = nodes_of(zone_type(1, n + repeated), n)
         status = simulation%contact%state%status(order)
         last = n - 1 + min(repeated, 1)
         zones = pack([(zone_type(i, i + 1), i=1, last)], slip_sign(status(:last))*slip_sign(status(2:last + 1)) < 0)
         if (size(zones) > 0) call add_unresolved(unresolved, 'stick_zones'//peaks_near(zones), 'near x = '// &
                                                 to_text(model%x(zones(1)%first), 4)//' a stick zone has no node', 'use more nodes')
         zones = zones_of(holds(status))
         zones = pack(zones, [(is_narrow_stick_zone(status, zones(i)) .and. zones(i)%first <= n + 1, i=1, size(zones))])
         names = adjustl(trim(largest_tensions(simulation))//peaks_near(zones))
         if (size(zones) > 0 .and. names /= '') then
            nodes = zones(1)%last - zones(1)%first + 1
            call add_unresolved(unresolved, names, 'near x = '//to_text(model%x(order(zones(1)%first)), 4)// &
                                ' a stick zone between opposite slip has only '//to_text(nodes)// &
                                trim(merge(' node ', ' nodes', nodes == 1)), 'use more nodes')
         end if
         call check_jumps()
         call check_narrow_zones()
      end associate

   contains

      !> Where slip was opposite and one side sticks now, the shear still changes its sign within a node or two: without the stick
      !> zone that was there the tension has no limit.
      subroutine check_jumps()
         real(wp), parameter :: nearly = 0.5_wp
         integer, parameter :: reach = 2
         integer :: node, next

         names = adjustl(largest_tensions(simulation))
         if (names == '') return
         associate (model => simulation%contact%model, state => simulation%contact%state)
            associate (limit => model%static_friction(order)*state%fields%pressure(order), shear => state%fields%shear(order))
               do node = 1, n
                  do next = node + 1, min(node + reach, size(order))
                     if (.not. all(in_contact(status(node:next))) .or. shear(node)*shear(next) >= 0.0_wp) cycle
                     if (abs(shear(node)) < nearly*limit(node) .or. abs(shear(next)) < nearly*limit(next)) cycle
                     call add_unresolved(unresolved, names, 'near x = '//to_text(model%x(node), 4)//' the shear changes its '// &
                                         'sign within '//to_text(next - node)//trim(merge(' interval ', ' intervals', &
                                                                                          next == node + 1)), 'use more nodes')
                     return
                  end do
               end do
            end associate
         end associate
      end subroutine check_jumps

      !> Of several stick zones those with one or two nodes, and slip zones between them with so few, may not be there on another
      !> mesh.
      subroutine check_narrow_zones()
         integer, parameter :: most = 2
         logical, allocatable :: narrow(:), touching(:)
         character(:), allocatable :: text

         associate (model => simulation%contact%model)
            zones = zones_of(held(simulation%contact%model, simulation%contact%state))
            ! What ends with the mesh may go on at its other end.
            narrow = zones%last - zones%first < most .and. zones%first > 1 .and. zones%last < model%nodes()
            if (size(zones) < 2) return
            if (any(narrow)) then
               names = 'stick_zones'
               if (narrow(1)) names = names//' stick_left left_slip_zone'
               if (narrow(size(zones))) names = names//' stick_right right_slip_zone'
               text = to_text(count(narrow))//' of '//to_text(size(zones))//' stick zones '// &
                      trim(merge('has ', 'have', count(narrow) == 1))//' only one or two nodes'
               if (count(narrow) > 1) text = text//', the first'
               text = text//' near x = '//to_text(model%x(zones(findloc(narrow, .true., dim=1))%first), 4)
               call add_unresolved(unresolved, names, text, trim(merge('beside a worn edge they depend on the mesh', &
                                                                       'use more nodes                            ', &
                                                                       model%scene%wear%acts())))
               return
            end if
            touching = in_contact(simulation%contact%state%status)
            do i = 2, size(zones)
               if (zones(i)%first - zones(i - 1)%last > most + 1) cycle
               if (.not. all(touching(zones(i - 1)%last:zones(i)%first))) cycle
               call add_unresolved(unresolved, 'stick_zones', 'the slip zone near x = '//to_text(model%x(zones(i)%first), 4)// &
                                   ' between stick zones has only one or two nodes', 'use more nodes')
               return
            end do
         end associate
      end subroutine check_narrow_zones

      !> Names of the peaks, after blanks, if the pressure is largest in or next to one of the zones: with full coupling the jump of
      !> the shear gives the pressure a logarithm there.
      function peaks_near(zones) result(names)
         type(zone_type), intent(in) :: zones(:)
         character(len=25) :: names
         integer :: peaks(3), image

         names = ''
         if (.not. simulation%contact%model%compliance%elastic_block(block_wt)) return
         peaks = maxloc(simulation%contact%state%fields%pressure, dim=1) + n*[0, -1, 1]
         do image = 1, merge(3, 1, repeated > 0)
            if (any(zones%first <= peaks(image) + 1 .and. zones%last >= peaks(image) - 1)) names = ' peak_pressure peak_shear'
         end do
      end function peaks_near
   end subroutine check_stick_zones

   !> Slip that vanishes from cycle to cycle: whether nodes at their friction limit still slip a little is a matter of the mesh.
   subroutine check_shakedown(simulation, unresolved)
      type(simulation_type), intent(in) :: simulation
      type(unresolved_type), allocatable, intent(inout) :: unresolved(:)
      real(wp), parameter :: least_part = 1.0e-4_wp
      character(len=160) :: names

      if (simulation%cycle_count == 0) return
      associate (cycle => simulation%cycles(simulation%cycle_count))
         if (cycle%dissipation() >= least_part*cycle%first_dissipation) return
         if (.not. cycle%first_dissipation > certified*size_of_works()) return
         names = 'largest_slip_range stick_ratio_reversal smallest_stick_ratio permanent_stick_length'
         if (cycle%dissipation() > 0.0_wp) names = trim(names)//' stick_ratio stick_ratio_return largest_stick_ratio'
         call add_unresolved(unresolved, trim(names), 'the slip vanishes from cycle to cycle: the last one dissipates '// &
                             to_text(cycle%dissipation()/cycle%first_dissipation, 2)//' of the first one', &
                             'whether nodes still slip depends on the mesh')
      end associate

   contains

      !> The largest traction over the contact times the largest motion, force: nothing slips where the work of friction is
      !> round-off of this.
      real(wp) function size_of_works()
         associate (path => simulation%contact, motion => simulation%contact%state%fields%motion)
            size_of_works = path%certificate%traction_scale*sum(path%model%width, mask=in_contact(path%state%status)) &
                            *maxval(abs(motion([motion_approach, motion_shift, motion_interference])))
         end associate
      end function size_of_works
   end subroutine check_shakedown

   !> A dissipation that large increments do not know to the accuracy asked for, since their errors are compared with what a cycle
   !> dissipates: that of a press during which nearly all nodes stick.
   subroutine check_increments(simulation, unresolved)
      type(simulation_type), intent(in) :: simulation
      type(unresolved_type), allocatable, intent(inout) :: unresolved(:)
      real(wp), parameter :: most = 3.0_wp
      real(wp) :: work

      associate (contact => simulation%contact)
         work = max(contact%state%dissipation - contact%state%skipped_dissipation, tiny(work))
         if (.not. contact%certificate%dissipation_error > most*contact%model%scene%method%accuracy*work) return
         call add_unresolved(unresolved, 'dissipation', 'the dissipation is next to nothing: large increments find it with an '// &
                             'estimated error of '//to_text(100.0_wp*min(contact%certificate%dissipation_error/work, 1.0_wp), 2)// &
                             ' %', "use a smaller accuracy, or stepping='event'")
      end associate
   end subroutine check_increments

   !> Creepage, a mean over some intervals, while it changes.
   subroutine check_rolling(simulation, unresolved)
      type(simulation_type), intent(in) :: simulation
      type(unresolved_type), allocatable, intent(inout) :: unresolved(:)

      associate (contact => simulation%contact)
         if (ieee_is_nan(contact%rolling%creepage()) .or. contact%rolling%is_steady(contact%half_width())) return
         call add_unresolved(unresolved, 'creepage', 'rolled by less than twice the contact length under constant forces: '// &
                             'the creepage still changes within the intervals of its mean', 'roll farther')
      end associate
   end subroutine check_rolling

   !> Wear mostly by cycles that change the pressures too much: the shape, and with it the tractions, are then as uncertain as it.
   !> Nothing worn by a changing shear, which always makes the edges of a contact slip: wear widens these zones from cycle to cycle.
   !> And a worn part that ends within few intervals at a large pressure.
   subroutine check_worn_shape(simulation, unresolved)
      type(simulation_type), intent(in) :: simulation
      type(unresolved_type), allocatable, intent(inout) :: unresolved(:)
      real(wp), parameter :: most = 0.5_wp, sharp = 0.05_wp
      character(:), allocatable :: remedy

      associate (model => simulation%contact%model, state => simulation%contact%state)
         if (.not. model%scene%wear%acts() .or. simulation%cycle_count == 0) return
         if (state%coarsely_worn > most*model%force(state%worn)) &
            call add_unresolved(unresolved, 'peak_pressure peak_shear stick_ratio extremes worn_area wear_depth'// &
                                tensions(simulation), 'most of the wear is from cycles that each change the pressures by '// &
                                'much', 'use a smaller coefficient and more cycles')
         if (simulation%cycles(simulation%cycle_count)%is_sheared() .and. .not. any(state%worn > 0.0_wp)) &
            call add_unresolved(unresolved, 'peak_pressure peak_shear stick_ratio extremes dissipation cycle_dissipation '// &
                                'worn_area wear_depth left_corner_intensity right_corner_intensity'//tensions(simulation), &
                                'no node slips in a cycle: what slips, and wears, at the edges is narrower than the mesh', &
                                trim(finer_mesh(simulation)))
         call check_worn_edges()
         if (.not. pressure_at_worn_kink(model, state) > sharp*maxval(state%fields%pressure)) return
         remedy = 'use more nodes'
         ! A scar is under a nearly uniform pressure up to its ends (docs/theory.md, wear).
         if (simulation%cycles(simulation%cycle_count)%permanent_stick_length() <= 0.0_wp) &
            remedy = 'in gross slip it does on any mesh; worn_area, wear_depth and contact_half_width are resolved'
         call add_unresolved(unresolved, 'peak_pressure peak_shear stick_ratio_reversal stick_ratio_return extremes'// &
                             tensions(simulation), 'the worn part of the surface ends within few intervals where the '// &
                             'pressure is large', remedy)
      end associate

   contains

      !> Where the outermost node is worn, the pressure is flat up to a new edge, and no root over some intervals.
      subroutine check_worn_edges()
         !> Intensities, the slip zone by them, and how far they hold.
         integer, parameter :: of_root(4) = [1, 2, 4, 5]
         character(:), allocatable :: names
         integer :: side, edge, i

         names = ''
         associate (state => simulation%contact%state)
            do side = 1, 2
               edge = findloc(in_contact(state%status), .true., dim=1, back=side == 2)
               if (edge == 0) return
               if (.not. state%worn(edge) > 0.0_wp) cycle
               do i = 1, size(of_root)
                  names = names//' '//trim(merge('left_ ', 'right_', side == 1))//trim(edge_quantities(of_root(i)))
               end do
            end do
         end associate
         if (names /= '') call add_unresolved(unresolved, names(2:), 'the surface is worn up to the edge of the contact, where '// &
                                              'the pressure is no root any more', 'fields of edges describe unworn ones')
      end subroutine check_worn_edges
   end subroutine check_worn_shape

   !> Pressure that the sharpest bend of the worn depth adds, force/length^2, where the pressure is large: m J/pi by a jump J of the
   !> slope from one interval to the next, as for a profile (see mfv_profile_sampling). It is small if the mesh resolves the bend.
   real(wp) function pressure_at_worn_kink(model, state) result(added)
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: state
      real(wp), parameter :: near_largest = 0.7_wp
      real(wp) :: slope(model%nodes() - 1)
      logical :: touching(model%nodes())
      integer :: node

      slope = (state%worn(2:) - state%worn(:model%nodes() - 1))/(model%arc(2:) - model%arc(:model%nodes() - 1))
      touching = in_contact(state%status)
      added = 0.0_wp
      do node = 2, model%nodes() - 1
     if (.not. all(touching(node - 1:node + 1)) .or. state%fields%pressure(node) < near_largest*maxval(state%fields%pressure)) cycle
         added = max(added, model%compliance%modulus*abs(slope(node) - slope(node - 1))/pi)
      end do
   end function pressure_at_worn_kink

end module mfv_resolution
