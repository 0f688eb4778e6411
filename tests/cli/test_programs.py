"""mfv_run as a user runs it: examples, messages, exit codes, files that are whole or not there."""

import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import h5py
import numpy as np
import pytest
import xarray
from disk import wait_for_work
from terminal import shown_on_a_terminal

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("MFV_RUN", str(ROOT / "build/release/bin/mfv_run"))
EXAMPLES = sorted(path for path in (ROOT / "examples").glob("*.nml") if "&sweep" not in path.read_text())

BODIES = """&body shape='half_plane', shear_modulus=1.0, poisson_ratio=0.3 /
&body shape='disk', radius=0.25, rigid=.true. /
"""
COMPLETE, INPUT, EARLY = 0, 2, 3
#: Examples with a warning, which their text or the guide explains.
WARNED_OF = ("disk_on_plane", "press_fit", "static_kinetic", "wear")


def mfv_run(*arguments, cwd):
    return subprocess.run([PROGRAM, *map(str, arguments)], cwd=cwd, capture_output=True, text=True, timeout=300)


def case(folder, text, name="case.nml"):
    path = folder / name
    path.write_text(text)
    return path


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_examples_have_a_certificate(example, tmp_path):
    run = mfv_run(example, cwd=tmp_path)
    assert run.returncode == COMPLETE, run.stderr
    assert example.stem in WARNED_OF or "\nwarning" not in run.stdout, run.stdout
    assert run.stderr == ""
    with h5py.File(next(tmp_path.glob("*.h5"))) as result:
        assert result["certificate/largest"][()] < 1e-10
        assert result.attrs["input"] == example.read_text()
        assert result.attrs["outcome"] == "complete"


def test_digits_do_not_depend_on_threads(tmp_path):
    example = case(
        tmp_path,
        BODIES + "&friction law='coulomb', mu=0.5 /\n&mesh nodes=161 /\n&step normal_force=1e-3 /\n"
        "&step tangential_force=3e-4, cycles=1 /\n",
    )
    states = []
    for threads in ("1", "2"):
        folder = tmp_path / threads
        folder.mkdir()
        subprocess.run(
            [PROGRAM, example],
            cwd=folder,
            check=True,
            capture_output=True,
            timeout=300,
            env=os.environ | {"OPENBLAS_NUM_THREADS": threads},
        )
        with h5py.File(folder / "case.h5") as result:
            states.append({name: result["state"][name][()].tobytes() for name in result["state"]})
    assert states[0] == states[1]


def test_examples_are_there():
    assert len(EXAMPLES) >= 4


def test_file_opens_without_help(tmp_path):
    mfv_run(ROOT / "examples/mindlin.nml", cwd=tmp_path)
    path = tmp_path / "mindlin.h5"
    with h5py.File(path) as result:
        names = {
            "pressure",
            "shear",
            "gap",
            "slip",
            "normal_displacement",
            "tangential_displacement",
            "status",
            "friction_work",
            "x",
            "contact_edge",
            "stick_edge",
        }
        assert set(result["state"]) == names
        assert names < set(result["steps/0001"]) and len(result["steps"]) == 6
        history = {
            "normal_force",
            "tangential_force",
            "approach",
            "shift",
            "contact_nodes",
            "stick_nodes",
            "dissipation",
            "event_kind",
            "event_node",
        }
        assert history < set(result["history"])
        for group in result.values():
            for dataset in group.values():
                if isinstance(dataset, h5py.Dataset):
                    assert dataset.attrs["units"] and dataset.attrs["long_name"]
        assert result["state/pressure"].dims[0][0] == result["state/x"]
        np.testing.assert_array_equal(result["state/x"][:], result["mesh/x"][:])
        np.testing.assert_array_equal(result["state/shear"][:], result["steps/0006/shear"][:])
        for name in ("title", "mfv_version", "hdf5_version", "outcome", "message", "plane", "coupling", "lower_body", "upper_body"):
            assert isinstance(result.attrs[name], str) and result.attrs[name]
    for group, dimension in (("state", "x"), ("history", "record"), ("steps/0003", "x"), ("reference", "x")):
        with xarray.open_dataset(path, engine="h5netcdf", group=group) as dataset:
            assert dimension in dataset.coords, group
    dump = subprocess.run(["h5dump", "-H", str(path)], capture_output=True) if has_h5dump() else None
    assert dump is None or dump.returncode == 0


