!> What the programs that solve a case have in common.
module mfv_run_case
   use, intrinsic :: iso_fortran_env, only: error_unit, output_unit
   use mfv_case, only: case_type
   use mfv_case_reader, only: read_case_file
   use mfv_clock, only: seconds_now
   use mfv_error, only: error_type
   use mfv_hdf5_writer, only: check_writable
   use mfv_kinds, only: wp
   use mfv_result_file, only: write_result
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

   !> Read the case in the file `path`, solve it, write its result and print the summary; the program then ends with the exit
   !> code of the outcome. `algorithm`: in place of the case's own; `suffix` then comes to the name of the result file.
   subroutine run_case(path, algorithm, suffix)
      character(*), intent(in) :: path
      integer, intent(in), optional :: algorithm
      character(*), intent(in), optional :: suffix
      type(case_type) :: case
      type(simulation_type) :: simulation
      type(string_type), allocatable :: warnings(:)
      type(terminal_observer_type) :: observer
      type(error_type), allocatable :: error
      character(:), allocatable :: text
      real(wp) :: started

      call read_case_file(path, case, error)
      if (allocated(error)) call fail(error)
      if (present(algorithm)) case%scene%method%algorithm = algorithm
      if (present(suffix)) case%result_path = with_suffix(case%result_path, suffix)
      call check_writable(case%result_path, error)
      if (allocated(error)) then
         error%message = path//": &output file='"//case%result_path//"': "//error%message
         call fail(error)
      end if
      started = seconds_now()
      simulation = new_simulation(case%scene, case%keep_history, case%keep_reversals)
      call catch_interrupts()
      call observer%start()
      call simulation%run(observer)
      call observer%clear()
      if (simulation%outcome /= MFV_COMPLETE) call case%explain(simulation)

      call validity_warnings(simulation, warnings)
      call write_result(case%result_path, case, simulation, warnings, error)
      if (allocated(error)) call fail(error)
      call summarize(case, simulation, warnings, seconds_now() - started, text)
      write (output_unit, '(a)', advance='no') text
      write (output_unit, '(a)') 'result              '//case%result_path
      if (simulation%outcome /= MFV_COMPLETE) write (error_unit, '(a)') simulation%message
      call end_program(status_exit_code(simulation%outcome))
   end subroutine run_case

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
