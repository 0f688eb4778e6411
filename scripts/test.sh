#!/bin/sh
# Installs what is missing, builds MFV and runs the tests. Safe to repeat.
#   sh scripts/test.sh [PRESET ...] [-R NAME | other options of ctest]
# Presets: release by default. -R NAME runs the tests whose names match NAME ("sh scripts/test.sh -R test_hertz"); -N lists them.
. "$(dirname "$0")/common.sh"
presets=
while [ $# -gt 0 ]; do
  case $1 in -*) break ;; esac
  presets="$presets $1"
  shift
done
# Tests of studies with MPI, and of users' programs in C++ and by pkg-config.
packages="$packages openmpi-bin libopenmpi-dev g++ pkgconf"
# Tests of the manual pages, with both programs that show them.
packages="$packages mandoc groff-base"
# Tests of the C interface under valgrind.
packages="$packages valgrind"
# Tests of the pages of mfv report in a browser.
packages="$packages chromium"
install_missing
python_environment test
for preset in ${presets:-release}; do
  build "$preset"
  say "testing preset $preset"
  cd "$root"
  ctest --preset "$preset" --parallel "$jobs" "$@"
done
