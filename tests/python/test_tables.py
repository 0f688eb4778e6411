"""Texts of instruments, spreadsheets and programs: by the library and by Python alike. All numbers here are invented."""

from __future__ import annotations

import itertools
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mfv
from mfv import Body, Mesh, Scene, Step, errors, identify, profiles, tables
from mfv._suggestions import suggestion

X = [-0.2, -0.1, -0.05, 0.0, 0.05, 0.1, 0.25]
HEIGHT = [0.04, 0.01, 0.0025, 0.0, 0.0025, 0.01, 0.0625]


def text(heading: str = "", separator: str = " ", end: str = "\n", comma: bool = False, **others: Any) -> str:
    """The points as a text. `last`: after every row; `first`: whether rows are numbered; `quote`: around cells."""
    rows = []
    for number, cells in enumerate(zip(X, HEIGHT), start=1):
        written = [f"{others.get('quote', '')}{cell}{others.get('quote', '')}" for cell in cells]
        written = [cell.replace(".", ",") if comma else cell for cell in written]
        rows.append(separator.join([str(number)] * others.get("first", False) + written) + others.get("last", ""))
    return end.join([*heading.splitlines(), *rows]) + end


TEXTS: dict[str, bytes] = {
    "blanks": text().encode(),
    "byte-order mark": text("x;z", ";").encode("utf-8-sig"),
    "UTF-16": text("x [um] z [um]").encode("utf-16"),
    "UTF-16, high byte first": b"\xfe\xff" + text("x,z", ",").encode("utf-16-be"),
    "UTF-16 without a mark": text(separator="\t").encode("utf-16-le"),
    "Latin-1": text("X (\xb5m);Z (\xb5m)", ";").encode("latin-1"),
    "CR LF": text(end="\r\n").encode(),
    "CR CR LF": text("Scan A,\nx,z", ",", "\r\r\n").encode(),
    "CR": text(end="\r").encode(),
    "end of a DOS file": text(end="\r\n").encode() + b"\x1a",
    "tabs": text("x\tz", "\t").encode(),
    "two tabs": text(separator="\t\t").encode(),
    "blanks around separators": text(separator=" ; ").encode(),
    "trailing commas": text("x,z,", ",", last=",").encode(),
    "an empty row of a spreadsheet": (text("x;z", ";", last=";;") + ";;;\n").encode(),
    "quotes": text('"x","z"', ",", quote='"').encode(),
    "quoted decimal commas": text('"x","z"', ",", comma=True, quote='"').encode(),
    "decimal commas and semicolons": text("x;z", ";", comma=True).encode(),
    "decimal commas and tabs": text("x\tz", "\t", comma=True).encode(),
    "decimal commas and blanks": text(comma=True).encode(),
    "comments": ("% a\n// b\n! c\n" + text(last=" # d")).encode(),
    "a preamble": text("Profilometer,A1\nDate,2026-01-02\n12 points,\nGain,0.5\nLateral mm,Raw mm,", ",", last=",,").encode(),
    "a count": f"mm mm\n{len(X)}\n{text()}".encode(),
    "row numbers": text("No;x;z", ";", first=True).encode(),
    "decreasing": "\n".join(text().splitlines()[::-1]).encode(),
    "minus signs and no-break spaces": text().replace("-", "\u2212").replace(" ", "\u00a0").encode(),
    "exponents": text().replace("0.25", "2.5D-1").replace("\n0.1 ", "\n+1e-1 ").encode(),
    "dropouts": (text() + "0.3 NaN\n0.35 --\nnan nan\n").encode(),
    "dropouts between commas": (text("x,z", ",") + "0.3,\n0.35,,\n").encode(),
    "dropouts after tabs": (text(separator="\t") + "0.3\t\n0.35\tbad\n").encode(),
}


def scene(body: Body, name: str = "scene") -> Scene:
    mesh, press = Mesh(nodes=40, half_width=0.08), Step(normal_force=1.0e-3)
    return Scene(Body.half_plane(shear_modulus=1.0, poisson_ratio=0.3), body, mesh=mesh, steps=[press], name=name)


