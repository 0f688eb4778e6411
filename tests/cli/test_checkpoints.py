"""Runs that are interrupted or killed, and resumed: they end with the tractions and the dissipation of the undisturbed run."""

import os
import random
import signal
import subprocess
import time
from pathlib import Path

import h5py
import numpy as np
import pytest
from disk import wait_for_work

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = Path(os.environ.get("MFV_RUN", ROOT / "build/release/bin/mfv_run"))
COMPLETE, INPUT, INTERRUPTED = 0, 2, 130

TEXT = """&body shape='half_plane', shear_modulus=1.0, poisson_ratio=0.3 /
&body shape='disk', radius=0.25, rigid=.true. /
&friction {friction} /
&mesh nodes={nodes} /
&solver {solver} /
&step normal_force=1e-3 /
&step tangential_force=2e-4, cycles={cycles} /
&output states='steps', checkpoint_minutes={minutes} /
"""
COULOMB = "law='coulomb', mu=0.5"
# A fifth of a second each on an idle machine.
RUNS = {
    "reduced": (COULOMB, 201, "linear_solver='reduced'", 15),
    "fft": (COULOMB, 61, "linear_solver='fft'", 2),
    "dahl": ("law='dahl', mu=0.5, stiffness=1e3", 41, "linear_solver='reduced'", 3),
    "conventional": (COULOMB, 61, "algorithm='conventional', load_step=0.01", 3),
}


def write_case(folder, friction=COULOMB, nodes=401, solver="linear_solver='auto'", cycles=30, minutes=1e-9):
    (folder / "case.nml").write_text(TEXT.format(friction=friction, nodes=nodes, solver=solver, cycles=cycles, minutes=minutes))


