"""python -m mfv identify: parameters of a scene from measured loops."""

from __future__ import annotations

import argparse
from pathlib import Path

from .._files import PICTURES, target, written
from ..errors import InputError
from ..identify.priors import NAMES, Priors
from ..scene import Scene
from .completion import complete_files
from .shared import add_output

NAME, HELP = "identify", "estimate parameters of a case from measured loops"

DESCRIPTION = """\
Estimate parameters of a case from measured loops of tangential force over shift: values, standard errors, intervals,
correlations, warnings, and a picture of loops and residuals. Lag, drift and offset of the rig are estimated too. The
loops are comma-separated columns Q, U and P, and test if there are several, under a line with their names. Parameters
are keys of the case, and rig_stiffness. Needs scipy. See docs/identify.md.
"""

EXAMPLES = """\
examples:
  python -m mfv identify rig.nml loops.csv --free friction%mu=0.6 --free rig_stiffness=5e4
                                            print the estimate, draw loops.png
  python -m mfv identify rig.nml loops.csv --free friction%mu=0.6 --shift large
                                            the machine prescribes the shift in test 'large'
"""


def _free(text: str) -> tuple[str, float]:
    """A parameter and its start value. Raises ArgumentTypeError."""
    name, _, value = text.partition("=")
    try:
        return name.strip(), float(value)
    except ValueError:
        raise argparse.ArgumentTypeError(f"must be KEY=START such as friction%mu=0.6, not '{text}'") from None


def _prior(text: str) -> tuple[str, float]:
    """A systematic error of the rig and the width of its prior. Raises ArgumentTypeError."""
    name, _, value = text.partition("=")
    try:
        Priors(**{name.strip(): float(value)})
        return name.strip(), float(value)
    except (TypeError, ValueError, InputError):
        raise argparse.ArgumentTypeError(
            f"must be NAME=WIDTH such as slack=0.02 with NAME {', '.join(NAMES)}, not '{text}'"
        ) from None


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    complete_files(parser.add_argument("file", type=Path, metavar="CASE.nml", help="case; its steps are not used"), "nml")
    complete_files(parser.add_argument("other", type=Path, metavar="LOOPS.csv", help="measured loops"), "csv")
    parser.add_argument(
        "--free", type=_free, action="append", required=True, metavar="KEY=START", help="a parameter and its start value; repeat it"
    )
    parser.add_argument(
        "--shift", action="append", default=[], metavar="TEST", help="test in which the shift is prescribed; repeat it"
    )
    parser.add_argument(
        "--prior",
        type=_prior,
        action="append",
        default=[],
        metavar="NAME=WIDTH",
        help="standard deviation of lag [degrees], drift, offset or slack [parts of half the range], 0 for none; repeat it",
    )
    add_output(parser, "PICTURE", "png, pdf, svg or eps (default: LOOPS.png beside the loops)")


def run(options: argparse.Namespace) -> None:
    """Fit, print, draw. Raises OSError, InputError, ValueError, ModuleNotFoundError."""
    from ..identify import fit, read

    scene, loops = Scene.from_file(options.file), read(options.other)
    tests = {loop.name.rpartition(": ")[2]: loop for loop in loops}
    for test in options.shift:
        if test not in tests:
            raise ValueError(f"{options.other}: no test '{test}'; there are {', '.join(tests)}")
        tests[test].drive = "shift"
    picture = target(options.output, options.other.with_suffix(".png"), PICTURES, [options.file, options.other])
    fitted = fit(scene, loops, dict(options.free), priors=Priors(**dict(options.prior)))
    print(fitted)
    with written(picture) as part:
        fitted.figure().savefig(part, dpi=150)
    print(f"\n{picture}")
