"""Pictures of studies: a column of the table over an axis, with error bars; values in doubt are hollow."""

from __future__ import annotations

from typing import TYPE_CHECKING

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .. import drawing
from .._suggestions import LISTED_BY, suggestion
from .axes import as_written
from .dataset import flagged, label

if TYPE_CHECKING:
    import xarray

#: Columns that are drawn by default, the first that varies; most lines in a picture.
USUAL = ("cycle_dissipation", "dissipation", "lower_tension", "contact_length", "peak_pressure", "approach")
MOST_LINES = 12


def figure(table: xarray.Dataset, column: str | None = None, over: str | None = None) -> Figure:
    """A picture of `lines`."""
    with matplotlib.rc_context(drawing.STYLE):
        picture = Figure(figsize=(6.4, 4.2), layout="constrained")
        lines(table, column, over, picture.subplots())
    return picture


def lines(table: xarray.Dataset, column: str | None = None, over: str | None = None, ax: Axes | None = None) -> Axes:
    """A column of a study's table over one of its axes, a line for every combination of the others, into `ax` or new axes.

    Markers are hollow where `mfv.studies.flagged` says that the value is in doubt; with error bars if the table has them. `column`:
    by default the dissipation of the cycle, or the first of other observables that varies. `over`: by default the axis with most numbers.
    Raises ValueError for other names, and for more than 12 lines; choose some by `table.sel(...)`.
    """
    dimensions = table["case"].dims
    numeric = [
        str(name)
        for name, values in table.variables.items()
        if values.ndim == 1 and values.dtype.kind in "biuf" and set(values.dims) <= set(dimensions)
    ]
    columns = [str(name) for name in table.data_vars if table[name].dims == dimensions and table[name].dtype.kind in "biuf"]
    varied = [name for name in numeric if name in table.coords]
    varying = [one for one in USUAL if one in columns and _varies(table[one])]
    if column is None and not varying:
        raise ValueError(f"none of {', '.join(USUAL)} varies; name a column, which 'mfv info' lists")
    name = _chosen(column, columns, varying, "column")
    usual = sorted(varied, key=lambda one: table[one].size, reverse=True)
    along = _chosen(over, varied, usual, "axis of numbers")
    (dimension,) = table[along].dims
    others = [one for one in dimensions if one != dimension]
    count = int(np.prod([table.sizes[one] for one in others]))
    if count > MOST_LINES:
        raise ValueError(
            f"{name} over {along} has {count} lines; at most {MOST_LINES} can be told apart: fix an axis by table.sel(...)"
        )
    axes = ax or Figure(figsize=(6.4, 4.2), layout="constrained").subplots()
    order = np.argsort(table[along].values)
    doubtful = flagged(table, name)
    colours = matplotlib.colormaps["viridis"](np.linspace(0.0, 0.85, max(count, 1)))
    for number, places in enumerate(np.ndindex(*(table.sizes[one] for one in others))):
        here = dict(zip(map(str, others), places))
        row = table.isel(here).isel({dimension: order})
        x, y, is_hollow = row[along].values, row[name].values, doubtful.isel(here).values[order]
        colour = colours[number]
        axes.plot(x, y, color=colour, linewidth=1.0, label=_line_name(table, here))
        axes.plot(x[~is_hollow], y[~is_hollow], "o", color=colour, markersize=5)
        axes.plot(x[is_hollow], y[is_hollow], "o", color=colour, markersize=5, markerfacecolor="white")
        if f"{name}_error" in row:
            bar = row[f"{name}_error"].values
            has_bar = np.isfinite(bar)
            axes.errorbar(x[has_bar], y[has_bar], bar[has_bar], fmt="none", color=colour, linewidth=0.8, capsize=2)
    if doubtful.any():
        axes.plot([], [], "o", color="black", markersize=5, markerfacecolor="white", label="in doubt: see its warnings")
    axes.set(xlabel=label(table, along), ylabel=label(table, name))
    if count > 1 or doubtful.any():
        axes.legend(fontsize=8)
    return axes


def _chosen(given: str | None, known: list[str], usual: list[str], kind: str) -> str:
    """A name, or the usual one. Raises ValueError."""
    if given is not None and given not in known:
        raise ValueError(f"no {kind} '{given}' in the table{suggestion(given, known, listed_by=LISTED_BY)}")
    if given is None and not usual:
        raise ValueError(f"the table has no {kind} to draw over; 'mfv info' lists its columns")
    return usual[0] if given is None else given


def _varies(values: xarray.DataArray) -> bool:
    finite = values.values[np.isfinite(values.values)]
    return finite.size > 1 and bool(np.ptp(finite) > 0.0)


def _line_name(table: xarray.Dataset, places: dict[str, int]) -> str:
    """The values of the other axes, empty without any."""
    row = table.isel(places)
    named = [one for one in row.coords if row[one].ndim == 0 and set(table[one].dims) & set(places)]
    return ", ".join(f"{label(table, str(one))} = {_short(row[one].values.item())}" for one in named)


def _short(value: object) -> str:
    return value if isinstance(value, str) else f"{value:g}" if isinstance(value, float) else as_written(value)
