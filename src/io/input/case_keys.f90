!> All groups and keys of a case: kinds, defaults, ranges and meanings. The reader checks against this list; docs/namelist.md and
!> `mfv_run --keys` are made from it.
module mfv_case_keys
   use mfv_elasticity, only: elasticity_names, layer_names
   use mfv_geometry, only: shape_names
   use mfv_compliance, only: coupling_names
   use mfv_friction, only: friction_law_names
   use mfv_keys
   use mfv_kinds, only: wp
   use mfv_material, only: plane_names
   use mfv_motions, only: motions, motion_count => user_motions, motion_shift, control_force, control_displacement, &
                          controlled_key, first_control
   use mfv_run_state, only: most_turning_points
   use mfv_scene, only: algorithm_names, integration_names, most_cycles, solver_names, stepping_names
   use mfv_strings, only: to_text
   implicit none
   private
   public :: case_catalogue

   !> Groups in the order of the reference, and those that may be repeated.
   character(*), parameter :: group_list = 'scene body layer mesh friction wear step history solver output'
   character(*), parameter :: repeated_groups = 'body layer step'

   !> Terms of a Fourier series: 4 for each of the most intervals that a circle can have with it (mfv_mesh_reader).
   real(wp), parameter :: most_nodes = 1.0e8_wp, most_harmonics = 2.0e8_wp, most_rows = 1.0e6_wp

