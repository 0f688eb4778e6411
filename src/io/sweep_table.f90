!> The table of a sweep: one HDF5 file with the compound dataset /table, a row a case. The same bytes whoever computed the rows,
!> in whatever order: no times, no dates, no names of machines are in it. docs/sweep.md describes it.
module mfv_sweep_table
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite, ieee_quiet_nan, ieee_value
   use, intrinsic :: iso_c_binding, only: c_loc
   use, intrinsic :: iso_fortran_env, only: int32, int64, int8
   use hdf5
   use mfv_error, only: error_type, set_error
   use mfv_hdf5_reader, only: close_read, has, open_to_read, read_text_attribute, read_whole_attribute
   use mfv_hdf5_writer
   use mfv_kinds, only: wp
   use mfv_observables
   use mfv_status
   use mfv_strings, only: string_type, to_text
   use mfv_sweep_columns
   use mfv_sweep_plan
   use mfv_sweep_record, only: record_type
   use mfv_version, only: library_version
   implicit none
   private
   public :: write_table, find_table, check_place, no_table, other_table, part_table, same_table, table_checksum, states_name

   !> What is at the place of a table: nothing that counts; something of another sweep or no table; an incomplete table; the
   !> complete table of this sweep.
   integer, parameter :: no_table = 0, other_table = 1, part_table = 2, same_table = 3
   type(file_kind_type), parameter :: table_kind = file_kind_type('table of mfv_sweep', 'input_checksum')
   !> Bytes that a message may have.
   integer, parameter :: longest_message = 500
   integer, parameter :: bytes_of_real = 8, bytes_of_whole = 4

   !> Where a column is in a row.
   type :: layout_type
      integer :: offset = 0, length = 0
   end type layout_type

