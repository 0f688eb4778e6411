"""Contact histories solved by another method, in numpy alone, and small ones by hand, against the library.

The conventional way: load increments, and in each the normal and the tangential problem in turn with the friction
bounds lagged (Panagiotopoulos 1975) until neither changes. Nothing of the library is in it but the formulas of the half-plane.
Its error is proportional to the increment; MFV has none, so the difference has to vanish at first order.
"""

from __future__ import annotations

from collections import namedtuple

import numpy as np
import pytest

import mfv
from mfv import NodeStatus

MODULUS, DATUM, FORCE = 1.7, 0.9, 0.015
HALF_WIDTH = {"disk": 0.1, "flat_punch": 0.4}
#: Relative differences allowed at 256 load steps a leg, one and a half to three times those measured.
LARGEST = {"pressure": 2e-4, "shear": 2e-3, "approach": 3e-6, "shift": 1e-4, "dissipation": 4e-4}


State = namedtuple("State", [*LARGEST, "stick"])  # a contact at the end of a leg of its load history


def half_plane(shape: str, nodes: int, nu: float, coupling: str = "full") -> tuple[np.ndarray, ...]:
    """Nodes; gaps; w by p (and u by tau), w by tau, u by p, zero at the distance DATUM; plane strain."""
    dx = 2 * HALF_WIDTH[shape] / nodes
    x = (np.arange(nodes) - (nodes - 1) / 2) * dx
    distance, kappa = x[:, None] - x, 3 - 4 * nu
    left, right = distance - dx / 2, distance + dx / 2
    integral = right * (np.log(DATUM / abs(right)) + 1) - left * (np.log(DATUM / abs(left)) + 1)  # of ln(DATUM/|x|)
    direct = (kappa + 1) / (4 * np.pi * MODULUS) * integral
    cross = (kappa - 1) / (8 * MODULUS) * 2 * np.clip(distance, -dx / 2, dx / 2)
    gap = x**2 / 2 if shape == "disk" else 0 * x
    return x, gap, direct, cross * (coupling == "full"), -cross * (coupling != "none")


def bounded(matrix, offset, low, high, total, side):
    """Tractions t between bounds, with a given sum, and the rigid motion c for which v = matrix t + offset - c is zero
    inside the bounds, >= 0 at the lower and <= 0 at the upper one; by active sets. `side`: -1, 0, 1, where to begin.
    """
    for _ in range(100):
        free = side == 0
        t = np.select([side < 0, side > 0], [low, high], 0.0)
        system = np.block([[matrix[np.ix_(free, free)], -np.ones((free.sum(), 1))], [np.ones(free.sum()), 0.0]])
        solution = np.linalg.solve(system, np.append(-(matrix @ t + offset)[free], total - t.sum()))
        t[free], c = solution[:-1], solution[-1]
        v = matrix @ t + offset - c
        after = np.where(free, 1 * (t > high) - (t < low), np.where(side * v > 1e-15, 0, side))
        if np.array_equal(after, side):
            return t, c, v, side
        side = after
    raise AssertionError("the active sets do not settle")


def incremental(gap, direct, by_shear, by_pressure, mu, dx, legs, steps) -> list[State]:
    """States at the ends of the legs (P, Q) of a load history, each divided into this many implicit load steps."""
    zero, infinite = 0 * gap, gap + np.inf
    shear, slip, contact, dissipation, start = zero, zero, np.zeros(gap.size, int), 0.0, np.zeros(2)
    states = []
    for leg in np.array(legs):
        for part in np.arange(1, steps + 1) / steps:
            normal, tangential = (start + part * (leg - start)) / dx
            for _ in range(200):
                before = shear
                p, approach, _, contact = bounded(direct, gap + by_shear @ shear, zero, infinite, normal, contact)
                side = np.where(p > 0, 0, -1)
                shear, shift, slipped, side = bounded(direct, by_pressure @ p - slip, -mu * p, mu * p, tangential, side)
                if abs(shear - before).max() < 1e-12 * p.max():
                    break
            else:
                raise AssertionError("pressure and shear do not settle")
            dissipation -= dx * shear @ slipped
            slip = slip + slipped
        start = leg
        states.append(State(p, shear, approach, shift, dissipation, (p > 0) & (side == 0)))
    return states


