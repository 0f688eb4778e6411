!> The steps of a case, from its text, and what they have in common with a load history (mfv_history_reader).
module mfv_step_reader
   use mfv_edge_reader, only: convert_intensities
   use mfv_error, only: error_type
   use mfv_key_reader
   use mfv_kinds, only: wp
   use mfv_motions, only: motions, motion_count, motion_approach, motion_shift, motion_upper_bulk, motion_interference, &
                          control_keep, control_force, control_displacement, controlled_key, &
                          first_control
   use mfv_scene, only: last_with_target, scene_type, step_type
   use mfv_strings, only: to_text
   implicit none
   private
   public :: check_held, check_motion, read_steady_tolerance, read_steps

contains

   !> The steps of the load history.
   subroutine read_steps(reader, scene, error)
      type(reader_type), intent(in) :: reader
      type(scene_type), intent(inout) :: scene
      type(error_type), allocatable, intent(out) :: error
      integer :: i, j

      if (count_groups(reader, 'step') + count_groups(reader, 'history') == 0 .and. .not. reader%without_steps) then
         call fail(reader, 0, '&step: at least one step is needed', error)
         return
      end if
      allocate (scene%steps(count_groups(reader, 'step')))
      do i = 1, size(scene%steps)
         associate (step => scene%steps(i))
            do j = 1, motion_count
               call read_target(reader, i, j, step%control(j), step%target(j), error)
               if (step%control(j) /= control_keep .and. .not. allocated(error)) &
                  call check_motion(reader, 'step', i, j, trim(controlled_key(j, step%control(j))), scene, error)
               if (scene%cannot_be_negative(j, step%control(j)) .and. step%target(j) < 0.0_wp) &
                  call reader%complain('step', i, trim(controlled_key(j, step%control(j))), 'must be a number at least 0 ('// &
                                       trim(motions(j)%force_unit)//')', error)
               if (j == motion_shift .and. .not. allocated(error)) call read_force_ratio(reader, i, scene, error)
               if (allocated(error)) return
            end do
            call read_intensities(reader, i, scene, error)
            if (allocated(error)) return
            step%friction = reader%logical_value('step', i, 'friction')
            step%cycles = reader%integer_value('step', i, 'cycles')
            call read_steady_tolerance(reader, 'step', i, step, error)
            if (allocated(error)) return
            if (all(step%control == control_keep)) then
               call fail(reader, line_of(reader, 'step', i), '&step '//to_text(i)//': needs a target: normal_force or '// &
                         'approach, tangential_force, force_ratio or shift, moment or rotation, lower_bulk_stress, '// &
                         'upper_bulk_stress, interference; with shape=''edge'' normal_intensity, shear_intensity', error)
               return
            end if
         end associate
      end do
   end subroutine read_steps

   !> The tangential target of step `number` as a fraction of the sliding limit mu P. The normal targets up to this step are known.
   subroutine read_force_ratio(reader, number, scene, error)
      type(reader_type), intent(in) :: reader
      integer, intent(in) :: number
      type(scene_type), intent(inout) :: scene
      type(error_type), allocatable, intent(inout) :: error
      integer :: last

      if (.not. reader%has('step', number, 'force_ratio')) return
      ! The cycles of this step are read later.
      last = last_with_target(scene%steps(:number), motion_approach)
      if (scene%steps(number)%control(motion_shift) /= control_keep) then
         call reader%complain('step', number, 'force_ratio', 'tangential_force or shift is also given; prescribe only one '// &
                              'of them', error)
      else if (.not. scene%friction%acts()) then
         call reader%complain('step', number, 'force_ratio', needs_friction, error)
      else if (.not. reader%logical_value('step', number, 'friction')) then
         call reader%complain('step', number, 'force_ratio', 'has no effect in a step without friction; remove it', error)
      else if (last == 0) then
         call reader%complain('step', number, 'force_ratio', 'needs a normal_force, in this step or in an earlier one '// &
                              'without cycles', error)
      else if (scene%steps(last)%control(motion_approach) /= control_force) then
         call reader%complain('step', number, 'force_ratio', 'needs a normal_force, but step '//to_text(last)// &
                              ' prescribes an approach', error)
      else
         scene%steps(number)%control(motion_shift) = control_force
         scene%steps(number)%target(motion_shift) = reader%real_value('step', number, 'force_ratio') &
                                                    *scene%friction%static%largest()*scene%steps(last)%target(motion_approach)
      end if
   end subroutine read_force_ratio

   !> Forces of step `number` by the intensities of an edge.
   subroutine read_intensities(reader, number, scene, error)
      type(reader_type), intent(in) :: reader
      integer, intent(in) :: number
      type(scene_type), intent(inout) :: scene
      type(error_type), allocatable, intent(inout) :: error
      real(wp), allocatable :: normal(:), shear(:)
      real(wp) :: targets(motion_count, 1)
      type(step_type) :: step

      if (reader%has('step', number, 'normal_intensity')) normal = [reader%real_value('step', number, 'normal_intensity')]
      if (reader%has('step', number, 'shear_intensity')) shear = [reader%real_value('step', number, 'shear_intensity')]
      step = scene%steps(number)
      targets(:, 1) = step%target
      call convert_intensities(reader, 'step', number, scene, normal, shear, step, targets, error)
      scene%steps(number)%control = step%control
      scene%steps(number)%target = targets(:, 1)
   end subroutine read_intensities

   !> The target of one motion of step `number`: a force or a displacement.
   subroutine read_target(reader, number, motion, control, target, error)
      type(reader_type), intent(in) :: reader
      integer, intent(in) :: number, motion
      integer, intent(out) :: control
      real(wp), intent(out) :: target
      type(error_type), allocatable, intent(out) :: error
      integer :: i

      control = control_keep
      target = 0.0_wp
      do i = first_control(motion), control_displacement
         if (.not. reader%has('step', number, trim(controlled_key(motion, i)))) cycle
         if (control /= control_keep) then
            call reader%complain('step', number, trim(motions(motion)%key), trim(motions(motion)%force_key)// &
                                 ' is also given; prescribe only one of '//trim(motions(motion)%force_key)//' and '// &
                                 trim(motions(motion)%key), error)
            return
         end if
         control = i
         target = reader%real_value('step', number, trim(controlled_key(motion, i)))
      end do
   end subroutine read_target

   !> Error for a `motion`, by a key of a group, that the scene does not have: a bulk stress in a body that does not deform like a
   !> half-plane, a rotation or a bulk stress of surfaces that repeat.
   subroutine check_motion(reader, group, number, motion, key, scene, error)
      type(reader_type), intent(in) :: reader
      character(*), intent(in) :: group, key
      integer, intent(in) :: number, motion
      type(scene_type), intent(in) :: scene
      type(error_type), allocatable, intent(out) :: error
      character(:), allocatable :: kind
      integer :: body
      logical :: upper

      if (.not. scene%can_repeat(motion)) then
         call reader%complain(group, number, key, 'has no effect that repeats with the period in &mesh; remove one of them', error)
         return
      end if
      if (motion == motion_interference .and. .not. scene%can_interfere()) then
         call reader%complain(group, number, key, 'needs a disk and a hole of one radius, not of '// &
                              to_text(scene%lower%radius, 12)//' and '//to_text(scene%upper%radius, 12)// &
                              ': the interference is by how much the pin is larger', error)
         return
      end if
      upper = motion == motion_upper_bulk
      if (.not. motions(motion)%is_stress .or. scene%can_have_bulk_stress(upper)) return
      body = merge(2, 1, upper)
      kind = reader%text_value('body', body, 'shape')
      if (reader%logical_value('body', body, 'rigid')) kind = 'rigid '//kind
      if (scene%has_layers(upper)) kind = kind//' with layers, which it does not stretch'
      call reader%complain(group, number, key, 'the '//merge('upper', 'lower', upper)//' body is a '// &
                           kind//'; a bulk stress needs an elastic half_plane, wedge, power, rounded_punch or profile', error)
   end subroutine check_motion

   !> Error for an interference with vertical normals in a case that does not prescribe the approach: at a given normal force the
   !> upper body would only be lifted.
   subroutine check_held(reader, scene, error)
      type(reader_type), intent(in) :: reader
      type(scene_type), intent(in) :: scene
      type(error_type), allocatable, intent(out) :: error
      integer :: i, control

      control = control_force
      do i = 1, size(scene%steps)
         if (scene%steps(i)%control(motion_approach) /= control_keep) control = scene%steps(i)%control(motion_approach)
         if (scene%holds_for_interference(control) .or. scene%steps(i)%control(motion_interference) == control_keep) cycle
         call reader%complain(merge('history', 'step   ', scene%steps(i)%row > 0), merge(1, i, scene%steps(i)%row > 0), &
                              'interference', 'needs a prescribed approach, which holds the upper body in its place, such as '// &
                              'approach=0.0; at a given normal_force it would only be lifted', error)
         return
      end do
   end subroutine check_held

   !> The tolerance of a step with cycles, from its key in a group. Error for one without effect.
   subroutine read_steady_tolerance(reader, group, number, step, error)
      type(reader_type), intent(in) :: reader
      character(*), intent(in) :: group
      integer, intent(in) :: number
      type(step_type), intent(inout) :: step
      type(error_type), allocatable, intent(out) :: error

      if (.not. reader%has(group, number, 'steady_tolerance')) return
      step%steady_tolerance = reader%real_value(group, number, 'steady_tolerance')
      if (step%cycles < 2) call reader%complain(group, number, 'steady_tolerance', 'has no effect without cycles of 2 or more; '// &
                                                'remove it', error)
   end subroutine read_steady_tolerance

end module mfv_step_reader
