!> A cycle of the load history: its three turning points, and what is measured between them.
module mfv_cycle
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan, ieee_quiet_nan, ieee_value
   use mfv_contact_model, only: contact_model_type
   use mfv_contact_state, only: contact_state_type
   use mfv_edge_fields, only: edge_field_type
   use mfv_kinds, only: pi, wp
   use mfv_load_extremes, only: load_extremes_type
   use mfv_motions, only: motions, motion_count, motion_approach, motion_shift, motion_interference
   use mfv_slip_zones, only: slip_record_type
   use mfv_tolerances, only: certified, significant
   use mfv_zone_edges, only: find_zone_edges, zone_edges_type
   implicit none
   private
   public :: cycle_type, turning_point_type, new_turning_point, append_cycle

   !> State at a turning point of the load.
   type :: turning_point_type
      !> Forces and motions, as in contact_fields_type.
      real(wp) :: force(motion_count) = 0.0_wp, motion(motion_count) = 0.0_wp
      real(wp) :: dissipation = 0.0_wp
      type(zone_edges_type) :: edges
      !> The outermost edges, left and right; not at the start.
      type(edge_field_type) :: left, right
      !> Record of the slip zones up to here.
      type(slip_record_type) :: slip
      !> Tangential stiffness, force/length^2: tangential force over shift on the first increment after the preceding turning
      !> point, where all nodes stick. NaN without such an increment.
      real(wp) :: stiffness_on_leaving = 0.0_wp
      !> See contact_model_type.
      real(wp) :: largest_stiffness = 0.0_wp
      !> Work of the forces so far, and its estimated error over the accuracy, see path_record_type.
      real(wp) :: work(motion_count) = 0.0_wp, work_error = 0.0_wp
   contains
      procedure :: distance
   end type turning_point_type

   type :: cycle_type
      !> Step of the load history, number of the cycle in this step, and number over all steps.
      integer :: step = 0, number = 0, overall = 0
      !> Its turning points.
      integer :: turns = 2
      !> Start; the turning point with the forces that differ most from those at the start; return.
      type(turning_point_type) :: start, reversal, return
      !> Extremes at the turning points, without the start: of forces and motions, and of what they cause.
      real(wp), dimension(motion_count) :: lowest_force = 0.0_wp, highest_force = 0.0_wp, lowest_motion = 0.0_wp, &
                                           highest_motion = 0.0_wp
      !> Left and right edge, arc lengths, of what sticks at all these turning points; NaN with several patches or stick zones.
      real(wp) :: stick(2) = 0.0_wp
      type(load_extremes_type) :: extremes
      !> Cycles of the block of wear that begins with this one; area worn off the profiles before it, length^2.
      integer :: block = 1
      real(wp) :: worn_area = 0.0_wp
      !> Largest change of a traction from start to return, relative to the largest traction so far.
      real(wp) :: change = 0.0_wp
      !> Energy dissipated in the first cycle of this step, per unit thickness: force.
      real(wp) :: first_dissipation = 0.0_wp
      !> Record of the slip zones up to the first cycle of this step, and of the first cycle.
      type(slip_record_type) :: loading_slip, first_slip
   contains
      procedure :: add_point
      procedure :: is_farther
      procedure :: slip
      procedure :: dissipation
      procedure :: loop_area
      procedure :: drift
      procedure :: walks
      procedure :: force_amplitude
      procedure :: shift_amplitude
      procedure :: is_sheared
      procedure, private :: only_sheared
      procedure :: secant_stiffness
      procedure :: loss_factor
      procedure :: permanent_stick_length
   end type cycle_type

