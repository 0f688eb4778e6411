#!/bin/sh
# Rough surfaces and surfaces that repeat: 30 surfaces of 2,048 points against every event, 100 against dense matrices.
. "$(dirname "$0")/common.sh"
install_missing
python_environment test
build release
cd "$root"
MFV_DEEP=1 OPENBLAS_NUM_THREADS=1 MPLBACKEND=Agg PYTHONPATH=python MFV_LIBRARY=$root/build/release/lib/libmfv.so \
  MFV_RUN=$root/build/release/bin/mfv_run "$venv/bin/python" -m pytest -q -p no:cacheprovider tests/python/test_surfaces.py tests/python/test_periodic.py
