!> The closed forms of src/reference for C; NaN outside their domain. See include/mfv.h.
module mfv_reference_c
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite, ieee_quiet_nan, ieee_value
   use, intrinsic :: iso_c_binding, only: c_double
   use mfv_reference_carter, only: carter_creepage, carter_shear
   use mfv_reference_flat_punch, only: flat_punch_pressure
   use mfv_reference_hertz, only: hertz_half_width, hertz_pressure
   use mfv_reference_indenter, only: indenter_type, power_indenter, rounded_punch_indenter
   use mfv_material, only: new_material, plane_strain
   use mfv_reference_mindlin
   use mfv_reference_persson, only: persson_force
   use mfv_reference_spence, only: spence_cylinder_shear, spence_flat_punch_shear, spence_stick_ratio
   use mfv_reference_yield, only: contact_arc_at_yield
   implicit none
   private

contains

   function c_hertz_half_width(normal_force, radius, shear_modulus, kolosov) result(a) bind(C, name='mfv_hertz_half_width')
      real(c_double), value :: normal_force, radius, shear_modulus, kolosov
      real(c_double) :: a

      a = not_a_number()
      if (.not. all_finite([normal_force, radius, shear_modulus, kolosov])) return
      if (normal_force >= 0 .and. radius > 0 .and. shear_modulus > 0 .and. kolosov > -1) &
         a = hertz_half_width(normal_force, radius, 4.0_c_double*shear_modulus/(kolosov + 1.0_c_double))
   end function c_hertz_half_width

   function c_hertz_pressure(x, normal_force, half_width) result(pressure) bind(C, name='mfv_hertz_pressure')
      real(c_double), value :: x, normal_force, half_width
      real(c_double) :: pressure

      pressure = not_a_number()
      if (.not. all_finite([x, normal_force, half_width])) return
      if (half_width > 0) pressure = hertz_pressure(x, normal_force, half_width)
   end function c_hertz_pressure

   function c_flat_punch_pressure(x, normal_force, half_width) result(pressure) bind(C, name='mfv_flat_punch_pressure')
      real(c_double), value :: x, normal_force, half_width
      real(c_double) :: pressure

      pressure = not_a_number()
      if (.not. all_finite([x, normal_force, half_width])) return
      if (half_width > 0) pressure = flat_punch_pressure(x, normal_force, half_width)
   end function c_flat_punch_pressure

   function c_spence_stick_ratio(friction_coefficient, beta) result(ratio) bind(C, name='mfv_spence_stick_ratio')
      real(c_double), value :: friction_coefficient, beta
      real(c_double) :: ratio

      ratio = not_a_number()
      if (.not. all_finite([friction_coefficient, beta])) return
      if (friction_coefficient >= 0 .and. abs(beta) <= 1) ratio = spence_stick_ratio(friction_coefficient, beta)
   end function c_spence_stick_ratio

   function c_spence_cylinder_shear(x, normal_force, half_width, friction_coefficient, beta) result(shear) &
      bind(C, name='mfv_spence_cylinder_shear')
      real(c_double), value :: x, normal_force, half_width, friction_coefficient, beta
      real(c_double) :: shear
      real(c_double) :: at(1)

      shear = not_a_number()
      at = shear
      if (.not. all_finite([x, normal_force, half_width, friction_coefficient, beta])) return
      if (half_width > 0 .and. friction_coefficient >= 0 .and. abs(beta) <= 1) &
         at = spence_cylinder_shear([x], normal_force, half_width, friction_coefficient, beta)
      shear = at(1)
   end function c_spence_cylinder_shear

   function c_spence_flat_punch_shear(x, normal_force, half_width, friction_coefficient, beta) result(shear) &
      bind(C, name='mfv_spence_flat_punch_shear')
      real(c_double), value :: x, normal_force, half_width, friction_coefficient, beta
      real(c_double) :: shear
      real(c_double) :: at(1)

      shear = not_a_number()
      at = shear
      if (.not. all_finite([x, normal_force, half_width, friction_coefficient, beta])) return
      if (half_width > 0 .and. friction_coefficient >= 0 .and. abs(beta) <= 1) &
         at = spence_flat_punch_shear([x], normal_force, half_width, friction_coefficient, beta)
      shear = at(1)
   end function c_spence_flat_punch_shear

   function c_mindlin_stick_ratio(tangential_force, normal_force, friction_coefficient) result(ratio) &
      bind(C, name='mfv_mindlin_stick_ratio')
      real(c_double), value :: tangential_force, normal_force, friction_coefficient
      real(c_double) :: ratio

      ratio = not_a_number()
      if (.not. all_finite([tangential_force, normal_force, friction_coefficient])) return
      if (normal_force > 0 .and. friction_coefficient > 0) &
         ratio = mindlin_stick_ratio(tangential_force, normal_force, friction_coefficient)
   end function c_mindlin_stick_ratio

   function c_mindlin_shear(x, tangential_force, normal_force, half_width, friction_coefficient) result(shear) &
      bind(C, name='mfv_mindlin_shear')
      real(c_double), value :: x, tangential_force, normal_force, half_width, friction_coefficient
      real(c_double) :: shear
      real(c_double) :: at(1)
      type(mindlin_history_type) :: history

      shear = not_a_number()
      if (.not. all_finite([x, tangential_force, normal_force, half_width, friction_coefficient])) return
      if (.not. (normal_force > 0 .and. friction_coefficient > 0 .and. half_width > 0)) return
      history = new_mindlin_history(normal_force, half_width, half_width, half_width, friction_coefficient)
      call history%load(tangential_force)
      at = history%shear([x])
      shear = at(1)
   end function c_mindlin_shear

   function c_mindlin_dissipation(tangential_force, normal_force, half_width, radius, friction_coefficient) &
      result(dissipation) bind(C, name='mfv_mindlin_dissipation')
      real(c_double), value :: tangential_force, normal_force, half_width, radius, friction_coefficient
      real(c_double) :: dissipation

      dissipation = not_a_number()
      if (.not. all_finite([tangential_force, normal_force, half_width, radius, friction_coefficient])) return
      if (normal_force > 0 .and. friction_coefficient > 0 .and. half_width > 0 .and. radius > 0) &
         dissipation = mindlin_dissipation(tangential_force, normal_force, half_width, radius, friction_coefficient)
   end function c_mindlin_dissipation

   function c_carter_creepage(tangential_force, normal_force, half_width, radius, friction_coefficient) result(creepage) &
      bind(C, name='mfv_carter_creepage')
      real(c_double), value :: tangential_force, normal_force, half_width, radius, friction_coefficient
      real(c_double) :: creepage

      creepage = not_a_number()
      if (.not. all_finite([tangential_force, normal_force, half_width, radius, friction_coefficient])) return
      if (normal_force > 0 .and. friction_coefficient > 0 .and. half_width > 0 .and. radius > 0 .and. &
          abs(tangential_force) <= friction_coefficient*normal_force) &
         creepage = carter_creepage(tangential_force, normal_force, half_width, radius, friction_coefficient)
   end function c_carter_creepage

   function c_carter_shear(x, tangential_force, normal_force, half_width, friction_coefficient) result(shear) &
      bind(C, name='mfv_carter_shear')
      real(c_double), value :: x, tangential_force, normal_force, half_width, friction_coefficient
      real(c_double) :: shear

      shear = not_a_number()
      if (.not. all_finite([x, tangential_force, normal_force, half_width, friction_coefficient])) return
      if (normal_force > 0 .and. friction_coefficient > 0 .and. half_width > 0 .and. &
          abs(tangential_force) <= friction_coefficient*normal_force) &
         shear = carter_shear(x, tangential_force, normal_force, half_width, friction_coefficient)
   end function c_carter_shear

   function c_power_half_width(normal_force, coefficient, exponent, shear_modulus, kolosov) result(a) &
      bind(C, name='mfv_power_half_width')
      real(c_double), value :: normal_force, coefficient, exponent, shear_modulus, kolosov
      real(c_double) :: a

      a = not_a_number()
      if (.not. all_finite([normal_force, coefficient, exponent, shear_modulus, kolosov])) return
      if (coefficient > 0 .and. is_exponent(exponent)) &
         a = half_width_of(power_indenter(coefficient, exponent), normal_force, shear_modulus, kolosov)
   end function c_power_half_width

   function c_power_approach(half_width, coefficient, exponent, datum) result(approach) bind(C, name='mfv_power_approach')
      real(c_double), value :: half_width, coefficient, exponent, datum
      real(c_double) :: approach

      approach = not_a_number()
      if (.not. all_finite([half_width, coefficient, exponent, datum])) return
      if (coefficient > 0 .and. is_exponent(exponent)) &
         approach = approach_of(power_indenter(coefficient, exponent), half_width, datum)
   end function c_power_approach

   function c_power_pressure(x, normal_force, half_width, exponent) result(pressure) bind(C, name='mfv_power_pressure')
      real(c_double), value :: x, normal_force, half_width, exponent
      real(c_double) :: pressure

      pressure = not_a_number()
      if (.not. all_finite([x, normal_force, half_width, exponent])) return
      if (is_exponent(exponent)) pressure = pressure_of(power_indenter(1.0_c_double, exponent), x, normal_force, half_width)
   end function c_power_pressure

   function c_power_stick_ratio(tangential_force, normal_force, friction_coefficient, exponent) result(ratio) &
      bind(C, name='mfv_power_stick_ratio')
      real(c_double), value :: tangential_force, normal_force, friction_coefficient, exponent
      real(c_double) :: ratio

      ratio = not_a_number()
      if (.not. all_finite([tangential_force, normal_force, friction_coefficient, exponent])) return
      if (is_exponent(exponent)) &
         ratio = stick_ratio_of(power_indenter(1.0_c_double, exponent), tangential_force, normal_force, friction_coefficient)
   end function c_power_stick_ratio

   function c_power_shear(x, tangential_force, normal_force, half_width, friction_coefficient, exponent) result(shear) &
      bind(C, name='mfv_power_shear')
      real(c_double), value :: x, tangential_force, normal_force, half_width, friction_coefficient, exponent
      real(c_double) :: shear

      shear = not_a_number()
      if (.not. all_finite([x, tangential_force, normal_force, half_width, friction_coefficient, exponent])) return
      if (is_exponent(exponent)) shear = shear_of(power_indenter(1.0_c_double, exponent), x, tangential_force, normal_force, &
                                                  half_width, friction_coefficient)
   end function c_power_shear

   function c_rounded_punch_half_width(normal_force, flat_half_width, edge_radius, shear_modulus, kolosov) result(a) &
      bind(C, name='mfv_rounded_punch_half_width')
      real(c_double), value :: normal_force, flat_half_width, edge_radius, shear_modulus, kolosov
      real(c_double) :: a

      a = not_a_number()
      if (.not. all_finite([normal_force, flat_half_width, edge_radius, shear_modulus, kolosov])) return
      if (flat_half_width >= 0 .and. edge_radius > 0) &
         a = half_width_of(rounded_punch_indenter(flat_half_width, edge_radius), normal_force, shear_modulus, kolosov)
   end function c_rounded_punch_half_width

   function c_rounded_punch_approach(half_width, flat_half_width, edge_radius, datum) result(approach) &
      bind(C, name='mfv_rounded_punch_approach')
      real(c_double), value :: half_width, flat_half_width, edge_radius, datum
      real(c_double) :: approach

      approach = not_a_number()
      if (.not. all_finite([half_width, flat_half_width, edge_radius, datum])) return
      if (flat_half_width >= 0 .and. half_width > flat_half_width .and. edge_radius > 0) &
         approach = approach_of(rounded_punch_indenter(flat_half_width, edge_radius), half_width, datum)
   end function c_rounded_punch_approach

   function c_rounded_punch_pressure(x, normal_force, half_width, flat_half_width) result(pressure) &
      bind(C, name='mfv_rounded_punch_pressure')
      real(c_double), value :: x, normal_force, half_width, flat_half_width
      real(c_double) :: pressure

      pressure = not_a_number()
      if (.not. all_finite([x, normal_force, half_width, flat_half_width])) return
      if (flat_half_width >= 0 .and. half_width > flat_half_width) &
         pressure = pressure_of(rounded_punch_indenter(flat_half_width/half_width, 1.0_c_double), x, normal_force, half_width)
   end function c_rounded_punch_pressure

   function c_rounded_punch_stick_ratio(tangential_force, normal_force, friction_coefficient, half_width, flat_half_width) &
      result(ratio) bind(C, name='mfv_rounded_punch_stick_ratio')
      real(c_double), value :: tangential_force, normal_force, friction_coefficient, half_width, flat_half_width
      real(c_double) :: ratio

      ratio = not_a_number()
      if (.not. all_finite([tangential_force, normal_force, friction_coefficient, half_width, flat_half_width])) return
      if (flat_half_width >= 0 .and. half_width > flat_half_width) &
         ratio = stick_ratio_of(rounded_punch_indenter(flat_half_width/half_width, 1.0_c_double), tangential_force, &
                                normal_force, friction_coefficient)
   end function c_rounded_punch_stick_ratio

   function c_rounded_punch_shear(x, tangential_force, normal_force, half_width, friction_coefficient, flat_half_width) &
      result(shear) bind(C, name='mfv_rounded_punch_shear')
      real(c_double), value :: x, tangential_force, normal_force, half_width, friction_coefficient, flat_half_width
      real(c_double) :: shear

      shear = not_a_number()
      if (.not. all_finite([x, tangential_force, normal_force, half_width, friction_coefficient, flat_half_width])) return
      if (flat_half_width >= 0 .and. half_width > flat_half_width) &
         shear = shear_of(rounded_punch_indenter(flat_half_width/half_width, 1.0_c_double), x, tangential_force, normal_force, &
                          half_width, friction_coefficient)
   end function c_rounded_punch_shear

   !> Whether a power can be an indenter's: from a wedge to what still has a slope at half its contact.
   pure logical function is_exponent(exponent)
      real(c_double), intent(in) :: exponent

      is_exponent = exponent >= 1 .and. exponent <= 100
   end function is_exponent

   pure real(c_double) function half_width_of(indenter, normal_force, shear_modulus, kolosov) result(a)
      type(indenter_type), intent(in) :: indenter
      real(c_double), intent(in) :: normal_force, shear_modulus, kolosov

      a = not_a_number()
      if (normal_force >= 0 .and. shear_modulus > 0 .and. kolosov > -1) &
         a = indenter%half_width(normal_force*(kolosov + 1.0_c_double)/(8.0_c_double*shear_modulus))
   end function half_width_of

   pure real(c_double) function approach_of(indenter, half_width, datum) result(approach)
      type(indenter_type), intent(in) :: indenter
      real(c_double), intent(in) :: half_width, datum

      approach = not_a_number()
      if (half_width > 0 .and. datum > 0) approach = indenter%approach(half_width, datum)
   end function approach_of

   !> The pressure of an indenter that is scaled to a contact half-width of 1.
   real(c_double) function pressure_of(indenter, x, normal_force, half_width) result(pressure)
      type(indenter_type), intent(in) :: indenter
      real(c_double), intent(in) :: x, normal_force, half_width
      real(c_double) :: at(1)

      pressure = not_a_number()
      if (.not. half_width > 0) return
      at = 0.0_c_double
      if (abs(x) < half_width) at = indenter%pressure([x/half_width], 1.0_c_double)
      pressure = at(1)/indenter%force(1.0_c_double)*normal_force/half_width
   end function pressure_of

   !> The stick ratio of an indenter that is scaled to a contact half-width of 1.
   pure real(c_double) function stick_ratio_of(indenter, tangential_force, normal_force, friction_coefficient) result(ratio)
      type(indenter_type), intent(in) :: indenter
      real(c_double), intent(in) :: tangential_force, normal_force, friction_coefficient
      type(mindlin_history_type) :: history

      ratio = not_a_number()
      if (.not. (normal_force > 0 .and. friction_coefficient > 0)) return
      history = new_mindlin_history(normal_force, 1.0_c_double, indenter, 1.0_c_double, friction_coefficient)
      ratio = history%stick_half_width(tangential_force)
   end function stick_ratio_of

   !> The shear traction of an indenter that is scaled to a contact half-width of 1.
   real(c_double) function shear_of(indenter, x, tangential_force, normal_force, half_width, friction_coefficient) result(shear)
      type(indenter_type), intent(in) :: indenter
      real(c_double), intent(in) :: x, tangential_force, normal_force, half_width, friction_coefficient
      type(mindlin_history_type) :: history
      real(c_double) :: at(1)

      shear = not_a_number()
      if (.not. (normal_force > 0 .and. friction_coefficient > 0 .and. half_width > 0)) return
      history = new_mindlin_history(normal_force, 1.0_c_double, indenter, 1.0_c_double, friction_coefficient)
      call history%load(tangential_force)
      at = 0.0_c_double
      if (abs(x) < half_width) at = history%shear([x/half_width])
      shear = at(1)/half_width
   end function shear_of

   function c_persson_force(half_angle, clearance, youngs_modulus, poisson_ratio) result(force) &
      bind(C, name='mfv_persson_force')
      real(c_double), value :: half_angle, clearance, youngs_modulus, poisson_ratio
      real(c_double) :: force

      force = not_a_number()
      if (.not. all_finite([half_angle, clearance, youngs_modulus, poisson_ratio])) return
      if (half_angle > 0 .and. clearance > 0 .and. youngs_modulus > 0 .and. abs(poisson_ratio) < 1) &
         force = persson_force(half_angle, clearance, youngs_modulus/(1.0_c_double - poisson_ratio**2))
      if (.not. force < huge(force)) force = not_a_number()
   end function c_persson_force

   function c_yield_arc(youngs_modulus, poisson_ratio, yield_strength) result(arc) bind(C, name='mfv_yield_contact_arc')
      real(c_double), value :: youngs_modulus, poisson_ratio, yield_strength
      real(c_double) :: arc

      arc = not_a_number()
      if (.not. all_finite([youngs_modulus, poisson_ratio, yield_strength])) return
      if (youngs_modulus > 0 .and. poisson_ratio > -1 .and. poisson_ratio <= 0.5 .and. yield_strength >= 0) &
         arc = contact_arc_at_yield(new_material(youngs_modulus/(2.0_c_double*(1.0_c_double + poisson_ratio)), &
                                                 poisson_ratio, plane_strain), plane_strain, yield_strength)
   end function c_yield_arc

   !> Whether arguments can be compared: with NaN that may trap.
   pure logical function all_finite(arguments)
      real(c_double), intent(in) :: arguments(:)

      all_finite = all(ieee_is_finite(arguments))
   end function all_finite

   pure real(c_double) function not_a_number()
      not_a_number = ieee_value(1.0_c_double, ieee_quiet_nan)
   end function not_a_number

end module mfv_reference_c
