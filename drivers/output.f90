!> Standard output. A failure to print ends the program with a message and an exit code; gfortran's own output would be lost
!> silently on a full disk.
module mfv_output
   use, intrinsic :: iso_c_binding
   use, intrinsic :: iso_fortran_env, only: error_unit
   use mfv_process, only: begin_streams, find_small_limit
   use mfv_safe_file, only: write_all
   use mfv_status, only: MFV_FILE_ERROR, MFV_INPUT_ERROR, status_exit_code
   use mfv_version, only: library_version
   use mfv_command_line, only: end_at_once, end_program, has_argument
   implicit none
   private
   public :: begin_program, print_text, print_line

contains

   !> Open the standard streams (process.c) and answer --help, -h and --version, wherever they are among the arguments; the program
   !> then ends. It also ends, with a message, where limits of the process are too small. `usage`, `help`: lines of text.
   subroutine begin_program(program, usage, help)
      character(*), intent(in) :: program, usage(:), help(:)
      character(:), allocatable :: why

      call begin_streams()
      if (has_argument('--help') .or. has_argument('-h')) then
         call print_lines([character(max(len(usage), len(help))) :: usage, help])
      else if (has_argument('--version')) then
         call print_line(program//' '//library_version)
      else
         call find_small_limit(why)
         if (.not. allocated(why)) return
         write (error_unit, '(a)') program//': '//why
         call end_at_once(status_exit_code(MFV_INPUT_ERROR))
      end if
      call end_program(0)
   end subroutine begin_program

   !> Print a text. On failure the program ends with the exit code of MFV_FILE_ERROR.
   subroutine print_text(text)
      character(*), intent(in) :: text
      integer, parameter :: standard_output = 1
      character(:), allocatable :: why

      call write_all(standard_output, text, why)
      if (.not. allocated(why)) return
      write (error_unit, '(a)') 'cannot write to standard output: '//why
      call end_program(status_exit_code(MFV_FILE_ERROR))
   end subroutine print_text

   subroutine print_line(text)
      character(*), intent(in) :: text

      call print_text(text//achar(10))
   end subroutine print_line

   subroutine print_lines(lines)
      character(*), intent(in) :: lines(:)
      integer :: i

      do i = 1, size(lines)
         call print_line(trim(lines(i)))
      end do
   end subroutine print_lines

end module mfv_output
