!> Summary of the steps taken, for closed forms; its size does not depend on their number.
module mfv_load_summary
   use mfv_kinds, only: wp
   use mfv_motions, only: motion_count, motion_approach, motion_shift, control_keep, control_force, control_displacement
   use mfv_scene, only: step_type
   implicit none
   private
   public :: load_summary_type

   type :: load_summary_type
      !> Steps taken, the last one perhaps not to its end.
      integer :: steps = 0
      !> Which motions any step controlled, and whether any had cycles.
      logical :: controlled(motion_count) = .false., cycled = .false.
      !> Whether only increasing normal forces were applied, with friction from the start.
      logical :: pressed_harder = .true.
      !> Whether the bodies were pressed without a tangential force, then sheared under force control with friction; whether shear
      !> has begun; whether friction acted before.
      logical :: pressed_then_sheared = .true., sheared = .false., friction_in_press = .false.
      !> Last target of the normal force, force/length.
      real(wp), private :: normal_target = 0.0_wp
   contains
      procedure :: add
   end type load_summary_type

contains

   !> Add a step.
   pure subroutine add(self, step)
      class(load_summary_type), intent(inout) :: self
      type(step_type), intent(in) :: step

      self%steps = self%steps + 1
      self%controlled = self%controlled .or. step%control /= control_keep
      self%cycled = self%cycled .or. step%cycles > 0
      self%pressed_harder = self%pressed_harder .and. step%friction .and. step%cycles == 0 &
                            .and. step%control(motion_approach) == control_force &
                            .and. step%target(motion_approach) >= self%normal_target &
                            .and. .not. abs(step%target(motion_shift)) > 0.0_wp
      self%normal_target = step%target(motion_approach)
      self%sheared = self%sheared .or. abs(step%target(motion_shift)) > 0.0_wp
      if (self%sheared) then
         self%pressed_then_sheared = self%pressed_then_sheared .and. step%friction &
                                     .and. step%control(motion_approach) == control_keep &
                                     .and. step%control(motion_shift) == control_force
      else
         self%pressed_then_sheared = self%pressed_then_sheared .and. step%control(motion_shift) /= control_displacement
         self%friction_in_press = self%friction_in_press .or. step%friction
      end if
   end subroutine add

end module mfv_load_summary
