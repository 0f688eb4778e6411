!> Replaces result_file.f90 in a build without HDF5: results cannot be written.
module mfv_result_file
   use mfv_case, only: case_type
   use mfv_error, only: error_type, set_error
   use mfv_features, only: no_hdf5_message
   use mfv_observables, only: observed_type
   use mfv_simulation, only: simulation_type
   use mfv_status, only: MFV_FILE_ERROR, MFV_INPUT_ERROR
   use mfv_strings, only: string_type
   implicit none
   private
   public :: check_writable, write_result, resume_result

contains

   !> Error MFV_INPUT_ERROR, always.
   subroutine check_writable(path, error, is_whole)
      character(*), intent(in) :: path
      type(error_type), allocatable, intent(out) :: error
      logical, intent(out), optional :: is_whole

      if (present(is_whole)) is_whole = .false.
      call set_error(error, MFV_INPUT_ERROR, path//' cannot be written: '//no_hdf5_message)
   end subroutine check_writable

   !> Error MFV_INPUT_ERROR, always.
   subroutine resume_result(path, case, simulation, is_finished, error)
      character(*), intent(in) :: path
      type(case_type), intent(in) :: case
      type(simulation_type), intent(inout) :: simulation
      logical, intent(out) :: is_finished
      type(error_type), allocatable, intent(out) :: error

      is_finished = .false.
      call set_error(error, MFV_INPUT_ERROR, path//' cannot be read: '//no_hdf5_message)
   end subroutine resume_result

   !> Error MFV_FILE_ERROR, always.
   subroutine write_result(path, case, simulation, warnings, error, with_restart, observed)
      character(*), intent(in) :: path
      type(case_type), intent(in) :: case
      type(simulation_type), intent(in) :: simulation
      type(string_type), intent(in) :: warnings(:)
      logical, intent(in), optional :: with_restart
      type(observed_type), intent(in), optional :: observed
      type(error_type), allocatable, intent(out) :: error

      call check_writable(path, error)
      error%status = MFV_FILE_ERROR
   end subroutine write_result

end module mfv_result_file
