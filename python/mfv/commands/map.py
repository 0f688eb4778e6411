"""mfv map: the regimes of a case over two of its loads."""

from __future__ import annotations

import argparse
import re
import sys
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from .._files import PICTURES, target, written
from ..studies.executors import NAMES
from ..studies.maps import LIFE, STICK_RATIO, TOLERANCE, WEAR_RATE
from ..studies.plan import is_table
from .completion import complete_files, complete_words
from .shared import add_output, at_least, number, terminated_like_interrupted

if TYPE_CHECKING:
    import xarray

    from ..fatigue.comparison import PadTest

NAME, HELP = "map", "regimes of a case over two loads, with boundaries"

DESCRIPTION = """\
Solve a case over a grid of two of its loads, and find the boundaries of the regimes of its last cycle between them: stick,
partial slip, gross sliding, open (contact lost), and, with yield_strength in a &body, yielding. Write one table, like that of
'mfv study', and one picture with contour lines of a column. Axes are

  Q    largest tangential force    P   largest normal force    mu  coefficient of friction
  D    largest shift               B   largest bulk stress

of the case, whose targets are scaled in proportion, or any key of the case with a number, such as step(2)%shift; keys joined
by + change in proportion. A range is FROM:TO. Boundaries are found to a relative tolerance by bracketing; solved cases are
saved beside the table, as by 'mfv study'. See docs/studies.md.
"""

