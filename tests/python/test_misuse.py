"""Misuse of the Python package: callbacks that raise, closed cases, wrong arrays, pickling, fork, threads, the end of the interpreter. Each
ends with an exception that says what is wrong, and what was misused still works."""

from __future__ import annotations

import copy
import os
import pickle
import re
import subprocess
import sys
import threading
from collections.abc import Iterator

import numpy as np
import pytest

import mfv
from mfv import errors

TEXT = """&scene coupling='goodman' / &body shape='half_plane', shear_modulus=1.0, poisson_ratio=0.3 /
&body shape='disk', radius=0.25, rigid=.true. / &mesh nodes=21, half_width=0.0127 /
&friction law='coulomb', mu=0.7 / &step normal_force=1.0e-3, friction=.false. / &step tangential_force=2.8e-4 /
"""


@pytest.fixture
def case() -> Iterator[mfv.Case]:
    with mfv.Case.from_text(TEXT) as made:
        yield made
        if made._handle:
            made.observe(None)
            still_works(made)


def still_works(case: mfv.Case) -> None:
    assert case.loads.contact_nodes >= 0 and np.isfinite(case["state/pressure"]).all()
    assert case.advance(normal_force=1.0e-3) == "complete"


@pytest.mark.parametrize("kind", [ValueError, KeyboardInterrupt, SystemExit, GeneratorExit, MemoryError, errors.BadHandle])
def test_what_a_callback_raises_ends_the_run_and_is_raised(case: mfv.Case, kind: type[BaseException]) -> None:
    def raises(progress: mfv.Progress) -> None:
        raise kind(1, "from the callback") if kind is errors.BadHandle else kind("from the callback")

    case.observe(raises)
    with pytest.raises(kind, match="from the callback"):
        case.run()
    assert case.outcome == "interrupted"


def test_a_callback_ends_a_run_at_the_first_any_and_the_last_call(case: mfv.Case) -> None:
    seen: list[mfv.Progress] = []
    start = case.save()
    case.observe(lambda progress: seen.append(progress) or False)
    assert case.run() == "complete"
    last = len(seen)
    end = case.loads
    for stop_at in range(1, last + 1):
        calls = iter(range(1, last + 1))
        case.restore(start)
        case.observe(lambda progress, calls=calls, stop_at=stop_at: next(calls) == stop_at)
        assert case.run() == "interrupted"
        case.observe(None)
        if case.loads.tangential_force == 0.0:
            case.advance(normal_force=1.0e-3, friction=False)
        case.advance(tangential_force=2.8e-4)
        assert case.loads.shift == pytest.approx(end.shift, rel=1e-11)


def test_what_a_callback_returns_may_be_anything(case: mfv.Case) -> None:
    class Unwilling:
        def __bool__(self) -> bool:
            raise TypeError("neither true nor false")

    for answer, outcome in ((None, "complete"), ("yes", "interrupted"), (np.bool_(True), "interrupted"), ([], "complete")):
        with mfv.Case.from_text(TEXT) as other:
            other.observe(lambda progress, answer=answer: answer)
            assert other.run() == outcome
    case.observe(lambda progress: Unwilling())
    with pytest.raises(TypeError, match="neither true nor false"):
        case.run()


def test_a_callback_cannot_use_or_close_its_case_but_another(case: mfv.Case) -> None:
    told: list[str] = []

    def uses(progress: mfv.Progress) -> None:
        for use in (case.run, case.save, case.copy, case.close, case.result, case.fields, case.tangent, lambda: case.loads):
            with pytest.raises(RuntimeError, match="must not use its case"):
                use()
        with mfv.Case.from_text(TEXT) as other:
            told.append(other.run())

    case.observe(uses)
    assert case.run() == "complete"
    assert set(told) == {"complete"}


def test_a_callback_may_drop_the_last_reference_to_its_case() -> None:
    holder = [mfv.Case.from_text(TEXT)]
    holder[0].observe(lambda progress: holder.clear())
    assert holder[0].run() == "complete"
    assert not holder


def test_a_closed_case_cannot_be_used() -> None:
    case = mfv.Case.from_text(TEXT)
    state = case.save()
    other = mfv.Case.from_text(TEXT)
    case.close()
    out = np.empty(21)
    for use in (
        case.copy,
        case.save,
        case.tangent,
        lambda: case.restore(state),
        lambda: case.values("state/shear", out),
        lambda: case.loads,
        lambda: case.x,
        lambda: case.message,
        lambda: case.observe(print),
        lambda: case.observe(None),
        lambda: copy.deepcopy(case),
    ):
        with pytest.raises(errors.BadHandle):
            use()
    other.restore(state)
    still_works(other)
    other.close()


def test_what_is_not_a_state_is_refused(case: mfv.Case) -> None:
    for wrong in (None, 3, case):
        with pytest.raises(TypeError, match="state must be a State, which Case.save returns, not "):
            case.restore(wrong)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="state must be a State, which Case.save returns, not 3"):
        case.save(3)  # type: ignore[arg-type]


def test_what_is_not_a_number_is_named(case: mfv.Case) -> None:
    for keys, named in (
        ({"normal_force": np.array([1e-4])}, "normal_force=array([0.0001])"),
        ({"normal_force": 1e-4, "steady_tolerance": None}, "steady_tolerance=None"),
        ({"normal_force": "a", "shift": [1.0], "approach": None}, "normal_force='a', shift=[1.0]"),
    ):
        with pytest.raises(TypeError, match=re.escape(f"must be numbers, not {named}") + "$"):
            case.advance(**keys)


