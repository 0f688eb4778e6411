!> Geometry of a body: its surface near the contact before deformation. Bodies touch at x = 0, y = 0; `recess` is the distance of a
!> surface from the common tangent there.
module mfv_geometry
   use, intrinsic :: iso_c_binding, only: c_int, c_null_ptr, c_ptr, c_size_t
   use mfv_gsl, only: gsl_interp_alloc, gsl_interp_eval, gsl_interp_free, gsl_interp_init, gsl_interp_linear, gsl_interp_steffen
   use mfv_kinds, only: pi, wp
   implicit none
   private
   public :: geometry_type, new_half_plane_surface, new_disk, new_hole, new_flat_punch, new_rounded_punch, new_power, new_wedge, &
             new_profile, new_points, new_wave
   public :: gap_in_hole, radial_gap_in_hole
   public :: shape_half_plane, shape_disk, shape_hole, shape_flat_punch, shape_rounded_punch, shape_wedge, shape_power, &
             shape_profile, shape_matrix, shape_wave, shape_names
   public :: interpolation_unset, interpolation_linear, interpolation_cubic

   integer, parameter :: shape_half_plane = 1, shape_disk = 2, shape_hole = 3, shape_flat_punch = 4, shape_rounded_punch = 5, &
                         shape_wedge = 6, shape_power = 7, shape_profile = 8, shape_matrix = 9, shape_wave = 10
   !> Names of the shapes, in the order of their numbers.
   character(*), parameter :: shape_names = 'half_plane disk hole flat_punch rounded_punch wedge power profile matrix wave'
   !> Interpolation of a profile: linear by default; linear or monotone cubic by choice, in the order of the key.
   integer, parameter :: interpolation_unset = 0, interpolation_linear = 1, interpolation_cubic = 2

   !> A point of a profile is at the end of a period within this part of it.
   real(wp), parameter :: at_end = 1.0e-9_wp

   !> A surface. Lengths by default.
   type :: geometry_type
      integer :: shape = shape_half_plane
      !> Disk and hole: radius R. Rounded punch: radius of its edges.
      real(wp) :: radius = 0.0_wp
      !> Rounded punch: half-width of its flat.
      real(wp) :: flat_half_width = 0.0_wp
      !> Power law: recess coefficient*|x|**exponent; the coefficient is a length^(1 - exponent).
      real(wp) :: coefficient = 0.0_wp, exponent = 0.0_wp
      !> Wave: recess amplitude*(1 - cos(2 pi x/wavelength)).
      real(wp) :: amplitude = 0.0_wp, wavelength = 0.0_wp
      !> First and last x of the surface.
      real(wp) :: from = -huge(1.0_wp), to = huge(1.0_wp)
      !> Profile: increasing positions and the recess there. Matrix: nodes and their initial recess.
      real(wp), allocatable :: position(:), height(:)
      !> Profile: one of interpolation_...
      integer :: interpolation = interpolation_unset
      !> Profile: points of the measurement without a value, which are not in it.
      integer :: dropouts = 0
      !> The surface repeats after this length; 0: it does not.
      real(wp) :: period = 0.0_wp
   contains
      procedure :: has_surface
      procedure :: recess
      procedure :: curvature
      procedure :: circular
      procedure :: is_disk
      procedure :: is_hole
      procedure :: is_straight
      procedure :: is_sampled
      procedure :: is_pointed
      procedure :: has_sharp_ends
      procedure :: is_regular
      procedure :: half_extent
      procedure :: size_of_shape
      procedure :: from_polyline
      procedure :: get_points
   end type geometry_type

