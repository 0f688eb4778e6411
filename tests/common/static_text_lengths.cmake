# Fails where the library keeps lengths of texts in static memory. gfortran does so, in variables slen.N, wherever a function
# with a deferred-length character result is called, and two threads then mix up their texts. Variables: NM, LIBRARY.
if(NOT NM OR NOT EXISTS "${NM}")
  message(STATUS "skipped: there is no nm")
  return()
endif()
execute_process(COMMAND ${NM} ${LIBRARY} RESULT_VARIABLE code OUTPUT_VARIABLE symbols ERROR_VARIABLE symbols)
if(NOT code EQUAL 0 OR NOT symbols MATCHES "mfv_run")
  message(STATUS "skipped: nm finds no symbols in ${LIBRARY}")
  return()
endif()
string(REGEX MATCHALL " [bBdDsS] _?slen[.][^\n]*" found "${symbols}")
if(found)
  list(LENGTH found number)
  string(REGEX REPLACE " [bBdDsS] " " " found "${found}")
  message(FATAL_ERROR "${number} calls of functions with deferred-length texts:${found}; give the functions an explicit "
    "length, or make subroutines of them")
endif()