contains

   !> Write the table of a sweep with the records that are there to its file. Error MFV_FILE_ERROR; what was there before is
   !> then still there.
   subroutine write_table(sweep, records, error)
      type(sweep_type), intent(in) :: sweep
      type(record_type), intent(in) :: records(:)
      type(error_type), allocatable, intent(out) :: error
      type(writer_type) :: writer

      call create_file(sweep%result_path, table_kind, writer, error)
      if (allocated(error)) return
      if (writer%code == 0) then
         call write_file_attributes(writer, sweep, records)
         call write_rows(writer, sweep, records)
         if (sweep%keeps_states) call write_links(writer, sweep, records)
      end if
      call finish_file(sweep%result_path, 'the table', writer, error)
   end subroutine write_table

   !> Whether the table can be written to its place. Error MFV_INPUT_ERROR where not, or where there is a file that is no table
   !> of a sweep: the result of a case, for one, is not replaced.
   subroutine check_place(sweep, error)
      type(sweep_type), intent(in) :: sweep
      type(error_type), allocatable, intent(out) :: error

      call check_writable(sweep%result_path, table_kind, error)
      if (allocated(error)) error%message = sweep%source//": &sweep file='"//sweep%result_path//"': "//error%message
   end subroutine check_place

   !> What is at the place of a sweep's table.
   subroutine find_table(sweep, state)
      type(sweep_type), intent(in) :: sweep
      integer, intent(out) :: state
      character(:), allocatable :: checksum
      type(error_type), allocatable :: error
      integer(hid_t) :: file
      integer :: complete
      logical :: is_there

      inquire (file=sweep%result_path, exist=is_there)
      state = merge(other_table, no_table, is_there)
      if (.not. is_there) return
      call open_to_read(sweep%result_path, file, error)
      if (allocated(error)) return
      if (has(file, 'table')) then
         call read_text_attribute(file, 'input_checksum', checksum, error)
         if (.not. allocated(error)) call read_whole_attribute(file, 'complete', complete, error)
         if (.not. allocated(error)) then
            if (complete == 0) then
               state = part_table
            else if (checksum == table_checksum(sweep)) then
               state = same_table
            end if
         end if
      end if
      call close_read(file)
   end subroutine find_table

   !> The checksum of a sweep in hexadecimal digits.
   pure function table_checksum(sweep) result(text)
      type(sweep_type), intent(in) :: sweep
      character(len=16) :: text

      write (text, '(z16.16)') sweep%checksum
   end function table_checksum

   !> Name of the whole result of case `number` in the folder of the states: 000017.
   pure function states_name(number) result(name)
      integer, intent(in) :: number
      character(len=len_trim(padded_name(number))) :: name

      name = padded_name(number)
   end function states_name

   pure function padded_name(number) result(name)
      integer, intent(in) :: number
      character(len=12) :: name

      write (name, '(i6.6)') number
      if (number > 999999) name = to_text(number)
   end function padded_name

   !> Attributes of the whole file.
   subroutine write_file_attributes(writer, sweep, records)
      type(writer_type), intent(inout) :: writer
      type(sweep_type), intent(in) :: sweep
      type(record_type), intent(in) :: records(:)
      character(:), allocatable :: outcome
      integer :: i, j, number

      call write_text(writer, writer%file, 'title', 'Sweep over cases of frictional contact')
      call write_text(writer, writer%file, 'input', sweep%text)
      call write_text(writer, writer%file, 'input_checksum', table_checksum(sweep))
      do i = 1, size(sweep%bases)
         call write_text(writer, writer%file, 'base_'//to_text(i), sweep%bases(i)%text)
         call write_text(writer, writer%file, 'base_'//to_text(i)//'_file', sweep%bases(i)%name)
      end do
      call write_text(writer, writer%file, 'length_unit', sweep%length_unit)
      call write_text(writer, writer%file, 'force_unit', sweep%force_unit)
      call write_text(writer, writer%file, 'mfv_version', library_version)
      call write_hdf5_version(writer)
      number = count(records%number > 0)
      call write_whole(writer, writer%file, 'complete', merge(1, 0, number == size(records)))
      call write_whole(writer, writer%file, 'cases', size(records))
      call write_whole(writer, writer%file, 'cases_done', number)
      do i = 0, maxval(records%outcome)
         number = count(records%number > 0 .and. records%outcome == i)
         if (number == 0) cycle
         outcome = status_outcome(i)
         do j = 1, len(outcome)
            if (outcome(j:j) == ' ') outcome(j:j) = '_'
         end do
         call write_whole(writer, writer%file, 'cases_'//outcome, number)
      end do
   end subroutine write_file_attributes

   !> The dataset /table.
   subroutine write_rows(writer, sweep, records)
      type(writer_type), intent(inout) :: writer
      type(sweep_type), intent(in) :: sweep
      type(record_type), intent(in) :: records(:)
      type(column_type), allocatable :: columns(:)
      type(layout_type), allocatable :: layout(:)
      integer(int8), allocatable, target :: rows(:)
      integer(hid_t) :: stored, native, space, properties, dataset
      integer(hsize_t) :: extent(1)
      integer :: code

      call list_columns(sweep, columns)
      call lay_out(sweep, records, columns, layout)
      call fill_rows(sweep, records, columns, layout, rows)
      call make_type(writer, columns, layout, .true., stored)
      call make_type(writer, columns, layout, .false., native)
      extent = count(records%number > 0)
      call h5screate_simple_f(1, extent, space, code)
      call note(writer, code)
      ! No time of writing is kept: the bytes would not be the same twice.
      call h5pcreate_f(H5P_DATASET_CREATE_F, properties, code)
      call h5pset_obj_track_times_f(properties, .false., code)
      call note(writer, code)
      call h5dcreate_f(writer%file, '/table', stored, space, dataset, code, properties)
      call note(writer, code)
      if (code == 0) then
         if (size(rows) > 0) call h5dwrite_f(dataset, native, c_loc(rows), code)
         call note(writer, code)
         call describe_columns(writer, dataset, columns)
         call h5dclose_f(dataset, code)
      end if
      call h5pclose_f(properties, code)
      call h5sclose_f(space, code)
      call h5tclose_f(native, code)
      call h5tclose_f(stored, code)
   end subroutine write_rows

   !> Names, units and meanings of the columns, in order, as attributes of the table.
   subroutine describe_columns(writer, dataset, columns)
      type(writer_type), intent(inout) :: writer
      integer(hid_t), intent(in) :: dataset
      type(column_type), intent(in) :: columns(:)
      type(string_type) :: names(size(columns)), units(size(columns)), meanings(size(columns))
      integer :: i

      do i = 1, size(columns)
         names(i)%text = columns(i)%name
         units(i)%text = columns(i)%unit
         meanings(i)%text = columns(i)%meaning
      end do
      call write_texts(writer, dataset, 'columns', names)
      call write_texts(writer, dataset, 'units', units)
      call write_texts(writer, dataset, 'long_names', meanings)
   end subroutine describe_columns

   !> Where each column is in a row: texts are as wide as the longest needs.
   subroutine lay_out(sweep, records, columns, layout)
      type(sweep_type), intent(in) :: sweep
      type(record_type), intent(in) :: records(:)
      type(column_type), intent(in) :: columns(:)
      type(layout_type), allocatable, intent(out) :: layout(:)
      character(:), allocatable :: text
      integer :: i, j, offset

      allocate (layout(size(columns)))
      offset = 0
      do i = 1, size(columns)
         layout(i)%offset = offset
         select case (columns(i)%kind)
         case (column_real)
            layout(i)%length = bytes_of_real
         case (column_whole)
            layout(i)%length = bytes_of_whole
         case default
            layout(i)%length = 1
            do j = 1, size(records)
               if (records(j)%number == 0) cycle
               call find_text(sweep, records(j), columns(i), text)
               layout(i)%length = max(layout(i)%length, len(text))
            end do
         end select
         offset = offset + layout(i)%length
      end do
   end subroutine lay_out

   !> The HDF5 type of a row: as it is stored, the same on every machine, or as it is in memory.
   subroutine make_type(writer, columns, layout, is_stored, row)
      type(writer_type), intent(inout) :: writer
      type(column_type), intent(in) :: columns(:)
      type(layout_type), intent(in) :: layout(:)
      logical, intent(in) :: is_stored
      integer(hid_t), intent(out) :: row
      integer(hid_t) :: text
      integer :: i, code

      call h5tcreate_f(H5T_COMPOUND_F, int(sum(layout%length), size_t), row, code)
      call note(writer, code)
      do i = 1, size(columns)
         select case (columns(i)%kind)
         case (column_real)
            call h5tinsert_f(row, columns(i)%name, int(layout(i)%offset, size_t), &
                             merge(H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, is_stored), code)
         case (column_whole)
            call h5tinsert_f(row, columns(i)%name, int(layout(i)%offset, size_t), &
                             merge(H5T_STD_I32LE, H5T_NATIVE_INTEGER, is_stored), code)
         case default
            call h5tcopy_f(H5T_C_S1, text, code)
            call h5tset_size_f(text, int(layout(i)%length, size_t), code)
            call h5tset_cset_f(text, H5T_CSET_UTF8_F, code)
            call h5tset_strpad_f(text, H5T_STR_NULLPAD_F, code)
            call h5tinsert_f(row, columns(i)%name, int(layout(i)%offset, size_t), text, code)
            call note(writer, code)
            call h5tclose_f(text, code)
         end select
         call note(writer, code)
      end do
   end subroutine make_type

   !> All rows one after another.
   subroutine fill_rows(sweep, records, columns, layout, rows)
      type(sweep_type), intent(in) :: sweep
      type(record_type), intent(in) :: records(:)
      type(column_type), intent(in) :: columns(:)
      type(layout_type), intent(in) :: layout(:)
      integer(int8), allocatable, intent(out) :: rows(:)
      real(wp) :: errors(2, moment_count)
      integer(int64) :: row, at
      integer :: i, j

      allocate (rows(count(records%number > 0)*int(sum(layout%length), int64)))
      rows = 0
      row = 0
      do i = 1, size(records)
         if (records(i)%number == 0) cycle
         if (sweep%has_reference) call compare(records, sweep%reference_of(i), i, errors)
         do j = 1, size(columns)
            at = row*sum(layout%length) + layout(j)%offset
            call fill(sweep, records, i, columns(j), errors, rows(at + 1:at + layout(j)%length))
         end do
         row = row + 1
      end do
   end subroutine fill_rows

   !> The value of one column in the row of case `number`, as bytes. `errors`: of pressure and shear, shape (2, moment_count).
   subroutine fill(sweep, records, number, column, errors, bytes)
      type(sweep_type), intent(in) :: sweep
      type(record_type), intent(in) :: records(:)
      integer, intent(in) :: number
      type(column_type), intent(in) :: column
      real(wp), intent(in) :: errors(:, :)
      integer(int8), intent(inout) :: bytes(:)
      character(:), allocatable :: text
      integer :: i

      select case (column%kind)
      case (column_real)
         bytes = transfer(real_of(sweep, records, number, column, errors), bytes)
      case (column_whole)
         bytes = transfer(whole_of(sweep, records(number), column), bytes)
      case default
         call find_text(sweep, records(number), column, text)
         do i = 1, len(text)
            bytes(i) = transfer(text(i:i), 0_int8)
         end do
      end select
   end subroutine fill

   !> The value of a column of reals.
   real(wp) function real_of(sweep, records, number, column, errors)
      type(sweep_type), intent(in) :: sweep
      type(record_type), intent(in) :: records(:)
      integer, intent(in) :: number
      type(column_type), intent(in) :: column
      real(wp), intent(in) :: errors(:, :)
      integer :: places(1 + size(sweep%axes))

      real_of = ieee_value(1.0_wp, ieee_quiet_nan)
      select case (column%source)
      case (from_axis)
         places = sweep%places(number)
         real_of = sweep%axes(column%number)%numbers(places(1 + column%number))
      case (from_residual)
         real_of = records(number)%largest_residual
      case (from_observable)
         real_of = records(number)%observables(column%number)
      case (from_pressure_error)
         real_of = errors(1, column%number)
      case (from_shear_error)
         real_of = errors(2, column%number)
      case (from_dissipation_ratio)
         real_of = dissipation_ratio(records(number), records(sweep%reference_of(number)))
      end select
   end function real_of

   !> The value of a column of whole numbers.
   integer(int32) function whole_of(sweep, record, column)
      type(sweep_type), intent(in) :: sweep
      type(record_type), intent(in) :: record
      type(column_type), intent(in) :: column
      integer :: places(1 + size(sweep%axes))

      whole_of = 0
      select case (column%source)
      case (from_case)
         whole_of = record%number
      case (from_axis)
         places = sweep%places(record%number)
         whole_of = nint(sweep%axes(column%number)%numbers(places(1 + column%number)))
      case (from_status)
         whole_of = record%outcome
      case (from_steps)
         whole_of = record%steps_done
      case (from_events)
         whole_of = record%events
      case (from_solves)
         whole_of = record%linear_solves
      case (from_nodes)
         whole_of = record%nodes
      end select
   end function whole_of

   !> The value of a column of texts.
   subroutine find_text(sweep, record, column, text)
      type(sweep_type), intent(in) :: sweep
      type(record_type), intent(in) :: record
      type(column_type), intent(in) :: column
      character(:), allocatable, intent(out) :: text
      integer :: places(1 + size(sweep%axes)), length

      places = sweep%places(record%number)
      text = ''
      select case (column%source)
      case (from_base)
         text = sweep%bases(places(1))%name
      case (from_axis)
         text = sweep%axes(column%number)%values(places(1 + column%number))%text
      case (from_outcome)
         text = status_outcome(record%outcome)
      case (from_message)
         length = min(len(record%message), longest_message)
         ! A letter of UTF-8 is not cut through: its later bytes begin with the bits 10.
         do while (length < len(record%message) .and. length > 0)
            if (iand(ichar(record%message(length + 1:length + 1)), 192) /= 128) exit
            length = length - 1
         end do
         text = record%message(:length)
      end select
   end subroutine find_text

   !> L1 errors of the tractions of case `number` against a reference, NaN where one of them is not there, or, but for the
   !> moment where the cycles begin, where they do not have the same number of whole cycles: that would compare different moments.
   subroutine compare(records, reference, number, errors)
      type(record_type), intent(in) :: records(:)
      integer, intent(in) :: reference, number
      real(wp), intent(out) :: errors(:, :)
      integer :: i

      errors = ieee_value(1.0_wp, ieee_quiet_nan)
      if (records(reference)%number == 0) return
      if (size(records(reference)%tractions) == 0 .or. size(records(number)%tractions) == 0) return
      do i = 1, moment_count
         call traction_errors(records(number)%tractions(i), records(reference)%tractions(i), errors(1, i), errors(2, i))
      end do
      if (.not. has_same_cycles(records(number), records(reference))) &
         errors(:, moment_loading + 1:) = ieee_value(1.0_wp, ieee_quiet_nan)
   end subroutine compare

   !> Whether two cases have the same number of whole cycles; not where one of them has none.
   pure logical function has_same_cycles(one, other)
      type(record_type), intent(in) :: one, other
      real(wp) :: cycles(2)

      cycles = [one%observables(observable_place('cycles')), other%observables(observable_place('cycles'))]
      has_same_cycles = all(ieee_is_finite(cycles))
      if (has_same_cycles) has_same_cycles = nint(cycles(1)) == nint(cycles(2))
   end function has_same_cycles

   !> Dissipation in the last cycle over that of a reference, NaN where there is none, or where it is not the same cycle.
   real(wp) function dissipation_ratio(record, reference) result(ratio)
      type(record_type), intent(in) :: record, reference
      integer :: i

      ratio = ieee_value(1.0_wp, ieee_quiet_nan)
      if (reference%number == 0) return
      if (.not. has_same_cycles(record, reference)) return
      i = observable_place('cycle_dissipation')
      if (.not. (ieee_is_finite(record%observables(i)) .and. ieee_is_finite(reference%observables(i)))) return
      if (abs(reference%observables(i)) > 0.0_wp) ratio = record%observables(i)/reference%observables(i)
   end function dissipation_ratio

   !> Links to the whole results of the cases.
   subroutine write_links(writer, sweep, records)
      type(writer_type), intent(inout) :: writer
      type(sweep_type), intent(in) :: sweep
      type(record_type), intent(in) :: records(:)
      character(:), allocatable :: folder
      integer :: i, code

      folder = sweep%states_folder()
      folder = folder(index(folder(:len(folder) - 1), '/', back=.true.) + 1:)
      call create_group(writer, 'cases')
      do i = 1, size(records)
         if (records(i)%number == 0 .or. records(i)%outcome == MFV_INPUT_ERROR) cycle
         call h5lcreate_external_f(folder//states_name(i)//'.h5', '/', writer%file, '/cases/'//states_name(i), code)
         call note(writer, code)
      end do
   end subroutine write_links

end module mfv_sweep_table
