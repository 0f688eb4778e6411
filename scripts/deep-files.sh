#!/bin/sh
# Files that are written: every call to the disk of every program fails in turn, or is where it is killed, and 50 kills at random
# moments of each of two programs; after each there must be the old file or the new one (tests/cli/test_files.py).
. "$(dirname "$0")/common.sh"
install_missing
python_environment test
build release
cd "$root"
MFV_DEEP=1 OPENBLAS_NUM_THREADS=1 MPLBACKEND=Agg PYTHONPATH=python MFV_LIBRARY=$root/build/release/lib/libmfv.so \
  MFV_RUN=$root/build/release/bin/mfv_run "$venv/bin/python" -m pytest -q -p no:cacheprovider tests/cli/test_files.py
