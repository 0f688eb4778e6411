!> All fields of a result: names, meanings, units and values, by group. The result file, the C API and, through it, Python take
!> their names from here.
module mfv_result_fields
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan, ieee_positive_inf, ieee_quiet_nan, ieee_value
   use mfv_body, only: body_names, body_type
   use mfv_geometry, only: shape_names
   use mfv_body_pair, only: lower_body, upper_body
   use mfv_case, only: case_type
   use mfv_certificate, only: residual_count, residual_descriptions, residual_names
   use mfv_closed_form, only: closed_form_of, closed_form_type
   use mfv_compliance, only: coupling_names
   use mfv_contact_state, only: contact_state_type
   use mfv_cycle, only: cycle_type, turning_point_type
   use mfv_edge_fields, only: edge_field_type, edge_quantities, is_in_cycles
   use mfv_error_bar
   use mfv_interior, only: has_interior
   use mfv_kinds, only: wp
   use mfv_load_cycles, only: present_edge_fields
   use mfv_load_extremes, only: candidate_tension, extreme_type
   use mfv_material, only: material_type, plane_names
   use mfv_motions, only: motions, motion_count => user_motions, motion_approach, motion_shift, motion_rotation, bulk_motions
   use mfv_near_field, only: near_field_type
   use mfv_node_status, only: event_names, in_contact, node_status_names
   use mfv_observables, only: observable_count, observable_place, observables, observe, observed_type
   use mfv_resolution, only: find_unresolved_observables
   use mfv_scene, only: algorithm_names, stepping_leap, stepping_names
   use mfv_simulation, only: history_none, mark_cycle_start, mark_loading, mark_return, mark_reversal, &
                             sensitivity_type, simulation_type
   use mfv_state_interior, only: find_edges_at_nodes
   use mfv_status, only: status_outcome
   use mfv_strings, only: add_text, list_of_words, string_type, to_text, word_of
   use mfv_text_file, only: find_working_directory
   use mfv_version, only: library_version
   use mfv_zone_edges, only: find_patches, find_zone_edges, largest_shear, patch_type, zone_edges_type
   implicit none
   private
   public :: field_type, list_type, result_groups, group_fields, field_named, step_group, along_nodes, &
             along_nothing, scale_count, scale_group, scale_name, result_attributes

   !> Dimension along which the values of a field are listed.
   integer, parameter :: along_nothing = 0, along_nodes = 1, along_records = 2, along_companions = 3, along_cycles = 4, &
                         along_patches = 5, scale_count = 5
   !> Group and name of the scale of each dimension.
   character(*), parameter :: scale_group(scale_count) = [character(14) :: 'mesh', 'history', 'error_estimate', 'cycles', 'patches']
   character(*), parameter :: scale_name(scale_count) = [character(15) :: 'x', 'record', 'companion_nodes', 'cycle', 'patch']

   !> One named quantity: real `values` or whole numbers `whole`, the other not allocated.
   type :: field_type
      character(:), allocatable :: name, description, unit
      integer :: along = along_nothing
      real(wp), allocatable :: values(:)
      integer, allocatable :: whole(:)
      !> Names of the values 0, 1, ... of a coded quantity; empty for a plain one.
      character(:), allocatable :: flags
   end type field_type

   !> A list of fields, allocated by the caller. Units are given in terms of length and force, such as force/length^2; the fields
   !> have the user's names of these two.
   type :: list_type
      type(field_type), allocatable :: fields(:)
      character(:), allocatable :: length_unit, force_unit
   contains
      generic :: add => add_number, add_count, add_numbers, add_counts
      procedure, private :: add_number, add_count, add_numbers, add_counts
   end type list_type

   !> Instants whose tractions are available: start of the cycles; reversal of the last cycle; its end.
   character(*), parameter :: moment_names(3) = [character(8) :: 'loading', 'reversal', 'return']
   integer, parameter :: moment_marks(3) = [mark_loading, mark_reversal, mark_return]
   !> Meanings of fields in several groups.
   character(*), parameter :: pressure_meaning = 'compressive normal traction p'
   character(*), parameter :: shear_meaning = 'shear traction tau on the lower body, positive to the right'
   character(*), parameter :: dissipation_meaning = 'energy dissipated so far per unit thickness (with wear: by all cycles)'
   character(*), parameter :: contact_nodes_meaning = 'nodes in contact'
   character(*), parameter :: stick_nodes_meaning = 'stuck nodes'
   character(*), parameter :: between_nodes = ', x, between nodes'
   character(*), parameter :: narrow = '; those, and gaps between them, narrower than two intervals are not resolved'
   character(*), parameter :: linear_solves_meaning = 'linear solves so far'

