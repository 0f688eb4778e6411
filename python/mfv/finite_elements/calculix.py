"""Results of CalculiX: .frd (CGX format) and nodal forces in .dat; node sets come from the input deck.

They are read here since the packages that read .frd (ccx2paraview, pyvista-frd-reader) need VTK, of 200 MB, for a text in fixed columns,
and do not read .dat; meshio reads neither.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from .deck import Deck, read_deck
from .record import Columns, Element, Record, chosen, on_surface

#: Types of elements in .frd with nodes between the corners.
_QUADRATIC = (4, 5, 6, 8, 10)

_STATISTICS = re.compile(r"^\s*statistics for slave set\s+(\S+?),?\s+master set\s+\S+\s+and time\s+(\S+)", re.IGNORECASE)
_HEADING = re.compile(r"^\s*forces \(fx,fy,fz\) for set (\S+) and time\s+(\S+)", re.IGNORECASE)


class _Block(NamedTuple):
    """Values of nodes at a time: a block such as STRESS, with the names of its components."""

    time: float
    components: list[str]
    #: By number of node.
    values: dict[int, list[float]]


class _Frd(NamedTuple):
    nodes: dict[int, list[float]]
    elements: list[tuple[list[int], bool]]
    blocks: list[_Block]


# --- .frd ---


def read_frd(path: Path, surface: str | None, mesh: Path | None, columns: Columns | None) -> Record:
    """The contact tractions (CSTR of *CONTACT FILE), else the forces (RF of *NODE FILE), and the stresses at the nodes of a set.

    `mesh`: the input deck with the set; that beside the result if None. CalculiX has the tractions at the nodes of the slave surface, and
    forces where nodes are held, which are 0 where bodies touch. The tractions at nodes are extrapolated: on coarse meshes their sums are
    percents off, so the resultants in the .dat file beside the result (CF of *CONTACT PRINT) are read, too. Raises OSError, ValueError.
    """
    deck = _deck_of(path, mesh, "node sets")
    numbers = deck.numbers(surface)
    result = _frd(path)
    missing = [number for number in numbers if number not in result.nodes]
    if missing:
        raise ValueError(
            f"{path}: does not have node {missing[0]} of {surface}; give its own input deck as mesh, and use OUTPUT=2D"
        )
    times, arrays = _arrays(result.blocks, numbers)
    source = f"{path}, {surface}"
    fields = chosen(arrays, source, columns)
    place = {number: at for at, number in enumerate(result.nodes)}
    elements = [Element(tuple(place[node] for node in nodes), is_quadratic) for nodes, is_quadratic in result.elements]
    position = np.array(list(result.nodes.values()))
    record = on_surface(source, position, elements, [place[number] for number in numbers], times, fields)
    return record._replace(totals=_totals(path.with_suffix(".dat"), deck, numbers, times)) if "pressure" in fields else record


def _deck_of(path: Path, mesh: Path | None, what: str) -> Deck:
    """The input deck of a result. Raises OSError, ValueError."""
    place = mesh or path.with_suffix(".inp")
    if not place.is_file():
        raise FileNotFoundError(f"{path}: has no {what}; give its input deck as mesh: {place} does not exist")
    return read_deck(place)


def _arrays(blocks: Sequence[_Block], numbers: Sequence[int]) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Times, and the values at nodes by component, arrays (times, nodes), of the components that there are at all times."""
    found: dict[str, dict[float, list[float]]] = {}
    for block in blocks:
        if all(number in block.values for number in numbers):
            for at, name in enumerate(block.components):
                found.setdefault(name, {})[block.time] = [block.values[number][at] for number in numbers]
    times = sorted(set().union(*(set(rows) for rows in found.values())))
    if any(list(rows) == times[:-1] for rows in found.values()):  # the last time is not complete
        times.pop()
    complete = {name: rows for name, rows in found.items() if set(times) <= set(rows)}
    return np.array(times), {name: np.array([rows[time] for time in times]) for name, rows in complete.items()}


def _frd(path: Path) -> _Frd:
    """Nodes, elements and blocks of results. Raises OSError, ValueError."""
    reader = _FrdReader()
    for number, line in enumerate(_lines(path), start=1):
        try:
            reader.take(line)
        except (ValueError, IndexError) as error:
            raise ValueError(f"{path}:{number}: not a line of a formatted .frd file: {error}") from None
    if not reader.result.blocks:
        raise ValueError(f"{path}: has no results of nodes, or is not a .frd file")
    return reader.result


