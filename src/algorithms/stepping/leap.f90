!> Large increments (`stepping='leap'`): load segments in a few implicit steps instead of event by event.
!>
!> In a large increment every equality and inequality of dissertation Table 2.1 is satisfied at its end only (mfv_active_set). The
!> slip of nodes that stick within it follows from the edges of the stick zones (mfv_sticking_front). An interval is divided into 1,
!> 2, 4, 8, ... equal increments (a chain) until the estimated errors of tractions and dissipation are within `accuracy`: tractions
!> relative to the largest so far, dissipation relative to that of the interval, so that every leg of every cycle meets the
!> tolerance. If nodes slip one way only under constant pressures, one increment is exact (Mindlin).
!>
!> Where it is not known which nodes hold from the start, tractions that depend on the path have an error of first order: a node
!> that touches during an increment holds at an estimate of its slip at first contact, and a node that slips and sticks again within
!> an increment is treated as stuck. Dissipation: see mfv_chain_dissipation.
!>
!> An interval that would take more solves than it has events is applied by events (mfv_first_violation), which are exact; gross
!> sliding and separation are therefore found there. The certificate checks large increments at their ends only.
module mfv_leap
   use mfv_active_set, only: find_rates, slipping_back
   use mfv_chain_dissipation, only: chain_dissipation, dissipation_by_rates, node_wise_dissipation
   use mfv_compliance, only: block_up, block_wt
   use mfv_contact_fields, only: contact_fields_type
   use mfv_contact_path
   use mfv_contact_state, only: contact_state_type
   use mfv_error, only: error_type
   use mfv_first_violation, only: apply_by_violations
   use mfv_kinds, only: wp
   use mfv_motions, only: motion_count, motion_approach, motion_shift, control_force
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
   !> Where contact begins, event stepping resolves the touching of single nodes. The shear tractions next to that point, or next to
   !> the edge of a contact without slip zones, differ by up to this, relative to the largest traction, over the number of nodes in
   !> contact (0.05 to 0.5 with 50 to 800 nodes in contact, nu from 0 to 0.4 and mu from 0.3 to 1.5); next to a slip zone of fewer
   !> than `resolved` nodes by up to `error_unresolved`.
   integer, parameter :: resolved = 3
   real(wp), parameter :: error_unresolved = 10.0_wp
   real(wp), parameter :: error_at_start = 0.5_wp
   !> The same where nodes touch later under a changing normal load, and where fewer than `resolved` nodes slip at an edge: the
   !> outermost node may have closed and stuck or not (up to 1.5 with 80 to 400 nodes). Under a constant one, contact grows where it
   !> slips.
   real(wp), parameter :: error_of_growth = 1.5_wp
   !> Allowed part of the tolerance for errors of tractions by the path, which can be twice as large as estimated.
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
      !> Whether contact begins in the interval, and whether the nodes that hold from its start are known.
      logical :: begins = .false., fronts = .false.
      !> Nodes that hold from the start of the last increment, if known, shape (nodes).
      logical, allocatable :: held(:)
      !> Linear solves, and changes of status that event stepping would make one by one.
      integer :: solves = 0, changes = 0
      !> Estimated errors of the final tractions, and their part where contact begins, force/length^2; of the dissipation, force;
      !> the dissipation, force, and the largest traction, force/length^2.
      real(wp) :: traction_error = 0.0_wp, start_error = 0.0_wp, work_error = 0.0_wp, work = 0.0_wp, traction = 0.0_wp
      !> The dissipation by node_wise_dissipation and its estimated error, force.
      real(wp) :: node_wise = 0.0_wp, node_wise_error = 0.0_wp
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
         if (accepted .and. path%system%allowed > 0.0_wp) call finish_chain(path, segment, done + length, chain, accepted)
         path%system%allowed = 0.0_wp
         path%system%allowed_in_rates = 0.0_wp
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
      logical, allocatable :: held(:)
      integer :: increments

      accepted = .false.
      if (may_depend_on_path(path, segment)) call find_held(path, subsegment(segment, done, done + length), held)
      call allow_errors(path)
      call make_chain(path, segment, done, length, 1, held, chain)
      if (.not. chain%found) return
      accepted = .not. (may_depend_on_path(path, segment) .or. any(slips(chain%before(1)%status)) .or. &
                        has_shear(path, chain%after(1)))
      if (accepted .or. chain%start_error > path%model%scene%method%accuracy &
          *max(path%certificate%traction_scale(), chain%traction)) return
      increments = 2
      do
         call make_chain(path, segment, done, length, increments, held, finer, chain)
         if (finer%found) call compare(path, subsegment(segment, done, done + length), chain, finer)
         chain = finer
         if (.not. chain%found) return
         call choose(path, chain, accepted, increments)
         if (accepted .and. .not. chain%fronts) accepted = .not. slips_back(path, subsegment(segment, done, done + length), chain)
         if (accepted .or. increments == 0) return
      end do
   end subroutine refine

   !> Allow errors of iterative solvers that are negligible beside that of a chain: of the rates, only signs and corrections of
   !> slips are used. Without coupling this would save nothing: the preconditioner is exact.
   subroutine allow_errors(path)
      class(contact_path_type), intent(inout) :: path
      real(wp), parameter :: negligible = 1.0e-5_wp, most = 1.0e-7_wp, in_rates = 1.0e-2_wp

      if (.not. (path%model%compliance%has_block(block_up) .and. path%model%compliance%has_block(block_wt))) return
      associate (accuracy => path%model%scene%method%accuracy)
         path%system%allowed = min(negligible*accuracy, most)
         path%system%allowed_in_rates = in_rates*accuracy
      end associate
   end subroutine allow_errors

   !> Solve for the end of a chain without the error allowed so far, which later events and statuses would depend on. `last`: the
   !> fraction of the segment there.
   subroutine finish_chain(path, segment, last, chain, found)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      real(wp), intent(in) :: last
      type(chain_type), intent(inout) :: chain
      logical, intent(out) :: found
      type(contact_state_type) :: start

      start = path%state
      path%system%allowed = 0.0_wp
      path%state = chain%before(chain%increments)
      call find_statuses_on_mesh(path, segment, last, chain%after(chain%increments), found, chain%exceeded, chain%held)
      chain%found = found
      chain%before(chain%increments)%status = path%state%status
      chain%before(chain%increments)%stuck_slip = path%state%stuck_slip
      path%state = start
   end subroutine finish_chain

   !> Whether a chain meets the tolerance; if not, the number of increments of the next one, 0: too many.
   subroutine choose(path, chain, accepted, increments)
      class(contact_path_type), intent(in) :: path
      type(chain_type), intent(in) :: chain
      logical, intent(out) :: accepted
      integer, intent(out) :: increments
      real(wp) :: accuracy, traction, work, by_tractions, by_work, wanted

      accuracy = path%model%scene%method%accuracy
      traction = max(path%certificate%traction_scale(), chain%traction)
      work = reference_work(path, chain)
      by_tractions = 0.0_wp
      by_work = 0.0_wp
      if (traction > 0.0_wp) &
         by_tractions = ((chain%traction_error - chain%start_error)/safety + chain%start_error)/(accuracy*traction)
      if (chain%work_error > 0.0_wp) by_work = chain%work_error/max(accuracy*work, tiny(1.0_wp))
      accepted = max(by_tractions, by_work) <= 1.0_wp
      increments = 0
      if (accepted) return
      wanted = min(max(2.0_wp, merge(1.0_wp, by_tractions, chain%fronts), by_work**merge(0.25_wp, 0.5_wp, chain%begins)), &
                   real(most_increments, wp))
      increments = chain%increments*2**ceiling(log(wanted)/log(2.0_wp) - 1.0e-6_wp)
      if (increments > most_increments .or. &
          (real(chain%solves, wp)*increments)/chain%increments > solves_per_change*chain%changes) increments = 0
   end subroutine choose

   !> Whether nodes that slip in the last increment would slip back at its end: they have stuck within the increment, which no
   !> chain resolves. This does not occur under constant pressures.
   logical function slips_back(path, segment, chain)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      type(chain_type), intent(in) :: chain
      real(wp), parameter :: negligible = 1.0e-9_wp
      type(contact_fields_type) :: rates
      logical :: found

      associate (last => chain%after(chain%increments), begin => chain%before(1)%fields)
         slips_back = maxval(abs(last%pressure - begin%pressure)) > max(negligible, path%system%tolerance)*chain%traction
         if (.not. slips_back) return
         call find_rates_after(path, segment, chain, chain%increments, rates, found)
         if (found) slips_back = any(slipping_back(path, chain%before(chain%increments)%status, rates))
      end associate
   end function slips_back

   !> The work that the error of the dissipation of a chain is compared with, force: the dissipation. If contact begins, that is
   !> often next to nothing: then at least a fraction of (mu P)^2/m, m the contact modulus.
   pure real(wp) function reference_work(path, chain) result(work)
      class(contact_path_type), intent(in) :: path
      type(chain_type), intent(in) :: chain
      real(wp), parameter :: fraction = 1.0e-4_wp

      work = chain%work
      if (chain%begins) work = max(work, fraction/path%model%compliance%modulus &
                                   *path%model%force(path%model%static_friction*chain%after(chain%increments)%pressure)**2)
   end function reference_work

   !> Nodes that hold at the start of an interval, shape (nodes): those that stick as the loads begin to change. Not allocated if
   !> these are not found.
   subroutine find_held(path, segment, held)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      logical, allocatable, intent(out) :: held(:)
      integer, parameter :: most_passes = 20
      type(contact_state_type) :: start
      type(contact_fields_type) :: rates
      integer :: pass, wanted(size(path%state%status))
      logical :: determined, found

      if (has_constant_pressures(path, segment)) return
      start = path%state
      found = .not. any(in_contact(path%state%status))
      do pass = 1, most_passes
         if (found) exit
         if (.not. any(holds(path%state%status))) &
            call path%set_status(in_contact(path%state%status), spread(node_stick, 1, size(wanted)))
         call find_rates(path, segment, 0.0_wp, path%state%fields, rates, determined)
         if (.not. determined) exit
         call find_moving(path, rates, wanted)
         found = all(wanted == path%state%status)
         call path%set_status(wanted /= path%state%status, wanted)
      end do
      if (found) held = path%state%status == node_stick
      path%state = start
   end subroutine find_held

   !> Whether the pressures do not change: nodes that slip then stick at reversals only.
   pure logical function has_constant_pressures(path, segment)
      class(contact_path_type), intent(in) :: path
      type(segment_type), intent(in) :: segment
      logical :: normal(motion_count)

      normal = path%model%moves
      normal(motion_shift) = .false.
      has_constant_pressures = .not. path%model%compliance%has_block(block_wt) .and. .not. path%model%has_rigid_parts() .and. &
                               .not. any(abs(segment%load%rate) > 0.0_wp .and. normal)
   end function has_constant_pressures

   !> Statuses of the nodes at the friction limit for the given rates, as `wanted`, shape (nodes): nodes that slip back stick, and
   !> stuck nodes slip whose shear traction grows faster than the limit.
   subroutine find_moving(path, rate, wanted)
      class(contact_path_type), intent(in) :: path
      type(contact_fields_type), intent(in) :: rate
      integer, intent(out) :: wanted(:)
      real(wp), parameter :: negligible = 1.0e-9_wp
      real(wp) :: excess(size(wanted)), tolerance
      logical :: at_limit(size(wanted))

      tolerance = max(negligible, path%system%tolerance)
      wanted = path%state%status
      associate (fields => path%state%fields, limit => path%model%static_friction)
         at_limit = abs(fields%shear) >= limit*fields%pressure*(1.0_wp - tolerance)
         excess = sign(1.0_wp, fields%shear)*rate%shear - limit*rate%pressure
         where (slipping_back(path, path%state%status, rate)) wanted = node_stick
         where (path%state%status == node_stick .and. at_limit .and. excess > tolerance*maxval(abs(rate%shear))) &
            wanted = merge(node_slip_left, node_slip_right, fields%shear > 0.0_wp)
      end associate
   end subroutine find_moving

   !> An interval in a number of equal `increments`. `held`: from find_held. `coarser`: a chain of the same interval, for a first
   !> guess of the statuses. `path` is unchanged.
   subroutine make_chain(path, segment, done, length, increments, held, chain, coarser)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      real(wp), intent(in) :: done, length
      integer, intent(in) :: increments
      logical, allocatable, intent(in) :: held(:)
      type(chain_type), intent(out) :: chain
      type(chain_type), intent(in), optional :: coarser
      type(contact_state_type) :: start
      logical, allocatable :: holding(:)
      integer, allocatable :: status(:)
      integer :: i

      start = path%state
      chain%increments = increments
      allocate (chain%before(increments), chain%after(increments))
      allocate (chain%friction_work(size(start%status), increments), source=0.0_wp)
      chain%fronts = allocated(held)
      chain%begins = .not. any(in_contact(start%status))
      chain%solves = -path%system%solves
      if (allocated(held)) holding = held
      do i = 1, increments
         status = path%state%status
         if (allocated(held) .and. i > 1) holding = status == node_stick
         if (i == 1) call guess_slip(path, segment, done + length*reached(i))
         if (present(coarser)) call guess_from(path, coarser, i, increments)
         chain%after(i) = path%state%fields
         call find_statuses_on_mesh(path, segment, done + length*reached(i), chain%after(i), chain%found, chain%exceeded, &
                                    holding)
         if (.not. chain%found) exit
         chain%changes = chain%changes + count_changes(status, path%state%status)
         chain%before(i) = path%state
         call add_node_wise(path, chain, i)
         path%state%fields = chain%after(i)
         chain%traction = max(chain%traction, maxval(abs(chain%after(i)%pressure)), maxval(abs(chain%after(i)%shear)))
      end do
      chain%solves = chain%solves + path%system%solves
      if (allocated(holding)) call move_alloc(holding, chain%held)
      if (chain%found .and. any(in_contact(path%state%status) .and. .not. in_contact(start%status))) &
         chain%start_error = error_of_edge(path%state%status, chain%begins, abs(segment%load(motion_approach)%rate) > 0.0_wp, &
                                           path%model%scene%friction%static%largest())*chain%traction
      path%state = start

   contains

      !> Fraction of the interval after i increments. If contact begins, increments are even in the contact width, which for a
      !> parabola grows with the square root of the load.
      pure real(wp) function reached(i)
         integer, intent(in) :: i

         reached = real(i, wp)/real(increments, wp)
         if (chain%begins) reached = reached**2
      end function reached
   end subroutine make_chain

   !> Add the dissipation of increment `i` of a chain, node by node.
   subroutine add_node_wise(path, chain, i)
      class(contact_path_type), intent(in) :: path
      type(chain_type), intent(inout) :: chain
      integer, intent(in) :: i
      real(wp) :: error

      associate (work => chain%friction_work(:, i))
         call node_wise_dissipation(path%model, chain%before(i), chain%after(i), path%system%tolerance, work, error)
         chain%node_wise = chain%node_wise + path%model%force(work)
      end associate
      chain%node_wise_error = chain%node_wise_error + error
   end subroutine add_node_wise

   !> If increment `i` ends where one of a coarser chain does, start from the statuses there: of all nodes if the slip of touching
   !> nodes follows from the fronts.
   subroutine guess_from(path, coarser, i, increments)
      class(contact_path_type), intent(inout) :: path
      type(chain_type), intent(in) :: coarser
      integer, intent(in) :: i, increments

      if (mod(i*coarser%increments, increments) /= 0) return
      associate (status => coarser%before(i*coarser%increments/increments)%status)
         call path%set_status(coarser%fronts .or. in_contact(path%state%status) .and. in_contact(status), status)
      end associate
   end subroutine guess_from

   !> Number of nodes that change their status one by one (at a reversal of the load all slipping nodes stick at once).
   pure integer function count_changes(before, after)
      integer, intent(in) :: before(:), after(:)

      count_changes = count(before /= after .and. .not. (slips(before) .and. after == node_stick))
   end function count_changes

   !> Errors of the finer of two chains: tractions at first order, dissipation by mfv_chain_dissipation.
   subroutine compare(path, segment, coarser, finer)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      type(chain_type), intent(in) :: coarser
      type(chain_type), intent(inout) :: finer
      real(wp) :: refinement

      refinement = 1.0_wp/(sqrt(real(finer%increments, wp)/real(coarser%increments, wp)) - 1.0_wp)
      associate (a => coarser%after(coarser%increments), b => finer%after(finer%increments))
         finer%traction_error = finer%start_error &
                                + refinement*max(maxval(abs(a%pressure - b%pressure)), maxval(abs(a%shear - b%shear)))
      end associate
      call find_dissipation(path, segment, coarser, finer)
      if (finer%node_wise > 0.0_wp) finer%friction_work = finer%friction_work*(finer%work/finer%node_wise)
   end subroutine compare

   !> The dissipation of the finer of two chains and its estimated error. `segment`: that of the chain.
   subroutine find_dissipation(path, segment, coarser, finer)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      type(chain_type), intent(in) :: coarser
      type(chain_type), intent(inout) :: finer
      !> If contact begins, the smooth sum is worse than the rates with fewer increments.
      integer, parameter :: smooth_from = 8
      real(wp) :: smooth, corners, difference, change, by_rates, error

      call chain_dissipation(path%model, finer%before(1)%fields, finer%after, finer%begins, finer%changes, smooth, corners)
      difference = abs(smooth - finer%node_wise)
      finer%work = 0.5_wp*(max(smooth, 0.0_wp) + finer%node_wise)
      change = abs(finer%node_wise - coarser%node_wise)*(real(coarser%increments, wp)/finer%increments)**2
      finer%work_error = max(difference, change, corners)
      if (finer%begins .and. finer%increments > 1) then
         call dissipation_by_rates(dissipation_rates(path, segment, finer), count(slips(finer%before(finer%increments)%status)), &
                                   by_rates, error)
         if (finer%increments >= smooth_from .and. abs(smooth - by_rates) < error) then
            error = abs(smooth - by_rates)
            by_rates = 0.5_wp*(smooth + by_rates)
         end if
         if (error < finer%work_error) then
            finer%work = by_rates
            finer%work_error = error
         end if
      end if
      if (finer%node_wise_error <= finer%work_error) then
         finer%work = finer%node_wise
         finer%work_error = finer%node_wise_error
      end if
   end subroutine find_dissipation

   !> The friction dissipation per unit of load at the ends of the increments of a chain, force, shape (increments).
   function dissipation_rates(path, segment, chain) result(dissipated)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      type(chain_type), intent(in) :: chain
      real(wp) :: dissipated(chain%increments)
      type(contact_fields_type) :: rates
      logical :: found
      integer :: i

      dissipated = 0.0_wp
      do i = 1, chain%increments
         call find_rates_after(path, segment, chain, i, rates, found)
         if (found) dissipated(i) = -path%model%force(chain%after(i)%shear*rates%slip())
      end do
   end function dissipation_rates

   !> The rates at the end of increment `i` of a chain. `path` is unchanged.
   subroutine find_rates_after(path, segment, chain, i, rates, found)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      type(chain_type), intent(in) :: chain
      integer, intent(in) :: i
      type(contact_fields_type), intent(out) :: rates
      logical, intent(out) :: found
      type(contact_state_type) :: start

      start = path%state
      path%state = chain%before(i)
      path%state%fields = chain%after(i)
      call find_rates(path, segment, 1.0_wp, chain%after(i), rates, found)
      path%state = start
   end subroutine find_rates_after

   !> Error of the tractions of a contact that has begun (`begins`) or grown in the interval, relative to the largest, by the
   !> `status` of its nodes: see error_at_start and error_of_growth. An error at the edge of a contact without slip zones is
   !> compared with the friction limit, since it changes the slip zones of later steps. `presses`: whether the normal load changes;
   !> `friction`: the coefficient.
   pure real(wp) function error_of_edge(status, begins, presses, friction) result(error)
      integer, intent(in) :: status(:)
      logical, intent(in) :: begins, presses
      real(wp), intent(in) :: friction
      integer :: i, slipping
      logical :: inside

      error = merge(error_at_start, merge(error_of_growth, 0.0_wp, presses), begins)
      slipping = 0
      inside = .false.
      do i = 1, size(status)
         if (slips(status(i))) then
            slipping = slipping + 1
            cycle
         end if
         if ((status(i) == node_open .and. inside) .or. (status(i) == node_stick .and. .not. inside)) then
            if (slipping < resolved .and. .not. begins) error = error_of_growth
            if (slipping == 0 .and. begins) error = max(error, error_at_start/min(friction, 1.0_wp))
            if (slipping > 0 .and. slipping < resolved .and. begins) error = max(error, error_unresolved)
         end if
         inside = status(i) == node_stick
         slipping = 0
      end do
      error = error/max(count(in_contact(status)), 1)
   end function error_of_edge

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

   !> Whether the end of a segment may depend on the path to it: not without coupling, tangential load, shear and slip.
   logical function may_depend_on_path(path, segment)
      class(contact_path_type), intent(in) :: path
      type(segment_type), intent(in) :: segment

      associate (compliance => path%model%compliance)
         may_depend_on_path = compliance%has_block(block_up) .or. compliance%has_block(block_wt) .or. path%model%has_rigid_parts()
      end associate
      may_depend_on_path = may_depend_on_path .or. abs(segment%load(motion_shift)%rate) > 0.0_wp .or. &
                           any(slips(path%state%status)) .or. has_shear(path, path%state%fields)
   end function may_depend_on_path

   !> Whether the shear tractions are above round-off.
   logical function has_shear(path, fields)
      class(contact_path_type), intent(in) :: path
      type(contact_fields_type), intent(in) :: fields
      real(wp), parameter :: nothing = 1.0e-14_wp

      has_shear = maxval(abs(fields%shear)) > max(nothing, path%system%tolerance) &
                  *max(path%certificate%traction_scale(), maxval(abs(fields%pressure)))
   end function has_shear

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
      call path%certificate%note_large_increment(chain%traction_error, chain%work_error, reference_work(path, chain))
   end subroutine accept_chain

end module mfv_leap
