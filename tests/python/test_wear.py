"""Wear: volume, worn profiles, blocks of cycles, and the limits that it tends to."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scenes import HALF_PLANE

import mfv

FORCE, MU, RADIUS, COEFFICIENT = 1.0e-3, 0.5, 1.0, 1.0e-2
MODULUS = 2.0 / 0.7  # 2 G/(1 - nu), under a rigid cylinder
HALF_WIDTH = np.sqrt(4.0 * FORCE * RADIUS / (np.pi * MODULUS))


def worn(cycles: int, *, steps: list[mfv.Step] | None = None, wear: dict[str, Any] | None = None, **keys: Any) -> mfv.Result:
    """A cylinder sheared between half the limit of sliding to both sides."""
    given: dict[str, Any] = {
        "mesh": mfv.Mesh(nodes=101),
        "coupling": "none",
        "friction": mfv.Friction.coulomb(MU),
        "output": mfv.Output(states="steps", history="steps"),
        **keys,
    }
    return mfv.Scene(
        HALF_PLANE,
        mfv.Body.disk(RADIUS, rigid=True),
        wear=mfv.Wear(**{"coefficient": COEFFICIENT, **(wear or {})}),
        steps=steps or [mfv.Step(normal_force=FORCE), mfv.Step(force_ratio=0.5), mfv.Step(force_ratio=-0.5, cycles=cycles)],
        **given,
    ).run(check=True)


def sliding(cycles: int, **keys: Any) -> mfv.Result:
    """The cylinder slides to and fro over four times its elastic shift."""
    steps = [mfv.Step(normal_force=FORCE), mfv.Step(shift=2.0e-3), mfv.Step(shift=-2.0e-3, cycles=cycles)]
    return worn(cycles, steps=steps, **keys)


def test_partial_slip_wears_until_the_stick_zone_carries_the_load() -> None:
    """Ciavarella and Hills 1999, J. Strain Anal. 34, 131; Hills, Ramesh, Barber and Moore 2018: the slip zones lose their pressure,
    the stick zone and its profile stay. The parabola then touches over the half-width c of the stick zone, whose ends are sharp:
    p = 2 P_c sqrt(c^2 - x^2)/(pi c^2) + (P - P_c)/(pi sqrt(c^2 - x^2)), with Hertz's force P_c of the half-width c."""
    edge = HALF_WIDTH * np.sqrt(0.5)
    hertz = np.pi * MODULUS * edge**2 / (4.0 * RADIUS)
    errors = []
    for nodes in (101, 201):
        press, shear = mfv.Step(normal_force=FORCE), mfv.Step(force_ratio=0.5)
        steps = [press, shear, *(mfv.Step(force_ratio=-0.5, cycles=cycles) for cycles in (1000000, 2))]
        result = worn(0, steps=steps, wear={"coefficient": 1.0}, mesh=mfv.Mesh(nodes=nodes))
        x, pressure = result.mesh.x, result.state.pressure
        inner = np.abs(x) < 0.8 * edge
        root = np.sqrt(edge**2 - x[inner] ** 2)
        expected = 2.0 * hertz * root / (np.pi * edge**2) + (FORCE - hertz) / (np.pi * root)
        errors.append(np.max(np.abs(pressure[inner] / expected - 1.0)))
        assert result.cycles.dissipation[-1] < 1e-3 * result.cycles.dissipation[0]
        stuck = np.abs(x[(result.state.status == mfv.NodeStatus.STICK) & (pressure > 0.01 * pressure.max())])
        assert stuck.max() == pytest.approx(edge, abs=result.mesh.interval)
        assert result.state.wear_depth[np.abs(x) < edge - result.mesh.interval].max() < 1e-6 * result.state.wear_depth.max()
        assert result.summary.largest_residual < 1e-9
    assert errors[1] < 3e-3 and errors[0] > 1.5 * errors[1]


