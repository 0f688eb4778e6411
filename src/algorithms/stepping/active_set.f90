!> The statuses at one load, independent of the load history: all nodes that violate an inequality of dissertation Table 2.1 change
!> together, and the system is solved again, until no inequality is violated (the primal-dual active set method: Hintermueller, Ito
!> and Kunisch, SIAM J. Optim. 13, 2003). Without friction the result is the state of every load history. With Coulomb friction
!> nodes that stick throughout hold at the slip of the start, others at the slip that they had when the edge of their zone passed
!> (mfv_sticking_front), or, if it is not known which nodes these are, at the slip of the start or of about first contact.
!>
!> If a zone is slightly too large, its traction (less the friction limit) is K/sqrt(t) + A sqrt(t) at the distance t from its
!> edge; moving the edge by s changes K by A s/2, whatever the other edges do. The edge therefore belongs at twice the distance at
!> which the sign changes. If the zone is too small, it belongs at two thirds of the distance up to which the surfaces overlap. An
!> edge then converges quadratically, and the number of solves hardly depends on the number of nodes. Changing only the violating
!> nodes would just halve the distance.
module mfv_active_set
   use mfv_compliance, only: block_wt
   use mfv_contact_fields, only: contact_fields_type
   use mfv_contact_path, only: contact_path_type, segment_type
   use mfv_contact_state, only: contact_state_type
   use mfv_contact_system
   use mfv_inequalities, only: inequalities, is_required, slack, status_after
   use mfv_kinds, only: pi, wp
   use mfv_motions, only: motions, motion_count, motion_approach, motion_shift, control_force, control_displacement
   use mfv_node_status
   use mfv_sticking_front, only: find_fronts
   use mfv_tolerances, only: significant
   implicit none
   private
   public :: find_statuses, first_guess, find_rates, slipping_back, end_of_run

   !> Violations below this fraction of the largest magnitude of their type are round-off.
   real(wp), parameter :: round_off = 1.0e-11_wp
   !> Most linear solves at one load.
   integer, parameter :: most_solves = 60
   !> Relative error of tractions that intermediate solutions may have, until only a `few` nodes change; where no fronts are known,
   !> this part of the fraction of the contact that has changed, if it is larger.
   real(wp), parameter :: intermediate = 1.0e-6_wp, of_changes = 1.0e-4_wp
   integer, parameter :: few = 2
   !> Most nodes at fronts by which the statuses that the rates require may differ from those that the state does: where the slip at
   !> a front is only nearly as assumed, these alternate. Or one for this number of nodes that have stuck in the increment.
   integer, parameter :: at_fronts = 4, stuck_for_one = 4
   !> Most corrections of the slip that is expected of open nodes, for given statuses.
   integer, parameter :: most_looks = 3

