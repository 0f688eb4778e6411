"""Fatigue parameters, critical distances, lives and short cracks against closed forms and other algorithms."""

import warnings
from pathlib import Path

import numpy as np
import pytest
from matplotlib import pyplot
from scipy.optimize import minimize, minimize_scalar

import mfv
from mfv import fatigue

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"

E, NU = 74000.0, 0.33
G = 0.5 * E / (1.0 + NU)
#: A turn in equal steps, extremes of sine and cosine included.
TURN = 2.0 * np.pi * np.arange(48) / 48


def history(xx=0.0, yy=0.0, xy=0.0, zz=0.0) -> fatigue.StressCycle:
    """A cycle at one point from histories of the components."""
    components = np.broadcast_arrays(*map(np.atleast_1d, (xx, yy, xy, zz)))
    return fatigue.StressCycle(0.0, 0.0, np.stack(components, axis=-1), G, NU)


TENSION = history(xx=200.0 * np.sin(TURN))
REPEATED = history(xx=[0.0, 300.0])
TORSION = history(xy=120.0 * np.sin(TURN))


def test_uniaxial() -> None:
    """Closed forms of tension and compression with the amplitude s, and of repeated tension."""
    s, k = 200.0, 0.3
    swt = fatigue.smith_watson_topper(TENSION).maximum
    assert swt.value == pytest.approx(s**2 / E, rel=1e-9) and swt.angle == pytest.approx(0.0, abs=1e-4)
    assert fatigue.smith_watson_topper(REPEATED).maximum.value == pytest.approx(300.0 * 150.0 / E, rel=1e-9)
    findley = fatigue.findley(TENSION, k=k).maximum
    assert findley.value == pytest.approx(0.5 * s * (k + np.hypot(1.0, k)), rel=1e-9)
    assert abs(findley.angle) == pytest.approx(0.5 * np.arctan(1.0 / k), abs=1e-4)
    assert fatigue.crossland(TENSION, k=k).maximum.value == pytest.approx(s * (1.0 / np.sqrt(3.0) + k / 3.0), rel=1e-9)
    assert fatigue.crossland(REPEATED, k=k).maximum.value == pytest.approx(150.0 / np.sqrt(3.0) + k * 100.0, rel=1e-9)
    assert fatigue.dang_van(TENSION, k=k).maximum.value == pytest.approx(s * (0.5 + k / 3.0), rel=1e-9)
    assert fatigue.dang_van(REPEATED, k=k).maximum.value == pytest.approx(75.0 + k * 100.0, rel=1e-9)
    strain = fatigue.fatemi_socie(TENSION, yield_strength=465.0, k=0.0).maximum
    assert strain.value == pytest.approx((1.0 + NU) * s / E, rel=1e-9) and abs(strain.angle) == pytest.approx(
        0.25 * np.pi, abs=1e-4
    )


def test_torsion() -> None:
    """Closed forms of torsion with the amplitude t."""
    t, k = 120.0, 0.3
    swt = fatigue.smith_watson_topper(TORSION).maximum
    assert swt.value == pytest.approx(t**2 * (1.0 + NU) / E, rel=1e-9) and abs(swt.angle) == pytest.approx(0.25 * np.pi, abs=1e-4)
    assert fatigue.findley(TORSION, k=k).maximum.value == pytest.approx(t * np.hypot(1.0, k), rel=1e-9)
    assert fatigue.crossland(TORSION, k=k).maximum.value == pytest.approx(t, rel=1e-9)
    assert fatigue.dang_van(TORSION, k=k).maximum.value == pytest.approx(t, rel=1e-9)
    # gamma cos(u) (1 + c sin(u)), u twice the angle of the plane, is largest where sin(u) = (sqrt(1 + 8 c^2) - 1)/(4 c).
    c = 0.8 * t / 465.0
    sine = (np.sqrt(1.0 + 8.0 * c**2) - 1.0) / (4.0 * c)
    expected = t / G * np.sqrt(1.0 - sine**2) * (1.0 + c * sine)
    found = fatigue.fatemi_socie(TORSION, yield_strength=465.0, k=0.8).maximum
    assert found.value == pytest.approx(expected, rel=1e-8)
    assert min(abs(found.angle), 0.5 * np.pi - abs(found.angle)) == pytest.approx(0.5 * np.arcsin(sine), abs=1e-4)


@pytest.mark.parametrize("phase", [0.0, 0.5 * np.pi])
@pytest.mark.parametrize("stress, shear", [(200.0, 120.0), (200.0, 90.0)])
def test_tension_with_torsion_in_and_out_of_phase(stress: float, shear: float, phase: float) -> None:
    """The path of the deviator is a line or an ellipse: amplitudes combine or the larger one counts."""
    cycle = history(xx=stress * np.sin(TURN), xy=shear * np.sin(TURN + phase))
    out = phase > 0.0
    octahedral = max(stress / np.sqrt(3.0), shear) if out else np.hypot(stress / np.sqrt(3.0), shear)
    assert fatigue.crossland(cycle, k=0.0).maximum.value == pytest.approx(octahedral, rel=1e-9)
    tresca = max(0.5 * stress, shear) if out else np.hypot(0.5 * stress, shear)
    assert fatigue.findley(cycle, k=0.0).maximum.value == pytest.approx(tresca, rel=1e-9)
    assert fatigue.dang_van(cycle, k=0.0).maximum.value == pytest.approx(tresca, rel=1e-9)

    def negative(angle: float) -> float:
        """Of Smith, Watson and Topper on one plane, from amplitudes of sine and cosine parts instead of histories."""
        cosine, sine, double = np.cos(angle) ** 2, np.sin(angle) ** 2, np.sin(2.0 * angle)
        parts = [(stress * cosine, shear * double), (stress * (cosine - NU * sine) / E, shear * double * (1.0 + NU) / E)]
        values = [np.hypot(*part) if out else abs(sum(part)) for part in parts]
        return -values[0] * values[1]

    best = min(minimize_scalar(negative, (a, a + 0.1), options={"xtol": 1e-10}).fun for a in np.linspace(-1.5, 1.5, 9))
    # The extremes of a plane are between the 48 states: 1 - cos(pi/48) twice.
    assert fatigue.smith_watson_topper(cycle).maximum.value == pytest.approx(-best, rel=5e-3 if out else 1e-8)


def test_constants_give_the_fatigue_limits() -> None:
    """k from two fatigue limits: both tests reach the same value of the parameter."""
    bending, torsion = 200.0, 120.0
    tests = history(xx=[bending, -bending]), history(xy=[torsion, -torsion])
    for parameter, constant in (
        (fatigue.crossland, fatigue.crossland_constant),
        (fatigue.dang_van, fatigue.dang_van_constant),
        (fatigue.findley, fatigue.findley_constant),
    ):
        first, second = (parameter(test, k=constant(bending, torsion)).maximum.value for test in tests)
        assert first == pytest.approx(second, rel=1e-8)
    with pytest.raises(ValueError, match="at least half the bending limit"):
        fatigue.findley_constant(200.0, 90.0)


