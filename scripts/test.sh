#!/bin/sh
# Installs what is missing, builds MFV and runs every test. Safe to repeat. Arguments: presets (release unless told).
. "$(dirname "$0")/common.sh"
install_missing
python_environment test
for preset in "${@:-release}"; do
  build "$preset"
  say "testing preset $preset"
  cd "$root"
  ctest --preset "$preset"
done
