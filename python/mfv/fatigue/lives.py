"""Initiation lives: strain-life curves of Coffin, Manson and Basquin, their inversion, and rainflow counting with Miner's rule."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Callable, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._packages import needed
from .parameters import MARGIN, in_range, normal_strain, on_planes
from .stress_cycle import StressCycle

Array = NDArray[np.float64]

#: A curve of a material: the value of a parameter at which it fails after N cycles.
Curve = Callable[[Any], Any]

#: Longest life that is computed; beyond it a life is infinite.
LONGEST_LIFE = 1.0e12

#: Planes of the first search: angles over half a turn, and tilts over a quarter.
ANGLES, TILTS = 36, 7

#: The number of planes that are refined, with more than this fraction of the largest damage, at this distance from each other [radians].
REFINED, PROMISING, APART = 3, 0.5, 0.2

#: Angles are found to this [radians].
PLANE_TOLERANCE = 1.0e-4

#: Points of a curve, in place of its inverse, in the search for the plane.
TABULATED = 241

#: Plastic strains do not change the volume.
PLASTIC_POISSON_RATIO = 0.5


@dataclass(frozen=True)
class StrainLife:
    """Strain-life curve of fully reversed tension and compression: strain amplitude = strength/E (2N)^strength_exponent +
    ductility (2N)^ductility_exponent, N in cycles (Basquin; Coffin and Manson). Both exponents are negative.

    Its other methods give a fatigue parameter of this test, a function of N that decreases; its inverse is the life of any point with that
    value. `youngs_modulus`, `strength`: force/length^2.
    """

    youngs_modulus: float
    strength: float
    strength_exponent: float
    ductility: float
    ductility_exponent: float
    poisson_ratio: float = 0.3

    def stress_amplitude(self, cycles: ArrayLike) -> Array:
        """Basquin's part, strength (2N)^strength_exponent [force/length^2]."""
        return np.asarray(self.strength * (2.0 * np.asarray(cycles)) ** self.strength_exponent)

    def plastic_strain(self, cycles: ArrayLike) -> Array:
        """Coffin and Manson's part, ductility (2N)^ductility_exponent."""
        return np.asarray(self.ductility * (2.0 * np.asarray(cycles)) ** self.ductility_exponent)

    def strain_amplitude(self, cycles: ArrayLike) -> Array:
        """Strain amplitude."""
        return np.asarray(self.stress_amplitude(cycles) / self.youngs_modulus + self.plastic_strain(cycles))

    def smith_watson_topper(self, cycles: ArrayLike) -> Array:
        """(Largest stress) * (strain amplitude) [force/length^2]."""
        return np.asarray(self.stress_amplitude(cycles) * self.strain_amplitude(cycles))

    def fatemi_socie(self, cycles: ArrayLike, *, yield_strength: float, k: float = 1.0) -> Array:
        """Fatemi and Socie's parameter on the plane where it is largest, as `mfv.fatigue.fatemi_socie` has it.

        On a plane whose normal is at the angle a to the load, the shear strain amplitude is sin(2a) of that at 45 degrees and the largest
        normal stress s cos(a)^2: gamma sin(2a) (1 + c + c cos(2a)) with c = k s/(2 yield_strength) is largest at cos(2a) = 2 c/(1 + c +
        sqrt((1 + c)^2 + 8 c^2)). Curves in books (Socie and Marquis 2000, section 5.5.2) are those of the plane at 45 degrees, cos(2a) = 0.
        """
        stress = self.stress_amplitude(cycles)
        elastic = (1.0 + self.poisson_ratio) * stress / self.youngs_modulus
        shear_strain = elastic + (1.0 + PLASTIC_POISSON_RATIO) * self.plastic_strain(cycles)
        c = 0.5 * k * stress / yield_strength
        cosine = 2.0 * c / (1.0 + c + np.sqrt((1.0 + c) ** 2 + 8.0 * c**2))
        return np.asarray(shear_strain * np.sqrt(1.0 - cosine**2) * (1.0 + c + c * cosine))

    def findley(self, cycles: ArrayLike, *, k: float) -> Array:
        """Findley's parameter of Basquin's stress amplitude [force/length^2]."""
        return np.asarray(0.5 * (k + np.sqrt(1.0 + k**2)) * self.stress_amplitude(cycles))

    def crossland(self, cycles: ArrayLike, *, k: float) -> Array:
        """Crossland's parameter of Basquin's stress amplitude [force/length^2]."""
        return np.asarray((1.0 / np.sqrt(3.0) + k / 3.0) * self.stress_amplitude(cycles))

    def dang_van(self, cycles: ArrayLike, *, k: float) -> Array:
        """Dang Van's parameter of Basquin's stress amplitude [force/length^2]."""
        return np.asarray((0.5 + k / 3.0) * self.stress_amplitude(cycles))


