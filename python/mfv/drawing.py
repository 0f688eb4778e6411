"""What pictures of results have in common: style, colours, zones, labels, heading, caption, legend."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from .codes import NodeStatus
from .result import Group, Result, counts
from .views import along_surface, contact, intervals, is_named

#: Colours from Okabe and Ito, distinguishable with colour blindness.
NUMBERS, CLOSED_FORM, SURFACE, MARKS = "#0072B2", "#D55E00", "#009E73", "#000000"
STICK, RIGHT, LEFT, WITHOUT_FRICTION = "#DCEBF5", "#FBE3B4", "#EBD3E1", "#EEEEEE"
ZONES: dict[int, dict[str, Any]] = {
    status: {"label": label, "facecolor": colour, "edgecolor": edge, "hatch": hatch}
    for status, label, colour, edge, hatch in (
        (NodeStatus.STICK, "stick", STICK, "none", None),
        (NodeStatus.SLIP_RIGHT, "lower surface slips to the right", RIGHT, "#C9A24B", "///"),
        (NodeStatus.SLIP_LEFT, "lower surface slips to the left", LEFT, "#B98AA6", "\\\\\\"),
        (NodeStatus.CREEP_RIGHT, "lower surface creeps to the right", STICK, "#9FC3DA", "//"),
        (NodeStatus.CREEP_LEFT, "lower surface creeps to the left", STICK, "#9FC3DA", "\\\\"),
        (NodeStatus.FRICTIONLESS, "frictionless contact", WITHOUT_FRICTION, "none", None),
    )
}

STYLE: dict[Any, Any] = {
    "font.family": ["STIXGeneral"],
    "mathtext.fontset": "stix",
    "font.size": 11,
    "axes.titlesize": 11,
    "axes.linewidth": 0.6,
    "axes.formatter.use_mathtext": True,
    "axes.formatter.limits": (-3, 4),
    "hatch.linewidth": 0.4,
    "legend.frameon": False,
    "xtick.direction": "in",
    "ytick.direction": "in",
    "xtick.top": True,
    "ytick.right": True,
}

#: Size of a panel with its labels in inch.
PANEL_WIDTH, PANEL_HEIGHT = 3.6, 3.3

#: Letters of the caption per inch; width of the key of a legend entry, in letters.
LETTERS_PER_INCH, KEY_LETTERS = 19, 9


def limit_style(index: str) -> dict[str, Any]:
    """How a limit of friction is drawn: the kinetic one is dashed."""
    label = rf"limit $\pm\mu_{index} p$" if index else r"limit $\pm\mu p$"
    return {"color": "0.35", "linewidth": 0.7, "linestyle": (0, (2, 2)) if index == "k" else "-", "label": label}


def loads_of(result: Result, step: int | None) -> Group:
    """Loads and counts of that state."""
    return result.summary if step is None else result.at(step)


def shade_zones(ax: Axes, result: Result, state: Group) -> None:
    """Background of the stick and slip zones; of each kind the first has the label."""
    starts, ends = intervals(result)
    labelled: set[int] = set()
    for status, first, last in runs(state.status):
        if status in ZONES:
            style = ZONES[status] if status not in labelled else {**ZONES[status], "label": "_another zone"}
            ax.axvspan(starts[first], ends[last], linewidth=0.0, zorder=0, **style)
            labelled.add(status)


def runs(values: np.ndarray) -> Iterator[tuple[int, int, int]]:
    """Value, first and last index of every run of equal values."""
    starts = np.flatnonzero(np.diff(values, prepend=values[0] - 1))
    ends = np.append(starts[1:], len(values)) - 1
    return ((int(values[first]), int(first), int(last)) for first, last in zip(starts, ends))


def frame_contact(ax: Axes, result: Result, state: Group) -> None:
    """Show the contact and a quarter of its length on either side within the mesh; without contact the whole mesh."""
    ax.set_xlim(contact(result, [state]))
    ax.locator_params(axis="x", nbins=5)
    ax.set_xlabel(label(*along_surface(result)))


def legend_entries(picture: Figure, lines_first: bool = True) -> tuple[list[Artist], list[str]]:
    """Handles and labels of everything that is drawn, once, lines before zones."""
    handles: dict[str, Artist] = {}
    for ax in picture.axes:
        for handle, label in zip(*ax.get_legend_handles_labels()):
            handles.setdefault(label, handle)
    labels = sorted(handles, key=lambda label: lines_first and isinstance(handles[label], Patch))
    return [handles[label] for label in labels], labels


def add_legend(picture: Figure, caption: str = "", lines_first: bool = True) -> None:
    """One legend below all panels of a picture with a constrained layout, lines before zones, with the caption above it."""
    letters = int(LETTERS_PER_INCH * picture.get_figwidth())
    handles, labels = legend_entries(picture, lines_first)
    rows = -(-sum(len(label) + KEY_LETTERS for label in labels) // letters) or 1
    legend = picture.legend(
        handles,
        labels,
        ncols=-(-len(labels) // rows) or 1,
        fontsize=10,
        loc="outside lower center",
        title="\n".join(textwrap.fill(line, letters) for line in caption.splitlines()),
        title_fontsize=9,
    )
    legend.get_title().set(color="0.35", parse_math=False, multialignment="center")


def heading(result: Result, step: int | None) -> str:
    """The title of the result and, for a saved state, which one it is."""
    if step is None:
        return result.title
    state = result.at(step)
    place = f"state {step} (step {state.step}, reversal {state.reversal})"
    return f"{result.title}: {place}" if result.title else place


def caption(result: Result, step: int | None) -> str:
    """Outcome unless complete, node counts and certificate; below, the sources of the closed forms."""
    parts = [
        f"{result.mesh.x.size} nodes, {counts(loads_of(result, step))}",
        f"largest relative residual {result.certificate.largest:.1e}",
    ]
    if result.outcome != "complete":
        parts.insert(0, f"ended early: {result.outcome}")
    names = [name for name in ("pressure", "shear") if name in result.reference]
    sources = "; ".join(result.reference.description(name).split(";")[0] for name in names)
    return " \N{MIDDLE DOT} ".join(parts) + (f"\nclosed form: {sources}" if sources else "")


def label(name: str, symbol: str, unit: str) -> str:
    """Label of an axis, with the unit if the user has named it."""
    if not is_named(unit):
        return f"{name} ${symbol}$"
    shown = unit.replace("$", r"\$").replace("^2", "$^2$")
    return f"{name} ${symbol}$ [{shown}]"
