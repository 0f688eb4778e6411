"""Intensities, slip zones and exponents at contact edges against closed forms; shape='edge'; bars and mirror images on random scenes."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scenes import seeds

import mfv
from mfv import Body, Friction, History, Mesh, Output, Scene, Step
from mfv.errors import InputError

ELASTIC: dict[str, float] = {"shear_modulus": 1.0, "poisson_ratio": 0.3}
PLANE, CYLINDER = Body.half_plane(**ELASTIC), Body.disk(1.0, elasticity="half_plane", **ELASTIC)
MU, P, Q = 0.5, 1.0e-3, 5.0e-5
COMPLIANCE = 2.0 * (1.0 - 0.3) / 1.0  # of both bodies, (1 - nu)/G each
A = math.sqrt(2.0 * P * COMPLIANCE / math.pi)
#: Hertz: K_N = p0 sqrt(2/a); of a tangential force: K_T = Q/(pi sqrt(2 a)).
K_N = 2.0 * P / (math.pi * A) * math.sqrt(2.0 / A)
K_T = Q / (math.pi * math.sqrt(2.0 * A))


def observed(
    *steps: Step, lower: Body = PLANE, upper: Body = CYLINDER, mu: float = MU, bars: bool = False, **keys: Any
) -> mfv.Result:
    mesh = {"nodes": 201, **keys.pop("mesh", {})}
    if upper is CYLINDER:
        mesh["gap"] = "parabolic"
    scene = Scene(
        lower, upper, friction=Friction.coulomb(mu), mesh=Mesh(**mesh), steps=steps, output=Output(error_estimate=bars), **keys
    )
    return mfv.run(scene)


@pytest.mark.parametrize(
    ("mesh", "errors"), [({"nodes": 51}, (3e-4, 2e-5)), ({"nodes": 401}, (5e-6, 1e-6)), ({"refine": "edges"}, (1e-5, 2e-4))]
)
def test_hertz_and_cattaneo(mesh: dict[str, Any], errors: tuple[float, float]) -> None:
    """K_N and K_T of a cylinder, and the distance at which p = K_N sqrt(s) sqrt(1 - s/(2 a)) differs from it by a tenth: 0.38 a."""
    seen = observed(Step(normal_force=P), Step(tangential_force=Q), mesh=mesh).observables
    for side in ("left", "right"):
        assert seen[f"{side}_normal_intensity"] == pytest.approx(K_N, rel=errors[0])
        assert seen[f"{side}_shear_intensity"] == pytest.approx(K_T, rel=errors[1])
        assert seen[f"{side}_asymptotic_slip_zone"] == pytest.approx(2.0 * K_T / (MU * K_N), rel=3e-4)
        assert seen[f"{side}_slip_zone"] == pytest.approx(A * (1.0 - math.sqrt(1.0 - Q / (MU * P))), rel=6e-3)
        assert seen[f"{side}_edge_reach"] == pytest.approx(0.38 * A, rel=0.01)
        assert seen[f"{side}_edge_exponent"] == 0.5


def test_k_t_has_the_second_order() -> None:
    """Without the shift of the edge by the discrete equations it would be the first."""
    errors = [
        abs(observed(Step(normal_force=P), Step(tangential_force=Q), upper=Body.flat_punch(0.05), mesh={"nodes": n}, coupling="none").observables
            .right_shear_intensity / (Q / (math.pi * math.sqrt(0.1))) - 1.0)
        for n in (51, 101, 201)
    ]  # fmt: skip
    orders = np.log(np.divide(errors[:-1], errors[1:])) / np.log([101 / 51, 201 / 101])
    assert orders.min() > 1.8, (errors, orders)


def test_bulk_stress_shears_both_edges_outwards() -> None:
    """K_T = -+(sigma/4) sqrt(a/2) for alike bodies, the lower one stretched (Nowell and Hills 1987: q = (sigma/4) x/sqrt(a^2 - x^2))."""
    sigma = 1.0e-3
    seen = observed(Step(normal_force=P), Step(lower_bulk_stress=sigma)).observables
    expected = 0.25 * sigma * math.sqrt(0.5 * A)
    assert [seen.left_shear_intensity, seen.right_shear_intensity] == pytest.approx([expected, -expected], rel=1e-5)


def test_after_a_reversal_half_the_zone() -> None:
    """The change since the reversal, 2 Q, has the slip zone of Q; loads that go on count from where they began."""
    back = observed(Step(normal_force=P), Step(tangential_force=Q), Step(tangential_force=-Q)).observables
    assert back.left_shear_intensity == pytest.approx(-2.0 * K_T, rel=1e-5)
    assert back.left_asymptotic_slip_zone == pytest.approx(2.0 * K_T / (MU * K_N), rel=1e-4)
    on = observed(Step(normal_force=P), Step(tangential_force=Q), Step(tangential_force=1.5 * Q)).observables
    assert on.left_shear_intensity == pytest.approx(1.5 * K_T, rel=1e-5)


@pytest.mark.parametrize("change", [1.0e-4, -1.0e-4, 2.0e-5, 0.0])
def test_straight_load_paths(change: float) -> None:
    """The permanent stick zone is the contact under (P1 + P2)/2 - |Q2 - Q1|/(2 mu); slip zones by asymptotes to their width over a."""
    shear = 1.0e-4
    seen = observed(
        Step(normal_force=P), Step(normal_force=P + change, tangential_force=shear, cycles=4), mesh={"nodes": 401}
    ).observables
    half = math.sqrt(2.0 * (P + 0.5 * change - 0.5 * shear / MU) * COMPLIANCE / math.pi)
    assert seen.steady_stick_length == pytest.approx(2.0 * half, rel=1e-5)
    assert seen.permanent_stick_length == pytest.approx(2.0 * half, rel=1.5e-3)
    assert seen.right_slip_zone == pytest.approx(A - half, rel=0.01)
    assert seen.right_asymptotic_slip_zone == pytest.approx(A - half, rel=1.2 * (A - half) / A)


def test_no_steady_zone_where_loads_turn_on_the_way() -> None:
    """Nor for bodies whose normal and tangential problems differ."""
    path = History(normal_force=[P, 1.1 * P, P], tangential_force=[Q, 0.0, -Q], cycles=3, period=3)
    turning = mfv.run(Scene(PLANE, CYLINDER, friction=Friction.coulomb(MU), steps=[Step(normal_force=P)], history=path))
    assert "steady_stick_length" not in turning.observables
    disk = observed(Step(normal_force=P), Step(tangential_force=Q, cycles=2), upper=Body.disk(1.0, **ELASTIC)).observables
    assert "steady_stick_length" not in disk and disk.permanent_stick_length > 0.0


def test_permanent_stick_zone_at_every_turning_point() -> None:
    """Rows of a period in any order: what sticks at all of them is what sticks at the two extremes, a root(1 - Q/(mu P)), inside that of the rows
    between."""
    for rows in ((1.0, -1.0, 0.3, -0.2), (0.1, 1.0, -1.0, -0.1), (1.0, 0.2, -1.0, -0.2)):
        path = History(normal_force=[P] * 4, tangential_force=[Q * row for row in rows], cycles=3, period=4)
        seen = observed(Step(normal_force=P), history=path, mesh={"nodes": 401}).observables
        assert seen.permanent_stick_length == pytest.approx(2.0 * A * math.sqrt(1.0 - Q / (MU * P)), rel=2e-3)


@pytest.mark.parametrize("coupled", [False, True])
def test_every_cycle_has_its_edges(coupled: bool) -> None:
    """/cycles at the reversal and at the end: K_T of the change since the turning point before; the last row is what the observables say."""
    upper = Body.disk(1.0, **ELASTIC) if coupled else CYLINDER
    seen = observed(Step(normal_force=P), Step(tangential_force=Q), Step(tangential_force=-Q, cycles=3), upper=upper)
    cycles, end = seen.cycles, seen.observables
    error = 0.02 if coupled else 1e-5
    for side in ("left", "right"):
        assert list(cycles[f"{side}_shear_intensity_reversal"]) == pytest.approx([-2.0 * K_T] * 3, rel=error)
        assert list(cycles[f"{side}_shear_intensity_return"]) == pytest.approx([2.0 * K_T] * 3, rel=error)
        assert list(cycles[f"{side}_normal_intensity_reversal"]) == pytest.approx([K_N] * 3, rel=max(error, 1e-4))
        for name in ("normal_intensity", "shear_intensity", "slip_zone"):
            assert cycles[f"{side}_{name}_return"][-1] == pytest.approx(end[f"{side}_{name}"], rel=1e-9)
    assert not {"left_corner_intensity_return", "left_asymptotic_slip_zone_return"} & set(cycles)


def test_noise_of_the_normal_force_is_no_turning_point() -> None:
    """K_T is the change since the tangential force last turned, as long as mu dP is far below dQ, as of loads from finite elements."""
    angle = np.arange(1, 41) / 40.0 * 2.5 * math.pi
    noise = 1.0 + 1.0e-5 * np.random.default_rng(1).standard_normal(40)
    path = History(normal_force=list(P * noise), tangential_force=list(Q * np.sin(angle)))
    seen = observed(Step(normal_force=P), history=path).observables
    assert seen.right_shear_intensity == pytest.approx(2.0 * K_T, rel=1e-4)
    assert seen.right_asymptotic_slip_zone == pytest.approx(2.0 * K_T / (MU * K_N), rel=1e-3)


def test_corners() -> None:
    """P/(pi sqrt(2 b)) at the ends of a punch; sliding with coupling (Johnson 1985, section 2.5, exponent -1/2 -+ l, tan(pi l) = beta mu)."""
    b = 0.05
    seen = observed(Step(normal_force=P), Step(tangential_force=Q), upper=Body.flat_punch(b), coupling="none").observables
    assert [seen.left_corner_intensity, seen.right_corner_intensity] == pytest.approx(
        [P / (math.pi * math.sqrt(2.0 * b))] * 2, rel=2e-6
    )
    assert seen.left_edge_exponent == -0.5 and "left_normal_intensity" not in seen
    mu = 0.3
    seen = observed(Step(normal_force=P), Step(tangential_force=0.99999 * mu * P), upper=Body.flat_punch(b), mu=mu).observables
    shift = math.atan(mu * (1.0 - 2.0 * 0.3) / (2.0 * (1.0 - 0.3))) / math.pi
    assert seen.right_edge_exponent == pytest.approx(-0.5 + shift, abs=1e-12)
    expected = P * math.cos(math.pi * shift) / (math.pi * math.sqrt(2.0 * b)) * 2.0**-shift
    assert seen.right_corner_intensity == pytest.approx(expected, rel=5e-4)
    assert "left_corner_intensity" not in seen  # it sticks there: the pressure oscillates


def test_coupled_edges_converge() -> None:
    """Rigid on elastic: K_N with the exponent of the sliding edge; no K_T, whose field oscillates."""
    values = [
        observed(
            Step(normal_force=P), Step(tangential_force=0.9 * MU * P), upper=Body.disk(1.0, rigid=True), mesh={"nodes": n}
        ).observables
        for n in (101, 201, 401)
    ]
    assert "left_shear_intensity" not in values[0]
    assert values[0].left_edge_exponent == pytest.approx(0.5 - math.atan(0.4 / 1.4 * MU) / math.pi)
    for name in ("left_normal_intensity", "right_normal_intensity"):
        assert values[0][name] == pytest.approx(values[2][name], rel=5e-4)


def test_waves_and_their_patches() -> None:
    """Westergaard: p = 2 p* cos(pi x/L) sqrt(sin^2(pi a/L) - sin^2(pi x/L)) at its edge; both edges of every patch are in /patches."""
    depth, length, force = 0.01, 1.0, 5.0e-3
    wave = Body.wave(depth, length, rigid=True)
    result = observed(
        Step(normal_force=force), Step(tangential_force=1e-4), upper=wave, coupling="none", mesh={"nodes": 1024, "period": length}
    )
    full = math.pi * 2.0 / (1.0 - 0.3) * depth / length
    a = math.asin(math.sqrt(force / length / full)) * length / math.pi
    expected = 2.0 * full * math.cos(math.pi * a / length) * math.sqrt(math.pi / length * math.sin(2.0 * math.pi * a / length))
    assert result.observables.left_normal_intensity == pytest.approx(expected, rel=3e-4)
    assert result.patches.left_normal_intensity[0] == result.observables.left_normal_intensity
    assert result.patches.unit("right_shear_intensity") == result.observables.unit("right_shear_intensity") == "force/length^(3/2)"


def test_an_edge_by_itself() -> None:
    """K_N and K_T as prescribed, with a bulk stress; the slip zone tends to 2 K_T/(mu K_N) with its width over edge_length."""
    errors = []
    for length in (A, 4.0 * A, 16.0 * A):
        upper = Body.edge(K_N, length, **ELASTIC)
        # K_T is negative where the lower body is stretched.
        steps = [Step(normal_intensity=K_N), Step(shear_intensity=-K_T, lower_bulk_stress=1.0e-4)]
        seen = observed(*steps, upper=upper, mesh={"refine": "edges"}).observables
        assert seen.contact_half_width == pytest.approx(length, rel=1e-5)
        assert seen.right_normal_intensity == pytest.approx(K_N, rel=1e-4)
        assert seen.right_shear_intensity == pytest.approx(-K_T, rel=2e-4)
        errors.append(abs(seen.right_slip_zone / (2.0 * K_T / (MU * K_N)) - 1.0))
    assert errors[0] < 0.06 and errors[1] < 0.3 * errors[0] and errors[2] < 0.3 * errors[1], errors


def test_an_edge_under_a_history() -> None:
    """K_N changes with the fourth root of the normal force; what is wrong is said with its key."""
    path = History(normal_intensity=[K_N, 1.02 * K_N, K_N], shear_intensity=[K_T, 0.0, -K_T])
    upper = Body.edge(K_N, A, **ELASTIC)
    result = mfv.run(
        Scene(PLANE, upper, friction=Friction.coulomb(MU), mesh=Mesh(nodes=201), steps=[Step(normal_intensity=K_N)], history=path)
    )
    assert result.observables.right_normal_intensity == pytest.approx(K_N, rel=1e-4)
    assert result.summary.normal_force == pytest.approx(P, rel=1e-12)
    assert result.summary.tangential_force == pytest.approx(-Q, rel=1e-12)
    for steps, complaint in (
        ([Step(normal_intensity=K_N, normal_force=P)], "normal_force or approach is also given"),
        ([Step(shear_intensity=K_T)], "needs a normal_intensity or normal_force"),
        ([Step(normal_intensity=K_N), Step(shear_intensity=K_T, shift=1.0)], "force_ratio or shift is also given"),
    ):
        with pytest.raises(InputError, match=complaint):
            mfv.run(Scene(PLANE, upper, friction=Friction.coulomb(MU), steps=steps))
    with pytest.raises(InputError, match="needs a body with shape='edge'"):
        mfv.run(Scene(PLANE, CYLINDER, friction=Friction.coulomb(MU), steps=[Step(normal_intensity=K_N)]))
    with pytest.raises(InputError, match="must be 'half_plane' beside"):
        mfv.run(Scene(CYLINDER, upper, friction=Friction.coulomb(MU), steps=[Step(normal_intensity=K_N)]))


def test_bars_hold_on_random_scenes() -> None:
    """Cylinders, alike half-planes, in-phase bulk stress, P and Q cycles: bars true within twice, or the value is flagged."""
    held, number = 0, 0
    for seed in seeds(24):
        random = np.random.default_rng(seed)
        shear, mu = random.uniform(0.05, 0.6), random.uniform(0.2, 0.9)
        sigma = random.uniform(-0.3, 0.3) * mu * 2.0 * P / (math.pi * A) * (1.0 - shear)
        steps = [Step(normal_force=P), Step(tangential_force=shear * mu * P, lower_bulk_stress=float(sigma))]
        result = observed(*steps, mu=mu, bars=True, mesh={"nodes": int(random.integers(61, 301))})
        truth = {
            "left_normal_intensity": K_N,
            "right_normal_intensity": K_N,
            "left_shear_intensity": shear * mu * P / (math.pi * math.sqrt(2.0 * A)) + 0.25 * sigma * math.sqrt(0.5 * A),
            "right_shear_intensity": shear * mu * P / (math.pi * math.sqrt(2.0 * A)) - 0.25 * sigma * math.sqrt(0.5 * A),
            "left_edge_reach": 0.38 * A,
        }
        truth |= {
            f"{side}_asymptotic_slip_zone": 2.0 * abs(truth[f"{side}_shear_intensity"]) / (mu * K_N) for side in ("left", "right")
        }
        for name, value in truth.items():
            bar = result.error_estimate[f"{name}_error"]
            if math.isnan(bar):
                continue
            number += 1
            held += abs(result.observables[name] - value) <= 2.0 * bar + 1e-12 * abs(value)
    assert held >= 0.98 * number > 80, (held, number)


def test_mirror_image() -> None:
    """Left for right; K_T changes its sign."""
    steps = [Step(normal_force=P), Step(tangential_force=Q, lower_bulk_stress=5e-4)]
    other = [Step(normal_force=P), Step(tangential_force=-Q, lower_bulk_stress=5e-4)]
    here, there = observed(*steps).observables, observed(*other).observables
    for name in ("normal_intensity", "shear_intensity", "slip_zone", "asymptotic_slip_zone", "edge_reach"):
        sign = -1.0 if name == "shear_intensity" else 1.0
        for side, opposite in (("left", "right"), ("right", "left")):
            assert here[f"{side}_{name}"] == pytest.approx(sign * there[f"{opposite}_{name}"], rel=1e-8)


def test_picture() -> None:
    """Both edges in panels of their own; none where a punch ends."""
    axes = mfv.plot.edges_figure(observed(Step(normal_force=P), Step(tangential_force=Q))).axes
    assert [ax.get_xlabel().split("$")[0] for ax in axes] == ["distance from the left edge ", "distance from the right edge "]
    with pytest.raises(ValueError, match="no edges to draw"):
        mfv.plot.edges_figure(observed(Step(normal_force=P), upper=Body.flat_punch(0.05)))


def test_every_step_of_a_case() -> None:
    """The intensities of each state, as it is reached."""
    scene = Scene(PLANE, CYLINDER, friction=Friction.coulomb(MU), mesh=Mesh(nodes=201, gap="parabolic"))
    with mfv.Case(scene) as case:
        for force in (0.0, Q, -Q):
            case.advance(normal_force=P, tangential_force=force)
            before = case.result().observables.get("left_shear_intensity", 0.0)
        assert before == pytest.approx(-2.0 * K_T, rel=1e-4)
