!> A case: a scene with what the user wants to see of its solution, and the text it came from.
module mfv_case
   use mfv_scene, only: scene_type
   use mfv_simulation, only: history_events
   implicit none
   private
   public :: case_type

   type :: case_type
      type(scene_type) :: scene
      !> The input, verbatim, and the name of its file for messages.
      character(:), allocatable :: text, source
      !> Where the result goes; empty: nowhere.
      character(:), allocatable :: result_path
      !> See mfv_simulation.
      integer :: keep_history = history_events
      !> Names of the user's units, for labels.
      character(:), allocatable :: length_unit, force_unit
   end type case_type

end module mfv_case