contains

   !> Paths of the groups that the result of a simulation has.
   function result_groups(simulation) result(groups)
      type(simulation_type), intent(in) :: simulation
      type(string_type), allocatable :: groups(:)
      integer :: i

      groups = list_of_words('mesh scene compliance state summary certificate')
      if (simulation%keep_history /= history_none) call add_text(groups, 'history')
      call add_text(groups, 'observables')
      if (any(in_contact(simulation%contact%state%status))) call add_text(groups, 'patches')
      if (simulation%cycle_count > 0) call add_text(groups, 'cycles')
      call add_text(groups, 'reference')
      if (has_estimate(simulation)) call add_text(groups, 'error_estimate')
      if (has_sensitivity(simulation)) call add_text(groups, 'sensitivity')
      do i = 1, simulation%snapshot_count
         call add_text(groups, step_group(i))
      end do
   end function result_groups

   !> Path of the group of snapshot `number`: steps/0001 and so on.
   pure function step_group(number) result(path)
      integer, intent(in) :: number
      character(len=len_trim(padded_step_group(number))) :: path

      path = padded_step_group(number)
   end function step_group

   !> The same, padded with blanks.
   pure function padded_step_group(number) result(path)
      integer, intent(in) :: number
      character(len=17) :: path

      write (path, '(a,i4.4)') 'steps/', number
      if (number > 9999) path = 'steps/'//to_text(number)
   end function padded_step_group

   !> The fields of one group; none for an unknown group. The tractions at instants of a cycle (moments/loading and so on) are not
   !> in result files and result_groups. `observed`: what is read off the simulation, if it
   !> is known.
   subroutine group_fields(case, simulation, group, fields, observed)
      type(case_type), intent(in) :: case
      type(simulation_type), intent(in) :: simulation
      character(*), intent(in) :: group
      type(field_type), allocatable, intent(out) :: fields(:)
      type(observed_type), intent(in), optional :: observed
      type(list_type) :: list
      type(observed_type), allocatable :: seen
      integer :: number, code, i

      list%length_unit = case%length_unit
      list%force_unit = case%force_unit
      allocate (list%fields(0))
      select case (group)
      case ('scene')
         call add_scene(list, simulation)
      case ('compliance')
         call add_compliance(list, simulation)
      case ('mesh')
         call add_mesh(list, simulation)
      case ('state')
         call add_state(list, simulation, simulation%contact%state)
      case ('summary')
         call add_summary(list, simulation, simulation%contact%state)
      case ('certificate')
         call add_certificate(list, simulation)
      case ('observables')
         if (present(observed)) then
            call add_observables(list, observed%values)
         else
            allocate (seen, source=observe(simulation))
            call add_observables(list, seen%values)
         end if
      case ('patches')
         call add_patches(list, simulation, observed)
      case ('cycles')
         if (simulation%cycle_count > 0) call add_cycles(list, simulation)
      case ('reference')
         call add_reference(list, simulation)
      case ('error_estimate')
         if (has_estimate(simulation)) call add_estimate(list, simulation%estimate)
      case ('sensitivity')
         if (has_sensitivity(simulation)) call add_sensitivity(list, simulation%sensitivity)
      case ('history')
         if (simulation%keep_history /= history_none) call add_history(list, simulation)
      case default
         do i = 1, size(moment_names)
            if (group == 'moments/'//moment_names(i)) call add_moment(list, simulation, moment_marks(i))
         end do
         number = 0
         if (index(group, 'steps/') == 1) read (group(len('steps/') + 1:), '(i10)', iostat=code) number
         if (number >= 1 .and. number <= simulation%snapshot_count) then
            if (group == step_group(number)) call add_step(list, simulation, number)
         end if
      end select
      call move_alloc(list%fields, fields)
   end subroutine group_fields

   !> Whether there are error bars.
   pure logical function has_estimate(simulation)
      type(simulation_type), intent(in) :: simulation

      has_estimate = .false.
      if (allocated(simulation%estimate)) has_estimate = simulation%estimate%message == ''
   end function has_estimate

   !> Whether a run with perturbed friction has been compared.
   pure logical function has_sensitivity(simulation)
      type(simulation_type), intent(in) :: simulation

      has_sensitivity = .false.
      if (allocated(simulation%sensitivity)) has_sensitivity = simulation%sensitivity%message == ''
   end function has_sensitivity

   !> Place of the field with a name, 0 for none.
   pure integer function field_named(fields, name)
      type(field_type), intent(in) :: fields(:)
      character(*), intent(in) :: name

      do field_named = size(fields), 1, -1
         if (fields(field_named)%name == name) return
      end do
   end function field_named

   !> Names and texts of the attributes of a result. `warnings`: see mfv_validity; the caller finds them once, because they take a
   !> search for the largest stress. `observed`: as for group_fields.
   subroutine result_attributes(case, simulation, warnings, names, texts, observed)
      type(case_type), intent(in) :: case
      type(simulation_type), intent(in) :: simulation
      type(string_type), intent(in) :: warnings(:)
      type(string_type), allocatable, intent(out) :: names(:), texts(:)
      type(observed_type), intent(in), optional :: observed
      character(:), allocatable :: text, directory, unresolved
      integer :: i

      call find_working_directory(directory)
      call find_unresolved_observables(simulation, unresolved, observed)
      text = ''
      do i = 1, size(warnings)
         if (i > 1) text = text//achar(10)
         text = text//warnings(i)%text
      end do
      call add('title', case%scene%title)
      call add('outcome', status_outcome(simulation%outcome))
      call add('message', simulation%message)
      call add('warnings', text)
      call add('unresolved', unresolved)
      call add('input', case%text)
      call add('input_file', case%source)
      call add('options', trim(case%options))
      call add('working_directory', directory)
      call add('mfv_version', library_version)
      call add('length_unit', case%length_unit)
      call add('force_unit', case%force_unit)
      call add('plane', trim(word_of(plane_names, case%scene%plane)))
      call add('coupling', trim(word_of(coupling_names, case%scene%coupling)))
      call add('friction_law', trim(case%scene%friction%name()))
      call add('algorithm', trim(word_of(algorithm_names, case%scene%method%algorithm)))
      call add('stepping', trim(word_of(stepping_names, simulation%contact%model%scene%method%stepping)))
      call add('linear_solver', trim(simulation%contact%system%name))
      call add('lower_body', trim(body_name(case%scene%lower)))
      call add('upper_body', trim(body_name(case%scene%upper)))
      if (allocated(simulation%estimate)) call add('error_estimate', trim(merge('yes ', 'none', has_estimate(simulation)))// &
                                                   separated(simulation%estimate%message))
      if (allocated(simulation%sensitivity)) call add('sensitivity', trim(merge('yes ', 'none', has_sensitivity(simulation)))// &
                                                      separated(simulation%sensitivity%message))

   contains

      subroutine add(name, text)
         character(*), intent(in) :: name, text

         call add_text(names, name)
         call add_text(texts, text)
      end subroutine add
   end subroutine result_attributes

   !> A text after a colon; empty if there is none.
   pure function separated(text) result(tail)
      character(*), intent(in) :: text
      character(len=merge(len(text) + 2, 0, text /= '')) :: tail

      tail = ': '//text
   end function separated

   !> Shape of a body, in words; padded with blanks.
   pure function body_name(body) result(name)
      type(body_type), intent(in) :: body
      character(len=len('rigid ') + len(shape_names)) :: name

      name = word_of(shape_names, body%shape)
      if (body%rigid) name = 'rigid '//word_of(shape_names, body%shape)
   end function body_name

   subroutine add_scene(list, simulation)
      type(list_type), intent(inout) :: list
      type(simulation_type), intent(in) :: simulation
      type(near_field_type) :: pair

      associate (scene => simulation%contact%model%scene)
         call add_body(list, 'lower', scene%lower)
         call add_body(list, 'upper', scene%upper)
         if (scene%modulus() > 0.0_wp) then
            call list%add('contact_modulus', scene%modulus(), 'force/length^2', 'modulus m of both bodies, 1/m = sum of '// &
                          '(kappa + 1)/(4 G); of anisotropic bodies of their compliances A under pressure; of layers: of '// &
                          'the first ones')
            call list%add('dundurs_beta', scene%beta(), '1', "Dundurs' parameter beta, positive if the lower body "// &
                          "couples more strongly")
            pair = scene%near_field()
            if (scene%lower%elasticity%material%is_anisotropic() .or. scene%upper%elasticity%material%is_anisotropic()) then
               call list%add('contact_shear_modulus', scene%modulus()/pair%shear_ratio(), 'force/length^2', 'modulus of '// &
                             'anisotropic bodies under shear: 1/At of both')
               call list%add('contact_mixed_ratio', pair%mixed/pair%normal, '1', 'compliance between pressure and shear over '// &
                             'that under pressure, of oblique anisotropic bodies')
            end if
         end if
         call list%add('curvature', scene%curvature(), '1/length', 'relative curvature of disks and holes at the origin')
         call list%add('friction_coefficient', scene%friction%static%largest(), '1', 'largest (static) coefficient of '// &
                       'friction, 0 without friction')
      end associate
   end subroutine add_scene

   !> What is known of one body.
   subroutine add_body(list, name, body)
      type(list_type), intent(inout) :: list
      character(*), intent(in) :: name
      type(body_type), intent(in) :: body
      character(:), allocatable :: layer
      integer :: i

      if (body%circular()) call list%add(name//'_radius', body%radius, 'length', 'radius of the '//name//' body')
      associate (elasticity => body%elasticity, material => body%elasticity%material)
         if (.not. material%exists()) return
         if (elasticity%is_layered()) then
            call list%add(name//'_layers', size(elasticity%layer), 'layers of the '//name//' body, numbered from the surface down')
            do i = 1, size(elasticity%layer)
               layer = 'layer '//to_text(i)//' of the '//name//' body'
               call list%add(name//'_layer_'//to_text(i)//'_thickness', elasticity%layer(i)%thickness, 'length', &
                             'thickness of '//layer)
               call add_material(list, name//'_layer_'//to_text(i), layer, elasticity%layer(i)%material, name == 'upper')
            end do
            if (elasticity%base%exists()) call add_material(list, name//'_base', 'what is below the layers of the '//name// &
                                                            ' body', elasticity%base, name == 'upper')
            layer = 'the '//name//' body at its surface'
         else
            layer = 'the '//name//' body'
         end if
         call add_material(list, name, layer, material, name == 'upper')
         if (.not. elasticity%has_datum()) return
         call list%add(name//'_datum', elasticity%datum, 'length', 'distance from the origin at which displacements of the '// &
                       name//' body are measured')
         call list%add(name//'_datum_of_case', merge(1, 0, elasticity%datum_of_case), 'whether this is a default that depends '// &
                       'on the loads or the mesh of this case')
      end associate
   end subroutine add_body

   !> A material; `name`: of its fields, `of`: whose it is; `upside_down`: seen from the upper body.
   subroutine add_material(list, name, of, material, upside_down)
      type(list_type), intent(inout) :: list
      character(*), intent(in) :: name, of
      type(material_type), intent(in) :: material
      logical, intent(in) :: upside_down
      character(*), parameter :: places(6) = ['11', '12', '22', '16', '26', '66']
      type(material_type) :: seen
      integer :: i

      if (material%is_isotropic()) then
         call list%add(name//'_shear_modulus', material%shear_modulus, 'force/length^2', 'shear modulus of '//of)
         call list%add(name//'_poisson_ratio', material%poisson_ratio, '1', "Poisson's ratio of "//of)
         call list%add(name//'_kolosov_constant', material%kolosov, '1', "Kolosov's constant of "//of)
         return
      end if
      seen = material
      if (upside_down) seen = material%mirrored()
      do i = 1, size(places)
         call list%add(name//'_compliance_'//places(i), seen%compliance(i), 'length^2/force', 'compliance s'//places(i)//' of '// &
                       of//' along x and y, in its plane state')
      end do
   end subroutine add_material

   !> Compliance blocks of the scene, and memory of the kernels or matrices.
   subroutine add_compliance(list, simulation)
      type(list_type), intent(inout) :: list
      type(simulation_type), intent(in) :: simulation
      character(*), parameter :: blocks(4) = ['wp', 'wt', 'up', 'ut']
      integer :: i, bytes

      associate (pair => simulation%contact%model%compliance)
         do i = 1, size(blocks)
            call list%add(blocks(i), merge(1, 0, pair%elastic_block(i)), 'whether C_'//blocks(i)//' exists')
         end do
         do i = 1, size(body_names)
            bytes = 0
            if (pair%deforms(i)) bytes = int(pair%body(i)%compliance%bytes())
            call list%add(body_names(i)//'_bytes', bytes, 'bytes of the '//body_names(i)//" body's kernels or matrix")
            if (simulation%contact%model%scene%has_layers(i == 2)) &
               call list%add(body_names(i)//'_kernel_error', pair%body(i)%compliance%kernel_error, '1', 'estimated error of '// &
                             'the kernels of the layers of the '//body_names(i)//' body, over their largest value')
         end do
      end associate
   end subroutine add_compliance

   subroutine add_mesh(list, simulation)
      type(list_type), intent(inout) :: list
      type(simulation_type), intent(in) :: simulation

      associate (model => simulation%contact%model)
         call list%add('x', model%x, along_nodes, 'length', 'position of the nodes')
         call list%add('initial_gap', visible_gap(simulation, model%initial_gap - model%worn), along_nodes, 'length', &
                       'gap of the undeformed bodies, infinite where one of them has no surface')
         if (model%scene%arc_radius() > 0.0_wp) call list%add('arc', model%arc, along_nodes, 'length', 'distance of the nodes '// &
                                                              'from the origin along the surface')
         call list%add('interval', model%interval(), 'length', 'width of an interval')
         call list%add('width', model%width, along_nodes, 'length', 'length of the surface interval of each node')
         if (model%scene%friction%acts()) then
            call list%add('static_friction', model%static_friction, along_nodes, '1', 'coefficient of friction of stuck nodes')
            call list%add('kinetic_friction', model%kinetic_friction, along_nodes, '1', 'coefficient of friction of '// &
                          'slipping nodes, after weakening')
         end if
      end associate
   end subroutine add_mesh

   !> The fields of a state, with the edges of all zones.
   subroutine add_state(list, simulation, state)
      type(list_type), intent(inout) :: list
      type(simulation_type), intent(in) :: simulation
      type(contact_state_type), intent(in) :: state
      real(wp), dimension(simulation%contact%model%nodes()) :: contact_edge, stick_edge
      character(*), parameter :: where_from = ' zones between nodes, along the surface from the origin: the left edge at the '// &
                                 'first node of a zone, the right one at its last node; NaN at all others'

      call add_displacements(list, simulation, state)
      associate (model => simulation%contact%model)
         call list%add('pressure', state%fields%pressure, along_nodes, 'force/length^2', pressure_meaning)
         call list%add('shear', state%fields%shear, along_nodes, 'force/length^2', shear_meaning)
         call list%add('gap', visible_gap(simulation, model%gap(state%fields) + state%worn - model%worn), along_nodes, 'length', &
                       'gap between the bodies, infinite where one of them has no surface')
         call list%add('slip', modelled(simulation, state%fields%slip()), along_nodes, 'length', 'slip s = u - U of the lower '// &
                       'surface relative to the upper one (not modelled without friction)')
         call list%add('status', state%status, along_nodes, 'contact status of the nodes', node_status_names)
         if (model%tangential) call list%add('friction_work', state%friction_work, along_nodes, 'force/length', 'energy '// &
                                             'dissipated so far per unit of surface')
      end associate
      if (simulation%contact%model%scene%wear%acts()) &
         call list%add('wear_depth', state%worn, along_nodes, 'length', 'depth worn off both surfaces together')
      call find_edges_at_nodes(simulation%contact%model, state, contact_edge, stick_edge)
      call list%add('contact_edge', contact_edge, along_nodes, 'length', 'edges of contact'//where_from)
      if (simulation%contact%model%tangential) call list%add('stick_edge', stick_edge, along_nodes, 'length', 'edges of stick'// &
                                                             where_from)
   end subroutine add_state

   !> Displacements of the surface of each elastic body.
   subroutine add_displacements(list, simulation, state)
      type(list_type), intent(inout) :: list
      type(simulation_type), intent(in) :: simulation
      type(contact_state_type), intent(in) :: state
      real(wp), dimension(simulation%contact%model%nodes()) :: normal, tangential
      character(*), parameter :: prefix(2) = [character(6) :: '', 'upper_']
      integer :: side

      do side = lower_body, upper_body
         associate (pair => simulation%contact%model%compliance, &
                    arm => simulation%contact%model%tangential_arm(:, bulk_motions(side)))
            if (.not. pair%deforms(side)) cycle
            call pair%body_displacements(side, state%fields%pressure, state%fields%shear, normal, tangential)
            tangential = tangential + merge(-1.0_wp, 1.0_wp, side == lower_body)*arm*state%fields%motion(bulk_motions(side))
         end associate
         call list%add(trim(prefix(side))//'normal_displacement', normal, along_nodes, 'length', 'displacement w of the '// &
                       body_names(side)//' surface into its body')
         call list%add(trim(prefix(side))//'tangential_displacement', modelled(simulation, tangential), along_nodes, 'length', &
                       'displacement u of the '//body_names(side)//' surface to the right (not modelled without friction)')
      end do
   end subroutine add_displacements

   !> A tangential quantity: NaN in scenes without the tangential problem.
   function modelled(simulation, values)
      type(simulation_type), intent(in) :: simulation
      real(wp), intent(in) :: values(:)
      real(wp) :: modelled(size(values))

      modelled = values
      if (.not. simulation%contact%model%tangential) modelled = ieee_value(1.0_wp, ieee_quiet_nan)
   end function modelled

   !> The gap where the indenter is, infinite elsewhere.
   function visible_gap(simulation, gap) result(visible)
      type(simulation_type), intent(in) :: simulation
      real(wp), intent(in) :: gap(:)
      real(wp) :: visible(size(gap))

      visible = gap
      where (.not. simulation%contact%model%can_touch) visible = ieee_value(1.0_wp, ieee_positive_inf)
   end function visible_gap

   !> The state at the end of a step or reversal, with its loads.
   subroutine add_step(list, simulation, number)
      type(list_type), intent(inout) :: list
      type(simulation_type), intent(in) :: simulation
      integer, intent(in) :: number
      type(contact_state_type) :: state

      state = simulation%padded(simulation%snapshots(number))
      call add_state(list, simulation, state)
      call add_loads(list, simulation, state)
      call list%add('step', simulation%snapshots(number)%step, 'number of the step')
      call list%add('reversal', simulation%snapshots(number)%reversal, 'number of the reversal in the step, 1 for a step '// &
                    'without cycles')
   end subroutine add_step

   !> The tractions at an instant of the last cycle, if there is one.
   subroutine add_moment(list, simulation, mark)
      type(list_type), intent(inout) :: list
      type(simulation_type), intent(in) :: simulation
      integer, intent(in) :: mark
      type(contact_state_type) :: state

      associate (snapshot => simulation%marks(mark))
         if (snapshot%step == 0 .or. (mark /= mark_loading .and. snapshot%reversal == 0)) return
         state = simulation%padded(snapshot)
      end associate
      call list%add('pressure', state%fields%pressure, along_nodes, 'force/length^2', pressure_meaning)
      call list%add('shear', state%fields%shear, along_nodes, 'force/length^2', shear_meaning)
   end subroutine add_moment

   !> Loads, rigid motions and counts of a state.
   subroutine add_loads(list, simulation, state)
      type(list_type), intent(inout) :: list
      type(simulation_type), intent(in) :: simulation
      type(contact_state_type), intent(in) :: state
      logical, parameter :: usual(motion_count) = .not. motions(:motion_count)%optional
      type(zone_edges_type) :: edges

      call find_zone_edges(simulation%contact%model, state, edges)
      associate (f => state%fields)
         call add_motions(list, usual, reshape(f%force, [1, motion_count]), reshape(f%motion, [1, motion_count]), along_nothing)
         call add_motions(list,.not. usual .and. simulation%contact%model%moves(:motion_count), &
                          reshape(f%force, [1, motion_count]), reshape(f%motion, [1, motion_count]), along_nothing)
         call list%add('dissipation', state%dissipation, 'force', dissipation_meaning)
         call list%add('contact_nodes', state%contact_nodes(), contact_nodes_meaning)
         call list%add('stick_nodes', state%stick_nodes(), stick_nodes_meaning)
         call list%add('slip_nodes', state%slip_nodes(), 'slipping nodes')
         call list%add('patches', [edges%patches], along_nothing, 'contact patches, with open nodes between them'//narrow)
         call list%add('contact_half_width', edges%half_width(), 'length', 'half the length of the contact along the surface, '// &
                       'from edges between nodes; NaN with several patches')
        call list%add('stick_ratio', edges%stick_ratio(), '1', 'length of the stick zones over that of the contact, from edges '// &
                       'between nodes')
      end associate
      call add_edges(list, simulation, edges)
   end subroutine add_loads

   !> Edges between nodes.
   subroutine add_edges(list, simulation, edges)
      type(list_type), intent(inout) :: list
      type(simulation_type), intent(in) :: simulation
      type(zone_edges_type), intent(in) :: edges

      if (.not. edges%contact) return
      associate (scene => simulation%contact%model%scene)
         call list%add('contact_left', scene%x_of_arc(edges%contact_left), 'length', 'left edge of the contact'//between_nodes)
         call list%add('contact_right', scene%x_of_arc(edges%contact_right), 'length', 'right edge of the contact'//between_nodes)
         call list%add('contact_length', edges%contact_length, 'length', 'length of the contact along the surface, of all '// &
                       'patches together, from edges between nodes')
         if (.not. edges%stick) return
         call list%add('stick_left', scene%x_of_arc(edges%stick_left), 'length', 'left edge of the stick zones'//between_nodes)
         call list%add('stick_right', scene%x_of_arc(edges%stick_right), 'length', 'right edge of the stick zones'//between_nodes)
      end associate
   end subroutine add_edges

   !> Observables of the load history, where defined.
   subroutine add_observables(list, values)
      type(list_type), intent(inout) :: list
      real(wp), intent(in) :: values(:)
      integer :: i

      do i = 1, observable_count
         if (ieee_is_nan(values(i))) cycle
         associate (row => observables(i))
            call list%add(trim(row%name), values(i), trim(row%unit), trim(row%meaning))
         end associate
      end do
   end subroutine add_observables

   !> The contact patches of the present state, from left to right; none without contact.
   subroutine add_patches(list, simulation, observed)
      type(list_type), intent(inout) :: list
      type(simulation_type), intent(in) :: simulation
      type(observed_type), intent(in), optional :: observed
      integer, parameter :: along = along_patches
      type(patch_type), allocatable :: patches(:)
      integer :: i

      call find_patches(simulation%contact%model, simulation%contact%state, patches)
      if (size(patches) == 0) return
      call list%add('patch', [(i, i=1, size(patches))], along, 'number of the contact patch, from left to right')
      call list%add('first_node', patches%first, along, 'number, from 1, of its first node')
      call list%add('last_node', patches%last, along, 'number, from 1, of its last node')
   call list%add('contact_left', simulation%contact%model%scene%x_of_arc(patches%left), along, 'length', 'left edge'//between_nodes)
call list%add('contact_right', simulation%contact%model%scene%x_of_arc(patches%right), along, 'length', 'right edge'//between_nodes)
      call list%add('contact_length', patches%length(), along, 'length', 'length, from its edges between nodes')
      call add_patch_loads(list, simulation, patches)
      if (present(observed)) then
         call add_patch_edges(list, observed%edges)
      else
         call add_patch_edges(list, present_edge_fields(simulation, patches))
      end if
      if (.not. simulation%contact%model%tangential) return
      call list%add('stick_zones', [(size(patches(i)%stick), i=1, size(patches))], along, 'number of stick zones in the '// &
                    'patch'//narrow)
      call list%add('stick_left', [(outermost(patches(i), .false.), i=1, size(patches))], along, 'length', 'left edge of its '// &
                    'first stick zone'//between_nodes//'; NaN without stick zones')
      call list%add('stick_right', [(outermost(patches(i), .true.), i=1, size(patches))], along, 'length', 'right edge of its '// &
                    'last stick zone'//between_nodes//'; NaN without stick zones')
      call list%add('stick_length', [(sum(patches(i)%stick%length()), i=1, size(patches))], along, 'length', 'length of all '// &
                    'its stick zones, from edges between nodes')

   contains

      !> The left or right edge of the stick zones of a patch.
      pure real(wp) function outermost(patch, right) result(edge)
         type(patch_type), intent(in) :: patch
         logical, intent(in) :: right

         edge = ieee_value(1.0_wp, ieee_quiet_nan)
         if (size(patch%stick) == 0) return
         edge = simulation%contact%model%scene%x_of_arc(patch%stick(1)%left)
         if (right) edge = simulation%contact%model%scene%x_of_arc(patch%stick(size(patch%stick))%right)
      end function outermost
   end subroutine add_patches

   !> Fields at the left and right edges of the patches, shape (2, patches), named as observables; those that no patch has are
   !> omitted.
   subroutine add_patch_edges(list, edges)
      type(list_type), intent(inout) :: list
      type(edge_field_type), intent(in) :: edges(:, :)
      character(*), parameter :: side(2) = [character(5) :: 'left', 'right']
      real(wp) :: values(size(edge_quantities), size(edges, 2))
      integer :: i, j

      do i = 1, size(side)
         do j = 1, size(edges, 2)
            values(:, j) = edges(i, j)%values()
         end do
         do j = 1, size(edge_quantities)
            if (all(ieee_is_nan(values(j, :)))) cycle
            associate (row => observables(observable_place(trim(side(i))//'_'//trim(edge_quantities(j)))))
               call list%add(trim(row%name), values(j, :), along_patches, trim(row%unit), trim(row%meaning))
            end associate
         end do
      end do
   end subroutine add_patch_edges

   !> Forces and peak tractions of the patches; the forces add up to those of the contact.
   subroutine add_patch_loads(list, simulation, patches)
      type(list_type), intent(inout) :: list
      type(simulation_type), intent(in) :: simulation
      type(patch_type), intent(in) :: patches(:)
      integer, parameter :: along = along_patches
      real(wp), dimension(simulation%contact%model%nodes()) :: pressure, shear
      real(wp), dimension(size(patches)) :: normal_force, tangential_force, peak_pressure, peak_shear
      integer :: i

      associate (model => simulation%contact%model, state => simulation%contact%state%fields)
         pressure = 0.0_wp
         shear = 0.0_wp
         do i = 1, size(patches)
            associate (first => patches(i)%first, last => patches(i)%last)
               pressure(first:last) = state%pressure(first:last)
               shear(first:last) = state%shear(first:last)
               normal_force(i) = model%resultant(motion_approach, pressure, shear)
               tangential_force(i) = model%resultant(motion_shift, pressure, shear)
               peak_pressure(i) = maxval(pressure(first:last))
               pressure(first:last) = 0.0_wp
               shear(first:last) = 0.0_wp
            end associate
            peak_shear(i) = largest_shear(model, simulation%contact%state, patches(i))
         end do
      end associate
      call list%add('normal_force', normal_force, along, 'force/length', 'normal force of the patch per unit thickness')
      call list%add('tangential_force', tangential_force, along, 'force/length', 'tangential force of the patch on the lower '// &
                    'body per unit thickness')
      call list%add('peak_pressure', peak_pressure, along, 'force/length^2', 'largest pressure in the patch')
      if (simulation%contact%model%tangential) call list%add('peak_shear', peak_shear, along, 'force/length^2', 'largest '// &
                                                             'size of the shear traction in the patch, also at stick edges '// &
                                                             'between nodes')
   end subroutine add_patch_loads

   !> The cycles, and the distribution of dissipation in the last one.
   subroutine add_cycles(list, simulation)
      type(list_type), intent(inout) :: list
      type(simulation_type), intent(in) :: simulation
      integer, parameter :: along = along_cycles
      type(cycle_type), allocatable :: c(:)
      type(contact_state_type) :: before, after
      integer :: i

      c = simulation%cycles(:simulation%cycle_count)
      call list%add('cycle', c%overall, along, 'number of the cycle, over all steps')
      call list%add('step', c%step, along, 'number of its step')
      call list%add('dissipation', c%dissipation(), along, 'force', 'energy dissipated in the cycle per unit thickness')
      call list%add('change', c%change, along, '1', 'largest change of a traction over the cycle, relative to the largest traction')
      call list%add('force_amplitude', c%force_amplitude(), along, 'force/length', 'half the range of the tangential force')
      call list%add('shift_amplitude', c%shift_amplitude(), along, 'length', 'half the range of the shift')
      call list%add('tangential_stiffness', c%return%stiffness_on_leaving, along, 'force/length^2', 'tangential force over '// &
                    'shift right after the reversal, where all nodes stick')
      call list%add('secant_stiffness', c%secant_stiffness(), along, 'force/length^2', 'tangential force over shift from end '// &
                    'to end')
      call list%add('loss_factor', c%loss_factor(), along, '1', 'area of the loop of tangential force and shift over 2 pi '// &
                    'times the elastic energy of the secant stiffness')
      if (simulation%contact%model%scene%wear%acts()) then
         call list%add('block', c%block, along, 'number of cycles of the block of wear that begins with this one')
         call list%add('worn_area', c%worn_area, along, 'length^2', 'area worn off the profiles before the cycle')
      end if
      do i = 1, motion_count
         if (simulation%contact%model%moves(i)) call list%add(trim(motions(i)%force_key)//'_work', c%loop_area(i), along, 'force', &
                                                              'work of the '//trim(motions(i)%force_name)//' over the cycle: '// &
                                                              'area of its loop, closed by a straight line')
      end do
      do i = 1, motion_count
         if (simulation%contact%model%moves(i) .and. .not. motions(i)%is_known) &
            call list%add(trim(motions(i)%key)//'_drift', c%drift(i), along, trim(motions(i)%unit), 'change of the '// &
                          trim(motions(i)%key)//' over the cycle: not 0 where the upper body walks although tractions repeat')
      end do
      call add_cycle_extremes(list, c)
      call list%add('stick_ratio_lowest', c%extremes%lowest_stick%value, along, '1', 'lowest stick ratio at a turning point')
      call list%add('stick_ratio_highest', c%extremes%highest_stick%value, along, '1', 'highest stick ratio at a turning point')
      call list%add('stick_ratio_reversal', c%reversal%edges%stick_ratio(), along, '1', 'stick ratio at the turning point '// &
                    'whose forces differ most from those at the start')
      call list%add('stick_ratio_return', c%return%edges%stick_ratio(), along, '1', 'stick ratio at the end of the cycle')
      call list%add('contact_centre_reversal', c%reversal%edges%centre(), along, 'length', 'middle of the contact at the '// &
                    'reversal, along the surface from the origin')
      call list%add('contact_centre_return', c%return%edges%centre(), along, 'length', 'middle of the contact at the end of '// &
                    'the cycle, along the surface from the origin')
      call add_cycle_edges(list, c%reversal, '_reversal', 'the reversal')
      call add_cycle_edges(list, c%return, '_return', 'the end of the cycle')
      if (simulation%marks(mark_cycle_start)%step == 0 .or. simulation%marks(mark_return)%reversal == 0) return
      before = simulation%padded(simulation%marks(mark_cycle_start))
      after = simulation%padded(simulation%marks(mark_return))
      call list%add('friction_work', after%friction_work - before%friction_work, along_nodes, 'force/length', 'energy '// &
                    'dissipated in the last cycle per unit of surface')
   end subroutine add_cycles

   !> The outermost edges at turning points, with the names of the observables and a suffix, as far as defined,
   !> without what says how far the asymptotes hold; `moment`: what these are.
   subroutine add_cycle_edges(list, points, suffix, moment)
      type(list_type), intent(inout) :: list
      type(turning_point_type), intent(in) :: points(:)
      character(*), intent(in) :: suffix, moment

      call add('left', points%left)
      call add('right', points%right)

   contains

      subroutine add(side, edges)
         character(*), intent(in) :: side
         type(edge_field_type), intent(in) :: edges(:)
         real(wp) :: values(size(edge_quantities), size(edges))
         character(:), allocatable :: meaning
         integer :: i, place

         values = reshape([(edges(i)%values(), i=1, size(edges))], shape(values))
         do i = 1, size(edge_quantities)
            if (all(ieee_is_nan(values(i, :))) .or. .not. is_in_cycles(i)) cycle
            associate (row => observables(observable_place(side//'_'//trim(edge_quantities(i)))))
               meaning = trim(row%meaning)
               place = index(meaning, ' at the end')
               if (place > 0) meaning = meaning(:place - 1)//meaning(place + len(' at the end'):)
               call list%add(trim(row%name)//suffix, values(i, :), along_cycles, trim(row%unit), 'at '//moment//': '//meaning)
            end associate
         end do
      end subroutine add
   end subroutine add_cycle_edges

   !> Extremes over the cycles: names, units and meanings are those of the observables.
   subroutine add_cycle_extremes(list, c)
      type(list_type), intent(inout) :: list
      type(cycle_type), intent(in) :: c(:)

      call add('largest_pressure', c%extremes%pressure)
      call add('largest_shear', c%extremes%shear)
      call add('largest_slip_range', c%extremes%slip_range)
      call add('largest_lower_tension', c%extremes%searched(candidate_tension(1)))
      call add('largest_upper_tension', c%extremes%searched(candidate_tension(2)))

   contains

      !> Add an extreme with its place and row, if a cycle has it.
      subroutine add(name, extreme)
         character(*), intent(in) :: name
         type(extreme_type), intent(in) :: extreme(:)
         character(*), parameter :: suffix(3) = [character(4) :: '', '_x', '_row']
         real(wp) :: values(size(extreme), size(suffix))
         integer :: i, place

         if (all(extreme%row == 0)) return
         values(:, 1) = extreme%value
         values(:, 2) = extreme%x
         values(:, 3) = extreme%row
         do i = 1, size(suffix)
            where (extreme%row == 0) values(:, i) = ieee_value(1.0_wp, ieee_quiet_nan)
            place = observable_place(name//trim(suffix(i)))
            if (place > observable_count) cycle
            associate (row => observables(place))
               call list%add(trim(row%name), values(:, i), along_cycles, trim(row%unit), of_each_cycle(row%meaning))
            end associate
         end do
      end subroutine add

      !> The meaning of an observable of the last cycle, for every cycle.
      pure function of_each_cycle(meaning) result(text)
         character(*), intent(in) :: meaning
         character(len=len_trim(meaning)) :: text

         text = meaning
         if (index(meaning, ' over the last cycle') > 0) text = meaning(:index(meaning, ' over the last cycle'))//'over the cycle'
      end function of_each_cycle
   end subroutine add_cycle_extremes

   subroutine add_summary(list, simulation, state)
      type(list_type), intent(inout) :: list
      type(simulation_type), intent(in) :: simulation
      type(contact_state_type), intent(in) :: state

      call add_loads(list, simulation, state)
      if (simulation%contact%model%moves(motion_rotation) .and. simulation%contact%state%contact_nodes() > 0) &
         call list%add('creepage', simulation%contact%rolling%creepage(), '1', 'rolling: sliding of the upper body over the '// &
                       'lower per rolled distance, both to the right')
      call list%add('steps_done', simulation%steps_done, 'steps reached')
      call list%add('events', simulation%contact%events, 'loads at which nodes changed their status')
      call list%add('leaps', simulation%contact%certificate%large_increments, &
                    "stepping='leap': large increments, in which events are not located")
      if (simulation%contact%model%scene%method%stepping == stepping_leap) then
         call list%add('increment_traction_error', simulation%contact%certificate%increment_traction_error, '1', &
                       "stepping='leap': largest estimated error of the tractions by large increments, relative to the "// &
                       "largest traction; on rough surfaces a root mean square, relative to that of the tractions")
         call list%add('increment_dissipation_error', simulation%contact%certificate%increment_dissipation_error, '1', &
                       "stepping='leap': largest estimated error of the dissipation of a load segment by large increments, "// &
                       "relative to that dissipation")
      end if
      call list%add('linear_solves', simulation%contact%system%solves, linear_solves_meaning)
      call list%add('largest_residual', simulation%contact%certificate%largest(), '1', 'largest relative residual of the '// &
                    'certificate')
   end subroutine add_summary

   subroutine add_certificate(list, simulation)
      type(list_type), intent(inout) :: list
      type(simulation_type), intent(in) :: simulation
      integer :: kind

      associate (certificate => simulation%contact%certificate)
         call list%add('largest', certificate%largest(), '1', 'largest of the residuals below')
         call list%add('increments', certificate%increments, 'increments that were checked')
         do kind = 1, residual_count
            if (certificate%applies(kind)) call list%add(trim(residual_names(kind)), certificate%residual(kind), '1', &
                                                         trim(residual_descriptions(kind))// &
                                                         ', relative, largest over all increments')
         end do
      end associate
   end subroutine add_certificate

   !> The closed form, where one exists.
   subroutine add_reference(list, simulation)
      type(list_type), intent(inout) :: list
      type(simulation_type), intent(in) :: simulation
      type(closed_form_type) :: form

      form = closed_form_of(simulation)
      if (form%pressure_source /= '') then
         call list%add('pressure', form%pressure, along_nodes, 'force/length^2', form%pressure_source)
         call list%add('contact_half_width', form%half_width, 'length', form%pressure_source)
      end if
      if (form%shear_source /= '') call list%add('shear', form%shear, along_nodes, 'force/length^2', form%shear_source)
      if (allocated(form%shift) .and. simulation%keep_history /= history_none) call list%add('shift', form%shift, along_records, &
                                                                                             'length', form%shear_source)
   end subroutine add_reference

   !> Error bars: of each quantity its value, error, order, and its values on the coarser meshes.
   subroutine add_estimate(list, estimate)
      type(list_type), intent(inout) :: list
      type(error_estimate_type), intent(in) :: estimate
      integer :: i

      call list%add('nodes', estimate%nodes, 'intervals of the mesh, as &mesh nodes counts them')
      call list%add('companion_nodes', estimate%coarser_nodes, along_companions, 'intervals of the coarser meshes')
      do i = 1, observable_count
         call add_bar(list, estimate%bar(i), trim(observables(i)%name), trim(observables(i)%unit), trim(observables(i)%meaning))
      end do
   end subroutine add_estimate

   !> Changes caused by perturbed friction.
   subroutine add_sensitivity(list, sensitivity)
      type(list_type), intent(inout) :: list
      type(sensitivity_type), intent(in) :: sensitivity

      call list%add('perturbation', sensitivity%perturbation, '1', 'relative change of all coefficients of friction in a '// &
                    'second run')
      call list%add('pressure_change', sensitivity%pressure, '1', 'largest change of a pressure over the largest traction, in '// &
                    'the second run')
      call list%add('shear_change', sensitivity%shear, '1', 'largest change of a shear traction over the largest traction, in '// &
                    'the second run')
      call list%add('dissipation_change', sensitivity%dissipation, '1', 'relative change of the dissipation, in the second run')
      call list%add('stick_ratio_change', sensitivity%stick_ratio, '1', 'change of the stick ratio between nodes, in the '// &
                    'second run')
   end subroutine add_sensitivity

   !> One quantity of the error estimate, where the scene has it.
   subroutine add_bar(list, bar, name, unit, meaning)
      type(list_type), intent(inout) :: list
      type(error_bar_type), intent(in) :: bar
      character(*), intent(in) :: name, unit, meaning

      if (.not. bar%known) return
      call list%add(name, bar%value, unit, meaning)
      call list%add(name//'_error', bar%error, unit, 'estimated discretisation error: '//meaning//'; infinite if '// &
                    'there is no limit, NaN if it is not resolved, as a warning says')
      call list%add(name//'_order', bar%order, '1', 'observed order of convergence, from 1 to 2 (negative: no limit; NaN: not '// &
                    'resolved): '//meaning)
      call list%add(name//'_companions', bar%coarser_values, along_companions, unit, 'on the coarser meshes: '//meaning)  ! wording: ok
   end subroutine add_bar

   !> Some of the motions and their forces (shape (values, motion_count)), first the forces.
   subroutine add_motions(list, which, force, motion, along)
      type(list_type), intent(inout) :: list
      logical, intent(in) :: which(motion_count)
      real(wp), intent(in) :: force(:, :), motion(:, :)
      integer, intent(in) :: along
      character(len=len(motions%unit)) :: unit
      integer :: i

      do i = 1, motion_count
         if (which(i)) call list%add(trim(motions(i)%force_key), force(:, i), along, trim(motions(i)%force_unit), &
                                     trim(motions(i)%force_meaning))
      end do
      do i = 1, motion_count
         unit = motions(i)%unit
         if (unit == 'radians') unit = '1'
         if (which(i)) call list%add(trim(motions(i)%key), motion(:, i), along, trim(unit), trim(motions(i)%meaning))
      end do
   end subroutine add_motions

   subroutine add_history(list, simulation)
      type(list_type), intent(inout) :: list
      type(simulation_type), intent(in) :: simulation
      integer, parameter :: along = along_records
      real(wp), dimension(simulation%contact%history%records, motion_count) :: force, motion
      logical :: has_stresses(2)
      integer :: i

      has_stresses = [has_interior(simulation%contact%model%scene%lower), has_interior(simulation%contact%model%scene%upper)]
      associate (r => simulation%contact%history%record(:simulation%contact%history%records))
         call list%add('record', [(i, i=0, size(r) - 1)], along, 'number of the record')
         do i = 1, motion_count
            force(:, i) = r%force(i)
            motion(:, i) = r%motion(i)
         end do
         associate (moves => simulation%contact%model%moves)
            call add_motions(list,.not. motions(:motion_count)%optional, force, motion, along)
            call add_nonlinear_shift(list, simulation)
            call add_motions(list, motions(:motion_count)%optional .and. moves(:motion_count), force, motion, along)
            if (moves(motion_rotation)) call add_rolling(list, simulation)
         end associate
         call list%add('dissipation', r%dissipation, along, 'force', dissipation_meaning)
         call list%add('contact_nodes', r%contact_nodes, along, contact_nodes_meaning)
         call list%add('stick_nodes', r%stick_nodes, along, stick_nodes_meaning)
         call list%add('event_kind', r%event_kind, along, 'kind of the event', event_names)
         call list%add('event_node', r%event_node, along, 'number, from 1, of the first node of the event; 0 for none')
         call list%add('event_count', r%event_count, along, 'number of nodes of the event')
         call list%add('step', r%step, along, 'number of the step, 0 before the first')
         call list%add('linear_solves', r%linear_solves, along, linear_solves_meaning)
         if (allocated(simulation%stress_at)) then
            do i = 1, size(body_names)
               if (.not. has_stresses(i)) cycle
               call list%add(body_names(i)//'_tension', r%tension(i), along, 'force/length^2', 'largest tension along the '// &
                             'surface of the '//body_names(i)//' body; NaN at events')
               call list%add(body_names(i)//'_tension_x', r%tension_x(i), along, 'length', 'where it is: x')
               call list%add(body_names(i)//'_surface_stress', r%surface_stress(i), along, 'force/length^2', 'stress along the '// &
                             'surface of the '//body_names(i)//' body at x = stress_at; NaN at events')
            end do
         end if
      end associate
   end subroutine add_history

   !> Distances of rolling and sliding, if the bodies can roll.
   subroutine add_rolling(list, simulation)
      type(list_type), intent(inout) :: list
      type(simulation_type), intent(in) :: simulation

      associate (model => simulation%contact%model, r => simulation%contact%history%record(:simulation%contact%history%records))
         if (.not. model%rolls()) return
         call list%add('rolled', -r%motion(motion_rotation)/model%scene%curvature(), along_records, 'length', 'distance that '// &
                       'the contact has rolled to the right along the surfaces')
         call list%add('slid', r%motion(motion_shift) + model%centre_height()*r%motion(motion_rotation), along_records, 'length', &
                       'rigid-body sliding of the upper surface to the right over the lower one')
      end associate
   end subroutine add_rolling

   !> The non-linear part of the hysteresis loop (dissertation Fig. 6.2b): the shift minus that of full stick, for cycles of known
   !> stiffness.
   subroutine add_nonlinear_shift(list, simulation)
      type(list_type), intent(inout) :: list
      type(simulation_type), intent(in) :: simulation
      real(wp) :: stiffness

      if (simulation%cycle_count == 0) return
      stiffness = simulation%cycles(simulation%cycle_count)%return%stiffness_on_leaving
      if (ieee_is_nan(stiffness)) return
      if (.not. abs(stiffness) > 0.0_wp) return
      associate (r => simulation%contact%history%record(:simulation%contact%history%records))
         call list%add('nonlinear_shift', r%motion(motion_shift) - r%force(motion_shift)/stiffness, along_records, 'length', &
                       'shift minus tangential_force over the tangential stiffness right after the last reversal')
      end associate
   end subroutine add_nonlinear_shift

   !> A unit in terms of length and force, with the user's names for those two.
   pure subroutine find_label(list, unit, label)
      type(list_type), intent(in) :: list
      character(*), intent(in) :: unit
      character(:), allocatable, intent(out) :: label
      integer :: i, length

      label = ''
      i = 1
      do while (i <= len(unit))
         length = max(verify(unit(i:)//'/', 'abcdefghijklmnopqrstuvwxyz') - 1, 1)
         select case (unit(i:i + length - 1))
         case ('length')
            label = label//list%length_unit
         case ('force')
            label = label//list%force_unit
         case default
            label = label//unit(i:i + length - 1)
         end select
         i = i + length
      end do
   end subroutine find_label

   subroutine add_number(list, name, value, unit, description)
      class(list_type), intent(inout) :: list
      character(*), intent(in) :: name, unit, description
      real(wp), intent(in) :: value

      call list%add(name, [value], along_nothing, unit, description)
   end subroutine add_number

   subroutine add_count(list, name, value, description)
      class(list_type), intent(inout) :: list
      character(*), intent(in) :: name, description
      integer, intent(in) :: value

      call list%add(name, [value], along_nothing, description)
   end subroutine add_count

   subroutine add_numbers(list, name, values, along, unit, description)
      class(list_type), intent(inout) :: list
      character(*), intent(in) :: name, unit, description
      real(wp), intent(in) :: values(:)
      integer, intent(in) :: along
      character(:), allocatable :: label

      call find_label(list, unit, label)
      call append_field(list%fields, name, along, label, description)
      list%fields(size(list%fields))%values = values
   end subroutine add_numbers

   subroutine add_counts(list, name, values, along, description, flags)
      class(list_type), intent(inout) :: list
      character(*), intent(in) :: name, description
      integer, intent(in) :: values(:), along
      character(*), intent(in), optional :: flags

      call append_field(list%fields, name, along, '1', description)
      list%fields(size(list%fields))%whole = values
      if (present(flags)) list%fields(size(list%fields))%flags = flags
   end subroutine add_counts

   !> Append a field without values; by move_alloc, because gfortran leaks components in array constructors.
   subroutine append_field(fields, name, along, unit, description)
      type(field_type), allocatable, intent(inout) :: fields(:)
      character(*), intent(in) :: name, unit, description
      integer, intent(in) :: along
      type(field_type), allocatable :: longer(:)
      integer :: i, n

      n = size(fields)
      allocate (longer(n + 1))
      do i = 1, n
         call move_field(fields(i), longer(i))
      end do
      longer(n + 1)%name = name
      longer(n + 1)%along = along
      longer(n + 1)%unit = unit
      longer(n + 1)%description = description
      longer(n + 1)%flags = ''
      call move_alloc(longer, fields)
   end subroutine append_field

   subroutine move_field(from, to)
      type(field_type), intent(inout) :: from
      type(field_type), intent(out) :: to

      call move_alloc(from%name, to%name)
      call move_alloc(from%description, to%description)
      call move_alloc(from%unit, to%unit)
      call move_alloc(from%values, to%values)
      call move_alloc(from%whole, to%whole)
      call move_alloc(from%flags, to%flags)
      to%along = from%along
   end subroutine move_field

end module mfv_result_fields
