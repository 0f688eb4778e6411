"""Means over the realisations of a study, with their confidence intervals."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray
from numpy.typing import NDArray

from .._suggestions import suggestion
from ..errors import input_error
from ..surfaces import mean_and_bar
from .cases import NOT_RESOLVED, observables
from .dataset import UNRESOLVED, UNRESOLVED_MEANING, flagged


def mean_over(table: xarray.Dataset, axis: str, confidence: float = 0.95) -> xarray.Dataset:
    """See `mfv.studies.mean_over`."""
    if not 0.0 < confidence < 1.0:
        raise input_error(f"confidence: must be between 0 and 1, not {confidence!r}")
    dimension = _dimension(table, axis)
    left = [one for one in table["case"].dims if one != dimension]
    ordered = table.transpose(*left, dimension, ...)
    shape, size = tuple(table.sizes[one] for one in left), table.sizes[dimension]
    columns: dict[str, Any] = {
        "case": (left, 1 + np.arange(int(np.prod(shape))).reshape(shape), {"units": "1", "long_name": "number of the mean"}),
        "realisations": (
            left,
            np.sum(ordered["status"].values == 0, axis=-1),
            {"units": "1", "long_name": f"complete cases along {axis}, of {size}"},
        ),
    }
    doubts = np.full(shape, "", dtype=object)
    for name in _averaged(ordered):
        given, meaning = ordered[name], ordered[name].attrs.get("long_name", name)
        mean, half = _mean_and_half(given.values, confidence)
        columns[name] = (left, mean, {**given.attrs, "long_name": f"mean over {axis}: {meaning}"})
        interval = f"half of the {100.0 * confidence:g} % confidence interval of the mean over {axis}: {meaning}"
        columns[f"{name}_error"] = (left, half, {**given.attrs, "long_name": interval})
        doubtful = np.any(flagged(ordered, name).transpose(*left, dimension).values | np.isnan(given.values), axis=-1)
        doubts = doubts + np.where(doubtful & np.isfinite(mean), f"{name} ", "").astype(object)
    doubts = np.vectorize(str.rstrip, otypes=[object])(doubts)
    warned = np.sum(ordered["warnings"].values != "", axis=-1)
    columns["warnings"] = (left, np.vectorize(_warning, otypes=[object])(warned, size), table["warnings"].attrs)
    columns[UNRESOLVED] = (left, doubts, {"units": "1", "long_name": UNRESOLVED_MEANING})
    coordinates = {name: values for name, values in table.coords.items() if dimension not in values.dims}
    return xarray.Dataset(columns, coordinates, {**table.attrs, "mean_over": axis, "confidence": confidence})


def _dimension(table: xarray.Dataset, axis: str) -> str:
    """That of an axis, which must not vary together with others unless it is the name of their dimension. Raises ValueError."""
    dimensions = table["case"].dims
    axes = {str(name): of.dims[0] for name, of in table.coords.items() if of.ndim == 1 and of.dims[0] in dimensions}
    axes.update({str(one): one for one in dimensions if one not in axes and one in table.sizes})
    if axis not in axes:
        raise ValueError(f"no axis '{axis}' in the table{suggestion(axis, axes)}")
    dimension = str(axes[axis])
    others = [name for name, of in axes.items() if of == dimension and name not in (axis, dimension)]
    if others and axis != dimension:
        raise ValueError(f"{axis} varies together with {', '.join(others)}: choose their axis, {dimension}")
    return dimension


def _averaged(table: xarray.Dataset) -> list[str]:
    """Observables and the errors against a reference; without bars and certificates."""
    known = set(observables())
    bars, dimensions = {f"{name}_error" for name in known}, table["case"].dims
    return [
        str(name)
        for name, values in table.data_vars.items()
        if values.dims == dimensions and values.dtype.kind == "f" and name not in bars and name != "largest_residual"
    ]


def _mean_and_half(values: NDArray[np.float64], confidence: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Mean along the last dimension of what is finite, and half of its interval."""
    pairs = np.apply_along_axis(lambda one: mean_and_bar(one[np.isfinite(one)], confidence), -1, values)
    return pairs[..., 0], pairs[..., 1]


def _warning(warned: int, size: int) -> str:
    """How many realisations have warnings. The mesh may be the cause: what is in doubt is named as not resolved."""
    return f"{warned} of {size} realisations have warnings; {NOT_RESOLVED} columns named in {UNRESOLVED}" if warned else ""
