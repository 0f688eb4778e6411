"""Wedges, powers, rounded punches and profiles: contacts against their closed forms, and the warnings that go with surfaces."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scenes import HALF_PLANE

import mfv
from mfv import Body, Scene, Step

G, KAPPA, MU, SLOPE = 1.0, 1.8, 0.3, 0.01
#: The force on a wedge that makes a contact of the half-width 1.
WEDGE_FORCE = 2.0 / 0.7 * SLOPE
ANGLE = float(np.degrees(np.arctan(SLOPE)))


def scene(upper: mfv.Body, force: float, *, lower: mfv.Body = HALF_PLANE, nodes: int = 401, **mesh: Any) -> mfv.Scene:
    """Two bodies without coupling, pressed without friction, then sheared to 0.3 of sliding; the mesh is chosen."""
    steps = [mfv.Step(normal_force=force, friction=False), mfv.Step(force_ratio=0.3)]
    return mfv.Scene(
        lower,
        upper,
        steps=steps,
        friction=mfv.Friction.coulomb(MU),
        mesh=mfv.Mesh(nodes=nodes, **mesh),
        coupling="none",
    )


def edges(result: mfv.Result) -> tuple[float, float]:
    """Half-width of the contact and stick ratio, between nodes."""
    return float(result.summary.contact_half_width), float(result.summary.stick_ratio)


def warnings(result: mfv.Result) -> list[str]:
    """What the summary warns of."""
    return str(result.attributes.get("warnings", "")).splitlines()


def half_width_of(force: Callable[[float], float], wanted: float) -> float:
    """The half-width of a growing force, by bisection."""
    lower, upper = 0.0, 10.0
    for _ in range(100):
        middle = 0.5 * (lower + upper)
        lower, upper = (middle, upper) if force(middle) < wanted else (lower, middle)
    return lower


def rounded_force(a: float, b: float, radius: float) -> float:
    """The force on a rounded punch over E*, from the integral of the slope, by the midpoint rule in asin(x/a)."""
    if a <= b:
        return 0.0
    ends = np.linspace(np.arcsin(b / a), np.pi / 2, 20001)
    t = 0.5 * (ends[1:] + ends[:-1])
    return float(np.sum(a * np.sin(t) * (a * np.sin(t) - b)) * (ends[1] - ends[0]) / radius)


def test_a_wedge() -> None:
    """401 nodes: half-width 1, stick ratio 0.7; a profile of three points is the same, its corner on a node or between two."""
    named = mfv.run(scene(mfv.Body.wedge(ANGLE, rigid=True), WEDGE_FORCE))
    assert edges(named) == pytest.approx((1.0, 0.7), abs=1e-5)
    points = np.array([-1.5, 0.0, 1.5])
    for nodes in (401, 400):
        profile = mfv.Body.profile(points, SLOPE * np.abs(points), interpolation="linear", rigid=True)
        result = mfv.run(scene(profile, WEDGE_FORCE, nodes=nodes, half_width=1.2))
        assert edges(result)[0] == pytest.approx(1.0, abs=1e-5)
        assert len(warnings(result)) == 0
    reference = named.reference
    exact = mfv.reference.wedge_half_width(WEDGE_FORCE, SLOPE, G, KAPPA)
    assert reference.contact_half_width == pytest.approx(exact, rel=1e-14)
    assert mfv.reference.wedge_stick_ratio(0.3, 1.0, 1.0) == pytest.approx(0.7)
    inside = (np.abs(named.mesh.x) > 0.02) & (np.abs(named.mesh.x) < 0.95)
    x = named.mesh.x[inside]
    np.testing.assert_allclose(mfv.reference.wedge_pressure(x, WEDGE_FORCE, 1.0), reference.pressure[inside], rtol=1e-12)
    np.testing.assert_allclose(named.state.pressure[inside], reference.pressure[inside], rtol=2e-3)
    shear = mfv.reference.wedge_shear(x, 0.3 * MU * WEDGE_FORCE, WEDGE_FORCE, 1.0, MU)
    np.testing.assert_allclose(shear, reference.shear[inside], rtol=1e-10, atol=1e-14)
    assert np.max(np.abs(named.state.shear[inside] - shear)) < 0.02 * np.max(shear)


@pytest.mark.parametrize("exponent", [1.5, 3.0, 4.0, 6.0])
def test_powers(exponent: float) -> None:
    force = mfv.run(scene(mfv.Body.power(0.01, exponent, rigid=True), 0.02))
    a = mfv.reference.power_half_width(0.02, 0.01, exponent, G, KAPPA)
    assert force.reference.contact_half_width == pytest.approx(a, rel=1e-14)
    assert edges(force)[0] == pytest.approx(a, rel=7e-5 if exponent > 4 else 2e-5)
    ratio = mfv.reference.power_stick_ratio(0.3, 1.0, 1.0, exponent)
    assert ratio == pytest.approx(0.7 ** (1 / exponent), rel=1e-14)
    assert edges(force)[1] == pytest.approx(ratio, abs=3e-5)
    approach = mfv.reference.power_approach(a, 0.01, exponent, a)
    assert force.summary.approach == pytest.approx(approach, rel=1e-3)  # the datum of a power is the half-width


@pytest.mark.parametrize("b", [0.05, 0.5, 0.8])
def test_rounded_punches(b: float) -> None:
    radius = 100.0
    force = 2.0 / 0.7 * rounded_force(1.0, b, radius)
    assert mfv.reference.rounded_punch_half_width(force, b, radius, G, KAPPA) == pytest.approx(1.0, rel=1e-7)
    stick = half_width_of(lambda a: rounded_force(a, b, radius), 0.7 * rounded_force(1.0, b, radius))
    assert mfv.reference.rounded_punch_stick_ratio(0.3, 1.0, 1.0, 1.0, b) == pytest.approx(stick, rel=1e-6)
    result = mfv.run(scene(mfv.Body.rounded_punch(b, radius, rigid=True), force))
    assert edges(result) == (pytest.approx(1.0, abs=1e-5), pytest.approx(stick, abs=1e-5))
    assert result.reference.contact_half_width == pytest.approx(1.0, rel=1e-7)
    x = result.mesh.x
    pressure = mfv.reference.rounded_punch_pressure(x, force, 1.0, b)
    np.testing.assert_allclose(pressure, result.reference.pressure, rtol=1e-4, atol=1e-5)
    inside = np.abs(x) < 0.97
    assert np.max(np.abs(result.state.pressure - result.reference.pressure)[inside]) < 5e-3 * np.max(result.state.pressure)


def sizes(result: mfv.Result) -> NDArray[np.float64]:
    """What must not depend on which body is below, on units, or on how a mesh came about."""
    shear = np.abs(result.state.shear)
    return np.array([*edges(result), result.state.pressure.max(), shear.max()])


def test_either_way_up_rigid_or_elastic() -> None:
    """A wedge above or below; of two equal materials the half-width is twice as large at the same force."""
    force = WEDGE_FORCE / 2
    rigid_plane, wedge = mfv.Body.half_plane(rigid=True), {"shear_modulus": 1.0, "poisson_ratio": 0.3}
    above = mfv.run(scene(mfv.Body.wedge(ANGLE, rigid=True), force, nodes=101))
    below = mfv.run(scene(rigid_plane, force, lower=mfv.Body.wedge(ANGLE, **wedge), nodes=101))
    both = mfv.run(scene(mfv.Body.wedge(ANGLE, **wedge), force, nodes=101))
    np.testing.assert_allclose(sizes(below), sizes(above), rtol=1e-10)
    assert both.reference.contact_half_width == pytest.approx(1.0, rel=1e-12)
    np.testing.assert_allclose(sizes(both), sizes(above) * [2, 1, 1 / 2 * 1, 1 / 2 * 1], rtol=1e-10)


def test_sums_of_shapes() -> None:
    """A wedge against a disk and a rounded punch: the closed form adds the gaps at one half-width."""
    lower = mfv.Body.rounded_punch(0.3, 50.0, shear_modulus=1.0, poisson_ratio=0.3)
    force = 2.0 / 0.7 * (0.8 * SLOPE + rounded_force(0.8, 0.3, 50.0))
    result = mfv.run(scene(mfv.Body.wedge(ANGLE, rigid=True), force, lower=lower))
    assert result.reference.contact_half_width == pytest.approx(0.8, rel=1e-7)
    assert edges(result)[0] == pytest.approx(0.8, abs=1e-4)
    disk = mfv.Body.disk(200.0, rigid=True)
    wedge = mfv.Body.wedge(ANGLE, shear_modulus=1.0, poisson_ratio=0.3)
    result = mfv.run(scene(disk, 2.0 / 0.7 * (0.8 * SLOPE + np.pi * 0.64 / 800), lower=wedge))
    assert result.reference.contact_half_width == pytest.approx(0.8, rel=1e-12)
    assert edges(result)[0] == pytest.approx(0.8, abs=1e-4)


def test_meshes_grow_under_named_shapes() -> None:
    """A load that the scene's steps do not have; and datums: only the approach knows them."""
    pressed = scene(mfv.Body.wedge(ANGLE, rigid=True), 0.1 * WEDGE_FORCE, nodes=41)
    with pressed.contact() as contact:
        contact.advance(normal_force=WEDGE_FORCE)
        assert contact.result().summary.contact_half_width == pytest.approx(1.0, abs=5e-4)
    with pytest.raises(mfv.errors.InputError, match="datum: is needed"):
        mfv.run(mfv.Scene(HALF_PLANE, mfv.Body.wedge(1.0, rigid=True), steps=[mfv.Step(approach=0.01)]))
    with pytest.raises(mfv.errors.InputError, match="half_width: is needed"):
        lower = mfv.Body.half_plane(shear_modulus=1.0, poisson_ratio=0.3, datum=1.0)
        mfv.run(mfv.Scene(lower, mfv.Body.wedge(1.0, rigid=True), steps=[mfv.Step(shift=0.01)]))


