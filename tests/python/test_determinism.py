"""The same bits: in two runs, from text, file and calls, by the library and by mfv_run, with other cases solved before, in one go and by
steps, with memory elsewhere, and under a locale with a decimal comma."""

from __future__ import annotations

import hashlib
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import h5py
import numpy as np
import pytest

import mfv

BODIES = """&body shape='half_plane', shear_modulus=1.0, poisson_ratio=0.1 /
&body shape='disk', radius=0.25, rigid=.true. /
"""
STEPS = "&step normal_force=1.0e-3 /\n&step tangential_force=2.0e-4, cycles=2 /\n&step shift=-1.0e-5 /\n"
PRESS_FIRST = "&step normal_force=1.0e-3, friction=.false. /\n&step tangential_force=2.0e-4, cycles=1 /\n"

#: One of every sort of solver and law.
CASES = {
    "full": "&scene coupling='full' /\n" + BODIES + "&mesh nodes=61 /\n&friction law='coulomb', mu=0.4 /\n" + STEPS,
    "dgesv": BODIES + "&mesh nodes=21 /\n&friction law='coulomb', mu=0.4 /\n&solver linear_solver='dgesv' /\n" + STEPS,
    "fft": BODIES + "&mesh nodes=61 /\n&friction law='coulomb', mu=0.4 /\n&solver linear_solver='fft' /\n" + STEPS,
    "leap": "&scene coupling='goodman' /\n"
    + BODIES
    + "&mesh nodes=61 /\n&friction law='coulomb', mu=0.4 /\n&solver stepping='leap', accuracy=1e-3 /\n"
    + PRESS_FIRST,
    "weakening": BODIES
    + "&mesh nodes=21 /\n&friction law='weakening', mu_static=0.5, mu_kinetic=0.4, weakening_distance=1e-3 /\n"
    + PRESS_FIRST,
    "dahl": "&scene coupling='goodman' /\n"
    + BODIES
    + "&mesh nodes=21 /\n&friction law='dahl', mu=0.4, stiffness=1e3 /\n&solver friction_tolerance=1e-2 /\n"
    + PRESS_FIRST,
    "fourier": "&body shape='disk', radius=1.0, shear_modulus=1.0, poisson_ratio=0.3, kernel='fourier' /\n"
    "&body shape='half_plane', rigid=.true. /\n&mesh nodes=21, half_angle=20.0 /\n&friction law='coulomb', mu=0.4 /\n"
    "&step normal_force=0.02 /\n&step moment=1e-4 /\n",
}

#: Prints the digests of all cases; `before` is done first.
CHILD = """
import json, sys
sys.path.insert(0, {folder!r})
import test_determinism as this
{before}
print(json.dumps({{name: this.digest_of(text) for name, text in this.CASES.items()}}))
"""


def digest(fields: dict[str, np.ndarray]) -> str:
    """A checksum of everything but the times that were taken."""
    found = hashlib.sha256()
    for path in sorted(fields):
        if "seconds" not in path:
            found.update(path.encode() + np.ascontiguousarray(fields[path]).tobytes())
    return found.hexdigest()


def fields_of(case: mfv.Case) -> dict[str, np.ndarray]:
    return {path: np.asarray(case[path]) for path in case.fields()}


def digest_of(text: str) -> str:
    with mfv.Case.from_text(text) as case:
        assert case.run() == "complete", case.message
        return digest(fields_of(case)) + case.message


def digests_of_a_child(before: str = "", command: tuple[str, ...] = (), **environment: str) -> dict[str, str]:
    child = CHILD.format(folder=str(Path(__file__).parent), before=before)
    run = subprocess.run(
        [*command, sys.executable, "-c", child],
        env=os.environ | {"OPENBLAS_NUM_THREADS": "1"} | environment,
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert run.returncode == 0, run.stderr
    return json.loads(run.stdout)


@pytest.fixture(scope="module")
def digests() -> dict[str, str]:
    return digests_of_a_child()


def test_two_runs_with_other_cases_solved_before(digests: dict[str, str]) -> None:
    backwards = "this.CASES = dict(reversed(this.CASES.items()))\n[this.digest_of(text) for text in this.CASES.values()]"
    assert digests_of_a_child(backwards) == digests


def test_memory_elsewhere(digests: dict[str, str]) -> None:
    """Without random addresses, and with memory that has been used and is not zero."""
    command: tuple[str, ...] = ()
    if shutil.which("setarch") and subprocess.run(["setarch", "-R", "true"], capture_output=True).returncode == 0:
        command = ("setarch", "-R")
    assert digests_of_a_child(command=command, MALLOC_PERTURB_="165") == digests


def test_decimal_comma(digests: dict[str, str], tmp_path: Path) -> None:
    """The host has called setlocale: numbers are nevertheless read and written with decimal points."""
    source, name = tmp_path / "source", "comma"
    source.write_text('LC_NUMERIC\ndecimal_point "<U002C>"\nthousands_sep "<U002E>"\ngrouping 3;3\nEND LC_NUMERIC\n')
    if not shutil.which("localedef"):
        pytest.skip("localedef makes the locale with the decimal comma, and is not here")
    subprocess.run(["localedef", "-c", "-i", source, tmp_path / name], capture_output=True)
    if not (tmp_path / name / "LC_NUMERIC").exists():
        pytest.skip("localedef could not make a locale with a decimal comma")
    before = f"import locale\nlocale.setlocale(locale.LC_NUMERIC, {name!r})\nassert locale.localeconv()['decimal_point'] == ','"
    assert digests_of_a_child(before, LOCPATH=str(tmp_path)) == digests


@pytest.mark.parametrize("name", CASES)
def test_text_file_and_calls(name: str, digests: dict[str, str], tmp_path: Path) -> None:
    path = tmp_path / "case.nml"
    path.write_text(CASES[name])
    with mfv.Case.from_file(path) as from_file, mfv.Case(mfv.Scene.from_text(CASES[name])) as from_calls:
        for case in (from_file, from_calls):
            case.run()
            assert digest(fields_of(case)) + case.message == digests[name]


@pytest.mark.parametrize("name", ["full", "weakening"])
def test_mfv_run_with_one_thread_and_two(name: str, digests: dict[str, str], tmp_path: Path) -> None:
    program = os.environ.get("MFV_RUN")
    if not program:
        pytest.skip("MFV_RUN does not say where the program is")
    (tmp_path / "case.nml").write_text(CASES[name])
    for threads in "12":
        subprocess.run(
            [program, "case.nml"], cwd=tmp_path, check=True, capture_output=True, env=os.environ | {"OPENBLAS_NUM_THREADS": threads}
        )
        with mfv.Case.from_text(CASES[name]) as case, h5py.File(tmp_path / "case.h5") as result:
            case.run()
            written = {path: result[path][()] for path in case.fields()}
            assert digest(written) + case.message == digests[name]
            assert result.attrs["message"] == case.message


def test_in_one_go_and_by_steps() -> None:
    """Also after a run that was taken back, and in a copy."""
    text = CASES["full"]
    with mfv.Case.from_text(text) as whole, mfv.Case.from_text(text) as stepped:
        whole.run()
        start = stepped.save()
        stepped.run()
        stepped.restore(start)
        stepped.advance(normal_force=1.0e-3)
        stepped.advance(tangential_force=2.0e-4, cycles=2)
        middle = stepped.copy()
        stepped.advance(shift=-1.0e-5)
        middle.advance(shift=-1.0e-5)
        for case in (stepped, middle):
            for path in whole.fields():
                if path.startswith(("state/", "history/", "certificate/")):
                    np.testing.assert_array_equal(case[path], whole[path], err_msg=path)
