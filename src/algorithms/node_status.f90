!> What a surface node can be (dissertation Table 2.1, Fig. 2.1) and what can happen to it.
module mfv_node_status
   implicit none
   private
   public :: node_open, node_stick, node_slip_right, node_slip_left, node_frictionless, node_status_names
   public :: event_none, event_close, event_open, event_slip_right, event_slip_left, event_stick, event_step_end, &
             event_stopped, event_names, in_contact, slips, slip_sign

   !> Node statuses. `node_frictionless`: in contact while friction is off or absent.
   integer, parameter :: node_open = 0, node_stick = 1, node_slip_right = 2, node_slip_left = 3, node_frictionless = 4
   character(*), parameter :: node_status_names = 'open stick slip_right slip_left frictionless'

   !> Events: what ended an increment of the load. `event_none`: the start of the history; `event_stopped`: its early end.
   integer, parameter :: event_none = 0, event_close = 1, event_open = 2, event_slip_right = 3, event_slip_left = 4, &
                         event_stick = 5, event_step_end = 6, event_stopped = 7
   character(*), parameter :: event_names = 'start close open slip_right slip_left stick step_end stopped'

contains

   elemental logical function in_contact(status)
      integer, intent(in) :: status

      in_contact = status /= node_open
   end function in_contact

   elemental logical function slips(status)
      integer, intent(in) :: status

      slips = status == node_slip_right .or. status == node_slip_left
   end function slips

   !> Sign of the slip rate s' that a slip status demands: 1 right (tau = -f), -1 left (tau = +f), 0 for the others.
   elemental integer function slip_sign(status)
      integer, intent(in) :: status

      slip_sign = merge(1, 0, status == node_slip_right) - merge(1, 0, status == node_slip_left)
   end function slip_sign

end module mfv_node_status