class _FrdReader:
    """Takes the lines of a .frd file by turns; the first columns say what a line has."""

    def __init__(self) -> None:
        self.result = _Frd({}, [], [])
        self.part, self.digits, self.time = "", 10, 0.0
        self.last = [0.0]

    def take(self, line: str) -> None:
        """Take a line. Raises ValueError, IndexError."""
        key = line[:3]
        if line[:6].strip() in ("2C", "3C", "100C"):
            self._begin(line)
        elif key == " -4":
            self.result.blocks.append(_Block(self.time, [], {}))
        elif key == " -5" and line[5:13].strip() != "ALL":  # magnitudes are not stored
            self.result.blocks[-1].components.append(line[5:13].strip())
        elif key in (" -1", " -2") and self.part == "3C":
            self._take_element(key, line)
        elif key == " -1":
            values = self.result.nodes if self.part == "2C" else self.result.blocks[-1].values
            self.last = values[int(line[3 : 3 + self.digits])] = _reals(line, self.digits)
        elif key == " -2":
            self.last += _reals(line, self.digits)

    def _begin(self, line: str) -> None:
        """A heading of nodes, elements or results; its last letter says how many digits numbers of nodes have."""
        if line[-1] not in "01":
            raise ValueError("it is binary; write a formatted one")
        self.part, self.digits = line[:6].strip(), 10 if line[-1] == "1" else 5
        if self.part == "100C":
            self.time = float(line[12:24])

    def _take_element(self, key: str, line: str) -> None:
        if key == " -1":
            self.result.elements.append(([], int(line[3 + self.digits : 8 + self.digits]) in _QUADRATIC))
        else:
            nodes = (int(line[at : at + self.digits]) for at in range(3, len(line), self.digits))
            self.result.elements[-1][0].extend(nodes)


def _lines(path: Path) -> Iterator[str]:
    with path.open(encoding="latin-1", newline="\n") as file:
        for line in file:
            yield line.rstrip()


def _reals(line: str, digits: int) -> list[float]:
    return [float(line[at : at + 12]) for at in range(3 + digits, len(line), 12)]


# --- .dat ---


def read_dat(path: Path, surface: str | None, mesh: Path | None, columns: Columns | None) -> Record:
    """The nodal forces of a set (*NODE PRINT with RF); positions come from the input deck, as for .frd. Raises OSError, ValueError."""
    deck = _deck_of(path, mesh, "positions of nodes")
    source = f"{path}, {surface}"
    frames = _forces(path, surface)
    numbers = list(frames[0][1])
    uneven = next((time for time, values in frames if list(values) != numbers), None)
    if uneven is not None:
        raise ValueError(f"{source}: the forces at time {uneven:g} are at other nodes than the first ones")
    place, position, elements = deck.mesh()
    missing = [number for number in numbers if number not in place]
    if missing:
        raise ValueError(f"{deck.path}: does not have node {missing[0]} of {path}")
    forces = np.array([list(values.values()) for _, values in frames])
    fields = chosen({"fx": forces[..., 0], "fy": forces[..., 1]}, source, columns)
    return on_surface(source, position, elements, [place[number] for number in numbers], np.array([t for t, _ in frames]), fields)


def _totals(path: Path, deck: Deck, numbers: Sequence[int], times: np.ndarray) -> np.ndarray | None:
    """Forces along x and y on the body of a slave surface with these nodes, and their moment about the origin, (times, 3); None if the file,
    or a time, is missing. Raises OSError, ValueError."""
    if not path.is_file():
        return None
    found: dict[float, list[float]] = {}
    lines = (line for line in _lines(path) if line)
    for line in lines:
        heading = _STATISTICS.match(line)
        if heading and heading[1].upper() in deck.surfaces and set(deck.numbers(heading[1])) == set(numbers):
            next(lines)
            row = [float(word) for word in next(lines).split()]
            found[float(heading[2])] = [row[0], row[1], row[5]]
    if not found:
        return None
    known = np.array(list(found))
    nearest = [int(np.argmin(np.abs(known - time))) for time in times]
    if np.any(np.abs(known[nearest] - times) > 1e-4 * np.max(np.abs(times))):
        return None
    return np.array(list(found.values()))[nearest]


def _forces(path: Path, surface: str | None) -> list[tuple[float, dict[int, list[float]]]]:
    """Times, and forces by number of node, of a set. Raises OSError, ValueError."""
    frames: list[tuple[float, dict[int, list[float]]]] = []
    names: dict[str, None] = {}
    is_wanted = False
    for line in _lines(path):
        heading, words = _HEADING.match(line), line.split()
        if heading:
            names[heading[1].upper()] = None
            is_wanted = heading[1].upper() == (surface or "").upper()
            if is_wanted:
                frames.append((float(heading[2]), {}))
        elif words and not (len(words) == 4 and words[0].isdigit()):
            is_wanted = False
        elif words and is_wanted:
            frames[-1][1][int(words[0])] = [float(word) for word in words[1:]]
    if not frames or not frames[0][1]:
        advice = "print them: *NODE PRINT, NSET=... and RF"
        raise ValueError(
            f"{path}: no nodal forces of a set '{surface}'; there are those of {', '.join(names) or 'no set'}; {advice}"
        )
    return frames
