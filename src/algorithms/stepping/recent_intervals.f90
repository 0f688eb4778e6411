!> States within the last different load intervals: a first guess where a cycle repeats them.
module mfv_recent_intervals
   use mfv_chain_dissipation, only: sample_type
   use mfv_contact_system, only: load_type
   use mfv_motions, only: motion_count
   use mfv_tolerances, only: significant
   implicit none
   private
   public :: recent_intervals_type

   !> Number of intervals that are kept.
   integer, parameter :: most_intervals = 8

   type :: interval_type
      type(load_type) :: load(motion_count)
      !> Evenly spaced states from the start to the end, shape (0:samples).
      type(sample_type), allocatable :: samples(:)
   end type interval_type

   type :: recent_intervals_type
      private
      type(interval_type) :: intervals(most_intervals)
      !> The last one.
      integer :: last = 0
   contains
      procedure :: keep
      procedure :: find
   end type recent_intervals_type

contains

   !> Keep the `samples` of an interval, shape (0:samples), without their rates, in place of those of an equal one or the oldest.
   subroutine keep(self, load, samples)
      class(recent_intervals_type), intent(inout) :: self
      type(load_type), intent(in) :: load(motion_count)
      type(sample_type), intent(in) :: samples(0:)
      integer :: i, place

      place = 0
      do i = 1, most_intervals
         if (allocated(self%intervals(i)%samples) .and. all(same(self%intervals(i)%load, load))) place = i
      end do
      if (place == 0) then
         self%last = 1 + modulo(self%last, most_intervals)
         place = self%last
      end if
      associate (interval => self%intervals(place))
         interval%load = load
         if (allocated(interval%samples)) deallocate (interval%samples)
         allocate (interval%samples(0:ubound(samples, 1)))
         do i = 1, ubound(samples, 1)
            interval%samples(i)%status = samples(i)%status
            call interval%samples(i)%fields%copy_from(samples(i)%fields)
         end do
      end associate
   end subroutine keep

   !> The state at the fraction `place`/`parts` of the interval with the same loads, on a mesh of `nodes` nodes. `found`:
   !> whether there is one; if not, `sample` keeps its value.
   subroutine find(self, load, nodes, place, parts, sample, found)
      class(recent_intervals_type), intent(in) :: self
      type(load_type), intent(in) :: load(motion_count)
      integer, intent(in) :: nodes, place, parts
      type(sample_type), intent(inout) :: sample
      logical, intent(out) :: found
      integer :: i, count

      found = .false.
      do i = 1, most_intervals
         associate (interval => self%intervals(i))
            if (.not. allocated(interval%samples)) return
            if (.not. all(same(interval%load, load))) cycle
            count = ubound(interval%samples, 1)
            if (modulo(place*count, parts) /= 0) cycle
            if (size(interval%samples(count)%status) /= nodes) cycle
            sample%status = interval%samples(place*count/parts)%status
            call sample%fields%copy_from(interval%samples(place*count/parts)%fields)
            found = .true.
            return
         end associate
      end do
   end subroutine find

   !> Whether two loads are equal up to round-off.
   elemental logical function same(a, b)
      type(load_type), intent(in) :: a, b

      same = a%control == b%control .and. max(abs(a%value - b%value), abs(a%rate - b%rate)) &
             <= significant*max(abs(a%value), abs(a%rate))
   end function same

end module mfv_recent_intervals
