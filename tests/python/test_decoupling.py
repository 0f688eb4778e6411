"""The quick study of elastic decoupling: its report is complete, and the statements of the dissertation's chapter 6 hold.

75 nodes in contact by default; tolerances are the discretisation errors of this mesh (finer ones: examples/decoupling).
"""

from __future__ import annotations

import csv
import os
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest

import mfv
from mfv.studies.dataset import frame_of
from mfv.studies.namelist import read_study

STUDY = Path(__file__).resolve().parents[2] / "examples" / "decoupling" / "study.py"
MOMENTS = ("loading", "reversal", "return")


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    """Where a quick study has been written."""
    path = tmp_path_factory.mktemp("decoupling")
    package = str(Path(mfv.__file__).resolve().parents[1])
    environment = os.environ | {"MPLBACKEND": "Agg", "PYTHONPATH": package}
    command = [sys.executable, str(STUDY), "--quick", "--output", str(path)]
    done = subprocess.run(command, capture_output=True, text=True, env=environment, cwd=path, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return path


def table(folder: Path, name: str) -> np.ndarray:
    """The table of a study, from its saved cases."""
    study = read_study(folder / f"{name}.nml")
    return frame_of(study.so_far(folder / f"{name}.sqlite")).to_records(index=False)


def rows(table: np.ndarray, **values) -> np.ndarray:
    """The rows with these values."""
    keep = np.ones(len(table), dtype=bool)
    for column, value in values.items():
        keep &= table[column] == value if isinstance(value, str) else np.isclose(table[column], value)
    assert keep.any()
    return table[keep]


def by_coupling(folder: Path, name: str) -> list[np.ndarray]:
    """Rows of full coupling, Goodman's and none."""
    whole = table(folder, name)
    return [rows(whole, coupling=coupling) for coupling in ("full", "goodman", "none")]


class Balanced(HTMLParser):
    """Whether every element is closed correctly."""

    EMPTY = ("meta", "img")

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.pictures = 0
        self.statements = 0

    def handle_starttag(self, tag, attrs):
        if tag == "img":
            self.pictures += dict(attrs)["src"].startswith("data:image/png;base64,")
        if tag == "tr":
            self.statements += dict(attrs).get("class") is not None
        if tag not in self.EMPTY:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag


def test_the_page_is_whole_and_alone(folder):
    """Every element closed, all pictures inside, a row for every statement."""
    page = (folder / "report.html").read_text(encoding="utf-8")
    parser = Balanced()
    parser.feed(page)
    parser.close()
    assert parser.open == []
    assert parser.pictures == 15
    with (folder / "numbers.csv").open(newline="") as stream:
        assert parser.statements == sum(1 for _ in stream) - 1
    assert "http" not in page


def test_every_figure_has_its_numbers(folder):
    """CSV files with a head and lines of as many entries."""
    page = (folder / "report.html").read_text(encoding="utf-8")
    files = sorted(path for path in folder.glob("*.csv"))
    assert {f"figure_6_{number}.csv" for number in range(1, 6)} <= {path.name for path in files}
    for path in files:
        with path.open(newline="") as stream:
            lines = list(csv.reader(stream))
        assert len(lines) > 3 and len({len(line) for line in lines}) == 1, path.name
        assert path.name == "numbers.csv" or path.name in page


def test_no_statement_is_without_a_verdict(folder):
    """Each has one of four."""
    with (folder / "numbers.csv").open(newline="") as stream:
        statements = list(csv.DictReader(stream))
    verdicts = {statement["verdict"] for statement in statements}
    assert verdicts <= {"agrees", "agrees in part", "differs", "not in the text"}
    assert sum(statement["verdict"] == "agrees" for statement in statements) > 0.6 * len(statements)


def test_all_cases_solve_their_equations(folder):
    """The certificates of all studies."""
    for path in folder.glob("*.sqlite"):
        whole = table(folder, path.stem)
        assert (whole["outcome"] == "complete").all()
        assert whole["largest_residual"].max() < 1e-9


def test_dissipation_has_no_dimensions(folder):
    """Bodies of KR from 0.03 to 2: one curve to a/R (section 6.4)."""
    for name, key in (("lateral_force", "force_ratio"), ("friction", "mu")):
        full, *_ = by_coupling(folder, name)
        for value in np.unique(full[key]):
            numbers = rows(full, **{key: value})["dissipation_number"]
            assert np.ptp(numbers) < 0.01 * numbers.mean() or value < 0.1


def test_goodman_dissipates_as_if_decoupled(folder):
    """The pressures are equal and the lateral force governs the slip (section 6.4)."""
    for name in ("lateral_force", "friction", "ratios", "mismatch"):
        _, goodman, none = by_coupling(folder, name)
        assert goodman["cycle_dissipation"] == pytest.approx(none["cycle_dissipation"], rel=1e-9)
        for moment in MOMENTS:
            assert goodman[f"pressure_error_{moment}"] == pytest.approx(none[f"pressure_error_{moment}"], rel=1e-9)


def test_decouplings_over_predict(folder):
    """By 18 % or more at mu = 0.7, by 13 to 30 % or so over mu (sections 6.4 and 6.5)."""
    _, goodman, _ = by_coupling(folder, "lateral_force")
    assert goodman["dissipation_ratio"].min() == pytest.approx(1.18, abs=0.01)
    _, goodman, _ = by_coupling(folder, "ratios")
    assert goodman["dissipation_ratio"].min() == pytest.approx(1.13, abs=0.01)
    assert goodman["dissipation_ratio"].max() == pytest.approx(1.30, abs=0.03)
    high = rows(goodman, force_ratio=0.99)["dissipation_ratio"]
    assert (np.diff(high) > 0).all()
    low = rows(goodman, force_ratio=0.5)["dissipation_ratio"]
    assert 0 < low.argmin() < len(low) - 1  # concave up


def test_decoupled_dissipation_is_that_of_mindlin(folder):
    """Two equal disks against the closed form, 150 nodes in contact."""
    finest = rows(table(folder, "mindlin"), nodes_of_mesh=195)
    finest = finest[finest["force_ratio"] > 0.2]
    compliance, force, mu, radius = 0.7 / 77e9, finest["normal_force"], 0.7, 2.0
    half_width = np.sqrt(2 * force * compliance * radius / np.pi)
    exact = mfv.reference.mindlin_dissipation(finest["force_ratio"] * mu * force, force, half_width, radius, mu)
    assert finest["cycle_dissipation"] == pytest.approx(exact, rel=5e-3)
    assert finest["stick_ratio_reversal"] == pytest.approx(np.sqrt(1 - finest["force_ratio"]), abs=5e-3)


def test_slope_over_friction_is_two(folder):
    """Exactly without the effect of shear on pressure, nearly with it (section 6.5)."""
    for part, tolerance in zip(by_coupling(folder, "friction"), (0.05, 1e-6, 1e-6)):
        part = rows(part, base=part["base"][-1])
        slope = np.polyfit(np.log(part["mu"]), np.log(part["dissipation_number"]), 1)[0]
        assert slope == pytest.approx(2, abs=tolerance)


def test_stick_ratios(folder):
    """Loading: least with full coupling, most decoupled; reversal: nearly the same (section 6.4)."""
    full, goodman, none = by_coupling(folder, "lateral_force")
    assert (full["stick_ratio_loading"] < goodman["stick_ratio_loading"]).all()
    assert (goodman["stick_ratio_loading"] < none["stick_ratio_loading"]).all()
    assert none["stick_ratio_loading"] == pytest.approx(none["stick_ratio_reversal"], abs=1e-6)
    assert full["stick_ratio_reversal"] == pytest.approx(none["stick_ratio_reversal"], abs=0.03)


def test_errors_of_tractions(folder):
    """Pressure to 23 %, shear of full decoupling from 100 %, nearly equal near gross sliding (section 6.4)."""
    _, goodman, none = by_coupling(folder, "lateral_force")
    assert goodman["pressure_error_reversal"].max() == pytest.approx(0.225, abs=0.01)
    assert none["shear_error_loading"].max() == pytest.approx(1.0, abs=0.02)
    last = [rows(part, force_ratio=0.99)["shear_error_reversal"] for part in (goodman, none)]
    assert last[0] == pytest.approx(last[1], abs=0.01)
    assert last[0] == pytest.approx(0.226, abs=0.01)


def test_contact_follows_the_shear(folder):
    """Full coupling: to the left by 0.09 a at Q = 0.65 mu P, to the right at -Q; not at all decoupled (section 6.3)."""
    full, goodman, none = by_coupling(folder, "cyclic")
    assert full["patch_shift_loading"] == pytest.approx(-0.09, abs=0.01)
    assert full["patch_shift_reversal"] == pytest.approx(0.09, abs=0.01)
    for part in (goodman, none):
        assert part["patch_shift_loading"] == pytest.approx(0, abs=1e-9)


def test_dissipation_is_even_in_beta(folder):
    """Two disks of one radius: the mirror image has -beta. Contact shifts are odd."""
    full, *_ = by_coupling(folder, "mismatch")
    for ratio in np.unique(full["force_ratio"]):
        part = rows(full, force_ratio=ratio)
        assert part["dissipation_number"] == pytest.approx(part["dissipation_number"][::-1], rel=1e-9)
        assert part["patch_shift_return"] == pytest.approx(-part["patch_shift_return"][::-1], abs=1e-6)


def test_only_full_coupling_remembers(folder):
    """Steady dissipation after five beginnings: the same to round-off unless shear acts on pressure (section 6.1)."""
    whole = table(folder, "shakedown")
    for coupling, remembers in (("full", True), ("goodman", False), ("none", False)):
        part = rows(whole, coupling=coupling, beta=0.5, force_ratio=0.2)["dissipation_number"]
        assert (np.ptp(part) > 0.2 * part.mean()) == remembers
        assert remembers or np.ptp(part) < 1e-9 * part.mean()


def test_flat_punch_shakes_down():
    """Slip of the first cycle only, with Goodman's approximation as with full coupling; decoupled none at all."""
    text = (STUDY.parent / "cases" / "flat_punch.nml").read_text(encoding="utf-8")
    for coupling, slips in (("full", True), ("goodman", True), ("none", False)):
        history = mfv.run(text=text.replace("'goodman'", f"'{coupling}'")).history
        ends = history.dissipation[history.event_kind == mfv.EventKind.STEP_END]
        first, *later = np.diff(ends[1::2])
        assert (first > 0.2 * ends.max()) == slips
        assert len(later) == 3 and np.abs(later).max() <= 1e-9 * max(first, 1e-3)


def test_a_quick_study_has_no_remarks(folder):
    """They are on the numbers of the whole one."""
    with (folder / "numbers.csv").open(newline="") as stream:
        assert not any(statement["why"] for statement in csv.DictReader(stream))


def test_small_forces_slip_nothing(folder):
    """beta = 0.5, mu = 0.7: dissipation ceases after some cycles of Q = 0.05 mu P (frictional shakedown)."""
    whole = rows(table(folder, "shakedown"), beta=0.5, force_ratio=0.05)
    full, none = (rows(whole, coupling=coupling)["dissipation_number"] for coupling in ("full", "none"))
    assert (np.abs(full) < 1e-4 * none).all()
