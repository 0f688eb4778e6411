!> Stresses inside a half-plane under tractions that are linear on elements of its surface, in closed form.
!>
!> With sigma_yy = -p, sigma_xy = tau on y = 0, the integrals N(z) of p/(t - z) dt and T(z) of tau/(t - z) dt, and the roots mu1 and
!> mu2 of mfv_material, the derivatives of Lekhnitskii's potentials in the lower half-plane are (docs/theory.md)
!>
!>     Phi1 = (mu2 N - T)/(2 pi i (mu2 - mu1)) at z1 = x + mu1 y,    Phi2 = (T - mu1 N)/(2 pi i (mu2 - mu1)) at z2 = x + mu2 y
!>
!> and sigma_xx, sigma_yy and -sigma_xy twice the real parts of the sums of mu^2 Phi, Phi and mu Phi. With the divided differences
!> N' = (N(z2) - N(z1))/(z2 - z1) and T', nothing is divided by mu2 - mu1:
!>
!>     sigma_xx = 2 Re [(mu1 + mu2) T + mu2^2 y T' - mu1 mu2 (N + mu2 y N')]/(2 pi i)
!>     sigma_yy = 2 Re [N - mu1 y N' + y T']/(2 pi i)
!>     sigma_xy = 2 Re [mu1 mu2 y N' - T - mu2 y T']/(2 pi i)
!>
!> N and T at z1. With equal roots N' and T' are derivatives: of an isotropic material Muskhelishvili's solution (1953, sections
!> 90 to 93; Johnson 1985, section 2.5, for uniform and triangular tractions). The integrals over an element are elementary; for
!> elements that are short compared with their distance, series avoid cancellation; groups of distant elements act together
!> (mfv_element_tree).
module mfv_interior_half_plane
   use mfv_element_tree, only: element_tree_type, last_not_above, new_straight_tree
   use mfv_kinds, only: pi, wp
   use mfv_logarithms, only: log_ratio
   use mfv_material, only: material_type
   use mfv_periodic_images, only: images_each_side, new_periodic_images, periodic_images_type
   use mfv_tolerances, only: significant
   implicit none
   private
   public :: half_plane_load_type, new_half_plane_load, line_load_stress, surface_stress_of

   !> Terms of the power series, which converge at least as 1/25^k: enough for the kind of real numbers.
   integer, parameter :: most_terms = int(0.25_wp*digits(1.0_wp)) + 2

   !> A half-plane under tractions p + i tau that are linear on elements.
   type :: half_plane_load_type
      private
      type(material_type) :: material
      complex(wp) :: root(2) = (0.0_wp, 1.0_wp)
      !> Ends of the elements, lengths, and tractions there, force/length^2; shapes (elements).
      real(wp), allocatable :: from(:), to(:)
      complex(wp), allocatable :: first(:), last(:)
      type(element_tree_type) :: tree
      !> Of a surface that repeats: the distant images of the elements, the near ones to either side, and whether the first element
      !> begins where the last one of the image before ends; and the stress along the surface without which its mean strain would
      !> not be zero, force/length^2.
      type(periodic_images_type) :: images
      integer :: near_images = 0
      logical :: meets = .false.
      real(wp) :: lateral = 0.0_wp
      !> Middle of the period, from which places are measured here, length.
      real(wp) :: middle = 0.0_wp
   contains
      procedure :: stress
      procedure :: surface_stress
      procedure :: traction
   end type half_plane_load_type