@pytest.mark.parametrize("name", TEXTS)
def test_a_text_is_the_same_for_python_and_the_library(tmp_path: Path, name: str) -> None:
    path = tmp_path / "trace.txt"
    path.write_bytes(TEXTS[name])
    trace = tables.read_trace(path)
    valued = np.isfinite(trace.height) & np.isfinite(trace.x)
    np.testing.assert_array_equal(trace.x[valued], X)
    np.testing.assert_array_equal(trace.height[valued], HEIGHT)
    by_library = scene(Body(shape="profile", file=path, rigid=True)).run()
    by_python = scene(Body.profile(X, HEIGHT, rigid=True)).run()
    np.testing.assert_array_equal(by_library.state.pressure, by_python.state.pressure)
    warned = [line for line in by_library.attributes.get("warnings", "").splitlines() if "have no value" in line]
    gaps = int(np.sum(~valued))
    assert bool(warned) == bool(gaps)
    if warned:
        assert f"{gaps} of {len(X) + gaps} points of the profile of the upper body have no value and are omitted" in warned[0]


def test_heights_alone(tmp_path: Path) -> None:
    path = tmp_path / "heights.txt"
    for content in ("z [mm]\n0,04\n0,01\n0,0\n0,01\n0,04\n", "5\n0.04\n0.01\n0.0\n0.01\n0.04\n", "0,04\n0,01\n0,00\n0,01\n0,04"):
        path.write_text(content)
        trace = tables.read_trace(path)
        assert trace.x is None and trace.height.tolist() == [0.04, 0.01, 0.0, 0.01, 0.04]
        alone = scene(Body(shape="profile", file=path, rigid=True, position_scale=0.1, centred=True)).run()
        both = scene(Body.profile(0.1 * np.arange(5), trace.height, rigid=True, centred=True)).run()
        np.testing.assert_array_equal(alone.state.pressure, both.state.pressure)
    with pytest.raises(errors.InputError, match="has one column, heights; give the distance between them as position_scale"):
        scene(Body(shape="profile", file=path, rigid=True)).contact()


@pytest.mark.parametrize(
    "content, message",
    [
        (b"0 0\n1 one\n2 2\n", "trace.txt:2"),
        (b"0 0\n1 1,5x\n2 2\n", "trace.txt:2"),
        (b"0 0 0\n1 1 1\n2 2 2\n2.5 3 3\n", "trace.txt:1: must be two numbers, x and height, not '0 0 0'"),
        (b"1 5 1\n2 4 1\n3 6 1\n", "trace.txt:1: must be two numbers"),
        (b"9\n0 0\n1 1\n2 2\n", "trace.txt:1: the file has 3 rows, not 9"),
        (b"2 0\n1 1\n1.5 2\n", "trace.txt:3: x must increase from line to line, or decrease"),
        (b"0 0\n1 1\n2 2\nend\n", "trace.txt:4"),
        (b"2026-01-02 10:30\n0 0\n1 1\n", "trace.txt:1"),
        (b"0 0\n1 \x07\n", "trace.txt:2:3: not a text file: control character 7"),
        (b"\x89PNG\r\n\x1a\n\0\0", "trace.txt:2:1: not a text file: control character 26"),
        (b"0.1,0.2,0.3\n", "trace.txt:1: must be two numbers"),
    ],
)
def test_a_text_is_refused_by_both_with_its_line(tmp_path: Path, content: bytes, message: str) -> None:
    path = tmp_path / "trace.txt"
    path.write_bytes(content)
    with pytest.raises(errors.MfvError, match=re.escape(message)):
        tables.read_trace(path)
    with pytest.raises(errors.InputError, match=re.escape(message)) as raised:
        scene(Body(shape="profile", file=path, rigid=True)).contact()
    assert str(raised.value).isprintable()


