"""Pictures of results: numbers as points, closed forms as lines.

`pressure`, `shear`, `surfaces`, `loop`, `nonlinear_loop`, `friction_work`, `turning`, `rolling`, `tension`, `surface_stress`,
`stress_contours` and `parameter_contours` draw into axes of yours, or new ones, and return them; `figure` makes a picture of what a
result has, `cycles_figure` one of its cycles, `edges_figure` one of its edges, `stress_figure` one of the stresses inside a body.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Callable

import matplotlib
import numpy as np
from matplotlib import patheffects
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from . import drawing, patches_figure
from . import edges_figure as edges_picture
from .codes import EventKind, NodeStatus
from .errors import MfvError
from .result import Group, Result, doubt, is_last
from .stress import NAMES, Largest, StressField, contact_edges, drawn_at, grid, is_radial, radius_of, stored, stress, surface_at
from .views import (
    contact,
    friction_limits,
    has_friction,
    has_last_normal_force,
    heights,
    is_named,
    is_sheared,
    limit_of_friction,
)

if TYPE_CHECKING:
    from .fatigue import ParameterMap

#: How pictures write the stresses.
STRESS_LABELS = {
    "sigma_xx": r"$\sigma_{xx}$",
    "sigma_yy": r"$\sigma_{yy}$",
    "sigma_xy": r"$\sigma_{xy}$",
    "sigma_zz": r"$\sigma_{zz}$",
    "principal_1": r"$\sigma_1$",
    "principal_2": r"$\sigma_2$",
    "von_mises": r"$\sigma_\mathrm{vM}$",
    "sigma_rr": r"$\sigma_{rr}$",
    "sigma_thetatheta": r"$\sigma_{\theta\theta}$",
    "sigma_rtheta": r"$\sigma_{r\theta}$",
    "tresca": r"$\sigma_\mathrm{T}$",
    "principal_angle": r"direction of $\sigma_1$",
}

#: Stresses with a mark at the largest tension along the surface; kinds of axes.
TENSIONS = ("sigma_xx", "sigma_thetatheta", "principal_1")
AXES = ("normalised", "physical")

#: Tractions of more than this times the median are spikes, which would flatten all others.
SPIKE = 5.0

#: Panels beside each other; more are in two rows.
LONGEST_ROW = 4

#: Turning points of a cycle that are all named on a load-displacement curve; of more, its reversals.
NAMED_TURNS = 4


#: A function that draws a result, or one of its states, into axes.
Panel = Callable[[Result, "Axes | None", "int | None"], Axes]


def figure(result: Result, step: int | None = None) -> Figure:
    """A picture of a result: pressure; shear traction, or without friction the deformed surfaces; tangential force over shift,
    with cycles also over the non-linear shift, or, without tangential force, moment over rotation; after rolling, sliding over
    rolled distance; with a bulk stress the stress along the surface; with `stress_at` the largest tension over the last cycle.

    `step`: draw `result.steps[step - 1]`, not the last state. Raises ValueError if it does not exist. For a contact with
    several patches the panels show all patches, the patch with the largest load, and the gap.
    """
    if drawing.loads_of(result, step).get("patches", 1) > 1:
        return patches_figure.figure(result, step)
    panels = [pressure, shear if has_friction(result) else surfaces]
    if _is_rolled(result):
        panels.append(rolling)
    elif is_sheared(result):
        panels.append(loop)
        if "nonlinear_shift" in result.history:
            panels.append(nonlinear_loop)
    elif _is_turned(result):
        panels.append(turning)
    if _has_bulk_stress(result) and _can_have_stresses(result, step):
        panels.append(surface_stress)
    if _has_tension(result):
        panels.append(tension)
    return _panels_in_a_row(panels, result, step, drawing.caption(result, step))


def cycles_figure(result: Result) -> Figure:
    """A picture of the cycles of a result: hysteresis loop; its non-linear part; dissipation of the last cycle over x.

    Raises ValueError without cycles.
    """
    _check_cycles(result)
    turns = _turns_in_the_last_cycle(result)
    drawable = [
        (loop, "shift" in result.history and not turns),
        (turning, turns),
        (nonlinear_loop, "nonlinear_shift" in result.history),
        (friction_work, "friction_work" in result.cycles),
        (tension, _has_tension(result)),
    ]
    panels = [panel for panel, is_there in drawable if is_there]
    if not panels:
        raise ValueError("no cycles to draw: the result has neither a history nor dissipation by friction")
    return _panels_in_a_row(panels, result, None, _cycle_caption(result))


def edges_figure(result: Result) -> Figure:
    """A picture of the tractions next to the left and right edge of the contact, with their asymptotes and slip zones.

    Raises ValueError without intensities.
    """
    return edges_picture.figure(result)


def _check_cycles(result: Result) -> None:
    """Raises ValueError without cycles."""
    if not result.cycles:
        raise ValueError("this result has no cycles; give a step cycles=...")


def _panels_in_a_row(panels: Sequence[Panel], result: Result, step: int | None, caption: str) -> Figure:
    """A picture of panels beside each other, with a heading, a legend and a caption."""
    with matplotlib.rc_context(drawing.STYLE):
        picture = Figure(layout="constrained")
        rows = 1 if len(panels) <= LONGEST_ROW else 2
        columns = -(-len(panels) // rows)
        picture.set_size_inches(columns * drawing.PANEL_WIDTH, rows * drawing.PANEL_HEIGHT + 1.0)
        axes = list(picture.subplots(rows, columns, squeeze=False).flat)
        for panel, ax, letter in zip(panels, axes, "abcdef"):
            panel(result, ax, step)
            ax.set_title(f"({letter})")
        for ax in axes[len(panels) :]:
            ax.remove()
        picture.suptitle(drawing.heading(result, step), fontsize=12, parse_math=False)
        drawing.add_legend(picture, caption)
    return picture


def _turns_in_the_last_cycle(result: Result) -> bool:
    """Whether the moment alternates in the last cycle, and the tangential force does not."""
    history = result.history
    if "rotation" not in history:
        return False
    of_cycle = history.step == result.cycles.step[-1]
    negligible = 1.0e-9 * np.max(np.abs(history.normal_force))
    is_sheared = np.ptp(history.tangential_force[of_cycle]) > negligible and np.ptp(history.shift[of_cycle]) > 0.0
    return bool(np.ptp(history.rotation[of_cycle]) > 0.0 and not is_sheared)


def _cycle_caption(result: Result) -> str:
    """Number of cycles, dissipation of the last one, and its change of the tractions."""
    seen, unit = result.observables, result.observables.unit("cycle_dissipation")
    parts = [
        f"{result.cycles.cycle.size} cycles",
        f"the last cycle dissipates {seen.cycle_dissipation:.4g}{f' {unit}' if is_named(unit) else ''}"
        + doubt(result, "cycle_dissipation"),
        f"loss factor {seen.loss_factor:.3g}{doubt(result, 'loss_factor')}" if "loss_factor" in seen else "",
        f"change of the tractions over it {seen.cycle_change:.1e}",
    ]
    return " \N{MIDDLE DOT} ".join(part for part in parts if part)


def stress_figure(
    result: Result, name: str = "von_mises", body: str = "lower", step: int | None = None, axes: str = "normalised"
) -> Figure:
    """A picture of a stress inside a body: contours over the largest pressure, axes over the contact half-width.

    `name`: one of `mfv.stress.NAMES`. `axes`: 'physical' for stresses and lengths in their units. Stresses that mfv_stress has written into the
    file are drawn; otherwise they are computed, which needs the library. Raises ValueError for an unknown name, step or kind of axes.
    """
    if name not in NAMES:
        raise ValueError(f"unknown stress {name}; choose from {', '.join(NAMES)}")
    field = stored(result, body=body, step=step) or grid(result, body=body, step=step)
    if np.isnan(field[name]).all():
        raise ValueError(f"{name} is not defined in a half-plane")
    with matplotlib.rc_context(drawing.STYLE):
        picture = Figure(figsize=_stress_size(field), layout="constrained")
        units = result.mesh.unit("x"), result.state.unit("pressure")
        ax = stress_contours(field, picture.subplots(), name, colour_bar=True, axes=axes, units=units)
        heading = drawing.heading(result, step)
        ax.set_title(f"{heading}: {body} body" if heading else f"{body} body", fontsize=12, parse_math=False)
        picture.supxlabel(_scales(result, field), fontsize=9, color="0.35")
    return picture


def _stress_size(field: StressField) -> tuple[float, float]:
    """Size of the picture in inch at which a field, drawn to scale, fills it beside its colour bar and between its texts."""
    width, beside, above = 7.0, 1.4, 1.1
    inside = ~np.isnan(field["sigma_xx"])
    ratio = np.ptp(field.y[inside]) / np.ptp(field.x[inside]) if inside.any() else 0.5
    return width, float(np.clip((width - beside) * ratio, 1.5, 8.0)) + above


def _scales(result: Result, field: StressField) -> str:
    """The scales of the picture, the largest von Mises stress and the largest tension, in the user's units."""
    unit, length = _unit(result.state.unit("pressure")), _unit(result.mesh.unit("x"))
    parts = [
        f"$p_0$ = {field.largest_pressure:.4g}{unit}{doubt(result, 'peak_pressure')}",
        f"$a$ = {field.half_width:.4g}{length}{doubt(result, 'contact_half_width')}",
        f"largest von Mises stress {field.largest.value:.4g}{unit}{doubt(result, 'peak_pressure', f'largest_{field.body}_von_mises')}"
        if np.isfinite(field.largest.value)
        else "von Mises stress unbounded at a sharp corner",
    ]
    if field.tension.value > 0.0:
        parts[-1] += (
            f"\nlargest tension along the surface {field.tension.value:.4g}{unit} at $x$ = {_signed(field.tension.x)}{length}"
            + doubt(result, f"{field.body}_tension")
        )
    return " \N{MIDDLE DOT} ".join(parts)


