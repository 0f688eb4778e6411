"""Commented cases: the templates of `mfv new`.

`names` lists them, `write` writes one with the files that it needs. The comments are the descriptions of the keys in
templates/keys.md, the output of mfv_run --keys.
"""

from __future__ import annotations

import functools
import io
import re
import textwrap
from collections.abc import Callable
from importlib.resources import files
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from .studies.namelist import keys_in_markdown

#: Files that a template needs beside itself.
EXTRA_FILES = {"profile": ("profile.txt",), "matrix": ("compliance.h5",), "study": ("cylinder.nml",)}

#: The half-plane of compliance.h5: shear modulus, Poisson's ratio, datum of the displacements, half-width and number of nodes.
SHEAR_MODULUS, POISSON_RATIO, DATUM, HALF_WIDTH, NODES = 1.0, 0.3, 0.25, 0.0127, 81

#: Width of a comment, and its indent.
WIDTH, INDENT = 100, "   ! "

_FOLDER = files(__package__) / "templates"


def names() -> dict[str, str]:
    """The templates, each with a description."""
    found = sorted(Path(entry.name).stem for entry in _FOLDER.iterdir() if entry.name.endswith(".nml"))
    return {name: text(name).splitlines()[0].removeprefix("! ") for name in found}


def text(name: str) -> str:
    """The text of a template, with the meaning of every key above its first occurrence."""
    group, lines, told = "", [], set()
    for line in (_FOLDER / f"{name}.nml").read_text(encoding="utf-8").splitlines():
        starts, key = re.match(r"&(\w+)", line), re.match(r" +(?:! )?(\w+) = ", line)
        group = starts[1] if starts else group
        if key and (group, key[1]) not in told:
            told.add((group, key[1]))
            comment = textwrap.wrap(_meanings()[group, key[1]], WIDTH - len(INDENT), break_on_hyphens=False)
            lines += [INDENT + part for part in comment]
        lines.append(line)
    return "\n".join(lines) + "\n"


@functools.cache
def _meanings() -> dict[tuple[str, str], str]:
    """The meanings of the keys of cases (keys.md) and of studies, by group and key."""
    found = {}
    group, columns = "", [""]
    for line in ((_FOLDER / "keys.md").read_text(encoding="utf-8") + keys_in_markdown()).splitlines():
        cells = [cell.strip().strip("`") for cell in line.removeprefix("|").removesuffix("|").split(" | ")]
        if line.startswith("### &"):
            group = line[5:].split()[0]
        elif line.startswith("| key |"):
            columns = cells
        elif line.startswith("| `"):
            row = dict(zip(columns, cells))
            unit = f", in {row['unit']}" if row.get("unit") else ""
            default = f", {row['default']} by default" if row["default"] != "-" else ""
            found[group, row["key"]] = f"{row['meaning']} ({row['value']}{unit}{default})"
    return found


def is_study(name: str) -> bool:
    """Whether a template is for `mfv study`."""
    return re.search(r"^&sweep\b", text(name), flags=re.MULTILINE) is not None


def write(name: str, path: Path, written: Callable[[Path], Any], overwrite: bool = False) -> list[Path]:
    """Write a template to `path` and the files that it needs beside it; return the files written.

    `written(path)` is a context with a temporary path, renamed to `path` on success. An identical file beside it is not written
    again. Raises ValueError for an unknown template, FileExistsError for a file that would be
    overwritten; then nothing is written.
    """
    if name not in names():
        raise ValueError(f"unknown template {name}; choose from {', '.join(names())}")
    wanted = {path.with_name(extra): extra for extra in EXTRA_FILES.get(name, ()) if path.name != extra}
    if len(wanted) < len(EXTRA_FILES.get(name, ())):
        raise ValueError(f"{path}: another file of this template has this name; choose another with -o")
    targets = {path: f"{name}.nml", **{place: c for place, c in wanted.items() if not _is_there(place, c)}}
    for place in targets:
        if place.exists() and not overwrite:
            raise FileExistsError(f"{place}: exists; overwrite it with --force, or choose another name with -o NAME.nml")
    for place, source in reversed(targets.items()):
        with written(place) as part:
            part.write_bytes(_content(source, place))
    return list(targets)


def _content(source: str, place: Path) -> bytes:
    """The contents of a file of a template; the commands in its comments have the file's name."""
    if source in _MADE:
        return _MADE[source]()
    return text(source.removesuffix(".nml")).replace("FILE", place.stem).encode()


def _is_there(place: Path, name: str) -> bool:
    """Whether an identical file that a template needs exists."""
    return name != "compliance.h5" and place.is_file() and place.read_bytes() == _content(name, place)


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
    with h5py.File(memory, "w") as file:  # in memory, since HDF5 can hang on a full disk
        file["x"] = x
        file["width"] = np.full(NODES, interval)
        file["compliance"] = np.block([[direct, coupling], [-coupling, direct]])
    return memory.getvalue()


#: Files of templates that are computed.
_MADE = {"profile.txt": _profile, "compliance.h5": _matrix}
