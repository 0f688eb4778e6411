!> A run that can be gone on with after the end of its process: it is paused from time to time, and where it is interrupted, and
!> a checkpoint written.
module mfv_checkpointed_run
   use, intrinsic :: iso_fortran_env, only: error_unit
   use mfv_case, only: case_type
   use mfv_checkpoint, only: checkpoint_type, new_checkpoint
   use mfv_error, only: error_type
   use mfv_kinds, only: wp
   use mfv_simulation, only: simulation_type
   use mfv_terminal, only: fail, is_interrupted, terminal_observer_type
   implicit none
   private
   public :: run_with_checkpoints, keep_run

contains

   !> Run the steps of a new simulation of `case`; where `resume`, from its checkpoint. `checkpoint`: of the run; where it has
   !> been interrupted it is there, else the caller removes it when the result is safe.
   !> The program ends where a checkpoint that is there cannot be used.
   subroutine run_with_checkpoints(case, resume, observer, simulation, checkpoint)
      type(case_type), intent(in) :: case
      logical, intent(in) :: resume
      type(terminal_observer_type), intent(inout) :: observer
      type(simulation_type), intent(inout) :: simulation
      type(checkpoint_type), intent(out) :: checkpoint
      real(wp), parameter :: seconds_of_a_minute = 60.0_wp

      call new_checkpoint(case, simulation, checkpoint)
      if (resume) call go_to_checkpoint(checkpoint, simulation)
      call observer%allow_pauses(case%checkpoint_minutes*seconds_of_a_minute)
      do
         call simulation%run(observer)
         if (.not. simulation%is_paused()) exit
         call keep_run(checkpoint, simulation, observer)
         if (is_interrupted()) call simulation%interrupt()
         if (is_interrupted()) exit
         call observer%end_pause()
      end do
      observer%can_pause = .false.
   end subroutine run_with_checkpoints

   !> Bring a new simulation to where its checkpoint was written. Where there is none the run begins at the beginning: a job that is
   !> started again and again does not need to know whether it is the first one.
   subroutine go_to_checkpoint(checkpoint, simulation)
      type(checkpoint_type), intent(in) :: checkpoint
      type(simulation_type), intent(inout) :: simulation
      type(error_type), allocatable :: error
      logical :: is_there

      inquire (file=checkpoint%path, exist=is_there)
      if (.not. is_there) then
         write (error_unit, '(a)') 'there is no '//checkpoint%path//': the case begins at the beginning'
         return
      end if
      call checkpoint%read(simulation, error)
      if (allocated(error)) call fail(error)
   end subroutine go_to_checkpoint

   !> Write a checkpoint. Where that fails the run goes on without it, and says so.
   subroutine keep_run(checkpoint, simulation, observer)
      type(checkpoint_type), intent(in) :: checkpoint
      type(simulation_type), intent(inout) :: simulation
      type(terminal_observer_type), intent(inout) :: observer
      type(error_type), allocatable :: error

      call checkpoint%write(simulation, error)
      if (allocated(error)) then
         call observer%clear()
         write (error_unit, '(a)') 'no checkpoint: '//error%message
      else if (is_interrupted()) then
         call observer%clear()
         write (error_unit, '(a)') checkpoint%path//' keeps where the run is: --resume goes on from there'
      end if
   end subroutine keep_run

end module mfv_checkpointed_run