def test_a_load_history_from_other_programs(tmp_path: Path) -> None:
    path = tmp_path / "loads.csv"
    loads = [2.0e-4, -2.0e-4, 2.0e-4]
    written = "\n".join(f"{row},0;{load}".replace(".", ",") for row, load in enumerate(loads))
    contents = (
        "\ufefftangential_force\n" + "\n".join(map(str, loads)),
        "# Time tangential_force\n" + "\n".join(f"{row}\t{load}" for row, load in enumerate(loads)),
        'Test A\n"Time [s]";"tangential_force";\n' + written.replace("\n", ";\n") + ";",
    )
    body = Body.disk(0.25, rigid=True)
    for content, encoding in itertools.product(contents, ("utf-8", "utf-16")):
        path.write_text(content.lstrip("\ufeff") if encoding == "utf-16" else content, encoding=encoding)
        case = scene(body)
        case.friction, case.history = mfv.Friction.coulomb(0.5), mfv.History(file=path)
        case.output = mfv.Output(states="reversals")
        reached = [float(state.tangential_force) for state in case.run().steps[1:]]
        assert reached == pytest.approx(loads, rel=1e-9)
    for content, message in (
        ("tangential_force;time\n1e-4;0\n;1\n", "loads.csv:3: must have a value in every column"),
        (
            "Time;Tangential_Force;tangential_force\n0;1e-4;2e-4\n",
            "columns 2 and 3 have the same name, Tangential_Force; remove one",
        ),
        (
            "Time (s);Tangential_Force [N/mm]\n0;1e-4\n",
            r"unknown column 'Tangential_Force .N/mm.'; write tangential_force without its unit, and numbers in the units of the case",
        ),
        ("time;tangential_force\n10:30:05;1e-4\n", "loads.csv:2:1: must be two numbers"),
    ):
        path.write_text(content)
        with pytest.raises(errors.InputError, match=message):
            case.contact()


@pytest.mark.parametrize(
    "heading, x, height",
    [
        ("z [mm]", None, [0.5, 1.2, 2.7]),
        ("# Height", None, [0.5, 1.2, 2.7]),
        ("height, mm", None, [0.5, 1.2, 2.7]),
        ("Scan of pad 3\nz\nmm", None, [0.5, 1.2, 2.7]),
        ("x,z", [0.0, 1.0, 2.0], [5.0, 2.0, 7.0]),
        ("Gain,3\nx,z\nmm,um", [0.0, 1.0, 2.0], [5.0, 2.0, 7.0]),
        ("x [mm] z [mm]", [0.0, 1.0, 2.0], [5.0, 2.0, 7.0]),
        ("", None, None),
        ("Scan of pad", None, None),
        ("# Pad3", None, None),
        ("Length,4.8 mm", None, None),
    ],
)
def test_whole_numbers_and_commas_are_read_by_the_names_above(tmp_path: Path, heading: str, x: Any, height: Any) -> None:
    path = tmp_path / "trace.txt"
    path.write_text(f"{heading}\n0,5\n1,2\n2,7\n")
    if height is None:
        with pytest.raises(
            errors.InputError, match="0,5' may be x and height, or one height with a decimal comma; name the columns"
        ) as told:
            profiles.read(path)
        assert "give spacing in mm" in str(told.value)
        height = [0.5, 1.2, 2.7]
    else:
        trace = tables.read_trace(path)
        assert (None if trace.x is None else trace.x.tolist(), trace.height.tolist()) == (x, height)
    if x is None:
        assert (
            profiles.read(path, spacing=0.5, outwards=False, file_unit="mm" if "mm" not in heading else None).height.tolist()
            == height
        )


def test_two_names_above_refuse_x_that_turns(tmp_path: Path) -> None:
    path = tmp_path / "trace.txt"
    path.write_text("x,z\n3,5\n1,2\n2,2\n")
    with pytest.raises(errors.MfvError, match="trace.txt:4: x must increase from line to line, or decrease"):
        tables.read_trace(path)


ROWS = [(0.0, 0.0, 100.0), (1.0, 0.5, 100.0), (2.0, 1.0, 100.0), (1.0, 0.75, 100.0), (0.0, 0.25, 100.0)]


def loops(heading: str, separator: str = ",", comma: bool = False, last: str = "") -> str:
    rows = [separator.join(map(str, row)) + last for row in ROWS]
    return "\n".join([heading, *([row.replace(".", ",") for row in rows] if comma else rows)]) + "\n"


