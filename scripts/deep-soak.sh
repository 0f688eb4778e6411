#!/bin/sh
# An hour of random cases through the C interface in one process (tests/soak): memory flat, no certificate above its limit,
# bit-identical repetitions. Environment: MFV_SOAK_SECONDS, MFV_SOAK_THREADS, MFV_SOAK_SEED (the day).
. "$(dirname "$0")/common.sh"
install_missing
build release
folder=$root/build/deep/soak
mkdir -p "$folder"
"$root/build/release/bin/soak" --seconds "${MFV_SOAK_SECONDS:-3600}" --threads "${MFV_SOAK_THREADS:-2}" \
  --seed "${MFV_SOAK_SEED:-$(date +%Y%m%d)}" --record "$folder/record.txt" --folder "$folder"
