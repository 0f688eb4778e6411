"""Namelists of examples/dissertation: every one is accepted, and the numbers of the dissertation's chapter 3 come out."""

from __future__ import annotations

import importlib
from functools import cache
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

import mfv

FOLDER = Path(__file__).resolve().parents[2] / "examples" / "dissertation"
BETA = 0.4 / 1.4  # nu = 0.3


@cache
def solved(number: int) -> mfv.Result:
    """The result of the base case of figure 3.number."""
    return mfv.run(FOLDER / f"figure_3_{number:02d}.nml", check=True)


@pytest.fixture
def beside(monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    """The independent solution that lies beside the namelists."""
    monkeypatch.syspath_prepend(str(FOLDER))
    return importlib.import_module("spence_coupled")


@pytest.mark.parametrize("number", range(1, 21))
def test_namelist_is_accepted(number: int) -> None:
    with mfv.Case.from_file(FOLDER / f"figure_3_{number:02d}.nml") as case:
        assert "warnings" not in case.result().attributes or not case.result().attributes["warnings"]


@pytest.mark.parametrize(
    "number, nodes", [(1, 21), (2, 103), (4, 103), (11, 87), (12, 87), (13, 85), (14, 42), (16, 43), (17, 43), (18, 43)]
)
def test_nodes_in_contact_are_those_of_the_dissertation(number: int, nodes: int) -> None:
    assert solved(number).summary.contact_nodes == nodes


def test_stick_ratio_of_the_mindlin_problem_to_one_node_per_side() -> None:
    result = solved(10)
    nodes = result.summary.contact_nodes
    for state in result.steps[1:]:
        exact = np.sqrt(1.0 - state.tangential_force / (0.7 * result.summary.normal_force))
        assert abs(state.stick_ratio - exact) <= 2.0 / nodes


def test_stick_ratio_decoupled_to_one_node_per_side() -> None:
    exact = mfv.reference.spence_stick_ratio(0.3, BETA)
    for number in (3, 4, 5, 6):
        assert abs(solved(number).summary.stick_ratio - exact) <= 2.0 / solved(number).summary.contact_nodes


def test_stick_ratio_coupled_to_one_node_per_side_of_an_independent_solution(beside: ModuleType) -> None:
    exact = beside.stick_ratio(0.3, BETA)
    assert exact < mfv.reference.spence_stick_ratio(0.3, BETA) - 0.05
    for number in (7, 8):
        assert abs(solved(number).summary.stick_ratio - exact) <= 2.0 / solved(number).summary.contact_nodes


def test_independent_solution_meets_its_known_limits(beside: ModuleType) -> None:
    assert beside.stick_ratio(0.3, 1.0e-6) == pytest.approx(1.0, abs=1.0e-5)  # incompressible: all stick
    adhering = beside.punch(1.0, 0.0, BETA, goodman=False)[1][0]
    assert adhering == pytest.approx(1.0 / (np.pi * np.sqrt(1.0 - BETA**2)), rel=2.0e-4)  # Muskhelishvili
    for mu in (0.1, 0.3, 1.0):
        exact = mfv.reference.spence_stick_ratio(mu, BETA)
        assert beside.stick_ratio(mu, BETA, goodman=True) == pytest.approx(exact, abs=2.0e-5)


def test_two_equal_cylinders_map_onto_a_rigid_one() -> None:
    two, one = solved(9), solved(11)
    np.testing.assert_array_equal(two.state.status, one.state.status)
    for quantity in ("pressure", "shear"):
        np.testing.assert_allclose(two.state[quantity], one.state[quantity], atol=2.0e-3 * one.state[quantity].max())


def test_static_and_kinetic_friction_is_symmetric_in_the_mindlin_problem() -> None:
    shear, status = solved(12).state.shear, solved(12).state.status
    np.testing.assert_allclose(shear, shear[::-1], atol=1.0e-11 * shear.max())
    np.testing.assert_array_equal(status, status[::-1])
    assert solved(12).certificate.largest < 1.0e-11
    stuck = np.flatnonzero(status == mfv.NodeStatus.STICK)
    assert stuck.size == np.ptp(stuck) + 1  # one zone


def test_cycle_is_steady_at_once_and_mirrored_up_to_a_node() -> None:
    """Sub-figures 12 and 20 are the ends of steps 11 and 18; the last step repeats the cycle."""
    result = solved(18)
    left, right, *again = (result.steps[i].shear for i in (10, 17, -2, -1))
    for state, repeated in zip((left, right), again):
        np.testing.assert_allclose(repeated, state, atol=1.0e-11 * np.abs(state).max())
    assert abs(np.argmin(left) - (left.size - 1 - np.argmax(right))) <= 1
    assert np.abs(left + right[::-1]).sum() < 0.15 * np.abs(left).sum()


def test_nominal_load_steps_lead_to_the_states_of_events() -> None:
    text = (FOLDER / "figure_3_20.nml").read_text().replace("nodes=100", "nodes=50")
    by_event = mfv.run(text=text.replace("'nominal'", "'event'"), check=True)
    for load_step in ("1.0", "0.25", "0.02"):
        nominal = mfv.run(text=text.replace("load_step=0.05", f"load_step={load_step}"), check=True)
        np.testing.assert_allclose(nominal.state.shear, by_event.state.shear, atol=1.0e-11 * by_event.state.shear.max())
