!> Friction laws with uniform coefficients, and all of mfv_friction.
module test_friction
   use mfv_friction
   use mfv_kinds, only: wp
   implicit none
   public
   private :: wp

contains

   !> Coulomb's law with the coefficient of friction mu >= 0. For mu = 0 the tangential problem is not modelled.
   function coulomb_friction(mu) result(friction)
      real(wp), intent(in) :: mu
      type(friction_type) :: friction

      friction = uniform_friction('coulomb', mu, mu)
   end function coulomb_friction

   !> mu_static >= mu_kinetic >= 0.
   function static_kinetic_friction(mu_static, mu_kinetic) result(friction)
      real(wp), intent(in) :: mu_static, mu_kinetic
      type(friction_type) :: friction

      friction = uniform_friction('static_kinetic', mu_static, mu_kinetic)
   end function static_kinetic_friction

   !> mu_static >= mu_kinetic >= 0; `distance`: slip over which friction decreases, length, > 0.
   function weakening_friction(mu_static, mu_kinetic, distance) result(friction)
      real(wp), intent(in) :: mu_static, mu_kinetic, distance
      type(friction_type) :: friction

      friction = uniform_friction('weakening', mu_static, mu_kinetic)
      call friction%law%set_parameter('weakening_distance', distance)
   end function weakening_friction

   !> Dahl's law with the limit mu p, `stiffness` sigma > 0 (force/length^3) and `exponent` gamma >= 0.
   function dahl_friction(mu, stiffness, exponent) result(friction)
      real(wp), intent(in) :: mu, stiffness, exponent
      type(friction_type) :: friction

      friction = uniform_friction('dahl', mu, mu)
      call friction%law%set_parameter('stiffness', stiffness)
      call friction%law%set_parameter('exponent', exponent)
   end function dahl_friction

end module test_friction