def stress_contours(
    field: StressField,
    ax: Axes | None = None,
    name: str = "von_mises",
    *,
    colour_bar: bool = False,
    axes: str = "normalised",
    units: tuple[str, str] = ("", ""),
) -> Axes:
    """Contours of a stress over the largest pressure, axes over the contact half-width; or, with `axes` 'physical', as they are, `units`
    being the names of those of length and stress.

    Marked is the place of the largest von Mises stress, on pictures of this; the largest tension along the surface on those of sigma_xx,
    sigma_thetatheta and principal_1; the last also have lines along its direction. `colour_bar`: with a scale beside them.
    Raises ValueError for unknown axes.
    """
    if axes not in AXES:
        raise ValueError(f"axes must be {' or '.join(AXES)}, not '{axes}'")
    ax = _axes(ax)
    is_angle = name == "principal_angle"
    physical = axes == "physical"
    length, stress = (1.0, 1.0) if physical else (field.half_width, field.largest_pressure)
    origin = 0.0 if physical else field.middle
    x, y = (field.x - origin) / length, np.nan_to_num(field.y / length)
    values = np.ma.masked_invalid(np.degrees(field[name]) if is_angle else field[name] / stress)
    signed = bool(values.min() < -1.0e-9 * values.max() and name not in ("von_mises", "tresca"))
    bound = 90.0 if is_angle else float(np.percentile(np.abs(values.compressed()), 99.9))
    levels = MaxNLocator(20, steps=[1, 2, 2.5, 5, 10]).tick_values(-bound if signed else 0.0, bound)
    colours = "twilight" if is_angle else "RdBu_r" if signed else "viridis"
    contours = ax.contourf(x, y, values, levels=levels, cmap=colours, extend="neither" if is_angle else "both" if signed else "max")
    if not is_angle:
        ax.contour(x, y, values, levels=levels[::2], colors="black", linewidths=0.3)
    if name == "principal_1":
        _draw_directions(ax, x, y, field["principal_angle"])
    mark = field.largest if name == "von_mises" else field.tension if name in TENSIONS else None
    if mark is not None and np.isfinite(mark.x):
        place = (mark.x - origin) / length, mark.y / length
        unit = _unit(units[1]) if physical else " $p_0$"
        at = f"{_signed(place[0])}, {_signed(place[1])}" if physical else f"{_rounded(place[0])}, {_rounded(place[1])}"
        text = f"{'largest' if name == 'von_mises' else 'largest tension'}: {mark.value / stress:.4g}{unit}"
        _mark_stress(ax, place, f"{text}\nat ({at}){_unit(units[0]) if physical else ' $a$'}", field.body == "upper")
    ax.set_aspect("equal")
    inside = ~values.mask if np.ma.is_masked(values) else np.ones_like(values, dtype=bool)
    ax.set_xlim(x[inside].min(), x[inside].max())
    ax.set_ylim(y[inside].min(), y[inside].max())
    ax.set_xlabel(drawing.label("", "x", units[0]).strip() if physical else "$x/a$")
    ax.set_ylabel(drawing.label("", "y", units[0]).strip() if physical else "$y/a$")
    if colour_bar:
        label = f"{STRESS_LABELS[name]} [degrees]" if is_angle else f"{STRESS_LABELS[name]}$/p_0$"
        if physical and not is_angle:
            label = f"{STRESS_LABELS[name]}{f' [{_unit(units[1]).strip()}]' if _unit(units[1]) else ''}"
        beside = ax.inset_axes((1.02, 0.0, 0.025, 1.0))  # as high as the axes, which keep their aspect
        ax.figure.colorbar(contours, cax=beside, label=label)
    return ax


