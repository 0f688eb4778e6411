!> A scene that is being built, key by key: what a text of namelist groups says, said by calls. Nothing is judged here but what
!> cannot be kept; the case reader judges the whole (mfv_case_reader), with the messages that it has for texts.
module mfv_draft
   use, intrinsic :: ieee_arithmetic, only: ieee_is_finite
   use mfv_case, only: case_type
   use mfv_case_changes, only: put_entry, remove_alternatives, remove_keys, set_dundurs_beta, write_number
   use mfv_case_data, only: case_data_type
   use mfv_case_keys, only: case_catalogue
   use mfv_case_reader, only: read_case_groups
   use mfv_error, only: error_type, set_error
   use mfv_key_path, only: read_key_name
   use mfv_keys, only: catalogue_type
   use mfv_kinds, only: wp
   use mfv_namelist, only: append_group, entry_type, group_type, groups_of_name, parse_namelists, write_namelists
   use mfv_status, only: MFV_INPUT_ERROR
   use mfv_strings, only: lower_case, quoted, string_type, to_text
   use mfv_text_file, only: directory_of
   use mfv_utf8, only: find_fault_of_text
   implicit none
   private
   public :: draft_type, read_draft

   !> Dundurs' parameter can be set as if it were a key; this is the size of the largest.
   character(*), parameter :: dundurs_key = 'dundurs_beta', dundurs_values = 'must be a number from -0.5 to 0.5'
   real(wp), parameter :: largest_beta = 0.5_wp
   character(*), parameter :: line_ends = achar(10)//achar(13)

   !> A fault, and the key that was named: a value for that mends it.
   type :: fault_type
      character(:), allocatable :: name
      type(error_type) :: error
   end type fault_type

   type :: draft_type
      private
      type(group_type), allocatable :: groups(:)
      type(case_data_type) :: data
      !> What messages call it, and where the files are that it names.
      character(:), allocatable :: source, directory
      !> What was wrong with calls that could not be kept.
      type(fault_type), allocatable :: faults(:)
      !> The keys that there are, once one has been named.
      type(catalogue_type), allocatable :: catalogue
   contains
      !> Give a key a value: `call draft%set('body(2)%radius', 0.25_wp)`. Keys: docs/namelist.md. Faults are told by make_case, the
      !> first of those that no later call for the same key has mended; and by `error` (MFV_INPUT_ERROR) where it is there.
      !> 'dundurs_beta', a number, replaces the materials of both bodies, see set_dundurs_beta of mfv_case_changes.
      generic :: set => set_real, set_reals, set_integer, set_logical, set_text
      !> Data in memory in place of a file that a key names, see mfv_case_data: values of shape (rows) or (rows, columns).
      generic :: set_data => set_column, set_matrix
      procedure :: remove
      procedure :: keep_fault
      procedure :: write_text
      procedure :: make_case
      procedure, private :: set_real, set_reals, set_integer, set_logical, set_text, set_column, set_matrix, set_written, &
                            set_materials, find_group
   end type draft_type

