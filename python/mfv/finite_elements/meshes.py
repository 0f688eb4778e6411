"""Results on meshes: VTU, XDMF and others by meshio, with a file for every time or a .pvd; Exodus by netCDF4.

meshio 5.3 reads the first time of an Exodus file only, so that is read by the library below it.
"""

from __future__ import annotations

import xml.etree.ElementTree as xml
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from .._packages import needed
from .record import Array, Columns, Element, Record, chosen, components, on_surface

#: Elements with nodes between the corners.
_QUADRATIC = ("triangle6", "quad8", "quad9", "tetra10", "hexahedron20", "hexahedron27", "wedge15")

#: Elements of a plane or a solid, not of its surface.
_BODIES = (*_QUADRATIC, "triangle", "quad", "tetra", "hexahedron", "wedge")


# --- meshio ---


def read_meshes(paths: Sequence[Path], surface: str | None, columns: Columns | None, times: Sequence[float] | None) -> Record:
    """Arrays at the points of meshes, one file for every time, or XDMF with all of them. Raises OSError, ValueError, ModuleNotFoundError.

    The surface is a point set, or an array at the points that is not 0 on it. `times`: of the files; 0, 1, ... if None.
    """
    meshio = needed("meshio")
    if len(paths) == 1 and paths[0].suffix.lower() == ".xdmf":
        mesh, frames, found = _series(meshio, paths[0])
    else:
        meshes = [_mesh(meshio, path) for path in paths]
        mesh, frames = meshes[0], [each.point_data for each in meshes]
        found = list(range(len(paths)))
        moved = next((path for path, each in zip(paths, meshes) if each.points.shape != mesh.points.shape), None)
        if moved is not None:
            raise ValueError(f"{moved}: has another number of points than {paths[0]}; results on one mesh are needed")
    if times is not None and len(times) != len(frames):
        raise ValueError(f"times: {len(times)} numbers for {len(frames)} files")
    nodes = _marked(str(paths[0]), surface, mesh.point_sets, frames[0])
    source = f"{paths[0]}, {surface}"
    fields = chosen(_stacked(frames, nodes), source, columns)
    elements = [
        Element(tuple(int(node) for node in cell), block.type in _QUADRATIC)
        for block in mesh.cells
        if block.type in _BODIES
        for cell in block.data
    ]
    when = np.array(times if times is not None else found, dtype=float)
    return on_surface(source, np.asarray(mesh.points, dtype=float), elements, nodes, when, fields)


def _mesh(meshio: Any, path: Path) -> Any:
    """A mesh. Raises ValueError."""
    try:
        return meshio.read(path)
    except (Exception, SystemExit) as error:  # readers raise exceptions of many types
        raise ValueError(f"{path}: meshio cannot read it: {error or type(error).__name__}") from None


def _series(meshio: Any, path: Path) -> tuple[Any, list[Mapping[str, Any]], list[float]]:
    """The mesh, the arrays at the points at all times, and these, of an XDMF file. Raises ValueError."""
    try:
        with meshio.xdmf.TimeSeriesReader(str(path)) as reader:
            points, cells = reader.read_points_cells()
            rows = [reader.read_data(number) for number in range(reader.num_steps)]
    except Exception:  # a file of one time is not a series
        mesh = _mesh(meshio, path)
        return mesh, [mesh.point_data], [0.0]
    return meshio.Mesh(points, cells), [row[1] for row in rows], [float(row[0]) for row in rows]


def _marked(name: str, surface: str | None, sets: Mapping[str, Any], arrays: Mapping[str, Any]) -> list[int]:
    """The places of the points of a surface. Raises ValueError."""
    marks = [key for key, values in arrays.items() if np.ndim(values) == 1]
    listed = f"point sets {', '.join(sets) or 'none'}; arrays at points {', '.join(marks) or 'none'}"
    if surface is None:
        raise ValueError(f"{name}: give the point set of the surface, or an array that is not 0 on it; there are {listed}")
    if surface in sets:
        nodes = np.asarray(sets[surface], dtype=int)
    elif surface in marks:
        nodes = np.nonzero(np.asarray(arrays[surface]))[0]
    else:
        raise ValueError(f"{name}: no point set or array '{surface}'; there are {listed}")
    if len(nodes) == 0:
        raise ValueError(f"{name}: '{surface}' has no points")
    return [int(node) for node in nodes]


