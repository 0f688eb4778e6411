"""Edges between nodes and the largest tension on random scenes: refined meshes, corners, and values below the certified accuracy."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scenes import seeds

import mfv

PARABOLA = {"youngs_modulus": 72100.0, "poisson_ratio": 0.33}


def test_refined_meshes_have_the_closed_form() -> None:
    """Cattaneo and Mindlin from 60 to 300 nodes: edges to 2e-5, tension to 2e-4 of the largest stress 2 mu p0."""
    random = np.random.default_rng(1)
    worst = np.zeros(3)
    for _ in seeds(24):
        ratio, mu, force = random.uniform(0.05, 0.95), random.uniform(0.2, 1.0), random.uniform(50.0, 200.0)
        modulus = PARABOLA["youngs_modulus"] / (1.0 - PARABOLA["poisson_ratio"] ** 2)
        half = math.sqrt(4.0 * force * 10.0 / (math.pi * modulus))
        scene = mfv.Scene(
            mfv.Body.half_plane(**PARABOLA),
            mfv.Body.disk(10.0, rigid=True),
            coupling="none",
            mesh=mfv.Mesh(gap="parabolic", nodes=int(random.integers(60, 300)), half_width=1.4 * half, refine="edges"),
            friction=mfv.Friction.coulomb(mu),
            steps=[mfv.Step(normal_force=force, friction=False), mfv.Step(tangential_force=ratio * mu * force)],
        )
        seen = mfv.run(scene).observables
        stress = 2.0 * mu * 2.0 * force / (math.pi * half)
        errors = [
            seen.contact_half_width / half - 1.0,
            seen.stick_ratio / math.sqrt(1.0 - ratio) - 1.0,
            seen.lower_tension / stress - math.sqrt(ratio),
        ]
        worst = np.maximum(worst, np.abs(errors))
    print(worst)
    assert (worst < [1e-5, 5e-5, 4e-4]).all()


WEDGE = """
&body shape='half_plane', shear_modulus=1.0, poisson_ratio={nu} /
&body shape='wedge', rigid=.true., angle={angle} /
&friction law='coulomb', mu={mu} /
&mesh nodes={nodes}{mesh} /
&output error_estimate={bars} /
&step normal_force=0.01 /
&step tangential_force={shear}, lower_bulk_stress={bulk} /
&step tangential_force={back}, lower_bulk_stress=-{bulk}, cycles=1 /
"""


def wedge(random: np.random.Generator) -> dict[str, float]:
    """A random wedge under bulk stress."""
    mu, ratio = random.uniform(0.5, 0.7), random.uniform(0.3, 0.7)
    return {
        "nu": random.choice([0.0, 0.05, 0.3]),
        "angle": random.uniform(1.0, 3.0),
        "mu": mu,
        "shear": 0.01 * mu * ratio,
        "back": 0.004 * mu * ratio,
        "bulk": random.uniform(0.004, 0.008),
    }


def test_tension_of_a_wedge_is_independent_of_parity() -> None:
    """Next to the tip, where the pressure has no limit, the surface is compressed: odd, even and refined meshes agree."""
    random = np.random.default_rng(2)
    for _ in seeds(6):
        keys = wedge(random)
        found = [
            mfv.run(text=WEDGE.format(nodes=nodes, mesh=mesh, bars=".false.", **keys)).observables.lower_tension
            for nodes, mesh in ((301, ""), (302, ""), (303, ""), (200, ", refine='edges'"))
        ]
        assert found == pytest.approx([found[0]] * 4, rel=0.02), (keys, found)


@pytest.mark.parametrize("mesh", ["", ", refine='edges'"])
def test_peak_pressure_of_a_wedge_has_no_limit(mesh: str) -> None:
    """Neither has the tension a bar where a warning says that a slip zone is too narrow for it."""
    random = np.random.default_rng(3)
    for nodes in (101, 102, 150):
        result = mfv.run(text=WEDGE.format(nodes=nodes, mesh=mesh, bars=".true.", **wedge(random)))
        bars = result.error_estimate
        assert bars.peak_pressure_error == math.inf and bars.peak_pressure_order == 0.0
        assert math.isfinite(bars.lower_tension_error) != ("lower_tension" in result.attributes["warnings"])


ROUND_OFF = """
&scene plane='stress', coupling='{coupling}' /
&body shape='wedge', angle={angle}, youngs_modulus=1300.0, poisson_ratio={nu} /
&body shape='half_plane', youngs_modulus=1300.0, poisson_ratio={nu}, datum=10.0 /
&mesh nodes={nodes} /
&friction law='coulomb', mu={mu} /
&step normal_force={first}, friction=.false. /
&step shift={shift} /
&step normal_force={last}, cycles=2 /
&step moment={moment} /
"""
MIRRORED = ("shift", "moment")


def test_round_off_does_not_decide() -> None:
    """Mirror image, and loads and coefficients changed by 1e-13: the same edges and tensions."""
    random = np.random.default_rng(4)
    for number in seeds(24):
        keys = {
            "coupling": ("none", "goodman", "full")[number % 3],
            "angle": random.uniform(0.2, 1.0),
            "nu": (0.0, 0.3)[number % 2],
            "nodes": int(random.integers(60, 120)),
            "mu": random.uniform(0.3, 1.5),
            "first": random.uniform(0.5, 1.0),
            "shift": random.uniform(-1.0, 1.0) * 10.0 ** random.uniform(-9.0, -4.0),
            "last": random.uniform(0.3, 0.5),
            "moment": random.uniform(-0.05, 0.05),
        }
        one = mfv.run(text=ROUND_OFF.format(**keys))
        mirrored = mfv.run(text=ROUND_OFF.format(**keys | {key: -keys[key] for key in MIRRORED}))
        changed = mfv.run(text=ROUND_OFF.format(**keys | {key: keys[key] * (1.0 + 1e-13) for key in ("mu", "first", "moment")}))
        for other in (mirrored, changed):
            for name in ("contact_half_width", "stick_ratio", "lower_tension", "upper_tension"):
                assert other.observables[name] == pytest.approx(one.observables[name], rel=1e-6), (name, keys)
