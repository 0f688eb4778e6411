!> A state of a simulation, kept in memory to come back to: a host program tries a step and takes it back.
!>
!> What only grows along the way (history records, snapshots, cycles) is not copied: coming back drops what has come since. So a
!> simulation that keeps any of these can come back only to states on the way that led to where it is now, which is told from a
!> checksum of that way; one that keeps none of them can go to any state that was kept of its scene.
module mfv_kept_state
   use, intrinsic :: iso_fortran_env, only: int64
   use mfv_contact_path, only: kept_path_type
   use mfv_cycle, only: cycle_type
   use mfv_error, only: error_type, set_error
   use mfv_simulation, only: history_none, position_type, simulation_type
   use mfv_status, only: MFV_BAD_ARGUMENT
   implicit none
   private
   public :: kept_state_type

   type :: kept_state_type
      private
      type(kept_path_type) :: contact
      type(position_type) :: position
      !> The last cycle, where there is no load history, and so only this one.
      type(cycle_type), allocatable :: last_cycle
      integer(int64) :: scene = 0, trail = 0
      logical :: is_kept = .false.
   contains
      procedure :: keep
      procedure :: come_back
   end type kept_state_type

contains

   !> Keep the present state of a simulation. `scene`: a checksum by which the scene is known.
   subroutine keep(self, simulation, scene)
      class(kept_state_type), intent(inout) :: self
      type(simulation_type), intent(in) :: simulation
      integer(int64), intent(in) :: scene

      call simulation%contact%keep(self%contact)
      self%position = simulation%position_type
      if (allocated(self%last_cycle)) deallocate (self%last_cycle)
      if (simulation%cycle_count > 0 .and. simulation%keep_history == history_none) self%last_cycle = simulation%cycles(1)
      self%is_kept = .true.
      self%scene = scene
      self%trail = simulation%trail()
   end subroutine keep

   !> Bring a simulation back to the state. Error MFV_BAD_ARGUMENT: nothing was kept, the state is of another scene (see keep), or
   !> it
   !> is not on the way that led to the present one; the simulation is then as it was.
   subroutine come_back(self, simulation, scene, error)
      class(kept_state_type), intent(in) :: self
      type(simulation_type), intent(inout) :: simulation
      integer(int64), intent(in) :: scene
      type(error_type), allocatable, intent(out) :: error

      if (.not. self%is_kept) then
         call set_error(error, MFV_BAD_ARGUMENT, 'nothing has been kept in this state')
      else if (scene /= self%scene) then
         call set_error(error, MFV_BAD_ARGUMENT, 'the state is of another scene')
      else if (.not. simulation%came_through(self%position%way%steps, self%trail)) then
         call set_error(error, MFV_BAD_ARGUMENT, 'the state is not on the way that led to the present one, of which history '// &
                        "or states are kept; with &output history='none', states='none' any state can be gone to")
      end if
      if (allocated(error)) return
      call simulation%contact%come_back(self%contact)
      simulation%position_type = self%position
      if (allocated(self%last_cycle) .and. simulation%keep_history == history_none) simulation%cycles = [self%last_cycle]
      if (allocated(simulation%estimate)) deallocate (simulation%estimate)
      if (allocated(simulation%sensitivity)) deallocate (simulation%sensitivity)
   end subroutine come_back

end module mfv_kept_state
