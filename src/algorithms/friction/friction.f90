!> The friction of a scene: a law (one file for each, see mfv_friction_law) and its coefficients along the surface. Only this
!> module lists the laws.
module mfv_friction
   use mfv_friction_coefficient, only: friction_coefficient_type, uniform_coefficient
   use mfv_friction_coulomb, only: coulomb_law
   use mfv_friction_dahl, only: dahl_law
   use mfv_friction_law, only: friction_law_type
   use mfv_friction_static_kinetic, only: static_kinetic_law
   use mfv_friction_weakening, only: weakening_law
   use mfv_kinds, only: wp
   implicit none
   private
   public :: friction_type, friction_coefficient_type, uniform_coefficient, no_friction, uniform_friction, friction_law_names, &
             new_friction_law

   !> Names of all laws, as in a case.
   character(*), parameter :: friction_law_names = 'coulomb static_kinetic weakening dahl'

   type :: friction_type
      !> Static and kinetic coefficient of friction (equal for laws with one coefficient).
      type(friction_coefficient_type) :: static, kinetic
      !> Not allocated: no friction.
      class(friction_law_type), allocatable :: law
   contains
      procedure :: name
      procedure :: acts
      procedure :: is_coulomb
      procedure :: is_proportional
      procedure :: is_linear
      procedure :: sticks
      procedure :: converges
      procedure :: simplify
   end type friction_type

contains

   !> The law with the given name, with its parameters still to be set; not allocated for 'none' and unknown names.
   subroutine new_friction_law(name, law)
      character(*), intent(in) :: name
      class(friction_law_type), allocatable, intent(out) :: law

      select case (name)
      case ('coulomb')
         allocate (law, source=coulomb_law)
      case ('static_kinetic')
         allocate (law, source=static_kinetic_law)
      case ('weakening')
         allocate (law, source=weakening_law)
      case ('dahl')
         allocate (law, source=dahl_law)
      end select
   end subroutine new_friction_law

   function no_friction() result(friction)
      type(friction_type) :: friction

      friction%static = uniform_coefficient(0.0_wp)
      friction%kinetic = friction%static
   end function no_friction

   !> The law with the given name and uniform coefficients, with its parameters still to be set.
   function uniform_friction(name, mu_static, mu_kinetic) result(friction)
      character(*), intent(in) :: name
      real(wp), intent(in) :: mu_static, mu_kinetic
      type(friction_type) :: friction

      friction%static = uniform_coefficient(mu_static)
      friction%kinetic = uniform_coefficient(mu_kinetic)
      call new_friction_law(name, friction%law)
   end function uniform_friction

   !> Replace a law by Coulomb's law if it is equivalent: static and kinetic coefficients equal everywhere.
   subroutine simplify(self)
      class(friction_type), intent(inout) :: self

      if (.not. allocated(self%law)) return
      if (.not. self%law%has_two_coefficients) return
      if (.not. self%kinetic%equals(self%static)) return
      call new_friction_law('coulomb', self%law)
   end subroutine simplify

   !> Name of the law, as in a case.
   pure function name(self)
      class(friction_type), intent(in) :: self
      character(len=16) :: name

      name = 'none'
      if (allocated(self%law)) name = self%law%name
   end function name

   !> Whether there can be any shear traction.
   pure logical function acts(self)
      class(friction_type), intent(in) :: self

      acts = allocated(self%law) .and. self%static%largest() > 0.0_wp
   end function acts

   !> Whether |tau| = mu p wherever a node slips.
   pure logical function is_proportional(self)
      class(friction_type), intent(in) :: self

      is_proportional = .false.
      if (allocated(self%law)) is_proportional = self%law%is_proportional
   end function is_proportional

   !> See mfv_friction_law; true without friction.
   pure logical function is_linear(self)
      class(friction_type), intent(in) :: self

      is_linear = .true.
      if (allocated(self%law)) is_linear = self%law%is_linear
   end function is_linear

   !> See mfv_friction_law; true without friction.
   pure logical function sticks(self)
      class(friction_type), intent(in) :: self

      sticks = .true.
      if (allocated(self%law)) sticks = self%law%sticks
   end function sticks

   !> See mfv_friction_law; true without friction.
   pure logical function converges(self)
      class(friction_type), intent(in) :: self

      converges = .true.
      if (allocated(self%law)) converges = self%law%slip_of_fall() > 0.0_wp
   end function converges

   !> Whether it is Coulomb's law with a uniform coefficient, as closed forms assume.
   pure logical function is_coulomb(self)
      class(friction_type), intent(in) :: self

      is_coulomb = self%is_proportional() .and. self%static%is_uniform()
   end function is_coulomb

end module mfv_friction
