"""A series of fretting-fatigue tests compared with every parameter and critical distance: which of them predicts the measured lives.

`read_tests` reads a table of pad tests, `predict` solves each and predicts its lives, `judge` counts how many are within factors of the
measured ones. Nothing is fitted.
"""

from __future__ import annotations

import math
import os
import warnings
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from .. import tables
from .._suggestions import suggestion
from ..errors import MfvError, input_error
from ..scene import Body, Friction, Mesh, Output, Scene, Step
from .critical_distance import averaged_cycle, critical_length
from .lives import StrainLife, life
from .parameters import (
    crossland,
    crossland_constant,
    dang_van,
    dang_van_constant,
    fatemi_socie,
    findley,
    findley_constant,
    smith_watson_topper,
)
from .stress_cycle import StressCycle, stress_cycle

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..result import Result

#: Parameters, and places: the surface, and averages over critical distances below it.
PARAMETERS = ("Smith-Watson-Topper", "Fatemi-Socie", "Findley", "Crossland", "Dang Van")
PLACES = ("hot spot", "point", "area", "line")

#: Bands around the measured life; fewest failed tests for a preference.
FACTORS, FEWEST = (2.0, 5.0), 5

#: Relative difference of two half-widths that the same loads may have by rounded numbers.
ROUNDED = 0.01

#: A source that begins so is an example: its row is predicted, but not counted.
INVENTED = "invented"


class Column(NamedTuple):
    """A column: its unit (empty: none), meaning, value in the template, default (None: required), and its kind."""

    unit: str
    meaning: str
    example: str
    default: str | None = None
    kind: str = "positive"


#: Every column of a table of tests. Forces are those per mm of thickness.
COLUMNS = {
    "test": Column("", "name of the test, of this row alone", "1", kind="text"),
    "source": Column(
        "", f"where the numbers come from and who checked them; a row whose source begins with '{INVENTED}' is not counted",
        "invented to show the columns; replace this row", kind="text",
    ),
    "pad_radius": Column("mm", "radius of the cylindrical pad", "50"),
    "youngs_modulus": Column("MPa", "of the specimen", "70000"),
    "poisson_ratio": Column("", "of the specimen", "0.33", kind="poisson"),
    "pad_youngs_modulus": Column("MPa", "of the pad; if empty: as of the specimen", "", ""),
    "pad_poisson_ratio": Column("", "of the pad; if empty: as of the specimen", "", "", "poisson"),
    "mu": Column("", "coefficient of friction", "0.7"),
    "normal_force": Column("N/mm", "force of the pad; or peak_pressure", "100", ""),
    "peak_pressure": Column("MPa", "of Hertz, in place of normal_force; if both are given they must agree", "", ""),
    "half_width": Column("mm", "of the contact, as measured or printed: compared with Hertz", "", ""),
    "tangential_force": Column("N/mm", "largest in the cycle", "40"),
    "shear_ratio": Column("", "smallest over largest tangential force", "-1", "-1", "number"),
    "bulk_stress": Column("MPa", "largest in the cycle, in phase with the tangential force", "100", kind="number"),
    "bulk_ratio": Column("", "smallest over largest bulk stress", "-1", "-1", "number"),
    "life": Column("cycles", "measured, to the end of the test", "500000"),
    "failed": Column("", "yes, or no for a test that was stopped (run-out)", "yes", kind="yes or no"),
    "strength": Column("MPa", "of the strain-life curve strength/E (2N)^strength_exponent + ductility (2N)^ductility_exponent", "900"),
    "strength_exponent": Column("", "of the strain-life curve", "-0.1", kind="negative"),
    "ductility": Column("", "of the strain-life curve", "0.2"),
    "ductility_exponent": Column("", "of the strain-life curve", "-0.6", kind="negative"),
    "yield_strength": Column("MPa", "for Fatemi and Socie", "400"),
    "fatemi_socie_k": Column("", "k of Fatemi and Socie", "1", "1"),
    "torsion_ratio": Column(
        "", "fatigue limit in torsion over that in bending, for k of Findley, Crossland and Dang Van; if empty: 1/sqrt(3)", "",
        repr(1.0 / math.sqrt(3.0)),
    ),
    "threshold_range": Column("MPa m^0.5", "threshold of long cracks, for the critical distance", "4"),
    "fatigue_limit_range": Column("MPa", "range of the plain fatigue limit, for the critical distance", "250"),
}  # fmt: skip