def test_smallest_sphere_of_random_paths() -> None:
    """Crossland's amplitude is a radius that encloses the path; no smaller one does, since the dual problem has the same value."""
    random = np.random.default_rng(3)
    stress = random.normal(size=(9, 40, 4))
    found = fatigue.crossland(fatigue.StressCycle(np.zeros(40), np.zeros(40), stress, G, NU), k=0.0).values
    tensors = np.zeros((9, 40, 3, 3))
    tensors[..., 0, 0], tensors[..., 1, 1], tensors[..., 2, 2] = stress[..., 0], stress[..., 1], stress[..., 3]
    tensors[..., 0, 1] = tensors[..., 1, 0] = stress[..., 2]
    deviators = (tensors - np.trace(tensors, axis1=2, axis2=3)[..., None, None] * np.eye(3) / 3.0).reshape(9, 40, 9)
    for place in range(0, 40, 4):
        path = deviators[:, place]

        def dual(share: np.ndarray, path: np.ndarray = path) -> float:
            """Minus the square of a radius that no enclosing sphere can have less of; `share` of the states, sum 1."""
            return float(np.sum((share @ path) ** 2) - share @ np.sum(path**2, axis=1))

        total = {"type": "eq", "fun": lambda share: np.sum(share) - 1.0}
        best = minimize(
            dual, np.full(9, 1.0 / 9.0), bounds=[(0.0, 1.0)] * 9, constraints=total, method="SLSQP", options={"ftol": 1e-14}
        )
        assert found[place] == pytest.approx(np.sqrt(-0.5 * best.fun), rel=1e-5)


@pytest.mark.parametrize("states", [4, 6, 8, 13, 48])
def test_smallest_sphere_of_ellipses(states: int) -> None:
    """Elliptical paths about any mean: the sphere is about the centre of the ellipse if every state has its opposite, whatever the
    axes; without, it is no larger."""
    random = np.random.default_rng(states)
    turn = 2.0 * np.pi * np.arange(states) / states
    sine, cosine, mean = random.normal(size=(3, 2000, 4))
    # Some are collinear, some do not change at all, some are circles of pure deviators.
    cosine[:50], sine[:25] = 0.0, 0.0
    cosine[50:100], sine[50:100] = [1.0, -1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]
    around = sine * np.sin(turn)[:, None, None] + cosine * np.cos(turn)[:, None, None]
    tensor = around - np.stack([around[..., [0, 1, 3]].mean(axis=-1)] * 4, axis=-1) * [1.0, 1.0, 0.0, 1.0]
    expected = np.sqrt(np.max(0.5 * np.sum(tensor**2 * [1.0, 1.0, 2.0, 1.0], axis=-1), axis=0))
    zero = np.zeros(2000)
    path = around + 10.0 * mean
    found = fatigue.crossland(fatigue.StressCycle(zero, zero, path, G, NU), k=0.0).values
    if states % 2 == 0:
        np.testing.assert_allclose(found, expected, rtol=1e-8, atol=1e-12)
    else:
        assert np.all(found <= expected * (1.0 + 1e-8) + 1e-12)
    twice = np.repeat(path, 2, axis=0)
    np.testing.assert_allclose(
        fatigue.crossland(fatigue.StressCycle(zero, zero, twice, G, NU), k=0.0).values, found, rtol=1e-8, atol=1e-12
    )
    # In axes turned by 0.3 rad: sigma_xx and sigma_yy exchange, sigma_zz stays.
    c, s = np.cos(0.3), np.sin(0.3)
    turned = np.zeros((4, 4))
    turned[:3, :3] = [[c * c, s * s, 2.0 * s * c], [s * s, c * c, -2.0 * s * c], [-s * c, s * c, c * c - s * s]]
    turned[3, 3] = 1.0
    for parameter in (fatigue.crossland, fatigue.dang_van):
        first, second = (parameter(fatigue.StressCycle(zero, zero, each, G, NU), k=0.3).values for each in (path, path @ turned.T))
        np.testing.assert_allclose(first, second, rtol=1e-6)


def test_tension_and_torsion_with_eight_states() -> None:
    """Amplitudes 200 and 100 out of phase: sqrt(J2) has the amplitude 200/sqrt(3), Tresca's shear 100."""
    turn = 2.0 * np.pi * np.arange(8) / 8
    cycle = history(xx=200.0 * np.sin(turn), xy=100.0 * np.cos(turn))
    assert fatigue.crossland(cycle, k=0.0).maximum.value == pytest.approx(200.0 / np.sqrt(3.0), rel=1e-9)
    assert fatigue.dang_van(cycle, k=0.0).maximum.value == pytest.approx(100.0, rel=1e-9)


@pytest.mark.parametrize("noise", [1e-14, 1e-11, 1e-10, 1e-9, 1e-7])
def test_smallest_sphere_of_states_nearly_on_a_sphere(noise: float) -> None:
    """Many states could determine the sphere and differ by round-off: the search ends, with the radius."""
    random = np.random.default_rng(7)
    deviator = random.normal(size=(40, 200, 3))
    deviator /= np.linalg.norm(deviator, axis=2)[..., None]
    # Two opposite states, so that the radius is known.
    deviator[0], deviator[1] = [1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]
    first, second, third = np.moveaxis(deviator + noise * random.normal(size=deviator.shape), -1, 0)
    zz = second * np.sqrt(2.0 / 3.0)
    stress = np.stack([first / np.sqrt(2.0) - 0.5 * zz, -first / np.sqrt(2.0) - 0.5 * zz, third / np.sqrt(2.0), zz], axis=-1)
    found = fatigue.crossland(fatigue.StressCycle(np.zeros(200), np.zeros(200), stress, G, NU), k=0.0).values
    np.testing.assert_allclose(found, 1.0 / np.sqrt(2.0), rtol=10.0 * noise + 1e-8)


def test_map_ignores_points_outside_and_wrong_shapes_are_refused() -> None:
    stress = np.array([[[np.nan] * 4, [10.0, 0.0, 0.0, 0.0]], [[np.nan] * 4, [-10.0, 0.0, 0.0, 0.0]]])
    peak = fatigue.smith_watson_topper(fatigue.StressCycle(np.array([0.0, 1.0]), np.zeros(2), stress, G, NU)).maximum
    assert peak.x == 1.0 and peak.value == pytest.approx(100.0 / E)
    with pytest.raises(ValueError, match="at least two states"):
        fatigue.StressCycle(0.0, 0.0, np.zeros((1, 4)), G, NU)
    with pytest.raises(ValueError, match="inside the body"):
        fatigue.smith_watson_topper(history(xx=[np.nan, np.nan])).maximum


MATERIAL = fatigue.StrainLife(E, 1015.0, -0.11, 0.21, -0.52, poisson_ratio=NU)


def test_lives_invert_the_curves() -> None:
    cycles = np.array([1e2, 1e5, 3e8])
    for name in ("strain_amplitude", "smith_watson_topper", "stress_amplitude"):
        curve = getattr(MATERIAL, name)
        np.testing.assert_allclose(fatigue.life(curve(cycles), curve), cycles, rtol=1e-9)
    curve = MATERIAL.smith_watson_topper
    assert fatigue.life(0.0, curve) == np.inf and fatigue.life(1e9, curve) == 0.5 and np.isnan(fatigue.life(np.nan, curve))
    with pytest.raises(ValueError, match="decrease with the number of cycles"):
        fatigue.life(1.0, lambda n: n)


