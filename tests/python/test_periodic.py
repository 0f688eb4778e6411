"""Surfaces that repeat against closed forms (Westergaard's wave, Cattaneo's and Mindlin's problem on it, full contact), a dense matrix of
the Fourier series, half-planes as the period grows, and themselves moved along the surface."""

from __future__ import annotations

import math
import os
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import mfv
from mfv import Body, Friction, Mesh, Scene, Step

Numbers = NDArray[np.float64]
PERIOD, HEIGHT, MU = 2.0, 1.0e-3, 0.3
PLANE = {"youngs_modulus": 1.0, "poisson_ratio": 0.2}
#: E*, and the mean pressure of full contact.
MODULUS = 1 / (1 - 0.2**2)
FULL = math.pi * MODULUS * HEIGHT / PERIOD


def wave(share_of_full: float, nodes: int, steps: list[Step], coupling: str = "none", **mesh: Any) -> mfv.Result:
    """A rigid wave on a half-plane, pressed without friction by a share of the mean pressure of full contact."""
    scene = Scene(
        Body.half_plane(**PLANE),
        Body.wave(HEIGHT, PERIOD, rigid=True),
        steps=[Step(normal_force=share_of_full * FULL * PERIOD, friction=False), *steps],
        friction=Friction.coulomb(MU),
        mesh=Mesh(nodes=nodes, period=PERIOD, **mesh),
    )
    scene.coupling = coupling  # type: ignore[assignment]
    return scene.run(check=True)


@pytest.mark.parametrize("share", [0.2, 0.7])
def test_westergaards_wave_and_its_shearing(share: float) -> None:
    """Mean pressure p* sin^2(pi a/l); a stick zone of sin^2(pi c/l) = sin^2(pi a/l) (1 - Q/(mu P)). Edges and peaks converge."""
    force, form = share * FULL * PERIOD, (HEIGHT, PERIOD, 1 / (2 * 1.2), 3 - 4 * 0.2)
    contact = float(mfv.reference.wave_half_width(force, *form))
    ratio = float(mfv.reference.wave_stick_ratio(0.5 * MU * force, force, MU, *form))
    assert math.sin(math.pi * contact / PERIOD) ** 2 == pytest.approx(share, rel=1e-12)
    assert math.sin(math.pi * ratio * contact / PERIOD) ** 2 == pytest.approx(0.5 * share, rel=1e-12)
    errors = []
    for nodes in (128, 512):
        result = wave(share, nodes, [Step(force_ratio=0.5)])
        found = result.observables
        peak = float(mfv.reference.wave_pressure(0.0, force, *form))
        errors.append([found.contact_half_width / contact - 1, found.stick_ratio / ratio - 1, found.peak_pressure / peak - 1])
        pressure = mfv.reference.wave_pressure(result.mesh.x, force, *form)
        np.testing.assert_allclose(result.reference.pressure, pressure, rtol=0, atol=1e-12 * peak)
        assert np.max(np.abs(result.state.pressure - pressure)) < 0.7 * FULL / math.sqrt(nodes)
        assert np.sum(pressure * result.mesh.width) == pytest.approx(force, rel=2e-3)
    assert np.all(np.abs(errors[1]) < [2e-5, 5e-5, 1e-4]), errors
    assert np.all(np.abs(errors[0]) < [3e-4, 3e-4, 2e-3]), errors


@pytest.mark.parametrize("coupling", ["none", "full"])
def test_full_contact(coupling: str) -> None:
    """p = mean + p* cos(2 pi x/l), of the second order in the intervals; the approach of the mean pressure follows from the datum, the
    period by default. Sheared, all of it slips where mu p is small first, without a sharp edge at the ends of the period."""
    errors = []
    for nodes in (32, 64, 128):
        result = wave(1.5, nodes, [], coupling)
        x = result.mesh.x
        errors.append(np.max(np.abs(result.state.pressure - FULL * (1.5 + np.cos(2 * np.pi * x / PERIOD)))) / FULL)
        np.testing.assert_allclose(result.reference.pressure, FULL * (1.5 + np.cos(2 * np.pi * x / PERIOD)), rtol=1e-12)
        force = 1.5 * FULL * PERIOD
        approach = HEIGHT + force / (math.pi * MODULUS / 2) * math.log(2 * math.pi)
        assert result.summary.approach == pytest.approx(approach, rel=2e-3 * 32 / nodes)
    assert errors[0] < 3e-3 and errors[0] / errors[1] > 3.5 and errors[1] / errors[2] > 3.5
    sheared = wave(1.5, 128, [Step(force_ratio=0.9)], coupling)
    assert "the contact reaches the end" not in sheared.attributes["warnings"]
    assert sheared.observables.lower_tension > 0 and 0 < sheared.observables.stick_ratio < 1


