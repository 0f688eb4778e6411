"""Kernels of disk and hole: time and error."""

from __future__ import annotations

import csv
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

from harness import ENVIRONMENT, Bench, stamp
from matplotlib import pyplot

Kernels = dict[tuple[int, int], tuple[float, float]]

TEXT = """## Which kernel for disk and hole?

Use the default, `kernel='exact'`. It computes only the entries that the mesh near the contact needs ({window} here), each to round-off, so
its time does not depend on the number of intervals on the circle. The Fourier series is summed over the whole circle; its error decreases with
the second power of the harmonics, and with four for each interval (dissertation section 4.2.2.1) it is {error_at_4:.0e} of the largest entry.

![Error over harmonics, and time over the intervals of the circle](pictures/circle_kernels.png)

Relative error of the largest of the three kernels of a disk, kappa = 1.8:

{error_table}

Time for {window} entries, relative to the exact kernel on the same circle ({exact_seconds:.0e} s):

{time_table}

## What share of a run is assembly?

A disk pressed and sheared on a rigid plane with friction, fully coupled, about 100 nodes in contact, dgesv:

{run_table}
"""


def measure(bench: Bench, _quick: bool) -> dict[str, Any]:
    """The rows that the program writes."""
    output = subprocess.run([bench.program, "circle"], check=True, capture_output=True, text=True, env=ENVIRONMENT).stdout
    return stamp() | {"rows": list(csv.reader(output.splitlines()))}


def section(data: dict[str, Any], pictures: Path) -> str:
    """The text."""
    rows = data["rows"]
    kernels = {
        (int(circle), int(multiple)): (float(seconds), float(error))
        for kind, _, circle, _, multiple, seconds, error in (row for row in rows if row[0] == "kernels")
    }
    circles, multiples = (sorted({key[place] for key in kernels}) for place in (0, 1))
    multiples.remove(0)
    draw(kernels, circles, multiples, pictures / "circle_kernels.png")
    return TEXT.format(
        window=next(row[3] for row in rows if row[0] == "kernels"),
        error_at_4=kernels[circles[-1], 4][1],
        exact_seconds=kernels[circles[0], 0][0],
        error_table=table(kernels, circles, multiples, lambda _, cell: f"{cell[1]:.1e}"),
        time_table=table(kernels, circles, multiples, lambda circle, cell: f"{cell[0] / kernels[circle, 0][0]:.2g}"),
        run_table=run_table([row[1:] for row in rows if row[0] == "run"]),
    )


CellText = Callable[[int, tuple[float, float]], str]


def table(kernels: Kernels, circles: list[int], multiples: list[int], cell_text: CellText) -> str:
    """A row for each circle, a column for each number of harmonics."""
    lines = [
        "| intervals on the circle | " + " | ".join(f"{multiple} harmonics an interval" for multiple in multiples) + " |",
        "| ---: |" + " ---: |" * len(multiples),
    ]
    for circle in circles:
        cells = [kernels.get((circle, multiple)) for multiple in multiples]
        lines.append(f"| {circle} | " + " | ".join("" if c is None else cell_text(circle, c) for c in cells) + " |")
    return "\n".join(lines)


def run_table(runs: list[list[str]]) -> str:
    """Share of the assembly in whole runs."""
    lines = ["| intervals on the circle | nodes in contact | kernel | linear solves | share of assembly |"]
    lines.append("| ---: | ---: | --- | ---: | ---: |")
    for circle, contact, kernel, assembly, total, solves in runs:
        lines.append(f"| {circle} | {contact} | {kernel} | {solves} | {100 * float(assembly) / float(total):.2g} % |")
    return "\n".join(lines)


def draw(kernels: Kernels, circles: list[int], multiples: list[int], path: Path) -> None:
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
    pyplot.close(figure)
