!> Plane elasticity of one body: isotropic, or with a plane of symmetry parallel to that of the problem.
!>
!> The strains in the plane are (exx, eyy, gxy) = s (sxx, syy, sxy), s symmetric: the compliances in plane stress, those reduced by
!> ezz = 0 in plane strain. The stresses are sums of functions of x + mu1 y and x + mu2 y, mu1 and mu2 the roots of
!>
!>     s11 mu^4 - 2 s16 mu^3 + (2 s12 + s66) mu^2 - 2 s26 mu + s22 = 0
!>
!> with positive imaginary parts (docs/theory.md). Only their sum and product are needed, which keep all digits where the roots
!> coincide: mu1 = mu2 = i of an isotropic material.
module mfv_material
   use mfv_kinds, only: wp
   implicit none
   private
   public :: material_type, new_material, new_orthotropic_material, new_anisotropic_material
   public :: shear_modulus_of, flexibilities, plane_strain, plane_stress, plane_names

   !> The two plane states.
   integer, parameter :: plane_strain = 1, plane_stress = 2
   character(*), parameter :: plane_names = 'strain stress'

   !> A material in a plane state, seen from a body below its surface: x to the right, y out of the body.
   type :: material_type
      !> Isotropic: shear modulus G, force/length^2; Poisson's ratio, in (-1, 0.5]; Kolosov's constant kappa. Else 0.
      real(wp) :: shear_modulus = 0.0_wp, poisson_ratio = 0.0_wp, kolosov = 0.0_wp
      !> s11, s12, s22, s16, s26 and s66 of the plane state, length^2/force; 0 without a material.
      real(wp) :: compliance(6) = 0.0_wp
      !> sigma_zz by sigma_xx, sigma_yy and sigma_xy: 0 in plane stress.
      real(wp) :: out_of_plane(3) = 0.0_wp
      !> mu1 + mu2 and mu1 mu2.
      complex(wp) :: root_sum = (0.0_wp, 2.0_wp), root_product = (-1.0_wp, 0.0_wp)
   contains
      procedure :: exists
      procedure :: is_isotropic
      procedure :: is_anisotropic
      procedure :: plane_modulus
      procedure :: roots
      procedure :: stress_out_of_plane
      procedure :: pressure_stretches
      procedure :: lateral_ratio
      procedure :: mirrored
   end type material_type

   !> Indices of material_type%compliance.
   integer, parameter :: s11 = 1, s12 = 2, s22 = 3, s16 = 4, s26 = 5, s66 = 6

