!> Near field of an elastic body: how its surface deforms close to a load. On every body with a smooth surface the displacements by
!> line forces P into it and Q along it are
!>
!>     w by P:  -(A/pi) ln|x|      w by Q:  -(M/pi) ln|x| + B/2 sgn x
!>     u by Q:  -(At/pi) ln|x|     u by P:  -(M/pi) ln|x| - B/2 sgn x
!>
!> up to smooth functions. Of an isotropic material A = At = (kappa + 1)/(4 G), M = 0 and B = (kappa - 1)/(4 G) (Johnson 1985,
!> section 2.2; Barber 2010, chapter 12). In general, with the roots of mfv_material, A = -s22 Im(1/mu1 + 1/mu2), At = s11 Im(mu1
!> + mu2), M = -s11 Im(mu1 mu2) and B = s12 - s11 Re(mu1 mu2) (docs/theory.md). M vanishes where the axes of an orthotropic
!> material are along and normal to the surface. Edges, scales and closed forms need no more of a body's elasticity than these
!> constants.
module mfv_near_field
   use mfv_kinds, only: wp
   use mfv_material, only: material_type
   implicit none
   private
   public :: near_field_type, near_field_of, pair_of

   !> A, At, B and M of a body or, with B and M the differences of lower and upper body, a pair, length^2/force; 0 of a rigid body.
   type :: near_field_type
      real(wp) :: normal = 0.0_wp, tangential = 0.0_wp, coupling = 0.0_wp, mixed = 0.0_wp
   contains
      procedure :: modulus
      procedure :: beta
      procedure :: shear_ratio
      procedure :: coupling_ratio
      procedure :: edge_product
      procedure :: with_reversed_shear
   end type near_field_type

contains

   !> Constants of a material; 0 without one.
   elemental type(near_field_type) function near_field_of(material) result(constants)
      type(material_type), intent(in) :: material

      if (.not. material%exists()) return
      if (material%is_isotropic()) then
         constants%normal = 1.0_wp/material%plane_modulus()
         constants%tangential = constants%normal
         constants%coupling = (material%kolosov - 1.0_wp)/(4.0_wp*material%shear_modulus)
         return
      end if
      associate (s => material%compliance)
         constants%normal = -s(3)*aimag(material%root_sum/material%root_product)
         constants%tangential = s(1)*aimag(material%root_sum)
         constants%coupling = s(2) - s(1)*real(material%root_product, wp)
         constants%mixed = -s(1)*aimag(material%root_product)
      end associate
   end function near_field_of

   !> Constants of two bodies together, the upper one upside down: A and At add, B and M subtract.
   elemental type(near_field_type) function pair_of(lower, upper) result(pair)
      type(near_field_type), intent(in) :: lower, upper

      pair = near_field_type(lower%normal + upper%normal, lower%tangential + upper%tangential, lower%coupling - upper%coupling, &
                             lower%mixed - upper%mixed)
   end function pair_of

   !> 1/A, force/length^2: half the contact modulus E* of an isotropic body; 0 without constants.
   elemental real(wp) function modulus(self)
      class(near_field_type), intent(in) :: self

      modulus = 0.0_wp
      if (self%normal > 0.0_wp) modulus = 1.0_wp/self%normal
   end function modulus

   !> B/sqrt(A At - M^2): Dundurs' second parameter (dissertation eq. 6.1; docs/theory.md), positive if
   !> the coupling of the lower body is stronger; 0 without constants.
   elemental real(wp) function beta(self)
      class(near_field_type), intent(in) :: self

      beta = 0.0_wp
      if (self%normal > 0.0_wp) beta = self%coupling/sqrt(self%normal*self%tangential - self%mixed**2)
   end function beta

   !> At/A; 1 without constants.
   elemental real(wp) function shear_ratio(self)
      class(near_field_type), intent(in) :: self

      shear_ratio = 1.0_wp
      if (self%normal > 0.0_wp) shear_ratio = self%tangential/self%normal
   end function shear_ratio

   !> Magnitude of B or M, whichever is larger, over sqrt(A At): 0 where pressure and shear do not affect each other.
   elemental real(wp) function coupling_ratio(self)
      class(near_field_type), intent(in) :: self

      coupling_ratio = 0.0_wp
      if (self%normal > 0.0_wp) coupling_ratio = max(abs(self%coupling), abs(self%mixed))/sqrt(self%normal*self%tangential)
   end function coupling_ratio

   !> Where surfaces slip with tau = f p, their slopes are those of (A + M f) times the integral of p/(t - x) dt/pi, and B f p. At
   !> the edge of the slip zone the exponent 1/2 is changed by 1/pi atan(B f/(A + M f)) (isotropic: Johnson 1985, section 8.1):
   !> that ratio.
   elemental real(wp) function edge_product(self, ratio) result(product)
      class(near_field_type), intent(in) :: self
      real(wp), intent(in) :: ratio

      product = 0.0_wp
      if (abs(self%coupling) > 0.0_wp) product = self%coupling*ratio/(self%normal + self%mixed*ratio)
   end function edge_product

   !> The constants for shear tractions of the other sign.
   elemental type(near_field_type) function with_reversed_shear(self) result(constants)
      class(near_field_type), intent(in) :: self

      constants = near_field_type(self%normal, self%tangential, -self%coupling, -self%mixed)
   end function with_reversed_shear

end module mfv_near_field
