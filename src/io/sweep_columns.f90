!> The columns of a sweep's table: the one list of their names, units and meanings, in order.
module mfv_sweep_columns
   use mfv_observables
   use mfv_result_fields, only: labelled_unit
   use mfv_sweep_plan
   implicit none
   private
   public :: column_type, list_columns
   public :: from_case, from_base, from_axis, from_outcome, from_status, from_message, from_steps, from_events, from_solves, &
             from_nodes, from_residual, from_observable, from_pressure_error, from_shear_error, from_dissipation_ratio

   !> Where the values of a column come from.
   integer, parameter :: from_case = 1, from_base = 2, from_axis = 3, from_outcome = 4, from_status = 5, from_message = 6, &
                         from_steps = 7, from_events = 8, from_solves = 9, from_nodes = 10, from_residual = 11, &
                         from_observable = 12, from_pressure_error = 13, from_shear_error = 14, from_dissipation_ratio = 15

   type :: column_type
      character(:), allocatable :: name, unit, meaning
      !> column_real, column_whole or column_text.
      integer :: kind = column_real
      !> Where from, and which axis, observable or moment.
      integer :: source = 0, number = 0
   end type column_type

contains

   !> All columns of a sweep.
   subroutine list_columns(sweep, columns)
      type(sweep_type), intent(in) :: sweep
      type(column_type), allocatable, intent(out) :: columns(:)
      integer :: i

      allocate (columns(0))
      call add(columns, 'case', column_whole, '1', 'number of the case', from_case)
      call add(columns, 'base', column_text, '1', 'base case', from_base)
      do i = 1, size(sweep%axes)
         associate (axis => sweep%axes(i))
            call add(columns, axis%name, axis%column, labelled_unit(axis%unit, sweep%length_unit, sweep%force_unit), &
                     axis%meaning, from_axis, i)
         end associate
      end do
      call add(columns, 'outcome', column_text, '1', 'how the case ended', from_outcome)
      call add(columns, 'status', column_whole, '1', 'the same as a code, 0 for complete (mfv_status.def)', from_status)
      call add(columns, 'message', column_text, '1', 'the same in words', from_message)
      call add(columns, 'steps_done', column_whole, '1', 'steps of the load history that were reached', from_steps)
      call add(columns, 'events', column_whole, '1', 'loads at which nodes changed their status', from_events)
      call add(columns, 'linear_solves', column_whole, '1', 'linear solves', from_solves)
      call add(columns, 'nodes', column_whole, '1', 'nodes of the mesh', from_nodes)
      call add(columns, 'largest_residual', column_real, '1', 'largest relative residual of the certificate', from_residual)
      do i = 1, observable_count
         call add(columns, observable_name(i), column_real, &
                  labelled_unit(observable_unit(i), sweep%length_unit, sweep%force_unit), observable_meaning(i), from_observable, i)
      end do
      if (sweep%has_reference) call add_errors(columns)
   end subroutine list_columns

   !> Differences from the case of full coupling.
   subroutine add_errors(columns)
      type(column_type), allocatable, intent(inout) :: columns(:)
      integer :: i

      do i = 1, moment_count
         call add(columns, 'pressure_error_'//moment_name(i), column_real, '1', 'L1 difference of the pressures from those '// &
                  'of full coupling, relative to them, at the moment '//moment_name(i)//' (eq. 6.6)', from_pressure_error, i)
         call add(columns, 'shear_error_'//moment_name(i), column_real, '1', 'L1 difference of the shear tractions from '// &
                  'those of full coupling, relative to them, at the moment '//moment_name(i)//' (eq. 6.6)', from_shear_error, i)
      end do
      call add(columns, 'dissipation_ratio', column_real, '1', 'cycle_dissipation over that of full coupling', &
               from_dissipation_ratio)
   end subroutine add_errors

   subroutine add(columns, name, kind, unit, meaning, source, number)
      type(column_type), allocatable, intent(inout) :: columns(:)
      character(*), intent(in) :: name, unit, meaning
      integer, intent(in) :: kind, source
      integer, intent(in), optional :: number
      type(column_type), allocatable :: longer(:)
      integer :: i, n

      n = size(columns)
      allocate (longer(n + 1))
      do i = 1, n
         longer(i) = columns(i)
      end do
      longer(n + 1)%name = name
      longer(n + 1)%kind = kind
      longer(n + 1)%unit = unit
      longer(n + 1)%meaning = meaning
      longer(n + 1)%source = source
      if (present(number)) longer(n + 1)%number = number
      call move_alloc(longer, columns)
   end subroutine add

end module mfv_sweep_columns
