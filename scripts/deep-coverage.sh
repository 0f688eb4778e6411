#!/bin/sh
# Which lines of src/ and drivers/ the tests run, by folder; those that they do not run are listed before.
. "$(dirname "$0")/common.sh"
packages="$packages openmpi-bin libopenmpi-dev g++ pkgconf mandoc groff-base chromium"
install_missing
python_environment coverage
build coverage
cd "$root"
find build/coverage -name '*.gcda' -delete
ctest --preset coverage --timeout 3600 || { echo "coverage: a test failed"; exit 1; }
"$venv/bin/gcovr" --root . --object-directory build/coverage --filter src/ --filter drivers/ \
  --gcov-ignore-errors=no_working_dir_found --gcov-ignore-parse-errors=negative_hits.warn_once_per_file --json build/coverage/lines.json build/coverage/src build/coverage/drivers >/dev/null
"$venv/bin/python" scripts/coverage_by_folder.py build/coverage/lines.json
