!> The one catalogue of what a result consists of: names, meanings, units and values, by group. The result file, the C
!> API and through it Python all take their names from here.
module mfv_result_fields
   use, intrinsic :: ieee_arithmetic, only: ieee_positive_inf, ieee_quiet_nan, ieee_value
   use mfv_case, only: case_type
   use mfv_certificate, only: residual_count, residual_description, residual_name
   use mfv_closed_form, only: closed_form_of, closed_form_type
   use mfv_contact_state, only: contact_state_type
   use mfv_kinds, only: wp
   use mfv_node_status, only: event_names, node_status_names
   use mfv_simulation, only: history_none, simulation_type, snapshot_type
   use mfv_strings, only: add_text, list_of_words, string_type, to_text
   implicit none
   private
   public :: field_type, result_groups, group_fields, find_field, step_group, along_nodes, along_records, along_nothing

   !> What the values of a field run along.
   integer, parameter :: along_nothing = 0, along_nodes = 1, along_records = 2

   !> One named quantity: real `values` or whole numbers `whole`, the other not allocated.
   type :: field_type
      character(:), allocatable :: name, description, unit
      integer :: along = along_nothing
      real(wp), allocatable :: values(:)
      integer, allocatable :: whole(:)
      !> Names of the values 0, 1, ... of a coded quantity; empty for a plain one.
      character(:), allocatable :: flags
   end type field_type

   !> Units of a case, as labels.
   type :: units_type
      character(:), allocatable :: length, force, traction, energy
   end type units_type

