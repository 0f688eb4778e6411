"""Self-affine surfaces, their parameters, and the contact of rough surfaces."""

from __future__ import annotations

import os
from typing import Any

import numpy as np
import pytest

import mfv
from mfv import Body, Friction, Mesh, Output, Scene, Step, surfaces

pytest.importorskip("SurfaceTopography")

LENGTH, WAVES = 10.0, 40


def surface(points: int = 640, seed: int = 1, **options: Any) -> mfv.profiles.Profile:
    """One of 40 of the shortest waves in the period."""
    given: dict[str, Any] = {"hurst": 0.8, "rms_slope": 0.1, "roll_off": 2.0, "cut_off": LENGTH / WAVES, "seed": seed}
    return surfaces.self_affine(points, LENGTH, **(given | options))


def pressed(profile: mfv.profiles.Profile, *steps: Step, period: bool = True) -> mfv.Result:
    """The surface on a half-plane."""
    mesh = Mesh(nodes=profile.x.size - 1, period=LENGTH) if period else Mesh(nodes=profile.x.size)
    lower, upper = Body.half_plane(youngs_modulus=1.0, poisson_ratio=0.0), Body.profile(profile.x, profile.height, rigid=True)
    return mfv.run(Scene(lower, upper, mesh=mesh, friction=Friction.coulomb(0.3), steps=list(steps), coupling="none"))


def test_a_seed_gives_one_surface_also_on_more_points() -> None:
    coarse, fine = surface(640), surface(1280)
    assert coarse.x[0] == -LENGTH / 2 and coarse.x[-1] == LENGTH / 2 and coarse.height[0] == coarse.height[-1]
    assert coarse.height.min() == 0.0
    difference = (fine.height[::2] - fine.height[::2].mean()) - (coarse.height - coarse.height.mean())
    assert np.ptp(difference) < 1e-12
    assert not np.allclose(surface(seed=2).height, coarse.height)


def test_the_spectrum_is_what_was_asked_for() -> None:
    """Means over realisations: the slope, the power law from the roll-off to the shortest wave, nothing beyond."""
    slopes, spectra = [], []
    for seed in range(200):
        profile = surface(seed=seed)
        slopes.append(surfaces.roughness(profile.x[:-1], profile.height[:-1]).slope ** 2)
        spectra.append(np.abs(np.fft.rfft(profile.height[:-1])) ** 2)
    assert np.sqrt(np.mean(slopes)) == pytest.approx(0.1, rel=0.05)
    spectrum, wave = np.mean(spectra, axis=0), np.arange(321)
    assert spectrum[WAVES + 2 :].max() < 1e-20 * spectrum[1]
    inside = slice(6, WAVES - 1)
    exponent = np.polyfit(np.log(wave[inside]), np.log(spectrum[inside]), 1)[0]
    assert exponent == pytest.approx(-1.0 - 2.0 * 0.8, abs=0.1)
    assert spectrum[1] / spectrum[4] == pytest.approx(1.0, abs=0.5)


def test_parameters_of_a_wave() -> None:
    x = np.arange(1000) / 1000
    found = surfaces.roughness(x, 0.01 * np.cos(2 * np.pi * 5 * x))
    wave = 2 * np.pi * 5
    assert found.height == pytest.approx(0.01 / np.sqrt(2), rel=1e-3)
    assert found.slope == pytest.approx(0.01 * wave / np.sqrt(2), rel=1e-2)
    assert found.curvature == pytest.approx(0.01 * wave**2 / np.sqrt(2), rel=1e-2)


def test_contact_of_all_states() -> None:
    steps = [Step(normal_force=force, friction=False) for force in (0.05, 0.1, 0.2)] + [
        Step(force_ratio=0.5),
        Step(force_ratio=0.9),
    ]
    result = pressed(surface(), *steps)
    found = surfaces.contact(result)
    assert list(found.step) == [1, 2, 3, 4, 5]
    assert np.allclose(found.normal_force, [0.05, 0.1, 0.2, 0.2, 0.2])
    assert np.all(np.diff(found.contact_length[:3]) > 0.0) and np.ptp(found.contact_length[2:]) < 1e-9
    assert np.allclose(found.mean_pressure, found.normal_force / found.contact_length)
    assert np.isnan(found.stick_fraction[:3]).all() and 1.0 > found.stick_fraction[3] > found.stick_fraction[4] > 0.0
    assert found.dissipation[4] > found.dissipation[3] > 0.0
    lengths = surfaces.patch_lengths(result.state)
    assert lengths.sum() == pytest.approx(found.contact_length[-1], rel=1e-12) and np.all(lengths > 0.0)
    at_nodes = surfaces.pressures(result.state)
    assert at_nodes.size == result.summary.contact_nodes and at_nodes.max() == found.largest_pressure[-1]
    picture = surfaces.figure(result)
    assert len(picture.axes) == 7
    lower, upper = Body.half_plane(youngs_modulus=1.0, poisson_ratio=0.0), Body.disk(1.0, rigid=True)
    empty = mfv.run(Scene(lower, upper, steps=[Step(normal_force=0.1)], output=Output(states="none")))
    with pytest.raises(ValueError, match="no states"):
        surfaces.contact(empty)


def test_uncoupled_shear_by_superposition() -> None:
    """Ciavarella and Jaeger for any patches: the shear is mu times the pressures less those of a smaller load, on the stick zone."""
    share = 0.6
    whole = pressed(surface(), Step(normal_force=0.1), Step(force_ratio=share))
    inner = pressed(surface(), Step(normal_force=0.1 * (1.0 - share), friction=False))
    expected = 0.3 * (whole.state.pressure - inner.state.pressure)
    assert np.abs(whole.state.shear - expected).max() < 1e-11 * whole.state.pressure.max()
    assert np.array_equal(whole.state.status == mfv.NodeStatus.STICK, inner.state.status != mfv.NodeStatus.OPEN)
    assert whole.summary.events == 0


