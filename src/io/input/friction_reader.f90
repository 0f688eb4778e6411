!> The friction of a case, from its text: the law, its coefficients, and the steps in which it acts.
module mfv_friction_reader
   use mfv_error, only: error_type
   use mfv_friction
   use mfv_friction_law, only: friction_law_type
   use mfv_key_reader
   use mfv_kinds, only: wp
   use mfv_scene, only: scene_type
   use mfv_wear, only: wear_archard
   use mfv_strings, only: has_word, list_of_words, string_type, to_text
   use mfv_table_file, only: read_table
   implicit none
   private
   public :: read_friction, read_wear, check_friction_keys, check_coefficients_a_node, check_friction_of_steps

contains

   !> The friction law; its keys have been checked.
   subroutine read_friction(reader, scene, error)
      type(reader_type), intent(in) :: reader
      type(scene_type), intent(inout) :: scene
      type(error_type), allocatable, intent(out) :: error
      type(string_type), allocatable :: keys(:)
      character(:), allocatable :: coefficients, needed, known
      integer :: i

      scene%friction = no_friction()
      call new_friction_law(reader%text_value('friction', 1, 'law'), scene%friction%law)
      if (.not. allocated(scene%friction%law)) return
      keys = reader%catalogue%names('friction')
      call find_keys_of_law(reader%text_value('friction', 1, 'law'), coefficients, needed, known)
      do i = 1, size(keys)
         if (has_word(known, keys(i)%text) .and. keys(i)%text /= 'mu_file' .and. reader%has('friction', 1, keys(i)%text)) &
            call scene%friction%law%set_parameter(keys(i)%text, reader%real_value('friction', 1, keys(i)%text))
      end do
      call read_coefficients(reader, scene%friction, error)
      if (.not. allocated(error)) call scene%friction%simplify()
   end subroutine read_friction

   !> Error for missing keys of the law, and for keys that have no effect with it.
   subroutine check_friction_keys(reader, error)
      type(reader_type), intent(in) :: reader
      type(error_type), allocatable, intent(out) :: error
      character(:), allocatable :: coefficients, needed, known, law
      type(string_type), allocatable :: keys(:)
      integer :: i

      call find_keys_of_law(reader%text_value('friction', 1, 'law'), coefficients, needed, known)
      keys = reader%catalogue%names('friction')
      do i = 1, size(keys)
         if (.not. reader%has('friction', 1, keys(i)%text)) cycle
         if (.not. has_word('law '//coefficients//' '//known, keys(i)%text)) then
            if (reader%has('friction', 1, 'law')) then
               call reader%complain('friction', 1, keys(i)%text, &
                                    "has no effect with law='"//reader%text_value('friction', 1, 'law')// &
                                    "'; remove it or choose another law", error)
            else
               call find_law_with(keys(i)%text, law)
               call reader%complain('friction', 1, keys(i)%text, "needs a law; add law='"//law//"'", error)
            end if
         else if (has_word(coefficients, keys(i)%text) .and. reader%has('friction', 1, 'mu_file')) then
            call reader%complain('friction', 1, keys(i)%text, 'mu_file is also given; give only one of them', error)
         end if
         if (allocated(error)) return
      end do
      if (.not. reader%has('friction', 1, 'mu_file')) needed = coefficients//' '//needed
      keys = list_of_words(needed)
      do i = 1, size(keys)
         call reader%need('friction', 1, keys(i)%text, error)
         if (allocated(error)) return
      end do
   end subroutine check_friction_keys

   !> The first law that has a key.
   subroutine find_law_with(key, law)
      character(*), intent(in) :: key
      character(:), allocatable, intent(out) :: law
      character(:), allocatable :: coefficients, needed, known
      type(string_type), allocatable :: laws(:)
      integer :: i

      laws = list_of_words(friction_law_names)
      do i = 1, size(laws)
         law = laws(i)%text
         call find_keys_of_law(law, coefficients, needed, known)
         if (has_word(coefficients//' '//known, key)) return
      end do
   end subroutine find_law_with

   !> Keys of a law, separated by blanks: its coefficients, other needed keys, and all keys except its coefficients.
   subroutine find_keys_of_law(name, coefficients, needed, known)
      character(*), intent(in) :: name
      character(:), allocatable, intent(out) :: coefficients, needed, known
      class(friction_law_type), allocatable :: law

      coefficients = ''
      needed = ''
      known = ''
      call new_friction_law(name, law)
      if (.not. allocated(law)) return
      coefficients = 'mu'
      if (law%has_two_coefficients) coefficients = 'mu_static mu_kinetic'
      needed = trim(law%needed_keys)
      known = 'mu_file '//needed//' '//trim(law%optional_keys)
   end subroutine find_keys_of_law

   !> Coefficients of friction: numbers, one number per node, or a file.
   subroutine read_coefficients(reader, friction, error)
      type(reader_type), intent(in) :: reader
      type(friction_type), intent(inout) :: friction
      type(error_type), allocatable, intent(out) :: error

      if (reader%has('friction', 1, 'mu_file')) then
         call read_mu_file(reader, friction, error)
      else if (reader%has('friction', 1, 'mu')) then
         call reader%real_values('friction', 1, 'mu', friction%static%value)
         friction%kinetic = friction%static
      else
         call reader%real_values('friction', 1, 'mu_static', friction%static%value)
         call reader%real_values('friction', 1, 'mu_kinetic', friction%kinetic%value)
         call spread_single(friction%kinetic%value, size(friction%static%value))
         call spread_single(friction%static%value, size(friction%kinetic%value))
         if (size(friction%static%value) /= size(friction%kinetic%value)) then
            call reader%complain('friction', 1, 'mu_kinetic', 'must have one value, or as many as mu_static', error)
         else if (any(friction%kinetic%value > friction%static%value)) then
            call reader%complain('friction', 1, 'mu_kinetic', 'must not be above mu_static', error)
         end if
      end if
   end subroutine read_coefficients

   !> Repeat a single value `number` times.
   subroutine spread_single(values, number)
      real(wp), allocatable, intent(inout) :: values(:)
      integer, intent(in) :: number

      if (size(values) == 1 .and. number > 1) values = spread(values(1), 1, number)
   end subroutine spread_single

   !> Coefficients along x from the file of &friction mu_file.
   subroutine read_mu_file(reader, friction, error)
      type(reader_type), intent(in) :: reader
      type(friction_type), intent(inout) :: friction
      type(error_type), allocatable, intent(out) :: error
      type(error_type), allocatable :: file_error
      character(:), allocatable :: path
      real(wp), allocatable :: table(:, :)
      logical :: two, in_memory

      two = friction%law%has_two_coefficients
      call find_file(reader, 'friction', 1, 'mu_file', path, in_memory)
      if (in_memory) then
         call reader%data%read_columns(path, trim(merge('x mu_static mu_kinetic', 'x mu                  ', two)), table, &
                                       file_error)
      else if (two) then
         call read_table(path, 'x, mu_static and mu_kinetic', 3, .true., table, file_error)
      else
         call read_table(path, 'x and mu', 2, .true., table, file_error)
      end if
      if (allocated(file_error)) then
         call reader%complain('friction', 1, 'mu_file', file_error%message, error)
      else if (size(table, 2) < 2) then
         call reader%complain('friction', 1, 'mu_file', path//': needs at least 2 lines of numbers', error)
      else if (any(table(2:, :) < 0.0_wp)) then
         call reader%complain('friction', 1, 'mu_file', path//': coefficients must not be negative', error)
      else if (any(table(size(table, 1), :) > table(2, :))) then
         call reader%complain('friction', 1, 'mu_file', path//': mu_kinetic must not be above mu_static', error)
      end if
      if (allocated(error)) return
      ! Component by component: gfortran 12 miscompiles a constructor with array sections.
      friction%static%value = table(2, :)
      friction%static%position = table(1, :)
      friction%kinetic%value = table(size(table, 1), :)
      friction%kinetic%position = table(1, :)
   end subroutine read_mu_file

   !> The wear; the friction and the steps are known.
   subroutine read_wear(reader, scene, error)
      type(reader_type), intent(in) :: reader
      type(scene_type), intent(inout) :: scene
      type(error_type), allocatable, intent(out) :: error

      if (count_groups(reader, 'wear') == 0) return
      call reader%need('wear', 1, 'coefficient', error)
      if (allocated(error)) return
      scene%wear%law = reader%choice('wear', 1, 'law')
      scene%wear%coefficient = reader%real_value('wear', 1, 'coefficient')
      scene%wear%tolerance = reader%real_value('wear', 1, 'tolerance')
      scene%wear%block = reader%integer_value('wear', 1, 'block')
      if (.not. scene%friction%acts()) then
         call reader%complain('wear', 1, 'coefficient', needs_friction, error)
      else if (scene%wear%law == wear_archard .and. .not. scene%friction%is_linear()) then
         call reader%complain('wear', 1, 'law', "'archard' needs friction with law='coulomb' or 'static_kinetic', whose work "// &
                              "gives the product of pressure and slip; use law='work'", error)
      else if (size(scene%steps) > 0 .and. .not. any(scene%steps%cycles > 0)) then
         call reader%complain('wear', 1, 'coefficient', 'has no effect without a step with cycles; remove it or add cycles', error)
      else if (reader%has('wear', 1, 'block') .and. reader%has('wear', 1, 'tolerance')) then
         call reader%complain('wear', 1, 'tolerance', 'has no effect with block; remove one of them', error)
      end if
   end subroutine read_wear

   !> Error unless coefficients per node have a fixed mesh with that number of nodes.
   subroutine check_coefficients_a_node(reader, scene, error)
      type(reader_type), intent(in) :: reader
      type(scene_type), intent(in) :: scene
      type(error_type), allocatable, intent(out) :: error
      character(:), allocatable :: key, advice
      real(wp), allocatable :: given(:)
      integer :: nodes

      if (.not. allocated(scene%friction%static%value) .or. allocated(scene%friction%static%position)) return
      if (size(scene%friction%static%value) == 1) return
      key = 'mu_static'
      if (reader%has('friction', 1, 'mu')) key = 'mu'
      call reader%real_values('friction', 1, key, given)
      if (size(given) == 1) key = 'mu_kinetic'
      advice = ''
      if (size(given) == 2 .and. .not. any(abs(given - anint(given)) > 0.0_wp)) advice = decimal_point
      nodes = scene%mesh%nodes
      if (scene%lower%is_matrix()) nodes = size(scene%lower%position)
      if (scene%mesh%refined) then
         call reader%complain('friction', 1, key, "one value per node needs refine='none'; use mu_file"//advice, error)
         return
      end if
      if (.not. scene%lower%is_matrix() .and. .not. (scene%mesh%half_width > 0.0_wp .or. allocated(scene%mesh%ends))) then
         call reader%complain('friction', 1, key, 'one value per node needs a mesh with half_width, half_angle or ends'//advice, &
                              error)
      else if (size(scene%friction%static%value) /= nodes) then
         call reader%complain('friction', 1, key, 'must have one value, or one per node ('//to_text(nodes)//'), not '// &
                              to_text(size(scene%friction%static%value))//advice, error)
      end if
   end subroutine check_coefficients_a_node

   !> Error for a tangential force in a step without friction.
   subroutine check_friction_of_steps(reader, error)
      type(reader_type), intent(in) :: reader
      type(error_type), allocatable, intent(out) :: error
      real(wp), allocatable :: coefficients(:)
      character(:), allocatable :: key
      logical :: law
      integer :: i

      law = reader%text_value('friction', 1, 'law') /= 'none'
      key = 'mu_static'
      if (reader%has('friction', 1, 'mu')) key = 'mu'
      if (law .and. reader%has('friction', 1, key)) then
         call reader%real_values('friction', 1, key, coefficients)
         law = any(coefficients > 0.0_wp)
      end if
      do i = 1, count_groups(reader, 'step')
         if (.not. reader%has('step', i, 'tangential_force')) cycle
         if (.not. abs(reader%real_value('step', i, 'tangential_force')) > 0.0_wp) cycle
         if (law .and. reader%logical_value('step', i, 'friction')) cycle
         if (reader%text_value('friction', 1, 'law') == 'none') then
            call reader%complain('step', i, 'tangential_force', needs_friction, error)
         else
            call reader%complain('step', i, 'tangential_force', 'must be 0 in a step without friction (or where every '// &
                                 'coefficient is 0)', error)
         end if
         return
      end do
   end subroutine check_friction_of_steps

end module mfv_friction_reader
