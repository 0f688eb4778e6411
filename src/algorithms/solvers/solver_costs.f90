!> Cost of the linear solvers, as measured by bench/measure.py (docs/performance.md), and the cheapest one.
module mfv_solver_costs
   use mfv_kinds, only: wp
   use mfv_scene, only: solver_dgesv, solver_fft, solver_reduced
   implicit none
   private
   public :: least_leap, least_coupled_leap
   public :: cheapest_solver, seconds_of_solve, most_coupled, most_one_way, most_apart, most_at_once, &
             most_bristles

   !> Seconds per linear solve with m unknown tractions in event stepping, including all other work: dgesv coefficient*m^3, reduced
   !> coefficient*m^2, fft coefficient*m*log2(m). Full coupling, one thread.
   real(wp), parameter :: dgesv_seconds = 1.3e-10_wp, reduced_seconds = 2.4e-10_wp, fft_seconds = 6.8e-8_wp

   !> Most nodes for which linear_solver='auto' uses the reduced system; fft beyond. Event stepping: pressures and shear coupled,
   !> coupled one way (Goodman), and uncoupled (in the last two cases fft has an exact inverse on a half-plane). Without events and
   !> without coupling, where the reduced system has little to update. With bristles, whose rows change in every increment, or
   !> large increments with coupling.
   integer, parameter :: most_coupled = 1800, most_one_way = 1400, most_apart = 900, most_at_once = 100, most_bristles = 300

   !> Fewest nodes of the mesh for which stepping='auto' takes large increments if an error is allowed. They take some 100 solves to
   !> press with friction and coupling and 20 to 60 for a half-cycle, on any mesh, events about one for each node that changes its
   !> status (docs/performance.md). Without coupling they take 4 solves.
   integer, parameter :: least_leap = 30, least_coupled_leap = 640

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