@pytest.mark.parametrize("seed", range(10, 30))
def test_a_press_without_coupling_leaves_no_shear(seed: int) -> None:
    """Also where nodes leave and touch again as the statuses are found."""
    assert not np.any(pressed(surface(320, seed=seed), Step(normal_force=0.1)).state.shear)


def test_narrow_stick_zones_are_one_warning() -> None:
    """However many of them there are."""
    result = pressed(surface(seed=2, cut_off=LENGTH / 80), Step(normal_force=0.1), Step(force_ratio=0.8))
    found = [warning for warning in result.warnings if "stick zones" in warning]
    assert len(found) == 1 and found[0].startswith("3 of 13 stick zones have only one or two nodes, the first near x = -0.07")


def check_against_events(points: int, seed: int, coupling: str, force: float = 0.1) -> None:
    """States after shear and a cycle, exactly as by events. Without coupling below 64 nodes in contact each leg is one increment."""
    profile = surface(points, seed=seed, cut_off=8 * LENGTH / points)
    lower, upper = Body.half_plane(youngs_modulus=1.0, poisson_ratio=0.3), Body.profile(profile.x, profile.height, rigid=True)
    steps = [Step(normal_force=force), Step(force_ratio=0.6), Step(force_ratio=-0.6, cycles=1)]
    mesh = Mesh(nodes=points, period=LENGTH)
    scene = Scene(lower, upper, mesh=mesh, friction=Friction.coulomb(0.3), steps=steps, coupling=coupling)
    found = mfv.run(scene)
    scene.solver = mfv.Solver(stepping="event", linear_solver="reduced")
    expected = mfv.run(scene)
    assert np.array_equal(found.state.status, expected.state.status)
    assert np.abs(found.state.shear - expected.state.shear).max() < 1e-9 * expected.state.pressure.max()
    assert found.summary.dissipation == pytest.approx(expected.summary.dissipation, rel=1e-8)


@pytest.mark.parametrize("coupling", ["none", "full"])
@pytest.mark.parametrize("seed", range(4))
def test_random_surfaces_against_events(seed: int, coupling: str) -> None:
    check_against_events(320, seed, coupling)


@pytest.mark.parametrize("seed", range(8))
def test_few_nodes_against_events(seed: int) -> None:
    check_against_events(384, seed, "none", force=0.03)


@pytest.mark.skipif("MFV_DEEP" not in os.environ, reason="takes minutes: MFV_DEEP=1")
@pytest.mark.parametrize("seed", range(30))
def test_many_surfaces_against_events(seed: int) -> None:
    check_against_events(2048, seed, "none")


@pytest.mark.parametrize("seed", range(2))
def test_coupled_surfaces_by_large_increments(seed: int) -> None:
    """Root mean squares of the tractions, dissipation and stick ratios within the accuracy, against events."""
    points, accuracy = 2048, 1e-2
    profile = surface(points, seed=seed, cut_off=8 * LENGTH / points)
    lower, upper = Body.half_plane(youngs_modulus=1.0, poisson_ratio=0.3), Body.profile(profile.x, profile.height, rigid=True)
    steps = [Step(normal_force=0.15), Step(force_ratio=0.6), Step(force_ratio=-0.6, cycles=1)]
    scene = Scene(lower, upper, mesh=Mesh(nodes=points, period=LENGTH), friction=Friction.coulomb(0.3), steps=steps)
    scene.solver = mfv.Solver(accuracy=accuracy)
    found = mfv.run(scene)
    scene.solver = mfv.Solver(stepping="event")
    expected = mfv.run(scene)
    assert found.summary.leaps > 0 and found.summary.events < 0.3 * expected.summary.events
    for one, other in zip(found.steps, expected.steps, strict=True):
        wrong = np.hypot(one.pressure - other.pressure, one.shear - other.shear)
        tractions = np.hypot(other.pressure, other.shear)
        assert np.linalg.norm(wrong) < accuracy * np.linalg.norm(tractions)
        assert one.contact_length == pytest.approx(other.contact_length, rel=accuracy)
    assert np.asarray(found.cycles.dissipation) == pytest.approx(np.asarray(expected.cycles.dissipation), rel=accuracy)


def test_mean_and_bar() -> None:
    mean, bar = surfaces.mean_and_bar([1.0, 2.0, 3.0, 4.0])
    assert mean == 2.5 and bar == pytest.approx(3.182446 * np.sqrt(5.0 / 3.0) / 2.0, rel=1e-6)
    assert np.isnan(surfaces.mean_and_bar([1.0])[1])


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"rms_height": 1.0}, "one of rms_height and rms_slope"),
        ({"rms_slope": None}, "one of rms_height and rms_slope"),
        ({"hurst": 1.5}, "hurst must be above 0 and at most 1, not 1.5"),
        ({"cut_off": 0.001}, "cut_off 0.001 is shorter than two of the 640 points"),
        ({"roll_off": 0.1}, "roll_off 0.1 is shorter than cut_off"),
        ({"rms_slope": -1.0}, "rms_slope must be a number above 0"),
        ({"points": 2}, "points must be at least 4"),
    ],
)
def test_what_is_refused(options: dict[str, Any], message: str) -> None:
    with pytest.raises(mfv.MfvError, match=message):
        surface(**options)
    with pytest.raises(mfv.MfvError, match="equal distances"):
        surfaces.roughness([0.0, 1.0, 3.0, 4.0], [0.0, 1.0, 0.0, 1.0])
