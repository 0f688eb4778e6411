!> Error bars by Richardson extrapolation from several meshes (Richardson 1911; Roache 1994; least squares as in Eca and
!> Hoekstra 2014). Edges of contact and stick zones lie anywhere in an interval: errors jump from one number of intervals to
!> the next. The bar is therefore a mean square over all meshes, plus the uncertainty within an interval.
module mfv_error_bar
   use, intrinsic :: ieee_arithmetic, only: ieee_positive_inf, ieee_quiet_nan, ieee_value
   use mfv_kinds, only: wp
   implicit none
   private
   public :: error_bar_type, error_estimate_type, new_error_bar, unresolved_bar, logarithmic_bar, highest_order

   !> A quantity with its error bar.
   type :: error_bar_type
      !> Whether the scene has this quantity, and whether the mesh resolves what it depends on. If not resolved, error and
      !> order are NaN.
      logical :: known = .false., resolved = .true.
      !> Value on the finest mesh, and estimated distance to its limit under mesh refinement, infinite without a limit; in the
      !> unit of the quantity.
      real(wp) :: value = 0.0_wp, error = 0.0_wp
      !> Observed order of convergence, between lowest_order and highest_order; lowest_order if the value depends on edges;
      !> negative, or 0 if it grows as a logarithm, without a limit.
      real(wp) :: order = 0.0_wp
      !> Values on the coarser meshes, finest first.
      real(wp), allocatable :: coarser_values(:)
   end type error_bar_type

   !> The error bars of a result.
   type :: error_estimate_type
      !> Status (see mfv_status), MFV_COMPLETE with error bars; message: why there are none, else empty.
      integer :: status = 0
      character(:), allocatable :: message
      !> A warning if the coarser meshes do not allow error bars; else empty.
      character(:), allocatable :: doubt
      !> Intervals of the mesh and of the coarser meshes, finest first; as &mesh nodes.
      integer :: nodes = 0
      integer, allocatable :: coarser_nodes(:)
      !> Of every observable, in their order (see mfv_observables).
      type(error_bar_type), allocatable :: bar(:)
   end type error_estimate_type

   !> Accepted orders: tractions and edges converge with order 1, integrals with 2. The sawtooth can simulate any order.
   real(wp), parameter :: lowest_order = 1.0_wp, highest_order = 2.0_wp
   !> Safety factor on Richardson's estimate: 1.25 is usual for three and more meshes where the order is known (Roache 1994).
   real(wp), parameter :: safety = 1.6_wp
   !> A peak diverges if it grows with a power of the number of intervals between these, equal from mesh to mesh to within
   !> this factor: 1/2 at the edge of a flat punch, below 1 for any finite force.
   real(wp), parameter :: growth_factor = 1.5_wp, least_growth = 0.2_wp, most_growth = 1.0_wp
   !> Number of meshes needed to call a peak divergent.
   integer, parameter :: fewest_growing = 3
   !> Tolerance for equal lengths, number of intervals times their width.
   real(wp), parameter :: tolerance = 1.0e-12_wp

