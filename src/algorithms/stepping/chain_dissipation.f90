!> Friction dissipation of a chain of large increments.
!>
!> Along the exact solution the dissipation is -int tau ds, summed over the surface. The contribution of a node has corners where
!> it begins to slip, to stick or to touch. The sum is smooth: by energy it is the work of the loads less the stored energy. On an
!> interpolated path these are -int (tau ds + p dg), with the gap g; p dg is zero on the exact path only. (The elastic part
!> tau C dtau is integrated exactly by any interpolation, since C is symmetric.) The sum is integrated with parabolas through three
!> states each (Simpson's rule), extrapolated once (Boole's rule, Richardson 1911).
!>
!> For a single node tau is mu p wherever it slips, so that its dissipation lies between its slip times the smaller and the larger
!> limit at both ends of an increment. Under constant pressures this is exact.
!>
!> The errors of the two sums are of different origin, and their difference is about as large as either. If contact begins, a third
!> sum is better than both: the rates -tau ds/df at the ends of increments, by Simpson's rule. While a contact grows in proportion
!> to its shape, its dissipation goes as f^4, and the rule is exact.
!>
!> Otherwise, with rates at both ends of the interval, the smooth sum is integrated with Hermite's polynomials of the fifth degree
!> through the values and slopes at three states each. In Mindlin's problem the shift goes as (1 - q) ln(1 - q), q = Q/(mu P), and
!> four intervals up to q = 0.8 give the dissipation to 2e-4, where Simpson's rule is off by 4e-3.
module mfv_chain_dissipation
   use mfv_contact_fields, only: contact_fields_type
   use mfv_contact_model, only: contact_model_type
   use mfv_contact_state, only: contact_state_type
   use mfv_kinds, only: wp
   use mfv_lapack, only: dgesv
   use mfv_motions, only: motion_count
   use mfv_node_status
   use mfv_tolerances, only: significant
   implicit none
   private
   public :: sample_type, chain_dissipation, dissipation_by_rates, dissipation_by_slopes, node_wise_dissipation, &
             straight_dissipation

   !> A state on the path: statuses, fields, and their rates per unit of the interval.
   type :: sample_type
      integer, allocatable :: status(:)
      type(contact_fields_type) :: fields, rates
   end type sample_type

   !> Values and slopes at three states.
   integer, parameter :: values_of_three = 6

