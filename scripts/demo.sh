#!/bin/sh
# Installs what is missing, builds MFV, solves examples/mindlin.nml and draws it. Safe to repeat.
. "$(dirname "$0")/common.sh"
install_missing
build_programs
python_environment report
mkdir -p "$root/build/demo"
cd "$root/build/demo"
say "solving examples/mindlin.nml"
"$root/build/release/bin/mfv_run" "$root/examples/mindlin.nml"
PYTHONPATH=$root/python "$venv/bin/python" -m mfv plot mindlin.h5 -o mindlin.png
say "result build/demo/mindlin.h5, picture build/demo/mindlin.png"
