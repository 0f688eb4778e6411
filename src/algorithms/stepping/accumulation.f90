!> Stick-slip whose events accumulate at a finite load, and the way past it.
!>
!> Under static and kinetic friction a node near the edge of a contact that shrinks sticks at |tau| = mu_k p, slips when p has
!> fallen so far that |tau| = mu_s p, drops to mu_k p, sticks again. Its events follow each other in a geometric sequence, with a
!> ratio near mu_k/mu_s, that accumulates where its pressure vanishes.
!>
!> The limit does not depend on the sequence: there p = tau = 0 at the node, its friction cone has shrunk to its apex, and all other
!> nodes are as they were. So the node is led to the apex along the ray tau/p = constant, which begins where the node is
!> and stays inside the cone. Its slip on the way has one direction, for it slips only against tau; what it dissipates is exact to
!> first order in 1 - mu_k/mu_s, of the square of the remaining load. The node then opens.
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

   !> Go to where the first pressures vanish with all nodes that slip again and again on the way, if that is within `near`, a part
   !> of the segment, and nothing else happens before.
   !> `constraints`: as contact_path_type%find_constraints leaves them. `left`: what is left of the segment. `round_off`: rates
   !> below this part of the largest count as zero. `increment`: the way there, if `passed`; the path's statuses are then those on
   !> it. Otherwise nothing has changed, except that `increment` is of no use.
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
      if (.not. path%model%scene%friction%law%drops() .or. path%has_over_stress()) return
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

   !> The nodes with shear whose pressure vanishes soon.
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

   !> Let these nodes slip against their shear traction, along tau = (tau/p) p.
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

   !> Whether the increment ends soon because nodes among these open, and they only.
   pure logical function opens_first(increment, nodes, near)
      type(increment_type), intent(in) :: increment
      logical, intent(in) :: nodes(:)
      real(wp), intent(in) :: near
      logical :: first(size(nodes))

      opens_first = .false.
      if (increment%singular .or. .not. increment%ends_in_event .or. increment%step > near) return
      first = increment%violations%step <= increment%reach
      opens_first = all(nodes .or. .not. first) .and. all(increment%violations%kind == event_open .or. .not. first)
   end function opens_first

end module mfv_accumulation
