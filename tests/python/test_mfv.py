"""The Python package: the C interface through ctypes, results and files, pictures, the command line."""

from __future__ import annotations

import copy
import os
import pickle
import re
import subprocess
import sys
import threading
from pathlib import Path

import h5py
import numpy as np
import pytest

import mfv
from mfv import __main__ as command_line
from mfv import _library, errors
from mfv.commands import info

PROJECT = Path(__file__).resolve().parents[2]
MINDLIN = PROJECT / "examples" / "mindlin.nml"

HALF_PLANE = "&body shape='half_plane', shear_modulus=1.0, poisson_ratio=0.3 /\n"
DISK = "&body shape='disk', radius=0.25, rigid=.true. /\n"
MESH = "&mesh nodes=61, half_width=0.01225 /\n"
FRICTION = "&friction law='coulomb', mu=0.7 /\n"

SHEARED = (
    "&scene title='sheared', coupling='goodman' /\n"
    + HALF_PLANE
    + DISK
    + MESH
    + FRICTION
    + "&step normal_force=1.0e-3, friction=.false. /\n"
    + "&step tangential_force=2.8e-4 /\n"
    + "&step tangential_force=-1.0e-4 /\n"
)
SLIDING = SHEARED + "&step tangential_force=1.0e-3 /\n"
FRICTIONLESS = (
    "&scene title='pressed', length_unit='mm', force_unit='N' /\n" + HALF_PLANE + DISK + MESH + "&step normal_force=1.0e-3 /\n"
)
FLAT_PUNCH = (
    "&scene title='punch', coupling='goodman' /\n"
    + HALF_PLANE
    + "&body shape='flat_punch', half_width=0.4, rigid=.true. /\n"
    + "&mesh nodes=65, half_width=0.5 /\n"
    + FRICTION
    + "&step normal_force=1.0e-3 /\n"
)
NO_HISTORY = SHEARED + "&output history='none' /\n"
NO_STEPS = SHEARED[: SHEARED.index("&step")]


@pytest.fixture(scope="module")
def sheared() -> mfv.Result:
    """The sheared cylinder, run in this process."""
    return mfv.run(text=SHEARED)


def everything(result: mfv.Result) -> dict[str, np.ndarray]:
    """All values of a result by path."""
    groups = {name: getattr(result, name) for name in ["mesh", "scene", "state", "summary", "certificate", "history", "reference"]}
    groups.update({f"steps/{number:04d}": group for number, group in enumerate(result.steps, start=1)})
    return {f"{path}/{name}": group[name] for path, group in groups.items() for name in group}


def assert_same(first: mfv.Result, second: mfv.Result) -> None:
    """Two results are the same, digit for digit."""
    one, other = everything(first), everything(second)
    assert one.keys() == other.keys()
    for path in one:
        assert np.asarray(one[path]).tobytes() == np.asarray(other[path]).tobytes(), path


# --- errors, versions, the library ---


def test_exceptions_are_those_of_the_list_of_statuses() -> None:
    entries = re.findall(r'MFV_STATUS\(\w+, (\d+), \d+, "(.*?)", "(.*?)"\)', (PROJECT / "include" / "mfv_status.def").read_text())
    assert _library.statuses() == tuple((int(code), outcome, explanation) for code, outcome, explanation in entries)
    assert {kind.__name__ for kind in errors.failures().values()} == {
        "".join(word.capitalize() for word in outcome.split()) for code, outcome, _ in entries if code != "0"
    }
    assert errors.failures()[1] is errors.InputError
    assert issubclass(errors.GrossSliding, mfv.MfvError)
    with pytest.raises(AttributeError):
        errors.NoSuchStatus


def test_an_exception_survives_pickling() -> None:
    error = pickle.loads(pickle.dumps(errors.InputError(1, "why")))
    assert (type(error), error.status, str(error)) == (errors.InputError, 1, "why")


def test_versions_are_one() -> None:
    assert mfv.__version__ == mfv.library_version() == (PROJECT / "VERSION").read_text().strip()


def test_a_missing_library_is_missed_only_by_those_who_need_it(tmp_path: Path) -> None:
    path = tmp_path / "result.h5"
    mfv.run(text=SHEARED, output=path)
    script = f"""
import mfv
mfv.plot.figure(mfv.read({str(path)!r}))
try:
    mfv.run({str(MINDLIN)!r})
except mfv.LibraryNotFound as error:
    assert isinstance(error, ImportError) and "MFV_LIBRARY" in str(error)
else:
    raise SystemExit("it ran")
"""
    python_path = os.pathsep.join(filter(None, [str(Path(mfv.__file__).parents[1]), os.environ.get("PYTHONPATH")]))
    environment = {**os.environ, "MFV_LIBRARY": str(tmp_path / "nowhere.so"), "PYTHONPATH": python_path}
    subprocess.run([sys.executable, "-c", script], env=environment, check=True)
    subprocess.run([sys.executable, "-m", "mfv", "info", path], env=environment, check=True, capture_output=True)


def test_a_program_that_cannot_be_run_is_named(tmp_path: Path) -> None:
    """The program beside the library is a file that is not executable."""
    for name in ("lib/libmfv.so", "bin/mfv_run"):
        (tmp_path / name).parent.mkdir()
        (tmp_path / name).touch()
    environment = {**os.environ, "MFV_LIBRARY": str(tmp_path / "lib/libmfv.so")}
    environment["PYTHONPATH"] = os.pathsep.join(filter(None, [str(Path(mfv.__file__).parents[1]), os.environ.get("PYTHONPATH")]))
    done = subprocess.run([sys.executable, "-m", "mfv", "run", MINDLIN], env=environment, capture_output=True, text=True)
    assert done.returncode == 2 and done.stderr == f"mfv: {tmp_path}/bin/mfv_run: Permission denied\n"


# --- cases ---


def test_file_and_text_give_the_same_result() -> None:
    assert_same(mfv.run(MINDLIN), mfv.run(text=MINDLIN.read_text()))


def test_run_wants_one_case() -> None:
    with pytest.raises(TypeError):
        mfv.run()
    with pytest.raises(TypeError):
        mfv.run(MINDLIN, text=SHEARED)


def test_advancing_step_by_step_gives_the_digits_of_a_run(sheared: mfv.Result) -> None:
    with mfv.Case.from_text(SHEARED) as case:
        lead_as_sheared(case)
        assert_same(case.result(), sheared)


