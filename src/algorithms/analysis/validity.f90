!> Warnings where the assumptions of the model do not hold.
module mfv_validity
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use mfv_body, only: body_type, shape_half_plane, shape_matrix
   use mfv_contact_model, only: needs_equal_intervals
   use mfv_contact_state, only: contact_state_type
   use mfv_cycle, only: cycle_type
   use mfv_interior, only: has_interior, interior_type
   use mfv_kinds, only: pi, wp
   use mfv_motions, only: motion_approach, motion_shift, motion_rotation, bulk_motions, &
                          control_displacement
   use mfv_node_status, only: in_contact
   use mfv_scene, only: scene_type
   use mfv_simulation, only: simulation_type, states_none, states_steps
   use mfv_slip_zones, only: contact_interval, needed_mesh, resolved_nodes, slip_record_type, nodes_at_edge
   use mfv_state_interior, only: state_interior
   use mfv_stress_search, only: largest_type, largest_von_mises
   use mfv_strings, only: add_text, string_type, to_text
   use mfv_surface_warnings, only: warn_of_surface
   use mfv_zone_edges, only: zones_of
   implicit none
   private
   public :: validity_warnings

   !> Normals are vertical at every node: at this angle from the initial point of contact, degrees, the error is 1.5 % (1 -
   !> cos) in the normal and 17 % (sin) in the tangential component.
   real(wp), parameter :: largest_angle = 10.0_wp