def test_arrays_that_do_not_fit_are_refused(case: mfv.Case) -> None:
    read_only = np.empty(21)
    read_only.flags.writeable = False
    for out, kind in (
        (np.empty(20), errors.BadArgument),
        (np.empty(22), errors.BadArgument),
        (np.empty(0), errors.BadArgument),
        (np.empty(21, np.int32), errors.BadArgument),
        (np.empty(21, np.float32), ValueError),
        (np.empty(21, ">f8"), ValueError),
        (np.empty(21, object), ValueError),
        (np.empty(42)[::2], ValueError),
        (np.empty((21, 2))[:, 0], ValueError),
        (read_only, ValueError),
        ([0.0] * 21, TypeError),
        (None, TypeError),
    ):
        with pytest.raises(kind):
            case.values("state/shear", out)  # type: ignore[arg-type]
    for direction in ([1.0], [1.0, 2.0, 3.0], [[0.0, 1.0]], 1.0):
        with pytest.raises(ValueError, match="direction"):
            case.tangent(direction)
    for direction in ([np.nan, 1.0], [np.inf, 0.0], [0.0, 0.0]):
        with pytest.raises(errors.BadArgument):
            case.tangent(direction)
    with pytest.raises((ValueError, TypeError)):
        case.tangent(["a", "b"])  # type: ignore[list-item]
    for motions in (-1, 0, 1, 7, 2**31):
        with pytest.raises((errors.BadArgument, ValueError, OverflowError)):
            case.tangent(motions=motions)


def test_arrays_that_are_strided_or_of_other_numbers_are_taken(case: mfv.Case) -> None:
    case.run()
    expected = case.tangent([0.0, 1.0])
    for direction in (np.array([0.0, 9.0, 1.0, 9.0])[::2], np.array([0, 1], np.int8), np.array([0, 1], ">f4"), (0, 1)):
        np.testing.assert_array_equal(case.tangent(direction), expected)
    read_only = np.array([0.0, 1.0])
    read_only.flags.writeable = False
    np.testing.assert_array_equal(case.tangent(read_only), expected)


def test_wrong_names_and_numbers(case: mfv.Case) -> None:
    for path in ("", " ", "state/shear ", "state", "/", "\udcff", "\u00e9" * 5000, "state/shear\n"):
        with pytest.raises(KeyError):
            case[path]
    with pytest.raises(ValueError, match="null character"):
        case["state/\0"]
    for step in ({"shift": float("nan")}, {"normal_force": -1.0}, {"cycles": -1}, {"cycles": 10**30}, {"shift": float("inf")}):
        with pytest.raises(errors.BadArgument):
            case.advance(**step)  # type: ignore[arg-type]
    for step in ({"shift": "a"}, {"shift": [1.0]}, {"shift": 1j}, {"steady_tolerance": None}, {"cycles": 1.5}):
        with pytest.raises(TypeError):
            case.advance(**step)  # type: ignore[arg-type]


def test_cases_and_states_cannot_be_pickled(case: mfv.Case) -> None:
    for held in (case, case.save()):
        with pytest.raises(TypeError, match="belongs to this process"):
            pickle.dumps(held)
    scene = mfv.Scene.from_text(TEXT)
    assert pickle.loads(pickle.dumps(scene)).run().outcome == "complete"


def test_results_can_be_pickled(case: mfv.Case) -> None:
    case.run()
    result = case.result()
    again = pickle.loads(pickle.dumps(result))
    np.testing.assert_array_equal(again.state.pressure, result.state.pressure)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork here")
def test_a_child_of_fork_goes_on_with_its_own(case: mfv.Case) -> None:
    child = f"""
import os, mfv
case = mfv.Case.from_text({TEXT!r})
case.run()
child = os.fork()
outcome = case.advance(tangential_force=-2.0e-4)
case.close()
if child == 0:
    os._exit(0 if outcome == "complete" else 1)
print(os.waitpid(child, 0)[1], outcome)
"""
    run = subprocess.run([sys.executable, "-c", child], capture_output=True, text=True, timeout=120)
    assert (run.stdout, run.stderr) == ("0 complete\n", "")


def test_two_threads_on_one_case_take_turns(case: mfv.Case) -> None:
    case.run()
    failures: list[BaseException] = []

    def lead(sign: int) -> None:
        try:
            for _ in range(40):
                case.advance(tangential_force=sign * 1.0e-4)
                _ = case.loads, case["state/shear"], case.message
        except BaseException as error:
            failures.append(error)

    threads = [threading.Thread(target=lead, args=(sign,)) for sign in (-1, 1, -1, 1)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not failures


def test_a_handle_in_use_is_told(case: mfv.Case) -> None:
    """Around the lock of the package, straight to the library, as two hosts of one handle would."""
    from mfv._library import library

    statuses: list[int] = []
    case.observe(lambda progress: statuses.append(library().mfv_run(case._handle)) or False)
    case.run()
    assert statuses and {errors.failures()[status] for status in statuses} == {errors.InUse}


def test_the_interpreter_ends_with_open_cases_states_and_callbacks() -> None:
    child = f"""
import mfv
cases = [mfv.Case.from_text({TEXT!r}) for _ in range(5)]
states = [case.save() for case in cases]
for case in cases:
    case.observe(lambda progress: False)
    case.run()
cases[0].itself = cases[0]
print("done")
"""
    run = subprocess.run([sys.executable, "-X", "dev", "-c", child], capture_output=True, text=True, timeout=120)
    assert (run.returncode, run.stdout, run.stderr) == (0, "done\n", "")


def test_a_callback_that_ends_the_interpreter() -> None:
    child = f"""
import sys, mfv
case = mfv.Case.from_text({TEXT!r})
case.observe(lambda progress: sys.exit(7))
case.run()
"""
    run = subprocess.run([sys.executable, "-c", child], capture_output=True, text=True, timeout=120)
    assert (run.returncode, run.stderr) == (7, "")
