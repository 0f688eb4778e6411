!> What the programs say about themselves: --help, and refusals of wrong arguments.
module mfv_help
   use, intrinsic :: iso_fortran_env, only: error_unit
   use mfv_output, only: print_line
   use mfv_status, only: MFV_INPUT_ERROR, status_exit_code
   use mfv_strings, only: add_text, list_of_words, nearest_name, shortened, string_type
   use mfv_terminal, only: end_program
   implicit none
   private
   public :: print_lines, refuse, refuse_option

contains

   !> Print a text of one line an element.
   subroutine print_lines(lines)
      character(*), intent(in) :: lines(:)
      integer :: i

      do i = 1, size(lines)
         call print_line(trim(lines(i)))
      end do
   end subroutine print_lines

   !> End `program` because of its arguments: say why, and how it is used. `usage`: lines of text.
   subroutine refuse(program, usage, why)
      character(*), intent(in) :: program, usage(:), why
      integer :: i

      write (error_unit, '(a)') program//': '//why, (trim(usage(i)), i=1, size(usage)), program//' --help explains.'
      call end_program(status_exit_code(MFV_INPUT_ERROR))
   end subroutine refuse

   !> End `program` because it has no option of this name, and name the nearest that it has. `help`: lines of text, with one
   !> option a line, as in '  --check   read the case'. An option that it has is in the wrong place.
   subroutine refuse_option(program, usage, help, option)
      character(*), intent(in) :: program, usage(:), help(:), option
      type(string_type), allocatable :: names(:)
      character(:), allocatable :: nearest

      call find_options(help, names)
      nearest = nearest_name(option(max(verify(option, '-'), 1):), names)
      if ('--'//nearest == option) call refuse(program, usage, option//' does not go with the arguments before it')
      if (nearest /= '') nearest = '; did you mean --'//nearest//'?'
      call refuse(program, usage, "unknown option '"//shortened(option)//"'"//nearest)
   end subroutine refuse_option

   !> The options that a help text explains, without their dashes: the first --name of lines that begin with an option.
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

end module mfv_help
