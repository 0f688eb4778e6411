#!/bin/sh
# Random scenes against the truth of every number (tests/truth): 10,000, in as many processes as there are cores.
# Environment: MFV_TRUTH_SCENES, MFV_TRUTH_SEED (of the first), MFV_TRUTH_PROCESSES, MFV_TRUTH_SHRINK (findings to shrink).
. "$(dirname "$0")/common.sh"
install_missing
python_environment test
build release
cd "$root"
OPENBLAS_NUM_THREADS=1 PYTHONPATH=python:tests MFV_LIBRARY=$root/build/release/lib/libmfv.so MFV_RUN=$root/build/release/bin/mfv_run \
  "$venv/bin/python" -m truth --scenes "${MFV_TRUTH_SCENES:-10000}" --seed "${MFV_TRUTH_SEED:-0}" \
  --processes "${MFV_TRUTH_PROCESSES:-$jobs}" --shrink "${MFV_TRUTH_SHRINK:-20}" --folder "$root/build/deep/truth"
