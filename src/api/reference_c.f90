!> The closed forms of src/reference for C; NaN outside their domain. See include/mfv.h. Arguments are checked before they are
!> compared: a comparison with NaN may trap.
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

   real(c_double) function mfv_hertz_half_width(normal_force, radius, shear_modulus, kolosov) result(a) bind(C)
      real(c_double), value :: normal_force, radius, shear_modulus, kolosov

      a = not_a_number()
      if (are_not_negative([normal_force]) .and. are_positive([radius, shear_modulus, kolosov + 1.0_c_double])) &
         a = hertz_half_width(normal_force, radius, 4.0_c_double*shear_modulus/(kolosov + 1.0_c_double))
   end function mfv_hertz_half_width

   real(c_double) function mfv_hertz_pressure(x, normal_force, half_width) result(pressure) bind(C)
      real(c_double), value :: x, normal_force, half_width

      pressure = not_a_number()
      if (are_finite([x, normal_force]) .and. are_positive([half_width])) pressure = hertz_pressure(x, normal_force, half_width)
   end function mfv_hertz_pressure

   real(c_double) function mfv_flat_punch_pressure(x, normal_force, half_width) result(pressure) bind(C)
      real(c_double), value :: x, normal_force, half_width

      pressure = not_a_number()
      if (are_finite([x, normal_force]) .and. are_positive([half_width])) &
         pressure = flat_punch_pressure(x, normal_force, half_width)
   end function mfv_flat_punch_pressure

   real(c_double) function mfv_spence_stick_ratio(friction_coefficient, beta) result(ratio) bind(C)
      real(c_double), value :: friction_coefficient, beta

      ratio = not_a_number()
      if (are_not_negative([friction_coefficient]) .and. is_dundurs(beta)) ratio = spence_stick_ratio(friction_coefficient, beta)
   end function mfv_spence_stick_ratio

   real(c_double) function mfv_spence_cylinder_shear(x, normal_force, half_width, friction_coefficient, beta) result(shear) bind(C)
      real(c_double), value :: x, normal_force, half_width, friction_coefficient, beta

      shear = not_a_number()
      if (are_finite([x, normal_force]) .and. are_positive([half_width]) .and. are_not_negative([friction_coefficient]) .and. &
          is_dundurs(beta)) shear = only(spence_cylinder_shear([x], normal_force, half_width, friction_coefficient, beta))
   end function mfv_spence_cylinder_shear

   real(c_double) function mfv_spence_flat_punch_shear(x, normal_force, half_width, friction_coefficient, beta) result(shear) &
      bind(C)
      real(c_double), value :: x, normal_force, half_width, friction_coefficient, beta

      shear = not_a_number()
      if (are_finite([x, normal_force]) .and. are_positive([half_width]) .and. are_not_negative([friction_coefficient]) .and. &
          is_dundurs(beta)) shear = only(spence_flat_punch_shear([x], normal_force, half_width, friction_coefficient, beta))
   end function mfv_spence_flat_punch_shear

   real(c_double) function mfv_mindlin_stick_ratio(tangential_force, normal_force, friction_coefficient) result(ratio) bind(C)
      real(c_double), value :: tangential_force, normal_force, friction_coefficient

      ratio = not_a_number()
      if (are_finite([tangential_force]) .and. are_positive([normal_force, friction_coefficient])) &
         ratio = mindlin_stick_ratio(tangential_force, normal_force, friction_coefficient)
   end function mfv_mindlin_stick_ratio

   real(c_double) function mfv_mindlin_shear(x, tangential_force, normal_force, half_width, friction_coefficient) result(shear) &
      bind(C)
      real(c_double), value :: x, tangential_force, normal_force, half_width, friction_coefficient
      type(mindlin_history_type) :: history

      shear = not_a_number()
      if (.not. (are_finite([x, tangential_force]) .and. are_positive([normal_force, friction_coefficient, half_width]))) return
      history = new_mindlin_history(normal_force, half_width, half_width, half_width, friction_coefficient)
      call history%load(tangential_force)
      shear = only(history%shear([x]))
   end function mfv_mindlin_shear

   real(c_double) function mfv_mindlin_dissipation(tangential_force, normal_force, half_width, radius, friction_coefficient) &
      result(dissipation) bind(C)
      real(c_double), value :: tangential_force, normal_force, half_width, radius, friction_coefficient

      dissipation = not_a_number()
      if (are_finite([tangential_force]) .and. are_positive([normal_force, friction_coefficient, half_width, radius])) &
         dissipation = mindlin_dissipation(tangential_force, normal_force, half_width, radius, friction_coefficient)
   end function mfv_mindlin_dissipation

   real(c_double) function mfv_carter_creepage(tangential_force, normal_force, half_width, radius, friction_coefficient) &
      result(creepage) bind(C)
      real(c_double), value :: tangential_force, normal_force, half_width, radius, friction_coefficient

      creepage = not_a_number()
      if (are_positive([half_width, radius]) .and. is_carried(tangential_force, normal_force, friction_coefficient)) &
         creepage = carter_creepage(tangential_force, normal_force, half_width, radius, friction_coefficient)
   end function mfv_carter_creepage

   real(c_double) function mfv_carter_shear(x, tangential_force, normal_force, half_width, friction_coefficient) result(shear) &
      bind(C)
      real(c_double), value :: x, tangential_force, normal_force, half_width, friction_coefficient

      shear = not_a_number()
      if (are_finite([x]) .and. are_positive([half_width]) .and. &
          is_carried(tangential_force, normal_force, friction_coefficient)) &
         shear = carter_shear(x, tangential_force, normal_force, half_width, friction_coefficient)
   end function mfv_carter_shear

   real(c_double) function mfv_power_half_width(normal_force, coefficient, exponent, shear_modulus, kolosov) result(a) bind(C)
      real(c_double), value :: normal_force, coefficient, exponent, shear_modulus, kolosov

      a = not_a_number()
      if (are_positive([coefficient]) .and. is_exponent(exponent)) &
         a = half_width_of(power_indenter(coefficient, exponent), normal_force, shear_modulus, kolosov)
   end function mfv_power_half_width

   real(c_double) function mfv_power_approach(half_width, coefficient, exponent, datum) result(approach) bind(C)
      real(c_double), value :: half_width, coefficient, exponent, datum

      approach = not_a_number()
      if (are_positive([coefficient]) .and. is_exponent(exponent)) &
         approach = approach_of(power_indenter(coefficient, exponent), half_width, datum)
   end function mfv_power_approach

   real(c_double) function mfv_power_pressure(x, normal_force, half_width, exponent) result(pressure) bind(C)
      real(c_double), value :: x, normal_force, half_width, exponent

      pressure = not_a_number()
      if (is_exponent(exponent)) pressure = pressure_of(power_indenter(1.0_c_double, exponent), x, normal_force, half_width)
   end function mfv_power_pressure

   real(c_double) function mfv_power_stick_ratio(tangential_force, normal_force, friction_coefficient, exponent) result(ratio) &
      bind(C)
      real(c_double), value :: tangential_force, normal_force, friction_coefficient, exponent

      ratio = not_a_number()
      if (is_exponent(exponent)) &
         ratio = stick_ratio_of(power_indenter(1.0_c_double, exponent), tangential_force, normal_force, friction_coefficient)
   end function mfv_power_stick_ratio

   real(c_double) function mfv_power_shear(x, tangential_force, normal_force, half_width, friction_coefficient, exponent) &
      result(shear) bind(C)
      real(c_double), value :: x, tangential_force, normal_force, half_width, friction_coefficient, exponent

      shear = not_a_number()
      if (is_exponent(exponent)) shear = shear_of(power_indenter(1.0_c_double, exponent), x, tangential_force, normal_force, &
                                                  half_width, friction_coefficient)
   end function mfv_power_shear

   real(c_double) function mfv_rounded_punch_half_width(normal_force, flat_half_width, edge_radius, shear_modulus, kolosov) &
      result(a) bind(C)
      real(c_double), value :: normal_force, flat_half_width, edge_radius, shear_modulus, kolosov

      a = not_a_number()
      if (are_not_negative([flat_half_width]) .and. are_positive([edge_radius])) &
         a = half_width_of(rounded_punch_indenter(flat_half_width, edge_radius), normal_force, shear_modulus, kolosov)
   end function mfv_rounded_punch_half_width

   real(c_double) function mfv_rounded_punch_approach(half_width, flat_half_width, edge_radius, datum) result(approach) bind(C)
      real(c_double), value :: half_width, flat_half_width, edge_radius, datum

      approach = not_a_number()
      if (is_beyond_flat(half_width, flat_half_width) .and. are_positive([edge_radius])) &
         approach = approach_of(rounded_punch_indenter(flat_half_width, edge_radius), half_width, datum)
   end function mfv_rounded_punch_approach

   real(c_double) function mfv_rounded_punch_pressure(x, normal_force, half_width, flat_half_width) result(pressure) bind(C)
      real(c_double), value :: x, normal_force, half_width, flat_half_width

      pressure = not_a_number()
      if (is_beyond_flat(half_width, flat_half_width)) &
         pressure = pressure_of(rounded_punch_indenter(flat_half_width/half_width, 1.0_c_double), x, normal_force, half_width)
   end function mfv_rounded_punch_pressure

   real(c_double) function mfv_rounded_punch_stick_ratio(tangential_force, normal_force, friction_coefficient, half_width, &
                                                         flat_half_width) result(ratio) bind(C)
      real(c_double), value :: tangential_force, normal_force, friction_coefficient, half_width, flat_half_width

      ratio = not_a_number()
      if (is_beyond_flat(half_width, flat_half_width)) &
         ratio = stick_ratio_of(rounded_punch_indenter(flat_half_width/half_width, 1.0_c_double), tangential_force, &
                                normal_force, friction_coefficient)
   end function mfv_rounded_punch_stick_ratio

   real(c_double) function mfv_rounded_punch_shear(x, tangential_force, normal_force, half_width, friction_coefficient, &
                                                   flat_half_width) result(shear) bind(C)
      real(c_double), value :: x, tangential_force, normal_force, half_width, friction_coefficient, flat_half_width

      shear = not_a_number()
      if (is_beyond_flat(half_width, flat_half_width)) &
         shear = shear_of(rounded_punch_indenter(flat_half_width/half_width, 1.0_c_double), x, tangential_force, normal_force, &
                          half_width, friction_coefficient)
   end function mfv_rounded_punch_shear

   real(c_double) function mfv_persson_force(half_angle, clearance, youngs_modulus, poisson_ratio) result(force) bind(C)
      real(c_double), value :: half_angle, clearance, youngs_modulus, poisson_ratio

      force = not_a_number()
      if (.not. (are_positive([half_angle, clearance, youngs_modulus]) .and. are_finite([poisson_ratio]))) return
      if (abs(poisson_ratio) < 1) &
         force = persson_force(half_angle, clearance, youngs_modulus/(1.0_c_double - poisson_ratio**2))
      if (.not. force < huge(force)) force = not_a_number()
   end function mfv_persson_force

   real(c_double) function mfv_yield_contact_arc(youngs_modulus, poisson_ratio, yield_strength) result(arc) bind(C)
      real(c_double), value :: youngs_modulus, poisson_ratio, yield_strength

      arc = not_a_number()
      if (.not. (are_positive([youngs_modulus]) .and. are_not_negative([yield_strength]) .and. are_finite([poisson_ratio]))) return
      if (poisson_ratio > -1 .and. poisson_ratio <= 0.5) &
         arc = contact_arc_at_yield(new_material(youngs_modulus/(2.0_c_double*(1.0_c_double + poisson_ratio)), &
                                                 poisson_ratio, plane_strain), plane_strain, yield_strength)
   end function mfv_yield_contact_arc

   pure real(c_double) function half_width_of(indenter, normal_force, shear_modulus, kolosov) result(a)
      type(indenter_type), intent(in) :: indenter
      real(c_double), intent(in) :: normal_force, shear_modulus, kolosov

      a = not_a_number()
      if (are_not_negative([normal_force]) .and. are_positive([shear_modulus, kolosov + 1.0_c_double])) &
         a = indenter%half_width(normal_force*(kolosov + 1.0_c_double)/(8.0_c_double*shear_modulus))
   end function half_width_of

   pure real(c_double) function approach_of(indenter, half_width, datum) result(approach)
      type(indenter_type), intent(in) :: indenter
      real(c_double), intent(in) :: half_width, datum

      approach = not_a_number()
      if (are_positive([half_width, datum])) approach = indenter%approach(half_width, datum)
   end function approach_of

   !> The pressure of an indenter that is scaled to a contact half-width of 1.
   real(c_double) function pressure_of(indenter, x, normal_force, half_width) result(pressure)
      type(indenter_type), intent(in) :: indenter
      real(c_double), intent(in) :: x, normal_force, half_width

      pressure = not_a_number()
      if (.not. (are_finite([x, normal_force]) .and. are_positive([half_width]))) return
      pressure = 0.0_c_double
      if (abs(x) < half_width) pressure = only(indenter%pressure([x/half_width], 1.0_c_double))
      pressure = pressure/indenter%force(1.0_c_double)*normal_force/half_width
   end function pressure_of

   !> The stick ratio of an indenter that is scaled to a contact half-width of 1.
   pure real(c_double) function stick_ratio_of(indenter, tangential_force, normal_force, friction_coefficient) result(ratio)
      type(indenter_type), intent(in) :: indenter
      real(c_double), intent(in) :: tangential_force, normal_force, friction_coefficient
      type(mindlin_history_type) :: history

      ratio = not_a_number()
      if (.not. (are_finite([tangential_force]) .and. are_positive([normal_force, friction_coefficient]))) return
      history = new_mindlin_history(normal_force, 1.0_c_double, indenter, 1.0_c_double, friction_coefficient)
      ratio = history%stick_half_width(tangential_force)
   end function stick_ratio_of

   !> The shear traction of an indenter that is scaled to a contact half-width of 1.
   real(c_double) function shear_of(indenter, x, tangential_force, normal_force, half_width, friction_coefficient) result(shear)
      type(indenter_type), intent(in) :: indenter
      real(c_double), intent(in) :: x, tangential_force, normal_force, half_width, friction_coefficient
      type(mindlin_history_type) :: history

      shear = not_a_number()
      if (.not. (are_finite([x, tangential_force]) .and. are_positive([normal_force, friction_coefficient, half_width]))) return
      history = new_mindlin_history(normal_force, 1.0_c_double, indenter, 1.0_c_double, friction_coefficient)
      call history%load(tangential_force)
      shear = 0.0_c_double
      if (abs(x) < half_width) shear = only(history%shear([x/half_width]))
      shear = shear/half_width
   end function shear_of

   !> The value of an array of one.
   pure real(c_double) function only(values)
      real(c_double), intent(in) :: values(:)

      only = values(1)
   end function only

   !> Whether a power can be an indenter's: from a wedge to what still has a slope at half its contact.
   pure logical function is_exponent(exponent)
      real(c_double), intent(in) :: exponent

      is_exponent = are_finite([exponent])
      if (is_exponent) is_exponent = exponent >= 1 .and. exponent <= 100
   end function is_exponent

   !> Whether a contact reaches beyond the flat part of a punch.
   pure logical function is_beyond_flat(half_width, flat_half_width)
      real(c_double), intent(in) :: half_width, flat_half_width

      is_beyond_flat = are_finite([half_width]) .and. are_not_negative([flat_half_width])
      if (is_beyond_flat) is_beyond_flat = half_width > flat_half_width
   end function is_beyond_flat

   !> Whether this can be Dundurs' parameter beta.
   pure logical function is_dundurs(beta)
      real(c_double), intent(in) :: beta

      is_dundurs = are_finite([beta])
      if (is_dundurs) is_dundurs = abs(beta) <= 1
   end function is_dundurs

   !> Whether friction can carry the tangential force.
   pure logical function is_carried(tangential_force, normal_force, friction_coefficient)
      real(c_double), intent(in) :: tangential_force, normal_force, friction_coefficient

      is_carried = are_finite([tangential_force]) .and. are_positive([normal_force, friction_coefficient])
      if (is_carried) is_carried = abs(tangential_force) <= friction_coefficient*normal_force
   end function is_carried

   pure logical function are_positive(arguments)
      real(c_double), intent(in) :: arguments(:)

      are_positive = are_finite(arguments)
      if (are_positive) are_positive = all(arguments > 0)
   end function are_positive

   pure logical function are_not_negative(arguments)
      real(c_double), intent(in) :: arguments(:)

      are_not_negative = are_finite(arguments)
      if (are_not_negative) are_not_negative = all(arguments >= 0)
   end function are_not_negative

   pure logical function are_finite(arguments)
      real(c_double), intent(in) :: arguments(:)

      are_finite = all(ieee_is_finite(arguments))
   end function are_finite

   pure real(c_double) function not_a_number()
      not_a_number = ieee_value(1.0_c_double, ieee_quiet_nan)
   end function not_a_number

end module mfv_reference_c