def test_peaks_where_the_worn_part_ends_are_resolved_or_said_not_to_be() -> None:
    """After few cycles the peak pressure agrees on all meshes; after many it grows with the number of nodes, without a limit."""
    meshes = (31, 61, 121, 241)
    few = [worn(30, mesh=mfv.Mesh(nodes=nodes), wear={"coefficient": 0.3}) for nodes in meshes]
    many = [worn(300, mesh=mfv.Mesh(nodes=nodes), wear={"coefficient": 0.3}) for nodes in meshes]
    peaks = np.array([[result.observables.peak_pressure for result in results] for results in (few, many)])
    assert np.ptp(peaks[0]) < 1e-3 * peaks[0, -1]
    assert np.all(peaks[1, 1:] > 1.25 * peaks[1, :-1])
    names = {"peak_pressure", "peak_shear", "largest_pressure"}
    for result in few:
        assert not names & set(result.attributes["unresolved"].split())
    for result in many:
        assert names <= set(result.attributes["unresolved"].split())


@pytest.mark.parametrize("run", [worn, sliding])
def test_the_worn_surfaces_pressed_anew_have_the_same_pressure(run: Any) -> None:
    result = run(300)
    x = result.mesh.x
    profile = RADIUS - np.sqrt(RADIUS**2 - x**2) + result.state.wear_depth
    assert result.state.wear_depth.max() > 1e-3 * HALF_WIDTH**2
    again = mfv.Scene(
        HALF_PLANE,
        mfv.Body.profile(np.r_[x[0] - 1e-3, x, x[-1] + 1e-3], np.r_[profile[0], profile, profile[-1]], rigid=True),
        mesh=mfv.Mesh(nodes=len(x), half_width=0.5 * len(x) * result.mesh.interval),
        steps=[mfv.Step(normal_force=FORCE)],
    ).run(check=True)
    assert np.allclose(again.state.pressure, result.state.pressure, atol=2e-4 * result.state.pressure.max())


def test_the_worn_volume_is_that_of_the_friction_work() -> None:
    for run in (worn, sliding):
        result = run(64, wear={"block": 1})
        assert len(result.cycles.cycle) == 64
        width, depth = result.mesh.width, result.state.wear_depth
        assert result.observables.worn_area == pytest.approx(np.sum(width * depth), rel=1e-12)
        assert result.observables.wear_depth == depth.max()
        assert result.observables.worn_area == pytest.approx(COEFFICIENT / MU * result.cycles.dissipation.sum(), rel=2e-3)
        assert np.allclose(np.diff(result.cycles.worn_area), COEFFICIENT / MU * result.cycles.dissipation[:-1], rtol=1e-2)


ALUMINIUM: dict[str, Any] = {"youngs_modulus": 74100, "poisson_ratio": 0.33}
CHANGING = {"normal_force": [300, 450, 300, 150], "tangential_force": [100, 0, -100, 0]}


def cycled(
    loads: dict[str, list[float]], *, cycles: int = 4, nodes: int = 101, steady: float | None = None, **wear: Any
) -> mfv.Result:
    """Two elastic bodies, or a rigid one where the history has approach or rotation, under closed cycles."""
    pad: dict[str, Any] = {"rigid": True} if {"approach", "rotation"} & set(loads) else ALUMINIUM
    return mfv.Scene(
        mfv.Body.half_plane(**ALUMINIUM),
        mfv.Body.disk(50, **pad),
        mesh=mfv.Mesh(nodes=nodes),
        friction=mfv.Friction.coulomb(0.6),
        wear=mfv.Wear(**{"law": "work", "coefficient": 2.0e-9, **wear}),
        steps=[mfv.Step(normal_force=300)],
        history=mfv.History(**loads, cycles=cycles, steady_tolerance=steady),
        output=mfv.Output(states="none"),
    ).run(check=True)


