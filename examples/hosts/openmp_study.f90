!> A parameter study in a Fortran program with OpenMP: shear cycles of a rigid cylinder on a half-plane for every combination of
!> coefficient
!> of friction, lateral force and Dundurs' parameter, one contact per thread. Prints a table (CSV), a row per case.
!>
!>     OMP_NUM_THREADS=4 OPENBLAS_NUM_THREADS=1 openmp_study > study.csv
!>
!> Contacts are independent, so that the table is identical for any number of threads. A case that ends early, as
!> the ones
!> beyond the friction limit do, is a row with its outcome. What thousands of cases take (axes of any keys, restarts, MPI) mfv.study
!> of the Python package has.
program openmp_study
   use mfv
   implicit none

   real(wp), parameter :: frictions(*) = [0.2_wp, 0.5_wp, 0.8_wp]
   real(wp), parameter :: force_ratios(*) = [0.2_wp, 0.4_wp, 0.6_wp, 0.8_wp, 1.1_wp]
   real(wp), parameter :: betas(*) = [0.0_wp, 0.25_wp, 0.5_wp]

   !> Columns that are fields of the contact's group observables.
   character(len=*), parameter :: columns(*) = [character(len=20) :: 'cycle_dissipation', 'tangential_stiffness', 'loss_factor', &
                                                                                         'contact_half_width', 'stick_ratio_return']

   !> A case and its results: status (see mfv_status), and columns, NaN if missing.
   type :: row_type
      real(wp) :: friction = 0.0_wp, force_ratio = 0.0_wp, beta = 0.0_wp
      integer :: status = MFV_COMPLETE
      real(wp) :: values(size(columns)) = 0.0_wp
      character(:), allocatable :: fault
   end type row_type

   type(row_type) :: rows(size(frictions)*size(force_ratios)*size(betas))
   integer :: i, j, k, number

   number = 0
   do i = 1, size(frictions)
      do j = 1, size(force_ratios)
         do k = 1, size(betas)
            number = number + 1
            rows(number)%friction = frictions(i)
            rows(number)%force_ratio = force_ratios(j)
            rows(number)%beta = betas(k)
         end do
      end do
   end do

   ! Cases take different times: a free thread takes the next one.
   !$omp parallel do schedule(dynamic)
   do number = 1, size(rows)
      call solve(rows(number))
   end do
   !$omp end parallel do

   call print_table(rows)

contains

   !> Solve one case. Everything that it needs is local, and so belongs to its thread.
   subroutine solve(row)
      type(row_type), intent(inout) :: row
      type(draft_type) :: scene
      type(contact_type) :: contact
      type(error_type), allocatable :: error

      call describe(row, scene)
      call new_contact(scene, contact, error)
      if (allocated(error)) then
         row%status = error%status
         row%fault = error%message
         return
      end if
      call contact%run()
      row%status = contact%status()
      call read_values(contact, row%values)
   end subroutine solve

   !> The scene of a case: pressed with friction, sheared to the lateral force, and twice back and forth.
   subroutine describe(row, scene)
      type(row_type), intent(in) :: row
      type(draft_type), intent(out) :: scene
      real(wp), parameter :: normal_force = 5.0e-4_wp

      call scene%set('body(1)%shape', 'half_plane')
      call scene%set('body(1)%shear_modulus', 1.0_wp)
      ! beta = (kappa - 1)/(kappa + 1) with kappa = 3 - 4 nu, under a rigid cylinder
      call scene%set('body(1)%poisson_ratio', (1.0_wp - 2.0_wp*row%beta)/(2.0_wp - 2.0_wp*row%beta))
      call scene%set('body(2)%shape', 'disk')
      call scene%set('body(2)%radius', 0.25_wp)
      call scene%set('body(2)%rigid', .true.)
      call scene%set('mesh%nodes', 75)
      call scene%set('friction%law', 'coulomb')
      call scene%set('friction%mu', row%friction)
      call scene%set('step(1)%normal_force', normal_force)
      call scene%set('step(2)%force_ratio', row%force_ratio)
      call scene%set('step(3)%force_ratio', -row%force_ratio)
      call scene%set('step(3)%cycles', 2)
      call scene%set('output%history', 'none')
   end subroutine describe

   !> The columns of a contact; NaN for those missing in a case that ended early.
   subroutine read_values(contact, values)
      use, intrinsic :: ieee_arithmetic, only: ieee_quiet_nan, ieee_value
      type(contact_type), intent(inout) :: contact
      real(wp), intent(out) :: values(:)
      type(error_type), allocatable :: error
      integer :: i

      do i = 1, size(values)
         call contact%get('observables/'//trim(columns(i)), values(i), error)
         if (allocated(error)) values(i) = ieee_value(values(i), ieee_quiet_nan)
      end do
   end subroutine read_values

   !> The table; the program stops at an invalid case.
   subroutine print_table(rows)
      type(row_type), intent(in) :: rows(:)
      integer :: i

      print '(*(a))', 'friction,force_ratio,dundurs_beta,outcome', (',', trim(columns(i)), i=1, size(columns))
      do i = 1, size(rows)
         if (allocated(rows(i)%fault)) error stop rows(i)%fault
         print '(3(f4.2, ","), a, *(:, ",", g0.8))', rows(i)%friction, rows(i)%force_ratio, rows(i)%beta, &
            status_outcome(rows(i)%status), rows(i)%values
      end do
   end subroutine print_table

end program openmp_study
