!> A scene on its mesh: node positions, undeformed gaps and the compliance between the nodes.
!>
!> With vertical normals (limits in docs/theory.md) nodes are at equal arc lengths from the origin of x on both bodies. Gaps are
!> exact at the x of the nodes, on the circle of scene%arc_radius. On a body of another radius the nodes would be at another x; the
!> difference is of third order in the angle. With radial normals, for a disk in a hole, nodes are at equal angles on both bodies,
!> gaps are along the radii of the hole, and tractions are per unit of its arc. On unequal intervals gaps are means, as
!> displacements are.
module mfv_contact_model
   use mfv_body, only: body_type, gap_between, radial_gap_between
   use mfv_body_pair, only: body_pair_type, new_body_pair
   use mfv_circle, only: circle_intervals, kernel_fourier
   use mfv_compliance, only: compliance_type
   use mfv_contact_fields, only: contact_fields_type
   use mfv_kinds, only: pi, wp
   use mfv_lapack, only: ddot
   use mfv_quadrature, only: gauss_points
   use mfv_tolerances, only: significant, visible
   use mfv_motions, only: motions, motion_count, motion_approach, motion_shift, motion_rotation, motion_lower_bulk, &
                          motion_upper_bulk, motion_interference, motion_wear, arm_unit, control_force
   use mfv_reference_indenter, only: indenter_type
   use mfv_clock, only: seconds_now
   use mfv_scene, only: scene_type
   use mfv_scene_indenter, only: indenter_of, largest_half_width
   implicit none
   private
   public :: contact_model_type, new_contact_model, adapt_model, choose_mesh, can_choose_mesh, has_touchable_node, &
             intervals_round, needs_equal_intervals, gap_at

   type :: contact_model_type
      type(scene_type) :: scene
      !> Positions of the nodes: x, and the arc length from the origin of x; lengths.
      real(wp), allocatable :: x(:), arc(:)
      !> Length of the surface that belongs to each node.
      real(wp), allocatable :: width(:)
      !> Undeformed gaps g0, with the wear so far, length; zero where a node faces no surface.
      real(wp), allocatable :: initial_gap(:)
      !> Depth worn off both surfaces so far, and in the present block of cycles, length.
      real(wp), allocatable :: worn(:), wear(:)
      !> Whether both bodies have a surface at the node, so that it can touch.
      logical, allocatable :: can_touch(:)
      !> Decrease of the gap, and displacement of the upper surface to the right along the lower one, for a unit of every motion of
      !> the upper body (mfv_motions); shape (nodes, motion_count). Approach and shift: without unit; rotation, wear: lengths;
      !> bulk stresses: length^3/force.
      real(wp), allocatable :: normal_arm(:, :), tangential_arm(:, :)
      !> Whether normals are vertical: approach only closes gaps, and shift only slides.
      logical :: upright = .true.
      !> Static and kinetic coefficient of friction at the nodes, shape (nodes), and the friction scale: the largest ratio of shear
      !> to pressure, at most 1.
      real(wp), allocatable :: static_friction(:), kinetic_friction(:)
      real(wp) :: friction_scale = 0.0_wp
      type(body_pair_type) :: compliance
      !> Whether the tangential problem is modelled: friction acts in some step.
      logical :: tangential = .false.
      !> Which motions are modelled; the others are fixed.
      logical :: moves(motion_count) = .not. motions%optional
      !> Whether the mesh may grow with the contact.
      logical :: growing = .false.
      !> Number of nodes added at either end.
      integer :: added = 0
      !> Time spent on the compliance so far, seconds.
      real(wp) :: assembly_seconds = 0.0_wp
   contains
      procedure :: nodes
      procedure :: interval
      procedure :: intervals
      procedure :: largest_stiffness
      procedure :: length
      procedure :: unit_of_arm
      procedure :: gap
      procedure :: gap_terms
      procedure :: relative_displacements
      procedure :: displace
      procedure :: has_rigid_parts
      procedure :: motions_couple
      procedure :: couples
      procedure :: lifts
      procedure :: rigid_normal
      procedure :: rigid_tangential
      procedure :: nearest_approach
      procedure :: force
      procedure :: resultant
      procedure :: reaches_end
      procedure :: repeats_beyond
      procedure :: centre_height
      procedure :: rolls
      procedure :: rolled
      procedure :: slid
      procedure :: rolling_error
      procedure :: spare_nodes
      procedure :: grow
      procedure :: add_tangential
      procedure :: set_worn
      procedure :: begin_wear
      procedure, private :: build_compliance
      procedure, private :: place_nodes
   end type contact_model_type

   !> Chosen half-width of the mesh relative to the estimated contact half-width.
   real(wp), parameter :: room = 1.2_wp

