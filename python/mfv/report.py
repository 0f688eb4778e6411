"""A result as one self-contained web page, with plotly and all data; nothing is loaded from the network.

`page` makes the text of the page. It needs the Python packages plotly and jinja2 (the extra `report`).
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Sequence
from importlib.resources import files
from typing import Any

import numpy as np

from ._packages import require

require("plotly", "jinja2")

import plotly.graph_objects as go
from jinja2 import Environment, StrictUndefined
from markupsafe import Markup
from plotly.offline import get_plotlyjs

from . import __version__, _html
from .codes import NodeStatus
from .load_history import LoadHistory, evenly, kept_states, thinned
from .result import Group, Result, counts, doubt, is_last
from .stress import drawn_at
from .views import (
    LOADS,
    Curve,
    along_surface,
    contact,
    curve_of,
    friction_limits,
    has_friction,
    has_last_normal_force,
    heights,
    intervals,
    is_named,
    limit_of_friction,
    statuses,
)

#: The most states, records of the history and rows of the table of cycles that a page shows.
MOST_STATES, MOST_RECORDS, MOST_CYCLES = 240, 4000, 40

#: The most states that each get a tick.
MOST_TICKS = 12

#: Digits of the numbers in the curves.
DIGITS = 7

#: Names and colours of the statuses of nodes.
STATUSES = {
    NodeStatus.OPEN: ("open", "rgba(0,0,0,0)"),
    NodeStatus.STICK: ("stick", "#cfe3f1"),
    NodeStatus.SLIP_RIGHT: ("lower surface slips to the right", "#f8d998"),
    NodeStatus.SLIP_LEFT: ("lower surface slips to the left", "#e6c3d8"),
    NodeStatus.FRICTIONLESS: ("frictionless contact", "#e2e4e6"),
    NodeStatus.CREEP_RIGHT: ("lower surface creeps to the right", "#b5d6e6"),
    NodeStatus.CREEP_LEFT: ("lower surface creeps to the left", "#c3cdec"),
}

#: Key numbers of the page: group, name, label. Those that a result does not have are omitted.
KEY_NUMBERS = (
    ("summary", "normal_force", "normal force P"),
    ("summary", "tangential_force", "tangential force Q"),
    ("summary", "moment", "moment M"),
    ("summary", "lower_bulk_stress", "bulk stress of the lower body"),
    ("summary", "upper_bulk_stress", "bulk stress of the upper body"),
    ("summary", "interference", "interference"),
    ("summary", "approach", "approach"),
    ("summary", "shift", "shift U"),
    ("summary", "contact_half_width", "contact half-width"),
    ("summary", "contact_length", "contact length"),
    ("summary", "patches", "contact patches"),
    ("summary", "stick_ratio", "stick ratio"),
    ("observables", "peak_pressure", "largest pressure"),
    ("observables", "peak_shear", "largest shear traction"),
    ("summary", "dissipation", "dissipation so far"),
    ("observables", "cycle_dissipation", "dissipation of the last cycle"),
    ("observables", "loss_factor", "loss factor"),
    ("certificate", "largest", "largest relative residual"),
)

#: Key numbers that are meaningless without friction.
OF_FRICTION = ("tangential_force", "shift", "stick_ratio", "peak_shear", "dissipation")

#: Columns of the table of cycles.
CYCLE_COLUMNS = (
    "dissipation",
    "loss_factor",
    "tangential_stiffness",
    "secant_stiffness",
    "stick_ratio_reversal",
    "change",
)

#: How the page writes the limits of friction, by the index of their coefficients.
LIMITS = {"": "μp", "s": "μₛp", "k": "μₖp"}

NUMBERS = {"color": "#0072b2", "width": 1.5}
SECOND = {"color": "#009e73", "width": 1.5}
CLOSED_FORM = {"color": "#d55e00", "width": 1.5}
LIMIT = {"color": "#5b6570", "width": 1}

#: Computed values at the nodes.
POINTS = {"mode": "lines+markers", "line": {**NUMBERS, "width": 0.75}, "marker": {"size": 4}}


def page(result: Result, source: str, history: LoadHistory | None = None) -> str:
    """The page of a result. `source`: name of the file; `history`: states to show in place of the saved ones."""
    states, note = history or LoadHistory(kept_states(result), "")
    shown = thinned(states, MOST_STATES)
    limits = contact(shown)
    inside = _in_view(shown, limits)
    curve = curve_of(shown)
    notes = [note] if note else []
    if len(shown.steps) < len(states.steps):
        notes.append(f"{len(shown.steps)} of {len(states.steps)} states are shown")
    data = {
        "states": [_state(shown, number, inside, curve, history is None) for number in range(len(shown.steps))],
        "figures": {
            **_traction_figures(shown, inside),
            **({"curve": _curve_figure(shown, curve)} if len(shown.steps) > 1 or shown.history else {}),
            "map": _map_figure(shown, inside),
            **_history_figures(result),
            **_cycle_figures(result, _in_view(result, limits)),
        },
    }
    resources, reference = files(__package__) / "pages", result.reference
    environment = Environment(autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    environment.filters["number"] = _number
    return environment.from_string((resources / "report.html").read_text(encoding="utf-8")).render(
        title=result.title or source,
        source=source,
        result=result,
        attributes={name: text.strip() for name, text in result.attributes.items()},
        key_numbers=_key_numbers(result),
        zones=[STATUSES[NodeStatus(code)] for code in statuses(shown) if code != NodeStatus.OPEN],
        notes=notes,
        figures=data["figures"],
        states=len(shown.steps),
        has_friction=has_friction(result),
        sources={name: reference.description(name) for name in ("pressure", "shear", "shift") if name in reference},
        tables=_tables(result),
        cycles=_cycle_table(result),
        version=__version__,
        style=Markup((resources / "report.css").read_text(encoding="utf-8")),
        script=Markup((resources / "report.js").read_text(encoding="utf-8")),
        plotly=Markup(get_plotlyjs()),
        data=Markup(json.dumps(data, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")),
    )


def _in_view(result: Result, limits: tuple[float, float]) -> slice:
    """The nodes that are shown."""
    left, right = limits
    inside = np.flatnonzero((drawn_at(result) >= left) & (drawn_at(result) <= right))
    return slice(int(inside[0]), int(inside[-1]) + 1)


def _state(result: Result, number: int, inside: slice, curve: Curve, is_kept: bool) -> dict[str, Any]:
    """The data of a state for the slider: curves by figure and trace, the point on the curve, and text.

    `is_kept`: whether the state is from the file, with a step and a reversal.
    """
    state = result.steps[number]
    pressures: dict[str, Any] = {"pressure": _list(state.pressure[inside])}
    if "pressure" in result.reference:
        holds = has_last_normal_force(result, state)
        pressures["closed form"] = _list(result.reference.pressure[inside]) if holds else []
    if has_friction(result):
        shears: dict[str, Any] = {
            "zones": [state.status[inside].tolist()],
            "shear traction": _list(state.shear[inside]),
        }
        for index, coefficient in friction_limits(result):
            name, limit = LIMITS[index], limit_of_friction(coefficient, state)[inside]
            shears[f"+{name}"], shears[f"\N{MINUS SIGN}{name}"] = _list(limit), _list(-limit)
        if "shear" in result.reference:
            shears["closed form"] = _list(result.reference.shear[inside]) if is_last(result, state) else []
        lower = {"shear": shears}
    else:
        below, above = (_list(height[inside]) for height in heights(result, state))
        lower = {"surfaces": {"lower body": below, "upper body": above}}
    return {
        "curves": {"pressure": pressures, **lower},
        "point": [_rounded(state[curve.across]), _rounded(state[curve.up])],
        "text": _words(result, state, number, is_kept),
    }


def _words(result: Result, state: Group, number: int, is_kept: bool) -> str:
    """Description of a state: its number, its loads, its node counts."""
    place = f"state {number + 1} of {len(result.steps)}"
    if is_kept and "step" in state:
        place += f" (step {state.step}, reversal {state.reversal})"
    loads = [f"{symbol} = {_with_unit(state, name)}" for symbol, name in LOADS if name in state]
    return ", ".join([place, *loads, counts(state)])


def _traction_figures(result: Result, inside: slice) -> dict[str, Any]:
    """Pressure, and shear traction or surfaces, without values; the slider sets them."""
    x = _list(drawn_at(result)[inside])
    across = _axis(*along_surface(result))
    largest = max(float(state.pressure.max()) for state in result.steps) or 1.0
    pressure = _figure(across, _axis("pressure", "p", result.state.unit("pressure"), [0.0, 1.08 * largest]))
    if "pressure" in result.reference:
        pressure.add_scatter(x=x, name="closed form", mode="lines", line=CLOSED_FORM)
    pressure.add_scatter(x=x, name="pressure", **POINTS)
    figures = {"pressure": pressure}
    if has_friction(result):
        figures["shear"] = _shear_figure(result, inside, x, across)
    else:
        surfaces = _figure(across, _axis("height", "y", result.state.unit("gap")))
        surfaces.add_scatter(x=x, name="lower body", mode="lines+markers", line=SECOND, marker_size=4)
        surfaces.add_scatter(x=x, name="upper body", mode="lines", line=LIMIT)
        figures["surfaces"] = surfaces
    return {name: _plain(figure) for name, figure in figures.items()}


def _shear_figure(result: Result, inside: slice, x: Sequence[Any], across: dict[str, Any]) -> go.Figure:
    """Shear traction with the friction limits and stick and slip zones."""
    limits = friction_limits(result)
    bound = max(
        [float(np.max(np.abs(state.shear))) for state in result.steps]
        + [float(np.max(coefficient * state.pressure)) for state in result.steps for _, coefficient in limits]
    )
    bound = bound or 1.0
    figure = _figure(across, _axis("shear traction", "τ", result.state.unit("shear"), [-1.08 * bound, 1.08 * bound]))
    figure.add_heatmap(x=_edges(result, inside), y=[-2.0 * bound, 2.0 * bound], name="zones", hoverinfo="skip", **_status_colours())
    for index, _ in limits:
        line = {**LIMIT, "dash": "dot" if index == "k" else "solid"}
        for sign in "+\N{MINUS SIGN}":
            figure.add_scatter(x=x, name=f"{sign}{LIMITS[index]}", mode="lines", line=line)
    if "shear" in result.reference:
        figure.add_scatter(x=x, name="closed form", mode="lines", line=CLOSED_FORM)
    figure.add_scatter(x=x, name="shear traction", **POINTS)
    return figure


def _curve_figure(result: Result, curve: Curve) -> dict[str, Any]:
    """Load over displacement, and the moving point of the slider as the last trace."""
    units = (result.summary.unit(name) for name in (curve.across, curve.up))
    figure = _figure(*(_axis(*label, unit) for label, unit in zip((curve.across_label, curve.up_label), units)))
    across, up = curve.values(result)
    chosen = evenly(across.size, MOST_RECORDS)
    loads = _list(up[chosen])
    figure.add_scatter(x=_list(across[chosen]), y=loads, name="computed", mode="lines", line=NUMBERS)
    if curve.across == "shift" and result.history and "shift" in result.reference:
        closed = {**CLOSED_FORM, "dash": "dash"}
        shift = _list(result.reference.shift[chosen])
        figure.add_scatter(x=shift, y=loads, name="closed form", mode="lines", line=closed)
    figure.add_scatter(name="this state", mode="markers", marker={"size": 13, "color": "#d55e00"})
    return _plain(figure)


def _map_figure(result: Result, inside: slice) -> dict[str, Any]:
    """The status of every node in every state."""
    statuses = np.array([state.status[inside] for state in result.steps])
    ticks = {"dtick": 1} if len(result.steps) <= MOST_TICKS else {}
    figure = _figure(_axis(*along_surface(result)), {"title": {"text": "state"}, **ticks})
    figure.update_layout(margin_t=8)
    words = [STATUSES[NodeStatus(code)][0] for code in range(len(NodeStatus))]
    figure.add_heatmap(
        x=_edges(result, inside),
        y=(np.arange(len(result.steps) + 1) + 0.5).tolist(),
        z=statuses.tolist(),
        text=[[words[code] for code in row] for row in statuses] if statuses.size <= 20000 else None,
        hovertemplate="x = %{x:.4g}, state %{y}: %{text}<extra></extra>" if statuses.size <= 20000 else None,
        name="status",
        **_status_colours(),
    )
    return _plain(figure)


def _history_figures(result: Result) -> dict[str, Any]:
    """Loads, dissipation and numbers of nodes over the records of the history."""
    history = result.history
    if not history:
        return {}
    chosen = evenly(history.normal_force.size, MOST_RECORDS)
    record = (chosen + 1).tolist()

    def over_records(names: Iterable[tuple[str, str]], label: tuple[str, str, str]) -> dict[str, Any]:
        figure = _figure({"title": {"text": "record"}}, _axis(*label))
        for (name, shown), line in zip(names, (NUMBERS, SECOND)):
            figure.add_scatter(x=record, y=_list(history[name][chosen]), name=shown, mode="lines", line=line)
        return _plain(figure)

    is_rubbed = has_friction(result)
    forces = [("normal_force", "normal force P")] + [("tangential_force", "tangential force Q")] * is_rubbed
    nodes = [("contact_nodes", "in contact")] + [("stick_nodes", "stuck")] * is_rubbed
    figures = {"forces": over_records(forces, ("force", "", history.unit("normal_force")))}
    if is_rubbed:
        label = "dissipation", "", history.unit("dissipation")
        figures["dissipation"] = over_records([("dissipation", "dissipation")], label)
    figures["nodes"] = over_records(nodes, ("nodes", "", "1"))
    return figures


def _cycle_figures(result: Result, inside: slice) -> dict[str, Any]:
    """Dissipation of every cycle, and of the last one over x."""
    cycles = result.cycles
    if not cycles:
        return {}
    figure = _figure({"title": {"text": "cycle"}}, _axis("dissipation of a cycle", "", cycles.unit("dissipation")))
    figure.update_yaxes(rangemode="tozero")
    figure.add_scatter(x=cycles.cycle.tolist(), y=_list(cycles.dissipation), name="dissipation", mode="lines+markers", line=NUMBERS)
    figures = {"cycles": figure}
    if "friction_work" in cycles:
        label = _axis("dissipation per cycle and area", "", cycles.unit("friction_work"))
        work = _figure(_axis(*along_surface(result)), label)
        x, values = _list(drawn_at(result)[inside]), _list(cycles.friction_work[inside])
        work.add_scatter(x=x, y=values, name="friction work", **POINTS)
        figures["work"] = work
    return {name: _plain(figure) for name, figure in figures.items()}


def _figure(across: dict[str, Any], up: dict[str, Any]) -> go.Figure:
    """An empty figure."""
    frame = {"showline": True, "mirror": True, "ticks": "inside", "zeroline": False, "exponentformat": "power"}
    return go.Figure(
        layout={
            "template": "plotly_white",
            "xaxis": {"automargin": True, **frame, **across},
            "yaxis": {"automargin": True, **frame, **up},
            "margin": {"l": 56, "r": 12, "t": 30, "b": 44},
            "legend": {"orientation": "h", "x": 0, "y": 1.02, "yanchor": "bottom"},
            "showlegend": False,
        }
    )


def _axis(name: str, symbol: str, unit: str, limits: Sequence[float] | None = None) -> dict[str, Any]:
    """Title of an axis, with the unit if the user has named it, and its range if given."""
    shown = f" [{_unit(unit)}]" if is_named(unit) else ""
    title = f"{name} <i>{symbol}</i>{shown}" if symbol else f"{name}{shown}"
    axis: dict[str, Any] = {"title": {"text": title}}
    if limits is not None:
        axis["range"] = list(limits)
    return axis


def _plain(figure: go.Figure) -> dict[str, Any]:
    """A figure as plain lists and dictionaries."""
    plain: dict[str, Any] = json.loads(figure.to_json())
    return plain


def _status_colours() -> dict[str, Any]:
    """A colour for each status, for a heat map."""
    bands = len(NodeStatus)
    scale = [[edge / bands, STATUSES[NodeStatus(code)][1]] for code in range(bands) for edge in (code, code + 1)]
    return {"colorscale": scale, "zmin": -0.5, "zmax": bands - 0.5, "showscale": False}


def _edges(result: Result, inside: slice) -> list[float]:
    """The boundaries between the intervals of the nodes."""
    starts, ends = intervals(result)
    return [*starts[inside].tolist(), float(ends[inside][-1])]


def _key_numbers(result: Result) -> list[dict[str, str]]:
    """The key numbers: name, value with unit, error bar, definition."""
    found = []
    omitted: tuple[str, ...] = () if has_friction(result) else OF_FRICTION
    if result.summary.get("patches", 1) == 1:
        omitted += ("contact_length", "patches")  # with one patch equivalent to the half-width
    for group_name, name, shown in KEY_NUMBERS:
        group: Group = getattr(result, group_name)
        if name in group and name not in omitted and not math.isnan(group[name]):
            bar = result.error_estimate.get(f"{name}_error")
            found.append(
                {
                    "name": shown,
                    "value": _with_unit(group, name),
                    "bar": doubt(result, name).strip() if bar is None or not math.isfinite(bar) else f"± {bar:.2g}",
                    "meaning": group.description(name),
                }
            )
    return found


def _tables(result: Result) -> dict[str, list[tuple[str, str, str, str]]]:
    """All numbers of the result: name, value, unit, meaning, by group."""
    groups = (("certificate", result.certificate), ("summary", result.summary), ("observables", result.observables))
    return {
        name: [
            (key, _number(group[key]), _unit(group.unit(key)), group.description(key) + doubt(result, key))
            for key in group
            if np.ndim(group[key]) == 0
        ]
        for name, group in groups
        if group
    }


def _cycle_table(result: Result) -> dict[str, Any]:
    """The cycles: columns with names and units, rows; of many the first and the last."""
    cycles = result.cycles
    if not cycles:
        return {}
    names = [name for name in CYCLE_COLUMNS if name in cycles and not np.isnan(cycles[name]).all()]
    chosen = evenly(cycles.cycle.size, MOST_CYCLES)
    rows = [(int(cycles.cycle[row]), [_number(cycles[name][row]) for name in names]) for row in chosen]
    return {
        "names": [(name.replace("_", " "), _unit(cycles.unit(name))) for name in names],
        "rows": rows,
        "all": int(cycles.cycle.size),
    }


def _with_unit(group: Group, name: str) -> str:
    """A number with its unit if the user has named one."""
    unit = group.unit(name)
    return f"{_number(group[name])}{f' {_unit(unit)}' if is_named(unit) else ''}"


def _unit(unit: str) -> str:
    """A unit for display; empty for a pure number."""
    return _html.unit(unit).replace("^2", "²").replace("^3", "³")


def _number(value: Any) -> str:
    """A number for display."""
    return "none" if math.isnan(value) else f"{value + 0:.6g}".replace("-", "\N{MINUS SIGN}")


def _list(values: Any) -> list[float | None]:
    """Numbers for the page; None for those that are not finite."""
    return [_rounded(value) for value in np.asarray(values, dtype=float).tolist()]


def _rounded(value: float) -> float | None:
    return float(f"{value:.{DIGITS}g}") if math.isfinite(value) else None
