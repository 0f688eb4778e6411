#!/bin/sh
# A program under valgrind's memcheck, which ends with 9 when there is an error or when memory is lost: memcheck.sh PROGRAM ARGUMENTS...
# (Valgrind knows no traps of floating-point numbers: those of the debug build do not fire under it.)
export OPENBLAS_NUM_THREADS=1
exec valgrind --quiet --leak-check=full --show-leak-kinds=definite,indirect,possible \
  --errors-for-leak-kinds=definite,indirect,possible --num-callers=30 --error-exitcode=9 "$@"
