#!/bin/sh
# Installs what is missing and makes build/wheel/mfv_contact-*.whl: the Python package with the library, the programs and their dependencies,
# down to the C library. It works on machines without compilers and without these libraries, with a C library no older than here.
# The licence texts of these libraries go with it. Safe to repeat. Needs Linux (Debian or Ubuntu for the licence texts).
. "$(dirname "$0")/common.sh"
install_missing
python_environment wheel
fresh=$root/build/wheel.new
rm -rf "$fresh"
trap 'rm -rf "$fresh"' EXIT
mkdir -p "$fresh"
say "building the wheel"
log=$fresh/build.log
PATH=$venv/bin:$PATH
{ python -m pip wheel --disable-pip-version-check --no-deps --wheel-dir "$fresh/plain" "$root" &&
  python -m auditwheel repair --wheel-dir "$fresh/repaired" "$fresh"/plain/mfv_contact-*.whl &&
  python "$root/scripts/wheel_licences.py" "$fresh"/repaired/mfv_contact-*.whl "$fresh/wheel"; } >"$log" 2>&1 || { tail -n 40 "$log"; exit 1; }
rm -rf "$root/build/wheel"
mv "$fresh/wheel" "$root/build/wheel"
say "wheel build/wheel/$(basename "$root"/build/wheel/mfv_contact-*.whl)"
