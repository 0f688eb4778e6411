#!/bin/sh
# Output files: 50 kills at random times of each of two programs, with the other tests of tests/cli/test_files.py;
# after each the old or the new file must be complete.
. "$(dirname "$0")/common.sh"
install_missing
python_environment test
build release
cd "$root"
MFV_DEEP=1 sh scripts/pytest tests/cli/test_files.py
