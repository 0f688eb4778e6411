"""Axes of a map: loads of a case by short names, each scaled as a whole, and keys that change in proportion."""

from __future__ import annotations

import math
import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import f90nml
import numpy as np

from .._suggestions import suggestion
from ..errors import input_error
from ..inputs import groups
from ..inputs import keys as keys_of_text
from ..tables import read_rows
from .axes import Axis
from .cases import Base, base_text

#: Short names of axes: the keys that they scale, without their groups, and what the value is.
SHORT = {
    "Q": (("tangential_force",), "largest tangential force; all tangential forces of the case in proportion"),
    "P": (("normal_force",), "largest normal force; all normal forces of the case in proportion"),
    "D": (("shift",), "largest shift; all shifts of the case in proportion"),
    "B": (("lower_bulk_stress", "upper_bulk_stress"), "largest bulk stress; all bulk stresses of the case in proportion"),
    "mu": (("mu", "mu_static", "mu_kinetic"), "largest coefficient of friction"),
}

#: Default ranges, in multiples of the value of the case; that of Q in multiples of mu times its normal force.
RANGES = {"Q": (0.02, 1.2), "P": (0.2, 2.0), "D": (0.1, 3.0), "B": (0.0, 2.0), "mu": (0.2, 2.0)}
OTHER_RANGE = (0.5, 2.0)

#: Loads of &history, which a file may have.
_LOADS = ("normal_force", "approach", "tangential_force", "shift", "force_ratio", "moment", "rotation", "lower_bulk_stress",
          "upper_bulk_stress", "interference")  # fmt: skip


@dataclass(frozen=True)
class Loads:
    """The keys of a case with their values, and its name in messages."""

    keys: Mapping[str, Any]
    name: str

    def steps(self) -> Iterator[str]:
        """The groups with loads in their order: step(1), step(2), ..., history."""
        number = 1
        while any(key.startswith(f"step({number})%") for key in self.keys):
            yield f"step({number})"
            number += 1
        yield "history"

    def targets(self, names: Sequence[str]) -> dict[str, Any]:
        """The given ones of these loads by key, in the order of the steps."""
        keys = (f"{group}%{name}" for group in self.steps() for name in names)
        return {key: self.keys[key] for key in keys if key in self.keys}

    def tangential_forces(self) -> dict[str, Any]:
        """The tangential forces by key; those given by force_ratio times mu and the normal force. Raises InputError."""
        found: dict[str, Any] = {}
        force: Any = None
        for group in self.steps():
            force = self.keys.get(f"{group}%normal_force", force)
            ratio = self.keys.get(f"{group}%force_ratio")
            if f"{group}%tangential_force" in self.keys:
                found[f"{group}%tangential_force"] = self.keys[f"{group}%tangential_force"]
            elif ratio is not None:
                mu = self.friction()
                if force is None or mu is None:
                    raise input_error(f"{self.name}: Q: {group}%force_ratio needs a normal_force and a number for mu")
                # A normal force that changes within &history, where the ratio does, has a value for each ratio.
                forces = np.asarray(ratio) * mu * (force if np.ndim(force) <= np.ndim(ratio) else np.asarray(force))
                found[f"{group}%tangential_force"] = forces.tolist()
        return found

    def friction(self) -> float | None:
        """The largest coefficient of friction; None without one number for it."""
        values = [self.keys[key] for key in ("friction%mu", "friction%mu_static") if key in self.keys]
        return max(map(float, values)) if values else None

    def obliquity(self, step: int) -> float:
        """The target of the tangential over that of the normal force in a step, from 1, as sizes; NaN if either is unknown."""
        number = list(self.steps())[:step]
        try:
            forces = [value for key, value in self.tangential_forces().items() if key.partition("%")[0] in number]
        except ValueError:
            return math.nan
        pressing = [value for key, value in self.targets(("normal_force",)).items() if key.partition("%")[0] in number]
        if not forces or not pressing or np.ndim(forces[-1]) or np.ndim(pressing[-1]) or not float(pressing[-1]) > 0.0:
            return math.nan
        return abs(float(forces[-1])) / float(pressing[-1])


def loads_of(base: Base) -> Loads:
    """The keys of a base case. Raises InputError."""
    return Loads(keys_of_text(base_text(base)), base.name)


