"""Axes of a study: keys of the case and their values, one or several axes along a dimension."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from .. import errors
from .._library import library, text_for
from ..errors import MfvError, input_error
from ..scene import _scene_handle, _set_key, _text_of_scene, created
from .cases import DUNDURS_BETA, key_info

#: Keys of the materials that dundurs_beta replaces.
OF_MATERIALS = ("shear_modulus", "youngs_modulus", "poisson_ratio", "rigid")


@dataclass(frozen=True)
class Axis:
    """Values of one key of the case, or of several that change together, each multiplied by the factor of its key.

    `keys`: such as 'friction%mu', or ['step(2)%force_ratio', 'step(3)%force_ratio'] with `factors` [1, -1]. The factor of a key of
    &history may be a list, with one factor per turning point.
    """

    keys: str | Sequence[str]
    values: Iterable[Any]
    factors: Sequence[Any] | None = None


def fault(message: str, axis: int, part: str) -> MfvError:
    """The InputError about an axis, by its number from 0, and a part of it: its key, values, factor or name."""
    error = input_error(message)
    error.where = axis, part
    return error


class Coordinate:
    """A named list of values along a dimension, and the keys that take them."""

    def __init__(self, name: str, keys: Sequence[str], values: Iterable[Any], factors: Sequence[Any] | None = None) -> None:
        """Raises InputError."""
        self.name = name
        self.keys = tuple(_in_one_form(key) for key in keys)
        self.values = [_plain(value) for value in values]
        self.factors = (1,) * len(self.keys) if factors is None else tuple(factors)
        if len(self.factors) != len(self.keys):
            raise fault(f"{name}: must have one value per key ({len(self.keys)}), not {len(self.factors)}", 0, "factor")
        if not self.values:
            raise fault(f"{name}: no values given", 0, "values")
        check_name(name)
        for factor in self.factors:
            for one in factor if isinstance(factor, Sequence) else [factor]:
                if one != 1 or isinstance(factor, Sequence):
                    self._check_products(one)

    def settings(self, place: int) -> list[tuple[str, Any]]:
        """The keys and their values at a place, from 0."""
        value = self.values[place]
        return [(key, _times(value, factor)) for key, factor in zip(self.keys, self.factors)]

    def _check_products(self, factor: float) -> None:
        for value in self.values:
            if isinstance(value, bool) or not isinstance(value, (int, float)):
                raise fault(f"{as_written(value)} is not a number and cannot be multiplied by {factor:g}", 0, "factor")
            if not math.isfinite(float(value) * factor):
                raise fault(f"{as_written(value)} times {factor:g} overflows", 0, "factor")


class Dimension:
    """A dimension of the study: one axis, or several that change together."""

    def __init__(self, name: str, coordinates: Sequence[Coordinate]) -> None:
        """Raises InputError without axes, or for axes of different lengths."""
        check_name(name)
        self.name = name
        self.coordinates = list(coordinates)
        if not self.coordinates:
            raise input_error(f"{name}: no axes given")
        for other in self.coordinates[1:]:
            if len(other.values) != len(self):
                first = self.coordinates[0]
                raise input_error(
                    f"{other.name} has {len(other.values)} values, but {first.name} has {len(self)}; paired axes need equal numbers"
                )

    def __len__(self) -> int:
        return len(self.coordinates[0].values)


def _times(value: Any, factor: float | Sequence[float]) -> Any:
    """A value times its factor; a list for a list of factors."""
    if isinstance(factor, Sequence):
        return [value * one for one in factor]
    return value if factor == 1 else value * factor


def check_name(name: Any) -> None:
    """Raises InputError for an invalid name of an axis or a dimension."""
    if not isinstance(name, str) or not name or name != name.strip() or "/" in name:
        raise fault(
            f"{name!r}: a name must be a non-empty text without / and without blanks at either end",
            0,
            "name",
        )


def as_written(value: Any) -> str:
    """A value as written in a namelist."""
    if isinstance(value, bool):
        return ".true." if value else ".false."
    if isinstance(value, list):
        return ", ".join(map(as_written, value[:3])) + (", ..." if len(value) > 3 else "")
    return f"'{value}'" if isinstance(value, str) else repr(value)


def _in_one_form(key: Any) -> str:
    """A key in lower case, its number without leading zeros, so that equivalent keys are equal. Raises TypeError."""
    if not isinstance(key, str):
        raise TypeError(f"must be a key of the case such as 'friction%mu', not {key!r}")
    return re.sub(r"\(0+(?=\d)", "(", key.lower())


def _plain(value: Any) -> Any:
    """A value without the types of numpy, pandas and pathlib."""
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    return value.tolist() if hasattr(value, "tolist") else value


def dimensions_of(axes: Any, *, are_keys: bool = True) -> list[Dimension]:
    """The dimensions from the axes of `study`. `are_keys`: whether a name without an Axis is a key.

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
    if not isinstance(values, Axis):
        return Coordinate(name, [name] if are_keys else [], _listed(name, values))
    keys = [values.keys] if isinstance(values.keys, str) else list(values.keys)
    if not keys:
        raise fault(f"{name}: no keys given", 0, "key")
    factors = None if values.factors is None else _listed(name, values.factors)
    return Coordinate(name, keys, _listed(name, values.values), factors)


