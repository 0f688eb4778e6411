#!/bin/sh
# Checks the sources without running them: formatting, spelling, wording, types, shell scripts, licences. Prints what to fix and
# exits with 1 if anything is found. Part of the tests (ctest entry "lint"). Argument: names of checks; all by default.
. "$(dirname "$0")/common.sh"
python_environment test
cd "$root"
bin=$venv/bin
failed=

# Run one check. $1: its name; what follows: the command.
check() {
  name=$1
  shift
  case " $chosen " in *" $name "*) ;; *) return 0 ;; esac
  if output=$("$@" 2>&1); then say "$name: ok"; else
    say "$name: FAILED"
    printf '%s\n' "$output" | tail -n 60
    failed="$failed $name"
  fi
}

# Fortran in the project's format: fprettify changes nothing.
fortran_format() {
  # The texts of --help are formatted as printed.
  find src drivers tests examples bench -name '*.f90' ! -name '*_help.f90' ! -path '*/build/*' -print0 |
    xargs -0 "$bin/fprettify" -c .fprettify.rc --diff --silent >"$venv/fprettify.diff"
  [ ! -s "$venv/fprettify.diff" ] || { cat "$venv/fprettify.diff"; return 1; }
}

spelling() { git ls-files -z | grep -zvE '\.(svg|png|txt|ipynb)$|^LICENSES' | xargs -0 "$bin/codespell" --toml pyproject.toml; }
shell_scripts() { "$bin/shellcheck" --external-sources --source-path=SCRIPTDIR scripts/*.sh scripts/pytest .ci/run tests/checkers/*.sh; }

all='fortran_format spelling wording ruff ruff_format mypy shell_scripts licences'
chosen=${*:-$all}
check fortran_format fortran_format
check spelling spelling
check wording "$bin/python" scripts/check_wording.py
check ruff "$bin/ruff" check --no-cache .
check ruff_format "$bin/ruff" format --no-cache --check --diff .
check mypy "$bin/mypy" --cache-dir "$venv/mypy_cache" --config-file pyproject.toml python/mfv
check shell_scripts shell_scripts
check licences "$bin/reuse" lint --quiet
[ -z "$failed" ]
