"""Cases advanced from Python: increments, loads, tangent, saved states, trials, observers, interrupts, arrays of the caller."""

from __future__ import annotations

import copy
import gc
import io
import os
import signal
import subprocess
import sys
import threading
import time
import weakref
from pathlib import Path

import numpy as np
import pytest
from scenes import PRESS, cylinder

import mfv
from mfv import errors

NOTHING_KEPT = mfv.Output(history="none", states="none")
SHEARED = PRESS, mfv.Step(tangential_force=2.8e-4), mfv.Step(tangential_force=-1.0e-4)


@pytest.fixture
def pressed() -> mfv.Case:
    """The pressed cylinder; states can be restored in any order."""
    case = cylinder(output=NOTHING_KEPT).contact()
    case.advance(normal_force=1.0e-3, friction=False, check=True)
    return case


def tractions(case: mfv.Case) -> bytes:
    """All fields of a state at the nodes, bit-identical."""
    return b"".join(np.asarray(case[f"state/{name}"]).tobytes() for name in ("pressure", "shear", "slip", "status"))


# --- steps and loads ---


def test_increments_lead_where_targets_do(pressed: mfv.Case) -> None:
    other = copy.deepcopy(pressed)
    other.advance(tangential_force=3.0e-4)
    for _ in range(3):
        pressed.advance(tangential_force=1.0e-4, relative=True, check=True)
    assert pressed.loads.tangential_force == pytest.approx(3.0e-4, rel=1e-12)
    np.testing.assert_allclose(pressed["state/shear"], other["state/shear"], rtol=0, atol=1e-12)
    pressed.advance(shift=0.0, normal_force=1.0e-4, relative=True)
    assert pressed.loads.normal_force == pytest.approx(1.1e-3, rel=1e-12)
    assert pressed.loads.shift == pytest.approx(other.loads.shift, rel=1e-9)


def test_friction_acts_unless_told() -> None:
    ended = []
    for keys in ({}, {"friction": None}, {"friction": True}, {"friction": False}):
        with cylinder().contact() as case:
            case.advance(normal_force=1.0e-3, **keys)
            ended.append(case.loads.slip_nodes + case.loads.stick_nodes)
    assert ended[0] == ended[1] == ended[2] > 0 == ended[3]


def test_loads_are_those_of_the_summary(pressed: mfv.Case) -> None:
    pressed.advance(tangential_force=2.8e-4)
    loads, summary = pressed.loads, pressed.result().summary
    for name in set(mfv.Loads._fields) & set(summary):
        assert getattr(loads, name) == summary[name], name
    assert loads.contact_nodes == loads.stick_nodes + loads.slip_nodes > 40
    assert loads.events > 5 and loads.linear_solves > 5
    assert loads.moment == pytest.approx(0.25 * 2.8e-4, rel=1e-9)
    assert loads.rotation == 0.0


def test_numbers_beyond_a_c_int_are_not_wrapped(pressed: mfv.Case) -> None:
    with pytest.raises(errors.BadArgument, match="cycles must be from 0 to 1000000"):
        pressed.advance(shift=1e-5, cycles=2**32)
    with pytest.raises(errors.BadArgument, match="cycles must be from 0 to 1000000"):
        pressed.advance(shift=1e-5, cycles=-(2**40))
    with pytest.raises(TypeError, match="must be numbers"):
        pressed.advance(shift="far")  # type: ignore[arg-type]
    with pytest.raises(TypeError):
        pressed.advance(shift=1e-5, cycles=1.5)  # type: ignore[arg-type]
    pressed.advance(shift=np.float64(1e-5), cycles=np.int64(1), friction=np.bool_(True))
    assert pressed.outcome == "complete"


def test_a_message_is_that_of_the_outcome_whatever_was_asked_in_between(pressed: mfv.Case) -> None:
    assert pressed.message == "step 1 was reached"
    with pytest.raises(KeyError):
        pressed["no/field"]
    with pytest.raises(errors.BadArgument):
        pressed.advance(normal_force=-1.0)
    assert pressed.message == "step 1 was reached" and "step 1 was reached" in repr(pressed)


# --- the tangent ---


