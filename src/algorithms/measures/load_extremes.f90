!> Extremes over a stretch of the load history, such as its last cycle, from the states at the ends of its load segments: the value,
!> where it is, and in which row.
!>
!> Largest stresses need a search in each state (mfv_stress_search), which costs more than a load segment. Estimates of them (1 %
!> too small as a median, and less sensitive to slip zones of one or two nodes) find the state that is worth it. The surface
!> stress follows from p, tau and the integrals of p/(t - x) dt and tau/(t - x) dt (mfv_interior_half_plane). At an edge of the
!> contact both vanish as a root: in each interval they are taken as proportional to root((t - l)(r - t)), between the edges l and
!> r, whose integrals are elementary.
module mfv_load_extremes
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
   use mfv_body, only: body_type
   use mfv_contact_model, only: contact_model_type
   use mfv_contact_state, only: contact_state_type
   use mfv_element_tree, only: element_tree_type, new_straight_tree
   use mfv_interior, only: has_interior, interior_type, von_mises_stress
   use mfv_interior_half_plane, only: line_load_stress, surface_stress_of
   use mfv_kinds, only: pi, wp
   use mfv_motions, only: bulk_motions, motion_approach, motion_shift, motion_count
   use mfv_node_status, only: in_contact
   use mfv_state_interior, only: state_interior
   use mfv_stress_search, only: depths_below, estimate_in_layers, find_largest_at_interfaces, largest_type
   use mfv_tolerances, only: significant, visible
   use mfv_zone_edges, only: find_patches, largest_shear, outermost_edges, patch_type, rises_at_end, zone_edges_type
   implicit none
   private
   public :: extreme_type, load_extremes_type, slip_range_type, candidate_count, candidate_tension, candidate_von_mises, &
             most_rows, add_estimate, is_same_estimate, over_steps, over_cycle, over_rows

   !> Stretches: steps without cycles, a cycle, rows of &history.
   integer, parameter :: over_steps = 1, over_cycle = 2, over_rows = 3

   !> Stresses that need a search, of the lower and the upper body.
   integer, parameter :: candidate_tension(2) = [1, 2], candidate_von_mises(2) = [3, 4], candidate_count = 4
   !> Most rows of each, those with the largest estimates, in which they are searched for; and in all.
   integer, parameter :: rows_of(candidate_count) = [5, 5, 3, 3], most_rows = 5
   !> Estimates that differ by less, relative to their values, are of the same state.
   real(wp), parameter :: same = visible
   !> Extremes that differ by less, relative to their values, are equal: the first row counts.
   real(wp), parameter :: round_off = significant

   !> A value, its place (x and y, lengths) and its row, see load_extremes_type; 0: none yet. Of a tension or pressure also the
   !> largest one at another place, farther than an interval, of any row.
   type :: extreme_type
      real(wp) :: value = 0.0_wp, x = 0.0_wp, y = 0.0_wp
      integer :: row = 0
      real(wp) :: rival = -huge(1.0_wp), rival_x = 0.0_wp
   contains
      procedure :: raise
      procedure :: raise_with_rival
      procedure :: compete
   end type extreme_type

   !> Extremes since the start of a stretch. A row is the number of the step, of the turning point in the cycle, or of the row of
   !> &history.
   type :: load_extremes_type
      !> See over_steps; and the step in which the stretch began.
      integer :: stretch = over_steps, step = 0
      type(extreme_type) :: pressure, shear, lowest_stick, highest_stick, slip_range
      !> Largest tension along the surface of each body, and von Mises stress in it, where searched for.
      type(extreme_type) :: searched(candidate_count)
      !> Largest tension and shear at the interfaces of the layers of each body.
      type(extreme_type) :: interface_tension(2), interface_shear(2)
      !> Rows that may have these, 0 for none, and the estimates in them, force/length^2.
      integer :: row(most_rows, candidate_count) = 0
      real(wp) :: estimate(most_rows, candidate_count) = -1.0_wp
      !> Whether the largest pressure of a finer mesh may be at the end of a surface, without limit.
      logical :: at_end = .false.
      !> The last row, the motions of its state, and the largest tensions in it, where searched for (row 0: not).
      integer :: last_row = 0
      real(wp) :: last_motion(motion_count) = 0.0_wp
      type(extreme_type) :: last_tension(2)
   contains
      procedure :: add_state
      procedure :: knows_tension
      procedure :: is_repeated
   end type load_extremes_type

   !> Smallest and largest slip of every node while in contact, lengths, shape (nodes); `added`: see contact_model_type.
   type :: slip_range_type
      real(wp), allocatable :: lowest(:), highest(:)
      integer :: added = 0
   contains
      procedure :: widen
      procedure :: add => add_slip
   end type slip_range_type

   !> Tractions at some places of the surface: arc lengths; p, tau, and 1/pi integral of p/(t - x) dt, where a body needs it, and of
   !> tau/(t - x) dt, force/length^2; (places).
   type :: surface_samples_type
      real(wp), allocatable :: arc(:), pressure(:), shear(:), of_pressure(:), of_shear(:)
   end type surface_samples_type