def parameter_contours(
    field: ParameterMap, ax: Axes | None = None, *, colour_bar: bool = True, units: tuple[str, str] | None = None
) -> Axes:
    """Contours of a fatigue parameter on a grid, in the units of the case, with its maximum marked and there a line along the critical
    plane. `colour_bar`: with a scale beside them. `units`: names of those of length and of the parameter in place of the field's own."""
    if ax is None:
        size = 7.0, 1.2 + 5.5 * min(float(np.ptp(field.y) / np.ptp(field.x)), 1.0)
        with matplotlib.rc_context(drawing.STYLE):
            return parameter_contours(field, _axes(None, size), colour_bar=colour_bar, units=units)
    units = units or field.units
    values = np.ma.masked_invalid(field.values)
    levels = MaxNLocator(15).tick_values(0.0, float(values.max()))
    contours = ax.contourf(field.x, field.y, values, levels=levels, cmap="viridis")
    peak = field.maximum
    if np.isfinite(peak.angle):  # the plane is normal to (cos, sin) of the angle
        ends = 0.1 * np.ptp(field.x) * np.array([-np.sin(peak.angle), np.cos(peak.angle)]) * np.array([[0.0], [1.0]])
        into_body = -1.0 if ends[1, 1] > 0.0 and np.mean(field.y) < peak.y else 1.0
        ax.plot(peak.x + into_body * ends[:, 0], peak.y + into_body * ends[:, 1], color="white", linewidth=1.5)
    angle = f", {np.degrees(peak.angle) + 0.0:.0f}\N{DEGREE SIGN}" if np.isfinite(peak.angle) else ""
    if peak.tilt > 1.0e-2:  # not by round-off
        angle += f", tilted {np.degrees(peak.tilt):.0f}\N{DEGREE SIGN} out of the plane"
    ax.plot(peak.x, peak.y, "x", color="white", markersize=7, clip_on=False, zorder=5)
    ax.set_title(f"{field.name}: {peak.value:.4g}{_unit(units[1])} at ({_signed(peak.x)}, {_signed(peak.y)}){angle}", fontsize=10)
    ax.set_aspect("equal")
    ax.set_xlabel(drawing.label("", "x", units[0]).strip())
    ax.set_ylabel(drawing.label("", "y", units[0]).strip())
    if colour_bar:
        bar = ax.figure.colorbar(contours, cax=ax.inset_axes((1.02, 0.0, 0.025, 1.0)), ticks=levels[::4])
        bar.set_label(_unit(units[1]).strip())
    return ax