def test_the_tangent_is_what_differences_give(pressed: mfv.Case) -> None:
    pressed.advance(tangential_force=2.0e-4)
    h = 1.0e-7
    for direction in ((0.0, 1.0), (0.0, -1.0), (1.0, 0.5)):
        tangent = pressed.tangent(direction)
        before = pressed.loads
        with pressed.trial():
            pressed.advance(approach=h * direction[0], shift=h * direction[1], relative=True, check=True)
            after = pressed.loads
        change = np.array([after.normal_force - before.normal_force, after.tangential_force - before.tangential_force])
        np.testing.assert_allclose(tangent @ np.multiply(h, direction), change, rtol=2e-2, atol=2e-11)
    assert pressed.tangent().shape == (2, 2)
    assert pressed.tangent((0, -1))[1, 1] > pressed.tangent((0, 1))[1, 1] > 0.0


def test_a_tangent_of_a_wrong_size_is_refused(pressed: mfv.Case) -> None:
    with pytest.raises(ValueError, match=r"must have 2 numbers, not the shape \(3,\)"):
        pressed.tangent((0.0, 1.0, 0.0))
    with pytest.raises(errors.BadArgument):
        pressed.tangent(motions=7)


# --- saved states, trials, copies ---


def test_states_can_be_gone_to_in_any_order(pressed: mfv.Case) -> None:
    kept = []
    for force in (1.0e-4, 3.0e-4, -1.0e-4):
        pressed.advance(tangential_force=force)
        kept.append((pressed.save(), tractions(pressed), pressed.loads))
    for state, expected, loads in (kept[1], kept[0], kept[2], kept[0]):
        pressed.restore(state)
        assert tractions(pressed) == expected
        assert pressed.loads == loads
    pressed.advance(tangential_force=3.0e-4)
    assert tractions(pressed) == kept[1][1]


def test_a_state_comes_back_after_an_early_end_and_outlives_its_case(pressed: mfv.Case) -> None:
    state, before = pressed.save(), tractions(pressed)
    copied = pressed.copy()
    assert pressed.advance(tangential_force=1.0) == "gross sliding"
    pressed.restore(state)
    assert (pressed.outcome, tractions(pressed)) == ("complete", before)
    pressed.close()
    copied.advance(tangential_force=1.0e-4)
    copied.restore(state)
    assert tractions(copied) == before


def test_storage_of_a_state_is_used_again(pressed: mfv.Case) -> None:
    state = pressed.save()
    pressed.advance(tangential_force=1.0e-4)
    expected = tractions(pressed)
    assert pressed.save(state) is state
    pressed.advance(tangential_force=2.0e-4)
    pressed.restore(state)
    assert tractions(pressed) == expected


def test_a_trial_is_taken_back_unless_it_is_accepted(pressed: mfv.Case) -> None:
    before = tractions(pressed)
    with pressed.trial():
        pressed.advance(tangential_force=1.0e-4)
        inner = tractions(pressed)
        with pressed.trial():
            pressed.advance(tangential_force=1.0)
        assert tractions(pressed) == inner
    assert tractions(pressed) == before
    with pytest.raises(ZeroDivisionError), pressed.trial():
        pressed.advance(tangential_force=1.0e-4)
        raise ZeroDivisionError
    assert tractions(pressed) == before
    with pressed.trial() as trial:
        pressed.advance(tangential_force=1.0e-4)
        trial.accept()
    assert tractions(pressed) == inner


def test_a_state_of_another_case_is_refused(pressed: mfv.Case) -> None:
    other = cylinder(mesh=mfv.Mesh(nodes=31, half_width=0.01225), output=NOTHING_KEPT).contact()
    with pytest.raises(errors.BadArgument):
        pressed.restore(other.save())
    assert pressed.loads.normal_force == pytest.approx(1.0e-3)


def test_copies_go_their_own_ways(pressed: mfv.Case) -> None:
    other = copy.copy(pressed)
    other.advance(tangential_force=2.8e-4)
    assert pressed.loads.tangential_force == 0.0
    pressed.close()
    assert other.advance(tangential_force=0.0) == "complete"


def test_what_is_not_used_any_more_is_freed() -> None:
    case = cylinder().contact()
    case.advance(normal_force=1.0e-4, cycles=1)
    gone = weakref.ref(case)
    del case
    gc.collect()
    assert gone() is None


