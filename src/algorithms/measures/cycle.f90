!> What is kept of a cycle of the load history: its three turning points, and what it did.
module mfv_cycle
   use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
   use mfv_contact_model, only: contact_model_type
   use mfv_contact_state, only: contact_state_type
   use mfv_kinds, only: pi, wp
   use mfv_motions, only: motions, motion_count, motion_approach, motion_shift
   use mfv_slip_zones, only: slip_record_type
   use mfv_zone_edges, only: find_zone_edges, zone_edges_type
   implicit none
   private
   public :: cycle_type, turning_point_type, new_turning_point, append_cycle

   !> Where the load turns.
   type :: turning_point_type
      !> Forces and motions, as contact_fields_type has them.
      real(wp) :: force(motion_count) = 0.0_wp, motion(motion_count) = 0.0_wp
      real(wp) :: dissipation = 0.0_wp
      type(zone_edges_type) :: edges
      !> What is known of the slip zones up to there.
      type(slip_record_type) :: slip
      !> Tangential force over shift on the first event increment of the way to it, that is right after the turning point before,
      !> where all sticks: tangential stiffness, force/length^2. NaN where no such increment was made.
      real(wp) :: stiffness_on_leaving = 0.0_wp
      !> See contact_model_type.
      real(wp) :: largest_stiffness = 0.0_wp
   end type turning_point_type

   type :: cycle_type
      !> Step of the load history, number in it, and number over all steps.
      integer :: step = 0, number = 0, overall = 0
      !> Where it began, its far end, and where it ended.
      type(turning_point_type) :: start, reversal, return
      !> Largest change of a traction from its start to its end, in parts of the largest traction so far.
      real(wp) :: change = 0.0_wp
      !> Energy that the first cycle of this step dissipated, per unit thickness: force.
      real(wp) :: first_dissipation = 0.0_wp
      !> What is known of the slip zones up to where the cycles of this step begin, and of those of its first cycle.
      type(slip_record_type) :: loading_slip, first_slip
   contains
      procedure :: slip
      procedure :: dissipation
      procedure :: force_amplitude
      procedure :: shift_amplitude
      procedure, private :: is_sheared
      procedure, private :: only_sheared
      procedure :: secant_stiffness
      procedure :: loss_factor
   end type cycle_type

contains

   !> The turning point that a state is. `slip`: see turning_point_type; `stiffness`: see stiffness_on_leaving.
   type(turning_point_type) function new_turning_point(model, state, slip, stiffness) result(point)
      type(contact_model_type), intent(in) :: model
      type(contact_state_type), intent(in) :: state
      type(slip_record_type), intent(in) :: slip
      real(wp), intent(in) :: stiffness

      point%force = state%fields%force
      point%motion = state%fields%motion
      point%largest_stiffness = model%largest_stiffness()
      point%dissipation = state%dissipation
      point%slip = slip
      point%stiffness_on_leaving = stiffness
      call find_zone_edges(model, state, point%edges)
   end function new_turning_point

   !> Energy that the cycle dissipated, per unit thickness: force.
   elemental real(wp) function dissipation(self)
      class(cycle_type), intent(in) :: self

      dissipation = self%return%dissipation - self%start%dissipation
   end function dissipation

   !> What is known of the slip zones of the cycle.
   elemental type(slip_record_type) function slip(self)
      class(cycle_type), intent(in) :: self

      slip = self%return%slip%since(self%start%slip)
   end function slip

   !> Half of what the tangential force changes by, force/length.
   elemental real(wp) function force_amplitude(self)
      class(cycle_type), intent(in) :: self

      force_amplitude = 0.5_wp*abs(self%return%force(motion_shift) - self%reversal%force(motion_shift))
   end function force_amplitude

   !> Half of what the shift changes by, length.
   elemental real(wp) function shift_amplitude(self)
      class(cycle_type), intent(in) :: self

      shift_amplitude = 0.5_wp*abs(self%return%motion(motion_shift) - self%reversal%motion(motion_shift))
   end function shift_amplitude

   !> Whether tangential force and shift both change by more than round-off.
   elemental logical function is_sheared(self)
      class(cycle_type), intent(in) :: self
      real(wp), parameter :: round_off = 1.0e-10_wp

      is_sheared = self%shift_amplitude() > round_off*max(abs(self%return%motion(motion_shift)), &
                                                          abs(self%reversal%motion(motion_shift))) .and. &
                   self%force_amplitude() > round_off*max(self%return%force(motion_approach), &
                                                          self%reversal%force(motion_approach)) .and. &
                   self%force_amplitude() < self%return%largest_stiffness*self%shift_amplitude()
   end function is_sheared

   !> Whether the tangential force alone works over the loop: neither the normal force nor a motion such as the rotation changes.
   elemental logical function only_sheared(self)
      class(cycle_type), intent(in) :: self
      real(wp), parameter :: round_off = 1.0e-9_wp
      real(wp) :: force(3), motion(3)
      integer :: i

      force = [self%start%force(motion_approach), self%reversal%force(motion_approach), self%return%force(motion_approach)]
      only_sheared = self%is_sheared() .and. maxval(force) - minval(force) <= round_off*maxval(force)
      do i = 1, motion_count
         if (.not. motions(i)%optional) cycle
         motion = [self%start%motion(i), self%reversal%motion(i), self%return%motion(i)]
         only_sheared = only_sheared .and. maxval(motion) - minval(motion) <= round_off*maxval(abs(motion))
      end do
   end function only_sheared

   !> Tangential force over shift from end to end, force/length^2; NaN where one of them does not change.
   elemental real(wp) function secant_stiffness(self)
      class(cycle_type), intent(in) :: self

      secant_stiffness = ieee_value(1.0_wp, ieee_quiet_nan)
      if (self%is_sheared()) secant_stiffness = self%force_amplitude()/self%shift_amplitude()
   end function secant_stiffness

   !> Loss factor: dissipation over 2 pi times the energy force_amplitude shift_amplitude/2 of the linear spring that has the
   !> secant stiffness. NaN where that is none, and where the normal force or the rotation changes too: the dissipation is then not
   !> the area of the loop of tangential force and shift.
   elemental real(wp) function loss_factor(self)
      class(cycle_type), intent(in) :: self

      loss_factor = ieee_value(1.0_wp, ieee_quiet_nan)
      if (self%only_sheared()) loss_factor = self%dissipation()/(pi*self%force_amplitude()*self%shift_amplitude())
   end function loss_factor

   !> Append a cycle to the first `number` ones of a list that doubles where it is full; where `last_only`, it takes their place.
   subroutine append_cycle(cycles, number, cycle, last_only)
      type(cycle_type), allocatable, intent(inout) :: cycles(:)
      integer, intent(inout) :: number
      type(cycle_type), intent(in) :: cycle
      logical, intent(in) :: last_only
      type(cycle_type), allocatable :: longer(:)
      integer, parameter :: first_capacity = 8

      if (.not. allocated(cycles)) allocate (cycles(first_capacity))
      if (last_only) number = 0
      if (number == size(cycles)) then
         allocate (longer(2*number))
         longer(:number) = cycles
         call move_alloc(longer, cycles)
      end if
      number = number + 1
      cycles(number) = cycle
   end subroutine append_cycle

end module mfv_cycle
