!> Bodies: their shape near the contact, their material, and the compliance that goes with them.
!>
!> The pole of every body is at x = 0, y = 0 before the bodies deform; the lower body is below, the upper one above, each
!> seen from its own side: `recess` is how far its surface recedes from the common tangent at the pole.
module mfv_body
   use, intrinsic :: iso_c_binding, only: c_int, c_null_ptr, c_ptr, c_size_t
   use mfv_circle, only: kernel_exact, new_circle
   use mfv_circle_kernels, only: body_disk, body_hole
   use mfv_compliance, only: compliance_type
   use mfv_gsl, only: gsl_interp_alloc, gsl_interp_eval, gsl_interp_free, gsl_interp_init, gsl_interp_steffen
   use mfv_half_plane, only: new_half_plane
   use mfv_kinds, only: wp
   use mfv_material, only: material_type
   use mfv_matrix_compliance, only: new_matrix_compliance
   implicit none
   private
   public :: body_type, new_half_plane_body, new_disk, new_hole, new_flat_punch, new_profile, new_matrix_body
   public :: gap_between, radial_gap_between
   public :: shape_half_plane, shape_disk, shape_hole, shape_flat_punch, shape_profile, shape_matrix, shape_names

   integer, parameter :: shape_half_plane = 1, shape_disk = 2, shape_hole = 3, shape_flat_punch = 4, shape_profile = 5, &
                         shape_matrix = 6
   !> Names of the shapes 1, 2, ...
   character(*), parameter :: shape_names = 'half_plane disk hole flat_punch profile matrix'

   !> A body. Lengths unless told.
   type :: body_type
      integer :: shape = shape_half_plane
      logical :: rigid = .true.
      !> Material of an elastic body.
      type(material_type) :: material
      !> Disk and hole: radius R.
      real(wp) :: radius = 0.0_wp
      !> Elastic bodies: distance from the pole at which displacements are measured.
      real(wp) :: datum = 0.0_wp
      !> Elastic bodies: yield strength, force/length^2; 0: not known.
      real(wp) :: yield_strength = 0.0_wp
      !> Elastic disk and hole: kernel and harmonics, see mfv_circle.
      integer :: kernel = kernel_exact, harmonics = 0
      !> First and last x at which there is a surface to touch.
      real(wp) :: from = -huge(1.0_wp), to = huge(1.0_wp)
      !> Profile: increasing positions and heights above the flat surface. Matrix: the nodes and their undeformed recess.
      real(wp), allocatable :: position(:), height(:)
      !> Matrix: surface that belongs to each node, and displacements by nodal forces.
      real(wp), allocatable :: width(:), matrix(:, :)
   contains
      procedure :: covers
      procedure :: recess
      procedure :: curvature
      procedure :: circular
      procedure :: half_extent
      procedure :: make_compliance
   end type body_type

