!> Elasticity of a body: how its surface deforms under tractions.
module mfv_elasticity
   use mfv_circle, only: kernel_exact, new_circle
   use mfv_circle_kernels, only: body_disk, body_hole
   use mfv_compliance, only: compliance_type
   use mfv_half_plane, only: new_half_plane
   use mfv_kinds, only: wp
   use mfv_layer_stress, only: layer_stress_type, new_layer_stress
   use mfv_layered, only: new_layered
   use mfv_layers, only: layer_at_depth, layer_type, layers_type, new_layers
   use mfv_material, only: material_type
   use mfv_matrix_compliance, only: matrix_of, new_matrix_compliance
   use mfv_near_field, only: near_field_of, near_field_type
   implicit none
   private
   public :: elasticity_type, as_half_plane, as_disk, as_hole, as_matrix
   public :: elasticity_own, elasticity_names, layer_names

   !> A half-plane; a disk or a hole of the radius of the surface; a user's matrix.
   integer, parameter :: as_half_plane = 1, as_disk = 2, as_hole = 3, as_matrix = 4
   !> Choices for a body: that of its shape, the first one, or a half-plane, isotropic or not.
   integer, parameter :: elasticity_own = 1
   character(*), parameter :: elasticity_names = 'own half_plane orthotropic anisotropic'
   !> Materials of a layer.
   character(*), parameter :: layer_names = 'isotropic orthotropic anisotropic'

   type :: elasticity_type
      !> One of as_...
      integer :: kind = as_half_plane
      !> At the surface.
      type(material_type) :: material = material_type()
      !> Half-plane: layers bonded on its surface, from there down, and what is below them, rigid without a material.
      type(layer_type), allocatable :: layer(:)
      type(material_type) :: base = material_type()
      !> Stresses in the layers, at the surface; allocated by find_surface_stress.
      type(layer_stress_type), allocatable :: layer_stress
      !> Distance from x = 0 to the datum, the surface point where displacements vanish, length.
      real(wp) :: datum = 0.0_wp
      !> Whether this is a default that depends on the loads or on the mesh, not on the shapes.
      logical :: datum_of_case = .false.
      !> Disk and hole: kernel and harmonics, see mfv_circle.
      integer :: kernel = kernel_exact, harmonics = 0
      !> Matrix: surface length of each node, and displacements by nodal forces.
      real(wp), allocatable :: width(:), matrix(:, :)
      !> Half-plane: length after which the surface repeats; 0: it does not.
      real(wp) :: period = 0.0_wp
   contains
      procedure :: is_circle
      procedure :: is_matrix
      procedure :: is_layered
      procedure :: pressure_stretches
      procedure :: has_datum
      procedure :: layers
      procedure :: layer_count
      procedure :: coat
      procedure :: find_surface_stress
      procedure :: prepare_stress
      procedure :: material_of
      procedure :: thickness
      procedure :: depth_of
      procedure :: layer_at
      procedure :: near_field
      procedure :: near_field_over
      procedure :: strain_by_bulk_stress
      procedure :: make_compliance
   end type elasticity_type

