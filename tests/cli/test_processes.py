"""Limits of the process, signals, and the share of the search for the largest stress."""

import itertools
import os
import random
import resource
import shutil
import signal
import subprocess
import time
from pathlib import Path

import h5py
import pytest
from disk import wait_for_work

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = Path(os.environ.get("MFV_RUN", ROOT / "build/release/bin/mfv_run"))
PROGRAMS = ("mfv_run", "mfv_conventional", "mfv_stress")
LIMITS = {"s": (resource.RLIMIT_STACK, 2**20), "v": (resource.RLIMIT_AS, 2**28), "d": (resource.RLIMIT_DATA, 2**28)}

BODIES = """&body shape='half_plane', shear_modulus=1.0, poisson_ratio=0.3 /
&body shape='disk', radius=0.25, shear_modulus=1.0, poisson_ratio=0.2 /
"""
SHORT = BODIES + "&friction law='coulomb', mu=0.5 /\n&mesh nodes=21 /\n&step normal_force=1e-3 /\n&step tangential_force=1e-4 /\n"


def limited(program, option, size, arguments, folder):
    """A program with one limit, bytes."""
    kind = LIMITS[option][0]
    return subprocess.run(
        [PROGRAM.with_name(program), *arguments],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=120,
        preexec_fn=lambda: resource.setrlimit(kind, (size, size)),
    )


@pytest.mark.parametrize("program, option", list(itertools.product(PROGRAMS, LIMITS)))
def test_a_small_limit_is_refused_with_its_name(program, option, tmp_path):
    (tmp_path / "case.nml").write_text(SHORT)
    least = LIMITS[option][1]
    for size in (least - 1024, least // 2, least // 2 + 4096 * random.Random(program + option).randrange(1000) // 20):
        run = limited(program, option, size, ["case.nml"], tmp_path)
        assert run.returncode == 2 and run.stdout == "", run
        assert f"(ulimit -{option}) is {size // 1024} kB; at least {least // 1024} kB are needed" in run.stderr
    assert sorted(path.name for path in tmp_path.iterdir()) == ["case.nml"]


@pytest.mark.parametrize("option", LIMITS)
def test_the_limits_that_are_asked_for_suffice(option, tmp_path):
    (tmp_path / "case.nml").write_text(SHORT.replace("nodes=21", "nodes=601"))
    for program in PROGRAMS[:2]:
        assert limited(program, option, LIMITS[option][1], ["case.nml"], tmp_path).returncode == 0
    assert limited("mfv_stress", option, LIMITS[option][1], ["case.h5"], tmp_path).returncode == 0


@pytest.mark.parametrize(
    "arguments, text",
    [
        ((), BODIES + "&mesh nodes=4001, refine='edges' /\n&step normal_force=1e-3 /\n"),
        (("--advise", "error=1e-4"), BODIES + "&friction law='coulomb', mu=0.5 /\n&mesh nodes=401, refine='edges' /\n"
         "&step normal_force=1e-3 /\n&step tangential_force=1e-4, cycles=400 /\n"),
    ],
    ids=("refinement", "advice"),
)  # fmt: skip
@pytest.mark.parametrize("seconds", [0.1, 0.6])
def test_a_signal_before_there_is_a_result_ends_the_program_at_once(arguments, text, seconds, tmp_path):
    (tmp_path / "case.nml").write_text(text)
    run = subprocess.Popen([PROGRAM, *arguments, "case.nml"], cwd=tmp_path, stderr=subprocess.PIPE, text=True)
    before = os.times().children_user
    wait_for_work(run, seconds)
    assert run.poll() is None
    run.send_signal(signal.SIGTERM)
    errors = run.communicate(timeout=120)[1]
    assert os.times().children_user - before < seconds + 0.5
    assert run.returncode == 130 and errors == "interrupted before the first increment; no result is written\n"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["case.nml"]


def test_a_second_signal_ends_the_program(tmp_path):
    text = SHORT.replace("nodes=21", "nodes=801").replace("1e-4 /", "1e-4, cycles=10000 /\n&solver linear_solver='dgesv' /")
    (tmp_path / "case.nml").write_text(text)
    run = subprocess.Popen([PROGRAM, "case.nml"], cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    wait_for_work(run, 0.5)
    run.send_signal(signal.SIGTERM)
    run.send_signal(signal.SIGINT)
    run.send_signal(signal.SIGTERM)
    run.communicate(timeout=120)
    assert run.returncode in (130, -signal.SIGTERM)  # 130: the result was written between the signals


@pytest.mark.parametrize("seed", range(3))
def test_yield_is_searched_for_on_many_nodes(seed, tmp_path):
    random_number = random.Random(seed).uniform
    (tmp_path / "case.nml").write_text(
        "&body shape='half_plane', rigid=.true. /\n"
        f"&body shape='disk', radius={random_number(0.3, 0.9)}, shear_modulus={random_number(50, 90)}, poisson_ratio=0.3, "
        f"yield_strength=1e-3 /\n&mesh nodes=3001 /\n&step normal_force={random_number(0.005, 0.02)} /\n"
    )
    run = subprocess.run([PROGRAM, "case.nml"], cwd=tmp_path, capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    assert "exceeds its yield_strength" in run.stdout


@pytest.mark.parametrize("blanks", ["", "   "])
@pytest.mark.parametrize(
    "group",
    [
        "&output file='{}' /",
        "&history file='{}', normal_force=1 /",
        "&friction law='coulomb', mu_file='{}' /",
        "&body shape='profile', file='{}' /",
    ],
)
def test_a_file_name_is_not_empty(group, blanks, tmp_path):
    (tmp_path / "case.nml").write_text("&step normal_force=1e-3 /\n" + group.format(blanks) + "\n" + BODIES)
    run = subprocess.run([PROGRAM, "case.nml"], cwd=tmp_path, capture_output=True, text=True)
    assert run.returncode == 2 and "must not be empty: name a file, or remove the key" in run.stderr, run.stderr
    assert run.stderr.startswith("case.nml:2: ")


def test_a_title_may_be_empty(tmp_path):
    (tmp_path / "case.nml").write_text("&scene title='' /\n" + SHORT)
    assert subprocess.run([PROGRAM, "case.nml"], cwd=tmp_path, capture_output=True).returncode == 0
    with h5py.File(tmp_path / "case.h5") as result:
        assert result.attrs["outcome"] == "complete"


def test_continuous_integration_leaves_nothing_behind_where_a_step_fails(tmp_path):
    """.ci/run with stand-ins: the site takes a minute, the first hour fails."""
    for name, text in (
        ("scripts/demo.sh", ""),
        ("scripts/docs.sh", "echo $$ >site; sleep 60"),
        ("build/venv/bin/pip", ""),
        ("build/venv/bin/python", "while [ ! -s site ]; do sleep 0.01; done; exit 3"),
    ):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f"#!/bin/sh\n{text}\n")
        path.chmod(0o755)
    (tmp_path / ".ci").mkdir()
    shutil.copy(ROOT / ".ci/run", tmp_path / ".ci/run")
    assert subprocess.run([tmp_path / ".ci/run"], capture_output=True, timeout=30).returncode == 3
    site = (tmp_path / "site").read_text().strip()
    for _ in range(100):
        if subprocess.run(["ps", "-o", "stat=", "-p", site], capture_output=True, text=True).stdout.strip() in ("", "Z"):
            return
        time.sleep(0.1)
    os.kill(int(site), signal.SIGKILL)
    pytest.fail("the site is still being built")
