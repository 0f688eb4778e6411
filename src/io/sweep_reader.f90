!> From the text of a sweep to a valid sweep, or to a message that names file, line, group, key, value and what is right.
module mfv_sweep_reader
   use, intrinsic :: iso_fortran_env, only: int64
   use mfv_case, only: case_type
   use mfv_case_changes, only: stands_for, write_number
   use mfv_case_keys, only: case_catalogue
   use mfv_case_reader, only: read_case_groups
   use mfv_checksum, only: add_text_to_checksum
   use mfv_error, only: error_type
   use mfv_key_path, only: read_key_name
   use mfv_key_reader
   use mfv_keys
   use mfv_kinds, only: wp
   use mfv_namelist, only: entry_type, groups_of_name, parse_namelists
   use mfv_observables, only: observable_count, observable_name
   use mfv_strings, only: lower_case, quoted, to_text
   use mfv_sweep_columns, only: column_type, from_axis, list_columns
   use mfv_sweep_keys, only: sweep_catalogue
   use mfv_sweep_plan
   use mfv_sweep_record, only: record_layout
   use mfv_text_file, only: directory_of, path_beside, read_bytes, read_text, stem_of
   use mfv_version, only: library_version
   implicit none
   private
   public :: read_sweep_file, read_sweep_text, most_cases

   !> Cases that a sweep can have.
   integer, parameter :: most_cases = 10000000

