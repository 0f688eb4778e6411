!> Parameters with respect to which a simulation is differentiated (mfv_derivatives), by their names in a case: keys of &body and
!> &friction, such as body(2)%radius, targets of steps, such as step(2)%shift, or of the next step: shift.
module mfv_case_parameters
   use mfv_case, only: case_type
   use mfv_case_keys, only: case_catalogue
   use mfv_contact_model, only: contact_model_type, needs_equal_intervals, new_contact_model
   use mfv_contact_fields, only: contact_fields_type, new_contact_fields
   use mfv_derivatives, only: parameter_type
   use mfv_draft, only: draft_type, read_draft
   use mfv_error, only: error_type, set_error
   use mfv_key_reader, only: check_groups, reader_type
   use mfv_keys, only: catalogue_type, kind_real, read_key_name
   use mfv_kinds, only: wp
   use mfv_motions, only: motions, user_motions, control_force, control_displacement
   use mfv_namelist, only: parse_namelists
   use mfv_scene, only: algorithm_mfv, scene_type, stepping_leap
   use mfv_simulation, only: simulation_type
   use mfv_status, only: MFV_BAD_ARGUMENT
   use mfv_strings, only: lower_case, quoted, string_type, to_text
   implicit none
   private
   public :: read_parameters

   !> Keys are varied by once and twice this fraction of their value, those that are zero by once and twice this value. The
   !> derivative is the sum of both differences times these weights, over the variation.
   real(wp), parameter :: variation = 1.0e-5_wp, weights(2) = [8.0_wp, -1.0_wp]/12.0_wp

