"""A picture of two results: the first, the second, both superposed."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any, Callable

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from . import drawing, plot
from .compare import Comparison
from .stress import drawn_at
from .views import has_friction, heights, is_sheared

#: Styles of the two superposed results, and of their difference.
STYLES: tuple[dict[str, Any], dict[str, Any]] = (
    {"label": "first", "color": drawing.NUMBERS, "linewidth": 1.0},
    {"label": "second", "color": drawing.CLOSED_FORM, "linewidth": 1.0, "linestyle": (0, (4, 2))},
)
DIFFERENCE: dict[str, Any] = {"label": "second minus first", "color": drawing.SURFACE, "linewidth": 0.8}


def figure(comparison: Comparison, first: str = "first", second: str = "second") -> Figure:
    """A picture of a comparison, a column for each result and one for both superposed; a row for the pressure, one for
    the shear traction and, where a load history has a tangential force, one for that over the shift.

    `first`, `second`: names of the results.
    """
    results = comparison.first, comparison.second
    rows = [plot.pressure, plot.shear if any(map(has_friction, results)) else plot.surfaces]
    if any(map(is_sheared, results)):
        rows.append(plot.loop)
    over: dict[Any, Callable[[Comparison, Axes], None]] = {
        plot.pressure: partial(_draw_tractions, "pressure"),
        plot.shear: partial(_draw_tractions, "shear"),
        plot.surfaces: _draw_gaps,
        plot.loop: _draw_loops,
    }
    with matplotlib.rc_context(drawing.STYLE):
        picture = Figure(figsize=(3 * drawing.PANEL_WIDTH, len(rows) * 0.92 * drawing.PANEL_HEIGHT + 0.9), layout="constrained")
        axes = picture.subplots(len(rows), 3, squeeze=False)
        for panel, row in zip(rows, axes):
            for result, ax in zip(results, row):
                if panel is plot.loop and not is_sheared(result):
                    ax.set_axis_off()
                else:
                    panel(result, ax, comparison.step)
            over[panel](comparison, row[2])
            _unite_limits([ax for ax in row if ax.axison], panel is plot.surfaces)
        for ax, name in zip(axes[0], (first, second, "both")):
            ax.set_title(name, parse_math=False)
        picture.suptitle(
            f"Largest difference of the tractions / largest traction: {comparison.largest_difference:.3g}",
            fontsize=12,
        )
        drawing.add_legend(picture)
    return picture


def _draw_tractions(name: str, comparison: Comparison, ax: Axes) -> None:
    """A traction of both results over x, and its difference."""
    results = comparison.first, comparison.second
    states = [result.at(comparison.step) for result in results]
    for result, state, style in zip(results, states, STYLES):
        ax.plot(drawn_at(result), state[name], **style)
    x = np.union1d(*(drawn_at(result) for result in results))
    one, other = (np.interp(x, drawn_at(r), state[name], 0.0, 0.0) for r, state in zip(results, states))
    ax.plot(x, other - one, **DIFFERENCE)
    drawing.frame_contact(ax, comparison.first, states[0])


def _draw_gaps(comparison: Comparison, ax: Axes) -> None:
    """Deformed surfaces of the lower body of both results."""
    for result, style in zip((comparison.first, comparison.second), STYLES):
        ax.plot(drawn_at(result), heights(result, result.at(comparison.step))[0], **style)
    drawing.frame_contact(ax, comparison.first, comparison.first.at(comparison.step))


def _draw_loops(comparison: Comparison, ax: Axes) -> None:
    """Tangential force over shift, of results that are sheared."""
    for result, style in zip((comparison.first, comparison.second), STYLES):
        if is_sheared(result):
            ax.plot(result.history.shift, result.history.tangential_force, **style)
            ax.set_xlabel(drawing.label("shift", "U", result.history.unit("shift")))
    ax.locator_params(axis="x", nbins=5)
    ax.margins(0.12)


def _unite_limits(axes: Sequence[Axes], only_across: bool) -> None:
    """Give all panels of a row the same limits, so that they can be compared; show equal labels once."""
    across = np.array([ax.get_xlim() for ax in axes])
    up = np.array([ax.get_ylim() for ax in axes])
    for ax in axes:
        ax.set_xlim(across[:, 0].min(), across[:, 1].max())
        if not only_across:
            ax.set_ylim(up[:, 0].min(), up[:, 1].max())
    for ax in axes[1:]:
        if ax.get_ylabel() in ("", axes[0].get_ylabel()):
            ax.set_ylabel("")
