!> Leaps: a part of the load history at once, as an integrator would take it.
!>
!> A leap holds stuck nodes at the slip that they have at its start, and asks at its end alone that every equality and
!> inequality of dissertation Table 2.1 holds, slip counted from start to end (mfv_active_set). Two leaps of half the length go
!> the same way again; where they end with the same tractions, and have dissipated the same, to a part `leap_tolerance` of the
!> largest, they are taken, else the leap is shortened. Where nodes slip one way only under constant pressures, no way matters
!> and one leap is exact (Mindlin). Where it matters, a node that touches on the way holds at about the slip that it then had,
!> and a node that slips and sticks again on the way is taken never to have slipped: errors that fall with the length, which
!> the tolerance bounds leap by leap, not in sum.
!>
!> What leaps cannot settle, however short, goes by events (mfv_first_violation) for as long: so gross sliding, separation and
!> the like end as they do there. Of leaps the certificate checks the ends.
module mfv_leap
   use mfv_compliance, only: block_up, block_wt
   use mfv_contact_fields, only: contact_fields_type
   use mfv_contact_model, only: contact_model_type
   use mfv_contact_path
   use mfv_contact_state, only: contact_state_type
   use mfv_error, only: error_type
   use mfv_first_violation, only: lead_by_violations
   use mfv_kinds, only: wp
   use mfv_march, only: march_type
   use mfv_node_status
   use mfv_observer, only: observer_type
   use mfv_scene, only: control_force
   use mfv_straight, only: before_separation, carries_nothing_yet, close_leap, grow_mesh, lead_straight, part_of, settle_on_mesh
   implicit none
   private
   public :: lead_by_leaps

   !> The shortest leap, in parts of a segment; and by how much the next may be longer or shorter than this one.
   real(wp), parameter :: shortest = 1.0e-4_wp, most_growth = 8.0_wp, least_shrink = 0.125_wp, most_shrink = 0.5_wp, &
                          safety = 0.7_wp

   !> A leap and its two halves, or the leap alone where it is exact.
   type :: leap_type
      !> State before each part, with the statuses on the way through it; and fields after it; parts.
      type(contact_state_type) :: state(2)
      type(contact_fields_type) :: after(2)
      !> What friction dissipates in each part, force/length, shape (nodes, 2).
      real(wp), allocatable :: friction_work(:, :)
      integer :: parts = 0
      !> Whether the statuses were found, or at least the mesh was too short for them.
      logical :: settled = .false., exceeded = .false.
      !> Largest difference of the tractions at the end between the leap and its halves, and the largest of them,
      !> force/length^2; the same of what friction dissipates.
      real(wp) :: difference = 0.0_wp, traction = 0.0_wp, work_difference = 0.0_wp, work = 0.0_wp
   end type leap_type

