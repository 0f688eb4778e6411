!> Which closed form holds for a scene and its load history so far, evaluated on its mesh: what a picture or a test can
!> hold the numbers against.
module mfv_closed_form
   use mfv_body, only: shape_flat_punch, shape_half_plane
   use mfv_compliance, only: block_up, block_wt
   use mfv_kinds, only: wp
   use mfv_reference_flat_punch, only: flat_punch_pressure
   use mfv_reference_hertz, only: hertz_half_width, hertz_pressure
   use mfv_reference_mindlin, only: mindlin_history_type, new_mindlin_history
   use mfv_reference_spence, only: spence_cylinder_shear, spence_flat_punch_shear
   use mfv_scene, only: scene_type
   use mfv_simulation, only: simulation_type, states_reversals, states_steps
   implicit none
   private
   public :: closed_form_type, closed_form_of

   type :: closed_form_type
      !> Where each comes from; empty where there is none.
      character(:), allocatable :: pressure_source, shear_source
      !> Tractions on the nodes, force/length^2.
      real(wp), allocatable :: pressure(:), shear(:)
      !> Contact half-width of the closed form, length.
      real(wp) :: half_width = 0.0_wp
      !> Shift at every record of the load history, length; only where there is a history and Mindlin's form holds.
      real(wp), allocatable :: shift(:)
   end type closed_form_type

   !> Beyond this part of the radius of a circle a contact half-width is too large for Hertz's forms.
   real(wp), parameter :: widest_hertz = 0.2_wp

contains

   !> The closed form of a simulation's present state. Hertz's forms are those of parabolas on half-planes: for the exact
   !> circle they are off by the order of (a/R)^2, for elastic disks and holes by that of a/R or less.
   function closed_form_of(simulation) result(form)
      type(simulation_type), intent(in) :: simulation
      type(closed_form_type) :: form

      form%pressure_source = ''
      form%shear_source = ''
      associate (model => simulation%contact%model, scene => simulation%contact%model%scene, &
                 force => simulation%contact%state%fields%normal_force)
         if (.not. (force > 0.0_wp .and. scene%modulus() > 0.0_wp)) return
         if (model%compliance%has_block(block_wt) .and. model%tangential .and. .not. alike(scene)) return
         if (simulation%way%rotated) return
         if (is_hertz(scene)) then
            form%half_width = hertz_half_width(force, 1.0_wp/scene%curvature(), scene%modulus())
            if (form%half_width > widest_hertz*min(scene%lower%half_extent(), scene%upper%half_extent())) return
            form%pressure = hertz_pressure(model%x, force, form%half_width)
            form%pressure_source = 'Hertz; Johnson 1985, section 4.2; dissertation eqs. 3.1, 3.2, 5.1'
         else if (scene%lower%shape == shape_half_plane .and. scene%upper%shape == shape_flat_punch &
                  .and. scene%upper%rigid) then
            form%half_width = scene%upper%to
            form%pressure = flat_punch_pressure(model%x, force, form%half_width)
            form%pressure_source = 'Johnson 1985, section 2.8; dissertation eq. 3.3'
         else
            return
         end if
         if (is_spence(simulation)) call add_spence(form, simulation)
         if (is_mindlin(simulation)) call add_mindlin(form, simulation)
      end associate
   end function closed_form_of

   !> Circles and half-planes that touch at a point.
   pure logical function is_hertz(scene)
      type(scene_type), intent(in) :: scene

      is_hertz = (scene%lower%circular() .or. scene%lower%shape == shape_half_plane) .and. &
                 (scene%upper%circular() .or. scene%upper%shape == shape_half_plane) .and. scene%curvature() > 0.0_wp
   end function is_hertz

   !> Whether Dundurs' beta vanishes: bodies of one material. What coupling their different shapes leave is of the order of
   !> a/R.
   pure logical function alike(scene)
      type(scene_type), intent(in) :: scene
      real(wp), parameter :: none = 1.0e-12_wp

      alike = abs(scene%dundurs_beta()) < none
   end function alike

   !> Pressed only, ever harder, with friction from the start and Goodman's coupling.
   logical function is_spence(simulation)
      type(simulation_type), intent(in) :: simulation

      associate (model => simulation%contact%model)
         is_spence = model%compliance%has_block(block_up) .and. &
                     model%scene%friction%is_coulomb() .and. model%tangential .and. .not. alike(model%scene)
      end associate
      is_spence = is_spence .and. simulation%way%pressed_harder
   end function is_spence

   subroutine add_spence(form, simulation)
      type(closed_form_type), intent(inout) :: form
      type(simulation_type), intent(in) :: simulation

      associate (x => simulation%contact%model%x, scene => simulation%contact%model%scene, &
                 force => simulation%contact%state%fields%normal_force)
         if (is_hertz(scene)) then
            form%shear = spence_cylinder_shear(x, force, form%half_width, scene%friction%static%largest(), &
                                               abs(scene%dundurs_beta()))
         else
            form%shear = spence_flat_punch_shear(x, force, form%half_width, scene%friction%static%largest(), &
                                                 abs(scene%dundurs_beta()))
         end if
         form%shear = sign(1.0_wp, scene%dundurs_beta())*form%shear
         form%shear_source = 'Spence 1973; dissertation eqs. 3.4 to 3.6, corrected'
      end associate
   end subroutine add_spence

   !> A disk pressed to a constant normal force without shear (friction off, or no coupling), then sheared by forces, of which
   !> every turn was kept.
   logical function is_mindlin(simulation)
      type(simulation_type), intent(in) :: simulation

      associate (model => simulation%contact%model, way => simulation%way)
         is_mindlin = is_hertz(model%scene) .and. model%scene%friction%is_coulomb() .and. model%tangential .and. &
                      way%pressed_then_sheared .and. way%sheared .and. &
                      (.not. way%friction_in_press .or. alike(model%scene) .or. .not. model%compliance%has_block(block_up)) .and. &
                      (simulation%keep_states == states_reversals .or. &
                       simulation%keep_states == states_steps .and. .not. way%cycled)
      end associate
   end function is_mindlin

   subroutine add_mindlin(form, simulation)
      type(closed_form_type), intent(inout) :: form
      type(simulation_type), intent(in) :: simulation
      type(mindlin_history_type) :: history
      integer :: i

      associate (contact => simulation%contact, scene => simulation%contact%model%scene, &
                 force => simulation%contact%state%fields%normal_force)
         history = new_mindlin_history(force, form%half_width, 1.0_wp/scene%curvature(), scene%datum(), &
                                       scene%friction%static%largest())
         do i = 1, simulation%snapshot_count
            call history%load(simulation%snapshots(i)%state%fields%tangential_force)
         end do
         call history%load(contact%state%fields%tangential_force)
         form%shear = history%shear(contact%model%x)
         form%shear_source = 'Cattaneo 1938, Mindlin 1949; dissertation eqs. 3.7, 3.8, corrected'

         history%turning = [real(wp) ::]
         allocate (form%shift(contact%history%records))
         do i = 1, contact%history%records
            call history%load(contact%history%record(i)%tangential_force)
            form%shift(i) = history%shift()
         end do
      end associate
   end subroutine add_mindlin

end module mfv_closed_form
