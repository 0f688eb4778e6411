"""The folders of src and what they use of each other, from the sources. Standard library only.

    python3 scripts/dependencies.py [--check] [docs/pictures/dependencies.svg]

Fails, with the lines at fault, if a module uses one of a folder above its own; the order is that of mfv_add_folder in
src/CMakeLists.txt. (The compiler rejects it too: it does not find the module.) Draws the picture if its name is given; with --check it
fails if the picture does not show the sources.
"""

import argparse
import re
import sys
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
ROW, BOX, WIDTH = 40, 560, 880
LEFT = BOX + 10
MANY_USES = 5, 20

CONTENTS = {
    "common": "kinds, errors, statuses, text, GSL, FFTW, safe files",
    "geometry": "surfaces of bodies before deformation, measured profiles",
    "compliance": "elasticity of bodies, kernels, Toeplitz and Fourier products",
    "stress": "stresses inside the bodies and along their surfaces",
    "reference": "closed forms",
    "algorithms/friction": "statuses and events of a node, one file per law",
    "algorithms/model": "scene, contact on its mesh, fields, state, history",
    "algorithms/solvers": "linear systems, dense, updated and by FFT",
    "algorithms/measures": "certificate, edges, slip zones, cycles, rolling",
    "algorithms/stepping": "first violation, large increments, derivatives",
    "algorithms/run": "the state of a run, segments, cycles, wear",
    "algorithms/analysis": "observables, error bars, advice, tangent, warnings",
    "io/input": "namelist, keys, scene builder, profiles, matrices",
    "io/output": "result fields, HDF5 files, restart, summary",
    "api": "contact_type, the Fortran and C interfaces",
}


def sources(folder):
    """Fortran and C sources of a folder, those without HDF5 too."""
    files = [*(ROOT / "src" / folder).iterdir(), *(ROOT / "src" / folder).glob("without_hdf5/*")]
    return sorted(path for path in files if path.suffix in (".f90", ".F90", ".c", ".h"))


def read_folders():
    """Folders from below to above, with their modules."""
    text = (ROOT / "src/CMakeLists.txt").read_text()
    order = re.findall(r"^mfv_add_folder\(([\w/]+)", text, re.MULTILINE)
    modules = {}
    for folder in order:
        for path in sources(folder):
            for name in re.findall(r"^module (mfv\w*)$", path.read_text(), re.MULTILINE):
                modules[name] = folder
    modules.update(mfv_version="common", mfv_features="common")
    return order, modules


def read_arrows(order, modules):
    """Numbers of uses between folders, and the wrong ones."""
    arrows, wrong = Counter(), []
    for folder in order:
        for path in sources(folder):
            for number, line in enumerate(path.read_text().splitlines(), 1):
                used = re.match(r"\s*use (mfv\w*)", line)
                if not used:
                    continue
                other = modules.get(used[1])
                where = f"{path.relative_to(ROOT)}:{number}: {line.strip()}"
                if other is None:
                    wrong.append(f"{where}: no such module in src")
                elif order.index(other) > order.index(folder):
                    wrong.append(f"{where}: {other} is above {folder}")
                elif other != folder:
                    arrows[folder, other] += 1
    return arrows, wrong


def draw(order, arrows):
    """An SVG: the folders from above to below, an arc for each pair, wide for many uses."""
    height = ROW * len(order) + 20
    middle = {folder: 10 + ROW * (len(order) - 1 - i) + ROW // 2 for i, folder in enumerate(order)}
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" font-family="sans-serif" font-size="15">',
        f'<rect width="{WIDTH}" height="{height}" fill="white"/>',
    ]
    for (user, used), number in sorted(arrows.items()):
        top, bottom = middle[user], middle[used]
        reach = LEFT + 24 * (bottom - top) // ROW + 8
        lines.append(
            f'<path d="M {LEFT} {top} C {reach} {top}, {reach} {bottom}, {LEFT} {bottom}" fill="none" stroke="#36648b" '
            f'stroke-opacity="0.35" stroke-width="{1 + 2 * sum(number >= many for many in MANY_USES)}"/>'
        )
    for folder in order:
        y = middle[folder]
        lines += [
            f'<rect x="10" y="{y - 15}" width="{BOX}" height="30" rx="4" fill="#eef3f7" stroke="#36648b"/>',
            f'<text x="22" y="{y + 5}">{folder}</text>',
            f'<text x="{BOX}" y="{y + 5}" text-anchor="end" fill="#444" font-size="13">{CONTENTS[folder]}</text>',
        ]
    return "\n".join([*lines, "</svg>", ""])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("picture", type=Path, nargs="?")
    parser.add_argument("--check", action="store_true", help="compare the picture instead of drawing it")
    arguments = parser.parse_args()
    order, modules = read_folders()
    arrows, wrong = read_arrows(order, modules)
    if wrong:
        sys.exit("\n".join(["a folder uses one above it:", *wrong]))
    if not arguments.picture:
        return
    picture = draw(order, arrows)
    if not arguments.check:
        arguments.picture.write_text(picture)
    elif arguments.picture.read_text() != picture:
        sys.exit(f"{arguments.picture} does not show the sources; run python3 scripts/dependencies.py {arguments.picture}")


if __name__ == "__main__":
    main()
