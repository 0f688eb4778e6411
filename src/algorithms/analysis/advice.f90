!> Advice: number of nodes and linear solver for a given error. Pairs of coarse meshes of the scene, of m and 3 m intervals
!> with common nodes, give the constants c of the error laws c/nodes^order of the tractions (l2 norm over the nodes), of the
!> half-width and the stick ratio between nodes and of the dissipation. It also depends on the width of the slip zones
!> (mfv_slip_zones), and edges are uncertain by a part of an interval. Solver costs follow from laws with measured constants.
module mfv_advice
   use mfv_discretisation_error
   use mfv_kinds, only: wp
   use mfv_node_status, only: in_contact
   use mfv_observables, only: error_edges, error_place, error_stick
   use mfv_observer, only: observer_type, relay_type
   use mfv_profile_sampling, only: negligible_pressure
   use mfv_resolution, only: poorest_patch, refinement_for_layers, undersampling
   use mfv_scene
   use mfv_simulation, only: history_none, new_simulation, simulation_type, states_steps
   use mfv_slip_zones, only: largest_resolved_error
   use mfv_solver_costs, only: cheapest_solver, seconds_of_solve
   use mfv_status, only: MFV_COMPLETE, MFV_INPUT_ERROR, status_outcome
   use mfv_strings, only: to_text
   use mfv_zone_edges, only: find_zone_edges, zone_edges_type, zone_type, zones_of
   implicit none
   private
   public :: advice_type, advise, advice_names, advice_count, advice_pressure, advice_shear, advice_half_width, &
             advice_stick_ratio, advice_dissipation, cheapest_solver, seconds_of_solve

   !> Quantities: tractions relative in the l2 norm; half-width and dissipation relative; stick ratio absolute, that is,
   !> relative to the contact.
   integer, parameter :: advice_pressure = 1, advice_shear = 2, advice_half_width = 3, advice_stick_ratio = 4, &
                         advice_dissipation = 5, advice_count = 5
   character(*), parameter :: advice_names(advice_count) = [character(11) :: 'pressure', 'shear', 'half_width', 'stick_ratio', &
                                                                                                                      'dissipation']
   !> Orders of convergence (docs/verification.md), and safety factors.
   real(wp), parameter :: order(advice_count) = [1.0_wp, 1.0_wp, 1.0_wp, 1.0_wp, 2.0_wp]
   real(wp), parameter :: safety(advice_count) = [2.0_wp, 2.0_wp, 1.4_wp, 1.4_wp, 2.0_wp]
   !> Safety factor on the error by the width of slip zones: an upper bound, but from coarse meshes.
   real(wp), parameter :: slip_safety = 1.5_wp
   !> Largest &mesh nodes that are advised.
   integer, parameter :: most_nodes = 100000
   !> Approximate numbers of nodes in contact on the coarse meshes.
   integer, parameter :: pair_nodes(8) = [13, 15, 17, 19, 21, 23, 25, 27]
   !> Number of pairs where more nodes are needed, for several contact patches.
   integer, parameter :: pairs_of_patches = 3
   !> Nodes in contact that the pilot mesh needs, in each patch of several; most &mesh nodes of coarse meshes; and the minimum for
   !> any mesh.
   integer, parameter :: fewest_pilot_nodes = 8, fewest_pilot_patch = 4, most_coarse_nodes = 40000, fewest_nodes = 30
   !> Largest difference between the meshes of a pair that is one of converging results: pressure, half-width.
   real(wp), parameter :: largest_difference = 0.5_wp

   character(*), parameter :: too_few = 'a contact patch has too few nodes, or the profile more points than nodes'

   !> Relative residual of an iterative solver over the given error; at least the default.
   real(wp), parameter :: tolerance_part = 1.0e-3_wp
   !> Tolerance of large increments over the given error: their error is proportional to it.
   real(wp), parameter :: accuracy_part = 0.1_wp

   type :: advice_type
      !> Status (see mfv_status), and why there is no advice; empty with advice.
      integer :: status = MFV_COMPLETE
      character(:), allocatable :: message
      real(wp) :: wanted_error = 0.0_wp
      !> &mesh nodes and nodes in contact that the given error needs; and the scene's own numbers.
      integer :: nodes = 0, contact_nodes = 0, present_nodes = 0
      !> Whether the scene has the quantity; its predicted error with the scene's own nodes, and the nodes in contact that the
      !> given error needs.
      logical :: known(advice_count) = .false.
      real(wp) :: present_error(advice_count) = 0.0_wp, needed_nodes(advice_count) = 0.0_wp
      !> &mesh nodes of the coarser mesh of each pair.
      integer, allocatable :: pair_nodes(:)
      !> See method_type.
      integer :: linear_solver = solver_auto
      real(wp) :: linear_tolerance = 0.0_wp, friction_tolerance = 0.0_wp, accuracy = 0.0_wp
      !> Approximate number of linear solves and seconds of the run.
      real(wp) :: solves = 0.0_wp, seconds = 0.0_wp
      !> Linear solves on the finest of the coarse meshes, of &mesh nodes `tried_nodes`, by events and by large increments; 0:
      !> not tried.
      integer :: tried_nodes = 0, event_solves = 0, increment_solves = 0
   end type advice_type

   !> Sums of the squared constants c of the error laws c/nodes^order, nodes in contact; shape (advice_count).
   type :: law_type
      real(wp) :: squares(advice_count) = 0.0_wp
      !> Nodes in contact over &mesh nodes. Linear solves with `nodes` nodes in contact, and their exponent of growth with the
      !> nodes.
      real(wp) :: density = 0.0_wp, solves = 0.0_wp, nodes = 1.0_wp, growth = 0.0_wp
      !> Nodes in contact that resolve the layers, as the warnings of a run ask for.
      real(wp) :: layer_nodes = 0.0_wp
      logical :: known(advice_count) = .false.
      !> Number of pairs, and of those that both resolve the slip zones; sum over the pairs of the squared nodes in contact
      !> for which the width of the slip zones predicts an error 1 of the dissipation.
      integer :: pairs = 0, resolved_pairs = 0
      real(wp) :: slip_law = 0.0_wp
      !> Why the pairs do not show convergence; empty if they do.
      character(:), allocatable :: doubt
   end type law_type

