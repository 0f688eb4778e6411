"""Pictures of results: numbers as points, closed forms as lines.

`pressure`, `shear`, `surfaces` and `loop` draw into axes of yours; `figure` makes a picture of what a result has.
"""

from __future__ import annotations

from collections.abc import Iterator

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .codes import EventKind, NodeStatus
from .result import Group, Result, counts

#: Colours from Okabe and Ito, told apart by the colour-blind too.
NUMBERS, CLOSED_FORM, MARKS = "#0072B2", "#D55E00", "#000000"
ZONES = {
    NodeStatus.STICK: {"label": "stick", "facecolor": "#DCEBF5", "edgecolor": "none"},
    NodeStatus.SLIP_RIGHT: {"label": "slip to the right", "facecolor": "#FBE3B4", "edgecolor": "#C9A24B", "hatch": "///"},
    NodeStatus.SLIP_LEFT: {"label": "slip to the left", "facecolor": "#EBD3E1", "edgecolor": "#B98AA6", "hatch": "\\\\\\"},
    NodeStatus.FRICTIONLESS: {"label": "frictionless contact", "facecolor": "#EEEEEE", "edgecolor": "none"},
}

STYLE = {
    "font.family": "serif",
    "font.serif": ["STIXGeneral"],
    "mathtext.fontset": "stix",
    "font.size": 10,
    "axes.titlesize": 10,
    "axes.linewidth": 0.6,
    "axes.formatter.use_mathtext": True,
    "axes.formatter.limits": (-2, 4),
    "hatch.linewidth": 0.4,
    "legend.frameon": False,
    "xtick.direction": "in",
    "ytick.direction": "in",
    "xtick.top": True,
    "ytick.right": True,
}

PANEL_WIDTH, FIGURE_HEIGHT = 3.6, 3.7  # inch

#: Step ends at one place of a load-displacement curve that are all named; of more, the first and the last.
NAMED_TOGETHER = 4


def figure(result: Result, step: int | None = None) -> Figure:
    """A picture of a result: pressure; shear traction, or the surfaces without friction; load-displacement curve.

    `step`: draw the state in `result.steps[step - 1]` in place of the last state. Raises ValueError where there is none.
    """
    panels = [pressure, shear if _has_friction(result) else surfaces]
    if _is_sheared(result):
        panels.append(loop)
    with matplotlib.rc_context(STYLE):
        picture = Figure(figsize=(PANEL_WIDTH * len(panels), FIGURE_HEIGHT), layout="constrained")
        for panel, ax, letter in zip(panels, picture.subplots(1, len(panels)), "abc"):
            panel(result, ax, step)
            ax.set_title(f"({letter})", loc="left")
        picture.suptitle(_heading(result, step), fontsize=11, parse_math=False)
        _legend(picture)
        picture.supxlabel(_caption(result, step), fontsize=7.5, color="0.35", parse_math=False)
    return picture


def pressure(result: Result, ax: Axes, step: int | None = None) -> None:
    """Pressure over x, with its closed form where one holds."""
    state = _state(result, step)
    if "pressure" in result.reference and _same_normal_force(result, step):
        _draw_line(ax, result.mesh.x, result.reference.pressure)
    _draw_points(ax, result, state, state.pressure)
    ax.set_ylim(bottom=0.0)
    ax.set_ylabel(_label("pressure", "p", state.unit("pressure")))
    _frame_contact(ax, result, state)


def shear(result: Result, ax: Axes, step: int | None = None) -> None:
    """Shear traction over x between the limits of friction, stick and slip zones, closed form where one holds."""
    state = _state(result, step)
    limit = result.scene.friction_coefficient * state.pressure
    _shade_zones(ax, result, state)
    for sign in (1.0, -1.0):
        ax.plot(result.mesh.x, sign * limit, color="0.35", linewidth=0.7, label=r"limit $\pm\mu p$")
    if "shear" in result.reference and _is_last(result, state):
        _draw_line(ax, result.mesh.x, result.reference.shear)
    _draw_points(ax, result, state, state.shear)
    ax.set_ylabel(_label("shear traction", r"\tau", state.unit("shear")))
    _frame_contact(ax, result, state)


