"""Layers against independent solutions: the same bodies as dense matrices, strips by Winkler's and Johnson's limits, a coated cylinder by
finite elements; stresses in balance; keys, refusals, Python and text alike."""

from __future__ import annotations

import dataclasses
import math
import os
import re
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.linalg import expm
from test_anisotropic import near_field, random_material, reduced, steps, turned

import mfv
from mfv import Body, Friction, Layer, Mesh, Output, Scene, Step

Numbers = NDArray[np.float64]
ALLOY = {"youngs_modulus": 70e3, "poisson_ratio": 0.33}


@dataclasses.dataclass
class Material:
    """A material by its keys; its reduced compliances in plane strain along x and y, and its near field A, At, M, B."""

    keys: dict[str, Any]

    def compliance(self, upside_down: bool = False) -> Numbers:
        if "youngs_modulus" in self.keys:
            e, nu = self.keys["youngs_modulus"], self.keys["poisson_ratio"]
            s = np.array([[1 - nu**2, -nu * (1 + nu), 0], [-nu * (1 + nu), 1 - nu**2, 0], [0, 0, 2 * (1 + nu)]]) / e
        else:
            angle = self.keys.get("axis_angle", 0.0)
            s = turned(reduced(self.keys), -angle if upside_down else angle)
        return np.asarray(s)

    def surface(self, upside_down: bool = False) -> tuple[float, float, float, float]:
        if "youngs_modulus" in self.keys:
            e, nu = self.keys["youngs_modulus"], self.keys["poisson_ratio"]
            shear = e / (2 * (1 + nu))
            return (1 - nu) / shear, (1 - nu) / shear, 0.0, (1 - 2 * nu) / (2 * shear)
        return near_field(self.compliance(upside_down))

    def decay(self, upside_down: bool = False) -> float:
        """The least decay of waves over k and a depth: the smallest imaginary part of the roots."""
        (s11, s12, s16), (_, s22, s26), (_, _, s66) = self.compliance(upside_down)
        roots = np.roots([s11, -2 * s16, 2 * s12 + s66, -2 * s26, s22]).imag
        return float(roots[roots > 0].min())

    def rates(self, upside_down: bool = False) -> NDArray[np.complex128]:
        """How (k u, k v, sigma_xy, sigma_yy) of exp(i k x) changes with k y, y out of the body."""
        (s11, s12, s16), (_, s22, s26), (_, _, s66) = self.compliance(upside_down)
        stress = np.array([1j, 0, -s16, -s12]) / s11  # sigma_xx
        return np.array([
            s16 * stress + [0, -1j, s66, s26],
            s12 * stress + [0, 0, s26, s22],
            -1j * stress,
            [0, 0, -1j, 0],
        ])  # fmt: skip


def waves(layers: list[tuple[float, Material]], base: Material | None, k: Numbers, flip: bool) -> NDArray[np.complex128]:
    """k times the displacements (u, v) of the surface by waves of (sigma_xy, sigma_yy), shape (k, 2, 2): all displacements and
    tractions between thin slices of the layers from one linear system."""
    seen, decayed = [], 0.0
    for t, m in layers:
        if decayed > 25:  # what is below does not matter
            break
        seen.append((t, m))
        decayed += k.min() * t * m.decay(flip)
    if decayed > 25:
        (_, base), seen = seen[-1], seen[:-1]
    slices = [(t / n, m) for t, m in seen for n in [math.ceil(t * k.max() / 1.5)] for _ in range(n)]
    size = 4 * (len(slices) + 1)
    system = np.zeros((len(k), size, size), dtype=complex)
    steps_of = {}
    for i, (t, m) in enumerate(slices):
        key = (t, id(m))
        if key not in steps_of:
            steps_of[key] = expm(-k[:, None, None] * t * m.rates(flip))
        system[:, 4 * i : 4 * i + 4, 4 * i : 4 * i + 4] = steps_of[key]
        system[:, 4 * i : 4 * i + 4, 4 * i + 4 : 4 * i + 8] = -np.eye(4)
    end = np.zeros((2, 4), dtype=complex)
    end[:, :2] = np.eye(2)
    if base:
        a, at, m, b = base.surface(flip)
        end[:, 2:] = -np.array([[at, -(m + 1j * b)], [-(m - 1j * b), a]])
    system[:, size - 4 : size - 2, size - 4 :] = end
    system[:, size - 2, 2] = system[:, size - 1, 3] = 1
    right = np.zeros((len(k), size, 2), dtype=complex)
    right[:, size - 2, 0] = right[:, size - 1, 1] = 1
    return np.asarray(np.linalg.solve(system, right)[:, :2, :])


