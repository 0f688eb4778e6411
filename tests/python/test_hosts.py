"""The scipy host of examples/hosts against closed forms of its own: Hertz, Ciavarella and Jaeger, Masing."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from scenes import PROJECT
from scipy.integrate import quad
from scipy.optimize import brentq

PATH = PROJECT / "examples" / "hosts" / "scipy_host.py"

#: The cylinder on the half-plane: shear modulus, Poisson's ratio, radius, which is the distance of the datum too.
G, NU, R = 1.0, 0.3, 0.25


@pytest.fixture(scope="module")
def host() -> ModuleType:
    """The example, imported."""
    spec = importlib.util.spec_from_file_location("scipy_host", PATH)
    module = importlib.util.module_from_spec(spec)
    sys.modules["scipy_host"] = module
    spec.loader.exec_module(module)
    return module


def approach(force: float) -> float:
    """Approach of a rigid cylinder, measured from the surface at the distance R (the slope of Hertz's surface, integrated)."""
    a2 = 2.0 * force * R * (1.0 - NU) / (np.pi * G)
    if a2 == 0.0:
        return 0.0
    s = np.sqrt(R**2 - a2)
    return (R**2 - R * s + a2 * np.log((R + s) / np.sqrt(a2))) / (2.0 * R)


def shift(force: float, mu: float, weight: float) -> float:
    """Shift under a growing tangential force: mu times the approach that the slipping part takes away (Ciavarella, Jaeger)."""
    return mu * (approach(weight) - approach(weight - force / mu))


def test_two_contacts_in_series_follow_the_closed_form(host: ModuleType) -> None:
    series = host.Series(host.contact(0.5), host.contact(0.7))
    for top in (2.0e-4, 5.0e-4, 8.0e-4):
        force = series.shift_top(top)
        expected = sum(shift(force, mu, host.WEIGHT) for mu in (0.5, 0.7))
        assert top == pytest.approx(expected, rel=5e-4)
        for case, mu in ((series.lower, 0.5), (series.upper, 0.7)):
            loads = case.loads
            assert loads.tangential_force == pytest.approx(force, rel=1e-6)
            assert loads.normal_force == pytest.approx(host.WEIGHT, rel=1e-8)
            edges = case["summary/stick_ratio"]
            assert edges == pytest.approx(np.sqrt(1.0 - force / (mu * host.WEIGHT)), abs=2e-3)
    turned, at = force, top
    for top in (4.0e-4, -3.0e-4):  # unloading: twice the shift at half the change of the force (Masing)
        force = series.shift_top(top)
        expected = sum(2.0 * shift(0.5 * (turned - force), mu, host.WEIGHT) for mu in (0.5, 0.7))
        assert at - top == pytest.approx(expected, rel=5e-4)


def test_the_tangent_saves_evaluations_and_leads_to_the_same_forces(host: ModuleType) -> None:
    tops = np.linspace(1.0e-4, 8.0e-4, 8)
    joints = [host.Series(host.contact(0.5), host.contact(0.7), with_tangent) for with_tangent in (True, False)]
    forces = [[joint.shift_top(top) for top in tops] for joint in joints]
    np.testing.assert_allclose(forces[0], forces[1], rtol=1e-6)
    # Round-off decides some: 36 to 42 have been seen, by processor and number of BLAS threads, and 70 without the tangent.
    assert joints[0].evaluations <= 6 * len(tops) < 7 * len(tops) < joints[1].evaluations


def test_an_equilibrium_that_is_not_there_leaves_the_joint_as_it_was(host: ModuleType) -> None:
    series = host.Series(host.contact(0.5), host.contact(0.7))
    force = series.shift_top(3.0e-4)
    with pytest.raises(RuntimeError, match="no equilibrium at the shift 1"):
        series.shift_top(1.0)  # the lower contact slides: no force of the upper one can be its equal
    assert series.shift_top(3.0e-4) == pytest.approx(force, rel=1e-12)


def test_a_mass_braked_by_friction_turns_where_the_energy_says(host: ModuleType) -> None:
    mu, weight = 0.5, host.WEIGHT
    free = host.ring_down(host.contact(mu), 0.8 * mu * weight, 1.0, 5)

    def work(reached: float, left: float) -> float:
        """Work of the force between turning points by Masing's rule, integrated by parts: it vanishes."""
        way = [2.0 * shift(0.5 * (left - force), mu, weight) for force in (-reached, left)]
        area = quad(lambda force: 2.0 * shift(0.5 * (left - force), mu, weight), -reached, left, epsabs=0.0, epsrel=1e-8)
        return area[0] - reached * way[0] - left * way[1]

    force = free.forces[0]
    assert force == pytest.approx(0.8 * mu * weight, rel=1e-9)
    for turned in free.forces[1:]:
        expected = brentq(work, 0.5 * abs(force), abs(force) * (1 - 1e-6), args=(abs(force),), xtol=1e-12)
        assert abs(turned) == pytest.approx(expected, rel=5e-4)
        assert turned * force < 0.0
        force = turned
    assert np.all(np.diff(free.time) > 0.0)
    assert np.all(np.diff(np.abs(free.forces)) < 0.0) and np.all(np.diff(free.dissipation) > 0.0)


def test_the_example_draws(
    host: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys, "argv", ["scipy_host.py", "-o", str(tmp_path / "host.png")])
    host.main()
    printed = capsys.readouterr().out
    assert "two contacts in series, with the tangent:" in printed and "a mass released at Q = 0.8 mu P turns at" in printed
    assert (tmp_path / "host.png").stat().st_size > 10000
