!> Readers that the C interface does not have, for fuzz_target: every one takes the path of a file and gives a status and a message.
module fuzz_readers
   use, intrinsic :: iso_c_binding, only: c_char, c_int, c_size_t
   use, intrinsic :: iso_fortran_env, only: int64, int8
   use hdf5, only: H5I_ATTR_F, H5I_DATASET_F, H5I_DATASPACE_F, H5I_DATATYPE_F, H5I_FILE_F, H5I_GENPROP_LST_F, H5I_GROUP_F, hsize_t
   use mfv_body, only: body_type
   use mfv_case, only: case_type
   use mfv_error, only: error_type
   use mfv_kinds, only: wp
   use mfv_matrix_file, only: read_matrix_body
   use mfv_observables, only: moment_count
   use mfv_profile_file, only: read_profile, read_table, trace_type
   use mfv_status, only: MFV_COMPLETE
   use mfv_stress_file, only: add_stresses, stress_request_type, stress_result_type
   use mfv_strings, only: copy_to_c, from_c
   use mfv_sweep_journal, only: append_to_journal, close_journal, gather_journal, journal_type, open_journal
   use mfv_sweep_plan, only: sweep_type
   use mfv_sweep_reader, only: read_sweep_file
   use mfv_sweep_record, only: pack_record, record_type
   use mfv_sweep_table, only: check_place, find_table
   implicit none
   private

   !> Checksum of the sweep that journals are looked into for, and its cases.
   integer(int64), parameter :: journal_checksum = 1234567890123456789_int64
   integer, parameter :: journal_cases = 5

   interface
      function c_members(type, members) bind(C, name='H5Inmembers') result(code)
         import :: c_int, hsize_t
         integer(c_int), value :: type
         integer(hsize_t), intent(out) :: members
         integer(c_int) :: code
      end function c_members
   end interface

