"""Tables of measured loops."""

from __future__ import annotations

import math
import os
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import input_error
from .loop import Loop

Array = NDArray[np.float64]

#: Names of the columns of a table of measured loops, in lower case, and what they stand for.
_COLUMNS = {
    "tangential_force": ("tangential_force", "q"),
    "shift": ("shift", "u"),
    "normal_force": ("normal_force", "p"),
    "test": ("test",),
}


def read(path: str | os.PathLike[str], **options: Any) -> list[Loop]:
    """The loops of a text file with comma-separated columns Q, U and P (or tangential_force, shift, normal_force) under a line with
    their names; a column `test` separates several tests. Lines beginning with # are comments. `options`: those of every `Loop`.

    Raises OSError, InputError.
    """
    name = os.fspath(path)
    try:
        with open(path, encoding="utf-8") as file:
            lines = [text for line in file if (text := line.partition("#")[0].strip())]
    except UnicodeDecodeError:
        raise input_error(f"{name}: not a text file in UTF-8") from None
    names, *rows = [[cell.strip() for cell in line.split(",")] for line in lines] or [[]]
    if not rows:
        raise input_error(f"{name}: no rows; needs a line with the names of the columns, such as Q,U,P, and rows of numbers")
    if any(len(row) != len(names) for row in rows):
        raise input_error(f"{name}: not a table: its rows have different numbers of comma-separated columns")
    return loops_of(dict(zip(names, zip(*rows))), **{"name": name, **options})


def loops_of(table: Any, **options: Any) -> list[Loop]:
    """The loops of a table: a mapping of columns, or a pandas.DataFrame; columns and options as in `read`. Raises InputError."""
    label = options.pop("name", "table")
    found = {str(name).strip().lower(): name for name in (table.columns if hasattr(table, "columns") else table)}
    columns = {meaning: next((found[name] for name in names if name in found), None) for meaning, names in _COLUMNS.items()}
    missing = [names[-1].upper() for meaning, names in _COLUMNS.items() if columns[meaning] is None and meaning != "test"]
    if missing:
        raise input_error(f"{label}: no column {', '.join(missing)}; there are {', '.join(map(str, found.values())) or 'none'}")
    force, shift, pressing = (
        _numbers(table[columns[name]], f"{label}: column {columns[name]}") for name in ("tangential_force", "shift", "normal_force")
    )
    if columns["test"] is None:
        return [Loop(force, shift, pressing, name=label, **options)]  # type: ignore[arg-type]  # it takes the mean
    tests = np.asarray(table[columns["test"]])
    if "" in tests.tolist():
        raise input_error(f"{label}: column {columns['test']} has empty cells; give every row the name of its test")
    return [
        Loop(force[tests == test], shift[tests == test], pressing[tests == test], name=f"{label}: {test}", **options)
        for test in dict.fromkeys(tests.tolist())
    ]


def _numbers(values: Any, column: str) -> Array:
    """The numbers of a column; NaN for an empty cell. Raises InputError."""
    numbers = []
    for value in np.atleast_1d(np.asarray(values)).tolist():
        try:
            numbers.append(math.nan if value is None or value == "" else float(value))
        except (TypeError, ValueError):
            raise input_error(f"{column}: {value!r} is not a number") from None
    return np.array(numbers)