contains

   !> The sweep in a file. `tries_values`: see read_sweep_text. Error MFV_INPUT_ERROR.
   subroutine read_sweep_file(path, sweep, error, tries_values)
      character(*), intent(in) :: path
      type(sweep_type), intent(out) :: sweep
      type(error_type), allocatable, intent(out) :: error
      logical, intent(in), optional :: tries_values
      character(:), allocatable :: text

      call read_text(path, text, error)
      if (allocated(error)) return
      call read_sweep_text(text, path, sweep, error, tries_values)
      if (allocated(error)) return
      if (sweep%result_path == '') sweep%result_path = stem_of(path)//'.h5'
   end subroutine read_sweep_file

   !> The sweep in a text. `source`: its name for messages; the base cases are looked for beside it. `tries_values`:
   !> whether the values are tried in cases, which takes time where there are many; they are unless told. Error MFV_INPUT_ERROR.
   subroutine read_sweep_text(text, source, sweep, error, tries_values)
      character(*), intent(in) :: text, source
      type(sweep_type), intent(out) :: sweep
      type(error_type), allocatable, intent(out) :: error
      logical, intent(in), optional :: tries_values
      type(reader_type) :: reader
      logical :: is_tried

      is_tried = .true.
      if (present(tries_values)) is_tried = tries_values
      reader%source = source
      reader%directory = directory_of(source)
      reader%catalogue = sweep_catalogue()
      sweep%source = source
      sweep%text = text
      call parse_namelists(text, source, reader%groups, error)
      if (.not. allocated(error)) call check_groups(reader, error)
      if (.not. allocated(error)) call check_entries(reader, error)
      if (.not. allocated(error)) call read_choices(reader, sweep, error)
      if (.not. allocated(error)) call read_bases(reader, sweep, error)
      if (.not. allocated(error)) call read_axes(reader, sweep, error)
      if (.not. allocated(error)) call check_count(reader, sweep, error)
      if (.not. allocated(error)) call find_reference(reader, sweep, error)
      if (.not. allocated(error)) call check_columns(reader, sweep, error)
      if (is_tried .and. .not. allocated(error)) call check_values(reader, sweep, error)
      if (.not. allocated(error)) call find_checksum(sweep, error)
   end subroutine read_sweep_text

   subroutine read_choices(reader, sweep, error)
      type(reader_type), intent(in) :: reader
      type(sweep_type), intent(inout) :: sweep
      type(error_type), allocatable, intent(out) :: error

      if (count_groups(reader, 'sweep') == 0) then
         call fail(reader, 0, '&sweep: the group is missing', error)
         return
      end if
      call reader%need('sweep', 1, 'base', error)
      sweep%paired = reader%text_value('sweep', 1, 'combine') == 'paired'
      sweep%keeps_states = reader%text_value('sweep', 1, 'states') == 'all'
      sweep%has_reference = reader%text_value('sweep', 1, 'reference') == 'full'
      sweep%result_path = reader%text_value('sweep', 1, 'file')
   end subroutine read_choices

   !> The base cases: each a valid one, and all with the same names of units.
   subroutine read_bases(reader, sweep, error)
      type(reader_type), intent(in) :: reader
      type(sweep_type), intent(inout) :: sweep
      type(error_type), allocatable, intent(out) :: error
      type(entry_type) :: entry
      type(case_type) :: case
      type(error_type), allocatable :: case_error
      logical :: found
      integer :: i

      call reader%entry_of('sweep', 1, 'base', entry, found)
      allocate (sweep%bases(size(entry%values)))
      do i = 1, size(sweep%bases)
         call read_base(reader, entry%values(i)%text, sweep%bases(i), case, case_error)
         if (allocated(case_error)) then
            call reader%complain('sweep', 1, 'base', case_error%message, error)
            return
         end if
         if (i == 1) then
            sweep%length_unit = case%length_unit
            sweep%force_unit = case%force_unit
         else if (case%length_unit /= sweep%length_unit .or. case%force_unit /= sweep%force_unit) then
            call reader%complain('sweep', 1, 'base', sweep%bases(i)%name//' names other units than '//sweep%bases(1)%name// &
                                 ' (length_unit, force_unit); one table has one system of units', error)
            return
         end if
      end do
   end subroutine read_bases

   !> One base case.
   subroutine read_base(reader, name, base, case, error)
      type(reader_type), intent(in) :: reader
      character(*), intent(in) :: name
      type(base_type), intent(out) :: base
      type(case_type), intent(out) :: case
      type(error_type), allocatable, intent(out) :: error
      character(:), allocatable :: path

      path = path_beside(reader%directory, name)
      base%name = name
      base%directory = directory_of(path)
      call read_text(path, base%text, error)
      if (.not. allocated(error)) call parse_namelists(base%text, name, base%groups, error)
      if (.not. allocated(error)) call read_case_groups(base%groups, name, base%directory, case, error)
   end subroutine read_base

   !> All &vary.
   subroutine read_axes(reader, sweep, error)
      type(reader_type), intent(in) :: reader
      type(sweep_type), intent(inout) :: sweep
      type(error_type), allocatable, intent(out) :: error
      integer :: i

      allocate (sweep%axes(count_groups(reader, 'vary')))
      do i = 1, size(sweep%axes)
         sweep%axes(i)%line = line_of(reader, 'vary', i)
         call read_targets(reader, i, sweep, sweep%axes(i), error)
         if (.not. allocated(error)) call read_values(reader, i, sweep%axes(i), error)
         if (.not. allocated(error)) call check_kinds(reader, i, sweep%axes(i), error)
         if (allocated(error)) return
      end do
   end subroutine read_axes

   !> The keys that &vary `number` varies, with their factors.
   subroutine read_targets(reader, number, sweep, axis, error)
      type(reader_type), intent(in) :: reader
      integer, intent(in) :: number
      type(sweep_type), intent(in) :: sweep
      type(axis_type), intent(inout) :: axis
      type(error_type), allocatable, intent(out) :: error
      type(entry_type) :: entry
      real(wp), allocatable :: factors(:)
      character(:), allocatable :: why
      logical :: found
      integer :: i

      call reader%need('vary', number, 'key', error)
      if (allocated(error)) return
      call reader%entry_of('vary', number, 'key', entry, found)
      allocate (axis%targets(size(entry%values)))
      do i = 1, size(axis%targets)
         call read_target(entry%values(i)%text, sweep, axis%targets(i), why)
         if (why == '') call find_clash_of_materials(sweep%axes(:number - 1), axis%targets(:i - 1), axis%targets(i), why)
         if (why == '' .and. is_varied(sweep%axes(:number - 1), axis%targets(:i - 1), axis%targets(i))) &
            why = quoted(entry%values(i)%text)//': is varied already'
         if (why /= '') then
            call reader%complain('vary', number, 'key', why, error)
            return
         end if
      end do
      axis%name = entry%values(1)%text
      if (reader%has('vary', number, 'name')) axis%name = reader%text_value('vary', number, 'name')
      call reader%real_values('vary', number, 'factor', factors)
      if (.not. allocated(factors)) return
      if (size(factors) == size(axis%targets)) then
         axis%targets%factor = factors
      else
         call reader%complain('vary', number, 'factor', 'must have one value a key, '//to_text(size(axis%targets))//', not '// &
                              to_text(size(factors)), error)
      end if
   end subroutine read_targets

   !> A key as written: group%key or group(number)%key; `why` says what is wrong with it, empty where nothing is.
   subroutine read_target(written, sweep, target, why)
      character(*), intent(in) :: written
      type(sweep_type), intent(in) :: sweep
      type(target_type), intent(out) :: target
      character(:), allocatable, intent(out) :: why
      type(catalogue_type) :: catalogue

      catalogue = case_catalogue()
      why = ''
      target%group = ''
      target%key = lower_case(written)
      if (target%key == dundurs_key) return
      call read_key_name(written, catalogue, target%group, target%number, target%key, why)
      if (why /= '') then
         if (index(written, '%') == 0) why = why//' or '//quoted(dundurs_key)
         return
      end if
      target%is_whole = catalogue%keys(catalogue%place(target%group, target%key))%kind == kind_integer
      call check_target(catalogue, sweep, target, why)
      if (why /= '') why = quoted(written)//': '//why
   end subroutine read_target

   !> A key that a sweep can vary, in a group that every base has.
   subroutine check_target(catalogue, sweep, target, why)
      type(catalogue_type), intent(in) :: catalogue
      type(sweep_type), intent(in) :: sweep
      type(target_type), intent(in) :: target
      character(:), allocatable, intent(out) :: why
      integer :: i, there

      why = ''
      if (target%group == 'output' .and. target%key == 'file') why = 'the sweep names its files itself'
      if (why /= '' .or. .not. catalogue%repeats(target%group)) return
      do i = 1, size(sweep%bases)
         there = groups_of_name(sweep%bases(i)%groups, target%group)
         if (target%number >= 1 .and. target%number <= there) cycle
         why = 'there is no &'//target%group//' '//to_text(target%number)//' in '//sweep%bases(i)%name//', which has '// &
               to_text(there)
         return
      end do
   end subroutine check_target

   !> Dundurs' parameter decides the materials of both bodies: `why` names a key of a material that is varied beside it, empty
   !> where there is none.
   subroutine find_clash_of_materials(axes, targets, target, why)
      type(axis_type), intent(in) :: axes(:)
      type(target_type), intent(in) :: targets(:), target
      character(:), allocatable, intent(out) :: why
      integer :: i

      why = ''
      call find_clash_among(targets, target, why)
      do i = 1, size(axes)
         if (why == '') call find_clash_among(axes(i)%targets, target, why)
      end do
   end subroutine find_clash_of_materials

   !> The same, among the keys of one axis.
   subroutine find_clash_among(targets, target, why)
      type(target_type), intent(in) :: targets(:), target
      character(:), allocatable, intent(inout) :: why
      character(:), allocatable :: name
      integer :: i

      do i = 1, size(targets)
         name = ''
         if (target%key == dundurs_key .and. is_of_material(targets(i))) call name_target(targets(i), name)
         if (targets(i)%key == dundurs_key .and. is_of_material(target)) call name_target(target, name)
         if (name == '') cycle
         why = quoted(name)//' and '//quoted(dundurs_key)//' cannot be varied in one sweep: '//dundurs_key//' decides the '// &
               'materials of both bodies'
         return
      end do
   end subroutine find_clash_among

   !> Whether a key is one of a material that Dundurs' parameter replaces.
   pure logical function is_of_material(target)
      type(target_type), intent(in) :: target

      is_of_material = target%group == 'body' .and. (target%key == 'shear_modulus' .or. target%key == 'youngs_modulus' .or. &
                                                     target%key == 'poisson_ratio' .or. target%key == 'rigid')
   end function is_of_material

   !> Whether a key, or one that it stands for, is among those before it, of the same axis or of others.
   pure logical function is_varied(axes, targets, target)
      type(axis_type), intent(in) :: axes(:)
      type(target_type), intent(in) :: targets(:), target
      integer :: i, j

      is_varied = .false.
      do j = 1, size(targets)
         is_varied = is_varied .or. is_same(targets(j), target)
      end do
      do i = 1, size(axes)
         do j = 1, size(axes(i)%targets)
            is_varied = is_varied .or. is_same(axes(i)%targets(j), target)
         end do
      end do
   end function is_varied

   pure logical function is_same(one, other)
      type(target_type), intent(in) :: one, other

      is_same = one%group == other%group .and. one%number == other%number .and. stands_for(one%key, other%key)
   end function is_same

   !> The values of &vary `number`: written, or a row of numbers.
   subroutine read_values(reader, number, axis, error)
      type(reader_type), intent(in) :: reader
      integer, intent(in) :: number
      type(axis_type), intent(inout) :: axis
      type(error_type), allocatable, intent(out) :: error
      type(entry_type) :: entry
      character(len=5), parameter :: of_row(3) = ['from ', 'to   ', 'count']
      logical :: found
      integer :: i

      call reader%entry_of('vary', number, 'values', entry, found)
      do i = 1, size(of_row)
         if (found .and. reader%has('vary', number, trim(of_row(i)))) then
            call reader%complain('vary', number, trim(of_row(i)), 'values is there too; give values, or from, to and count', &
                                 error)
            return
         else if (.not. found) then
            call reader%need('vary', number, trim(of_row(i)), error)
            if (allocated(error)) exit
         end if
      end do
      if (allocated(error)) then
         call fail(reader, axis%line, '&vary '//to_text(number)//' ('//axis%name//'): needs values=..., or from, to and '// &
                   'count; '//trim(of_row(i))//' is missing', error)
      else if (found) then
         axis%values = entry%values
         axis%is_quoted = entry%is_quoted
      else
         call make_row(reader, number, axis, error)
      end if
   end subroutine read_values

   !> A row of numbers, whole ones where every key takes such; then no two may become one.
   subroutine make_row(reader, number, axis, error)
      type(reader_type), intent(in) :: reader
      integer, intent(in) :: number
      type(axis_type), intent(inout) :: axis
      type(error_type), allocatable, intent(out) :: error
      real(wp) :: first, last, value, previous, part
      integer :: i, n
      logical :: is_log

      first = reader%real_value('vary', number, 'from')
      last = reader%real_value('vary', number, 'to')
      n = reader%integer_value('vary', number, 'count')
      is_log = reader%text_value('vary', number, 'spacing') == 'log'
      if (is_log .and. .not. (first*last > 0.0_wp)) then
         call reader%complain('vary', number, 'spacing', 'needs from and to above 0, or both below', error)
         return
      end if
      axis%is_row = .true.
      allocate (axis%values(n))
      allocate (axis%is_quoted(n))
      axis%is_quoted = .false.
      value = first
      do i = 1, n
         previous = value
         part = real(i - 1, wp)/max(n - 1, 1)
         value = first + part*(last - first)
         if (is_log) value = first*(last/first)**part
         if (i == n .and. n > 1) value = last
         if (all(axis%targets%is_whole) .and. max(abs(first), abs(last)) < huge(1)) then
            axis%values(i)%text = to_text(nint(value))
            if (i > 1 .and. nint(value) == nint(previous)) then
               call reader%complain('vary', number, 'count', to_text(previous)//' and '//to_text(value)//' both become '// &
                                    to_text(nint(value))//', for '//axis%targets(1)%key//' takes whole numbers; give '// &
                                    'fewer, or values=...', error)
               return
            end if
         else
            call write_number(value, axis%values(i)%text)
         end if
      end do
   end subroutine make_row

   !> Each value of the kind that its keys take; and what column they make.
   subroutine check_kinds(reader, number, axis, error)
      type(reader_type), intent(in) :: reader
      integer, intent(in) :: number
      type(axis_type), intent(inout) :: axis
      type(error_type), allocatable, intent(out) :: error
      type(catalogue_type) :: catalogue
      type(key_type) :: key
      character(:), allocatable :: why
      integer :: i, j, code

      catalogue = case_catalogue()
      allocate (axis%numbers(size(axis%values)))
      axis%numbers = 0.0_wp
      do i = 1, size(axis%targets)
         call key_of(catalogue, axis%targets(i), key)
         if (i == 1) call name_column(key, axis)
         ! A row for other keys too is not of whole numbers.
         if (axis%is_row .and. axis%column == column_whole .and. key%kind == kind_real) axis%column = column_real
         if (abs(axis%targets(i)%factor - 1.0_wp) > 0.0_wp .and. key%kind /= kind_real .and. key%kind /= kind_integer) then
            call reader%complain('vary', number, 'factor', key%name//' is no number', error)
            return
         end if
         do j = 1, size(axis%values)
            if (.not. axis%is_quoted(j)) then
               axis%numbers(j) = logical_code(axis%values(j)%text)
               if (key%kind /= kind_logical) call read_number(axis%values(j)%text, kind_real, axis%numbers(j), code)
            end if
            if (is_too_large(axis%targets(i)%factor, axis%numbers(j))) then
               call reader%complain('vary', number, 'factor', 'times '//to_text(axis%numbers(j))// &
                                    ' is too large for a number', error)
               return
            end if
            call find_value_fault(axis, i, j, key, why)
            if (why == '') cycle
            call complain_of_value(reader, number, why, error)
            return
         end do
      end do
   end subroutine check_kinds

   !> Whether a product is beyond what a real can be.
   pure logical function is_too_large(one, other)
      real(wp), intent(in) :: one, other

      is_too_large = .false.
      if (abs(one) > 1.0_wp) is_too_large = abs(other) > huge(1.0_wp)/abs(one)
   end function is_too_large

   !> Error about a value of &vary `number`, at the line of the values.
   subroutine complain_of_value(reader, number, why, error)
      type(reader_type), intent(in) :: reader
      integer, intent(in) :: number
      character(*), intent(in) :: why
      type(error_type), allocatable, intent(inout) :: error
      type(entry_type) :: entry
      logical :: found

      call reader%entry_of('vary', number, 'values', entry, found)
      if (.not. found) call reader%entry_of('vary', number, 'from', entry, found)
      call fail(reader, entry%line, '&vary '//to_text(number)//': '//why, error)
   end subroutine complain_of_value

   !> What is wrong with a value of an axis for one of its keys; empty when nothing is.
   subroutine find_value_fault(axis, target, place, key, why)
      type(axis_type), intent(in) :: axis
      integer, intent(in) :: target, place
      type(key_type), intent(in) :: key
      character(:), allocatable, intent(out) :: why
      type(entry_type) :: entry
      character(:), allocatable :: name
      real(wp) :: number
      integer :: code

      ! What is no number cannot be multiplied: it is shown as written.
      call read_number(axis%values(place)%text, kind_real, number, code)
      allocate (entry%values(1))
      entry%values(1)%text = axis%values(place)%text
      if (code == 0) entry%values(1)%text = value_for(axis, axis%targets(target), place)
      entry%is_quoted = [axis%is_quoted(place)]
      call find_fault(key, entry, why)
      if (why == '') return
      if (axis%is_quoted(place)) entry%values(1)%text = quoted(entry%values(1)%text)
      call name_target(axis%targets(target), name)
      why = name//'='//entry%values(1)%text//': '//why
   end subroutine find_value_fault

   !> A key as one writes it.
   subroutine name_target(target, name)
      type(target_type), intent(in) :: target
      character(:), allocatable, intent(out) :: name
      type(catalogue_type) :: catalogue

      name = target%key
      if (target%group /= '') name = target%group//'%'//target%key
      catalogue = case_catalogue()
      if (catalogue%repeats(target%group)) name = target%group//'('//to_text(target%number)//')%'//target%key
   end subroutine name_target

   !> The key of the case, or Dundurs' parameter as if it were one.
   subroutine key_of(catalogue, target, key)
      type(catalogue_type), intent(in) :: catalogue
      type(target_type), intent(in) :: target
      type(key_type), intent(out) :: key
      real(wp), parameter :: largest = 0.5_wp
      type(key_type), allocatable :: keys(:)

      if (target%key == dundurs_key) then
         allocate (keys(0))
         call add_real_key(keys, '', dundurs_key, '1', "Dundurs' parameter beta, positive where the lower body couples more", &
                           lower=-largest, upper=largest)
         key = keys(1)
      else
         key = catalogue%keys(catalogue%place(target%group, target%key))
      end if
   end subroutine key_of

   !> Kind, unit and meaning of the column of an axis, from its first key.
   subroutine name_column(key, axis)
      type(key_type), intent(in) :: key
      type(axis_type), intent(inout) :: axis

      axis%column = column_real
      if (key%kind == kind_integer .or. key%kind == kind_logical) axis%column = column_whole
      if (key%kind == kind_text .or. key%kind == kind_choice) axis%column = column_text
      axis%unit = key%unit
      if (key%unit == '') axis%unit = '1'
      axis%meaning = key%meaning
      if (key%group /= '') axis%meaning = '&'//key%group//' '//key%name//': '//key%meaning
   end subroutine name_column

   !> Lists of one length where they are paired; and no more cases than can be.
   subroutine check_count(reader, sweep, error)
      type(reader_type), intent(in) :: reader
      type(sweep_type), intent(in) :: sweep
      type(error_type), allocatable, intent(out) :: error
      integer :: i

      do i = 2, size(sweep%axes)
         if (.not. sweep%paired .or. size(sweep%axes(i)%values) == size(sweep%axes(1)%values)) cycle
         call reader%complain('sweep', 1, 'combine', '&vary '//to_text(i)//' has '//to_text(size(sweep%axes(i)%values))// &
                              ' values, &vary 1 has '//to_text(size(sweep%axes(1)%values)), error)
         return
      end do
      if (sweep%cases() < 0 .or. sweep%cases() > most_cases) &
         call fail(reader, 0, '&vary: more than '//to_text(most_cases)//' cases', error)
   end subroutine check_count

   !> The axis of the coupling, where cases are compared with full coupling.
   subroutine find_reference(reader, sweep, error)
      type(reader_type), intent(in) :: reader
      type(sweep_type), intent(inout) :: sweep
      type(error_type), allocatable, intent(out) :: error
      integer :: i, j

      if (.not. sweep%has_reference) return
      do i = 1, size(sweep%axes)
         if (size(sweep%axes(i)%targets) /= 1) cycle
         if (sweep%axes(i)%targets(1)%group /= 'scene' .or. sweep%axes(i)%targets(1)%key /= 'coupling') cycle
         do j = size(sweep%axes(i)%values), 1, -1
            if (sweep%axes(i)%values(j)%text == 'full') sweep%full_place = j
         end do
         sweep%coupling_axis = i
      end do
      if (sweep%full_place == 0) then
         call reader%complain('sweep', 1, 'reference', "needs a &vary of key='scene%coupling' alone with 'full' among its "// &
                              'values', error)
      else if (sweep%paired) then
         call reader%complain('sweep', 1, 'reference', "needs combine='all': among pairs there is no case that is the same "// &
                              'otherwise', error)
      end if
   end subroutine find_reference

   !> Every column of the table with a name of its own.
   subroutine check_columns(reader, sweep, error)
      type(reader_type), intent(in) :: reader
      type(sweep_type), intent(in) :: sweep
      type(error_type), allocatable, intent(out) :: error
      type(column_type), allocatable :: columns(:)
      character(:), allocatable :: name, why
      integer :: i, j

      call list_columns(sweep, columns)
      do i = 1, size(sweep%axes)
         name = sweep%axes(i)%name
         why = ''
         if (name == '' .or. verify(name, ' ') /= 1) why = 'must not be empty, nor begin with a blank'
         do j = 1, size(columns)
            if (why /= '' .or. columns(j)%name /= name) cycle
            if (columns(j)%source /= from_axis) then
               why = 'every table has a column '//name//' ('//columns(j)%meaning//'); give another name'
            else if (columns(j)%number < i) then
               why = 'the column of &vary '//to_text(columns(j)%number)//' has this name; give another name'
            end if
         end do
         if (why == '') cycle
         call fail(reader, sweep%axes(i)%line, '&vary '//to_text(i)//' name='//quoted(name)//': '//why, error)
         return
      end do
   end subroutine check_columns

   !> Every base and every value with the first values of the others must make a valid case; of long rows some values are tried.
   subroutine check_values(reader, sweep, error)
      type(reader_type), intent(in) :: reader
      type(sweep_type), intent(in) :: sweep
      type(error_type), allocatable, intent(out) :: error
      integer, allocatable :: tried(:)
      integer :: places(1 + size(sweep%axes)), i, j

      do i = 1, size(sweep%bases)
         places = 1
         places(1) = i
         call check_places(reader, sweep, places, 0, error)
         if (allocated(error)) return
      end do
      do i = 1, size(sweep%axes)
         if (sweep%paired .and. i > 1) exit
         places = 1
         call choose_tried(sweep, i, tried)
         do j = 1, size(tried)
            places(1 + i) = tried(j)
            if (sweep%paired) places(2:) = tried(j)
            call check_places(reader, sweep, places, i, error)
            if (allocated(error)) return
         end do
      end do
   end subroutine check_values

   !> Places on axis `number` that are tried, but for the first, which all axes share: all of them, or, of a long row of
   !> numbers, the last and some in between. Lists that are written out are tried as a whole, and so is what is paired with one.
   subroutine choose_tried(sweep, number, tried)
      type(sweep_type), intent(in) :: sweep
      integer, intent(in) :: number
      integer, allocatable, intent(out) :: tried(:)
      integer, parameter :: long = 1000, between = 200
      logical :: is_row
      integer :: i, n

      n = size(sweep%axes(number)%values)
      is_row = sweep%axes(number)%is_row
      if (sweep%paired) is_row = all(sweep%axes%is_row)
      if (is_row .and. n > long) then
         tried = [(1 + nint(real(n - 1, wp)*i/(between + 1)), i=1, between + 1)]
      else
         tried = [(i, i=2, n)]
      end if
   end subroutine choose_tried

   !> The case at some places must be valid; `axis`: the one whose value is looked at, 0 for none.
   subroutine check_places(reader, sweep, places, axis, error)
      type(reader_type), intent(in) :: reader
      type(sweep_type), intent(in) :: sweep
      integer, intent(in) :: places(:), axis
      type(error_type), allocatable, intent(out) :: error
      type(error_type), allocatable :: case_error
      type(case_type) :: case
      character(:), allocatable :: values

      call sweep%read_case(sweep%number_at(places), case, case_error)
      if (.not. allocated(case_error)) return
      call sweep%describe(places, values)
      values = 'case '//to_text(sweep%number_at(places))//' ('//values//'): '//case_error%message
      if (axis > 0) then
         call complain_of_value(reader, axis, values, error)
      else
         call fail(reader, line_of(reader, 'sweep', 1), values, error)
      end if
   end subroutine check_places

   !> The checksum of all that decides the results: the version, what a record consists of, the texts, and the files that they
   !> name.
   subroutine find_checksum(sweep, error)
      type(sweep_type), intent(inout) :: sweep
      type(error_type), allocatable, intent(out) :: error
      integer :: i, j, k

      call add_text_to_checksum(library_version, sweep%checksum)
      call add_layout(sweep%checksum)
      call add_text_to_checksum(sweep%text, sweep%checksum)
      do i = 1, size(sweep%bases)
         call add_text_to_checksum(sweep%bases(i)%text, sweep%checksum)
         do j = 1, size(sweep%bases(i)%groups)
            do k = 1, size(sweep%bases(i)%groups(j)%entries)
               associate (group => sweep%bases(i)%groups(j))
                  if (is_file(group%name, group%entries(k)%key)) &
                     call add_file(sweep%bases(i), group%entries(k)%values(1)%text, sweep%checksum, error)
               end associate
               if (allocated(error)) return
            end do
         end do
         call add_files_of_axes(sweep, sweep%bases(i), error)
         if (allocated(error)) return
      end do
   end subroutine find_checksum

   !> Add what a record consists of: another build of the same version may have other observables.
   subroutine add_layout(checksum)
      integer(int64), intent(inout) :: checksum
      integer :: i

      call add_text_to_checksum('layout '//to_text(record_layout)//', observables '//to_text(observable_count), checksum)
      do i = 1, observable_count
         call add_text_to_checksum(observable_name(i), checksum)
      end do
   end subroutine add_layout

   !> The files that values of axes name, beside one base.
   subroutine add_files_of_axes(sweep, base, error)
      type(sweep_type), intent(inout) :: sweep
      type(base_type), intent(in) :: base
      type(error_type), allocatable, intent(out) :: error
      integer :: i, j, k

      do i = 1, size(sweep%axes)
         do j = 1, size(sweep%axes(i)%targets)
            if (.not. is_file(sweep%axes(i)%targets(j)%group, sweep%axes(i)%targets(j)%key)) cycle
            do k = 1, size(sweep%axes(i)%values)
               call add_file(base, sweep%axes(i)%values(k)%text, sweep%checksum, error)
               if (allocated(error)) return
            end do
         end do
      end do
   end subroutine add_files_of_axes

   !> Whether a key names a file that is read.
   pure logical function is_file(group, key)
      character(*), intent(in) :: group, key

      is_file = (group == 'body' .and. key == 'file') .or. (group == 'friction' .and. key == 'mu_file')
   end function is_file

   !> Add a file that a case names.
   subroutine add_file(base, name, checksum, error)
      type(base_type), intent(in) :: base
      character(*), intent(in) :: name
      integer(int64), intent(inout) :: checksum
      type(error_type), allocatable, intent(out) :: error
      character(:), allocatable :: path, bytes

      path = path_beside(base%directory, name)
      call read_bytes(path, bytes, error)
      if (.not. allocated(error)) call add_text_to_checksum(bytes, checksum)
   end subroutine add_file

end module mfv_sweep_reader
