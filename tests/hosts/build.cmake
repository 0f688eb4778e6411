# Copies examples/hosts, as a user would, and builds the copy with the installed tree of consumer/run.cmake.
# Variables: SOURCE_DIR, TREE, WORK_DIR, C, Fortran (compilers).
file(REMOVE_RECURSE ${WORK_DIR})
file(COPY ${SOURCE_DIR}/examples/hosts DESTINATION ${WORK_DIR})
execute_process(COMMAND_ERROR_IS_FATAL ANY COMMAND ${CMAKE_COMMAND} -S ${WORK_DIR}/hosts -B ${WORK_DIR}/build
  -DCMAKE_PREFIX_PATH=${TREE} -DCMAKE_C_COMPILER=${C} -DCMAKE_Fortran_COMPILER=${Fortran}
  "-DCMAKE_C_FLAGS=-Wall -Wextra -Werror -std=c99 -pedantic" "-DCMAKE_Fortran_FLAGS=-Wall -Wextra -Werror -std=f2018")
execute_process(COMMAND_ERROR_IS_FATAL ANY COMMAND ${CMAKE_COMMAND} --build ${WORK_DIR}/build --parallel 2)
