!> Surface displacements of a solid disk and of a hole in an infinite plane under a box traction of the angle `dtheta` at
!> theta = 0: Michell's solution (dissertation chapter 4, appendices C to E), summed exactly or to a number of harmonics.
!>
!> For a disk under a unit radial traction sigma_rr the series is, with a = dtheta/2,
!>
!>     u_r     = R/(2 pi G) sum over n >= 2 of sin(na)/n [kappa/(n+1) + 1/(n-1)] cos(n theta) + the terms n = 0, 1
!>     u_theta = R/(2 pi G) sum over n >= 2 of sin(na)/n [kappa/(n+1) - 1/(n-1)] sin(n theta) + the term n = 1
!>
!> and for a hole kappa and 1 are exchanged and the first series changes its sign. A unit shear traction sigma_rtheta gives
!> u_theta as the first series (n >= 2) and u_r as the negative of the second (Betti). With sin(na) cos(n theta) and sin(na)
!> sin(n theta) as differences, four sums suffice (docs/theory.md), where L(x) = ln|2 sin(x/2)| and S(x) = (pi - x)/2 on (0, 2
!> pi):
!>
!>     sum sin(nx)/(n^2-1)     = sin(x) (1/4 - L)          sum sin(nx)/(n (n^2-1)) = 3/4 sin(x) - (1 - cos x) S
!>     sum cos(nx)/(n^2-1)     = 1/2 + cos(x)/4 - sin(x) S sum cos(nx)/(n (n^2-1)) = (1 - cos x) L + 3/4 cos(x) - 1/2
!>
!> The differences between x = theta + a and theta - a are evaluated analytically (product rule, addition theorems, atanh for
!> the logarithms), without cancellation for any dtheta.
!>
!> The coefficients of u_theta by a radial traction, [(kappa-1) n -+ (kappa+1)]/(n^2-1) for disk and hole, have two terms. In
!> a disk in a hole the first term is the coupling of dissimilar materials: it cancels if (kappa-1)/G is equal in both. The
!> second term adds up: inclined normals have a component in the direction of the load.
!>
!> n = 0 and n = 1 are from Tables 4.2, 4.3 and E.1 with kappa - 1 cancelled analytically, without ln(R), which is a rigid
!> translation. Misprints with an effect: Table 4.3 has B_12 of the hole with the wrong sign (sigma_rr = 0 and sigma_rtheta =
!> S_1 cos theta require -(kappa-1)R sin(a)/((kappa+1) pi)), eq. 4.14 has the wrong sign before R dtheta/(4 pi G), eq. 4.15
!> has kappa(n-1)-1+n for kappa(n+1)+n-1.
module mfv_circle_kernels
   use mfv_fourier, only: fourier_sum
   use mfv_kinds, only: pi, wp
   use mfv_logarithms, only: log_of_one_less
   implicit none
   private
   public :: circle_kernels_type, exact_kernels, exact_values, fourier_kernels, body_disk, body_hole
   public :: exact_cross_of_dissimilar, fourier_cross_of_dissimilar

   integer, parameter :: body_disk = 1, body_hole = 2

   !> Kernels times G/R, from 0 on by distance in intervals: u_r by sigma_rr (even), u_theta by sigma_rr (odd; u_r by
   !> sigma_rtheta is its negative), u_theta by sigma_rtheta (even).
   type :: circle_kernels_type
      real(wp), allocatable :: radial(:), cross(:), tangential(:)
   end type circle_kernels_type

