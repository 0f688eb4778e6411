!> Warnings where the assumptions of the model do not hold.
module mfv_validity
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use mfv_body, only: body_type
   use mfv_cycle, only: cycle_type
   use mfv_extreme_states, only: find_largest_of_history
   use mfv_kinds, only: pi, wp
   use mfv_load_extremes, only: load_extremes_type
   use mfv_motions, only: motion_approach, motion_shift, motion_rotation, control_displacement
   use mfv_near_field, only: near_field_type
   use mfv_node_status, only: in_contact
   use mfv_observables, only: observed_type
   use mfv_resolution, only: find_unresolved, poorest_patch, unresolved_type
   use mfv_scene, only: most_of_datum, scene_type
   use mfv_simulation, only: simulation_type
   use mfv_stress_search, only: largest_type
   use mfv_strings, only: add_text, string_type, to_text
   use mfv_surface_warnings, only: warn_of_surface
   use mfv_tolerances, only: certified
   use mfv_zone_edges, only: zone_type
   implicit none
   private
   public :: validity_warnings

   !> Normals are vertical at every node: at this angle from the initial point of contact, degrees, the error is 1.5 % (1 -
   !> cos) in the normal and 17 % (sin) in the tangential component.
   real(wp), parameter :: largest_angle = 10.0_wp

