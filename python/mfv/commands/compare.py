"""python -m mfv compare: two results side by side."""

from __future__ import annotations

import argparse
from pathlib import Path

from .._files import PICTURES, target, written
from ..result import read
from .shared import add_output

NAME, HELP = "compare", "two results side by side"

DESCRIPTION = """\
Draw two results side by side and over each other: pressure, shear traction with stick and slip zones, and tangential
force over shift; and print what differs: settings, keys of the inputs, the numbers of summary, observables and
certificate with their relative differences, and the tractions. The last line is the number to judge by: the largest
difference of a traction in parts of the largest traction. Tractions on different meshes are interpolated linearly.
"""

EXAMPLES = """\
examples:
  python -m mfv compare goodman.h5 full.h5  print what differs, draw goodman_full.png
  python -m mfv compare coarse.h5 fine.h5 -o mesh.pdf
  python -m mfv compare yesterday.h5 today.h5 --no-picture --tolerance 1e-9
                                            exit code 1 when the tractions differ by more
"""

DIFFERENT = 1  # exit code, with --tolerance


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What the command takes."""
    parser.add_argument("file", type=Path, metavar="FIRST.h5", help="result file")
    parser.add_argument("other", type=Path, metavar="SECOND.h5", help="result file")
    add_output(parser, "PICTURE", "png, pdf, svg or eps; else FIRST_SECOND.png beside the first file")
    parser.add_argument("--no-picture", action="store_true", help="draw nothing")
    parser.add_argument("--step", type=int, metavar="N", help="the states in steps/000N in place of the last ones")
    parser.add_argument(
        "--tolerance", type=float, metavar="PART", help="end with code 1 when the tractions differ by more than this"
    )


def run(options: argparse.Namespace) -> int:
    """Compare, print, draw; return the exit code. Raises OSError, NotAResult, ValueError."""
    from ..compare import compare

    comparison = compare(read(options.file), read(options.other), options.step)
    sources = [options.file, options.other]
    usual = options.file.with_name(f"{options.file.stem}_{options.other.stem}.png")
    picture = None if options.no_picture else target(options.output, usual, PICTURES, sources)
    print(f"first   {options.file}\nsecond  {options.other}\n\n{comparison.describe()}")
    if picture is not None:
        from ..comparison_figure import figure  # here: it loads matplotlib

        with written(picture) as part:
            figure(comparison, str(options.file), str(options.other)).savefig(part, dpi=150)
        print(f"\n{picture}")
    too_different = options.tolerance is not None and not comparison.largest_difference <= options.tolerance
    return DIFFERENT if too_different else 0
