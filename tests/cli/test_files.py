"""The old file or the new one, whole, whatever happens: disks that fail at any call, kills at any call and at random, power
cuts, places that cannot be written, two runs on one file, outputs that nobody takes."""

import errno
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import h5py
import numpy as np
import pytest

from disk import CASE, CONVENTIONAL, RUN, STRESS, STUDY, SWEEP, build_shim, parts, run, run_on_disk

COMPLETE, INPUT, FILE = 0, 2, 4
NOBODY = 65534

#: Of every program that writes: its command, and what it writes.
PROGRAMS = {
    "mfv_run": ([RUN, "case.nml"], "case.h5"),
    "mfv_conventional": ([CONVENTIONAL, "case.nml"], "case_conventional.h5"),
    "mfv_stress": ([STRESS, "case.h5", "--points", "5", "4"], "case.h5"),
    "mfv_sweep": ([SWEEP, "--again", "study.nml"], "study.h5"),
}
#: Commands of Python, which take longer to begin; tests/pages has their failures.
COMMANDS = {
    "new": ([sys.executable, "-m", "mfv", "new", "matrix", "--force", "-o", "matrix.nml"], "matrix.h5"),
    "table": ([sys.executable, "-m", "mfv", "table", "study.h5", "--csv", "study.csv"], "study.csv"),
}
WRITERS = PROGRAMS | COMMANDS


@pytest.fixture(scope="session")
def shim(tmp_path_factory):
    return build_shim(tmp_path_factory.mktemp("shim"))


@pytest.fixture(scope="session")
def begun(tmp_path_factory):
    """A folder in which everything has been written once, from a case that was another then."""
    folder = tmp_path_factory.mktemp("begun").resolve()
    (folder / "study.nml").write_text(STUDY)
    (folder / "case.nml").write_text(CASE.format(mu=0.7))
    for command, _ in WRITERS.values():
        done = run(command, folder)
        assert done.returncode == COMPLETE, done.stderr
    (folder / "case.nml").write_text(CASE.format(mu=0.5))
    return folder


@pytest.fixture
def folder(begun, tmp_path):
    shutil.copytree(begun, tmp_path, dirs_exist_ok=True)
    return tmp_path.resolve()


def numbers(path):
    """What is in a file, to the bit; without what is the same in no two runs."""
    if path.suffix != ".h5":
        return {"bytes": path.read_bytes()}
    found = {}
    with h5py.File(path) as file:
        file.visititems(lambda name, item: found.update({name: item[()].tobytes()}) if isinstance(item, h5py.Dataset) else None)
    assert found
    return found


def restore(begun, folder):
    """The folder as it was begun: all files, and no others."""
    for path in folder.iterdir():
        shutil.rmtree(path) if path.is_dir() else path.unlink()
    shutil.copytree(begun, folder, dirs_exist_ok=True)


@pytest.mark.parametrize("program", WRITERS)
def test_files_are_on_the_disk_before_they_have_their_names(program, shim, folder):
    command, written = WRITERS[program]
    done, calls = run_on_disk(shim, command, folder)
    assert done.returncode == COMPLETE, done.stderr
    renamed = [call for call in calls if call[0] == "rename"]
    assert str(folder / written) in [call[2] for call in renamed]
    for what, path, target in renamed:
        place = calls.index([what, path, target])
        last_write = max(i for i, call in enumerate(calls[:place]) if call[:2] in (["write", path], ["ftruncate", path]))
        assert ["fsync", path] in calls[last_write:place], calls
        after = [call[1].rstrip("/") for call in calls[place:] if call[0] == "fsync"]
        assert str(Path(target).parent) in after, calls
    for call in calls:
        if call[0] in ("open", "write"):
            assert ".part" in call[1] or call[1].endswith(".journal"), calls
    assert parts(folder) == []


@pytest.mark.parametrize("program", PROGRAMS)
@pytest.mark.parametrize("number, stays", [(errno.ENOSPC, True), (errno.EIO, False)], ids=["disk full", "one error"])
def test_every_call_that_fails_is_told_and_leaves_the_old_file(program, number, stays, shim, begun, folder):
    command, written = PROGRAMS[program]
    old = numbers(folder / written)
    new_done, calls = run_on_disk(shim, command, folder)
    new = numbers(folder / written)
    counted = [call for call in calls if call[0] != "unlink"]
    assert new_done.returncode == COMPLETE and len(counted) >= 5
    for at in range(1, len(counted) + 1):
        restore(begun, folder)
        done, calls = run_on_disk(shim, command, folder, at, number, stays)
        failed = [call for call in calls if call[0] != "unlink"][at - 1]
        where = (at, failed, done.stderr)
        assert done.returncode in (COMPLETE, INPUT, FILE), where
        assert parts(folder) == [], where
        found = numbers(folder / written)
        if done.returncode == COMPLETE:
            assert failed[0] in ("close", "fsync") and found == new, where  # the trial of the place, or a file of another process
            continue
        # The first is the trial of the place, before anything is computed.
        assert done.returncode == (INPUT if at == 1 and program != "mfv_stress" else FILE), where
        assert os.strerror(number) in done.stderr or "journal" in done.stderr, where
        assert found == (new if "power cut" in done.stderr else old), where


@pytest.mark.parametrize("program", PROGRAMS)
def test_kills_at_every_call_leave_the_old_file_or_the_new_one(program, shim, begun, folder):
    command, written = PROGRAMS[program]
    old = numbers(folder / written)
    _, calls = run_on_disk(shim, command, folder)
    new = numbers(folder / written)
    counted = [call for call in calls if call[0] != "unlink"]
    renamed = max(i for i, call in enumerate(counted, 1) if call[0] == "rename" and call[2] == str(folder / written))
    for at in range(1, len(counted) + 1):
        restore(begun, folder)
        done, _ = run_on_disk(shim, command, folder, at)
        assert done.returncode == -signal.SIGKILL
        assert numbers(folder / written) == (old if at <= renamed else new), (at, counted[at - 1])
    again = [word for word in command if word != "--again"]
    assert run(again, folder).returncode == COMPLETE and numbers(folder / written) == new
