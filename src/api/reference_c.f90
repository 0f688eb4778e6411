!> The closed forms of src/reference by name, for mfv_reference of include/mfv.h.
module mfv_reference_c
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite, ieee_quiet_nan, ieee_value
   use mfv_kinds, only: wp
   use mfv_material, only: material_type, new_anisotropic_material, new_material, plane_strain
   use mfv_near_field, only: near_field_of, near_field_type
   use mfv_reference_carter, only: carter_creepage, carter_shear
   use mfv_reference_flat_punch, only: flat_punch_pressure
   use mfv_reference_hertz, only: hertz_half_width, hertz_pressure
   use mfv_reference_indenter, only: indenter_type, power_indenter, rounded_punch_indenter
   use mfv_reference_mindlin
   use mfv_reference_oblique, only: oblique_half_width, oblique_stick_ratio
   use mfv_reference_persson, only: persson_force
   use mfv_reference_spence, only: spence_cylinder_shear, spence_flat_punch_shear, spence_stick_ratio
   use mfv_reference_wave, only: new_wave_contact, wave_type
   use mfv_reference_yield, only: contact_arc_at_yield
   implicit none
   private
   public :: evaluate_closed_form

contains

   !> The closed form `name` of the arguments `a`, in the order of the header; NaN outside its domain. `is_known`: whether there
   !> is one of that name with this number of arguments.
   subroutine evaluate_closed_form(name, a, value, is_known)
      character(*), intent(in) :: name
      real(wp), intent(in) :: a(:)
      real(wp), intent(out) :: value
      logical, intent(out) :: is_known
      real(wp) :: values(1)
      type(wave_type) :: wave

      value = ieee_value(1.0_wp, ieee_quiet_nan)
      is_known = .true.
      select case (name)
      case ('hertz_half_width')
         if (fits('0++k')) value = hertz_half_width(a(1), a(2), 4.0_wp*a(3)/(a(4) + 1.0_wp))
      case ('hertz_pressure')
         if (fits('xx+')) value = hertz_pressure(a(1), a(2), a(3))
      case ('flat_punch_pressure')
         if (fits('xx+')) value = flat_punch_pressure(a(1), a(2), a(3))
      case ('spence_stick_ratio')
         if (fits('0b')) value = spence_stick_ratio(a(1), a(2))
      case ('spence_cylinder_shear')
         if (fits('xx+0b')) then
            values = spence_cylinder_shear(a(1:1), a(2), a(3), a(4), a(5))
            value = values(1)
         end if
      case ('spence_flat_punch_shear')
         if (fits('xx+0b')) then
            values = spence_flat_punch_shear(a(1:1), a(2), a(3), a(4), a(5))
            value = values(1)
         end if
      case ('mindlin_stick_ratio')
         if (fits('x++')) value = mindlin_stick_ratio(a(1), a(2), a(3))
      case ('mindlin_shear')
         if (fits('xx+++')) value = shear_at(a(1), a(2), new_mindlin_history(a(3), a(4), a(4), a(4), a(5)))
      case ('mindlin_dissipation')
         if (fits('x++++')) value = mindlin_dissipation(a(1), a(2), a(3), a(4), a(5))
      case ('carter_creepage')
         if (fits('x++++')) then
            if (abs(a(1)) <= a(5)*a(2)) value = carter_creepage(a(1), a(2), a(3), a(4), a(5))
         end if
      case ('carter_shear')
         if (fits('xx+++')) then
            if (abs(a(2)) <= a(5)*a(3)) value = carter_shear(a(1), a(2), a(3), a(4), a(5))
         end if
      case ('power_half_width')
         if (fits('0+e+k')) value = half_width_of(power_indenter(a(2), a(3)), a(1), a(4), a(5))
      case ('power_approach')
         if (fits('++e+')) value = approach_of(power_indenter(a(2), a(3)), a(1), a(4))
      case ('power_pressure')
         if (fits('xx+e')) value = pressure_of(power_indenter(1.0_wp, a(4)), a(1), a(2), a(3))
      case ('power_stick_ratio')
         if (fits('x++e')) value = stick_ratio_of(power_indenter(1.0_wp, a(4)), a(1), a(2), a(3))
      case ('power_shear')
         if (fits('xx+++e')) value = shear_of(power_indenter(1.0_wp, a(6)), a(1), a(2), a(3), a(4), a(5))
      case ('rounded_punch_half_width')
         if (fits('00++k')) value = half_width_of(rounded_punch_indenter(a(2), a(3)), a(1), a(4), a(5))
      case ('rounded_punch_approach')
         if (fits('+0++')) then
            if (a(1) > a(2)) value = approach_of(rounded_punch_indenter(a(2), a(3)), a(1), a(4))
         end if
      case ('rounded_punch_pressure')
         if (fits('xx+0')) then
            if (a(3) > a(4)) value = pressure_of(rounded_punch_indenter(a(4)/a(3), 1.0_wp), a(1), a(2), a(3))
         end if
      case ('rounded_punch_stick_ratio')
         if (fits('x+++0')) then
            if (a(4) > a(5)) value = stick_ratio_of(rounded_punch_indenter(a(5)/a(4), 1.0_wp), a(1), a(2), a(3))
         end if
      case ('rounded_punch_shear')
         if (fits('xx+++0')) then
            if (a(4) > a(6)) value = shear_of(rounded_punch_indenter(a(6)/a(4), 1.0_wp), a(1), a(2), a(3), a(4), a(5))
         end if
      case ('surface_compliance')
         if (fits('+x+xx+x')) value = surface_compliance(a(:6), nint(min(max(a(7), 0.0_wp), 5.0_wp)))
      case ('oblique_half_width')
         if (fits('0x++x')) value = oblique_half_width(a(1), a(2), a(3), a(4), a(5))
      case ('oblique_stick_ratio')
         if (fits('x++x')) then
            if (a(2) + a(4)*a(1) > 0) value = oblique_stick_ratio(a(1), a(2), a(3), a(4))
         end if
      case ('wave_half_width')
         if (fits('0+++k')) then
            wave = new_wave_contact(a(2), a(3), 4.0_wp*a(4)/(a(5) + 1.0_wp))
            value = wave%half_width(a(1))
         end if
      case ('wave_pressure')
         if (fits('x0+++k')) then
            wave = new_wave_contact(a(3), a(4), 4.0_wp*a(5)/(a(6) + 1.0_wp))
            value = wave%pressure(a(1), a(2))
         end if
      case ('wave_stick_ratio')
         if (fits('x+++++k')) then
            wave = new_wave_contact(a(4), a(5), 4.0_wp*a(6)/(a(7) + 1.0_wp))
            if (a(2) < wave%full_force) value = wave%stick_ratio(a(1), a(2), a(3))
         end if
      case ('persson_force')
         if (fits('+++n')) then
            value = persson_force(a(1), a(2), a(3)/(1.0_wp - a(4)**2))
            if (.not. value < huge(value)) value = ieee_value(1.0_wp, ieee_quiet_nan)
         end if
      case ('yield_contact_arc')
         if (fits('+n0')) then
            if (a(2) <= 0.5_wp) &
               value = contact_arc_at_yield(new_material(a(1)/(2.0_wp*(1.0_wp + a(2))), a(2), plane_strain), plane_strain, a(3))
         end if
      case default
         is_known = .false.
      end select

   contains

      !> Whether the number of arguments is that of `domains`, and every argument is in its domain.
      logical function fits(domains)
         character(*), intent(in) :: domains
         integer :: i

         is_known = len(domains) == size(a)
         fits = is_known
         do i = 1, merge(size(a), 0, is_known)
            fits = fits .and. is_in(domains(i:i), a(i))
         end do
      end function fits

   end subroutine evaluate_closed_form

   !> A, At, M or B, by its number, of a half-plane of the compliances s11, s12, s22, s16, s26, s66; NaN for another number or a
   !> material that is not stable.
   pure real(wp) function surface_compliance(compliances, number) result(value)
      real(wp), intent(in) :: compliances(6)
      integer, intent(in) :: number
      type(material_type) :: material
      type(near_field_type) :: constants
      real(wp) :: all_of_them(4)
      logical :: valid

      value = ieee_value(1.0_wp, ieee_quiet_nan)
      call new_anisotropic_material(compliances, 0.0_wp, material, valid)
      if (.not. valid .or. number < 1 .or. number > size(all_of_them)) return
      constants = near_field_of(material)
      all_of_them = [constants%normal, constants%tangential, constants%mixed, constants%coupling]
      value = all_of_them(number)
   end function surface_compliance

   !> Whether a number is finite (x), positive (+), not negative (0), Kolosov's constant (k), Dundurs' beta (b), Poisson's ratio (n)
   !> or the exponent of an indenter (e). A comparison with NaN may trap.
   pure logical function is_in(domain, number)
      character(1), intent(in) :: domain
      real(wp), intent(in) :: number

      is_in = ieee_is_finite(number)
      if (.not. is_in) return
      select case (domain)
      case ('+')
         is_in = number > 0
      case ('0')
         is_in = number >= 0
      case ('k')
         is_in = number + 1.0_wp > 0
      case ('b')
         is_in = abs(number) <= 1
      case ('n')
         is_in = abs(number) < 1
      case ('e')
         is_in = number >= 1 .and. number <= 100
      end select
   end function is_in

   pure real(wp) function half_width_of(indenter, normal_force, shear_modulus, kolosov) result(a)
      type(indenter_type), intent(in) :: indenter
      real(wp), intent(in) :: normal_force, shear_modulus, kolosov

      a = indenter%half_width(normal_force*(kolosov + 1.0_wp)/(8.0_wp*shear_modulus))
   end function half_width_of

   pure real(wp) function approach_of(indenter, half_width, datum) result(approach)
      type(indenter_type), intent(in) :: indenter
      real(wp), intent(in) :: half_width, datum

      approach = indenter%approach(half_width, datum)
   end function approach_of

   !> The pressure of an indenter that is scaled to a contact half-width of 1.
   real(wp) function pressure_of(indenter, x, normal_force, half_width) result(pressure)
      type(indenter_type), intent(in) :: indenter
      real(wp), intent(in) :: x, normal_force, half_width
      real(wp) :: values(1)

      values = 0.0_wp
      if (abs(x) < half_width) values = indenter%pressure([x/half_width], 1.0_wp)
      pressure = values(1)/indenter%force(1.0_wp)*normal_force/half_width
   end function pressure_of

   !> The stick ratio of an indenter that is scaled to a contact half-width of 1.
   pure real(wp) function stick_ratio_of(indenter, tangential_force, normal_force, friction_coefficient) result(ratio)
      type(indenter_type), intent(in) :: indenter
      real(wp), intent(in) :: tangential_force, normal_force, friction_coefficient
      type(mindlin_history_type) :: history

      history = new_mindlin_history(normal_force, 1.0_wp, indenter, 1.0_wp, friction_coefficient)
      ratio = history%stick_half_width(tangential_force)
   end function stick_ratio_of

   !> The shear traction of an indenter that is scaled to a contact half-width of 1.
   real(wp) function shear_of(indenter, x, tangential_force, normal_force, half_width, friction_coefficient) result(shear)
      type(indenter_type), intent(in) :: indenter
      real(wp), intent(in) :: x, tangential_force, normal_force, half_width, friction_coefficient

      shear = 0.0_wp
      if (abs(x) >= half_width) return
      shear = shear_at(x/half_width, tangential_force, &
                       new_mindlin_history(normal_force, 1.0_wp, indenter, 1.0_wp, friction_coefficient))/half_width
   end function shear_of

   !> The shear traction at x after a growing force.
   real(wp) function shear_at(x, tangential_force, unloaded) result(shear)
      real(wp), intent(in) :: x, tangential_force
      type(mindlin_history_type), intent(in) :: unloaded
      type(mindlin_history_type) :: history
      real(wp) :: values(1)

      history = unloaded
      call history%load(tangential_force)
      values = history%shear([x])
      shear = values(1)
   end function shear_at

end module mfv_reference_c
