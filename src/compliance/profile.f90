!> Profiles from points as they were measured: scaled, centred and levelled.
module mfv_profile
   use mfv_body, only: body_type, interpolation_unset, new_profile
   use mfv_error, only: error_type, set_error
   use mfv_kinds, only: wp
   use mfv_numbers, only: largest_size, reasonable_sizes
   use mfv_status, only: MFV_INPUT_ERROR
   use mfv_strings, only: to_text
   implicit none
   private
   public :: trace_type, profile_of_points, level_none, level_mean, level_line

   !> What is taken off heights: nothing, their mean, or the straight line with the least squares.
   integer, parameter :: level_none = 0, level_mean = 1, level_line = 2

   !> How measured points become a profile.
   type :: trace_type
      !> Lengths of the case per unit of the points; a negative one for heights turns outward heights into recess.
      real(wp) :: position_scale = 1.0_wp, height_scale = 1.0_wp
      !> One of level_...; one of interpolation_... (mfv_body).
      integer :: level = level_none, interpolation = interpolation_unset
      !> Whether the middle of the positions is put at x = 0.
      logical :: centred = .false.
   end type trace_type

   !> Steffen's interpolation needs as many points.
   integer, parameter :: fewest_points = 3

contains

   !> The profile through measured points: their increasing positions, and how far the surface recedes there; shape (points).
   !> Error MFV_INPUT_ERROR for fewer than 3 points, and for scales that make them too large or put two in one place.
   subroutine profile_of_points(positions, heights, trace, body, error)
      real(wp), intent(in) :: positions(:), heights(:)
      type(trace_type), intent(in) :: trace
      type(body_type), intent(out) :: body
      type(error_type), allocatable, intent(out) :: error
      real(wp), allocatable :: x(:), height(:)
      integer :: n

      n = size(positions)
      if (n < fewest_points) then
         call set_error(error, MFV_INPUT_ERROR, 'needs at least '//to_text(fewest_points)//' points, and has '//to_text(n))
         return
      end if
      if (any(abs(positions) > largest_size/max(trace%position_scale, 1.0_wp)) .or. &
          any(abs(heights) > largest_size/max(abs(trace%height_scale), 1.0_wp))) then
         call set_error(error, MFV_INPUT_ERROR, 'with position_scale and height_scale, '//reasonable_sizes)
         return
      end if
      x = trace%position_scale*positions
      height = trace%height_scale*heights
      if (trace%centred) x = x - 0.5_wp*(x(1) + x(n))
      if (trace%level == level_mean) height = height - sum(height)/n
      if (trace%level == level_line) call remove_line(x, height)
      if (all(x(2:) > x(:n - 1))) then
         body = new_profile(x, height, trace%interpolation)
      else
         call set_error(error, MFV_INPUT_ERROR, 'position_scale or centred leaves no distance between points')
      end if
   end subroutine profile_of_points

   !> Take the straight line with the least squares off some heights.
   pure subroutine remove_line(x, height)
      real(wp), intent(in) :: x(:)
      real(wp), intent(inout) :: height(:)
      real(wp) :: from_middle(size(x)), scale

      scale = maxval(abs(x))
      from_middle = x/scale - sum(x/scale)/size(x)
      height = height - sum(height)/size(x)
      height = height - sum(from_middle*height)/sum(from_middle**2)*from_middle
   end subroutine remove_line

end module mfv_profile