contains

   !> The parameters with these names. Error MFV_BAD_ARGUMENT: an unknown name, a parameter that the simulation has passed, or a
   !> scene without derivatives.
   subroutine read_parameters(case, simulation, names, parameters, error)
      type(case_type), intent(in) :: case
      type(simulation_type), intent(in) :: simulation
      type(string_type), intent(in) :: names(:)
      type(parameter_type), allocatable, intent(out) :: parameters(:)
      type(error_type), allocatable, intent(out) :: error
      type(catalogue_type) :: catalogue
      character(:), allocatable :: why
      integer :: i

      call find_obstacle(case, simulation, why)
      if (why /= '') then
         call set_error(error, MFV_BAD_ARGUMENT, why)
         return
      end if
      catalogue = case_catalogue()
      allocate (parameters(size(names)))
      do i = 1, size(names)
         call read_parameter(case, simulation, catalogue, names(i)%text, parameters(i), why)
         if (why == '') cycle
         call set_error(error, MFV_BAD_ARGUMENT, why)
         return
      end do
   end subroutine read_parameters

   !> Why a simulation cannot be differentiated; empty if it can.
   subroutine find_obstacle(case, simulation, why)
      type(case_type), intent(in) :: case
      type(simulation_type), intent(in) :: simulation
      character(:), allocatable, intent(out) :: why

      why = ''
      associate (scene => simulation%contact%model%scene)
         if (scene%method%algorithm /= algorithm_mfv) then
            why = "derivatives need algorithm='mfv'"
         else if (case%scene%method%stepping == stepping_leap) then
            why = "derivatives need every event: remove stepping='leap'"
         else if (scene%friction%acts() .and. .not. scene%friction%is_proportional()) then
            why = "derivatives need Coulomb's law or no friction, not law='"//trim(scene%friction%name())//"'"
         else if (scene%wear%acts()) then
            why = 'derivatives need surfaces that do not wear: leave out &wear'
         end if
      end associate
   end subroutine find_obstacle

   !> One parameter. `why`: what is wrong; empty if nothing is.
   subroutine read_parameter(case, simulation, catalogue, name, parameter, why)
      type(case_type), intent(in) :: case
      type(simulation_type), intent(in) :: simulation
      type(catalogue_type), intent(in) :: catalogue
      character(*), intent(in) :: name
      type(parameter_type), intent(out) :: parameter
      character(:), allocatable, intent(out) :: why
      character(:), allocatable :: group, key
      integer :: number, next

      next = simulation%steps_done + 1
      parameter%name = lower_case(name)
      if (index(name, '%') == 0) parameter%name = 'step('//to_text(next)//')%'//parameter%name
      call read_key_name(parameter%name, catalogue, group, number, key, why)
      if (why /= '') return
      if (group == 'step') then
         call read_target(key, parameter, why)
         parameter%step = number
         if (why == '' .and. (number < next .or. simulation%current%number > 0 .and. number == next)) &
            why = 'step '//to_text(number)//' has already begun; the next one is step '//to_text(next)
      else if (group /= 'body' .and. group /= 'layer' .and. group /= 'friction') then
         why = 'must be a key of &body, &layer or &friction, or a target of a step'
      else if (catalogue%keys(catalogue%place(group, key))%kind /= kind_real) then
         why = 'is not a number'
      else if (simulation%load_summary%steps > 0) then
         why = 'keys must be named before the first step'
      else
         call vary_key(case, simulation%contact%model, parameter, group, number, key, why)
      end if
      if (why /= '') why = quoted(name)//': '//why
   end subroutine read_parameter

   !> The motion and the control of a target.
   subroutine read_target(key, parameter, why)
      character(*), intent(in) :: key
      type(parameter_type), intent(inout) :: parameter
      character(:), allocatable, intent(inout) :: why
      integer :: i

      do i = 1, user_motions
         if (key == motions(i)%key) parameter%control = control_displacement
         if (key == motions(i)%force_key .and. .not. motions(i)%is_known) parameter%control = control_force
         if (parameter%control /= 0) exit
      end do
      parameter%motion = i
      if (i > user_motions) why = 'is not the target of a motion'
   end subroutine read_target

   !> Models with other values of a key, on the mesh of `model`.
   subroutine vary_key(case, model, parameter, group, number, key, why)
      type(case_type), intent(in) :: case
      type(contact_model_type), intent(in) :: model
      type(parameter_type), intent(inout) :: parameter
      character(*), intent(in) :: group, key
      integer, intent(in) :: number
      character(:), allocatable, intent(inout) :: why
      real(wp) :: value, step
      integer :: i, pair

      call find_value(case, group, number, key, value, why)
      if (why /= '') return
      step = variation*abs(value)
      if (.not. step > 0.0_wp) step = variation
      parameter%weight = weights/step
      allocate (parameter%model(2, size(weights)))
      do pair = 1, size(weights)
         do i = 1, 2
            call build(case, model, parameter%name, value + (2*i - 3)*pair*step, parameter%model(i, pair), why)
            if (why /= '') return
         end do
      end do
      associate (least => parameter%model(1, size(weights)), largest => parameter%model(2, size(weights)))
         if (.not. differ(least, largest)) why = 'has no effect on the contact'
         if (abs(edge(least) - edge(largest)) > 0.0_wp .and. min(edge(least), edge(largest)) <= model%length()) &
            why = 'moves an edge of a body between the nodes, which has no derivative'
      end associate
   end subroutine vary_key

   !> The value of a key in the text of a case.
   subroutine find_value(case, group, number, key, value, why)
      type(case_type), intent(in) :: case
      character(*), intent(in) :: group, key
      integer, intent(in) :: number
      real(wp), intent(out) :: value
      character(:), allocatable, intent(inout) :: why
      type(reader_type) :: reader
      type(error_type), allocatable :: error
      real(wp), allocatable :: values(:)

      value = 0.0_wp
      reader%catalogue = case_catalogue()
      call parse_namelists(case%text, case%source, reader%groups, error)
      if (.not. allocated(error)) call check_groups(reader, error)
      if (.not. allocated(error) .and. number > 0) call reader%real_values(group, number, key, values)
      if (.not. allocated(values)) then
         why = 'is not set in the case; set it to a number'
      else if (size(values) /= 1) then
         why = 'has several values'
      else
         value = values(1)
      end if
   end subroutine find_value

   !> The model of the case with another value of a key, on the initial mesh of `model`.
   subroutine build(case, model, name, value, varied, why)
      type(case_type), intent(in) :: case
      type(contact_model_type), intent(in) :: model
      character(*), intent(in) :: name
      real(wp), intent(in) :: value
      type(contact_model_type), intent(out) :: varied
      character(:), allocatable, intent(inout) :: why
      type(draft_type) :: draft
      type(case_type) :: other
      type(error_type), allocatable :: error

      call read_draft(case%text, case%source, draft, error, case%data)
      if (.not. allocated(error)) call draft%set(name, value, error)
      if (.not. allocated(error)) call draft%make_case(other, error)
      if (allocated(error)) then
         why = 'cannot be varied: '//error%message
         return
      end if
      call hold_mesh(model, other%scene)
      varied = new_contact_model(other%scene)
      if (varied%nodes() /= model%nodes()) why = 'changes the number of nodes'
   end subroutine build

   !> Give a scene the mesh of `model`. A Fourier series needs whole intervals on the circle: there the mesh grows with its radius.
   subroutine hold_mesh(model, scene)
      type(contact_model_type), intent(in) :: model
      type(scene_type), intent(inout) :: scene

      scene%mesh = model%scene%mesh
      if (allocated(scene%mesh%ends) .or. scene%lower%is_matrix()) return
      scene%mesh%whole_circle = .false.
      scene%mesh%nodes = model%nodes()
      scene%mesh%half_width = model%length()
      if (needs_equal_intervals(scene)) scene%mesh%half_width = model%length()*scene%arc_radius()/model%scene%arc_radius()
   end subroutine hold_mesh

   !> Distance of the nearest edge of a body from the origin, length; huge for bodies without edges.
   pure real(wp) function edge(model)
      type(contact_model_type), intent(in) :: model

      edge = min(model%scene%lower%half_extent(), model%scene%upper%half_extent())
   end function edge

   !> Whether two models on the same nodes differ in gaps, arms, friction or compliance.
   logical function differ(one, other)
      type(contact_model_type), intent(in) :: one, other
      type(contact_fields_type) :: fields
      real(wp), dimension(one%nodes(), 2) :: normal, tangential

      fields = new_contact_fields(one%nodes())
      fields%pressure(1) = one%compliance%modulus
      fields%shear(1) = one%compliance%modulus
      call one%compliance%displacements(fields%pressure, fields%shear, normal(:, 1), tangential(:, 1))
      call other%compliance%displacements(fields%pressure, fields%shear, normal(:, 2), tangential(:, 2))
      differ = any(abs(one%initial_gap - other%initial_gap) > 0.0_wp) .or. any(abs(one%normal_arm - other%normal_arm) > 0.0_wp) &
               .or. any(abs(one%tangential_arm - other%tangential_arm) > 0.0_wp) &
               .or. any(abs(one%static_friction - other%static_friction) > 0.0_wp) &
               .or. any(abs(normal(:, 1) - normal(:, 2)) > 0.0_wp) .or. any(abs(tangential(:, 1) - tangential(:, 2)) > 0.0_wp)
   end function differ

end module mfv_case_parameters