def test_parabolas_have_no_end() -> None:
    """A rigid disk of the radius 1 with gap='parabolic': the contact extends beyond |x| = 1, as in Hertz theory."""
    lower = mfv.Body.half_plane(youngs_modulus=1.0, poisson_ratio=0.0)
    for force in (0.785, 1.1):
        press = [mfv.Step(normal_force=force)]
        for mesh in (mfv.Mesh(nodes=201, half_width=1.25, gap="parabolic"), mfv.Mesh(nodes=201, gap="parabolic")):
            result = mfv.run(mfv.Scene(lower, mfv.Body.disk(1.0, rigid=True), mesh=mesh, steps=press))
            exact = np.sqrt(4 * force / np.pi)
            assert result.reference.contact_half_width == pytest.approx(exact, rel=1e-14)
            assert result.summary.contact_half_width == pytest.approx(exact, rel=3e-4)
            assert result.state.pressure.max() == pytest.approx(exact / 2, rel=1e-3)
            assert all("small strains" in warning for warning in warnings(result))


def test_warnings_of_surfaces_that_end() -> None:
    """Disk and profile; the corner of a flat punch only where the intervals miss it."""
    lower = mfv.Body.half_plane(youngs_modulus=1.0, poisson_ratio=0.0)
    x = np.linspace(-1.0, 1.0, 2001)
    keys: dict[str, Any] = {"mesh": mfv.Mesh(nodes=101, half_width=1.25), "steps": [mfv.Step(normal_force=2.5)]}
    for upper in (mfv.Body.disk(1.0, rigid=True), mfv.Body.profile(x, 0.01 * x**2, rigid=True)):
        result = mfv.run(mfv.Scene(lower, upper, **keys))
        assert ["reaches the end of the surface of the upper body" in text for text in warnings(result)].count(True) == 1
    punch = mfv.run(mfv.Scene(lower, mfv.Body.flat_punch(1.0), **keys))
    assert all("small strains" in text for text in warnings(punch))
    keys["mesh"] = mfv.Mesh(nodes=25, half_width=1.25)
    wide = mfv.run(mfv.Scene(lower, mfv.Body.flat_punch(1.0), **keys))
    assert ["the contact ends at x = -1.05 instead" in text for text in warnings(wide)].count(True) == 1


