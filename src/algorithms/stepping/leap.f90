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
!> With full coupling the shear tractions depend on how the contact has grown. If it begins on layers, or one chain is not accurate
!> (it is, if the contact grows in proportion to its shape), it begins by events, on few nodes; then intervals double the load.
!> Their errors are compared with tractions and dissipation at the end of the segment.
!>
!> An interval that would take more solves than it has events is applied by events (mfv_first_violation), which are exact; gross
!> sliding and separation are therefore found there. The certificate checks large increments at their ends only.
module mfv_leap
   use mfv_active_set, only: find_rates, first_guess, slipping_back
   use mfv_chain
   use mfv_chain_dissipation, only: chain_dissipation, dissipation_by_rates, dissipation_by_slopes, sample_type, &
                                    straight_dissipation
   use mfv_compliance, only: block_up, block_wt
   use mfv_contact_fields, only: contact_fields_type
   use mfv_contact_path
   use mfv_contact_state, only: contact_state_type
   use mfv_contact_system, only: load_type
   use mfv_error, only: error_type
   use mfv_first_violation, only: apply_by_violations
   use mfv_frictionless, only: apply_directly, before_separation, lacks_support, find_statuses_and_grow, find_statuses_on_mesh, &
                               finish_large_increment, grow_mesh, subsegment
   use mfv_kinds, only: wp
   use mfv_motions, only: motion_count, motion_approach, motion_shift, control_displacement
   use mfv_node_status
   use mfv_observer, only: observer_type
   use mfv_tolerances, only: rounding, significant, visible
   implicit none
   private
   public :: apply_by_large_increments

   !> An interval shorter than this fraction of a segment is not divided. Where a contact grows that has begun in the segment: of
   !> the first length of the interval; and shorter than `least_growth` of what is done before it.
   real(wp), parameter :: shortest = 0.2_wp, least_growth = 0.05_wp
   !> Most increments of an interval; those of an exact one, for the history: one for a number of nodes in contact whose events cost
   !> more, and so few that all together have at most a number of nodes.
   integer, parameter :: most_increments = 64, most_recorded = 8, nodes_a_record = 32, nodes_recorded = 32768
   !> Linear solves of event stepping per change of status. Less than one, since event stepping can update the inverse from solve
   !> to solve, and a large increment cannot.
   real(wp), parameter :: solves_per_change = 0.6_wp
   !> Allowed part of the tolerance for errors of tractions by the path, which can be twice as large as estimated.
   real(wp), parameter :: safety = 0.5_wp

   !> Contacts that have begun in the segment are pressed by events up to this number of nodes, or until they are rough.
   integer, parameter :: nodes_to_begin = 150
   !> Most increments of an interval in which such a contact grows, if its tractions are not accurate.
   integer, parameter :: most_growing = 8
   !> Largest part of a segment in which a growing contact may be taken to begin.
   real(wp), parameter :: most_to_begin = 0.25_wp

   !> Progress in a segment, as fractions of it: what is done, the goal of large increments, the length of the next interval, and
   !> the longest that was tried for it. `by_violations`: whether that interval is applied by events.
   type :: leap_progress_type
      real(wp) :: done = 0.0_wp, goal = 0.0_wp, length = 0.0_wp, longest = 0.0_wp
      !> Increments of the first chain of the next interval.
      integer :: increments = 2
      logical :: by_violations = .false.
      !> A contact that has begun in the segment, without friction, at the goal: the largest pressure and the 2-norm of all,
      !> force/length^2; the friction limit, force. Zero: it has not (has_begun).
      real(wp) :: traction = 0.0_wp, norm = 0.0_wp, sliding_limit = 0.0_wp
      !> The dissipation of the contact before the segment, force.
      real(wp) :: dissipation = 0.0_wp
      !> The sum of the squares of the errors of the tractions of rough contacts over the allowed one.
      real(wp) :: spent = 0.0_wp
   end type leap_progress_type

