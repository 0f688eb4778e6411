!> Derivatives of a contact state with respect to parameters: targets of load steps, and keys of the scene such as a coefficient of
!> friction, a radius or a modulus.
!>
!> At fixed statuses the state is the solution of a linear system, whose right side contains the loads, the gaps, the friction and
!> the memory: the slip at which each stuck node holds. Its derivative solves the same system for the derivatives of these
!> (docs/theory.md). The load at which an event occurs depends on the parameters as well. Fields are continuous there; `fields` are
!> their derivatives at the last event, including its displacement. A node that sticks copies the derivative of its slip from there
!> into the memory.
!>
!> The mesh is held. Keys enter through gaps, compliances, arms and coefficients of friction, which are explicit: their derivatives
!> at given tractions and motions are differences of fourth order between models with other values of the key.
module mfv_derivatives
   use mfv_contact_fields, only: contact_fields_type, new_contact_fields
   use mfv_contact_model, only: adapt_model, contact_model_type
   use mfv_kinds, only: wp
   use mfv_motions, only: motion_count, motion_approach, motion_shift, control_force, control_keep
   use mfv_strings, only: string_type
   implicit none
   private
   public :: parameter_type, derivatives_type, explicit_type, explicit_derivatives

   !> A parameter: the target of a motion in a step, or a key of the scene.
   type :: parameter_type
      !> Its name in a case, such as step(2)%shift or friction%mu.
      character(:), allocatable :: name
      !> Number of the step, the motion, and its control; 0 for a key.
      integer :: step = 0, motion = 0, control = 0
      !> Models with smaller and with larger values of the key, shape (2, pairs). The derivative of what they determine is the sum
      !> of the differences of the pairs times `weight`, shape (pairs). Not allocated for a target.
      type(contact_model_type), allocatable :: model(:, :)
      real(wp), allocatable :: weight(:)
   end type parameter_type

   !> Derivatives of a state with respect to all parameters, shape (..., parameters).
   type :: derivatives_type
      !> Names of the parameters; and why the derivatives are not known, empty if they are.
      type(string_type), allocatable :: name(:)
      character(:), allocatable :: fault
      !> Derivatives of the fields at the last event or the end of the last segment. `normal`: of the gap, except for the approach.
      type(contact_fields_type), allocatable :: fields(:)
      !> Derivative of the slip at which a stuck node holds, shape (nodes, parameters).
      real(wp), allocatable :: stuck_slip(:, :)
      real(wp), allocatable :: dissipation(:)
      !> Derivatives of the loads at the start and the end of the segment, at both ends of the step, and of the present loads; shape
      !> (motion_count, parameters).
      real(wp), allocatable :: start(:, :), goal(:, :), there(:, :), back(:, :), load(:, :)
      !> Number of loads so far at which several nodes change their status together and a change of the parameter separates them, so
      !> that the derivative is approximate; shape (parameters).
      integer, allocatable :: separated(:)
      !> Linear solves so far for derivatives.
      integer :: solves = 0
   contains
      procedure :: begin
      procedure :: begin_step
      procedure :: begin_segment
      procedure :: note_stuck
      procedure :: touch
      procedure :: refresh
      procedure :: widen
      procedure :: are_of
      procedure :: fail
   end type derivatives_type

   !> Explicit derivatives with respect to a parameter, at given tractions and motions: of the gap and the slip, length; of the
   !> coefficient of friction and the width of the intervals, shape (nodes); of the resultants of the tractions.
   type :: explicit_type
      real(wp), allocatable :: gap(:), slip(:), friction(:), width(:)
      real(wp) :: resultant(motion_count) = 0.0_wp
   end type explicit_type