def test_warnings_of_rounded_edges_that_the_mesh_does_not_resolve() -> None:
    """Contact beyond the flat over less than four intervals: the mesh that the warning asks for has none."""
    lower = mfv.Body.half_plane(youngs_modulus=115000.0, poisson_ratio=0.32)
    upper = mfv.Body.rounded_punch(3.0, 3.0, youngs_modulus=115000.0, poisson_ratio=0.32)
    for nodes in (101, 151, 201, 301, 451):
        keys: dict[str, Any] = {"mesh": mfv.Mesh(nodes=nodes), "steps": [mfv.Step(normal_force=500.0)]}
        (text,) = warnings(mfv.run(mfv.Scene(lower, upper, **keys)))
        wanted = re.search(r"rounded edges of the upper body .* about (\d+) nodes", text)
        assert wanted, text
        keys["mesh"] = mfv.Mesh(nodes=int(wanted[1]))
        assert warnings(mfv.run(mfv.Scene(lower, upper, **keys))) == [], nodes


def test_warnings_of_what_is_between_points() -> None:
    """Corners that are rounded, a smooth curve of few points that is not; not where it does not matter or corners are meant."""
    x = np.array([-1.5, 0.0, 1.5])

    def warned(profile: mfv.Body) -> list[str]:
        result = mfv.run(scene(profile, WEDGE_FORCE, nodes=101, half_width=1.2))
        return [text for text in warnings(result) if "profile" in text]

    rounded = warned(mfv.Body.profile(x, SLOPE * np.abs(x), interpolation="monotone_cubic", rigid=True))
    assert len(rounded) == 1 and "interpolation='linear' if the profile has corners" in rounded[0]
    assert len(warned(mfv.Body.profile(x, SLOPE * np.abs(x), rigid=True))) == 1
    assert len(warned(mfv.Body.profile(x, SLOPE * np.abs(x), interpolation="linear", rigid=True))) == 0
    few, many = np.linspace(-1.5, 1.5, 11), np.linspace(-1.5, 1.5, 401)
    polygon = mfv.Body.profile(few, 0.01 * few**2, interpolation="linear", rigid=True)
    assert "interpolation='monotone_cubic'" in warned(polygon)[0]
    assert len(warned(mfv.Body.profile(many, 0.01 * many**2, rigid=True))) == 0
    assert len(warned(mfv.Body.profile(many, 0.01 * many**2, interpolation="monotone_cubic", rigid=True))) == 0


