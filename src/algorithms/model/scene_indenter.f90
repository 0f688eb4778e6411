!> The gap of a scene in terms of closed forms, and the contact that they expect.
module mfv_scene_indenter
   use mfv_body, only: body_type
   use mfv_geometry, only: shape_flat_punch, shape_half_plane, shape_matrix, shape_power, shape_profile, &
                           shape_rounded_punch, shape_wave, shape_wedge
   use mfv_kinds, only: wp
   use mfv_near_field, only: near_field_type
   use mfv_motions, only: motion_approach, motion_interference, control_force, control_displacement
   use mfv_reference_indenter, only: flat_indenter, indenter_type, power_indenter, rounded_punch_indenter
   use mfv_scene, only: scene_type
   implicit none
   private
   public :: indenter_of, touches_everywhere, largest_half_width, default_datum

contains

   !> The gap of both bodies, with circles as parabolas and flat punches as half-planes; flat for bodies without a closed form.
   pure function indenter_of(scene) result(indenter)
      type(scene_type), intent(in) :: scene
      type(indenter_type) :: indenter

      indenter = flat_indenter()
      if (.not. (has_form(scene%lower) .and. has_form(scene%upper))) return
      if (scene%curvature() > 0.0_wp) call indenter%add(power_indenter(0.5_wp*scene%curvature(), 2.0_wp))
      call add_body(indenter, scene%lower)
      call add_body(indenter, scene%upper)
   end function indenter_of

   !> Whether the surfaces touch everywhere: neither body has an edge, a curvature or another shape.
   pure logical function touches_everywhere(scene)
      type(scene_type), intent(in) :: scene
      type(indenter_type) :: indenter
      integer :: shapes(2)

      shapes = [scene%lower%shape, scene%upper%shape]
      indenter = indenter_of(scene)
      touches_everywhere = indenter%is_flat() .and. .not. scene%curvature() > 0.0_wp .and. &
                           .not. any(shapes == shape_flat_punch .or. shapes == shape_profile .or. shapes == shape_matrix .or. &
                                     shapes == shape_wave)
   end function touches_everywhere

   !> Whether there are closed forms for the shape of a body.
   pure logical function has_form(body)
      type(body_type), intent(in) :: body

      has_form = body%circular() .or. &
                 any(body%shape == [shape_half_plane, shape_flat_punch, shape_rounded_punch, shape_power, shape_wedge])
   end function has_form

   pure subroutine add_body(indenter, body)
      type(indenter_type), intent(inout) :: indenter
      type(body_type), intent(in) :: body

      if (any(body%shape == [shape_power, shape_wedge])) &
         call indenter%add(power_indenter(body%coefficient, body%exponent))
      if (body%shape == shape_rounded_punch) call indenter%add(rounded_punch_indenter(body%flat_half_width, body%radius))
   end subroutine add_body

   !> The largest contact half-width, length, that the closed form expects for the targets of the scene, for approaches of at most
   !> `most` (length); 0 without a closed form or a target that presses.
   pure real(wp) function largest_half_width(scene, most) result(largest)
      type(scene_type), intent(in) :: scene
      real(wp), intent(in) :: most
      type(indenter_type) :: indenter
      real(wp) :: approach

      largest = half_width_of_forces(scene)
      indenter = indenter_of(scene)
      ! An interference presses as an approach does.
      approach = max(maxval(scene%steps%extreme(motion_approach, control_displacement)), 0.0_wp) &
                 + max(maxval(scene%steps%extreme(motion_interference, control_displacement)), 0.0_wp)
      if (approach > 0.0_wp .and. .not. indenter%is_flat() .and. scene%modulus() > 0.0_wp) &
         largest = max(largest, indenter%half_width_at_approach(approach, scene%datum(), most))
   end function largest_half_width

   !> The largest half-width for the normal forces only.
   pure real(wp) function half_width_of_forces(scene) result(half_width)
      type(scene_type), intent(in) :: scene
      type(indenter_type) :: indenter
      real(wp) :: force
      integer, parameter :: most_iterations = 20
      type(near_field_type) :: over_width
      integer :: i

      half_width = 0.0_wp
      indenter = indenter_of(scene)
      force = maxval(scene%steps%extreme(motion_approach, control_force))
      if (force > 0.0_wp .and. .not. indenter%is_flat() .and. scene%modulus() > 0.0_wp) &
         half_width = indenter%half_width(0.5_wp*force/scene%modulus())
      if (.not. half_width > 0.0_wp) return
      ! The modulus is that over the half-width.
      do i = 1, most_iterations
         over_width = scene%near_field_over(half_width)
         if (abs(over_width%modulus() - scene%modulus()) <= 0.0_wp) exit
         half_width = (half_width**2*indenter%half_width(0.5_wp*force/over_width%modulus()))**(1.0_wp/3.0_wp)
      end do
   end function half_width_of_forces

   !> Default distance from the contact at which the displacements of a body are measured, length: the radius of a circle, in a neat
   !> fit its diameter; else the smaller length of both shapes; else the contact half-width that the closed form expects for the
   !> normal forces; else 0.
   !> `of_case`: whether the shapes have no length, so that it depends on the loads of this case.
   pure subroutine default_datum(scene, body, other, datum, of_case)
      type(scene_type), intent(in) :: scene
      type(body_type), intent(in) :: body, other
      real(wp), intent(out) :: datum
      logical, intent(out) :: of_case

      datum = merge(body%radius, min(body%size_of_shape(), other%size_of_shape()), body%circular())
      if (scene%is_neat()) datum = 2.0_wp*body%radius
      of_case = .not. datum < huge(1.0_wp)
      if (of_case) datum = half_width_of_forces(scene)
   end subroutine default_datum

end module mfv_scene_indenter
