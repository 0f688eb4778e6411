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
# The studies of the Python package are tested with MPI too. Users' programs are built in C++ and by pkg-config too.
packages="$packages openmpi-bin libopenmpi-dev g++ pkgconf"
# The manual pages are looked at by both programs that show such pages.
packages="$packages mandoc groff-base"
# The tests of the C interface run under valgrind too.
packages="$packages valgrind"
# Pages of python -m mfv report are looked at in chromium.
packages="$packages chromium"
install_missing
python_environment test
for preset in ${presets:-release}; do
  build "$preset"
  say "testing preset $preset"
  cd "$root"
  ctest --preset "$preset" --parallel "$jobs" "$@"
done