def test_a_trace_as_it_comes(tmp_path: Path) -> None:
    """Micrometres, outwards, tilted, not centred, with a heading: the same contact as the profile in the case's own units."""
    x = np.linspace(-0.6, 0.6, 601)
    recess = 0.02 * (x**2 - 0.3 * x**4)
    outwards = -recess + 0.004 * x + 0.3
    columns = np.column_stack([1e3 * (x + 0.6), 1e3 * outwards])
    (tmp_path / "trace.csv").write_text(
        "Instrument 7, trace 3\nX [um],Z [um]\n" + "\n".join(f"{a:.12g}, {b:.12g}" for a, b in columns) + "\n"
    )
    scales: dict[str, Any] = {"position_scale": 1e-3, "height_scale": -1e-3, "level": "line", "centred": True}
    trace = mfv.Body(shape="profile", file=tmp_path / "trace.csv", rigid=True, **scales)
    level = recess - np.polyval(np.polyfit(x, recess, 1), x)
    own = mfv.Body.profile(x, level, rigid=True)
    results = [mfv.run(scene(body, 0.002, nodes=61, half_width=0.6)) for body in (trace, own)]
    np.testing.assert_allclose(sizes(results[0]), sizes(results[1]), rtol=1e-6)
    assert results[0].summary.approach == pytest.approx(results[1].summary.approach, rel=1e-6)


