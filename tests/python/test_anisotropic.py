"""Anisotropic half-planes against independent solutions: the same body as a dense matrix from Stroh's eigenvectors, the isotropic twin of
an orthotropic one, stresses that satisfy compatibility, closed forms."""

from __future__ import annotations

import math
import os
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import mfv
from mfv import Body, Friction, Mesh, Scene, Step, reference

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
    """A, At, M and B (docs/theory.md) from Stroh's eigenvectors: L^-1 - i S L^-1 = i A B^-1, in x and y."""
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
    moduli = [10 ** draw.uniform(3, 5), 10 ** draw.uniform(3, 5), 10 ** draw.uniform(3, 5)]
    keys = {f"youngs_modulus_{axis + 1}": modulus for axis, modulus in enumerate(moduli)}
    for one, other in ((0, 1), (0, 2), (1, 2)):
        keys[f"poisson_ratio_{one + 1}{other + 1}"] = draw.uniform(-0.3, 0.5) * math.sqrt(moduli[one] / moduli[other])
    return {**keys, "shear_modulus_12": 10 ** draw.uniform(3, 4.5), "axis_angle": draw.uniform(-90, 90)}


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


@pytest.mark.parametrize("seed", range(300 if os.environ.get("MFV_DEEP") else 24))
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
        np.testing.assert_allclose(
            getattr(one.state, name), getattr(other_one.state, name), rtol=0, atol=2e-12 * scale, err_msg=name
        )
    assert one.summary.events == other_one.summary.events
    for name in ("approach", "shift", "dissipation"):
        assert getattr(one.summary, name) == pytest.approx(getattr(other_one.summary, name), rel=1e-10, abs=1e-15), name


def on_a_disk(
    lower: dict[str, Any], upper: dict[str, Any], loads: list[Step], mu: float, nodes: int = 61, **scene: Any
) -> mfv.Result:
    """A disk with the gap of a parabola, without end effects of its own."""
    return Scene(
        Body.half_plane(datum=50.0, **lower),
        Body.disk(60.0, elasticity="half_plane", datum=50.0, **upper) if not upper.get("elasticity") and not upper.get("rigid")
        else Body.disk(60.0, **upper),
        steps=loads,
        friction=Friction.coulomb(mu),
        mesh=Mesh(nodes=nodes, gap="parabolic", **scene),
    ).run(check=True)  # fmt: skip


@pytest.mark.parametrize("seed", range(6))
def test_an_orthotropic_body_is_an_isotropic_one_with_other_friction(seed: int) -> None:
    """With the axes along and normal to the surface: tau sqrt(At/A) is the shear of an isotropic body with mu sqrt(At/A)."""
    draw = np.random.default_rng(seed)
    keys = {**random_material(draw), "axis_angle": 90.0 * (seed % 2)}
    a, at, m, b = near_field(turned(reduced(keys), keys["axis_angle"]))
    factor, beta = math.sqrt(at / a), b / math.sqrt(a * at)
    kappa = (1 + beta) / (1 - beta)
    twin = {"shear_modulus": (kappa + 1) / (4 * a), "poisson_ratio": (3 - kappa) / 4}
    mu, force = 0.4, 200.0
    loads = [
        Step(normal_force=force),
        Step(tangential_force=0.2 * force),
        Step(tangential_force=-0.1 * force, normal_force=0.8 * force),
    ]
    other = [Step(normal_force=step.normal_force, tangential_force=factor * (step.tangential_force or 0.0)) for step in loads]
    other[0] = Step(normal_force=force)
    other[1] = Step(tangential_force=factor * 0.2 * force)
    one = on_a_disk({"elasticity": "orthotropic", **keys}, {"rigid": True}, loads, mu)
    same = on_a_disk(twin, {"rigid": True}, other, mu * factor)
    assert abs(m) < 1e-12 * a
    np.testing.assert_allclose(one.state.pressure, same.state.pressure, rtol=0, atol=1e-11 * np.max(same.state.pressure))
    np.testing.assert_allclose(one.state.shear * factor, same.state.shear, rtol=0, atol=1e-11 * np.max(same.state.pressure))
    np.testing.assert_allclose(one.state.slip / factor, same.state.slip, rtol=0, atol=1e-11 * np.max(np.abs(same.state.slip)))
    assert one.summary.events == same.summary.events
    assert one.summary.dissipation == pytest.approx(same.summary.dissipation, rel=1e-10)
    assert one.scene.dundurs_beta == pytest.approx(beta, rel=1e-10)