def case(shape: str, nodes: int, nu: float, mu: float, steps: list[tuple[str, float]], coupling: str = "full") -> str:
    """Namelist of a disk of radius 1 (parabolic gap) or a flat punch; `steps`: loads and targets."""
    size, gap = ("radius=1.0", "gap='parabolic'") if shape == "disk" else (f"half_width={HALF_WIDTH[shape]}", "")
    return (
        f"&scene coupling='{coupling}' /\n&friction law='coulomb', mu={mu} /\n"
        f"&body shape='half_plane', shear_modulus={MODULUS}, poisson_ratio={nu}, datum={DATUM} /\n"
        f"&body shape='{shape}', {size}, rigid=.true. /\n&mesh nodes={nodes}, half_width={HALF_WIDTH[shape]}, {gap} /\n"
    ) + "".join(f"&step {load}={target:.17g} /\n" for load, target in steps)


def solved(text: str) -> mfv.Result:
    """The library's result of a case that has to come to its end, with a certificate."""
    result = mfv.run(text=text)
    assert result.outcome == "complete", result.message
    assert result.certificate.largest < 1e-12
    return result


def check_history(shape: str, nodes: int, coupling: str, nu: float, mu: float, exact: set[str], levels: int) -> None:
    """Press, shear, shear back, unload while shearing: equal to round-off in the quantities for which a load step of
    any size is exact; in the others with an error that falls with the first power of the load step.
    """
    shear = 0.6 * mu * FORCE
    legs = [(FORCE, 0.0), (FORCE, shear), (FORCE, -shear), (0.7 * FORCE, shear)]
    steps = [(f"normal_force={normal:.17g}, tangential_force", tangential) for normal, tangential in legs]
    result = solved(case(shape, nodes, nu, mu, steps, coupling))
    assert all(step.stick_nodes >= 4 and step.slip_nodes >= 7 for step in result.steps[1:])
    x, *model = half_plane(shape, nodes, nu, coupling)
    counts = 2 ** np.arange(2, 2 + levels)
    runs = [list(zip(incremental(*model, mu, x[1] - x[0], legs, count), result.steps)) for count in counts]
    for run in runs[-2:]:
        assert all(np.array_equal(ours.stick, step.status == NodeStatus.STICK) for ours, step in run)
    scale = {name: max(np.max(abs(step[name])) for step in result.steps) for name in LARGEST}
    scale["dissipation"] = scale["shift"] * shear
    for name in LARGEST:
        error = np.array([max(np.max(abs(getattr(ours, name) - step[name])) for ours, step in run) for run in runs])
        error /= scale[name]
        if name in exact:
            assert error.max() < 1e-11, name
        else:
            order = -np.polyfit(np.log(counts), np.log(error), 1)[0]
            assert 0.8 < order < 1.5 and error[-1] < LARGEST[name] * 256 / counts[-1], (name, order, error)


@pytest.mark.parametrize(("nu", "mu"), [(0.3, 0.3), (0.0, 0.7)])
@pytest.mark.parametrize("coupling", ["full", "goodman", "none"])
def test_disk(coupling: str, nu: float, mu: float) -> None:
    exact = {"full": set(), "goodman": {"pressure", "approach"}, "none": {*LARGEST} - {"dissipation"}}[coupling]
    check_history("disk", 35, coupling, nu, mu, exact, levels=7 if nu == 0.0 else 6)


@pytest.mark.parametrize(("nu", "mu"), [(0.3, 0.3), (0.0, 0.7)])
@pytest.mark.parametrize("coupling", ["full", "goodman"])  # with none every node of a punch sticks up to gross sliding
def test_punch(coupling: str, nu: float, mu: float) -> None:
    check_history("flat_punch", 25, coupling, nu, mu, {*LARGEST} - {"dissipation"}, levels=5)


