!> Scenes of several suites: the dissertation's cylinder and punch on a half-plane.
module test_scenes
   use mfv_body
   use mfv_geometry
   use mfv_compliance, only: coupling_full
   use test_friction, only: coulomb_friction, no_friction
   use mfv_kinds, only: wp
   use mfv_material, only: new_material, plane_strain
   use mfv_motions, only: motion_approach, motion_shift, control_force
   use mfv_scene
   use mfv_simulation, only: history_events, new_simulation, simulation_type
   implicit none
   private
   public :: body, two_bodies, cylinder, flat_punch, press, shear, solved, dissipation_by_segments, radius, &
             shear_modulus, poisson_ratio

   !> Dissertation section 3.1: R = 0.25, G = 1, nu = 0.3.
   real(wp), parameter :: radius = 0.25_wp, shear_modulus = 1.0_wp, poisson_ratio = 0.3_wp

contains

   !> A body with a shape of mfv_body that needs at most a radius; elastic in plane strain with G = `modulus` and its radius
   !> (a half-plane: 1) as datum, or rigid.
   function body(shape, body_radius, modulus, ratio) result(self)
      integer, intent(in) :: shape
      real(wp), intent(in), optional :: body_radius, modulus, ratio
      type(body_type) :: self

      select case (shape)
      case (shape_disk)
         self = new_body(new_disk(body_radius))
      case (shape_hole)
         self = new_body(new_hole(body_radius))
      case default
         self = new_body(new_half_plane_surface())
      end select
      if (.not. present(modulus)) return
      self%rigid = .false.
      self%elasticity%material = new_material(modulus, ratio, plane_strain)
      self%elasticity%datum = 1.0_wp
      if (self%circular()) self%elasticity%datum = self%radius
   end function body

   !> Two bodies on intervals over [-half_width, half_width] of the surface; 0: automatic.
   function two_bodies(lower, upper, nodes, half_width, mu, coupling) result(scene)
      type(body_type), intent(in) :: lower, upper
      integer, intent(in) :: nodes
      real(wp), intent(in) :: half_width
      real(wp), intent(in), optional :: mu
      integer, intent(in), optional :: coupling
      type(scene_type) :: scene

      scene = base(nodes, half_width, mu, coupling)
      scene%lower = lower
      scene%upper = upper
   end function two_bodies

   !> Rigid cylinder on the half-plane, with Hertz's parabola; mu = 0: no friction.
   function cylinder(nodes, half_width, mu, coupling) result(scene)
      integer, intent(in) :: nodes
      real(wp), intent(in) :: half_width
      real(wp), intent(in), optional :: mu
      integer, intent(in), optional :: coupling
      type(scene_type) :: scene

      scene = base(nodes, half_width, mu, coupling)
      scene%upper = new_body(new_disk(radius))
      scene%lower%elasticity%datum = radius
      scene%mesh%parabolic = .true.
   end function cylinder

   !> Rigid flat punch of half-width `punch` on the half-plane.
   function flat_punch(nodes, punch, mu, coupling) result(scene)
      integer, intent(in) :: nodes
      real(wp), intent(in) :: punch
      real(wp), intent(in), optional :: mu
      integer, intent(in), optional :: coupling
      type(scene_type) :: scene

      scene = base(nodes, punch, mu, coupling)
      scene%upper = new_body(new_flat_punch(punch))
      scene%lower%elasticity%datum = punch
   end function flat_punch

   function base(nodes, half_width, mu, coupling) result(scene)
      integer, intent(in) :: nodes
      real(wp), intent(in) :: half_width
      real(wp), intent(in), optional :: mu
      integer, intent(in), optional :: coupling
      type(scene_type) :: scene

      scene%title = 'test'
      scene%lower = body(shape_half_plane, modulus=shear_modulus, ratio=poisson_ratio)
      scene%mesh = mesh_request_type(nodes, half_width)
      scene%coupling = coupling_full
      if (present(coupling)) scene%coupling = coupling
      scene%friction = no_friction()
      if (present(mu)) scene%friction = coulomb_friction(mu)
      allocate (scene%steps(0))
   end function base

   !> Append a step to a normal force.
   subroutine press(scene, normal_force, friction)
      type(scene_type), intent(inout) :: scene
      real(wp), intent(in) :: normal_force
      logical, intent(in) :: friction
      type(step_type) :: step

      step%control(motion_approach) = control_force
      step%target(motion_approach) = normal_force
      step%friction = friction
      scene%steps = [scene%steps, step]
   end subroutine press

   !> Append a step to a tangential force, with cycles where present.
   subroutine shear(scene, tangential_force, cycles)
      type(scene_type), intent(inout) :: scene
      real(wp), intent(in) :: tangential_force
      integer, intent(in), optional :: cycles
      type(step_type) :: step

      step%control(motion_shift) = control_force
      step%target(motion_shift) = tangential_force
      if (present(cycles)) step%cycles = cycles
      scene%steps = [scene%steps, step]
   end subroutine shear

   !> Run the scene through its steps.
   function solved(scene) result(simulation)
      type(scene_type), intent(in) :: scene
      type(simulation_type) :: simulation

      simulation = new_simulation(scene, history_events)
      call simulation%run()
   end function solved

   !> Dissipation of each load segment whose end is kept, force.
   function dissipation_by_segments(simulation) result(dissipation)
      type(simulation_type), intent(in) :: simulation
      real(wp), allocatable :: dissipation(:)
      integer :: i

      associate (s => simulation%snapshots(:simulation%snapshot_count))
         dissipation = [(s(i)%state%dissipation, i=1, size(s))]
         dissipation(2:) = dissipation(2:) - [(s(i)%state%dissipation, i=1, size(s) - 1)]
      end associate
   end function dissipation_by_segments

end module test_scenes