def life(value: ArrayLike, curve: Curve) -> Any:
    """Cycles N at which `curve(N)`, which must decrease, has these values: an array, or a number for a number.

    Infinite beyond 1e12 cycles, 0.5 (one reversal) for values that are larger than the curve there; NaN for NaN. Needs scipy, whose
    `brentq` finds log N in this bracket. Example: `life(peak.value, material.smith_watson_topper)`.
    """
    brentq = needed("scipy.optimize").brentq
    ends = np.log(0.5), np.log(LONGEST_LIFE)
    largest, smallest = (float(curve(np.exp(end))) for end in ends)
    if not largest > smallest > 0.0:
        raise ValueError(
            f"the curve must be positive and decrease with the number of cycles, but it has {largest:g} and {smallest:g} at the ends"
        )

    def single(wanted: float) -> float:
        if np.isnan(wanted):
            return np.nan
        if wanted <= smallest:
            return np.inf
        if wanted >= largest:
            return 0.5
        # Relative differences of logarithms: values of curves extend over many orders of magnitude.
        return float(np.exp(brentq(lambda log: np.log(float(curve(np.exp(log))) / wanted), *ends, xtol=1.0e-12)))

    values = np.asarray(value, dtype=np.float64)
    lives = np.array([single(wanted) for wanted in values.ravel()]).reshape(values.shape)
    return float(lives) if values.ndim == 0 else lives


class Counted(NamedTuple):
    """The cycles of a history, by indices of its values: each goes from `first` to `second` and back."""

    first: NDArray[np.int64]
    second: NDArray[np.int64]


def count_cycles(history: ArrayLike) -> Counted:
    """The closed cycles of a history that is repeated, by rainflow counting (pyLife's four-point method, after ASTM E1049).

    The history is counted from its largest value, so that nothing remains open. No cycles if it is constant. Needs pyLife.
    """
    values = np.asarray(history, dtype=np.float64)
    if values.ndim != 1 or not np.isfinite(values).all():
        raise ValueError("a history must be a sequence of numbers")
    if np.ptp(values) == 0.0:
        return Counted(np.empty(0, dtype=np.int64), np.empty(0, dtype=np.int64))
    rainflow = needed("pylife.stress.rainflow")
    start = int(np.argmax(values))
    order = np.append(np.roll(np.arange(values.size), -start), start)
    recorder = rainflow.FullRecorder()
    detector = rainflow.FourPointDetector(recorder=recorder).process(values[order], flush=True)
    left = detector.residual_index[:-1]
    first, second = ([*recorder.index_from, left[0]], [*recorder.index_to, left[1]])
    return Counted(order[np.array(first, dtype=np.int64)], order[np.array(second, dtype=np.int64)])


class Damage(NamedTuple):
    """Miner's damage of one repetition of a history, whose inverse is the life in repetitions, and angle and tilt (as of ParameterMap) of the
    plane with the most of it; NaN without damage."""

    value: float
    angle: float
    tilt: float


