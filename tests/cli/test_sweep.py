"""mfv_sweep as a user runs it: tables, threads and ranks, journals that survive kill -9, parts, messages and exit codes."""
import csv
import hashlib
import os
import random
import re
import shutil
import signal
import struct
import subprocess
import sys
import time
from pathlib import Path

import h5py
import numpy as np
import pandas  # xarray brings it
import pytest

import mfv
from disk import build_shim, go_on_with, run_on_disk, start_until
from terminal import shown_on_a_terminal

ROOT = Path(__file__).resolve().parents[2]
MFV_RUN = os.environ.get("MFV_RUN", str(ROOT / "build/release/bin/mfv_run"))
MFV_SWEEP = os.environ.get("MFV_SWEEP", str(Path(MFV_RUN).with_name("mfv_sweep")))
COMPLETE, INPUT, FILE, INTERRUPTED = 0, 2, 4, 130

BASE = """! a small case of Mindlin's problem
&scene coupling='goodman', length_unit='mm', force_unit='N' /
&body shape='half_plane', shear_modulus=1.0, poisson_ratio=0.3 /
&body shape='disk', radius=0.25, rigid=.true. /
&mesh nodes={nodes}, half_width=0.01225 /
&friction law='coulomb', mu=0.7 /
&step normal_force=1.0e-3, friction=.false. /
&step tangential_force=2.8e-4 /
&step tangential_force=-2.8e-4, cycles={cycles} /
"""
STUDY = """&sweep base='base.nml', reference='full' /
&vary key='friction%mu', values=0.3, 0.7 /
&vary key='step(2)%tangential_force', 'step(3)%tangential_force', factor=1, -1, from=1e-4, to=4e-4, count=3, spacing='log', name='Q' /
&vary key='scene%coupling', values='full', 'goodman', 'none' /
"""
CASES = 18

AS_ROOT = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OPENBLAS_NUM_THREADS": "1"}
HAS_MPI = "with MPI" in subprocess.run([MFV_SWEEP, "--version"], capture_output=True, text=True).stdout
OPEN_MPI = shutil.which("mpirun") and "Open MPI" in subprocess.run(["mpirun", "--version"], capture_output=True, text=True).stdout
needs_mpi = pytest.mark.skipif(not (HAS_MPI and OPEN_MPI), reason="built without MPI, or no mpirun of Open MPI")


def mfv_sweep(*arguments, cwd, launcher=()):
    return subprocess.run([*launcher, MFV_SWEEP, *map(str, arguments)], cwd=cwd, capture_output=True, text=True, timeout=300,
                          env=os.environ | AS_ROOT)


def ranks(number):
    return ["mpirun", "--oversubscribe", "-n", str(number)]


def start(*arguments, cwd, launcher=()):
    return subprocess.Popen([*launcher, MFV_SWEEP, *map(str, arguments)], cwd=cwd, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                            text=True, env=os.environ | AS_ROOT, start_new_session=True)


def write(folder, study=STUDY, nodes=21, cycles=1):
    (folder / "base.nml").write_text(BASE.format(nodes=nodes, cycles=cycles))
    (folder / "study.nml").write_text(study)


def long_study(folder, count=60, nodes=51):
    """Cases enough to be caught at work."""
    write(folder, "&sweep base='base.nml' /\n"
          f"&vary key='friction%mu', from=0.4, to=1.0, count={count} /\n&vary key='scene%coupling', values='full', 'none' /\n",
          nodes=nodes, cycles=4)
    return 2 * count


