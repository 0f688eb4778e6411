"""Tables of measured loops."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping, Sequence
from numbers import Real
from typing import Any

import numpy as np

from .. import tables
from ..errors import MfvError, input_error
from .loop import Loop

#: Names of the columns of a table of measured loops, in lower case, and what they stand for.
MEANINGS = {
    "tangential_force": ("tangential_force", "q"),
    "shift": ("shift", "u"),
    "normal_force": ("normal_force", "p"),
    "test": ("test",),
    "time": ("time", "t"),
}

#: Units of a column of times, in lower case; one with another unit is a temperature or a thickness.
_TIMES = ("", "s", "sec", "second", "seconds", "ms", "us", "µs", "min", "minutes", "h", "hours", "d", "days", "cycles", "-")


def read(path: str | os.PathLike[str], **options: Any) -> list[Loop]:
    """The loops of a text file: columns Q, U and P (or tangential_force, shift, normal_force) under a line with their names, which may
    have units, as spreadsheets and programs write them (`mfv.tables`); a column `test` separates several tests, and `time` gives the
    times of rows, in numbers or as times of the day, with or without dates. `options`: those of `loops_of`.

    Raises OSError, InputError.
    """
    columns = _names_of(options.get("columns"))
    return _loops(tables.read_columns(path, columns, _optional(options)), **{"name": os.fspath(path), **options})


def loops_of(table: Any, **options: Any) -> list[Loop]:
    """The loops of a table: a mapping of columns, or a pandas.DataFrame.

    `columns`: names of columns (or for a file their numbers from 1) by their meaning, such as {'tangential_force': 'Fx', 'shift': 3}.
    `normal_force`: instead of a column P, force per thickness. `units`: units of columns by their meaning, if not in their names;
    numbers without any are taken as they are. `length_unit`, `force_unit` ('mm' and 'N'): those of the scene. `thickness`, in
    `length_unit`: divides columns that are forces. `sign`: factors of columns by their meaning, such as {'shift': -1}. Other options
    are those of every `Loop`. Raises InputError.
    """
    label = options.pop("name", "table")
    return _loops(tables.columns_of(table, label, _names_of(options.get("columns")), _optional(options)), name=label, **options)


def _optional(options: Mapping[str, Any]) -> list[str]:
    """The columns that may be absent, by their meaning."""
    return ["test", "time", *(["normal_force"] if options.get("normal_force") is not None else [])]


def _names_of(given: Mapping[str, str | int] | None) -> dict[str, Sequence[str] | int]:
    """Names of the columns of loops in lower case by their meaning. Raises InputError."""
    _check_meanings("columns", given)
    names: dict[str, Sequence[str] | int] = dict(MEANINGS)
    for meaning, name in (given or {}).items():
        if isinstance(name, bool) or not isinstance(name, (int, str)):
            raise input_error(f"columns: {meaning} must be the name of a column or its number from 1, not {name!r}")
        names[meaning] = name if isinstance(name, int) else (name.strip().lower(),)
    return names


def _check_meanings(option: str, given: Mapping[str, Any] | None) -> None:
    """Raises InputError for an option that is not a mapping of columns by their meaning."""
    for meaning in given or {}:
        if meaning not in MEANINGS:
            raise input_error(f"{option}: '{meaning}' is not one of {', '.join(MEANINGS)}")


def _check_values(option: str, given: Mapping[str, Any] | None, kind: type, what: str) -> None:
    """Raises InputError for an option that is not a mapping of columns by their meaning to values of a kind."""
    _check_meanings(option, given)
    for meaning, value in (given or {}).items():
        if not isinstance(value, kind):
            raise input_error(f"{option}: {meaning} must be {what}, not {value!r}")


def _unit_of(column: tables.Column, meaning: str, units: Mapping[str, str], usual: str) -> str:
    """The unit of a column, or ''; `usual` is for the advice. Raises InputError for one in brackets that is not known."""
    if meaning not in units and column.unit and not tables.known_unit(column.unit):
        raise input_error(f"{column.label}: unknown unit '{column.unit}'; say what it is, such as units={{'{meaning}': '{usual}'}}")
    return units.get(meaning, column.unit)


def _loops(
    found: Mapping[str, tables.Column],
    *,
    name: str,
    columns: Mapping[str, str | int] | None = None,  # of `found`
    normal_force: float | None = None,
    units: Mapping[str, str] | None = None,
    length_unit: str = "mm",
    force_unit: str = "N",
    thickness: float | None = None,
    sign: Mapping[str, float] | None = None,
    **options: Any,
) -> list[Loop]:
    """The loops in columns by their meaning; options as in `loops_of`. Raises InputError."""
    _check_values("units", units, str, "a unit, such as 'um'")
    _check_values("sign", sign, Real, "a factor, such as -1")
    if thickness is not None and not (isinstance(thickness, Real) and 0.0 < thickness < math.inf):
        raise input_error(f"thickness: must be a positive length in {length_unit}, not {thickness!r}")
    values = {}
    for meaning in ("tangential_force", "shift", "normal_force"):
        if meaning == "normal_force" and normal_force is not None:
            continue
        column = found[meaning]
        unit = _unit_of(column, meaning, units or {}, length_unit if meaning == "shift" else f"{force_unit}/{length_unit}")
        if meaning == "shift":
            scale = tables.factor(unit, length_unit, column.label) if unit else 1.0
        else:
            scale = _force_scale(column.label, unit or (force_unit if thickness else ""), length_unit, force_unit, thickness)
        values[meaning] = (sign or {}).get(meaning, 1.0) * scale * column.numbers()
    force, shift = values["tangential_force"], values["shift"]
    pressing = np.full(force.size, normal_force) if normal_force is not None else values["normal_force"]
    time = found.get("time")
    if "test" not in found:
        return [Loop(force, shift, pressing, name=name, **_times(time, slice(None)), **options)]  # type: ignore[arg-type]  # it takes the mean
    tests = np.asarray(found["test"].values)
    if tests.shape != force.shape:
        raise input_error(f"{found['test'].label} has {tests.size} rows; {found['tangential_force'].label} has {force.size}")
    if any(test is None or test == "" or test != test for test in tests.tolist()):
        raise input_error(f"{found['test'].label} has empty cells; give every row the name of its test")
    return [
        Loop(force[rows], shift[rows], pressing[rows], name=f"{name}: {test}", **_times(time, rows), **options)
        for test in dict.fromkeys(tests.tolist())
        for rows in [tests == test]
    ]


def _times(column: tables.Column | None, rows: Any) -> dict[str, Any]:
    """The times of the rows of a test, as keys of `Loop`; a note if they cannot be used. A column t with another unit is not time."""
    if column is None:
        return {}
    times = column.seconds()
    if times is None:
        if column.unit.lower() not in _TIMES:
            is_other = tables.name_of(column.name) == "t"
            return {} if is_other else {"notes": (f"{column.label} is not used: {column.unit} is not a unit of time",)}
        try:
            times = column.numbers()
        except MfvError as error:
            return {"notes": (f"{error} or a time of the day such as 12:03:04.5; the column is not used",)}
    times = times[rows]
    stops = np.flatnonzero(~(np.diff(times) > 0.0))
    if stops.size:
        place = np.arange(len(column.values))[rows][stops[0]] + 1
        return {"notes": (f"{column.label} is not used: it does not increase from row {place} to the next",)}
    return {"time": times}


def _force_scale(label: str, unit: str, length_unit: str, force_unit: str, thickness: float | None) -> float:
    """Forces per thickness of the scene per unit of a column. Raises InputError."""
    if not unit:
        return 1.0
    if tables.is_force(unit, label):
        if not thickness:
            raise input_error(
                f"{label}: is a force in {unit}, where the scene has forces per thickness; give the thickness in {length_unit}, "
                f"or the unit of the column if it is another, such as units={{'tangential_force': '{force_unit}/{length_unit}'}}"
            )
        return tables.factor(unit, force_unit, label) / thickness
    return tables.factor(unit, f"{force_unit}/{length_unit}", label)
