"""Steady rolling of two elastic cylinders, independently of the library: the tractions travel with the contact (Kalker 1971).

Half-planes of contact modulus `modulus` (1/E* = (1-nu1^2)/E1 + (1-nu2^2)/E2) and Dundurs' `beta` (positive where the lower body couples
more), relative curvature `curvature`. The contact moves to the right. Piecewise constant tractions on equal intervals that move along;
a particle now at x_i was at x_(i+1) one interval earlier: it sticks where u(x_i) - u(x_(i+1)) is the sliding of the bodies over one
interval, else |q| = mu p against the slip. Contact, stick and slip are found by active sets.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray


class Rolling(NamedTuple):
    """Limit of steady rolling: creepage; parts of the contact that stick; half-width; positions and tractions."""

    creepage: float
    stick_ratio: float
    half_width: float
    x: NDArray[np.float64]
    pressure: NDArray[np.float64]
    shear: NDArray[np.float64]


def steady_rolling(
    modulus: float, beta: float, curvature: float, mu: float, normal_force: float, tangential_force: float, intervals: int = 201
) -> Rolling:
    """Steady rolling to the right; raises RuntimeError if the active sets do not converge."""
    half = 1.25 * np.sqrt(4.0 * normal_force / (np.pi * modulus * curvature))
    step = 2.0 * half / intervals
    x = (np.arange(intervals) + 0.5) * step - half
    distance = x[:, None] - x[None, :]
    box = 0.5 * step
    ends = [(distance + side * box) * np.log(np.abs(distance + side * box)) for side in (1, -1)]
    own = -2.0 / (np.pi * modulus) * (ends[0] - ends[1] - 2.0 * box)  # w by p, u by q
    other = 2.0 * beta / modulus * np.clip(distance, -box, box)  # w by q; u by p: minus this
    own_slip, other_slip = (kernel - np.roll(kernel, -1, axis=0) for kernel in (own, -other))
    gap = 0.5 * curvature * x**2
    contact = np.abs(x) < half / 1.25
    stick, way = contact.copy(), np.zeros(intervals)
    for _ in range(100):
        at = np.flatnonzero(contact)
        n = len(at)
        matrix = np.zeros((2 * n + 2, 2 * n + 2))
        right = np.zeros(2 * n + 2)
        matrix[:n, :n], matrix[:n, n : 2 * n], matrix[:n, 2 * n] = own[np.ix_(at, at)], other[np.ix_(at, at)], -1.0
        right[:n] = -gap[at]
        for row, i in enumerate(at, start=n):
            if stick[i]:
                matrix[row, :n], matrix[row, n : 2 * n], matrix[row, 2 * n + 1] = other_slip[i, at], own_slip[i, at], -step
            else:
                matrix[row, row], matrix[row, row - n] = 1.0, mu * way[i]
        matrix[2 * n, :n] = matrix[2 * n + 1, n : 2 * n] = step
        right[2 * n :] = normal_force, tangential_force
        solution = np.linalg.solve(matrix, right)
        pressure, shear = np.zeros(intervals), np.zeros(intervals)
        pressure[at], shear[at] = solution[:n], solution[n : 2 * n]
        approach, creepage = solution[2 * n :]
        slip = own_slip @ shear + other_slip @ pressure - creepage * step
        closes = ~contact & (gap + own @ pressure + other @ shear < approach * (1.0 - 1e-12))
        now = (contact & (pressure >= 0.0)) | closes
        beyond = stick & (np.abs(shear) > mu * pressure * (1.0 + 1e-9))
        back = contact & ~stick & (slip * way < 0.0)
        sticks = ((stick & ~beyond) | back | closes) & now
        if np.array_equal(now, contact) and np.array_equal(sticks, stick):
            part = float(stick.sum() / contact.sum())
            return Rolling(float(creepage), part, 0.5 * step * int(contact.sum()), x, pressure, shear)
        way[beyond] = -np.sign(shear[beyond])
        contact, stick = now, sticks
    raise RuntimeError("the active sets do not settle")