contains

   !> Whether the body deforms as a disk or as the plane around a hole.
   elemental logical function is_circle(self)
      class(elasticity_type), intent(in) :: self

      is_circle = self%kind == as_disk .or. self%kind == as_hole
   end function is_circle

   !> Whether it is a user's matrix, which has its own nodes, and no stresses inside.
   elemental logical function is_matrix(self)
      class(elasticity_type), intent(in) :: self

      is_matrix = self%kind == as_matrix
   end function is_matrix

   !> Whether it has layers.
   pure logical function is_layered(self)
      class(elasticity_type), intent(in) :: self

      is_layered = self%layer_count() > 0
   end function is_layered

   !> Number of its layers.
   pure integer function layer_count(self)
      class(elasticity_type), intent(in) :: self

      layer_count = 0
      if (allocated(self%layer)) layer_count = size(self%layer)
   end function layer_count

   !> Whether a pressure can cause tension along a straight surface: by its material, see mfv_material, on layers, or where it
   !> repeats, as its mean strain is zero there.
   pure logical function pressure_stretches(self)
      class(elasticity_type), intent(in) :: self

      pressure_stretches = self%material%pressure_stretches() .or. self%is_layered() .or. self%period > 0.0_wp
   end function pressure_stretches

   !> Whether displacements are measured at a datum: not above a rigid base, nor of a matrix.
   pure logical function has_datum(self)
      class(elasticity_type), intent(in) :: self

      has_datum = .not. self%is_matrix()
      if (self%is_layered()) has_datum = self%base%exists()
   end function has_datum

   !> Its layers, in terms of waves.
   pure type(layers_type) function layers(self)
      class(elasticity_type), intent(in) :: self

      layers = new_layers(self%layer, self%base)
   end function layers

   !> Put layers, from the surface down, on the body as it is, or on a rigid one.
   pure subroutine coat(self, layer, rigid)
      class(elasticity_type), intent(inout) :: self
      type(layer_type), intent(in) :: layer(:)
      logical, intent(in) :: rigid

      self%kind = as_half_plane
      self%base = material_type()
      if (.not. rigid) self%base = self%material
      self%layer = layer
      self%material = layer(1)%material
   end subroutine coat

   !> Find the stresses at the surface of layers and their interfaces, for distances up to many times `length`, unless they are
   !> known; none without layers.
   subroutine find_surface_stress(self, length)
      class(elasticity_type), intent(inout) :: self
      real(wp), intent(in) :: length
      !> In lengths of the mesh, and in thicknesses of the layers.
      real(wp), parameter :: distant(2) = [20.0_wp, 10.0_wp]
      real(wp) :: reach

      if (.not. self%is_layered()) return
      reach = maxval(distant*[length, self%thickness()])
      if (allocated(self%layer_stress)) then
         if (self%layer_stress%reach >= reach) return
         deallocate (self%layer_stress)
      end if
      allocate (self%layer_stress, source=new_layer_stress(self%layers(), self%period, reach))
   end subroutine find_surface_stress

   !> Make stresses in layers quick down to the depth `deepest`, length.
   subroutine prepare_stress(self, deepest)
      class(elasticity_type), intent(inout) :: self
      real(wp), intent(in) :: deepest

      if (allocated(self%layer_stress)) call self%layer_stress%prepare(deepest)
   end subroutine prepare_stress

   !> The material of a layer, from the surface down, or of the base.
   pure type(material_type) function material_of(self, layer) result(material)
      class(elasticity_type), intent(in) :: self
      integer, intent(in) :: layer

      material = self%material
      if (.not. self%is_layered()) return
      material = self%base
      if (layer <= size(self%layer)) material = self%layer(layer)%material
   end function material_of

   !> Thickness of all layers, length.
   pure real(wp) function thickness(self)
      class(elasticity_type), intent(in) :: self

      thickness = 0.0_wp
      if (self%is_layered()) thickness = self%depth_of(size(self%layer))
   end function thickness

   !> Depth of the lower side of a layer below the surface, length.
   pure real(wp) function depth_of(self, layer) result(depth)
      class(elasticity_type), intent(in) :: self
      integer, intent(in) :: layer

      depth = sum(self%layer(:layer)%thickness)
   end function depth_of

   !> Number of the layer at a depth below the surface, length, of two that meet there the upper one; layer_count + 1: the base.
   pure integer function layer_at(self, depth) result(number)
      class(elasticity_type), intent(in) :: self
      real(wp), intent(in) :: depth

      number = 1
      if (self%is_layered()) number = layer_at_depth(self%layer%thickness, depth)
   end function layer_at

   !> The constants for tractions that vary over a length: of the near field or, with layers, of a wave of this length over 2 pi.
   pure type(near_field_type) function near_field_over(self, length) result(constants)
      class(elasticity_type), intent(in) :: self
      real(wp), intent(in) :: length
      type(layers_type) :: layers
      complex(wp) :: z(2, 2)

      constants = self%near_field()
      if (.not. self%is_layered()) return
      layers = self%layers()
      z = layers%compliance(cmplx(1.0_wp/length, 0.0_wp, wp))
      constants = near_field_type(real(z(2, 2), wp), real(z(1, 1), wp), -aimag(z(1, 2)), -real(z(1, 2), wp))
   end function near_field_over

   !> Constants of its near field, 0 without a material.
   elemental type(near_field_type) function near_field(self) result(constants)
      class(elasticity_type), intent(in) :: self

      constants = near_field_of(self%material)
   end function near_field

   !> Strain along the surface per uniform stress in its direction, length^2/force: s11 of mfv_material; isotropic: 1/E in plane
   !> stress, (1 - nu^2)/E in plane strain. With layers: of the stress in their base.
   pure real(wp) function strain_by_bulk_stress(self) result(strain)
      class(elasticity_type), intent(in) :: self

      strain = self%material%compliance(1)
      if (self%is_layered()) strain = self%base%compliance(1)
   end function strain_by_bulk_stress

   !> Compliance with `nodes` intervals of the width `interval` (length) of a surface of the radius `radius` (circles).
   !> `coupling`, `tangential`: see mfv_compliance. `common_radius`: with radial normals, radius of the arc with the nodes of
   !> both bodies, to which tractions refer (length); else 0. `ends`: of unequal intervals, arc lengths, shape (nodes + 1).
   !> `middle`: see new_circle.
   subroutine make_compliance(self, radius, nodes, interval, coupling, tangential, common_radius, compliance, ends, &
                              middle)
      class(elasticity_type), intent(in) :: self
      integer, intent(in) :: nodes, coupling
      real(wp), intent(in) :: radius, interval, common_radius
      logical, intent(in) :: tangential
      class(compliance_type), allocatable, intent(out) :: compliance
      real(wp), intent(in), optional :: ends(:), middle
      class(compliance_type), allocatable :: graded
      real(wp) :: of_arc

      select case (self%kind)
      case (as_disk, as_hole)
         of_arc = merge(common_radius, radius, common_radius > 0.0_wp)
         allocate (compliance, source=new_circle(merge(body_disk, body_hole, self%kind == as_disk), self%material, of_arc, nodes, &
                                                 interval, self%datum*(of_arc/radius), self%kernel, self%harmonics, coupling, &
                                                 tangential, common_radius > 0.0_wp, ends, middle))
      case (as_matrix)
         allocate (compliance, source=new_matrix_compliance(self%matrix, self%width, coupling, tangential))
      case default
         if (self%is_layered()) then
            allocate (compliance, source=new_layered(self%layers(), self%near_field(), nodes, interval, self%datum, coupling, &
                                                     tangential, self%period, ends))
         else
            allocate (compliance, source=new_half_plane(self%near_field(), nodes, interval, self%datum, coupling, tangential, &
                                                        ends, self%period))
         end if
      end select
      if (.not. present(ends)) return
      call move_alloc(compliance, graded)
      allocate (compliance, source=matrix_of(graded))
   end subroutine make_compliance

end module mfv_elasticity
