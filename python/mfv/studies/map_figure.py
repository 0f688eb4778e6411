"""Picture of a map: regimes as fills with their names, exact boundaries, contour lines of a column; values in doubt have hollow markers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import matplotlib
import numpy as np
from matplotlib import patheffects
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from .. import drawing
from .._suggestions import LISTED_BY, suggestion
from ..views import is_named
from .dataset import flagged, label
from .maps import FAILED, OPEN, PARTIAL, SLIDING, STICK, YIELDING, polygons

if TYPE_CHECKING:
    import xarray

#: Fills of the regimes; partial slip is the ground on which the others lie.
FILLS = {STICK: drawing.STICK, PARTIAL: "#FEF3DC", SLIDING: drawing.LEFT, OPEN: drawing.WITHOUT_FRICTION, FAILED: "#FFFFFF"}
DOUBT = "0.45"

#: Words and symbols of the axes.
AXES = {
    "Q": ("tangential force", "Q"),
    "P": ("normal force", "P"),
    "D": ("shift", r"\delta"),
    "B": ("bulk stress", r"\sigma_B"),
    "mu": ("coefficient of friction", r"\mu"),
}

#: Ratio of largest and smallest value from which the levels of contours are in a geometric sequence; their number; steps within a decade.
WIDE, LEVELS = 30.0, 7
STEPS = ((1.0,), (1.0, 3.0), (1.0, 2.0, 5.0))

#: Width of a letter of a name over its height, for the distance of the name from other things.
LETTER = 0.3


def figure(table: xarray.Dataset, column: str | None = None) -> Figure:
    """A picture of `regimes`."""
    with matplotlib.rc_context(drawing.STYLE):
        picture = Figure(figsize=(5.6, 4.4), layout="constrained")
        regimes(table, column, picture.subplots())
    return picture


def regimes(table: xarray.Dataset, column: str | None = None, ax: Axes | None = None) -> Axes:
    """The regimes of a map over its axes, with contour lines of a column, into `ax` or new axes.

    Boundaries are solid, dashed where the mesh does not resolve them; yielding is hatched. Contours end where a case ended early.
    Markers are hollow where `mfv.studies.flagged` says that the column is in doubt. `column`: by default that of the map.
    Raises ValueError for the table of another study, and for an unknown column.
    """
    if "map_axes" not in table.attrs:
        raise ValueError("not the table of a map: mfv.studies.regime_map makes one")
    name = str(table.attrs["map_contour"] if column is None else column)
    known = [str(one) for one in table.data_vars if table[one].dims == table["case"].dims and table[one].dtype.kind in "biuf"]
    if name not in known:
        raise ValueError(f"no column '{name}' in the table{suggestion(name, known, listed_by=LISTED_BY)}")
    axes = ax or Figure(figsize=(5.6, 4.4), layout="constrained").subplots()
    across, up = (str(one) for one in table.attrs["map_axes"])
    x, y = table[across].values, table[up].values
    axes.set(xlim=(x[0], x[-1]), ylim=(y[0], y[-1]), facecolor=FILLS[PARTIAL], xlabel=_axis(table, across), ylabel=_axis(table, up))
    _fill(table, axes)
    _draw_boundaries(table, axes)
    texts = _draw_contours(table, name, axes)
    _mark_doubt(table, name, axes)
    _name_regimes(table, axes, texts)
    return axes


def _axis(table: xarray.Dataset, name: str) -> str:
    if name not in AXES:
        return label(table, name)
    unit = table[name].attrs.get("units", "1")
    return drawing.label(*AXES[name], "" if unit == "1" else unit)


def _fill(table: xarray.Dataset, axes: Axes) -> None:
    """The fills of all regimes but partial slip; yielding and failed cases as hatches, which gross sliding hides."""
    if "yields" in table:
        axes.add_collection(
            PolyCollection(polygons(table, YIELDING), facecolor="none", edgecolor="0.7", hatch="///", linewidth=0.0, zorder=0.6)
        )
    for regime in (STICK, SLIDING, OPEN):
        colour, order = FILLS[regime], 0.5 if regime == STICK else 0.7
        axes.add_collection(
            PolyCollection(polygons(table, regime), facecolor=colour, edgecolor=colour, linewidth=0.3, zorder=order)
        )
    axes.add_collection(
        PolyCollection(polygons(table, FAILED), facecolor=FILLS[FAILED], edgecolor="0.8", hatch="xxx", linewidth=0.0, zorder=0.8)
    )


def _draw_boundaries(table: xarray.Dataset, axes: Axes) -> None:
    """The curves of the boundaries."""
    x, y = (table[f"boundary_{name}"].values for name in table.attrs["map_axes"])
    curve, resolved = table["boundary_curve"].values, table["boundary_resolved"].values
    for number in np.unique(curve):
        of = curve == number
        style = "-" if resolved[of].all() else (0, (5, 2))
        axes.plot(x[of], y[of], color=drawing.MARKS, linewidth=1.4, linestyle=style, zorder=2.5, solid_capstyle="butt")


def _draw_contours(table: xarray.Dataset, name: str, axes: Axes) -> list[NDArray[Any]]:
    """Contour lines of a column where cases are complete, with their values; places of these as fractions of the axes."""
    values = np.where(table["outcome"].values == "complete", table[name].values.astype(float), np.nan)
    values = np.ma.masked_invalid(values)
    levels = _levels(values.compressed())
    if not levels.size:
        return []
    across, up = table.attrs["map_axes"]
    lines = axes.contour(table[across].values, table[up].values, values.T, levels, colors=drawing.NUMBERS, linewidths=0.8, zorder=2)
    power = _power(levels)
    texts = axes.clabel(lines, fmt=lambda value: _written(value / 10.0**power), fontsize=8)
    for text in texts:
        text.set_path_effects([patheffects.withStroke(linewidth=2.0, foreground="white")])
    about = table[name].attrs
    unit = about.get("units", "1") if is_named(about.get("units", "1")) else ""
    unit = unit.replace("$", r"\$").replace("^2", "$^2$")
    shown = " ".join(part for part in (f"$10^{{{power}}}$" if power else "", unit) if part)
    meaning = f"lines: {about.get('long_name', name).split(';')[0]}"
    axes.set_title(f"{meaning} [{shown}]" if shown else meaning, fontsize=9, color=drawing.NUMBERS, loc="left", wrap=True)
    to_axes = axes.transLimits
    return [np.asarray(to_axes.transform(text.get_position())) for text in texts]


def _levels(values: NDArray[Any]) -> NDArray[Any]:
    """Levels of contours; none if the values do not vary."""
    if values.size < 4 or not np.ptp(values) > 0.0:
        return np.empty(0)
    # A few percent of the values at the lower end would make levels of their own.
    low, high = np.quantile(values, (0.03, 1.0))
    if low > 0.0 and high > WIDE * low:
        decades = range(int(np.floor(np.log10(low))), int(np.ceil(np.log10(high))) + 1)
        rows = (
            [step * 10.0**decade for decade in decades for step in steps if low <= step * 10.0**decade <= high] for steps in STEPS
        )
        return np.array(min(rows, key=lambda row: abs(len(row) - LEVELS)))
    levels: NDArray[Any] = np.asarray(MaxNLocator(LEVELS).tick_values(low, high))
    inner: NDArray[Any] = levels[(levels > low) & (levels < high)]
    return inner


def _power(levels: NDArray[Any]) -> int:
    """The power of ten that the labels of levels leave out: 0 for usual numbers, and for those of many decades."""
    sizes = np.log10(np.abs(levels[levels != 0.0]))
    largest = int(np.floor(sizes.max()))
    return largest if abs(largest) > 2 and np.ptp(sizes) < 2.5 else 0


def _written(value: float) -> str:
    """A number as the label of a contour line."""
    if value == 0.0 or 1.0e-3 <= abs(value) < 1.0e4:
        return f"{value:.4g}"
    power = int(np.floor(np.log10(abs(value)) + 1.0e-9))
    digits = f"{value / 10.0**power:.3g}"
    return f"$10^{{{power}}}$" if digits == "1" else rf"${digits}\cdot10^{{{power}}}$"


def _mark_doubt(table: xarray.Dataset, name: str, axes: Axes) -> None:
    """Hollow markers where a column is in doubt; the hatch of yielding says it there."""
    doubtful = flagged(table, name).values & (table["outcome"].values == "complete")
    if "yields" in table:
        doubtful &= ~(table["yields"].values > 0.0)
    if not doubtful.any():
        return
    across, up = table.attrs["map_axes"]
    i, j = np.nonzero(doubtful)
    style: dict[str, Any] = {"markersize": 2.4, "markerfacecolor": "white", "markeredgecolor": DOUBT, "markeredgewidth": 0.5}
    axes.plot(
        table[across].values[i], table[up].values[j], "o", zorder=1.5, clip_on=False, label="in doubt: see its warnings", **style
    )
    axes.figure.legend(loc="outside lower right", fontsize=8, handletextpad=0.2, borderpad=0.0)


def _name_regimes(table: xarray.Dataset, axes: Axes, texts: Sequence[NDArray[Any]]) -> None:
    """The name of every regime within it, far from all boundaries and from `texts`."""
    across, up = (np.linspace(0.0, 1.0, table.sizes[table[name].dims[0]]) for name in table.attrs["map_axes"])
    places = np.stack(np.meshgrid(across, up, indexing="ij"), axis=-1)
    regime = table["regime"].values
    yields = table["yields"].values > 0.0 if "yields" in table else np.zeros(regime.shape, dtype=bool)
    named = [(str(one), regime == one) for one in np.unique(regime.astype(str))]
    named = [(name, inside & ~yields if (inside & ~yields).any() else inside) for name, inside in named] + [(YIELDING, yields)]
    lines = [table[f"boundary_{name}"].values for name in table.attrs["map_axes"]]
    taken = [*texts, *axes.transLimits.transform(np.column_stack(lines))]
    edges = np.array([[0.0, 0.0], [1.0, 1.0]])
    for name, inside in named:
        if not inside.any():
            continue
        outside = [*places[~inside], *taken]
        here = places[inside]
        size = [LETTER * len(name), 1.0]
        space = np.min(np.abs(here[:, None, :] - edges) / size, axis=(1, 2))
        if outside:
            apart = (here[:, None, :] - np.array(outside)[None, :, :]) / size
            space = np.minimum(space, np.sqrt(np.min(np.sum(apart**2, axis=2), axis=1)))
        place = here[int(np.argmax(space))]
        taken.append(place)
        text = axes.text(
            float(place[0]), float(place[1]), name, transform=axes.transAxes, ha="center", va="center", fontsize=10, zorder=3
        )
        text.set_path_effects([patheffects.withStroke(linewidth=2.5, foreground=FILLS.get(name, "white"))])
