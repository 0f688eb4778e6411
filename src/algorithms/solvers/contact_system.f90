!> Interface of linear solvers: for given statuses and controlled loads, the state and its rates per unit of load.
module mfv_contact_system
   use, intrinsic :: iso_fortran_env, only: int64
   use mfv_contact_fields, only: contact_fields_type
   use mfv_contact_model, only: contact_model_type
   use mfv_friction_law, only: friction_row_type
   use mfv_kinds, only: wp
   use mfv_motions, only: motions, motion_count, control_force, control_displacement
   implicit none
   private
   public :: contact_system_type, solver_work_type, load_type, front_type, response_type, constraints_type, prescribed_type, &
             find_prescribed, initial_loads
   public :: rates_of_loads, rates_at_end, rates_of_derivatives, kinds_of_rates

   !> Kinds of rates: of the loads, of the loads at states of large increments, and derivatives with respect to parameters.
   integer, parameter :: rates_of_loads = 1, rates_at_end = 2, rates_of_derivatives = 3, kinds_of_rates = 3

   !> A controlled load: force (moment) or displacement (rotation), its present value and its rate per unit of load.
   type :: load_type
      integer :: control = control_force
      real(wp) :: value = 0.0_wp
      real(wp) :: rate = 0.0_wp
   end type load_type

   integer :: motion
   !> Loads before the first step: no forces; optional motions are fixed.
   type(load_type), parameter :: initial_loads(motion_count) = &
                         [(load_type(merge(control_displacement, control_force, motions(motion)%optional)), motion=1, motion_count)]

   !> A stuck node holds at its `stuck_slip` plus `weight` times the slip of another `node`, 0: none. That one does not stick; its
   !> line (row) is zero where it has no friction.
   type :: front_type
      integer :: node = 0
      real(wp) :: weight = 0.0_wp
   end type front_type

   !> The equality constraints of all nodes (dissertation Table 2.1).
   type :: constraints_type
      !> Statuses, see mfv_node_status, shape (nodes).
      integer, allocatable :: status(:)
      !> Slip s at which a stuck node holds, length, shape (nodes).
      real(wp), allocatable :: stuck_slip(:)
      !> What the slip of stuck nodes depends on, shape (nodes); not allocated: nothing.
      type(front_type), allocatable :: front(:)
      !> The lines tau = slope*p + stiffness*s + offset of slipping and creeping nodes (mfv_friction_law), and the rate of
      !> the offset per unit of load; shape (nodes).
      type(friction_row_type), allocatable :: row(:)
      real(wp), allocatable :: offset_rate(:)
      !> Rates of the gaps of nodes in contact and of the slip of stuck nodes, length per unit of load, shape (nodes); not
      !> allocated: zero.
      real(wp), allocatable :: gap_rate(:), slip_rate(:)
      !> The load of every motion; meaningless for motions that are not modelled.
      type(load_type) :: load(motion_count)
      !> Rates of one kind, such as those of the loads, resemble each other: a first guess of iterative solvers.
      integer :: kind = rates_of_loads
      !> Whether only rates are wanted: the state may be the first guess.
      logical :: rates_only = .false.
      !> Whether nodes change their status one by one, from event to event, which decides on the solver.
      logical :: one_by_one = .false.
      !> Relative errors of states, and of rates but those of the loads, that iterative solvers may leave, if above the
      !> linear_tolerance of the scene.
      real(wp) :: allowed = 0.0_wp, allowed_in_rates = 0.0_wp
   end type constraints_type

   !> Prescribed values of the state, or of its rates per unit of load.
   type :: prescribed_type
      !> Opening w - delta of nodes in contact and slip s of stuck ones, length; offsets of the lines of slipping and creeping ones,
      !> force/length^2; shape (nodes).
      real(wp), allocatable :: opening(:), slip(:), offset(:)
      !> Values of the controlled loads.
      real(wp) :: load(motion_count) = 0.0_wp
   end type prescribed_type

   !> The state that the constraints determine and its rates per unit of load.
   type :: response_type
      type(contact_fields_type) :: state, rate
   end type response_type

   !> Work so far: linear solves; iterations, and products with the compliance (iterative solvers).
   type :: solver_work_type
      integer :: solves = 0
      integer(int64) :: iterations = 0, products = 0
   end type solver_work_type

   type, abstract, extends(solver_work_type) :: contact_system_type
      !> Value of &solver linear_solver.
      character(len=7) :: name = 'dgesv'
      !> Tolerance of tractions, motions and their rates of the last solve, relative to the largest; 0: round-off.
      !> `rate_tolerance`: the same of the rates that may be less accurate.
      real(wp) :: tolerance = 0.0_wp, rate_tolerance = 0.0_wp
      !> Whether the last solve failed although the constraints may determine the fields: the iteration did not converge.
      logical :: gave_up = .false.
   contains
      procedure(solve_interface), deferred :: solve
   end type contact_system_type

   abstract interface
      !> Solve for state and rates. `start`: a first guess (the present fields, after a change of statuses); the result depends on
      !> it only within the tolerance. `singular`: the constraints do not determine the fields; the response is then invalid.
      !> `response`: its storage is reused.
      subroutine solve_interface(self, model, constraints, start, response, singular)
         import :: constraints_type, contact_fields_type, contact_model_type, contact_system_type, response_type
         class(contact_system_type), intent(inout) :: self
         type(contact_model_type), intent(in) :: model
         type(constraints_type), intent(in) :: constraints
         type(contact_fields_type), intent(in) :: start
         type(response_type), intent(inout) :: response
         logical, intent(out) :: singular
      end subroutine solve_interface
   end interface

contains

   !> The prescribed values of the state of a model, or (`rates`) of its rates. `prescribed`: its storage is reused.
   pure subroutine find_prescribed(constraints, model, rates, prescribed)
      type(constraints_type), intent(in) :: constraints
      type(contact_model_type), intent(in) :: model
      logical, intent(in) :: rates
      type(prescribed_type), intent(inout) :: prescribed

      if (.not. rates) then
         prescribed%load = constraints%load%value
         prescribed%offset = constraints%row%offset
         prescribed%opening = -model%initial_gap
         prescribed%slip = constraints%stuck_slip
         return
      end if
      prescribed%load = constraints%load%rate
      prescribed%offset = constraints%offset_rate
      call set_rates(prescribed%opening, size(constraints%status), constraints%gap_rate)
      call set_rates(prescribed%slip, size(constraints%status), constraints%slip_rate)
   end subroutine find_prescribed

   !> Rates of `nodes` nodes, zero if none are given.
   pure subroutine set_rates(rates, nodes, given)
      real(wp), allocatable, intent(inout) :: rates(:)
      integer, intent(in) :: nodes
      real(wp), allocatable, intent(in) :: given(:)

      if (allocated(given)) then
         rates = given
         return
      end if
      if (allocated(rates)) then
         if (size(rates) /= nodes) deallocate (rates)
      end if
      if (.not. allocated(rates)) allocate (rates(nodes))
      rates = 0.0_wp
   end subroutine set_rates

end module mfv_contact_system
