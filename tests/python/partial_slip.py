"""Shear tractions and surface stress of uncoupled half-planes at constant normal force, by singular integrals instead of nodes.

Lengths are over the half-width a of the contact, tractions over P/a, forces over P. The shear tau pushes the lower body to the right.
While the edges c < d of the stick zone move inwards and slip keeps its direction at either side, the change D of tau since the turning
point is +-mu p - tau there in the slip zones, and in the stick zone the slope of the slip does not change:

    p.v. integral of D/(t - x) dt = -pi f,    f = m (change of the strain of the lower body less that of the upper one),

with the contact modulus m (docs/theory.md). Its solution bounded at both edges (Muskhelishvili), R(t) = sqrt((t - c)(t - d)),

    D(x) = 1/pi sqrt((x - c)(d - x)) integral of D(t) sgn(t)/(R(t) (t - x)) dt over the slip zones, sgn = 1 right, -1 left of them,

exists and has the resultant Q if

    integral of D sgn/R dt = -pi f,    integral of D |t - (c + d)/2|/R dt = Q.

These two determine c and d. Without slip at a fixed c and d the rate is (Q'/pi - f' (x - (c + d)/2))/sqrt((x - c)(d - x)): its sign at an
edge is the direction of slip there, and a slip zone in which it is reversed sticks at once. Nothing is assumed of the former tractions:
reversals, and bulk stress in and out of phase, are the same equations. Where an edge would move outwards `Unsolved` is raised.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Callable

import numpy as np
from scipy.optimize import root

Array = np.ndarray
Function = Callable[[Array], Array]

#: Points of a panel between two edges, in the angle that removes roots at both of its ends.
DEGREE = 36
#: Gauss points of each part of a panel, and halvings of its parts towards its ends.
GAUSS, HALVINGS = 8, 9
#: Part of a load segment that is omitted, and the friction over mu P/a that may remain where a loop closes.
CLOSING, CLOSED = 1e-7, 1e-4


class Unsolved(Exception):
    """The history is not one of edges that move inwards."""


# --- pressures ---------------------------------------------------------------------------------------------------------------------


def hertz_pressure(x: Array) -> Array:
    """Under a parabola."""
    return 2.0 / math.pi * np.sqrt(np.maximum(1.0 - np.square(x), 0.0))


def pad_pressure(x: Array, flat: float) -> Array:
    """Under a flat face up to |x| = `flat` < 1 with parabolic edges (Ciavarella, Hills and Monno 1998)."""
    psi = math.acos(flat)
    start = 0.5 * math.pi - psi
    phi = np.arcsin(np.minimum(np.abs(x), 1.0))
    near = np.where(np.abs(phi - start) < 1e-14, 1e-14, phi - start)
    logarithm = np.sin(phi) * np.log(np.abs(np.sin(phi + start) / np.sin(near)))
    logarithm += math.sin(start) * np.log(np.abs(np.tan(0.5 * (phi + start)) * np.tan(0.5 * near)))
    bracket = 2.0 * psi * np.cos(phi) + logarithm
    return np.maximum(2.0 * bracket / (math.pi * (2.0 * psi - math.sin(2.0 * psi))), 0.0)


# --- functions with roots at edges -------------------------------------------------------------------------------------------------


@dataclass
class Panels:
    """A function between ascending `ends`, in each panel a polynomial of the angle: x = l + (r - l) sin^2(angle/2)."""

    ends: Array
    values: Array = field(default_factory=lambda: np.zeros((0, DEGREE)))

    def points(self) -> Array:
        """Where its values are taken, shape (panels, DEGREE)."""
        angle = 0.5 * math.pi * (1.0 - np.cos(math.pi * (np.arange(DEGREE) + 0.5) / DEGREE))
        left, right = self.ends[:-1, None], self.ends[1:, None]
        return left + (right - left) * np.sin(0.5 * angle) ** 2

    def filled(self, function: Function) -> Panels:
        points = self.points()
        return Panels(self.ends, function(points.ravel()).reshape(points.shape))

    def __call__(self, x: Array) -> Array:
        """Interpolated: a Chebyshev series in each panel."""
        x = np.asarray(x, float)
        panel = np.clip(np.searchsorted(self.ends, x, side="right") - 1, 0, len(self.ends) - 2)
        left, right = self.ends[panel], self.ends[panel + 1]
        angle = 2.0 * np.arcsin(np.sqrt(np.clip((x - left) / (right - left), 0.0, 1.0)))
        order = np.arange(DEGREE)
        places = math.pi * (order + 0.5) / DEGREE
        series = 2.0 / DEGREE * self.values @ np.cos(np.outer(places, order))
        series[:, 0] *= 0.5
        # Clenshaw's recurrence.
        cosine, before, last = 1.0 - 2.0 * angle / math.pi, np.zeros_like(angle), np.zeros_like(angle)
        for k in range(DEGREE - 1, 0, -1):
            before, last = series[panel, k] + 2.0 * cosine * before - last, before
        found = series[panel, 0] + cosine * before - last
        return np.where((x <= self.ends[0]) | (x >= self.ends[-1]), 0.0, found)


def _rule() -> tuple[Array, Array]:
    """Angles in (0, pi) and weights, graded towards both ends."""
    points, weights = np.polynomial.legendre.leggauss(GAUSS)
    cuts = np.concatenate([[0.0], 0.5 * math.pi * 0.5 ** np.arange(HALVINGS, -1, -1.0)])
    middle, half = 0.5 * (cuts[1:] + cuts[:-1]), 0.5 * (cuts[1:] - cuts[:-1])
    angle = (middle[:, None] + half[:, None] * points).ravel()
    weight = (half[:, None] * weights).ravel()
    return np.concatenate([angle, math.pi - angle[::-1]]), np.concatenate([weight, weight[::-1]])


ANGLE, WEIGHT = _rule()


def quadrature(ends: Array) -> tuple[Array, Array]:
    """Places and weights between ascending ends, at which functions may have roots and their inverses."""
    left, right = np.asarray(ends[:-1])[:, None], np.asarray(ends[1:])[:, None]
    near = np.sin(0.5 * ANGLE) ** 2
    x = np.where(near < 0.5, left + (right - left) * near, right - (right - left) * np.cos(0.5 * ANGLE) ** 2)
    return x.ravel(), (0.5 * (right - left) * np.sin(ANGLE) * WEIGHT).ravel()


def between(ends: Array, left: float, right: float) -> Array:
    """`left`, the ends between, and `right`."""
    inner = ends[(ends > left + 1e-12) & (ends < right - 1e-12)]
    return np.array([left, *inner, right])


def sampled(function: Panels, left: float, right: float) -> tuple[Array, Array, Array]:
    """Places, weights and values of a function from `left` to `right`, one of which is an end of a panel."""
    if right - left < 1e-12:
        return np.zeros(0), np.zeros(0), np.zeros(0)
    ends = between(function.ends, left, right)
    x, weight = quadrature(ends)
    whole = np.searchsorted(function.ends, 0.5 * (ends[1:] + ends[:-1])) - 1
    values = (function.values @ SAMPLING)[whole]
    for i, panel in enumerate(whole):
        if (ends[i] > function.ends[panel]) or (ends[i + 1] < function.ends[panel + 1]):
            values[i] = function(x.reshape(values.shape)[i])
    return x, weight, values.ravel()


def _sampling() -> Array:
    """From the values of a panel to those at the angles of the rule."""
    order = np.arange(DEGREE)
    series = 2.0 / DEGREE * np.cos(np.outer(math.pi * (order + 0.5) / DEGREE, order))
    series[:, 0] *= 0.5
    return series @ np.cos(np.outer(order, np.arccos(1.0 - 2.0 * ANGLE / math.pi)))


SAMPLING = _sampling()


# --- tractions ---------------------------------------------------------------------------------------------------------------------


@dataclass
class Contact:
    """The state of a contact: `pressure` with kinks at `kinks`, the shear, and the slip zones beyond the stick zone with the signs of
    the shear in them (0: no slip there)."""

    pressure: Function
    mu: float
    kinks: tuple[float, ...] = ()
    force: float = 0.0
    strain: float = 0.0

    def __post_init__(self) -> None:
        self.shear = Panels(np.array(sorted({-1.0, *self.kinks, 1.0}))).filled(np.zeros_like)
        self.edges = [-1.0, 1.0]
        self.signs = [0.0, 0.0]

    def load(self, force: float, strain: float, parts: int = 4) -> None:
        """Change the tangential force, over P, and the strain m (epsilon_1 - epsilon_2), over P/a, in proportion."""
        change = np.array([force - self.force, strain - self.strain])
        if not np.any(np.abs(change) > 1e-13):
            return
        if abs(force) > self.mu * (1.0 - 1e-9):
            self._slide(math.copysign(1.0, force))
        else:
            self._slip(change, parts)
        self.force, self.strain = force, strain

    def _slide(self, sign: float) -> None:
        self.shear = Panels(np.array(sorted({-1.0, *self.kinks, 1.0}))).filled(lambda x: sign * self.mu * self.pressure(x))
        self.edges, self.signs = [0.0, 0.0], [sign, sign]

    def _start(self, change: Array) -> tuple[list[float], list[float]]:
        """Edges of the stick zone just after the turning point, and the directions of slip at them."""
        found = []
        for goes_on in ((True, True), (True, False), (False, True), (False, False)):
            edges = [edge if on else side for edge, side, on in zip(self.edges, (-1.0, 1.0), goes_on)]
            if any(on and sign == 0.0 for on, sign in zip(goes_on, self.signs)) or edges[1] - edges[0] < 1e-9:
                continue
            half = 0.5 * (edges[1] - edges[0])
            rates = [change[0] / math.pi + change[1] * half, change[0] / math.pi - change[1] * half]
            if min(np.abs(rates)) < 1e-3 * max(np.abs(rates)):
                continue
            signs = [math.copysign(1.0, rate) for rate in rates]
            if all(on == (sign == old) for on, sign, old in zip(goes_on, signs, self.signs)):
                found.append((edges, signs))
        if len(found) != 1:
            raise Unsolved(f"{len(found)} ways to go on")
        return found[0]

    def _needed(self, edges: Array, signs: list[float]) -> tuple[Array, Array, Array, Array]:
        """The change of force and strain that moves the edges inwards to these; places, changes of tau times weights over R, sgn."""
        c, d = edges
        left, left_weight, left_shear = sampled(self.shear, -1.0, c)
        right, right_weight, right_shear = sampled(self.shear, d, 1.0)
        t = np.concatenate([left, right])
        side = np.repeat([-1.0, 1.0], [left.size, right.size])
        sign = np.repeat(signs, [left.size, right.size])
        change = sign * self.mu * self.pressure(t) - np.concatenate([left_shear, right_shear])
        change = change * np.concatenate([left_weight, right_weight]) / np.sqrt(np.maximum(np.abs((t - c) * (t - d)), 1e-300))
        return np.array([np.sum(change * np.abs(t - 0.5 * (c + d))), -np.sum(change * side) / math.pi]), t, change, side

    def _slip(self, change: Array, parts: int) -> None:
        start, signs = self._start(change)
        scale = np.max(np.abs(change) * [1.0, math.pi])
        # Where a loop closes the edges jump to its start: just before that.
        fractions = np.concatenate([[0.01, 0.1], np.linspace(0.0, 1.0, parts + 1)[1:]])
        fractions[-1] -= CLOSING
        widths = np.full(2, 0.25 * fractions[0] * min(scale / self.mu, 1.0))
        before, last = 0.0, np.zeros(2)
        edges = np.array(start)
        for fraction in fractions:

            def residual(logarithms: Array, fraction: float = fraction) -> Array:
                inwards = np.exp(np.minimum(logarithms, 1.0))
                at = np.array([start[0] + inwards[0], start[1] - inwards[1]])
                if at[1] - at[0] < 1e-6:
                    return np.full(2, 1e3) + logarithms
                return (self._needed(at, signs)[0] - fraction * change) * [1.0, math.pi] / scale

            solved = root(residual, np.log(widths), method="hybr", options={"xtol": 1e-13})
            if np.max(np.abs(residual(solved.x))) > 1e-8:
                raise Unsolved(f"no edges at {fraction}")
            found = np.exp(solved.x)
            if np.any(found < last * (1.0 - 1e-9)):
                raise Unsolved("an edge moves outwards")
            following = fractions[min(np.searchsorted(fractions, fraction) + 1, len(fractions) - 1)]
            growth = (found - last) / (fraction - before) * (following - fraction)
            before, last = fraction, found
            widths = found + growth
            room = start[1] - start[0]
            if widths.sum() > 0.98 * room:
                widths = found + growth * max(0.98 * room - found.sum(), 0.0) / max(growth.sum(), 1e-300) * 0.5
            edges = np.array([start[0] + found[0], start[1] - found[1]])
        for i in range(2):
            nearest = self.shear.ends[np.argmin(np.abs(self.shear.ends - edges[i]))]
            edges[i] = nearest if abs(nearest - edges[i]) < 2e-5 else edges[i]
        _, t, weights, side = self._needed(edges, signs)
        former, c, d = self.shear, *edges

        def shear(x: Array) -> Array:
            inside = (x > c) & (x < d)
            values = self.mu * self.pressure(x) * np.where(x < c, signs[0], signs[1])
            at = x[inside]
            values[inside] = former(at) + np.sqrt((at - c) * (d - at)) / math.pi * ((weights * side) / (t - at[:, None])).sum(
                axis=1
            )
            return values

        self.shear = Panels(np.unique(np.concatenate([former.ends, edges]))).filled(shear)
        x = self.shear.points().ravel()
        if np.max(np.abs(self.shear.values.ravel()) - self.mu * self.pressure(x)) > 1e-6 * self.mu:
            raise Unsolved("more than the friction limit")
        self.edges, self.signs = self._beyond_closed_loops(edges, signs), signs

    def _beyond_closed_loops(self, edges: Array, signs: list[float]) -> list[float]:
        """The edges of the stick zone, beyond former slip zones in which the limit is reached again."""
        lack = 1.0 - np.array(signs)[:, None, None] * self.shear.values / (self.mu * self.pressure(self.shear.points()))
        closed = np.all(np.abs(lack) < CLOSED, axis=2)
        left, right = (int(np.argmin(np.abs(self.shear.ends - edge))) for edge in edges)
        while left < right and closed[0, left]:
            left += 1
        while right > left and closed[1, right - 1]:
            right -= 1
        return [float(self.shear.ends[left]), float(self.shear.ends[right])]

    # --- stresses ---

    def shear_stress_integral(self, x: float) -> float:
        """2/pi p.v. integral of tau/(t - x) dt: sigma_xx along the lower surface by the shear."""
        if not -1.0 < x < 1.0:
            t, weight, shear = sampled(self.shear, -1.0, 1.0)
            return 2.0 / math.pi * float(np.sum(weight * shear / (t - x)))
        t, weight, shear = (np.concatenate(both) for both in zip(sampled(self.shear, -1.0, x), sampled(self.shear, x, 1.0)))
        here = float(self.shear(np.array([x]))[0])
        apart = np.where(t == x, 1.0, t - x)
        return 2.0 / math.pi * float(np.sum(weight * (shear - here) / apart) + here * math.log((1.0 - x) / (1.0 + x)))

    def surface_stress(self, x: float, bulk: float = 0.0, upper: bool = False) -> float:
        """sigma_xx along a surface, over P/a."""
        stress = bulk + (-1.0 if upper else 1.0) * self.shear_stress_integral(x)
        return stress - float(self.pressure(np.array([x]))[0]) if abs(x) < 1.0 else stress

    def largest_tension(self, bulk: float = 0.0, upper: bool = False) -> tuple[float, float]:
        """The largest sigma_xx along a surface, at least the bulk stress, and its place: at edges, former ones too, or between them."""
        inner = np.concatenate(
            [self.shear.ends[:-1] + np.diff(self.shear.ends) * part for part in (0.05, 0.2, 0.4, 0.6, 0.8, 0.95)]
        )
        beside = 1.0 + np.geomspace(1e-4, 10.0, 16)
        places = np.unique(np.concatenate([self.shear.ends, inner, beside, -beside]))
        stress = np.array([self.surface_stress(x, bulk, upper) for x in places])
        best, where = float(stress.max()), float(places[stress.argmax()])
        for i in range(1, len(places) - 1):
            # At an edge, where it has a cusp, it is exact.
            if stress[i] < stress[i - 1 : i + 2].max() or stress[i] < 0.9 * best or abs(places[i]) == 1.0:
                continue
            value, place = _golden(lambda x: self.surface_stress(x, bulk, upper), places[i - 1], places[i + 1])
            if value > best:
                best, where = value, place
        return (best, where) if best > bulk else (max(bulk, 0.0), math.nan)


def _golden(function: Callable[[float], float], left: float, right: float) -> tuple[float, float]:
    """The largest value between two places and its place."""
    part = 0.5 * (math.sqrt(5.0) - 1.0)
    while right - left > 1e-7:
        inner = right - part * (right - left), left + part * (right - left)
        if function(inner[0]) >= function(inner[1]):
            right = inner[1]
        else:
            left = inner[0]
    middle = 0.5 * (left + right)
    return function(middle), middle
