"""Pins that fit their bores neatly or with interference, against closed forms: Lame, Kelvin, Persson, gross sliding; pads pressed in.

tests/python/test_fits_independent.py has histories with slip.
"""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

import mfv
from mfv import errors
from mfv.stress import stress

RADIUS, INTERFERENCE, MU = 10.0, 0.01, 0.3
STEEL = {"youngs_modulus": 2.0e5, "poisson_ratio": 0.3}
BRONZE = {"youngs_modulus": 1.1e5, "poisson_ratio": 0.35}


def fit(*steps: mfv.Step, pin: dict[str, float] = STEEL, bore: dict[str, float] = STEEL, nodes: int = 60, **more: Any) -> mfv.Scene:
    """A pin in a bore of its radius."""
    bodies = {"lower": mfv.Body.hole(RADIUS, **bore), "upper": mfv.Body.disk(RADIUS, **pin)}
    friction = {"friction": mfv.Friction.coulomb(MU)} if "friction" not in more else {}
    return mfv.Scene(**bodies, mesh=mfv.Mesh(normals="radial", nodes=nodes), steps=list(steps), **friction, **more)


def solved(*steps: mfv.Step, **more: Any) -> mfv.Result:
    return mfv.run(fit(*steps, **more), check=True)


def kolosov(material: dict[str, float], plane: str) -> tuple[float, float]:
    """Shear modulus and Kolosov's constant."""
    nu = material["poisson_ratio"]
    return material["youngs_modulus"] / (2 + 2 * nu), 3 - 4 * nu if plane == "strain" else (3 - nu) / (1 + nu)


def lame_pressure(pin: dict[str, float], bore: dict[str, float], plane: str = "strain") -> float:
    """The pressure of a pin in an infinite plate: it shrinks by (kappa - 1) p R/(4 G), the bore grows by p R/(2 G)."""
    (of_pin, kappa), (of_bore, _) = kolosov(pin, plane), kolosov(bore, plane)
    return INTERFERENCE / RADIUS / ((kappa - 1) / (4 * of_pin) + 1 / (2 * of_bore))


def press(interference: float = INTERFERENCE) -> mfv.Step:
    return mfv.Step(interference=interference)


@pytest.mark.parametrize("plane", ["strain", "stress"])
@pytest.mark.parametrize(("pin", "bore"), [(STEEL, STEEL), (STEEL, BRONZE), (BRONZE, STEEL)])
def test_pressed_in(pin: dict[str, float], bore: dict[str, float], plane: str) -> None:
    """Lame's solution: pressure, closing force, stresses around the bore and in the pin."""
    result = solved(press(), pin=pin, bore=bore, plane=plane)
    pressure = lame_pressure(pin, bore, plane)
    assert result.state.pressure == pytest.approx(pressure, rel=1e-12)
    assert result.summary.closing_force == pytest.approx(2 * np.pi * RADIUS * pressure, rel=1e-12)
    assert np.max(np.abs(result.state.shear)) < 1e-12 * pressure
    assert result.observables.lower_tension == pytest.approx(pressure, rel=1e-10)
    angle, distance = np.meshgrid(np.linspace(-np.pi, np.pi, 25), RADIUS * np.array([1.0, 1.3, 4.0]))
    around = stress(result, distance * np.sin(angle), RADIUS - distance * np.cos(angle))
    for name, sign in (("sigma_rr", -1.0), ("sigma_thetatheta", 1.0)):
        assert around[name] == pytest.approx(sign * pressure * (RADIUS / distance) ** 2, rel=1e-10)
    inside = stress(result, 0.3 * distance * np.sin(angle), RADIUS - 0.2 * distance * np.cos(angle), body="upper")
    assert np.nanmax(np.abs(inside["sigma_xx"] + pressure)) < 1e-10 * pressure


def test_the_gap_opens_where_lame_and_the_load_say() -> None:
    """Without friction p = p0 + P/(pi R) cos(theta) until it is zero opposite to the load, at P = pi R p0."""
    lame = lame_pressure(STEEL, BRONZE)
    opens = np.pi * RADIUS * lame
    for nodes in (40, 81):  # a cosine is a mode of the mesh
        result = solved(press(), mfv.Step(normal_force=0.97 * opens), bore=BRONZE, nodes=nodes, friction=None)
        expected = lame * (1 + 0.97 * np.cos(result.mesh.arc / RADIUS))
        assert result.state.pressure == pytest.approx(expected, abs=1e-11 * lame) and result.summary.contact_nodes == nodes
    beyond = solved(press(), mfv.Step(normal_force=1.03 * opens), bore=BRONZE, nodes=160, friction=None)
    assert beyond.summary.contact_nodes < 160 and beyond.state.status[[0, -1]].tolist() == [0, 0]


