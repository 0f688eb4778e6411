!> What layers below the first one add to the displacements by a load on the surface of a body: smooth functions of the distance.
!>
!> With Z of mfv_layers and the constants A, At, M, B of the first layer, an even function is
!>
!>     F(x) = (1/pi) integral over k > 0 of (Z - Z of an endless first layer)/k (cos kx - cos kD) dk,
!>
!> D the datum, and the odd one has sin kx. On a rigid base there is no datum: the logarithm of the first layer, with D, and F
!> vanish together far away. The integrand decays as exp(-k d), d the distance of the nearest image of the load. Its limit at k = 0
!> is taken with exp(-k d) in closed form, the rest by the sum of mfv_wave_integral. Along a second ray the values at some x tell
!> the error. Of a surface that repeats F is a sum over its modes.
!>
!> F is kept as Chebyshev series over intervals in proportion to x, halved where they do not converge.
module mfv_smooth_kernel
   use mfv_chebyshev, only: chebyshev_coefficients, chebyshev_points, piecewise_type
   use mfv_kinds, only: pi, wp
   use mfv_layers, only: layers_type
   use mfv_quadrature, only: gauss_points
   use mfv_wave_integral, only: last_exponent, new_wave_integral
   implicit none
   private
   public :: smooth_kernel_type, new_smooth_kernel, smooth_kernels, normal_kernel, tangential_kernel, mixed_kernel, odd_kernel, &
             thinnest

   !> The functions: w by pressure, u by shear, and the even and the odd part of w by shear (of u by pressure: with the sign of the
   !> odd part changed).
   integer, parameter :: normal_kernel = 1, tangential_kernel = 2, mixed_kernel = 3, odd_kernel = 4, smooth_kernels = 4

   !> Terms of a series; points of the mean over an interval of x; most halvings.
   integer, parameter :: terms = 24, mean_points = 12, most_halvings = 8
   !> The least thickness, over the distances that are asked for, and the most modes.
   real(wp), parameter :: thinnest = 1.0e-8_wp, most_modes = 1.0e6_wp

   !> The series are those of F, shape (terms, smooth_kernels, intervals).
   type, extends(piecewise_type) :: smooth_kernel_type
      !> Distance of the nearest image of the load, length, and period, 0 without.
      real(wp) :: image = 1.0_wp, period = 0.0_wp
      !> Largest error of F over its largest value, from a second integral.
      real(wp) :: error = 0.0_wp
      !> Points and weights of the mean over an interval.
      real(wp) :: place(mean_points, mean_points) = 0.0_wp, weight(mean_points, mean_points) = 0.0_wp
   contains
      procedure :: reach
      procedure :: mean
      procedure :: at
   end type smooth_kernel_type

   !> An integral over k, as a sum, for all x up to some length.
   type :: spectrum_type
      logical :: rigid_base = .false.
      real(wp) :: image = 1.0_wp, datum = 1.0_wp, period = 0.0_wp
      !> Limits of the functions at k = 0, length^2/force; of surfaces that repeat: constants, length/force.
      real(wp) :: limit(smooth_kernels) = 0.0_wp
      !> k, 1/length, and values of the functions without the limits times weights over k, shape (smooth_kernels, points).
      complex(wp), allocatable :: k(:), value(:, :)
      !> The sums at the datum, which are subtracted; 0 on a rigid base.
      real(wp) :: at_datum(smooth_kernels) = 0.0_wp
   end type spectrum_type

