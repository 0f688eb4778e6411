!> A case: a scene with the requested output, and its text.
module mfv_case
   use mfv_case_data, only: case_data_type
   use mfv_kinds, only: wp
   use mfv_motions, only: motion_count, control_keep, controlled_key
   use mfv_scene, only: scene_type
   use mfv_simulation, only: history_events, simulation_type, states_auto
   use mfv_strings, only: to_text
   implicit none
   private
   public :: case_type

   type :: case_type
      type(scene_type) :: scene
      !> The input, verbatim, and the name of its file for messages.
      character(:), allocatable :: text, source
      !> Options of the program that change the result, such as --accuracy 1e-2 --estimate.
      character(len=64) :: options = ''
      !> Data in memory instead of files that the text names.
      type(case_data_type) :: data
      !> Path of the result file; empty: none.
      character(:), allocatable :: result_path
      !> See mfv_simulation.
      integer :: keep_history = history_events
      integer :: keep_states = states_auto
      !> See simulation_type.
      real(wp), allocatable :: stress_at
      !> Whether the case is also solved on coarser meshes, for an estimate of the discretisation error.
      logical :: error_estimate = .false.
      !> Whether the case is run once more with perturbed friction, to measure its sensitivity to round-off.
      logical :: sensitivity = .false.
      !> Minutes of wall clock between checkpoints; 0: only when the run is interrupted.
      real(wp) :: checkpoint_minutes = 0.0_wp
      !> Names of the user's units, for labels.
      character(:), allocatable :: length_unit, force_unit
   contains
      procedure :: explain
   end type case_type

contains

   !> Put the file, the step and the targets that were not reached before the message of a simulation that ended early.
   subroutine explain(self, simulation)
      class(case_type), intent(in) :: self
      type(simulation_type), intent(inout) :: simulation
      character(:), allocatable :: text
      integer :: i

      text = self%source//': '
      if (simulation%failed_scene_step > 0) then
         associate (step => self%scene%steps(simulation%failed_scene_step))
            if (step%row == 0) text = text//'&step '//to_text(simulation%failed_scene_step)
            if (step%row > 0) text = text//'&history'
            if (step%row > 0 .and. .not. allocated(step%path)) text = text//' row '//to_text(step%row)
            do i = 1, motion_count
               if (step%control(i) == control_keep .or. allocated(step%path)) cycle
               text = text//' '//trim(controlled_key(i, step%control(i)))//'='//to_text(step%target(i), 10)
            end do
         end associate
         text = text//' not reached: '
      end if
      simulation%message = text//simulation%message
   end subroutine explain

end module mfv_case
