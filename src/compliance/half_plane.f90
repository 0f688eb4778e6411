!> Compliance of an elastic half-plane under box tractions (dissertation appendix A, signs and factors as derived in
!> docs/theory.md; Johnson 1985, section 2.5; Barber 2009, chapter 12).
!>
!> With h half the width of an interval, x the distance from its centre, the constants A, At, M and B of mfv_near_field, of which no
!> more is assumed, and L = (h/pi) [2 ln(D/h) + 2 - log_kernel(x/h)], a unit pressure gives
!>
!>     w = A L,    u = M L - B h step_kernel(x/h)
!>
!> and a unit shear u = At L and w = M L + B h step_kernel(x/h). A half-plane has no rigid-body constraint: displacements are
!> measured from the surface points at the distance D (`datum`), where L of a concentrated force vanishes.
!>
!> On a surface that repeats after the length l the logarithm is ln|sin(pi x/l) l/(pi D)| and the step sgn x - 2 x/l, which have no
!> mean strain: what they add is smooth, integrated by quadrature.
!>
!> Equation A.10 in print has -A/(2 pi) with A = 2(1-nu^2)/E in front of *squared* logarithms, too large by a factor of two;
!> the signs of the coupling terms in A.1/A.2 and A.11/A.13 contradict each other. The signs here satisfy reciprocity,
!> C_wt(i,j) = C_up(j,i), and surface points move towards a pressure.
module mfv_half_plane
   use mfv_compliance
   use mfv_kernel_compliance, only: kernel_compliance_type
   use mfv_kinds, only: pi, wp
   use mfv_near_field, only: near_field_type
   use mfv_quadrature, only: gauss_points
   use mfv_toeplitz, only: toeplitz_type, new_toeplitz
   implicit none
   private
   public :: half_plane_type, new_half_plane, log_kernel, step_kernel

   integer, parameter :: points = 12

   !> Toeplitz blocks: one entry per distance.
   type, extends(kernel_compliance_type) :: half_plane_type
      private
      real(wp) :: datum = 1.0_wp
      !> C_wp by distance; C_wt and C_up are it times M/A, plus and minus the `cross` entries by distance (odd).
      real(wp), allocatable :: direct(:)
      real(wp) :: mixed_ratio = 0.0_wp, cross = 0.0_wp
      !> Quadrature over an interval of what a surface that repeats adds.
      real(wp) :: point(points) = 0.0_wp, weight(points) = 0.0_wp
      !> Products with the first.
      type(toeplitz_type) :: operator
   contains
      procedure :: resize
      procedure :: kernels_at
      procedure :: entries
      procedure :: products
      procedure :: normal_by_shear
      procedure :: tangential_displacements
      procedure :: signature
   end type half_plane_type

   !> The kernels: w by pressure, and w by shear.
   integer, parameter :: direct_kernel = 1, cross_kernel = 2