@pytest.mark.parametrize("law", ["work", "archard"])
@pytest.mark.parametrize(
    "loads",
    [
        CHANGING,
        {"tangential_force": [75, -75]},
        {"shift": [0.02, -0.02]},
        {"rotation": [0.004, 0, -0.004, 0], "tangential_force": [0, 60, 0, -60]},
        {"approach": [0.016, 0.012], "tangential_force": [40, -40]},
        {"normal_force": [300, 300, 0], "shift": [0.02, -0.02, 0]},
    ],
    ids=["force", "coupling", "sliding", "rocking", "approach", "separation"],
)
def test_wear_where_the_pressure_changes_within_the_cycle(law: str, loads: dict[str, list[float]]) -> None:
    """The worn area is the coefficient times the work, and every node wears by its own, also if it is open at the end."""
    result = cycled(loads, law=law, block=1)
    factor = 2.0e-9 if law == "work" else 2.0e-9 / 0.6
    assert result.observables.worn_area == pytest.approx(factor * result.cycles.dissipation.sum(), rel=1e-5)
    one, two = (cycled(loads, law=law, block=1, cycles=cycles).state for cycles in (1, 2))
    depth, work = two.wear_depth - one.wear_depth, two.friction_work - one.friction_work
    np.testing.assert_allclose(depth, factor * work, rtol=1e-3, atol=1e-3 * depth.max())


def test_wear_does_not_depend_on_the_row_where_the_cycle_starts() -> None:
    """After the first cycle, which begins at another load."""
    for wear in ({"block": 1, "coefficient": 1e-7}, {"coefficient": 1e-6}):
        areas = []
        for first in range(4):
            result = cycled({name: row[first:] + row[:first] for name, row in CHANGING.items()}, cycles=30, **wear)
            areas.append(result.observables.worn_area - result.cycles.worn_area[1])
        assert max(areas) == pytest.approx(min(areas), rel=1e-3 if "block" in wear else 0.05), wear


@pytest.mark.parametrize(
    "loads",
    [
        CHANGING,
        {"tangential_force": [75, -75]},
        {"normal_force": [150, 450, 450, 450], "shift": [0, 0.02, -0.02, 0]},
        {"normal_force": [450, 150], "shift": [0.02, -0.02]},
        {"rotation": [0.004, 0, -0.004, 0], "tangential_force": [0, 60, 0, -60]},
        {"approach": [0.016, 0.012], "tangential_force": [40, -40]},
        {"normal_force": [300, 300, 0], "shift": [0.02, -0.02, 0]},
    ],
    ids=["force", "coupling", "low", "phase", "rocking", "approach", "separation"],
)
def test_blocks_where_the_pressure_changes_within_the_cycle(loads: dict[str, list[float]]) -> None:
    """100 cycles in blocks against single cycles: worn area and dissipation within 1.2 times the tolerance."""
    coefficient = 8.0e-6
    exact = cycled(loads, nodes=61, cycles=100, coefficient=coefficient, block=1)
    for tolerance in (0.05, 0.01):
        blocks = cycled(loads, nodes=61, cycles=100, coefficient=coefficient, tolerance=tolerance)
        assert len(blocks.cycles.block) < 60
        for name in ("worn_area", "dissipation"):
            limit = max(1.2 * tolerance, 0.02)
            assert blocks.observables[name] == pytest.approx(exact.observables[name], rel=limit), (name, tolerance)
        computed = np.sum(blocks.cycles.block * blocks.cycles.dissipation)
        assert blocks.observables.worn_area == pytest.approx(coefficient * computed, rel=0.1)
        assert blocks.observables.worn_area == pytest.approx(coefficient * blocks.observables.dissipation, rel=0.02)


@pytest.mark.parametrize("block", [None, 10])
def test_wear_that_goes_on_is_not_steady(block: int | None) -> None:
    """The remaining wear must be within the tolerance, in long and in short blocks."""
    full, ended = (
        cycled({"shift": [-0.02, 0.02]}, cycles=500, law="archard", coefficient=1.0e-8, block=block, steady=steady)
        for steady in (None, 1.0e-3)
    )
    assert full.observables.cycles == 500 == full.cycles.block.sum()
    assert ended.observables.cycles == ended.cycles.block.sum()
    assert ended.observables.worn_area == pytest.approx(full.observables.worn_area, rel=1.1e-3)


def test_wear_that_has_ended_is_steady() -> None:
    """In partial slip the slip zones lose their pressure. Single cycles end long before the last one."""
    result = cycled({"tangential_force": [75, -75]}, cycles=2000, coefficient=1.0e-2, block=1, steady=0.05)
    assert "steady after" in result.message and result.observables.cycles < 1500


