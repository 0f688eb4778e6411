r"""Edges of a contact and the constants of the tractions there, from nodal forces.

Near an incomplete edge, at the distance s inside, p = K_N sqrt(s) + C s^(3/2) and, where the bodies stick, q = K_T/sqrt(s) + B sqrt(s)
(Hills, Andresen, Moore, Barber 2019). The forces of these tractions at nodes are integrals with the hat functions of the elements, so that
coarse meshes give good constants: elements need not resolve the tractions. Tractions of a result are fitted at the nodes. The edge,
between nodes, is that with the smallest residual.
"""

from __future__ import annotations

from typing import NamedTuple, Protocol

import numpy as np

from .record import Array, Places

#: A node is in contact if its pressure is above this fraction of the largest one.
LOADED = 1.0e-3

#: Numbers of loaded nodes that are fitted; the second one gives the value, the others its error. The farthest one is within this fraction of
#: the contact from the edge.
NODES, FARTHEST = (3, 4, 5), 0.8

#: The truncated term of the expansions grows with the square of the number of nodes: with 3, 4 and 5 of them the differences sum up to as
#: much as the error with 4. For safety:
SAFETY = 2.0

#: Candidates for the edge at each level of the search, and levels: 2 elements are divided by 10^4.
_CANDIDATES, _LEVELS = 41, 4


class Edge(NamedTuple):
    """An edge over time: its x [length], K_N [force/length^(5/2)], K_T [force/length^(3/2)] on the lower body to the right, and their
    errors, arrays (times,); NaN where they are undefined or unknown."""

    x: Array
    x_error: Array
    K_N: Array
    K_N_error: Array
    K_T: Array
    K_T_error: Array


class _Fit(NamedTuple):
    """Edge, K_N and K_T, and what the tractions at the nodes differ from these by: a length and parts of K_N and K_T."""

    values: Array
    misfit: Array


#: An edge, K_N and K_T with their errors, of which none is known.
_UNKNOWN = (np.nan,) * 6


def edge(x: Array, width: Array, pressure: Array, shear: Array, are_samples: bool, side: int) -> Edge:
    """The edge on the right (`side` 1) or left (-1). Pressure and shear traction at nodes, (times, nodes) [force/length^2], are nodal forces
    over the `width` of the surface that belongs to a node, or the tractions there (`are_samples`)."""
    if side < 0:
        x, width, pressure, shear = -x[::-1], width[::-1], pressure[:, ::-1], shear[:, ::-1]
    basis = _Samples(x) if are_samples else _Averages(x, width)
    rows = np.array([_at_time(x, basis, *tractions) for tractions in zip(pressure, shear)])
    rows[:, 0] *= side
    return Edge(*rows.T)


def contact_nodes(pressure: Array) -> Places:
    """The places of the nodes in contact at a time, of which the outermost may be just outside."""
    largest = float(pressure.max())
    return np.nonzero(pressure > LOADED * largest)[0] if largest > 0.0 else np.array([], dtype=np.intp)


def _at_time(x: Array, basis: _Basis, pressure: Array, shear: Array) -> tuple[float, ...]:
    """Edge, K_N and K_T on the right with their errors, by turns."""
    loaded = contact_nodes(pressure)
    if len(loaded) == 0:
        return _UNKNOWN
    last = int(loaded[-1])
    if last == len(x) - 1 or _is_complete(pressure, loaded):
        return (float(x[last]), *_UNKNOWN[1:])
    reach = FARTHEST * (x[last] - x[loaded[0]])
    sizes = [size for size in NODES if last - size + 1 >= 1 and x[last] - x[last - size + 1] <= reach]
    if len(sizes) < 2:
        return (float(x[last]), float(x[last + 1] - x[last]), *_UNKNOWN[2:]) if last + 1 < len(x) else _UNKNOWN
    fits = [_fit(x, basis, pressure, shear, last, size) for size in sizes]
    values = np.array([fit.values for fit in fits])
    errors = SAFETY * np.sum(np.abs(np.diff(values, axis=0)), axis=0) + fits[1].misfit
    if not errors[1] < values[1, 1]:
        return (float(values[1, 0]), float(errors[0]), *_UNKNOWN[2:])
    return tuple(float(value) for pair in zip(values[1], errors) for value in pair)