contains

   !> Warnings about a simulation: few nodes in contact or slip zones; contact at large angles, or beyond a datum; surfaces that
   !> end, are steep or are uncertain between points; yield (the largest von Mises stress by refinement); large rotations; wear of
   !> much at once; lost digits; an accuracy beyond that of the mesh.
   subroutine validity_warnings(simulation, warnings)
      type(simulation_type), intent(in) :: simulation
      type(string_type), allocatable, intent(out) :: warnings(:)
      !> Fewest nodes in contact for half-width and stick ratio; largest residual without lost digits.
      integer, parameter :: fewest = 10
      real(wp), parameter :: good = 1.0e-8_wp
      integer :: nodes
      real(wp) :: largest

      allocate (warnings(0))
      associate (scene => simulation%contact%model%scene)
         call check_angle(simulation, 'lower', scene%lower, warnings)
         call check_angle(simulation, 'upper', scene%upper, warnings)
         call check_datum(simulation, scene, warnings)
         call check_accuracy(simulation, scene, warnings)
         call warn_of_surface(simulation, .false., scene%lower, largest_angle, warnings)
         call warn_of_surface(simulation, .true., scene%upper, largest_angle, warnings)
         call check_yield(simulation, .false., scene%lower, warnings)
         call check_yield(simulation, .true., scene%upper, warnings)
      end associate
      nodes = simulation%contact%state%contact_nodes()
      if (nodes > 0 .and. nodes < fewest) call add_text(warnings, 'only '//to_text(nodes)// &
                                                        trim(merge(' node is  ', ' nodes are', nodes == 1))// &
                                                        ' in contact: half-width, stick ratio and tractions are '// &
                                                        'inaccurate; use a finer mesh')
      call check_slip_zones(simulation, warnings)
      call check_order(simulation%contact%model%scene%lower, warnings)
      call check_rotation(simulation, warnings)
      call check_wear(simulation, warnings)
      call check_slide(simulation, simulation%contact%model%scene, warnings)
      if (simulation%cycle_count > 0) call check_drift(simulation%cycles(simulation%cycle_count), warnings)
      largest = simulation%contact%certificate%largest()
      if (largest > good) &
         call add_text(warnings, 'the largest relative residual is '//to_text(largest, 2)// &
                       ', well above rounding errors: results may be inaccurate; /certificate in the result file lists the '// &
                       'residuals by name')
   end subroutine validity_warnings

   subroutine check_angle(simulation, name, body, warnings)
      type(simulation_type), intent(in) :: simulation
      character(*), intent(in) :: name
      type(body_type), intent(in) :: body
      type(string_type), allocatable, intent(inout) :: warnings(:)
      real(wp) :: angle

      if (body%rigid .or. .not. body%circular() .or. simulation%contact%model%scene%mesh%radial) return
      if (simulation%contact%state%contact_nodes() == 0) return
      associate (model => simulation%contact%model)
         angle = maxval(abs(model%arc), mask=in_contact(simulation%contact%state%status))/body%radius*180.0_wp/pi
      end associate
      if (.not. angle > largest_angle) return
      call add_text(warnings, 'the contact reaches '//to_text(angle, 3)//' degrees from the initial point of '// &
                    'contact on the '//name//' body; vertical normals are inaccurate beyond '// &
                    to_text(largest_angle, 2)//' degrees')
   end subroutine check_angle

   !> An accuracy for which the program's equal intervals are too large: beyond the most nodes, or where the present contact is much
   !> smaller than the mesh, or is one of patches.
   subroutine check_accuracy(simulation, scene, warnings)
      type(simulation_type), intent(in) :: simulation
      type(scene_type), intent(in) :: scene
      type(string_type), allocatable, intent(inout) :: warnings(:)
      !> Error of the tractions times nodes in contact, for up to three times the accuracy.
      real(wp), parameter :: error_of_one = 0.08_wp
      integer :: wanted, patches, nodes
      character(:), allocatable :: needs

      if (.not. scene%mesh%nodes_by_accuracy .or. allocated(scene%mesh%ends) .or. .not. scene%friction%converges()) return
      if (.not. scene%method%accuracy > 0.0_wp) return
      wanted = scene%mesh%nodes_for(scene%method%accuracy)
      patches = size(zones_of(in_contact(simulation%contact%state%status)))
      nodes = simulation%contact%state%contact_nodes()
      needs = 'accuracy='//to_text(scene%method%accuracy, 2)//' needs about '
      if (wanted > scene%mesh%nodes) then
         call add_text(warnings, needs//to_text(real(wanted, wp), 2)//' equal intervals; the mesh has '// &
                       to_text(scene%mesh%nodes)//": give nodes, or refine='edges'")
      else if (nodes < patches*error_of_one/scene%method%accuracy) then
         call add_text(warnings, needs//to_text(nint(3.0_wp*error_of_one/scene%method%accuracy))// &
                       ' nodes in each patch of contact; now '//to_text(nodes)//' are in '//to_text(patches)// &
                       trim(merge(' patch  ', ' patches', patches == 1))//': give nodes')
      end if
   end subroutine check_accuracy

   !> A default datum that another case would not have; and a datum inside the contact: the compliance of a flat contact of the
   !> half-width a is proportional to ln(2 d/a).
   subroutine check_datum(simulation, scene, warnings)
      type(simulation_type), intent(in) :: simulation
      type(scene_type), intent(in) :: scene
      type(string_type), allocatable, intent(inout) :: warnings(:)
      real(wp), parameter :: most = 1.2_wp
      real(wp) :: half_width

      if (scene%lower%circular() .or. scene%upper%circular() .or. scene%lower%shape == shape_matrix) return
      if (simulation%contact%state%contact_nodes() == 0) return
      if (scene%lower%datum_of_case .or. scene%upper%datum_of_case) &
         call add_text(warnings, 'the datum of the displacements, '//to_text(scene%datum(), 4)//', is the half-width of the '// &
                       'contact at the largest normal_force of this case, or else of its mesh: give datum to compare '// &
                       'approaches, shifts and stiffnesses with those of other cases')
      associate (arc => simulation%contact%model%arc, touching => in_contact(simulation%contact%state%status))
         half_width = 0.5_wp*(maxval(arc, mask=touching) - minval(arc, mask=touching))
      end associate
      if (half_width > most*scene%datum()) &
         call add_text(warnings, 'the contact half-width of '//to_text(half_width, 3)//' exceeds the datum '// &
                       to_text(scene%datum(), 3)//' at which displacements are measured: approach and shift are too small for '// &
                       'their forces, or negative; set a larger datum')
   end subroutine check_datum

   !> Cycles, or given blocks of them, that wear too much at once: slip paths are constant within them, pressures are those at the
   !> end. In many more cycles, in which the wear becomes small, it tends to the same limit.
   subroutine check_wear(simulation, warnings)
      type(simulation_type), intent(in) :: simulation
      type(string_type), allocatable, intent(inout) :: warnings(:)
      real(wp) :: worn, last

      associate (model => simulation%contact%model, state => simulation%contact%state)
         if (.not. model%scene%wear%acts() .or. simulation%cycle_count == 0) return
         worn = model%force(state%worn)
         last = worn - simulation%cycles(simulation%cycle_count)%worn_area
         if (.not. min(state%coarsely_worn, last) > model%scene%wear%tolerance*worn) return
         call add_text(warnings, to_text(100.0_wp*state%coarsely_worn/worn, 3)//' % of the worn area is from cycles, or given '// &
                       'blocks of cycles, that change the pressures or the wear by more than the fraction '// &
                       to_text(model%scene%wear%tolerance, 2)//' (tolerance of &wear): it may be half of the right one; use a '// &
                       'smaller coefficient and more cycles, or a smaller block')
      end associate
   end subroutine check_wear

   !> Rotation is first order: exact for rolling parabolas, otherwise with errors that grow with the rolled distance.
   subroutine check_rotation(simulation, warnings)
      type(simulation_type), intent(in) :: simulation
      type(string_type), allocatable, intent(inout) :: warnings(:)
      real(wp), parameter :: small_error = 1.0e-3_wp, small_distance = 0.1_wp
      real(wp) :: rolled, half_width, error

      associate (model => simulation%contact%model, state => simulation%contact%state)
         if (.not. model%moves(motion_rotation) .or. state%contact_nodes() == 0) return
         if (.not. abs(state%fields%motion(motion_rotation)) > 0.0_wp) return
         half_width = 0.5_wp*sum(model%width, mask=in_contact(state%status))
         rolled = model%rolled(state%fields)
         error = model%rolling_error(state%fields)
      end associate
      if (abs(error) > small_error) &
         call add_text(warnings, 'the contact has rolled by '//to_text(rolled, 3)//': the relative curvature has an error of '// &
                       to_text(100.0_wp*error, 2)//' % and the contact half-width about half of that; roll less far')
      if (simulation%contact%model%scene%mesh%radial) return
      if (simulation%load(motion_approach)%control == control_displacement .and. rolled**2 > small_distance**2*half_width**2) &
         call add_text(warnings, 'the bodies have rolled at a prescribed approach: it refers to the initial '// &
                       'point of contact, and the normal force has grown with the distance; prescribe normal_force instead')
   end subroutine check_rotation

   !> Sliding: nodes stay opposite each other although the profiles slide over each other. On a straight surface, and between
   !> parabolas, the contact keeps its tractions and is only displaced; between other profiles the gap changes by the slope times
   !> the slide. A pin in a bore turns in place.
   subroutine check_slide(simulation, scene, warnings)
      type(simulation_type), intent(in) :: simulation
      type(scene_type), intent(in) :: scene
      type(string_type), allocatable, intent(inout) :: warnings(:)
      real(wp), parameter :: small_slide = 0.1_wp
      character(:), allocatable :: consequence

      associate (slip => simulation%slip)
         if (scene%mesh%radial .or. .not. slip%farthest > small_slide*slip%half_width) return
         if (scene%wear%acts()) then
            consequence = 'both surfaces wear over the contact only, not over the path of the slide'
         else if (scene%lower%shape == shape_half_plane .or. scene%upper%shape == shape_half_plane .or. &
                  (scene%lower%circular() .and. scene%upper%circular())) then
            consequence = 'positions along the bodies, such as those of stresses, are off by up to the slide'
         else
            consequence = 'gaps, and with them all tractions, are those before the slide'
         end if
         call add_text(warnings, 'the upper body has slid by '//to_text(slip%farthest, 3)//' along the lower one, with a '// &
                       'contact half-width of '//to_text(slip%half_width, 3)//': the model keeps nodes opposite each other, '// &
                       'which is right for slides of less than a tenth of the half-width; '//consequence)
      end associate
   end subroutine check_slide

   !> Cycles whose tractions repeat while the upper body moves on.
   subroutine check_drift(cycle, warnings)
      type(cycle_type), intent(in) :: cycle
      type(string_type), allocatable, intent(inout) :: warnings(:)

      if (cycle%walks()) &
         call add_text(warnings, 'the upper body walks: over the last cycle the tractions repeat to '// &
                       to_text(cycle%change, 1)//' of the largest, but the shift changes by '// &
                       to_text(cycle%drift(motion_shift), 4)//', and so in every further cycle; /cycles has shift_drift')
   end subroutine check_drift

   !> Slip zones with too few nodes: affected quantities and required mesh.
   subroutine check_slip_zones(simulation, warnings)
      type(simulation_type), intent(in) :: simulation
      type(string_type), allocatable, intent(inout) :: warnings(:)
      character(:), allocatable :: names, text, remedy
      integer :: nodes
      real(wp) :: width, interval

      names = ''
      nodes = resolved_nodes
      width = huge(width)
      interval = contact_interval(simulation%contact%model, simulation%contact%state)
      call add_work(simulation%slip, 'dissipation')
      ! The tension behind a contact grows with the root of its slip zone; a matrix has no interior.
      call add_zones(simulation%slip, trim(merge('stick_ratio, peak_shear         ', 'stick_ratio, peak_shear, tension', &
                                                 simulation%contact%model%scene%lower%shape == shape_matrix)))
      if (.not. simulation%slip%is_coarse_now(interval)) then
         call add_edge(-1, 'left')
         call add_edge(1, 'right')
      end if
      if (simulation%cycle_count > 0) then
         associate (cycle => simulation%cycles(simulation%cycle_count))
            call add_work(cycle%slip(), 'cycle_dissipation, loss_factor, nonlinear_shift')
            call add_work(cycle%first_slip, 'first_cycle_dissipation')
            call add_zones(cycle%loading_slip, 'stick_ratio_loading')
            call add_zones(cycle%reversal%slip, 'stick_ratio_reversal')
            call add_zones(cycle%return%slip, 'stick_ratio_return')
         end associate
      end if
      if (names == '') return
      text = 'slip zones have only '//to_text(nodes)//trim(merge(' node ', ' nodes', nodes == 1))
      if (nodes == 0) text = 'no node slips: slip zones are narrower than the mesh resolves'
      remedy = trim(needed_mesh(simulation%contact%model, simulation%contact%state, width))
      associate (scene => simulation%contact%model%scene)
         if (.not. (allocated(scene%mesh%ends) .or. scene%lower%shape == shape_matrix .or. needs_equal_intervals(scene))) &
            remedy = "refine='edges' in &mesh, or "//remedy
      end associate
      call add_text(warnings, text//' ('//to_text(width/interval, 2)//' intervals); not resolved: '//names(3:)//'; use '// &
                    remedy//' for '//to_text(resolved_nodes)//' nodes in each slip zone')

   contains

      subroutine add_work(slip, quantities)
         type(slip_record_type), intent(in) :: slip
         character(*), intent(in) :: quantities

         if (slip%is_coarse()) call add(quantities, slip%mean_nodes(), slip%mean_width())
      end subroutine add_work

      subroutine add_zones(slip, quantities)
         type(slip_record_type), intent(in) :: slip
         character(*), intent(in) :: quantities

         if (slip%is_coarse_now(interval)) call add(quantities, slip%nodes_now, slip%width_now)
      end subroutine add_zones

      !> A slip zone at an edge with too few nodes although the widest one is resolved. A traction that points from the edge into
      !> the contact causes tension outside.
      subroutine add_edge(side, name)
         integer, intent(in) :: side
         character(*), intent(in) :: name
         integer :: zone, edge

         associate (model => simulation%contact%model, state => simulation%contact%state)
            zone = nodes_at_edge(model, state, side)
            if (zone == 0 .or. zone >= resolved_nodes) return
            edge = findloc(in_contact(state%status), .true., dim=1, back=side > 0)
            associate (scene => model%scene)
               if (.not. merge(has_interior(scene%lower), has_interior(scene%upper), side*state%fields%shear(edge) < 0.0_wp)) return
            end associate
            call add('tension at the '//name//' edge', zone, zone*model%width(edge))
         end associate
      end subroutine add_edge

      subroutine add(quantities, its_nodes, its_width)
         character(*), intent(in) :: quantities
         integer, intent(in) :: its_nodes
         real(wp), intent(in) :: its_width

         names = names//', '//quantities
         nodes = min(nodes, its_nodes)
         width = min(width, its_width)
      end subroutine add
   end subroutine check_slip_zones

   !> A matrix with the components of each node in turn, instead of all normal ones first. Neighbouring rows are then the two
   !> components of one node, which almost everywhere displace each other less than the next node's.
   subroutine check_order(body, warnings)
      type(body_type), intent(in) :: body
      type(string_type), allocatable, intent(inout) :: warnings(:)
      real(wp), parameter :: almost_every = 0.8_wp
      integer :: i, n

      if (body%shape /= shape_matrix) return
      n = size(body%position) - 2
      if (count([(body%matrix(i, i + 1) < body%matrix(i, i + 2), i=1, n)]) > almost_every*n .and. n > 1) &
         call add_text(warnings, 'the matrix seems to be in the wrong order, because neighbouring rows couple weakly: rows and '// &
                       'columns must have all normal components first, then all tangential ones')
   end subroutine check_order

   !> The last state and, at the ends of steps, those of largest normal force, and of largest tangential force and bulk stress in
   !> either direction.
   subroutine check_yield(simulation, upper, body, warnings)
      type(simulation_type), intent(in) :: simulation
      logical, intent(in) :: upper
      type(body_type), intent(in) :: body
      type(string_type), allocatable, intent(inout) :: warnings(:)
      type(largest_type) :: largest, other
      character(:), allocatable :: where_it_is
      integer :: candidates(5), i, n, bulk

      if (.not. body%yield_strength > 0.0_wp) return
      largest = largest_below(simulation, upper, simulation%contact%state)
      where_it_is = 'in the last state'
      n = simulation%snapshot_count
      candidates = 0
      bulk = bulk_motions(merge(2, 1, upper))
      if (n > 1) candidates = [maxloc([(simulation%snapshots(i)%state%fields%force(motion_approach), i=1, n)]), &
                               maxloc([(simulation%snapshots(i)%state%fields%force(motion_shift), i=1, n)]), &
                               minloc([(simulation%snapshots(i)%state%fields%force(motion_shift), i=1, n)]), &
                               maxloc([(simulation%snapshots(i)%state%fields%motion(bulk), i=1, n)]), &
                               minloc([(simulation%snapshots(i)%state%fields%motion(bulk), i=1, n)])]
      do i = 1, size(candidates)
         if (.not. ieee_is_finite(largest%value)) exit
         if (candidates(i) == 0 .or. candidates(i) == n) cycle
         other = largest_below(simulation, upper, simulation%padded(simulation%snapshots(candidates(i))))
         if (ieee_is_finite(other%value)) then
            if (.not. other%value > largest%value) cycle
         end if
         largest = other
         where_it_is = 'in steps/'//to_text(candidates(i))
      end do
      if (.not. ieee_is_finite(largest%value)) then
         call add_text(warnings, 'the '//merge('upper', 'lower', upper)//' body yields under any load: its stresses are '// &
                       'unbounded at a sharp corner; they are bounded with rounded edges')
      else if (largest%value > body%yield_strength) then
         call add_text(warnings, 'the largest von Mises stress of the '//merge('upper', 'lower', upper)//' body, '// &
                       to_text(largest%value, 4)//' '//where_it_is//', exceeds its yield_strength '// &
                       to_text(body%yield_strength)//': stresses and tractions are not valid beyond yield')
      else if (has_history(simulation) .and. any(simulation%keep_states == [states_steps, states_none])) then
         call add_text(warnings, 'yield of the '//merge('upper', 'lower', upper)//' body is not checked at the turning points '// &
                       "of the load history, which are not saved: set states='reversals' in &output")
      end if
   end subroutine check_yield

   !> Whether a step is a load history with turning points of its own, or a row of one.
   pure logical function has_history(simulation)
      type(simulation_type), intent(in) :: simulation
      integer :: i

      associate (steps => simulation%contact%model%scene%steps)
         has_history = any(steps%is_passed) .or. any([(allocated(steps(i)%path), i=1, size(steps))])
      end associate
   end function has_history

   !> Largest von Mises stress of a body in a state; zero without an interior.
   type(largest_type) function largest_below(simulation, upper, state) result(largest)
      type(simulation_type), intent(in) :: simulation
      logical, intent(in) :: upper
      type(contact_state_type), intent(in) :: state
      type(interior_type) :: interior
      logical :: available

      ! The value is flat at its maximum: few elements suffice.
      call state_interior(simulation%contact%model, state, upper, interior, available, fewest_elements=60)
      if (available) largest = largest_von_mises(interior)
   end function largest_below

end module mfv_validity