def test_parameters_of_the_material_test_give_its_life() -> None:
    """Elastic tension and compression of the amplitude at N cycles has the life N by every parameter."""
    elastic = fatigue.StrainLife(E, 1015.0, -0.11, 0.0, -0.52, poisson_ratio=NU)
    cycles = 2.0e5
    amplitude = float(elastic.stress_amplitude(cycles))
    cycle = history(xx=[amplitude, -amplitude])
    k = 0.3
    values = {
        "smith_watson_topper": (fatigue.smith_watson_topper(cycle), elastic.smith_watson_topper),
        "findley": (fatigue.findley(cycle, k=k), lambda n: elastic.findley(n, k=k)),
        "crossland": (fatigue.crossland(cycle, k=k), lambda n: elastic.crossland(n, k=k)),
        "dang_van": (fatigue.dang_van(cycle, k=k), lambda n: elastic.dang_van(n, k=k)),
    }
    for found, curve in values.values():
        assert fatigue.life(found.maximum.value, curve) == pytest.approx(cycles, rel=1e-6)
    for factor in (0.0, 0.3, 1.0, 4.0):
        limits = {"yield_strength": 465.0, "k": factor}
        found = fatigue.fatemi_socie(cycle, **limits).maximum.value
        assert fatigue.life(found, lambda n, limits=limits: elastic.fatemi_socie(n, **limits)) == pytest.approx(cycles, rel=1e-6)


@pytest.mark.parametrize("cycles", [1e2, 1e4, 1e7])
def test_fatemi_socie_of_the_material_test(cycles: float) -> None:
    """Strains, plastic ones included, and stresses of the test as tensors, on planes of all angles."""
    stress, plastic = float(MATERIAL.stress_amplitude(cycles)), float(MATERIAL.plastic_strain(cycles))
    strain = np.diag([stress / E + plastic, *[-NU * stress / E - 0.5 * plastic] * 2])
    angle = np.linspace(0.0, 0.5 * np.pi, 20001)
    normal, along = np.stack([np.cos(angle), np.sin(angle), 0.0 * angle]), np.stack([-np.sin(angle), np.cos(angle), 0.0 * angle])
    shear = 2.0 * np.abs(np.einsum("in,ij,jn->n", normal, strain, along))
    tension = stress * normal[0] ** 2
    for k in (0.0, 0.5, 1.0):
        expected = np.max(shear * (1.0 + k * tension / 465.0))
        assert MATERIAL.fatemi_socie(cycles, yield_strength=465.0, k=k) == pytest.approx(expected, rel=1e-7)


def test_basquin_is_the_woehler_curve_of_pylife() -> None:
    woehler = pytest.importorskip("pylife.materiallaws.woehlercurve")
    import pandas

    curve = pandas.Series({"k_1": -1.0 / MATERIAL.strength_exponent, "ND": 1.0e6, "SD": float(MATERIAL.stress_amplitude(1.0e6))})
    loads = MATERIAL.stress_amplitude(np.array([1e3, 1e5]))
    np.testing.assert_allclose(woehler.WoehlerCurve(curve).cycles(loads), fatigue.life(loads, MATERIAL.stress_amplitude), rtol=1e-8)


def test_rainflow() -> None:
    """The example of ASTM E1049 for repeating histories: cycles of the ranges 3, 4, 7 and 9."""
    counted = fatigue.count_cycles([-2.0, 1.0, -3.0, 5.0, -1.0, 3.0, -4.0, 4.0])
    values = np.array([-2.0, 1.0, -3.0, 5.0, -1.0, 3.0, -4.0, 4.0])
    ranges = np.abs(values[counted.first] - values[counted.second])
    assert sorted(ranges) == [3.0, 4.0, 7.0, 9.0]
    assert fatigue.count_cycles([1.0, 1.0]).first.size == 0


def test_damage_of_two_blocks_adds_up() -> None:
    """Two unequal cycles in one history: Miner's sum of both, on the plane across the tension."""
    cycle = history(xx=[300.0, 0.0, 200.0, 0.0])
    damage = fatigue.smith_watson_topper_damage(cycle, MATERIAL.smith_watson_topper)
    both = [fatigue.life(s * 0.5 * s / E, MATERIAL.smith_watson_topper) for s in (300.0, 200.0)]
    assert damage.value == pytest.approx(sum(1.0 / n for n in both), rel=1e-9) and damage.angle == pytest.approx(0.0)
    with pytest.raises(ValueError, match="of one point, not 2"):
        fatigue.smith_watson_topper_damage(
            fatigue.StressCycle(np.zeros(2), np.zeros(2), np.zeros((2, 2, 4)), G, NU), lambda n: 1 / n
        )


def test_damages_of_two_blocks_add_up() -> None:
    """As above, by Findley and by Fatemi and Socie: of pulsating tension the plane is the same for both amplitudes if it does not depend on them."""
    cycle = history(xx=[300.0, 0.0, 200.0, 0.0])
    k = 0.3
    curve = FINDLEY_CURVE
    damage = fatigue.findley_damage(cycle, curve, k=k)
    # s/4 sin(u) + k s/2 (1 + cos(u)) is largest at tan(u) = 1/(2 k).
    both = [fatigue.life(0.5 * s * (k + np.hypot(0.5, k)), curve) for s in (300.0, 200.0)]
    assert damage.value == pytest.approx(sum(1.0 / n for n in both), rel=1e-6)
    damage = fatigue.fatemi_socie_damage(cycle, MATERIAL.smith_watson_topper, yield_strength=465.0, k=0.0)
    both = [fatigue.life(0.25 * s / G, MATERIAL.smith_watson_topper) for s in (300.0, 200.0)]
    assert damage.value == pytest.approx(sum(1.0 / n for n in both), rel=1e-6)


#: A power law whose inverse is (FINDLEY_STRENGTH/value)^10.
FINDLEY_STRENGTH = 600.0


def FINDLEY_CURVE(cycles: float) -> float:
    return FINDLEY_STRENGTH * cycles**-0.1


@pytest.mark.parametrize("lateral", [0.0, NU], ids=["plane stress", "plane strain"])
def test_damage_of_a_cycle_out_of_phase_is_its_life(lateral: float) -> None:
    """On the critical plane the path is one cycle along its longest chord; the largest normal stress is between its ends."""
    turn = 2.0 * np.pi * np.arange(12) / 12
    xx, yy, xy = 200.0 * np.sin(turn) + 50.0, 90.0 * np.sin(turn + 0.4), 60.0 * np.sin(turn + 1.3)
    cycle = history(xx=xx, yy=yy, xy=xy, zz=lateral * (xx + yy))
    limits = {"yield_strength": 465.0, "k": 1.0}
    for damage, value, curve in (
        (fatigue.findley_damage(cycle, FINDLEY_CURVE, k=0.3), fatigue.findley(cycle, k=0.3), FINDLEY_CURVE),
        (
            fatigue.fatemi_socie_damage(cycle, lambda n: MATERIAL.fatemi_socie(n, **limits), **limits),
            fatigue.fatemi_socie(cycle, **limits),
            lambda n: MATERIAL.fatemi_socie(n, **limits),
        ),
    ):
        peak = value.maximum
        # Damage of a power is largest where the parameter is; rainflow may add small cycles.
        assert 1.0 / damage.value == pytest.approx(fatigue.life(peak.value, curve), rel=1e-4)
        assert damage.angle == pytest.approx(peak.angle, abs=5e-3) and damage.tilt == pytest.approx(peak.tilt, abs=5e-3)


