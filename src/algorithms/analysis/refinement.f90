!> A mesh that is fine at the edges of contact and stick zones, found by solving the same scene on coarser meshes: first on equal
!> intervals, then on intervals graded by its edges, which resolve slip zones that were narrower than an interval. Contact edges are
!> those on equal intervals, where their discretisation error is known (mfv_zone_edges).
module mfv_refinement
   use mfv_discretisation_error, only: scene_on_mesh
   use mfv_graded_mesh, only: graded_ends
   use mfv_kinds, only: wp
   use mfv_motions, only: motion_approach
   use mfv_observer, only: observer_type, relay_type
   use mfv_reference_indenter, only: indenter_type
   use mfv_resolution, only: poorest_patch
   use mfv_scene, only: control_displacement, control_force, most_by_points, scene_type, solver_auto, step_type
   use mfv_scene_indenter, only: indenter_of
   use mfv_simulation, only: history_none, new_simulation, simulation_type, states_reversals
   use mfv_status, only: MFV_COMPLETE, MFV_INTERRUPTED, MFV_MESH_EXCEEDED
   use mfv_tolerances, only: visible
   use mfv_zone_edges, only: find_patches, patch_type, zone_type
   implicit none
   private
   public :: refine_at_edges, follow_patches

   !> Coarser meshes have this part of the nodes, and at least this many.
   real(wp), parameter :: coarse_part = 0.5_wp
   integer, parameter :: fewest_coarse = 60
   !> Room beyond the outermost contact edges, relative to the distance between them; factor if it was too small.
   real(wp), parameter :: room = 0.06_wp, more = 3.0_wp
   !> Most cycles of a step on the coarser meshes.
   integer, parameter :: most_cycles = 2

   !> The edges of some states, their ranks (those of the last state first; even: of contact; then odd: of stick zones), and the
   !> outermost ones; lengths.
   type :: edges_type
      real(wp), allocatable :: points(:)
      integer, allocatable :: rank(:)
      real(wp) :: left = huge(1.0_wp), right = -huge(1.0_wp)
      !> Whether a body ends at the outermost edge.
      logical :: left_ends = .false., right_ends = .false.
   end type edges_type

