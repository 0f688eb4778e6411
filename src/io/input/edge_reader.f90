!> A contact edge by itself (shape='edge'): its parabola, and its loads given by the intensities K_N and K_T of its right edge.
module mfv_edge_reader
   use mfv_compliance, only: coupling_none
   use mfv_error, only: error_type
   use mfv_geometry, only: new_power
   use mfv_key_reader
   use mfv_kinds, only: wp
   use mfv_motions, only: motion_approach, motion_lower_bulk, motion_shift, motion_upper_bulk, control_force, control_keep
   use mfv_near_field, only: near_field_type
   use mfv_reference_edge, only: edge_contact_type
   use mfv_scene, only: last_with_target, scene_type, step_type
   use mfv_tolerances, only: rounding
   implicit none
   private
   public :: form_edge, convert_intensities

   character(*), parameter :: needs_edge = "needs a body with shape='edge'"

contains

   !> The surface of a body with shape='edge': a parabola whose curvature follows from both materials.
   subroutine form_edge(reader, scene, error)
      type(reader_type), intent(in) :: reader
      type(scene_type), intent(inout) :: scene
      type(error_type), allocatable, intent(out) :: error
      type(edge_contact_type) :: edge
      integer :: body

      body = edge_body(reader)
      if (body == 0) return
      if (reader%text_value('body', 3 - body, 'shape') /= 'half_plane') then
         call reader%complain('body', 3 - body, 'shape', "must be 'half_plane' beside a body with shape='edge'", error)
         return
      else if (scene%is_layered()) then
         call reader%complain('body', body, 'shape', "'edge' has no layers: its intensities are those of half-planes", error)
         return
      end if
      edge = edge_of(reader, scene)
      if (body == 1) scene%lower%geometry_type = new_power(0.5_wp*edge%curvature(), 2.0_wp)
      if (body == 2) scene%upper%geometry_type = new_power(0.5_wp*edge%curvature(), 2.0_wp)
   end subroutine form_edge

   !> The number of the body with shape='edge', 0 for none.
   pure integer function edge_body(reader) result(body)
      type(reader_type), intent(in) :: reader

      do body = 2, 1, -1
         if (reader%text_value('body', body, 'shape') == 'edge') return
      end do
   end function edge_body

   !> The edge contact of the scene.
   pure type(edge_contact_type) function edge_of(reader, scene) result(edge)
      type(reader_type), intent(in) :: reader
      type(scene_type), intent(in) :: scene
      type(near_field_type) :: pair
      integer :: body

      body = edge_body(reader)
      pair = scene%near_field()
      edge = edge_contact_type(reader%real_value('body', body, 'normal_intensity'), &
                               reader%real_value('body', body, 'edge_length'), pair%normal, pair%tangential)
   end function edge_of

   !> Convert intensities to forces. `normal`, `shear`: K_N and K_T of all rows of a group, not allocated if not given; `step`: its
   !> controls, and `targets`, shape (motions, rows), its other loads.
   subroutine convert_intensities(reader, group, number, scene, normal, shear, step, targets, error)
      type(reader_type), intent(in) :: reader
      character(*), intent(in) :: group
      integer, intent(in) :: number
      type(scene_type), intent(in) :: scene
      real(wp), allocatable, intent(in) :: normal(:), shear(:)
      type(step_type), intent(inout) :: step
      real(wp), intent(inout) :: targets(:, :)
      type(error_type), allocatable, intent(inout) :: error
      type(edge_contact_type) :: edge
      character(:), allocatable :: key

      if (.not. (allocated(normal) .or. allocated(shear))) return
      key = merge('normal_intensity', 'shear_intensity ', allocated(normal))
      if (edge_body(reader) == 0) then
         call complain(trim(key), needs_edge)
         return
      end if
      edge = edge_of(reader, scene)
      if (allocated(normal)) then
         if (step%control(motion_approach) /= control_keep) then
            call complain('normal_intensity', 'normal_force or approach is also given; prescribe only one of them')
         else if (any(normal < 0.0_wp)) then
            call complain('normal_intensity', 'must be at least 0 (force/length^(5/2))')
         end if
         if (allocated(error)) return
         step%control(motion_approach) = control_force
         targets(motion_approach, :) = edge%normal_force(normal)
         if (any(targets(motion_approach, :) > huge(1.0_wp))) &
            call complain('normal_intensity', 'is too large beside the normal_intensity of the body')
         if (allocated(error)) return
      end if
      if (.not. allocated(shear)) return
      if (step%control(motion_shift) /= control_keep) then
         call complain('shear_intensity', 'tangential_force, force_ratio or shift is also given; prescribe only one of them')
      else if (.not. scene%friction%acts()) then
         call complain('shear_intensity', needs_friction)
      else if (scene%coupling /= coupling_none .and. is_coupled()) then
         call complain('shear_intensity', "needs coupling='none' in &scene, or bodies of one material: else "// &
                       'pressing shears the edge, too')
      else if (control_of(motion_approach) /= control_force) then
         call complain('shear_intensity', 'needs a normal_intensity or normal_force, here or in an earlier step without cycles')
      end if
      if (allocated(error)) return
      step%control(motion_shift) = control_force
      associate (lower => scene%lower%elasticity%strain_by_bulk_stress(), upper => scene%upper%elasticity%strain_by_bulk_stress())
         targets(motion_shift, :) = edge%tangential_force(edge%intensity_of(loads_of(motion_approach)), shear, &
                                                          lower*loads_of(motion_lower_bulk) - upper*loads_of(motion_upper_bulk))
      end associate

   contains

      subroutine complain(name, why)
         character(*), intent(in) :: name, why

         if (reader%has(group, number, name)) then
            call reader%complain(group, number, name, why, error)
         else
            call reader%complain(group, number, 'file', 'column '''//name//''': '//why, error)
         end if
      end subroutine complain

      !> Whether normal and tangential displacements of the pair depend on each other.
      pure logical function is_coupled()
         type(near_field_type) :: pair

         pair = scene%near_field()
         is_coupled = pair%coupling_ratio() > rounding
      end function is_coupled

      !> The control of a motion in this group, or in the last step before it without cycles.
      pure integer function control_of(motion) result(control)
         integer, intent(in) :: motion
         integer :: last

         control = step%control(motion)
         if (control /= control_keep) return
         last = last_before(motion)
         if (last > 0) control = scene%steps(last)%control(motion)
      end function control_of

      !> Its targets, shape (rows).
      pure function loads_of(motion) result(loads)
         integer, intent(in) :: motion
         real(wp) :: loads(size(targets, 2))
         integer :: last

         loads = targets(motion, :)
         if (step%control(motion) /= control_keep) return
         last = last_before(motion)
         loads = 0.0_wp
         if (last > 0) loads = scene%steps(last)%target(motion)
      end function loads_of

      !> The last step before this group without cycles that has a target for a motion.
      pure integer function last_before(motion) result(last)
         integer, intent(in) :: motion
         integer :: steps

         steps = size(scene%steps)
         if (group == 'step') steps = number - 1
         last = last_with_target(scene%steps(:steps), motion)
      end function last_before
   end subroutine convert_intensities

end module mfv_edge_reader
