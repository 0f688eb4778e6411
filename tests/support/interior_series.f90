!> Stresses on a ring inside a disk or around a hole from Michell's series, summed by FFTW as in the dissertation (section
!> 5.1.4, C.2.1, D.2.1). One transform for each of the three stresses gives a whole ring; the number of terms grows as 1/|ln
!> r|, so that the closed form of mfv_interior_circle is better close to the surface.
module mfv_interior_series
   use mfv_fourier, only: fourier_sum
   use mfv_kinds, only: pi, wp
   implicit none
   private
   public :: traction_series_type, new_traction_series

   !> Fourier coefficients of sigma_rr + i sigma_rtheta on the circle, as of exp(i n theta), n from -terms to terms.
   type :: traction_series_type
      private
      logical :: disk = .true.
      real(wp) :: kappa = 1.0_wp
      integer :: terms = 0
      complex(wp), allocatable :: coefficient(:)
   contains
      procedure :: ring_stress
   end type traction_series_type

contains

   !> Series of the tractions `radial` and `shear` (force/length^2) on boxes around `theta` of the half-widths `half`,
   !> radians, shapes (boxes), truncated after `terms` harmonics. `disk`, `kappa`: as for mfv_interior_circle.
   pure function new_traction_series(disk, kappa, theta, half, radial, shear, terms) result(self)
      logical, intent(in) :: disk
      real(wp), intent(in) :: kappa, theta(:), half(:), radial(:), shear(:)
      integer, intent(in) :: terms
      type(traction_series_type) :: self
      complex(wp) :: turn, first_turn
      integer :: j, n

      self%disk = disk
      self%kappa = kappa
      self%terms = terms
      allocate (self%coefficient(-terms:terms), source=(0.0_wp, 0.0_wp))
      do j = 1, size(theta)
         if (.not. (abs(radial(j)) > 0.0_wp .or. abs(shear(j)) > 0.0_wp)) cycle
         first_turn = exp(cmplx(0.0_wp, -theta(j), wp))
         turn = 1.0_wp
         associate (traction => cmplx(radial(j), shear(j), wp)/pi)
            self%coefficient(0) = self%coefficient(0) + traction*half(j)
            do n = 1, terms
               turn = turn*first_turn
               self%coefficient(n) = self%coefficient(n) + traction*turn*sin(n*half(j))/n
               self%coefficient(-n) = self%coefficient(-n) + traction*conjg(turn)*sin(n*half(j))/n
            end do
         end associate
      end do
   end function new_traction_series

   !> Polar stresses sigma_rr, sigma_thetatheta, sigma_rtheta, each of shape (points), at the radius `r` (in units of R: below
   !> 1 in a disk, above 1 around a hole) and the angles 0, 2 pi/points, ... Terms beyond half the number of points are
   !> omitted.
   subroutine ring_stress(self, r, radial, around, shear)
      class(traction_series_type), intent(in) :: self
      real(wp), intent(in) :: r
      real(wp), intent(out) :: radial(:), around(:), shear(:)
      complex(wp), allocatable :: sum_half(:), difference(:), shear_part(:)
      complex(wp) :: mean, deviator
      real(wp) :: total(size(radial))
      integer :: n

      allocate (sum_half(0:size(radial)/2), difference(0:size(radial)/2), shear_part(0:size(radial)/2))
      sum_half = 0.0_wp
      difference = 0.0_wp
      shear_part = 0.0_wp
      do n = 0, self%terms
         call harmonic(self, n, r, mean, deviator)
         call fold(sum_half, merge(n, -n, self%disk), 2.0_wp*mean)
         call fold(difference, merge(n, -n, self%disk), deviator)
         call fold(shear_part, merge(n, -n, self%disk), -(0.0_wp, 1.0_wp)*deviator)
      end do
      call add_force_terms(self, r, sum_half, difference, shear_part)
      call fourier_sum(sum_half, total)
      call fourier_sum(difference, around)
      call fourier_sum(shear_part, shear)
      radial = total - around
      around = total + around
   end subroutine ring_stress

   !> Coefficients of exp(i n theta) (a hole: exp(-i n theta)) in Phi and in z Phi' + z^2 Psi/r^2 of mfv_interior_circle,
   !> without the singular force terms.
   pure subroutine harmonic(self, n, r, mean, deviator)
      type(traction_series_type), intent(in) :: self
      integer, intent(in) :: n
      real(wp), intent(in) :: r
      complex(wp), intent(out) :: mean, deviator
      complex(wp) :: plus, minus

      if (self%disk) then
         plus = self%coefficient(n)
         minus = conjg(self%coefficient(-n))
         if (n == 0) then
            mean = 0.5_wp*real(plus, wp)
            deviator = (0.0_wp, 1.0_wp)*aimag(plus)/r**2
         else
            if (n == 1) call take_force_off(self, plus, minus)
            mean = plus*r**n
            deviator = (n*(1.0_wp - r**(-2))*plus + (plus - minus)*r**(-2))*r**n
         end if
      else
         mean = 0.0_wp
         deviator = -conjg(self%coefficient(0))*r**(-2)
         if (n == 0) return
         plus = self%coefficient(-n)
         minus = -conjg(self%coefficient(n))
         mean = plus*r**(-n)
         deviator = (-n*(1.0_wp - r**(-2))*plus + (plus + minus)*r**(-2))*r**(-n)
      end if
   end subroutine harmonic

   !> A disk's first harmonics without the effect of the force at its centre on the surface.
   pure subroutine take_force_off(self, plus, minus)
      type(traction_series_type), intent(in) :: self
      complex(wp), intent(inout) :: plus, minus
      complex(wp) :: force

      force = -2.0_wp*pi*self%coefficient(-1)
      plus = plus + conjg(force)/(pi*(1.0_wp + self%kappa))
      minus = minus + conjg(force)/(2.0_wp*pi)
   end subroutine take_force_off

   !> Terms of the resultant force: concentrated at a disk's centre; at infinity for a hole.
   pure subroutine add_force_terms(self, r, sum_half, difference, shear_part)
      type(traction_series_type), intent(in) :: self
      real(wp), intent(in) :: r
      complex(wp), intent(inout) :: sum_half(0:), difference(0:), shear_part(0:)
      complex(wp), parameter :: i = (0.0_wp, 1.0_wp)
      complex(wp) :: force, backward, forward
      real(wp) :: kelvin

      kelvin = 1.0_wp/(2.0_wp*pi*(1.0_wp + self%kappa))
      force = -2.0_wp*pi*self%coefficient(-1)
      if (self%disk) then
         ! Phi = -kelvin F/z; z Phi' + z^2 Psi/r^2 = kelvin F/z + kappa kelvin F* z/r^2.
         call fold(sum_half, -1, -2.0_wp*kelvin*force/r)
         backward = kelvin*force/r
         forward = self%kappa*kelvin*conjg(force)/r
      else
         ! Phi = kappa kelvin F/z, and in z^2 Psi twice that (once as Phi, once as -z Phi') and kappa kelvin F* z.
         call fold(sum_half, -1, 2.0_wp*self%kappa*kelvin*force/r)
         backward = self%kappa*kelvin*force/r*(-1.0_wp + 2.0_wp/r**2)
         forward = self%kappa*kelvin*conjg(force)/r
      end if
      call fold(difference, -1, backward)
      call fold(shear_part, -1, -i*backward)
      call fold(difference, 1, forward)
      call fold(shear_part, 1, -i*forward)
   end subroutine add_force_terms

   !> Add Re(value exp(i n theta)) to the coefficients of a sum over 2 (size - 1) or 2 size - 1 points, in the form of
   !> mfv_fourier.
   pure subroutine fold(coefficients, n, value)
      complex(wp), intent(inout) :: coefficients(0:)
      integer, intent(in) :: n
      complex(wp), intent(in) :: value

      if (abs(n) > ubound(coefficients, 1)) return
      if (n >= 0) then
         coefficients(n) = coefficients(n) + value
      else
         coefficients(-n) = coefficients(-n) + conjg(value)
      end if
   end subroutine fold

end module mfv_interior_series
