"""python -m mfv info: what is in a result, in words and numbers."""

from __future__ import annotations

import argparse
from pathlib import Path

from ..result import Group, Result, kept, read

NAME, HELP = "info", "print what is in a result"

DESCRIPTION = """\
Print what is in a result, in words and numbers: how the run ended, its settings, loads and counts at the end, what is
read off the load history, the certificate, error bars and the sources of closed forms where there are any.
"""

EXAMPLES = """\
examples:
  python -m mfv info mindlin.h5             what is in it
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What the command takes."""
    parser.add_argument("file", type=Path, metavar="RESULT.h5", help="result file")


def run(options: argparse.Namespace) -> None:
    """Print. Raises OSError, NotAResult."""
    print(description(read(options.file)))


def description(result: Result) -> str:
    """A result in words and numbers, the input aside."""
    attributes = [f"{name:20}{value}" for name, value in result.attributes.items() if name != "input"]
    sources = [f"{name:20}{result.reference.description(name)}" for name in result.reference]
    blocks = [
        attributes,
        ["summary", *_lines(result.summary)],
        *([["observables", *_lines(result.observables)]] if result.observables else []),
        ["certificate", *_lines(result.certificate)],
        *([["sensitivity", *_lines(result.sensitivity)]] if result.sensitivity else []),
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
