"""The reader for each format of finite-element results."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Union

import numpy as np

from .calculix import read_dat, read_frd
from .meshes import read_exodus, read_meshes, read_pvd
from .record import Columns, Record, chosen, on_surface
from .text_tables import read_csv, read_rpt

#: Suffixes by format.
FORMATS = {
    "CSV": (".csv", ".txt", ".tsv"),
    "CalculiX": (".frd", ".dat"),
    "report of Abaqus": (".rpt",),
    "VTU and others by meshio": (".vtu", ".vtk", ".xdmf", ".pvd"),
    "Exodus": (".e", ".exo", ".ex2", ".exii"),
}

Name = Union[str, "os.PathLike[str]"]
#: A file, several with a time each, or arrays by name.
Source = Union[Name, Sequence[Name], Mapping[str, Any]]


def read_surface(
    source: Source,
    surface: str | None,
    mesh: Name | None = None,
    columns: Columns | None = None,
    times: Sequence[float] | None = None,
) -> Record:
    """The nodes of a surface over time. Raises OSError, ValueError, ModuleNotFoundError for a missing package."""
    if isinstance(source, Mapping):
        return _arrays(source, surface, columns)
    paths = [Path(source)] if isinstance(source, (str, os.PathLike)) else [Path(path) for path in source]
    if not paths:
        raise ValueError("no files given")
    deck, path, suffix = Path(mesh) if mesh is not None else None, paths[0], paths[0].suffix.lower()
    if suffix == ".odb":
        raise ValueError(f"{path}: only Abaqus reads an odb; write a field report (.rpt) or a CSV from it")
    _check_files([*paths, *([] if deck is None else [deck])])
    if suffix == ".pvd":
        paths, times = read_pvd(path)
        _check_files(paths)
        suffix = ".vtu"
    if suffix in FORMATS["VTU and others by meshio"]:
        return read_meshes(paths, surface, columns, times)
    if len(paths) > 1 or times is not None:
        raise ValueError(f"{path}: several files, and times, are for {', '.join(FORMATS['VTU and others by meshio'])} only")
    if suffix in FORMATS["CSV"]:
        return read_csv(path, surface, deck, columns)
    if suffix == ".rpt":
        return read_rpt(path, surface, deck, columns)
    if suffix in FORMATS["CalculiX"]:
        return (read_frd if suffix == ".frd" else read_dat)(path, surface, deck, columns)
    if suffix in FORMATS["Exodus"]:
        return read_exodus(path, surface, columns)
    known = ", ".join(each for suffixes in FORMATS.values() for each in suffixes)
    raise ValueError(f"{path}: unknown format '{suffix}'; known are {known}")


def _check_files(paths: Sequence[Path]) -> None:
    """Raises FileNotFoundError for the first that is not a file."""
    absent = next((path for path in paths if not path.is_file()), None)
    if absent is not None:
        raise FileNotFoundError(f"{absent}: does not exist or is not a file")


def _arrays(source: Mapping[str, Any], surface: str | None, columns: Columns | None) -> Record:
    """The record of arrays: x, y (nodes) and t (times), values (times, nodes). Raises ValueError."""
    label = surface or "arrays"
    if "x" not in source:
        raise ValueError(f"{label}: no x; give the positions of the nodes, and values (times, nodes) such as pressure and shear")
    x = np.asarray(source["x"], dtype=float)
    values = {name: np.atleast_2d(np.asarray(array, dtype=float)) for name, array in source.items() if name not in ("x", "y", "t")}
    size = next((len(array) for array in values.values()), 1)
    times = np.asarray(source.get("t", np.arange(size)), dtype=float).reshape(-1)
    wrong = next((name for name, array in values.items() if array.shape != (len(times), len(x))), None)
    if wrong is not None:
        raise ValueError(f"{label}: {wrong} has the shape {values[wrong].shape}, not (times, nodes) = {(len(times), len(x))}")
    position = np.column_stack([x, np.asarray(source.get("y", np.zeros(len(x))), dtype=float)])
    return on_surface(label, position, [], list(range(len(x))), times, chosen(values, label, columns))