contains

   !> The friction dissipation from the fields `start` through the fields `after`, evenly spaced on a smooth path, shape
   !> (increments), a power of two; force. `corners`: the error due to corners, one for each of the `changes` of status. (A corner
   !> is taken for part of a parabola: an error of random sign, on average 0.4 of that of the trapezoidal rule if all corners share
   !> the curvature.)
   subroutine chain_dissipation(model, start, after, changes, work, corners)
      class(contact_model_type), intent(in) :: model
      type(contact_fields_type), intent(in) :: start, after(:)
      integer, intent(in) :: changes
      real(wp), intent(out) :: work, corners
      real(wp), parameter :: share = 0.8_wp
      integer :: increments

      increments = size(after)
      work = composite(1)
      corners = share*abs(trapezoidal() - work)/sqrt(real(max(changes, 1), wp))
      if (increments >= 4) work = work + (work - composite(2))/15.0_wp

   contains

      !> Parabolas through every `stride`-th state; a straight line for a single interval.
      real(wp) function composite(stride)
         integer, intent(in) :: stride
         integer :: i

         if (increments == stride) then
            composite = straight_dissipation(model, start, after(increments))
            return
         end if
         composite = curved_dissipation(model, start, after(stride), after(2*stride))
         do i = 2*stride, increments - 2*stride, 2*stride
            composite = composite + curved_dissipation(model, after(i), after(i + stride), after(i + 2*stride))
         end do
      end function composite

      !> Straight lines through all states.
      real(wp) function trapezoidal()
         integer :: i

         trapezoidal = straight_dissipation(model, start, after(1))
         do i = 2, increments
            trapezoidal = trapezoidal + straight_dissipation(model, after(i - 1), after(i))
         end do
      end function trapezoidal
   end subroutine chain_dissipation

   !> -int (tau ds + p dg) along parabolas through three evenly spaced states.
   pure real(wp) function curved_dissipation(model, a, b, c) result(work)
      class(contact_model_type), intent(in) :: model
      type(contact_fields_type), intent(in) :: a, b, c

      work = -model%force(along(a%shear, b%shear, c%shear, a%slip(), b%slip(), c%slip()) + &
                          along(a%pressure, b%pressure, c%pressure, model%gap(a), model%gap(b), model%gap(c)))
   end function curved_dissipation

   !> int f dg along parabolas through three evenly spaced values of f and g.
   elemental real(wp) function along(f1, f2, f3, g1, g2, g3)
      real(wp), intent(in) :: f1, f2, f3, g1, g2, g3
      real(wp) :: slope, turn

      slope = 0.5_wp*(g3 - g1)
      turn = 0.5_wp*((g3 - g2) - (g2 - g1))
      along = 2.0_wp*(f2*slope + ((f3 - f1)*turn + 0.5_wp*((f3 - f2) - (f2 - f1))*slope)/3.0_wp)
   end function along

   !> -int (tau ds + p dg) along a straight line from the fields `a` to the fields `b`; force.
   pure real(wp) function straight_dissipation(model, a, b) result(work)
      class(contact_model_type), intent(in) :: model
      type(contact_fields_type), intent(in) :: a, b

      work = -0.5_wp*model%force((a%shear + b%shear)*(b%slip() - a%slip()) + &
                                 (a%pressure + b%pressure)*(model%gap(b) - model%gap(a)))
   end function straight_dissipation

   !> The friction dissipation from evenly spaced states with their rates, an even number without the first; force. `error`: that
   !> due to edges of zones which move node by node, force: rates jump with each of the `changes` of status (as found on random
   !> scenes).
   !> `motion_work`: the work of the forces of all motions, force.
   subroutine dissipation_by_slopes(model, samples, changes, work, error, motion_work)
      class(contact_model_type), intent(in) :: model
      type(sample_type), intent(in) :: samples(0:)
      integer, intent(in) :: changes
      real(wp), intent(out) :: work, error, motion_work(motion_count)
      real(wp), parameter :: noise = 4.0_wp
      real(wp) :: weight(values_of_three, values_of_three), straight
      integer :: i, n

      n = ubound(samples, 1)
      call integrate_polynomials(weight)
      work = 0.0_wp
      motion_work = 0.0_wp
      do i = 0, n - 2, 2
         call add_pair(model, samples(i:i + 2), 1.0_wp/n, weight, work, motion_work)
      end do
      straight = 0.0_wp
      do i = 1, n
         straight = straight + straight_dissipation(model, samples(i - 1)%fields, samples(i)%fields)
      end do
      error = noise*abs(work - straight)/max(changes, 1)
   end subroutine dissipation_by_slopes

   !> Add -int (tau ds + p dg) and int F dy through three states, `step` apart. `weight`: from integrate_polynomials.
   subroutine add_pair(model, samples, step, weight, work, motion_work)
      class(contact_model_type), intent(in) :: model
      type(sample_type), intent(in) :: samples(3)
      real(wp), intent(in) :: step, weight(values_of_three, values_of_three)
      real(wp), intent(inout) :: work, motion_work(motion_count)
      real(wp), dimension(size(model%width), values_of_three) :: shear, slip, pressure, gap
      real(wp), dimension(motion_count, values_of_three) :: force, motion
      integer :: i

      do i = 1, 3
         associate (fields => samples(i)%fields, rates => samples(i)%rates)
            shear(:, i) = fields%shear
            shear(:, 3 + i) = step*rates%shear
            slip(:, i) = fields%slip()
            slip(:, 3 + i) = step*rates%slip()
            pressure(:, i) = fields%pressure
            pressure(:, 3 + i) = step*rates%pressure
            gap(:, i) = model%gap(fields)
            gap(:, 3 + i) = step*(model%gap(fields%plus(1.0_wp, rates)) - gap(:, i))
            force(:, i) = fields%force
            force(:, 3 + i) = step*rates%force
            motion(:, i) = fields%motion
            motion(:, 3 + i) = step*rates%motion
         end associate
      end do
      work = work - model%force(sum(shear*matmul(slip, transpose(weight)) + pressure*matmul(gap, transpose(weight)), dim=2))
      motion_work = motion_work + sum(force*matmul(motion, transpose(weight)), dim=2)
   end subroutine add_pair

   !> int f dg from -1 to 1 for the polynomials f (rows) and g (columns) of the fifth degree that have the value 1 (first three) or
   !> the slope 1 at -1, 0 or 1, and otherwise values and slopes 0 there.
   subroutine integrate_polynomials(weight)
      real(wp), intent(out) :: weight(values_of_three, values_of_three)
      real(wp), parameter :: places(3) = [-1.0_wp, 0.0_wp, 1.0_wp]
      real(wp), dimension(values_of_three, values_of_three) :: conditions, coefficients, powers
      integer :: i, j, info, pivots(values_of_three)

      coefficients = 0.0_wp
      powers = 0.0_wp
      conditions = 0.0_wp
      do j = 0, values_of_three - 1
         conditions(:3, j + 1) = places**j
         if (j > 0) conditions(4:, j + 1) = j*places**(j - 1)
         coefficients(j + 1, j + 1) = 1.0_wp
         do i = 0, values_of_three - 1
            if (modulo(i + j, 2) == 1) powers(i + 1, j + 1) = 2.0_wp*j/(i + j)
         end do
      end do
      call dgesv(values_of_three, values_of_three, conditions, values_of_three, pivots, coefficients, values_of_three, info)
      weight = matmul(transpose(coefficients), matmul(powers, coefficients))
   end subroutine integrate_polynomials

   !> The friction dissipation of a contact that begins, force, by its rates at the ends of increments that are even in the
   !> half-width, per unit of load over the interval, shape (increments), a power of two. `error`: its estimated error, force: the
   !> change from half the number of increments, or that due to edges of zones which move node by node, by the number of `slipping`
   !> nodes (up to 4 % with 50 of them, 0.5 % with 120, 0.14 % with 450).
   pure subroutine dissipation_by_rates(rates, slipping, work, error)
      real(wp), intent(in) :: rates(:)
      integer, intent(in) :: slipping
      real(wp), intent(out) :: work, error
      real(wp), parameter :: few = 8.0_wp
      real(wp) :: by_nodes

      work = simpson(rates)
      by_nodes = max((few/max(slipping, 1))**2, 1.0_wp/max(slipping, 1))
      error = max(abs(work - simpson(rates(2::2))), by_nodes*abs(work))

   contains

      !> Loads go as the square of the half-width f. A single interval is a fourth power of f.
      pure real(wp) function simpson(rates) result(work)
         real(wp), intent(in) :: rates(:)
         real(wp) :: by_width(size(rates))
         integer :: i, n

         n = size(rates)
         by_width = [(2.0_wp*i/n*rates(i), i=1, n)]
         work = by_width(n)/4.0_wp
         if (n > 1) work = (4.0_wp*sum(by_width(1::2)) + 2.0_wp*sum(by_width(2:n - 2:2)) + by_width(n))/(3.0_wp*n)
      end function simpson
   end subroutine dissipation_by_rates

   !> The friction dissipation of each node from the state `before`, with the statuses of the increment, to the fields `after`;
   !> force/length, shape (nodes). `error`: estimated error of its sum, force. Nodes that slip from the start follow the
   !> trapezoidal rule; others begin to slip, and separating nodes open, half way on average. `tolerance`: that of the linear
   !> solver.
   pure subroutine node_wise_dissipation(model, before, after, tolerance, work, error)
      class(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: before
      type(contact_fields_type), intent(in) :: after
      real(wp), intent(in) :: tolerance
      real(wp), intent(out) :: work(:), error
      real(wp), parameter :: tolerance_factor = 100.0_wp
      real(wp), dimension(size(work)) :: slipped, limit, limit_after
      logical :: on(size(work))

      slipped = after%slip() - before%stuck_slip
      limit = model%static_friction*before%fields%pressure
      limit_after = model%static_friction*max(after%pressure, 0.0_wp)
      on = slips(before%status) .and. -before%fields%shear*slip_sign(before%status) &
           >= limit*(1.0_wp - max(significant, tolerance_factor*tolerance))
      where (on)
         work = -0.5_wp*(before%fields%shear + after%shear)*slipped
      elsewhere(slips(before%status))
         work = (0.75_wp*abs(after%shear) + 0.25_wp*limit)*abs(slipped)
      elsewhere(.not. in_contact(before%status))
         work = max(-0.25_wp*before%fields%shear*slipped, 0.0_wp)
      elsewhere
         work = 0.0_wp
      end where
      error = model%force(merge(0.5_wp*abs(limit - limit_after)*abs(slipped), 0.0_wp, before%status /= node_stick))
   end subroutine node_wise_dissipation

end module mfv_chain_dissipation
