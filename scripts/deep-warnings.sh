#!/bin/sh
# Warnings of uninitialised variables at -O0 and at -O2. The builds disable them, since gfortran also gives them for the bounds of
# allocatables; all others are failures.
. "$(dirname "$0")/common.sh"
install_missing
found=0
for optimisation in 0 2; do
  folder=$root/build/warnings-O$optimisation
  log=$folder/build.log
  say "compiling at -O$optimisation"
  cmake -S "$root" -B "$folder" -DCMAKE_BUILD_TYPE=None -DBUILD_TESTING=OFF -DMFV_UNHEARD_WARNINGS= \
    -DCMAKE_Fortran_FLAGS="-O$optimisation" >/dev/null
  LC_ALL=C cmake --build "$folder" --parallel "$jobs" --clean-first >"$log" 2>&1 || { tail -n 40 "$log"; echo "does not compile"; exit 1; }
  # Bounds: place.dim[0].lbound, place.offset, place.span.
  if grep 'Warning:\|warning:' "$log" | grep -v "\.dim\[[0-9]*\]\.[a-z]*'\|\.offset'"; then found=1; fi
done
[ $found = 0 ] || { echo "warnings of uninitialised variables: see above"; exit 1; }
echo "warnings of uninitialised variables at -O0 and -O2: none but those of bounds of allocatables"
