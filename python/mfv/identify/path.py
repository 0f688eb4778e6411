"""The driven column as a path between turning points."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..errors import input_error

if TYPE_CHECKING:
    from .loop import Loop

Array = NDArray[np.float64]


@dataclass
class Path:
    """The driven column as a path between levels. `levels`: distinct values of extremes, with `errors`, their standard errors;
    `turns`: index of the level at the end of every branch, the last branch included; `before`: levels passed before the first row;
    `branch`: of every row, from 0."""

    levels: Array
    errors: Array
    turns: list[int]
    before: list[int]
    branch: NDArray[np.int64]


def estimated_noise(column: Array) -> float:
    """Standard deviation of independent errors, from the median of the second differences, which ignores the turning points
    (Gasser, Sroka and Jennen-Steinmetz 1986, made robust)."""
    differences = column[:-2] - 2.0 * column[1:-1] + column[2:]
    return 1.4826 * float(np.median(np.abs(differences - np.median(differences)))) / math.sqrt(6.0)


def _reversals(driven: Array, threshold: float) -> list[int]:
    """Rows of the extremes between which the column changes by more than a threshold."""
    found: list[int] = []
    low = high = 0
    direction = 0
    for row, value in enumerate(driven):
        low = row if value < driven[low] else low
        high = row if value > driven[high] else high
        if direction >= 0 and driven[high] - value > threshold:
            found += [high] if direction > 0 or driven[high] - driven[0] > threshold else []
            direction, low = -1, row
        elif direction <= 0 and value - driven[low] > threshold:
            found += [low] if direction < 0 or driven[0] - driven[low] > threshold else []
            direction, high = 1, row
    return found


def _with_ends(driven: Array, rows: list[int], threshold: float) -> list[int]:
    """Reversals, completed by those that the record begins shortly after or ends shortly behind: turns by more than a threshold."""
    if not rows:
        return rows
    first = int(np.argmax(np.abs(driven[: rows[0]] - driven[rows[0]]))) if rows[0] > 0 else 0
    last = rows[-1] + int(np.argmax(np.abs(driven[rows[-1] :] - driven[rows[-1]])))
    begins = abs(driven[0] - driven[first]) > threshold
    ends = abs(driven[-1] - driven[last]) > threshold
    return ([first] if begins else []) + rows + ([last] if ends else [])


def path_of(loop: Loop) -> Path:
    """The path of the driven column. Raises InputError."""
    driven = loop._driven
    noise = (loop.force_noise if loop.drive == "tangential_force" else loop.shift_noise) or 0.0
    amplitude = float(np.ptp(driven))
    rows = _with_ends(driven, _reversals(driven, max(8.0 * noise, 0.05 * amplitude)), max(8.0 * noise, 0.005 * amplitude))
    if amplitude <= 10.0 * noise:
        raise input_error(f"{loop.name}: the driven column changes by less than ten times its noise")
    ends = [0, *rows, driven.size - 1]
    branch = np.searchsorted(np.array(rows), np.arange(driven.size), side="left")
    extremes = [_level(driven, ends, number, noise) for number in range(1, len(ends))]
    if loop.cycles_before > 0:
        extremes.insert(0, _level(driven, ends, 0, noise))
    levels: list[list[tuple[float, float]]] = []
    index = []
    for value, error in extremes:
        near = [n for n, level in enumerate(levels) if abs(level[0][0] - value) <= max(4.0 * noise, 1e-9 * amplitude)]
        if not near:
            levels.append([])
        index.append(near[0] if near else len(levels) - 1)
        levels[index[-1]].append((value, error))
    errors = np.array([1.0 / math.sqrt(sum(1.0 / error**2 for _, error in level)) if noise else 0.0 for level in levels])
    weights = [[1.0 / error**2 if noise else 1.0 for _, error in level] for level in levels]
    means = np.array([np.average([value for value, _ in level], weights=weight) for level, weight in zip(levels, weights)])
    before: list[int] = []
    if loop.cycles_before > 0:
        first = index.pop(0)
        upper, lower = int(np.argmax(means)), int(np.argmin(means))
        rises = means[index[0]] > means[first]
        before = [upper, lower] * loop.cycles_before if rises else [lower, upper] * loop.cycles_before
    return Path(means, errors, index, before, branch)


def _level(driven: Array, ends: list[int], number: int, noise: float) -> tuple[float, float]:
    """The value of the driven column at an end of a branch, and its standard error.

    The maximum of noisy rows is biased outwards. Instead, a corner, value + c1 |row - end| + c2 (row - end)^2, and a smooth
    maximum, value + c2 (row - end)^2 + c4 (row - end)^4, are fitted to a third of the branches on either side; the better one counts.
    """
    row = ends[number]
    if noise == 0.0:
        return float(driven[row]), 0.0
    reach = [max(3, (ends[n + 1] - ends[n]) // 3) for n in range(max(number - 1, 0), min(number + 1, len(ends) - 1))]
    reach = [0, *reach] if number == 0 else [*reach, 0] if number == len(ends) - 1 else reach
    window = np.arange(max(row - reach[0], 0), min(row + reach[1] + 1, driven.size))
    if window.size < 6:
        return float(driven[row]), noise
    best = (math.inf, 0.0, 0.0)
    shifts = (0.0,) if 0 in reach else np.linspace(-0.25, 0.25, 21) * max(min(reach), 4)
    for shift in shifts:
        distance = np.abs(window - row - shift) / window.size
        for powers in ((1, 2), (2, 4)):
            basis = np.stack([np.ones(window.size), *(distance**power for power in powers)], axis=1)
            coefficients = np.linalg.lstsq(basis, driven[window], rcond=None)[0]
            error = noise * math.sqrt(np.linalg.inv(basis.T @ basis)[0, 0])
            misfit = float(np.sum((driven[window] - basis @ coefficients) ** 2))
            best = min(best, (misfit, float(coefficients[0]), error))
    return best[1], best[2]
