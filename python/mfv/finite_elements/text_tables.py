"""Nodal values over time in texts: columns with names (CSV), also those exported from an odb of Abaqus, and Abaqus's field reports.

The package that reads an odb is Abaqus's own Python; what it exports are these texts.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ..tables import read_rows
from .deck import read_deck
from .record import Array, Columns, Record, chosen, on_surface

#: Names of columns, in lower case: times, sets, nodes and where they are.
_TIMES = ("time", "t", "total time", "frame")
_SETS = ("surface", "set", "instance", "part instance name")
_PLACES = {
    "node": ("node", "node label", "label"),
    "x": ("x", "coord-coor1", "coord.coor1", "coor1", "coord1"),
    "y": ("y", "coord-coor2", "coord.coor2", "coor2", "coord2"),
}

_TIME = re.compile(r"Time\s*=\s*([-+\d.Ee]+)")
_STEP = re.compile(r"^\s*Step:\s*(.+?)\s*$")
_BRACKET = re.compile(r"\s*[\[(][^\])]*[\])]\s*$")
_RULE = re.compile(r"^-{10,}\s*$")


# --- CSV ---


def read_csv(path: Path, surface: str | None, mesh: Path | None, columns: Columns | None) -> Record:
    """A row for every node and time. Columns: time (or Abaqus's Frame, with Step), x, y, node, surface, and values of `record.NAMES`.

    Without a column surface or set all rows are those of the surface; without x and y, positions are those of the nodes in the input deck
    `mesh`. Raises OSError, InputError, ValueError.
    """
    texts = _cells_of(path)
    names = {name.lower(): name for name in texts}
    of_set = next((names[name] for name in _SETS if name in names), None)
    keep = np.ones(len(next(iter(texts.values()))), dtype=bool)
    if of_set is not None:
        there = list(dict.fromkeys(texts[of_set]))
        if surface is None and len(there) > 1:
            raise ValueError(f"{path}: give the surface; the column {of_set} has {', '.join(there)}")
        keep = np.array([cell.upper() == (surface or there[0]).upper() for cell in texts[of_set]])
        if not keep.any():
            raise ValueError(f"{path}: no rows of '{surface}' in the column {of_set}; there are {', '.join(there)}")
    kept = {name: [cell for cell, is_kept in zip(cells, keep) if is_kept] for name, cells in texts.items()}
    of_time = next((names[name] for name in _TIMES if name in names), None)
    times = _times(path, kept[of_time], kept.get(names.get("step", ""))) if of_time else np.zeros(int(keep.sum()))
    values = {}
    for name, cells in kept.items():
        if name not in (of_set, of_time) and (numbers := _numbers(cells)) is not None:
            values[_meaning(name)] = numbers
    return _record(path, surface, mesh, columns, times, values)


def _cells_of(path: Path) -> dict[str, list[str]]:
    """The cells of every column by its name without a unit. Raises OSError, InputError, ValueError."""
    rows = read_rows(path, ())
    if not rows.lines:
        raise ValueError(
            f"{path}: no rows; needs a line with the names of the columns, such as time,x,pressure,shear, and rows of numbers"
        )
    table = [rows.cells(line) for line in rows.lines]
    names = [bare_name(name) for name in rows.names]
    return {name: [_cell(row[at], rows.decimal_comma) for row in table] for at, name in enumerate(names)}


def _cell(cell: str, decimal_comma: bool) -> str:
    """A cell without quotation marks, with a decimal point."""
    return (cell.replace(",", ".") if decimal_comma else cell).strip("\"' ")


def _numbers(cells: Sequence[str]) -> Array | None:
    """The cells as numbers; None if one of them is not."""
    try:
        return np.array([float(cell) for cell in cells])
    except ValueError:
        return None


def _times(path: Path, cells: Sequence[str], steps: Sequence[str] | None) -> Array:
    """The time of every row. Times of Abaqus's frames are those in their steps, which follow one another. Raises ValueError."""
    numbers = _numbers(cells)
    if numbers is not None:
        return numbers
    found = [_TIME.search(cell) for cell in cells]
    if None in found:
        raise ValueError(f"{path}: '{cells[found.index(None)]}' is not a time")
    return _total_times(steps or [""] * len(cells), [float(match[1]) for match in found if match])


def _total_times(steps: Sequence[str], within: Sequence[float]) -> Array:
    """Times from the beginning, of times in steps, by the names of the steps in their order."""
    ends: dict[str, float] = {}
    for step, time in zip(steps, within):
        ends[step] = max(ends.get(step, 0.0), time)
    starts = dict(zip(ends, np.cumsum([0.0, *ends.values()])))
    return np.array([starts[step] + time for step, time in zip(steps, within)])


def _record(
    path: Path, surface: str | None, mesh: Path | None, columns: Columns | None, times: Array, values: Mapping[str, Array]
) -> Record:
    """The record of rows, a row for every node and time. Raises ValueError."""
    frames = [np.nonzero(times == time)[0] for time in np.unique(times)]
    by_node = "node" in values
    if by_node:
        frames = [rows[np.argsort(values["node"][rows], kind="stable")] for rows in frames]
    same = values["node"] if by_node else values.get("x")
    first = frames[0]
    for rows in frames:
        if len(rows) != len(first) or (same is not None and not np.array_equal(same[rows], same[first])):
            raise ValueError(
                f"{path}: time {times[rows[0]]:g} has other nodes than the first one; every time needs a row for every node"
            )
    arrays = {
        name: np.array([column[rows] for rows in frames])
        for name, column in values.items()
        if name not in ("node", "x", "y", "time")
    }
    source = f"{path}, {surface}" if surface else str(path)
    fields = chosen(arrays, source, columns)
    every = np.unique(times)
    if "x" in values:
        x, y = values["x"][first], values["y"][first] if "y" in values else np.zeros(len(first))
        if len(np.unique(np.column_stack([x, y]), axis=0)) < len(first):
            raise ValueError(
                f"{path}: several rows of a time have the same position; every node once, a column time for several times"
            )
        return on_surface(source, np.column_stack([x, y]), [], list(range(len(first))), every, fields)
    if mesh is None or not by_node:
        raise ValueError(f"{path}: has no column x (or COORD.COOR1); add it, or a column node, with the input deck as mesh")
    deck = read_deck(mesh)
    place, position, elements = deck.mesh()
    numbers = [int(number) for number in values["node"][first]]
    missing = [number for number in numbers if number not in place]
    if missing:
        raise ValueError(f"{mesh}: does not have node {missing[0]} of {path}")
    return on_surface(source, position, elements, [place[number] for number in numbers], every, fields)


# --- field reports of Abaqus ---


def read_rpt(path: Path, surface: str | None, mesh: Path | None, columns: Columns | None) -> Record:
    """Field reports of Abaqus, one table of nodes for every frame, one after another in a file.

    Columns Node Label and, for instance, CPRESS, CSHEAR1, CNORMF.CNORMF1, S.S11, COORD.COOR1; without coordinates positions come from the
    input deck `mesh`. With `mesh`, `surface` is a set of it; else it names the file only. Raises OSError, ValueError.
    """
    frames = _frames_of(path)
    if not frames:
        raise ValueError(
            f"{path}: has no table of nodes (Node Label and values); write it by Report, Field Output, at Unique Nodal"
        )
    times = _total_times([frame.step for frame in frames], [frame.time for frame in frames])
    if (same := np.flatnonzero(np.diff(times) <= 0.0)).size:
        raise ValueError(f"{path}: two frames have the time {times[same[0]]:g}; omit one, or give a CSV with more digits of time")
    rows = np.concatenate([frame.rows for frame in frames])
    time_of_row = np.repeat(times, [len(frame.rows) for frame in frames])
    if mesh is not None and surface is not None:
        keep = np.isin(rows[:, 0], read_deck(mesh).numbers(surface))
        if not keep.any():
            raise ValueError(f"{path}: has no node of '{surface}' of {mesh}")
        rows, time_of_row = rows[keep], time_of_row[keep]
    values = {"node": rows[:, 0]} | {_meaning(name): rows[:, at] for at, name in enumerate(frames[0].names[1:], start=1)}
    return _record(path, surface, mesh, columns, time_of_row, values)


def _meaning(name: str) -> str:
    """node, x or y for a column of these, else its own name."""
    return next((axis for axis, names in _PLACES.items() if name.lower() in names), name)


class _Table(NamedTuple):
    """A table of a report: step, line of its frame, time in the step, names of the columns, a row for every node."""

    step: str
    frame: str
    time: float
    names: list[str]
    rows: Array


def _frames_of(path: Path) -> list[_Table]:
    """One table for every frame, of all its parts and regions. Raises ValueError."""
    frames: list[_Table] = []
    for table in _tables_of(path):
        if table.names != (frames or [table])[0].names:
            raise ValueError(f"{path}: its tables have different columns; write the same variables at all frames")
        if frames and frames[-1][:2] == table[:2]:
            table = table._replace(rows=np.concatenate([frames.pop().rows, table.rows]))
        frames.append(table)
    return [frame._replace(rows=_by_node(path, frame)) for frame in frames]


def _by_node(path: Path, frame: _Table) -> Array:
    """A row for every node, in their order. A node that several regions share is in the table of each. Raises ValueError."""
    rows: Array = frame.rows[np.argsort(frame.rows[:, 0], kind="stable")]
    first = np.concatenate([[True], np.diff(rows[:, 0]) > 0.0])
    differs = ~np.isclose(rows, rows[first][np.cumsum(first) - 1]).all(axis=1)
    if differs.any():
        raise ValueError(
            f"{path}: node {rows[differs][0, 0]:.0f} has several values at the time {frame.time:g} of {frame.step}: report one part only, "
            "averaged over all regions"
        )
    once: Array = rows[first]
    return once


def _tables_of(path: Path) -> list[_Table]:
    """The tables of a report as they stand there. Raises ValueError."""
    found: list[_Table] = []
    rows: list[list[list[float]]] = []
    step, frame, time, above, is_table = "", "", 0.0, ["", ""], False
    with path.open(encoding="latin-1") as file:
        for line in file:
            words = line.split()
            if match := _STEP.match(line):
                step = match[1]
            elif match := _TIME.search(line):
                frame, time = line.strip(), float(match[1])
            elif _RULE.match(line) and "label" in above[1].lower():
                found.append(_Table(step, frame, time, _names(above[0], 1 + above[1].count("@")), np.empty(0)))
                rows.append([])
                is_table = True
            elif _RULE.match(line) and is_table:
                raise ValueError(f"{path}: the rows of its tables are broken into several lines; write it with a wider page")
            elif is_table and words and words[0].isdigit() and len(words) == len(found[-1].names):
                rows[-1].append([float(word) for word in words])
            elif words:
                is_table = is_table and not rows[-1]
            above = [above[1], line] if words else above
    return [table._replace(rows=np.array(values)) for table, values in zip(found, rows) if values]


def _names(line: str, columns: int) -> list[str]:
    """The names of the columns: Node and variables. Behind those of contact there may be the names of the surfaces, after a blank."""
    parts = [part.split()[0] for part in re.split(r"\s{2,}", line.strip())]
    return parts if len(parts) == columns else line.split()


def bare_name(heading: str) -> str:
    """A heading without a unit in brackets."""
    return _BRACKET.sub("", heading).strip()