contains

   !> Error bar of a quantity with `values` on meshes of `nodes` intervals, finest first, shape (2 or more). `allowances`:
   !> uncertainty within an interval on each mesh, in the unit of the values, shape of values. `by_edges`: values depend on
   !> edges of zones, whose errors jump from mesh to mesh: differences below the allowances have no
   !> significance. `smooth`: of up to second order. `bounded`: the quantity always has a limit.
   pure type(error_bar_type) function new_error_bar(nodes, values, allowances, by_edges, smooth, bounded) result(bar)
      integer, intent(in) :: nodes(:)
      real(wp), intent(in) :: values(:), allowances(:)
      logical, intent(in) :: by_edges, smooth, bounded
      real(wp), dimension(size(values) - 1) :: ratio, difference
      real(wp) :: scatter, own

      bar%known = .true.
      bar%value = values(1)
      bar%coarser_values = values(2:)
      if (.not. bounded .and. grows(nodes, abs(values))) then
         bar%order = -log(abs(values(1)/values(size(values))))/log(real(nodes(1), wp)/nodes(size(nodes)))
         bar%error = ieee_value(1.0_wp, ieee_positive_inf)
         return
      end if
      ratio = real(nodes(1), wp)/nodes(2:)
      difference = abs(values(2:) - values(1))
      if (by_edges) difference = max(difference - allowances(2:) - allowances(1) - tolerance*abs(values(1)), 0.0_wp)
      bar%order = lowest_order
      if (smooth) bar%order = observed_order(nodes, values)
      scatter = norm2(difference/(ratio**bar%order - 1.0_wp))/sqrt(real(size(difference), wp))
      ! An edge that this mesh alone seems to know well does so by chance.
      own = allowances(1)
      if (by_edges) own = max(own, minval(allowances(2:)/ratio**2))
      bar%error = norm2([own, safety*scatter])
   end function new_error_bar

   !> Whether the values diverge.
   pure logical function grows(nodes, values)
      integer, intent(in) :: nodes(:)
      real(wp), intent(in) :: values(:)
      real(wp) :: power(size(values) - 1)

      grows = .false.
      if (size(values) < fewest_growing .or. .not. all(values > 0.0_wp)) return
      power = log(values(:size(power))/values(2:))/log(real(nodes(:size(power)), wp)/nodes(2:))
      grows = minval(power) > least_growth .and. maxval(power) < min(most_growth, growth_factor*minval(power))
   end function grows

   !> A quantity that grows with the logarithm of the number of intervals. `values`: as above.
   pure type(error_bar_type) function logarithmic_bar(values) result(bar)
      real(wp), intent(in) :: values(:)

      bar%known = .true.
      bar%value = values(1)
      bar%error = ieee_value(1.0_wp, ieee_positive_inf)
      bar%coarser_values = values(2:)
   end function logarithmic_bar

   !> A quantity that the mesh, or a coarser one, does not resolve (mfv_resolution). `values`: as above.
   pure type(error_bar_type) function unresolved_bar(values) result(bar)
      real(wp), intent(in) :: values(:)

      bar%known = .true.
      bar%resolved = .false.
      bar%value = values(1)
      bar%error = ieee_value(1.0_wp, ieee_quiet_nan)
      bar%order = bar%error
      bar%coarser_values = values(2:)
   end function unresolved_bar

   !> Order p, between lowest_order and highest_order, of the best fit v0 + c/nodes^p to the values. Weighted least squares: a
   !> mesh with smaller errors has a larger weight.
   pure real(wp) function observed_order(nodes, values) result(order)
      integer, intent(in) :: nodes(:)
      real(wp), intent(in) :: values(:)
      integer, parameter :: parts = 40
      real(wp) :: misfit, least, trial
      integer :: i

      order = highest_order
      least = huge(least)
      do i = parts, 0, -1
         trial = lowest_order + i*(highest_order - lowest_order)/parts
         misfit = misfit_of(nodes, values, trial)
         if (.not. misfit < least) cycle
         least = misfit
         order = trial
      end do
   end function observed_order

   !> Weighted mean square residual of the best v0 + c/nodes^order, relative to the values.
   pure real(wp) function misfit_of(nodes, values, order) result(misfit)
      integer, intent(in) :: nodes(:)
      real(wp), intent(in) :: values(:), order
      real(wp), dimension(size(values)) :: step, weight, deviation
      real(wp) :: mean_step, mean_value, slope, scale

      misfit = 0.0_wp
      scale = maxval(abs(values))
      if (.not. scale > 0.0_wp) return
      step = (real(nodes(1), wp)/nodes)**order
      weight = 1.0_wp/step**2
      mean_step = sum(weight*step)/sum(weight)
      mean_value = sum(weight*values/scale)/sum(weight)
      slope = sum(weight*(step - mean_step)*(values/scale - mean_value))/sum(weight*(step - mean_step)**2)
      deviation = values/scale - mean_value - slope*(step - mean_step)
      misfit = sum(weight*deviation**2)/sum(weight)
   end function misfit_of

end module mfv_error_bar
