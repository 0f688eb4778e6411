!> Profiles from measured points: scaled, centred and levelled.
module mfv_profile
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
   use mfv_geometry, only: geometry_type, interpolation_unset, new_profile
   use mfv_error, only: error_type, set_error
   use mfv_kinds, only: wp
   use mfv_numbers, only: largest_size, reasonable_sizes
   use mfv_status, only: MFV_INPUT_ERROR
   use mfv_strings, only: to_text
   implicit none
   private
   public :: trace_type, profile_of_points

   !> Levelling of heights, in the order of the key &body level: none, by their mean, or by the least-squares line or parabola.
   integer, parameter :: level_none = 1, level_mean = 2, level_line = 3

   !> Settings that turn measured points into a profile.
   type :: trace_type
      !> Lengths of the case per unit of the points; for heights negative if they are positive outwards.
      real(wp) :: position_scale = 1.0_wp, height_scale = 1.0_wp
      !> One of level_...; one of interpolation_... (mfv_geometry).
      integer :: level = level_none, interpolation = interpolation_unset
      !> Whether the middle of the positions is moved to x = 0.
      logical :: centred = .false.
      !> Whether position_scale is given, the distance of heights without positions.
      logical :: has_spacing = .false.
   end type trace_type

   !> Minimum for Steffen's interpolation.
   integer, parameter :: fewest_points = 3

contains

   !> The profile through measured points: increasing positions and the recess there; shape (points). Points without a value (NaN)
   !> are omitted and counted. Error MFV_INPUT_ERROR for fewer than 3 others, and for scales with which numbers are too large or
   !> points coincide.
   subroutine profile_of_points(positions, heights, trace, geometry, error)
      real(wp), intent(in) :: positions(:), heights(:)
      type(trace_type), intent(in) :: trace
      type(geometry_type), intent(out) :: geometry
      type(error_type), allocatable, intent(out) :: error
      real(wp), allocatable :: x(:), height(:)
      logical :: given(size(positions))
      integer :: n

      given = .not. (ieee_is_nan(positions) .or. ieee_is_nan(heights))
      n = count(given)
      if (n < fewest_points) then
         call set_error(error, MFV_INPUT_ERROR, 'needs at least '//to_text(fewest_points)//' points; it has '//to_text(n)// &
                        trim(merge(' with values', '            ', n < size(given))))
         return
      end if
      x = pack(positions, given)
      height = pack(heights, given)
      if (any(abs(x) > largest_size/max(trace%position_scale, 1.0_wp)) .or. &
          any(abs(height) > largest_size/max(abs(trace%height_scale), 1.0_wp))) then
         call set_error(error, MFV_INPUT_ERROR, 'with position_scale and height_scale, '//reasonable_sizes)
         return
      end if
      x = trace%position_scale*x
      height = trace%height_scale*height
      if (trace%centred) x = x - 0.5_wp*(x(1) + x(n))
      if (trace%level == level_mean) height = height - sum(height)/n
      if (trace%level >= level_line) call remove_polynomial(trace%level - level_mean, x, height)
      if (all(x(2:) > x(:n - 1))) then
         geometry = new_profile(x, height, trace%interpolation)
         geometry%dropouts = size(given) - n
      else
         call set_error(error, MFV_INPUT_ERROR, 'with position_scale and centred, points coincide')
      end if
   end subroutine profile_of_points

   !> Subtract the least-squares line (degree 1) or parabola (2) from heights.
   pure subroutine remove_polynomial(degree, x, height)
      integer, intent(in) :: degree
      real(wp), intent(in) :: x(:)
      real(wp), intent(inout) :: height(:)
      real(wp) :: line(size(x)), parabola(size(x)), scale

      scale = maxval(abs(x))
      line = x/scale - sum(x/scale)/size(x)
      parabola = line**2 - sum(line**2)/size(x)
      parabola = parabola - sum(line*parabola)/sum(line**2)*line
      height = height - sum(height)/size(x)
      height = height - sum(line*height)/sum(line**2)*line
      if (degree > 1) height = height - sum(parabola*height)/sum(parabola**2)*parabola
   end subroutine remove_polynomial

end module mfv_profile
