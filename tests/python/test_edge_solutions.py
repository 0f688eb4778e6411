"""The numbers with which src/algorithms/measures/zone_edges.f90 takes the error of the discretisation off tractions near an edge."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np

import mfv

SOURCE = Path(__file__).resolve().parents[2] / "src" / "stress" / "edge_solutions.f90"


def numbers(text: str, pattern: str) -> np.ndarray:
    """The real numbers in the part of a text that a pattern matches."""
    found = re.search(pattern, text, re.DOTALL)
    assert found, pattern
    return np.array([float(value) for value in re.findall(r"\d+\.\d+(?=_wp)", found[0])])


def solutions(power: float, nodes: int) -> tuple[float, np.ndarray, np.ndarray, np.ndarray]:
    """Offset, g(j), k(j) and h(j), j = 0 to nodes - 1, by Wiener and Hopf's method (docs/theory.md, edges between nodes)."""
    places, aliases, terms = 2**15, 300, 4000
    t = (np.arange(places) + 0.5) * 2 * np.pi / places - np.pi
    symbol = sum((-1.0) ** k / (abs(t + 2 * np.pi * k) * (t + 2 * np.pi * k)) for k in range(-aliases, aliases + 1))
    symbol = symbol * 2 * np.pi * np.sin(t / 2) + 0.5j * np.pi * np.tan(np.pi * (0.5 - power)) / np.tan(t / 2)
    z = np.exp(1j * t)
    logarithm = np.log(symbol) + (1 - power) * np.log(1 - z) + power * np.log(1 - 1 / z)
    number = np.arange(terms)
    series = (np.fft.fft(logarithm)[:terms] * np.exp(-1j * number * t[0])).real / places
    factor = np.zeros(nodes)  # exp(-sum of series[n] z^n, n > 0)
    factor[0] = 1.0
    for n in range(1, nodes):
        factor[n] = -sum(m * series[m] * factor[n - m] for m in range(1, n + 1)) / n

    def solution(exponent: float) -> np.ndarray:
        """That with the generating function factor(z) (1 - z)^-exponent: u^(exponent - 1)/gamma(exponent) far from the edge."""
        powers = np.cumprod([1.0, *((n - 1 + exponent) / n for n in range(1, nodes))])
        return np.convolve(factor, powers)[:nodes] / math.exp(-series[1:].sum())

    first, second = float(np.sum(number * series)), float(np.sum(number**2 * series))
    k, g, h = (solution(power + n) for n in range(3))
    # h without the terms u^m and u^(m-1) that its generating function brings.
    h = h - g / 2 - (1 / 8 - second / 2 - (2 + power) / 24) * k
    scales = [math.gamma(power + n) for n in range(3)]
    return (1 + power) / 2 + first, g * scales[1], k * scales[0], h * scales[2]


def test_tabulated_solutions() -> None:
    """Every number of the table, from the symbol of the equations."""
    text = SOURCE.read_text()
    ends = numbers(text, r"least_power = .*")[:2]
    table = numbers(text, r":: solutions\(numbers, powers\) = .*?\], &").reshape(-1, 15)
    assert len(table) == 7
    for power, row in zip(np.linspace(*ends, len(table)), table):
        offset, g, k, h = solutions(float(power), 5)
        np.testing.assert_allclose(row, [offset, *g, *k, *h[:4]], atol=1e-6, err_msg=str(power))


def test_solutions_far_from_the_edge() -> None:
    """They tend to the powers of the distance: k with the first order of its inverse, g and h, of no other power, with the second."""
    for power in (0.35, 0.5, 0.62):
        offset, g, k, h = solutions(power, 41)
        for found, exponent, order in ((k, power - 1, 1), (g, power, 2), (h, power + 1, 2)):
            errors = [abs(found[j] / (j + offset) ** exponent - 1) for j in (20, 40)]
            assert errors[1] < errors[0] * 2 ** -(order - 0.2), (power, exponent, errors)


