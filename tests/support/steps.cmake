# For scripts that build and run things: commands that must go well.

# Run a command; its output is then in step_output.
function(step)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT code EQUAL 0)
    list(JOIN ARGV " " command)
    message(FATAL_ERROR "failed: ${command}\n${output}")
  endif()
  set(step_output "${output}" PARENT_SCOPE)
endfunction()

# A procedure that is passed as an argument from inside another makes its program's stack executable.
function(expect_no_executable_stack)
  foreach(file IN LISTS ARGV)
    step(${READELF} -lW ${file})
    if(NOT step_output MATCHES "GNU_STACK[^\n]* RW ")
      message(FATAL_ERROR "the stack of ${file} is executable, or it does not say:\n${step_output}")
    endif()
  endforeach()
endfunction()

# Compile and link `source` as pkg-config tells, with the libraries of `kind`, shared or static, of the tree in `tree`.
function(build_by_pkg_config compiler source kind program)
  set(ENV{PKG_CONFIG_PATH} ${tree}/${LIBDIR}/pkgconfig)
  step(${PKG_CONFIG} --cflags mfv)
  separate_arguments(compile UNIX_COMMAND "${step_output}")
  if(kind STREQUAL "static")
    step(${PKG_CONFIG} --static --libs mfv)
    string(REPLACE "-lmfv" "-l:libmfv.a" step_output "${step_output}")
  else()
    step(${PKG_CONFIG} --libs mfv)
  endif()
  separate_arguments(link UNIX_COMMAND "${step_output}")
  step(${compiler} ${compile} -DMFV_EXPECTED_VERSION="${VERSION}" ${source} -o ${program} ${link} -lm -Wl,-rpath,${tree}/${LIBDIR})
endfunction()
