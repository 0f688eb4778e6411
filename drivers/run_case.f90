!> Solve a case: common to mfv_run and mfv_conventional.
module mfv_run_case
   use, intrinsic :: iso_c_binding, only: c_int
   use, intrinsic :: iso_fortran_env, only: error_unit
   use mfv_clock, only: seconds_now
   use mfv_command_line, only: end_program, fail
   use mfv_contact, only: contact_type, read_contact
   use mfv_error, only: error_type
   use mfv_features, only: has_hdf5, no_hdf5_message
   use mfv_kinds, only: wp
   use mfv_output, only: print_line, print_text
   use mfv_process, only: catch_interrupts, use_one_thread
   use mfv_status, only: MFV_COMPLETE, MFV_INTERRUPTED, status_exit_code
   use mfv_terminal, only: terminal_observer_type
   implicit none
   private
   public :: run_case

contains

   !> Read the case in the file `path`, solve it, write its result (if the library has HDF5) and print the summary; the program then
   !> ends with the exit code of the outcome. `algorithm`, `accuracy`: replace those of the case; `suffix`: inserted in the
   !> name of the result file. `estimate`, `sensitivity`: compute error bars and the sensitivity to round-off even if the case does
   !> not request them; `resume`: continue from a checkpoint.
   subroutine run_case(path, resume, estimate, sensitivity, accuracy, algorithm, suffix)
      character(*), intent(in) :: path
      logical, intent(in) :: resume, estimate, sensitivity
      real(wp), intent(in), optional :: accuracy
      integer, intent(in), optional :: algorithm
      character(*), intent(in), optional :: suffix
      type(contact_type) :: contact
      type(terminal_observer_type) :: observer
      type(error_type), allocatable :: error
      character(:), allocatable :: text
      real(wp) :: started

      call use_one_thread()
      started = seconds_now()
      call read_contact(path, contact, error, needs_steps=.true., algorithm=algorithm, suffix=suffix, accuracy=accuracy)
      if (.not. allocated(error)) call contact%ask_for(estimate, sensitivity, error)
      if (.not. allocated(error)) call contact%keep_checkpoints(error)
      if (allocated(error)) call fail(error)
      if (resume) call continue_run(contact)
      call catch_interrupts(int(status_exit_code(MFV_INTERRUPTED), c_int))
      call observer%start()
      call contact%run(observer)
      call observer%clear()
      if (has_hdf5) call contact%save(error)
      if (allocated(error)) call fail(error)
      call contact%summarize(seconds_now() - started, text)
      call print_text(text)
      if (.not. has_hdf5) then
         call print_line('result              not written: '//no_hdf5_message)
      else if (contact%is_unfinished() .and. contact%checkpoint_path == '') then
         call print_line('result              not written: interrupted before step 1')
      else if (contact%is_unfinished()) then
         call print_line('result              '//contact%checkpoint_path//' (unfinished; --resume continues)')
      else
         call print_line('result              '//contact%case%result_path)
      end if
      if (contact%status() /= MFV_COMPLETE) then
         call contact%get_message(text)
         write (error_unit, '(a)') text
      end if
      call end_program(status_exit_code(merge(MFV_INTERRUPTED, contact%status(), contact%is_unfinished())))
   end subroutine run_case

   !> Continue from the checkpoint of the case, if there is one, and print a message. The program ends if the result is complete or
   !> the checkpoint cannot be used.
   subroutine continue_run(contact)
      type(contact_type), intent(inout) :: contact
      type(error_type), allocatable :: error
      character(:), allocatable :: message
      logical :: is_finished

      call contact%resume(message, is_finished, error)
      if (allocated(error)) call fail(error)
      write (error_unit, '(a)') message
      if (is_finished) call end_program(0)
   end subroutine continue_run

end module mfv_run_case
