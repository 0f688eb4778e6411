"""Commands of mfv: run and stress, which are programs; compare, animate, new, which make more than one picture."""

from __future__ import annotations

import io
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import h5py
import numpy as np
import pytest
import xarray
from PIL import Image

import mfv
from mfv import animate, comparison_figure, report, template
from mfv.commands import main
from mfv.compare import compare, relative_difference
from mfv.load_history import kept_states, thinned, with_states_between
from mfv.views import curve_of

sys.path.append(str(Path(__file__).resolve().parents[1] / "cli"))
from terminal import shown_on_a_terminal

PRESSED = """
&scene title='{title}', coupling='{coupling}' /
&body shape='half_plane', shear_modulus=1.0, poisson_ratio=0.3 /
&body shape='disk', radius=0.25, rigid=.true. /
&mesh nodes={nodes}, half_width=0.01225 /
"""
SHEARED = (
    PRESSED
    + """
&friction law='coulomb', mu=0.7 /
&step normal_force=1.0e-3, friction=.false. /
&step tangential_force=2.8e-4 /
&step tangential_force=-2.8e-4, cycles=1 /
"""
)
MINDLIN = {"title": "it's a/b ! sheared", "coupling": "goodman", "nodes": 61}


def solved(path: Path, text: str = SHEARED, **changes: object) -> mfv.Result:
    """A result in a file."""
    values = {key: str(value).replace("'", "''") for key, value in {**MINDLIN, **changes}.items()}
    return mfv.run(text=text.format(**values), output=path)


# --- compare ---


