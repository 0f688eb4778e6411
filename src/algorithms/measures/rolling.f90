!> Creepage: sliding per rolled distance, over the last few intervals of the mesh. In steady rolling the sliding has the
!> period of one interval, as nodes enter and leave the contact one by one.
module mfv_rolling
   use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
   use mfv_kinds, only: wp
   use mfv_tolerances, only: significant, visible
   implicit none
   private
   public :: rolling_type

   !> Intervals over which the creepage is measured.
   integer, parameter :: intervals = 4

   type :: rolling_type
      private
      !> Rolling direction, 1 to the right, -1 to the left; number of interval ends passed, at most `intervals` + 1.
      integer :: direction = 0, passed = 0
      !> Distance rolled in this direction under constant forces, length.
      real(wp) :: distance = 0.0_wp
      !> Sliding at the ends of the last intervals, length, latest first; and width of an interval, length.
      real(wp) :: slid(intervals + 1) = 0.0_wp, interval = 0.0_wp
   contains
      procedure :: follow
      procedure :: creepage
      procedure :: is_steady
      procedure :: heads_right
   end type rolling_type

contains

   !> Add an increment in which the contact rolls from `rolled(1)` to `rolled(2)` and the surfaces slide from `slid(1)` to
   !> `slid(2)`, lengths. `forces_stay`: forces are constant. Starts anew without rolling (by more than round-off) and after a
   !> reversal.
   pure subroutine follow(self, interval, rolled, slid, forces_stay)
      class(rolling_type), intent(inout) :: self
      real(wp), intent(in) :: interval, rolled(2), slid(2)
      logical, intent(in) :: forces_stay
      !> An end that is missed by this fraction of an interval counts as passed.
      real(wp), parameter :: round_off = significant
      real(wp) :: ends, last, fraction
      integer :: direction, i

      direction = 0
      if (abs(rolled(2) - rolled(1)) > epsilon(interval)*interval) direction = merge(1, -1, rolled(2) > rolled(1))
      if (direction /= self%direction) self%passed = 0
      if (direction /= self%direction .or. .not. forces_stay) self%distance = 0.0_wp
      if (forces_stay) self%distance = self%distance + abs(rolled(2) - rolled(1))
      self%direction = direction
      self%interval = interval
      if (direction == 0) return
      last = aint_down(direction*rolled(2)/interval + round_off)
      ends = last - aint_down(direction*rolled(1)/interval + round_off)
      do i = nint(min(ends, real(intervals + 1, wp))) - 1, 0, -1
         fraction = ((last - i)*direction*interval - rolled(1))/(rolled(2) - rolled(1))
         self%slid(2:) = self%slid(:intervals)
         self%slid(1) = slid(1) + fraction*(slid(2) - slid(1))
         self%passed = min(self%passed + 1, intervals + 1)
      end do
   end subroutine follow

   !> Largest integer not above a number.
   pure real(wp) function aint_down(number)
      real(wp), intent(in) :: number

      aint_down = aint(number)
      if (aint_down > number) aint_down = aint_down - 1.0_wp
   end function aint_down

   !> Sliding of the upper surface over the lower one per rolled distance, both to the right; NaN before enough intervals are
   !> rolled.
   pure real(wp) function creepage(self)
      class(rolling_type), intent(in) :: self

      creepage = ieee_value(1.0_wp, ieee_quiet_nan)
      if (self%passed > intervals) &
         creepage = (self%slid(1) - self%slid(intervals + 1))/(self%direction*intervals*self%interval)
   end function creepage

   !> Whether it has rolled by twice the contact length under constant forces, so that transients of the tractions have left
   !> the contact. Half-width: length.
   pure logical function is_steady(self, half_width)
      class(rolling_type), intent(in) :: self
      real(wp), intent(in) :: half_width
      real(wp), parameter :: lengths = 2.0_wp

      is_steady = self%distance*(1.0_wp + visible) >= lengths*2.0_wp*half_width .and. half_width > 0.0_wp
   end function is_steady

   !> Whether it rolls to the right.
   pure logical function heads_right(self)
      class(rolling_type), intent(in) :: self

      heads_right = self%direction > 0
   end function heads_right

end module mfv_rolling