@pytest.mark.parametrize("law", ["work", "archard"])
def test_the_dissipation_counts_all_cycles_of_the_blocks(law: str) -> None:
    """The worn area is the coefficient times the work of friction; the same cycle by cycle. The energy balance holds."""
    factor = 1.0 if law == "work" else MU
    for run in (worn, sliding):
        result = run(3000, wear={"law": law, "coefficient": factor * COEFFICIENT / MU})
        assert len(result.cycles.cycle) < 300
        total = result.observables.dissipation
        assert COEFFICIENT / MU * total == pytest.approx(result.observables.worn_area, rel=2e-3)
        assert total == result.summary.dissipation
        assert total == pytest.approx(np.sum(result.mesh.width * result.state.friction_work), rel=1e-9)
        assert total > 10.0 * np.sum(result.cycles.dissipation)
        assert result.certificate.energy_balance < 1e-10
    blocks, cycles = sliding(256), sliding(256, wear={"block": 1})
    assert blocks.observables.dissipation == pytest.approx(cycles.observables.dissipation, rel=2e-3)


@pytest.mark.parametrize("coefficient", [1.0, 10.0, 100.0])
def test_wear_of_whole_slip_zones_in_few_cycles_is_warned_of(coefficient: float) -> None:
    """A few cycles against many that wear as much together: right to 6 %, or a warning."""
    warned = []
    for cycles in (1, 4, 16):
        few = worn(cycles, wear={"coefficient": coefficient})
        many = worn(32 * cycles, wear={"coefficient": coefficient / 32.0, "block": 1})
        error = abs(few.observables.worn_area / many.observables.worn_area - 1.0)
        warned.append("of the worn area is from cycles" in few.attributes["warnings"])
        assert warned[-1] or error < 0.06
        assert "of the worn area" not in many.attributes["warnings"]
    # The wear of 16 large cycles is that of the worn limit.
    assert warned[0] == (coefficient > 1.0) and not warned[2]


def test_blocks_of_a_given_size_and_those_that_are_chosen_are_right() -> None:
    exact = sliding(256, wear={"block": 1}).observables.worn_area
    first, second = (abs(sliding(256, wear={"block": block}).observables.worn_area / exact - 1.0) for block in (64, 16))
    assert second < 1e-4 and first < 4e-4
    chosen = [abs(sliding(256, wear={"tolerance": tolerance}).observables.worn_area / exact - 1.0) for tolerance in (0.1, 0.025)]
    assert max(chosen) < 1e-2


@pytest.mark.parametrize("cycles", [18_000, 100_000])
def test_the_pressure_is_uniform_up_to_the_edges_of_a_scar_that_grows(cycles: int) -> None:
    """In gross slip, by the tolerance of blocks alone: wear of a node begins when the edge of the scar reaches it, in the middle of
    a block. By single cycles the largest pressure is 1.01 times the mean one after 100 000 cycles."""
    text = (Path(__file__).parents[2] / "examples" / "wear.nml").read_text()
    assert "nodes=101" in text and "cycles=18000" in text
    text = text.replace("nodes=101", "nodes=51").replace("cycles=18000", f"cycles={cycles}")
    with mfv.Case.from_text(text, "wear.nml") as case:
        case.run()
        result = case.result()
    mean = result.observables.normal_force / result.observables.contact_length
    assert result.observables.patches == 1
    assert result.state.pressure.max() < 1.1 * mean
    assert result.observables.worn_area * 1.5 * 6.0 == pytest.approx((0.5 * result.observables.contact_length) ** 3, rel=0.08)