def surfaces(result: Result, ax: Axes, step: int | None = None) -> None:
    """The deformed surface of the lower body and the upper body on it."""
    state = _state(result, step)
    lower = -state.normal_displacement
    upper = np.where(np.isfinite(state.gap), lower + state.gap, np.nan)
    ax.plot(result.mesh.x, upper, color=MARKS, linewidth=1.0, label="surface of the upper body")
    _draw_points(ax, result, state, lower, label="surface of the lower body")
    ax.set_ylabel(_label("height", "y", state.unit("gap")))
    _frame_contact(ax, result, state)


def loop(result: Result, ax: Axes, step: int | None = None) -> None:
    """Tangential force over shift, with the closed form where one holds; step ends are numbered, `step` stands out."""
    history = result.history
    shift, force = history.shift, history.tangential_force
    complete = np.any((history.event_kind != EventKind.START) & (history.event_kind != EventKind.STEP_END))
    if "shift" in result.reference:
        _draw_line(ax, result.reference.shift, force, linestyle="--" if complete else "none", marker="" if complete else "x")
    ax.plot(shift, force, color=NUMBERS, linewidth=0.8 if complete else 0.0, **_points(len(shift)), label="computed")
    _mark_step_ends(ax, result, step)
    ax.set_xlabel(_label("shift", "U", history.unit("shift")))
    ax.set_ylabel(_label("tangential force", "Q", history.unit("tangential_force")))
    ax.margins(0.12)


def _state(result: Result, step: int | None) -> Group:
    """The last state, or that of a step."""
    if step is None:
        return result.state
    if not 1 <= step <= len(result.steps):
        raise ValueError(f"there is no step {step}: the result has {len(result.steps)}")
    return result.steps[step - 1]


def _loads(result: Result, step: int | None) -> Group:
    """Loads and counts of that state."""
    return result.summary if step is None else _state(result, step)


def _has_friction(result: Result) -> bool:
    return result.scene.friction_coefficient > 0.0


def _is_sheared(result: Result) -> bool:
    """Whether the load history has a tangential force to speak of."""
    if not _has_friction(result) or not result.history:
        return False
    negligible = 1.0e-9 * np.max(np.abs(result.history.normal_force))
    return bool(np.any(np.abs(result.history.tangential_force) > negligible))


def _same_normal_force(result: Result, step: int | None) -> bool:
    """Whether the closed form of the pressure, which is that of the last state, holds for this one."""
    return bool(np.isclose(_loads(result, step).normal_force, result.summary.normal_force, rtol=1.0e-9, atol=0.0))


def _is_last(result: Result, state: Group) -> bool:
    """Whether a state is the last one, for which alone the closed form of the shear traction holds."""
    return all(np.array_equal(state[name], result.state[name]) for name in ("pressure", "shear"))


def _draw_line(ax: Axes, x: np.ndarray, y: np.ndarray, linestyle: str = "-", marker: str = "") -> None:
    ax.plot(x, y, color=CLOSED_FORM, linewidth=1.2, linestyle=linestyle, marker=marker, label="closed form")


def _draw_points(ax: Axes, result: Result, state: Group, values: np.ndarray, label: str = "computed") -> None:
    points = _points(np.count_nonzero(state.status != NodeStatus.OPEN))
    ax.plot(result.mesh.x, values, linestyle="none", color=NUMBERS, **points, label=label)


def _points(number: int) -> dict[str, object]:
    """Markers that leave each other room: smaller where there are more."""
    return {"marker": "o", "markersize": float(np.clip(250.0 / max(number, 1), 1.0, 3.0)), "markeredgewidth": 0.0}


def _shade_zones(ax: Axes, result: Result, state: Group) -> None:
    """Background of the stick and slip zones."""
    half = 0.5 * result.mesh.interval
    for status, first, last in _runs(state.status):
        if status in ZONES:
            ax.axvspan(result.mesh.x[first] - half, result.mesh.x[last] + half, linewidth=0.0, zorder=0, **ZONES[status])


def _runs(values: np.ndarray) -> Iterator[tuple[int, int, int]]:
    """Value, first and last index of every run of equal values."""
    starts = np.flatnonzero(np.diff(values, prepend=values[0] - 1))
    ends = np.append(starts[1:], len(values)) - 1
    return ((int(values[first]), int(first), int(last)) for first, last in zip(starts, ends))


