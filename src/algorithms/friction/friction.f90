!> The friction of a scene: a law (each is a file of its own, see mfv_friction_law) and its coefficients along the surface.
module mfv_friction
   use mfv_friction_coefficient, only: friction_coefficient_type, uniform_coefficient
   use mfv_friction_coulomb, only: coulomb_law_type
   use mfv_friction_dahl, only: new_dahl_law
   use mfv_friction_law, only: friction_law_type
   use mfv_friction_static_kinetic, only: new_static_kinetic_law
   use mfv_friction_weakening, only: new_weakening_law
   use mfv_kinds, only: wp
   implicit none
   private
   public :: friction_type, friction_coefficient_type, uniform_coefficient, no_friction, coulomb_friction, &
             static_kinetic_friction, weakening_friction, dahl_friction

   type :: friction_type
      !> Static and kinetic coefficient of friction (the same where the law knows only one).
      type(friction_coefficient_type) :: static, kinetic
      !> Not there: no friction.
      class(friction_law_type), allocatable :: law
      !> Name of the law, as in a case.
      character(len=16) :: name = 'none'
   contains
      procedure :: acts
      procedure :: is_coulomb
      procedure :: simplify
   end type friction_type

contains

   function no_friction() result(friction)
      type(friction_type) :: friction

      friction%static = uniform_coefficient(0.0_wp)
      friction%kinetic = friction%static
   end function no_friction

   !> Coulomb's law with the coefficient of friction mu >= 0. mu = 0 is no friction and costs no more: the tangential problem
   !> is then not modelled.
   function coulomb_friction(mu) result(friction)
      real(wp), intent(in) :: mu
      type(friction_type) :: friction

      friction%static = uniform_coefficient(mu)
      friction%kinetic = friction%static
      allocate (coulomb_law_type :: friction%law)
      friction%name = 'coulomb'
   end function coulomb_friction

   !> mu_static >= mu_kinetic >= 0.
   function static_kinetic_friction(mu_static, mu_kinetic) result(friction)
      real(wp), intent(in) :: mu_static, mu_kinetic
      type(friction_type) :: friction

      friction%static = uniform_coefficient(mu_static)
      friction%kinetic = uniform_coefficient(mu_kinetic)
      allocate (friction%law, source=new_static_kinetic_law())
      friction%name = 'static_kinetic'
   end function static_kinetic_friction

   !> mu_static >= mu_kinetic >= 0; `distance` of the slip between them, length, > 0.
   function weakening_friction(mu_static, mu_kinetic, distance) result(friction)
      real(wp), intent(in) :: mu_static, mu_kinetic, distance
      type(friction_type) :: friction

      friction%static = uniform_coefficient(mu_static)
      friction%kinetic = uniform_coefficient(mu_kinetic)
      allocate (friction%law, source=new_weakening_law(distance))
      friction%name = 'weakening'
   end function weakening_friction

   !> Dahl's law with the limit mu p, `stiffness` sigma > 0 (force/length^3) and `exponent` gamma >= 0.
   function dahl_friction(mu, stiffness, exponent) result(friction)
      real(wp), intent(in) :: mu, stiffness, exponent
      type(friction_type) :: friction

      friction%static = uniform_coefficient(mu)
      friction%kinetic = friction%static
      allocate (friction%law, source=new_dahl_law(stiffness, exponent))
      friction%name = 'dahl'
   end function dahl_friction

   !> With equal static and kinetic coefficients everywhere, static and kinetic friction and weakening friction are Coulomb's law.
   subroutine simplify(self)
      class(friction_type), intent(inout) :: self

      if (.not. allocated(self%law)) return
      if (.not. (self%law%drops .or. self%law%weakening_distance < huge(1.0_wp))) return
      if (.not. self%kinetic%equals(self%static)) return
      deallocate (self%law)
      allocate (coulomb_law_type :: self%law)
      self%name = 'coulomb'
   end subroutine simplify

   !> Whether there can be any shear traction.
   pure logical function acts(self)
      class(friction_type), intent(in) :: self

      acts = allocated(self%law) .and. self%static%largest() > 0.0_wp
   end function acts

   !> Whether it is Coulomb's law with one coefficient everywhere (closed forms know no other).
   pure logical function is_coulomb(self)
      class(friction_type), intent(in) :: self

      is_coulomb = .false.
      if (.not. allocated(self%law)) return
      select type (law => self%law)
      type is (coulomb_law_type)
         is_coulomb = self%static%is_uniform()
      end select
   end function is_coulomb

end module mfv_friction
