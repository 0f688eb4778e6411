"""Kernels of disk and hole: time and error."""

from __future__ import annotations

import csv
import subprocess
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

Of the time of a run with dgesv and about 100 nodes in contact, assembly takes up to {exact_share:.1g} % with the exact kernel, and up to {fourier_share:.2g} % with the Fourier series (1,000 to {largest:,} intervals on the circle).
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
        exact_share=largest_share(rows, "exact"),
        fourier_share=largest_share(rows, "fourier"),
        largest=max(int(row[1]) for row in rows if row[0] == "run"),
    )


def largest_share(rows: list[list[str]], kernel: str) -> float:
    """The largest share of the assembly in a whole run, per cent."""
    runs = (row for row in rows if row[0] == "run" and row[3] == kernel)
    return max(100.0 * float(assembly) / float(total) for _, _, _, _, assembly, total, _ in runs)


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
