!> Rigid upper bodies: the undeformed gap g0(x) between the indenter and the flat surface below it.
module mfv_indenter
   use, intrinsic :: iso_c_binding, only: c_int, c_null_ptr, c_ptr, c_size_t
   use mfv_gsl, only: gsl_interp_alloc, gsl_interp_eval, gsl_interp_free, gsl_interp_init, gsl_interp_steffen
   use mfv_kinds, only: wp
   implicit none
   private
   public :: indenter_type, new_disk, new_flat_punch, new_profile
   public :: shape_disk, shape_flat_punch, shape_profile

   integer, parameter :: shape_disk = 1, shape_flat_punch = 2, shape_profile = 3

   !> A rigid indenter centred at x = 0 (a profile: where its own coordinates put it). Lengths.
   type :: indenter_type
      integer :: shape = 0
      !> Disk: radius R.
      real(wp) :: radius = 0.0_wp
      !> Disk: x^2/(2R) instead of the exact circle.
      logical :: parabolic = .false.
      !> First and last x under the indenter.
      real(wp) :: from = 0.0_wp, to = 0.0_wp
      !> Profile: increasing positions and heights above the flat surface.
      real(wp), allocatable :: position(:), height(:)
   contains
      procedure :: covers
      procedure :: gap
      procedure :: half_extent
   end type indenter_type

contains

   !> Disk of the given radius (length); Hertz's parabola instead of the circle where `parabolic`.
   pure function new_disk(radius, parabolic) result(indenter)
      real(wp), intent(in) :: radius
      logical, intent(in) :: parabolic
      type(indenter_type) :: indenter

      indenter%shape = shape_disk
      indenter%radius = radius
      indenter%parabolic = parabolic
      indenter%from = -radius
      indenter%to = radius
   end function new_disk

   !> Flat punch with sharp edges at x = -half_width and half_width (length).
   pure function new_flat_punch(half_width) result(indenter)
      real(wp), intent(in) :: half_width
      type(indenter_type) :: indenter

      indenter%shape = shape_flat_punch
      indenter%from = -half_width
      indenter%to = half_width
   end function new_flat_punch

   !> Profile through the points (position, height), lengths, by Steffen's monotone interpolation: no overshoot, flat
   !> parts stay flat. The caller makes sure of at least three strictly increasing positions.
   pure function new_profile(position, height) result(indenter)
      real(wp), intent(in) :: position(:), height(:)
      type(indenter_type) :: indenter

      indenter%shape = shape_profile
      indenter%position = position
      indenter%height = height
      indenter%from = position(1)
      indenter%to = position(size(position))
   end function new_profile

   !> Whether the indenter is above the surface point x.
   elemental logical function covers(self, x)
      class(indenter_type), intent(in) :: self
      real(wp), intent(in) :: x

      covers = x >= self%from .and. x <= self%to
   end function covers

   !> Undeformed gaps (length) at the positions `x`; zero where the indenter does not cover x (ask `covers`).
   function gap(self, x) result(gaps)
      class(indenter_type), intent(in) :: self
      real(wp), intent(in) :: x(:)
      real(wp) :: gaps(size(x))

      gaps = 0.0_wp
      select case (self%shape)
      case (shape_disk)
         if (self%parabolic) then
            gaps = x**2/(2.0_wp*self%radius)
         else
            where (self%covers(x)) gaps = x**2/(self%radius + sqrt(max((self%radius - x)*(self%radius + x), 0.0_wp)))
         end if
      case (shape_profile)
         gaps = interpolated(self, x)
      end select
   end function gap

   !> The largest |x| under the indenter, length.
   pure real(wp) function half_extent(self)
      class(indenter_type), intent(in) :: self

      half_extent = max(abs(self%from), abs(self%to))
   end function half_extent

   function interpolated(self, x) result(heights)
      class(indenter_type), intent(in) :: self
      real(wp), intent(in) :: x(:)
      real(wp) :: heights(size(x))
      type(c_ptr) :: interpolation
      integer(c_size_t) :: points
      integer(c_int) :: code
      integer :: i

      heights = 0.0_wp
      points = size(self%position, kind=c_size_t)
      interpolation = gsl_interp_alloc(gsl_interp_steffen, points)
      code = gsl_interp_init(interpolation, self%position, self%height, points)
      do i = 1, size(x)
         if (.not. self%covers(x(i))) cycle
         heights(i) = gsl_interp_eval(interpolation, self%position, self%height, x(i), c_null_ptr)
      end do
      call gsl_interp_free(interpolation)
   end function interpolated

end module mfv_indenter