def test_a_first_cycle_unlike_the_others_wears_alone() -> None:
    """Pressed with friction and coupling, the first cycle dissipates 2.4 times as much as those that follow."""
    steps = [mfv.Step(normal_force=100.0), mfv.Step(shift=5.0e-4), mfv.Step(shift=-5.0e-4, cycles=200)]
    results = [
        mfv.Scene(
            mfv.Body.half_plane(youngs_modulus=70000, poisson_ratio=0.33),
            mfv.Body.disk(10, rigid=True),
            mesh=mfv.Mesh(nodes=101, half_width=0.17),
            friction=mfv.Friction.coulomb(0.6),
            wear=mfv.Wear(coefficient=1.0e-9, **wear),
            steps=steps,
        ).run(check=True)
        for wear in ({}, {"block": 1})
    ]
    blocks, cycles = (result.cycles for result in results)
    assert cycles.dissipation[0] > 2.0 * cycles.dissipation[1]
    assert len(blocks.block) <= 12 and blocks.block.sum() == 200 and blocks.block[0] == 1
    assert blocks.dissipation[-1] == pytest.approx(cycles.dissipation[-1], rel=1e-4)
    depths = [result.state.wear_depth for result in results]
    np.testing.assert_allclose(depths[0], depths[1], atol=1e-3 * depths[1].max())


def test_blocks_do_not_depend_on_what_is_kept() -> None:
    """Without a history only the last cycle is kept."""
    depths = []
    for history in ("events", "steps", "none"):
        result = worn(3000, output=mfv.Output(states="none", history=history))
        depths.append(result.state.wear_depth)
    assert np.array_equal(depths[0], depths[1]) and np.array_equal(depths[0], depths[2])


def test_a_scar_grows_to_the_width_of_its_volume() -> None:
    """Worn far beyond Hertz's contact, the flat is a chord of the cylinder: area 2 a^3/(3 R), under a uniform pressure. Every point
    slides over 4 (U - U_e) in a cycle, U_e the elastic shift at the limit of sliding."""
    result = sliding(100000, wear={"coefficient": 1.0e-3})
    half_width = 0.5 * result.observables.contact_length
    assert half_width > 3.0 * HALF_WIDTH
    assert half_width == pytest.approx((1.5 * RADIUS * result.observables.worn_area) ** (1.0 / 3.0), rel=0.02)
    inside = np.abs(result.mesh.x) < 0.8 * half_width
    assert np.allclose(result.state.pressure[inside], FORCE / (2.0 * half_width), rtol=0.1)
    path = 4.0 * (2.0e-3 - result.cycles.force_amplitude / result.cycles.tangential_stiffness)
    cycles = result.cycles.block
    assert result.observables.worn_area == pytest.approx(1.0e-3 * FORCE * np.sum(cycles * path), rel=0.03)


@pytest.mark.parametrize("coupling", ["full", "goodman"])
def test_solvers_and_laws_of_wear_agree(coupling: Any) -> None:
    usual = worn(200, coupling=coupling)
    assert usual.summary.largest_residual < 1e-9
    for solver in ("dgesv", "fft"):
        other = worn(200, coupling=coupling, solver=mfv.Solver(linear_solver=solver))
        assert np.allclose(other.state.wear_depth, usual.state.wear_depth, atol=1e-8 * usual.state.wear_depth.max())
        assert np.array_equal(other.cycles.block, usual.cycles.block)
    work = worn(200, coupling=coupling, wear={"law": "work", "coefficient": COEFFICIENT / MU})
    assert np.allclose(work.state.wear_depth, usual.state.wear_depth, rtol=1e-9)


def test_a_saved_state_brings_back_the_surfaces() -> None:
    scene = mfv.Scene(
        HALF_PLANE,
        mfv.Body.disk(RADIUS, rigid=True),
        coupling="none",
        friction=mfv.Friction.coulomb(MU),
        mesh=mfv.Mesh(nodes=61, half_width=0.04),
        wear=mfv.Wear(coefficient=COEFFICIENT),
        output=mfv.Output(states="none", history="none"),
    )
    with scene.contact() as case:
        case.advance(normal_force=FORCE)
        case.advance(tangential_force=2.0e-4)
        case.advance(tangential_force=-2.0e-4, cycles=50)
        saved, depth = case.save(), np.array(case["state/wear_depth"])
        case.advance(tangential_force=-2.0e-4, cycles=500)
        first = np.array(case["state/pressure"])
        assert np.max(case["state/wear_depth"]) > 1.5 * depth.max()
        case.restore(saved)
        assert np.array_equal(case["state/wear_depth"], depth)
        case.advance(tangential_force=-2.0e-4, cycles=500)
        assert np.allclose(case["state/pressure"], first, rtol=0.0, atol=1e-10 * first.max())