def smith_watson_topper_damage(history: StressCycle, curve: Curve) -> Damage:
    """Miner's damage of a history that is not a simple cycle, at one point, on the plane where it is largest.

    On a plane the normal strain is counted by `count_cycles`; each cycle has its own parameter, with the largest normal stress from its
    beginning until it is closed. `history`: of one point, such as of `averaged_cycle`. `curve`: as of `life`. Planes in all directions are
    searched, first 5 degrees apart; scipy refines the best. Raises ValueError for several points.
    """

    def counted(normal: Array, _shear: Array) -> Array:
        return np.asarray(normal_strain(history, normal)[None])

    return _largest_damage(history, counted, lambda amplitude, tension: np.maximum(tension, 0.0) * amplitude, curve)


def fatemi_socie_damage(history: StressCycle, curve: Curve, *, yield_strength: float, k: float = 1.0) -> Damage:
    """Miner's damage by Fatemi and Socie's parameter, as `smith_watson_topper_damage`: on a plane the shear strain along a direction is
    counted, and planes and directions are searched (Bannantine and Socie 1991, ASTM STP 1122, 249)."""

    def value(amplitude: Array, tension: Array) -> Array:
        return np.asarray(amplitude / history.shear_modulus * (1.0 + k * np.maximum(tension, 0.0) / yield_strength))

    return _largest_damage(history, lambda _normal, shear: shear, value, curve)


def findley_damage(history: StressCycle, curve: Curve, *, k: float) -> Damage:
    """Miner's damage by Findley's parameter, as `fatemi_socie_damage`: the shear stress along a direction is counted."""
    return _largest_damage(history, lambda _normal, shear: shear, lambda amplitude, tension: amplitude + k * tension, curve)


def _largest_damage(
    history: StressCycle,
    counted: Callable[[Array, Array], Array],
    value: Callable[[Array, Array], Array],
    curve: Curve,
) -> Damage:
    """Damage on the plane, and along the direction on it, where it is largest.

    `counted`: the counted quantity, shape (1 or 2 components, states), of normal and shear stress on a plane. `value`: the parameter of
    cycles with this amplitude of it and this largest normal stress.
    """
    if history.x.size != 1:
        raise ValueError(f"the damage is that of one point, not {history.x.size}")
    single = replace(history, x=np.zeros(()), y=np.zeros(()), stress=history.stress.reshape(-1, 4))
    is_vector = len(counted(*on_planes(single, np.zeros(()), np.zeros(())))) > 1
    rate = _tabulated(curve)

    def cycles(plane: Array) -> Array:
        """The parameter of every cycle on a plane: angle, tilt, and direction on it."""
        normal, shear = on_planes(single, plane[0], plane[1])
        along = counted(normal, shear)
        loads = along[0] * np.cos(plane[2]) + along[1] * np.sin(plane[2]) if is_vector else along[0]
        found = count_cycles(loads)
        amplitude = 0.5 * np.abs(loads[found.first] - loads[found.second])
        return np.asarray(value(amplitude, _largest_during(found, loads, normal)))

    def negative(plane: Array) -> float:
        return -float(np.sum(rate(cycles(plane))))

    planes = []
    for angle in np.pi * (0.5 - np.arange(ANGLES) / ANGLES):
        for tilt in 0.5 * np.pi * np.arange(TILTS) / (TILTS - 1):
            along = counted(*on_planes(single, np.asarray(angle), np.asarray(tilt)))
            planes.append(np.array([angle, tilt, _longest(along)]))
    damages = np.array([-negative(plane) for plane in planes])
    minimize = needed("scipy.optimize").minimize
    best, most = planes[0], 0.0
    for start in _apart(planes, damages):
        # Perpendicular planes are refined among themselves first, since a tilt of 0 is an end of its range.
        for free in ([0], [0, 1, 2] if is_vector else [0, 1]):
            plane = start.copy()

            def part(values: Array, plane: Array = plane, free: list[int] = free) -> float:
                plane[free] = values
                return negative(plane)

            simplex = np.vstack([start[free], start[free] + 0.05 * np.eye(len(free))])
            options = {"xatol": PLANE_TOLERANCE, "fatol": 0.0, "initial_simplex": simplex}
            found = minimize(part, start[free], method="Nelder-Mead", options=options)
            if -found.fun > most * (1.0 + MARGIN):
                plane[free] = found.x
                best, most = plane.copy(), float(-found.fun)
    if most == 0.0:
        return Damage(0.0, np.nan, np.nan)
    values = cycles(best)
    angle, tilt = in_range(best[0], best[1])
    return Damage(float(np.sum(1.0 / np.atleast_1d(life(values, curve)))), float(angle), float(tilt))