@pytest.mark.parametrize("seed, lateral", [(0, 0.0), (1, NU)])
def test_damage_of_a_random_history_against_all_planes(seed: int, lateral: float) -> None:
    """Findley's damage is at least that of any plane and direction of a grid, and no more than the grid can miss."""
    random = np.random.default_rng(seed)
    stress = 100.0 * random.normal(size=(8, 4)) + 50.0
    stress[:, 3] = lateral * (stress[:, 0] + stress[:, 1])
    damage = fatigue.findley_damage(fatigue.StressCycle(0.0, 0.0, stress, G, NU), FINDLEY_CURVE, k=0.3)
    tensor = tensors(stress)
    most = 0.0
    for angle in np.pi * np.arange(24) / 24:
        for tilt in 0.5 * np.pi * np.arange(7) / 6:
            normal = np.array([np.cos(tilt) * np.cos(angle), np.cos(tilt) * np.sin(angle), np.sin(tilt)])
            first = np.array([-np.sin(angle), np.cos(angle), 0.0])
            second = np.cross(normal, first)
            for turn in np.pi * np.arange(6) / 6:
                shear = tensor @ normal @ (np.cos(turn) * first + np.sin(turn) * second)
                most = max(most, damage_by_levels(shear, tensor @ normal @ normal))
    assert most * (1.0 - 1e-6) <= damage.value < 1.1 * most


def damage_by_levels(shear: np.ndarray, normal: np.ndarray) -> float:
    """Findley's damage of a repeated history: cycles by taking out the smallest range until two states are left, each with the largest
    normal stress while it lasts, on a fine polyline of the history."""
    start = int(np.argmax(shear))
    loads, stress = (np.append(np.roll(one, -start), one[start]) for one in (shear, normal))
    time = np.arange(loads.size)
    inner = [i for i in range(1, loads.size - 1) if (loads[i] - loads[i - 1]) * (loads[i + 1] - loads[i]) < 0.0]
    turns = [0, *inner, loads.size - 1]
    damage = 0.0
    fine = np.linspace(0.0, time[-1], 4000)
    fine = np.union1d(fine, time)
    path, around = np.interp(fine, time, loads), np.interp(fine, time, stress)
    while len(turns) > 2:
        if len(turns) == 3:
            begin, turn = 0, turns[1]
            taken = (1,)
            during = around
        else:
            ranges = [abs(loads[turns[i + 1]] - loads[turns[i]]) for i in range(1, len(turns) - 2)]
            smallest = int(np.argmin(ranges)) + 1
            begin, turn = turns[smallest], turns[smallest + 1]
            after = fine > turn
            closed = after & ((path - loads[begin]) * np.sign(loads[turn] - loads[begin]) <= 0.0)
            during = around[(fine >= begin) & (fine <= fine[closed][0])]
            taken = (smallest, smallest + 1)
        value = 0.5 * abs(loads[turn] - loads[begin]) + 0.3 * np.max(during)
        damage += (max(value, 0.0) / FINDLEY_STRENGTH) ** 10
        turns = [one for place, one in enumerate(turns) if place not in taken]
    return damage


def tensors(stress: np.ndarray) -> np.ndarray:
    """Stress tensors, shape (states, 3, 3), of the components of a cycle."""
    xx, yy, xy, zz = stress.T
    zero = 0.0 * xx
    return np.moveaxis(np.array([[xx, xy, zero], [xy, yy, zero], [zero, zero, zz]]), -1, 0)


def test_equal_tension_in_two_directions_has_its_critical_plane_out_of_the_model() -> None:
    """Pulsating equibiaxial tension in plane stress: no plane perpendicular to the model has shear. Closed form of Findley."""
    k, s = 0.3, 200.0
    found = fatigue.findley(history(xx=[0.0, s], yy=[0.0, s]), k=k).maximum
    assert found.value == pytest.approx(0.5 * s * (k + np.hypot(0.5, k)), rel=1e-8)
    assert found.tilt == pytest.approx(0.5 * np.arctan(0.5 / k), abs=1e-4)
    strain = fatigue.fatemi_socie(history(xx=[0.0, s], yy=[0.0, s]), yield_strength=465.0, k=0.0).maximum
    assert strain.value == pytest.approx(0.25 * s / G, rel=1e-8) and strain.tilt == pytest.approx(0.25 * np.pi, abs=1e-4)


@pytest.mark.parametrize("lateral", [0.0, NU, None], ids=["plane stress", "plane strain", "any"])
def test_critical_planes_against_a_search_over_the_sphere(lateral: float | None) -> None:
    """Random cycles on planes with random normals, the best of them refined; the shear amplitude by all pairs of states."""
    random = np.random.default_rng(5)
    normals = random.normal(size=(4000, 3))
    stress = 150.0 * random.normal(size=(5, 6, 4)) + 80.0
    if lateral is not None:
        stress[..., 3] = lateral * (stress[..., 0] + stress[..., 1])
    cycles = fatigue.StressCycle(np.zeros(6), np.zeros(6), stress, G, NU)
    parameters = {
        "Findley": (fatigue.findley(cycles, k=0.3), lambda shear, normal: shear + 0.3 * normal),
        "Fatemi-Socie": (
            fatigue.fatemi_socie(cycles, yield_strength=465.0),
            lambda shear, normal: shear / G * (1.0 + np.maximum(normal, 0.0) / 465.0),
        ),
    }
    for place in range(6):
        tensor = tensors(stress[:, place])

        def on_sphere(vectors: np.ndarray, tensor: np.ndarray = tensor) -> tuple[np.ndarray, np.ndarray]:
            """Shear amplitude and largest normal stress."""
            unit = vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)
            traction = np.einsum("sij,nj->nsi", tensor, unit)
            normal = np.einsum("nsi,ni->ns", traction, unit)
            shear = traction - normal[..., None] * unit[:, None]
            return 0.5 * np.linalg.norm(shear[:, :, None] - shear[:, None], axis=-1).max(axis=(1, 2)), normal.max(axis=1)

        for found, value in parameters.values():
            every = value(*on_sphere(normals))
            best = 0.0
            for start in np.argsort(every)[-4:]:

                def negative(vector: np.ndarray, value: object = value, on_sphere: object = on_sphere) -> float:
                    return -float(value(*on_sphere(vector[None]))[0])

                options = {"xatol": 1e-8, "fatol": 1e-12, "maxiter": 2000}
                best = max(best, -minimize(negative, normals[start], method="Nelder-Mead", options=options).fun)
            assert found.values[place] == pytest.approx(best, rel=1e-5)


@pytest.mark.parametrize("shear", [30.0, 60.0, 100.0, 150.0])
def test_damage_of_a_simple_cycle_is_its_life(shear: float) -> None:
    """Shear with tension: the plane with the most damage, between those of the first search, is that of the largest parameter."""
    cycle = history(xx=[20.0, -20.0], xy=[shear, -shear])
    damage = fatigue.smith_watson_topper_damage(cycle, MATERIAL.smith_watson_topper)
    peak = fatigue.smith_watson_topper(cycle).maximum
    assert 1.0 / damage.value == pytest.approx(fatigue.life(peak.value, MATERIAL.smith_watson_topper), rel=1e-5)
    assert damage.angle == pytest.approx(peak.angle, abs=2e-3)


