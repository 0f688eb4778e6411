!> Error bars from meshes: how far a value is from its limit, told from values on coarser meshes (Richardson 1911; Roache
!> 1994; least squares over several meshes as Eca and Hoekstra 2014). An edge of a contact or stick zone lies somewhere in
!> an interval, so that errors have the shape of a saw over the number of intervals. So no single pair of meshes is
!> believed: the bar is the mean square over all of them; and what the intervals leave open comes on top.
module mfv_error_bar
   use, intrinsic :: ieee_arithmetic, only: ieee_positive_inf, ieee_quiet_nan, ieee_value
   use mfv_kinds, only: wp
   implicit none
   private
   public :: error_bar_type, error_estimate_type, new_error_bar, unresolved_bar, quantity_count, quantity_half_width, &
             quantity_stick_ratio, quantity_peak_pressure, quantity_peak_shear, quantity_dissipation, lowest_order, highest_order

   !> What is estimated.
   integer, parameter :: quantity_half_width = 1, quantity_stick_ratio = 2, quantity_peak_pressure = 3, &
                         quantity_peak_shear = 4, quantity_dissipation = 5, quantity_count = 5

   !> A quantity with its bar.
   type :: error_bar_type
      !> Whether the scene has this quantity; and whether the mesh resolves what it depends on. Error and order of one that is not
      !> resolved are NaN: coarser meshes tell nothing of it.
      logical :: known = .false., resolved = .true.
      !> Its value on the finest mesh, and how far from that the limit of ever finer meshes may be: infinite where there is no
      !> limit. In the quantity's unit.
      real(wp) :: value = 0.0_wp, error = 0.0_wp
      !> Observed order of convergence, between lowest_order and highest_order; lowest_order where all that is observed is
      !> whole intervals; negative where there is no limit.
      real(wp) :: order = 0.0_wp
      !> Values on the coarser meshes, the finest first.
      real(wp), allocatable :: companions(:)
   end type error_bar_type

   !> The bars of a result.
   type :: error_estimate_type
      !> How it went (see mfv_status), MFV_COMPLETE where there are bars; and in words why there are none, else empty.
      integer :: status = 0
      character(:), allocatable :: message
      !> Intervals of the mesh, and of the coarser meshes, the finest first; as &mesh nodes counts them.
      integer :: nodes = 0
      integer, allocatable :: companion_nodes(:)
      type(error_bar_type) :: bar(quantity_count)
   end type error_estimate_type

   !> Orders that make sense: tractions and edges converge with the first, integrals with the second. One mesh's place in the
   !> saw can pretend any.
   real(wp), parameter :: lowest_order = 1.0_wp, highest_order = 2.0_wp
   !> Safety on Richardson's estimate; as is usual where three meshes and more take part (Roache 1994).
   real(wp), parameter :: safety = 1.25_wp
   !> A peak that grows from every mesh to the next with about the same power of the number of intervals, within this factor, has
   !> no limit where the power is between these: the edge of a flat punch grows with the power 1/2, and a traction whose sum is a
   !> force with less than 1.
   real(wp), parameter :: growth_factor = 1.5_wp, least_growth = 0.2_wp, most_growth = 1.0_wp
   !> Meshes that such a claim takes.
   integer, parameter :: fewest_growing = 3
   !> Numbers of intervals times their width are equal to within this.
   real(wp), parameter :: round_off = 1.0e-12_wp

contains

   !> The bar of a quantity with `values` on meshes of `nodes` intervals, the finest first, shape (2 or more). `allowances`:
   !> what the interval leaves open on each of the meshes, in the unit of the values, shape of values. `counted`: whether the
   !> values are numbers of intervals, so that differences that the allowances explain say nothing. `bounded`: whether the
   !> quantity always has a limit.
   pure type(error_bar_type) function new_error_bar(nodes, values, allowances, counted, bounded) result(bar)
      integer, intent(in) :: nodes(:)
      real(wp), intent(in) :: values(:), allowances(:)
      logical, intent(in) :: counted, bounded
      real(wp), dimension(size(values) - 1) :: ratio, difference
      real(wp) :: scatter

      bar%known = .true.
      bar%value = values(1)
      bar%companions = values(2:)
      if (.not. bounded .and. grows(nodes, abs(values))) then
         bar%order = -log(abs(values(1)/values(size(values))))/log(real(nodes(1), wp)/nodes(size(nodes)))
         bar%error = ieee_value(1.0_wp, ieee_positive_inf)
         return
      end if
      ratio = real(nodes(1), wp)/nodes(2:)
      difference = abs(values(2:) - values(1))
      if (counted) difference = max(difference - allowances(2:) - allowances(1) - round_off*abs(values(1)), 0.0_wp)
      bar%order = observed_order(nodes, values)
      if (counted .and. .not. any(difference > 0.0_wp)) bar%order = lowest_order
      scatter = norm2(difference/(ratio**bar%order - 1.0_wp))/sqrt(real(size(difference), wp))
      bar%error = norm2([allowances(1), safety*scatter])
   end function new_error_bar

   !> Whether the values grow without end.
   pure logical function grows(nodes, values)
      integer, intent(in) :: nodes(:)
      real(wp), intent(in) :: values(:)
      real(wp) :: power(size(values) - 1)

      grows = .false.
      if (size(values) < fewest_growing .or. .not. all(values > 0.0_wp)) return
      power = log(values(:size(power))/values(2:))/log(real(nodes(:size(power)), wp)/nodes(2:))
      grows = minval(power) > least_growth .and. maxval(power) < min(most_growth, growth_factor*minval(power))
   end function grows

   !> The bar of a quantity of which coarser meshes tell nothing. `values`: as above.
   pure type(error_bar_type) function unresolved_bar(values) result(bar)
      real(wp), intent(in) :: values(:)

      bar%known = .true.
      bar%resolved = .false.
      bar%value = values(1)
      bar%error = ieee_value(1.0_wp, ieee_quiet_nan)
      bar%order = bar%error
      bar%companions = values(2:)
   end function unresolved_bar

   !> The order p, between lowest_order and highest_order, with which v0 + c/nodes^p comes nearest to the values, by least
   !> squares in which a mesh weighs as much as its errors are small.
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

   !> Weighted mean square that the best v0 + c/nodes^order leaves, relative to the values.
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
