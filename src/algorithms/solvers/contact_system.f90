!> What a linear solver offers to the Method of First Violation: with the status of every node and the controlled
!> loads given, the state and its rates per unit of load.
module mfv_contact_system
   use, intrinsic :: iso_fortran_env, only: int64
   use mfv_contact_fields, only: contact_fields_type
   use mfv_contact_model, only: contact_model_type
   use mfv_friction_law, only: friction_row_type
   use mfv_kinds, only: wp
   use mfv_motions, only: motions, motion_count, control_force, control_displacement
   implicit none
   private
   public :: contact_system_type, load_type, response_type, constraints_type, prescribed_type, find_prescribed, initial_loads

   !> One controlled load: force (moment) or rigid displacement (rotation), its value now and its rate per unit of load.
   type :: load_type
      integer :: control = control_force
      real(wp) :: value = 0.0_wp
      real(wp) :: rate = 0.0_wp
   end type load_type

   integer :: motion
   !> Loads of bodies that nothing has been prescribed for: no forces; motions that need not be modelled are held.
   type(load_type), parameter :: initial_loads(motion_count) = &
                         [(load_type(merge(control_displacement, control_force, motions(motion)%optional)), motion=1, motion_count)]

   !> The equality constraints of all nodes (dissertation Table 2.1).
   type :: constraints_type
      !> Statuses, see mfv_node_status, shape (nodes).
      integer, allocatable :: status(:)
      !> Slip s at which a stuck node holds, length, shape (nodes).
      real(wp), allocatable :: stuck_slip(:)
      !> The lines tau = slope*p + stiffness*s + offset of slipping and creeping nodes (mfv_friction_law), and the rate of
      !> the offset per unit of load; shape (nodes).
      type(friction_row_type), allocatable :: row(:)
      real(wp), allocatable :: offset_rate(:)
      !> Rates with which nodes in contact part and stuck nodes slip, length per unit of load, shape (nodes); not there: none.
      real(wp), allocatable :: gap_rate(:), slip_rate(:)
      !> The load of every motion; of no meaning where the motion is not modelled.
      type(load_type) :: load(motion_count)
   end type constraints_type

   !> What the constraints prescribe of the state, or of its rates per unit of load.
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

   type, abstract :: contact_system_type
      !> What &solver linear_solver calls it.
      character(len=7) :: name = 'dgesv'
      !> Linear solves so far.
      integer :: solves = 0
      !> Of solvers that iterate: iterations, and products with the compliance, so far.
      integer(int64) :: iterations = 0, products = 0
      !> Tractions, motions and their rates are known to this part of the largest, what is below is noise; 0: to round-off.
      real(wp) :: tolerance = 0.0_wp
   contains
      procedure(solve_interface), deferred :: solve
   end type contact_system_type

   abstract interface
      !> Solve for state and rates. `start`: fields at or near which the state is expected (those now, when statuses have
      !> changed): a guess, of which the result does not depend beyond the solver's tolerance. `singular`: the constraints do
      !> not determine them; the response is then of no use. `response`: its storage is used again.
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

   !> What the constraints prescribe of the state of a model, or (`rates`) of its rates. `prescribed`: its storage is used again.
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
