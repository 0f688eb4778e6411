!> Platform-independent random scenes: laws, couplings, materials, shapes and load paths by a number.
module test_random_scenes_support
   use, intrinsic :: iso_fortran_env, only: int64
   use mfv_body
   use mfv_geometry
   use mfv_compliance, only: coupling_full, coupling_goodman, coupling_none
   use test_friction
   use mfv_contact_state, only: contact_state_type
   use mfv_kinds, only: pi, wp
   use mfv_material, only: new_material, plane_strain, plane_stress
   use mfv_motions, only: motion_approach, motion_shift, motion_rotation, control_keep, control_force, control_displacement
   use mfv_observer, only: observer_type
   use mfv_scene
   implicit none
   private
   public :: random_scene, random_pin, law_count, law_names, patience_type, generator_type

   integer, parameter :: law_count = 5
   character(*), parameter :: law_names(law_count) = [character(14) :: 'none', 'coulomb', 'static_kinetic', 'weakening', 'dahl']

   !> Minimal standard generator of Park and Miller (1988, Comm. ACM 31, 1192).
   type :: generator_type
      integer(int64) :: state = 1
   contains
      procedure :: between
      procedure :: one_of
      procedure :: chance
      procedure :: chance_where
   end type generator_type

   !> Stops a run with chatter after a number of increments.
   type, extends(observer_type) :: patience_type
      integer :: increments = 0, most_increments = 400
   contains
      procedure :: notify
   end type patience_type

   !> Scales of a contact: force P, half-width, approach and shift, coefficient of friction.
   type :: sizes_type
      real(wp) :: force = 1.0_wp, half_width = 1.0_wp, approach = 1.0_wp, shift = 1.0_wp, mu = 0.0_wp, radius = 0.0_wp
   end type sizes_type