def test_results_name_the_shapes() -> None:
    x = np.linspace(-0.1, 0.1, 41)
    nodes = (np.arange(21) - 10) * 8.0e-4
    distance = np.maximum(np.abs(nodes[:, None] - nodes), 2.0e-4)
    half_plane = Body.half_plane(shear_modulus=1.0, poisson_ratio=0.3)
    pairs = [
        ("wedge", Body.wedge(5.0, rigid=True), half_plane),
        ("power", Body.power(2.0, 2.0, rigid=True), half_plane),
        ("profile", Body.profile(x, x**2 / 0.5, interpolation="monotone_cubic", rigid=True), half_plane),
        ("rounded_punch", Body.rounded_punch(half_width=0.01, edge_radius=0.1, rigid=True), half_plane),
        ("disk", Body.disk(0.25, rigid=True), Body.matrix(nodes, compliance=0.5 * np.log(0.25 / distance))),
    ]
    for name, upper, lower in pairs:
        result = Scene(lower, upper, steps=[Step(normal_force=1.0e-5)]).run(check=True)
        assert result.attributes["upper_body"] == f"rigid {name}"
        assert result.attributes["lower_body"] == lower.shape


def test_tension_at_edges_beside_the_finest_intervals() -> None:
    """With full coupling the last edges are a few intervals from where the refined mesh is finest, which is where they were at other
    times: the tension is that of a fine equal mesh (before: 30 % too small to 70 % too large)."""
    pressed = {True: [mfv.Step(normal_force=300), mfv.Step(tangential_force=126), mfv.Step(normal_force=390)], False: []}
    pressed[False] = [mfv.Step(normal_force=300, friction=False), mfv.Step(tangential_force=42)]
    last = {True: 0.0, False: -25.2}
    for oblique, steps in pressed.items():
        tension = {}
        for mesh in (mfv.Mesh(nodes=801), *(mfv.Mesh(nodes=n, refine="edges") for n in (140, 150, 160))):
            result = mfv.Scene(
                mfv.Body.half_plane(youngs_modulus=1e5, poisson_ratio=0.3),
                mfv.Body.disk(50, rigid=True),
                friction=mfv.Friction.coulomb(0.7),
                mesh=mesh,
                steps=[*steps, mfv.Step(tangential_force=last[oblique])],
            ).run(check=True)
            tension[mesh.nodes] = result.observables.lower_tension
        for nodes in (140, 150, 160):
            assert tension[nodes] == pytest.approx(tension[801], rel=0.03), (oblique, nodes)


def test_tension_at_an_edge_that_the_refined_mesh_misses() -> None:
    """The wedge unloads, and its contact ends where intervals are wide: the tension is that of a fine equal mesh."""
    steps = [
        mfv.Step(normal_force=0.01316),
        mfv.Step(tangential_force=-8.469e-4, upper_bulk_stress=0.0609),
        mfv.Step(normal_force=0.00433, upper_bulk_stress=0.1156),
    ]
    tension = {}
    for mesh in (
        mfv.Mesh(nodes=601, half_width=0.0625),
        *(mfv.Mesh(nodes=n, half_width=0.0625, refine="edges") for n in (130, 150, 170)),
    ):
        result = mfv.Scene(
            mfv.Body.wedge(0.77022, rigid=True),
            mfv.Body.half_plane(shear_modulus=7.10786, poisson_ratio=0.3),
            plane="stress",
            coupling="none",
            friction=mfv.Friction.coulomb(0.6),
            mesh=mesh,
            steps=steps,
        ).run(check=True)
        tension[mesh.nodes] = result.observables.upper_tension
    for nodes in (130, 150, 170):
        assert tension[nodes] == pytest.approx(tension[601], rel=0.02), nodes


