!> Replaces matrix_file.f90 in a build without HDF5: bodies given by a matrix cannot be read.
module mfv_matrix_file
   use mfv_body, only: body_type
   use mfv_error, only: error_type, set_error
   use mfv_features, only: no_hdf5_message
   use mfv_status, only: MFV_INPUT_ERROR
   implicit none
   private
   public :: read_matrix_body

contains

   !> Error MFV_INPUT_ERROR, always.
   subroutine read_matrix_body(path, body, error)
      character(*), intent(in) :: path
      type(body_type), intent(out) :: body
      type(error_type), allocatable, intent(out) :: error

      call set_error(error, MFV_INPUT_ERROR, path//' cannot be read: '//no_hdf5_message)
   end subroutine read_matrix_body

end module mfv_matrix_file
