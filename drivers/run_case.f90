!> What the programs that solve a case have in common.
module mfv_run_case
   use, intrinsic :: iso_fortran_env, only: error_unit
   use mfv_case, only: case_type
   use mfv_case_reader, only: read_case_file
   use mfv_checkpoint, only: checkpoint_type
   use mfv_checkpointed_run, only: keep_run, run_with_checkpoints
   use mfv_clock, only: seconds_now
   use mfv_discretisation_error, only: estimate_error, has_coarser_meshes
   use mfv_error, only: error_type, set_error
   use mfv_features, only: has_hdf5, hdf5_is_left_out
   use mfv_kinds, only: wp
   use mfv_one_thread, only: use_one_thread
   use mfv_output, only: print_line, print_text
   use mfv_result_file, only: check_writable, is_whole_result, write_result
   use mfv_sensitivity, only: find_sensitivity
   use mfv_simulation, only: new_simulation, simulation_type
   use mfv_status
   use mfv_strings, only: string_type
   use mfv_summary, only: summarize
   use mfv_terminal
   use mfv_validity, only: validity_warnings
   implicit none
   private
   public :: run_case

contains

   !> Read the case in the file `path`, solve it, write its result (where the library has HDF5) and print the summary; the program
   !> then ends with the exit code of the outcome. `algorithm`: in place of the case's own; `suffix` then comes to the name of the result file.
   !> `estimate`, `sensitivity`: whether the discretisation error and the sensitivity to round-off are found out even where the case does
   !> not ask for them; `resume`: whether to go on from a checkpoint.
   subroutine run_case(path, algorithm, suffix, estimate, sensitivity, resume)
      character(*), intent(in) :: path
      integer, intent(in), optional :: algorithm
      character(*), intent(in), optional :: suffix
      logical, intent(in), optional :: estimate, sensitivity, resume
      type(case_type) :: case
      type(checkpoint_type) :: checkpoint
      type(simulation_type) :: simulation
      type(string_type), allocatable :: warnings(:)
      type(terminal_observer_type) :: observer
      type(error_type), allocatable :: error
      character(:), allocatable :: text
      real(wp) :: started
      logical :: ended_early, is_resumed, is_written

      call read_case_file(path, case, error)
      if (allocated(error)) call fail(error)
      if (present(algorithm)) case%scene%method%algorithm = algorithm
      if (present(suffix)) case%result_path = with_suffix(case%result_path, suffix)
      if (present(estimate)) call ask_for_estimate(case, estimate, error)
      if (.not. allocated(error) .and. present(sensitivity)) call ask_for_sensitivity(case, sensitivity, error)
      if (allocated(error)) call fail(error)
      if (has_hdf5) call check_writable(case%result_path, error)
      if (allocated(error)) then
         error%message = path//": &output file='"//case%result_path//"': "//error%message
         call fail(error)
      end if
      call use_one_thread()
      started = seconds_now()
      simulation = new_simulation(case%scene, case%keep_history, case%keep_states)
      call catch_interrupts()
      call observer%start()
      is_resumed = .false.
      if (present(resume)) is_resumed = resume
      call run_with_checkpoints(case, is_resumed, observer, simulation, checkpoint)
      if (case%error_estimate) then
         observer%work = 'coarser meshes: '
         call estimate_error(simulation, observer)
      end if
      if (case%sensitivity .and. .not. was_interrupted(simulation)) then
         observer%work = 'perturbed friction: '
         call find_sensitivity(simulation, observer)
      end if
      call observer%clear()
      if (was_interrupted(simulation)) call keep_run(checkpoint, simulation, observer)
      ended_early = simulation%outcome == MFV_INTERRUPTED .or. was_interrupted(simulation)
      if (simulation%outcome /= MFV_COMPLETE) call case%explain(simulation)

      call validity_warnings(simulation, warnings)
      ! A part of a run does not take the place of a whole result: its checkpoint goes on to one.
      is_written = has_hdf5
      if (is_written .and. simulation%outcome == MFV_INTERRUPTED) is_written = .not. is_whole_result(case%result_path)
      if (is_written) call write_result(case%result_path, case, simulation, warnings, error)
      if (allocated(error)) call fail(error)
      if (.not. ended_early) call checkpoint%remove()
      call summarize(case, simulation, warnings, seconds_now() - started, text)
      call print_text(text)
      if (is_written) then
         call print_line('result              '//case%result_path)
      else if (has_hdf5) then
         call print_line('result              not written: '//case%result_path//' is whole, and stays as it was')
      else
         call print_line('result              no file: '//hdf5_is_left_out)
      end if
      if (simulation%outcome /= MFV_COMPLETE) write (error_unit, '(a)') simulation%message
      if (ended_early) call end_program(status_exit_code(MFV_INTERRUPTED))
      call end_program(status_exit_code(simulation%outcome))
   end subroutine run_case

   !> Have the discretisation error estimated. Error MFV_INPUT_ERROR for a case without coarser meshes.
   subroutine ask_for_estimate(case, estimate, error)
      type(case_type), intent(inout) :: case
      logical, intent(in) :: estimate
      type(error_type), allocatable, intent(out) :: error

      case%error_estimate = case%error_estimate .or. estimate
      if (case%error_estimate .and. .not. has_coarser_meshes(case%scene)) &
         call set_error(error, MFV_INPUT_ERROR, case%source//": --estimate: a body with shape='matrix' has no coarser mesh")
   end subroutine ask_for_estimate

   !> Have the sensitivity found out. Error MFV_INPUT_ERROR for a case without friction.
   subroutine ask_for_sensitivity(case, sensitivity, error)
      type(case_type), intent(inout) :: case
      logical, intent(in) :: sensitivity
      type(error_type), allocatable, intent(out) :: error

      case%sensitivity = case%sensitivity .or. sensitivity
      if (case%sensitivity .and. .not. case%scene%friction%acts()) &
         call set_error(error, MFV_INPUT_ERROR, case%source//': --sensitivity: the case has no friction to perturb')
   end subroutine ask_for_sensitivity

   !> Whether a run that was complete was interrupted while its error or its sensitivity was found out.
   pure logical function was_interrupted(simulation)
      type(simulation_type), intent(in) :: simulation

      was_interrupted = .false.
      if (simulation%outcome == MFV_INTERRUPTED) return
      if (allocated(simulation%estimate)) was_interrupted = simulation%estimate%status == MFV_INTERRUPTED
      if (allocated(simulation%sensitivity)) was_interrupted = was_interrupted .or. simulation%sensitivity%status == MFV_INTERRUPTED
   end function was_interrupted

   !> The name of a file with a suffix before its extension.
   pure function with_suffix(path, suffix) result(name)
      character(*), intent(in) :: path, suffix
      character(len=len(path) + len(suffix)) :: name
      integer :: dot

      dot = index(path, '.', back=.true.)
      if (dot <= index(path, '/', back=.true.) + 1) dot = len(path) + 1
      name = path(:dot - 1)//suffix//path(dot:)
   end function with_suffix

end module mfv_run_case
