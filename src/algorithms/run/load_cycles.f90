!> The cycles of a step: their turning points, edges and extremes, and whether they have become steady.
module mfv_load_cycles
   use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
   use mfv_compliance, only: block_wt
   use mfv_contact_state, only: contact_state_type
   use mfv_cycle, only: append_cycle, cycle_type, new_turning_point, turning_point_type
   use mfv_edge_fields, only: edge_field_type, edge_fields_of, undefined_edge
   use mfv_extreme_states, only: complete_extremes
   use mfv_kinds, only: wp
   use mfv_run_state, only: history_none, mark_cycle_start, mark_loading, mark_pending, mark_return, mark_reversal, mark_turn, &
                            run_state_type
   use mfv_scene, only: step_type
   use mfv_zone_edges, only: find_patches, patch_type
   implicit none
   private
   public :: begin_cycles, restart_cycle, complete_cycle_segment, present_edge_fields, wears, is_steady

contains

   !> Begin the cycles of a step at the present state.
   subroutine begin_cycles(self)
      class(run_state_type), intent(inout) :: self
      integer :: i

      do i = 1, mark_pending
         self%marks(i)%step = 0
      end do
      self%current%cycle = cycle_type()
      self%current%cycle%step = self%steps_done + 1
      self%current%cycle%loading_slip = self%slip
      call self%set_mark(mark_loading, 0)
      call restart_cycle(self)
   end subroutine begin_cycles

   !> Begin the next cycle at the present state: the first one, or one after wear.
   subroutine restart_cycle(self)
      class(run_state_type), intent(inout) :: self

      self%current%cycle%return = turning_point_here(self, ieee_value(1.0_wp, ieee_quiet_nan))
      call self%contact%state%begin_cycle_work()
      call self%set_mark(mark_return, self%current%number - 1)
   end subroutine restart_cycle

   !> The present state as a turning point. `stiffness`: see turning_point_type.
   type(turning_point_type) function turning_point_here(self, stiffness) result(point)
      class(run_state_type), intent(in) :: self
      real(wp), intent(in) :: stiffness

      associate (contact => self%contact)
         point = new_turning_point(contact%model, contact%state, self%slip, contact%work, contact%work_error, stiffness)
      end associate
   end function turning_point_here

   !> Complete a segment of cycles of `turns` segments. Store its end if it is the farthest of its cycle so far and, after a
   !> complete cycle, the cycle.
   subroutine complete_cycle_segment(self, turns)
      class(run_state_type), intent(inout) :: self
      integer, intent(in) :: turns
      type(turning_point_type) :: point
      logical :: is_farthest

      point = turning_point_here(self, self%contact%leaving%stiffness)
      associate (number => self%current%number, cycle => self%current%cycle)
         call cycle%add_point(point, is_first=mod(number, turns) == 1)
         if (mod(number, turns) == 0) then
            call complete_cycle(self, turns, point)
            return
         end if
         is_farthest = mod(number, turns) == 1
         if (.not. is_farthest) is_farthest = cycle%is_farther(point)
         if (.not. is_farthest) return
         call add_edge_fields(self, point)
         cycle%reversal = point
         call self%set_mark(mark_pending, number)
      end associate
   end subroutine complete_cycle_segment

   !> Complete the present cycle of `turns` segments, which ends at the turning point `point`.
   subroutine complete_cycle(self, turns, point)
      class(run_state_type), intent(inout) :: self
      integer, intent(in) :: turns
      type(turning_point_type), intent(inout) :: point
      type(contact_state_type) :: before

      self%cycles_done = self%cycles_done + 1
      self%marks(mark_cycle_start) = self%marks(mark_return)
      self%marks(mark_reversal) = self%marks(mark_pending)
      before = self%padded(self%marks(mark_cycle_start))
      call add_edge_fields(self, point)
      call self%set_mark(mark_return, self%current%number)
      associate (cycle => self%current%cycle)
         cycle%number = self%current%number/turns
         cycle%turns = turns
         cycle%worn_area = self%contact%model%force(self%contact%state%worn)
         cycle%overall = self%cycles_done
         cycle%start = cycle%return
         cycle%return = point
         cycle%change = change_since(self, before)
         if (cycle%number == 1) cycle%first_dissipation = cycle%dissipation()
         if (cycle%number == 1) cycle%first_slip = cycle%slip()
      end associate
      call complete_extremes(self)
      call append_cycle(self%cycles, self%cycle_count, self%current%cycle, self%keep_history == history_none)
   end subroutine complete_cycle

   !> The left and right edge of the patches of the present state, shape (2, patches).
   function present_edge_fields(self, patches) result(edges)
      class(run_state_type), intent(in) :: self
      type(patch_type), intent(in) :: patches(:)
      type(edge_field_type) :: edges(2, size(patches))
      type(contact_state_type), allocatable :: before

      if (self%marks(mark_turn)%step > 0) allocate (before, source=self%padded(self%marks(mark_turn)))
      associate (contact => self%contact)
         edges = edge_fields_of(contact%model, contact%system, contact%state, self%load, patches, before)
      end associate
   end function present_edge_fields

   !> Add the outermost edges of the present state to its turning point; not where the surfaces wear, whose edges are as fine as
   !> what wears away in a cycle, nor of coupled bodies, whose edges are known at one of both ends only: where they slip.
   subroutine add_edge_fields(self, point)
      class(run_state_type), intent(in) :: self
      type(turning_point_type), intent(inout) :: point
      type(patch_type), allocatable :: patches(:)
      type(edge_field_type), allocatable :: edges(:, :)

      point%left = undefined_edge()
      point%right = point%left
      if (self%contact%model%scene%wear%acts() .or. self%contact%model%couples(block_wt)) return
      call find_patches(self%contact%model, self%contact%state, patches)
      if (size(patches) == 0) return
      edges = present_edge_fields(self, patches)
      point%left = edges(1, 1)
      point%right = edges(2, size(patches))
   end subroutine add_edge_fields

   !> Whether the present segment ends a cycle whose wear changes the gaps.
   pure logical function wears(self, step)
      class(run_state_type), intent(in) :: self
      type(step_type), intent(in) :: step

      wears = step%cycles > 0 .and. mod(self%current%number, step%turns()) == 0 .and. self%contact%model%scene%wear%acts() .and. &
              self%contact%model%tangential
   end function wears

   !> Whether the cycles of a step have become steady. With wear also the change that the remaining cycles would make, each as much
   !> as those of this block, must be within the tolerance: that of the tractions, and that of the worn area relative to itself.
   logical function is_steady(self, step)
      class(run_state_type), intent(in) :: self
      type(step_type), intent(in) :: step
      type(contact_state_type) :: start
      real(wp) :: blocks, worn

      associate (cycle => self%current%cycle, tolerance => step%steady_tolerance)
         is_steady = cycle%number > 1 .and. cycle%change <= tolerance
         if (.not. (is_steady .and. wears(self, step))) return
         blocks = real(step%cycles - self%current%number/step%turns(), wp)/real(self%cycles(self%cycle_count)%block, wp)
         worn = self%contact%model%force(self%contact%state%worn)
         start = self%padded(self%marks(mark_cycle_start))
         is_steady = blocks*change_since(self, start) <= tolerance .and. blocks*(worn - cycle%worn_area) <= tolerance*worn
      end associate
   end function is_steady

   !> Largest change of a traction since the state `before` on the same mesh, relative to the largest traction so far.
   pure real(wp) function change_since(self, before)
      class(run_state_type), intent(in) :: self
      type(contact_state_type), intent(in) :: before
      real(wp) :: scale

      change_since = 0.0_wp
      scale = self%contact%certificate%traction_scale
      associate (now => self%contact%state%fields, then => before%fields)
         if (scale > 0.0_wp) change_since = max(maxval(abs(now%pressure - then%pressure)), &
                                                maxval(abs(now%shear - then%shear)))/scale
      end associate
   end function change_since

end module mfv_load_cycles
