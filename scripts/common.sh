# shellcheck shell=sh
# Shared by the scripts: what the project needs, how to get it, how to build. Sourced, not run.
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
venv=$root/build/venv
jobs=$(nproc 2>/dev/null || echo 2)

say() { printf '== %s\n' "$*"; }

# Debian packages: compilers, build tools, and the libraries that MFV depends on.
packages='gfortran gcc make cmake libopenblas-dev liblapack-dev libgsl-dev libfftw3-dev libhdf5-dev'

# Install missing packages on Debian and Ubuntu; elsewhere, or without root rights, name them and continue.
install_missing() {
  missing=
  if command -v dpkg-query >/dev/null 2>&1; then
    for package in $packages; do
      dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing="$missing $package"
    done
    python3 -c 'import venv, ensurepip' 2>/dev/null || missing="$missing python3 python3-venv"
  else
    for program in gfortran gcc make cmake python3; do
      command -v "$program" >/dev/null 2>&1 || missing="$missing $program"
    done
  fi
  [ -n "$missing" ] || return 0
  as_root=
  [ "$(id -u)" -eq 0 ] || as_root=sudo
  if command -v apt-get >/dev/null 2>&1 && { [ -z "$as_root" ] || sudo -n true 2>/dev/null || [ -t 0 ]; }; then
    say "installing:$missing"
    $as_root apt-get update -qq
    # shellcheck disable=SC2086
    $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing >/dev/null
  else
    say "missing:$missing"
    say "install them with your system's package manager (gfortran >= 11, CMake >= 3.21, LAPACK, GSL, FFTW, HDF5 with"
    say "Fortran, Python >= 3.9); on Debian or Ubuntu: apt-get install$missing. Going on with what is there."
  fi
}

# Python environment of the project, in build/venv: the dependencies of the package, which runs from the source tree, and its
# commands, so that build/venv/bin is all that a user puts on the path. $1: extra of pyproject.toml to install.
python_environment() {
  stamp=$venv/done-$1
  [ "$stamp" -nt "$root/pyproject.toml" ] && return 0
  say "Python packages ($1) in build/venv"
  [ -x "$venv/bin/python" ] || python3 -m venv "$venv"
  "$venv/bin/python" "$root/scripts/commands.py" "$root/build/release/bin"
  "$venv/bin/python" "$root/scripts/requirements.py" "$1" >"$venv/requirements.txt"
  "$venv/bin/python" -m pip install --quiet --disable-pip-version-check -r "$venv/requirements.txt" || return 1
  touch "$stamp"
}

# Configure and build one preset. $1: its name; further arguments: options of the build, such as --target mfv_run.
build() {
  log=build/$1/build.log
  say "building preset $1: takes up to a few minutes; log: $log"
  cd "$root"
  mkdir -p "build/$1"
  { cmake --preset "$1" && cmake --build --preset "$@" --parallel "$jobs"; } >"$log" 2>&1 || { tail -n 40 "$log"; return 1; }
}

# Build what a user needs, all that cmake --install takes: programs and libraries, not the tests.
build_programs() { build release --target mfv mfv_static mfv_run mfv_stress mfv_conventional; }
