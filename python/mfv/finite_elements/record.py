"""What the readers of finite-element results have in common: the nodes of one surface of a plane model over time."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple, Union

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
#: Places of nodes in an array.
Places = NDArray[np.intp]

#: Names in results, in lower case and without blanks, dashes, points and underscores, of what a record has. Those of forces may occur
#: together, such as Abaqus's normal and frictional ones: they are added.
NAMES: dict[str, tuple[str, ...]] = {
    **{
        f"force_{axis}": (
            f"force{axis}",
            f"f{axis}",
            f"forces{axis}",
            f"nodalforces{axis}",
            f"rf{axis}",
            f"rf{n}",
            f"rfrf{n}",
            f"f{n}",
        )
        + tuple(f"{name}{end}" for name in ("cnormf", "cshearf") for end in (axis, n, f"cnormf{n}", f"cshearf{n}"))
        for axis, n in (("x", "1"), ("y", "2"))
    },
    "pressure": ("pressure", "p", "cpress"),
    "shear": ("shear", "tau", "cshear1"),
    **{
        f"stress_{axes}": (f"stress{axes}", f"sigma{axes}", f"s{axes}", f"s{n}", f"ss{n}", f"stresses{axes}", f"cauchystress{axes}")
        for axes, n in (("xx", "11"), ("yy", "22"), ("xy", "12"))
    },
}

#: Names in the options of a user: one name in the result or several, whose values are added.
Columns = Mapping[str, Union[str, Sequence[str]]]


class Element(NamedTuple):
    """An element of the mesh: its nodes (places in the list of nodes, or numbers), and whether its sides have nodes between the corners."""

    nodes: tuple[int, ...]
    is_quadratic: bool


class Face(NamedTuple):
    """The side of an element on the surface: its two ends, the node between them or -1, and the middle of the element [length]."""

    first: int
    last: int
    between: int
    inside: tuple[float, float]


class Record(NamedTuple):
    """The nodes of a surface over time, in the axes and units of the model."""

    #: File and set, for messages.
    source: str
    #: (nodes, 2) [length], undeformed.
    position: Array
    #: (times,)
    times: Array
    #: Arrays (times, nodes), by the keys of NAMES: forces [force], tractions and stresses [force/length^2].
    fields: dict[str, Array]
    #: Sides of elements; none if the result has no mesh.
    faces: list[Face]
    #: The extent of a three-dimensional mesh across the plane [length]; 1 in a plane mesh.
    thickness: float = 1.0
    #: The resultant of the tractions on the body of the surface, if the program has it: forces along x and y, and the moment about the
    #: origin, (times, 3).
    totals: Array | None = None


def plain(name: str) -> str:
    """A name in lower case without blanks, dashes, points and underscores."""
    return "".join(letter for letter in name.lower() if letter.isalnum())


def chosen(available: Mapping[str, Array], source: str, columns: Columns | None) -> dict[str, Array]:
    """The fields of a record among the arrays of a result, which have the shape (times, nodes). Raises ValueError.

    `columns`: names in the result by the keys of NAMES, in place of the known ones.
    """
    given = dict(columns or {})
    unknown = [key for key in given if key not in NAMES]
    if unknown:
        raise ValueError(f"columns: unknown quantity '{unknown[0]}'; choose from {', '.join(NAMES)}")
    short = {plain(name): name for name in available}
    fields = {}
    for key, known in NAMES.items():
        if key in given:
            names = [given[key]] if isinstance(given[key], str) else list(given[key])
            missing = [name for name in names if plain(str(name)) not in short]
            if missing:
                raise ValueError(f"{source}: no values '{missing[0]}' for {key}; there are {_listed(available)}")
            found = [short[plain(str(name))] for name in names]
        else:
            found = [short[name] for name in known if name in short]
            found = [name for name in found if plain(name).startswith(("cnormf", "cshearf"))] or found[:1]
        if found:
            fields[key] = np.sum([available[name] for name in found], axis=0)
    return _checked(fields, source, available)


def _checked(fields: dict[str, Array], source: str, available: Iterable[str]) -> dict[str, Array]:
    """The fields, if they are finite and those of forces or tractions are complete. Raises ValueError."""
    stresses = [key for key in fields if key.startswith("stress")]
    if not {"force_x", "force_y"} <= set(fields) and "pressure" not in fields and len(stresses) < 3:
        raise ValueError(
            f"{source}: has neither nodal forces (force_x, force_y) nor tractions (pressure, shear); there are {_listed(available)}; "
            "name them by columns, such as columns={'pressure': 'CPRESS'}"
        )
    if 0 < len(stresses) < 3:
        for key in stresses:
            del fields[key]
    bad = next((key for key, values in fields.items() if not np.all(np.isfinite(values))), None)
    if bad is not None:
        raise ValueError(f"{source}: {bad} has values that are not numbers; export the surface's nodes only, at times with results")
    return fields


def _listed(names: Iterable[str]) -> str:
    return ", ".join(names) or "no arrays"


#: Places of xx, yy and xy among the components of a stress, by the shape of its last axes.
_STRESSES = {(3,): (0, 1, 2), (4,): (0, 1, 3), (6,): (0, 1, 3), (9,): (0, 4, 1), (2, 2): (0, 3, 1), (3, 3): (0, 4, 1)}


def components(name: str, values: Array) -> dict[str, Array]:
    """The components of an array of a mesh, (times, nodes) and axes of components, with _x, _y or _xx, _yy, _xy behind its name."""
    shape = values.shape[2:]
    if not shape or shape == (1,):
        return {name: values.reshape(values.shape[:2])}
    flat = values.reshape(*values.shape[:2], -1)
    if shape in _STRESSES and (shape != (3,) or plain(f"{name}xx") in NAMES["stress_xx"]):
        return {f"{name}_{part}": flat[..., place] for part, place in zip(("xx", "yy", "xy"), _STRESSES[shape])}
    return {f"{name}_{part}": flat[..., place] for place, part in enumerate("xyz"[: flat.shape[2]])}


def on_surface(
    source: str,
    position: Array,
    elements: Sequence[Element],
    surface: Sequence[int],
    times: Array,
    fields: dict[str, Array],
) -> Record:
    """The record of the nodes `surface` (places in `position`, an array (nodes, 2 or 3)); `fields` are at these nodes, in this order.

    Nodes of a three-dimensional mesh behind one another are one: their forces are added, their tractions and stresses averaged.
    """
    flat, deep = position[:, :2], position[:, 2] if position.shape[1] > 2 else np.zeros(len(position))
    used = np.array(surface, dtype=int)
    size = max(float(np.ptp(flat[used], axis=0).max()), 1e-300)
    _, first, place = np.unique(np.round(flat[used] / (1e-7 * size)), axis=0, return_index=True, return_inverse=True)
    place = np.asarray(place).reshape(-1)
    counts = np.bincount(place)
    merged = {
        key: np.array([np.bincount(place, row) for row in values]) / (1.0 if key.startswith("force") else counts)
        for key, values in fields.items()
    }
    thickness = float(np.ptp(deep[used])) or 1.0
    number = dict(zip(used.tolist(), place.tolist()))
    return Record(source, flat[used][first], times, merged, _faces(position, elements, number), thickness)


def _faces(position: Array, elements: Sequence[Element], number: Mapping[int, int]) -> list[Face]:
    """The sides of elements whose nodes are on the surface; `number`: of its nodes, by their places in `position`."""
    found: dict[tuple[int, int], Face] = {}
    for nodes, is_quadratic in elements:
        on = [node for node in nodes if node in number]
        points = {number[node]: position[node, :2] for node in on}
        if len(points) != 2 + is_quadratic:
            continue
        inside = np.mean([position[node, :2] for node in nodes], axis=0)
        along = max(((one, other) for one in points for other in points), key=lambda pair: _distance(points, pair))
        between = next((node for node in points if node not in along), -1)
        first, last = sorted(along)
        found[first, last] = Face(first, last, between, (float(inside[0]), float(inside[1])))
    return list(found.values())


def _distance(points: Mapping[int, Array], pair: tuple[int, int]) -> float:
    return float(np.hypot(*(points[pair[0]] - points[pair[1]])))