# --- observers, progress, interrupts ---


def test_the_interpreter_can_end_while_a_thread_leads_a_case() -> None:
    script = """
        import threading, time, mfv
        from scenes import PRESS, cylinder
        case = cylinder(PRESS, mfv.Step(tangential_force=-2.8e-4, cycles=500), mesh=mfv.Mesh(nodes=401, half_width=0.01225)).contact()
        began = threading.Event()
        case.observe(lambda progress: began.set())
        threading.Thread(target=case.run, daemon=True).start()
        began.wait()
        """
    command = [sys.executable, "-c", "\n".join(line.strip() for line in script.splitlines())]
    paths = os.pathsep.join(map(str, (Path(mfv.__file__).parents[1], Path(__file__).parent)))
    environment = {**os.environ, "PYTHONPATH": paths}
    ended = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=60, check=False)
    assert (ended.returncode, ended.stderr) == (0, "")


def test_loads_that_a_stopped_step_has_not_reached_are_held(pressed: mfv.Case) -> None:
    pressed.observe(lambda told: told.tangential_force > 1.0e-4)
    pressed.advance(tangential_force=2.8e-4)
    pressed.observe(None)
    held = pressed.loads.tangential_force
    assert 1.0e-4 < held < 2.8e-4
    pressed.advance(normal_force=1.1e-3, check=True)
    assert pressed.loads.tangential_force == pytest.approx(held, rel=1e-12)


def test_an_observer_is_told_of_every_increment() -> None:
    seen: list[mfv.Progress] = []
    case = cylinder(*SHEARED).contact()
    case.observe(seen.append)
    case.run()
    force, pressed = case["history/tangential_force"], case["history/normal_force"]
    moved = (np.diff(force) != 0.0) | (np.diff(pressed) != 0.0)  # a reversal has a record of its own, at the same loads
    assert [told.tangential_force for told in seen] == list(force[1:][moved])
    assert [told.segment for told in seen] == sorted(told.segment for told in seen)
    assert seen[-1].segments == 3 and seen[-1].done == pytest.approx(1.0)
    loads = case.loads
    assert (seen[-1].tangential_force, seen[-1].shift) == (loads.tangential_force, loads.shift)
    count = len(seen)
    case.observe(None)
    case.advance(tangential_force=0.0)
    assert len(seen) == count
    alone = cylinder(*SHEARED).contact()
    alone.run()
    alone.advance(tangential_force=0.0)
    assert tractions(case) == tractions(alone)


def test_an_observer_can_end_a_run() -> None:
    with cylinder(*SHEARED).contact() as case:
        case.observe(lambda told: told.tangential_force > 1.0e-4)
        assert case.run() == "interrupted"
        assert 1.0e-4 < case.loads.tangential_force < 2.8e-4
        with pytest.raises(errors.Interrupted):
            case.run(check=True)


def test_what_a_callback_raises_is_raised() -> None:
    def fail(told: mfv.Progress) -> None:
        if told.segment == 2:
            raise ZeroDivisionError("in the callback")

    with cylinder(*SHEARED).contact() as case:
        case.observe(fail)
        with pytest.raises(ZeroDivisionError, match="in the callback"):
            case.run()
        assert case.outcome == "interrupted"
        assert case.loads.normal_force == pytest.approx(1.0e-3)
        assert case.result().outcome == "interrupted"


def test_a_callback_must_not_use_its_case(pressed: mfv.Case) -> None:
    for use in (
        lambda: pressed.loads,
        lambda: pressed["mesh/x"],
        lambda: pressed.advance(shift=0.0),
        pressed.save,
        pressed.close,
        lambda: pressed.observe(None),
    ):
        state = pressed.save()
        pressed.observe(lambda _, use=use: use())
        with pytest.raises(RuntimeError, match="must not use its case"):
            pressed.advance(tangential_force=1.0e-4)
        pressed.observe(None)
        pressed.restore(state)
        assert pressed.advance(tangential_force=0.0) == "complete"


