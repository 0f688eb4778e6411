#!/bin/sh
# Rough surfaces and surfaces that repeat: 30 surfaces of 2,048 points against every event, 100 against dense matrices.
. "$(dirname "$0")/common.sh"
install_missing
python_environment test
build release
cd "$root"
MFV_DEEP=1 sh scripts/pytest tests/python/test_surfaces.py tests/python/test_periodic.py
