#!/bin/sh
# All tests with every run-time check (bounds, floating-point traps), warnings as errors: the preset debug.
. "$(dirname "$0")/common.sh"
sh "$root/scripts/test.sh" debug
echo "all tests of the preset debug pass"