EXAMPLES = """\
examples:
  mfv map case.nml                           over Q and P, to case_map.png and case_map.nc
  mfv map case.nml --over Q=0:300,P=100:1000 ranges, in the units of the case
  mfv map case.nml --over D,mu --points 30x20
  mfv map case.nml --contour largest_lower_tension -o map.pdf
  mfv map case.nml --contour wear_rate --wear-coefficient 2e-8
  mfv map case.nml --contour life --material tests.csv
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    complete_files(parser.add_argument("file", type=Path, metavar="CASE.nml", help="the case"), "nml")
    parser.add_argument(
        "--over",
        type=_axes,
        metavar="X,Y",
        help="the axes, each with its range or without: Q=0:300,P (Q,P by default; D,P without Q)",
    )
    parser.add_argument("--points", type=_points, default=(50, 50), metavar="NxM", help="points along the axes (50x50)")
    column = parser.add_argument(
        "--contour",
        metavar="COLUMN",
        help=f"column of the contour lines: an observable, {WEAR_RATE} or {LIFE} (cycle_dissipation)",
    )
    complete_words(column, lambda: ("cycle_dissipation", "largest_lower_tension", WEAR_RATE, LIFE))
    parser.add_argument(
        "--stick-ratio",
        type=number,
        default=STICK_RATIO,
        metavar="RATIO",
        help=f"call it stick if stick zones are at least this fraction of the contact throughout the last cycle ({STICK_RATIO:g})",
    )
    parser.add_argument(
        "--tolerance", type=number, default=TOLERANCE, metavar="T", help=f"of boundaries, relative to the load ({TOLERANCE:g})"
    )
    parser.add_argument(
        "--wear-coefficient", type=number, metavar="K", help="depth of wear per pressure and slip, if the case has no &wear"
    )
    material = parser.add_argument(
        "--material", type=Path, metavar="TESTS.csv", help="strain-life curve: the first row of a table as of 'mfv fatigue --new'"
    )
    complete_files(material, "csv")
    parser.add_argument(
        "--parameter",
        default="Smith-Watson-Topper",
        metavar="NAME",
        help="of the life: Smith-Watson-Topper (the default), Fatemi-Socie, ...",
    )
    executor = parser.add_argument("--executor", default="threads", metavar="NAME", help="as of 'mfv study' (threads by default)")
    complete_words(executor, lambda: NAMES)
    parser.add_argument(
        "--workers", type=at_least(1), metavar="N", help="number of cases at a time (default: number of processors)"
    )
    parser.add_argument("--again", action="store_true", help="solve all cases again")
    add_output(parser, "PICTURE", "png, pdf, svg or eps; the table has its name with .nc (default: CASE_map.png)")


def _axes(text: str) -> dict[str, tuple[float, float] | None]:
    """The axes of --over with their ranges. Raises ArgumentTypeError."""
    found: dict[str, tuple[float, float] | None] = {}
    for part in text.split(","):
        name, equals, limits = part.strip().partition("=")
        try:
            first, last = map(float, limits.split(":")) if equals else (0.0, 0.0)
        except ValueError:
            raise argparse.ArgumentTypeError(f"'{part}': a range is FROM:TO, such as {name or 'Q'}=0.1:1") from None
        if not name or name in found:
            raise argparse.ArgumentTypeError(f"'{text}': must be two different axes with a comma between, such as Q,P")
        found[name] = (first, last) if equals else None
    if len(found) != 2:
        raise argparse.ArgumentTypeError(f"'{text}': must be two axes with a comma between, such as Q,P")
    return found


def _points(text: str) -> tuple[int, int]:
    """The numbers of points of --points. Raises ArgumentTypeError."""
    match = re.fullmatch(r"(\d+)(?:x(\d+))?", text)
    counts = (int(match[1]), int(match[2] or match[1])) if match else (0, 0)
    if min(counts) < 2:
        raise argparse.ArgumentTypeError(f"must be two whole numbers of at least 2 with x between, such as 50x50, not '{text}'")
    return counts


def run(options: argparse.Namespace) -> None:
    """Solve, write and draw. Raises OSError, ValueError."""
    from ..studies import regime_map
    from ..studies.dataset import write  # here, since it imports xarray
    from ..studies.map_figure import figure

    usual = Path(f"{options.file.stem}_map.png")
    picture = target(options.output, usual, PICTURES, [options.file])
    output = picture.with_suffix(".nc")
    if output.exists() and not is_table(output):
        raise FileExistsError(f"{output}: exists and is not the table of a study; not overwritten; give -o another name")
    kept = output.with_suffix(".sqlite")
    try:
        with terminated_like_interrupted():
            table = regime_map(
                options.file,
                options.over,
                options.points,
                contour=options.contour,
                stick_ratio=options.stick_ratio,
                tolerance=options.tolerance,
                wear_coefficient=options.wear_coefficient,
                material=_material(options.material),
                parameter=options.parameter,
                executor=options.executor,
                workers=options.workers,
                store=kept,
                again=options.again,
                progress=True,
            )
    except KeyboardInterrupt:
        print(f"mfv: solved cases are saved in {kept}; repeat the command to continue", file=sys.stderr)
        raise
    write(table, output)
    with written(picture) as part:
        figure(table).savefig(part, dpi=200)
    print(report(table))
    print(f"{output}\n{picture}")


def _material(path: Path | None) -> PadTest | None:
    """The first row of a table of tests. Raises OSError, InputError."""
    if path is None:
        return None
    from ..fatigue.comparison import read_tests

    return read_tests(path)[0]


def report(table: xarray.Dataset) -> str:
    """The numbers of points by regime, the boundaries with their tolerances, and what is in doubt."""
    from ..studies.dataset import flagged

    regimes = Counter(table["regime"].values.flat)
    lines = [f"{table['regime'].size} points: {', '.join(f'{count} {name}' for name, count in regimes.most_common())}"]
    if "yields" in table:
        lines[0] += f"; {int((table['yields'].values > 0.0).sum())} yielding"
    of = table["boundary"].values
    for name in dict.fromkeys(of):
        here = table.isel(crossing=of == name)
        relative = max(
            float((of_axis["boundary_tolerance"] / np.maximum(abs(of_axis[f"boundary_{axis}"]), np.diff(table[axis]).min())).max())
            for axis in table.attrs["map_axes"]
            if (of_axis := here.isel(crossing=here["boundary_along"].values == axis)).sizes["crossing"]
        )
        doubt = int((here["boundary_resolved"].values == 0).sum())
        note = f", {doubt} of them not resolved by the mesh" if doubt else ""
        lines.append(f"boundary of {name}: {here.sizes['crossing']} points{note}, within {relative:.1e} of the load")
    column = table.attrs["map_contour"]
    doubtful = int(flagged(table, column).values.sum())
    if doubtful:
        lines.append(f"{column} is in doubt at {doubtful} points, hollow in the picture: see the columns warnings and unresolved")
    failed = [text for text, name in zip(table["message"].values.flat, table["regime"].values.flat) if name == "failed"]
    lines += [f"failed: {text}" for text in failed[:1]]
    return "\n".join(lines)
