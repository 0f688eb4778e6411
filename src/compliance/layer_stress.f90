!> Stresses in layers and their base under line loads on the surface: what mfv_interior_half_plane does not know of, smooth
!> functions of x and the depth. In the first layer that is the difference to an endless one, below it everything.
!>
!> A kernel K is (1/pi) Re integral over k > 0 of S(k) exp(i k x) dk, S from mfv_layers, to the right of the load; to its left with
!> the conjugate of S at the conjugate of k. (Without oblique layers K is even or odd in x.) They are kept as Chebyshev series in
!> the distance over intervals in proportion to it, and in the depth over blocks that double downwards; blocks are made when they
!> are asked for (`prepare`). At other depths the integrals are evaluated anew. Of a surface that repeats K is a sum over its modes
!> and a mean, without extension along x.
module mfv_layer_stress
   use mfv_chebyshev, only: chebyshev_coefficients, chebyshev_points, lagrange_weights, piecewise_type
   use mfv_kinds, only: pi, wp
   use mfv_layers, only: layer_at_depth, layers_type, loads
   use mfv_smooth_kernel, only: thinnest
   use mfv_wave_integral, only: last_exponent, new_wave_integral
   implicit none
   private
   public :: layer_stress_type, new_layer_stress, stress_row_type

   !> Stresses (sigma_xx, sigma_yy, sigma_xy) by pressure and by shear; their signs in the mirror image.
   integer, parameter :: functions = 3*loads
   real(wp), parameter :: mirrored(functions) = [1.0_wp, 1.0_wp, -1.0_wp, -1.0_wp, -1.0_wp, 1.0_wp]
   !> Terms of the series in x and in the depth; intervals of x until it doubles.
   integer, parameter :: terms = 24, terms_down = 20, intervals_per_doubling = 2

   !> The functions at one depth. The series are those to the right and, if they differ, to the left, shape (terms, functions or
   !> twice as many, intervals).
   type, extends(piecewise_type) :: stress_row_type
      !> The length over which the functions are smooth, and the period, 0 without.
      real(wp) :: scale = 1.0_wp, period = 0.0_wp
   contains
      procedure :: at
   end type stress_row_type

   !> The functions at all depths between two.
   type :: depths_type
      integer :: layer = 1
      real(wp) :: from = 0.0_wp, to = 0.0_wp
      type(stress_row_type) :: row(terms_down)
   end type depths_type

   type :: layer_stress_type
      type(layers_type) :: layers
      real(wp) :: period = 0.0_wp, reach = 0.0_wp
      !> At the surface, at the upper sides of the interfaces (from 0), and at all depths.
      type(stress_row_type), allocatable :: interface(:)
      type(depths_type), allocatable :: block(:)
   contains
      procedure :: prepare
      procedure :: row
      procedure :: scale_at
   end type layer_stress_type

