!> How the cases of a sweep are handed out and their records collected: rank 0 gives cases to its own threads and to the other
!> ranks, case by case, and keeps the journal; each process has one thread that manages and others that solve.
module mfv_sweep_work
   use, intrinsic :: iso_fortran_env, only: error_unit, int8
   use mfv_clock, only: seconds_now
   use mfv_error, only: error_type, set_error
   use mfv_kinds, only: wp
   use mfv_pause, only: pause_briefly
   use mfv_ranks
   use mfv_status, only: MFV_COMPLETE
   use mfv_strings, only: to_text
   use mfv_sweep_journal, only: append_to_journal, journal_type, sync_journal
   use mfv_sweep_plan, only: sweep_type
   use mfv_sweep_record, only: record_type, unpack_record
   use mfv_sweep_team
   use mfv_terminal, only: is_interrupted, is_terminal, request_interrupt
   use omp_lib, only: omp_get_num_threads, omp_get_thread_num, omp_set_dynamic
   implicit none
   private
   public :: solve_cases, assist

   !> Messages between ranks: how many threads a rank has; a case to solve; a record; no more cases will come; everybody is to
   !> stop; a rank has nothing left to send.
   integer, parameter :: message_threads = 1, message_case = 2, message_record = 3, message_end = 4, message_stop = 5, &
                         message_left = 6

   !> What rank 0 knows.
   type :: manager_type
      !> Cases to solve, shape (cases), and how many have been handed out and collected.
      integer, allocatable :: pending(:)
      integer :: handed_out = 0, collected = 0
      !> Threads of each rank, cases that are with it, and whether it has left; shape (0:ranks - 1).
      integer, allocatable :: threads(:), given(:)
      logical, allocatable :: left(:)
      !> Whether the others know that it is over.
      logical :: has_told = .false.
      real(wp) :: started = 0.0_wp, next_line = 0.0_wp, next_sync = 0.0_wp
      logical :: visible = .false., shown = .false.
   end type manager_type

   !> Seconds between lines of progress, and after which the journal is made safe from the end of the machine.
   real(wp), parameter :: line_pause = 0.2_wp, sync_pause = 1.0_wp