def test_invalid_wear() -> None:
    def refusal(**keys: Any) -> str:
        with pytest.raises(mfv.errors.InputError) as raised:
            worn(2, **keys)
        return str(raised.value)

    assert "needs a &friction law" in refusal(friction=None, steps=[mfv.Step(normal_force=FORCE, cycles=2)])
    assert "has no effect without a step with cycles" in refusal(steps=[mfv.Step(normal_force=FORCE)])
    assert "use law='work'" in refusal(friction=mfv.Friction.dahl(MU, 1.0e3))
    assert "has no effect with block" in refusal(wear={"block": 2, "tolerance": 0.1})
    with pytest.raises(mfv.errors.InputError, match="&wear: coefficient is missing"):
        mfv.run(text=worn(2).attributes["input"].replace("coefficient=0.01", "block=2"))


def random_scene(seed: int, *, length: float = 1.0, force: float = 1.0, mirror: bool = False, exchange: bool = False) -> mfv.Scene:
    """Two elastic bodies under a random cycle of both forces, with wear; in other units, mirrored, or turned upside down."""
    random = np.random.default_rng(seed)
    stress, loads = force / length**2, 10 ** random.uniform(-4, -3)
    ratios, modulus, mu = random.uniform(0.0, 0.45, 2), 10 ** random.uniform(-0.5, 0.5), random.uniform(0.2, 0.8)
    normal = loads * random.uniform(0.7, 1.3, random.integers(3, 7))
    tangential = (-1 if mirror else 1) * mu * normal * random.uniform(-0.8, 0.8, len(normal))
    bodies = [
        mfv.Body.half_plane(shear_modulus=stress, poisson_ratio=ratios[0]),
        mfv.Body.power(0.5 / length, 2.0, shear_modulus=modulus * stress, poisson_ratio=ratios[1]),
    ]
    flexibility = (1.0 - ratios[0]) / 2.0 + (1.0 - ratios[1]) / (2.0 * modulus)
    return mfv.Scene(
        *(bodies[::-1] if exchange else bodies),
        coupling=("full", "goodman", "none")[seed % 3],
        friction=mfv.Friction.coulomb(mu),
        mesh=mfv.Mesh(nodes=61, half_width=2.5 * np.sqrt(4.0 * loads * flexibility / np.pi) * length),
        wear=mfv.Wear(coefficient=10 ** random.uniform(-2, 0) / stress),
        steps=[mfv.Step(normal_force=loads * force / length)],
        history=mfv.History(normal_force=normal * force / length, tangential_force=tangential * force / length, cycles=400),
    )


@pytest.mark.parametrize("seed", range(9))
def test_wear_in_other_units_mirrored_and_upside_down(seed: int) -> None:
    def compared(name: str, result: mfv.Result, factor: float, turned: bool) -> None:
        values, expected = factor * result.state[name], first.state[name]
        assert np.allclose(values[::-1] if turned else values, expected, rtol=0.0, atol=1e-11 * np.max(np.abs(expected))), name

    first = random_scene(seed).run(check=True)
    length, force = 37.0, 5.0e4
    scaled = random_scene(seed, length=length, force=force).run(check=True)
    mirrored, exchanged = random_scene(seed, mirror=True).run(check=True), random_scene(seed, exchange=True).run(check=True)
    for name, unit, side in (("pressure", length**2 / force, 1), ("shear", length**2 / force, -1), ("wear_depth", 1.0 / length, 1)):
        compared(name, scaled, unit, False)
        compared(name, mirrored, side, True)
        compared(name, exchanged, 1.0, True)
    assert np.max(first.state.wear_depth) > 0.0


