!> Stick-slip events that accumulate at a finite load, and how to pass them.
!>
!> Under static and kinetic friction a node near the edge of a shrinking contact sticks at |tau| = mu_k p, slips when p has
!> decreased so far that |tau| = mu_s p, drops to mu_k p, and sticks again. Its events form a geometric sequence with a ratio near
!> mu_k/mu_s, which accumulates where its pressure vanishes.
!>
!> The limit does not depend on the sequence: there p = tau = 0 at the node, its friction cone has shrunk to the apex, and all
!> other nodes are unchanged. The node is therefore taken to the apex along the ray tau/p = constant, which starts at its present
!> tractions and stays inside the cone. It slips in one direction only, against tau. The error of its dissipation is of first
!> order in 1 - mu_k/mu_s and of second order in the remaining load. The node then opens.
module mfv_accumulation
   use mfv_contact_path, only: contact_path_type
   use mfv_contact_system, only: constraints_type
   use mfv_friction_law, only: friction_row_type
   use mfv_increment, only: find_increment, increment_type
   use mfv_kinds, only: wp
   use mfv_node_status
   implicit none
   private
   public :: pass_accumulation

contains

   !> Advance to the load at which the first pressures vanish, with all nodes that alternate between stick and slip, if it is
   !> within the fraction `near` of the segment and no other event occurs before.
   !> `constraints`: from contact_path_type%find_constraints. `left`: the rest of the segment. `rate_tolerance`: rates below this
   !> fraction of the largest count as zero. `passed`: whether it succeeds; `increment` and the statuses of `path` are then set.
   !> Otherwise only `increment` has changed and is invalid.
   subroutine pass_accumulation(path, constraints, left, near, rate_tolerance, increment, passed)
      class(contact_path_type), intent(inout) :: path
      type(constraints_type), intent(in) :: constraints
      real(wp), intent(in) :: left, near, rate_tolerance
      type(increment_type), intent(inout) :: increment
      logical, intent(out) :: passed
      type(constraints_type) :: rays
      integer :: status(size(path%state%status))
      logical :: alternates(size(path%state%status))

      passed = .false.
      if (.not. path%model%scene%friction%acts()) return
      if (.not. path%model%scene%friction%law%drops .or. path%has_over_stress()) return
      call find_increment(path, constraints, left, .false., rate_tolerance, increment)
      if (increment%singular) return
      alternates = vanish(path, increment, near)
      if (.not. any(alternates)) return
      status = path%state%status
      rays = constraints
      call set_rays(path, alternates, rays)
      call path%state%set_status(alternates, rays%status)
      call find_increment(path, rays, left, .false., rate_tolerance, increment)
      passed = opens_first(increment, alternates, near)
      if (.not. passed) path%state%status = status
   end subroutine pass_accumulation

   !> Nodes with shear whose pressure vanishes soon.
   pure function vanish(path, increment, near)
      class(contact_path_type), intent(in) :: path
      type(increment_type), intent(in) :: increment
      real(wp), intent(in) :: near
      logical :: vanish(size(path%state%status))

      associate (pressure => path%state%fields%pressure)
         vanish = in_contact(path%state%status) .and. pressure > 0.0_wp .and. abs(path%state%fields%shear) > 0.0_wp &
                  .and. pressure + near*increment%response%rate%pressure < 0.0_wp &
                  .and. path%model%kinetic_friction < path%model%static_friction
      end associate
   end function vanish

   !> Let these nodes slip against their shear traction, on the line tau = (tau/p) p.
   pure subroutine set_rays(path, nodes, constraints)
      class(contact_path_type), intent(in) :: path
      logical, intent(in) :: nodes(:)
      type(constraints_type), intent(inout) :: constraints
      integer :: i

      do i = 1, size(nodes)
         if (.not. nodes(i)) cycle
         associate (pressure => path%state%fields%pressure(i), shear => path%state%fields%shear(i))
            constraints%status(i) = merge(node_slip_left, node_slip_right, shear > 0.0_wp)
            constraints%row(i) = friction_row_type(slope=shear/pressure)
         end associate
      end do
   end subroutine set_rays

   !> Whether the increment ends soon because nodes of this set, and no others, open.
   pure logical function opens_first(increment, nodes, near)
      type(increment_type), intent(in) :: increment
      logical, intent(in) :: nodes(:)
      real(wp), intent(in) :: near
      logical :: first(size(nodes))

      opens_first = .false.
      if (increment%singular .or. .not. increment%ends_in_event .or. increment%step > near) return
      first = increment%violations%soonest <= increment%reach
      opens_first = all(nodes .or. .not. first) .and. all(increment%violations%kind == event_open .or. .not. first)
   end function opens_first

end module mfv_accumulation
