"""Half-planes as matrix bodies, for comparison with the closed-form half-planes of MFV."""

from __future__ import annotations

from typing import Callable

import numpy as np
from numpy.typing import NDArray

import mfv

Array = NDArray[np.float64]


def half_plane(x: Array, width: Array, shear_modulus: float, poisson_ratio: float, datum: float, *, mean: bool = True) -> mfv.Body:
    """The half-plane under boxes of `width` about `x`: mean displacements of the boxes, or those at `x`, which is what MFV's own
    half-plane has and is symmetric for equal widths alone."""
    kappa = 3.0 - 4.0 * poisson_ratio
    by_logarithm, by_sign = (kappa + 1.0) / (4.0 * np.pi * shear_modulus), (kappa - 1.0) / (8.0 * shear_modulus)
    matrix = _means if mean else _values
    normal = -by_logarithm * (matrix(_logarithm, x, width) - np.log(datum))
    across = by_sign * matrix(_sign, x, width)
    return mfv.Body.matrix(x, compliance=np.block([[normal, across], [-across, normal]]), width=width)


def graded(inner: int, interval: float, growth: float, outer: tuple[int, int]) -> tuple[Array, Array]:
    """Places and widths: `inner` equal ones about 0, growing outwards by `growth` from one to the next, this many on either side."""
    left, right = (interval * growth ** np.arange(1.0, number + 1) for number in outer)
    width = np.concatenate((left[::-1], np.full(inner, interval), right))
    ends = np.concatenate(([0.0], np.cumsum(width))) - left.sum() - 0.5 * inner * interval
    return 0.5 * (ends[1:] + ends[:-1]), width


def skew(nodes: int, interval: float, growth: float) -> tuple[Array, Array]:
    """Places and widths that grow from left to right, the middle one, of `interval`, about 0."""
    width = interval * growth ** (np.arange(nodes) - 0.5 * (nodes - 1))
    ends = np.concatenate(([0.0], np.cumsum(width)))
    middles = 0.5 * (ends[1:] + ends[:-1])
    return middles - middles[nodes // 2], width


def _logarithm(order: int, x: Array) -> Array:
    """ln|x| integrated `order` times."""
    with np.errstate(divide="ignore", invalid="ignore"):
        once, twice = x * np.log(np.abs(x)) - x, 0.5 * x**2 * np.log(np.abs(x)) - 0.75 * x**2
    return np.where(x == 0.0, 0.0, once if order == 1 else twice)


def _sign(order: int, x: Array) -> Array:
    """The sign of x integrated `order` times."""
    return np.abs(x) if order == 1 else 0.5 * x * np.abs(x)


def _values(kernel: Callable[[int, Array], Array], x: Array, width: Array) -> Array:
    """Means of a kernel over the boxes, seen from the places."""
    distance, half = x[:, None] - x[None, :], 0.5 * width[None, :]
    return (kernel(1, distance + half) - kernel(1, distance - half)) / width[None, :]


def _means(kernel: Callable[[int, Array], Array], x: Array, width: Array) -> Array:
    """Means of a kernel over pairs of boxes."""
    left, right = x - 0.5 * width, x + 0.5 * width
    corners = (
        kernel(2, right[:, None] - left[None, :])
        - kernel(2, right[:, None] - right[None, :])
        - kernel(2, left[:, None] - left[None, :])
        + kernel(2, left[:, None] - right[None, :])
    )
    return corners / np.outer(width, width)
