# mfv_add_suite(NAME <name> SOURCES <file.pf> [LIBRARIES <targets...>] [LABELS <labels...>])
#
# Build the suite <file.pf> (a path from the current source folder) into the executable <name>, and register it as one
# test of ctest. It is built with pFUnit when find_package(PFUNIT) has found it, otherwise with the stand-in of
# tests/standin, whose folder must then be added to the build.

include_guard(GLOBAL)

function(mfv_add_suite)
  cmake_parse_arguments(PARSE_ARGV 0 arg "" "NAME;SOURCES" "LIBRARIES;LABELS")
  if(NOT arg_NAME OR NOT arg_SOURCES MATCHES "\\.pf$" OR arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "mfv_add_suite needs NAME and SOURCES with one .pf file; unknown arguments: "
                        "'${arg_UNPARSED_ARGUMENTS}'")
  endif()

  if(PFUNIT_FOUND)
    add_pfunit_ctest(${arg_NAME} TEST_SOURCES ${arg_SOURCES} LINK_LIBRARIES ${arg_LIBRARIES})
    # The driver includes the list of suites, which Makefiles do not see.
    set_property(SOURCE "${CMAKE_CURRENT_BINARY_DIR}/${arg_NAME}_driver.F90" APPEND
                 PROPERTY OBJECT_DEPENDS "${CMAKE_CURRENT_BINARY_DIR}/${arg_NAME}.inc")
    # pFUnit calls a suite without a test that ran "OK (0 test)".
    set_property(TEST ${arg_NAME} APPEND PROPERTY FAIL_REGULAR_EXPRESSION "\\(0 test")
  else()
    mfv_add_standin_executable(${arg_NAME} "${arg_SOURCES}" ${arg_LIBRARIES})
    add_test(NAME ${arg_NAME} COMMAND ${arg_NAME})
  endif()
  # Optimising takes longer than it saves: a suite runs once.
  target_compile_options(${arg_NAME} PRIVATE $<$<COMPILE_LANG_AND_ID:Fortran,GNU>:-O0>)
  set_tests_properties(${arg_NAME} PROPERTIES TIMEOUT 600 LABELS "${arg_LABELS}")
endfunction()

# Build the suite <source> with the stand-in into the executable <name>, linked to the further arguments.
function(mfv_add_standin_executable name source)
  find_package(Python3 REQUIRED COMPONENTS Interpreter)
  get_filename_component(script "${CMAKE_CURRENT_FUNCTION_LIST_DIR}/../tests/standin/pf_preprocess.py" ABSOLUTE)
  get_filename_component(input "${source}" ABSOLUTE)
  get_filename_component(stem "${source}" NAME_WE)
  set(output "${CMAKE_CURRENT_BINARY_DIR}/pf/${name}")
  file(MAKE_DIRECTORY "${output}/mod")

  add_custom_command(
    OUTPUT "${output}/${stem}.f90" "${output}/${stem}_driver.f90"
    COMMAND Python3::Interpreter "${script}" "${input}"
            --module "${output}/${stem}.f90" --driver "${output}/${stem}_driver.f90"
    DEPENDS "${input}" "${script}"
    COMMENT "Preprocessing ${source}"
    VERBATIM)
  add_executable(${name} "${output}/${stem}.f90" "${output}/${stem}_driver.f90")
  set_target_properties(${name} PROPERTIES Fortran_MODULE_DIRECTORY "${output}/mod")
  target_include_directories(${name} PRIVATE "${output}/mod")
  target_link_libraries(${name} PRIVATE mfv::funit ${ARGN})
endfunction()