contains

   !> Elements from `from` to `to`, lengths (ascending, for speed), with tractions p + i tau linear from `first` to `last`,
   !> force/length^2; shapes (elements). `period`: length after which they repeat, 0 and by default: not; `middle`
   !> of the period with the elements, length.
   pure type(half_plane_load_type) function new_half_plane_load(material, from, to, first, last, period, middle) &
      result(self)
      type(material_type), intent(in) :: material
      real(wp), intent(in) :: from(:), to(:)
      complex(wp), intent(in) :: first(:), last(:)
      real(wp), intent(in), optional :: period, middle
      real(wp) :: length
      integer :: n

      length = 0.0_wp
      if (present(period)) length = period
      self%material = material
      self%root = material%roots()
      self%first = first
      self%last = last
      if (length > 0.0_wp .and. present(middle)) self%middle = middle
      self%from = from - self%middle
      self%to = to - self%middle
      if (length > 0.0_wp) then
         self%near_images = images_each_side
         n = size(from)
         if (n > 0) self%meets = abs(to(n) - from(1) - length) < significant*length
         self%images = new_periodic_images(length, self%from, self%to, first, last)
         self%lateral = material%lateral_ratio()*sum(0.5_wp*real(first + last, wp)*(to - from))/length
      end if
      self%tree = new_straight_tree(self%from, self%to, self%first, self%last)
   end function new_half_plane_load

   !> Stresses (sigma_xx, sigma_yy, sigma_xy), force/length^2, at the depth `depth` >= 0 below the surface point `x`, lengths. At
   !> jumps of the tractions the singular term of sigma_xx on the surface is omitted.
   pure function stress(self, x, depth)
      class(half_plane_load_type), intent(in) :: self
      real(wp), intent(in) :: x, depth
      real(wp) :: stress(3)
      complex(wp) :: sums(4), other(4), points(2)

      points = x - self%middle - self%root*depth
      if (.not. self%images%period > 0.0_wp) then
         sums = near_sums(self, points)
      else
         points = self%images%move_into_period(points)
         if (self%images%is_deep(points) .or. self%images%is_near(points)) then
            sums = periodic_sums(self, points)
         else
            ! Points far from each other: each with its own number of periods.
            sums = periodic_sums(self, spread(one_point(1), 1, 2))
            other = periodic_sums(self, spread(one_point(2), 1, 2))
            sums([2, 4]) = (other([1, 3]) - sums([1, 3]))/(points(2) - points(1))
         end if
      end if
      stress = stress_of(self%material, self%root, depth, sums)
      stress(1) = stress(1) + self%lateral

   contains

      pure complex(wp) function one_point(number)
         integer, intent(in) :: number
         complex(wp) :: moved(1)

         moved = self%images%move_into_period(points(number:number))
         one_point = moved(1)
      end function one_point
   end function stress

   !> The integrals of stress_of over all images of a surface that repeats.
   pure function periodic_sums(self, points) result(sums)
      class(half_plane_load_type), intent(in) :: self
      complex(wp), intent(in) :: points(2)
      complex(wp) :: sums(4)

      if (self%images%is_deep(points)) then
         sums = self%images%whole(points)
      else
         sums = near_sums(self, points)
         call self%images%add_distant(points, sums)
      end if
   end function periodic_sums

   !> The integrals of stress_of over the elements, at two points at or below the surface.
   pure function near_sums(self, points) result(sums)
      class(half_plane_load_type), intent(in) :: self
      complex(wp), intent(in) :: points(2)
      complex(wp) :: sums(4), distant(4), mean, tilt, integral(2), difference(2)
      real(wp) :: ends(2)
      integer :: near(2, self%tree%leaves()), number, j, k, m

      sums = 0.0_wp
      do m = -self%near_images, self%near_images
         call self%tree%find_distant(points - m*self%images%period, distant, near, number)
         sums = sums + distant
         do k = 1, number
            do j = near(1, k), near(2, k)
               mean = 0.5_wp*(self%first(j) + self%last(j))
               tilt = 0.5_wp*(self%last(j) - self%first(j))
               ends = ends_of(self, j, m)
               call element_integrals(ends(1) - points, ends(2) - points, integral, difference)
               sums(1) = sums(1) + mean*integral(1) + tilt*integral(2)
               sums(2) = sums(2) + mean*difference(1) + tilt*difference(2)
               sums(3) = sums(3) + aimag(mean)*integral(1) + aimag(tilt)*integral(2)
               sums(4) = sums(4) + aimag(mean)*difference(1) + aimag(tilt)*difference(2)
            end do
         end do
      end do
   end function near_sums

   !> The ends of element `j` of the image number `image`, lengths: the same numbers where images meet, so that the logarithms there
   !> cancel.
   pure function ends_of(self, j, image) result(ends)
      class(half_plane_load_type), intent(in) :: self
      integer, intent(in) :: j, image
      real(wp) :: ends(2)

      ends = [self%from(j), self%to(j)] + image*self%images%period
      if (self%meets .and. j == size(self%to)) ends(2) = self%from(1) + (image + 1)*self%images%period
   end function ends_of

   !> Stresses as of `stress` at the depth `depth` > 0, length, under line loads `normal` into the surface and `shear` to the right,
   !> force/length, at the distances `right` to the right, lengths; shapes (loads). Isotropic: Flamant (Johnson 1985, section 2.3).
   pure function line_load_stress(material, right, depth, normal, shear) result(stress)
      type(material_type), intent(in) :: material
      real(wp), intent(in) :: right(:), depth, normal(:), shear(:)
      real(wp) :: stress(3)
      complex(wp) :: roots(2), sums(4)
      complex(wp), dimension(size(right)) :: first, both, load

      roots = material%roots()
      first = 1.0_wp/(right + roots(1)*depth)
      both = first/(right + roots(2)*depth)
      load = cmplx(normal, shear, wp)
      sums = [sum(load*first), sum(load*both), sum(shear*first), sum(shear*both)]
      stress = stress_of(material, roots, depth, sums)
   end function line_load_stress

   !> Stresses from the integrals `sums` of p + i tau and of tau: each at the first point, and its divided difference.
   pure function stress_of(material, roots, depth, sums) result(stress)
      type(material_type), intent(in) :: material
      complex(wp), intent(in) :: roots(2), sums(4)
      real(wp), intent(in) :: depth
      complex(wp), parameter :: i = (0.0_wp, 1.0_wp)
      complex(wp) :: normal, shear, of_normal, of_shear
      real(wp) :: stress(3)

      shear = sums(3)
      normal = sums(1) - i*shear
      of_shear = -depth*sums(4)
      of_normal = -depth*sums(2) - i*of_shear
      ! 2 Re f/(2 pi i) = Im f/pi.
      associate (mu => roots, total => material%root_sum, product => material%root_product)
         stress(1) = aimag(total*shear + mu(2)**2*of_shear - product*(normal + mu(2)*of_normal))/pi
         stress(2) = aimag(normal - mu(1)*of_normal + of_shear)/pi
         stress(3) = aimag(product*of_normal - shear - mu(2)*of_shear)/pi
      end associate
   end function stress_of

   !> sigma_xx at the surface point `x`, equal to that of `stress`, in real numbers: with mu1 + mu2 = a + i b and mu1 mu2 = c + i d
   !> c p(x) - a tau(x) + 1/pi integral of (b tau - d p)/(t - x) dt; isotropic: c = -1, b = 2.
   pure real(wp) function surface_stress(self, x)
      class(half_plane_load_type), intent(in) :: self
      real(wp), intent(in) :: x
      real(wp) :: here(2), sums(2), place, ends(2)
      complex(wp) :: images(4), distant
      integer :: near(2, self%tree%leaves()), number, j, k, m

      place = place_of(self, x)
      images = 0.0_wp
      if (self%images%period > 0.0_wp) call self%images%add_distant(cmplx([place, place], 0.0_wp, wp), images)
      here = 0.0_wp
      ! Along the surface integrals of p and of tau are real.
      sums = [real(images(1), wp), real(images(3), wp)]
      do m = -self%near_images, self%near_images
         call self%tree%find_distant_along(place - m*self%images%period, distant, near, number)
         sums = sums + [real(distant, wp), aimag(distant)]
         do k = 1, number
            do j = near(1, k), near(2, k)
               ends = ends_of(self, j, m) - place
               call add_surface_element(ends(1), ends(2), self%first(j), self%last(j), sums, here)
            end do
         end do
      end do
      surface_stress = surface_stress_of(self%material, here(1), here(2), sums(1)/pi, sums(2)/pi) + self%lateral
   end function surface_stress

   !> sigma_xx at a surface point with the tractions `pressure` and `shear`, force/length^2, and the integrals of p/(t - x) dt/pi
   !> and tau/(t - x) dt/pi.
   elemental real(wp) function surface_stress_of(material, pressure, shear, of_pressure, of_shear) result(stress)
      type(material_type), intent(in) :: material
      real(wp), intent(in) :: pressure, shear, of_pressure, of_shear

      associate (total => material%root_sum, product => material%root_product)
         stress = aimag(total)*of_shear - aimag(product)*of_pressure + real(product, wp)*pressure - real(total, wp)*shear
      end associate
   end function surface_stress_of

   !> p + i tau at the surface point `x`, 0 outside all elements.
   pure complex(wp) function traction(self, x)
      class(half_plane_load_type), intent(in) :: self
      real(wp), intent(in) :: x
      real(wp) :: place, ends(2)
      integer :: j, m

      traction = 0.0_wp
      place = place_of(self, x)
      ! (The nearest images: elements may extend beyond the period.)
      do m = -min(self%near_images, 1), min(self%near_images, 1)
         j = last_not_above(self%from, place - m*self%images%period)
         if (j == 0) cycle
         ends = ends_of(self, j, m)
         if (place > ends(2) .or. .not. ends(2) > ends(1)) cycle
         traction = self%first(j) + (self%last(j) - self%first(j))*((place - ends(1))/(ends(2) - ends(1)))
      end do
   end function traction

   !> The surface point `x` as the elements are kept: with a period, in the one around their middle; lengths.
   pure real(wp) function place_of(self, x)
      class(half_plane_load_type), intent(in) :: self
      real(wp), intent(in) :: x
      complex(wp) :: moved(1)

      place_of = x
      if (.not. self%images%period > 0.0_wp) return
      moved = self%images%move_into_period([cmplx(x - self%middle, 0.0_wp, wp)])
      place_of = real(moved(1), wp)
   end function place_of

   !> Add the integrals of p/t and tau/t over an element from `left` to `right`, and p and tau at 0 if it is there: of two elements
   !> that meet there, the larger p.
   pure subroutine add_surface_element(left, right, first, last, sums, here)
      real(wp), intent(in) :: left, right
      complex(wp), intent(in) :: first, last
      real(wp), intent(inout) :: sums(2), here(2)
      real(wp) :: middle, half, ratio, square, power, growth, tilted
      complex(wp) :: inside
      integer :: k
      !> Factors of the series of the distant elements.
      real(wp), parameter :: factor(most_terms) = [(2.0_wp/(2*k + 1), k=1, most_terms)]

      middle = 0.5_wp*(left + right)
      half = 0.5_wp*(right - left)
      if (abs(middle) > 5.0_wp*half) then
         ratio = half/middle
         square = ratio**2
         power = 1.0_wp
         tilted = 0.0_wp
         do k = 1, most_terms
            if (power <= 0.1_wp*epsilon(1.0_wp)) exit
            power = power*square
            tilted = tilted - factor(k)*power
         end do
         growth = ratio*(2.0_wp - tilted)
      else
         growth = 0.0_wp
         if (abs(left) > 0.0_wp) growth = -log(abs(left))
         if (abs(right) > 0.0_wp) growth = growth + log(abs(right))
         tilted = 2.0_wp - growth*middle/half
         if (left <= 0.0_wp .and. right >= 0.0_wp) then
            inside = first - left/(right - left)*(last - first)
            if (real(inside, wp) > here(1)) here = [real(inside, wp), aimag(inside)]
         end if
      end if
      sums = sums + 0.5_wp*([real(first + last, wp), aimag(first + last)]*growth &
                            + [real(last - first, wp), aimag(last - first)]*tilted)
   end subroutine add_surface_element

   !> Integrals over an element of 1/(t - z1) and u/(t - z1) dt, u from -1 to 1, and their divided differences between z1 and z2
   !> (zero on the surface, where they are not needed). `to_left`, `to_right`: its ends relative to both points, which are not
   !> above them.
   pure subroutine element_integrals(to_left, to_right, integral, difference)
      complex(wp), intent(in) :: to_left(2), to_right(2)
      complex(wp), intent(out) :: integral(2), difference(2)
      real(wp), parameter :: short = 0.04_wp
      real(wp) :: middle, half, from_left, from_right, below
      complex(wp) :: place(2)

      half = 0.5_wp*real(to_right(1) - to_left(1), wp)
      place = -0.5_wp*(to_left + to_right)/half
      if (short*minval(real(place, wp)**2 + aimag(place)**2) > 1.0_wp) then
         call distant_integrals(half, place, integral, difference)
         return
      end if
      from_left = real(to_left(1), wp)
      from_right = real(to_right(1), wp)
      middle = 0.5_wp*(from_left + from_right)
      below = aimag(to_left(1))
      integral(1) = cmplx(0.0_wp, -atan2(2.0_wp*half*below, below**2 + from_left*from_right), wp)
      difference = 0.0_wp
      if (min(from_left**2, from_right**2) + below**2 > (epsilon(1.0_wp)*half)**2) then
         integral(1) = integral(1) + 0.5_wp*log_ratio(from_left**2 + below**2, from_right**2 + below**2, &
                                                      2.0_wp*half*(from_left + from_right))
         if (below > 0.0_wp) difference(1) = 2.0_wp*half/(to_left(2)*to_right(1)) &
                                             *log_over(2.0_wp*half*(place(2) - place(1))*half/(to_left(2)*to_right(1)))
      else
         ! At an end on the surface the singular logarithm cancels with that of the next element.
         integral(1) = cmplx(merge(1.0_wp, -1.0_wp, middle > 0.0_wp)*log(2.0_wp*half), -0.5_wp*pi, wp)
      end if
      integral(2) = place(1)*integral(1) + 2.0_wp
      if (below > 0.0_wp) difference(2) = integral(1)/half + place(2)*difference(1)
   end subroutine element_integrals

   !> ln(1 + w)/w; 1 at 0.
   pure complex(wp) function log_over(w)
      complex(wp), intent(in) :: w

      log_over = 1.0_wp
      if (.not. abs(w) > 0.0_wp) return
      associate (x => real(w, wp), y => aimag(w))
         log_over = cmplx(0.5_wp*log_ratio(1.0_wp, (1.0_wp + x)**2 + y**2, 2.0_wp*x + x**2 + y**2), atan2(y, 1.0_wp + x), wp)/w
      end associate
   end function log_over

   !> The same as power series, for elements that are short compared with their distance. `place`: the points relative to the
   !> middle, over half the length of the element.
   pure subroutine distant_integrals(half, place, integral, difference)
      real(wp), intent(in) :: half
      complex(wp), intent(in) :: place(2)
      complex(wp), intent(out) :: integral(2), difference(2)
      complex(wp) :: ratio(2), square(2), power, change
      real(wp) :: size_of_power, least_decrease
      integer :: k

      ratio = 1.0_wp/place
      square = ratio**2
      ! The power k of the first square, and its divided difference.
      power = 1.0_wp
      change = 0.0_wp
      size_of_power = 1.0_wp
      least_decrease = maxval(abs(real(square, wp)) + abs(aimag(square)))
      integral(2) = 0.0_wp
      difference = 0.0_wp
      do k = 1, most_terms
         if (size_of_power <= 0.1_wp*epsilon(1.0_wp)) exit
         change = change*square(2) + power
         power = power*square(1)
         size_of_power = size_of_power*least_decrease
         integral(2) = integral(2) - 2.0_wp*power/(2*k + 1)
         difference(2) = difference(2) - 2.0_wp*change/(2*k + 1)
      end do
      integral(1) = ratio(1)*(integral(2) - 2.0_wp)
      ! From the squares to the ratios, and from these to the points.
      difference(2) = difference(2)*(ratio(1) + ratio(2))
      difference(1) = integral(2) - 2.0_wp + ratio(2)*difference(2)
      difference = -difference*ratio(1)*ratio(2)/half
   end subroutine distant_integrals

end module mfv_interior_half_plane
