!> Advice as text: reasons as comments, and groups that replace those of the case.
module mfv_advice_text
   use mfv_advice
   use mfv_case, only: case_type
   use mfv_error, only: error_type
   use mfv_kinds, only: wp
   use mfv_namelist, only: group_type, parse_namelists, write_entry
   use mfv_numbers, only: read_real
   use mfv_scene, only: solver_fft, solver_names
   use mfv_strings, only: has_word, line_feed, list_of_words, quoted, shortened, string_type, to_text, word_of
   implicit none
   private
   public :: write_advice, read_wanted_error, read_wanted_quantities

contains

   !> The wanted error in a text, a number above 0 and below 1. `why`: what is wrong with it; empty if it is valid.
   subroutine read_wanted_error(text, wanted_error, why)
      character(*), intent(in) :: text
      real(wp), intent(out) :: wanted_error
      character(:), allocatable, intent(out) :: why
      logical :: is_right

      call read_real(text, wanted_error, is_right)
      why = ''
      if (.not. (is_right .and. wanted_error > 0.0_wp .and. wanted_error < 1.0_wp)) &
         why = 'error='//shortened(text)//': must be a number above 0 and below 1, such as 1e-2'
   end subroutine read_wanted_error

   !> The quantities that a text names, separated by commas, shape (advice_count); `why` as above.
   subroutine read_wanted_quantities(text, wanted, why)
      character(*), intent(in) :: text
      logical, intent(out) :: wanted(:)
      character(:), allocatable, intent(out) :: why
      character(len=len(text)) :: words
      character(:), allocatable :: all_names
      type(string_type), allocatable :: names(:)
      integer :: i, j

      words = text
      do i = 1, len(text)
         if (text(i:i) == ',') words(i:i) = ' '
      end do
      names = list_of_words(words)
      all_names = trim(advice_names(1))
      do i = 2, advice_count
         all_names = all_names//','//trim(advice_names(i))
      end do
      why = ''
      wanted = .false.
      do i = 1, size(names)
         do j = 1, advice_count
            if (names(i)%text == advice_names(j)) wanted(j) = .true.
         end do
         if (.not. any(names(i)%text == advice_names)) &
            why = 'of='//shortened(text)//': '//quoted(shortened(names(i)%text))//' is not one of '//all_names
      end do
      if (size(names) == 0) why = 'of='//shortened(text)//': must be one or more of '//all_names
   end subroutine read_wanted_quantities

   !> Advice for a case.
   subroutine write_advice(case, advice, text)
      type(case_type), intent(in) :: case
      type(advice_type), intent(in) :: advice
      character(:), allocatable, intent(out) :: text
      type(group_type), allocatable :: groups(:)
      type(error_type), allocatable :: error

      text = ''
      call add_reasons(case, advice, text)
      call parse_namelists(case%text, case%source, groups, error)
      call add_group(text, groups, 'mesh', 'nodes refine', 'nodes='//to_text(advice%nodes))
      call add_solver(case, advice, groups, text)
   end subroutine write_advice

   !> What the advice is based on.
   subroutine add_reasons(case, advice, text)
      type(case_type), intent(in) :: case
      type(advice_type), intent(in) :: advice
      character(:), allocatable, intent(inout) :: text
      character(len=14) :: name
      character(len=24) :: present, needed
      integer :: i, last

      last = size(advice%pair_nodes)
      call add_line(text, case%source//', wanted error '//to_text(advice%wanted_error)//'. Based on '//to_text(last)// &
                    ' pairs of coarse meshes of this case,')
      call add_line(text, 'from '//to_text(advice%pair_nodes(1))//' and '//to_text(3*advice%pair_nodes(1))//' to '// &
                    to_text(advice%pair_nodes(last))//' and '//to_text(3*advice%pair_nodes(last))// &
                    ' nodes: error = c/nodes, of the dissipation c/nodes^2')
      call add_line(text, 'or, if larger, the bound from the width of its slip zones (at least 4 nodes); with a safety factor.')
      present = 'error with '//to_text(advice%present_nodes)
      call add_line(text, '               '//present//'nodes needed')
      do i = 1, advice_count
         if (.not. advice%known(i)) cycle
         name = advice_names(i)
         present = to_text(advice%present_error(i), 2)
         needed = to_text(ceiling(advice%needed_nodes(i)*advice%nodes/max(advice%contact_nodes, 1)))
         call add_line(text, ' '//name//present//trim(needed))
      end do
      if (.not. case%scene%friction%converges()) &
         call add_line(text, 'Static and kinetic friction does not converge with the mesh: no number of nodes is enough.')
      call add_line(text, 'Then about '//to_text(advice%contact_nodes)//' nodes in contact, '//to_text(advice%solves, 2)// &
                    ' linear solves, '//to_text(advice%seconds, 1)//' s (estimated).')
      if (2*advice%increment_solves < advice%event_solves) &
         call add_line(text, "accuracy="//to_text(advice%accuracy, 2)//' needs fewer solves: '// &
                       to_text(advice%increment_solves)//' instead of '//to_text(advice%event_solves)//' with '// &
                       to_text(advice%tried_nodes)//' nodes.')
      if (case%scene%mesh%refined) &
         call add_line(text, "This is for equal intervals: refine='edges' needs fewer nodes; --estimate gives its errors.")
      call add_line(text, 'Replace &mesh and &solver of the case by:')
   end subroutine add_reasons

   !> The group &solver: the solver and its tolerance, and the tolerance of non-linear friction laws.
   subroutine add_solver(case, advice, groups, text)
      type(case_type), intent(in) :: case
      type(advice_type), intent(in) :: advice
      type(group_type), intent(in) :: groups(:)
      character(:), allocatable, intent(inout) :: text
      character(:), allocatable :: keys, values

      keys = 'linear_solver linear_tolerance'
      values = "linear_solver='"//trim(word_of(solver_names, advice%linear_solver))//"'"
      if (advice%linear_solver == solver_fft) values = values//', linear_tolerance='//to_text(advice%linear_tolerance, 2)
      if (.not. case%scene%friction%is_linear()) then
         keys = keys//' friction_tolerance'
         values = values//', friction_tolerance='//to_text(advice%friction_tolerance, 2)
      end if
      call add_group(text, groups, 'solver', keys, values)
   end subroutine add_solver

   !> Append a group of the case with `values` instead of some `keys`, which are separated by blanks.
   subroutine add_group(text, groups, name, keys, values)
      character(:), allocatable, intent(inout) :: text
      type(group_type), intent(in) :: groups(:)
      character(*), intent(in) :: name, keys, values
      character(:), allocatable :: written
      integer :: i, j

      text = text//'&'//name//' '//values
      do i = 1, size(groups)
         if (groups(i)%name /= name) cycle
         do j = 1, size(groups(i)%entries)
            if (has_word(keys, groups(i)%entries(j)%key)) cycle
            call write_entry(groups(i)%entries(j), written)
            text = text//', '//written
         end do
      end do
      text = text//' /'//line_feed
   end subroutine add_group

   !> Append a comment.
   subroutine add_line(text, words)
      character(:), allocatable, intent(inout) :: text
      character(*), intent(in) :: words

      text = text//'! '//words//line_feed
   end subroutine add_line

end module mfv_advice_text
