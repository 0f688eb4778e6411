!> Profiles from text files with x and height, or with heights at equal distances.
module mfv_profile_file
   use mfv_case_data, only: case_data_type
   use mfv_error, only: error_type, set_error
   use mfv_geometry, only: geometry_type
   use mfv_kinds, only: wp
   use mfv_profile, only: profile_of_points, trace_type
   use mfv_status, only: MFV_INPUT_ERROR
   use mfv_table_file, only: read_table
   implicit none
   private
   public :: read_profile

contains

   !> The profile in the file `path`, see read_table: x, increasing or decreasing, and height in every line, or heights alone.
   !> `trace`: options; `data`: has the datasets x and height if they are in memory. Error MFV_INPUT_ERROR with the line and what
   !> would be right.
   subroutine read_profile(path, trace, geometry, error, data)
      character(*), intent(in) :: path
      type(trace_type), intent(in) :: trace
      type(geometry_type), intent(out) :: geometry
      type(error_type), allocatable, intent(out) :: error
      type(case_data_type), intent(in), optional :: data
      real(wp), allocatable :: table(:, :), x(:)
      integer :: i

      if (present(data)) then
         call data%read_columns(path, 'x height', table, error, with_gaps=.true.)
      else
         call read_table(path, 'x and height', 2, .true., table, error, is_trace=.true.)
         if (allocated(error)) then
            if (index(error%message, ': not a text file') > 0) error%message = error%message// &
                                                            '; write one: mfv profile '//path//' -o '//path(:name_end(path))//'.txt'
         end if
      end if
      if (allocated(error)) return
      if (size(table, 1) == 1 .and. .not. trace%has_spacing) then
         call set_error(error, MFV_INPUT_ERROR, path//': has one column, heights; give the distance between them as position_scale')
         return
      end if
      x = table(1, :)
      if (size(table, 1) == 1) x = [(real(i, wp), i=0, size(x) - 1)]
      call profile_of_points(x, table(size(table, 1), :), trace, geometry, error)
      if (allocated(error)) error%message = path//': '//error%message
   end subroutine read_profile

   !> The last character of a path before the suffix of its name, unless that is .txt.
   pure integer function name_end(path)
      character(*), intent(in) :: path

      name_end = len(path)
      if (index(path, '.', back=.true.) > index(path, '/', back=.true.) + 1) name_end = index(path, '.', back=.true.) - 1
      if (path(name_end + 1:) == '.txt') name_end = len(path)
   end function name_end

end module mfv_profile_file
