"""python -m mfv report: a result as one web page."""

from __future__ import annotations

import argparse
from pathlib import Path

from .._files import target, written
from ..result import read
from .shared import at_least, solved_between

NAME, HELP = "report", "a result as one web page"

DESCRIPTION = """\
Write a result as one web page to be opened in any browser: outcome and key numbers, pressure and shear traction with
stick and slip zones over the load history (a slider), the curve of load over displacement, the stick map, the history,
the cycles, the certificate, all numbers, the input. The file holds everything, about 5 MB of it the plotting library;
nothing is loaded from anywhere. It can be printed. Needs the Python packages plotly and jinja2.
"""

EXAMPLES = """\
examples:
  python -m mfv report mindlin.h5           write mindlin.html
  python -m mfv report mindlin.h5 --states 60 -o report.html
                                            with states between those that the file keeps
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What the command takes."""
    parser.add_argument("file", type=Path, metavar="RESULT.h5", help="result file")
    parser.add_argument("-o", "--output", type=Path, metavar="PAGE.html", help="else RESULT.html beside the file")
    parser.add_argument(
        "--states",
        type=at_least(2),
        metavar="N",
        help="about N states on the slider, from the case solved again, in place of those that the file keeps",
    )


def run(options: argparse.Namespace) -> None:
    """Write the page. Raises OSError, NotAResult, ModuleNotFoundError."""
    from ..report import page

    result, history = read(options.file), None
    output = target(options.output, options.file.with_suffix(".html"), (".html", ".htm"), [options.file])
    if options.states is not None:
        history = solved_between(options, result, options.states)
    with written(output) as part:
        part.write_text(page(result, options.file.name, history), encoding="utf-8")
    print(output)
