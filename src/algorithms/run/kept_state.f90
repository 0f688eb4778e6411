!> A state of a simulation saved in memory: a host program tries a step and restores the state.
!>
!> History records, snapshots and cycles are not copied; those after the saved state are dropped when it is restored. A simulation
!> with history or states can therefore only be restored to states of its own load history, identified by a checksum. A simulation
!> without them can be restored to any saved state of its scene.
module mfv_kept_state
   use, intrinsic :: iso_fortran_env, only: int64
   use mfv_error, only: error_type, set_error
   use mfv_run_state, only: saved_run_type
   use mfv_simulation, only: simulation_type
   use mfv_status, only: MFV_BAD_ARGUMENT
   implicit none
   private
   public :: kept_state_type

   type :: kept_state_type
      private
      type(saved_run_type) :: run
      integer(int64) :: scene = 0, history_checksum = 0
      logical :: is_saved = .false.
   contains
      procedure :: keep
      procedure :: come_back
   end type kept_state_type

contains

   !> Save the present state of a simulation. `scene`: checksum of its scene.
   subroutine keep(self, simulation, scene)
      class(kept_state_type), intent(inout) :: self
      type(simulation_type), intent(in) :: simulation
      integer(int64), intent(in) :: scene

      call simulation%save_to(self%run)
      self%is_saved = .true.
      self%scene = scene
      self%history_checksum = simulation%history_checksum()
   end subroutine keep

   !> Restore the state of a simulation. Error MFV_BAD_ARGUMENT: nothing was saved, the state is of another scene, or it is not of
   !> the load history so far; the simulation is then unchanged.
   subroutine come_back(self, simulation, scene, error)
      class(kept_state_type), intent(in) :: self
      type(simulation_type), intent(inout) :: simulation
      integer(int64), intent(in) :: scene
      type(error_type), allocatable, intent(out) :: error

      if (.not. self%is_saved) then
         call set_error(error, MFV_BAD_ARGUMENT, 'no state has been saved; save one first')
      else if (scene /= self%scene) then
         call set_error(error, MFV_BAD_ARGUMENT, 'the state is of another scene')
      else if (.not. simulation%passed_through(self%run%position%load_summary%steps, self%history_checksum)) then
         call set_error(error, MFV_BAD_ARGUMENT, 'the state is not part of the load history so far; set &output '// &
                        "history='none', states='none' to restore any saved state")
      end if
      if (allocated(error)) return
      call simulation%restore(self%run)
      if (allocated(simulation%estimate)) deallocate (simulation%estimate)
      if (allocated(simulation%sensitivity)) deallocate (simulation%sensitivity)
   end subroutine come_back

end module mfv_kept_state
