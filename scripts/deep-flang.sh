#!/bin/sh
# The library, mfv_run and mfv_conventional by LLVM's Fortran compiler, without HDF5, whose modules are gfortran's: the tests of the
# C interface, and the summaries of the examples, which must be those of gfortran's build in all six digits.
. "$(dirname "$0")/common.sh"
flang=$(apt-cache pkgnames flang- 2>/dev/null | grep -E '^flang-[0-9]+$' | sort -V | tail -n 1)
[ -n "$flang" ] || flang='flang-19'
packages="$packages $flang"
install_missing
version=${flang#flang-}
compiler=$(command -v "flang-new-$version" || command -v "flang-$version" || command -v flang-new) ||
  { echo "there is no flang"; exit 1; }
build release --target mfv_run
folder=$root/build/flang
say "building with $compiler in build/flang"
cmake -S "$root" -B "$folder" -DCMAKE_BUILD_TYPE=Release -DCMAKE_Fortran_COMPILER="$compiler" -DMFV_HDF5=OFF >/dev/null
cmake --build "$folder" --parallel "$jobs" --target mfv_run mfv_conventional test_c_api test_embedding test_threads
export OPENBLAS_NUM_THREADS=1
"$folder/bin/test_c_api" "$root/examples/mindlin.nml"
"$folder/bin/test_embedding"
"$folder/bin/test_threads"

# A summary without times and file names. $1: build; $2: case.
summary() {
  "$root/build/$1/bin/mfv_run" "$2" |
    sed -n -E 's/, ([^,]* s|tractions change by .*)$//; /^(outcome|contact|nodes|stick|normal|tangential|dissipation|last|work)/p'
}
work=$folder/examples
rm -rf "$work"
mkdir -p "$work"
cp "$root"/examples/*.nml "$root"/examples/*.txt "$work"
cd "$work"
count=0
for case in *.nml; do
  ! grep -q '^&sweep' "$case" || continue
  summary flang "$case" >"$case.flang"
  summary release "$case" >"$case.gfortran"
  diff "$case.gfortran" "$case.flang" || { echo "flang: $case ends otherwise than with gfortran"; exit 1; }
  count=$((count + 1))
done
echo "$(basename "$compiler"): the C interface passes its tests, $count examples give the summaries of gfortran's build"
