!> The mesh of a case, from its text.
module mfv_mesh_reader
   use mfv_body
   use mfv_circle, only: kernel_fourier
   use mfv_contact_model, only: can_choose_mesh, choose_mesh, has_touchable_node, intervals_round
   use mfv_error, only: error_type
   use mfv_key_reader
   use mfv_kinds, only: pi, wp
   use mfv_scene, only: scene_type
   use mfv_strings, only: list_of_words, string_type, to_text
   implicit none
   private
   public :: read_mesh

contains

   !> The mesh. It must lie under the indenter and fit the circle of a Fourier series.
   subroutine read_mesh(reader, scene, error)
      type(reader_type), intent(in) :: reader
      type(scene_type), intent(inout) :: scene
      type(error_type), allocatable, intent(out) :: error
      type(string_type), allocatable :: keys(:)
      integer, parameter :: most_carried = 1000000
      integer :: i

      scene%mesh%nodes = reader%integer_value('mesh', 1, 'nodes')
      scene%mesh%half_width = reader%real_value('mesh', 1, 'half_width')
      scene%mesh%parabolic = reader%text_value('mesh', 1, 'gap') == 'parabolic'
      scene%mesh%radial = reader%text_value('mesh', 1, 'normals') == 'radial'
      if (reader%has('mesh', 1, 'gap') .and. .not. (scene%lower%circular() .or. scene%upper%circular())) then
         call reader%complain('mesh', 1, 'gap', 'has no effect without a disk or hole; remove it', error)
      else if (scene%mesh%radial .and. .not. (scene%lower%circular() .and. scene%upper%circular() .and. &
                                              scene%lower%shape /= scene%upper%shape)) then
         call reader%complain('mesh', 1, 'normals', "must be 'vertical' unless a disk is in a hole", error)
      else if (scene%mesh%radial .and. scene%mesh%parabolic) then
         call reader%complain('mesh', 1, 'normals', "must be 'vertical' with gap='parabolic'", error)
      end if
      if (allocated(error)) return
      keys = list_of_words('nodes half_width half_angle')
      do i = 1, size(keys)
         if (scene%lower%shape /= shape_matrix .or. .not. reader%has('mesh', 1, keys(i)%text)) cycle
         call reader%complain('mesh', 1, keys(i)%text, 'has no effect for a matrix, which has its own nodes; remove it', error)
         return
      end do
      if (reader%has('mesh', 1, 'half_angle')) call read_half_angle(reader, scene, error)
      if (allocated(error)) return
      if (scene%mesh%nodes > most_carried .and. .not. scene%mesh%whole_circle) then
         call reader%complain('mesh', 1, 'nodes', 'can be more than '//to_text(most_carried)//' only with half_angle=180', &
                              error)
         return
      end if
      if (.not. can_choose_mesh(scene)) then
         call reader%complain('mesh', 1, 'half_width', 'is needed: no step has a normal_force or approach to choose it from', &
                              error)
      else if (.not. has_touchable_node(scene) .and. scene%lower%shape == shape_matrix) then
         call reader%complain('body', 1, 'file', 'no node of this body is under the indenter', error)
      else if (.not. has_touchable_node(scene)) then
         call reader%complain('mesh', 1, trim(mesh_key(reader)), 'no node of this mesh is under the indenter', error)
      end if
      if (.not. allocated(error)) call check_circle(reader, 1, scene, scene%lower, error)
      if (.not. allocated(error)) call check_circle(reader, 2, scene, scene%upper, error)
   end subroutine read_mesh

   subroutine read_half_angle(reader, scene, error)
      type(reader_type), intent(in) :: reader
      type(scene_type), intent(inout) :: scene
      type(error_type), allocatable, intent(out) :: error
      real(wp), parameter :: half_turn = 180.0_wp
      real(wp) :: half_angle

      half_angle = reader%real_value('mesh', 1, 'half_angle')
      if (reader%has('mesh', 1, 'half_width')) then
         call reader%complain('mesh', 1, 'half_angle', 'half_width is also given; give only one of them', error)
      else if (.not. scene%arc_radius() > 0.0_wp) then
         call reader%complain('mesh', 1, 'half_angle', 'needs an elastic disk or hole; use half_width', &
                              error)
      else
         scene%mesh%whole_circle = .not. half_angle < half_turn
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
   end function mesh_key

   !> Error for a mesh longer than the circle. A Fourier series also needs a whole number of intervals on the circle, and at least
   !> half as many harmonics: with fewer, tractions that alternate from node to node would cause no displacement.
   subroutine check_circle(reader, number, scene, body, error)
      type(reader_type), intent(in) :: reader
      integer, intent(in) :: number
      type(scene_type), intent(in) :: scene
      type(body_type), intent(in) :: body
      type(error_type), allocatable, intent(out) :: error
      real(wp), parameter :: whole = 1.0e-9_wp, most_intervals = 5.0e7_wp
      real(wp) :: interval, intervals
      integer :: nodes, fewest
      logical :: growing

      if (body%rigid .or. .not. body%circular()) return
      call choose_mesh(scene, nodes, interval, growing)
      intervals = intervals_round(scene, body, interval)
      if (nodes > intervals*(1.0_wp + whole)) then
         call reader%complain('mesh', 1, trim(mesh_key(reader)), &
                              'wraps around body '//to_text(number)//' more than once; reduce it', error)
      else if (body%kernel == kernel_fourier .and. intervals > most_intervals) then
         call reader%complain('body', number, 'kernel', 'the circle would have '//to_text(intervals, 3)// &
                              ' intervals, more than '//to_text(most_intervals)//"; use kernel='exact'", error)
      else if (body%kernel == kernel_fourier .and. abs(intervals - anint(intervals)) > whole*intervals) then
         call reader%complain('body', number, 'kernel', 'needs a whole number of intervals around the circle, not '// &
                              to_text(intervals, 10)//"; make 180*nodes/half_angle whole, or use kernel='exact'", error)
      else if (body%kernel == kernel_fourier .and. body%harmonics > 0) then
         fewest = (nint(intervals) + 1)/2
         if (body%harmonics < fewest) &
            call reader%complain('body', number, 'harmonics', 'must be at least '//to_text(fewest)//', half the '// &
                                 to_text(nint(intervals))//' intervals of the circle; with fewer the compliance is singular', &
                                 error)
      end if
   end subroutine check_circle

end module mfv_mesh_reader
