!> How a caller watches a run, and stops it: an object of its own that is told of every increment.
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
      !> Told after every increment. `segment`, `segments`: which of the straight parts of the load history is on its
      !> way; `fraction`: how much of it is done. `stop_wanted`: set to end the run here, as interrupted.
      subroutine notify_interface(self, state, segment, segments, fraction, stop_wanted)
         import :: contact_state_type, observer_type, wp
         class(observer_type), intent(inout) :: self
         type(contact_state_type), intent(in) :: state
         integer, intent(in) :: segment, segments
         real(wp), intent(in) :: fraction
         logical, intent(out) :: stop_wanted
      end subroutine notify_interface
   end interface

   !> Tells a caller of one run among several, all as one work.
   type, extends(observer_type) :: relay_type
      !> Who is told; not associated: nobody.
      class(observer_type), pointer :: caller => null()
      !> Runs before this one, and of all.
      integer :: before = 0, runs = 1
      !> Whether the caller has stopped it.
      logical :: ended = .false.
   contains
      procedure :: notify => relay
   end type relay_type

contains

   !> Another part of the work begins, such as solving on coarser meshes.
   subroutine begin_work(self, work)
      class(observer_type), intent(inout) :: self
      character(*), intent(in) :: work
   end subroutine begin_work

   !> Something that does not end the run, but that a user should know at once.
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
