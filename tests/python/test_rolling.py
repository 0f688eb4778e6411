"""Rolling against closed forms and against an independent solution of steady rolling (Bentall and Johnson's problem)."""

from __future__ import annotations

import numpy as np
import pytest
from steady_rolling import steady_rolling

import mfv

RADIUS, HALF_WIDTH = 1000.0, 1.0


def rolled(beta: float, mu: float, part: float, nodes: int = 251, length: float = 5.0) -> mfv.Result:
    """A rigid disk of RADIUS on a half-plane of E* = 1, pressed to HALF_WIDTH, sheared to `part` of mu P, rolled to the right."""
    ratio = (1.0 - 2.0 * beta) / (2.0 - 2.0 * beta)
    force = np.pi / (4.0 * RADIUS) * HALF_WIDTH**2
    return mfv.run(
        text=f"&body shape='half_plane', youngs_modulus={1.0 - ratio**2!r}, poisson_ratio={ratio!r} /\n"
        f"&body shape='disk', radius={RADIUS}, rigid=.true. /\n"
        f"&mesh nodes={nodes}, half_width={length + 1.5} /\n&friction law='coulomb', mu={mu} /\n"
        f"&step normal_force={force!r}, friction=.false. /\n&step tangential_force={part * mu * force!r} /\n"
        f"&step rotation={-length / RADIUS!r} /\n",
        check=True,
    )


@pytest.mark.parametrize(
    ("beta", "mu", "part", "intervals"),
    [(0.1, 0.3, 0.0, 125), (0.1, 0.05, 0.0, 250), (0.3, 0.1, 0.0, 250), (0.3, 0.3, 0.5, 125), (0.3, 0.3, -0.5, 125)],
)
def test_dissimilar_rollers_creep_as_in_steady_rolling(beta: float, mu: float, part: float, intervals: int) -> None:
    result = rolled(beta, mu, part)
    force = result.summary.normal_force
    steady = steady_rolling(1.0, beta, 1.0 / RADIUS, mu, force, part * mu * force, intervals)
    assert result.observables.creepage == pytest.approx(steady.creepage, abs=3e-3 * max(mu, beta) * HALF_WIDTH / RADIUS)
    assert result.observables.contact_half_width == pytest.approx(steady.half_width, rel=0.02)


def test_carter_from_python() -> None:
    result = rolled(0.0, 0.3, 0.5)
    force = result.summary.normal_force
    creepage = mfv.reference.carter_creepage(0.15 * force, force, HALF_WIDTH, RADIUS, 0.3)
    assert creepage == pytest.approx(0.3 / RADIUS * (1.0 - np.sqrt(0.5)), rel=1e-12)
    assert result.observables.creepage == pytest.approx(creepage, rel=2e-3)
    x = result.mesh.x - 5.0 * HALF_WIDTH
    shear = mfv.reference.carter_shear(x, 0.15 * force, force, result.reference.contact_half_width, 0.3)
    assert np.allclose(shear, result.reference.shear, rtol=1e-9, atol=1e-12 * shear.max())
    assert np.isnan(mfv.reference.carter_creepage(1.0, 1.0, 1.0, 1.0, 0.3))