@pytest.mark.parametrize(("nodes", "part"), [(401, 0.01), (801, 0.003)])
def test_largest_tension_under_rounded_edges(nodes: int, part: float) -> None:
    """8 and 16 nodes in each rounded edge, where the pressure has its maxima: superposed flat punches (Jaeger 1998; Ciavarella 1998)."""
    flat, radius, half_width, mu = 1.0, 10.0, 1.05, 0.5
    stiff = mfv.Body.half_plane(youngs_modulus=115000.0, poisson_ratio=0.32)
    punch = mfv.Body.rounded_punch(flat, radius, youngs_modulus=115000.0, poisson_ratio=0.32)
    modulus = 115000.0 / (1.0 - 0.32**2) / 2.0

    def force(a: float) -> float:
        angle = np.arccos(flat / a)
        return float(modulus * a**2 / (4.0 * radius) * (2.0 * angle - np.sin(2.0 * angle)))

    place, weight = np.polynomial.legendre.leggauss(40)
    for stick in (1.01, 1.03):
        least = np.arcsin(stick / half_width)
        angle = least + (0.5 * np.pi - least) * 0.5 * (1.0 + place)
        widths = half_width * np.sin(angle)
        integral = 0.5 * (0.5 * np.pi - least) * np.sum(weight * widths * np.arccos(flat / widths))
        steps = [
            mfv.Step(normal_force=force(half_width), friction=False),
            mfv.Step(force_ratio=1.0 - force(stick) / force(half_width)),
        ]
        result = mfv.Scene(stiff, punch, steps=steps, friction=mfv.Friction.coulomb(mu), mesh=mfv.Mesh(nodes=nodes)).run(check=True)
        exact = 2.0 * mu * modulus / (np.pi * radius) * integral
        assert result.observables.lower_tension == pytest.approx(exact, rel=part)


def test_tension_beside_the_tip_of_a_wedge() -> None:
    """A stick zone ends three intervals from the tip, where the pressure is largest: the tension is that of fine meshes, behind the contact."""
    steps = [mfv.Step(normal_force=4.754e-3), mfv.Step(normal_force=0.011886, tangential_force=1.0697e-3)]
    found = {
        nodes: mfv.Scene(
            mfv.Body.half_plane(shear_modulus=1.0, poisson_ratio=0.01),
            mfv.Body.wedge(4.95866, rigid=True),
            friction=mfv.Friction.coulomb(0.5),
            mesh=mfv.Mesh(nodes=nodes),
            steps=steps,
        )
        .run(check=True)
        .observables
        for nodes in (101, 103, 603)
    }
    for nodes in (101, 103):
        assert found[nodes].lower_tension == pytest.approx(found[603].lower_tension, rel=0.03), nodes
        assert found[nodes].lower_tension_x == pytest.approx(found[603].lower_tension_x, rel=0.03), nodes


def test_a_datum_inside_the_contact_is_noticed() -> None:
    """Half-width 1; the default datum is that of the contact, and does not lie inside it."""
    steps = [mfv.Step(normal_force=WEDGE_FORCE)]
    wedge = mfv.Body.wedge(ANGLE, rigid=True)
    for datum, noticed in ((None, False), (0.9, False), (0.7, True)):
        keys = {} if datum is None else {"datum": datum}
        lower = mfv.Body.half_plane(shear_modulus=1.0, poisson_ratio=0.3, **keys)
        warnings = mfv.Scene(lower, wedge, steps=steps).run(check=True).attributes["warnings"]
        assert ("exceeds the datum" in warnings) == noticed, datum


def test_a_datum_that_depends_on_the_case_is_noticed() -> None:
    """By default the load or the mesh determines it; a key, a disk or a profile has one for all cases."""
    wedge, disk = mfv.Body.wedge(ANGLE, rigid=True), mfv.Body.disk(20.0, rigid=True)
    steps, mesh = [mfv.Step(normal_force=WEDGE_FORCE)], mfv.Mesh(half_width=1.5)
    given = mfv.Body.half_plane(shear_modulus=1.0, poisson_ratio=0.3, datum=2.0)
    for lower, upper, noticed in ((HALF_PLANE, wedge, True), (given, wedge, False), (HALF_PLANE, disk, False)):
        warnings = mfv.Scene(lower, upper, steps=steps, mesh=mesh).run(check=True).attributes["warnings"]
        assert ("give datum" in warnings) == noticed, (lower, upper)
    with mfv.Scene(HALF_PLANE, wedge, mesh=mesh).contact() as contact:
        contact.advance(normal_force=WEDGE_FORCE)
        assert contact["scene/lower_datum"] == 1.5 and contact["scene/lower_datum_of_case"] == 1
        assert "give datum" in contact.result().attributes["warnings"]


