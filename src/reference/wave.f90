!> Closed forms: a wave D (1 - cos(2 pi x/l)) pressed on a half-plane that repeats with it (Westergaard 1939; Johnson 1985, section
!> 13.2), then sheared (docs/theory.md). Forces are those of one period.
module mfv_reference_wave
   use mfv_kinds, only: pi, wp
   implicit none
   private
   public :: wave_type, new_wave_contact

   !> A wave of the length l and the amplitude D (lengths) on bodies of the modulus m = 1/A (force/length^2).
   type :: wave_type
      real(wp) :: length = 1.0_wp
      !> Force at which everything touches, force/length.
      real(wp) :: full_force = 0.0_wp
   contains
      procedure :: half_width
      procedure :: pressure
      procedure :: stick_ratio
   end type wave_type

contains

   !> See wave_type.
   pure type(wave_type) function new_wave_contact(amplitude, length, modulus) result(wave)
      real(wp), intent(in) :: amplitude, length, modulus

      wave%length = length
      wave%full_force = 2.0_wp*pi*modulus*amplitude
   end function new_wave_contact

   !> Half-width of the contact, length, under a normal force, force/length: P = P* sin^2(pi a/l); half the wave in full contact.
   elemental real(wp) function half_width(self, normal_force)
      class(wave_type), intent(in) :: self
      real(wp), intent(in) :: normal_force

      half_width = self%length/pi*asin(sqrt(min(max(normal_force/self%full_force, 0.0_wp), 1.0_wp)))
   end function half_width

   !> Pressure at x (length), force/length^2: 2 p* cos(pi x/l) sqrt(sin^2(pi a/l) - sin^2(pi x/l)), in full contact the mean and
   !> p* cos(2 pi x/l), p* = P*/l.
   elemental real(wp) function pressure(self, x, normal_force)
      class(wave_type), intent(in) :: self
      real(wp), intent(in) :: x, normal_force
      real(wp) :: share

      share = max(normal_force/self%full_force, 0.0_wp)
      if (share >= 1.0_wp) then
         pressure = self%full_force/self%length*(share + cos(2.0_wp*pi*x/self%length))
      else
         pressure = 2.0_wp*self%full_force/self%length*abs(cos(pi*x/self%length)) &
                    *sqrt(max(share - sin(pi*x/self%length)**2, 0.0_wp))
      end if
   end function pressure

   !> Width of the stick zone over that of the contact, pressed without shear to less than full contact, then sheared by a growing
   !> force: the stick zone is the contact under P - |Q|/mu (Jaeger 1998, Ciavarella 1998).
   elemental real(wp) function stick_ratio(self, tangential_force, normal_force, friction_coefficient) result(ratio)
      class(wave_type), intent(in) :: self
      real(wp), intent(in) :: tangential_force, normal_force, friction_coefficient

      ratio = self%half_width(normal_force - abs(tangential_force)/friction_coefficient)/self%half_width(normal_force)
   end function stick_ratio

end module mfv_reference_wave
