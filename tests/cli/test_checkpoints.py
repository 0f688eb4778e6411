"""Runs that are interrupted or killed, and gone on with: they end with the same bits as the undisturbed run."""
import os
import random
import signal
import subprocess
import time
from pathlib import Path

import h5py
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
&output history='steps', states='steps', checkpoint_minutes=3e-4 /
"""
COULOMB = "law='coulomb', mu=0.5"
# A fifth of a second each on an idle machine.
RUNS = {
    "reduced": (COULOMB, 201, "linear_solver='reduced'", 15),
    "fft": (COULOMB, 61, "linear_solver='fft'", 2),
    "dahl": ("law='dahl', mu=0.5, stiffness=1e3", 41, "linear_solver='reduced'", 3),
    "conventional": (COULOMB, 61, "algorithm='conventional', load_step=0.01", 3),
}


def write_case(folder, friction=COULOMB, nodes=401, solver="linear_solver='auto'", cycles=30):
    (folder / "case.nml").write_text(TEXT.format(friction=friction, nodes=nodes, solver=solver, cycles=cycles))


def want_checkpoints_at_once(folder):
    path = folder / "case.nml"
    path.write_text(path.read_text().replace("checkpoint_minutes=3e-4", "checkpoint_minutes=1e-9"))


def start(folder, *options):
    return subprocess.Popen([PROGRAM, *options, "case.nml"], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def run(folder, *options):
    process = start(folder, *options)
    output, errors = process.communicate(timeout=300)
    return process.returncode, output, errors


def datasets(path):
    """Bytes of every dataset of a result, by name, and the attributes of the file."""
    found = {}
    with h5py.File(path) as result:
        result.visititems(lambda name, item: found.__setitem__(name, item[()].tobytes())
                          if isinstance(item, h5py.Dataset) else None)
        return found, dict(result.attrs)


def stop_after(folder, seconds, how, *options):
    """Start the case and stop it after so many seconds of a processor; its exit code, and what it said."""
    process = start(folder, *options)
    wait_for_work(process, seconds)
    if process.poll() is None:
        process.send_signal(how)
    output, errors = process.communicate(timeout=300)
    return process.returncode, output, errors


def stop_when_under_way(folder, how, name="case"):
    """Start the case and stop it when its first checkpoint is there; its exit code, and what it said."""
    process = start(folder)
    while not (folder / f"{name}.checkpoint").exists() and process.poll() is None:
        time.sleep(0.005)
    process.send_signal(how)
    output, errors = process.communicate(timeout=300)
    return process.returncode, output, errors


@pytest.mark.parametrize("name", RUNS)
def test_a_run_that_is_stopped_again_and_again(tmp_path, name):
    write_case(tmp_path, *RUNS[name])
    before = os.times()
    assert run(tmp_path)[0] == COMPLETE
    used = os.times().children_user + os.times().children_system - before.children_user - before.children_system
    seconds, stops = 0.5 * used, 0
    expected = datasets(tmp_path / "case.h5")
    (tmp_path / "case.h5").rename(tmp_path / "expected.h5")
    draw = random.Random(name)
    while True:
        how = draw.choice([signal.SIGKILL, signal.SIGKILL, signal.SIGINT, signal.SIGTERM])
        code, output, errors = stop_after(tmp_path, draw.uniform(0.5, 1.5) * seconds, how, "--resume")
        if code == COMPLETE and stops > 0:
            break
        if code == COMPLETE:  # faster than the undisturbed run: once more, and sooner
            (tmp_path / "case.h5").unlink()
            seconds *= 0.5
            continue
        stops += 1
        if code > 0:
            assert code == INTERRUPTED and "case.checkpoint keeps where the run is" in errors, errors
            with h5py.File(tmp_path / "case.h5") as result:
                outcome = result.attrs["outcome"]
            # Whole where an earlier run was killed between its result and the end of its checkpoint: a part does not replace it.
            assert outcome == "interrupted" or datasets(tmp_path / "case.h5") == expected
        else:
            assert code == -how, errors
        seconds *= 1.2  # to begin with it may be stopped before its first checkpoint
    assert datasets(tmp_path / "case.h5") == expected
    assert not (tmp_path / "case.checkpoint").exists()


def test_a_checkpoint_only_where_the_run_is_interrupted(tmp_path):
    write_case(tmp_path, cycles=3000)
    path = tmp_path / "case.nml"
    path.write_text(path.read_text().replace("checkpoint_minutes=3e-4", "checkpoint_minutes=0"))
    assert stop_after(tmp_path, 0.3, signal.SIGKILL)[0] == -signal.SIGKILL
    assert not (tmp_path / "case.checkpoint").exists()
    assert stop_after(tmp_path, 0.5, signal.SIGTERM)[0] == INTERRUPTED
    lines = (tmp_path / "case.checkpoint").read_bytes().split(b"\n")
    assert lines[0].startswith(b"MFV checkpoint of mfv ") and b"case.nml: 1 of 2 steps" in lines[1]


def test_a_part_of_a_run_does_not_replace_a_whole_result(tmp_path):
    write_case(tmp_path, nodes=41, cycles=1)
    assert run(tmp_path)[0] == COMPLETE
    whole = (tmp_path / "case.h5").read_bytes()
    write_case(tmp_path, cycles=3000)
    code, output, errors = stop_when_under_way(tmp_path, signal.SIGINT)
    assert code == INTERRUPTED and "case.checkpoint keeps where the run is" in errors
    assert "result              not written: case.h5 is whole, and stays as it was" in output
    assert (tmp_path / "case.h5").read_bytes() == whole


def test_without_a_checkpoint_a_run_begins_at_the_beginning(tmp_path):
    write_case(tmp_path, nodes=41, cycles=1)
    code, _, errors = run(tmp_path, "--resume")
    assert code == COMPLETE and errors == "there is no case.checkpoint: the case begins at the beginning\n"
    assert run(tmp_path)[2] == ""


@pytest.mark.parametrize("content, why", [
    (b"", "is no checkpoint"),
    (b"MFV checkpoint of mfv 0.0.0, layout 1", "is of another version"),
    (None, "is of another case"),
])
def test_a_checkpoint_that_cannot_be_used_is_refused(tmp_path, content, why):
    write_case(tmp_path, cycles=3000)
    assert stop_when_under_way(tmp_path, signal.SIGTERM)[0] == INTERRUPTED
    result = (tmp_path / "case.h5").read_bytes()
    if content is None:
        write_case(tmp_path, cycles=2999)
    else:
        (tmp_path / "case.checkpoint").write_bytes(content)
    code, output, errors = run(tmp_path, "--resume")
    assert code == INPUT and output == ""
    assert errors.startswith("case.checkpoint " + why) and errors.endswith("without --resume the case begins anew\n")
    assert (tmp_path / "case.h5").read_bytes() == result


def test_a_checkpoint_goes_with_a_complete_run(tmp_path):
    write_case(tmp_path, cycles=3000)
    assert stop_when_under_way(tmp_path, signal.SIGTERM)[0] == INTERRUPTED
    write_case(tmp_path, nodes=41, cycles=1)
    assert run(tmp_path)[0] == COMPLETE
    assert not (tmp_path / "case.checkpoint").exists()


@pytest.mark.parametrize("what", ["folder", "file"])
def test_a_checkpoint_that_cannot_be_written_does_not_end_the_run(tmp_path, what):
    write_case(tmp_path, nodes=61, cycles=5)
    want_checkpoints_at_once(tmp_path)
    path = tmp_path / "case.checkpoint"
    path.mkdir() if what == "folder" else path.write_text("notes")
    code, _, errors = run(tmp_path)
    assert code == COMPLETE and "no checkpoint: case.checkpoint" in errors
    assert path.is_dir() if what == "folder" else path.read_text() == "notes"


def test_results_with_other_extensions_have_checkpoints_of_their_own(tmp_path):
    write_case(tmp_path, cycles=3000)
    path = tmp_path / "case.nml"
    text = path.read_text()
    for name in ("mu0.3", "mu0.5", "x.checkpoint"):
        path.write_text(text.replace("&output", f"&output file='{name}',"))
        code, _, errors = stop_when_under_way(tmp_path, signal.SIGTERM, name)
        assert code == INTERRUPTED and errors.startswith(f"{name}.checkpoint keeps where the run is")
    assert sorted(file.name for file in tmp_path.iterdir()) == sorted(
        ["case.nml"] + [name + end for name in ("mu0.3", "mu0.5", "x.checkpoint") for end in ("", ".checkpoint")])


def test_a_pipe_is_no_checkpoint(tmp_path):
    write_case(tmp_path, nodes=41, cycles=1)
    want_checkpoints_at_once(tmp_path)
    os.mkfifo(tmp_path / "case.checkpoint")
    code, _, errors = run(tmp_path)
    assert code == COMPLETE and "no checkpoint: case.checkpoint is there and is no checkpoint" in errors
    code, _, errors = run(tmp_path, "--resume")
    assert code == INPUT and errors.startswith("case.checkpoint: cannot be read: it is no regular file")
