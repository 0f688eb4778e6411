"""A picture of the left and right edges of a contact: tractions over the distance from the edge, with their asymptotes."""

from __future__ import annotations

from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from . import drawing
from .codes import NodeStatus
from .result import Result
from .views import has_friction


def figure(result: Result) -> Figure:
    """Both edges of the last state over logarithmic axes: pressure, friction limit and size of the shear; the asymptotes K_N sqrt(s) and
    |K_T|/sqrt(s) of the shear since the last turning point, if stuck; the slip zone. Raises ValueError without intensities."""
    sides = [side for side in ("left", "right") if f"{side}_normal_intensity" in result.observables]
    if not sides:
        raise ValueError("no edges to draw: the pressure vanishes at none, or the mesh has too few nodes there")
    with matplotlib.rc_context(drawing.STYLE):
        picture = Figure(figsize=(2 * drawing.PANEL_WIDTH + 1.0, drawing.PANEL_HEIGHT + 1.0), layout="constrained")
        axes = picture.subplots(1, len(sides), sharey=True, squeeze=False)[0]
        for side, ax in zip(sides, axes):
            edge(result, side, ax)
        axes[0].set_ylabel(drawing.label("tractions", r"p, |\tau|", result.state.unit("pressure")))
        picture.suptitle(drawing.heading(result, None), fontsize=12, parse_math=False)
        drawing.add_legend(picture)
    return picture


def edge(result: Result, side: str, ax: Axes) -> Axes:
    """The `side` ('left' or 'right') edge of a contact in axes of its own."""
    seen, state = result.observables, result.state
    sign = 1.0 if side == "left" else -1.0
    arc = result.mesh.get("arc", result.mesh.x)  # along the surface of a circle
    distance = sign * (arc - np.interp(float(result.summary[f"contact_{side}"]), result.mesh.x, arc))
    shown = (distance > 0.0) & (distance < 0.5 * float(seen.contact_length)) & (state.status != NodeStatus.OPEN)
    s = np.geomspace(0.5 * distance[shown].min(), distance[shown].max(), 200)
    points: dict[str, Any] = {"linestyle": "none", "marker": "o", "markersize": 3.0, "markeredgewidth": 0.0}
    ax.plot(distance[shown], state.pressure[shown], color=drawing.NUMBERS, label="pressure $p$", **points)
    ax.plot(s, seen[f"{side}_normal_intensity"] * np.sqrt(s), color=drawing.NUMBERS, linewidth=0.9, label=r"$K_N\sqrt{s}$")
    if has_friction(result):
        limit = result.mesh.kinetic_friction[shown] * state.pressure[shown]
        ax.plot(distance[shown], limit, color="0.35", linewidth=0.7, label=r"limit $\mu p$")
        ax.plot(distance[shown], np.abs(state.shear[shown]), color=drawing.CLOSED_FORM, label=r"shear $|\tau|$", **points)
    if f"{side}_shear_intensity" in seen:
        stuck = np.abs(seen[f"{side}_shear_intensity"]) / np.sqrt(s)
        ax.plot(
            s, stuck, color=drawing.CLOSED_FORM, linewidth=0.9, label=r"$|K_T|/\sqrt{s}$ if stuck, since the last turning point"
        )
    for name, style, label in (
        ("slip_zone", "-", "slip zone"),
        ("asymptotic_slip_zone", (0, (4, 3)), "slip zone by $K_N$ and $K_T$"),
    ):
        if seen.get(f"{side}_{name}", 0.0) > 0.0:
            ax.axvline(seen[f"{side}_{name}"], color=drawing.SURFACE, linewidth=0.9, linestyle=style, label=label)
    lowest = np.min(state.pressure[shown])
    ax.set(xscale="log", yscale="log", xlim=(s[0], s[-1]), ylim=(0.5 * lowest, 2.0 * np.max(state.pressure[shown])))
    ax.set_xlabel(drawing.label(f"distance from the {side} edge", "s", result.mesh.unit("x")))
    return ax