def _draw_directions(ax: Axes, x: np.ndarray, y: np.ndarray, angle: np.ndarray) -> None:
    """Short lines along the first principal stress."""
    some = tuple(slice(size // 40, None, max(1, size // 20)) for size in x.shape)
    ax.quiver(
        x[some],
        y[some],
        np.cos(angle[some]),
        np.sin(angle[some]),
        pivot="middle",
        headaxislength=0,
        headlength=0,
        headwidth=0,
        width=0.0015,
        scale=40,
        color="0.25",
    )


def _mark_stress(ax: Axes, place: tuple[float, float], text: str, upper: bool) -> None:
    """A place with its text, inside the body."""
    outline = [patheffects.withStroke(linewidth=2.5, foreground="white")]
    ax.plot(*place, "x", color="black", markersize=7, clip_on=False, zorder=5, path_effects=outline)
    ax.annotate(
        text,
        place,
        xytext=(0, 12 if upper else -12),
        textcoords="offset points",
        ha="center",
        va="bottom" if upper else "top",
        fontsize=9,
        path_effects=outline,
    )


def _unit(unit: str) -> str:
    """A unit to stand after a value; empty unless the user has named it."""
    return f" {unit.replace('$', chr(92) + '$').replace('^2', '$^2$')}" if is_named(unit) else ""


def _rounded(value: float) -> str:
    """Two decimals, without a minus before zero."""
    return f"{round(value, 2) + 0.0:.2f}".replace("-", "\N{MINUS SIGN}")


def _signed(value: float) -> str:
    """Four digits, with a minus sign as on the axes."""
    return f"{value + 0.0:.4g}".replace("-", "\N{MINUS SIGN}")


def pressure(result: Result, ax: Axes | None = None, step: int | None = None) -> Axes:
    """Pressure over x, with its closed form if there is one."""
    ax = _axes(ax)
    state = result.at(step)
    _draw_points(ax, result, state, state.pressure)
    if "pressure" in result.reference and _same_normal_force(result, step):
        _draw_closed_form(ax, result, result.reference.pressure)
    ax.set_ylim(bottom=0.0)
    _cut_spikes(ax, state.pressure[state.status != NodeStatus.OPEN])
    ax.set_ylabel(drawing.label("pressure", "p", state.unit("pressure")))
    drawing.frame_contact(ax, result, state)
    return ax


def shear(result: Result, ax: Axes | None = None, step: int | None = None) -> Axes:
    """Shear traction over x with the friction limits, stick and slip zones, and the closed form if there is one."""
    ax = _axes(ax)
    state = result.at(step)
    drawing.shade_zones(ax, result, state)
    for index, coefficient in friction_limits(result):
        limit = limit_of_friction(coefficient, state)
        ax.plot(drawn_at(result), limit, **drawing.limit_style(index))
        ax.plot(drawn_at(result), -limit, **{**drawing.limit_style(index), "label": "_limit to the left"})
    _draw_points(ax, result, state, state.shear)
    if "shear" in result.reference and is_last(result, state):
        _draw_closed_form(ax, result, result.reference.shear)
    limits = [limit_of_friction(coefficient, state) for _, coefficient in friction_limits(result)]
    _cut_spikes(ax, np.max(np.abs([state.shear, *limits]), axis=0)[state.status != NodeStatus.OPEN])
    ax.set_ylabel(drawing.label("shear traction", r"\tau", state.unit("shear")))
    drawing.frame_contact(ax, result, state)
    return ax


def surfaces(result: Result, ax: Axes | None = None, step: int | None = None) -> Axes:
    """The deformed surface of the lower body and the upper body on it."""
    ax = _axes(ax)
    state = result.at(step)
    lower, upper = heights(result, state)
    _draw_points(ax, result, state, lower, label="surface of the lower body", color=drawing.SURFACE)
    ax.plot(drawn_at(result), upper, color=drawing.MARKS, linewidth=0.9, label="surface of the upper body")
    ax.set_ylabel(drawing.label("height", "y", state.unit("gap")))
    middle, least = float(np.mean(ax.get_ylim())), 1.0e-3 * abs(float(drawing.loads_of(result, step)["approach"]))
    if np.ptp(ax.get_ylim()) < least:  # flat: no axis of round-off
        ax.set_ylim(middle - least, middle + least)
    drawing.frame_contact(ax, result, state)
    return ax


def loop(result: Result, ax: Axes | None = None, step: int | None = None) -> Axes:
    """Tangential force over shift, with the closed form if there is one; step ends are numbered, `step` is bold."""
    ax = _axes(ax)
    history = result.history
    shift, force = history.shift, history.tangential_force
    has_events = not np.isin(history.event_kind, (EventKind.START, EventKind.STEP_END, EventKind.STOPPED)).all()
    _curve(ax, shift, force, color=drawing.NUMBERS, linewidth=0.8 if has_events else 0.0, **_points(len(shift)), label="computed")
    if "shift" in result.reference:
        style: dict[str, Any] = {"linestyle": (0, (4, 3))} if has_events else {"linestyle": "none", "marker": "x"}
        _curve(
            ax, result.reference.shift, force, color=drawing.CLOSED_FORM, linewidth=0.9, label="closed form", markersize=4, **style
        )
    across = drawing.label("shift", "U", history.unit("shift"))
    up = drawing.label("tangential force", "Q", history.unit("tangential_force"))
    return _finished_curve(ax, result, step, ("shift", "tangential_force"), (across, up))


def _curve(ax: Axes, across: np.ndarray, up: np.ndarray, *, label: str | None = None, **style: Any) -> None:
    """A curve in pieces: thousands of loops that lie on each other take minutes and gigabytes as one path."""
    piece = 2000
    for first in range(0, max(len(across) - 1, 1), piece):
        part = slice(first, first + piece + 1)
        ax.plot(across[part], up[part], label=label if first == 0 else None, **style)


def nonlinear_loop(result: Result, ax: Axes | None = None, step: int | None = None) -> Axes:
    """Tangential force over the non-linear part of the shift, which is due to slip. Raises ValueError without cycles."""
    _check_cycles(result)
    history = result.history
    if "nonlinear_shift" not in history:
        raise ValueError("no non-linear shift to draw: the result has no history, or its shift is constant")
    ax = _axes(ax)
    _curve(ax, history.nonlinear_shift, history.tangential_force, color=drawing.NUMBERS, linewidth=0.8)
    across = drawing.label("non-linear shift", "U - Q/k", history.unit("nonlinear_shift"))
    up = drawing.label("tangential force", "Q", history.unit("tangential_force"))
    return _finished_curve(ax, result, step, ("nonlinear_shift", "tangential_force"), (across, up), ticks=4)


def friction_work(result: Result, ax: Axes | None = None, step: int | None = None) -> Axes:
    """Energy that the last cycle dissipates per unit of surface, over x. Raises ValueError without cycles."""
    _check_cycles(result)
    ax = _axes(ax)
    cycles = result.cycles
    ax.plot(drawn_at(result), cycles.friction_work, color=drawing.NUMBERS, linewidth=0.8, **_points(result.mesh.x.size))
    ax.set_ylabel(drawing.label("dissipation per cycle and area", "d", cycles.unit("friction_work")))
    drawing.frame_contact(ax, result, result.at(step))
    return ax


def turning(result: Result, ax: Axes | None = None, step: int | None = None) -> Axes:
    """Moment over rotation; step ends are numbered, `step` is bold."""
    ax = _axes(ax)
    history = result.history
    points = _points(history.rotation.size)
    _curve(ax, history.rotation, history.moment, color=drawing.NUMBERS, linewidth=0.8, **points, label="computed")
    labels = r"rotation $\varphi$ [rad]", drawing.label("moment", "M", history.unit("moment"))
    return _finished_curve(ax, result, step, ("rotation", "moment"), labels)


def rolling(result: Result, ax: Axes | None = None, step: int | None = None) -> Axes:
    """Sliding over the rolled distance, whose slope is the creepage; step ends are numbered, `step` is bold."""
    ax = _axes(ax)
    history = result.history
    _curve(ax, history.rolled, history.slid, color=drawing.NUMBERS, linewidth=0.8, **_points(len(history.slid)), label="computed")
    across = drawing.label("rolled distance", "s", history.unit("rolled"))
    up = drawing.label("sliding", r"U + h\varphi", history.unit("slid"))
    return _finished_curve(ax, result, step, ("rolled", "slid"), (across, up))


def tension(result: Result, ax: Axes | None = None, step: int | None = None) -> Axes:
    """The largest tension along the surfaces, and the stress at the place `stress_at`, at the ends of the steps, rows and turning points:
    of the last cycle, without cycles of the whole load history."""
    ax = _axes(ax)
    history = result.history
    first = int(np.flatnonzero(history.event_kind == EventKind.STEP_END)[0])
    if result.cycles:
        of_step = np.flatnonzero((history.event_kind == EventKind.STEP_END) & (history.step == result.cycles.step[-1]))
        turns = of_step.size // int(np.count_nonzero(result.cycles.step == result.cycles.step[-1]))
        first = int(of_step[max(of_step.size - turns - 1, 0)])
    for body, color in (("lower", drawing.NUMBERS), ("upper", drawing.CLOSED_FORM)):
        if f"{body}_tension" not in history:
            continue
        ends = np.isfinite(history[f"{body}_surface_stress"]) & (np.arange(history.step.size) >= first)
        rows = np.arange(np.count_nonzero(ends)) + (0 if result.cycles else 1)
        style: dict[str, Any] = {"marker": "o", "markersize": 3.0}
        ax.plot(rows, history[f"{body}_tension"][ends], color=color, linewidth=1.0, label=f"{body} tension", **style)
        stress = history[f"{body}_surface_stress"][ends]
        ax.plot(rows, stress, color=color, linewidth=0.8, linestyle=(0, (4, 3)), label=f"{body}, at stress_at")
    ax.set_xlabel("turning point of the last cycle" if result.cycles else "load segment")
    ax.xaxis.set_major_locator(MaxNLocator(6, integer=True))
    ax.set_ylabel(drawing.label("stress along the surface", r"\sigma", result.state.unit("pressure")))
    return ax


def surface_stress(result: Result, ax: Axes | None = None, step: int | None = None) -> Axes:
    """Stress along the surface of the lower body (of the upper one over a rigid or a matrix), sigma_xx on a flat one, over x, with the
    largest tension marked: of the last state, or `step`, and of the saved reversals of the last cycle. Needs the library."""
    ax = _axes(ax)
    body, chosen = _stressed_body(result), step or len(result.steps)
    turns = list(_named_records(result, result.history.tangential_force, step).values()) if result.cycles and step is None else []
    shown = [number for number in turns if number < chosen and result.steps[number - 1].step == result.cycles.step[-1]]
    name = "sigma_xx" if radius_of(result, body) is None else "sigma_thetatheta"
    for number, style in zip([*shown, step], [*((0, (k + 1, 1.5)) for k in range(len(shown))), "-"]):
        x = _surface_points(result, body, number)
        field = stress(result, *surface_at(result, body, x), body=body, step=number)
        color = drawing.NUMBERS if number == step else "0.45"
        label = f"{'state ' if number else 'last state'}{number or ''}"
        ax.plot(x, field[name], color=color, linewidth=1.0, linestyle=style, label=f"{body} body, {label}")
        if number == step and np.isfinite(field.tension.x) and field.tension.value > 0.0:
            _mark_tension(ax, field.tension, result, doubt(result, f"{body}_tension"))
    ax.set_ylabel(
        drawing.label(
            "stress along the surface", r"\sigma_{xx}" if name == "sigma_xx" else r"\sigma", result.state.unit("pressure")
        )
    )
    drawing.frame_contact(ax, result, result.at(step))
    return ax


def _mark_tension(ax: Axes, peak: Largest, result: Result, note: str) -> None:
    """Mark the largest tension with its value, a `note` and its place."""
    units = _unit(result.state.unit("pressure")), _unit(result.mesh.unit("x"))
    left, right = contact(result, [result.state])
    place = peak.x
    if is_radial(result):  # the surface rises from y = 0 on either side of the origin
        place = float(np.degrees(2.0 * np.arctan2(np.sign(peak.x) * abs(peak.y), abs(peak.x)))) if peak.x else 0.0
    beside = place < 0.5 * (left + right)
    ax.plot(place, peak.value, "o", color=drawing.MARKS, markersize=5, markerfacecolor="none", clip_on=False)
    text = f"{peak.value:.4g}{units[0]}{note}\nat $x$ = {_signed(peak.x)}{units[1]}"
    ax.annotate(text, (place, peak.value), xytext=(10 if beside else -10, -2), textcoords="offset points",
                ha="left" if beside else "right", va="top", fontsize=9)  # fmt: skip


def _surface_points(result: Result, body: str, step: int | None) -> np.ndarray:
    """Points x across the frame of a picture, dense towards the edges of the contact, where the stress peaks."""
    left, right = contact(result, [result.at(step)])
    steps = (right - left) * np.geomspace(1.0e-5, 0.1, 40)
    close = [edge + side * steps for edge in contact_edges(result, body, step) for side in (-1.0, 1.0)]
    points = np.unique(np.concatenate([np.linspace(left, right, 301), *close]))
    return points[(points >= left) & (points <= right)]


def _stressed_body(result: Result) -> str:
    """The body whose stresses a picture shows: the lower one if it is elastic and no matrix."""
    return "upper" if "lower_datum" not in result.scene else "lower"


def _has_bulk_stress(result: Result) -> bool:
    """Whether a body has a bulk stress."""
    return "lower_bulk_stress" in result.summary or "upper_bulk_stress" in result.summary


def _can_have_stresses(result: Result, step: int | None) -> bool:
    """Whether stresses can be computed: there is contact, the library, and a body that has them."""
    try:
        return (
            bool((result.at(step).pressure > 0.0).any())
            and stress(result, [0.0], [0.0], body=_stressed_body(result), step=step) is not None
        )
    except (MfvError, ValueError):
        return False


def _has_tension(result: Result) -> bool:
    """Whether the history has stresses along the surfaces."""
    return "lower_surface_stress" in result.history or "upper_surface_stress" in result.history


def _finished_curve(
    ax: Axes, result: Result, step: int | None, names: tuple[str, str], labels: tuple[str, str], ticks: int = 5
) -> Axes:
    """A curve over the records of the history with numbered step ends and labels."""
    _mark_step_ends(ax, result, step, *names)
    ax.set(xlabel=labels[0], ylabel=labels[1])
    ax.locator_params(axis="x", nbins=ticks)
    ax.margins(0.12)
    return ax


def _axes(ax: Axes | None, size: tuple[float, float] = (drawing.PANEL_WIDTH, drawing.PANEL_HEIGHT)) -> Axes:
    """The given axes, or those of a new figure of pyplot of a size in inch."""
    if ax is not None:
        return ax
    from matplotlib import pyplot  # here, since it needs a display

    with matplotlib.rc_context(drawing.STYLE):
        _, made = pyplot.subplots(figsize=size, layout="constrained")
    return made


def _is_turned(result: Result) -> bool:
    """Whether the load history has a rotation."""
    return "rotation" in result.history and bool(np.any(result.history.rotation != 0.0))


def _is_rolled(result: Result) -> bool:
    """Whether the contact has rolled by more than its half-width."""
    return "rolled" in result.history and bool(np.ptp(result.history.rolled) > result.summary.contact_half_width)


def _same_normal_force(result: Result, step: int | None) -> bool:
    """Whether the closed form of the pressure, computed for the last state, also holds for this one."""
    return step is None or (has_last_normal_force(result, result.at(step)) and not _is_rolled(result))


def _draw_closed_form(ax: Axes, result: Result, values: np.ndarray) -> None:
    """A traction in closed form over its contact, down to zero at the ends unless the pressure is singular there."""
    half_width = result.reference.contact_half_width
    middle = float(result.history.rolled[-1]) if "rolled" in result.history else 0.0
    places = drawn_at(result)
    inside = np.abs(places - middle) < half_width
    x, y = places[inside], values[inside]
    touching_pressure = result.reference.pressure[inside]
    if touching_pressure.size > 0 and touching_pressure[0] < touching_pressure.max():
        x, y = np.pad(x, 1, constant_values=(middle - half_width, middle + half_width)), np.pad(y, 1)
    ax.plot(x, y, color=drawing.CLOSED_FORM, linewidth=0.9, label="closed form")


def _draw_points(
    ax: Axes, result: Result, state: Group, values: np.ndarray, label: str = "computed", color: str = drawing.NUMBERS
) -> None:
    points = _points(int(np.count_nonzero(state.status != NodeStatus.OPEN)))
    ax.plot(drawn_at(result), values, linestyle="none", color=color, **points, label=label)


def _points(number: int) -> dict[str, Any]:
    """Markers, smaller for more points."""
    return {"marker": "o", "markersize": float(np.clip(350.0 / max(number, 1), 1.0, 3.5)), "markeredgewidth": 0.0}


def _cut_spikes(ax: Axes, sizes: np.ndarray) -> None:
    """Limit an axis to what most nodes have where a few, at sharp corners, have tractions many times as large; say how large."""
    usual = SPIKE * float(np.median(sizes)) if sizes.size > 0 else 0.0
    if not 0.0 < usual < (largest := float(np.max(sizes))):
        return
    bottom = ax.get_ylim()[0]
    ax.set_ylim(max(bottom, -usual) if bottom < 0.0 else bottom, usual)
    ax.text(0.5, 0.97, f"at the corners up to {largest:.3g}", transform=ax.transAxes, ha="center", va="top", fontsize=9)


def _mark_step_ends(ax: Axes, result: Result, step: int | None, across: str, up: str) -> None:
    """Number the ends of steps and the reversals of the last cycle, as in `result.steps`, coinciding ones together; mark an early end."""
    history = result.history
    curve = np.column_stack((history[across], history[up]))
    curve_size = np.maximum(np.ptp(curve, axis=0), np.finfo(float).tiny)
    records = _named_records(result, history[up], step)
    ends = _places(curve[list(records)], list(records.values()), 0.03 * curve_size)
    marks = [(place, ", ".join(map(str, numbers)), "o", step in numbers) for place, numbers in ends]
    marks += [(place, "stopped", "s", False) for place in curve[history.event_kind == EventKind.STOPPED]]
    relative = np.array([place for place, *_ in marks] or np.empty((0, 2))) / curve_size
    middle = np.mean((curve.min(axis=0), curve.max(axis=0)), axis=0) / curve_size
    for number, (place, text, marker, bold) in enumerate(marks):
        is_far_right = relative[number, 0] > middle[0] + 0.3
        _mark(ax, place, text, marker, bold, _is_labelled_above(relative, number, middle), is_far_right)


def _named_records(result: Result, values: np.ndarray, step: int | None) -> dict[int, int]:
    """Records of the history, from 0, and the numbers, from 1, of the saved states at them that a picture names: ends of steps and, of
    cycles, the turning points of the last one; of many the reversals of `values` alone; and `step`."""
    ends: dict[int, list[int]] = {}
    records_of_ends = np.flatnonzero(result.history.event_kind == EventKind.STEP_END)
    for record, of_step in zip(records_of_ends, result.history.step[records_of_ends]):
        ends.setdefault(int(of_step), []).append(int(record))
    cycles = {int(number): int(np.sum(result.cycles.step == number)) for number in np.unique(result.cycles.get("step", []))}
    named: dict[int, int] = {}
    for number, state in enumerate(result.steps, start=1):
        records = ends.get(int(state.step), [])
        place = int(state.reversal) - 1
        if not 0 <= place < len(records):
            continue
        here = records[place]
        turns = len(records) // cycles.get(int(state.step), 1)
        if number == step or (
            place >= len(records) - turns
            and (turns <= NAMED_TURNS or _reverses(values[records], place) or number == len(result.steps))
        ):
            named[here] = number
    return named


def _reverses(values: np.ndarray, place: int) -> bool:
    """Whether values rise before a place and fall after it, or the other way round; the first and the last follow each other."""
    before, after = values[place] - values[place - 1], values[(place + 1) % len(values)] - values[place]
    return bool(before * after < 0.0)


def _is_labelled_above(places: np.ndarray, number: int, middle: np.ndarray) -> bool:
    """Whether the text goes above and to the left of a mark, not below and to the right: off the curve, which rises to
    the right, inwards, and away from a neighbour."""
    here = places[number]
    neighbours = places[(np.abs(places - here) < 0.15).all(axis=1) & (places != here).any(axis=1)]
    if len(neighbours) > 0:
        return bool(here[0] <= neighbours[:, 0].min())
    return bool(here[0] >= middle[0])


def _mark(ax: Axes, place: np.ndarray, text: str, marker: str, bold: bool, above: bool, is_far_right: bool) -> None:
    """A mark with its text: above and to the left, or below and to the right; long text at the right margin is centred below."""
    width, weight = (1.8, "bold") if bold else (0.8, "normal")
    ha, va, offset = ("right", "bottom", (-5, 5)) if above else ("left", "top", (5, -5))
    if is_far_right and not above and len(text) > 4:
        ha, offset = "center", (0, -6)
    ax.plot(*place, marker=marker, markersize=7, markerfacecolor="none", markeredgecolor=drawing.MARKS, markeredgewidth=width)
    ax.annotate(text, tuple(place), xytext=offset, textcoords="offset points", ha=ha, va=va, fontsize=9, fontweight=weight)


def _places(points: np.ndarray, numbers: list[int], tolerance: np.ndarray) -> list[tuple[np.ndarray, list[int]]]:
    """Points that coincide in a picture, with the numbers of all that are there."""
    places: list[tuple[np.ndarray, list[int]]] = []
    for number, point in zip(numbers, points):
        together = next((others for place, others in places if np.all(np.abs(place - point) < tolerance)), None)
        if together is None:
            places.append((point, [number]))
        else:
            together.append(number)
    return places