contains

   !> Take a larger value, or NaN for an unbounded one. `row`, `x`, `y`: where it is. Of equal ones the first row counts.
   pure subroutine raise(self, value, row, x, y)
      class(extreme_type), intent(inout) :: self
      real(wp), intent(in) :: value
      integer, intent(in) :: row
      real(wp), intent(in), optional :: x, y

      if (self%row > 0) then
         if (ieee_is_nan(self%value)) return
         if (.not. ieee_is_nan(value)) then
            if (value <= self%value - round_off*abs(self%value)) return
            if (value <= self%value + round_off*abs(self%value) .and. row > self%row) return
         end if
      end if
      self%value = value
      self%row = row
      if (present(x)) self%x = x
      if (present(y)) self%y = y
   end subroutine raise

   !> Take a larger value, as above; the smaller one may be the rival, see compete.
   pure subroutine raise_with_rival(self, value, row, interval, x, y)
      class(extreme_type), intent(inout) :: self
      real(wp), intent(in) :: value, interval, x
      integer, intent(in) :: row
      real(wp), intent(in), optional :: y
      type(extreme_type) :: before

      before = self
      call self%raise(value, row, x, y)
      if (before%row > 0) call self%compete(before%value, before%x, interval)
      call self%compete(value, x, interval)
   end subroutine raise_with_rival

   !> Keep the largest of a value and the present rival as the rival, if farther than `interval` from the place of the extreme.
   pure subroutine compete(self, value, x, interval)
      class(extreme_type), intent(inout) :: self
      real(wp), intent(in) :: value, x, interval

      if (.not. abs(self%rival_x - self%x) > interval) self%rival = -huge(1.0_wp)
      if (.not. (abs(x - self%x) > interval .and. value > self%rival)) return
      self%rival = value
      self%rival_x = x
   end subroutine compete

   !> Whether the largest tension of the body number `side` has been searched for in this state, the last one.
   pure logical function knows_tension(self, side, state) result(knows)
      class(load_extremes_type), intent(in) :: self
      integer, intent(in) :: side
      type(contact_state_type), intent(in) :: state

      knows = self%last_tension(side)%row > 0 .and. .not. any(abs(state%fields%motion - self%last_motion) > 0.0_wp)
   end function knows_tension

   !> Add the state at the end of a load segment. `slip`: of the stretch so far. `friction`: whether friction acts in the segment.
   !> `place`: where it is among the rows of each stress, 0 if it is not; shape (candidate_count).
   subroutine add_state(self, model, state, slip, row, friction, place)
      class(load_extremes_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: state
      type(slip_range_type), intent(inout) :: slip
      integer, intent(in) :: row
      logical, intent(in) :: friction
      integer, intent(out) :: place(:)
      type(patch_type), allocatable :: patches(:)
      type(zone_edges_type) :: edges
      real(wp) :: shear, estimates(candidate_count), arc
      integer :: i

      self%last_row = row
      self%last_motion = state%fields%motion
      self%last_tension = extreme_type()
      call find_patches(model, state, patches)
      edges = outermost_edges(patches)
      self%at_end = self%at_end .or. rises_at_end(model, state, patches)
      if (edges%contact) call self%pressure%raise_with_rival(maxval(state%fields%pressure), row, model%interval(), &
                                                             place_of_largest(model%x, state%fields%pressure))
      if (model%tangential) then
         do i = 1, size(patches)
            shear = largest_shear(model, state, patches(i), arc)
            call self%shear%raise(shear, row, model%scene%x_of_arc(arc))
         end do
         call slip%add(model, state)
         associate (ranges => slip%highest - slip%lowest)
            if (any(ranges >= 0.0_wp)) call self%slip_range%raise(maxval(ranges), row, place_of_largest(model%x, ranges))
         end associate
      end if
      if (model%tangential .and. friction .and. edges%contact) then
         call self%highest_stick%raise(edges%stick_ratio(), row)
         call lower(self%lowest_stick, edges%stick_ratio(), row)
      end if
      call estimate_stresses(model, state, patches, estimates)
      call add_interfaces(self, model, state, row, estimates)
      do i = 1, candidate_count
         call add_estimate(self%estimate(:rows_of(i), i), estimates(i), place(i))
         if (place(i) > 0) self%row(place(i), i) = row
      end do
   end subroutine add_state

   !> Add the tractions at the interfaces of layers; estimate the other stresses of bodies with layers by those of some points.
   subroutine add_interfaces(self, model, state, row, estimates)
      class(load_extremes_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: state
      integer, intent(in) :: row
      real(wp), intent(inout) :: estimates(:)
      type(interior_type) :: interior
      type(largest_type) :: tension, shear
      logical :: available
      integer :: side

      do side = 1, 2
         if (.not. model%scene%has_layers(side == 2)) cycle
         call state_interior(model, state, side == 2, interior, available)
         call find_largest_at_interfaces(interior, tension, shear)
         if (tension%value > 0.0_wp) call self%interface_tension(side)%raise(tension%value, row, tension%x, tension%y)
         call self%interface_shear(side)%raise(shear%value, row, shear%x, shear%y)
         call estimate_in_layers(interior, estimates(candidate_tension(side)), estimates(candidate_von_mises(side)))
      end do
   end subroutine add_interfaces

   !> Put an estimate among the largest ones, in place of the smallest; negative: none. `place`: where, 0 if it is not among them or
   !> equal to one.
   pure subroutine add_estimate(largest, estimate, place)
      real(wp), intent(inout) :: largest(:)
      real(wp), intent(in) :: estimate
      integer, intent(out) :: place

      place = 0
      if (.not. estimate >= 0.0_wp .or. any(largest >= 0.0_wp .and. is_same_estimate(largest, estimate))) return
      if (.not. estimate > minval(largest)) return
      place = minloc(largest, dim=1)
      largest(place) = estimate
   end subroutine add_estimate

   !> Whether two estimates may be of the same state.
   elemental logical function is_same_estimate(one, other)
      real(wp), intent(in) :: one, other

      is_same_estimate = abs(one - other) <= same*other
   end function is_same_estimate

   !> x of the largest value at the nodes: the middle of neighbouring nodes with the same value.
   pure real(wp) function place_of_largest(x, values) result(place)
      real(wp), intent(in) :: x(:), values(:)
      real(wp) :: least
      integer :: first, last

      least = maxval(values) - round_off*abs(maxval(values))
      first = findloc(values >= least, .true., dim=1)
      last = first
      do while (last < size(x))
         if (values(last + 1) < least) exit
         last = last + 1
      end do
      place = 0.5_wp*(x(first) + x(last))
   end function place_of_largest

   !> Whether a stretch repeats the `other` one as far as the search for a stress is concerned.
   pure logical function is_repeated(self, other, candidate)
      class(load_extremes_type), intent(in) :: self
      type(load_extremes_type), intent(in) :: other
      integer, intent(in) :: candidate

      associate (here => self%estimate(:, candidate), there => other%estimate(:, candidate))
         is_repeated = self%step == other%step .and. all(self%row(:, candidate) == other%row(:, candidate) .and. &
                                                         abs(here - there) <= round_off*abs(there))
      end associate
   end function is_repeated

   !> Take a smaller value.
   pure subroutine lower(self, value, row)
      type(extreme_type), intent(inout) :: self
      real(wp), intent(in) :: value
      integer, intent(in) :: row

      if (self%row > 0 .and. .not. value < self%value - round_off*abs(self%value)) return
      self%value = value
      self%row = row
   end subroutine lower

   !> Add the nodes by which the mesh has grown to `added` at either end; all of `nodes` at first.
   pure subroutine widen(self, nodes, added)
      class(slip_range_type), intent(inout) :: self
      integer, intent(in) :: nodes, added
      !> Beyond any slip; twice as much does not overflow.
      real(wp), parameter :: beyond = 0.25_wp*huge(1.0_wp)
      real(wp), allocatable :: margin(:)

      if (.not. allocated(self%lowest)) then
         allocate (self%lowest(nodes), source=beyond)
         allocate (self%highest(nodes), source=-beyond)
      else if (added > self%added) then
         allocate (margin(added - self%added), source=beyond)
         self%lowest = [margin, self%lowest, margin]
         self%highest = [-margin, self%highest, -margin]
      end if
      self%added = added
   end subroutine widen

   !> Add the slip of the nodes in contact.
   pure subroutine add_slip(self, model, state)
      class(slip_range_type), intent(inout) :: self
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: state
      real(wp) :: slip(model%nodes())

      call self%widen(model%nodes(), model%added)
      slip = state%fields%slip()
      where (in_contact(state%status))
         self%lowest = min(self%lowest, slip)
         self%highest = max(self%highest, slip)
      end where
   end subroutine add_slip

   !> Estimates of the largest stresses of a state, force/length^2, as for half-planes; -1 for a body without them. The von Mises
   !> stress only where it is compared with a yield strength.
   subroutine estimate_stresses(model, state, patches, estimates)
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: state
      type(patch_type), intent(in) :: patches(:)
      real(wp), intent(out) :: estimates(candidate_count)
      type(surface_samples_type) :: samples

      call sample_surface(model, state, patches, samples)
      call add_body(model%scene%lower, 1)
      call add_body(model%scene%upper, 2)

   contains

      !> What the tangential stress at the samples has in addition around a neat fit (surface_stress of mfv_interior_circle).
      function hoop_stress(body)
         type(body_type), intent(in) :: body
         real(wp) :: hoop_stress(size(samples%arc)), angle(size(samples%arc)), kappa

         kappa = body%elasticity%material%kolosov
         angle = samples%arc/body%radius
         associate (force => state%fields%force, to_right => -sign(1.0_wp, model%scene%lower%curvature()))
            hoop_stress = 2.0_wp/((1.0_wp + kappa)*pi*body%radius) &
                          *(force(motion_approach)*cos(angle) + to_right*force(motion_shift)*sin(angle))
         end associate
         if (body%is_hole()) hoop_stress = kappa*hoop_stress + model%force(state%fields%pressure)/(pi*body%radius)
      end function hoop_stress

      subroutine add_body(body, side)
         type(body_type), intent(in) :: body
         integer, intent(in) :: side
         !> Part of the shear that a tension between the samples may have, so that states with and without it differ.
         real(wp), parameter :: between = 0.1_wp
         real(wp) :: bulk, hoop, sign

         estimates([candidate_tension(side), candidate_von_mises(side)]) = -1.0_wp
         if (.not. has_interior(body) .or. body%elasticity%is_layered()) return
         bulk = state%fields%motion(bulk_motions(side))
         ! Surfaces that repeat have no bulk stress, but one that keeps their mean strain zero.
         associate (period => model%scene%mesh%period)
            if (period > 0.0_wp) bulk = body%elasticity%material%lateral_ratio()*sum(state%fields%pressure*model%width)/period
         end associate
         ! A circle is in tension also beside a contact without shear, in proportion to the force.
         hoop = 0.0_wp
         if (body%deforms_as_circle()) hoop = state%fields%force(motion_approach)/(pi*body%radius)
         sign = merge(1.0_wp, -1.0_wp, side == 1)
         associate (stress => bulk + surface_stress_of(body%elasticity%material, samples%pressure, sign*samples%shear, &
                                                       samples%of_pressure, sign*samples%of_shear))
            if (model%scene%is_neat()) then
               ! A difference of larger stresses.
               estimates(candidate_tension(side)) = max(maxval(hoop_stress(body) + stress), 0.0_wp) + &
                                                    between*maxval(state%fields%pressure)
            else
               estimates(candidate_tension(side)) = hoop + max(max(bulk, 0.0_wp) + between*maxval(abs(state%fields%shear)), &
                                                               maxval(stress))
            end if
            if (body%yield_strength > 0.0_wp) &
               estimates(candidate_von_mises(side)) = largest_von_mises(model, state, patches, samples, stress, body, side, bulk)
         end associate
      end subroutine add_body
   end subroutine estimate_stresses

   !> Tractions at the edges of the patches and at some of their nodes, also beside edges of stick zones.
   subroutine sample_surface(model, state, patches, samples)
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: state
      type(patch_type), intent(in) :: patches(:)
      type(surface_samples_type), intent(out) :: samples
      !> Of a fit, whose stress is largest anywhere around the circle, more.
      integer, parameter :: between = 12, around = 60
      logical :: is_sample(model%nodes())
      logical, allocatable :: inside(:)
      integer, allocatable :: nodes(:)
      complex(wp), allocatable :: integrals(:)
      integer :: most_between, i, j

      most_between = merge(around, between, model%scene%is_neat())
      is_sample = .false.
      do i = 1, size(patches)
         associate (patch => patches(i))
            is_sample(patch%first:patch%last:max(1, (patch%last - patch%first)/most_between)) = .true.
            is_sample([patch%first, min(patch%first + 1, patch%last), max(patch%last - 1, patch%first), patch%last]) = .true.
            do j = 1, size(patch%stick)
               is_sample([patch%stick(j)%first, patch%stick(j)%last]) = .true.
            end do
         end associate
      end do
      nodes = pack([(i, i=1, size(is_sample))], is_sample)
      samples%arc = [model%arc(nodes), patches%left, patches%right]
      samples%pressure = [state%fields%pressure(nodes), (0.0_wp, i=1, 2*size(patches))]
      samples%shear = [state%fields%shear(nodes), (0.0_wp, i=1, 2*size(patches))]
      integrals = cauchy_integrals(model, state, patches, nodes)
      samples%of_shear = aimag(integrals)
      samples%of_pressure = real(integrals, wp)
      if (.not. any(patches%to_first > 0.0_wp)) return
      ! A patch that continues in the first one has no edge where the surfaces repeat.
      inside = .not. model%scene%repeats_beyond(samples%arc)
      samples = surface_samples_type(pack(samples%arc, inside), pack(samples%pressure, inside), pack(samples%shear, inside), &
                                     pack(samples%of_pressure, inside), pack(samples%of_shear, inside))
   end subroutine sample_surface

   !> 1/pi integrals of p + i tau over t - x dt at `nodes` and at the left and the right edges of all patches, force/length^2. The
   !> tractions are constant in each interval; at its own edges those of a patch vanish as roots.
   function cauchy_integrals(model, state, patches, nodes) result(integrals)
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: state
      type(patch_type), intent(in) :: patches(:)
      integer, intent(in) :: nodes(:)
      complex(wp) :: integrals(size(nodes) + 2*size(patches))
      type(element_tree_type) :: tree
      complex(wp), allocatable :: traction(:)
      real(wp), allocatable :: from(:), to(:)
      integer, allocatable :: loaded(:), near(:, :)
      complex(wp), allocatable :: beyond(:)
      complex(wp) :: sum_beyond
      real(wp) :: period
      integer :: i, j

      period = model%scene%repeat_length()
      loaded = [((j, j=patches(i)%first, patches(i)%last), i=1, size(patches))]
      traction = cmplx(state%fields%pressure(loaded), state%fields%shear(loaded), wp)
      from = place(model%arc(loaded) - 0.5_wp*model%width(loaded))
      to = place(model%arc(loaded) + 0.5_wp*model%width(loaded))
      beyond = traction*log(cosine(model%arc(loaded) + 0.5_wp*model%width(loaded)) &
                            /cosine(model%arc(loaded) - 0.5_wp*model%width(loaded)))
      sum_beyond = sum(beyond)
      tree = new_straight_tree(from, to, traction, traction)
      allocate (near(2, tree%leaves()))
      integrals(:size(nodes)) = [(over_all(place(model%arc(nodes(i)))), i=1, size(nodes))]
      j = 1
      do i = 1, size(patches)
         associate (patch => patches(i), last => j + patches(i)%last - patches(i)%first)
            integrals(size(nodes) + i) = at_edge(patch, -1, patch%left, j, last)
            integrals(size(nodes) + size(patches) + i) = at_edge(patch, 1, patch%right, j, last)
            j = last + 1
         end associate
      end do
      integrals = integrals/pi

   contains

      !> A place at which the integral is that over 1/(t - x), but for what is `beyond`, which does not depend on it. Where the
      !> surface repeats every length l, sin(pi (t - x)/l) is the difference of the tangents times both cosines.
      elemental real(wp) function place(arc)
         real(wp), intent(in) :: arc

         place = arc
         if (period > 0.0_wp) place = tan(angle_of(arc))
      end function place

      !> The cosine of that angle; one where the surface does not repeat.
      elemental real(wp) function cosine(arc)
         real(wp), intent(in) :: arc

         cosine = 1.0_wp
         if (period > 0.0_wp) cosine = cos(angle_of(arc))
      end function cosine

      !> Angle of an arc length in the period, less than a right angle.
      elemental real(wp) function angle_of(arc)
         real(wp), intent(in) :: arc
         real(wp), parameter :: most = 0.5_wp*pi*(1.0_wp - 4.0_wp*epsilon(1.0_wp))

         angle_of = max(-most, min(most, pi*(arc - model%scene%mesh%middle)/period))
      end function angle_of

      !> The integral over all intervals at a place.
      complex(wp) function over_all(x)
         real(wp), intent(in) :: x
         complex(wp) :: distant
         integer :: i, number

         call tree%find_distant_along(x, distant, near, number)
         over_all = sum_beyond + distant
         do i = 1, number
            over_all = over_all + over_intervals(x, near(1, i), near(2, i))
         end do
      end function over_all

      !> The integral over the intervals `first` to `last` at a place, without the constant.
      complex(wp) function over_intervals(x, first, last)
         real(wp), intent(in) :: x
         integer, intent(in) :: first, last

         over_intervals = sum(traction(first:last)*log(max(abs(to(first:last) - x), tiny(1.0_wp)) &
                                                       /max(abs(from(first:last) - x), tiny(1.0_wp))))
      end function over_intervals

      !> The integral over all intervals at the left (-1) or right `edge` of a patch, from the interval `first` to `last`. In that
      !> patch t = c - a cos(angle): the integral over t of the root is a^2/2 (angle - sin cos), that of the root over t - x is
      !> a (sin - side angle).
      complex(wp) function at_edge(patch, side, edge, first, last)
         type(patch_type), intent(in) :: patch
         integer, intent(in) :: side, first, last
         real(wp), intent(in) :: edge
         real(wp) :: half, angle(first:last + 1), root(first:last)

         half = 0.5_wp*patch%length()
         at_edge = over_all(place(edge)) - over_intervals(place(edge), first, last) - sum(beyond(first:last))
         if (.not. half > 0.0_wp) return
         associate (inner => model%arc(patch%first + 1:patch%last), width => model%width(patch%first:patch%last))
            angle(first) = 0.0_wp
            angle(first + 1:last) = acos(max(-1.0_wp, min(1.0_wp, (patch%left + half - inner + 0.5_wp*width(2:))/half)))
            angle(last + 1) = pi
            associate (a => angle(first:last), b => angle(first + 1:last + 1))
               root = 0.5_wp*half*(b - a - sin(b)*cos(b) + sin(a)*cos(a))
               where (root > 0.0_wp) root = width/root*(sin(b) - sin(a) - side*(b - a))
            end associate
         end associate
         at_edge = at_edge + sum(traction(first:last)*root)
      end function at_edge
   end function cauchy_integrals
   !> Estimate of the largest von Mises stress of a body, force/length^2: at the samples, and below the patches with the largest
   !> pressures under line loads at the nodes. `stress`: sigma_xx at the samples.
   real(wp) function largest_von_mises(model, state, patches, samples, stress, body, side, bulk) result(largest)
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: state
      type(patch_type), intent(in) :: patches(:)
      type(surface_samples_type), intent(in) :: samples
      type(body_type), intent(in) :: body
      integer, intent(in) :: side
      real(wp), intent(in) :: stress(:), bulk
      integer, parameter :: across = 12
      integer, parameter :: most_patches = 20
      real(wp) :: sign, depth, below(3), peak(size(patches))
      logical :: left(size(patches))
      integer :: i, j, k, m, number

      sign = merge(1.0_wp, -1.0_wp, side == 1)
      largest = of_components(bulk, 0.0_wp, 0.0_wp)
      do i = 1, size(samples%arc)
         largest = max(largest, of_components(stress(i), -samples%pressure(i), sign*samples%shear(i)))
      end do
      peak = [(maxval(state%fields%pressure(patches(i)%first:patches(i)%last)), i=1, size(patches))]
      left = .true.
      do number = 1, min(size(patches), most_patches)
         i = maxloc(peak, dim=1, mask=left)
         left(i) = .false.
         do k = 1, size(depths_below)
            depth = 0.5_wp*depths_below(k)*patches(i)%length()
            do j = 1, across
               associate (place => patches(i)%left + patches(i)%length()*(j - 0.5_wp)/across)
                  below = 0.0_wp
                  ! With the nearest images.
                  do m = -1, 1
                     if (m /= 0 .and. .not. model%scene%mesh%period > 0.0_wp) cycle
                     below = below + line_load_stress(body%elasticity%material, model%arc - place + m*model%scene%mesh%period, &
                                                      depth, model%width*state%fields%pressure, &
                                                      sign*model%width*state%fields%shear)
                  end do
               end associate
               largest = max(largest, of_components(bulk + below(1), below(2), below(3)))
            end do
         end do
      end do

   contains

      pure real(wp) function of_components(xx, yy, xy)
         real(wp), intent(in) :: xx, yy, xy

         of_components = von_mises_stress([xx, yy, xy, body%elasticity%material%stress_out_of_plane([xx, yy, xy])])
      end function of_components
   end function largest_von_mises

end module mfv_load_extremes
