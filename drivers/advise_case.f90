!> The option --advise of mfv_run.
module mfv_advise_case
   use, intrinsic :: iso_c_binding, only: c_int
   use mfv_advice, only: advice_count, advice_type, advise
   use mfv_advice_text, only: read_wanted_error, read_wanted_quantities, write_advice
   use mfv_case, only: case_type
   use mfv_case_reader, only: read_case_file
   use mfv_error, only: error_type, set_error
   use mfv_command_line, only: fail, get_argument, refuse
   use mfv_kinds, only: wp
   use mfv_output, only: print_text
   use mfv_process, only: catch_interrupts, use_one_thread
   use mfv_status, only: MFV_COMPLETE, MFV_INTERRUPTED, status_exit_code
   use mfv_strings, only: shortened
   use mfv_terminal, only: terminal_observer_type
   implicit none
   private
   public :: advise_case

contains

   !> Read the arguments and the case, and print the mesh and the solver that the wanted error needs. The program ends with an exit
   !> code on failure. `usage`: lines of text.
   subroutine advise_case(usage)
      character(*), intent(in) :: usage(:)
      type(case_type) :: case
      type(advice_type) :: advice
      type(error_type), allocatable :: error
      type(terminal_observer_type) :: observer
      character(:), allocatable :: path, text
      real(wp) :: wanted_error
      logical :: wanted(advice_count)

      call use_one_thread()
      call read_arguments(usage, path, wanted_error, wanted)
      call read_case_file(path, case, error)
      if (allocated(error)) call fail(error)
      call catch_interrupts(int(status_exit_code(MFV_INTERRUPTED), c_int))
      call observer%start()
      call observer%begin_work('coarse meshes')
      call advise(case%scene, wanted_error, wanted, advice, observer)
      call observer%clear()
      if (advice%status /= MFV_COMPLETE) then
         call set_error(error, advice%status, path//': no advice: '//advice%message)
         call fail(error)
      end if
      call write_advice(case, advice, text)
      call print_text(text)
   end subroutine advise_case

   !> --advise, error=..., of=... and the case, in any order.
   subroutine read_arguments(usage, path, wanted_error, wanted)
      character(*), intent(in) :: usage(:)
      character(:), allocatable, intent(out) :: path
      real(wp), intent(out) :: wanted_error
      logical, intent(out) :: wanted(:)
      character(:), allocatable :: argument, why
      logical :: has_error
      integer :: i

      path = ''
      wanted_error = 0.0_wp
      wanted = .true.
      has_error = .false.
      do i = 1, command_argument_count()
         call get_argument(i, argument)
         why = ''
         if (argument == '--advise') cycle
         if (index(argument, '-') == 1) then
            why = "does not take the option '"//shortened(argument)//"'"
         else if (index(argument, 'error=') == 1) then
            call read_wanted_error(argument(len('error=') + 1:), wanted_error, why)
            if (has_error) why = shortened(argument)//': error is given twice'
            has_error = .true.
         else if (index(argument, 'of=') == 1) then
            call read_wanted_quantities(argument(len('of=') + 1:), wanted, why)
         else if (path == '') then
            path = argument
         else
            why = "too many arguments: '"//shortened(argument)//"'"
         end if
         if (why /= '') call refuse('mfv_run', usage, '--advise '//why)
      end do
      if (.not. has_error) call refuse('mfv_run', usage, '--advise needs the wanted error, such as error=1e-2')
      if (path == '') call refuse('mfv_run', usage, 'a case file is missing')
   end subroutine read_arguments

end module mfv_advise_case