def clausen(theta: Numbers) -> Numbers:
    """Cl2 by its power series, -2 pi < theta < 2 pi."""
    even = [math.pi**2 / 6, math.pi**4 / 90] + [float(np.sum(np.arange(1.0, 4000.0) ** (-2 * k))) for k in range(3, 80)]
    with np.errstate(divide="ignore", invalid="ignore"):
        logarithm = np.where(theta == 0.0, 0.0, theta * np.log(np.abs(theta)))
    terms = [zeta / (k * (2 * k + 1)) * (theta / (2 * np.pi)) ** (2 * k) for k, zeta in enumerate(even, 1)]
    return np.asarray(theta - logarithm + theta * np.sum(terms, axis=0))


def dense(scene: Scene, nodes: int) -> mfv.Result:
    """The same with the half-plane as a matrix: -ln|2 sin(pi x/l)| integrated by Clausen's function."""
    width, c = PERIOD / nodes, 2 * math.pi / PERIOD
    x = (np.arange(nodes) + 0.5) * width - PERIOD / 2
    # The nearest image.
    distance = x[:, None] - x[None, :]
    distance = distance - PERIOD * np.round(distance / PERIOD)
    direct = (clausen(c * (distance + width / 2)) - clausen(c * (distance - width / 2))) / c + width * math.log(2 * math.pi)
    odd = np.clip(2 * distance / width, -1, 1) - 2 * distance / PERIOD
    normal, coupled = 2 / MODULUS / math.pi * direct, 0.5 * (1 - 2 * 0.2) * (1 + 0.2) * width * odd
    total = np.block([[normal, coupled], [-coupled, normal]]) / width
    made = Scene(
        Body.matrix(x, compliance=total, width=np.full(nodes, width)), scene.upper, steps=scene.steps, friction=scene.friction
    )
    made.coupling = scene.coupling
    return made.run(check=True)


def rough(seed: int, move: float = 0.0) -> Scene:
    """A random surface of few waves, moved along x, under random forces: from little to full contact."""
    draw = np.random.default_rng(seed)
    x = np.linspace(-PERIOD / 2, PERIOD / 2, 1601)
    numbers = np.arange(1, 5)
    height = sum(
        draw.normal() * HEIGHT / number * np.cos(2 * np.pi * number * (x - move) / PERIOD + draw.uniform(0, 6.28))
        for number in numbers
    )
    force = FULL * PERIOD * draw.uniform(0.1, 1.2)
    steps = [Step(normal_force=force, friction=bool(seed % 2))]
    steps += [
        Step(normal_force=force * draw.uniform(0.7, 1.4), tangential_force=0.6 * MU * force * draw.uniform(-1, 1)) for _ in range(3)
    ]
    made = Scene(
        Body.half_plane(**PLANE),
        Body.profile(x, height - np.min(height), rigid=True, interpolation="monotone_cubic"),
        steps=steps,
        friction=Friction.coulomb(MU),
    )
    made.coupling = ("full", "full", "none", "goodman")[seed % 4]  # type: ignore[assignment]
    return made


def in_order(result: mfv.Result, name: str) -> Numbers:
    """A field from -l/2 to l/2. (The mesh begins where the gap is widest.)"""
    x = np.asarray(result.mesh.x)
    return np.asarray(result.state[name])[np.argsort(x - PERIOD * np.round(x / PERIOD))]


@pytest.mark.parametrize("seed", range(100 if os.environ.get("MFV_DEEP") else 12))
def test_a_dense_matrix_gives_the_same(seed: int) -> None:
    """Tractions to round-off and the same events, also where the contact spans the ends of the period."""
    nodes, scene = 48, rough(seed)
    other = dense(scene, nodes)
    scene.mesh = Mesh(nodes=nodes, period=PERIOD)
    one = scene.run(check=True)
    scale = np.max(other.state.pressure)
    for name in ("pressure", "shear"):
        np.testing.assert_allclose(in_order(one, name), other.state[name], rtol=0, atol=3e-12 * scale, err_msg=name)
    assert one.summary.events == other.summary.events
    for name in ("approach", "shift", "dissipation"):
        assert getattr(one.summary, name) == pytest.approx(getattr(other.summary, name), rel=1e-9, abs=1e-14), name


