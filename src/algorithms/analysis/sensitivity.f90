!> Sensitivity of a result to rounding errors: the scene is run again with all coefficients of friction times 1 + 1e-12. With
!> a stress drop the slip of one node decides whether the next one slips. Rounding errors can then select another of several
!> admissible states: such a result is chaotic, although its certificate is small.
module mfv_sensitivity
   use mfv_friction, only: friction_type
   use mfv_kinds, only: wp
   use mfv_observer, only: observer_type, relay_type
   use mfv_scene, only: scene_type
   use mfv_simulation, only: history_none, new_simulation, sensitivity_type, simulation_type, states_none
   use mfv_status, only: MFV_COMPLETE, MFV_INPUT_ERROR, status_outcome
   use mfv_zone_edges, only: find_zone_edges, zone_edges_type
   implicit none
   private
   public :: find_sensitivity

contains

   !> Run the scene of a finished simulation again with perturbed friction and record the difference of the final states in
   !> simulation%sensitivity. `observer` monitors that run and can stop it. Its message says why there is no comparison.
   subroutine find_sensitivity(simulation, observer)
      type(simulation_type), intent(inout) :: simulation
      class(observer_type), intent(inout), target, optional :: observer
      type(sensitivity_type) :: sensitivity
      type(simulation_type) :: other
      type(scene_type) :: scene
      type(relay_type) :: watch

      sensitivity%status = MFV_INPUT_ERROR
      sensitivity%message = ''
      scene = simulation%contact%model%scene
      if (simulation%outcome /= MFV_COMPLETE) then
         sensitivity%status = simulation%outcome
         sensitivity%message = 'the run did not complete'
      else if (simulation%load_summary%steps /= size(scene%steps)) then
         sensitivity%message = 'load steps were applied that are not in the case'
      else if (.not. scene%friction%acts()) then
         sensitivity%message = 'the case has no friction'
      else
         call perturb(scene%friction, sensitivity%perturbation)
         if (present(observer)) watch%caller => observer
         other = new_simulation(scene, history_none, states_none)
         call other%run(watch)
         sensitivity%status = other%outcome
         if (other%outcome == MFV_COMPLETE) then
            call compare(simulation, other, sensitivity)
         else
            sensitivity%message = 'with perturbed friction: '//status_outcome(other%outcome)
         end if
      end if
      simulation%sensitivity = sensitivity
   end subroutine find_sensitivity

   !> All coefficients times 1 + `perturbation`.
   pure subroutine perturb(friction, perturbation)
      type(friction_type), intent(inout) :: friction
      real(wp), intent(in) :: perturbation

      friction%static%value = friction%static%value*(1.0_wp + perturbation)
      friction%kinetic%value = friction%kinetic%value*(1.0_wp + perturbation)
   end subroutine perturb

   !> Differences of the final states, and of the dissipation.
   subroutine compare(one, other, sensitivity)
      type(simulation_type), intent(in) :: one, other
      type(sensitivity_type), intent(inout) :: sensitivity
      type(zone_edges_type) :: edges(2)
      real(wp) :: scale

      scale = one%contact%certificate%traction_scale
      associate (a => one%contact%state, b => other%contact%state)
         if (size(a%status) /= size(b%status)) then
            sensitivity%message = 'with perturbed friction the mesh grows to another length'
            return
         end if
         sensitivity%pressure = maxval(abs(b%fields%pressure - a%fields%pressure))/scale
         sensitivity%shear = maxval(abs(b%fields%shear - a%fields%shear))/scale
         sensitivity%dissipation = abs(b%dissipation - a%dissipation)
         if (a%dissipation > 0.0_wp) sensitivity%dissipation = sensitivity%dissipation/a%dissipation
         call find_zone_edges(one%contact%model, a, edges(1))
         call find_zone_edges(other%contact%model, b, edges(2))
         sensitivity%stick_ratio = abs(edges(2)%stick_ratio() - edges(1)%stick_ratio())
      end associate
   end subroutine compare

end module mfv_sensitivity