contains

   !> Statuses and fields at the fraction `done` of the segment. The first guess is the statuses of `path` and `fields`; the start
   !> is the fields of `path`. `held`: nodes that hold from the start, while others stick as the edges of their zones move
   !> (mfv_sticking_front), shape (nodes); if absent, all nodes that stick hold at the slip of the start or of first contact.
   !> `in_proportion`: whether zones have grown in proportion to their size (mfv_sticking_front); needed with `held`.
   !> `expected`: statuses for the second solution; the first one shows when nodes touch, shape (nodes).
   !> `found`: whether there are any. `path` then has the statuses, and in stuck_slip the slip from which that of the increment
   !> counts; its fields remain those of the start. If not found, the statuses are invalid: the system is singular, the statuses
   !> cycle (but for a few nodes at fronts), nothing balances a prescribed force, or every node slips.
   subroutine find_statuses(path, segment, done, fields, found, held, in_proportion, expected)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      real(wp), intent(in) :: done
      type(contact_fields_type), intent(inout) :: fields
      logical, intent(out) :: found
      logical, intent(in), optional :: held(:), in_proportion
      integer, intent(in), optional :: expected(:)
      type(constraints_type) :: constraints
      integer, dimension(size(path%state%status)) :: wanted, required
      integer :: tried(size(path%state%status), most_solves)
      real(wp), dimension(size(path%state%status)) :: hold, ahead, before
      type(contact_state_type) :: consistent
      logical :: possible, by_edges, guessed, rough, accurate, is_consistent
      integer :: solve, first, looks, stuck
      real(wp) :: changed

      found = .false.
      rough = segment%allowed < intermediate
      by_edges = .true.
      first = 1
      hold = path%state%fields%slip()
      where (path%state%status == node_stick) hold = path%state%stuck_slip
      path%state%stuck_slip = hold
      ahead = 0.0_wp
      looks = 0
      changed = 1.0_wp
      do solve = 1, most_solves
         tried(:, solve) = path%state%status
         call constrain(path, segment, done, constraints, possible)
         if (.not. possible) return
         path%state%stuck_slip = hold
         if (rough) constraints%allowed = intermediate
         if (rough .and. .not. present(held)) constraints%allowed = max(intermediate, of_changes*changed)
         call solve_with_fronts(path, constraints, path%state%stuck_slip, ahead, fields, possible, held, in_proportion)
         if (.not. possible) return
         call find_wanted(path, segment, fields, wanted, held)
         if (.not. present(held)) call slip_on_return(path, fields, any(in_contact(tried(:, :solve)), dim=2), wanted)
         guessed = solve == 1 .and. present(expected)
         if (guessed) wanted = expected
         found = all(wanted == path%state%status)
         is_consistent = found
         accurate = .not. rough .or. path%system%tolerance <= max(round_off, segment%allowed)
         if (.not. accurate .and. count(wanted /= path%state%status) <= few) then
            rough = .false.
            first = solve + 1
            if (found) cycle
         end if
         if (present(held)) then
            before = ahead
            if (count(in_contact(wanted) .neqv. in_contact(path%state%status)) <= few .and. &
                (found .or. any(path%state%status == node_stick .and. .not. held))) &
               call find_returning(path, segment, fields, held, wanted, ahead)
            if (looks < most_looks .and. maxval(abs(ahead - before)) > same_slip(path)*maxval(abs(fields%slip()))) then
               ! Tractions at an edge hardly mean anything before this slip is known: no status changes by them.
               looks = looks + 1
               cycle
            end if
         end if
         if (all(wanted == path%state%status)) then
            if (present(held)) then
               call find_slipping_on(path, segment, fields, held, wanted)
               found = .not. reverses(path, fields, held)
            end if
            if (all(wanted == path%state%status)) return
            found = .false.
         end if
         if (present(held) .and. accurate .and. is_consistent) then
            stuck = count(path%state%status == node_stick .and. .not. held)
            if (count(wanted /= path%state%status) <= max(at_fronts, stuck/stuck_for_one)) call keep(path, fields, consistent)
         end if
         if (by_edges .and. .not. guessed) then
            required = wanted
            call move_edges(path%state%status, wanted, held)
            ! Edges that were moved too far would cycle.
            if (is_among(wanted, tried(:, first:solve)) .and. .not. (found .or. allocated(consistent%status))) then
               by_edges = .false.
               first = solve + 1
               wanted = required
            end if
         end if
         if (found .and. is_among(wanted, tried(:, :solve))) then
            found = .not. reverses(path, fields, held)
            return
         end if
         found = .false.
         call find_touching(path, fields, wanted, hold)
         looks = 0
         changed = min(1.0_wp, real(count(wanted /= path%state%status), wp)/max(count(in_contact(wanted)), 1))
         call path%set_status(wanted /= path%state%status, wanted)
         path%state%stuck_slip = hold
         if (.not. is_among(wanted, tried(:, first:solve))) cycle
         if (allocated(consistent%status)) then
            call path%set_status(consistent%status /= path%state%status, consistent%status)
            path%state%stuck_slip = consistent%stuck_slip
            fields = consistent%fields
            found = .not. reverses(path, fields, held)
         end if
         if (found .or. .not. by_edges) return
         by_edges = .false.
         first = solve + 1
      end do
      found = .false.
   end subroutine find_statuses

   !> If shear causes normal displacements, nodes that close again slip: stuck they pulled, since their slip is far from that at
   !> which they would hold. `closed`: nodes that were in contact before, shape (nodes).
   pure subroutine slip_on_return(path, fields, closed, wanted)
      class(contact_path_type), intent(in) :: path
      type(contact_fields_type), intent(in) :: fields
      logical, intent(in) :: closed(:)
      integer, intent(inout) :: wanted(:)

      if (.not. path%model%compliance%has_block(block_wt)) return
      where (wanted == node_stick .and. closed .and. .not. in_contact(path%state%status)) &
         wanted = merge(node_slip_right, node_slip_left, fields%slip() > path%state%stuck_slip)
   end subroutine slip_on_return

   !> Keep the statuses of a state, its `fields` and the slip at which its nodes hold.
   subroutine keep(path, fields, kept)
      class(contact_path_type), intent(in) :: path
      type(contact_fields_type), intent(in) :: fields
      type(contact_state_type), intent(inout) :: kept

      kept%status = path%state%status
      kept%stuck_slip = path%state%stuck_slip
      kept%fields = fields
   end subroutine keep

   !> Solve for the fields at the end of an increment, which contain a first guess. `hold`: the slip at which nodes hold, length,
   !> shape (nodes); that of nodes at which an edge has passed follows from the solution, if `held` is present (see find_statuses).
   !> `ahead`: from find_returning. `solved`: false if the system is singular.
   subroutine solve_with_fronts(path, constraints, hold, ahead, fields, solved, held, in_proportion)
      class(contact_path_type), intent(inout) :: path
      type(constraints_type), intent(inout) :: constraints
      real(wp), intent(inout) :: hold(:)
      real(wp), intent(in) :: ahead(:)
      type(contact_fields_type), intent(inout) :: fields
      logical, intent(out) :: solved
      logical, intent(in), optional :: held(:), in_proportion
      type(front_type) :: front(size(hold))
      type(response_type) :: response
      real(wp) :: slip(size(hold))
      logical :: singular

      if (present(held)) then
         associate (start => path%state%fields)
            call find_fronts(path%state%status, held,.not. start%pressure > 0.0_wp, start, &
                             merge(path%model%initial_gap - path%model%rigid_normal(start), path%model%gap(start), in_proportion), &
                             ahead, in_proportion, hold, front)
         end associate
         if (any(front%node > 0)) constraints%front = front
      end if
      constraints%stuck_slip = hold
      call path%system%solve(path%model, constraints, fields, response, singular)
      solved = .not. singular
      if (singular) return
      fields = response%state
      slip = fields%slip()
      where (front%node > 0) hold = hold + front%weight*slip(max(front%node, 1))
   end subroutine solve_with_fronts

   !> Slips that differ by less than this fraction of the largest are the same.
   pure real(wp) function same_slip(path)
      class(contact_path_type), intent(in) :: path
      real(wp), parameter :: same = 1.0e-7_wp, negligible = 1.0e-4_wp

      same_slip = max(same, path%system%tolerance, negligible*path%model%scene%method%accuracy)
   end function same_slip

   !> Nodes that slip, but would slip back at the end of the increment, stick in `wanted`: the edge of a stick zone has passed them.
   !> The zone is then too small, and its nodes stay stuck but for those of `held`, since the shear traction exceeds the limit in
   !> zones that are too small as well as in those that are too large. `ahead`: how far open nodes next to stuck ones will slip
   !> until they touch, at the rates of the end; length, shape (nodes). Only this is found if nodes open or close in `wanted`, and
   !> nothing is changed if the rates are not determined.
   subroutine find_returning(path, segment, fields, held, wanted, ahead)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      type(contact_fields_type), intent(in) :: fields
      logical, intent(in) :: held(:)
      integer, intent(inout) :: wanted(:)
      real(wp), intent(inout) :: ahead(:)
      type(contact_fields_type) :: rates
      real(wp), dimension(size(wanted)) :: gap, gap_rate
      logical :: found, returns(size(wanted)), next(size(wanted))

      associate (status => path%state%status)
         next = status == node_open .and. (eoshift(status, -1, node_open) == node_stick .or. &
                                           eoshift(status, 1, node_open) == node_stick)
         if (.not. any(slips(status) .and. .not. held) .and. .not. any(next)) return
         if (.not. any(holds(status))) return
         call find_rates(path, segment, 1.0_wp, fields, rates, found)
         if (.not. found) return
         gap = path%model%gap(fields)
         gap_rate = path%model%gap(fields%plus(1.0_wp, rates)) - gap
         ahead = 0.0_wp
         where (next .and. gap_rate < 0.0_wp) ahead = -rates%slip()*gap/gap_rate
         if (any(in_contact(wanted) .neqv. in_contact(status))) return
         returns = slipping_back(path, status, rates)
         if (.not. any(returns)) return
         where (returns) wanted = node_stick
         where (status == node_stick .and. slips(wanted) .and. .not. held) wanted = node_stick
      end associate
   end subroutine find_returning

   !> Nodes that stick, but slipped at the start and would slip on at the end, slip in `wanted`: no edge of a stick zone has passed
   !> them. (The slip at which they hold follows from this assumption, so that their shear tractions do not contradict it.)
   subroutine find_slipping_on(path, segment, fields, held, wanted)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      type(contact_fields_type), intent(in) :: fields
      logical, intent(in) :: held(:)
      integer, intent(inout) :: wanted(:)
      type(contact_fields_type) :: rates
      integer, dimension(size(wanted)) :: status, slipping
      logical :: anew(size(wanted)), found

      anew = path%state%status == node_stick .and. .not. held .and. path%state%fields%pressure > 0.0_wp
      if (.not. any(anew)) return
      status = path%state%status
      slipping = merge(merge(node_slip_left, node_slip_right, fields%shear > 0.0_wp), status, anew)
      if (.not. any(holds(slipping)) .and. segment%load(motion_shift)%control == control_force) return
      path%state%status = slipping
      call find_rates(path, segment, 1.0_wp, fields, rates, found)
      path%state%status = status
      if (.not. found) return
      where (anew .and. slipping_along(path, slip_sign(slipping), rates)) wanted = slipping
   end subroutine find_slipping_on

   !> The rates at the fraction `done` of the segment, per unit of load, for the statuses of `path`. `fields`: the fields there, a
   !> first guess. `found`: whether the statuses determine them.
   subroutine find_rates(path, segment, done, fields, rates, found)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: segment
      real(wp), intent(in) :: done
      type(contact_fields_type), intent(in) :: fields
      type(contact_fields_type), intent(out) :: rates
      logical, intent(out) :: found
      type(constraints_type) :: constraints
      type(response_type) :: response
      logical :: singular

      call path%loads_at(segment, done, constraints)
      call path%set_rows(constraints, .false.)
      constraints%kind = rates_at_end
      constraints%rates_only = .true.
      call path%system%solve(path%model, constraints, fields, response, singular)
      found = .not. singular
      if (found) rates = response%rate
   end subroutine find_rates

   !> The nodes that slip by their `status`, but slip back at the given rates, shape (nodes).
   pure function slipping_back(path, status, rates) result(back)
      class(contact_path_type), intent(in) :: path
      integer, intent(in) :: status(:)
      type(contact_fields_type), intent(in) :: rates
      logical :: back(size(status))

      back = slipping_along(path, -slip_sign(status), rates)
   end function slipping_back

   !> The nodes that slip in a `direction` (1, -1; 0: none) at the given rates, shape (nodes).
   pure function slipping_along(path, direction, rates) result(along)
      class(contact_path_type), intent(in) :: path
      integer, intent(in) :: direction(:)
      type(contact_fields_type), intent(in) :: rates
      logical :: along(size(direction))
      real(wp) :: slip(size(along))

      slip = rates%slip()
      along = direction*slip > max(significant, path%system%rate_tolerance)*maxval(abs(slip))
   end function slipping_along

   !> Whether a node that was slipping at the start slips against its slip over the increment: it has stuck in between, where no
   !> front is known to have passed.
   pure logical function reverses(path, fields, held)
      class(contact_path_type), intent(in) :: path
      type(contact_fields_type), intent(in) :: fields
      logical, intent(in) :: held(:)
      real(wp), dimension(size(held)) :: slipped
      real(wp) :: tolerance

      slipped = fields%slip() - path%state%fields%slip()
      tolerance = max(round_off, path%system%tolerance)*maxval(abs(fields%slip()))
      reverses = any(-slip_sign(path%state%status)*slipped > tolerance .and. path%state%fields%pressure > 0.0_wp .and. .not. held)
   end function reverses

   !> A first guess of the contact: nodes at which the undeformed surfaces overlap at an approach of P/(pi m), m the contact
   !> modulus (exact for a parabola under the force P). `fraction`: fraction of the segment.
   subroutine first_guess(path, segment, fraction, contact)
      class(contact_path_type), intent(in) :: path
      type(segment_type), intent(in) :: segment
      real(wp), intent(in) :: fraction
      logical, intent(out) :: contact(:)
      real(wp), parameter :: deformed = 0.25_wp
      real(wp), dimension(size(contact)) :: gap, normal, tangential
      type(contact_fields_type) :: fields
      real(wp) :: level
      logical :: turned(motion_count)

      fields = path%state%fields
      turned = motions%optional .and. path%model%moves .and. segment%load%control == control_displacement
      if (any(turned)) then
         where (turned) fields%motion = segment%load%value + fraction*segment%load%rate
         call path%model%relative_displacements(fields, normal, tangential)
         fields%normal = normal
      end if
      gap = path%model%gap(fields)
      level = segment%load(motion_approach)%value + fraction*segment%load(motion_approach)%rate
      if (segment%load(motion_approach)%control == control_force) then
         level = level/(pi*path%model%compliance%modulus)
      else
         level = deformed*(level - fields%motion(motion_approach) - path%model%nearest_approach(gap))
      end if
      level = max(level, 0.0_wp) + path%model%nearest_approach(gap) + 8*epsilon(1.0_wp)*maxval(abs(gap))
      contact = path%model%can_touch .and. gap <= level*path%model%normal_arm(:, motion_approach)
   end subroutine first_guess

   !> The constraints at the fraction `done` of the segment, without rates. `possible`: false if nothing balances a prescribed
   !> force (moment), or if every node slips under a prescribed tangential force.
   subroutine constrain(path, segment, done, constraints, possible)
      class(contact_path_type), intent(in) :: path
      type(segment_type), intent(in) :: segment
      real(wp), intent(in) :: done
      type(constraints_type), intent(out) :: constraints
      logical, intent(out) :: possible
      real(wp), parameter :: no_force = 1.0e-12_wp
      real(wp) :: scale
      integer :: i

      call path%loads_at(segment, done, constraints)
      constraints%load%rate = 0.0_wp
      call path%set_rows(constraints, .false.)
      possible = any(in_contact(path%state%status)) .or. constraints%load(motion_approach)%control == control_displacement
      do i = 1, motion_count
         if (motions(i)%optional .and. path%model%moves(i) .and. constraints%load(i)%control == control_force) &
            possible = possible .and. path%model%lifts(i) .and. path%state%contact_nodes() > 1
      end do
      if (any(holds(path%state%status)) .or. constraints%load(motion_shift)%control == control_displacement) return
      scale = max(path%certificate%force_scale(motion_approach), abs(constraints%load(motion_approach)%value))
      possible = possible .and. .not. any(slips(path%state%status)) .and. &
                 max(abs(constraints%load(motion_shift)%value), abs(segment%load(motion_shift)%rate)) <= no_force*scale
      constraints%load(motion_shift) = load_type(control_displacement, path%state%fields%motion(motion_shift), 0.0_wp)
   end subroutine constrain

   !> The statuses that the `fields` require: nodes change where an inequality is violated. `held`: see find_statuses; the slip of
   !> other nodes since first contact is then not known here (find_returning).
   subroutine find_wanted(path, segment, fields, wanted, held)
      class(contact_path_type), intent(in) :: path
      type(segment_type), intent(in) :: segment
      type(contact_fields_type), intent(in) :: fields
      integer, intent(out) :: wanted(:)
      logical, intent(in), optional :: held(:)
      real(wp), parameter :: missed = 3.0_wp
      real(wp), dimension(size(wanted)) :: gap, slipped
      real(wp) :: traction, motion, tolerance, allowed(size(inequalities))
      logical :: violated(size(inequalities))
      integer :: i, closed

      tolerance = max(round_off, path%system%tolerance)
      traction = tolerance*max(maxval(abs(fields%pressure)), maxval(abs(fields%shear)), path%certificate%traction_scale)
      motion = round_off*max(maxval(abs(fields%normal)), maxval(abs(fields%tangential)), abs(fields%motion(motion_approach)), &
                             abs(fields%motion(motion_shift)))
      gap = path%model%gap(fields)
      slipped = 0.0_wp
      if (path%model%tangential) slipped = fields%slip() - path%state%stuck_slip
      ! An iterative solution misses the equalities; inequalities are not more accurate.
      motion = max(motion, missed*max(0.0_wp, maxval(abs(gap), mask=in_contact(path%state%status)), &
                                      maxval(abs(slipped), mask=path%state%status == node_stick)))
      if (present(held)) slipped = merge(slipped, 0.0_wp, held)
      closed = node_frictionless
      if (segment%friction .and. path%model%tangential) closed = node_stick
      wanted = path%state%status
      allowed = merge(motion, traction, inequalities == event_close .or. inequalities == event_stick)
      do i = 1, size(wanted)
         violated = is_required(inequalities, wanted(i)) .and. &
                    slack(inequalities, gap(i), fields%pressure(i), fields%shear(i), &
                          path%model%static_friction(i)*fields%pressure(i), slip_sign(wanted(i))*slipped(i)) < -allowed
         if (.not. path%model%can_touch(i)) violated = violated .and. inequalities /= event_close
         ! With a pressure below zero by round-off a shear traction is beyond both limits: the node slips the way of its own.
         violated = violated .and. inequalities /= merge(event_slip_right, event_slip_left, fields%shear(i) > 0.0_wp)
         if (any(violated)) wanted(i) = status_after(inequalities(findloc(violated, .true., dim=1)), wanted(i), &
                                                     closed == node_stick, 0, node_stick)
      end do
      if (closed == node_stick) call follow_neighbours(path%state%status, wanted)
   end subroutine find_wanted

   !> The slip at which closing nodes hold: that at first contact, if gap and slip change linearly from the start to the `fields`,
   !> in which these nodes are still open.
   subroutine find_touching(path, fields, wanted, hold)
      class(contact_path_type), intent(in) :: path
      type(contact_fields_type), intent(in) :: fields
      integer, intent(in) :: wanted(:)
      real(wp), intent(inout) :: hold(:)
      real(wp), dimension(size(wanted)) :: before, after, slip

      if (.not. path%model%tangential) return
      before = max(path%model%gap(path%state%fields), 0.0_wp)
      after = path%model%gap(fields)
      slip = path%state%fields%slip()
      where (in_contact(wanted) .and. .not. in_contact(path%state%status) .and. after < 0.0_wp) &
         hold = slip + before/(before - after)*(fields%slip() - slip)
   end subroutine find_touching

   !> Nodes that close at an edge of the contact get the status of the edge.
   pure subroutine follow_neighbours(status, wanted)
      integer, intent(in) :: status(:)
      integer, intent(inout) :: wanted(:)
      integer :: i, n

      n = size(status)
      do i = 2, n
         if (closes(i) .and. in_contact(wanted(i - 1))) wanted(i) = wanted(i - 1)
      end do
      do i = n - 1, 1, -1
         if (closes(i) .and. in_contact(status(i + 1))) wanted(i) = wanted(i + 1)
         if (closes(i) .and. closes(i + 1) .and. wanted(i) == node_stick) wanted(i) = wanted(i + 1)
      end do

   contains

      pure logical function closes(node)
         integer, intent(in) :: node

         closes = .not. in_contact(status(node)) .and. in_contact(wanted(node))
      end function closes
   end subroutine follow_neighbours

   !> The last of the nodes from `first` on that all have its two statuses.
   pure integer function end_of_run(one, other, first) result(last)
      integer, intent(in) :: one(:), other(:), first

      last = first
      do while (last < size(one))
         if (one(last + 1) /= one(first) .or. other(last + 1) /= other(first)) exit
         last = last + 1
      end do
   end function end_of_run

   !> If the changing nodes lie at one edge of their zone, move the edge to where it belongs (see above). `held`: see find_statuses.
   subroutine move_edges(status, wanted, held)
      integer, intent(in) :: status(:)
      integer, intent(inout) :: wanted(:)
      logical, intent(in), optional :: held(:)
      integer :: original(size(wanted)), first, last, n
      logical :: left, right

      n = size(status)
      original = wanted
      first = 1
      do while (first <= n)
         last = first
         if (original(first) /= status(first)) then
            last = end_of_run(status, original, first)
            left = .true.
            right = .true.
            if (first > 1) left = status(first - 1) /= status(first)
            if (last < n) right = status(last + 1) /= status(first)
            if (grows(status(first), original(first))) then
               if (first == 1) left = .false.
               if (last == n) right = .false.
               call stay_behind(first, last, left, right)
            else if (at_front(first, last)) then
               call stay_behind(first, last, left, right)
            else
               call go_further(first, last, left, right)
            end if
         end if
         first = last + 1
      end do

   contains

      !> Whether nodes that begin to slip lie at an edge that the slip of the zone follows. Its traction exceeds the limit as
      !> t^(3/2) - 3/2 s t^(1/2), if the zone is too large by s: the edge belongs at two thirds of the distance.
      pure logical function at_front(first, last)
         integer, intent(in) :: first, last

         at_front = .false.
         if (present(held)) at_front = status(first) == node_stick .and. slips(original(first)) .and. .not. all(held(first:last))
      end function at_front

      !> Whether the change enlarges a zone of contact or of stick.
      pure logical function grows(from, to)
         integer, intent(in) :: from, to

         grows = from == node_open .or. to == node_stick
      end function grows

      !> The zone that the nodes first to last leave shrinks further, by at most half of its rest.
      subroutine go_further(first, last, left, right)
         integer, intent(in) :: first, last
         logical, intent(in) :: left, right
         integer :: step, node, further, room

         if (left .eqv. right) return
         step = merge(1, -1, left)
         node = merge(last, first, left)
         room = 0
         do
            if (node + (room + 1)*step < 1 .or. node + (room + 1)*step > n) exit
            if (status(node + (room + 1)*step) /= status(node) .or. &
                original(node + (room + 1)*step) /= status(node)) exit
            room = room + 1
         end do
         do further = 1, min(last - first, room/2)
            wanted(node + further*step) = original(node)
         end do
      end subroutine go_further

      !> The zone that the nodes first to last join gets the nearer two thirds of them.
      subroutine stay_behind(first, last, left, right)
         integer, intent(in) :: first, last
         logical, intent(in) :: left, right
         integer :: joining

         if (left .eqv. right) return
         joining = (2*(last - first + 1) + 1)/3
         if (left) wanted(first + joining:last) = status(first + joining:last)
         if (right) wanted(first:last - joining) = status(first:last - joining)
      end subroutine stay_behind
   end subroutine move_edges

end module mfv_active_set
