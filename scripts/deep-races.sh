#!/bin/sh
# Races between threads, by valgrind's helgrind, which looks into libgfortran, HDF5, GSL, FFTW and OpenBLAS too: the test of threads
# of the C interface, and mfv_sweep with four threads that read matrix files and write results. GCC's OpenMP synchronises in a way
# that helgrind does not see: tests/checkers/openmp_by_pthreads.c takes its place.
. "$(dirname "$0")/common.sh"
packages="$packages valgrind"
install_missing
python_environment test
build release --target mfv_sweep --target test_threads
folder=$root/build/deep/races
rm -rf "$folder"
mkdir -p "$folder"
cd "$folder"
gcc -std=c11 -O1 -g -shared -fPIC -pthread "$root/tests/checkers/openmp_by_pthreads.c" -o openmp_by_pthreads.so
"$venv/bin/python" - <<'PYTHON'
import h5py
import numpy as np
x = np.linspace(-1.0, 1.0, 21)
with h5py.File("body.h5", "w") as file:
    file["x"] = x
    file["compliance"] = np.exp(-np.abs(x[:, None] - x[None, :]))  # positive definite
PYTHON
cat >base.nml <<'CASE'
&body shape='matrix', file='body.h5' /
&body shape='disk', radius=2.0, rigid=.true. /
&step normal_force=0.1 /
CASE
cat >study.nml <<'SWEEP'
&sweep base='base.nml', states='all' /
&vary key='step(1)%normal_force', from=0.01, to=0.1, count=20 /
SWEEP
export OPENBLAS_NUM_THREADS=1
helgrind="valgrind --quiet --tool=helgrind --history-level=approx --suppressions=$root/tests/checkers/helgrind.supp --error-exitcode=9"
say "mfv_sweep --threads 4"
LD_PRELOAD=$folder/openmp_by_pthreads.so $helgrind "$root/build/release/bin/mfv_sweep" --threads 4 study.nml ||
  { echo "helgrind: mfv_sweep ended with $?"; exit 1; }
say "test_threads"
$helgrind "$root/build/release/bin/test_threads" || { echo "helgrind: test_threads ended with $?"; exit 1; }
echo "helgrind: eight threads of the C interface and mfv_sweep --threads 4, no race"