def test_a_stuck_pin_of_one_material_is_part_of_the_plate() -> None:
    """Kelvin's solution for a force in a plate, on a circle about it."""
    force, kappa = 1000.0, 3 - 4 * STEEL["poisson_ratio"]
    errors_of = []
    for nodes in (40, 80, 160):
        result = solved(press(), mfv.Step(tangential_force=force), nodes=nodes)
        angle, unit = result.mesh.arc / RADIUS - np.pi / 2, force / (2 * np.pi * RADIUS * (kappa + 1))
        pressure = lame_pressure(STEEL, STEEL) + (kappa + 3) * unit * np.cos(angle)
        shear = -(kappa - 1) * unit * np.sin(angle)
        errors_of.append(np.max(np.abs([result.state.pressure - pressure, result.state.shear - shear])) / unit)
        assert result.summary.stick_nodes == nodes
    assert np.log2(np.array(errors_of[:-1]) / errors_of[1:]) == pytest.approx(3.0, abs=0.05)


def test_a_neat_pin_has_the_contact_of_persson_at_any_load() -> None:
    """The numerator of Persson's formula is zero at tan^2(angle/2) = s with 2 - ln(s + 1) - 2 s^2 = 0; the contact recedes to
    that angle at once, and everything is proportional to the load."""
    half = 2 * np.arctan(np.sqrt(brentq(lambda s: 2 - np.log(s + 1) - 2 * s**2, 0.5, 1.0)))
    found = [solved(mfv.Step(normal_force=100.0), nodes=nodes, friction=None) for nodes in (101, 401)]
    assert [one.summary.contact_half_width / RADIUS for one in found] == pytest.approx([half] * 2, abs=4e-4)
    larger = solved(mfv.Step(normal_force=1.0e5), nodes=101, friction=None)
    assert larger.state.pressure == pytest.approx(1000 * found[0].state.pressure, rel=1e-9)
    below, above = mfv.reference.persson_force(half + np.array([-1e-6, 1e-6]), 1.0, 1.0, 0.3)
    assert 1e3 < below < 1e9 and np.isnan(above)


@pytest.mark.parametrize("seam", [0.0, 400.0])
def test_stresses_go_on_across_the_seam(seam: float) -> None:
    """Below the surface sigma_rr is the pressure everywhere, also where the contact spans the ends of the mesh (which a larger force of
    an earlier step turns), in full contact and not."""
    for start in ([], [press()]):
        steps = [*start, mfv.Step(tangential_force=seam), mfv.Step(tangential_force=-200.0)]
        result = solved(*(steps if seam else [*start, steps[-1]]), nodes=241)
        angle = result.mesh.arc / RADIUS
        for body, inwards in (("lower", 1 + 1e-9), ("upper", 1 - 1e-9)):
            distance = RADIUS * inwards
            found = stress(result, distance * np.sin(angle), RADIUS - distance * np.cos(angle), body=body)
            assert found["sigma_rr"] == pytest.approx(-result.state.pressure, abs=0.02 * result.state.pressure.max())
            assert found.tension.value == pytest.approx(
                result.observables[f"{body}_tension"], abs=0.01 * result.state.pressure.max()
            )


def test_torque() -> None:
    """Uniform shear; gross sliding at 2 pi R^2 mu p0, which is the moment at the end."""
    limit = 2 * np.pi * RADIUS**2 * MU * lame_pressure(STEEL, BRONZE)
    result = solved(press(), mfv.Step(moment=-0.9 * limit), bore=BRONZE)
    assert result.state.shear == pytest.approx(-0.9 * limit / (2 * np.pi * RADIUS**2), rel=1e-12)
    sliding = mfv.run(fit(press(), mfv.Step(moment=1.1 * limit), bore=BRONZE))
    assert sliding.outcome == "gross sliding" and sliding.summary.moment == pytest.approx(limit, rel=1e-9)
    loose = mfv.run(fit(mfv.Step(moment=1.0), bore=BRONZE))
    assert loose.outcome == "separated" and "nothing balances the moment" in loose.message


@pytest.mark.parametrize("interference", [0.0, INTERFERENCE])
def test_no_direction_is_special(interference: float) -> None:
    """The history of forces turned by a quarter and by half of the circle: the same tractions and numbers there."""
    start = [press(interference)] if interference else []
    found = []
    for turn in (0.0, 0.5, 1.0):
        c, s = round(np.cos(np.pi * turn)), round(np.sin(np.pi * turn))
        steps = [
            mfv.Step(normal_force=c * p - s * q, tangential_force=s * p + c * q) for p, q in ((5e3, 0.0), (6e3, 9e2), (4e3, -5e2))
        ]
        result = solved(*start, *steps, bore=BRONZE, nodes=80)
        order = np.argsort(np.round(result.mesh.arc / RADIUS - np.pi * turn, 9) % (2 * np.pi))
        found.append((result, result.state.pressure[order], result.state.shear[order]))
    for result, pressure, shear in found[1:]:
        assert pressure == pytest.approx(found[0][1], abs=1e-9 * found[0][1].max())
        assert shear == pytest.approx(found[0][2], abs=1e-9 * found[0][1].max())
        for name in ("contact_length", "patches", "dissipation", "stick_ratio", "contact_half_width", "closing_force"):
            assert result.summary.get(name, 0.0) == pytest.approx(found[0][0].summary.get(name, 0.0), rel=1e-8), name
        for name in ("peak_pressure", "peak_shear", "lower_tension", "upper_tension", "largest_lower_tension"):
            assert result.observables[name] == pytest.approx(found[0][0].observables[name], rel=1e-8), name


