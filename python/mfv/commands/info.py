"""mfv info: print the contents of a result or of the table of a study."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from .._html import unit
from .._packages import require
from ..result import COORDINATES, LISTS, Group, Result, doubt, kept, read
from ..studies.plan import is_table
from .completion import complete_files

if TYPE_CHECKING:
    import xarray

NAME, HELP = "info", "print the contents of a result or of the table of a study"

DESCRIPTION = """\
Print the contents of a result: outcome, settings, loads and node counts at the end, observables of the load history,
certificate, error estimates and sources of closed forms if there are any; or the rows of one of its tables, with commas.
For the table of a study: its columns with values, units and meanings.
"""

EXAMPLES = """\
examples:
  mfv info mindlin.h5                 a result
  mfv info case.h5 --rows cycles      a row for every cycle
  mfv info case.h5 --rows cycles >cycles.csv
  mfv info study.nc                   columns of a table
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    file = parser.add_argument("file", type=Path, metavar="RESULT.h5", help="result file, or table of a study (.nc)")
    complete_files(file, "h5", "nc")
    parser.add_argument("--rows", choices=LISTS, help="print the rows of this table of a result, in the units of the case")


def run(options: argparse.Namespace) -> None:
    """Print. Raises OSError, ValueError, NotAResult."""
    if is_table(options.file):
        if options.rows is not None:
            raise ValueError(f"{options.file}: the table of a study has no --rows; 'mfv study' writes it as .csv, too")
        require("xarray", "h5netcdf")
        import xarray  # here, since results are read without it

        with xarray.open_dataset(options.file, engine="h5netcdf") as table:
            print(columns_of(table))
        return
    result = read(options.file)
    print(description(result) if options.rows is None else rows_of(result, options.rows))


def rows_of(result: Result, name: str) -> str:
    """A table of a result as text with commas: a line of names, and a line for each row. Raises ValueError if it has none."""
    group = getattr(result, name)
    if not group:
        raise ValueError(f"the result has no {name}")
    (row,) = COORDINATES[name]
    names = [row, *(column for column in group if column != row and group.dimensions(column) == (row,))]
    rows = zip(*(group[column].tolist() for column in names), strict=True)
    return "\n".join(",".join(map(str, line)) for line in [names, *rows])


def columns_of(table: xarray.Dataset) -> str:
    """The axes and columns of a study's table, one per line: values, unit, meaning."""
    named = [*(table[name] for name in table.coords), *table.data_vars.values()]
    lines = []
    for one in named:
        shown_unit, meaning = unit(one.attrs.get("units", "1")), one.attrs.get("long_name", "")
        lines.append(f"  {one.name!s:28}{_values(one.values):34}{shown_unit:16}{meaning}")
    sizes = " x ".join(f"{size} {name}" for name, size in table["case"].sizes.items())
    return "\n".join([f"{table['case'].size} cases: {sizes}", *(line.rstrip() for line in lines)])


def _values(values: np.ndarray) -> str:
    """The values of an array: its text or the number of texts, or the range of its numbers."""
    if values.dtype.kind not in "biuf":
        different = sorted(set(map(str, values.flat)))
        return different[0][:32] if len(different) == 1 else f"{len(different)} different"
    finite = values[np.isfinite(values)]
    if finite.size == 0:
        return "none"
    missing = values.size - finite.size
    return f"{finite.min():.6g} to {finite.max():.6g}" + (f", {missing} none" if missing else "")


def description(result: Result) -> str:
    """All numbers of a result and their meanings, without the input."""
    attributes = [f"{name:20}{value}" for name, value in result.attributes.items() if name != "input"]
    sources = [f"{name:20}{result.reference.description(name)}" for name in result.reference]
    groups = {name: getattr(result, name) for name in ("summary", "observables", "certificate", "sensitivity")}
    blocks = [
        attributes,
        *([name, *_lines(result, group)] for name, group in groups.items() if group),
        *([["error estimate", *_bars(result.error_estimate)]] if result.error_estimate else []),
        ["closed form", *(f"  {line}" for line in sources)] if sources else ["closed form: none"],
        [f"{result.mesh.x.size} nodes, {kept(result)}"],
    ]
    return "\n\n".join("\n".join(block) for block in blocks)


def _lines(result: Result, group: Group) -> list[str]:
    """The scalars of a group of a result, one per line."""
    return [
        f"  {name:25} {group[name]:<14.6g}{unit(group.unit(name)):16}{group.description(name)}{doubt(result, name)}"
        for name in group
    ]


def _bars(estimate: Group) -> list[str]:
    """The quantities of an error estimate with their error bars, one per line."""
    names = [name for name in estimate if f"{name}_error" in estimate]
    return [
        f"  {name:25} {estimate[name]:<14.6g}+- {estimate[name + '_error']:<11.2g}{unit(estimate.unit(name)):16}"
        f"order {estimate[name + '_order']:.2g}"
        for name in names
    ]
