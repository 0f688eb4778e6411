"""A problem as data: the groups of a namelist with their keys, and the tables of the files that they name."""

from __future__ import annotations

import copy
import dataclasses
import os
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

import mfv
from mfv.case import Case
from mfv.result import Result

#: Keys that name a file of two or three columns, or of columns with names.
FILE_KEYS = ("file", "mu_file")
#: Load increments times nodes after which a run is given up: a count, so that no verdict depends on the speed of the machine.
MOST_WORK = 1_000_000
#: Nodes beyond which the time of dgesv, which grows with their third power, counts with it.
DENSE = 500

Table = dict[str, list[float]]
Keys = dict[str, Any]


@dataclasses.dataclass
class Problem:
    """`groups`: name and keys of each group in their order; `tables`: columns of each file by its name."""

    groups: list[tuple[str, Keys]]
    tables: dict[str, Table] = dataclasses.field(default_factory=dict)
    #: What it is: shapes, law, loads, mesh; for tables and findings.
    labels: dict[str, str] = dataclasses.field(default_factory=dict)
    #: A smooth indenter under Coulomb's law or without friction.
    ordinary: bool = False

    def copy(self) -> Problem:
        return copy.deepcopy(self)

    def all(self, name: str) -> list[Keys]:
        """The keys of all groups of a name, to be changed."""
        return [keys for group, keys in self.groups if group == name]

    def one(self, name: str) -> Keys:
        """The keys of a group that occurs once, to be changed; it is added if absent."""
        for group, keys in self.groups:
            if group == name:
                return keys
        keys: Keys = {}
        last = max((place for place, (group, _) in enumerate(self.groups) if group in ("scene", "body")), default=-1)
        self.groups.insert(last + 1, (name, keys))
        return keys

    def has(self, name: str, key: str | None = None) -> bool:
        return any(group == name and (key is None or key in keys) for group, keys in self.groups)

    def accuracy(self) -> float:
        """The error of large increments that it allows, zero without the key."""
        return float(self.one("solver").get("accuracy", 0.0)) if self.has("solver") else 0.0

    def wear_tolerance(self) -> float:
        """The error of blocks of cycles that it allows, zero without wear."""
        return float(self.one("wear").get("tolerance", 0.05)) if self.has("wear") else 0.0

    def loads(self) -> Iterator[Keys]:
        """The keys of every step, and the columns of the load history, whether they are in the namelist or in a file."""
        for group, keys in self.groups:
            if group == "step":
                yield keys
            if group == "history":
                yield self.tables[keys["file"]] if "file" in keys else keys

    def text(self) -> str:
        """The namelist."""
        lines = []
        for group, keys in self.groups:
            lines.append(f"&{group} " + ", ".join(f"{key}={namelist_value(value)}" for key, value in keys.items()) + " /")
        return "\n".join(lines) + "\n"

    def write(self, folder: Path, name: str = "case.nml") -> Path:
        """Write namelist and files into a folder; return the path of the namelist."""
        folder.mkdir(parents=True, exist_ok=True)
        for file, table in self.tables.items():
            heading = [] if file.startswith(("profile", "mu")) else [",".join(table)]
            rows = [",".join(f"{value:.17g}" for value in row) for row in zip(*table.values())]
            (folder / file).write_text("\n".join([*heading, *rows]) + "\n")
        path = folder / name
        path.write_text(self.text())
        return path

    def run(self) -> Result:
        """Solve it in this process, from the text. Raises InputError."""
        if not self.tables:
            return _solved(self.text(), "case.nml")
        with tempfile.TemporaryDirectory() as folder:
            return _solved(self.text(), os.fspath(self.write(Path(folder))))

    def scene(self) -> mfv.Scene:
        """The same as Python objects, with arrays in place of files."""
        groups = [(name, dict(keys)) for name, keys in self.groups]
        for name, keys in groups:
            self._read_files(name, keys)
        single = {name: kind(**keys) for name, keys in groups if (kind := _KINDS.get(name))}
        lower, upper = (mfv.Body(**keys) for name, keys in groups if name == "body")
        layers = [(keys.pop("body"), mfv.Layer(**keys)) for name, keys in groups if name == "layer"]
        for number, body in enumerate((lower, upper), start=1):
            body.layers = [layer for of, layer in layers if of == number] or None
        scene = next((keys for name, keys in groups if name == "scene"), {})
        return mfv.Scene(lower, upper, steps=[mfv.Step(**keys) for name, keys in groups if name == "step"], **single, **scene)

    def _read_files(self, group: str, keys: Keys) -> None:
        """Replace the names of files by their columns."""
        for key in FILE_KEYS:
            if key not in keys:
                continue
            table = {name: np.array(column) for name, column in self.tables[keys.pop(key)].items()}
            keys.update(table if group == "history" else {"data": table})


_KINDS: dict[str, type] = {
    "mesh": mfv.Mesh,
    "friction": mfv.Friction,
    "wear": mfv.Wear,
    "history": mfv.History,
    "solver": mfv.Solver,
    "output": mfv.Output,
}


def _solved(text: str, name: str) -> Result:
    increments = 0

    def is_too_long(_: object) -> bool:
        nonlocal increments
        increments += 1
        return increments > most

    with Case.from_text(text, name) as case:
        nodes = len(case["mesh/x"])
        dense = max(nodes / DENSE, 1.0) ** 2 if "linear_solver='dgesv'" in text else 1.0
        most = MOST_WORK // int(nodes * dense)
        case.observe(is_too_long)
        case.run()
        case.observe(None)
        return case.result()


def namelist_value(value: Any) -> str:
    """A value as it stands in a namelist."""
    if isinstance(value, bool):
        return ".true." if value else ".false."
    if isinstance(value, str):
        return f"'{value}'"
    if isinstance(value, (list, tuple, np.ndarray)):
        return ", ".join(namelist_value(item) for item in value)
    return f"{value:.17g}" if isinstance(value, float) else str(value)
