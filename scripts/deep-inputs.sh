#!/bin/sh
# Valid cases are accepted (tests/cli/test_bad_input.py), including values that take seconds each.
. "$(dirname "$0")/common.sh"
install_missing
python_environment test
build release
cd "$root"
MFV_DEEP=1 sh scripts/pytest tests/cli/test_bad_input.py -k what_is_right
