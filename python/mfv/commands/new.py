"""mfv new: write a commented case from a template."""

from __future__ import annotations

import argparse
from collections.abc import Collection
from pathlib import Path

from .. import template
from .._files import target, written
from .completion import complete_files, complete_words

NAME, HELP = "new", "write a commented case from a template"

DESCRIPTION = """\
Write a case from a template. A comment explains each key; optional keys are comments with their default values. Every
template can be solved as it is. Files that a template needs (a profile, a matrix, the case of a study) are written
beside it. Existing files are overwritten only with --force.
"""

EXAMPLES = """\
examples:
  mfv new                             write cylinder.nml
  mfv new joint.nml                   write the default template to joint.nml
  mfv new --list                      list the templates
  mfv new pin_in_bore -o joint.nml
                                      write another template
  mfv run joint.nml                   solve it
"""

DEFAULT = "cylinder"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    chosen = parser.add_argument(
        "template",
        nargs="?",
        default=DEFAULT,
        metavar="TEMPLATE",
        help=f"name of a template, see --list ({DEFAULT} by default); a name that ends in .nml is the file to write",
    )
    complete_words(chosen, template.names)
    output = parser.add_argument("-o", "--output", type=Path, metavar="CASE.nml", help="file to write (default: TEMPLATE.nml)")
    complete_files(output, "nml")
    parser.add_argument("--list", action="store_true", help="list the templates")
    parser.add_argument("--force", action="store_true", help="overwrite existing files")


def run(options: argparse.Namespace) -> None:
    """Write the case and print how to solve it. Raises OSError, ValueError."""
    if options.list:
        for name, meaning in template.names().items():
            print(f"{name:18}{meaning}")
        return
    name, path = _template_and_file(options.template, options.output, template.names())
    path = target(path, Path(f"{name}.nml"), (".nml",), [])
    for place in template.write(name, path, written, options.force):
        print(place)
    print(f"solve it: {'mfv study' if template.is_study(name) else 'mfv run'} {path}")


def _template_and_file(chosen: str, output: Path | None, names: Collection[str]) -> tuple[str, Path | None]:
    """The template and the file to write. CASE.nml in place of a template: the template of that name, else the default one."""
    if not chosen.endswith(".nml"):
        return chosen, output
    path = Path(chosen)
    name = path.stem if path.stem in names else DEFAULT
    if output is not None:
        raise ValueError(f"'{chosen}' is a file name and -o gives another; write 'mfv new {name} -o {output}'")
    return name, path