@pytest.mark.parametrize(
    "content, options",
    [
        (loops("Q,U,P").encode("utf-8-sig"), {}),
        (loops("Q,U,P").encode("utf-16"), {}),
        (loops("Q,U,P").replace("\n", "\r\r\n").encode(), {}),
        (loops("Q;U;P", ";", comma=True).encode(), {}),
        (loops("Q\tU\tP", "\t", comma=True).encode(), {}),
        (loops("Q U P", " ").encode(), {}),
        (loops("# Q U P", " ").encode(), {}),
        (loops('"Q","U","P",', last=",").encode(), {}),
        (loops("Rig A,3\nOperator:,Q\n\nQ,U,P").encode(), {}),
        (loops("Q [N/mm],U [mm],P [N/mm]").encode(), {}),
        (loops("Q [N/mm] U [mm] P [N/mm]", " ").encode(), {}),
        (loops("Q (kN/m);U (\xb5m);P (N/mm)", ";").replace(";0.5;", ";500;").encode("latin-1"), {"units": {"shift": "mm"}}),
        (loops("Q,U,P\nN/mm,mm,N/mm").encode(), {}),
        (loops("Q;U;P\n[kN/m];[mm];[N/mm]", ";").encode(), {}),
        (loops("time,Q,U,P\ns,N/mm,mm,N/mm").replace("\n", "\n0,").replace("\n0,s", "\ns").rstrip("0,").encode(), {}),
        (loops("Q/(N/mm);U/mm;P/(N/mm)", ";").encode(), {}),
        (loops("Q [-],U,P (N/mm)").encode(), {}),
        (loops("Fx,disp,Fn").encode(), {"columns": {"tangential_force": "Fx", "shift": "disp", "normal_force": "fn"}}),
        (loops("a,b,c").encode(), {"columns": {"tangential_force": 1, "shift": 2, "normal_force": 3}}),
        (loops("Q,U,remark").replace(",100.0", ",ok").encode(), {"normal_force": 100.0}),
    ],
)
def test_loops_are_read_as_they_come(tmp_path: Path, content: bytes, options: dict[str, Any]) -> None:
    path = tmp_path / "loops.csv"
    path.write_bytes(content)
    if "500" in content.decode("latin-1"):
        content = content.replace(b"500", b"0.5")
        path.write_bytes(content)
    (loop,) = identify.read(path, **options)
    assert loop.tangential_force.tolist() == [row[0] for row in ROWS]
    assert loop.shift.tolist() == [row[1] for row in ROWS]
    assert loop.normal_force == 100.0


def test_units_thickness_and_signs(tmp_path: Path) -> None:
    path = tmp_path / "loops.csv"
    path.write_text(loops("Q [kN],U [um],P [N]").replace(",100.0", ",100"))
    (loop,) = identify.read(path, thickness=10.0, sign={"shift": -1})
    np.testing.assert_allclose(loop.tangential_force, [100.0 * row[0] for row in ROWS])
    np.testing.assert_allclose(loop.shift, [-1.0e-3 * row[1] for row in ROWS])
    assert loop.normal_force == pytest.approx(10.0)
    (loop,) = identify.read(path, thickness=0.01, length_unit="m", force_unit="kN")
    np.testing.assert_allclose(loop.tangential_force, [100.0 * row[0] for row in ROWS])
    np.testing.assert_allclose(loop.shift, [1.0e-6 * row[1] for row in ROWS])
    with pytest.raises(errors.InputError, match="column Q .kN.: is a force in kN, .*; give the thickness in mm"):
        identify.read(path)
    path.write_text(loops("Q,U,P"))
    with pytest.raises(errors.InputError, match="thickness: must be a positive length in mm, not -1.0"):
        identify.read(path, thickness=-1.0)
    (loop,) = identify.read(path, thickness=10.0, units={"shift": "nm"})
    assert loop.normal_force == 10.0 and loop.shift.max() == pytest.approx(1.0e-6)
    for options, message in (
        ({"units": {"shift": "furlong"}}, "unknown unit 'furlong'; known are m, cm, mm"),
        ({"units": {"shift": "N"}}, "a value in N is a force and cannot be in mm"),
        ({"sign": {"U": -1}}, "sign: 'U' is not one of tangential_force, shift"),
        ({"columns": {"shift": "dU"}}, "no column du; there are Q, U, P"),
    ):
        with pytest.raises(errors.InputError, match=message):
            identify.read(path, **options)


