!> A contact state: the fields and the memory of the nodes.
module mfv_contact_state
   use mfv_contact_fields, only: contact_fields_type, new_contact_fields
   use mfv_friction_law, only: friction_point_type, memory_size
   use mfv_kinds, only: wp
   use mfv_motions, only: motion_shift
   use mfv_node_status
   implicit none
   private
   public :: contact_state_type, new_contact_state

   type :: contact_state_type
      type(contact_fields_type) :: fields
      !> Statuses, see mfv_node_status, shape (nodes).
      integer, allocatable :: status(:)
      !> Slip at which a stuck node holds, or a slipping node last held, length, shape (nodes).
      real(wp), allocatable :: stuck_slip(:)
      !> Sign of the last slip rate, 0 for none, shape (nodes).
      integer, allocatable :: slip_direction(:)
      !> Memory of the friction law, shape (memory_size, nodes).
      real(wp), allocatable :: memory(:, :)
      !> Work dissipated by friction so far, force (energy per unit thickness); and its part in the cycles of blocks of wear that
      !> are not computed.
      real(wp) :: dissipation = 0.0_wp, skipped_dissipation = 0.0_wp
      !> Work dissipated so far per unit of surface, force/length, shape (nodes).
      real(wp), allocatable :: friction_work(:)
      !> In the present cycle: the sum of the magnitudes of the work per unit of surface, force/length, and that of these times the
      !> pressure, force^2/length^3; both shape (nodes), without wear (0).
      real(wp), allocatable :: cycle_work(:), pressure_work(:)
      !> Depth worn off both surfaces together, length, shape (nodes).
      real(wp), allocatable :: worn(:)
      !> Area worn off in single cycles that change the pressures by more than the tolerance of the wear, and estimated error of
      !> what is worn off in given blocks of cycles, length^2.
      real(wp) :: coarsely_worn = 0.0_wp, wear_error = 0.0_wp
   contains
      procedure :: set_status
      procedure :: copy_from
      procedure :: friction_point
      procedure :: skip
      procedure :: begin_cycle_work
      procedure :: add_cycle_work
      procedure :: widen
      procedure :: contact_nodes
      procedure :: stick_nodes
      procedure :: slip_nodes
   end type contact_state_type

