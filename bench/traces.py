"""Measured traces on more and more nodes at each of their points: contact length, patches and dissipation, with bars and verdicts.

The traces are test data of the package SurfaceTopography (github.com/ContactEngineering/SurfaceTopography, folder
test/file_format_examples; not in its wheel): copy or clone them. Prints a Markdown table; --document replaces that of a page. Five
minutes.

build/venv/bin/python bench/traces.py FOLDER [--document docs/verification.md]
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "python"))
os.environ.setdefault("MFV_LIBRARY", str(ROOT / "build/release/lib/libmfv.so"))

import mfv
from mfv import profiles

Numbers = NDArray[np.float64]
#: Files, and what they are.
TRACES = {
    "hfm-1.hfm": "4.8 mm of a ground surface, 9,600 points",
    "dektak-1.csv": "1.5 mm of a smooth surface with spikes, 9,600 points",
    "opdx-3.opdx": "50 um of a film, 3,001 points",
}
#: Nodes at each point; of the last, the reference, without bars.
FINER = (1, 2, 4, 8, 16)
#: The filter, in points: it halves the amplitude of waves of this length.
SHORTEST = 16
#: Steel on a rigid trace: mean pressure over E* times the rms slope; friction; part of the sliding limit.
MODULUS, POISSON, PRESSURE, MU, SHARE = 210.0e3, 0.3, 0.02, 0.3, 0.6
QUANTITIES = ("contact_length", "patches", "cycle_dissipation")
#: Before and after the table in a page.
MARK = "<!-- traces -->\n"


class Trace(NamedTuple):
    """Positions and recess [um] of one period, at equal distances; the last point closes it."""

    x: Numbers
    height: Numbers

    @property
    def length(self) -> float:
        return float(self.x[-1] - self.x[0])

    @property
    def slope(self) -> float:
        """Root mean square."""
        return float(np.sqrt(np.mean((np.diff(self.height) / np.diff(self.x)) ** 2)))


class Row(NamedTuple):
    """Values of the quantities, their bars (NaN without one), names of those not resolved, of one number of nodes."""

    finer: int
    nodes: int
    in_contact: int
    values: dict[str, float]
    bars: dict[str, float]
    unresolved: list[str]


def read(path: Path, smoothed: bool) -> Trace:
    """The trace without its form (a parabola), `smoothed` by a Gaussian filter of ISO 16610-21 or as it was measured. What remains
    between its ends is removed by a line, so that it repeats."""
    given = profiles.read(path, unit="um")
    if smoothed:
        given = profiles.read(path, unit="um", lambda_s=SHORTEST * float(np.ptp(given.x)) / (given.x.size - 1))
    valued = np.isfinite(given.height)
    x = np.linspace(given.x[valued][0], given.x[valued][-1], int(np.sum(valued)))
    height = np.interp(x, given.x[valued], given.height[valued])
    x -= 0.5 * (x[0] + x[-1])
    height -= np.polynomial.Polynomial.fit(x, height, 2)(x)
    height -= np.interp(x, x[[0, -1]], height[[0, -1]])
    return Trace(x, height - height.min())


def scene(trace: Trace, finer: int, smoothed: bool) -> mfv.Scene:
    """The trace pressed on a half-plane, sheared, and one cycle."""
    force = PRESSURE * trace.slope * MODULUS / (1.0 - POISSON**2) * trace.length
    steps = [mfv.Step(normal_force=force), mfv.Step(force_ratio=SHARE), mfv.Step(force_ratio=-SHARE, cycles=1)]
    return mfv.Scene(
        mfv.Body.half_plane(youngs_modulus=MODULUS, poisson_ratio=POISSON),
        mfv.Body.profile(trace.x, trace.height, rigid=True, interpolation="monotone_cubic" if smoothed else "linear"),
        mesh=mfv.Mesh(nodes=finer * (trace.x.size - 1), period=trace.length),
        friction=mfv.Friction.coulomb(MU),
        steps=steps,
        coupling="none",
        length_unit="um",
        output=mfv.Output(states="none", history="none", error_estimate=finer < FINER[-1]),
    )


def rows(path: Path, smoothed: bool) -> Iterator[Row]:
    """Of all numbers of nodes."""
    trace = read(path, smoothed)
    for finer in FINER:
        result = scene(trace, finer, smoothed).run(check=True)
        bars = dict.fromkeys(QUANTITIES, np.nan)
        if finer < FINER[-1]:
            bars = {name: float(result.error_estimate.get(f"{name}_error", np.nan)) for name in QUANTITIES}
        values = {name: float(result.observables[name]) for name in QUANTITIES}
        names = [name for name in str(result.attributes["unresolved"]).split() if name in QUANTITIES]
        yield Row(finer, result.mesh.x.size, int(result.summary.contact_nodes), values, bars, names)


def cell(row: Row, name: str, reference: float) -> str:
    """The error in percent, with the bar in percent in brackets, or a question mark where it is not resolved."""
    percent = 100.0 * (row.values[name] / reference - 1.0)
    error = f"{percent:+.0f}" if abs(percent) >= 10.0 else f"{percent:+.2g}"
    if name in row.unresolved:
        return f"{error}?"
    return f"{error} ({100.0 * row.bars[name] / abs(row.values[name]):.1g})"


def order(found: list[Row], name: str) -> str:
    """Of convergence: the slope of a line through the logarithms of the errors."""
    errors = [abs(row.values[name] / found[-1].values[name] - 1.0) for row in found[:-1]]
    return f"{-np.polyfit(np.log(FINER[:-1]), np.log(errors), 1)[0]:.1f}"


def table(folder: Path) -> str:
    """Of all traces, as measured and smoothed: a line each, with the numbers of all nodes at a point but the last."""
    lines = ["| trace | nodes in each patch | contact length, % | order | dissipation of a cycle, % | order |"]
    lines.append("| --- | --- | --- | ---: | --- | ---: |")
    for name in TRACES:
        for smoothed in (False, True):
            title = f"{name}, {'smoothed' if smoothed else 'as measured'}"
            found = []
            for row in rows(folder / name, smoothed):
                found.append(row)
                print(title, row, file=sys.stderr, flush=True)
            cells = [title, ", ".join(f"{row.in_contact / row.values['patches']:.1f}" for row in found[:-1])]
            for quantity in ("contact_length", "cycle_dissipation"):
                reference = found[-1].values[quantity]
                cells.append(", ".join(cell(row, quantity, reference) for row in found[:-1]))
                cells.append(order(found, quantity))
            lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


def main() -> None:
    """Measure, print or document."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, help="of the files " + ", ".join(TRACES))
    parser.add_argument("--document", type=Path, help="page whose part between '<!-- traces -->' marks becomes the table")
    options = parser.parse_args()
    text = table(options.folder)
    print(text)
    if options.document:
        before, _, rest = options.document.read_text().partition(MARK)
        _, _, after = rest.partition(MARK)
        options.document.write_text(f"{before}{MARK}\n{text}\n{MARK}{after}")


if __name__ == "__main__":
    main()
