# mfv_compile_options(target [traps]): the language standard, warnings, and what MFV_STRICT asks for. Traps of floating-point
# numbers in a program: by default invalid,zero,overflow.
# -frecursive keeps local variables of every size off static memory: two threads may be in one procedure (for which reason
# the check of recursion, a static flag, is omitted).
# -Wno-c-binding-type: HDF5's own kind of its identifiers is not named in iso_c_binding.
# -Wno-unused-dummy-argument: a procedure that fills in an interface need not use all of it.
# MFV_UNHEARD_WARNINGS: gfortran takes the reallocation of an allocatable on assignment for a use of its bounds.
# scripts/deep-warnings.sh checks them, except those about bounds.
set(MFV_UNHEARD_WARNINGS "-Wno-uninitialized;-Wno-maybe-uninitialized" CACHE STRING "Options that turn warnings of gfortran off")
mark_as_advanced(MFV_UNHEARD_WARNINGS)
function(mfv_compile_options target)
  set(gnu_fortran $<COMPILE_LANG_AND_ID:Fortran,GNU>)
  set(traps invalid,zero,overflow)
  if(ARGC GREATER 1)
    set(traps ${ARGV1})
  endif()
  set(gnu_c $<COMPILE_LANG_AND_ID:C,GNU>)
  target_compile_options(${target} PRIVATE
    $<${gnu_fortran}:-std=f2018 -frecursive -fimplicit-none -Wall -Wextra -Wcharacter-truncation
      -Wno-c-binding-type -Wno-unused-dummy-argument ${MFV_UNHEARD_WARNINGS}>
    $<${gnu_c}:-std=gnu11 -Wall -Wextra -Wconversion -Wshadow -Wstrict-prototypes>)
  # Users of the library are rebuilt when its modules change. (Ninja detects this itself.)
  if(CMAKE_GENERATOR MATCHES "Makefiles" AND NOT target MATCHES "^mfv_folder_|quadruple|interior_equations")
    get_target_property(sources ${target} SOURCES)
    list(FILTER sources INCLUDE REGEX "\\.f90$")
    get_property(modules GLOBAL PROPERTY MFV_MODULE_FILES)
    set_property(SOURCE ${sources} APPEND PROPERTY OBJECT_DEPENDS ${modules})
  endif()
  if(MFV_STRICT)
    target_compile_options(${target} PRIVATE
      $<${gnu_fortran}:-Werror -fcheck=all,no-array-temps,no-recursion -fbacktrace -ffpe-trap=${traps}>
      $<${gnu_c}:-Werror>)
  endif()
endfunction()

# Sanitizers: everything must be linked with them, including the tests. A finding ends the program. Integer overflows in Fortran are
# not checked: gfortran's code for reallocation on assignment causes them, from bounds of unallocated arrays, and reports them on
# standard error regardless of UBSAN_OPTIONS, where tests expect messages.
if(MFV_SANITIZE)
  add_compile_options(-fsanitize=${MFV_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer
    $<$<COMPILE_LANGUAGE:Fortran>:-fno-sanitize=signed-integer-overflow>)
  add_link_options(-fsanitize=${MFV_SANITIZE})
endif()
