!> The load history: one record for every event or step end.
module mfv_history
   use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
   use mfv_contact_state, only: contact_state_type
   use mfv_kinds, only: wp
   use mfv_motions, only: motion_count
   implicit none
   private
   public :: history_type, history_record_type

   type :: history_record_type
      !> Motions and their forces, as contact_fields_type has them.
      real(wp) :: motion(motion_count) = 0.0_wp, force(motion_count) = 0.0_wp
      real(wp) :: dissipation = 0.0_wp
      integer :: contact_nodes = 0, stick_nodes = 0
      !> The event (see mfv_node_status), its first node, and the number of nodes with it.
      integer :: event_kind = 0, event_node = 0, event_count = 0
      !> Step of the load history, and number of linear solves so far.
      integer :: step = 0, linear_solves = 0
      !> Of both bodies, if wanted: the largest tension along the surface and its x; the stress along the surface at a given x;
      !> force/length^2 and length. NaN at events.
      real(wp), dimension(2) :: tension = 0.0_wp, tension_x = 0.0_wp, surface_stress = 0.0_wp
   end type history_record_type

   type :: history_type
      !> Number of records.
      integer :: records = 0
      !> Storage; the first `records` entries are in use.
      type(history_record_type), allocatable :: record(:)
   contains
      procedure :: append
      procedure :: move_nodes
   end type history_type

contains

   !> Append a record of `state` after an event (`kind`, first `node`, `count` nodes). The list doubles when full.
   subroutine append(self, state, kind, node, count, step, linear_solves)
      class(history_type), intent(inout) :: self
      type(contact_state_type), intent(in) :: state
      integer, intent(in) :: kind, node, count, step, linear_solves
      integer, parameter :: first_capacity = 64

      if (.not. allocated(self%record)) allocate (self%record(first_capacity))
      if (self%records == size(self%record)) self%record = [self%record, self%record]
      self%records = self%records + 1
      self%record(self%records) = history_record_type( &
                                  state%fields%motion, state%fields%force, state%dissipation, state%contact_nodes(), &
                                  state%stick_nodes(), kind, node, count, step, linear_solves)
      associate (record => self%record(self%records))
         record%tension = ieee_value(1.0_wp, ieee_quiet_nan)
         record%tension_x = record%tension
         record%surface_stress = record%tension
      end associate
   end subroutine append

   !> Renumber the nodes after `extra` nodes were added before the first one.
   subroutine move_nodes(self, extra)
      class(history_type), intent(inout) :: self
      integer, intent(in) :: extra
      integer :: i

      do i = 1, self%records
         if (self%record(i)%event_node > 0) self%record(i)%event_node = self%record(i)%event_node + extra
      end do
   end subroutine move_nodes

end module mfv_history
