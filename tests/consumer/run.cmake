# Installs the build into a fresh tree, builds the consumer against that tree and runs it; the installed mfv_run too.
# Variables: BUILD_DIR, SOURCE_DIR, WORK_DIR, VERSION.
function(step)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "failed: ${ARGV}\n${output}")
  endif()
endfunction()

file(REMOVE_RECURSE ${WORK_DIR})
step(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${WORK_DIR}/tree)
step(${CMAKE_COMMAND} -S ${SOURCE_DIR}/tests/consumer -B ${WORK_DIR}/build -DCMAKE_PREFIX_PATH=${WORK_DIR}/tree
     -DEXPECTED_VERSION=${VERSION})
step(${CMAKE_COMMAND} --build ${WORK_DIR}/build)
step(${WORK_DIR}/build/consumer ${SOURCE_DIR}/examples/mindlin.nml ${WORK_DIR}/mindlin.h5)
step(${WORK_DIR}/tree/bin/mfv_run --check ${SOURCE_DIR}/examples/mindlin.nml)
