!> The one list of groups and keys of a case: kinds, defaults, ranges and meanings. The reader checks against it, the
!> reference in docs/namelist.md and `mfv_run --keys` are printed from it.
module mfv_case_keys
   use mfv_body, only: shape_names
   use mfv_kinds, only: wp
   use mfv_scene, only: most_cycles
   use mfv_strings, only: list_of_words, quoted, string_type, to_text
   implicit none
   private
   public :: key_type, case_keys, case_groups, group_list, group_repeats, kind_real, kind_integer, kind_logical, kind_text, &
             kind_choice, list_keys_as_markdown, describe_allowed

   integer, parameter :: kind_real = 1, kind_integer = 2, kind_logical = 3, kind_text = 4, kind_choice = 5

   !> One key.
   type :: key_type
      character(:), allocatable :: group, name
      integer :: kind = 0
      !> Default as it would be written; empty: none, the key is left out or needed, as the meaning says.
      character(:), allocatable :: default
      !> Choices, separated by blanks.
      character(:), allocatable :: choices
      !> Allowed range of a number, each end open or closed.
      real(wp) :: lower = -huge(1.0_wp), upper = huge(1.0_wp)
      logical :: lower_open = .false.
      !> Whether there may be several values: one a node.
      logical :: is_list = .false.
      character(:), allocatable :: unit, meaning
   end type key_type

   !> Groups in the order of the reference, with what they are for; and those that may come more than once.
   character(*), parameter :: group_list = 'scene body mesh friction step solver output'
   character(*), parameter :: repeated_groups = 'body step'

   character(len=1), parameter :: line_feed = achar(10)
   real(wp), parameter :: most_nodes = 1.0e8_wp, most_harmonics = 2.0e9_wp