contains

   !> Explicit derivatives with respect to a parameter at the tractions and motions of `fields`.
   subroutine explicit_derivatives(parameter, model, fields, derivatives)
      type(parameter_type), intent(inout) :: parameter
      type(contact_model_type), intent(in) :: model
      type(contact_fields_type), intent(in) :: fields
      type(explicit_type), intent(out) :: derivatives
      real(wp), dimension(model%nodes(), 2) :: normal, tangential
      integer :: i, n, pair

      n = model%nodes()
      allocate (derivatives%gap(n), derivatives%slip(n), derivatives%friction(n), derivatives%width(n), source=0.0_wp)
      if (.not. allocated(parameter%model)) return
      do pair = 1, size(parameter%weight)
         associate (less => parameter%model(1, pair), more => parameter%model(2, pair), weight => parameter%weight(pair))
            call adapt_model(less, model%added, model%tangential, model%moves)
            call adapt_model(more, model%added, model%tangential, model%moves)
            call less%relative_displacements(fields, normal(:, 1), tangential(:, 1))
            call more%relative_displacements(fields, normal(:, 2), tangential(:, 2))
            derivatives%gap = derivatives%gap + weight*((more%initial_gap - less%initial_gap) + (normal(:, 2) - normal(:, 1)))
            derivatives%slip = derivatives%slip + weight*(tangential(:, 2) - tangential(:, 1))
            derivatives%friction = derivatives%friction + weight*(more%static_friction - less%static_friction)
            derivatives%width = derivatives%width + weight*(more%width - less%width)
            do i = 1, motion_count
               derivatives%resultant(i) = derivatives%resultant(i) + weight*(more%resultant(i, fields%pressure, fields%shear) &
                                                                             - less%resultant(i, fields%pressure, fields%shear))
            end do
         end associate
      end do
   end subroutine explicit_derivatives

   !> Begin at a state that does not depend on the parameters; only on keys if nothing has been applied yet, when the upper body
   !> just touches.
   subroutine begin(self, parameters, model, fields)
      class(derivatives_type), intent(out) :: self
      type(parameter_type), intent(inout) :: parameters(:)
      type(contact_model_type), intent(in) :: model
      type(contact_fields_type), intent(in) :: fields
      integer :: k, n, pair

      n = size(parameters)
      self%fault = ''
      allocate (self%fields(n), self%name(n))
      do k = 1, n
         self%name(k)%text = parameters(k)%name
         self%fields(k) = new_contact_fields(model%nodes())
         if (.not. allocated(parameters(k)%model)) cycle
         do pair = 1, size(parameters(k)%weight)
            associate (less => parameters(k)%model(1, pair), more => parameters(k)%model(2, pair), &
                       approach => self%fields(k)%motion(motion_approach))
               approach = approach + parameters(k)%weight(pair)*(more%nearest_approach(more%initial_gap) &
                                                                 - less%nearest_approach(less%initial_gap))
            end associate
         end do
      end do
      allocate (self%stuck_slip(model%nodes(), n), self%dissipation(n), source=0.0_wp)
      allocate (self%separated(n), source=0)
      allocate (self%start(motion_count, n), self%goal(motion_count, n), self%there(motion_count, n), &
                self%back(motion_count, n), self%load(motion_count, n), source=0.0_wp)
      if (any([(allocated(parameters(k)%model), k=1, n)])) call self%refresh(parameters, model, fields)
   end subroutine begin

   !> Begin step `number`, which controls motions as in step_type; `has_path`: with several targets for each, those of a cycle of a
   !> load history. `control`: the controls of all motions during the step.
   subroutine begin_step(self, parameters, number, controlled, has_path, control)
      class(derivatives_type), intent(inout) :: self
      type(parameter_type), intent(in) :: parameters(:)
      integer, intent(in) :: number, controlled(motion_count), control(motion_count)
      logical, intent(in) :: has_path
      integer :: k

      self%there = self%load
      do k = 1, size(parameters)
         where (controlled /= control_keep) self%there(:, k) = 0.0_wp
         if (parameters(k)%step == number) then
            self%there(parameters(k)%motion, k) = 1.0_wp
            if (controlled(parameters(k)%motion) /= parameters(k)%control) &
               call self%fail(parameters(k)%name//' is not a target of this step')
            if (has_path) call self%fail(parameters(k)%name//' is not one target: the step is the cycle of &history')
         end if
         self%back(:, k) = merge(self%fields(k)%force, self%fields(k)%motion, control == control_force)
      end do
   end subroutine begin_step

   !> Begin a segment to the targets of the step, or (`returns`) back to its start.
   subroutine begin_segment(self, returns, control)
      class(derivatives_type), intent(inout) :: self
      logical, intent(in) :: returns
      integer, intent(in) :: control(motion_count)
      integer :: k

      self%goal = self%there
      if (returns) self%goal = self%back
      self%load = self%goal
      do k = 1, size(self%fields)
         self%start(:, k) = merge(self%fields(k)%force, self%fields(k)%motion, control == control_force)
      end do
   end subroutine begin_segment

   !> Node `node` sticks.
   pure subroutine note_stuck(self, node)
      class(derivatives_type), intent(inout) :: self
      integer, intent(in) :: node
      integer :: k

      do k = 1, size(self%fields)
         self%stuck_slip(node, k) = self%fields(k)%tangential(node) - self%fields(k)%motion(motion_shift)
      end do
   end subroutine note_stuck

   !> Without load the upper body is moved until node `node` closes; refresh must follow.
   pure subroutine touch(self, model, node)
      class(derivatives_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      integer, intent(in) :: node
      integer :: k

      do k = 1, size(self%fields)
         associate (approach => self%fields(k)%motion(motion_approach))
            approach = approach + (self%fields(k)%normal(node) - approach)/model%normal_arm(node, motion_approach)
         end associate
      end do
   end subroutine touch

   !> Derivatives of all displacements from those of tractions and motions, after the mesh or the problem has changed. `fields`: the
   !> present state.
   subroutine refresh(self, parameters, model, fields)
      class(derivatives_type), intent(inout) :: self
      type(parameter_type), intent(inout) :: parameters(:)
      type(contact_model_type), intent(in) :: model
      type(contact_fields_type), intent(in) :: fields
      type(explicit_type) :: explicit
      integer :: k

      do k = 1, size(parameters)
         call explicit_derivatives(parameters(k), model, fields, explicit)
         call model%displace(self%fields(k))
         self%fields(k)%normal = self%fields(k)%normal + explicit%gap
         self%fields(k)%tangential = self%fields(k)%tangential + explicit%slip
      end do
   end subroutine refresh

   !> Add `extra` nodes at either end; refresh must follow.
   subroutine widen(self, extra)
      class(derivatives_type), intent(inout) :: self
      integer, intent(in) :: extra
      real(wp), allocatable :: wider(:, :)
      integer :: k, n

      n = size(self%stuck_slip, 1)
      allocate (wider(n + 2*extra, size(self%fields)), source=0.0_wp)
      wider(extra + 1:extra + n, :) = self%stuck_slip
      call move_alloc(wider, self%stuck_slip)
      do k = 1, size(self%fields)
         self%fields(k) = self%fields(k)%padded(extra)
      end do
   end subroutine widen

   !> Whether they are derivatives with respect to `parameters`.
   pure logical function are_of(self, parameters)
      class(derivatives_type), intent(in) :: self
      type(parameter_type), allocatable, intent(in) :: parameters(:)
      integer :: k

      are_of = .false.
      if (.not. allocated(parameters)) return
      if (size(parameters) /= size(self%name)) return
      are_of = all([(parameters(k)%name == self%name(k)%text, k=1, size(parameters))])
   end function are_of

   !> The derivatives are not known from here on, and why.
   subroutine fail(self, why)
      class(derivatives_type), intent(inout) :: self
      character(*), intent(in) :: why

      if (self%fault == '') self%fault = why
   end subroutine fail

end module mfv_derivatives
