"""The driven column of a record as a path between turning points: when they are, how high, and the rows between them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.polynomial import Chebyshev
from numpy.typing import NDArray

from ..errors import input_error
from .columns import estimated_noise, grid_step, robust_deviation, scatter_in_the_plane, spikes_of

if TYPE_CHECKING:
    from .loop import Loop

Array = NDArray[np.float64]

#: The driven column is no smooth function of the row number if its residuals are correlated by more than this from row to row, and
#: larger than this part of its range: the rows are then no measure of time.
_CORRELATED, _LARGE = 0.4, 0.002

#: Degrees of the polynomials over the time of a branch, and the rows that a branch needs for one.
_DEGREES, _ENOUGH = (1, 3, 5, 7), 16

#: Largest degree of the polynomial about a turning point of a smooth column.
_SMOOTH = 8

#: Standard errors of extremes grow by this factor as the time of the turn and its shape are chosen by the fit (120 synthetic loops).
SEARCHED = 1.2

#: Rows that each side of a corner needs for numbers of its own.
BOTH_SIDES = 8

#: Part of the range near an extreme whose rows determine it if their times are unknown.
_NEAR = 0.15


@dataclass
class Path:
    """The driven column as a path between levels.

    `levels`: distinct values of extremes, with `errors`, their standard errors, and `level_times`, the mean time at which each is
    reached [cycles]; `turns`: index of the level at the end of every branch, the last branch included; `before`: levels passed
    before the first row. `time`: of every row [cycles], 0 in the middle of the record; `sampling`: what it is made from;
    `turn_times`: ends of the branches but the last. `noise`: of the force and of the shift. `is_spike`: rows that are not used.
    """

    levels: Array
    errors: Array
    level_times: Array
    turns: list[int]
    before: list[int]
    time: Array
    sampling: Literal["time", "rows", "arc length"]
    turn_times: Array
    noise: tuple[float, float]
    is_spike: NDArray[np.bool_]
    warnings: list[str]
    _pieces: list[Chebyshev]
    _exact: Array | None

    @property
    def branch(self) -> NDArray[np.int64]:
        """Of every row, from 0."""
        return np.searchsorted(self.turn_times, self.time, side="left")

    def displaced(self, delay: float) -> tuple[Array, NDArray[np.int64]]:
        """How much the driven column changes from every row until a `delay` [cycles] later, and the branch at which it is then."""
        if delay == 0.0:
            return np.zeros(self.time.size), self.branch
        later = self.time + delay
        branch = np.searchsorted(self.turn_times, later, side="left")
        return self._smooth(later, branch) - self._smooth(self.time, self.branch), branch

    def _smooth(self, time: Array, branch: NDArray[np.int64]) -> Array:
        """The driven column without noise."""
        if self._exact is not None:
            inside = np.interp(time, self.time, self._exact)
            ends = ((0, 1), (-1, -2))
            for (end, next_), beyond in zip(ends, (time < self.time[0], time > self.time[-1])):
                slope = (self._exact[end] - self._exact[next_]) / (self.time[end] - self.time[next_])
                inside = np.where(beyond, self._exact[end] + slope * (time - self.time[end]), inside)
            return np.asarray(inside)
        result = np.empty(time.size)
        for number, piece in enumerate(self._pieces):
            rows = branch == number
            result[rows] = piece(time[rows])
        return result


def path_of(loop: Loop) -> Path:
    """The path of the driven column of a loop, with the noise of its columns where it is not given. Raises InputError."""
    is_spike, (force, shift) = spikes_of(loop)
    by_force = loop.drive == "tangential_force"
    driven = force if by_force else shift
    amplitude = float(np.ptp(driven))
    if amplitude == 0.0:
        raise input_error(f"{loop.name}: the driven column, {loop.drive}, does not change")
    columns = ((force, loop.force_noise), (shift, loop.shift_noise))
    force_noise, shift_noise = (estimated_noise(column, loop.time) if noise is None else noise for column, noise in columns)
    noise = force_noise if by_force else shift_noise
    rows = _turning_rows(driven, noise, amplitude)
    ends = [0, *rows, driven.size - 1]
    time: Array = np.arange(driven.size, dtype=float)
    sampling: Literal["time", "rows", "arc length"] = "rows"
    if loop.time is not None:
        time, sampling = loop.time, "time"
    elif _is_uneven(driven, ends, amplitude):
        sampling = "arc length"
        relative = scatter_in_the_plane(force, shift)
        force_noise, shift_noise = (
            min(estimate, relative * float(np.ptp(column))) if given is None else given
            for (column, given), estimate in zip(columns, (force_noise, shift_noise))
        )
        noise = force_noise if by_force else shift_noise
        rows = _turning_rows(driven, noise, amplitude)
        ends = [0, *rows, driven.size - 1]
    warnings = []
    steps = [0.0 if noise == 0.0 else grid_step(column) for column, noise in columns]
    noises = []
    for name, step, estimate, (_, given) in zip(("tangential_force", "shift"), steps, (force_noise, shift_noise), columns):
        rounding = step / math.sqrt(12.0)
        noises.append(max(estimate, rounding) if given is None else math.hypot(estimate, rounding))
        if step > 0.5 * noises[-1]:
            warnings.append(
                f"{loop.name}: the resolution of {name}, {step:.3g}, is not below its noise: rows are rounded, and their errors are not "
                "independent; use a smaller range of the converter"
            )
    noise = noises[0] if by_force else noises[1]
    if amplitude <= 10.0 * noise:
        raise input_error(f"{loop.name}: the driven column changes by less than ten times its noise")
    if is_spike.any():
        warnings.append(about_spikes(loop, is_spike))
    cycles = max(float(np.sum(np.abs(np.diff(driven[ends])))) / (2.0 * amplitude), 1e-3)
    tolerance = noise
    if sampling == "arc length":
        spacing = float(np.median(np.abs(np.diff(driven))))
        tolerance = max(noise, spacing)
        found = [(float(driven[row]), tolerance, 0.0) for row in ends]
        warnings.append(
            f"{loop.name}: the rows are unevenly spaced and have no time: turning points are known to their spacing only, "
            f"{spacing / amplitude:.1%} of the range; give the column time"
        )
    else:
        time = (time - 0.5 * (time[0] + time[-1])) * cycles / (time[-1] - time[0])
        found = [_level(driven, time, ends, number, noise) for number in range(len(ends))]
    # The place at which the first loading begins is no target.
    groups, index = _grouped(found if loop.cycles_before > 0 else found[1:], tolerance, amplitude)
    levels, errors, middles = _averages(groups, noise)
    turns = index[1:] if loop.cycles_before > 0 else index
    exact, pieces = None, []
    if sampling == "arc length":
        levels, errors = _bounded(levels, errors, driven, noise)
        along = np.array([levels[index[0]] if loop.cycles_before > 0 else driven[0], *levels[turns]])
        reached = np.append(0.0, np.cumsum(np.abs(np.diff(along)))) / (2.0 * amplitude)
        reached -= 0.5 * reached[-1]
        slopes = 2.0 * amplitude * np.sign(np.diff(along))
        branch = np.searchsorted(np.array(ends[1:-1]), np.arange(driven.size), side="left")
        time = reached[branch] + (driven - along[branch]) / slopes[branch]
        turn_times = reached[1:-1]
        # A row beyond its turning point because of noise stays on its branch.
        low, high = np.append(-np.inf, turn_times + 1e-9)[branch], np.append(turn_times, np.inf)[branch]
        time = np.clip(time, low, high)
        pieces = [
            Chebyshev([level - slope * begin, slope], domain=[-1.0, 1.0]) for level, slope, begin in zip(along, slopes, reached)
        ]
        middles = np.array(
            [reached[1:][np.array(turns) == level].mean() if level in turns else 0.0 for level in range(levels.size)]
        )
    else:
        turn_times = np.array([time_ for _, _, time_ in found[1:-1]])
        if noise == 0.0:
            exact = driven
        else:
            branch = np.searchsorted(turn_times, time, side="left")
            pieces = [_piece(time[branch == number], driven[branch == number]) for number in range(len(turns))]
    before: list[int] = []
    if loop.cycles_before > 0:
        upper, lower = int(np.argmax(levels)), int(np.argmin(levels))
        rises = levels[turns[0]] > levels[index[0]]
        before = [upper, lower] * loop.cycles_before if rises else [lower, upper] * loop.cycles_before
    return Path(
        levels,
        errors,
        middles,
        turns,
        before,
        time,
        sampling,
        turn_times,
        (noises[0], noises[1]),
        is_spike,
        warnings,
        pieces,
        exact,
    )


def about_spikes(loop: Loop, is_spike: NDArray[np.bool_]) -> str:
    """The sentence about rows that are not used."""
    rows = np.flatnonzero(is_spike)
    shown = ", ".join(str(row + 1) for row in rows[:5]) + (", ..." if rows.size > 5 else "")
    return f"{loop.name}: {rows.size} spike{'s' if rows.size > 1 else ''} (row {shown}) not used; look for electrical disturbance"


def _turning_rows(driven: Array, noise: float, amplitude: float) -> list[int]:
    threshold = max(8.0 * noise, 0.05 * amplitude)
    return _with_ends(driven, _reversals(driven, threshold), max(8.0 * noise, 0.005 * amplitude))


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


def _is_uneven(driven: Array, ends: list[int], amplitude: float) -> bool:
    """Whether the driven column is no smooth function of the row number on its branches."""
    parts = []
    for first, last in zip(ends[:-1], ends[1:]):
        if last - first >= 2 * _ENOUGH:
            row = np.arange(first, last + 1, dtype=float)
            parts.append(driven[first : last + 1] - _piece(row, driven[first : last + 1])(row))
    if not parts:
        return False
    total = sum(float(part @ part) for part in parts)
    products = sum(float(part[1:] @ part[:-1]) for part in parts)
    rows = sum(part.size for part in parts)
    return products > _CORRELATED * total and total > rows * (_LARGE * amplitude) ** 2


def _piece(time: Array, driven: Array) -> Chebyshev:
    """The polynomial over the time of a branch, of the degree with the best Bayesian information criterion (Schwarz 1978)."""
    if time.size < _ENOUGH:
        return Chebyshev.fit(time, driven, min(1, time.size - 1)) if time.size > 1 else Chebyshev([driven[0] if time.size else 0.0])
    best = (math.inf, Chebyshev([0.0]))
    floor = (1e-12 * float(np.ptp(driven))) ** 2
    for degree in _DEGREES:
        piece = Chebyshev.fit(time, driven, degree)
        variance = float(np.mean((driven - piece(time)) ** 2)) + floor
        criterion = time.size * math.log(variance) + degree * math.log(time.size)
        best = min(best, (criterion, piece), key=lambda each: each[0])
    return best[1]


def _level(driven: Array, time: Array, ends: list[int], number: int, noise: float) -> tuple[float, float, float]:
    """The value of the driven column at an end of a branch, its standard error, and its time.

    The maximum of noisy rows is biased outwards. Instead, a corner, value + c1 |t - end| + c2 (t - end)^2, one with other numbers on
    either side, and a smooth maximum, value + c2 (t - end)^2 + c4 (t - end)^4, are fitted over the time t to a third of the branches
    on either side; the one with the best Bayesian information criterion counts.
    """
    row = ends[number]
    if noise == 0.0:
        return float(driven[row]), 0.0, float(time[row])
    reach = [max(3, (ends[n + 1] - ends[n]) // 3) for n in range(max(number - 1, 0), min(number + 1, len(ends) - 1))]
    reach = [0, *reach] if number == 0 else [*reach, 0] if number == len(ends) - 1 else reach
    window = np.arange(max(row - reach[0], 0), min(row + reach[1] + 1, driven.size))
    if window.size < 6:
        return float(driven[row]), noise, float(time[row])
    span = float(time[window[-1]] - time[window[0]])
    best = (math.inf, 0.0, 0.0, 0.0)
    widest = 0.0 if 0 in reach else 0.25 * max(min(reach), 4) * span / window.size
    # The second grid is between the neighbours of the best place of the first.
    for half in (widest, 0.1 * widest) if widest else (0.0,):
        middle = best[3] if half != widest else float(time[row])
        for end in middle + half * np.linspace(-1.0, 1.0, 21) if half else [middle]:
            distance = (time[window] - end) / span
            sides = (np.minimum(distance, 0.0), np.maximum(distance, 0.0))
            shapes = [[np.abs(distance), distance**2], [distance**2, distance**4]]
            shapes += [[side**power for side in sides for power in (1, 2)]] if widest and min(reach) >= BOTH_SIDES else []
            for shape in shapes:
                basis = np.stack([np.ones(window.size), *shape], axis=1)
                coefficients = np.linalg.lstsq(basis, driven[window], rcond=None)[0]
                misfit = float(np.sum((driven[window] - basis @ coefficients) ** 2)) / noise**2
                misfit += basis.shape[1] * math.log(window.size)
                # On a smooth curve two sides would meet anywhere: only a corner turns.
                is_turn = len(shape) < 4 or coefficients[1] * coefficients[3] < 0.0
                if misfit < best[0] and is_turn:
                    error = noise * math.sqrt(np.linalg.inv(basis.T @ basis)[0, 0]) * (SEARCHED if widest else 1.0)
                    best = (misfit, float(coefficients[0]), error, float(end))
    return best[1], best[2], best[3]


def smooth_extremes(column: Array, time: Array) -> list[tuple[float, float, float, float]]:
    """Values and times of the turning points inside a smooth column, without those at its ends, each with its standard error: value,
    error, time, error."""
    noise = estimated_noise(column, time)
    if np.ptp(np.diff(time)) < 1e-3 * float(np.median(np.diff(time))):
        # Few rows a period: fourth differences contain less of the motion.
        noise = min(noise, robust_deviation(np.diff(column, 4)) / math.sqrt(70.0))
    rows = _reversals(column, 8.0 * noise)
    ends = [0, *rows, column.size - 1]
    return [_smooth_extreme(column, time, ends[number - 1 : number + 2], noise) for number in range(1, len(ends) - 1)]


def _smooth_extreme(column: Array, time: Array, ends: list[int], noise: float) -> tuple[float, float, float, float]:
    """A turning point between two others, at the rows `ends`: that of a polynomial over the time of a third of the branches on either
    side, of the degree with the best Bayesian information criterion."""
    row = ends[1]
    window = np.arange(max(row - max(3, (row - ends[0]) // 3), 0), min(row + max(3, (ends[2] - row) // 3) + 1, column.size))
    span = float(time[window[-1]] - time[window[0]])
    at = (time[window] - time[row]) / span
    best = (math.inf, float(column[row]), noise, float(time[row]), span / window.size)
    floor = (1e-12 * float(np.ptp(column[window]))) ** 2
    for degree in range(2, min(_SMOOTH, window.size - 2) + 1):
        basis = np.vander(at, degree + 1)
        coefficients = np.linalg.lstsq(basis, column[window], rcond=None)[0]
        variance = float(np.mean((column[window] - basis @ coefficients) ** 2)) + floor
        criterion = window.size * math.log(variance) + degree * math.log(window.size)
        slope = np.polyder(coefficients)
        turns = [float(root.real) for root in np.roots(slope) if abs(root.imag) < 1e-9 and at[0] <= root.real <= at[-1]]
        if criterion >= best[0] or not turns:
            continue
        turn = min(turns, key=abs)
        powers = turn ** np.arange(degree, -1.0, -1.0)
        changes = np.append(np.polyder(np.ones(degree + 1)) * powers[1:], 0.0)
        inverse = (SEARCHED * noise) ** 2 * np.linalg.pinv(basis.T @ basis)
        value_error, slope_error = (math.sqrt(float(each @ inverse @ each)) for each in (powers, changes))
        bend = abs(float(np.polyval(np.polyder(slope), turn)))
        if bend > 0.0:
            value = float(np.polyval(coefficients, turn))
            best = (criterion, value, value_error, float(time[row]) + span * turn, span * slope_error / bend)
    return best[1:]


def _grouped(
    found: list[tuple[float, float, float]], noise: float, amplitude: float
) -> tuple[list[list[tuple[float, float, float]]], list[int]]:
    """Extremes that are equal up to noise, and of every extreme the number of its group."""
    groups: list[list[tuple[float, float, float]]] = []
    index = []
    for extreme in found:
        near = [n for n, group in enumerate(groups) if abs(group[0][0] - extreme[0]) <= max(4.0 * noise, 1e-9 * amplitude)]
        if not near:
            groups.append([])
        index.append(near[0] if near else len(groups) - 1)
        groups[index[-1]].append(extreme)
    return groups, index


def _averages(groups: list[list[tuple[float, float, float]]], noise: float) -> tuple[Array, Array, Array]:
    """Weighted means of groups of extremes, their standard errors, and their mean times."""
    weights = [[1.0 / error**2 if noise else 1.0 for _, error, _ in group] for group in groups]
    means, times = (
        np.array([np.average([extreme[place] for extreme in group], weights=weight) for group, weight in zip(groups, weights)])
        for place in (0, 2)
    )
    errors = np.array([1.0 / math.sqrt(sum(weight)) if noise else 0.0 for weight in weights])
    return means, errors, times


def _bounded(means: Array, errors: Array, driven: Array, noise: float) -> tuple[Array, Array]:
    """Upper and lower extreme of rows at unknown times, with standard errors, from their posterior distribution.

    Rows near an extreme L are a Poisson process of a constant density d along the path with normal errors, so that the logarithm of
    the likelihood is the sum of ln Phi((L - x)/noise) over the rows minus d L.
    """
    normal = np.frompyfunc(lambda z: 0.5 * math.erfc(-z / math.sqrt(2.0)), 1, 1)
    means, errors = means.copy(), errors.copy()
    amplitude = float(np.ptp(driven))
    for level, sign in ((int(np.argmax(means)), 1.0), (int(np.argmin(means)), -1.0)):
        column = sign * driven
        top = float(column.max())
        near = column[column > top - _NEAR * amplitude]
        density = near.size / (_NEAR * amplitude)
        width = max(noise, 1e-6 * amplitude)
        grid = np.linspace(top - 5.0 * width, top + 5.0 * width + 8.0 / density, 400)
        chance = np.maximum(normal((grid[:, None] - near) / width).astype(float), 1e-300)
        logarithm = np.sum(np.log(chance), axis=1) - density * grid
        weight = np.exp(logarithm - logarithm.max())
        mean = float(np.average(grid, weights=weight))
        means[level], errors[level] = sign * mean, math.sqrt(float(np.average((grid - mean) ** 2, weights=weight)))
    return means, errors
