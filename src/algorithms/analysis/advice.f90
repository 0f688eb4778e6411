!> How many nodes, and which linear solver, a scene needs for a wanted error. Pairs of coarse meshes of the scene itself, of
!> m and 3 m intervals, whose nodes lie in the same places, tell the size c of the errors c/nodes^order of the tractions
!> (l2, over the nodes) and of the dissipation; the width of the intervals that of half-width and stick ratio, and the width of
!> the slip zones that of the dissipation too (mfv_slip_zones). What a solver costs comes from laws with measured constants.
module mfv_advice
   use mfv_discretisation_error
   use mfv_error_bar, only: quantity_count, quantity_half_width, quantity_stick_ratio
   use mfv_kinds, only: wp
   use mfv_node_status, only: in_contact
   use mfv_observer, only: observer_type, relay_type
   use mfv_scene
   use mfv_simulation, only: history_none, new_simulation, simulation_type, states_steps
   use mfv_slip_zones, only: largest_resolved_error
   use mfv_solver_costs, only: cheapest_solver, seconds_of_solve
   use mfv_status, only: MFV_COMPLETE, MFV_INPUT_ERROR, status_outcome
   use mfv_strings, only: to_text
   implicit none
   private
   public :: advice_type, advise, advice_names, advice_count, advice_pressure, advice_shear, advice_half_width, &
             advice_stick_ratio, advice_dissipation, cheapest_solver, seconds_of_solve

   !> Quantities that can be wanted: the tractions in the l2 norm relative to their own; half-width and dissipation
   !> relative; the stick ratio as it is, that is in parts of the contact.
   integer, parameter :: advice_pressure = 1, advice_shear = 2, advice_half_width = 3, advice_stick_ratio = 4, &
                         advice_dissipation = 5, advice_count = 5
   character(*), parameter :: advice_names(advice_count) = [character(11) :: 'pressure', 'shear', 'half_width', 'stick_ratio', &
                                                                                                                      'dissipation']
   !> Orders of convergence, docs/verification.md, and safety factors on the errors: of what comes from pairs of meshes, and of
   !> half an interval at either edge.
   real(wp), parameter :: order(advice_count) = [1.0_wp, 1.0_wp, 1.0_wp, 1.0_wp, 2.0_wp]
   real(wp), parameter :: safety(advice_count) = [2.0_wp, 2.0_wp, 1.4_wp, 1.4_wp, 2.0_wp]
   !> Safety on the error by the width of slip zones, which is an upper bound but comes from coarse meshes.
   real(wp), parameter :: slip_safety = 1.5_wp
   !> &mesh nodes that can be advised.
   integer, parameter :: most_nodes = 100000
   !> Nodes in contact that the coarse meshes of the pairs should have, about.
   integer, parameter :: pair_nodes(8) = [13, 15, 17, 19, 21, 23, 25, 27]
   !> Nodes in contact that a first mesh must have, to tell how many nodes the pairs need; and that a mesh should have at
   !> least.
   integer, parameter :: fewest_pilot_nodes = 8, fewest_nodes = 10

   !> Relative residual that an iterative solver may leave, in parts of the wanted error; never below the default.
   real(wp), parameter :: tolerance_part = 1.0e-3_wp
   !> Tolerance of friction laws that are not linear, in parts of the wanted error: the error itself is about a sixth of it
   !> (docs/verification.md).
   real(wp), parameter :: friction_tolerance_part = 0.3_wp
   !> Tolerance of leaps, in parts of the wanted error: the error follows it.
   real(wp), parameter :: leap_tolerance_part = 0.1_wp

   type :: advice_type
      !> How it went (see mfv_status), and why there is no advice; empty where there is.
      integer :: status = MFV_COMPLETE
      character(:), allocatable :: message
      real(wp) :: wanted_error = 0.0_wp
      !> &mesh nodes that the wanted error takes, and nodes in contact then; and what the scene has itself.
      integer :: nodes = 0, contact_nodes = 0, present_nodes = 0
      !> Whether the scene has a quantity that is wanted; the error that its law has with the scene's own nodes, and the
      !> nodes in contact that the wanted error takes.
      logical :: known(advice_count) = .false.
      real(wp) :: present_error(advice_count) = 0.0_wp, needed_nodes(advice_count) = 0.0_wp
      !> Coarse meshes that were solved, &mesh nodes of the coarser one of each pair.
      integer, allocatable :: pair_nodes(:)
      !> See method_type.
      integer :: linear_solver = solver_auto
      real(wp) :: linear_tolerance = 0.0_wp, friction_tolerance = 0.0_wp, leap_tolerance = 0.0_wp
      !> Linear solves and seconds that the run will take, about.
      real(wp) :: solves = 0.0_wp, seconds = 0.0_wp
      !> Linear solves on the finest of the coarse meshes, of &mesh nodes `tried_nodes`, by events and by large increments; 0: not
      !> tried.
      integer :: tried_nodes = 0, event_solves = 0, leap_solves = 0
   end type advice_type

   !> What the pairs tell: squares of the coefficients c of the errors c/nodes^order, nodes in contact; shape (advice_count).
   type :: law_type
      real(wp) :: squares(advice_count) = 0.0_wp
      !> Nodes in contact over &mesh nodes. Linear solves with `nodes` nodes in contact, and the power of the nodes with which
      !> they grow.
      real(wp) :: density = 0.0_wp, solves = 0.0_wp, nodes = 1.0_wp, growth = 0.0_wp
      logical :: known(advice_count) = .false.
      !> Pairs, and those whose meshes both resolve the slip zones; nodes in contact that the error 1 of the dissipation takes by
      !> the
      !> width of the slip zones, squared, and summed over the pairs.
      integer :: pairs = 0, resolved_pairs = 0
      real(wp) :: slip_law = 0.0_wp
   end type law_type

