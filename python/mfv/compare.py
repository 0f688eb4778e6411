"""Comparison of two results: settings, inputs, numbers and tractions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from . import _html
from .inputs import keys
from .result import Group, Result, doubt
from .stress import drawn_at

#: Groups of numbers that are compared.
GROUPS = ("summary", "observables", "certificate")

#: Attributes that are not settings: the input is compared by its keys, and the working directory does not matter.
NOT_SETTINGS = ("input", "working_directory")

TRACTIONS = ("pressure", "shear")

Array = np.ndarray


class Setting(NamedTuple):
    """An attribute or an input key that differs; None if a result does not have it."""

    name: str
    first: Any
    second: Any


class Number(NamedTuple):
    """A number of both results; NaN if a result does not have it."""

    group: str
    name: str
    unit: str
    description: str
    first: float
    second: float

    @property
    def relative_difference(self) -> float:
        """Difference relative to the larger number; 0 if they are equal."""
        return relative_difference(self.first, self.second)


class Traction(NamedTuple):
    """Differences of a traction between the two states."""

    name: str
    unit: str
    #: Largest absolute values.
    first: float
    second: float
    #: Largest and root-mean-square difference, relative to the largest value of this traction in either result; 0 if both are zero.
    largest_difference: float
    mean_square_difference: float


@dataclass(frozen=True)
class Comparison:
    """Differences of two results."""

    first: Result
    second: Result
    #: Number of the state in `steps`, None for the last one.
    step: int | None
    settings: list[Setting]
    #: Input keys that differ, or why they cannot be compared.
    inputs: list[Setting] | str
    numbers: list[Number]
    tractions: list[Traction]
    #: The overall measure: the largest difference of a traction, relative to the largest traction of either result.
    largest_difference: float
    #: Whether the meshes differ, so that tractions were compared by interpolation.
    interpolated: bool

    def describe(self) -> str:
        """The comparison as text."""
        state = "at the end" if self.step is None else f"in state {self.step}"
        meshes = f"{self.first.mesh.x.size} and {self.second.mesh.x.size} nodes"
        how = f"interpolated linearly to the nodes of both meshes ({meshes})" if self.interpolated else "node by node"
        blocks = [
            _setting_lines("different settings", self.settings),
            [f"input keys: {self.inputs}"] if isinstance(self.inputs, str) else _setting_lines("different input keys", self.inputs),
            *(self._number_lines(group) for group in GROUPS),
            [
                f"tractions {state}, {how}",
                f"  {'':26}{'first':>14} {'second':>14}   largest and root-mean-square difference",
                *(
                    f"  {name:26}{first:14.6g} {second:14.6g}   {largest:<10.3g}{mean_square:<10.3g}{_html.unit(unit)}"
                    for name, unit, first, second, largest, mean_square in self.tractions
                ),
            ],
            [f"largest difference of the tractions / largest traction: {self.largest_difference:.3g}"],
        ]
        return "\n\n".join("\n".join(block) for block in blocks if block)

    def _number_lines(self, group: str) -> list[str]:
        """The numbers of one group, one per line."""
        numbers = [number for number in self.numbers if number.group == group]
        if not numbers:
            return []
        lines = [f"{group:28}{'first':>14} {'second':>14}   relative difference"]
        return lines + [
            f"  {number.name:26}{_figure(number.first):>14} {_figure(number.second):>14}   "
            f"{_figure(number.relative_difference, 3):<10}"
            f"{_html.unit(number.unit)}".rstrip()
            + (doubt(self.first, number.name) or doubt(self.second, number.name))
            for number in numbers
        ]


def compare(first: Result, second: Result, step: int | None = None) -> Comparison:
    """The comparison of two results, of their last states or of `steps[step - 1]`.

    Tractions on different meshes are interpolated linearly to the nodes of both; outside a mesh they are zero. Units are not
    converted. Raises ValueError if a result has no such state.
    """
    states = first.at(step), second.at(step)
    meshes = drawn_at(first), drawn_at(second)
    x = np.union1d(*meshes)
    values = {name: [np.interp(x, mesh, state[name], 0.0, 0.0) for mesh, state in zip(meshes, states)] for name in TRACTIONS}
    differences = [np.max(np.abs(one - other)) for one, other in values.values()]
    return Comparison(
        first,
        second,
        step,
        [one for one in _different(first.attributes, second.attributes) if one.name not in NOT_SETTINGS],
        _different_keys(first, second),
        [number for group in GROUPS for number in _numbers(group, getattr(first, group), getattr(second, group))],
        [_traction(name, states[0].unit(name), *values[name]) for name in TRACTIONS],
        _ratio(max(differences), np.max(np.abs(list(values.values())))),
        not np.array_equal(*meshes),
    )


def relative_difference(first: float, second: float) -> float:
    """Difference of two numbers relative to the larger; 0 if they are equal, infinite if one of them is, NaN if one is NaN."""
    if first == second:
        return 0.0
    if not np.isfinite(first + second):
        return float(abs(second - first))
    return abs(second - first) / max(abs(first), abs(second))


def _different_keys(first: Result, second: Result) -> list[Setting] | str:
    """Input keys that differ, or why they cannot be compared."""
    try:
        return _different(keys(first.attributes["input"]), keys(second.attributes["input"]))
    except ValueError as error:
        return str(error)


def _different(one: Mapping[str, Any], other: Mapping[str, Any]) -> list[Setting]:
    names = [*one, *(name for name in other if name not in one)]
    return [Setting(name, one.get(name), other.get(name)) for name in names if one.get(name) != other.get(name)]


def _numbers(name: str, first: Group, second: Group) -> list[Number]:
    """The numbers of one group of both results, those of the first one first."""
    found = []
    for key in [*first, *(key for key in second if key not in first)]:
        source = first if key in first else second
        if np.ndim(source[key]) == 0:
            values = (float(group[key]) if key in group else np.nan for group in (first, second))
            found.append(Number(name, key, source.unit(key), source.description(key), *values))
    return found


def _traction(name: str, unit: str, one: Array, other: Array) -> Traction:
    """Differences of a traction at the same nodes."""
    largest = float(np.max(np.abs((one, other))))
    difference = np.abs(one - other)
    return Traction(
        name,
        unit,
        float(np.max(np.abs(one))),
        float(np.max(np.abs(other))),
        _ratio(np.max(difference), largest),
        _ratio(np.sqrt(np.mean(difference**2)), largest),
    )


def _ratio(part: float, whole: float) -> float:
    """part/whole, 0 if both are zero."""
    return 0.0 if part == 0.0 else float(part / whole)


def _setting_lines(heading: str, settings: list[Setting]) -> list[str]:
    """Settings, one per line, in columns."""
    if not settings:
        return [f"{heading}: none"]
    width = max(len("first"), min(48, max(len(_text(first)) for _, first, _ in settings))) + 1
    return [
        f"{heading:34}{'first':{width}} second",
        *(f"  {name:31} {_text(first):{width}} {_text(second)}".rstrip() for name, first, second in settings),
    ]


def _text(value: Any) -> str:
    """A setting on one line; - for None."""
    return "-" if value is None else "; ".join(str(value).splitlines())


def _figure(value: float, digits: int = 6) -> str:
    """A number; - for NaN."""
    return "-" if np.isnan(value) else f"{value or 0.0:.{digits}g}"
