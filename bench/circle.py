"""Measure the kernels of disk and hole, and write docs/performance.md and its picture.

    cmake --preset release && cmake --build --preset release --target bench_circle
    build/venv/bin/python bench/circle.py
"""

from __future__ import annotations

import argparse
import csv
import os
import subprocess
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot

ROOT = Path(__file__).resolve().parents[1]

TEXT = """# Performance

Written by `bench/circle.py`; do not edit. Times are of one run on one machine: compare them with each other, not with yours.

## Which kernel for disk and hole?

`kernel='exact'`, the default. It computes only the entries that the mesh near the contact needs ({window} here), each to round-off, so
that its time does not depend on how fine the circle is. The Fourier series has to be summed over the whole circle; its error falls with
the second power of the harmonics, and at the customary four for each interval (dissertation section 4.2.2.1) it is still
{error_at_4:.0e} of the largest entry.

![Error over harmonics, and time over the intervals of the circle](pictures/circle_kernels.png)

Relative error of the largest of the three kernels of a disk, kappa = 1.8:

{error_table}

Time for {window} entries, in units of the exact kernel's on the same circle (that takes {exact_seconds:.0e} s):

{time_table}

## What share of a run is assembly?

A disk pressed and sheared on a rigid plane with friction, fully coupled, about 100 nodes in contact, dgesv:

{run_table}
"""


def main() -> None:
    """Run the benchmark, write the page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=Path, default=ROOT / "build/release/bin/bench_circle")
    parser.add_argument("--docs", type=Path, default=ROOT / "docs", help="where performance.md goes")
    options = parser.parse_args()
    environment = os.environ | {"OPENBLAS_NUM_THREADS": "1"}
    output = subprocess.run([options.program], check=True, capture_output=True, text=True, env=environment).stdout
    rows = list(csv.reader(output.splitlines()))
    kernels = {
        (int(circle), int(multiple)): (float(seconds), float(error))
        for kind, _, circle, _, multiple, seconds, error in (row for row in rows if row[0] == "kernels")
    }
    circles, multiples = (sorted({key[place] for key in kernels}) for place in (0, 1))
    multiples.remove(0)
    draw(kernels, circles, multiples, options.docs / "pictures/circle_kernels.png")
    text = TEXT.format(
        window=next(row[3] for row in rows if row[0] == "kernels"),
        error_at_4=kernels[circles[-1], 4][1],
        exact_seconds=kernels[circles[0], 0][0],
        error_table=table(kernels, circles, multiples, lambda _, cell: f"{cell[1]:.1e}"),
        time_table=table(kernels, circles, multiples, lambda circle, cell: f"{cell[0] / kernels[circle, 0][0]:.2g}"),
        run_table=run_table([row[1:] for row in rows if row[0] == "run"]),
    )
    (options.docs / "performance.md").write_text(text)


def table(kernels, circles, multiples, cell_text) -> str:
    """A row for each circle, a column for each number of harmonics."""
    lines = [
        "| intervals on the circle | " + " | ".join(f"{multiple} harmonics an interval" for multiple in multiples) + " |",
        "| ---: |" + " ---: |" * len(multiples),
    ]
    for circle in circles:
        cells = [kernels.get((circle, multiple)) for multiple in multiples]
        lines.append(f"| {circle} | " + " | ".join("" if c is None else cell_text(circle, c) for c in cells) + " |")
    return "\n".join(lines)


def run_table(runs) -> str:
    """Share of the assembly in whole runs."""
    lines = ["| intervals on the circle | nodes in contact | kernel | linear solves | share of assembly |"]
    lines.append("| ---: | ---: | --- | ---: | ---: |")
    for circle, contact, kernel, assembly, total, solves in runs:
        lines.append(f"| {circle} | {contact} | {kernel} | {solves} | {100 * float(assembly) / float(total):.2g} % |")
    return "\n".join(lines)


def draw(kernels, circles, multiples, path: Path) -> None:
    """Error over harmonics (the dissertation's Figure 4.4 as a curve), time over circles."""
    figure, (left, right) = pyplot.subplots(1, 2, figsize=(9, 3.6), layout="constrained")
    for circle in circles:
        shown = [multiple for multiple in multiples if (circle, multiple) in kernels]
        left.loglog(shown, [kernels[circle, multiple][1] for multiple in shown], "o-", label=f"{circle:.0e} intervals")
    guide = [kernels[circles[0], multiples[0]][1] * 2 * (multiples[0] / multiple) ** 2 for multiple in multiples]
    left.loglog(multiples, guide, "k:", linewidth=0.8, label="second order")
    left.set_xlabel("harmonics an interval")
    left.set_ylabel("relative error")
    for multiple in [0, *multiples]:
        shown = [circle for circle in circles if (circle, multiple) in kernels]
        name = f"{multiple} harmonics an interval" if multiple else "exact"
        right.loglog(shown, [kernels[circle, multiple][0] for circle in shown], "o-", label=name)
    right.set_xlabel("intervals on the circle")
    right.set_ylabel("seconds")
    for axes in (left, right):
        axes.legend(fontsize=8, frameon=False)
        axes.grid(alpha=0.3)
    figure.savefig(path, dpi=150)


if __name__ == "__main__":
    main()
