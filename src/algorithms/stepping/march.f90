!> Where on a segment a contact is, for the algorithms that lead it: they can leave it there and go on another time, with the same
!> digits as if they had not.
module mfv_march
   use mfv_archive, only: archive_type
   use mfv_contact_path, only: moment_type
   use mfv_contact_system, only: constraints_type
   use mfv_increment, only: increment_type
   use mfv_kinds, only: wp
   implicit none
   private
   public :: march_type

   type :: march_type
      !> Left in the middle of a segment at the observer's wish; the next call for the same segment goes on from here.
      logical :: paused = .false.
      !> By violations: the part of what they lead that is done; whether the last increment had a length, and whether it has led to
      !> the end; the load now and that increment; what tells whether the load advances (see mfv_first_violation).
      real(wp) :: done = 0.0_wp
      logical :: moved = .false., at_end = .false.
      type(moment_type) :: moment
      type(increment_type) :: increment
      !> The constraints of an increment, made anew for each.
      type(constraints_type) :: constraints
      integer :: standing = 0, creeping = 0, since = 0
      real(wp) :: milestone = 0.0_wp
      !> By large increments, load steps or straight: the part of the segment that is done.
      real(wp) :: part = 0.0_wp
      !> By large increments: whether events lead on from there; how far increments go, and the length of the next interval, in
      !> parts of the segment.
      logical :: by_violations = .false.
      real(wp) :: goal = 0.0_wp, length = 0.0_wp
   contains
      procedure :: carry
   end type march_type

contains

   !> See mfv_archive.
   subroutine carry(self, archive)
      class(march_type), intent(inout) :: self
      type(archive_type), intent(inout) :: archive

      call archive%carry(self%paused)
      if (.not. self%paused) return
      call archive%carry(self%done)
      call archive%carry(self%moved)
      call archive%carry(self%at_end)
      call self%moment%carry(archive)
      call self%increment%carry(archive)
      call archive%carry(self%standing)
      call archive%carry(self%creeping)
      call archive%carry(self%since)
      call archive%carry(self%milestone)
      call archive%carry(self%part)
      call archive%carry(self%by_violations)
      call archive%carry(self%goal)
      call archive%carry(self%length)
   end subroutine carry

end module mfv_march
