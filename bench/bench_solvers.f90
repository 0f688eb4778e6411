!> Cost of an event with each linear solver. Arguments: nodes in contact (about), linear solver, cycles, repeats. Writes a line:
!>
!>     events,<solver>,<nodes in contact>,<events>,<solves>,<iterations>,<seconds, best>,<Q traction norm>,<certificate>
program bench_solvers
   use, intrinsic :: iso_fortran_env, only: output_unit
   use mfv_body, only: new_disk, new_half_plane_body
   use mfv_clock, only: seconds_now
   use mfv_friction, only: coulomb_friction
   use mfv_kinds, only: pi, wp
   use mfv_material, only: new_material, plane_strain
   use mfv_reduced_system, only: reduced_system_type
   use mfv_scene
   use mfv_simulation, only: history_none, new_simulation, simulation_type
   implicit none
   character(len=32) :: argument, solver
   integer :: contact, cycles, repeats, i
   real(wp) :: best, started
   type(scene_type) :: scene
   type(simulation_type) :: simulation

   call get_command_argument(1, argument)
   read (argument, *) contact
   call get_command_argument(2, solver)
   call get_command_argument(3, argument)
   read (argument, *) cycles
   call get_command_argument(4, argument)
   read (argument, *) repeats
   call make_scene()
   best = huge(1.0_wp)
   do i = 1, repeats
      started = seconds_now()
      simulation = new_simulation(scene, history_none, .false.)
      call simulation%run()
      best = min(best, seconds_now() - started)
   end do
   write (output_unit, '(a,a,a,3(i0,a),es12.5,a,es22.15,a,es9.2,a,i0)') 'events,', trim(solver), ',', &
      simulation%contact%state%contact_nodes(), ',', simulation%contact%events, ',', simulation%contact%system%solves, ',', &
      best, ',', norm2(simulation%contact%state%fields%shear), ',', simulation%contact%certificate%largest(), ',', &
      simulation%outcome
   select type (system => simulation%contact%system)
   type is (reduced_system_type)
      write (output_unit, '(a,2(1x,i0))') 'refinements, rebuilds', system%refinements, system%rebuilds()
   end select

contains

   subroutine make_scene()
      scene%title = 'bench'
      scene%lower = new_half_plane_body()
      scene%lower%rigid = .false.
      scene%lower%datum = 0.25_wp
      scene%lower%material = new_material(1.0_wp, 0.3_wp, plane_strain)
      scene%upper = new_disk(0.25_wp)
      scene%upper%rigid = .true.
      scene%mesh%nodes = nint(1.2_wp*contact)
      scene%friction = coulomb_friction(0.5_wp)
      allocate (scene%steps(merge(1, 2, cycles == 0)))
      scene%steps(1)%normal_control = control_force
      scene%steps(1)%normal_target = 1.0e-3_wp
      if (cycles > 0) then
         scene%steps(2)%tangential_control = control_force
         scene%steps(2)%tangential_target = 3.0e-4_wp
         scene%steps(2)%cycles = cycles
      end if
      select case (solver)
      case ('dgesv')
         scene%method%linear_solver = solver_dgesv
      case ('reduced')
         scene%method%linear_solver = solver_reduced
      case ('fft')
         scene%method%linear_solver = solver_fft
      end select
   end subroutine make_scene

end program bench_solvers
