!> The restart data of a result file, in its group `restart`: what an interrupted run needs, besides the history and the states of
!> every result, to continue from the start of the segment in which it was stopped.
!>
!> `exchange` writes or reads a quantity, so that each is named once.
module mfv_hdf5_restart
   use hdf5, only: hid_t
   use, intrinsic :: iso_fortran_env, only: int8, int64
   use mfv_checksum, only: add_to_checksum
   use mfv_contact_model, only: adapt_model, contact_model_type
   use mfv_contact_path, only: path_record_type
   use mfv_contact_state, only: contact_state_type, new_contact_state
   use mfv_error, only: error_type, set_error
   use mfv_friction_law, only: memory_size
   use mfv_hdf5_reader, only: read_vector
   use mfv_history, only: history_type
   use mfv_kinds, only: wp
   use mfv_contact_system, only: solver_work_type
   use mfv_motions, only: motions, motion_count, user_motions
   use mfv_node_status, only: node_creep_left, node_open
   use mfv_result_fields, only: along_nothing, field_type, list_type, step_group
   use mfv_run_state, only: mark_count, run_record_type, snapshot_type, wear_trial_type
   use mfv_scene, only: step_type
   use mfv_simulation, only: simulation_type
   use mfv_status, only: MFV_INPUT_ERROR
   use mfv_strings, only: to_text
   use mfv_tolerances, only: significant
   use mfv_wear_block, only: widened
   implicit none
   private
   public :: restart_group, restart_fields, read_restart

   character(*), parameter :: restart_group = 'restart'
   !> Relative tolerance for scenes to be the same.
   real(wp), parameter :: same = significant
   !> Upper limit of counts.
   integer, parameter :: most = 1000000000
   character(*), parameter :: internal = 'internal values of this version of MFV, for --resume'

   !> All of a run that has a fixed size. None of it may have allocatable components.
   type :: numbers_type
      type(path_record_type) :: path
      type(run_record_type) :: run
      type(solver_work_type) :: work
      !> See saved_path_type.
      integer :: records = 0, added = 0
      logical :: tangential = .false., moves(motion_count) = .false.
      !> Of the last step that was reached.
      character(len=240) :: message = ''
   end type numbers_type

   !> One group of a file that is written or read.
   type :: exchange_type
      logical :: reading = .false.
      integer(hid_t) :: file = -1
      !> The group, and a prefix of names for several states in one group.
      character(:), allocatable :: group, prefix
      !> Fields to be written.
      type(list_type) :: list
      !> The first error of reading.
      type(error_type), allocatable :: error
   contains
      generic :: exchange => exchange_reals, exchange_real, exchange_integers, exchange_integer
      procedure, private :: exchange_reals, exchange_real, exchange_integers, exchange_integer
      procedure, private :: complain
   end type exchange_type

