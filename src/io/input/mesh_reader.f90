!> The mesh of a case, from its text.
module mfv_mesh_reader
   use mfv_body
   use mfv_circle, only: kernel_fourier
   use mfv_contact_model, only: can_choose_mesh, choose_mesh, has_touchable_node, intervals_round, needs_equal_intervals
   use mfv_error, only: error_type
   use mfv_key_reader
   use mfv_kinds, only: pi, wp
   use mfv_motions, only: control_keep, motion_interference
   use mfv_scene, only: scene_type
   use mfv_strings, only: list_of_words, string_type, to_text
   use mfv_tolerances, only: significant
   implicit none
   private
   public :: read_mesh, read_period

   !> Most unequal intervals, whose compliance is a full matrix.
   integer, parameter :: most_graded = 5000
   !> Half the circle, degrees.
   real(wp), parameter :: half_turn = 180.0_wp

contains

   !> The mesh. It must lie under the indenter and fit the circle of a Fourier series.
   subroutine read_mesh(reader, scene, error)
      type(reader_type), intent(in) :: reader
      type(scene_type), intent(inout) :: scene
      type(error_type), allocatable, intent(out) :: error
      type(string_type), allocatable :: keys(:)
      integer, parameter :: most_carried = 1000000
      character(*), parameter :: fixed(3) = [character(10) :: 'nodes', 'half_angle', 'ends']
      integer :: i

      scene%mesh%nodes = reader%integer_value('mesh', 1, 'nodes')
      scene%mesh%half_width = reader%real_value('mesh', 1, 'half_width')
      scene%mesh%parabolic = reader%text_value('mesh', 1, 'gap') == 'parabolic'
      if (reader%has('mesh', 1, 'gap') .and. .not. (scene%lower%circular() .or. scene%upper%circular())) then
         call reader%complain('mesh', 1, 'gap', 'has no effect without a disk or hole; remove it', error)
      else if (scene%mesh%radial .and. .not. (scene%lower%circular() .and. scene%upper%circular() .and. &
                                              scene%lower%shape /= scene%upper%shape)) then
         call reader%complain('mesh', 1, 'normals', "must be 'vertical' unless a disk is in a hole", error)
      else if (scene%mesh%radial .and. .not. (scene%lower%elasticity%is_circle() .and. &
                                              scene%upper%elasticity%is_circle())) then
         call reader%complain('mesh', 1, 'normals', "must be 'vertical' unless both bodies have elasticity='own' and "// &
                              'no layers', error)
      else if (scene%mesh%radial .and. scene%mesh%parabolic) then
         call reader%complain('mesh', 1, 'normals', "must be 'vertical' with gap='parabolic'", error)
      end if
      if (allocated(error)) return
      keys = list_of_words('nodes half_width half_angle ends refine period')
      do i = 1, size(keys)
         if (.not. scene%lower%is_matrix() .or. .not. reader%has('mesh', 1, keys(i)%text)) cycle
         call reader%complain('mesh', 1, keys(i)%text, 'has no effect for a matrix, which has its own nodes; remove it', error)
         return
      end do
      if (scene%is_neat()) call check_neat(reader, scene, error)
      if (allocated(error)) return
      scene%mesh%refined = reader%text_value('mesh', 1, 'refine') == 'edges'
      scene%mesh%nodes_by_accuracy = program_chooses_nodes(reader, scene)
      if ((scene%lower%is_sampled() .or. scene%upper%is_sampled()) .and. &
          .not. any([(reader%has('mesh', 1, trim(fixed(i))), i=1, size(fixed))])) then
         scene%mesh%nodes = max(scene%mesh%nodes, scene%default_nodes())
         scene%mesh%nodes_by_patches = size(scene%steps) > 0 .and. .not. (scene%mesh%refined .or. needs_equal_intervals(scene))
      end if
      if (scene%is_neat() .and. .not. reader%has('mesh', 1, 'nodes')) scene%mesh%nodes = scene%default_nodes()
      if (scene%mesh%refined) call check_refined(reader, scene, error)
      if (.not. allocated(error) .and. reader%has('mesh', 1, 'ends')) call read_ends(reader, scene, error)
      if (.not. allocated(error) .and. reader%has('mesh', 1, 'half_angle')) call read_half_angle(reader, scene, error)
      if (allocated(error)) return
      if (scene%mesh%nodes > most_carried .and. .not. scene%mesh%whole_circle) then
         call reader%complain('mesh', 1, 'nodes', 'can be more than '//to_text(most_carried)//' only with half_angle=180', &
                              error)
         return
      end if
      if (.not. can_choose_mesh(scene) .and. max(scene%lower%wavelength, scene%upper%wavelength) > 0.0_wp) then
         call reader%complain('mesh', 1, 'period', 'is needed for a wave, or half_width', error)
      else if (.not. can_choose_mesh(scene)) then
         call reader%complain('mesh', 1, 'half_width', 'is needed: no step has a normal_force or approach to choose it from', &
                              error)
      else if (.not. has_touchable_node(scene) .and. scene%lower%is_matrix()) then
         call reader%complain('body', 1, 'file', 'no node of this body is under the indenter', error)
      else if (.not. has_touchable_node(scene)) then
         call reader%complain('mesh', 1, trim(mesh_key(reader)), 'no node of this mesh is under the indenter', error)
      end if
      if (.not. allocated(error)) call check_circle(reader, 1, scene, scene%lower, error)
      if (.not. allocated(error)) call check_circle(reader, 2, scene, scene%upper, error)
   end subroutine read_mesh

   !> Error for keys without effect in a neat fit, whose intervals cover the circle, and for wear that could make it a loose one.
   subroutine check_neat(reader, scene, error)
      type(reader_type), intent(in) :: reader
      type(scene_type), intent(in) :: scene
      type(error_type), allocatable, intent(out) :: error
      type(string_type), allocatable :: keys(:)
      integer, parameter :: fewest_around = 8
      integer :: i

      keys = list_of_words('half_width half_angle ends')
      do i = 1, size(keys)
         if (keys(i)%text == 'half_angle' .and. .not. reader%real_value('mesh', 1, 'half_angle') < half_turn) cycle
         if (reader%has('mesh', 1, keys(i)%text)) &
            call reader%complain('mesh', 1, keys(i)%text, 'has no effect in a neat fit, whose equal intervals cover the '// &
                                 'circle; remove it', error)
         if (allocated(error)) return
      end do
      if (scene%wear%acts() .and. .not. stays_pressed(scene)) &
         call reader%complain('wear', 1, 'coefficient', 'in a neat fit needs an interference in the first step, which no step '// &
                              'takes back: worn surfaces that part are no neat fit', error)
      if (allocated(error)) return
      if (reader%integer_value('mesh', 1, 'nodes') < fewest_around) &
         call reader%complain('mesh', 1, 'nodes', 'must be at least '//to_text(fewest_around)//' around a neat fit', error)
      if (allocated(error)) return
      if (reader%text_value('mesh', 1, 'refine') == 'edges') &
         call reader%complain('mesh', 1, 'refine', "must be 'none' in a neat fit, whose equal intervals cover the circle", error)
   end subroutine check_neat

   !> Whether an interference is pressed in first and never taken back.
   pure logical function stays_pressed(scene)
      type(scene_type), intent(in) :: scene
      integer :: i

      stays_pressed = size(scene%steps) > 0
      do i = 1, size(scene%steps)
         associate (step => scene%steps(i))
            if (step%control(motion_interference) == control_keep) then
               stays_pressed = stays_pressed .and. i > 1
            else
               stays_pressed = stays_pressed .and. step%target(motion_interference) > 0.0_wp
               if (allocated(step%path)) stays_pressed = stays_pressed .and. all(step%path(motion_interference, :) > 0.0_wp)
            end if
         end associate
      end do
   end function stays_pressed

   !> The period of surfaces that repeat, which loads and datums depend on. Both bodies deform like half-planes.
   subroutine read_period(reader, scene, error)
      type(reader_type), intent(in) :: reader
      type(scene_type), intent(inout) :: scene
      type(error_type), allocatable, intent(out) :: error
      type(string_type), allocatable :: others(:)
      integer :: i

      if (.not. reader%has('mesh', 1, 'period')) return
      others = list_of_words('half_width half_angle')
      do i = 1, size(others)
         if (.not. reader%has('mesh', 1, others(i)%text)) cycle
         call reader%complain('mesh', 1, others(i)%text, 'has no effect with period, which the intervals cover; '// &
                              'remove one of them', error)
         return
      end do
      if (reader%text_value('mesh', 1, 'normals') == 'radial') then
         call reader%complain('mesh', 1, 'normals', "must be 'vertical' with period", error)
      else if (scene%lower%is_matrix()) then
         call reader%complain('mesh', 1, 'period', 'has no effect for a matrix; remove it', error)
      else if (scene%lower%deforms_as_circle() .or. scene%upper%deforms_as_circle()) then
         i = merge(1, 2, scene%lower%deforms_as_circle())
         call reader%complain('body', i, 'shape', "needs elasticity='half_plane' with period in &mesh", error)
      end if
      if (allocated(error)) return
      scene%mesh%period = reader%real_value('mesh', 1, 'period')
      do i = 1, 2
         associate (wavelength => merge(scene%lower%wavelength, scene%upper%wavelength, i == 1))
            if (.not. wavelength > 0.0_wp) cycle
            if (abs(scene%mesh%period/wavelength - max(anint(scene%mesh%period/wavelength), 1.0_wp)) <= significant) cycle
            call reader%complain('mesh', 1, 'period', 'must be a whole number of wavelengths of body '//to_text(i)//', '// &
                                 to_text(wavelength), error)
            return
         end associate
      end do
      scene%lower%period = scene%mesh%period
      scene%upper%period = scene%mesh%period
      if (.not. scene%lower%rigid) scene%lower%elasticity%period = scene%mesh%period
      if (.not. scene%upper%rigid) scene%upper%elasticity%period = scene%mesh%period
   end subroutine read_period

   !> Whether the number of nodes follows from the accuracy: of equal intervals if the program also chooses their width.
   logical function program_chooses_nodes(reader, scene)
      type(reader_type), intent(in) :: reader
      type(scene_type), intent(in) :: scene
      type(string_type), allocatable :: keys(:)
      integer :: i

      keys = list_of_words('half_width half_angle ends period')
      program_chooses_nodes = .not. scene%lower%is_matrix() .and. .not. reader%has('mesh', 1, 'nodes')
      if (.not. scene%mesh%refined) program_chooses_nodes = program_chooses_nodes .and. &
                                                            .not. any([(reader%has('mesh', 1, keys(i)%text), i=1, size(keys))])
   end function program_chooses_nodes

   !> Error if a mesh cannot be refined at edges.
   subroutine check_refined(reader, scene, error)
      type(reader_type), intent(in) :: reader
      type(scene_type), intent(inout) :: scene
      type(error_type), allocatable, intent(out) :: error

      if (reader%has('mesh', 1, 'ends')) then
         call reader%complain('mesh', 1, 'refine', "must be 'none' with ends, which are the mesh already", error)
      else if (scene%mesh%nodes > most_graded) then
         call reader%complain('mesh', 1, 'nodes', 'can be at most '//to_text(most_graded)//" with refine='edges'", error)
      else if (size(scene%steps) == 0) then
         call reader%complain('mesh', 1, 'refine', "must be 'none' in a scene without steps, from which the edges are found", error)
      else
         call check_kernels(reader, 'refine', scene, error)
      end if
   end subroutine check_refined

   !> Error for bodies whose compliance needs equal intervals. `key`: asks for unequal ones.
   subroutine check_kernels(reader, key, scene, error)
      type(reader_type), intent(in) :: reader
      character(*), intent(in) :: key
      type(scene_type), intent(in) :: scene
      type(error_type), allocatable, intent(out) :: error

      if (needs_equal_intervals(scene)) &
         call reader%complain('mesh', 1, key, "needs kernel='exact'; a Fourier series needs equal intervals", error)
   end subroutine check_kernels

   !> The ends of unequal intervals.
   subroutine read_ends(reader, scene, error)
      type(reader_type), intent(in) :: reader
      type(scene_type), intent(inout) :: scene
      type(error_type), allocatable, intent(out) :: error
      type(string_type), allocatable :: others(:)
      real(wp), allocatable :: ends(:)
      real(wp) :: reach
      integer :: i, place

      others = list_of_words('nodes half_width half_angle')
      reach = merge(pi, 0.5_wp*pi, scene%mesh%radial)*scene%arc_radius()
      do i = 1, size(others)
         if (.not. reader%has('mesh', 1, others(i)%text)) cycle
         call reader%complain('mesh', 1, others(i)%text, 'has no effect with ends; remove one of them', error)
         return
      end do
      call reader%real_values('mesh', 1, 'ends', ends)
      place = findloc(ends(2:) > ends(:size(ends) - 1), .false., dim=1)
      if (size(ends) < 2) then
         call reader%complain('mesh', 1, 'ends', 'must have at least two values, the ends of one interval', error)
      else if (size(ends) - 1 > most_graded) then
         call reader%complain('mesh', 1, 'ends', 'must have at most '//to_text(most_graded + 1)//' values, not '// &
                              to_text(size(ends))//'; use equal intervals (nodes) for finer meshes', error)
      else if (place > 0) then
         call reader%complain('mesh', 1, 'ends', 'must increase; value '//to_text(place + 1)//', '// &
                              to_text(ends(place + 1))//', is not above the one before it, '//to_text(ends(place)), error)
      else if (scene%mesh%period > 0.0_wp .and. maxval(abs(ends)) > 0.5_wp*scene%mesh%period*(1.0_wp + significant)) then
         call reader%complain('mesh', 1, 'ends', 'must be within half a period, '//to_text(0.5_wp*scene%mesh%period), error)
      else if (maxval(abs(ends)) > reach .and. scene%arc_radius() > 0.0_wp) then
         call reader%complain('mesh', 1, 'ends', 'must not be beyond a '//trim(merge('half   ', 'quarter', scene%mesh%radial))// &
                              ' of the circle, '//to_text(reach), error)
      else
         call check_kernels(reader, 'ends', scene, error)
      end if
      if (allocated(error)) return
      scene%mesh%nodes = size(ends) - 1
      call move_alloc(ends, scene%mesh%ends)
   end subroutine read_ends

   subroutine read_half_angle(reader, scene, error)
      type(reader_type), intent(in) :: reader
      type(scene_type), intent(inout) :: scene
      type(error_type), allocatable, intent(out) :: error
      real(wp) :: half_angle

      half_angle = reader%real_value('mesh', 1, 'half_angle')
      if (reader%has('mesh', 1, 'half_width')) then
         call reader%complain('mesh', 1, 'half_angle', 'half_width is also given; give only one of them', error)
      else if (.not. scene%arc_radius() > 0.0_wp) then
         call reader%complain('mesh', 1, 'half_angle', 'needs an elastic disk or hole; use half_width', &
                              error)
      else
         scene%mesh%whole_circle = .not. half_angle < half_turn
         if (scene%mesh%whole_circle .and. scene%mesh%refined) &
            call reader%complain('mesh', 1, 'half_angle', "must be below 180 with refine='edges'", error)
         if (.not. scene%mesh%whole_circle) scene%mesh%half_width = scene%arc_radius()*pi*half_angle/half_turn
      end if
   end subroutine read_half_angle

   !> The key of the mesh for error messages; padded with blanks.
   pure function mesh_key(reader) result(key)
      type(reader_type), intent(in) :: reader
      character(len=10) :: key

      key = 'nodes'
      if (reader%has('mesh', 1, 'half_width')) key = 'half_width'
      if (reader%has('mesh', 1, 'half_angle')) key = 'half_angle'
      if (reader%has('mesh', 1, 'ends')) key = 'ends'
   end function mesh_key

   !> Error for a mesh longer than the circle. A Fourier series also needs a whole number of intervals on the circle, and at least
   !> half as many harmonics: with fewer, tractions that alternate from node to node would cause no displacement.
   subroutine check_circle(reader, number, scene, body, error)
      type(reader_type), intent(in) :: reader
      integer, intent(in) :: number
      type(scene_type), intent(in) :: scene
      type(body_type), intent(in) :: body
      type(error_type), allocatable, intent(out) :: error
      real(wp), parameter :: most_intervals = 5.0e7_wp
      real(wp) :: interval, intervals
      character(:), allocatable :: remedy
      integer :: nodes, fewest
      logical :: growing

      if (.not. body%deforms_as_circle()) return
      call choose_mesh(scene, nodes, interval, growing)
      intervals = intervals_round(scene, body, interval)
      if (nodes > intervals*(1.0_wp + significant)) then
         call reader%complain('mesh', 1, trim(mesh_key(reader)), &
                              'wraps around body '//to_text(number)//' more than once; reduce it', error)
      else if (body%elasticity%kernel /= kernel_fourier) then
         return
      else if (intervals > most_intervals) then
         call reader%complain('body', number, 'kernel', 'the circle would have '//to_text(intervals, 3)// &
                              ' intervals, more than '//to_text(most_intervals)//"; use kernel='exact'", error)
      else if (abs(intervals - anint(intervals)) > significant*intervals) then
         remedy = "make 180*nodes/half_angle whole, or use kernel='exact'"
         ! Nodes are on another circle.
         if (abs(body%radius - scene%arc_radius()) > significant*body%radius .and. .not. scene%mesh%radial) &
            remedy = "use kernel='exact' for this body: the mesh divides the other circle, of the radius "// &
                     to_text(scene%arc_radius())
         call reader%complain('body', number, 'kernel', 'needs a whole number of intervals around the circle of body '// &
                              to_text(number)//', not '//to_text(intervals, 10)//'; '//remedy, error)
      else if (body%elasticity%harmonics > 0) then
         fewest = (nint(intervals) + 1)/2
         if (body%elasticity%harmonics < fewest) &
            call reader%complain('body', number, 'harmonics', 'must be at least '//to_text(fewest)//', half the '// &
                                 to_text(nint(intervals))//' intervals of the circle; with fewer the compliance is singular', &
                                 error)
      end if
   end subroutine check_circle

end module mfv_mesh_reader
