!> Open the Fortran interface of HDF5 once in a process: each opening leaks about 60 kB of types. It is not closed, because a host
!> may also use HDF5.
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

   !> Open the interface and turn off error output of HDF5 in this thread.
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
