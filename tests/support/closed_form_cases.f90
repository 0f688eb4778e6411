!> Random cases with closed forms: Hertz, the flat punch and the cylinder pressed with friction (Spence, Goodman's coupling),
!> Cattaneo and Mindlin with and without a cycle; random meshes, coefficients of friction, Poisson's ratios, loads and units.
module test_closed_form_cases
   use mfv_body, only: new_body
   use mfv_geometry, only: new_disk
   use mfv_compliance, only: coupling_goodman
   use mfv_kinds, only: pi, wp
   use mfv_material, only: new_material, plane_strain
   use mfv_observables
   use mfv_reference_hertz
   use mfv_reference_mindlin
   use mfv_reference_spence
   use mfv_scene, only: scene_type
   use test_scenes
   implicit none
   private
   public :: random_case, random_numbers, kinds, kind_hertz, kind_punch, kind_cycle, kind_mindlin
   public :: place_half_width, place_stick_ratio, place_peak_pressure, place_peak_shear, place_dissipation, place_lower_tension, &
             place_upper_tension, place_cycle_dissipation, place_secant_stiffness, place_loss_factor

   !> The kind of a case is modulo(its number, kinds): one of these, or a cylinder pressed with friction.
   integer, parameter :: kinds = 6, kind_hertz = 0, kind_punch = 1, kind_cycle = 2, kind_mindlin = 3

   !> Places of some observables in the list.
   integer, parameter :: place_half_width = findloc(observables%name, 'contact_half_width', dim=1), &
                         place_stick_ratio = findloc(observables%name, 'stick_ratio', dim=1), &
                         place_peak_pressure = findloc(observables%name, 'peak_pressure', dim=1), &
                         place_peak_shear = findloc(observables%name, 'peak_shear', dim=1), &
                         place_dissipation = findloc(observables%name, 'dissipation', dim=1), &
                         place_lower_tension = findloc(observables%name, 'lower_tension', dim=1), &
                         place_upper_tension = findloc(observables%name, 'upper_tension', dim=1), &
                         place_cycle_dissipation = findloc(observables%name, 'cycle_dissipation', dim=1), &
                         place_secant_stiffness = findloc(observables%name, 'secant_stiffness', dim=1), &
                         place_loss_factor = findloc(observables%name, 'loss_factor', dim=1)

contains

   !> Case `i` of set `number`, and the exact quantities; -1: no closed form.
   subroutine random_case(number, i, scene, truth)
      integer, intent(in) :: number, i
      type(scene_type), intent(out) :: scene
      real(wp), intent(out) :: truth(observable_count)
      real(wp) :: u(8), mu, force, length, modulus, half_width, shear_force, normal_force

      u = random_numbers(100000*number + 100*i, size(u))
      mu = 0.1_wp + 0.9_wp*u(1)
      length = 10.0_wp**(6.0_wp*u(2) - 3.0_wp)
      modulus = 10.0_wp**(12.0_wp*u(3) - 6.0_wp)
      select case (modulo(i, kinds))
      case (kind_hertz)
         scene = cylinder(intervals(30, 400), 1.0_wp)
      case (kind_punch)
         scene = flat_punch(intervals(20, 200), length*radius, mu, coupling_goodman)
      case (kind_cycle)
         scene = cylinder(intervals(24, 150), 1.0_wp, mu, coupling_goodman)
      case default
         scene = cylinder(intervals(24, 250), 1.0_wp, mu, coupling_goodman)
      end select
      scene%lower%elasticity%material = new_material(modulus, 0.48_wp*u(5), plane_strain)
      scene%lower%elasticity%datum = length*radius
      normal_force = 1.0e-3_wp*modulus*length*(0.3_wp + 0.7_wp*u(6))
      shear_force = mu*normal_force*(0.05_wp + 0.9_wp*u(7))
      half_width = length*radius
      truth = -1.0_wp
      if (modulo(i, kinds) /= kind_punch) then
         scene%upper = new_body(new_disk(length*radius))
         half_width = hertz_half_width(normal_force, length*radius, scene%modulus())
         scene%mesh%half_width = half_width*(1.1_wp + 0.3_wp*u(8))
         truth(place_peak_pressure) = 2.0_wp*normal_force/(pi*half_width)
      end if
      if (modulo(i, kinds) /= kind_punch) truth(place_half_width) = half_width
      force = normal_force
      select case (modulo(i, kinds))
      case (kind_hertz)
         call press(scene, force, .false.)
      case (kind_punch)
         call press(scene, force, .true.)
         truth(place_stick_ratio) = spence_stick_ratio(mu, scene%beta())
      case (kind_cycle, kind_mindlin)
         call press(scene, force, .false.)
         call shear(scene, shear_force)
         if (modulo(i, kinds) == kind_cycle) call shear(scene, -shear_force, cycles=1)
         truth(place_stick_ratio) = mindlin_stick_ratio(shear_force, force, mu)
         truth(place_peak_shear) = mu*truth(place_peak_pressure)*sqrt(shear_force/(mu*force))
         truth(place_dissipation) = mindlin_dissipation(shear_force, force, half_width, length*radius, mu) &
                                    *merge(1.25_wp, 0.25_wp, modulo(i, kinds) == kind_cycle)
         ! The sum of both shear tractions of Mindlin behind the contact: 2 mu p0 (x - sqrt(x^2 - a^2))/a of each (Johnson 1985,
         ! section 7.1), at x = a.
         truth(place_lower_tension) = 2.0_wp*truth(place_peak_shear)
      case default
         call press(scene, force, .true.)
         truth(place_stick_ratio) = spence_stick_ratio(mu, scene%beta())
         truth(place_peak_shear) = largest_spence_shear(force, half_width, mu, scene%beta())
      end select

   contains

      !> Between `fewest` and `most`, with decreasing probability.
      integer function intervals(fewest, most)
         integer, intent(in) :: fewest, most

         intervals = nint(fewest*(real(most, wp)/fewest)**u(4))
      end function intervals
   end subroutine random_case

   real(wp) function largest_spence_shear(force, half_width, mu, beta)
      real(wp), intent(in) :: force, half_width, mu, beta
      integer, parameter :: points = 4000
      real(wp) :: x(0:points)
      integer :: i

      x = [(half_width*i/points, i=0, points)]
      largest_spence_shear = maxval(abs(spence_cylinder_shear(x, force, half_width, mu, beta)))
   end function largest_spence_shear

   !> Platform-independent numbers between 0 and 1: the minimal standard generator, started with the cube of the seed so that
   !> sequences of neighbouring seeds differ.
   pure function random_numbers(seed, n) result(numbers)
      integer, intent(in) :: seed, n
      real(wp) :: numbers(n)
      integer, parameter :: long = selected_int_kind(18)
      integer(long), parameter :: multiplier = 48271_long, modulus = 2147483647_long
      integer, parameter :: warm_up = 9
      integer(long) :: state
      integer :: i

      state = modulo(seed*modulo(int(seed, long)**2, modulus), modulus)
      do i = 1, warm_up
         state = modulo(multiplier*state, modulus)
      end do
      do i = 1, n
         state = modulo(multiplier*state, modulus)
         numbers(i) = real(state, wp)/real(modulus, wp)
      end do
   end function random_numbers

end module test_closed_form_cases