contains

   !> Paths of the groups that the result of a simulation has.
   function result_groups(simulation) result(groups)
      type(simulation_type), intent(in) :: simulation
      type(string_type), allocatable :: groups(:)
      integer :: i

      groups = list_of_words('mesh scene state summary certificate')
      if (simulation%keep_history /= history_none) call add_text(groups, 'history')
      call add_text(groups, 'reference')
      do i = 1, size(simulation%snapshots)
         call add_text(groups, step_group(i))
      end do
   end function result_groups

   !> Path of the group of snapshot `number`: steps/0001 and so on.
   pure function step_group(number) result(path)
      integer, intent(in) :: number
      character(:), allocatable :: path
      character(len=16) :: buffer

      write (buffer, '(a,i4.4)') 'steps/', number
      if (number > 9999) buffer = 'steps/'//to_text(number)
      path = trim(buffer)
   end function step_group

   !> The fields of one group; none for a group that does not exist.
   function group_fields(case, simulation, group) result(fields)
      type(case_type), intent(in) :: case
      type(simulation_type), intent(in) :: simulation
      character(*), intent(in) :: group
      type(field_type), allocatable :: fields(:)
      type(units_type) :: units
      integer :: number, code

      units = units_of(case)
      select case (group)
      case ('scene')
         fields = scene_fields(simulation, units)
      case ('mesh')
         fields = mesh_fields(simulation, units)
      case ('state')
         fields = state_fields(simulation, simulation%contact%state, units)
      case ('summary')
         fields = summary_fields(simulation, simulation%contact%state, units)
      case ('certificate')
         fields = certificate_fields(simulation)
      case ('reference')
         fields = reference_fields(simulation, units)
      case ('history')
         allocate (fields(0))
         if (simulation%keep_history /= history_none) fields = history_fields(simulation, units)
      case default
         allocate (fields(0))
         if (index(group, 'steps/') /= 1) return
         read (group(len('steps/') + 1:), '(i10)', iostat=code) number
         if (code /= 0) return
         if (number < 1 .or. number > size(simulation%snapshots)) return
         if (group /= step_group(number)) return
         fields = step_fields(simulation, number, units)
      end select
   end function group_fields

   !> The field at a path such as state/pressure; `found` false where there is none.
   subroutine find_field(case, simulation, path, field, found)
      type(case_type), intent(in) :: case
      type(simulation_type), intent(in) :: simulation
      character(*), intent(in) :: path
      type(field_type), intent(out) :: field
      logical, intent(out) :: found
      type(field_type), allocatable :: fields(:)
      integer :: i, slash, first

      first = merge(2, 1, index(path, '/') == 1)
      slash = index(path, '/', back=.true.)
      found = slash > first
      if (.not. found) return
      fields = group_fields(case, simulation, path(first:slash - 1))
      do i = 1, size(fields)
         found = fields(i)%name == path(slash + 1:)
         if (found) field = fields(i)
         if (found) return
      end do
      found = .false.
   end subroutine find_field

   function scene_fields(simulation, units) result(fields)
      type(simulation_type), intent(in) :: simulation
      type(units_type), intent(in) :: units
      type(field_type), allocatable :: fields(:)

      associate (scene => simulation%contact%model%scene)
         fields = [scalar('shear_modulus', scene%material%shear_modulus, units%traction, 'shear modulus of the half-plane'), &
                   scalar('poisson_ratio', scene%material%poisson_ratio, '1', "Poisson's ratio of the half-plane"), &
                   scalar('kolosov_constant', scene%material%kolosov, '1', "Kolosov's constant of the half-plane"), &
                   scalar('dundurs_beta', scene%material%dundurs_beta(), '1', "Dundurs' parameter beta against the rigid body"), &
                   scalar('radius', scene%indenter%radius, units%length, 'radius of the disk, 0 for another indenter'), &
                   scalar('friction_coefficient', scene%friction%coefficient, '1', 'coefficient of friction, 0 without friction'), &
                   scalar('datum', scene%datum, units%length, &
                          'distance of the surface point from which displacements are measured')]
      end associate
   end function scene_fields

   function mesh_fields(simulation, units) result(fields)
      type(simulation_type), intent(in) :: simulation
      type(units_type), intent(in) :: units
      type(field_type), allocatable :: fields(:)

      associate (model => simulation%contact%model)
         fields = [along('x', model%x, along_nodes, units%length, 'position of the nodes'), &
                   along('initial_gap', visible_gap(simulation, model%initial_gap), along_nodes, units%length, &
                         'gap of the undeformed bodies, infinite beside the indenter'), &
                   scalar('interval', model%interval(), units%length, 'width of an interval')]
      end associate
   end function mesh_fields

   !> The seven fields of a state.
   function state_fields(simulation, state, units) result(fields)
      type(simulation_type), intent(in) :: simulation
      type(contact_state_type), intent(in) :: state
      type(units_type), intent(in) :: units
      type(field_type), allocatable :: fields(:)
      type(field_type) :: status

      status = along_whole('status', state%status, along_nodes, 'contact status of the nodes')
      status%flags = node_status_names
      associate (model => simulation%contact%model)
         fields = [along('pressure', state%fields%pressure, along_nodes, units%traction, 'compressive normal traction p'), &
                   along('shear', state%fields%shear, along_nodes, units%traction, &
                         'shear traction tau on the lower body, positive to the right'), &
                   along('gap', visible_gap(simulation, model%gap(state%fields)), along_nodes, units%length, &
                         'gap between the bodies, infinite beside the indenter'), &
                   along('slip', modelled(state%fields%slip()), along_nodes, units%length, &
                         'slip s = u - U of the lower surface against the upper body (not modelled without friction)'), &
                   along('normal_displacement', state%fields%normal, along_nodes, units%length, &
                         'displacement w of the lower surface into the body'), &
                   along('tangential_displacement', modelled(state%fields%tangential), along_nodes, units%length, &
                         'displacement u of the lower surface to the right (not modelled without friction)'), &
                   status]
      end associate

   contains

      !> NaN in scenes that leave the tangential problem out.
      function modelled(values)
         real(wp), intent(in) :: values(:)
         real(wp) :: modelled(size(values))

         modelled = values
         if (.not. simulation%contact%model%scene%tangential()) modelled = ieee_value(1.0_wp, ieee_quiet_nan)
      end function modelled
   end function state_fields

   !> The gap where the indenter is, infinite elsewhere.
   function visible_gap(simulation, gap) result(visible)
      type(simulation_type), intent(in) :: simulation
      real(wp), intent(in) :: gap(:)
      real(wp) :: visible(size(gap))

      visible = gap
      where (.not. simulation%contact%model%can_touch) visible = ieee_value(1.0_wp, ieee_positive_inf)
   end function visible_gap

   !> The state at the end of a step or reversal, with its loads.
   function step_fields(simulation, number, units) result(fields)
      type(simulation_type), intent(in) :: simulation
      integer, intent(in) :: number
      type(units_type), intent(in) :: units
      type(field_type), allocatable :: fields(:)
      type(contact_state_type) :: state

      state = simulation%padded_state(number)
      fields = [state_fields(simulation, state, units), load_fields(simulation, state, units), &
                scalar_whole('step', simulation%snapshots(number)%step, 'number of the step'), &
                scalar_whole('reversal', simulation%snapshots(number)%reversal, &
                             'number of the reversal in the step, 1 for a step without cycles')]
   end function step_fields

   !> Loads, rigid motions and counts of a state.
   function load_fields(simulation, state, units) result(fields)
      type(simulation_type), intent(in) :: simulation
      type(contact_state_type), intent(in) :: state
      type(units_type), intent(in) :: units
      type(field_type), allocatable :: fields(:)

      associate (f => state%fields)
         fields = [scalar('normal_force', f%normal_force, units%force, 'normal force P per unit thickness'), &
                   scalar('tangential_force', f%tangential_force, units%force, 'tangential force Q per unit thickness'), &
                   scalar('approach', f%approach, units%length, 'approach of the upper body'), &
                   scalar('shift', f%shift, units%length, 'shift of the upper body to the right'), &
                   scalar('dissipation', state%dissipation, units%energy, &
                          'energy dissipated so far per unit thickness'), &
                   scalar_whole('contact_nodes', state%contact_nodes(), 'nodes in contact'), &
                   scalar_whole('stick_nodes', state%stick_nodes(), 'stuck nodes'), &
                   scalar_whole('slip_nodes', state%slip_nodes(), 'slipping nodes'), &
                   scalar('contact_half_width', 0.5_wp*state%contact_nodes()*simulation%contact%model%interval(), &
                          units%length, 'half the length of all intervals in contact'), &
                   scalar('stick_ratio', real(state%stick_nodes(), wp)/max(state%contact_nodes(), 1), '1', &
                          'stuck nodes over nodes in contact')]
      end associate
   end function load_fields

   function summary_fields(simulation, state, units) result(fields)
      type(simulation_type), intent(in) :: simulation
      type(contact_state_type), intent(in) :: state
      type(units_type), intent(in) :: units
      type(field_type), allocatable :: fields(:)

      fields = [load_fields(simulation, state, units), &
                scalar_whole('steps_done', simulation%steps_done, 'steps reached'), &
                scalar_whole('increments', simulation%contact%certificate%increments, &
                             'increments of the load, each up to an event or to the end of a step'), &
                scalar_whole('linear_solves', simulation%contact%system%solves, 'linear solves'), &
                scalar('largest_residual', simulation%contact%certificate%largest(), '1', &
                       'largest relative residual of the certificate')]
   end function summary_fields

   function certificate_fields(simulation) result(fields)
      type(simulation_type), intent(in) :: simulation
      type(field_type), allocatable :: fields(:)
      integer :: kind

      associate (certificate => simulation%contact%certificate)
         fields = [scalar('largest', certificate%largest(), '1', 'largest of the residuals below'), &
                   scalar_whole('increments', certificate%increments, 'increments that were checked')]
         do kind = 1, residual_count
            if (.not. certificate%claimed(kind)) cycle
            fields = [fields, scalar(residual_name(kind), certificate%residual(kind), '1', &
                                     residual_description(kind)//', relative, largest over all increments')]
         end do
      end associate
   end function certificate_fields

   !> The closed form, where one exists.
   function reference_fields(simulation, units) result(fields)
      type(simulation_type), intent(in) :: simulation
      type(units_type), intent(in) :: units
      type(field_type), allocatable :: fields(:)
      type(closed_form_type) :: form

      allocate (fields(0))
      form = closed_form_of(simulation)
      if (form%pressure_source /= '') then
         fields = [fields, along('pressure', form%pressure, along_nodes, units%traction, form%pressure_source), &
                   scalar('contact_half_width', form%half_width, units%length, form%pressure_source)]
      end if
      if (form%shear_source /= '') &
         fields = [fields, along('shear', form%shear, along_nodes, units%traction, form%shear_source)]
      if (allocated(form%shift) .and. simulation%keep_history /= history_none) &
         fields = [fields, along('shift', form%shift, along_records, units%length, form%shear_source)]
   end function reference_fields

   function history_fields(simulation, units) result(fields)
      type(simulation_type), intent(in) :: simulation
      type(units_type), intent(in) :: units
      type(field_type), allocatable :: fields(:)
      integer :: i

      associate (r => simulation%contact%history%record(:simulation%contact%history%records))
         fields = [along_whole('record', [(i, i=0, size(r) - 1)], along_records, 'number of the record'), &
                   along('normal_force', r%normal_force, along_records, units%force, 'normal force P per unit thickness'), &
                   along('tangential_force', r%tangential_force, along_records, units%force, &
                         'tangential force Q per unit thickness'), &
                   along('approach', r%approach, along_records, units%length, 'approach of the upper body'), &
                   along('shift', r%shift, along_records, units%length, 'shift of the upper body to the right'), &
                   along_whole('contact_nodes', r%contact_nodes, along_records, 'nodes in contact'), &
                   along_whole('stick_nodes', r%stick_nodes, along_records, 'stuck nodes'), &
                   along('dissipation', r%dissipation, along_records, units%energy, &
                         'energy dissipated so far per unit thickness'), &
                   along_whole('event_kind', r%event_kind, along_records, 'what happened'), &
                   along_whole('event_node', r%event_node, along_records, &
                               'number, from 1, of the first node it happened to; 0 for none'), &
                   along_whole('event_count', r%event_count, along_records, 'number of nodes it happened to together'), &
                   along_whole('step', r%step, along_records, 'number of the step, 0 before the first'), &
                   along_whole('linear_solves', r%linear_solves, along_records, 'linear solves so far')]
         do i = 1, size(fields)
            if (fields(i)%name == 'event_kind') fields(i)%flags = event_names
         end do
      end associate
   end function history_fields

   function units_of(case) result(units)
      type(case_type), intent(in) :: case
      type(units_type) :: units

      units%length = case%length_unit
      units%force = case%force_unit//'/'//case%length_unit
      units%traction = case%force_unit//'/'//case%length_unit//'^2'
      units%energy = case%force_unit
   end function units_of

   function along(name, values, dimension, unit, description) result(field)
      character(*), intent(in) :: name, unit, description
      real(wp), intent(in) :: values(:)
      integer, intent(in) :: dimension
      type(field_type) :: field

      field%name = name
      field%values = values
      field%along = dimension
      field%unit = unit
      field%description = description
      field%flags = ''
   end function along

   function along_whole(name, values, dimension, description) result(field)
      character(*), intent(in) :: name, description
      integer, intent(in) :: values(:), dimension
      type(field_type) :: field

      field = along(name, [real(wp) ::], dimension, '1', description)
      deallocate (field%values)
      field%whole = values
   end function along_whole

   function scalar(name, value, unit, description) result(field)
      character(*), intent(in) :: name, unit, description
      real(wp), intent(in) :: value
      type(field_type) :: field

      field = along(name, [value], along_nothing, unit, description)
   end function scalar

   function scalar_whole(name, value, description) result(field)
      character(*), intent(in) :: name, description
      integer, intent(in) :: value
      type(field_type) :: field

      field = along_whole(name, [value], along_nothing, description)
   end function scalar_whole

end module mfv_result_fields