@pytest.mark.parametrize("seed", range(6))
def test_the_ends_of_the_period_are_nothing_special(seed: int) -> None:
    """A surface moved by whole intervals: the same tractions, observables, warnings and stresses, whatever spans the ends of the period.
    (The profile is interpolated between its points.)"""
    nodes, by = 80, 23
    results = []
    for move in (0.0, by * PERIOD / nodes):
        scene = rough(seed, move)
        scene.mesh = Mesh(nodes=nodes, period=PERIOD)
        results.append(scene.run(check=True))
    one, other = results
    scale = np.max(one.state.pressure)
    for name in ("pressure", "shear"):
        np.testing.assert_allclose(np.roll(in_order(one, name), by), in_order(other, name), rtol=0, atol=2e-3 * scale)
    assert set(one.observables) == set(other.observables)
    for name in ("dissipation", "stick_ratio", "contact_length", "patches", "peak_pressure", "peak_shear", "lower_tension"):
        if name in one.observables:
            assert other.observables[name] == pytest.approx(one.observables[name], rel=1e-2), name
    x = np.linspace(-2.0, 2.0, 33)
    for y in (0.0, -0.2):
        here = mfv.stress.stress(one, x, np.full_like(x, y))
        there = mfv.stress.stress(other, x + by * PERIOD / nodes, np.full_like(x, y))
        for name in ("sigma_xx", "sigma_yy", "sigma_xy"):
            np.testing.assert_allclose(there[name], here[name], rtol=0, atol=3e-2 * scale, err_msg=f"{name} at {y}")


@pytest.mark.parametrize("seed", range(4))
def test_two_periods_are_twice_one(seed: int) -> None:
    """The period and the forces doubled: the same tractions, twice the dissipation."""
    one = rough(seed)
    one.mesh = Mesh(nodes=40, period=PERIOD)
    two = rough(seed)
    x, height = np.asarray(two.upper.data["x"]), np.asarray(two.upper.data["height"])  # type: ignore[index]
    doubled = np.concatenate([x[:-1] - PERIOD / 2, x + PERIOD / 2])
    two.upper = Body.profile(doubled, np.concatenate([height[:-1], height]), rigid=True, interpolation="monotone_cubic")
    for step in two.steps:
        for name in ("normal_force", "tangential_force"):
            if getattr(step, name) is not None:
                setattr(step, name, 2 * getattr(step, name))
    two.mesh = Mesh(nodes=80, period=2 * PERIOD)
    first, second = one.run(check=True), two.run(check=True)
    assert second.summary.dissipation == pytest.approx(2 * first.summary.dissipation, rel=1e-4)
    assert np.max(second.state.pressure) == pytest.approx(np.max(first.state.pressure), rel=1e-4)
    assert np.max(np.abs(second.state.shear)) == pytest.approx(np.max(np.abs(first.state.shear)), rel=1e-4)


@pytest.mark.parametrize("nodes", [36, 54, 72, 78, 140])
def test_tension_in_full_contact_has_no_spikes(nodes: int) -> None:
    """Where images of the tractions meet, at the ends of the period, logarithms cancel."""
    found = wave(1.6, nodes, [Step(force_ratio=0.5)], "full").observables
    fine = wave(1.6, 400, [Step(force_ratio=0.5)], "full").observables
    assert found.lower_tension == pytest.approx(fine.lower_tension, rel=2e-2)


def test_open_surfaces_are_in_tension_without_shear() -> None:
    """Without mean strain: B/s11 times the mean pressure."""
    found = wave(0.5, 101, []).observables
    assert found.lower_tension == pytest.approx((1 - 2 * 0.2) / (1 - 0.2) * 0.5 * FULL, rel=1e-12)


def test_it_tends_to_half_planes_as_the_period_grows() -> None:
    """A cylinder with full coupling: the difference of the dissipation is of the order a/l."""

    def dissipation(**mesh: Any) -> float:
        scene = Scene(
            Body.half_plane(datum=1.0, **PLANE),
            Body.power(0.5, 2.0, rigid=True),
            steps=[Step(normal_force=1e-4), Step(force_ratio=0.5)],
            friction=Friction.coulomb(MU),
            mesh=Mesh(**mesh),
        )
        return float(scene.run(check=True).observables.dissipation)

    ends = (np.arange(82) - 40.5) * 1.3 * 0.0111 / 40.5
    alone = dissipation(ends=ends)
    differences = [abs(dissipation(ends=ends, period=period) / alone - 1) for period in (0.3, 3.0, 6.0)]
    assert differences[0] / differences[1] == pytest.approx(10.0, rel=0.1)
    assert differences[1] / differences[2] == pytest.approx(2.0, rel=0.02)


