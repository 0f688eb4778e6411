!> A contact edge by itself: a parabola on a half-plane, whose right edge has given intensities (docs/theory.md, intensities at
!> edges). Under the normal force P the half-width a is that of Hertz, and the pressure next to an edge K_N sqrt(s), K_N = k
!> sqrt(2 a)/A, k the curvature and A the compliance of both bodies together. The force Q and the strain e by which bulk stresses
!> stretch the lower surface more than the upper one cause K_T = Q/(pi sqrt(2 a)) - (e/At) sqrt(a/2) at the right edge, if nothing
!> slips. A slip zone sees the rest of the contact as an error of the order of its width over a.
module mfv_reference_edge
   use mfv_kinds, only: pi, wp
   implicit none
   private
   public :: edge_contact_type

   !> K_N is `intensity` (force/length^(5/2)) at the half-width `length`; compliances A and At, length^2/force.
   type :: edge_contact_type
      real(wp) :: intensity = 0.0_wp, length = 0.0_wp, normal = 0.0_wp, tangential = 0.0_wp
   contains
      procedure :: curvature
      procedure :: half_width
      procedure :: intensity_of
      procedure :: normal_force
      procedure :: tangential_force
   end type edge_contact_type

contains

   !> Curvature of the parabola, 1/length.
   elemental real(wp) function curvature(self)
      class(edge_contact_type), intent(in) :: self

      curvature = self%intensity*self%normal/sqrt(2.0_wp*self%length)
   end function curvature

   !> Half-width at an intensity K_N, force/length^(5/2): it grows with the square.
   elemental real(wp) function half_width(self, intensity)
      class(edge_contact_type), intent(in) :: self
      real(wp), intent(in) :: intensity

      half_width = self%length*(intensity/self%intensity)**2
   end function half_width

   !> K_N under a normal force, force/length.
   elemental real(wp) function intensity_of(self, normal_force) result(intensity)
      class(edge_contact_type), intent(in) :: self
      real(wp), intent(in) :: normal_force

      intensity = self%intensity*(normal_force/self%normal_force(self%intensity))**0.25_wp
   end function intensity_of

   !> Normal force at an intensity K_N.
   elemental real(wp) function normal_force(self, intensity)
      class(edge_contact_type), intent(in) :: self
      real(wp), intent(in) :: intensity

      normal_force = 0.5_wp*pi*self%curvature()*self%half_width(intensity)**2/self%normal
   end function normal_force

   !> Tangential force at the intensities K_N and K_T (force/length^(3/2)) and the difference of strains e.
   elemental real(wp) function tangential_force(self, normal_intensity, shear_intensity, strain) result(force)
      class(edge_contact_type), intent(in) :: self
      real(wp), intent(in) :: normal_intensity, shear_intensity, strain

      associate (a => self%half_width(normal_intensity))
         force = pi*sqrt(2.0_wp*a)*(shear_intensity + strain/self%tangential*sqrt(0.5_wp*a))
      end associate
   end function tangential_force

end module mfv_reference_edge
