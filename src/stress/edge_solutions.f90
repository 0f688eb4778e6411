!> Discretisation error of nodal tractions next to a contact edge: the two solutions of the discrete equations there.
!>
!> Tractions are uniform on equal intervals of a half-plane, and displacements are those at the middles. At the edge tractions
!> vanish as the distance to the power m. Far from everything else the discrete equations have two solutions, g(j) and k(j), j
!> = 0 at the outermost node, with the asymptotes u^m and u^(m-1), u = j + offset. g + 2 m r k is the discrete traction for
!> d^m with an edge offset + 2 r intervals outwards from the outermost node. They follow from the Wiener-Hopf factors of the
!> symbol (docs/theory.md, edges between nodes).
!>
!> On unequal intervals, where displacements are means, the two solutions and that for d^(m+1) follow from the equations of the
!> outermost intervals: the difference from the means of the exact tractions decays inwards.
module mfv_edge_solutions
   use mfv_kinds, only: pi, wp
   use mfv_lapack, only: dgesv
   use mfv_quadrature, only: gauss_points
   implicit none
   private
   public :: find_solved_distance, discrete_over_exact, graded_solution_type, new_graded_solution, least_power, most_power

   !> Exponents for which the solutions are tabulated.
   real(wp), parameter :: least_power = 0.29_wp, most_power = 0.71_wp
   !> Exact tractions are the distance to the power m - 1, m and m + 1.
   integer, parameter :: terms = 3

   !> Discrete tractions of the outermost unequal intervals; `unit`: their total width, length.
   type :: graded_solution_type
      private
      real(wp) :: power = 0.5_wp, unit = 1.0_wp
      !> Ends as distances from that of the contact; shapes (0:intervals), (intervals, terms).
      real(wp), allocatable :: ends(:), discrete(:, :)
   contains
      procedure :: edge_beyond
      procedure :: over_exact
   end type graded_solution_type