contains

   !> Warnings about a simulation, with what is observed in it: what its mesh does not resolve; contact at large angles, or beyond a
   !> datum; surfaces that end, are steep or are uncertain between points; yield; large rotations; wear of much at once; lost
   !> digits; an accuracy beyond that of the mesh.
   subroutine validity_warnings(simulation, observed, warnings)
      type(simulation_type), intent(in) :: simulation
      type(observed_type), intent(in) :: observed
      type(string_type), allocatable, intent(out) :: warnings(:)
      !> Largest residual without lost digits.
      real(wp), parameter :: good = 1.0e-8_wp
      type(unresolved_type), allocatable :: unresolved(:)
      integer :: i
      real(wp) :: largest

      allocate (warnings(0))
      associate (scene => simulation%contact%model%scene)
         call check_angle(simulation, 'lower', scene%lower, warnings)
         call check_angle(simulation, 'upper', scene%upper, warnings)
         call check_strain(simulation, scene, warnings)
         call check_datum(simulation, scene, warnings)
         call check_accuracy(simulation, scene, warnings)
         call warn_of_surface(simulation, .false., scene%lower, largest_angle, warnings)
         call warn_of_surface(simulation, .true., scene%upper, largest_angle, warnings)
         call check_yield(simulation, observed%extremes, .false., scene%lower, warnings)
         call check_yield(simulation, observed%extremes, .true., scene%upper, warnings)
      end associate
      call find_unresolved(simulation, unresolved)
      do i = 1, size(unresolved)
         call add_text(warnings, unresolved(i)%text)
      end do
      if (allocated(simulation%estimate)) then
         if (simulation%estimate%doubt /= '') call add_text(warnings, simulation%estimate%doubt)
      end if
      call check_order(simulation%contact%model%scene%lower, warnings)
      call check_rotation(simulation, warnings)
      call check_wear(simulation, warnings)
      call check_worn_layers(simulation, 'lower', simulation%contact%model%scene%lower, warnings)
      call check_worn_layers(simulation, 'upper', simulation%contact%model%scene%upper, warnings)
      call check_slide(simulation, simulation%contact%model%scene, warnings)
      if (simulation%cycle_count > 0) call check_drift(simulation%cycles(simulation%cycle_count), warnings)
      largest = simulation%contact%certificate%largest()
      if (largest > good) &
         call add_text(warnings, 'the largest relative residual is '//to_text(largest, 2)// &
                       ', well above rounding errors: results may be inaccurate; /certificate in the result file lists the '// &
                       'residuals by name')
      largest = simulation%contact%model%compliance%kernel_error
      if (largest > certified) &
         call add_text(warnings, 'the kernels of the layers have an estimated error of '//to_text(largest, 2)//' of their '// &
                       'largest value: all results may have errors of that size')
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
                    to_text(largest_angle, 2)//' degrees: there they are off by '// &
                    to_text(100.0_wp*sin(min(angle, 90.0_wp)*pi/180.0_wp), 2)//' % (sine) of the tractions')
   end subroutine check_angle

   !> Contacts that are not small: bodies deform as if their strains and displacements did not change their shapes. Strains are of
   !> the order of the mean pressure over E* = 2 m: 0.4 a/R of a cylinder, half the slope of a wedge.
   subroutine check_strain(simulation, scene, warnings)
      type(simulation_type), intent(in) :: simulation
      type(scene_type), intent(in) :: scene
      type(string_type), allocatable, intent(inout) :: warnings(:)
      !> That of a cylinder in contact up to 10 degrees; largest approach over the radius.
      real(wp), parameter :: largest_strain = 0.07_wp, largest_approach = 0.1_wp
      character(*), parameter :: consequence = ': the theory of small strains and displacements does not hold; tractions, '// &
                                 'contact_length, approach, shift, stiffnesses, dissipation and stresses are off '// &
                                 'by at least that much; check the units of radius, moduli and forces'
      real(wp) :: strain, approach, modulus, thickness
      type(near_field_type) :: over_width

      associate (state => simulation%contact%state, model => simulation%contact%model)
         if (state%contact_nodes() == 0 .or. .not. scene%modulus() > 0.0_wp) return
         ! Layers may be softer than what is below them, or stiffer.
         over_width = scene%near_field_over(sum(model%width, mask=in_contact(state%status)))
         modulus = min(scene%modulus(), over_width%modulus())
         strain = sum(state%fields%pressure*model%width)/sum(model%width, mask=in_contact(state%status))/(2.0_wp*modulus)
         approach = 0.0_wp
         thickness = scene%compressed_thickness()
         if (thickness > 0.0_wp) approach = state%fields%motion(motion_approach)/thickness
         if (approach > largest_approach) then
            call add_text(warnings, 'the approach is '//to_text(100.0_wp*approach, 2)//' % of the thickness of the layers'// &
                          consequence)
            return
         end if
         if (scene%lower%circular()) approach = state%fields%motion(motion_approach)/scene%lower%radius
         if (scene%upper%circular()) approach = max(approach, state%fields%motion(motion_approach)/scene%upper%radius)
      end associate
      if (strain > largest_strain) then
         call add_text(warnings, 'the mean contact pressure is '//to_text(100.0_wp*strain, 2)//' % of the contact modulus E*'// &
                       consequence)
      else if (approach > largest_approach) then
         call add_text(warnings, 'the approach is '//to_text(100.0_wp*approach, 2)//' % of the radius'//consequence)
      end if
   end subroutine check_strain

   !> An accuracy for which the program's equal intervals are too large: beyond the most nodes, or where the present contact is much
   !> smaller than the mesh, or is one of patches.
   subroutine check_accuracy(simulation, scene, warnings)
      type(simulation_type), intent(in) :: simulation
      type(scene_type), intent(in) :: scene
      type(string_type), allocatable, intent(inout) :: warnings(:)
      !> Error of the tractions times nodes in contact, for up to three times the accuracy.
      real(wp), parameter :: error_of_one = 0.08_wp
      type(zone_type) :: patch
      integer :: wanted, nodes
      character(:), allocatable :: needs

      if (.not. scene%mesh%nodes_by_accuracy .or. allocated(scene%mesh%ends) .or. .not. scene%friction%converges()) return
      if (.not. scene%method%accuracy > 0.0_wp) return
      wanted = scene%mesh%nodes_for(scene%method%accuracy)
      patch = poorest_patch(simulation)
      nodes = patch%last - patch%first + 1
      needs = 'accuracy='//to_text(scene%method%accuracy, 2)//' needs about '
      if (wanted > scene%mesh%nodes) then
         call add_text(warnings, needs//to_text(real(wanted, wp), 2)//' equal intervals; the mesh has '// &
                       to_text(scene%mesh%nodes)//": give nodes, or refine='edges'")
      else if (nodes < error_of_one/scene%method%accuracy) then
         call add_text(warnings, needs//to_text(nint(3.0_wp*error_of_one/scene%method%accuracy))// &
                       ' nodes in each patch of contact; a patch has '//to_text(nodes)//': give nodes')
      end if
   end subroutine check_accuracy

   !> A default datum that another case would not have; and a datum inside the contact (see hint_of_datum in mfv_simulation).
   subroutine check_datum(simulation, scene, warnings)
      type(simulation_type), intent(in) :: simulation
      type(scene_type), intent(in) :: scene
      type(string_type), allocatable, intent(inout) :: warnings(:)
      real(wp) :: half_width

      if (.not. scene%has_datum()) return
      if (simulation%contact%state%contact_nodes() == 0) return
      if (scene%lower%elasticity%datum_of_case .or. scene%upper%elasticity%datum_of_case) &
         call add_text(warnings, 'the datum of the displacements, '//to_text(scene%datum(), 4)//', is the half-width of the '// &
                       'contact at the largest normal_force of this case, or else of its mesh: give datum to compare '// &
                       'approaches, shifts and stiffnesses with those of other cases')
      half_width = simulation%contact%half_width()
      if (half_width > most_of_datum*scene%datum()) &
         call add_text(warnings, 'the contact half-width of '//to_text(half_width, 3)//' exceeds the datum '// &
                       to_text(scene%datum(), 3)//' at which displacements are measured: approach and shift are too small for '// &
                       'their forces, or negative; set a larger datum')
   end subroutine check_datum

   !> Cycles that wear too much at once: slip paths are constant within them, pressures are those at the end. In many more cycles,
   !> in which the wear becomes small, it tends to the same limit. And given blocks of cycles that wear otherwise than single ones.
   subroutine check_wear(simulation, warnings)
      type(simulation_type), intent(in) :: simulation
      type(string_type), allocatable, intent(inout) :: warnings(:)
      real(wp) :: worn, last

      associate (model => simulation%contact%model, state => simulation%contact%state)
         if (.not. model%scene%wear%acts() .or. simulation%cycle_count == 0) return
         worn = model%force(state%worn)
         last = worn - simulation%cycles(simulation%cycle_count)%worn_area
         if (min(state%coarsely_worn, last) > model%scene%wear%tolerance*worn) &
            call add_text(warnings, 'worn_area and wear_depth: '//to_text(100.0_wp*state%coarsely_worn/worn, 3)//' % of the '// &
                          'worn area is from cycles that each change the pressures or the wear by more than the fraction '// &
                          to_text(model%scene%wear%tolerance, 2)//' (tolerance of &wear): it may be half of the right one; '// &
                          'use a smaller coefficient and more cycles')
         if (state%wear_error > model%scene%wear%tolerance*worn) &
            call add_text(warnings, 'worn_area and wear_depth: the estimated error from the given blocks of cycles is '// &
                          to_text(100.0_wp*state%wear_error/worn, 3)//' %; use smaller blocks, or leave out block of &wear')
      end associate
   end subroutine check_wear

   !> Layers that are worn off.
   subroutine check_worn_layers(simulation, name, body, warnings)
      type(simulation_type), intent(in) :: simulation
      character(*), intent(in) :: name
      type(body_type), intent(in) :: body
      type(string_type), allocatable, intent(inout) :: warnings(:)
      !> Worn depth over the thickness.
      real(wp), parameter :: deepest = 0.1_wp

      if (.not. body%elasticity%is_layered()) return
      associate (model => simulation%contact%model, elasticity => body%elasticity, state => simulation%contact%state)
         if (model%scene%wear%acts() .and. maxval(state%worn) > deepest*elasticity%layer(1)%thickness) &
            call add_text(warnings, 'wear_depth is '//to_text(100.0_wp*maxval(state%worn)/elasticity%layer(1)%thickness, 2)// &
                          ' % of the first layer of the '//name//' body, whose thickness does not change in the model')
      end associate
   end subroutine check_worn_layers

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
                       to_text(100.0_wp*error, 2)//' %, the contact half-width about half of that, tractions and creepage '// &
                       'up to twice that; roll less far')
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
         else if (scene%lower%is_straight() .or. scene%upper%is_straight() .or. &
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

   !> A matrix with the components of each node in turn, instead of all normal ones first. Neighbouring rows are then the two
   !> components of one node, which almost everywhere displace each other less than the next node's.
   subroutine check_order(body, warnings)
      type(body_type), intent(in) :: body
      type(string_type), allocatable, intent(inout) :: warnings(:)
      real(wp), parameter :: almost_every = 0.8_wp
      integer :: i, n

      if (.not. body%is_matrix()) return
      n = size(body%position) - 2
      if (count([(body%elasticity%matrix(i, i + 1) < body%elasticity%matrix(i, i + 2), i=1, n)]) > almost_every*n .and. n > 1) &
         call add_text(warnings, 'the matrix seems to be in the wrong order, because neighbouring rows couple weakly: rows and '// &
                       'columns must have all normal components first, then all tangential ones')
   end subroutine check_order

   !> The largest von Mises stress of the load history, at the ends of its load segments, in the states where it may be.
   subroutine check_yield(simulation, extremes, upper, body, warnings)
      type(simulation_type), intent(in) :: simulation
      type(load_extremes_type), intent(in) :: extremes
      logical, intent(in) :: upper
      type(body_type), intent(in) :: body
      type(string_type), allocatable, intent(inout) :: warnings(:)
      type(largest_type) :: largest
      integer :: mark

      if (.not. body%has_strength()) return
      call find_largest_of_history(simulation, upper, extremes, largest, mark)
      if (mark == 0) return
      if (.not. ieee_is_finite(largest%value)) then
         call add_text(warnings, 'the '//merge('upper', 'lower', upper)//' body yields under any load: its stresses are '// &
                       'unbounded at a sharp corner; they are bounded with rounded edges')
      else if (largest%value > body%strength_at(largest%y)) then
         associate (where_it_is => simulation%marks(mark))
            call add_text(warnings, 'the largest von Mises stress of the '//merge('upper', 'lower', upper)//' body, '// &
                          to_text(largest%value, 4)//' '// &
                          trim(place_in_history(simulation, where_it_is%step, where_it_is%reversal))// &
                          ', exceeds its yield_strength '//to_text(body%strength_at(largest%y))//trim(in_layer(largest))// &
                          ': stresses and tractions are not valid beyond yield')
         end associate
      end if

   contains

      !> Which layer a stress is in, in words, padded with blanks; blank without layers.
      pure function in_layer(stress) result(words)
         type(largest_type), intent(in) :: stress
         character(len=40) :: words

         words = ''
         if (.not. body%elasticity%is_layered()) return
         words = ' in layer '//to_text(body%elasticity%layer_at(abs(stress%y)))
         if (body%elasticity%layer_at(abs(stress%y)) > body%elasticity%layer_count()) words = ' below the layers'
      end function in_layer
   end subroutine check_yield

   !> The end of a load segment in words; padded with blanks.
   pure function place_in_history(simulation, step, segment) result(text)
      type(simulation_type), intent(in) :: simulation
      integer, intent(in) :: step, segment
      character(len=80) :: text

      text = 'at the end of step '//to_text(step)
      if (segment > 1) text = 'at turning point '//to_text(segment)//' of step '//to_text(step)
      associate (steps => simulation%contact%model%scene%steps)
         if (step > size(steps)) return
         if (steps(step)%row > 0) then
            text = 'in row '//to_text(steps(step)%row + mod(segment - 1, steps(step)%turns()))//' of &history'
         else if (steps(step)%cycles > 0) then
            text = 'at turning point '//to_text(segment)//' of step '//to_text(step)
         end if
      end associate
   end function place_in_history

end module mfv_validity
