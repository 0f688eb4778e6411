!> mfv_stress RESULT.h5: compute stresses inside a body of a result and add them to its file.
program mfv_stress
   use, intrinsic :: iso_fortran_env, only: error_unit
   use mfv_error, only: error_type
   use mfv_command_line, only: fail, get_argument, refuse, refuse_option
   use mfv_kinds, only: wp
   use mfv_output, only: begin_program, print_text
   use mfv_numbers, only: read_real
   use mfv_table_file, only: read_table
   use mfv_stress_file
   use mfv_strings, only: shortened, to_text
   use mfv_stress_text, only: list_stresses, summarize_stresses
   use mfv_stress_help, only: help, usage
   implicit none
   save  ! implied by the standard; without it gfortran's -frecursive leaks the variables of a program

   type(stress_request_type) :: request
   type(stress_result_type) :: result
   type(error_type), allocatable :: error
   character(:), allocatable :: path, text, warning

   call begin_program('mfv_stress', usage, help)
   call read_arguments()
   call add_stresses(path, request, result, error)
   if (allocated(error)) call fail(error)
   text = ''
   if (allocated(request%x)) call list_stresses(result, text)
   call print_text(text)
   call summarize_stresses(path, request, result, text, warning)
   call print_text(text)
   if (warning /= '') write (error_unit, '(a)') warning

contains

   subroutine read_arguments()
      real(wp), parameter :: most_points = 1.0e7_wp
      character(:), allocatable :: argument
      real(wp), allocatable :: points(:, :)
      integer :: i

      path = ''
      i = 1
      do while (i <= command_argument_count())
         call get_argument(i, argument)
         i = i + 1
         select case (argument)
         case ('--body')
            call get_argument(i, argument)
            if (argument /= 'lower' .and. argument /= 'upper') &
               call refuse('mfv_stress', usage, "--body must be lower or upper, not '"//shortened(argument)//"'")
            request%upper = argument == 'upper'
         case ('--step')
            request%step = nint(number(i, '--step', 1.0_wp, whole=.true.))
         case ('--width')
            request%width = number(i, '--width', tiny(1.0_wp))
         case ('--depth')
            request%depth = number(i, '--depth', tiny(1.0_wp))
         case ('--points')
            request%across = nint(number(i, '--points', 2.0_wp, whole=.true.))
            i = i + 1
            request%down = nint(number(i, '--points', 2.0_wp, whole=.true.))
         case ('--at')
            call get_argument(i, argument)
            call read_table(argument, 'x and y', 2, .false., points, error)
            if (allocated(error)) call refuse('mfv_stress', usage, error%message)
            if (size(points, 2) == 0) call refuse('mfv_stress', usage, argument//' has no points')
            request%x = points(1, :)
            request%y = points(2, :)
         case default
            if (index(argument, '-') == 1) call refuse_option('mfv_stress', usage, help, argument)
            if (path /= '') call refuse('mfv_stress', usage, "too many arguments: '"//shortened(argument)//"'")
            path = argument
            cycle
         end select
         i = i + 1
      end do
      if (path == '') call refuse('mfv_stress', usage, 'a result file is missing')
      if (real(request%across, wp)*request%down > most_points) &
         call refuse('mfv_stress', usage, '--points asks for more than '//to_text(most_points)//' points')
   end subroutine read_arguments

   !> The number in argument `i`, at least `lower`.
   real(wp) function number(i, option, lower, whole) result(value)
      integer, intent(in) :: i
      character(*), intent(in) :: option
      real(wp), intent(in) :: lower
      logical, intent(in), optional :: whole
      real(wp), parameter :: most = 1.0e5_wp
      character(:), allocatable :: text, kind
      logical :: is_right

      kind = ' a number above 0 and at most '//to_text(most)
      if (present(whole)) kind = ' a whole number from '//to_text(nint(lower))//' to '//to_text(nint(most))
      call get_argument(i, text)
      call read_real(text, value, is_right)
      if (is_right .and. present(whole)) is_right = .not. abs(value - anint(value)) > 0.0_wp
      if (.not. (is_right .and. value >= lower .and. value <= most)) &
         call refuse('mfv_stress', usage, option//" needs"//kind//", not '"//shortened(text)//"'")
   end function number

end program mfv_stress
