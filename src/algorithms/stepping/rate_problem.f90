!> The rates of all undecided nodes at once, where changing statuses one by one fails: a linear complementarity problem, solved by
!> Lemke's algorithm (Klarbring 1990; Cottle, Pang and Stone, The Linear Complementarity Problem, section 4.4). For Coulomb
!> friction and without friction.
!>
!> Undecided are nodes that touch without pressure (they can open, stick or slip either way) and nodes at their friction limit
!> (they can stick or continue to slip). With all of them stuck the system gives the rates of pressure and shear for given rates z
!> of gap and slip; then w = q + M z, z >= 0, w >= 0, w z = 0 with
!>
!>     z = gap', v+, v- (slip to the right, to the left),    w = p', mu p' + tau', mu p' - tau'.
module mfv_rate_problem
   use mfv_contact_path, only: contact_path_type
   use mfv_contact_system
   use mfv_inequalities, only: slack, status_after
   use mfv_kinds, only: wp
   use mfv_motions, only: motion_approach
   use mfv_node_status
   use mfv_tolerances, only: significant
   implicit none
   private
   public :: find_statuses_by_rates

contains

   !> Statuses with consistent rates for the loads of `constraints`; the statuses of these are ignored. `found`: whether there are
   !> any; otherwise the statuses of `path` are unchanged.
   subroutine find_statuses_by_rates(path, constraints, found)
      class(contact_path_type), intent(inout) :: path
      type(constraints_type), intent(in) :: constraints
      logical, intent(out) :: found
      type(constraints_type) :: base
      integer, allocatable :: node(:), event(:)
      real(wp), allocatable :: matrix(:, :), constant(:), z(:)
      integer :: status(size(path%state%status)), i
      logical :: singular, mask(size(path%state%status))

      found = .false.
      if (path%has_over_stress()) return
      if (path%model%scene%friction%acts()) then
         if (.not. path%model%scene%friction%law%is_linear .or. path%model%scene%friction%law%drops) return
      end if
      call find_undecided(path, node, event)
      if (size(node) == 0) return
      base = constraints
      base%status = path%state%status
      base%stuck_slip = path%state%fields%slip()
      base%status(node) = merge(node_stick, node_frictionless, path%model%tangential)
      call influence(path, base, node, event, matrix, constant, singular)
      if (singular) return
      call lemke(matrix, constant, z, found)
      if (.not. found) return
      status = base%status
      do i = 1, size(node)
         if (z(i) > 0.0_wp .and. in_contact(status(node(i)))) &
            status(node(i)) = status_after(event(i), status(node(i)), .true., 0, node_stick)
      end do
      mask = status /= path%state%status
      call path%set_status(mask, status)
   end subroutine find_statuses_by_rates

   !> The unknowns: node and event of each, at which its inequality is violated.
   subroutine find_undecided(path, node, event)
      class(contact_path_type), intent(in) :: path
      integer, allocatable, intent(out) :: node(:), event(:)
      real(wp), parameter :: closed = 1.0e-12_wp
      real(wp), dimension(size(path%state%status)) :: gap
      real(wp) :: pressure_scale, gap_scale, limit
      integer :: i

      gap = path%model%gap(path%state%fields)
      gap_scale = max(maxval(abs(path%model%initial_gap)), abs(path%state%fields%motion(motion_approach)))
      pressure_scale = path%certificate%traction_scale
      allocate (node(0), event(0))
      do i = 1, size(gap)
         associate (pressure => path%state%fields%pressure(i), shear => path%state%fields%shear(i))
            if (in_contact(path%state%status(i)) .and. pressure > significant*pressure_scale) then
               limit = path%model%static_friction(i)*pressure
               if (.not. path%model%tangential .or. abs(shear) < limit*(1.0_wp - significant)) cycle
               node = [node, i]
               event = [event, merge(event_slip_left, event_slip_right, shear > 0.0_wp)]
            else if (in_contact(path%state%status(i)) .or. &
                     (path%model%can_touch(i) .and. gap(i) <= closed*gap_scale)) then
               node = [node, i]
               event = [event, event_open]
               if (.not. path%model%tangential) cycle
               node = [node, i, i]
               event = [event, event_slip_right, event_slip_left]
            end if
         end associate
      end do
   end subroutine find_undecided

   !> M and q, each scaled by its largest entry.
   subroutine influence(path, base, node, event, matrix, constant, singular)
      class(contact_path_type), intent(inout) :: path
      type(constraints_type), intent(in) :: base
      integer, intent(in) :: node(:), event(:)
      real(wp), allocatable, intent(out) :: matrix(:, :), constant(:)
      logical, intent(out) :: singular
      type(constraints_type) :: moved
      integer :: j, m

      m = size(node)
      allocate (matrix(m, m), constant(m))
      call respond(base, constant)
      do j = 1, m
         if (singular) return
         moved = base
         allocate (moved%gap_rate(size(base%status)), moved%slip_rate(size(base%status)), source=0.0_wp)
         if (event(j) == event_open) then
            moved%gap_rate(node(j)) = path%model%length()
         else
            moved%slip_rate(node(j)) = merge(1, -1, event(j) == event_slip_right)*path%model%length()
         end if
         call respond(moved, matrix(:, j))
         matrix(:, j) = matrix(:, j) - constant
      end do
      constant = constant/max(maxval(abs(constant)), tiny(1.0_wp))
      matrix = matrix/max(maxval(abs(matrix)), tiny(1.0_wp))

   contains

      !> w for the rates that the constraints determine.
      subroutine respond(constraints, w)
         type(constraints_type), intent(in) :: constraints
         real(wp), intent(out) :: w(:)
         type(response_type) :: response

         w = 0.0_wp
         call path%system%solve(path%model, constraints, path%state%fields, response, singular)
         if (singular) return
         w = slack(event, 0.0_wp, response%rate%pressure(node), response%rate%shear(node), &
                   path%model%static_friction(node)*response%rate%pressure(node), 0.0_wp)
      end subroutine respond
   end subroutine influence

   !> z >= 0 with w = constant + matrix z >= 0 and w z = 0. `solved`: false if the algorithm ends on a ray or takes too many
   !> pivots.
   pure subroutine lemke(matrix, constant, z, solved)
      real(wp), intent(in) :: matrix(:, :), constant(:)
      real(wp), allocatable, intent(out) :: z(:)
      logical, intent(out) :: solved
      real(wp), parameter :: small = 1.0e-11_wp
      real(wp) :: tableau(size(constant), 2*size(constant) + 2), ratio, least
      integer :: basic(size(constant)), m, i, row, column, leaving, pivots

      m = size(constant)
      allocate (z(m), source=0.0_wp)
      solved = all(constant >= -small)
      if (solved) return
      ! Columns: w, z, the artificial variable, the right side; small distinct perturbations of the right side avoid ties.
      tableau = 0.0_wp
      tableau(:, m + 1:2*m) = -matrix
      tableau(:, 2*m + 1) = -1.0_wp
      do i = 1, m
         tableau(i, i) = 1.0_wp
         tableau(i, 2*m + 2) = constant(i) + small*i
         basic(i) = i
      end do
      row = minloc(tableau(:, 2*m + 2), dim=1)
      column = 2*m + 1
      do pivots = 1, 50*m + 100
         leaving = basic(row)
         tableau(row, :) = tableau(row, :)/tableau(row, column)
         do i = 1, m
            if (i /= row) tableau(i, :) = tableau(i, :) - tableau(i, column)*tableau(row, :)
         end do
         basic(row) = column
         if (leaving == 2*m + 1) exit
         column = merge(leaving + m, leaving - m, leaving <= m)
         row = 0
         least = huge(1.0_wp)
         do i = 1, m
            if (tableau(i, column) <= small) cycle
            ratio = tableau(i, 2*m + 2)/tableau(i, column)
            if (ratio > least) cycle
            least = ratio
            row = i
         end do
         if (row == 0) return
      end do
      solved = leaving == 2*m + 1
      if (.not. solved) return
      do i = 1, m
         if (basic(i) > m .and. basic(i) <= 2*m .and. tableau(i, 2*m + 2) > 100*m*small) z(basic(i) - m) = tableau(i, 2*m + 2)
      end do
   end subroutine lemke

end module mfv_rate_problem
