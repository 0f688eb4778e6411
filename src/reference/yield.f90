!> Onset of yield under a frictionless cylinder: von Mises stress on the axis below Hertz's pressure (Johnson 1985, eqs.
!> 4.45), and the contact arc of dissertation Table 4.1.
module mfv_reference_yield
   use mfv_kinds, only: wp
   use mfv_material, only: material_type, plane_strain
   use mfv_minimum, only: minimum_near, objective_type
   implicit none
   private
   public :: hertz_axis_von_mises, hertz_largest_von_mises, contact_arc, contact_arc_at_yield

   type, extends(objective_type) :: axis_type
      real(wp) :: out_of_plane = 0.0_wp
   contains
      procedure :: value => negative_von_mises
   end type axis_type

contains

   !> Von Mises stress over the peak pressure p0 on the axis, at the depth `depth` over the half-width. `out_of_plane`:
   !> Poisson's ratio in plane strain, 0 in plane stress.
   elemental real(wp) function hertz_axis_von_mises(depth, out_of_plane) result(von_mises)
      real(wp), intent(in) :: depth, out_of_plane
      real(wp) :: tangential, down, across, root

      root = sqrt(1.0_wp + depth**2)
      tangential = -((1.0_wp + 2.0_wp*depth**2)/root - 2.0_wp*depth)
      down = -1.0_wp/root
      across = out_of_plane*(tangential + down)
      von_mises = sqrt(0.5_wp*((tangential - down)**2 + (down - across)**2 + (across - tangential)**2))
   end function hertz_axis_von_mises

   !> Largest von Mises stress on the axis over p0, and its depth over the half-width.
   subroutine hertz_largest_von_mises(out_of_plane, von_mises, depth)
      real(wp), intent(in) :: out_of_plane
      real(wp), intent(out) :: von_mises, depth
      type(axis_type) :: axis
      real(wp) :: place(1), value

      axis%out_of_plane = out_of_plane
      place = 0.7_wp
      call minimum_near(axis, [0.1_wp], place, value)
      von_mises = -value
      depth = abs(place(1))
   end subroutine hertz_largest_von_mises

   real(wp) function negative_von_mises(self, x) result(value)
      class(axis_type), intent(in) :: self
      real(wp), intent(in) :: x(:)

      value = -hertz_axis_von_mises(abs(x(1)), self%out_of_plane)
   end function negative_von_mises

   !> Contact arc 2a/R, radians, of an elastic disk on a rigid plane with the peak pressure p0 (force/length^2) and the
   !> modulus m = 4 G/(kappa + 1) (force/length^2): p0 = m a/R.
   pure real(wp) function contact_arc(largest_pressure, modulus)
      real(wp), intent(in) :: largest_pressure, modulus

      contact_arc = 2.0_wp*largest_pressure/modulus
   end function contact_arc

   !> Contact arc, radians, at the yield strength (force/length^2); independent of load and radius. Dissertation Table 4.1
   !> uses p0 = 1.79 Y (Johnson 1985, section 6.1, for nu = 0.3) and nu = 0.3 for every metal instead of the Poisson's ratios
   !> in its own column: its arcs are up to 0.6 % off.
   real(wp) function contact_arc_at_yield(material, plane, yield_strength) result(arc)
      type(material_type), intent(in) :: material
      integer, intent(in) :: plane
      real(wp), intent(in) :: yield_strength
      real(wp) :: von_mises, depth

      call hertz_largest_von_mises(merge(material%poisson_ratio, 0.0_wp, plane == plane_strain), von_mises, depth)
      arc = contact_arc(yield_strength/von_mises, material%plane_modulus())
   end function contact_arc_at_yield

end module mfv_reference_yield