contains

   !> Lead the loads along one segment by leaps. `observer` is told of every leap, and can have a pause there.
   !> Errors, each leaving the last admissible state in place: those of mfv_first_violation.
   subroutine lead_by_leaps(path, segment, march, observer, error)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      type(march_type), intent(inout) :: march
      class(observer_type), intent(inout), optional :: observer
      type(error_type), allocatable, intent(out) :: error
      real(wp) :: goal

      if (.not. (segment%friction .and. path%model%scene%friction%acts())) then
         call lead_straight(path, segment, march, observer, error)
         return
      end if
      if (.not. march%paused) then
         call path%start_segment(segment, error)
         if (allocated(error)) return
         march%part = 0.0_wp
         march%by_violations = .false.
         march%goal = before_separation(segment)
         if (carries_nothing_yet(path, segment)) march%goal = 0.0_wp
         march%length = march%goal
         march%violations_length = shortest
         march%traction = path%certificate%traction_scale()
         march%work = path%state%dissipation
      else if (march%part < march%goal .and. .not. march%by_violations) then
         march%paused = .false.
      end if
      goal = march%goal
      do while (march%part < goal)
         if (march%by_violations) then
            call go_by_violations(path, segment, march, observer, error)
         else
            call leap_on(path, segment, march, observer, error)
         end if
         if (allocated(error) .or. march%paused) return
      end do
      if (goal < 1.0_wp) call lead_by_violations(path, part_of(segment, goal, 1.0_wp), march, observer, error)
   end subroutine lead_by_leaps

   !> Try a leap, and take it where it is right; else the next is shorter, or violations lead on (`march%by_violations`).
   subroutine leap_on(path, segment, march, observer, error)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      type(march_type), intent(inout) :: march
      class(observer_type), intent(inout), optional :: observer
      type(error_type), allocatable, intent(out) :: error
      type(leap_type) :: leap
      real(wp) :: error_ratio
      logical :: accepted, grown

      associate (done => march%part, goal => march%goal, length => march%length)
         if (length >= (1.0_wp - shortest)*(goal - done)) length = goal - done
         call try_leap(path, segment, done, length, leap)
         march%traction = max(march%traction, leap%traction)
         march%work = max(march%work, path%state%dissipation + leap%work)
         if (leap%exceeded) then
            call grow_mesh(path, grown)
            if (grown) return
         end if
         error_ratio = ratio(leap, path%model%scene%method%leap_tolerance, march%traction, march%work)
         accepted = leap%settled .and. error_ratio <= 1.0_wp
         march%factor = change(leap%settled, accepted, error_ratio)
         if (accepted) then
            call take(path, leap)
            done = merge(goal, done + length, length >= goal - done)
            march%violations_length = shortest
            call close_leap(path, segment, done, observer, error)
            if (allocated(error)) return
            if (present(observer)) march%paused = observer%pause_wanted .and. done < goal
         else if (length <= shortest) then
            length = min(march%violations_length, goal - done)
            march%by_violations = .true.
            return
         end if
         length = max(length*march%factor, shortest)
      end associate
   end subroutine leap_on

   !> Go by violations where leaps do not lead on.
   subroutine go_by_violations(path, segment, march, observer, error)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      type(march_type), intent(inout) :: march
      class(observer_type), intent(inout), optional :: observer
      type(error_type), allocatable, intent(out) :: error

      associate (done => march%part, goal => march%goal, length => march%length)
         call lead_by_violations(path, part_of(segment, done, done + length), march, observer, error)
         if (allocated(error) .or. march%paused) return
         march%by_violations = .false.
         done = merge(goal, done + length, length >= goal - done)
         march%violations_length = 2.0_wp*march%violations_length
         length = max(length*march%factor, shortest)
      end associate
   end subroutine go_by_violations

   !> By how much a leap errs, in parts of what it may: tractions of the largest so far, dissipation of that so far.
   pure real(wp) function ratio(leap, tolerance, traction, work)
      type(leap_type), intent(in) :: leap
      real(wp), intent(in) :: tolerance, traction, work

      ratio = 0.0_wp
      if (traction > 0.0_wp) ratio = leap%difference/(tolerance*traction)
      if (work > 0.0_wp) ratio = max(ratio, leap%work_difference/(tolerance*work))
   end function ratio

   !> By which factor the next leap is longer than this one, as for an integrator of first order.
   pure real(wp) function change(settled, accepted, error_ratio)
      logical, intent(in) :: settled, accepted
      real(wp), intent(in) :: error_ratio

      change = merge(most_growth, most_shrink, settled)
      if (settled .and. error_ratio > 0.0_wp) change = safety/sqrt(error_ratio)
      if (accepted) then
         change = min(max(change, 1.0_wp), most_growth)
      else
         change = max(min(change, most_shrink), least_shrink)
      end if
   end function change

   !> Leap from the part `done` of the segment as far as `length`, at once and in halves. `path` stays as it is.
   subroutine try_leap(path, segment, done, length, leap)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      real(wp), intent(in) :: done, length
      type(leap_type), intent(out) :: leap
      type(contact_state_type) :: start
      type(contact_fields_type) :: whole
      integer :: status(size(path%state%status))

      start = path%state
      allocate (leap%friction_work(size(path%state%status), 2), source=0.0_wp)
      call guess_slip(path, segment, done + length)
      call settle_on_mesh(path, segment, done + length, whole, leap%settled, leap%exceeded)
      status = path%state%status
      if (leap%settled) then
         leap%traction = max(maxval(abs(whole%pressure)), maxval(abs(whole%shear)))
         leap%friction_work(:, 1) = friction_work(path%model, path%state, whole, path%system%noise)
         leap%work = path%model%force(leap%friction_work(:, 1))
         if (moves_nothing(path, segment, whole)) then
            leap%parts = 1
            leap%state(1) = path%state
            leap%after(1) = whole
         else
            path%state = start
            call halve(path, segment, done, length, status, leap)
            if (leap%settled) then
               leap%difference = max(maxval(abs(leap%after(2)%pressure - whole%pressure)), &
                                     maxval(abs(leap%after(2)%shear - whole%shear)))
               leap%work_difference = abs(path%model%force(leap%friction_work(:, 1)) &
                                           + path%model%force(leap%friction_work(:, 2)) - leap%work)
            end if
         end if
      end if
      path%state = start
   end subroutine try_leap

   !> The two halves of a leap that ended with the statuses `status`, shape (nodes).
   subroutine halve(path, segment, done, length, status, leap)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      real(wp), intent(in) :: done, length
      integer, intent(in) :: status(:)
      type(leap_type), intent(inout) :: leap
      real(wp), parameter :: half = 0.5_wp

      leap%parts = 2
      call guess_slip(path, segment, done + half*length)
      call settle_on_mesh(path, segment, done + half*length, leap%after(1), leap%settled, leap%exceeded)
      if (.not. leap%settled) return
      leap%state(1) = path%state
      leap%friction_work(:, 1) = friction_work(path%model, path%state, leap%after(1), path%system%noise)
      path%state%fields = leap%after(1)
      call path%set_status(in_contact(path%state%status), status)
      call settle_on_mesh(path, segment, done + length, leap%after(2), leap%settled, leap%exceeded)
      leap%state(2) = path%state
      if (leap%settled) leap%friction_work(:, 2) = friction_work(path%model, path%state, leap%after(2), path%system%noise)
   end subroutine halve

   !> A first guess of who slips at the part `part` of the segment: where the tangential load changes, nodes slip with it.
   !> Where the normal load does not change, nor the pressures with it, and the tangential force does, as many as slip in
   !> Mindlin's contact of cylinders: the edge of the stick zone is there where the pressure is sqrt(Q/(mu P)) of the largest;
   !> after a reversal with half the change in place of Q.
   subroutine guess_slip(path, segment, part)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      real(wp), intent(in) :: part
      integer, dimension(size(path%state%status)) :: status
      real(wp) :: force, grip
      logical :: reverses

      if (.not. abs(segment%tangential%rate) > 0.0_wp) return
      status = merge(node_slip_left, node_slip_right, segment%tangential%rate > 0.0_wp)
      reverses = any(slips(path%state%status) .and. path%state%status /= status)
      associate (fields => path%state%fields, load => segment%tangential)
         grip = path%model%force(path%model%static_friction*fields%pressure)
         if (load%control /= control_force .or. abs(segment%normal%rate) > 0.0_wp .or. .not. grip > 0.0_wp .or. &
             path%model%compliance%has_block(block_wt)) then
            call path%set_status(slips(path%state%status), status)
            return
         end if
         force = load%value + part*load%rate
         if (reverses) force = 0.5_wp*(force - fields%tangential_force)
         force = max(sign(1.0_wp, load%rate)*force, 0.0_wp)
         where (fields%pressure > sqrt(force/grip)*maxval(fields%pressure)) status = node_stick
      end associate
      call path%set_status(in_contact(path%state%status), status)
   end subroutine guess_slip

   !> Whether pressing without coupling, tangential load or shear is all that a leap to the fields `after` does: no way matters.
   logical function moves_nothing(path, segment, after)
      class(contact_path_type), intent(in) :: path
      type(segment_type), intent(in) :: segment
      type(contact_fields_type), intent(in) :: after
      real(wp), parameter :: nothing = 1.0e-14_wp

      associate (compliance => path%model%compliance, model => path%model)
         moves_nothing = .not. (compliance%has_block(block_up) .or. compliance%has_block(block_wt) .or. &
                                model%rotational .or. model%scene%mesh%radial)
      end associate
      if (.not. moves_nothing) return
      moves_nothing = .not. abs(segment%tangential%rate) > 0.0_wp .and. .not. any(slips(path%state%status)) .and. &
                      max(maxval(abs(path%state%fields%shear)), maxval(abs(after%shear))) &
                      <= max(nothing, path%system%noise)*max(path%certificate%traction_scale(), maxval(abs(after%pressure)))
   end function moves_nothing

   !> Go where the leap led.
   subroutine take(path, leap)
      class(contact_path_type), intent(inout) :: path
      type(leap_type), intent(in) :: leap
      integer :: i

      do i = 1, leap%parts
         path%state%status = leap%state(i)%status
         path%state%stuck_slip = leap%state(i)%stuck_slip
         call path%take_increment(leap%after(i), leap%after(i)%slip() - path%state%fields%slip(), 0.0_wp, &
                                  friction_work=leap%friction_work(:, i))
      end do
   end subroutine take

   !> What friction dissipates on the way from `before`, which has the statuses on the way, to the fields `after`, force/length,
   !> shape (nodes). Nodes that slip already at the start do so with tractions from those then to those after: the trapezoid.
   !> Others begin to slip on the way, half way on the average; and nodes that part do so half way on the average. With
   !> constant pressures this is exact, else of second order in the length of the leap. `noise`: the linear solver's.
   pure function friction_work(model, before, after, noise) result(work)
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: before
      type(contact_fields_type), intent(in) :: after
      real(wp), intent(in) :: noise
      real(wp), parameter :: at_limit = 1.0e-9_wp, noises = 100.0_wp
      real(wp), dimension(size(before%status)) :: work
      real(wp), dimension(size(before%status)) :: slipped, limit
      logical :: on(size(work))

      slipped = after%slip() - before%stuck_slip
      limit = model%static_friction*before%fields%pressure
      on = slips(before%status) .and. -before%fields%shear*slip_sign(before%status) &
           >= limit*(1.0_wp - max(at_limit, noises*noise))
      where (on)
         work = -0.5_wp*(before%fields%shear + after%shear)*slipped
      elsewhere (slips(before%status))
         work = (0.75_wp*abs(after%shear) + 0.25_wp*limit)*abs(slipped)
      elsewhere (.not. in_contact(before%status))
         work = max(-0.25_wp*before%fields%shear*slipped, 0.0_wp)
      elsewhere
         work = 0.0_wp
      end where
   end function friction_work

end module mfv_leap