def _apart(planes: list[Array], damages: Array) -> list[Array]:
    """The planes with the largest damage, at some distance from each other."""
    chosen: list[Array] = []
    normals: list[Array] = []
    for place in np.argsort(-damages, kind="stable"):
        if len(chosen) == REFINED or damages[place] <= PROMISING * damages.max():
            break
        angle, tilt, _ = planes[place]
        normal = np.array([np.cos(tilt) * np.cos(angle), np.cos(tilt) * np.sin(angle), np.sin(tilt)])
        if all(abs(float(normal @ other)) < np.cos(APART) for other in normals):
            chosen.append(planes[place])
            normals.append(normal)
    return chosen


def _longest(path: Array) -> float:
    """The direction of the longest chord of a path, shape (1 or 2, states)."""
    if len(path) == 1:
        return 0.0
    chords = path[:, :, None] - path[:, None, :]
    first, second = np.unravel_index(np.argmax(np.sum(chords**2, axis=0)), chords.shape[1:])
    return float(np.arctan2(chords[1, first, second], chords[0, first, second]))


def _largest_during(cycles: Counted, loads: Array, normal: Array) -> Array:
    """The largest normal stress during every cycle of a repeated history: from its beginning, at `first`, until `loads` return there,
    linear between states."""
    start, states = int(np.argmax(loads)), loads.size
    order = np.append(np.roll(np.arange(states), -start), start)
    place = np.empty(states, dtype=int)
    place[order[:-1]] = np.arange(states)
    along, stress = loads[order], normal[order]
    largest = np.empty(cycles.first.size)
    for number, (first, second) in enumerate(zip(cycles.first, cycles.second)):
        begin, turn = place[first], place[second]
        side = np.sign(along[turn] - along[begin])
        # The history ends where it begins, at its largest value, so every cycle is closed.
        end = turn + 1 + int(np.argmax(side * (along[turn + 1 :] - along[begin]) <= 0.0))
        share = (along[begin] - along[end - 1]) / (along[end] - along[end - 1])
        closed = stress[end - 1] + share * (stress[end] - stress[end - 1])
        largest[number] = max(float(np.max(stress[begin:end])), float(closed))
    return largest


def _tabulated(curve: Curve) -> Callable[[Array], Array]:
    """Damage of cycles with some values of a parameter, from a table of the curve: fast enough for a search."""
    cycles = np.geomspace(0.5, LONGEST_LIFE, TABULATED)
    values = np.array([float(curve(one)) for one in cycles])
    if not (values > 0.0).all() or not (np.diff(values) < 0.0).all():
        life(1.0, curve)  # raises ValueError with its reason
        raise ValueError("the curve must decrease with the number of cycles everywhere")

    def rate(wanted: Array) -> Array:
        is_counted = wanted > values[-1]
        logs = np.interp(np.log(np.where(is_counted, wanted, values[-1])), np.log(values[::-1]), np.log(cycles[::-1]))
        return np.where(is_counted, np.exp(-logs), 0.0)

    return rate
