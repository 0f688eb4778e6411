#!/bin/sh
# The whole suite with the address, leak and undefined-behaviour sanitizers, including Python and the programs that it starts.
. "$(dirname "$0")/common.sh"
install_missing
python_environment test
build sanitize
cd "$root"
rm -f build/sanitize/finding.*
ended=0
ctest --preset sanitize --timeout 3600 || ended=$?
# Tests check the output of their processes; the reports of all processes are checked here.
find build/sanitize -maxdepth 1 -name 'finding.*' -exec "$venv/bin/python" tests/checkers/findings.py {} + || ended=1
[ $ended = 0 ] || { echo "sanitizers: a test failed, or something was found"; exit 1; }
echo "address, leak and undefined-behaviour sanitizers: $(ctest --preset sanitize -N | sed -n 's/^Total Tests: //p') tests, nothing found"
