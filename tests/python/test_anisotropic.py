"""Anisotropic half-planes against independent solutions: the same body as a dense matrix from Stroh's eigenvectors, the isotropic twin of
an orthotropic one, stresses that satisfy compatibility, closed forms."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import mfv
from mfv import Body, Friction, Mesh, Scene, Step

Numbers = NDArray[np.float64]
#: A carbon fibre composite, fibres along the first axis, MPa.
CARBON = {
    "youngs_modulus_1": 140e3, "youngs_modulus_2": 10e3, "youngs_modulus_3": 10e3, "poisson_ratio_12": 0.3,
    "poisson_ratio_13": 0.3, "poisson_ratio_23": 0.45, "shear_modulus_12": 5e3,
}  # fmt: skip


def reduced(keys: dict[str, float]) -> Numbers:
    """The compliances in plane strain of an orthotropic material along its axes, shape (3, 3)."""
    e1, e2, e3, nu12, nu13, nu23, g12 = (
        keys[name] for name in ("youngs_modulus_1", "youngs_modulus_2", "youngs_modulus_3", "poisson_ratio_12", "poisson_ratio_13",
                                "poisson_ratio_23", "shear_modulus_12")
    )  # fmt: skip
    full = np.diag([1 / e1, 1 / e2, 1 / e3, 1 / g12])
    full[0, 1] = full[1, 0] = -nu12 / e1
    full[0, 2] = full[2, 0] = -nu13 / e1
    full[1, 2] = full[2, 1] = -nu23 / e2
    # Without strain out of the plane: the inverse of the stiffness in the plane.
    stiffness = np.linalg.inv(full)[np.ix_([0, 1, 3], [0, 1, 3])]
    return np.asarray(np.linalg.inv(stiffness))


def turned(compliance: Numbers, degrees: float) -> Numbers:
    """Compliances along x and y of a material turned counterclockwise."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    stress = np.array([[c * c, s * s, 2 * s * c], [s * s, c * c, -2 * s * c], [-s * c, s * c, c * c - s * s]])
    return np.asarray(stress.T @ compliance @ stress)


def near_field(compliance: Numbers) -> tuple[float, float, float, float]:
    """A, At, M and B (docs/theory.md) from Stroh's eigenvectors: L^-1 - i S L^-1 = i A B^-1 (Ting 1996, chapter 7), in x and y."""
    stiffness = np.linalg.inv(compliance)
    q, r, t = (stiffness[np.ix_(rows, columns)] for rows, columns in (([0, 2], [0, 2]), ([0, 2], [2, 1]), ([2, 1], [2, 1])))
    inverse = np.linalg.inv(t)
    sextic = np.block([[-inverse @ r.T, inverse], [r @ inverse @ r.T - q, -r @ inverse]])
    roots, vectors = np.linalg.eig(sextic)
    up = roots.imag > 0
    impedance = 1j * vectors[:2, up] @ np.linalg.inv(vectors[2:, up])
    return impedance[1, 1].real, impedance[0, 0].real, -impedance[0, 1].real, impedance[0, 1].imag


def matrix(compliance: Numbers, x: Numbers, width: float, datum: float) -> Numbers:
    """Displacements by nodal forces on the upper side of the material, shape (2n, 2n), normal components first."""
    a, at, m, b = near_field(compliance)
    r = (x[:, None] - x[None, :]) / (width / 2)
    plus, minus = r + 1, r - 1
    logs = plus * np.log(np.abs(plus)) - minus * np.log(np.abs(minus))
    direct = (width / 2 / np.pi) * (2 * math.log(2 * datum / width) + 2 - logs)
    step = b * width / 2 * np.clip(r, -1, 1)
    return np.block([[a * direct, m * direct + step], [m * direct - step, at * direct]]) / width


