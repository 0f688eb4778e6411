!> A scene on its mesh: node positions, undeformed gaps and the compliance between the nodes.
module mfv_contact_model
   use mfv_compliance, only: compliance_type
   use mfv_contact_fields, only: contact_fields_type
   use mfv_half_plane, only: new_half_plane
   use mfv_indenter, only: shape_disk, shape_flat_punch
   use mfv_kinds, only: wp
   use mfv_reference_hertz, only: hertz_half_width, hertz_half_width_of_approach
   use mfv_scene, only: control_displacement, control_force, scene_type
   implicit none
   private
   public :: contact_model_type, new_contact_model

   type :: contact_model_type
      type(scene_type) :: scene
      !> Positions of the nodes, length.
      real(wp), allocatable :: x(:)
      !> Undeformed gaps g0, length; zero where the indenter does not cover the node.
      real(wp), allocatable :: initial_gap(:)
      !> Whether the indenter covers the node, so that it can touch at all.
      logical, allocatable :: can_touch(:)
      class(compliance_type), allocatable :: compliance
      !> Whether the tangential problem is modelled: friction acts in some step.
      logical :: tangential = .false.
      !> Whether the mesh may grow with the contact.
      logical :: growing = .false.
      !> How many nodes have been added at either end.
      integer :: added = 0
   contains
      procedure :: nodes
      procedure :: interval
      procedure :: length
      procedure :: gap
      procedure :: reaches_end
      procedure :: grow
      procedure :: add_tangential
      procedure, private :: build_compliance
      procedure, private :: place_nodes
   end type contact_model_type

   !> Contact estimates leave this much room to the end of a chosen mesh.
   real(wp), parameter :: room = 1.2_wp

contains

   !> Model of a valid scene (the reader of the scene has checked it).
   function new_contact_model(scene) result(model)
      type(scene_type), intent(in) :: scene
      type(contact_model_type) :: model
      real(wp) :: half_width, interval

      model%scene = scene
      half_width = scene%mesh%half_width
      if (.not. half_width > 0.0_wp) then
         half_width = estimated_half_width(scene)
         model%growing = .true.
      end if
      interval = 2.0_wp*half_width/scene%mesh%nodes
      model%tangential = scene%tangential()
      call model%build_compliance(scene%mesh%nodes, interval)
      call model%place_nodes()
   end function new_contact_model

   !> Model the tangential problem from now on: friction acts in a step that the scene did not have.
   subroutine add_tangential(self)
      class(contact_model_type), intent(inout) :: self

      self%tangential = .true.
      call self%build_compliance(self%nodes(), self%interval())
   end subroutine add_tangential

   subroutine build_compliance(self, nodes, interval)
      class(contact_model_type), intent(inout) :: self
      integer, intent(in) :: nodes
      real(wp), intent(in) :: interval

      if (allocated(self%compliance)) deallocate (self%compliance)
      allocate (self%compliance, source=new_half_plane(self%scene%material, nodes, interval, self%scene%datum, &
                                                       self%scene%coupling, self%tangential))
   end subroutine build_compliance

   pure integer function nodes(self)
      class(contact_model_type), intent(in) :: self

      nodes = self%compliance%nodes
   end function nodes

   !> Width of an interval, length.
   pure real(wp) function interval(self)
      class(contact_model_type), intent(in) :: self

      interval = self%compliance%interval
   end function interval

   !> Half the length of the mesh, length: the scale of the scene.
   pure real(wp) function length(self)
      class(contact_model_type), intent(in) :: self

      length = 0.5_wp*self%interval()*self%nodes()
   end function length

   !> Gap g0 - delta + w of every node, length (where the indenter does not cover a node: of no meaning).
   pure function gap(self, fields)
      class(contact_model_type), intent(in) :: self
      type(contact_fields_type), intent(in) :: fields
      real(wp) :: gap(self%compliance%nodes)

      gap = self%initial_gap - fields%approach + fields%normal
   end function gap

   !> Whether the contact statuses (true: in contact) reach an end of the mesh beyond which the indenter goes on.
   pure logical function reaches_end(self, contact)
      class(contact_model_type), intent(in) :: self
      logical, intent(in) :: contact(:)
      integer :: n

      n = self%nodes()
      reaches_end = contact(1) .and. self%scene%indenter%covers(self%x(1) - self%interval()) &
                    .or. contact(n) .and. self%scene%indenter%covers(self%x(n) + self%interval())
   end function reaches_end

   !> Lengthen the mesh by `extra` nodes at either end, with the same intervals.
   subroutine grow(self, extra)
      class(contact_model_type), intent(inout) :: self
      integer, intent(in) :: extra

      call self%compliance%resize(self%nodes() + 2*extra)
      self%added = self%added + extra
      call self%place_nodes()
   end subroutine grow

   !> Positions symmetric to the last bit.
   subroutine place_nodes(self)
      class(contact_model_type), intent(inout) :: self
      integer :: i, n

      n = self%nodes()
      self%x = [(0.5_wp*self%interval()*(2*i - n - 1), i=1, n)]
      self%initial_gap = self%scene%indenter%gap(self%x)
      self%can_touch = self%scene%indenter%covers(self%x)
   end subroutine place_nodes

   !> Half-width of a mesh for a scene that asks for none: the punch itself, the whole profile, or Hertz's contact under
   !> the largest load with some room.
   function estimated_half_width(scene) result(half_width)
      type(scene_type), intent(in) :: scene
      real(wp) :: half_width
      integer :: i

      half_width = scene%indenter%half_extent()
      if (scene%indenter%shape /= shape_disk) return
      half_width = 0.0_wp
      do i = 1, size(scene%steps)
         associate (step => scene%steps(i))
            select case (step%normal_control)
            case (control_force)
               half_width = max(half_width, hertz_half_width(step%normal_target, scene%indenter%radius, scene%material))
            case (control_displacement)
               half_width = max(half_width, hertz_half_width_of_approach(step%normal_target, scene%indenter%radius, &
                                                                         scene%datum))
            end select
         end associate
      end do
      if (.not. half_width > 0.0_wp) half_width = 1.0e-2_wp*scene%indenter%radius
      half_width = min(room*half_width, scene%indenter%radius)
   end function estimated_half_width

end module mfv_contact_model
