!> The closed form of a scene and its load history so far, evaluated on its mesh, for comparison in pictures and tests.
module mfv_closed_form
   use mfv_compliance, only: block_up, block_wt
   use mfv_kinds, only: wp
   use mfv_motions, only: motion_approach, motion_shift, motion_rotation
   use mfv_near_field, only: near_field_type
   use mfv_node_status, only: node_stick
   use mfv_reference_carter, only: carter_shear
   use mfv_reference_flat_punch, only: flat_punch_pressure
   use mfv_reference_indenter, only: indenter_type
   use mfv_reference_mindlin, only: mindlin_history_type, new_mindlin_history
   use mfv_reference_spence, only: spence_cylinder_shear, spence_flat_punch_shear
   use mfv_reference_wave, only: new_wave_contact, wave_type
   use mfv_scene, only: scene_type
   use mfv_scene_indenter, only: indenter_of
   use mfv_simulation, only: simulation_type, states_auto, states_reversals, states_steps
   use mfv_tolerances, only: significant
   implicit none
   private
   public :: closed_form_type, closed_form_of

   type :: closed_form_type
      !> Source of each; empty without a closed form.
      character(:), allocatable :: pressure_source, shear_source
      !> Tractions on the nodes, force/length^2.
      real(wp), allocatable :: pressure(:), shear(:)
      !> Half-width of the contact by the closed form, length.
      real(wp) :: half_width = 0.0_wp
      !> Shift at every record of the load history, length; only for Mindlin's solution and with a recorded history.
      real(wp), allocatable :: shift(:)
      !> The gap, if there is a closed form.
      type(indenter_type), private :: indenter
   end type closed_form_type

   !> Largest contact half-width over the radius of a circle for which parabolas on half-planes are a good approximation.
   real(wp), parameter :: widest_hertz = 0.2_wp