contains

   !> A sweep as mfv_sweep --check takes it; its first and last case.
   integer(c_int) function fuzz_sweep(path, message, size) bind(C)
      character(kind=c_char), intent(in) :: path(*)
      character(kind=c_char), intent(inout) :: message(*)
      integer(c_size_t), value :: size
      type(sweep_type) :: sweep
      type(case_type) :: case
      type(error_type), allocatable :: error
      character(:), allocatable :: text

      call read_sweep_file(from_c(path), sweep, error)
      if (.not. allocated(error)) call sweep%describe(sweep%places(sweep%cases()), text)
      if (.not. allocated(error)) call sweep%read_case(1, case, error)
      if (.not. allocated(error)) call sweep%read_case(sweep%cases(), case, error)
      call tell(error, message, size, fuzz_sweep)
   end function fuzz_sweep

   !> A matrix body.
   integer(c_int) function fuzz_matrix(path, message, size) bind(C)
      character(kind=c_char), intent(in) :: path(*)
      character(kind=c_char), intent(inout) :: message(*)
      integer(c_size_t), value :: size
      type(body_type) :: body
      type(error_type), allocatable :: error

      call read_matrix_body(from_c(path), body, error)
      call tell(error, message, size, fuzz_matrix)
   end function fuzz_matrix

   !> A result as mfv_stress takes it, on a coarse grid; the file is changed.
   integer(c_int) function fuzz_stress(path, message, size) bind(C)
      character(kind=c_char), intent(in) :: path(*)
      character(kind=c_char), intent(inout) :: message(*)
      integer(c_size_t), value :: size
      type(stress_request_type) :: request
      type(stress_result_type) :: result
      type(error_type), allocatable :: error

      request%across = 5
      request%down = 3
      call add_stresses(from_c(path), request, result, error)
      call tell(error, message, size, fuzz_stress)
   end function fuzz_stress

   !> A journal of a sweep.
   integer(c_int) function fuzz_journal(path, message, size) bind(C)
      character(kind=c_char), intent(in) :: path(*)
      character(kind=c_char), intent(inout) :: message(*)
      integer(c_size_t), value :: size
      type(record_type) :: records(journal_cases)
      type(error_type), allocatable :: error
      logical :: found

      call gather_journal(from_c(path), journal_checksum, records, found, error)
      call tell(error, message, size, fuzz_journal)
   end function fuzz_journal

   !> Write a valid journal to begin with: every second case, with tractions at one moment.
   integer(c_int) function fuzz_write_journal(path, message, size) bind(C)
      character(kind=c_char), intent(in) :: path(*)
      character(kind=c_char), intent(inout) :: message(*)
      integer(c_size_t), value :: size
      type(record_type) :: records(journal_cases), record
      type(journal_type) :: journal
      type(error_type), allocatable :: error
      integer(int8), allocatable :: bytes(:)
      integer :: i

      call open_journal(from_c(path), journal_checksum, .true., journal, records, error)
      do i = 1, journal_cases, 2
         if (allocated(error)) exit
         record%number = i
         record%message = 'every step was reached'
         if (allocated(record%tractions)) deallocate (record%tractions)
         allocate (record%tractions(moment_count))
         record%tractions(1)%pressure = [0.0_wp, 1.0_wp, 2.0_wp]
         record%tractions(1)%shear = [0.0_wp, 0.5_wp, 1.0_wp]
         call pack_record(record, bytes)
         call append_to_journal(journal, bytes, error)
      end do
      if (.not. allocated(error)) call close_journal(journal, error)
      call tell(error, message, size, fuzz_write_journal)
   end function fuzz_write_journal

   !> A table as mfv_sweep looks at it before it is replaced or left alone.
   integer(c_int) function fuzz_table(path, message, size) bind(C)
      character(kind=c_char), intent(in) :: path(*)
      character(kind=c_char), intent(inout) :: message(*)
      integer(c_size_t), value :: size
      type(sweep_type) :: sweep
      type(error_type), allocatable :: error
      integer :: state

      sweep%source = 'fuzz'
      sweep%result_path = from_c(path)
      call check_place(sweep, error)
      call find_table(sweep, state)
      call tell(error, message, size, fuzz_table)
   end function fuzz_table

   !> A text with columns of numbers: a profile, and coefficients of friction.
   integer(c_int) function fuzz_columns(path, message, size) bind(C)
      character(kind=c_char), intent(in) :: path(*)
      character(kind=c_char), intent(inout) :: message(*)
      integer(c_size_t), value :: size
      type(body_type) :: body
      type(error_type), allocatable :: error
      real(wp), allocatable :: table(:, :)

      call read_table(from_c(path), 'x, mu_static and mu_kinetic', 3, .true., table, error)
      call read_profile(from_c(path), trace_type(), body, error)
      call tell(error, message, size, fuzz_columns)
   end function fuzz_columns

   !> Objects of HDF5 that are open: files, groups, types, spaces, datasets, attributes, lists of properties.
   integer(c_int) function fuzz_open_objects() bind(C)
      integer, parameter :: kinds = 7
      integer :: types(kinds), i, code
      integer(hsize_t) :: members

      fuzz_open_objects = 0
      types = [H5I_FILE_F, H5I_GROUP_F, H5I_DATATYPE_F, H5I_DATASPACE_F, H5I_DATASET_F, H5I_ATTR_F, H5I_GENPROP_LST_F]
      do i = 1, kinds
         code = c_members(types(i), members)
         if (code == 0) fuzz_open_objects = fuzz_open_objects + int(members)
      end do
   end function fuzz_open_objects

   !> Status and message of what was done.
   subroutine tell(error, message, size, status)
      type(error_type), allocatable, intent(in) :: error
      character(kind=c_char), intent(inout) :: message(*)
      integer(c_size_t), intent(in) :: size
      integer(c_int), intent(out) :: status

      status = MFV_COMPLETE
      if (.not. allocated(error)) return
      status = error%status
      call copy_to_c(error%message, message, int(size))
   end subroutine tell

end module fuzz_readers