@pytest.mark.parametrize("angle", [0.0, 37.0, -80.0])
@pytest.mark.parametrize("plane", ["strain", "stress"])
def test_an_isotropic_material_by_its_compliances_is_isotropic(plane: str, angle: float) -> None:
    """At any angle, in both planes, with all stresses: no digits are lost where the roots coincide."""
    e, nu = 70e3, 0.33
    compliances = [1 / e, -nu / e, 1 / e, 0.0, 0.0, 2 * (1 + nu) / e] + (
        [-nu / e, -nu / e, 1 / e, 0.0] if plane == "strain" else []
    )
    results = []
    for lower in (
        {"youngs_modulus": e, "poisson_ratio": nu},
        {"elasticity": "anisotropic", "compliances": compliances, "axis_angle": angle},
    ):
        scene = Scene(
            Body.half_plane(datum=50.0, yield_strength=300.0, **lower),
            Body.disk(60.0, rigid=True),
            steps=[Step(normal_force=300.0), Step(tangential_force=60.0, lower_bulk_stress=20.0), Step(tangential_force=-50.0)],
            friction=Friction.coulomb(0.5),
            mesh=Mesh(nodes=61),
        )
        scene.plane = plane
        results.append(scene.run(check=True))
    one, other = results
    for group in ("state", "observables", "error_estimate"):
        for name in one[group] if isinstance(one, dict) else getattr(one, group):
            expected = np.asarray(getattr(one, group)[name], dtype=float)
            scale = np.max(np.abs(expected[np.isfinite(expected)]), initial=0.0)
            # The place of a maximum is known to the root of round-off.
            rtol = 1e-7 if name.endswith(("_x", "_y")) else 1e-8
            np.testing.assert_allclose(getattr(other, group)[name], expected, rtol=rtol, atol=1e-10 * scale, err_msg=name)
    x, y = np.linspace(-2.0, 2.0, 9), np.array([0.0, -0.05, -0.3, -2.0])[:, None]
    fields = [mfv.stress.stress(result, x, y) for result in results]
    for name in ("sigma_xx", "sigma_yy", "sigma_xy", "sigma_zz", "von_mises"):
        np.testing.assert_allclose(
            fields[1][name], fields[0][name], rtol=0, atol=1e-10 * np.max(np.abs(fields[0][name])), err_msg=name
        )


