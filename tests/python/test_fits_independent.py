"""A pin in a bore of its radius (a neat fit), pressed in by an interference, against another derivation in numpy alone.

Elasticity: potentials of Kolosov and Muskhelishvili for a disk and for the plane outside a hole, as power series. On a rim
of radius 1 let s = exp(i theta), sigma_rr + i sigma_rtheta = sum c_k s^k and 2G (u_r + i u_theta) = sum d_k s^k. Then

    disk: d_k = kappa c_k/(k+1), d_-k = c_-k/(k-1);    hole: d_k = -c_k/(k+1), d_-k = -kappa c_-k/(k-1),    k >= 2.

The hole's first formula also holds for k = 0 and 1. c_-1 is the force, carried at infinity or in the disk's centre by
z phi' = c_-1/(1+kappa), and d_-1 a translation, defined up to a multiple of the force. Only in the disk it couples k = 1 and
-1: d_1 = kappa c_1/2 - conj(c_-1), d_-1 = -conj(c_1). Without shear d_0 = (kappa-1)/2 c_0. A moment in the disk's centre
balances uniform shear: 2G u_theta = -c_0/r + omega r. Its rotation, by definition that of the circle of half its area, is
held: omega = 2 c_0, so that on the rim d_0 = c_0.

Contact: implicit load increments, in each of which every node is open, sticks or slips. Their error is of first order in
the increment; MFV has none, so the difference has to vanish at first order.
"""

from __future__ import annotations

from collections import namedtuple
from functools import cache

import numpy as np
import pytest

import mfv
from mfv import NodeStatus

RADIUS, NODES = 1.3, 60
F = 0.01  # the interference, and the unit of forces: moduli are about 1
WIDTH = 2 * np.pi * RADIUS / NODES
ANGLE = (np.arange(NODES) - (NODES - 1) / 2) * 2 * np.pi / NODES
Materials = tuple[tuple[float, float], tuple[float, float]]  # shear moduli and Poisson's ratios of hole and disk
ALIKE, STIFF_PIN, STIFF_BORE = ((0.8, 0.3), (0.8, 0.3)), ((0.7, 0.35), (2.1, 0.2)), ((2.1, 0.2), (0.7, 0.35))
OPEN, STICK = -2, 0  # statuses; of nodes that slip the sign of their shear
#: Relative differences allowed at COUNTS[-1] load steps a leg, one and a half to three times the largest measured.
LARGEST = {"pressure": 1e-4, "shear": 3e-3, "approach": 1e-4, "shift": 1e-4, "rotation": 3e-4, "moment": 2e-4, "dissipation": 4e-3}
COUNTS = [23, 41, 89, 173, 347, 701]
State = namedtuple("State", [*LARGEST, "status"])  # a contact at the end of a leg of its load history
Leg = namedtuple("Leg", "interference normal tangential moment", defaults=[0.0, 0.0, 0.0, None])  # None: the rotation is held
#: u_r and u_theta of all nodes by a unit approach, shift and rotation of a pin.
MOTIONS = np.column_stack(
    [np.append(np.cos(ANGLE), -np.sin(ANGLE)), np.append(np.sin(ANGLE), np.cos(ANGLE)), np.repeat([0.0, RADIUS], NODES)]
)


@cache
def compliance(modulus: float, nu: float, hole: bool, terms: int = 4000) -> np.ndarray:
    """u_r and u_theta of all nodes, by sigma_rr and sigma_rtheta on all intervals of the rim of a disk or a hole."""
    kappa, node, fold = 3 - 4 * nu, np.arange(NODES), np.arange(-terms, terms + 1)
    k = node[:, None] + NODES * fold  # harmonics with the same values at the nodes: a series of alternating signs
    box = np.sinc(k / NODES) / NODES * np.where(abs(fold) == terms, 0.5, 1.0)  # c_k of a unit traction on an interval
    above, below = (-1, -kappa) if hole else (kappa, 1)
    factor = np.where(k >= 0, above, below) / np.where(k == -1, np.inf, abs(k + 1))
    series = [np.where((k == 0) & (not hole), zeroth, factor) for zeroth in ((kappa - 1) / 2, 1)]
    normal, shear = (np.fft.ifft((box * d).sum(axis=1)) * NODES for d in series)
    once = 0 if hole else 2 * np.sinc(1 / NODES) / NODES * np.cos(2 * np.pi * node / NODES)
    blocks = [part[(node[:, None] - node) % NODES] for part in (normal - once, 1j * (shear + once))]
    return RADIUS / (2 * modulus) * np.block([[block.real for block in blocks], [block.imag for block in blocks]])