@pytest.mark.parametrize("nodes", [60, 240])
@pytest.mark.parametrize("motion", [-3.0, -1.0, 1.0])
def test_warnings_see_across_the_seam(motion: float, nodes: int) -> None:
    """Opposite slip meets opposite and below the pin, with no stick zone or a narrow one between: the same warnings in all directions,
    of which some have the place at the ends of the mesh."""
    found = []
    for name in ("shift", "approach"):
        step = mfv.Step(**{name: motion * INTERFERENCE})
        result = solved(press(), step, nodes=nodes, bore=BRONZE, friction=mfv.Friction.coulomb(0.02))
        found.append([re.sub(r"x = [-+.\de]+", "x", warning) for warning in result.warnings])
    assert found[0] and found[0] == found[1]


def test_a_rotating_load_makes_a_pin_creep() -> None:
    """A ring under a rotating load creeps, by the same angle every turn, with the load or against it; without slip it does not."""
    angle = np.linspace(0, 2 * np.pi, 25)[1:]
    turns = {}
    for force, sense in ((3000.0, 1), (3000.0, -1), (600.0, 1)):
        history = mfv.History(
            normal_force=force * np.cos(angle), tangential_force=sense * force * np.sin(angle), moment=0.0, period=24, cycles=4
        )
        result = mfv.run(
            fit(press(), mfv.Step(normal_force=force, moment=0.0), history=history, friction=mfv.Friction.coulomb(0.1)), check=True
        )
        turns[force, sense] = result.cycles.rotation_drift
    steady = turns[3000.0, 1][-1]
    assert abs(steady) > 1e-6 and turns[3000.0, 1][-2] == pytest.approx(steady, rel=1e-6)
    assert turns[3000.0, -1][-1] == pytest.approx(-steady, rel=1e-6)
    assert np.max(np.abs(turns[600.0, 1])) < 1e-12


def test_everything_is_released() -> None:
    """Back to no interference and no force: nothing touches, and the work of the loads is what friction has dissipated."""
    steps = (mfv.Step(normal_force=4e3), mfv.Step(tangential_force=8e2, cycles=2), mfv.Step(normal_force=0.0, interference=0.0))
    result = solved(press(), *steps, bore=BRONZE)
    assert result.summary.contact_nodes == 0 and abs(result.summary.closing_force) < 1e-9
    assert result.summary.largest_residual < 1e-10  # the energy balance is one of them


def test_every_way_in() -> None:
    """Steps one by one, increments, a history, another solver and other units of length: the same."""
    steps = (press(), mfv.Step(normal_force=4e3), mfv.Step(interference=0.4 * INTERFERENCE))
    expected = solved(*steps, bore=BRONZE)
    with mfv.Case(fit(bore=BRONZE)) as case:
        case.advance(interference=INTERFERENCE)
        case.advance(normal_force=4e3)
        case.advance(interference=-0.6 * INTERFERENCE, relative=True)
        assert case.loads.interference == pytest.approx(0.4 * INTERFERENCE, rel=1e-14)
        assert case.loads.closing_force == pytest.approx(expected.summary.closing_force, rel=1e-10)
        with pytest.raises(errors.BadArgument, match="the interference must not be negative"):
            case.advance(interference=-1.0)
        led = case.result()
    history = mfv.History(interference=[INTERFERENCE, INTERFERENCE, 0.4 * INTERFERENCE], normal_force=[0.0, 4e3, 4e3])
    others = [led, mfv.run(fit(bore=BRONZE, history=history), check=True)]
    others += [solved(*steps, bore=BRONZE, solver=mfv.Solver(linear_solver=solver)) for solver in ("dgesv", "fft")]
    for other in others:
        assert other.state.pressure == pytest.approx(expected.state.pressure, abs=1e-9 * expected.state.pressure.max())
        assert other.summary.dissipation == pytest.approx(expected.summary.dissipation, rel=1e-8)