def with_history_in_text(base: Base) -> Base:
    """A base whose &history, if it names a file, has the loads of the file as lists, so that they can be scaled.

    Raises InputError, OSError.
    """
    text = base_text(base)
    file = dict(groups(text)).get("history", {}).get("file")
    if not file or any(file == name for name, _, _ in base.data):
        return base
    rows = read_rows(Path(os.path.abspath(base.folder), file), ())
    cells = [rows.cells(line) for line in rows.lines]
    namelist = f90nml.reads(text)
    del namelist["history"]["file"]
    for place, name in enumerate(rows.names):
        if name.lower() in _LOADS:
            namelist["history"][name.lower()] = [rows.number(row[place]) for row in cells]
    return replace(base, text=str(namelist))


def map_axis(name: str, loads: Loads, given: Any, count: int) -> tuple[str, Axis]:
    """Name and axis of a map. `name`: Q, P, D, B, mu, or keys of the case, joined by +, that change in proportion; the value of the axis
    is the largest of them. `given`: first and last value, or None for the default range; or an Axis, as it is.

    Raises InputError, which names the case, the axis and what would be right.
    """
    if isinstance(given, Axis):
        return name, replace(given, values=_checked(name, list(given.values), loads.name))
    targets = _targets(name, loads)
    size = float(max(np.max(np.abs(value)) for value in targets.values()))
    if not size > 0.0:
        raise input_error(f"{loads.name}: {name}: {', '.join(targets)} is 0 and cannot be scaled; give the case a value")
    factors = [(np.asarray(value, dtype=float) / size).tolist() for value in targets.values()]
    first, last = _range(name, loads, size) if given is None else given
    values = _checked(name, [float(value) for value in np.linspace(first, last, count)], loads.name)
    short = name if name in SHORT or "+" not in name else name.partition("+")[0]
    return short, Axis(list(targets), values, factors)


def _checked(name: str, values: list[Any], case: str) -> list[Any]:
    """The values of an axis. Raises InputError unless they are at least two and increase."""
    numbers = np.asarray(values, dtype=float)
    if numbers.size < 2 or not np.all(np.isfinite(numbers)) or not np.all(np.diff(numbers) > 0.0):
        raise input_error(f"{case}: {name}: needs at least 2 points from a smaller to a larger finite value, such as {name}=0.1:1")
    return values


def _range(name: str, loads: Loads, size: float) -> tuple[float, float]:
    """The default range of an axis."""
    low, high = RANGES.get(name, OTHER_RANGE)
    pressing = loads.targets(("normal_force",)).values()
    mu = loads.friction()
    if name == "Q" and pressing and mu is not None:
        size = mu * float(max(np.max(np.abs(force)) for force in pressing))
    return low * size, high * size


def _targets(name: str, loads: Loads) -> dict[str, Any]:
    """The keys of an axis with their values in the case. Raises InputError."""
    if name not in SHORT:
        return _given(name, loads)
    keys, _ = SHORT[name]
    if name == "mu":
        found = {f"friction%{key}": loads.keys[f"friction%{key}"] for key in keys if f"friction%{key}" in loads.keys}
    else:
        found = loads.tangential_forces() if name == "Q" else loads.targets(keys)
    if not found:
        others = [one for one in ("Q", "P", "D", "B") if one != name and _has(one, loads)]
        hint = f"; it has {', '.join(others)}" if others else ""
        raise input_error(f"{loads.name}: {name}: the case gives no {' or '.join(keys)}{hint}")
    return found


def _has(name: str, loads: Loads) -> bool:
    """Whether a case has the loads of a short name."""
    names = SHORT[name][0]
    return bool(loads.targets((*names, "force_ratio") if name == "Q" else names))


def usual_axes(loads: Loads) -> tuple[str, str]:
    """The axes of a map by default: normal force and tangential force, or shift. Raises InputError."""
    for name in ("Q", "D"):
        if _has(name, loads):
            return name, "P"
    raise input_error(f"{loads.name}: no tangential_force, force_ratio or shift in the case: give the axes by --over, or over=")


def _given(name: str, loads: Loads) -> dict[str, Any]:
    """The numbers of the keys in a name such as step(2)%shift+step(3)%shift. Raises InputError."""
    found: dict[str, Any] = {}
    for key in name.lower().split("+"):
        if key not in loads.keys:
            known = [*SHORT, *(one for one in loads.keys if _is_number(loads.keys[one]))]
            raise input_error(f"{loads.name}: '{key}' is neither {', '.join(SHORT)} nor a key of the case{suggestion(key, known)}")
        if not _is_number(loads.keys[key]):
            raise input_error(f"{loads.name}: {key}={loads.keys[key]!r}: an axis of a map needs a number")
        found[key] = loads.keys[key]
    return found


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)