@dataclass(frozen=True)
class PadTest:
    """A row of a table of tests: its values by column, as numbers, texts or None, its file and line, and remarks on its numbers."""

    values: dict[str, Any]
    where: str
    notes: tuple[str, ...] = ()

    def __getitem__(self, column: str) -> Any:
        return self.values[column]

    @property
    def is_invented(self) -> bool:
        """Whether the row is an example."""
        return str(self["source"]).lower().startswith(INVENTED)

    @property
    def critical_length(self) -> float:
        """Critical distance L, mm."""
        return critical_length(self["threshold_range"] * math.sqrt(1000.0), self["fatigue_limit_range"])


@dataclass(frozen=True)
class Prediction:
    """A test, the half-width of its contact [mm], and its predicted lives [cycles] by parameter and place."""

    test: PadTest
    half_width: float
    lives: dict[tuple[str, str], float]

    def factor(self, parameter: str, place: str) -> float:
        """Predicted over measured life."""
        return self.lives[parameter, place] / float(self.test["life"])


@dataclass(frozen=True)
class Verdict:
    """How a parameter at a place does: numbers of failed tests within every band of FACTORS, median of predicted over measured lives and
    the largest factor between them, and the number of run-outs with a predicted life of at least the test."""

    parameter: str
    place: str
    within: tuple[int, ...]
    median: float
    worst: float
    run_outs: int


def template() -> str:
    """A table of tests to fill in: its columns explained, and one row that is invented and says so."""
    lines = ["# Fretting-fatigue tests for 'mfv fatigue'. Columns (units are fixed; lines that begin with # are comments):"]
    for name, column in COLUMNS.items():
        lines.append(f"# {label(name)}: {column.meaning}" + (" (optional)" if column.default is not None else ""))
    return "\n".join([*lines, ",".join(map(label, COLUMNS)), ",".join(column.example for column in COLUMNS.values()), ""])


def label(name: str) -> str:
    """A column with its unit: 'pad_radius [mm]'."""
    return f"{name} [{COLUMNS[name].unit}]" if COLUMNS[name].unit else name


def columns_in_markdown() -> str:
    """Every column as a table."""
    lines = ["| column | unit | meaning |", "| --- | --- | --- |"]
    for name, column in COLUMNS.items():
        default = {None: "", "": " (optional)"}.get(column.default, f" (optional; {float(column.default or 0):.4g})")
        default = " (optional)" if name == "torsion_ratio" else default
        lines.append(f"| `{name}` | {column.unit or '-'} | {column.meaning}{default} |")
    return "\n".join(lines)


def read_tests(path: str | os.PathLike[str]) -> list[PadTest]:
    """The tests of a text file as spreadsheets and programs write it (`mfv.tables`), one in a row under a line with their columns.

    Raises OSError; InputError, which names file, line, column and value.
    """
    name = os.fspath(path)
    table = tables.read_rows(path, are_texts=[column for column, about in COLUMNS.items() if about.kind in ("text", "yes or no")])
    if not table.lines:
        raise input_error(f"{name}: no tests; 'mfv fatigue --new FILE.csv' writes a table to fill in")
    names = [_column(name, table.header, cell) for cell in table.names]
    for column, about in COLUMNS.items():
        if column not in names and about.default is None:
            raise input_error(f"{name}:{table.header}: column {label(column)} is missing: {about.meaning}")
    for column in names:
        if names.count(column) > 1:
            raise input_error(f"{name}:{table.header}: column {column} is given twice")
    tests = [_test(f"{name}:{line}", dict(zip(names, table.cells(line))), table) for line in table.lines]
    for place, test in enumerate(tests):
        if any(other["test"] == test["test"] for other in tests[:place]):
            raise input_error(f"{test.where}: test '{test['test']}' is there twice; give every row a name of its own")
    return tests


