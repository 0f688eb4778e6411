!> Discretisation error of a result: the scene is solved again on coarser meshes, and the observables get error bars
!> (mfv_error_bar).
module mfv_discretisation_error
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
   use mfv_body, only: body_names, body_type
   use mfv_circle, only: kernel_fourier
   use mfv_compliance, only: block_up, block_wt
   use mfv_contact_model, only: contact_model_type
   use mfv_contact_state, only: contact_state_type
   use mfv_corners, only: corner_type, corners_of, find_corner
   use mfv_edge_fields, only: edge_quantities, is_in_cycles
   use mfv_error_bar
   use mfv_extreme_states, only: find_present_tension
   use mfv_friction, only: friction_coefficient_type
   use mfv_interior, only: interior_type
   use mfv_kinds, only: pi, wp
   use mfv_load_extremes, only: candidate_tension, extreme_type, load_extremes_type
   use mfv_motions, only: bulk_motions, control_keep, motion_approach, motion_shift
   use mfv_near_field, only: near_field_type
   use mfv_node_status, only: holds, in_contact
   use mfv_observables
   use mfv_observer, only: observer_type, relay_type
   use mfv_profile_sampling, only: largest_jumps, negligible_pressure
   use mfv_resolution, only: add_unresolved, all_quantities, find_unresolved, is_prescribed, is_unresolved, &
                             nodes_in, poorest_patch, undersampling, unresolved_type
   use mfv_scene, only: scene_type
   use mfv_simulation, only: history_none, mark_loading, mark_return, mark_reversal, new_simulation, simulation_type, &
                             states_steps
   use mfv_slip_zones, only: contact_interval, is_narrow_stick_zone, largest_resolved_error, slip_record_type
   use mfv_state_interior, only: state_interior
   use mfv_status, only: MFV_COMPLETE, MFV_INPUT_ERROR, status_outcome
   use mfv_stress_search, only: largest_type
   use mfv_strings, only: to_text
   use mfv_tolerances, only: certified, significant
   use mfv_zone_edges, only: find_patches, held, largest_shear, patch_type, slipping_run, zone_type, zones_of
   implicit none
   private
   public :: estimate_error, coarser_scene, scene_on_mesh, fix_cycles, nearest_mesh, allowances_of_behaviours, has_coarser_meshes

   !> Ratios of fine to coarse numbers of intervals: spread, so that edges lie in different places of an interval.
   real(wp), parameter :: coarsening(3) = [1.4_wp, 1.7_wp, 2.0_wp]
   !> Minimum of nodes in contact on the coarsest mesh.
   integer, parameter :: fewest_contact_nodes = 5
   !> Factor on the bars of unequal intervals, whose coarser meshes differ less from them than their errors do: measured
   !> (docs/verification.md).
   real(wp), parameter :: of_unequal_intervals = 2.0_wp
   !> With few nodes in a patch errors do not yet fall regularly from mesh to mesh: bars grow by (few_nodes/nodes)^3, at most by
   !> most_growth. Measured (docs/verification.md).
   real(wp), parameter :: few_nodes = 24.0_wp, most_growth = 2.0_wp
   !> Dimensionless numbers, and the observables whose relative errors add up to theirs.
   character(*), parameter :: numbers(3, 8) = reshape([character(20) :: &
                                                       'half_width_number', 'contact_half_width', '', &
                                                       'pressure_number', 'peak_pressure', 'contact_half_width', &
                                                       'shear_number', 'peak_shear', 'contact_half_width', &
                                                       'force_number', 'force_amplitude', 'normal_force', &
                                                       'shift_number', 'shift_amplitude', '', &
                                                       'dissipation_number', 'cycle_dissipation', 'normal_force', &
                                                       'stiffness_number', 'tangential_stiffness', '', &
                                                       'creepage_number', 'creepage', 'contact_half_width'], [3, 8])
   !> Least uncertainty of tensions on equal intervals, relative, over (interval/half-width)^2, for coarser meshes that agree better
   !> because their edges happen to lie alike in an interval: measured (docs/verification.md, the trailing edge).
   real(wp), parameter :: of_tensions = 0.03_wp
   !> The same of worn surfaces, over interval/half-width: the worn part ends somewhere in an interval.
   real(wp), parameter :: of_worn_tensions = 0.5_wp

