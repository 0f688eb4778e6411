!> What mfv_sweep does with a sweep: solve what is not there yet, and write the table when all is there.
module mfv_run_sweep
   use, intrinsic :: iso_c_binding
   use, intrinsic :: iso_fortran_env, only: error_unit, int64
   use mfv_error, only: error_type, set_error
   use mfv_locked_file, only: delete_path, make_directory, sync_name
   use mfv_one_thread, only: use_one_thread
   use mfv_output, only: print_line
   use mfv_ranks
   use mfv_safe_file, only: describe_code
   use mfv_status
   use mfv_strings, only: add_text, from_c, string_type, to_text
   use mfv_sweep_journal
   use mfv_sweep_plan, only: sweep_type
   use mfv_sweep_reader, only: read_sweep_file
   use mfv_sweep_record, only: record_type
   use mfv_sweep_table
   use mfv_sweep_work, only: assist, solve_cases
   use mfv_terminal
   use mfv_text_file, only: split_lines
   use omp_lib, only: omp_get_max_threads, omp_get_num_procs
   implicit none
   private
   public :: run_sweep, sweep_options_type

   type :: sweep_options_type
      !> Threads that solve in each process, 0: chosen. Whether it starts anew whatever is there.
      integer :: threads = 0
      logical :: again = .false.
      !> Part of the cases that is wanted, of how many; 0 of 0: all, with the parts that have been computed before.
      integer :: part = 0, parts = 0
   end type sweep_options_type

   !> What rank 0 tells the others in the beginning: to go on. All else is the code to end with.
   integer, parameter :: go_on = -1

   interface
      function c_matching_files(start, end) bind(C, name='mfv_matching_files') result(names)
         import :: c_char, c_ptr
         character(kind=c_char), intent(in) :: start(*), end(*)
         type(c_ptr) :: names
      end function c_matching_files

      subroutine c_free(memory) bind(C, name='free')
         import :: c_ptr
         type(c_ptr), value :: memory
      end subroutine c_free
   end interface