def _column(file: str, line: int, cell: str) -> str:
    """The column of a heading such as 'pad_radius [mm]'. Raises InputError."""
    name, _, unit = cell.partition("[")
    name, unit = name.strip(), unit.strip().removesuffix("]").strip()
    if name not in COLUMNS:
        raise input_error(f"{file}:{line}: unknown column '{name}'{suggestion(name, COLUMNS)}")
    if unit and unit != COLUMNS[name].unit:
        raise input_error(f"{file}:{line}: column {name} is in {unit}; it must be in {COLUMNS[name].unit or 'no unit'}: convert it")
    return name


def _test(where: str, cells: dict[str, str], table: tables.Rows) -> PadTest:
    """A test from its cells. Raises InputError."""
    values: dict[str, Any] = {}
    for name, column in COLUMNS.items():
        text = cells.get(name, "")
        if not text and column.default is None:
            raise input_error(f"{where}: {label(name)} is empty: {column.meaning}")
        number = table.number(text) if text else float(column.default or "nan")
        values[name] = _value(where, name, text or column.default or "", number)
    if values["normal_force"] is None and values["peak_pressure"] is None:
        raise input_error(f"{where}: needs normal_force or peak_pressure")
    for name in ("youngs_modulus", "poisson_ratio"):
        values[f"pad_{name}"] = values[name] if values[f"pad_{name}"] is None else values[f"pad_{name}"]
    notes = _settle_force(where, values)
    limit = values["mu"] * values["normal_force"]
    if values["tangential_force"] >= limit or abs(values["shear_ratio"]) * values["tangential_force"] >= limit:
        raise input_error(
            f"{where}: tangential_force={values['tangential_force']:g} is not below the sliding limit mu P = {limit:.4g} N/mm"
        )
    for name, largest in (("shear_ratio", "tangential_force"), ("bulk_ratio", "bulk_stress")):
        if values[name] > 1.0 and values[largest] >= 0.0:
            raise input_error(f"{where}: {name}={values[name]:g}: must be at most 1, the smallest over the largest {largest}")
    if not 0.5 <= values["torsion_ratio"] < 1.0:
        raise input_error(f"{where}: torsion_ratio={values['torsion_ratio']:g}: must be at least 0.5 and less than 1")
    return PadTest(values, where, notes)


def _value(where: str, name: str, text: str, number: float) -> Any:
    """The value of a cell, None if it is empty. `number`: that in it, or NaN. Raises InputError."""
    kind = COLUMNS[name].kind
    if kind == "text":
        return text
    if not text:
        return None
    if kind == "yes or no":
        if text.lower() not in ("yes", "no"):
            raise input_error(f"{where}: {name}='{text}': must be yes or no")
        return text.lower() == "yes"
    wanted, is_right = {
        "positive": ("a number above 0", number > 0.0),
        "negative": ("a number below 0", number < 0.0),
        "poisson": ("a number from 0 to 0.5", 0.0 <= number <= 0.5),
        "number": ("a number", True),
    }[kind]
    if not math.isfinite(number) or not is_right:
        raise input_error(f"{where}: {label(name)}='{text}': must be {wanted}")
    return number


def _settle_force(where: str, values: dict[str, Any]) -> tuple[str, ...]:
    """Set the normal force, by Hertz if the pressure is given, and compare all numbers that the force determines. Raises InputError if the
    two contradict each other; returns a remark if another half-width is given."""
    compliance = sum((1.0 - values[f"{of}poisson_ratio"] ** 2) / values[f"{of}youngs_modulus"] for of in ("", "pad_"))
    radius, force, pressure = values["pad_radius"], values["normal_force"], values["peak_pressure"]
    # a = 2 R p0/E*, P = pi a p0/2.
    if pressure is not None:
        of_pressure = math.pi * radius * compliance * pressure**2
        if force is not None and abs(math.sqrt(force / of_pressure) - 1.0) > ROUNDED:
            raise input_error(
                f"{where}: normal_force={force:g} and peak_pressure={pressure:g} contradict each other: by Hertz this pressure needs "
                f"{of_pressure:.4g} N/mm, this force has {math.sqrt(force / (math.pi * radius * compliance)):.4g} MPa; correct or remove one"
            )
        force = of_pressure if force is None else force
    values["normal_force"] = force
    half_width = math.sqrt(4.0 * force * radius * compliance / math.pi)
    given = values["half_width"]
    if given is None or abs(given / half_width - 1.0) <= ROUNDED:
        return ()
    percent = 100.0 * (given / half_width - 1.0)
    return (f"half_width={given:g} mm is {percent:+.1f} % off the {half_width:.4g} mm of Hertz for its loads: check the row",)