contains

   !> A flat surface without end.
   pure function new_half_plane_body() result(body)
      type(body_type) :: body

      body%shape = shape_half_plane
   end function new_half_plane_body

   !> Disk of the given radius (length).
   pure function new_disk(radius) result(body)
      real(wp), intent(in) :: radius
      type(body_type) :: body

      body%shape = shape_disk
      body%radius = radius
      body%from = -radius
      body%to = radius
   end function new_disk

   !> Infinite plane around a hole of the given radius (length).
   pure function new_hole(radius) result(body)
      real(wp), intent(in) :: radius
      type(body_type) :: body

      body = new_disk(radius)
      body%shape = shape_hole
   end function new_hole

   !> Flat punch with sharp edges at x = -half_width and half_width (length).
   pure function new_flat_punch(half_width) result(body)
      real(wp), intent(in) :: half_width
      type(body_type) :: body

      body%shape = shape_flat_punch
      body%from = -half_width
      body%to = half_width
   end function new_flat_punch

   !> Profile through the points (position, height), lengths, by Steffen's monotone interpolation: no overshoot, flat
   !> parts stay flat. The caller makes sure of at least three strictly increasing positions.
   pure function new_profile(position, height) result(body)
      real(wp), intent(in) :: position(:), height(:)
      type(body_type) :: body

      body%shape = shape_profile
      body%position = position
      body%height = height
      body%from = position(1)
      body%to = position(size(position))
   end function new_profile

   !> Elastic body of a user's matrix: `position` and `recess` of its surface nodes and the `width` of the surface that
   !> belongs to each, lengths, shape (n); `matrix`: displacements by nodal forces, see mfv_matrix_compliance.
   pure function new_matrix_body(position, recess, width, matrix) result(body)
      real(wp), intent(in) :: position(:), recess(:), width(:), matrix(:, :)
      type(body_type) :: body

      body%shape = shape_matrix
      body%rigid = .false.
      body%position = position
      body%height = recess
      body%width = width
      body%matrix = matrix
      body%from = position(1)
      body%to = position(size(position))
   end function new_matrix_body

   !> Whether the body has a surface at x.
   elemental logical function covers(self, x)
      class(body_type), intent(in) :: self
      real(wp), intent(in) :: x

      covers = x >= self%from .and. x <= self%to
   end function covers

   !> Whether the body is a disk or a hole.
   elemental logical function circular(self)
      class(body_type), intent(in) :: self

      circular = self%shape == shape_disk .or. self%shape == shape_hole
   end function circular

   !> Curvature at the pole, 1/length: positive for a disk, negative for a hole, 0 for what is flat or has no one value.
   elemental real(wp) function curvature(self)
      class(body_type), intent(in) :: self

      curvature = 0.0_wp
      if (self%shape == shape_disk) curvature = 1.0_wp/self%radius
      if (self%shape == shape_hole) curvature = -1.0_wp/self%radius
   end function curvature

   !> The largest |x| at which there is a surface, length; enormous for a half-plane.
   pure real(wp) function half_extent(self)
      class(body_type), intent(in) :: self

      half_extent = max(abs(self%from), abs(self%to))
   end function half_extent

   !> How far the surface recedes from the tangent at the pole (length) at the positions `x`; zero where there is no
   !> surface (ask `covers`). `parabolic`: x^2/(2R) in place of the circle.
   function recess(self, x, parabolic) result(depth)
      class(body_type), intent(in) :: self
      real(wp), intent(in) :: x(:)
      logical, intent(in) :: parabolic
      real(wp) :: depth(size(x))

      depth = 0.0_wp
      select case (self%shape)
      case (shape_disk, shape_hole)
         if (parabolic) then
            depth = 0.5_wp*self%curvature()*x**2
         else
            where (self%covers(x)) depth = sign(1.0_wp, self%curvature())*x**2/(self%radius + chord(self%radius, x))
         end if
      case (shape_profile)
         depth = interpolated(self, x)
      case (shape_matrix)
         depth = self%height
      end select
   end function recess

   !> Height of a circle's centre over its point at x: sqrt(R^2 - x^2).
   elemental real(wp) function chord(radius, x)
      real(wp), intent(in) :: radius, x

      chord = sqrt(max((radius - x)*(radius + x), 0.0_wp))
   end function chord

   !> Undeformed gaps (length) at the positions `x`: the exact shapes, without cancellation where a disk lies in a hole of
   !> nearly its radius; or, `parabolic`, Hertz's parabolas. Zero where one of the bodies has no surface.
   function gap_between(lower, upper, x, parabolic) result(gaps)
      type(body_type), intent(in) :: lower, upper
      real(wp), intent(in) :: x(:)
      logical, intent(in) :: parabolic
      real(wp) :: gaps(size(x))

      if (lower%circular() .and. upper%circular() .and. lower%shape /= upper%shape) then
         if (lower%shape == shape_disk) then
            gaps = clearance(lower%radius, upper%radius, x, parabolic)
         else
            gaps = clearance(upper%radius, lower%radius, x, parabolic)
         end if
      else
         gaps = lower%recess(x, parabolic) + upper%recess(x, parabolic)
      end if
      where (.not. (lower%covers(x) .and. upper%covers(x))) gaps = 0.0_wp
   end function gap_between

   !> Gap of a disk in a hole, which touch at the pole. With the chords c = sqrt(R^2 - x^2) the difference of
   !> x^2/(R + c) has the factor R_hole - R_disk, which is taken out by hand.
   elemental real(wp) function clearance(disk, hole, x, parabolic)
      real(wp), intent(in) :: disk, hole, x
      logical, intent(in) :: parabolic
      real(wp) :: chord_disk, chord_hole

      if (parabolic) then
         clearance = x**2*(hole - disk)/(2.0_wp*disk*hole)
         return
      end if
      clearance = 0.0_wp
      if (abs(x) > min(disk, hole)) return
      chord_disk = chord(disk, x)
      chord_hole = chord(hole, x)
      clearance = x**2*(hole - disk)*(1.0_wp + (disk + hole)/(chord_disk + chord_hole)) &
                  /((disk + chord_disk)*(hole + chord_hole))
   end function clearance

   !> Undeformed gaps (length) of a disk in a hole, touching at the pole, along the radii of the hole at the angles
   !> `theta` from the pole; without cancellation. With e = R_hole - R_disk: e (1 - cos) + R_disk - sqrt(R_disk^2 - (e sin)^2).
   pure function radial_gap_between(lower, upper, theta) result(gaps)
      type(body_type), intent(in) :: lower, upper
      real(wp), intent(in) :: theta(:)
      real(wp) :: gaps(size(theta)), clearance_of_radii, disk

      disk = min(lower%radius, upper%radius)
      clearance_of_radii = abs(lower%radius - upper%radius)
      gaps = (clearance_of_radii*sin(theta))**2
      gaps = 2.0_wp*clearance_of_radii*sin(0.5_wp*theta)**2 + gaps/(disk + sqrt(max(disk**2 - gaps, 0.0_wp)))
   end function radial_gap_between

   !> The compliance of an elastic body with `nodes` intervals of the width `interval` (length); left unallocated for a
   !> rigid one. `coupling`, `tangential`: see mfv_compliance; `radial`: see mfv_circle. A profile deforms as the half-plane that it nearly is.
   subroutine make_compliance(self, nodes, interval, coupling, tangential, radial, compliance)
      class(body_type), intent(in) :: self
      integer, intent(in) :: nodes, coupling
      real(wp), intent(in) :: interval
      logical, intent(in) :: tangential, radial
      class(compliance_type), allocatable, intent(out) :: compliance

      if (self%rigid) return
      select case (self%shape)
      case (shape_disk, shape_hole)
         allocate (compliance, source=new_circle(merge(body_disk, body_hole, self%shape == shape_disk), self%material, &
                                                 self%radius, nodes, interval, self%datum, self%kernel, &
                                                 self%harmonics, coupling, tangential, radial))
      case (shape_matrix)
         allocate (compliance, source=new_matrix_compliance(self%matrix, self%width, coupling, tangential))
      case default
         allocate (compliance, source=new_half_plane(self%material, nodes, interval, self%datum, coupling, tangential))
      end select
   end subroutine make_compliance

   function interpolated(self, x) result(heights)
      class(body_type), intent(in) :: self
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

end module mfv_body
