#!/bin/sh
# Races between threads, by valgrind's helgrind, which also checks libgfortran, GSL, FFTW and OpenBLAS: the test of threads of the
# C interface.
. "$(dirname "$0")/common.sh"
packages="$packages valgrind"
install_missing
build release --target test_threads
export OPENBLAS_NUM_THREADS=1
valgrind --quiet --tool=helgrind --history-level=approx --suppressions="$root/tests/checkers/helgrind.supp" --error-exitcode=9 \
  "$root/build/release/bin/test_threads" || { echo "helgrind: test_threads ended with $?"; exit 1; }
echo "helgrind: eight threads of the C interface, no race"
