!> mfv_sweep SWEEP.nml: solve the cases of a sweep, on all processors, and write one table.
program mfv_sweep
   use mfv_error, only: error_type
   use mfv_help, only: print_lines, refuse, refuse_option
   use mfv_keys, only: list_keys_as_markdown
   use mfv_namelist, only: group_type, write_namelists
   use mfv_output, only: begin_program, print_line, print_text
   use mfv_numbers, only: read_whole
   use mfv_ranks, only: has_ranks
   use mfv_run_sweep, only: run_sweep, sweep_options_type
   use mfv_strings, only: shortened, to_text
   use mfv_sweep_keys, only: sweep_catalogue
   use mfv_sweep_plan, only: sweep_type
   use mfv_sweep_reader, only: read_sweep_file
   use mfv_sweep_table, only: check_place
   use mfv_terminal
   use mfv_version, only: library_version
   implicit none
   save  ! the standard says so of a program; gfortran's -frecursive loses what they hold, which the leak sanitizer tells

   character(len=1), parameter :: line_feed = achar(10)
   !> How it is used, and what --help adds: one line an element. The manual page is made from both (docs/man).
   character(*), parameter :: usage(*) = [character(len=100) :: &
      'usage: mfv_sweep [--threads N] [--again] SWEEP.nml', &
      '       mfv_sweep --part I/N [--threads M] SWEEP.nml', &
      '       mfv_sweep --check SWEEP.nml', &
      '       mfv_sweep --case N SWEEP.nml', &
      '       mfv_sweep --keys | --version | --help' &
      ]
   character(*), parameter :: help(*) = [character(len=100) :: &
      '', &
      'Solve many cases that differ in some values, on all processors, and write one table, one row a', &
      'case: dissipation, stiffness, stick ratios, shift of the contact, peak tractions, outcome.', &
      '', &
      'A sweep names a base case and what is varied in it. This is a whole one, of 3 x 10 x 3 cases, of', &
      'the case examples/mindlin.nml:', &
      '', &
      "  &sweep base='mindlin.nml', file='study.h5' /", &
      "  &vary  key='friction%mu', values=0.3, 0.5, 0.7 /", &
      "  &vary  key='step(2)%tangential_force', 'step(3)%tangential_force', factor=1, -1,", &
      "         from=0.5e-4, to=2.5e-4, count=10, spacing='linear', name='Q' /", &
      "  &vary  key='scene%coupling', values='full', 'goodman', 'none' /", &
      '', &
      'Keys in one &vary move together, here forth and back; the last &vary runs fastest.', &
      '', &
      'Options:', &
      '  --threads N     cases at a time; by default OMP_NUM_THREADS, or all processors', &
      '  --again         solve all cases, those that are there already as well', &
      '  --part I/N      solve part I of N only, such as 3/16, for queues; a later run gathers the parts', &
      '  --check         validate, and say which cases there are; nothing is solved or written', &
      '  --case N        print case N, from 1, as a case for mfv_run', &
      '  --keys          print every group and key of a sweep, as tables in Markdown', &
      '  --version       print the version, and whether it was built with MPI', &
      '  -h, --help      print this text', &
      '', &
      'Files:', &
      '  The table is the dataset /table of the file, which lies in the working directory, under the name', &
      '  of the sweep with .h5 unless &sweep names it. What has been solved is kept in a journal beside it:', &
      '  after Ctrl-C, or worse, the same command goes on where it was.', &
      '', &
      'Exit codes:', &
      '  0     all cases are done, those that ended early among them: the column outcome tells', &
      '  2     the input cannot be used; the message names file, line, key and value', &
      '  4     a file could not be read or written', &
      '  130   interrupted; the cases so far are kept', &
      '', &
      'Examples:', &
      '  mfv_sweep --check study.nml', &
      '  mfv_sweep study.nml                      # all processors of this machine', &
      '  mpirun -n 64 mfv_sweep study.nml         # of many, where it was built with MPI', &
      '  mfv_sweep --case 17 study.nml > 17.nml   # case 17 by itself', &
      '  python -m mfv table study.h5 --csv study.csv', &
      '', &
      'See also:', &
      '  docs/sweep.md has what can be varied, and the columns of the table; mfv_sweep --keys every key.', &
      '  mfv_run(1), mfv_case(5).' &
      ]
   type(sweep_options_type) :: options
   character(:), allocatable :: argument, path, text
   integer :: i, number
   logical :: only_check

   path = ''
   number = 0
   only_check = .false.
   i = 1
   call begin_program()
   if (command_argument_count() == 0) call refuse('mfv_sweep', usage, 'a sweep file is missing')
   do while (i <= command_argument_count())
      call get_argument(i, argument)
      select case (argument)
      case ('--help', '-h')
         call print_lines([usage, help])
         call end_program(0)
      case ('--version')
         call print_line('mfv_sweep '//library_version//trim(merge(' with MPI   ', ' without MPI', has_ranks)))
         call end_program(0)
      case ('--keys')
         call list_keys_as_markdown(sweep_catalogue(), text)
         call print_text(text)
         call end_program(0)
      case ('--again')
         options%again = .true.
      case ('--check')
         only_check = .true.
      case ('--threads', '--case', '--part')
         i = i + 1
         call read_option(argument, i)
      case default
         if (index(argument, '-') == 1) call refuse_option('mfv_sweep', usage, help, argument)
         if (path /= '') call refuse('mfv_sweep', usage, "too many arguments: '"//shortened(argument)//"'")
         path = argument
      end select
      i = i + 1
   end do
   if (path == '') call refuse('mfv_sweep', usage, 'a sweep file is missing')
   if (only_check) then
      call check_sweep(path)
   else if (number > 0) then
      call print_case(path, number)
   else
      call run_sweep(path, options)
   end if

contains

   !> An option with a value, which is argument `place`.
   subroutine read_option(option, place)
      character(*), intent(in) :: option
      integer, intent(in) :: place
      character(:), allocatable :: value
      integer :: slash, read_number
      logical :: right

      call get_argument(place, value)
      right = .false.
      if (option == '--part') then
         slash = index(value, '/')
         if (slash > 1) then
            options%part = whole(value(:slash - 1))
            options%parts = whole(value(slash + 1:))
            right = options%part >= 1 .and. options%part <= options%parts
         end if
         if (.not. right) call refuse('mfv_sweep', usage, "--part '"//shortened(value)//"': must be I/N with I from 1 to N, "// &
                                      'such as 3/16')
         return
      end if
      read_number = whole(value)
      if (read_number < 1) call refuse('mfv_sweep', usage, option//" '"//shortened(value)//"': must be a whole number above 0")
      if (option == '--threads') options%threads = read_number
      if (option == '--case') number = read_number
   end subroutine read_option

   !> A whole number, 0 where the text is none.
   integer function whole(digits) result(value)
      character(*), intent(in) :: digits
      logical :: is_right

      value = 0
      if (verify(digits, '0123456789') == 0) call read_whole(digits, value, is_right)
   end function whole

   !> Validate, and say what there is to do.
   subroutine check_sweep(sweep_path)
      character(*), intent(in) :: sweep_path
      type(sweep_type) :: sweep
      type(error_type), allocatable :: error
      character(:), allocatable :: words
      integer, parameter :: shown = 5
      integer :: place

      call read_sweep_file(sweep_path, sweep, error)
      if (.not. allocated(error)) call check_place(sweep, error)
      if (allocated(error)) call fail(error)
      call print_line(sweep%source//' is valid: '//to_text(sweep%cases())//' cases, into '//sweep%result_path)
      do place = 1, size(sweep%axes)
         call print_line('  '//sweep%axes(place)%name//': '//to_text(size(sweep%axes(place)%values))//' values')
      end do
      do place = 1, min(shown, sweep%cases())
         call sweep%describe(sweep%places(place), words)
         call print_line('  case '//to_text(place)//': '//words)
      end do
      if (sweep%cases() > shown) call print_line('  ...')
   end subroutine check_sweep

   !> A case of the sweep as text.
   subroutine print_case(sweep_path, case_number)
      character(*), intent(in) :: sweep_path
      integer, intent(in) :: case_number
      type(sweep_type) :: sweep
      type(error_type), allocatable :: error
      type(group_type), allocatable :: groups(:)
      character(:), allocatable :: words

      call read_sweep_file(sweep_path, sweep, error, tries_values=.false.)
      if (allocated(error)) call fail(error)
      if (case_number > sweep%cases()) call refuse('mfv_sweep', usage, '--case '//to_text(case_number)//': there are '// &
                                                   to_text(sweep%cases())//' cases')
      call sweep%groups_at(sweep%places(case_number), groups, error)
      if (allocated(error)) call fail(error)
      call sweep%describe(sweep%places(case_number), words)
      call write_namelists(groups, text)
      call print_text('! case '//to_text(case_number)//' of '//sweep%source//': '//words//line_feed//text)
   end subroutine print_case

end program mfv_sweep
