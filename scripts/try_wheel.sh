#!/bin/sh
# Installs the wheel of scripts/wheel.sh into empty environments, one for each interpreter named, and imports it, solves and draws a
# case there: sh scripts/try_wheel.sh python3.9 python3.13. By default every python3.9 to python3.13 that is found.
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
wheel=$(ls "$root"/build/wheel/mfv_contact-*.whl)
[ $# -gt 0 ] || set -- python3.9 python3.10 python3.11 python3.12 python3.13
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
tried=0
for python in "$@"; do
  "$python" -c 'import venv, ensurepip' 2>/dev/null || { echo "$python: not found"; continue; }
  rm -rf "$folder/venv" "$folder/work"
  "$python" -m venv "$folder/venv"
  mkdir "$folder/work"
  cd "$folder/work"
  "$folder/venv/bin/python" -m pip install --quiet --disable-pip-version-check "$wheel"
  env -i PATH="$folder/venv/bin:/usr/bin:/bin" HOME="$folder" MPLBACKEND=Agg sh -euc '
    mfv new >/dev/null
    mfv run cylinder.nml >summary.txt
    mfv plot cylinder.h5 >/dev/null
    python -c "import mfv; result = mfv.read(\"cylinder.h5\"); assert result.certificate.largest < 1e-10"
    ls ./*.png >/dev/null'
  "$folder/venv/bin/python" -c '
import platform, numpy
print(f"Python {platform.python_version()}, numpy {numpy.__version__}: installed, imported, solved and drew a case")'
  tried=$((tried + 1))
done
[ "$tried" -gt 0 ]