def start(folder, *options):
    return subprocess.Popen([PROGRAM, *options, "case.nml"], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def run(folder, *options):
    process = start(folder, *options)
    output, errors = process.communicate(timeout=300)
    return process.returncode, output, errors


def same_end(path, other):
    """Whether two results end with the same tractions and dissipation to 1e-10, over the same cycles."""
    with h5py.File(path) as one, h5py.File(other) as two:
        scale = np.abs(one["state/pressure"]).max()
        tractions = max(np.abs(one["state"][name][()] - two["state"][name][()]).max() for name in ("pressure", "shear")) / scale
        dissipation = np.abs(two["cycles/dissipation"][()] / one["cycles/dissipation"][()] - 1.0).max()
        return max(tractions, dissipation) < 1e-10 and set(one) == set(two) and len(one["steps"]) == len(two["steps"])


def stop_when_under_way(folder, how, name="case.h5", *options):
    """Start the case and stop it when its first checkpoint is there; its exit code, and what it said."""
    before = (folder / name).stat().st_mtime_ns if (folder / name).exists() else 0
    process = start(folder, *options)
    while process.poll() is None and not ((folder / name).exists() and (folder / name).stat().st_mtime_ns > before):
        time.sleep(0.005)
    process.send_signal(how)
    output, errors = process.communicate(timeout=300)
    return process.returncode, output, errors


def outcome_of(path):
    with h5py.File(path) as result:
        return result.attrs["outcome"]


@pytest.mark.parametrize("name", RUNS)
def test_a_run_that_is_stopped_again_and_again(tmp_path, name):
    write_case(tmp_path, *RUNS[name])
    before = os.times()
    assert run(tmp_path)[0] == COMPLETE
    used = os.times().children_user + os.times().children_system - before.children_user - before.children_system
    seconds, stops = 0.5 * used, 0
    (tmp_path / "case.h5").rename(tmp_path / "expected.h5")
    draw = random.Random(name)
    while True:
        how = draw.choice([signal.SIGKILL, signal.SIGKILL, signal.SIGINT, signal.SIGTERM])
        process = start(tmp_path, "--resume")
        wait_for_work(process, draw.uniform(0.5, 1.5) * seconds)
        if process.poll() is None:
            process.send_signal(how)
        _output, errors = process.communicate(timeout=300)
        if process.returncode == COMPLETE and stops > 0:
            break
        if process.returncode == COMPLETE:  # faster than the undisturbed run: once more, and sooner
            (tmp_path / "case.h5").unlink()
            seconds *= 0.5
            continue
        stops += 1
        assert process.returncode in (INTERRUPTED, -how), errors
        if (tmp_path / "case.h5").exists():
            assert outcome_of(tmp_path / "case.h5") in ("interrupted", "complete")  # complete: killed after its last write
        seconds *= 1.2  # a segment takes a while
    assert same_end(tmp_path / "expected.h5", tmp_path / "case.h5")
    assert outcome_of(tmp_path / "case.h5") == "complete"


def test_no_checkpoints_if_they_are_off_but_the_interrupted_result_is_one(tmp_path):
    write_case(tmp_path, cycles=3000, minutes=0)
    process = start(tmp_path)
    wait_for_work(process, 0.3)
    process.kill()
    process.communicate(timeout=300)
    assert not (tmp_path / "case.h5").exists()
    process = start(tmp_path)
    wait_for_work(process, 0.5)
    process.send_signal(signal.SIGTERM)
    output, _ = process.communicate(timeout=300)
    assert process.returncode == INTERRUPTED and "result              case.h5 (unfinished; --resume continues)" in output
    assert outcome_of(tmp_path / "case.h5") == "interrupted"


def test_a_finished_result_is_replaced_by_a_finished_one_only(tmp_path):
    write_case(tmp_path, nodes=41, cycles=1)
    assert run(tmp_path)[0] == COMPLETE
    whole = (tmp_path / "case.h5").read_bytes()
    write_case(tmp_path, nodes=61, cycles=40)
    code, output, _ = stop_when_under_way(tmp_path, signal.SIGINT, "case.partial.h5")
    assert code == INTERRUPTED and "result              case.partial.h5 (unfinished; --resume continues)" in output
    assert (tmp_path / "case.h5").read_bytes() == whole and outcome_of(tmp_path / "case.partial.h5") == "interrupted"
    code, _, errors = run(tmp_path, "--resume")
    assert code == COMPLETE and errors == "resuming from case.partial.h5: 1 of 2 steps done\n"
    assert not (tmp_path / "case.partial.h5").exists() and (tmp_path / "case.h5").read_bytes() != whole


def test_without_a_checkpoint_a_run_starts_from_step_1(tmp_path):
    write_case(tmp_path, nodes=41, cycles=1)
    code, _, errors = run(tmp_path, "--resume")
    assert code == COMPLETE and errors == "no checkpoint found; starting from step 1\n"
    code, output, errors = run(tmp_path, "--resume")
    assert code == COMPLETE and output == "" and errors == "case.h5 is complete; there is nothing to resume\n"


def test_a_run_goes_on_with_the_options_that_it_began_with(tmp_path):
    write_case(tmp_path, nodes=41, cycles=1)
    wrong = "; give the same options; run without --resume to start again from step 1\n"
    for options in ((), ("--accuracy", "1e-2"), ("--estimate", "--sensitivity")):
        assert run(tmp_path, *options)[0] == COMPLETE
        for others in ((), ("--accuracy", "1e-2"), ("--accuracy", "1e-3"), ("--estimate",), ("--estimate", "--sensitivity")):
            code, _, errors = run(tmp_path, "--resume", *others)
            if others == options:
                assert code == COMPLETE and errors == "case.h5 is complete; there is nothing to resume\n"
            else:
                assert code == INPUT and errors.startswith("case.h5: the result of a run with") and errors.endswith(wrong)
                assert " ".join(options or others).split()[0] in errors
    with h5py.File(tmp_path / "case.h5") as result:
        assert result.attrs["options"] == "--estimate --sensitivity"


def test_a_run_that_failed_is_not_called_complete(tmp_path):
    write_case(tmp_path, nodes=41, cycles=1)
    path = tmp_path / "case.nml"
    path.write_text(path.read_text().replace("tangential_force=2e-4", "tangential_force=2e-3"))
    assert run(tmp_path)[0] == 3 and outcome_of(tmp_path / "case.h5") == "gross sliding"
    code, output, errors = run(tmp_path, "--resume")
    assert code == INPUT and output == ""
    assert errors == (
        "case.h5: the run ended (gross sliding); nothing to resume; run without --resume to start again from step 1\n"
    )


@pytest.mark.parametrize(
    "damage, why",
    [
        ("text", "the text of the case file has changed"),
        ("version", "written by version 0.0.0"),
        ("numbers", "restart/numbers is damaged"),
        ("missing", "dataset restart/state_pressure is missing"),
        ("file", "case.h5 is not an HDF5 file"),
    ],
)
def test_a_checkpoint_that_cannot_be_used_is_refused(tmp_path, damage, why):
    write_case(tmp_path, cycles=3000)
    assert stop_when_under_way(tmp_path, signal.SIGTERM)[0] == INTERRUPTED
    if damage == "text":
        write_case(tmp_path, cycles=2999)
    elif damage == "file":
        (tmp_path / "case.h5").write_text("notes")
    else:
        with h5py.File(tmp_path / "case.h5", "r+") as result:
            if damage == "version":
                result.attrs["mfv_version"] = "0.0.0"
            elif damage == "numbers":
                result["restart/numbers"][17] += 1
            else:
                del result["restart/state_pressure"]
    before = (tmp_path / "case.h5").read_bytes()
    code, output, errors = run(tmp_path, "--resume")
    assert code == INPUT and output == ""
    if damage != "file":  # that is refused before
        assert why in errors and errors.endswith("run without --resume to start again from step 1\n")
    assert (tmp_path / "case.h5").read_bytes() == before


def test_a_checkpoint_that_cannot_be_written_does_not_end_the_run(tmp_path):
    write_case(tmp_path, nodes=61, cycles=5)
    assert run(tmp_path)[0] == COMPLETE
    (tmp_path / "case.partial.h5").write_text("notes")
    code, _, errors = run(tmp_path)
    assert code == COMPLETE and "checkpoint not written: case.partial.h5" in errors
    assert (tmp_path / "case.partial.h5").read_text() == "notes"
