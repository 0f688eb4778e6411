# Run SUITE, which must end by itself with a status other than 0, its output matching REGEX.
execute_process(COMMAND "${SUITE}" RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
message("${output}\nstatus: ${status}")
if(NOT status MATCHES "^[1-9][0-9]*$")
  message(FATAL_ERROR "the suite must end with a status other than 0")
endif()
if(NOT output MATCHES "${REGEX}")
  message(FATAL_ERROR "the output must match\n${REGEX}")
endif()
