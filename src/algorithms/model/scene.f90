!> A scene: bodies, mesh, friction, load history and method. No files, no solution.
module mfv_scene
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite, ieee_quiet_nan, ieee_value
   use mfv_body, only: body_type
   use mfv_compliance, only: coupling_full
   use mfv_element_tree, only: last_not_above
   use mfv_near_field, only: near_field_type, pair_of
   use mfv_friction, only: friction_type
   use mfv_interior, only: has_interior, interior_type, new_interior
   use mfv_kinds, only: pi, wp
   use mfv_material, only: plane_strain
   use mfv_motions, only: motions, motion_approach, motion_count, motion_rotation, control_keep, control_force, &
                          control_displacement, first_control
   use mfv_profile_sampling, only: sufficient_interval
   use mfv_surface_tractions, only: zone_list_type
   use mfv_tolerances, only: visible
   use mfv_wear, only: wear_type
   implicit none
   private
   public :: scene_type, both_rigid, mesh_request_type, step_type, method_type, control_keep, control_force, control_displacement, &
             most_cycles, most_of_datum, algorithm_mfv, algorithm_conventional, stepping_event, stepping_nominal, stepping_leap, &
             stepping_auto, integration_explicit, solver_auto, solver_dgesv, solver_reduced, solver_fft, &
             algorithm_names, stepping_names, integration_names, solver_names, friction_tolerance_part, most_by_points, &
             accuracy_by_mesh, last_with_target

   !> The Method of First Violation (dissertation section 2.3) or the conventional algorithm (2.2). Names here and below: values of
   !> the keys of &solver, in the order of the numbers.
   integer, parameter :: algorithm_mfv = 1, algorithm_conventional = 2
   character(*), parameter :: algorithm_names = 'mfv conventional'
   !> Stepping of the Method of First Violation: what costs least at the allowed error (auto); from rates; from a trial load step
   !> and interpolation (2.3 to 2.5); or in large increments without events, refined until they are accurate.
   integer, parameter :: stepping_auto = 1, stepping_event = 2, stepping_nominal = 3, stepping_leap = 4
   character(*), parameter :: stepping_names = 'auto event nominal leap'
   !> Linear solvers: chosen by size and structure; the augmented system with LAPACK's dgesv; the reduced system with an updated
   !> factorisation; Krylov iteration with products through FFTW.
   integer, parameter :: solver_auto = 1, solver_dgesv = 2, solver_reduced = 3, solver_fft = 4
   character(*), parameter :: solver_names = 'auto dgesv reduced fft'
   !> Integration of nonlinear friction laws: second order with controlled error, or explicit (appendix B).
   integer, parameter :: integration_second_order = 1, integration_explicit = 2
   character(*), parameter :: integration_names = 'second_order explicit'
   !> Most cycles of a step.
   integer, parameter :: most_cycles = 1000000
   !> Largest contact half-width over the datum of the displacements.
   real(wp), parameter :: most_of_datum = 1.2_wp

   !> A step of the load history; targets are reached linearly from the previous step.
   type :: step_type
      !> Control of every motion (mfv_motions), and its target: normal force P >= 0 or approach delta, tangential force Q or shift
      !> U to the right, moment M or rotation counterclockwise; force/length, force (moment), length, radians; bulk stresses,
      !> force/length^2, with control_displacement.
      integer :: control(motion_count) = control_keep
      real(wp) :: target(motion_count) = 0.0_wp
      !> Whether friction acts during this step.
      logical :: friction = .true.
      !> 0: apply the targets once; n: load to the targets and return to the start of the step, n times.
      integer :: cycles = 0
      !> Cycles end early when two consecutive ones are equal within this fraction of the largest traction; 0: never.
      real(wp) :: steady_tolerance = 0.0_wp
      !> Targets of the turning points of each cycle in turn, shape (motions, at least 2), with the controls above; the last ones
      !> end the cycle. Unallocated: a cycle goes to `target` and returns.
      real(wp), allocatable :: path(:, :)
      !> Row of the load history (its first one, with a path) that the step is; 0: none. And whether more rows follow.
      integer :: row = 0
      logical :: is_passed = .false.
   contains
      procedure :: turns => turns_of_step
      procedure :: segments => segments_of_step
      procedure :: extreme
   end type step_type

   !> Algorithm and solver of a scene.
   type :: method_type
      integer :: algorithm = algorithm_mfv, stepping = stepping_event, integration = integration_second_order
      !> The nominal load step dL0 of nominal stepping, the conventional algorithm and explicit integration, as a fraction of each
      !> load segment.
      real(wp) :: load_step = 0.05_wp
      !> Tolerance of the tractions for an increment with nonlinear friction, relative to the largest traction or, if that is
      !> smaller, to the change of the shear over the load segment; 0: see allowed_in_friction.
      real(wp) :: friction_tolerance = 0.0_wp
      !> Most iterations of the conventional algorithm at one load.
      integer :: most_iterations = 1000
      integer :: linear_solver = solver_auto
      !> Tolerance of the relative residual of an iterative linear solver.
      real(wp) :: linear_tolerance = 1.0e-12_wp
      !> Allowed error of large increments: of tractions, relative to the largest; of the dissipation of a segment, relative to that
      !> dissipation. 0: none, only exact ones are taken; accuracy_by_mesh: see choose_stepping in mfv_linear_solvers.
      real(wp) :: accuracy = 0.0_wp
   contains
      procedure :: takes_accuracy
      procedure :: allowed_in_friction
   end type method_type

   !> The accuracy of a method that has not been given one.
   real(wp), parameter :: accuracy_by_mesh = -1.0_wp

   !> Part of the wanted error of dissipation that an increment with nonlinear friction may have in its tractions: load segments
   !> then have an error of 0.1 of the wanted one as a median, and of 0.7 at most (docs/verification.md).
   real(wp), parameter :: friction_tolerance_part = 0.1_wp

   !> Nodes of a mesh by default, and around a neat fit; and most nodes on account of an accuracy, of the points of a profile,
   !> and of these with unequal intervals, whose compliance is a full matrix.
   integer, parameter :: usual_nodes = 101, nodes_around = 360, most_by_accuracy = 3001, most_by_points = 10001, most_refined = 2001

   !> Mesh settings of the user; what is not set is chosen from an estimate of the contact.
   type :: mesh_request_type
      integer :: nodes = usual_nodes
      !> Nodes are the centres of equal intervals over [-half_width, half_width], length along the surface; 0: chosen. Increased
      !> when the contact requires it.
      real(wp) :: half_width = 0.0_wp
      !> Ends of unequal intervals, increasing arc lengths from the origin of x, shape (nodes + 1); unallocated for equal ones.
      real(wp), allocatable :: ends(:)
      !> Whether such intervals are to be chosen, small at the edges of contact and stick zones; and whether the number of intervals
      !> follows from the accuracy (set_accuracy).
      logical :: refined = .false., nodes_by_accuracy = .false.
      !> Whether the number of nodes follows from the contact patches of a profile (follow_patches).
      logical :: nodes_by_patches = .false.
      !> Whether `nodes` intervals cover the whole circle; only those near the contact are modelled.
      logical :: whole_circle = .false.
      !> Whether gaps are those of parabolas instead of circles (Hertz).
      logical :: parabolic = .false.
      !> Whether normals are radial instead of vertical: for a disk in a hole.
      logical :: radial = .false.
      !> Length after which both surfaces and all loads repeat; 0: they do not. Middle of the period that the mesh covers, length,
      !> and whether it has been chosen: with the widest gap at the ends.
      real(wp) :: period = 0.0_wp, middle = 0.0_wp
      logical :: has_middle = .false.
   contains
      procedure :: nodes_for
   end type mesh_request_type

   !> What is wrong with a scene of two rigid bodies, for messages.
   character(*), parameter :: both_rigid = 'both bodies are rigid; at least one must be elastic or have layers'

   type :: scene_type
      character(:), allocatable :: title
      integer :: plane = plane_strain
      integer :: coupling = coupling_full
      !> The bodies below and above; at least one is elastic.
      type(body_type) :: lower, upper
      type(mesh_request_type) :: mesh
      type(friction_type) :: friction
      type(wear_type) :: wear
      type(method_type) :: method
      type(step_type), allocatable :: steps(:)
   contains
      procedure :: set_accuracy
      procedure :: default_nodes
      procedure :: nodes_for_profile
      procedure :: fault
      procedure :: tangential
      procedure :: moves
      procedure :: near_field
      procedure :: is_similar
      procedure :: modulus
      procedure :: near_field_over
      procedure :: is_layered
      procedure :: has_layers
      procedure :: compressed_thickness
      procedure, private :: is_all_on_rigid
      procedure :: curvature
      procedure :: beta
      procedure :: has_datum
      procedure :: datum
      procedure :: arc_radius
      procedure :: x_of_arc
      procedure :: x_in_period
      procedure :: is_neat
      procedure :: repeat_length
      procedure :: repeats_beyond
      procedure :: touchable
      procedure :: last_touchable
      procedure :: can_have_bulk_stress
      procedure :: can_interfere
      procedure :: holds_for_interference
      procedure :: cannot_be_negative
      procedure :: can_repeat
      procedure :: interior
   end type scene_type