def test_derivatives() -> None:
    """By the interference and by a coefficient of friction, against differences."""
    steps = (press(), mfv.Step(normal_force=4e3))
    with mfv.Case(fit(*steps, bore=BRONZE)) as case:
        case.differentiate("step(1)%interference", "friction%mu")
        case.run()
        found = list(case.derivatives.values())
    for number, (name, size) in enumerate((("interference", INTERFERENCE), ("mu", MU))):
        little = 1e-6 * size
        ends = []
        for change in (-little, little):
            interference, mu = (INTERFERENCE + change, MU) if name == "interference" else (INTERFERENCE, MU + change)
            ends.append(solved(press(interference), steps[1], bore=BRONZE, friction=mfv.Friction.coulomb(mu)))
        slopes = (ends[1].state.pressure - ends[0].state.pressure) / (2 * little)
        assert found[number].pressure == pytest.approx(slopes, abs=1e-5 * np.max(np.abs(slopes)))


def test_a_pad_pressed_in_is_a_prescribed_approach() -> None:
    """With vertical normals and a held approach the interference presses as the approach does, before and after shear."""
    bodies = mfv.Body.half_plane(**STEEL), mfv.Body.rounded_punch(2.0, 5.0, rigid=True)
    found = []
    for keys in ({"approach": 0.01}, {"approach": 0.0, "interference": 0.01}):
        steps = [mfv.Step(**keys), mfv.Step(tangential_force=300.0), mfv.Step(tangential_force=-300.0, cycles=1)]
        found.append(
            mfv.run(
                mfv.Scene(*bodies, friction=mfv.Friction.coulomb(MU), mesh=mfv.Mesh(half_width=3.0, nodes=81), steps=steps),
                check=True,
            )
        )
    assert found[1].state.pressure == pytest.approx(found[0].state.pressure, abs=1e-10 * found[0].state.pressure.max())
    assert found[1].state.shear == pytest.approx(found[0].state.shear, abs=1e-10 * found[0].state.pressure.max())
    assert found[1].summary.closing_force == pytest.approx(found[0].summary.normal_force, rel=1e-10)
    with mfv.Case(mfv.Scene(*bodies, friction=mfv.Friction.coulomb(MU), mesh=mfv.Mesh(half_width=3.0, nodes=81))) as case:
        with pytest.raises(errors.BadArgument, match="needs a prescribed approach, which holds the upper body"):
            case.advance(interference=0.01)
        case.advance(approach=0.0, interference=0.01)
        assert case.loads.normal_force == pytest.approx(found[0].steps[0].normal_force, rel=1e-10)


@pytest.mark.parametrize(
    ("bore", "mesh", "step", "message"),
    [
        (10.01, {"normals": "radial"}, {"interference": 0.01}, "needs a disk and a hole of one radius, not of 10.01 and 10"),
        (9.99, {"normals": "radial"}, {"normal_force": 1.0}, "normals='radial' in &mesh, and in a step interference=0.01"),
        (10.0, {}, {"normal_force": 1.0}, "such a neat fit needs normals='radial' in &mesh"),
        (10.0, {"normals": "radial", "half_width": 3.0}, {"interference": 0.01}, "half_width=3: has no effect in a neat fit"),
        (10.0, {"normals": "radial", "refine": "edges"}, {"interference": 0.01}, "refine='edges': must be 'none' in a neat fit"),
        (10.0, {"normals": "radial", "nodes": 5}, {"interference": 0.01}, "nodes=5: must be at least 8 around a neat fit"),
        (10.0, {"normals": "radial"}, {"interference": -0.01}, "must be a number at least 0"),
        (10.5, {}, {"normal_force": 1.0, "interference": 0.01}, "needs a prescribed approach, which holds the upper body"),
    ],
)  # fmt: skip
def test_what_is_refused(bore: float, mesh: dict[str, Any], step: dict[str, float], message: str) -> None:
    bodies = mfv.Body.hole(bore, **STEEL), mfv.Body.disk(RADIUS, **STEEL)
    with pytest.raises(errors.InputError) as refusal:
        mfv.run(mfv.Scene(*bodies, mesh=mfv.Mesh(**mesh), steps=[mfv.Step(**step)]))
    assert message in str(refusal.value)


def test_a_contact_that_ends_where_the_mesh_does_has_no_corner_there() -> None:
    """A load that turns around a pin nearly without friction only turns its stresses: the largest tension stays (its mesh does not turn)."""
    angles = np.radians(np.arange(0.0, 360.0, 7.0))
    steps = [mfv.Step(normal_force=50.0 * np.cos(angle), tangential_force=50.0 * np.sin(angle)) for angle in angles]
    scene = fit(*steps, nodes=79, friction=mfv.Friction.coulomb(1e-3), output=mfv.Output(states="steps"))
    result = mfv.run(scene, check=True)
    tension = [stress(result, 0.0, -1.0, step=step).tension.value for step in range(1, len(steps) + 1)]
    assert np.ptp(tension) < 0.02 * np.mean(tension)