contains

   !> The fields of the group `restart` of an interrupted run, all on the present mesh.
   subroutine restart_fields(simulation, fields)
      type(simulation_type), intent(in) :: simulation
      type(field_type), allocatable, intent(out) :: fields(:)
      type(exchange_type) :: to_file
      type(simulation_type) :: copy
      integer :: i

      copy%position_type = simulation%position_type
      copy%restart = simulation%restart
      if (allocated(simulation%cycles)) copy%cycles = simulation%cycles
      if (allocated(simulation%wear_trial)) call copy_trial(simulation, copy)
      copy%run_record_type = copy%restart%position%run_record_type
      copy%contact%model = simulation%contact%model
      copy%contact%history = simulation%contact%history
      associate (saved => copy%restart%contact)
         saved%position%state = copy%padded(snapshot_type(state=saved%position%state, added=saved%added))
         saved%added = copy%contact%model%added
      end associate
      call copy%slip_range%widen(copy%contact%model%nodes(), copy%contact%model%added)
      do i = 1, mark_count
         if (copy%marks(i)%step > 0) copy%marks(i)%state = copy%padded(copy%marks(i))
      end do
      ! Snapshots are in `steps`; only their other values are written, on the nodes of the present mesh.
      allocate (copy%snapshots(simulation%snapshot_count))
      do i = 1, simulation%snapshot_count
         copy%snapshots(i)%state = simulation%snapshots(i)%state
         call copy%snapshots(i)%state%widen(copy%contact%model%added - simulation%snapshots(i)%added)
      end do
      to_file%group = restart_group
      allocate (to_file%list%fields(0))
      call exchange_restart(to_file, copy)
      call move_alloc(to_file%list%fields, fields)
   end subroutine restart_fields

   !> Copy the present block of wear, and the position at its start if its wear has begun.
   subroutine copy_trial(simulation, copy)
      type(simulation_type), intent(in) :: simulation
      type(simulation_type), intent(inout) :: copy

      associate (trial => simulation%wear_trial)
         allocate (copy%wear_trial)
         copy%wear_trial%cycles = trial%cycles
         copy%wear_trial%correction = widened(trial%correction, simulation%contact%model%nodes())
         if (.not. trial%is_worn) return
         copy%position_type = trial%start%position
         if (allocated(trial%start%last_cycle)) copy%cycles = [trial%start%last_cycle]
      end associate
   end subroutine copy_trial

   !> Restore a new simulation from the restart data in `file`. Error MFV_INPUT_ERROR if they are missing, damaged or of another
   !> scene; the simulation is then undefined.
   subroutine read_restart(file, simulation, error)
      integer(hid_t), intent(in) :: file
      type(simulation_type), intent(inout) :: simulation
      type(error_type), allocatable, intent(out) :: error
      type(exchange_type) :: from_file
      integer :: i

      from_file%reading = .true.
      from_file%file = file
      from_file%group = restart_group
      call exchange_restart(from_file, simulation)
      if (allocated(from_file%error)) then
         call move_alloc(from_file%error, error)
      else
         call simulation%resume()
         do i = 1, simulation%snapshot_count
            call simulation%contact%model%displace(simulation%snapshots(i)%state%fields)
         end do
      end if
   end subroutine read_restart

   !> All of the group `restart`.
   subroutine exchange_restart(self, simulation)
      type(exchange_type), intent(inout) :: self
      type(simulation_type), intent(inout) :: simulation
      logical :: wears
      integer :: nodes, i

      self%prefix = ''
      call exchange_scene(self, simulation%contact%model)
      call exchange_numbers(self, simulation)
      associate (steps => simulation%contact%model%scene%steps)
         if (any(steps%row > 0)) call exchange_targets(self, steps)
      end associate
      if (allocated(self%error)) return
      nodes = simulation%contact%model%nodes()
      wears = simulation%contact%model%scene%wear%acts()
      if (self%reading) call read_snapshots(self, simulation)
      if (wears) call exchange_trial(self, nodes, simulation%wear_trial)
      call exchange_cycles(self, simulation)
      call exchange_history(self, simulation%restart%contact%records, simulation%contact%history)
      call exchange_state(self, 'state_', nodes, wears, simulation%restart%contact%position%state)
      associate (slip => simulation%slip_range)
         if (self%reading) call slip%widen(nodes, simulation%contact%model%added)
         call self%exchange('lowest_slip', slip%lowest, 'smallest slip of the nodes in contact in the present cycle')
         call self%exchange('highest_slip', slip%highest, 'largest slip of the nodes in contact in the present cycle')
      end associate
      associate (marks => simulation%marks)
         call self%exchange('mark_steps', marks%step, 'steps of the states mark_1 and so on', 0, most)
         call self%exchange('mark_reversals', marks%reversal, 'reversals of the states mark_1 and so on', 0, most)
      end associate
      do i = 1, mark_count
         associate (mark => simulation%marks(i))
            if (mark%step == 0) cycle
            mark%added = simulation%contact%model%added
            call exchange_state(self, 'mark_'//to_text(i)//'_', nodes, wears, mark%state)
         end associate
      end do
      if (allocated(self%error) .or. .not. simulation%contact%model%tangential) return
      do i = 1, simulation%snapshot_count
         call self%exchange('stuck_slip_'//to_text(i), simulation%snapshots(i)%state%stuck_slip, &
                            'slip at which the nodes are stuck in '//step_group(i))
      end do
   end subroutine exchange_restart

   !> What has a fixed size. A simulation that reads it has the mesh and the problem of that time afterwards.
   subroutine exchange_numbers(self, simulation)
      type(exchange_type), intent(inout) :: self
      type(simulation_type), intent(inout) :: simulation
      type(numbers_type) :: numbers
      integer, allocatable :: list(:)

      associate (saved => simulation%restart%contact, run => simulation%restart%position%run_record_type)
         numbers = numbers_type(saved%position%path_record_type, run, saved%work, saved%records, saved%added, saved%tangential, &
                                saved%moves, simulation%restart%position%message)
         list = transfer(numbers, [0])
         list = [list, checksum_of(list)]
         call self%exchange('numbers', list, internal)
         if (allocated(self%error)) return
         if (self%reading) then
            associate (last => size(list) - 2)
               if (any(list(last + 1:) /= checksum_of(list(:last)))) call self%complain('numbers')
            end associate
            if (allocated(self%error)) return
            numbers = transfer(list, numbers)
            saved%position%path_record_type = numbers%path
            run = numbers%run
            simulation%run_record_type = run
            saved%work = numbers%work
            saved%records = numbers%records
            saved%added = numbers%added
            saved%tangential = numbers%tangential
            saved%moves = numbers%moves
            simulation%restart%position%message = trim(numbers%message)
            call adapt_model(simulation%contact%model, saved%added, saved%tangential, saved%moves)
         end if
      end associate
   end subroutine exchange_numbers

   !> The checksum of integers, as two integers.
   pure function checksum_of(list)
      integer, intent(in) :: list(:)
      integer :: checksum_of(2)
      integer(int64) :: checksum

      checksum = 0
      call add_to_checksum(transfer(list, [0_int8]), checksum)
      checksum_of = transfer(checksum, checksum_of)
   end function checksum_of

   !> Identify the scene by positions, gaps, coefficients of friction, and displacements under uneven tractions, at the initial
   !> nodes of the mesh.
   subroutine exchange_scene(self, model)
      type(exchange_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      real(wp), dimension(model%nodes()) :: traction, normal, tangential
      real(wp), allocatable :: ours(:, :), numbers(:)
      integer :: i, first, last

      first = model%added + 1
      last = model%nodes() - model%added
      traction = 0.0_wp
      traction(first:last) = [(1.0_wp + sqrt(real(i, wp)), i=1, last - first + 1)]
      call model%compliance%displacements(traction, traction, normal, tangential)
      ours = reshape([model%x(first:last), model%initial_gap(first:last) - model%worn(first:last), &
                      model%static_friction(first:last), model%kinetic_friction(first:last), normal(first:last), &
                      tangential(first:last)], [last - first + 1, 6])
      numbers = reshape(ours, [size(ours)])
      call self%exchange('scene', numbers, 'positions, gaps, coefficients of friction and displacements, to identify the scene')
      if (.not. self%reading .or. allocated(self%error)) return
      associate (theirs => reshape(numbers, shape(ours)))
         do i = 1, size(ours, 2)
            if (maxval(abs(theirs(:, i) - ours(:, i))) > same*maxval(abs(ours(:, i)))) then
               call set_error(self%error, MFV_INPUT_ERROR, 'the result of another case: a file that the case reads has changed')
               return
            end if
         end do
      end associate
   end subroutine exchange_scene

   !> Identify the load history by its targets, which may be in a file.
   subroutine exchange_targets(self, steps)
      type(exchange_type), intent(inout) :: self
      type(step_type), intent(in) :: steps(:)
      real(wp), allocatable :: ours(:), numbers(:)
      integer :: i

      ours = [(steps(i)%target, i=1, size(steps))]
      do i = 1, size(steps)
         if (allocated(steps(i)%path)) ours = [ours, steps(i)%path]
      end do
      numbers = ours
      call self%exchange('targets', numbers, 'targets of all steps, to identify the load history')
      if (.not. self%reading .or. allocated(self%error)) return
      if (any(abs(numbers - ours) > same*abs(ours))) &
         call set_error(self%error, MFV_INPUT_ERROR, 'the result of another case: the file of the load history has changed')
   end subroutine exchange_targets

   !> The cycles so far.
   subroutine exchange_cycles(self, simulation)
      type(exchange_type), intent(inout) :: self
      type(simulation_type), intent(inout) :: simulation
      integer, allocatable :: list(:)

      if (self%reading) allocate (simulation%cycles(max(simulation%cycle_count, 1)))
      if (simulation%cycle_count == 0) return
      list = transfer(simulation%cycles(:simulation%cycle_count), [0])
      call self%exchange('cycles', list, internal)
      simulation%cycles(:simulation%cycle_count) = transfer(list, simulation%cycles, simulation%cycle_count)
   end subroutine exchange_cycles

   !> The first `records` records of the load history.
   subroutine exchange_history(self, records, history)
      type(exchange_type), intent(inout) :: self
      integer, intent(in) :: records
      type(history_type), intent(inout) :: history
      integer, allocatable :: list(:)

      if (records == 0) return
      if (self%reading) then
         history%records = records
         if (allocated(history%record)) deallocate (history%record)
         allocate (history%record(records))
      end if
      list = transfer(history%record(:records), [0])
      call self%exchange('records', list, internal)
      history%record(:records) = transfer(list, history%record, records)
   end subroutine exchange_history

   !> The block of wear that the segment begins with, if there is one.
   subroutine exchange_trial(self, nodes, trial)
      type(exchange_type), intent(inout) :: self
      integer, intent(in) :: nodes
      type(wear_trial_type), allocatable, intent(inout) :: trial
      integer :: begins

      begins = merge(1, 0, allocated(trial))
      call self%exchange('begins_with_wear', begins, 'whether the segment begins with the wear of a block of cycles', 0, 1)
      if (begins == 0 .or. allocated(self%error)) return
      if (self%reading) then
         allocate (trial)
         allocate (trial%correction(nodes))
      end if
      call self%exchange('block', trial%cycles, 'cycles of that block; 0: as many as the tolerance allows', 0, most)
      call self%exchange('correction', trial%correction, 'depth of wear that corrects the block before')
   end subroutine exchange_trial

   !> A state with everything that later increments depend on. `wears`: whether the surfaces do.
   subroutine exchange_state(self, prefix, nodes, wears, state)
      type(exchange_type), intent(inout) :: self
      character(*), intent(in) :: prefix
      integer, intent(in) :: nodes
      logical, intent(in) :: wears
      type(contact_state_type), intent(inout) :: state
      integer :: i

      if (allocated(self%error)) return
      if (self%reading) state = new_contact_state(nodes, wears)
      self%prefix = prefix
      call exchange_visible(self, state)
      call exchange_motions(self, state, motions(:user_motions)%optional)
      call self%exchange('skipped_dissipation', state%skipped_dissipation, 'energy dissipated in cycles that are not computed')
      call self%exchange('friction_work', state%friction_work, 'energy dissipated per unit of surface')
      call self%exchange('cycle_work', state%cycle_work, 'magnitudes of the friction work of this cycle')
      call self%exchange('pressure_work', state%pressure_work, 'the same times the pressure')
      call self%exchange('worn', state%worn, 'depth worn off both surfaces')
      call self%exchange('coarsely_worn', state%coarsely_worn, 'area worn off in single cycles that wear too much')
      call self%exchange('wear_error', state%wear_error, 'estimated error of the area worn off in given blocks of cycles')
      call self%exchange('normal', state%fields%normal, 'separation of the surfaces by deformation and rotation')
      call self%exchange('tangential', state%fields%tangential, 'displacement of the lower surface to the right relative to '// &
                         'the upper one')
      call self%exchange('stuck_slip', state%stuck_slip, 'slip at which the node is stuck')
      call self%exchange('slip_direction', state%slip_direction, 'sign of the last slip rate')
      do i = 1, memory_size
         call self%exchange('memory_'//to_text(i), state%memory(i, :), 'internal variable of the friction law')
      end do
      self%prefix = ''
   end subroutine exchange_state

   !> The fields of every state of a result.
   subroutine exchange_visible(self, state)
      type(exchange_type), intent(inout) :: self
      type(contact_state_type), intent(inout) :: state

      call self%exchange('status', state%status, 'contact status')
      if (any(state%status < node_open .or. state%status > node_creep_left)) call self%complain('status')
      call self%exchange('pressure', state%fields%pressure, 'pressure')
      call self%exchange('shear', state%fields%shear, 'shear traction')
      call exchange_motions(self, state,.not. motions(:user_motions)%optional)
      call self%exchange('dissipation', state%dissipation, 'energy dissipated so far')
   end subroutine exchange_visible

   !> Some of the motions with their forces.
   subroutine exchange_motions(self, state, which)
      type(exchange_type), intent(inout) :: self
      type(contact_state_type), intent(inout) :: state
      logical, intent(in) :: which(user_motions)
      integer :: i

      do i = 1, user_motions
         if (.not. which(i)) cycle
         call self%exchange(trim(motions(i)%key), state%fields%motion(i), trim(motions(i)%key))
         call self%exchange(trim(motions(i)%force_key), state%fields%force(i), trim(motions(i)%force_name))
      end do
   end subroutine exchange_motions

   !> The states of steps and reversals before the restart.
   subroutine read_snapshots(self, simulation)
      type(exchange_type), intent(inout) :: self
      type(simulation_type), intent(inout) :: simulation
      integer :: i

      if (simulation%snapshot_count > size(simulation%snapshots)) then
         deallocate (simulation%snapshots)
         allocate (simulation%snapshots(simulation%snapshot_count))
      end if
      do i = 1, simulation%snapshot_count
         associate (snapshot => simulation%snapshots(i), model => simulation%contact%model)
            self%group = step_group(i)
            snapshot%state = new_contact_state(model%nodes(), model%scene%wear%acts())
            call exchange_visible(self, snapshot%state)
            call exchange_motions(self, snapshot%state, motions(:user_motions)%optional .and. model%moves(:user_motions))
            if (model%tangential) call self%exchange('friction_work', snapshot%state%friction_work, '')
            if (model%scene%wear%acts()) call self%exchange('wear_depth', snapshot%state%worn, '')
            call self%exchange('step', snapshot%step, '', 1, size(model%scene%steps))
            call self%exchange('reversal', snapshot%reversal, '', 1, huge(1))
            if (allocated(self%error)) return
            snapshot%added = model%added
         end associate
      end do
      self%group = restart_group
   end subroutine read_snapshots

   subroutine exchange_reals(self, name, values, meaning)
      class(exchange_type), intent(inout) :: self
      character(*), intent(in) :: name, meaning
      real(wp), intent(inout) :: values(:)
      real(wp), allocatable :: theirs(:)

      if (allocated(self%error)) return
      if (self%reading) then
         call read_vector(self%file, self%group//'/'//self%prefix//name, size(values), theirs, self%error)
         if (.not. allocated(self%error)) values = theirs
      else
         call self%list%add(self%prefix//name, values, along_nothing, '1', meaning)
      end if
   end subroutine exchange_reals

   subroutine exchange_real(self, name, value, meaning)
      class(exchange_type), intent(inout) :: self
      character(*), intent(in) :: name, meaning
      real(wp), intent(inout) :: value
      real(wp) :: values(1)

      values = value
      call self%exchange(name, values, meaning)
      value = values(1)
   end subroutine exchange_real

   !> Integers, from `least` to `most` if given.
   subroutine exchange_integers(self, name, values, meaning, least, most)
      class(exchange_type), intent(inout) :: self
      character(*), intent(in) :: name, meaning
      integer, intent(inout) :: values(:)
      integer, intent(in), optional :: least, most
      real(wp), allocatable :: numbers(:)
      logical :: damaged

      if (.not. self%reading) then
         call self%list%add(self%prefix//name, values, along_nothing, meaning)
         return
      end if
      numbers = real(values, wp)
      call self%exchange(name, numbers, meaning)
      damaged = any(abs(numbers) > real(huge(1), wp) + 1.0_wp)
      if (.not. damaged) values = nint(numbers)
      if (present(least) .and. present(most)) damaged = damaged .or. any(values < least .or. values > most)
      if (damaged) call self%complain(name)
   end subroutine exchange_integers

   subroutine exchange_integer(self, name, value, meaning, least, most)
      class(exchange_type), intent(inout) :: self
      character(*), intent(in) :: name, meaning
      integer, intent(inout) :: value
      integer, intent(in), optional :: least, most
      integer :: values(1)

      values = value
      call self%exchange(name, values, meaning, least, most)
      value = values(1)
   end subroutine exchange_integer

   !> Error for an impossible value.
   subroutine complain(self, name)
      class(exchange_type), intent(inout) :: self
      character(*), intent(in) :: name

      if (.not. allocated(self%error)) &
         call set_error(self%error, MFV_INPUT_ERROR, self%group//'/'//self%prefix//name//' is damaged')
   end subroutine complain

end module mfv_hdf5_restart
