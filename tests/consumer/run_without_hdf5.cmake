# Builds MFV without HDF5 and without a shared library, installs it, builds and runs a program on it by find_package and by
# pkg-config, and runs a case with the installed mfv_run.
# Variables: SOURCE_DIR, WORK_DIR, VERSION, LIBDIR, C, Fortran (compilers), READELF, PKG_CONFIG.
include(${CMAKE_CURRENT_LIST_DIR}/../support/steps.cmake)
set(case ${SOURCE_DIR}/examples/mindlin.nml)
set(source ${SOURCE_DIR}/tests/api/test_without_hdf5.c)
set(tree ${WORK_DIR}/tree)

file(REMOVE_RECURSE ${WORK_DIR})
step(${CMAKE_COMMAND} -S ${SOURCE_DIR} -B ${WORK_DIR}/build -DMFV_HDF5=OFF -DBUILD_SHARED_LIBS=OFF -DBUILD_TESTING=OFF
  -DCMAKE_BUILD_TYPE=Debug -DCMAKE_INSTALL_LIBDIR=${LIBDIR} -DCMAKE_C_COMPILER=${C} -DCMAKE_Fortran_COMPILER=${Fortran})
step(${CMAKE_COMMAND} --build ${WORK_DIR}/build --parallel 2)
step(${CMAKE_COMMAND} --install ${WORK_DIR}/build --prefix ${tree})

step(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${WORK_DIR}/consumer -DLANGUAGE=C -DCMAKE_C_COMPILER=${C}
  -DSOURCE=${source} -DSTATIC_ONLY=ON -DCMAKE_PREFIX_PATH=${tree} -DEXPECTED_VERSION=${VERSION})
step(${CMAKE_COMMAND} --build ${WORK_DIR}/consumer)
build_by_pkg_config(${C} ${source} static ${WORK_DIR}/by_pkg_config)
foreach(program ${WORK_DIR}/consumer/consumer ${WORK_DIR}/by_pkg_config)
  step(${program} ${case})
  if(NOT step_output MATCHES "without HDF5: all checks passed\n")
    message(FATAL_ERROR "${program} prints ${step_output}")
  endif()
endforeach()

execute_process(COMMAND ${tree}/bin/mfv_run ${case} WORKING_DIRECTORY ${WORK_DIR} RESULT_VARIABLE code OUTPUT_VARIABLE output)
if(NOT code EQUAL 0 OR NOT output MATCHES "in contact 87, .*\nresult +not written: .*MFV_HDF5=OFF" OR EXISTS ${WORK_DIR}/mindlin.h5)
  message(FATAL_ERROR "mfv_run without HDF5 ends with ${code} and prints ${output}")
endif()
expect_no_executable_stack(${tree}/bin/mfv_run ${tree}/bin/mfv_conventional)