contains

   !> Nodes and solver for the error `wanted_error`, between 0 and 1, in the quantities `wanted`, shape (advice_count).
   !> `observer` monitors the runs on coarse meshes and can stop them.
   subroutine advise(scene, wanted_error, wanted, advice, observer)
      type(scene_type), intent(in) :: scene
      real(wp), intent(in) :: wanted_error
      logical, intent(in) :: wanted(:)
      type(advice_type), intent(out) :: advice
      class(observer_type), intent(inout), target, optional :: observer
      type(relay_type) :: watch
      type(law_type) :: law

      advice%message = ''
      advice%wanted_error = wanted_error
      advice%present_nodes = scene%mesh%nodes
      call refuse_fixed_meshes(scene, advice)
      if (advice%message /= '') return
      watch%runs = 2*size(pair_nodes) + 2
      if (present(observer)) watch%caller => observer
      call measure(scene, law, advice, watch)
      if (advice%message /= '') return
      advice%known = law%known .and. wanted
      if (.not. any(advice%known)) then
         advice%status = MFV_INPUT_ERROR
         advice%message = 'the case has none of the quantities asked for'
         return
      end if
      call choose_nodes(scene, law, advice)
      if (advice%message /= '') return
      call choose_solver(scene, law, advice)
   end subroutine advise

   !> Scenes whose mesh is fixed.
   subroutine refuse_fixed_meshes(scene, advice)
      type(scene_type), intent(in) :: scene
      type(advice_type), intent(inout) :: advice

      if (.not. has_coarser_meshes(scene)) then
         advice%message = "a body with shape='matrix' has a fixed mesh"
      else if (allocated(scene%mesh%ends)) then
         advice%message = 'ends in &mesh fix the mesh'
      else if (allocated(scene%friction%static%value) .and. .not. allocated(scene%friction%static%position)) then
         if (size(scene%friction%static%value) > 1) &
            advice%message = 'the coefficient of friction is given by one value per node; give it by mu_file, which suits any mesh'
      end if
      if (advice%message /= '') advice%status = MFV_INPUT_ERROR
   end subroutine refuse_fixed_meshes

   !> Solve the pairs of coarse meshes.
   subroutine measure(scene, law, advice, watch)
      type(scene_type), intent(in) :: scene
      type(law_type), intent(out) :: law
      type(advice_type), intent(inout) :: advice
      type(relay_type), intent(inout) :: watch
      real(wp), parameter :: finer = 3.0_wp
      type(simulation_type) :: pilot, coarse, fine
      real(wp) :: scale
      integer :: nodes

      allocate (advice%pair_nodes(0))
      call solve_pilot(scene, pilot, nodes, advice, watch)
      if (advice%message /= '') return
      law%density = real(pilot%contact%state%contact_nodes(), wp)/nodes
      scale = 1.0_wp
      if (patches_of(pilot) > 1) scale = real(pilot%contact%state%contact_nodes(), wp)/minval(pair_nodes)
      do
         call measure_pairs(scene, scale, pilot, law, coarse, fine, advice, watch)
         if (advice%message /= '' .or. law%doubt == '') exit
         scale = finer*scale
         if (3*scale*pair_nodes(pairs_of_patches)/law%density <= most_coarse_nodes) cycle
         advice%status = MFV_INPUT_ERROR
         advice%message = 'no convergence up to '//to_text(3*advice%pair_nodes(size(advice%pair_nodes)))//' nodes: '//law%doubt
         exit
      end do
      if (advice%message /= '') return
      if (law%pairs == 0) then
         advice%status = MFV_INPUT_ERROR
         advice%message = "kernel='fourier': no coarser mesh divides the circle into whole intervals"
         return
      end if
      law%squares(advice_dissipation) = law%squares(advice_dissipation)*law%pairs/max(law%resolved_pairs, 1)
      law%squares = law%squares/law%pairs
      law%squares(advice_dissipation) = max(law%squares(advice_dissipation), &
                                            (slip_safety*law%slip_law/(law%pairs*safety(advice_dissipation)))**2)
      law%density = real(fine%contact%state%contact_nodes(), wp)/(3*advice%pair_nodes(size(advice%pair_nodes)))
      law%nodes = max(fine%contact%state%contact_nodes(), 1)
      law%layer_nodes = refinement_for_layers(fine)*law%nodes
      law%solves = max(fine%contact%system%solves, 1)
      law%growth = max(log(law%solves/max(coarse%contact%system%solves, 1))/log(3.0_wp), 0.0_wp)
      call add_interval_laws(law, fine)
      call try_large_increments(scene, fine, pilot, advice, watch)
   end subroutine measure

   !> Solve pairs of meshes with `scale` times the usual nodes in contact, and add their differences to new laws. `coarse`, `fine`:
   !> the last pair.
   subroutine measure_pairs(scene, scale, pilot, law, coarse, fine, advice, watch)
      type(scene_type), intent(in) :: scene
      real(wp), intent(in) :: scale
      type(simulation_type), intent(in) :: pilot
      type(law_type), intent(inout) :: law
      type(simulation_type), intent(out) :: coarse, fine
      type(advice_type), intent(inout) :: advice
      type(relay_type), intent(inout) :: watch
      integer :: i, nodes

      law = law_type(density=law%density, doubt='')
      advice%pair_nodes = [integer ::]
      do i = 1, merge(pairs_of_patches, size(pair_nodes), scale > 1.0_wp)
         nodes = nearest_mesh(scene, scale*pair_nodes(i)/law%density)
         if (nodes == 0 .or. any(advice%pair_nodes == nodes)) cycle
         call solve(scene, nodes, pilot, coarse, advice, watch)
         if (advice%message == '') call solve(scene, 3*nodes, pilot, fine, advice, watch)
         if (advice%message /= '') return
         advice%pair_nodes = [advice%pair_nodes, nodes]
         call add_pair(law, coarse, fine)
         if (law%doubt /= '') return
      end do
   end subroutine measure_pairs

   !> A coarse mesh with enough nodes in contact to predict their number on any other mesh.
   subroutine solve_pilot(scene, pilot, nodes, advice, watch)
      type(scene_type), intent(in) :: scene
      type(simulation_type), intent(out) :: pilot
      integer, intent(out) :: nodes
      type(advice_type), intent(inout) :: advice
      type(relay_type), intent(inout) :: watch
      integer, parameter :: first = 30, attempts = 12
      integer :: attempt, contact

      nodes = 0
      contact = 0
      do attempt = 1, attempts
         nodes = nearest_mesh(scene, real(merge(first, nodes*max(2, 2*fewest_pilot_nodes/max(contact, 1)), attempt == 1), wp))
         if (nodes == 0) exit
         pilot = new_simulation(scene_on_mesh(scene, nodes), history_none)
         call pilot%run(watch)
         contact = pilot%contact%state%contact_nodes()
         if (watch%ended) exit
         if (pilot%outcome == MFV_COMPLETE .and. contact >= fewest_pilot_nodes .and. resolves_patches(pilot)) return
         if (pilot%outcome /= MFV_COMPLETE .and. attempt > 2 .or. 3*nodes > most_coarse_nodes) exit
      end do
      advice%status = pilot%outcome
      if (advice%status == MFV_COMPLETE) advice%status = MFV_INPUT_ERROR
      advice%message = 'on a mesh of '//to_text(nodes)//' nodes: '//status_outcome(pilot%outcome)//', '//to_text(contact)// &
                       ' nodes in contact'
      if (pilot%outcome == MFV_COMPLETE .and. contact >= fewest_pilot_nodes) &
         advice%message = 'no convergence up to '//to_text(nodes)//' nodes: '//too_few
   end subroutine solve_pilot

   !> Whether every contact patch that matters has some nodes, and the mesh misses nothing of a profile.
   logical function resolves_patches(simulation)
      type(simulation_type), intent(in) :: simulation
      type(zone_type) :: patch
      real(wp) :: part(2)
      integer :: points

      patch = poorest_patch(simulation)
      call undersampling(simulation, .false., part(1), points)
      call undersampling(simulation, .true., part(2), points)
      resolves_patches = patch%last - patch%first >= fewest_pilot_patch .and. all(part <= negligible_pressure)
   end function resolves_patches

   !> Number of contact patches.
   integer function patches_of(simulation)
      type(simulation_type), intent(in) :: simulation

      patches_of = size(zones_of(in_contact(simulation%contact%state%status)))
   end function patches_of

   !> Solve a scene on `nodes` intervals, with the cycles of the pilot.
   subroutine solve(scene, nodes, pilot, simulation, advice, watch)
      type(scene_type), intent(in) :: scene
      integer, intent(in) :: nodes
      type(simulation_type), intent(in) :: pilot
      type(simulation_type), intent(out) :: simulation
      type(advice_type), intent(inout) :: advice
      type(relay_type), intent(inout) :: watch
      type(scene_type) :: other

      other = scene_on_mesh(scene, nodes)
      call fix_cycles(other, pilot)
      simulation = new_simulation(other, history_none, states_steps)
      watch%before = watch%before + 1
      call simulation%run(watch)
      if (simulation%outcome == MFV_COMPLETE) return
      advice%status = simulation%outcome
      advice%message = 'on a mesh of '//to_text(nodes)//' nodes: '//status_outcome(simulation%outcome)
   end subroutine solve

   !> Compare the number of solves by large increments with that by events, on the finest of the coarse meshes, with Coulomb
   !> friction.
   subroutine try_large_increments(scene, fine, pilot, advice, watch)
      type(scene_type), intent(in) :: scene
      type(simulation_type), intent(in) :: fine, pilot
      type(advice_type), intent(inout) :: advice
      type(relay_type), intent(inout) :: watch
      type(advice_type) :: trial
      type(scene_type) :: large
      type(simulation_type) :: simulation

      if (scene%method%algorithm /= algorithm_mfv .or. all(scene%method%stepping /= [stepping_auto, stepping_event])) return
      if (.not. scene%friction%is_proportional() .or. .not. scene%tangential()) return
      large = scene
      large%method%stepping = stepping_leap
      large%method%accuracy = accuracy_part*advice%wanted_error
      advice%tried_nodes = 3*advice%pair_nodes(size(advice%pair_nodes))
      trial%message = ''
      call solve(large, advice%tried_nodes, pilot, simulation, trial, watch)
      if (trial%message /= '') return
      advice%event_solves = fine%contact%system%solves
      advice%increment_solves = simulation%contact%system%solves
   end subroutine try_large_increments

   !> Add the error laws of tractions and dissipation from a pair of meshes.
   subroutine add_pair(law, coarse, fine)
      type(law_type), intent(inout) :: law
      type(simulation_type), intent(in) :: coarse, fine
      real(wp) :: difference(advice_count)
      type(zone_edges_type) :: on_coarse, on_fine
      integer, allocatable :: place(:)
      integer :: nodes

      nodes = coarse%contact%state%contact_nodes()
      associate (on => coarse%contact%model, over => fine%contact%model, a => coarse%contact%state, b => fine%contact%state)
         place = nint((on%arc - over%arc(1))/over%interval()) + 1
         difference = 0.0_wp
         call find_zone_edges(on, a, on_coarse)
         call find_zone_edges(over, b, on_fine)
         difference(advice_pressure) = distance(a%fields%pressure, b%fields%pressure, place)
         difference(advice_half_width) = abs(on_coarse%contact_length/on_fine%contact_length - 1.0_wp)
         law%known([advice_pressure, advice_half_width]) = .true.
         if (on%tangential) then
            law%known(advice_stick_ratio) = .true.
            difference(advice_stick_ratio) = abs(on_coarse%stick_ratio() - on_fine%stick_ratio())
            law%known(advice_shear) = any(abs(b%fields%shear) > 0.0_wp)
            law%known(advice_dissipation) = fine%slip%work > 0.0_wp
            difference(advice_shear) = distance(a%fields%shear, b%fields%shear, place)
            if (law%known(advice_dissipation) .and. .not. (coarse%slip%is_coarse() .or. fine%slip%is_coarse())) then
               difference(advice_dissipation) = abs(a%dissipation/b%dissipation - 1.0_wp)
               law%resolved_pairs = law%resolved_pairs + 1
            end if
            law%slip_law = law%slip_law + fine%slip%error_number()*sum(over%width, mask=in_contact(b%status))**2
         end if
      end associate
      if (patches_of(coarse) /= patches_of(fine)) then
         law%doubt = 'the number of contact patches depends on the mesh'
      else if (.not. resolves_patches(coarse)) then
         law%doubt = too_few
      else if (any(difference([advice_pressure, advice_half_width]) > largest_difference)) then
         law%doubt = 'pressures or contact lengths depend on the mesh'
      end if
      law%squares = law%squares + (difference*real(nodes, wp)**order)**2
      law%pairs = law%pairs + 1
   end subroutine add_pair

   !> Relative l2 distance of coarse tractions from fine ones; `place`: indices of the coarse nodes among the fine ones;
   !> tractions are zero outside.
   pure real(wp) function distance(coarse, fine, place)
      real(wp), intent(in) :: coarse(:), fine(:)
      integer, intent(in) :: place(:)
      real(wp) :: there(size(place))
      integer :: i

      there = 0.0_wp
      do i = 1, size(place)
         if (place(i) >= 1 .and. place(i) <= size(fine)) there(i) = fine(place(i))
      end do
      distance = 0.0_wp
      if (norm2(there) > 0.0_wp) distance = norm2(coarse - there)/norm2(there)
   end function distance

   !> Edges are uncertain by a part of an interval.
   subroutine add_interval_laws(law, fine)
      type(law_type), intent(inout) :: law
      type(simulation_type), intent(in) :: fine
      real(wp) :: allowances(0:error_place)
      type(zone_edges_type) :: edges
      integer :: nodes

      allowances = allowances_of_behaviours(fine, fine%contact%state)
      call find_zone_edges(fine%contact%model, fine%contact%state, edges)
      nodes = fine%contact%state%contact_nodes()
      associate (half_width => law%squares(advice_half_width), stick_ratio => law%squares(advice_stick_ratio))
         half_width = max(half_width, (nodes*allowances(error_edges)/max(0.5_wp*edges%contact_length, tiny(1.0_wp)))**2)
         stick_ratio = max(stick_ratio, (nodes*allowances(error_stick))**2)
      end associate
   end subroutine add_interval_laws

   !> Number of nodes from the error laws.
   subroutine choose_nodes(scene, law, advice)
      type(scene_type), intent(in) :: scene
      type(law_type), intent(in) :: law
      type(advice_type), intent(inout) :: advice
      real(wp) :: coefficient(advice_count), error(advice_count)
      integer :: hardest

      coefficient = safety*sqrt(law%squares)
      error = advice%wanted_error
      if (law%slip_law > 0.0_wp) error(advice_dissipation) = min(advice%wanted_error, largest_resolved_error)
      advice%needed_nodes = (coefficient/error)**(1.0_wp/order)
      advice%present_error = coefficient/(scene%mesh%nodes*law%density)**order
      hardest = maxloc(advice%needed_nodes, dim=1, mask=advice%known)
      if (advice%needed_nodes(hardest) > most_nodes*law%density) then
         advice%status = MFV_INPUT_ERROR
         advice%message = trim(advice_names(hardest))//' needs about '//to_text(advice%needed_nodes(hardest)/law%density, 2)// &
                          ' nodes, more than the limit of '//to_text(most_nodes)
         if (hardest == advice_dissipation) &
            advice%message = advice%message//', because its slip zones are much narrower than the contact'
         return
      end if
      if (law%layer_nodes > most_nodes*law%density) then
         advice%status = MFV_INPUT_ERROR
         advice%message = 'the layers need about '//to_text(law%layer_nodes/law%density, 2)// &
                          ' nodes, more than the limit of '//to_text(most_nodes)
         return
      end if
      advice%contact_nodes = ceiling(max(maxval(advice%needed_nodes, mask=advice%known), real(fewest_nodes, wp), law%layer_nodes))
      advice%nodes = mesh_of_at_least(scene, advice%contact_nodes/law%density)
      advice%contact_nodes = nint(advice%nodes*law%density)
   end subroutine choose_nodes

   !> Smallest number of intervals not below `wanted`, of the parity of the scene's, that fits the circle of a Fourier series;
   !> if none fits, the next one of this parity.
   integer function mesh_of_at_least(scene, wanted) result(nodes)
      type(scene_type), intent(in) :: scene
      real(wp), intent(in) :: wanted
      integer :: more

      do more = 0, max(ceiling(wanted), 4)
         nodes = nearest_mesh(scene, wanted + more)
         if (nodes >= wanted) return
      end do
      nodes = ceiling(wanted)
   end function mesh_of_at_least

   !> Linear solver, tolerances and cost.
   subroutine choose_solver(scene, law, advice)
      type(scene_type), intent(in) :: scene
      type(law_type), intent(in) :: law
      type(advice_type), intent(inout) :: advice
      type(method_type) :: usual
      real(wp) :: unknowns

      unknowns = real(advice%contact_nodes, wp)*merge(2, 1, scene%tangential())
      advice%linear_solver = cheapest_solver(unknowns)
      advice%linear_tolerance = max(tolerance_part*advice%wanted_error, usual%linear_tolerance)
      advice%accuracy = accuracy_part*advice%wanted_error
      advice%friction_tolerance = min(friction_tolerance_part*advice%wanted_error, scene%method%allowed_in_friction())
      advice%solves = law%solves*(advice%contact_nodes/law%nodes)**law%growth
      advice%seconds = advice%solves*seconds_of_solve(advice%linear_solver, unknowns)
   end subroutine choose_solver

end module mfv_advice
