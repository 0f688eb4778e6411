!> Large increments (`stepping='leap'`): load segments in a few implicit steps instead of event by event.
!>
!> In a large increment stuck nodes hold at the slip of its start, and every equality and inequality of dissertation Table 2.1 is
!> satisfied at its end only, with slip counted from start to end (mfv_active_set): backward Euler. An interval is divided into 1,
!> 2, 4, 8, ... equal increments (a chain) until tractions and dissipation change by at most half of `leap_tolerance`: tractions
!> relative to the largest so far, dissipation relative to that of the interval, so that every leg of every cycle meets the
!> tolerance. If nodes slip one way only under constant pressures, one increment is exact (Mindlin).
!>
!> Tractions that depend on the path have an error of first order: a node that touches during an increment holds at an estimate of
!> its slip at first contact, and a node that slips and sticks again within an increment is treated as stuck. Dissipation: see
!> mfv_chain_dissipation.
!>
!> An interval that would take more solves than it has events is applied by events (mfv_first_violation), which are exact; gross
!> sliding and separation are therefore found there. The certificate checks large increments at their ends only.
module mfv_leap
   use mfv_chain_dissipation, only: chain_dissipation, node_wise_dissipation
   use mfv_compliance, only: block_up, block_wt
   use mfv_contact_fields, only: contact_fields_type
   use mfv_contact_path
   use mfv_contact_state, only: contact_state_type
   use mfv_contact_system, only: constraints_type, response_type
   use mfv_error, only: error_type
   use mfv_first_violation, only: apply_by_violations
   use mfv_kinds, only: wp
   use mfv_motions, only: motion_approach, motion_shift, control_force
   use mfv_node_status
   use mfv_observer, only: observer_type
   use mfv_straight, only: apply_directly, before_separation, lacks_support, find_statuses_on_mesh, finish_large_increment, &
                           grow_mesh, subsegment
   implicit none
   private
   public :: apply_by_large_increments

   !> An interval shorter than this fraction of a segment is not divided where no statuses are found.
   real(wp), parameter :: shortest = 0.2_wp
   !> Most increments of an interval.
   integer, parameter :: most_increments = 64
   !> Linear solves of event stepping per change of status. Less than one, since event stepping can update the inverse from solve
   !> to solve, and a large increment cannot.
   real(wp), parameter :: solves_per_change = 0.6_wp
   !> Linear solves of an increment in a long chain.
   real(wp), parameter :: solves_per_increment = 3.0_wp
   !> Allowed difference relative to the tolerance: the error of a chain is about its difference from one with half as many
   !> increments.
   real(wp), parameter :: safety = 0.5_wp

   !> Progress in a segment, as fractions of it: what is done, the goal of large increments, and the length of the next interval.
   !> `by_violations`: whether that interval is applied by events.
   type :: progress_type
      real(wp) :: done = 0.0_wp, goal = 0.0_wp, length = 0.0_wp
      logical :: by_violations = .false.
   end type progress_type

   !> An interval divided into equal increments.
   type :: chain_type
      integer :: increments = 0
      !> States before each increment, with the statuses of that increment; fields after it; shape (increments).
      type(contact_state_type), allocatable :: before(:)
      type(contact_fields_type), allocatable :: after(:)
      !> Friction dissipation of each increment, force/length, shape (nodes, increments).
      real(wp), allocatable :: friction_work(:, :)
      !> Whether the statuses were found; if not, whether only the mesh was too short.
      logical :: found = .false., exceeded = .false.
      !> Linear solves, and changes of status that event stepping would make one by one.
      integer :: solves = 0, changes = 0
      !> Estimated errors of the final tractions, force/length^2, and of the dissipation, force; the dissipation, force, and the
      !> largest traction, force/length^2.
      real(wp) :: traction_error = 0.0_wp, work_error = 0.0_wp, work = 0.0_wp, traction = 0.0_wp
      !> Error of the dissipation due to its corners as a function of the load, one for each change of status; force.
      real(wp) :: corner_error = 0.0_wp
   end type chain_type

