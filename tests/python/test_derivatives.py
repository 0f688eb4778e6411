"""Derivatives through events: against differences, in Newton's method, with saved states; and what is refused."""

from __future__ import annotations

import sys

import numpy as np
import pytest
from numpy.typing import NDArray
from scenes import DISK, HALF_PLANE, MESH, PROJECT, cylinder

import mfv
from mfv import errors

sys.path.insert(0, str(PROJECT / "bench"))
import derivatives as bench

NOTHING_KEPT = mfv.Output(history="none", states="none")
NUMBERS = mfv.Friction.coulomb(0.5)
WIDE = mfv.Mesh(nodes=61, half_width=0.0155)


def new_case(**keys: object) -> mfv.Case:
    """A cylinder with full coupling, whose states can be restored in any order."""
    return cylinder(**{"mesh": WIDE, "friction": NUMBERS, "coupling": "full", "output": NOTHING_KEPT, **keys}).contact()


@pytest.mark.parametrize("number", [1, 4, 6, 13, 14, 22, 44, 60, 99])
def test_random_scenes_agree_with_differences(number: int) -> None:
    outcome = bench.compared(number)  # of all keys and targets; it also finds the path unchanged
    assert outcome is not None
    assert outcome.kinks == 0
    assert outcome.largest < 1e-6
    assert outcome.solves <= 1.0


def iterations(case: mfv.Case, wanted: NDArray[np.float64], by_tangent: bool) -> int:
    """Steps of Newton's method for approach and shift that give a normal and a tangential force."""
    start, motion = case.save(), np.array([case.loads.approach, case.loads.shift])
    matrix = case.tangent((1.0, 1.0))
    for number in range(1, 40):
        case.restore(start)
        case.differentiate("approach", "shift")
        case.advance(approach=motion[0], shift=motion[1], check=True)
        missing = wanted - (case.loads.normal_force, case.loads.tangential_force)
        if abs(missing).max() < 1e-12 * wanted[0]:
            return number
        if number > 1 and by_tangent:
            matrix = case.tangent()
        elif number > 1:
            found = [case.derivatives[name].loads for name in ("approach", "shift")]
            matrix = np.array([[loads.normal_force for loads in found], [loads.tangential_force for loads in found]])
        motion = motion + np.linalg.solve(matrix, missing)
    raise AssertionError("Newton's method does not converge")


def test_newton_on_two_motions_converges_quadratically() -> None:
    with new_case() as case:
        case.advance(normal_force=8.0e-4)
        case.advance(tangential_force=1.5e-4)
        before = case.save()
        counts = []
        for by_tangent in (False, True):
            case.restore(before)
            counts.append(iterations(case, np.array([1.4e-3, 5.0e-4]), by_tangent))
    assert counts[0] <= 5 < 9 <= counts[1]


