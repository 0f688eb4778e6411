!> Before the first call of HDF5. Its Fortran interface makes its types anew each time that it is opened, some 60 kB, and never
!> gives them back: it is opened once in a process. (It is not closed: a host may use HDF5 too.)
module mfv_hdf5_start
   use hdf5, only: h5eset_auto_f, h5open_f
   implicit none
   private
   public :: start_hdf5

   interface
      subroutine open_hdf5_once() bind(C, name='mfv_open_hdf5_once')
      end subroutine open_hdf5_once
   end interface

contains

   !> Have the interface open, and HDF5 print nothing in this thread.
   subroutine start_hdf5()
      integer :: code

      call open_hdf5_once()
      call h5eset_auto_f(0, code)
   end subroutine start_hdf5

   subroutine open_hdf5() bind(C, name='mfv_open_hdf5')
      integer :: code

      call h5open_f(code)
   end subroutine open_hdf5

end module mfv_hdf5_start
