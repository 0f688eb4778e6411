!> The C interface of include/mfv.h: thin walls around the library. Check the handle, unpack, call, return the status.
module mfv_c
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use, intrinsic :: iso_c_binding
   use mfv_case, only: case_type
   use mfv_case_reader, only: read_case_file, read_case_text
   use mfv_contact_state, only: contact_state_type
   use mfv_discretisation_error, only: estimate_error
   use mfv_error, only: error_type
   use mfv_interior, only: interior_type, largest_type, stress_count
   use mfv_kinds, only: wp
   use mfv_result_fields, only: field_named, field_type, group_fields, result_attributes, result_groups
   use mfv_result_file, only: write_result
   use mfv_scene, only: control_displacement, control_force, control_keep, most_cycles, step_type
   use mfv_simulation, only: new_simulation, simulation_type
   use mfv_status
   use mfv_strings, only: add_text, copy_to_c, string_type, to_text
   use mfv_validity, only: validity_warnings
   use mfv_version, only: library_version
   implicit none
   private

   !> What a handle points to.
   type :: handle_type
      !> A mark by which a freed or foreign handle can be told in most cases.
      integer :: mark = 0
      type(case_type) :: case
      type(simulation_type) :: simulation
      character(:), allocatable :: message
      !> Paths of all fields, and the group that was looked at last: made when asked for, dropped when the state changes.
      type(string_type), allocatable :: paths(:)
      character(:), allocatable :: group
      type(field_type), allocatable :: fields(:)
      !> Warnings, which may take a search for the largest stress; names and texts of the attributes.
      type(string_type), allocatable :: warnings(:), attribute_names(:), attribute_texts(:)
   end type handle_type

   integer, parameter :: valid_mark = 1297499699

   !> mfv_step of the header.
   type, bind(C) :: c_step
      integer(c_size_t) :: size
      real(c_double) :: normal_target, tangential_target
      integer(c_int) :: normal_control, tangential_control, friction, cycles
      real(c_double) :: rotational_target
      integer(c_int) :: rotational_control, unused
      real(c_double) :: steady_tolerance
   end type c_step

   interface
      !> Characters of a C string.
      pure function c_strlen(text) bind(C, name='strlen') result(length)
         import :: c_ptr, c_size_t
         type(c_ptr), value :: text
         integer(c_size_t) :: length
      end function c_strlen
   end interface

