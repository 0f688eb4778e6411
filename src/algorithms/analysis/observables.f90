!> Observables for joint damping from a load history with cycles: dissipation per cycle, stiffness after a reversal, stick
!> ratios on loading and reversal, shift of the contact patch; with units, and dimensionless as in dissertation section 5.2
!> and eq. 6.5.
module mfv_observables
   use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
   use mfv_body, only: body_names
   use mfv_contact_state, only: contact_state_type
   use mfv_cycle, only: cycle_type
   use mfv_edge_fields, only: edge_field_type, edge_quantities
   use mfv_extreme_states, only: find_extremes, find_present_tension
   use mfv_kinds, only: pi, wp
   use mfv_load_cycles, only: present_edge_fields
   use mfv_load_extremes, only: candidate_tension, candidate_von_mises, extreme_type, load_extremes_type
   use mfv_motions, only: motions, motion_count => user_motions, motion_approach, motion_shift
   use mfv_near_field, only: near_field_type
   use mfv_simulation, only: mark_loading, simulation_type
   use mfv_steady_stick, only: steady_stick_length
   use mfv_stress_search, only: largest_type
   use mfv_tolerances, only: significant
   use mfv_zone_edges, only: outermost_edges, find_patches, find_zone_edges, largest_shear, patch_type, zone_edges_type
   implicit none
   private
   public :: observable_count, observables, observable_place, observed_type, observe, error_none, error_load, error_smooth, &
             error_edges, error_stick, error_pressure, error_shear, error_local, error_place

   !> How the discretisation error of an observable behaves: not estimated (counts, rows, and numbers with the relative errors of
   !> their factors); none where the load is prescribed; smooth; that of edges of the contact, of stick zones, of the peaks of
   !> the tractions, of a stress that can be at an edge; of fields at an edge; that of a place.
   integer, parameter :: error_none = 0, error_load = 1, error_smooth = 2, error_edges = 3, error_stick = 4, error_pressure = 5, &
                         error_shear = 6, error_local = 7, error_edge_field = 8, error_place = 9

   !> Name, as in tables and files; unit in terms of length and force (energies per unit thickness), or 1; behaviour of the
   !> discretisation error; meaning.
   type :: row_type
      character(len=36) :: name
      character(len=18) :: unit
      integer :: error
      character(len=140) :: meaning
   end type row_type

   !> Extremes of a stretch of the load history, at the ends of its load segments.
   character(*), parameter :: over = ' over the last cycle; without cycles: over all rows or steps'
   character(*), parameter :: row_meaning = 'when it occurs: row of &history, turning point of the cycle, or step'
   !> Number and list of the observables.
   integer, parameter :: observable_count = 105
   type(row_type), parameter :: observables(observable_count) = [ &
                                row_type('normal_force', 'force/length', error_load, &
                                         'normal force P per unit thickness at the end'), &
                                row_type('tangential_force', 'force/length', error_load, &
                                         'tangential force Q per unit thickness at the end'), &
                                row_type('approach', 'length', error_smooth, 'approach of the upper body at the end'), &
                                row_type('shift', 'length', error_smooth, 'shift of the upper body to the right at the end'), &
                                row_type('moment', 'force', error_load, 'moment on the upper body at the end'), &
                                row_type('rotation', '1', error_smooth, 'rotation of the upper body at the end, radians'), &
                                row_type('lower_contraction', 'length^2', error_smooth, &
                                         'area by which the shear tractions shorten the lower body at the end'), &
                                row_type('upper_contraction', 'length^2', error_smooth, &
                                         'area by which the shear tractions shorten the upper body at the end'), &
                                row_type('dissipation', 'force', error_smooth, &
                                         'energy dissipated so far per unit thickness (with wear: by all cycles)'), &
                                row_type('contact_half_width', 'length', error_edges, &
                                    'half the length of the contact at the end, from edges between nodes, where it is one patch'), &
                                row_type('contact_length', 'length', error_edges, &
                                         'length of the contact at the end, of all its patches, from edges between nodes'), &
                                row_type('patches', '1', error_none, &
                                         'contact patches at the end, with open nodes between them'), &
                                row_type('contact_centre', 'length', error_edges, &
                                         'middle between the outermost edges at the end, arc length from the origin of x'), &
                                row_type('stick_ratio', '1', error_stick, &
                                       'length of the stick zones over that of the contact at the end, from edges between nodes'), &
                                row_type('peak_pressure', 'force/length^2', error_pressure, 'largest pressure at the end'), &
                                row_type('peak_shear', 'force/length^2', error_shear, &
                                         'largest size of the shear traction at the end, also at stick edges between nodes'), &
                                row_type('cycles', '1', error_none, 'whole cycles of the last step that has any'), &
                                row_type('cycle_dissipation', 'force', error_smooth, &
                                         'energy dissipated in the last cycle, per unit thickness'), &
                                row_type('first_cycle_dissipation', 'force', error_smooth, &
                                         'energy dissipated in the first cycle, per unit thickness'), &
                                row_type('cycle_change', '1', error_none, &
                                         'largest change of a traction over the last cycle, relative to the largest traction'), &
                                row_type('shift_drift', 'length', error_smooth, &
                                         'change of the shift over the last cycle: not 0 where the upper body walks'), &
                                row_type('force_amplitude', 'force/length', error_load, &
                                         'half the range of the tangential force in the last cycle'), &
                                row_type('shift_amplitude', 'length', error_smooth, &
                                         'half the range of the shift in the last cycle'), &
                                row_type('tangential_stiffness', 'force/length^2', error_smooth, &
                                         'tangential force over shift right after the last reversal'), &
                                row_type('secant_stiffness', 'force/length^2', error_smooth, &
                                         'tangential force over shift from end to end of the last cycle'), &
                                row_type('loss_factor', '1', error_smooth, &
                                 'area of the loop of tangential force and shift over 2 pi times the energy of secant_stiffness'), &
                                row_type('stick_ratio_loading', '1', error_stick, 'stick ratio where the cycles begin'), &
                                row_type('stick_ratio_reversal', '1', error_stick, &
                                         'stick ratio at the far end of the last cycle'), &
                                row_type('stick_ratio_return', '1', error_stick, 'stick ratio at the end of the last cycle'), &
                                row_type('patch_shift_loading', '1', error_edges, &
                                         'middle of the contact over its half-width where the cycles begin'), &
                                row_type('patch_shift_reversal', '1', error_edges, &
                                         'middle of the contact over its half-width at the far end of the last cycle'), &
                                row_type('patch_shift_return', '1', error_edges, &
                                         'middle of the contact over its half-width at the end of the last cycle'), &
                                row_type('half_width_number', '1', error_none, &
                                         'contact_half_width times the relative curvature'), &
                                row_type('pressure_number', '1', error_none, &
                                         'peak_pressure over p0 = 2 P/(pi a), the peak of an ellipse (section 5.2)'), &
                                row_type('shear_number', '1', error_none, 'peak_shear over p0 = 2 P/(pi a)'), &
                                row_type('force_number', '1', error_none, &
                                         'force_amplitude over mu P: the lateral force ratio of section 6.4'), &
                                row_type('shift_number', '1', error_none, &
                                         'shift_amplitude times the relative curvature (section 5.2)'), &
                                row_type('dissipation_number', '1', error_none, &
                                         'cycle_dissipation over P^2 A, A = sum of (kappa + 1)/(4 G) (eq. 6.5); anisotropic: At'), &
                                row_type('stiffness_number', '1', error_none, 'tangential_stiffness times A (anisotropic: At)'), &
                                row_type('creepage', '1', error_smooth, &
                                      'rolling: sliding of the upper body over the lower per rolled distance, both to the right'), &
                                row_type('creepage_number', '1', error_none, &
                                         'creepage over mu a K: K relative curvature, a contact_half_width (Carter 1926); '// &
                                         'anisotropic: over mu a K At/A'), &
                                row_type('lower_tension', 'force/length^2', error_local, &
                                         'largest tension along the surface of the lower body at the end'), &
                                row_type('lower_tension_x', 'length', error_place, 'where it is: x'), &
                                row_type('upper_tension', 'force/length^2', error_local, &
                                         'largest tension along the surface of the upper body at the end'), &
                                row_type('upper_tension_x', 'length', error_place, 'where it is: x'), &
                                row_type('worn_area', 'length^2', error_smooth, &
                                         'area worn off both profiles: volume per unit thickness'), &
                                row_type('wear_depth', 'length', error_smooth, 'largest depth worn off both surfaces together'), &
                                row_type('largest_lower_tension', 'force/length^2', error_local, &
                                         'largest tension along the surface of the lower body'//over), &
                                row_type('largest_lower_tension_x', 'length', error_place, 'where it is: x'), &
                                row_type('largest_lower_tension_row', '1', error_none, row_meaning), &
                                row_type('largest_upper_tension', 'force/length^2', error_local, &
                                         'largest tension along the surface of the upper body'//over), &
                                row_type('largest_upper_tension_x', 'length', error_place, 'where it is: x'), &
                                row_type('largest_upper_tension_row', '1', error_none, row_meaning), &
                                row_type('largest_pressure', 'force/length^2', error_pressure, 'largest pressure'//over), &
                                row_type('largest_pressure_x', 'length', error_place, 'where it is: x of a node'), &
                                row_type('largest_pressure_row', '1', error_none, row_meaning), &
                                row_type('largest_shear', 'force/length^2', error_shear, &
                                         'largest size of the shear traction'//over), &
                                row_type('largest_shear_x', 'length', error_place, 'where it is: x'), &
                                row_type('largest_shear_row', '1', error_none, row_meaning), &
                                row_type('largest_slip_range', 'length', error_smooth, &
                                         'largest range of the slip of a node at turning points in contact'//over), &
                                row_type('largest_slip_range_x', 'length', error_place, 'where it is: x'), &
                                row_type('smallest_stick_ratio', '1', error_stick, &
                                         'smallest stick ratio, as stick_ratio'//over), &
                                row_type('smallest_stick_ratio_row', '1', error_none, row_meaning), &
                                row_type('largest_stick_ratio', '1', error_stick, 'largest stick ratio, as stick_ratio'//over), &
                                row_type('largest_stick_ratio_row', '1', error_none, row_meaning), &
                                row_type('largest_lower_von_mises', 'force/length^2', error_local, &
                                         'with yield_strength: largest von Mises '//'stress in the lower body'//over), &
                                row_type('largest_lower_von_mises_x', 'length', error_place, 'where it is: x'), &
                                row_type('largest_lower_von_mises_y', 'length', error_place, 'where it is: y'), &
                                row_type('largest_lower_von_mises_row', '1', error_none, row_meaning), &
                                row_type('largest_upper_von_mises', 'force/length^2', error_local, &
                                         'with yield_strength: largest von Mises '//'stress in the upper body'//over), &
                                row_type('largest_upper_von_mises_x', 'length', error_place, 'where it is: x'), &
                                row_type('largest_upper_von_mises_y', 'length', error_place, 'where it is: y'), &
                                row_type('largest_upper_von_mises_row', '1', error_none, row_meaning), &
                                row_type('largest_lower_interface_tension', 'force/length^2', error_smooth, &
                                         'with layers: largest normal traction that opens an interface of the lower body'//over), &
                                row_type('largest_lower_interface_tension_x', 'length', error_place, 'where it is: x'), &
                                row_type('largest_lower_interface_tension_y', 'length', error_none, 'where it is: y'), &
                                row_type('largest_lower_interface_tension_row', '1', error_none, row_meaning), &
                                row_type('largest_lower_interface_shear', 'force/length^2', error_smooth, &
                                         'with layers: largest shear traction at an interface of the lower body'//over), &
                                row_type('largest_lower_interface_shear_x', 'length', error_place, 'where it is: x'), &
                                row_type('largest_lower_interface_shear_y', 'length', error_none, 'where it is: y'), &
                                row_type('largest_lower_interface_shear_row', '1', error_none, row_meaning), &
                                row_type('largest_upper_interface_tension', 'force/length^2', error_smooth, &
                                         'with layers: largest normal traction that opens an interface of the upper body'//over), &
                                row_type('largest_upper_interface_tension_x', 'length', error_place, 'where it is: x'), &
                                row_type('largest_upper_interface_tension_y', 'length', error_none, 'where it is: y'), &
                                row_type('largest_upper_interface_tension_row', '1', error_none, row_meaning), &
                                row_type('largest_upper_interface_shear', 'force/length^2', error_smooth, &
                                         'with layers: largest shear traction at an interface of the upper body'//over), &
                                row_type('largest_upper_interface_shear_x', 'length', error_place, 'where it is: x'), &
                                row_type('largest_upper_interface_shear_y', 'length', error_none, 'where it is: y'), &
                                row_type('largest_upper_interface_shear_row', '1', error_none, row_meaning), &
                                row_type('left_normal_intensity', 'force/length^(5/2)', error_edge_field, &
                                         'K_N at the left edge of the contact at the end: pressure K_N sqrt(s), distance s'), &
                                row_type('left_shear_intensity', 'force/length^(3/2)', error_edge_field, &
                                         'K_T at the left edge: shear K_T/sqrt(s) if stuck since the last turning point'), &
                                row_type('left_slip_zone', 'length', error_stick, &
                                         'width of the slip zone at the left edge at the end'), &
                                row_type('left_asymptotic_slip_zone', 'length', error_edge_field, &
                                         'width of the slip zone at the left edge by K_N and K_T'), &
                                row_type('left_edge_reach', 'length', error_edge_field, &
                                         'distance from the left edge where p is a tenth off K_N sqrt(s)'), &
                                row_type('left_edge_exponent', '1', error_none, &
                                         'exponent of s in the pressure at the left edge, 1/2; corners -1/2'), &
                                row_type('left_corner_intensity', 'force/length^(3/2)', error_edge_field, &
                                         'intensity K of the pressure K/sqrt(s) of a corner at the left end'), &
                                row_type('right_normal_intensity', 'force/length^(5/2)', error_edge_field, &
                                         'K_N at the right edge of the contact at the end: pressure K_N sqrt(s), distance s'), &
                                row_type('right_shear_intensity', 'force/length^(3/2)', error_edge_field, &
                                         'K_T at the right edge: shear K_T/sqrt(s) if stuck since the last turning point'), &
                                row_type('right_slip_zone', 'length', error_stick, &
                                         'width of the slip zone at the right edge at the end'), &
                                row_type('right_asymptotic_slip_zone', 'length', error_edge_field, &
                                         'width of the slip zone at the right edge by K_N and K_T'), &
                                row_type('right_edge_reach', 'length', error_edge_field, &
                                         'distance from the right edge where p is a tenth off K_N sqrt(s)'), &
                                row_type('right_edge_exponent', '1', error_none, &
                                         'exponent of s in the pressure at the right edge, 1/2; corners -1/2'), &
                                row_type('right_corner_intensity', 'force/length^(3/2)', error_edge_field, &
                                         'intensity K of the pressure K/sqrt(s) of a corner at the right end'), &
                                row_type('permanent_stick_length', 'length', error_stick, &
                                         'length that sticks at all turning points of the last cycle'), &
                                row_type('steady_stick_length', 'length', error_edge_field, &
                                         'length that sticks in steady cycles on a straight load path, by superposition')]

   !> What is read off a simulation: the observables, NaN if not available; and the extremes and the edges of all patches, of which
   !> some are.
   type :: observed_type
      real(wp) :: values(observable_count)
      type(load_extremes_type) :: extremes
      type(edge_field_type), allocatable :: edges(:, :)
   contains
      procedure :: value => observed_value
   end type observed_type

contains

   !> Index of an observable; observable_count + 1 of other names.
   pure integer function observable_place(name) result(place)
      character(*), intent(in) :: name

      do place = 1, observable_count
         if (observables(place)%name == name) return
      end do
   end function observable_place

   !> The observable of a name.
   pure real(wp) function observed_value(self, name) result(value)
      class(observed_type), intent(in) :: self
      character(*), intent(in) :: name

      value = self%values(observable_place(name))
   end function observed_value

   !> All observables at the present state of a simulation, with units.
   type(observed_type) function observe(simulation) result(observed)
      type(simulation_type), intent(in) :: simulation

      observed%values = ieee_value(1.0_wp, ieee_quiet_nan)
      call find_extremes(simulation, observed%extremes)
      call add_present(simulation, observed%extremes, observed%edges, observed%values)
      call add_extremes(observed%extremes, observed%values)
      call add_cycles(simulation, observed%values)
   end function observe

   !> Observables of the last step with cycles.
   subroutine add_cycles(simulation, values)
      type(simulation_type), intent(in) :: simulation
      real(wp), intent(inout) :: values(:)
      type(contact_state_type) :: state
      type(zone_edges_type) :: loading

      if (simulation%marks(mark_loading)%step == 0) return
      state = simulation%padded(simulation%marks(mark_loading))
      call find_zone_edges(simulation%contact%model, state, loading)
      call add_turning_point(loading, 'loading', values)
      if (simulation%cycle_count == 0) return
      associate (cycle => simulation%cycles(simulation%cycle_count))
         ! Not those of an earlier step, if the last step with cycles ended in its first one.
         if (cycle%step == simulation%marks(mark_loading)%step) call add_cycle(simulation, cycle, values)
      end associate
   end subroutine add_cycles

   !> Observables of the present state. `extremes`: of the load history, which may be those of this state. `fields`: of the edges of
   !> its patches.
   subroutine add_present(simulation, extremes, fields, values)
      type(simulation_type), intent(in) :: simulation
      type(load_extremes_type), intent(in) :: extremes
      type(edge_field_type), allocatable, intent(out) :: fields(:, :)
      real(wp), intent(inout) :: values(:)
      type(zone_edges_type) :: edges
      type(patch_type), allocatable :: patches(:)
      type(near_field_type) :: pair
      real(wp) :: mean_peak, limit, shear
      integer :: i

      associate (state => simulation%contact%state, model => simulation%contact%model)
         call find_patches(model, state, patches)
         edges = outermost_edges(patches)
         do i = 1, motion_count
            if (.not. model%moves(i)) cycle
            call put(values, trim(motions(i)%force_key), state%fields%force(i))
            call put(values, trim(motions(i)%key), state%fields%motion(i))
         end do
         call put(values, 'dissipation', state%dissipation)
         call put(values, 'contact_half_width', edges%half_width())
         call put(values, 'contact_length', edges%contact_length)
         call put(values, 'patches', real(edges%patches, wp))
         call put(values, 'contact_centre', edges%centre())
         call put(values, 'stick_ratio', edges%stick_ratio())
         call put(values, 'peak_pressure', maxval(state%fields%pressure))
         shear = maxval(abs(state%fields%shear))
         do i = 1, size(patches)
            shear = max(shear, largest_shear(model, state, patches(i)))
         end do
         call put(values, 'peak_shear', shear)
         call put(values, 'half_width_number', edges%half_width()*model%scene%curvature())
         fields = present_edge_fields(simulation, patches)
         call add_edge_fields(fields, values)
         call add_tension(simulation, extremes, .false., 'lower', values)
         call add_tension(simulation, extremes, .true., 'upper', values)
         if (model%scene%wear%acts()) then
            call put(values, 'worn_area', model%force(state%worn))
            call put(values, 'wear_depth', maxval(state%worn))
         end if
         if (.not. (state%fields%force(motion_approach) > 0.0_wp .and. edges%contact)) return
         mean_peak = 2.0_wp*state%fields%force(motion_approach)/(pi*edges%half_width())
         call put(values, 'pressure_number', maxval(state%fields%pressure)/mean_peak)
         call put(values, 'shear_number', shear/mean_peak)
         call put(values, 'creepage', simulation%contact%rolling%creepage())
         if (edges%patches /= 1) return
         pair = model%scene%near_field()
         limit = model%scene%friction%static%largest()*edges%half_width()*model%scene%curvature()*pair%shear_ratio()
         if (limit > 0.0_wp) call put(values, 'creepage_number', simulation%contact%rolling%creepage()/limit)
      end associate
   end subroutine add_present

   !> Fields at the outermost edges of the contact.
   subroutine add_edge_fields(edges, values)
      type(edge_field_type), intent(in) :: edges(:, :)
      real(wp), intent(inout) :: values(:)

      if (size(edges, 2) == 0) return
      call put_edge('left', edges(1, 1))
      call put_edge('right', edges(2, size(edges, 2)))

   contains

      subroutine put_edge(side, edge)
         character(*), intent(in) :: side
         type(edge_field_type), intent(in) :: edge
         integer :: i

         associate (of_edge => edge%values())
            do i = 1, size(edge_quantities)
               call put(values, side//'_'//trim(edge_quantities(i)), of_edge(i))
            end do
         end associate
      end subroutine put_edge
   end subroutine add_edge_fields

   !> The largest tension along the surface of a body; NaN for a rigid body or a matrix, and if singular.
   subroutine add_tension(simulation, extremes, upper, name, values)
      type(simulation_type), intent(in) :: simulation
      type(load_extremes_type), intent(in) :: extremes
      logical, intent(in) :: upper
      character(*), intent(in) :: name
      real(wp), intent(inout) :: values(:)
      type(largest_type) :: largest
      logical :: available

      call find_present_tension(simulation, extremes, upper, largest, available)
      if (.not. available) return
      call put(values, name//'_tension', largest%value)
      call put(values, name//'_tension_x', largest%x)
   end subroutine add_tension

   !> Extremes over the last cycle or, without one, over the load history.
   subroutine add_extremes(extremes, values)
      type(load_extremes_type), intent(in) :: extremes
      real(wp), intent(inout) :: values(:)
      integer :: i

      call put_extreme('largest_pressure', extremes%pressure)
      call put_extreme('largest_shear', extremes%shear)
      call put_extreme('largest_slip_range', extremes%slip_range)
      call put_extreme('smallest_stick_ratio', extremes%lowest_stick)
      call put_extreme('largest_stick_ratio', extremes%highest_stick)
      do i = 1, size(body_names)
         call put_extreme('largest_'//body_names(i)//'_tension', extremes%searched(candidate_tension(i)))
         call put_extreme('largest_'//body_names(i)//'_von_mises', extremes%searched(candidate_von_mises(i)))
         call put_extreme('largest_'//body_names(i)//'_interface_tension', extremes%interface_tension(i))
         call put_extreme('largest_'//body_names(i)//'_interface_shear', extremes%interface_shear(i))
      end do

   contains

      !> The observable of a name, and those of its place and row that exist.
      subroutine put_extreme(name, extreme)
         character(*), intent(in) :: name
         type(extreme_type), intent(in) :: extreme
         character(*), parameter :: suffix(4) = [character(4) :: '', '_x', '_y', '_row']
         integer :: j

         if (extreme%row == 0) return
         associate (value => [extreme%value, extreme%x, extreme%y, real(extreme%row, wp)])
            do j = 1, size(suffix)
               call put(values, name//trim(suffix(j)), value(j))
            end do
         end associate
      end subroutine put_extreme
   end subroutine add_extremes

   !> Observables of the last cycle.
   subroutine add_cycle(simulation, cycle, values)
      type(simulation_type), intent(in) :: simulation
      type(cycle_type), intent(in) :: cycle
      real(wp), intent(inout) :: values(:)

      call put(values, 'cycles', real(cycle%number + cycle%block - 1, wp))
      call put(values, 'cycle_dissipation', cycle%dissipation())
      call put(values, 'first_cycle_dissipation', cycle%first_dissipation)
      call put(values, 'cycle_change', cycle%change)
      call put(values, 'shift_drift', cycle%drift(motion_shift))
      call put(values, 'force_amplitude', cycle%force_amplitude())
      call put(values, 'shift_amplitude', cycle%shift_amplitude())
      call put(values, 'tangential_stiffness', cycle%return%stiffness_on_leaving)
      call put(values, 'secant_stiffness', cycle%secant_stiffness())
      call put(values, 'loss_factor', cycle%loss_factor())
      call put(values, 'permanent_stick_length', cycle%permanent_stick_length())
      call put(values, 'steady_stick_length', steady_stick_length(simulation, cycle))
      call add_turning_point(cycle%reversal%edges, 'reversal', values)
      call add_turning_point(cycle%return%edges, 'return', values)
      call add_numbers(simulation, cycle, values)
   end subroutine add_cycle

   !> Stick ratio and patch shift at a turning point.
   subroutine add_turning_point(edges, name, values)
      type(zone_edges_type), intent(in) :: edges
      character(*), intent(in) :: name
      real(wp), intent(inout) :: values(:)

      if (.not. edges%contact) return
      call put(values, 'stick_ratio_'//name, edges%stick_ratio())
      call put(values, 'patch_shift_'//name, edges%centre()/edges%half_width())
   end subroutine add_turning_point

   !> Dimensionless observables of the last cycle.
   subroutine add_numbers(simulation, cycle, values)
      type(simulation_type), intent(in) :: simulation
      type(cycle_type), intent(in) :: cycle
      real(wp), intent(inout) :: values(:)
      !> A normal force that is a smaller fraction of the largest one counts as zero.
      real(wp), parameter :: round_off = significant
      real(wp) :: sliding_limit, force, shear_modulus
      type(near_field_type) :: pair

      associate (scene => simulation%contact%model%scene)
         force = cycle%return%force(motion_approach)
         if (force <= round_off*cycle%highest_force(motion_approach)) force = 0.0_wp
         sliding_limit = scene%friction%static%largest()*force
         if (sliding_limit > 0.0_wp) call put(values, 'force_number', cycle%force_amplitude()/sliding_limit)
         call put(values, 'shift_number', cycle%shift_amplitude()*scene%curvature())
         if (.not. scene%modulus() > 0.0_wp) return
         pair = scene%near_field()
         shear_modulus = scene%modulus()/pair%shear_ratio()
         if (force > 0.0_wp) call put(values, 'dissipation_number', cycle%dissipation()*shear_modulus/force**2)
         call put(values, 'stiffness_number', cycle%return%stiffness_on_leaving/shear_modulus)
      end associate
   end subroutine add_numbers

   !> Set the value of an observable; other names are ignored.
   pure subroutine put(values, name, value)
      real(wp), intent(inout) :: values(:)
      character(*), intent(in) :: name
      real(wp), intent(in) :: value
      integer :: place

      place = observable_place(name)
      if (place <= observable_count) values(place) = value
   end subroutine put

end module mfv_observables
