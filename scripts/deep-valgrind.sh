#!/bin/sh
# Memcheck over the tests of the interfaces: no errors, no leaks. (Two of them are in the suite of the debug preset.)
. "$(dirname "$0")/common.sh"
packages="$packages valgrind"
install_missing
tests='test_c_api test_embedding test_threads test_kept_state test_tangent'
# shellcheck disable=SC2086
build debug --target $tests
cd "$root/build/debug"
count=0
for test in $tests; do
  say "$test"
  if [ "$test" = test_c_api ]; then set -- "$root/examples/mindlin.nml" memcheck.h5; else set --; fi
  sh "$root/tests/checkers/memcheck.sh" "bin/$test" "$@" || { echo "memcheck: $test ended with $?"; exit 1; }
  count=$((count + 1))
done
echo "memcheck: $count programs of the interfaces, no error, nothing lost"
