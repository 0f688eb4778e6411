"""Critical distances: stresses averaged at a point, along a line or over an area below a hot spot, and the length that belongs to them.

Taylor (1999), Int. J. Fatigue 21, 413: the point at L/2, the line of length 2L, the half disk of radius L.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ..result import Result
from ..stress import beneath, radius_of
from .stress_cycle import StressCycle, stress_cycle

Array = NDArray[np.float64]

#: Points of the Gauss rule along a line, and across the half disk.
ALONG, AROUND = 32, 24


def critical_length(threshold_range: float, fatigue_limit_range: float, *, geometry_factor: float = 1.0) -> float:
    """(threshold_range/(geometry_factor fatigue_limit_range))^2/pi [length], both at the same load ratio.

    With a factor of 1 the critical distance of Taylor (1999); El Haddad's a0 with that of the crack, 1.1215 for an edge crack (El Haddad,
    Smith, Topper 1979, ASME J. Engineering Materials 101, 42). `threshold_range`: of the stress intensity of long cracks
    [force/length^(3/2)]; `fatigue_limit_range`: twice the amplitude [force/length^2].
    """
    return float((threshold_range / (geometry_factor * fatigue_limit_range)) ** 2 / np.pi)


def averaged_cycle(
    result: Result,
    x: float,
    length: float,
    *,
    method: Literal["point", "line", "area"] = "line",
    angle: float = 0.0,
    body: str = "lower",
    states: Sequence[int] | None = None,
) -> StressCycle:
    """Stresses over a cycle, averaged below the surface point at `x`: a StressCycle of one point, for the functions of parameters.

    `length`: the critical distance L [length]. `method`: 'point' at L/2, 'line' from the surface to 2L, 'area' of the half disk with the
    radius L below the tangent of the surface, as far as it is in the body. `angle`: of the line or to the point from the inward normal,
    in radians, counterclockwise. Others and errors as of `stress_cycle`; ValueError for an unknown method.
    """
    if method == "point":
        distance, direction, weights = np.array([0.5 * length]), np.array([angle]), np.ones(1)
    elif method == "line":
        share, weights = _rule(0.0, 1.0, ALONG)
        distance, direction, weights = 2.0 * length * share**2, np.full(ALONG, angle), 2.0 * share * weights
    elif method == "area":
        share, weight = _rule(0.0, 1.0, ALONG)
        turn, turn_weight = _rule(-0.5 * np.pi, 0.5 * np.pi, AROUND)
        direction = np.repeat(turn, ALONG)
        reach = np.full(AROUND, length)
        radius = radius_of(result, body)
        if radius is not None and result.attributes[f"{body}_body"].endswith("disk"):
            reach = np.minimum(reach, 2.0 * radius * np.cos(turn))
        distance = np.outer(reach, share**2).ravel()
        weights = np.outer(turn_weight * reach**2, 4.0 * share**3 * weight).ravel()
        weights /= np.sum(weights)
    else:
        raise ValueError(f"method must be 'point', 'line' or 'area', not '{method}'")
    across, up = beneath(result, body, x, distance, direction)
    return stress_cycle(result, across, up, body=body, states=states).average(weights)


def _rule(start: float, end: float, points: int) -> tuple[Array, Array]:
    """Gauss points and weights of an interval."""
    nodes, weights = np.polynomial.legendre.leggauss(points)
    return start + 0.5 * (end - start) * (nodes + 1.0), 0.5 * (end - start) * weights
