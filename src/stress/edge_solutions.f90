!> Discretisation error of nodal tractions next to a contact edge: the two solutions of the discrete equations there.
!>
!> Tractions are uniform on equal intervals of a half-plane, and displacements are those at the middles. At the edge tractions
!> vanish as the distance to the power m. The discrete equations have the solutions k(j), g(j) and h(j), j = 0 at the outermost
!> node, with the asymptotes u^(m-1), u^m and u^(m+1), u = j + offset: the discrete tractions of an edge that lies `offset`
!> intervals outwards, and of its shift. They follow from the Wiener-Hopf factors of the symbol (docs/theory.md, edges between
!> nodes). The tractions of three nodes give their factors, and these the edge.
!>
!> On unequal intervals, where displacements are means, the three solutions follow from the equations of the outermost intervals:
!> the difference from the means of the exact tractions decays inwards.
module mfv_edge_solutions
   use mfv_kinds, only: pi, wp
   use mfv_lapack, only: dgesv
   use mfv_quadrature, only: gauss_points
   use mfv_tolerances, only: rounding
   implicit none
   private
   public :: find_solved_distance, discrete_over_exact, graded_solution_type, new_graded_solution, least_power, most_power, &
             root_factor, find_singular_factor

   !> Exponents for which the solutions are tabulated.
   real(wp), parameter :: least_power = 0.29_wp, most_power = 0.71_wp
   !> Exact tractions are the distance to the power m - 1, m and m + 1. Nodes, from 0, to which solutions are tabulated.
   integer, parameter :: terms = 3, most_tabulated = 4

   !> Discrete tractions of the outermost unequal intervals; `unit`: their total width, length.
   type :: graded_solution_type
      private
      real(wp) :: power = 0.5_wp, unit = 1.0_wp
      !> Ends as distances from that of the contact; shapes (0:intervals), (intervals, terms).
      real(wp), allocatable :: ends(:), discrete(:, :)
   contains
      procedure :: edge_beyond
      procedure :: over_exact
      procedure :: graded_root
      procedure :: graded_singular
      procedure :: length_unit
      procedure :: intervals => solved_intervals
   end type graded_solution_type

