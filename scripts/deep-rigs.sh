#!/bin/sh
# Loops with the defects of rigs against mfv.identify: prints the table of docs/verification.md.
# Environment: MFV_RIGS_SEEDS (sets of noise for each defect, by default 100).
. "$(dirname "$0")/common.sh"
install_missing
python_environment test
build release
cd "$root"
OPENBLAS_NUM_THREADS=1 PYTHONPATH=python MFV_LIBRARY=$root/build/release/lib/libmfv.so \
  "$venv/bin/python" tests/python/rig_defects.py --seeds "${MFV_RIGS_SEEDS:-100}"
