!> Interface of friction laws. A law is a file of its own that extends `friction_law_type` and contains all that is specific to it;
!> the algorithms use this interface and never its name.
!>
!> A node holds up to the limit |tau| <= mu_s p. Laws differ for nodes that slip (or creep): over an increment of the
!> load the shear traction is on the line
!>
!>     tau = slope*p + stiffness*s + offset,
!>
!> a row of the augmented system (dissertation eq. 2.2, B.2). Nonlinear laws give a line that is right at the expected end of the
!> increment; the algorithm iterates and controls the error.
!>
!> The defaults below are those of a law without memory whose nodes stick below the limit and slip at it.
module mfv_friction_law
   use mfv_kinds, only: wp
   use mfv_node_status
   implicit none
   private
   public :: friction_law_type, friction_point_type, friction_row_type, friction_event_type, memory_size, most_events, &
             secant_tolerance

   !> Memory values of each node; and most events of a law at a node.
   integer, parameter :: memory_size = 3, most_events = 3
   !> Factor on the tolerance for rates of secants.
   real(wp), parameter :: secant_tolerance = 100.0_wp

   !> State of a node for a friction law.
   type :: friction_point_type
      !> Static and kinetic coefficient of friction at the node.
      real(wp) :: static = 0.0_wp, kinetic = 0.0_wp
      !> Pressure p and shear traction tau, force/length^2; slip s = u - U, length.
      real(wp) :: pressure = 0.0_wp, shear = 0.0_wp, slip = 0.0_wp
      !> Memory of the law at the node.
      real(wp) :: memory(memory_size) = 0.0_wp
   end type friction_point_type

   !> The line tau = slope*p + stiffness*s + offset: no unit, force/length^3, force/length^2.
   type :: friction_row_type
      real(wp) :: slope = 0.0_wp, stiffness = 0.0_wp, offset = 0.0_wp
   end type friction_row_type

   !> An event of a friction law at a node: `slack` must not become negative, and changes at the rate rate + by_pressure*(rate of
   !> p) + by_motion*(rate of slip in the direction of the motion of the node).
   type :: friction_event_type
      !> See mfv_node_status; event_none: no event.
      integer :: kind = event_none
      real(wp) :: slack = 0.0_wp, rate = 0.0_wp, by_pressure = 0.0_wp, by_motion = 0.0_wp
      !> Whether `slack` is a length (else force/length^2); and the factor on the tolerance of its rate.
      logical :: is_length = .false.
      real(wp) :: tolerance_factor = 1.0_wp
   end type friction_event_type

   type, abstract :: friction_law_type
      !> Value of the key &friction law; keys of &friction, besides the coefficients, that it requires, and those that are optional.
      character(len=16) :: name = ''
      character(len=32) :: needed_keys = '', optional_keys = ''
      !> Whether it has both a static and a kinetic coefficient of friction; where these are equal, it is Coulomb's law.
      logical :: has_two_coefficients = .false.
      !> Whether |tau| = mu p wherever a node slips, with a single coefficient, as closed forms and large increments assume.
      logical :: is_proportional = .false.
      !> Whether the lines are exact over increments of any length.
      logical :: is_linear = .true.
      !> Whether a node below its limit does not move at all; else it creeps.
      logical :: sticks = .true.
      !> Whether |tau| drops when a node begins to slip: it relaxes at a fixed load, along a path of its own.
      logical :: drops = .false.
      !> Whether it has memory, and its own events.
      logical :: has_memory = .false., has_events = .false.
      !> Fraction of the limit at which a holding node slips.
      real(wp) :: limit_fraction = 1.0_wp
   contains
      procedure :: set_parameter
      procedure :: depends_on_end
      !> Lines and limits.
      procedure(row_interface), deferred :: row
      procedure(strength_interface), deferred :: strength
      procedure :: secant
      procedure :: has_soft_limit
      procedure :: holding_status
      procedure :: over_stress
      !> Events and memory.
      procedure :: find_events
      procedure :: pass_event
      procedure :: change_status
      procedure :: remember
      procedure :: is_releasing
      procedure :: release_rate
      procedure :: can_become_unstable
      procedure :: release
      procedure :: slip_of_fall
      !> Certificate and messages.
      procedure :: defect
      procedure :: wrong_motion
      procedure :: explain_failure
   end type friction_law_type

   abstract interface
      !> The line of a slipping or creeping node with this `status` over the increment from `before` to `after`; the same
      !> point twice gives the tangent.
      pure function row_interface(self, status, before, after) result(row)
         import :: friction_law_type, friction_point_type, friction_row_type
         class(friction_law_type), intent(in) :: self
         integer, intent(in) :: status
         type(friction_point_type), intent(in) :: before, after
         type(friction_row_type) :: row
      end function row_interface

      !> |tau| of a node that slips, force/length^2.
      pure real(wp) function strength_interface(self, point)
         import :: friction_law_type, friction_point_type, wp
         class(friction_law_type), intent(in) :: self
         type(friction_point_type), intent(in) :: point
      end function strength_interface
   end interface

