"""Backbones: curves of force over displacement under growing loads, and that of Cattaneo and Mindlin."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


class Backbone(NamedTuple):
    """A curve of first loading by its points, from (0, 0), displacements increasing."""

    displacement: Array  #: [length]
    force: Array  #: [force/length]
    doubt: str = ""  #: why models of this curve are wrong, if `measure` found that; fits refuse it

    def trusted(self) -> Backbone:
        """The backbone, if nothing is known against models of it. Raises ValueError."""
        if self.doubt:
            raise ValueError(self.doubt)
        return self

    @classmethod
    def of(cls, displacement: ArrayLike, force: ArrayLike) -> Backbone:
        """The backbone through points, (0, 0) the first. Raises ValueError if displacements do not increase or forces fall."""
        backbone = cls(np.asarray(displacement, dtype=np.float64), np.asarray(force, dtype=np.float64))
        if backbone.displacement.ndim != 1 or backbone.displacement.shape != backbone.force.shape or backbone.force.size < 2:
            raise ValueError("a backbone needs two or more displacements and as many forces")
        if not (np.all(np.isfinite(backbone.displacement)) and np.all(np.isfinite(backbone.force))):
            raise ValueError("displacements and forces of a backbone must be finite numbers")
        if backbone.displacement[0] != 0.0 or backbone.force[0] != 0.0:
            raise ValueError("a backbone must begin at displacement 0 and force 0")
        if np.any(np.diff(backbone.displacement) <= 0.0) or np.any(np.diff(backbone.force) < 0.0):
            raise ValueError("displacements of a backbone must increase, and forces must not decrease")
        return backbone

    @property
    def stiffness(self) -> Array:
        """Slopes between the points, one fewer than points [force/length^2]."""
        return np.diff(self.force) / np.diff(self.displacement)

    def in_series(self, compliance: float) -> Backbone:
        """The backbone with a linear spring of a `compliance` [length^2/force] in series; a negative one is removed.

        Another datum changes the shift by such a compliance and nothing else, ln(D2/D1)/(pi m) (docs/theory.md).
        Raises ValueError if a negative compliance leaves none.
        """
        return Backbone.of(self.displacement + compliance * self.force, self.force)._replace(doubt=self.doubt)

    def concave(self) -> Backbone:
        """The least concave backbone that is nowhere below: its points are some of this one's (upper convex hull).

        It is the same if the stiffness never increases. Only then a model of springs and sliders in parallel has the backbone.
        """
        kept = [0]
        for point in range(1, self.force.size):
            while len(kept) > 1 and self._slope(kept[-2], kept[-1]) <= self._slope(kept[-1], point):
                kept.pop()
            kept.append(point)
        return Backbone(self.displacement[kept], self.force[kept], self.doubt)

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
