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

   !> A time, seconds, and the part of the work that is done by then.
   type :: mark_type
      real(wp) :: time = 0.0_wp, done = 0.0_wp
   end type mark_type

   !> Shows progress on a terminal, and ends the run after Ctrl-C.
   type, extends(observer_type) :: terminal_observer_type
      private
      logical :: visible = .false.
      !> Characters shown.
      integer :: shown = 0
      real(wp) :: next_time = 0.0_wp
      !> Label before the progress; empty for the case itself.
      character(len=20) :: work = ''
      !> Whether the work has been seen; the first mark, and two later ones, each at twice the work of the one before.
      logical :: begun = .false.
      type(mark_type) :: first, earlier, later
   contains
      procedure :: notify
      procedure, private :: note
      procedure :: start
      procedure :: begin_work
      procedure :: warn
      procedure :: clear
   end type terminal_observer_type

   !> Seconds between two lines of progress; seconds of work before the time left is estimated.
   real(wp), parameter :: pause = 0.2_wp, enough = 2.0_wp

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
      character(:), allocatable :: text
      type(mark_type) :: now

      if (self%work == '') call begin_saving()
      stop_wanted = is_interrupted() /= 0
      if (.not. self%visible) return
      now = mark_type(seconds_now(), (segment - 1 + fraction)/segments)
      call self%note(now)
      if (now%time < self%next_time) return
      self%next_time = now%time + pause
      text = '  '//self%work(:len_trim(self%work) + min(1, len_trim(self%work)))//to_text(floor(100*now%done))//' %, '// &
             time_left(self, now)//'load segment '//to_text(segment)//' of '//to_text(segments)
      if (self%work == '') text = text//', '//to_text(state%contact_nodes())//' nodes in contact, '// &
                                  to_text(state%stick_nodes())//' stuck'
      write (error_unit, '(a)', advance='no') achar(13)//text//repeat(' ', max(0, self%shown - len(text)))
      self%shown = max(self%shown, len(text))
      flush (error_unit)
   end subroutine notify

   !> Note what is done, for the time left.
   subroutine note(self, now)
      class(terminal_observer_type), intent(inout) :: self
      type(mark_type), intent(in) :: now

      if (.not. self%begun) then
         self%first = now
         self%earlier = now
         self%later = now
         self%begun = .true.
      else if (now%done - self%first%done >= 2*(self%later%done - self%first%done)) then
         self%earlier = self%later
         self%later = now
      end if
   end subroutine note

   !> The estimated time left as text that ends with a comma; empty before there is an estimate. The remaining work is taken to go
   !> on at the mean rate since the mark `earlier`. The first quarter of the work done is before that mark and does not count: a
   !> press may be much slower or faster than the cycles after it.
   function time_left(self, now) result(text)
      class(terminal_observer_type), intent(in) :: self
      type(mark_type), intent(in) :: now
      character(:), allocatable :: text

      text = ''
      if (now%time - self%first%time < enough .or. now%done <= self%earlier%done) return
      text = duration((now%time - self%earlier%time)*(1 - now%done)/(now%done - self%earlier%done))//' left, '
   end function time_left

   !> A time in the largest units that fit.
   pure function duration(seconds) result(text)
      real(wp), intent(in) :: seconds
      character(:), allocatable :: text
      real(wp), parameter :: minute = 60.0_wp, hour = 60*minute, longest = 1e6_wp*hour
      integer :: minutes

      if (seconds < minute) then
         text = to_text(nint(seconds))//' s'
      else if (seconds < hour) then
         text = to_text(nint(seconds/minute))//' min'
      else
         minutes = nint(min(seconds, longest)/minute)
         text = to_text(minutes/60)//' h '//to_text(mod(minutes, 60))//' min'
      end if
   end function duration

   !> See mfv_observer.
   subroutine begin_work(self, work)
      class(terminal_observer_type), intent(inout) :: self
      character(*), intent(in) :: work

      self%work = work
      if (work /= '') self%work = work//':'
      self%begun = .false.
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

      if (self%shown > 0) write (error_unit, '(a)', advance='no') achar(13)//repeat(' ', self%shown)//achar(13)
      self%shown = 0
   end subroutine clear

end module mfv_terminal
