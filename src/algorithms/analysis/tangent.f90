!> Consistent tangent of a contact: derivatives of its loads with respect to the motions of the upper body.
!>
!> With fixed statuses everything is linear (mfv_first_violation): the derivatives are exact until a node changes its status.
!> Where contact and friction are not differentiable (load reversal, first contact of nodes) they depend on the direction of
!> the motions: the statuses are first adapted to it.
module mfv_tangent
   use mfv_contact_path, only: contact_path_type, segment_type
   use mfv_contact_state, only: contact_state_type
   use mfv_contact_system
   use mfv_error, only: error_type, set_error
   use mfv_first_violation, only: apply_by_violations
   use mfv_kinds, only: wp
   use mfv_motions, only: motion_count, control_displacement
   use mfv_node_status, only: in_contact, node_frictionless
   use mfv_observer, only: observer_type
   use mfv_status, only: MFV_BAD_ARGUMENT, MFV_INTERRUPTED
   use mfv_tolerances, only: significant
   implicit none
   private
   public :: find_tangent

   !> Stops a run when the statuses are consistent with the direction: not at an increment within tolerance, or one that only
   !> relaxes over-stress, after which others change at the same load.
   type, extends(observer_type) :: settled_type
   contains
      procedure :: notify
   end type settled_type

contains

   !> tangent(i, j): derivative of the force of motion i with respect to motion j (mfv_motions), shape (motions, motions), motions
   !> from 2 to motion_count; the others are fixed. `direction`: of the next motions, shape (motions), of any length; friction
   !> acts, if the scene has any. If omitted, statuses are unchanged, but nodes that were pressed without friction stick, if the
   !> scene has friction: whatever small motion follows, no shear reaches the friction limit at once. Zero without contact and,
   !> for the shift, without friction. Errors MFV_BAD_ARGUMENT: singular contact, a direction of zeros, or motions that surfaces
   !> do not have that repeat; others: the run in this direction fails.
   subroutine find_tangent(path, tangent, error, direction)
      type(contact_path_type), intent(in) :: path
      real(wp), intent(out) :: tangent(:, :)
      type(error_type), allocatable, intent(out) :: error
      real(wp), intent(in), optional :: direction(:)
      type(contact_path_type) :: copy
      class(contact_system_type), allocatable :: system
      logical :: sticks
      integer :: i

      tangent = 0.0_wp
      if (any([(.not. path%model%scene%can_repeat(i), i=1, size(tangent, 1))])) then
         call set_error(error, MFV_BAD_ARGUMENT, 'surfaces that repeat (period in &mesh) have no rotation and no '// &
                        'bulk stress: the tangent has two motions')
         return
      end if
      sticks = any(path%state%status == node_frictionless) .and. path%model%scene%friction%acts()
      if (.not. (present(direction) .or. sticks) .and. all(path%model%moves(:size(tangent, 1)))) then
         ! The solver changes in use: work on a copy, so that results of the original stay bit-identical.
         allocate (system, source=path%system)
         call derive(path, system, tangent, error)
         return
      end if
      call path%copy_without_history(copy)
      do i = 1, size(tangent, 1)
         call copy%begin_motion(i)
      end do
      if (present(direction)) then
         call adapt_statuses(copy, direction, error)
      else if (sticks) then
         call copy%switch_friction(segment_type(), error)
      end if
      if (allocated(error)) return
      allocate (system, source=copy%system)
      call derive(copy, system, tangent, error)
   end subroutine find_tangent

   !> Adapt the statuses to motions in a direction.
   subroutine adapt_statuses(path, direction, error)
      type(contact_path_type), intent(inout) :: path
      real(wp), intent(in) :: direction(:)
      type(error_type), allocatable, intent(out) :: error
      !> Length of the trial motion over that of the mesh: small, but well above rounding errors.
      real(wp), parameter :: little = significant
      type(segment_type) :: segment
      type(settled_type) :: observer
      integer :: i
      real(wp) :: motion(motion_count), largest

      motion = 0.0_wp
      motion(:size(direction)) = direction
      largest = maxval(abs(motion)*path%model%unit_of_arm([(i, i=1, motion_count)]))
      if (.not. largest > 0.0_wp) then
         call set_error(error, MFV_BAD_ARGUMENT, 'the direction of the tangent must not be all zeros')
         return
      end if
      motion = motion/largest*(little*path%model%length())
      segment%load = [(load_type(control_displacement, path%state%fields%motion(i), motion(i)), i=1, motion_count)]
      call apply_by_violations(path, segment, observer, error)
      if (.not. allocated(error)) return
      if (error%status == MFV_INTERRUPTED) deallocate (error)
   end subroutine adapt_statuses

   !> See mfv_observer.
   subroutine notify(self, state, segment, segments, fraction, stop_wanted)
      class(settled_type), intent(inout) :: self
      type(contact_state_type), intent(in) :: state
      integer, intent(in) :: segment, segments
      real(wp), intent(in) :: fraction
      logical, intent(out) :: stop_wanted
      real(wp), parameter :: minimum = 0.01_wp

      stop_wanted = fraction > minimum
   end subroutine notify

   !> Derivatives with the present statuses, by a separate solver.
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
            call set_error(error, MFV_BAD_ARGUMENT, &
                           'the tangent is not determined: the linear system of the contact is singular')
            return
         end if
         do i = 1, size(tangent, 1)
            tangent(i, j) = path%model%resultant(i, response%rate%pressure, response%rate%shear)
         end do
      end do
   end subroutine derive

end module mfv_tangent