contains

   !> The exact kernels at `nodes` distances 0, dtheta, 2 dtheta, ... (at most half the circle, or all of it if dtheta divides
   !> it). `kappa`: Kolosov's constant.
   pure type(circle_kernels_type) function exact_kernels(body, kappa, dtheta, nodes) result(kernels)
      integer, intent(in) :: body, nodes
      real(wp), intent(in) :: kappa, dtheta
      integer :: i

      allocate (kernels%radial(0:nodes - 1), kernels%cross(0:nodes - 1), kernels%tangential(0:nodes - 1))
      do i = 0, nodes - 1
         call exact_values(body, kappa, i*dtheta, dtheta, kernels%radial(i), kernels%cross(i), kernels%tangential(i))
      end do
   end function exact_kernels

   !> The exact kernels at an angle `theta` in [0, 2 pi) from the middle of the box, within the box or outside.
   pure subroutine exact_values(body, kappa, theta, dtheta, radial, cross, tangential)
      integer, intent(in) :: body
      real(wp), intent(in) :: kappa, theta, dtheta
      real(wp), intent(out) :: radial, cross, tangential
      real(wp) :: sine_first, sine_second, cosine_first, cosine_second, sign

      sign = merge(1.0_wp, -1.0_wp, body == body_disk)
      call differences(theta, 0.5_wp*dtheta, sine_first, sine_second, cosine_first, cosine_second)
      radial = (sign*(kappa + 1.0_wp)*sine_first - (kappa - 1.0_wp)*sine_second)/(4.0_wp*pi)
      cross = -((kappa - 1.0_wp)*cosine_first - sign*(kappa + 1.0_wp)*cosine_second)/(4.0_wp*pi)
      tangential = radial
      call add_lower_terms(body, kappa, theta, dtheta, radial, cross, tangential)
   end subroutine exact_values

   !> The term (kappa-1) n/(n^2-1), n >= 2, of the exact cross kernel of a disk or a hole, times G/R, at the angle `theta` >= 0.
   elemental real(wp) function exact_cross_of_dissimilar(kappa, theta, dtheta) result(cross)
      real(wp), intent(in) :: kappa, theta, dtheta
      real(wp) :: sine_first, sine_second, cosine_first, cosine_second

      call differences(theta, 0.5_wp*dtheta, sine_first, sine_second, cosine_first, cosine_second)
      cross = -(kappa - 1.0_wp)*cosine_first/(4.0_wp*pi)
   end function exact_cross_of_dissimilar

   !> The same with the series truncated after `harmonics` terms, see fourier_kernels.
   function fourier_cross_of_dissimilar(kappa, circle_nodes, harmonics, nodes) result(cross)
      integer, intent(in) :: circle_nodes, harmonics, nodes
      real(wp), intent(in) :: kappa
      real(wp) :: cross(nodes)
      complex(wp), allocatable :: folded(:)
      real(wp), allocatable :: sums(:)
      integer :: i

      folded = 0.5_wp*(folded_coefficients(body_disk, kappa, circle_nodes, harmonics) &
                       + folded_coefficients(body_hole, kappa, circle_nodes, harmonics))
      allocate (sums(0:circle_nodes - 1))
      call fourier_sum(folded, sums)
      cross = [(0.5_wp*(sums(i) - sums(modulo(-i, circle_nodes))), i=0, nodes - 1)]
   end function fourier_cross_of_dissimilar

   !> The kernels at `nodes` distances with the series truncated after `harmonics` terms, on a circle of `circle_nodes`
   !> intervals: aliased coefficients are added and summed by one transform.
   type(circle_kernels_type) function fourier_kernels(body, kappa, circle_nodes, harmonics, nodes) result(kernels)
      integer, intent(in) :: body, circle_nodes, harmonics, nodes
      real(wp), intent(in) :: kappa
      complex(wp), allocatable :: folded(:)
      real(wp), allocatable :: sums(:)
      real(wp) :: dtheta, mirrored
      integer :: i

      dtheta = 2.0_wp*pi/circle_nodes
      folded = folded_coefficients(body, kappa, circle_nodes, harmonics)
      allocate (sums(0:circle_nodes - 1))
      call fourier_sum(folded, sums)
      allocate (kernels%radial(0:nodes - 1), kernels%cross(0:nodes - 1), kernels%tangential(0:nodes - 1))
      do i = 0, nodes - 1
         mirrored = sums(modulo(-i, circle_nodes))
         kernels%radial(i) = 0.5_wp*(sums(i) + mirrored)
         kernels%cross(i) = 0.5_wp*(sums(i) - mirrored)
         kernels%tangential(i) = kernels%radial(i)
         call add_lower_terms(body, kappa, i*dtheta, dtheta, kernels%radial(i), kernels%cross(i), kernels%tangential(i))
      end do
   end function fourier_kernels

   !> Coefficients of the cosine (u_r) and sine (u_theta) series of a unit radial traction, n >= 2, in the form of
   !> mfv_fourier: aliased coefficients are added.
   pure function folded_coefficients(body, kappa, circle_nodes, harmonics) result(folded)
      integer, intent(in) :: body, circle_nodes, harmonics
      real(wp), intent(in) :: kappa
      complex(wp), allocatable :: folded(:)
      real(wp) :: amplitude, cosine, sine, n_real
      integer :: n, m, angle

      allocate (folded(0:circle_nodes/2), source=(0.0_wp, 0.0_wp))
      do n = 2, harmonics
         n_real = real(n, wp)
         angle = modulo(n, 2*circle_nodes)
         amplitude = sin(pi*angle/circle_nodes)/(2.0_wp*pi*n_real)
         if (body == body_disk) then
            cosine = amplitude*(kappa/(n_real + 1.0_wp) + 1.0_wp/(n_real - 1.0_wp))
            sine = amplitude*(kappa/(n_real + 1.0_wp) - 1.0_wp/(n_real - 1.0_wp))
         else
            cosine = -amplitude*(kappa/(n_real - 1.0_wp) + 1.0_wp/(n_real + 1.0_wp))
            sine = amplitude*(kappa/(n_real - 1.0_wp) - 1.0_wp/(n_real + 1.0_wp))
         end if
         m = modulo(n, circle_nodes)
         if (2*m > circle_nodes) then
            m = circle_nodes - m
            sine = -sine
         end if
         if (m == 0 .or. 2*m == circle_nodes) sine = 0.0_wp
         folded(m) = folded(m) + cmplx(cosine, -sine, wp)
      end do
   end function folded_coefficients

   !> Differences f(theta + a) - f(theta - a) of the four sums in the head of this file, for theta in [0, 2 pi). `a`: half the
   !> angle of the box; theta may be inside it.
   pure subroutine differences(theta, a, sine_first, sine_second, cosine_first, cosine_second)
      real(wp), intent(in) :: theta, a
      real(wp), intent(out) :: sine_first, sine_second, cosine_first, cosine_second
      real(wp) :: sin_a, cos_a, sin_t, cos_t, one_minus, log_mean, log_step, saw_mean, saw_step
      real(wp), parameter :: near = 0.25_wp

      sin_a = sin(a)
      cos_a = cos(a)
      sin_t = sin(theta)
      cos_t = cos(theta)
      ! Means and differences of 1 - cos, of L and of S between theta - a and theta + a; S jumps by pi at 0.
      one_minus = 2.0_wp*sin(0.5_wp*theta)**2 + 2.0_wp*cos_t*sin(0.5_wp*a)**2
      saw_mean = 0.5_wp*(pi - theta)
      saw_step = -a
      if (theta < a) then
         saw_mean = -0.5_wp*theta
         saw_step = pi - a
      end if
      if (abs(theta - a) < near*(theta + a)) then
         ! Both from one theta - a: their large parts cancel below.
         log_step = log(2.0_wp*sin(0.5_wp*(theta + a)))
         log_mean = log(2.0_wp*sin(0.5_wp*max(abs(theta - a), tiny(a))))
         log_step = log_step - log_mean
         log_mean = log_mean + 0.5_wp*log_step
      else if (theta < a) then
         log_mean = log(2.0_wp*sin(0.5_wp*a)) + 0.5_wp*log_of_one_less((sin(0.5_wp*theta)/sin(0.5_wp*a))**2)
         log_step = 2.0_wp*atanh(cos(0.5_wp*a)*sin(0.5_wp*theta)/(sin(0.5_wp*a)*cos(0.5_wp*theta)))
      else
         log_mean = log(2.0_wp*sin(0.5_wp*theta)) + 0.5_wp*log_of_one_less((sin(0.5_wp*a)/sin(0.5_wp*theta))**2)
         log_step = 2.0_wp*atanh(sin(0.5_wp*a)*cos(0.5_wp*theta)/(cos(0.5_wp*a)*sin(0.5_wp*theta)))
      end if
      sine_first = 2.0_wp*cos_t*sin_a*(0.25_wp - log_mean) - sin_t*cos_a*log_step
      sine_second = 1.5_wp*cos_t*sin_a - 2.0_wp*sin_t*sin_a*saw_mean - saw_step*one_minus
      cosine_first = -sin_a*(0.5_wp*sin_t + 2.0_wp*cos_t*saw_mean) - saw_step*sin_t*cos_a
      cosine_second = 2.0_wp*sin_t*sin_a*(log_mean - 0.75_wp) + one_minus*log_step
   end subroutine differences

   !> Add the terms n = 0 and n = 1, times G/R.
   pure subroutine add_lower_terms(body, kappa, theta, dtheta, radial, cross, tangential)
      integer, intent(in) :: body
      real(wp), intent(in) :: kappa, theta, dtheta
      real(wp), intent(inout) :: radial, cross, tangential
      real(wp) :: zeroth, first

      zeroth = dtheta/(4.0_wp*pi)
      first = sin(0.5_wp*dtheta)/(4.0_wp*pi)
      tangential = tangential - zeroth
      if (body == body_disk) then
         radial = radial + 0.5_wp*(kappa - 1.0_wp)*zeroth + first*kappa*(kappa - 3.0_wp)/(kappa + 1.0_wp)*cos(theta)
         cross = cross + first*(kappa**2 + kappa - 4.0_wp)/(kappa + 1.0_wp)*sin(theta)
         tangential = tangential + first*(kappa**2 + 5.0_wp*kappa + 8.0_wp)/(kappa + 1.0_wp)*cos(theta)
      else
         radial = radial - zeroth - first*cos(theta)
         cross = cross - first*sin(theta)
         tangential = tangential - first*cos(theta)
      end if
   end subroutine add_lower_terms

end module mfv_circle_kernels
