"""Profiles from files of instruments (SurfaceTopography) and texts, with units, signs, lines of maps and filters. All are invented."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scenes import PROJECT

import mfv
from mfv import Body, Mesh, Scene, Step, errors, profiles
from mfv.commands import main

#: A map of 21 x 5 points, a micrometre apart: metres, positive outwards; a ridge along y that is higher from line to line.
SIZE, LINES, STEP = 21, 5, 1.0e-6
HEIGHTS = -((np.arange(SIZE)[:, None] - 10) ** 2) * 1.0e-9 + np.arange(LINES)[None, :] * 1.0e-9


def x3p(path: Path, heights: Any = HEIGHTS) -> Path:
    from SurfaceTopography import Topography

    heights = np.ma.masked_invalid(np.array(heights))
    Topography(heights, (heights.shape[0] * STEP, heights.shape[1] * STEP), unit="m").to_x3p(str(path))
    return path


def scene(body: Body, **keys: Any) -> Scene:
    mesh, press = Mesh(nodes=21, half_width=4.0e-3), Step(normal_force=1.0e-6)
    return Scene(Body.half_plane(shear_modulus=1.0, poisson_ratio=0.3), body, mesh=mesh, steps=[press], **keys)


def test_lines_of_a_map_in_the_unit_of_the_scene(tmp_path: Path) -> None:
    path = x3p(tmp_path / "scan.x3p")
    for options, expected, note in (
        ({}, HEIGHTS[:, 2], "line 3 of 5 along x"),
        ({"line": 5}, HEIGHTS[:, 4], "line 5 of 5 along x"),
        ({"line": "mean"}, HEIGHTS.mean(axis=1), "mean of 5 lines along x"),
        ({"along": "y", "line": 1}, HEIGHTS[0], "line 1 of 21 along y"),
        ({"outwards": False}, -HEIGHTS[:, 2], "line 3"),
    ):
        profile = profiles.read(path, unit="um", **options)
        np.testing.assert_allclose(profile.x, np.arange(expected.size), atol=1e-9)
        np.testing.assert_allclose(profile.height, -1.0e6 * expected, atol=1e-12)
        assert note in profile.notes[0]
    with pytest.raises(errors.InputError, match="line 6: the map has 5 lines along x"):
        profiles.read(path, line=6)
    with pytest.raises(errors.InputError, match="no channel 'Phase'; there are Default"):
        profiles.read(path, channel="Phase")
    with pytest.raises(errors.InputError, match="scan.x3p: has positions; remove spacing"):
        profiles.read(path, spacing=0.1)
    for options in (
        {"line": 0},
        {"line": "last"},
        {"along": "z"},
        {"unit": "N"},
        {"lambda_s": -1.0},
        {"lambda_s": 2.0, "lambda_c": 1.0},
    ):
        with pytest.raises(errors.InputError):
            profiles.read(path, **options)


def test_a_body_of_a_file_of_an_instrument(tmp_path: Path) -> None:
    path = x3p(tmp_path / "scan.x3p")
    with pytest.warns(UserWarning, match="line 3 of 5 along x"):
        body = Body.profile(path, unit="mm", centred=True, rigid=True)
    x = (np.arange(SIZE) - 10) * 1.0e-3
    exact = scene(Body.profile(x, x**2, rigid=True)).run()
    read = scene(body).run()
    np.testing.assert_allclose(read.state.pressure, exact.state.pressure, rtol=1e-6, atol=1e-9)
    assert read.state.pressure.max() > 0.0
    named = scene(Body(shape="profile", file="scan.x3p", centred=True, rigid=True), length_unit="mm", name=str(tmp_path / "case"))
    with pytest.warns(UserWarning, match="line 3 of 5"):
        np.testing.assert_array_equal(named.run().state.pressure, read.state.pressure)
    named.upper.height_scale = -1.0
    with pytest.raises(errors.InputError, match="scan.x3p: has units; remove position_scale and height_scale"):
        named.contact()
    with pytest.raises(TypeError, match="not both"):
        Body.profile(path, [1.0, 2.0])
    with pytest.raises(TypeError, match="needs x and height"):
        Body.profile([1.0, 2.0])


def test_the_command_writes_what_the_program_names(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    heights = HEIGHTS.copy()
    heights[3:5, 2] = np.nan
    x3p(tmp_path / "scan.x3p", heights)
    case = (
        "&body shape='half_plane', shear_modulus=1.0, poisson_ratio=0.3 /\n"
        "&body shape='profile', file='{}', centred=.true., rigid=.true. /\n"
        "&mesh nodes=21, half_width=4e-3 /\n&step normal_force=1e-6 /\n"
    )
    program = os.environ.get("MFV_RUN", str(PROJECT / "build/release/bin/mfv_run"))
    (tmp_path / "case.nml").write_text(case.format("scan.x3p"))
    done = subprocess.run([program, "case.nml"], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 2 and done.stderr.strip().isprintable()
    line = done.stderr.strip().rpartition("write one: ")[2]
    assert line == "mfv profile scan.x3p -o scan.txt"
    ran = subprocess.run([sys.executable, "-m", *line.split()], cwd=tmp_path, capture_output=True, text=True)
    assert ran.returncode == 0 and "21 points over 0.02 mm, 2 without a value" in ran.stdout, ran
    assert "&body shape='profile', file='scan.txt'" in ran.stdout and "line 3 of 5 along x" in ran.stderr
    (tmp_path / "case.nml").write_text(case.format("scan.txt"))
    done = subprocess.run([program, "case.nml"], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0 and "2 of 21 points of the profile of the upper body have no value" in done.stdout + done.stderr
    np.testing.assert_allclose(
        mfv.read(tmp_path / "case.h5").state.pressure,
        scene(Body.profile(tmp_path / "scan.txt", outwards=False, centred=True, rigid=True)).run().state.pressure,
        rtol=1e-9,
    )
    assert main(["profile", str(tmp_path / "scan.x3p"), "-o", str(tmp_path / "scan.x3p")]) == 2
    assert "must end with .txt" in capsys.readouterr().err


def test_units_of_texts(tmp_path: Path) -> None:
    path = tmp_path / "trace.csv"
    for heading, options, scales, note in (
        ("x [um],z [nm]", {}, (1.0e-3, 1.0e-6), ""),
        ("X_(microns),y1", {}, (1.0e-3, 1.0e-3), "names one unit of length, um"),
        ("x,z", {}, (1.0, 1.0), "names no unit of length: its numbers are taken as mm; file_unit chooses another"),
        ("x,z", {"file_unit": "um"}, (1.0e-3, 1.0e-3), ""),
        ("x [mm],z", {"file_unit": "um"}, (1.0, 1.0e-3), ""),
    ):
        path.write_text(f"{heading}\n0,1\n1,2\n2,4\n")
        profile = profiles.read(path, **options)
        np.testing.assert_allclose(profile.x, np.array([0.0, 1.0, 2.0]) * scales[0])
        np.testing.assert_allclose(profile.height, np.array([1.0, 2.0, 4.0]) * -scales[1])
        assert note in " ".join(profile.notes) and bool(note) == bool(profile.notes)
    path.write_text("z [um]\n1\n2\n4\n")
    with pytest.raises(errors.InputError, match=r"has no distances between its heights; give spacing in mm"):
        profiles.read(path)
    np.testing.assert_allclose(profiles.read(path, spacing=0.5).x, [0.0, 0.5, 1.0])
    for spacing in (0.0, -1.0, float("nan"), "1"):
        with pytest.raises(errors.InputError, match="spacing: must be a positive length in mm, not"):
            profiles.read(path, spacing=spacing)  # type: ignore[arg-type]
    with pytest.raises(errors.InputError, match="lambda_s=0.8: must be below lambda_c=0.08"):
        profiles.read(path, spacing=0.5, lambda_s=0.8, lambda_c=0.08)
    for content, message in (
        ("0 0\n1 0\n", "a filter needs at least 3 points; it has 2"),
        ("nan 1\nnan 2\n", "no height has a value"),
    ):
        path.write_text(content)
        with pytest.raises(errors.InputError, match=message):
            profiles.read(path, lambda_s=0.8)


def test_options_of_maps_are_refused_where_they_have_no_effect(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "trace.csv"
    path.write_text("x [mm] z [mm]\n0 1\n1 2\n2 4\n")
    for options, words in (
        ({"line": 1}, "line would have no effect: remove line"),
        ({"line": "middle", "along": "x"}, "line, along would have no effect: remove line, along"),
        ({"channel": 1}, "channel would have no effect"),
    ):
        with pytest.raises(errors.InputError, match=f"trace.csv: is a text with one profile, for which {words}"):
            profiles.read(path, **options)
    assert main(["profile", str(path), "--channel", "Height"]) == 2
    assert "trace.csv: is a text with one profile, for which channel would have no effect" in capsys.readouterr().err


def test_points_without_a_position_are_omitted(tmp_path: Path) -> None:
    path = tmp_path / "trace.txt"
    path.write_text("x [mm] z [mm]\n0 1\nnan nan\n1 2\n2 nan\n3 1\n")
    profile = profiles.read(path)
    assert profile.x.tolist() == [0.0, 1.0, 2.0, 3.0] and np.isnan(profile.height).tolist() == [False, False, True, False]
    assert profile.notes == [f"{path}: 1 of 5 points have no position and are omitted"]


def test_gaussian_filters_halve_waves_of_the_cutoff(tmp_path: Path) -> None:
    path = tmp_path / "waves.txt"
    x = np.arange(0.0, 40.0, 0.02)
    for wavelength in (0.4, 0.8, 1.6):
        path.write_text("x [mm] z [mm]\n" + "\n".join(f"{a:.6g} {np.sin(2.0 * np.pi * a / wavelength):.9g}" for a in x))
        transmitted = 0.5 ** ((0.8 / wavelength) ** 2)  # ISO 16610-21, equation of the transmission characteristic
        middle = slice(400, -400)
        for options, expected in (({"lambda_s": 0.8}, transmitted), ({"lambda_c": 0.8}, 1.0 - transmitted)):
            height = profiles.read(path, **options).height[middle]
            assert np.ptp(height) / 2.0 == pytest.approx(expected, abs=2e-4)


def test_a_filter_leaves_lines_and_gaps(tmp_path: Path) -> None:
    path = tmp_path / "gaps.txt"
    x = np.arange(50) * 0.1
    path.write_text("x [mm] z [mm]\n" + "\n".join(f"{a:.6g} {'nan' if n in (7, 8) else 2.0}" for n, a in enumerate(x)))
    height = profiles.read(path, lambda_s=0.5).height
    assert np.flatnonzero(~np.isfinite(height)).tolist() == [7, 8]
    np.testing.assert_allclose(height[np.isfinite(height)], -2.0, rtol=1e-12)


def test_files_that_cannot_be_read_say_why(tmp_path: Path) -> None:
    whole = x3p(tmp_path / "whole.x3p").read_bytes()
    for name, content, reason in (
        ("cut.x3p", whole[: len(whole) // 2], "nor a format that SurfaceTopography knows (its reader of .x3p: "),
        ("noise.bin", b"\x01\x02\x00\x03" * 8, "noise.bin:1:1: not a text file: control character 1, nor a format that"),
        ("three.txt", b"a b c\n1 2 x\n", "three.txt:1"),
        ("nothing.sur", b"", ""),
    ):
        path = tmp_path / name
        path.write_bytes(content)
        with pytest.raises(errors.InputError) as raised:
            profiles.read(path)
        assert reason in str(raised.value) and str(raised.value).isprintable()
        assert name in str(raised.value)


def test_without_the_package_the_message_has_the_line_that_installs_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    path = x3p(tmp_path / "scan.x3p")

    def absent(module: str) -> Any:
        raise ModuleNotFoundError(f"the Python package {module} is not installed: pip install it", name=module)

    monkeypatch.setattr(profiles, "needed", absent)
    with pytest.raises(
        ModuleNotFoundError, match=r"scan.x3p:1:\d+: not a text file.*; for files of instruments the Python package"
    ):
        profiles.read(path)
    path = tmp_path / "scan.csv"
    path.write_text("x,z\n0,1\n1,one\n")
    assert main(["profile", str(path)]) == 2
    told = capsys.readouterr().err
    assert "scan.csv:3: must be two numbers, x and height, not '1,one'; for files of instruments the Python package" in told


def test_a_profile_has_two_points_at_a_distance(tmp_path: Path) -> None:
    (tmp_path / "point.csv").write_text("x [mm], z [mm]\n1, 2\n")
    (tmp_path / "heights.csv").write_text("z [mm]\n1\n2\n3\n")
    for options in ({}, {"lambda_s": 1.0}):
        with pytest.raises(errors.InputError, match="point.csv: a profile needs at least two points at different positions"):
            profiles.read(tmp_path / "point.csv", **options)
    with pytest.raises(errors.InputError, match="spacing: must be a positive length in mm, not -1.0"):
        profiles.read(tmp_path / "heights.csv", spacing=-1.0)


@pytest.mark.parametrize("rows", ["0,0\n2,1\n1,4\n", "0 0\n1 1\n1 2\n2 4\n"])
def test_a_text_with_positions_out_of_order_is_refused(tmp_path: Path, rows: str) -> None:
    """Also where SurfaceTopography, which does not sort it, would read it."""
    path = tmp_path / "trace.csv"
    path.write_text("x,z\n" + rows)
    with pytest.raises(errors.InputError, match="trace.csv:4: x must increase from line to line, or decrease; sort the rows"):
        profiles.read(path)


@pytest.mark.parametrize("seed", range(6))
def test_patches_that_the_mesh_misses(seed: int) -> None:
    """Bumps of random heights and places: with a short mesh around one of them the others overlap, which is said; else all bars hold."""
    random = np.random.default_rng(seed)
    places, heights = np.array([-1.0, 0.0, 1.3]) + random.uniform(-0.2, 0.2, 3), random.uniform(0.0, 4e-3, 3)
    x = np.linspace(-2.0, 2.0, 401)
    recess = 0.1 * np.min([(x - place) ** 2 + height for place, height in zip(places, heights)], axis=0)
    bodies = {"lower": Body.half_plane(youngs_modulus=2e5, poisson_ratio=0.3), "upper": Body.profile(x, recess, rigid=True)}
    alone = mfv.run(Scene(**bodies, mesh=Mesh(nodes=101, half_width=abs(places[1]) + 0.4), steps=[Step(normal_force=2000.0)]))
    wide = mfv.run(Scene(**bodies, mesh=Mesh(nodes=401, half_width=2.0), steps=[Step(normal_force=2000.0)]))
    missed = (
        wide.observables.patches > alone.observables.patches
        or wide.observables.contact_length > 1.1 * alone.observables.contact_length
    )
    assert missed == any("overlap beyond the mesh" in warning for warning in alone.warnings)
    assert missed == ("peak_pressure" in alone.unresolved)
    assert not any("overlap" in warning for warning in wide.warnings)


def test_a_text_that_says_recess_is_not_turned(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """What `mfv profile` writes, again through it, through Body.profile and through a case: the same surface."""
    monkeypatch.chdir(tmp_path)
    x = np.linspace(-0.1, 0.1, 41)
    np.savetxt("measured.csv", np.column_stack([1e3 * x, -1e3 * x**2]), delimiter=";", header="x [um];z [um]", comments="")
    for first, second in (("measured.csv", "once.txt"), ("once.txt", "twice.txt")):
        assert main(["profile", first, "-o", second]) in (0, None)
    assert Path("once.txt").read_text().splitlines()[1:] == Path("twice.txt").read_text().splitlines()[1:]
    assert "taken as positive" not in capsys.readouterr().err
    keys = {"level": "none", "rigid": True}
    by_name = [scene(Body.profile(name, **keys)) for name in ("measured.csv", "once.txt", "twice.txt")]
    as_key = scene(Body(shape="profile", file=str(tmp_path / "once.txt"), **keys))
    by_array = scene(Body.profile(x, x**2, **keys))
    pressures = [one.run(check=True).state.pressure for one in (*by_name, as_key, by_array)]
    for pressure in pressures:
        np.testing.assert_allclose(pressure, pressures[-1], rtol=1e-6, atol=1e-6 * pressures[-1].max())
    # Older files of `mfv profile`, and others whose comment says it; an explicit sense counts.
    Path("older.txt").write_text("# a.x3p; height: distance by which the surface recedes\nx [mm] height [mm]\n0 0\n1 2\n")
    assert profiles.read("older.txt").height.tolist() == [0.0, 2.0]
    assert profiles.read("older.txt", outwards=True).height.tolist() == [0.0, -2.0]


def test_sense_of_heights_is_said_if_nothing_is_known(tmp_path: Path) -> None:
    path = tmp_path / "numbers.txt"
    path.write_text("0 0\n1 2\n2 3\n")
    assert any("positive out of the material; outwards=False" in note for note in profiles.read(path).notes)
    assert len(profiles.read(path, outwards=True).notes) == 1
    with pytest.raises(TypeError, match="Body.profile has no 'inwards'; did you mean outwards=False"):
        Body.profile(path, inwards=True)
    with pytest.raises(TypeError, match="did you mean lambda_s"):
        Body.profile(path, lamda_s=0.1)