contains

   !> Closed form for the present state of a simulation. It holds for parabolas on half-planes: errors are of the order
   !> (a/R)^2 for rigid circles, up to a/R for elastic disks and holes.
   type(closed_form_type) function closed_form_of(simulation) result(form)
      type(simulation_type), intent(in) :: simulation

      form%pressure_source = ''
      form%shear_source = ''
      associate (model => simulation%contact%model, scene => simulation%contact%model%scene, &
                 force => simulation%contact%state%fields%force(motion_approach))
         if (.not. (force > 0.0_wp .and. scene%modulus() > 0.0_wp) .or. scene%is_layered()) return
         if (model%tangential .and. model%couples(block_wt)) return
         if (any(simulation%load_summary%controlled(motion_rotation + 1:))) return
         if (any(abs(model%worn) > 0.0_wp)) return
         if (scene%mesh%period > 0.0_wp) then
            call add_wave(form, simulation)
            return
         end if
         if (simulation%load_summary%controlled(motion_rotation) .and. .not. (is_hertz(scene) .and. model%rolls())) return
         form%indenter = indenter_of(scene)
         if (.not. form%indenter%is_flat() .and. .not. (scene%lower%has_sharp_ends() .or. scene%upper%has_sharp_ends())) then
            form%half_width = form%indenter%half_width(0.5_wp*force/scene%modulus())
            if (form%half_width > widest(scene)) return
            call add_pressure(form, simulation)
         else if (scene%lower%is_straight() .and. scene%upper%has_sharp_ends() &
                  .and. scene%upper%rigid) then
            form%half_width = scene%upper%to
            form%pressure = flat_punch_pressure(model%x, force, form%half_width)
            form%pressure_source = 'Johnson 1985, section 2.8; dissertation eq. 3.3'
         else
            return
         end if
         if (simulation%load_summary%controlled(motion_rotation)) then
            if (is_carter(simulation, form%half_width)) call add_carter(form, simulation)
            return
         end if
         if (is_spence(simulation)) call add_spence(form, simulation)
         if (is_mindlin(form, simulation)) call add_mindlin(form, simulation)
      end associate
   end function closed_form_of

   !> Pressure of a wave on a straight surface, of which the mesh has one period.
   subroutine add_wave(form, simulation)
      type(closed_form_type), intent(inout) :: form
      type(simulation_type), intent(in) :: simulation
      type(wave_type) :: wave

      associate (model => simulation%contact%model, scene => simulation%contact%model%scene, &
                 force => simulation%contact%state%fields%force(motion_approach))
         if (.not. (scene%lower%is_straight() .or. scene%upper%is_straight())) return
         associate (wavelength => max(scene%lower%wavelength, scene%upper%wavelength))
            if (abs(wavelength - scene%mesh%period) > significant*scene%mesh%period) return
            wave = new_wave_contact(max(scene%lower%amplitude, scene%upper%amplitude), wavelength, scene%modulus())
         end associate
         form%half_width = wave%half_width(force)
         form%pressure = wave%pressure(model%x, force)
         form%pressure_source = 'Westergaard 1939; Johnson 1985, section 13.2'
      end associate
   end subroutine add_wave

   !> Positions of the nodes, length, from the middle of the contact, which may have rolled.
   function middle_at_zero(simulation) result(position)
      type(simulation_type), intent(in) :: simulation
      real(wp), allocatable :: position(:)

      associate (model => simulation%contact%model)
         position = model%x
         if (simulation%load_summary%controlled(motion_rotation)) &
            position = model%arc - model%rolled(simulation%contact%state%fields)
      end associate
   end function middle_at_zero

   !> Similar bodies that have rolled far enough under constant forces, without gross sliding; `half_width`: Hertz's, length.
   logical function is_carter(simulation, half_width)
      type(simulation_type), intent(in) :: simulation
      real(wp), intent(in) :: half_width

      associate (contact => simulation%contact, model => simulation%contact%model)
         is_carter = model%scene%friction%is_coulomb() .and. model%tangential .and. contact%rolling%is_steady(half_width) .and. &
                     .not. model%couples(block_up) .and. &
                     any(contact%state%status == node_stick)
      end associate
   end function is_carter

   subroutine add_carter(form, simulation)
      type(closed_form_type), intent(inout) :: form
      type(simulation_type), intent(in) :: simulation
      real(wp), allocatable :: position(:)

      position = middle_at_zero(simulation)
      if (.not. simulation%contact%rolling%heads_right()) position = -position
      associate (fields => simulation%contact%state%fields)
         form%shear = carter_shear(position, fields%force(motion_shift), fields%force(motion_approach), form%half_width, &
                                   simulation%contact%model%scene%friction%static%largest())
      end associate
      form%shear_source = 'Carter 1926; Johnson 1985, section 8.3'
   end subroutine add_carter

   !> Largest contact half-width with a closed form, length; unlimited for rigid parabolas on a half-plane.
   pure real(wp) function widest(scene)
      type(scene_type), intent(in) :: scene

      widest = huge(1.0_wp)
      if (.not. scene%mesh%parabolic .or. scene%arc_radius() > 0.0_wp) &
         widest = widest_hertz*min(scene%lower%half_extent(), scene%upper%half_extent())
   end function widest

   !> Pressure of an indenter at the nodes. At a sharp tip, where it is infinite, the mean over the interval of the node.
   subroutine add_pressure(form, simulation)
      type(closed_form_type), intent(inout) :: form
      type(simulation_type), intent(in) :: simulation
      real(wp), allocatable :: x(:)

      associate (model => simulation%contact%model)
         x = middle_at_zero(simulation)
         ! ln(2 a/x) at x is the mean of ln(2 a/s) over |s| < e x.
         if (form%indenter%is_pointed()) x = max(abs(x), 0.5_wp*model%interval()*exp(-1.0_wp))
         form%pressure = 2.0_wp*model%scene%modulus()*form%indenter%pressure(x, form%half_width)
         form%pressure_source = 'superposed flat punches; Jaeger 2005'
         if (size(form%indenter%flat) > 0) form%pressure_source = 'Ciavarella, Hills and Monno 1998'
         if (is_hertz(model%scene)) form%pressure_source = 'Hertz; Johnson 1985, section 4.2; dissertation eqs. 3.1, 3.2, 5.1'
      end associate
   end subroutine add_pressure

   !> Circles and half-planes that touch at a point.
   pure logical function is_hertz(scene)
      type(scene_type), intent(in) :: scene

      is_hertz = (scene%lower%circular() .or. scene%lower%is_straight()) .and. &
                 (scene%upper%circular() .or. scene%upper%is_straight()) .and. scene%curvature() > 0.0_wp
   end function is_hertz

   !> Monotonic pressing with friction from the start and Goodman's coupling.
   logical function is_spence(simulation)
      type(simulation_type), intent(in) :: simulation
      type(near_field_type) :: pair

      pair = simulation%contact%model%scene%near_field()
      associate (model => simulation%contact%model)
         is_spence = (is_hertz(model%scene) .or. model%scene%upper%has_sharp_ends()) .and. &
                     model%couples(block_up) .and. model%scene%friction%is_coulomb() .and. model%tangential
      end associate
      is_spence = is_spence .and. simulation%load_summary%pressed_harder .and. .not. abs(pair%mixed) > 0.0_wp
   end function is_spence

   !> Of orthotropic bodies the shear times root(At/A) is that of isotropic ones with as many times the friction (docs/theory.md).
   subroutine add_spence(form, simulation)
      type(closed_form_type), intent(inout) :: form
      type(simulation_type), intent(in) :: simulation
      type(near_field_type) :: pair
      real(wp) :: factor

      pair = simulation%contact%model%scene%near_field()
      factor = sqrt(pair%shear_ratio())
      associate (x => simulation%contact%model%x, scene => simulation%contact%model%scene, &
                 force => simulation%contact%state%fields%force(motion_approach))
         if (is_hertz(scene)) then
            form%shear = spence_cylinder_shear(x, force, form%half_width, factor*scene%friction%static%largest(), &
                                               abs(scene%beta()))
         else
            form%shear = spence_flat_punch_shear(x, force, form%half_width, factor*scene%friction%static%largest(), &
                                                 abs(scene%beta()))
         end if
         form%shear = sign(1.0_wp/factor, scene%beta())*form%shear
         form%shear_source = 'Spence 1973; dissertation eqs. 3.4 to 3.6, corrected'
      end associate
   end subroutine add_spence

   !> An indenter pressed to a constant normal force without shear (friction off or no coupling), then loaded by tangential
   !> forces whose turning points are all recorded.
   logical function is_mindlin(form, simulation)
      type(closed_form_type), intent(in) :: form
      type(simulation_type), intent(in) :: simulation

      associate (model => simulation%contact%model, summary => simulation%load_summary)
         is_mindlin = .not. form%indenter%is_flat() .and. model%scene%friction%is_coulomb() .and. model%tangential .and. &
                      summary%pressed_then_sheared .and. summary%sheared .and. &
                      .not. (summary%friction_in_press .and. model%couples(block_up)) .and. &
                      (any(simulation%keep_states == [states_auto, states_reversals]) .or. &
                       simulation%keep_states == states_steps .and. .not. summary%cycled)
      end associate
   end function is_mindlin

   subroutine add_mindlin(form, simulation)
      type(closed_form_type), intent(inout) :: form
      type(simulation_type), intent(in) :: simulation
      type(mindlin_history_type) :: history
      type(near_field_type) :: pair
      integer :: i

      associate (contact => simulation%contact, scene => simulation%contact%model%scene, &
                 force => simulation%contact%state%fields%force(motion_approach))
         pair = scene%near_field()
         history = new_mindlin_history(force, form%half_width, form%indenter, scene%datum(by_shear=.true.), &
                                       scene%friction%static%largest())
         do i = 1, simulation%snapshot_count
            call history%load(simulation%snapshots(i)%state%fields%force(motion_shift))
         end do
         call history%load(contact%state%fields%force(motion_shift))
         form%shear = history%shear(contact%model%x)
         form%shear_source = 'Jaeger 1998, Ciavarella 1998'
         if (is_hertz(scene)) form%shear_source = 'Cattaneo 1938, Mindlin 1949; dissertation eqs. 3.7, 3.8, corrected'

         history%turning = [real(wp) ::]
         allocate (form%shift(contact%history%records))
         do i = 1, contact%history%records
            call history%load(contact%history%record(i)%force(motion_shift))
            form%shift(i) = pair%shear_ratio()*history%shift()
         end do
      end associate
   end subroutine add_mindlin

end module mfv_closed_form