@pytest.mark.parametrize(
    "heading, name, unit",
    [
        ("x [mm]", "x", "mm"),
        ("X (µm)", "x", "um"),
        ("y in µm", "y", "um"),
        ("Q / N", "q", "N"),
        ("Force [kN/m]", "force", "kN/m"),
        ("Lateral um", "lateral", "um"),
        ("X_(microns)", "x_", "um"),
        ("Micrometer", "micrometer", "um"),
        ("Q", "q", ""),
        ("y1", "y1", ""),
        ("shift [furlong]", "shift", ""),
        ("U/µm", "u", "um"),
        ("Q/(N/mm)", "q", "N/mm"),
        ("Q lb/in", "q lb/in", ""),
    ],
)
def test_units_of_headings(heading: str, name: str, unit: str) -> None:
    assert (tables.name_of(heading), tables.unit_of(heading)) == (name, unit)


@pytest.mark.parametrize(
    "heading, units",
    [
        ("x in mm z in um", ("mm", "um")),
        ("x/mm;z/µm", ("mm", "um")),
        ("# x [um] z [nm]", ("um", "nm")),
        ("x;z\nmm;um", ("mm", "um")),
        ("x1 mm;z1 um", ("mm", "um")),
        ("# all lengths in mm", ("", "mm")),
        ("x [um] z [nm]\n# line 3, y [mm]", ("um", "nm")),
        ("Cutoff 0.8 mm", ("", "")),
        ("Length 4.8 mm, cutoff 0.8 mm", ("", "")),
        ("Cutoff;0.8 mm\nx;z", ("", "")),
        ("Spacing;0.5;um", ("", "")),
    ],
)
def test_units_of_a_trace(tmp_path: Path, heading: str, units: tuple[str, str]) -> None:
    path = tmp_path / "trace.txt"
    path.write_text(f"{heading}\n{text()}", encoding="utf-8")
    trace = tables.read_trace(path)
    assert (trace.x_unit, trace.height_unit) == units and trace.x is not None and trace.x.tolist() == X


@pytest.mark.parametrize(
    "heading, options, message",
    [
        (
            "Q [KN],U [mm],P [KN]",
            {},
            r"column Q \[KN\]: unknown unit 'KN'; say what it is, such as units={'tangential_force': 'N/mm'}",
        ),
        ("Q,U (V),P", {}, r"column U \(V\): unknown unit 'V'; say what it is, such as units={'shift': 'mm'}"),
        ("Q [lb/in],U,P", {}, "unknown unit 'lb/in'"),
        ("Q,U,P\n[KN],[mm],[KN]", {}, "column Q: unknown unit 'KN'"),
        ("U,U,P", {"columns": {"tangential_force": 1}}, "columns 1, 2 have the same name, U; choose one by its number"),
        ("Q,U,P", {"thickness": -8.0}, "thickness: must be a positive length in mm, not -8"),
        ("Q,U,P", {"columns": {"shift": 2.0}}, "columns: shift must be the name of a column or its number from 1, not 2.0"),
        ("Q,U,P", {"sign": {"shift": "-"}}, "sign: shift must be a factor, such as -1, not '-'"),
        ("Q,U,P", {"units": {"shift": 5}}, "units: shift must be a unit, such as 'um', not 5"),
    ],
)
def test_what_would_be_a_wrong_number_is_refused(tmp_path: Path, heading: str, options: dict[str, Any], message: str) -> None:
    path = tmp_path / "loops.csv"
    path.write_text(loops(heading))
    with pytest.raises(errors.InputError, match=message):
        identify.read(path, **options)