contains

   !> All keys.
   function case_catalogue() result(catalogue)
      type(catalogue_type) :: catalogue

      catalogue%group_list = group_list
      catalogue%repeated_groups = repeated_groups
      allocate (catalogue%keys(most_keys))
      call add_scene_keys(catalogue)
      call add_body_keys(catalogue)
      call add_layer_keys(catalogue)
      call add_mesh_keys(catalogue)
      call add_friction_keys(catalogue)
      call add_wear_keys(catalogue)
      call add_step_keys(catalogue)
      call add_history_keys(catalogue)
      call add_solver_keys(catalogue)
      call add_output_keys(catalogue)
      catalogue%keys = catalogue%keys(:catalogue%size)
   end function case_catalogue

   subroutine add_scene_keys(keys)
      type(catalogue_type), intent(inout) :: keys

      call keys%add('scene', 'title', kind_text, 'title of the scene, for summary, file and pictures')
      call keys%add('scene', 'plane', kind_choice, 'plane strain or plane stress', default='strain', choices=plane_names)
      call keys%add('scene', 'coupling', kind_choice, 'elastic coupling: full, without the effect of shear on the normal '// &
                    'problem (Goodman), or none', default='full', choices=coupling_names)
      call keys%add('scene', 'length_unit', kind_text, &
                    'name of the unit of length, for labels and a check of moduli', default='length')
      call keys%add('scene', 'force_unit', kind_text, 'name of the unit of force, likewise', default='force')
   end subroutine add_scene_keys

   subroutine add_body_keys(keys)
      type(catalogue_type), intent(inout) :: keys

      call keys%add('body', 'shape', kind_choice, 'needed; first body below, second body above', choices=shape_names//' edge')
      call keys%add('body', 'rigid', kind_logical, 'whether the body is rigid; one at least must be elastic, and a '// &
                    'flat_punch rigid', &
                    default='.false.')
      call add_isotropic_keys(keys, 'body', 'an elastic body')
      call keys%add('body', 'yield_strength', kind_real, 'elastic body: the largest von Mises stress above which there is '// &
                    'a warning', unit='force/length^2', above=0.0_wp)
      call keys%add('body', 'datum', kind_real, 'elastic body: distance from the contact at which displacements are measured; '// &
                    'if omitted: the radius of a disk or hole; else the radius, half-width or extent of the other body; else '// &
                    'the half-width of the contact', unit='length', above=0.0_wp)
      call keys%add('body', 'radius', kind_real, 'disk, hole: radius, needed', unit='length', above=0.0_wp)
      call keys%add('body', 'half_width', kind_real, 'flat_punch: half its width; rounded_punch: half the width of its flat '// &
                    'face; needed', unit='length', above=0.0_wp)
      call keys%add('body', 'edge_radius', kind_real, 'rounded_punch: radius of its edges, which are parabolas, needed', &
                    unit='length', above=0.0_wp)
      call keys%add('body', 'angle', kind_real, 'wedge: angle between each flank and the common tangent, needed', unit='degrees', &
                    above=0.0_wp, upper=80.0_wp)
      call keys%add('body', 'coefficient', kind_real, 'power: the surface recedes by coefficient*abs(x)^exponent, needed', &
                    unit='length^(1-exponent)', above=0.0_wp)
      call keys%add('body', 'exponent', kind_real, 'power: exponent of the shape, needed; 1: a wedge, 2: a cylinder', &
                    lower=1.0_wp, upper=100.0_wp)
      call keys%add('body', 'amplitude', kind_real, 'wave: the surface recedes by amplitude*(1 - cos(2 pi x/wavelength)), needed', &
                    unit='length', above=0.0_wp)
      call keys%add('body', 'wavelength', kind_real, 'wave: its length, needed', unit='length', above=0.0_wp)
      call keys%add('body', 'normal_intensity', kind_real, 'edge: intensity K_N of the pressure K_N sqrt(s), s the '// &
                    'distance from the right edge, where the half-width of the model is edge_length, needed', &
                    unit='force/length^(5/2)', above=0.0_wp)
      call keys%add('body', 'edge_length', kind_real, 'edge: half-width of the model at normal_intensity, needed; far '// &
                    'larger than the slip zone', unit='length', above=0.0_wp)
      call keys%add('body', 'elasticity', kind_choice, 'how the surface deforms: a disk or hole as such by default, or as a '// &
                    'half-plane, as all other shapes do; orthotropic, anisotropic: as a half-plane of such a material', &
                    default='own', choices=elasticity_names)
      call add_anisotropic_keys(keys, 'body')
      call keys%add('body', 'kernel', kind_choice, 'elastic disk, hole: closed forms, or the Fourier series', default='exact', &
                    choices='exact fourier')
      call keys%add('body', 'harmonics', kind_integer, "kernel='fourier': terms of the series; if omitted: 4 per "// &
                    "interval of the whole circle; at least half the number of these intervals", default='', lower=2.0_wp, &
                    upper=most_harmonics)
      call keys%add('body', 'file', kind_text, 'profile: text file with two columns, x and height, or one, heights; matrix: '// &
                    'HDF5 file; needed')
      call keys%add('body', 'interpolation', kind_choice, 'profile: straight lines between its points, with corners, or a '// &
                    'smooth curve without overshoot', default='linear', choices='linear monotone_cubic')
      call keys%add('body', 'position_scale', kind_real, 'profile: x of the file is multiplied by it; with heights only: the '// &
                    'distance between them, needed', above=0.0_wp, default='1')
      call keys%add('body', 'height_scale', kind_real, 'profile: heights of the file are multiplied by it; negative if they '// &
                    'are towards the other body', default='1')
      call keys%add('body', 'level', kind_choice, 'profile: subtracted from its heights: nothing, their mean, or their '// &
                    'least-squares line or parabola', default='none', choices='none mean line parabola')
      call keys%add('body', 'centred', kind_logical, 'profile: whether the middle of its positions is moved to x = 0', &
                    default='.false.')
   end subroutine add_body_keys

   !> Keys of a layer: which body, how thick, and its material.
   subroutine add_layer_keys(keys)
      type(catalogue_type), intent(inout) :: keys

      call keys%add('layer', 'body', kind_integer, 'the body that it is bonded on, 1 or 2, needed; several layers of one body: '// &
                    'from the surface down', lower=1.0_wp, upper=2.0_wp)
      call keys%add('layer', 'thickness', kind_real, 'needed', unit='length', above=0.0_wp)
      call keys%add('layer', 'elasticity', kind_choice, 'the kind of its material', default='isotropic', choices=layer_names)
      call add_isotropic_keys(keys, 'layer', 'an isotropic layer')
      call keys%add('layer', 'yield_strength', kind_real, 'the largest von Mises stress in the layer above which there is a '// &
                    'warning', unit='force/length^2', above=0.0_wp)
      call add_anisotropic_keys(keys, 'layer')
   end subroutine add_layer_keys

   !> Keys of an isotropic material; `of`: whose it is.
   subroutine add_isotropic_keys(keys, group, of)
      type(catalogue_type), intent(inout) :: keys
      character(*), intent(in) :: group, of

      call keys%add(group, 'shear_modulus', kind_real, 'shear modulus G of '//of, unit='force/length^2', above=0.0_wp)
      call keys%add(group, 'youngs_modulus', kind_real, 'E = 2 G (1 + nu), instead of shear_modulus', unit='force/length^2', &
                    above=0.0_wp)
      call keys%add(group, 'poisson_ratio', kind_real, "Poisson's ratio, needed for "//of, above=-1.0_wp, upper=0.5_wp)
   end subroutine add_isotropic_keys

   subroutine add_anisotropic_keys(keys, group)
      type(catalogue_type), intent(inout) :: keys
      character(*), intent(in) :: group
      character(*), parameter :: strain = ', needed in plane strain'

      call keys%add(group, 'youngs_modulus_1', kind_real, 'orthotropic: modulus along the first axis, needed', &
                    unit='force/length^2', above=0.0_wp)
      call keys%add(group, 'youngs_modulus_2', kind_real, 'orthotropic: modulus along the second axis, in the plane, needed', &
                    unit='force/length^2', above=0.0_wp)
      call keys%add(group, 'youngs_modulus_3', kind_real, 'orthotropic: modulus out of the plane'//strain, &
                    unit='force/length^2', above=0.0_wp)
      call keys%add(group, 'poisson_ratio_12', kind_real, 'orthotropic: contraction along axis 2 over extension under a stress '// &
                    'along axis 1, needed')
      call keys%add(group, 'poisson_ratio_13', kind_real, 'orthotropic: contraction along axis 3, likewise'//strain)
      call keys%add(group, 'poisson_ratio_23', kind_real, 'orthotropic: contraction along axis 3 under a stress along axis 2, '// &
                    'likewise'//strain)
      call keys%add(group, 'shear_modulus_12', kind_real, 'orthotropic: shear modulus in the plane, needed', &
                    unit='force/length^2', above=0.0_wp)
      call keys%add(group, 'compliances', kind_real, 'anisotropic: six or, in plane strain, ten numbers, needed: S11, '// &
                    'S12, S22, S16, S26, S66, S13, S23, S33, S36; strains (11, 22, engineering 12) by stresses', &
                    unit='length^2/force')
      keys%keys(keys%size)%is_list = .true.
      call keys%add(group, 'axis_angle', kind_real, 'orthotropic, anisotropic: angle from x to the first axis of the '// &
                    'material, counterclockwise', unit='degrees', default='0', lower=-180.0_wp, upper=180.0_wp)
   end subroutine add_anisotropic_keys

   subroutine add_mesh_keys(keys)
      type(catalogue_type), intent(inout) :: keys

      call keys%add('mesh', 'nodes', kind_integer, 'number of equal intervals; nodes are their centres; more by '// &
                    'default for a small accuracy in &solver, 360 around a neat fit', default='101', &
                    lower=1.0_wp, upper=most_nodes)
      call keys%add('mesh', 'half_width', kind_real, 'the intervals cover [-half_width, half_width] along the surface; if '// &
                    'omitted: chosen from an estimate of the contact, and extended when the contact reaches its '// &
                    'ends', unit='length', &
                    above=0.0_wp)
      call keys%add('mesh', 'half_angle', kind_real, 'instead of half_width if a body is an elastic disk or hole: the '// &
                   'intervals cover this angle on either side; 180: the whole circle', unit='degrees', above=0.0_wp, upper=180.0_wp)
      call keys%add('mesh', 'period', kind_real, 'instead of half_width: surfaces, loads and mesh repeat after this length '// &
                    'along the surface; forces are those of one period', unit='length', above=0.0_wp)
      call keys%add('mesh', 'refine', kind_choice, 'edges: unequal intervals, small at the edges of contact and stick zones at '// &
                    'the ends of the steps', default='none', choices='none edges')
      call keys%add('mesh', 'ends', kind_real, 'instead of nodes, half_width and half_angle: the ends of all intervals, '// &
                    'which may be unequal, from left to right along the surface', unit='length')
      keys%keys(keys%size)%is_list = .true.
      call keys%add('mesh', 'gap', kind_choice, 'gap of disks and holes: exact circles, or the parabolas x^2/(2R) of Hertz', &
                    default='exact', choices='exact parabolic')
      call keys%add('mesh', 'normals', kind_choice, 'vertical: pressure, gap and approach are vertical at every node; radial: '// &
                    'along the radius, for a disk in a hole; positions along the surface and tractions are then those of the '// &
                    'hole', default='vertical', choices='vertical radial')
   end subroutine add_mesh_keys

   subroutine add_friction_keys(keys)
      type(catalogue_type), intent(inout) :: keys

      call keys%add('friction', 'law', kind_choice, 'friction law', default='none', choices='none '//friction_law_names)
      call add_coefficient_key(keys, 'mu', 'coulomb, dahl: coefficient of friction')
      call add_coefficient_key(keys, 'mu_static', 'static_kinetic, weakening: coefficient up to which a node sticks')
      call add_coefficient_key(keys, 'mu_kinetic', 'static_kinetic, weakening: coefficient of a slipping node, after '// &
                               'weakening; not above mu_static')
      call keys%add('friction', 'mu_file', kind_text, 'instead of the coefficients: text file with the columns x and mu, or '// &
                    'x, mu_static and mu_kinetic; linear between its lines, constant beyond them')
      call keys%add('friction', 'weakening_distance', kind_real, 'weakening: slip over which the coefficient decreases from '// &
                    'mu_static to mu_kinetic, needed', unit='length', above=0.0_wp)
      call keys%add('friction', 'stiffness', kind_real, 'dahl: stiffness sigma of the bristles, traction over slip, needed', &
                    unit='force/length^3', above=0.0_wp)
      call keys%add('friction', 'exponent', kind_real, 'dahl: exponent gamma; if omitted: 1', lower=0.0_wp, upper=100.0_wp)
   end subroutine add_friction_keys

   subroutine add_wear_keys(keys)
      type(catalogue_type), intent(inout) :: keys

      call keys%add('wear', 'law', kind_choice, 'archard: the depth of wear of both surfaces together is the coefficient times '// &
                    'pressure times slip (friction: coulomb, static_kinetic); work: times the work of friction per unit of '// &
                    'surface', default='archard', choices='archard work')
      call keys%add('wear', 'coefficient', kind_real, 'needed; the gaps grow after every cycle of steps with cycles', &
                    unit='length^2/force', above=0.0_wp)
      call keys%add('wear', 'tolerance', kind_real, 'largest error of worn area and depth against a computation of every '// &
                    'cycle: one cycle in a block of as many as it allows is computed, and two after it, by which the block '// &
                    'is corrected or shortened', &
                    default='0.05', lower=1.0e-6_wp, upper=1.0_wp)
      call keys%add('wear', 'block', kind_integer, 'largest number of cycles in a block; if omitted: as many as the '// &
                    'tolerance allows', lower=1.0_wp, &
                    upper=real(most_cycles, wp))
   end subroutine add_wear_keys

   !> A coefficient of friction: one value, or one per node.
   subroutine add_coefficient_key(keys, name, meaning)
      type(catalogue_type), intent(inout) :: keys
      character(*), intent(in) :: name, meaning

      call keys%add('friction', name, kind_real, meaning//'; one value, or one per node', lower=0.0_wp)
      keys%keys(keys%size)%is_list = .true.
   end subroutine add_coefficient_key

   subroutine add_step_keys(keys)
      type(catalogue_type), intent(inout) :: keys
      integer :: i, control

      do i = 1, motion_count
         associate (motion => motions(i))
            do control = first_control(i), control_displacement
               if (control == control_force) then
                  call keys%add('step', trim(motion%force_key), kind_real, trim(motion%force_target), unit=trim(motion%force_unit))
               else
                  call keys%add('step', trim(motion%key), kind_real, trim(motion%target), unit=trim(motion%unit))
               end if
               if (motion%pushes .and. motion%is_known) keys%keys(keys%size)%lower = 0.0_wp
            end do
         end associate
         if (i == motion_shift) call keys%add('step', 'force_ratio', kind_real, 'target Q/(mu P) instead of '// &
                                              'tangential_force: mu the largest coefficient of &friction, P the normal_force '// &
                                         'of this step or of the last step before it that has one', lower=-1.0e6_wp, upper=1.0e6_wp)
      end do
      call keys%add('step', 'normal_intensity', kind_real, 'edge: target of K_N, instead of normal_force', &
                    unit='force/length^(5/2)', lower=0.0_wp)
      call keys%add('step', 'shear_intensity', kind_real, 'edge: target of K_T at the right edge, with the bulk stresses of '// &
                    'this step, instead of tangential_force', unit='force/length^(3/2)')
      call keys%add('step', 'friction', kind_logical, 'whether friction acts during this step', default='.true.')
      call keys%add('step', 'cycles', kind_integer, '0: load to the targets; n: load to the targets and back to the loads at '// &
                    'the start of the step, n times', default='0', lower=0.0_wp, upper=real(most_cycles, wp))
      call keys%add('step', 'steady_tolerance', kind_real, 'cycles end early when the tractions after two successive cycles '// &
                    'differ by less than this fraction of the largest traction; if omitted: never', above=0.0_wp)
   end subroutine add_step_keys

   !> Those of a load history after the steps: the loads of a step, with a value for every turning point.
   subroutine add_history_keys(keys)
      type(catalogue_type), intent(inout) :: keys
      character(len=17) :: name
      integer :: i, control

      call keys%add('history', 'file', kind_text, 'text file with the loads of the turning points instead of lists: columns '// &
                    'with the names of these keys in the first line, and a row for every turning point; a column '// &
                    'time is ignored')
      do i = 1, motion_count
         do control = first_control(i), control_displacement
            name = controlled_key(i, control)
            call add_history_key(trim(name), trim(merge(motions(i)%force_unit//'  ', motions(i)%unit, control == control_force)))
            if (motions(i)%pushes .and. motions(i)%is_known) keys%keys(keys%size)%lower = 0.0_wp
         end do
         if (i == motion_shift) call add_history_key('force_ratio', '')
      end do
      call add_history_key('normal_intensity', 'force/length^(5/2)')
      keys%keys(keys%size)%lower = 0.0_wp
      call add_history_key('shear_intensity', 'force/length^(3/2)')
      call keys%add('history', 'period', kind_integer, 'number of the last turning points that are a cycle; if omitted: '// &
                    'all of them if there are cycles, else none', lower=2.0_wp, upper=most_rows)
      call keys%add('history', 'cycles', kind_integer, 'how many times the last turning points are passed through', default='1', &
                    lower=1.0_wp, upper=real(most_cycles, wp))
      call keys%add('history', 'steady_tolerance', kind_real, 'as in &step', above=0.0_wp)

   contains

      !> A list of loads.
      subroutine add_history_key(name, unit)
         character(*), intent(in) :: name, unit

         call keys%add('history', name, kind_real, 'as in &step', unit=unit)
         if (name == 'force_ratio') keys%keys(keys%size)%lower = -1.0e6_wp
         if (name == 'force_ratio') keys%keys(keys%size)%upper = 1.0e6_wp
         keys%keys(keys%size)%is_list = .true.
      end subroutine add_history_key
   end subroutine add_history_keys

   subroutine add_solver_keys(keys)
      type(catalogue_type), intent(inout) :: keys

      call keys%add('solver', 'algorithm', kind_choice, 'mfv: Method of First Violation; conventional: load steps with '// &
                    'corrections of node statuses', default='mfv', choices=algorithm_names)
      call keys%add('solver', 'accuracy', kind_real, 'allowed error: of the tractions, relative to the largest traction '// &
                    '(rough contacts, of at least 8 patches with fewer than 64 nodes each on average: a root mean square), '// &
                    'and, by large increments, of the dissipation of each load segment; 0: only exact large increments; if '// &
                    'omitted, 1e-3 on meshes of 384 nodes or more, else 0; '// &
                    'if given, also chooses nodes; dahl, weakening: see friction_tolerance', &
                    default='1e-3', lower=0.0_wp, upper=0.1_wp)
      call keys%add('solver', 'stepping', kind_choice, "algorithm='mfv': events found from rates (event), or from trial load "// &
                    'steps and interpolation (nominal; coulomb, static_kinetic); large increments (leap: coulomb); or large '// &
                    'increments where accuracy allows them and they cost less than events (auto)', &
                    default='auto', choices=stepping_names)
      call add_part_key(keys, 'load_step', '0.05', "nominal load step, as a fraction of each load segment: for "// &
                        "algorithm='conventional', stepping='nominal', integration='explicit'")
      call keys%add('solver', 'integration', kind_choice, 'dahl: second order with controlled error, or explicit with '// &
                    'load_step (appendix B)', default='second_order', choices=integration_names)
      call add_part_key(keys, 'friction_tolerance', '1e-4', 'dahl, weakening: error allowed in an increment, relative to the '// &
                        'largest traction, or to the change of the shear over the load segment if that is smaller; with '// &
                        'accuracy above 0 by default a tenth of it')
      call keys%add('solver', 'iterations', kind_integer, 'conventional: largest number of status corrections at one '// &
                    'load', default='1000', &
                    lower=1.0_wp, upper=1.0e6_wp)
      call keys%add('solver', 'linear_solver', kind_choice, 'auto: chosen by size and structure; dgesv: augmented system with '// &
                    'LAPACK, the reference; reduced: factorisation that is updated at every event; fft: iterative, '// &
                    'without a matrix', default='auto', choices=solver_names)
      call add_part_key(keys, 'linear_tolerance', '1e-12', "linear_solver='fft': relative residual at which iteration stops")
   end subroutine add_solver_keys

   !> A number of the solver from 1e-12 to 1, with a default.
   subroutine add_part_key(keys, name, default, meaning)
      type(catalogue_type), intent(inout) :: keys
      character(*), intent(in) :: name, default, meaning

      call keys%add('solver', name, kind_real, meaning, lower=1.0e-12_wp, upper=1.0_wp, default=default)
   end subroutine add_part_key

   subroutine add_output_keys(keys)
      type(catalogue_type), intent(inout) :: keys

      call keys%add('output', 'file', kind_text, 'result file (HDF5); if omitted: the name of the case file with .h5, in the '// &
                    'working directory')
      call keys%add('output', 'history', kind_choice, 'history record at every event, at every step end, or '// &
                    'none', default='events', &
                    choices='events steps none')
      call keys%add('output', 'states', kind_choice, 'states saved at the end of every step, and at every turning point '// &
                    '(reversals) or those of the last cycle (last_cycle) of its cycles; or only the last one; auto: steps in '// &
                    'a case with &history, else reversals, or last_cycle in a step that has passed '// &
                    to_text(most_turning_points)//' turning points', default='auto', &
                    choices='auto reversals steps none last_cycle')
      call keys%add('output', 'stress_at', kind_real, 'x at which /history has the stress along the surface of both bodies, '// &
                    'with the largest tension along it and its x', unit='length')
      call keys%add('output', 'error_estimate', kind_logical, 'whether the case is also solved on coarser meshes, for error '// &
                    'bars of the observables', &
                    default='.false.')
      call keys%add('output', 'sensitivity', kind_logical, 'whether the case is run once more with all coefficients of '// &
                    'friction times 1 + 1e-12, to report the changes', &
                    default='.false.')
      call keys%add('output', 'checkpoint_minutes', kind_real, 'mfv_run: least time between two checkpoints, from which '// &
                    'mfv_run --resume continues; 0: only when the run is interrupted', unit='minutes', lower=0.0_wp, &
                    upper=1.0e6_wp, default='10')
   end subroutine add_output_keys

end module mfv_case_keys
