!> The one list of groups and keys of a case: kinds, defaults, ranges and meanings. The reader checks against it, the
!> reference in docs/namelist.md and `mfv_run --keys` are printed from it.
module mfv_case_keys
   use mfv_body, only: shape_names
   use mfv_friction, only: friction_law_names
   use mfv_keys
   use mfv_kinds, only: wp
   use mfv_motions, only: motions, motion_count, motion_shift
   use mfv_scene, only: most_cycles
   implicit none
   private
   public :: case_catalogue

   !> Groups in the order of the reference, with what they are for; and those that may come more than once.
   character(*), parameter :: group_list = 'scene body mesh friction step solver output'
   character(*), parameter :: repeated_groups = 'body step'

   !> Terms of a Fourier series: 4 for each of the most intervals that a circle can have with it (mfv_mesh_reader).
   real(wp), parameter :: most_nodes = 1.0e8_wp, most_harmonics = 2.0e8_wp

contains

   !> All keys.
   function case_catalogue() result(catalogue)
      type(catalogue_type) :: catalogue

      catalogue%group_list = group_list
      catalogue%repeated_groups = repeated_groups
      call list_keys(catalogue%keys)
   end function case_catalogue

   subroutine list_keys(keys)
      type(key_type), allocatable, intent(out) :: keys(:)

      allocate (keys(0))
      call add_scene_keys(keys)
      call add_body_keys(keys)
      call add_mesh_keys(keys)
      call add_friction_keys(keys)
      call add_step_keys(keys)
      call add_solver_keys(keys)
      call add_output_keys(keys)
   end subroutine list_keys

   subroutine add_scene_keys(keys)
      type(key_type), allocatable, intent(inout) :: keys(:)

      call add_text_key(keys, 'scene', 'title', '', 'title of the scene, for summary, file and pictures')
      call add_choice_key(keys, 'scene', 'plane', 'strain', 'strain stress', 'plane strain or plane stress')
      call add_choice_key(keys, 'scene', 'coupling', 'full', 'full goodman none', 'elastic coupling: full, without the '// &
                          'effect of shear on the normal problem (Goodman), or none')
      call add_text_key(keys, 'scene', 'length_unit', 'length', 'name of the unit of length, for labels only')
      call add_text_key(keys, 'scene', 'force_unit', 'force', 'name of the unit of force, for labels only')
   end subroutine add_scene_keys

   subroutine add_body_keys(keys)
      type(key_type), allocatable, intent(inout) :: keys(:)

      call add_choice_key(keys, 'body', 'shape', '', shape_names, 'needed; first body below, second body above')
      call add_logical_key(keys, 'body', 'rigid', '.false.', 'whether the body is rigid; at least one is not; a '// &
                           'flat_punch must be')
      call add_positive_key(keys, 'body', 'shear_modulus', 'force/length^2', 'shear modulus G of an elastic body')
      call add_positive_key(keys, 'body', 'youngs_modulus', 'force/length^2', &
                            'E = 2 G (1 + nu), in place of shear_modulus')
      call add_real_key(keys, 'body', 'poisson_ratio', '', "Poisson's ratio, needed for an elastic body", &
                        lower=-1.0_wp, lower_open=.true., upper=0.5_wp)
      call add_positive_key(keys, 'body', 'yield_strength', 'force/length^2', 'elastic body: a warning is given when '// &
                            'the largest von Mises stress is beyond it')
      call add_positive_key(keys, 'body', 'datum', 'length', 'elastic body: distance from the contact at which '// &
                            'displacements are measured; if omitted: the radius of a disk or hole; else the radius, '// &
                            'half-width or extent of the other body; else the half-width of the contact, see below')
      call add_positive_key(keys, 'body', 'radius', 'length', 'disk, hole: radius, needed')
      call add_positive_key(keys, 'body', 'half_width', 'length', 'flat_punch: half its width; rounded_punch: half the width '// &
                            'of its flat part; needed')
      call add_positive_key(keys, 'body', 'edge_radius', 'length', 'rounded_punch: radius of its edges, which are parabolas, '// &
                            'needed')
      call add_real_key(keys, 'body', 'angle', 'degrees', 'wedge: angle of either flank to the common tangent, needed', &
                        lower=0.0_wp, lower_open=.true., upper=80.0_wp)
      call add_positive_key(keys, 'body', 'coefficient', 'length^(1-exponent)', 'power: the surface recedes '// &
                            'by coefficient*abs(x)^exponent, needed')
      call add_real_key(keys, 'body', 'exponent', '', 'power: exponent of the shape, needed; 1: a wedge, 2: a cylinder', &
                        lower=1.0_wp, upper=100.0_wp)
      call add_choice_key(keys, 'body', 'kernel', 'exact', 'exact fourier', 'elastic disk, hole: closed forms, or the '// &
                          'Fourier series')
      call add_integer_key(keys, 'body', 'harmonics', '', "kernel='fourier': terms of the series; if omitted: 4 for each "// &
                           'interval of the whole circle; at least half as many as these intervals', 2.0_wp, most_harmonics)
      call add_text_key(keys, 'body', 'file', '', 'profile: text file with two columns, x and height; matrix: HDF5 file; see '// &
                        'below; beside the case file; needed')
      call add_choice_key(keys, 'body', 'interpolation', 'linear', 'linear monotone_cubic', 'profile: straight lines '// &
                          'between its points, which keep corners, or a smooth curve without overshoot')
      call add_real_key(keys, 'body', 'position_scale', '', 'profile: x of the file is multiplied by it', lower=0.0_wp, &
                        lower_open=.true., default='1')
      call add_real_key(keys, 'body', 'height_scale', '', 'profile: heights of the file are multiplied by it; they are how far '// &
                        'the surface recedes from the other body: negative where the file counts them outwards', default='1')
      call add_choice_key(keys, 'body', 'level', 'none', 'none mean line', 'profile: subtracted from its heights: nothing, '// &
                          'their mean, or their least-squares line')
      call add_logical_key(keys, 'body', 'centred', '.false.', 'profile: whether the middle of its positions is moved to x = 0')
   end subroutine add_body_keys

   subroutine add_mesh_keys(keys)
      type(key_type), allocatable, intent(inout) :: keys(:)

      call add_integer_key(keys, 'mesh', 'nodes', '101', 'number of equal intervals; nodes are their centres', &
                           1.0_wp, most_nodes)
      call add_positive_key(keys, 'mesh', 'half_width', 'length', 'the intervals cover [-half_width, half_width] along '// &
                            'the surface; if omitted: chosen from an estimate of the contact, and grown when the contact needs it')
      call add_real_key(keys, 'mesh', 'half_angle', 'degrees', 'in place of half_width where a body is an elastic disk or '// &
                        'hole: the intervals cover this angle on either side; 180: the whole circle, of which only '// &
                        'what is near the contact is carried', lower=0.0_wp, lower_open=.true., upper=180.0_wp)
      call add_choice_key(keys, 'mesh', 'gap', 'exact', 'exact parabolic', &
                          'gap of disks and holes: exact circles, or the parabolas x^2/(2R) of Hertz')
      call add_choice_key(keys, 'mesh', 'normals', 'vertical', 'vertical radial', 'vertical: pressure, gap and approach are '// &
                          'vertical at every node; radial: along the radius, for a disk in a hole, whatever the angle; '// &
                          'lengths along the surface and tractions are then those of the hole')
   end subroutine add_mesh_keys

   subroutine add_friction_keys(keys)
      type(key_type), allocatable, intent(inout) :: keys(:)

      call add_choice_key(keys, 'friction', 'law', 'none', 'none '//friction_law_names, 'friction law')
      call add_coefficient_key(keys, 'mu', 'coulomb, dahl: coefficient of friction')
      call add_coefficient_key(keys, 'mu_static', 'static_kinetic, weakening: coefficient up to which a node sticks')
      call add_coefficient_key(keys, 'mu_kinetic', 'static_kinetic, weakening: coefficient with which it slips, at the end; '// &
                               'not above mu_static')
      call add_text_key(keys, 'friction', 'mu_file', '', 'in place of the coefficients: text file with the columns x and mu, '// &
                        'or x, mu_static and mu_kinetic; linear between its lines, constant beyond them; beside the case file')
      call add_positive_key(keys, 'friction', 'weakening_distance', 'length', 'weakening: slip over which the coefficient '// &
                            'falls from mu_static to mu_kinetic, needed')
      call add_positive_key(keys, 'friction', 'stiffness', 'force/length^3', 'dahl: stiffness sigma of the bristles, traction '// &
                            'over slip, needed')
      call add_real_key(keys, 'friction', 'exponent', '', 'dahl: exponent gamma; if omitted: 1', lower=0.0_wp, &
                        upper=100.0_wp)
   end subroutine add_friction_keys

   !> A coefficient of friction: one value, or one a node.
   subroutine add_coefficient_key(keys, name, meaning)
      type(key_type), allocatable, intent(inout) :: keys(:)
      character(*), intent(in) :: name, meaning

      call add_real_key(keys, 'friction', name, '', meaning//'; one value, or one a node of a mesh with half_width or '// &
                        'half_angle', lower=0.0_wp)
      keys(size(keys))%is_list = .true.
   end subroutine add_coefficient_key

   subroutine add_step_keys(keys)
      type(key_type), allocatable, intent(inout) :: keys(:)
      integer :: i

      do i = 1, motion_count
         associate (motion => motions(i))
            call add_real_key(keys, 'step', trim(motion%force_key), trim(motion%force_unit), trim(motion%force_target))
            if (motion%pushes) keys(size(keys))%lower = 0.0_wp
            call add_real_key(keys, 'step', trim(motion%key), trim(motion%unit), trim(motion%target))
         end associate
         if (i == motion_shift) &
            call add_real_key(keys, 'step', 'force_ratio', '', 'target Q/(mu P) in place of tangential_force: mu the largest '// &
                              'coefficient of &friction, P the normal_force that this step or the last one before it names', &
                              lower=-1.0e6_wp, upper=1.0e6_wp)
      end do
      call add_logical_key(keys, 'step', 'friction', '.true.', 'whether friction acts during this step')
      call add_integer_key(keys, 'step', 'cycles', '0', '0: go to the targets; n: go there and back to where the step '// &
                           'began, n times', 0.0_wp, real(most_cycles, wp))
      call add_positive_key(keys, 'step', 'steady_tolerance', '', 'cycles end early when the state after two in a row is the '// &
                            'same to within this part of the largest traction; if omitted: never')
   end subroutine add_step_keys

   subroutine add_solver_keys(keys)
      type(key_type), allocatable, intent(inout) :: keys(:)

      call add_choice_key(keys, 'solver', 'algorithm', 'mfv', 'mfv conventional', 'mfv: Method of First Violation; '// &
                          'conventional: load steps with repairs of statuses, for comparison')
      call add_choice_key(keys, 'solver', 'stepping', 'event', 'event nominal leap', 'mfv: events from rates, or from trial '// &
                          'load steps and interpolation; both lead to the same states (coulomb, static_kinetic); leap: '// &
                          'large increments, events where these would cost more (coulomb)')
      call add_part_key(keys, 'leap_tolerance', '1e-3', "stepping='leap': tolerance of the tractions, relative to the largest "// &
                        'traction, and of the dissipation of each load segment, relative to that')
      call add_part_key(keys, 'load_step', '0.05', 'nominal load step, part of each load segment: for '// &
                        "algorithm='conventional', stepping='nominal', integration='explicit'")
      call add_choice_key(keys, 'solver', 'integration', 'second_order', 'second_order explicit', 'dahl: second order with '// &
                          'controlled error, or explicit with load_step (appendix B)')
      call add_part_key(keys, 'friction_tolerance', '1e-4', 'dahl, weakening: error that an increment may make, part of the '// &
                        'largest traction')
      call add_integer_key(keys, 'solver', 'iterations', '1000', 'conventional: repairs that may be made at one load', &
                           1.0_wp, 1.0e6_wp)
      call add_choice_key(keys, 'solver', 'linear_solver', 'auto', 'auto dgesv reduced fft', 'auto: chosen by size and '// &
                          'structure; dgesv: augmented system with LAPACK, the reference; reduced: factorisation that is '// &
                          'updated at every event; fft: products through FFTW and iteration, no matrix')
      call add_part_key(keys, 'linear_tolerance', '1e-12', "linear_solver='fft': relative residual to which it iterates")
   end subroutine add_solver_keys

   !> A number of the solver from 1e-12 to 1, with a default.
   subroutine add_part_key(keys, name, default, meaning)
      type(key_type), allocatable, intent(inout) :: keys(:)
      character(*), intent(in) :: name, default, meaning

      call add_real_key(keys, 'solver', name, '', meaning, lower=1.0e-12_wp, upper=1.0_wp, default=default)
   end subroutine add_part_key

   subroutine add_output_keys(keys)
      type(key_type), allocatable, intent(inout) :: keys(:)

      call add_text_key(keys, 'output', 'file', '', 'result file (HDF5); if omitted: the name of the case file with .h5, '// &
                        'in the working directory')
      call add_choice_key(keys, 'output', 'history', 'events', 'events steps none', &
                          'a history record an event, a step end, or none')
      call add_choice_key(keys, 'output', 'states', 'reversals', 'reversals steps none', 'state kept at every reversal of a '// &
                          'step with cycles, only at the end of every step, or none but the last')
      call add_logical_key(keys, 'output', 'error_estimate', '.false.', 'whether the case is also solved on coarser meshes, to '// &
                           'tell the discretisation error of half-width, stick ratio, peak tractions and dissipation')
      call add_logical_key(keys, 'output', 'sensitivity', '.false.', 'whether the case is run once more with all '// &
                           'coefficients of friction times 1 + 1e-12, to report how much that changes tractions, '// &
                           'dissipation and stick ratio')
      call add_real_key(keys, 'output', 'checkpoint_minutes', 'minutes', 'mfv_run: least time between two checkpoints, '// &
                        'from which mfv_run --resume continues; 0: only when the run is interrupted', lower=0.0_wp, &
                        upper=1.0e6_wp, default='10')
   end subroutine add_output_keys

end module mfv_case_keys
