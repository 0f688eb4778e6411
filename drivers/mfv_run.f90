!> mfv_run CASE.nml: solve one case and write its result.
program mfv_run
   use mfv_advise_case, only: advise_case
   use mfv_case, only: case_type
   use mfv_case_keys, only: case_catalogue
   use mfv_case_reader, only: read_case_file
   use mfv_error, only: error_type
   use mfv_command_line, only: fail, get_argument, has_argument, refuse, refuse_option
   use mfv_keys, only: list_keys_as_markdown
   use mfv_kinds, only: wp
   use mfv_numbers, only: read_real
   use mfv_output, only: begin_program, print_text
   use mfv_run_case, only: run_case
   use mfv_strings, only: shortened
   use mfv_summary, only: summarize_check
   use mfv_run_help, only: help, usage
   implicit none
   save  ! implied by the standard; without it gfortran's -frecursive leaks the variables of a program

   character(:), allocatable :: path, text
   real(wp), allocatable :: accuracy
   logical :: check, estimate, sensitivity, resume

   call begin_program('mfv_run', usage, help)
   if (has_argument('--keys')) then
      call list_keys_as_markdown(case_catalogue(), text)
      call print_text(text)
   else if (has_argument('--advise')) then
      call advise_case(usage)
   else
      call read_arguments()
      if (check) then
         call check_case(path)
      else
         call run_case(path, resume, estimate, sensitivity, accuracy)
      end if
   end if

contains

   !> One case file, with options before or after it.
   subroutine read_arguments()
      character(:), allocatable :: argument
      integer :: i

      check = .false.
      estimate = .false.
      sensitivity = .false.
      resume = .false.
      i = 0
      do while (i < command_argument_count())
         i = i + 1
         call get_argument(i, argument)
         select case (argument)
         case ('--accuracy')
            i = i + 1
            call read_accuracy(i)
         case ('--check')
            check = .true.
         case ('--estimate')
            estimate = .true.
         case ('--sensitivity')
            sensitivity = .true.
         case ('--resume')
            resume = .true.
         case default
            if (index(argument, '-') == 1) call refuse_option('mfv_run', usage, help, argument)
            if (allocated(path)) call refuse('mfv_run', usage, "too many arguments: '"//shortened(argument)//"'")
            path = argument
         end select
      end do
      if (.not. allocated(path)) call refuse('mfv_run', usage, 'a case file is missing')
      if (check .and. (estimate .or. sensitivity .or. resume .or. allocated(accuracy))) &
         call refuse('mfv_run', usage, '--check only reads the case; remove the other options')
   end subroutine read_arguments

   !> The value of --accuracy, argument number `place`.
   subroutine read_accuracy(place)
      integer, intent(in) :: place
      character(:), allocatable :: argument
      logical :: valid

      valid = place <= command_argument_count()
      if (valid) call get_argument(place, argument)
      allocate (accuracy, source=0.0_wp)
      if (valid) call read_real(argument, accuracy, valid)
      if (valid) valid = accuracy >= 0.0_wp .and. accuracy <= 0.1_wp
      if (.not. valid) call refuse('mfv_run', usage, '--accuracy needs a number from 0 to 0.1, such as 1e-3')
   end subroutine read_accuracy

   subroutine check_case(path)
      character(*), intent(in) :: path
      type(case_type) :: case
      type(error_type), allocatable :: error

      call read_case_file(path, case, error)
      if (allocated(error)) call fail(error)
      call summarize_check(case, text)
      call print_text(text)
   end subroutine check_case

end program mfv_run