def test_a_case_without_steps_can_be_led_the_same_way(sheared: mfv.Result) -> None:
    with mfv.Case.from_text(NO_STEPS) as case:
        lead_as_sheared(case)
        assert list(case.result().reference) == list(sheared.reference)
        np.testing.assert_array_equal(case["state/status"], sheared.state.status)
        np.testing.assert_allclose(case["state/shear"], sheared.state.shear, rtol=0.0, atol=1e-12)
        np.testing.assert_allclose(case["state/slip"], sheared.state.slip, rtol=0.0, atol=1e-15)


def lead_as_sheared(case: mfv.Case) -> None:
    """The steps of the sheared cylinder, one by one."""
    assert case.advance(normal_force=1.0e-3, friction=False) == "complete"
    assert case.advance(tangential_force=2.8e-4) == "complete"
    assert case.advance(tangential_force=-1.0e-4) == "complete"
    assert case.message == "step 3 was reached"


def test_advancing_by_displacements_and_cycles(sheared: mfv.Result) -> None:
    with mfv.Case.from_text(SHEARED) as case:
        case.advance(approach=sheared.summary.approach, friction=False)
        assert case["summary/normal_force"] == pytest.approx(1.0e-3, rel=1e-9)
        case.advance(shift=sheared.steps[1].shift, cycles=2)
        assert len(case.result().steps) == 5
        assert case["steps/0004/tangential_force"] == pytest.approx(2.8e-4, rel=1e-9)


def test_the_closed_form_is_that_of_the_steps_taken() -> None:
    with mfv.Case.from_text(FLAT_PUNCH) as case:
        case.run()
        assert "shear" in case.result().reference
        case.advance(tangential_force=3.0e-4)
        assert "shear" not in case.result().reference


def test_a_result_is_a_copy() -> None:
    with mfv.Case.from_text(SHEARED) as case:
        case.advance(normal_force=5.0e-4, friction=False)
        before = case.result()
        kept = copy.deepcopy(before)
        case.advance(normal_force=1.0e-3, friction=False)
        assert_same(before, kept)
        assert case["summary/normal_force"] == pytest.approx(1.0e-3)
    assert_same(before, kept)


@pytest.mark.parametrize("text", [SHEARED, FRICTIONLESS, FLAT_PUNCH, SLIDING], ids=["sheared", "frictionless", "punch", "sliding"])
def test_every_field_is_that_of_the_file(text: str, tmp_path: Path) -> None:
    path = tmp_path / "result.h5"
    with mfv.Case.from_text(text) as case, h5py.File(_written(case, path)) as file:
        fields = case.fields()
        for field in fields:
            assert np.asarray(case[field]).tobytes() == file[field][()].tobytes(), field
            assert np.asarray(case[field]).dtype == file[field].dtype
            _group, _name = field.rsplit("/", 1)
        in_file: list[str] = []
        file.visititems(lambda name, item: in_file.append(name) if isinstance(item, h5py.Dataset) else None)
        assert set(in_file) <= {
            *fields,
            *(f"{field.rsplit('/', 1)[0]}/{scale}" for field in fields for scale in ("x", "record")),
        }


def _written(case: mfv.Case, path: Path) -> Path:
    case.run()
    case.write(path)
    return path


@pytest.mark.parametrize("text", [SHEARED, NO_HISTORY, FRICTIONLESS], ids=["sheared", "no history", "frictionless"])
def test_what_is_read_is_what_was_run(text: str, tmp_path: Path) -> None:
    path = tmp_path / "result.h5"
    ran = mfv.run(text=text, output=path)
    read = mfv.read(path)
    assert_same(ran, read)
    assert (read.outcome, read.message) == (ran.outcome, ran.message)
    assert read.state.unit("pressure") == ran.state.unit("pressure")
    assert read.state.description("slip") == ran.state.description("slip")
    assert read.title in ("sheared", "pressed")


def test_codes_are_those_of_the_file(tmp_path: Path) -> None:
    mfv.run(text=SHEARED, output=tmp_path / "result.h5")
    with h5py.File(tmp_path / "result.h5") as file:
        for field, codes in (
            ("state/status", mfv.NodeStatus),
            ("steps/0001/status", mfv.NodeStatus),
            ("history/event_kind", mfv.EventKind),
        ):
            flags = dict(zip(file[field].attrs["flag_meanings"].split(), file[field].attrs["flag_values"]))
            assert flags == {code.name.lower(): code.value for code in codes}


def test_bad_input_is_an_input_error_that_names_the_key() -> None:
    with pytest.raises(errors.InputError, match="poisson_ratio") as caught:
        mfv.run(text=SHEARED.replace("0.3", "0.7"))
    assert caught.value.status == 1
    with pytest.raises(errors.InputError, match="no_such_file.nml"):
        mfv.run("no_such_file.nml")
    with pytest.raises(ValueError, match="null character"):
        mfv.Case.from_text("&scene\0/")


def test_gross_sliding_is_a_result_unless_it_must_not_be(tmp_path: Path) -> None:
    result = mfv.run(text=SLIDING)
    assert result.outcome == "gross sliding"
    assert "&step 4 tangential_force" in result.message
    assert result.summary.stick_nodes == 0
    assert result.summary.tangential_force == pytest.approx(7.0e-4)
    with pytest.raises(errors.GrossSliding, match="&step 4 tangential_force"):
        mfv.run(text=SLIDING, output=tmp_path / "sliding.h5", check=True)
    assert mfv.read(tmp_path / "sliding.h5").outcome == "gross sliding"
    with mfv.Case.from_text(SLIDING) as case:
        assert case.run() == "gross sliding"
        with pytest.raises(errors.GrossSliding):
            case.run(check=True)
        with pytest.raises(errors.GrossSliding):
            case.advance(tangential_force=0.0, check=True)


def test_bad_arguments_leave_the_case_as_it_was() -> None:
    with mfv.Case.from_text(SHEARED) as case:
        with pytest.raises(errors.BadArgument, match="must not be negative"):
            case.advance(normal_force=-1.0)
        with pytest.raises(errors.BadArgument, match="not finite"):
            case.advance(shift=float("nan"))
        with pytest.raises(TypeError, match="not both"):
            case.advance(normal_force=1.0, approach=1.0)
        with pytest.raises(KeyError, match="state/pressur"):
            case["state/pressur"]
        assert case.outcome == "complete"
        assert case.run() == "complete"


def test_a_file_that_cannot_be_written_is_a_file_error(tmp_path: Path) -> None:
    with pytest.raises(errors.FileError, match="nowhere"):
        mfv.run(text=SHEARED, output=tmp_path / "nowhere" / "result.h5")
    with mfv.Case.from_text(SHEARED) as case, pytest.raises(errors.FileError, match="nowhere"):
        case.write(tmp_path / "nowhere" / "result.h5")