contains

   !> See include/mfv.h, as for all that follow.
   function mfv_version(buffer, size) result(status) bind(C, name='mfv_version')
      type(c_ptr), value :: buffer
      integer(c_size_t), value :: size
      integer(c_int) :: status

      status = text_out(library_version, buffer, size)
   end function mfv_version

   function mfv_status_text(code, outcome, outcome_size, explanation, explanation_size) result(status) &
      bind(C, name='mfv_status_text')
      integer(c_int), value :: code
      type(c_ptr), value :: outcome, explanation
      integer(c_size_t), value :: outcome_size, explanation_size
      integer(c_int) :: status

      status = text_out(status_outcome(code), outcome, outcome_size)
      status = max(status, text_out(status_explanation(code), explanation, explanation_size))
      if (status_exit_code(code) < 0) status = MFV_BAD_ARGUMENT
   end function mfv_status_text

   function mfv_create_from_file(path, handle, message, message_size) result(status) bind(C, name='mfv_create_from_file')
      type(c_ptr), value :: path, message
      type(c_ptr), intent(out) :: handle
      integer(c_size_t), value :: message_size
      integer(c_int) :: status
      type(case_type) :: case
      type(error_type), allocatable :: error

      handle = c_null_ptr
      status = MFV_BAD_ARGUMENT
      if (.not. c_associated(path)) return
      call read_case_file(text_in(path), case, error, without_steps=.true.)
      call finish_creation(case, error, handle, message, message_size, status)
   end function mfv_create_from_file

   function mfv_create_from_text(text, name, handle, message, message_size) result(status) &
      bind(C, name='mfv_create_from_text')
      type(c_ptr), value :: text, name, message
      type(c_ptr), intent(out) :: handle
      integer(c_size_t), value :: message_size
      integer(c_int) :: status
      type(case_type) :: case
      type(error_type), allocatable :: error

      handle = c_null_ptr
      status = MFV_BAD_ARGUMENT
      if (.not. c_associated(text)) return
      if (c_associated(name)) then
         call read_case_text(text_in(text), text_in(name), case, error, without_steps=.true.)
      else
         call read_case_text(text_in(text), 'text', case, error, without_steps=.true.)
      end if
      call finish_creation(case, error, handle, message, message_size, status)
   end function mfv_create_from_text

   !> Make a handle of a case that was read, or tell why it was not.
   subroutine finish_creation(case, error, handle, message, message_size, status)
      type(case_type), intent(in) :: case
      type(error_type), allocatable, intent(in) :: error
      type(c_ptr), intent(inout) :: handle
      type(c_ptr), intent(in) :: message
      integer(c_size_t), intent(in) :: message_size
      integer(c_int), intent(out) :: status
      type(handle_type), pointer :: self
      integer(c_int) :: copied

      if (allocated(error)) then
         status = error%status
         if (c_associated(message)) copied = text_out(error%message, message, message_size)
         return
      end if
      allocate (self)
      self%mark = valid_mark
      self%case = case
      self%simulation = new_simulation(case%scene, case%keep_history, case%keep_states)
      self%message = self%simulation%message
      handle = c_loc(self)
      status = MFV_COMPLETE
      if (c_associated(message)) copied = text_out('', message, message_size)
   end subroutine finish_creation

   function mfv_free(handle) result(status) bind(C, name='mfv_free')
      type(c_ptr), value :: handle
      integer(c_int) :: status
      type(c_ptr), pointer :: slot
      type(handle_type), pointer :: self

      status = MFV_COMPLETE
      if (.not. c_associated(handle)) return
      call c_f_pointer(handle, slot)
      if (.not. c_associated(slot)) return
      self => handle_of(slot)
      slot = c_null_ptr
      status = MFV_BAD_HANDLE
      if (.not. associated(self)) return
      self%mark = 0
      deallocate (self)
      status = MFV_COMPLETE
   end function mfv_free

   function mfv_run(handle) result(status) bind(C, name='mfv_run')
      type(c_ptr), value :: handle
      integer(c_int) :: status
      type(handle_type), pointer :: self

      status = MFV_BAD_HANDLE
      self => handle_of(handle)
      if (.not. associated(self)) return
      if (self%simulation%outcome == MFV_COMPLETE) then
         call forget(self)
         call self%simulation%run()
         if (self%case%error_estimate) call estimate_error(self%simulation)
         if (self%simulation%outcome /= MFV_COMPLETE) call self%case%explain(self%simulation)
      end if
      self%message = self%simulation%message
      status = self%simulation%outcome
   end function mfv_run

   function mfv_advance(handle, step) result(status) bind(C, name='mfv_advance')
      type(c_ptr), value :: handle, step
      integer(c_int) :: status
      type(handle_type), pointer :: self
      type(c_step), pointer :: given
      character(:), allocatable :: why

      status = MFV_BAD_HANDLE
      self => handle_of(handle)
      if (.not. associated(self)) return
      status = refused(self, 'mfv_advance: the step is null')
      if (.not. c_associated(step)) return
      call c_f_pointer(step, given)
      call find_fault(given, why)
      status = refused(self, 'mfv_advance: '//why)
      if (why /= '') return
      if (self%simulation%outcome == MFV_COMPLETE) then
         call forget(self)
         call self%simulation%advance(step_type(given%normal_control, given%tangential_control, given%normal_target, &
                                                given%tangential_target, given%friction /= 0, given%cycles, &
                                                given%rotational_control, given%rotational_target, &
                                                given%steady_tolerance))
      end if
      self%message = self%simulation%message
      status = self%simulation%outcome
   end function mfv_advance

   !> What is wrong with a step; empty when nothing is.
   subroutine find_fault(step, why)
      type(c_step), intent(in) :: step
      character(:), allocatable, intent(out) :: why
      integer, parameter :: controls(3) = [control_keep, control_force, control_displacement]

      why = ''
      if (step%size /= c_sizeof(step)) then
         why = 'size is not sizeof(mfv_step)'
      else if (.not. any(step%normal_control == controls) .or. .not. any(step%tangential_control == controls) .or. &
               .not. any(step%rotational_control == controls)) then
         why = 'a control must be MFV_KEEP, MFV_FORCE or MFV_DISPLACEMENT'
      else if (.not. all(ieee_is_finite([step%normal_target, step%tangential_target, step%rotational_target]))) then
         why = 'a target is not finite'
      else if (step%normal_control == control_force .and. step%normal_target < 0.0_wp) then
         why = 'the normal force must not be negative'
      else if (.not. (step%steady_tolerance >= 0.0_wp .and. ieee_is_finite(step%steady_tolerance))) then
         why = 'steady_tolerance must not be negative'
      else if (step%cycles < 0 .or. step%cycles > most_cycles) then
         why = 'cycles must be from 0 to '//to_text(most_cycles)
      end if
   end subroutine find_fault

   function mfv_message(handle, buffer, size) result(status) bind(C, name='mfv_message')
      type(c_ptr), value :: handle, buffer
      integer(c_size_t), value :: size
      integer(c_int) :: status
      type(handle_type), pointer :: self

      status = MFV_BAD_HANDLE
      self => handle_of(handle)
      if (associated(self)) status = text_out(self%message, buffer, size)
   end function mfv_message

   function mfv_field_count(handle, count) result(status) bind(C, name='mfv_field_count')
      type(c_ptr), value :: handle, count
      integer(c_int) :: status
      type(handle_type), pointer :: self
      integer(c_size_t), pointer :: number

      status = MFV_BAD_HANDLE
      self => handle_of(handle)
      if (.not. associated(self)) return
      status = refused(self, 'mfv_field_count: count is null')
      if (.not. c_associated(count)) return
      call c_f_pointer(count, number)
      call list_paths(self)
      number = size(self%paths, kind=c_size_t)
      status = MFV_COMPLETE
   end function mfv_field_count

   function mfv_field_path(handle, index, buffer, size) result(status) bind(C, name='mfv_field_path')
      type(c_ptr), value :: handle, buffer
      integer(c_size_t), value :: index, size
      integer(c_int) :: status
      type(handle_type), pointer :: self

      status = MFV_BAD_HANDLE
      self => handle_of(handle)
      if (.not. associated(self)) return
      call list_paths(self)
      status = refused(self, 'mfv_field_path: there are '//to_text(ubound(self%paths, 1))//' fields')
      if (index < 0 .or. index >= ubound(self%paths, 1)) return
      status = text_out(self%paths(index + 1)%text, buffer, size)
   end function mfv_field_path

   !> Make the list of the paths of all fields.
   subroutine list_paths(self)
      type(handle_type), intent(inout) :: self
      type(string_type), allocatable :: groups(:)
      type(field_type), allocatable :: fields(:)
      integer :: i, j

      if (allocated(self%paths)) return
      groups = result_groups(self%simulation)
      do i = 1, size(groups)
         call group_fields(self%case, self%simulation, groups(i)%text, fields)
         do j = 1, size(fields)
            call add_text(self%paths, groups(i)%text//'/'//fields(j)%name)
         end do
      end do
   end subroutine list_paths

   !> The state is about to change: drop what was made from it.
   subroutine forget(self)
      type(handle_type), intent(inout) :: self

      if (allocated(self%paths)) deallocate (self%paths)
      if (allocated(self%group)) deallocate (self%group)
      if (allocated(self%fields)) deallocate (self%fields)
      if (allocated(self%warnings)) deallocate (self%warnings)
      if (allocated(self%attribute_names)) deallocate (self%attribute_names, self%attribute_texts)
   end subroutine forget

   !> MFV_BAD_ARGUMENT, with its reason as the handle's message.
   function refused(self, why) result(status)
      type(handle_type), intent(inout) :: self
      character(*), intent(in) :: why
      integer(c_int) :: status

      self%message = why
      status = MFV_BAD_ARGUMENT
   end function refused

   function mfv_attribute_name(handle, index, buffer, size) result(status) bind(C, name='mfv_attribute_name')
      type(c_ptr), value :: handle, buffer
      integer(c_size_t), value :: index, size
      integer(c_int) :: status
      type(handle_type), pointer :: self

      status = MFV_BAD_HANDLE
      self => handle_of(handle)
      if (.not. associated(self)) return
      call list_attributes(self)
      status = refused(self, 'mfv_attribute_name: there are '//to_text(ubound(self%attribute_names, 1))//' attributes')
      if (index < 0 .or. index >= ubound(self%attribute_names, 1)) return
      status = text_out(self%attribute_names(index + 1)%text, buffer, size)
   end function mfv_attribute_name

   function mfv_attribute(handle, name, buffer, size, length) result(status) bind(C, name='mfv_attribute')
      type(c_ptr), value :: handle, name, buffer, length
      integer(c_size_t), value :: size
      integer(c_int) :: status
      type(handle_type), pointer :: self
      integer(c_size_t), pointer :: characters
      integer :: i

      status = MFV_BAD_HANDLE
      self => handle_of(handle)
      if (.not. associated(self)) return
      status = refused(self, 'mfv_attribute: the name is null')
      if (.not. c_associated(name)) return
      call list_attributes(self)
      status = refused(self, "there is no attribute '"//text_in(name)//"'")
      do i = 1, ubound(self%attribute_names, 1)
         if (self%attribute_names(i)%text /= text_in(name)) cycle
         associate (text => self%attribute_texts(i)%text)
            if (c_associated(length)) then
               call c_f_pointer(length, characters)
               characters = len(text, kind=c_size_t)
            end if
            status = MFV_COMPLETE
            if (c_associated(buffer)) status = text_out(text, buffer, size)
         end associate
         return
      end do
   end function mfv_attribute

   !> Make the list of the attributes.
   subroutine list_attributes(self)
      type(handle_type), intent(inout) :: self

      if (allocated(self%attribute_names)) return
      call find_warnings(self)
      call result_attributes(self%case, self%simulation, self%warnings, self%attribute_names, self%attribute_texts)
   end subroutine list_attributes

   !> Have the warnings at hand.
   subroutine find_warnings(self)
      type(handle_type), intent(inout) :: self

      if (.not. allocated(self%warnings)) call validity_warnings(self%simulation, self%warnings)
   end subroutine find_warnings

   function mfv_field_info(handle, path, count, is_integer, along, unit, unit_size, description, description_size) &
      result(status) bind(C, name='mfv_field_info')
      type(c_ptr), value :: handle, path, count, is_integer, along, unit, description
      integer(c_size_t), value :: unit_size, description_size
      integer(c_int) :: status
      type(field_type), pointer :: field
      integer(c_size_t), pointer :: number
      integer(c_int) :: copied

      call field_at(handle, path, field, status)
      if (status /= MFV_COMPLETE) return
      if (c_associated(count)) then
         call c_f_pointer(count, number)
         number = values_of(field)
      end if
      call integer_out(merge(1, 0, allocated(field%whole)), is_integer)
      call integer_out(field%along, along)
      if (c_associated(unit)) copied = text_out(field%unit, unit, unit_size)
      if (c_associated(description)) copied = text_out(field%description, description, description_size)
   end function mfv_field_info

   function mfv_copy_real(handle, path, values, count) result(status) bind(C, name='mfv_copy_real')
      type(c_ptr), value :: handle, path, values
      integer(c_size_t), value :: count
      integer(c_int) :: status
      type(field_type), pointer :: field
      real(c_double), pointer :: copy(:)

      call field_at(handle, path, field, status)
      if (status /= MFV_COMPLETE) return
      status = fit_for_copy(handle, path, field, .false., values, count)
      if (status /= MFV_COMPLETE) return
      call c_f_pointer(values, copy, [count])
      copy = field%values
   end function mfv_copy_real

   function mfv_copy_integer(handle, path, values, count) result(status) bind(C, name='mfv_copy_integer')
      type(c_ptr), value :: handle, path, values
      integer(c_size_t), value :: count
      integer(c_int) :: status
      type(field_type), pointer :: field
      integer(c_int32_t), pointer :: copy(:)

      call field_at(handle, path, field, status)
      if (status /= MFV_COMPLETE) return
      status = fit_for_copy(handle, path, field, .true., values, count)
      if (status /= MFV_COMPLETE) return
      call c_f_pointer(values, copy, [count])
      copy = field%whole
   end function mfv_copy_integer

   !> Whether a field can be copied as reals or whole numbers into `count` places; if not, MFV_BAD_ARGUMENT and why.
   function fit_for_copy(handle, path, field, whole, values, count) result(status)
      type(c_ptr), intent(in) :: handle, path, values
      type(field_type), intent(in) :: field
      logical, intent(in) :: whole
      integer(c_size_t), intent(in) :: count
      integer(c_int) :: status
      type(handle_type), pointer :: self

      status = MFV_COMPLETE
      self => handle_of(handle)
      if (allocated(field%whole) .neqv. whole) then
         status = refused(self, text_in(path)//' has '//trim(merge('whole numbers', 'reals        ', .not. whole)))
      else if (.not. c_associated(values)) then
         status = refused(self, text_in(path)//': values is null')
      else if (count /= values_of(field)) then
         status = refused(self, text_in(path)//' has '//to_text(int(values_of(field)))//' values, count is another number')
      end if
   end function fit_for_copy

   function mfv_stress(handle, body, step, count, x, y, stresses) result(status) bind(C, name='mfv_stress')
      type(c_ptr), value :: handle, x, y, stresses
      integer(c_int), value :: body, step
      integer(c_size_t), value :: count
      integer(c_int) :: status
      type(handle_type), pointer :: self
      type(interior_type) :: interior

      status = MFV_BAD_HANDLE
      self => handle_of(handle)
      if (.not. associated(self)) return
      call interior_of_state(self, body, step, interior, status)
      if (status == MFV_COMPLETE) status = stresses_out(self, interior, count, x, y, stresses)
   end function mfv_stress

   function mfv_largest_von_mises(handle, body, step, place) result(status) bind(C, name='mfv_largest_von_mises')
      type(c_ptr), value :: handle, place
      integer(c_int), value :: body, step
      integer(c_int) :: status
      type(handle_type), pointer :: self
      type(interior_type) :: interior

      status = MFV_BAD_HANDLE
      self => handle_of(handle)
      if (.not. associated(self)) return
      call interior_of_state(self, body, step, interior, status)
      if (status == MFV_COMPLETE) status = largest_out(self, interior, place)
   end function mfv_largest_von_mises

   function mfv_stress_under(handle, body, nodes, arc, width, pressure, shear, count, x, y, stresses, place) &
      result(status) bind(C, name='mfv_stress_under')
      type(c_ptr), value :: handle, arc, width, pressure, shear, x, y, stresses, place
      integer(c_int), value :: body
      integer(c_size_t), value :: nodes, count
      integer(c_int) :: status
      type(handle_type), pointer :: self
      type(interior_type) :: interior
      real(c_double), pointer, dimension(:) :: positions, widths, pressures, shears

      status = MFV_BAD_HANDLE
      self => handle_of(handle)
      if (.not. associated(self)) return
      status = refused(self, 'mfv_stress_under: an array is null')
      if (.not. (c_associated(arc) .and. c_associated(width) .and. c_associated(pressure) .and. c_associated(shear))) return
      call c_f_pointer(arc, positions, [nodes])
      call c_f_pointer(width, widths, [nodes])
      call c_f_pointer(pressure, pressures, [nodes])
      call c_f_pointer(shear, shears, [nodes])
      status = refused(self, 'mfv_stress_under: values must be finite and widths positive')
      if (.not. (all(ieee_is_finite(positions)) .and. all(ieee_is_finite(widths)) .and. all(ieee_is_finite(pressures)) .and. &
                 all(ieee_is_finite(shears)))) return
      if (any(widths <= 0.0_wp)) return
      call make_interior(self, body, positions, widths, pressures, shears, interior, status)
      if (status == MFV_COMPLETE .and. c_associated(stresses)) &
         status = stresses_out(self, interior, count, x, y, stresses)
      if (status == MFV_COMPLETE .and. c_associated(place)) status = largest_out(self, interior, place)
   end function mfv_stress_under

   !> A body under the tractions of the present state or of a step.
   subroutine interior_of_state(self, body, step, interior, status)
      type(handle_type), intent(inout) :: self
      integer(c_int), intent(in) :: body, step
      type(interior_type), intent(out) :: interior
      integer(c_int), intent(out) :: status
      type(contact_state_type) :: state

      status = refused(self, 'there is no step '//to_text(int(step))//'; there are '// &
                       to_text(self%simulation%snapshot_count))
      if (step < 0 .or. step > self%simulation%snapshot_count) return
      state = self%simulation%contact%state
      if (step > 0) state = self%simulation%padded_state(step)
      associate (model => self%simulation%contact%model)
         call make_interior(self, body, model%arc, model%width, state%fields%pressure, state%fields%shear, interior, status)
      end associate
   end subroutine interior_of_state

   subroutine make_interior(self, body, arc, width, pressure, shear, interior, status)
      type(handle_type), intent(inout) :: self
      integer(c_int), intent(in) :: body
      real(wp), intent(in) :: arc(:), width(:), pressure(:), shear(:)
      type(interior_type), intent(out) :: interior
      integer(c_int), intent(out) :: status
      integer(c_int), parameter :: lower = 0, upper = 1
      logical :: available

      status = refused(self, 'the body must be MFV_LOWER or MFV_UPPER')
      if (body /= lower .and. body /= upper) return
      call self%case%scene%interior(body == upper, arc, width, pressure, shear, interior, available)
      status = MFV_COMPLETE
      if (.not. available) status = refused(self, 'the '//merge('upper', 'lower', body == upper)// &
                                            ' body is rigid or a matrix: there are no stresses inside it')
   end subroutine make_interior

   function stresses_out(self, interior, count, x, y, stresses) result(status)
      type(handle_type), intent(inout) :: self
      type(interior_type), intent(in) :: interior
      integer(c_size_t), intent(in) :: count
      type(c_ptr), intent(in) :: x, y, stresses
      integer(c_int) :: status
      real(c_double), pointer :: across(:), up(:), values(:, :)
      integer(c_size_t) :: i

      status = refused(self, 'an array is null')
      if (.not. (c_associated(x) .and. c_associated(y) .and. c_associated(stresses))) return
      call c_f_pointer(x, across, [count])
      call c_f_pointer(y, up, [count])
      call c_f_pointer(stresses, values, [int(stress_count, c_size_t), count])
      do i = 1, count
         values(:, i) = interior%all_stresses(across(i), up(i))
      end do
      status = MFV_COMPLETE
   end function stresses_out

   function largest_out(self, interior, place) result(status)
      type(handle_type), intent(inout) :: self
      type(interior_type), intent(in) :: interior
      type(c_ptr), intent(in) :: place
      integer(c_int) :: status
      real(c_double), pointer :: values(:)
      type(largest_type) :: largest

      status = refused(self, 'place is null')
      if (.not. c_associated(place)) return
      call c_f_pointer(place, values, [3])
      largest = interior%largest_von_mises()
      values = [largest%value, largest%x, largest%y]
      status = MFV_COMPLETE
   end function largest_out

   function mfv_write(handle, path) result(status) bind(C, name='mfv_write')
      type(c_ptr), value :: handle, path
      integer(c_int) :: status
      type(handle_type), pointer :: self
      type(error_type), allocatable :: error
      character(:), allocatable :: where_to

      status = MFV_BAD_HANDLE
      self => handle_of(handle)
      if (.not. associated(self)) return
      where_to = self%case%result_path
      if (c_associated(path)) where_to = text_in(path)
      status = refused(self, 'mfv_write: no path, and the case has no &output file')
      if (where_to == '') return
      call find_warnings(self)
      call write_result(where_to, self%case, self%simulation, self%warnings, error)
      status = MFV_COMPLETE
      self%message = self%simulation%message
      if (.not. allocated(error)) return
      status = error%status
      self%message = error%message
   end function mfv_write

   !> The object of a handle; not associated where it is none.
   function handle_of(handle) result(self)
      type(c_ptr), intent(in) :: handle
      type(handle_type), pointer :: self

      nullify (self)
      if (.not. c_associated(handle)) return
      call c_f_pointer(handle, self)
      if (self%mark /= valid_mark) nullify (self)
   end function handle_of

   !> The field at a path of a handle; MFV_BAD_HANDLE or MFV_BAD_ARGUMENT where there is none. The group it is in is kept,
   !> for the next field of it.
   subroutine field_at(handle, path, field, status)
      type(c_ptr), intent(in) :: handle, path
      type(field_type), pointer, intent(out) :: field
      integer(c_int), intent(out) :: status
      type(handle_type), pointer :: self
      character(:), allocatable :: name
      integer :: number, slash

      nullify (field)
      status = MFV_BAD_HANDLE
      self => handle_of(handle)
      if (.not. associated(self)) return
      status = refused(self, 'the path is null')
      if (.not. c_associated(path)) return
      name = text_in(path)
      status = refused(self, "there is no field '"//name//"'")
      slash = index(name, '/', back=.true.)
      if (slash < 2) return
      call keep_group(self, name(:slash - 1))
      number = field_named(self%fields, name(slash + 1:))
      if (number == 0) return
      field => self%fields(number)
      status = MFV_COMPLETE
   end subroutine field_at

   !> Have the fields of a group at hand.
   subroutine keep_group(self, group)
      type(handle_type), intent(inout) :: self
      character(*), intent(in) :: group

      if (allocated(self%group)) then
         if (self%group == group) return
      end if
      call group_fields(self%case, self%simulation, group, self%fields)
      self%group = group
   end subroutine keep_group

   !> A number through a pointer that may be null.
   subroutine integer_out(value, pointer_to_integer)
      integer, intent(in) :: value
      type(c_ptr), intent(in) :: pointer_to_integer
      integer(c_int), pointer :: place

      if (.not. c_associated(pointer_to_integer)) return
      call c_f_pointer(pointer_to_integer, place)
      place = value
   end subroutine integer_out

   pure integer(c_size_t) function values_of(field)
      type(field_type), intent(in) :: field

      if (allocated(field%whole)) then
         values_of = size(field%whole, kind=c_size_t)
      else
         values_of = size(field%values, kind=c_size_t)
      end if
   end function values_of

   !> Text of a C string.
   function text_in(pointer_to_text) result(text)
      type(c_ptr), intent(in) :: pointer_to_text
      character(len=c_strlen(pointer_to_text)) :: text
      character(kind=c_char), pointer :: characters(:)
      integer :: i

      call c_f_pointer(pointer_to_text, characters, [len(text)])
      do i = 1, len(text)
         text(i:i) = characters(i)
      end do
   end function text_in

   !> Text into a caller's buffer; MFV_BAD_ARGUMENT where there is none.
   function text_out(text, buffer, size) result(status)
      character(*), intent(in) :: text
      type(c_ptr), intent(in) :: buffer
      integer(c_size_t), intent(in) :: size
      integer(c_int) :: status
      character(kind=c_char), pointer :: characters(:)

      status = MFV_BAD_ARGUMENT
      if (.not. c_associated(buffer) .or. size < 1) return
      call c_f_pointer(buffer, characters, [size])
      call copy_to_c(text, characters, int(min(size, int(huge(0), c_size_t))))
      status = MFV_COMPLETE
   end function text_out

end module mfv_c