def edge_crack_by_dislocations(stress, points: int = 200) -> float:
    """K/sqrt(pi a) of an edge crack 0 < x < 1 in a half-plane from its singular integral equation, by Gauss-Chebyshev collocation.

    Edge dislocations at t have the stress 1/(x - t) - 1/(x + t) - 2 t (x - t)/(x + t)^3 on the crack, with their images in the free
    surface (Hills, Kelly, Dai, Korsunsky 1996, Solution of Crack Problems, chapter 2); their density is singular at the tip only.
    """
    i = np.arange(1, points + 1)
    odd = (2 * i - 1) * np.pi / (2 * points + 1)
    t, x = 0.5 * (1.0 + np.cos(odd)), 0.5 * (1.0 + np.cos(2 * i * np.pi / (2 * points + 1)))
    kernel = 1.0 / (x[:, None] - t) - 1.0 / (x[:, None] + t) - 2.0 * t * (x[:, None] - t) / (x[:, None] + t) ** 3
    density = np.linalg.solve(-kernel * 2.0 * t / (2 * points + 1), stress(x))
    # K from the density at the tip, by Krenk's interpolation.
    return float(2.0 * np.sqrt(2.0) / (2 * points + 1) * np.sum(np.sin(points * odd) / np.tan(0.5 * odd) * density))


def test_edge_crack_in_a_half_plane() -> None:
    """1.1215 sqrt(pi a) in tension (Koiter 1965); gradients as steep as those of a contact against the integral equation."""
    assert fatigue.stress_intensity(np.ones_like, 2.0) == pytest.approx(1.12152 * np.sqrt(2.0 * np.pi), rel=1e-4)
    for stress in (np.ones_like, lambda x: x, lambda x: np.exp(-5.0 * x), lambda x: 1.0 - 2.0 * np.sqrt(x)):
        expected = edge_crack_by_dislocations(stress)
        assert fatigue.stress_intensity(stress, 1.0) == pytest.approx(expected * np.sqrt(np.pi), rel=2e-3)


@pytest.mark.parametrize("ratio", [0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6])
def test_edge_crack_in_a_plate(ratio: float) -> None:
    """Tension and bending of a plate: Tada, Paris, Irwin (2000), section 2.10, and Gross and Srawley (1965), good to 0.5 and 0.2 %."""
    angle = 0.5 * np.pi * ratio
    tension = np.sqrt(np.tan(angle) / angle) / np.cos(angle) * (0.752 + 2.02 * ratio + 0.37 * (1.0 - np.sin(angle)) ** 3)
    bending = np.polynomial.polynomial.polyval(ratio, (1.122, -1.40, 7.33, -13.08, 14.0))
    scale = np.sqrt(np.pi * ratio)
    assert fatigue.stress_intensity(np.ones_like, ratio, thickness=1.0) == pytest.approx(tension * scale, rel=0.015)
    assert fatigue.stress_intensity(lambda x: 1.0 - 2.0 * x, ratio, thickness=1.0) == pytest.approx(bending * scale, rel=0.02)


def test_crack_through_the_plate_is_refused() -> None:
    with pytest.raises(ValueError, match="goes through the thickness"):
        fatigue.stress_intensity(np.ones_like, 1.0, thickness=1.0)


def test_short_cracks() -> None:
    """El Haddad: at the fatigue limit a crack of any length is at the threshold 1.1215 limit sqrt(pi (a + a0))."""
    threshold, limit = 130.0, 248.0
    a0 = fatigue.critical_length(threshold, limit, geometry_factor=1.12152)
    length = np.geomspace(1e-4, 10.0, 9)
    allowed = fatigue.short_crack_threshold(length, threshold, a0) / (1.12152 * np.sqrt(np.pi * length))
    np.testing.assert_allclose(allowed, threshold / (1.12152 * np.sqrt(np.pi * (length + a0))))
    assert allowed[0] == pytest.approx(limit, rel=1e-3)
    falling = fatigue.EdgeCrack(0.0, np.array([1.0, 2.0, 3.0]), np.array([[0.0, 0.0, 0.0], [10.0, 8.0, 4.0]]))
    assert falling.arrest_length(5.0) == pytest.approx(2.75) and np.isnan(falling.arrest_length(3.0))
    assert falling.arrest_length(11.0) == 1.0


def pad_scene(name: str = "fretting_fatigue") -> mfv.Scene:
    """An example of a pad test on a small mesh."""
    scene = mfv.Scene.from_file(EXAMPLES / f"{name}.nml")
    scene.mesh = mfv.Mesh(nodes=81)
    return scene


@pytest.fixture(scope="module")
def pad() -> mfv.Result:
    """A pad test with the bulk stress in phase with the shear."""
    return pad_scene().run()


def test_states_of_the_last_cycle(pad: mfv.Result) -> None:
    assert fatigue.last_cycle(pad) == (5, 6)
    turning = pad_scene()
    turning.mesh = mfv.Mesh(nodes=31)
    angles = 0.25 * np.pi * np.arange(17)
    loads = [mfv.Step(tangential_force=100.0 * np.sin(angle), lower_bulk_stress=60.0 * np.cos(angle)) for angle in angles]
    turning.steps = [mfv.Step(normal_force=500.0, friction=False), *loads]
    assert fatigue.last_cycle(turning.run()) == tuple(range(11, 19))
    once = pad_scene()
    once.steps = once.steps[:2]
    with pytest.raises(ValueError, match="repeat the cycle"):
        fatigue.last_cycle(once.run())


PRESS = mfv.Step(normal_force=500, friction=False)
HALF = 162.5  # half of mu P


def equal_pad(*steps: mfv.Step, **keys: object) -> mfv.Result:
    """A cylinder on a half-plane of the same material, pressed and then loaded."""
    material = {"youngs_modulus": 74100, "poisson_ratio": 0.33}
    bodies = mfv.Body.half_plane(**material), mfv.Body.disk(127, **material)
    return mfv.Scene(*bodies, friction=mfv.Friction.coulomb(0.65), mesh=mfv.Mesh(nodes=61), steps=[PRESS, *steps], **keys).run()


def swt_of_last_cycle(result: mfv.Result) -> float:
    return fatigue.smith_watson_topper(fatigue.stress_cycle(result, -1.3949, 0.0)).maximum.value


def cyclic(**keys: float) -> list[mfv.Step]:
    """A load to its target, and three cycles to its opposite and back."""
    return [mfv.Step(**keys), mfv.Step(**{name: -value for name, value in keys.items()}, cycles=3)]


@pytest.mark.parametrize("states", ["last_cycle", "reversals"])
def test_last_cycle_of_a_history_is_whole(states: str, tmp_path: Path) -> None:
    """A load may pass a value twice in a cycle, and the tangential force is constant in gross slip."""
    half = swt_of_last_cycle(equal_pad(*cyclic(tangential_force=HALF)))
    gross = swt_of_last_cycle(equal_pad(*cyclic(shift=0.06)))
    angle = 2.0 * np.pi * np.arange(1, 25) / 24
    (tmp_path / "loads.csv").write_text(f"tangential_force\n{HALF}\n0\n{-HALF}\n0\n")
    cases = [
        (mfv.History(shift=0.06 * np.cos(angle), cycles=3), 24, gross),
        (mfv.History(shift=0.06 * np.sin(angle), cycles=3), 24, gross),
        (mfv.History(tangential_force=HALF * np.sin(angle), cycles=3), 24, half),
        (mfv.History(tangential_force=[HALF, 0.0, -HALF, 0.0], cycles=3), 4, half),
        (mfv.History(tangential_force=[50.0, HALF, 0.0, -HALF, 0.0], period=4, cycles=3), 4, half),
        (mfv.History(file=tmp_path / "loads.csv", cycles=3), 4, half),
    ]
    for history, period, expected in cases:
        result = equal_pad(history=history, output=mfv.Output(states=states))
        end = len(result.steps)
        assert fatigue.last_cycle(result) == tuple(range(end - period + 1, end + 1))
        assert swt_of_last_cycle(result) == pytest.approx(expected, rel=1e-6)


