!> Plane isotropic elasticity of one body.
module mfv_material
   use mfv_kinds, only: wp
   implicit none
   private
   public :: material_type, new_material, shear_modulus_of, flexibilities, plane_strain, plane_stress, plane_names

   !> The two plane states.
   integer, parameter :: plane_strain = 1, plane_stress = 2
   character(*), parameter :: plane_names = 'strain stress'

   !> An isotropic material in a plane state.
   type :: material_type
      !> Shear modulus G, force/length^2.
      real(wp) :: shear_modulus = 0.0_wp
      !> Poisson's ratio, in (-1, 0.5].
      real(wp) :: poisson_ratio = 0.0_wp
      !> Kolosov's constant kappa.
      real(wp) :: kolosov = 0.0_wp
   contains
      procedure :: plane_modulus
   end type material_type

contains

   !> Material from shear modulus (force/length^2), Poisson's ratio and plane state, all checked by the caller.
   pure type(material_type) function new_material(shear_modulus, poisson_ratio, plane) result(material)
      real(wp), intent(in) :: shear_modulus, poisson_ratio
      integer, intent(in) :: plane

      material = material_type(shear_modulus, poisson_ratio, kolosov_constant(poisson_ratio, plane))
   end function new_material

   !> Kolosov's constant: 3 - 4 nu in plane strain, (3 - nu)/(1 + nu) in plane stress (Barber 2009, eq. 3.20;
   !> dissertation eq. 6.2).
   pure real(wp) function kolosov_constant(poisson_ratio, plane) result(kolosov)
      real(wp), intent(in) :: poisson_ratio
      integer, intent(in) :: plane

      if (plane == plane_stress) then
         kolosov = (3.0_wp - poisson_ratio)/(1.0_wp + poisson_ratio)
      else
         kolosov = 3.0_wp - 4.0_wp*poisson_ratio
      end if
   end function kolosov_constant

   !> Shear modulus from Young's modulus (both force/length^2) and Poisson's ratio: G = E/(2 (1 + nu)).
   elemental real(wp) function shear_modulus_of(youngs_modulus, poisson_ratio) result(shear_modulus)
      real(wp), intent(in) :: youngs_modulus, poisson_ratio

      shear_modulus = youngs_modulus/(2.0_wp*(1.0_wp + poisson_ratio))
   end function shear_modulus_of

   !> Flexibilities 1/G_1 and 1/G_2, length^2/force, of a lower and an upper body with Poisson's ratio 0, for Dundurs'
   !> parameter `beta`, from -1/2 to 1/2, and the mutual compliance A, length^2/force, the sum of (kappa + 1)/(4 G). With
   !> kappa = 3: 1/G_1 = A (1 + 2 beta)/2 and 1/G_2 = A (1 - 2 beta)/2 (dissertation eq. 6.1). beta = -1/2 or 1/2: one body is
   !> rigid.
   pure function flexibilities(beta, compliance)
      real(wp), intent(in) :: beta, compliance
      real(wp) :: flexibilities(2)

      flexibilities = 0.5_wp*compliance*[1.0_wp + 2.0_wp*beta, 1.0_wp - 2.0_wp*beta]
   end function flexibilities

   !> 4 G/(kappa + 1) = E/(2 (1 - nu^2)) in plane strain, force/length^2: half the contact modulus against a rigid body.
   pure real(wp) function plane_modulus(self)
      class(material_type), intent(in) :: self

      plane_modulus = 4.0_wp*self%shear_modulus/(self%kolosov + 1.0_wp)
   end function plane_modulus

end module mfv_material