@pytest.mark.parametrize("seed", range(20))
def test_constants_of_the_near_field(seed: int) -> None:
    """Roots of a polynomial against Stroh's eigenvectors."""
    keys = random_material(np.random.default_rng(seed))
    s = turned(reduced(keys), keys["axis_angle"])
    expected = near_field(s)
    found = reference.surface_compliance(s[0, 0], s[0, 1], s[1, 1], s[0, 2], s[1, 2], s[2, 2], [1, 2, 3, 4])
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-13 * expected[0])


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_oblique_bodies_of_one_material(side: float) -> None:
    """Two bodies of one material and direction: B cancels, M does not. With p' = p + (M/A) tau the problem is uncoupled, the friction
    limit mu/(1 +- mu M/A): the contact is Hertz's under P + (M/A) Q, the stick zone that under P - Q/mu (docs/theory.md)."""
    keys = {"elasticity": "orthotropic", **CARBON, "axis_angle": 30.0}
    a, _, m, _ = (2 * value for value in near_field(turned(reduced(CARBON), 30.0)))
    force, mu, radius = 50.0, 0.4, 60.0
    q = side * 0.6 * mu * force
    contact = float(reference.oblique_half_width(force, q, radius, 1 / a, m / a))
    ratio = float(reference.oblique_stick_ratio(q, force, mu, m / a))
    assert contact == pytest.approx(math.sqrt(2 * radius * a * (force + m / a * q) / math.pi), rel=1e-14)
    assert ratio * contact == pytest.approx(math.sqrt(2 * radius * a * (force - abs(q) / mu) / math.pi), rel=1e-14)
    errors = []
    for nodes in (101, 202, 404):
        loads = [Step(normal_force=force, friction=False), Step(tangential_force=q)]
        result = on_a_disk(keys, keys, loads, mu, nodes, half_width=1.3 * contact)
        found = result.observables
        errors.append([found.contact_half_width / contact - 1, found.stick_ratio / ratio - 1])
    assert np.all(np.abs(errors[0]) < 4e-5) and np.all(np.abs(errors[2]) < 4e-6), errors
    assert abs(contact / math.sqrt(2 * radius * a * force / math.pi) - 1) > 0.03
    # Gross sliding: the shear is the friction limit everywhere.
    last = on_a_disk(keys, keys, [Step(normal_force=force, friction=False), Step(shift=side * 0.1)], mu, 202).observables
    sliding = math.sqrt(2 * radius * a * force * (1 + side * mu * m / a) / math.pi)
    assert last.contact_half_width == pytest.approx(sliding, rel=1e-4)


def test_stresses_in_the_upper_body_are_those_turned_by_half_a_turn() -> None:
    """The picture upside down: the stresses at opposite points are the same, for axes at any angle."""
    soft = {"elasticity": "orthotropic", **CARBON, "axis_angle": 25.0}
    stiff = {"youngs_modulus": 210e3, "poisson_ratio": 0.3}
    loads = [Step(normal_force=50.0), Step(tangential_force=12.0)]

    def run(lower: Body, upper: Body) -> mfv.Result:
        return Scene(lower, upper, steps=loads, friction=Friction.coulomb(0.5), mesh=Mesh(nodes=61, half_width=1.2)).run(check=True)

    plane, pad = Body.half_plane(datum=40.0, **soft), Body.power(1 / 120, 2.0, datum=40.0, **stiff)
    one, other = run(plane, pad), run(pad, plane)
    x, y = np.linspace(-1.5, 1.5, 7), np.array([-0.02, -0.4, -1.5])[:, None]
    for body, opposite, sign in (("lower", "upper", 1.0), ("upper", "lower", -1.0)):
        here, there = mfv.stress.stress(one, x, sign * y, body=body), mfv.stress.stress(other, -x, -sign * y, body=opposite)
        for name in ("sigma_xx", "sigma_yy", "sigma_xy", "sigma_zz"):
            np.testing.assert_allclose(there[name], here[name], rtol=0, atol=1e-9 * np.max(np.abs(here[name])), err_msg=name)
    # At the surface the strain along it is continuous where bodies stick: their displacements agree.
    assert np.max(np.abs(one.state.slip)) > 0


