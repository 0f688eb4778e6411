!> mfv_run CASE.nml: solve one case and write its result.
program mfv_run
   use mfv_advise_case, only: advise_case
   use mfv_case, only: case_type
   use mfv_case_keys, only: case_catalogue
   use mfv_case_reader, only: read_case_file
   use mfv_error, only: error_type
   use mfv_command_line, only: fail, get_argument, refuse, refuse_option
   use mfv_keys, only: list_keys_as_markdown
   use mfv_output, only: begin_program, print_text
   use mfv_run_case, only: run_case
   use mfv_strings, only: shortened
   use mfv_summary, only: summarize_check
   use mfv_run_help, only: help, usage
   implicit none
   save  ! the standard says so of a program; gfortran's -frecursive loses what they hold, which the leak sanitizer tells

   character(:), allocatable :: option, text

   call begin_program('mfv_run', usage, help)
   call get_argument(1, option)
   select case (option)
   case ('--keys')
      call list_keys_as_markdown(case_catalogue(), text)
      call print_text(text)
   case ('--advise')
      call advise_case(usage)
   case ('--check')
      call check_case()
   case default
      call solve_case()
   end select

contains

   !> Solve the case that is the last argument, after options in any order.
   subroutine solve_case()
      character(:), allocatable :: path, argument
      logical :: estimate, sensitivity, resume
      integer :: i

      estimate = .false.
      sensitivity = .false.
      resume = .false.
      do i = 1, command_argument_count() - 1
         call get_argument(i, argument)
         select case (argument)
         case ('--estimate')
            estimate = .true.
         case ('--sensitivity')
            sensitivity = .true.
         case ('--resume')
            resume = .true.
         case default
            if (index(argument, '-') == 1) call refuse_option('mfv_run', usage, help, argument)
            call expect_arguments(i)
         end select
      end do
      call get_case(max(command_argument_count(), 1), path)
      call run_case(path, resume, estimate, sensitivity)
   end subroutine solve_case

   !> Argument `number`, which must be the case and the last one.
   subroutine get_case(number, path)
      integer, intent(in) :: number
      character(:), allocatable, intent(out) :: path

      call expect_arguments(number)
      call get_argument(number, path)
      if (any(path == [character(13) :: '--estimate', '--sensitivity', '--resume'])) &
         call refuse('mfv_run', usage, 'a case file is missing')
      if (index(path, '-') == 1) call refuse_option('mfv_run', usage, help, path)
   end subroutine get_case

   !> Refuse any other number of arguments.
   subroutine expect_arguments(number)
      integer, intent(in) :: number
      character(:), allocatable :: surplus

      if (command_argument_count() < number) call refuse('mfv_run', usage, 'a case file is missing')
      if (command_argument_count() <= number) return
      call get_argument(number + 1, surplus)
      call refuse('mfv_run', usage, "too many arguments: '"//shortened(surplus)//"'")
   end subroutine expect_arguments

   subroutine check_case()
      character(:), allocatable :: path
      type(case_type) :: case
      type(error_type), allocatable :: error

      call get_case(2, path)

      call read_case_file(path, case, error)
      if (allocated(error)) call fail(error)
      call summarize_check(case, text)
      call print_text(text)
   end subroutine check_case

end program mfv_run