def test_the_mesh_grows_while_a_block_is_worn() -> None:
    """Where MFV has chosen the mesh, the worn contact reaches its end in the middle of a block."""
    areas = []
    for nodes in (22, 24, 30):
        disk = {"shear_modulus": 0.033, "poisson_ratio": 0.45}
        result = mfv.Scene(
            mfv.Body.hole(4.156e-3, **disk),
            mfv.Body.disk(2.872e-3, **disk),
            friction=mfv.Friction.coulomb(0.07),
            wear=mfv.Wear(coefficient=601.0),
            mesh=mfv.Mesh(nodes=nodes),
            steps=[mfv.Step(normal_force=5.87e-8), mfv.Step(shift=1.818e-7), mfv.Step(shift=-1.818e-7, cycles=15)],
        ).run(check=True)
        areas.append(result.observables.worn_area)
        assert (len(result.mesh.x) > nodes) == (nodes < 30) and result.certificate.largest < 1e-12
    assert max(areas) < 1.05 * min(areas)


def test_blocks_in_partial_slip_lose_little_wear() -> None:
    """Narrow slip zones: the worn area of blocks against that of single cycles, within twice the tolerance."""

    def area(**keys: Any) -> float:
        result = mfv.Scene(
            mfv.Body.half_plane(shear_modulus=1.0, poisson_ratio=0.3),
            mfv.Body.disk(0.25, rigid=True),
            friction=mfv.Friction.coulomb(MU),
            mesh=mfv.Mesh(nodes=101),
            steps=[
                mfv.Step(normal_force=FORCE, friction=False),
                mfv.Step(tangential_force=0.5 * MU * FORCE),
                mfv.Step(tangential_force=-0.5 * MU * FORCE, cycles=60),
            ],
            wear=mfv.Wear(coefficient=0.1, **keys),
            output=mfv.Output(states="none", history="none"),
        ).run(check=True)
        return float(np.sum(result.state.wear_depth * result.mesh.width))

    exact = area(block=1)
    for tolerance in (0.05, 0.01):
        assert area(tolerance=tolerance) == pytest.approx(exact, rel=2.0 * tolerance), tolerance


def uneven_scene(seed: int, *, half: bool = False, **wear: Any) -> mfv.Scene:
    """A random indenter (parabola, waves, unequal powers) on a half-plane, both laws of wear, partial or gross slip, constant or
    varying normal force; `half`: half as many cycles. The profiles of partial slip are of the kind of which blocks once wore 19
    times as much as single cycles."""
    random = np.random.default_rng([40, seed])
    nodes, ratios, mu = int(random.integers(25, 42)), random.uniform(0.0, 0.45, 2), random.uniform(0.2, 0.95)
    load, modulus, rigid = 10 ** random.uniform(-4, -3), 10 ** random.uniform(-0.5, 0.5), random.random() < 0.5
    flexibility = (1 - ratios[0]) / 2 + (0 if rigid else (1 - ratios[1]) / (2 * modulus))
    contact = np.sqrt(4 * load * flexibility / np.pi)
    upper: dict[str, Any] = {"rigid": True} if rigid else {"shear_modulus": modulus, "poisson_ratio": ratios[1]}
    x = np.linspace(-3.0, 3.0, 161) * contact
    shapes = [
        0.5 * x**2,
        0.5 * x**2
        + 0.5
        * contact**2
        * random.uniform(0.02, 0.2)
        * np.cos(2 * np.pi * x / (contact * random.uniform(0.5, 2.0)) + random.uniform(0, 6)),
        0.5 * contact**2 * np.abs(x / contact) ** random.uniform(2, 4) * (1 + 0.3 * random.uniform(-1, 1) * np.sign(x)),
    ]
    profile = shapes[random.integers(3)]
    law, motion = ("archard", "work")[random.integers(2)], random.integers(4)
    coefficient, cycles = 10 ** random.uniform(-2.5, 1.0), int(random.integers(20, 101)) // (2 if half else 1)
    steps = [mfv.Step(normal_force=load, friction=bool(random.random() < 0.7))]
    history = None
    if motion == 0:
        slide = 2.0 * mu * load * flexibility * random.uniform(1.0, 4.0)
        steps += [mfv.Step(shift=slide), mfv.Step(shift=-slide, cycles=cycles)]
    elif motion == 1:
        shear = mu * load * random.uniform(0.2, 0.95)
        steps += [mfv.Step(tangential_force=shear), mfv.Step(tangential_force=-shear * random.uniform(0.2, 1), cycles=cycles)]
    elif motion == 2:
        other = load * random.uniform(0.6, 1.4)
        shear = -mu * other * random.uniform(-0.5, 0.9)
        steps += [
            mfv.Step(tangential_force=mu * load * random.uniform(0.2, 0.9)),
            mfv.Step(normal_force=other, tangential_force=shear, cycles=cycles),
        ]
    else:
        rows = int(random.integers(3, 7))
        normal = load * random.uniform(0.7, 1.3, rows)
        tangential = mu * normal * random.uniform(-0.85, 0.85, rows)
        history = mfv.History(normal_force=normal, tangential_force=tangential, cycles=cycles)
    friction = (
        mfv.Friction.coulomb(mu) if random.random() < 0.85 else mfv.Friction.static_kinetic(mu, mu * random.uniform(0.85, 1.0))
    )
    return mfv.Scene(
        mfv.Body.half_plane(shear_modulus=1.0, poisson_ratio=ratios[0]),
        mfv.Body.profile(x, profile - profile.min(), **upper),
        coupling=("full", "goodman", "none")[random.integers(3)],
        friction=friction,
        mesh=mfv.Mesh(nodes=nodes, half_width=2.5 * contact),
        wear=mfv.Wear(law=law, coefficient=coefficient, **wear),
        steps=steps,
        history=history,
        output=mfv.Output(history="steps", states="none"),
    )


