!> Choice of the linear solver of a scene, and of its stepping.
module mfv_linear_solvers
   use mfv_augmented_system, only: augmented_system_type
   use mfv_automatic_system, only: automatic_system_type
   use mfv_compliance, only: block_wt
   use mfv_contact_model, only: contact_model_type
   use mfv_contact_system, only: contact_system_type
   use mfv_kinds, only: wp
   use mfv_krylov_system, only: krylov_system_type
   use mfv_reduced_system, only: reduced_system_type
   use mfv_scene
   use mfv_solver_costs, only: least_by_default, least_coupled_leap, least_exact, least_leap, most_after_increments, most_apart, &
                               most_at_once, most_at_once_coupled, most_bristles, most_bristles_coupled, most_coupled, most_one_way
   implicit none
   private
   public :: new_contact_system, choose_stepping

contains

   !> The linear solver of the scene of a model. 'auto': the reduced system up to a number of nodes in contact that depends on the
   !> structure (mfv_solver_costs), beyond it fft, whose memory is proportional to that of the mesh. A stored matrix has no fast
   !> products and always uses the reduced system.
   subroutine new_contact_system(model, system)
      type(contact_model_type), intent(in) :: model
      class(contact_system_type), allocatable, intent(out) :: system
      integer :: solver

      solver = model%scene%method%linear_solver
      if (solver == solver_auto .and. (model%scene%lower%is_matrix() .or. allocated(model%scene%mesh%ends) .or. &
                                       model%nodes() <= most_reduced(model))) solver = solver_reduced
      select case (solver)
      case (solver_auto)
         allocate (automatic_system_type :: system)
         system%name = 'reduced'
         select type (system)
         type is (automatic_system_type)
            system%most = most_reduced(model)
            system%most_one_by_one = system%most
            if (model%scene%method%stepping == stepping_leap) system%most_one_by_one = max(system%most, most_after_increments)
         end select
      case (solver_fft)
         allocate (krylov_system_type :: system)
         system%name = 'fft'
      case (solver_reduced)
         allocate (reduced_system_type :: system)
         system%name = 'reduced'
      case default
         allocate (augmented_system_type :: system)
      end select
   end subroutine new_contact_system

   !> Choose the accuracy of the scene of a model, if it has none, and its stepping. 'auto': large increments with Coulomb friction
   !> and enough nodes (mfv_solver_costs), where they can be exact or have an accuracy.
   subroutine choose_stepping(model)
      type(contact_model_type), intent(inout) :: model
      !> Error of large increments without an accuracy: beside that of meshes of `least_by_default` nodes, about 1.5e-3.
      real(wp), parameter :: usual = 1.0e-3_wp
      logical :: coupled

      coupled = model%compliance%has_block(block_wt)
      associate (method => model%scene%method, proportional => model%scene%friction%is_proportional())
         if (.not. method%accuracy >= 0.0_wp) then
            method%accuracy = merge(usual, 0.0_wp, method%stepping == stepping_leap .or. method%stepping == stepping_auto .and. &
                                    proportional .and. model%nodes() >= least_by_default)
            model%scene%mesh%nodes_by_accuracy = .false.
         end if
         if (method%stepping /= stepping_auto) return
         method%stepping = stepping_event
         if (.not. proportional) return
         if (method%accuracy > 0.0_wp .and. model%nodes() >= merge(least_coupled_leap, least_leap, coupled) .or. &
             .not. coupled .and. model%compliance%is_homogeneous .and. model%nodes() >= least_exact) method%stepping = stepping_leap
      end associate
   end subroutine choose_stepping

   !> Most nodes in contact for the reduced system.
   pure integer function most_reduced(model) result(most)
      type(contact_model_type), intent(in) :: model
      logical :: coupled, one_way, at_once

      one_way = model%compliance%one_way()
      coupled = model%compliance%has_block(block_wt) .and. .not. one_way
      associate (scene => model%scene)
         at_once = scene%method%algorithm == algorithm_mfv .and. &
                   (scene%method%stepping == stepping_leap .or. &
                    scene%method%stepping == stepping_event .and. .not. model%tangential)
         if (.not. scene%friction%sticks()) then
            most = merge(most_bristles_coupled, most_bristles, coupled)
         else if (at_once) then
            most = merge(most_at_once_coupled, most_at_once, coupled)
         else
            most = most_apart
            if (one_way) most = most_one_way
            if (coupled) most = most_coupled
         end if
      end associate
   end function most_reduced

end module mfv_linear_solvers
