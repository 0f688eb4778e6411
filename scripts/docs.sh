#!/bin/sh
# Builds the site of the documents, build/docs/html/index.html, from the sources: installs what is missing, solves and draws the
# gallery, checks every link. Safe to repeat. The site can be read offline.
. "$(dirname "$0")/common.sh"
install_missing
build_programs
site=$root/build/docs
venv=$site/venv
if [ ! "$venv/done" -nt "$root/pyproject.toml" ]; then
  say "Python packages of the site in build/docs/venv"
  [ -x "$venv/bin/python" ] || python3 -m venv "$venv"
  "$venv/bin/python" "$root/scripts/requirements.py" docs >"$venv/requirements.txt"
  "$venv/bin/python" -m pip install --quiet --disable-pip-version-check -r "$venv/requirements.txt"
  touch "$venv/done"
fi
export PYTHONDONTWRITEBYTECODE=1 MPLBACKEND=Agg OPENBLAS_NUM_THREADS=1
export MPLCONFIGDIR="$site/matplotlib"
say "staging the pages, solving the gallery"
"$venv/bin/python" "$root/docs/site/stage.py" --programs "$root/build/release/bin" "$site/source"
say "building the pages"
rm -rf "$site/html"
"$venv/bin/python" -m sphinx -q -W --keep-going -j "$jobs" -b html -c "$root/docs/site" -d "$site/doctrees" "$site/source" "$site/html"
say "checking the links"
"$venv/bin/python" "$root/scripts/check_links.py"
"$venv/bin/python" "$root/scripts/check_links.py" "$site/html"
say "build/docs/html/index.html"
