"""Load histories: lists, tables and files of turning points, and what is measured over their cycles."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scenes import HALF_PLANE, PROJECT, cylinder
from scipy.optimize import brentq

import mfv

PRESS = mfv.Step(normal_force=1.0e-3)
MESH = mfv.Mesh(nodes=61, half_width=0.016)
NORMAL = np.array([1.2e-3, 0.9e-3, 1.1e-3, 0.8e-3])
TANGENTIAL = np.array([2.0e-4, -1.0e-4, 3.0e-4, 0.0])


def run(history: mfv.History, *steps: mfv.Step, **keys: Any) -> mfv.Result:
    return cylinder(*(steps or (PRESS,)), history=history, **{"mesh": MESH, **keys}).run(check=True)


def same(one: mfv.Result, other: mfv.Result) -> bool:
    return all(np.array_equal(one.state[name], other.state[name], equal_nan=True) for name in one.state)


def test_rows_are_steps() -> None:
    steps = [mfv.Step(normal_force=float(p), tangential_force=float(q)) for p, q in zip(NORMAL, TANGENTIAL)]
    history = run(mfv.History(normal_force=NORMAL, tangential_force=TANGENTIAL))
    assert same(history, cylinder(PRESS, *steps, mesh=MESH).run(check=True))
    assert len(history.steps) == 2  # the pressing, and the last row


def test_two_turning_points_are_a_cycle_of_a_step() -> None:
    shear = mfv.Step(tangential_force=1.0e-4)
    step = cylinder(PRESS, shear, mfv.Step(tangential_force=-2.0e-4, cycles=3), mesh=MESH).run(check=True)
    history = run(mfv.History(tangential_force=[-2.0e-4, 1.0e-4], cycles=3), PRESS, shear)
    for name in ("dissipation", "loss_factor", "secant_stiffness", "stick_ratio_reversal", "cycle", "tangential_force_work"):
        assert np.allclose(history.cycles[name], step.cycles[name], rtol=1e-9, equal_nan=True), name


def test_a_list_a_table_and_a_file_are_the_same(tmp_path: Path) -> None:
    pandas = pytest.importorskip("pandas")
    table = pandas.DataFrame({"time": range(4), "normal_force": NORMAL, "tangential_force": TANGENTIAL})
    lists = run(mfv.History(normal_force=NORMAL, tangential_force=TANGENTIAL, period=3, cycles=2))
    assert same(lists, run(mfv.History.from_table(table, period=3, cycles=2)))
    for separator in (",", ";", " "):
        table.to_csv(tmp_path / "loads.csv", sep=separator, index=False)
        assert same(lists, run(mfv.History(file=tmp_path / "loads.csv", period=3, cycles=2)))
    with pytest.raises(TypeError, match="did you mean shift"):
        mfv.History.from_table(table.rename(columns={"normal_force": "shft"}))
    scene = cylinder(PRESS, history=mfv.History(tangential_force=TANGENTIAL))
    assert mfv.Scene.from_text(scene.text()) == scene


def test_the_stiffness_after_a_reversal_does_not_depend_on_the_rows() -> None:
    """A cycle of two rows, of four, and of 24 of a cosine: tangential_stiffness is that right after the last reversal."""
    force = 2.0e-4
    cosine = np.cos(2.0 * np.pi * np.arange(1, 25) / 24)
    found = [
        run(mfv.History(tangential_force=force * np.array(rows), cycles=2), PRESS, mfv.Step(tangential_force=force)).cycles
        for rows in ([-1.0, 1.0], [0.0, -1.0, -1.0, 0.0, 1.0], cosine)
    ]
    for cycles in found:
        assert cycles.tangential_stiffness[-1] == pytest.approx(found[0].tangential_stiffness[-1], rel=1e-9)
        assert cycles.dissipation[-1] == pytest.approx(found[0].dissipation[-1], rel=1e-9)


def test_a_ratio_follows_the_normal_force() -> None:
    ratio = run(mfv.History(normal_force=NORMAL, force_ratio=TANGENTIAL / (0.7 * NORMAL)))
    assert np.allclose(
        ratio.state.shear, run(mfv.History(normal_force=NORMAL, tangential_force=TANGENTIAL)).state.shear, atol=1e-12
    )


@pytest.mark.parametrize(
    ("states", "numbers"), [("steps", [1, 3]), ("reversals", [1, 2, 3, 4, 5, 6, 7, 8]), ("last_cycle", [1, 6, 7, 8]), ("none", [])]
)
def test_states_that_are_saved(states: Any, numbers: list[int]) -> None:
    result = run(mfv.History(tangential_force=TANGENTIAL, period=3, cycles=2), output=mfv.Output(states=states))
    everything = run(mfv.History(tangential_force=TANGENTIAL, period=3, cycles=2), output=mfv.Output(states="reversals"))
    expected = (
        [everything.steps[number - 1] for number in numbers] if len(numbers) != 2 else [everything.steps[0], everything.steps[7]]
    )
    assert len(result.steps) == len(expected)
    assert all(np.array_equal(one.shear, other.shear) for one, other in zip(result.steps, expected))


def test_many_rows_are_not_saved() -> None:
    random = np.random.default_rng(7)
    normal = random.uniform(0.5e-3, 1.5e-3, 400)
    result = run(mfv.History(normal_force=normal, force_ratio=random.uniform(-0.9, 0.9, 400)), output=mfv.Output(history="steps"))
    assert len(result.steps) == 2
    assert np.allclose(result.history.normal_force[2:], normal)  # the first two records: before and after the pressing


@pytest.mark.parametrize("keys", [{"coupling": "full"}, {"coupling": "none"}])
def test_the_areas_of_the_loops_add_up_to_the_dissipation(keys: dict[str, Any]) -> None:
    loads = {"rotation": [0.0, 1.0e-4, -1.0e-4, 0.0], "lower_bulk_stress": [0.0, 5.0e-3, 0.0, -5.0e-3]}
    for others in ({}, loads):
        cycles = run(mfv.History(normal_force=NORMAL, tangential_force=TANGENTIAL, cycles=3, **others), **keys).cycles
        areas = sum(cycles[name][-1] for name in cycles if name.endswith("_work") and name != "friction_work")
        assert areas == pytest.approx(cycles.dissipation[-1], rel=1e-9)
        expected = cycles.tangential_force_work / (np.pi * cycles.force_amplitude * cycles.shift_amplitude)
        assert np.allclose(cycles.loss_factor[1:], expected[1:])
        assert np.isnan(cycles.loss_factor[0])  # the first loop is open


def test_the_turning_point_where_a_history_ends_early() -> None:
    scene = cylinder(PRESS, history=mfv.History(tangential_force=[1.0e-4, -1.0e-3], cycles=2))
    result = scene.run()
    assert result.outcome == "gross sliding"
    assert "&history not reached: row 2, cycle 1: gross sliding" in result.message
    result = cylinder(PRESS, history=mfv.History(tangential_force=[1.0e-4, -1.0e-3])).run()
    assert "&history row 2 tangential_force=-0.001 not reached" in result.message


def test_invalid_histories(tmp_path: Path) -> None:
    def refusal(history: mfv.History, **keys: Any) -> str:
        with pytest.raises(mfv.errors.InputError) as raised:
            run(history, **keys)
        return str(raised.value)

    assert "needs a file, or lists of loads" in refusal(mfv.History(period=2))
    assert "has 2 values, another list has 4" in refusal(mfv.History(normal_force=NORMAL, tangential_force=[0.0, 1.0e-4]))
    assert "must be at most 4" in refusal(mfv.History(normal_force=NORMAL, period=5))
    assert "needs at least two turning points" in refusal(mfv.History(normal_force=NORMAL[:1], cycles=2))
    assert "normal_force is also given" in refusal(mfv.History(normal_force=NORMAL, approach=1.0e-4))
    assert "tangential_force must be 0 without friction" in refusal(mfv.History(tangential_force=[1.0e-4]), friction=None)
    file = tmp_path / "loads.csv"
    for text, message in (
        ("1,2\n3,4\n", "loads.csv:1: must have the names of the columns"),
        ("P,Q\n1e-3,0\n", "unknown column 'P'; P, Q and M are normal_force, tangential_force and moment"),
        ("tangetial_force\n1e-4\n", "unknown column 'tangetial_force'; did you mean tangential_force?"),
        (",shift\n1,2\n", "column 1 has no name"),
        ("# loads\ntangential_force;time\n1e-4;0\n2e-4\n", "loads.csv:4: must be two numbers"),
        ("time\n1\n", "its only column is time"),
        ("normal_force\n1e-3\n-1e-3\n", "normal_force must be at least 0, not -0.001 in row 2"),
    ):
        file.write_text(text)
        assert message in refusal(mfv.History(file=file))


def elliptical_loads(phase: float, points: int = 16) -> tuple[np.ndarray, np.ndarray]:
    """Turning points of P = P0 + P1 cos(t), Q = Q1 cos(t - phase)."""
    angle = 2.0 * np.pi * np.arange(1, points + 1) / points
    return 1.0e-3 + 3.0e-4 * np.cos(angle), 2.0e-4 * np.cos(angle - np.radians(phase))


def dissipation_by_elements(normal: np.ndarray, tangential: np.ndarray, mu: float, modulus: float, substeps: int) -> float:
    """Dissipation of the second cycle, by the extended solution of Ciavarella and Jaeger (Barber, Davies and Hills 2011).

    Uncoupled contact of half-planes is a sum of incremental flat punches: independent springs, of stiffness dk(a), that touch at the
    approach of the half-width a and slide at mu times their normal force. P = pi E* a^2/(4 R), k = dP/d(approach), R = 1.
    """
    half_width = np.linspace(0.0, 1.0, 1001)[1:] * np.sqrt(4.0 * normal.max() / (np.pi * modulus)) * (1.0 + 1.0e-9)
    datum = 20.0 * half_width[-1]

    def approach(a: Any) -> Any:
        return 0.5 * a**2 * (np.log(2.0 * datum / a) + 0.5)

    stiffness = np.diff(np.pi * modulus / (2.0 * np.log(2.0 * datum / half_width)), prepend=0.0)
    touching = approach(half_width) - 0.5 * np.diff(approach(half_width), prepend=0.0)
    force = np.zeros_like(touching)

    def unbalanced(shift: float, force: np.ndarray, limit: np.ndarray, target: float) -> float:
        return float(stiffness @ np.clip(force + shift, -limit, limit)) - target

    loss, path = 0.0, [(normal[-1], 0.0), *zip(normal, tangential), *zip(normal, tangential)]
    for number, ((p0, q0), (p1, q1)) in enumerate(zip(path[:-1], path[1:])):
        for share in np.arange(1, substeps + 1) / substeps:
            limit = mu * np.maximum(approach(np.sqrt(4.0 * (p0 + share * (p1 - p0)) / (np.pi * modulus))) - touching, 0.0)
            target, reach = q0 + share * (q1 - q0), limit.max() + np.abs(force).max() + 1.0e-12
            shift = brentq(unbalanced, -reach, reach, (force, limit, target), xtol=1e-18)
            after = np.clip(force + shift, -limit, limit)
            if number >= len(normal):
                loss += stiffness @ (0.5 * (force + after) * (force + shift - after))
            force = after
    return loss


@pytest.mark.parametrize("phase", [0.0, 45.0, 90.0, 135.0])
def test_dissipation_over_the_phase_of_normal_and_tangential_force(phase: float) -> None:
    normal, tangential = elliptical_loads(phase)
    modulus = 2.0 / 0.7  # 2 G/(1 - nu) over a rigid cylinder
    coarse, fine = (dissipation_by_elements(normal, tangential, 0.5, modulus, substeps) for substeps in (8, 16))
    scene = mfv.Scene(
        HALF_PLANE,
        mfv.Body.disk(1.0, rigid=True),
        coupling="none",
        mesh=mfv.Mesh(nodes=401, half_width=0.03),
        friction=mfv.Friction.coulomb(0.5),
        steps=[mfv.Step(normal_force=normal[-1])],
        history=mfv.History(normal_force=normal, tangential_force=tangential, cycles=2),
        output=mfv.Output(history="none"),
    )
    assert scene.run(check=True).cycles.dissipation[-1] == pytest.approx(2.0 * fine - coarse, rel=1e-3)


def test_no_dissipation_where_the_tangential_force_changes_more_slowly_than_its_limit() -> None:
    normal, _ = elliptical_loads(0.0)
    tangential = 0.6 * (normal - 1.0e-3)  # mu = 0.7
    cycles = run(mfv.History(normal_force=normal, tangential_force=tangential, cycles=3), coupling="none").cycles
    assert abs(cycles.dissipation[-1]) < 1e-12 * cycles.force_amplitude[-1] * cycles.shift_amplitude[-1]


def test_a_steady_cycle_forgets_its_initial_loads() -> None:
    """The dissipation depends on the periodic loads only, and not on a mean tangential force (Barber, Davies and Hills 2011)."""
    normal, tangential = elliptical_loads(60.0)
    found = []
    for before, mean in ((mfv.Step(tangential_force=0.0), 0.0), (mfv.Step(force_ratio=0.5), 0.0), (PRESS, 5.0e-5)):
        history = mfv.History(normal_force=normal, tangential_force=tangential + mean, cycles=3)
        cycles = run(history, mfv.Step(normal_force=1.4e-3), before, coupling="none").cycles
        found.append(cycles.dissipation[-1])
    assert np.allclose(found, found[0], rtol=1e-9)


def test_a_pad_that_rocks_under_a_constant_shear_walks() -> None:
    """Its tractions repeat while it moves on: the constant force, times the drift, is what friction dissipates."""
    elastic: Any = {"youngs_modulus": 115000.0, "poisson_ratio": 0.32}
    steps = [
        mfv.Step(normal_force=500.0, friction=False),
        mfv.Step(tangential_force=150.0, moment=300.0),
        mfv.Step(moment=-300.0, cycles=20, steady_tolerance=1e-5),
    ]
    result = mfv.Scene(
        mfv.Body.half_plane(**elastic),
        mfv.Body.rounded_punch(1.0, 100.0, **elastic),
        mesh=mfv.Mesh(nodes=101),
        friction=mfv.Friction.coulomb(0.5),
        steps=steps,
    ).run(check=True)
    cycles = result.cycles
    assert cycles.shift_drift[-1] * 150.0 == pytest.approx(cycles.dissipation[-1], rel=1e-5)
    assert result.observables.shift_drift == cycles.shift_drift[-1] == pytest.approx(2.2e-4, rel=0.02)
    assert abs(cycles.rotation_drift[-1]) < 1e-9 and abs(cycles.approach_drift[-1]) < 1e-9
    assert "cycles but walking" in result.message and result.attributes["warnings"].count("the upper body walks") == 1


def test_states_between_the_turning_points_of_a_result() -> None:
    from mfv.load_history import with_states_between

    result = run(mfv.History(normal_force=NORMAL, tangential_force=TANGENTIAL, cycles=3))
    for states, saved in ((2, 4), (6, 5), (12, 9), (60, 13)):  # whole cycles of four states, and the pressing
        shown = with_states_between(result, states)
        assert "for more states add rows" in shown.note
        assert len(shown.result.steps) == saved
        assert [float(state.normal_force) for state in shown.result.steps[-4:]] == pytest.approx(NORMAL)
        assert np.array_equal(shown.result.steps[-1].shear, result.state.shear)


def test_thinned_states_are_whole_cycles() -> None:
    from mfv.load_history import thinned, with_states_between

    turning = run(mfv.History(tangential_force=[-2.0e-4, 2.0e-4], cycles=30), output=mfv.Output(states="reversals"))
    steps = [PRESS, mfv.Step(tangential_force=2.0e-4), mfv.Step(tangential_force=-2.0e-4, cycles=10)]
    reversed_ = cylinder(*steps, mesh=MESH).run(check=True)
    for result, states in ((turning, 31), (reversed_, 12)):
        forces = [float(state.tangential_force) for state in with_states_between(result, states).result.steps]
        assert len(forces) <= states and forces[-2:] == pytest.approx([-2.0e-4, 2.0e-4])
        assert forces.count(pytest.approx(-2.0e-4)) >= 4
    assert len(thinned(turning, 1).steps) == 1


def test_a_drift_that_dies_out_is_no_walk() -> None:
    """Shakedown: shift and tractions of a coupled contact settle together."""
    result = mfv.run(PROJECT / "examples/cycles.nml")
    assert "steady" in result.message and "walk" not in result.message + result.attributes["warnings"]
    assert abs(result.cycles.shift_drift[-1]) < 1e-4 * abs(result.cycles.shift_drift[0])


def test_numbers_of_a_cycle_that_ends_without_a_normal_force_are_omitted() -> None:
    """Over a normal force that is a rounding error they were 1e15 and more."""
    elastic: Any = {"youngs_modulus": 70000.0, "poisson_ratio": 0.3}
    found = (
        mfv.Scene(
            mfv.Body.half_plane(**elastic),
            mfv.Body.disk(20.0, **elastic),
            friction=mfv.Friction.coulomb(0.3),
            steps=[mfv.Step(normal_force=100.0)],
            history=mfv.History(normal_force=[150.0, 80.0, 0.0], tangential_force=[20.0, -10.0, 0.0], cycles=2),
        )
        .run(check=True)
        .observables
    )
    assert found.cycle_dissipation > 0.0 and found.stiffness_number > 0.0
    assert "force_number" not in found and "dissipation_number" not in found


@pytest.mark.parametrize("separates", [False, True])
def test_areas_by_large_increments_are_accurate_or_unknown(separates: bool) -> None:
    """The work of P is some thousand times the dissipation; what straight lines miss of either is not known from that of both."""
    plane: Any = {"youngs_modulus": 0.85230, "poisson_ratio": 0.3}
    normal, tangential, mu, nodes = [5.96983e-3, 4.68764e-3], [-7.5039e-4, 2.1470e-4], 0.186411, 600
    if separates:
        normal, tangential, mu, nodes = [0.0, 5.96983e-3], [0.0, 8.9e-4], 0.5, 601

    def cycles(accuracy: float | None) -> Any:
        scene = mfv.Scene(
            mfv.Body.half_plane(**plane),
            mfv.Body.disk(62.6994, rigid=True) if separates else mfv.Body.disk(62.6994, youngs_modulus=1.20294, poisson_ratio=0.4),
            plane="stress",
            friction=mfv.Friction.coulomb(mu),
            mesh=mfv.Mesh(nodes=nodes, half_width=None if separates else 1.6),
            solver=mfv.Solver(accuracy=accuracy),
            steps=[mfv.Step(normal_force=max(normal)), *([] if separates else [mfv.Step(tangential_force=tangential[0])])],
            history=mfv.History(normal_force=normal[::-1], tangential_force=tangential[::-1], cycles=2),
            output=mfv.Output(history="none"),
        )
        return scene.run(check=True).cycles

    exact, quick = cycles(None), cycles(1.0e-2)
    assert quick.dissipation[-1] == pytest.approx(exact.dissipation[-1], rel=1e-2)
    assert np.isnan(quick.loss_factor[-1]) == np.isnan(quick.normal_force_work[-1]) == separates
    if not separates:
        assert quick.loss_factor[-1] == pytest.approx(exact.loss_factor[-1], rel=1e-2)
        assert quick.normal_force_work[-1] == pytest.approx(exact.normal_force_work[-1], abs=1e-2 * exact.dissipation[-1])


@pytest.mark.parametrize(
    "lower, upper, mu, normal, shears",
    [
        ((1.0, 0.0), (2.128, 0.3), 0.752, 1.607e-3, [9.536e-4, 3.652e-4, -6.601e-4, 1.026e-3, -7.878e-4]),
        ((1.0, 0.3), (0.549, 0.3), 0.831, 1.758e-3, [-8.013e-4, 1.110e-3, -6.178e-4, -8.672e-4]),
    ],
)
def test_large_increments_past_former_reversals(lower: Any, upper: Any, mu: float, normal: float, shears: list[float]) -> None:
    """The rate of the dissipation jumps where the load passes a former reversal; the first case was off by four times the accuracy."""
    bodies = [dict(zip(("youngs_modulus", "poisson_ratio"), values)) for values in (lower, upper)]

    def dissipations(accuracy: float | None) -> Any:
        scene = mfv.Scene(
            mfv.Body.half_plane(**bodies[0]),
            mfv.Body.disk(1.0, **bodies[1]),
            friction=mfv.Friction.coulomb(mu),
            mesh=mfv.Mesh(nodes=431),
            solver=mfv.Solver(accuracy=accuracy),
            steps=[mfv.Step(normal_force=normal), *(mfv.Step(tangential_force=shear) for shear in shears)],
            output=mfv.Output(history="steps"),
        )
        return np.diff(scene.run(check=True).history.dissipation)

    assert dissipations(3e-3)[1:] == pytest.approx(dissipations(None)[1:], rel=2 * 3e-3)


def test_yield_at_turning_points_is_noticed_whether_or_not_they_are_saved() -> None:
    """The peak of the history yields, its ends do not."""
    body = mfv.Body.half_plane(youngs_modulus=74100, poisson_ratio=0.33, yield_strength=150)
    pad = mfv.Body.disk(127, youngs_modulus=74100, poisson_ratio=0.33)
    history = mfv.History(normal_force=[100, 1000, 100], tangential_force=[10, 300, 10])
    for states in ("none", "steps", "reversals"):
        scene = mfv.Scene(
            body,
            pad,
            friction=mfv.Friction.coulomb(0.6),
            steps=[mfv.Step(normal_force=100)],
            history=history,
            output=mfv.Output(states=states),
        )
        assert "row 2 of &history, exceeds its yield_strength" in scene.run(check=True).attributes["warnings"], states


@pytest.mark.parametrize(
    "accuracy, last, words", [(1e-3, 1e-3, ""), (1e-3, 1e-5, "nodes in each patch"), (1e-6, 1e-3, "equal intervals")]
)
def test_a_mesh_too_coarse_for_the_accuracy_is_noticed(accuracy: float, last: float, words: str) -> None:
    """One contact of its nodes; one that is unloaded to a tenth of its width; more nodes than the program takes."""
    steps = [mfv.Step(normal_force=1e-3, friction=False), mfv.Step(normal_force=last)]
    warnings = cylinder(*steps, mesh=mfv.Mesh(), solver=mfv.Solver(accuracy=accuracy)).run(check=True).attributes["warnings"]
    assert ("accuracy=" in warnings and words in warnings) == bool(words)