contains

   !> Load segments of a cycle of the step, each of which ends at a turning point.
   elemental integer function turns_of_step(self) result(turns)
      class(step_type), intent(in) :: self

      turns = 2
      if (allocated(self%path)) turns = size(self%path, 2)
   end function turns_of_step

   !> The last step that prescribes a motion or its force, 0 for none. A step with cycles ends at its initial loads.
   pure integer function last_with_target(steps, motion) result(last)
      type(step_type), intent(in) :: steps(:)
      integer, intent(in) :: motion

      last = findloc(steps%control(motion) /= control_keep .and. steps%cycles == 0, .true., dim=1, back=.true.)
   end function last_with_target

   !> Load segments of the step: one, or those of all its cycles.
   elemental integer function segments_of_step(self) result(segments)
      class(step_type), intent(in) :: self

      segments = max(1, self%turns()*self%cycles)
   end function segments_of_step

   !> The largest target of a motion under a control, or `-huge` without one.
   elemental real(wp) function extreme(self, motion, control)
      class(step_type), intent(in) :: self
      integer, intent(in) :: motion, control

      extreme = -huge(1.0_wp)
      if (self%control(motion) /= control) return
      extreme = self%target(motion)
      if (allocated(self%path)) extreme = maxval(self%path(motion, :))
   end function extreme

   !> Whether an accuracy has an effect: large increments are possible.
   elemental logical function takes_accuracy(self)
      class(method_type), intent(in) :: self

      takes_accuracy = self%algorithm == algorithm_mfv .and. (self%stepping == stepping_auto .or. self%stepping == stepping_leap)
   end function takes_accuracy

   !> The tolerance of the tractions for an increment with nonlinear friction: the given one, else that of the accuracy, if any.
   elemental real(wp) function allowed_in_friction(self) result(tolerance)
      class(method_type), intent(in) :: self
      real(wp), parameter :: usual = 1.0e-4_wp, least = 1.0e-10_wp

      tolerance = usual
      if (self%accuracy > 0.0_wp) tolerance = max(friction_tolerance_part*self%accuracy, least)
      if (self%friction_tolerance > 0.0_wp) tolerance = self%friction_tolerance
   end function allowed_in_friction

   !> Set the accuracy, and the number of nodes if that follows from it and a finer mesh is more accurate.
   subroutine set_accuracy(self, accuracy)
      class(scene_type), intent(inout) :: self
      real(wp), intent(in) :: accuracy

      self%method%accuracy = accuracy
      if (self%mesh%nodes_by_accuracy .and. self%friction%converges()) self%mesh%nodes = self%default_nodes()
   end subroutine set_accuracy

   !> Number of nodes where the user gives none: that of the accuracy and of the points of a profile.
   integer function default_nodes(self) result(nodes)
      class(scene_type), intent(in) :: self

      nodes = min(self%mesh%nodes_for(self%method%accuracy), most_by_accuracy)
      if (self%is_neat()) nodes = max(nodes, nodes_around)
      nodes = max(nodes, min(self%nodes_for_profile(), merge(most_refined, most_by_points, self%mesh%refined)))
   end function default_nodes

   !> Odd number of equal intervals over the mesh that miss nothing of a profile that would change the pressures under the
   !> largest load, on the average over the mesh; 0 without a profile or such a load, without an upper limit.
   integer function nodes_for_profile(self) result(nodes)
      class(scene_type), intent(in) :: self
      real(wp) :: half_width, pressure, usual, interval

      nodes = 0
      if (.not. (self%lower%is_sampled() .or. self%upper%is_sampled())) return
      half_width = min(self%lower%half_extent(), self%upper%half_extent())
      if (self%mesh%half_width > 0.0_wp) half_width = min(half_width, self%mesh%half_width)
      if (.not. allocated(self%steps) .or. .not. self%modulus() > 0.0_wp .or. half_width >= huge(1.0_wp)) return
      if (size(self%steps) == 0) return
      pressure = 0.5_wp/half_width*max(maxval(self%steps%extreme(motion_approach, control_force)), 0.0_wp, &
                                      self%modulus()*max(maxval(self%steps%extreme(motion_approach, control_displacement)), 0.0_wp))
      if (.not. pressure > 0.0_wp) return
      usual = 2.0_wp*half_width/usual_nodes
      interval = min(sufficient_interval(self%lower, self%modulus(), pressure, usual), &
                     sufficient_interval(self%upper, self%modulus(), pressure, usual))
      if (interval < usual) nodes = 2*nint(min(half_width/interval, 1.0e9_wp)) + 1
   end function nodes_for_profile

   !> Nodes with which the tractions have about the given error (root mean square over the contact, relative to the largest),
   !> without an upper limit; measured (docs/verification.md): on equal intervals 0.3 over the number of nodes, on refined ones 6
   !> over its square. The usual number for accuracy 0.
   elemental integer function nodes_for(self, accuracy) result(nodes)
      class(mesh_request_type), intent(in) :: self
      real(wp), intent(in) :: accuracy
      real(wp), parameter :: error_of_one = 0.3_wp, refined_error_of_one = 6.0_wp
      integer, parameter :: fewest_refined = 60

      nodes = usual_nodes
      if (.not. accuracy > 0.0_wp) return
      if (self%refined) then
         nodes = max(fewest_refined, ceiling(sqrt(refined_error_of_one/accuracy)))
      else
         nodes = max(usual_nodes, 2*nint(min(0.5_wp*error_of_one/accuracy, 1.0e9_wp)) + 1)
      end if
   end function nodes_for

   !> Why a scene cannot be modelled at all, empty if it can. (The readers check much more.)
   pure function fault(self)
      class(scene_type), intent(in) :: self
      character(len=len(both_rigid)) :: fault

      fault = ''
      if (self%lower%rigid .and. self%upper%rigid) fault = both_rigid
   end function fault

   !> Whether the scene requires the tangential problem: a friction law, and a step in which it acts. A scene without steps may get
   !> such steps later.
   pure logical function tangential(self)
      class(scene_type), intent(in) :: self

      tangential = self%friction%acts()
      if (.not. allocated(self%steps)) return
      if (size(self%steps) > 0) tangential = tangential .and. any(self%steps%friction)
   end function tangential

   !> Which motions the scene requires: those that are always modelled, and those that a step controls.
   pure function moves(self)
      class(scene_type), intent(in) :: self
      logical :: moves(motion_count)
      integer :: i

      moves = .not. motions%optional
      if (.not. allocated(self%steps)) return
      do i = 1, motion_count
         moves(i) = moves(i) .or. any(self%steps%control(i) /= control_keep)
      end do
   end function moves

   !> Constants of the near field of both bodies together.
   pure type(near_field_type) function near_field(self) result(both)
      class(scene_type), intent(in) :: self

      both = pair_of(self%lower%elasticity%near_field(), self%upper%elasticity%near_field())
   end function near_field

   !> Whether the bodies are elastically similar: their near field has no coupling. Different shapes couple by the order of a/R
   !> only.
   pure logical function is_similar(self)
      class(scene_type), intent(in) :: self
      real(wp), parameter :: none = 1.0e-12_wp
      type(near_field_type) :: both

      both = self%near_field()
      is_similar = both%coupling_ratio() < none
   end function is_similar

   !> Contact modulus of both bodies, force/length^2: 1/A of mfv_near_field, the sum of those of the elastic bodies, (kappa +
   !> 1)/(4 G) if isotropic (A in dissertation eq. 6.1, corrected for a misprint). Zero if a body has no material.
   pure real(wp) function modulus(self)
      class(scene_type), intent(in) :: self
      type(near_field_type) :: both

      both = self%near_field()
      modulus = both%modulus()
   end function modulus

   !> The constants of both bodies for tractions that vary over a length, see mfv_elasticity; without layers those of the near
   !> field.
   pure type(near_field_type) function near_field_over(self, length) result(both)
      class(scene_type), intent(in) :: self
      real(wp), intent(in) :: length

      both = pair_of(self%lower%elasticity%near_field_over(length), self%upper%elasticity%near_field_over(length))
   end function near_field_over

   !> Whether a body has layers.
   pure logical function is_layered(self)
      class(scene_type), intent(in) :: self

      is_layered = self%has_layers(.false.) .or. self%has_layers(.true.)
   end function is_layered

   !> Whether all that deforms are layers on rigid bodies, or a matrix.
   pure logical function is_all_on_rigid(self)
      class(scene_type), intent(in) :: self

      is_all_on_rigid = (self%lower%rigid .or. .not. self%lower%elasticity%has_datum()) .and. &
                        (self%upper%rigid .or. .not. self%upper%elasticity%has_datum())
   end function is_all_on_rigid

   !> Total thickness of layers between rigid bodies, length; 0 if there is another elastic body.
   pure real(wp) function compressed_thickness(self) result(thickness)
      class(scene_type), intent(in) :: self

      thickness = 0.0_wp
      if (.not. self%is_all_on_rigid()) return
      thickness = self%lower%elasticity%thickness() + self%upper%elasticity%thickness()
   end function compressed_thickness

   !> Whether the lower or the `upper` body has layers.
   pure logical function has_layers(self, upper)
      class(scene_type), intent(in) :: self
      logical, intent(in) :: upper

      has_layers = merge(self%upper%elasticity%is_layered(), self%lower%elasticity%is_layered(), upper)
   end function has_layers

   !> Relative curvature K = 1/R1 + 1/R2 of dissertation eq. 6.1, 1/length.
   pure real(wp) function curvature(self)
      class(scene_type), intent(in) :: self

      curvature = self%lower%curvature() + self%upper%curvature()
   end function curvature

   !> Dundurs' second parameter, see mfv_near_field.
   pure real(wp) function beta(self)
      class(scene_type), intent(in) :: self
      type(near_field_type) :: both

      both = self%near_field()
      beta = both%beta()
   end function beta

   !> Whether the displacements are measured at a datum inside of bodies: half-planes and the like, not circles.
   pure logical function has_datum(self)
      class(scene_type), intent(in) :: self

      has_datum = .not. (self%lower%circular() .or. self%upper%circular() .or. self%is_all_on_rigid())
   end function has_datum

   !> Datum of the displacements of both bodies together, length: the mean of the logarithms of their datums, weighted with their
   !> flexibilities under pressure or, if `by_shear`, under shear.
   pure real(wp) function datum(self, by_shear)
      class(scene_type), intent(in) :: self
      logical, intent(in), optional :: by_shear
      real(wp) :: flexibility(2), logarithm(2)

      flexibility = [of_body(self%lower), of_body(self%upper)]
      logarithm = 0.0_wp
      where (flexibility > 0.0_wp) logarithm = log([self%lower%elasticity%datum, self%upper%elasticity%datum])
      datum = exp(sum(flexibility*logarithm)/sum(flexibility))
      if (.not. flexibility(2) > 0.0_wp) datum = self%lower%elasticity%datum
      if (.not. flexibility(1) > 0.0_wp) datum = self%upper%elasticity%datum

   contains

      pure real(wp) function of_body(body)
         type(body_type), intent(in) :: body
         type(near_field_type) :: constants

         constants = body%elasticity%near_field()
         of_body = constants%normal
         if (present(by_shear)) of_body = merge(constants%tangential, constants%normal, by_shear)
      end function of_body
   end function datum

   !> Radius of the circle of the nodes, length: with radial normals that of the hole, along whose radii gaps are measured; else
   !> that of the smaller elastic circle; 0 for nodes on a straight line.
   pure real(wp) function arc_radius(self)
      class(scene_type), intent(in) :: self

      arc_radius = max(self%lower%radius, self%upper%radius)
      if (self%mesh%radial) return
      arc_radius = 0.0_wp
      if (self%upper%deforms_as_circle()) arc_radius = self%upper%radius
      if (.not. self%lower%deforms_as_circle()) return
      if (.not. arc_radius > 0.0_wp .or. self%lower%radius < arc_radius) arc_radius = self%lower%radius
   end function arc_radius

   !> x of the node at an arc length from the origin of x, lengths.
   elemental real(wp) function x_of_arc(self, arc) result(x)
      class(scene_type), intent(in) :: self
      real(wp), intent(in) :: arc
      real(wp) :: radius

      radius = self%arc_radius()
      x = arc
      if (radius > 0.0_wp) x = radius*sin(arc/radius)
   end function x_of_arc

   !> Whether a disk and its hole have one radius, so that they touch all around.
   pure logical function is_neat(self)
      class(scene_type), intent(in) :: self

      is_neat = self%mesh%radial .and. self%lower%circular() .and. self%upper%circular() .and. &
                .not. abs(self%curvature()) > 0.0_wp
   end function is_neat

   !> Arc length after which both surfaces repeat: the period, the circumference of a neat fit, or 0.
   pure real(wp) function repeat_length(self) result(length)
      class(scene_type), intent(in) :: self

      length = self%mesh%period
      if (self%is_neat()) length = 2.0_wp*pi*self%arc_radius()
   end function repeat_length

   !> Whether an arc length is an end of the mesh beyond which the surfaces repeat.
   elemental logical function repeats_beyond(self, arc)
      class(scene_type), intent(in) :: self
      real(wp), intent(in) :: arc

      real(wp) :: length

      length = self%repeat_length()
      repeats_beyond = length > 0.0_wp .and. abs(arc - self%mesh%middle) > 0.5_wp*length*(1.0_wp - visible)
   end function repeats_beyond

   !> The same x, length, or its image in the period about the origin.
   elemental real(wp) function x_in_period(self, x) result(image)
      class(scene_type), intent(in) :: self
      real(wp), intent(in) :: x

      image = x
      if (self%mesh%period > 0.0_wp) image = x - self%mesh%period*anint(x/self%mesh%period)
   end function x_in_period

   !> Whether both bodies have a surface at an arc length (length) from the origin of x: on a circle up to 90 degrees, with radial
   !> normals up to 180, where the radius of the hole meets the disk; of surfaces that repeat, and of a neat fit, within one length.
   elemental logical function touchable(self, arc)
      class(scene_type), intent(in) :: self
      real(wp), intent(in) :: arc
      real(wp) :: radius, x, length

      radius = self%arc_radius()
      x = self%x_in_period(self%x_of_arc(arc))
      if (self%mesh%radial) then
         touchable = abs(x)*abs(self%lower%radius - self%upper%radius) < radius*min(self%lower%radius, self%upper%radius)
      else
         touchable = self%lower%covers(x, self%mesh%parabolic) .and. self%upper%covers(x, self%mesh%parabolic)
      end if
      length = self%repeat_length()
      if (length > 0.0_wp) then
         touchable = touchable .and. abs(arc - self%mesh%middle) < 0.5_wp*length
      else if (radius > 0.0_wp) then
         touchable = touchable .and. abs(arc) < merge(pi, 0.5_wp*pi, self%mesh%radial)*radius
      end if
   end function touchable

   !> `outside`, or the end of the surface between it and `inside` (by bisection); arc lengths.
   pure real(wp) function last_touchable(self, inside, outside) result(last)
      class(scene_type), intent(in) :: self
      real(wp), intent(in) :: inside, outside
      real(wp) :: beyond, middle
      integer :: i

      last = outside
      if (self%touchable(outside)) return
      last = inside
      beyond = outside
      do i = 1, digits(1.0_wp)
         middle = 0.5_wp*(last + beyond)
         if (self%touchable(middle)) then
            last = middle
         else
            beyond = middle
         end if
      end do
   end function last_touchable

   !> Whether the lower or `upper` body can have a bulk stress: an elastic body that deforms like a half-plane.
   pure logical function can_have_bulk_stress(self, upper)
      class(scene_type), intent(in) :: self
      logical, intent(in) :: upper

      can_have_bulk_stress = merge(of_body(self%upper), of_body(self%lower), upper)

   contains

      pure logical function of_body(body)
         type(body_type), intent(in) :: body

         of_body = has_interior(body) .and. body%elasticity%strain_by_bulk_stress() > 0.0_wp .and. .not. body%deforms_as_circle()
      end function of_body
   end function can_have_bulk_stress

   !> Whether an interference can close all gaps: with vertical normals, or between a disk and a hole of one radius.
   pure logical function can_interfere(self)
      class(scene_type), intent(in) :: self

      can_interfere = self%is_neat() .or. .not. self%mesh%radial
   end function can_interfere

   !> Whether the upper body keeps its place against an interference, under a `control` of the approach: at a given normal force
   !> with vertical normals it would only be lifted.
   pure logical function holds_for_interference(self, control)
      class(scene_type), intent(in) :: self
      integer, intent(in) :: control

      holds_for_interference = self%mesh%radial .or. control == control_displacement
   end function holds_for_interference

   !> Whether the target of a motion under a control must be at least 0.
   elemental logical function cannot_be_negative(self, motion, control)
      class(scene_type), intent(in) :: self
      integer, intent(in) :: motion, control

      cannot_be_negative = motions(motion)%pushes .and. control == first_control(motion) .and. &
                           .not. (control == control_force .and. self%is_neat())
   end function cannot_be_negative

   !> Whether a motion displaces surfaces that repeat alike in every period: not a rotation or a bulk stress.
   pure logical function can_repeat(self, motion)
      class(scene_type), intent(in) :: self
      integer, intent(in) :: motion

      can_repeat = .not. self%mesh%period > 0.0_wp .or. .not. (motion == motion_rotation .or. motions(motion)%is_stress)
   end function can_repeat

   !> The lower or `upper` body under tractions, see mfv_interior. With radial normals the angles of the nodes are common to both
   !> bodies and their forces are equal; arcs and tractions are not.
   !> `contact_edge`, `stick_edge`: edges of the zones between nodes, ascending at the nodes with finite values, the left and the
   !> right one of each zone in turn; shape (nodes). `bulk`: its bulk stress, force/length^2. `available`: false for a rigid body or
   !> a given matrix. `fewest_elements`: see mfv_surface_tractions.
   recursive subroutine interior(self, upper, arc, width, pressure, shear, contact_edge, stick_edge, bulk, inside, available, &
                                 fewest_elements)
      class(scene_type), intent(in) :: self
      logical, intent(in) :: upper
      real(wp), intent(in), dimension(:) :: arc, width, pressure, shear, contact_edge, stick_edge
      real(wp), intent(in) :: bulk
      type(interior_type), intent(out) :: inside
      logical, intent(out) :: available
      integer, intent(in), optional :: fewest_elements
      type(zone_list_type) :: zones
      real(wp) :: ratio
      integer :: i, side, first

      zones%closed = self%is_neat() .and. all(abs(pressure) > 0.0_wp)
      first = 1
      if (self%is_neat()) first = last_in_gap(pressure)
      if (first > 1) then
         ! A contact across the ends of the mesh, in one piece.
         associate (order => [(i, i=first, size(arc)), (i, i=1, first - 1)], &
                    turn => [(0.0_wp, i=first, size(arc)), (self%repeat_length(), i=1, first - 1)])
            call self%interior(upper, arc(order) + turn, width(order), pressure(order), shear(order), &
                               without_seam(self, contact_edge(order) + turn), without_seam(self, stick_edge(order) + turn), bulk, &
                               inside, available, fewest_elements)
         end associate
         return
      end if
      ratio = 1.0_wp
      if (self%mesh%radial) ratio = merge(self%upper%radius, self%lower%radius, upper)/self%arc_radius()
      zones%contact = pairs(contact_edge)
      zones%stick = ratio*pairs(stick_edge)
      allocate (zones%sharp(2, size(zones%contact, 2)))
      do i = 1, size(zones%contact, 2)
         do side = 1, 2
            zones%sharp(side, i) = ends_with_body(self, arc, width, zones%contact(side, i), 2*side - 3)
         end do
      end do
      if (all(self%repeats_beyond(pack(zones%contact, zones%sharp)))) zones%period = ratio*self%repeat_length()
      zones%contact = ratio*zones%contact
      if (self%coupling == coupling_full) zones%pair = self%near_field()
      zones%middle = self%mesh%middle
      if (present(fewest_elements)) zones%fewest_elements = fewest_elements
      if (upper) then
         call new_interior(self%upper, upper, self%mesh%radial, ratio*arc, ratio*width, pressure/ratio, &
                           shear/ratio, zones, inside, available)
      else
         call new_interior(self%lower, upper, self%mesh%radial, ratio*arc, ratio*width, pressure/ratio, &
                           shear/ratio, zones, inside, available)
      end if
      inside%bulk = bulk
   end subroutine interior

   !> The last unloaded node if the loaded ones at both ends belong together, else 1.
   pure integer function last_in_gap(pressure) result(first)
      real(wp), intent(in) :: pressure(:)
      integer :: n

      first = 1
      n = size(pressure)
      if (all(abs(pressure) > 0.0_wp) .or. .not. (abs(pressure(1)) > 0.0_wp .and. abs(pressure(n)) > 0.0_wp)) return
      first = findloc(abs(pressure) > 0.0_wp, .false., dim=1, back=.true.)
   end function last_in_gap

   !> Edges without those at the end of the mesh, which is inside of a zone; NaN in their place.
   pure function without_seam(scene, edges) result(cleared)
      type(scene_type), intent(in) :: scene
      real(wp), intent(in) :: edges(:)
      real(wp) :: cleared(size(edges)), seam

      seam = scene%mesh%middle + 0.5_wp*scene%repeat_length()
      cleared = merge(ieee_value(1.0_wp, ieee_quiet_nan), edges, abs(edges - seam) <= visible*scene%repeat_length())
   end function without_seam

   !> Whether a contact zone ends on the left (`side` -1) or right (1) where a body does, so that the pressure does not vanish
   !> there: at an `edge` that is the end of the body, or of the interval of its last node. `arc`, `width`: see interior.
   pure logical function ends_with_body(self, arc, width, edge, side)
      class(scene_type), intent(in) :: self
      real(wp), intent(in) :: arc(:), width(:), edge
      integer, intent(in) :: side
      integer :: before, node

      ! The nearest end of an interval is that of one of the nodes next to the edge.
      before = max(1, last_not_above(arc, edge) - 1)
      associate (near => before, beyond => min(before + 3, size(arc)))
         node = near - 1 + minloc(abs(arc(near:beyond) + side*0.5_wp*width(near:beyond) - edge), dim=1)
      end associate
      associate (tiny_step => side*visible*width(node))
         ends_with_body = self%touchable(edge - tiny_step) .and. .not. self%touchable(edge + tiny_step)
         if (abs(arc(node) + side*0.5_wp*width(node) - edge) <= abs(tiny_step)) &
            ends_with_body = .not. self%touchable(arc(node) + side*width(node))
      end associate
   end function ends_with_body

   !> The finite values as pairs, shape (2, pairs); none if they are not ascending.
   pure function pairs(edges)
      real(wp), intent(in) :: edges(:)
      real(wp), allocatable :: pairs(:, :)
      real(wp), allocatable :: known(:)
      integer :: n

      known = pack(edges, ieee_is_finite(edges))
      n = size(known)
      if (mod(n, 2) /= 0) n = 0
      if (any(known(2:n) < known(:n - 1))) n = 0
      pairs = reshape(known(:n), [2, n/2])
   end function pairs

end module mfv_scene
