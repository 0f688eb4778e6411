!> A load interval in equal large increments (a chain), and states between their ends (samples).
!>
!> Each increment starts from the end of the one before. Tractions depend on the path only through the slip at which nodes hold
!> that stick within an increment (mfv_sticking_front), so that few increments suffice for them. The dissipation needs more states:
!> each is found as one increment from the end of the chain's increment before it, without changing the chain.
module mfv_chain
   use mfv_active_set, only: end_of_run, find_rates
   use mfv_chain_dissipation, only: node_wise_dissipation, sample_type
   use mfv_contact_fields, only: contact_fields_type
   use mfv_contact_path, only: contact_path_type, segment_type
   use mfv_contact_state, only: contact_state_type
   use mfv_frictionless, only: find_statuses_on_mesh
   use mfv_kinds, only: wp
   use mfv_motions, only: motion_count, motion_approach, motion_shift, control_force
   use mfv_node_status
   use mfv_tolerances, only: significant
   use mfv_zone_edges, only: zone_type, zones_of
   implicit none
   private
   public :: chain_type, make_chain, add_samples, find_rates_after, is_rough, error_at_start

   !> Where contact begins, event stepping resolves the touching of single nodes. The shear tractions next to that point, or next to
   !> the edge of a contact without slip zones, differ by up to this, relative to the largest traction, over the number of nodes in
   !> contact (0.05 to 0.5 with 50 to 800 nodes in contact, nu from 0 to 0.4 and mu from 0.3 to 1.5). The same is allowed for where
   !> nodes touch later under a changing normal load (0.1 to 0.3 with 200 to 1100 nodes); under a constant one, contact grows where
   !> it slips.
   real(wp), parameter :: error_at_start = 0.5_wp
   !> The same next to a slip zone of fewer than `resolved` nodes, where one more may slip (up to 0.9 with 400 to 2100 nodes and
   !> Dundurs' constant from 0.05 to 0.22), or where nodes touch later and so few slip: the outermost node may have closed and stuck
   !> or not (up to 1.5 with 80 to 400 nodes).
   integer, parameter :: resolved = 3
   real(wp), parameter :: error_of_growth = 1.5_wp

   type :: chain_type
      integer :: increments = 0
      !> States before each increment, with the statuses of that increment; fields after it; shape (increments).
      type(contact_state_type), allocatable :: before(:)
      type(contact_fields_type), allocatable :: after(:)
      !> Evenly spaced states from the start to the end, shape (0:samples), a multiple of `increments`; not allocated: none yet.
      type(sample_type), allocatable :: samples(:)
      !> Friction dissipation of each increment by node_wise_dissipation, force/length, shape (nodes, increments).
      real(wp), allocatable :: friction_work(:, :)
      !> Whether the statuses were found; if not, whether only the mesh was too short.
      logical :: found = .false., exceeded = .false.
      !> Whether contact begins in the interval, and whether the nodes that hold from its start are known.
      logical :: begins = .false., fronts = .false.
      !> Whether these are not, since the contact has many patches of few nodes (is_rough).
      logical :: rough = .false.
      !> Nodes that hold from the start of the last increment, if known, shape (nodes); whether others stick at the end of any.
      logical, allocatable :: held(:)
      logical :: sticks_anew = .false.
      !> Linear solves, and changes of status that event stepping would make one by one.
      integer :: solves = 0, changes = 0
      !> Estimated errors of the final tractions, and their part where contact begins, force/length^2; of the dissipation, force;
      !> the dissipation, force, and the largest traction, force/length^2.
      real(wp) :: traction_error = 0.0_wp, start_error = 0.0_wp, work_error = 0.0_wp, work = 0.0_wp, traction = 0.0_wp
      !> How much the final tractions change, at most, from those of the chain with fewer increments, force/length^2. Zero: there is
      !> no such chain.
      real(wp) :: difference = 0.0_wp
      !> The sum of `friction_work` and its estimated error, force.
      real(wp) :: node_wise = 0.0_wp, node_wise_error = 0.0_wp
      !> The former with half as many increments or samples, force.
      real(wp) :: coarse_node_wise = 0.0_wp
      !> Dissipation and work of the forces of all motions by the samples, force.
      real(wp) :: by_slopes = 0.0_wp, motion_work(motion_count) = 0.0_wp
      !> Estimated error of the latter, force.
      real(wp) :: motion_work_error = huge(1.0_wp)
   end type chain_type

contains

   !> An interval in a number of equal `increments`. `start`: its start with the statuses as the loads begin to change; without
   !> statuses if they are not known. `other`: a chain of the same interval, for a first guess. `path` is unchanged.
   subroutine make_chain(path, interval, increments, start, chain, other)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: interval
      integer, intent(in) :: increments
      type(sample_type), intent(in) :: start
      type(chain_type), intent(out) :: chain
      type(chain_type), intent(in), optional :: other
      type(contact_state_type) :: present_state
      logical, allocatable :: held(:)
      integer, allocatable :: status(:), expected(:)
      integer :: i

      present_state = path%state
      chain%increments = increments
      allocate (chain%before(increments), chain%after(increments))
      allocate (chain%friction_work(size(present_state%status), increments), source=0.0_wp)
      chain%fronts = allocated(start%status)
      chain%begins = .not. any(in_contact(present_state%status))
      chain%solves = -path%system%solves
      do i = 1, increments
         status = path%state%status
         if (chain%fronts) held = holding_before(chain, start, i)
         call guess_end(path, interval, start, chain, i, held, other)
         call expect_statuses(chain, i, expected, other)
         call find_statuses_on_mesh(path, interval, reached(chain, i), chain%after(i), chain%found, chain%exceeded, held, &
                                    chain%begins, expected)
         if (.not. chain%found) exit
         if (chain%fronts) chain%sticks_anew = chain%sticks_anew .or. any(path%state%status == node_stick .and. .not. held)
         chain%changes = chain%changes + count_changes(status, path%state%status)
         chain%before(i) = path%state
         call add_node_wise_work(path, chain, i, path%state, chain%after(i))
         path%state%fields = chain%after(i)
         chain%traction = max(chain%traction, maxval(abs(chain%after(i)%pressure)), maxval(abs(chain%after(i)%shear)))
      end do
      chain%solves = chain%solves + path%system%solves
      if (allocated(held)) call move_alloc(held, chain%held)
      chain%work = chain%node_wise
      if (chain%found) chain%rough = .not. chain%fronts .and. is_rough(path%state%status)
      if (chain%found .and. .not. chain%rough) call find_start_error(path, present_state%status, interval, chain)
      path%state = present_state
   end subroutine make_chain

   !> Whether a contact has many patches of few nodes, whose fronts are not resolved. `status`: shape (nodes).
   pure logical function is_rough(status)
      integer, intent(in) :: status(:)
      integer, parameter :: many = 8, few = 64
      integer :: patches

      patches = count(in_contact(status) .and. .not. eoshift(in_contact(status), -1, .false.))
      is_rough = patches >= many .and. count(in_contact(status)) < few*patches
   end function is_rough

   !> Nodes that hold from the start of increment `i`, shape (nodes).
   pure function holding_before(chain, start, i) result(held)
      type(chain_type), intent(in) :: chain
      type(sample_type), intent(in) :: start
      integer, intent(in) :: i
      logical, allocatable :: held(:)

      if (i == 1) then
         held = start%status == node_stick
      else
         held = chain%before(i - 1)%status == node_stick
      end if
   end function holding_before

   !> Fraction of the interval after i increments. If contact begins, increments are even in the contact width, which for a
   !> parabola grows with the square root of the load.
   pure real(wp) function reached(chain, i)
      type(chain_type), intent(in) :: chain
      integer, intent(in) :: i

      reached = real(i, wp)/real(chain%increments, wp)
      if (chain%begins) reached = reached**2
   end function reached

   !> Add the dissipation from the state `before` to the fields `after`, in increment `i` of a chain, node by node.
   subroutine add_node_wise_work(path, chain, i, before, after)
      class(contact_path_type), intent(in) :: path
      type(chain_type), intent(inout) :: chain
      integer, intent(in) :: i
      type(contact_state_type), intent(in) :: before
      type(contact_fields_type), intent(in) :: after
      real(wp) :: work(size(before%status)), error

      call node_wise_dissipation(path%model, before, after, path%system%tolerance, work, error)
      chain%friction_work(:, i) = chain%friction_work(:, i) + work
      chain%node_wise = chain%node_wise + path%model%force(work)
      chain%node_wise_error = chain%node_wise_error + error
   end subroutine add_node_wise_work

   !> A first guess of the end of increment `i`: the same state of the `other` chain, or of an equal interval before; else a state
   !> midway between two of the other chain, or zones that have grown or begun to slip. `held`: see guess_slip.
   subroutine guess_end(path, interval, start, chain, i, held, other)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: interval
      type(sample_type), intent(in) :: start
      type(chain_type), intent(inout) :: chain
      integer, intent(in) :: i
      logical, intent(in), optional :: held(:)
      type(chain_type), intent(in), optional :: other
      logical :: known, by_pressure
      integer :: next

      chain%after(i) = path%state%fields
      by_pressure = .false.
      known = .false.
      next = 0
      if (present(other)) next = (i*other%increments + chain%increments - 1)/chain%increments
      if (next > 0) known = next*chain%increments == i*other%increments
      if (.not. known) then
         if (chain%fronts .and. .not. chain%begins) call guess_growth(path, interval, reached(chain, i - 1), reached(chain, i))
         if (i == 1) call guess_slip(path, interval, reached(chain, i), chain%after(i), by_pressure, held)
      end if
      if (next > 0 .and. .not. by_pressure) call guess_from(path, other, next, known, start, chain, i)
      if (chain%fronts .and. .not. (chain%begins .or. known)) &
         call guess_as_before(path, interval, i, chain%increments, chain%after(i), known)
   end subroutine guess_end

   !> A first guess of the end of increment `i` from the state `next` of another chain: if that is the same (`known`), or midway to
   !> it. If the slip of touching nodes does not follow from the fronts, only statuses of nodes in contact are guessed.
   subroutine guess_from(path, other, next, known, start, chain, i)
      class(contact_path_type), intent(inout) :: path
      type(chain_type), intent(in) :: other
      integer, intent(in) :: next
      logical, intent(in) :: known
      type(sample_type), intent(in) :: start
      type(chain_type), intent(inout) :: chain
      integer, intent(in) :: i
      integer, dimension(size(path%state%status)) :: before, after

      after = other%before(next)%status
      if (known) then
         call path%set_status(other%fronts .or. in_contact(path%state%status) .and. in_contact(after), after)
         call chain%after(i)%copy_from(other%after(next))
      else if (chain%fronts .and. .not. chain%begins .and. chain%increments == 2*other%increments) then
         before = start%status
         if (i > 1) before = chain%before(i - 1)%status
         call path%set_status(spread(.true., 1, size(after)), statuses_between(before, after))
         chain%after(i) = mean(path%state%fields, other%after(next))
      end if
   end subroutine guess_from

   !> The statuses expected at the end of increment `i` of a chain, those of the `other` chain there; not allocated: unknown. (Of
   !> fronts and where contact begins they are the first guess itself.)
   subroutine expect_statuses(chain, i, expected, other)
      type(chain_type), intent(in) :: chain
      integer, intent(in) :: i
      integer, allocatable, intent(out) :: expected(:)
      type(chain_type), intent(in), optional :: other

      if (chain%fronts .or. chain%begins .or. .not. present(other)) return
      if (modulo(i*other%increments, chain%increments) == 0) expected = other%before(i*other%increments/chain%increments)%status
   end subroutine expect_statuses

   !> The mean of two fields.
   pure type(contact_fields_type) function mean(a, b)
      type(contact_fields_type), intent(in) :: a, b

      mean = a%plus(1.0_wp, b)
      mean = mean%plus(-0.5_wp, mean)
   end function mean

   !> A first guess from the end of part `i` of an equal interval before, if there was one (`known`).
   subroutine guess_as_before(path, interval, i, parts, fields, known)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: interval
      integer, intent(in) :: i, parts
      type(contact_fields_type), intent(inout) :: fields
      logical, intent(out) :: known
      type(sample_type) :: sample

      call path%recent%find(interval%load, size(path%state%status), i, parts, sample, known)
      if (.not. known) return
      call path%set_status(spread(.true., 1, size(sample%status)), sample%status)
      call fields%copy_from(sample%fields)
   end subroutine guess_as_before

   !> Number of nodes that change their status one by one (at a reversal of the load all slipping nodes stick at once).
   pure integer function count_changes(before, after)
      integer, intent(in) :: before(:), after(:)

      count_changes = count(before /= after .and. .not. (slips(before) .and. after == node_stick))
   end function count_changes

   !> Double the number of samples, and sum the dissipation node by node anew; at first take the `start`, with its rates, and the
   !> ends of the increments. `found`: false if a state or its rates are not found. `path` is unchanged.
   subroutine add_samples(path, interval, start, chain, found)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: interval
      type(sample_type), intent(in) :: start
      type(chain_type), intent(inout) :: chain
      logical, intent(out) :: found
      type(sample_type), allocatable :: coarse(:)
      type(contact_state_type) :: present_state
      type(contact_fields_type) :: rates
      integer :: i, solves

      solves = path%system%solves
      present_state = path%state
      if (allocated(chain%samples)) then
         call move_alloc(chain%samples, coarse)
         allocate (chain%samples(0:2*ubound(coarse, 1)))
         chain%samples(0::2) = coarse
         do i = 1, ubound(chain%samples, 1), 2
            call find_sample(path, interval, start, chain, i, found)
            path%state = present_state
            if (.not. found) exit
         end do
         if (found) call sum_samples(path, chain)
      else
         allocate (chain%samples(0:chain%increments))
         chain%samples(0) = start
         do i = 1, chain%increments
            associate (sample => chain%samples(i))
               sample%status = chain%before(i)%status
               sample%fields = chain%after(i)
               call find_rates_after(path, interval, chain, i, .true., rates, found)
               call sample%rates%copy_from(rates)
            end associate
            if (.not. found) exit
         end do
      end if
      chain%solves = chain%solves + path%system%solves - solves
   end subroutine add_samples

   !> Find sample `i`, midway between two known ones. `path` is left at the start of the increment.
   subroutine find_sample(path, interval, start, chain, i, found)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: interval
      type(sample_type), intent(in) :: start
      type(chain_type), intent(inout) :: chain
      integer, intent(in) :: i
      logical, intent(out) :: found
      real(wp) :: fraction
      logical :: exceeded, known
      integer :: increment

      fraction = real(i, wp)/ubound(chain%samples, 1)
      increment = 1 + (i*chain%increments)/ubound(chain%samples, 1)
      if (increment > 1) then
         path%state = chain%before(increment - 1)
         path%state%fields = chain%after(increment - 1)
      end if
      associate (left => chain%samples(i - 1), right => chain%samples(i + 1), sample => chain%samples(i))
         sample%fields = mean(left%fields, right%fields)
         call guess_as_before(path, interval, i, ubound(chain%samples, 1), sample%fields, known)
         ! Between the ends of the interval, which may be far apart.
         if (ubound(chain%samples, 1) == 2 .and. chain%increments == 1 .and. .not. known) &
            call guess_slip(path, interval, fraction, sample%fields, known, holding_before(chain, start, 1))
         if (.not. known) &
            call path%set_status(spread(.true., 1, size(left%status)), statuses_between(left%status, right%status))
         call find_statuses_on_mesh(path, interval, fraction, sample%fields, found, exceeded, &
                                    holding_before(chain, start, increment), chain%begins)
         if (.not. found) return
         sample%status = path%state%status
         path%state%fields = sample%fields
         call find_rates(path, interval, fraction, sample%fields, sample%rates, found)
      end associate
   end subroutine find_sample

   !> A guess of the statuses between two states: edges of contact and of stick zones are midway. Nodes that slip neither before nor
   !> after follow the nearest ones that do.
   pure function statuses_between(before, after) result(status)
      integer, intent(in) :: before(:), after(:)
      integer, dimension(size(before)) :: status, contact, stick
      logical :: slipping(size(before))
      integer :: distance, i, n

      n = size(before)
      contact = midway(merge(1, 0, in_contact(before)), merge(1, 0, in_contact(after)))
      stick = midway(merge(1, 0, before == node_stick), merge(1, 0, after == node_stick))
      status = merge(before, after, slips(before))
      slipping = slips(status)
      where (contact == 0)
         status = node_open
      elsewhere(stick == 1)
         status = node_stick
      end where
      do i = 1, n
         if (contact(i) == 0 .or. stick(i) == 1 .or. slipping(i)) cycle
         status(i) = node_stick
         do distance = 1, n - 1
            if (any(slipping([max(i - distance, 1), min(i + distance, n)]))) exit
         end do
         if (distance == n) cycle
         associate (near => merge(max(i - distance, 1), min(i + distance, n), slipping(max(i - distance, 1))))
            status(i) = merge(before(near), after(near), slips(before(near)))
         end associate
      end do
   end function statuses_between

   !> The values between two states, shape (nodes): where an edge has moved, it is midway.
   pure function midway(before, after) result(status)
      integer, intent(in) :: before(:), after(:)
      integer :: status(size(before)), first, last, half, n
      logical :: from_left, from_right

      n = size(before)
      status = before
      first = 1
      do while (first <= n)
         last = end_of_run(before, after, first)
         half = (last - first + 1)/2
         from_left = .false.
         from_right = .false.
         if (first > 1) then
            from_left = before(first - 1) == after(first)
            from_right = after(first - 1) == before(first)
         end if
         if (last < n) then
            from_left = from_left .or. after(last + 1) == before(first)
            from_right = from_right .or. before(last + 1) == after(first)
         end if
         if (from_left .and. .not. from_right) status(first:first + half - 1) = after(first)
         if (from_right .and. .not. from_left) status(last - half + 1:last) = after(first)
         first = last + 1
      end do
   end function midway

   !> The dissipation of the increments node by node, from sample to sample.
   subroutine sum_samples(path, chain)
      class(contact_path_type), intent(in) :: path
      type(chain_type), intent(inout) :: chain
      type(contact_state_type) :: before
      integer :: i, increment, each

      each = ubound(chain%samples, 1)/chain%increments
      chain%coarse_node_wise = chain%node_wise
      chain%friction_work = 0.0_wp
      chain%node_wise = 0.0_wp
      chain%node_wise_error = 0.0_wp
      do i = 1, ubound(chain%samples, 1)
         increment = 1 + (i - 1)/each
         before = chain%before(increment)
         before%fields = chain%samples(i - 1)%fields
         before%status = chain%samples(i)%status
         where (before%status /= node_stick) before%stuck_slip = before%fields%slip()
         call add_node_wise_work(path, chain, increment, before, chain%samples(i)%fields)
      end do
   end subroutine sum_samples

   !> The rates at the end of increment `i` of a chain, per unit of the interval. `backward`: as the end is reached, where nodes are
   !> stuck that have just arrived at their limit (in a repeated cycle many do so at the very end). `path` is unchanged.
   subroutine find_rates_after(path, interval, chain, i, backward, rates, found)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: interval
      type(chain_type), intent(in) :: chain
      integer, intent(in) :: i
      logical, intent(in) :: backward
      type(contact_fields_type), intent(out) :: rates
      logical, intent(out) :: found
      real(wp), parameter :: just = 1.0e-5_wp
      type(contact_state_type) :: present_state
      real(wp) :: slipped(size(path%state%status))

      present_state = path%state
      path%state = chain%before(i)
      slipped = abs(chain%after(i)%slip() - path%state%stuck_slip)
      call path%set_status(backward .and. slips(path%state%status) .and. slipped <= just*maxval(slipped), &
                           spread(node_stick, 1, size(slipped)))
      path%state%fields = chain%after(i)
      call find_rates(path, interval, reached(chain, i), chain%after(i), rates, found)
      path%state = present_state
   end subroutine find_rates_after

   !> Errors of the tractions where nodes have closed since the statuses `before`, or have stuck next to narrow slip zones. (Nodes
   !> that hold throughout or slip at the end have no memory of the path.)
   subroutine find_start_error(path, before, interval, chain)
      class(contact_path_type), intent(in) :: path
      integer, intent(in) :: before(:)
      type(segment_type), intent(in) :: interval
      type(chain_type), intent(inout) :: chain
      logical :: grown

      grown = any(in_contact(path%state%status) .and. .not. in_contact(before))
      if (.not. (grown .or. chain%sticks_anew)) return
      chain%start_error = error_of_edge(path%state%status, chain%begins, grown .and. abs(interval%load(motion_approach)%rate) > 0, &
                                        path%model%scene%friction%static%largest())*chain%traction
   end subroutine find_start_error

   !> Error of the tractions of a contact that has begun (`begins`) or grown in the interval, relative to the largest, by the
   !> `status` of its nodes: see error_at_start and error_of_growth. An error at the edge of a contact without slip zones is
   !> compared with the friction limit, since it changes the slip zones of later steps. `presses`: whether the normal load
   !> changes; `friction`: the coefficient.
   pure real(wp) function error_of_edge(status, begins, presses, friction) result(error)
      integer, intent(in) :: status(:)
      logical, intent(in) :: begins, presses
      real(wp), intent(in) :: friction
      integer :: i, slipping
      logical :: inside

      error = merge(error_at_start, 0.0_wp, begins .or. presses)
      slipping = 0
      inside = .false.
      do i = 1, size(status)
         if (slips(status(i))) then
            slipping = slipping + 1
            cycle
         end if
         if ((status(i) == node_open .and. inside) .or. (status(i) == node_stick .and. .not. inside)) then
            if (slipping == 0 .and. begins) then
               error = max(error, error_at_start/min(friction, 1.0_wp))
            else if (slipping < resolved) then
               error = max(error, error_of_growth)
            end if
         end if
         inside = status(i) == node_stick
         slipping = 0
      end do
      error = error/max(count(in_contact(status)), 1)
   end function error_of_edge

   !> A first guess of the slipping nodes at a fraction of the interval: they slip in the direction of the tangential load. Under
   !> constant pressures and tangential force control their number is that of Mindlin's contact of cylinders: the edge of the stick
   !> zone is where the pressure is sqrt(Q/(mu P)) of the largest in its patch; after a reversal, with half the change in place of
   !> Q. The opposite force usually reverses all shear, which `fields` then have as a first guess, and has the same stick zones
   !> (Masing). Only nodes stick that hold from the start (`held`), if these are known. `by_pressure`: whether their number follows
   !> from the pressures.
   subroutine guess_slip(path, interval, fraction, fields, by_pressure, held)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: interval
      real(wp), intent(in) :: fraction
      type(contact_fields_type), intent(inout) :: fields
      logical, intent(out) :: by_pressure
      logical, intent(in), optional :: held(:)
      integer, dimension(size(path%state%status)) :: status
      real(wp) :: force, sliding_limit
      logical :: reverses, can_stick(size(path%state%status))

      by_pressure = .false.
      if (.not. abs(interval%load(motion_shift)%rate) > 0.0_wp) return
      status = merge(node_slip_left, node_slip_right, interval%load(motion_shift)%rate > 0.0_wp)
      reverses = any(slips(path%state%status) .and. path%state%status /= status)
      associate (start => path%state%fields, load => interval%load(motion_shift))
         sliding_limit = path%model%force(path%model%static_friction*start%pressure)
         if (load%control /= control_force .or. abs(interval%load(motion_approach)%rate) > 0.0_wp .or. &
             .not. sliding_limit > 0.0_wp) then
            call path%set_status(slips(path%state%status), status)
            return
         end if
         by_pressure = .true.
         force = load%value + fraction*load%rate
         can_stick = .true.
         if (present(held)) can_stick = held
         if (reverses .and. abs(force + start%force(motion_shift)) <= significant*abs(force)) then
            can_stick = can_stick .and. path%state%status == node_stick
            fields%shear = -start%shear
            fields%tangential = -start%tangential
            fields%motion(motion_shift) = -start%motion(motion_shift)
         else
            if (reverses) force = 0.5_wp*(force - start%force(motion_shift))
            force = max(sign(1.0_wp, load%rate)*force, 0.0_wp)
            can_stick = can_stick .and. start%pressure > sqrt(force/sliding_limit)*largest_of_patches(start%pressure)
         end if
         where (can_stick) status = node_stick
      end associate
      call path%set_status(in_contact(path%state%status), status)
   end subroutine guess_slip

   !> A first guess of the statuses after a normal force has grown between two fractions of an interval: zones about the middle of
   !> the contact that have grown with it, as under a cylinder.
   subroutine guess_growth(path, interval, from, to)
      class(contact_path_type), intent(inout) :: path
      type(segment_type), intent(in) :: interval
      real(wp), intent(in) :: from, to
      type(zone_type), allocatable :: patches(:)
      real(wp) :: middle, growth
      integer :: i, n, status(size(path%state%status))

      n = size(status)
      patches = zones_of(in_contact(path%state%status))
      associate (load => interval%load(motion_approach))
         if (load%control /= control_force .or. .not. (load%value + from*load%rate > 0.0_wp .and. load%rate > 0.0_wp)) return
         growth = sqrt((load%value + to*load%rate)/(load%value + from*load%rate))
      end associate
      if (size(patches) /= 1) return
      if (patches(1)%first == 1 .or. patches(1)%last == n) return
      middle = 0.5_wp*(patches(1)%first + patches(1)%last)
      status = path%state%status([(min(max(nint(middle + (i - middle)/growth), 1), n), i=1, n)])
      call path%set_status(path%model%can_touch .or. .not. in_contact(status), status)
   end subroutine guess_growth

   !> The largest pressure of the patch of each node, shape (nodes); a patch has consecutive nodes with a pressure.
   pure function largest_of_patches(pressure) result(largest)
      real(wp), intent(in) :: pressure(:)
      real(wp) :: largest(size(pressure))
      integer :: first, last

      first = 1
      do while (first <= size(pressure))
         last = first
         do while (last < size(pressure))
            if (.not. (pressure(first) > 0.0_wp .and. pressure(last + 1) > 0.0_wp)) exit
            last = last + 1
         end do
         largest(first:last) = maxval(pressure(first:last))
         first = last + 1
      end do
   end function largest_of_patches

end module mfv_chain
