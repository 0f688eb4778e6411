#!/bin/sh
# Valid cases are accepted (tests/cli/test_bad_input.py), including values that take seconds each.
. "$(dirname "$0")/common.sh"
install_missing
python_environment test
build release
cd "$root"
MFV_DEEP=1 OPENBLAS_NUM_THREADS=1 MPLBACKEND=Agg PYTHONPATH=python MFV_LIBRARY=$root/build/release/lib/libmfv.so \
  MFV_RUN=$root/build/release/bin/mfv_run "$venv/bin/python" -m pytest -q -p no:cacheprovider tests/cli/test_bad_input.py -k what_is_right
