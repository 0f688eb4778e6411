!> Bodies: a surface, an elasticity or none, and a yield strength. Before deformation they touch at x = 0, y = 0, the lower body
!> below.
module mfv_body
   use mfv_compliance, only: compliance_type
   use mfv_elasticity, only: as_disk, as_half_plane, as_hole, as_matrix, elasticity_type
   use mfv_geometry, only: gap_in_hole, geometry_type, new_points, radial_gap_in_hole
   use mfv_kinds, only: wp
   implicit none
   private
   public :: body_type, new_body, new_matrix_body, gap_between, radial_gap_between, body_names

   character(*), parameter :: body_names(2) = ['lower', 'upper']

   type, extends(geometry_type) :: body_type
      logical :: rigid = .true.
      !> Of an elastic body.
      type(elasticity_type) :: elasticity
      !> Elastic bodies: yield strength, force/length^2; 0: unknown.
      real(wp) :: yield_strength = 0.0_wp
   contains
      procedure :: covers
      procedure :: deforms_as_circle
      procedure :: is_matrix
      procedure :: strength_of
      procedure :: strength_at
      procedure :: has_strength
      procedure :: make_compliance
   end type body_type

contains

   !> A rigid body with a surface. If it becomes elastic, disk and hole deform as such, all others as half-planes.
   pure type(body_type) function new_body(geometry) result(body)
      type(geometry_type), intent(in) :: geometry

      body%geometry_type = geometry
      body%elasticity%kind = as_half_plane
      if (geometry%is_disk()) body%elasticity%kind = as_disk
      if (geometry%is_hole()) body%elasticity%kind = as_hole
   end function new_body

   !> Elastic body of a user's matrix: `position` and `recess` of its surface nodes and surface length `width` of each,
   !> lengths, shape (n); `matrix`: displacements by nodal forces, see mfv_matrix_compliance.
   pure type(body_type) function new_matrix_body(position, recess, width, matrix) result(body)
      real(wp), intent(in) :: position(:), recess(:), width(:), matrix(:, :)

      body%geometry_type = new_points(position, recess)
      body%rigid = .false.
      body%elasticity%kind = as_matrix
      body%elasticity%width = width
      body%elasticity%matrix = matrix
   end function new_matrix_body

   !> Whether the body deforms as a disk or as the plane around a hole.
   elemental logical function deforms_as_circle(self)
      class(body_type), intent(in) :: self

      deforms_as_circle = .not. self%rigid .and. self%elasticity%is_circle()
   end function deforms_as_circle

   !> Whether it is a user's matrix, which has its own nodes.
   elemental logical function is_matrix(self)
      class(body_type), intent(in) :: self

      is_matrix = self%elasticity%is_matrix()
   end function is_matrix

   !> Yield strength of a layer, or of the body without layers, force/length^2; 0: unknown.
   pure real(wp) function strength_of(self, layer) result(strength)
      class(body_type), intent(in) :: self
      integer, intent(in) :: layer

      strength = self%yield_strength
      if (layer <= self%elasticity%layer_count()) strength = self%elasticity%layer(layer)%yield_strength
   end function strength_of

   !> Yield strength at a depth (its size counts) below the surface, length; force/length^2; 0: unknown.
   pure real(wp) function strength_at(self, depth) result(strength)
      class(body_type), intent(in) :: self
      real(wp), intent(in) :: depth

      strength = self%strength_of(self%elasticity%layer_at(abs(depth)))
   end function strength_at

   !> Whether a yield strength is known.
   pure logical function has_strength(self)
      class(body_type), intent(in) :: self
      integer :: i

      has_strength = any([(self%strength_of(i) > 0.0_wp, i=1, self%elasticity%layer_count() + 1)])
   end function has_strength

   !> Whether the body has a surface at x. `parabolic`: the parabola of a circle is unlimited, unless it deforms as a circle.
   elemental logical function covers(self, x, parabolic)
      class(body_type), intent(in) :: self
      real(wp), intent(in) :: x
      logical, intent(in) :: parabolic

      covers = self%has_surface(x) .or. (parabolic .and. self%circular() .and. .not. self%deforms_as_circle())
   end function covers

   !> Initial gaps (length) at the positions `x`: exact shapes, without cancellation for a disk in a hole of nearly its
   !> radius; or, `parabolic`, Hertz's parabolas. Zero outside a surface.
   function gap_between(lower, upper, x, parabolic) result(gaps)
      type(body_type), intent(in) :: lower, upper
      real(wp), intent(in) :: x(:)
      logical, intent(in) :: parabolic
      real(wp) :: gaps(size(x))

      if (lower%is_disk() .and. upper%is_hole()) then
         gaps = gap_in_hole(lower%radius, upper%radius, x, parabolic)
      else if (lower%is_hole() .and. upper%is_disk()) then
         gaps = gap_in_hole(upper%radius, lower%radius, x, parabolic)
      else
         gaps = lower%recess(x, parabolic) + upper%recess(x, parabolic)
      end if
      where (.not. (lower%covers(x, parabolic) .and. upper%covers(x, parabolic))) gaps = 0.0_wp
   end function gap_between

   !> Initial gaps (length) of a disk in a hole that touch at theta = 0, along the radii of the hole at the angles `theta`.
   pure function radial_gap_between(lower, upper, theta) result(gaps)
      type(body_type), intent(in) :: lower, upper
      real(wp), intent(in) :: theta(:)
      real(wp) :: gaps(size(theta))

      gaps = radial_gap_in_hole(min(lower%radius, upper%radius), max(lower%radius, upper%radius), theta)
   end function radial_gap_between

   !> Compliance of an elastic body; unallocated for a rigid one. Arguments: see mfv_elasticity.
   subroutine make_compliance(self, nodes, interval, coupling, tangential, common_radius, compliance, ends, middle)
      class(body_type), intent(in) :: self
      integer, intent(in) :: nodes, coupling
      real(wp), intent(in) :: interval, common_radius
      logical, intent(in) :: tangential
      class(compliance_type), allocatable, intent(out) :: compliance
      real(wp), intent(in), optional :: ends(:), middle

      if (self%rigid) return
      call self%elasticity%make_compliance(self%radius, nodes, interval, coupling, tangential, common_radius, compliance, &
                                           ends, middle)
   end subroutine make_compliance

end module mfv_body