def test_a_result_is_no_different_from_itself(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    solved(tmp_path / "a.h5")
    same = compare(mfv.read(tmp_path / "a.h5"), mfv.read(tmp_path / "a.h5"))
    assert same.largest_difference == 0.0 and same.settings == [] and same.inputs == [] and not same.interpolated
    assert all(number.relative_difference == 0.0 or np.isnan(number.first) for number in same.numbers)
    assert len(same.numbers) > 40
    assert main(["compare", str(tmp_path / "a.h5"), str(tmp_path / "a.h5"), "--no-picture", "--tolerance", "0"]) == 0
    assert "different input keys: none" in capsys.readouterr().out
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.h5"]


def test_differences_are_reported(tmp_path: Path) -> None:
    first, second = solved(tmp_path / "a.h5"), solved(tmp_path / "b.h5", coupling="full")
    found = compare(first, second)
    assert ("coupling", "goodman", "full") in found.settings
    assert found.inputs == [("scene%coupling", "goodman", "full")]
    (shift,) = (number for number in found.numbers if (number.group, number.name) == ("summary", "shift"))
    assert (shift.first, shift.second) == (first.summary.shift, second.summary.shift)
    assert shift.relative_difference == pytest.approx(1.0 - second.summary.shift / first.summary.shift)
    largest = np.max(np.abs(first.state.pressure - second.state.pressure))
    assert found.tractions[0].largest_difference == pytest.approx(largest / second.state.pressure.max(), rel=1e-12)
    assert found.largest_difference == pytest.approx(largest / second.state.pressure.max(), rel=1e-12)


def test_columns_stay_apart_and_zero_has_no_sign(tmp_path: Path) -> None:
    first, second = solved(tmp_path / "a.h5"), solved(tmp_path / "b.h5", coupling="full")
    second.attributes.pop("coupling")
    first.attributes.pop("friction_law")
    text = compare(first, second).describe()
    assert "firstsecond" not in text and re.search(r"first +second$", text, re.M)
    assert not re.search(r"-0\.?(?![.\de])", text)


def test_tractions_on_other_meshes_are_interpolated() -> None:
    coarse, fine = (mfv.run(text=SHEARED.format(**{**MINDLIN, "title": "", "nodes": nodes})) for nodes in (61, 183))
    found = compare(coarse, fine)
    assert found.interpolated and "interpolated linearly" in found.describe()
    # Both hold at the nodes of the coarse mesh, which are among those of the fine one.
    shared = np.max(np.abs(coarse.state.pressure - fine.state.pressure[1::3])) / fine.state.pressure.max()
    assert shared <= found.tractions[0].largest_difference < 0.2
    assert 0.0 < found.tractions[0].mean_square_difference < found.tractions[0].largest_difference


def test_relative_differences() -> None:
    assert relative_difference(0.0, 0.0) == relative_difference(np.inf, np.inf) == 0.0
    assert relative_difference(1.0, 2.0) == relative_difference(2.0, 1.0) == 0.5
    assert relative_difference(0.0, -3.0) == 1.0
    for one, other in ((1.0, np.nan), (np.nan, 0.0), (np.nan, np.nan)):
        assert np.isnan(relative_difference(one, other)) and np.isnan(relative_difference(other, one))
    assert relative_difference(np.inf, 1.0) == relative_difference(-1.0, -np.inf) == np.inf


def test_compare_writes_picture_and_numbers(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    solved(tmp_path / "a.h5")
    second = solved(tmp_path / "b.h5", coupling="full", nodes=81)
    arguments = ["compare", str(tmp_path / "a.h5"), str(tmp_path / "b.h5")]
    assert main([*arguments, "--tolerance", "1e-3"]) == 1
    printed = capsys.readouterr().out
    assert printed.rstrip().endswith(str(tmp_path / "a_b.png")) and f"{second.summary.dissipation:.6g}" in printed
    assert (tmp_path / "a_b.png").stat().st_size > 50000


def test_the_picture_has_both_results_and_both_over_each_other(tmp_path: Path) -> None:
    first, second = solved(tmp_path / "a.h5"), solved(tmp_path / "b.h5", coupling="full", nodes=81)
    axes = comparison_figure.figure(compare(first, second)).axes
    assert len(axes) == 9
    one, other, difference = axes[2].lines
    np.testing.assert_array_equal(one.get_ydata(), first.state.pressure)
    np.testing.assert_array_equal(other.get_ydata(), second.state.pressure)
    assert np.max(np.abs(difference.get_ydata())) == pytest.approx(
        compare(first, second).tractions[0].largest_difference * max(first.state.pressure.max(), second.state.pressure.max())
    )
    assert len({ax.get_xlim() for ax in axes[:3]}) == len({ax.get_ylim() for ax in axes[6:]}) == 1
    # A pressed and a sheared one; two that are only pressed.
    pressed = mfv.run(text=PRESSED.format(**{**MINDLIN, "title": ""}) + "&step normal_force=1.0e-3 /")
    assert [ax.axison for ax in comparison_figure.figure(compare(pressed, second)).axes[6:]] == [False, True, True]
    assert len(comparison_figure.figure(compare(pressed, pressed)).axes) == 6


def test_what_cannot_be_compared_is_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    solved(tmp_path / "a.h5")
    (tmp_path / "b.h5").write_text("no HDF5\n")
    good, bad = str(tmp_path / "a.h5"), str(tmp_path / "b.h5")
    for arguments, complaint in (
        ([good, bad], f"{bad}: not a result file"),
        ([good, str(tmp_path / "c.h5")], "c.h5"),
        ([good, good, "--step", "9"], f"{good}: no state 9"),
        ([good, good, "-o", str(tmp_path / "nowhere" / "x.png")], "nowhere"),
    ):
        assert main(["compare", *arguments]) == 2
        printed = capsys.readouterr().err
        assert complaint in printed and printed.count("\n") == 1
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.h5", "b.h5"]


def test_only_a_difference_ends_with_1(tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file.attrs["mfv_version"] = "0.1.0"
        file["state/pressure"] = [0.0]
    arguments = ["compare", str(tmp_path / "a.h5"), str(tmp_path / "a.h5"), "--no-picture", "--tolerance", "1e-3"]
    assert main(arguments) == 2
    assert "missing: the group mesh, the group scene, the group summary" in capsys.readouterr().err
    (tmp_path / "a.h5").unlink()
    solved(tmp_path / "a.h5")
    monkeypatch.setattr("mfv.compare.compare", lambda *_: 1 // 0)
    assert main(arguments) == 2
    assert "ZeroDivisionError" in capsys.readouterr().err


# --- output files of commands ---


def test_results_are_not_overwritten_by_what_is_drawn_of_them(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    solved(tmp_path / "a.h5")
    solved(tmp_path / "b.png")
    study = str(tmp_path / "study.nml")
    assert main(["new", "study", "-o", study]) == 0
    capsys.readouterr()
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    first, other = str(tmp_path / "a.h5"), str(tmp_path / "b.png")
    for arguments, complaint in (
        (["plot", first, "-o", first], f"{first}: the file name must end with .png or "),
        (["plot", other], f"{other}: is the input file"),
        (["plot", first, "-o", other], f"{other}: is an HDF5 file, not overwritten"),
        (["plot", first, "-o", str(tmp_path / "out")], f"{tmp_path / 'out'}: the file name must end with"),
        (["plot", first, "-o", str(tmp_path)], f"{tmp_path}: is a directory"),
        (["plot", first, "-o", ""], "such as a.png"),
        (
            ["plot", first, "-o", str(tmp_path / "no" / "x.png")],
            f"{tmp_path / 'no' / 'x.png'}: {tmp_path / 'no'} does not exist or is not a directory",
        ),
        (["plot", first, "--body", "upper"], "add --stress NAME"),
        (["plot", first, "--cycles", "--step", "1"], "remove one of them"),
        (["report", first, "-o", first], f"{first}: the file name must end with .html or .htm"),
        (["animate", first, "--kept", "-o", first], f"{first}: the file name must end with"),
        (["new", "--force", "-o", first], f"{first}: the file name must end with"),
        (["study", study, "-o", first], f"{first}: is an HDF5 file, not overwritten"),
        (["study", study, "-o", other], f"{other}: the file name must end with .nc or .h5 or .csv"),
        (["study", study, "--case", "25"], f"{study}: no case 25; the cases are numbered from 1 to 24"),
    ):
        assert main(arguments) == 2, arguments
        printed = capsys.readouterr()
        assert complaint in printed.err and printed.err.count("\n") == 1 and printed.out == "", arguments
        assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before
    assert main(["plot", first, "-o", str(tmp_path / "A.PNG")]) == 0
    assert main(["animate", first, "--kept", "-o", str(tmp_path / "A.GIF")]) == 0
    assert (tmp_path / "A.PNG").read_bytes()[1:4] == b"PNG" and (tmp_path / "A.GIF").read_bytes()[:3] == b"GIF"


# --- states between those saved in a result ---

PROJECT = Path(__file__).resolve().parents[2]
EXAMPLES = PROJECT / "examples"


@pytest.mark.parametrize(
    ("name", "parts"),
    [("mindlin", 6), ("steel_fretting", 6), ("pin_in_bore", 2), ("hertz", 1), ("shear_cycles", 10), ("cycles", 84)],
)
def test_states_on_the_way_lead_to_the_same_end(name: str, parts: int) -> None:
    result = mfv.run(EXAMPLES / f"{name}.nml")
    again, note = with_states_between(result, 2 * parts)
    assert note == "" and len(again.steps) == 2 * parts
    assert compare(result, again).largest_difference < 1e-9
    if len(result.steps) == parts:  # every second state is one of the result's own
        for kept, state in zip(result.steps, again.steps[1::2]):
            np.testing.assert_allclose(state.pressure, kept.pressure, atol=1e-9 * kept.pressure.max())
            np.testing.assert_allclose(state.shear, kept.shear, atol=1e-9 * kept.pressure.max())
            assert state.tangential_force == pytest.approx(kept.tangential_force, abs=1e-9 * kept.normal_force)


def test_states_on_the_way_are_half_way() -> None:
    result = mfv.run(text=SHEARED.format(**{**MINDLIN, "title": ""}))
    forces = [state.tangential_force for state in with_states_between(result, 8).result.steps]
    np.testing.assert_allclose(forces, np.array([0, 0, 1.4, 2.8, 0, -2.8, 0, 2.8]) * 1e-4, atol=1e-15)


def test_an_early_end_is_the_end_of_the_states() -> None:
    result = mfv.run(text=SHEARED.format(**{**MINDLIN, "title": ""}) + "&step tangential_force=1e-3 /")
    assert result.outcome == "gross sliding"
    again, note = with_states_between(result, 50)
    assert note == "" and again.outcome == "gross sliding"
    np.testing.assert_array_equal(again.steps[-1].pressure, again.state.pressure)
    forces = [state.tangential_force for state in again.steps[-9:]]  # of the part that ended early: from 0 to where it ended
    assert forces[-1] == pytest.approx(result.summary.tangential_force, rel=1e-9)
    np.testing.assert_allclose(np.diff(forces), forces[-1] / 10 - result.steps[-1].tangential_force / 10, rtol=1e-6)
    assert len(kept_states(result).steps) == len(result.steps) + 1


def test_another_end_is_told_and_so_is_what_cannot_be_solved_again() -> None:
    # Dahl's friction is solved to a tolerance of an increment, of which more states make more.
    assert "ends in a different state" in with_states_between(mfv.run(EXAMPLES / "dahl.nml"), 20).note
    result = mfv.run(text=SHEARED.format(**{**MINDLIN, "title": ""}))
    assert "need at least 8 states" in with_states_between(result, 7).note
    result.attributes["input"] = result.attributes["input"].replace("shift", "").replace("disk", "disc")
    again, note = with_states_between(result, 40)
    assert "disc" in note and again.steps == result.steps
    # A host that advances the contact itself has other states than the steps of the text.
    with mfv.Case.from_text(SHEARED.format(**{**MINDLIN, "title": ""})) as case:
        case.advance(normal_force=1.0e-3)
        led = case.result()
    again, note = with_states_between(led, 40)
    assert "ends in a different state" in note and len(again.steps) == 1
    without = mfv.run(text=SHEARED.format(**{**MINDLIN, "title": ""}) + "&output states='none' /\n")
    assert without.steps == [] and len(with_states_between(without, 8).result.steps) == 8
    steady = SHEARED.replace("cycles=1", "cycles=9, steady_tolerance=1e-6") + "&output states='none' /\n"
    assert "steady" in with_states_between(mfv.run(text=steady.format(**{**MINDLIN, "title": ""})), 40).note
    result.attributes["algorithm"] = "conventional"
    assert "load steps" in with_states_between(result, 40).note


@pytest.mark.parametrize("friction", ["&friction law='coulomb', mu=0.7 /\n", ""])
def test_a_history_that_ends_unloaded_has_its_states_in_between(friction: str) -> None:
    unloaded = PRESSED + friction + "&step normal_force=1e-3 /\n&step normal_force=0 /\n"
    result = mfv.run(text=unloaded.format(**{**MINDLIN, "title": ""}))
    again, note = with_states_between(result, 12)
    assert note == "" and len(again.steps) == 12
    assert again.steps[8].normal_force == pytest.approx(0.5e-3, rel=1e-9)


def test_of_many_states_some_are_shown() -> None:
    result = mfv.run(text=SHEARED.format(**{**MINDLIN, "title": ""}).replace("cycles=1", "cycles=20"))
    few = thinned(result, 5).steps
    assert len(few) == 5 and few[0] is result.steps[0] and few[-1] is result.steps[-1]
    assert thinned(result, 100) is result
    assert len(result.steps) == 42


# --- animate ---


def pictures(path: Path) -> list[np.ndarray]:
    """The frames of a GIF."""
    with Image.open(path) as image:
        frames = []
        for number in range(image.n_frames):
            image.seek(number)
            frames.append(np.asarray(image.convert("RGB")))
        return frames


def test_animate_writes_a_gif_that_moves(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    solved(tmp_path / "a.h5")
    assert main(["animate", str(tmp_path / "a.h5"), "--frames", "8", "--rate", "4"]) == 0
    printed = capsys.readouterr()
    assert printed.out.strip() == str(tmp_path / "a.gif") and printed.err == ""
    frames = pictures(tmp_path / "a.gif")
    assert len(frames) == 8
    assert all(np.any(one != other) for one, other in zip(frames, frames[1:]))
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.gif", "a.h5"]


def test_animate_shows_progress_on_a_terminal_alone(tmp_path: Path) -> None:
    solved(tmp_path / "a.h5")
    environment = {**os.environ, "PYTHONPATH": str(Path(mfv.__file__).parents[1])}
    command = [sys.executable, "-m", "mfv", "animate", str(tmp_path / "a.h5"), "--frames", "2", "--kept"]
    assert b"drawing" in shown_on_a_terminal(command, env=environment)
    ended = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    assert ended.stderr == "" and ended.stdout.strip() == str(tmp_path / "a.gif")


def test_animate_draws_the_states_of_the_file(tmp_path: Path) -> None:
    result = solved(tmp_path / "a.h5")
    moving = animate.movie(result)
    assert moving.frames == len(result.steps)
    for number, state in enumerate(result.steps):
        moving.draw(number)
        pressure, shear, curve = moving.picture.axes
        (computed,) = (line for line in shear.lines if line.get_label() == "computed")
        np.testing.assert_array_equal(computed.get_ydata(), state.shear)
        assert curve.lines[-1].get_xydata().tolist() == [[state.shift, state.tangential_force]]
        assert pressure.get_ylim()[1] >= max(other.pressure.max() for other in result.steps)


@pytest.mark.parametrize(
    ("text", "across"),
    [
        (PRESSED + "&step normal_force=1e-3 /\n&output history='none' /\n", "approach"),
        ((EXAMPLES / "pin_in_bore.nml").read_text(), "rotation"),
        (SHEARED + "&step tangential_force=1e-3 /\n", "shift"),
    ],
    ids=["frictionless without history", "turned", "sliding"],
)
def test_animate_draws_what_there_is(text: str, across: str, tmp_path: Path) -> None:
    mfv.run(text=text.format(**{**MINDLIN, "title": ""}), output=tmp_path / "a.h5")
    shown = kept_states(mfv.read(tmp_path / "a.h5"))
    assert across in animate.movie(shown).picture.axes[2].get_xlabel()
    assert main(["animate", str(tmp_path / "a.h5"), "--kept"]) == 0
    assert len(pictures(tmp_path / "a.gif")) == len(shown.steps)


def test_a_result_without_states_has_its_last_one() -> None:
    text = SHEARED.format(**{**MINDLIN, "title": ""}) + "&output states='none', history='none' /\n"
    result = mfv.run(text=text)
    assert result.steps == [] and animate.movie(result).frames == 1
    assert curve_of(result).across == "shift"
    shown = report.page(result, "x.h5")
    assert 'id="pressure"' in shown and 'id="curve"' not in shown


def test_an_mp4_needs_ffmpeg_and_says_so(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    solved(tmp_path / "a.h5")
    arguments = ["animate", str(tmp_path / "a.h5"), "--kept", "-o", str(tmp_path / "a.mp4")]
    assert main(arguments) == 0
    assert (tmp_path / "a.mp4").read_bytes()[4:8] == b"ftyp"
    (tmp_path / "a.mp4").write_bytes(b"earlier")
    monkeypatch.setattr("shutil.which", lambda name: None)
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    assert main(arguments) == 2
    assert "write a GIF" in capsys.readouterr().err
    assert main([*arguments[:-1], str(tmp_path / "a.avi")]) == 2
    assert ".gif or .mp4" in capsys.readouterr().err
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.h5", "a.mp4"]
    assert (tmp_path / "a.mp4").read_bytes() == b"earlier"


# --- new ---

MFV_RUN = Path(os.environ.get("MFV_RUN", PROJECT / "build" / "release" / "bin" / "mfv_run"))
COMMAND_LINE = [sys.executable, "-m", "mfv"]


@pytest.mark.parametrize("name", template.names())
def test_every_template_is_solved(name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "case.nml"
    assert main(["new", name, "-o", str(path)]) == 0
    printed = capsys.readouterr().out.splitlines()
    assert printed[0] == str(path) and printed[-1].endswith(str(path))
    assert sorted(printed[:-1]) == sorted(str(place) for place in tmp_path.iterdir())
    program, *arguments = printed[-1].removeprefix("solve it: ").split()
    environment = {**os.environ, "PYTHONPATH": str(Path(mfv.__file__).parents[1])}
    assert program == "mfv"
    ended = subprocess.run([*COMMAND_LINE, *arguments], cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
    assert ended.returncode == 0, ended.stderr
    if arguments[0] == "study":
        with xarray.open_dataset(tmp_path / "case.nc") as table:
            assert table["outcome"].size == 24 and set(table["outcome"].values.flat) == {"complete"}
            assert table["largest_residual"].max() < 1e-11
    else:
        result = mfv.read(tmp_path / "case.h5")
        assert result.outcome == "complete" and result.certificate.largest < 1e-11
        assert not result.attributes["warnings"].strip()
        assert 0.0 < result.summary.stick_ratio < 1.0


def test_comments_of_templates_are_those_of_the_catalogue() -> None:
    printed = subprocess.run([MFV_RUN, "--keys"], capture_output=True, text=True, check=True).stdout
    assert (Path(template.__file__).parent / "templates/keys.md").read_text() == printed, "mfv_run --keys > keys.md"
    text = template.text("study")
    assert "   ! number of equal intervals; nodes are their centres; more by default" in template.text("cylinder")
    assert "(a number above 0, in length)\n" in template.text("matrix") and "('linear' or 'log', 'linear' by default)\n" in text
    for key in ("key", "values", "factor"):  # a comment above the first one alone
        place = text.index(f"   {key} = ")
        assert text[:place].splitlines()[-1].startswith("   ! ")
    assert text.count("! the values, in the unit of the key") == 1
    assert max(map(len, text.splitlines()[2:])) <= 100


def test_the_matrix_of_the_template_is_a_half_plane(tmp_path: Path) -> None:
    assert main(["new", "matrix", "-o", str(tmp_path / "case.nml")]) == 0
    given = mfv.run(tmp_path / "case.nml")
    body = "shape = 'half_plane', shear_modulus = 1.0, poisson_ratio = 0.3 /"
    text = template.text("matrix").replace("shape = 'matrix'", body + "\n&mesh nodes = 81, half_width = 0.0127")
    known = mfv.run(text=text.replace("   file = 'compliance.h5'\n", ""))
    assert compare(given, known).largest_difference < 1e-10
    assert given.summary.approach == pytest.approx(known.summary.approach, rel=1e-3)


def test_the_matrix_template_does_not_write_over_its_input(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["new", "matrix"]) == 0
    subprocess.run([MFV_RUN, "matrix.nml"], check=True, capture_output=True)
    assert mfv.read("matrix.h5").outcome == "complete"


def test_nothing_is_overwritten_unless_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "compliance.h5").write_text("mine\n")
    arguments = ["new", "matrix", "-o", str(tmp_path / "case.nml")]
    assert main(arguments) == 2
    assert f"{tmp_path / 'compliance.h5'}: exists" in capsys.readouterr().err
    assert (tmp_path / "compliance.h5").read_text() == "mine\n" and len(list(tmp_path.iterdir())) == 1
    assert main([*arguments, "--force"]) == 0
    assert (tmp_path / "compliance.h5").read_bytes().startswith(b"\x89HDF")
    # What a study needs may be there already, the same.
    for template_name in ("cylinder", "study"):
        assert main(["new", template_name, "-o", str(tmp_path / f"{template_name}.nml")]) == 0
    assert main(["new", "study", "-o", str(tmp_path / "cylinder.nml")]) == 2
    assert "choose another" in capsys.readouterr().err


def test_new_lists_templates_and_names_what_it_does_not_have(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["new", "--list"]) == 0
    assert [line.split()[0] for line in capsys.readouterr().out.splitlines()] == list(template.names())
    assert main(["new", "cube"]) == 2
    assert "unknown template cube; choose from cylinder, " in capsys.readouterr().err
    assert main(["new"]) == 0
    assert [path.name for path in tmp_path.iterdir()] == ["cylinder.nml"]


def test_a_misspelled_command_has_a_proposal(capsys: pytest.CaptureFixture[str]) -> None:
    for word, proposal in (
        ("plto", "did you mean plot?"),
        ("a.nml", "did you mean 'mfv run a.nml'?"),
        ("a.h5", "did you mean 'mfv plot a.h5'?"),
        ("xyz", "choose from new, run, plot, "),
    ):
        with pytest.raises(SystemExit) as caught:
            main([word, "case.h5"])
        assert caught.value.code == 2 and f"unknown command '{word}'; {proposal}" in capsys.readouterr().err


@pytest.mark.parametrize(
    "command",
    ["new", "plot", "info", "compare", "animate", "report", "study", "map", "identify", "profile", "loads", "fatigue"],
)
def test_every_command_teaches(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as caught:
        main([command, "--help"])
    assert caught.value.code == 0
    printed = capsys.readouterr().out
    assert f"mfv {command}" in printed.split("examples:")[1] and len(printed) > 400


# --- programs ---

SLIDING = SHEARED + "&step tangential_force=1.0e-3 /\n"


def both(arguments: list[str], folder: Path, **options: object) -> list[subprocess.CompletedProcess[str]]:
    """`mfv run` and mfv_run with the same arguments."""
    commands = ([*COMMAND_LINE, "run", *arguments], [str(MFV_RUN), *arguments])
    return [subprocess.run(command, cwd=folder, capture_output=True, text=True, **options) for command in commands]


@pytest.mark.parametrize(
    ("arguments", "code"),
    [
        (["--check", "case.nml"], 0),
        (["case.nml"], 3),
        (["absent.nml"], 2),
        ([], 2),
        (["--version"], 0),
        (["--help"], 0),
        (["-x"], 2),
    ],
)
def test_run_is_the_program(arguments: list[str], code: int, tmp_path: Path) -> None:
    (tmp_path / "case.nml").write_text(SLIDING.format(**{**MINDLIN, "title": "sliding"}))
    command, program = both(arguments, tmp_path)
    assert command.returncode == program.returncode == code
    assert (command.stderr, timeless(command.stdout)) == (program.stderr, timeless(program.stdout))


def timeless(text: str) -> str:
    """A summary without the times."""
    return re.sub(r"\S+ s$", "", text, flags=re.MULTILINE)


def test_run_ends_by_the_signals_of_the_program(tmp_path: Path) -> None:
    """A closed pipe, which Python ignores, and Ctrl-C while it solves; progress is shown on a terminal."""
    many = "&output history='none' /\n" + SHEARED.replace("cycles=1", "cycles=20000").replace("{nodes}", "301")
    (tmp_path / "case.nml").write_text(many.format(**{**MINDLIN, "title": "many cycles"}))
    started = subprocess.Popen([*COMMAND_LINE, "run", "case.nml"], cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    while not Path(f"/proc/{started.pid}/exe").resolve().name.startswith("mfv_run"):
        time.sleep(0.02)
    time.sleep(0.3)
    started.send_signal(signal.SIGINT)
    out, _ = started.communicate(timeout=60)
    assert started.returncode == 130 and b"interrupted" in out
    closed = "(sleep 0.3; exec {}) | true; exit ${{PIPESTATUS[0]}}"  # the reader has ended before the first line
    commands = (f"{' '.join(COMMAND_LINE)} run --keys", f"{MFV_RUN} --keys")
    codes = [subprocess.run(["bash", "-c", closed.format(line)], capture_output=True).returncode for line in commands]
    assert codes == [128 + signal.SIGPIPE] * 2
    shown = shown_on_a_terminal([*COMMAND_LINE, "run", "--estimate", str(PROJECT / "examples/cycles.nml")], cwd=tmp_path)
    assert shown == b"" or b"%" in shown


def test_rows_of_a_table_are_printed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """All columns with a value for each row; as read by numpy they are those of the file."""
    result = mfv.run(PROJECT / "examples/shear_cycles.nml", output=tmp_path / "a.h5")
    for name, row in (("cycles", "cycle"), ("history", "record"), ("patches", "patch")):
        assert main(["info", str(tmp_path / "a.h5"), "--rows", name]) == 0
        table = np.genfromtxt(io.StringIO(capsys.readouterr().out), delimiter=",", names=True)
        group = getattr(result, name)
        assert table.dtype.names[0] == row and "friction_work" not in table.dtype.names
        for column in table.dtype.names:
            np.testing.assert_array_equal(np.atleast_1d(table[column]), group[column], err_msg=column)


def test_stress_is_the_program(tmp_path: Path) -> None:
    solved(tmp_path / "a.h5")
    done = subprocess.run([*COMMAND_LINE, "stress", "a.h5", "--points", "5", "4"], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0 and "largest von Mises" in done.stdout
    assert mfv.read(tmp_path / "a.h5").stresses["last/lower"].von_mises.shape == (4, 5)


def test_without_a_library_two_lines_say_what_to_type(tmp_path: Path) -> None:
    """A copy of the package, with no build beside it and none of the system."""
    shutil.copytree(Path(mfv.__file__).parent, tmp_path / "python/mfv", ignore=shutil.ignore_patterns("lib", "bin", "__pycache__"))
    (tmp_path / "VERSION").write_text("0.0.0\n")
    bare = {"PATH": "/nowhere", "PYTHONPATH": str(tmp_path / "python"), "HOME": str(tmp_path), "PYTHONDONTWRITEBYTECODE": "1"}
    for arguments in (["run", "case.nml"], ["stress", "a.h5"], ["study", str(PROJECT / "examples/study.nml"), "--list"]):
        done = subprocess.run([*COMMAND_LINE, *arguments], cwd=tmp_path, env=bare, capture_output=True, text=True)
        assert done.returncode == 2, done.stderr
        assert len(done.stderr.splitlines()) == 2 and "not found; type\n    pip install ." in done.stderr


# --- the overview, and completion in the shell ---


def test_without_arguments_there_is_an_overview(capsys: pytest.CaptureFixture[str]) -> None:
    assert main([]) == 0
    shown = capsys.readouterr()
    assert shown.err == "" and len(shown.out.splitlines()) < 24
    for line in ("usage: mfv COMMAND", "  new ", "  study ", "First steps:", "  mfv run cylinder.nml"):
        assert line in shown.out


def test_new_takes_the_name_of_a_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["new", "mine.nml"]) == main(["new", "weakening.nml"]) == 0
    assert "solve it: mfv run mine.nml" in capsys.readouterr().out
    assert Path("mine.nml").read_text() == template.text("cylinder").replace("FILE", "mine")
    assert Path("weakening.nml").read_text() == template.text("weakening").replace("FILE", "weakening")
    assert main(["new", "mine.nml"]) == 2 and main(["new", "a.nml", "-o", "b.nml"]) == 2
    complaints = capsys.readouterr().err
    assert "mine.nml: exists; overwrite it with --force" in complaints
    assert "write 'mfv new cylinder -o b.nml'" in complaints


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        (
            "mfv ",
            {
                "new",
                "run",
                "plot",
                "info",
                "stress",
                "compare",
                "animate",
                "report",
                "study",
                "map",
                "identify",
                "profile",
                "loads",
                "fatigue",
            },
        ),
        ("mfv run s", {"s.nml"}),
        ("mfv run --res", {"--resume"}),
        ("mfv stress --b", {"--body"}),
        ("mfv an", {"animate"}),
        ("mfv plot --st", {"--step", "--stress"}),
        ("mfv new two", {"two_cylinders"}),
        ("mfv plot --stress von", {"von_mises"}),
        ("mfv plot --body ", {"lower", "upper"}),
        ("mfv plot a", {"a.h5"}),
        ("mfv compare a.h5 b", {"b.h5"}),
        ("mfv study s", {"s.nml"}),
    ],
)
def test_completion_in_the_shell(line: str, expected: set[str], tmp_path: Path) -> None:
    """The protocol of argcomplete: the shell sets the line and the cursor, and reads the words from file descriptor 8."""
    for name in ("a.h5", "a.png", "b.h5", "b.txt", "s.nml", "s.txt"):
        (tmp_path / name).touch()
    of_shell = {"_ARGCOMPLETE": "1", "_ARGCOMPLETE_SHELL": "bash", "_ARGCOMPLETE_IFS": "\n", "COMP_LINE": line, "COMP_TYPE": "9"}
    environment = {**os.environ, **of_shell, "COMP_POINT": str(len(line))}
    script = '"$0" -m mfv 8>words 9>/dev/null'
    subprocess.run(["bash", "-c", script, sys.executable], cwd=tmp_path, env=environment, check=True, capture_output=True)
    assert {word.strip() for word in (tmp_path / "words").read_text().split("\n")} - {"-h", "--help", "--version"} == expected


def test_what_is_no_result_is_told_in_a_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    case = tmp_path / "case.nml"
    case.write_text(SHEARED)
    (tmp_path / "study.csv").write_text("case,outcome\n")
    with h5py.File(tmp_path / "study.h5", "w") as table:
        table.attrs.update({"mfv_version": "0.9.0", "cases": 4})
    for name, message in (
        ("case.nml", "a case, not a result; solve it first with 'mfv run'"),
        ("study.csv", "not a result; for the table of a study write NetCDF: 'mfv study STUDY.nml'"),
        ("study.h5", "the table of a study, not a result; 'mfv plot' draws it"),
        ("no.h5", "No such file or directory"),
    ):
        assert main(["plot", str(tmp_path / name)]) == 2
        assert capsys.readouterr().err.startswith(f"mfv: {tmp_path / name}: {message}")


def test_completion_needs_no_argcomplete(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    from mfv.commands import completion

    monkeypatch.setattr(completion, "IS_COMPLETING", True)
    monkeypatch.setitem(sys.modules, "argcomplete", None)
    monkeypatch.setitem(sys.modules, "argcomplete.completers", None)
    assert main(["new", "--list"]) == 0
    assert "two_cylinders" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["new", "x", "--template", "y"], "mfv new: error: unknown option '--template'; choose from --output, --list, --force"),
        (["plot", "--cycels=2", "x.h5"], "mfv plot: error: unknown option '--cycels'; did you mean --cycles?"),
        (["info", "x.h5", "y.h5"], "mfv info: error: too many arguments: 'y.h5'"),
    ],
)
def test_an_unknown_word_is_answered_by_its_command(words: list[str], message: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(words)
    told = capsys.readouterr().err
    assert ended.value.code == 2 and told.startswith(f"usage: mfv {words[0]} ") and message in told