def test_discrete_solution_is_that_of_hertz() -> None:
    """Pressures of a run over the exact ones, at the first ten nodes from the edge."""
    half_plane = mfv.Body.half_plane(shear_modulus=1.0, poisson_ratio=0.3)
    exact = float(mfv.reference.power_half_width(0.01, 1e-2, 2.0, 1.0, 3 - 4 * 0.3))
    for margin in (1.2, 1.213, 1.253):
        mesh = mfv.Mesh(nodes=801, half_width=margin * exact)
        steps = [mfv.Step(normal_force=0.01)]
        scene = mfv.Scene(
            half_plane, mfv.Body.power(1e-2, 2.0, rigid=True), mesh=mesh, friction=mfv.Friction(law="none"), steps=steps
        )
        state = mfv.run(scene).state
        touching = np.asarray(state.pressure) > 0
        x, pressure = np.asarray(state.x)[touching][:10], np.asarray(state.pressure)[touching][:10]
        distance = (x[0] + exact) / (x[1] - x[0])
        offset, g, k, _ = solutions(0.5, 10)
        found = pressure[1:] / (2 * 0.01 / (np.pi * exact) * np.sqrt(1 - (x[1:] / exact) ** 2))
        expected = (g[1:] + 0.5 * (distance - offset) * k[1:]) / np.sqrt(np.arange(1, 10) + distance)
        np.testing.assert_allclose(found, expected, atol=1e-4)
        assert max(abs(found - 1)) > 2e-4


def test_edges_are_exact_wherever_they_are_between_nodes() -> None:
    """Half-widths of three profiles, in intervals, with the edge anywhere between two nodes: 401 and 101 nodes."""
    kappa = 3 - 4 * 0.3
    half_plane = mfv.Body.half_plane(shear_modulus=1.0, poisson_ratio=0.3)
    shapes = [
        (mfv.Body.power(1e-2, 2.0, rigid=True), mfv.reference.power_half_width(0.01, 1e-2, 2.0, 1.0, kappa), 2e-4, 2e-3),
        (mfv.Body.power(1e-2, 4.0, rigid=True), mfv.reference.power_half_width(0.01, 1e-2, 4.0, 1.0, kappa), 2e-3, 1e-2),
        (
            mfv.Body.rounded_punch(0.5, 100.0, rigid=True),
            mfv.reference.rounded_punch_half_width(0.01, 0.5, 100.0, 1.0, kappa),
            5e-4,
            2e-3,
        ),
    ]
    for body, exact, fine, coarse in shapes:
        for nodes, bound in ((401, fine), (101, coarse)):
            errors = []
            for margin in (1.2, 1.213, 1.253, 1.31, 1.377, 1.41, 1.5):
                mesh = mfv.Mesh(nodes=nodes, half_width=margin * exact)
                scene = mfv.Scene(
                    half_plane, body, mesh=mesh, friction=mfv.Friction(law="none"), steps=[mfv.Step(normal_force=0.01)]
                )
                found = mfv.run(scene).observables.contact_half_width
                errors.append(abs(found - exact) / (2 * margin * exact / nodes))
            print(body.shape, body.exponent, nodes, max(errors))
            assert max(errors) < bound, (body.shape, nodes)


def test_edges_and_tension_with_full_coupling() -> None:
    """A rigid cylinder, pressed and sheared: edges within thousandths of an interval of a fine mesh's, the largest tension converges."""
    errors: dict[int, tuple[float, float]] = {}
    runs = {}
    for nodes in (1601, 101, 201, 401):
        scene = mfv.Scene(
            mfv.Body.half_plane(youngs_modulus=72100.0, poisson_ratio=0.33),
            mfv.Body.disk(10.0, rigid=True),
            mesh=mfv.Mesh(nodes=nodes, half_width=0.18275, gap="parabolic"),
            friction=mfv.Friction.coulomb(0.85),
            steps=[mfv.Step(normal_force=135.75, friction=False), mfv.Step(tangential_force=38.79)],
        )
        runs[nodes] = mfv.run(scene)
        seen, fine = runs[nodes].summary, runs[1601].summary
        interval = 2 * 0.18275 / nodes
        edge = max(abs(seen.contact_left - fine.contact_left), abs(seen.contact_right - fine.contact_right)) / interval
        errors[nodes] = (edge, abs(runs[nodes].observables.lower_tension / runs[1601].observables.lower_tension - 1))
    print(errors)
    assert errors[101][0] < 3e-3 and errors[201][0] < 1e-3 and errors[401][0] < 1e-3
    assert errors[101][1] < 4e-3 and errors[201][1] < 1e-3 and errors[401][1] < 2e-4


