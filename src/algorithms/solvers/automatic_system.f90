!> linear_solver='auto': the reduced system while few nodes are in contact, then the iteration through FFTW.
!>
!> The number of nodes in contact is not known at the start of a run, but at every solve. The reduced system returns, with a new
!> factorisation, when less than half as many are in contact (the first guess of an active set can be far too large).
module mfv_automatic_system
   use mfv_contact_fields, only: contact_fields_type
   use mfv_contact_model, only: contact_model_type
   use mfv_contact_system
   use mfv_krylov_system, only: krylov_system_type
   use mfv_node_status, only: in_contact
   use mfv_reduced_system, only: reduced_system_type
   implicit none
   private
   public :: automatic_system_type

   type, extends(contact_system_type) :: automatic_system_type
      !> Most nodes in contact for the reduced system; the same where nodes change their status one by one.
      integer :: most = 0, most_one_by_one = 0
      !> Whether the last solve was by iteration.
      logical, private :: iterates = .false.
      !> (Both allocatable: otherwise gfortran 12 does not free the components of the second.)
      type(reduced_system_type), allocatable, private :: reduced
      type(krylov_system_type), allocatable, private :: krylov
   contains
      procedure :: solve
   end type automatic_system_type

contains

   !> See mfv_contact_system.
   subroutine solve(self, model, constraints, start, response, singular)
      class(automatic_system_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      type(constraints_type), intent(in) :: constraints
      type(contact_fields_type), intent(in) :: start
      type(response_type), intent(inout) :: response
      logical, intent(out) :: singular

      call choose(self, count(in_contact(constraints%status)), constraints%one_by_one)
      if (self%iterates) then
         call solve_by(self%krylov)
      else
         call solve_by(self%reduced)
      end if

   contains

      !> Solve by one of the two, and take over its name, tolerance and counts.
      subroutine solve_by(system)
         class(contact_system_type), intent(inout) :: system

         self%solves = self%solves + 1
         self%iterations = self%iterations - system%iterations
         self%products = self%products - system%products
         call system%solve(model, constraints, start, response, singular)
         self%iterations = self%iterations + system%iterations
         self%products = self%products + system%products
         self%name = system%name
         self%gave_up = system%gave_up
         self%tolerance = system%tolerance
         self%rate_tolerance = system%rate_tolerance
      end subroutine solve_by
   end subroutine solve

   !> Choose by the number of nodes in contact, and whether they change their status one by one.
   subroutine choose(self, contact, one_by_one)
      class(automatic_system_type), intent(inout) :: self
      integer, intent(in) :: contact
      logical, intent(in) :: one_by_one
      integer :: most

      most = merge(self%most_one_by_one, self%most, one_by_one)
      self%iterates = contact > merge(most/2, most, self%iterates .and. .not. one_by_one)
      if (self%iterates) then
         if (allocated(self%reduced)) deallocate (self%reduced)
         if (allocated(self%krylov)) return
         allocate (self%krylov)
         self%krylov%name = 'fft'
      else
         if (allocated(self%krylov)) deallocate (self%krylov)
         if (allocated(self%reduced)) return
         allocate (self%reduced)
         self%reduced%name = 'reduced'
      end if
   end subroutine choose

end module mfv_automatic_system
