"""A picture of a contact with several patches, such as that of a rough profile: all patches, the one with the largest load, the gap."""

from __future__ import annotations

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from . import drawing
from .codes import NodeStatus
from .result import Group, Result
from .stress import drawn_at, is_radial
from .views import along_surface, friction_limits, has_friction, intervals

#: Size of the picture and of a row, inch.
WIDTH, ROW = 10.8, 2.4
#: Margin on either side of the patch in the narrow column, relative to its length.
AROUND = 0.35
#: The largest number of patches that are numbered; more numbers would overlap.
MOST_NUMBERS = 20


def patches_of(result: Result, state: Group) -> list[tuple[float, float]]:
    """Left and right ends of the patches of a state, x: edges between nodes of the last state, else ends of the nodes' intervals."""
    if state is result.state and "patch" in result.patches and not is_radial(result):
        edges = result.patches.contact_left, result.patches.contact_right
        return [(float(left), float(right)) for left, right in zip(*edges)]
    starts, ends = intervals(result)
    return [(float(starts[first]), float(ends[last])) for first, last in _touching_nodes(state)]


def _touching_nodes(state: Group) -> list[tuple[int, int]]:
    """First and last node of every patch."""
    touching = (state.status != NodeStatus.OPEN).astype(int)
    return [(first, last) for is_patch, first, last in drawing.runs(touching) if is_patch]


def figure(result: Result, step: int | None = None) -> Figure:
    """Rows for pressure, shear traction (with friction) and gap; a wide column for all patches, a narrow one for the patch with the
    largest load. See `figure` in plot."""
    state = result.at(step)
    patches = patches_of(result, state)
    panels = [_pressure, _shear, _gap] if has_friction(result) else [_pressure, _gap]
    chosen = _largest(result, state)
    with matplotlib.rc_context(drawing.STYLE):
        picture = Figure(figsize=(WIDTH, ROW * len(panels) + 1.0), layout="constrained")
        axes = picture.subplots(len(panels), 2, sharex="col", squeeze=False, width_ratios=(2.4, 1.0))
        for panel, row in zip(panels, axes):
            for ax in row:
                panel(result, state, patches, ax)
            row[1].set_ylabel("")
        _frame(result, patches, chosen, axes)
        axes[0, 0].set_title(f"{len(patches)} patches")
        axes[0, 1].set_title(f"patch {chosen + 1} (largest load)")
        picture.suptitle(drawing.heading(result, step), fontsize=12, parse_math=False)
        drawing.add_legend(picture, drawing.caption(result, step), lines_first=False)
    return picture


def _largest(result: Result, state: Group) -> int:
    """Index of the patch with the largest load."""
    forces = result.mesh.width * state.pressure
    return int(np.argmax([np.sum(forces[first : last + 1]) for first, last in _touching_nodes(state)]))


def _pressure(result: Result, state: Group, patches: list[tuple[float, float]], ax: Axes) -> None:
    """Pressure, filled, patch by patch down to zero at its edges."""
    for number, (x, values) in enumerate(_by_patch(result, state, patches, state.pressure)):
        ax.fill_between(x, values, color=drawing.NUMBERS, alpha=0.18, linewidth=0.0)
        ax.plot(x, values, color=drawing.NUMBERS, linewidth=0.9, label="pressure" if number == 0 else "_more")
    ax.set_ylim(0.0, 1.12 * float(state.pressure.max()))
    ax.set_ylabel(drawing.label("pressure", "p", state.unit("pressure")))


def _shear(result: Result, state: Group, patches: list[tuple[float, float]], ax: Axes) -> None:
    """Shear traction between the limits of friction, stick and slip zones of every patch."""
    drawing.shade_zones(ax, result, state)
    for index, coefficient in friction_limits(result):
        style = drawing.limit_style(index)
        for sign in (1.0, -1.0):
            for x, values in _by_patch(result, state, patches, sign * coefficient * state.pressure):
                ax.plot(x, values, **style)
                style["label"] = "_more"
    for number, (x, values) in enumerate(_by_patch(result, state, patches, state.shear)):
        ax.plot(x, values, color=drawing.CLOSED_FORM, linewidth=1.0, label="shear traction" if number == 0 else "_more")
    ax.axhline(0.0, color="0.6", linewidth=0.4, zorder=0.5)
    ax.set_ylabel(drawing.label("shear traction", r"\tau", state.unit("shear")))