def _stacked(frames: Sequence[Mapping[str, Any]], nodes: Sequence[int]) -> dict[str, Array]:
    """The arrays of all times at nodes, (times, nodes), by component."""
    found: dict[str, Array] = {}
    for name in frames[0]:
        if all(name in frame for frame in frames):
            found |= components(name, np.array([np.asarray(frame[name], dtype=float)[nodes] for frame in frames]))
    return found


def read_pvd(path: Path) -> tuple[list[Path], list[float]]:
    """The files and times of a ParaView collection. Raises OSError, ValueError."""
    try:
        sets = xml.parse(path).getroot().findall("./Collection/DataSet")
    except xml.ParseError as error:
        raise ValueError(f"{path}: not a ParaView collection: {error}") from None
    if not sets:
        raise ValueError(f"{path}: lists no files (Collection, DataSet)")
    return [path.parent / str(each.get("file")) for each in sets], [float(each.get("timestep", at)) for at, each in enumerate(sets)]


# --- Exodus ---


def read_exodus(path: Path, surface: str | None, columns: Columns | None) -> Record:
    """Nodal variables at the nodes of a node set, by its name or number, at all times. Raises OSError, ValueError, ModuleNotFoundError."""
    try:
        file = needed("netCDF4").Dataset(path)
    except OSError as error:
        raise ValueError(f"{path}: not an Exodus file: {error}") from None
    with file:
        file.set_auto_mask(False)
        variables = file.variables
        nodes = _node_set(path, surface, variables)
        names = _texts(variables, "name_nod_var")
        places = [f"vals_nod_var{at}" for at in range(1, len(names) + 1)]
        arrays = {
            name: np.asarray(variables[key][:], dtype=float)[:, nodes] for name, key in zip(names, places) if key in variables
        }
        position = _positions(variables)
        elements = [
            Element(tuple(int(node) - 1 for node in cell), _is_quadratic(str(block.elem_type), block.shape[1], position.shape[1]))
            for key, block in variables.items()
            if key.startswith("connect")
            for cell in block[:]
        ]
        times = np.asarray(variables["time_whole"][:], dtype=float)
    source = f"{path}, {surface}"
    return on_surface(source, position, elements, nodes, times, chosen(arrays, source, columns))


def _node_set(path: Path, surface: str | None, variables: Mapping[str, Any]) -> list[int]:
    """The places of the nodes of a set. Raises ValueError."""
    numbers = [str(number) for number in variables["ns_prop1"][:]] if "ns_prop1" in variables else []
    names = _texts(variables, "ns_names") or [""] * len(numbers)
    listed = ", ".join(name or number for name, number in zip(names, numbers)) or "none"
    at = next((at for at, pair in enumerate(zip(names, numbers), start=1) if surface in pair), None)
    if at is None:
        raise ValueError(f"{path}: no node set '{surface}'; there are {listed}")
    return [int(node) - 1 for node in variables[f"node_ns{at}"][:]]


def _texts(variables: Mapping[str, Any], key: str) -> list[str]:
    """The names in an array of characters."""
    rows = variables[key][:] if key in variables else []
    return [b"".join(np.asarray(row).astype("S1").tolist()).decode().strip("\0 ") for row in rows]


def _positions(variables: Mapping[str, Any]) -> Array:
    """Positions (nodes, 2 or 3)."""
    if "coord" in variables:
        return np.asarray(variables["coord"][:], dtype=float).T
    return np.column_stack([np.asarray(variables[f"coord{axis}"][:], dtype=float) for axis in "xyz" if f"coord{axis}" in variables])


def _is_quadratic(kind: str, nodes: int, dimensions: int) -> bool:
    """Whether elements of a type with this number of nodes have nodes between the corners."""
    is_plane = dimensions == 2 or kind.upper().startswith(("QUAD", "TRI", "SHELL"))
    return nodes in ((6, 8, 9) if is_plane else (10, 15, 20, 27))