@pytest.mark.parametrize(
    ("keys", "plane", "what"),
    [
        ({"elasticity": "orthotropic"}, "strain", "youngs_modulus_1 is missing"),
        (
            {"elasticity": "orthotropic", **CARBON, "poisson_ratio": 0.3},
            "strain",
            "poisson_ratio=0.3: has no effect for a half_plane with",
        ),
        ({"elasticity": "orthotropic", **CARBON}, "stress", "youngs_modulus_3=10000: has no effect with plane='stress'"),
        ({"elasticity": "orthotropic", **CARBON, "poisson_ratio_12": 4.0}, "strain", "elasticity='orthotropic': no such material"),
        ({"elasticity": "anisotropic"}, "strain", "compliances is missing"),
        (
            {"elasticity": "anisotropic", "compliances": [1.0, 0.0, 1.0, 0.0, 0.0, 2.0]},
            "strain",
            "must be ten numbers in plane strain",
        ),
        ({"elasticity": "anisotropic", "compliances": [1.0] * 10}, "stress", "must be six numbers in plane stress"),
        ({"elasticity": "anisotropic", "compliances": [1.0, 1.1, 1.0, 0.0, 0.0, 2.0]}, "stress", "no such material"),
        (
            {"youngs_modulus": 1.0, "poisson_ratio": 0.3, "axis_angle": 3.0},
            "strain",
            "axis_angle=3: has no effect for a half_plane",
        ),
    ],
)
def test_what_does_not_fit_is_refused(keys: dict[str, Any], plane: str, what: str) -> None:
    scene = Scene(Body.half_plane(**keys), Body.disk(1.0, rigid=True), steps=[Step(normal_force=1.0)])
    scene.plane = plane
    with pytest.raises(mfv.errors.InputError, match=what):
        scene.run()


def test_dundurs_beta_and_fatigue_need_isotropic_bodies() -> None:
    scene = Scene(
        Body.half_plane(elasticity="orthotropic", **CARBON), Body.disk(60.0, rigid=True), steps=[Step(normal_force=5.0), Step(tangential_force=1.0, cycles=1)],
        friction=Friction.coulomb(0.5), mesh=Mesh(nodes=21),
    )  # fmt: skip
    result = scene.run(check=True)
    assert result.scene.lower_compliance_11 == pytest.approx(reduced(CARBON)[0, 0], rel=1e-14)
    with pytest.raises(ValueError, match="the lower body is anisotropic"):
        mfv.fatigue.stress_cycle(result, [0.0], [-0.1])


@pytest.mark.parametrize("angle", [30.0, -70.0])
def test_pressure_alone_stretches_an_oblique_surface(angle: float) -> None:
    """Without friction a rigid cylinder stretches it at one edge: |M|/s11 times Hertz's pressure, at the left one if M is positive."""
    s = turned(reduced(CARBON), angle)
    _, _, m, _ = near_field(s)
    scene = Scene(
        Body.half_plane(elasticity="orthotropic", axis_angle=angle, **CARBON),
        Body.disk(60.0, rigid=True),
        steps=[Step(normal_force=50.0)],
        mesh=Mesh(nodes=101, gap="parabolic"),
    )
    found = scene.run(check=True).observables
    peak = 2 * 50.0 / (math.pi * found.contact_half_width)
    assert found.lower_tension == pytest.approx(abs(m) / s[0, 0] * peak, rel=2e-4)
    assert found.lower_tension_x == pytest.approx(-math.copysign(found.contact_half_width, m), rel=1e-3)
    sharp = Scene(
        Body.half_plane(elasticity="orthotropic", axis_angle=angle, **CARBON), Body.flat_punch(1.0), steps=[Step(normal_force=50.0)]
    ).run(check=True)
    assert "lower_tension" not in sharp.observables


@pytest.mark.parametrize(("nu", "mu", "is_stretched"), [(-0.5, 5.0, True), (-0.5, 0.3, False), (0.3, 5.0, False)])
def test_the_tip_of_a_wedge_stretches_an_auxetic_plane_that_sticks(nu: float, mu: float, is_stretched: bool) -> None:
    """(2 beta - 1) p where it sticks, beta = (1 - 2 nu)/(2 (1 - nu)) of a plane under a rigid wedge: no largest tension is given. Where it
    slides, or is not auxetic, it is compressed."""
    scene = Scene(
        Body.half_plane(youngs_modulus=1.0, poisson_ratio=nu, datum=10.0),
        Body.wedge(5.0, rigid=True),
        steps=[Step(normal_force=0.1), *([] if mu > 1 else [Step(shift=2.0)])],
        friction=Friction.coulomb(mu),
        mesh=Mesh(nodes=61),
    )
    assert ("lower_tension" in scene.run(check=True).observables) is not is_stretched


