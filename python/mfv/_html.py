"""What notebooks show: small tables and a picture of the tractions as HTML, in the colours of the page, without JavaScript."""

from __future__ import annotations

import html
from collections.abc import Collection, Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

#: Colours of pressure and shear traction: near those of mfv.plot, and legible on light and dark pages.
PRESSURE, SHEAR = "#2A8FD0", "#D55E00"

#: Size of the picture in pixels, what is left free around the curves and, for their names, below; points beyond so many are
#: thinned out.
WIDTH, HEIGHT, MARGIN, LEGEND, MOST_POINTS = 360, 150, 12, 18, 400

CELL = "text-align:left; padding:1px 10px 1px 0; vertical-align:top"
NUMBER = "text-align:right; padding:1px 10px 1px 0; vertical-align:top; font-variant-numeric:tabular-nums"


def table(rows: Iterable[Sequence[str]], caption: str = "", numbers: Collection[int] = ()) -> str:
    """A table whose first column has names; `numbers`: columns that are numbers."""
    lines = [
        "<tr>" + "".join(_cell(text, column, column in numbers) for column, text in enumerate(row)) + "</tr>"
        for row in rows
    ]
    head = f"<caption style='text-align:left; font-weight:bold'>{html.escape(caption)}</caption>" if caption else ""
    return f"<table style='border-collapse:collapse; margin:4px 0; color:inherit; font-size:inherit'>{head}{''.join(lines)}</table>"


def block(*parts: str) -> str:
    """Parts one below the other."""
    return "<div>" + "".join(parts) + "</div>"


def unit(name: str) -> str:
    """A unit as it is shown: nothing for a pure number."""
    return "" if name == "1" else name


def tractions(x: NDArray[np.float64], pressure: NDArray[np.float64], shear: NDArray[np.float64]) -> str:
    """A picture of pressure and shear traction over the loaded part of the surface; empty where nothing is loaded."""
    loaded = np.flatnonzero((pressure != 0.0) | (shear != 0.0))
    if loaded.size == 0:
        return ""
    first, last = max(loaded[0] - 1, 0), min(loaded[-1] + 2, x.size)
    shown = slice(first, last, max(1, (last - first) // MOST_POINTS))
    across = _scaled(x[shown], x[first], x[last - 1], MARGIN, WIDTH - MARGIN)
    low, high = min(0.0, shear.min()), max(pressure.max(), shear.max())
    bottom, height = HEIGHT - MARGIN, HEIGHT + LEGEND
    zero = _scaled(np.zeros(2), low, high, bottom, MARGIN)
    parts = [_line(across[[0, -1]], zero, "currentColor", 0.5)]
    place = MARGIN
    for name, values, colour in (("pressure", pressure, PRESSURE), ("shear traction", shear, SHEAR)):
        if np.any(values != 0.0):
            parts.append(_line(across, _scaled(values[shown], low, high, bottom, MARGIN), colour, 1.5))
            parts.append(f"<text x='{place}' y='{height - 5}' font-size='12' fill='{colour}'>{name}</text>")
            place += WIDTH // 4
    size = f"width='{WIDTH}' height='{height}' viewBox='0 0 {WIDTH} {height}'"
    return f"<svg role='img' xmlns='http://www.w3.org/2000/svg' {size}>{''.join(parts)}</svg>"


def _cell(text: str, column: int, is_number: bool) -> str:
    kind = "th" if column == 0 else "td"
    return f"<{kind} style='{NUMBER if is_number else CELL}'>{html.escape(text)}</{kind}>"


def _scaled(values: NDArray[np.float64], low: float, high: float, start: float, end: float) -> NDArray[np.float64]:
    """Values from [low, high] on the way from `start` to `end`."""
    reach = high - low
    return start + (end - start) * ((values - low) / reach if reach > 0.0 else 0.5 + 0.0 * values)


def _line(across: NDArray[np.float64], up: NDArray[np.float64], colour: str, width: float) -> str:
    points = " ".join(f"{x:.1f},{y:.1f}" for x, y in zip(across, up))
    return f"<polyline points='{points}' fill='none' stroke='{colour}' stroke-width='{width}'/>"
