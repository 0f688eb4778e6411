"""Nodes, elements, node sets and surfaces of an input deck, .inp, of CalculiX or Abaqus.

It is read here because meshio 5.3 does not know plane-strain elements (CPE4) and skips surfaces.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from .record import Array, Element

#: Sets by their names in upper case: numbers of nodes or elements.
Sets = dict[str, list[int]]
Rows = list[list[str]]

#: Families of elements, with the numbers of corners by those of nodes: plane and axisymmetric ones, and solids.
_PLANE = {3: 3, 4: 4, 6: 3, 8: 4, 9: 4}
_SOLID = {4: 4, 6: 6, 8: 8, 10: 4, 15: 6, 20: 8, 27: 8}
_KIND = re.compile(r"(C3D|F3D|CPE|CPS|CAX|CPEG|M2D|S)(\d+)")

#: Corners of the sides S1, S2, ... of a solid, by its number of corners.
_SIDES = {
    8: ((0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)),
    6: ((0, 1, 2), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)),
    4: ((0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)),
}


@dataclass
class Deck:
    """What an input deck has; nodes and elements by their numbers, sets by their names in upper case."""

    path: Path
    nodes: dict[int, list[float]] = field(default_factory=dict)
    elements: dict[int, Element] = field(default_factory=dict)
    solids: set[int] = field(default_factory=set)
    node_sets: Sets = field(default_factory=dict)
    element_sets: Sets = field(default_factory=dict)
    surfaces: dict[str, Rows] = field(default_factory=dict)

    def numbers(self, surface: str | None) -> list[int]:
        """The numbers of the nodes of a set or surface. Raises ValueError."""
        listed = ", ".join(sorted({*self.node_sets, *self.surfaces})) or "none"
        if surface is None:
            raise ValueError(f"{self.path}: give the node set or surface; there are {listed}")
        name = surface.upper()
        found = self._of_surface(name) if name in self.surfaces else self.node_sets.get(name, [])
        if not found:
            raise ValueError(f"{self.path}: no node set or surface '{surface}'; there are {listed}")
        missing = [number for number in found if number not in self.nodes]
        if missing:
            raise ValueError(f"{self.path}: node {missing[0]} of {surface} does not exist")
        return list(dict.fromkeys(found))

    def mesh(self) -> tuple[dict[int, int], Array, list[Element]]:
        """The place of every number of a node, positions (nodes, 3), and elements with places of nodes."""
        place = {number: at for at, number in enumerate(self.nodes)}
        elements = [
            Element(tuple(place[node] for node in nodes), is_quadratic)
            for nodes, is_quadratic in self.elements.values()
            if all(node in place for node in nodes)
        ]
        return place, np.array(list(self.nodes.values())), elements

    def _of_surface(self, name: str) -> list[int]:
        """The nodes of a surface of nodes, node sets, or sides of elements. Raises ValueError."""
        found: list[int] = []
        for first, side, *_ in (row + [""] for row in self.surfaces[name]):
            if re.fullmatch(r"S\d", side.upper()):
                for number in _members([[first]], self.element_sets):
                    found += self._of_side(name, number, int(side[1]))
            else:
                found += _members([[first]], self.node_sets)
        return found

    def _of_side(self, name: str, number: int, side: int) -> list[int]:
        """The corners on a side of an element, and the node between those of a plane one. Raises ValueError."""
        if number not in self.elements:
            raise ValueError(f"{self.path}: element {number} of {name} does not exist")
        nodes, is_quadratic = self.elements[number]
        is_solid = number in self.solids
        corners = (_SOLID if is_solid else _PLANE)[len(nodes)]
        sides = _SIDES[corners] if is_solid else [(at, (at + 1) % corners) for at in range(corners)]
        if not 1 <= side <= len(sides):
            raise ValueError(f"{self.path}: element {number} of {name} has no side S{side}")
        found = [nodes[corner] for corner in sides[side - 1]]
        return found + [nodes[corners + side - 1]] if is_quadratic and not is_solid else found


def read_deck(path: Path) -> Deck:
    """An input deck, with the files that it includes. Raises OSError, ValueError."""
    deck = Deck(path)
    for keyword, options, rows in _cards(path):
        try:
            _add(deck, keyword, options, rows)
        except (ValueError, IndexError) as error:
            raise ValueError(f"{path}: *{keyword}: {error}") from None
    return deck


def _add(deck: Deck, keyword: str, options: dict[str, str], rows: Rows) -> None:
    """Adds a card. Raises ValueError, IndexError."""
    if keyword == "NODE":
        numbers = [_add_node(deck, row) for row in rows]
        _extend(deck.node_sets, options.get("NSET"), numbers)
    elif keyword == "ELEMENT":
        _extend(deck.element_sets, options.get("ELSET"), _add_elements(deck, options.get("TYPE", ""), rows))
    elif keyword in ("NSET", "ELSET"):
        sets = deck.node_sets if keyword == "NSET" else deck.element_sets
        _extend(sets, options.get(keyword), _ranges(rows) if "GENERATE" in options else _members(rows, sets))
    elif keyword == "SURFACE" and "NAME" in options:
        deck.surfaces[options["NAME"]] = rows


def _extend(sets: Sets, name: str | None, numbers: list[int]) -> None:
    if name:
        sets.setdefault(name, []).extend(numbers)


def _add_node(deck: Deck, row: list[str]) -> int:
    number, position = int(row[0]), ([float(cell) for cell in row[1:4] if cell] + [0.0, 0.0, 0.0])[:3]
    if deck.nodes.setdefault(number, position) != position:
        raise ValueError(f"node {number} occurs twice, in two parts or instances; write a flat input file")
    return number


def _add_elements(deck: Deck, kind: str, rows: Rows) -> list[int]:
    """Adds elements, whose rows may continue in the next; the numbers of those that are known."""
    known = _KIND.match(kind)
    corners = {} if known is None else _SOLID if known[1] in ("C3D", "F3D") else _PLANE
    size = int(known[2]) if known else 0
    if size not in corners:
        return []
    cells = [int(cell) for row in rows for cell in row if cell]
    numbers = cells[:: size + 1]
    for at, number in enumerate(numbers):
        start = at * (size + 1) + 1
        deck.elements[number] = Element(tuple(cells[start : start + size]), corners[size] < size)
    if corners is _SOLID:
        deck.solids.update(numbers)
    return numbers


def _ranges(rows: Rows) -> list[int]:
    """The numbers of sets with GENERATE: first, last, step."""
    found: list[int] = []
    for row in rows:
        first, last, *step = (int(cell) for cell in row if cell)
        found += range(first, last + 1, *step)
    return found


def _members(rows: Sequence[Sequence[str]], sets: Sets) -> list[int]:
    """Numbers, and those of the sets that are named."""
    cells = [cell for row in rows for cell in row if cell]
    return [number for cell in cells for number in ([int(cell)] if cell.isdigit() else sets.get(cell.upper(), []))]


def _cards(path: Path) -> Iterator[tuple[str, dict[str, str], Rows]]:
    """Keyword, options and rows of every card. Options, except for names of files, in upper case. Raises OSError."""
    keyword, options = "", {}  # type: tuple[str, dict[str, str]]
    rows: Rows = []
    with path.open(encoding="utf-8", errors="replace") as file:
        for line in file:
            text = line.strip()
            if text.startswith("**") or not text:
                continue
            if not text.startswith("*"):
                rows.append([cell.strip() for cell in text.split(",")])
                continue
            yield keyword, options, rows
            keyword, options, rows = *_heading(text), []
            if keyword == "INCLUDE":
                yield from _cards(path.parent / text.partition("=")[2].strip().strip('"'))
    yield keyword, options, rows


def _heading(text: str) -> tuple[str, dict[str, str]]:
    """Keyword and options of a line that begins with a star."""
    keyword, *words = (word.strip() for word in text[1:].upper().split(","))
    options = (word.partition("=") for word in words)
    return keyword, {name.strip(): value.strip().strip('"') for name, _, value in options}
