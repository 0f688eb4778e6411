"""python -m mfv new: a commented case to begin with."""

from __future__ import annotations

import argparse
from pathlib import Path

from .._files import target, written

NAME, HELP = "new", "a commented case from a template"

DESCRIPTION = """\
Write a case to begin with, from a template: every key that matters, with its meaning as a comment, those that can be
left out as comments with their values. Each can be solved as it is. Files that a template needs (a profile, a
matrix, the case of a study) are written beside it. Nothing that is there already is overwritten without --force.
"""

EXAMPLES = """\
examples:
  python -m mfv new                         write cylinder.nml
  python -m mfv new --list                  which templates there are
  python -m mfv new pin_in_bore -o joint.nml
  mfv_run joint.nml                         solve it
"""

DEFAULT = "cylinder"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What the command takes."""
    parser.add_argument("template", nargs="?", default=DEFAULT, metavar="TEMPLATE", help=f"see --list; {DEFAULT} unless told")
    parser.add_argument("-o", "--output", type=Path, metavar="CASE.nml", help="else TEMPLATE.nml, here")
    parser.add_argument("--list", action="store_true", help="print the templates, a line each")
    parser.add_argument("--force", action="store_true", help="overwrite what is there")


def run(options: argparse.Namespace) -> None:
    """Write, and say how to go on. Raises OSError, ValueError."""
    from .. import template

    if options.list:
        for name, meaning in template.names().items():
            print(f"{name:18}{meaning}")
        return
    path = target(options.output, Path(f"{options.template}.nml"), (".nml",), [])
    for place in template.write(options.template, path, written, options.force):
        print(place)
    print(f"solve it: {'python -m mfv study' if template.is_study(options.template) else 'mfv_run'} {path}")