def test_last_cycle_with_states_between_is_whole() -> None:
    gross = equal_pad(*cyclic(shift=0.06))
    finer, note = mfv.load_history.with_states_between(gross, 64)
    assert note == "" and fatigue.last_cycle(finer) == tuple(range(49, 65))
    assert swt_of_last_cycle(finer) == pytest.approx(swt_of_last_cycle(gross), rel=1e-6)
    half = swt_of_last_cycle(equal_pad(*cyclic(tangential_force=HALF)))
    forces = (HALF, -HALF, HALF, -HALF, 0.0)
    unloaded = equal_pad(*(mfv.Step(tangential_force=force) for force in forces))
    with pytest.raises(ValueError, match="do not contain a closed cycle"):
        fatigue.last_cycle(unloaded)
    finer, note = mfv.load_history.with_states_between(unloaded, 24)
    assert note == "" and fatigue.last_cycle(finer) == tuple(range(15, 25))
    assert swt_of_last_cycle(finer) == pytest.approx(half, rel=1e-6)
    for result in (gross, equal_pad(history=mfv.History(tangential_force=[-HALF, HALF], cycles=30))):
        finer, _ = mfv.load_history.with_states_between(result, 3)  # too few
        assert len(fatigue.last_cycle(finer)) == 2


def test_last_cycle_of_plain_steps_and_of_a_host() -> None:
    """A cycle that passes through its first loads twice is not taken for half of itself."""
    forces = (HALF, 0.0, -HALF, 0.0)
    twice = [mfv.Step(tangential_force=force) for force in (*forces, *forces)]
    half = swt_of_last_cycle(equal_pad(*cyclic(tangential_force=HALF)))
    result = equal_pad(*twice)
    assert fatigue.last_cycle(result) == (6, 7, 8, 9) and swt_of_last_cycle(result) == pytest.approx(half, rel=1e-6)
    with mfv.Case.from_text(result.attributes["input"].split("&step")[0] + "&step normal_force=500, friction=.false. /\n") as case:
        case.run()
        for force in (*forces, *forces):
            case.advance(tangential_force=force)
        assert fatigue.last_cycle(case.result()) == (6, 7, 8, 9)


def test_last_cycle_with_wear() -> None:
    """Forces of a cycle between two shifts change with wear, but its states are known; so is a last cycle that was not saved."""
    worn = equal_pad(*cyclic(shift=0.01), wear=mfv.Wear(coefficient=1e-7))
    assert fatigue.last_cycle(worn) == (len(worn.steps) - 1, len(worn.steps))
    ends = equal_pad(*cyclic(shift=0.01), output=mfv.Output(states="steps"))
    with pytest.raises(ValueError, match="save its turning points by states='last_cycle'"):
        fatigue.last_cycle(ends)


def test_surface_stresses_of_a_cycle(pad: mfv.Result) -> None:
    """The largest tension of the cycle is that of the library; plane strain; the mirrored half of the cycle has the mirrored stresses."""
    tension = mfv.stress.stress(pad, 0.0, 0.0).tension
    cycle = fatigue.stress_cycle(pad, np.array([tension.x, -tension.x]), np.zeros(2))
    xx, yy, _xy, zz = np.moveaxis(cycle.stress, -1, 0)
    assert xx[1, 0] == pytest.approx(tension.value, rel=1e-3)
    np.testing.assert_allclose(zz, 0.33 * (xx + yy), atol=1e-9)
    wide = fatigue.stress_cycle(pad, np.array([-3.0, 3.0]), np.full(2, -0.5)).stress
    half = pad_scene()
    half.steps[1:] = (
        mfv.Step(tangential_force=-162.5, lower_bulk_stress=-80.0),
        mfv.Step(tangential_force=162.5, lower_bulk_stress=80.0, cycles=2),
    )
    other = fatigue.stress_cycle(half.run(), np.array([-3.0, 3.0]), np.full(2, -0.5)).stress
    np.testing.assert_allclose(other[::-1], wide, rtol=1e-6, atol=1e-6)


def test_upper_body_is_the_mirror_image() -> None:
    """Two equal bodies, no bulk stress: the shear on the upper one is reversed, so it is in tension at the other edge."""
    scene = pad_scene("fretting_pad")
    scene.upper = mfv.Body.power(0.5 / 127.0, 2.0, youngs_modulus=74100, poisson_ratio=0.33)
    result = scene.run()
    edge = float(result.summary.contact_half_width)
    x = np.array([-edge, edge])
    lower, upper = (fatigue.stress_cycle(result, x, np.zeros(2), body=body).stress for body in mfv.stress.BODIES)
    assert lower[-1, 0, 0] > 50.0
    np.testing.assert_allclose(upper[:, ::-1, 0], lower[..., 0], rtol=1e-6)


def test_units_of_parameters(pad: mfv.Result) -> None:
    """Those of the case; strains have none; averages keep them."""
    cycle = fatigue.averaged_cycle(pad, 1.0, 0.1, method="point")
    assert cycle.units == fatigue.smith_watson_topper(cycle).units == fatigue.crossland(cycle, k=0.3).units == ("mm", "N/mm^2")
    assert fatigue.fatemi_socie(cycle, yield_strength=300.0).units == ("mm", "1")


def test_averages(pad: mfv.Result) -> None:
    """Averages over vanishing distances are the value at the hot spot; the line is the integral of stresses at its points."""
    tension = mfv.stress.stress(pad, 0.0, 0.0).tension
    for method in ("point", "area"):
        tiny = fatigue.averaged_cycle(pad, tension.x, 1e-7, method=method).stress
        assert tiny[-1, 0] == pytest.approx(tension.value, abs=0.3)
    depth = np.linspace(0.0, np.sqrt(0.1), 2001) ** 2
    along = fatigue.stress_cycle(pad, tension.x, -depth).stress
    expected = np.trapezoid(along, depth, axis=1) / 0.1
    np.testing.assert_allclose(fatigue.averaged_cycle(pad, tension.x, 0.05, method="line").stress, expected, rtol=1e-4, atol=1e-3)
    with pytest.raises(ValueError, match="'point', 'line' or 'area'"):
        fatigue.averaged_cycle(pad, tension.x, 0.05, method="volume")


def test_crack_below_a_pad(pad: mfv.Result) -> None:
    """A crack that is short beside the stress gradient is in uniform tension; far from the contact in the bulk stress alone."""
    tension = mfv.stress.stress(pad, 0.0, 0.0).tension
    surface = np.ptp(fatigue.stress_cycle(pad, tension.x, 0.0).stress[..., 0])
    short = fatigue.edge_crack(pad, tension.x, [1e-7]).range
    assert short[0] == pytest.approx(1.12152 * surface * np.sqrt(np.pi * 1e-7), rel=2e-3)
    remote = fatigue.edge_crack(pad, -4000.0, [1.0]).range
    assert remote[0] == pytest.approx(1.12152 * 160.0 * np.sqrt(np.pi), rel=2e-3)


def test_ruiz(pad: mfv.Result) -> None:
    """Zero where the contact sticks during the whole cycle; the second parameter is largest near the trailing edge."""
    found = fatigue.ruiz(pad)
    last = pad.steps[-1]
    inner = np.abs(found.x) < 0.4
    assert np.all(pad.state.status[inner] == mfv.NodeStatus.STICK)
    assert np.max(found.first[inner]) < 1e-9 * np.max(found.first)
    assert found.slip.max() == pytest.approx(float(pad.observables.largest_slip_range), rel=1e-12)
    assert found.units == ("N/mm", "N^2/mm^3")
    place = int(np.argmax(found.second))
    assert found.x[place] < -0.9 * 1.39 and found.shear[place] == pytest.approx(0.65 * last.pressure[place], rel=1e-9)
    assert found.slip[place] == pytest.approx(abs(pad.steps[5].slip[place] - pad.steps[4].slip[place]), rel=1e-12)


