"""The command line: python -m mfv plot RESULT.h5, python -m mfv info RESULT.h5, python -m mfv table STUDY.h5."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from . import __version__
from .errors import MfvError
from .result import Group, Result, kept, read
from .table import read_table

UNUSABLE = 2  # exit code, as that of mfv_run for input that cannot be used

PLOT_HELP = """\
Draw a result as a picture of up to three panels: the pressure over x; the shear traction over x with the stick and
slip zones behind it and the limits of friction around it (without friction: the surfaces of both bodies); the
tangential force over the shift (where there is a history with a tangential force), with the ends of the steps
numbered. Points are computed, lines are closed forms where the file has them.
"""

EXAMPLES = """\
examples:
  mfv_run examples/mindlin.nml              write mindlin.h5
  python -m mfv info mindlin.h5             what is in it
  python -m mfv plot mindlin.h5             draw mindlin.png
  python -m mfv plot mindlin.h5 --stress von_mises
                                            draw the stresses inside the lower body
  python -m mfv plot mindlin.h5 -o fig3.pdf --step 2
                                            draw the state after step 2, for print
  python -m mfv table study.h5 --csv study.csv
                                            the table of a sweep for a spreadsheet
"""


def main(arguments: list[str] | None = None) -> int:
    """Run the command line; return the exit code."""
    options = _parser().parse_args(arguments)
    try:
        options.command(options)
    except (MfvError, OSError, ValueError) as error:
        print(f"mfv: {error}", file=sys.stderr)
        return UNUSABLE
    return 0


def _parser() -> argparse.ArgumentParser:
    raw = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(
        prog="python -m mfv", description="Look at result files of mfv_run and tables of mfv_sweep.", epilog=EXAMPLES, formatter_class=raw
    )
    parser.add_argument("--version", action="version", version=f"mfv {__version__}")
    commands = parser.add_subparsers(required=True, metavar="plot | info | table")

    plot = commands.add_parser(
        "plot", help="draw a result", description=PLOT_HELP, epilog=EXAMPLES, formatter_class=raw
    )
    plot.add_argument("file", type=Path, metavar="RESULT.h5", help="result file")
    plot.add_argument(
        "-o", "--output", type=Path, metavar="PICTURE", help="png, pdf or svg; else RESULT.png, or RESULT_NAME_BODY.png for a stress, beside the file"
    )
    plot.add_argument(
        "--step", type=int, metavar="N", help="the state in the file's group steps/000N in place of the last"
    )
    plot.add_argument(
        "--stress",
        metavar="NAME",
        help="contours of a stress inside a body in place of the panels: von_mises, sigma_xx, sigma_yy, sigma_xy, ...",
    )
    plot.add_argument(
        "--cycles",
        action="store_true",
        help="the cycles in place of the panels: hysteresis loop, its non-linear part, where the last one dissipates",
    )
    plot.add_argument("--body", choices=("lower", "upper"), default="lower", help="which body, with --stress")
    plot.set_defaults(command=_plot)

    info = commands.add_parser("info", help="print what is in a result", epilog=EXAMPLES, formatter_class=raw)
    info.add_argument("file", type=Path, metavar="RESULT.h5", help="result file")
    info.set_defaults(command=_info)

    table = commands.add_parser("table", help="print the table of a sweep", epilog=EXAMPLES, formatter_class=raw)
    table.add_argument("file", type=Path, metavar="STUDY.h5", help="file of mfv_sweep")
    table.add_argument(
        "--csv", metavar="FILE", help="write comma-separated values; - for the standard output; else the columns are described"
    )
    table.set_defaults(command=_table)
    return parser


def _plot(options: argparse.Namespace) -> None:
    from . import plot  # here, so that info does not load matplotlib

    result = read(options.file)
    if options.stress:
        picture = plot.stress_figure(result, options.stress, options.body, options.step)
    elif options.cycles:
        picture = plot.cycles_figure(result)
    else:
        picture = plot.figure(result, options.step)
    name = f"{options.file.stem}_{options.stress}_{options.body}" if options.stress else options.file.stem
    if options.cycles:
        name += "_cycles"
    output = options.output or options.file.with_name(f"{name}.png")
    picture.savefig(output, dpi=200)
    print(output)


def _info(options: argparse.Namespace) -> None:
    print(_description(read(options.file)))


def _table(options: argparse.Namespace) -> None:
    table = read_table(options.file)
    if options.csv is None:
        print(table.describe())
    else:
        table.write_csv(None if options.csv == "-" else options.csv)


def _description(result: Result) -> str:
    """A result in words and numbers, the input aside."""
    attributes = [f"{name:20}{value}" for name, value in result.attributes.items() if name != "input"]
    sources = [f"{name:20}{result.reference.description(name)}" for name in result.reference]
    blocks = [
        attributes,
        ["summary", *_lines(result.summary)],
        *([["observables", *_lines(result.observables)]] if result.observables else []),
        ["certificate", *_lines(result.certificate)],
        *([["error estimate", *_bars(result.error_estimate)]] if result.error_estimate else []),
        ["closed form", *(f"  {line}" for line in sources)] if sources else ["closed form: none"],
        [f"{result.mesh.x.size} nodes, {kept(result)}"],
    ]
    return "\n\n".join("\n".join(block) for block in blocks)


def _lines(group: Group) -> list[str]:
    """The scalars of a group, one a line."""
    return [f"  {name:26}{group[name]:<14.6g}{_unit(group, name):16}{group.description(name)}" for name in group]


def _bars(estimate: Group) -> list[str]:
    """The quantities of an error estimate with their bars, one a line."""
    names = [name for name in estimate if f"{name}_error" in estimate]
    return [
        f"  {name:26}{estimate[name]:<14.6g}+- {estimate[name + '_error']:<11.2g}{_unit(estimate, name):16}"
        f"order {estimate[name + '_order']:.2g}"
        for name in names
    ]


def _unit(group: Group, name: str) -> str:
    return "" if group.unit(name) == "1" else group.unit(name)


if __name__ == "__main__":
    sys.exit(main())
