!> Scene builder: sets the keys of a case by calls instead of a text. Only values that cannot be stored are refused here; the case
!> reader (mfv_case_reader) checks the scene, with the same messages as for texts.
module mfv_draft
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use mfv_case, only: case_type
   use mfv_case_data, only: case_data_type
   use mfv_case_keys, only: case_catalogue
   use mfv_case_reader, only: read_case_groups
   use mfv_error, only: error_type, set_error
   use mfv_keys, only: catalogue_type, read_key_name
   use mfv_kinds, only: wp
   use mfv_material, only: flexibilities
   use mfv_motions, only: motions, motion_count => user_motions
   use mfv_namelist, only: entry_type, group_type, parse_namelists, resize_entries, resize_groups, write_namelists
   use mfv_numbers, only: write_real
   use mfv_status, only: MFV_INPUT_ERROR
   use mfv_strings, only: has_word, line_feed, lower_case, quoted, string_type, to_text
   use mfv_text_file, only: directory_of, find_fault_of_text
   implicit none
   private
   public :: draft_type, read_draft

   !> Dundurs' parameter can be set like a key; its largest magnitude.
   character(*), parameter :: dundurs_key = 'dundurs_beta', dundurs_values = 'must be a number from -0.5 to 0.5'
   real(wp), parameter :: largest_beta = 0.5_wp
   character(*), parameter :: line_ends = achar(10)//achar(13)
   !> Keys of one group that exclude each other; the last row with a key applies.
   character(*), parameter :: alternatives_of(motion_count + 4) = &
                              [character(56) :: motions(:motion_count)%force_key//' '//motions(:motion_count)%key, &
                                   'normal_force approach normal_intensity', 'tangential_force force_ratio shift shear_intensity', &
                                                 'shear_modulus youngs_modulus', 'half_width half_angle']

   !> An error of a call, and the key that was named: setting that key again clears it.
   type :: fault_type
      character(:), allocatable :: name
      type(error_type) :: error
   end type fault_type

   type :: draft_type
      private
      type(group_type), allocatable :: groups(:)
      type(case_data_type) :: data
      !> Its name for messages, and the directory of the files that it names.
      character(:), allocatable :: source, directory
      !> Errors of calls whose values could not be stored.
      type(fault_type), allocatable :: faults(:)
      !> Catalogue of keys; allocated by the first call.
      type(catalogue_type), allocatable :: catalogue
   contains
      !> Give a key a value: `call draft%set('body(2)%radius', 0.25_wp)`. Keys: docs/namelist.md. Errors (MFV_INPUT_ERROR) are
      !> returned in `error`, if present, and by make_case, unless a later call sets the same key correctly.
      !> 'dundurs_beta', a number, replaces the materials of both bodies, see flexibilities of mfv_material.
      generic :: set => set_real, set_reals, set_integer, set_logical, set_text
      !> Data in memory instead of a file that a key names, see mfv_case_data: values of shape (rows) or (rows, columns).
      generic :: set_data => set_column, set_matrix
      procedure :: remove
      procedure :: keep_fault
      procedure :: write_text
      procedure :: make_case
      procedure, private :: set_real, set_reals, set_integer, set_logical, set_text, set_column, set_matrix, set_value, &
         set_values, set_materials, write_materials, find_group
   end type draft_type

