!> Compliance of bodies whose displacements depend on the distance from the loaded interval only. On equal intervals one entry per
!> distance suffices. On unequal ones (a graded mesh) entries are mean displacements of an interval by a uniform traction on
!> another one: forces and mean displacements are conjugate, so that reciprocity holds exactly, C(i, j)/width(j) =
!> C(j, i)/width(i), which displacements at the middles of unequal intervals would violate.
!>
!> The mean is over the smaller interval, by Gauss quadrature of the displacements by the larger one. These behave as r ln(r) at
!> its ends: pieces that touch an end are integrated in t, r = L t**4; others are halved until they are as far from the ends as
!> they are long.
module mfv_kernel_compliance
   use mfv_compliance, only: compliance_type
   use mfv_kinds, only: wp
   use mfv_quadrature, only: gauss_points
   implicit none
   private
   public :: kernel_compliance_type

   type, abstract, extends(compliance_type) :: kernel_compliance_type
      !> Length after which the surface repeats; 0: it does not.
      real(wp) :: period = 0.0_wp
      !> Unequal intervals: their widths, length, shape (nodes), and the kernels, shape (nodes, nodes, kernels): mean over the
      !> first interval by a unit traction on the second. Unallocated for equal intervals.
      real(wp), allocatable :: width(:), mean(:, :, :)
   contains
      procedure(kernels_interface), deferred :: kernels_at
      procedure :: grade
   end type kernel_compliance_type

   abstract interface
      !> All kernels by a unit traction on an interval of the width `width` at a signed `distance` from its middle, lengths.
      pure subroutine kernels_interface(self, distance, width, kernels)
         import :: kernel_compliance_type, wp
         class(kernel_compliance_type), intent(in) :: self
         real(wp), intent(in) :: distance, width
         real(wp), intent(out) :: kernels(:)
      end subroutine kernels_interface
   end interface

   !> Points of the quadrature next to an end, and the most elsewhere.
   integer, parameter :: touching_points = 20, most_points = 12

   !> Points and weights on (-1, 1), by the number of points.
   type :: rule_type
      real(wp), allocatable :: point(:), weight(:)
   end type rule_type

contains

   !> Set the entries for unequal intervals between `ends`, lengths, increasing, shape (nodes + 1). `odd`: which kernels change
   !> their sign with the distance.
   subroutine grade(self, ends, odd)
      class(kernel_compliance_type), intent(inout) :: self
      real(wp), intent(in) :: ends(:)
      logical, intent(in) :: odd(:)
      type(rule_type) :: rules(touching_points)
      real(wp) :: to_nearest
      integer :: i, j, n

      n = size(ends) - 1
      do i = 1, touching_points
         allocate (rules(i)%point(i), rules(i)%weight(i))
         call gauss_points(-1.0_wp, 1.0_wp, rules(i)%point, rules(i)%weight)
      end do
      self%width = ends(2:) - ends(:n)
      if (allocated(self%mean)) deallocate (self%mean)
      allocate (self%mean(n, n, size(odd)))
      do j = 1, n
         do i = 1, j
            ! The nearest image of the second interval, next to the first one across the ends of a period.
            to_nearest = 0.0_wp
            if (self%period > 0.0_wp) &
               to_nearest = -self%period*anint((ends(j) + ends(j + 1) - ends(i) - ends(i + 1))/(2.0_wp*self%period))
            associate (forward => self%mean(i, j, :), backward => self%mean(j, i, :))
               if (self%width(i) <= self%width(j)) then
                  call find_mean(self, ends(i:i + 1), ends(j:j + 1) + to_nearest, rules, forward)
                  backward = merge(-1.0_wp, 1.0_wp, odd)*forward*(self%width(i)/self%width(j))
               else
                  call find_mean(self, ends(j:j + 1) + to_nearest, ends(i:i + 1), rules, backward)
                  forward = merge(-1.0_wp, 1.0_wp, odd)*backward*(self%width(j)/self%width(i))
               end if
               if (i == j) where (odd) forward = 0.0_wp
            end associate
         end do
      end do
   end subroutine grade

   !> Means over the interval `over` by a unit traction on the interval `loaded`, which is not shorter.
   subroutine find_mean(self, over, loaded, rules, mean)
      class(kernel_compliance_type), intent(in) :: self
      real(wp), intent(in) :: over(2), loaded(2)
      type(rule_type), intent(in) :: rules(:)
      real(wp), intent(out) :: mean(:)

      real(wp) :: length

      length = over(2) - over(1)
      ! Of the interval itself one half, by symmetry of the even kernels.
      if (over(1) >= loaded(1) .and. over(2) <= loaded(2)) length = 0.5_wp*length
      mean = 0.0_wp
      if (over(1) >= loaded(2)) then
         call add_piece(self, over(1), length, loaded, rules, mean)
      else
         call add_piece(self, over(2), -length, loaded, rules, mean)
      end if
      mean = mean/length
   end subroutine find_mean

   !> Add the integrals over the piece from `from`, its end nearest to the loaded interval, to from + length (signed).
   recursive subroutine add_piece(self, from, length, loaded, rules, total)
      class(kernel_compliance_type), intent(in) :: self
      real(wp), intent(in) :: from, length, loaded(2)
      type(rule_type), intent(in) :: rules(:)
      real(wp), intent(inout) :: total(:)
      real(wp), parameter :: touching = 1.0e-12_wp, digits = 17.0_wp
      real(wp) :: apart, ratio, t, kernels(size(total)), middle
      integer :: i, points

      middle = 0.5_wp*(loaded(1) + loaded(2))
      apart = minval(abs(from - loaded))
      if (apart <= touching*abs(length)) then
         do i = 1, touching_points
            t = 0.5_wp*(1.0_wp + rules(touching_points)%point(i))
            call self%kernels_at(from - middle + length*t**4, loaded(2) - loaded(1), kernels)
            total = total + 2.0_wp*abs(length)*t**3*rules(touching_points)%weight(i)*kernels
         end do
      else if (apart < abs(length)) then
         call add_piece(self, from, 0.5_wp*length, loaded, rules, total)
         call add_piece(self, from + 0.5_wp*length, 0.5_wp*length, loaded, rules, total)
      else
         ! The error decreases by this ratio squared with every point (Trefethen 2013, theorem 19.3).
         ratio = 1.0_wp + 2.0_wp*apart/abs(length)
         ratio = ratio + sqrt(ratio**2 - 1.0_wp)
         points = min(max(ceiling(0.5_wp*digits/log10(ratio)), 1), most_points)
         do i = 1, points
            call self%kernels_at(from - middle + 0.5_wp*length*(1.0_wp + rules(points)%point(i)), loaded(2) - loaded(1), kernels)
            total = total + 0.5_wp*abs(length)*rules(points)%weight(i)*kernels
         end do
      end if
   end subroutine add_piece

end module mfv_kernel_compliance