contains

   !> Scene `number` >= 1; `law`: its entry in law_names.
   subroutine random_scene(number, scene, law)
      integer, intent(in) :: number
      type(scene_type), intent(out) :: scene
      integer, intent(out) :: law
      type(generator_type) :: random
      type(sizes_type) :: sizes
      integer :: i
      real(wp) :: unused

      random%state = 1 + 7919_int64*number
      do i = 1, 5
         unused = random%between(0.0_wp, 1.0_wp)
      end do
      scene%title = 'random'
      scene%plane = merge(plane_strain, plane_stress, random%chance(0.7_wp))
      scene%coupling = random%one_of([coupling_full, coupling_full, coupling_goodman, coupling_none])
      call choose_bodies(random, scene, sizes)
      call choose_friction(random, scene, sizes, law)
      allocate (scene%steps(0))
      call choose_steps(random, scene, sizes)
      scene%method%friction_tolerance = 1.0e-2_wp
   end subroutine random_scene

   !> Pin `number` >= 1 in its bore, with radial normals: couplings, materials, clearances, the pin below or above, at most
   !> one rigid body, up to 40 degrees; pressed, sheared, pressed again and perhaps rotated, by forces.
   subroutine random_pin(number, scene)
      integer, intent(in) :: number
      type(scene_type), intent(out) :: scene
      type(generator_type) :: random
      type(body_type) :: pin, bore
      type(step_type) :: press, shear
      real(wp) :: force, mu, unused
      integer :: elastic, i

      random%state = 1 + 6007_int64*number
      do i = 1, 5
         unused = random%between(0.0_wp, 1.0_wp)
      end do
      scene%title = 'random pin'
      scene%plane = merge(plane_strain, plane_stress, random%chance(0.7_wp))
      scene%coupling = random%one_of([coupling_full, coupling_goodman, coupling_none])
      pin = new_body(new_disk(10.0_wp**random%between(-2.0_wp, 2.0_wp)))
      bore = new_body(new_hole(pin%radius*(1.0_wp + 10.0_wp**random%between(-4.0_wp, -0.3_wp))))
      elastic = random%one_of([1, 2, 3, 3, 3])
      if (elastic /= 2) call make_elastic(random, scene%plane, pin%radius, pin)
      if (elastic /= 1) call make_elastic(random, scene%plane, bore%radius, bore)
      scene%lower = bore
      scene%upper = pin
      if (random%chance(0.5_wp)) then
         scene%lower = pin
         scene%upper = bore
      end if
      scene%mesh = mesh_request_type(nodes=21 + int(random%between(0.0_wp, 15.99_wp)), half_width=1.2_wp*bore%radius, &
                                     radial=.true.)
      mu = random%between(0.05_wp, 0.8_wp)
      scene%friction = coulomb_friction(mu)
      force = 0.25_wp*pi*scene%modulus()*scene%curvature()*(random%between(0.2_wp, 0.7_wp)*bore%radius)**2

      press%control(motion_approach) = control_force
      press%target(motion_approach) = force
      shear%control(motion_shift) = control_force
      shear%target(motion_shift) = random%between(-0.5_wp, 0.5_wp)*mu*force
      shear%cycles = random%one_of([0, 0, 1])
      scene%steps = [press, shear]
      press%target(motion_approach) = random%between(0.4_wp, 1.2_wp)*force
      scene%steps = [scene%steps, press]
      if (.not. random%chance(0.5_wp)) return
      shear = step_type()
      shear%control(motion_rotation) = control_force
      shear%target(motion_rotation) = random%between(-0.2_wp, 0.2_wp)*mu*force*pin%radius
      scene%steps = [scene%steps, shear]
   end subroutine random_pin

   !> Both bodies and the mesh, for a half-width of 2 to 8 % of a radius.
   subroutine choose_bodies(random, scene, sizes)
      type(generator_type), intent(inout) :: random
      type(scene_type), intent(inout) :: scene
      type(sizes_type), intent(inout) :: sizes
      integer :: shapes
      real(wp) :: radius
      logical :: both

      radius = 10.0_wp**random%between(-2.0_wp, 2.0_wp)
      sizes%half_width = random%between(0.02_wp, 0.08_wp)*radius
      shapes = random%one_of([1, 2, 3, 4, 5, 6, 7])
      scene%lower = new_body(new_half_plane_surface())
      scene%upper = new_body(new_disk(radius))
      select case (shapes)
      case (3)
         scene%lower = new_body(new_disk(radius))
         scene%upper = new_body(new_half_plane_surface())
      case (4)
         scene%lower = new_body(new_disk(random%between(1.0_wp, 2.0_wp)*radius))
      case (5, 6)
         scene%lower = new_body(new_hole(random%between(1.3_wp, 3.0_wp)*radius))
      case (7)
         scene%upper = new_body(new_flat_punch(sizes%half_width))
      end select
      call make_elastic(random, scene%plane, radius, scene%lower)
      both = random%chance(0.5_wp)
      if (both .and. shapes /= 7 .and. shapes /= 3) call make_elastic(random, scene%plane, radius, scene%upper)
      sizes%radius = merge(radius, 0.0_wp, shapes == 1 .or. shapes == 2)

      scene%mesh%nodes = 11 + int(random%between(0.0_wp, 20.99_wp))
      if (shapes == 7) then
         scene%mesh%half_width = sizes%half_width
         sizes%force = random%between(0.001_wp, 0.01_wp)*scene%modulus()*sizes%half_width
      else
         sizes%force = 0.5_wp*pi*scene%modulus()*sizes%half_width**2*scene%curvature()
         if (random%chance(0.5_wp)) scene%mesh%half_width = 1.4_wp*sizes%half_width
      end if
      sizes%approach = sizes%force/(pi*scene%modulus())*(0.5_wp + log(2.0_wp*scene%datum()/sizes%half_width))
   end subroutine choose_bodies

   subroutine make_elastic(random, plane, datum, body)
      type(generator_type), intent(inout) :: random
      integer, intent(in) :: plane
      real(wp), intent(in) :: datum
      type(body_type), intent(inout) :: body
      real(wp) :: modulus, ratio

      modulus = 10.0_wp**random%between(-3.0_wp, 3.0_wp)
      ratio = random%between(-0.9_wp, 0.5_wp)
      body%rigid = .false.
      body%elasticity%material = new_material(modulus, ratio, plane)
      body%elasticity%datum = datum
      if (body%circular()) body%elasticity%datum = body%radius
   end subroutine make_elastic

   subroutine choose_friction(random, scene, sizes, law)
      type(generator_type), intent(inout) :: random
      type(scene_type), intent(inout) :: scene
      type(sizes_type), intent(inout) :: sizes
      integer, intent(out) :: law
      real(wp) :: mu, kinetic, part

      mu = 10.0_wp**random%between(-1.3_wp, 0.3_wp)
      kinetic = mu*random%between(0.6_wp, 1.0_wp)
      part = 10.0_wp**random%between(-1.0_wp, 2.0_wp)
      sizes%mu = mu
      sizes%shift = mu*sizes%approach
      law = random%one_of([1, 2, 2, 2, 3, 3, 4, 4, 5])
      select case (law)
      case (1)
         scene%friction = no_friction()
      case (2)
         scene%friction = coulomb_friction(mu)
      case (3)
         scene%friction = static_kinetic_friction(mu, kinetic)
      case (4)
         scene%friction = weakening_friction(mu, kinetic, part*mu*sizes%force/scene%modulus())
      case default
         scene%friction = dahl_friction(mu, 10.0_wp*part*scene%modulus()/sizes%half_width, &
                                        0.5_wp*random%one_of([0, 1, 2, 2, 3, 4]))
      end select
      if (.not. random%chance_where(law /= 1, 0.2_wp)) return
      scene%friction%static%value = [1.2_wp, 0.8_wp]*mu
      scene%friction%static%position = [-1.0_wp, 1.0_wp]*random%between(0.1_wp, 2.0_wp)*sizes%half_width
      scene%friction%kinetic = scene%friction%static
      if (law == 3 .or. law == 4) scene%friction%kinetic%value = [1.0_wp, 0.8_wp]*kinetic
   end subroutine choose_friction

   !> Two to five steps: a press, then forces or displacements, together or one after the other, cycles, a moment.
   subroutine choose_steps(random, scene, sizes)
      type(generator_type), intent(inout) :: random
      type(scene_type), intent(inout) :: scene
      type(sizes_type), intent(in) :: sizes
      type(step_type) :: step
      real(wp) :: normal, part
      logical :: friction, presses, shears
      integer :: i

      friction = scene%friction%acts()
      normal = 1.0_wp
      do i = 1, random%one_of([2, 3, 4, 5])
         step = step_type()
         presses = random%chance_where(i > 1, 0.4_wp)
         if (presses .or. i == 1 .or. .not. friction) then
            if (i > 1) normal = random%between(0.1_wp, 1.2_wp)
            if (random%chance_where(i > 1, 0.05_wp)) normal = 0.0_wp
            step%control(motion_approach) = merge(control_force, control_displacement, random%chance(0.8_wp))
            step%target(motion_approach) = normal*merge(sizes%force, sizes%approach, step%control(motion_approach) == control_force)
         end if
         shears = random%chance_where(friction, merge(0.2_wp, 0.7_wp, i == 1))
         if (shears .or. (friction .and. i > 1 .and. step%control(motion_approach) == control_keep)) then
            part = random%between(-1.0_wp, 1.0_wp)
            step%control(motion_shift) = merge(control_force, control_displacement, random%chance(0.8_wp))
            step%target(motion_shift) = part*min(normal, 1.0_wp)*merge(sizes%mu*sizes%force, sizes%shift, &
                                                                       step%control(motion_shift) == control_force)
         end if
         if (i == 1) step%friction = random%chance_where(friction, 0.8_wp)
         if (random%chance_where(i > 1, 0.3_wp)) step%cycles = random%one_of([1, 2])
         if (random%chance_where(i > 1 .and. friction .and. sizes%radius > 0.0_wp, 0.2_wp)) then
            step%control(motion_rotation) = control_force
            step%target(motion_rotation) = random%between(-0.3_wp, 0.3_wp)*normal*sizes%force*sizes%half_width
         end if
         scene%steps = [scene%steps, step]
      end do
   end subroutine choose_steps

   !> Uniform between two numbers.
   real(wp) function between(self, low, high)
      class(generator_type), intent(inout) :: self
      real(wp), intent(in) :: low, high
      integer(int64), parameter :: multiplier = 16807, modulus = 2147483647

      self%state = mod(multiplier*self%state, modulus)
      between = low + (high - low)*real(self%state, wp)/real(modulus, wp)
   end function between

   integer function one_of(self, choices)
      class(generator_type), intent(inout) :: self
      integer, intent(in) :: choices(:)

      one_of = choices(1 + int(self%between(0.0_wp, 0.999999_wp)*size(choices)))
   end function one_of

   !> True with this probability.
   logical function chance(self, probability)
      class(generator_type), intent(inout) :: self
      real(wp), intent(in) :: probability

      chance = self%between(0.0_wp, 1.0_wp) < probability
   end function chance

   !> The same if it is `possible`; otherwise false without drawing a number. (The evaluation of a logical expression, and
   !> with it the scenes, would depend on the optimisation.)
   logical function chance_where(self, possible, probability)
      class(generator_type), intent(inout) :: self
      logical, intent(in) :: possible
      real(wp), intent(in) :: probability

      chance_where = .false.
      if (possible) chance_where = self%chance(probability)
   end function chance_where

   !> Stop after a number of increments.
   subroutine notify(self, state, segment, segments, fraction, stop_wanted)
      class(patience_type), intent(inout) :: self
      type(contact_state_type), intent(in) :: state
      integer, intent(in) :: segment, segments
      real(wp), intent(in) :: fraction
      logical, intent(out) :: stop_wanted

      self%increments = self%increments + 1
      stop_wanted = self%increments > self%most_increments
   end subroutine notify

end module test_random_scenes_support
