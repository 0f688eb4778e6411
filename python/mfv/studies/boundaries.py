"""Boundaries of the regimes of a map: found between neighbouring points by bracketing, joined to curves."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

#: Two points of a bracket around an estimate are this fraction of the tolerance from it; the bracket then is within the tolerance.
CLOSE = 0.9

#: Most rounds of a bracket: bisection alone needs fewer for any tolerance above round-off.
ROUNDS = 80


class Sample(NamedTuple):
    """What a case says about a boundary: a number, negative outside the regime, NaN if unknown; whether its size is
    a measure of the distance; where the boundary is expected along either axis, NaN if unknown; whether the column that decides is
    flagged."""

    value: float
    is_smooth: bool = False
    expected: tuple[float, float] = (math.nan, math.nan)
    flagged: bool = False

    @property
    def is_inside(self) -> bool:
        """Whether the case is within the regime; a known value only."""
        return self.value >= 0.0


@dataclass
class Crossing:
    """A boundary between two neighbouring points of a map, along one of its axes.

    `name`: regime on one side. `along`: number of the axis, 0 or 1. `place`: that of the point with the smaller value. `fixed`: value of
    the other axis. `lower`, `upper`: values of the axis between which the boundary is, and what the cases there say.
    """

    name: str
    along: int
    place: tuple[int, int]
    fixed: float
    lower: float
    upper: float
    at_lower: Sample
    at_upper: Sample
    rounds: int = 0
    has_failed: bool = False
    #: The best of the cases of each round: value of the axis and of the sample.
    _best: list[tuple[float, float]] = field(default_factory=list)
    _width: float = math.inf
    _size: float = 0.0

    def __post_init__(self) -> None:
        small, large = sorted((abs(self.lower), abs(self.upper)))
        self._size = small if self.lower * self.upper > 0.0 else large
        self._best = sorted(((self.lower, self.at_lower.value), (self.upper, self.at_upper.value)), key=lambda one: -abs(one[1]))

    @property
    def value(self) -> float:
        """Where the boundary is: the middle of the bracket."""
        return 0.5 * (self.lower + self.upper)

    @property
    def tolerance(self) -> float:
        """Half the width of the bracket, in the unit of the axis."""
        return 0.5 * (self.upper - self.lower)

    @property
    def is_resolved(self) -> bool:
        """Whether the column that decides is not flagged in the case within the regime."""
        return not (self.at_lower if self.at_lower.is_inside else self.at_upper).flagged

    def is_found(self, tolerance: float) -> bool:
        """Whether nothing is left to do. `tolerance`: relative to the values of the axis around."""
        return self.tolerance <= tolerance * self._size or self.has_failed or self.rounds >= ROUNDS

    def trials(self, tolerance: float) -> list[float]:
        """Values of the axis to be solved next: two close to an estimate, one on either side; the middle if there is no estimate or if the
        last one did not halve the bracket."""
        width = self.upper - self.lower
        middle = self.value
        estimate = self._estimate()
        if not self.lower < estimate < self.upper:
            return [middle]
        step = CLOSE * tolerance * self._size
        pair = [one for one in (estimate - step, estimate + step) if self.lower < one < self.upper]
        return [*pair, middle] if width > 0.5 * self._width else pair

    def narrow(self, values: Sequence[float], samples: Sequence[Sample]) -> None:
        """Take the results of the trials."""
        self.rounds += 1
        self._width = self.upper - self.lower
        for value, sample in sorted(zip(values, samples), key=lambda one: one[0]):
            if math.isnan(sample.value):
                self.has_failed = True
            elif self.lower < value < self.upper:
                if sample.is_inside == self.at_lower.is_inside:
                    self.lower, self.at_lower = value, sample
                else:
                    self.upper, self.at_upper = value, sample
                    break  # a later trial is beyond the boundary
        known = [(value, sample.value) for value, sample in zip(values, samples) if not math.isnan(sample.value)]
        if known:
            self._best = [self._best[-1], min(known, key=lambda one: abs(one[1]))]

    def _estimate(self) -> float:
        """Where the boundary is expected: as a case says, else by the secant; NaN if neither is known."""
        for sample in (self.at_lower, self.at_upper):
            if self.lower < sample.expected[self.along] < self.upper:
                return sample.expected[self.along]
        if not (self.at_lower.is_smooth and self.at_upper.is_smooth):
            return math.nan
        (x1, f1), (x2, f2) = self._best
        return x2 - f2 * (x2 - x1) / (f2 - f1) if f1 != f2 else math.nan


def crossings(name: str, axes: Sequence[Sequence[float]], samples: NDArray[Any]) -> list[Crossing]:
    """The pairs of neighbours, along either axis, of which one is within a regime. `samples`: shape of the map, of `Sample`."""
    found = []
    for along in (0, 1):
        shape = list(samples.shape)
        shape[along] -= 1
        for place in np.ndindex(*shape):
            lower = samples.item(place)
            upper = samples.item(place[0] + (along == 0), place[1] + (along == 1))
            if not math.isnan(lower.value + upper.value) and lower.is_inside != upper.is_inside:
                values = axes[along]
                start, end = values[place[along]], values[place[along] + 1]
                fixed = axes[1 - along][place[1 - along]]
                found.append(Crossing(name, along, (place[0], place[1]), fixed, start, end, lower, upper))
    return found


def refine(
    found: Sequence[Crossing],
    solve: Callable[[Sequence[tuple[float, float]], Sequence[Crossing]], Sequence[Sample]],
    tolerance: float,
    is_done: Callable[[], object] = lambda: None,
) -> None:
    """Narrow all crossings to a tolerance (see `Crossing.is_found`), or until a case fails. `solve`: the samples of a list of
    points of the map, each for its crossing. `is_done`: called for each crossing that is found."""
    left = list(found)
    while left:
        trials = [one.trials(tolerance) for one in left]
        asked = [(one, value) for one, values in zip(left, trials) for value in values]
        points = [(value, one.fixed) if one.along == 0 else (one.fixed, value) for one, value in asked]
        samples = iter(solve(points, [one for one, _ in asked]))
        for one, values in zip(left, trials):
            one.narrow(values, [next(samples) for _ in values])
            if one.is_found(tolerance):
                is_done()
        left = [one for one in left if not one.is_found(tolerance)]


class Cell(NamedTuple):
    """Four neighbouring points of a map: the part of it within a regime as a polygon, shape (n, 2), and the crossings on its sides in
    their order around the cell."""

    polygon: list[tuple[float, float]]
    crossings: list[int]


def cells(
    axes: Sequence[Sequence[float]], inside: NDArray[Any], at: dict[tuple[int, int, int], tuple[int, float]]
) -> Iterator[Cell]:
    """The cells of a map of which a part is within a regime. `inside`: shape of the map, 1 within, 0 outside, NaN unknown. `at`: number and
    value of the crossing on a side, by its axis and the place of its first point."""
    corners = ((0, 0), (1, 0), (1, 1), (0, 1))
    for i, j in np.ndindex(inside.shape[0] - 1, inside.shape[1] - 1):
        around = [inside[i + a, j + b] for a, b in corners]
        if np.isnan(around).any() or not any(around):
            continue
        polygon, numbers = [], []
        for corner, (a, b) in enumerate(corners):
            c, d = corners[(corner + 1) % 4]
            if around[corner]:
                polygon.append((axes[0][i + a], axes[1][j + b]))
            if around[corner] != around[(corner + 1) % 4]:
                along = 0 if b == d else 1
                number, value = at[along, i + min(a, c), j + min(b, d)]
                polygon.append((value, axes[1][j + b]) if along == 0 else (axes[0][i + a], value))
                numbers.append(number)
        yield Cell(polygon, numbers)


def curves(pairs: Sequence[tuple[int, int]]) -> list[list[int]]:
    """Chains of the crossings that `pairs` connect, each in the order along its curve; a closed one ends where it begins."""
    neighbours: dict[int, list[int]] = {}
    for one, other in pairs:
        neighbours.setdefault(one, []).append(other)
        neighbours.setdefault(other, []).append(one)
    found = []
    for start in sorted(neighbours, key=lambda one: len(neighbours[one])):  # ends first
        while neighbours[start]:
            chain = [start]
            while neighbours[chain[-1]]:
                following = neighbours[chain[-1]].pop(0)
                neighbours[following].remove(chain[-1])
                chain.append(following)
            found.append(chain)
    return found