def scene(test: PadTest, nodes: int = 101) -> Scene:
    """A test as a scene in mm, N and MPa: pressed, then two cycles of shear and bulk stress in phase, which end with their largest values."""
    pull = {"tangential_force": test["tangential_force"], "lower_bulk_stress": test["bulk_stress"]}
    back = {name: test[ratio] * pull[name] for name, ratio in zip(pull, ("shear_ratio", "bulk_ratio"))}
    return Scene(
        Body.half_plane(youngs_modulus=test["youngs_modulus"], poisson_ratio=test["poisson_ratio"]),
        Body.disk(test["pad_radius"], youngs_modulus=test["pad_youngs_modulus"], poisson_ratio=test["pad_poisson_ratio"]),
        friction=Friction.coulomb(test["mu"]),
        mesh=Mesh(nodes=nodes),
        steps=[Step(normal_force=test["normal_force"], friction=False), Step(**pull), Step(**back, cycles=2)],
        output=Output(history="none"),
        length_unit="mm",
        force_unit="N",
    )


def predict(test: PadTest, nodes: int = 101) -> Prediction:
    """The lives of a test by every parameter at every place: at the largest tension of the surface over the cycle, and by the point, area
    and line methods below. Raises MfvError, with the row, if it cannot be solved. Needs scipy."""
    about = f"{test.where}: test '{test['test']}'"
    try:
        result = scene(test, nodes).run(check=True)
    except MfvError as error:
        raise input_error(f"{about} cannot be solved: {error.message}") from None
    x = float(result.observables.get("largest_lower_tension_x", math.nan))
    if not math.isfinite(x):
        raise input_error(f"{about} has no tension on the surface of the specimen over the cycle, so no hot spot: check its loads")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # those of the result are among the notes
            cycles = {place: _cycle(result, x, place, test.critical_length) for place in PLACES}
        lives = {(name, place): value for place, cycle in cycles.items() for name, value in lives_of(test, cycle).items()}
    except ValueError as error:
        raise input_error(f"{about} has no predicted life: {error}") from None
    notes = (*test.notes, *result.warnings)
    return Prediction(PadTest(test.values, test.where, notes), float(result.summary.contact_half_width), lives)


def _cycle(result: Result, x: float, place: str, length: float) -> StressCycle:
    return stress_cycle(result, x, 0.0) if place == "hot spot" else averaged_cycle(result, x, length, method=place)  # type: ignore[arg-type]


def lives_of(test: PadTest, cycle: StressCycle, parameters: Sequence[str] = PARAMETERS) -> dict[str, float]:
    """Lives by every parameter, or some, of a cycle at one point, with the material of a test [cycles]."""
    curve = StrainLife(
        *(
            test[name]
            for name in ("youngs_modulus", "strength", "strength_exponent", "ductility", "ductility_exponent", "poisson_ratio")
        )
    )
    plastic = {"yield_strength": test["yield_strength"], "k": test["fatemi_socie_k"]}
    k_findley, k_crossland, k_dang_van = (
        constant(1.0, test["torsion_ratio"]) for constant in (findley_constant, crossland_constant, dang_van_constant)
    )
    pairs: dict[str, Any] = {
        "Smith-Watson-Topper": (smith_watson_topper, curve.smith_watson_topper),
        "Fatemi-Socie": (partial(fatemi_socie, **plastic), lambda n: curve.fatemi_socie(n, **plastic)),
        "Findley": (partial(findley, k=k_findley), lambda n: curve.findley(n, k=k_findley)),
        "Crossland": (partial(crossland, k=k_crossland), lambda n: curve.crossland(n, k=k_crossland)),
        "Dang Van": (partial(dang_van, k=k_dang_van), lambda n: curve.dang_van(n, k=k_dang_van)),
    }
    chosen = {name: pairs[name] for name in parameters}
    return {name: float(life(of_cycle(cycle).maximum.value, of_test)) for name, (of_cycle, of_test) in chosen.items()}