def _listed(name: str, values: Any) -> list[Any]:
    """Values as a list. Raises TypeError for a single one."""
    if isinstance(values, (str, Mapping)) or not isinstance(values, Iterable):
        raise TypeError(f"{name}: must be a list of values or a mfv.Axis, not {values!r}")
    return list(values)


def _columns_of_table(table: Any) -> dict[str, list[Any]]:
    """The columns of a table of cases: a pandas.DataFrame, or a list with a mapping for each case. Raises TypeError."""
    if hasattr(table, "columns"):
        if len(set(table.columns)) < len(table.columns) or len(table) == 0:
            raise input_error("a table of cases must have rows and unique column names")
        return {str(name): list(table[name]) for name in table.columns}
    rows = _listed("a table of cases", table)
    if not rows or not all(isinstance(row, Mapping) and row.keys() == rows[0].keys() for row in rows):
        raise TypeError("a table of cases must be a pandas.DataFrame or a list of mappings with equal keys, one per case")
    return {str(name): [row[name] for row in rows] for name in rows[0]}


def fault_of_key(key: str) -> str:
    """Why a study cannot set a key, as a message of the library; empty if it can."""
    if key == DUNDURS_BETA:
        return ""
    if key == "output%file":
        return "'output%file': cannot be varied; the study names the result files"
    if key_info(key) is None:
        with _scene_handle("", "key") as handle:
            _set_key(handle, key, 0)
            try:
                created("mfv_create", handle)
            except errors.InputError as error:
                told = error.message.removeprefix("key: ")
                return told if "%" in key else f"{told} or '{DUNDURS_BETA}'"
    return ""


def fault_of_pair(one: str, other: str) -> str:
    """Why a study cannot vary both keys; empty if it can."""
    for beta, key in ((one, other), (other, one)):
        if beta == DUNDURS_BETA and key.partition("%")[2] in OF_MATERIALS:
            return f"'{key}' and '{DUNDURS_BETA}' cannot be varied in one study: {DUNDURS_BETA} sets the materials of both bodies"
    return f"'{other}' is already varied" if one == other or _stands_for(one, other) else ""


def _stands_for(one: str, other: str) -> bool:
    """Whether one key is an alternative to another, according to the library."""
    if DUNDURS_BETA in (one, other) or one.partition("%")[0] != other.partition("%")[0]:
        return False
    with _scene_handle("", "keys") as handle:
        _set_key(handle, one, 0)
        before = _text_of_scene(handle)
        library().mfv_scene_make_room(handle, text_for(other))
        return _text_of_scene(handle) != before


def numbered_group(key: str) -> tuple[str, int | None]:
    """Group of a key, and its number if it has one."""
    group, _, _ = key.partition("%")
    name, bracket, number = group.partition("(")
    return name, int(number.rstrip(")")) if bracket else None