contains

   !> A flat surface of infinite extent.
   pure type(geometry_type) function new_half_plane_surface() result(body)
      body = geometry_type(shape=shape_half_plane)
   end function new_half_plane_surface

   !> Disk of the given radius (length).
   pure type(geometry_type) function new_disk(radius) result(body)
      real(wp), intent(in) :: radius

      body = geometry_type(shape=shape_disk, radius=radius, from=-radius, to=radius)
   end function new_disk

   !> Infinite plane around a hole of the given radius (length).
   pure type(geometry_type) function new_hole(radius) result(body)
      real(wp), intent(in) :: radius

      body = geometry_type(shape=shape_hole, radius=radius, from=-radius, to=radius)
   end function new_hole

   !> Flat punch with sharp edges at x = -half_width and half_width (length).
   pure type(geometry_type) function new_flat_punch(half_width) result(body)
      real(wp), intent(in) :: half_width

      body = geometry_type(shape=shape_flat_punch, from=-half_width, to=half_width)
   end function new_flat_punch

   !> Punch that is flat over |x| < half_width; edges with the recess (|x| - half_width)^2/(2 edge_radius); lengths.
   pure type(geometry_type) function new_rounded_punch(half_width, edge_radius) result(body)
      real(wp), intent(in) :: half_width, edge_radius

      body = geometry_type(shape=shape_rounded_punch, flat_half_width=half_width, radius=edge_radius)
   end function new_rounded_punch

   !> Body with the recess coefficient*|x|**exponent; the coefficient is a length^(1 - exponent).
   pure type(geometry_type) function new_power(coefficient, exponent) result(body)
      real(wp), intent(in) :: coefficient, exponent

      body = geometry_type(shape=shape_power, coefficient=coefficient, exponent=exponent)
   end function new_power

   !> Wedge: recess slope*|x|, a power law with the exponent 1.
   pure type(geometry_type) function new_wedge(slope) result(body)
      real(wp), intent(in) :: slope

      body = geometry_type(shape=shape_wedge, coefficient=slope, exponent=1.0_wp)
   end function new_wedge

   !> Wave with a crest at x = 0: recess amplitude*(1 - cos(2 pi x/wavelength)); lengths.
   pure type(geometry_type) function new_wave(amplitude, wavelength) result(body)
      real(wp), intent(in) :: amplitude, wavelength

      body = geometry_type(shape=shape_wave, amplitude=amplitude, wavelength=wavelength)
   end function new_wave

   !> Profile through the points (position, height), lengths; height is the recess. `interpolation`: linear, or Steffen's
   !> monotone cubic, without overshoot, with rounded corners. At least three strictly increasing positions (checked by the
   !> caller).
   pure type(geometry_type) function new_profile(position, height, interpolation) result(body)
      real(wp), intent(in) :: position(:), height(:)
      integer, intent(in), optional :: interpolation

      body%shape = shape_profile
      if (present(interpolation)) body%interpolation = interpolation
      body%position = position
      body%height = height
      body%from = position(1)
      body%to = position(size(position))
   end function new_profile

   !> Surface nodes of a user's matrix: increasing positions and the recess there, lengths, shape (n).
   pure type(geometry_type) function new_points(position, recess) result(body)
      real(wp), intent(in) :: position(:), recess(:)

      body%shape = shape_matrix
      body%position = position
      body%height = recess
      body%from = position(1)
      body%to = position(size(position))
   end function new_points

   !> Whether there is a surface at x.
   elemental logical function has_surface(self, x)
      class(geometry_type), intent(in) :: self
      real(wp), intent(in) :: x

      has_surface = x >= self%from .and. x <= self%to
   end function has_surface

   !> Whether the body is a disk or a hole.
   elemental logical function circular(self)
      class(geometry_type), intent(in) :: self

      circular = self%shape == shape_disk .or. self%shape == shape_hole
   end function circular

   elemental logical function is_disk(self)
      class(geometry_type), intent(in) :: self

      is_disk = self%shape == shape_disk
   end function is_disk

   elemental logical function is_hole(self)
      class(geometry_type), intent(in) :: self

      is_hole = self%shape == shape_hole
   end function is_hole

   !> Whether it is flat, without an end.
   elemental logical function is_straight(self)
      class(geometry_type), intent(in) :: self

      is_straight = self%shape == shape_half_plane
   end function is_straight

   !> Whether it is known at points only: a profile.
   elemental logical function is_sampled(self)
      class(geometry_type), intent(in) :: self

      is_sampled = self%shape == shape_profile
   end function is_sampled

   !> Whether its slope jumps at x = 0: the tip of a wedge.
   elemental logical function is_pointed(self)
      class(geometry_type), intent(in) :: self

      is_pointed = (self%shape == shape_power .or. self%shape == shape_wedge) .and. .not. self%exponent > 1.0_wp
   end function is_pointed

   !> Whether it ends at corners, at which the pressure of an elastic body under it has no limit.
   elemental logical function has_sharp_ends(self)
      class(geometry_type), intent(in) :: self

      has_sharp_ends = self%shape == shape_flat_punch
   end function has_sharp_ends

   !> Whether the surface is a circle or straight.
   pure logical function is_regular(self)
      class(geometry_type), intent(in) :: self

      is_regular = self%shape /= shape_profile .and. self%shape /= shape_wave
      if (self%shape == shape_matrix) is_regular = all(abs(self%height) <= 0.0_wp)
   end function is_regular

   !> Curvature at x = 0, 1/length: positive for a disk, negative for a hole, 0 if flat or undefined.
   elemental real(wp) function curvature(self)
      class(geometry_type), intent(in) :: self

      curvature = 0.0_wp
      if (self%shape == shape_disk) curvature = 1.0_wp/self%radius
      if (self%shape == shape_hole) curvature = -1.0_wp/self%radius
   end function curvature

   !> Largest |x| of the surface, length; huge for a half-plane.
   pure real(wp) function half_extent(self)
      class(geometry_type), intent(in) :: self

      half_extent = max(abs(self%from), abs(self%to))
   end function half_extent

   !> A characteristic length of the shape; huge without one.
   pure real(wp) function size_of_shape(self)
      class(geometry_type), intent(in) :: self

      size_of_shape = self%half_extent()
      if (self%shape == shape_rounded_punch) size_of_shape = self%flat_half_width + self%radius
      if (self%shape == shape_wave) size_of_shape = self%wavelength
   end function size_of_shape

   !> Distance of the surface from the tangent at x = 0 (length) at the positions `x`; zero outside the surface of a circle.
   !> `parabolic`: x^2/(2R) instead of the circle.
   function recess(self, x, parabolic) result(depth)
      class(geometry_type), intent(in) :: self
      real(wp), intent(in) :: x(:)
      logical, intent(in) :: parabolic
      real(wp) :: depth(size(x))

      depth = 0.0_wp
      select case (self%shape)
      case (shape_disk, shape_hole)
         if (parabolic) then
            depth = 0.5_wp*self%curvature()*x**2
         else
            where (self%has_surface(x)) depth = sign(1.0_wp, self%curvature())*x**2/(self%radius + chord(self%radius, x))
         end if
      case (shape_rounded_punch)
         depth = max(abs(x) - self%flat_half_width, 0.0_wp)**2/(2.0_wp*self%radius)
      case (shape_power, shape_wedge)
         depth = power_of(self, abs(x))
      case (shape_wave)
         depth = 2.0_wp*self%amplitude*sin(pi*x/self%wavelength)**2
      case (shape_profile)
         depth = interpolated(self, x, self%interpolation)
      case (shape_matrix)
         depth = self%height
      end select
   end function recess

   !> C x^n, without overflow for any x >= 0.
   elemental real(wp) function power_of(body, x)
      type(geometry_type), intent(in) :: body
      real(wp), intent(in) :: x
      real(wp), parameter :: largest = 230.0_wp

      power_of = 0.0_wp
      if (.not. x > 0.0_wp) return
      power_of = exp(largest)
      if (log(body%coefficient) + body%exponent*log(x) < largest) power_of = body%coefficient*x**body%exponent
   end function power_of

   !> Height of a circle's centre over its point at x: sqrt(R^2 - x^2).
   elemental real(wp) function chord(radius, x)
      real(wp), intent(in) :: radius, x

      chord = sqrt(max((radius - x)*(radius + x), 0.0_wp))
   end function chord

   !> Gap of a disk in a hole that touch at x = 0. With the chords c = sqrt(R^2 - x^2) the difference of x^2/(R + c) contains
   !> the factor R_hole - R_disk, which is factored out analytically.
   elemental real(wp) function gap_in_hole(disk, hole, x, parabolic)
      real(wp), intent(in) :: disk, hole, x
      logical, intent(in) :: parabolic
      real(wp) :: chord_disk, chord_hole

      if (parabolic) then
         gap_in_hole = x**2*(hole - disk)/(2.0_wp*disk*hole)
         return
      end if
      gap_in_hole = 0.0_wp
      if (abs(x) > min(disk, hole)) return
      chord_disk = chord(disk, x)
      chord_hole = chord(hole, x)
      gap_in_hole = x**2*(hole - disk)*(1.0_wp + (disk + hole)/(chord_disk + chord_hole)) &
                    /((disk + chord_disk)*(hole + chord_hole))
   end function gap_in_hole

   !> Gaps of a disk in a hole that touch at theta = 0, along the radii of the hole at the angles `theta`; without cancellation.
   !> With e = R_hole - R_disk: e (1 - cos) + R_disk - sqrt(R_disk^2 - (e sin)^2).
   elemental real(wp) function radial_gap_in_hole(disk, hole, theta) result(gap)
      real(wp), intent(in) :: disk, hole, theta

      gap = ((hole - disk)*sin(theta))**2
      gap = 2.0_wp*(hole - disk)*sin(0.5_wp*theta)**2 + gap/(disk + sqrt(max(disk**2 - gap, 0.0_wp)))
   end function radial_gap_in_hole

   !> Distance at `x` between the two interpolations of a profile: linear from the chosen one, or monotone cubic from linear;
   !> shape (size(x)), length.
   function from_polyline(self, x) result(departure)
      class(geometry_type), intent(in) :: self
      real(wp), intent(in) :: x(:)
      real(wp) :: departure(size(x))

      departure = interpolated(self, x, interpolation_cubic) - interpolated(self, x, interpolation_linear)
   end function from_polyline

   !> A profile at `x`, by the given interpolation.
   function interpolated(self, x, interpolation) result(heights)
      class(geometry_type), intent(in) :: self
      real(wp), intent(in) :: x(:)
      integer, intent(in) :: interpolation
      real(wp) :: heights(size(x))
      integer :: n

      heights = 0.0_wp
      if (interpolation == interpolation_cubic .and. closes(self)) then
         ! One point of the neighbouring periods: else the slope would jump where they meet.
         n = size(self%position)
         associate (position => self%position, height => self%height)
            call evaluate([position(1) - (position(n) - position(n - 1)), position, position(n) + (position(2) - position(1))], &
                          [height(n - 1), height, height(2)])
         end associate
      else
         call evaluate(self%position, self%height)
      end if

   contains

      !> The interpolation of these points at `x`.
      subroutine evaluate(position, height)
         real(wp), intent(in), contiguous :: position(:), height(:)
         type(c_ptr) :: interpolant
         integer(c_size_t) :: points
         integer(c_int) :: code
         integer :: i

         points = size(position, kind=c_size_t)
         if (interpolation == interpolation_cubic) then
            interpolant = gsl_interp_alloc(gsl_interp_steffen, points)
         else
            interpolant = gsl_interp_alloc(gsl_interp_linear, points)
         end if
         code = gsl_interp_init(interpolant, position, height, points)
         do i = 1, size(x)
            if (self%has_surface(x(i))) heights(i) = gsl_interp_eval(interpolant, position, height, x(i), c_null_ptr)
         end do
         call gsl_interp_free(interpolant)
      end subroutine evaluate
   end function interpolated

   !> Whether a profile ends where its next period begins.
   pure logical function closes(self)
      class(geometry_type), intent(in) :: self
      real(wp), parameter :: equal = 1.0e-6_wp
      integer :: n

      n = size(self%position)
      closes = self%period > 0.0_wp .and. abs(self%position(n) - self%position(1) - self%period) <= at_end*self%period .and. &
               abs(self%height(n) - self%height(1)) <= equal*(maxval(self%height) - minval(self%height))
   end function closes

   !> The points of a profile, increasing positions and the recess there, lengths; if it repeats those of three periods, the middle
   !> one around x = 0.
   pure subroutine get_points(self, position, height)
      class(geometry_type), intent(in) :: self
      real(wp), allocatable, intent(out) :: position(:), height(:)
      logical :: inside(size(self%position))

      position = self%position
      height = self%height
      if (.not. self%period > 0.0_wp) return
      inside = self%position >= -0.5_wp*self%period*(1.0_wp + at_end) .and. self%position < 0.5_wp*self%period*(1.0_wp - at_end)
      position = pack(self%position, inside)
      height = pack(self%height, inside)
      position = [position - self%period, position, position + self%period]
      height = [height, height, height]
   end subroutine get_points

end module mfv_geometry