contains

   !> Set the mesh of a scene to intervals that are small at the edges at the ends of its steps and reversals. Without contact, or
   !> if the scene has a fault, the mesh is unchanged. `interrupted`: `observer` stopped it; the mesh is unchanged.
   subroutine refine_at_edges(scene, interrupted, observer)
      type(scene_type), intent(inout) :: scene
      logical, intent(out) :: interrupted
      class(observer_type), intent(inout), target, optional :: observer
      integer, parameter :: passes = 3, most_passes = 6
      type(relay_type) :: watch
      type(scene_type) :: trial
      type(simulation_type) :: coarse
      type(edges_type) :: edges, first
      real(wp), allocatable :: ends(:)
      real(wp) :: extra
      integer :: nodes, pass, outcome
      logical :: exceeded, is_last

      interrupted = .false.
      if (scene%fault() /= '') return
      nodes = scene%mesh%nodes
      if (present(observer)) watch%caller => observer
      watch%runs = passes
      trial = scene_on_mesh(scene, max(nint(coarse_part*nodes), fewest_coarse))
      trial%steps%cycles = min(trial%steps%cycles, most_cycles)
      ! The mesh is that of the scene, whatever its solver.
      trial%method%linear_solver = solver_auto
      extra = room
      do pass = 1, most_passes
         watch%before = min(pass, passes) - 1
         coarse = new_simulation(trial, history_none, states_reversals)
         call coarse%run(watch)
         interrupted = coarse%outcome == MFV_INTERRUPTED
         if (interrupted) return
         call find_edges(coarse, edges)
         if (.not. edges%left < edges%right) return
         if (pass == 1) then
            first = edges
            outcome = coarse%outcome
         else if (coarse%outcome == outcome) then
            call take_contact(first, edges)
         else
            ! It ended before the contact reached its size.
            edges = first
         end if
         call add_tip(scene, edges)
         ! The contact may jump to the next asperity, or become wider on the finer mesh.
         exceeded = pass > 1 .and. coarse%outcome == MFV_MESH_EXCEEDED
         if (exceeded) extra = more*extra
         is_last = pass == most_passes .or. (pass >= passes .and. .not. exceeded)
         call limit(scene, edges, extra)
         call graded_ends(edges%points, edges%rank, edges%left, edges%right, merge(nodes, trial%mesh%nodes, is_last), ends)
         trial%mesh%ends = ends
         trial%mesh%nodes = size(ends) - 1
         if (is_last) exit
      end do
      scene%mesh%ends = ends
      scene%mesh%nodes = size(ends) - 1
   end subroutine refine_at_edges

   !> Increase the number of nodes of a scene until every contact patch that matters has enough of them under its largest load,
   !> without friction. `interrupted`: as above.
   subroutine follow_patches(scene, interrupted, observer)
      type(scene_type), intent(inout) :: scene
      logical, intent(out) :: interrupted
      class(observer_type), intent(inout), target, optional :: observer
      integer, parameter :: wanted = 20, most_passes = 8
      type(relay_type) :: watch
      type(scene_type) :: trial
      type(simulation_type) :: pressed
      type(zone_type) :: patch
      real(wp) :: part
      integer :: pass

      interrupted = .false.
      if (scene%fault() /= '' .or. size(scene%steps) == 0) return
      if (present(observer)) watch%caller => observer
      watch%runs = most_passes
      trial = scene
      trial%steps = [largest_press(scene%steps)]
      do pass = 1, most_passes
         trial%mesh%nodes = scene%mesh%nodes
         pressed = new_simulation(trial, history_none)
         watch%before = pass - 1
         call pressed%run(watch)
         interrupted = pressed%outcome == MFV_INTERRUPTED
         if (pressed%outcome /= MFV_COMPLETE .or. pressed%contact%state%contact_nodes() == 0) return
         patch = poorest_patch(pressed)
         part = real(patch%last - patch%first + 1, wp)/wanted
         if (part >= 1.0_wp .or. scene%mesh%nodes >= most_by_points) return
         scene%mesh%nodes = min(2*ceiling(0.5_wp*scene%mesh%nodes/part) + 1, most_by_points)
      end do
   end subroutine follow_patches

   !> A step that presses to the largest target of the approach, or of its force, of some steps, without friction.
   pure type(step_type) function largest_press(steps) result(press)
      type(step_type), intent(in) :: steps(:)
      real(wp) :: target

      press%friction = .false.
      press%control(motion_approach) = control_force
      target = maxval(steps%extreme(motion_approach, control_force))
      if (.not. target > 0.0_wp) then
         press%control(motion_approach) = control_displacement
         target = maxval(steps%extreme(motion_approach, control_displacement))
      end if
      press%target(motion_approach) = target
   end function largest_press

   !> The edges at the ends of all steps and reversals, and at the end of the run.
   subroutine find_edges(simulation, edges)
      type(simulation_type), intent(in) :: simulation
      type(edges_type), intent(out) :: edges
      type(patch_type), allocatable :: patches(:)
      integer :: i, j, k, rank

      allocate (edges%points(0), edges%rank(0))
      do i = simulation%snapshot_count + 1, 1, -1
         if (i > simulation%snapshot_count) then
            call find_patches(simulation%contact%model, simulation%contact%state, patches)
         else
            call find_patches(simulation%contact%model, simulation%padded(simulation%snapshots(i)), patches)
         end if
         rank = 2*(simulation%snapshot_count + 1 - i)
         do j = 1, size(patches)
            associate (patch => patches(j))
               edges%points = [edges%points, patch%left, patch%right]
               edges%rank = [edges%rank, rank, rank]
               do k = 1, size(patch%stick)
                  edges%points = [edges%points, patch%stick(k)%left, patch%stick(k)%right]
                  edges%rank = [edges%rank, rank + 1, rank + 1]
               end do
               if (patch%left < edges%left) edges%left_ends = patch%left_ends
               if (patch%right > edges%right) edges%right_ends = patch%right_ends
               edges%left = min(edges%left, patch%left)
               edges%right = max(edges%right, patch%right)
            end associate
         end do
      end do
   end subroutine find_edges

   !> Replace contact edges by those of the first pass that are very near, relative to the distance of the outermost ones, but not
   !> one in the middle between two of them: round-off must not decide.
   subroutine take_contact(first, edges)
      type(edges_type), intent(in) :: first
      type(edges_type), intent(inout) :: edges
      real(wp), parameter :: very_near = 2.0e-3_wp
      real(wp) :: away(size(first%points)), nearest
      logical :: tied(size(first%points))
      integer :: i

      do i = 1, size(edges%points)
         if (modulo(edges%rank(i), 2) /= 0) cycle
         away = first%points - edges%points(i)
         where (modulo(first%rank, 2) /= 0) away = huge(nearest)
         nearest = minval(abs(away))
         tied = abs(away) <= (1.0_wp + visible)*nearest
         if (nearest > very_near*(first%right - first%left)) cycle
         if (any(tied .and. away > 0.0_wp) .and. any(tied .and. away < 0.0_wp)) cycle
         edges%points(i) = first%points(minloc(abs(away), dim=1))
      end do
   end subroutine take_contact

   !> The tip of a wedge is a point of large pressure too.
   subroutine add_tip(scene, edges)
      type(scene_type), intent(in) :: scene
      type(edges_type), intent(inout) :: edges
      type(indenter_type) :: indenter

      indenter = indenter_of(scene)
      if (indenter%is_flat() .or. .not. indenter%is_pointed()) return
      edges%points = [0.0_wp, edges%points]
      edges%rank = [-1, edges%rank]
   end subroutine add_tip

   !> Widen the range of the edges to that of the mesh: by a `part` of it on either side, but not beyond the mesh of the user or
   !> the end of a body, which must be an end of an interval.
   subroutine limit(scene, edges, part)
      type(scene_type), intent(in) :: scene
      type(edges_type), intent(inout) :: edges
      real(wp), intent(in) :: part
      real(wp) :: extra, most

      extra = part*(edges%right - edges%left)
      most = huge(1.0_wp)
      if (scene%mesh%half_width > 0.0_wp) most = scene%mesh%half_width
      if (.not. edges%left_ends) edges%left = max(scene%last_touchable(edges%left, edges%left - extra), -most)
      if (.not. edges%right_ends) edges%right = min(scene%last_touchable(edges%right, edges%right + extra), most)
   end subroutine limit

end module mfv_refinement
