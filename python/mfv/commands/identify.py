"""mfv identify: parameters of a scene from measured loops."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from .._files import PICTURES, target, written
from ..errors import MfvError
from ..identify.priors import NAMES, Priors
from ..scene import Scene
from .completion import complete_files
from .shared import add_output, number

NAME, HELP = "identify", "estimate parameters of a case from measured loops"

DESCRIPTION = """\
Estimate parameters of a case from measured loops of tangential force over shift: values, standard errors, intervals,
correlations, warnings, and a picture of loops and residuals. Lag, drift and offset of the rig are estimated too. The
loops are the columns Q, U and P of a text file, and test if there are several, under a line with their names; units in
the names are converted to those of &scene (mm and N without length_unit and force_unit). Parameters are keys of the
case, and rig_stiffness. Needs scipy. See docs/identify.md.
"""

EXAMPLES = """\
examples:
  mfv identify rig.nml loops.csv --free friction%mu=0.6 --free rig_stiffness=5e4
                                      print the estimate, draw loops.png
  mfv identify rig.nml loops.csv --free friction%mu=0.6 --shift large
                                      the machine prescribes the shift in test 'large'
  mfv identify rig.nml daq.txt --free friction%mu=0.6 --column shift=LVDT --unit shift=um --thickness 8
                                      columns of other names and units; forces, not forces per thickness
"""


class _Pairs(argparse.Action):
    """Collects pairs of a name and a value; a name given twice is an error."""

    def __call__(
        self, parser: argparse.ArgumentParser, namespace: argparse.Namespace, pair: Any, option: str | None = None
    ) -> None:
        pairs = getattr(namespace, self.dest)
        if pair[0] in dict(pairs):
            raise argparse.ArgumentError(self, f"{pair[0]} is given twice")
        setattr(namespace, self.dest, [*pairs, pair])


def _free(text: str) -> tuple[str, float]:
    """A parameter and its start value. Raises ArgumentTypeError."""
    name, _, value = text.partition("=")
    try:
        return name.strip(), float(value)
    except ValueError:
        raise argparse.ArgumentTypeError(f"must be KEY=START such as friction%mu=0.6, not '{text}'") from None


def _pair(text: str) -> tuple[str, str]:
    """The meaning of a column and what is given for it. Raises ArgumentTypeError."""
    meaning, _, value = text.partition("=")
    if not value.strip():
        raise argparse.ArgumentTypeError(f"must be COLUMN=VALUE such as shift=um, not '{text}'")
    return _meaning(meaning.strip()), value.strip()


def _meaning(text: str) -> str:
    """The meaning of a column. Raises ArgumentTypeError."""
    from ..identify.reading import MEANINGS

    if text not in MEANINGS:
        raise argparse.ArgumentTypeError(f"'{text}' is not the meaning of a column: must be {', '.join(MEANINGS)}")
    return text


def _prior(text: str) -> tuple[str, float]:
    """A systematic error of the rig and the width of its prior. Raises ArgumentTypeError."""
    name, _, value = text.partition("=")
    try:
        Priors(**{name.strip(): float(value)})
        return name.strip(), float(value)
    except (TypeError, ValueError, MfvError):
        raise argparse.ArgumentTypeError(
            f"must be NAME=WIDTH such as slack=0.02 with NAME {', '.join(NAMES)}, not '{text}'"
        ) from None


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    complete_files(parser.add_argument("file", type=Path, metavar="CASE.nml", help="case; its steps are not used"), "nml")
    complete_files(parser.add_argument("other", type=Path, metavar="LOOPS.csv", help="measured loops"), "csv")
    parser.add_argument(
        "--free",
        type=_free,
        action=_Pairs,
        default=[],
        required=True,
        metavar="KEY=START",
        help="a parameter and its start value; repeat it",
    )
    parser.add_argument(
        "--shift", action="append", default=[], metavar="TEST", help="test in which the shift is prescribed; repeat it"
    )
    columns = "tangential_force, shift, normal_force, test, time"
    parser.add_argument(
        "--column",
        type=_pair,
        action=_Pairs,
        default=[],
        metavar="C=NAME",
        help=f"name of a column in the file, or its number from 1; C: {columns}",
    )
    parser.add_argument("--unit", type=_pair, action=_Pairs, default=[], metavar="C=UNIT", help="unit of a column in the file")
    parser.add_argument("--reverse", type=_meaning, action="append", default=[], metavar="C", help="change the sign of a column")
    parser.add_argument("--thickness", type=number, metavar="LENGTH", help="divides columns that are forces")
    parser.add_argument(
        "--prior",
        type=_prior,
        action=_Pairs,
        default=[],
        metavar="NAME=WIDTH",
        help="standard deviation of lag [degrees], drift, offset or slack [parts of half the range], 0 for none; repeat it",
    )
    add_output(parser, "PICTURE", "png, pdf, svg or eps (default: LOOPS.png beside the loops)")


def run(options: argparse.Namespace) -> None:
    """Fit, print, draw. Raises OSError, InputError, ValueError, ModuleNotFoundError."""
    from ..identify import fit, read

    scene = Scene.from_file(options.file)
    loops = read(
        options.other,
        columns={meaning: int(name) if name.isdecimal() else name for meaning, name in options.column},
        units=dict(options.unit),
        sign=dict.fromkeys(options.reverse, -1.0),
        thickness=options.thickness,
        length_unit=scene.length_unit or "mm",
        force_unit=scene.force_unit or "N",
    )
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