contains

   !> A draft from a namelist text, to be changed. `source`: its name for messages; files it names are looked for beside it.
   !> Error MFV_INPUT_ERROR.
   subroutine read_draft(text, source, draft, error)
      character(*), intent(in) :: text, source
      type(draft_type), intent(out) :: draft
      type(error_type), allocatable, intent(out) :: error

      draft%source = source
      draft%directory = directory_of(source)
      call parse_namelists(text, source, draft%groups, error)
   end subroutine read_draft

   !> The group and key of a name; the groups of that name up to its number come to be. Error MFV_INPUT_ERROR.
   subroutine find_group(self, name, group, number, key, error)
      class(draft_type), intent(inout) :: self
      character(*), intent(in) :: name
      character(:), allocatable, intent(out) :: group, key
      integer, intent(out) :: number
      type(error_type), allocatable, intent(out) :: error
      type(group_type) :: new
      character(:), allocatable :: why
      integer :: there

      if (.not. allocated(self%groups)) allocate (self%groups(0))
      if (.not. allocated(self%catalogue)) self%catalogue = case_catalogue()
      call read_key_name(name, self%catalogue, group, number, key, why)
      if (lower_case(name) == dundurs_key) why = quoted(name)//': '//dundurs_values
      there = groups_of_name(self%groups, group)
      if (why == '' .and. (number < 1 .or. number > max(2, there + 1))) &
         why = quoted(name)//': there are '//to_text(there)//' of &'//group//' so far; the next one is '//group//'('// &
               to_text(there + 1)//')'
      if (why /= '') then
         call set_error(error, MFV_INPUT_ERROR, why)
         return
      end if
      do there = there + 1, number
         new%name = group
         allocate (new%entries(0))
         call append_group(self%groups, new)
      end do
   end subroutine find_group

   !> Keep a value as it would be written, or the fault with it (`why`, where it is not empty).
   subroutine set_written(self, name, value, is_quoted, why, error)
      class(draft_type), intent(inout) :: self
      character(*), intent(in) :: name, value, why
      logical, intent(in) :: is_quoted
      type(error_type), allocatable, intent(out), optional :: error
      type(error_type), allocatable :: fault
      type(entry_type) :: entry
      character(:), allocatable :: group
      integer :: number

      call self%find_group(name, group, number, entry%key, fault)
      if (.not. allocated(fault) .and. why /= '') call set_error(fault, MFV_INPUT_ERROR, quoted(name)//': '//why)
      if (.not. allocated(fault)) then
         allocate (entry%values(1))
         entry%values(1)%text = value
         entry%is_quoted = [is_quoted]
         call put_entry(self%groups, group, number, entry)
      end if
      call tell(self, name, fault, error)
   end subroutine set_written

   !> Take a key out, as if it had never been given a value; no harm where it has none. `alternatives`: take out, too, those that it
   !> is an alternative to, such as tangential_force and force_ratio for shift, so that it can be given a value. Fault and `error`
   !> as of set.
   subroutine remove(self, name, error, alternatives)
      class(draft_type), intent(inout) :: self
      character(*), intent(in) :: name
      type(error_type), allocatable, intent(out), optional :: error
      logical, intent(in), optional :: alternatives
      type(error_type), allocatable :: fault
      character(:), allocatable :: group, key
      integer :: number
      logical :: is_alone

      is_alone = .true.
      if (present(alternatives)) is_alone = .not. alternatives
      call self%find_group(name, group, number, key, fault)
      if (.not. allocated(fault)) then
         if (is_alone) then
            call remove_keys(self%groups, group, number, key)
         else
            call remove_alternatives(self%groups, group, number, key)
         end if
      end if
      call tell(self, name, fault, error)
   end subroutine remove

   !> Keep a fault, and tell it to a caller who wants to know. A call for the same key that goes well mends it.
   subroutine tell(self, name, fault, error)
      class(draft_type), intent(inout) :: self
      character(*), intent(in) :: name
      type(error_type), allocatable, intent(in) :: fault
      type(error_type), allocatable, intent(out), optional :: error

      call mend(self, name)
      if (.not. allocated(fault)) return
      call self%keep_fault(name, fault)
      if (present(error)) error = fault
   end subroutine tell

   !> Keep a fault with a key for make_case to tell.
   subroutine keep_fault(self, name, fault)
      class(draft_type), intent(inout) :: self
      character(*), intent(in) :: name
      type(error_type), intent(in) :: fault
      type(fault_type), allocatable :: longer(:)
      integer :: i, n

      n = 0
      if (allocated(self%faults)) n = size(self%faults)
      allocate (longer(n + 1))
      do i = 1, n
         longer(i) = self%faults(i)
      end do
      longer(n + 1)%name = name
      longer(n + 1)%error = fault
      call move_alloc(longer, self%faults)
   end subroutine keep_fault

   !> Drop the faults with a key.
   subroutine mend(self, name)
      class(draft_type), intent(inout) :: self
      character(*), intent(in) :: name
      type(fault_type), allocatable :: old(:)
      integer :: i

      if (.not. allocated(self%faults)) return
      call move_alloc(self%faults, old)
      do i = 1, size(old)
         if (old(i)%name /= name) call self%keep_fault(old(i)%name, old(i)%error)
      end do
   end subroutine mend

   subroutine set_real(self, name, value, error)
      class(draft_type), intent(inout) :: self
      character(*), intent(in) :: name
      real(wp), intent(in) :: value
      type(error_type), allocatable, intent(out), optional :: error
      character(:), allocatable :: text

      if (lower_case(name) == dundurs_key) then
         call self%set_materials(value, error)
      else if (ieee_is_finite(value)) then
         call write_number(value, text)
         call self%set_written(name, text, .false., '', error)
      else
         call self%set_written(name, '', .false., 'the value is not finite', error)
      end if
   end subroutine set_real

   !> Give both bodies materials with Dundurs' parameter `beta`; the mutual compliance stays as it is. Fault and `error` as of set;
   !> also where the scene so far is not a valid one.
   subroutine set_materials(self, beta, error)
      class(draft_type), intent(inout) :: self
      real(wp), intent(in) :: beta
      type(error_type), allocatable, intent(out), optional :: error
      type(error_type), allocatable :: fault
      type(case_type) :: case

      if (.not. (ieee_is_finite(beta) .and. abs(beta) <= largest_beta)) then
         call set_error(fault, MFV_INPUT_ERROR, dundurs_key//'='//to_text(beta)//': '//dundurs_values)
      else
         call mend(self, dundurs_key)
         call self%make_case(case, fault)
         if (allocated(fault)) fault%message = quoted(dundurs_key)//': '//fault%message
      end if
      if (.not. allocated(fault)) then
         if (case%scene%modulus() > 0.0_wp) then
            call set_dundurs_beta(self%groups, beta, 1.0_wp/case%scene%modulus())
         else
            call set_error(fault, MFV_INPUT_ERROR, dundurs_key//" needs bodies with materials, not shape='matrix'")
         end if
      end if
      call tell(self, dundurs_key, fault, error)
   end subroutine set_materials

   subroutine set_reals(self, name, values, error)
      class(draft_type), intent(inout) :: self
      character(*), intent(in) :: name
      real(wp), intent(in) :: values(:)
      type(error_type), allocatable, intent(out), optional :: error
      type(error_type), allocatable :: fault
      type(entry_type) :: entry
      character(:), allocatable :: group, key
      integer :: number, i

      call self%find_group(name, group, number, key, fault)
      if (.not. allocated(fault) .and. size(values) == 0) &
         call set_error(fault, MFV_INPUT_ERROR, quoted(name)//': there are no values')
      if (.not. allocated(fault) .and. .not. all(ieee_is_finite(values))) &
         call set_error(fault, MFV_INPUT_ERROR, quoted(name)//': value '// &
                        to_text(findloc(ieee_is_finite(values), .false., dim=1))//' is not finite')
      if (.not. allocated(fault)) then
         entry%key = key
         allocate (entry%values(size(values)), entry%is_quoted(size(values)))
         entry%is_quoted = .false.
         do i = 1, size(values)
            call write_number(values(i), entry%values(i)%text)
         end do
         call put_entry(self%groups, group, number, entry)
      end if
      call tell(self, name, fault, error)
   end subroutine set_reals

   subroutine set_integer(self, name, value, error)
      class(draft_type), intent(inout) :: self
      character(*), intent(in) :: name
      integer, intent(in) :: value
      type(error_type), allocatable, intent(out), optional :: error

      if (lower_case(name) == dundurs_key) then
         call self%set_materials(real(value, wp), error)
      else
         call self%set_written(name, to_text(value), .false., '', error)
      end if
   end subroutine set_integer

   subroutine set_logical(self, name, value, error)
      class(draft_type), intent(inout) :: self
      character(*), intent(in) :: name
      logical, intent(in) :: value
      type(error_type), allocatable, intent(out), optional :: error

      call self%set_written(name, trim(merge('.true. ', '.false.', value)), .false., '', error)
   end subroutine set_logical

   subroutine set_text(self, name, value, error)
      class(draft_type), intent(inout) :: self
      character(*), intent(in) :: name, value
      type(error_type), allocatable, intent(out), optional :: error
      character(:), allocatable :: why
      integer :: line

      call find_fault_of_text(value, line, why)
      if (scan(value, line_ends) > 0) why = 'a text must be of one line'
      if (why /= '') then
         call self%set_written(name, '', .true., why, error)
      else
         call self%set_written(name, value, .true., '', error)
      end if
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
         call set_error(fault, MFV_INPUT_ERROR, 'the name of data must be of one line')
      else if (index(' '//known//' ', ' '//name//' ') == 0 .or. name == '') then
         call set_error(fault, MFV_INPUT_ERROR, "the data '"//file//"': unknown dataset '"//name//"'; datasets are "//known)
      else
         call self%data%put(file, name, values)
      end if
      call tell(self, file, fault, error)
   end subroutine set_matrix

   !> The scene as a text of namelist groups; comments say which data were in memory.
   subroutine write_text(self, text)
      class(draft_type), intent(in) :: self
      character(:), allocatable, intent(out) :: text
      character(len=1), parameter :: line_feed = achar(10)
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
         call set_error(error, self%faults(1)%error%status, source//': '//self%faults(1)%error%message)
         return
      end if
      allocate (groups(0))
      if (allocated(self%groups)) groups = self%groups
      call check_data(self%data, groups, source, error)
      if (allocated(error)) return
      call read_case_groups(groups, source, directory, case, error, without_steps=.true., data=self%data)
      if (allocated(error)) return
      call self%write_text(text)
      case%text = text
   end subroutine make_case

   !> Data that no key names are a mistake: error MFV_INPUT_ERROR.
   subroutine check_data(data, groups, source, error)
      type(case_data_type), intent(in) :: data
      type(group_type), intent(in) :: groups(:)
      character(*), intent(in) :: source
      type(error_type), allocatable, intent(out) :: error
      integer :: i

      if (.not. allocated(data%datasets)) return
      do i = 1, size(data%datasets)
         if (is_named(data%datasets(i)%file, groups)) cycle
         call set_error(error, MFV_INPUT_ERROR, source//": no key names the data '"//data%datasets(i)%file//"'; a body has "// &
                        'file, &friction has mu_file')
         return
      end do
   end subroutine check_data

   !> Whether a key names a file.
   pure logical function is_named(file, groups)
      character(*), intent(in) :: file
      type(group_type), intent(in) :: groups(:)
      integer :: i, j

      is_named = .false.
      do i = 1, size(groups)
         do j = 1, size(groups(i)%entries)
            if (groups(i)%entries(j)%key /= 'file' .and. groups(i)%entries(j)%key /= 'mu_file') cycle
            is_named = is_named .or. any(same(groups(i)%entries(j)%values, file))
         end do
      end do
   end function is_named

   !> Whether texts are this one.
   elemental logical function same(one, other)
      type(string_type), intent(in) :: one
      character(*), intent(in) :: other

      same = one%text == other
   end function same

end module mfv_draft
