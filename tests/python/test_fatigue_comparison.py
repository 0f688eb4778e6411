"""Series of fretting-fatigue tests: their tables, predicted lives, and what is said about them; every row here is made up."""

import math
from pathlib import Path

import pytest

import mfv
from mfv import fatigue
from mfv.commands import main
from mfv.fatigue import comparison
from mfv.fatigue.comparison import PARAMETERS, PLACES, PadTest, Prediction, judge, statement

ROOT = Path(__file__).resolve().parents[2]


def table(*rows: dict[str, object], separator: str = ",") -> str:
    """A table of tests: the row of the template with some values changed."""
    names = list(comparison.COLUMNS)
    lines = [separator.join(map(comparison.label, names))]
    for number, row in enumerate(rows, start=1):
        cells = {name: column.example for name, column in comparison.COLUMNS.items()} | {"test": number, "source": "made up"} | row
        text = separator.join(str(cells[name]) for name in names)
        lines.append(text.replace(".", ",") if separator == ";" else text)
    return "\n".join([*lines, ""])


def read(path: Path, *rows: dict[str, object], **options: str) -> list[PadTest]:
    path.write_text(table(*rows, **options))
    return comparison.read_tests(path)


def test_the_template_is_a_table_whose_row_is_not_counted(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(["fatigue", "--new", "tests.csv"]) == 0
    assert main(["fatigue", "--new", "tests.csv"]) == 2 and "exists, not overwritten" in capsys.readouterr().err
    (test,) = comparison.read_tests("tests.csv")
    assert test.is_invented and "invented to show the columns" in test["source"]
    assert main(["fatigue", "tests.csv", "--nodes", "41", "-o", "tests.png"]) == 0
    printed = capsys.readouterr().out
    assert "1 (invented)" in printed and "no row is a failed test that somebody has measured" in printed
    assert Path("tests.png").stat().st_size > 20_000 and sorted(path.name for path in tmp_path.iterdir()) == [
        "tests.csv",
        "tests.png",
    ]
    for options, words in (
        ([], "no table given"),
        (["no.csv"], "No such file"),
        (["tests.csv", "-o", "x.txt"], "must end with .png"),
    ):
        assert main(["fatigue", *options]) == 2
        assert words in capsys.readouterr().err


def test_every_column_is_printed_by_the_command_that_the_page_names(capsys):
    assert main(["fatigue", "--columns"]) == 0
    printed = capsys.readouterr().out
    assert all(f"| `{name}` |" in printed for name in comparison.COLUMNS)
    assert "`mfv fatigue --columns`" in (ROOT / "docs/fatigue.md").read_text()


@pytest.fixture(scope="module")
def series(tmp_path_factory) -> list[Prediction]:
    """Pads of three sizes."""
    folder = tmp_path_factory.mktemp("series")
    rows = [{"pad_radius": radius, "normal_force": 2.0 * radius, "tangential_force": 0.8 * radius} for radius in (12.5, 50, 125)]
    return [comparison.predict(test, 41) for test in read(folder / "tests.csv", *rows)]


def test_predictions_are_those_of_the_functions(series):
    """One life by hand, from the same loads as a text; the size effect: similar stresses have the same life at the hot spot, and longer
    ones below smaller pads."""
    text = """&scene length_unit='mm', force_unit='N' /
    &body shape='half_plane', youngs_modulus=70000, poisson_ratio=0.33 /
    &body shape='disk', radius=50, youngs_modulus=70000, poisson_ratio=0.33 /
    &friction law='coulomb', mu=0.7 /
    &mesh nodes=41 /
    &step normal_force=100, friction=.false. /
    &step tangential_force=40, lower_bulk_stress=100 /
    &step tangential_force=-40, lower_bulk_stress=-100, cycles=2 /
    """
    result = mfv.run(text=text)
    length = (4.0 * math.sqrt(1000.0) / 250.0) ** 2 / math.pi
    x = float(mfv.stress.stress(result, 0.0, 0.0).tension.x)
    curve = fatigue.StrainLife(70000.0, 900.0, -0.1, 0.2, -0.6, 0.33)
    k = fatigue.findley_constant(1.0, 1.0 / math.sqrt(3.0))
    value = fatigue.findley(fatigue.averaged_cycle(result, x, length, method="point"), k=k).maximum.value
    assert series[1].lives["Findley", "point"] == pytest.approx(fatigue.life(value, lambda n: curve.findley(n, k=k)), rel=1e-3)
    assert series[1].half_width == pytest.approx(result.summary.contact_half_width)
    small, _, large = series
    for parameter in PARAMETERS:
        assert small.lives[parameter, "hot spot"] == pytest.approx(large.lives[parameter, "hot spot"], rel=1e-3)
        assert small.lives[parameter, "point"] > 3.0 * large.lives[parameter, "point"] > 10.0 * large.lives[parameter, "hot spot"]


def test_the_parameter_that_made_the_lives_is_found(series):
    """Lives by Fatemi and Socie at the point, run-outs half as long: it fits, the hot spot does not."""
    lives = [one.lives["Fatemi-Socie", "point"] for one in series]
    tests = [
        Prediction(
            PadTest(one.test.values | {"life": 1.1 * life if failed else 0.5 * life, "failed": failed}, one.test.where),
            one.half_width,
            one.lives,
        )
        for failed in (True, False)
        for one, life in zip(series, lives)
    ]
    said = statement(tests)
    assert "Within a factor of 2 of all (3 failed tests and 3 run-outs): Fatemi-Socie (point)" in said
    assert "hot spot" not in said and said.endswith("Fewer than 5 failed tests are too few to prefer one.")
    best = judge(tests)[0]
    assert best.within == (3, 3) and best.run_outs == 3 and best.worst < 2.0


def made_up(factors: list[float], failed: bool = True, **lives: float) -> list[Prediction]:
    """Tests whose predicted lives are these multiples of the measured ones, by every parameter at every place."""
    values = {"life": 1e5, "failed": failed, "source": "made up", "test": "1"}
    return [
        Prediction(PadTest(values, "x.csv:2"), 1.0, {(p, q): 1e5 * factor for p in PARAMETERS for q in PLACES})
        for factor in factors
    ]


def test_bands_and_run_outs_are_counted():
    failed, run_outs = made_up([0.4, 0.6, 1.0, 1.9, 4.0, 7.0]), made_up([0.5, 3.0], failed=False)
    verdict = judge([*failed, *run_outs])[0]
    assert verdict.within == (3, 5) and verdict.run_outs == 1 and verdict.median == pytest.approx(1.45) and verdict.worst == 7.0
    said = statement([*failed, *run_outs])
    assert "None is within a factor of 5 of all (6 failed tests and 2 run-outs)" in said
    assert "within a factor of 7; it predicts failure of 1 run-out." in said and "too few" not in said
    assert "Within a factor of 5 of all (5 failed tests):" in statement(failed[:5])


@pytest.mark.parametrize(
    "change, words",
    [
        ({"pad_radius": -5}, ":2: pad_radius [mm]='-5': must be a number above 0"),
        ({"strength_exponent": 0.1}, "strength_exponent='0.1': must be a number below 0"),
        ({"poisson_ratio": "abc"}, "poisson_ratio='abc': must be a number from 0 to 0.5"),
        ({"life": "inf"}, "life [cycles]='inf': must be a number above 0"),
        ({"mu": ""}, "mu is empty: coefficient of friction"),
        ({"failed": "maybe"}, "failed='maybe': must be yes or no"),
        ({"tangential_force": 80}, "tangential_force=80 is not below the sliding limit mu P = 70 N/mm"),
        ({"normal_force": ""}, "needs normal_force or peak_pressure"),
        ({"peak_pressure": 200}, "normal_force=100 and peak_pressure=200 contradict each other"),
        ({"shear_ratio": 1.2}, "shear_ratio=1.2: must be at most 1, the smallest over the largest tangential_force"),
        ({"bulk_ratio": 10}, "bulk_ratio=10: must be at most 1, the smallest over the largest bulk_stress"),
        ({"torsion_ratio": 0.4}, "torsion_ratio=0.4: must be at least 0.5 and less than 1"),
    ],
)
def test_bad_rows_are_named(change, words, tmp_path):
    with pytest.raises(mfv.errors.InputError) as caught:
        read(tmp_path / "tests.csv", change)
    assert words in str(caught.value) and str(tmp_path / "tests.csv") in str(caught.value)


@pytest.mark.parametrize(
    "text, words",
    [
        (table({}).replace("pad_radius [mm]", "pad_radius [m]"), "column pad_radius is in m; it must be in mm"),
        (table({}).replace("pad_radius [mm]", "pad_radus"), "unknown column 'pad_radus'; did you mean pad_radius?"),
        (table({}).replace("torsion_ratio", "mu"), "column mu is given twice"),
        (
            table({}).replace("made up", "made up,1"),
            ":2: must have 26 cells, as many as the names of the columns, not the 27 of '1,made up,1,",
        ),
        (table({}).replace("0.33,", "0,33,"), "; decimal commas need semicolons or tabs between cells, texts with"),
        (table({}).replace("made up", "made; up").replace("0.33,", "0,33,"), "not the 27 of '1,made; up,"),
        (
            "&scene length_unit='mm', force_unit='N' /\n&step /\n",
            "unknown column '&scene length_unit='mm'; choose from test, source",
        ),
        (table({}, {"mu": "x"}).replace("made up", '"made\n\nup, #2"', 1), ":5: mu='x': must be a number"),
        (table({"mu": "0.6"}, separator=";").replace("0,6;", "0.6;"), ":2: mu='0.6': must be a number above 0"),
        (table().rstrip() + "\n" + 25 * "," + "\n", "no tests; 'mfv fatigue --new FILE.csv' writes a table"),
        (table({}, {"test": 1}), ":3: test '1' is there twice"),
        ("", "no tests; 'mfv fatigue --new FILE.csv' writes a table"),
        ("test,source\n1,x\n", "column pad_radius [mm] is missing"),
    ],
)
def test_bad_tables_are_named(text, words, tmp_path):
    (tmp_path / "tests.csv").write_text(text)
    with pytest.raises(mfv.errors.InputError) as caught:
        comparison.read_tests(tmp_path / "tests.csv")
    assert words in str(caught.value)
    (tmp_path / "tests.csv").write_bytes(table({}).encode() + b"\0")
    with pytest.raises(mfv.errors.InputError, match="tests.csv:3:1: not a text file: control character 0"):
        comparison.read_tests(tmp_path / "tests.csv")


@pytest.mark.parametrize(
    "change, words",
    [
        ({"bulk_stress": -400, "bulk_ratio": 1, "tangential_force": 1}, "has no tension on the surface of the specimen"),
        ({"strength_exponent": -90}, "has no predicted life: the curve must be positive and decrease"),
    ],
)
def test_a_test_without_a_prediction_is_named(change, words, tmp_path):
    (test,) = read(tmp_path / "tests.csv", change)
    with pytest.raises(mfv.errors.InputError, match=f"tests.csv:2: test '1' {words}"):
        comparison.predict(test, 31)


def test_numbers_that_the_loads_determine(tmp_path):
    """By Hertz: E* = E/(2 (1 - nu^2)), a^2 = 4 P R/(pi E*), p0 = 2 P/(pi a)."""
    modulus = 70000.0 / (2.0 * (1.0 - 0.33**2))
    half_width = math.sqrt(4.0 * 100.0 * 50.0 / (math.pi * modulus))
    pressure = 200.0 / (math.pi * half_width)
    (test,) = read(tmp_path / "a.csv", {"normal_force": "", "peak_pressure": pressure, "half_width": round(half_width, 3)})
    assert test["normal_force"] == pytest.approx(100.0) and test.notes == ()
    (test,) = read(tmp_path / "b.csv", {"peak_pressure": round(pressure, 1), "half_width": 1.045 * half_width})
    assert "+4.5 % off" in test.notes[0]


def test_semicolons_decimal_commas_comments_and_a_mark(tmp_path):
    rows = {"mu": 0.65, "source": "made up"}
    expected = read(tmp_path / "a.csv", rows)
    text = "\ufeff# a comment\n\n" + table(rows, separator=";")
    (tmp_path / "b.csv").write_text(text, encoding="utf-8")
    found = comparison.read_tests(tmp_path / "b.csv")
    assert found[0].values == expected[0].values and found[0].where.endswith("b.csv:4")
    # As spreadsheets write it: tabs, and a row of empty cells.
    (tmp_path / "c.txt").write_text(table(rows, separator="\t") + 25 * "\t" + "\n", encoding="utf-8")
    assert comparison.read_tests(tmp_path / "c.txt")[0].values == expected[0].values
    # All cells in quotation marks, with decimal commas and a comma in a text; UTF-16.
    lines = table(rows, separator=";").replace("made up", 'made, ""as said"", #2 up').splitlines()
    quoted = "".join(",".join(f'"{cell}"' for cell in line.split(";")) + "\r\n" for line in lines)
    (tmp_path / "d.csv").write_text(quoted, encoding="utf-16")
    found = comparison.read_tests(tmp_path / "d.csv")
    assert found[0].values == expected[0].values | {"source": 'made, "as said", #2 up'}