def test_friction_and_modulus_are_fitted_to_a_loop() -> None:
    """By Gauss-Newton, from shifts and dissipation of the run whose parameters are to be found."""

    def run(mu: float, modulus: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        below = mfv.Body.half_plane(shear_modulus=modulus, poisson_ratio=0.3)
        names = ("friction%mu", "body(1)%shear_modulus")
        with mfv.Scene(below, DISK, mesh=WIDE, friction=mfv.Friction.coulomb(mu), output=NOTHING_KEPT).contact() as case:
            case.differentiate(*names)
            case.advance(normal_force=8.0e-4, check=True)
            values, jacobian = [], []
            for force in (2.0e-4, -2.0e-4, 2.0e-4):
                case.advance(tangential_force=force, check=True)
                values += [case.loads.shift, case.loads.dissipation]
                found = [case.derivatives[name].loads for name in names]
                jacobian += [[loads.shift for loads in found], [loads.dissipation for loads in found]]
        return np.array(values), np.array(jacobian)

    measured, _ = run(0.5, 1.0)
    guess, errors_of_guess = np.array([0.6, 0.8]), []
    for _ in range(7):
        values, jacobian = run(*guess)
        scale = abs(measured)
        guess = guess - np.linalg.lstsq(jacobian / scale[:, None], (values - measured) / scale, rcond=None)[0]
        errors_of_guess.append(abs(guess - (0.5, 1.0)).max())
    assert errors_of_guess[-1] < 1e-9


def test_parameters_that_separate_simultaneous_events_are_named() -> None:
    with new_case() as case:
        case.differentiate("step(1)%normal_force", "step(1)%tangential_force", "friction%mu")
        case.advance(normal_force=8.0e-4, tangential_force=0.0)
        closed = case.loads.contact_nodes // 2  # in pairs, the first one or two at first contact
        events = {name: derivative.loads.events for name, derivative in case.derivatives.items()}
    assert events.pop("step(1)%tangential_force") == closed
    assert not any(events.values())


def test_states_and_copies_have_their_derivatives() -> None:
    with new_case() as case:
        case.differentiate("friction%mu", "step(2)%tangential_force")
        case.advance(normal_force=8.0e-4)
        pressed = case.save()
        case.advance(tangential_force=2.0e-4)
        first = case.derivatives
        case.restore(pressed)
        assert case.derivatives["step(2)%tangential_force"].loads.shift == 0.0
        other = case.copy()
        for again in (case, other):
            again.advance(tangential_force=2.0e-4)
            assert again.derivatives.keys() == first.keys()
            for name, derivative in again.derivatives.items():
                assert derivative.loads == first[name].loads
                np.testing.assert_array_equal(derivative.shear, first[name].shear)
        # A state is saved with the parameters of that time: with others it has none.
        case.differentiate("shift")
        case.restore(pressed)
        with pytest.raises(errors.BadArgument, match="no derivatives.*saved with other parameters than those of the last"):
            _ = case.derivatives
        with pytest.raises(errors.BadArgument, match="saved with other parameters"):
            _ = case.copy().derivatives
        case.differentiate("shift")
        again = case.save()
        case.advance(shift=1.0e-5)
        assert case.derivatives["shift"].loads.shift == pytest.approx(1.0, rel=1e-12)
        case.restore(again)
        assert case.derivatives["shift"].loads.shift == 0.0


def test_data_in_memory_are_kept_for_other_values_of_a_key() -> None:
    x = np.linspace(-0.03, 0.03, 61)
    shift = []
    for radius in (0.25, 0.25 * (1.0 - 1e-6), 0.25 * (1.0 + 1e-6)):
        rough = mfv.Body.profile(x, -1e-4 * x**2, shear_modulus=1.0, poisson_ratio=0.3)
        disk = mfv.Body.disk(radius, rigid=True)
        scene = mfv.Scene(rough, disk, mesh=WIDE, friction=mfv.Friction.coulomb([0.4, 0.6], x=[-0.01, 0.01]), output=NOTHING_KEPT)
        with scene.contact() as case:
            case.differentiate("body(2)%radius")
            case.advance(normal_force=8.0e-4)
            case.advance(tangential_force=1.0e-4, check=True)
            shift.append(case.loads.shift)
            if radius == 0.25:
                found = case.derivatives["body(2)%radius"].loads.shift
    assert found == pytest.approx((shift[2] - shift[1]) / 0.5e-6, rel=1e-5)


def test_cycles_of_a_history_hold_their_targets() -> None:
    """Against differences; the normal force is kept, and the cycle begins at a row whose target is a parameter."""
    at = {"step(1)%normal_force": 8.0e-4, "step(2)%tangential_force": 1.5e-4, "friction%mu": 0.5}
    names = ("shift", "approach", "normal_force", "tangential_force", "dissipation")

    def loads(given: dict[str, float], *parameters: str) -> tuple[mfv.Loads, dict[str, mfv.loads.Derivative]]:
        press, first, mu = given.values()
        history = mfv.History(tangential_force=[first, -1.0e-4, 2.5e-4, 0.5e-4], period=3, cycles=2)
        scene = cylinder(
            mfv.Step(normal_force=press), friction=mfv.Friction.coulomb(mu), history=history, mesh=WIDE, coupling="full"
        )
        with scene.contact() as case:
            case.differentiate(*parameters)
            case.run(check=True)
            return case.loads, case.derivatives

    base, found = loads(at, *at)
    assert found["step(1)%normal_force"].loads.normal_force == pytest.approx(1.0, rel=1e-12)
    for key, value in at.items():
        less, more = (loads({**at, key: value * factor})[0] for factor in (1.0 - 1e-6, 1.0 + 1e-6))
        for name in names:
            difference = (getattr(more, name) - getattr(less, name)) / (2e-6 * value)
            scale = abs(getattr(base, name)) / value
            assert getattr(found[key].loads, name) == pytest.approx(difference, rel=1e-5, abs=1e-6 * scale), (key, name)
    with pytest.raises(errors.BadArgument, match="cycle of &history"):
        loads(at, "step(3)%tangential_force")


@pytest.mark.parametrize(
    ("keys", "parameter", "why"),
    [
        ({"friction": mfv.Friction.static_kinetic(0.7, 0.5)}, "shift", "static_kinetic"),
        ({"solver": mfv.Solver(algorithm="conventional")}, "shift", "algorithm='mfv'"),
        ({"solver": mfv.Solver(stepping="leap", accuracy=1e-3)}, "shift", "every event"),
        ({"wear": mfv.Wear(coefficient=1e-3)}, "shift", "&wear"),
        ({}, "body(2)%redius", "did you mean radius"),
        ({}, "body(1)%radius", "not set in the case"),
        ({}, "mesh%half_width", "&body, &layer or &friction"),
        ({}, "body(1)%shape", "not a number"),
        ({}, "step(1)%friction", "not the target of a motion"),
    ],
)
def test_what_is_refused(keys: dict[str, object], parameter: str, why: str) -> None:
    with new_case(**keys) as case, pytest.raises(errors.BadArgument) as raised:
        case.differentiate(parameter)
    assert why in str(raised.value)


def test_keys_without_a_derivative_are_refused() -> None:
    punch = mfv.Body.flat_punch(0.01)
    with mfv.Scene(HALF_PLANE, punch, mesh=MESH).contact() as case, pytest.raises(errors.BadArgument, match="moves an edge"):
        case.differentiate("body(2)%half_width")
    strong = mfv.Body.half_plane(shear_modulus=1.0, poisson_ratio=0.3, yield_strength=1.0)
    with mfv.Scene(strong, DISK, mesh=MESH).contact() as case, pytest.raises(errors.BadArgument, match="has no effect"):
        case.differentiate("body(1)%yield_strength")


def test_no_derivatives_after_an_early_end_or_another_control() -> None:
    with new_case() as case:
        case.differentiate("step(1)%normal_force", "step(2)%shift")
        case.advance(normal_force=8.0e-4)
        assert case.derivatives["step(1)%normal_force"].loads.normal_force == pytest.approx(1.0, rel=1e-12)
        case.advance(tangential_force=1.0e-4)
        with pytest.raises(errors.BadArgument, match=r"step\(2\)%shift is not a target"):
            _ = case.derivatives
        case.differentiate("tangential_force")
        assert case.advance(tangential_force=1.0) == "gross sliding"
        with pytest.raises(errors.BadArgument, match="ended early"):
            _ = case.derivatives
