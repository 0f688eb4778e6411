!> Cauchy integrals over many elements of a surface: distant groups of them act through their moments (Barnes and Hut 1986;
!> Greengard and Rokhlin 1987, J. Comput. Phys. 73, 325, for logarithmic potentials).
!>
!> With the traction sigma along the surface s, in the complex plane, and the middle c of a group of elements
!>
!>     integral of sigma/(s - z) ds = - sum over k >= 0 of M_k/(z - c)^(k+1),  M_k = integral of sigma (s - c)^k ds.
!>
!> Groups are the nodes of a binary tree. Moments of its leaves are found by quadrature or, along a straight surface, in closed
!> form, the others from those of their halves.
module mfv_element_tree
   use mfv_kinds, only: wp
   implicit none
   private
   public :: element_tree_type, new_element_tree, new_straight_tree, last_not_above

   !> Most elements of a leaf; radii beyond which a group acts through its moments; the highest moment.
   integer, parameter :: leaf_size = 32
   real(wp), parameter :: distant = 3.0_wp
   integer, parameter :: most_moments = ceiling(digits(1.0_wp)*log(2.0_wp)/log(distant))
   !> Most groups that wait for their turn: one for each level of the tree, at most.
   integer, parameter :: most_levels = 64

   type :: element_tree_type
      private
      !> First and last elements of the groups, and the first of both halves (0: a leaf); shapes (groups).
      integer, allocatable :: first(:), last(:), halves(:)
      !> Middles and radii of the groups; moments of sigma and of its imaginary part over radius^k, shapes (0:most_moments, groups).
      complex(wp), allocatable :: middle(:), moments(:, :), shear_moments(:, :)
      real(wp), allocatable :: radius(:)
      integer :: leaf_count = 0
   contains
      procedure :: find_distant
      procedure :: find_distant_along
      procedure :: leaves
   end type element_tree_type

