!> A sweep: base cases, axes along which values are put into them, and the cases that come out, numbered from 1.
module mfv_sweep_plan
   use, intrinsic :: iso_fortran_env, only: int64
   use mfv_case, only: case_type
   use mfv_case_changes, only: set_dundurs_beta, set_value, write_number
   use mfv_case_reader, only: read_case_groups
   use mfv_error, only: error_type, set_error
   use mfv_kinds, only: wp
   use mfv_namelist, only: group_type, write_namelists
   use mfv_status, only: MFV_INPUT_ERROR
   use mfv_strings, only: quoted, string_type, to_text
   implicit none
   private
   public :: sweep_type, axis_type, base_type, target_type, dundurs_key, column_real, column_whole, column_text, value_for

   !> The key that stands for the materials of both bodies.
   character(*), parameter :: dundurs_key = 'dundurs_beta'
   !> What a column of the table holds.
   integer, parameter :: column_real = 1, column_whole = 2, column_text = 3

   !> A key of the case that an axis varies.
   type :: target_type
      !> Group, and which one of that name; empty for dundurs_key.
      character(:), allocatable :: group, key
      integer :: number = 1
      !> What a number is multiplied by, and whether it has to be whole.
      real(wp) :: factor = 1.0_wp
      logical :: is_whole = .false.
   end type target_type

   !> One &vary.
   type :: axis_type
      !> Name of the column, its unit in terms of length and force, and what it is.
      character(:), allocatable :: name, unit, meaning
      type(target_type), allocatable :: targets(:)
      !> Values as they would be written, and which of them between quotes; and as numbers where they are (.true. is 1).
      type(string_type), allocatable :: values(:)
      logical, allocatable :: is_quoted(:)
      real(wp), allocatable :: numbers(:)
      !> Whether the values are a row of numbers, from one to another.
      logical :: is_row = .false.
      integer :: column = column_real
      !> Line of the sweep.
      integer :: line = 0
   end type axis_type

   !> One base case.
   type :: base_type
      !> As the sweep names it; where the files are that the case names; its text.
      character(:), allocatable :: name, directory, text
      type(group_type), allocatable :: groups(:)
   end type base_type

   type :: sweep_type
      !> Name of its file for messages, and its text.
      character(:), allocatable :: source, text
      type(base_type), allocatable :: bases(:)
      type(axis_type), allocatable :: axes(:)
      !> Whether the axes move together, whether whole results are kept, and whether cases are compared with full coupling: then
      !> the axis of the coupling and the place of 'full' on it.
      logical :: paired = .false., keeps_states = .false., has_reference = .false.
      integer :: coupling_axis = 0, full_place = 0
      !> File of the table, and names of the user's units.
      character(:), allocatable :: result_path, length_unit, force_unit
      !> Checksum of all that decides the results: texts, files that they name, version.
      integer(int64) :: checksum = 0
   contains
      procedure :: cases
      procedure :: places
      procedure :: number_at
      procedure :: reference_of
      procedure :: describe
      procedure :: read_case
      procedure :: groups_at
      procedure :: states_folder
      procedure :: reads_hdf5
   end type sweep_type

