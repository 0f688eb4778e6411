!> Standard output. What cannot be printed ends the program with a message and an exit code: gfortran's own output is lost
!> on a full disk without a word.
module mfv_output
   use, intrinsic :: iso_c_binding
   use, intrinsic :: iso_fortran_env, only: error_unit
   use mfv_safe_file, only: write_all
   use mfv_status, only: MFV_FILE_ERROR, status_exit_code
   use mfv_version, only: library_version
   use mfv_command_line, only: end_program, get_argument
   implicit none
   private
   public :: begin_program, print_text, print_line

   interface
      subroutine c_begin_streams() bind(C, name='mfv_begin_streams')
      end subroutine c_begin_streams
   end interface

contains

   !> What every program does first: see streams.c; and answer --help and --version, if one of them is the first argument. The
   !> program
   !> then ends. `usage`, `help`: lines of text.
   subroutine begin_program(program, usage, help)
      character(*), intent(in) :: program, usage(:), help(:)
      character(:), allocatable :: option

      call c_begin_streams()
      call get_argument(1, option)
      select case (option)
      case ('--help', '-h')
         call print_lines([character(max(len(usage), len(help))) :: usage, help])
      case ('--version')
         call print_line(program//' '//library_version)
      case default
         return
      end select
      call end_program(0)
   end subroutine begin_program

   !> Print a text as it is. Where that fails the program ends with the exit code of MFV_FILE_ERROR.
   subroutine print_text(text)
      character(*), intent(in) :: text
      integer, parameter :: standard_output = 1
      character(:), allocatable :: why

      call write_all(standard_output, text, why)
      if (.not. allocated(why)) return
      write (error_unit, '(a)') 'standard output cannot be written: '//why
      call end_program(status_exit_code(MFV_FILE_ERROR))
   end subroutine print_text

   !> Print a line.
   subroutine print_line(text)
      character(*), intent(in) :: text

      call print_text(text//achar(10))
   end subroutine print_line

   !> Print a text of one line an element.
   subroutine print_lines(lines)
      character(*), intent(in) :: lines(:)
      integer :: i

      do i = 1, size(lines)
         call print_line(trim(lines(i)))
      end do
   end subroutine print_lines

end module mfv_output
