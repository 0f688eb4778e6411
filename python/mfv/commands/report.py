"""mfv report: write a result as one web page."""

from __future__ import annotations

import argparse

from .._files import target, written
from ..result import read
from .shared import add_output, add_result, at_least, solved_between

NAME, HELP = "report", "write a result as one web page"

DESCRIPTION = """\
Write a result as one web page for any browser: outcome and key numbers, pressure and shear traction with stick and slip
zones over the load history (a slider), load over displacement, stick map, history, cycles, certificate, all numbers,
input. The file is complete (the plotting library takes about 5 MB) and loads nothing from the network. It can be
printed. Needs the Python packages plotly and jinja2.
"""

EXAMPLES = """\
examples:
  mfv report mindlin.h5               write mindlin.html
  mfv report mindlin.h5 --states 60 -o report.html
                                      with states between those saved in the file
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    add_result(parser)
    add_output(parser, "PAGE.html", "file to write (default: RESULT.html beside the file)")
    parser.add_argument(
        "--states",
        type=at_least(2),
        metavar="N",
        help="solve the case again for about N states on the slider; by default those saved in the file",
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
