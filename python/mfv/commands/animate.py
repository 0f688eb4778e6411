"""python -m mfv animate: the load history as a moving picture."""

from __future__ import annotations

import argparse
from pathlib import Path

from .._files import target, written
from ..result import read
from .shared import add_output, at_least, solved_between

NAME, HELP = "animate", "the load history as a GIF or an MP4"

DESCRIPTION = """\
Draw the load history of a result as a moving picture: pressure, shear traction with stick and slip zones, and the curve
of force over displacement with a point that moves along it. A result keeps states at the ends of steps and at
reversals only; for those in between the case, which the file holds, is solved again with targets on the way, which
does not change its path (a note tells when the end differs). Without the library, or with --kept, the pictures are
those of the states in the file. An MP4 needs ffmpeg or the Python package imageio-ffmpeg; a GIF needs nothing more.
"""

EXAMPLES = """\
examples:
  python -m mfv animate shear_cycles.h5     write shear_cycles.gif
  python -m mfv animate shear_cycles.h5 -o cycles.mp4 --frames 300 --rate 30
  python -m mfv animate cycles.h5 --kept --rate 2
                                            a state of the file each half second
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What the command takes."""
    parser.add_argument("file", type=Path, metavar="RESULT.h5", help="result file")
    add_output(parser, "PICTURE", "gif or mp4; else RESULT.gif beside the file")
    parser.add_argument("--frames", type=at_least(2), default=120, metavar="N", help="about how many pictures (120)")
    parser.add_argument("--rate", type=at_least(1), default=20, metavar="N", help="pictures a second (20)")
    parser.add_argument("--kept", action="store_true", help="only the states in the file; solve nothing again")


def run(options: argparse.Namespace) -> None:
    """Solve, draw, write. Raises OSError, NotAResult, ValueError."""
    from tqdm import tqdm

    from ..animate import SUFFIXES, movie, save
    from ..load_history import kept_states, thinned

    result = read(options.file)
    output = target(options.output, options.file.with_suffix(".gif"), SUFFIXES, [options.file])
    if options.kept:
        shown = thinned(kept_states(result), options.frames)
    else:
        shown = solved_between(options, result, options.frames).result
    with written(output) as part, tqdm(total=len(shown.steps), desc="drawing", unit="picture", disable=None) as bar:
        save(movie(shown), part, options.rate, lambda frame, number: bar.update())
    print(output)
