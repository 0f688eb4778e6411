!> The states of the load history that may have the largest stresses of a stretch, kept as marks; and the search in them.
module mfv_extreme_states
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite, ieee_is_nan
   use mfv_contact_state, only: contact_state_type
   use mfv_kinds, only: wp
   use mfv_load_extremes, only: add_estimate, candidate_count, candidate_tension, candidate_von_mises, extreme_type, &
                                is_same_estimate, load_extremes_type, most_rows, over_cycle, over_rows, over_steps, slip_range_type
   use mfv_run_state, only: mark_candidate, mark_last_cycle, mark_of, mark_yield, rows_of_yield, run_state_type
   use mfv_scene, only: step_type
   use mfv_state_interior, only: find_largest_tension, find_largest_von_mises
   use mfv_stress_search, only: largest_type
   implicit none
   private
   public :: note_extremes, complete_extremes, find_extremes, find_present_tension, find_largest_of_history, &
             has_largest_tension

   !> An estimate is not smaller than this part of a stress that is among the largest.
   real(wp), parameter :: least_estimate = 0.85_wp

contains

   !> Note what the state at the end of the present segment adds to the extremes of its stretch.
   subroutine note_extremes(self, step)
      class(run_state_type), intent(inout) :: self
      type(step_type), intent(in) :: step
      integer :: i, turn
      integer :: place(candidate_count), yield_place

      turn = 1 + mod(self%current%number - 1, step%turns())
      if (merge(turn, 0, step%cycles > 0) == 1 .or. (step%row == 1 .and. self%current%number == 1)) then
         self%extremes = load_extremes_type(stretch=over_cycle, step=self%steps_done + 1)
         if (step%row > 0) self%extremes%stretch = over_rows
         self%slip_range = slip_range_type()
      end if
      associate (extremes => self%extremes, contact => self%contact)
         i = turn
         if (extremes%stretch == over_rows) i = step%row + turn - 1
         if (extremes%stretch == over_steps) i = self%steps_done + 1
         call extremes%add_state(contact%model, contact%state, self%slip_range, i, step%friction, place)
         do i = 1, candidate_count
            if (place(i) > 0) call self%set_mark(mark_of(mark_candidate, i, place(i)), self%current%number)
         end do
         do i = 1, size(candidate_von_mises)
            associate (candidate => candidate_von_mises(i))
               if (place(candidate) == 0) cycle
               call add_estimate(self%yield_estimate(:, i), extremes%estimate(place(candidate), candidate), yield_place)
               if (yield_place > 0) call self%set_mark(mark_of(mark_yield, i, yield_place), self%current%number)
            end associate
         end do
      end associate
   end subroutine note_extremes

   !> The extremes of a complete cycle. The search for the largest tensions is skipped if they repeat those of the cycle before.
   subroutine complete_extremes(self)
      class(run_state_type), intent(inout) :: self
      integer :: i, j, candidate

      self%current%cycle%extremes = self%extremes
      do i = 1, size(candidate_tension)
         candidate = candidate_tension(i)
         if (self%current%cycle%number > 1) then
            associate (before => self%cycles(self%cycle_count)%extremes)
               if (self%extremes%is_repeated(before, candidate)) then
                  self%current%cycle%extremes%searched(candidate) = before%searched(candidate)
                  self%current%cycle%extremes%last_tension(i) = before%last_tension(i)
                  cycle
               end if
            end associate
         end if
         call search(self, mark_of(mark_candidate, candidate, 1), candidate, self%current%cycle%extremes)
      end do
      do i = 1, size(candidate_von_mises)
         do j = 1, count(self%current%cycle%extremes%row(:, candidate_von_mises(i)) > 0)
            self%marks(mark_of(mark_last_cycle, i, j)) = self%marks(mark_of(mark_candidate, candidate_von_mises(i), j))
         end do
      end do
   end subroutine complete_extremes

   !> Search for a largest stress in the states of its marks from `first` on, the most promising ones first; none where no state has
   !> it.
   subroutine search(self, first, candidate, extremes)
      class(run_state_type), intent(in) :: self
      integer, intent(in) :: first, candidate
      type(load_extremes_type), intent(inout) :: extremes
      type(largest_type) :: largest
      logical :: available, is_left(most_rows)
      integer :: i, number

      associate (found => extremes%searched(candidate), estimates => extremes%estimate(:, candidate))
         found = extreme_type()
         is_left = extremes%row(:, candidate) > 0
         do number = 1, count(is_left)
            i = maxloc(estimates, dim=1, mask=is_left)
            is_left(i) = .false.
            if (found%row > 0) then
               if (ieee_is_nan(found%value)) exit
               ! The last state, if it is among these, has a value of its own among the observables, which must not be larger.
               if (estimates(i) < least_estimate*found%value .and. extremes%row(i, candidate) /= extremes%last_row) cycle
            end if
            call find_largest(self%padded(self%marks(first + i - 1)))
            if (.not. available) exit
            associate (interval => self%contact%model%interval())
               call found%raise_with_rival(largest%value, extremes%row(i, candidate), interval, largest%x, largest%y)
               call found%compete(largest%rival, largest%rival_x, interval)
            end associate
            if (any(candidate == candidate_tension) .and. extremes%row(i, candidate) == extremes%last_row) &
               extremes%last_tension(candidate) = extreme_type(largest%value, largest%x, largest%y, extremes%last_row, &
                                                               largest%rival, largest%rival_x)
         end do
      end associate

   contains

      subroutine find_largest(state)
         type(contact_state_type), intent(in) :: state

         if (any(candidate == candidate_tension)) then
            call find_largest_tension(self%contact%model, state, candidate == candidate_tension(2), largest, available)
         else
            call find_largest_von_mises(self%contact%model, state, candidate == candidate_von_mises(2), largest, available)
         end if
      end subroutine find_largest
   end subroutine search

   !> The extremes of the last complete cycle or, without one, of the rows of &history or all steps so far; of rows that follow the
   !> cycles, or a first cycle that is not complete: of these.
   subroutine find_extremes(self, extremes)
      class(run_state_type), intent(in) :: self
      type(load_extremes_type), intent(out) :: extremes
      integer :: i

      extremes = self%latest_extremes()
      if (.not. self%ends_with_cycle()) then
         do i = 1, size(candidate_tension)
            call search(self, mark_of(mark_candidate, candidate_tension(i), 1), candidate_tension(i), extremes)
         end do
      end if
      do i = 1, size(candidate_von_mises)
         call search(self, first_of_von_mises(self, i), candidate_von_mises(i), extremes)
      end do
   end subroutine find_extremes

   !> Whether the last state may have the largest tension of the body number `side` over the history or its last cycle.
   pure logical function has_largest_tension(self, side) result(has)
      class(run_state_type), intent(in) :: self
      integer, intent(in) :: side
      type(load_extremes_type) :: extremes

      extremes = self%latest_extremes()
      associate (row => extremes%row(:, candidate_tension(side)), estimate => extremes%estimate(:, candidate_tension(side)))
         has = any(row == extremes%last_row .and. estimate >= least_estimate*maxval(estimate))
      end associate
   end function has_largest_tension

   !> The largest tension of the lower or `upper` body in the present state: of find_extremes, if it was searched for there.
   !> `available`: see find_largest_tension.
   subroutine find_present_tension(self, extremes, upper, largest, available)
      class(run_state_type), intent(in) :: self
      type(load_extremes_type), intent(in) :: extremes
      logical, intent(in) :: upper
      type(largest_type), intent(out) :: largest
      logical, intent(out) :: available
      integer :: side

      side = merge(2, 1, upper)
      available = extremes%knows_tension(side, self%contact%state)
      if (available) then
         associate (known => extremes%last_tension(side))
            largest = largest_type(known%value, known%x, known%y, known%rival, known%rival_x)
         end associate
      else
         call find_largest_tension(self%contact%model, self%contact%state, upper, largest, available)
      end if
   end subroutine find_present_tension

   !> The first mark of the states in which find_extremes searches for the largest von Mises stress of a body.
   pure integer function first_of_von_mises(self, body) result(mark)
      class(run_state_type), intent(in) :: self
      integer, intent(in) :: body

      mark = mark_of(mark_candidate, candidate_von_mises(body), 1)
      if (self%ends_with_cycle()) mark = mark_of(mark_last_cycle, body, 1)
   end function first_of_von_mises

   !> The largest von Mises stress of the lower or `upper` body over the whole load history, at the ends of its segments; of layers,
   !> as a part of their yield strengths. `extremes`: of find_extremes; what is known of their states is not searched for again.
   !> `mark`: of the state; 0 without any.
   subroutine find_largest_of_history(self, upper, extremes, largest, mark)
      class(run_state_type), intent(in) :: self
      logical, intent(in) :: upper
      type(load_extremes_type), intent(in) :: extremes
      type(largest_type), intent(out) :: largest
      integer, intent(out) :: mark
      type(largest_type) :: other
      logical :: available
      integer :: i, body, found, next

      body = merge(2, 1, upper)
      mark = 0
      associate (known => extremes%searched(candidate_von_mises(body)), rows => extremes%row(:, candidate_von_mises(body)), &
                 estimates => extremes%estimate(:, candidate_von_mises(body)))
         if (known%row > 0) then
            largest = largest_type(known%value, known%x, known%y)
            found = findloc(rows, known%row, dim=1)
            mark = first_of_von_mises(self, body) + found - 1
            ! The first one of equal states.
            i = findloc(is_same_estimate(self%yield_estimate(:, body), estimates(found)), .true., dim=1)
            if (i > 0) mark = mark_of(mark_yield, body, i)
         end if
         do i = 1, rows_of_yield
            next = mark_of(mark_yield, body, i)
            if (self%marks(next)%step == 0) cycle
            if (mark > 0) then
               if (.not. ieee_is_finite(largest%value)) exit
               if (any(rows > 0 .and. is_same_estimate(estimates, self%yield_estimate(i, body)))) cycle
               if (self%yield_estimate(i, body) < least_estimate*largest%value) cycle
            end if
            call find_largest_von_mises(self%contact%model, self%padded(self%marks(next)), upper, other, available)
            if (.not. available) exit
            if (mark > 0) then
               if (other%value*strength_at(largest) <= largest%value*strength_at(other)) cycle
            end if
            largest = other
            mark = next
         end do
      end associate

   contains

      !> The yield strength where a stress is.
      pure real(wp) function strength_at(stress)
         type(largest_type), intent(in) :: stress

         associate (scene => self%contact%model%scene)
            strength_at = merge(scene%upper%strength_at(stress%y), scene%lower%strength_at(stress%y), upper)
         end associate
      end function strength_at
   end subroutine find_largest_of_history

end module mfv_extreme_states