def random_material(draw: np.random.Generator) -> dict[str, float]:
    return {
        "youngs_modulus_1": 10 ** draw.uniform(3, 5), "youngs_modulus_2": 10 ** draw.uniform(3, 5), "youngs_modulus_3": 1e4,
        "poisson_ratio_12": draw.uniform(-0.1, 0.2), "poisson_ratio_13": draw.uniform(0, 0.1), "poisson_ratio_23": draw.uniform(0, 0.1),
        "shear_modulus_12": 10 ** draw.uniform(3, 4.5), "axis_angle": draw.uniform(-90, 90),
    }  # fmt: skip


def anisotropic(keys: dict[str, float]) -> dict[str, Any]:
    """The same material by its compliances along x and y."""
    s = turned(reduced(keys), keys["axis_angle"])
    in_plane = [s[0, 0], s[0, 1], s[1, 1], s[0, 2], s[1, 2], s[2, 2]]
    return {"elasticity": "anisotropic", "compliances": [*in_plane, 0.0, 0.0, 1.0, 0.0]}


def steps(draw: np.random.Generator, force: float, mu: float) -> list[Step]:
    """Press, then forces within the friction limit."""
    loads = [Step(normal_force=force, friction=bool(draw.random() < 0.5))]
    for _ in range(3):
        loads.append(Step(normal_force=force * draw.uniform(0.6, 1.5), tangential_force=force * mu * draw.uniform(-0.55, 0.55)))
    return loads


@pytest.mark.parametrize("seed", range(24))
def test_a_dense_matrix_of_strohs_eigenvectors_gives_the_same(seed: int) -> None:
    """Random materials at any angle, one or both bodies elastic, all couplings: tractions to round-off, the same events."""
    draw = np.random.default_rng(seed)
    nodes, half_width, radius = 40, 1.5, 60.0
    x = (np.arange(nodes) + 0.5) * 2 * half_width / nodes - half_width
    lower = random_material(draw)
    mu = draw.uniform(0.2, 0.8)
    coupling = ("full", "full", "goodman", "none")[seed % 4]
    datum = 40.0
    total = matrix(turned(reduced(lower), lower["axis_angle"]), x, x[1] - x[0], datum)
    body = {"elasticity": "orthotropic", **lower} if seed % 3 else anisotropic(lower)
    upper: dict[str, Any] = {"rigid": True}
    if seed % 2:
        other = random_material(draw)
        upper = {"elasticity": "orthotropic", "datum": datum, **other}
        # Seen from its own side the upper body is turned the other way, and its shear is reversed.
        mirrored = matrix(turned(reduced(other), -other["axis_angle"]), x, x[1] - x[0], datum)
        sign = np.array([1.0, -1.0])
        total = total + mirrored * np.kron(np.outer(sign, sign), np.ones((nodes, nodes)))
    # Hertz's half-width would be half that of the mesh.
    normal = (total[0, 0] - total[0, 1]) * 2 * math.pi / (3 * math.log(3))
    force = math.pi * (0.5 * half_width) ** 2 / (2 * radius * normal)
    loads, friction = steps(draw, force, mu), Friction.coulomb(mu)
    mesh = Mesh(nodes=nodes, half_width=half_width, gap="parabolic")
    direct = Scene(Body.half_plane(datum=datum, **body), Body.disk(radius, **upper), steps=loads, mesh=mesh, friction=friction)
    direct.coupling = coupling
    dense = Scene(
        Body.matrix(x, compliance=total, width=np.full(nodes, x[1] - x[0])),
        Body.disk(radius, rigid=True),
        steps=loads,
        friction=friction,
        mesh=Mesh(gap="parabolic"),
    )
    dense.coupling = coupling
    one, other_one = direct.run(check=True), dense.run(check=True)
    scale = np.max(other_one.state.pressure)
    for name in ("pressure", "shear"):
        np.testing.assert_allclose(getattr(one.state, name), getattr(other_one.state, name), rtol=0, atol=2e-12 * scale, err_msg=name)
    assert one.summary.events == other_one.summary.events
    for name in ("approach", "shift", "dissipation"):
        assert getattr(one.summary, name) == pytest.approx(getattr(other_one.summary, name), rel=1e-10, abs=1e-15), name
