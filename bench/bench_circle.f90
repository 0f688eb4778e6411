!> Time and error of the circle's kernels, exact and by Fourier series, and what share of a run they are. Writes lines of
!> comma-separated values for bench/circle.py:
!>
!>     kernels,<body>,<intervals on the circle>,<window>,<harmonics per interval, 0: exact>,<seconds>,<largest relative error>
!>     run,<intervals on the circle>,<nodes in contact>,<kernel>,<seconds assembly>,<seconds in all>,<linear solves>
module bench_circle
   use, intrinsic :: iso_fortran_env, only: output_unit
   use mfv_body, only: new_body
   use mfv_geometry, only: new_disk, new_half_plane_surface
   use mfv_circle, only: kernel_exact, kernel_fourier
   use mfv_circle_kernels
   use mfv_clock, only: seconds_now
   use mfv_friction, only: uniform_friction
   use mfv_kinds, only: pi, wp
   use mfv_material, only: new_material, plane_strain
   use mfv_motions, only: motion_approach, motion_shift, control_force
   use mfv_scene, only: scene_type, solver_dgesv, step_type
   use mfv_simulation, only: history_none, new_simulation, simulation_type
   implicit none
   private
   public :: measure_circle_kernels

   integer, parameter :: circles(5) = [1000, 10000, 100000, 1000000, 10000000], window = 500
   integer, parameter :: multiples(4) = [1, 4, 16, 64], largest_series = 160000000
   real(wp), parameter :: kappa = 1.8_wp
contains

   !> Everything, on one line each.
   subroutine measure_circle_kernels()
      integer :: i, j

      do i = 1, size(circles)
         call measure(circles(i), 0)
         do j = 1, size(multiples)
            if (real(multiples(j), wp)*circles(i) <= largest_series) call measure(circles(i), multiples(j))
         end do
      end do
      do i = 1, 4
         call run(circles(i), kernel_exact)
         call run(circles(i), kernel_fourier)
      end do
   end subroutine measure_circle_kernels

   !> Kernels of a disk: time, the best of three, and error against the closed form.
   subroutine measure(circle, multiple)
      integer, intent(in) :: circle, multiple
      type(circle_kernels_type) :: kernels, exact
      real(wp) :: seconds, started
      integer :: repeat

      seconds = huge(1.0_wp)
      do repeat = 1, 3
         started = seconds_now()
         if (multiple == 0) then
            kernels = exact_kernels(body_disk, kappa, 2*pi/circle, window)
         else
            kernels = fourier_kernels(body_disk, kappa, circle, multiple*circle, window)
         end if
         seconds = min(seconds, seconds_now() - started)
         if (seconds > 1.0_wp) exit
      end do
      exact = exact_kernels(body_disk, kappa, 2*pi/circle, window)
      write (output_unit, '(a,3(i0,a),es12.5,a,es12.5)') 'kernels,disk,', circle, ',', window, ',', multiple, ',', seconds, ',', &
         max(maxval(abs(kernels%radial - exact%radial)), maxval(abs(kernels%cross - exact%cross)), &
             maxval(abs(kernels%tangential - exact%tangential)))/maxval(abs(exact%radial))
   end subroutine measure

   !> A frictional run with about a hundred nodes in contact on any circle.
   subroutine run(circle, kernel)
      integer, intent(in) :: circle, kernel
      type(scene_type) :: scene
      type(simulation_type) :: simulation
      type(step_type) :: step
      real(wp) :: half_width, started, seconds

      half_width = 50*2*pi/circle
      scene%title = 'bench'
      scene%lower = new_body(new_disk(1.0_wp))
      scene%lower%rigid = .false.
      scene%lower%elasticity%datum = 1.0_wp
      scene%lower%elasticity%material = new_material(1.0_wp, 0.3_wp, plane_strain)
      scene%lower%elasticity%kernel = kernel
      scene%upper = new_body(new_half_plane_surface())
      scene%mesh%nodes = circle
      scene%mesh%whole_circle = .true.
      scene%friction = uniform_friction('coulomb', 0.3_wp, 0.3_wp)
      scene%method%linear_solver = solver_dgesv
      step%control(motion_approach) = control_force
      step%target(motion_approach) = half_width**2*pi*scene%modulus()/2
      step%control(motion_shift) = control_force
      step%target(motion_shift) = 0.1_wp*step%target(motion_approach)
      scene%steps = [step]
      started = seconds_now()
      simulation = new_simulation(scene, history_none)
      call simulation%run()
      seconds = seconds_now() - started
      write (output_unit, '(a,i0,a,i0,a,a,a,es12.5,a,es12.5,a,i0)') 'run,', circle, ',', &
         simulation%contact%state%contact_nodes(), ',', trim(merge('exact  ', 'fourier', kernel == kernel_exact)), ',', &
         simulation%contact%model%assembly_seconds, ',', seconds, ',', simulation%contact%system%solves
   end subroutine run

end module bench_circle
