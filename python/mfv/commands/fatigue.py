"""mfv fatigue: compare fretting-fatigue tests with every parameter and critical distance."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from .._files import PICTURES, target, written
from .completion import complete_files
from .shared import add_output, at_least

if TYPE_CHECKING:
    from ..fatigue.comparison import Prediction

NAME, HELP = "fatigue", "compare fretting-fatigue tests with predicted lives"

DESCRIPTION = """\
Compare a series of pad tests with the lives that every parameter (Smith-Watson-Topper, Fatemi-Socie, Findley, Crossland,
Dang Van) predicts at the hot spot and by critical distances (point, area, line): predicted over measured lives, numbers
within factors of 2 and 5, and which of them fits. Nothing is fitted. Every row of the table is a test with its loads, its
material and its life; --new writes a table to fill in. Needs scipy. See docs/fatigue.md.
"""

EXAMPLES = """\
examples:
  mfv fatigue --new tests.csv               write a table with one invented row
  mfv fatigue tests.csv                     compare
  mfv fatigue tests.csv -o tests.png        and draw predicted over measured lives
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    complete_files(parser.add_argument("file", type=Path, metavar="TESTS.csv", nargs="?", help="table of tests"), "csv")
    add_output(parser, "PICTURE", "also draw: png, pdf, svg or eps")
    parser.add_argument("--nodes", type=at_least(21), default=101, metavar="N", help="nodes of the mesh (101)")
    parser.add_argument("--new", type=Path, metavar="FILE.csv", help="write a table to fill in")
    parser.add_argument("--columns", action="store_true", help="print every column of a table, in Markdown")


def run(options: argparse.Namespace) -> None:
    """Write a table, or compare. Raises OSError, ValueError, InputError, ModuleNotFoundError."""
    from ..fatigue import comparison

    if options.columns:
        print(comparison.columns_in_markdown())
        return
    if options.new is not None:
        path = target(options.new, Path("tests.csv"), (".csv",), [])
        if path.exists():
            raise FileExistsError(f"{path}: exists, not overwritten; give another name")
        with written(path) as part:
            part.write_text(comparison.template(), encoding="utf-8")
        print(f"{path}\nreplace its invented row by your tests, then: mfv fatigue {path}")
        return
    if options.file is None:
        raise ValueError("no table given; write 'mfv fatigue TESTS.csv', or 'mfv fatigue --new TESTS.csv' for one to fill in")
    tests = comparison.read_tests(options.file)
    picture = None
    if options.output is not None:
        picture = target(options.output, options.file.with_suffix(".png"), PICTURES, [options.file])
    from tqdm import tqdm

    predictions = [comparison.predict(test, options.nodes) for test in tqdm(tests, desc="solving", unit="test", disable=None)]
    print(report(predictions))
    if picture is not None:
        with written(picture) as part:
            comparison.figure(predictions).savefig(part, dpi=150)
        print(f"\n{picture}")


def report(predictions: Sequence[Prediction]) -> str:
    """Every test, every parameter at every place, and which fits."""
    from ..fatigue.comparison import FACTORS, PARAMETERS, PLACES, judge, numbered, statement

    width = max(len(str(one.test["test"])) for one in predictions) + 10
    lines = []
    for place in ("hot spot", "point"):
        lines += [f"predicted life [cycles], {place}"]
        lines += [f"{'test':{width}}{'a [mm]':>8}{'measured':>12}" + "".join(f"{name:>21}" for name in PARAMETERS)]
        for one in predictions:
            name = f"{one.test['test']}{' (invented)' if one.test.is_invented else ''}"
            life = f"{'' if one.test['failed'] else '> '}{one.test['life']:.2e}"
            values = "".join(f"{one.lives[parameter, place]:21.2e}" for parameter in PARAMETERS)
            lines.append(f"{name:{width}}{one.half_width:8.3f}{life:>12}{values}")
        lines.append("")
    counted = [one for one in predictions if not one.test.is_invented]
    if any(one.test["failed"] for one in counted):
        failed = sum(bool(one.test["failed"]) for one in counted)
        bands = ", ".join(f"{factor:g}" for factor in FACTORS)
        lines += [
            f"{numbered(failed, 'failed test')}: number within factors of {bands}; median of predicted over measured life; largest factor"
        ]
        lines += [f"{'':22}" + "".join(f"{place:>28}" for place in PLACES)]
        found = {(one.parameter, one.place): one for one in judge(predictions)}
        for parameter in PARAMETERS:
            row = [found[parameter, place] for place in PLACES]
            cells = [f"{', '.join(map(str, one.within))}; {one.median:.2g}; {one.worst:.2g}" for one in row]
            lines.append(f"{parameter:22}" + "".join(f"{cell:>28}" for cell in cells))
        run_outs = len(counted) - failed
        if run_outs:
            lines += ["", f"{numbered(run_outs, 'run-out')}: number with a predicted life of at least the test"]
            for parameter in PARAMETERS:
                lines.append(f"{parameter:22}" + "".join(f"{found[parameter, place].run_outs:28}" for place in PLACES))
        lines.append("")
    lines.append(statement(predictions))
    lines += [f"{one.test.where}: test '{one.test['test']}': {note}" for one in predictions for note in one.test.notes]
    return "\n".join(lines)