contains

   !> Unloaded, separated state with `nodes` nodes. `wears`: whether the surfaces do.
   pure function new_contact_state(nodes, wears) result(state)
      integer, intent(in) :: nodes
      logical, intent(in) :: wears
      type(contact_state_type) :: state

      state%fields = new_contact_fields(nodes)
      allocate (state%status(nodes), source=node_open)
      allocate (state%slip_direction(nodes), source=0)
      allocate (state%memory(memory_size, nodes), source=0.0_wp)
      allocate (state%stuck_slip(nodes), state%friction_work(nodes), state%worn(nodes), source=0.0_wp)
      allocate (state%cycle_work(merge(nodes, 0, wears)), state%pressure_work(merge(nodes, 0, wears)), source=0.0_wp)
   end function new_contact_state

   !> Set the statuses of the nodes of `mask`. A node that sticks holds at its present slip; one that slips at first contact has
   !> held there.
   pure subroutine set_status(self, mask, status)
      class(contact_state_type), intent(inout) :: self
      logical, intent(in) :: mask(:)
      integer, intent(in) :: status(:)

      integer :: i

      do i = 1, size(mask)
         if (.not. mask(i)) cycle
         if (status(i) == node_stick .and. self%status(i) /= node_stick .or. &
             slips(status(i)) .and. any(self%status(i) == [node_open, node_frictionless])) &
            self%stuck_slip(i) = self%fields%tangential(i) - self%fields%motion(motion_shift)
         self%status(i) = status(i)
      end do
   end subroutine set_status

   !> Copy `other`, reusing storage.
   pure subroutine copy_from(self, other)
      class(contact_state_type), intent(inout) :: self
      type(contact_state_type), intent(in) :: other

      call self%fields%copy_from(other%fields)
      self%status = other%status
      self%stuck_slip = other%stuck_slip
      self%slip_direction = other%slip_direction
      self%memory = other%memory
      self%dissipation = other%dissipation
      self%skipped_dissipation = other%skipped_dissipation
      self%friction_work = other%friction_work
      self%cycle_work = other%cycle_work
      self%pressure_work = other%pressure_work
      self%worn = other%worn
      self%coarsely_worn = other%coarsely_worn
      self%wear_error = other%wear_error
   end subroutine copy_from

   !> State of node `node` for a friction law, with the given fields and coefficients of friction.
   pure function friction_point(self, fields, node, static, kinetic) result(point)
      class(contact_state_type), intent(in) :: self
      type(contact_fields_type), intent(in) :: fields
      integer, intent(in) :: node
      real(wp), intent(in) :: static, kinetic
      type(friction_point_type) :: point

      point = friction_point_type(static, kinetic, fields%pressure(node), fields%shear(node), &
                                  fields%tangential(node) - fields%motion(motion_shift), self%memory(:, node))
   end function friction_point

   !> Add the `work` of friction in cycles that are not computed, force/length, shape (nodes); `width`: of the nodes, length.
   pure subroutine skip(self, width, work)
      class(contact_state_type), intent(inout) :: self
      real(wp), intent(in) :: width(:), work(:)

      self%friction_work = self%friction_work + work
      self%dissipation = self%dissipation + sum(width*work)
      self%skipped_dissipation = self%skipped_dissipation + sum(width*work)
   end subroutine skip

   !> Begin to sum the work of a cycle.
   pure subroutine begin_cycle_work(self)
      class(contact_state_type), intent(inout) :: self

      self%cycle_work = 0.0_wp
      self%pressure_work = 0.0_wp
   end subroutine begin_cycle_work

   !> Add the work of an increment from the state `before`.
   pure subroutine add_cycle_work(self, before)
      class(contact_state_type), intent(inout) :: self
      type(contact_state_type), intent(in) :: before
      real(wp), dimension(size(self%status)) :: work

      work = abs(self%friction_work - before%friction_work)
      self%cycle_work = self%cycle_work + work
      self%pressure_work = self%pressure_work + 0.5_wp*max(before%fields%pressure + self%fields%pressure, 0.0_wp)*work
   end subroutine add_cycle_work

   !> Add `extra` open nodes at either end; the caller fills in their displacements.
   pure subroutine widen(self, extra)
      class(contact_state_type), intent(inout) :: self
      integer, intent(in) :: extra
      integer :: i

      self%fields = self%fields%padded(extra)
      self%status = [(node_open, i=1, extra), self%status, (node_open, i=1, extra)]
      self%slip_direction = [(0, i=1, extra), self%slip_direction, (0, i=1, extra)]
      self%stuck_slip = [(0.0_wp, i=1, extra), self%stuck_slip, (0.0_wp, i=1, extra)]
      self%memory = reshape([(0.0_wp, i=1, memory_size*extra), self%memory, (0.0_wp, i=1, memory_size*extra)], &
                            [memory_size, size(self%status)])
      self%friction_work = [(0.0_wp, i=1, extra), self%friction_work, (0.0_wp, i=1, extra)]
      self%worn = [(0.0_wp, i=1, extra), self%worn, (0.0_wp, i=1, extra)]
      if (size(self%cycle_work) == 0) return
      self%cycle_work = [(0.0_wp, i=1, extra), self%cycle_work, (0.0_wp, i=1, extra)]
      self%pressure_work = [(0.0_wp, i=1, extra), self%pressure_work, (0.0_wp, i=1, extra)]
   end subroutine widen

   pure integer function contact_nodes(self)
      class(contact_state_type), intent(in) :: self

      contact_nodes = count(in_contact(self%status))
   end function contact_nodes

   !> Number of nodes that hold: stuck, or creeping below the friction limit.
   pure integer function stick_nodes(self)
      class(contact_state_type), intent(in) :: self

      stick_nodes = count(holds(self%status))
   end function stick_nodes

   pure integer function slip_nodes(self)
      class(contact_state_type), intent(in) :: self

      slip_nodes = count(slips(self%status))
   end function slip_nodes

end module mfv_contact_state