def test_an_interrupt_from_the_keyboard_ends_a_long_run_with_its_state() -> None:
    # A process that a shell put into the background ignores interrupts.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    case = cylinder(PRESS, mfv.Step(tangential_force=2.8e-4), mfv.Step(tangential_force=-2.8e-4, cycles=1000000)).contact()
    timer = threading.Timer(0.3, signal.raise_signal, [signal.SIGINT])
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        case.run()
    timer.join()
    assert signal.signal(signal.SIGINT, before) is signal.default_int_handler
    assert case.outcome == "interrupted"
    assert case.loads.normal_force == pytest.approx(1.0e-3) and abs(case.loads.tangential_force) <= 2.8e-4 * (1 + 1e-9)


def test_progress_is_quiet_in_a_pipe_and_shown_on_a_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = cylinder(*SHEARED)
    quiet, terminal = io.StringIO(), io.StringIO()
    monkeypatch.setattr(sys, "stderr", quiet)
    plain = scene.run(progress=True)
    assert quiet.getvalue() == ""
    terminal.isatty = lambda: True  # type: ignore[method-assign]
    monkeypatch.setattr(sys, "stderr", terminal)
    shown = scene.run(progress=True)
    assert "100%" in terminal.getvalue()
    assert shown.state.shear.tobytes() == plain.state.shear.tobytes()


def test_other_threads_go_on_during_a_run() -> None:
    case = cylinder(PRESS, mfv.Step(tangential_force=2.8e-4), mfv.Step(tangential_force=-2.8e-4, cycles=400)).contact()
    worker = threading.Thread(target=case.run)
    worker.start()
    turns = 0
    while worker.is_alive():
        turns += 1
        time.sleep(0.001)
    assert turns > 20 and case.outcome == "complete"


# --- arrays of the caller's ---


def test_fields_are_copied_into_arrays_of_the_caller(pressed: mfv.Case) -> None:
    pressure, status = np.empty(61), np.empty(61, np.int32)
    assert pressed.values("state/pressure", pressure) is pressure
    np.testing.assert_array_equal(pressure, pressed["state/pressure"])
    np.testing.assert_array_equal(pressed.values("state/status", status), pressed["state/status"])
    rows = np.zeros((3, 61))
    pressed.values("state/pressure", rows[1])
    assert rows[1].tobytes() == pressure.tobytes() and not rows[[0, 2]].any()
    with pytest.raises(ValueError, match="contiguous, writable array of float64 or int32"):
        pressed.values("state/pressure", np.empty((61, 2))[:, 0])
    with pytest.raises(ValueError, match="contiguous, writable array of float64 or int32"):
        pressed.values("state/pressure", np.empty(61, np.float32))
    with pytest.raises(errors.BadArgument, match="61 values"):
        pressed.values("state/pressure", np.empty(60))
    with pytest.raises(errors.BadArgument, match="reals"):
        pressed.values("state/pressure", status)


def test_a_case_is_a_table_of_its_fields(pressed: mfv.Case) -> None:
    assert list(pressed) == pressed.fields()
    assert "state/pressure" in pressed and "state/presure" not in pressed and 0 not in pressed


def test_arguments_of_a_wrong_kind_are_named(pressed: mfv.Case) -> None:
    before = tractions(pressed)
    for call, message in (
        (lambda: pressed.advance(normal_force="1"), "must be numbers, not normal_force='1'"),
        (lambda: pressed.advance(shift=1e-5, steady_tolerance="no"), "steady_tolerance='no'"),
        (lambda: pressed.observe(5), "observe takes a function of the progress, or None, not 5"),
        (lambda: pressed.values("state/pressure", out=[0.0]), "out must be a numpy array, not list"),
    ):
        with pytest.raises(TypeError, match=message):
            call()
    assert tractions(pressed) == before


def test_positions_are_kept_until_the_mesh_grows() -> None:
    case = cylinder(mesh=mfv.Mesh(nodes=31)).contact()
    x = case.x
    assert x is case.x and not x.flags.writeable
    np.testing.assert_array_equal(x, case["mesh/x"])
    case.advance(normal_force=1.0e-3, friction=False)
    assert case.x.size == case["mesh/x"].size > x.size == 31


def test_a_case_shows_its_loads(pressed: mfv.Case) -> None:
    shown = pressed._repr_html_()
    for word in ("complete", "normal force", "0.001", "contact nodes"):
        assert word in shown
    pressed.close()
    assert "closed" in pressed._repr_html_()
    with pytest.raises(errors.BadHandle):
        _ = pressed.loads