def judge(predictions: Iterable[Prediction]) -> list[Verdict]:
    """Every parameter at every place, by the tests that are not invented; the best first: most tests in the narrow band, then in the wide
    one, then the smallest factor."""
    counted = [one for one in predictions if not one.test.is_invented]
    failed = [one for one in counted if one.test["failed"]]
    run_outs = [one for one in counted if not one.test["failed"]]
    verdicts = []
    for parameter in PARAMETERS:
        for place in PLACES:
            factors = np.array([one.factor(parameter, place) for one in failed])
            away = np.maximum(factors, 1.0 / factors)
            within = tuple(int(np.sum(away <= factor)) for factor in FACTORS)
            survived = sum(one.factor(parameter, place) >= 1.0 for one in run_outs)
            median, worst = (float(np.median(factors)), float(away.max())) if failed else (math.nan, math.nan)
            verdicts.append(Verdict(parameter, place, within, median, worst, survived))
    return sorted(verdicts, key=lambda one: (*(-count for count in one.within), -one.run_outs, one.worst))


def statement(predictions: Sequence[Prediction]) -> str:
    """Which parameter and place fits, in a sentence or two."""
    counted = [one for one in predictions if not one.test.is_invented]
    failed = sum(bool(one.test["failed"]) for one in counted)
    run_outs = len(counted) - failed
    if not failed:
        return "Nothing to judge by: no row is a failed test that somebody has measured."
    verdicts = judge(predictions)
    every = numbered(failed, "failed test") + (f" and {numbered(run_outs, 'run-out')}" if run_outs else "")
    for place, factor in enumerate(FACTORS):
        fits = [one for one in verdicts if one.within[place] == failed and one.run_outs == run_outs]
        if fits:
            text = f"Within a factor of {factor:g} of all ({every}): {', '.join(f'{one.parameter} ({one.place})' for one in fits)}."
            break
    else:
        best = min(verdicts, key=lambda one: (one.run_outs < run_outs, one.worst))
        missed = f"; it predicts failure of {numbered(run_outs - best.run_outs, 'run-out')}" if best.run_outs < run_outs else ""
        text = (
            f"None is within a factor of {FACTORS[-1]:g} of all ({every}). The nearest is {best.parameter} ({best.place}), within a factor of "
            f"{best.worst:.3g}{missed}."
        )
    if failed < FEWEST:
        text += f" Fewer than {FEWEST} failed tests are too few to prefer one."
    return text


def numbered(number: int, name: str) -> str:
    """A number of things: 1 run-out, 2 run-outs."""
    return f"{number} {name}{'' if number == 1 else 's'}"


def figure(predictions: Sequence[Prediction]) -> Figure:
    """Predicted over measured lives at every place, with bands of FACTORS; hollow: run-outs; crosses: invented rows."""
    import matplotlib
    from matplotlib.figure import Figure

    picture = Figure(figsize=(11.0, 9.0), layout="constrained")
    measured = np.array([float(one.test["life"]) for one in predictions])
    ends = np.array([0.3 * measured.min(), 3.0 * measured.max()])
    for ax, place in zip(picture.subplots(2, 2).flat, PLACES):
        for factor, grey in zip(reversed(FACTORS), ("0.93", "0.82")):
            ax.fill_between(ends, ends / factor, ends * factor, color=grey, label=f"factor {factor:g}")
        for number, parameter in enumerate(PARAMETERS):
            colour = matplotlib.colormaps["tab10"](number)
            for one, life_measured in zip(predictions, measured):
                style = "x" if one.test.is_invented else "o"
                face = colour if one.test["failed"] else "none"
                ax.plot(life_measured, one.lives[parameter, place], style, color=colour, markerfacecolor=face)
            ax.plot([], [], "o", color=colour, label=parameter)
        ax.set(xscale="log", yscale="log", xlim=ends, xlabel="measured life [cycles]", ylabel="predicted life [cycles]")
        ax.set_title("at the hot spot" if place == "hot spot" else f"critical distance: {place}", fontsize=10)
    picture.axes[0].legend(fontsize=8)
    return picture