def has_h5dump():
    return subprocess.run(["sh", "-c", "command -v h5dump"], capture_output=True).returncode == 0


def test_summary_says_what_came_out(tmp_path):
    run = mfv_run(ROOT / "examples/mindlin.nml", cwd=tmp_path)
    for word in (
        "contact half-width",
        "in contact 87",
        "stuck 67",
        "slipping 20",
        "stick ratio",
        "normal force",
        "tangential force",
        "dissipation",
        "linear solves",
        "events",
        "certificate",
        "mindlin.h5",
    ):
        assert word in run.stdout, word


@pytest.mark.parametrize("mesh", ["", "&mesh nodes=25, half_width=1.25 /\n", "&mesh nodes=101, half_width=1.25 /\n"])
def test_summary_says_where_tension_is_singular(mesh, tmp_path):
    """Also where the interval of the outermost node reaches beyond the corner."""
    (tmp_path / "punch.nml").write_text(
        "&body shape='half_plane', shear_modulus=1.0, poisson_ratio=0.3 /\n"
        "&body shape='flat_punch', half_width=1.0, rigid=.true. /\n&friction law='coulomb', mu=0.5 /\n"
        f"{mesh}&step normal_force=1.0e-3 /\n&step tangential_force=2.0e-4 /\n"
    )
    run = mfv_run("punch.nml", cwd=tmp_path)
    assert "tension at the end  lower body singular at a sharp corner\n" in run.stdout


def test_help_version_keys_and_check(tmp_path):
    assert (
        "usage: mfv_run [--accuracy E] [--estimate] [--sensitivity] [--resume] CASE.nml" in mfv_run("--help", cwd=tmp_path).stdout
    )
    version = (ROOT / "VERSION").read_text().strip()
    assert mfv_run("--version", cwd=tmp_path).stdout == f"mfv_run {version}\n"
    check = mfv_run("--check", ROOT / "examples/mindlin.nml", cwd=tmp_path)
    assert check.returncode == COMPLETE and "is valid" in check.stdout
    assert list(tmp_path.iterdir()) == []


MINDLIN = """&scene coupling='goodman', length_unit='mm', force_unit='N' /
&body shape='half_plane', shear_modulus=1.0, poisson_ratio=0.3 /
&body shape='disk', radius=0.25, rigid=.true. /
&mesh nodes=61, half_width=0.0127, gap='parabolic' /
&friction law='coulomb', mu=0.7 /
&step normal_force=1.0e-3, friction=.false. /
&step tangential_force={force} /
&output file='{name}.h5'{more} /
"""


@pytest.mark.parametrize("example", ["coating", "rolling"])
def test_the_summary_has_the_bars_of_what_it_shows(example, tmp_path):
    """Every number of the summary that has a bar in the file, and the others of the main ones."""
    run = mfv_run("--estimate", ROOT / f"examples/{example}.nml", cwd=tmp_path)
    assert run.returncode == COMPLETE
    lines = run.stdout.splitlines()
    shown = set(re.findall(r"-?\d\S*(?=[, ]|$)", " ".join(line for line in lines if not line.startswith("error estimate"))))
    bars = " ".join(line for line in lines if line.startswith("error estimate"))
    with h5py.File(tmp_path / f"{example}.h5") as result:
        estimate = result["error_estimate"]
        names = [name for name in estimate if f"{name}_error" in estimate and not name.endswith(("_x", "_y", "_number"))]
        missing = [
            name for name in names if written(estimate[name][()]) in shown and f" {written(estimate[name][()])} " not in bars
        ]
    assert not missing and len(names) > 20
    assert example == "rolling" or re.search(r"shear at lower interfaces \S+ N/mm\^2 \+- \S+ \(", bars)


def written(value):
    """A number as in the summary, six digits."""
    text = f"{value:.6g}"
    return text if abs(value) >= 1e-3 else re.sub(r"e-0", "e-", f"{value:.5e}".replace("+", ""))


