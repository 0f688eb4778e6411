# MFV_ARCHIVES: what the static library is linked with in the programs of this build: HDF5, GSL and FFTW as static libraries. Empty if
# these are not installed or cannot be linked; the programs then use shared libraries. Debian's shared HDF5 loads some 35 further
# libraries (curl, Kerberos, LDAP), which takes 7 ms at every start; they serve parts of HDF5 that the programs do not use. OpenBLAS,
# which adds 26 MB and saves 1 ms, is static in mfv_run only.
include(CheckSourceCompiles)

# The archives beside the shared libraries. OpenBLAS precedes GSL's own CBLAS, as it does with shared libraries.
set(MFV_ARCHIVES)
set(lapack ${LAPACK_LIBRARIES} ${BLAS_LIBRARIES})
foreach(library ${HDF5Fortran_LIBRARIES} ${GSL_LIBRARY} ${FFTW3_LIBRARY} ${lapack} ${GSL_CBLAS_LIBRARY})
  string(REGEX REPLACE "(/libopenblas)\\.[a-z]+$" "\\1.a" openblas "${library}")
  if(library IN_LIST lapack AND EXISTS ${openblas})
    list(APPEND MFV_ARCHIVES ${openblas})
  elseif(library IN_LIST lapack)
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

# What these programs are linked with besides.
set(MFV_ARCHIVES_OPTIONS)
if(CMAKE_Fortran_COMPILER_ID STREQUAL "GNU")
  list(APPEND MFV_ARCHIVES_OPTIONS -static-libgfortran)
endif()
if(CMAKE_SYSTEM_NAME STREQUAL "Linux")
  # The programs look for it by name.
  list(APPEND MFV_ARCHIVES_OPTIONS LINKER:--export-dynamic-symbol=openblas_set_num_threads)
endif()

# A program that uses all of them.
if(MFV_HDF5)
  set(hdf5_module "use h5ds, only: h5dsset_scale_f\nuse hdf5, only: h5open_f, hid_t")
  set(hdf5_call "call h5open_f(i)\ncall h5dsset_scale_f(0_hid_t, i)")
endif()
set(CMAKE_REQUIRED_INCLUDES ${HDF5Fortran_INCLUDE_DIRS})
set(CMAKE_REQUIRED_LIBRARIES ${MFV_ARCHIVES})
set(CMAKE_REQUIRED_LINK_OPTIONS ${MFV_ARCHIVES_OPTIONS})
check_source_compiles(Fortran "program archives
    ${hdf5_module}
    interface
      subroutine fftw_cleanup() bind(C)
      end subroutine
      subroutine gsl_blas_dnrm2() bind(C)
      end subroutine
    end interface
    integer :: i
    call fftw_cleanup()
    call gsl_blas_dnrm2()
    ${hdf5_call}
  end program" MFV_ARCHIVES_WORK SRC_EXT f90)
unset(CMAKE_REQUIRED_INCLUDES)
unset(CMAKE_REQUIRED_LIBRARIES)
unset(CMAKE_REQUIRED_LINK_OPTIONS)
if(NOT MFV_ARCHIVES_WORK)
  set(MFV_ARCHIVES)
endif()
list(TRANSFORM MFV_ARCHIVES REPLACE "^(.*/libopenblas)\\.a$"
  "$<IF:$<STREQUAL:$<TARGET_PROPERTY:NAME>,mfv_run>,\\1.a,\\1${CMAKE_SHARED_LIBRARY_SUFFIX}>")
