"""Short cracks: the stress intensity of an edge crack in the stresses of a contact, and whether it arrests."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..result import Result
from ..stress import beneath, slope
from .parameters import normal_stress
from .stress_cycle import stress_cycle

Array = NDArray[np.float64]

#: Points of the Gauss rule along a crack.
POINTS = 48
#: Longest crack over the thickness of the layer that it is in, for which other materials do not matter.
SHORT = 0.05

#: Weight function of an edge crack in a half-plane, a polynomial in (x/a)^2: Hartranft and Sih (1973), Mechanics of Fracture 1, 179.
HALF_PLANE = (0.2945, -0.3912, 0.7685, -0.9942, 0.5094)

#: The same for a plate of finite thickness, in powers of 1 - x/a and a/W: Fett and Munz (1997), Stress Intensity Factors and Weight
#: Functions, edge-cracked plate.
PLATE = (
    (0.4980, 2.4463, 0.0700, 1.3187, -3.067),
    (0.5416, -5.0806, 24.3447, -32.7208, 18.1214),
    (-0.19277, 2.55863, -12.6415, 19.7630, -10.986),
)


def stress_intensity(stress: Callable[[Array], ArrayLike], length: ArrayLike, *, thickness: float | None = None) -> Array:
    """Mode I stress intensity of edge cracks normal to the surface [force/length^(3/2)], shape of `length`.

    `stress(depth)`: normal stress on the plane of the crack without it [force/length^2] at depths from the surface [length], arrays of
    shape (*length.shape, points), to which its result is broadcast. `thickness` of the plate, which is free to bend; without, a half-plane. A negative
    value means that the crack is closed, at least in part. Errors of the weight functions: 0.2 % (half-plane), 2 % up to 0.6 of
    the thickness. Raises ValueError for a crack through the plate.
    """
    crack = np.asarray(length, dtype=np.float64)
    share, weights = _rule(crack, thickness)
    along = np.broadcast_to(stress(crack[..., None] * share), (*crack.shape, POINTS))
    return np.asarray(np.sqrt(np.pi * crack) * np.sum(weights * along, axis=-1))


@dataclass(frozen=True)
class EdgeCrack:
    """Cracks of several lengths at one place: `intensity` over the states of a cycle, shape (states, lengths)."""

    x: float
    length: Array
    intensity: Array

    @property
    def range(self) -> Array:
        """Range of the stress intensity over the cycle, with closed cracks as negative values."""
        return np.asarray(np.ptp(self.intensity, axis=0))

    @property
    def opening_range(self) -> Array:
        """Range of the stress intensity while the crack is open: compression counts as 0."""
        return np.asarray(np.ptp(np.maximum(self.intensity, 0.0), axis=0))

    def arrest_length(self, threshold: ArrayLike, *, opening: bool = False) -> float:
        """The smallest length at which the range is below the threshold (of `short_crack_threshold`), interpolated between lengths; NaN
        if a crack passes all of them. `opening`: the `opening_range`, for thresholds that are defined so (ASTM E647 below R = 0)."""
        excess = (self.opening_range if opening else self.range) - np.broadcast_to(threshold, self.length.shape)
        below = np.flatnonzero(excess < 0.0)
        if not below.size:
            return float("nan")
        end = int(below[0])
        if end == 0:
            return float(self.length[0])
        before, after = excess[end - 1], excess[end]
        return float(self.length[end - 1] + before / (before - after) * (self.length[end] - self.length[end - 1]))


def edge_crack(
    result: Result,
    x: float,
    length: ArrayLike,
    *,
    body: str = "lower",
    states: Sequence[int] | None = None,
    thickness: float | None = None,
) -> EdgeCrack:
    """Cracks along the inward normal of the surface at `x`, of increasing `length`, over a cycle of a result; the crack does not change the contact.

    `thickness`: as of `stress_intensity`; others and errors as of `stress_cycle`. The weight functions are those of one material: warns of
    cracks longer than a twentieth of the first layer (a plate of that thickness alone differs by 3 %, `PLATE`).
    """
    crack = np.asarray(length, dtype=np.float64)
    if crack.ndim != 1 or not crack.size or crack[0] <= 0.0 or np.any(np.diff(crack) <= 0.0):
        raise ValueError("lengths of cracks must be positive and increase")
    layer = float(result.scene.get(f"{body}_layer_1_thickness", np.inf))
    if crack[-1] > SHORT * layer:
        warnings.warn(
            f"a crack of {crack[-1]:g} is not short against the first layer of the {body} body, {layer:g}: its stress intensity is that in a body "
            "of one material",
            stacklevel=2,
        )
    share, weights = _rule(crack, thickness)
    across, up = beneath(result, body, x, crack[:, None] * share)
    history = normal_stress(stress_cycle(result, across, up, body=body, states=states), slope(result, body, x))
    return EdgeCrack(float(x), crack, np.sqrt(np.pi * crack) * np.sum(weights * history, axis=-1))


def short_crack_threshold(length: ArrayLike, threshold_range: float, a0: float) -> Array:
    """Threshold of the stress intensity range of short cracks [force/length^(3/2)]: threshold_range sqrt(a/(a + a0)).

    Kitagawa and Takahashi (1976), Int. Conf. Mech. Behav. Materials, 627; El Haddad, Smith, Topper (1979). `a0`: see
    `mfv.fatigue.critical_length`.
    """
    crack = np.asarray(length, dtype=np.float64)
    return np.asarray(threshold_range * np.sqrt(crack / (crack + a0)))


def _rule(crack: Array, thickness: float | None) -> tuple[Array, Array]:
    """Points x/a along cracks, shape (points), and weights, (*crack.shape, points), for K/sqrt(pi a)."""
    nodes, weights = np.polynomial.legendre.leggauss(POINTS)
    share, weights = 0.5 * (nodes + 1.0), 0.5 * weights
    if thickness is None:
        # x/a = sin(phi) removes the singularity 1/sqrt(1 - (x/a)^2).
        angle = 0.5 * np.pi * share
        squares = np.sin(angle) ** 2
        factor = 1.0 + (1.0 - squares) * np.polynomial.polynomial.polyval(squares, HALF_PLANE)
        return np.sin(angle), np.broadcast_to(weights * factor, (*crack.shape, POINTS))
    ratio = (crack / thickness)[..., None]
    if np.any(ratio >= 1.0):
        raise ValueError(f"a crack of {np.max(crack):g} goes through the thickness {thickness:g}")
    # 1 - x/a = t^2 removes the singularity 1/sqrt(1 - x/a).
    rest = share**2
    series = sum(rest ** (power + 1) * np.polynomial.polynomial.polyval(ratio, row) for power, row in enumerate(PLATE))
    return 1.0 - rest, np.sqrt(2.0) / np.pi * 2.0 * weights * (1.0 + series / (1.0 - ratio) ** 1.5)