contains

   !> Whether the scene can be solved on coarser meshes: the nodes of a matrix are fixed.
   pure logical function has_coarser_meshes(scene)
      type(scene_type), intent(in) :: scene

      has_coarser_meshes = .not. scene%lower%is_matrix()
   end function has_coarser_meshes

   !> Estimate the discretisation error of a finished simulation, into simulation%estimate. `observer` monitors the runs on
   !> the coarser meshes and can stop them. Its message says why there is no estimate.
   subroutine estimate_error(simulation, observer)
      type(simulation_type), intent(inout) :: simulation
      class(observer_type), intent(inout), target, optional :: observer
      type(error_estimate_type) :: estimate
      real(wp), allocatable :: values(:, :), allowances(:, :)
      integer, allocatable :: nodes(:)
      type(unresolved_type), allocatable :: unresolved(:)
      type(observed_type) :: observed
      integer :: place

      estimate%nodes = simulation%contact%model%scene%mesh%nodes
      estimate%message = ''
      estimate%doubt = ''
      allocate (estimate%coarser_nodes(0), estimate%bar(observable_count))
      call choose_coarser_meshes(simulation, nodes, estimate)
      if (estimate%message == '') then
         call find_unresolved(simulation, unresolved)
         observed = observe(simulation)
         call solve_coarser_meshes(simulation, observed%values, nodes, values, allowances, unresolved, estimate, observer)
      end if
      if (estimate%message == '') then
         estimate%coarser_nodes = nodes(2:)
         do place = 1, observable_count
            if (observables(place)%error == error_none .or. ieee_is_nan(values(place, 1))) cycle
            if (is_unresolved(unresolved, trim(observables(place)%name)) .and. &
                .not. is_prescribed(simulation, trim(observables(place)%name))) then
               estimate%bar(place) = unresolved_bar(values(place, :))
            else if (is_there(simulation%contact%model, place, values, allowances(place, :))) then
               associate (behaviour => observables(place)%error)
                  estimate%bar(place) = new_error_bar(nodes, values(place, :), allowances(place, :), &
                                                      any(behaviour == [error_edges, error_stick, error_place]), &
                                                      is_smooth(simulation%contact%model, place), &
                                                      all(behaviour /= [error_pressure, error_shear, error_local]))
               end associate
               ! Not an allowance: on coarser meshes it would hide differences.
               if (observables(place)%name == 'largest_pressure_x') estimate%bar(place)%error = &
                  max(estimate%bar(place)%error, distance_of_maxima(simulation%contact%model%x, &
                                                                    simulation%contact%state%fields%pressure, values(place, 1)))
               if (observables(place)%name == 'largest_slip_range') &
                  call narrow_slip_range(nodes, values, allowances, estimate%bar(place))
            end if
            if (peak_is_at_corner(simulation, place, values(:, 1))) estimate%bar(place) = logarithmic_bar(values(place, :))
         end do
         estimate%bar%error = (1.0_wp + min((few_nodes/nodes_in(poorest_patch(simulation)))**3, most_growth))*estimate%bar%error
         if (allocated(simulation%contact%model%scene%mesh%ends)) estimate%bar%error = of_unequal_intervals*estimate%bar%error
         call add_numbers(values, estimate%bar)
         call widen_uncertain_places(values, estimate%bar)
         call add_rivals(simulation, observed%extremes, estimate%bar)
      end if
      simulation%estimate = estimate
   end subroutine estimate_error

   !> The bars of the dimensionless numbers, from those of their factors. `values`: of all observables on all meshes; their bars,
   !> shape (observable_count).
   pure subroutine add_numbers(values, bars)
      real(wp), intent(in) :: values(:, :)
      type(error_bar_type), intent(inout) :: bars(:)
      integer :: i, j, place

      do i = 1, size(numbers, 2)
         place = observable_place(trim(numbers(1, i)))
         if (ieee_is_nan(values(place, 1))) cycle
         bars(place)%value = values(place, 1)
         bars(place)%coarser_values = values(place, 2:)
         do j = 2, size(numbers, 1)
            if (numbers(j, i) == '') cycle
            associate (bar => bars(place), of => bars(observable_place(trim(numbers(j, i)))))
               if (.not. of%known) cycle
               if (j == 2) bar%order = of%order
               bar%known = .true.
               bar%resolved = bar%resolved .and. of%resolved
               if (of%error > 0.0_wp .or. .not. of%resolved) bar%error = bar%error + abs(bar%value/of%value)*of%error
            end associate
         end do
      end do
   end subroutine add_numbers

   !> The largest tension or pressure may be at another place where one is as large within their bars, as at both edges of a
   !> contact: its distance is added to the bars of places. `extremes`: see find_extremes; `bars`: shape (observable_count).
   subroutine add_rivals(simulation, extremes, bars)
      type(simulation_type), intent(in) :: simulation
      type(load_extremes_type), intent(in) :: extremes
      type(error_bar_type), intent(inout) :: bars(:)
      type(largest_type) :: largest
      logical :: available
      integer :: side

      call add('largest_pressure', rivals_of(extremes%pressure))
      if (.not. simulation%contact%model%tangential) return
      do side = 1, size(body_names)
         call add('largest_'//body_names(side)//'_tension', rivals_of(extremes%searched(candidate_tension(side))))
         call find_present_tension(simulation, extremes, side == 2, largest, available)
         if (available) call add(body_names(side)//'_tension', largest)
      end do

   contains

      pure type(largest_type) function rivals_of(found)
         type(extreme_type), intent(in) :: found

         rivals_of = largest_type(found%value, found%x, found%y, found%rival, found%rival_x)
      end function rivals_of

      subroutine add(name, largest)
         character(*), intent(in) :: name
         type(largest_type), intent(in) :: largest

         associate (of_value => bars(observable_place(name)), of_place => bars(observable_place(name//'_x')))
            if (.not. (of_place%known .and. of_place%resolved .and. of_value%known .and. of_value%resolved)) return
            if (largest%rival >= largest%value - 2.0_wp*of_value%error) &
               of_place%error = of_place%error + abs(largest%rival_x - largest%x)
         end associate
      end subroutine add
   end subroutine add_rivals

   !> Where a quantity is largest is uncertain by the length of the contact if it is uncertain by so much that it may be as large
   !> elsewhere; but a slip range is uncertain by what the outermost node misses. `values`: of all observables on all meshes; their
   !> bars, shape (observable_count).
   pure subroutine widen_uncertain_places(values, bars)
      real(wp), intent(in) :: values(:, :)
      type(error_bar_type), intent(inout) :: bars(:)
      real(wp), parameter :: uncertain = 0.1_wp
      character(:), allocatable :: name
      integer :: place, largest

      do place = 1, observable_count
         if (observables(place)%error /= error_place .or. .not. bars(place)%known) cycle
         name = trim(observables(place)%name)
         if (name == 'largest_slip_range_x') cycle
         largest = observable_place(name(:len(name) - 2))  ! without _x or _y
         if (.not. bars(largest)%known) cycle
         if (bars(place)%resolved .and. bars(largest)%error > uncertain*abs(values(largest, 1))) &
            bars(place)%error = max(bars(place)%error, values(observable_place('contact_length'), 1))
      end do
   end subroutine widen_uncertain_places

   !> The bar of a slip range that is largest at the outermost node of one patch, on every mesh: in first order the range grows in
   !> proportion to the distance of this node from the contact's edge, d, with a slope from all meshes. The bar is slope*d and what
   !> the line leaves, as for other quantities.
   pure subroutine narrow_slip_range(nodes, values, allowances, bar)
      integer, intent(in) :: nodes(:)
      real(wp), intent(in) :: values(:, :), allowances(:, :)
      type(error_bar_type), intent(inout) :: bar
      real(wp), dimension(size(nodes)) :: distance, range, line
      real(wp) :: slope
      type(error_bar_type) :: other
      integer :: place

      place = observable_place('largest_slip_range_x')
      distance = 0.5_wp*values(observable_place('contact_length'), :) - &
                 abs(values(place, :) - values(observable_place('contact_centre'), :))
      if (any(nint(values(observable_place('patches'), :)) /= 1 .or. distance < 0.0_wp .or. distance > allowances(place, :))) return
      range = values(observable_place('largest_slip_range'), :)
      associate (far => distance(2:) - distance(1))
         if (.not. sum(far**2) > 0.0_wp) return
         slope = sum(far*(range(2:) - range(1)))/sum(far**2)
         line = slope*(distance - distance(1))
      end associate
      other = new_error_bar(nodes, range - line, spread(abs(slope)*distance(1), 1, size(nodes)), .false., .false., .true.)
      bar%error = min(bar%error, other%error)
   end subroutine narrow_slip_range

   !> Whether a peak is at a corner, where it grows whenever intervals are halved, and how it changes from mesh to mesh depends more
   !> on where the corner lies between nodes: peaks of the pressure, and of the shear at a corner that has slipped. `values`: of
   !> all observables.
   pure logical function peak_is_at_corner(simulation, place, values)
      type(simulation_type), intent(in) :: simulation
      integer, intent(in) :: place
      real(wp), intent(in) :: values(:)
      type(corner_type) :: corner
      integer :: peak

      peak_is_at_corner = .false.
      associate (model => simulation%contact%model, state => simulation%contact%state, name => observables(place)%name, &
                 behaviour => observables(place)%error)
         if (all(behaviour /= [error_pressure, error_shear])) return
         if (index(name, 'largest_') == 1) then
            peak = minloc(abs(model%x - values(observable_place(trim(name)//'_x'))), dim=1)
         else if (behaviour == error_pressure) then
            peak = maxloc(state%fields%pressure, dim=1)
         else
            peak = maxloc(abs(state%fields%shear), dim=1)
         end if
         call find_corner(model, state%fields%pressure, peak, corner, peak_is_at_corner)
         if (behaviour == error_shear) peak_is_at_corner = peak_is_at_corner .and. state%friction_work(peak) > 0.0_wp
      end associate
   end function peak_is_at_corner

   !> Whether observables with this behaviour can converge faster than with the first power of the interval: not those of edges, and
   !> not the peak pressure at a kink of a profile, nor largest tractions of states with cusps by full coupling, and nothing under
   !> friction that weakens or creeps, node by node.
   pure logical function is_smooth(model, place)
      type(contact_model_type), intent(in) :: model
      integer, intent(in) :: place

      associate (scene => model%scene, behaviour => observables(place)%error)
         is_smooth = any(behaviour == [error_load, error_smooth, error_pressure, error_shear])
         if (allocated(scene%friction%law)) is_smooth = is_smooth .and. scene%friction%is_proportional()
         if (behaviour == error_pressure) is_smooth = is_smooth .and. .not. (scene%lower%is_sampled() .or. scene%upper%is_sampled())
         if (any(behaviour == [error_pressure, error_shear]) .and. index(observables(place)%name, 'largest_') == 1) &
            is_smooth = is_smooth .and. .not. (model%tangential .and. pressing_shears(model))
         ! It is that of an edge, mostly.
         if (observables(place)%name == 'largest_slip_range') is_smooth = .false.
      end associate
   end function is_smooth

   !> Whether an observable is modelled, is not prescribed, and is not zero on all meshes and certainly so. `values`: of all
   !> observables on all meshes.
   pure logical function is_there(model, place, values, allowances)
      type(contact_model_type), intent(in) :: model
      integer, intent(in) :: place
      real(wp), intent(in) :: values(:, :), allowances(:)
      !> Relative difference of a prescribed load on two meshes.
      real(wp), parameter :: round_off = certified
      real(wp) :: scale

      associate (own => values(place, :))
         select case (observables(place)%error)
         case (error_stick)
            is_there = model%tangential
         case (error_load)
            scale = maxval(abs(own))
            if (observables(place)%name == 'moment') scale = max(scale, maxval(abs(values(observable_place('normal_force'), :)* &
                                                                                   values(observable_place('contact_length'), :))))
            is_there = maxval(abs(own - own(1))) > round_off*scale
         case default
            is_there = any(abs(own) > 0.0_wp)
            if (any(observables(place)%error == [error_smooth, error_place])) is_there = is_there .or. any(allowances > 0.0_wp)
         end select
      end associate
   end function is_there

   !> Numbers of intervals of the mesh and of different coarser meshes; or, in `estimate`, why there are none.
   subroutine choose_coarser_meshes(simulation, nodes, estimate)
      type(simulation_type), intent(in) :: simulation
      integer, allocatable, intent(out) :: nodes(:)
      type(error_estimate_type), intent(inout) :: estimate
      integer :: i, coarser

      estimate%status = MFV_INPUT_ERROR
      nodes = [estimate%nodes]
      associate (scene => simulation%contact%model%scene)
         if (simulation%outcome /= MFV_COMPLETE) then
            estimate%status = simulation%outcome
            estimate%message = 'the run did not complete'
         else if (.not. has_coarser_meshes(scene)) then
            estimate%message = "a body with shape='matrix' has no coarser mesh"
         else if (simulation%load_summary%steps /= size(scene%steps)) then
            estimate%message = 'load steps were applied that are not in the case'
         else if (simulation%contact%state%contact_nodes() < 2*fewest_contact_nodes) then
            estimate%message = 'at least '//to_text(2*fewest_contact_nodes)//' nodes in contact are needed, not '// &
                               to_text(simulation%contact%state%contact_nodes())
         else
            do i = 1, size(coarsening)
               coarser = nearest_mesh(scene, scene%mesh%nodes/coarsening(i))
               if (coarser > 0 .and. coarser < nodes(size(nodes))) nodes = [nodes, coarser]
            end do
            if (size(nodes) < 3) &
               estimate%message = "kernel='fourier': fewer than two coarser meshes divide the circle into whole intervals"
         end if
      end associate
      if (estimate%message == '') estimate%status = MFV_COMPLETE
   end subroutine choose_coarser_meshes

   !> Number of intervals nearest to `wanted`, of the parity of the scene's, that fits its circles; 0 if there is none within
   !> a fifth.
   pure integer function nearest_mesh(scene, wanted) result(nodes)
      type(scene_type), intent(in) :: scene
      real(wp), intent(in) :: wanted
      real(wp), parameter :: reach = 0.2_wp
      integer :: nearest, i, side, parity

      parity = modulo(scene%mesh%nodes, 2)
      nearest = 2*nint(0.5_wp*(wanted - parity)) + parity
      do i = 0, max(1, floor(0.5_wp*reach*wanted))
         do side = -1, 1, 2
            nodes = nearest + 2*side*i
            if (nodes > 0 .and. fits(scene, scene%lower, nodes) .and. fits(scene, scene%upper, nodes)) return
         end do
      end do
      nodes = 0
   end function nearest_mesh

   !> Whether a mesh of `nodes` intervals over a given half-width fits a body: a Fourier series needs a whole number of them
   !> on its circle.
   pure logical function fits(scene, body, nodes)
      type(scene_type), intent(in) :: scene
      type(body_type), intent(in) :: body
      integer, intent(in) :: nodes
      real(wp) :: intervals

      fits = .true.
      if (.not. body%deforms_as_circle() .or. body%elasticity%kernel /= kernel_fourier) return
      if (.not. scene%mesh%half_width > 0.0_wp) return
      intervals = pi*body%radius*nodes/scene%mesh%half_width
      fits = abs(intervals - anint(intervals)) <= significant*intervals
   end function fits

   !> Solve the scene on the coarser meshes. `finest`: the observables of the simulation; `values`, `allowances`: on every
   !> mesh, shape (observable_count, size(nodes)). `unresolved`: nothing can be estimated from a mesh that misses contact patches
   !> or points of a profile.
   subroutine solve_coarser_meshes(simulation, finest, nodes, values, allowances, unresolved, estimate, observer)
      type(simulation_type), intent(in) :: simulation
      real(wp), intent(in) :: finest(:)
      integer, intent(in) :: nodes(:)
      real(wp), allocatable, intent(out) :: values(:, :), allowances(:, :)
      type(unresolved_type), allocatable, intent(inout) :: unresolved(:)
      type(error_estimate_type), intent(inout) :: estimate
      class(observer_type), intent(inout), target, optional :: observer
      type(relay_type) :: watch
      type(simulation_type) :: coarse
      type(observed_type) :: observed
      logical :: other_zones
      integer :: i, before

      before = size(unresolved)
      other_zones = .false.
      allocate (values(observable_count, size(nodes)), allowances(observable_count, size(nodes)))
      values(:, 1) = finest
      allowances(:, 1) = interval_allowances(simulation, values(:, 1))
      if (present(observer)) watch%caller => observer
      watch%runs = size(nodes) - 1
      do i = 2, size(nodes)
         watch%before = i - 2
         coarse = new_simulation(coarser_scene(simulation, nodes(i)), history_none, states_steps)
         call coarse%run(watch)
         if (coarse%outcome /= MFV_COMPLETE) then
            estimate%status = coarse%outcome
            estimate%message = 'on a mesh of '//to_text(nodes(i))//' nodes: '//status_outcome(coarse%outcome)
            return
         end if
         observed = observe(coarse)
         values(:, i) = observed%values
         allowances(:, i) = interval_allowances(coarse, values(:, i))
         other_zones = other_zones .or. stick_zones(coarse) /= stick_zones(simulation)
         if (estimate%doubt == '') estimate%doubt = trim(difference_of_meshes(simulation, coarse))
      end do
      if (estimate%doubt /= '') then
         call add_unresolved(unresolved, all_quantities(simulation), estimate%doubt, 'use more nodes')
      else
         call add_missing(values, merge('stick_zones stick_left stick_right', repeat(' ', 34), other_zones), unresolved)
         call add_edges_of_cycles(simulation, values(:, 1), unresolved)
         if (size(unresolved) == before) return
      end if
      estimate%doubt = unresolved(size(unresolved))%text
   end subroutine solve_coarser_meshes

   !> The number of stick zones.
   pure integer function stick_zones(simulation)
      type(simulation_type), intent(in) :: simulation

      stick_zones = size(zones_of(held(simulation%contact%model, simulation%contact%state)))
   end function stick_zones

   !> Observables that are undefined on a coarser mesh are not resolved, nor are those in `others`, separated by blanks, which have
   !> another value there. `values`: as above.
   subroutine add_missing(values, others, unresolved)
      real(wp), intent(in) :: values(:, :)
      character(*), intent(in) :: others
      type(unresolved_type), allocatable, intent(inout) :: unresolved(:)
      character(:), allocatable :: names
      integer :: place

      names = ''
      if (others /= '') names = ' '//others
      do place = 1, observable_count
         if (observables(place)%error == error_none .or. ieee_is_nan(values(place, 1))) cycle
         if (any(ieee_is_nan(values(place, :))) .and. .not. is_unresolved(unresolved, trim(observables(place)%name))) &
            names = names//' '//trim(observables(place)%name)
      end do
      if (names /= '') call add_unresolved(unresolved, names(2:), 'undefined on a coarser mesh, or it has another number of '// &
                                           'stick zones', 'use more nodes')
   end subroutine add_missing

   !> Fields of edges at a turning point of the last cycle have the bar of the observable: none if that is undefined. `values`: of
   !> the observables.
   subroutine add_edges_of_cycles(simulation, values, unresolved)
      type(simulation_type), intent(in) :: simulation
      real(wp), intent(in) :: values(:)
      type(unresolved_type), allocatable, intent(inout) :: unresolved(:)
      character(*), parameter :: sides(2) = [character(6) :: 'left_', 'right_']
      character(:), allocatable :: names
      real(wp) :: known(size(edge_quantities), 4)
      integer :: side, i

      if (simulation%cycle_count == 0) return
      associate (cycle => simulation%cycles(simulation%cycle_count))
         known = reshape([cycle%reversal%left%values(), cycle%return%left%values(), &
                          cycle%reversal%right%values(), cycle%return%right%values()], shape(known))
      end associate
      names = ''
      do side = 1, size(sides)
         do i = 1, size(edge_quantities)
            if (all(ieee_is_nan(known(i, 2*side - 1:2*side))) .or. .not. is_in_cycles(i)) cycle
            if (ieee_is_nan(values(observable_place(trim(sides(side))//trim(edge_quantities(i)))))) &
               names = names//' '//trim(sides(side))//trim(edge_quantities(i))
         end do
      end do
      if (names /= '') call add_unresolved(unresolved, names(2:), 'known at a turning point only', 'use more nodes')
   end subroutine add_edges_of_cycles

   !> Why a coarser mesh says nothing about the discretisation error of a simulation; empty if it does.
   function difference_of_meshes(simulation, coarse) result(why)
      type(simulation_type), intent(in) :: simulation, coarse
      character(len=160) :: why
      real(wp) :: part(2)
      integer :: patches(2), points

      why = ''
      patches(1) = size(zones_of(in_contact(simulation%contact%state%status)))
      patches(2) = size(zones_of(in_contact(coarse%contact%state%status)))
      call undersampling(coarse, .false., part(1), points)
      call undersampling(coarse, .true., part(2), points)
      if (patches(1) /= patches(2)) then
         why = 'the error cannot be estimated: there are '//to_text(patches(1))//' contact patches, but '//to_text(patches(2))// &
               ' on a mesh of '//to_text(coarse%contact%model%scene%mesh%nodes)//' nodes'
      else if (any(part > negligible_pressure)) then
         why = 'the error cannot be estimated: a mesh of '//to_text(coarse%contact%model%scene%mesh%nodes)// &
               ' nodes is coarser than the profile'
      end if
   end function difference_of_meshes

   !> The scene of a simulation on `nodes` intervals, with as many cycles as the simulation, steady or not.
   type(scene_type) function coarser_scene(simulation, nodes) result(scene)
      type(simulation_type), intent(in) :: simulation
      integer, intent(in) :: nodes

      scene = scene_on_mesh(simulation%contact%model%scene, nodes)
      call fix_cycles(scene, simulation)
   end function coarser_scene

   !> Set the number of cycles of a scene to that of a simulation of it, steady or not.
   subroutine fix_cycles(scene, simulation)
      type(scene_type), intent(inout) :: scene
      type(simulation_type), intent(in) :: simulation
      integer :: i

      do i = 1, simulation%snapshot_count
         associate (snapshot => simulation%snapshots(i))
            if (.not. scene%steps(snapshot%step)%steady_tolerance > 0.0_wp) cycle
            scene%steps(snapshot%step)%cycles = snapshot%reversal/scene%steps(snapshot%step)%turns()
         end associate
      end do
      scene%steps%steady_tolerance = 0.0_wp
   end subroutine fix_cycles

   !> A scene on `nodes` intervals over the same surface. A mesh of given half-width has another interval at either end, so
   !> that wider intervals do not exceed it, and grows if it did: intervals outside the contact have no effect. A coefficient
   !> of friction per node is averaged over the wider intervals.
   type(scene_type) function scene_on_mesh(original, nodes) result(scene)
      type(scene_type), intent(in) :: original
      integer, intent(in) :: nodes
      integer :: spare

      scene = original
      if (allocated(scene%mesh%ends)) then
         scene%mesh%ends = resampled(original%mesh%ends, nodes)
         scene%mesh%nodes = nodes
         call average(scene%friction%static, nodes, 0)
         call average(scene%friction%kinetic, nodes, 0)
         return
      end if
      spare = 0
      if (scene%mesh%half_width > 0.0_wp) spare = 1
      if (scene%arc_radius() > 0.0_wp .and. scene%mesh%half_width*(nodes + 2) > pi*scene%arc_radius()*nodes) spare = 0
      scene%mesh%nodes = nodes + 2*spare
      scene%mesh%half_width = scene%mesh%half_width*(nodes + 2*spare)/nodes
      call average(scene%friction%static, nodes, spare)
      call average(scene%friction%kinetic, nodes, spare)
   end function scene_on_mesh

   !> Ends of `nodes` intervals, graded like those between `ends`.
   pure function resampled(ends, nodes)
      real(wp), intent(in) :: ends(:)
      integer, intent(in) :: nodes
      real(wp) :: resampled(nodes + 1), place
      integer :: i, below, n

      n = size(ends) - 1
      do i = 0, nodes
         place = real(n, wp)*i/nodes
         below = min(int(place), n - 1)
         resampled(i + 1) = ends(below + 1) + (place - below)*(ends(below + 2) - ends(below + 1))
      end do
      resampled(nodes + 1) = ends(n + 1)
   end function resampled

   !> Averages over `nodes` intervals of values that are constant on each interval; `spare` more intervals at either end take
   !> the end values.
   pure subroutine average(coefficient, nodes, spare)
      type(friction_coefficient_type), intent(inout) :: coefficient
      integer, intent(in) :: nodes, spare
      real(wp) :: means(1 - spare:nodes + spare), from, to
      integer :: i, j, n

      if (.not. allocated(coefficient%value) .or. allocated(coefficient%position)) return
      n = size(coefficient%value)
      if (n == 1) return
      means = 0.0_wp
      do i = 1, nodes
         from = real(n, wp)*(i - 1)/nodes
         to = real(n, wp)*i/nodes
         do j = floor(from) + 1, min(ceiling(to), n)
            means(i) = means(i) + coefficient%value(j)*(min(to, real(j, wp)) - max(from, j - 1.0_wp))/(to - from)
         end do
      end do
      means(:0) = means(1)
      means(nodes + 1:) = means(nodes)
      coefficient%value = means
   end subroutine average

   !> Uncertainty of each observable within an interval and by large increments, shape (observable_count); of places the interval
   !> there. Those of turning points are the larger ones of the present state and of the state there. `values`: of the observables.
   function interval_allowances(simulation, values) result(allowances)
      type(simulation_type), intent(in) :: simulation
      real(wp), intent(in) :: values(:)
      real(wp) :: allowances(observable_count), of_behaviour(0:error_place), fineness
      integer :: i

      of_behaviour = allowances_of_behaviours(simulation, simulation%contact%state)
      allowances = of_behaviour(observables%error)
      if (simulation%cycle_count > 0) then
         call take_turning_point(mark_loading, '_loading')
         call take_turning_point(mark_reversal, '_reversal')
         call take_turning_point(mark_return, '_return')
      end if
      associate (model => simulation%contact%model)
         where (observables%error == error_edges .and. observables%unit == '1') &
            allowances = 2.0_wp*allowances/max(values(observable_place('contact_length')), model%interval())
         where (observables%name == 'contact_length') allowances = 2.0_wp*allowances
         where (observables%error == error_stick .and. observables%unit == 'length') &
            allowances = values(observable_place('contact_length'))*allowances
         call add_narrow_stick(observable_place('smallest_stick_ratio'), contact_interval(model, simulation%contact%state)/ &
                               max(values(observable_place('contact_length')), model%interval()))
         if (.not. allocated(model%scene%mesh%ends)) then
            fineness = contact_interval(model, simulation%contact%state)/ &
                       max(0.5_wp*values(observable_place('contact_length')), model%interval())
            fineness = of_tensions*fineness**2 + merge(of_worn_tensions*fineness, 0.0_wp, model%scene%wear%acts())
            where (observables%error == error_local .and. index(observables%name, '_tension') > 0) &
               allowances = allowances + fineness*abs(values)
         end if
         call add_jumps(simulation%contact%state, at_end=.true.)
         if (simulation%cycle_count > 0) call add_jumps(simulation%padded(simulation%marks(mark_reversal)), at_end=.false.)
         ! What slips within the outermost intervals while friction acts against coupling stays in the shift.
         if (pressing_shears(model) .and. stick_zones_can_grow(model)) &
            where (observables%name == 'shift') allowances = allowances + maxval(hidden_slip())
         call add_coarse_slip(simulation%slip, 'dissipation', 1.0_wp)
         if (.not. ieee_is_nan(values(observable_place('largest_slip_range')))) &
            call add_hidden('largest_slip_range', maxval(hidden_slip()))
         if (simulation%cycle_count > 0) then
            associate (cycle => simulation%cycles(simulation%cycle_count))
               call add_coarse_slip(cycle%slip(), 'cycle_dissipation', 1.0_wp)
               call add_coarse_slip(cycle%first_slip, 'first_cycle_dissipation', 1.0_wp)
               call add_coarse_slip(cycle%slip(), 'loss_factor', pi*cycle%force_amplitude()*cycle%shift_amplitude())
            end associate
         end if
         do i = 1, observable_count
            if (observables(i)%error == error_place .and. .not. ieee_is_nan(values(i))) &
               allowances(i) = model%width(minloc(abs(model%x - values(i)), dim=1))
         end do
      end associate
      ! Errors of large increments.
      associate (certificate => simulation%contact%certificate)
         where (index(observables%name, 'dissipation') > 0 .or. observables%name == 'loss_factor') &
            allowances = allowances + certificate%increment_dissipation_error*abs(values)
         where (observables%error == error_pressure .or. observables%error == error_shear .or. observables%error == error_local) &
            allowances = allowances + certificate%increment_traction_error*certificate%traction_scale
      end associate
      if (simulation%contact%model%scene%wear%acts() .and. simulation%cycle_count > 0) call add_to_wear()

   contains

      !> Uncertainties in the state of a turning point, whose names end with `ending`, and of the extreme stick ratios.
      subroutine take_turning_point(mark, ending)
         integer, intent(in) :: mark
         character(*), intent(in) :: ending

         if (simulation%marks(mark)%step == 0) return
         of_behaviour = allowances_of_behaviours(simulation, simulation%padded(simulation%marks(mark)))
         where (index(observables%name, ending) > 0 .or. mark /= mark_loading .and. &
                (observables%name == 'smallest_stick_ratio' .or. observables%name == 'largest_stick_ratio')) &
            allowances = max(allowances, of_behaviour(observables%error))
      end subroutine take_turning_point

      !> By how much a tension at a jump of the shear in a state may exceed the largest tensions over the load history and, in the
      !> last state (`at_end`), those there.
      subroutine add_jumps(state, at_end)
         type(contact_state_type), intent(in) :: state
         logical, intent(in) :: at_end
         real(wp) :: tension
         integer :: side, place, largest

         do side = 1, size(body_names)
            place = observable_place(body_names(side)//'_tension')
            largest = observable_place('largest_'//body_names(side)//'_tension')
            if (ieee_is_nan(values(largest))) cycle
            tension = tension_at_jump(simulation%contact%model, state, side == 2)
            allowances(largest) = max(allowances(largest), tension - values(largest))
            if (at_end .and. .not. ieee_is_nan(values(place))) allowances(place) = max(allowances(place), tension - values(place))
         end do
      end subroutine add_jumps

      !> A stick zone of few intervals before the end, where its edges are not looked at, is known to one of them; without a node to
      !> two. `interval`: over the length of the contact. None where all nodes slide in the end, or at the ends of cycles.
      subroutine add_narrow_stick(place, interval)
         integer, intent(in) :: place
         real(wp), intent(in) :: interval
         real(wp), parameter :: narrow = 4.0_wp

         if (.not. (values(place) < narrow*interval .and. values(observable_place('stick_ratio')) > 0.0_wp)) return
         if (values(observable_place('force_number')) >= 1.0_wp - significant) return
         allowances(place) = max(allowances(place), merge(1.0_wp, 2.0_wp, values(place) > 0.0_wp)*interval)
      end subroutine add_narrow_stick

      !> What is worn off has the relative error of all cycles together: the first one and others like the last one.
      subroutine add_to_wear()
         real(wp) :: part

         associate (first => observable_place('first_cycle_dissipation'), last => observable_place('cycle_dissipation'), &
                    others => simulation%cycle_count - 1)
            part = min((allowances(first) + others*allowances(last))/ &
                       max(abs(values(first)) + others*abs(values(last)), tiny(part)), 1.0_wp)
         end associate
         where (observables%name == 'worn_area' .or. observables%name == 'wear_depth') allowances = max(allowances, part*values)
      end subroutine add_to_wear

      !> The error of a dissipation over `unit` (force) by slip zones of few intervals, or within the outermost one at either end.
      subroutine add_coarse_slip(slip, name, unit)
         type(slip_record_type), intent(in) :: slip
         character(*), intent(in) :: name
         real(wp), intent(in) :: unit

         if (ieee_is_nan(values(observable_place(name)))) return
         associate (allowance => allowances(observable_place(name)), model => simulation%contact%model)
            if (name /= 'loss_factor') allowance = abs(values(observable_place(name)))* &
                                                   min(slip%error_number()*contact_interval(model, simulation%contact%state)**2, &
                                                       largest_resolved_error)
            call add_hidden(name, sum(hidden_slip()**2)*model%compliance%modulus/(model%compliance%shear_ratio*unit))
         end associate
      end subroutine add_coarse_slip

      !> Slip within the outermost interval at either end, at most of the order of mu p times the interval over the contact modulus.
      function hidden_slip() result(slip)
         real(wp) :: slip(2)
         logical, allocatable :: touching(:)
         integer :: ends(2)

         slip = 0.0_wp
         associate (model => simulation%contact%model, state => simulation%contact%state)
            touching = in_contact(state%status)
            if (.not. any(touching .and. abs(state%fields%shear) > 0.0_wp)) return
            ends = [findloc(touching, .true., dim=1), findloc(touching, .true., dim=1, back=.true.)]
            slip = model%static_friction(ends)*state%fields%pressure(ends)*model%width(ends)*model%compliance%shear_ratio &
                   /model%compliance%modulus
         end associate
      end function hidden_slip

      !> Add to the allowance of a quantity what is `hidden` within the outermost intervals; a larger value is that of nodes.
      subroutine add_hidden(name, hidden)
         character(*), intent(in) :: name
         real(wp), intent(in) :: hidden

         associate (allowance => allowances(observable_place(name)), value => abs(values(observable_place(name))))
            if (hidden > 0.0_wp) allowance = allowance + hidden*min(hidden/max(value, tiny(value)), 1.0_wp)
         end associate
      end subroutine add_hidden
   end function interval_allowances

   !> Tension along the surface of a body, the `upper` or the lower one, that may be where the shear rises most within few
   !> intervals inside the contact, force/length^2: a rise by d over a length w adds 2/pi d log(1/w) there (Johnson, Contact
   !> mechanics, 1985, eq. 2.25a, integrated), 2/pi d log(2) more if it is half as long. -huge without a rise.
   real(wp) function tension_at_jump(model, state, upper) result(tension)
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: state
      logical, intent(in) :: upper
      integer, parameter :: reach = 3
      type(interior_type) :: interior
      logical :: available
      real(wp) :: rise, largest
      integer :: i, first

      tension = -huge(tension)
      if (.not. model%tangential) return
      largest = certified*maxval(abs(state%fields%shear))
      first = 0
      do i = 2, model%nodes() - reach - 1
         if (.not. all(in_contact(state%status(i - 1:i + reach + 1)))) cycle
         rise = merge(-1, 1, upper)*(state%fields%shear(i + reach) - state%fields%shear(i))
         if (.not. rise > largest) cycle
         largest = rise
         first = i
      end do
      if (first == 0) return
      call state_interior(model, state, upper, interior, available)
      if (.not. available) return
      tension = maxval([(interior%surface_stress(model%arc(i)), i=first, first + reach)]) + 2.0_wp/pi*log(2.0_wp)*largest
   end function tension_at_jump

   !> Distance of the farthest maximum of the pressure from `place`, length, that may be the largest between nodes: it rises by no
   !> more than it does from the steeper neighbour. Arguments of shape (nodes).
   pure real(wp) function distance_of_maxima(x, pressure, place) result(distance)
      real(wp), intent(in) :: x(:), pressure(:), place
      integer :: i

      distance = 0.0_wp
      do i = 2, size(x) - 1
         if (pressure(i) < max(pressure(i - 1), pressure(i + 1))) cycle
         if (2.0_wp*pressure(i) - min(pressure(i - 1), pressure(i + 1)) >= maxval(pressure)) &
            distance = max(distance, abs(x(i) - place))
      end do
   end function distance_of_maxima

   !> Uncertainty within an interval of observables of each behaviour in a state: that of the edges of contact and
   !> stick zones (the half-width, the stick ratio), and that of cusps.
   function allowances_of_behaviours(simulation, state) result(of_behaviour)
      type(simulation_type), intent(in) :: simulation
      type(contact_state_type), intent(in) :: state
      real(wp) :: of_behaviour(0:error_place)
      type(patch_type), allocatable :: patches(:)
      real(wp) :: contact, stick, length, largest, nodal, at_jumps, part(2)
      integer :: i, points, nodes_held

      associate (model => simulation%contact%model)
         call find_patches(model, state, patches)
         call widen_uncertainties(model, state, has_receded(simulation, state), patches)
         ! Errors of the two edges of one patch add up; those of several patches are independent.
         contact = sqrt(2.0_wp*sum(patches%left_error**2 + patches%right_error**2))
         stick = model%interval()
         nodes_held = count(held(model, state))
         if (nodes_held > 0) &
            stick = sqrt(2.0_wp*sum([(sum(patches(i)%stick%left_error**2 + patches(i)%stick%right_error**2), i=1, size(patches))]))
         length = max(sum(patches%length()), model%interval())
         of_behaviour = 0.0_wp
         of_behaviour(error_edges) = 0.5_wp*contact
         of_behaviour(error_stick) = max(norm2([stick, contact*nodes_held/max(state%contact_nodes(), 1)]), &
                                         marginal_length(model, state))/length
         if (size(patches) > 0) then
            nodal = maxval(abs(state%fields%shear))
            largest = maxval([(largest_shear(model, state, patches(i)), i=1, size(patches))])
            if (model%compliance%has_block(block_wt)) then
               of_behaviour(error_pressure) = room_at_cusp(state%fields%pressure, holds(state%status))
               ! The pressure at the edge of a stick zone, which limits the shear there, is interpolated across a cusp.
               if (pressing_shears(model) .and. largest > nodal) of_behaviour(error_shear) = &
                  max(largest - nodal, model%scene%friction%static%largest()*of_behaviour(error_pressure))
            end if
            call undersampling(simulation, .false., part(1), points)
            call undersampling(simulation, .true., part(2), points)
            at_jumps = pressure_at_jumps(model, state%fields%pressure)
            of_behaviour(error_pressure) = max(of_behaviour(error_pressure), maxval(part)*maxval(state%fields%pressure), at_jumps)
            if (.not. largest > nodal) &
               of_behaviour(error_shear) = room_at_kink(abs(state%fields%shear), holds(state%status))
            of_behaviour(error_shear) = max(of_behaviour(error_shear), change_by_edges(model, state, patches, largest), &
                                            at_jumps*largest/max(maxval(state%fields%pressure), tiny(1.0_wp)))
         end if
      end associate
   end function allowances_of_behaviours

   !> Length over which neighbouring nodes are held next to their friction limit: on a slightly different mesh they may slip. A
   !> single node may be so near to any edge; and nodes that have just reached it, as at the end of a closed cycle, rest
   !> there on any mesh.
   real(wp) function marginal_length(model, state) result(length)
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: state
      real(wp), parameter :: least_margin = 0.002_wp
      type(zone_type), allocatable :: runs(:)
      integer :: i

      length = 0.0_wp
      if (.not. model%tangential .or. .not. allocated(model%scene%friction%law)) return
      associate (limit => model%static_friction*state%fields%pressure, shear => abs(state%fields%shear))
         runs = zones_of(holds(state%status) .and. shear > (1.0_wp - least_margin)*limit .and. shear < (1.0_wp - certified)*limit)
      end associate
      do i = 1, size(runs)
         if (runs(i)%last > runs(i)%first) length = length + sum(model%width(runs(i)%first:runs(i)%last))
      end do
   end function marginal_length

   !> Change of the largest shear, which is `largest`, if the edges of the stick zones lie elsewhere within their uncertainties,
   !> force/length^2.
   real(wp) function change_by_edges(model, state, patches, largest) result(change)
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: state
      type(patch_type), intent(in) :: patches(:)
      real(wp), intent(in) :: largest
      type(patch_type) :: moved
      real(wp) :: other
      integer :: i, side

      change = 0.0_wp
      do side = -1, 1, 2
         other = 0.0_wp
         do i = 1, size(patches)
            moved = patches(i)
            moved%stick%left = moved%stick%left - side*moved%stick%left_error
            moved%stick%right = moved%stick%right + side*moved%stick%right_error
            other = max(other, largest_shear(model, state, moved))
         end do
         change = max(change, abs(other - largest))
      end do
   end function change_by_edges

   !> Pressure that jumps of the slopes of profiles add around the largest pressures, force/length^2.
   pure real(wp) function pressure_at_jumps(model, pressure) result(at_jumps)
      type(contact_model_type), intent(in) :: model
      real(wp), intent(in) :: pressure(:)
      real(wp), parameter :: nearly = 0.9_wp, least_softness = 0.1_wp
      type(near_field_type) :: pair
      real(wp) :: jump
      logical :: is_large(size(pressure))

      is_large = pressure >= nearly*maxval(pressure)
      associate (x => pack(model%x, is_large), width => pack(model%width, is_large), scene => model%scene)
         jump = maxval(largest_jumps(scene%lower, x, width) + largest_jumps(scene%upper, x, width))
      end associate
      ! Oblique surfaces that slip to one side are softer (mfv_corners).
      pair = model%scene%near_field()
      at_jumps = model%scene%modulus()*jump/pi
      if (pair%normal > 0.0_wp) at_jumps = at_jumps/max(1.0_wp - model%scene%friction%static%largest()*abs(pair%mixed) &
                                                        /pair%normal, least_softness)
   end function pressure_at_jumps

   !> Larger uncertainties of edges where the exponents of the tractions are less certain: of contact with
   !> full coupling, where they depend on the friction, and of stick zones that can have grown. If the contact `has_receded` with
   !> full coupling, its edge is known to an interval unless the outermost nodes, from which it is found, slip alike.
   pure subroutine widen_uncertainties(model, state, has_receded, patches)
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: state
      logical, intent(in) :: has_receded
      type(patch_type), intent(inout) :: patches(:)
      !> In intervals; narrow of stick zones of few nodes between opposite slip; grown_to_end where fewer than two nodes slip beside
      !> the stick zone; worn where the outermost node is, since the pressure vanishes otherwise there; cornered over the number of
      !> nodes of the patch: around a corner in contact the pressure has an error of the first order, which moves the edges in
      !> second order; layered times the squared interval over the thickness of a layer, within which the pressure vanishes as a
      !> root, up to layered_at_most; stuck of stick zones, and of the contact beside an outermost node that sticks, where the
      !> pressure depends on the shear.
      real(wp), parameter :: coupled = 0.02_wp, receded = 0.5_wp, worn = 0.5_wp, grown = 0.2_wp, grown_to_end = 0.25_wp, &
                             cornered = 0.2_wp, narrow = 0.5_wp, layered = 0.2_wp, layered_at_most = 0.5_wp, stuck = 0.08_wp
      integer, parameter :: fewest_alike = 4
      logical :: can_grow, depends_on_friction
      type(corner_type), allocatable :: corners(:)
      real(wp) :: least, thickness
      integer :: i, j

      thickness = thinnest_layer(model%scene)
      can_grow = stick_zones_can_grow(model)
      corners = corners_of(model, state)
      depends_on_friction = model%compliance%elastic_block(block_wt) .and. pressing_shears(model)
      do i = 1, size(patches)
         associate (patch => patches(i), width => model%width)
            if (depends_on_friction .and. .not. patch%left_ends) &
               patch%left_error = max(patch%left_error, width(patch%first)*of_friction(slipping_run(state, patch%first, 1)))
            if (depends_on_friction .and. .not. patch%right_ends) &
               patch%right_error = max(patch%right_error, width(patch%last)*of_friction(slipping_run(state, patch%last, -1)))
            least = min(layered*(maxval(width([patch%first, patch%last]))/thickness)**2, layered_at_most)
            if (any(corners%place > patch%left .and. corners%place < patch%right)) &
               least = max(least, cornered/(patch%last - patch%first + 1))
            if (.not. patch%left_ends) patch%left_error = max(patch%left_error, width(patch%first)* &
                                                              max(least, merge(worn, 0.0_wp, is_worn(patch%first))))
            if (.not. patch%right_ends) patch%right_error = max(patch%right_error, width(patch%last)* &
                                                                max(least, merge(worn, 0.0_wp, is_worn(patch%last))))
            do j = 1, size(patch%stick)
               associate (zone => patch%stick(j))
                  if (is_narrow_stick_zone(state%status, zone)) then
                     zone%left_error = max(zone%left_error, width(zone%first)*narrow)
                     zone%right_error = max(zone%right_error, width(zone%last)*narrow)
                  end if
                  if (depends_on_friction) then
                     zone%left_error = max(zone%left_error, width(zone%first)*stuck)
                     zone%right_error = max(zone%right_error, width(zone%last)*stuck)
                  end if
                  if (.not. can_grow) cycle
                  zone%left_error = max(zone%left_error, width(zone%first)*merge(grown_to_end, grown, &
                                                                                 zone%first - patch%first < 2))
                  zone%right_error = max(zone%right_error, width(zone%last)*merge(grown_to_end, grown, patch%last - zone%last < 2))
               end associate
            end do
         end associate
      end do

   contains

      !> In intervals, where the pressure depends on the shear: an edge beside `slipping` nodes that slip alike.
      pure real(wp) function of_friction(slipping)
         integer, intent(in) :: slipping

         of_friction = merge(stuck, coupled, slipping == 0)
         if (has_receded .and. slipping < fewest_alike) of_friction = receded
      end function of_friction

      pure logical function is_worn(node)
         integer, intent(in) :: node

         is_worn = .false.
         if (model%scene%wear%acts()) is_worn = state%worn(node) > 0.0_wp
      end function is_worn
   end subroutine widen_uncertainties

   !> Thickness of the thinner one of the first layers of both bodies, length; huge without layers.
   pure real(wp) function thinnest_layer(scene) result(thickness)
      type(scene_type), intent(in) :: scene

      thickness = huge(thickness)
      if (scene%has_layers(.false.)) thickness = scene%lower%elasticity%depth_of(1)
      if (scene%has_layers(.true.)) thickness = min(thickness, scene%upper%elasticity%depth_of(1))
   end function thinnest_layer

   !> Whether the contact was wider than in a state by an interval or more, or the surfaces are stretched: shear tractions at the
   !> edges are then not those of one slip zone.
   pure logical function has_receded(simulation, state)
      type(simulation_type), intent(in) :: simulation
      type(contact_state_type), intent(in) :: state

      associate (model => simulation%contact%model)
         has_receded = simulation%slip%half_width > 0.5_wp*(sum(model%width, mask=in_contact(state%status)) + &
                                                            contact_interval(model, state)) .or. &
                       any(abs(state%fields%motion(bulk_motions)) > 0.0_wp)
      end associate
   end function has_receded

   !> Whether stick zones can have grown while friction acted, so that the exponent at their edges is not known: pressing with
   !> coupling or oblique loading.
   pure logical function stick_zones_can_grow(model)
      type(contact_model_type), intent(in) :: model

      associate (steps => model%scene%steps)
         stick_zones_can_grow = any(steps%friction .and. steps%control(motion_approach) /= control_keep .and. &
                                    (pressing_shears(model) .or. steps%control(motion_shift) /= control_keep))
      end associate
   end function stick_zones_can_grow

   !> Whether pressing causes shear tractions: not with coupling of the order of a/R alone, as of a cylinder on a half-plane of
   !> the same material.
   pure logical function pressing_shears(model)
      type(contact_model_type), intent(in) :: model

      associate (scene => model%scene)
         pressing_shears = model%compliance%has_block(block_up) .and. &
                           (.not. scene%is_similar() .or. (scene%lower%circular() .and. scene%upper%circular()))
      end associate
   end function pressing_shears

   !> Uncertainty of a peak of the pressure that is a cusp, as with full coupling, force/length^2: at the edge of a stick zone,
   !> which lies between two nodes, or where contact began when bodies are pressed with friction, where the strain of the stick
   !> zone has a kink (Spence 1973). Arguments of shape (nodes), pressure in force/length^2.
   pure real(wp) function room_at_cusp(pressure, held) result(room)
      real(wp), intent(in) :: pressure(:)
      logical, intent(in) :: held(:)
      !> The edge of the stick zone is sought this many nodes from the peak.
      integer, parameter :: reach = 2
      integer :: peak, last, top, side, i

      room = room_at_kink(pressure, held)
      peak = maxloc(pressure, dim=1)
      if (peak - reach <= 1 .or. peak + reach >= size(pressure)) return
      do side = -1, 1, 2
         do i = -reach, reach - 1
            last = peak + side*i
            top = peak + side*min(i, 0)
            if (min(last + side, top - 2*side) < 1 .or. max(last + side, top - 2*side) > size(held)) cycle
            if (.not. held(last) .or. held(last + side) .or. .not. held(top - 2*side)) cycle
            room = max(room, max(i + 1, 1)*max(abs(pressure(top) - pressure(top - side)), &
                                               abs(pressure(top - side) - pressure(top - 2*side))))
         end do
      end do
   end function room_at_cusp

   !> Uncertainty of the largest of some nodal values where it lies between nodes, as a kink or, inside a stick zone, as a cusp at
   !> the edge of an earlier one; in the unit of the values, 0 if they are smooth. Arguments of shape (nodes).
   pure real(wp) function room_at_kink(values, held) result(room)
      real(wp), intent(in) :: values(:)
      logical, intent(in) :: held(:)
      integer, parameter :: reach = 3
      real(wp) :: slope(-1:1), bend(-2:2)
      integer :: peak, side, i

      room = 0.0_wp
      peak = maxloc(values, dim=1)
      if (peak - reach < 1 .or. peak + reach > size(values)) return
      do side = -1, 1, 2
         ! Extrapolated to the peak: 0 if it is smooth.
         slope(side) = 2.5_wp*(values(peak + side) - values(peak + 2*side)) - 1.5_wp*(values(peak + 2*side) - values(peak + 3*side))
      end do
      associate (flat => max(min(slope(-1), slope(1)), 0.0_wp), steep => max(slope(-1), slope(1)))
         room = 0.5_wp*flat
         ! The steep side of a cusp is a root.
         if (all(held(peak - reach:peak + reach))) room = min(4.0_wp*flat, 0.6_wp*steep)
      end associate
      ! More than the curvature beside it.
      bend = [(values(peak + i) - 0.5_wp*(values(peak + i - 1) + values(peak + i + 1)), i=-2, 2)]
      room = max(room, bend(0) - max(min(bend(-2), bend(2)), 0.0_wp))
   end function room_at_kink

end module mfv_discretisation_error
