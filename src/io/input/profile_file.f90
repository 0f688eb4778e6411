!> Profiles from text files with x and height, or with heights at equal distances.
module mfv_profile_file
   use mfv_case_data, only: case_data_type
   use mfv_error, only: error_type, set_error
   use mfv_geometry, only: geometry_type
   use mfv_kinds, only: wp
   use mfv_profile, only: profile_of_points, trace_type
   use mfv_status, only: MFV_INPUT_ERROR
   use mfv_strings, only: string_type, to_text
   use mfv_table_file, only: read_table
   implicit none
   private
   public :: read_profile, metres_in

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
      type(string_type), allocatable :: heading(:)
      integer :: i

      if (present(data)) then
         call data%read_columns(path, 'x height', table, error, with_gaps=.true.)
      else
         call read_table(path, 'x and height', 2, .true., table, error, is_trace=.true., heading=heading)
         if (.not. allocated(error)) call check_units(path, heading, trace, error)
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

   !> Error if by its heading a file has positions and heights in different units of length, and no scale makes them the same.
   subroutine check_units(path, heading, trace, error)
      character(*), intent(in) :: path
      type(string_type), intent(in) :: heading(:)
      type(trace_type), intent(in) :: trace
      type(error_type), allocatable, intent(out) :: error
      character(len=2) :: x, height

      if (size(heading) < 2 .or. trace%has_spacing .or. abs(abs(trace%height_scale) - 1.0_wp) > 0.0_wp) return
      x = unit_in(heading(size(heading) - 1)%text)
      height = unit_in(heading(size(heading))%text)
      if (x == height .or. .not. (metres_in(x) > 0.0_wp .and. metres_in(height) > 0.0_wp)) return
      call set_error(error, MFV_INPUT_ERROR, path//': by its heading positions are in '//trim(x)//' and heights in '// &
                     trim(height)//'; give height_scale='//to_text(metres_in(height)/metres_in(x))//' if lengths are in '// &
                     trim(x)//' (negative for heights that are positive outwards), or position_scale and height_scale')
   end subroutine check_units

   !> Metres in a unit of length; 0 if it is not known.
   pure real(wp) function metres_in(unit) result(metres)
      character(*), intent(in) :: unit

      select case (unit)
      case ('m')
         metres = 1.0_wp
      case ('cm')
         metres = 1.0e-2_wp
      case ('mm')
         metres = 1.0e-3_wp
      case ('um')
         metres = 1.0e-6_wp
      case ('nm')
         metres = 1.0e-9_wp
      case default
         metres = 0.0_wp
      end select
   end function metres_in

   !> The unit of length in brackets at the end of the name of a column, um for micrometres in any writing; blank for none.
   pure character(len=2) function unit_in(name)
      character(*), intent(in) :: name
      !> The sign for micro and the Greek letter.
      character(len=2), parameter :: micro = char(194)//char(181), mu = char(206)//char(188)
      integer :: opening, closing

      unit_in = ''
      opening = scan(name, '[(', back=.true.)
      closing = scan(name, '])', back=.true.)
      if (opening == 0 .or. closing <= opening + 1 .or. closing > opening + 4) return
      associate (unit => name(opening + 1:closing - 1))
         if (any(unit == [character(len=3) :: 'um', micro//'m', mu//'m', char(181)//'m'])) then
            unit_in = 'um'
         else if (len(unit) <= 2) then
            unit_in = unit
         end if
      end associate
   end function unit_in

   !> The last character of a path before the suffix of its name, unless that is .txt.
   pure integer function name_end(path)
      character(*), intent(in) :: path

      name_end = len(path)
      if (index(path, '.', back=.true.) > index(path, '/', back=.true.) + 1) name_end = index(path, '.', back=.true.) - 1
      if (path(name_end + 1:) == '.txt') name_end = len(path)
   end function name_end

end module mfv_profile_file
