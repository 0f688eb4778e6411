!> Where the model stops holding: warnings that go with a result.
module mfv_validity
   use mfv_body, only: body_type, shape_matrix
   use mfv_contact_model, only: along_rotation
   use mfv_contact_state, only: contact_state_type
   use mfv_interior, only: interior_type, largest_type
   use mfv_kinds, only: pi, wp
   use mfv_node_status, only: in_contact
   use mfv_simulation, only: simulation_type
   use mfv_strings, only: add_text, string_type, to_text
   implicit none
   private
   public :: validity_warnings

   !> Normals are vertical at every node: at this angle from the pole, degrees, that is wrong by 1.5 % (1 - cos) in the
   !> normal and by 17 % (sin) in the tangential component.
   real(wp), parameter :: largest_angle = 10.0_wp

contains

   !> Warnings about a simulation, none as a rule: few nodes in contact; contact at angles for which vertical normals are a
   !> poor approximation; stresses beyond a yield strength that the user gave (the largest von Mises stress by refinement);
   !> large rotations; lost digits.
   subroutine validity_warnings(simulation, warnings)
      type(simulation_type), intent(in) :: simulation
      type(string_type), allocatable, intent(out) :: warnings(:)

      allocate (warnings(0))
      associate (scene => simulation%contact%model%scene)
         call check_angle(simulation, 'lower', scene%lower, warnings)
         call check_angle(simulation, 'upper', scene%upper, warnings)
         call check_yield(simulation, .false., scene%lower, warnings)
         call check_yield(simulation, .true., scene%upper, warnings)
      end associate
      call check_resolution(simulation, warnings)
      call check_order(simulation%contact%model%scene%lower, warnings)
      call check_rotation(simulation, warnings)
      call check_certificate(simulation, warnings)
   end subroutine validity_warnings

   subroutine check_angle(simulation, name, body, warnings)
      type(simulation_type), intent(in) :: simulation
      character(*), intent(in) :: name
      type(body_type), intent(in) :: body
      type(string_type), allocatable, intent(inout) :: warnings(:)
      real(wp) :: angle

      if (body%rigid .or. .not. body%circular() .or. simulation%contact%model%scene%mesh%radial) return
      if (simulation%contact%state%contact_nodes() == 0) return
      associate (model => simulation%contact%model)
         angle = maxval(abs(model%arc), mask=in_contact(simulation%contact%state%status))/body%radius*180.0_wp/pi
      end associate
      if (.not. angle > largest_angle) return
      call add_text(warnings, 'the contact reaches '//to_text(angle, 3)//' degrees from the pole of the '//name// &
                    ' body; normals are taken as vertical, which is a poor approximation beyond '// &
                    to_text(largest_angle, 2))
   end subroutine check_angle

   !> Nodes opposite each other stay so: a body that has rolled along has left them.
   subroutine check_rotation(simulation, warnings)
      type(simulation_type), intent(in) :: simulation
      type(string_type), allocatable, intent(inout) :: warnings(:)
      real(wp) :: rolled, half_width

      associate (model => simulation%contact%model, state => simulation%contact%state)
         if (.not. model%rotational .or. state%contact_nodes() == 0) return
         rolled = abs(state%fields%rotation)*maxval(abs(model%tangential_arm(:, along_rotation)))
         half_width = 0.5_wp*sum(model%width, mask=in_contact(state%status))
      end associate
      if (rolled > half_width) &
         call add_text(warnings, 'the upper body has turned by more than the contact half-width along its surface: rotations '// &
                       'must be small')
   end subroutine check_rotation

   !> Half-width and stick ratio come in whole nodes.
   subroutine check_resolution(simulation, warnings)
      type(simulation_type), intent(in) :: simulation
      type(string_type), allocatable, intent(inout) :: warnings(:)
      integer, parameter :: fewest = 10

      associate (contact => simulation%contact%state%contact_nodes())
         if (contact > 0 .and. contact < fewest) &
            call add_text(warnings, 'only '//to_text(contact)//' nodes are in contact: the mesh is too coarse')
      end associate
   end subroutine check_resolution

   !> A user's matrix whose rows come node by node, not normal components first: almost every node then moves its neighbour in
   !> the matrix, which is its own other component, less than the one after that.
   subroutine check_order(body, warnings)
      type(body_type), intent(in) :: body
      type(string_type), allocatable, intent(inout) :: warnings(:)
      real(wp), parameter :: almost_every = 0.8_wp
      integer :: i, n

      if (body%shape /= shape_matrix) return
      n = size(body%position) - 2
      if (count([(body%matrix(i, i + 1) < body%matrix(i, i + 2), i=1, n)]) > almost_every*n .and. n > 1) &
         call add_text(warnings, 'in the matrix neighbours move each other less than nodes further apart: do its rows and '// &
                       'columns have all normal components first, then the tangential ones?')
   end subroutine check_order

   !> A result that has lost digits.
   subroutine check_certificate(simulation, warnings)
      type(simulation_type), intent(in) :: simulation
      type(string_type), allocatable, intent(inout) :: warnings(:)
      real(wp), parameter :: good = 1.0e-8_wp

      associate (largest => simulation%contact%certificate%largest())
         if (largest > good) call add_text(warnings, 'the certificate, '//to_text(largest, 2)// &
                                           ', is far from round-off: digits have been lost')
      end associate
   end subroutine check_certificate

   !> The last state, and of those at the ends of steps the ones with the largest normal force and the largest tangential
   !> forces to either side.
   subroutine check_yield(simulation, upper, body, warnings)
      type(simulation_type), intent(in) :: simulation
      logical, intent(in) :: upper
      type(body_type), intent(in) :: body
      type(string_type), allocatable, intent(inout) :: warnings(:)
      type(largest_type) :: largest, other
      character(:), allocatable :: where_it_is
      integer :: candidates(3), i, n

      if (.not. body%yield_strength > 0.0_wp) return
      largest = largest_below(simulation, upper, simulation%contact%state)
      where_it_is = 'in the last state'
      n = simulation%snapshot_count
      candidates = 0
      if (n > 1) candidates = [maxloc([(simulation%snapshots(i)%state%fields%normal_force, i=1, n)]), &
                               maxloc([(simulation%snapshots(i)%state%fields%tangential_force, i=1, n)]), &
                               minloc([(simulation%snapshots(i)%state%fields%tangential_force, i=1, n)])]
      do i = 1, size(candidates)
         if (candidates(i) == 0 .or. candidates(i) == n) cycle
         other = largest_below(simulation, upper, simulation%padded_state(candidates(i)))
         if (.not. other%value > largest%value) cycle
         largest = other
         where_it_is = 'in steps/'//to_text(candidates(i))
      end do
      if (largest%value > body%yield_strength) &
         call add_text(warnings, 'the largest von Mises stress of the '//merge('upper', 'lower', upper)//' body, '// &
                       to_text(largest%value, 4)//' '//where_it_is//', is beyond its yield_strength '// &
                       to_text(body%yield_strength)//': elasticity no longer holds')
   end subroutine check_yield

   !> The largest von Mises stress of a body in a state; zero for a body without an inside.
   function largest_below(simulation, upper, state) result(largest)
      type(simulation_type), intent(in) :: simulation
      logical, intent(in) :: upper
      type(contact_state_type), intent(in) :: state
      type(largest_type) :: largest
      type(interior_type) :: interior
      logical :: available

      associate (model => simulation%contact%model)
         call model%scene%interior(upper, model%arc, model%width, state%fields%pressure, state%fields%shear, interior, &
                                   available)
      end associate
      if (available) largest = interior%largest_von_mises()
   end function largest_below

end module mfv_validity