def test_an_unknown_unit_is_replaced_and_a_temperature_is_no_time(tmp_path: Path) -> None:
    path = tmp_path / "loops.csv"
    rows = "\n".join(f"{20 + number},{','.join(map(str, row))}" for number, row in enumerate(ROWS))
    for heading, is_time in (("T [C]", False), ("t [mm]", False), ("t", True), ("Time (s)", True)):
        path.write_text(f"{heading},Q [V],U [mm],P\n{rows}\n")
        (loop,) = identify.read(path, units={"tangential_force": "N/mm"})
        assert loop.tangential_force.tolist() == [row[0] for row in ROWS]
        assert (loop.time is not None) == is_time


@pytest.mark.parametrize(
    "heading, cells, times, note",
    [
        ("Time", ["12:03:04.5", "12:03:05", "12:03:05.25", "12:03:06", "12:03:10"], [0.0, 0.5, 0.75, 1.5, 5.5], ""),
        ("Time (hh:mm:ss)", ["23:59:59", "00:00:01", "00:00:02", "00:00:03", "00:00:04"], [0.0, 2.0, 3.0, 4.0, 5.0], ""),
        ("t", ["59:58.5", "59:59", "1:00:00", "1:00:01", "1:00:02"], [0.0, 0.5, 1.5, 2.5, 3.5], ""),
        ("time", [f"2026-01-0{1 + day}T23:00:00Z" for day in range(5)], [86400.0 * day for day in range(5)], ""),
        (
            "time",
            [f"{28 + day}.02.2026 1:00:00" if day == 0 else f"0{day}.03.2026 1:00:00" for day in range(5)],
            [86400.0 * n for n in range(5)],
            "",
        ),
        (
            "time",
            [f"1/2/2026 {hour % 12 or 12}:00:00 {'AP'[hour > 11]}M" for hour in range(10, 15)],
            [3600.0 * n for n in range(5)],
            "",
        ),
        ("time [min]", ["1", "2", "3", "4", "5"], [1.0, 2.0, 3.0, 4.0, 5.0], ""),
        (
            "time",
            [f"{day}/2/2026 1:00:00" for day in range(1, 6)],
            None,
            "'1/2/2026 1:00:00' is not a number or a time of the day such as 12:03:04.5",
        ),
        ("time", ["1", "2", "2", "3", "4"], None, "it does not increase from row 2 to the next"),
        ("time", ["12:00:00", "12:00:01", "late", "12:00:03", "12:00:04"], None, "'12:00:00' is not a number or"),
        ("time [furlong]", ["1", "2", "3", "4", "5"], None, "furlong is not a unit of time"),
        ("T [C]", ["20", "21", "22", "23", "24"], None, ""),
    ],
)
def test_times_of_the_day_are_seconds_or_are_said_to_be_unused(
    tmp_path: Path, heading: str, cells: list[str], times: list[float] | None, note: str
) -> None:
    path = tmp_path / "loops.csv"
    path.write_text("\n".join([f"{heading};Q;U;P", *(";".join([cell, *map(str, row)]) for cell, row in zip(cells, ROWS))]) + "\n")
    table = {heading: cells, **dict(zip("QUP", np.array(ROWS).T))}
    for (loop,) in (identify.read(path), identify.loops_of(table)):
        assert (None if loop.time is None else loop.time.tolist()) == times
        assert len(loop.notes) == bool(note) and all(note in told and f"column {heading}" in told for told in loop.notes)


def test_dates_of_a_data_frame_are_seconds() -> None:
    import pandas

    table = pandas.DataFrame(np.array(ROWS), columns=["Q", "U", "P"])
    for zone in (None, "UTC"):
        table["time"] = pandas.date_range("2026-01-02 12:00", periods=5, freq="250ms", tz=zone)
        (loop,) = identify.loops_of(table)
        assert loop.time is not None and loop.time.tolist() == [0.0, 0.25, 0.5, 0.75, 1.0]


def test_a_time_that_is_not_used_is_a_warning_of_the_fit() -> None:
    case, loop = synthetic()
    table = {"Q": loop.tangential_force, "U": loop.shift, "P": np.full(loop.shift.size, 100.0), "time": np.zeros(loop.shift.size)}
    fitted = identify.fit(case, identify.loops_of(table, shift_noise=1.0e-4), {"friction%mu": 0.5, "rig_stiffness": 8.0e4})
    assert any("column time is not used: it does not increase from row 1 to the next" in warning for warning in fitted.warnings)