def test_ruiz_needs_friction() -> None:
    scene = pad_scene()
    scene.friction, scene.steps = None, [mfv.Step(normal_force=500), mfv.Step(normal_force=400, cycles=2)]
    with pytest.raises(ValueError, match="need friction"):
        fatigue.ruiz(scene.run())


def round_scene(lower: mfv.Body, upper: mfv.Body, normals: str) -> mfv.Result:
    """A disk in a hole or two disks, pressed and sheared."""
    angle = 60.0 if normals == "radial" else 4.0
    scene = mfv.Scene(
        lower,
        upper,
        mesh=mfv.Mesh(nodes=61, half_angle=angle, normals=normals),
        friction=mfv.Friction.coulomb(0.3),
        steps=[
            mfv.Step(normal_force=1000.0 if normals == "radial" else 400.0),
            mfv.Step(force_ratio=0.4),
            mfv.Step(force_ratio=-0.4, cycles=2),
        ],
    )
    return scene.run()


ALUMINIUM, STEEL = {"youngs_modulus": 70000.0, "poisson_ratio": 0.33}, {"youngs_modulus": 210000.0, "poisson_ratio": 0.3}


@pytest.fixture(
    scope="module",
    params=[
        (mfv.Body.hole(10.05, **ALUMINIUM), mfv.Body.disk(10.0, **STEEL), "radial"),
        (mfv.Body.disk(10.0, **STEEL), mfv.Body.hole(10.05, **ALUMINIUM), "radial"),
        (mfv.Body.disk(20.0, **ALUMINIUM), mfv.Body.disk(10.0, **STEEL), "vertical"),
    ],
    ids=["pin above", "pin below", "disks"],
)
def round_bodies(request: pytest.FixtureRequest) -> tuple[mfv.Result, float]:
    """A result, and the radius to which arc lengths refer: of the hole; 0 for that of each body."""
    lower, upper, normals = request.param
    return round_scene(lower, upper, normals), 10.05 if normals == "radial" else 0.0


