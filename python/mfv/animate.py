"""Animations of results: the load history as a GIF or an MP4.

`movie` makes one of the states in `steps`; `save` writes it.
"""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable
from typing import Any, NamedTuple

import matplotlib
import numpy as np
from matplotlib.animation import AbstractMovieWriter, FFMpegWriter, FuncAnimation, PillowWriter
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.patches import Patch

from . import drawing, plot
from ._packages import how_to_install
from .load_history import kept_states
from .result import Group, Result, counts
from .stress import drawn_at
from .views import LOADS, Curve, contact, curve_of, has_friction, heights, is_named, statuses

#: Suffixes of files that can be written.
SUFFIXES = (".gif", ".mp4")

#: Dots an inch: a panel of 3.6 inch is 360 pixels wide.
RESOLUTION = 100

#: Heights in inch: of the picture, of the row of its caption, of the row of its legend.
HEIGHT, CAPTION, LEGEND = 4.06, 0.25, 0.27

#: Margin of the axes, relative to their range.
MARGIN = 0.06


class Movie(NamedTuple):
    """A picture and a function that draws a frame into it."""

    picture: Figure
    draw: Callable[[int], None]
    frames: int


def movie(result: Result) -> Movie:
    """The states in `result.steps`, or the last state, one after the other: pressure; shear traction with stick and slip zones, or
    the surfaces without friction; load over displacement with a point at the state."""
    result = result if result.steps else kept_states(result)
    is_rubbed = has_friction(result)
    with matplotlib.rc_context(drawing.STYLE):
        picture = Figure(figsize=(3 * drawing.PANEL_WIDTH, HEIGHT), dpi=RESOLUTION)
        axes = picture.subplots(1, 3)
        picture.suptitle(result.title, fontsize=12, parse_math=False)
        zones = _zones(result) if is_rubbed else []
        below = CAPTION + (LEGEND if zones else 0.0)
        picture.set_layout_engine(ConstrainedLayoutEngine(rect=(0.0, below / HEIGHT, 1.0, 1.0 - below / HEIGHT), w_pad=0.08))
        caption = picture.text(0.5, 0.08 / HEIGHT, "", ha="center", fontsize=10, color="0.35", parse_math=False)
        if zones:
            picture.legend(
                handles=zones, ncols=len(zones), fontsize=10, loc="upper center", bbox_to_anchor=(0.5, below / HEIGHT),
                borderaxespad=0.0, borderpad=0.0,
            )  # fmt: skip
    second = (plot.shear, _limits_of_shear(result)) if is_rubbed else (plot.surfaces, _heights(result))
    panels: list[tuple[Axes, plot.Panel, tuple[float, float]]] = [
        (axes[0], plot.pressure, (0.0, _largest(result, "pressure"))),
        (axes[1], *second),
    ]
    framed = contact(result)
    curve = curve_of(result)
    point = _draw_curve(result, axes[2], curve)

    def draw(number: int) -> None:
        state = result.steps[number]
        with matplotlib.rc_context(drawing.STYLE):
            for ax, panel, limits in panels:
                ax.clear()
                panel(result, ax, number + 1)
                ax.set_xlim(framed)
                ax.set_ylim(_with_margin(limits))
        point.set_data([state[curve.across]], [state[curve.up]])
        caption.set_text(_caption(result, state, number + 1))

    draw(len(result.steps) - 1)
    with matplotlib.rc_context(drawing.STYLE):
        picture.draw_without_rendering()
    picture.set_layout_engine("none")  # fixed panels
    return Movie(picture, draw, len(result.steps))


def save(
    moving: Movie,
    path: str | os.PathLike[str],
    frames_per_second: int = 20,
    progress: Callable[[int, int], Any] | None = None,
) -> None:
    """Write a movie as a GIF or an MP4, by the suffix. `progress` is called with each frame and their number.

    Raises ValueError for another suffix, or for an MP4 without ffmpeg; OSError.
    """
    path = os.fspath(path)
    program: dict[Any, Any] = {"animation.ffmpeg_path": _ffmpeg()} if path.lower().endswith(".mp4") else {}
    writer = _writer(path, frames_per_second)
    frames = FuncAnimation(moving.picture, moving.draw, frames=moving.frames, init_func=lambda: None)
    with matplotlib.rc_context({**drawing.STYLE, **program}):
        frames.save(path, writer=writer, progress_callback=progress)