def increment(
    matrix: np.ndarray, mu: float, load: Leg, turn: float, slip: np.ndarray, status: np.ndarray
) -> tuple[np.ndarray, ...]:
    """Pressure, shear, motions, slip and statuses at the end of a load increment, from slip and statuses at its beginning.

    `turn`: the rotation, if it is held.
    """
    unit, zero = np.eye(NODES), np.zeros((NODES, NODES))
    surfaces = np.hstack([matrix, -MOTIONS])  # gap + interference; -slip
    balance = np.hstack([WIDTH * MOTIONS.T, np.zeros((3, 3))])
    force = [load.normal, load.tangential, turn if load.moment is None else load.moment]
    if load.moment is None:
        balance[2] = np.eye(2 * NODES + 3)[-1]
    for _ in range(50):
        opened, sticks = status == OPEN, status == STICK
        open_rows = np.hstack([unit, zero, 0 * MOTIONS[:NODES]])
        slip_rows = np.hstack([np.diag(-mu * np.where(opened, 0, status)), unit, 0 * MOTIONS[:NODES]])
        normal_rows = np.where(opened[:, None], open_rows, surfaces[:NODES])
        shear_rows = np.where(sticks[:, None], surfaces[NODES:], slip_rows)
        right = np.concatenate([np.where(opened, 0, load.interference), np.where(sticks, -slip, 0), force])
        solution = np.linalg.solve(np.vstack([normal_rows, shear_rows, balance]), right)
        p, shear, motion = np.split(solution, [NODES, 2 * NODES])
        distance, slipped = np.split(surfaces @ solution, 2)
        slipped = -slipped - slip
        slides = np.where(abs(shear) > mu * p, np.sign(shear), STICK)
        closed = np.where(sticks, slides, np.where(status * slipped < -1e-14, STICK, status))
        touches = np.where(opened, distance < load.interference - 1e-14, p >= 0)
        after = np.where(touches, np.where(opened, np.sign(slipped), closed), OPEN).astype(int)
        if np.array_equal(after, status):
            return p, shear, motion, slip + slipped, status
        status = after
    raise AssertionError("the statuses do not settle")


def incremental(matrix: np.ndarray, mu: float, legs: list[Leg], count: int) -> list[State]:
    """States at the ends of the legs of a load history, each divided into this many implicit load steps."""
    slip, status, motion, dissipation, moment = np.zeros(NODES), np.zeros(NODES, int), np.zeros(3), 0.0, 0.0
    states, start = [], np.zeros(3)
    for leg in legs:
        for part in np.arange(1, count + 1) / count:
            loads = start + part * (np.array(leg[:3]) - start)
            target = None if leg.moment is None else moment + part * (leg.moment - moment)
            before = slip
            p, shear, motion, slip, status = increment(matrix, mu, Leg(*loads, target), motion[2], slip, status)
            dissipation += WIDTH * shear @ (slip - before)
        start, moment = np.array(leg[:3]), RADIUS * WIDTH * shear.sum()
        states.append(State(p, shear, *motion, moment, dissipation, status))
    return states


def solved(materials: Materials, mu: float, legs: list[Leg], pin_below: bool = False) -> mfv.Result:
    """The library's result, which has to come to its end, with a certificate. A pin below has the opposite tangential force."""
    hole, pin = (
        shape(RADIUS, shear_modulus=modulus, poisson_ratio=nu)
        for shape, (modulus, nu) in zip((mfv.Body.hole, mfv.Body.disk), materials)
    )
    steps = []
    for before, leg in zip([Leg(), *legs], legs):
        names = dict(zip(("interference", "normal_force", "tangential_force", "moment"), zip(before, leg)))
        changed = {name: now for name, (then, now) in names.items() if now != then}
        if pin_below and "tangential_force" in changed:
            changed["tangential_force"] *= -1
        steps.append(mfv.Step(**changed))
    lower, upper = (pin, hole) if pin_below else (hole, pin)
    mesh, friction = mfv.Mesh(normals="radial", nodes=NODES), mfv.Friction.coulomb(mu)
    result = mfv.run(mfv.Scene(lower=lower, upper=upper, mesh=mesh, friction=friction, steps=steps))
    assert result.outcome == "complete", result.message
    assert result.certificate.largest < 1e-12
    return result


def translations(step: mfv.Group, materials: Materials, pin_below: bool = False) -> np.ndarray:
    """Approach and shift by which displacements of hole and disk (rows) of the library exceed ours; all else has to agree."""
    sign = -1 if pin_below else 1
    bodies = [np.append(step[f"{side}normal_displacement"], step[f"{side}tangential_displacement"]) for side in ("", "upper_")]
    signs = np.repeat([[1, 1], [-1, 1]], NODES, axis=1)  # normal displacements are into the body
    excess = []
    for displacement, hole, (modulus, nu) in zip(bodies[::sign] * signs, (True, False), materials):
        ours = compliance(modulus, nu, hole) @ -np.append(step.pressure, sign * step.shear)
        fit, *_ = np.linalg.lstsq(MOTIONS[:, :2], displacement - ours, rcond=None)
        assert abs(displacement - ours - MOTIONS[:, :2] @ fit).max() < 1e-12 * abs(ours).max()
        excess.append(fit)
    return np.array(excess)


