!> The consistent tangent of a contact: how its loads change with the motions of the upper body.
!>
!> With all statuses fixed everything is linear (mfv_first_violation), so that the rates of the loads under prescribed motions are
!> derivatives, exact until a node changes its status. At corners of contact and friction (a load that turns, nodes that touch) they
!> depend on where the motions go on to: then the statuses are first settled in that direction.
module mfv_tangent
   use mfv_contact_path, only: contact_path_type, segment_type
   use mfv_contact_state, only: contact_state_type
   use mfv_contact_system
   use mfv_error, only: error_type, set_error
   use mfv_first_violation, only: apply_by_violations
   use mfv_kinds, only: wp
   use mfv_motions, only: motion_count, control_displacement, arm_unit
   use mfv_node_status, only: in_contact
   use mfv_observer, only: observer_type
   use mfv_status, only: MFV_BAD_ARGUMENT, MFV_INTERRUPTED
   implicit none
   private
   public :: find_tangent

   !> Ends a run when the statuses have settled: not at an increment that is round-off, or that only lets excess tractions go, after
   !> which
   !> others change at the same load.
   type, extends(observer_type) :: settled_type
   contains
      procedure :: notify
   end type settled_type

contains

   !> tangent(i, j): derivative of the force of motion i with respect to motion j (mfv_motions), shape (motions, motions), motions
   !> from 2 to motion_count; the others are held.
   !> `direction`: of motions to go on with, shape (motions), only its direction counts; friction acts, if the scene has any. Left
   !> out, statuses are as they are.
   !> Errors MFV_BAD_ARGUMENT: the contact does not determine it, or a direction of zeros; others: nothing leads on in this
   !> direction.
   subroutine find_tangent(path, tangent, error, direction)
      type(contact_path_type), intent(in) :: path
      real(wp), intent(out) :: tangent(:, :)
      type(error_type), allocatable, intent(out) :: error
      real(wp), intent(in), optional :: direction(:)
      type(contact_path_type) :: copy
      class(contact_system_type), allocatable :: system
      integer :: i

      tangent = 0.0_wp
      if (.not. present(direction) .and. all(path%model%moves(:size(tangent, 1)))) then
         ! The solver's work is its state: a copy leaves the digits of the original as they are.
         allocate (system, source=path%system)
         call derive(path, system, tangent, error)
         return
      end if
      call path%copy_without_history(copy)
      do i = 1, size(tangent, 1)
         call copy%begin_motion(i)
      end do
      if (present(direction)) call turn(copy, direction, error)
      if (allocated(error)) return
      allocate (system, source=copy%system)
      call derive(copy, system, tangent, error)
   end subroutine find_tangent

   !> Settle the statuses for motions that go on in a direction.
   subroutine turn(path, direction, error)
      type(contact_path_type), intent(inout) :: path
      real(wp), intent(in) :: direction(:)
      type(error_type), allocatable, intent(out) :: error
      !> So far, in parts of the mesh's length: little beside everything but round-off.
      real(wp), parameter :: little = 1.0e-9_wp
      type(segment_type) :: segment
      type(settled_type) :: observer
      integer :: i
      real(wp) :: motion(motion_count), largest

      motion = 0.0_wp
      motion(:size(direction)) = direction
      largest = maxval(abs(motion)*[(arm_unit(i, path%model%length()), i=1, motion_count)])
      if (.not. largest > 0.0_wp) then
         call set_error(error, MFV_BAD_ARGUMENT, 'the direction of the tangent has no length')
         return
      end if
      motion = motion/largest*(little*path%model%length())
      segment%load = [(load_type(control_displacement, path%state%fields%motion(i), motion(i)), i=1, motion_count)]
      call apply_by_violations(path, segment, observer, error)
      if (.not. allocated(error)) return
      if (error%status == MFV_INTERRUPTED) deallocate (error)
   end subroutine turn

   !> See mfv_observer.
   subroutine notify(self, state, segment, segments, fraction, stop_wanted)
      class(settled_type), intent(inout) :: self
      type(contact_state_type), intent(in) :: state
      integer, intent(in) :: segment, segments
      real(wp), intent(in) :: fraction
      logical, intent(out) :: stop_wanted
      real(wp), parameter :: on_the_way = 0.01_wp

      stop_wanted = fraction > on_the_way
   end subroutine notify

   !> The derivatives with the statuses as they are, by a solver of its own.
   subroutine derive(path, system, tangent, error)
      type(contact_path_type), intent(in) :: path
      class(contact_system_type), intent(inout) :: system
      real(wp), intent(inout) :: tangent(:, :)
      type(error_type), allocatable, intent(out) :: error
      type(constraints_type) :: constraints
      type(response_type) :: response
      logical :: singular
      integer :: i, j

      if (.not. any(in_contact(path%state%status))) return
      call path%set_rows(constraints, .false.)
      do j = 1, size(tangent, 2)
         constraints%load = [(load_type(control_displacement, path%state%fields%motion(i), merge(1.0_wp, 0.0_wp, i == j)), &
                              i=1, motion_count)]
         call system%solve(path%model, constraints, path%state%fields, response, singular)
         if (singular) then
            call set_error(error, MFV_BAD_ARGUMENT, 'the contact does not determine the tangent: the linear system is singular')
            return
         end if
         do i = 1, size(tangent, 1)
            tangent(i, j) = path%model%resultant(i, response%rate%pressure, response%rate%shear)
         end do
      end do
   end subroutine derive

end module mfv_tangent