def test_cycles_that_dissipate_nothing_have_no_slip_zones_to_resolve() -> None:
    """A tilted punch slips while it is sheared, not in the smaller cycles: their dissipation is a rounding error."""
    result = mfv.Scene(
        mfv.Body.half_plane(youngs_modulus=2.6, poisson_ratio=0.25),
        mfv.Body.flat_punch(1.0),
        coupling="goodman",
        mesh=mfv.Mesh(nodes=145),
        friction=mfv.Friction.coulomb(0.005),
        steps=[
            Step(normal_force=0.026, friction=False),
            Step(rotation=-0.001),
            Step(force_ratio=0.3),
            Step(force_ratio=0.15, cycles=1),
        ],
    ).run(check=True)
    assert abs(result.observables.cycle_dissipation) < 1e-12 * result.observables.dissipation
    assert "not resolved" not in result.attributes["warnings"]


@pytest.mark.parametrize(
    ("lower", "upper", "wear", "consequence"),
    [
        (HALF_PLANE, mfv.Body.disk(10.0, rigid=True), None, "positions along the bodies"),
        (HALF_PLANE, mfv.Body.disk(10.0, rigid=True), mfv.Wear(coefficient=1.0e-9), "over the contact only"),
        (mfv.Body.wedge(1.0, shear_modulus=1.0, poisson_ratio=0.3), mfv.Body.disk(10.0, rigid=True), None, "all tractions"),
    ],
)
def test_a_far_slide_is_noticed_after_the_return(lower: mfv.Body, upper: mfv.Body, wear: mfv.Wear | None, consequence: str) -> None:
    """Half-width 0.13 to 0.19: a slide of 0.1 and back, and of less than a tenth."""
    for far, noticed in ((0.1, True), (0.011, False)):
        steps = [Step(normal_force=0.01, friction=False), Step(shift=far), Step(shift=0.0, cycles=2)]
        scene = mfv.Scene(
            lower, upper, steps=steps, wear=wear, friction=mfv.Friction.coulomb(0.1), mesh=mfv.Mesh(nodes=61, half_width=0.6)
        )
        warnings = scene.run(check=True).attributes["warnings"]
        assert ("has slid by" in warnings and consequence in warnings) == noticed, warnings


def test_a_narrow_slip_zone_at_one_edge_is_noticed_beside_a_wide_one() -> None:
    """A bulk stress made the right edge slip back over 2 nodes of 140, and the tension there is twice that of fine meshes."""
    cycle = {"tangential_force": 6.5888e-5, "lower_bulk_stress": 2.49727e-4}
    tensions = {}
    for nodes, noticed in ((140, True), (420, False), (840, False)):
        result = mfv.Scene(
            mfv.Body.half_plane(youngs_modulus=0.69003, poisson_ratio=0.33),
            mfv.Body.disk(162.0835, youngs_modulus=4.81374, poisson_ratio=0.4),
            coupling="none",
            mesh=mfv.Mesh(nodes=nodes, half_width=1.6),
            friction=mfv.Friction.coulomb(0.2873456),
            steps=[
                Step(normal_force=0.00206331),
                Step(tangential_force=-3.49079e-4, lower_bulk_stress=-2.49727e-4),
                Step(cycles=2, **cycle),
            ],
        ).run(check=True)
        assert ("lower_tension" in result.attributes["warnings"]) == noticed, nodes
        tensions[nodes] = float(result.observables.lower_tension)
    assert tensions[420] == pytest.approx(tensions[840], rel=0.01)
    assert tensions[140] > 1.5 * tensions[840]