contains

   !> Stresses of layers for distances up to `reach`, length. `period`: of a surface that repeats, length; else 0.
   type(layer_stress_type) function new_layer_stress(layers, period, reach) result(self)
      type(layers_type), intent(in) :: layers
      real(wp), intent(in) :: period, reach
      integer :: i

      self%layers = layers
      self%period = period
      self%reach = reach
      allocate (self%block(0), self%interface(0:size(layers%layer)))
      do i = 0, size(layers%layer)
         associate (depth => layers%depth_of(i), number => max(i, 1))
            call make_rows(self, number, [depth], self%scale_at(depth, number), reach, self%interface(i:i))
         end associate
      end do
   end function new_layer_stress

   !> Length over which the functions are smooth at a depth in a layer, length: the distance of the load or, in the first layer, of
   !> its nearest image.
   pure real(wp) function scale_at(self, depth, number) result(scale)
      class(layer_stress_type), intent(in) :: self
      real(wp), intent(in) :: depth
      integer, intent(in) :: number

      associate (layers => self%layers)
         if (number == 1) then
            scale = layers%nearest_image() - layers%layer(1)%decay*depth
            return
         end if
         scale = sum(layers%layer(:number - 1)%decay*layers%layer(:number - 1)%thickness)
         scale = scale + (depth - layers%depth_of(number - 1))*layers%decay_of(number)
      end associate
   end function scale_at

   !> Make blocks for all depths down to `deepest`, length.
   subroutine prepare(self, deepest)
      class(layer_stress_type), intent(inout) :: self
      real(wp), intent(in) :: deepest
      integer, parameter :: most_halvings = 6
      real(wp) :: from, to, length
      integer :: number, n

      from = 0.0_wp
      n = size(self%block)
      if (n > 0) from = self%block(n)%to
      do while (from < deepest)
         number = layer_at_depth(self%layers%layer%thickness, from*(1.0_wp + 16.0_wp*epsilon(1.0_wp)) + tiny(1.0_wp))
         to = huge(1.0_wp)
         if (number <= size(self%layers%layer)) then
            to = self%layers%depth_of(number)
         else if (self%layers%rigid_base) then
            exit
         end if
         if (number > 1) then
            length = self%scale_at(from, number)/self%layers%decay_of(number)
            if (from + 1.1_wp*length < to) to = from + length
         end if
         call add_block(self, number, from, to, most_halvings)
         from = to
      end do
   end subroutine prepare

   !> Append the block between two depths of a layer, halved until the series converge.
   recursive subroutine add_block(self, number, from, to, halvings)
      class(layer_stress_type), intent(inout) :: self
      integer, intent(in) :: number, halvings
      real(wp), intent(in) :: from, to
      type(depths_type), allocatable :: longer(:)
      type(depths_type) :: block
      integer :: n

      block%layer = number
      block%from = from
      block%to = to
      call make_rows(self, number, chebyshev_points(terms_down, to, from), &
                     min(self%scale_at(from, number), self%scale_at(to, number)), self%reach, block%row)
      if (halvings > 0 .and. .not. has_converged(block)) then
         call add_block(self, number, from, 0.5_wp*(from + to), halvings - 1)
         call add_block(self, number, 0.5_wp*(from + to), to, halvings - 1)
         return
      end if
      n = size(self%block)
      allocate (longer(n + 1))
      longer(:n) = self%block
      longer(n + 1) = block
      call move_alloc(longer, self%block)
   end subroutine add_block

   !> Whether the last terms of the series in the depth are small.
   pure logical function has_converged(block)
      type(depths_type), intent(in) :: block
      real(wp), parameter :: tolerance = 5.0e-12_wp
      real(wp) :: weight(terms_down), largest
      real(wp), allocatable :: term(:, :, :)
      integer :: i, j

      has_converged = .true.
      largest = 0.0_wp
      do j = 1, terms_down
         largest = max(largest, maxval(abs(block%row(j)%series)))
      end do
      do i = terms_down - 1, terms_down
         weight = [(cos(pi*(i - 1)*(j - 0.5_wp)/terms_down)*2.0_wp/terms_down, j=1, terms_down)]
         term = weight(1)*block%row(1)%series
         do j = 2, terms_down
            term = term + weight(j)*block%row(j)%series
         end do
         has_converged = has_converged .and. maxval(abs(term)) <= tolerance*largest
      end do
   end function has_converged

   !> The functions at a depth in a layer, for distances up to `reach`, lengths.
   pure function row(self, depth, number, reach)
      class(layer_stress_type), intent(in) :: self
      real(wp), intent(in) :: depth, reach
      integer, intent(in) :: number
      type(stress_row_type) :: row, rows(1)
      real(wp) :: weight(terms_down), t
      integer :: i, j

      if (.not. depth > 0.0_wp .and. reach <= self%reach) then
         row = self%interface(0)
         return
      end if
      do i = 1, size(self%block)
         associate (block => self%block(i))
            if (reach > self%reach .or. block%layer /= number .or. depth > block%to*(1.0_wp + 8.0_wp*epsilon(1.0_wp)) &
                .or. depth < block%from*(1.0_wp - 8.0_wp*epsilon(1.0_wp))) cycle
            t = -(2.0_wp*depth - block%from - block%to)/(block%to - block%from)
            weight = lagrange_weights(terms_down, t)
            row = block%row(1)
            row%series = weight(1)*row%series
            do j = 2, terms_down
               row%series = row%series + weight(j)*block%row(j)%series
            end do
            return
         end associate
      end do
      call make_rows(self, number, [depth], self%scale_at(depth, number), max(reach, self%reach), rows)
      row = rows(1)
   end function row

   !> Rows at ascending depths in a layer for distances up to `reach`; `scale`: the length over which all of them are smooth.
   pure subroutine make_rows(self, number, depths, scale, reach, rows)
      class(layer_stress_type), intent(in) :: self
      integer, intent(in) :: number
      real(wp), intent(in) :: depths(:), reach
      real(wp), value :: scale
      type(stress_row_type), intent(out) :: rows(:)
      complex(wp), allocatable :: k(:), weight(:), sides(:, :, :), waves(:, :)
      real(wp), allocatable :: ends(:), x(:), values(:, :, :), mean(:), series(:, :)
      !> Waves at once.
      integer, parameter :: at_once = 1000
      integer :: i, j, m, count, n, first, last

      scale = max(scale, thinnest*max(reach, self%period))
      ends = ends_of(scale, self%layers%slant(), merge(0.5_wp*self%period, reach, self%period > 0.0_wp))
      if (self%period > 0.0_wp) then
         n = ceiling(last_exponent/scale*self%period/(2.0_wp*pi))
         k = [(cmplx(2.0_wp*pi*m/self%period, 0.0_wp, wp), m=1, n)]
         weight = spread(cmplx(2.0_wp*pi/self%period, 0.0_wp, wp), 1, n)
      else
         call new_wave_integral(scale, ends(size(ends)), self%layers%slant(), 1.0_wp, k, weight)
      end if
      count = functions*size(depths)
      allocate (sides(size(k), count, merge(2, 1, self%layers%is_oblique())))
      do j = 1, size(k)
         sides(j, :, 1) = weight(j)/pi*pack(waves_at(self, number, depths, k(j)), .true.)
         if (size(sides, 3) == 1) cycle
         sides(j, :, 2) = weight(j)/pi*conjg(pack(waves_at(self, number, depths, conjg(k(j))), .true.))
      end do
      n = size(ends) - 1
      x = [(chebyshev_points(terms, ends(i), ends(i + 1)), i=1, n)]
      mean = [(0.0_wp, i=1, count)]
      if (self%period > 0.0_wp .and. number > 1) &
         mean = [(pack(self%layers%uniform_stresses(number)/self%period, .true.), i=1, size(depths))]
      allocate (values(size(x), count, size(sides, 3)), source=0.0_wp)
      do first = 1, size(k), at_once
         last = min(first + at_once - 1, size(k))
         waves = waves_of(k(first:last), x)
         do i = 1, size(sides, 3)
            values(:, :, i) = values(:, :, i) + matmul(real(waves, wp), real(sides(first:last, :, i), wp)) &
                              - matmul(aimag(waves), aimag(sides(first:last, :, i)))
         end do
      end do
      do m = 1, size(depths)
         rows(m)%scale = scale
         rows(m)%period = self%period
         rows(m)%ends = ends
         allocate (rows(m)%series(terms, functions*size(sides, 3), n))
      end do
      do i = 1, n
         do j = 1, size(sides, 3)
            series = chebyshev_coefficients(values(terms*(i - 1) + 1:terms*i, :, j) + spread(mean, 1, terms))
            do m = 1, size(depths)
               rows(m)%series(:, functions*(j - 1) + 1:functions*j, i) = series(:, functions*(m - 1) + 1:functions*m)
            end do
         end do
      end do
   end subroutine make_rows

   !> exp(i k x), shape (x, k); 0 where it has decayed.
   pure function waves_of(k, x) result(waves)
      complex(wp), intent(in) :: k(:)
      real(wp), intent(in) :: x(:)
      complex(wp) :: waves(size(x), size(k))
      integer :: i, j

      waves = 0.0_wp
      do j = 1, size(k)
         do i = 1, size(x)
            if (aimag(k(j))*x(i) < last_exponent) waves(i, j) = exp(cmplx(-aimag(k(j))*x(i), real(k(j), wp)*x(i), wp))
         end do
      end do
   end function waves_of

   !> Ends of the intervals of x up to `farthest`, lengths; as short as near the load also where waves are shifted to.
   pure function ends_of(scale, slant, farthest) result(ends)
      real(wp), intent(in) :: scale, slant, farthest
      real(wp), allocatable :: ends(:)
      real(wp) :: from, step

      ends = [0.0_wp]
      from = 0.0_wp
      step = scale/intervals_per_doubling
      do while (from < farthest)
         from = from + step
         ends = [ends, from]
         step = max(step, (from - 2.0_wp*slant*scale)/intervals_per_doubling)
      end do
   end function ends_of

   !> S, by load and depth.
   pure function waves_at(self, number, depths, k) result(waves)
      class(layer_stress_type), intent(in) :: self
      integer, intent(in) :: number
      real(wp), intent(in) :: depths(:)
      complex(wp), intent(in) :: k
      complex(wp) :: waves(3, loads, size(depths))

      waves = self%layers%stresses(k, number, depths)
      if (number == 1) waves = waves - self%layers%endless_stresses(k, depths)
   end function waves_at

   !> Stresses (sigma_xx, sigma_yy, sigma_xy) by unit line loads into the surface and to the right on the body, shape (3, loads), at
   !> the signed distance x to the right of them, length; 1/length.
   pure function at(self, x) result(values)
      class(stress_row_type), intent(in) :: self
      real(wp), intent(in) :: x
      real(wp) :: values(3, loads), place
      integer :: first

      place = x
      if (self%period > 0.0_wp) place = x - self%period*anint(x/self%period)
      first = 1
      if (place < 0.0_wp) first = size(self%series, 2) - functions + 1
      associate (b => self%values_at(abs(place), first, functions))
         values = reshape(merge(mirrored, 1.0_wp, place < 0.0_wp .and. first == 1)*b, [3, loads])
      end associate
   end function at

end module mfv_layer_stress
