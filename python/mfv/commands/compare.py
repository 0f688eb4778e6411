"""mfv compare: compare two results."""

from __future__ import annotations

import argparse

from .._files import PICTURES, target, written
from ..result import read
from .shared import add_output, add_result, number

NAME, HELP = "compare", "compare two results: differences and a picture"

DESCRIPTION = """\
Print the differences of two results: settings, input keys, the numbers of summary, observables and certificate with their
relative differences, and the tractions. Draw them side by side and superposed: pressure, shear traction with stick and
slip zones, tangential force over shift. The last line is the overall measure: the largest difference of a traction
divided by the largest traction. Tractions on different meshes are interpolated linearly.
"""

EXAMPLES = """\
examples:
  mfv compare goodman.h5 full.h5      print the differences, draw goodman_full.png
  mfv compare coarse.h5 fine.h5 -o mesh.pdf
  mfv compare yesterday.h5 today.h5 --no-picture --tolerance 1e-9
                                      exit code 1 if the tractions differ by more
"""

DIFFERENT = 1  # exit code, with --tolerance


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    add_result(parser, "file", "FIRST.h5")
    add_result(parser, "other", "SECOND.h5")
    add_output(parser, "PICTURE", "png, pdf, svg or eps (default: FIRST_SECOND.png beside the first file)")
    parser.add_argument("--no-picture", action="store_true", help="print only")
    parser.add_argument("--step", type=int, metavar="N", help="compare state N (group steps/000N); the last states by default")
    parser.add_argument(
        "--tolerance", type=number, metavar="RATIO", help="exit with code 1 if the largest difference of the tractions exceeds this"
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
