!> Load segments without friction depend on the final loads alone. They are applied in one large increment with the active set
!> method (mfv_active_set). The method of events takes over where the bodies separate, and where no solution is found. Segments
!> with friction are applied by events.
module mfv_frictionless
   use mfv_active_set, only: first_guess, find_statuses
   use mfv_contact_fields, only: contact_fields_type
   use mfv_contact_path
   use mfv_contact_state, only: contact_state_type
   use mfv_contact_system, only: load_type
   use mfv_error, only: error_type
   use mfv_first_violation, only: apply_by_violations, most_residual
   use mfv_kinds, only: wp
   use mfv_motions, only: motion_approach, control_force
   use mfv_node_status
   use mfv_observer, only: observer_type
   use mfv_scene, only: stepping_nominal
   use mfv_strings, only: to_text
   use mfv_tolerances, only: significant
   implicit none
   private
   public :: apply_directly, find_statuses_and_grow, find_statuses_on_mesh, grow_mesh, before_separation, lacks_support, &
             finish_large_increment, subsegment

contains

   !> Apply the loads of a segment: at once if friction does not act, else by violations. `observer` is notified of the end or of
   !> every increment. Errors: those of mfv_first_violation.
   subroutine apply_directly(path, segment, observer, error)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      class(observer_type), intent(inout), optional :: observer
      type(error_type), allocatable, intent(out) :: error
      type(contact_fields_type) :: fields
      type(contact_state_type) :: start
      real(wp) :: fraction
      logical :: found, friction

      friction = segment%friction .and. path%model%scene%friction%acts()
      if (friction .or. path%model%scene%method%stepping == stepping_nominal) then
         call apply_by_violations(path, segment, observer, error)
         return
      end if
      call path%switch_friction(segment, error)
      if (allocated(error)) return
      fraction = before_separation(segment)
      if (lacks_support(path, segment)) fraction = 0.0_wp
      found = .false.
      if (fraction > 0.0_wp) call find_statuses_and_grow(path, segment, fraction, fields, found, start)
      if (.not. found) fraction = 0.0_wp
      if (found) then
         call path%take_increment(fields, fields%slip() - path%state%fields%slip(), 0.0_wp, &
                                  friction_work=0.0_wp*fields%shear)
         call finish_large_increment(path, segment, fraction, observer, error)
         if (allocated(error) .or. .not. fraction < 1.0_wp) return
      end if
      call apply_by_violations(path, subsegment(segment, fraction, 1.0_wp), observer, error)
   end subroutine apply_directly

   !> After large increments to the fraction `fraction` of the segment: check the certificate and notify the observer.
   !> Errors MFV_NO_CONTINUATION: the certificate is far too large; MFV_INTERRUPTED.
   subroutine finish_large_increment(path, segment, fraction, observer, error)
      class(contact_path_type), intent(in) :: path
      type(segment_type), intent(in) :: segment
      real(wp), intent(in) :: fraction
      class(observer_type), intent(inout), optional :: observer
      type(error_type), allocatable, intent(out) :: error

      if (path%certificate%largest() > most_residual(path)) &
         call path%no_continuation('the equations are no longer satisfied (certificate '// &
                                   to_text(path%certificate%largest())//')', error)
      if (.not. allocated(error)) call path%notify(segment, fraction, observer, error)
   end subroutine finish_large_increment

   !> Statuses and fields at a fraction of the segment, on a mesh that may grow with the contact. `found`: whether there are any;
   !> otherwise the statuses are unchanged. The fields of `path` remain those of the start. `start`: the state before, on that mesh.
   subroutine find_statuses_and_grow(path, segment, fraction, fields, found, start)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      real(wp), intent(in) :: fraction
      type(contact_fields_type), intent(out) :: fields
      logical, intent(out) :: found
      type(contact_state_type), intent(out) :: start
      logical :: exceeded, grown

      do
         start = path%state
         fields = start%fields
         call find_statuses_on_mesh(path, segment, fraction, fields, found, exceeded)
         if (found) return
         path%state = start
         if (.not. exceeded) return
         call grow_mesh(path, grown)
         if (.not. grown) return
      end do
   end subroutine find_statuses_and_grow

   !> Statuses and fields at a fraction of the segment, on the present mesh. The first guess is `fields` and the statuses of `path`,
   !> or an estimate if nothing is in contact. `found`: whether there are any; if not, the statuses are invalid. `exceeded`: whether
   !> only the mesh is too short. The fields of `path` remain those of the start. `held`, `in_proportion`, `expected`: see
   !> find_statuses.
   subroutine find_statuses_on_mesh(path, segment, fraction, fields, found, exceeded, held, in_proportion, expected)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      real(wp), intent(in) :: fraction
      type(contact_fields_type), intent(inout) :: fields
      logical, intent(out) :: found, exceeded
      logical, intent(in), optional :: held(:), in_proportion
      integer, intent(in), optional :: expected(:)

      call guess_contact(path, segment, fraction)
      call find_statuses(path, segment, fraction, fields, found, held, in_proportion, expected)
      exceeded = found
      if (found) exceeded = path%model%reaches_end(in_contact(path%state%status))
      found = found .and. .not. exceeded
   end subroutine find_statuses_on_mesh

   !> Lengthen the mesh if it may grow. `grown`: whether it did.
   subroutine grow_mesh(path, grown)
      class(contact_path_type), intent(inout) :: path
      logical, intent(out) :: grown
      type(iteration_type) :: iteration

      grown = path%model%growing .and. path%model%spare_nodes() > 0
      if (grown) call path%widen(iteration)
   end subroutine grow_mesh

   !> A first guess of the contact if there is none.
   subroutine guess_contact(path, segment, fraction)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      real(wp), intent(in) :: fraction
      logical :: contact(size(path%state%status))
      integer :: status(size(path%state%status))

      if (any(in_contact(path%state%status))) return
      call first_guess(path, segment, fraction, contact)
      status = node_frictionless
      if (segment%friction .and. path%model%tangential) status = node_stick
      call path%set_status(contact, status)
   end subroutine guess_contact

   !> The fraction of the segment up to which the bodies are certainly in contact: all of it unless the normal force decreases to
   !> zero, then up to a small rest. (At zero force the pressures of any contact are zero.)
   pure real(wp) function before_separation(segment) result(fraction)
      type(segment_type), intent(in) :: segment
      real(wp), parameter :: little = 1.0e-4_wp

      fraction = 1.0_wp
      if (segment%load(motion_approach)%control /= control_force) return
      associate (start => segment%load(motion_approach)%value, change => segment%load(motion_approach)%rate)
         if (start + change > significant*abs(start) .and. start + change > 0.0_wp) return
         fraction = 0.0_wp
         if (start > 0.0_wp) fraction = (1.0_wp - little)*start/(-change)
      end associate
   end function before_separation

   !> Whether a force other than the normal one acts while the bodies approach without contact, so that nothing balances it yet.
   pure logical function lacks_support(path, segment)
      class(contact_path_type), intent(in) :: path
      type(segment_type), intent(in) :: segment

      lacks_support = .false.
      if (segment%load(motion_approach)%control == control_force .or. any(in_contact(path%state%status))) return
      lacks_support = any(path%model%moves .and. acts(segment%load))

   contains

      elemental logical function acts(load)
         type(load_type), intent(in) :: load

         acts = load%control == control_force .and. max(abs(load%value), abs(load%rate)) > 0.0_wp
      end function acts
   end function lacks_support

   !> The part of a segment from the fraction `begin` to the fraction `end`.
   pure type(segment_type) function subsegment(segment, begin, end) result(fraction)
      type(segment_type), intent(in) :: segment
      real(wp), intent(in) :: begin, end

      fraction = segment
      if (.not. begin > 0.0_wp .and. .not. end < 1.0_wp) return
      fraction%load = load_between(segment%load, begin, end)
      fraction%from = segment%from + (segment%to - segment%from)*begin
      fraction%to = segment%from + (segment%to - segment%from)*end
   end function subsegment

   elemental type(load_type) function load_between(load, begin, end) result(fraction)
      type(load_type), intent(in) :: load
      real(wp), intent(in) :: begin, end

      fraction = load_type(load%control, load%value + begin*load%rate, (end - begin)*load%rate)
   end function load_between

end module mfv_frictionless
