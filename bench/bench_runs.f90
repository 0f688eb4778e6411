!> Timed cases. Every case is solved several times, alternating with the others, so that other load of the machine affects all;
!> nothing is recorded and only the tractions are written. A line of JSON for every case.
module bench_runs
   use, intrinsic :: iso_fortran_env, only: error_unit, int64, output_unit
   use mfv_case, only: case_type
   use mfv_case_reader, only: read_case_file
   use mfv_clock, only: seconds_now
   use mfv_error, only: error_type
   use mfv_kinds, only: wp
   use mfv_motions, only: motion_approach, motion_shift
   use mfv_reduced_system, only: reduced_system_type
   use mfv_simulation, only: history_none, new_simulation, simulation_type, states_steps
   implicit none
   private
   public :: run_cases

   !> Cost of the last step of the load history, or of the whole.
   type :: counts_type
      real(wp) :: seconds = 0.0_wp
      integer :: events = 0, solves = 0
      integer(int64) :: iterations = 0, products = 0
   end type counts_type

   !> A case with its minimum times.
   type :: entry_type
      type(case_type) :: case
      type(simulation_type) :: simulation
      type(counts_type) :: whole, last
   end type entry_type

contains

   !> Solve the cases in the files `paths`, `repeats` times each. `tractions`: whether those of the end are written, to
   !> <case file>.tractions: x, pressure, shear of every node, as binary double precision.
   subroutine run_cases(paths, repeats, tractions)
      character(*), intent(in) :: paths(:)
      integer, intent(in) :: repeats
      logical, intent(in) :: tractions
      type(entry_type), allocatable :: entries(:)
      integer :: i, repeat

      allocate (entries(size(paths)))
      do i = 1, size(paths)
         call read_entry(trim(paths(i)), entries(i))
      end do
      do repeat = 1, repeats
         do i = 1, size(entries)
            call solve(entries(i), repeat == 1)
         end do
      end do
      do i = 1, size(entries)
         call write_entry(trim(paths(i)), entries(i))
         if (tractions) call write_tractions(trim(paths(i))//'.tractions', entries(i)%simulation)
      end do
   end subroutine run_cases

   !> Read one case; stop the program if it is invalid.
   subroutine read_entry(path, entry)
      character(*), intent(in) :: path
      type(entry_type), intent(inout) :: entry
      type(error_type), allocatable :: error

      call read_case_file(path, entry%case, error)
      if (.not. allocated(error)) return
      write (error_unit, '(a)') error%message
      error stop 2, quiet = .true.
   end subroutine read_entry

   !> Solve a case once more. `first`: the times are the first ones.
   subroutine solve(entry, first)
      type(entry_type), intent(inout) :: entry
      logical, intent(in) :: first
      type(counts_type) :: before, after
      real(wp) :: started
      integer :: i

      started = seconds_now()
      entry%simulation = new_simulation(entry%case%scene, history_none, states_steps)
      before = counts_type()
      after = counts_type()
      associate (steps => entry%case%scene%steps)
         do i = 1, size(steps)
            before = after
            call entry%simulation%advance(steps(i))
            after = counts_now(entry%simulation, started)
         end do
      end associate
      before%seconds = after%seconds - before%seconds
      if (.not. first) then
         before%seconds = min(before%seconds, entry%last%seconds)
         after%seconds = min(after%seconds, entry%whole%seconds)
      end if
      entry%last = counts_type(before%seconds, after%events - before%events, after%solves - before%solves, &
                               after%iterations - before%iterations, after%products - before%products)
      entry%whole = after
   end subroutine solve

   !> Present counts.
   type(counts_type) function counts_now(simulation, started) result(counts)
      type(simulation_type), intent(in) :: simulation
      real(wp), intent(in) :: started

      counts%seconds = seconds_now() - started
      counts%events = simulation%contact%events
      counts%solves = simulation%contact%system%solves
      counts%iterations = simulation%contact%system%iterations
      counts%products = simulation%contact%system%products
   end function counts_now

   !> One line.
   subroutine write_entry(path, entry)
      character(*), intent(in) :: path
      type(entry_type), intent(in) :: entry
      integer :: refinements, rebuilds

      refinements = 0
      rebuilds = 0
      select type (system => entry%simulation%contact%system)
      type is (reduced_system_type)
         refinements = system%refinements
         rebuilds = system%rebuilds()
      end select
      associate (contact => entry%simulation%contact, state => entry%simulation%contact%state)
         write (output_unit, '(4a,7(a,i0),5(a,es22.15),a)', advance='no') '{"case": "', path, '", "solver": "', &
            trim(contact%system%name)//'"', ', "outcome": ', entry%simulation%outcome, ', "nodes": ', contact%model%nodes(), &
            ', "contact": ', state%contact_nodes(), ', "stuck": ', state%stick_nodes(), &
            ', "refinements": ', refinements, ', "rebuilds": ', rebuilds, ', "memory": ', peak_memory(), &
            ', "certificate": ', contact%certificate%largest(), ', "dissipation": ', state%dissipation, &
            ', "interval": ', contact%model%interval(), ', "normal_force": ', state%fields%force(motion_approach), &
            ', "tangential_force": ', state%fields%force(motion_shift), ', '
      end associate
      call write_counts('whole', entry%whole)
      write (output_unit, '(a)', advance='no') ', '
      call write_counts('last', entry%last)
      write (output_unit, '(a)') '}'
   end subroutine write_entry

   !> Peak memory of this process so far, bytes; 0 if unknown.
   integer(int64) function peak_memory() result(bytes)
      character(*), parameter :: key = 'VmHWM:'
      character(len=80) :: line
      integer :: unit, status

      bytes = 0
      open (newunit=unit, file='/proc/self/status', status='old', action='read', iostat=status)
      if (status /= 0) return
      do
         read (unit, '(a)', iostat=status) line
         if (status /= 0) exit
         if (index(line, key) /= 1) cycle
         read (line(len(key) + 1:index(line, 'kB') - 1), *) bytes
         bytes = 1024*bytes
         exit
      end do
      close (unit)
   end function peak_memory

   subroutine write_counts(name, counts)
      character(*), intent(in) :: name
      type(counts_type), intent(in) :: counts

      write (output_unit, '(3a,es15.8,4(a,i0),a)', advance='no') '"', name, '": {"seconds": ', counts%seconds, ', "events": ', &
         counts%events, ', "solves": ', counts%solves, ', "iterations": ', counts%iterations, ', "products": ', &
         counts%products, '}'
   end subroutine write_counts

   subroutine write_tractions(path, simulation)
      character(*), intent(in) :: path
      type(simulation_type), intent(in) :: simulation
      integer :: unit

      open (newunit=unit, file=path, access='stream', form='unformatted', status='replace', action='write')
      associate (model => simulation%contact%model, fields => simulation%contact%state%fields)
         write (unit) model%x, fields%pressure, fields%shear
      end associate
      close (unit)
   end subroutine write_tractions

end module bench_runs