contains

   !> Elements along a surface with sigma at quadrature points: `place` of the points, and `weight` such that the integral of f ds
   !> over an element is the sum of f times weight; shapes (points, elements). `ends`: of the elements, shape (2, elements).
   pure type(element_tree_type) function new_element_tree(ends, place, sigma, weight) result(self)
      complex(wp), intent(in) :: ends(:, :), place(:, :), sigma(:, :), weight(:, :)
      integer :: group

      call divide(self, size(place, 2))
      do group = 1, size(self%first)
         if (self%halves(group) /= 0) cycle
         associate (i => self%first(group), j => self%last(group))
            call add_leaf(self, group, ends(:, i:j), place(:, i:j), sigma(:, i:j), weight(:, i:j))
         end associate
      end do
      call join_groups(self)
   end function new_element_tree

   !> Elements from `from` to `to` along the real axis, with sigma linear from `first` to `last`; shapes (elements).
   pure type(element_tree_type) function new_straight_tree(from, to, first, last) result(self)
      real(wp), intent(in) :: from(:), to(:)
      complex(wp), intent(in) :: first(:), last(:)
      integer :: group

      call divide(self, size(from))
      do group = 1, size(self%first)
         if (self%halves(group) /= 0) cycle
         associate (i => self%first(group), j => self%last(group))
            call add_straight_leaf(self, group, from(i:j), to(i:j), first(i:j), last(i:j))
         end associate
      end do
      call join_groups(self)
   end function new_straight_tree

   !> Divide some elements into groups, without their moments.
   pure subroutine divide(self, elements)
      type(element_tree_type), intent(inout) :: self
      integer, intent(in) :: elements
      integer :: group, groups, middle

      groups = 2*elements
      allocate (self%first(groups), self%last(groups), self%halves(groups))
      groups = min(elements, 1)
      self%first(:groups) = 1
      self%last(:groups) = elements
      group = 1
      do while (group <= groups)
         self%halves(group) = 0
         if (self%last(group) - self%first(group) >= leaf_size) then
            self%halves(group) = groups + 1
            middle = (self%first(group) + self%last(group))/2
            self%first(groups + 1:groups + 2) = [self%first(group), middle + 1]
            self%last(groups + 1:groups + 2) = [middle, self%last(group)]
            groups = groups + 2
         end if
         group = group + 1
      end do
      self%first = self%first(:groups)
      self%last = self%last(:groups)
      self%halves = self%halves(:groups)
      self%leaf_count = count(self%halves == 0)
      allocate (self%middle(groups), self%radius(groups))
      allocate (self%moments(0:most_moments, groups), self%shear_moments(0:most_moments, groups))
   end subroutine divide

   !> Middle, radius and moments of a leaf with these elements, see new_straight_tree. With d_k = b^k - a^k, a and b the ends of an
   !> element over the radius, d_(k+1) = b d_k + a^k (b - a); sigma = c + s t has the moments c d_(k+1)/(k+1) + s d_(k+2)/(k+2).
   pure subroutine add_straight_leaf(self, group, from, to, first, last)
      type(element_tree_type), intent(inout) :: self
      integer, intent(in) :: group
      real(wp), intent(in) :: from(:), to(:)
      complex(wp), intent(in) :: first(:), last(:)
      real(wp), dimension(size(from)) :: a, b, width, power, difference
      complex(wp), dimension(size(from)) :: constant, slope
      integer :: k

      associate (middle => 0.5_wp*(from(1) + to(size(to))))
         self%middle(group) = middle
         self%radius(group) = max(maxval(abs(from - middle)), maxval(abs(to - middle)), tiny(1.0_wp))
         a = (from - middle)/self%radius(group)
         b = (to - middle)/self%radius(group)
      end associate
      width = (to - from)/self%radius(group)
      slope = 0.0_wp
      where (width > 0.0_wp) slope = (last - first)/width
      constant = 0.5_wp*(first + last - slope*(a + b))
      power = a
      difference = width
      do k = 0, most_moments
         self%moments(k, group) = sum(constant*difference)/(k + 1)
         difference = b*difference + power*width
         self%moments(k, group) = self%moments(k, group) + sum(slope*difference)/(k + 2)
         power = power*a
      end do
      self%moments(:, group) = self%radius(group)*self%moments(:, group)
      ! Along a straight surface shear moments are the imaginary parts.
      self%shear_moments(:, group) = aimag(self%moments(:, group))
   end subroutine add_straight_leaf

   !> Middle, radius and moments of a leaf with these elements, see new_element_tree.
   pure subroutine add_leaf(self, group, ends, place, sigma, weight)
      type(element_tree_type), intent(inout) :: self
      integer, intent(in) :: group
      complex(wp), intent(in) :: ends(:, :), place(:, :), sigma(:, :), weight(:, :)
      complex(wp), dimension(size(place, 1), size(place, 2)) :: terms, shear, ratio
      integer :: k

      self%middle(group) = 0.5_wp*(ends(1, 1) + ends(2, size(ends, 2)))
      self%radius(group) = max(maxval(abs(ends - self%middle(group))), tiny(1.0_wp))
      ratio = (place - self%middle(group))/self%radius(group)
      terms = sigma*weight
      shear = aimag(sigma)*weight
      do k = 0, most_moments
         self%moments(k, group) = sum(terms)
         self%shear_moments(k, group) = sum(shear)
         terms = terms*ratio
         shear = shear*ratio
      end do
   end subroutine add_leaf

   !> Groups of groups from their leaves upwards: halves have larger numbers.
   pure subroutine join_groups(self)
      type(element_tree_type), intent(inout) :: self
      integer :: group

      do group = size(self%first), 1, -1
         if (self%halves(group) /= 0) call join_halves(self, group)
      end do
   end subroutine join_groups

   !> Middle, radius and moments of a group from those of its halves.
   pure subroutine join_halves(self, group)
      type(element_tree_type), intent(inout) :: self
      integer, intent(in) :: group
      real(wp) :: radius
      complex(wp) :: middle
      logical :: straight
      integer :: half

      associate (halves => [self%halves(group), self%halves(group) + 1])
         middle = 0.5_wp*sum(self%middle(halves))
         radius = maxval(abs(self%middle(halves) - middle) + self%radius(halves))
         self%moments(:, group) = 0.0_wp
         self%shear_moments(:, group) = 0.0_wp
         straight = .not. any(abs(aimag(self%middle(halves))) > 0.0_wp)
         do half = 1, 2
            associate (part => halves(half))
               associate (shrink => self%radius(part)/radius, shift => (self%middle(part) - middle)/radius)
                  self%moments(:, group) = self%moments(:, group) + about_other(self%moments(:, part), shrink, shift)
                  if (.not. straight) self%shear_moments(:, group) = self%shear_moments(:, group) &
                                                                     + about_other(self%shear_moments(:, part), shrink, shift)
               end associate
            end associate
         end do
         if (straight) self%shear_moments(:, group) = aimag(self%moments(:, group))
      end associate
      self%middle(group) = middle
      self%radius(group) = radius
   end subroutine join_halves

   !> Moments about a middle from which the old one is a `shift` of radii away, with a radius of which the old one is `shrink`.
   pure function about_other(moments, shrink, shift) result(shifted)
      complex(wp), intent(in) :: moments(0:), shift
      real(wp), intent(in) :: shrink
      complex(wp) :: shifted(0:most_moments)
      logical :: straight
      integer :: i, k

      straight = .not. abs(aimag(shift)) > 0.0_wp
      shifted = [(moments(k)*shrink**k, k=0, most_moments)]
      ! Binomial sums, in place; along a straight surface with real numbers.
      do i = 1, most_moments
         do k = most_moments, i, -1
            if (straight) then
               shifted(k) = shifted(k) + real(shift, wp)*shifted(k - 1)
            else
               shifted(k) = shifted(k) + shift*shifted(k - 1)
            end if
         end do
      end do
   end function about_other

   !> Number of leaves.
   pure integer function leaves(self)
      class(element_tree_type), intent(in) :: self

      leaves = self%leaf_count
   end function leaves

   !> Integrals over the elements distant from both points z, on one side of the surface: of sigma/(s - z1) ds, its divided
   !> difference sigma/((s - z1) (s - z2)) ds, the derivative where the points are equal, and both for aimag(sigma). The other
   !> elements are in the first `number` ranges of elements `near`, shape (2, leaves).
   pure subroutine find_distant(self, z, integrals, near, number)
      class(element_tree_type), intent(in) :: self
      complex(wp), intent(in) :: z(2)
      complex(wp), intent(out) :: integrals(4)
      integer, intent(inout) :: near(:, :)
      integer, intent(out) :: number
      integer :: waiting(most_levels), group, places
      complex(wp) :: away(2)

      integrals = 0.0_wp
      number = 0
      places = min(size(self%first), 1)
      waiting(1) = 1
      do while (places > 0)
         group = waiting(places)
         places = places - 1
         away = z - self%middle(group)
         if (minval(real(away, wp)**2 + aimag(away)**2) > (distant*self%radius(group))**2) then
            call add_group(self%moments(:, group), self%shear_moments(:, group), self%radius(group), away, integrals)
         else
            call look_closer(self, group, waiting, places, near, number)
         end if
      end do
   end subroutine find_distant

   !> The integral over sigma/(s - x) ds over the elements of a straight surface distant from a point x of it; the others are in the
   !> first `number` ranges of elements `near`, shape (2, leaves).
   pure subroutine find_distant_along(self, x, integral, near, number)
      class(element_tree_type), intent(in) :: self
      real(wp), intent(in) :: x
      complex(wp), intent(out) :: integral
      integer, intent(inout) :: near(:, :)
      integer, intent(out) :: number
      integer :: waiting(most_levels), group, places, k
      real(wp) :: away, ratio
      complex(wp) :: total

      integral = 0.0_wp
      number = 0
      places = min(size(self%first), 1)
      waiting(1) = 1
      do while (places > 0)
         group = waiting(places)
         places = places - 1
         away = x - real(self%middle(group), wp)
         if (abs(away) > distant*self%radius(group)) then
            ratio = self%radius(group)/away
            total = 0.0_wp
            do k = highest_moment(abs(ratio)), 0, -1
               total = total*ratio + self%moments(k, group)
            end do
            integral = integral - total/away
         else
            call look_closer(self, group, waiting, places, near, number)
         end if
      end do
   end subroutine find_distant_along

   !> Put the halves of a group that is not distant among the first `places` groups `waiting` to be looked at; or, if it has none,
   !> its elements among the first `number` ranges `near`.
   pure subroutine look_closer(self, group, waiting, places, near, number)
      class(element_tree_type), intent(in) :: self
      integer, intent(in) :: group
      integer, intent(inout) :: waiting(:), places, near(:, :), number

      if (self%halves(group) == 0) then
         number = number + 1
         near(:, number) = [self%first(group), self%last(group)]
      else
         waiting(places + 1:places + 2) = self%halves(group) + [1, 0]
         places = places + 2
      end if
   end subroutine look_closer

   !> The highest moment that matters at a `ratio` of the radius to the distance.
   pure integer function highest_moment(ratio)
      real(wp), intent(in) :: ratio

      highest_moment = min(most_moments, ceiling(digits(1.0_wp)*log(2.0_wp)/(-log(ratio))))
   end function highest_moment

   !> Add the integrals of a group, at points `away` from its middle. Polynomials of the ratio by Horner's scheme, whose
   !> intermediate values are the coefficients of the divided difference.
   pure subroutine add_group(moments, shear_moments, radius, away, integrals)
      complex(wp), intent(in) :: moments(0:), shear_moments(0:), away(2)
      real(wp), intent(in) :: radius
      complex(wp), intent(inout) :: integrals(4)
      complex(wp) :: ratio(2), sums(2), differences(2)
      integer :: k

      ratio = radius/away
      sums = 0.0_wp
      differences = 0.0_wp
      do k = highest_moment(maxval(abs(ratio))), 0, -1
         differences = differences*ratio(2) + sums
         sums = sums*ratio(1) + [moments(k), shear_moments(k)]
      end do
      differences = (sums + ratio(2)*differences)/(away(1)*away(2))
      integrals = integrals + [-sums(1)/away(1), differences(1), -sums(2)/away(1), differences(2)]
   end subroutine add_group

   !> Index of the last of ascending values that is not above x; 0 for none.
   pure integer function last_not_above(values, x) result(last)
      real(wp), intent(in) :: values(:), x
      integer :: beyond, middle

      last = 0
      beyond = size(values) + 1
      do while (beyond - last > 1)
         middle = (last + beyond)/2
         if (values(middle) <= x) then
            last = middle
         else
            beyond = middle
         end if
      end do
   end function last_not_above

end module mfv_element_tree