def _is_complete(pressure: Array, loaded: Places) -> bool:
    """Whether the pressure rises towards the right edge, as at a corner: of the right half the last two nodes have the largest."""
    return len(loaded) > 5 and float(pressure[loaded[-2:]].max()) >= float(pressure[loaded[len(loaded) // 2 :]].max())


def _fit(x: Array, basis: _Basis, pressure: Array, shear: Array, last: int, size: int) -> _Fit:
    """A fit to `size` loaded nodes and the one beyond the last."""
    nodes = np.arange(last - size + 1, last + 2)
    low, high = x[last - 1], x[last + 1]
    for _ in range(_LEVELS):
        candidates = np.linspace(low, high, _CANDIDATES)[1:-1]
        residuals, factors = _solved(basis.powers(nodes, candidates, (0.5, 1.5)), pressure[nodes])
        best = int(np.argmin(residuals))
        step = candidates[1] - candidates[0]
        low, high = candidates[best] - step, candidates[best] + step
    place = candidates[best : best + 1]
    weights = basis.weights(nodes, float(place[0]))
    weighted = weights * shear[nodes]
    rest, of_shear = _solved(weights[:, None] * basis.powers(nodes, place, (-0.5, 0.5)), weighted)
    values = np.array([place[0], factors[best, 0], of_shear[0, 0]])
    parts = [_part(residuals[best], pressure[nodes]), _part(rest[0], weighted)]
    misfit = np.array([parts[0] * (x[last] - x[last - 1]), parts[0] * abs(values[1]), parts[1] * abs(values[2])])
    return _Fit(values, misfit)


def _part(residual: float, values: Array) -> float:
    """A residual as a part of the values."""
    size = float(np.linalg.norm(values))
    return float(residual) / size if size > 0.0 else 0.0


class _Basis(Protocol):
    """What powers of the distance from the edge are in the values at nodes."""

    def powers(self, nodes: Places, edges: Array, powers: tuple[float, float]) -> Array:
        """Values at nodes of (edge - x)^power inside the contact, (edges, nodes, powers)."""

    def weights(self, nodes: Places, place: float) -> Array:
        """Weights of the nodes in the fit of the shear traction, which may be infinite at the edge."""


class _Averages(NamedTuple):
    """Values that are nodal forces over widths: integrals with the hat functions of the nodes, second differences of primitives."""

    x: Array
    width: Array

    def powers(self, nodes: Places, edges: Array, powers: tuple[float, float]) -> Array:
        spaced = np.concatenate([self.x, [2.0 * self.x[-1] - self.x[-2]]])
        places = spaced[nodes[0] - 1 : nodes[-1] + 2]
        inside = np.maximum(edges[:, None, None] - places[None, :, None], 0.0)
        exponents = np.array(powers)
        primitive = inside ** (exponents + 2.0) / ((exponents + 1.0) * (exponents + 2.0))
        slopes = np.diff(primitive, axis=1) / np.diff(places)[None, :, None]
        return np.asarray(np.diff(slopes, axis=1) / self.width[nodes, None])

    def weights(self, nodes: Places, place: float) -> Array:
        return np.ones(len(nodes))


class _Samples(NamedTuple):
    """Values at the nodes themselves. Shear tractions are weighted with the square root of the distance from the edge."""

    x: Array

    def powers(self, nodes: Places, edges: Array, powers: tuple[float, float]) -> Array:
        distance = edges[:, None, None] - self.x[None, nodes, None]
        return np.where(distance > 0.0, np.maximum(distance, 1e-300) ** np.array(powers), 0.0)

    def weights(self, nodes: Places, place: float) -> Array:
        return np.asarray(np.sqrt(np.maximum(place - self.x[nodes], 0.0)))


def _solved(matrices: Array, values: Array) -> tuple[Array, Array]:
    """Residuals and factors of least-squares problems, with matrices (problems, rows, columns)."""
    scale = np.linalg.norm(matrices, axis=1, keepdims=True)
    scale = np.where(scale > 0.0, scale, 1.0)
    scaled = matrices / scale
    factors = np.linalg.pinv(scaled) @ values
    residuals = np.linalg.norm((scaled @ factors[..., None])[..., 0] - values, axis=1)
    return residuals, factors / scale[:, 0]
