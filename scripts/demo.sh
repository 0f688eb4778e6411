#!/bin/sh
# Installs what is missing, builds MFV, solves examples/mindlin.nml and draws it. Safe to repeat.
. "$(dirname "$0")/common.sh"
install_missing
build_programs
python_environment report
for extra in study joint identify fatigue; do
  python_environment "$extra" || say "continuing without the Python packages of $extra"
done
mkdir -p "$root/build/demo"
cd "$root/build/demo"
say "solving examples/mindlin.nml"
PATH=$venv/bin:$PATH
mfv run "$root/examples/mindlin.nml"
mfv plot mindlin.h5
say "result build/demo/mindlin.h5, picture build/demo/mindlin.png; in each new terminal type"
say "export PATH=\"$venv/bin:\$PATH\""
