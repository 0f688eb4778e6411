"""Commented cases to begin with: the templates of `python -m mfv new`.

`names` tells which there are, `write` writes one with the files that it needs. The comments come from the catalogue of keys
(scripts/templates.py).
"""

from __future__ import annotations

import io
import re
from collections.abc import Callable
from importlib.resources import files
from pathlib import Path
from typing import Any

import h5py
import numpy as np

#: Files that a template needs beside itself.
COMPANIONS = {"profile": ("profile.txt",), "matrix": ("compliance.h5",), "study": ("cylinder.nml",)}

#: The half-plane of compliance.h5: shear modulus, Poisson's ratio, where its displacements are measured from, nodes on either side.
SHEAR_MODULUS, POISSON_RATIO, DATUM, HALF_WIDTH, NODES = 1.0, 0.3, 0.25, 0.0127, 81

_FOLDER = files(__package__) / "templates"


def names() -> dict[str, str]:
    """The templates, and what each is, in a line."""
    found = sorted(Path(entry.name).stem for entry in _FOLDER.iterdir() if entry.name.endswith(".nml"))
    return {name: text(name).splitlines()[0].removeprefix("! ") for name in found}


def text(name: str) -> str:
    """The text of a template."""
    return (_FOLDER / f"{name}.nml").read_text(encoding="utf-8")


def is_study(name: str) -> bool:
    """Whether a template is for `python -m mfv study`."""
    return re.search(r"^&sweep\b", text(name), flags=re.MULTILINE) is not None


def write(name: str, path: Path, written: Callable[[Path], Any], overwrite: bool = False) -> list[Path]:
    """Write a template to `path` and what it needs beside it; returns the files written.

    `written(path)` is a context with a path to write to that becomes `path` when all is well. A file beside it that is the
    same already is left alone. Raises ValueError for an unknown template, FileExistsError for a file that would be
    overwritten; then nothing is written.
    """
    if name not in names():
        raise ValueError(f"there is no template {name}; there is {', '.join(names())}")
    wanted = {path.with_name(companion): companion for companion in COMPANIONS.get(name, ()) if path.name != companion}
    if len(wanted) < len(COMPANIONS.get(name, ())):
        raise ValueError(f"{path}: another file of this template has that name; give another with -o")
    targets = {path: f"{name}.nml", **{place: c for place, c in wanted.items() if not _is_there(place, c)}}
    for place in targets:
        if place.exists() and not overwrite:
            raise FileExistsError(f"{place}: exists already; --force overwrites it, -o NAME.nml writes elsewhere")
    for place, source in reversed(targets.items()):
        with written(place) as part:
            part.write_bytes(_content(source, place))
    return list(targets)


def _content(source: str, place: Path) -> bytes:
    """What a file of a template has in it; the commands in its comments name the place."""
    if source in _MADE:
        return _MADE[source]()
    return (_FOLDER / source).read_bytes().replace(b"FILE", place.stem.encode())


def _is_there(place: Path, companion: str) -> bool:
    """Whether a file that a template needs is there already, the same."""
    return companion != "compliance.h5" and place.is_file() and place.read_bytes() == _content(companion, place)


def _profile() -> bytes:
    """A punch with rounded edges as points: flat up to 0.3, then receding by the square of the distance."""
    points = (f"{x:.2f} {max(abs(x) - 0.3, 0.0) ** 2:.6f}" for x in np.linspace(-0.6, 0.6, 121).round(2) + 0.0)
    return "\n".join(["# A punch with rounded edges: x, how far it recedes (lengths)", *points, ""]).encode()


def _matrix() -> bytes:
    """An HDF5 file with the compliance of an elastic half-plane by nodal forces (Johnson 1985, sections 2.2 and 2.3)."""
    interval = 2.0 * HALF_WIDTH / NODES
    x = interval * (np.arange(NODES) - 0.5 * (NODES - 1))
    distance = x[:, None] - x
    ends = (distance + 0.5 * interval, distance - 0.5 * interval)
    logarithm = (ends[0] * np.log(np.abs(ends[0])) - ends[1] * np.log(np.abs(ends[1]))) / interval - 1.0 - np.log(DATUM)
    direct = -(1.0 - POISSON_RATIO) / (np.pi * SHEAR_MODULUS) * logarithm
    coupling = (1.0 - 2.0 * POISSON_RATIO) / (4.0 * SHEAR_MODULUS) * np.sign(distance)
    memory = io.BytesIO()
    with h5py.File(memory, "w") as file:  # HDF5 does not come back from a full disk: it is kept away from disks
        file["x"] = x
        file["width"] = np.full(NODES, interval)
        file["compliance"] = np.block([[direct, coupling], [-coupling, direct]])
    return memory.getvalue()


#: Files of templates that are not in the folder, but made.
_MADE = {"profile.txt": _profile, "compliance.h5": _matrix}