contains

   !> Apply the loads of a segment by large increments. `observer` is notified of every interval.
   !> Errors, each with the last admissible state left in place: those of mfv_first_violation.
   subroutine apply_by_large_increments(path, segment, observer, error)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      class(observer_type), intent(inout), optional :: observer
      type(error_type), allocatable, intent(out) :: error
      type(leap_progress_type) :: progress

      if (.not. (segment%friction .and. path%model%scene%friction%acts() .and. &
                 (path%model%scene%method%accuracy > 0.0_wp .or. is_exact(path, segment)))) then
         call apply_directly(path, segment, observer, error)
         return
      end if
      call path%switch_friction(segment, error)
      if (allocated(error)) return
      if (.not. lacks_support(path, segment)) progress%goal = before_separation(segment)
      progress%dissipation = path%state%dissipation
      call set_length(progress, progress%goal)
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

   !> Whether the contact has begun in the segment, by events (begin_by_violations).
   pure logical function has_begun(progress)
      type(leap_progress_type), intent(in) :: progress

      has_begun = progress%traction > 0.0_wp
   end function has_begun

   !> Set the length of the next interval, but not beyond the goal.
   pure subroutine set_length(progress, length)
      type(leap_progress_type), intent(inout) :: progress
      real(wp), intent(in) :: length
      real(wp), parameter :: whole = 0.999_wp

      associate (left => progress%goal - progress%done)
         progress%length = merge(left, length, length > whole*left)
      end associate
      progress%longest = progress%length
   end subroutine set_length

   !> The interval is done: the next one is the rest. While a contact grows that has begun in the segment it is twice as long, or as
   !> long if this one was shortened.
   pure subroutine advance(progress)
      type(leap_progress_type), intent(inout) :: progress
      real(wp) :: length

      length = merge(progress%length, 2.0_wp*progress%length, progress%length < progress%longest)
      if (.not. has_begun(progress)) length = progress%goal
      progress%done = merge(progress%goal, progress%done + progress%length, progress%length >= progress%goal - progress%done)
      call set_length(progress, length)
   end subroutine advance

   !> The length of intervals that are not divided.
   pure real(wp) function shortest_length(progress) result(length)
      type(leap_progress_type), intent(in) :: progress

      length = shortest
      if (has_begun(progress)) length = max(shortest*progress%longest, least_growth*progress%done)
   end function shortest_length

   !> Try the next interval. If its statuses are not found, it is shortened; if it is not accurate, it is applied by events
   !> (`progress%by_violations`).
   subroutine try_large_increments(path, segment, progress, observer, error)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      type(leap_progress_type), intent(inout) :: progress
      class(observer_type), intent(inout), optional :: observer
      type(error_type), allocatable, intent(out) :: error
      type(segment_type) :: interval
      type(chain_type), allocatable :: chain
      logical :: accepted, grown

      interval = subsegment(segment, progress%done, progress%done + progress%length)
      if (begins_on_few_nodes(path, interval, progress)) then
         call begin_by_violations(path, segment, progress)
         return
      end if
      call allow_errors(path, progress, interval)
      call refine(path, interval, progress, chain, accepted)
      if (accepted .and. interval%allowed > 0.0_wp) call finish_chain(path, interval, chain, accepted)
      if (chain%exceeded) then
         call grow_mesh(path, grown)
         if (grown) return
      end if
      if (accepted) then
         call accept_chain(path, interval, progress, chain)
         if (has_begun(progress)) progress%increments = max(chain%increments, 2)
         call advance(progress)
         call finish_large_increment(path, segment, progress%done, observer, error)
      else if (chain%rough) then
         progress%length = progress%longest
         progress%by_violations = .true.
      else if (is_coupled(path) .and. .not. any(in_contact(path%state%status))) then
         call begin_by_violations(path, segment, progress)
      else if (chain%found .and. .not. is_worth_it(progress, chain)) then
         progress%length = progress%longest
         progress%by_violations = .true.
      else if (.not. chain%found .and. chain%solves < path%state%contact_nodes() .and. &
               progress%length > shortest_length(progress)) then
         progress%length = 0.5_wp*progress%length
      else
         progress%by_violations = .true.
      end if
   end subroutine try_large_increments

   !> Whether a chain of more increments would take fewer solves than events. Not asked of contacts that have not begun in the
   !> segment.
   pure logical function is_worth_it(progress, chain)
      type(leap_progress_type), intent(in) :: progress
      type(chain_type), intent(in) :: chain

      is_worth_it = .not. has_begun(progress) .or. max(2/chain%increments, 1)*chain%solves < solves_per_change*chain%changes
   end function is_worth_it

   !> Whether the pressures depend on the shear tractions, so that these depend on how the contact grows.
   pure logical function is_coupled(path)
      class(contact_path_type), intent(in) :: path

      is_coupled = path%model%compliance%has_block(block_wt)
   end function is_coupled

   !> Whether contact begins, or has begun in the segment, on so few nodes that large increments with coupling would not be
   !> accurate; or begins on layers or a rough surface, so that it does not grow in proportion to its shape.
   logical function begins_on_few_nodes(path, interval, progress) result(few)
      class(contact_path_type), intent(in) :: path
      type(segment_type), intent(in) :: interval
      type(leap_progress_type), intent(in) :: progress
      logical :: contact(size(path%state%status))
      real(wp) :: gap(size(contact))

      few = is_coupled(path)
      if (.not. few) return
      if (any(in_contact(path%state%status))) then
         few = has_begun(progress) .and. path%state%contact_nodes() < nodes_to_begin .and. .not. is_rough(path%state%status)
      else
         call first_guess(path, interval, 1.0_wp, contact)
         ! Patches of a rough surface do not extend beyond the largest gaps beside them.
         gap = path%model%gap(path%state%fields)
         contact = contact .and. .not. (gap > eoshift(gap, -1, huge(gap)) .and. gap >= eoshift(gap, 1, huge(gap)))
         few = count(contact) < error_at_start/path%model%scene%method%accuracy .or. path%model%scene%is_layered() .or. &
               is_rough(merge(node_stick, node_open, contact))
      end if
   end function begins_on_few_nodes

   !> Have the next interval applied by events: at first up to a contact of about `nodes_to_begin` nodes if large increments may
   !> then be accurate at the goal, else all of it.
   subroutine begin_by_violations(path, segment, progress)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      type(leap_progress_type), intent(inout) :: progress
      real(wp), parameter :: nothing = 1.0e-12_wp, headroom = 4.0_wp
      integer :: nodes, first

      progress%by_violations = .true.
      if (has_begun(progress)) return
      call find_goal(path, segment, progress, nodes)
      if (nodes*path%model%scene%method%accuracy < headroom*error_at_start) return
      first = guessed(nothing)
      do while (progress%length > most_to_begin*progress%goal .or. guessed(progress%length) > first + nodes_to_begin)
         progress%length = 0.5_wp*progress%length
      end do

   contains

      !> The estimated number of nodes in contact after a part of the segment.
      integer function guessed(length)
         real(wp), intent(in) :: length
         logical :: contact(size(path%state%status))

         call first_guess(path, segment, progress%done + length, contact)
         guessed = count(contact)
      end function guessed
   end subroutine begin_by_violations

   !> The contact at the goal without friction, from none: its tractions, for `progress`, and its number of `nodes`, 0 if it is not
   !> found.
   subroutine find_goal(path, segment, progress, nodes)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      type(leap_progress_type), intent(inout) :: progress
      integer, intent(out) :: nodes
      type(segment_type) :: frictionless
      type(contact_state_type) :: start
      type(contact_fields_type) :: fields
      logical :: found

      nodes = 0
      frictionless = segment
      frictionless%friction = .false.
      frictionless%load(motion_shift) = load_type(control_displacement, path%state%fields%motion(motion_shift), 0.0_wp)
      call find_statuses_and_grow(path, frictionless, progress%goal, fields, found, start)
      if (found) then
         nodes = path%state%contact_nodes()
         progress%traction = maxval(fields%pressure)
         progress%norm = norm2(fields%pressure)
         progress%sliding_limit = path%model%force(path%model%static_friction*fields%pressure)
      end if
      path%state = start
   end subroutine find_goal

   !> Apply the next interval by events.
   subroutine continue_by_violations(path, segment, progress, observer, error)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      type(leap_progress_type), intent(inout) :: progress
      class(observer_type), intent(inout), optional :: observer
      type(error_type), allocatable, intent(out) :: error

      call apply_by_violations(path, subsegment(segment, progress%done, progress%done + progress%length), observer, error)
      if (allocated(error)) return
      progress%by_violations = .false.
      call advance(progress)
   end subroutine continue_by_violations

   !> An interval in chains of more and more increments. The first one has as many as were needed before, at least two unless
   !> contact begins: the statuses of half as many, longer ones are easily found from it, but not by themselves. `accepted`: whether
   !> one is accurate with fewer solves than event stepping; `chain`: that one, or the last. `path` is unchanged.
   subroutine refine(path, interval, progress, chain, accepted)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: interval
      type(leap_progress_type), intent(in) :: progress
      type(chain_type), allocatable, intent(out) :: chain
      logical, intent(out) :: accepted
      type(sample_type) :: start
      type(chain_type), allocatable :: finer
      !> Both sums of the dissipation without rates may err in the same direction by more than they differ.
      real(wp), parameter :: both_wrong = 0.3_wp
      integer :: increments
      logical :: rough, begins

      rough = is_rough(path%state%status)
      begins = .not. any(in_contact(path%state%status))
      if (may_depend_on_path(path, interval) .and. (path%leaving%pending .or. .not. rough)) call find_start(path, interval, start)
      call find_stiffness(path, interval, start)
      ! Fronts of patches of few nodes are not resolved.
      if (rough .and. allocated(start%status)) deallocate (start%status)
      accepted = is_exact(path, interval)
      increments = 1
      associate (nodes => max(path%state%contact_nodes(), 1))
         if (accepted .and. path%record_events) increments = max(1, min(most_recorded, nodes/nodes_a_record, nodes_recorded/nodes))
      end associate
      if (.not. (accepted .or. begins)) increments = progress%increments
      allocate (chain)
      call make_chain(path, interval, increments, start, chain)
      accepted = accepted .and. chain%found
      if (accepted .or. .not. chain%found) return
      if (.not. promises(path, progress, chain)) return
      if (increments > 1) then
         call move_alloc(chain, finer)
         allocate (chain)
         call make_chain(path, interval, increments/2, start, chain, finer)
         if (.not. chain%found) return
         ! As if every other state had been known.
         finer%solves = (finer%solves + 2*chain%solves)/2
      else
         allocate (finer)
         call make_chain(path, interval, 2, start, finer, chain)
      end if
      do
         if (finer%found) call compare(path, interval, chain, finer)
         call move_alloc(finer, chain)
         if (.not. chain%found) return
         call choose(path, progress, chain, accepted, increments)
         if (chain%fronts .and. .not. chain%begins .and. relative_work_error(path, progress, chain) > both_wrong) &
            call refine_samples(path, interval, progress, start, chain, accepted, increments)
         if (accepted .or. increments == 0) return
         allocate (finer)
         call make_chain(path, interval, increments, start, finer, chain)
      end do
   end subroutine refine

   !> Whether chains of more increments may be accurate, with fewer solves than events.
   pure logical function promises(path, progress, chain)
      class(contact_path_type), intent(in) :: path
      type(leap_progress_type), intent(in) :: progress
      type(chain_type), intent(in) :: chain

      promises = chain%start_error <= path%model%scene%method%accuracy*reference_traction(path, progress, chain) .and. &
                 is_worth_it(progress, chain)
   end function promises

   !> If the tractions of a chain are accurate, but not its dissipation, take more and more samples. `accepted`, `increments`: see
   !> choose.
   subroutine refine_samples(path, interval, progress, start, chain, accepted, increments)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: interval
      type(leap_progress_type), intent(in) :: progress
      type(sample_type), intent(in) :: start
      type(chain_type), intent(inout) :: chain
      logical, intent(inout) :: accepted
      integer, intent(inout) :: increments
      !> Fewest samples under changing normal loads, where fewer do not show their error. Where the contact has begun in the segment
      !> the error of the sum without rates is taken, which is larger.
      integer, parameter :: least_samples = 4
      logical :: found

      if (relative_traction_error(path, progress, chain) > 1.0_wp) return
      do
         call add_samples(path, interval, start, chain, found)
         if (.not. found) return
         call weigh_samples(path, progress, chain)
         accepted = relative_work_error(path, progress, chain) <= 1.0_wp
         if (accepted .and. abs(interval%load(motion_approach)%rate) > 0.0_wp .and. .not. has_begun(progress)) &
            accepted = ubound(chain%samples, 1) >= least_samples
         if (accepted .and. shares_work(chain)) &
            accepted = chain%motion_work_error <= path%model%scene%method%accuracy*reference_work(path, progress, chain)
         if (accepted) return
         if (2*ubound(chain%samples, 1) > most_increments .or. 2*chain%solves > solves_per_change*chain%changes) exit
      end do
      increments = 0
   end subroutine refine_samples

   !> Whether the forces of several motions change as these move, so that the dissipation does not give the work of each.
   pure logical function shares_work(chain)
      type(chain_type), intent(in) :: chain
      real(wp), parameter :: negligible = 1.0e-4_wp
      real(wp) :: area(motion_count)

      area = areas_of(chain)
      shares_work = sum(area) - maxval(area) > negligible*sum(area)
   end function shares_work

   !> Changes of the forces times those of their motions over a chain, force.
   pure function areas_of(chain) result(area)
      type(chain_type), intent(in) :: chain
      real(wp) :: area(motion_count)

      associate (start => chain%before(1)%fields, end => chain%after(chain%increments))
         area = abs((end%force - start%force)*(end%motion - start%motion))
      end associate
   end function areas_of

   !> The dissipation of a chain by its samples: by slopes, or node by node if that is exact. Its error is taken to be half the
   !> difference to the sum node by node, extrapolated at second order, but at least a sixth of that to the sum itself; twice as
   !> much with two samples; and at least a third of the change from half as many, or from the sum without rates (where the load
   !> passes a former reversal, rates jump, and the sums converge at second order). While a contact grows that has begun in the
   !> segment, the sum node by node is much worse, since nodes touch: there it is taken to be this change, three times as much, or
   !> a quarter of that due to edges (under coatings and waves at most a fifth of this was found).
   subroutine weigh_samples(path, progress, chain)
      class(contact_path_type), intent(in) :: path
      type(leap_progress_type), intent(in) :: progress
      type(chain_type), intent(inout) :: chain
      real(wp), parameter :: part_of_edges = 0.25_wp
      real(wp) :: by_nodes, coarse, error, few, coarse_works(motion_count)

      coarse = chain%by_slopes
      coarse_works = chain%motion_work
      call dissipation_by_slopes(path%model, chain%samples, chain%changes, chain%by_slopes, error, chain%motion_work)
      by_nodes = chain%node_wise + (chain%node_wise - chain%coarse_node_wise)/3.0_wp
      chain%work = chain%by_slopes
      few = merge(2.0_wp, 1.0_wp, ubound(chain%samples, 1) == 2)
      if (has_begun(progress)) then
         chain%work_error = max(abs(chain%by_slopes - coarse), part_of_edges*error)
      else
         chain%work_error = max(few*abs(chain%by_slopes - by_nodes)/2.0_wp, &
                                few*abs(chain%by_slopes - chain%node_wise)/6.0_wp, error, abs(chain%by_slopes - coarse)/3.0_wp)
      end if
      call prefer_node_wise(chain)
      if (ubound(chain%samples, 1) > chain%increments) &
         chain%motion_work_error = maxval(abs(chain%motion_work - coarse_works))/3.0_wp + abs(chain%work - chain%by_slopes)
   end subroutine weigh_samples

   !> Take the dissipation node by node if its error is not larger, or if the other one is negative.
   pure subroutine prefer_node_wise(chain)
      type(chain_type), intent(inout) :: chain

      if (.not. (chain%work < 0.0_wp .or. chain%node_wise_error <= chain%work_error)) return
      chain%work = chain%node_wise
      chain%work_error = chain%node_wise_error
   end subroutine prefer_node_wise

   !> Allow errors of iterative solvers that are negligible beside that of a chain and in the certificate: of the rates, only signs
   !> and corrections of slips are used, and smaller ones where a contact grows that has begun in the segment, whose fronts may
   !> rest. Without coupling this would save nothing: the preconditioner is exact.
   subroutine allow_errors(path, progress, interval)
      class(contact_path_type), intent(in) :: path
      type(leap_progress_type), intent(in) :: progress
      type(segment_type), intent(inout) :: interval
      real(wp), parameter :: most = 1.0e-9_wp, in_rates = 1.0e-2_wp, at_fronts = 3.0e-3_wp, most_in_rates = 1.0e-4_wp

      if (.not. (path%model%compliance%has_block(block_up) .and. path%model%compliance%has_block(block_wt))) return
      associate (accuracy => path%model%scene%method%accuracy)
         interval%allowed = min(visible*accuracy, most)
         interval%allowed_in_rates = min(merge(at_fronts, in_rates, has_begun(progress))*accuracy, most_in_rates)
      end associate
   end subroutine allow_errors

   !> Solve for the end of a chain without the error allowed so far, which later events and statuses would depend on.
   subroutine finish_chain(path, interval, chain, found)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: interval
      type(chain_type), intent(inout) :: chain
      logical, intent(out) :: found
      type(contact_state_type) :: start
      type(segment_type) :: accurate

      start = path%state
      accurate = interval
      accurate%allowed = 0.0_wp
      path%state = chain%before(chain%increments)
      call find_statuses_on_mesh(path, accurate, 1.0_wp, chain%after(chain%increments), found, chain%exceeded, chain%held, &
                                 chain%begins)
      chain%found = found
      chain%before(chain%increments)%status = path%state%status
      chain%before(chain%increments)%stuck_slip = path%state%stuck_slip
      if (found .and. allocated(chain%samples)) then
         chain%samples(ubound(chain%samples, 1))%status = path%state%status
         call chain%samples(ubound(chain%samples, 1))%fields%copy_from(chain%after(chain%increments))
      end if
      path%state = start
   end subroutine finish_chain

   !> Whether a chain meets the tolerance; if not, the number of increments of the next one, 0: too many. (In rough contacts errors
   !> fall irregularly, and with fronts samples give the dissipation: twice as many.)
   subroutine choose(path, progress, chain, accepted, increments)
      class(contact_path_type), intent(in) :: path
      type(leap_progress_type), intent(in) :: progress
      type(chain_type), intent(in) :: chain
      logical, intent(out) :: accepted
      integer, intent(out) :: increments
      real(wp) :: by_tractions, by_work, wanted

      by_tractions = relative_traction_error(path, progress, chain)
      by_work = relative_work_error(path, progress, chain)
      accepted = max(by_tractions, by_work) <= 1.0_wp
      increments = 0
      if (accepted) return
      wanted = 2.0_wp
      if (.not. chain%rough .and. (chain%begins .or. .not. chain%fronts)) &
         wanted = min(max(2.0_wp, merge(1.0_wp, by_tractions, chain%fronts), by_work**merge(0.25_wp, 0.5_wp, chain%begins)), &
                      real(most_increments, wp))
      increments = chain%increments*2**ceiling(log(wanted)/log(2.0_wp) - 1.0e-6_wp)
      if ((has_begun(progress) .and. by_tractions > 1.0_wp .and. increments > most_growing .and. .not. chain%rough) .or. &
          (chain%begins .and. by_tractions > most_increments/chain%increments)) increments = 0
      if ((increments > most_increments .and. .not. chain%rough) .or. &
          (real(chain%solves, wp)*increments)/chain%increments > solves_per_change*chain%changes) increments = 0
   end subroutine choose

   !> The estimated error of the tractions of a chain, relative to the allowed one. In rough contacts intervals err at different
   !> nodes, and their squares add up: an interval may take of what is left the power 2/3 of its share of the rest of the segment.
   !> (Errors are of first order, and the norm of the tractions grows with the root of the load: with intervals that double, this
   !> takes the fewest increments.)
   pure real(wp) function relative_traction_error(path, progress, chain) result(error)
      class(contact_path_type), intent(in) :: path
      type(leap_progress_type), intent(in) :: progress
      type(chain_type), intent(in) :: chain
      real(wp), parameter :: power = 2.0_wp/3.0_wp

      if (chain%rough) then
         associate (share => progress%length/(progress%goal - progress%done))
            error = over_allowed(path, progress, chain, chain%traction_error) &
                    /sqrt(max(1.0_wp - progress%spent, tiny(1.0_wp))*share**power)
         end associate
      else
         error = over_allowed(path, progress, chain, (chain%traction_error - chain%start_error)/safety + chain%start_error)
      end if
   end function relative_traction_error

   !> An error of the tractions of a chain, force/length^2, relative to the accuracy.
   pure real(wp) function over_allowed(path, progress, chain, traction_error) result(error)
      class(contact_path_type), intent(in) :: path
      type(leap_progress_type), intent(in) :: progress
      type(chain_type), intent(in) :: chain
      real(wp), intent(in) :: traction_error
      real(wp) :: traction

      error = 0.0_wp
      traction = reference_traction(path, progress, chain)
      if (traction > 0.0_wp) error = traction_error/(path%model%scene%method%accuracy*traction)
   end function over_allowed

   !> The traction that errors of those of a chain are compared with, force/length^2: the largest so far. If the contact has begun
   !> in the segment, at least that at its end, which the state that it is left at then is as accurate as: in rough contacts, whose
   !> errors are root mean squares, in proportion to the 2-norms.
   pure real(wp) function reference_traction(path, progress, chain) result(traction)
      class(contact_path_type), intent(in) :: path
      type(leap_progress_type), intent(in) :: progress
      type(chain_type), intent(in) :: chain

      traction = max(path%certificate%traction_scale, chain%traction, progress%traction)
      if (.not. (chain%rough .and. has_begun(progress))) return
      associate (last => chain%after(chain%increments))
         traction = traction*max(1.0_wp, progress%norm/norm2([last%pressure, last%shear]))
      end associate
   end function reference_traction

   !> The estimated error of the dissipation of a chain, relative to the allowed one.
   pure real(wp) function relative_work_error(path, progress, chain) result(error)
      class(contact_path_type), intent(in) :: path
      type(leap_progress_type), intent(in) :: progress
      type(chain_type), intent(in) :: chain

      error = 0.0_wp
      if (chain%work_error > 0.0_wp) &
         error = chain%work_error/max(path%model%scene%method%accuracy*reference_work(path, progress, chain), tiny(1.0_wp))
   end function relative_work_error

   !> The work that the error of the dissipation of a chain is compared with, force: the dissipation. If contact begins, that is
   !> often next to nothing: then at least that of a cycle of shear to about 0.8 mu P, as a fraction of (mu P)^2/m, m the contact
   !> modulus. In later parts of a segment in which it has begun, at least a `part` of the dissipation at the goal, if it grows with
   !> the square of the load as that of a parabola, but no more than that of such a cycle; at least the fraction `least` of that
   !> of such a cycle at the goal; in rough contacts at least a `part` of that of such cycles of all patches, as if each was
   !> alone.
   pure real(wp) function reference_work(path, progress, chain) result(work)
      class(contact_path_type), intent(in) :: path
      type(leap_progress_type), intent(in) :: progress
      type(chain_type), intent(in) :: chain
      real(wp), parameter :: fraction = 0.06_wp, part = 0.25_wp, least = 0.01_wp
      real(wp) :: cycle_work, share

      work = chain%work
      cycle_work = fraction/path%model%compliance%modulus
      if (chain%begins) then
         work = max(work, cycle_work*path%model%force(path%model%static_friction*chain%after(chain%increments)%pressure)**2)
      else if (has_begun(progress)) then
         share = (progress%done + progress%length)/progress%goal
         work = max(work, least*cycle_work*progress%sliding_limit**2, &
                    part*min(cycle_work*progress%sliding_limit**2, &
                             (path%state%dissipation - progress%dissipation + chain%work)/share**2))
         if (chain%rough) work = max(work, part*cycle_work*sum_of_squares(path, chain%after(chain%increments)%pressure))
      end if
   end function reference_work

   !> The sum of the squares of the friction limits of all patches under the given pressures, shape (nodes); force^2.
   pure real(wp) function sum_of_squares(path, pressure) result(total)
      class(contact_path_type), intent(in) :: path
      real(wp), intent(in) :: pressure(:)
      real(wp) :: limit
      integer :: i

      total = 0.0_wp
      limit = 0.0_wp
      do i = 1, size(pressure)
         limit = limit + path%model%width(i)*path%model%static_friction(i)*pressure(i)
         if (pressure(i) > 0.0_wp .and. i < size(pressure)) cycle
         total = total + limit**2
         limit = 0.0_wp
      end do
   end function sum_of_squares

   !> The start of an interval with the statuses as the loads begin to change, and their rates if there is contact. Without statuses
   !> if these are not found.
   subroutine find_start(path, interval, begin)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: interval
      type(sample_type), intent(out) :: begin
      integer, parameter :: most_passes = 20
      type(contact_state_type) :: start
      integer :: pass, wanted(size(path%state%status))
      logical :: determined, found

      if (has_constant_pressures(path, interval)) return
      start = path%state
      found = .not. any(in_contact(path%state%status))
      do pass = 1, most_passes
         if (found) exit
         if (.not. any(holds(path%state%status))) &
            call path%set_status(in_contact(path%state%status), spread(node_stick, 1, size(wanted)))
         call find_rates(path, interval, 0.0_wp, path%state%fields, begin%rates, determined)
         if (.not. determined) exit
         call find_moving(path, begin%rates, wanted)
         found = all(wanted == path%state%status)
         call path%set_status(wanted /= path%state%status, wanted)
      end do
      if (found) begin%status = path%state%status
      begin%fields = start%fields
      path%state = start
   end subroutine find_start

   !> Find the stiffness on leaving a turning point, if it is pending, from the rates at the start of an interval. Under constant
   !> pressures all nodes in contact stick there. `start`: see find_start.
   subroutine find_stiffness(path, interval, start)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: interval
      type(sample_type), intent(in) :: start
      type(contact_state_type) :: present_state
      type(contact_fields_type) :: rates
      logical :: found

      if (.not. path%leaving%pending .or. .not. abs(interval%load(motion_shift)%rate) > 0.0_wp) return
      found = allocated(start%status)
      if (found) then
         rates = start%rates
      else if (has_constant_pressures(path, interval) .and. any(in_contact(path%state%status))) then
         present_state = path%state
         call path%set_status(in_contact(path%state%status), spread(node_stick, 1, size(path%state%status)))
         call find_rates(path, interval, 0.0_wp, path%state%fields, rates, found)
         path%state = present_state
      end if
      if (found) call path%note_stiffness(rates%force(motion_shift), rates%motion(motion_shift))
   end subroutine find_stiffness

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

   !> Whether a segment needs no more than one increment.
   logical function is_exact(path, segment)
      class(contact_path_type), intent(in) :: path
      type(segment_type), intent(in) :: segment

      is_exact = slips_one_way(path, segment) .or. .not. may_depend_on_path(path, segment)
   end function is_exact

   !> Whether nodes slip in the direction of the load only, and one increment is therefore exact: on half-planes under constant
   !> pressures. The rates are those under rigid punches, the stick zones, that move together. By the maximum principle of the
   !> logarithmic potential the shear traction of every stick zone grows everywhere, and the surface beside it moves less than it.
   logical function slips_one_way(path, interval)
      class(contact_path_type), intent(in) :: path
      type(segment_type), intent(in) :: interval

      slips_one_way = path%model%compliance%is_homogeneous .and. has_constant_pressures(path, interval)
   end function slips_one_way

   !> Statuses of the nodes at the friction limit for the given rates, as `wanted`, shape (nodes): nodes that slip back stick, and
   !> stuck nodes slip whose shear traction grows faster than the limit.
   subroutine find_moving(path, rate, wanted)
      class(contact_path_type), intent(in) :: path
      type(contact_fields_type), intent(in) :: rate
      integer, intent(out) :: wanted(:)
      real(wp) :: excess(size(wanted)), tolerance
      logical :: at_limit(size(wanted))

      tolerance = max(significant, path%system%tolerance)
      wanted = path%state%status
      associate (fields => path%state%fields, limit => path%model%static_friction)
         at_limit = abs(fields%shear) >= limit*fields%pressure*(1.0_wp - tolerance)
         excess = sign(1.0_wp, fields%shear)*rate%shear - limit*rate%pressure
         where (slipping_back(path, path%state%status, rate)) wanted = node_stick
         tolerance = max(significant, path%system%rate_tolerance)
         where (path%state%status == node_stick .and. at_limit .and. excess > tolerance*maxval(abs(rate%shear))) &
            wanted = merge(node_slip_left, node_slip_right, fields%shear > 0.0_wp)
      end associate
   end subroutine find_moving

   !> Errors of the finer of two chains of an interval: tractions at the order at which they converge, at most the first, with
   !> fronts after the contact has begun the second, and at half that order if it is not known; dissipation by
   !> mfv_chain_dissipation. In rough contacts, where single nodes of small patches may close in another order, that of tractions
   !> is a root mean square, times the ratio of the largest traction to theirs, at first order.
   subroutine compare(path, interval, coarser, finer)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: interval
      type(chain_type), intent(in) :: coarser
      type(chain_type), intent(inout) :: finer
      real(wp) :: order, ratio, least_order, most_order

      most_order = merge(2.0_wp, 1.0_wp, finer%fronts .and. .not. finer%begins)
      least_order = merge(1.0_wp, 0.5_wp, finer%rough)*most_order
      ratio = real(finer%increments, wp)/real(coarser%increments, wp)
      associate (a => coarser%after(coarser%increments), b => finer%after(finer%increments))
         finer%difference = max(maxval(abs(a%pressure - b%pressure)), maxval(abs(a%shear - b%shear)))
         if (finer%rough) finer%difference = finer%traction*norm2([a%pressure - b%pressure, a%shear - b%shear]) &
                                             /norm2([b%pressure, b%shear])
      end associate
      order = least_order
      if (coarser%difference > finer%difference) order = merge(log(coarser%difference/finer%difference)/log(ratio), most_order, &
                                                               finer%difference > 0.0_wp)
      order = min(max(order, least_order), most_order)
      finer%traction_error = finer%start_error + finer%difference/(ratio**order - 1.0_wp)
      ! As if with half as many increments, at second order.
      finer%coarse_node_wise = finer%node_wise - 3.0_wp*(finer%node_wise - coarser%node_wise) &
                               /((real(finer%increments, wp)/coarser%increments)**2 - 1.0_wp)
      call find_dissipation(path, interval, coarser, finer)
   end subroutine compare

   !> The dissipation of the finer of two chains and its estimated error.
   subroutine find_dissipation(path, interval, coarser, finer)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: interval
      type(chain_type), intent(in) :: coarser
      type(chain_type), intent(inout) :: finer
      !> If contact begins, the smooth sum is worse than the rates with fewer increments.
      integer, parameter :: smooth_from = 8
      real(wp) :: smooth, corners, difference, change, by_rates, error

      call chain_dissipation(path%model, finer%before(1)%fields, finer%after, finer%changes, smooth, corners)
      finer%by_slopes = smooth
      difference = abs(smooth - finer%node_wise)
      finer%work = 0.5_wp*(max(smooth, 0.0_wp) + finer%node_wise)
      change = abs(finer%node_wise - coarser%node_wise)
      if (finer%rough) then
         ! Nodes that slip and stick again within an increment are missed: first order.
         change = change*coarser%increments/(finer%increments - coarser%increments)
         finer%node_wise_error = max(finer%node_wise_error, change)
      else
         change = change*(real(coarser%increments, wp)/finer%increments)**2
      end if
      finer%work_error = max(difference, change, corners)
      if (finer%begins .and. finer%increments > 1) then
         call dissipation_by_rates(dissipation_rates(path, interval, finer), count(slips(finer%before(finer%increments)%status)), &
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
      call prefer_node_wise(finer)
   end subroutine find_dissipation

   !> The friction dissipation per unit of the interval at the ends of the increments of a chain, force, shape (increments).
   function dissipation_rates(path, interval, chain) result(dissipated)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: interval
      type(chain_type), intent(in) :: chain
      real(wp) :: dissipated(chain%increments)
      type(contact_fields_type) :: rates
      logical :: found
      integer :: i

      dissipated = 0.0_wp
      do i = 1, chain%increments
         call find_rates_after(path, interval, chain, i, .false., rates, found)
         if (found) dissipated(i) = -path%model%force(chain%after(i)%shear*rates%slip())
      end do
   end function dissipation_rates

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

      has_shear = maxval(abs(fields%shear)) > max(rounding, path%system%tolerance) &
                  *max(path%certificate%traction_scale, maxval(abs(fields%pressure)))
   end function has_shear

   !> Accept the increments of a chain from the state of `path`, at the start of the interval. The dissipation of each node is
   !> scaled to that of the chain. (Friction has no memory here: statuses are set directly.)
   subroutine accept_chain(path, interval, progress, chain)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: interval
      type(leap_progress_type), intent(inout) :: progress
      type(chain_type), intent(in) :: chain
      real(wp) :: before(motion_count), share, error
      integer :: i

      share = 1.0_wp
      if (chain%node_wise > 0.0_wp) share = chain%work/chain%node_wise
      before = path%work
      do i = 1, chain%increments
         ! Nodes that slip on stuck before this increment.
         where (.not. (slips(chain%before(i)%status) .and. chain%before(i)%status == path%state%status)) &
            path%state%stuck_slip = chain%before(i)%stuck_slip
         path%state%status = chain%before(i)%status
         call path%take_increment(chain%after(i), chain%after(i)%slip() - path%state%fields%slip(), 0.0_wp, &
                                  friction_work=share*chain%friction_work(:, i))
         call path%record_increment(interval, real(i, wp)/chain%increments)
      end do
      if (shares_work(chain)) &
         path%work_error = path%work_error + error_of_works(chain, path%work - before)/path%model%scene%method%accuracy
      path%work = before + work_of_motions(path, chain, share*chain%node_wise, path%work - before)
      if (allocated(chain%samples)) call path%recent%keep(interval%load, chain%samples)
      error = chain%traction_error
      if (chain%rough) then
         progress%spent = progress%spent + over_allowed(path, progress, chain, error)**2
         error = sqrt(progress%spent)*path%model%scene%method%accuracy*reference_traction(path, progress, chain)
      end if
      call path%certificate%note_large_increment(error, reference_traction(path, progress, chain), chain%work_error, &
                                                 reference_work(path, progress, chain), chain%rough)
   end subroutine accept_chain

   !> The work of the forces of all motions, force, from that along `straight` lines between the ends of increments, or from the
   !> samples. Either contains the elastic energy (with Goodman's coupling, its work along these lines or through the samples). The
   !> rest of what is `dissipated`, force, is divided among motions as are the areas between straight line and path, if all paths
   !> have the same shape. (This is exact for one motion with a changing force.)
   pure function work_of_motions(path, chain, dissipated, straight) result(work)
      class(contact_path_type), intent(in) :: path
      type(chain_type), intent(in) :: chain
      real(wp), intent(in) :: dissipated, straight(motion_count)
      real(wp) :: work(motion_count), area(motion_count), missing
      integer :: i

      if (allocated(chain%samples)) then
         work = chain%motion_work
         missing = dissipated - chain%by_slopes
      else
         work = straight
         missing = dissipated
         do i = 1, chain%increments
            missing = missing - straight_dissipation(path%model, begin(i), chain%after(i))
         end do
      end if
      area = areas_of(chain)
      if (sum(area) > 0.0_wp) work = work + missing*area/sum(area)

   contains

      !> The fields at the start of increment `i`.
      pure type(contact_fields_type) function begin(i)
         integer, intent(in) :: i

         if (i == 1) begin = chain%before(1)%fields
         if (i > 1) begin = chain%after(i - 1)
      end function begin
   end function work_of_motions

   !> Estimated error of the works of the forces over a chain, force: by the samples, else the largest change of those along
   !> `straight` lines, force, from half as many of these.
   pure real(wp) function error_of_works(chain, straight) result(error)
      type(chain_type), intent(in) :: chain
      real(wp), intent(in) :: straight(motion_count)
      real(wp) :: coarse(motion_count)
      integer :: i

      error = chain%motion_work_error
      if (allocated(chain%samples)) return
      coarse = 0.0_wp
      if (chain%increments > 1) coarse = work_between(chain%before(1)%fields, chain%after(2))
      do i = 4, chain%increments, 2
         coarse = coarse + work_between(chain%after(i - 2), chain%after(i))
      end do
      error = maxval(abs(straight - coarse))

   contains

      pure function work_between(first, last) result(work)
         type(contact_fields_type), intent(in) :: first, last
         real(wp) :: work(motion_count)

         work = 0.5_wp*(first%force + last%force)*(last%motion - first%motion)
      end function work_between
   end function error_of_works

end module mfv_leap
