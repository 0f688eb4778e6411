!> The C interface of include/mfv.h: thin walls around the library. Unpack, call, return the status. Calls with a handle
!> come from guards.c, which has looked the handle up: they have the address of its object in its place, and no other call uses it.
module mfv_c
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite, ieee_quiet_nan, ieee_value
   use, intrinsic :: iso_c_binding
   use mfv_case_keys, only: case_catalogue
   use mfv_contact, only: contact_type, loads_type, new_contact, read_contact, read_contact_text
   use mfv_contact_state, only: contact_state_type
   use mfv_draft, only: draft_type, read_draft
   use mfv_error, only: error_type, set_error
   use mfv_features, only: has_hdf5
   use mfv_interior, only: interior_type, stress_count
   use mfv_kept_state, only: kept_state_type
   use mfv_key_path, only: read_key_name
   use mfv_keys, only: catalogue_type, kind_integer
   use mfv_kinds, only: wp
   use mfv_observables, only: observable_count, observable_meaning, observable_name, observable_unit
   use mfv_observer, only: observer_type
   use mfv_result_fields, only: field_type
   use mfv_scene, only: step_type
   use mfv_status
   use mfv_stress_search, only: largest_tension, largest_type, largest_von_mises
   use mfv_strings, only: copy_to_c, string_type, to_text
   use mfv_version, only: library_version
   implicit none
   private

   !> Tells a function of the caller.
   type, extends(observer_type) :: c_observer_type
      procedure(c_observe), nopass, pointer :: observe => null()
      type(c_ptr) :: user = c_null_ptr
   contains
      procedure :: notify
   end type c_observer_type

   !> What the handle of a case is of.
   type :: handle_type
      type(contact_type) :: contact
      type(c_observer_type) :: observer
      character(:), allocatable :: message
   end type handle_type

   !> What the handles of a scene and of a state are of.
   type :: scene_handle_type
      type(draft_type) :: draft
   end type scene_handle_type

   type :: state_handle_type
      type(kept_state_type) :: state
   end type state_handle_type

   character(*), parameter :: unnamed = 'text'

   !> Sizes of arrays beyond this are a mistake: (size_t)-1, say.
   integer(c_size_t), parameter :: most = 2_c_size_t**31 - 1

   !> mfv_step of the header.
   type, bind(C) :: c_step
      integer(c_size_t) :: size
      real(c_double) :: normal_target, tangential_target
      integer(c_int) :: normal_control, tangential_control, friction, cycles
      real(c_double) :: rotational_target
      integer(c_int) :: rotational_control, relative
      real(c_double) :: steady_tolerance
   end type c_step

   !> mfv_loads of the header.
   type, bind(C) :: c_loads
      integer(c_size_t) :: size
      real(c_double) :: normal_force, tangential_force, moment, approach, shift, rotation, dissipation
      integer(c_int) :: contact_nodes, stick_nodes, slip_nodes, events, linear_solves, unused
   end type c_loads

   !> mfv_progress of the header.
   type, bind(C) :: c_progress
      integer(c_size_t) :: size
      real(c_double) :: fraction
      integer(c_int) :: segment, segments, contact_nodes, stick_nodes
      real(c_double) :: normal_force, tangential_force, approach, shift
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

   function mfv_has_feature(feature, there) result(status) bind(C, name='mfv_has_feature')
      type(c_ptr), value :: feature, there
      integer(c_int) :: status

      status = MFV_BAD_ARGUMENT
      if (.not. c_associated(feature) .or. .not. c_associated(there)) return
      call integer_out(0, there)
      if (text_in(feature) /= 'hdf5' .or. c_strlen(feature) /= 4) return
      call integer_out(merge(1, 0, has_hdf5), there)
      status = MFV_COMPLETE
   end function mfv_has_feature

   function mfv_key_info(key, is_integer, unit, unit_size, description, description_size) result(status) &
      bind(C, name='mfv_key_info')
      type(c_ptr), value :: key, is_integer, unit, description
      integer(c_size_t), value :: unit_size, description_size
      integer(c_int) :: status
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
         if (c_associated(is_integer)) call integer_out(merge(1, 0, found%kind == kind_integer), is_integer)
         call say(found%unit, unit, unit_size)
         call say(found%meaning, description, description_size)
      end associate
      status = MFV_COMPLETE
   end function mfv_key_info

   function mfv_observable_info(index, name, name_size, unit, unit_size, description, description_size) result(status) &
      bind(C, name='mfv_observable_info')
      integer(c_size_t), value :: index, name_size, unit_size, description_size
      type(c_ptr), value :: name, unit, description
      integer(c_int) :: status
      integer :: number

      status = MFV_BAD_ARGUMENT
      call say('', name, name_size)
      call say('', unit, unit_size)
      call say('', description, description_size)
      if (index < 0 .or. index >= observable_count) return
      number = int(index) + 1
      call say(observable_name(number), name, name_size)
      call say(observable_unit(number), unit, unit_size)
      call say(observable_meaning(number), description, description_size)
      status = MFV_COMPLETE
   end function mfv_observable_info

   function mfv_scene_create(scene) result(status) bind(C, name='mfv_scene_create_unguarded')
      type(c_ptr), intent(out), optional :: scene
      integer(c_int) :: status
      type(draft_type) :: draft

      status = MFV_BAD_ARGUMENT
      if (.not. present(scene)) return
      call hand_out_scene(draft, scene)
      status = MFV_COMPLETE
   end function mfv_scene_create

   function mfv_scene_from_text(text, name, scene, message, message_size) result(status) &
      bind(C, name='mfv_scene_from_text_unguarded')
      type(c_ptr), value :: text, name, message
      type(c_ptr), intent(out), optional :: scene
      integer(c_size_t), value :: message_size
      integer(c_int) :: status
      type(draft_type) :: draft
      type(error_type), allocatable :: error

      call say('a pointer is null', message, message_size)
      status = MFV_BAD_ARGUMENT
      if (.not. present(scene)) return
      scene = c_null_ptr
      if (.not. c_associated(text)) return
      call read_draft(text_in(text), name_in(name), draft, error)
      status = told(error, message, message_size)
      if (status == MFV_COMPLETE) call hand_out_scene(draft, scene)
   end function mfv_scene_from_text

   subroutine hand_out_scene(draft, scene)
      type(draft_type), intent(in) :: draft
      type(c_ptr), intent(out) :: scene
      type(scene_handle_type), pointer :: self

      allocate (self)
      self%draft = draft
      scene = c_loc(self)
   end subroutine hand_out_scene

   function mfv_scene_set_text(scene, key, value) result(status) bind(C, name='mfv_scene_set_text_unguarded')
      type(c_ptr), value :: scene, key, value
      integer(c_int) :: status
      type(scene_handle_type), pointer :: self
      type(error_type), allocatable :: error

      call find_scene(scene, self, status, key, value)
      if (status /= MFV_COMPLETE) return
      call self%draft%set(text_in(key), text_in(value), error)
      status = merge(MFV_BAD_ARGUMENT, MFV_COMPLETE, allocated(error))
   end function mfv_scene_set_text

   function mfv_scene_set_real(scene, key, value) result(status) bind(C, name='mfv_scene_set_real_unguarded')
      type(c_ptr), value :: scene, key
      real(c_double), value :: value
      integer(c_int) :: status
      type(scene_handle_type), pointer :: self
      type(error_type), allocatable :: error

      call find_scene(scene, self, status, key)
      if (status /= MFV_COMPLETE) return
      call self%draft%set(text_in(key), value, error)
      status = merge(MFV_BAD_ARGUMENT, MFV_COMPLETE, allocated(error))
   end function mfv_scene_set_real

   function mfv_scene_set_reals(scene, key, values, count) result(status) bind(C, name='mfv_scene_set_reals_unguarded')
      type(c_ptr), value :: scene, key, values
      integer(c_size_t), value :: count
      integer(c_int) :: status
      type(scene_handle_type), pointer :: self
      type(error_type), allocatable :: error
      real(c_double), pointer :: list(:)

      call find_scene(scene, self, status, key, values)
      if (status /= MFV_COMPLETE) return
      if (count /= 0 .and. .not. is_size(count)) then
         status = MFV_BAD_ARGUMENT
         call keep_null(self, text_in(key))
         return
      end if
      call c_f_pointer(values, list, [count])
      call self%draft%set(text_in(key), list, error)
      status = merge(MFV_BAD_ARGUMENT, MFV_COMPLETE, allocated(error))
   end function mfv_scene_set_reals

   function mfv_scene_set_integer(scene, key, value) result(status) bind(C, name='mfv_scene_set_integer_unguarded')
      type(c_ptr), value :: scene, key
      integer(c_int), value :: value
      integer(c_int) :: status
      type(scene_handle_type), pointer :: self
      type(error_type), allocatable :: error

      call find_scene(scene, self, status, key)
      if (status /= MFV_COMPLETE) return
      call self%draft%set(text_in(key), int(value), error)
      status = merge(MFV_BAD_ARGUMENT, MFV_COMPLETE, allocated(error))
   end function mfv_scene_set_integer

   function mfv_scene_set_logical(scene, key, value) result(status) bind(C, name='mfv_scene_set_logical_unguarded')
      type(c_ptr), value :: scene, key
      integer(c_int), value :: value
      integer(c_int) :: status
      type(scene_handle_type), pointer :: self
      type(error_type), allocatable :: error

      call find_scene(scene, self, status, key)
      if (status /= MFV_COMPLETE) return
      call self%draft%set(text_in(key), value /= 0, error)
      status = merge(MFV_BAD_ARGUMENT, MFV_COMPLETE, allocated(error))
   end function mfv_scene_set_logical

   function mfv_scene_remove(scene, key) result(status) bind(C, name='mfv_scene_remove_unguarded')
      type(c_ptr), value :: scene, key
      integer(c_int) :: status

      status = removed(scene, key, alternatives=.false.)
   end function mfv_scene_remove

   function mfv_scene_make_room(scene, key) result(status) bind(C, name='mfv_scene_make_room_unguarded')
      type(c_ptr), value :: scene, key
      integer(c_int) :: status

      status = removed(scene, key, alternatives=.true.)
   end function mfv_scene_make_room

   !> Take a key of a scene out, with or without its alternatives.
   integer(c_int) function removed(scene, key, alternatives) result(status)
      type(c_ptr), intent(in) :: scene, key
      logical, intent(in) :: alternatives
      type(scene_handle_type), pointer :: self
      type(error_type), allocatable :: error

      call find_scene(scene, self, status, key)
      if (status /= MFV_COMPLETE) return
      call self%draft%remove(text_in(key), error, alternatives)
      status = merge(MFV_BAD_ARGUMENT, MFV_COMPLETE, allocated(error))
   end function removed

   function mfv_scene_set_data(scene, file, dataset, rows, columns, values) result(status) &
      bind(C, name='mfv_scene_set_data_unguarded')
      type(c_ptr), value :: scene, file, dataset, values
      integer(c_size_t), value :: rows, columns
      integer(c_int) :: status
      type(scene_handle_type), pointer :: self
      type(error_type), allocatable :: error
      real(c_double), pointer :: by_rows(:, :)

      call find_scene(scene, self, status, file, dataset)
      if (status /= MFV_COMPLETE) return
      status = MFV_BAD_ARGUMENT
      if (.not. (c_associated(values) .and. is_size(rows) .and. is_size(columns))) then
         call keep_null(self, text_in(file))
         return
      end if
      call c_f_pointer(values, by_rows, [columns, rows])
      call self%draft%set_data(text_in(file), text_in(dataset), transpose(by_rows), error)
      status = merge(MFV_BAD_ARGUMENT, MFV_COMPLETE, allocated(error))
   end function mfv_scene_set_data

   function mfv_scene_text(scene, buffer, size, length) result(status) bind(C, name='mfv_scene_text_unguarded')
      type(c_ptr), value :: scene, buffer, length
      integer(c_size_t), value :: size
      integer(c_int) :: status
      type(scene_handle_type), pointer :: self
      character(:), allocatable :: text

      call find_scene(scene, self, status)
      if (status /= MFV_COMPLETE) return
      call self%draft%write_text(text)
      call size_out(len(text, kind=c_size_t), length)
      if (c_associated(buffer)) status = text_out(text, buffer, size)
   end function mfv_scene_text

   subroutine mfv_scene_free(scene) bind(C, name='mfv_scene_free_unguarded')
      type(c_ptr), value :: scene
      type(scene_handle_type), pointer :: self

      call c_f_pointer(scene, self)
      deallocate (self)
   end subroutine mfv_scene_free

   !> The object of a scene, and whether the arguments that must be there are: MFV_BAD_ARGUMENT.
   subroutine find_scene(scene, self, status, first, second)
      type(c_ptr), intent(in) :: scene
      type(scene_handle_type), pointer, intent(out) :: self
      integer(c_int), intent(out) :: status
      type(c_ptr), intent(in), optional :: first, second

      call c_f_pointer(scene, self)
      status = MFV_COMPLETE
      if (present(first)) status = expected(first)
      if (status /= MFV_COMPLETE .or. .not. present(second)) return
      status = expected(second)
      if (status /= MFV_COMPLETE) call keep_null(self, text_in(first))
   end subroutine find_scene

   !> MFV_BAD_ARGUMENT for a null pointer.
   integer(c_int) function expected(pointer)
      type(c_ptr), intent(in) :: pointer

      expected = merge(MFV_COMPLETE, MFV_BAD_ARGUMENT, c_associated(pointer))
   end function expected

   !> Whether this can be the size of an array that a caller has. (The upper half of size_t is below 0 here.)
   pure logical function is_size(count)
      integer(c_size_t), intent(in) :: count

      is_size = count > 0 .and. count <= most
   end function is_size

   !> Have a scene keep that something was null.
   subroutine keep_null(self, name)
      type(scene_handle_type), intent(inout) :: self
      character(*), intent(in) :: name
      type(error_type), allocatable :: fault

      call set_error(fault, MFV_INPUT_ERROR, name//': an argument is null, empty or too large')
      call self%draft%keep_fault(name, fault)
   end subroutine keep_null

   !> `found`: what became of the scene's handle; the scene is there where it is MFV_COMPLETE.
   function mfv_create(scene, found, handle, message, message_size) result(status) bind(C, name='mfv_create_unguarded')
      type(c_ptr), value :: scene, message
      integer(c_int), value :: found
      type(c_ptr), intent(out), optional :: handle
      integer(c_size_t), value :: message_size
      integer(c_int) :: status
      type(scene_handle_type), pointer :: given
      type(handle_type), pointer :: self
      type(error_type), allocatable :: error

      status = MFV_BAD_ARGUMENT
      call say('the place for the handle is null', message, message_size)
      if (.not. present(handle)) return
      handle = c_null_ptr
      status = found
      call say('the scene is null, was freed, or is none', message, message_size)
      if (found == MFV_IN_USE) call say('the scene is in use by another call', message, message_size)
      if (found /= MFV_COMPLETE) return
      call c_f_pointer(scene, given)
      allocate (self)
      call new_contact(given%draft, self%contact, error)
      status = told(error, message, message_size)
      call hand_out(self, status, handle)
   end function mfv_create

   function mfv_create_from_file(path, handle, message, message_size) result(status) &
      bind(C, name='mfv_create_from_file_unguarded')
      type(c_ptr), value :: path, message
      type(c_ptr), intent(out), optional :: handle
      integer(c_size_t), value :: message_size
      integer(c_int) :: status
      type(handle_type), pointer :: self
      type(error_type), allocatable :: error

      call say('a pointer is null', message, message_size)
      status = MFV_BAD_ARGUMENT
      if (.not. present(handle)) return
      handle = c_null_ptr
      if (.not. c_associated(path)) return
      allocate (self)
      call read_contact(text_in(path), self%contact, error)
      status = told(error, message, message_size)
      call hand_out(self, status, handle)
   end function mfv_create_from_file

   function mfv_create_from_text(text, name, handle, message, message_size) result(status) &
      bind(C, name='mfv_create_from_text_unguarded')
      type(c_ptr), value :: text, name, message
      type(c_ptr), intent(out), optional :: handle
      integer(c_size_t), value :: message_size
      integer(c_int) :: status
      type(handle_type), pointer :: self
      type(error_type), allocatable :: error

      call say('a pointer is null', message, message_size)
      status = MFV_BAD_ARGUMENT
      if (.not. present(handle)) return
      handle = c_null_ptr
      if (.not. c_associated(text)) return
      allocate (self)
      call read_contact_text(text_in(text), name_in(name), self%contact, error)
      status = told(error, message, message_size)
      call hand_out(self, status, handle)
   end function mfv_create_from_text

   !> The status of an error, MFV_COMPLETE where there is none; its message goes to a buffer, which may be null.
   function told(error, message, message_size) result(status)
      type(error_type), allocatable, intent(in) :: error
      type(c_ptr), intent(in) :: message
      integer(c_size_t), intent(in) :: message_size
      integer(c_int) :: status

      status = MFV_COMPLETE
      call say('', message, message_size)
      if (.not. allocated(error)) return
      status = error%status
      call say(error%message, message, message_size)
   end function told

   !> A text to a buffer, which may be null.
   subroutine say(text, message, message_size)
      character(*), intent(in) :: text
      type(c_ptr), intent(in) :: message
      integer(c_size_t), intent(in) :: message_size
      integer(c_int) :: copied

      if (c_associated(message)) copied = text_out(text, message, message_size)
   end subroutine say

   !> Hand out an object whose contact was made; do away with it where `status` says that it was not.
   subroutine hand_out(self, status, handle)
      type(handle_type), pointer, intent(inout) :: self
      integer(c_int), intent(in) :: status
      type(c_ptr), intent(inout) :: handle

      if (status == MFV_COMPLETE) then
         call self%contact%get_message(self%message)
         handle = c_loc(self)
      else
         deallocate (self)
      end if
   end subroutine hand_out

   function mfv_copy(handle, copy) result(status) bind(C, name='mfv_copy_unguarded')
      type(c_ptr), value :: handle
      type(c_ptr), intent(out) :: copy
      integer(c_int) :: status
      type(handle_type), pointer :: self, other

      call c_f_pointer(handle, self)
      status = MFV_COMPLETE
      allocate (other)
      other%contact = self%contact
      call hand_out(other, status, copy)
   end function mfv_copy

   subroutine mfv_free(handle) bind(C, name='mfv_free_unguarded')
      type(c_ptr), value :: handle
      type(handle_type), pointer :: self

      call c_f_pointer(handle, self)
      deallocate (self)
   end subroutine mfv_free

   function mfv_observe(handle, observer, user) result(status) bind(C, name='mfv_observe_unguarded')
      type(c_ptr), value :: handle, user
      type(c_funptr), value :: observer
      integer(c_int) :: status
      type(handle_type), pointer :: self

      call c_f_pointer(handle, self)
      status = MFV_COMPLETE
      nullify (self%observer%observe)
      if (c_associated(observer)) call c_f_procpointer(observer, self%observer%observe)
      self%observer%user = user
   end function mfv_observe

   !> An observer: `user` points to an integer that is not 0 when the run is to end.
   function mfv_stop_when_set(progress, user) result(stop_wanted) bind(C, name='mfv_stop_when_set')
      type(c_ptr), value :: progress, user
      integer(c_int) :: stop_wanted
      integer(c_int), pointer, volatile :: flag

      stop_wanted = 0
      if (.not. (c_associated(progress) .and. c_associated(user))) return
      call c_f_pointer(user, flag)
      stop_wanted = flag
   end function mfv_stop_when_set

   !> See mfv_observer.
   subroutine notify(self, state, segment, segments, fraction, stop_wanted)
      class(c_observer_type), intent(inout) :: self
      type(contact_state_type), intent(in) :: state
      integer, intent(in) :: segment, segments
      real(wp), intent(in) :: fraction
      logical, intent(out) :: stop_wanted
      type(c_progress) :: progress

      progress = c_progress(c_sizeof(progress), fraction, segment, segments, state%contact_nodes(), state%stick_nodes(), &
                            state%fields%normal_force, state%fields%tangential_force, state%fields%approach, state%fields%shift)
      stop_wanted = self%observe(progress, self%user) /= 0
   end subroutine notify

   function mfv_run(handle) result(status) bind(C, name='mfv_run_unguarded')
      type(c_ptr), value :: handle
      integer(c_int) :: status
      type(handle_type), pointer :: self

      call c_f_pointer(handle, self)
      status = MFV_COMPLETE
      if (associated(self%observer%observe)) then
         call self%contact%run(self%observer)
      else
         call self%contact%run()
      end if
      call self%contact%get_message(self%message)
      status = self%contact%status()
   end function mfv_run

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
      wanted = step_type(given%normal_control, given%tangential_control, given%normal_target, given%tangential_target, &
                         given%friction /= 0, given%cycles, given%rotational_control, given%rotational_target, &
                         given%steady_tolerance)
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

   function mfv_get_loads(handle, loads) result(status) bind(C, name='mfv_get_loads_unguarded')
      type(c_ptr), value :: handle, loads
      integer(c_int) :: status
      type(handle_type), pointer :: self
      type(c_loads), pointer :: given
      type(loads_type) :: now

      call c_f_pointer(handle, self)
      status = MFV_COMPLETE
      if (.not. c_associated(loads)) then
         status = refused(self, 'mfv_get_loads: loads is null')
         return
      end if
      call c_f_pointer(loads, given)
      if (given%size /= c_sizeof(given)) then
         status = refused(self, 'mfv_get_loads: size is not sizeof(mfv_loads)')
         return
      end if
      now = self%contact%loads()
      given = c_loads(given%size, now%normal_force, now%tangential_force, now%moment, now%approach, now%shift, now%rotation, &
                      now%dissipation, now%contact_nodes, now%stick_nodes, now%slip_nodes, now%events, now%linear_solves, 0)
      status = MFV_COMPLETE
   end function mfv_get_loads

   function mfv_tangent(handle, motions, direction, tangent) result(status) bind(C, name='mfv_tangent_unguarded')
      type(c_ptr), value :: handle, direction, tangent
      integer(c_int), value :: motions
      integer(c_int) :: status
      type(handle_type), pointer :: self
      real(c_double), pointer :: towards(:), by_rows(:, :)
      type(error_type), allocatable :: error
      real(wp), allocatable :: found(:, :)

      call c_f_pointer(handle, self)
      status = MFV_COMPLETE
      if (motions /= 2 .and. motions /= 3) then
         status = refused(self, 'mfv_tangent: motions must be 2, or 3 with rotation')
         return
      end if
      if (.not. c_associated(tangent)) then
         status = refused(self, 'mfv_tangent: tangent is null')
         return
      end if
      allocate (found(motions, motions))
      if (c_associated(direction)) then
         call c_f_pointer(direction, towards, [motions])
         call self%contact%get_tangent(found(:motions, :motions), error, towards)
      else
         call self%contact%get_tangent(found(:motions, :motions), error)
      end if
      status = failed(self, error)
      if (status /= MFV_COMPLETE) return
      call c_f_pointer(tangent, by_rows, [motions, motions])
      by_rows = transpose(found(:motions, :motions))
   end function mfv_tangent

   !> `state`: the object of a state, made where it is null; `found`: what became of its handle.
   function mfv_save(handle, found, state) result(status) bind(C, name='mfv_save_unguarded')
      type(c_ptr), value :: handle
      integer(c_int), value :: found
      type(c_ptr), intent(inout), optional :: state
      integer(c_int) :: status
      type(handle_type), pointer :: self
      type(state_handle_type), pointer :: kept

      call c_f_pointer(handle, self)
      if (.not. present(state)) then
         status = refused(self, 'mfv_save: state is null')
         return
      end if
      status = found
      if (found /= MFV_COMPLETE) then
         call keep_bad_state(self, found)
         return
      end if
      if (.not. c_associated(state)) then
         allocate (kept)
         state = c_loc(kept)
      end if
      call c_f_pointer(state, kept)
      call self%contact%keep(kept%state)
   end function mfv_save

   !> `found`: what became of the state's handle; the state is there where it is MFV_COMPLETE.
   function mfv_restore(handle, found, state) result(status) bind(C, name='mfv_restore_unguarded')
      type(c_ptr), value :: handle, state
      integer(c_int), value :: found
      integer(c_int) :: status
      type(handle_type), pointer :: self
      type(state_handle_type), pointer :: kept
      type(error_type), allocatable :: error

      call c_f_pointer(handle, self)
      status = found
      if (found /= MFV_COMPLETE) then
         call keep_bad_state(self, found)
         return
      end if
      call c_f_pointer(state, kept)
      call self%contact%come_back(kept%state, error)
      status = failed(self, error)
      if (status == MFV_COMPLETE) call self%contact%get_message(self%message)
   end function mfv_restore

   subroutine mfv_state_free(state) bind(C, name='mfv_state_free_unguarded')
      type(c_ptr), value :: state
      type(state_handle_type), pointer :: kept

      call c_f_pointer(state, kept)
      deallocate (kept)
   end subroutine mfv_state_free

   !> What is wrong with the handle of a state, as the message of a case's.
   subroutine keep_bad_state(self, found)
      type(handle_type), intent(inout) :: self
      integer(c_int), intent(in) :: found

      self%message = 'the state is null, was freed, or is none'
      if (found == MFV_IN_USE) self%message = 'the state is in use by another call'
   end subroutine keep_bad_state

   function mfv_message(handle, buffer, size) result(status) bind(C, name='mfv_message_unguarded')
      type(c_ptr), value :: handle, buffer
      integer(c_size_t), value :: size
      integer(c_int) :: status
      type(handle_type), pointer :: self

      call c_f_pointer(handle, self)
      status = text_out(self%message, buffer, size)
   end function mfv_message

   function mfv_field_count(handle, count) result(status) bind(C, name='mfv_field_count_unguarded')
      type(c_ptr), value :: handle, count
      integer(c_int) :: status
      type(handle_type), pointer :: self
      type(string_type), pointer :: paths(:)

      call c_f_pointer(handle, self)
      status = MFV_COMPLETE
      if (.not. c_associated(count)) then
         status = refused(self, 'mfv_field_count: count is null')
         return
      end if
      call self%contact%field_paths(paths)
      call size_out(size(paths, kind=c_size_t), count)
      status = MFV_COMPLETE
   end function mfv_field_count

   function mfv_field_path(handle, index, buffer, size) result(status) bind(C, name='mfv_field_path_unguarded')
      type(c_ptr), value :: handle, buffer
      integer(c_size_t), value :: index, size
      integer(c_int) :: status
      type(handle_type), pointer :: self
      type(string_type), pointer :: paths(:)

      call c_f_pointer(handle, self)
      status = MFV_COMPLETE
      call self%contact%field_paths(paths)
      if (index < 0 .or. index >= ubound(paths, 1)) then
         status = refused(self, 'mfv_field_path: there are '//to_text(ubound(paths, 1))//' fields')
         return
      end if
      status = text_out(paths(index + 1)%text, buffer, size)
      if (status /= MFV_COMPLETE) status = refused(self, 'mfv_field_path: the buffer is null or has no room')
   end function mfv_field_path

   !> MFV_BAD_ARGUMENT, with its reason as the handle's message.
   function refused(self, why) result(status)
      type(handle_type), intent(inout) :: self
      character(*), intent(in) :: why
      integer(c_int) :: status

      self%message = why
      status = MFV_BAD_ARGUMENT
   end function refused

   !> The status of an error, with its message as the handle's; MFV_COMPLETE where there is none.
   function failed(self, error) result(status)
      type(handle_type), intent(inout) :: self
      type(error_type), allocatable, intent(in) :: error
      integer(c_int) :: status

      status = MFV_COMPLETE
      if (.not. allocated(error)) return
      status = error%status
      self%message = error%message
   end function failed

   function mfv_attribute_name(handle, index, buffer, size) result(status) bind(C, name='mfv_attribute_name_unguarded')
      type(c_ptr), value :: handle, buffer
      integer(c_size_t), value :: index, size
      integer(c_int) :: status
      type(handle_type), pointer :: self
      type(string_type), pointer :: names(:), texts(:)

      call c_f_pointer(handle, self)
      status = MFV_COMPLETE
      call self%contact%attributes(names, texts)
      if (index < 0 .or. index >= ubound(names, 1)) then
         status = refused(self, 'mfv_attribute_name: there are '//to_text(ubound(names, 1))//' attributes')
         return
      end if
      status = text_out(names(index + 1)%text, buffer, size)
      if (status /= MFV_COMPLETE) status = refused(self, 'mfv_attribute_name: the buffer is null or has no room')
   end function mfv_attribute_name

   function mfv_attribute(handle, name, buffer, size, length) result(status) bind(C, name='mfv_attribute_unguarded')
      type(c_ptr), value :: handle, name, buffer, length
      integer(c_size_t), value :: size
      integer(c_int) :: status
      type(handle_type), pointer :: self
      type(string_type), pointer :: names(:), texts(:)
      character(:), allocatable :: wanted
      integer :: i

      call c_f_pointer(handle, self)
      status = MFV_COMPLETE
      if (.not. c_associated(name)) then
         status = refused(self, 'mfv_attribute: the name is null')
         return
      end if
      wanted = text_in(name)
      call self%contact%attributes(names, texts)
      do i = 1, ubound(names, 1)
         if (names(i)%text /= wanted .or. len(names(i)%text) /= len(wanted)) cycle
         call size_out(len(texts(i)%text, kind=c_size_t), length)
         if (c_associated(buffer)) status = text_out(texts(i)%text, buffer, size)
         if (status /= MFV_COMPLETE) status = refused(self, 'mfv_attribute: the buffer has no room')
         return
      end do
      status = refused(self, "there is no attribute '"//wanted//"'")
   end function mfv_attribute

   function mfv_field_info(handle, path, count, is_integer, along, unit, unit_size, description, description_size) &
      result(status) bind(C, name='mfv_field_info_unguarded')
      type(c_ptr), value :: handle, path, count, is_integer, along, unit, description
      integer(c_size_t), value :: unit_size, description_size
      integer(c_int) :: status
      type(field_type), pointer :: field
      integer(c_int) :: copied

      call field_at(handle, path, field, status)
      if (status /= MFV_COMPLETE) return
      call size_out(values_of(field), count)
      call integer_out(merge(1, 0, allocated(field%whole)), is_integer)
      call integer_out(field%along, along)
      if (c_associated(unit)) copied = text_out(field%unit, unit, unit_size)
      if (c_associated(description)) copied = text_out(field%description, description, description_size)
   end function mfv_field_info

   function mfv_copy_real(handle, path, values, count) result(status) bind(C, name='mfv_copy_real_unguarded')
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

   function mfv_copy_integer(handle, path, values, count) result(status) bind(C, name='mfv_copy_integer_unguarded')
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

      call c_f_pointer(handle, self)
      status = MFV_COMPLETE
      if (allocated(field%whole) .neqv. whole) then
         status = refused(self, text_in(path)//' has '//trim(merge('whole numbers', 'reals        ', .not. whole)))
      else if (.not. c_associated(values)) then
         status = refused(self, text_in(path)//': values is null')
      else if (count /= values_of(field)) then
         status = refused(self, text_in(path)//' has '//to_text(int(values_of(field)))//' values, count is another number')
      end if
   end function fit_for_copy

   function mfv_stress(handle, body, step, count, x, y, stresses) result(status) bind(C, name='mfv_stress_unguarded')
      type(c_ptr), value :: handle, x, y, stresses
      integer(c_int), value :: body, step
      integer(c_size_t), value :: count
      integer(c_int) :: status
      type(handle_type), pointer :: self
      type(error_type), allocatable :: error
      real(c_double), pointer :: across(:), up(:), values(:, :)

      call c_f_pointer(handle, self)
      status = MFV_COMPLETE
      if (count == 0) return
      call take_points(self, count, x, y, stresses, across, up, values, status)
      if (status /= MFV_COMPLETE) return
      call self%contact%get_stresses(int(body), across, up, values, error, int(step))
      status = failed(self, error)
   end function mfv_stress

   !> Arrays for points and the stresses at them. MFV_BAD_ARGUMENT.
   subroutine take_points(self, count, x, y, stresses, across, up, values, status)
      type(handle_type), intent(inout) :: self
      integer(c_size_t), intent(in) :: count
      type(c_ptr), intent(in) :: x, y, stresses
      real(c_double), pointer, intent(out) :: across(:), up(:), values(:, :)
      integer(c_int), intent(out) :: status

      nullify (across, up, values)
      if (.not. (c_associated(x) .and. c_associated(y) .and. c_associated(stresses))) then
         status = refused(self, 'an array is null')
         return
      end if
      if (count < 0 .or. count > most) then
         status = refused(self, 'count is too large: there must be that many points')
         return
      end if
      call c_f_pointer(x, across, [count])
      call c_f_pointer(y, up, [count])
      call c_f_pointer(stresses, values, [int(stress_count, c_size_t), count])
      status = MFV_COMPLETE
   end subroutine take_points

   function mfv_largest_von_mises(handle, body, step, place) result(status) bind(C, name='mfv_largest_von_mises_unguarded')
      type(c_ptr), value :: handle, place
      integer(c_int), value :: body, step
      integer(c_int) :: status

      status = largest_stress(handle, body, step, place, tension=.false.)
   end function mfv_largest_von_mises

   function mfv_largest_tension(handle, body, step, place) result(status) bind(C, name='mfv_largest_tension_unguarded')
      type(c_ptr), value :: handle, place
      integer(c_int), value :: body, step
      integer(c_int) :: status

      status = largest_stress(handle, body, step, place, tension=.true.)
   end function mfv_largest_tension

   !> The largest von Mises stress or `tension` of a body, with its place.
   integer(c_int) function largest_stress(handle, body, step, place, tension) result(status)
      type(c_ptr), intent(in) :: handle, place
      integer(c_int), intent(in) :: body, step
      logical, intent(in) :: tension
      type(handle_type), pointer :: self
      type(error_type), allocatable :: error
      type(largest_type) :: largest

      call c_f_pointer(handle, self)
      if (.not. c_associated(place)) then
         status = refused(self, 'place is null')
         return
      end if
      if (tension) then
         call self%contact%get_largest_tension(int(body), largest, error, int(step))
      else
         call self%contact%get_largest_von_mises(int(body), largest, error, int(step))
      end if
      status = failed(self, error)
      if (status == MFV_COMPLETE) call place_out(largest, place)
   end function largest_stress

   !> A largest stress and its place through a pointer.
   subroutine place_out(largest, place)
      type(largest_type), intent(in) :: largest
      type(c_ptr), intent(in) :: place
      real(c_double), pointer :: values(:)

      call c_f_pointer(place, values, [3])
      values = [largest%value, largest%x, largest%y]
   end subroutine place_out

   function mfv_stress_under(handle, body, nodes, arc, width, pressure, shear, contact_edge, stick_edge, count, x, y, stresses, &
                             place, tension) result(status) bind(C, name='mfv_stress_under_unguarded')
      type(c_ptr), value :: handle, arc, width, pressure, shear, contact_edge, stick_edge, x, y, stresses, place, tension
      integer(c_int), value :: body
      integer(c_size_t), value :: nodes, count
      integer(c_int) :: status
      type(handle_type), pointer :: self
      type(interior_type) :: interior
      type(error_type), allocatable :: error
      real(c_double), pointer, dimension(:) :: positions, widths, pressures, shears, across, up
      real(c_double), pointer :: values(:, :)
      integer(c_size_t) :: i
      logical :: usable

      call c_f_pointer(handle, self)
      status = MFV_COMPLETE
      if (.not. (c_associated(arc) .and. c_associated(width) .and. c_associated(pressure) .and. c_associated(shear))) then
         status = refused(self, 'mfv_stress_under: an array is null')
         return
      end if
      if (.not. is_size(nodes)) then
         status = refused(self, 'mfv_stress_under: nodes must be at least 1 and the number of tractions')
         return
      end if
      call c_f_pointer(arc, positions, [nodes])
      call c_f_pointer(width, widths, [nodes])
      call c_f_pointer(pressure, pressures, [nodes])
      call c_f_pointer(shear, shears, [nodes])
      usable = all(ieee_is_finite(positions)) .and. all(ieee_is_finite(widths)) .and. all(ieee_is_finite(pressures)) .and. &
               all(ieee_is_finite(shears))
      if (usable) usable = all(widths > 0.0_wp)
      if (.not. usable) then
         status = refused(self, 'mfv_stress_under: values must be finite and widths positive')
         return
      end if
      call self%contact%make_interior(int(body), positions, widths, pressures, shears, edges_at(contact_edge), &
                                      edges_at(stick_edge), interior, error)
      status = failed(self, error)
      if (status == MFV_COMPLETE .and. c_associated(stresses)) then
         call take_points(self, count, x, y, stresses, across, up, values, status)
         if (status /= MFV_COMPLETE) return
         do i = 1, count
            values(:, i) = interior%all_stresses(across(i), up(i))
         end do
      end if
      if (status == MFV_COMPLETE .and. c_associated(place)) call place_out(largest_von_mises(interior), place)
      if (status == MFV_COMPLETE .and. c_associated(tension)) call place_out(largest_tension(interior), tension)

   contains

      !> Edges of the caller's, not numbers where the pointer is null.
      function edges_at(pointer_to_edges) result(edges)
         type(c_ptr), intent(in) :: pointer_to_edges
         real(wp) :: edges(nodes)
         real(c_double), pointer :: theirs(:)

         edges = ieee_value(1.0_wp, ieee_quiet_nan)
         if (.not. c_associated(pointer_to_edges)) return
         call c_f_pointer(pointer_to_edges, theirs, [nodes])
         edges = theirs
      end function edges_at
   end function mfv_stress_under

   function mfv_write(handle, path) result(status) bind(C, name='mfv_write_unguarded')
      type(c_ptr), value :: handle, path
      integer(c_int) :: status
      type(handle_type), pointer :: self
      type(error_type), allocatable :: error

      call c_f_pointer(handle, self)
      status = MFV_COMPLETE
      if (c_associated(path)) then
         call self%contact%write(text_in(path), error)
      else
         call self%contact%write('', error)
      end if
      status = failed(self, error)
      if (status == MFV_COMPLETE) call self%contact%get_message(self%message)
   end function mfv_write

   !> The field at a path of a case; MFV_BAD_ARGUMENT where there is none.
   subroutine field_at(handle, path, field, status)
      type(c_ptr), intent(in) :: handle, path
      type(field_type), pointer, intent(out) :: field
      integer(c_int), intent(out) :: status
      type(handle_type), pointer :: self
      type(error_type), allocatable :: error

      nullify (field)
      call c_f_pointer(handle, self)
      status = MFV_COMPLETE
      if (.not. c_associated(path)) then
         status = refused(self, 'the path is null')
         return
      end if
      call self%contact%find_field(text_in(path), field, error)
      status = failed(self, error)
   end subroutine field_at

   !> A number through a pointer that may be null.
   subroutine integer_out(value, pointer_to_integer)
      integer, intent(in) :: value
      type(c_ptr), intent(in) :: pointer_to_integer
      integer(c_int), pointer :: place

      if (.not. c_associated(pointer_to_integer)) return
      call c_f_pointer(pointer_to_integer, place)
      place = value
   end subroutine integer_out

   !> A size through a pointer that may be null.
   subroutine size_out(value, pointer_to_size)
      integer(c_size_t), intent(in) :: value
      type(c_ptr), intent(in) :: pointer_to_size
      integer(c_size_t), pointer :: place

      if (.not. c_associated(pointer_to_size)) return
      call c_f_pointer(pointer_to_size, place)
      place = value
   end subroutine size_out

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

   !> What messages call a text: its name, or 'text' where the pointer is null.
   function name_in(pointer_to_name) result(name)
      type(c_ptr), intent(in) :: pointer_to_name
      character(len=length_of_name(pointer_to_name)) :: name

      name = unnamed
      if (c_associated(pointer_to_name)) name = text_in(pointer_to_name)
   end function name_in

   pure integer function length_of_name(pointer_to_name) result(length)
      type(c_ptr), intent(in) :: pointer_to_name

      length = len(unnamed)
      if (c_associated(pointer_to_name)) length = int(c_strlen(pointer_to_name))
   end function length_of_name

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