contains

   !> Half-plane with `nodes` intervals of width `interval` (length). `datum`: distance at which displacements are measured,
   !> length. `coupling`: see mfv_compliance. `tangential`: friction can act; otherwise only C_wp is built. `ends`: of unequal
   !> intervals, of which `interval` is the mean, length, shape (nodes + 1); such a body has entries only. `period`: see
   !> mfv_kernel_compliance, by default 0.
   type(half_plane_type) function new_half_plane(constants, nodes, interval, datum, coupling, tangential, ends, period) result(self)
      type(near_field_type), intent(in) :: constants
      integer, intent(in) :: nodes, coupling
      real(wp), intent(in) :: interval, datum
      logical, intent(in) :: tangential
      real(wp), intent(in), optional :: ends(:), period

      if (present(period)) self%period = period
      if (self%period > 0.0_wp) call gauss_points(-1.0_wp, 1.0_wp, self%point, self%weight)
      self%interval = interval
      self%datum = datum
      self%modulus = constants%modulus()
      self%shear_ratio = constants%shear_ratio()
      self%mixed_ratio = constants%mixed/constants%normal
      call self%choose_blocks(coupling, tangential)
      self%cross = 0.5_wp*constants%coupling*interval
      self%nodes = nodes
      self%is_homogeneous = .not. present(ends)
      self%by_distance = self%is_homogeneous .and. .not. self%period > 0.0_wp
      if (present(ends)) then
         call self%grade(ends, odd=[.false., .true.])
      else
         call self%resize(nodes)
      end if
   end function new_half_plane

   !> See mfv_compliance.
   subroutine resize(self, nodes)
      class(half_plane_type), intent(inout) :: self
      integer, intent(in) :: nodes
      integer :: distance

      self%nodes = nodes
      self%direct = [(normal_displacement(self, 2.0_wp*distance, self%interval), distance=0, nodes - 1)]
      self%operator = new_toeplitz(self%direct, repeats=abs(nodes*self%interval - self%period) < 0.5_wp*self%interval)
      self%block_values = nodes
   end subroutine resize

   !> w by a unit pressure on an interval of the width `width`, at `r` times half the width from its middle, length^3/force.
   elemental real(wp) function normal_displacement(self, r, width)
      class(half_plane_type), intent(in) :: self
      real(wp), intent(in) :: r, width
      real(wp) :: half

      half = width/2.0_wp
      if (.not. self%period > 0.0_wp) then
         normal_displacement = half/(pi*self%modulus)*(2.0_wp*log(self%datum/half) + 2.0_wp - log_kernel(r))
      else
         associate (distance => abs(r*half) - self%period*anint(abs(r*half)/self%period))
            normal_displacement = half/(pi*self%modulus)*(2.0_wp*log(self%datum/half) + 2.0_wp - log_kernel(distance/half) &
                                                          - of_images(self, distance/self%period, half/self%period))
         end associate
      end if
   end function normal_displacement

   !> Integral of ln(sin(pi x)/(pi x)) over the interval of half the width `half` around `distance` (over the period), over `half`.
   pure real(wp) function of_images(self, distance, half) result(total)
      class(half_plane_type), intent(in) :: self
      real(wp), intent(in) :: distance, half
      real(wp) :: x
      integer :: i

      total = 0.0_wp
      do i = 1, points
         x = pi*(distance + half*self%point(i))
         if (abs(x) > 0.0_wp) total = total + self%weight(i)*log(sin(x)/x)
      end do
   end function of_images

   !> The step sgn x, or that of a surface that repeats, averaged over the interval of the width `width` at a signed `distance`.
   elemental real(wp) function step(self, distance, width)
      class(half_plane_type), intent(in) :: self
      real(wp), intent(in) :: distance, width

      step = step_kernel(2.0_wp*distance/width)
      if (self%period > 0.0_wp) step = step - 2.0_wp*distance/self%period
   end function step

   !> See mfv_kernel_compliance.
   pure subroutine kernels_at(self, distance, width, kernels)
      class(half_plane_type), intent(in) :: self
      real(wp), intent(in) :: distance, width
      real(wp), intent(out) :: kernels(:)

      kernels(direct_kernel) = normal_displacement(self, 2.0_wp*distance/width, width)
      kernels(cross_kernel) = self%cross*(width/self%interval)*step(self, distance, width)
   end subroutine kernels_at

   !> See mfv_compliance.
   pure function signature(self)
      class(half_plane_type), intent(in) :: self
      real(wp) :: signature(4)

      signature = 0.0_wp
      if (abs(self%cross) > 0.0_wp) signature(:2) = [1.0_wp, self%cross]
      if (abs(self%mixed_ratio) > 0.0_wp) signature(3:) = [self%mixed_ratio/self%modulus, self%datum]
   end function signature

   !> See mfv_compliance.
   pure subroutine entries(self, block, rows, columns, matrix)
      class(half_plane_type), intent(in) :: self
      integer, intent(in) :: block, rows(:), columns(:)
      real(wp), intent(out) :: matrix(:, :)
      !> Part of the first and of the second kernel in each block.
      real(wp) :: direct(4), odd(4)
      integer :: j

      direct([block_wp, block_wt, block_up, block_ut]) = [1.0_wp, self%mixed_ratio, self%mixed_ratio, self%shear_ratio]
      odd([block_wp, block_wt, block_up, block_ut]) = [0.0_wp, 1.0_wp, -1.0_wp, 0.0_wp]
      matrix = 0.0_wp
      do j = 1, size(columns)
         if (allocated(self%mean)) then
            if (abs(direct(block)) > 0.0_wp) matrix(:, j) = direct(block)*self%mean(rows, columns(j), direct_kernel)
            if (abs(odd(block)) > 0.0_wp) matrix(:, j) = matrix(:, j) + odd(block)*self%mean(rows, columns(j), cross_kernel)
         else
            if (abs(direct(block)) > 0.0_wp) matrix(:, j) = direct(block)*self%direct(abs(rows - columns(j)) + 1)
            if (abs(odd(block)) > 0.0_wp) &
               matrix(:, j) = matrix(:, j) + odd(block)*self%cross*step(self, self%interval*(rows - columns(j)), self%interval)
         end if
      end do
   end subroutine entries

   !> See mfv_compliance; the cross blocks, constant on either side of the diagonal, are evaluated by running sums.
   subroutine products(self, pressure, shear, by_block)
      class(half_plane_type), intent(in) :: self
      real(wp), intent(in) :: pressure(:), shear(:)
      real(wp), intent(out) :: by_block(:, :)

      by_block(:, [block_wt, block_up]) = 0.0_wp
      call self%operator%multiply(pressure, by_block(:, block_wp), shear, by_block(:, block_ut))
      if (self%has_block(block_wt)) call multiply_steps(self, self%cross, shear, by_block(:, block_wt))
      if (self%has_block(block_up)) call multiply_steps(self, -self%cross, pressure, by_block(:, block_up))
      if (abs(self%mixed_ratio) > 0.0_wp) then
         if (self%has_block(block_wt)) by_block(:, block_wt) = by_block(:, block_wt) + self%mixed_ratio*by_block(:, block_ut)
         if (self%has_block(block_up)) by_block(:, block_up) = by_block(:, block_up) + self%mixed_ratio*by_block(:, block_wp)
      end if
      by_block(:, block_ut) = merge(self%shear_ratio, 0.0_wp, self%has_block(block_ut))*by_block(:, block_ut)
   end subroutine products

   !> See mfv_compliance.
   subroutine normal_by_shear(self, shear, normal)
      class(half_plane_type), intent(in) :: self
      real(wp), intent(in) :: shear(:)
      real(wp), intent(out) :: normal(:)
      real(wp) :: direct(size(shear)), none(size(shear))

      normal = 0.0_wp
      if (.not. self%has_block(block_wt)) return
      call multiply_steps(self, self%cross, shear, normal)
      if (.not. abs(self%mixed_ratio) > 0.0_wp) return
      call self%operator%multiply(shear, direct, 0.0_wp*shear, none)
      normal = normal + self%mixed_ratio*direct
   end subroutine normal_by_shear

   !> See mfv_compliance.
   subroutine tangential_displacements(self, pressure, shear, tangential)
      class(half_plane_type), intent(in) :: self
      real(wp), intent(in) :: pressure(:), shear(:)
      real(wp), intent(out) :: tangential(:)
      real(wp) :: direct(size(shear)), none(size(shear))

      tangential = 0.0_wp
      if (self%has_block(block_up)) call multiply_steps(self, -self%cross, pressure, tangential)
      call self%operator%multiply(self%mixed_ratio*pressure, none, self%shear_ratio*shear, direct)
      if (self%has_block(block_ut)) tangential = tangential + direct
      if (self%has_block(block_up)) tangential = tangential + none
   end subroutine tangential_displacements

   !> displacement(i) = cross (sum of tractions left of i - sum right of i), less cross 2/period (sum of tractions times their
   !> signed distances from i) on a surface that repeats.
   pure subroutine multiply_steps(self, cross, traction, displacement)
      class(half_plane_type), intent(in) :: self
      real(wp), intent(in) :: cross, traction(:)
      real(wp), intent(out) :: displacement(:)
      real(wp) :: left, right, moment, factor, on_right(size(traction))
      integer :: i, n

      n = size(traction)
      left = 0.0_wp
      right = 0.0_wp
      moment = 0.0_wp
      ! The three sums side by side: each waits for its own last addition only.
      do i = 1, n
         displacement(i) = cross*left
         left = left + traction(i)
         on_right(n + 1 - i) = right
         right = right + traction(n + 1 - i)
         moment = moment + i*traction(i)
      end do
      displacement = displacement - cross*on_right
      if (.not. self%period > 0.0_wp) return
      factor = 2.0_wp*cross*self%interval/self%period
      do i = 1, n
         displacement(i) = displacement(i) - factor*(i*right - moment)
      end do
   end subroutine multiply_steps

   !> (r+1) ln|r+1| - (r-1) ln|r-1|, the normal displacement by a box traction, to a relative error near epsilon for every r
   !> >= 0 (r = |x|/h): by series for small and large r, where the terms cancel.
   elemental real(wp) function log_kernel(r) result(kernel)
      real(wp), intent(in) :: r
      real(wp), parameter :: near = 0.5_wp, far = 2.0_wp
      real(wp) :: distance

      distance = abs(r)
      if (distance < near) then
         kernel = series(distance**2, -1.0_wp)
      else if (distance < far) then
         kernel = x_log_x(distance + 1.0_wp) - x_log_x(distance - 1.0_wp)
      else
         kernel = 2.0_wp*log(distance) + 2.0_wp - series(distance**(-2), 1.0_wp)
      end if
   end function log_kernel

   !> x ln|x|, with its limit 0 at x = 0.
   pure real(wp) function x_log_x(x)
      real(wp), intent(in) :: x

      x_log_x = 0.0_wp
      if (abs(x) > 0.0_wp) x_log_x = x*log(abs(x))
   end function x_log_x

   !> sum over k >= 1 of square^k/(k (2k + sign)), from the smallest term up; square <= 1/4. With sign -1 and r^2 it equals
   !> (1+r) ln(1+r) + (1-r) ln(1-r), with sign 1 and 1/r^2 the difference of log_kernel to 2 ln(r) + 2.
   pure real(wp) function series(square, sign) result(total)
      real(wp), intent(in) :: square, sign
      integer :: k, terms

      ! Enough for round-off; most pairs of nodes are far apart.
      terms = 26
      if (square < 1.0e-2_wp) terms = 8
      if (square < 1.0e-4_wp) terms = 4
      total = 0.0_wp
      do k = terms, 1, -1
         total = (total + 1.0_wp/(k*(2.0_wp*k + sign)))*square
      end do
   end function series

   !> x/h inside the loaded interval, -1 or 1 outside: the tangential displacement by a box pressure.
   elemental real(wp) function step_kernel(r) result(kernel)
      real(wp), intent(in) :: r

      kernel = min(max(r, -1.0_wp), 1.0_wp)
   end function step_kernel

end module mfv_half_plane