contains

   !> `distance` of the edge, in intervals outwards from the outermost node, where tractions vanish with the exponent `power`.
   !> `values`: tractions at five or more nodes to the inverse exponent, outermost first; `inwards`: their distances from that
   !> node. With the edge g + 2 m r k, to the inverse exponent, fits the second to fourth value (third to fifth with exponents
   !> below 1/2, where k is irregular) by a parabola without a linear term; `otherwise`: the third to fifth (second to fourth). Of
   !> several such edges the one nearest to `distance` at first, which stays if none is `found`.
   pure subroutine find_solved_distance(inwards, values, power, otherwise, distance, found)
      real(wp), intent(in) :: inwards(0:), values(0:), power
      logical, intent(in) :: otherwise
      real(wp), intent(inout) :: distance
      logical, intent(out) :: found
      integer, parameter :: steps = 22, halvings = 40
      real(wp), parameter :: least = -0.6_wp, step = 0.1_wp
      real(wp) :: guess, left, right, middle, at_left, at_right, offset, g(4), k(4)
      integer :: first, i, j

      call find_edge_solutions(power, offset, g, k)
      first = merge(2, 1, power < 0.5_wp .neqv. otherwise)
      guess = distance
      found = .false.
      at_right = misfit(least)
      do i = 1, steps
         left = least + (i - 1)*step
         right = left + step
         at_left = at_right
         at_right = misfit(right)
         if (at_left*at_right > 0.0_wp .or. .not. abs(at_left) > 0.0_wp) cycle
         do j = 1, halvings
            middle = 0.5_wp*(left + right)
            if (at_left*misfit(middle) > 0.0_wp) then
               left = middle
            else
               right = middle
            end if
         end do
         if (.not. found .or. abs(middle - guess) < abs(distance - guess)) distance = middle
         found = .true.
      end do

   contains

      !> Determinant of the three values, those of the discrete solution with the edge at `edge`, and the squared distances.
      pure real(wp) function misfit(edge)
         real(wp), intent(in) :: edge
         real(wp) :: discrete(3), square(3)

         associate (value => values(first:first + 2), last => first + 2)
            discrete = max(g(first:last) + power*(edge - offset)*k(first:last), 0.0_wp)
            if (abs(power - 0.5_wp) > 0.0_wp) then
               discrete = discrete**(1.0_wp/power)
            else
               discrete = discrete**2
            end if
            square = (inwards(first:last) + edge)**2
            misfit = value(1)*(discrete(2)*square(3) - discrete(3)*square(2)) &
                     - value(2)*(discrete(1)*square(3) - discrete(3)*square(1)) &
                     + value(3)*(discrete(1)*square(2) - discrete(2)*square(1))
         end associate
      end function misfit
   end subroutine find_solved_distance

   !> Offset and the two solutions for j = 1 to 4 for an exponent, interpolated in the table to 1e-5, k to 6e-4. Verified by
   !> tests/python/test_edge_solutions.py.
   pure subroutine find_edge_solutions(power, offset, g, k)
      real(wp), intent(in) :: power
      real(wp), intent(out) :: offset, g(4), k(4)
      integer, parameter :: powers = 7
      integer :: i
      real(wp), parameter :: tabulated(powers) = [(least_power + (i - 1)*(most_power - least_power)/(powers - 1), i=1, powers)]
      real(wp), parameter :: solutions(9, powers) = reshape([ &
              0.860699_wp, 1.175358_wp, 1.370073_wp, 1.481191_wp, 1.584615_wp, 0.150503_wp, 0.671431_wp, 0.383166_wp, 0.356635_wp, &
              0.841320_wp, 1.246079_wp, 1.464396_wp, 1.626871_wp, 1.767032_wp, 0.544208_wp, 0.606435_wp, 0.451321_wp, 0.389337_wp, &
              0.829380_wp, 1.304766_wp, 1.570424_wp, 1.785116_wp, 1.970880_wp, 0.725241_wp, 0.617810_wp, 0.499283_wp, 0.432011_wp, &
              0.825347_wp, 1.361029_wp, 1.686648_wp, 1.959477_wp, 2.199223_wp, 0.813172_wp, 0.651237_wp, 0.545658_wp, 0.479493_wp, &
              0.829380_wp, 1.420521_wp, 1.814357_wp, 2.153109_wp, 2.456090_wp, 0.858901_wp, 0.690941_wp, 0.594302_wp, 0.531546_wp, &
              0.841320_wp, 1.486743_wp, 1.955829_wp, 2.369472_wp, 2.746252_wp, 0.885941_wp, 0.732947_wp, 0.646318_wp, 0.588719_wp, &
             0.860699_wp, 1.562005_wp, 2.113650_wp, 2.612415_wp, 3.075201_wp, 0.905789_wp, 0.776965_wp, 0.702486_wp, 0.651810_wp], &
                                                            [9, powers])
      real(wp) :: found(9)
      logical :: others(powers)

      found = 0.0_wp
      do i = 1, powers
         others = .true.
         others(i) = .false.
         found = found + solutions(:, i)*product((power - tabulated)/(tabulated(i) - tabulated), mask=others)
      end do
      offset = found(1)
      g = found(2:5)
      k = found(6:9)
   end subroutine find_edge_solutions

   !> Discrete traction over d^power at the nodes j = 1, 2, ..., for an edge `distance` intervals outwards from the outermost
   !> node; 1 without a discrete solution. Its difference from 1 decays as the inverse square of the distance.
   pure function discrete_over_exact(power, distance, nodes) result(ratio)
      real(wp), intent(in) :: power, distance
      integer, intent(in) :: nodes
      real(wp) :: ratio(nodes)
      real(wp) :: offset, g(4), k(4)
      integer :: j

      call find_edge_solutions(power, offset, g, k)
      do j = 1, nodes
         if (j <= 4) then
            ratio(j) = (g(j) + power*(distance - offset)*k(j))/(j + distance)**power
         else
            ratio(j) = 1.0_wp + (ratio(4) - 1.0_wp)*((4 + distance)/(j + distance))**2
         end if
      end do
      where (.not. ratio > 0.5_wp) ratio = 1.0_wp
   end function discrete_over_exact

   !> Solutions on unequal intervals of `widths`, outermost first, lengths; at least `terms`, of which the first few are used.
   !> The exact tractions d^m leave the displacements -ln(r) p + (pi/2) q sgn(x) p unchanged, q = tan(pi (1/2 - m)), and the
   !> discrete ones their means: the difference of both tractions has no resultant displacement (docs/theory.md).
   type(graded_solution_type) function new_graded_solution(widths, power) result(self)
      real(wp), intent(in) :: widths(:), power
      integer, parameter :: most_intervals = 32
      real(wp), allocatable :: matrix(:, :), differences(:, :)
      integer, allocatable :: pivots(:)
      integer :: i, n, code

      n = min(size(widths), most_intervals)
      self%power = power
      self%unit = sum(widths(:n))
      allocate (self%ends(0:n), self%discrete(n, terms), matrix(n, n), differences(n, terms), pivots(n))
      self%ends = [(sum(widths(:i)), i=0, n)]/self%unit
      call set_equations(self%ends, power, matrix, differences)
      call dgesv(n, terms, matrix, n, pivots, differences, n, code)
      if (code /= 0) differences = 0.0_wp
      do i = 1, terms
         self%discrete(:, i) = power_means(self%ends, power + i - 2) + differences(:, i)
      end do
   end function new_graded_solution

   !> Means of x**power over intervals.
   pure function power_means(ends, power) result(means)
      real(wp), intent(in) :: ends(0:), power
      real(wp) :: means(size(ends) - 1)
      integer :: n

      n = size(means)
      means = (ends(1:)**(power + 1.0_wp) - ends(:n - 1)**(power + 1.0_wp))/((power + 1.0_wp)*(ends(1:) - ends(:n - 1)))
   end function power_means

   !> Mean displacements of the intervals: by uniform tractions on them, `matrix`; and by the exact tractions less their means,
   !> `of_rest`. Their total length is 1, which determines the constant of the logarithm: it is small beside the entries.
   subroutine set_equations(ends, power, matrix, of_rest)
      real(wp), intent(in) :: ends(0:), power
      real(wp), intent(out) :: matrix(:, :), of_rest(:, :)
      integer, parameter :: points = 10
      real(wp) :: t(points), weight(points), step, place(points), share(points), rest(points, terms), means(size(ends) - 1)
      real(wp) :: twice(0:size(ends) - 1, 0:size(ends) - 1), once(0:size(ends) - 1, points)
      integer :: i, j, n

      n = size(means)
      step = 0.5_wp*pi*tan(pi*(0.5_wp - power))
      call gauss_points(0.0_wp, 1.0_wp, t, weight)
      ! Roots and logarithms at both ends of an interval become smooth.
      weight = 6.0_wp*t*(1.0_wp - t)*weight
      t = t**2*(3.0_wp - 2.0_wp*t)
      do j = 0, n
         twice(:, j) = log_twice(ends - ends(j))
      end do
      do j = 1, n
         associate (width => ends(j) - ends(j - 1))
            matrix(:, j) = -(twice(1:, j - 1) - twice(:n - 1, j - 1) - twice(1:, j) + twice(:n - 1, j))/(ends(1:) - ends(:n - 1))
            matrix(:, j) = matrix(:, j) + step*width*[(sign(min(abs(i - j), 1), i - j), i=1, n)]
            place = ends(j - 1) + width*t
            share = width*weight/sum(weight)
            do i = 1, terms
               rest(:, i) = place**(power + i - 2)*share
               rest(:, i) = rest(:, i) - sum(rest(:, i))*share/width
            end do
            do i = 1, points
               once(:, i) = log_once(ends - place(i))
            end do
            if (j == 1) of_rest = 0.0_wp
            of_rest = of_rest - matmul(once(1:, :) - once(:n - 1, :), rest)/spread(ends(1:) - ends(:n - 1), 2, terms)
            of_rest(j, :) = of_rest(j, :) - 2.0_wp*step/width*matmul(place, rest)
         end associate
      end do
   end subroutine set_equations

   !> Integrals of ln|x|: t ln|t| - t, and t^2/2 ln|t| - 3/4 t^2.
   elemental real(wp) function log_once(t)
      real(wp), intent(in) :: t

      log_once = 0.0_wp
      if (abs(t) > 0.0_wp) log_once = t*(log(abs(t)) - 1.0_wp)
   end function log_once

   elemental real(wp) function log_twice(t)
      real(wp), intent(in) :: t

      log_twice = 0.0_wp
      if (abs(t) > 0.0_wp) log_twice = 0.5_wp*t**2*(log(abs(t)) - 1.5_wp)
   end function log_twice

   !> Distance of the edge outwards from the outer end of the outermost interval, length, from the tractions of three or more
   !> intervals, outermost first. `found`: it is in this interval or the next one outwards, of the width `beyond`, length.
   subroutine edge_beyond(self, tractions, beyond, distance, found)
      class(graded_solution_type), intent(in) :: self
      real(wp), intent(in) :: tractions(:), beyond
      real(wp), intent(out) :: distance
      logical, intent(out) :: found
      real(wp) :: matrix(terms, terms), factors(terms)
      integer :: pivots(terms), code

      found = .false.
      distance = 0.0_wp
      if (size(self%discrete, 1) < terms) return
      matrix = self%discrete(:terms, :)
      factors = tractions(:terms)
      call dgesv(terms, 1, matrix, terms, pivots, factors, terms, code)
      if (code /= 0 .or. .not. factors(2) > 0.0_wp) return
      distance = self%unit*factors(1)/(self%power*factors(2))
      associate (outermost => self%unit*self%ends(1))
         found = distance >= -outermost .and. distance <= max(outermost, beyond)
      end associate
   end subroutine edge_beyond

   !> Discrete tractions over the means of the exact ones for an edge `distance` beyond the outer end of the outermost interval,
   !> length, which it may cut; 1 for intervals farther inwards, where the end of the solution is near.
   pure function over_exact(self, distance, intervals) result(ratio)
      class(graded_solution_type), intent(in) :: self
      real(wp), intent(in) :: distance
      integer, intent(in) :: intervals
      real(wp) :: ratio(intervals), exact(size(self%ends) - 1)
      integer :: n

      ratio = 1.0_wp
      n = min(intervals, max(size(exact)/2, 1))
      exact = power_means(max(self%ends + distance/self%unit, 0.0_wp), self%power)
      exact(1) = exact(1)*max(self%ends(1) + min(distance/self%unit, 0.0_wp), 0.0_wp)/self%ends(1)
      ratio(:n) = (self%discrete(:n, 2) + self%power*distance/self%unit*self%discrete(:n, 1))/max(exact(:n), tiny(1.0_wp))
      where (.not. ratio > 0.5_wp) ratio = 1.0_wp
   end function over_exact

end module mfv_edge_solutions
