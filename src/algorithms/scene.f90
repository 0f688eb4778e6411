!> A scene: what touches what, on which mesh, with which friction, and how it is loaded. No files, no solution.
module mfv_scene
   use mfv_compliance, only: coupling_full
   use mfv_friction, only: friction_type
   use mfv_indenter, only: indenter_type
   use mfv_kinds, only: wp
   use mfv_material, only: material_type, plane_strain
   implicit none
   private
   public :: scene_type, mesh_request_type, step_type, control_keep, control_force, control_displacement

   !> What a step does with the normal or the tangential load: leave it as it is, lead the force to a target, or lead
   !> the rigid displacement (approach, shift) to a target.
   integer, parameter :: control_keep = 0, control_force = 1, control_displacement = 2

   !> One step of the load history; targets are reached linearly from the step before.
   type :: step_type
      integer :: normal_control = control_keep, tangential_control = control_keep
      !> Normal force P >= 0 (force/length) or approach delta (length).
      real(wp) :: normal_target = 0.0_wp
      !> Tangential force Q (force/length) or shift U (length), positive to the right.
      real(wp) :: tangential_target = 0.0_wp
      !> Whether friction acts during this step.
      logical :: friction = .true.
      !> 0: go to the targets and stay; n: go there and back to where the step began, n times.
      integer :: cycles = 0
   end type step_type

   !> What the user asked of the mesh. Unset: chosen from an estimate of the contact.
   type :: mesh_request_type
      integer :: nodes = 101
      !> Nodes are the centres of equal intervals over [-half_width, half_width], length; 0: chosen, and grown when the
      !> contact needs it.
      real(wp) :: half_width = 0.0_wp
   end type mesh_request_type

   type :: scene_type
      character(:), allocatable :: title
      integer :: plane = plane_strain
      integer :: coupling = coupling_full
      !> The elastic half-plane below.
      type(material_type) :: material
      !> The rigid body above.
      type(indenter_type) :: indenter
      !> Distance of the surface point from which displacements are measured, length.
      real(wp) :: datum = 0.0_wp
      type(mesh_request_type) :: mesh
      type(friction_type) :: friction
      type(step_type), allocatable :: steps(:)
   contains
      procedure :: tangential
   end type scene_type

contains

   !> Whether the scene needs the tangential problem at all: a law with friction, and a step in which it acts.
   pure logical function tangential(self)
      class(scene_type), intent(in) :: self

      tangential = self%friction%acts()
      if (allocated(self%steps)) tangential = tangential .and. any(self%steps%friction)
   end function tangential

end module mfv_scene