contains

   !> `distance` of the edge, in intervals outwards from the outermost node, where tractions vanish with the exponent `power`.
   !> `tractions`: at the outermost nodes, outermost first; those of the nodes `first` (0 or 1) to first + 2 are used. `distance` is
   !> unchanged if no edge is `found` in the interval of the outermost node or the next.
   pure subroutine find_solved_distance(tractions, power, first, distance, found)
      real(wp), intent(in) :: tractions(0:), power
      integer, intent(in) :: first
      real(wp), intent(inout) :: distance
      logical, intent(out) :: found
      real(wp), parameter :: nearest = -0.6_wp, farthest = 1.6_wp
      real(wp) :: offset, columns(terms, terms), edge

      found = .false.
      if (size(tractions) < first + terms) return
      call find_columns(power, first, offset, columns)
      edge = offset + shift_of_edge(factors_of(columns, tractions(first:first + terms - 1)), power)
      found = edge >= nearest .and. edge <= farthest
      if (found) distance = edge
   end subroutine find_solved_distance

   !> Factor a of tractions a s^power + b s^(power + 1) at the distance s from their edge, which may lie anywhere near the outermost
   !> node, from those of the three nodes from `first` (0 or 1) on, outermost first: units of the interval.
   pure real(wp) function root_factor(tractions, power, first) result(factor)
      real(wp), intent(in) :: tractions(terms), power
      integer, intent(in) :: first
      real(wp) :: offset, columns(terms, terms)

      call find_columns(power, first, offset, columns)
      factor = root_of(factors_of(columns, tractions), power)
   end function root_factor

   !> Factor a of tractions a s^(power - 1) + b s^power at the distance s from an edge of a zone whose nodes are all held, from
   !> those of the outermost three nodes. `offset`: where the edge of the discrete solution is, in intervals outwards from the
   !> outermost node: k(j) is the power m - 1 of j + offset there, half an interval before that of g(j) (docs/theory.md: s = m).
   pure subroutine find_singular_factor(tractions, power, factor, offset)
      real(wp), intent(in) :: tractions(0:terms - 1), power
      real(wp), intent(out) :: factor, offset
      real(wp), parameter :: half = 0.5_wp
      real(wp) :: columns(terms, terms), factors(terms)

      call find_columns(power, 0, offset, columns)
      factors = factors_of(columns, tractions)
      offset = offset - half
      factor = factors(1) + half*power*factors(2) + 0.5_wp*half**2*power*(power + 1.0_wp)*factors(3)
   end subroutine find_singular_factor

   !> The three solutions at the three nodes from `first` on.
   pure subroutine find_columns(power, first, offset, columns)
      real(wp), intent(in) :: power
      integer, intent(in) :: first
      real(wp), intent(out) :: offset, columns(terms, terms)
      real(wp) :: g(0:most_tabulated), k(0:most_tabulated), h(0:most_tabulated - 1)

      call find_edge_solutions(power, offset, g, k, h)
      associate (last => first + terms - 1)
         columns = reshape([k(first:last), g(first:last), h(first:last)], [terms, terms])
      end associate
   end subroutine find_columns

   !> The factor at the edge itself, from those of the powers about a place near it; 0 at the edge of a zone that has grown.
   pure real(wp) function root_of(factors, power)
      real(wp), intent(in) :: factors(terms), power

      root_of = 0.0_wp
      if (discriminant_of(factors, power) > 0.0_wp) root_of = factors(2) - (power + 1.0_wp)*factors(3)*shift_of_edge(factors, power)
   end function root_of

   !> Factors of the columns of a matrix in `values`, by Cramer's rule.
   pure function factors_of(columns, values) result(factors)
      real(wp), intent(in) :: columns(terms, terms), values(terms)
      real(wp) :: factors(terms)

      factors = [volume(values, columns(:, 2), columns(:, 3)), volume(columns(:, 1), values, columns(:, 3)), &
                 volume(columns(:, 1), columns(:, 2), values)]/volume(columns(:, 1), columns(:, 2), columns(:, 3))

   contains

      pure real(wp) function volume(a, b, c)
         real(wp), intent(in) :: a(terms), b(terms), c(terms)

         volume = a(1)*(b(2)*c(3) - b(3)*c(2)) - a(2)*(b(1)*c(3) - b(3)*c(1)) + a(3)*(b(1)*c(2) - b(2)*c(1))
      end function volume
   end function factors_of

   !> How far an edge lies outwards, from factors of the powers m - 1, m and m + 1 of the distance from a place near it: tractions
   !> a (d + s)^m + b (d + s)^(m+1), a >= 0, have the factors m a s + m (m+1)/2 b s^2, a + (m+1) b s and b. Where that has no
   !> solution a is 0: the edge of a zone that has grown.
   pure real(wp) function shift_of_edge(factors, power) result(shift)
      real(wp), intent(in) :: factors(terms), power
      real(wp) :: discriminant

      discriminant = discriminant_of(factors, power)
      if (discriminant > 0.0_wp) then
         shift = 2.0_wp*factors(1)/(power*factors(2) + sqrt(discriminant))
      else
         shift = factors(2)/((power + 1.0_wp)*factors(3))
      end if
   end function shift_of_edge

   !> Positive where an edge has tractions of the power `power`.
   pure real(wp) function discriminant_of(factors, power)
      real(wp), intent(in) :: factors(terms), power

      discriminant_of = (power*factors(2))**2 - 2.0_wp*power*(power + 1.0_wp)*factors(1)*factors(3)
   end function discriminant_of

   !> Offset and the three solutions from j = 0 on for an exponent, interpolated in the table to 3e-5, k to 9e-4. Verified by
   !> tests/python/test_edge_solutions.py.
   pure subroutine find_edge_solutions(power, offset, g, k, h)
      real(wp), intent(in) :: power
      real(wp), intent(out) :: offset, g(0:most_tabulated), k(0:most_tabulated), h(0:most_tabulated - 1)
      integer, parameter :: powers = 7, numbers = 3*(most_tabulated + 1)
      integer :: i
      real(wp), parameter :: tabulated(powers) = [(least_power + (i - 1)*(most_power - least_power)/(powers - 1), i=1, powers)]
      real(wp), parameter :: solutions(numbers, powers) = reshape([ &
                           0.860695_wp, 1.131712_wp, 1.175358_wp, 1.370073_wp, 1.481191_wp, 1.584615_wp, 3.902455_wp, 0.150503_wp, &
                                        0.671431_wp, 0.383166_wp, 0.356636_wp, 0.888756_wp, 2.224138_wp, 3.887139_wp, 5.714474_wp, &
                           0.841318_wp, 1.050164_wp, 1.246079_wp, 1.464396_wp, 1.626871_wp, 1.767032_wp, 2.917122_wp, 0.544208_wp, &
                                        0.606435_wp, 0.451321_wp, 0.389337_wp, 0.836153_wp, 2.298324_wp, 4.144050_wp, 6.239622_wp, &
                           0.829379_wp, 0.992912_wp, 1.304766_wp, 1.570424_wp, 1.785116_wp, 1.970880_wp, 2.309098_wp, 0.725241_wp, &
                                        0.617810_wp, 0.499283_wp, 0.432011_wp, 0.787493_wp, 2.377132_wp, 4.429284_wp, 6.824514_wp, &
                           0.825347_wp, 0.954443_wp, 1.361029_wp, 1.686648_wp, 1.959477_wp, 2.199223_wp, 1.908886_wp, 0.813172_wp, &
                                        0.651237_wp, 0.545658_wp, 0.479493_wp, 0.745653_wp, 2.465140_wp, 4.748367_wp, 7.481311_wp, &
                           0.829381_wp, 0.930947_wp, 1.420520_wp, 1.814357_wp, 2.153109_wp, 2.456090_wp, 1.633240_wp, 0.858901_wp, &
                                        0.690941_wp, 0.594302_wp, 0.531546_wp, 0.714741_wp, 2.568254_wp, 5.109283_wp, 8.224694_wp, &
                           0.841323_wp, 0.919740_wp, 1.486742_wp, 1.955828_wp, 2.369472_wp, 2.746252_wp, 1.437094_wp, 0.885941_wp, &
                                        0.732947_wp, 0.646318_wp, 0.588719_wp, 0.699530_wp, 2.693808_wp, 5.522535_wp, 9.072576_wp, &
                           0.860702_wp, 0.918895_wp, 1.562005_wp, 2.113650_wp, 2.612415_wp, 3.075200_wp, 1.294218_wp, 0.905789_wp, &
                                      0.776965_wp, 0.702486_wp, 0.651810_wp, 0.704795_wp, 2.850233_wp, 6.000967_wp, 10.046406_wp], &
                                                                  [numbers, powers])
      real(wp) :: found(numbers)
      logical :: others(powers)

      i = nint((power - least_power)*(powers - 1)/(most_power - least_power)) + 1
      if (abs(power - tabulated(min(max(i, 1), powers))) <= rounding) then
         found = solutions(:, i)  ! such as 1/2
      else
         found = 0.0_wp
         do i = 1, powers
            others = .true.
            others(i) = .false.
            found = found + solutions(:, i)*product((power - tabulated)/(tabulated(i) - tabulated), mask=others)
         end do
      end if
      offset = found(1)
      associate (n => most_tabulated + 1)
         g = found(2:n + 1)
         k = found(n + 2:2*n + 1)
         h = found(2*n + 2:)
      end associate
   end subroutine find_edge_solutions

   !> Discrete traction over d^power at the nodes j = 1, 2, ..., for an edge `distance` intervals outwards from the outermost
   !> node; 1 without a discrete solution. Its difference from 1 decays as the inverse square of the distance.
   pure function discrete_over_exact(power, distance, nodes) result(ratio)
      real(wp), intent(in) :: power, distance
      integer, intent(in) :: nodes
      real(wp) :: ratio(nodes)
      real(wp) :: offset, g(0:most_tabulated), k(0:most_tabulated), h(0:most_tabulated - 1)
      integer :: j

      call find_edge_solutions(power, offset, g, k, h)
      do j = 1, nodes
         if (j <= most_tabulated) then
            ratio(j) = (g(j) + power*(distance - offset)*k(j))/(j + distance)**power
         else
            ratio(j) = 1.0_wp + (ratio(most_tabulated) - 1.0_wp)*((most_tabulated + distance)/(j + distance))**2
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

      found = .false.
      distance = 0.0_wp
      if (size(self%discrete, 1) < terms) return
      distance = self%unit*shift_of_edge(factors_of(self%discrete(:terms, :), tractions(:terms)), self%power)
      associate (outermost => self%unit*self%ends(1))
         found = distance >= -outermost .and. distance <= max(outermost, beyond)
      end associate
   end subroutine edge_beyond

   !> As root_factor, in units of length_unit.
   pure real(wp) function graded_root(self, tractions, first) result(factor)
      class(graded_solution_type), intent(in) :: self
      real(wp), intent(in) :: tractions(terms)
      integer, intent(in) :: first

      factor = root_of(factors_of(self%discrete(first + 1:first + terms, :), tractions), self%power)
   end function graded_root

   !> As find_singular_factor; the edge of the discrete solution is the outer end of the outermost interval.
   pure real(wp) function graded_singular(self, tractions) result(factor)
      class(graded_solution_type), intent(in) :: self
      real(wp), intent(in) :: tractions(:)
      real(wp) :: factors(terms)

      factors = factors_of(self%discrete(:terms, :), tractions(:terms))
      factor = factors(1)
   end function graded_singular

   !> The length that is 1 in the factors of this solution.
   pure real(wp) function length_unit(self)
      class(graded_solution_type), intent(in) :: self

      length_unit = self%unit
   end function length_unit

   !> Number of the outermost intervals that are far enough from the end of the solution.
   pure integer function solved_intervals(self) result(number)
      class(graded_solution_type), intent(in) :: self

      number = max((size(self%ends) - 1)/2, 1)
   end function solved_intervals

   !> Discrete tractions over the means of the exact ones for an edge `distance` beyond the outer end of the outermost interval,
   !> length, which it may cut; 1 for intervals farther inwards, where the end of the solution is near.
   pure function over_exact(self, distance, intervals) result(ratio)
      class(graded_solution_type), intent(in) :: self
      real(wp), intent(in) :: distance
      integer, intent(in) :: intervals
      real(wp) :: ratio(intervals), exact(size(self%ends) - 1)
      integer :: n

      ratio = 1.0_wp
      n = min(intervals, self%intervals())
      exact = power_means(max(self%ends + distance/self%unit, 0.0_wp), self%power)
      exact(1) = exact(1)*max(self%ends(1) + min(distance/self%unit, 0.0_wp), 0.0_wp)/self%ends(1)
      ratio(:n) = (self%discrete(:n, 2) + self%power*distance/self%unit*self%discrete(:n, 1))/max(exact(:n), tiny(1.0_wp))
      where (.not. ratio > 0.5_wp) ratio = 1.0_wp
   end function over_exact

end module mfv_edge_solutions