SEEDS = 500 if "MFV_DEEP" in os.environ else 16


def compared(result: mfv.Result, exact: mfv.Result) -> float:
    """The largest relative difference of worn area, largest depth and dissipation; of wear that is round-off: 0."""
    if exact.observables.worn_area < 1e-12 * exact.mesh.x.max() ** 2 > result.observables.worn_area:
        return 0.0
    names = ("worn_area", "wear_depth", "dissipation")
    return max(abs(result.observables[name] / exact.observables[name] - 1.0) for name in names)


def test_random_scenes_wear_in_blocks_as_in_single_cycles() -> None:
    """Within the tolerance of 5 %, in a fraction of the cycles; the same dissipation in history, summary and observables. Of the
    500 of MFV_DEEP one may differ by more: where bursts of slip shift in time (2 nodes in a slip zone, which is warned of)."""
    errors, cost, asked = [], 0, 0
    for seed in range(SEEDS):
        exact = uneven_scene(seed, half=SEEDS < 100, block=1).run()
        if exact.outcome != "complete":
            continue
        result = uneven_scene(seed, half=SEEDS < 100).run()
        assert result.outcome == "complete", seed
        errors.append(compared(result, exact))
        cost += len(result.cycles.block)
        asked += int(result.cycles.block.sum())
        assert asked and result.cycles.block.sum() == len(exact.cycles.block)
        assert result.history.dissipation[-1] == result.summary.dissipation == result.observables.dissipation
    print(f"{len(errors)} scenes: median {np.median(errors):.2g}, largest {np.sort(errors)[-3:]}; cost {cost / asked:.3f}")
    assert len(errors) > 0.8 * SEEDS
    assert np.median(errors) < 0.005 and np.sum(np.array(errors) > 0.05) <= len(errors) // 400
    assert cost < 0.4 * asked


def test_given_blocks_are_right_or_warned_of() -> None:
    """Random scenes in blocks of 10 cycles, and a large one."""
    warned = 0
    for seed in range(SEEDS // 2):
        exact = uneven_scene(seed, half=True, block=1).run()
        result = uneven_scene(seed, half=True, block=10).run()
        if "complete" not in (exact.outcome, result.outcome):
            continue
        warning = "worn_area and wear_depth: the estimated error from the given blocks" in result.attributes["warnings"]
        warned += warning
        assert result.outcome != "complete" or warning or compared(result, exact) < 0.05, seed
    assert warned < SEEDS // 4
    result = worn(1000, wear={"coefficient": 0.1, "block": 500})
    assert "worn_area and wear_depth: the estimated error from the given blocks" in result.attributes["warnings"]
