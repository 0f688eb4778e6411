!> Stresses inside a solid disk, or around a hole in an infinite plane, under box tractions on the circle, in closed form.
!>
!> Kolosov's potentials on the unit circle (Muskhelishvili 1953, chapters 14 and 15): with the Cauchy integrals
!>
!>     I+(z) = 1/(2 pi i) int (sigma_rr + i sigma_rtheta)/(s - z) ds,   I-(z) the same with - i,
!>
!> which over a box are logarithms, disk and hole have
!>
!>     disk: Phi = J+ - i M/(2 pi) - N/2 - F/(2 pi (1+kappa) z),  z^2 Psi = J+ - J- - i M/(2 pi) - z J+' + kappa F* z/(2 pi (1+kappa))
!>           J+ = I+ + F* z/(pi (1+kappa)),  J- = I- + F* z/(2 pi)
!>     hole: Phi = -I+ + kappa F/(2 pi (1+kappa) z),  z^2 Psi = I- + Phi - z Phi' + kappa F* z/(2 pi (1+kappa)) - N + i T
!>
!> with F the force that the disk's centre, or the tractions in the hole, exert on the body, M the integral and N, T the
!> means of sigma_rr and sigma_rtheta: the singular terms of dissertation eq. 4.9, and of 4.13, in one piece. Sums of the
!> series of C.2.1 and D.2.1, whose n = 0 terms are misprinted (docs/theory.md).
!>
!> Points are given from the pole z = 1, not from the centre, so that nothing cancels close to the contact; Phi' comes
!> only times |z|^2 - 1, which vanishes on the surface.
module mfv_interior_circle
   use mfv_kinds, only: pi, wp
   use mfv_logarithms, only: log_ratio
   implicit none
   private
   public :: circle_stress

contains

   !> Stresses (sigma_XX, sigma_YY, sigma_XY), force/length^2, at the point with the coordinates `from_pole` = (X, Y),
   !> measured from the pole in radii, X outwards from the centre through the pole.
   !> `disk`: disk or hole. `kappa`: Kolosov's constant. `theta`, `half`: centres and half-widths of the boxes, radians;
   !> `radial`, `shear`: sigma_rr and sigma_rtheta on them; shapes (boxes). The point must be on or inside the disk, on or
   !> outside the hole; in the centre of a disk stresses are singular.
   pure function circle_stress(disk, kappa, theta, half, radial, shear, from_pole) result(stress)
      logical, intent(in) :: disk
      real(wp), intent(in) :: kappa, theta(:), half(:), radial(:), shear(:), from_pole(2)
      real(wp) :: stress(3)
      complex(wp), parameter :: i = (0.0_wp, 1.0_wp)
      complex(wp) :: zeta, z, plus, minus, slope, force, logarithm, step, inverse, traction
      complex(wp) :: potential, potential_slope, rest
      real(wp) :: beyond, mean_radial, mean_shear, kelvin
      integer :: j

      zeta = cmplx(from_pole(1), from_pole(2), wp)
      z = 1.0_wp + zeta
      beyond = 2.0_wp*real(zeta, wp) + abs(zeta)**2
      plus = 0.0_wp
      minus = 0.0_wp
      slope = 0.0_wp
      force = 0.0_wp
      mean_radial = 0.0_wp
      mean_shear = 0.0_wp
      do j = 1, size(theta)
         if (.not. (abs(radial(j)) > 0.0_wp .or. abs(shear(j)) > 0.0_wp)) cycle
         traction = cmplx(radial(j), shear(j), wp)
         call box_integrals(disk, theta(j), half(j), zeta, logarithm, inverse, step)
         plus = plus + traction*logarithm
         minus = minus + conjg(traction)*logarithm
         slope = slope + traction*inverse
         force = force + i*traction*step
         mean_radial = mean_radial + radial(j)*half(j)/pi
         mean_shear = mean_shear + shear(j)*half(j)/pi
      end do
      plus = plus/(2.0_wp*pi*i)
      minus = minus/(2.0_wp*pi*i)
      slope = slope/(2.0_wp*pi*i)
      kelvin = 1.0_wp/(2.0_wp*pi*(1.0_wp + kappa))
      if (disk) then
         plus = plus + 2.0_wp*kelvin*conjg(force)*z
         slope = slope + 2.0_wp*kelvin*conjg(force)
         minus = minus + conjg(force)*z/(2.0_wp*pi)
         potential = plus - i*mean_shear - 0.5_wp*mean_radial - kelvin*force/z
         rest = beyond/z*slope + (plus - minus - i*mean_shear)/z**2 &
                + conjg(z)*kelvin*force/z**2 + kappa*kelvin*conjg(force)/z
      else
         potential = -plus + kappa*kelvin*force/z
         potential_slope = -slope - kappa*kelvin*force/z**2
         rest = beyond/z*potential_slope &
                + (minus + potential + kappa*kelvin*conjg(force)*z - cmplx(mean_radial, -mean_shear, wp))/z**2
      end if
      stress(1) = 2.0_wp*real(potential, wp) - real(rest, wp)
      stress(2) = 2.0_wp*real(potential, wp) + real(rest, wp)
      stress(3) = aimag(rest)
   end function circle_stress

   !> Of one box, with d = s - z from its first to its last point: the change of ln d (continuous on the body's side), the
   !> integral of ds/d^2, and the change of s.
   pure subroutine box_integrals(disk, theta, half, zeta, logarithm, inverse, step)
      logical, intent(in) :: disk
      real(wp), intent(in) :: theta, half
      complex(wp), intent(in) :: zeta
      complex(wp), intent(out) :: logarithm, inverse, step
      complex(wp) :: first, last
      real(wp) :: growth, turn

      first = from_pole_to(theta - half) - zeta
      last = from_pole_to(theta + half) - zeta
      step = 2.0_wp*sin(half)*cmplx(-sin(theta), cos(theta), wp)
      turn = atan2(aimag(conjg(first)*step), real(conjg(first)*last, wp))
      if (disk .and. turn < -0.5_wp*pi) turn = turn + 2.0_wp*pi
      growth = 0.0_wp
      inverse = 0.0_wp
      ! At the very edge of a box on the surface the logarithm is singular where the traction jumps: that part is left out.
      if (min(abs(first), abs(last)) > epsilon(1.0_wp)*abs(step)) then
         growth = 0.5_wp*log_ratio(abs(first)**2, abs(last)**2, real(step*conjg(first + last), wp))
         inverse = step/(first*last)
      else
         turn = merge(0.5_wp*pi + half, half - 0.5_wp*pi, disk)
      end if
      logarithm = cmplx(growth, turn, wp)
   end subroutine box_integrals

   !> exp(i theta) - 1.
   pure complex(wp) function from_pole_to(theta)
      real(wp), intent(in) :: theta

      from_pole_to = 2.0_wp*sin(0.5_wp*theta)*cmplx(-sin(0.5_wp*theta), cos(0.5_wp*theta), wp)
   end function from_pole_to

end module mfv_interior_circle