contains

   !> Material from shear modulus (force/length^2), Poisson's ratio and plane state, all checked by the caller.
   pure type(material_type) function new_material(shear_modulus, poisson_ratio, plane) result(material)
      real(wp), intent(in) :: shear_modulus, poisson_ratio
      integer, intent(in) :: plane

      material%shear_modulus = shear_modulus
      material%poisson_ratio = poisson_ratio
      material%kolosov = kolosov_constant(poisson_ratio, plane)
      material%compliance(s66) = 1.0_wp/shear_modulus
      material%compliance([s11, s22]) = 0.5_wp/material%plane_modulus()
      material%compliance(s12) = material%compliance(s11) - 0.5_wp/shear_modulus
      if (plane == plane_strain) material%out_of_plane(:2) = poisson_ratio
   end function new_material

   !> Orthotropic material. `youngs`: E1, E2, E3; `poisson`: nu12, nu13, nu23, the contraction along the second axis over the strain
   !> along the first under a stress along the first; `shear_modulus`: G12. Moduli in force/length^2; E3, nu13 and nu23 have no
   !> effect in plane stress. `angle`: counterclockwise from x to the first axis, radians. `valid`: the material is stable.
   pure subroutine new_orthotropic_material(youngs, poisson, shear_modulus, plane, angle, material, valid)
      real(wp), intent(in) :: youngs(3), poisson(3), shear_modulus, angle
      integer, intent(in) :: plane
      type(material_type), intent(out) :: material
      logical, intent(out) :: valid
      real(wp) :: compliance(10)

      compliance = 0.0_wp
      compliance([s11, s22, s66]) = 1.0_wp/[youngs(:2), shear_modulus]
      compliance(s12) = -poisson(1)/youngs(1)
      compliance(7:9) = [-poisson(2)/youngs(1), -poisson(3)/youngs(2), 1.0_wp/youngs(3)]
      if (plane == plane_stress) then
         call new_anisotropic_material(compliance(:6), angle, material, valid)
      else
         call new_anisotropic_material(compliance, angle, material, valid)
      end if
   end subroutine new_orthotropic_material

   !> Material from its compliances S11, S12, S22, S16, S26, S66 and, in plane strain, S13, S23, S33, S36, length^2/force. `angle`:
   !> counterclockwise from x to their first axis, radians. `valid`: the material is stable.
   pure subroutine new_anisotropic_material(compliance, angle, material, valid)
      real(wp), intent(in) :: compliance(:), angle
      type(material_type), intent(out) :: material
      logical, intent(out) :: valid
      real(wp) :: by_z(3)

      material%compliance = compliance(:6)
      if (size(compliance) > 6) then
         valid = compliance(9) > 0.0_wp
         if (.not. valid) return
         by_z = compliance([7, 8, 10])
         material%out_of_plane = -by_z/compliance(9)
         material%compliance = material%compliance + material%out_of_plane([1, 1, 2, 1, 2, 3])*by_z([1, 2, 2, 3, 3, 3])
      end if
      call turn(material, angle)
      valid = is_stable(material%compliance)
      if (valid) call find_roots(material)
   end subroutine new_anisotropic_material

   !> Turn a material counterclockwise by an angle, radians. With T the stresses along its axes by those along x and y, the
   !> compliances are T' S T, with the engineering shear strain.
   pure subroutine turn(material, angle)
      type(material_type), intent(inout) :: material
      real(wp), intent(in) :: angle
      real(wp) :: stress(3, 3), turned(3, 3), c, s

      if (.not. abs(angle) > 0.0_wp) return
      c = cos(angle)
      s = sin(angle)
      ! Axes along x and y after a quarter turn, too.
      if (abs(c) < epsilon(1.0_wp)) c = 0.0_wp
      if (abs(s) < epsilon(1.0_wp)) s = 0.0_wp
      stress = reshape([c**2, s**2, -s*c, s**2, c**2, s*c, 2.0_wp*s*c, -2.0_wp*s*c, c**2 - s**2], [3, 3])
      turned = matmul(transpose(stress), matmul(matrix_of(material%compliance), stress))
      material%compliance = [turned(1, 1), turned(1, 2), turned(2, 2), turned(1, 3), turned(2, 3), turned(3, 3)]
      material%out_of_plane = matmul(material%out_of_plane, stress)
   end subroutine turn

   !> The symmetric matrix of six compliances.
   pure function matrix_of(compliance) result(matrix)
      real(wp), intent(in) :: compliance(6)
      real(wp) :: matrix(3, 3)

      matrix = reshape(compliance([s11, s12, s16, s12, s22, s26, s16, s26, s66]), [3, 3])
   end function matrix_of

   !> Whether no stress in the plane releases energy: the compliances are positive definite or, of an incompressible material,
   !> semidefinite.
   pure logical function is_stable(s)
      real(wp), intent(in) :: s(6)
      real(wp), parameter :: least = 1.0e-12_wp
      real(wp) :: minor

      is_stable = s(s11) > 0.0_wp .and. s(s22) > 0.0_wp .and. s(s66) > 0.0_wp
      if (.not. is_stable) return
      minor = s(s11)*s(s22) - s(s12)**2
      is_stable = minor > -least*s(s11)*s(s22) .and. &
                  s(s66)*minor - s(s11)*s(s26)**2 - s(s22)*s(s16)**2 + 2.0_wp*s(s12)*s(s16)*s(s26) > -least*s(s66)*s(s11)*s(s22)
   end function is_stable

   !> Sum a + i b and product c + i d of the roots, from (mu^2 - (a + i b) mu + c + i d)(mu^2 - (a - i b) mu + c - i d): a =
   !> s16/s11, 2 c = k - b^2, b d = s26/s11 - a c and c^2 + d^2 = s22/s11, k = (2 s12 + s66)/s11 - a^2. So b^2 is a root of a
   !> cubic; the largest, for the other pairs of the four roots have smaller sums of imaginary parts. Newton's iteration descends
   !> to it from above; the other roots are apart: (Im mu1 - Im mu2)^2 and -(Re mu1 - Re mu2)^2.
   pure subroutine find_roots(material)
      type(material_type), intent(inout) :: material
      real(wp) :: a, k, skew, last, square, next, c, d, slope
      integer, parameter :: most = 100
      real(wp), parameter :: nothing = 64.0_wp*epsilon(1.0_wp)
      integer :: i

      associate (s => material%compliance)
         a = s(s16)/s(s11)
         k = (2.0_wp*s(s12) + s(s66))/s(s11) - a**2
         skew = s(s26)/s(s11)
         last = s(s22)/s(s11)
      end associate
      ! At a root c**2 <= last, so that the square is at most this.
      square = k + 2.0_wp*sqrt(last)
      do i = 1, most
         c = 0.5_wp*(k - square)
         d = skew - a*c
         ! c^2 y + d^2 - last y and its derivative by y = b^2.
         slope = c**2 - last - c*square + a*d
         if (.not. slope > 0.0_wp) exit
         next = square - ((c**2 - last)*square + d**2)/slope
         if (.not. next < square) exit
         square = next
      end do
      c = 0.5_wp*(k - square)
      d = (skew - a*c)/sqrt(square)
      ! Of materials that are symmetric about the surface the first and the last part vanish, but for round-off of a turn.
      if (abs(a) < nothing*sqrt(square)) a = 0.0_wp
      if (abs(d) < nothing*sqrt(last)) d = 0.0_wp
      if (d**2 < 0.5_wp*last) c = sign(sqrt(last - d**2), c)
      material%root_sum = cmplx(a, sqrt(square), wp)
      material%root_product = cmplx(c, d, wp)
   end subroutine find_roots

   !> Whether there is a material.
   elemental logical function exists(self)
      class(material_type), intent(in) :: self

      exists = self%compliance(s11) > 0.0_wp
   end function exists

   !> Whether it is isotropic: given by G and nu.
   elemental logical function is_isotropic(self)
      class(material_type), intent(in) :: self

      is_isotropic = self%shear_modulus > 0.0_wp
   end function is_isotropic

   !> Whether there is a material that is not isotropic.
   elemental logical function is_anisotropic(self)
      class(material_type), intent(in) :: self

      is_anisotropic = self%exists() .and. .not. self%is_isotropic()
   end function is_anisotropic

   !> mu1 and mu2, each with half the digits where they nearly coincide, but none less for their sum and product.
   pure function roots(self)
      class(material_type), intent(in) :: self
      complex(wp) :: roots(2), apart

      apart = sqrt(0.25_wp*self%root_sum**2 - self%root_product)
      roots = 0.5_wp*self%root_sum + [-apart, apart]
   end function roots

   !> sigma_zz, force/length^2, beside the stresses sigma_xx, sigma_yy and sigma_xy in the plane.
   pure real(wp) function stress_out_of_plane(self, in_plane) result(stress)
      class(material_type), intent(in) :: self
      real(wp), intent(in) :: in_plane(3)

      stress = sum(self%out_of_plane*in_plane)
   end function stress_out_of_plane

   !> Whether a pressure can cause tension along a straight surface, see surface_stress_of in mfv_interior_half_plane: not where
   !> it is isotropic or the axes of an orthotropic material are along the surface and normal to it.
   elemental logical function pressure_stretches(self)
      class(material_type), intent(in) :: self

      pressure_stretches = abs(aimag(self%root_product)) > 0.0_wp .or. real(self%root_product, wp) > 0.0_wp
   end function pressure_stretches

   !> Stress along the surface over the mean pressure of surfaces that repeat, without which their mean strain would not be zero:
   !> B/s11 of mfv_near_field.
   pure real(wp) function lateral_ratio(self)
      class(material_type), intent(in) :: self

      lateral_ratio = self%compliance(s12)/self%compliance(s11) - real(self%root_product, wp)
   end function lateral_ratio

   !> The material of the mirror image at the surface: that of an upper body, seen as a lower one.
   pure type(material_type) function mirrored(self) result(image)
      class(material_type), intent(in) :: self

      image = self
      image%compliance([s16, s26]) = -image%compliance([s16, s26])
      image%out_of_plane(3) = -image%out_of_plane(3)
      image%root_sum = -conjg(image%root_sum)
      image%root_product = conjg(image%root_product)
   end function mirrored

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