@pytest.mark.parametrize("nodes", [24, 41])
@pytest.mark.parametrize("shape", ["disk", "flat_punch"])
def test_frictionless(shape: str, nodes: int) -> None:
    """One linear complementarity problem."""
    result = solved(case(shape, nodes, 0.3, 0.0, [("normal_force", FORCE)]))
    x, gap, direct, *_ = half_plane(shape, nodes, 0.3)
    p, approach, opened, _ = bounded(direct, gap, 0 * x, x + np.inf, FORCE / (x[1] - x[0]), np.zeros(nodes, int))
    assert (p > 0).all() == (shape == "flat_punch")
    assert result.state.pressure == pytest.approx(p, abs=1e-12 * p.max())
    assert result.state.gap == pytest.approx(opened, abs=1e-12 * approach)
    assert result.summary.approach == pytest.approx(approach, rel=1e-12)


def test_one_node_by_hand() -> None:
    """A spring and a slider: sticks up to U = c mu p, then slips at the full traction; forth and back."""
    a, mu = HALF_WIDTH["flat_punch"], 0.4
    c = 3.2 / (4 * np.pi * MODULUS) * 2 * a * (np.log(DATUM / a) + 1)
    p = FORCE / (2 * a)
    moves = [("normal_force", FORCE), *(("shift", factor * c * mu * p) for factor in (0.5, 3, -3))]
    steps = solved(case("flat_punch", 1, 0.2, mu, moves)).steps
    assert [step.approach / (c * p) for step in steps] == pytest.approx([1, 1, 1, 1], rel=1e-13)
    assert [step.shear[0] / (mu * p) for step in steps] == pytest.approx([0, 0.5, 1, -1], rel=1e-13)
    assert [step.slip[0] / (c * mu * p) for step in steps] == pytest.approx([0, 0, -2, 2], abs=1e-13)
    assert [step.dissipation / (c * mu * p * mu * FORCE) for step in steps] == pytest.approx([0, 0, 2, 6], abs=1e-13)
    beyond = mfv.run(text=case("flat_punch", 1, 0.2, mu, [moves[0], ("tangential_force", 1.1 * mu * FORCE)]))
    assert beyond.outcome == "gross sliding"
    assert beyond.summary.tangential_force == pytest.approx(mu * FORCE, rel=1e-13)


@pytest.mark.parametrize("mu", [0.2, 0.5])
def test_two_nodes_by_hand(mu: float) -> None:
    """Pressed: both stick for mu > b = cross/(near - far), or slip inwards. Then sheared: the right one slips first."""
    h = HALF_WIDTH["flat_punch"] / 2
    direct, cross = 2.8 / (4 * np.pi * MODULUS), 0.8 / (4 * MODULUS) * h
    near = direct * 2 * h * (np.log(DATUM / h) + 1)
    far = direct * h * (3 * np.log(DATUM / (3 * h)) - np.log(DATUM / h) + 2)
    b, p = cross / (near - far), FORCE / (4 * h)
    inward = min(mu, b) * p
    slip = cross * p - (near - far) * inward
    pressed = solved(case("flat_punch", 2, 0.3, mu, [("normal_force", FORCE)])).steps[0]
    assert pressed.shear == pytest.approx(np.array([-inward, inward]), rel=1e-13)
    assert pressed.slip == pytest.approx(np.array([slip, -slip]), abs=1e-14 * cross * p)
    assert pressed.approach == pytest.approx((near + far) * p - cross * inward, rel=1e-13)
    assert pressed.dissipation == pytest.approx(2 * h * inward * slip, abs=1e-14 * cross * p * p)
    if mu < b:
        return
    first, force = 4 * h * p * (mu - b) / (1 + mu * b), 0.8 * mu * FORCE
    loads = [("normal_force", FORCE), *(("tangential_force", q) for q in (0.999 * first, 1.001 * first, force))]
    _, before, after, end = solved(case("flat_punch", 2, 0.3, mu, loads)).steps
    assert [*before.status, *after.status] == 3 * [NodeStatus.STICK] + [NodeStatus.SLIP_LEFT]
    pressure = p + b * force / (4 * h) * np.array([1, -1])
    shear = np.array([force / (2 * h) - mu * pressure[1], mu * pressure[1]])
    shift = cross * pressure[1] + near * shear[0] + far * shear[1]
    slip = near * shear[1] + far * shear[0] - cross * pressure[0] - shift
    assert slip < -0.1 * shift
    assert end.pressure == pytest.approx(pressure, rel=1e-13) and end.shear == pytest.approx(shear, rel=1e-13)
    assert end.shift == pytest.approx(shift, rel=1e-12) and end.slip[1] == pytest.approx(slip, rel=1e-12)
    mean = 0.5 * (mu * (p - b * first / (4 * h)) + shear[1])
    assert end.dissipation == pytest.approx(-2 * h * mean * slip, rel=1e-12)


