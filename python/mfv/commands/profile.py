"""mfv profile: a measured profile as a text file for &body."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np

from .._files import target, written
from .shared import add_output, number

NAME, HELP = "profile", "write the profile in a file of an instrument as a text"

DESCRIPTION = """\
Write a measured profile as a text file with x and height for &body shape='profile', file='...': from a line scan or a line
of an areal map. Texts are read as they come; files of instruments (x3p, opd, sur, plu, vk4, ...) with the package
SurfaceTopography. Lengths are converted to one unit, and heights, which instruments count outwards, to the recess that
&body takes. Points without a value are written as nan. Filters: ISO 16610-21 (Gaussian). See docs/guide.md.
"""

EXAMPLES = """\
examples:
  mfv profile scan.x3p -o scan.txt
                                      the middle line of a map, in mm
  mfv profile scan.opd --line 120 --along y --unit um
                                      another line, in micrometres
  mfv profile trace.csv -o scan.txt --file-unit um --lambda-s 0.0025
                                      a text without a unit; without waves shorter than 2.5 micrometres
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.add_argument("file", type=Path, metavar="SCAN", help="text, or file of an instrument")
    add_output(parser, "FILE.txt", "text to write (default: SCAN with .txt)")
    parser.add_argument("--unit", default="mm", help="unit of length of the case, and of the options (default: mm)")
    parser.add_argument("--file-unit", metavar="UNIT", help="unit of length of a file that names none (default: --unit)")
    parser.add_argument(
        "--inwards",
        action="store_true",
        help="heights of the file are the recess, positive into the material (default: if its heading says recess)",
    )
    parser.add_argument("--spacing", type=number, metavar="LENGTH", help="distance of heights that have no positions")
    parser.add_argument("--line", help="map: number of the line from 1, middle, or mean (default: middle)")
    parser.add_argument("--along", choices=("x", "y"), help="map: direction of the line (default: x)")
    parser.add_argument("--channel", help="number from 1 or name of the channel (default: that of the format)")
    parser.add_argument("--lambda-s", type=number, metavar="LENGTH", help="remove waves shorter than this")
    parser.add_argument("--lambda-c", type=number, metavar="LENGTH", help="remove waves longer than this")


def run(options: argparse.Namespace) -> None:
    """Read, write, print the key. Raises OSError, InputError, ValueError, ModuleNotFoundError."""
    from ..profiles import read

    path = target(options.output, options.file.with_suffix(".txt"), (".txt", ".csv", ".dat"), [options.file])
    profile = read(
        options.file,
        unit=options.unit,
        file_unit=options.file_unit,
        outwards=False if options.inwards else None,
        spacing=options.spacing,
        line=int(options.line) if (options.line or "").isdigit() else options.line,
        along=options.along,
        channel=options.channel,
        lambda_s=options.lambda_s,
        lambda_c=options.lambda_c,
    )
    for note in profile.notes:
        print(f"mfv: {note}", file=sys.stderr)
    heading = f"# {options.file.name}; recess: distance by which the surface recedes\nx [{profile.unit}] recess [{profile.unit}]\n"
    with written(path) as part, part.open("w", encoding="utf-8") as file:
        file.write(heading)
        np.savetxt(file, np.column_stack([profile.x, profile.height]), fmt="%.9g")
    gaps = int(np.sum(~np.isfinite(profile.height)))
    print(
        f"{path}: {profile.x.size} points over {np.ptp(profile.x):.4g} {profile.unit}{f', {gaps} without a value' if gaps else ''}"
    )
    print(f"&body shape='profile', file='{path}', rigid=.true. /")
