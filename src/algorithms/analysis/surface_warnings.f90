!> Warnings about the undeformed surfaces in contact: ends, shape between the points of a profile, slope.
module mfv_surface_warnings
   use mfv_body, only: body_type
   use mfv_geometry, only: interpolation_cubic, interpolation_linear
   use mfv_contact_state, only: contact_state_type
   use mfv_kinds, only: pi, wp
   use mfv_motions, only: motion_approach
   use mfv_node_status, only: in_contact
   use mfv_profile_sampling, only: negligible_pressure, pressure_of_wave
   use mfv_simulation, only: simulation_type
   use mfv_strings, only: add_text, string_type, to_text
   use mfv_tolerances, only: significant
   implicit none
   private
   public :: warn_of_surface

contains

   !> Add warnings about the surface of the lower or `upper` body of a simulation; `largest_angle`: largest angle of flanks,
   !> degrees, for which half-planes are a good approximation.
   subroutine warn_of_surface(simulation, upper, body, largest_angle, warnings)
      type(simulation_type), intent(in) :: simulation
      logical, intent(in) :: upper
      type(body_type), intent(in) :: body
      real(wp), intent(in) :: largest_angle
      type(string_type), allocatable, intent(inout) :: warnings(:)
      character(len=5) :: name
      logical, allocatable :: contact(:)
      real(wp) :: angle

      name = merge('upper', 'lower', upper)
      contact = touched(simulation)
      if (.not. any(contact)) return
      call check_end
      if (body%is_sampled()) call check_interpolation
      if (body%is_sampled() .and. body%period > 0.0_wp) call check_step
      if (body%dropouts > 0) call warn_of_dropouts
      if (.not. body%is_pointed()) return
      angle = atan(body%coefficient)*180.0_wp/pi
      if (angle > largest_angle) call add_text(warnings, 'the flanks of the '//name//' body rise by '//to_text(angle, 3)// &
                                               ' degrees; the half-plane compliance is inaccurate beyond '// &
                                               to_text(largest_angle, 2)//' degrees')

   contains

      !> A profile that does not repeat, from one end of the period to the other.
      subroutine check_step()
         real(wp), parameter :: visible_step = 0.01_wp
         real(wp) :: ends(2), heights(2)

         ends = 0.5_wp*body%period*[-1, 1]
         if (.not. all(body%has_surface(ends))) return
         heights = body%recess(ends, .false.)
         if (abs(heights(2) - heights(1)) <= visible_step*(maxval(body%height) - minval(body%height))) return
         call add_text(warnings, 'the heights of the profile of the '//name//' body differ by '// &
                       to_text(abs(heights(2) - heights(1)), 3)//' at the ends of the period: it has a step there, and '// &
                       'tractions in contact with it are those at a sharp corner')
      end subroutine check_step

      !> Points of a measurement without a value are not in its profile.
      subroutine warn_of_dropouts()
         integer :: n

         n = size(body%position)
         call add_text(warnings, to_text(body%dropouts)//' of '//to_text(n + body%dropouts)//' points of the profile of the '// &
                       name//' body have no value and are omitted; its points are now up to '// &
                       to_text(maxval(body%position(2:) - body%position(:n - 1)), 3)//' apart: check that what is missing '// &
                       'does not touch')
      end subroutine warn_of_dropouts

      !> A contact cannot grow beyond the end of a surface. A flat punch has corners by design; an interval should end there.
      subroutine check_end()
         integer :: i, side

         do side = -1, 1, 2
            do i = 1, size(contact)
               if (.not. contact(i)) cycle
               if (any(contact(max(i + side, 1):min(i + side, size(contact))))) cycle
               if (.not. ends_at(i, side) .or. simulation%contact%model%repeats_beyond(i, side)) cycle
               if (body%has_sharp_ends()) then
                  if (.not. misses_corner(i, side)) cycle
                  call add_text(warnings, 'no interval of the mesh ends at the corner of the '//name//' body, x = '// &
                                to_text(corner(side))//': the contact ends at x = '//to_text(end_of(i, side), 4)// &
                                ' instead; choose &mesh half_width and nodes accordingly, or omit half_width')
               else
                  call add_text(warnings, 'the contact reaches the end of the surface of the '//name//' body, near x = '// &
                                to_text(simulation%contact%model%x(i), 4)//' and cannot grow beyond it: tractions and '// &
                                'stresses there are those at a sharp corner; extend the surface unless the corner is real')
               end if
               return
            end do
         end do
      end subroutine check_end

      !> The left (-1) or right (1) end of the surface of the body.
      pure real(wp) function corner(side)
         integer, intent(in) :: side

         corner = merge(body%from, body%to, side < 0)
      end function corner

      !> Whether the interval of a node ends so far from the end of the surface that the width of the contact is wrong by 1 %.
      pure logical function misses_corner(node, side)
         integer, intent(in) :: node, side
         real(wp), parameter :: negligible = 0.01_wp

         misses_corner = abs(end_of(node, side) - corner(side)) > 0.5_wp*negligible*(body%to - body%from)
      end function misses_corner

      !> The left (-1) or right (1) end of the interval of a node.
      pure real(wp) function end_of(node, side)
         integer, intent(in) :: node, side

         associate (model => simulation%contact%model)
            end_of = model%scene%x_of_arc(model%arc(node) + side*0.5_wp*model%width(node))
         end associate
      end function end_of

      !> Whether the surface of the body ends before the next node.
      pure logical function ends_at(node, side)
         integer, intent(in) :: node, side
         real(wp) :: arc

         associate (model => simulation%contact%model)
            arc = model%arc(node) + side*model%width(node)
            if (node + side >= 1 .and. node + side <= model%nodes()) arc = model%arc(node + side)
            ends_at = .not. model%scene%touchable(arc) .and. &
                      (.not. body%covers(model%scene%x_of_arc(arc), model%scene%mesh%parabolic) .or. &
                       (body%deforms_as_circle() .and. abs(arc) >= 0.5_wp*pi*body%radius))
         end associate
      end function ends_at

      !> With points further apart than the nodes the shape between them is uncertain.
      subroutine check_interpolation()
         real(wp), parameter :: further = 1.5_wp
         real(wp), allocatable :: x(:), departure(:), spacing(:), position(:), height(:)
         real(wp) :: share

         x = pack(simulation%contact%model%x, contact)
         departure = abs(body%from_polyline(simulation%contact%model%scene%x_in_period(x)))
         call body%get_points(position, height)
         spacing = spacing_at(position, x)
         if (all(spacing <= further*pack(simulation%contact%model%width, contact))) return
         associate (model => simulation%contact%model, pressure => simulation%contact%state%fields%pressure)
            if (model%scene%modulus() > 0.0_wp .and. maxval(pressure) > 0.0_wp) then
               share = maxval(pressure_of_wave(model%scene%modulus(), departure, spacing))/maxval(pressure)
            else
               share = maxval(departure)/max(maxval(pack(model%initial_gap, contact)) - minval(pack(model%initial_gap, contact)), &
                                             tiny(1.0_wp))
            end if
         end associate
         if (share < negligible_pressure) return
         if (body%interpolation == interpolation_linear .and. corners_under(body, x) <= 2) return
         call add_text(warnings, 'the profile of the '//name//' body is coarser than the mesh: its points are up to '// &
                       to_text(maxval(spacing), 3)//' apart in the contact. Straight lines and a smooth curve through them '// &
                       'differ by up to '//to_text(maxval(departure), 3)//', which changes the pressure by about '// &
                       to_text(100.0_wp*share, 2)//' % of its peak: give more points, or '//trim(advice_for(body%interpolation)))
      end subroutine check_interpolation
   end subroutine warn_of_surface

   !> Nodes in contact in the last state or in the saved state with the largest normal force.
   function touched(simulation) result(contact)
      type(simulation_type), intent(in) :: simulation
      logical, allocatable :: contact(:)
      type(contact_state_type) :: state
      integer :: i, n

      contact = in_contact(simulation%contact%state%status)
      n = simulation%snapshot_count
      if (n == 0) return
      i = maxloc([(simulation%snapshots(i)%state%fields%force(motion_approach), i=1, n)], dim=1)
      state = simulation%padded(simulation%snapshots(i))
      contact = contact .or. in_contact(state%status)
   end function touched

   !> Advice for a profile that is uncertain between its points; padded with blanks.
   pure function advice_for(interpolation) result(advice)
      integer, intent(in) :: interpolation
      character(len=120) :: advice

      select case (interpolation)
      case (interpolation_cubic)
         advice = "interpolation='linear' if the profile has corners at its points, which are now rounded"
      case (interpolation_linear)
         advice = "interpolation='monotone_cubic' if the profile is smooth, without corners at its points"
      case default
         advice = "interpolation='monotone_cubic' if the profile is smooth, 'linear' (the default) if it has corners at its points"
      end select
   end function advice_for

   !> Distance of the points of a profile on either side of each x, length.
   pure function spacing_at(position, x) result(spacing)
      real(wp), intent(in) :: position(:), x(:)
      real(wp) :: spacing(size(x))
      integer :: i, k

      k = 1
      do i = 1, size(x)
         do while (k < size(position) - 1)
            if (position(k + 1) >= x(i)) exit
            k = k + 1
         end do
         spacing(i) = position(k + 1) - position(k)
      end do
   end function spacing_at

   !> Number of points between the outermost nodes in contact at which a profile changes its slope.
   pure integer function corners_under(body, x) result(corners)
      type(body_type), intent(in) :: body
      real(wp), intent(in) :: x(:)
      real(wp), allocatable :: slope(:), position(:), height(:)
      integer :: i, n

      call body%get_points(position, height)
      n = size(position)
      slope = (height(2:) - height(:n - 1))/(position(2:) - position(:n - 1))
      corners = count([(abs(slope(i) - slope(i - 1)) > significant*maxval(abs(slope)) .and. &
                        position(i) > minval(x) .and. position(i) < maxval(x), i=2, n - 1)])
   end function corners_under

end module mfv_surface_warnings
