!> The C interface of include/mfv.h: unpack, call, return the status. guards.c calls the procedures `..._unguarded` with the address
!> of an object instead of its handle, and excludes other calls on the object. A null pointer to a number or an array is an absent
!> argument.
module mfv_c
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite, ieee_quiet_nan, ieee_value
   use, intrinsic :: iso_c_binding
   use mfv_case_keys, only: case_catalogue
   use mfv_contact, only: contact_type, count_values, derivative_type, loads_type, new_contact, read_contact, read_contact_text
   use mfv_contact_state, only: contact_state_type
   use mfv_draft, only: draft_type, read_draft
   use mfv_error, only: error_type, set_error
   use mfv_features, only: has_hdf5
   use mfv_handles
   use mfv_interior, only: interior_type, stress_count
   use mfv_kept_state, only: kept_state_type
   use mfv_keys, only: catalogue_type, kind_integer, read_key_name
   use mfv_kinds, only: wp
   use mfv_motions, only: motions, motion_count => user_motions
   use mfv_observables, only: observable_count, observables
   use mfv_observer, only: observer_type
   use mfv_reference_c, only: evaluate_closed_form
   use mfv_result_fields, only: field_type
   use mfv_scene, only: step_type
   use mfv_status
   use mfv_stress_search, only: largest_tension, largest_type, largest_von_mises
   use mfv_strings, only: copy_to_c, from_c, list_of_words, string_type, to_text
   use mfv_version, only: library_version
   implicit none
   private

   !> Calls a function of the caller.
   type, extends(observer_type) :: c_observer_type
      procedure(c_observe), nopass, pointer :: observe => null()
      type(c_ptr) :: user = c_null_ptr
   contains
      procedure :: notify
   end type c_observer_type

   !> The object of a case's handle; those of scenes and states are of draft_type and kept_state_type.
   type :: handle_type
      type(contact_type) :: contact
      type(c_observer_type) :: observer
      character(:), allocatable :: message
   end type handle_type

   !> Name in messages of a text without a name.
   character(*), parameter :: unnamed = 'text'

   !> Larger array sizes, such as (size_t)-1, are errors.
   integer(c_size_t), parameter :: most = 2_c_size_t**31 - 1

   !> Changes of a scene, as in guards.c.
   integer(c_int), parameter :: set_text = 1, set_real = 2, set_reals = 3, set_integer = 4, set_logical = 5, set_data = 6, &
                                remove_key = 7, make_room = 8

   !> mfv_step of the header.
   type, bind(C) :: c_step
      integer(c_size_t) :: size
      real(c_double) :: target(motion_count), steady_tolerance
      integer(c_int) :: control(motion_count), friction, cycles, relative, unused(2)
   end type c_step

   !> mfv_loads of the header.
   type, bind(C) :: c_loads
      integer(c_size_t) :: size
      real(c_double) :: force(motion_count), motion(motion_count), dissipation
      integer(c_int) :: contact_nodes, stick_nodes, slip_nodes, events, linear_solves, unused
   end type c_loads

   !> mfv_progress of the header.
   type, bind(C) :: c_progress
      integer(c_size_t) :: size
      real(c_double) :: fraction
      integer(c_int) :: segment, segments, contact_nodes, stick_nodes
      real(c_double) :: force(motion_count), motion(motion_count)
   end type c_progress

   abstract interface
      !> mfv_observer of the header.
      function c_observe(progress, user) bind(C) result(stop_wanted)
         import :: c_int, c_progress, c_ptr
         type(c_progress), intent(in) :: progress
         type(c_ptr), value :: user
         integer(c_int) :: stop_wanted
      end function c_observe
   end interface

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
   integer(c_int) function mfv_version(buffer, size) result(status) bind(C)
      type(c_ptr), value :: buffer
      integer(c_size_t), value :: size

      status = text_out(library_version, buffer, size)
   end function mfv_version

   integer(c_int) function mfv_status_text(code, outcome, outcome_size, explanation, explanation_size) result(status) bind(C)
      integer(c_int), value :: code
      type(c_ptr), value :: outcome, explanation
      integer(c_size_t), value :: outcome_size, explanation_size

      status = text_out(status_outcome(code), outcome, outcome_size)
      status = max(status, text_out(status_explanation(code), explanation, explanation_size))
      if (status_exit_code(code) < 0) status = MFV_BAD_ARGUMENT
   end function mfv_status_text

   integer(c_int) function mfv_has_feature(feature, there) result(status) bind(C)
      type(c_ptr), value :: feature
      integer(c_int), intent(inout), optional :: there

      status = MFV_BAD_ARGUMENT
      if (.not. (c_associated(feature) .and. present(there))) return
      there = 0
      if (text_in(feature) /= 'hdf5' .or. c_strlen(feature) /= 4) return
      there = merge(1, 0, has_hdf5)
      status = MFV_COMPLETE
   end function mfv_has_feature

   integer(c_int) function mfv_key_info(key, is_integer, unit, unit_size, description, description_size) result(status) bind(C)
      type(c_ptr), value :: key, unit, description
      integer(c_int), intent(inout), optional :: is_integer
      integer(c_size_t), value :: unit_size, description_size
      type(catalogue_type) :: catalogue
      character(:), allocatable :: group, name, why
      integer :: number

      status = MFV_BAD_ARGUMENT
      call say('', unit, unit_size)
      call say('', description, description_size)
      if (.not. c_associated(key)) return
      catalogue = case_catalogue()
      call read_key_name(text_in(key), catalogue, group, number, name, why)
      if (why /= '') return
      associate (found => catalogue%keys(catalogue%place(group, name)))
         if (present(is_integer)) is_integer = merge(1, 0, found%kind == kind_integer)
         call say(found%unit, unit, unit_size)
         call say(found%meaning, description, description_size)
      end associate
      status = MFV_COMPLETE
   end function mfv_key_info

   integer(c_int) function mfv_observable_info(index, name, name_size, unit, unit_size, description, description_size) &
      result(status) bind(C)
      integer(c_size_t), value :: index, name_size, unit_size, description_size
      type(c_ptr), value :: name, unit, description
      integer :: number

      status = MFV_BAD_ARGUMENT
      call say('', name, name_size)
      call say('', unit, unit_size)
      call say('', description, description_size)
      if (index < 0 .or. index >= observable_count) return
      number = int(index) + 1
      call say(trim(observables(number)%name), name, name_size)
      call say(trim(observables(number)%unit), unit, unit_size)
      call say(trim(observables(number)%meaning), description, description_size)
      status = MFV_COMPLETE
   end function mfv_observable_info

   integer(c_int) function mfv_reference(name, count, arguments, value) result(status) bind(C)
      type(c_ptr), value :: name
      integer(c_size_t), value :: count
      real(c_double), intent(in), optional :: arguments(count)
      real(c_double), intent(inout), optional :: value
      logical :: is_known

      status = MFV_BAD_ARGUMENT
      if (.not. (c_associated(name) .and. present(arguments) .and. present(value) .and. is_size(count))) return
      call evaluate_closed_form(text_in(name), arguments, value, is_known)
      if (is_known) status = MFV_COMPLETE
   end function mfv_reference

   ! --- scenes ---

   integer(c_int) function mfv_scene_create(scene) result(status) bind(C)
      type(c_ptr), intent(out), optional :: scene
      type(draft_type), pointer :: draft

      status = MFV_BAD_ARGUMENT
      if (.not. present(scene)) return
      status = MFV_COMPLETE
      allocate (draft)
      call issue(kind_scene, c_loc(draft), scene, status)
      if (status /= MFV_COMPLETE) deallocate (draft)
   end function mfv_scene_create

   integer(c_int) function mfv_scene_from_text(text, name, scene, message, message_size) result(status) bind(C)
      type(c_ptr), value :: text, name, message
      type(c_ptr), intent(out), optional :: scene
      integer(c_size_t), value :: message_size
      type(draft_type), pointer :: draft
      type(error_type), allocatable :: error

      status = MFV_BAD_ARGUMENT
      call say('a pointer is null', message, message_size)
      if (.not. present(scene)) return
      scene = c_null_ptr
      if (.not. c_associated(text)) return
      allocate (draft)
      call read_draft(text_in(text), text_or(name, unnamed), draft, error)
      status = told(error, message, message_size)
      call issue(kind_scene, c_loc(draft), scene, status)
      if (status /= MFV_COMPLETE) deallocate (draft)
   end function mfv_scene_from_text

   !> The handle of a new object, if `status` is MFV_COMPLETE.
   subroutine issue(kind, object, handle, status)
      integer(c_int), intent(in) :: kind
      type(c_ptr), intent(in) :: object
      type(c_ptr), intent(out) :: handle
      integer(c_int), intent(inout) :: status

      handle = c_null_ptr
      if (status /= MFV_COMPLETE) return
      handle = mfv_handle_issue(kind, object)
      if (.not. c_associated(handle)) status = MFV_BAD_HANDLE
   end subroutine issue

   !> All calls that change a scene. `change`: see set_text. `key`: name of a key, or of data. MFV_BAD_ARGUMENT without a key or
   !> usable values; mfv_create then fails as well.
   integer(c_int) function mfv_scene_change(scene, change, key, text, rows, columns, values) result(status) bind(C)
      type(c_ptr), value :: scene, key, text
      integer(c_int), value :: change
      integer(c_size_t), value :: rows, columns
      real(c_double), intent(in), optional :: values(columns, rows)
      type(draft_type), pointer :: draft
      type(error_type), allocatable :: error
      character(:), allocatable :: name
      logical :: usable

      call c_f_pointer(scene, draft)
      status = MFV_BAD_ARGUMENT
      if (.not. c_associated(key)) return
      name = text_in(key)
      select case (change)
      case (set_text)
         usable = c_associated(text)
      case (set_reals)
         usable = present(values) .and. (rows == 0 .or. is_size(rows))
      case (set_data)
         usable = c_associated(text) .and. present(values) .and. is_size(rows) .and. is_size(columns)
      case default
         usable = .true.
      end select
      if (.not. usable) then
         call set_error(error, MFV_INPUT_ERROR, name//': an argument is null, empty or too large')
         call draft%keep_fault(name, error)
         return
      end if
      select case (change)
      case (set_text)
         call draft%set(name, text_in(text), error)
      case (set_real)
         call draft%set(name, values(1, 1), error)
      case (set_reals)
         call draft%set(name, values(1, :), error)
      case (set_integer)
         call draft%set(name, int(values(1, 1)), error)
      case (set_logical)
         call draft%set(name, abs(values(1, 1)) > 0.0_wp, error)
      case (set_data)
         call draft%set_data(name, text_in(text), transpose(values), error)
      case (remove_key, make_room)
         call draft%remove(name, error, alternatives=change == make_room)
      end select
      if (.not. allocated(error)) status = MFV_COMPLETE
   end function mfv_scene_change

   !> Whether this can be the size of an array that a caller has. (The upper half of size_t is below 0 here.)
   pure logical function is_size(count)
      integer(c_size_t), intent(in) :: count

      is_size = count > 0 .and. count <= most
   end function is_size

   integer(c_int) function mfv_scene_text_unguarded(scene, buffer, size, length) result(status) bind(C)
      type(c_ptr), value :: scene, buffer
      integer(c_size_t), value :: size
      integer(c_size_t), intent(inout), optional :: length
      type(draft_type), pointer :: draft
      character(:), allocatable :: text

      call c_f_pointer(scene, draft)
      status = MFV_COMPLETE
      call draft%write_text(text)
      if (present(length)) length = len(text, kind=c_size_t)
      if (c_associated(buffer)) status = text_out(text, buffer, size)
   end function mfv_scene_text_unguarded

   integer(c_int) function mfv_scene_free(scene) result(status) bind(C)
      type(c_ptr), intent(inout), optional :: scene
      type(draft_type), pointer :: draft
      type(c_ptr) :: object

      status = mfv_handle_remove(scene, kind_scene, object)
      if (.not. c_associated(object)) return
      call c_f_pointer(object, draft)
      deallocate (draft)
   end function mfv_scene_free

   integer(c_int) function mfv_create(scene, handle, message, message_size) result(status) bind(C)
      type(c_ptr), value :: scene, message
      type(c_ptr), intent(out), optional :: handle
      integer(c_size_t), value :: message_size
      type(c_ptr) :: object
      type(draft_type), pointer :: draft
      type(handle_type), pointer :: self
      type(error_type), allocatable :: error
      character(:), allocatable :: why

      status = MFV_BAD_ARGUMENT
      call say('the pointer to the handle is null', message, message_size)
      if (.not. present(handle)) return
      handle = c_null_ptr
      status = mfv_handle_enter(scene, kind_scene, use_reading, object)
      if (status /= MFV_COMPLETE) then
         call explain_handle('scene', status, why)
         call say(why, message, message_size)
         return
      end if
      call c_f_pointer(object, draft)
      allocate (self)
      call new_contact(draft, self%contact, error)
      call mfv_handle_leave(scene)
      status = told(error, message, message_size)
      call hand_out(self, handle, status)
   end function mfv_create

   integer(c_int) function mfv_create_from_file(path, handle, message, message_size) result(status) bind(C)
      type(c_ptr), value :: path, message
      type(c_ptr), intent(out), optional :: handle
      integer(c_size_t), value :: message_size
      type(handle_type), pointer :: self
      type(error_type), allocatable :: error

      status = MFV_BAD_ARGUMENT
      call say('a pointer is null', message, message_size)
      if (.not. present(handle)) return
      handle = c_null_ptr
      if (.not. c_associated(path)) return
      allocate (self)
      call read_contact(text_in(path), self%contact, error)
      status = told(error, message, message_size)
      call hand_out(self, handle, status)
   end function mfv_create_from_file

   integer(c_int) function mfv_create_from_text(text, name, handle, message, message_size) result(status) bind(C)
      type(c_ptr), value :: text, name, message
      type(c_ptr), intent(out), optional :: handle
      integer(c_size_t), value :: message_size
      type(handle_type), pointer :: self
      type(error_type), allocatable :: error

      status = MFV_BAD_ARGUMENT
      call say('a pointer is null', message, message_size)
      if (.not. present(handle)) return
      handle = c_null_ptr
      if (.not. c_associated(text)) return
      allocate (self)
      call read_contact_text(text_in(text), text_or(name, unnamed), self%contact, error)
      status = told(error, message, message_size)
      call hand_out(self, handle, status)
   end function mfv_create_from_text

   !> The status of an error, MFV_COMPLETE if there is none; its message is copied to a buffer, which may be null.
   integer(c_int) function told(error, message, message_size) result(status)
      type(error_type), allocatable, intent(in) :: error
      type(c_ptr), intent(in) :: message
      integer(c_size_t), intent(in) :: message_size

      status = MFV_COMPLETE
      call say('', message, message_size)
      if (.not. allocated(error)) return
      status = error%status
      call say(error%message, message, message_size)
   end function told

   !> Copy a text to a buffer, which may be null.
   subroutine say(text, message, message_size)
      character(*), intent(in) :: text
      type(c_ptr), intent(in) :: message
      integer(c_size_t), intent(in) :: message_size
      integer(c_int) :: copied

      copied = text_out(text, message, message_size)
   end subroutine say

   !> The handle of a new case, which is freed if `status` is not MFV_COMPLETE or no handle is available.
   subroutine hand_out(self, handle, status)
      type(handle_type), pointer, intent(inout) :: self
      type(c_ptr), intent(out) :: handle
      integer(c_int), intent(inout) :: status

      call self%contact%get_message(self%message)
      call issue(kind_case, c_loc(self), handle, status)
      if (status /= MFV_COMPLETE) deallocate (self)
   end subroutine hand_out

   integer(c_int) function mfv_copy(handle, copy) result(status) bind(C)
      type(c_ptr), value :: handle
      type(c_ptr), intent(out), optional :: copy
      type(c_ptr) :: object
      type(handle_type), pointer :: self, other

      status = MFV_BAD_ARGUMENT
      if (.not. present(copy)) return
      copy = c_null_ptr
      status = mfv_handle_enter(handle, kind_case, use_reading, object)
      if (status /= MFV_COMPLETE) return
      call c_f_pointer(object, self)
      allocate (other)
      other%contact = self%contact
      call mfv_handle_leave(handle)
      call hand_out(other, copy, status)
   end function mfv_copy

   integer(c_int) function mfv_free(handle) result(status) bind(C)
      type(c_ptr), intent(inout), optional :: handle
      type(handle_type), pointer :: self
      type(c_ptr) :: object

      status = mfv_handle_remove(handle, kind_case, object)
      if (.not. c_associated(object)) return
      call c_f_pointer(object, self)
      deallocate (self)
   end function mfv_free

   integer(c_int) function mfv_observe_unguarded(handle, observer, user) result(status) bind(C)
      type(c_ptr), value :: handle, user
      type(c_funptr), value :: observer
      type(handle_type), pointer :: self

      call c_f_pointer(handle, self)
      nullify (self%observer%observe)
      if (c_associated(observer)) call c_f_procpointer(observer, self%observer%observe)
      self%observer%user = user
      status = MFV_COMPLETE
   end function mfv_observe_unguarded

   !> An observer: `user` points to an integer that is not 0 when the run is to end.
   integer(c_int) function mfv_stop_when_set(progress, user) result(stop_wanted) bind(C)
      type(c_ptr), value :: progress, user
      integer(c_int), pointer, volatile :: flag

      stop_wanted = 0
      if (.not. (c_associated(progress) .and. c_associated(user))) return
      call c_f_pointer(user, flag)
      stop_wanted = flag
   end function mfv_stop_when_set

   !> See mfv_observer; the caller's function may be absent.
   subroutine notify(self, state, segment, segments, fraction, stop_wanted)
      class(c_observer_type), intent(inout) :: self
      type(contact_state_type), intent(in) :: state
      integer, intent(in) :: segment, segments
      real(wp), intent(in) :: fraction
      logical, intent(out) :: stop_wanted
      type(c_progress) :: progress

      stop_wanted = .false.
      if (.not. associated(self%observe)) return
      progress = c_progress(c_sizeof(progress), fraction, segment, segments, state%contact_nodes(), state%stick_nodes(), &
                            state%fields%force(:motion_count), state%fields%motion(:motion_count))
      stop_wanted = self%observe(progress, self%user) /= 0
   end subroutine notify

   integer(c_int) function mfv_run_unguarded(handle) result(status) bind(C)
      type(c_ptr), value :: handle
      type(handle_type), pointer :: self

      call c_f_pointer(handle, self)
      call self%contact%run(self%observer)
      call self%contact%get_message(self%message)
      status = self%contact%status()
   end function mfv_run_unguarded

   function mfv_advance(handle, step) result(status) bind(C, name='mfv_advance_unguarded')
      type(c_ptr), value :: handle, step
      integer(c_int) :: status
      type(handle_type), pointer :: self
      type(c_step), pointer :: given
      type(error_type), allocatable :: error
      type(step_type) :: wanted

      call c_f_pointer(handle, self)
      status = MFV_COMPLETE
      if (.not. c_associated(step)) then
         status = refused(self, 'mfv_advance: the step is null')
         return
      end if
      call c_f_pointer(step, given)
      if (given%size /= c_sizeof(given)) then
         status = refused(self, 'mfv_advance: size is not sizeof(mfv_step)')
         return
      end if
      wanted = step_type(friction=given%friction /= 0, cycles=given%cycles, steady_tolerance=given%steady_tolerance)
      wanted%control(:motion_count) = given%control
      wanted%target(:motion_count) = given%target
      if (associated(self%observer%observe)) then
         call self%contact%advance(wanted, error, given%relative /= 0, self%observer)
      else
         call self%contact%advance(wanted, error, given%relative /= 0)
      end if
      if (allocated(error)) then
         status = refused(self, 'mfv_advance: '//error%message)
      else
         call self%contact%get_message(self%message)
         status = self%contact%status()
      end if
   end function mfv_advance

   integer(c_int) function mfv_get_loads_unguarded(handle, loads) result(status) bind(C)
      type(c_ptr), value :: handle
      type(c_loads), intent(inout), optional :: loads
      type(handle_type), pointer :: self
      type(loads_type) :: now

      call c_f_pointer(handle, self)
      status = expected(self, present(loads), 'mfv_get_loads: loads is null')
      if (status /= MFV_COMPLETE) return
      status = expected(self, loads%size == c_sizeof(loads), 'mfv_get_loads: size is not sizeof(mfv_loads)')
      if (status /= MFV_COMPLETE) return
      now = self%contact%loads()
      loads = c_loads(loads%size, now%force, now%motion, now%dissipation, &
                      now%contact_nodes, now%stick_nodes, now%slip_nodes, now%events, now%linear_solves, 0)
   end function mfv_get_loads_unguarded

   integer(c_int) function mfv_tangent_unguarded(handle, motions, direction, tangent) result(status) bind(C)
      type(c_ptr), value :: handle, direction
      integer(c_int), value :: motions
      real(c_double), intent(inout), optional :: tangent(motions, motions)
      type(handle_type), pointer :: self
      real(c_double), pointer :: towards(:)
      type(error_type), allocatable :: error
      real(wp) :: found(motion_count, motion_count)

      call c_f_pointer(handle, self)
      status = expected(self, motions >= 2 .and. motions <= motion_count, 'mfv_tangent: motions must be from 2 to MFV_MOTIONS')
      if (status /= MFV_COMPLETE) return
      status = expected(self, present(tangent), 'mfv_tangent: tangent is null')
      if (status /= MFV_COMPLETE) return
      nullify (towards)
      if (c_associated(direction)) call c_f_pointer(direction, towards, [motions])
      call self%contact%get_tangent(found(:motions, :motions), error, towards)
      status = failed(self, error)
      if (status == MFV_COMPLETE) tangent = transpose(found(:motions, :motions))
   end function mfv_tangent_unguarded

   integer(c_int) function mfv_differentiate_unguarded(handle, parameters) result(status) bind(C)
      type(c_ptr), value :: handle, parameters
      type(handle_type), pointer :: self
      type(error_type), allocatable :: error

      call c_f_pointer(handle, self)
      status = expected(self, c_associated(parameters), 'mfv_differentiate: parameters is null')
      if (status /= MFV_COMPLETE) return
      call self%contact%differentiate(list_of_words(text_in(parameters)), error)
      status = failed(self, error)
   end function mfv_differentiate_unguarded

   integer(c_int) function mfv_derivative_unguarded(handle, index, loads, count, pressure, shear) result(status) bind(C)
      type(c_ptr), value :: handle
      integer(c_size_t), value :: index, count
      type(c_loads), intent(inout), optional :: loads
      real(c_double), intent(inout), optional :: pressure(count), shear(count)
      type(handle_type), pointer :: self
      type(derivative_type) :: derivative
      type(error_type), allocatable :: error

      call c_f_pointer(handle, self)
      call self%contact%get_derivative(int(min(index, most - 1)) + 1, derivative, error)
      status = failed(self, error)
      if (status /= MFV_COMPLETE) return
      if (present(pressure) .or. present(shear)) &
         status = expected(self, count == size(derivative%pressure), 'mfv_derivative: count must be the number of nodes, '// &
                           to_text(size(derivative%pressure)))
      if (status /= MFV_COMPLETE) return
      if (present(loads)) status = expected(self, loads%size == c_sizeof(loads), 'mfv_derivative: size is not sizeof(mfv_loads)')
      if (status /= MFV_COMPLETE) return
      if (present(loads)) loads = c_loads(loads%size, derivative%force, derivative%motion, derivative%dissipation, 0, 0, 0, &
                                          derivative%separated_events, derivative%linear_solves, 0)
      if (present(pressure)) pressure = derivative%pressure
      if (present(shear)) shear = derivative%shear
   end function mfv_derivative_unguarded

   integer(c_int) function mfv_save_unguarded(handle, state) result(status) bind(C)
      type(c_ptr), value :: handle
      type(c_ptr), intent(inout), optional :: state
      type(handle_type), pointer :: self
      type(kept_state_type), pointer :: kept
      type(c_ptr) :: object

      call c_f_pointer(handle, self)
      status = expected(self, present(state), 'mfv_save: state is null')
      if (status /= MFV_COMPLETE) return
      if (c_associated(state)) then
         status = mfv_handle_enter(state, kind_state, use_alone, object)
         if (status /= MFV_COMPLETE) then
            call explain_handle('state', status, self%message)
            return
         end if
         call c_f_pointer(object, kept)
         call self%contact%keep(kept)
         call mfv_handle_leave(state)
      else
         allocate (kept)
         call self%contact%keep(kept)
         call issue(kind_state, c_loc(kept), state, status)
         if (status /= MFV_COMPLETE) deallocate (kept)
      end if
   end function mfv_save_unguarded

   integer(c_int) function mfv_restore_unguarded(handle, state) result(status) bind(C)
      type(c_ptr), value :: handle, state
      type(handle_type), pointer :: self
      type(kept_state_type), pointer :: kept
      type(c_ptr) :: object
      type(error_type), allocatable :: error

      call c_f_pointer(handle, self)
      status = mfv_handle_enter(state, kind_state, use_reading, object)
      if (status /= MFV_COMPLETE) then
         call explain_handle('state', status, self%message)
         return
      end if
      call c_f_pointer(object, kept)
      call self%contact%come_back(kept, error)
      call mfv_handle_leave(state)
      status = failed(self, error)
      if (status == MFV_COMPLETE) call self%contact%get_message(self%message)
   end function mfv_restore_unguarded

   integer(c_int) function mfv_state_free(state) result(status) bind(C)
      type(c_ptr), intent(inout), optional :: state
      type(kept_state_type), pointer :: kept
      type(c_ptr) :: object

      status = mfv_handle_remove(state, kind_state, object)
      if (.not. c_associated(object)) return
      call c_f_pointer(object, kept)
      deallocate (kept)
   end function mfv_state_free

   !> The message for a bad handle of a scene or a state.
   subroutine explain_handle(what, status, message)
      character(*), intent(in) :: what
      integer(c_int), intent(in) :: status
      character(:), allocatable, intent(out) :: message

      message = 'the '//what//' is null, freed or invalid'
      if (status == MFV_IN_USE) message = 'the '//what//' is in use by another call'
   end subroutine explain_handle

   integer(c_int) function mfv_message_unguarded(handle, buffer, size) result(status) bind(C)
      type(c_ptr), value :: handle, buffer
      integer(c_size_t), value :: size
      type(handle_type), pointer :: self

      call c_f_pointer(handle, self)
      status = text_out(self%message, buffer, size)
   end function mfv_message_unguarded

   !> MFV_BAD_ARGUMENT, with its reason as the case's message.
   integer(c_int) function refused(self, why) result(status)
      type(handle_type), intent(inout) :: self
      character(*), intent(in) :: why

      self%message = why
      status = MFV_BAD_ARGUMENT
   end function refused

   !> MFV_COMPLETE if an argument is valid, else refused.
   integer(c_int) function expected(self, is_good, why) result(status)
      type(handle_type), intent(inout) :: self
      logical, intent(in) :: is_good
      character(*), intent(in) :: why

      status = MFV_COMPLETE
      if (.not. is_good) status = refused(self, why)
   end function expected

   !> The status of an error, with its message as that of the case; MFV_COMPLETE if there is none.
   integer(c_int) function failed(self, error) result(status)
      type(handle_type), intent(inout) :: self
      type(error_type), allocatable, intent(in) :: error

      status = MFV_COMPLETE
      if (.not. allocated(error)) return
      status = error%status
      self%message = error%message
   end function failed

   integer(c_int) function mfv_field_count_unguarded(handle, count) result(status) bind(C)
      type(c_ptr), value :: handle
      integer(c_size_t), intent(inout), optional :: count
      type(handle_type), pointer :: self
      type(string_type), pointer :: paths(:)

      call c_f_pointer(handle, self)
      call self%contact%field_paths(paths)
      status = expected(self, present(count), 'mfv_field_count: count is null')
      if (status == MFV_COMPLETE) count = size(paths, kind=c_size_t)
   end function mfv_field_count_unguarded

   integer(c_int) function mfv_field_path_unguarded(handle, index, buffer, size) result(status) bind(C)
      type(c_ptr), value :: handle, buffer
      integer(c_size_t), value :: index, size
      type(handle_type), pointer :: self
      type(string_type), pointer :: paths(:)

      call c_f_pointer(handle, self)
      call self%contact%field_paths(paths)
      status = listed_text_out(self, 'mfv_field_path', 'fields', paths, index, buffer, size)
   end function mfv_field_path_unguarded

   integer(c_int) function mfv_attribute_name_unguarded(handle, index, buffer, size) result(status) bind(C)
      type(c_ptr), value :: handle, buffer
      integer(c_size_t), value :: index, size
      type(handle_type), pointer :: self
      type(string_type), pointer :: names(:), texts(:)

      call c_f_pointer(handle, self)
      call self%contact%attributes(names, texts)
      status = listed_text_out(self, 'mfv_attribute_name', 'attributes', names, index, buffer, size)
   end function mfv_attribute_name_unguarded

   !> Copy text `index` (from 0) of a list to a buffer. `caller`, `items`: names of the called function and of the texts, for
   !> messages.
   integer(c_int) function listed_text_out(self, caller, items, list, index, buffer, size) result(status)
      type(handle_type), intent(inout) :: self
      character(*), intent(in) :: caller, items
      type(string_type), intent(in) :: list(:)
      integer(c_size_t), intent(in) :: index, size
      type(c_ptr), intent(in) :: buffer

      if (index < 0 .or. index >= ubound(list, 1)) then
         status = refused(self, caller//': there are '//to_text(ubound(list, 1))//' '//items)
         return
      end if
      status = text_out(list(index + 1)%text, buffer, size)
      if (status /= MFV_COMPLETE) status = refused(self, caller//': the buffer is null or has no room')
   end function listed_text_out

   integer(c_int) function mfv_attribute_unguarded(handle, name, buffer, size, length) result(status) bind(C)
      type(c_ptr), value :: handle, name, buffer
      integer(c_size_t), value :: size
      integer(c_size_t), intent(inout), optional :: length
      type(handle_type), pointer :: self
      type(string_type), pointer :: names(:), texts(:)
      character(:), allocatable :: wanted
      integer :: i

      call c_f_pointer(handle, self)
      status = expected(self, c_associated(name), 'mfv_attribute: the name is null')
      if (status /= MFV_COMPLETE) return
      wanted = text_in(name)
      call self%contact%attributes(names, texts)
      do i = 1, ubound(names, 1)
         if (names(i)%text /= wanted .or. len(names(i)%text) /= len(wanted)) cycle
         if (present(length)) length = len(texts(i)%text, kind=c_size_t)
         if (c_associated(buffer)) status = text_out(texts(i)%text, buffer, size)
         if (status /= MFV_COMPLETE) status = refused(self, 'mfv_attribute: the buffer has no room')
         return
      end do
      status = refused(self, "there is no attribute '"//wanted//"'")
   end function mfv_attribute_unguarded

   integer(c_int) function mfv_field_info_unguarded(handle, path, count, is_integer, along, unit, unit_size, description, &
                                                    description_size) result(status) bind(C)
      type(c_ptr), value :: handle, path, unit, description
      integer(c_size_t), value :: unit_size, description_size
      integer(c_size_t), intent(inout), optional :: count
      integer(c_int), intent(inout), optional :: is_integer, along
      type(field_type), pointer :: field

      call find_field(handle, path, field, status)
      if (status /= MFV_COMPLETE) return
      if (present(count)) count = count_values(field)
      if (present(is_integer)) is_integer = merge(1, 0, allocated(field%whole))
      if (present(along)) along = field%along
      call say(field%unit, unit, unit_size)
      call say(field%description, description, description_size)
   end function mfv_field_info_unguarded

   integer(c_int) function mfv_copy_real_unguarded(handle, path, values, count) result(status) bind(C)
      type(c_ptr), value :: handle, path
      integer(c_size_t), value :: count
      real(c_double), intent(inout), optional :: values(count)
      type(field_type), pointer :: field

      call find_field_to_copy(handle, path, .false., present(values), count, field, status)
      if (status == MFV_COMPLETE) values = field%values
   end function mfv_copy_real_unguarded

   integer(c_int) function mfv_copy_integer_unguarded(handle, path, values, count) result(status) bind(C)
      type(c_ptr), value :: handle, path
      integer(c_size_t), value :: count
      integer(c_int32_t), intent(inout), optional :: values(count)
      type(field_type), pointer :: field

      call find_field_to_copy(handle, path, .true., present(values), count, field, status)
      if (status == MFV_COMPLETE) values = field%whole
   end function mfv_copy_integer_unguarded

   !> The field at a path of a case, of integers or reals if `whole` is given. MFV_BAD_ARGUMENT.
   subroutine find_field(handle, path, field, status, whole)
      type(c_ptr), intent(in) :: handle, path
      type(field_type), pointer, intent(out) :: field
      integer(c_int), intent(out) :: status
      logical, intent(in), optional :: whole
      type(handle_type), pointer :: self
      type(error_type), allocatable :: error

      nullify (field)
      call c_f_pointer(handle, self)
      status = expected(self, c_associated(path), 'the path is null')
      if (status /= MFV_COMPLETE) return
      call self%contact%find_field(text_in(path), field, error, whole)
      status = failed(self, error)
   end subroutine find_field

   !> The same, to be copied to an array of `count` values (`has_places`: the array is not null).
   subroutine find_field_to_copy(handle, path, whole, has_places, count, field, status)
      type(c_ptr), intent(in) :: handle, path
      logical, intent(in) :: whole, has_places
      integer(c_size_t), intent(in) :: count
      type(field_type), pointer, intent(out) :: field
      integer(c_int), intent(out) :: status
      type(handle_type), pointer :: self

      call find_field(handle, path, field, status, whole)
      if (status /= MFV_COMPLETE) return
      call c_f_pointer(handle, self)
      if (.not. has_places) then
         status = refused(self, text_in(path)//': values is null')
      else if (count /= count_values(field)) then
         status = refused(self, text_in(path)//' has '//to_text(int(count_values(field)))//' values; count must be that number')
      end if
   end subroutine find_field_to_copy

   integer(c_int) function mfv_stress_unguarded(handle, body, step, count, x, y, stresses, place, tension) result(status) &
      bind(C)
      type(c_ptr), value :: handle
      integer(c_int), value :: body, step
      integer(c_size_t), value :: count
      real(c_double), intent(in), optional :: x(count), y(count)
      real(c_double), intent(inout), optional :: stresses(stress_count, count), place(3), tension(3)
      type(handle_type), pointer :: self
      type(interior_type) :: interior
      type(error_type), allocatable :: error

      call c_f_pointer(handle, self)
      call self%contact%find_interior(int(body), interior, error, int(step))
      status = failed(self, error)
      if (status == MFV_COMPLETE) status = answered(self, interior, count, x, y, stresses, place, tension)
   end function mfv_stress_unguarded

   !> The requested stresses of a body: at points, the largest von Mises stress and the largest tension. MFV_BAD_ARGUMENT.
   integer(c_int) function answered(self, interior, count, x, y, stresses, place, tension) result(status)
      type(handle_type), intent(inout) :: self
      type(interior_type), intent(inout) :: interior
      integer(c_size_t), intent(in) :: count
      real(c_double), intent(in), optional :: x(count), y(count)
      real(c_double), intent(inout), optional :: stresses(stress_count, count), place(3), tension(3)
      !> Points at which stresses in layers are found one by one.
      integer(c_size_t), parameter :: few = 20
      integer(c_size_t) :: i

      status = MFV_COMPLETE
      if (present(stresses) .and. count /= 0) then
         status = expected(self, present(x) .and. present(y), 'an array is null')
         if (status /= MFV_COMPLETE) return
         status = expected(self, is_size(count), 'count is too large: there must be that many points')
         if (status /= MFV_COMPLETE) return
         if (count > few) call interior%prepare(maxval(abs(y), mask=abs(y) <= huge(1.0_wp)))
         do i = 1, count
            stresses(:, i) = interior%all_stresses(x(i), y(i))
         end do
      end if
      if (present(place)) call interior%prepare()
      if (present(place)) place = place_of(largest_von_mises(interior))
      if (present(tension)) tension = place_of(largest_tension(interior))
   end function answered

   !> A largest stress and its position.
   pure function place_of(largest) result(place)
      type(largest_type), intent(in) :: largest
      real(c_double) :: place(3)

      place = [largest%value, largest%x, largest%y]
   end function place_of

   integer(c_int) function mfv_stress_under_unguarded(handle, body, nodes, arc, width, pressure, shear, contact_edge, stick_edge, &
                                                      bulk_stress, count, x, y, stresses, place, tension) result(status) bind(C)
      type(c_ptr), value :: handle
      integer(c_int), value :: body
      integer(c_size_t), value :: nodes, count
      real(c_double), intent(in), optional, dimension(nodes) :: arc, width, pressure, shear, contact_edge, stick_edge
      real(c_double), value :: bulk_stress
      real(c_double), intent(in), optional :: x(count), y(count)
      real(c_double), intent(inout), optional :: stresses(stress_count, count), place(3), tension(3)
      type(handle_type), pointer :: self
      ! Of neighbours over the sum of their widths; where widths change, positions may not be quite in the middle.
      real(wp), parameter :: least_distance = 0.45_wp
      type(interior_type) :: interior
      type(error_type), allocatable :: error
      logical :: usable

      call c_f_pointer(handle, self)
      status = expected(self, present(arc) .and. present(width) .and. present(pressure) .and. present(shear), &
                        'mfv_stress_under: an array is null')
      if (status /= MFV_COMPLETE) return
      status = expected(self, is_size(nodes), 'mfv_stress_under: nodes must be at least 1 and the number of tractions')
      if (status /= MFV_COMPLETE) return
      usable = all(ieee_is_finite([arc, width, pressure, shear, bulk_stress]))
      if (usable) usable = all(width > 0.0_wp)
      status = expected(self, usable, 'mfv_stress_under: values must be finite and widths positive')
      if (status /= MFV_COMPLETE) return
      usable = all(arc(2:) - arc(:nodes - 1) > least_distance*(width(2:) + width(:nodes - 1)))
      status = expected(self, usable, 'mfv_stress_under: intervals must lie from left to right and not overlap')
      if (status /= MFV_COMPLETE) return
      call self%contact%make_interior(int(body), arc, width, pressure, shear, edges_or_nan(nodes, contact_edge), &
                                      edges_or_nan(nodes, stick_edge), bulk_stress, interior, error)
      status = failed(self, error)
      if (status == MFV_COMPLETE) status = answered(self, interior, count, x, y, stresses, place, tension)
   end function mfv_stress_under_unguarded

   !> The given edges, or NaN for each node.
   pure function edges_or_nan(nodes, given) result(edges)
      integer(c_size_t), intent(in) :: nodes
      real(c_double), intent(in), optional :: given(nodes)
      real(wp) :: edges(nodes)

      edges = ieee_value(1.0_wp, ieee_quiet_nan)
      if (present(given)) edges = given
   end function edges_or_nan

   integer(c_int) function mfv_write_unguarded(handle, path) result(status) bind(C)
      type(c_ptr), value :: handle, path
      type(handle_type), pointer :: self
      type(error_type), allocatable :: error

      call c_f_pointer(handle, self)
      call self%contact%write(text_or(path, ''), error)
      status = failed(self, error)
      if (status == MFV_COMPLETE) call self%contact%get_message(self%message)
   end function mfv_write_unguarded

   ! --- texts ---

   !> Text of a C string.
   function text_in(pointer_to_text) result(text)
      type(c_ptr), intent(in) :: pointer_to_text
      character(len=c_strlen(pointer_to_text)) :: text
      character(kind=c_char), pointer :: characters(:)

      call c_f_pointer(pointer_to_text, characters, [len(text) + 1])
      text = from_c(characters)
   end function text_in

   !> Text of a C string, or `default` where the pointer is null.
   function text_or(pointer_to_text, default) result(text)
      type(c_ptr), intent(in) :: pointer_to_text
      character(*), intent(in) :: default
      character(len=length_or(pointer_to_text, len(default))) :: text

      text = default
      if (c_associated(pointer_to_text)) text = text_in(pointer_to_text)
   end function text_or

   !> Length of a C string, or `default` where the pointer is null.
   pure integer function length_or(pointer_to_text, default) result(length)
      type(c_ptr), intent(in) :: pointer_to_text
      integer, intent(in) :: default

      length = default
      if (c_associated(pointer_to_text)) length = int(c_strlen(pointer_to_text))
   end function length_or

   !> Copy a text to a buffer; MFV_BAD_ARGUMENT if it is null or empty.
   integer(c_int) function text_out(text, buffer, size) result(status)
      character(*), intent(in) :: text
      type(c_ptr), intent(in) :: buffer
      integer(c_size_t), intent(in) :: size
      character(kind=c_char), pointer :: characters(:)

      status = MFV_BAD_ARGUMENT
      if (.not. c_associated(buffer) .or. size < 1) return
      call c_f_pointer(buffer, characters, [size])
      call copy_to_c(text, characters, int(min(size, int(huge(0), c_size_t))))
      status = MFV_COMPLETE
   end function text_out

end module mfv_c