def _writer(path: str, frames_per_second: int) -> AbstractMovieWriter:
    """The writer of files with this suffix."""
    suffix = os.path.splitext(path)[1].lower()
    if suffix == ".gif":
        return PillowWriter(fps=frames_per_second)
    if suffix == ".mp4":
        return FFMpegWriter(fps=frames_per_second, codec="libx264", extra_args=["-pix_fmt", "yuv420p"])
    raise ValueError(f"the name of an animation must end with {' or '.join(SUFFIXES)}, not '{suffix}'")


def _ffmpeg() -> str:
    """The program ffmpeg, or that of the package imageio-ffmpeg. Raises ValueError if neither exists."""
    found = shutil.which(matplotlib.rcParams["animation.ffmpeg_path"])
    if found:
        return str(found)
    try:
        from imageio_ffmpeg import get_ffmpeg_exe

        return str(get_ffmpeg_exe())
    except (ImportError, RuntimeError):
        raise ValueError(
            "an MP4 needs ffmpeg, which was not found: install it (apt-get install ffmpeg, or "
            f"{how_to_install('imageio-ffmpeg')}), or write a GIF (-o NAME.gif)"
        ) from None


def _zones(result: Result) -> list[Patch]:
    """Patches for a legend of the statuses that nodes have in any of the states."""
    return [Patch(**style) for status, style in drawing.ZONES.items() if status in statuses(result)]


def _largest(result: Result, name: str) -> float:
    return max(float(np.max(np.abs(state[name]))) for state in result.steps) or 1.0


def _limits_of_shear(result: Result) -> tuple[float, float]:
    """The largest friction limits, or the largest shear traction if they are unknown."""
    largest = _largest(result, "shear")
    if "static_friction" in result.mesh:
        largest = max(float(np.max(result.mesh.static_friction * state.pressure)) for state in result.steps) or 1.0
    return -largest, largest


def _heights(result: Result) -> tuple[float, float]:
    """The lowest and the highest point of both surfaces in view."""
    left, right = contact(result)
    in_view = (drawn_at(result) >= left) & (drawn_at(result) <= right)
    shown = [height[in_view] for state in result.steps for height in heights(result, state)]
    return float(np.nanmin(shown)), float(np.nanmax(shown))


def _with_margin(limits: tuple[float, float]) -> tuple[float, float]:
    low, high = limits
    margin = MARGIN * (high - low)
    return (low - margin if low != 0.0 else 0.0), high + margin


def _draw_curve(result: Result, ax: Axes, curve: Curve) -> Any:
    """Draw load over displacement, from the history or else the states; return the moving point."""
    with matplotlib.rc_context(drawing.STYLE):
        ax.plot(*curve.values(result), color=drawing.NUMBERS, linewidth=0.8)
        (point,) = ax.plot([], [], "o", color=drawing.CLOSED_FORM, markersize=8, zorder=5)
        ax.set_xlabel(drawing.label(*curve.across_label, result.summary.unit(curve.across)))
        ax.set_ylabel(drawing.label(*curve.up_label, result.summary.unit(curve.up)))
        ax.locator_params(axis="x", nbins=5)
        ax.margins(0.12)
    return point


def _caption(result: Result, state: Group, number: int) -> str:
    """Number of the state, its loads and how many nodes stick."""
    parts = [f"state {number} of {len(result.steps)}"]
    for symbol, name in LOADS:
        if name in state:
            unit = state.unit(name)
            parts.append(f"{symbol} = {state[name]:.3g}{f' {unit}' if is_named(unit) else ''}")
    parts.append(counts(state))
    return " \N{MIDDLE DOT} ".join(parts)
