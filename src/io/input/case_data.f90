!> Data in memory instead of the files that a case names: datasets under the name of each file.
module mfv_case_data
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite, ieee_is_nan
   use mfv_body, only: body_type
   use mfv_error, only: error_type, set_error
   use mfv_kinds, only: wp
   use mfv_matrix_body, only: check_positions, matrix_data_type
   use mfv_status, only: MFV_INPUT_ERROR
   use mfv_strings, only: list_of_words, string_type, to_text
   implicit none
   private
   public :: case_data_type

   type :: dataset_type
      character(:), allocatable :: file, name
      !> Shape (rows, columns); one column for a vector.
      real(wp), allocatable :: values(:, :)
   end type dataset_type

   type :: case_data_type
      type(dataset_type), allocatable :: datasets(:)
   contains
      procedure :: put
      procedure :: has_file
      procedure :: read_columns
      procedure :: read_matrix_body
      procedure, private :: place_of
      procedure, private :: read_vector
      procedure, private :: gather_matrix
   end type case_data_type

contains

   !> Add or replace a dataset. `values`: shape (rows, columns).
   subroutine put(self, file, name, values)
      class(case_data_type), intent(inout) :: self
      character(*), intent(in) :: file, name
      real(wp), intent(in) :: values(:, :)
      type(dataset_type), allocatable :: longer(:)
      integer :: place, i

      if (.not. allocated(self%datasets)) allocate (self%datasets(0))
      place = self%place_of(file, name)
      if (place == 0) then
         allocate (longer(size(self%datasets) + 1))
         do i = 1, size(self%datasets)
            call move_alloc(self%datasets(i)%file, longer(i)%file)
            call move_alloc(self%datasets(i)%name, longer(i)%name)
            call move_alloc(self%datasets(i)%values, longer(i)%values)
         end do
         call move_alloc(longer, self%datasets)
         place = size(self%datasets)
      end if
      self%datasets(place)%file = file
      self%datasets(place)%name = name
      self%datasets(place)%values = values
   end subroutine put

   !> Whether there are data for a file.
   pure logical function has_file(self, file)
      class(case_data_type), intent(in) :: self
      character(*), intent(in) :: file
      integer :: i

      has_file = .false.
      if (.not. allocated(self%datasets)) return
      do i = 1, size(self%datasets)
         has_file = has_file .or. self%datasets(i)%file == file
      end do
   end function has_file

   !> Index of a dataset, 0 for none.
   pure integer function place_of(self, file, name) result(place)
      class(case_data_type), intent(in) :: self
      character(*), intent(in) :: file, name

      do place = size(self%datasets), 1, -1
         if (self%datasets(place)%file == file .and. self%datasets(place)%name == name) return
      end do
   end function place_of

   !> A dataset of one column and `count` rows (any number if negative). `with_gaps`: whether NaN is permitted.
   !> Error MFV_INPUT_ERROR.
   subroutine read_vector(self, file, name, count, values, error, with_gaps)
      class(case_data_type), intent(in) :: self
      character(*), intent(in) :: file, name
      integer, intent(in) :: count
      real(wp), allocatable, intent(out) :: values(:)
      type(error_type), allocatable, intent(out) :: error
      logical, intent(in), optional :: with_gaps
      logical :: may_be_nan
      integer :: place

      may_be_nan = .false.
      if (present(with_gaps)) may_be_nan = with_gaps
      place = self%place_of(file, name)
      if (place == 0) then
         call set_error(error, MFV_INPUT_ERROR, 'dataset '//name//' is missing')
         return
      end if
      associate (found => self%datasets(place)%values)
         if (size(found, 2) /= 1 .or. (count >= 0 .and. size(found, 1) /= count)) then
            call set_error(error, MFV_INPUT_ERROR, name//' must have one column and as many rows as x')
         else if (.not. all(ieee_is_finite(found) .or. (may_be_nan .and. ieee_is_nan(found)))) then
            call set_error(error, MFV_INPUT_ERROR, name//' has values that are not finite')
         else
            values = found(:, 1)
         end if
      end associate
   end subroutine read_vector

   !> The datasets with these names, separated by blanks, as columns; the first must increase. `table`: shape (columns, rows), as
   !> that of a text file. `with_gaps`: whether those after the first may have NaN. Error MFV_INPUT_ERROR.
   subroutine read_columns(self, file, names, table, error, with_gaps)
      class(case_data_type), intent(in) :: self
      character(*), intent(in) :: file, names
      real(wp), allocatable, intent(out) :: table(:, :)
      type(error_type), allocatable, intent(out) :: error
      logical, intent(in), optional :: with_gaps
      type(string_type), allocatable :: list(:)
      real(wp), allocatable :: column(:)
      integer :: i, rows

      list = list_of_words(names)
      rows = -1
      do i = 1, size(list)
         if (i == 1) then
            call self%read_vector(file, list(i)%text, rows, column, error)
         else
            call self%read_vector(file, list(i)%text, rows, column, error, with_gaps)
         end if
         if (allocated(error)) exit
         if (rows < 0) then
            rows = size(column)
            allocate (table(size(list), rows))
         end if
         table(i, :) = column
      end do
      if (.not. allocated(error)) then
         if (any(table(1, 2:) <= table(1, :rows - 1))) &
            call set_error(error, MFV_INPUT_ERROR, list(1)%text//' must increase; it does not at row '// &
                           to_text(findloc(table(1, 2:) <= table(1, :rows - 1), .true., dim=1) + 1))
      end if
      if (allocated(error)) error%message = "the data '"//file//"': "//error%message
   end subroutine read_columns

   !> A body given by a matrix, see mfv_matrix_body. Error MFV_INPUT_ERROR.
   subroutine read_matrix_body(self, file, body, error)
      class(case_data_type), intent(in) :: self
      character(*), intent(in) :: file
      type(body_type), intent(out) :: body
      type(error_type), allocatable, intent(out) :: error
      type(matrix_data_type) :: data

      call self%gather_matrix(file, data, error)
      if (.not. allocated(error)) call data%make_body(body, error)
      if (allocated(error)) error%message = "the data '"//file//"': "//error%message
   end subroutine read_matrix_body

   !> The datasets of a matrix body. Error MFV_INPUT_ERROR.
   subroutine gather_matrix(self, file, data, error)
      class(case_data_type), intent(in) :: self
      character(*), intent(in) :: file
      type(matrix_data_type), intent(out) :: data
      type(error_type), allocatable, intent(out) :: error
      integer :: place

      call self%read_vector(file, 'x', -1, data%x, error)
      if (.not. allocated(error)) call check_positions(data%x, self%place_of(file, 'width') > 0, error)
      if (.not. allocated(error) .and. self%place_of(file, 'gap') > 0) &
         call self%read_vector(file, 'gap', size(data%x), data%gap, error)
      if (.not. allocated(error) .and. self%place_of(file, 'width') > 0) &
         call self%read_vector(file, 'width', size(data%x), data%width, error)
      if (allocated(error)) return
      data%name = 'stiffness'
      place = self%place_of(file, 'compliance')
      if (place > 0) data%name = 'compliance'
      if ((place > 0) .eqv. (self%place_of(file, 'stiffness') > 0)) then
         call set_error(error, MFV_INPUT_ERROR, 'give exactly one of compliance and stiffness')
         return
      end if
      if (place == 0) place = self%place_of(file, 'stiffness')
      data%matrix = self%datasets(place)%values
   end subroutine gather_matrix

end module mfv_case_data
