!> The result file (HDF5): datasets with units and descriptions, dimension scales, the input text, versions and the certificate
!> (docs/file-format.md). It replaces an earlier result only when complete.
module mfv_result_file
   use hdf5
   use mfv_case, only: case_type
   use mfv_error, only: error_type, set_error
   use mfv_hdf5_reader, only: close_read, has, open_to_read, read_text_attribute
   use mfv_hdf5_restart, only: read_restart, restart_fields, restart_group
   use mfv_hdf5_writer
   use mfv_observables, only: observed_type
   use mfv_result_fields
   use mfv_simulation, only: simulation_type
   use mfv_status, only: MFV_COMPLETE, MFV_INPUT_ERROR, status_outcome
   use mfv_strings, only: string_type
   use mfv_version, only: library_version
   implicit none
   private
   public :: check_writable, write_result, resume_result

contains

   !> Restore a new simulation of a case from the result of an interrupted run at `path`. `is_finished`: that run is complete;
   !> nothing is done. Error MFV_INPUT_ERROR: the file is unreadable or damaged, or not a result of this case, this version and a
   !> run that did not fail; the simulation is then undefined.
   subroutine resume_result(path, case, simulation, is_finished, error)
      character(*), intent(in) :: path
      type(case_type), intent(in) :: case
      type(simulation_type), intent(inout) :: simulation
      logical, intent(out) :: is_finished
      type(error_type), allocatable, intent(out) :: error
      integer(hid_t) :: file

      is_finished = .false.
      call open_to_read(path, file, error)
      if (.not. allocated(error)) then
         call resume_open_file(file, case, simulation, is_finished, error)
         call close_read(file)
         if (allocated(error)) error%message = path//': '//error%message
      end if
      if (allocated(error)) error%message = error%message//'; run without --resume to start again from step 1'
   end subroutine resume_result

   !> The same for an open file.
   subroutine resume_open_file(file, case, simulation, is_finished, error)
      integer(hid_t), intent(in) :: file
      type(case_type), intent(in) :: case
      type(simulation_type), intent(inout) :: simulation
      logical, intent(out) :: is_finished
      type(error_type), allocatable, intent(out) :: error
      type(error_type), allocatable :: without_options
      character(:), allocatable :: input, version, outcome, options

      is_finished = .false.
      call read_text_attribute(file, 'input', input, error)
      if (.not. allocated(error)) call read_text_attribute(file, 'mfv_version', version, error)
      if (.not. allocated(error)) call read_text_attribute(file, 'outcome', outcome, error)
      if (allocated(error)) return
      call read_text_attribute(file, 'options', options, without_options)
      if (allocated(without_options)) options = ''
      if (input /= case%text) then
         call set_error(error, MFV_INPUT_ERROR, 'the result of another case: the text of the case file has changed')
      else if (options == '' .and. case%options /= '') then
         call set_error(error, MFV_INPUT_ERROR, 'the result of a run without '//trim(case%options)//'; give the same options')
      else if (options /= case%options) then
         call set_error(error, MFV_INPUT_ERROR, 'the result of a run with '//options//'; give the same options')
      else if (.not. has(file, restart_group)) then
         is_finished = outcome == status_outcome(MFV_COMPLETE)
         if (.not. is_finished) call set_error(error, MFV_INPUT_ERROR, 'the run ended ('//outcome//'); nothing to resume')
      else if (version /= library_version) then
         call set_error(error, MFV_INPUT_ERROR, 'written by version '//version//'; this is '//library_version)
      else
         call read_restart(file, simulation, error)
      end if
   end subroutine resume_open_file

   !> Write the result of a case to `path`, with its `warnings` (see mfv_validity). `with_restart`: with restart data. `observed`:
   !> the observables (mfv_observables), if they are known. Error
   !> MFV_FILE_ERROR, also if check_writable refuses; an earlier file is then unchanged.
   subroutine write_result(path, case, simulation, warnings, error, with_restart, observed)
      character(*), intent(in) :: path
      type(case_type), intent(in) :: case
      type(simulation_type), intent(in) :: simulation
      type(string_type), intent(in) :: warnings(:)
      type(error_type), allocatable, intent(out) :: error
      logical, intent(in), optional :: with_restart
      type(observed_type), intent(in), optional :: observed
      type(writer_type) :: writer
      type(string_type), allocatable :: names(:), texts(:)
      integer :: i

      call create_file(path, writer, error)
      if (allocated(error)) return
      if (writer%code == 0) then
         call result_attributes(case, simulation, warnings, names, texts, observed)
         do i = 1, size(names)
            call write_text(writer, writer%file, names(i)%text, texts(i)%text)
         end do
         call write_hdf5_version(writer)
         call write_groups(writer, case, simulation, observed, with_restart)
      end if
      call finish_file(path, 'the result', writer, error)
   end subroutine write_result

   !> All groups with their datasets.
   subroutine write_groups(writer, case, simulation, observed, with_restart)
      type(writer_type), intent(inout) :: writer
      type(case_type), intent(in) :: case
      type(simulation_type), intent(in) :: simulation
      type(observed_type), intent(in), optional :: observed
      logical, intent(in), optional :: with_restart
      type(string_type), allocatable :: groups(:)
      type(field_type), allocatable :: fields(:), scales(:)
      integer :: i, j

      allocate (scales(scale_count))
      do j = 1, scale_count
         scales(j)%name = ''
      end do
      groups = result_groups(simulation)
      do i = 1, size(groups)
         call group_fields(case, simulation, groups(i)%text, fields, observed)
         if (size(fields) == 0) cycle
         ! The group of a scale precedes the others that use it.
         do j = 1, scale_count
            if (scale_group(j) == groups(i)%text) scales(j) = fields(field_named(fields, trim(scale_name(j))))
         end do
         call write_group(writer, groups(i)%text, fields, scales)
      end do
      if (.not. present(with_restart)) return
      if (.not. with_restart) return
      call restart_fields(simulation, fields)
      call write_group(writer, restart_group, fields, scales)
   end subroutine write_groups

end module mfv_result_file
