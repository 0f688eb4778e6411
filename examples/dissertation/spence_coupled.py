"""Stick ratio of a rigid flat punch or cylinder pressed with friction on a half-plane, elastic coupling both ways.

Independent of the MFV library: numpy only, no load history. With a = 1, beta = (kappa - 1)/(kappa + 1), displacements times
4 G/(kappa + 1), p even and tau odd, the surface of the half-plane moves by

    w(x) = -1/pi int_0^1 p(s) [ln|x-s| + ln(x+s)] ds - beta int_x^1 tau(s) ds    (into the body),
    u(x) = -1/pi int_0^1 tau(s) [ln|x-s| - ln(x+s)] ds - beta int_0^x p(s) ds    (to the right).

Flat punch: the contact does not change, so the solution grows in proportion to the load and the stick zone 0 < x < c stays:
w is constant on (0, 1), u = 0 on (0, c), tau = mu p on (c, 1), as the surface slips inwards. For any c this is a linear
problem; its tau is singular at c unless c is right. The right c leaves tau - mu p without a square-root singularity there,
which bisection finds.

Cylinder: gap and loads grow self-similarly, the contact half-width a with the square root of the force. The derivative of
all fields with respect to a has no curvature, no strain in the stick zone and tau = mu p in the slip zones: it is a flat
punch of half-width a. So the stick ratio is the same (Spence 1973), and the fields of the cylinder are the sum over those of
punches: p(x) = 2 P int_x^1 f(x/a) da, with f the pressure under a punch of unit half-width and unit force.

Without the beta in w (Goodman) the stick ratio is that of eq. 3.4, and with c = 1 the pressure in the middle of the punch is
1/(pi sqrt(1 - beta^2)); `check` prints how well both are met.

    python examples/dissertation/spence_coupled.py
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
CELLS = 120  # on either side of c


def cells(c: float) -> Array:
    """Ends of cells on (0, 1), crowded at c from both sides and at 1; on (0, 1) alone when c = 1."""
    t = np.linspace(0.0, 1.0, CELLS + 1)
    stick = c * (1.0 - (1.0 - t) ** 3)
    if c == 1.0:
        return stick
    slip = c + (1.0 - c) * t**3 / (t**3 + (1.0 - t) ** 3)
    return np.concatenate((stick, slip[1:]))


def primitive(y: Array) -> Array:
    """Integral of ln|y|, 0 at 0."""
    return y * np.log(np.abs(y) + (y == 0.0)) - y


def punch(c: float, mu: float, beta: float, goodman: bool) -> tuple[Array, Array, Array]:
    """Middles of the cells, p and tau there under a flat punch of unit half-width and unit force with the stick zone (0, c)."""
    ends = cells(c)
    x, width = 0.5 * (ends[1:] + ends[:-1]), np.diff(ends)
    n, stuck = len(x), np.flatnonzero(x < c)
    near = primitive(x[:, None] - ends[:-1]) - primitive(x[:, None] - ends[1:])
    far = primitive(x[:, None] + ends[1:]) - primitive(x[:, None] + ends[:-1])
    inside = np.tril(np.ones((n, n)), -1) * width + np.diag(0.5 * width)  # int_0^x
    outside = width - inside  # int_x^1
    w_p, w_tau = -(near + far) / np.pi, -beta * outside * (0.0 if goodman else 1.0)
    u_tau, u_p = -(near - far) / np.pi, -beta * inside
    slips = np.where(x < c, 0.0, mu)  # tau = slips p, but unknown where stuck
    matrix = np.zeros((n + len(stuck) + 1, n + len(stuck) + 1))
    matrix[:n, :n], matrix[:n, n:-1], matrix[:n, -1] = w_p + w_tau * slips, w_tau[:, stuck], -1.0
    matrix[n:-1, :n], matrix[n:-1, n:-1] = (u_p + u_tau * slips)[stuck], u_tau[np.ix_(stuck, stuck)]
    matrix[-1, :n] = 2.0 * width
    solution = np.linalg.solve(matrix, np.eye(len(matrix))[-1])
    p = solution[:n]
    tau = slips * p
    tau[stuck] = solution[n:-1]
    return x, p, tau


def stick_ratio(mu: float, beta: float, goodman: bool = False) -> float:
    """c at which tau - mu p is not singular at the end of the stick zone, from its last two cells."""
    if beta == 0.0:
        return 1.0
    low, high = 0.0, 1.0
    while high - low > 1.0e-6:
        c = 0.5 * (low + high)
        x, p, tau = punch(c, mu, beta, goodman)
        last = slice(CELLS - 2, CELLS)
        t = c - x[last]
        excess = (tau - mu * p)[last] * np.sqrt(t)  # tau - mu p = K/sqrt(t) + K' sqrt(t), so this is K + K' t
        if excess[1] * t[0] > excess[0] * t[1]:  # K > 0
            high = c
        else:
            low = c
    return 0.5 * (low + high)


def goodman_stick_ratio(mu: float, beta: float) -> float:
    """Root c of beta K(c) = mu K'(c), eq. 3.4, with K from the arithmetic-geometric mean."""

    def mean(a: float, b: float) -> float:
        while abs(a - b) > 1.0e-15 * a:
            a, b = 0.5 * (a + b), np.sqrt(a * b)
        return a

    low, high = 0.0, 1.0
    for _ in range(60):
        c = 0.5 * (low + high)
        # K(c) = pi/2 / mean(1, sqrt(1 - c^2)), K'(c) = pi/2 / mean(1, c)
        low, high = (c, high) if beta * mean(1.0, c) < mu * mean(1.0, np.sqrt(1.0 - c * c)) else (low, c)
    return 0.5 * (low + high)


def check() -> None:
    """Print how well the known limits are met."""
    for beta in (0.1, 2.0 / 7.0, 0.5):
        middle = punch(1.0, 0.0, beta, False)[1][0] * np.pi * np.sqrt(1.0 - beta**2)
        print(f"beta = {beta:.4f}: adhering punch, pressure in the middle over the exact one {middle:.6f}")
        for mu in (0.1, 0.3, 1.0):
            numbers = stick_ratio(mu, beta, goodman=True), goodman_stick_ratio(mu, beta), stick_ratio(mu, beta)
            print("  mu = {:.1f}: Goodman {:.5f}, eq. 3.4 {:.5f}; full coupling {:.5f}".format(mu, *numbers))
    print(f"beta = 1e-6, mu = 0.3: full coupling {stick_ratio(0.3, 1.0e-6):.5f} (incompressible: 1)")


if __name__ == "__main__":
    check()