def test_two_threads_give_the_digits_of_one(sheared: mfv.Result, tmp_path: Path) -> None:
    texts = [SHEARED, FLAT_PUNCH] * 3
    results: list[mfv.Result | None] = [None] * len(texts)

    def work(number: int) -> None:
        results[number] = mfv.run(text=texts[number], output=tmp_path / f"{number}.h5")

    threads = [threading.Thread(target=work, args=(number,)) for number in range(len(texts))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    alone = {SHEARED: sheared, FLAT_PUNCH: mfv.run(text=FLAT_PUNCH)}
    for number, text in enumerate(texts):
        assert_same(results[number], alone[text])
        assert_same(mfv.read(tmp_path / f"{number}.h5"), alone[text])


def test_a_closed_case_is_closed() -> None:
    case = mfv.Case.from_text(SHEARED)
    case.close()
    case.close()
    assert "closed" in repr(case)
    for use in (
        case.run,
        case.fields,
        case.result,
        lambda: case["mesh/x"],
        lambda: case.advance(shift=0.0),
        lambda: case.write("x.h5"),
    ):
        with pytest.raises(errors.BadHandle):
            use()
    assert not Path("x.h5").exists()


# --- results ---


def test_a_group_is_attributes_and_items(sheared: mfv.Result) -> None:
    assert sheared.state.pressure is sheared.state["pressure"]
    assert "pressure" in sheared.reference and "nothing" not in sheared.reference
    assert "pressure" in dir(sheared.state)
    assert "compressive" in sheared.state.description("pressure") and "compressive" in repr(sheared.state)
    assert "complete" in repr(sheared)
    with pytest.raises(AttributeError, match="pressure"):
        sheared.state.nothing


def test_a_result_without_closed_form_and_history_has_empty_groups() -> None:
    result = mfv.run(text=NO_HISTORY.replace("'goodman'", "'full'"))
    assert len(result.history) == 0 and len(result.reference) == 0
    assert "complete" in repr(result)


def test_the_state_of_the_last_step_is_the_state(sheared: mfv.Result) -> None:
    assert len(sheared.steps) == 3
    for name in sheared.state:
        np.testing.assert_array_equal(sheared.steps[-1][name], sheared.state[name])


def test_xarray_finds_coordinates(tmp_path: Path) -> None:
    xarray = pytest.importorskip("xarray")
    pytest.importorskip("h5netcdf")
    mfv.run(text=SHEARED, output=tmp_path / "result.h5")
    for group, coordinate in (
        ("state", "x"),
        ("steps/0001", "x"),
        ("mesh", "x"),
        ("history", "record"),
        ("reference", "x"),
    ):
        with xarray.open_dataset(tmp_path / "result.h5", engine="h5netcdf", group=group) as dataset:
            assert coordinate in dataset.coords


# --- closed forms ---


def test_closed_forms_are_those_of_the_result(sheared: mfv.Result) -> None:
    scene, loads = sheared.scene, sheared.summary
    half_width = mfv.reference.hertz_half_width(
        loads.normal_force, scene.upper_radius, scene.lower_shear_modulus, scene.lower_kolosov_constant
    )
    assert half_width == pytest.approx(sheared.reference.contact_half_width)
    np.testing.assert_allclose(
        mfv.reference.hertz_pressure(sheared.mesh.x, loads.normal_force, half_width), sheared.reference.pressure
    )
    assert mfv.reference.mindlin_stick_ratio(2.8e-4, 1.0e-3, 0.7) == pytest.approx(np.sqrt(0.6))
    assert np.isnan(mfv.reference.hertz_pressure(0.0, 1.0, -1.0))


def test_closed_forms_take_arrays() -> None:
    x = np.array([[-0.5], [0.0], [0.3]])
    shear = mfv.reference.mindlin_shear(x, [0.0, 0.2], 1.0, 1.0, 0.5)
    assert shear.shape == (3, 2)
    np.testing.assert_allclose(shear[:, 0], 0.0, atol=1e-15)
    assert shear[1, 1] == mfv.reference.mindlin_shear(0.0, 0.2, 1.0, 1.0, 0.5)
    assert mfv.reference.flat_punch_pressure(0.0, 1.0, 2.0) == pytest.approx(1.0 / (2.0 * np.pi))
    assert 0.0 < mfv.reference.spence_stick_ratio(0.3, 0.2) < 1.0
    assert mfv.reference.spence_cylinder_shear(0.5, 1.0, 1.0, 0.3, 0.2) == -mfv.reference.spence_cylinder_shear(
        -0.5, 1.0, 1.0, 0.3, 0.2
    )
    assert mfv.reference.spence_flat_punch_shear(0.0, 1.0, 1.0, 0.3, 0.2) == pytest.approx(0.0, abs=1e-12)
    assert mfv.reference.mindlin_dissipation(0.2, 1.0, 1.0, 10.0, 0.5) > 0.0


# --- pictures and the command line ---


@pytest.mark.parametrize(
    ("text", "panels"),
    [(MINDLIN.read_text(), 4), (SLIDING, 3), (FRICTIONLESS, 2), (FLAT_PUNCH, 2), (NO_HISTORY, 2)],
    ids=["mindlin", "sliding", "frictionless", "punch", "no history"],
)
def test_plot_draws(text: str, panels: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    mfv.run(text=text, output=tmp_path / "x.h5")
    assert command_line.main(["plot", str(tmp_path / "x.h5")]) == 0
    assert capsys.readouterr().out.strip() == str(tmp_path / "x.png")
    picture = (tmp_path / "x.png").read_bytes()
    assert picture.startswith(b"\x89PNG") and len(picture) > 20000
    assert len(mfv.plot.figure(mfv.read(tmp_path / "x.h5")).axes) == panels
    assert command_line.main(["plot", str(tmp_path / "x.h5"), "--step", "1", "-o", str(tmp_path / "y.svg")]) == 0
    assert b"<svg" in (tmp_path / "y.svg").read_bytes()


def test_a_case_that_was_not_run_can_be_drawn() -> None:
    with mfv.Case.from_text(SHEARED) as case:
        assert len(mfv.plot.figure(case.result()).axes) == 2


def test_panels_show_numbers_and_closed_forms(sheared: mfv.Result) -> None:
    picture = mfv.plot.figure(sheared)
    for ax in picture.axes:
        assert {"computed", "closed form"} <= set(ax.get_legend_handles_labels()[1])
    (computed,) = (line for line in picture.axes[0].lines if line.get_label() == "computed")
    np.testing.assert_array_equal(computed.get_ydata(), sheared.state.pressure)
    assert {"stick", "lower surface slips to the right"} <= set(picture.axes[1].get_legend_handles_labels()[1])


def test_the_closed_form_of_the_shear_is_drawn_for_its_own_state_only(sheared: mfv.Result) -> None:
    assert "closed form" in mfv.plot.figure(sheared, 3).axes[1].get_legend_handles_labels()[1]
    second = mfv.plot.figure(sheared, 2)
    assert "closed form" in second.axes[0].get_legend_handles_labels()[1]
    assert "closed form" not in second.axes[1].get_legend_handles_labels()[1]


def test_units_are_shown_where_the_user_named_them(sheared: mfv.Result) -> None:
    assert "[" not in mfv.plot.figure(sheared).axes[0].get_ylabel()
    assert mfv.plot.figure(mfv.run(text=FRICTIONLESS)).axes[0].get_ylabel().endswith("[N/mm$^2$]")


def test_info_tells_what_is_there(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    mfv.run(text=SHEARED, output=tmp_path / "x.h5")
    assert command_line.main(["info", str(tmp_path / "x.h5")]) == 0
    printed = capsys.readouterr().out
    for word in ("sheared", "complete", "stick_ratio", "Hertz", "61 nodes", "3 states"):
        assert word in printed


def test_unusable_input_ends_with_one_line_and_code_2(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    mfv.run(text=SHEARED, output=tmp_path / "x.h5")
    (tmp_path / "text.h5").write_text("no HDF5\n")
    with h5py.File(tmp_path / "other.h5", "w") as file:
        file["data"] = 1
    good = str(tmp_path / "x.h5")
    for arguments, complaint in (
        (["plot", str(tmp_path / "missing.h5")], "No such file"),
        (["info", str(tmp_path / "text.h5")], "not a result file"),
        (["plot", str(tmp_path / "other.h5")], "not a result file"),
        (["info", str(tmp_path)], "directory"),
        (["plot", good, "--step", "9"], "no state 9"),
        (["plot", good, "--step", "0"], "no state 0"),
        (["plot", good, "-o", str(tmp_path / "nowhere" / "x.png")], "nowhere"),
        (["plot", good, "-o", str(tmp_path / "x.tiffany")], "tiffany"),
    ):
        assert command_line.main(arguments) == 2, arguments
        printed = capsys.readouterr()
        assert complaint in printed.err and printed.err.count("\n") == 1 and printed.out == ""


CYCLES = """
&scene coupling='full', title='loop' /
&body shape='half_plane', shear_modulus=1.0, poisson_ratio=0.0 /
&body shape='disk', radius=0.25, rigid=.true. /
&mesh nodes=61, half_width=0.0127 /
&friction law='coulomb', mu=0.7 /
&step normal_force=0.5e-3 /
&step force_ratio=0.65 /
&step force_ratio=-0.65, cycles=3 /
"""


def area(force: np.ndarray, displacement: np.ndarray) -> float:
    """Work of a force on a displacement; both are linear between records."""
    return float(np.sum(0.5 * (force[1:] + force[:-1]) * np.diff(displacement)))


def test_cycles_of_a_result_and_their_picture(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    result = mfv.run(text=CYCLES, output=tmp_path / "x.h5")
    read = mfv.read(tmp_path / "x.h5")
    for cycles, seen in ((result.cycles, result.observables), (read.cycles, read.observables)):
        assert list(cycles.cycle) == [1, 2, 3] and cycles.dissipation.size == 3
        assert seen.cycle_dissipation == cycles.dissipation[-1] < cycles.dissipation[0]
        assert seen.force_number == pytest.approx(0.65)
    # The loop has the area that is dissipated, with its linear part and without: the work of Q on U over the last cycle, P on
    # the approach aside.
    history = read.history
    ends = np.flatnonzero(history.event_kind == mfv.EventKind.STEP_END)
    last = slice(ends[-3], ends[-1] + 1)
    areas = [area(history.tangential_force[last], history[name][last]) for name in ("shift", "nonlinear_shift")]
    lift = area(history.normal_force[last], history.approach[last])
    assert areas[0] == pytest.approx(areas[1], rel=1e-9)
    assert areas[0] + lift == pytest.approx(read.cycles.dissipation[-1], rel=1e-9)
    work = read.cycles.friction_work
    assert np.dot(work, read.mesh.width) == pytest.approx(read.cycles.dissipation[-1], rel=1e-9)

    assert command_line.main(["plot", str(tmp_path / "x.h5"), "--cycles"]) == 0
    assert (tmp_path / "x_cycles.png").stat().st_size > 10000
    assert command_line.main(["info", str(tmp_path / "x.h5")]) == 0
    assert "loss_factor" in capsys.readouterr().out
    mfv.run(text=CYCLES.replace(", cycles=3", ""), output=tmp_path / "y.h5")
    assert command_line.main(["plot", str(tmp_path / "y.h5"), "--cycles"]) == 2
    assert "this result has no cycles" in capsys.readouterr().err


def test_a_python_without_the_needed_packages_ends_with_a_message(tmp_path: Path) -> None:
    environment = {**os.environ, "PYTHONPATH": str(PROJECT / "python")}
    for arguments, beginning in (("-m", "mfv"), "mfv: "), (("-c", "import mfv"), "Traceback"):
        done = subprocess.run([sys.executable, "-S", *arguments], env=environment, cwd=tmp_path, capture_output=True, text=True)
        assert done.returncode == (2 if beginning == "mfv: " else 1) and done.stderr.startswith(beginning), done.stderr
        assert f"{sys.executable} does not have the Python packages numpy, h5py, f90nml: " in done.stderr
        assert done.stdout == ""


@pytest.mark.parametrize("arguments", [["--step"], ["draw"], ["plot"], ["plot", "x.h5", "--step", "two"]])
def test_a_wrong_command_line_ends_with_code_2(arguments: list[str]) -> None:
    with pytest.raises(SystemExit) as caught:
        command_line.main(arguments)
    assert caught.value.code == 2


def test_help_teaches(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as caught:
        command_line.main(["--help"])
    assert caught.value.code == 0
    assert "mfv plot mindlin.h5" in capsys.readouterr().out


def test_the_module_runs_as_a_program(tmp_path: Path) -> None:
    ended = subprocess.run(
        [sys.executable, "-m", "mfv", "info", str(tmp_path / "missing.h5")],
        env={**os.environ, "PYTHONPATH": str(Path(mfv.__file__).parents[1])},
        capture_output=True,
        text=True,
    )
    assert ended.returncode == 2 and ended.stderr.startswith("mfv: ")


TWO_DISKS = (
    "&scene title='two disks' /\n"
    "&body shape='disk', radius=3, youngs_modulus=200e3, poisson_ratio=0.3 /\n"
    "&body shape='disk', radius=3, youngs_modulus=200e3, poisson_ratio=0.3, yield_strength=250 /\n"
    "&mesh nodes=101, half_width=0.0152 /\n"
    "&friction law='coulomb', mu=0.7 /\n"
    "&step normal_force=8.24 /\n"
    "&step tangential_force=2.74 /\n"
)


@pytest.fixture(scope="module")
def two_disks() -> mfv.Result:
    return mfv.run(text=TWO_DISKS)


def test_stresses_on_the_surface_are_the_tractions(two_disks: mfv.Result) -> None:
    node = int(np.argmax(two_disks.state.pressure))
    x = two_disks.mesh.x[node]
    y = -(x**2) / (3.0 + np.sqrt(9.0 - x**2))
    below = mfv.stress.stress(two_disks, x, y)
    above = mfv.stress.stress(two_disks, x, -y, body="upper")
    for field in (below, above):
        assert field["sigma_rr"] == pytest.approx(field["sigma_yy"], rel=1e-3)
        assert field["sigma_zz"] == pytest.approx(0.3 * (field["sigma_xx"] + field["sigma_yy"]), rel=1e-12)
        mean = 0.5 * (field["principal_1"] + field["principal_2"])
        assert mean == pytest.approx(0.5 * (field["sigma_xx"] + field["sigma_yy"]), rel=1e-12)
    assert np.isnan(mfv.stress.stress(two_disks, 0.0, 0.1)["von_mises"])
    assert mfv.stress.stress(two_disks, np.zeros((2, 1)), [-0.1, -0.2, -0.3])["von_mises"].shape == (2, 3)


def test_stresses_on_the_surface_converge_to_the_tractions() -> None:
    # Nodal values are means over intervals and stresses those of continuous tractions, so they differ by the square of the interval.
    errors = []
    for nodes in (51, 201):
        result = mfv.run(text=TWO_DISKS.replace("nodes=101", f"nodes={nodes}"))
        middle = np.abs(result.mesh.x) < 0.006
        x, pressure, shear = result.mesh.x[middle], result.state.pressure[middle], result.state.shear[middle]
        y = -(x**2) / (3.0 + np.sqrt(9.0 - x**2))
        found = []
        for body, side in (("lower", 1.0), ("upper", -1.0)):
            at = mfv.stress.stress(result, x, side * y, body=body)
            across, up = x / 3.0, side * (1.0 + y / 3.0)
            found.append(at["sigma_xx"] * across + at["sigma_xy"] * up - side * shear)
            found.append(at["sigma_xy"] * across + at["sigma_yy"] * up + side * pressure)
        errors.append(np.max(np.abs(found)) / pressure.max())
    # Below 2e-5 the difference is that of the linear elements.
    assert errors[0] < 1e-4 and errors[1] < 2e-5


def test_largest_von_mises_is_not_missed_by_grids(two_disks: mfv.Result) -> None:
    pressed = mfv.stress.grid(two_disks, step=1, across=301, down=151)
    assert pressed.largest.y / pressed.half_width == pytest.approx(-0.70, abs=0.02)
    assert np.nanmax(pressed["von_mises"]) <= pressed.largest.value * (1 + 1e-9)
    assert np.nanmax(pressed["von_mises"]) == pytest.approx(pressed.largest.value, rel=1e-3)
    sheared = mfv.stress.grid(two_disks)
    assert sheared.largest.x / sheared.half_width == pytest.approx(0.82, abs=0.025)


@pytest.mark.parametrize("degrees", [15.0, 30.0, 60.0])
def test_largest_von_mises_in_a_pin(degrees: float) -> None:
    """Against points along the axis; in wide contacts it is at the depth of half the radius, the deepest one searched, not on the surface."""
    steel = {"youngs_modulus": 7.0e4, "poisson_ratio": 0.3}
    hole = mfv.Body.hole(10.1, **steel)
    force = float(mfv.reference.persson_force(np.radians(degrees), 0.1, 7.0e4, 0.3))
    mesh = mfv.Mesh(nodes=101, half_angle=1.3 * degrees + 2.0, normals="radial")

    def pressed(strength: float) -> mfv.Result:
        pin = mfv.Body.disk(10.0, yield_strength=strength, **steel)
        return mfv.Scene(hole, pin, mesh=mesh, steps=[mfv.Step(normal_force=force)]).run()

    result = pressed(1.0e6)
    depth = np.linspace(0.03, 5.0, 200)
    axis = mfv.stress.stress(result, 0.0 * depth, depth, body="upper")
    largest = axis.largest.value
    assert largest >= np.max(axis["von_mises"]) * (1 - 1e-9)
    assert largest == pytest.approx(np.max(axis["von_mises"]), rel=1e-3)
    assert (axis.largest.y == pytest.approx(5.0, rel=0.01)) == (degrees > 20.0)
    for strength, part in ((0.9, "von Mises stress of the upper body"), (1.1, "")):
        warnings = pressed(strength * largest).attributes["warnings"]
        assert ("yield_strength" in warnings) == bool(part) and part in warnings


@pytest.mark.parametrize("nodes", [51, 401])
def test_von_mises_is_unbounded_at_a_sharp_corner(nodes: int) -> None:
    """The pressure diverges at the corners of a punch; with rounded edges it does not."""
    plane = mfv.Body.half_plane(youngs_modulus=7.0e4, poisson_ratio=0.3, yield_strength=1.0e6)
    rounded = mfv.Body.rounded_punch(0.5, 1.0, rigid=True)
    results = [
        mfv.Scene(plane, punch, mesh=mfv.Mesh(nodes=nodes), steps=[mfv.Step(normal_force=100.0)]).run()
        for punch in (mfv.Body.flat_punch(1.0), rounded)
    ]
    largest = [mfv.stress.stress(result, [0.0], [-0.1]).largest for result in results]
    assert np.isnan(largest[0].value) and np.isnan(largest[0].x)
    assert "unbounded at a sharp corner" in results[0].attributes["warnings"]
    assert largest[1].value > 0.0 and "corner" not in results[1].attributes["warnings"]


#: Fretting of an aluminium alloy: a flat specimen and a pad of the radius 10 mm.
FRETTING = """&body shape='half_plane', youngs_modulus=72100.0, poisson_ratio=0.33 /
&body shape='disk', radius=10.0, youngs_modulus=72100.0, poisson_ratio=0.33 /
&friction law='coulomb', mu=0.85 /
&mesh nodes={nodes} /
&step normal_force=135.75, friction=.false. /
&step {shear} /
"""
P0 = 2 * 135.75 / np.pi / 0.20669766271067924


@pytest.mark.parametrize("nodes, part", [(101, 2e-3), (401, 5e-4)])
def test_largest_tension_is_that_of_cattaneo_and_mindlin(nodes: int, part: float) -> None:
    result = mfv.run(text=FRETTING.format(nodes=nodes, shear="tangential_force=38.79"))
    exact = 2.0 * P0 * np.sqrt(0.85 * 38.79 / 135.75)
    assert result.observables.lower_tension == pytest.approx(exact, rel=part)
    assert result.observables.lower_tension_x == pytest.approx(-0.20669766, rel=2e-3)
    # The disk is round: of the order of a/R less, and at its other edge.
    assert result.observables.upper_tension == pytest.approx(exact, rel=0.02)
    assert result.observables.upper_tension_x == pytest.approx(0.20669766, rel=2e-3)
    # There is no spike on the surface or just below, where the closed form holds but for the edges, nor one interval below.
    x = np.linspace(-0.3, 0.3, 4001)
    for depth in (0.0, 1e-9, float(result.mesh.interval)):
        along = mfv.stress.stress(result, x, -depth)["sigma_xx"]
        assert along.max() <= result.observables.lower_tension * (1 + 1e-6)
        away = np.min(np.abs(np.abs(x)[:, None] - np.array([0.16840, 0.20670])), axis=1) > 0.004
        if depth < 1e-6:
            assert along[away] == pytest.approx(_cattaneo_mindlin(x)[away], abs=0.01 * exact)
        assert np.abs(np.diff(along, 2))[away[1:-1]].max() < 0.006 * exact
    sliding = mfv.run(text=FRETTING.format(nodes=nodes, shear="shift=0.02"))
    assert sliding.observables.lower_tension == pytest.approx(2.0 * 0.85 * P0, rel=part)


@pytest.mark.parametrize(
    "shear, exact", [("tangential_force=38.79", 2.0 * np.sqrt(0.85 * 38.79 / 135.75)), ("shift=0.03", 2.0 * 0.85)]
)
def test_largest_tension_converges(shear: str, exact: float) -> None:
    # Without coupling under a rigid parabola, where the closed form of the half-plane holds; the error depends on where between
    # the nodes the edges are, so it is the root mean square over meshes that are longer by parts of an interval.
    modulus = 72100.0 / (1.0 - 0.33**2)
    half_width = np.sqrt(4.0 * 135.75 * 10.0 / (np.pi * modulus))
    exact *= 2.0 * 135.75 / (np.pi * half_width)
    lower, _, friction, *_, press, end = FRETTING.splitlines()
    errors = []
    for nodes in (51, 201):
        found = []
        for part in (0.0, 0.25, 0.5, 0.75):
            mesh = f"&mesh gap='parabolic', nodes={nodes}, half_width={1.25 * half_width * (1.0 + 2.5 * part / (nodes - 1))} /"
            bodies = (lower, "&body shape='disk', radius=10.0, rigid=.true. /", "&scene coupling='none' /")
            text = "\n".join((*bodies, mesh, friction, press, end.format(shear=shear), ""))
            found.append(mfv.run(text=text).observables.lower_tension / exact - 1.0)
        errors.append(np.sqrt(np.mean(np.square(found))))
    assert errors[0] < 3e-4
    assert np.log(errors[0] / errors[1]) / np.log(4.0) > 1.5


def _cattaneo_mindlin(x: np.ndarray) -> np.ndarray:
    """sigma_xx on the surface of the specimen (Johnson 1985, eqs. 2.30 and 7.28)."""
    a, mu = 0.20669766271067924, 0.85
    c = a * np.sqrt(1.0 - 38.79 / (mu * 135.75))

    def ellipse(half: float) -> np.ndarray:
        z = x / half
        return -2.0 * (z - np.sign(z) * np.sqrt(np.maximum(z * z - 1.0, 0.0)))

    return P0 * (mu * (ellipse(a) - c / a * ellipse(c)) - np.sqrt(np.maximum(1.0 - (x / a) ** 2, 0.0)))


def test_largest_tension_is_mirrored_swapped_and_scaled() -> None:
    def tensions(text: str) -> np.ndarray:
        seen = mfv.run(text=text).observables
        return np.array([seen[f"{body}_tension{place}"] for body in ("lower", "upper") for place in ("", "_x")])

    case = FRETTING.format(nodes=41, shear="tangential_force=38.79")
    here = tensions(case)
    assert tensions(case.replace("=38.79", "=-38.79")) == pytest.approx(here * [1, -1, 1, -1], rel=1e-9)
    lower, upper, *rest = case.splitlines()
    assert tensions("\n".join((upper, lower, *rest))) == pytest.approx(here[[2, 3, 0, 1]] * [1, -1, 1, -1], rel=1e-7)
    metres = case.replace("72100.0", "72.1e9").replace("10.0", "1e-2").replace("135.75", "135.75e3").replace("38.79", "38.79e3")
    assert tensions(metres) == pytest.approx(here * [1e6, 1e-3, 1e6, 1e-3], rel=1e-7)


def test_bad_requests_for_stresses_are_told(two_disks: mfv.Result) -> None:
    with pytest.raises(ValueError, match="'lower' or 'upper'"):
        mfv.stress.stress(two_disks, 0.0, 0.0, body="left")
    with pytest.raises(ValueError, match="no state 3: the result has 2 in /steps, numbered from 1"):
        mfv.stress.grid(two_disks, step=3)
    with pytest.raises(errors.BadArgument, match="upper body is rigid"):
        mfv.stress.stress(mfv.run(text=SHEARED), 0.0, 0.0, body="upper")
    with pytest.raises(ValueError, match="unknown stress sigma_ab; choose from sigma_xx"):
        mfv.plot.stress_figure(two_disks, "sigma_ab")
    with pytest.raises(ValueError, match="sigma_rr is not defined in a half-plane"):
        mfv.plot.stress_figure(mfv.run(text=SHEARED), "sigma_rr")


def test_stresses_are_drawn(two_disks: mfv.Result, tmp_path: Path) -> None:
    for name in ("von_mises", "sigma_rtheta"):
        picture = mfv.plot.stress_figure(two_disks, name, body="upper")
        picture.savefig(tmp_path / "stress.png")
        ax = picture.axes[0]
        assert ax.get_xlabel() == "$x/a$"
        assert ax.get_xlim() == pytest.approx((-2.0, 2.0))
        assert ax.get_ylim() == pytest.approx((0.0, 2.0), abs=0.02)
        # The area is used: the picture is as wide as its contours and their scale.
        picture.canvas.draw()
        box = ax.get_position()
        assert box.width > 0.7 and box.width * box.height > 0.45
    picture = mfv.plot.stress_figure(two_disks, "principal_1", axes="physical")
    assert picture.axes[0].get_xlim()[1] == pytest.approx(2.0 * mfv.stress.grid(two_disks).half_width, rel=0.05)
    for name in ("tresca", "principal_angle"):
        mfv.plot.stress_figure(two_disks, name).savefig(tmp_path / "stress.png")
    with pytest.raises(ValueError, match="axes must be normalised or physical, not 'round'"):
        mfv.plot.stress_figure(two_disks, axes="round")


def test_yield_is_warned_of(two_disks: mfv.Result) -> None:
    assert two_disks.attributes["warnings"].startswith("the largest von Mises stress of the upper body")
    assert mfv.run(text=SHEARED).attributes["warnings"] == ""


def test_both_bodies_displacements_close_the_gap(two_disks: mfv.Result) -> None:
    state, mesh, summary = two_disks.state, two_disks.mesh, two_disks.summary
    gap = mesh.initial_gap - summary.approach + state.normal_displacement + state.upper_normal_displacement
    assert gap == pytest.approx(state.gap, abs=1e-15)
    slip = state.tangential_displacement - state.upper_tangential_displacement - summary.shift
    assert slip == pytest.approx(state.slip, abs=1e-15)
    # Each of the equal bodies is the other one turned round.
    assert state.normal_displacement == pytest.approx(state.upper_normal_displacement[::-1], rel=1e-9)


def test_compliance_says_what_was_needed(two_disks: mfv.Result) -> None:
    blocks = {name: two_disks.compliance[name] for name in ("wp", "wt", "up", "ut")}
    assert blocks == {"wp": 1, "wt": 0, "up": 0, "ut": 1}
    assert two_disks.compliance.lower_bytes == 3 * 8 * 101
    frictionless = mfv.run(text=HALF_PLANE + DISK + MESH + "&step normal_force=1.0e-3 /")
    assert [frictionless.compliance[name] for name in ("wp", "wt", "up", "ut")] == [1, 0, 0, 0]
    assert frictionless.compliance.upper_bytes == 0


def test_rotation_is_led(tmp_path: Path) -> None:
    with mfv.Case.from_text(HALF_PLANE + DISK + MESH + FRICTION) as case:
        case.advance(normal_force=5.0e-4, friction=False)
        case.advance(moment=1.0e-6, check=True)
        assert case["summary/moment"] == pytest.approx(1.0e-6, rel=1e-12)
        turned = case["summary/rotation"]
        case.advance(rotation=0.0, check=True)
        assert turned > 0.0
        assert case["summary/rotation"] == pytest.approx(0.0, abs=1e-15)
        assert case.result().certificate.moment_balance < 1e-11
        with pytest.raises(TypeError, match="give moment or rotation, not both"):
            case.advance(moment=0.0, rotation=0.0)
        with pytest.raises(TypeError, match="unexpected keyword argument 'rotatoin'"):
            case.advance(rotatoin=None)


def matrix_file(path: Path, **datasets: np.ndarray) -> str:
    """A case with a body from a matrix in a file beside it."""
    with h5py.File(path, "w") as file:
        for name, values in datasets.items():
            file[name] = values
    return f"&body shape='matrix', file='{path}' /\n" + DISK + FRICTION + "&step normal_force=1.0e-4 /\n"


def half_plane_matrix(nodes: int) -> tuple[np.ndarray, np.ndarray]:
    """Positions and nodal compliance of the half-plane of these tests, by differentiating nothing: from displacements."""
    x = (np.arange(nodes) - 0.5 * (nodes - 1)) * 4.0e-4
    h, distance = 2.0e-4, np.abs(x[:, None] - x[None, :])
    bracket = sum(s * (distance + s * h) * np.log(np.abs(distance + s * h) / 0.25) for s in (1, -1))
    direct = 2.8 / (4 * np.pi) * (2 * h - bracket) / (2 * h)
    cross = 0.8 / 8 * np.sign(x[:, None] - x[None, :])
    return x, np.block([[direct, cross], [-cross, direct]])


def test_a_half_plane_as_a_matrix(tmp_path: Path) -> None:
    x, compliance = half_plane_matrix(41)
    mesh = "&mesh nodes=41, half_width=0.0082 /\n"
    expected = mfv.run(text=HALF_PLANE + DISK + FRICTION + mesh + "&step normal_force=1.0e-4 /\n", check=True)
    for matrix in ({"compliance": compliance}, {"stiffness": np.linalg.inv(compliance)}):
        result = mfv.run(text=matrix_file(tmp_path / "body.h5", x=x, **matrix), check=True)
        assert result.state.pressure == pytest.approx(expected.state.pressure, abs=1e-9)
        assert result.state.shear == pytest.approx(expected.state.shear, abs=1e-9)
        assert result.certificate.largest < 1e-10
        assert result.attributes["warnings"] == ""
    node_by_node = np.arange(82).reshape(2, 41).T.ravel()
    shuffled = compliance[np.ix_(node_by_node, node_by_node)]
    result = mfv.run(text=matrix_file(tmp_path / "body.h5", x=x, compliance=shuffled))
    assert "all normal components first" in result.attributes["warnings"]


def test_error_bars_in_the_process_and_in_the_file(tmp_path: Path) -> None:
    result = mfv.run(text=SHEARED + "&output error_estimate=.true. /\n", check=True)
    estimate = result.error_estimate
    assert list(estimate.companion_nodes) == [43, 35, 31] and estimate.nodes == 61
    assert estimate.stick_ratio == result.observables.stick_ratio and 0 < estimate.stick_ratio_error < 0.1
    assert estimate.unit("peak_shear_error") == "force/length^2"
    assert result.attributes["error_estimate"] == "yes"
    assert not mfv.run(text=SHEARED).error_estimate
    with mfv.Case.from_text(SHEARED + "&output error_estimate=.true. /\n") as case:
        case.run()
        assert case["error_estimate/dissipation_error"] > 0.0
        case.write(tmp_path / "case.h5")
        case.advance(tangential_force=1.0e-4)  # the bars were those of the state before
        assert "error_estimate/dissipation_error" not in case.fields()
    read = mfv.read(tmp_path / "case.h5").error_estimate
    assert set(read) == set(estimate)
    np.testing.assert_array_equal(read.peak_shear_companions, estimate.peak_shear_companions)
    assert "error estimate" in info.description(result)


def test_sensitivity_to_round_off_in_the_process_and_in_the_file(tmp_path: Path) -> None:
    text = SHEARED + "&output sensitivity=.true. /\n"
    result = mfv.run(text=text, check=True)
    changes = result.sensitivity
    assert set(changes) == {"perturbation", "pressure_change", "shear_change", "dissipation_change", "stick_ratio_change"}
    # Shear is proportional to mu where nodes slip: a change of the size of the perturbation, and none of the pressure (Goodman).
    assert changes.perturbation == 1e-12 and 1e-14 < changes.shear_change < 1e-11 and changes.pressure_change < 1e-12
    assert changes.dissipation_change < 1e-10 and changes.stick_ratio_change < 1e-10
    assert result.attributes["sensitivity"] == "yes" and not mfv.run(text=SHEARED).sensitivity
    with mfv.Case.from_text(text) as case:
        case.run()
        assert case["sensitivity/shear_change"] == changes.shear_change
        case.write(tmp_path / "case.h5")
    assert mfv.read(tmp_path / "case.h5").sensitivity.shear_change == changes.shear_change
    assert "shear_change" in info.description(result)
    early = mfv.run(text=SHEARED + "&step tangential_force=8e-4 /\n&output sensitivity=.true. /\n")
    assert not early.sensitivity and early.attributes["sensitivity"] == "none: the run did not complete"
    with pytest.raises(errors.InputError, match="&output sensitivity=.true.: must be .false. in a case without friction"):
        mfv.run(text=FRICTIONLESS + "&output sensitivity=.true. /\n")


def test_bristles_that_are_too_stiff_are_named() -> None:
    text = SHEARED.replace(FRICTION, "&friction law='dahl', mu=0.7, stiffness=1e12 /\n").replace(", friction=.false.", "")
    result = mfv.run(text=text.replace("goodman", "full"))
    assert result.outcome == "no admissible continuation"
    assert "the bristles are too stiff for this mesh: &friction stiffness=1e12 should be at most" in result.message
    assert "law='coulomb' is the limit" in result.message


def test_a_matrix_has_no_error_bars(tmp_path: Path) -> None:
    x, compliance = half_plane_matrix(41)
    text = matrix_file(tmp_path / "body.h5", x=x, compliance=compliance)
    with pytest.raises(errors.InputError, match="&output error_estimate=.true.: must be .false. with shape='matrix'"):
        mfv.run(text=text + "&output error_estimate=.true. /\n")
    (tmp_path / "case.nml").write_text(text)
    program = os.environ.get("MFV_RUN", str(PROJECT / "build/release/bin/mfv_run"))
    run = subprocess.run([program, "--estimate", "case.nml"], cwd=tmp_path, capture_output=True, text=True, timeout=60)
    assert run.returncode == 2 and "case.nml: --estimate: a body with shape='matrix' has no coarser mesh" in run.stderr


def test_bad_matrices_are_refused(tmp_path: Path) -> None:
    x, compliance = half_plane_matrix(5)
    lopsided, infinite, negative, backwards = (compliance.copy() for _ in range(4))
    lopsided[0, 1] *= 1.01
    infinite[2, 3] = np.inf
    negative[0, 0] = -1.0
    backwards[5:, 5:] *= -1.0
    path = tmp_path / "body.h5"
    for datasets, message in (
        ({"x": x}, "give exactly one of compliance and stiffness"),
        ({"compliance": compliance}, "dataset x is missing"),
        ({"x": x[::-1], "compliance": compliance}, "x is not increasing at node 2"),
        ({"x": x, "compliance": compliance[:4, :4]}, r"compliance has the shape 4 x 4; with 5 positions in x it must be 5 x 5"),
        ({"x": x, "compliance": lopsided}, "compliance is not symmetric: row"),
        ({"x": x, "compliance": infinite}, "compliance is not finite in row"),
        ({"x": x, "compliance": negative}, "compliance is not positive definite in its normal part"),
        ({"x": x, "compliance": backwards}, "compliance is not positive definite in its tangential part"),
        ({"x": x, "stiffness": np.zeros((10, 10))}, "stiffness is not positive definite"),
        ({"x": x, "compliance": compliance, "gap": x[:2]}, "gap has 2 values, x has 5"),
        ({"x": x, "compliance": compliance, "width": -x}, "width is not positive at node"),
        ({"x": x, "compliance": compliance[:5, :5]}, "the matrix has normal components only"),
    ):
        with pytest.raises(errors.InputError, match=message):
            mfv.run(text=matrix_file(path, **datasets))
    path.write_text("no HDF5")
    with pytest.raises(errors.InputError, match="body.h5 is not an HDF5 file"):
        mfv.run(text=f"&body shape='matrix', file='{path}' /\n" + DISK + "&step normal_force=1 /")
    with pytest.raises(errors.InputError, match="no such file"):
        mfv.run(text="&body shape='matrix', file='nowhere.h5' /\n" + DISK + "&step normal_force=1 /")


def test_persson_and_yield_from_python() -> None:
    force = mfv.reference.persson_force(np.radians([1.0, 30.0, 89.0]), 1e-3, 1.0, 0.3)
    hertz = np.pi / 8 / (1 - 0.3**2) * 1e-3 * np.radians(1.0) ** 2
    assert force[0] == pytest.approx(hertz, rel=1e-3)
    assert np.isnan(force[2])
    arc = np.degrees(mfv.reference.yield_contact_arc(200e3, 0.3, 250.0))
    assert arc == pytest.approx(0.467, abs=1e-3)


def test_cases_with_fourier_kernels_in_threads_give_the_digits_of_one() -> None:
    texts = [
        TWO_DISKS.replace("poisson_ratio=0.3", "poisson_ratio=0.3, kernel='fourier'").replace(
            "nodes=101, half_width=0.0152", f"nodes={nodes}, half_angle=180"
        )
        for nodes in range(20000, 20008)
    ]
    alone = [mfv.run(text=text) for text in texts]
    together: dict[int, mfv.Result] = {}

    def run(number: int) -> None:
        together[number] = mfv.run(text=texts[number])

    threads = [threading.Thread(target=run, args=(number,)) for number in range(len(texts))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for number, result in enumerate(alone):
        assert result.outcome == "complete"
        np.testing.assert_array_equal(together[number].state.pressure, result.state.pressure)
