!> The bodies of a case, from its text.
module mfv_body_reader
   use mfv_body, only: body_type, new_body
   use mfv_geometry
   use mfv_circle, only: kernel_fourier
   use mfv_elasticity, only: as_half_plane, elasticity_own
   use mfv_error, only: error_type
   use mfv_key_reader
   use mfv_kinds, only: pi, wp
   use mfv_layers, only: is_moderate, layer_type
   use mfv_material, only: material_type, new_anisotropic_material, new_material, new_orthotropic_material, plane_stress, &
                           shear_modulus_of
   use mfv_matrix_file, only: read_matrix_body
   use mfv_profile, only: trace_type
   use mfv_profile_file, only: read_profile
   use mfv_scene, only: both_rigid, scene_type
   use mfv_scene_indenter, only: default_datum, touches_everywhere
   use mfv_strings, only: has_word, list_of_words, string_type, to_text
   implicit none
   private
   public :: check_bodies, read_body, check_pair, check_matrix, read_datums

   real(wp), parameter :: degree = pi/180.0_wp
   !> Keys of an orthotropic material, in the order of new_orthotropic_material; three of them not in plane stress.
   character(*), parameter :: orthotropic_keys = 'youngs_modulus_1 youngs_modulus_2 poisson_ratio_12 shear_modulus_12'
   character(*), parameter :: plane_strain_keys = 'youngs_modulus_3 poisson_ratio_13 poisson_ratio_23'

