#!/bin/sh
# Draws the pictures of the documents from the examples into docs/pictures. Needs a release build, the Python packages and the
# chromium of scripts/test.sh.
. "$(dirname "$0")/common.sh"
bin=$root/build/release/bin
pictures=$root/docs/pictures
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
show() { PYTHONPATH=$root/python MPLBACKEND=Agg MFV_LIBRARY=$root/build/release/lib/libmfv.so "$venv/bin/python" -m mfv "$@"; }
draw() { show plot "$@"; }
for example in disk_on_plane disk_in_hole two_cylinders pin_in_bore rolling; do
  "$bin/mfv_run" "$root/examples/$example.nml" >/dev/null
  draw "$example.h5" -o "$pictures/$example.png"
done
"$bin/mfv_run" "$root/examples/shear_cycles.nml" >/dev/null
draw shear_cycles.h5 --cycles -o "$pictures/shear_cycles.png"
show animate shear_cycles.h5 --frames 50 --rate 10 -o "$pictures/cycles.gif"
show report shear_cycles.h5 --states 120
chromium --headless --no-sandbox --disable-gpu --hide-scrollbars --window-size=1200,1310 --virtual-time-budget=20000 \
  --screenshot="$pictures/report.png" "file://$work/shear_cycles.html"
"$bin/mfv_run" "$root/examples/fretting_pad.nml" >/dev/null
"$bin/mfv_stress" fretting_pad.h5 >/dev/null
sed '$d' "$root/examples/fretting_pad.nml" >sheared.nml    # without the cycles
"$bin/mfv_run" sheared.nml >/dev/null
PYTHONPATH=$root/python MPLBACKEND=Agg MFV_LIBRARY=$root/build/release/lib/libmfv.so "$venv/bin/python" "$root/scripts/first_picture.py" \
  fretting_pad.h5 "$pictures/fretting_pad.png"
draw sheared.h5 -o "$pictures/tutorial_shear.png"
draw fretting_pad.h5 --cycles -o "$pictures/tutorial_cycles.png"
draw fretting_pad.h5 --stress von_mises -o "$pictures/tutorial_stress.png"
draw fretting_pad.h5 --edges -o "$pictures/edges.png"
for example in two_cylinders pin_in_bore; do
  "$bin/mfv_stress" "$example.h5" >/dev/null
  draw "$example.h5" --stress von_mises -o "$pictures/${example}_stress.png"
done
# The mass on a contact of examples/hosts.
library=$root/build/release/lib
cc -O2 -I"$root/include" "$root/examples/hosts/newmark.c" -o newmark -L"$library" -lmfv -lm -Wl,-rpath,"$library"
PYTHONPATH=$root/python MPLBACKEND=Agg MFV_LIBRARY=$library/libmfv.so OPENBLAS_NUM_THREADS=1 \
  "$venv/bin/python" "$root/examples/hosts/draw_newmark.py" newmark -o "$pictures/newmark_decay.png"
PYTHONPATH=$root/python MPLBACKEND=Agg MFV_LIBRARY=$library/libmfv.so "$venv/bin/python" "$root/examples/microslip.py" -o "$pictures/microslip.png"
for example in joint_models hosts/joint_host; do
  PYTHONPATH=$root/python MPLBACKEND=Agg MFV_LIBRARY=$library/libmfv.so OPENBLAS_NUM_THREADS=1 \
    "$venv/bin/python" "$root/examples/$example.py" -o "$pictures/${example#hosts/}.png"
done
PYTHONPATH=$root/python MPLBACKEND=Agg MFV_LIBRARY=$library/libmfv.so "$venv/bin/python" "$root/examples/identification.py" -o "$pictures/identify.png"
# Regimes of a pad that can yield: some two minutes.
PYTHONPATH=$root/python MPLBACKEND=Agg MFV_LIBRARY=$library/libmfv.so "$venv/bin/python" - "$root/examples/fretting_pad.nml" "$pictures" <<'END'
import sys

import mfv
from mfv.studies import map_figure, regime_map

pad = mfv.Scene.from_file(sys.argv[1])
pad.lower.yield_strength = 250
table = regime_map(pad, {"Q": (20, 500), "P": (200, 1000)}, points=33, stick_ratio=0.9)
map_figure.figure(table).savefig(f"{sys.argv[2]}/map.png", dpi=150)
END
# Fatigue parameters below a pad.
PYTHONPATH=$root/python MPLBACKEND=Agg MFV_LIBRARY=$library/libmfv.so "$venv/bin/python" - "$root/examples/fretting_fatigue.nml" "$pictures" <<'END'
import sys

import matplotlib.pyplot as plt

import mfv
from mfv import fatigue

result = mfv.run(sys.argv[1])
cycle = fatigue.stress_cycle(result, *fatigue.graded_points(result, depth=0.6))
figure, axes = plt.subplots(1, 2, figsize=(10.5, 2.2), layout="constrained")
for parameter, unit, ax in zip((fatigue.smith_watson_topper(cycle), fatigue.fatemi_socie(cycle, yield_strength=325)), ("MPa", "1"), axes):
    mfv.plot.parameter_contours(parameter, ax, units=("mm", unit)).set_xlim(-2.6, -0.2)
figure.savefig(f"{sys.argv[2]}/fatigue_maps.png", dpi=120)
END
PYTHONPATH=$root/python MPLBACKEND=Agg MFV_LIBRARY=$library/libmfv.so "$venv/bin/python" "$root/examples/wear.py" "$pictures/wear.png" "$pictures/wear.gif"
PYTHONPATH=$root/python MPLBACKEND=Agg MFV_LIBRARY=$library/libmfv.so "$venv/bin/python" "$root/examples/composite.py" "$pictures/composite.png"
PYTHONPATH=$root/python MPLBACKEND=Agg MFV_LIBRARY=$library/libmfv.so "$venv/bin/python" "$root/examples/coating.py" "$pictures/coating.png"
PYTHONPATH=$root/python MPLBACKEND=Agg MFV_LIBRARY=$library/libmfv.so "$venv/bin/python" "$root/examples/waves.py" "$pictures/waves.png"
# Figures of the dissertation, into examples/dissertation/pictures.
PYTHONPATH=$root/python MPLBACKEND=Agg MFV_LIBRARY=$root/build/release/lib/libmfv.so "$venv/bin/python" "$root/examples/dissertation/draw.py"

# How the folders of the sources depend on each other.
python3 "$root/scripts/dependencies.py" "$pictures/dependencies.svg"
