!> Progress on a terminal (not in a pipe), and the end of a run after Ctrl-C.
module mfv_terminal
   use, intrinsic :: iso_c_binding, only: c_int
   use, intrinsic :: iso_fortran_env, only: error_unit
   use mfv_clock, only: seconds_now
   use mfv_contact_state, only: contact_state_type
   use mfv_kinds, only: wp
   use mfv_observer, only: observer_type
   use mfv_process, only: begin_saving, is_interrupted
   use mfv_strings, only: to_text
   implicit none
   private
   public :: terminal_observer_type

   !> Shows progress on a terminal, and ends the run after Ctrl-C.
   type, extends(observer_type) :: terminal_observer_type
      private
      logical :: visible = .false., shown = .false.
      real(wp) :: next_time = 0.0_wp
      !> Label before the progress; empty for the case itself.
      character(len=20) :: work = ''
   contains
      procedure :: notify
      procedure :: start
      procedure :: begin_work
      procedure :: warn
      procedure :: clear
   end type terminal_observer_type

   !> Seconds between two lines of progress.
   real(wp), parameter :: pause = 0.2_wp

   interface
      function c_isatty(descriptor) bind(C, name='isatty') result(yes)
         import :: c_int
         integer(c_int), value :: descriptor
         integer(c_int) :: yes
      end function c_isatty
   end interface

contains

   !> Show progress if standard error is a terminal.
   subroutine start(self)
      class(terminal_observer_type), intent(inout) :: self
      integer(c_int), parameter :: standard_error = 2

      self%visible = c_isatty(standard_error) /= 0
      self%next_time = seconds_now() + pause
   end subroutine start

   !> See mfv_observer.
   subroutine notify(self, state, segment, segments, fraction, stop_wanted)
      class(terminal_observer_type), intent(inout) :: self
      type(contact_state_type), intent(in) :: state
      integer, intent(in) :: segment, segments
      real(wp), intent(in) :: fraction
      logical, intent(out) :: stop_wanted
      real(wp) :: now

      if (self%work == '') call begin_saving()
      stop_wanted = is_interrupted() /= 0
      if (.not. self%visible) return
      now = seconds_now()
      if (now < self%next_time) return
      self%next_time = now + pause
      self%shown = .true.
      write (error_unit, '(a)', advance='no') achar(13)//'  '//self%work(:len_trim(self%work) + min(1, len_trim(self%work)))// &
         to_text(floor(100*(segment - 1 + fraction)/segments))//' %, load segment '//to_text(segment)//' of '// &
         to_text(segments)//', '//to_text(state%contact_nodes())//' nodes in contact, '// &
         to_text(state%stick_nodes())//' stuck     '
      flush (error_unit)
   end subroutine notify

   !> See mfv_observer.
   subroutine begin_work(self, work)
      class(terminal_observer_type), intent(inout) :: self
      character(*), intent(in) :: work

      self%work = work
      if (work /= '') self%work = work//':'
   end subroutine begin_work

   !> See mfv_observer.
   subroutine warn(self, text)
      class(terminal_observer_type), intent(inout) :: self
      character(*), intent(in) :: text

      call self%clear()
      write (error_unit, '(a)') text
   end subroutine warn

   !> Clear the progress from the terminal.
   subroutine clear(self)
      class(terminal_observer_type), intent(inout) :: self
      integer, parameter :: width = 90

      if (self%shown) write (error_unit, '(a)', advance='no') achar(13)//repeat(' ', width)//achar(13)
      self%shown = .false.
   end subroutine clear

end module mfv_terminal
