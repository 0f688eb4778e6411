"""mfv_stress as a user runs it: what it puts into the file and prints, and what it leaves alone."""

import os
import subprocess
from pathlib import Path

import h5py
import numpy as np
import pytest
import xarray

ROOT = Path(__file__).resolve().parents[2]
RUN = Path(os.environ.get("MFV_RUN", ROOT / "build/release/bin/mfv_run"))
STRESS = RUN.with_name("mfv_stress")

CASE = """&scene length_unit='mm', force_unit='N' /
&body shape='hole', radius=4.0, shear_modulus=1.0, poisson_ratio=0.3, yield_strength=1e-3 /
&body shape='disk', radius=1.0, rigid=.true. /
&friction law='coulomb', mu=0.4 /
&mesh nodes=41, half_width=0.06 /
&step normal_force=1.0e-3, friction=.false. /
&step tangential_force=2.0e-4 /
"""


def stress(*arguments, cwd):
    return subprocess.run([STRESS, *map(str, arguments)], cwd=cwd, capture_output=True, text=True, timeout=300)


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "case.nml").write_text(CASE)
    subprocess.run([RUN, "case.nml"], cwd=tmp_path, check=True, capture_output=True)
    return tmp_path


def test_a_grid_is_put_into_the_file(folder):
    run = stress("case.h5", "--points", 41, 21, "--width", 1.5, "--depth", 1, cwd=folder)
    assert run.returncode == 0, run.stderr
    assert "largest von Mises" in run.stdout and "/stress/last/lower" in run.stdout
    assert "exceeds the yield_strength" in run.stderr
    with h5py.File(folder / "case.h5") as result:
        group = result["stress/last/lower"]
        assert group["von_mises"].shape == (21, 41)
        assert group["sigma_xx"].attrs["units"] == "N/mm^2" and "tension" in group["sigma_xx"].attrs["long_name"]
        a = group["half_width"][()]
        assert group["x"][-1] == pytest.approx(1.5 * a, rel=0.1) and group["depth"][-1] == pytest.approx(a)
        assert group["y"][-1] == pytest.approx(group["y"][0] - a)
        assert group["largest_von_mises"][()] >= np.nanmax(group["von_mises"][()]) * (1 - 1e-9)
        assert np.all(group["tresca"][()] >= group["von_mises"][()] * (1 - 1e-12))
        assert group["largest_tension"][()] >= np.nanmax(group["sigma_thetatheta"][0]) * (1 - 1e-9)
        assert group["largest_tension"][()] == pytest.approx(result["observables/lower_tension"][()], rel=1e-9)
        assert group["tension_x"][()] == pytest.approx(result["observables/lower_tension_x"][()], rel=1e-6)
        assert "largest tension" in run.stdout
        assert result["state/pressure"].shape == (41,)
    grid = xarray.open_dataset(folder / "case.h5", group="stress/last/lower", engine="h5netcdf")
    assert grid.von_mises.dims == ("depth", "x")


def test_scales_and_datasets_list_each_other(folder):
    assert stress("case.h5", "--points", 11, 7, cwd=folder).returncode == 0
    with h5py.File(folder / "case.h5") as result:
        listed, attached = 0, 0

        def check(_, item):
            nonlocal listed, attached
            if not isinstance(item, h5py.Dataset):
                return
            listed += len(item.attrs.get("REFERENCE_LIST", ()))
            for place, dimension in enumerate(item.dims):
                for scale in dimension.values():
                    # By HDF5, from the lists of both.
                    assert h5py.h5ds.is_attached(item.id, scale.id, place)
                    assert scale.shape == item.shape[place : place + 1]
                    attached += 1

        result.visititems(check)
        assert listed == attached > 50
        assert [d[0].name for d in result["stress/last/lower/von_mises"].dims] == [
            f"/stress/last/lower/{k}" for k in ("depth", "x")
        ]


def test_states_and_bodies_stand_beside_each_other_and_are_replaced(folder):
    for arguments in ((), ("--step", 1), ("--points", 11, 11)):
        assert stress("case.h5", *arguments, cwd=folder).returncode == 0
    with h5py.File(folder / "case.h5") as result:
        assert set(result["stress"]) == {"last", "0001"}
        assert result["stress/last/lower/von_mises"].shape == (11, 11)
        assert result["stress/0001/lower/von_mises"].shape == (81, 161)


def test_points_are_printed(folder):
    (folder / "points.txt").write_text("# x y\n0.0 -0.02\n0.01 -0.03\n0 1\n")
    run = stress("case.h5", "--at", "points.txt", cwd=folder)
    assert run.returncode == 0
    rows = [line.split() for line in run.stdout.splitlines() if line and line.lstrip()[0] in "-0123456789"]
    table = np.array(rows, dtype=float)
    assert table.shape == (3, 14)
    assert np.isnan(table[2, 2:]).all()
    with h5py.File(folder / "case.h5") as result:
        assert result["stress/last/lower_points/von_mises"][()] == pytest.approx(table[:, 8], nan_ok=True)


@pytest.mark.parametrize(
    "arguments, message",
    [
        ((), "a result file is missing"),
        (("case.h5", "--body", "left"), "--body must be lower or upper, not 'left'"),
        (("case.h5", "--depth", "-1"), "--depth needs a number above 0 and at most 100000, not '-1'"),
        (("case.h5", "--points", "1", "5"), "--points needs a whole number from 2 to 100000, not '1'"),
        (("case.h5", "--what"), "unknown option '--what'"),
        (("case.h5", "--step", "9"), "case.h5: the result has no state steps/0009"),
        (("case.h5", "--body", "upper"), "the upper body is rigid or given by a matrix"),
        (("nowhere.h5",), "nowhere.h5: no such file"),
        (("case.nml",), "case.nml is a case, not a result; solve it first with 'mfv run'"),
        (("case.h5", "--at", "nowhere.txt"), "nowhere.txt"),
        (("other.h5",), "attribute input is missing: not a result of MFV"),
    ],
)
def test_bad_requests_leave_the_file_as_it_was(folder, arguments, message):
    with h5py.File(folder / "other.h5", "w") as other:
        other["x"] = 1.0
    before = (folder / "case.h5").read_bytes()
    run = stress(*arguments, cwd=folder)
    assert run.returncode == 2
    assert message in run.stderr
    assert (folder / "case.h5").read_bytes() == before
    assert not list(folder.glob("*.part*"))


def test_states_without_load_or_steps(folder):
    (folder / "light.nml").write_text(CASE[: CASE.index("&step")] + "&step approach=-1e-4 /\n&output states='none' /\n")
    subprocess.run([RUN, "light.nml"], cwd=folder, check=True, capture_output=True)
    before = (folder / "light.h5").read_bytes()
    for arguments, message in (
        ((), "light.h5: no load acts in this state"),
        (("--step", "1"), "the result has no state steps/0001"),
    ):
        run = stress("light.h5", *arguments, cwd=folder)
        assert run.returncode == 2 and message in run.stderr and run.stdout == "", run
        assert (folder / "light.h5").read_bytes() == before


def test_numbers_that_no_result_has_are_refused(folder):
    # Found by fuzzing: the search for the largest stress met no finite value, and GSL ended the program.
    with h5py.File(folder / "case.h5", "r+") as result:
        result["state/pressure"][...] *= 1e200
    run = stress("case.h5", cwd=folder)
    assert run.returncode == 2 and run.stderr == "case.h5: mesh or state has values beyond 1e100\n"


def test_help_teaches():
    run = stress("--help", cwd=ROOT)
    assert run.returncode == 0 and "largest von Mises" in run.stdout
