!> An observer of a run, notified of every increment; it can stop the run.
module mfv_observer
   use mfv_contact_state, only: contact_state_type
   use mfv_kinds, only: wp
   implicit none
   private
   public :: observer_type, relay_type

   type, abstract :: observer_type
   contains
      procedure(notify_interface), deferred :: notify
      procedure :: begin_work
      procedure :: warn
   end type observer_type

   abstract interface
      !> Called after every increment. `segment`, `segments`: number of the current load segment, and of all segments; `fraction`:
      !> how much of it is done. `stop_wanted`: set to interrupt the run.
      subroutine notify_interface(self, state, segment, segments, fraction, stop_wanted)
         import :: contact_state_type, observer_type, wp
         class(observer_type), intent(inout) :: self
         type(contact_state_type), intent(in) :: state
         integer, intent(in) :: segment, segments
         real(wp), intent(in) :: fraction
         logical, intent(out) :: stop_wanted
      end subroutine notify_interface
   end interface

   !> Notifies a caller of one of several runs, all as one work.
   type, extends(observer_type) :: relay_type
      !> The observer of the caller, if associated.
      class(observer_type), pointer :: caller => null()
      !> Number of runs before this one, and of all runs.
      integer :: before = 0, runs = 1
      !> Whether the caller has stopped it.
      logical :: ended = .false.
   contains
      procedure :: notify => relay
   end type relay_type

contains

   !> Called when another stage of the work begins, such as solving on coarser meshes; '': the case itself.
   subroutine begin_work(self, work)
      class(observer_type), intent(inout) :: self
      character(*), intent(in) :: work
   end subroutine begin_work

   !> Called for a warning that a user should see at once; the run continues.
   subroutine warn(self, text)
      class(observer_type), intent(inout) :: self
      character(*), intent(in) :: text
   end subroutine warn

   !> See observer_type.
   subroutine relay(self, state, segment, segments, fraction, stop_wanted)
      class(relay_type), intent(inout) :: self
      type(contact_state_type), intent(in) :: state
      integer, intent(in) :: segment, segments
      real(wp), intent(in) :: fraction
      logical, intent(out) :: stop_wanted

      stop_wanted = .false.
      if (.not. associated(self%caller)) return
      call self%caller%notify(state, self%before*segments + segment, self%runs*segments, fraction, stop_wanted)
      self%ended = stop_wanted
   end subroutine relay

end module mfv_observer
