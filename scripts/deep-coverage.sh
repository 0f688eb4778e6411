#!/bin/sh
# Line coverage of src/ and drivers/ by the tests, by folder, after a list of the uncovered lines.
. "$(dirname "$0")/common.sh"
packages="$packages g++ pkgconf mandoc groff-base chromium"
install_missing
python_environment coverage
build coverage
cd "$root"
find build/coverage -name '*.gcda' -delete
# Excluded: a static library with coverage needs gcov to link, valgrind is slow, and an unprivileged user cannot write the counts.
export PYTEST_ADDOPTS="--deselect tests/cli/test_bad_files.py::test_files_without_permission"
ctest --preset coverage --timeout 3600 -E '^(installed_tree|memcheck_.*)$' || { echo "coverage: a test failed"; exit 1; }
"$venv/bin/gcovr" --root . --object-directory build/coverage --filter src/ --filter drivers/ \
  --gcov-ignore-errors=no_working_dir_found --gcov-ignore-parse-errors=negative_hits.warn_once_per_file \
  --json build/coverage/lines.json build/coverage/src build/coverage/drivers >/dev/null
"$venv/bin/python" scripts/coverage_by_folder.py build/coverage/lines.json
