!> The terminal: output, progress that stays quiet in a pipe, and Ctrl-C.
module mfv_terminal
   use, intrinsic :: iso_c_binding, only: c_funloc, c_funptr, c_int
   use, intrinsic :: iso_fortran_env, only: error_unit
   use mfv_clock, only: seconds_now
   use mfv_contact_state, only: contact_state_type
   use mfv_error, only: error_type
   use mfv_kinds, only: wp
   use mfv_observer, only: observer_type
   use mfv_status, only: status_exit_code
   use mfv_strings, only: to_text
   implicit none
   private
   public :: get_argument, terminal_observer_type, catch_interrupts, is_interrupted, end_program, fail

   !> Shows progress on a terminal, and ends the run after Ctrl-C, or has it paused then.
   type, extends(observer_type) :: terminal_observer_type
      !> Whether the run can be paused: after Ctrl-C, and every so many seconds where that is not 0.
      logical :: can_pause = .false.
      real(wp) :: pause_seconds = 0.0_wp, next_pause = 0.0_wp
      logical :: visible = .false.
      logical :: shown = .false.
      real(wp) :: next_time = 0.0_wp
      !> What is being done, before the rest; empty for the case itself.
      character(len=20) :: work = ''
   contains
      procedure :: notify
      procedure :: start
      procedure :: allow_pauses
      procedure :: end_pause
      procedure :: clear
   end type terminal_observer_type

   !> Set by the signal handler; a program's state, not the library's.
   logical, volatile :: interrupted = .false.

   integer(c_int), parameter :: signal_interrupt = 2, signal_terminate = 15
   real(wp), parameter :: pause = 0.2_wp

   interface
      function c_isatty(descriptor) bind(C, name='isatty') result(yes)
         import :: c_int
         integer(c_int), value :: descriptor
         integer(c_int) :: yes
      end function c_isatty

      function c_signal(number, handler) bind(C, name='signal') result(previous)
         import :: c_funptr, c_int
         integer(c_int), value :: number
         type(c_funptr), value :: handler
         type(c_funptr) :: previous
      end function c_signal

      subroutine c_exit(code) bind(C, name='exit')
         import :: c_int
         integer(c_int), value :: code
      end subroutine c_exit
   end interface

contains

   !> Find out whether there is a terminal to show progress on.
   subroutine start(self)
      class(terminal_observer_type), intent(inout) :: self
      self%visible = is_terminal()
      self%next_time = seconds_now() + pause
   end subroutine start

   !> From now on the run can be paused; every so many seconds, where that is not 0.
   subroutine allow_pauses(self, seconds)
      class(terminal_observer_type), intent(inout) :: self
      real(wp), intent(in) :: seconds

      self%can_pause = .true.
      self%pause_seconds = seconds
      call self%end_pause()
   end subroutine allow_pauses

   !> The run goes on; the time to the next pause begins.
   subroutine end_pause(self)
      class(terminal_observer_type), intent(inout) :: self

      self%pause_wanted = .false.
      self%next_pause = seconds_now() + self%pause_seconds
   end subroutine end_pause

   !> Whether messages go to a terminal.
   logical function is_terminal()
      integer(c_int), parameter :: standard_error = 2

      is_terminal = c_isatty(standard_error) /= 0
   end function is_terminal

   !> See mfv_observer.
   subroutine notify(self, state, segment, segments, fraction, stop_wanted)
      class(terminal_observer_type), intent(inout) :: self
      type(contact_state_type), intent(in) :: state
      integer, intent(in) :: segment, segments
      real(wp), intent(in) :: fraction
      logical, intent(out) :: stop_wanted
      real(wp) :: now

      stop_wanted = interrupted .and. .not. self%can_pause
      now = 0.0_wp
      if (self%visible .or. self%pause_seconds > 0.0_wp) now = seconds_now()
      self%pause_wanted = self%can_pause .and. (interrupted .or. (self%pause_seconds > 0.0_wp .and. now >= self%next_pause))
      if (.not. self%visible .or. now < self%next_time) return
      self%next_time = now + pause
      self%shown = .true.
      write (error_unit, '(a)', advance='no') achar(13)//'  '//self%work(:len_trim(self%work) + min(1, len_trim(self%work)))// &
         to_text(floor(100*(segment - 1 + fraction)/segments))//' %, part '//to_text(segment)//' of '// &
         to_text(segments)//', '//to_text(state%contact_nodes())//' nodes in contact, '// &
         to_text(state%stick_nodes())//' stuck     '
      flush (error_unit)
   end subroutine notify

   !> Wipe the progress off the terminal.
   subroutine clear(self)
      class(terminal_observer_type), intent(inout) :: self
      integer, parameter :: width = 90

      if (self%shown) write (error_unit, '(a)', advance='no') achar(13)//repeat(' ', width)//achar(13)
      self%shown = .false.
   end subroutine clear

   !> From now on Ctrl-C and a termination request end the run at its next increment, with its result kept.
   subroutine catch_interrupts()
      type(c_funptr) :: previous

      previous = c_signal(signal_interrupt, c_funloc(handle_signal))
      previous = c_signal(signal_terminate, c_funloc(handle_signal))
   end subroutine catch_interrupts

   !> Whether the program has been asked to end.
   logical function is_interrupted()
      is_interrupted = interrupted
   end function is_interrupted

   subroutine handle_signal(number) bind(C)
      integer(c_int), value :: number

      interrupted = interrupted .or. number > 0
   end subroutine handle_signal

   !> Command-line argument `number`, empty where there is none.
   subroutine get_argument(number, text)
      integer, intent(in) :: number
      character(:), allocatable, intent(out) :: text
      integer :: length

      call get_command_argument(number, length=length)
      allocate (character(len=length) :: text)
      if (length > 0) call get_command_argument(number, text)
   end subroutine get_argument

   !> End the program with the message and the exit code of an error.
   subroutine fail(error)
      type(error_type), intent(in) :: error

      write (error_unit, '(a)') error%message
      call end_program(status_exit_code(error%status))
   end subroutine fail

   !> End the program with an exit code, without the words that a stop statement may print.
   subroutine end_program(code)
      integer, intent(in) :: code

      flush (error_unit)
      call c_exit(int(code, c_int))
   end subroutine end_program

end module mfv_terminal
