!> Bodies given by a matrix, from an HDF5 file with the datasets that mfv_matrix_body has.
module mfv_matrix_file
   use hdf5, only: hid_t
   use mfv_body, only: body_type
   use mfv_error, only: error_type, set_error
   use mfv_hdf5_reader
   use mfv_matrix_body, only: check_positions, matrix_data_type, most_matrix_nodes
   use mfv_status, only: MFV_INPUT_ERROR
   implicit none
   private
   public :: read_matrix_body

contains

   !> The body in the file `path`. Error MFV_INPUT_ERROR, which names the file and what is wrong in it.
   subroutine read_matrix_body(path, body, error)
      character(*), intent(in) :: path
      type(body_type), intent(out) :: body
      type(error_type), allocatable, intent(out) :: error
      type(matrix_data_type) :: data
      integer(hid_t) :: file

      call open_to_read(path, file, error)
      if (allocated(error)) return
      call read_datasets(file, data, error)
      call close_read(file)
      if (.not. allocated(error)) call data%make_body(body, error)
      if (allocated(error)) error%message = path//': '//error%message
   end subroutine read_matrix_body

   !> All datasets of an open file.
   subroutine read_datasets(file, data, error)
      integer(hid_t), intent(in) :: file
      type(matrix_data_type), intent(out) :: data
      type(error_type), allocatable, intent(out) :: error

      call read_vector(file, 'x', -1, data%x, error)
      if (.not. allocated(error)) call check_positions(data%x, has(file, 'width'), error)
      if (allocated(error)) return
      if (has(file, 'gap')) call read_vector(file, 'gap', size(data%x), data%gap, error)
      if (allocated(error)) return
      if (has(file, 'width')) call read_vector(file, 'width', size(data%x), data%width, error)
      if (allocated(error)) return
      if (has(file, 'compliance') .eqv. has(file, 'stiffness')) then
         call set_error(error, MFV_INPUT_ERROR, 'give exactly one of compliance and stiffness')
         return
      end if
      data%name = 'stiffness'
      if (has(file, 'compliance')) data%name = 'compliance'
      call read_matrix(file, data%name, 2*most_matrix_nodes, data%matrix, error)
   end subroutine read_datasets

end module mfv_matrix_file