contains

   !> Two bodies with a shape each, of which one at least is elastic.
   subroutine check_bodies(reader, error)
      type(reader_type), intent(in) :: reader
      type(error_type), allocatable, intent(out) :: error
      integer :: body

      if (count_groups(reader, 'body') /= 2) then
         call fail(reader, 0, '&body: exactly two are needed, first the lower body, then the upper one; found '// &
                   to_text(count_groups(reader, 'body')), error)
         return
      end if
      do body = 1, 2
         call reader%need('body', body, 'shape', error)
         if (allocated(error)) return
      end do
      call check_layer_keys(reader, error)
      if (allocated(error)) return
      if (reader%logical_value('body', 1, 'rigid') .and. reader%logical_value('body', 2, 'rigid') .and. &
          count_groups(reader, 'layer') == 0) then
         call reader%complain('body', 2, 'rigid', both_rigid, error)
      else if (reader%text_value('body', 2, 'shape') == 'matrix') then
         call reader%complain('body', 2, 'shape', 'a matrix must be the first body, the lower one', error)
      else if (reader%text_value('body', 1, 'shape') == 'matrix' .and. &
               .not. (reader%logical_value('body', 2, 'rigid') .and. size(layers_of(reader, 2)) == 0)) then
         call reader%complain('body', 2, 'rigid', 'must be .true. if the lower body is a matrix; put the '// &
                              'compliance of both bodies into the matrix', error)
      end if
      do body = 1, 2
         if (.not. allocated(error)) call check_body_keys(reader, body, error)
      end do
   end subroutine check_bodies

   !> Error for layers without a body, thickness or material, or with keys that have no effect.
   subroutine check_layer_keys(reader, error)
      type(reader_type), intent(in) :: reader
      type(error_type), allocatable, intent(out) :: error
      type(string_type), allocatable :: keys(:)
      character(:), allocatable :: allowed
      integer :: i, number

      keys = reader%catalogue%names('layer')
      do number = 1, count_groups(reader, 'layer')
         call reader%need('layer', number, 'body', error)
         if (.not. allocated(error)) call reader%need('layer', number, 'thickness', error)
         if (allocated(error)) return
         if (number > 1) then
            if (reader%integer_value('layer', number, 'body') < reader%integer_value('layer', number - 1, 'body')) then
               call reader%complain('layer', number, 'body', 'must not be below that of the layer before: give the layers of '// &
                                    'body 1 first', error)
               return
            end if
         end if
         allowed = 'body thickness elasticity yield_strength '// &
                   trim(material_keys(reader%text_value('layer', number, 'elasticity')))
         do i = 1, size(keys)
            if (.not. reader%has('layer', number, keys(i)%text) .or. has_word(allowed, keys(i)%text)) cycle
            call reader%complain('layer', number, keys(i)%text, "has no effect with elasticity='"// &
                                 reader%text_value('layer', number, 'elasticity')//"'; its keys are "//allowed, error)
            return
         end do
      end do
   end subroutine check_layer_keys

   !> The numbers of the groups &layer of a body, from the surface down.
   pure function layers_of(reader, body) result(numbers)
      type(reader_type), intent(in) :: reader
      integer, intent(in) :: body
      integer, allocatable :: numbers(:)
      integer :: i

      numbers = pack([(i, i=1, count_groups(reader, 'layer'))], &
                     [(reader%integer_value('layer', i, 'body') == body, i=1, count_groups(reader, 'layer'))])
   end function layers_of

   !> Error for keys that have no effect for the shape of their body.
   subroutine check_body_keys(reader, body, error)
      type(reader_type), intent(in) :: reader
      integer, intent(in) :: body
      type(error_type), allocatable, intent(out) :: error
      type(string_type), allocatable :: keys(:)
      character(:), allocatable :: shape, allowed, elasticity
      logical :: rigid
      integer :: i

      shape = reader%text_value('body', body, 'shape')
      rigid = reader%logical_value('body', body, 'rigid')
      if (shape == 'flat_punch' .and. .not. rigid) then
         call reader%complain('body', body, 'rigid', 'must be .true. for a flat_punch', error)
         return
      end if
      allowed = 'shape rigid'
      if (needed_keys(shape) /= '') allowed = allowed//' '//trim(needed_keys(shape))
      if (shape == 'profile') allowed = allowed//' interpolation position_scale height_scale level centred'
      associate (layers => layers_of(reader, body))
         if ((shape == 'matrix' .or. shape == 'flat_punch') .and. size(layers) > 0) then
            call reader%complain('layer', layers(1), 'body', 'a '//shape//' cannot have layers', error)
            return
         end if
      end associate
      if (shape /= 'matrix' .and. .not. rigid) then
         elasticity = reader%text_value('body', body, 'elasticity')
         allowed = allowed//' elasticity yield_strength datum '//trim(material_keys(elasticity))
         if (reader%has('body', body, 'elasticity') .and. elasticity == 'own' .and. size(layers_of(reader, body)) > 0) then
            call reader%complain('body', body, 'elasticity', "must be 'half_plane' with layers, or be omitted: so does the "// &
                                 'body deform', error)
            return
         end if
         if (size(layers_of(reader, body)) > 0) shape = shape//' with layers'
         if (elasticity /= 'own') then
            shape = shape//" with elasticity='"//elasticity//"'"
         else if ((shape == 'disk' .or. shape == 'hole') .and. size(layers_of(reader, body)) == 0) then
            allowed = allowed//' kernel harmonics'
         end if
      end if
      keys = reader%catalogue%names('body')
      do i = 1, size(keys)
         if (.not. reader%has('body', body, keys(i)%text) .or. has_word(allowed, keys(i)%text)) cycle
         call reader%complain('body', body, keys(i)%text, 'has no effect for a'//trim(merge(' rigid', '      ', rigid))// &
                              ' '//shape//'; its keys are '//allowed, error)
         return
      end do
   end subroutine check_body_keys

   !> The keys of a material for a choice of elasticity, separated by blanks; padded with blanks.
   pure function material_keys(elasticity) result(keys)
      character(*), intent(in) :: elasticity
      character(len=160) :: keys

      select case (elasticity)
      case ('orthotropic')
         keys = orthotropic_keys//' '//plane_strain_keys//' axis_angle'
      case ('anisotropic')
         keys = 'compliances axis_angle'
      case default
         keys = 'shear_modulus youngs_modulus poisson_ratio'
      end select
   end function material_keys

   !> The keys that a shape needs, separated by blanks; padded with blanks.
   pure function needed_keys(shape) result(keys)
      character(*), intent(in) :: shape
      character(len=40) :: keys

      select case (shape)
      case ('disk', 'hole')
         keys = 'radius'
      case ('flat_punch')
         keys = 'half_width'
      case ('rounded_punch')
         keys = 'half_width edge_radius'
      case ('wedge')
         keys = 'angle'
      case ('power')
         keys = 'coefficient exponent'
      case ('wave')
         keys = 'amplitude wavelength'
      case ('edge')
         keys = 'normal_intensity edge_length'
      case ('profile', 'matrix')
         keys = 'file'
      case default
         keys = ''
      end select
   end function needed_keys

   !> One body: shape, then material.
   subroutine read_body(reader, number, plane, body, error)
      type(reader_type), intent(in) :: reader
      integer, intent(in) :: number, plane
      type(body_type), intent(out) :: body
      type(error_type), allocatable, intent(out) :: error

      call read_shape(reader, number, body, error)
      if (allocated(error)) return
      body%rigid = reader%logical_value('body', number, 'rigid')
      if (body%rigid .or. body%is_matrix()) then
         call read_layers(reader, number, plane, body, error)
         return
      end if
      call read_material('body', reader, number, plane, number == 2, body%elasticity%material, error)
      if (allocated(error)) return
      if (reader%choice('body', number, 'elasticity') /= elasticity_own) body%elasticity%kind = as_half_plane
      body%yield_strength = reader%real_value('body', number, 'yield_strength')
      body%elasticity%kernel = reader%choice('body', number, 'kernel')
      body%elasticity%harmonics = reader%integer_value('body', number, 'harmonics')
      if (body%elasticity%harmonics > 0 .and. body%elasticity%kernel /= kernel_fourier) &
         call reader%complain('body', number, 'harmonics', "has no effect without kernel='fourier'; remove it", error)
      if (.not. allocated(error)) call read_layers(reader, number, plane, body, error)
   end subroutine read_body

   !> Bond the layers of a body on it.
   subroutine read_layers(reader, number, plane, body, error)
      type(reader_type), intent(in) :: reader
      integer, intent(in) :: number, plane
      type(body_type), intent(inout) :: body
      type(error_type), allocatable, intent(out) :: error
      integer, allocatable :: numbers(:)
      type(layer_type), allocatable :: layer(:)
      integer :: i

      numbers = layers_of(reader, number)
      if (size(numbers) == 0) return
      allocate (layer(size(numbers)))
      do i = 1, size(numbers)
         layer(i)%thickness = reader%real_value('layer', numbers(i), 'thickness')
         layer(i)%yield_strength = reader%real_value('layer', numbers(i), 'yield_strength')
         call read_material('layer', reader, numbers(i), plane, number == 2, layer(i)%material, error)
         if (.not. allocated(error) .and. .not. is_moderate(layer(i)%material)) &
            call reader%complain('layer', numbers(i), 'elasticity', 'the moduli of the layer differ too much: some of its '// &
                                 'waves hardly decay, and its kernels would take too long', error)
         if (allocated(error)) return
      end do
      call body%elasticity%coat(layer, body%rigid)
      body%rigid = .false.
   end subroutine read_layers

   !> The elastic material of a body or a layer; `upside_down`: that of the upper body, seen from below, as its mirror image.
   subroutine read_material(group, reader, number, plane, upside_down, material, error)
      character(*), intent(in) :: group
      type(reader_type), intent(in) :: reader
      integer, intent(in) :: number, plane
      logical, intent(in) :: upside_down
      type(material_type), intent(out) :: material
      type(error_type), allocatable, intent(out) :: error

      select case (reader%text_value(group, number, 'elasticity'))
      case ('orthotropic')
         call read_orthotropic(group, reader, number, plane, material, error)
      case ('anisotropic')
         call read_anisotropic(group, reader, number, plane, material, error)
      case default
         call read_isotropic(group, reader, number, plane, material, error)
         return
      end select
      if (upside_down) material = material%mirrored()
   end subroutine read_material

   subroutine read_shape(reader, number, body, error)
      type(reader_type), intent(in) :: reader
      integer, intent(in) :: number
      type(body_type), intent(out) :: body
      type(error_type), allocatable, intent(out) :: error
      character(:), allocatable :: shape
      type(string_type), allocatable :: needed(:)
      integer :: i

      shape = reader%text_value('body', number, 'shape')
      needed = list_of_words(needed_keys(shape))
      do i = 1, size(needed)
         call reader%need('body', number, needed(i)%text, error)
         if (allocated(error)) return
      end do
      select case (shape)
      case ('half_plane')
         body = new_body(new_half_plane_surface())
      case ('disk')
         body = new_body(new_disk(value('radius')))
      case ('hole')
         body = new_body(new_hole(value('radius')))
      case ('flat_punch')
         body = new_body(new_flat_punch(value('half_width')))
      case ('rounded_punch')
         body = new_body(new_rounded_punch(value('half_width'), value('edge_radius')))
      case ('wedge')
         body = new_body(new_wedge(tan(degree*value('angle'))))
      case ('power')
         body = new_body(new_power(value('coefficient'), value('exponent')))
      case ('wave')
         body = new_body(new_wave(value('amplitude'), value('wavelength')))
      case ('edge')
         ! Until the materials of both bodies are known (mfv_edge_reader).
         body = new_body(new_power(1.0_wp/value('edge_length'), 2.0_wp))
      case default
         call read_body_file(reader, number, body, error)
      end select

   contains

      pure real(wp) function value(name)
         character(*), intent(in) :: name

         value = reader%real_value('body', number, name)
      end function value
   end subroutine read_shape

   !> The file of a profile or a matrix, or the data in its place.
   subroutine read_body_file(reader, number, body, error)
      type(reader_type), intent(in) :: reader
      integer, intent(in) :: number
      type(body_type), intent(out) :: body
      type(error_type), allocatable, intent(out) :: error
      type(error_type), allocatable :: fault
      character(:), allocatable :: path
      type(trace_type) :: trace
      type(geometry_type) :: surface
      logical :: in_memory

      call find_file(reader, 'body', number, 'file', path, in_memory)
      if (reader%text_value('body', number, 'shape') == 'profile') then
         call read_trace(reader, number, trace, error)
         if (allocated(error)) return
         if (in_memory) then
            call read_profile(path, trace, surface, fault, reader%data)
         else
            call read_profile(path, trace, surface, fault)
         end if
         body = new_body(surface)
      else if (in_memory) then
         call reader%data%read_matrix_body(path, body, fault)
      else
         call read_matrix_body(path, body, fault)
      end if
      if (allocated(fault)) call reader%complain('body', number, 'file', fault%message, error)
   end subroutine read_body_file

   !> Options of a profile.
   subroutine read_trace(reader, number, trace, error)
      type(reader_type), intent(in) :: reader
      integer, intent(in) :: number
      type(trace_type), intent(out) :: trace
      type(error_type), allocatable, intent(out) :: error

      trace%position_scale = reader%real_value('body', number, 'position_scale')
      trace%has_spacing = reader%has('body', number, 'position_scale')
      trace%height_scale = reader%real_value('body', number, 'height_scale')
      trace%centred = reader%logical_value('body', number, 'centred')
      trace%level = reader%choice('body', number, 'level')
      if (reader%has('body', number, 'interpolation')) &
         trace%interpolation = reader%choice('body', number, 'interpolation')
      if (.not. abs(trace%height_scale) > 0.0_wp) &
         call reader%complain('body', number, 'height_scale', 'must not be 0', error)
   end subroutine read_trace

   !> An orthotropic material.
   subroutine read_orthotropic(group, reader, number, plane, material, error)
      character(*), intent(in) :: group
      type(reader_type), intent(in) :: reader
      integer, intent(in) :: number, plane
      type(material_type), intent(out) :: material
      type(error_type), allocatable, intent(out) :: error
      type(string_type), allocatable :: keys(:)
      logical :: valid
      integer :: i

      keys = list_of_words(orthotropic_keys)
      if (plane /= plane_stress) keys = list_of_words(orthotropic_keys//' '//plane_strain_keys)
      do i = 1, size(keys)
         call reader%need(group, number, keys(i)%text, error)
         if (allocated(error)) return
      end do
      keys = list_of_words(plane_strain_keys)
      do i = 1, size(keys)
         if (plane /= plane_stress .or. .not. reader%has(group, number, keys(i)%text)) cycle
         call reader%complain(group, number, keys(i)%text, "has no effect with plane='stress' in &scene; remove it", error)
         return
      end do
      call new_orthotropic_material([value('youngs_modulus_1'), value('youngs_modulus_2'), value('youngs_modulus_3')], &
                                    [value('poisson_ratio_12'), value('poisson_ratio_13'), value('poisson_ratio_23')], &
                                    value('shear_modulus_12'), plane, degree*value('axis_angle'), material, valid)
      if (.not. valid) call reader%complain(group, number, 'elasticity', 'no such material: some stress would release energy; '// &
                                            'the squares of poisson_ratio_12, _13 and _23 must be below E1/E2, E1/E3 and '// &
                                            'E2/E3, and smaller if several are large', error)

   contains

      !> 0 where it has no effect.
      pure real(wp) function value(name)
         character(*), intent(in) :: name

         value = 0.0_wp
         if (plane == plane_stress .and. has_word(plane_strain_keys, name)) return
         value = reader%real_value(group, number, name)
      end function value
   end subroutine read_orthotropic

   !> A material with any compliances in the plane.
   subroutine read_anisotropic(group, reader, number, plane, material, error)
      character(*), intent(in) :: group
      type(reader_type), intent(in) :: reader
      integer, intent(in) :: number, plane
      type(material_type), intent(out) :: material
      type(error_type), allocatable, intent(out) :: error
      real(wp), allocatable :: compliances(:)
      logical :: valid

      call reader%need(group, number, 'compliances', error)
      if (allocated(error)) return
      call reader%real_values(group, number, 'compliances', compliances)
      if (plane == plane_stress .and. size(compliances) /= 6) then
         call reader%complain(group, number, 'compliances', 'must be six numbers in plane stress: S11, S12, S22, S16, S26, S66', &
                              error)
      else if (plane /= plane_stress .and. size(compliances) /= 10) then
         call reader%complain(group, number, 'compliances', 'must be ten numbers in plane strain: S11, S12, S22, S16, S26, '// &
                              'S66, S13, S23, S33, S36', error)
      end if
      if (allocated(error)) return
      call new_anisotropic_material(compliances, degree*reader%real_value(group, number, 'axis_angle'), &
                                    material, valid)
      if (.not. valid) call reader%complain(group, number, 'compliances', 'no such material: some stress would release '// &
                                            'energy; the matrix of the compliances must be positive definite', error)
   end subroutine read_anisotropic

   !> The elastic material, isotropic.
   subroutine read_isotropic(group, reader, number, plane, material, error)
      character(*), intent(in) :: group
      type(reader_type), intent(in) :: reader
      integer, intent(in) :: number, plane
      type(material_type), intent(out) :: material
      type(error_type), allocatable, intent(out) :: error
      real(wp) :: modulus, ratio

      call reader%need(group, number, 'poisson_ratio', error)
      if (allocated(error)) return
      ratio = reader%real_value(group, number, 'poisson_ratio')
      if (reader%has(group, number, 'youngs_modulus')) then
         if (reader%has(group, number, 'shear_modulus')) then
            call reader%complain(group, number, 'youngs_modulus', 'shear_modulus is also given; give only one of them', error)
            return
         end if
         modulus = shear_modulus_of(reader%real_value(group, number, 'youngs_modulus'), ratio)
      else
         call reader%need(group, number, 'shear_modulus', error)
         if (allocated(error)) return
         modulus = reader%real_value(group, number, 'shear_modulus')
      end if
      material = new_material(modulus, ratio, plane)
   end subroutine read_isotropic

   !> Error for bodies that do not separate away from the origin.
   subroutine check_pair(reader, scene, error)
      type(reader_type), intent(in) :: reader
      type(scene_type), intent(in) :: scene
      type(error_type), allocatable, intent(out) :: error
      real(wp) :: radius, excess
      integer :: hole, shapes(2)

      shapes = [scene%lower%shape, scene%upper%shape]
      if (any(shapes == shape_profile .or. shapes == shape_matrix)) return
      if (any(shapes == shape_hole)) then
         hole = findloc(shapes, shape_hole, dim=1)
         if (scene%curvature() > 0.0_wp) return
         if (any(shapes == shape_disk)) then
            if (scene%is_neat()) return
            radius = merge(scene%upper%radius, scene%lower%radius, hole == 1)
            excess = radius - merge(scene%lower%radius, scene%upper%radius, hole == 1)
            if (excess > 0.0_wp) then
               call reader%complain('body', hole, 'radius', 'must be at least the radius of the disk in it, '//to_text(radius)// &
                                    "; for a larger pin give both that radius, normals='radial' in &mesh, and in a step "// &
                                    'interference='//to_text(excess, 3), error)
            else
               call reader%complain('body', hole, 'radius', 'is that of the disk in it; such a neat fit needs '// &
                                    "normals='radial' in &mesh", error)
            end if
         else
            call reader%complain('body', hole, 'radius', 'a hole needs a disk of its radius or a smaller one in it', error)
         end if
      else if (touches_everywhere(scene)) then
         call reader%complain('body', 2, 'shape', 'two half-planes touch everywhere; one body must have another shape', error)
      end if
   end subroutine check_pair

   !> Friction needs the tangential components of a matrix.
   subroutine check_matrix(reader, scene, error)
      type(reader_type), intent(in) :: reader
      type(scene_type), intent(in) :: scene
      type(error_type), allocatable, intent(out) :: error

      if (.not. scene%lower%is_matrix() .or. .not. scene%friction%acts()) return
      if (size(scene%lower%elasticity%matrix, 1) > size(scene%lower%position)) return
      call reader%complain('body', 1, 'file', 'the matrix has normal components only; friction needs the tangential ones too', &
                           error)
   end subroutine check_matrix

   !> The datum of each elastic body: that of the user; by default that of mfv_scene_indenter, else the half-width of the mesh.
   subroutine read_datums(reader, scene, error)
      type(reader_type), intent(in) :: reader
      type(scene_type), intent(inout) :: scene
      type(error_type), allocatable, intent(out) :: error
      real(wp) :: datum(2)
      logical :: of_case(2), has_datum(2)
      integer :: number

      has_datum = [scene%lower%elasticity%has_datum(), scene%upper%elasticity%has_datum()]
      call default_datum(scene, scene%lower, scene%upper, datum(1), of_case(1))
      call default_datum(scene, scene%upper, scene%lower, datum(2), of_case(2))
      do number = 1, 2
         if (scene%mesh%period > 0.0_wp) then
            datum(number) = scene%mesh%period
            of_case(number) = .false.
         end if
         if (.not. datum(number) > 0.0_wp) datum(number) = reader%real_value('mesh', 1, 'half_width')
         if (reader%has('body', number, 'datum')) then
            datum(number) = reader%real_value('body', number, 'datum')
            of_case(number) = .false.
         end if
         if (datum(number) <= scene%mesh%period/(2.0_wp*pi) .and. scene%mesh%period > 0.0_wp .and. has_datum(number)) then
            call reader%complain('body', number, 'datum', 'must be above the period over 2 pi, '// &
                                 to_text(scene%mesh%period/(2.0_wp*pi))//', with period in &mesh: a uniform pressure moves the '// &
                                 'surface', error)
            return
         end if
         if (scene%is_neat() .and. datum(number) <= scene%lower%radius) then
            call reader%complain('body', number, 'datum', 'must be above the radius in a neat fit: a force '// &
                                 'moves the whole surface', error)
            return
         end if
         if (.not. has_datum(number) .and. .not. datum(number) > 0.0_wp) datum(number) = 1.0_wp
         if (datum(number) > 0.0_wp .or. reader%logical_value('body', number, 'rigid')) cycle
         call reader%complain('body', number, 'datum', 'is needed: the shapes have no length to derive it from, and neither a '// &
                              'normal_force nor half_width in &mesh is given', error)
         return
      end do
      scene%lower%elasticity%datum = datum(1)
      scene%upper%elasticity%datum = datum(2)
      scene%lower%elasticity%datum_of_case = of_case(1) .and. has_datum(1) .and. .not. scene%lower%rigid
      scene%upper%elasticity%datum_of_case = of_case(2) .and. has_datum(2) .and. .not. scene%upper%rigid
   end subroutine read_datums

end module mfv_body_reader
