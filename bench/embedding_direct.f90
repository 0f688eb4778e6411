!> The simulation without the C interface, for comparison in embedding.c: direct calls of the procedures behind mfv_advance.
module embedding_direct
   use, intrinsic :: iso_c_binding
   use mfv_case, only: case_type
   use mfv_case_reader, only: read_case_text
   use mfv_error, only: error_type
   use mfv_motions, only: motion_shift, control_displacement
   use mfv_scene, only: step_type
   use mfv_simulation, only: new_simulation, simulation_type
   implicit none
   private

   type(simulation_type), allocatable, save :: simulation

contains

   !> Run the steps of a new case. Returns the status.
   integer(c_int) function direct_start(text, length) bind(C, name='direct_start') result(status)
      integer(c_size_t), value :: length
      character(kind=c_char), intent(in) :: text(length)
      type(case_type) :: case
      type(error_type), allocatable :: error

      call read_case_text(transfer(text, repeat(' ', length)), 'text', case, error)
      if (allocated(error)) then
         status = error%status
         return
      end if
      if (allocated(simulation)) deallocate (simulation)
      simulation = new_simulation(case%scene, case%keep_history, case%keep_states)
      call simulation%run()
      status = simulation%outcome
   end function direct_start

   !> Increase the shift by an increment, length. Returns the status.
   integer(c_int) function direct_advance(increment) bind(C, name='direct_advance') result(status)
      real(c_double), value :: increment
      type(step_type) :: step

      step%control(motion_shift) = control_displacement
      step%target(motion_shift) = simulation%contact%state%fields%motion(motion_shift) + increment
      call simulation%advance(step)
      status = simulation%outcome
   end function direct_advance

   !> The tangential force now, force/length.
   real(c_double) function direct_force() bind(C, name='direct_force') result(force)
      force = simulation%contact%state%fields%force(motion_shift)
   end function direct_force

end module embedding_direct
