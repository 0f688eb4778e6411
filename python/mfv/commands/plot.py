"""mfv plot: draw a result."""

from __future__ import annotations

import argparse

from .._files import PICTURES, target, written
from ..result import read
from ..stress import NAMES
from ..studies.plan import is_table
from .completion import complete_words
from .shared import add_output, add_result

NAME, HELP = "plot", "draw a result"

DESCRIPTION = """\
Draw a result: pressure over x; shear traction over x with stick and slip zones and the friction limits (without friction:
the deformed surfaces of both bodies); tangential force over shift with numbered step ends, with cycles also without its
linear part; with a bulk stress the stress along the surface; with stress_at the tension over the last cycle. Points are
computed values, lines are closed forms if the file has any.
Of the table of a study (study.nc) draw a column over an axis; hollow markers are in doubt, see the column warnings.
"""

EXAMPLES = """\
examples:
  mfv plot mindlin.h5                 draw mindlin.png
  mfv plot mindlin.h5 --stress von_mises
                                      draw the stresses inside the lower body
  mfv plot mindlin.h5 --stress sigma_xx --axes physical
                                      in the units of the case, with the largest tension
  mfv plot mindlin.h5 -o fig3.pdf --step 2
                                      draw the state after step 2 as a PDF
  mfv plot shear_cycles.h5 --cycles
                                      draw the hysteresis loop and the dissipation over x
  mfv plot fretting.h5 --edges        draw the tractions next to the edges
  mfv plot study.nc --column lower_tension --over friction%mu
                                      draw a column of a study over one of its axes
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    add_result(parser)
    where = "png, pdf, svg or eps (default: RESULT.png, for a stress RESULT_NAME_BODY.png, beside the file)"
    add_output(parser, "PICTURE", where)
    parser.add_argument(
        "--step", type=int, metavar="N", help="draw state N of the file (group steps/000N); the last state by default"
    )
    kind = parser.add_mutually_exclusive_group()
    stress = kind.add_argument(
        "--stress",
        metavar="NAME",
        help="draw contours of a stress inside a body: von_mises, tresca, principal_1, sigma_xx, ...",
    )
    complete_words(stress, lambda: NAMES)
    kind.add_argument("--column", metavar="NAME", help="of a study: the column (the dissipation of the cycle by default)")
    kind.add_argument(
        "--cycles",
        action="store_true",
        help="draw the cycles: hysteresis loop, its non-linear part, dissipation of the last cycle over x",
    )
    kind.add_argument(
        "--edges",
        action="store_true",
        help="draw the tractions next to the left and right edge of the contact, with their asymptotes and slip zones",
    )
    parser.add_argument("--over", metavar="AXIS", help="of a study: the axis (the one with most values by default)")
    parser.add_argument("--body", choices=("lower", "upper"), help="with --stress: inside which body (lower by default)")
    parser.add_argument(
        "--axes",
        choices=("normalised", "physical"),
        help="with --stress: divided by the largest pressure and the contact half-width (normalised, the default), or in units (physical)",
    )


def run(options: argparse.Namespace) -> None:
    """Draw. Raises OSError, NotAResult, ValueError."""
    from .. import plot  # here, so that info does not load matplotlib

    if options.body is not None and options.stress is None:
        raise ValueError("--body has no effect without --stress; add --stress NAME or remove --body")
    if options.axes is not None and options.stress is None:
        raise ValueError("--axes has no effect without --stress; add --stress NAME or remove --axes")
    if options.step is not None and (options.cycles or options.edges):
        raise ValueError(f"--step has no effect with {'--cycles' if options.cycles else '--edges'}; remove one of them")
    if is_table(options.file):
        _draw_study(options)
        return
    body = options.body or "lower"
    result = read(options.file)
    if options.column is not None or options.over is not None:
        raise ValueError(f"{options.file}: not the table of a study; remove --column and --over")
    name = f"{options.file.stem}_{options.stress}_{body}" if options.stress else options.file.stem
    if options.cycles:
        name += "_cycles"
    if options.edges:
        name += "_edges"
    output = target(options.output, options.file.with_name(f"{name}.png"), PICTURES, [options.file])
    if options.stress:
        picture = plot.stress_figure(result, options.stress, body, options.step, options.axes or "normalised")
    elif options.cycles:
        picture = plot.cycles_figure(result)
    elif options.edges:
        picture = plot.edges_figure(result)
    else:
        picture = plot.figure(result, options.step)
    with written(output) as part:
        picture.savefig(part, dpi=200)
    print(output)


def _draw_study(options: argparse.Namespace) -> None:
    """Draw a column of a study's table. Raises OSError, ValueError."""
    import xarray  # here, since results are drawn without it

    from ..studies.figure import figure

    if options.stress or options.cycles or options.edges or options.step is not None:
        raise ValueError(
            f"{options.file}: the table of a study has no --stress, --cycles, --edges or --step; use --column and --over"
        )
    with xarray.open_dataset(options.file, engine="h5netcdf") as table:
        if "map_axes" in table.attrs and options.over is None:
            from ..studies import map_figure

            picture = map_figure.figure(table.load(), options.column)
        else:
            picture = figure(table, options.column, options.over)
    name = f"{options.file.stem}_{options.column}.png" if options.column else f"{options.file.stem}.png"
    output = target(options.output, options.file.with_name(name.replace("/", "_")), PICTURES, [options.file])
    with written(output) as part:
        picture.savefig(part, dpi=200)
    print(output)
