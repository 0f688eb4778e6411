!> Statuses of a surface node (dissertation Tables 2.1 and B.1, Fig. 2.1) and its events.
module mfv_node_status
   implicit none
   private
   public :: node_open, node_stick, node_slip_right, node_slip_left, node_frictionless, node_creep_right, node_creep_left, &
             node_status_names
   public :: event_none, event_close, event_open, event_slip_right, event_slip_left, event_stick, event_step_end, &
             event_stopped, event_reverse, event_weakened, event_caught, event_capped, event_dropped, event_increment, &
             event_names, &
             keeps_status, in_contact, slips, creeps, holds, slip_sign, motion_sign, is_among

   !> Node statuses. `node_frictionless`: in contact while friction is off or absent. `node_creep_right`, `node_creep_left`: held
   !> by bristles below the friction limit (partial slip of Table B.1), which yield to the right or to the left.
   integer, parameter :: node_open = 0, node_stick = 1, node_slip_right = 2, node_slip_left = 3, node_frictionless = 4, &
                         node_creep_right = 5, node_creep_left = 6
   character(*), parameter :: node_status_names = 'open stick slip_right slip_left frictionless creep_right creep_left'

   !> Events: what ended an increment of the load. `event_none`: the start of the history; `event_stopped`: its early end;
   !> `event_reverse`: a creeping node reverses its direction; `event_weakened`: the friction of a slipping node has decreased to
   !> its final value; `event_caught`: in a stress drop, the node satisfies its friction law again; `event_capped`: in a stress
   !> drop, the shear traction reaches the static limit, because the pressure decreases faster; `event_dropped`: the end of a
   !> stress drop, at the load at which it began; `event_increment`: the end of a large increment, in which events are not located.
   integer, parameter :: event_none = 0, event_close = 1, event_open = 2, event_slip_right = 3, event_slip_left = 4, &
                         event_stick = 5, event_step_end = 6, event_stopped = 7, event_reverse = 8, event_weakened = 9, &
                         event_caught = 10, event_capped = 11, event_dropped = 12, event_increment = 13
   character(*), parameter :: event_names = 'start close open slip_right slip_left stick step_end stopped reverse '// &
                              'weakened caught capped dropped increment'

contains

   elemental logical function in_contact(status)
      integer, intent(in) :: status

      in_contact = status /= node_open
   end function in_contact

   elemental logical function slips(status)
      integer, intent(in) :: status

      slips = status == node_slip_right .or. status == node_slip_left
   end function slips

   elemental logical function creeps(status)
      integer, intent(in) :: status

      creeps = status == node_creep_right .or. status == node_creep_left
   end function creeps

   !> Whether an event changes the memory of friction, but no status.
   elemental logical function keeps_status(event)
      integer, intent(in) :: event

      keeps_status = event == event_weakened .or. event == event_caught .or. event == event_capped
   end function keeps_status

   !> Whether the node is below the friction limit and resists any motion: stuck, or held by bristles.
   elemental logical function holds(status)
      integer, intent(in) :: status

      holds = status == node_stick .or. creeps(status)
   end function holds

   !> Sign of the slip rate s' that a slip status requires: 1 right (tau = -f), -1 left (tau = +f), 0 for the others.
   elemental integer function slip_sign(status)
      integer, intent(in) :: status

      slip_sign = merge(1, 0, status == node_slip_right) - merge(1, 0, status == node_slip_left)
   end function slip_sign

   !> Sign of the slip rate s' that a slipping or creeping status requires.
   elemental integer function motion_sign(status)
      integer, intent(in) :: status

      motion_sign = slip_sign(status) + merge(1, 0, status == node_creep_right) - merge(1, 0, status == node_creep_left)
   end function motion_sign

   !> Whether the statuses, shape (nodes), are one of the `sets`, shape (nodes, any).
   pure logical function is_among(status, sets)
      integer, intent(in) :: status(:), sets(:, :)
      integer :: i

      is_among = .false.
      do i = size(sets, 2), 1, -1
         is_among = all(sets(:, i) == status)
         if (is_among) return
      end do
   end function is_among

end module mfv_node_status
