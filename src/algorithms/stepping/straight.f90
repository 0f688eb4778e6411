!> Segments in which no friction can act need no history: their end depends on the loads alone. They are led there at once, by
!> the active set (mfv_active_set), and to where the bodies part, or wherever that does not succeed, by events. All others go by
!> events.
module mfv_straight
   use mfv_active_set, only: first_guess, settle_at
   use mfv_contact_fields, only: contact_fields_type
   use mfv_contact_path
   use mfv_contact_state, only: contact_state_type
   use mfv_contact_system, only: load_type
   use mfv_error, only: error_type
   use mfv_first_violation, only: failed_certificate, lead_by_violations, noises
   use mfv_kinds, only: wp
   use mfv_motions, only: motion_approach, control_force
   use mfv_node_status
   use mfv_observer, only: observer_type
   use mfv_scene, only: stepping_nominal
   use mfv_strings, only: to_text
   implicit none
   private
   public :: lead_straight, settle_on_mesh, grow_mesh, before_separation, carries_nothing_yet, &
             close_leap, part_of

contains

   !> Apply the loads of one segment, straight to its end where no friction can act, else by violations. `observer` is notified of
   !> the end, or of every increment. Errors: those of mfv_first_violation.
   subroutine lead_straight(path, segment, observer, error)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      class(observer_type), intent(inout), optional :: observer
      type(error_type), allocatable, intent(out) :: error
      type(contact_fields_type) :: fields
      real(wp) :: part
      logical :: settled, friction

      friction = segment%friction .and. path%model%scene%friction%acts()
      if (friction .or. path%model%scene%method%stepping == stepping_nominal) then
         call lead_by_violations(path, segment, observer, error)
         return
      end if
      call path%start_segment(segment, error)
      if (allocated(error)) return
      part = before_separation(segment)
      if (carries_nothing_yet(path, segment)) part = 0.0_wp
      settled = .false.
      if (part > 0.0_wp) call settle_and_grow(path, segment, part, fields, settled)
      if (.not. settled) part = 0.0_wp
      if (settled) then
         call path%take_increment(fields, fields%slip() - path%state%fields%slip(), 0.0_wp, &
                                  friction_work=0.0_wp*fields%shear)
         call close_leap(path, segment, part, observer, error)
         if (allocated(error) .or. .not. part < 1.0_wp) return
      end if
      call lead_by_violations(path, part_of(segment, part, 1.0_wp), observer, error)
   end subroutine lead_straight

   !> After large increments to the part `part` of the segment: check the certificate, and notify the observer.
   !> Errors MFV_NO_CONTINUATION: the certificate fails by far; MFV_INTERRUPTED.
   subroutine close_leap(path, segment, part, observer, error)
      class(contact_path_type), intent(in) :: path
      type(segment_type), intent(in) :: segment
      real(wp), intent(in) :: part
      class(observer_type), intent(inout), optional :: observer
      type(error_type), allocatable, intent(out) :: error

      if (path%certificate%largest() > max(failed_certificate, noises*path%system%noise)) &
         call path%no_continuation('the equations are no longer satisfied (certificate '// &
                                   to_text(path%certificate%largest())//')', error)
      if (.not. allocated(error)) call path%notify(segment, part, observer, error)
   end subroutine close_leap

   !> Statuses and fields at a part of the segment, on a mesh that grows with the contact where it may. `settled`: whether they
   !> were found; the statuses are as they were otherwise. The fields of `path` stay those of the start.
   subroutine settle_and_grow(path, segment, part, fields, settled)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      real(wp), intent(in) :: part
      type(contact_fields_type), intent(out) :: fields
      logical, intent(out) :: settled
      type(contact_state_type) :: start
      logical :: exceeded, grown

      do
         start = path%state
         call settle_on_mesh(path, segment, part, fields, settled, exceeded)
         if (settled) return
         path%state = start
         if (.not. exceeded) return
         call grow_mesh(path, grown)
         if (.not. grown) return
      end do
   end subroutine settle_and_grow

   !> Statuses and fields at a part of the segment. The statuses of `path` are the first guess; where nothing is in contact
   !> there is another. `settled`: whether they were found, on this mesh; if not, the statuses are of no use, and `exceeded`
   !> tells whether only the mesh is too short. The fields of `path` stay those of the start.
   subroutine settle_on_mesh(path, segment, part, fields, settled, exceeded)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      real(wp), intent(in) :: part
      type(contact_fields_type), intent(out) :: fields
      logical, intent(out) :: settled, exceeded

      call guess_contact(path, segment, part)
      call settle_at(path, segment, part, fields, settled)
      exceeded = settled
      if (settled) exceeded = path%model%reaches_end(in_contact(path%state%status))
      settled = settled .and. .not. exceeded
   end subroutine settle_on_mesh

   !> Lengthen the mesh, if it may grow. `grown`: whether it did.
   subroutine grow_mesh(path, grown)
      class(contact_path_type), intent(inout) :: path
      logical, intent(out) :: grown
      type(moment_type) :: moment

      grown = path%model%growing .and. path%model%spare_nodes() > 0
      if (grown) call path%widen(moment)
   end subroutine grow_mesh

   !> A first guess of the contact where there is none.
   subroutine guess_contact(path, segment, part)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      real(wp), intent(in) :: part
      logical :: contact(size(path%state%status))
      integer :: status(size(path%state%status))

      if (any(in_contact(path%state%status))) return
      call first_guess(path, segment, part, contact)
      status = node_frictionless
      if (segment%friction .and. path%model%tangential) status = node_stick
      call path%set_status(contact, status)
   end subroutine guess_contact

   !> How far along the segment the bodies are certainly pressed together: the whole of it unless the normal force falls to
   !> zero, then up to where little of it is left. (At zero the pressures of any contact are zero.)
   pure real(wp) function before_separation(segment) result(part)
      type(segment_type), intent(in) :: segment
      real(wp), parameter :: nothing = 1.0e-9_wp, little = 1.0e-4_wp

      part = 1.0_wp
      if (segment%load(motion_approach)%control /= control_force) return
      associate (start => segment%load(motion_approach)%value, change => segment%load(motion_approach)%rate)
         if (start + change > nothing*abs(start) .and. start + change > 0.0_wp) return
         part = 0.0_wp
         if (start > 0.0_wp) part = (1.0_wp - little)*start/(-change)
      end associate
   end function before_separation

   !> Whether a force other than the normal one begins to act while the bodies are apart and only draw near: it has nothing to
   !> carry it until they touch.
   pure logical function carries_nothing_yet(path, segment)
      class(contact_path_type), intent(in) :: path
      type(segment_type), intent(in) :: segment

      carries_nothing_yet = .false.
      if (segment%load(motion_approach)%control == control_force .or. any(in_contact(path%state%status))) return
      carries_nothing_yet = any(path%model%moves .and. acts(segment%load))

   contains

      elemental logical function acts(load)
         type(load_type), intent(in) :: load

         acts = load%control == control_force .and. max(abs(load%value), abs(load%rate)) > 0.0_wp
      end function acts
   end function carries_nothing_yet

   !> The segment from a part `begin` of it to a part `end`.
   pure type(segment_type) function part_of(segment, begin, end) result(part)
      type(segment_type), intent(in) :: segment
      real(wp), intent(in) :: begin, end

      part = segment
      if (.not. begin > 0.0_wp .and. .not. end < 1.0_wp) return
      part%load = part_of_load(segment%load, begin, end)
      part%from = segment%from + (segment%to - segment%from)*begin
      part%to = segment%from + (segment%to - segment%from)*end
   end function part_of

   elemental type(load_type) function part_of_load(load, begin, end) result(part)
      type(load_type), intent(in) :: load
      real(wp), intent(in) :: begin, end

      part = load_type(load%control, load%value + begin*load%rate, (end - begin)*load%rate)
   end function part_of_load

end module mfv_straight