contains

   !> Number of cases; more than can be counted as a negative number.
   pure integer function cases(self)
      class(sweep_type), intent(in) :: self
      real(wp) :: product_so_far
      integer :: i

      product_so_far = size(self%bases)
      do i = 1, size(self%axes)
         if (self%paired .and. i > 1) exit
         product_so_far = product_so_far*size(self%axes(i)%values)
      end do
      cases = -1
      if (product_so_far < huge(1)) cases = nint(product_so_far)
   end function cases

   !> Which base and which value of each axis case `number` has, shape (1 + axes).
   pure function places(self, number)
      class(sweep_type), intent(in) :: self
      integer, intent(in) :: number
      integer :: places(1 + size(self%axes))
      integer :: i, rest

      rest = number - 1
      places = 1
      if (self%paired .and. size(self%axes) > 0) then
         places(2:) = 1 + mod(rest, size(self%axes(1)%values))
         rest = rest/size(self%axes(1)%values)
      else
         do i = size(self%axes), 1, -1
            places(1 + i) = 1 + mod(rest, size(self%axes(i)%values))
            rest = rest/size(self%axes(i)%values)
         end do
      end if
      places(1) = 1 + rest
   end function places

   !> The number of the case with such places.
   pure integer function number_at(self, places) result(number)
      class(sweep_type), intent(in) :: self
      integer, intent(in) :: places(:)
      integer :: i

      number = places(1) - 1
      do i = 1, size(self%axes)
         if (self%paired .and. i > 1) exit
         number = number*size(self%axes(i)%values) + places(1 + i) - 1
      end do
      number = number + 1
   end function number_at

   !> The number of the case of full coupling that is the same otherwise, 0 for none.
   pure integer function reference_of(self, number) result(reference)
      class(sweep_type), intent(in) :: self
      integer, intent(in) :: number
      integer :: places(1 + size(self%axes))

      reference = 0
      if (.not. self%has_reference) return
      places = self%places(number)
      places(1 + self%coupling_axis) = self%full_place
      reference = self%number_at(places)
   end function reference_of

   !> The values at some places in words: base='hole.nml', friction%mu=0.3.
   subroutine describe(self, places, text)
      class(sweep_type), intent(in) :: self
      integer, intent(in) :: places(:)
      character(:), allocatable, intent(out) :: text
      integer :: i

      text = 'base='//quoted(self%bases(places(1))%name)
      do i = 1, size(self%axes)
         text = text//', '//self%axes(i)%name//'='
         if (self%axes(i)%is_quoted(places(1 + i))) then
            text = text//quoted(self%axes(i)%values(places(1 + i))%text)
         else
            text = text//self%axes(i)%values(places(1 + i))%text
         end if
      end do
   end subroutine describe

   !> Case `number`, ready to be solved. Error MFV_INPUT_ERROR of the case reader where the values do not go together.
   subroutine read_case(self, number, case, error)
      class(sweep_type), intent(in) :: self
      integer, intent(in) :: number
      type(case_type), intent(out) :: case
      type(error_type), allocatable, intent(out) :: error
      type(group_type), allocatable :: groups(:)
      integer :: places(1 + size(self%axes))

      places = self%places(number)
      call self%groups_at(places, groups, error)
      if (allocated(error)) return
      associate (base => self%bases(places(1)))
         call read_case_groups(groups, base%name, base%directory, case, error)
      end associate
      call write_namelists(groups, case%text)
   end subroutine read_case

   !> The groups of the case with such places. Error MFV_INPUT_ERROR where its materials cannot be replaced.
   subroutine groups_at(self, places, groups, error)
      class(sweep_type), intent(in) :: self
      integer, intent(in) :: places(:)
      type(group_type), allocatable, intent(out) :: groups(:)
      type(error_type), allocatable, intent(out) :: error
      real(wp) :: beta
      logical :: has_beta
      integer :: i, j

      groups = self%bases(places(1))%groups
      has_beta = .false.
      do i = 1, size(self%axes)
         associate (axis => self%axes(i), place => places(1 + i))
            do j = 1, size(axis%targets)
               if (axis%targets(j)%key == dundurs_key) then
                  has_beta = .true.
                  beta = axis%targets(j)%factor*axis%numbers(place)
               else
                  call set_value(groups, axis%targets(j)%group, axis%targets(j)%number, axis%targets(j)%key, &
                                 value_for(axis, axis%targets(j), place), axis%is_quoted(place))
               end if
            end do
         end associate
      end do
      if (has_beta) call replace_materials(self%bases(places(1)), beta, groups, error)
   end subroutine groups_at

   !> The value at a place of an axis for one of its keys, as it would be written.
   pure function value_for(axis, target, place) result(text)
      type(axis_type), intent(in) :: axis
      type(target_type), intent(in) :: target
      integer, intent(in) :: place
      character(len=length_of_value(axis, target, place)) :: text
      character(:), allocatable :: value

      call find_value(axis, target, place, value)
      text = value
   end function value_for

   pure integer function length_of_value(axis, target, place) result(length)
      type(axis_type), intent(in) :: axis
      type(target_type), intent(in) :: target
      integer, intent(in) :: place
      character(:), allocatable :: value

      call find_value(axis, target, place, value)
      length = len(value)
   end function length_of_value

   !> See value_for.
   pure subroutine find_value(axis, target, place, value)
      type(axis_type), intent(in) :: axis
      type(target_type), intent(in) :: target
      integer, intent(in) :: place
      character(:), allocatable, intent(out) :: value
      real(wp) :: number

      value = axis%values(place)%text
      ! The numbers of a row are whole where a key needs them; what is written out is to be right as it is.
      if (.not. (abs(target%factor - 1.0_wp) > 0.0_wp .or. (axis%is_row .and. target%is_whole))) return
      number = target%factor*axis%numbers(place)
      if (target%is_whole .and. abs(number) < huge(1)) then
         value = to_text(nint(number))
      else
         call write_number(number, value)
      end if
   end subroutine find_value

   !> Materials with Dundurs' parameter `beta` and the mutual compliance of the case as it is.
   subroutine replace_materials(base, beta, groups, error)
      type(base_type), intent(in) :: base
      real(wp), intent(in) :: beta
      type(group_type), allocatable, intent(inout) :: groups(:)
      type(error_type), allocatable, intent(out) :: error
      type(case_type) :: case

      call read_case_groups(groups, base%name, base%directory, case, error)
      if (allocated(error)) return
      if (case%scene%modulus() > 0.0_wp) then
         call set_dundurs_beta(groups, beta, 1.0_wp/case%scene%modulus())
      else
         call set_error(error, MFV_INPUT_ERROR, base%name//': '//dundurs_key//" needs bodies with materials, not "// &
                        "shape='matrix'")
      end if
   end subroutine replace_materials

   !> Folder for the whole results, with its final slash: the file of the table with .cases in place of .h5.
   pure function states_folder(self) result(folder)
      class(sweep_type), intent(in) :: self
      character(len=length_of_stem(self%result_path) + len('.cases/')) :: folder

      folder = self%result_path(:length_of_stem(self%result_path))//'.cases/'
   end function states_folder

   !> Whether cases read HDF5 files: a body with shape='matrix'.
   pure logical function reads_hdf5(self)
      class(sweep_type), intent(in) :: self
      integer :: i, j, k

      reads_hdf5 = .false.
      do i = 1, size(self%bases)
         do j = 1, size(self%bases(i)%groups)
            associate (entries => self%bases(i)%groups(j)%entries)
               do k = 1, size(entries)
                  if (entries(k)%key == 'shape') reads_hdf5 = reads_hdf5 .or. entries(k)%values(1)%text == 'matrix'
               end do
            end associate
         end do
      end do
      do i = 1, size(self%axes)
         do j = 1, size(self%axes(i)%values)
            reads_hdf5 = reads_hdf5 .or. self%axes(i)%values(j)%text == 'matrix'
         end do
      end do
   end function reads_hdf5

   !> Length of a path without .h5 at its end.
   pure integer function length_of_stem(path) result(length)
      character(*), intent(in) :: path

      length = len(path)
      if (length > 3) then
         if (path(length - 2:) == '.h5') length = length - 3
      end if
   end function length_of_stem

end module mfv_sweep_plan
