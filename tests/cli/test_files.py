"""The old file or the new one, whole, whatever happens: disks that fail, kills, places that cannot be written, two runs on one
file, outputs that nobody takes."""

import contextlib
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
from disk import CASE, CONVENTIONAL, RUN, STRESS, build_shim, go_on_with, parts, run, run_on_disk, wait_for_work

COMPLETE, INPUT, FILE = 0, 2, 4
NOBODY = 65534

#: Of every program that writes: its command, and what it writes.
PROGRAMS = {
    "mfv_run": ([RUN, "case.nml"], "case.h5"),
    "mfv_conventional": ([CONVENTIONAL, "case.nml"], "case_conventional.h5"),
    "mfv_stress": ([STRESS, "case.h5", "--points", "5", "4"], "case.h5"),
}
#: How many are killed at random moments; more for scripts/deep-check.sh.
KILLS = 50 if "MFV_DEEP" in os.environ else 10
#: Calls by which a file is replaced, in their order; after the last but one it has been replaced.
CALLS = ("write", "fsync", "rename", "folder")


@pytest.fixture(scope="session")
def shim(tmp_path_factory):
    return build_shim(tmp_path_factory.mktemp("shim"))


@pytest.fixture(scope="session")
def begun(tmp_path_factory):
    """A folder in which everything has been written once, with other numbers than it would have now."""
    folder = tmp_path_factory.mktemp("begun").resolve()
    (folder / "case.nml").write_text(CASE.format(mu=0.7))
    for command, _ in PROGRAMS.values():
        done = run(command, folder)
        assert done.returncode == COMPLETE, done.stderr
    assert run([STRESS, "case.h5", "--points", "6", "4"], folder).returncode == COMPLETE
    (folder / "case.nml").write_text(CASE.format(mu=0.5))
    return folder


@pytest.fixture
def folder(begun, tmp_path):
    shutil.copytree(begun, tmp_path, dirs_exist_ok=True)
    return tmp_path.resolve()


def numbers(path):
    """The content of a file, without what differs between runs."""
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


@pytest.mark.parametrize("program, number", [("mfv_run", errno.ENOSPC), ("mfv_conventional", errno.EIO), ("mfv_stress", errno.EIO)])
def test_calls_that_fail_are_errors_and_leave_the_old_file(program, number, shim, begun, folder):
    command, written = PROGRAMS[program]
    old = numbers(folder / written)
    assert run(command, folder).returncode == COMPLETE
    new = numbers(folder / written)
    for call in CALLS:
        restore(begun, folder)
        done = run_on_disk(shim, command, folder, call, number)
        assert done.returncode == FILE and os.strerror(number) in done.stderr, (call, done.stderr)
        assert (f"{written} is written, but may be lost in a power cut" in done.stderr) == (call == "folder"), (call, done.stderr)
        assert numbers(folder / written) == (new if call == "folder" else old) and parts(folder) == [], call


@pytest.mark.parametrize("program", PROGRAMS)
def test_kills_leave_the_old_file_or_the_new_one(program, shim, begun, folder):
    command, written = PROGRAMS[program]
    old = numbers(folder / written)
    assert run(command, folder).returncode == COMPLETE
    new = numbers(folder / written)
    assert new != old
    for call in CALLS:
        restore(begun, folder)
        assert run_on_disk(shim, command, folder, call).returncode == -signal.SIGKILL
        assert numbers(folder / written) == (new if call == "folder" else old), call
        assert run(command, folder).returncode == COMPLETE and numbers(folder / written) == new


def test_checkpoints_survive_kills(shim, begun, folder):
    """A checkpoint at every segment: after a kill --resume ends with the result of the run that nobody killed."""
    text = CASE.format(mu=0.5).replace("file='case.h5'", "file='case.h5', checkpoint_minutes=1e-9")
    command = [RUN, "often.nml"]
    checkpoint = folder / "case.partial.h5"

    def begin():
        restore(begun, folder)
        (folder / "often.nml").write_text(text)

    old = numbers(folder / "case.h5")
    begin()
    assert run(command, folder).returncode == COMPLETE and not checkpoint.exists()
    new = numbers(folder / "case.h5")
    for call in CALLS:
        begin()
        assert run_on_disk(shim, command, folder, call).returncode == -signal.SIGKILL
        assert checkpoint.exists() == (call == "folder") and numbers(folder / "case.h5") == old
    done = run([RUN, "--resume", "often.nml"], folder)
    assert done.returncode == COMPLETE and not checkpoint.exists(), done.stderr
    assert numbers(folder / "case.h5") == new


