!> Near field of an elastic body: how its surface deforms close to a load. On every body with a smooth surface the displacements by
!> line forces P into it and Q along it are
!>
!>     w by P:  -(A/pi) ln|x|      u by Q:  -(At/pi) ln|x|      w by Q:  B/2 sgn x      u by P: -B/2 sgn x
!>
!> up to smooth functions; A = At = (kappa + 1)/(4 G) and B = (kappa - 1)/(4 G) of an isotropic material (Johnson 1985, section 2.2;
!> Barber 2010, chapter 12). Edges, scales and closed forms need no more of a body's elasticity than these constants.
module mfv_near_field
   use mfv_kinds, only: wp
   use mfv_material, only: material_type
   implicit none
   private
   public :: near_field_type, near_field_of, pair_of

   !> A, At and B of a body or, with B the difference of lower and upper body, a pair, length^2/force; 0 of a rigid body.
   type :: near_field_type
      real(wp) :: normal = 0.0_wp, tangential = 0.0_wp, coupling = 0.0_wp
   contains
      procedure :: modulus
      procedure :: beta
   end type near_field_type

contains

   !> Constants of a material; 0 without one.
   elemental type(near_field_type) function near_field_of(material) result(constants)
      type(material_type), intent(in) :: material

      if (.not. material%shear_modulus > 0.0_wp) return
      constants%normal = 1.0_wp/material%plane_modulus()
      constants%tangential = constants%normal
      constants%coupling = (material%kolosov - 1.0_wp)/(4.0_wp*material%shear_modulus)
   end function near_field_of

   !> Constants of two bodies together, the upper one upside down: A and At add, B subtract.
   elemental type(near_field_type) function pair_of(lower, upper) result(pair)
      type(near_field_type), intent(in) :: lower, upper

      pair = near_field_type(lower%normal + upper%normal, lower%tangential + upper%tangential, lower%coupling - upper%coupling)
   end function pair_of

   !> 1/A, force/length^2: half the contact modulus E* of an isotropic body; 0 without constants.
   elemental real(wp) function modulus(self)
      class(near_field_type), intent(in) :: self

      modulus = 0.0_wp
      if (self%normal > 0.0_wp) modulus = 1.0_wp/self%normal
   end function modulus

   !> B/sqrt(A At): Dundurs' second parameter (dissertation eq. 6.1), positive if the coupling of the lower body is stronger; 0
   !> without constants.
   elemental real(wp) function beta(self)
      class(near_field_type), intent(in) :: self

      beta = 0.0_wp
      if (self%normal > 0.0_wp) beta = self%coupling/sqrt(self%normal*self%tangential)
   end function beta

end module mfv_near_field
