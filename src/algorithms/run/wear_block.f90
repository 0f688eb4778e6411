!> The wear of a block of cycles, from the friction work of the cycle at its start and of that after it.
!>
!> The depth of wear per cycle is r, the coefficient times the friction work of the computed cycle (Archard: over the coefficient of
!> friction, which is the integral of the pressure over the slip path). Over a block of N cycles the pressure moves from where
!> material is removed to where it is not, and the contact may grow. With the mean pressure p in the first cycle, weighted by the
!> work, and that pressure P after the block (implicit Euler, stable for any N), the depth is h = N r P/p, where P solves the normal
!> contact problem with an additional compliance N r/p at every node (Johansson 1994, Int. J. Numer. Meth. Engng 37, 1393):
!>
!>     gap + C (P - p) - d + N (r/p) P >= 0,   P >= 0,   one of them zero;   force of P = force of p, or d = 0.
!>
!> C is the compliance and d the change of the approach. Nodes that do not slip have their present pressure p. The gap is zero at
!> nodes that slip in the cycle or are in contact, else the present one. All nodes that slip in the cycle are thus loaded at once,
!> and coupling is neglected. Other nodes have the r/p of the nearest ones, beyond the contact the larger one of its two outermost
!> nodes. The gap has the correction of the block before, which is worn off with this one. Since what is touched within a step of
!> the implicit rule wears as from its start, N cycles are divided into m equal steps in each of which the edges of the contact
!> move outwards by about an interval.
!>
!> The two cycles after the block, each alone, tell its error. The first of them wears by f1, with slip that the wear of the block
!> causes; the next one, f2, with f of one cycle (N = 1) before the block, tells what the N + 1 cycles wear: by t = (N + 1) f +
!> N (f2 - f)/2, the trapezoidal rule, and `bend` for m > 1. The correction of the depth is e = t - h - f1, damped as the block is
!> by the pressures q that it causes:
!>
!>     C q - d + N (r/p) q = -e in contact after the block, q = 0 elsewhere;   force of q = 0, or d = 0;   c = e + N (r/p) q,
!>
!> and once more, so that pressures that have come to equilibrium stay there. With it the block is of second order in N, whatever
!> the prediction neglects: Rosenbrock's method with two stages and an approximate Jacobian (Verwer, Spee, Blom and Hundsdorfer
!> 1999, SIAM J. Sci. Comput. 20, 1456: ROS2 with gamma = 1, damped further). The error of first order is abs(c), to which the
!> estimate adds N abs(f2 - f1 - (f2 - f)/(N + 1))/2: if f2 still depends on the wear of the block, the slip that this wear causes
!> would be taken for that of every cycle, and wear feed on itself.
module mfv_wear_block
   use mfv_compliance, only: block_wp
   use mfv_contact_model, only: contact_model_type
   use mfv_contact_path, only: contact_path_type
   use mfv_contact_state, only: contact_state_type
   use mfv_kinds, only: wp
   use mfv_lapack, only: dgesv
   use mfv_motions, only: motion_approach
   use mfv_node_status, only: in_contact
   use mfv_tolerances, only: significant, visible
   use mfv_wear, only: wear_archard
   implicit none
   private
   public :: wear_block_type, find_wear_block, widened, work_of_wear

   !> The problem of a block: nodes near the contact, their softness r/p per cycle, pressure p, gap without any pressure on them,
   !> arm and width, and the compliance between them; in terms of the modulus and the `length` of the mesh.
   type :: problem_type
      integer, allocatable :: node(:)
      real(wp), allocatable :: softness(:), pressure(:), opening(:), arm(:), width(:), compliance(:, :)
      logical :: presses = .true.
      real(wp) :: length = 0.0_wp
   end type problem_type

   type :: wear_block_type
      integer :: cycles = 1
      !> Depth of the wear of the block, and of its first cycle: length, shape (nodes).
      real(wp), allocatable :: depth(:), first(:)
      !> The trapezoidal rule over the steps of the block less that over the whole of it: depth, length, shape (nodes); 0 if there
      !> is one step.
      real(wp), allocatable :: bend(:)
      !> Predicted change of the pressures or of the wear over the block, see change_of.
      real(wp) :: change = 0.0_wp
      type(problem_type), private :: problem
   contains
      procedure :: judge
   end type wear_block_type