def alike(nodes: int, steps: list[mfv.Step]) -> mfv.Result:
    """A cylinder of radius 10 on a half-plane of the same material, mu = 0.5, without coupling."""
    alloy = {"youngs_modulus": 70000.0, "poisson_ratio": 0.3}
    bodies = mfv.Body.half_plane(**alloy), mfv.Body.disk(10.0, **alloy)
    mesh, friction = mfv.Mesh(nodes=nodes), mfv.Friction.coulomb(0.5)
    return mfv.Scene(*bodies, coupling="none", mesh=mesh, friction=friction, steps=steps).run(check=True)


def test_largest_tension_at_the_edge_of_a_former_contact() -> None:
    """Pressed further with dQ/dP < mu all sticks: the tension has a cusp where contact ended before (superposed ellipses)."""
    mu, force, shear, slope = 0.5, (100.0, 110.0), 30.0, -0.4
    modulus = 70000.0 / (1.0 - 0.3**2) / 2.0
    first, second = (math.sqrt(4.0 * p * 10.0 / (math.pi * modulus)) for p in force)
    stuck = first * math.sqrt(1.0 - shear / mu / force[0])
    # sigma_xx at x = -first under the shear sqrt(a^2 - x^2): 2 (|x| - sqrt(x^2 - a^2)) beside it, 2 |x| below it, so that the last
    # increment adds none.
    exact = modulus / 20.0 * (2.0 * mu * math.sqrt(first**2 - stuck**2) - math.sqrt(second**2 - first**2))
    errors = {}
    for nodes in (101, 201, 801):
        result = alike(
            nodes,
            [
                mfv.Step(normal_force=force[0], friction=False),
                mfv.Step(tangential_force=shear),
                mfv.Step(normal_force=force[1], tangential_force=shear + slope * (force[1] - force[0])),
            ],
        )
        x = np.linspace(-1.3, 1.3, 4001) * second
        seen = mfv.stress.stress(result, x, 0.0 * x).values["sigma_xx"].max()
        assert result.observables.lower_tension > 0.999 * seen, nodes
        errors[nodes] = result.observables.lower_tension / exact - 1.0
    print(exact, errors)
    assert abs(errors[101]) < 0.15 and abs(errors[201]) < 0.04 and abs(errors[801]) < 0.025


def test_stick_ratio_after_unequal_reversals() -> None:
    """The stick zone of the last half-cycle, not that of first loading beside it: sqrt(1 - range of Q/(2 mu P)) (Mindlin, Deresiewicz)."""
    errors = []
    for largest in (15.0, 25.0, 40.0):
        for ratio in np.arange(-0.95, 0.45, 0.1):
            steps = [mfv.Step(normal_force=100.0, friction=False), mfv.Step(tangential_force=largest)]
            result = alike(101, [*steps, mfv.Step(tangential_force=float(ratio) * largest, cycles=2)])
            exact = math.sqrt(1.0 - (1.0 - ratio) * largest / (2.0 * 0.5 * 100.0))
            for name in ("reversal", "return"):
                seen = result.observables[f"stick_ratio_{name}"]
                errors.append(abs(seen - exact) * 0.5 * result.summary.contact_nodes)  # in intervals at either edge
    print(max(errors), np.median(errors))
    assert max(errors) < 0.4 and np.median(errors) < 0.1