def test_error_estimate_in_summary_and_file(tmp_path):
    by_key = case(tmp_path, MINDLIN.format(force=2.8e-4, name="key", more=", error_estimate=.true."), "key.nml")
    by_option = case(tmp_path, MINDLIN.format(force=2.8e-4, name="option", more=""), "option.nml")
    runs = [mfv_run(by_key, cwd=tmp_path), mfv_run("--estimate", by_option, cwd=tmp_path)]
    for run in runs:
        assert run.returncode == COMPLETE and run.stderr == ""
        assert (
            len(
                re.findall(
                    r"^error estimate +(contact half-width|stick ratio|peak pressure|peak shear|dissipation|tension of lower body) \S+"
                    r"( mm| N| N/mm\^2)? \+- \S+ \(\S+ %\), order ",
                    run.stdout,
                    re.MULTILINE,
                )
            )
            == 6
        ), run.stdout
        assert "from meshes with 43, 35, 31 nodes in place of 61" in run.stdout
    with h5py.File(tmp_path / "key.h5") as result, h5py.File(tmp_path / "option.h5") as other:
        estimate = result["error_estimate"]
        names = ("contact_half_width", "stick_ratio", "peak_pressure", "peak_shear", "dissipation", "lower_tension")
        # Every observable but prescribed forces and counts.
        quantities = {name.removesuffix("_error") for name in estimate if name.endswith("_error")}
        assert set(estimate) == {"nodes", "companion_nodes"} | {
            name + end for name in quantities for end in ("", "_error", "_order", "_companions")
        }
        assert quantities == {
            *names, "contact_length", "contact_centre", "approach", "shift", "lower_tension_x", "largest_lower_tension",
            "largest_lower_tension_x", "largest_pressure", "largest_pressure_x", "largest_shear", "largest_shear_x", "smallest_stick_ratio",
            "largest_stick_ratio", "largest_slip_range", "largest_slip_range_x", "half_width_number", "pressure_number", "shear_number",
            *(f"{side}_{name}" for side in ("left", "right") for name in (
                "normal_intensity", "shear_intensity", "slip_zone", "asymptotic_slip_zone", "edge_reach",
            )),
        }  # fmt: skip
        for name, dataset in estimate.items():
            assert dataset.attrs["units"] and dataset.attrs["long_name"]
            np.testing.assert_array_equal(dataset[()], other["error_estimate"][name][()])
        assert estimate["stick_ratio_companions"].dims[0][0] == estimate["companion_nodes"]
        assert estimate["contact_half_width_error"].attrs["units"] == "mm"
        for name in quantities:
            assert estimate[name][()] == result["observables"][name][()]
        assert abs(estimate["stick_ratio"][()] - 0.6**0.5) < 2 * estimate["stick_ratio_error"][()] < 2e-3
        assert result.attrs["error_estimate"] == "yes"
    shown = subprocess.run(
        [sys.executable, "-m", "mfv", "info", "key.h5"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        env={**os.environ, "PYTHONPATH": str(ROOT / "python")},
    )
    assert "error estimate" in shown.stdout and "peak_shear" in shown.stdout, shown.stderr


def test_sensitivity_in_summary_and_file(tmp_path):
    by_key = case(tmp_path, MINDLIN.format(force=2.8e-4, name="key", more=", sensitivity=.true."), "key.nml")
    by_option = case(tmp_path, MINDLIN.format(force=2.8e-4, name="option", more=""), "option.nml")
    for run in [mfv_run(by_key, cwd=tmp_path), mfv_run("--sensitivity", by_option, cwd=tmp_path)]:
        assert run.returncode == COMPLETE and run.stderr == ""
        assert re.search(
            r"^sensitivity +coefficients of friction times 1 \+ 1e-12 change pressures by \S+ and shear by \S+ of the "
            r"largest traction,\nsensitivity +dissipation by \S+ \(relative\), the stick ratio by \S+$",
            run.stdout,
            re.MULTILINE,
        ), run.stdout
    with h5py.File(tmp_path / "key.h5") as result, h5py.File(tmp_path / "option.h5") as other:
        for name, dataset in result["sensitivity"].items():
            assert dataset.attrs["units"] == "1" and dataset.attrs["long_name"]
            assert dataset[()] == other["sensitivity"][name][()]
    refused = case(tmp_path, re.sub("&friction.*", "", MINDLIN.format(force=0, name="none", more="")), "none.nml")
    run = mfv_run("--sensitivity", refused, cwd=tmp_path)
    assert run.returncode == 2 and "none.nml: --sensitivity: the case has no friction to perturb" in run.stderr


def test_no_error_estimate_of_what_ended_early(tmp_path):
    path = case(tmp_path, MINDLIN.format(force=8e-4, name="early", more=", error_estimate=.true."))
    run = mfv_run(path, cwd=tmp_path)
    assert run.returncode == EARLY and "error estimate      none: the run did not complete" in run.stdout
    with h5py.File(tmp_path / "early.h5") as result:
        assert "error_estimate" not in result
        assert result.attrs["error_estimate"] == "none: the run did not complete"


def test_interrupted_error_estimate_keeps_the_result(tmp_path):
    text = MINDLIN.format(force=2.8e-4, name="long", more=", history='none', states='steps'").replace("nodes=61", "nodes=41")
    path = case(tmp_path, text.replace("&output", "&step tangential_force=-2.8e-4, cycles=6000 /\n&output"))
    before = os.times().children_user
    assert mfv_run(path, cwd=tmp_path).returncode == COMPLETE
    alone = os.times().children_user - before
    (tmp_path / "long.h5").unlink()
    process = subprocess.Popen(
        [PROGRAM, "--estimate", str(path)], cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    wait_for_work(process, 1.4 * alone)
    process.send_signal(signal.SIGINT)
    output, errors = process.communicate(timeout=60)
    with h5py.File(tmp_path / "long.h5") as result:
        if process.returncode == COMPLETE:  # it was faster than this test
            return
        assert process.returncode == 130, errors
        assert "summary" in result and "error_estimate" not in result
        assert result.attrs["error_estimate"].endswith(("interrupted", "ended early"))
        assert "error estimate      none: " in output


@pytest.mark.parametrize("thickness", [0.002, 0.0063])
def test_advice_resolves_the_layers(tmp_path, thickness):
    """No mesh is proposed that a run warns of, although far fewer nodes give the error that is asked for."""
    text = f"""&body shape='half_plane', youngs_modulus=70000, poisson_ratio=0.33 /
&layer body=1, thickness={thickness}, youngs_modulus=300000, poisson_ratio=0.2 /
&body shape='disk', radius=10, youngs_modulus=210000, poisson_ratio=0.3 /
&friction law='coulomb', mu=0.3 /
&step normal_force=50 /
&step force_ratio=0.6 /
"""
    advice = mfv_run("--advise", "error=5e-2", case(tmp_path, text).name, cwd=tmp_path)
    assert advice.returncode == COMPLETE
    advised = mfv_run(case(tmp_path, text + advice.stdout, "advised.nml").name, cwd=tmp_path)
    assert advised.returncode == COMPLETE and "intervals thick" not in advised.stdout
    coarse = mfv_run(case(tmp_path, text + "&mesh nodes=41 /\n", "coarse.nml").name, cwd=tmp_path)
    assert "intervals thick" in coarse.stdout


def test_advice_can_be_pasted_and_holds(tmp_path):
    text = MINDLIN.format(force=2.8e-4, name="advised", more="").replace("&output", "&solver algorithm='mfv' /\n&output")
    path = case(tmp_path, text)
    run = mfv_run("--advise", "error=2e-2", path.name, cwd=tmp_path)
    assert run.returncode == COMPLETE and run.stderr == ""
    assert list(tmp_path.iterdir()) == [path]
    for word in (
        "case.nml, wanted error 0.02",
        "pairs of coarse meshes",
        "error with 61",
        "nodes needed",
        "pressure",
        "shear",
        "half_width",
        "stick_ratio",
        "dissipation",
        "(estimated)",
    ):
        assert word in run.stdout, run.stdout
    groups = [line for line in run.stdout.splitlines() if not line.startswith("!")]
    assert re.fullmatch(r"&mesh nodes=\d+, half_width=0.0127, gap='parabolic' /", groups[0])
    assert re.fullmatch(r"&solver linear_solver='\w+'.*, algorithm='mfv' /", groups[1])
    kept = [line for line in text.splitlines() if not line.startswith(("&mesh", "&solver"))]
    advised = case(tmp_path, "\n".join([*kept, run.stdout]), "advised.nml")
    assert mfv_run(advised.name, cwd=tmp_path).returncode == COMPLETE
    with h5py.File(tmp_path / "advised.h5") as result:
        state, closed, summary = result["state"], result["reference"], result["summary"]
        for name in ("pressure", "shear"):
            assert np.linalg.norm(state[name][:] - closed[name][:]) < 2e-2 * np.linalg.norm(closed[name][:])
        assert abs(summary["contact_half_width"][()] / closed["contact_half_width"][()] - 1) < 2e-2
        assert abs(summary["stick_ratio"][()] - 0.6**0.5) < 2e-2
    fewer = mfv_run("--advise", "of=pressure,dissipation", "error=2e-2", path.name, cwd=tmp_path).stdout
    assert "shear" not in fewer and "half_width  " not in fewer
    nodes = [int(re.search(r"&mesh nodes=(\d+)", advice)[1]) for advice in (fewer, run.stdout)]
    assert nodes[0] < nodes[1] < 200


@pytest.mark.parametrize(
    "arguments, message",
    [
        (("error=abc",), "--advise error=abc: must be a number above 0 and below 1, such as 1e-2"),
        (("error=",), "--advise error=: must be a number"),
        (("error=0",), "--advise error=0: must be a number above 0"),
        (("error=-1e-3",), "--advise error=-1e-3: must be a number above 0"),
        (("error=1",), "--advise error=1: must be a number above 0 and below 1"),
        (("error=nan",), "--advise error=nan: must be a number above 0"),
        (
            ("error=1e-2", "of=presure"),
            "--advise of=presure: 'presure' is not one of pressure,shear,half_width,stick_ratio,dissipation",
        ),
        ((), "--advise needs the wanted error, such as error=1e-2"),
        (("error=1e-2", "other.nml"), "--advise too many arguments: 'case.nml'"),
    ],
)
def test_wrong_wishes_for_advice(arguments, message, tmp_path):
    path = case(tmp_path, MINDLIN.format(force=2.8e-4, name="advised", more=""))
    run = mfv_run("--advise", *arguments, path.name, cwd=tmp_path)
    assert run.returncode == INPUT and message in run.stderr and run.stdout == ""


def test_no_advice_for_what_ends_early(tmp_path):
    path = case(tmp_path, MINDLIN.format(force=8e-4, name="early", more=""))
    run = mfv_run("--advise", "error=1e-2", path.name, cwd=tmp_path)
    assert run.returncode == EARLY and "case.nml: no advice: on a mesh of " in run.stderr and "gross sliding" in run.stderr


@pytest.mark.parametrize("arguments", [(), ("--chekc", "x.nml"), ("a.nml", "b.nml"), ("--check",), ("--estimate",)])
def test_wrong_arguments(arguments, tmp_path):
    run = mfv_run(*arguments, cwd=tmp_path)
    assert run.returncode == INPUT and "usage:" in run.stderr and run.stdout == ""


@pytest.mark.parametrize(
    "text, message",
    [
        (BODIES + "&stpe normal_force=1 /", "case.nml:3: &stpe: unknown group; did you mean &step?"),
        (BODIES + "&step normal_forse=1 /", "case.nml:3: &step normal_forse=1: unknown key; did you mean normal_force?"),
        (BODIES + "&step normal_force='much' /", "case.nml:3: &step normal_force='much': must be a number"),
        ("&step normal_force=1 /", "&body: exactly two are needed"),
        (BODIES.replace("0.25", "-0.25") + "&step normal_force=1 /", "case.nml:2: &body radius=-0.25: must be a number above 0"),
        (BODIES.replace("0.3 ", "0.6 ") + "&step normal_force=1 /", "case.nml:1: &body poisson_ratio=0.6: must be"),
        (BODIES + "&mesh nodes=0 / &step normal_force=1 /", "case.nml:3: &mesh nodes=0: must be"),
        (
            BODIES + "&step normal_force=1e-3 / &output file='no/such/folder/x.h5' /",
            "case.nml: &output file='no/such/folder/x.h5': no/such/folder/x.h5 cannot be written",
        ),
    ],
)
def test_bad_input_ends_with_a_message(text, message, tmp_path):
    path = case(tmp_path, text)
    run = mfv_run(path.name, cwd=tmp_path)
    assert run.returncode == INPUT
    assert message in run.stderr and run.stderr.startswith("case.nml:")
    assert run.stdout == "" and list(tmp_path.iterdir()) == [path]
    if "output" not in text:
        assert mfv_run("--check", path.name, cwd=tmp_path).returncode == INPUT


@pytest.mark.parametrize(
    "steps, outcome, message",
    [
        (
            "&friction law='coulomb', mu=0.7 / &step normal_force=1e-3, friction=.false. / &step tangential_force=8e-4 /",
            "gross sliding",
            "case.nml: &step 2 tangential_force=8e-4 not reached: gross sliding: every contact node slips",
        ),
        (
            "&mesh nodes=21, half_width=0.001 / &step normal_force=1e-3 /",
            "mesh exceeded",
            "case.nml: &step 1 normal_force=0.001 not reached: the contact reached the end of the mesh",
        ),
    ],
)
def test_early_ends_are_results(steps, outcome, message, tmp_path):
    run = mfv_run(case(tmp_path, BODIES + steps).name, cwd=tmp_path)
    assert run.returncode == EARLY
    assert message in run.stderr
    with h5py.File(tmp_path / "case.h5") as result:
        assert result.attrs["outcome"] == outcome
        assert message in result.attrs["message"]
        assert result["certificate/largest"][()] < 1e-10
    assert sorted(path.name for path in tmp_path.iterdir()) == ["case.h5", "case.nml"]


@pytest.mark.parametrize(
    "text",
    [
        "&scene coupling='goodman', plane='stress' / &body shape='half_plane', shear_modulus=1.0, poisson_ratio=-0.428 /"
        "&body shape='disk', radius=1.0, rigid=.true. / &mesh nodes=21, half_width=0.049291 / &friction law='coulomb', mu=0.7 /"
        "&step normal_force=0.00063458, tangential_force=0.0004129, cycles=2 /",
        "&body shape='half_plane', shear_modulus=1.0, poisson_ratio=-0.596 / &body shape='disk', radius=1.0, rigid=.true. /"
        "&mesh nodes=43, half_width=0.020276 / &friction law='coulomb', mu=0.3 /"
        "&step normal_force=0.00016664, tangential_force=-3.8765e-05 / &step tangential_force=3.4583e-05 / &step shift=-0.00014163 /",
    ],
)
def test_slip_to_both_sides_is_not_gross_sliding(text, tmp_path):
    """Pressed and sheared together: while few nodes are in contact, all of them slip, but not all against the force."""
    run = mfv_run(case(tmp_path, text).name, cwd=tmp_path)
    assert run.returncode == COMPLETE, run.stderr
    with h5py.File(tmp_path / "case.h5") as result:
        assert result["certificate/largest"][()] < 1e-11


def test_existing_results_survive_failed_runs(tmp_path):
    (tmp_path / "case.h5").write_text("precious")
    assert mfv_run(case(tmp_path, BODIES + "&step normal_force=-1 /").name, cwd=tmp_path).returncode == INPUT
    assert (tmp_path / "case.h5").read_text() == "precious"


def test_long_load_histories_fit_into_a_file(tmp_path):
    text = BODIES + (
        "&mesh nodes=3, half_width=0.01 / &friction law='coulomb', mu=0.7 / &step normal_force=1e-4 /"
        "&step tangential_force=2e-5, cycles=1500 / &output history='steps', states='reversals' /"
    )
    assert mfv_run(case(tmp_path, text).name, cwd=tmp_path).returncode == COMPLETE
    with h5py.File(tmp_path / "case.h5") as result:
        assert len(result["steps"]) == 3001


def test_other_files_are_not_replaced(tmp_path):
    path = case(tmp_path, BODIES + "&step normal_force=1e-3 / &output file='case.nml' /")
    before = path.read_text()
    run = mfv_run(path.name, cwd=tmp_path)
    assert run.returncode == INPUT and "is not an HDF5 file; not overwritten" in run.stderr
    assert path.read_text() == before
    path.write_text(BODIES + "&step normal_force=1e-3 /")
    assert mfv_run(path.name, cwd=tmp_path).returncode == COMPLETE
    assert mfv_run(path.name, cwd=tmp_path).returncode == COMPLETE


def test_profile_and_chosen_mesh(tmp_path):
    x = np.linspace(-0.1, 0.1, 401)
    np.savetxt(tmp_path / "profile.txt", np.column_stack([x, x**2 / 0.5]))
    bodies = BODIES.replace("shape='disk', radius=0.25", "shape='profile', file='profile.txt', interpolation='monotone_cubic'")
    profile = bodies.replace("nu=", "").replace("poisson_ratio=0.3", "poisson_ratio=0.3, datum=0.25")
    mesh = "&mesh nodes=101, half_width=0.0127{} / &step normal_force=1e-3 /"
    mfv_run(case(tmp_path, profile + mesh.format(""), "profile.nml").name, cwd=tmp_path)
    mfv_run(case(tmp_path, BODIES + mesh.format(", gap='parabolic'"), "disk.nml").name, cwd=tmp_path)
    with h5py.File(tmp_path / "profile.h5") as a, h5py.File(tmp_path / "disk.h5") as b:
        peak = b["state/pressure"][:].max()
        np.testing.assert_allclose(a["state/pressure"][:], b["state/pressure"][:], atol=1e-2 * peak)
    mfv_run(case(tmp_path, BODIES + "&step normal_force=1e-3 /", "chosen.nml").name, cwd=tmp_path)
    with h5py.File(tmp_path / "chosen.h5") as result:
        assert 70 < result["summary/contact_nodes"][()] < 95


def test_interrupt_leaves_a_readable_file(tmp_path):
    long = BODIES + (
        "&mesh nodes=161, half_width=0.0127 / &friction law='coulomb', mu=0.7 / &step normal_force=1e-3 /"
        "&step tangential_force=2e-4 / &step tangential_force=-2e-4, cycles=10000 /"
    )
    case(tmp_path, long)
    run = subprocess.Popen([PROGRAM, "case.nml"], cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    wait_for_work(run, 0.5)
    assert run.poll() is None
    run.send_signal(signal.SIGINT)
    output, errors = run.communicate(timeout=60)
    assert run.returncode == 130
    assert "interrupted" in output and "stopped on request" in errors
    with h5py.File(tmp_path / "case.h5") as result:
        assert result.attrs["outcome"] == "interrupted"
        assert result["certificate/largest"][()] < 1e-10


def test_progress_shows_on_a_terminal_only(tmp_path):
    text = BODIES + (
        "&mesh nodes=161, half_width=0.0127 / &friction law='coulomb', mu=0.7 / &step normal_force=1e-3 /"
        "&step tangential_force=2e-4, cycles=2 / &solver linear_solver='dgesv' /"
    )  # slow enough to be seen
    case(tmp_path, text)
    assert mfv_run("case.nml", cwd=tmp_path).stderr == ""
    seen = shown_on_a_terminal([PROGRAM, "--estimate", "case.nml"], cwd=tmp_path)
    assert re.search(rb"\r  \d+ %, load segment \d of 5", seen)
    assert re.search(rb"\r  coarser meshes: \d+ %, load segment \d+ of 15", seen)
    # Held up after a little work, so that it takes long enough for an estimate of the time left.
    wait = (
        "import signal, subprocess, sys, time; run = subprocess.Popen(sys.argv[1:]); time.sleep(0.3);"
        "run.send_signal(signal.SIGSTOP); time.sleep(2.0); run.send_signal(signal.SIGCONT); run.wait()"
    )
    seen = shown_on_a_terminal([sys.executable, "-c", wait, PROGRAM, "case.nml"], cwd=tmp_path)
    assert re.search(rb"\r  \d+ %, \d+ s left, load segment \d of 5, \d+ nodes in contact, \d+ stuck", seen)


def test_refined_meshes_resolve_small_slip_zones(tmp_path):
    call = [sys.executable, ROOT / "examples/microslip.py", "-o", tmp_path / "microslip.png"]
    run = subprocess.run(call, capture_output=True, text=True, timeout=300)
    assert run.returncode == 0, run.stderr
    equal, *refined = np.array([line.split() for line in run.stdout.splitlines()[1:]], dtype=float).T[1:]
    assert equal[0] > 0.3 and max(refined[0]) < 5e-3 and max(refined[1]) < 1e-3, run.stdout
    assert (tmp_path / "microslip.png").stat().st_size > 10000


def test_mesh_study_converges(tmp_path):
    run = subprocess.run(
        [sys.executable, ROOT / "examples/mesh_study.py", "--finest", "101", "-o", tmp_path / "study.png"],
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert run.returncode == 0, run.stderr
    orders = {row[1].strip(): float(row[-2]) for row in (line.split("|") for line in run.stdout.splitlines()[2:])}
    assert len(orders) == 10 and min(orders.values()) > 0.6, run.stdout
    assert orders["Mindlin: shift"] > 1.5 and orders["Mindlin: dissipation of a cycle"] > 1.5
    assert (tmp_path / "study.png").stat().st_size > 10000
