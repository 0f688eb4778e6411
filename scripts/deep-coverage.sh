#!/bin/sh
# Which lines of src/ and drivers/ the tests run, by folder; those that they do not run are listed before.
. "$(dirname "$0")/common.sh"
packages="$packages g++ pkgconf mandoc groff-base chromium"
install_missing
python_environment coverage
build coverage
cd "$root"
find build/coverage -name '*.gcda' -delete
# Left out: a static library that counts cannot be linked without gcov, valgrind is slow, and a user without rights cannot write the counts.
export PYTEST_ADDOPTS="--deselect tests/cli/test_bad_files.py::test_files_without_permission"
ctest --preset coverage --timeout 3600 -E '^(installed_tree|memcheck_.*)$' || { echo "coverage: a test failed"; exit 1; }
"$venv/bin/gcovr" --root . --object-directory build/coverage --filter src/ --filter drivers/ \
  --gcov-ignore-errors=no_working_dir_found --gcov-ignore-parse-errors=negative_hits.warn_once_per_file --json build/coverage/lines.json build/coverage/src build/coverage/drivers >/dev/null
"$venv/bin/python" scripts/coverage_by_folder.py build/coverage/lines.json
