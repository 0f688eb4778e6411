# MFV_ARCHIVES: what the static library is linked with in the programs of this build: HDF5, GSL and FFTW as static libraries. Empty if
# these are not installed or cannot be linked; the programs then use shared libraries. Debian's shared HDF5 loads some 35 further
# libraries (curl, Kerberos, LDAP), which takes 7 ms at every start; they serve parts of HDF5 that the programs do not use.
#
# MFV_OPENBLAS_OPTIONS: the options with which mfv_run is linked if OpenBLAS and gfortran's library are static in it too, which adds
# 26 MB and saves 1 ms, and in an optimised build the C library, which saves 0.7 ms; else empty.
include(CheckSourceRuns)

# The archives beside the shared libraries. OpenBLAS precedes GSL's own CBLAS, as it does with shared libraries.
set(MFV_ARCHIVES)
set(lapack ${LAPACK_LIBRARIES} ${BLAS_LIBRARIES})
foreach(library ${HDF5Fortran_LIBRARIES} ${GSL_LIBRARY} ${FFTW3_LIBRARY} ${lapack} ${GSL_CBLAS_LIBRARY})
  if(library IN_LIST lapack)
    list(APPEND MFV_ARCHIVES ${library})
  elseif(library MATCHES "^(.*/lib)(hdf5[a-z_]*|sz|z|gsl|fftw3|gslcblas)\\.[a-z]+$")
    list(APPEND MFV_ARCHIVES ${CMAKE_MATCH_1}${CMAKE_MATCH_2}.a)
    # libsz may be a part of libaec.
    if(CMAKE_MATCH_2 STREQUAL "sz" AND EXISTS ${CMAKE_MATCH_1}aec.a)
      list(APPEND MFV_ARCHIVES ${CMAKE_MATCH_1}aec.a)
    endif()
  endif()
endforeach()
list(REMOVE_DUPLICATES MFV_ARCHIVES)
list(APPEND MFV_ARCHIVES ${CMAKE_DL_LIBS} m)

# `result`: whether a program that uses all of some libraries (further arguments) can be linked with the `options`, and starts.
function(mfv_check_archives result options)
  if(MFV_HDF5)
    set(hdf5_module "use h5ds, only: h5dsset_scale_f\nuse hdf5, only: h5open_f, hid_t")
    set(hdf5_call "call h5open_f(i)\ncall h5dsset_scale_f(0_hid_t, i)")
  endif()
  set(CMAKE_REQUIRED_INCLUDES ${HDF5Fortran_INCLUDE_DIRS})
  set(CMAKE_REQUIRED_LIBRARIES ${ARGN})
  set(CMAKE_REQUIRED_LINK_OPTIONS ${options})
  check_source_runs(Fortran "program archives
      ${hdf5_module}
      interface
        subroutine fftw_cleanup() bind(C)
        end subroutine
        subroutine gsl_blas_dnrm2() bind(C)
        end subroutine
      end interface
      integer :: i
      if (command_argument_count() == 0) stop
      call fftw_cleanup()
      call gsl_blas_dnrm2()
      ${hdf5_call}
    end program" ${result} SRC_EXT f90)
endfunction()

mfv_check_archives(MFV_ARCHIVES_WORK "" ${MFV_ARCHIVES})
if(NOT MFV_ARCHIVES_WORK)
  set(MFV_ARCHIVES)
endif()

# OpenBLAS beside the shared library.
set(MFV_OPENBLAS_OPTIONS)
list(FILTER lapack INCLUDE REGEX "/libopenblas\\${CMAKE_SHARED_LIBRARY_SUFFIX}$")
list(REMOVE_DUPLICATES lapack)
string(REGEX REPLACE "\\${CMAKE_SHARED_LIBRARY_SUFFIX}$" ".a" openblas "${lapack}")
if(MFV_ARCHIVES AND lapack AND EXISTS "${openblas}" AND CMAKE_Fortran_COMPILER_ID STREQUAL "GNU")
  string(REPLACE "${lapack}" "${openblas}" archives "${MFV_ARCHIVES}")
  mfv_check_archives(MFV_STATIC_OPENBLAS_WORKS -static-libgfortran ${archives})
  if(MFV_STATIC_OPENBLAS_WORKS)
    set(MFV_OPENBLAS_OPTIONS -static-libgfortran)
    # Tests replace calls of the C library in the strict build, and sanitizers everywhere. The linker would warn of dlopen, with which
    # HDF5 looks for filters that MFV does not use.
    set(options -static -Wl,--no-warnings)
    if(NOT MFV_STRICT AND NOT MFV_SANITIZE)
      mfv_check_archives(MFV_STATIC_C_WORKS "${options}" ${archives})
      if(MFV_STATIC_C_WORKS)
        set(MFV_OPENBLAS_OPTIONS ${options})
      endif()
    endif()
    string(REPLACE "${lapack}" "$<IF:$<STREQUAL:$<TARGET_PROPERTY:NAME>,mfv_run>,${openblas},${lapack}>" MFV_ARCHIVES "${MFV_ARCHIVES}")
  endif()
endif()