def matrix(layers: list[tuple[float, Material]], base: Material | None, x: Numbers, datum: float, flip: bool = False) -> Numbers:
    """Displacements by nodal forces, shape (2n, 2n), normal components first: the first layer in closed form, and the difference
    by Gauss quadrature in equal intervals of k."""
    top = layers[0][1]
    a, at, m, b = top.surface(flip)
    width = x[1] - x[0]
    n = len(x)
    distance = np.arange(n) * width
    last = 40 / (2 * layers[0][0] * top.decay(flip))
    ends = [0.0]
    for end in last * 2.0 ** np.arange(-40.0, 1.0):
        pieces = max(math.ceil((end - ends[-1]) * (distance[-1] + datum) / 6), 1)
        ends += list(np.linspace(ends[-1], end, pieces + 1)[1:])
    points, weights = np.polynomial.legendre.leggauss(16)
    middles, halves = (np.array(ends[1:]) + ends[:-1]) / 2, np.diff(ends) / 2
    k = (middles[:, None] + halves[:, None] * points).ravel()
    weight = (halves[:, None] * weights).ravel()
    z = np.concatenate([waves(layers, base, part, flip) for part in np.array_split(k, max(len(k) // 400, 1))])
    z = z - np.array([[at, -(m + 1j * b)], [-(m - 1j * b), a]])
    far = 0.0
    if base is None:  # no datum: (1 - exp(-k c))/k is known in closed form
        c = 2 * layers[0][0]
        z = z + np.array([[at, -(m + 1j * b)], [-(m - 1j * b), a]]) * np.exp(-k * c)[:, None, None]
        far = 1.0
    box = weight * width * np.sinc(k * width / 2 / np.pi) / (np.pi * k)
    even = np.cos(np.outer(distance, k)) - (1 - far) * np.cos(k * datum)
    odd = np.sin(np.outer(distance, k))
    r = distance / (width / 2)
    logs = (r + 1) * np.log(r + 1) - (r - 1) * np.log(np.maximum(np.abs(r - 1), 1e-300))
    direct = (width / 2 / np.pi) * (2 * math.log(2 * datum / width) + 2 - logs)
    step = width / 2 * np.clip(r, -1, 1)
    if base is None:
        edges = np.array([distance + width / 2, distance - width / 2])
        squares = edges * np.log((edges**2 + c**2) / datum**2) - 2 * edges + 2 * c * np.arctan(edges / c)
        direct = direct + (squares[0] - squares[1]) / (2 * np.pi)
        arcs = edges * np.arctan(edges / c) - c / 2 * np.log(edges**2 + c**2)
        step = step - (arcs[0] - arcs[1]) / np.pi
    wp = a * direct + even @ (box * z[:, 1, 1].real)
    ut = at * direct + even @ (box * z[:, 0, 0].real)
    mixed = m * direct - even @ (box * (z[:, 0, 1] + z[:, 1, 0]).real) / 2
    skew = b * step + odd @ (box * -(z[:, 0, 1] - z[:, 1, 0]).imag) / 2
    lag = np.arange(n)[:, None] - np.arange(n)[None, :]
    w, u, e, o = (kernel[np.abs(lag)] for kernel in (wp, ut, mixed, skew))
    o = np.sign(lag) * o
    return np.block([[w, e + o], [e - o, u]]) / width


def random_layers(draw: np.random.Generator, scale: float) -> list[tuple[float, Material]]:
    """One or two layers, a tenth of `scale` or thicker, isotropic, or orthotropic at any angle."""
    layers = []
    for _ in range(int(draw.integers(1, 3))):
        keys: dict[str, Any] = {"youngs_modulus": 10 ** draw.uniform(3.2, 5.2), "poisson_ratio": draw.uniform(0, 0.5)}
        if draw.random() < 0.3:
            # Waves that are shifted along the surface need many points here.
            keys = {**random_material(draw), "axis_angle": float(draw.choice([0.0, 90.0, draw.uniform(-20, 20)]))}
        layers.append((scale * 10 ** draw.uniform(-0.7, 0.4), Material(keys)))
    return layers


def layer(thickness: float, material: Material) -> Layer:
    kind = "isotropic" if "youngs_modulus" in material.keys else "orthotropic"
    return Layer(thickness=thickness, elasticity=kind, **material.keys)


@pytest.mark.parametrize("seed", range(300 if os.environ.get("MFV_DEEP") else 10))
def test_a_dense_matrix_gives_the_same(seed: int) -> None:
    """Random layers on half-planes and rigid bases, one or both bodies, all couplings: tractions to round-off, the same events."""
    draw = np.random.default_rng(seed)
    nodes, half_width, radius, datum = 32, 1.5, 60.0, 4.0
    x = (np.arange(nodes) + 0.5) * 2 * half_width / nodes - half_width
    mu, coupling = draw.uniform(0.2, 0.8), ("full", "full", "goodman", "none")[seed % 4]
    sign = np.array([1.0, -1.0])
    total = np.zeros((2 * nodes, 2 * nodes))
    bodies = []
    for side in range(2 if seed % 2 else 1):
        stack = random_layers(draw, half_width)
        base = None if draw.random() < 0.3 else Material(dict(ALLOY) if draw.random() < 0.7 else random_material(draw))
        part = matrix(stack, base, x, datum, flip=side == 1)
        total += part * np.kron(np.outer(sign, sign), np.ones((nodes, nodes))) if side else part
        keys: dict[str, Any] = {"rigid": True}
        if base:
            keys = {"datum": datum, **base.keys}
            if "youngs_modulus" not in base.keys:
                keys["elasticity"] = "orthotropic"
        bodies.append({**keys, "layers": [layer(*one) for one in stack]})
    bodies.append({"rigid": True})
    normal = (total[0, 0] - total[0, 1]) * 2 * math.pi / (3 * math.log(3))
    force = math.pi * (0.5 * half_width) ** 2 / (2 * radius * normal)
    # The contact within the mesh, whatever the layers.
    force *= min(1.0, 0.6 * half_width / contact_width(total[:nodes, :nodes], x, radius, force)) ** 2
    loads, friction = steps(draw, force, mu), Friction.coulomb(mu)
    # Not symmetric, so that no two nodes change their status at once.
    height = x**2 / (2 * radius) * (1 + 0.1 * x / half_width)
    direct = Scene(
        Body.half_plane(**bodies[0]), Body.profile(x, height, **bodies[1]), steps=loads, friction=friction, coupling=coupling,
        mesh=Mesh(nodes=nodes, half_width=half_width),
    )  # fmt: skip
    dense = Scene(
        Body.matrix(x, compliance=total, width=np.full(nodes, x[1] - x[0])), Body.profile(x, height, rigid=True),
        steps=loads, friction=friction, coupling=coupling,
    )  # fmt: skip
    one, other = direct.run(check=True), dense.run(check=True)
    scale = np.max(other.state.pressure)
    for name in ("pressure", "shear"):
        np.testing.assert_allclose(getattr(one.state, name), getattr(other.state, name), rtol=0, atol=6e-12 * scale, err_msg=name)
    assert one.summary.events == other.summary.events
    assert one.summary.dissipation == pytest.approx(other.summary.dissipation, rel=1e-9, abs=1e-14)
    assert one.summary.largest_residual < 1e-10


def contact_width(compliance: Numbers, x: Numbers, radius: float, force: float) -> float:
    """Half-width of a frictionless contact, by solving for the pressures that close the gap at all nodes within it."""
    gap = x**2 / (2 * radius)
    for count in range(2, len(x) // 2):
        inside = slice(len(x) // 2 - count, len(x) // 2 + count)
        block = compliance[inside, inside]
        unit = np.linalg.solve(block, np.ones(2 * count))
        forces = np.linalg.solve(block, -gap[inside])
        forces += unit * (force - forces.sum()) / unit.sum()
        if forces[0] < 0:
            return float(abs(x[inside][0]))
    return float(x[-1])


@pytest.mark.parametrize("ratio, expected", [(5, -3.3e-3), (20, -1.9e-4)])
def test_a_thin_compressible_strip_is_winklers_foundation(ratio: float, expected: float) -> None:
    """P = 2 K a^3/(3 R t), K = 2 G (1 - nu)/(1 - 2 nu): the peak pressure differs by (t/a)^2."""
    shear, nu, t, radius = 10.0, 0.3, 1.0, 1000.0
    modulus, a = 2 * shear * (1 - nu) / (1 - 2 * nu), ratio * t
    strip = Body.half_plane(rigid=True, layers=[Layer(thickness=t, shear_modulus=shear, poisson_ratio=nu)])
    press = [Step(normal_force=2 * modulus * a**3 / (3 * radius * t))]
    mesh = Mesh(nodes=401, half_width=1.1 * a, gap="parabolic")
    result = Scene(strip, Body.disk(radius, rigid=True), mesh=mesh, steps=press).run(check=True)
    peak = modulus * a**2 / (2 * radius * t)
    assert result.observables.peak_pressure / peak - 1 == pytest.approx(expected, rel=0.03)
    assert "lower_datum" not in result.scene


def test_a_thin_incompressible_strip_follows_johnson() -> None:
    """P = 2 E a^5/(45 R t^3), p0 = E a^4/(24 R t^3): second order in t/a (Johnson 1985, section 5.8)."""
    modulus, t, radius, errors = 10.0, 1.0, 1000.0, []
    for a in (10.0, 20.0):
        strip = Body.half_plane(rigid=True, layers=[Layer(thickness=t, youngs_modulus=modulus, poisson_ratio=0.5)])
        press = [Step(normal_force=2 * modulus * a**5 / (45 * radius * t**3))]
        mesh = Mesh(nodes=401, half_width=1.2 * a, gap="parabolic")
        result = Scene(strip, Body.disk(radius, rigid=True), mesh=mesh, steps=press).run(check=True)
        errors.append(float(result.observables.peak_pressure) / (modulus * a**4 / (24 * radius * t**3)) - 1)
    assert math.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.1)
    assert abs(errors[1]) < 0.01


#: By finite elements (tests/finite_elements/coated_cylinder.py): coating E, nu, t; half-width, stick zone, peak pressure, centre of the
#: pressure, and sigma_yy and sigma_xy at the interface at x = -0.8, 0, 0.8.
BY_ELEMENTS = {
    "stiff": (
        400.0, 0.25, 0.5, (0.7111, 5e-4), (-0.598, 2e-3), (-0.050, 3e-3), (0.0897, 4e-4), (-0.057458, 8e-6),
        (-0.023770, -0.050926, -0.023658), (-0.014306, 0.003657, 0.018437),
    ),
    "soft": (
        20.0, 0.45, 0.3, (1.202, 1.5e-3), (-0.839, 7e-3), (0.789, 3e-3), (0.050566, 2e-6), (-0.015576, 8e-6),
        (-0.030415, -0.048267, -0.030459), (-0.004861, 0.008142, 0.015866),
    ),
}  # fmt: skip


@pytest.mark.parametrize("coating", BY_ELEMENTS)
def test_a_coated_cylinder_agrees_with_finite_elements(coating: str) -> None:
    """Pressed with friction and full coupling, then sheared."""
    modulus, nu, t, half_width, left, right, peak, centre, normal, shear = BY_ELEMENTS[coating]
    force = 0.0863074905
    body = Body.half_plane(
        youngs_modulus=100.0, poisson_ratio=0.3, layers=[Layer(thickness=t, youngs_modulus=modulus, poisson_ratio=nu)]
    )
    result = Scene(
        body,
        Body.disk(1000.0, rigid=True),
        friction=Friction.coulomb(0.5),
        mesh=Mesh(nodes=401, half_width=1.6 if coating == "soft" else 1.0, gap="parabolic"),
        steps=[Step(normal_force=force), Step(tangential_force=0.25 * force)],
    ).run(check=True)
    found = result.summary
    assert result.observables.contact_half_width == pytest.approx(half_width[0], abs=half_width[1])
    assert found.stick_left == pytest.approx(left[0], abs=left[1])
    assert found.stick_right == pytest.approx(right[0], abs=right[1])
    assert result.observables.peak_pressure == pytest.approx(peak[0], abs=peak[1])
    middle = np.sum(result.state.pressure * result.mesh.x) / np.sum(result.state.pressure)
    assert middle == pytest.approx(centre[0], abs=centre[1])
    at = mfv.stress.stress(result, [-0.8, 0.0, 0.8], np.full(3, -t))
    np.testing.assert_allclose(at["sigma_yy"], normal, rtol=0, atol=2e-6)
    np.testing.assert_allclose(at["sigma_xy"], shear, rtol=0, atol=2e-6)


def rubbed(lower: Body, **scene: Any) -> mfv.Result:
    steps_of = scene.pop("steps", [Step(normal_force=50), Step(force_ratio=0.6), Step(force_ratio=-0.6, cycles=1)])
    return Scene(
        lower, Body.disk(10.0, rigid=True), friction=Friction.coulomb(0.3), steps=steps_of, **scene
    ).run(check=True)  # fmt: skip


def test_a_layer_of_the_body_itself_changes_nothing() -> None:
    """All fields, observables and stresses are those without it, also in cycles and with a bulk stress."""
    loads = [Step(normal_force=50), Step(force_ratio=0.5, lower_bulk_stress=20), Step(force_ratio=-0.5, lower_bulk_stress=-20)]
    bare, coated = (
        rubbed(Body.half_plane(**ALLOY, layers=layers), steps=loads)
        for layers in (None, [Layer(thickness=0.03, **ALLOY), Layer(thickness=0.2, **ALLOY)])
    )
    peak = np.max(bare.state.pressure)
    for name in ("pressure", "shear"):
        np.testing.assert_allclose(getattr(coated.state, name), getattr(bare.state, name), rtol=0, atol=1e-10 * peak)
    for name in bare.observables:
        assert coated.observables[name] == pytest.approx(bare.observables[name], rel=1e-7, abs=1e-9 * peak), name
    x, y = np.array([-0.1, 0.05, 0.0, 0.3]), -np.array([0.01, 0.05, 0.4, 0.03])
    one, other = (mfv.stress.stress(result, x, y) for result in (bare, coated))
    for name in ("sigma_xx", "sigma_yy", "sigma_xy", "sigma_zz"):
        np.testing.assert_allclose(other[name], one[name], rtol=0, atol=1e-9 * peak, err_msg=name)


def test_interfaces_are_in_balance_and_layers_have_their_own_bulk_stress() -> None:
    """Normal and shear traction are continuous, extension along x is too; far away each layer has the stress of the common strain."""
    coating = Layer(thickness=0.05, youngs_modulus=200e3, poisson_ratio=0.2)
    loads = [Step(normal_force=50), Step(force_ratio=0.6, lower_bulk_stress=30)]
    result = rubbed(Body.half_plane(**ALLOY, layers=[coating]), steps=loads)
    x = np.array([-0.11, -0.05, 0.0, 0.12])
    above, below = (mfv.stress.stress(result, x, np.full(4, -0.05 * (1 + side))) for side in (0.0, 1e-9))
    for name in ("sigma_yy", "sigma_xy"):
        np.testing.assert_allclose(above[name], below[name], rtol=0, atol=1e-5)
    strains = [
        ((1 - nu**2) * at["sigma_xx"] - nu * (1 + nu) * at["sigma_yy"]) / e
        for at, e, nu in ((above, 200e3, 0.2), (below, 70e3, 0.33))
    ]
    np.testing.assert_allclose(*strains, rtol=0, atol=1e-9)
    far = mfv.stress.stress(result, [1e5, 1e5], [-0.01, -0.5])
    s11 = [(1 - 0.33**2) / 70e3, (1 - 0.2**2) / 200e3]
    np.testing.assert_allclose(far["sigma_xx"], [30 * s11[0] / s11[1], 30], rtol=1e-4)
    # The largest tractions that the summary names are those along the interface.
    seen = result.observables
    line = np.linspace(-1, 1, 4001)
    along = mfv.stress.stress(result, line, np.full_like(line, -0.05))
    assert seen.largest_lower_interface_shear == pytest.approx(np.max(np.abs(along["sigma_xy"])), rel=1e-5)
    assert seen.largest_lower_interface_tension == pytest.approx(np.max(along["sigma_yy"]), rel=1e-4)


def test_yield_is_that_of_the_layer() -> None:
    """The warning compares the stress in each layer with its own strength; without a strength a layer does not count."""
    coat: dict[str, Any] = {"thickness": 0.05, "youngs_modulus": 200e3, "poisson_ratio": 0.2}
    strong = rubbed(Body.half_plane(**ALLOY, yield_strength=1e3, layers=[Layer(**coat, yield_strength=1e4)]))
    weak = rubbed(Body.half_plane(**ALLOY, yield_strength=1e3, layers=[Layer(**coat, yield_strength=100.0)]))
    base = rubbed(Body.half_plane(**ALLOY, yield_strength=10.0, layers=[Layer(**coat)]))
    assert not any("yield" in line for line in strong.attributes.get("warnings", "").splitlines())
    assert any("exceeds its yield_strength 100 in layer 1" in line for line in weak.attributes.get("warnings", "").splitlines())
    assert any(
        "exceeds its yield_strength 10 below the layers" in line for line in base.attributes.get("warnings", "").splitlines()
    )
    assert weak.observables.largest_lower_von_mises_y > -0.05 > base.observables.largest_lower_von_mises_y


@pytest.mark.parametrize("thickness", [0.01, 0.6, 6.0])
def test_tractions_at_an_interface_are_its_largest_at_any_thickness(thickness: float) -> None:
    """Of coatings from a tenth to 60 times the half-width of the contact, also far beside it."""
    coating = Layer(thickness=thickness, youngs_modulus=280e3, poisson_ratio=0.33)
    seen = rubbed(Body.half_plane(**ALLOY, layers=[coating]), steps=[Step(normal_force=50), Step(force_ratio=0.6)])
    line = np.linspace(-20, 20, 1001) * max(thickness, 0.05)
    along = mfv.stress.stress(seen, line, np.full_like(line, -thickness))
    for name, values in (("tension", along["sigma_yy"]), ("shear", np.abs(along["sigma_xy"]))):
        largest = seen.observables[f"largest_lower_interface_{name}"]
        assert largest == pytest.approx(np.max(values), rel=1e-2), name
        assert largest >= np.max(values) * (1 - 1e-6), name


@pytest.mark.parametrize(
    "layers, keys, message",
    [
        ("&layer body=2, thickness=1, {m} /\n&layer body=1, thickness=1, {m} /", "", "give the layers of body 1 first"),
        ("&layer body=1, {m} /", "", "&layer 1: thickness is missing"),
        ("&layer body=1, thickness=1, youngs_modulus=1 /", "", "&layer 1: poisson_ratio is missing"),
        ("&layer body=3, thickness=1, {m} /", "", "must be a whole number from 1 to 2"),
        ("&layer body=1, thickness=1, axis_angle=3, {m} /", "", "has no effect with elasticity='isotropic'"),
        ("&layer body=2, thickness=1, {m} /", "elasticity='own',", "must be 'half_plane' with layers, or be omitted"),
        ("&layer body=2, thickness=1, {m} /", "kernel='fourier',", "has no effect for a disk with layers"),
    ],
)
def test_wrong_layers_are_refused(layers: str, keys: str, message: str) -> None:
    material = "youngs_modulus=2, poisson_ratio=0.3"
    text = (
        f"&body shape='half_plane', {material} /\n&body shape='disk', radius=1, {keys} {material} /\n"
        f"{layers.format(m=material)}\n&step normal_force=1e-3 /\n"
    )
    with pytest.raises(mfv.MfvError, match=re.escape(message)):
        mfv.run(Scene.from_text(text))


@pytest.mark.parametrize(("thickness", "allowed"), [(0.003, 5.0e-3), (0.03, 2.0e-4)])
def test_edges_of_thin_coatings(thickness: float, allowed: float) -> None:
    """Within the last few thicknesses from an edge of the contact tractions do not follow the square root of the distance."""

    def half_width(nodes: int) -> mfv.Result:
        coated = Body.half_plane(youngs_modulus=70e3, poisson_ratio=0.33)
        coated.layers = [Layer(thickness=thickness, youngs_modulus=300e3, poisson_ratio=0.2)]
        pad = Body.disk(10.0, youngs_modulus=210e3, poisson_ratio=0.3)
        steps = [Step(normal_force=50.0, friction=False)]
        return Scene(coated, pad, mesh=Mesh(nodes=nodes), output=Output(error_estimate=True), steps=steps).run(check=True)

    coarse, fine = half_width(101), half_width(801)
    error = abs(coarse.summary.contact_half_width - fine.summary.contact_half_width)
    assert error < allowed * fine.summary.contact_half_width
    assert error < 3.0 * coarse.error_bar("contact_half_width")  # as in tests/truth


@pytest.mark.parametrize("stiffness", [0.2, 3.0])
def test_dissipation_beside_nothing_is_in_doubt(stiffness: float) -> None:
    """Under a soft coating nearly all nodes stick in a press; increments that are accurate for a cycle do not know what it dissipates."""
    lower = Body.half_plane(
        shear_modulus=1.0, poisson_ratio=0.3, layers=[Layer(thickness=1.0, shear_modulus=stiffness, poisson_ratio=0.3)]
    )
    force = math.pi / 70.0 * (0.5 if stiffness < 1.0 else 4.1)
    steps = [Step(normal_force=0.5 * force), Step(force_ratio=0.6)]
    scene = Scene(
        lower, Body.disk(50.0, rigid=True), mesh=Mesh(nodes=900, half_width=1.12), friction=Friction.coulomb(0.5), steps=steps
    )
    scene.solver, scene.coupling = mfv.Solver(accuracy=1e-2), "full"
    sheared = scene.run()
    scene.steps = steps[:1]
    pressed = scene.run()
    scene.solver = mfv.Solver(stepping="event")
    exact = scene.run()
    wrong = abs(pressed.summary.dissipation / exact.summary.dissipation - 1.0)
    doubt = [warning for warning in pressed.warnings if "large increments find it" in warning]
    assert pressed.summary.leaps > 0 and ((len(doubt) == 1 and "dissipation" in pressed.unresolved) or wrong < 1e-2)
    assert (wrong > 0.1) == (stiffness < 1.0)
    assert not [warning for warning in sheared.warnings if "large increments find it" in warning]
