!> Stresses inside a half-plane under box tractions, in closed form.
!>
!> A force F ds on the surface point s makes the simple radial stresses -(2/pi) (F.rho) rho rho/r^4, rho the vector from s
!> (Flamant; Johnson 1985, section 2.2). Their integrals over a box are elementary (Johnson 1985, section 2.5); differences
!> between its ends are taken so that they keep their digits far away.
module mfv_interior_half_plane
   use mfv_kinds, only: pi, wp
   use mfv_logarithms, only: log_ratio
   implicit none
   private
   public :: half_plane_stress

contains

   !> Stresses (sigma_xx, sigma_yy, sigma_xy), force/length^2, at the depth `depth` >= 0 below the surface point `x`, by
   !> the tractions `pressure` and `shear` on boxes around `position` of the half-widths `half`; shapes (boxes), lengths.
   !> At the very edge of a box on the surface sigma_xx is singular where the shear jumps: the singular part is left out.
   pure function half_plane_stress(position, half, pressure, shear, x, depth) result(stress)
      real(wp), intent(in) :: position(:), half(:), pressure(:), shear(:), x, depth
      real(wp) :: stress(3)
      integer :: j

      stress = 0.0_wp
      do j = 1, size(position)
         if (.not. (abs(pressure(j)) > 0.0_wp .or. abs(shear(j)) > 0.0_wp)) cycle
         stress = stress + box_stress(x - position(j), depth, half(j), pressure(j), shear(j))
      end do
   end function half_plane_stress

   !> The same of one box around the origin.
   pure function box_stress(x, depth, half, pressure, shear) result(stress)
      real(wp), intent(in) :: x, depth, half, pressure, shear
      real(wp) :: stress(3)
      real(wp) :: left, right, square_left, square_right, angle, logarithm, cross, squares, third, second, first, zeroth

      left = x - half
      right = x + half
      square_left = left**2 + depth**2
      square_right = right**2 + depth**2
      angle = atan2(2.0_wp*half*depth, depth**2 + left*right)
      ! Differences between the ends of ln r, xi y/r^2 and y^2/r^2, with y = -depth.
      logarithm = 0.0_wp
      cross = 0.0_wp
      squares = 0.0_wp
      if (min(square_left, square_right) > (epsilon(1.0_wp)*half)**2) then
         logarithm = 0.5_wp*log_ratio(square_left, square_right, 4.0_wp*half*x)
         cross = -2.0_wp*half*depth*(depth**2 - left*right)/(square_left*square_right)
         squares = -4.0_wp*half*x*depth**2/(square_left*square_right)
      else
         angle = 0.5_wp*pi
      end if
      ! Integrals over xi of xi^3, xi^2 y, xi y^2 and y^3, each over r^4.
      third = logarithm + 0.5_wp*squares
      second = -0.5_wp*(angle + cross)
      first = -0.5_wp*squares
      zeroth = 0.5_wp*(cross - angle)
      stress = -2.0_wp/pi*[shear*third - pressure*second, shear*first - pressure*zeroth, shear*second - pressure*first]
   end function box_stress

end module mfv_interior_half_plane