contains

   !> A block from the friction work per unit of surface of its first cycle, whose end is the present state. `cycles`: their number;
   !> 0: as many as the predicted change allows, at most `most`. `presses`: whether the normal force is given. `correction`: depth
   !> that the surfaces wear by besides, at once, length, shape (nodes). The contact may reach the end of the mesh: wear beyond it
   !> is missing.
   subroutine find_wear_block(path, work, cycles, most, presses, block, correction)
      type(contact_path_type), intent(in) :: path
      real(wp), intent(in) :: work(:)
      integer, intent(in) :: cycles, most
      logical, intent(in) :: presses
      type(wear_block_type), intent(out) :: block
      real(wp), intent(in), optional :: correction(:)
      integer, parameter :: most_trials = 20
      real(wp), parameter :: safety = 0.9_wp, smallest = 0.1_wp
      real(wp), allocatable :: pressure(:)
      real(wp) :: worn
      integer :: trial, margin, n

      allocate (block%depth(size(work)), block%first(size(work)), block%bend(size(work)), source=0.0_wp)
      block%cycles = merge(cycles, most, cycles > 0)
      margin = size(work)/8
      block%problem%presses = presses
      worn = path%model%force(path%state%worn)/path%model%length()**2
      call gather(path, work, margin, block%problem, correction)
      if (size(block%problem%node) == 0) return
      associate (tolerance => path%model%scene%wear%tolerance, problem => block%problem)
         do trial = 1, most_trials
            do
               call solve(problem, real(block%cycles, wp), pressure)
               n = size(pressure)
               if (max(pressure(1), pressure(n)) <= 0.0_wp .or. margin >= size(work)) exit
               margin = 2*margin + 1
               call gather(path, work, margin, problem, correction)
            end do
            block%change = change_of(problem, block%cycles, pressure, worn)
            if (cycles > 0 .or. block%cycles == 1 .or. block%change <= tolerance) exit
            block%cycles = max(1, int(max(smallest, safety*tolerance/block%change)*block%cycles))
         end do
         if (block%cycles == 1) then
            block%depth(problem%node) = problem%softness*pressure*problem%length
            block%first = block%depth
         else
            call wear_off(block, steps_for(problem, pressure), pressure)
         end if
      end associate
   end subroutine find_wear_block

   !> Number of steps in which the depth of a block is found: in each the edges of the contact move outwards by about an interval,
   !> since what is touched during a step wears as if it had been in contact from its start. `pressure`: at the end of the
   !> block, shape (nodes of the problem).
   pure integer function steps_for(problem, pressure) result(steps)
      type(problem_type), intent(in) :: problem
      real(wp), intent(in) :: pressure(:)
      integer, parameter :: most = 100

      steps = min(max(1, count(pressure > 0.0_wp .and. .not. problem%pressure > 0.0_wp)/2), most)
   end function steps_for

   !> Find the depth of a block and of its first cycle by `steps` equal steps, each under the pressures at its end. `pressure`: at
   !> the end of a single step, shape (nodes of the problem).
   subroutine wear_off(block, steps, pressure)
      type(wear_block_type), intent(inout) :: block
      integer, intent(in) :: steps
      real(wp), allocatable, intent(inout) :: pressure(:)
      real(wp), allocatable :: opening(:), before(:), wear(:), first(:)
      real(wp) :: cycles
      integer :: i

      cycles = real(block%cycles, wp)/steps
      associate (problem => block%problem)
         opening = problem%opening
         before = problem%pressure
         call solve(problem, 1.0_wp, first)
         first = problem%softness*first
         allocate (wear(size(first)), source=0.0_wp)
         do i = 1, steps
            if (steps > 1) call solve(problem, cycles, pressure)
            wear = wear + cycles*problem%softness*pressure
            problem%opening = problem%opening + cycles*problem%softness*pressure
            problem%pressure = pressure
         end do
         problem%opening = opening
         problem%pressure = before
         block%first(problem%node) = first*problem%length
         block%depth(problem%node) = wear*problem%length
         if (steps > 1) block%bend(problem%node) = (wear + 0.5_wp*cycles*(first - problem%softness*pressure) &
                                                    - 0.5_wp*block%cycles*(first + problem%softness*pressure))*problem%length
      end associate
   end subroutine wear_off

   !> Judge a block by what the two cycles after it wear, `settling` and `next`, depths: length, shape (nodes), on a mesh that may
   !> have grown since. `correction`: of the depth of both the block and the cycle `settling`, length, shape (nodes). `error`: the
   !> larger of that of the worn area and of the largest depth, relative to all that is `worn` before the cycle `next`, depth, or to
   !> round-off; `width`: of the nodes. A block of one cycle has no correction; its error is what that of two cycles would have
   !> been, from `next` alone.
   subroutine judge(self, settling, next, worn, width, correction, error)
      class(wear_block_type), intent(in) :: self
      real(wp), intent(in) :: settling(:), next(:), worn(:), width(:)
      real(wp), allocatable, intent(out) :: correction(:)
      real(wp), intent(out) :: error
      real(wp), parameter :: round_off = 1.0e-13_wp
      real(wp), dimension(size(next)) :: first, depth, slope, memory, first_order
      real(wp), allocatable :: pressure(:)
      real(wp) :: n
      integer :: extra

      n = self%cycles
      extra = (size(next) - size(self%depth))/2
      first = widened(self%first, size(next))
      depth = widened(self%depth, size(next))
      memory = 0.0_wp
      allocate (correction(size(next)), source=0.0_wp)
      error = 0.0_wp
      if (size(self%problem%node) == 0) return
      associate (problem => self%problem, node => self%problem%node + extra)
         if (self%cycles == 1) then
            slope = next - first
            n = 2.0_wp
            call solve(problem, n, pressure)
            depth(node) = n*problem%softness*pressure*problem%length
            correction = n*first + 0.5_wp*n*(n - 1.0_wp)*slope - depth
         else
            slope = (next - first)/(n + 1.0_wp)
            call solve(problem, n, pressure)
            correction = (n + 1.0_wp)*first + 0.5_wp*n*(n + 1.0_wp)*slope + widened(self%bend, size(next)) - depth - settling
            memory = 0.5_wp*n*(next - settling - slope)
         end if
         first_order = correction
         call damp(problem, n, pressure > 0.0_wp, node, first_order)
         correction = first_order
         call damp(problem, n, pressure > 0.0_wp, node, correction)
      end associate
      associate (wrong => abs(first_order) + abs(memory), total => max(worn, round_off*self%problem%length))
         error = max(sum(width*wrong)/sum(width*max(total, wrong)), maxval(wrong)/maxval(max(total, wrong)))
      end associate
      if (self%cycles == 1) correction = 0.0_wp
   end subroutine judge

   !> Values of all nodes of a mesh that has grown to `nodes` nodes: zeros at either end.
   pure function widened(values, nodes)
      real(wp), intent(in) :: values(:)
      integer, intent(in) :: nodes
      real(wp) :: widened(nodes)

      widened = 0.0_wp
      associate (extra => (nodes - size(values))/2)
         widened(extra + 1:extra + size(values)) = values
      end associate
   end function widened

   !> Add to a depth of wear, length, shape (nodes), what the pressures of `active` nodes of the problem, which it changes, wear
   !> over `cycles` cycles; `node`: numbers of the nodes of the problem.
   subroutine damp(problem, cycles, active, node, depth)
      type(problem_type), intent(in) :: problem
      real(wp), intent(in) :: cycles
      logical, intent(in) :: active(:)
      integer, intent(in) :: node(:)
      real(wp), intent(inout) :: depth(:)
      real(wp) :: pressure(size(node)), approach

      pressure = 0.0_wp
      call solve_active(problem, cycles, active, depth(node)/problem%length, 0.0_wp, pressure, approach)
      depth(node) = depth(node) + cycles*problem%softness*pressure*problem%length
   end subroutine damp

   !> The work of friction per unit of surface that wears it by `depth`: force/length and length, shape (nodes).
   pure function work_of_wear(model, depth) result(work)
      type(contact_model_type), intent(in) :: model
      real(wp), intent(in) :: depth(:)
      real(wp) :: work(size(depth))

      work = depth/model%scene%wear%coefficient
      if (model%scene%wear%law == wear_archard) work = work*model%kinetic_friction
   end function work_of_wear

   !> Change of the pressures over a block relative to the force, or, if it is larger, that of the worn area, twice its error,
   !> relative to all that is worn: narrow slip zones have little of the force, but all of the wear.
   pure real(wp) function change_of(problem, cycles, pressure, worn)
      type(problem_type), intent(in) :: problem
      integer, intent(in) :: cycles
      real(wp), intent(in) :: pressure(:), worn
      real(wp) :: area

      associate (change => problem%width*abs(pressure - problem%pressure))
         change_of = sum(change)/sum(problem%width*problem%pressure)
         area = worn + cycles*sum(problem%softness*problem%width*problem%pressure)
         if (area > 0.0_wp) change_of = max(change_of, cycles*sum(problem%softness*change)/area)
      end associate
   end function change_of

   !> Gather the problem of a block, for the nodes up to `margin` nodes beyond those that slip in the cycle or are in contact;
   !> without nodes if there are none. `correction`: see find_wear_block.
   subroutine gather(path, work, margin, problem, correction)
      type(contact_path_type), intent(in) :: path
      real(wp), intent(in) :: work(:)
      integer, intent(in) :: margin
      type(problem_type), intent(inout) :: problem
      real(wp), intent(in), optional :: correction(:)
      logical :: contact(size(work)), known(size(work))
      real(wp), dimension(size(work)) :: rate, softness, beyond, gap, pressure
      integer :: i, first, last

      associate (model => path%model, wear => path%model%scene%wear)
         rate = wear%coefficient*max(work, 0.0_wp)
         if (wear%law == wear_archard) rate = rate/max(model%kinetic_friction, tiny(1.0_wp))
         call find_pressures(path%state, rate, pressure, known)
         contact = known .or. in_contact(path%state%status)
         known = known .or. contact .and. pressure > visible*maxval(pressure)
         first = findloc(known, .true., dim=1)
         last = findloc(known, .true., dim=1, back=.true.)
         problem%node = pack([(i, i=max(1, first - margin), min(size(work), last + margin))], &
                             model%can_touch(max(1, first - margin):min(size(work), last + margin)))
         if (first == 0) problem%node = [integer ::]
         do i = 1, size(work)
            if (known(i)) softness(i) = rate(i)/pressure(i)
         end do
         beyond = at_edges(known, softness)
         do i = 1, size(problem%node)
            if (.not. known(problem%node(i))) softness(problem%node(i)) = value_of_nearest(beyond, known, problem%node(i))
         end do
         gap = model%gap(path%state%fields)
         associate (length => model%length(), stress => model%compliance%modulus, node => problem%node)
            problem%length = length
            problem%softness = softness(node)*stress/length
            problem%pressure = pressure(node)/stress
            problem%arm = model%normal_arm(node, motion_approach)
            problem%width = model%width(node)/length
            if (allocated(problem%compliance)) deallocate (problem%compliance)
            allocate (problem%compliance(size(node), size(node)))
            call model%compliance%entries(block_wp, node, node, problem%compliance)
            problem%compliance = problem%compliance*(stress/length)
            problem%opening = merge(0.0_wp, gap(node), contact(node))/length - matmul(problem%compliance, problem%pressure)
            if (present(correction)) problem%opening = problem%opening + correction(node)/length
         end associate
      end associate
   end subroutine gather

   !> Values beyond the known ones: those at their edges, or of the nodes before them if these are larger. Nodes at the edges of the
   !> contact that are open in a part of the cycle slip less than what the contact will have grown to. Arguments of shape (nodes).
   pure function at_edges(known, values)
      logical, intent(in) :: known(:)
      real(wp), intent(in) :: values(:)
      real(wp) :: at_edges(size(values))
      integer :: i

      at_edges = values
      do i = 2, size(known) - 1
         if (known(i) .and. (known(i - 1) .neqv. known(i + 1))) &
            at_edges(i) = max(values(i), merge(values(i - 1), values(i + 1), known(i - 1)))
      end do
   end function at_edges

   !> The mean pressure of the cycle, weighted by the work, at nodes that slip, whose `rate` is above round-off; else the present
   !> pressure.
   pure subroutine find_pressures(state, rate, pressure, slips)
      type(contact_state_type), intent(in) :: state
      real(wp), intent(in) :: rate(:)
      real(wp), intent(out) :: pressure(:)
      logical, intent(out) :: slips(:)

      slips = rate > significant*maxval(rate) .and. state%pressure_work > 0.0_wp
      pressure = 0.0_wp
      where (slips)
         pressure = state%pressure_work/state%cycle_work
      elsewhere(in_contact(state%status))
         pressure = state%fields%pressure
      end where
   end subroutine find_pressures

   !> Of the values that are `known`, the one next to entry `i`, or the mean of two at the same distance; there is one.
   pure real(wp) function value_of_nearest(values, known, i) result(value)
      real(wp), intent(in) :: values(:)
      logical, intent(in) :: known(:)
      integer, intent(in) :: i
      integer :: j, sides(2)

      value = 0.0_wp
      do j = 1, size(known)
         sides = [max(1, i - j), min(size(known), i + j)]
         if (.not. any(known(sides))) cycle
         value = sum(values(sides), mask=known(sides))/count(known(sides))
         return
      end do
   end function value_of_nearest

   !> The pressures after `cycles` cycles of wear, by an active set.
   subroutine solve(problem, cycles, pressure)
      type(problem_type), intent(in) :: problem
      real(wp), intent(in) :: cycles
      real(wp), allocatable, intent(out) :: pressure(:)
      integer, parameter :: most_passes = 100
      logical :: active(size(problem%node)), wanted(size(problem%node))
      real(wp) :: gap(size(problem%node)), approach
      integer :: pass

      pressure = problem%pressure
      active = pressure > 0.0_wp
      do pass = 1, most_passes
         call solve_active(problem, cycles, active, problem%opening, sum(problem%width*problem%arm*problem%pressure), pressure, &
                           approach)
         gap = problem%opening - approach*problem%arm + matmul(problem%compliance, pressure) + cycles*problem%softness*pressure
         wanted = merge(pressure >= 0.0_wp, gap < 0.0_wp, active)
         if (all(wanted .eqv. active)) exit
         active = wanted
      end do
      pressure = max(pressure, 0.0_wp)
   end subroutine solve

   !> The pressures of active nodes with the given gap without them (`opening`) and normal force, zero elsewhere, and the further
   !> approach of the upper body; pressures are unchanged if the equations are singular.
   subroutine solve_active(problem, cycles, active, opening, force, pressure, approach)
      type(problem_type), intent(in) :: problem
      real(wp), intent(in) :: cycles, opening(:), force
      logical, intent(in) :: active(:)
      real(wp), intent(inout) :: pressure(:)
      real(wp), intent(out) :: approach
      real(wp), allocatable :: matrix(:, :), right(:)
      integer, allocatable :: at(:), pivot(:)
      integer :: i, m, code

      at = pack([(i, i=1, size(active))], active)
      m = size(at)
      approach = 0.0_wp
      allocate (matrix(m + 1, m + 1), right(m + 1), pivot(m + 1))
      matrix(:m, :m) = problem%compliance(at, at)
      do i = 1, m
         matrix(i, i) = matrix(i, i) + cycles*problem%softness(at(i))
      end do
      matrix(:m, m + 1) = -problem%arm(at)
      right(:m) = -opening(at)
      matrix(m + 1, :m) = merge(problem%width(at)*problem%arm(at), 0.0_wp, problem%presses)
      matrix(m + 1, m + 1) = merge(0.0_wp, 1.0_wp, problem%presses)
      right(m + 1) = merge(force, 0.0_wp, problem%presses)
      call dgesv(m + 1, 1, matrix, m + 1, pivot, right, m + 1, code)
      if (code /= 0) return
      pressure = 0.0_wp
      pressure(at) = right(:m)
      approach = right(m + 1)
   end subroutine solve_active

end module mfv_wear_block