contains

   !> Turning point from a state. `slip`, `work`, `work_error`, `stiffness`: see turning_point_type.
   type(turning_point_type) function new_turning_point(model, state, slip, work, work_error, stiffness) result(point)
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: state
      type(slip_record_type), intent(in) :: slip
      real(wp), intent(in) :: work(motion_count), work_error, stiffness

      point%force = state%fields%force
      point%motion = state%fields%motion
      point%largest_stiffness = model%largest_stiffness()
      point%dissipation = state%dissipation
      point%slip = slip
      point%stiffness_on_leaving = stiffness
      point%work = work
      point%work_error = work_error
      call find_zone_edges(model, state, point%edges)
   end function new_turning_point

   !> Distance of normal and tangential force from those of another turning point, force/length.
   elemental real(wp) function distance(self, other)
      class(turning_point_type), intent(in) :: self
      type(turning_point_type), intent(in) :: other

      distance = hypot(self%force(motion_approach) - other%force(motion_approach), &
                       self%force(motion_shift) - other%force(motion_shift))
   end function distance

   !> Update the extremes with a turning point; `is_first`: the first one of the cycle after its start.
   subroutine add_point(self, point, is_first)
      class(cycle_type), intent(inout) :: self
      type(turning_point_type), intent(in) :: point
      logical, intent(in) :: is_first
      real(wp) :: zone(2)

      if (is_first) then
         self%lowest_force = point%force
         self%highest_force = point%force
         self%lowest_motion = point%motion
         self%highest_motion = point%motion
         self%stick = stick_zone_of(point%edges)
         return
      end if
      self%lowest_force = min(self%lowest_force, point%force)
      self%highest_force = max(self%highest_force, point%force)
      self%lowest_motion = min(self%lowest_motion, point%motion)
      self%highest_motion = max(self%highest_motion, point%motion)
      zone = stick_zone_of(point%edges)
      if (any(ieee_is_nan([zone, self%stick]))) then
         self%stick = ieee_value(1.0_wp, ieee_quiet_nan)
      else
         self%stick = [max(self%stick(1), zone(1)), min(self%stick(2), zone(2))]
      end if
   end subroutine add_point

   !> Left and right edge of the only stick zone of the only patch, the same place if nothing sticks; NaN with several.
   pure function stick_zone_of(edges) result(zone)
      type(zone_edges_type), intent(in) :: edges
      real(wp) :: zone(2)

      zone = 0.0_wp
      if (edges%stick) zone = [edges%stick_left, edges%stick_right]
      if (edges%patches /= 1 .or. abs(zone(2) - zone(1) - edges%stick_length) > certified*edges%contact_length) &
         zone = ieee_value(1.0_wp, ieee_quiet_nan)
   end function stick_zone_of

   !> Whether a turning point is farther from the start of the cycle, the return of the one before, than its reversal so far. Of
   !> points that are equally far, but for round-off, the first counts.
   elemental logical function is_farther(self, point)
      class(cycle_type), intent(in) :: self
      type(turning_point_type), intent(in) :: point

      is_farther = point%distance(self%return) > (1.0_wp + significant)*self%reversal%distance(self%return)
   end function is_farther

   !> Work of the force of a motion over the cycle, per unit thickness: force. It is the area of the loop of force and motion; an
   !> open loop is closed by a straight line. NaN if large increments do not know it to the accuracy.
   elemental real(wp) function loop_area(self, motion)
      class(cycle_type), intent(in) :: self
      integer, intent(in) :: motion
      real(wp) :: round_off

      loop_area = ieee_value(1.0_wp, ieee_quiet_nan)
      round_off = significant*sum(max(abs(self%lowest_force), abs(self%highest_force))*(self%highest_motion - self%lowest_motion))
      if (self%return%work_error - self%start%work_error > max(self%dissipation(), 0.0_wp) + round_off) return
      associate (from => self%return, to => self%start)
         loop_area = (from%work(motion) - to%work(motion)) &
                     + 0.5_wp*(from%force(motion) + to%force(motion))*(to%motion(motion) - from%motion(motion))
      end associate
   end function loop_area

   !> Change of a motion over the cycle, in its unit; 0 if the cycle returns to the motion within the certified accuracy.
   elemental real(wp) function drift(self, motion)
      class(cycle_type), intent(in) :: self
      integer, intent(in) :: motion

      drift = self%return%motion(motion) - self%start%motion(motion)
      if (abs(drift) <= certified*(self%highest_motion(motion) - self%lowest_motion(motion))) drift = 0.0_wp
   end function drift

   !> Whether the upper body walks: its shift has changed over the cycle although the tractions repeat, and will go on changing.
   !> (Tractions determine approach and rotation.)
   elemental logical function walks(self)
      class(cycle_type), intent(in) :: self
      !> Least drift over the range of the shift; over the approach or interference, which is elastic, and the change of the
      !> tractions; round-off.
      real(wp), parameter :: least = 1.0e-3_wp, over_change = 3.0_wp, round_off = significant
      real(wp) :: lowest, highest, elastic

      lowest = min(self%lowest_motion(motion_shift), self%start%motion(motion_shift))
      highest = max(self%highest_motion(motion_shift), self%start%motion(motion_shift))
      elastic = max(abs(self%lowest_motion(motion_approach)), abs(self%highest_motion(motion_approach)), &
                    abs(self%highest_motion(motion_interference)))
      walks = abs(self%drift(motion_shift)) > max(least*(highest - lowest), over_change*self%change*elastic, &
                                                  round_off*max(abs(lowest), abs(highest), elastic))
   end function walks

   !> Dissipated energy per unit thickness: force.
   elemental real(wp) function dissipation(self)
      class(cycle_type), intent(in) :: self

      dissipation = self%return%dissipation - self%start%dissipation
   end function dissipation

   !> Record of the slip zones of the cycle.
   elemental type(slip_record_type) function slip(self)
      class(cycle_type), intent(in) :: self

      slip = self%return%slip%since(self%start%slip)
   end function slip

   !> Half the range of the tangential force, force/length.
   elemental real(wp) function force_amplitude(self)
      class(cycle_type), intent(in) :: self

      force_amplitude = 0.5_wp*(self%highest_force(motion_shift) - self%lowest_force(motion_shift))
   end function force_amplitude

   !> Half the range of the shift, length.
   elemental real(wp) function shift_amplitude(self)
      class(cycle_type), intent(in) :: self

      shift_amplitude = 0.5_wp*(self%highest_motion(motion_shift) - self%lowest_motion(motion_shift))
   end function shift_amplitude

   !> Whether tangential force and shift both change by more than a rounding error.
   elemental logical function is_sheared(self)
      class(cycle_type), intent(in) :: self

      is_sheared = self%shift_amplitude() > certified*max(abs(self%lowest_motion(motion_shift)), &
                                                          abs(self%highest_motion(motion_shift))) .and. &
                   self%force_amplitude() > certified*max(abs(self%lowest_force(motion_approach)), &
                                                          abs(self%highest_force(motion_approach))) .and. &
                   self%force_amplitude() < self%return%largest_stiffness*self%shift_amplitude()
   end function is_sheared

   !> Whether only the tangential force does work: neither the normal force nor another motion such as the rotation changes.
   elemental logical function only_sheared(self)
      class(cycle_type), intent(in) :: self
      real(wp) :: force(3), motion(3)
      integer :: i

      force = [self%start%force(motion_approach), self%lowest_force(motion_approach), self%highest_force(motion_approach)]
      only_sheared = self%is_sheared() .and. maxval(force) - minval(force) <= significant*maxval(force)
      do i = 1, motion_count
         if (.not. motions(i)%optional) cycle
         motion = [self%start%motion(i), self%lowest_motion(i), self%highest_motion(i)]
         only_sheared = only_sheared .and. maxval(motion) - minval(motion) <= significant*maxval(abs(motion))
      end do
   end function only_sheared

   !> Range of the tangential force over range of the shift, force/length^2; NaN if one of them does not change.
   elemental real(wp) function secant_stiffness(self)
      class(cycle_type), intent(in) :: self

      secant_stiffness = ieee_value(1.0_wp, ieee_quiet_nan)
      if (self%is_sheared()) secant_stiffness = self%force_amplitude()/self%shift_amplitude()
   end function secant_stiffness

   !> Loss factor: area of the loop of tangential force and shift over 2 pi times the energy force_amplitude*shift_amplitude/2 of a
   !> spring of the secant stiffness. The area is the dissipation unless another load changes. NaN without a secant stiffness, and
   !> for a loop that is open, which has no area: the work between its ends depends on how it is closed.
   elemental real(wp) function loss_factor(self)
      class(cycle_type), intent(in) :: self
      !> Part of the area by which an open loop may be uncertain.
      real(wp), parameter :: negligible = 0.01_wp
      !> Loss factor, and part of the amplitudes, that is a rounding error.
      real(wp), parameter :: round_off = significant
      real(wp) :: open_work

      loss_factor = ieee_value(1.0_wp, ieee_quiet_nan)
      if (.not. self%is_sheared()) return
      loss_factor = self%loop_area(motion_shift)
      if (self%only_sheared()) loss_factor = self%dissipation()
      open_work = self%force_amplitude()*abs(self%drift(motion_shift)) + &
                  self%shift_amplitude()*abs(self%return%force(motion_shift) - self%start%force(motion_shift))
      if (open_work > negligible*abs(loss_factor) + round_off*self%force_amplitude()*self%shift_amplitude()) &
         loss_factor = ieee_value(1.0_wp, ieee_quiet_nan)
      loss_factor = loss_factor/(pi*self%force_amplitude()*self%shift_amplitude())
   end function loss_factor

   !> Length of the part that sticks at all turning points of the cycle; NaN with several patches or stick zones.
   elemental real(wp) function permanent_stick_length(self) result(length)
      class(cycle_type), intent(in) :: self

      length = self%stick(2) - self%stick(1)
      if (length < 0.0_wp) length = 0.0_wp
   end function permanent_stick_length

   !> Append a cycle to the first `number` entries of a list, which doubles when full. `last_only`: it replaces them.
   subroutine append_cycle(cycles, number, cycle, last_only)
      type(cycle_type), allocatable, intent(inout) :: cycles(:)
      integer, intent(inout) :: number
      type(cycle_type), intent(in) :: cycle
      logical, intent(in) :: last_only
      integer, parameter :: first_capacity = 8

      if (.not. allocated(cycles)) allocate (cycles(first_capacity))
      if (last_only) number = 0
      if (number == size(cycles)) cycles = [cycles, cycles]
      number = number + 1
      cycles(number) = cycle
   end subroutine append_cycle

end module mfv_cycle