contains

   !> F of layers for distances up to `reach`, length. `datum`: length. `period`: of a surface that repeats, length; else 0.
   type(smooth_kernel_type) function new_smooth_kernel(layers, datum, period, reach) result(self)
      type(layers_type), intent(in) :: layers
      real(wp), intent(in) :: datum, period, reach
      type(spectrum_type) :: spectrum
      real(wp) :: farthest, largest, to
      integer :: i

      self%period = period
      do i = 1, mean_points
         call gauss_points(-1.0_wp, 1.0_wp, self%place(:i, i), self%weight(:i, i))
      end do
      farthest = merge(0.5_wp*period, reach, period > 0.0_wp)
      ! Of still thinner layers the error shows that these are not smooth over this length.
      self%image = max(layers%nearest_image(), thinnest*farthest)
      if (period > 0.0_wp) then
         spectrum = modes_of(layers, datum, period, self%image)
      else
         spectrum = spectrum_of(layers, datum, max(farthest, datum), self%image, 1.0_wp)
      end if
      largest = maxval(abs(layers%compliance((0.0_wp, 0.0_wp)))) + maxval(abs(layers%layer(1)%endless))
      allocate (self%ends(1), self%series(terms, smooth_kernels, 0))
      self%ends(1) = 0.0_wp
      to = self%image
      do while (self%ends(size(self%ends)) < farthest)
         if (period > 0.0_wp .and. 2.0_wp*to > farthest) to = farthest
         call add_interval(self, spectrum, self%ends(size(self%ends)), to, largest, most_halvings)
         to = 2.0_wp*to
      end do
      if (.not. period > 0.0_wp) then
         spectrum = spectrum_of(layers, datum, max(farthest, datum), self%image, 0.6_wp)
         self%error = max(self%error, difference(self, spectrum, largest))
      end if
      if (self%image > layers%nearest_image() .or. last_exponent/self%image*period > 2.0_wp*pi*most_modes) self%error = 1.0_wp
   end function new_smooth_kernel

   !> Distance up to which F is known, length.
   pure real(wp) function reach(self)
      class(smooth_kernel_type), intent(in) :: self

      reach = 0.0_wp
      if (.not. allocated(self%ends)) return
      reach = self%ends(size(self%ends))
      if (self%period > 0.0_wp) reach = huge(1.0_wp)
   end function reach

   !> Largest difference of F to another integral, at some x, over the largest value or `scale`.
   pure real(wp) function difference(self, spectrum, scale)
      type(smooth_kernel_type), intent(in) :: self
      type(spectrum_type), intent(in) :: spectrum
      real(wp), intent(in) :: scale
      real(wp) :: values(smooth_kernels), largest, x
      integer :: i

      difference = 0.0_wp
      largest = scale
      do i = 1, size(self%ends) - 1
         x = 0.3_wp*self%ends(i) + 0.7_wp*self%ends(i + 1)
         values = function_at(spectrum, x)
         largest = max(largest, maxval(abs(values)))
         difference = max(difference, maxval(abs(values - self%at(x))))
      end do
      difference = difference/largest
   end function difference

   !> The integral for distances up to `reach`; `part`: see mfv_wave_integral.
   type(spectrum_type) function spectrum_of(layers, datum, reach, image, part) result(self)
      type(layers_type), intent(in) :: layers
      real(wp), intent(in) :: datum, reach, image, part
      complex(wp), allocatable :: weight(:)
      integer :: j

      self%rigid_base = layers%rigid_base
      self%image = image
      self%datum = datum
      self%limit = real(functions_of(layers, (0.0_wp, 0.0_wp)), wp)
      call new_wave_integral(self%image, reach, layers%slant(), part, self%k, weight)
      allocate (self%value(smooth_kernels, size(self%k)))
      do j = 1, size(self%k)
         self%value(:, j) = (functions_of(layers, self%k(j)) - self%limit*exp(-self%k(j)*self%image))*weight(j)/(pi*self%k(j))
      end do
      if (.not. self%rigid_base) self%at_datum = sums(self, datum)
   end function spectrum_of

   !> Z less that of an endless first layer, by function.
   pure function functions_of(layers, k) result(functions)
      type(layers_type), intent(in) :: layers
      complex(wp), intent(in) :: k
      complex(wp) :: functions(smooth_kernels), z(2, 2)
      complex(wp), parameter :: i = (0.0_wp, 1.0_wp)

      z = layers%compliance(k) - layers%layer(1)%endless
      functions([normal_kernel, tangential_kernel]) = [z(2, 2), z(1, 1)]
      functions(mixed_kernel) = -0.5_wp*(z(1, 2) + z(2, 1))
      functions(odd_kernel) = -0.5_wp*(z(1, 2) - z(2, 1))/i
   end function functions_of

   !> The sum over the modes of a surface that repeats. The mean displacement by a uniform traction is that of the base, as without
   !> layers, and the compression of the layers.
   type(spectrum_type) function modes_of(layers, datum, period, image) result(self)
      type(layers_type), intent(in) :: layers
      real(wp), intent(in) :: datum, period, image
      integer :: m, modes

      modes = ceiling(min(last_exponent/image*period/(2.0_wp*pi), most_modes))
      self%period = period
      allocate (self%k(modes), self%value(smooth_kernels, modes))
      do m = 1, modes
         self%k(m) = 2.0_wp*pi*m/period
         self%value(:, m) = 2.0_wp/period*functions_of(layers, self%k(m))/self%k(m)
      end do
      self%limit = real(functions_of(layers, (0.0_wp, 0.0_wp)), wp)*(log(2.0_wp*pi*datum/period)/pi)
      self%limit([normal_kernel, tangential_kernel, mixed_kernel]) = &
         self%limit([normal_kernel, tangential_kernel, mixed_kernel]) &
         + [layers%uniform(2, 2), layers%uniform(1, 1), -layers%uniform(1, 2)]/period
      self%limit(odd_kernel) = 0.0_wp
   end function modes_of

   !> F at the distance x >= 0.
   pure function function_at(self, x) result(values)
      type(spectrum_type), intent(in) :: self
      real(wp), intent(in) :: x
      real(wp) :: values(smooth_kernels)

      values = sums(self, x)
      if (self%period > 0.0_wp) then
         values = values + self%limit
         return
      end if
      associate (c => self%image, d => merge(self%datum, hypot(self%datum, self%image), self%rigid_base))
         values(:odd_kernel - 1) = values(:odd_kernel - 1) - self%at_datum(:odd_kernel - 1) &
                                   - self%limit(:odd_kernel - 1)/pi*log(hypot(x, c)/d)
         values(odd_kernel) = values(odd_kernel) + self%limit(odd_kernel)/pi*atan(x/c)
      end associate
   end function function_at

   !> The sums over k.
   pure function sums(self, x)
      type(spectrum_type), intent(in) :: self
      real(wp), intent(in) :: x
      real(wp) :: sums(smooth_kernels)
      complex(wp) :: wave
      integer :: j

      sums = 0.0_wp
      do j = 1, size(self%k)
         if (aimag(self%k(j))*x > last_exponent) cycle
         wave = exp(cmplx(-aimag(self%k(j))*x, real(self%k(j), wp)*x, wp))
         sums(:odd_kernel - 1) = sums(:odd_kernel - 1) + real(self%value(:odd_kernel - 1, j)*wave, wp)
         sums(odd_kernel) = sums(odd_kernel) + aimag(self%value(odd_kernel, j)*wave)
      end do
   end function sums

   !> Append the series of an interval, halved where it does not converge.
   recursive subroutine add_interval(self, spectrum, from, to, largest, halvings)
      type(smooth_kernel_type), intent(inout) :: self
      type(spectrum_type), intent(in) :: spectrum
      real(wp), intent(in) :: from, to, largest
      integer, intent(in) :: halvings
      real(wp), parameter :: tolerance = 16.0_wp*epsilon(1.0_wp)
      real(wp) :: x(terms), values(smooth_kernels, terms), coefficients(terms, smooth_kernels), tail
      integer :: j

      x = chebyshev_points(terms, from, to)
      do j = 1, terms
         values(:, j) = function_at(spectrum, x(j))
      end do
      coefficients = chebyshev_coefficients(transpose(values))
      tail = maxval(abs(coefficients(terms - 1:, :)))/max(largest, maxval(abs(coefficients)))
      if (halvings > 0 .and. tail > tolerance) then
         call add_interval(self, spectrum, from, 0.5_wp*(from + to), largest, halvings - 1)
         call add_interval(self, spectrum, 0.5_wp*(from + to), to, largest, halvings - 1)
         return
      end if
      self%error = max(self%error, tail)
      call self%append(to, coefficients)
   end subroutine add_interval

   !> F at a signed distance, length^2/force.
   pure function at(self, x) result(values)
      class(smooth_kernel_type), intent(in) :: self
      real(wp), intent(in) :: x
      real(wp) :: values(smooth_kernels), place

      place = x
      if (self%period > 0.0_wp) place = x - self%period*anint(x/self%period)
      values = self%values_at(abs(place), 1, smooth_kernels)
      values(odd_kernel) = sign(1.0_wp, place)*values(odd_kernel)
   end function at

   !> Integral of F over the interval of the width `width` around a signed `distance`, lengths; length^3/force.
   pure function mean(self, distance, width) result(total)
      class(smooth_kernel_type), intent(in) :: self
      real(wp), intent(in) :: distance, width
      real(wp) :: total(smooth_kernels)

      total = 0.0_wp
      call add_part(self, distance, width, total)
   end function mean

   !> Add the integral over an interval, halved until it is not longer than F is smooth there.
   recursive pure subroutine add_part(self, distance, width, total)
      class(smooth_kernel_type), intent(in) :: self
      real(wp), intent(in) :: distance, width
      real(wp), intent(inout) :: total(:)
      real(wp), parameter :: digits = 17.0_wp
      real(wp) :: apart, stretch, x
      integer :: i, n

      x = distance
      if (self%period > 0.0_wp) x = x - self%period*anint(x/self%period)
      apart = max(self%image, abs(x) - 0.5_wp*width)
      if (width > apart) then
         call add_part(self, x - 0.25_wp*width, 0.5_wp*width, total)
         call add_part(self, x + 0.25_wp*width, 0.5_wp*width, total)
         return
      end if
      ! The error decreases by this ratio squared with every point (Trefethen 2013, theorem 19.3).
      stretch = 1.0_wp + 2.0_wp*apart/width
      stretch = stretch + sqrt(stretch**2 - 1.0_wp)
      n = min(max(ceiling(0.5_wp*digits/log10(stretch)), 1), mean_points)
      do i = 1, n
         total = total + 0.5_wp*width*self%weight(i, n)*self%at(x + 0.5_wp*width*self%place(i, n))
      end do
   end subroutine add_part

end module mfv_smooth_kernel
