!> A coefficient of friction that may vary along the surface.
module mfv_friction_coefficient
   use mfv_kinds, only: wp
   implicit none
   private
   public :: friction_coefficient_type, uniform_coefficient

   type :: friction_coefficient_type
      !> The coefficient: a single value; or one at each `position`; or, without positions, one for each node.
      real(wp), allocatable :: value(:)
      !> Increasing x of the values, length; between them the coefficient is linear, beyond them constant.
      real(wp), allocatable :: position(:)
   contains
      procedure :: at
      procedure :: largest
      procedure :: is_uniform
      procedure :: equals
   end type friction_coefficient_type

contains

   !> The same coefficient everywhere.
   pure function uniform_coefficient(mu) result(self)
      real(wp), intent(in) :: mu
      type(friction_coefficient_type) :: self

      self%value = [mu]
   end function uniform_coefficient

   !> The coefficient at nodes at x (length), shape (nodes); zero if not set.
   pure function at(self, x) result(mu)
      class(friction_coefficient_type), intent(in) :: self
      real(wp), intent(in) :: x(:)
      real(wp) :: mu(size(x))
      integer :: i

      mu = 0.0_wp
      if (.not. allocated(self%value)) return
      if (size(self%value) == 1) then
         mu = self%value(1)
      else if (allocated(self%position)) then
         mu = [(interpolated(self%position, self%value, x(i)), i=1, size(x))]
      else
         mu = self%value
      end if
   end function at

   pure real(wp) function interpolated(positions, values, x)
      real(wp), intent(in) :: positions(:), values(:), x
      real(wp) :: fraction
      integer :: i, n

      n = size(positions)
      i = min(max(count(positions <= x), 1), n - 1)
      fraction = min(max((x - positions(i))/(positions(i + 1) - positions(i)), 0.0_wp), 1.0_wp)
      interpolated = (1.0_wp - fraction)*values(i) + fraction*values(i + 1)
   end function interpolated

   !> The largest value; zero if not set.
   pure real(wp) function largest(self)
      class(friction_coefficient_type), intent(in) :: self

      largest = 0.0_wp
      if (allocated(self%value)) largest = maxval(self%value)
   end function largest

   !> Whether it is uniform.
   pure logical function is_uniform(self)
      class(friction_coefficient_type), intent(in) :: self

      is_uniform = .true.
      if (allocated(self%value)) is_uniform = maxval(self%value) <= minval(self%value)
   end function is_uniform

   !> Whether it has the same values as `other` at the same positions.
   pure logical function equals(self, other)
      class(friction_coefficient_type), intent(in) :: self, other

      equals = allocated(self%value) .and. allocated(other%value) .and. (allocated(self%position) .eqv. allocated(other%position))
      if (equals) equals = size(self%value) == size(other%value)
      if (equals) equals = .not. any(abs(self%value - other%value) > 0.0_wp)
      if (.not. equals .or. .not. allocated(self%position)) return
      equals = size(self%position) == size(other%position)
      if (equals) equals = .not. any(abs(self%position - other%position) > 0.0_wp)
   end function equals

end module mfv_friction_coefficient
