!> Cost of the linear solvers, as measured by bench/measure.py (docs/performance.md), and the cheapest one.
module mfv_solver_costs
   use mfv_kinds, only: wp
   use mfv_scene, only: solver_dgesv, solver_fft, solver_reduced
   implicit none
   private
   public :: least_by_default, least_exact, least_leap, least_coupled_leap
   public :: cheapest_solver, seconds_of_solve, most_after_increments, most_coupled, most_one_way, most_apart, most_at_once, &
             most_at_once_coupled, most_bristles, most_bristles_coupled

   !> Seconds per linear solve with m unknown tractions in event stepping, including all other work: dgesv coefficient*m^3, reduced
   !> coefficient*m^2, fft coefficient*m*log2(m). Full coupling, one thread.
   real(wp), parameter :: dgesv_seconds = 1.3e-10_wp, reduced_seconds = 2.4e-10_wp, fft_seconds = 6.8e-8_wp

   !> Most nodes in contact for which linear_solver='auto' uses the reduced system; fft beyond. Measured times of reduced over fft
   !> on one machine (2026-11-22; m nodes in contact on n nodes, one thread, each pair in one process):
   !>
   !>     by events          coupled                Goodman                uncoupled
   !>     one patch          m 500: 0.23            m 512: 0.49            m 512: 0.89
   !>     (n = 2 m)          m 999: 0.51            m 1024: 0.68           m 1024: 0.90
   !>                        m 1463: 0.50           m 1500: 0.75           m 1500: 0.88
   !>     8 to 33 patches    m 217, n 2048: 0.14                           m 223, n 2048: 0.26
   !>                        m 526, n 2048: 0.20                           m 541, n 2048: 0.23
   !>                        m 270, n 8192: 0.14                           m 861, n 8192: 0.42
   !>
   !>     large increments   coupled                                       Goodman, uncoupled
   !>     one patch          m 192: 1.7 (pressed), 6.5 (cycles)            m 32: 0.8
   !>     (n = 2 m)          m 256: 1.7 (pressed)                          m 64: 1.2
   !>                                                                      m 128: 2.7
   !>     8 to 33 patches    m 221, n 2048: 0.40                           m 81, n 512: 0.9
   !>                        m 538, n 2048: 1.11                           m 223, n 2048: 2.7
   !>                        m 277, n 8192: 0.29                           m 541, n 2048: 14
   !>
   !> (Large increments of contacts that press and shear change many nodes at once: m 206: 0.81, m 308: 1.7, m 411: 3.0.)
   !>
   !>     Dahl friction      coupled                                       uncoupled
   !>     (n = 2 m)          m 18: 0.12                                    m 64: 0.53
   !>                        m 125: 0.44                                   m 128: 1.1
   !>                                                                      m 256: 2.7
   !>
   !> In event stepping the limit is that of memory (100 MB coupled, else 2*30 MB) rather than of time.
   integer, parameter :: most_coupled = 1800, most_one_way = 2000, most_apart = 2000, most_at_once = 60, &
                         most_at_once_coupled = 100, most_bristles = 120, most_bristles_coupled = 260

   !> Most nodes in contact for the reduced system in an interval that is followed by events because large increments are too many
   !> or not accurate: the system is factorised anew for some hundred events.
   integer, parameter :: most_after_increments = 1000

   !> Fewest nodes of the mesh for which stepping='auto' takes large increments if an error is allowed. They take 40 to 200 solves
   !> to press with friction and coupling and 20 to 60 for a half-cycle, on any mesh, events about one for each node that
   !> changes its status (docs/performance.md). Without coupling they take 4 solves.
   integer, parameter :: least_leap = 30, least_coupled_leap = 384

   !> Fewest nodes of the mesh for which large increments may have an error although no accuracy is given; and for which exact ones,
   !> with the records of their history, take fewer solves than events.
   integer, parameter :: least_by_default = 384, least_exact = 128

contains

   !> The cheapest solver for a number of unknown tractions.
   pure integer function cheapest_solver(unknowns) result(solver)
      real(wp), intent(in) :: unknowns

      solver = solver_dgesv
      if (seconds_of_solve(solver_reduced, unknowns) < seconds_of_solve(solver, unknowns)) solver = solver_reduced
      if (seconds_of_solve(solver_fft, unknowns) < seconds_of_solve(solver, unknowns)) solver = solver_fft
   end function cheapest_solver

   !> Approximate seconds per linear solve.
   pure real(wp) function seconds_of_solve(solver, unknowns) result(seconds)
      integer, intent(in) :: solver
      real(wp), intent(in) :: unknowns

      select case (solver)
      case (solver_reduced)
         seconds = reduced_seconds*unknowns**2
      case (solver_fft)
         seconds = fft_seconds*unknowns*log(max(unknowns, 2.0_wp))/log(2.0_wp)
      case default
         seconds = dgesv_seconds*unknowns**3
      end select
   end function seconds_of_solve

end module mfv_solver_costs
