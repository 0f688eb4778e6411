!> What the assertions and the drivers of the pFUnit stand-in share: the pending exceptions, the text of a failure, and
!> the count of tests run. A test tool: one suite a process, one thread asserting.
module funit_core
   use, intrinsic :: iso_c_binding, only: c_funloc, c_funptr, c_int
   use, intrinsic :: iso_fortran_env, only: output_unit
   implicit none(type, external)
   private

   public :: SourceLocation, anyExceptions, assertExceptionRaised, assertFail
   public :: at_index, conformable, detail, fail
   public :: standin_disable, standin_enter, standin_finish, standin_leave, standin_start

   !> Where an assertion stands: the .pf file's name without its folder, and the line.
   type :: SourceLocation
      character(len=255) :: file = ''
      integer :: line = 0
   end type SourceLocation

   type :: exception
      character(len=:), allocatable :: text
   end type exception

   type(exception), allocatable, save :: pending(:)
   character(len=:), allocatable, save :: suite_name, test_name
   integer, save :: tests_run = 0, tests_failed = 0, tests_disabled = 0
   logical, save :: finished = .false.

   interface
      !> C's atexit: 0 when `handler` will be called at the end of the process.
      integer(c_int) function c_atexit(handler) bind(c, name='atexit')
         import :: c_funptr, c_int
         implicit none(type, external)
         type(c_funptr), value :: handler
      end function c_atexit

      !> C's _exit: end the process at once with `status`.
      subroutine c_exit_now(status) bind(c, name='_exit')
         import :: c_int
         implicit none(type, external)
         integer(c_int), value :: status
      end subroutine c_exit_now
   end interface

contains

   !> True while a failed assertion is pending.
   logical function anyExceptions()
      anyExceptions = .false.
      if (allocated(pending)) anyExceptions = size(pending) > 0
   end function anyExceptions

   !> Consume the latest pending exception; having none is a failure of its own.
   subroutine assertExceptionRaised(location)
      type(SourceLocation), intent(in), optional :: location

      if (anyExceptions()) then
         pending = pending(:size(pending) - 1)
      else
         call fail('assertExceptionRaised', detail('raised', 'nothing'), location)
      end if
   end subroutine assertExceptionRaised

   !> Fail with `message`.
   subroutine assertFail(message, location)
      character(len=*), intent(in) :: message
      type(SourceLocation), intent(in), optional :: location

      call fail('assertFail', '', location, message)
   end subroutine assertFail

   !> Record that `assertion` failed, as "file:line: assertion failed: message" and the lines of `details`.
   subroutine fail(assertion, details, location, message)
      character(len=*), intent(in) :: assertion
      !> Lines made by `detail` and `at_index`.
      character(len=*), intent(in) :: details
      type(SourceLocation), intent(in), optional :: location
      character(len=*), intent(in), optional :: message

      type(exception), allocatable :: longer(:)
      character(len=:), allocatable :: text
      integer :: n

      text = assertion//' failed'
      if (present(location)) text = trim(location%file)//':'//numeral(location%line)//': '//text
      if (present(message)) text = text//': '//trim(message)
      n = 0
      if (allocated(pending)) n = size(pending)
      allocate (longer(n + 1))
      if (n > 0) longer(:n) = pending
      longer(n + 1)%text = text//details
      call move_alloc(longer, pending)
   end subroutine fail

   !> A new line "label: <value>" for the details of a failure.
   pure function detail(label, value) result(line)
      character(len=*), intent(in) :: label, value
      character(len=:), allocatable :: line

      line = new_line('a')//repeat(' ', max(0, 14 - len(label)))//label//': <'//value//'>'
   end function detail

   !> A new line with the subscripts of element `position` (in array element order) of an array of shape `extents`;
   !> empty for a scalar.
   pure function at_index(position, extents) result(line)
      integer, intent(in) :: position
      integer, intent(in) :: extents(:)
      character(len=:), allocatable :: line
      integer :: i, rest

      line = ''
      if (size(extents) == 0) return
      rest = position - 1
      do i = 1, size(extents)
         line = line//','//numeral(mod(rest, extents(i)) + 1)
         rest = rest/extents(i)
      end do
      line = detail('at index', line(2:))
   end function at_index

   !> True when an expected value of the first shape may stand against an actual value of the second: a scalar, or the
   !> same shape. Otherwise the assertion has failed.
   logical function conformable(expected, actual, assertion, location, message)
      integer, intent(in) :: expected(:), actual(:)
      character(len=*), intent(in) :: assertion
      type(SourceLocation), intent(in), optional :: location
      character(len=*), intent(in), optional :: message

      conformable = size(expected) == 0
      if (size(expected) == size(actual)) conformable = all(expected == actual)
      if (conformable) return
      call fail(assertion, detail('expected shape', list(expected))//detail('actual shape', list(actual)), &
         & location, message)
   end function conformable

   !> Begin the suite, and watch for a process that ends before `standin_finish`, even by `stop` with status 0.
   subroutine standin_start(suite)
      character(len=*), intent(in) :: suite

      suite_name = suite
      test_name = ''
      if (c_atexit(c_funloc(end_of_process)) /= 0_c_int) error stop 'funit stand-in: atexit refused'
   end subroutine standin_start

   !> Begin a test.
   subroutine standin_enter(test)
      character(len=*), intent(in) :: test

      test_name = test
      tests_run = tests_run + 1
   end subroutine standin_enter

   !> End a test: report the exceptions pending and clear them.
   subroutine standin_leave()
      integer :: i

      if (anyExceptions()) then
         tests_failed = tests_failed + 1
         call say('FAIL '//test_name)
         do i = 1, size(pending)
            call say(pending(i)%text)
         end do
         deallocate (pending)
      else
         call say('ok   '//test_name)
      end if
      test_name = ''
   end subroutine standin_leave

   !> Report a test that is not run.
   subroutine standin_disable(test)
      character(len=*), intent(in) :: test

      tests_disabled = tests_disabled + 1
      call say('skip '//test)
   end subroutine standin_disable

   !> End the suite: print the summary, and stop with status 1 unless a test ran and none failed.
   subroutine standin_finish()
      finished = .true.
      call say(suite_name//': '//numeral(tests_run)//' tests, '//numeral(tests_failed)//' failed, ' &
         & //numeral(tests_disabled)//' disabled')
      if (tests_run == 0) call say(suite_name//': FAIL: no test ran')
      if (tests_run == 0 .or. tests_failed > 0) stop 1, quiet = .true.
   end subroutine standin_finish

   !> Called at the end of the process: one that ends early has failed, whatever its status.
   subroutine end_of_process() bind(c, name='mfv_standin_end_of_process')
      if (finished) return
      call say(suite_name//': FAIL: the process ended before the suite, in test <'//test_name//'>')
      call c_exit_now(1_c_int)
   end subroutine end_of_process

   !> Print a line and flush, so that a crash loses none.
   subroutine say(line)
      character(len=*), intent(in) :: line

      write (output_unit, '(a)') line
      flush (output_unit)
   end subroutine say

   !> `i` in decimal digits.
   pure function numeral(i) result(text)
      integer, intent(in) :: i
      character(len=:), allocatable :: text
      character(len=12) :: buffer

      write (buffer, '(i0)') i
      text = trim(buffer)
   end function numeral

   !> The values, between commas.
   pure function list(values) result(text)
      integer, intent(in) :: values(:)
      character(len=:), allocatable :: text
      integer :: i

      text = ''
      do i = 1, size(values)
         text = text//','//numeral(values(i))
      end do
      if (len(text) > 0) text = text(2:)
   end function list

end module funit_core