@pytest.mark.parametrize("body", mfv.stress.BODIES)
def test_surface_of_disks_and_holes(round_bodies: tuple[mfv.Result, float], body: str) -> None:
    """Along the surface is along the circle, below it is along the radius: stresses in polar components, distances from the centre."""
    result, common = round_bodies
    radius = float(result.scene[f"{body}_radius"])
    is_disk = result.attributes[f"{body}_body"].endswith("disk")
    inward = -1.0 if is_disk else 1.0
    above = is_disk == (body == "upper")
    centre = radius if above else -radius
    angle = np.asarray(result.mesh.arc) / (common or radius)

    def point(turn: np.ndarray, away: float | np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return away * np.sin(turn), centre - np.sign(centre) * away * np.cos(turn)

    numbers = fatigue.last_cycle(result)
    near = radius * (1.0 + inward * 1e-12)
    hoop = [mfv.stress.stress(result, *point(angle, near), body=body, step=n)["sigma_thetatheta"] for n in numbers]
    found = fatigue.ruiz(result, body=body).tension
    np.testing.assert_allclose(found, np.maximum(np.max(hoop, axis=0), 0.0), rtol=1e-6, atol=1e-6 * np.max(found))

    # A place beside the contact, where stresses vary slowly.
    loaded = np.any([result.steps[number - 1].pressure > 0.0 for number in numbers], axis=0)
    turn = angle[loaded].max() + (0.1 if common else 0.01)
    x = float(radius * np.sin(turn))
    surface = [mfv.stress.stress(result, *point(turn, near), body=body, step=n)["sigma_thetatheta"].item() for n in numbers]
    crack = fatigue.edge_crack(result, x, [1e-6], body=body).intensity[:, 0]
    np.testing.assert_allclose(crack, 1.12152 * np.sqrt(np.pi * 1e-6) * np.array(surface), rtol=2e-3)
    deep = fatigue.edge_crack(result, x, [0.1], body=body).intensity[:, 0]

    def along(depth: np.ndarray, number: int) -> np.ndarray:
        return mfv.stress.stress(result, *point(turn, radius + inward * depth), body=body, step=number)["sigma_thetatheta"]

    expected = [float(fatigue.stress_intensity(lambda d, n=n: along(d, n), 0.1)) for n in numbers]
    np.testing.assert_allclose(deep, expected, rtol=1e-9)

    below = fatigue.averaged_cycle(result, x, 0.1, method="point", body=body)
    np.testing.assert_allclose([below.x, below.y], point(turn, radius + inward * 0.05), rtol=0.0, atol=1e-12)
    exact = fatigue.stress_cycle(result, *point(turn, near), body=body).stress
    for method in ("line", "area"):
        mean = fatigue.averaged_cycle(result, x, 1e-6, method=method, body=body).stress
        np.testing.assert_allclose(mean, exact, atol=1e-3 * np.max(np.abs(exact)))


def test_area_in_a_disk_is_in_the_disk() -> None:
    """A half disk as large as the body covers the part of the disk that is nearer than L: the average of any stress there is finite."""
    result = pad_scene().run()
    for length in (1e-3, 0.1, 100.0):
        assert np.isfinite(fatigue.averaged_cycle(result, 1.3949, length, method="area", body="upper").stress).all()
    covered = fatigue.averaged_cycle(result, 0.0, 300.0, method="area", body="upper")
    assert covered.y == pytest.approx(127.0, rel=1e-3) and covered.x == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_picture_of_a_map(side: float) -> None:
    """The title has the maximum; the line along the critical plane goes into the body, at the angle of the plane."""
    x, y = np.meshgrid(np.linspace(-1.0, 1.0, 5), side * np.linspace(0.0, 1.0, 4))
    angle = np.full(x.shape, np.radians(30.0))
    values = np.where((x == 0.0) & (y == 0.0), 2.5, 1.0)
    ax = mfv.plot.parameter_contours(fatigue.ParameterMap("Findley", x, y, values, angle), pyplot.figure().subplots())
    line = np.diff(ax.lines[0].get_xydata(), axis=0)[0]
    assert line[1] * side > 0.0 and line[0] / line[1] == pytest.approx(-np.tan(np.radians(30.0)))
    assert ax.get_title() == "Findley: 2.5 at (0, 0), 30\N{DEGREE SIGN}"
    tilted = fatigue.ParameterMap("Findley", x, y, values, angle, np.full(x.shape, np.radians(20.0)))
    ax = mfv.plot.parameter_contours(tilted, pyplot.figure().subplots())
    assert ax.get_title().endswith("30\N{DEGREE SIGN}, tilted 20\N{DEGREE SIGN} out of the plane")
    named = fatigue.ParameterMap("Findley", x, y, values, angle, units=("mm", "N/mm^2"))
    for given, label in ((None, "N/mm$^2$"), (("mm", "MPa"), "MPa")):
        ax = mfv.plot.parameter_contours(named, units=given)
        assert ax.get_xlabel() == "$x$ [mm]" and f"2.5 {label} at" in ax.get_title()
        assert [bar.get_ylabel() for bar in ax.child_axes] == [label]
    assert not mfv.plot.parameter_contours(named, colour_bar=False).child_axes
    pyplot.close("all")


def test_points_are_dense_at_the_edges_of_a_curved_contact() -> None:
    """In a bore the edges of the contact are x, which differ from lengths along the surface by 2 %."""
    result = mfv.run(EXAMPLES / "pin_in_bore.nml")
    x, _ = fatigue.graded_points(result)
    left, right = result.summary.contact_left, result.summary.contact_right
    half = 0.5 * (right - left)
    for edge in (left, right):
        assert np.sum(np.abs(x[0] - edge) < 1.0e-3 * half) > 5
    assert abs(np.nanmin(result.state.contact_edge) - left) > 0.02 * half


HARD, SOFT = (mfv.Layer(thickness=t, youngs_modulus=e, poisson_ratio=nu) for t, e, nu in ((0.02, 3e5, 0.2), (0.03, 2e4, 0.4)))


def coated(*layers: mfv.Layer, above: bool = False) -> mfv.Result:
    """A coated body below a rigid cylinder, or a coated cylinder above a rigid half-plane, under a cycle of shear and bulk stress."""
    body = mfv.Body.disk(10.0, **ALUMINIUM) if above else mfv.Body.half_plane(**ALUMINIUM)
    body.layers = list(layers)
    other = mfv.Body(shape="half_plane", rigid=True) if above else mfv.Body.disk(10.0, rigid=True)
    bulk = f"{'upper' if above else 'lower'}_bulk_stress"
    steps = [
        mfv.Step(normal_force=50.0),
        mfv.Step(force_ratio=0.4, **{bulk: 20.0}),
        mfv.Step(force_ratio=-0.4, **{bulk: -20.0}, cycles=2),
    ]
    return mfv.Scene(
        *((other, body) if above else (body, other)), mesh=mfv.Mesh(nodes=61), friction=mfv.Friction.coulomb(0.5), steps=steps
    ).run(check=True)


@pytest.mark.parametrize("body", mfv.stress.BODIES)
def test_strains_in_every_layer_are_those_of_its_material(body: str) -> None:
    """Far from the contact all layers extend like the body under its bulk stress, in plane strain (1 - nu^2)/E times it."""
    result = coated(HARD, SOFT, above=body == "upper")
    into = -1.0 if body == "lower" else 1.0
    strain = 20.0 * (1.0 - 0.33**2) / 70000.0
    for depth, modulus in ((0.0, 3e5), (0.01, 3e5), (0.02, 3e5), (0.020001, 2e4), (0.05, 2e4), (0.051, 70000.0), (1.0, 70000.0)):
        cycle = fatigue.stress_cycle(result, 5000.0, into * depth, body=body)
        assert cycle.youngs_modulus == pytest.approx(modulus)
        found = fatigue.parameters.normal_strain(cycle, cycle.stress[..., 0])
        assert 0.5 * np.ptp(found) == pytest.approx(strain, rel=1e-3), depth


def test_points_and_averages_in_several_materials_are_refused() -> None:
    result = coated(HARD, SOFT)
    with pytest.raises(
        ValueError,
        match="layer 1 of the lower body and layer 2 of the lower body and the lower body below its layers: .* 0.02, 0.05",
    ):
        fatigue.stress_cycle(result, *fatigue.graded_points(result))
    with pytest.raises(ValueError, match="in layer 1 of the lower body and layer 2"):
        fatigue.averaged_cycle(result, 0.1, 0.02, method="line")
    with pytest.raises(ValueError, match="several|layer 1"):
        fatigue.edge_crack(result, 0.1, [0.01, 0.1])
    assert fatigue.averaged_cycle(result, 0.1, 0.2, method="point").youngs_modulus == pytest.approx(70000.0)
    assert fatigue.ruiz(result).tension.max() > 0.0


def test_cracks_that_are_not_short_against_a_layer_are_in_doubt() -> None:
    result = coated(HARD)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.filterwarnings("ignore", message="the mesh does not resolve")
        fatigue.edge_crack(result, 0.1, [5e-4, 9e-4])
        with pytest.raises(UserWarning, match="a crack of 0.01 is not short against the first layer of the lower body, 0.02"):
            fatigue.edge_crack(result, 0.1, [1e-3, 0.01])


def test_a_coating_of_the_same_material_changes_no_parameter() -> None:
    """Below the coating, and in it."""
    plain, same = coated(), coated(mfv.Layer(thickness=0.05, **ALUMINIUM))
    for depth in (0.0, 0.02, 0.2):
        plain_value, value = (
            fatigue.smith_watson_topper(fatigue.stress_cycle(one, 0.3, -depth)).maximum.value for one in (plain, same)
        )
        assert value == pytest.approx(plain_value, rel=1e-6)


def test_lives_below_an_anisotropic_layer() -> None:
    """The layer has none; the body below it has, also on a rigid one only the layers are a body."""
    fibres = {"youngs_modulus_1": 1.4e5, "youngs_modulus_2": 1e4, "youngs_modulus_3": 1e4, "shear_modulus_12": 5e3}
    layer = mfv.Layer(
        thickness=0.05, elasticity="orthotropic", poisson_ratio_12=0.3, poisson_ratio_13=0.3, poisson_ratio_23=0.4, **fibres
    )
    result = coated(layer)
    with pytest.raises(ValueError, match="layer 1 of the lower body is anisotropic"):
        fatigue.stress_cycle(result, 0.3, 0.0)
    assert fatigue.stress_cycle(result, 0.3, -0.1).youngs_modulus == pytest.approx(70000.0)


def test_what_the_mesh_does_not_resolve_is_said() -> None:
    scene = pad_scene()
    scene.mesh = mfv.Mesh(nodes=11)
    result = scene.run()
    with pytest.warns(UserWarning, match="does not resolve peak_pressure, .*largest_lower_tension"):
        fatigue.stress_cycle(result, 1.0, 0.0)
    with pytest.warns(UserWarning, match="does not resolve .*lower_tension"):
        fatigue.averaged_cycle(result, 1.0, 0.1)
    with pytest.warns(UserWarning, match="does not resolve largest_slip_range"):
        fatigue.ruiz(result)


def test_a_resolved_mesh_has_no_warning(pad: mfv.Result, recwarn: pytest.WarningsRecorder) -> None:
    fatigue.ruiz(pad)
    fatigue.averaged_cycle(pad, 1.0, 0.1)
    assert not recwarn.list


def test_disks_that_deform_as_half_planes_are_flat_inside() -> None:
    """Points on their surfaces, and stresses there, are those of the half-planes."""
    disk = mfv.Body.disk(10.0, elasticity="half_plane", **ALUMINIUM)
    flat = mfv.Body.power(0.05, 2.0, **ALUMINIUM)
    cycles = []
    for body in (disk, flat):
        scene = mfv.Scene(
            body, mfv.Body.disk(10.0, rigid=True), mesh=mfv.Mesh(nodes=61, half_width=0.4), friction=mfv.Friction.coulomb(0.5)
        )
        scene.steps = [mfv.Step(normal_force=50.0), mfv.Step(force_ratio=0.4), mfv.Step(force_ratio=-0.4, cycles=2)]
        result = scene.run(check=True)
        assert not np.any(fatigue.graded_points(result)[1][0])
        cycles.append(fatigue.averaged_cycle(result, 0.2, 0.05, method="area").stress)
    np.testing.assert_allclose(*cycles, rtol=1e-3, atol=0.1)