@pytest.mark.parametrize("program", ("mfv_run", "mfv_stress"))
def test_kills_at_random_moments_leave_the_old_file_or_the_new_one(program, begun, folder):
    """Half of them in the time in which the program writes, the last tenth."""
    command, written = PROGRAMS[program]
    old = numbers(folder / written)
    started = time.monotonic()
    assert run(command, folder).returncode == COMPLETE
    length = time.monotonic() - started
    new = numbers(folder / written)
    assert new != old
    moments = random.Random(8)
    killed, seen = 0, []
    for kill in range(KILLS):
        restore(begun, folder)
        process = subprocess.Popen(command, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        started = time.monotonic()
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(length * (moments.uniform(0.0, 1.0) if kill % 2 else moments.uniform(0.9, 1.1)))
            length = min(length, time.monotonic() - started)  # the machine is faster now
        process.kill()
        killed += process.wait() == -signal.SIGKILL
        found = numbers(folder / written)
        assert found in (old, new)
        seen.append(found == new)
    assert killed > 0 and not all(seen), (killed, seen)
    assert run(command, folder).returncode == COMPLETE
    assert numbers(folder / written) == new


def limit_files(length):
    """To be called in a child: files grow no further; the signal of that is as a shell leaves it."""

    def act():
        resource.setrlimit(resource.RLIMIT_FSIZE, (length, length))
        signal.signal(signal.SIGXFSZ, signal.SIG_DFL)

    return act


@pytest.mark.parametrize("program", PROGRAMS)
def test_a_limit_of_file_size_is_an_error_and_no_signal(program, folder):
    command, written = PROGRAMS[program]
    old = numbers(folder / written)
    for length in (0, 5000):
        done = run(command, folder, preexec_fn=limit_files(length))
        assert done.returncode == FILE, (done.returncode, done.stderr)
        assert "cannot be written: File too large" in done.stderr
        assert numbers(folder / written) == old and parts(folder) == []


def test_the_library_gives_the_error_to_a_host(folder):
    """In Python, which ignores the signal of a limit; HDF5 in this process still works afterwards."""
    host = """
import resource, mfv, mfv.errors
scene = mfv.Scene(mfv.Body.half_plane(shear_modulus=1.0, poisson_ratio=0.3), mfv.Body.disk(0.25, rigid=True),
                  mesh=mfv.Mesh(nodes=21, half_width=0.0127), steps=[mfv.Step(normal_force=1e-3)])
case = mfv.Case(scene)
case.run()
soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
resource.setrlimit(resource.RLIMIT_FSIZE, (5000, hard))
try:
    case.write("case.h5")
except mfv.errors.FileError as error:
    print(error)
resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
case.write("other.h5")
"""
    old = numbers(folder / "case.h5")
    done = run([sys.executable, "-c", host], folder)
    assert done.returncode == COMPLETE, done.stderr
    assert "case.h5 cannot be written: File too large" in done.stdout and parts(folder) == []
    assert numbers(folder / "case.h5") == old and numbers(folder / "other.h5")


@pytest.mark.parametrize(
    "command",
    [[RUN, "case.nml"], [RUN, "--help"], [RUN, "--keys"], [RUN, "--version"], [RUN, "--check", "case.nml"], [STRESS, "case.h5"]],
    ids=lambda command: " ".join([Path(command[0]).name, *command[1:]]),
)
def test_output_that_cannot_be_printed_is_an_error(command, folder):
    with open("/dev/full", "w") as full:
        done = subprocess.run(command, cwd=folder, stdout=full, stderr=subprocess.PIPE, text=True, timeout=300)
    assert done.returncode == FILE
    assert done.stderr == "cannot write to standard output: No space left on device\n"
    closed = subprocess.run(command, cwd=folder, preexec_fn=lambda: os.close(1), stderr=subprocess.PIPE, text=True, timeout=300)
    assert closed.returncode == FILE and "cannot write to standard output: Bad file descriptor" in closed.stderr
    assert all(numbers(path) for path in folder.glob("*.h5"))  # the summary has not gone into a file


def test_closed_errors_and_pipes_closed_early_do_no_harm(folder):
    new = "mu=0.5"
    for command in (f"{RUN} case.nml | head -n 1", f"{RUN} case.nml 2>&-", f"{RUN} case.nml <&- >&- 2>&-"):
        (folder / "case.h5").unlink()
        run(["sh", "-c", command], folder)
        with h5py.File(folder / "case.h5") as result:
            assert new in result.attrs["input"] and result.attrs["outcome"] == "complete"
    ignored = run(["sh", "-c", f"trap '' PIPE; {{ sleep 0.5; {RUN} case.nml; echo $? >code; }} | true"], folder)
    assert (folder / "code").read_text() == f"{FILE}\n" and "cannot write to standard output: Broken pipe" in ignored.stderr


@pytest.fixture
def open_folder():
    """A folder that another user than root can get to."""
    with tempfile.TemporaryDirectory() as name:
        os.chmod(name, 0o777)
        (Path(name) / "case.nml").write_text(CASE.format(mu=0.5))
        yield Path(name).resolve()


def as_nobody():
    if os.getuid() == 0:
        os.setgid(NOBODY)
        os.setuid(NOBODY)


def test_places_that_may_not_be_written(open_folder):
    folder = open_folder
    probe = subprocess.run(["sh", "-c", f"{RUN} --version"], cwd=folder, preexec_fn=as_nobody, capture_output=True)
    if probe.returncode != COMPLETE:
        pytest.skip("another user cannot get to the programs")
    assert run([RUN, "case.nml"], folder).returncode == COMPLETE
    old = (folder / "case.h5").read_bytes()
    os.chmod(folder / "case.h5", 0o444)
    done = run([RUN, "case.nml"], folder, preexec_fn=as_nobody)  # a file that may not be written, in a folder that may
    assert done.returncode == INPUT and "case.h5 cannot be written: Permission denied" in done.stderr
    done = run([STRESS, "case.h5"], folder, preexec_fn=as_nobody)
    assert done.returncode == FILE and "case.h5 cannot be written: Permission denied" in done.stderr
    os.chmod(folder / "case.h5", 0o666)
    os.chmod(folder, 0o555)  # and the other way round
    done = run([RUN, "case.nml"], folder, preexec_fn=as_nobody)
    assert done.returncode == INPUT and "case.h5 cannot be written: Permission denied" in done.stderr
    os.chmod(folder, 0o777)
    assert (folder / "case.h5").read_bytes() == old and parts(folder) == []
    assert run([RUN, "case.nml"], folder, preexec_fn=as_nobody).returncode == COMPLETE


@pytest.mark.parametrize(
    "name, why",
    [
        ("x" * 300, "cannot be written: File name too long"),
        ("no/such/folder.h5", "cannot be written: No such file or directory"),
        ("case.nml/x.h5", "cannot be written: Not a directory"),
        ("folder", "cannot be written: Is a directory"),
        ("/dev/full", "cannot be written: it is not a regular file"),
        ("/dev/null", "cannot be written: it is not a regular file"),
        ("round.h5", "cannot be written: Too many levels of symbolic links"),
        ("case.nml", "exists and is not an HDF5 file; not overwritten"),
        ("other.h5", "exists and is not a result of MFV (no attribute outcome); not overwritten"),
        ("broken.h5", "exists and cannot be read: it is damaged, or another program has it open for writing; not overwritten"),
    ],
)
def test_places_that_are_no_place_for_a_result(name, why, folder):
    (folder / "round.h5").symlink_to("round.h5")
    (folder / "folder").mkdir()
    whole = (folder / "case.h5").read_bytes()
    (folder / "broken.h5").write_bytes(whole[: len(whole) // 2])
    h5py.File(folder / "other.h5", "w").close()
    before = {path: path.read_bytes() for path in folder.glob("*") if path.is_file()}
    (folder / "bad.nml").write_text(CASE.format(mu=0.5).replace("case.h5", name))
    done = run([RUN, "bad.nml"], folder)
    assert done.returncode == INPUT and f"bad.nml: &output file='{name}': {name} {why}" in done.stderr
    (folder / "bad.nml").unlink()
    assert {path: path.read_bytes() for path in folder.glob("*") if path.is_file()} == before


@pytest.mark.parametrize(
    "name",
    [
        "with blanks in it.h5",
        "Gr\N{LATIN SMALL LETTER O WITH DIAERESIS}\N{LATIN SMALL LETTER SHARP S}e \N{GREEK SMALL LETTER MU}.h5",
        "x" * 240,
        "trailing blank .h5",
    ],
)
def test_unusual_names(name, folder):
    (folder / "case.nml").write_text(CASE.format(mu=0.5).replace("case.h5", name))
    done = run([RUN, "case.nml"], folder)
    assert done.returncode == COMPLETE and done.stdout.endswith(f"result              {name}\n"), done.stderr
    done = run([STRESS, name, "--points", "5", "4"], folder)
    assert done.returncode == COMPLETE, done.stderr
    assert "stress/last/lower/von_mises" in numbers(folder / name) or h5py.File(folder / name)["stress"]


def test_links_stay_links_and_modes_stay_modes(folder):
    (folder / "there").mkdir()
    (folder / "case.h5").rename(folder / "there/real.h5")
    (folder / "case.h5").symlink_to("there/real.h5")
    os.chmod(folder / "there/real.h5", 0o640)
    for command in ([RUN, "case.nml"], [STRESS, "case.h5", "--points", "5", "4"]):
        assert run(command, folder).returncode == COMPLETE
        assert (folder / "case.h5").is_symlink() and (folder / "there/real.h5").stat().st_mode & 0o7777 == 0o640
    assert "stress" in h5py.File(folder / "there/real.h5")
    os.umask(mask := os.umask(0o022))
    (folder / "there/real.h5").unlink()
    (folder / "case.h5").unlink()
    assert run([RUN, "case.nml"], folder).returncode == COMPLETE
    assert (folder / "case.h5").stat().st_mode & 0o7777 == 0o666 & ~mask


def test_runs_at_once_leave_one_of_the_whole_files(folder):
    cases = {f"{mu}.nml": CASE.format(mu=mu) for mu in (0.4, 0.45, 0.55, 0.6)}
    whole = []
    for name, text in cases.items():
        (folder / name).write_text(text)
        assert run([RUN, name], folder).returncode == COMPLETE
        whole.append(numbers(folder / "case.h5"))
    for _ in range(2):
        processes = [subprocess.Popen([RUN, name], cwd=folder, stdout=subprocess.DEVNULL) for name in cases]
        while any(process.poll() is None for process in processes):
            assert numbers(folder / "case.h5") in whole  # read at any moment
        assert [process.returncode for process in processes] == [COMPLETE] * 4
        assert numbers(folder / "case.h5") in whole and parts(folder) == []


def test_threads_of_one_process_at_once_leave_one_of_the_whole_files(folder):
    """Four cases that write the same file twenty times; not where HDF5 is built without locks for threads."""
    host = """
import threading, mfv
def write(mu):
    scene = mfv.Scene(mfv.Body.half_plane(shear_modulus=1.0, poisson_ratio=0.3), mfv.Body.disk(0.25, rigid=True),
                      mesh=mfv.Mesh(nodes=21, half_width=0.0127), friction=mfv.Friction.coulomb(mu),
                      steps=[mfv.Step(normal_force=1e-3), mfv.Step(tangential_force=2e-4)])
    case = mfv.Case(scene)
    case.run()
    for _ in range(20):
        case.write("case.h5")
    written.append(mu)
written = []
threads = [threading.Thread(target=write, args=(mu,)) for mu in (0.4, 0.45, 0.55, 0.6)]
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()
assert len(written) == 4
"""
    done = run([sys.executable, "-c", host], folder)
    assert done.returncode == COMPLETE, done.stderr
    with h5py.File(folder / "case.h5") as result:
        assert result.attrs["outcome"] == "complete" and abs(result["summary/tangential_force"][()] - 2e-4) < 1e-15
    assert parts(folder) == []


def test_a_reader_keeps_what_it_has_opened(folder):
    with h5py.File(folder / "case.h5") as old:
        before = old["state/shear"][:]
        for command in ([RUN, "case.nml"], [STRESS, "case.h5", "--points", "5", "4"]):
            assert run(command, folder).returncode == COMPLETE
        np.testing.assert_array_equal(old["state/shear"][:], before)
        assert "stress" in old and "mu=0.7" in old.attrs["input"]
    with h5py.File(folder / "case.h5") as new:
        assert "mu=0.5" in new.attrs["input"] and not np.array_equal(new["state/shear"][:], before)
    with h5py.File(folder / "case.h5", "r+"):  # somebody writes: HDF5's own lock is minded
        done = run([RUN, "case.nml"], folder)
        assert done.returncode == INPUT and "another program has it open for writing" in done.stderr


def test_stresses_do_not_go_into_another_result(shim, folder):
    """A result that takes the place of the one that the stresses are of, while they are computed."""
    process = subprocess.Popen([STRESS, "case.h5", "--points", "1000", "600"], cwd=folder, stderr=subprocess.PIPE, text=True)
    wait_for_work(process, 0.2)
    assert process.poll() is None
    process.send_signal(signal.SIGSTOP)
    assert run([RUN, "case.nml"], folder).returncode == COMPLETE
    new = numbers(folder / "case.h5")
    _, errors = go_on_with(process, signal.SIGCONT)
    assert process.returncode == FILE
    assert "case.h5 cannot be written: another process has replaced it in the meantime; run again" in errors
    assert numbers(folder / "case.h5") == new and not any(name.startswith("stress") for name in new) and parts(folder) == []


def test_a_small_disk(folder):
    """A file system of 1 MB, where one can be had."""
    place = folder / "small"
    place.mkdir()
    if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=1M", "tmpfs", place], capture_output=True).returncode != 0:
        pytest.skip("no file system can be mounted here")
    try:
        (place / "case.nml").write_text(CASE.format(mu=0.5))
        assert run([RUN, "case.nml"], place).returncode == COMPLETE
        old = (place / "case.h5").read_bytes()
        (place / "large").write_bytes(bytes(4096 * (os.statvfs(place).f_bavail - 2)))
        done = run([RUN, "case.nml"], place)
        assert done.returncode == FILE and "case.h5 cannot be written: No space left on device" in done.stderr
        assert (place / "case.h5").read_bytes() == old and parts(place) == []
    finally:
        subprocess.run(["umount", place], check=True)