contains

   !> Set the parameter `key`.
   pure subroutine set_parameter(self, key, value)
      class(friction_law_type), intent(inout) :: self
      character(*), intent(in) :: key
      real(wp), intent(in) :: value
   end subroutine set_parameter

   !> Whether the line of a node depends on the end of the increment.
   pure logical function depends_on_end(self, status, point)
      class(friction_law_type), intent(in) :: self
      integer, intent(in) :: status
      type(friction_point_type), intent(in) :: point

      depends_on_end = .false.
   end function depends_on_end

   !> The line through both ends of an increment at whose end `after` the law is satisfied; the only line of a linear law.
   pure function secant(self, status, before, after) result(row)
      class(friction_law_type), intent(in) :: self
      integer, intent(in) :: status
      type(friction_point_type), intent(in) :: before, after
      type(friction_row_type) :: row

      row = self%row(status, before, before)
   end function secant

   !> Whether creeping nodes approach the limit smoothly, so that a node is below it at first contact.
   pure logical function has_soft_limit(self)
      class(friction_law_type), intent(in) :: self

      has_soft_limit = .false.
   end function has_soft_limit

   !> Status of a node that holds and would move in `direction` (its sign, 0: unknown).
   pure integer function holding_status(self, direction)
      class(friction_law_type), intent(in) :: self
      integer, intent(in) :: direction

      holding_status = node_stick
   end function holding_status

   !> For laws whose nodes creep: the excess of the load of a node at the limit over the growth of the limit if it continued to
   !> creep, force/length^2. The node slips as long as this is not negative. `moved`: motion in the direction of slip, length;
   !> `growth`: of the limit, force/length^2; or their rates.
   elemental real(wp) function over_stress(self, moved, growth)
      class(friction_law_type), intent(in) :: self
      real(wp), intent(in) :: moved, growth

      over_stress = -growth
      if (moved > 0.0_wp) over_stress = 0.0_wp
   end function over_stress

   !> Events of the law at a node with this `status`, in an increment from `here` to the expected end `there`.
   pure subroutine find_events(self, status, here, there, events)
      class(friction_law_type), intent(in) :: self
      integer, intent(in) :: status
      type(friction_point_type), intent(in) :: here, there
      type(friction_event_type), intent(out) :: events(most_events)
   end subroutine find_events

   !> Update the memory after one of these events.
   pure subroutine pass_event(self, kind, memory)
      class(friction_law_type), intent(in) :: self
      integer, intent(in) :: kind
      real(wp), intent(inout) :: memory(:)
   end subroutine pass_event

   !> Update the memory for a change of status. `point`: the state at that load, with the memory before the change. (In the
   !> conventional algorithm once for a load step: nodes that do not slip at its end are taken to have slipped until then.)
   pure subroutine change_status(self, from, to, point, memory)
      class(friction_law_type), intent(in) :: self
      integer, intent(in) :: from, to
      type(friction_point_type), intent(in) :: point
      real(wp), intent(inout) :: memory(:)
   end subroutine change_status

   !> Update the memory after an increment. `released`: fraction of the over-stress that has relaxed in it.
   pure subroutine remember(self, status, before, after, released, memory)
      class(friction_law_type), intent(in) :: self
      integer, intent(in) :: status
      type(friction_point_type), intent(in) :: before, after
      real(wp), intent(in) :: released
      real(wp), intent(inout) :: memory(:)
   end subroutine remember

   !> Whether a node with this memory has over-stress that must relax before the load continues.
   pure logical function is_releasing(self, memory)
      class(friction_law_type), intent(in) :: self
      real(wp), intent(in) :: memory(:)

      is_releasing = .false.
   end function is_releasing

   !> Decrease of |tau| while all over-stress relaxes, force/length^2.
   pure real(wp) function release_rate(self, memory)
      class(friction_law_type), intent(in) :: self
      real(wp), intent(in) :: memory(:)

      release_rate = 0.0_wp
   end function release_rate

   !> Whether a node with this `status` may have no equilibrium nearby once it slips, so that its traction must relax at a fixed
   !> load.
   pure logical function can_become_unstable(self, status, point)
      class(friction_law_type), intent(in) :: self
      integer, intent(in) :: status
      type(friction_point_type), intent(in) :: point

      can_become_unstable = .false.
   end function can_become_unstable

   !> Slip over which the coefficient falls from its static to its kinetic value, length: 0 at once, so that results do not
   !> converge with the mesh; huge() where it does not fall.
   pure real(wp) function slip_of_fall(self)
      class(friction_law_type), intent(in) :: self

      slip_of_fall = merge(0.0_wp, huge(1.0_wp), self%drops)
   end function slip_of_fall

   !> Begin the stress drop of such a node, which now slips.
   pure subroutine release(self, point, memory)
      class(friction_law_type), intent(in) :: self
      type(friction_point_type), intent(in) :: point
      real(wp), intent(inout) :: memory(:)
   end subroutine release

   !> Residual of the law for a slipping or creeping node after an increment, force/length^2. `explicit`: lines were tangents at
   !> the start.
   pure real(wp) function defect(self, status, before, after, explicit)
      class(friction_law_type), intent(in) :: self
      integer, intent(in) :: status
      type(friction_point_type), intent(in) :: before, after
      logical, intent(in) :: explicit

      defect = after%shear + slip_sign(status)*self%strength(after)
   end function defect

   !> Motion of a slipping node against its direction: length if nodes stick, else the corresponding traction, force/length^2.
   !> `growth`: of the limit.
   pure real(wp) function wrong_motion(self, moved, growth)
      class(friction_law_type), intent(in) :: self
      real(wp), intent(in) :: moved, growth

      wrong_motion = -moved
   end function wrong_motion

   !> Possible reason in the parameters of the law if no solution is found; empty, or begins with '; '. `interval_stiffness`:
   !> contact modulus over the interval, force/length^3.
   pure function explain_failure(self, interval_stiffness) result(text)
      class(friction_law_type), intent(in) :: self
      real(wp), intent(in) :: interval_stiffness
      character(len=260) :: text

      text = ''
   end function explain_failure

end module mfv_friction_law
