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
   use mfv_scene, only: control_displacement, control_force, control_keep, scene_type, step_type
   use mfv_simulation, only: simulation_type
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
         if (is_rotated(simulation)) return
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

   !> Whether there is a rotation or a moment to speak of.
   pure logical function is_rotated(simulation)
      type(simulation_type), intent(in) :: simulation
      integer :: i

      is_rotated = .false.
      do i = 1, size(simulation%taken)
         is_rotated = is_rotated .or. simulation%taken(i)%rotational_control /= control_keep
      end do
   end function is_rotated

   !> Pressed only, ever harder, with friction from the start and Goodman's coupling.
   logical function is_spence(simulation)
      type(simulation_type), intent(in) :: simulation
      real(wp) :: before
      integer :: i

      associate (model => simulation%contact%model)
         is_spence = model%compliance%has_block(block_up) .and. &
                     model%scene%friction%is_coulomb() .and. model%tangential .and. .not. alike(model%scene)
         before = 0.0_wp
         do i = 1, size(simulation%taken)
            associate (step => simulation%taken(i))
               is_spence = is_spence .and. step%friction .and. step%cycles == 0 &
                           .and. step%normal_control == control_force .and. step%normal_target >= before &
                           .and. .not. abs(step%tangential_target) > 0.0_wp
               before = step%normal_target
            end associate
         end do
      end associate
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

   !> A disk pressed to a constant normal force without shear (friction off, or no coupling), then sheared by forces.
   logical function is_mindlin(simulation)
      type(simulation_type), intent(in) :: simulation
      logical :: pressing
      integer :: i

      associate (model => simulation%contact%model, scene => simulation%contact%model%scene)
         is_mindlin = is_hertz(scene) .and. scene%friction%is_coulomb() .and. model%tangential
         pressing = .true.
         do i = 1, size(simulation%taken)
            associate (step => simulation%taken(i))
               pressing = pressing .and. .not. abs(step%tangential_target) > 0.0_wp
               if (pressing) then
                  is_mindlin = is_mindlin .and. (.not. step%friction .or. alike(scene) .or. &
                                                 .not. model%compliance%has_block(block_up)) &
                               .and. step%tangential_control /= control_displacement
               else
                  is_mindlin = is_mindlin .and. step%friction .and. step%normal_control == control_keep &
                               .and. step%tangential_control == control_force
               end if
            end associate
         end do
         is_mindlin = is_mindlin .and. .not. pressing
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