contains

   !> Apply the loads of a segment by large increments. `observer` is notified of every interval.
   !> Errors, each with the last admissible state left in place: those of mfv_first_violation.
   subroutine apply_by_large_increments(path, segment, observer, error)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      class(observer_type), intent(inout), optional :: observer
      type(error_type), allocatable, intent(out) :: error
      type(progress_type) :: progress

      if (.not. (segment%friction .and. path%model%scene%friction%acts())) then
         call apply_directly(path, segment, observer, error)
         return
      end if
      call path%start_segment(segment, error)
      if (allocated(error)) return
      if (.not. lacks_support(path, segment)) progress%goal = before_separation(segment)
      progress%length = progress%goal
      do while (progress%done < progress%goal)
         if (progress%by_violations) then
            call continue_by_violations(path, segment, progress, observer, error)
         else
            call try_large_increments(path, segment, progress, observer, error)
         end if
         if (allocated(error)) return
      end do
      if (progress%goal < 1.0_wp) call apply_by_violations(path, subsegment(segment, progress%goal, 1.0_wp), observer, error)
   end subroutine apply_by_large_increments

   !> Try the next interval. If it is not accurate, it is shortened or applied by events (`progress%by_violations`).
   subroutine try_large_increments(path, segment, progress, observer, error)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      type(progress_type), intent(inout) :: progress
      class(observer_type), intent(inout), optional :: observer
      type(error_type), allocatable, intent(out) :: error
      type(chain_type) :: chain
      logical :: accepted, grown

      associate (done => progress%done, goal => progress%goal, length => progress%length)
         call refine(path, segment, done, length, chain, accepted)
         if (chain%exceeded) then
            call grow_mesh(path, grown)
            if (grown) return
         end if
         if (accepted) then
            call accept_chain(path, chain)
            done = merge(goal, done + length, length >= goal - done)
            length = goal - done
            call finish_large_increment(path, segment, done, observer, error)
         else if (.not. chain%found .and. chain%solves < path%state%contact_nodes() .and. length > shortest) then
            length = 0.5_wp*length
         else
            progress%by_violations = .true.
         end if
      end associate
   end subroutine try_large_increments

   !> Apply the next interval by events.
   subroutine continue_by_violations(path, segment, progress, observer, error)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      type(progress_type), intent(inout) :: progress
      class(observer_type), intent(inout), optional :: observer
      type(error_type), allocatable, intent(out) :: error

      associate (done => progress%done, goal => progress%goal, length => progress%length)
         call apply_by_violations(path, subsegment(segment, done, done + length), observer, error)
         if (allocated(error)) return
         progress%by_violations = .false.
         done = merge(goal, done + length, length >= goal - done)
         length = goal - done
      end associate
   end subroutine continue_by_violations

   !> The interval of the given `length` from the fraction `done` of the segment, in chains of more and more increments.
   !> `accepted`: whether one is accurate with fewer solves than event stepping; `chain`: that one, or the last. `path` is
   !> unchanged.
   subroutine refine(path, segment, done, length, chain, accepted)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      real(wp), intent(in) :: done, length
      type(chain_type), intent(out) :: chain
      logical, intent(out) :: accepted
      type(chain_type) :: finer
      integer :: increments

      accepted = .false.
      call make_chain(path, segment, done, length, 1, chain)
      if (.not. chain%found) return
      accepted = is_path_independent(path, segment, chain%after(1))
      if (accepted) return
      increments = 2
      do
         call make_chain(path, segment, done, length, increments, finer, chain)
         if (finer%found) call compare(path, chain, finer)
         chain = finer
         if (.not. chain%found) return
         call choose(path%model%scene%method%leap_tolerance, max(path%certificate%traction_scale(), chain%traction), chain, &
                     accepted, increments)
         if (accepted) accepted = .not. slips_back(path, subsegment(segment, done, done + length), chain)
         if (accepted .or. increments == 0) return
      end do
   end subroutine refine

   !> Whether a chain meets the tolerance; if not, the number of increments of the next one, 0: too many. `traction`: the largest
   !> so far.
   pure subroutine choose(tolerance, traction, chain, accepted, increments)
      real(wp), intent(in) :: tolerance, traction
      type(chain_type), intent(in) :: chain
      logical, intent(out) :: accepted
      integer, intent(out) :: increments
      real(wp) :: by_tractions, by_work, by_corners, wanted

      by_tractions = 0.0_wp
      by_work = 0.0_wp
      if (traction > 0.0_wp) by_tractions = chain%traction_error/(safety*tolerance*traction)
      by_corners = 0.0_wp
      if (chain%work_error > 0.0_wp) then
         by_work = chain%work_error/(safety*tolerance*max(chain%work, tiny(1.0_wp)/tolerance))
         by_corners = chain%corner_error/(safety*tolerance*max(chain%work, tiny(1.0_wp)/tolerance))
      end if
      accepted = max(by_tractions, by_work) <= 1.0_wp
      increments = 0
      if (accepted) return
      wanted = min(max(2.0_wp, by_tractions, sqrt(sqrt(by_work)), sqrt(by_corners)), real(most_increments, wp))
      increments = chain%increments*2**ceiling(log(wanted)/log(2.0_wp) - 1.0e-6_wp)
      if (increments > most_increments .or. solves_per_increment*increments > solves_per_change*chain%changes) increments = 0
   end subroutine choose

   !> Whether nodes that slip in the last increment would slip back at its end: they have stuck within the increment, which no
   !> chain resolves. This does not occur under constant pressures.
   logical function slips_back(path, segment, chain)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      type(chain_type), intent(in) :: chain
      real(wp), parameter :: negligible = 1.0e-9_wp
      type(contact_state_type) :: start
      type(constraints_type) :: constraints
      type(response_type) :: response

      associate (last => chain%after(chain%increments), begin => chain%before(1)%fields)
         slips_back = maxval(abs(last%pressure - begin%pressure)) > max(negligible, path%system%tolerance)*chain%traction
         if (.not. slips_back) return
         start = path%state
         path%state = chain%before(chain%increments)
         path%state%fields = last
         call path%loads_at(segment, 1.0_wp, constraints)
         call path%set_rows(constraints, .false.)
         call path%system%solve(path%model, constraints, last, response, slips_back)
         associate (rate => response%rate%slip())
            if (.not. slips_back) &
               slips_back = any(-slip_sign(path%state%status)*rate > max(negligible, path%system%tolerance)*maxval(abs(rate)))
         end associate
         path%state = start
      end associate
   end function slips_back

   !> An interval in a number of equal `increments`. `coarser`: a chain of the same interval, for a first guess of the statuses.
   !> `path` is unchanged.
   subroutine make_chain(path, segment, done, length, increments, chain, coarser)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      real(wp), intent(in) :: done, length
      integer, intent(in) :: increments
      type(chain_type), intent(out) :: chain
      type(chain_type), intent(in), optional :: coarser
      type(contact_state_type) :: start
      integer, allocatable :: status(:)
      integer :: i

      start = path%state
      chain%increments = increments
      allocate (chain%before(increments), chain%after(increments))
      allocate (chain%friction_work(size(start%status), increments), source=0.0_wp)
      chain%solves = -path%system%solves
      do i = 1, increments
         status = path%state%status
         if (i == 1) call guess_slip(path, segment, done + length*reached(i))
         if (present(coarser)) call guess_from(path, coarser, i, increments)
         call find_statuses_on_mesh(path, segment, done + length*reached(i), chain%after(i), chain%found, chain%exceeded)
         if (.not. chain%found) exit
         chain%changes = chain%changes + count_changes(status, path%state%status)
         chain%before(i) = path%state
         path%state%fields = chain%after(i)
         chain%traction = max(chain%traction, maxval(abs(chain%after(i)%pressure)), maxval(abs(chain%after(i)%shear)))
      end do
      chain%solves = chain%solves + path%system%solves
      path%state = start

   contains

      !> Fraction of the interval after i increments. If contact begins, increments are even in the contact width, which for a
      !> parabola grows with the square root of the load.
      pure real(wp) function reached(i)
         integer, intent(in) :: i

         reached = real(i, wp)/real(increments, wp)
         if (.not. any(in_contact(start%status))) reached = reached**2
      end function reached
   end subroutine make_chain

   !> If increment `i` ends where one of a coarser chain does, start from the statuses there.
   subroutine guess_from(path, coarser, i, increments)
      class(contact_path_type), intent(inout) :: path
      type(chain_type), intent(in) :: coarser
      integer, intent(in) :: i, increments

      if (mod(i*coarser%increments, increments) /= 0) return
      associate (status => coarser%before(i*coarser%increments/increments)%status)
         call path%set_status(in_contact(path%state%status) .and. in_contact(status), status)
      end associate
   end subroutine guess_from

   !> Number of nodes that change their status one by one (at a reversal of the load all slipping nodes stick at once).
   pure integer function count_changes(before, after)
      integer, intent(in) :: before(:), after(:)

      count_changes = count(before /= after .and. .not. (slips(before) .and. after == node_stick))
   end function count_changes

   !> Errors of the finer of two chains: tractions at first order, dissipation by mfv_chain_dissipation, which is distributed over
   !> the nodes.
   subroutine compare(path, coarser, finer)
      class(contact_path_type), intent(in) :: path
      type(chain_type), intent(in) :: coarser
      type(chain_type), intent(inout) :: finer
      real(wp) :: refinement, node_wise, node_wise_error, one, other, unused, unused_too
      integer :: i, stride

      refinement = 1.0_wp/(sqrt(real(finer%increments, wp)/real(coarser%increments, wp)) - 1.0_wp)
      associate (a => coarser%after(coarser%increments), b => finer%after(finer%increments))
         finer%traction_error = refinement*max(maxval(abs(a%pressure - b%pressure)), maxval(abs(a%shear - b%shear)))
      end associate
      node_wise = 0.0_wp
      node_wise_error = 0.0_wp
      do i = 1, finer%increments
         call node_wise_dissipation(path%model, finer%before(i), finer%after(i), path%system%tolerance, finer%friction_work(:, i), &
                                    unused)
         node_wise = node_wise + path%model%force(finer%friction_work(:, i))
         node_wise_error = node_wise_error + unused
      end do
      call chain_dissipation(path%model, finer%before(1)%fields, finer%after, finer%changes, finer%work, finer%work_error, &
                             finer%corner_error)
      if (node_wise_error <= finer%work_error .or. .not. node_wise > 0.0_wp) then
         finer%work = node_wise
         finer%work_error = node_wise_error
      else
         ! Three states can agree with a straight line by chance; then the two formulas must agree as well.
         if (finer%increments == 2) finer%work_error = max(finer%work_error, abs(finer%work - node_wise))
         stride = finer%increments/coarser%increments
         ! The same formula for both chains: the error due to the path.
         call chain_dissipation(path%model, finer%before(1)%fields, coarser%after, 1, one, unused, unused_too)
         call chain_dissipation(path%model, finer%before(1)%fields, &
                                finer%after(stride::stride), 1, other, unused, unused_too)
         finer%work_error = max(finer%work_error, finer%corner_error) + refinement*abs(one - other)
         finer%work = max(finer%work, 0.0_wp)
         finer%friction_work = finer%friction_work*(finer%work/node_wise)
      end if
   end subroutine compare

   !> A first guess of the slipping nodes at a fraction of the segment: they slip in the direction of the tangential load. Under
   !> constant pressures and tangential force control their number is that of Mindlin's contact of cylinders: the edge of the stick
   !> zone is where the pressure is sqrt(Q/(mu P)) of the largest; after a reversal, with half the change in place of Q.
   subroutine guess_slip(path, segment, fraction)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      real(wp), intent(in) :: fraction
      integer, dimension(size(path%state%status)) :: status
      real(wp) :: force, sliding_limit
      logical :: reverses

      if (.not. abs(segment%load(motion_shift)%rate) > 0.0_wp) return
      status = merge(node_slip_left, node_slip_right, segment%load(motion_shift)%rate > 0.0_wp)
      reverses = any(slips(path%state%status) .and. path%state%status /= status)
      associate (fields => path%state%fields, load => segment%load(motion_shift))
         sliding_limit = path%model%force(path%model%static_friction*fields%pressure)
         if (load%control /= control_force .or. abs(segment%load(motion_approach)%rate) > 0.0_wp .or. &
             .not. sliding_limit > 0.0_wp .or. path%model%compliance%has_block(block_wt)) then
            call path%set_status(slips(path%state%status), status)
            return
         end if
         force = load%value + fraction*load%rate
         if (reverses) force = 0.5_wp*(force - fields%force(motion_shift))
         force = max(sign(1.0_wp, load%rate)*force, 0.0_wp)
         where (fields%pressure > sqrt(force/sliding_limit)*maxval(fields%pressure)) status = node_stick
      end associate
      call path%set_status(in_contact(path%state%status), status)
   end subroutine guess_slip

   !> Whether an increment to the fields `after` is pure pressing without coupling, tangential load or shear, which does not depend
   !> on the path.
   logical function is_path_independent(path, segment, after)
      class(contact_path_type), intent(in) :: path
      type(segment_type), intent(in) :: segment
      type(contact_fields_type), intent(in) :: after
      real(wp), parameter :: nothing = 1.0e-14_wp

      associate (compliance => path%model%compliance, model => path%model)
         is_path_independent = .not. (compliance%has_block(block_up) .or. compliance%has_block(block_wt) .or. &
                                      model%has_rigid_parts())
      end associate
      if (.not. is_path_independent) return
      is_path_independent = .not. abs(segment%load(motion_shift)%rate) > 0.0_wp .and. .not. any(slips(path%state%status)) .and. &
                            max(maxval(abs(path%state%fields%shear)), maxval(abs(after%shear))) &
                          <= max(nothing, path%system%tolerance)*max(path%certificate%traction_scale(), maxval(abs(after%pressure)))
   end function is_path_independent

   !> Accept the increments of a chain.
   subroutine accept_chain(path, chain)
      class(contact_path_type), intent(inout) :: path
      type(chain_type), intent(in) :: chain
      integer :: i

      do i = 1, chain%increments
         path%state%status = chain%before(i)%status
         path%state%stuck_slip = chain%before(i)%stuck_slip
         call path%take_increment(chain%after(i), chain%after(i)%slip() - path%state%fields%slip(), 0.0_wp, &
                                  friction_work=chain%friction_work(:, i))
      end do
      call path%certificate%note_large_increment(chain%traction_error, chain%work_error, chain%work)
   end subroutine accept_chain

end module mfv_leap
