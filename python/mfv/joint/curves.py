"""Backbones: monotonic curves of force over displacement, and that of Cattaneo and Mindlin."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


class Curve(NamedTuple):
    """Points of a curve of first loading, from (0, 0), displacements increasing."""

    displacement: Array  #: [length]
    force: Array  #: [force/length]

    @classmethod
    def of(cls, displacement: ArrayLike, force: ArrayLike) -> Curve:
        """The curve through points, (0, 0) the first. Raises ValueError if displacements do not increase or forces fall."""
        curve = cls(np.asarray(displacement, dtype=np.float64), np.asarray(force, dtype=np.float64))
        if curve.displacement.ndim != 1 or curve.displacement.shape != curve.force.shape or curve.force.size < 2:
            raise ValueError("a curve needs two or more displacements and as many forces")
        if not (np.all(np.isfinite(curve.displacement)) and np.all(np.isfinite(curve.force))):
            raise ValueError("displacements and forces of a curve must be finite numbers")
        if curve.displacement[0] != 0.0 or curve.force[0] != 0.0:
            raise ValueError("a curve must begin at displacement 0 and force 0")
        if np.any(np.diff(curve.displacement) <= 0.0) or np.any(np.diff(curve.force) < 0.0):
            raise ValueError("displacements of a curve must increase, and forces must not decrease")
        return curve

    @property
    def stiffness(self) -> Array:
        """Slopes between the points, one fewer than points [force/length^2]."""
        return np.diff(self.force) / np.diff(self.displacement)

    def in_series(self, compliance: float) -> Curve:
        """The curve with a linear spring of a `compliance` [length^2/force] in series; a negative one is removed.

        Another datum changes the shift by such a compliance and nothing else, ln(D2/D1)/(pi m) (docs/theory.md).
        Raises ValueError if a negative compliance leaves none.
        """
        return Curve.of(self.displacement + compliance * self.force, self.force)

    def concave(self) -> Curve:
        """The least concave curve that is nowhere below: its points are some of this one's (upper convex hull).

        It is the same if the stiffness never increases. Only then a model of springs and sliders in parallel has the curve.
        """
        kept = [0]
        for point in range(1, self.force.size):
            while len(kept) > 1 and self._slope(kept[-2], kept[-1]) <= self._slope(kept[-1], point):
                kept.pop()
            kept.append(point)
        return Curve(self.displacement[kept], self.force[kept])

    def _slope(self, first: int, last: int) -> float:
        return float((self.force[last] - self.force[first]) / (self.displacement[last] - self.displacement[first]))


def mindlin_shift(force: ArrayLike, normal_force: float, half_width: float, datum: float, modulus: float, mu: float) -> Array:
    """Shift under a growing tangential `force` [force/length], cylinders pressed without friction and uncoupled.

    mu times the difference of two approaches, at P and at P - Q/mu (Ciavarella 1998, Jaeger 1998). `half_width` of the contact,
    distance of the `datum`, both lengths, contact `modulus` m [force/length^2], 1/m = sum (kappa + 1)/(4 G).
    """
    slipped = np.asarray(force, dtype=np.float64) / (mu * normal_force)
    left = 1.0 - slipped
    logarithm = np.log(np.where(left > 0.0, left, 1.0))
    linear, curved = np.log(2.0 * datum / half_width), 0.5
    return np.asarray(mu * normal_force / (np.pi * modulus) * (linear * slipped + curved * (left * logarithm + slipped)))


def mindlin_distribution(
    force: ArrayLike, normal_force: float, half_width: float, datum: float, modulus: float, mu: float
) -> tuple[Array, Array, Array]:
    """Slider distribution of the Iwan model that has the backbone of Cattaneo and Mindlin, with the `force` as parameter.

    Returns the shifts phi at these forces (those of `mindlin_shift`), the density there [force/length^3], minus the second
    derivative of the backbone, and the stiffness of all sliders that slide later than phi, which is the slope of the backbone.
    """
    left = 1.0 - np.asarray(force, dtype=np.float64) / (mu * normal_force)
    shift = mindlin_shift(force, normal_force, half_width, datum, modulus, mu)
    stiffness = np.pi * modulus / (np.log(2.0 * datum / half_width) - 0.5 * np.log(left))
    return shift, 0.5 * stiffness**3 / (np.pi * modulus * mu * normal_force * left), stiffness