def _gap(result: Result, state: Group, patches: list[tuple[float, float]], ax: Axes) -> None:
    """The gap between the deformed surfaces, the patches shaded."""
    for number, (left, right) in enumerate(patches):
        ax.axvspan(
            left, right, color=drawing.WITHOUT_FRICTION, linewidth=0.0, zorder=0, label="contact patch" if number == 0 else "_more"
        )
    gap = np.where(np.isfinite(state.gap), np.maximum(state.gap, 0.0), np.nan)
    ax.fill_between(drawn_at(result), gap, color=drawing.SURFACE, alpha=0.18, linewidth=0.0)
    ax.plot(drawn_at(result), gap, color=drawing.SURFACE, linewidth=0.9, label="gap")
    ax.set_ylim(bottom=0.0)
    ax.set_ylabel(drawing.label("gap", "g", state.unit("gap")))
    ax.set_xlabel(drawing.label(*along_surface(result)))


def _by_patch(
    result: Result, state: Group, patches: list[tuple[float, float]], values: np.ndarray
) -> list[tuple[np.ndarray, np.ndarray]]:
    """Places and values of every patch. A traction ends at the patch's edges, at zero unless it is singular there."""
    curves = []
    for (first, last), (left, right) in zip(_touching_nodes(state), patches):
        x, y, pressure = (array[first : last + 1] for array in (drawn_at(result), values, state.pressure))
        falls = len(x) < 2 or pressure[0] < pressure.max(), len(x) < 2 or pressure[-1] < pressure.max()
        ends = np.where(falls, 0.0, (y[0], y[-1]))
        across = np.concatenate(([min(left, x[0])], x, [max(right, x[-1])]))
        curves.append((across, np.concatenate(([ends[0]], y, [ends[1]]))))
    return curves


def _frame(result: Result, patches: list[tuple[float, float]], chosen: int, axes: np.ndarray) -> None:
    """Limits of both columns, numbers of the patches, and marks where the narrow column is in the wide one."""
    starts, stops = intervals(result)
    ends = float(starts[0]), float(stops[-1])
    margin = 0.08 * (patches[-1][1] - patches[0][0])
    axes[0, 0].set_xlim(max(ends[0], patches[0][0] - margin), min(ends[1], patches[-1][1] + margin))
    left, right = patches[chosen]
    shown = max(ends[0], left - AROUND * (right - left)), min(ends[1], right + AROUND * (right - left))
    axes[0, 1].set_xlim(*shown)
    axes[0, 1].locator_params(axis="x", nbins=4)
    for ax in axes[:, 0]:
        for place in shown:
            ax.axvline(place, color="0.5", linewidth=0.6, linestyle=(0, (2, 3)))
    if len(patches) <= MOST_NUMBERS:
        for number, (first, last) in enumerate(patches, start=1):
            axes[0, 0].annotate(
                str(number), (0.5 * (first + last), 1.0), xycoords=("data", "axes fraction"), xytext=(0, -3),
                textcoords="offset points", ha="center", va="top", fontsize=8,
            )  # fmt: skip
    _limit_gap(axes[-1, 1], shown)


def _limit_gap(ax: Axes, shown: tuple[float, float]) -> None:
    """The gap of the narrow column over what it shows."""
    x, values = ax.lines[0].get_xdata(), ax.lines[0].get_ydata()
    here = np.asarray(values)[(np.asarray(x) >= shown[0]) & (np.asarray(x) <= shown[1])]
    largest = float(np.nanmax(here)) if np.isfinite(here).any() else 0.0
    if largest > 0.0:
        ax.set_ylim(0.0, 1.15 * largest)