contains

   !> What a scene needs for the error `wanted_error`, between 0 and 1, in the quantities of `wanted`, shape (advice_count).
   !> `observer` watches the coarse meshes, and can stop them.
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
         advice%message = 'the case has none of the wanted quantities'
         return
      end if
      call choose_nodes(scene, law, advice)
      if (advice%message /= '') return
      call choose_solver(scene, law, advice)
   end subroutine advise

   !> Scenes whose mesh cannot be another.
   subroutine refuse_fixed_meshes(scene, advice)
      type(scene_type), intent(in) :: scene
      type(advice_type), intent(inout) :: advice

      if (.not. has_coarser_meshes(scene)) then
         advice%message = "a body with shape='matrix' has its own nodes"
      else if (allocated(scene%friction%static%value) .and. .not. allocated(scene%friction%static%position)) then
         if (size(scene%friction%static%value) > 1) &
            advice%message = 'the coefficient of friction has one value a node; a mu_file would do with any number of nodes'
      end if
      if (advice%message /= '') advice%status = MFV_INPUT_ERROR
   end subroutine refuse_fixed_meshes

   !> Solve the pairs of coarse meshes.
   subroutine measure(scene, law, advice, watch)
      type(scene_type), intent(in) :: scene
      type(law_type), intent(out) :: law
      type(advice_type), intent(inout) :: advice
      type(relay_type), intent(inout) :: watch
      type(simulation_type) :: pilot, coarse, fine
      integer :: i, nodes

      allocate (advice%pair_nodes(0))
      call solve_pilot(scene, pilot, nodes, advice, watch)
      if (advice%message /= '') return
      law%density = real(pilot%contact%state%contact_nodes(), wp)/nodes
      do i = 1, size(pair_nodes)
         nodes = nearest_mesh(scene, pair_nodes(i)/law%density)
         if (nodes == 0 .or. any(advice%pair_nodes == nodes)) cycle
         call solve(scene, nodes, pilot, coarse, advice, watch)
         if (advice%message == '') call solve(scene, 3*nodes, pilot, fine, advice, watch)
         if (advice%message /= '') return
         advice%pair_nodes = [advice%pair_nodes, nodes]
         call add_pair(law, coarse, fine)
      end do
      if (law%pairs == 0) then
         advice%status = MFV_INPUT_ERROR
         advice%message = 'no coarse mesh fits the circle of a Fourier series'
         return
      end if
      law%squares(advice_dissipation) = law%squares(advice_dissipation)*law%pairs/max(law%resolved_pairs, 1)
      law%squares = law%squares/law%pairs
      law%squares(advice_dissipation) = max(law%squares(advice_dissipation), &
                                            (slip_safety*law%slip_law/(law%pairs*safety(advice_dissipation)))**2)
      law%density = real(fine%contact%state%contact_nodes(), wp)/(3*advice%pair_nodes(size(advice%pair_nodes)))
      law%nodes = max(fine%contact%state%contact_nodes(), 1)
      law%solves = max(fine%contact%system%solves, 1)
      law%growth = max(log(law%solves/max(coarse%contact%system%solves, 1))/log(3.0_wp), 0.0_wp)
      call add_interval_laws(law, fine)
      call try_leaps(scene, fine, pilot, advice, watch)
   end subroutine measure

   !> A coarse mesh with enough nodes in contact to tell how many there are on any other.
   subroutine solve_pilot(scene, pilot, nodes, advice, watch)
      type(scene_type), intent(in) :: scene
      type(simulation_type), intent(out) :: pilot
      integer, intent(out) :: nodes
      type(advice_type), intent(inout) :: advice
      type(relay_type), intent(inout) :: watch
      integer, parameter :: first = 30, attempts = 8
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
         if (pilot%outcome == MFV_COMPLETE .and. contact >= fewest_pilot_nodes) return
         if (pilot%outcome /= MFV_COMPLETE .and. attempt > 2) exit
      end do
      advice%status = pilot%outcome
      if (advice%status == MFV_COMPLETE) advice%status = MFV_INPUT_ERROR
      advice%message = 'with '//to_text(nodes)//' nodes: '//status_outcome(pilot%outcome)//', '//to_text(contact)// &
                       ' nodes in contact'
   end subroutine solve_pilot

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
      advice%message = 'with '//to_text(nodes)//' nodes: '//status_outcome(simulation%outcome)
   end subroutine solve

   !> Whether large increments take fewer solves than events, on the finest of the coarse meshes, under Coulomb's friction.
   subroutine try_leaps(scene, fine, pilot, advice, watch)
      type(scene_type), intent(in) :: scene
      type(simulation_type), intent(in) :: fine, pilot
      type(advice_type), intent(inout) :: advice
      type(relay_type), intent(inout) :: watch
      type(advice_type) :: trial
      type(scene_type) :: leaping
      type(simulation_type) :: simulation

      if (scene%method%algorithm /= algorithm_mfv .or. scene%method%stepping /= stepping_event) return
      if (.not. scene%friction%is_proportional() .or. .not. scene%tangential()) return
      leaping = scene
      leaping%method%stepping = stepping_leap
      leaping%method%leap_tolerance = min(leap_tolerance_part*advice%wanted_error, scene%method%leap_tolerance)
      advice%tried_nodes = 3*advice%pair_nodes(size(advice%pair_nodes))
      trial%message = ''
      call solve(leaping, advice%tried_nodes, pilot, simulation, trial, watch)
      if (trial%message /= '') return
      advice%event_solves = fine%contact%system%solves
      advice%leap_solves = simulation%contact%system%solves
   end subroutine try_leaps

   !> Add what a pair of meshes tells of the tractions and the dissipation.
   subroutine add_pair(law, coarse, fine)
      type(law_type), intent(inout) :: law
      type(simulation_type), intent(in) :: coarse, fine
      real(wp) :: difference(advice_count)
      integer, allocatable :: place(:)
      integer :: nodes

      nodes = coarse%contact%state%contact_nodes()
      associate (on => coarse%contact%model, over => fine%contact%model, a => coarse%contact%state, b => fine%contact%state)
         place = nint((on%arc - over%arc(1))/over%interval()) + 1
         difference = 0.0_wp
         difference(advice_pressure) = distance(a%fields%pressure, b%fields%pressure, place)
         law%known([advice_pressure, advice_half_width]) = .true.
         if (on%tangential) then
            law%known(advice_stick_ratio) = .true.
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
      law%squares = law%squares + (difference*real(nodes, wp)**order)**2
      law%pairs = law%pairs + 1
   end subroutine add_pair

   !> Relative distance, l2, of coarse tractions from fine ones; `place`: the coarse nodes among the fine ones, outside of
   !> which there is no traction.
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

   !> Half-width and stick ratio may be wrong by what the intervals leave open.
   subroutine add_interval_laws(law, fine)
      type(law_type), intent(inout) :: law
      type(simulation_type), intent(in) :: fine
      real(wp), dimension(quantity_count) :: allowances, values
      integer :: nodes

      allowances = interval_allowances(fine)
      values = quantities_of(fine)
      nodes = fine%contact%state%contact_nodes()
      law%squares(advice_half_width) = (nodes*allowances(quantity_half_width)/max(values(quantity_half_width), tiny(1.0_wp)))**2
      law%squares(advice_stick_ratio) = (nodes*allowances(quantity_stick_ratio))**2
   end subroutine add_interval_laws

   !> Nodes by the laws.
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
         advice%message = trim(advice_names(hardest))//' takes about '//to_text(advice%needed_nodes(hardest)/law%density, 2)// &
                          ' nodes, more than the '//to_text(most_nodes)//' that can be advised'
         if (hardest == advice_dissipation) advice%message = advice%message//': its slip zones are narrow parts of the contact'
         return
      end if
      advice%contact_nodes = ceiling(max(maxval(advice%needed_nodes, mask=advice%known), real(fewest_nodes, wp)))
      advice%nodes = mesh_of_at_least(scene, advice%contact_nodes/law%density)
      advice%contact_nodes = nint(advice%nodes*law%density)
   end subroutine choose_nodes

   !> The least number of intervals, as odd or even as the scene's, that is no less than `wanted` and fits; where none fits the
   !> circle of a Fourier series the next one that does not.
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

   !> Solver, tolerances and cost.
   subroutine choose_solver(scene, law, advice)
      type(scene_type), intent(in) :: scene
      type(law_type), intent(in) :: law
      type(advice_type), intent(inout) :: advice
      type(method_type) :: usual
      real(wp) :: unknowns

      unknowns = real(advice%contact_nodes, wp)*merge(2, 1, scene%tangential())
      advice%linear_solver = cheapest_solver(unknowns)
      advice%linear_tolerance = max(tolerance_part*advice%wanted_error, usual%linear_tolerance)
      advice%leap_tolerance = min(leap_tolerance_part*advice%wanted_error, scene%method%leap_tolerance)
      advice%friction_tolerance = min(friction_tolerance_part*advice%wanted_error, scene%method%friction_tolerance)
      advice%solves = law%solves*(advice%contact_nodes/law%nodes)**law%growth
      advice%seconds = advice%solves*seconds_of_solve(advice%linear_solver, unknowns)
   end subroutine choose_solver

end module mfv_advice
