"""Contacts of several patches: the load of each, and invariances of all observables on random scenes."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matrix_bodies import half_plane

import mfv

SEEDS = range(5)

#: Counters and round-off, which may differ.
WORK = ("leaps", "linear_solves", "events", "largest_residual", "cycle_change", "change", "steps_done", "step", "record")

#: What changes its sign when right and left are exchanged; edges, which are exchanged too; and with the direction of the force.
ODD_PLACES = ("centre", "patch_shift", "_left", "_right", "tension_x", "largest_pressure_x", "largest_shear_x", "slip_range_x")
ODD_FORCES = ("tangential_force", "shift")


@dataclass(frozen=True)
class Case:
    """A half-plane under a rigid profile of bumps (middle, bend, rise), pressed and sheared to and fro."""

    modulus: float
    poisson_ratio: float
    coupling: str
    mu: float
    nodes: int
    half_width: float
    normal_force: float
    tangential_forces: tuple[float, ...]
    bumps: tuple[tuple[float, float, float], ...]
    shifted: float = 0.0
    cycles: int = 0

    def scene(self) -> mfv.Scene:
        """The scene."""
        body = mfv.Body.half_plane(shear_modulus=self.modulus, poisson_ratio=self.poisson_ratio, datum=self.half_width)
        mesh = mfv.Mesh(nodes=self.nodes, half_width=self.half_width)
        return mfv.Scene(body, self.profile(), mesh=mesh, **self.rest())

    def rest(self) -> dict[str, Any]:
        """What a scene has but for its bodies and its mesh."""
        steps = [mfv.Step(normal_force=self.normal_force), *(mfv.Step(tangential_force=q) for q in self.tangential_forces)]
        if self.cycles > 0:
            steps.append(mfv.Step(tangential_force=-self.tangential_forces[-1], cycles=self.cycles))
        return {"friction": mfv.Friction.coulomb(self.mu), "coupling": self.coupling, "steps": steps}

    def profile(self) -> mfv.Body:
        """The upper body."""
        x = np.linspace(-1.2, 1.2, 2401) * self.half_width
        heights = [
            (x - middle * self.half_width - self.shifted) ** 2 * bend / self.half_width + rise * self.half_width
            for middle, bend, rise in self.bumps
        ]
        return mfv.Body.profile(x, np.min(heights, axis=0), rigid=True)


def drawn(seed: int) -> Case:
    """Three random bumps of other heights and bends."""
    random = np.random.default_rng(seed)
    modulus, ratio = float(random.uniform(0.5, 2.0)), float(random.uniform(0.0, 0.45))
    half_width, mu = 0.02, float(random.uniform(0.2, 0.8))
    force = 0.004 * half_width * modulus / (1.0 - ratio)
    bumps = tuple((middle, float(random.uniform(0.15, 0.3)), float(random.uniform(0.0, 0.004))) for middle in (-0.55, 0.03, 0.6))
    shears = tuple(float(q) * mu * force for q in random.uniform(0.3, 0.9, 2) * (1.0, -1.0))
    coupling = str(random.choice(["full", "goodman", "none"]))
    return Case(modulus, ratio, coupling, mu, int(random.integers(91, 120)), half_width, force, shears, bumps)


def solved(case: Case) -> mfv.Result:
    """Its result, complete."""
    return mfv.run(case.scene(), check=True)


Numbers = dict[tuple[str, str], tuple[np.ndarray, str]]


def read_off(result: mfv.Result) -> Numbers:
    """Everything that is derived, with its unit, by group and name."""
    return {
        (group, name): (np.atleast_1d(np.asarray(values, dtype=float)), getattr(result, group).unit(name))
        for group in ("summary", "observables", "cycles", "patches")
        for name, values in getattr(result, group).items()
        if name not in WORK
    }


def mirrored(numbers: Numbers, nodes: int) -> Numbers:
    """What the mirror image of a result says."""
    seen: Numbers = {}
    for (group, name), (values, unit) in numbers.items():
        if group == "patches" or name == "friction_work":
            values = values[::-1]
        if (name.startswith(ODD_FORCES) and unit != "1" and not name.endswith(("amplitude", "_work"))) or any(
            part in name for part in ODD_PLACES
        ):
            values = -values
        if "_shear_intensity" in name:
            values = -values
        if group == "patches" and name.endswith("_node"):
            values = nodes + 1 - values
        for one, other in (("_left", "_right"), ("_right", "_left"), ("first_", "last_"), ("last_", "first_")):
            if one in name and (one.startswith("_") or group == "patches"):
                name = name.replace(one, other)
                break
        if is_of_edge(name):
            name = name.replace("left_", "right_") if name.startswith("left_") else name.replace("right_", "left_")
        if group == "patches" and name == "patch":
            values = values[::-1]
        seen[group, name] = values, unit
    return seen


def assert_same(found: Numbers, expected: Numbers, case: Case, tolerance: float = 1e-7, but: tuple[str, ...] = ()) -> None:
    """Equality to within a part of the sizes of the case."""
    assert found.keys() == expected.keys()
    traction = case.normal_force / case.half_width
    energy = case.normal_force * case.half_width
    sizes = {"length": case.half_width, "force/length": case.normal_force, "force/length^2": traction, "force": energy}
    for key, (values, unit) in expected.items():
        if key[1] in but:
            continue
        size = max(sizes.get(unit, 1.0), float(np.nanmax(np.abs(values), initial=0.0)))
        if unit == "force" and "dissipation" in key[1]:
            size = float(np.nanmax(np.abs(values), initial=0.0)) + 1e-9 * size
        np.testing.assert_allclose(found[key][0], values, rtol=0.0, atol=tolerance * size, err_msg=".".join(key))


@pytest.mark.parametrize("seed", SEEDS)
def test_patches_make_up_the_contact(seed: int) -> None:
    """Forces and lengths add up; edges are in order, next to the nodes, and what sticks is inside; the file has the same."""
    result = solved(drawn(seed))
    patches, summary, state = result.patches, result.summary, result.state
    assert patches.patch.size == summary.patches > 1
    assert patches.normal_force.sum() == pytest.approx(summary.normal_force, rel=1e-12)
    assert patches.tangential_force.sum() == pytest.approx(summary.tangential_force, rel=1e-9)
    assert patches.contact_length.sum() == pytest.approx(summary.contact_length, rel=1e-12)
    assert np.isnan(summary.contact_half_width)
    assert {"contact_half_width", "pressure_number"}.isdisjoint(result.observables)
    edges = np.column_stack((patches.contact_left, patches.contact_right)).ravel()
    assert np.all(np.diff(edges) > 0.0)
    interval = result.mesh.interval
    touching = np.zeros(result.mesh.x.size, dtype=bool)
    for first, last, left, right in zip(patches.first_node, patches.last_node, patches.contact_left, patches.contact_right):
        touching[first - 1 : last] = True
        assert left == pytest.approx(result.mesh.x[first - 1] - 0.5 * interval, abs=interval)
        assert right == pytest.approx(result.mesh.x[last - 1] + 0.5 * interval, abs=interval)
    np.testing.assert_array_equal(touching, state.status != mfv.NodeStatus.OPEN)
    sticks = patches.stick_zones > 0
    assert np.all(patches.stick_left[sticks] >= patches.contact_left[sticks])
    assert np.all(patches.stick_right[sticks] <= patches.contact_right[sticks])
    assert np.isnan(patches.stick_left[~sticks]).all()
    assert patches.stick_length.sum() == pytest.approx(summary.stick_ratio * summary.contact_length, rel=1e-12, abs=1e-15)


def test_far_bumps_are_hertzs() -> None:
    """Equal parabolas far apart bear the same; each has the half-width of Hertz under its force."""
    x = np.linspace(-1.0, 1.0, 4001)
    height = np.min([(x - middle) ** 2 / 2.0 for middle in (-0.5, 0.5)], axis=0)
    result = mfv.run(
        mfv.Scene(
            mfv.Body.half_plane(shear_modulus=1.0, poisson_ratio=0.3), mfv.Body.profile(x, height, rigid=True),
            mesh=mfv.Mesh(nodes=801, half_width=0.6), steps=[mfv.Step(normal_force=2.0e-3)],
        ),
        check=True,
    )  # fmt: skip
    exact = float(mfv.reference.hertz_half_width(1.0e-3, 1.0, 1.0, 1.8))
    assert result.patches.normal_force == pytest.approx([1.0e-3, 1.0e-3], rel=1e-6)
    assert 0.5 * result.patches.contact_length == pytest.approx([exact, exact], rel=5e-3)


def test_error_estimate_of_several_patches_is_of_their_length() -> None:
    """Not of a half-width, which they have not; the total between nodes."""
    case = drawn(1)
    scene = mfv.Scene(
        mfv.Body.half_plane(shear_modulus=case.modulus, poisson_ratio=case.poisson_ratio), case.profile(),
        mesh=mfv.Mesh(nodes=1001, half_width=case.half_width), output=mfv.Output(error_estimate=True), **case.rest(),
    )  # fmt: skip
    result = mfv.run(scene, check=True)
    assert "contact_half_width" not in result.error_estimate
    assert result.error_estimate.contact_length == result.observables.contact_length
    assert 0.0 < result.error_estimate.contact_length_error < 0.1 * result.observables.contact_length


def test_figure_of_several_patches(tmp_path: Path) -> None:
    """All patches, numbered, and the one that bears most; the state of a step too."""
    result = solved(drawn(0))
    largest = int(np.argmax(result.patches.normal_force))
    for step in (None, 1):
        picture = mfv.plot.figure(result, step)
        picture.savefig(tmp_path / "patches.png")
        assert len(picture.axes) == 6
    everything, one = mfv.plot.figure(result).axes[:2]
    assert [text.get_text() for text in everything.texts] == [str(number) for number in result.patches.patch]
    left, right = one.get_xlim()
    assert left < result.patches.contact_left[largest] < result.patches.contact_right[largest] < right


@pytest.mark.parametrize("seed", SEEDS)
def test_mirror_image(seed: int) -> None:
    """Forces to the left, the profile turned round: the same from the other side."""
    case = replace(drawn(seed), cycles=seed % 2)
    other = replace(
        case,
        tangential_forces=tuple(-q for q in case.tangential_forces),
        bumps=tuple((-middle, bend, rise) for middle, bend, rise in case.bumps),
    )
    here = read_off(solved(case))
    assert_same(mirrored(read_off(solved(other)), case.nodes), here, case)
    assert here["summary", "patches"][0] > 1


@pytest.mark.parametrize(("seed", "length", "force"), [(0, 1e3, 1.0), (1, 1e-6, 1e9), (2, 25.4, 4.448)])
def test_units(seed: int, length: float, force: float) -> None:
    """Lengths and forces in other units."""
    case = replace(drawn(seed), cycles=seed % 2)
    other = replace(
        case,
        modulus=case.modulus * force / length**2,
        half_width=case.half_width * length,
        normal_force=case.normal_force * force / length,
        tangential_forces=tuple(q * force / length for q in case.tangential_forces),
    )
    units = {"1": 1.0, "length": length, "force": force, "force/length": force / length, "force/length^2": force / length**2}
    units |= {"force/length^(3/2)": force / length**1.5, "force/length^(5/2)": force / length**2.5}
    found = {key: (values / units[unit], unit) for key, (values, unit) in read_off(solved(other)).items()}
    assert_same(found, read_off(solved(case)), case)


def is_of_edge(name: str) -> bool:
    """Whether a number is that of the field at one edge."""
    return name.startswith(("left_", "right_"))


@pytest.mark.parametrize("seed", SEEDS)
def test_split_steps(seed: int) -> None:
    """A step in two parts."""
    case = drawn(seed)
    first, second = case.tangential_forces
    split = replace(case, tangential_forces=(0.4 * first, first, 0.7 * first + 0.3 * second, second))
    found, expected = read_off(solved(split)), read_off(solved(case))
    assert_same(found, expected, case, but=tuple(name for _, name in expected if name.startswith(("largest_", "smallest_"))))
    # More rows take nothing away.
    for name in ("largest_pressure", "largest_shear", "largest_stick_ratio"):
        key = "observables", name
        assert found[key][0] >= expected[key][0] * (1.0 - 1e-7), name


@pytest.mark.parametrize("seed", SEEDS)
def test_cycles_are_steps_to_and_fro(seed: int) -> None:
    """Two cycles, or their four turns as steps."""
    case = replace(drawn(seed), cycles=2)
    there, back = -case.tangential_forces[-1], case.tangential_forces[-1]
    steps = replace(case, cycles=0, tangential_forces=(*case.tangential_forces, there, back, there, back))
    found = read_off(solved(steps))
    expected = {key: values for key, values in read_off(solved(case)).items() if key in found}
    assert_same(found, expected, case, but=tuple(name for _, name in expected if name.startswith(("largest_", "smallest_"))))
    assert {"patches", "stick_right", "contact_length"} <= {name for group, name in expected if group == "summary"}


@pytest.mark.parametrize("seed", SEEDS)
def test_shifted_profile(seed: int) -> None:
    """A profile some whole intervals to the side: so are all edges."""
    case = replace(drawn(seed), cycles=seed % 2)
    interval = 2.0 * case.half_width / case.nodes
    by = (seed - 2) * interval
    found, expected = (read_off(solved(replace(case, shifted=shift))) for shift in (by, 0.0))
    for (group, name), (values, unit) in expected.items():
        if name.endswith(("_left", "_right", "_x")) or "centre" in name:
            expected[group, name] = values + by, unit
        if group == "patches" and name.endswith("_node"):
            expected[group, name] = values + (seed - 2), unit
        if name == "friction_work":
            expected[group, name] = np.roll(values, seed - 2), unit
    assert_same(found, expected, case, tolerance=2e-3, but=("dissipation",))


@pytest.mark.parametrize("seed", SEEDS)
def test_matrix_is_its_half_plane(seed: int) -> None:
    """The half-plane as a matrix; the exponent at the edges under full coupling is then an estimate."""
    case = replace(drawn(seed), cycles=seed % 2)
    result = solved(case)
    body = half_plane(result.mesh.x, result.mesh.width, case.modulus, case.poisson_ratio, case.half_width, mean=False)
    matrix = mfv.run(mfv.Scene(body, case.profile(), **case.rest()), check=True)
    found, expected = read_off(matrix), read_off(result)
    for name in (
        "dissipation_number",
        "stiffness_number",
        "lower_tension",
        "lower_tension_x",
        "largest_lower_tension",
        "largest_lower_tension_x",
        "largest_lower_tension_row",
        "steady_stick_length",
    ):  # a matrix has no modulus and no inside, and is no half-plane
        expected.pop(("observables", name), None)
        expected.pop(("cycles", name), None)
    if case.coupling == "full":
        found, expected = ({key: value for key, value in of.items() if not is_of_edge(key[1])} for of in (found, expected))
    assert_same(found, expected, case, tolerance=2e-3 if case.coupling == "full" else 1e-7)


def test_peaks_between_opposite_slip_are_not_resolved_on_either_side() -> None:
    """Two bumps pressed with coupling: in the middle of each the shear jumps and the pressure has a logarithm. Which is the higher
    one, the left or the right, does not matter; without coupling the peak is smooth."""
    x = np.linspace(-1.2, 1.2, 401)
    bumps = np.minimum((x + 0.5) ** 2 / 2, (x - 0.5) ** 2 / 2 + 2e-4)
    names = {}
    for side, heights in (("left", bumps), ("right", bumps[::-1])):
        for coupling in ("full", "goodman"):
            result = mfv.Scene(
                mfv.Body.half_plane(shear_modulus=1.0, poisson_ratio=0.0),
                mfv.Body.profile(x, heights, interpolation="monotone_cubic", rigid=True),
                coupling=coupling,
                mesh=mfv.Mesh(nodes=100, half_width=0.9),
                friction=mfv.Friction.coulomb(0.25),
                steps=[mfv.Step(normal_force=0.05)],
            ).run(check=True)
            assert result.patches.contact_left.size == 2
            names[side, coupling] = set(result.attributes["unresolved"].split())
    assert names["left", "full"] == names["right", "full"] >= {"peak_pressure", "peak_shear"}
    assert names["left", "goodman"] == names["right", "goodman"]
    assert "peak_pressure" not in names["left", "goodman"]


@pytest.mark.parametrize("layered", [True, False])
@pytest.mark.parametrize("side", ["left", "right"])
def test_exponents_of_small_outermost_patches_are_not_resolved(side: str, layered: bool) -> None:
    """A small bump beside a large one, of a node or two with next to none of the force: only the exponent at its edge is in doubt,
    since whether the node slips is chance; nothing is without it."""
    x = np.linspace(-3.0, 3.0, 2401)
    outwards = x if side == "right" else -x
    layers = [mfv.Layer(thickness=0.5, youngs_modulus=2e5, poisson_ratio=0.25)] if layered else []
    body = mfv.Body.half_plane(youngs_modulus=7e4, poisson_ratio=0.2, layers=layers)
    for rise, poor in ((0.048, True), (0.07, False)) if layered else ((0.0595, True), (0.07, False)):
        heights = np.minimum(0.05 * x**2, rise + 4.0 * (outwards - 2.0) ** 2)
        scene = mfv.Scene(
            body,
            mfv.Body.profile(x, heights, rigid=True),
            mesh=mfv.Mesh(nodes=401, half_width=3.0),
            friction=mfv.Friction.coulomb(0.3),
            steps=[mfv.Step(normal_force=3000.0), mfv.Step(tangential_force=890.0 if side == "left" else -890.0)],
        )
        result = mfv.run(scene)
        force = result.patches.normal_force
        assert (len(force) == 2 and force.min() < 0.01 * force.sum()) == poor
        assert f"{side}_edge_exponent" in result.observables
        assert [name for name in result.unresolved if name.endswith("exponent")] == [f"{side}_edge_exponent"] * poor
        assert "peak_pressure" not in result.unresolved
