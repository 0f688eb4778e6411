"""python -m mfv plot: a picture of a result."""

from __future__ import annotations

import argparse
from pathlib import Path

from .._files import PICTURES, target, written
from ..result import read
from .shared import add_output

NAME, HELP = "plot", "draw a result"

DESCRIPTION = """\
Draw a result as a picture of up to three panels: the pressure over x; the shear traction over x with the stick and
slip zones behind it and the limits of friction around it (without friction: the surfaces of both bodies); the
tangential force over the shift (where there is a history with a tangential force), with the ends of the steps
numbered. Points are computed, lines are closed forms where the file has them.
"""

EXAMPLES = """\
examples:
  python -m mfv plot mindlin.h5             draw mindlin.png
  python -m mfv plot mindlin.h5 --stress von_mises
                                            draw the stresses inside the lower body
  python -m mfv plot mindlin.h5 --stress sigma_xx --axes physical
                                            the same in the units of the case, the largest tension marked
  python -m mfv plot mindlin.h5 -o fig3.pdf --step 2
                                            draw the state after step 2, for print
  python -m mfv plot shear_cycles.h5 --cycles
                                            draw the hysteresis loop and where it dissipates
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What the command takes."""
    parser.add_argument("file", type=Path, metavar="RESULT.h5", help="result file")
    where = "png, pdf, svg or eps; else RESULT.png, or RESULT_NAME_BODY.png for a stress, beside the file"
    add_output(parser, "PICTURE", where)
    parser.add_argument("--step", type=int, metavar="N", help="the state in the file's group steps/000N in place of the last")
    kind = parser.add_mutually_exclusive_group()
    kind.add_argument(
        "--stress",
        metavar="NAME",
        help="contours of a stress inside a body in place of the panels: von_mises, tresca, principal_1, sigma_xx, ...",
    )
    kind.add_argument(
        "--cycles",
        action="store_true",
        help="the cycles in place of the panels: hysteresis loop, its non-linear part, where the last one dissipates",
    )
    parser.add_argument("--body", choices=("lower", "upper"), help="which body, with --stress; lower by default")
    parser.add_argument(
        "--axes",
        choices=("normalised", "physical"),
        help="with --stress: over the largest pressure and the contact half-width (normalised, the default), or as they are (physical)",
    )


def run(options: argparse.Namespace) -> None:
    """Draw. Raises OSError, NotAResult, ValueError."""
    from .. import plot  # here, so that info does not load matplotlib

    if options.body is not None and options.stress is None:
        raise ValueError("--body says inside which body a stress is drawn: give --stress NAME too")
    if options.axes is not None and options.stress is None:
        raise ValueError("--axes says how a stress is drawn: give --stress NAME too")
    if options.step is not None and options.cycles:
        raise ValueError("--step chooses a state, which --cycles does not draw: give one of them")
    body = options.body or "lower"
    result = read(options.file)
    name = f"{options.file.stem}_{options.stress}_{body}" if options.stress else options.file.stem
    if options.cycles:
        name += "_cycles"
    output = target(options.output, options.file.with_name(f"{name}.png"), PICTURES, [options.file])
    if options.stress:
        picture = plot.stress_figure(result, options.stress, body, options.step, options.axes or "normalised")
    elif options.cycles:
        picture = plot.cycles_figure(result)
    else:
        picture = plot.figure(result, options.step)
    with written(output) as part:
        picture.savefig(part, dpi=200)
    print(output)
