"""Initiation lives: strain-life curves of Coffin, Manson and Basquin, their inversion, and rainflow counting with Miner's rule."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Callable, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._packages import needed
from .stress_cycle import StressCycle

Array = NDArray[np.float64]

#: A curve of a material: the value of a parameter at which it fails after N cycles.
Curve = Callable[[Any], Any]

#: Longest life that is computed; beyond it a life is infinite.
LONGEST_LIFE = 1.0e12

#: Planes of the first search are refined if they have more than this fraction of its largest damage; angles are found to the second
#: number, in radians.
PROMISING, PLANE_TOLERANCE = 0.5, 1.0e-3

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
        """Fatemi and Socie's parameter on the plane of the largest shear strain, at 45 degrees (Socie and Marquis 2000, Multiaxial Fatigue,
        section 5.5.2)."""
        stress = self.stress_amplitude(cycles)
        elastic = (1.0 + self.poisson_ratio) * stress / self.youngs_modulus
        shear_strain = elastic + (1.0 + PLASTIC_POISSON_RATIO) * self.plastic_strain(cycles)
        return np.asarray(shear_strain * (1.0 + 0.5 * k * stress / yield_strength))

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
    """Miner's damage of one repetition of a history, whose inverse is the life in repetitions, and the plane with the most of it."""

    value: float
    angle: float


def smith_watson_topper_damage(history: StressCycle, curve: Curve, *, planes: int = 36) -> Damage:
    """Miner's damage of a history that is not a simple cycle, at one point, on the plane where it is largest.

    On a plane the normal strain is counted by `count_cycles`; each cycle has its own Smith-Watson-Topper value, with the larger of
    the normal stresses at its ends. `history`: of one point, such as of `averaged_cycle`. `curve`: as of `life`. `planes`: of the first
    search, over half a turn; scipy's `minimize_scalar` then finds the largest damage about each that has more than its neighbours.
    """
    if history.x.size != 1:
        raise ValueError(f"the damage is that of one point, not {history.x.size}")
    xx, yy, xy, zz = history.stress.reshape(-1, 4).T

    def damage(angle: float) -> float:
        c, s = np.cos(angle), np.sin(angle)
        normal = xx * c**2 + yy * s**2 + 2.0 * xy * s * c
        strain = (normal - history.poisson_ratio * (xx + yy + zz - normal)) / history.youngs_modulus
        counted = count_cycles(strain)
        largest = np.maximum(np.maximum(normal[counted.first], normal[counted.second]), 0.0)
        value = largest * 0.5 * np.abs(strain[counted.first] - strain[counted.second])
        return float(np.sum(1.0 / np.atleast_1d(life(value, curve)))) if value.size else 0.0

    angles = np.pi * (0.5 - np.arange(planes) / planes)
    values = np.array([damage(angle) for angle in angles])
    best = int(np.argmax(values))
    worst = Damage(float(values[best]), float(angles[best]) if values[best] > 0.0 else np.nan)
    minimize_scalar = needed("scipy.optimize").minimize_scalar
    is_peak = (values >= np.roll(values, 1)) & (values >= np.roll(values, -1)) & (values > PROMISING * worst.value)
    for angle in angles[is_peak]:
        ends = angle - np.pi / planes, angle + np.pi / planes
        found = minimize_scalar(lambda turn: -damage(turn), bounds=ends, method="bounded", options={"xatol": PLANE_TOLERANCE})
        if -found.fun > worst.value:
            worst = Damage(float(-found.fun), float(np.pi / 2.0 - np.mod(np.pi / 2.0 - found.x, np.pi)))
    return worst