contains

   !> Model of a valid scene (the reader of the scene has checked it).
   function new_contact_model(scene) result(model)
      type(scene_type), intent(in) :: scene
      type(contact_model_type) :: model
      real(wp) :: interval
      integer :: nodes

      model%scene = scene
      call model%scene%friction%simplify()
      model%tangential = scene%tangential()
      model%moves = scene%moves()
      call choose_mesh(scene, nodes, interval, model%growing)
      if (scene%mesh%period > 0.0_wp .and. .not. (model%growing .or. allocated(scene%mesh%ends) .or. scene%mesh%has_middle)) &
         call choose_middle(model%scene, nodes)
      if (scene%is_neat() .and. .not. scene%mesh%has_middle) call turn_to_load(model%scene)
      call model%build_compliance(nodes, interval)
      allocate (model%worn(nodes), model%wear(nodes), source=0.0_wp)
      call model%place_nodes()
   end function new_contact_model

   !> Number and width (length) of the intervals of the mesh of a scene, and whether the mesh may grow.
   subroutine choose_mesh(scene, nodes, interval, growing)
      type(scene_type), intent(in) :: scene
      integer, intent(out) :: nodes
      real(wp), intent(out) :: interval
      logical, intent(out) :: growing
      integer :: circle

      nodes = scene%mesh%nodes
      growing = .not. (allocated(scene%mesh%ends) .or. scene%lower%is_matrix())
      if (allocated(scene%mesh%ends)) then
         nodes = size(scene%mesh%ends) - 1
         interval = (scene%mesh%ends(nodes + 1) - scene%mesh%ends(1))/nodes
      else if (scene%lower%is_matrix()) then
         nodes = size(scene%lower%position)
         interval = sum(scene%lower%elasticity%width)/nodes
      else if (scene%repeat_length() > 0.0_wp .and. .not. small_in_period(scene)) then
         interval = scene%repeat_length()/nodes
         growing = .false.
      else if (scene%mesh%whole_circle) then
         interval = 2.0_wp*pi*scene%arc_radius()/nodes
         circle = nodes
         nodes = 2*ceiling(estimated_half_width(scene)/interval) + modulo(circle, 2)
         nodes = min(nodes, circle)
      else if (scene%mesh%half_width > 0.0_wp) then
         interval = 2.0_wp*scene%mesh%half_width/nodes
      else
         interval = 2.0_wp*estimated_half_width(scene)/nodes
         if (needs_equal_intervals(scene)) interval = 2.0_wp*pi*scene%arc_radius()/circle_intervals(scene%arc_radius(), interval)
      end if
   end subroutine choose_mesh

   !> Whether a mesh that is to be refined begins about a contact much smaller than the period.
   logical function small_in_period(scene)
      type(scene_type), intent(in) :: scene
      real(wp), parameter :: small = 0.05_wp
      real(wp) :: expected

      small_in_period = .false.
      if (.not. scene%mesh%refined) return
      expected = largest_half_width(scene, scene%mesh%period)
      small_in_period = expected > 0.0_wp .and. expected < small*scene%mesh%period
   end function small_in_period

   !> Whether there is a length from which to choose a mesh: that of the user, of a shape, or of the contact under the targets of
   !> the steps.
   pure logical function can_choose_mesh(scene)
      type(scene_type), intent(in) :: scene

      can_choose_mesh = scene%lower%is_matrix() .or. allocated(scene%mesh%ends) .or. scene%repeat_length() > 0.0_wp .or. &
                        scene%mesh%half_width > 0.0_wp .or. scene%mesh%whole_circle .or. &
                        min(scene%lower%half_extent(), scene%upper%half_extent()) < huge(1.0_wp)
      if (.not. can_choose_mesh) can_choose_mesh = largest_half_width(scene, huge(1.0_wp)) > 0.0_wp
   end function can_choose_mesh

   !> Number of intervals of the width `interval` (length) on the circle of a disk or hole; with radial normals on the circle of
   !> the nodes.
   pure real(wp) function intervals_round(scene, body, interval)
      type(scene_type), intent(in) :: scene
      type(body_type), intent(in) :: body
      real(wp), intent(in) :: interval

      intervals_round = 2.0_wp*pi*merge(scene%arc_radius(), body%radius, scene%mesh%radial)/interval
   end function intervals_round

   !> Whether the mesh of a scene has a node where both bodies have a surface.
   logical function has_touchable_node(scene)
      type(scene_type), intent(in) :: scene
      real(wp) :: interval
      integer :: i, nodes
      logical :: growing

      if (scene%lower%is_matrix()) then
         has_touchable_node = any(scene%touchable(scene%lower%position))
         return
      else if (allocated(scene%mesh%ends)) then
         has_touchable_node = any(scene%touchable(middles(scene%mesh%ends)))
         return
      end if
      call choose_mesh(scene, nodes, interval, growing)
      has_touchable_node = .false.
      do i = 1, nodes
         has_touchable_node = scene%touchable(0.5_wp*interval*(2*i - nodes - 1))
         if (has_touchable_node) return
      end do
   end function has_touchable_node

   !> The middles of the intervals between `ends`, shape (size(ends) - 1).
   pure function middles(ends)
      real(wp), intent(in) :: ends(:)
      real(wp) :: middles(size(ends) - 1)

      middles = 0.5_wp*(ends(:size(ends) - 1) + ends(2:))
   end function middles

   !> Whether a body's kernel is a Fourier series, which requires equal intervals, a whole number of them on its circle.
   pure logical function needs_equal_intervals(scene)
      type(scene_type), intent(in) :: scene

      needs_equal_intervals = scene%arc_radius() > 0.0_wp .and. &
                              any([scene%lower%elasticity%kernel, scene%upper%elasticity%kernel] == kernel_fourier)
   end function needs_equal_intervals

   !> Larger stiffnesses, force/length^2, are ratios to a displacement of round-off.
   pure real(wp) function largest_stiffness(self)
      class(contact_model_type), intent(in) :: self
      real(wp), parameter :: elastic = 1.0e8_wp

      largest_stiffness = elastic*self%compliance%modulus
   end function largest_stiffness

   !> Model the tangential problem from now on: friction acts in a step that was not in the scene.
   subroutine add_tangential(self)
      class(contact_model_type), intent(inout) :: self

      self%tangential = .true.
      call self%build_compliance(self%nodes(), self%interval())
   end subroutine add_tangential

   !> Extend a model to `added` nodes at either end and to the given problem and motions; rebuild it, without wear, if it has more.
   subroutine adapt_model(model, added, tangential, moves)
      type(contact_model_type), intent(inout) :: model
      integer, intent(in) :: added
      logical, intent(in) :: tangential, moves(motion_count)

      if (model%added > added .or. (model%tangential .and. .not. tangential) .or. any(model%moves .and. .not. moves)) &
         model = new_contact_model(model%scene)
      if (tangential .and. .not. model%tangential) call model%add_tangential()
      model%moves = model%moves .or. moves
      if (model%added < added) call model%grow(added - model%added)
   end subroutine adapt_model

   !> Set the depth that is worn off, length, shape (nodes).
   subroutine set_worn(self, worn)
      class(contact_model_type), intent(inout) :: self
      real(wp), intent(in) :: worn(:)

      if (all(abs(worn - self%worn) <= 0.0_wp)) return
      self%worn = worn
      call self%place_nodes()
   end subroutine set_worn

   !> Let the motion motion_wear open the gaps by `wear` per unit, length, shape (nodes).
   subroutine begin_wear(self, wear)
      class(contact_model_type), intent(inout) :: self
      real(wp), intent(in) :: wear(:)

      self%wear = wear
      self%normal_arm(:, motion_wear) = -wear
   end subroutine begin_wear

   subroutine build_compliance(self, nodes, interval)
      class(contact_model_type), intent(inout) :: self
      integer, intent(in) :: nodes
      real(wp), intent(in) :: interval
      class(compliance_type), allocatable :: lower, upper
      real(wp) :: common_radius, started

      started = seconds_now()
      associate (scene => self%scene)
         common_radius = merge(scene%arc_radius(), 0.0_wp, scene%mesh%radial)
         call scene%lower%make_compliance(nodes, interval, scene%coupling, self%tangential, common_radius, lower, scene%mesh%ends, &
                                          scene%mesh%middle)
         call scene%upper%make_compliance(nodes, interval, scene%coupling, self%tangential, common_radius, upper, scene%mesh%ends, &
                                          scene%mesh%middle)
      end associate
      associate (scene => self%scene, length => nodes*interval)
         call scene%lower%elasticity%find_surface_stress(length)
         call scene%upper%elasticity%find_surface_stress(length)
         if (scene%lower%has_strength()) call scene%lower%elasticity%prepare_stress(length)
         if (scene%upper%has_strength()) call scene%upper%elasticity%prepare_stress(length)
      end associate
      call new_body_pair(lower, upper, self%compliance)
      self%assembly_seconds = self%assembly_seconds + seconds_now() - started
   end subroutine build_compliance

   pure integer function nodes(self)
      class(contact_model_type), intent(in) :: self

      nodes = self%compliance%nodes
   end function nodes

   !> Width of an interval, length (of unequal ones: the mean).
   pure real(wp) function interval(self)
      class(contact_model_type), intent(in) :: self

      interval = self%compliance%interval
   end function interval

   !> Length of the surface of the nodes of `mask`, shape (nodes), in (mean) intervals; for equal intervals their number.
   pure real(wp) function intervals(self, mask)
      class(contact_model_type), intent(in) :: self
      logical, intent(in) :: mask(:)

      intervals = sum(self%width/self%interval(), mask=mask)
   end function intervals

   !> Half the length of the mesh, length: the length scale of the scene.
   pure real(wp) function length(self)
      class(contact_model_type), intent(in) :: self

      length = 0.5_wp*self%interval()*self%nodes()
   end function length

   !> Unit of the arms of a motion, see arm_unit of mfv_motions.
   elemental real(wp) function unit_of_arm(self, motion)
      class(contact_model_type), intent(in) :: self
      integer, intent(in) :: motion

      unit_of_arm = arm_unit(motion, self%length(), self%compliance%modulus)
   end function unit_of_arm

   !> Gap g0 - delta + w of every node, length (meaningless where a node faces no surface).
   pure function gap(self, fields)
      class(contact_model_type), intent(in) :: self
      type(contact_fields_type), intent(in) :: fields
      real(wp) :: gap(self%compliance%nodes)

      gap = self%initial_gap - fields%motion(motion_approach) + fields%normal
   end function gap

   !> Sum of the magnitudes of the lengths that make up the gap of every node, shape (nodes), length: the surfaces of both bodies,
   !> approach and displacement. Round-off of a gap is relative to it.
   function gap_terms(self, fields) result(terms)
      class(contact_model_type), intent(in) :: self
      type(contact_fields_type), intent(in) :: fields
      real(wp) :: terms(self%compliance%nodes)

      associate (scene => self%scene)
         terms = abs(scene%lower%recess(self%x, scene%mesh%parabolic)) + abs(scene%upper%recess(self%x, scene%mesh%parabolic))
      end associate
      terms = terms + abs(self%initial_gap) + abs(fields%motion(motion_approach)) + abs(fields%normal)
   end function gap_terms

   !> Relative displacements of the surfaces by deformation and rigid motions, as in contact_fields_type, from the tractions and
   !> motions in `fields`; shape (nodes), length.
   subroutine relative_displacements(self, fields, normal, tangential)
      class(contact_model_type), intent(in) :: self
      type(contact_fields_type), intent(in) :: fields
      real(wp), intent(out) :: normal(:), tangential(:)

      call self%compliance%displacements(fields%pressure, fields%shear, normal, tangential)
      if (.not. self%has_rigid_parts()) return
      normal = normal - self%rigid_normal(fields)
      tangential = tangential - self%rigid_tangential(fields)
   end subroutine relative_displacements

   !> Set the displacements of the fields from their tractions and motions.
   subroutine displace(self, fields)
      class(contact_model_type), intent(in) :: self
      type(contact_fields_type), intent(inout) :: fields
      real(wp), dimension(self%compliance%nodes) :: normal, tangential

      call self%relative_displacements(fields, normal, tangential)
      fields%normal = normal
      fields%tangential = tangential
   end subroutine displace

   !> Whether motions of the upper body change gaps or slip non-uniformly: another motion than approach and shift is modelled, or
   !> normals are inclined. Otherwise rigid_normal and rigid_tangential are zero.
   pure logical function has_rigid_parts(self)
      class(contact_model_type), intent(in) :: self

      has_rigid_parts = any(self%moves .and. motions%optional) .or. .not. self%upright
   end function has_rigid_parts

   !> Whether nodes that stick couple the tractions in a block of the compliance (block_up, block_wt) next to an edge: not of
   !> elastically similar bodies.
   pure logical function couples(self, block)
      class(contact_model_type), intent(in) :: self
      integer, intent(in) :: block

      couples = self%compliance%elastic_block(block) .and. .not. self%scene%is_similar()
   end function couples

   !> Whether motions couple the normal and the tangential problem: all but approach, shift, bulk stresses and wear do, and all do
   !> with inclined normals.
   pure logical function motions_couple(self)
      class(contact_model_type), intent(in) :: self

      motions_couple = any(self%moves .and. motions%optional .and. .not. motions%is_known) .or. .not. self%upright
   end function motions_couple

   !> Whether a motion changes gaps; otherwise it only slides.
   pure logical function lifts(self, motion)
      class(contact_model_type), intent(in) :: self
      integer, intent(in) :: motion

      lifts = any(abs(self%normal_arm(:, motion)) > 0.0_wp)
   end function lifts

   !> Decrease of the gaps by the motions of the upper body, beyond the approach itself; shape (nodes), length.
   pure function rigid_normal(self, fields)
      class(contact_model_type), intent(in) :: self
      type(contact_fields_type), intent(in) :: fields
      real(wp) :: rigid_normal(self%compliance%nodes)

      rigid_normal = moved(self%normal_arm, motion_approach, fields%motion)
   end function rigid_normal

   !> Displacement of the upper surface to the right by its motions, beyond the shift itself; shape (nodes), length.
   pure function rigid_tangential(self, fields)
      class(contact_model_type), intent(in) :: self
      type(contact_fields_type), intent(in) :: fields
      real(wp) :: rigid_tangential(self%compliance%nodes)

      rigid_tangential = moved(self%tangential_arm, motion_shift, fields%motion)
   end function rigid_tangential

   !> Displacement of the nodes by motions with their `arm`, shape (nodes, motion_count), less the motion `own` itself.
   pure function moved(arm, own, motion)
      real(wp), intent(in) :: arm(:, :), motion(motion_count)
      integer, intent(in) :: own
      real(wp) :: moved(size(arm, 1))
      integer :: i

      moved = 0.0_wp
      do i = 1, motion_count
         if (abs(motion(i)) > 0.0_wp) moved = moved + (arm(:, i) - merge(1.0_wp, 0.0_wp, i == own))*motion(i)
      end do
   end function moved

   !> Further approach of the upper body until the nearest node closes its `gap`, length; none in a neat fit, which touches.
   pure real(wp) function nearest_approach(self, gap)
      class(contact_model_type), intent(in) :: self
      real(wp), intent(in) :: gap(:)

      nearest_approach = 0.0_wp
      if (self%scene%is_neat()) return
      nearest_approach = minval(gap/max(self%normal_arm(:, motion_approach), tiny(1.0_wp)), mask=self%can_touch)
   end function nearest_approach

   !> Sum of a traction over the surface, force/length.
   pure real(wp) function force(self, traction)
      class(contact_model_type), intent(in) :: self
      real(wp), intent(in) :: traction(:)

      force = ddot(size(traction), self%width, 1, traction, 1)
   end function force

   !> Resultant of the tractions on the lower body for a motion (mfv_motions): normal force down, tangential force to the right,
   !> force/length; moment about the centre of rotation (centre_height), counterclockwise, force.
   pure real(wp) function resultant(self, motion, pressure, shear)
      class(contact_model_type), intent(in) :: self
      integer, intent(in) :: motion
      real(wp), intent(in) :: pressure(:), shear(:)

      if (self%upright .and. motion == motion_approach) then
         resultant = self%force(pressure)
      else if (self%upright .and. motion == motion_shift) then
         resultant = self%force(shear)
      else
         resultant = self%force(self%normal_arm(:, motion)*pressure) + self%force(self%tangential_arm(:, motion)*shear)
      end if
   end function resultant

   !> Whether the contact (true: in contact) reaches an end of the mesh beyond which both bodies continue.
   pure logical function reaches_end(self, contact)
      class(contact_model_type), intent(in) :: self
      logical, intent(in) :: contact(:)
      integer :: n

      n = self%nodes()
      reaches_end = contact(1) .and. self%scene%touchable(self%arc(1) - self%width(1)) &
                    .or. contact(n) .and. self%scene%touchable(self%arc(n) + self%width(n))
   end function reaches_end

   !> Whether the surfaces repeat beyond the left (`side` -1) or right (1) end of the interval of a node.
   pure logical function repeats_beyond(self, node, side)
      class(contact_model_type), intent(in) :: self
      integer, intent(in) :: node, side

      repeats_beyond = self%scene%repeats_beyond(self%arc(node) + side*0.5_wp*self%width(node))
   end function repeats_beyond

   !> Number of nodes that can still be added at either end; limited on a circle, and where `half_width` is given, which is then far
   !> from the contact by mistake.
   pure integer function spare_nodes(self)
      class(contact_model_type), intent(in) :: self
      integer, parameter :: longest = 4

      spare_nodes = huge(1)
      if (self%scene%mesh%half_width > 0.0_wp) spare_nodes = max(0, (longest*self%scene%mesh%nodes - self%nodes())/2)
      if (self%scene%arc_radius() > 0.0_wp) &
         spare_nodes = min(spare_nodes, max(0, (circle_intervals(self%scene%arc_radius(), self%interval()) - self%nodes())/2))
   end function spare_nodes

   !> Lengthen the mesh by `extra` nodes at either end, with the same intervals.
   subroutine grow(self, extra)
      class(contact_model_type), intent(inout) :: self
      integer, intent(in) :: extra
      real(wp) :: started
      integer :: i

      started = seconds_now()
      call self%compliance%resize(self%nodes() + 2*extra)
      self%assembly_seconds = self%assembly_seconds + seconds_now() - started
      self%added = self%added + extra
      self%worn = [(0.0_wp, i=1, extra), self%worn, (0.0_wp, i=1, extra)]
      self%wear = [(0.0_wp, i=1, extra), self%wear, (0.0_wp, i=1, extra)]
      call self%place_nodes()
   end subroutine grow

   !> Set positions; they are exactly symmetric.
   subroutine place_nodes(self)
      class(contact_model_type), intent(inout) :: self
      integer :: i, n

      n = self%nodes()
      if (self%scene%lower%is_matrix()) then
         self%arc = self%scene%lower%position
         self%width = self%scene%lower%elasticity%width
      else if (allocated(self%scene%mesh%ends)) then
         self%arc = middles(self%scene%mesh%ends)
         self%width = self%scene%mesh%ends(2:) - self%scene%mesh%ends(:n)
      else
         self%arc = self%scene%mesh%middle + [(0.5_wp*self%interval()*(2*i - n - 1), i=1, n)]
         self%width = spread(self%interval(), 1, n)
      end if
      self%x = self%scene%x_of_arc(self%arc)
      if (allocated(self%scene%mesh%ends)) then
         self%initial_gap = mean_gaps(self%scene, self%scene%mesh%ends)
      else
         self%initial_gap = gap_at(self%scene, self%arc)
      end if
      self%initial_gap = self%initial_gap + self%worn
      self%can_touch = self%scene%touchable(self%arc)
      self%static_friction = self%scene%friction%static%at(self%scene%x_in_period(self%x))
      self%kinetic_friction = self%scene%friction%kinetic%at(self%scene%x_in_period(self%x))
      self%friction_scale = min(self%scene%friction%static%largest(), 1.0_wp)
      call place_arms(self)
   end subroutine place_nodes

   !> Choose the period that a mesh of `nodes` intervals covers so that its ends, where what spans them is counted twice, are last
   !> to touch: where the gap is widest, at an end of an interval. The period about the origin if it is also widest at its ends,
   !> or at opposite places.
   subroutine choose_middle(scene, nodes)
      type(scene_type), intent(inout) :: scene
      integer, intent(in) :: nodes
      integer, parameter :: samples = 2000
      real(wp), parameter :: nearly = 1.0e-4_wp
      real(wp) :: gap(0:samples), end(0:samples), interval, place
      logical :: is_widest(0:samples)
      integer :: i, first, last

      scene%mesh%middle = 0.0_wp
      scene%mesh%has_middle = .true.
      end = [(scene%mesh%period*(real(i, wp)/samples - 0.5_wp), i=0, samples)]
      gap = gap_at(scene, end*(1.0_wp - significant))
      where (.not. scene%touchable(end*(1.0_wp - significant))) gap = huge(1.0_wp)
      is_widest = gap >= maxval(gap)*(1.0_wp - nearly)
      if (is_widest(0) .or. is_widest(samples)) return
      first = findloc(is_widest, .true., dim=1) - 1
      last = findloc(is_widest, .true., dim=1, back=.true.) - 1
      if (all(is_widest(first:last))) then
         place = 0.5_wp*(end(first) + end(last))
      else if (first == samples - last) then
         return
      else
         place = merge(end(first), end(last), abs(end(first)) > abs(end(last)))
      end if
      interval = scene%mesh%period/nodes
      scene%mesh%middle = interval*anint((place - sign(0.5_wp*scene%mesh%period, place))/interval)
   end subroutine choose_middle

   !> Put the ends of the mesh around a neat fit opposite to the largest force of the load history (the sum of equally large ones),
   !> where a gap opens if any does.
   subroutine turn_to_load(scene)
      type(scene_type), intent(inout) :: scene
      integer, parameter :: along(2) = [motion_approach, motion_shift]
      real(wp) :: now(2), sum_of_largest(2), largest
      integer :: i, j

      scene%mesh%has_middle = .true.
      if (.not. allocated(scene%steps)) return
      now = 0.0_wp
      largest = 0.0_wp
      sum_of_largest = 0.0_wp
      do i = 1, size(scene%steps)
         associate (step => scene%steps(i))
            call take(step%target(along), step%control(along) == control_force)
            if (.not. allocated(step%path)) cycle
            do j = 1, size(step%path, 2)
               call take(step%path(along, j), step%control(along) == control_force)
            end do
         end associate
      end do
      if (norm2(sum_of_largest) <= visible*largest) return
      ! The right is at a positive angle on a hole below, at a negative one on a disk below.
      sum_of_largest(2) = -sign(1.0_wp, scene%lower%curvature())*sum_of_largest(2)
      scene%mesh%middle = scene%arc_radius()*atan2(sum_of_largest(2), sum_of_largest(1))
      if (scene%mesh%middle < -0.5_wp*scene%repeat_length()*(1.0_wp - visible)) scene%mesh%middle = -scene%mesh%middle

   contains

      !> Follow a step to the `target` forces that are `given`; others stay.
      subroutine take(target, given)
         real(wp), intent(in) :: target(2)
         logical, intent(in) :: given(2)

         now = merge(target, now, given)
         if (norm2(now) > largest*(1.0_wp + visible)) then
            largest = norm2(now)
            sum_of_largest = now
         else if (norm2(now) >= largest*(1.0_wp - visible)) then
            sum_of_largest = sum_of_largest + now
         end if
      end subroutine take
   end subroutine turn_to_load

   !> Undeformed gaps at arc lengths from the origin of x, lengths.
   function gap_at(scene, arc) result(gap)
      type(scene_type), intent(in) :: scene
      real(wp), intent(in) :: arc(:)
      real(wp) :: gap(size(arc))

      if (scene%mesh%radial) then
         gap = radial_gap_between(scene%lower, scene%upper, arc/scene%arc_radius())
      else
         gap = gap_between(scene%lower, scene%upper, scene%x_in_period(scene%x_of_arc(arc)), scene%mesh%parabolic)
      end if
   end function gap_at

   !> Mean undeformed gaps of the intervals between `ends`, as their compliance gives mean displacements: over both halves of each
   !> by Gauss quadrature, which is exact for a corner in the middle.
   function mean_gaps(scene, ends) result(gap)
      type(scene_type), intent(in) :: scene
      real(wp), intent(in) :: ends(:)
      real(wp) :: gap(size(ends) - 1)
      integer, parameter :: points = 4
      real(wp) :: point(points), weight(points), half(size(ends) - 1)
      integer :: i, n

      n = size(ends) - 1
      call gauss_points(0.0_wp, 0.5_wp, point, weight)
      half = ends(2:) - ends(:n)
      gap = 0.0_wp
      do i = 1, points
         gap = gap + weight(i)*(gap_at(scene, ends(:n) + point(i)*half) + gap_at(scene, ends(2:) - point(i)*half))
      end do
   end function mean_gaps

   !> Arms of the rotation of the upper body about the centre of centre_height. Counterclockwise it lifts the right side and moves a
   !> surface below the centre to the right (eq. 4.24, where M is in units of R and has its own signs). Circles roll: see
   !> rolling_arm. Arms of the bulk stresses: a uniform stress sigma strains the surface of its body by sigma (kappa + 1)/(8 G),
   !> about the origin of x.
   subroutine place_arms(self)
      class(contact_model_type), intent(inout) :: self
      integer :: n

      n = self%nodes()
      if (allocated(self%normal_arm)) deallocate (self%normal_arm, self%tangential_arm)
      allocate (self%normal_arm(n, motion_count), self%tangential_arm(n, motion_count), source=0.0_wp)
      self%normal_arm(:, motion_approach) = 1.0_wp
      self%tangential_arm(:, motion_shift) = 1.0_wp
      self%normal_arm(:, motion_interference) = 1.0_wp
      self%normal_arm(:, motion_wear) = -self%wear
      self%upright = .not. self%scene%mesh%radial
      if (self%scene%mesh%radial) then
         call place_radial_arms(self)
         return
      end if
      self%normal_arm(:, motion_rotation) = -self%x
      if (self%rolls()) self%normal_arm(:, motion_rotation) = -rolling_arm(self)
      self%tangential_arm(:, motion_rotation) = self%centre_height()
      associate (scene => self%scene)
         if (scene%can_have_bulk_stress(.false.)) &
            self%tangential_arm(:, motion_lower_bulk) = -scene%lower%elasticity%strain_by_bulk_stress()*self%arc
         if (scene%can_have_bulk_stress(.true.)) &
            self%tangential_arm(:, motion_upper_bulk) = scene%upper%elasticity%strain_by_bulk_stress()*self%arc
      end associate
   end subroutine place_arms

   !> Height of the centre of rotation above the origin of x, length: of the disk (the upper one of two; negative for a disk below),
   !> else of the hole; 0 without a circle. Of a disk in a hole it is the disk's centre whichever is above: forces and moment of the
   !> pair are the same upside down.
   pure real(wp) function centre_height(self)
      class(contact_model_type), intent(in) :: self

      centre_height = 0.0_wp
      associate (lower => self%scene%lower, upper => self%scene%upper)
         if (upper%circular() .and. .not. (upper%is_hole() .and. lower%is_disk())) then
            centre_height = sign(upper%radius, upper%curvature())
         else if (lower%circular()) then
            centre_height = -sign(lower%radius, lower%curvature())
         end if
      end associate
   end function centre_height

   !> Whether a rotation rolls the bodies on each other: circles, on each other or on a straight surface, with vertical normals.
   pure logical function rolls(self)
      class(contact_model_type), intent(in) :: self

      rolls = self%scene%curvature() > 0.0_wp .and. self%scene%lower%is_regular() .and. self%scene%upper%is_regular() .and. &
              .not. self%scene%mesh%radial
   end function rolls

   !> Distance that the contact has rolled to the right along the surfaces, length: a rotation moves it by -1/K, K the relative
   !> curvature, whichever body rotates. 0 if the bodies do not roll.
   pure real(wp) function rolled(self, fields)
      class(contact_model_type), intent(in) :: self
      type(contact_fields_type), intent(in) :: fields

      rolled = 0.0_wp
      if (self%rolls()) rolled = -fields%motion(motion_rotation)/self%scene%curvature()
   end function rolled

   !> Rigid sliding of the upper surface over the lower one at the origin of x, to the right, length.
   pure real(wp) function slid(self, fields)
      class(contact_model_type), intent(in) :: self
      type(contact_fields_type), intent(in) :: fields

      slid = fields%motion(motion_shift) + self%centre_height()*fields%motion(motion_rotation)
   end function slid

   !> Increase of the gap per unit of rotation, length, shape (nodes). A contact that has rolled by s has the gap g(arc - s), up to
   !> a constant that the approach compensates. For a parabola g = K arc^2/2 the change is -K s arc: the arm is the arc length. For
   !> other gaps, g = K arc^2/2 (1 + b arc^2), the arm arc + 2 b arc^3/3 keeps the least gap at s, to fourth order; the relative
   !> error of the curvature there is 2 b s^2 (see rolling_error).
   function rolling_arm(self) result(arm)
      class(contact_model_type), intent(in) :: self
      real(wp), dimension(self%compliance%nodes) :: arm, gap

      arm = self%arc
      gap = gap_at(self%scene, self%arc)
      where (gap > 0.0_wp .and. abs(self%arc) > 0.0_wp) &
         arm = (self%arc + 4.0_wp*gap/(self%scene%curvature()*self%arc))/3.0_wp
   end function rolling_arm

   !> Relative error of the curvature where the contact has rolled to, see rolling_arm: zero for parabolas on straight lines.
   real(wp) function rolling_error(self, fields)
      class(contact_model_type), intent(in) :: self
      type(contact_fields_type), intent(in) :: fields
      real(wp) :: gap(1)
      integer :: i

      rolling_error = 0.0_wp
      if (.not. self%rolls()) return
      i = minloc(abs(self%arc - self%rolled(fields)), dim=1)
      if (abs(self%arc(i)) < self%width(i)) return
      gap = gap_at(self%scene, [self%arc(i)])
      rolling_error = 2.0_wp*(2.0_wp*gap(1)/(self%scene%curvature()*self%arc(i)**2) - 1.0_wp)
   end function rolling_error

   !> The arms with radial normals: where the normal is inclined, approach and shift have components along both directions; a
   !> rotation, about the disk's centre, only slides the surfaces, by the disk's radius. `side`: 1 if the lower body is the disk, -1
   !> if it is the hole.
   subroutine place_radial_arms(self)
      class(contact_model_type), intent(inout) :: self
      real(wp) :: side

      side = self%scene%lower%curvature()*self%scene%lower%radius
      associate (angle => self%arc/self%scene%arc_radius())
         self%normal_arm(:, motion_approach) = cos(angle)
         self%normal_arm(:, motion_shift) = -side*sin(angle)
         self%tangential_arm(:, motion_approach) = side*sin(angle)
         self%tangential_arm(:, motion_shift) = cos(angle)
      end associate
      self%tangential_arm(:, motion_rotation) = self%centre_height()
   end subroutine place_radial_arms

   !> Default half-width of a mesh, length along the surface: that of the punch, of the profile, or of the contact that the closed
   !> form expects for the largest load, with a margin.
   function estimated_half_width(scene) result(half_width)
      type(scene_type), intent(in) :: scene
      real(wp) :: half_width, largest, beyond
      type(indenter_type) :: indenter

      largest = min(scene%lower%half_extent(), scene%upper%half_extent())
      half_width = largest
      indenter = indenter_of(scene)
      if (indenter%is_flat()) return
      half_width = largest_half_width(scene, largest)
      if (.not. half_width > 0.0_wp) half_width = 1.0e-2_wp*largest
      half_width = room*half_width
      beyond = 2.0_wp*min(largest, 0.25_wp*huge(1.0_wp))
      if (.not. (scene%lower%covers(beyond, scene%mesh%parabolic) .and. scene%upper%covers(beyond, scene%mesh%parabolic))) &
         half_width = min(half_width, largest)
   end function estimated_half_width

end module mfv_contact_model