def test_slip_that_jams_is_explained() -> None:
    """Where mu |M|/A is above 1, slip to one side raises the pressure by more than the friction that it overcomes."""
    scene = Scene(
        Body.half_plane(elasticity="orthotropic", axis_angle=60.0, **CARBON),
        Body.disk(10.0, rigid=True),
        steps=[Step(normal_force=50.0, friction=False), Step(tangential_force=-30.0)],
        friction=Friction.coulomb(1.7),
        mesh=Mesh(nodes=51),
    )
    result = scene.run()
    assert result.outcome == "no admissible continuation"
    assert "mu times contact_mixed_ratio of these oblique bodies is" in result.attributes["message"]


def test_a_cubic_crystal_at_45_degrees_is_symmetric() -> None:
    """Round-off of the turn does not make pressure stretch its surface: no tension, even at a sharp corner."""
    cubic = {f"youngs_modulus_{i}": 130e3 for i in (1, 2, 3)} | {f"poisson_ratio_{i}": 0.28 for i in (12, 13, 23)}
    plane = Body.half_plane(elasticity="orthotropic", axis_angle=45.0, shear_modulus_12=80e3, **cubic)
    result = Scene(plane, Body.flat_punch(1.0), steps=[Step(normal_force=50.0)], mesh=Mesh(nodes=21)).run(check=True)
    assert result.scene.contact_mixed_ratio == 0.0 and result.observables.lower_tension == 0.0


def test_an_incompressible_material_does_not_couple() -> None:
    """nu = 1/2 in plane strain: the compliances are only semidefinite, B = 0."""
    thirds = {f"youngs_modulus_{i}": 1.0 for i in (1, 2, 3)} | {f"poisson_ratio_{i}": 0.5 for i in (12, 13, 23)}
    plane = Body.half_plane(elasticity="orthotropic", shear_modulus_12=1 / 3, **thirds)
    result = Scene(plane, Body.disk(1.0, rigid=True), steps=[Step(normal_force=0.01)], mesh=Mesh(nodes=21)).run(check=True)
    assert abs(result.scene.dundurs_beta) < 1e-14
    assert 1 / result.scene.contact_modulus == pytest.approx(1.5, rel=1e-12)


def test_constants_of_a_cubic_crystal() -> None:
    """Silicon by the formulas of the guide (C11, C12, C44), at an angle: the compliances are those of the inverse of its stiffness matrix
    in plane strain."""
    c11, c12, c44 = 165700.0, 63900.0, 79600.0
    modulus, ratio = (c11 - c12) * (c11 + 2.0 * c12) / (c11 + c12), c12 / (c11 + c12)
    assert modulus == pytest.approx(130000.0, rel=2e-3) and ratio == pytest.approx(0.278, abs=5e-4)
    keys = {f"youngs_modulus_{axis}": modulus for axis in (1, 2, 3)} | {f"poisson_ratio_{pair}": ratio for pair in (12, 13, 23)}
    body = Body.half_plane(elasticity="orthotropic", axis_angle=20.0, shear_modulus_12=c44, **keys)
    found = Scene(body, Body.disk(10.0, rigid=True), steps=[Step(normal_force=1.0)], mesh=Mesh(nodes=21)).run(check=True).scene
    in_plane = np.linalg.inv([[c11, c12, 0.0], [c12, c11, 0.0], [0.0, 0.0, c44]])  # plane strain: the third strain vanishes
    expected = turned(in_plane, 20.0)
    for row, column in ((1, 1), (1, 2), (2, 2), (1, 6), (2, 6), (6, 6)):
        value = expected[min(row, 3) - 1, min(column, 3) - 1]
        assert found[f"lower_compliance_{row}{column}"] == pytest.approx(value, rel=1e-9, abs=1e-9 * in_plane[0, 0])