def michell(nodes: int, step: float, nu: float, hole: bool, terms: int = 20000) -> np.ndarray:
    """Displacement into a body, times G/R, by a unit pressure on the angle `step`, at this many distances: Michell's
    series, and of n = 1 what is no translation, the part without u_theta (dissertation tables 4.2, 4.3, E.1).
    """
    n, kappa, a = np.arange(2, terms), 3 - 4 * nu, step / 2
    first, second = (1, kappa) if hole else (kappa, 1)
    angle = np.arange(nodes) * step
    series = np.cos(np.outer(angle, n)) @ (np.sin(n * a) / n * (first / (n + 1) + second / (n - 1)))
    zeroth = a if hole else (kappa - 1) * a / 2
    once = 2 if hole else (kappa * (kappa - 3) + kappa**2 + kappa - 4) / (kappa + 1)
    return (series + zeroth + once * np.sin(a) / 2 * np.cos(angle)) / (2 * np.pi)


@pytest.mark.parametrize("datum", [0.3, 50.0])
def test_smooth_pin(datum: float) -> None:
    """A pin in a bore of a radius 5 % larger, in contact over 47 degrees: forces on common angles, by active sets."""
    nodes, bore, force, moduli, ratios = 61, 1.05, 0.02, (0.4, 0.9), (0.3, 0.1)
    text = "".join(
        f"&body shape='{shape}', radius={radius}, shear_modulus={modulus}, poisson_ratio={nu}, datum={datum} /\n"
        for shape, radius, modulus, nu in zip(("hole", "disk"), (bore, 1.0), moduli, ratios)
    )
    result = solved(text + f"&mesh nodes={nodes}, half_angle=51.5, normals='radial' /\n&step normal_force={force} /\n")
    step = 2 * np.radians(51.5) / nodes
    angle = (np.arange(nodes) - (nodes - 1) / 2) * step
    distance = np.abs(np.arange(nodes)[:, None] - np.arange(nodes))
    kernels = [michell(nodes, step, nu, hole) / g for g, nu, hole in zip(moduli, ratios, (True, False))]
    matrix = bore * sum(kernels)[distance]
    play = bore - 1
    gap = play * (1 - np.cos(angle)) + 1 - np.sqrt(1 - (play * np.sin(angle)) ** 2)
    touches, normal = abs(angle) < 0.3, np.cos(angle)
    for _ in range(20):
        system = np.block([[matrix[np.ix_(touches, touches)], -normal[touches, None]], [normal[touches], 0.0]])
        solution = np.linalg.solve(system, np.append(-gap[touches], force / (bore * step)))
        pressure = np.zeros(nodes)
        pressure[touches] = solution[:-1]
        after = np.where(touches, pressure > 0, gap + matrix @ pressure < solution[-1] * normal)
        if np.array_equal(after, touches):
            break
        touches = after
    else:
        raise AssertionError("the active set does not settle")
    assert 30 < touches.sum() < nodes - 2
    assert np.allclose(result.state.pressure, pressure, rtol=0, atol=1e-6 * pressure.max())
