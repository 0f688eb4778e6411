!> The load history of a case: a step for every turning point in &history, whose loads are lists of its keys or columns of a file.
module mfv_history_reader
   use mfv_edge_reader, only: convert_intensities
   use mfv_error, only: error_type
   use mfv_key_reader
   use mfv_keys, only: suggest
   use mfv_kinds, only: wp
   use mfv_motions, only: motions, motion_count, motion_approach, motion_shift, control_keep, control_force, &
                          control_displacement, controlled_key
   use mfv_scene, only: last_with_target, scene_type, step_type
   use mfv_step_reader, only: check_motion, read_steady_tolerance
   use mfv_strings, only: add_text, has_word, lower_case, string_type, to_text
   use mfv_table_file, only: read_named_table
   implicit none
   private
   public :: read_history

   character(*), parameter :: group = 'history'
   !> Keys that are no loads, and a column that is ignored.
   character(*), parameter :: others = 'file period cycles steady_tolerance', ignored = 'time'

   !> Loads of all turning points, shape (names, rows).
   type :: table_type
      type(string_type), allocatable :: names(:)
      real(wp), allocatable :: values(:, :)
   end type table_type

contains

   !> Append the steps of &history, if there is one.
   subroutine read_history(reader, scene, error)
      type(reader_type), intent(in) :: reader
      type(scene_type), intent(inout) :: scene
      type(error_type), allocatable, intent(out) :: error
      type(table_type) :: table
      type(step_type) :: step
      real(wp), allocatable :: targets(:, :)
      integer :: period

      if (count_groups(reader, group) == 0) return
      if (reader%has(group, 1, 'file')) then
         call read_file(reader, table, error)
      else
         call read_lists(reader, table, error)
      end if
      if (.not. allocated(error)) call find_targets(reader, scene, table, step, targets, error)
      if (.not. allocated(error)) call check_loads(reader, scene, step, targets, error)
      if (.not. allocated(error)) call read_period(reader, size(targets, 2), period, error)
      if (allocated(error)) return
      step%cycles = reader%integer_value(group, 1, 'cycles')
      call read_steady_tolerance(reader, group, 1, step, error)
      if (.not. allocated(error)) call append_steps(step, targets, period, scene%steps)
   end subroutine read_history

   !> The loads in the lists of keys.
   subroutine read_lists(reader, table, error)
      type(reader_type), intent(in) :: reader
      type(table_type), intent(out) :: table
      type(error_type), allocatable, intent(out) :: error
      type(string_type), allocatable :: keys(:)
      real(wp), allocatable :: values(:)
      integer :: i, rows

      keys = reader%catalogue%names(group)
      allocate (table%names(0))
      rows = 0
      do i = 1, size(keys)
         if (has_word(others, keys(i)%text) .or. .not. reader%has(group, 1, keys(i)%text)) cycle
         call add_text(table%names, keys(i)%text)
         call reader%real_values(group, 1, keys(i)%text, values)
         rows = max(rows, size(values))
      end do
      if (rows == 0) then
         call fail(reader, line_of(reader, group, 1), '&history: needs a file, or lists of loads such as tangential_force', error)
         return
      end if
      allocate (table%values(size(table%names), rows))
      do i = 1, size(table%names)
         call reader%real_values(group, 1, table%names(i)%text, values)
         if (size(values) /= 1 .and. size(values) /= rows) then
            call reader%complain(group, 1, table%names(i)%text, 'has '//to_text(size(values))//' values, another list has '// &
                                 to_text(rows)//'; give one for every turning point, or one for all', error)
            return
         end if
         table%values(i, :) = values(1)
         if (size(values) == rows) table%values(i, :) = values
      end do
   end subroutine read_lists

   !> The loads in the columns of a file.
   subroutine read_file(reader, table, error)
      type(reader_type), intent(in) :: reader
      type(table_type), intent(out) :: table
      type(error_type), allocatable, intent(out) :: error
      type(string_type), allocatable :: keys(:), known(:), written(:)
      type(error_type), allocatable :: file_error
      character(:), allocatable :: path, advice, list
      logical :: in_memory
      integer :: i

      keys = reader%catalogue%names(group)
      list = ''
      allocate (known(0))
      do i = 1, size(keys)
         if (has_word(others, keys(i)%text)) cycle
         call add_text(known, keys(i)%text)
         list = list//' '//keys(i)%text
         if (reader%has(group, 1, keys(i)%text)) call reader%complain(group, 1, keys(i)%text, 'a file is also given; make it a '// &
                                                                      'column of the file, or remove one of them', error)
         if (allocated(error)) return
      end do
      call find_file(reader, group, 1, 'file', path, in_memory)
      call read_named_table(path, table%names, table%values, file_error)
      if (allocated(file_error)) then
         call reader%complain(group, 1, 'file', file_error%message, error)
         return
      end if
      written = table%names
      do i = 1, size(written)
         table%names(i)%text = lower_case(written(i)%text)
      end do
      do i = 1, size(table%names)
         associate (name => table%names(i)%text)
            if (column_of(table, name) > i .and. name /= '') then
               call reader%complain(group, 1, 'file', path//': columns '//to_text(i)//' and '//to_text(column_of(table, name))// &
                                    ' have the same name, '//written(i)%text//'; remove one of them', error)
               return
            end if
            if (has_word(list//' '//ignored, name) .or. without_unit(name) == ignored) cycle
            if (name == '') then
               call reader%complain(group, 1, 'file', path//': column '//to_text(i)//' has no name', error)
               return
            end if
            call suggest(name, known, '', advice)
            if (any(name == ['p', 'q', 'm'])) advice = '; P, Q and M are normal_force, tangential_force and moment'
            if (has_word(list, trim(without_unit(name)))) &
               advice = '; write '//trim(without_unit(name))//' without its unit, and numbers in the units of the case'
            if (advice == '') advice = '; columns are'//list//', and '//ignored//', which is ignored'
            call reader%complain(group, 1, 'file', path//': unknown column '''//written(i)%text//''''//advice, error)
            return
         end associate
      end do
      if (size(table%values, 2) == 0) call reader%complain(group, 1, 'file', path//': has no row of numbers', error)
   end subroutine read_file

   !> The controls, as a step, and the targets of all turning points, shape (motions, rows).
   subroutine find_targets(reader, scene, table, step, targets, error)
      type(reader_type), intent(in) :: reader
      type(scene_type), intent(in) :: scene
      type(table_type), intent(in) :: table
      type(step_type), intent(out) :: step
      real(wp), allocatable, intent(out) :: targets(:, :)
      type(error_type), allocatable, intent(out) :: error
      real(wp), allocatable :: normal(:), shear(:)
      integer :: i, column, control, ratio

      allocate (targets(motion_count, size(table%values, 2)), source=0.0_wp)
      do i = 1, motion_count
         do control = control_force, control_displacement
            column = column_of(table, trim(controlled_key(i, control)))
            if (column == 0) cycle
            if (step%control(i) /= control_keep) then
               call complain(reader, table, column, trim(motions(i)%force_key)//' is also given; prescribe only one of them', error)
               return
            end if
            step%control(i) = control
            targets(i, :) = table%values(column, :)
         end do
      end do
      ratio = column_of(table, 'force_ratio')
      if (ratio > 0) call find_ratio(reader, scene, table, ratio, step, targets, error)
      if (allocated(error)) return
      column = column_of(table, 'normal_intensity')
      if (column > 0) normal = table%values(column, :)
      column = column_of(table, 'shear_intensity')
      if (column > 0) shear = table%values(column, :)
      call convert_intensities(reader, group, 1, scene, normal, shear, step, targets, error)
      if (allocated(error)) return
      if (all(step%control == control_keep)) &
         call reader%complain(group, 1, 'file', 'has no load: its only column is time', error)
   end subroutine find_targets

   !> The tangential force from a column (`ratio`) of ratios Q/(mu P); P is a column too, or that of the last step.
   subroutine find_ratio(reader, scene, table, ratio, step, targets, error)
      type(reader_type), intent(in) :: reader
      type(scene_type), intent(in) :: scene
      type(table_type), intent(in) :: table
      integer, intent(in) :: ratio
      type(step_type), intent(inout) :: step
      real(wp), intent(inout) :: targets(:, :)
      type(error_type), allocatable, intent(out) :: error
      real(wp) :: force(size(targets, 2))
      integer :: last
      logical :: is_known

      force = targets(motion_approach, :)
      is_known = step%control(motion_approach) == control_force
      if (step%control(motion_approach) == control_keep) then
         last = last_with_target(scene%steps, motion_approach)
         if (last > 0) is_known = scene%steps(last)%control(motion_approach) == control_force
         if (last > 0) force = scene%steps(last)%target(motion_approach)
      end if
      if (step%control(motion_shift) /= control_keep) then
         call complain(reader, table, ratio, 'tangential_force or shift is also given; prescribe only one of them', error)
      else if (.not. scene%friction%acts()) then
         call complain(reader, table, ratio, needs_friction, error)
      else if (.not. is_known) then
         call complain(reader, table, ratio, 'needs a normal_force, here or in an earlier step without cycles', error)
      end if
      step%control(motion_shift) = control_force
      targets(motion_shift, :) = table%values(ratio, :)*scene%friction%static%largest()*force
   end subroutine find_ratio

   !> Error for loads that the scene or its bodies cannot have.
   subroutine check_loads(reader, scene, step, targets, error)
      type(reader_type), intent(in) :: reader
      type(scene_type), intent(in) :: scene
      type(step_type), intent(in) :: step
      real(wp), intent(in) :: targets(:, :)
      type(error_type), allocatable, intent(out) :: error
      character(:), allocatable :: key
      integer :: i, row

      do i = 1, motion_count
         if (step%control(i) == control_keep) cycle
         key = 'file'
         if (.not. reader%has(group, 1, key)) key = trim(controlled_key(i, step%control(i)))
         call check_motion(reader, group, 1, i, key, scene, error)
         if (allocated(error)) return
         row = findloc(targets(i, :) < 0.0_wp, .true., dim=1)
         if (step%control(i) == control_force .and. scene%cannot_be_negative(i, control_force) .and. row > 0) &
            call reader%complain(group, 1, key, trim(motions(i)%force_key)//' must be at least 0, not '// &
                                 to_text(targets(i, max(row, 1)))//' in row '//to_text(row), error)
         if (i == motion_shift .and. step%control(i) == control_force .and. .not. scene%friction%acts() .and. &
             any(abs(targets(i, :)) > 0.0_wp)) &
            call reader%complain(group, 1, key, 'tangential_force must be 0 without friction', error)
         if (allocated(error)) return
      end do
   end subroutine check_loads

   !> The number of turning points at the end that are a cycle; 0: none.
   subroutine read_period(reader, rows, period, error)
      type(reader_type), intent(in) :: reader
      integer, intent(in) :: rows
      integer, intent(out) :: period
      type(error_type), allocatable, intent(out) :: error

      period = reader%integer_value(group, 1, 'period')
      if (period == 0 .and. reader%has(group, 1, 'cycles')) period = rows
      if (period > rows) then
         call reader%complain(group, 1, 'period', 'must be at most '//to_text(rows)//', the number of turning points', error)
      else if (period == 1) then
         call reader%complain(group, 1, 'cycles', 'needs at least two turning points; the history has one', error)
      end if
   end subroutine read_period

   !> Append a step for every turning point, or one with cycles for the last `period` of them. `pattern`: their controls, cycles and
   !> tolerance.
   subroutine append_steps(pattern, targets, period, steps)
      type(step_type), intent(in) :: pattern
      real(wp), intent(in) :: targets(:, :)
      integer, intent(in) :: period
      type(step_type), allocatable, intent(inout) :: steps(:)
      type(step_type), allocatable :: longer(:)
      integer :: i, n, singles, rows

      rows = size(targets, 2)
      singles = rows - period
      n = size(steps)
      allocate (longer(n + singles + merge(1, 0, period > 0)))
      longer(:n) = steps
      do i = 1, size(longer) - n
         associate (step => longer(n + i))
            step%control = pattern%control
            step%target = targets(:, i)
            step%row = i
            step%is_passed = i < size(longer) - n
            if (i <= singles) cycle
            step%target = targets(:, rows)
            step%path = targets(:, singles + 1:)
            step%cycles = pattern%cycles
            step%steady_tolerance = pattern%steady_tolerance
         end associate
      end do
      call move_alloc(longer, steps)
   end subroutine append_steps

   !> Column of a name, 0 for none.
   pure integer function column_of(table, name) result(column)
      type(table_type), intent(in) :: table
      character(*), intent(in) :: name

      do column = size(table%names), 1, -1
         if (table%names(column)%text == name) return
      end do
   end function column_of

   !> The name of a column without a unit in brackets.
   pure function without_unit(name) result(bare)
      character(*), intent(in) :: name
      character(len=len(name)) :: bare

      bare = name(:scan(name//'[', '[(') - 1)
   end function without_unit

   !> Error about a column: of the file, or the list of a key.
   subroutine complain(reader, table, column, why, error)
      type(reader_type), intent(in) :: reader
      type(table_type), intent(in) :: table
      integer, intent(in) :: column
      character(*), intent(in) :: why
      type(error_type), allocatable, intent(out) :: error

      if (reader%has(group, 1, 'file')) then
         call reader%complain(group, 1, 'file', 'column '''//table%names(column)%text//''': '//why, error)
      else
         call reader%complain(group, 1, table%names(column)%text, why, error)
      end if
   end subroutine complain

end module mfv_history_reader