def digest(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


def unchanging(path):
    """What stays as it is as long as nobody writes a file."""
    status = path.stat()
    return status.st_ino, status.st_mtime_ns, status.st_size


def numbers_in(journal):
    """Numbers of the cases in the whole records of a journal, in order."""
    data = journal.read_bytes()
    assert data.startswith(b"mfv_sweep journal 1 ")
    at, numbers = data.index(b"\n") + 1, []
    while at + 4 <= len(data):
        (length,) = struct.unpack_from("<i", data, at)
        if at + 4 + length + 8 > len(data):
            break
        numbers.append(struct.unpack_from("<i", data, at + 4)[0])
        at += 4 + length + 8
    return numbers


def wait_for_records(journal, number, run):
    """Wait until a journal has some records; false where the run ended first."""
    while run.poll() is None:
        if journal.exists() and len(journal.read_bytes()) > 37 and len(numbers_in(journal)) >= number:
            return True
        time.sleep(0.002)
    return False


@pytest.fixture(scope="module")
def shim(tmp_path_factory):
    return build_shim(tmp_path_factory.mktemp("shim"))


def start_until_records(shim, number, *arguments, cwd):
    """Start a sweep that stops when its journal has `number` more records, or up to twice as many, whatever the machine's speed."""
    calls_before_the_first_record = 8
    return start_until(shim, [MFV_SWEEP, *arguments], cwd, calls_before_the_first_record + 2 * number)


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    """The small study, solved by one thread."""
    folder = tmp_path_factory.mktemp("study")
    write(folder)
    run = mfv_sweep("--threads", 1, "study.nml", cwd=folder)
    assert run.returncode == COMPLETE and run.stderr == ""
    return folder


def test_rows_are_what_mfv_run_gives(study, tmp_path):
    table = mfv.read_table(study / "study.h5")
    assert list(table["case"]) == list(range(1, CASES + 1))
    for number in (1, 8, 11, 18):
        text = mfv_sweep("--case", number, study / "study.nml", cwd=tmp_path).stdout
        (tmp_path / "case.nml").write_text(text)
        subprocess.run([MFV_RUN, "case.nml"], cwd=tmp_path, capture_output=True)
        row = table[number - 1]
        with h5py.File(tmp_path / "case.h5") as result:
            assert row["outcome"] == result.attrs["outcome"]
            assert row["message"] == result.attrs["message"].replace("case.nml:", "base.nml:")
            for name in ("events", "linear_solves", "largest_residual"):
                assert row[name] == result["summary"][name][()], name
            assert row["nodes"] == result["mesh/x"].size
            for name, value in result["observables"].items():
                np.testing.assert_array_equal(row[name], value[()], err_msg=name)
                assert table.units[name] == value.attrs["units"]
                assert table.long_names[name] == value.attrs["long_name"]


def test_combinations_in_order(study):
    table = mfv.read_table(study / "study.h5")
    assert list(table["scene%coupling"][:4]) == ["full", "goodman", "none", "full"]
    np.testing.assert_array_equal(table["friction%mu"], np.repeat([0.3, 0.7], 9))
    np.testing.assert_allclose(table["Q"][:9:3], [1e-4, 2e-4, 4e-4], rtol=1e-15)
    assert table["Q"][6] == 4e-4
    assert set(table["base"]) == {"base.nml"}
    assert table.units["Q"] == "N/mm" and table.units["cycle_dissipation"] == "N" and table.units["friction%mu"] == "1"


def test_file_explains_itself(study):
    with h5py.File(study / "study.h5") as file:
        assert file.attrs["input"] == STUDY and file.attrs["base_1"] == BASE.format(nodes=21, cycles=1)
        assert file.attrs["complete"] == 1 and file.attrs["cases"] == CASES
        assert file.attrs["cases_complete"] + file.attrs["cases_gross_sliding"] == CASES
        assert file.attrs["mfv_version"] == (ROOT / "VERSION").read_text().strip()
        dataset = file["table"]
        assert tuple(dataset.attrs["columns"]) == dataset.dtype.names
        assert all(dataset.attrs["units"]) and all(dataset.attrs["long_names"])
        assert h5py.check_string_dtype(dataset.dtype["outcome"]).encoding == "utf-8"
        words = " ".join(str(value) for value in file.attrs.values())
        assert str(study) not in words and os.uname().nodename not in words


def test_early_ends_are_rows(study):
    table = mfv.read_table(study / "study.h5")
    early = table[table["status"] != 0]
    assert len(early) == 3 and set(early["outcome"]) == {"gross sliding"} and set(early["Q"]) == {4e-4}
    assert all(early["steps_done"] == 1) and all(np.isnan(early["cycle_dissipation"]))
    assert "base.nml: &step 2 tangential_force=4e-4 not reached" in early["message"][0]
    np.testing.assert_allclose(early["tangential_force"], 3e-4, rtol=1e-9)


def test_reference_is_full_coupling(study):
    table = mfv.read_table(study / "study.h5")
    for name in table.columns:
        if "_error_" in name:
            full = table["scene%coupling"] == "full"
            there = table["status"] == 0
            assert all(table[name][full & there] == 0)
            assert all(table[name][~full & there] > 0) and all(table[name][there] < 1)
    dissipation = table["cycle_dissipation"].reshape(-1, 3)
    np.testing.assert_array_equal(table["dissipation_ratio"].reshape(-1, 3), dissipation / dissipation[:, :1])
    # Eq. 6.6 by hand, from the whole results of two cases.
    states = []
    for number in (1, 2):
        text = mfv_sweep("--case", number, study / "study.nml", cwd=study).stdout
        (study / f"state{number}.nml").write_text(text)
        subprocess.run([MFV_RUN, f"state{number}.nml"], cwd=study, capture_output=True)
        with h5py.File(study / f"state{number}.h5") as result:
            states.append([result["steps/0002"][name][:] for name in ("pressure", "shear")])
    for full, goodman, name in zip(*states, ("pressure", "shear")):
        np.testing.assert_allclose(table[f"{name}_error_loading"][1], abs(goodman - full).sum() / abs(full).sum(), rtol=1e-12)


def crc64(data):
    """The checksum of the program xz, bit by bit."""
    rest = (1 << 64) - 1
    for byte in data:
        rest ^= byte
        for _ in range(8):
            rest = rest >> 1 ^ (0xC96C5795D7870F42 if rest & 1 else 0)
    return rest ^ (1 << 64) - 1


def change_observable(journal, number, place, value):
    """Another value of an observable of a case in a journal."""
    assert crc64(b"123456789") == 0x995DC9BBDF1939FA
    data = bytearray(journal.read_bytes())
    at = data.index(b"\n") + 1
    while struct.unpack_from("<i", data, at + 4)[0] != number:
        at += 4 + struct.unpack_from("<i", data, at)[0] + 8
    (length,) = struct.unpack_from("<i", data, at)
    struct.pack_into("<d", data, at + 4 + 8 * 4 + 8 + 8 * place, value)
    struct.pack_into("<Q", data, at + 4 + length, crc64(data[at:at + 4 + length]))
    journal.write_bytes(data)


@pytest.mark.parametrize("number, cycles, others", [(2, 5.0, []), (2, np.nan, []), (1, 5.0, [2, 3])])
def test_no_comparison_of_other_cycles(number, cycles, others, study, tmp_path):
    write(tmp_path)
    assert mfv_sweep("--part", "1/1", "study.nml", cwd=tmp_path).returncode == COMPLETE
    before = mfv.read_table(study / "study.h5")
    assert before["cycles"][0] == before["cycles"][1] == 1
    columns = list(before.columns)
    change_observable(tmp_path / "study.h5.part-1-of-1.journal", number,
                      columns.index("cycles") - columns.index("largest_residual") - 1, cycles)
    assert mfv_sweep("study.nml", cwd=tmp_path).stdout.startswith(f"{CASES} of {CASES} cases were there")
    table = mfv.read_table(tmp_path / "study.h5")
    np.testing.assert_equal(table["cycles"][number - 1], cycles)
    compared = ["dissipation_ratio"] + [f"{field}_error_{moment}" for field in ("pressure", "shear")
                                        for moment in ("loading", "reversal", "return")]
    other = np.isin(table["case"], others or [number])
    for name in compared:
        if name.endswith("loading"):
            np.testing.assert_array_equal(table[name], before[name])
        else:
            assert all(np.isnan(table[name][other])) and not any(np.isnan(before[name][other])), name
            np.testing.assert_array_equal(table[name][~other], before[name][~other])


def test_same_bytes_by_threads_and_at_another_time(study, tmp_path):
    write(tmp_path)
    time.sleep(1.1)  # HDF5 would keep the time in seconds
    for threads in (2, 5):
        assert mfv_sweep("--again", "--threads", threads, "study.nml", cwd=tmp_path).returncode == COMPLETE
        assert digest(tmp_path / "study.h5") == digest(study / "study.h5")
    assert mfv_sweep("--again", tmp_path / "study.nml", cwd=tmp_path).returncode == COMPLETE
    assert digest(tmp_path / "study.h5") == digest(study / "study.h5")


@needs_mpi
def test_same_bytes_by_ranks(study, tmp_path):
    write(tmp_path)
    for number, threads in ((3, 1), (2, 2)):
        run = mfv_sweep("--again", "--threads", threads, "study.nml", cwd=tmp_path, launcher=ranks(number))
        assert run.returncode == COMPLETE, run.stderr
        assert digest(tmp_path / "study.h5") == digest(study / "study.h5")


@needs_mpi
def test_ranks_killed_and_continued(tmp_path):
    cases = long_study(tmp_path)
    undisturbed = tmp_path / "undisturbed"
    undisturbed.mkdir()
    assert mfv_sweep("../study.nml", cwd=undisturbed).returncode == COMPLETE
    run = start("study.nml", cwd=tmp_path, launcher=ranks(3))
    assert wait_for_records(tmp_path / "study.h5.journal", 10, run)
    for process in Path("/proc").glob("[0-9]*"):  # of the processes that mpirun has started here
        try:
            if (process / "exe").resolve() == Path(MFV_SWEEP).resolve() and (process / "cwd").resolve() == tmp_path.resolve():
                os.kill(int(process.name), signal.SIGKILL)
        except (OSError, PermissionError):
            pass
    run.communicate(timeout=60)
    assert not (tmp_path / "study.h5").exists()
    run = mfv_sweep("study.nml", cwd=tmp_path, launcher=ranks(2))
    assert run.returncode == COMPLETE and re.match(rf"\d+ of {cases} cases were there", run.stdout), run.stdout + run.stderr
    assert digest(tmp_path / "study.h5") == digest(undisturbed / "study.h5")


def without_place_for_states(folder):
    """A sweep whose whole results cannot be written: there is a file in place of their folder."""
    write(folder, STUDY.replace("reference='full'", "states='all'"))
    (folder / "study.cases").write_text("")


def check_file_error(run):
    assert run.returncode == FILE, run.stdout + run.stderr
    assert len(re.findall(r"study\.cases/0000\d\d\.h5 cannot be written", run.stderr)) == 1, run.stderr
    assert "interrupted" not in run.stderr


@pytest.mark.parametrize("threads", [1, 3])
def test_file_errors_have_their_code_and_message(threads, tmp_path):
    without_place_for_states(tmp_path)
    check_file_error(mfv_sweep("--threads", threads, "study.nml", cwd=tmp_path))


@needs_mpi
@pytest.mark.parametrize("number, threads", [(2, 1), (4, 2)])
def test_file_errors_of_ranks_have_their_code_and_message(number, threads, tmp_path):
    without_place_for_states(tmp_path)
    check_file_error(mfv_sweep("--threads", threads, "study.nml", cwd=tmp_path, launcher=ranks(number)))


@needs_mpi
def test_input_errors_of_ranks_come_once(tmp_path):
    write(tmp_path, STUDY.replace("mu'", "mo'"))
    run = mfv_sweep("study.nml", cwd=tmp_path, launcher=ranks(2))
    assert run.returncode == INPUT and run.stderr.count("unknown key of &friction") == 1


def test_killed_at_any_moment(shim, tmp_path):
    """Before any of the calls that change a file, on disk: whatever the machine's speed."""
    cases = long_study(tmp_path)
    undisturbed = tmp_path / "undisturbed"
    undisturbed.mkdir()
    assert mfv_sweep("--threads", 1, "../study.nml", cwd=undisturbed).returncode == COMPLETE
    journal = tmp_path / "study.h5.journal"
    chance = random.Random(6)
    before = []
    for _ in range(6):
        run, _ = run_on_disk(shim, [MFV_SWEEP, "--threads", "2", "study.nml"], tmp_path.resolve(), at=chance.randint(7, 24))
        output = run.stdout
        assert run.returncode == -signal.SIGKILL and not (tmp_path / "study.h5").exists()
        after = numbers_in(journal)
        assert after[:len(before)] == before  # nothing is lost
        assert len(set(after)) == len(after)  # nothing is done twice
        if before and len(after) > len(before):
            assert f"{len(before)} of {cases} cases were there" in output
        before = after
    assert before
    run = mfv_sweep("study.nml", cwd=tmp_path)
    assert run.returncode == COMPLETE, run.stderr
    assert digest(tmp_path / "study.h5") == digest(undisturbed / "study.h5")
    assert not journal.exists()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["base.nml", "study.h5", "study.nml", "undisturbed"]


def test_end_of_the_journal_that_is_not_whole(shim, tmp_path):
    cases = long_study(tmp_path, count=20)
    journal = tmp_path / "study.h5.journal"
    go_on_with(start_until_records(shim, 5, "--threads", 1, "study.nml", cwd=tmp_path), signal.SIGKILL)
    whole = numbers_in(journal)
    data = journal.read_bytes()
    for damaged in (data[:-3], data[:-1] + bytes([data[-1] ^ 1])):
        journal.write_bytes(damaged)
        run = mfv_sweep("--check", "study.nml", cwd=tmp_path)
        assert run.returncode == COMPLETE and journal.read_bytes() == damaged
        run = start("study.nml", cwd=tmp_path)
        output, errors = run.communicate(timeout=60)
        assert f"{len(whole) - 1} of {cases} cases were there" in output, (output, errors)
        assert re.search(r"^study\.h5\.journal: \d+ bytes at the end of the journal were not whole and are dropped$", errors, re.M)
        (tmp_path / "study.h5").unlink()


def test_records_behind_a_broken_one_are_dropped_and_counted(study, tmp_path):
    write(tmp_path)
    for path, arguments in (("study.h5.journal", []), ("study.h5.part-1-of-1.journal", ["--again"])):
        assert mfv_sweep(*arguments, "--part", "1/1", "study.nml", cwd=tmp_path).returncode == COMPLETE
        (tmp_path / "study.h5.part-1-of-1.journal").rename(tmp_path / path)
        data = bytearray((tmp_path / path).read_bytes())
        first = data.index(b"\n") + 1
        second = first + 4 + struct.unpack_from("<i", data, first)[0] + 8
        data[second + 20] ^= 1
        (tmp_path / path).write_bytes(data)
        run = mfv_sweep("study.nml", cwd=tmp_path)
        assert run.returncode == COMPLETE and f"1 of {CASES} cases were there" in run.stdout
        assert run.stderr == f"{path}: {len(data) - second} bytes at the end of the journal were not whole and are dropped\n"
        assert digest(tmp_path / "study.h5") == digest(study / "study.h5")


@pytest.mark.skipif(not shutil.which("cc"), reason="no C compiler")
@pytest.mark.parametrize("number, words", [("ENOLCK", "the file system cannot lock files"), ("EOPNOTSUPP", "the file system cannot lock files"),
                                           ("EAGAIN", "another process is at work on this sweep"),
                                           ("EACCES", "another process is at work on this sweep")])
def test_locks_that_fail(number, words, tmp_path):
    write(tmp_path)
    (tmp_path / "lock.c").write_text(f"#include <errno.h>\nint lockf(int file, int command, long length) "
                                     f"{{ errno = {number}; return -1; }}\n")
    subprocess.run(["cc", "-w", "-shared", "-fPIC", "-o", "lock.so", "lock.c"], cwd=tmp_path, check=True)
    run = subprocess.run([MFV_SWEEP, "study.nml"], cwd=tmp_path, capture_output=True, text=True,
                         env=os.environ | AS_ROOT | {"LD_PRELOAD": str(tmp_path / "lock.so")})
    assert run.returncode == FILE and f"study.h5.journal: {words}" in run.stderr, run.stderr


def test_a_second_process_is_refused(shim, tmp_path):
    cases = long_study(tmp_path, count=4)
    run = start_until_records(shim, 2, "--threads", 1, "study.nml", cwd=tmp_path)
    second = mfv_sweep("study.nml", cwd=tmp_path)
    assert run.poll() is None
    go_on_with(run, signal.SIGKILL)
    assert second.returncode == FILE and "study.h5.journal: another process is at work on this sweep" in second.stderr
    third = mfv_sweep("study.nml", cwd=tmp_path)  # a killed process leaves no lock
    assert third.returncode == COMPLETE and f"of {cases} cases were there" in third.stdout


def test_interrupt_keeps_what_is_there(shim, tmp_path):
    cases = long_study(tmp_path)
    run = start_until_records(shim, 5, "--threads", 2, "study.nml", cwd=tmp_path)
    _, errors = go_on_with(run, signal.SIGINT)
    assert run.returncode == INTERRUPTED
    kept = int(re.match(rf"interrupted: (\d+) of {cases} cases are kept in study.h5.journal; the same command goes on", errors)[1])
    table = mfv.read_table(tmp_path / "study.h5")
    assert table.attributes["complete"] == 0 and table.attributes["cases_done"] == kept == len(table)
    assert sorted(numbers_in(tmp_path / "study.h5.journal")) == list(table["case"])
    run = mfv_sweep("study.nml", cwd=tmp_path)
    assert run.returncode == COMPLETE and run.stdout.startswith(f"{kept} of {cases} cases were there")
    table = mfv.read_table(tmp_path / "study.h5")
    assert table.attributes["complete"] == 1 and len(table) == cases


def test_a_finished_sweep_is_left_alone(study, tmp_path):
    write(tmp_path)
    shutil.copy2(study / "study.h5", tmp_path)
    before = unchanging(tmp_path / "study.h5")
    run = mfv_sweep("study.nml", cwd=tmp_path)
    assert run.returncode == COMPLETE and f"study.h5 is complete: {CASES} cases" in run.stdout
    assert unchanging(tmp_path / "study.h5") == before
    run = mfv_sweep("--again", "study.nml", cwd=tmp_path)
    assert run.returncode == COMPLETE and "were there" not in run.stdout
    assert unchanging(tmp_path / "study.h5") != before
    assert digest(tmp_path / "study.h5") == digest(study / "study.h5")


def test_again_that_is_interrupted_is_continued(shim, tmp_path):
    cases = long_study(tmp_path, count=60)
    journal = tmp_path / "study.h5.journal"
    assert mfv_sweep("study.nml", cwd=tmp_path).returncode == COMPLETE
    whole = digest(tmp_path / "study.h5")
    run = start_until_records(shim, 5, "--again", "--threads", 1, "study.nml", cwd=tmp_path)
    _, errors = go_on_with(run, signal.SIGINT)
    assert run.returncode == INTERRUPTED
    assert "are kept in study.h5.journal; the same command without --again goes on" in errors
    kept = numbers_in(journal)
    assert digest(tmp_path / "study.h5") == whole
    complete = journal.read_bytes()
    run = mfv_sweep("study.nml", cwd=tmp_path)
    assert run.returncode == COMPLETE and run.stdout.startswith(f"{len(kept)} of {cases} cases were there"), run.stdout
    assert digest(tmp_path / "study.h5") == whole and not journal.exists()
    # One of another input is not continued, and not deleted.
    damaged = bytearray(complete)
    damaged[25] ^= 1
    journal.write_bytes(damaged)
    assert "is complete" in mfv_sweep("study.nml", cwd=tmp_path).stdout and journal.read_bytes() == damaged


def test_a_whole_journal_beside_a_complete_table_is_deleted(study, tmp_path):
    write(tmp_path)
    assert mfv_sweep("--part", "1/1", "study.nml", cwd=tmp_path).returncode == COMPLETE
    (tmp_path / "study.h5.part-1-of-1.journal").rename(tmp_path / "study.h5.journal")
    shutil.copy2(study / "study.h5", tmp_path)
    before = unchanging(tmp_path / "study.h5")
    assert "is complete" in mfv_sweep("study.nml", cwd=tmp_path).stdout
    assert not (tmp_path / "study.h5.journal").exists() and unchanging(tmp_path / "study.h5") == before


def test_parts_over_a_complete_table(study, tmp_path):
    write(tmp_path)
    shutil.copy2(study / "study.h5", tmp_path)
    before = unchanging(tmp_path / "study.h5")
    assert "is complete" in mfv_sweep("--part", "1/3", "study.nml", cwd=tmp_path).stdout
    assert mfv_sweep("--again", "--part", "1/3", "study.nml", cwd=tmp_path).returncode == COMPLETE
    assert "6 of 6 cases were there" in mfv_sweep("--part", "1/3", "study.nml", cwd=tmp_path).stdout
    assert unchanging(tmp_path / "study.h5") == before
    run = mfv_sweep("study.nml", cwd=tmp_path)
    assert run.returncode == COMPLETE and f"6 of {CASES} cases were there" in run.stdout, run.stdout
    assert unchanging(tmp_path / "study.h5") != before and digest(tmp_path / "study.h5") == digest(study / "study.h5")
    assert not list(tmp_path.glob("*.journal"))


def test_another_input(study, shim, tmp_path):
    long_study(tmp_path)
    shutil.copy(study / "study.h5", tmp_path)
    journal = tmp_path / "study.h5.journal"
    run = start_until_records(shim, 3, "--threads", 1, "study.nml", cwd=tmp_path)
    go_on_with(run, signal.SIGTERM)
    assert run.returncode == INTERRUPTED
    assert digest(tmp_path / "study.h5") == digest(study / "study.h5")  # that of another input stays until all is there
    kept = journal.read_bytes()
    text = (tmp_path / "base.nml").read_text()
    (tmp_path / "base.nml").write_text(text.replace("cycles=4", "cycles=1"))
    run = mfv_sweep("study.nml", cwd=tmp_path)
    assert run.returncode == INPUT and "study.h5.journal: this journal is of another input" in run.stderr
    assert "--again" in run.stderr and journal.read_bytes() == kept
    run = mfv_sweep("--again", "study.nml", cwd=tmp_path)
    assert run.returncode == COMPLETE and not journal.exists()
    assert mfv.read_table(tmp_path / "study.h5").attributes["base_1"] == text.replace("cycles=4", "cycles=1")


def test_files_that_a_case_names_are_part_of_the_input(tmp_path):
    write(tmp_path, "&sweep base='base.nml' /\n&vary key='mesh%nodes', values=11, 21 /\n")
    text = (tmp_path / "base.nml").read_text()
    (tmp_path / "base.nml").write_text(text.replace("mu=0.7", "mu_file='mu.txt'"))
    (tmp_path / "mu.txt").write_text("-1 0.7\n1 0.7\n")
    assert mfv_sweep("study.nml", cwd=tmp_path).returncode == COMPLETE
    assert "is complete" in mfv_sweep("study.nml", cwd=tmp_path).stdout
    (tmp_path / "mu.txt").write_text("-1 0.6\n1 0.7\n")
    assert "is complete" not in mfv_sweep("study.nml", cwd=tmp_path).stdout
    table = mfv.read_table(tmp_path / "study.h5")
    assert list(table["mesh%nodes"]) == [11, 21] and table["mesh%nodes"].dtype == np.int32


def test_other_files_are_not_replaced(tmp_path):
    write(tmp_path, STUDY.replace("reference", "file='base.nml', reference"))
    before = (tmp_path / "base.nml").read_text()
    run = mfv_sweep("study.nml", cwd=tmp_path)
    assert run.returncode == INPUT and "study.nml: &sweep file='base.nml': base.nml is there and is no HDF5 file" in run.stderr
    assert (tmp_path / "base.nml").read_text() == before
    write(tmp_path)
    (tmp_path / "study.h5.journal").write_text("my diary\n")
    for again in ([], ["--again"]):
        run = mfv_sweep(*again, "study.nml", cwd=tmp_path)
        assert run.returncode == INPUT and "is no journal of mfv_sweep; it is not replaced" in run.stderr
    assert (tmp_path / "study.h5.journal").read_text() == "my diary\n"


def test_results_of_cases_are_not_replaced(tmp_path):
    write(tmp_path)
    subprocess.run([MFV_RUN, "base.nml"], cwd=tmp_path, capture_output=True)
    (tmp_path / "base.h5").rename(tmp_path / "study.h5")
    before = unchanging(tmp_path / "study.h5")
    for option in ([], ["--again"], ["--check"], ["--part", "1/2"]):
        run = mfv_sweep(*option, "study.nml", cwd=tmp_path)
        assert run.returncode == INPUT and run.stdout == ""
        assert "study.nml: &sweep file='study.h5': study.h5 is there and is no table of mfv_sweep" in run.stderr
        assert "name another file, or move this one away" in run.stderr
    assert unchanging(tmp_path / "study.h5") == before
    assert not list(tmp_path.glob("*.journal"))
    write(tmp_path, STUDY.replace("reference", "file='no/folder.h5', reference"))
    run = mfv_sweep("--check", "study.nml", cwd=tmp_path)
    assert run.returncode == INPUT and "study.nml: &sweep file='no/folder.h5': no/folder.h5 cannot be written" in run.stderr


def test_parts_are_gathered(study, tmp_path):
    write(tmp_path)
    for part in (1, 3, 4):
        run = mfv_sweep("--part", f"{part}/4", "study.nml", cwd=tmp_path)
        assert run.returncode == COMPLETE and f"part {part} of 4: " in run.stdout
    journals = sorted(path.name for path in tmp_path.glob("*.journal"))
    assert journals == [f"study.h5.part-{part}-of-4.journal" for part in (1, 3, 4)]
    assert sorted(numbers_in(tmp_path / journals[1])) == [3, 7, 11, 15]
    assert not (tmp_path / "study.h5").exists()
    run = mfv_sweep("--part", "3/4", "study.nml", cwd=tmp_path)
    assert run.returncode == COMPLETE and "4 of 4 cases were there" in run.stdout
    other = tmp_path / "study.h5.part-2-of-2.journal"
    data = bytearray((tmp_path / journals[0]).read_bytes())
    data[25] ^= 1
    other.write_bytes(data)
    run = mfv_sweep("study.nml", cwd=tmp_path)
    assert run.returncode == COMPLETE and f"13 of {CASES} cases were there" in run.stdout
    assert "study.h5.part-2-of-2.journal is of another input, and is left alone" in run.stderr
    assert digest(tmp_path / "study.h5") == digest(study / "study.h5")
    assert list(tmp_path.glob("*.journal")) == [other]
    for wrong in ("0/4", "5/4", "x/4", "3", "1/"):
        run = mfv_sweep("--part", wrong, "study.nml", cwd=tmp_path)
        assert run.returncode == INPUT and "must be I/N" in run.stderr


def test_values_that_do_not_go_together_are_rows(tmp_path):
    write(tmp_path, "&sweep base='base.nml' /\n&vary key='solver%algorithm', values='mfv', 'conventional' /\n"
          "&vary key='solver%stepping', values='event', 'leap' /\n")
    run = mfv_sweep("study.nml", cwd=tmp_path)
    assert run.returncode == COMPLETE
    assert "study.nml: case 4 (base='base.nml', solver%algorithm='conventional', solver%stepping='leap')" in run.stdout
    table = mfv.read_table(tmp_path / "study.h5")
    assert list(table["outcome"][[0, 1, 3]]) == ["complete", "complete", "input error"]
    assert "means nothing with algorithm='conventional'" in table["message"][3]
    assert np.isnan(table["normal_force"][3]) and np.isnan(table["largest_residual"][3]) and table["nodes"][3] == 0
    assert table.attributes["cases_input_error"] == 1


def test_whole_results(tmp_path):
    write(tmp_path, STUDY.replace("reference='full'", "file='out/table.h5', states='all'"))
    (tmp_path / "out").mkdir()
    assert mfv_sweep("--threads", 3, "study.nml", cwd=tmp_path).returncode == COMPLETE
    (tmp_path / "out").rename(tmp_path / "elsewhere")
    (tmp_path / "case.nml").write_text(mfv_sweep("--case", 14, "study.nml", cwd=tmp_path).stdout)
    subprocess.run([MFV_RUN, "case.nml"], cwd=tmp_path, capture_output=True)
    with h5py.File(tmp_path / "elsewhere/table.h5") as file, h5py.File(tmp_path / "case.h5") as alone:
        assert len(file["cases"]) == CASES
        for name in ("state/pressure", "steps/0002/shear", "history/shift", "observables/cycle_dissipation"):
            np.testing.assert_array_equal(file["cases/000014"][name][()], alone[name][()])
        assert file["cases/000014"].attrs["input"] in alone.attrs["input"]
        assert file["table"]["shift"][13] == file["cases/000014/summary/shift"][()]


def test_matrices_are_read_by_threads_side_by_side(tmp_path):
    x = np.linspace(-1.0, 1.0, 21)
    distance = np.abs(x[:, None] - x[None, :])
    with h5py.File(tmp_path / "body.h5", "w") as file:
        file["x"] = x
        file["compliance"] = np.exp(-distance)  # positive definite
    (tmp_path / "base.nml").write_text("&body shape='matrix', file='body.h5' /\n&body shape='disk', radius=2.0, rigid=.true. /\n"
                                       "&step normal_force=0.1 /\n")
    (tmp_path / "study.nml").write_text("&sweep base='base.nml', states='all' /\n"
                                        "&vary key='step(1)%normal_force', from=0.01, to=0.1, count=40 /\n")
    assert mfv_sweep("--threads", 4, "study.nml", cwd=tmp_path).returncode == COMPLETE
    table = mfv.read_table(tmp_path / "study.h5")
    assert set(table["outcome"]) == {"complete"}, set(table["message"])
    np.testing.assert_allclose(table["normal_force"], table["step(1)%normal_force"], rtol=1e-12)
    first = digest(tmp_path / "study.h5")
    assert mfv_sweep("--again", "--threads", 1, "study.nml", cwd=tmp_path).returncode == COMPLETE
    assert digest(tmp_path / "study.h5") == first


def test_several_bases_and_pairs(tmp_path):
    write(tmp_path, "&sweep base='base.nml', 'sub/other.nml', combine='paired' /\n&vary key='friction%mu', values=0.5, 0.7 /\n"
          "&vary key='step(1)%friction', values=.false., .true. /\n")
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub/other.nml").write_text(BASE.format(nodes=15, cycles=1))
    assert mfv_sweep("study.nml", cwd=tmp_path).returncode == COMPLETE
    table = mfv.read_table(tmp_path / "study.h5")
    assert list(table["base"]) == ["base.nml"] * 2 + ["sub/other.nml"] * 2
    assert list(table["friction%mu"]) == [0.5, 0.7, 0.5, 0.7] and list(table["step(1)%friction"]) == [0, 1, 0, 1]
    assert list(table["nodes"]) == [21, 21, 15, 15]


@pytest.mark.parametrize("change, line, words", [
    (("friction%mu", "friction%my"), 2, "'friction%my': unknown key of &friction; did you mean mu?"),
    (("friction%mu", "frictoin%mu"), 2, "unknown group; did you mean friction?"),
    (("step(2)", "step(4)"), 3, "there is no &step 4 in base.nml, which has 3"),
    (("values=0.3, 0.7", "values=0.3, -0.7"), 2, "&vary 1: friction%mu=-0.7: must be a number at least 0"),
    (("'goodman', 'none'", "'gudman', 'none'"), 4, "&vary 3: scene%coupling='gudman': must be 'full', 'goodman' or 'none'"),
    (("base='base.nml'", "base='bass.nml'"), 1, "&sweep base='bass.nml': "),
    (("&vary key='friction", "&very key='friction"), 2, "&very: unknown group; did you mean &vary?"),
    (("spacing='log'", "spacing='logg'"), 3, "must be 'linear' or 'log'"),
    (("count=3, ", ""), 3, "count is missing"),
    (("'full', 'goodman', 'none'", "'goodman', 'none'"), 1, "reference='full': needs a &vary of key='scene%coupling'"),
    (("name='Q'", "name='outcome'"), 3, "&vary 2 name='outcome': every table has a column outcome (how the case ended)"),
    (("factor=1, -1", "factor=1"), 3, "must have one value a key, 2, not 1"),
    (("reference='full'", "combine='paired'"), 1, "&vary 2 has 3 values, &vary 1 has 2"),
])
def test_bad_input_is_named(change, line, words, tmp_path):
    write(tmp_path, STUDY.replace(*change))
    run = mfv_sweep("study.nml", cwd=tmp_path)
    assert run.returncode == INPUT and run.stdout == ""
    assert re.match(rf"study\.nml:{line}: ", run.stderr) and words in run.stderr, run.stderr
    assert sorted(path.name for path in tmp_path.iterdir()) == ["base.nml", "study.nml"]


def test_values_that_the_case_refuses_are_named(tmp_path):
    write(tmp_path, "&sweep base='base.nml' /\n&vary key='friction%mu',\n values=0.3, 0 /\n")
    run = mfv_sweep("study.nml", cwd=tmp_path)
    assert run.returncode == INPUT
    assert "study.nml:3: &vary 1: case 2 (base='base.nml', friction%mu=0): base.nml:8: &step 2 tangential_force=2.8e-4: " in run.stderr


def test_a_case_is_printed_though_others_cannot_be_used(tmp_path):
    write(tmp_path, "&sweep base='base.nml' /\n&vary key='friction%mu', values=0.3, 0 /\n")
    for number, mu in ((1, "0.3"), (2, "0")):
        run = mfv_sweep("--case", number, "study.nml", cwd=tmp_path)
        assert run.returncode == COMPLETE and f"mu={mu}" in run.stdout.replace(" ", ""), run.stdout


def test_progress_shows_on_a_terminal_only(tmp_path):
    cases = long_study(tmp_path, count=100)
    seen = shown_on_a_terminal([MFV_SWEEP, "--threads", "1", "study.nml"], cwd=tmp_path, env=os.environ | AS_ROOT)
    assert re.search(rb"\r  cases \d+ of %d, 0 early ends, \d+:\d\d left" % cases, seen)


def test_help_version_keys_and_check(study, tmp_path):
    run = mfv_sweep("--help", cwd=tmp_path)
    assert run.returncode == COMPLETE and "usage: mfv_sweep" in run.stdout and "&vary" in run.stdout
    version = (ROOT / "VERSION").read_text().strip()
    assert mfv_sweep("--version", cwd=tmp_path).stdout in (f"mfv_sweep {version} with MPI\n", f"mfv_sweep {version} without MPI\n")
    assert mfv_sweep("--keys", cwd=tmp_path).stdout in (ROOT / "docs/sweep.md").read_text()
    run = mfv_sweep("--check", study / "study.nml", cwd=tmp_path)
    assert run.returncode == COMPLETE and f"is valid: {CASES} cases, into study.h5" in run.stdout
    assert "case 2: base='base.nml', friction%mu=0.3, Q=1e-4, scene%coupling='goodman'" in run.stdout
    for wrong in (["--unknown"], [], ["a.nml", "b.nml"], ["--threads", "0", "a.nml"], ["--case", "99", study / "study.nml"]):
        run = mfv_sweep(*wrong, cwd=tmp_path)
        assert run.returncode == INPUT and "mfv_sweep: " in run.stderr
    assert list(tmp_path.iterdir()) == []


def test_example(tmp_path):
    run = mfv_sweep(ROOT / "examples/sweep.nml", cwd=tmp_path)
    assert run.returncode == COMPLETE and "36: 36 complete" in run.stdout
    table = mfv.read_table(tmp_path / "sweep.h5")
    # Dissertation section 6.4: decoupled dissipation is 20 to 50 % above that of full coupling.
    ratio = table["dissipation_ratio"][table["scene%coupling"] != "full"]
    assert ratio.min() > 1.1 and ratio.max() < 1.5


def test_table_in_python(study, tmp_path):
    command = [sys.executable, "-m", "mfv", "table", str(study / "study.h5")]
    shown = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    assert f"{CASES} cases" in shown and "stick_ratio_loading" in shown
    subprocess.run([*command, "--csv", tmp_path / "table.csv"], check=True, capture_output=True)
    with open(tmp_path / "table.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    table = mfv.read_table(study / "study.h5")
    assert tuple(rows[0]) == table.columns and len(rows) == CASES
    for row, line in zip(table, rows):
        assert line["outcome"] == row["outcome"]
        np.testing.assert_array_equal(float(line["shift"]), row["shift"])
    assert table[table["status"] == 0].units == table.units
    frame = pandas.DataFrame(table)
    assert list(frame.columns) == list(table.columns) and list(frame["outcome"]) == list(table["outcome"])
    assert frame["shift"].to_numpy().tobytes() == table["shift"].tobytes()
    (tmp_path / "no.h5").write_text("no table")
    for path in (tmp_path / "no.h5", tmp_path / "missing.h5"):
        assert subprocess.run([*command[:-1], str(path)], capture_output=True).returncode == INPUT
