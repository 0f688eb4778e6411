#!/bin/sh
# 100,000 cases of tests/fuzz/run.py with sanitizers: readers of cases, columns, matrix files and results.
. "$(dirname "$0")/common.sh"
install_missing
python_environment test
build sanitize --target fuzz_target --target mfv_run
cd "$root"
"$venv/bin/python" tests/fuzz/run.py --found
"$venv/bin/python" tests/fuzz/run.py --cases "${MFV_FUZZ_CASES:-100000}" --seed "${MFV_FUZZ_SEED:-1}"
