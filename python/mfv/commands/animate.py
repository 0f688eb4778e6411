"""mfv animate: animate the load history."""

from __future__ import annotations

import argparse

from .._files import target, written
from ..result import read
from .shared import add_output, add_result, at_least, solved_between

NAME, HELP = "animate", "animate the load history as a GIF or an MP4"

DESCRIPTION = """\
Animate the load history of a result: pressure, shear traction with stick and slip zones, and force over displacement
with a moving point. A result has states only at step ends and reversals. For states in between the case, which the
file contains, is solved again with intermediate load targets; they do not change the solution (a note is printed if
the last state differs). With --kept, or without the library, only the states in the file are drawn. An MP4 needs
ffmpeg or the Python package imageio-ffmpeg.
"""

EXAMPLES = """\
examples:
  mfv animate shear_cycles.h5         write shear_cycles.gif
  mfv animate shear_cycles.h5 -o cycles.mp4 --frames 300 --rate 30
  mfv animate cycles.h5 --kept --rate 2
                                      the states of the file, two per second
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    add_result(parser)
    add_output(parser, "PICTURE", "gif or mp4 (default: RESULT.gif beside the file)")
    parser.add_argument("--frames", type=at_least(2), default=120, metavar="N", help="approximate number of frames (120)")
    parser.add_argument("--rate", type=at_least(1), default=20, metavar="N", help="frames per second (20)")
    parser.add_argument("--kept", action="store_true", help="draw only the states in the file; do not solve the case again")


def run(options: argparse.Namespace) -> None:
    """Solve the case for intermediate states, draw and write. Raises OSError, NotAResult, ValueError."""
    from tqdm import tqdm

    from ..animate import SUFFIXES, movie, save
    from ..load_history import kept_states, thinned

    result = read(options.file)
    output = target(options.output, options.file.with_suffix(".gif"), SUFFIXES, [options.file])
    states = kept_states(result) if options.kept else solved_between(options, result, options.frames).result
    shown = thinned(states, options.frames)
    with written(output) as part, tqdm(total=len(shown.steps), desc="drawing", unit="picture", disable=None) as bar:
        save(movie(shown), part, options.rate, lambda frame, number: bar.update())
    print(output)
