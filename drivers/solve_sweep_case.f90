!> One case of a sweep, from its values to its record.
module mfv_solve_sweep_case
   use, intrinsic :: iso_fortran_env, only: int8
   use mfv_case, only: case_type
   use mfv_contact_state, only: contact_state_type
   use mfv_discretisation_error, only: estimate_error
   use mfv_sensitivity, only: find_sensitivity
   use mfv_error, only: error_type
   use mfv_kinds, only: wp
   use mfv_observer, only: observer_type
   use mfv_result_file, only: write_result
   use mfv_simulation, only: new_simulation, simulation_type
   use mfv_status, only: MFV_COMPLETE, MFV_INTERRUPTED
   use mfv_strings, only: string_type
   use mfv_sweep_plan, only: sweep_type
   use mfv_sweep_record, only: pack_record, record_of, record_of_error, record_type
   use mfv_sweep_table, only: states_name
   use mfv_terminal, only: is_interrupted
   use mfv_validity, only: validity_warnings
   implicit none
   private
   public :: solve_sweep_case

   !> Ends a run after Ctrl-C.
   type, extends(observer_type) :: stop_observer_type
   contains
      procedure :: notify
   end type stop_observer_type

contains

   !> Solve case `number`, and write its whole result where the sweep keeps it. `bytes`: its record, see mfv_sweep_record; not
   !> allocated where the run was interrupted. Error MFV_FILE_ERROR where the result could not be written.
   subroutine solve_sweep_case(sweep, number, bytes, error)
      type(sweep_type), intent(in) :: sweep
      integer, intent(in) :: number
      integer(int8), allocatable, intent(out) :: bytes(:)
      type(error_type), allocatable, intent(out) :: error
      type(case_type) :: case
      type(simulation_type) :: simulation
      type(record_type) :: record
      type(stop_observer_type) :: observer
      type(error_type), allocatable :: input_error

      call read_alone(sweep, number, case, input_error)
      if (allocated(input_error)) then
         call record_of_error(number, input_error, record)
      else
         simulation = new_simulation(case%scene, case%keep_history, case%keep_states)
         call simulation%run(observer)
         if (simulation%outcome == MFV_INTERRUPTED) return
         if (simulation%outcome /= MFV_COMPLETE) call case%explain(simulation)
         if (sweep%keeps_states) call keep_states(sweep, number, case, simulation, observer, error)
         if (allocated(error) .or. is_interrupted()) return
         call record_of(number, simulation, sweep%has_reference, record)
      end if
      call pack_record(record, bytes)
   end subroutine solve_sweep_case

   !> Read a case; HDF5, which is not made for threads, one at a time.
   subroutine read_alone(sweep, number, case, error)
      type(sweep_type), intent(in) :: sweep
      integer, intent(in) :: number
      type(case_type), intent(out) :: case
      type(error_type), allocatable, intent(out) :: error

      if (sweep%reads_hdf5()) then
         !$omp critical (mfv_hdf5)
         call sweep%read_case(number, case, error)
         !$omp end critical (mfv_hdf5)
      else
         call sweep%read_case(number, case, error)
      end if
   end subroutine read_alone

   !> Write the whole result of a case, as mfv_run does.
   subroutine keep_states(sweep, number, case, simulation, observer, error)
      type(sweep_type), intent(in) :: sweep
      integer, intent(in) :: number
      type(case_type), intent(in) :: case
      type(simulation_type), intent(inout) :: simulation
      type(stop_observer_type), intent(inout) :: observer
      type(error_type), allocatable, intent(out) :: error
      type(string_type), allocatable :: warnings(:)

      if (case%error_estimate) call estimate_error(simulation, observer)
      if (case%sensitivity) call find_sensitivity(simulation, observer)
      if (is_interrupted()) return
      call validity_warnings(simulation, warnings)
      !$omp critical (mfv_hdf5)
      call write_result(sweep%states_folder()//states_name(number)//'.h5', case, simulation, warnings, error)
      !$omp end critical (mfv_hdf5)
   end subroutine keep_states

   !> See mfv_observer.
   subroutine notify(self, state, segment, segments, fraction, stop_wanted)
      class(stop_observer_type), intent(inout) :: self
      type(contact_state_type), intent(in) :: state
      integer, intent(in) :: segment, segments
      real(wp), intent(in) :: fraction
      logical, intent(out) :: stop_wanted

      stop_wanted = is_interrupted()
   end subroutine notify

end module mfv_solve_sweep_case
