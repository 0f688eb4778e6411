"""What a study varies: axes with their keys and values, one or several along a dimension."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..errors import MfvError, input_error


@dataclass(frozen=True)
class Axis:
    """Values of one key of the case, or of several that move together, each times the factor of its key.

    `keys`: such as 'friction%mu', or ['step(2)%force_ratio', 'step(3)%force_ratio'] with `factors` [1, -1].
    """

    keys: str | Sequence[str]
    values: Iterable[Any]
    factors: Sequence[float] | None = None


def fault(message: str, axis: int, part: str) -> MfvError:
    """The InputError about an axis, by its number from 0, and a part of it: its key, values, factor or name."""
    error = input_error(message)
    error.where = axis, part
    return error


class Coordinate:
    """A named list of values along a dimension, and the keys that take them."""

    def __init__(
        self, name: str, keys: Sequence[str], values: Iterable[Any], factors: Sequence[float] | None = None
    ) -> None:
        """Raises InputError."""
        self.name = name
        self.keys = tuple(keys)
        self.values = [value.item() if isinstance(value, np.generic) else value for value in values]
        self.factors = (1,) * len(self.keys) if factors is None else tuple(factors)
        if len(self.factors) != len(self.keys):
            raise fault(f"{name}: must have one value a key, {len(self.keys)}, not {len(self.factors)}", 0, "factor")
        if not self.values:
            raise fault(f"{name}: there are no values", 0, "values")
        if not name or name != name.strip() or "/" in name:
            raise fault(f"{name!r}: a name must not be empty, begin or end with a blank, or have a /", 0, "name")
        for factor in self.factors:
            if factor != 1:
                self._check_products(factor)

    def settings(self, place: int) -> list[tuple[str, Any]]:
        """The keys with what each becomes at a place, from 0."""
        value = self.values[place]
        return [(key, value if factor == 1 else value * factor) for key, factor in zip(self.keys, self.factors)]

    def shown(self, place: int) -> str:
        """The value at a place as one would write it."""
        return as_written(self.values[place])

    def _check_products(self, factor: float) -> None:
        for value in self.values:
            if isinstance(value, (str, bool)):
                raise fault(f"{as_written(value)} is no number, and cannot be multiplied by {factor:g}", 0, "factor")
            if not math.isfinite(float(value) * factor):
                raise fault(f"{as_written(value)} times {factor:g} is too large for a number", 0, "factor")


class Dimension:
    """A dimension of the study: one axis, or several that move together along it."""

    def __init__(self, name: str, coordinates: Sequence[Coordinate]) -> None:
        """Raises InputError where the axes do not have the same number of values."""
        self.name = name
        self.coordinates = list(coordinates)
        for other in self.coordinates[1:]:
            if len(other.values) != len(self):
                first = self.coordinates[0]
                raise input_error(
                    f"{other.name} has {len(other.values)} values, {first.name} has {len(self)}: they are paired"
                )

    def __len__(self) -> int:
        return len(self.coordinates[0].values)


def as_written(value: Any) -> str:
    """A value as a namelist has it."""
    if isinstance(value, bool):
        return ".true." if value else ".false."
    return f"'{value}'" if isinstance(value, str) else repr(value)


def dimensions_of(axes: Any, *, are_keys: bool = True) -> list[Dimension]:
    """The dimensions of what `study` takes as axes. `are_keys`: whether a name without an Axis is that of a key.

    Raises InputError, TypeError.
    """
    if axes is None:
        return []
    if isinstance(axes, Mapping):
        return [_dimension(name, values, are_keys) for name, values in axes.items()]
    columns = _columns_of_table(axes)
    return [Dimension("row", [_coordinate(name, values, are_keys) for name, values in columns.items()])]


def _dimension(name: str, values: Any, are_keys: bool) -> Dimension:
    if isinstance(values, Mapping):
        return Dimension(name, [_coordinate(inner, column, are_keys) for inner, column in values.items()])
    return Dimension(name, [_coordinate(name, values, are_keys)])


def _coordinate(name: str, values: Any, are_keys: bool) -> Coordinate:
    if isinstance(values, Axis):
        keys = [values.keys] if isinstance(values.keys, str) else values.keys
        return Coordinate(name, keys, values.values, values.factors)
    if isinstance(values, str) or not isinstance(values, Iterable):
        raise TypeError(f"{name}: a list of values or a mfv.Axis is wanted, not {values!r}")
    return Coordinate(name, [name] if are_keys else [], values)


def _columns_of_table(table: Any) -> dict[str, list[Any]]:
    """The columns of a table of cases: a pandas.DataFrame, or a list with a mapping for each case. Raises TypeError."""
    if hasattr(table, "columns"):
        return {str(name): list(table[name]) for name in table.columns}
    rows = list(table)
    if not rows or not all(isinstance(row, Mapping) and row.keys() == rows[0].keys() for row in rows):
        raise TypeError("a table of cases is a pandas.DataFrame, or a list of mappings, one a case, with the same keys")
    return {str(name): [row[name] for row in rows] for name in rows[0]}
