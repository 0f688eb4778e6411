!> Bonded layers on a half-plane or a rigid base: what a wave of tractions exp(i k x) on the surface causes, at any depth.
!>
!> With y out of the body, the vector (k u, k v, sigma_xy, sigma_yy) of such a wave changes within a layer as exp(k y N), N constant
!> (Hooke's law and equilibrium; docs/theory.md). It is continuous between layers, so that the surface compliance Z, (k u, k v) =
!> Z (sigma_xy, sigma_yy), follows from that of the base, step by step upwards:
!>
!>     Z' = (E11 Z + E12) (E21 Z + E22)^-1,   E = exp(k h N)
!>
!> An error decreases with every step, as all but the decaying waves do. exp is its series, in steps k h |N| <= 1, so that nothing
!> overflows or cancels in thick layers, and thin ones keep their digits: Z of a thin layer on a rigid base is E12 in the first
!> place. k may be complex, with a positive real part: Z continued analytically.
module mfv_layers
   use mfv_kinds, only: wp
   use mfv_material, only: material_type
   use mfv_near_field, only: near_field_of, near_field_type
   use mfv_tolerances, only: rounding
   implicit none
   private
   public :: layer_type, layers_type, new_layers, loads, is_moderate, layer_at_depth

   !> One layer.
   type :: layer_type
      !> Length.
      real(wp) :: thickness = 0.0_wp
      type(material_type) :: material
      !> Force/length^2; 0: unknown.
      real(wp) :: yield_strength = 0.0_wp
   end type layer_type

   !> Terms of the series of exp; depth over the length of a wave at which the waves of the surface have decayed to round-off,
   !> twice.
   integer, parameter :: terms = 18
   real(wp), parameter :: deep = 20.0_wp
   !> Waves on the surface: of pressure and of shear.
   integer, parameter :: loads = 2
   complex(wp), parameter :: unity(2, 2) = reshape([1.0_wp, 0.0_wp, 0.0_wp, 1.0_wp], [2, 2])

   !> One layer in terms of waves, or the base.
   type :: wave_layer_type
      real(wp) :: thickness = 0.0_wp
      type(material_type) :: material
      !> N^j/j!, shape (4, 4, 0:terms), and the norm of N in terms of the layer's own stiffness.
      complex(wp) :: power(4, 4, 0:terms) = 0.0_wp
      real(wp) :: norm = 1.0_wp
      !> Least decay of its waves, over k and a depth, and the most that they are shifted along x, over their decay.
      real(wp) :: decay = 1.0_wp, slant = 0.0_wp
      !> Z if it had no lower end.
      complex(wp) :: endless(2, 2) = 0.0_wp
   end type wave_layer_type

   type :: layers_type
      !> From the surface down.
      type(wave_layer_type), allocatable :: layer(:)
      !> The base; without a material it is rigid.
      type(wave_layer_type) :: base
      logical :: rigid_base = .false.
      !> Strains by the stresses sigma_xy and sigma_yy without extension along x, summed over the layers times their thickness,
      !> length^3/force: displacements (u, v) of the surface by uniform tractions.
      real(wp) :: uniform(2, 2) = 0.0_wp
   contains
      procedure :: compliance
      procedure :: stresses
      procedure :: endless_stresses
      procedure :: uniform_stresses
      procedure :: depth_of
      procedure :: decay_of
      procedure :: nearest_image
      procedure :: slant
      procedure :: is_oblique
   end type layers_type

contains

   !> Layers from the surface down on a base; a base without a material is rigid.
   pure type(layers_type) function new_layers(layer, base) result(self)
      type(layer_type), intent(in) :: layer(:)
      type(material_type), intent(in) :: base
      integer :: i

      allocate (self%layer(size(layer)))
      do i = 1, size(layer)
         self%layer(i) = wave_layer_of(layer(i))
         self%uniform = self%uniform + layer(i)%thickness*real(self%layer(i)%power(1:2, 3:4, 1), wp)
      end do
      self%rigid_base = .not. base%exists()
      if (.not. self%rigid_base) self%base = wave_layer_of(layer_type(0.0_wp, base))
   end function new_layers

   !> Whether the stiffnesses of a material along its axes are close enough for the series of exp: otherwise waves that hardly decay
   !> would need too many steps.
   pure logical function is_moderate(material)
      type(material_type), intent(in) :: material
      real(wp), parameter :: most_steps = 1.0e3_wp
      type(wave_layer_type) :: layer

      layer = wave_layer_of(layer_type(1.0_wp, material))
      is_moderate = layer%norm <= most_steps*layer%decay
   end function is_moderate

   pure type(wave_layer_type) function wave_layer_of(layer) result(self)
      type(layer_type), intent(in) :: layer
      complex(wp) :: rate(4, 4)
      real(wp) :: scale
      integer :: j

      self%thickness = layer%thickness
      self%material = layer%material
      rate = rates(layer%material)
      self%power(:, :, 0) = reshape([(merge(1.0_wp, 0.0_wp, modulo(j, 5) == 0), j=0, 15)], [4, 4])
      do j = 1, terms
         self%power(:, :, j) = matmul(rate, self%power(:, :, j - 1))/j
      end do
      scale = sqrt(layer%material%compliance(1)*layer%material%compliance(3))
      rate(1:2, 3:4) = rate(1:2, 3:4)/scale
      rate(3:4, 1:2) = rate(3:4, 1:2)*scale
      self%norm = maxval(sum(abs(rate), dim=2))
      associate (roots => layer%material%roots())
         self%decay = minval(aimag(roots))
         self%slant = maxval(abs(real(roots, wp)))/self%decay
      end associate
      self%endless = endless_compliance(layer%material)
   end function wave_layer_of

   !> N of a material, stresses in force/length^2.
   pure function rates(material)
      type(material_type), intent(in) :: material
      complex(wp) :: rates(4, 4)
      complex(wp), parameter :: i = (0.0_wp, 1.0_wp)
      real(wp) :: across

      associate (s11 => material%compliance(1), s12 => material%compliance(2), s22 => material%compliance(3), &
                 s16 => material%compliance(4), s26 => material%compliance(5), s66 => material%compliance(6))
         across = s22 - s12**2/s11
         ! Exactly zero if incompressible.
         if (material%is_isotropic()) across = (material%kolosov - 1.0_wp)/(material%shear_modulus*(material%kolosov + 1.0_wp))
         rates = 0.0_wp
         rates(1, :) = [i*s16/s11, -i, cmplx(s66 - s16**2/s11, 0.0_wp, wp), cmplx(s26 - s12*s16/s11, 0.0_wp, wp)]
         rates(2, [1, 3, 4]) = [i*s12/s11, cmplx(s26 - s12*s16/s11, 0.0_wp, wp), cmplx(across, 0.0_wp, wp)]
         rates(3, [1, 3, 4]) = [cmplx(1.0_wp/s11, 0.0_wp, wp), i*s16/s11, i*s12/s11]
         rates(4, 3) = -i
      end associate
   end function rates

   !> Z of a half-plane, from the constants of its near field.
   pure function endless_compliance(material) result(z)
      type(material_type), intent(in) :: material
      complex(wp) :: z(2, 2)
      type(near_field_type) :: constants

      constants = near_field_of(material)
      z(1, 1) = constants%tangential
      z(2, 2) = constants%normal
      z(1, 2) = -cmplx(constants%mixed, constants%coupling, wp)
      z(2, 1) = -cmplx(constants%mixed, -constants%coupling, wp)
   end function endless_compliance

   !> Z at the surface of layer `top`, by default the first; size(layer) + 1: at the base.
   pure function compliance(self, k, top) result(z)
      class(layers_type), intent(in) :: self
      complex(wp), intent(in) :: k
      integer, intent(in), optional :: top
      complex(wp) :: z(2, 2)
      real(wp) :: decayed
      integer :: i, first, lowest

      first = 1
      if (present(top)) first = top
      z = self%base%endless
      lowest = size(self%layer)
      decayed = 0.0_wp
      do i = first, size(self%layer)
         decayed = decayed + real(k, wp)*self%layer(i)%decay*self%layer(i)%thickness
         if (decayed < deep) cycle
         z = self%layer(i)%endless
         lowest = i - 1
         exit
      end do
      do i = lowest, first, -1
         call climb(self%layer(i), k*self%layer(i)%thickness, z)
      end do
   end function compliance

   !> Z at the upper side of a layer of the thickness `way` over k from that at its lower side. `down`: is multiplied by the
   !> tractions (sigma_xy, sigma_yy) at the lower side by those at the upper one.
   pure subroutine climb(layer, way, z, down)
      type(wave_layer_type), intent(in) :: layer
      complex(wp), intent(in) :: way
      complex(wp), intent(inout) :: z(2, 2)
      complex(wp), intent(inout), optional :: down(2, 2)
      complex(wp) :: step(4, 4), tractions(2, 2)
      integer :: i, steps

      ! The lower side is not seen, and its tractions vanish.
      if (real(way, wp)*layer%decay > merge(2.0_wp, 1.0_wp, present(down))*deep) then
         z = layer%endless
         if (present(down)) down = 0.0_wp
         return
      end if
      steps = max(ceiling(abs(way)*layer%norm), 1)
      step = exponential(layer, way/steps)
      do i = 1, steps
         tractions = inverse(matmul(step(3:4, 1:2), z) + step(3:4, 3:4))
         z = matmul(matmul(step(1:2, 1:2), z) + step(1:2, 3:4), tractions)
         if (present(down)) down = matmul(down, tractions)
      end do
   end subroutine climb

   !> Stresses (sigma_xx, sigma_yy, sigma_xy) by waves of pressure and of shear on the surface (`loads`), shape (3, loads, depths),
   !> at ascending depths in one layer (size(layer) + 1: the base), lengths. `k`: 1/length.
   pure function stresses(self, k, number, depths) result(values)
      class(layers_type), intent(in) :: self
      complex(wp), intent(in) :: k
      integer, intent(in) :: number
      real(wp), intent(in) :: depths(:)
      complex(wp) :: values(3, loads, size(depths))
      complex(wp), dimension(2, 2) :: z, above
      complex(wp) :: compliances(2, 2, size(depths)), down(2, 2, size(depths))
      real(wp) :: top, to
      integer :: i

      top = self%depth_of(number - 1)
      values = 0.0_wp
      if (number > size(self%layer)) then
         if (self%rigid_base) return
         above = unity
         z = self%base%endless
         do i = size(self%layer), 1, -1
            call climb(self%layer(i), k*self%layer(i)%thickness, z, above)
         end do
         do i = 1, size(depths)
            values(:, :, i) = wave_stress(self%base, self%base%endless, matmul(decayed(self%base, k*(depths(i) - top)), above))
         end do
         return
      end if
      associate (layer => self%layer(number))
         z = self%compliance(k, number + 1)
         to = top + layer%thickness
         do i = size(depths), 1, -1
            ! From here down to what is below, and from above to here.
            call climb(layer, k*(to - depths(i)), z)
            compliances(:, :, i) = z
            to = depths(i)
         end do
         down(:, :, 1) = unity
         call climb(layer, k*(depths(1) - top), z, down(:, :, 1))
         do i = 2, size(depths)
            down(:, :, i) = unity
            z = compliances(:, :, i)
            call climb(layer, k*(depths(i) - depths(i - 1)), z, down(:, :, i))
            down(:, :, i) = matmul(down(:, :, i), down(:, :, i - 1))
         end do
         z = self%compliance(k, number)
         above = unity
         do i = number - 1, 1, -1
            call climb(self%layer(i), k*self%layer(i)%thickness, z, above)
         end do
         do i = 1, size(depths)
            values(:, :, i) = wave_stress(layer, compliances(:, :, i), matmul(down(:, :, i), above))
         end do
      end associate
   end function stresses

   !> The same in an endless first layer.
   pure function endless_stresses(self, k, depths) result(values)
      class(layers_type), intent(in) :: self
      complex(wp), intent(in) :: k
      real(wp), intent(in) :: depths(:)
      complex(wp) :: values(3, loads, size(depths))
      integer :: i

      associate (layer => self%layer(1))
         do i = 1, size(depths)
            values(:, :, i) = wave_stress(layer, layer%endless, decayed(layer, k*depths(i)))
         end do
      end associate
   end function endless_stresses

   !> The same by uniform tractions, without extension along x.
   pure function uniform_stresses(self, number) result(values)
      class(layers_type), intent(in) :: self
      integer, intent(in) :: number
      real(wp) :: values(3, loads)
      complex(wp), parameter :: none(2, 2) = 0.0_wp

      values = real(wave_stress(wave_layer(self, number), none, unity), wp)
   end function uniform_stresses

   !> A layer, or the base.
   pure type(wave_layer_type) function wave_layer(self, number)
      type(layers_type), intent(in) :: self
      integer, intent(in) :: number

      if (number > size(self%layer)) then
         wave_layer = self%base
      else
         wave_layer = self%layer(number)
      end if
   end function wave_layer

   !> Stresses (sigma_xx, sigma_yy, sigma_xy) by a unit pressure and a unit shear on the surface, shape (3, loads). `tractions`:
   !> (sigma_xy, sigma_yy) by those on the surface, `z`: the compliance.
   pure function wave_stress(layer, z, tractions) result(values)
      type(wave_layer_type), intent(in) :: layer
      complex(wp), intent(in) :: z(2, 2), tractions(2, 2)
      complex(wp) :: values(3, loads), strain(2), here(2, loads)
      complex(wp), parameter :: i = (0.0_wp, 1.0_wp)

      here = reshape([-tractions(:, 2), tractions(:, 1)], [2, loads])
      strain = i*matmul(z(1, :), here)
      associate (s => layer%material%compliance)
         values(1, :) = (strain - s(2)*here(2, :) - s(4)*here(1, :))/s(1)
      end associate
      values(2, :) = here(2, :)
      values(3, :) = here(1, :)
   end function wave_stress

   !> Tractions at a depth `way` over k in an endless body by those on its surface, exp(-way G), G = N21 Z + N22. With the mean m of
   !> its eigenvalues and half their difference d, exp(-way m) [cosh(way d) - sinh(way d)/d (G - m)].
   pure function decayed(layer, way) result(tractions)
      type(wave_layer_type), intent(in) :: layer
      complex(wp), intent(in) :: way
      complex(wp) :: tractions(2, 2), rate(2, 2), mean, apart, square, even, odd
      real(wp), parameter :: close = 0.1_wp, nothing = 300.0_wp
      integer :: j

      rate = matmul(layer%power(3:4, 1:2, 1), layer%endless) + layer%power(3:4, 3:4, 1)
      mean = 0.5_wp*(rate(1, 1) + rate(2, 2))
      square = way**2*(mean**2 - rate(1, 1)*rate(2, 2) + rate(1, 2)*rate(2, 1))
      rate = way*(rate - mean*unity)
      tractions = 0.0_wp
      if (real(way*layer%decay, wp) > nothing) return
      if (abs(square) > close) then
         apart = sqrt(square)
         tractions = 0.5_wp*((exp(apart - way*mean) + exp(-apart - way*mean))*unity &
                             - (exp(apart - way*mean) - exp(-apart - way*mean))/apart*rate)
      else
         even = 1.0_wp
         odd = 1.0_wp
         do j = 8, 1, -1
            even = 1.0_wp + even*square/((2*j)*(2*j - 1))
            odd = 1.0_wp + odd*square/((2*j)*(2*j + 1))
         end do
         tractions = exp(-way*mean)*(even*unity - odd*rate)
      end if
   end function decayed

   !> exp(N x), |N x| <= 1.
   pure function exponential(layer, x) result(total)
      type(wave_layer_type), intent(in) :: layer
      complex(wp), intent(in) :: x
      complex(wp) :: total(4, 4)
      integer :: j

      total = layer%power(:, :, terms)
      do j = terms - 1, 0, -1
         total = total*x + layer%power(:, :, j)
      end do
   end function exponential

   pure function inverse(a)
      complex(wp), intent(in) :: a(2, 2)
      complex(wp) :: inverse(2, 2)

      inverse = reshape([a(2, 2), -a(2, 1), -a(1, 2), a(1, 1)], [2, 2])/(a(1, 1)*a(2, 2) - a(1, 2)*a(2, 1))
   end function inverse

   !> Depth of the lower side of a layer, length.
   pure real(wp) function depth_of(self, layer)
      class(layers_type), intent(in) :: self
      integer, intent(in) :: layer

      depth_of = sum(self%layer(:layer)%thickness)
   end function depth_of

   !> Least decay of the waves in a layer, or in the base, over k and a depth.
   pure real(wp) function decay_of(self, number)
      class(layers_type), intent(in) :: self
      integer, intent(in) :: number

      decay_of = self%base%decay
      if (number <= size(self%layer)) decay_of = self%layer(number)%decay
   end function decay_of

   !> Number of the layer at a depth, of two that meet there the upper one, from the thicknesses from the surface down, lengths; one
   !> more than there are: the base.
   pure integer function layer_at_depth(thickness, depth) result(number)
      real(wp), intent(in) :: thickness(:), depth

      do number = 1, size(thickness)
         if (depth <= sum(thickness(:number))*(1.0_wp + 4.0_wp*epsilon(1.0_wp))) return
      end do
   end function layer_at_depth

   !> Distance from the surface to the nearest image of a load there, beyond the first layer: what the layers below add is smooth
   !> over it, length.
   pure real(wp) function nearest_image(self)
      class(layers_type), intent(in) :: self

      nearest_image = 2.0_wp*self%layer(1)%decay*self%layer(1)%thickness
   end function nearest_image

   !> The most that waves in the layers and the base are shifted along x, over their decay.
   pure real(wp) function slant(self)
      class(layers_type), intent(in) :: self

      slant = max(self%base%slant, maxval(self%layer%slant))
   end function slant

   !> Whether the material of a layer, or of the base, has no axes along the surface, beyond round-off of turning it.
   pure logical function is_oblique(self)
      class(layers_type), intent(in) :: self
      integer :: i

      is_oblique = any([(has_none(self%layer(i)%material%compliance), i=1, size(self%layer)), &
                        has_none(self%base%material%compliance)])

   contains

      pure logical function has_none(compliance)
         real(wp), intent(in) :: compliance(6)

         has_none = maxval(abs(compliance(4:5))) > rounding*compliance(1)
      end function has_none
   end function is_oblique

end module mfv_layers
