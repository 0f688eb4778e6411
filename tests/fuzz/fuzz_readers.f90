!> Readers that the C interface does not have, for fuzz_target: every one takes the path of a file and gives a status and a message.
module fuzz_readers
   use, intrinsic :: iso_c_binding, only: c_char, c_int, c_size_t
   use hdf5, only: H5I_ATTR_F, H5I_DATASET_F, H5I_DATASPACE_F, H5I_DATATYPE_F, H5I_FILE_F, H5I_GENPROP_LST_F, H5I_GROUP_F, hsize_t
   use mfv_body, only: body_type
   use mfv_geometry, only: geometry_type
   use mfv_error, only: error_type
   use mfv_kinds, only: wp
   use mfv_matrix_file, only: read_matrix_body
   use mfv_profile, only: trace_type
   use mfv_profile_file, only: read_profile
   use mfv_status, only: MFV_COMPLETE
   use mfv_stress_file, only: add_stresses, stress_request_type, stress_result_type
   use mfv_strings, only: copy_to_c, from_c, string_type
   use mfv_table_file, only: read_named_table, read_table
   implicit none
   private

   interface
      function c_members(type, members) bind(C, name='H5Inmembers') result(code)
         import :: c_int, hsize_t
         integer(c_int), value :: type
         integer(hsize_t), intent(out) :: members
         integer(c_int) :: code
      end function c_members
   end interface

contains

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

   !> A text with columns of numbers: coefficients of friction, a load history, a profile.
   integer(c_int) function fuzz_columns(path, message, size) bind(C)
      character(kind=c_char), intent(in) :: path(*)
      character(kind=c_char), intent(inout) :: message(*)
      integer(c_size_t), value :: size
      type(geometry_type) :: surface
      type(error_type), allocatable :: error
      real(wp), allocatable :: table(:, :)
      type(string_type), allocatable :: names(:)

      call read_named_table(from_c(path), names, table, error)
      call read_table(from_c(path), 'x, mu_static and mu_kinetic', 3, .true., table, error)
      call read_profile(from_c(path), trace_type(), surface, error)
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
