!> Which linear solver a scene gets.
module mfv_linear_solvers
   use mfv_augmented_system, only: augmented_system_type
   use mfv_contact_model, only: contact_model_type
   use mfv_contact_system, only: contact_system_type
   use mfv_krylov_system, only: krylov_system_type
   use mfv_reduced_system, only: reduced_system_type
   use mfv_scene
   implicit none
   private
   public :: new_contact_system

contains

   !> The linear solver that the model's scene asks for.
   subroutine new_contact_system(model, system)
      type(contact_model_type), intent(in) :: model
      class(contact_system_type), allocatable, intent(out) :: system

      select case (model%scene%method%linear_solver)
      case (solver_fft)
         allocate (krylov_system_type :: system)
         system%name = 'fft'
      case (solver_auto, solver_reduced)
         allocate (reduced_system_type :: system)
         system%name = 'reduced'
      case default
         allocate (augmented_system_type :: system)
      end select
   end subroutine new_contact_system

end module mfv_linear_solvers
