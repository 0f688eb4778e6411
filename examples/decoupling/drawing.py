"""Shared by the pictures of the study."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from sweeps import COUPLINGS, Table

#: Colours from Okabe and Ito, distinguishable with colour blindness, with a marker each.
BLUE, ORANGE, GREEN, YELLOW, SKY, PINK, BLACK = (
    "#0072B2",
    "#D55E00",
    "#009E73",
    "#E69F00",
    "#56B4E9",
    "#CC79A7",
    "#000000",
)
CYCLE = ((BLUE, "o"), (ORANGE, "s"), (GREEN, "^"), (YELLOW, "v"), (PINK, "D"), (SKY, "x"), (BLACK, "P"))
OF_COUPLING = dict(zip(COUPLINGS, CYCLE))

#: The bodies of section 6.2.1, and their common limit for small contacts.
BODIES = {
    "hole_097": "0.97R in hole R, $KR=0.03$",
    "hole_050": "0.5R in hole R, $KR=1$",
    "disk_on_plane": "R on half-plane, $KR=1$",
    "disk_on_050": "R on 0.5R, $KR=1.5$",
    "disk_on_100": "R on R, $KR=2$",
    "half_plane": "elastic half-plane",
}
FORCE_RATIO = r"lateral force ratio $\tilde Q = Q/(\mu P)$"
FRICTION = r"coefficient of friction $\mu$"
DISSIPATION = r"dissipation of a cycle $D/(P^2 A)$"


@dataclass
class Drawn:
    """A picture with what it shows, and its numbers by column."""

    name: str
    caption: str
    picture: Figure
    numbers: Mapping[str, np.ndarray] = field(default_factory=dict)
    in_docs: bool = False


def stem(base: str) -> str:
    """Name of a case without its folder and ending."""
    return base.rsplit("/", 1)[-1].removesuffix(".nml")


def panels(rows: int, columns: int, size: tuple[float, float], **more: Any) -> tuple[Figure, list[Axes]]:
    """A picture with panels, row by row."""
    picture = Figure(figsize=size, layout="constrained")
    return picture, list(np.atleast_1d(picture.subplots(rows, columns, **more)).ravel())


def line(ax: Axes, x: np.ndarray, y: np.ndarray, place: int = 0, label: str | None = None, **style: Any) -> None:
    """Points joined by a line, by place in the cycle of colours and markers."""
    colour, marker = CYCLE[place % len(CYCLE)]
    defaults: dict[str, Any] = dict(color=colour, marker=marker, markersize=3.5, linewidth=1.0, label=label)
    ax.plot(x, y, **(defaults | style))


def coupled(ax: Axes, table: Table, x: str, y: str, **style: Any) -> None:
    """A line for each coupling of a table."""
    for coupling, rows in table.each("coupling"):
        place = list(COUPLINGS).index(coupling)
        line(ax, rows[x], rows[y], place, COUPLINGS[coupling], **style)


def letter(axes: list[Axes]) -> None:
    """Letters above the panels, before their titles."""
    for ax, name in zip(axes, "abcdefghijkl"):
        title = ax.get_title()
        ax.set_title("")
        ax.set_title(f"({name}) {title}", fontsize=10, loc="left")


def bodies_legend(picture: Figure, ax: Axes, columns: int = 3) -> None:
    """One legend below all panels."""
    handles, labels = ax.get_legend_handles_labels()
    picture.legend(handles, labels, loc="outside lower center", ncols=columns, fontsize=9)