contains

   !> Rank 0: have the cases `pending` solved by `threads` threads of this process and by the other ranks; records go into the
   !> journal and into `records` by number. It ends early after Ctrl-C, and with an error where a file cannot be written.
   subroutine solve_cases(sweep, pending, threads, ranks, journal, records, error)
      type(sweep_type), intent(in) :: sweep
      integer, intent(in) :: pending(:), threads, ranks
      type(journal_type), intent(inout) :: journal
      type(record_type), intent(inout) :: records(:)
      type(error_type), allocatable, intent(inout) :: error
      type(manager_type) :: manager
      type(team_type), target :: team
      integer :: own

      own = max(1, min(threads, size(pending)))
      manager%pending = pending
      allocate (manager%threads(0:ranks - 1), source=0)
      allocate (manager%given(0:ranks - 1), source=0)
      allocate (manager%left(0:ranks - 1), source=.false.)
      manager%threads(0) = own
      manager%left(0) = .true.
      manager%started = seconds_now()
      manager%visible = is_terminal()
      call new_team(2*own, team)
      call omp_set_dynamic(.false.)
      !$omp parallel num_threads(own + 1) default(shared)
      if (omp_get_thread_num() == 0) then
         call manage(manager, team, sweep, omp_get_num_threads() == 1, journal, records, error)
         call dismiss(team)
      else
         call work(team, sweep)
      end if
      !$omp end parallel
      if (manager%shown) write (error_unit, '(a)', advance='no') achar(13)//repeat(' ', 70)//achar(13)
   end subroutine solve_cases

   !> The managing thread of rank 0. `alone`: there is no other thread, so that it solves cases itself.
   subroutine manage(manager, team, sweep, alone, journal, records, error)
      type(manager_type), intent(inout) :: manager
      type(team_type), intent(inout), target :: team
      type(sweep_type), intent(in) :: sweep
      logical, intent(in) :: alone
      type(journal_type), intent(inout) :: journal
      type(record_type), intent(inout) :: records(:)
      type(error_type), allocatable, intent(inout) :: error
      logical :: busy, worked, over
      integer :: rests

      rests = 0
      do
         busy = .false.
         call collect_own(manager, team, journal, records, error, busy)
         call collect_from_ranks(manager, journal, records, error, busy)
         if (is_interrupted()) then
            call tell_ranks(manager, message_stop)
         else if (manager%collected == size(manager%pending)) then
            call tell_ranks(manager, message_end)
         else
            call hand_out(manager, team)
         end if
         call show_progress(manager, records)
         if (manager%has_told .and. all(manager%left) .and. .not. busy) then
            if (manager%collected == size(manager%pending)) exit
            if (alone) exit
            call dismiss(team)
            if (is_idle(team)) exit
         end if
         worked = .false.
         if (alone) call work_once(team, sweep, worked, over)
         if (busy .or. worked) rests = 0
         if (.not. (busy .or. worked)) call pause_briefly(rests)
      end do
      ! An error may have come in after the last look.
      call collect_own(manager, team, journal, records, error, busy)
   end subroutine manage

   !> Fetch what the own threads have done.
   subroutine collect_own(manager, team, journal, records, error, busy)
      type(manager_type), intent(inout) :: manager
      type(team_type), intent(inout), target :: team
      type(journal_type), intent(inout) :: journal
      type(record_type), intent(inout) :: records(:)
      type(error_type), allocatable, intent(inout) :: error
      logical, intent(inout) :: busy
      integer(int8), allocatable :: bytes(:)

      do
         call take_record(team, bytes, error)
         if (.not. allocated(bytes)) exit
         busy = .true.
         call keep_record(manager, 0, bytes, journal, records, error)
      end do
   end subroutine collect_own

   !> Receive what the other ranks have to say.
   subroutine collect_from_ranks(manager, journal, records, error, busy)
      type(manager_type), intent(inout) :: manager
      type(journal_type), intent(inout) :: journal
      type(record_type), intent(inout) :: records(:)
      type(error_type), allocatable, intent(inout) :: error
      logical, intent(inout) :: busy
      type(message_type) :: message
      logical :: is_there

      do
         call receive_message(message, is_there)
         if (.not. is_there) exit
         busy = .true.
         select case (message%kind)
         case (message_threads)
            manager%threads(message%from) = message%number
         case (message_record)
            call keep_record(manager, message%from, message%bytes, journal, records, error)
         case (message_stop)
            call request_interrupt()
            if (message%number /= 0 .and. .not. allocated(error)) call set_error(error, message%number, text_of(message%bytes))
         case (message_left)
            manager%left(message%from) = .true.
         end select
      end do
   end subroutine collect_from_ranks

   !> Into the journal first, then into the table to be.
   subroutine keep_record(manager, rank, bytes, journal, records, error)
      type(manager_type), intent(inout) :: manager
      integer, intent(in) :: rank
      integer(int8), intent(in) :: bytes(:)
      type(journal_type), intent(inout) :: journal
      type(record_type), intent(inout) :: records(:)
      type(error_type), allocatable, intent(inout) :: error
      type(record_type) :: record

      manager%given(rank) = manager%given(rank) - 1
      manager%collected = manager%collected + 1
      if (allocated(error)) return
      call append_to_journal(journal, bytes, error)
      if (allocated(error)) then
         call request_interrupt()
         return
      end if
      if (seconds_now() > manager%next_sync) then
         call sync_journal(journal, error)
         manager%next_sync = seconds_now() + sync_pause
         if (allocated(error)) call request_interrupt()
      end if
      call unpack_record(bytes, record)
      records(record%number) = record
   end subroutine keep_record

   !> Give cases to all who can begin one at once; and one to spare for each thread while there are plenty, so that none waits.
   subroutine hand_out(manager, team)
      type(manager_type), intent(inout) :: manager
      type(team_type), intent(inout), target :: team
      integer(int8), parameter :: nothing(0) = [integer(int8) ::]
      integer, parameter :: plenty = 3
      integer :: round, rank, most, next

      do round = 1, 2*maxval(manager%threads)
         do rank = 0, size(manager%threads) - 1
            if (manager%handed_out == size(manager%pending)) return
            most = manager%threads(rank)
            if (size(manager%pending) - manager%handed_out > plenty*sum(manager%threads)) most = 2*most
            if (manager%given(rank) >= most) cycle
            manager%handed_out = manager%handed_out + 1
            manager%given(rank) = manager%given(rank) + 1
            next = manager%pending(manager%handed_out)
            if (rank == 0) call give_case(team, next)
            if (rank > 0) call send_message(rank, message_case, next, nothing)
         end do
      end do
   end subroutine hand_out

   !> Tell the other ranks that it is over, once.
   subroutine tell_ranks(manager, kind)
      type(manager_type), intent(inout) :: manager
      integer, intent(in) :: kind
      integer(int8), parameter :: nothing(0) = [integer(int8) ::]
      integer :: rank

      if (manager%has_told) return
      manager%has_told = .true.
      do rank = 1, size(manager%threads) - 1
         call send_message(rank, kind, 0, nothing)
      end do
   end subroutine tell_ranks

   !> One line on a terminal: how many cases are done, how many ended early, what is left.
   subroutine show_progress(manager, records)
      type(manager_type), intent(inout) :: manager
      type(record_type), intent(in) :: records(:)
      character(len=16) :: left
      integer :: seconds, early, done

      if (.not. manager%visible .or. manager%collected == 0) return
      if (seconds_now() < manager%next_line) return
      manager%next_line = seconds_now() + line_pause
      manager%shown = .true.
      seconds = nint((seconds_now() - manager%started)/manager%collected*(size(manager%pending) - manager%collected))
      write (left, '(i0,a,i2.2)') seconds/60, ':', mod(seconds, 60)
      done = count(records%number > 0)
      early = count(records%number > 0 .and. records%outcome /= MFV_COMPLETE)
      write (error_unit, '(a)', advance='no') achar(13)//'  cases '//to_text(done)//' of '//to_text(size(records))//', '// &
         to_text(early)//' early ends, '//trim(left)//' left     '
      flush (error_unit)
   end subroutine show_progress

   !> The other ranks: solve what rank 0 sends, with `threads` threads, and send the records back. `error`: why this rank
   !> cannot; rank 0 is told, and all end.
   subroutine assist(sweep, threads, error)
      type(sweep_type), intent(in) :: sweep
      integer, intent(in) :: threads
      type(error_type), allocatable, intent(inout) :: error
      type(team_type), target :: team

      if (allocated(error)) call request_interrupt()
      call new_team(2*threads, team)
      call omp_set_dynamic(.false.)
      !$omp parallel num_threads(threads + 1) default(shared)
      if (omp_get_thread_num() == 0) then
         call serve(team, sweep, threads, omp_get_num_threads() == 1, error)
         call dismiss(team)
      else
         call work(team, sweep)
      end if
      !$omp end parallel
   end subroutine assist

   !> The managing thread of another rank.
   subroutine serve(team, sweep, threads, alone, error)
      type(team_type), intent(inout), target :: team
      type(sweep_type), intent(in) :: sweep
      integer, intent(in) :: threads
      logical, intent(in) :: alone
      type(error_type), allocatable, intent(inout) :: error
      integer(int8), parameter :: nothing(0) = [integer(int8) ::]
      type(message_type) :: message
      logical :: busy, is_there, is_over, has_told, has_told_why, worked, over
      integer :: rests

      rests = 0
      is_over = .false.
      has_told = .false.
      has_told_why = .false.
      call send_message(0, message_threads, merge(1, threads, alone), nothing)
      do
         busy = .false.
         call send_records(team, busy, error)
         call receive_message(message, is_there)
         if (is_there) then
            busy = .true.
            if (message%kind == message_case .and. .not. is_interrupted()) call give_case(team, message%number)
            if (message%kind == message_stop) call request_interrupt()
            is_over = is_over .or. message%kind == message_end .or. message%kind == message_stop
         end if
         if (is_interrupted() .and. .not. has_told) then
            has_told = .true.
            call send_stop(error, has_told_why)
            call dismiss(team)
         end if
         if (is_over .and. .not. busy) then
            if (is_idle(team)) exit
         end if
         worked = .false.
         if (alone) call work_once(team, sweep, worked, over)
         if (busy .or. worked) rests = 0
         if (.not. (busy .or. worked)) call pause_briefly(rests)
      end do
      ! An error may have come in after the last look.
      call send_records(team, busy, error)
      if (allocated(error) .and. .not. has_told_why) call send_stop(error, has_told_why)
      call send_message(0, message_left, 0, nothing)
   end subroutine serve

   !> Send rank 0 what the own threads have done. `busy`: set where there was something; `error`: why a result could not be
   !> kept.
   subroutine send_records(team, busy, error)
      type(team_type), intent(inout), target :: team
      logical, intent(inout) :: busy
      type(error_type), allocatable, intent(inout) :: error
      integer(int8), allocatable :: bytes(:)

      do
         call take_record(team, bytes, error)
         if (.not. allocated(bytes)) exit
         busy = .true.
         call send_message(0, message_record, 0, bytes)
      end do
   end subroutine send_records

   !> Tell rank 0 to stop. `has_told_why`: whether there is an error that it now knows.
   subroutine send_stop(error, has_told_why)
      type(error_type), allocatable, intent(in) :: error
      logical, intent(out) :: has_told_why
      integer(int8), parameter :: nothing(0) = [integer(int8) ::]

      has_told_why = allocated(error)
      if (has_told_why) then
         call send_message(0, message_stop, error%status, bytes_of(error%message))
      else
         call send_message(0, message_stop, 0, nothing)
      end if
   end subroutine send_stop

   !> A text as bytes.
   pure function bytes_of(text) result(bytes)
      character(*), intent(in) :: text
      integer(int8) :: bytes(len(text))

      bytes = transfer(text, bytes, len(text))
   end function bytes_of

   !> Bytes as a text.
   pure function text_of(bytes) result(text)
      integer(int8), intent(in) :: bytes(:)
      character(len=size(bytes)) :: text
      integer :: i

      do i = 1, size(bytes)
         text(i:i) = achar(iand(int(bytes(i)), 255))
      end do
   end function text_of

end module mfv_sweep_work