contains

   !> A scene builder from a namelist text. `source`: its name for messages, and the path to which file names are relative. `data`:
   !> instead of files that the text names. Error MFV_INPUT_ERROR.
   subroutine read_draft(text, source, draft, error, data)
      character(*), intent(in) :: text, source
      type(draft_type), intent(out) :: draft
      type(error_type), allocatable, intent(out) :: error
      type(case_data_type), intent(in), optional :: data

      draft%source = source
      draft%directory = directory_of(source)
      call parse_namelists(text, source, draft%groups, error)
      if (allocated(error)) deallocate (draft%groups)
      if (present(data)) draft%data = data
   end subroutine read_draft

   !> Index of the group in the name of a key, created if needed, and the key. Error MFV_INPUT_ERROR.
   subroutine find_group(self, name, place, key, error)
      class(draft_type), intent(inout) :: self
      character(*), intent(in) :: name
      integer, intent(out) :: place
      character(:), allocatable, intent(out) :: key
      type(error_type), allocatable, intent(out) :: error
      character(:), allocatable :: group, why
      integer :: number, there

      if (.not. allocated(self%groups)) allocate (self%groups(0))
      if (.not. allocated(self%catalogue)) self%catalogue = case_catalogue()
      call read_key_name(name, self%catalogue, group, number, key, why)
      if (lower_case(name) == dundurs_key) why = quoted(name)//': '//dundurs_values
      there = 0
      do place = 1, size(self%groups)
         if (self%groups(place)%name /= group) cycle
         there = there + 1
         if (there == number) exit
      end do
      if (why == '' .and. (number < 1 .or. number > max(2, there + 1))) &
         why = quoted(name)//': there are '//to_text(there)//' of &'//group//' so far; the next one is '//group//'('// &
               to_text(there + 1)//')'
      if (why /= '') then
         call set_error(error, MFV_INPUT_ERROR, why)
         return
      end if
      do there = there + 1, number
         place = size(self%groups) + 1
         call resize_groups(self%groups, place)
         self%groups(place)%name = group
         allocate (self%groups(place)%entries(0))
      end do
   end subroutine find_group

   !> Set a key to values as they would be written, or store an error (`why`, if not empty).
   subroutine set_values(self, name, values, is_quoted, why, error)
      class(draft_type), intent(inout) :: self
      character(*), intent(in) :: name, why
      type(string_type), intent(in) :: values(:)
      logical, intent(in) :: is_quoted
      type(error_type), allocatable, intent(out), optional :: error
      type(error_type), allocatable :: fault
      type(entry_type) :: entry
      integer :: place

      call self%find_group(name, place, entry%key, fault)
      if (.not. allocated(fault) .and. why /= '') call set_error(fault, MFV_INPUT_ERROR, quoted(name)//': '//why)
      if (.not. allocated(fault)) then
         entry%values = values
         allocate (entry%is_quoted(size(values)), source=is_quoted)
         call put_entry(self%groups(place), entry)
      end if
      call self%keep_fault(name, fault, error)
   end subroutine set_values

   !> The same for one value.
   subroutine set_value(self, name, value, is_quoted, why, error)
      class(draft_type), intent(inout) :: self
      character(*), intent(in) :: name, value, why
      logical, intent(in) :: is_quoted
      type(error_type), allocatable, intent(out), optional :: error
      type(string_type) :: values(1)

      values(1)%text = value
      call self%set_values(name, values, is_quoted, why, error)
   end subroutine set_value

   !> Replace the entry with the same key, keeping its line, or append the entry.
   subroutine put_entry(group, entry)
      type(group_type), intent(inout) :: group
      type(entry_type), intent(inout) :: entry
      integer :: i

      do i = 1, size(group%entries)
         if (group%entries(i)%key == entry%key) exit
      end do
      entry%line = group%line
      if (i <= size(group%entries)) then
         entry%line = group%entries(i)%line
      else
         call resize_entries(group%entries, i)
      end if
      group%entries(i) = entry
   end subroutine put_entry

   !> Remove a key, if it is set. `alternatives`: also remove its alternatives, such as tangential_force and force_ratio for shift,
   !> so that it can be set. Errors as for set.
   subroutine remove(self, name, error, alternatives)
      class(draft_type), intent(inout) :: self
      character(*), intent(in) :: name
      type(error_type), allocatable, intent(out), optional :: error
      logical, intent(in), optional :: alternatives
      type(error_type), allocatable :: fault
      character(:), allocatable :: key, keys
      integer :: place, i

      call self%find_group(name, place, key, fault)
      if (.not. allocated(fault)) then
         keys = key
         if (present(alternatives)) then
            do i = 1, size(alternatives_of)
               if (alternatives .and. has_word(alternatives_of(i), key)) keys = alternatives_of(i)
            end do
         end if
         call remove_keys(self%groups(place), keys)
      end if
      call self%keep_fault(name, fault, error)
   end subroutine remove

   !> Remove keys, separated by blanks, from a group.
   subroutine remove_keys(group, keys)
      type(group_type), intent(inout) :: group
      character(*), intent(in) :: keys
      integer :: i, n

      n = 0
      do i = 1, size(group%entries)
         if (has_word(keys, group%entries(i)%key)) cycle
         n = n + 1
         if (n < i) group%entries(n) = group%entries(i)
      end do
      call resize_entries(group%entries, n)
   end subroutine remove_keys

   !> Store the error of a key for make_case, instead of an earlier one, and return it in `error`. Without `fault` the earlier error
   !> is cleared.
   subroutine keep_fault(self, name, fault, error)
      class(draft_type), intent(inout) :: self
      character(*), intent(in) :: name
      type(error_type), intent(in), optional :: fault
      type(error_type), allocatable, intent(out), optional :: error
      type(fault_type), allocatable :: old(:)
      integer :: i, n

      if (.not. allocated(self%faults)) allocate (self%faults(0))
      call move_alloc(self%faults, old)
      n = count([(old(i)%name /= name, i=1, size(old))])
      allocate (self%faults(n + merge(1, 0, present(fault))))
      n = 0
      do i = 1, size(old)
         if (old(i)%name == name) cycle
         n = n + 1
         self%faults(n) = old(i)
      end do
      if (.not. present(fault)) return
      self%faults(n + 1)%name = name
      self%faults(n + 1)%error = fault
      if (present(error)) error = fault
   end subroutine keep_fault

   subroutine set_real(self, name, value, error)
      class(draft_type), intent(inout) :: self
      character(*), intent(in) :: name
      real(wp), intent(in) :: value
      type(error_type), allocatable, intent(out), optional :: error
      character(:), allocatable :: text

      if (lower_case(name) == dundurs_key) then
         call self%set_materials(value, error)
      else if (ieee_is_finite(value)) then
         call write_real(value, text)
         call self%set_value(name, text, .false., '', error)
      else
         call self%set_value(name, '', .false., 'the value is not finite', error)
      end if
   end subroutine set_real

   !> Give both bodies materials with Dundurs' parameter `beta`, without changing the mutual compliance. Errors as for set, and if
   !> the scene so far is not valid.
   subroutine set_materials(self, beta, error)
      class(draft_type), intent(inout) :: self
      real(wp), intent(in) :: beta
      type(error_type), allocatable, intent(out), optional :: error
      type(error_type), allocatable :: fault
      type(case_type) :: case

      if (.not. (ieee_is_finite(beta) .and. abs(beta) <= largest_beta)) then
         call set_error(fault, MFV_INPUT_ERROR, dundurs_key//'='//to_text(beta)//': '//dundurs_values)
      else
         call self%keep_fault(dundurs_key)
         call self%make_case(case, fault)
         if (allocated(fault)) fault%message = quoted(dundurs_key)//': '//fault%message
      end if
      if (.not. allocated(fault)) then
         if (case%scene%lower%elasticity%material%is_anisotropic() .or. &
             case%scene%upper%elasticity%material%is_anisotropic()) then
            call set_error(fault, MFV_INPUT_ERROR, dundurs_key//' needs isotropic bodies')
         else if (case%scene%is_layered()) then
            call set_error(fault, MFV_INPUT_ERROR, dundurs_key//' needs bodies without layers')
         else if (case%scene%modulus() > 0.0_wp) then
            call self%write_materials(flexibilities(beta, 1.0_wp/case%scene%modulus()))
         else
            call set_error(fault, MFV_INPUT_ERROR, dundurs_key//" needs bodies with materials, not shape='matrix'")
         end if
      end if
      call self%keep_fault(dundurs_key, fault, error)
   end subroutine set_materials

   !> Give both bodies a flexibility 1/G each, length^2/force, and Poisson's ratio 0. One without flexibility becomes rigid.
   subroutine write_materials(self, flexibility)
      class(draft_type), intent(inout) :: self
      real(wp), intent(in) :: flexibility(2)
      type(error_type), allocatable :: error
      character(:), allocatable :: key
      character(len=*), parameter :: groups(2) = ['body(1)%', 'body(2)%']
      integer :: body, place

      do body = 1, 2
         call self%find_group(groups(body)//'rigid', place, key, error)
         call remove_keys(self%groups(place), 'shear_modulus youngs_modulus poisson_ratio rigid')
         if (flexibility(body) > 0.0_wp) then
            call self%set(groups(body)//'shear_modulus', 1.0_wp/flexibility(body))
            call self%set(groups(body)//'poisson_ratio', 0.0_wp)
         else
            call remove_keys(self%groups(place), 'yield_strength datum elasticity kernel harmonics')
            call self%set(groups(body)//'rigid', .true.)
         end if
      end do
   end subroutine write_materials

   subroutine set_reals(self, name, values, error)
      class(draft_type), intent(inout) :: self
      character(*), intent(in) :: name
      real(wp), intent(in) :: values(:)
      type(error_type), allocatable, intent(out), optional :: error
      type(string_type), allocatable :: texts(:)
      character(:), allocatable :: why
      integer :: i

      allocate (texts(size(values)))
      why = ''
      if (size(values) == 0) why = 'no values are given'
      do i = 1, size(values)
         if (ieee_is_finite(values(i))) then
            call write_real(values(i), texts(i)%text)
         else if (why == '') then
            why = 'value '//to_text(i)//' is not finite'
         end if
      end do
      call self%set_values(name, texts, .false., why, error)
   end subroutine set_reals

   subroutine set_integer(self, name, value, error)
      class(draft_type), intent(inout) :: self
      character(*), intent(in) :: name
      integer, intent(in) :: value
      type(error_type), allocatable, intent(out), optional :: error

      if (lower_case(name) == dundurs_key) then
         call self%set_materials(real(value, wp), error)
      else
         call self%set_value(name, to_text(value), .false., '', error)
      end if
   end subroutine set_integer

   subroutine set_logical(self, name, value, error)
      class(draft_type), intent(inout) :: self
      character(*), intent(in) :: name
      logical, intent(in) :: value
      type(error_type), allocatable, intent(out), optional :: error

      call self%set_value(name, trim(merge('.true. ', '.false.', value)), .false., '', error)
   end subroutine set_logical

   subroutine set_text(self, name, value, error)
      class(draft_type), intent(inout) :: self
      character(*), intent(in) :: name, value
      type(error_type), allocatable, intent(out), optional :: error
      character(:), allocatable :: why
      integer :: line

      call find_fault_of_text(value, line, why)
      if (scan(value, line_ends) > 0) why = 'a text must not contain a line break'
      call self%set_value(name, value, .true., why, error)
   end subroutine set_text

   subroutine set_column(self, file, name, values, error)
      class(draft_type), intent(inout) :: self
      character(*), intent(in) :: file, name
      real(wp), intent(in) :: values(:)
      type(error_type), allocatable, intent(out), optional :: error

      call self%set_matrix(file, name, reshape(values, [size(values), 1]), error)
   end subroutine set_column

   subroutine set_matrix(self, file, name, values, error)
      class(draft_type), intent(inout) :: self
      character(*), intent(in) :: file, name
      real(wp), intent(in) :: values(:, :)
      type(error_type), allocatable, intent(out), optional :: error
      type(error_type), allocatable :: fault
      character(*), parameter :: known = 'x height mu mu_static mu_kinetic gap width compliance stiffness'

      if (scan(file, line_ends) > 0) then
         call set_error(fault, MFV_INPUT_ERROR, 'the name of data must not contain a line break')
      else if (.not. has_word(known, name)) then
         call set_error(fault, MFV_INPUT_ERROR, "the data '"//file//"': unknown dataset '"//name//"'; datasets are "//known)
      else
         call self%data%put(file, name, values)
      end if
      call self%keep_fault(file, fault, error)
   end subroutine set_matrix

   !> The scene as a text of namelist groups; comments name the data in memory.
   subroutine write_text(self, text)
      class(draft_type), intent(in) :: self
      character(:), allocatable, intent(out) :: text
      integer :: i

      text = ''
      if (allocated(self%groups)) call write_namelists(self%groups, text)
      if (.not. allocated(self%data%datasets)) return
      do i = size(self%data%datasets), 1, -1
         associate (dataset => self%data%datasets(i))
            text = "! '"//dataset%file//"' was given in memory: "//dataset%name//', '//to_text(size(dataset%values, 1))//' x '// &
                   to_text(size(dataset%values, 2))//line_feed//text
         end associate
      end do
   end subroutine write_text

   !> The case. It may have no steps. Error MFV_INPUT_ERROR.
   subroutine make_case(self, case, error)
      class(draft_type), intent(in) :: self
      type(case_type), intent(out) :: case
      type(error_type), allocatable, intent(out) :: error
      character(:), allocatable :: source, directory, text
      type(group_type), allocatable :: groups(:)

      source = 'scene'
      directory = ''
      if (allocated(self%source)) source = self%source
      if (allocated(self%directory)) directory = self%directory
      if (allocated(self%faults)) then
         if (size(self%faults) > 0) &
            call set_error(error, self%faults(1)%error%status, source//': '//self%faults(1)%error%message)
         if (allocated(error)) return
      end if
      allocate (groups(0))
      if (allocated(self%groups)) groups = self%groups
      call check_data(self%data, groups, source, error)
      if (allocated(error)) return
      call read_case_groups(groups, source, directory, case, error, without_steps=.true., data=self%data)
      if (allocated(error)) return
      call self%write_text(text)
      case%text = text
      case%data = self%data
   end subroutine make_case

   !> Error MFV_INPUT_ERROR for data that no key refers to.
   subroutine check_data(data, groups, source, error)
      type(case_data_type), intent(in) :: data
      type(group_type), intent(in) :: groups(:)
      character(*), intent(in) :: source
      type(error_type), allocatable, intent(out) :: error
      logical :: is_named
      integer :: i, j, k

      if (.not. allocated(data%datasets)) return
      do i = 1, size(data%datasets)
         is_named = .false.
         do j = 1, size(groups)
            do k = 1, size(groups(j)%entries)
               associate (entry => groups(j)%entries(k))
                  if (.not. has_word('file mu_file', entry%key) .or. size(entry%values) == 0) cycle
                  is_named = is_named .or. entry%values(1)%text == data%datasets(i)%file
               end associate
            end do
         end do
         if (is_named) cycle
         call set_error(error, MFV_INPUT_ERROR, source//": no key refers to the data '"//data%datasets(i)%file//"'; set file "// &
                        'of a body or mu_file of &friction to this name')
         return
      end do
   end subroutine check_data

end module mfv_draft