@pytest.mark.parametrize("refine", [{"refine": "edges", "nodes": 120}, {"nodes": 401}])
def test_unequal_intervals(refine: dict[str, Any]) -> None:
    """Small at the edges, and equal ones as fine: half-width and stick ratio."""
    found = wave(0.5, steps=[Step(force_ratio=0.5)], **refine).observables
    contact = PERIOD / math.pi * math.asin(math.sqrt(0.5))
    assert found.contact_half_width == pytest.approx(contact, rel=3e-5)
    assert found.stick_ratio == pytest.approx(PERIOD / math.pi * math.asin(0.5) / contact, rel=1e-4)


@pytest.mark.parametrize(
    ("lower", "upper", "mesh", "steps", "what"),
    [
        ({}, Body.disk(1.0, **PLANE), {}, [], "needs elasticity='half_plane' with period"),
        ({}, Body.disk(1.0, rigid=True), {"half_width": 0.5}, [], "half_width=0.5: has no effect with period"),
        ({"datum": 0.2}, Body.disk(1.0, rigid=True), {}, [], "must be above the period over 2 pi, 0.31831"),
        ({}, Body.disk(1.0, rigid=True), {}, [Step(moment=1.0)], "has no effect that repeats"),
        ({}, Body.disk(1.0, rigid=True), {}, [Step(lower_bulk_stress=1.0)], "has no effect that repeats"),
        ({}, Body.wave(0.1, 0.9, rigid=True), {}, [], "must be a whole number of wavelengths of body 2, 0.9"),
        ({}, Body.disk(1.0, rigid=True), {"ends": [-1.5, 0.0, 0.5]}, [], "must be within half a period, 1"),
    ],
)
def test_what_does_not_repeat_is_refused(lower: Any, upper: Body, mesh: Any, steps: list[Step], what: str) -> None:
    scene = Scene(
        Body.half_plane(**PLANE, **lower), upper, steps=[Step(normal_force=1e-3), *steps], mesh=Mesh(period=PERIOD, **mesh),
        friction=Friction.coulomb(0.3),
    )  # fmt: skip
    with pytest.raises(mfv.errors.InputError, match=what):
        scene.run()


def test_a_smooth_profile_has_no_kink_where_periods_meet() -> None:
    """A wave of few points, its crest where the periods meet or in the middle: the same pressures and warnings."""
    found = []
    for phase in (0.0, math.pi):
        x = np.linspace(-PERIOD / 2, PERIOD / 2, 17)
        height = HEIGHT * (1 - np.cos(2 * np.pi * x / PERIOD + phase))
        upper = Body.profile(x, height - height.min(), rigid=True, interpolation="monotone_cubic")
        steps = [Step(normal_force=0.5 * FULL * PERIOD)]
        found.append(
            Scene(Body.half_plane(**PLANE), upper, steps=steps, mesh=Mesh(nodes=320, period=PERIOD), coupling="none").run()
        )
    one, other = found
    np.testing.assert_allclose(np.sort(one.state.pressure), np.sort(other.state.pressure), rtol=0, atol=1e-9 * FULL)
    assert len(one.attributes["warnings"].splitlines()) == len(other.attributes["warnings"].splitlines()) > 0


def test_full_contact_of_an_incompressible_layer_by_every_solver() -> None:
    """Any pressure that is the same everywhere presses such a layer on a rigid base by nothing: the force alone says how large it is."""
    layer = mfv.Layer(thickness=0.3, shear_modulus=3000.0, poisson_ratio=0.5)
    found = []
    for solver in ("auto", "reduced", "dgesv", "fft"):
        scene = Scene(
            Body.half_plane(rigid=True, layers=[layer]),
            Body.wave(1e-4, 1.0, rigid=True),
            mesh=Mesh(nodes=60, period=1.0),
            friction=Friction.coulomb(0.5),
            solver=mfv.Solver(linear_solver=solver),
            steps=[Step(normal_force=20.0), Step(tangential_force=0.2), Step(tangential_force=-0.2, cycles=2)],
        )
        found.append(scene.run(check=True))
    for result in found:
        assert np.all(result.state.pressure > 0.0)
        assert np.mean(result.state.pressure) == pytest.approx(20.0, rel=1e-12)
        np.testing.assert_allclose(result.state.pressure, found[2].state.pressure, rtol=1e-9)
        np.testing.assert_allclose(result.state.shear, found[2].state.shear, atol=1e-9 * 20.0)
        assert result.summary.events == found[2].summary.events
