!> Command-line arguments, error messages about them, and program exit.
module mfv_command_line
   use, intrinsic :: iso_c_binding, only: c_int
   use, intrinsic :: iso_fortran_env, only: error_unit
   use mfv_error, only: error_type
   use mfv_status, only: MFV_INPUT_ERROR, status_exit_code
   use mfv_strings, only: add_text, list_of_words, find_nearest_name, shortened, string_type
   implicit none
   private
   public :: get_argument, has_argument, refuse, refuse_option, fail, end_program, end_at_once

   interface
      subroutine c_exit(code) bind(C, name='exit')
         import :: c_int
         integer(c_int), value :: code
      end subroutine c_exit

      subroutine c_exit_at_once(code) bind(C, name='_exit')
         import :: c_int
         integer(c_int), value :: code
      end subroutine c_exit_at_once
   end interface

contains

   !> Command-line argument `number`; empty if there are fewer.
   subroutine get_argument(number, text)
      integer, intent(in) :: number
      character(:), allocatable, intent(out) :: text
      integer :: length

      call get_command_argument(number, length=length)
      allocate (character(len=length) :: text)
      if (length > 0) call get_command_argument(number, text)
   end subroutine get_argument

   !> Whether one of the command-line arguments is `text`.
   logical function has_argument(text)
      character(*), intent(in) :: text
      character(:), allocatable :: argument
      integer :: i

      has_argument = .false.
      do i = 1, command_argument_count()
         call get_argument(i, argument)
         has_argument = has_argument .or. argument == text
      end do
   end function has_argument

   !> End the program with the message and the exit code of an error.
   subroutine fail(error)
      type(error_type), intent(in) :: error

      write (error_unit, '(a)') error%message
      call end_program(status_exit_code(error%status))
   end subroutine fail

   !> End the program with an exit code, without the output of a stop statement.
   subroutine end_program(code)
      integer, intent(in) :: code

      flush (error_unit)
      call c_exit(int(code, c_int))
   end subroutine end_program

   !> The same without exit handlers: that of a shared OpenBLAS waits forever for threads that have no memory.
   subroutine end_at_once(code)
      integer, intent(in) :: code

      flush (error_unit)
      call c_exit_at_once(int(code, c_int))
   end subroutine end_at_once

   !> End `program` because of wrong arguments: print why, and its `usage` (lines of text).
   subroutine refuse(program, usage, why)
      character(*), intent(in) :: program, usage(:), why
      integer :: i

      write (error_unit, '(a)') program//': '//why, (trim(usage(i)), i=1, size(usage)), &
         "Try '"//program//" --help' for more information."
      call end_program(status_exit_code(MFV_INPUT_ERROR))
   end subroutine refuse

   !> End `program` because it has no option of this name, and suggest the nearest. `help`: lines of text with one option each,
   !> such as '  --check   read the case'.
   subroutine refuse_option(program, usage, help, option)
      character(*), intent(in) :: program, usage(:), help(:), option
      type(string_type), allocatable :: names(:)
      character(:), allocatable :: nearest

      call find_options(help, names)
      call find_nearest_name(option(max(verify(option, '-'), 1):), names, nearest)
      if (nearest /= '') nearest = '; did you mean --'//nearest//'?'
      if (option == '-o') nearest = "; name the result in the case: &output file='NAME.h5'"
      call refuse(program, usage, "unknown option '"//shortened(option)//"'"//nearest)
   end subroutine refuse_option

   !> The options in a help text, without their dashes: the first --name of lines that begin with an option.
   subroutine find_options(help, names)
      character(*), intent(in) :: help(:)
      type(string_type), allocatable, intent(out) :: names(:)
      type(string_type), allocatable :: words(:)
      integer :: i, j

      allocate (names(0))
      do i = 1, size(help)
         if (index(adjustl(help(i)), '-') /= 1) cycle
         words = list_of_words(help(i))
         do j = 1, size(words)
            if (index(words(j)%text, '--') /= 1) cycle
            call add_text(names, words(j)%text(3:))
            exit
         end do
      end do
   end subroutine find_options

end module mfv_command_line
