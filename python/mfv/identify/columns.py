"""What the columns of a record show by themselves: noise, resolution, spikes."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from .loop import Loop

Array = NDArray[np.float64]

#: A row is a spike if it is farther from the median of five than this many robust standard deviations and increments.
_SPIKE, _INCREMENTS = 8.0, 4.0


def robust_deviation(values: Array) -> float:
    """Standard deviation of normal values from their median absolute deviation."""
    return 1.4826 * float(np.median(np.abs(values - np.median(values))))


def estimated_noise(column: Array, time: Array | None = None) -> float:
    """Standard deviation of independent errors, from the median of the second differences, which ignores the turning points
    (Gasser, Sroka and Jennen-Steinmetz 1986, made robust); with `time`, from the line through the neighbours."""
    after = np.full(column.size - 2, 0.5) if time is None else np.diff(time)[:-1] / np.maximum(time[2:] - time[:-2], 1e-300)
    differences = (1.0 - after) * column[:-2] + after * column[2:] - column[1:-1]
    return robust_deviation(differences / np.sqrt((1.0 - after) ** 2 + after**2 + 1.0))


def scatter_in_the_plane(force: Array, shift: Array) -> float:
    """Standard deviation of rows across the line through four neighbours, both columns over their ranges: it does not depend on
    how far the rows are apart."""
    points = np.stack([force / np.ptp(force), shift / np.ptp(shift)], axis=1)
    distances = []
    for row in range(2, len(points) - 2):
        near = points[[row - 2, row - 1, row + 1, row + 2]]
        centre = near.mean(axis=0)
        _, _, axes = np.linalg.svd(near - centre)
        along = (near - centre) @ axes[0]
        factor = 1.0 + 0.25 + float((points[row] - centre) @ axes[0]) ** 2 / max(float(along @ along), 1e-300)
        distances.append(float((points[row] - centre) @ axes[1]) / math.sqrt(factor))
    return robust_deviation(np.array(distances))


def grid_step(column: Array) -> float:
    """The step of a rounded column; 0 if it is not rounded, or moves evenly from step to step as a computed one."""
    values = np.unique(column)
    gaps = np.diff(values)
    gaps = gaps[gaps > 1e-9 * np.ptp(column)]
    if column.size < 20 or gaps.size < 3:
        return 0.0
    step = float(gaps.min())
    second = np.abs(column[:-2] - 2.0 * column[1:-1] + column[2:])
    is_rounded = np.all(np.abs(gaps / step - np.round(gaps / step)) < 1e-3) and np.mean(second > 0.5 * step) > 0.1
    return step if is_rounded else 0.0


def spikes_of(loop: Loop) -> tuple[NDArray[np.bool_], tuple[Array, Array]]:
    """Single rows that are far from their neighbours in one column only, and the columns with the median of five in their place.

    The median of five is the row itself where the column moves in one direction, however uneven the rows are.
    """
    columns = (loop.tangential_force, loop.shift)
    (force_off, force_far), (shift_off, shift_far) = (
        far_from_neighbours(column, loop.time) if noise != 0.0 else (np.zeros(column.size), np.zeros(column.size, dtype=bool))
        for column, noise in zip(columns, (loop.force_noise, loop.shift_noise))
    )
    alone = np.minimum(np.abs(force_off), np.abs(shift_off)) < 0.3 * np.maximum(np.abs(force_off), np.abs(shift_off))
    is_spike = (force_far | shift_far) & (alone | (force_off * shift_off < 0.0))
    force, shift = (np.where(is_spike, _median_of_five(column), column) if is_spike.any() else column for column in columns)
    return is_spike, (force, shift)


def far_from_neighbours(column: Array, time: Array | None = None) -> tuple[Array, NDArray[np.bool_]]:
    """Distances from the median of five over the range, and which of them are those of spikes; none of fewer than 20 rows."""
    span = float(np.ptp(column))
    if column.size < 20 or span == 0.0:
        return np.zeros(column.size), np.zeros(column.size, dtype=bool)
    off = column - _median_of_five(column)
    steps = np.abs(np.diff(np.lib.stride_tricks.sliding_window_view(np.pad(column, 4, mode="reflect"), 9)))
    limit = np.maximum(_SPIKE * max(estimated_noise(column, time), 1e-9 * span), _INCREMENTS * np.median(steps, axis=1))
    return off / span, np.abs(off) > limit


def _median_of_five(column: Array) -> Array:
    if column.size < 5:
        return column
    near = np.lib.stride_tricks.sliding_window_view(np.pad(column, 2, mode="reflect"), 5)
    return np.asarray(np.median(near, axis=1))
