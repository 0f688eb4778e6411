#!/bin/sh
# Checks that take too long for .ci/run. Arguments: parts, by default all. A part is a script scripts/deep-PART.sh, which
# installs and builds what it needs and ends with one line of results. Its output is in build/deep/PART.log.
. "$(dirname "$0")/common.sh"
all=
for script in "$root"/scripts/deep-*.sh; do
  part=$(basename "$script" .sh)
  [ "$part" = deep-check ] || all="$all ${part#deep-}"
done
for part in "$@"; do
  [ "$part" != check ] && [ -f "$root/scripts/deep-$part.sh" ] || { echo "there is no part '$part'; there are:$all" >&2; exit 2; }
done
mkdir -p "$root/build/deep"
failed=
[ $# -gt 0 ] || eval "set -- $all"
for part in "$@"; do
  log=$root/build/deep/$part.log
  [ ! -t 1 ] || printf '%s ...' "$part"
  started=$(date +%s)
  if sh "$root/scripts/deep-$part.sh" >"$log" 2>&1; then word=ok; else word=FAILED; failed="$failed $part"; fi
  [ ! -t 1 ] || printf '\r'
  printf '%-7s %-9s %3d min: %s\n' "$word" "$part" $((($(date +%s) - started + 59) / 60)) "$(tail -n 1 "$log")"
  [ $word = ok ] || printf '        see build/deep/%s.log\n' "$part"
done
[ -z "$failed" ]