def test_faults_of_tables_in_memory() -> None:
    table: dict[str, Any] = dict(zip("QUP", np.array(ROWS).T))
    for test, message in (
        (["a"] * 4 + [np.nan], "column test has empty cells"),
        (["a"] * 4 + [None], "column test has empty cells"),
        (["a"] * 3, "column test has 3 rows; table: column Q has 5"),
    ):
        with pytest.raises(errors.InputError, match=message):
            identify.loops_of({**table, "test": np.array(test, dtype=object)})
    with pytest.raises(errors.InputError, match="remove the rows with gaps, the first is row 2"):
        identify.loops_of({**table, "U": [0.0, np.nan, 1.0, 0.75, 0.25]})


def synthetic(seed: int = 0) -> tuple[Scene, identify.Loop]:
    """Two cylinders and a loop with mu = 0.45, rig stiffness 1e5 N/mm per mm, 1 % noise."""
    elastic = {"youngs_modulus": 70000.0, "poisson_ratio": 0.3}
    case = Scene(
        Body.half_plane(**elastic),
        Body.disk(10.0, **elastic),
        friction=mfv.Friction.coulomb(0.45),
        mesh=Mesh(nodes=41, gap="parabolic"),
        coupling="none",
    )
    planned = identify.Loop.planned(100.0, 35.0, rows=120, shift_noise=1.0e-4)
    return case, identify.simulate(case, planned, {"rig_stiffness": 1.0e5}, seed=seed)[0]


@pytest.mark.parametrize(
    "force, shift, normal_force, message",
    [
        (1.0, 1.0, 1.0, ""),
        (1.0, 1.0e3, 1.0, "of the stiffness of contact and rig: a shift in micrometres where the scene has millimetres"),
        (8.0, 1.0, 8.0, "times as stiff as the contact, which a rig can only make softer: forces in N where the scene has N/mm"),
        (1.0, 1.0e-3, 1.0, "times as stiff as the contact"),
        (1.0, -1.0, 1.0, "shift and tangential force have opposite signs (the loop runs clockwise"),
        (12.0, 1.0, 1.0, "the tangential force reaches 4.2 times the normal force: their units differ"),
    ],
)
def test_a_wrong_unit_or_sign_is_named(force: float, shift: float, normal_force: float, message: str) -> None:
    case, loop = synthetic()
    wrong = identify.Loop(force * loop.tangential_force, shift * loop.shift, normal_force * 100.0, shift_noise=None)
    wrong.force_noise, wrong.shift_noise = 0.0, abs(shift) * 1.0e-4
    try:
        warnings = "; ".join(identify.fit(case, wrong, {"friction%mu": 0.5, "rig_stiffness": 8.0e4}).warnings)
    except errors.InputError as error:
        warnings = str(error)
    if message:
        assert message in warnings
    else:
        assert not any(word in warnings for word in ("wrong way", "times as stiff", "of the stiffness", "their units"))


def test_rows_in_reverse_order_are_named() -> None:
    case, loop = synthetic()
    loop.tangential_force, loop.shift = loop.tangential_force[::-1].copy(), loop.shift[::-1].copy()
    warnings = "; ".join(identify.fit(case, loop, {"friction%mu": 0.5, "rig_stiffness": 8.0e4}).warnings)
    assert "the loop runs the wrong way round, friction would do negative work" in warnings


def test_messages_about_names_list_only_a_few() -> None:
    many = [f"column_{i:03}" for i in range(130)]
    assert suggestion("column_12", many, listed_by="'mfv info'").endswith("? 'mfv info' lists all")
    assert suggestion("xyz", many, listed_by="'mfv info'") == (
        "; choose from column_000, column_001, column_002, column_003, column_004 and 125 others, which 'mfv info' lists"
    )
    assert suggestion("xyz", ["a", "b"]) == "; choose from a, b"
    message = str(tables.missing_columns("loops.csv", {"force": ("q",)}, many))
    assert message.endswith("no column Q; there are column_000, column_001, column_002, column_003, column_004 and 125 others")
