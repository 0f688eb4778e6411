# mfv_compile_options(target): the language standard, warnings, and what MFV_STRICT asks for.
# -frecursive keeps local variables of every size off static memory: two threads may be in one procedure (for which reason
# the check of recursion, a static flag, is left out).
# -Wno-unused-dummy-argument: a procedure that fills in an interface need not use all of it.
# -Wno-uninitialized: gfortran takes the reallocation of an allocatable on assignment for a use of it.
function(mfv_compile_options target)
  set(gnu_fortran $<COMPILE_LANG_AND_ID:Fortran,GNU>)
  target_compile_options(${target} PRIVATE
    $<${gnu_fortran}:-std=f2018 -frecursive -fimplicit-none -Wall -Wextra -Wno-c-binding-type -Wno-unused-dummy-argument
      -Wno-uninitialized -Wno-maybe-uninitialized>)
  if(MFV_STRICT)
    target_compile_options(${target} PRIVATE
      $<${gnu_fortran}:-Werror -fcheck=all,no-array-temps,no-recursion -fbacktrace -ffpe-trap=invalid,zero,overflow>
      $<$<COMPILE_LANG_AND_ID:C,GNU>:-Wall -Wextra -Werror>)
  endif()
endfunction()

# Sanitizers: everything must be linked with them, the tests too.
if(MFV_SANITIZE)
  add_compile_options(-fsanitize=${MFV_SANITIZE} -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${MFV_SANITIZE})
endif()