def _frame_contact(ax: Axes, result: Result, state: Group) -> None:
    """Show the contact and a quarter of its length on either side, as far as there are nodes; all of the mesh without one."""
    half = 0.5 * result.mesh.interval
    left, right = result.mesh.x[0] - half, result.mesh.x[-1] + half
    touching = result.mesh.x[state.status != NodeStatus.OPEN]
    if touching.size > 0:
        margin = 0.25 * (touching[-1] - touching[0] + 2.0 * half)
        left, right = max(left, touching[0] - half - margin), min(right, touching[-1] + half + margin)
    ax.set_xlim(left, right)
    ax.set_xlabel(_label("position", "x", result.mesh.unit("x")))


def _mark_step_ends(ax: Axes, result: Result, step: int | None) -> None:
    """Numbers at the ends of steps and reversals, as in `result.steps`; those at one place together."""
    ends = np.flatnonzero(result.history.event_kind == EventKind.STEP_END)[: len(result.steps)]
    if len(ends) == 0:
        return
    points = np.column_stack((result.history.shift[ends], result.history.tangential_force[ends]))
    for place, numbers in _places(points):
        here = step in numbers
        ax.plot(*place, marker="o", markersize=6, markerfacecolor=MARKS if here else "white", markeredgecolor=MARKS, linestyle="none", zorder=4)
        outward = 1 if place[1] >= np.mean(points[:, 1]) else -1
        ax.annotate(
            _enumeration(numbers), place, xytext=(-6 * outward, 6 * outward), textcoords="offset points", fontsize=9,
            ha="right" if outward > 0 else "left", va="bottom" if outward > 0 else "top",
            fontweight="bold" if here else "normal",
        )


def _places(points: np.ndarray) -> list[tuple[np.ndarray, list[int]]]:
    """Points that coincide in a picture, with the numbers, from 1, of all that are there."""
    size = np.maximum(np.ptp(points, axis=0), np.finfo(float).tiny)
    places: list[tuple[np.ndarray, list[int]]] = []
    for number, point in enumerate(points, start=1):
        for place, numbers in places:
            if np.all(np.abs(place - point) < 0.02 * size):
                numbers.append(number)
                break
        else:
            places.append((point, [number]))
    return places


def _enumeration(numbers: list[int]) -> str:
    if len(numbers) > NAMED_TOGETHER:
        return f"{numbers[0]}, {numbers[1]}, \N{HORIZONTAL ELLIPSIS}, {numbers[-1]}"
    return ", ".join(str(number) for number in numbers)


def _legend(picture: Figure) -> None:
    """One legend below all panels."""
    handles = {}
    for ax in picture.axes:
        for handle, label in zip(*ax.get_legend_handles_labels()):
            handles.setdefault(label, handle)
    picture.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=min(len(handles), 6), fontsize=9)


def _heading(result: Result, step: int | None) -> str:
    if step is None:
        return result.title
    state = _state(result, step)
    place = f"state {step} (step {state.step}, reversal {state.reversal})"
    return f"{result.title}: {place}" if result.title else place


def _caption(result: Result, step: int | None) -> str:
    """Node counts, certificate, where the closed forms come from, and how the run ended unless well."""
    parts = [
        f"{result.mesh.x.size} nodes, {counts(_loads(result, step))}",
        f"largest relative residual {result.certificate.largest:.1e}",
    ]
    sources = [result.reference.description(name).split(";")[0] for name in ("pressure", "shear") if name in result.reference]
    if sources:
        parts.append("closed form: " + "; ".join(sources))
    if result.outcome != "complete":
        parts.append(f"ended early: {result.outcome}")
    return " \N{MIDDLE DOT} ".join(parts)


def _label(name: str, symbol: str, unit: str) -> str:
    """Label of an axis; the unit only where the user has named it."""
    if unit in ("", "1") or "length" in unit or "force" in unit:
        return f"{name} ${symbol}$"
    shown = unit.replace("^2", "\N{SUPERSCRIPT TWO}").replace("$", r"\$")
    return f"{name} ${symbol}$ [{shown}]"
