!> Closed form: a rigid flat punch pressed on an elastic half-plane without friction (Johnson 1985, section 2.8;
!> dissertation eq. 3.3).
module mfv_reference_flat_punch
   use mfv_kinds, only: pi, wp
   implicit none
   private
   public :: flat_punch_pressure

contains

   !> Pressure P/(pi sqrt(a^2 - x^2)) at x (length) under a punch of half-width a (length), force/length^2; zero outside; huge
   !> at the edges, where it is infinite.
   elemental real(wp) function flat_punch_pressure(x, normal_force, half_width) result(pressure)
      real(wp), intent(in) :: x, normal_force, half_width
      real(wp) :: inside

      pressure = 0.0_wp
      inside = (half_width - x)*(half_width + x)
      if (inside > 0.0_wp) pressure = normal_force/(pi*sqrt(inside))
   end function flat_punch_pressure

end module mfv_reference_flat_punch