@pytest.mark.parametrize("pin_below", [False, True])
@pytest.mark.parametrize("materials", [ALIKE, STIFF_PIN, STIFF_BORE])
def test_displacements(materials: Materials, pin_below: bool) -> None:
    """Of every node of both bodies, to round-off; but for translations in proportion to the force."""
    # The largest forces are alike on both sides: the mesh is not turned towards the load.
    legs = [Leg(F), Leg(F, 6 * F), Leg(F, 6 * F, 2 * F), Leg(F, 6 * F, -2 * F, 2 * F), Leg(0.8 * F, -5 * F, -2 * F, F)]
    result = solved(materials, 0.3, legs, pin_below)
    found = [translations(step, materials, pin_below) for step in result.steps]
    unit = found[3] / [legs[3].normal, legs[3].tangential]
    for excess, leg in zip(found, legs):
        assert np.allclose(excess, unit * [leg.normal, leg.tangential], rtol=1e-10, atol=1e-13)


#: Materials, friction, whether the pin is below, and loads: with and without interference, the rotation held or free.
HISTORIES = {
    "pressed": (STIFF_PIN, 0.3, False, [Leg(F), Leg(F, 6 * F), Leg(F, 2 * F), Leg(0.7 * F, 4 * F)]),
    # The sum of the tangential forces is zero: the mesh is not turned towards the load.
    "sheared": (ALIKE, 0.3, False, [Leg(F), Leg(F, 6 * F), *(Leg(F, 6 * F, sign * 4 * F) for sign in (1, -1, 1, -1))]),
    "free to turn": (STIFF_PIN, 0.3, False, [Leg(F), Leg(F, 6 * F, 0, 0), Leg(F, 6 * F, 4 * F, 0), Leg(F, 6 * F, -4 * F, 0)]),
    "turned": (STIFF_PIN, 0.3, False, [Leg(F), Leg(F, 6 * F), Leg(F, 6 * F, 0, 2 * F), Leg(F, -6 * F, 0, 2 * F)]),
    "pin below": (STIFF_BORE, 0.1, True, [Leg(F), Leg(F, 8 * F), Leg(F, 8 * F, 0, 1.2 * F), Leg(F, -8 * F, 0, 1.2 * F)]),
    "neat": (STIFF_BORE, 0.2, False, [Leg(0, 3 * F), Leg(0, 3 * F, 2 * F), Leg(0, 3 * F, -2 * F)]),
    "neat, pin below": (STIFF_PIN, 0.2, True, [Leg(0, 3 * F), Leg(0, 3 * F, 2 * F), Leg(0, 3 * F, -2 * F)]),
}


@pytest.mark.parametrize("name", HISTORIES)
def test_history(name: str) -> None:
    """Statuses are equal; what differs falls with the first power of the load step. Interference alone is exact."""
    materials, mu, pin_below, legs = HISTORIES[name]
    result = solved(materials, mu, legs, pin_below)
    assert any(step.contact_nodes < NODES for step in result.steps) and any(step.slip_nodes > 9 for step in result.steps)
    sign = -1 if pin_below else 1
    expected = []
    for step in result.steps:
        excess = np.subtract(*translations(step, materials, pin_below))
        approach, shift = np.array([step.approach, sign * step["shift"]]) - excess
        status = np.select([step.status == code for code in NodeStatus][:4], [OPEN, STICK, -sign, sign])
        held = [0.0, RADIUS * WIDTH * sign * step.shear.sum()]
        turn = held if legs[-1].moment is None else [step["rotation"], step["moment"]]
        expected.append(State(step.pressure, sign * step.shear, approach, shift, *turn, step.dissipation, status))
    matrix = compliance(*materials[1], hole=False) - compliance(*materials[0], hole=True)
    runs = [incremental(matrix, mu, legs, count) for count in COUNTS]
    scale = {key: max(np.max(abs(getattr(state, key))) for state in expected) for key in LARGEST}
    scale["shift"], scale["rotation"], scale["moment"] = scale["approach"], scale["approach"] / RADIUS, RADIUS * max(legs[-1][:3])
    for key, limit in LARGEST.items():
        pairs = [[np.atleast_1d(getattr(ours, key) - getattr(state, key)) for ours, state in zip(run, expected)] for run in runs]
        error = np.array([np.linalg.norm(pair) for pair in pairs]) / scale[key]
        order = -np.polyfit(np.log(COUNTS), np.log(error + 1e-300), 1)[0]
        assert error[-1] < limit, (key, error)
        assert key not in ("pressure", "shear", "dissipation") or 0.7 < order < 1.7, (key, order, error)
    for ours, state in zip(runs[-1], expected):
        assert np.array_equal(ours.status, state.status)
    if legs[0].normal == 0:
        assert np.allclose(runs[0][0].pressure, expected[0].pressure, rtol=1e-12, atol=0)