contains

   !> Run the sweep in the file `path`; the program then ends with an exit code.
   subroutine run_sweep(path, options)
      character(*), intent(in) :: path
      type(sweep_options_type), intent(in) :: options
      integer :: rank, ranks, code

      call start_ranks(rank, ranks)
      call use_one_thread()
      call catch_interrupts()
      if (rank == 0) then
         call lead(path, options, ranks, code)
      else
         call follow(path, options, ranks, code)
      end if
      call end_ranks()
      call end_program(code)
   end subroutine run_sweep

   !> What rank 0 does. `code`: the exit code.
   subroutine lead(path, options, ranks, code)
      character(*), intent(in) :: path
      type(sweep_options_type), intent(in) :: options
      integer, intent(in) :: ranks
      integer, intent(out) :: code
      type(sweep_type) :: sweep
      type(journal_type) :: journal
      type(record_type), allocatable :: records(:)
      type(string_type), allocatable :: parts(:)
      type(error_type), allocatable :: error
      logical :: is_complete
      integer :: told

      call prepare(path, options, sweep, journal, records, parts, is_complete, error)
      code = 0
      if (allocated(error)) code = status_exit_code(error%status)
      told = merge(go_on, code, .not. (allocated(error) .or. is_complete))
      call share_number(told)
      if (allocated(error)) then
         write (error_unit, '(a)') error%message
      else if (.not. is_complete) then
         call complete(sweep, options, ranks, journal, records, parts, code)
         call share_number(code)
      end if
   end subroutine lead

   !> What the other ranks do.
   subroutine follow(path, options, ranks, code)
      character(*), intent(in) :: path
      type(sweep_options_type), intent(in) :: options
      integer, intent(in) :: ranks
      integer, intent(out) :: code
      type(sweep_type) :: sweep
      type(error_type), allocatable :: error

      call share_number(code)
      if (code /= go_on) return
      ! Rank 0 has tried the values.
      call read_sweep_file(path, sweep, error, tries_values=.false.)
      call assist(sweep, threads_for(options, ranks), error)
      ! The code of rank 0, which has heard of all errors: a launcher takes that of any rank for the code of the run.
      call share_number(code)
   end subroutine follow

   !> Read the sweep and what there is of it. `is_complete`: there is nothing to do, and the user has been told so. `parts`:
   !> paths of the journals of parts of this sweep.
   subroutine prepare(path, options, sweep, journal, records, parts, is_complete, error)
      character(*), intent(in) :: path
      type(sweep_options_type), intent(in) :: options
      type(sweep_type), intent(out) :: sweep
      type(journal_type), intent(out) :: journal
      type(record_type), allocatable, intent(out) :: records(:)
      type(string_type), allocatable, intent(out) :: parts(:)
      logical, intent(out) :: is_complete
      type(error_type), allocatable, intent(out) :: error
      integer :: state

      is_complete = .false.
      call read_sweep_file(path, sweep, error)
      if (allocated(error)) return
      call check_place(sweep, error)
      if (allocated(error)) return
      call find_table(sweep, state)
      if (state == same_table .and. .not. options%again) then
         call leave_complete_alone(sweep, options, is_complete, error)
         if (allocated(error) .or. is_complete) return
      end if
      allocate (records(sweep%cases()))
      call open_journal(journal_path(sweep, options), sweep%checksum, options%again, journal, records, error)
      if (allocated(error)) return
      allocate (parts(0))
      if (options%parts == 0) call gather_parts(sweep, options, parts, records, error)
      if (allocated(error)) call close_journal(journal, error)
      if (.not. allocated(error) .and. sweep%keeps_states) call make_states_folder(sweep, error)
   end subroutine prepare

   !> The folder of the states, beside the table. Error MFV_FILE_ERROR where a power cut could take it away again.
   subroutine make_states_folder(sweep, error)
      type(sweep_type), intent(in) :: sweep
      type(error_type), allocatable, intent(out) :: error
      character(:), allocatable :: why
      integer :: code

      call make_directory(sweep%states_folder())
      call sync_name(sweep%result_path, code)
      if (code == 0) return
      call describe_code(code, why)
      call set_error(error, MFV_FILE_ERROR, sweep%states_folder()//' cannot be brought to the disk: '//why)
   end subroutine make_states_folder

   !> Where the table is complete: whether there is nothing to do, and the user has been told so. There is where --again has
   !> begun anew, so that there is a journal of this sweep without all its cases, or one of a part. A journal with all cases,
   !> which a process that ended between the table and its journal has left, is deleted.
   subroutine leave_complete_alone(sweep, options, is_complete, error)
      type(sweep_type), intent(in) :: sweep
      type(sweep_options_type), intent(in) :: options
      logical, intent(out) :: is_complete
      type(error_type), allocatable, intent(out) :: error
      type(record_type), allocatable :: records(:)
      type(string_type), allocatable :: paths(:)
      logical :: has_journal, found
      integer :: i

      is_complete = .false.
      allocate (records(sweep%cases()))
      call look_into(sweep, journal_path(sweep, options), records, has_journal, error)
      if (allocated(error)) return
      if (has_journal .and. (options%parts > 0 .or. any(records%number == 0))) return
      if (options%parts == 0) then
         call list_part_journals(sweep, paths)
         do i = 1, size(paths)
            call look_into(sweep, paths(i)%text, records, found, error)
            if (allocated(error) .or. found) return
         end do
      end if
      is_complete = .true.
      if (has_journal) call delete_path(journal_path(sweep, options))
      call print_line(sweep%result_path//' is complete: '//to_text(sweep%cases())//' cases; --again solves them anew')
   end subroutine leave_complete_alone

   !> Add what a journal has to `records`. `found`: whether it is there, and of this sweep.
   subroutine look_into(sweep, path, records, found, error)
      type(sweep_type), intent(in) :: sweep
      character(*), intent(in) :: path
      type(record_type), intent(inout) :: records(:)
      logical, intent(out) :: found
      type(error_type), allocatable, intent(out) :: error

      inquire (file=path, exist=found)
      if (found) call gather_journal(path, sweep%checksum, records, found, error)
   end subroutine look_into

   !> Where the journal of a run is.
   function journal_path(sweep, options) result(path)
      type(sweep_type), intent(in) :: sweep
      type(sweep_options_type), intent(in) :: options
      character(len=len(sweep%result_path) + len_trim(ending_of(options))) :: path

      path = sweep%result_path//trim(ending_of(options))
   end function journal_path

   !> Its ending; padded with blanks.
   pure function ending_of(options) result(ending)
      type(sweep_options_type), intent(in) :: options
      character(len=48) :: ending

      ending = '.journal'
      if (options%parts > 0) ending = '.part-'//to_text(options%part)//'-of-'//to_text(options%parts)//'.journal'
   end function ending_of

   !> The journals of parts of this sweep, and their records; with `again` they are not read. Those of another input are left
   !> alone.
   subroutine gather_parts(sweep, options, parts, records, error)
      type(sweep_type), intent(in) :: sweep
      type(sweep_options_type), intent(in) :: options
      type(string_type), allocatable, intent(inout) :: parts(:)
      type(record_type), intent(inout) :: records(:)
      type(error_type), allocatable, intent(out) :: error
      type(string_type), allocatable :: paths(:)
      type(record_type), allocatable :: unwanted(:)
      integer(int64) :: dropped
      logical :: found
      integer :: i

      call list_part_journals(sweep, paths)
      do i = 1, size(paths)
         if (options%again) then
            allocate (unwanted(size(records)))
            call gather_journal(paths(i)%text, sweep%checksum, unwanted, found, error)
            deallocate (unwanted)
         else
            call gather_journal(paths(i)%text, sweep%checksum, records, found, error, dropped)
            if (dropped > 0) call tell_of_dropped(paths(i)%text, dropped)
         end if
         if (allocated(error)) return
         if (found) then
            call add_text(parts, paths(i)%text)
         else
            write (error_unit, '(a)') paths(i)%text//' is of another input, and is left alone'
         end if
      end do
   end subroutine gather_parts

   !> Say that a journal was not whole.
   subroutine tell_of_dropped(path, bytes)
      character(*), intent(in) :: path
      integer(int64), intent(in) :: bytes

      write (error_unit, '(2a,i0,a)') path, ': ', bytes, ' bytes at the end of the journal were not whole and are dropped'
   end subroutine tell_of_dropped

   !> Paths of journals of parts, whatever is in them.
   subroutine list_part_journals(sweep, paths)
      type(sweep_type), intent(in) :: sweep
      type(string_type), allocatable, intent(out) :: paths(:)
      type(c_ptr) :: names
      character(kind=c_char), pointer :: letters(:)

      allocate (paths(0))
      names = c_matching_files(sweep%result_path//'.part-'//c_null_char, '.journal'//c_null_char)
      if (.not. c_associated(names)) return
      call c_f_pointer(names, letters, [1])
      paths = split_lines(from_c(letters))
      call c_free(names)
   end subroutine list_part_journals

   !> Solve what is missing, and finish as far as one can. `code`: the exit code.
   subroutine complete(sweep, options, ranks, journal, records, parts, code)
      type(sweep_type), intent(in) :: sweep
      type(sweep_options_type), intent(in) :: options
      integer, intent(in) :: ranks
      type(journal_type), intent(inout) :: journal
      type(record_type), intent(inout) :: records(:)
      type(string_type), intent(in) :: parts(:)
      integer, intent(out) :: code
      type(error_type), allocatable :: error
      integer, allocatable :: pending(:), wanted(:)
      integer :: i

      ! Every so many cases belong to a part: each has some of the hard ones.
      wanted = [(i, i=max(options%part, 1), size(records), max(options%parts, 1))]
      pending = pack(wanted, records(wanted)%number == 0)
      if (size(pending) < size(wanted)) call print_line(to_text(size(wanted) - size(pending))//' of '// &
         to_text(size(wanted))//' cases were there')
      if (journal%dropped > 0) call tell_of_dropped(journal%path, journal%dropped)
      call solve_cases(sweep, pending, threads_for(options, ranks), ranks, journal, records, error)
      code = 0
      if (allocated(error)) then
         call close_journal(journal, error)
      else if (any(records(wanted)%number == 0)) then
         code = status_exit_code(MFV_INTERRUPTED)
         call leave(sweep, options, size(wanted), journal, records, error)
      else if (options%parts > 0) then
         call close_journal(journal, error)
         if (.not. allocated(error)) call print_line('part '//to_text(options%part)//' of '//to_text(options%parts)//': '// &
            to_text(size(wanted))//' cases in '//journal%path//'; mfv_sweep '//sweep%source//' gathers the parts')
      else
         call finish(sweep, journal, records, parts, error)
      end if
      if (.not. allocated(error)) return
      write (error_unit, '(a)') error%message
      code = status_exit_code(error%status)
   end subroutine complete

   !> After an interrupt: keep the journal, and write a table of the rows so far where no complete one is in the way. `wanted`: how
   !> many cases there should have been.
   subroutine leave(sweep, options, wanted, journal, records, error)
      type(sweep_type), intent(in) :: sweep
      type(sweep_options_type), intent(in) :: options
      integer, intent(in) :: wanted
      type(journal_type), intent(inout) :: journal
      type(record_type), intent(in) :: records(:)
      type(error_type), allocatable, intent(out) :: error
      integer :: state

      call close_journal(journal, error)
      if (allocated(error)) return
      write (error_unit, '(a)') 'interrupted: '//to_text(count(records%number > 0))//' of '//to_text(wanted)// &
         ' cases are kept in '//journal%path//'; the same command'// &
         trim(merge(' without --again', '                ', options%again))//' goes on'
      if (options%parts > 0) return
      call find_table(sweep, state)
      if (state == no_table .or. state == part_table) call write_table(sweep, records, error)
   end subroutine leave

   !> Write the table; only then the journals are needed no more.
   subroutine finish(sweep, journal, records, parts, error)
      type(sweep_type), intent(in) :: sweep
      type(journal_type), intent(inout) :: journal
      type(record_type), intent(in) :: records(:)
      type(string_type), intent(in) :: parts(:)
      type(error_type), allocatable, intent(out) :: error
      integer :: i

      call write_table(sweep, records, error)
      if (allocated(error)) then
         call close_journal(journal, error)
         return
      end if
      do i = 1, size(parts)
         call delete_path(parts(i)%text)
      end do
      call delete_journal(journal)
      call summarize(sweep, records)
   end subroutine finish

   !> Counts by outcome, the largest residual, where the table is.
   subroutine summarize(sweep, records)
      type(sweep_type), intent(in) :: sweep
      type(record_type), intent(in) :: records(:)
      character(:), allocatable :: words, separator
      integer :: i, number

      words = ''
      separator = ': '
      do i = 0, maxval(records%outcome)
         number = count(records%outcome == i)
         if (number == 0) cycle
         words = words//separator//to_text(number)//' '//status_outcome(i)
         separator = ', '
      end do
      call print_line('cases               '//to_text(size(records))//words)
      if (any(records%outcome == MFV_INPUT_ERROR)) then
         i = findloc(records%outcome, MFV_INPUT_ERROR, dim=1)
         call sweep%describe(sweep%places(i), words)
         call print_line('first input error   '//sweep%source//': case '//to_text(i)//' ('//words//'): '// &
            records(i)%message)
      end if
      if (any(records%outcome /= MFV_INPUT_ERROR)) &
         call print_line('certificate         largest relative residual '// &
         to_text(maxval(records%largest_residual, mask=records%outcome /= MFV_INPUT_ERROR)))
      call print_line('table               '//sweep%result_path//" (Python: mfv.read_table('"// &
         sweep%result_path//"'))")
   end subroutine summarize

   !> How many threads solve in this process: as the user says, by option or OMP_NUM_THREADS; else one for each processor of a
   !> process alone, one for each of several ranks.
   integer function threads_for(options, ranks) result(threads)
      type(sweep_options_type), intent(in) :: options
      integer, intent(in) :: ranks
      integer :: length, code

      call get_environment_variable('OMP_NUM_THREADS', length=length, status=code)
      if (options%threads > 0) then
         threads = options%threads
      else if (code == 0 .and. length > 0) then
         threads = omp_get_max_threads()
      else if (ranks > 1) then
         threads = 1
      else
         threads = omp_get_num_procs()
      end if
   end function threads_for

end module mfv_run_sweep