contains

   !> All keys.
   function case_keys() result(keys)
      type(key_type), allocatable :: keys(:)

      allocate (keys(0))
      call add_scene_keys(keys)
      call add_body_keys(keys)
      call add_mesh_keys(keys)
      call add_friction_keys(keys)
      call add_step_keys(keys)
      call add_solver_keys(keys)
      call add_output_keys(keys)
   end function case_keys

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
                            'displacements are measured; left out: the radius of a disk or hole; else the radius, '// &
                            'half-width or extent of the other body')
      call add_positive_key(keys, 'body', 'radius', 'length', 'disk, hole: radius, needed')
      call add_positive_key(keys, 'body', 'half_width', 'length', 'flat_punch: half its width, needed')
      call add_choice_key(keys, 'body', 'kernel', 'exact', 'exact fourier', 'elastic disk, hole: closed forms, or the '// &
                          'Fourier series')
      call add_integer_key(keys, 'body', 'harmonics', '', "kernel='fourier': terms of the series; left out: 4 for each "// &
                           'interval of the whole circle', 2.0_wp, most_harmonics)
      call add_text_key(keys, 'body', 'file', '', 'profile: text file with two columns, x and height above the flat '// &
                        'surface; matrix: HDF5 file, see below; beside the case file; needed')
   end subroutine add_body_keys

   subroutine add_mesh_keys(keys)
      type(key_type), allocatable, intent(inout) :: keys(:)

      call add_integer_key(keys, 'mesh', 'nodes', '101', 'number of equal intervals; nodes are their centres', &
                           1.0_wp, most_nodes)
      call add_positive_key(keys, 'mesh', 'half_width', 'length', 'the intervals cover [-half_width, half_width] along '// &
                            'the surface; left out: chosen from an estimate of the contact, and grown when the contact needs it')
      call add_real_key(keys, 'mesh', 'half_angle', 'degrees', 'in place of half_width where a body is an elastic disk or '// &
                        'hole: the intervals cover this angle on either side; 180: the whole circle, of which only '// &
                        'what is near the contact is carried', lower=0.0_wp, lower_open=.true., upper=180.0_wp)
      call add_choice_key(keys, 'mesh', 'gap', 'exact', 'exact parabolic', &
                          'gap of disks and holes: exact circles, or the parabolas x^2/(2R) of Hertz')
      call add_choice_key(keys, 'mesh', 'normals', 'vertical', 'vertical radial', 'vertical: pressure, gap and approach are '// &
                          'vertical at every node; radial: along the radius, for a disk in a hole, whatever the angle')
   end subroutine add_mesh_keys

   subroutine add_friction_keys(keys)
      type(key_type), allocatable, intent(inout) :: keys(:)

      call add_choice_key(keys, 'friction', 'law', 'none', 'none coulomb static_kinetic weakening dahl', 'friction law')
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
      call add_real_key(keys, 'friction', 'exponent', '', 'dahl: exponent gamma; left out: 1', lower=0.0_wp)
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

      call add_real_key(keys, 'step', 'normal_force', 'force/length', 'target of the normal force P', lower=0.0_wp)
      call add_real_key(keys, 'step', 'approach', 'length', &
                        'target of the approach of the upper body, in place of normal_force')
      call add_real_key(keys, 'step', 'tangential_force', 'force/length', &
                        'target of the tangential force Q, positive to the right')
      call add_real_key(keys, 'step', 'shift', 'length', &
                        'target of the shift of the upper body to the right, in place of tangential_force')
      call add_real_key(keys, 'step', 'force_ratio', '', 'target Q/(mu P) in place of tangential_force: mu the largest '// &
                        'coefficient of &friction, P the normal_force that this step or the last one before it names', &
                        lower=-1.0e6_wp, upper=1.0e6_wp)
      call add_real_key(keys, 'step', 'moment', 'force', 'target of the moment M about the centre of the upper disk or '// &
                        'hole, else of the lower one, else about the pole; counterclockwise')
      call add_real_key(keys, 'step', 'rotation', 'radians', &
                        'target of the rotation of the upper body about the same point, in place of moment')
      call add_logical_key(keys, 'step', 'friction', '.true.', 'whether friction acts during this step')
      call add_integer_key(keys, 'step', 'cycles', '0', '0: go to the targets; n: go there and back to where the step '// &
                           'began, n times', 0.0_wp, real(most_cycles, wp))
      call add_positive_key(keys, 'step', 'steady_tolerance', '', 'cycles end early when the state after two in a row is the '// &
                            'same to within this part of the largest traction; left out: never')
   end subroutine add_step_keys

   subroutine add_solver_keys(keys)
      type(key_type), allocatable, intent(inout) :: keys(:)

      call add_choice_key(keys, 'solver', 'algorithm', 'mfv', 'mfv conventional', 'mfv: Method of First Violation; '// &
                          'conventional: load steps with repairs of statuses, for comparison')
      call add_choice_key(keys, 'solver', 'stepping', 'event', 'event nominal leap', 'mfv: events from rates, or from trial '// &
                          'load steps and interpolation; both lead to the same states (coulomb, static_kinetic); leap: each '// &
                          'straight part of the load history at once, halved where halves lead elsewhere (coulomb)')
      call add_part_key(keys, 'leap_tolerance', '1e-3', "stepping='leap': by how much a leap and its two halves may differ, "// &
                        'part of the largest traction')
      call add_real_key(keys, 'solver', 'event_tolerance', '', 'mfv: events closer to each other than this part of what is '// &
                        'done of a straight part of the load history are taken together: fewer solves, less accuracy '// &
                        '(coulomb)', lower=0.0_wp, upper=0.1_wp)
      keys(size(keys))%default = '0'
      call add_part_key(keys, 'load_step', '0.05', 'nominal load step, part of each straight part of the load history: for '// &
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

      call add_real_key(keys, 'solver', name, '', meaning, lower=1.0e-12_wp, upper=1.0_wp)
      keys(size(keys))%default = default
   end subroutine add_part_key

   subroutine add_output_keys(keys)
      type(key_type), allocatable, intent(inout) :: keys(:)

      call add_text_key(keys, 'output', 'file', '', 'result file (HDF5); left out: the name of the case file with .h5, '// &
                        'in the working directory')
      call add_choice_key(keys, 'output', 'history', 'events', 'events steps none', &
                          'a history record an event, a step end, or none')
      call add_choice_key(keys, 'output', 'states', 'reversals', 'reversals steps', 'state kept at every reversal of a step '// &
                          'with cycles, or only at the end of every step')
      call add_logical_key(keys, 'output', 'error_estimate', '.false.', 'whether the case is also solved on coarser meshes, to '// &
                           'tell the discretisation error of half-width, stick ratio, peak tractions and dissipation')
   end subroutine add_output_keys

   subroutine add_text_key(keys, group, name, default, meaning)
      type(key_type), allocatable, intent(inout) :: keys(:)
      character(*), intent(in) :: group, name, default, meaning

      call add_key(keys, group, name, kind_text, default, '', meaning)
   end subroutine add_text_key

   subroutine add_logical_key(keys, group, name, default, meaning)
      type(key_type), allocatable, intent(inout) :: keys(:)
      character(*), intent(in) :: group, name, default, meaning

      call add_key(keys, group, name, kind_logical, default, '', meaning)
   end subroutine add_logical_key

   subroutine add_choice_key(keys, group, name, default, choices, meaning)
      type(key_type), allocatable, intent(inout) :: keys(:)
      character(*), intent(in) :: group, name, default, choices, meaning

      call add_key(keys, group, name, kind_choice, default, '', meaning)
      keys(size(keys))%choices = choices
   end subroutine add_choice_key

   !> A whole number from `lower` to `upper`.
   subroutine add_integer_key(keys, group, name, default, meaning, lower, upper)
      type(key_type), allocatable, intent(inout) :: keys(:)
      character(*), intent(in) :: group, name, default, meaning
      real(wp), intent(in) :: lower, upper

      call add_key(keys, group, name, kind_integer, default, '', meaning)
      keys(size(keys))%lower = lower
      keys(size(keys))%upper = upper
   end subroutine add_integer_key

   !> A real without a default, from `lower` (itself allowed unless `lower_open`) to `upper`, each where present.
   subroutine add_real_key(keys, group, name, unit, meaning, lower, lower_open, upper)
      type(key_type), allocatable, intent(inout) :: keys(:)
      character(*), intent(in) :: group, name, unit, meaning
      real(wp), intent(in), optional :: lower, upper
      logical, intent(in), optional :: lower_open

      call add_key(keys, group, name, kind_real, '', unit, meaning)
      if (present(lower)) keys(size(keys))%lower = lower
      if (present(lower_open)) keys(size(keys))%lower_open = lower_open
      if (present(upper)) keys(size(keys))%upper = upper
   end subroutine add_real_key

   subroutine add_positive_key(keys, group, name, unit, meaning)
      type(key_type), allocatable, intent(inout) :: keys(:)
      character(*), intent(in) :: group, name, unit, meaning

      call add_real_key(keys, group, name, unit, meaning, lower=0.0_wp, lower_open=.true.)
   end subroutine add_positive_key

   !> Append a key. Element by element: gfortran leaks the components of arrays that a constructor joins.
   subroutine add_key(keys, group, name, kind, default, unit, meaning)
      type(key_type), allocatable, intent(inout) :: keys(:)
      character(*), intent(in) :: group, name, default, unit, meaning
      integer, intent(in) :: kind
      type(key_type), allocatable :: longer(:)
      integer :: i, n

      n = size(keys)
      allocate (longer(n + 1))
      do i = 1, n
         longer(i) = keys(i)
      end do
      longer(n + 1)%group = group
      longer(n + 1)%name = name
      longer(n + 1)%kind = kind
      longer(n + 1)%default = default
      longer(n + 1)%choices = ''
      longer(n + 1)%unit = unit
      longer(n + 1)%meaning = meaning
      call move_alloc(longer, keys)
   end subroutine add_key

   !> Groups that a case may have.
   function case_groups() result(groups)
      type(string_type), allocatable :: groups(:)

      groups = list_of_words(group_list)
   end function case_groups

   !> Whether a group may come more than once.
   pure logical function group_repeats(group)
      character(*), intent(in) :: group

      group_repeats = index(' '//repeated_groups//' ', ' '//group//' ') > 0
   end function group_repeats

   !> What values a key takes, in words, for messages and the reference.
   subroutine describe_allowed(key, text)
      type(key_type), intent(in) :: key
      character(:), allocatable, intent(out) :: text

      select case (key%kind)
      case (kind_choice)
         call join_alternatives(list_of_words(key%choices), text)
      case (kind_logical)
         text = '.true. or .false.'
      case (kind_text)
         text = "a text between quotes"
      case (kind_integer)
         text = 'a whole number from '//to_text(nint(key%lower))//' to '//to_text(nint(key%upper))
      case default
         text = 'a number'
         call add_range(key, text)
      end select
   end subroutine describe_allowed

   !> Append the range of a key to a text.
   subroutine add_range(key, text)
      type(key_type), intent(in) :: key
      character(:), allocatable, intent(inout) :: text

      if (key%lower > -huge(1.0_wp)) &
         text = text//trim(merge(' above   ', ' at least', key%lower_open))//' '//to_text(key%lower)
      if (key%upper < huge(1.0_wp)) text = text//' and at most '//to_text(key%upper)
   end subroutine add_range

   !> 'a', 'b' or 'c'
   subroutine join_alternatives(words, text)
      type(string_type), intent(in) :: words(:)
      character(:), allocatable, intent(out) :: text
      integer :: i

      text = quoted(words(1)%text)
      do i = 2, size(words)
         if (i < size(words)) text = text//', '//quoted(words(i)%text)
         if (i == size(words)) text = text//' or '//quoted(words(i)%text)
      end do
   end subroutine join_alternatives

   !> The reference of all keys as Markdown tables.
   subroutine list_keys_as_markdown(text)
      character(:), allocatable, intent(out) :: text
      type(key_type), allocatable :: keys(:)
      type(string_type), allocatable :: groups(:)
      integer :: i, j

      keys = case_keys()
      groups = case_groups()
      text = ''
      do i = 1, size(groups)
         text = text//'### &'//groups(i)%text
         if (group_repeats(groups(i)%text)) text = text//' (may come more than once)'
         text = text//line_feed//line_feed//'| key | value | default | unit | meaning |'//line_feed// &
                '| --- | --- | --- | --- | --- |'//line_feed
         do j = 1, size(keys)
            if (keys(j)%group == groups(i)%text) call add_row(keys(j), text)
         end do
         if (i < size(groups)) text = text//line_feed
      end do
   end subroutine list_keys_as_markdown

   !> Append the row of a key to a Markdown table.
   subroutine add_row(key, text)
      type(key_type), intent(in) :: key
      character(:), allocatable, intent(inout) :: text
      character(:), allocatable :: allowed, default

      call describe_allowed(key, allowed)
      default = '-'
      if (key%default /= '') default = '`'//key%default//'`'
      if (key%default /= '' .and. any(key%kind == [kind_text, kind_choice])) default = '`'//quoted(key%default)//'`'
      text = text//'| `'//key%name//'` | '//allowed//' | '//default//' | '//key%unit//' | '//key%meaning//' |'//line_feed
   end subroutine add_row

end module mfv_case_keys
