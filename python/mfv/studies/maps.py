"""Maps: the regimes of a case over two of its loads, with their boundaries; a study of a grid, and of the points that these need."""

from __future__ import annotations

import functools
import math
import os
import re
import warnings
from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .._observer import progress_bar
from .._suggestions import suggestion
from ..case import Case
from ..errors import input_error
from ..scene import created
from . import boundaries, executors
from .bases import Given, base_of
from .boundaries import Crossing, Sample
from .cases import observables, one_blas_thread, reading, scene_handle
from .map_axes import SHORT, Loads, loads_of, map_axis, usual_axes, with_history_in_text
from .plan import Study

if TYPE_CHECKING:
    import xarray

    from ..fatigue.comparison import PadTest

#: Regimes of a point. FAILED: the case ended early for another reason than gross sliding or separation.
STICK, PARTIAL, SLIDING, OPEN, FAILED = "stick", "partial slip", "gross sliding", "open", "failed"
#: A boundary that is independent of the others.
YIELDING = "yielding"

#: Default criterion of stick: the smallest stick ratio over the last cycle.
STICK_RATIO = 0.999
#: Default tolerance of boundaries, relative to the value of the axis.
TOLERANCE = 1.0e-6
#: Columns that a map adds to those of the study.
WEAR_RATE, LIFE = "wear_rate", "life"
#: Most points along an axis at which lives are computed; between them they are interpolated.
LIVES = 13

#: Relative difference of two moduli of one material.
SAME_MODULUS = 0.01

BODIES = ("lower", "upper")


def regime_map(
    case: Given,
    over: Mapping[str, Any] | Sequence[str] | None = None,
    points: int | tuple[int, int] = 50,
    *,
    contour: str | None = None,
    stick_ratio: float = STICK_RATIO,
    tolerance: float = TOLERANCE,
    wear_coefficient: float | None = None,
    material: PadTest | None = None,
    parameter: str = "Smith-Watson-Topper",
    executor: str | Executor = "threads",
    workers: int | None = None,
    store: str | os.PathLike[str] | None = None,
    again: bool = False,
    progress: bool = False,
) -> xarray.Dataset:
    """The regimes of a case over two of its loads: the table of a study over a grid, shape (points, points), and the boundaries.

    `over`: two axes, by default Q and P. Q, P, D, B and mu are the largest tangential force, normal force, shift, bulk stress and
    coefficient of friction of the case; all its targets of a kind are scaled in proportion. Other axes are keys of the case, joined by
    + if they change in proportion. A mapping gives the range of each, (first, last), None for the default, or an `mfv.Axis`.

    Columns besides those of a study: `regime`, with `yield_strength` in a &body `yields` (1, 0, NaN if the case ended before that is known),
    `wear_rate` if the case or `wear_coefficient` gives one (length^2/force), `life` if `material` gives a strain-life curve (a row of
    `mfv.fatigue.comparison.read_tests`). Along the dimension `crossing`: `boundary` (the regime on one side), `boundary_curve` (its number; the points
    of a curve are in order), the values of both axes as `boundary_Q` and so on, `boundary_along` (the axis along which it was found),
    `boundary_tolerance` (half the bracket, in the unit of that axis), `boundary_resolved` (0: the column that decides is not resolved).

    stick: the stick ratio is at least `stick_ratio` throughout the last cycle. gross sliding: every node slips at some load of the last
    cycle, or the case ends in gross sliding. yielding: the largest von Mises stress reaches the yield strength. open: no contact at the end
    or at a turning point of the last cycle, or the case ends with separated bodies. Without cycles the whole load history counts.

    `contour`: the column that `mfv.studies.map_figure.figure` draws; by default cycle_dissipation, without cycles dissipation.
    `tolerance`: of boundaries, relative. `executor`, `workers`, `store`, `again`, `progress`: as in `Study.run`; a store also has the
    cases of the boundaries. Raises InputError, FileError, OSError.
    """
    plan = _Plan(case, over, points, stick_ratio, tolerance)
    column = plan.usual_contour() if contour is None else contour
    plan.check_contour(column, wear_coefficient, material, parameter)
    executors.check(executor, workers)
    with executors.opened(executor, workers) as pool:
        table = plan.grid.run(executor=pool, store=store, again=again, progress=progress)
        found = plan.boundaries(table, functools.partial(_solved, executor=pool, store=store), progress)
    table = table.assign(plan.columns(table))
    if plan.has_wear(wear_coefficient):
        table[WEAR_RATE] = plan.wear_rate(table, wear_coefficient)
    if material is not None:
        table = table.assign(plan.lives(table, material, parameter))
    return plan.with_boundaries(_with_flags(table), found).assign_attrs(plan.attributes(column))


def _with_flags(table: xarray.Dataset) -> xarray.Dataset:
    """The table in which columns that a map computes are not resolved where those from which they are computed are not."""
    origins = {WEAR_RATE: "cycle_dissipation", LIFE: "largest_lower_tension"}
    columns = {name: origin for name, origin in origins.items() if name in table}

    def extended(names: str) -> str:
        there = names.split()
        return " ".join([*there, *(name for name, origin in columns.items() if origin in there)])

    values = np.vectorize(extended, otypes=[object])(table["unresolved"].values)
    return table.assign(unresolved=table["unresolved"].copy(data=values))


def _solved(study: Study, executor: Executor, store: str | os.PathLike[str] | None) -> xarray.Dataset:
    return study.run(executor=executor, store=store)


class _Plan:
    """A map before it is solved: its grid as a study, and the criteria of its regimes."""

    def __init__(
        self,
        case: Given,
        over: Mapping[str, Any] | Sequence[str] | None,
        points: int | tuple[int, int],
        stick_ratio: float,
        tolerance: float,
    ) -> None:
        """Raises InputError, OSError."""
        base = with_history_in_text(base_of(case))
        self.loads = loads_of(base)
        if not any(key in self.loads.keys for key in ("friction%mu", "friction%mu_static", "friction%mu_file")):
            raise input_error(f"{base.name}: no friction, so no regimes: give the case &friction law='coulomb', mu=...")
        self.stick_ratio, self.tolerance = _fraction("stick_ratio", stick_ratio), _fraction("tolerance", tolerance)
        names: Any = usual_axes(self.loads) if over is None else over
        given = dict(names) if isinstance(names, Mapping) else dict.fromkeys([names] if isinstance(names, str) else names)
        if len(given) != 2:
            raise input_error(f"{base.name}: over {', '.join(given) or 'nothing'}: a map needs two different axes, such as Q,P")
        counts = (points, points) if isinstance(points, int) else tuple(points)
        axes = dict(map_axis(name, self.loads, of, count) for (name, of), count in zip(given.items(), counts))
        if len(axes) != 2:
            raise input_error(f"{base.name}: over {', '.join(given)}: the axes share their first key; give each key to one axis")
        self.names = tuple(axes)
        self.grid = Study(base, axes)
        self.values = [one.values for one in self.grid.coordinates]

    def boundaries(self, table: xarray.Dataset, solve: Any, progress: bool) -> list[Crossing]:
        """The crossings of all boundaries, in the order of their names."""
        found = [
            crossing
            for name, samples in self.samples(table).items()
            for crossing in boundaries.crossings(name, self.values, samples)
        ]

        def of_points(points: Sequence[tuple[float, float]], wanted: Sequence[Crossing]) -> list[Sample]:
            rows = solve(self.grid.at(dict(zip(self.names, map(list, zip(*points))))))
            samples = self.samples(rows)
            return [samples[one.name][place] for place, one in enumerate(wanted)]

        with progress_bar(total=len(found), unit="boundary point", disable=None if progress else True) as bar:
            boundaries.refine(found, of_points, self.tolerance, bar.update)
        return found

    def samples(self, table: xarray.Dataset) -> dict[str, NDArray[Any]]:
        """For every boundary the sample of each case, in the shape of the table."""
        regime = self.regimes(table)
        is_known = ~np.isin(regime, (OPEN, FAILED))
        is_unresolved = _unresolved(table, "smallest_stick_ratio")
        slides = regime == SLIDING
        stick = np.where(slides, 0.0, table["smallest_stick_ratio"].values)
        found = {
            SLIDING: _samples(
                np.where(is_known, _signs(slides), np.nan), is_unresolved & (stick > 0.0), self._expected_sliding(table)
            ),
            STICK: _samples(np.where(is_known, stick - self.stick_ratio, np.nan), is_unresolved, is_smooth=True),
            OPEN: _samples(np.where(regime == FAILED, np.nan, _signs(regime == OPEN))),
        }
        if self.strengths:
            flags = np.logical_or.reduce([_unresolved(table, f"largest_{body}_von_mises") for body in self.strengths])
            found[YIELDING] = _samples(self._over_stress(table), flags, is_smooth=True)
        return found

    def regimes(self, table: xarray.Dataset) -> NDArray[Any]:
        """The regime of every case."""
        outcome, stick = table["outcome"].values, table["smallest_stick_ratio"].values
        complete = outcome == "complete"
        turns = np.isnan([table[f"stick_ratio_{place}"].values for place in ("reversal", "return")]).any(axis=0)
        is_apart = ~(table["patches"].values > 0) | (turns & (table["cycles"].values > 0))
        choices = {
            OPEN: (outcome == "separated") | (complete & is_apart),
            SLIDING: (outcome == "gross sliding") | (complete & (stick <= 0.0)),
            STICK: complete & (stick >= self.stick_ratio),
            PARTIAL: complete & (stick > 0.0),
        }
        found: NDArray[Any] = np.select(list(choices.values()), list(choices), FAILED).astype(object)
        return found

    @functools.cached_property
    def strengths(self) -> dict[str, str]:
        """The keys of the yield strengths that the bodies have, by body."""
        varied = {key for one in self.grid.coordinates for key in one.keys}
        keys = {body: f"body({number})%yield_strength" for number, body in enumerate(BODIES, start=1)}
        return {body: key for body, key in keys.items() if key in self.loads.keys or key in varied}

    def _over_stress(self, table: xarray.Dataset) -> NDArray[Any]:
        """The largest von Mises stress over the yield strength, minus 1; NaN where that is negative and the case ended early: the extremes
        are those of completed steps, without the state at which it ended."""
        over = [table[f"largest_{body}_von_mises"].values / self._of_key(key, table) - 1.0 for body, key in self.strengths.items()]
        largest = np.fmax.reduce(over)
        known: NDArray[Any] = np.where((table["outcome"].values == "complete") | (largest >= 0.0), largest, np.nan)
        return known

    def _points(self, table: xarray.Dataset) -> list[NDArray[Any]]:
        """The values of both axes for every case."""
        dimensions = table["case"].dims
        return [table[name].broadcast_like(table["case"]).transpose(*dimensions).values for name in self.names]

    def _of_key(self, key: str, table: xarray.Dataset) -> Any:
        """The number of a key in every case of a table, or in all of them. None if the case does not have it."""
        for axis, values in zip(self.grid.coordinates, self._points(table)):
            if key in axis.keys:
                factor: Any = axis.factors[axis.keys.index(key)]
                return values * factor
        return self.loads.keys.get(key)

    def _expected_sliding(self, table: xarray.Dataset) -> NDArray[Any]:
        """Where gross sliding begins along either axis according to cases that end in it, shape (*cases, 2), NaN for others. Everything
        slides at one ratio of the forces, so the boundary is where their targets have the ratio that the case reached."""
        found = np.full((*table["case"].shape, 2), np.nan)
        normal, tangential = table["normal_force"].values, np.abs(table["tangential_force"].values)
        slid = (table["outcome"].values == "gross sliding") & (normal > 0.0) & (tangential > 0.0)
        points = self._points(table)
        for place in zip(*np.nonzero(slid)):
            values = [float(one[place]) for one in points]
            settings = {
                axis.keys[number]: value if factor == 1 else np.multiply(value, factor).tolist()
                for axis, value in zip(self.grid.coordinates, values)
                for number, factor in enumerate(axis.factors)
            }
            loads = Loads({**self.loads.keys, **settings}, self.loads.name)
            ratio = tangential[place] / normal[place] / loads.obliquity(int(table["steps_done"].values[place]) + 1)
            found[place] = [value * ratio ** _power(axis.keys) for axis, value in zip(self.grid.coordinates, values)]
        return found

    def columns(self, table: xarray.Dataset) -> dict[str, Any]:
        """The columns of the regimes."""
        dimensions = table["case"].dims
        about = {"long_name": "regime of the last cycle; without cycles: of the load history", "units": "1"}
        found: dict[str, Any] = {"regime": (dimensions, self.regimes(table), about)}
        if self.strengths:
            over = self._over_stress(table)
            about = {"long_name": "1 where the largest von Mises stress reaches a yield strength", "units": "1"}
            found["yields"] = (dimensions, np.where(np.isnan(over), np.nan, over >= 0.0), about)
        return found

    def usual_contour(self) -> str:
        """The dissipation of the last cycle, or without cycles that of all steps."""
        has_cycles = any(key.endswith("%cycles") and value > 0 for key, value in self.loads.keys.items())
        return "cycle_dissipation" if has_cycles or "history%period" in self.loads.keys else "dissipation"

    def check_contour(self, contour: str, wear_coefficient: float | None, material: PadTest | None, parameter: str) -> None:
        """Raises InputError for a column that the map cannot have."""
        if wear_coefficient is not None and not 0.0 < wear_coefficient < math.inf:
            raise input_error(
                f"wear_coefficient={wear_coefficient:g}: must be above 0, in length^2/force: depth per pressure and slip"
            )
        if contour == WEAR_RATE or wear_coefficient is not None:
            if self._wear_divisor is None:
                raise input_error(
                    f"{self.loads.name}: {WEAR_RATE} needs one coefficient of friction: law='coulomb' with a number for mu"
                )
            if not self.has_wear(wear_coefficient):
                raise input_error(
                    f"{self.loads.name}: {WEAR_RATE} needs a wear coefficient: add &wear coefficient=..., or give --wear-coefficient K"
                )
            if wear_coefficient is not None and "wear%coefficient" in self.loads.keys:
                raise input_error(
                    f"{self.loads.name}: wear_coefficient={wear_coefficient:g}: &wear has coefficient; give only one of them"
                )
        if contour == LIFE and material is None:
            raise input_error(
                f"{LIFE} needs a strain-life curve: give --material TABLE.csv, a table as of 'mfv fatigue --new TABLE.csv'"
            )
        if material is not None:
            self._check_material(material, parameter)
        known = (*observables(), WEAR_RATE, LIFE)
        if contour not in known:
            raise input_error(f"contour '{contour}': not a column of a map{suggestion(contour, known)}")

    def _check_material(self, material: PadTest, parameter: str) -> None:
        """Raises InputError for an unknown parameter, and if units or modulus of the case are not those of the material."""
        from ..fatigue.comparison import PARAMETERS

        if parameter not in PARAMETERS:
            raise input_error(f"parameter '{parameter}': must be one of {', '.join(PARAMETERS)}")
        if self.usual_contour() != "cycle_dissipation":
            raise input_error(f"{self.loads.name}: {LIFE} needs a cycle: give the last step cycles=1 or more")
        units = self.grid.units
        if (units["length"], units["force"]) != ("mm", "N"):
            raise input_error(
                f"{self.loads.name}: {LIFE} needs a case in mm and N, as the material: length_unit='mm', force_unit='N'"
            )
        if any(re.fullmatch(r"layer\(\d+\)%body", key) and value == 1 for key, value in self.loads.keys.items()):
            raise input_error(
                f"{self.loads.name}: {LIFE} is that of a lower body without layers; choose points of one of its materials and "
                "mfv.fatigue.stress_cycle"
            )
        modulus, of_material = self.loads.keys.get("body(1)%youngs_modulus"), material["youngs_modulus"]
        if modulus is not None and abs(modulus / of_material - 1.0) > SAME_MODULUS:
            raise input_error(
                f"{self.loads.name}: body(1)%youngs_modulus={modulus:g}, but {material.where} has {of_material:g} MPa: the material is not that "
                "of the lower body"
            )

    def has_wear(self, coefficient: float | None) -> bool:
        """Whether a wear rate is known."""
        return self._wear_divisor is not None and (coefficient is not None or "wear%coefficient" in self.loads.keys)

    @functools.cached_property
    def _wear_divisor(self) -> str | None:
        """The key of the coefficient of friction by which dissipation is divided for the wear rate; empty for law='work', which needs
        none; None if friction has no one coefficient."""
        if self.loads.keys.get("wear%law") == "work":
            return ""
        keys = {"coulomb": "friction%mu", "static_kinetic": "friction%mu_kinetic"}
        key = keys.get(self.loads.keys.get("friction%law", "coulomb"), "")
        return key if key in self.loads.keys else None

    def wear_rate(self, table: xarray.Dataset, coefficient: float | None) -> Any:
        """The area worn per cycle: Archard's coefficient times the integral of pressure times slip, which is the dissipation over the
        coefficient of friction; with law='work' times the dissipation."""
        assert self._wear_divisor is not None
        of_case = self._of_key("wear%coefficient", table)
        mu = self._of_key(self._wear_divisor, table) if self._wear_divisor else 1.0
        about = {"long_name": "area worn off both surfaces per cycle", "units": f"{self.grid.units['length']}^2"}
        work = table["cycle_dissipation"]
        return work.dims, (coefficient if of_case is None else of_case) * work.values / mu, about

    def lives(self, table: xarray.Dataset, material: PadTest, parameter: str) -> dict[str, Any]:
        """The life at the place of the largest tension along the lower surface [cycles], at up to 13 points along either axis, which
        `life_solved` marks; between them it is interpolated, NaN next to a point without a finite
        one."""
        places = [np.unique(np.linspace(0, len(one) - 1, min(len(one), LIVES)).round().astype(int)) for one in self.values]
        lives = np.full([len(one) for one in places], np.nan)
        with one_blas_thread():
            for at in np.ndindex(*lives.shape):
                place = places[0][at[0]], places[1][at[1]]
                hot_spot = float(table["largest_lower_tension_x"].values[place])
                if table["outcome"].values[place] == "complete" and math.isfinite(hot_spot):
                    lives[at] = self._life(int(table["case"].values[place]), hot_spot, material, parameter)
        logarithms = np.log10(np.where(np.isfinite(lives), lives, np.nan))
        # Lives are powers of loads, so logarithms of both are interpolated.
        x, y = (np.log(one) if min(one) > 0.0 else np.asarray(one) for one in self.values)
        rows = np.array([np.interp(x, x[places[0]], column) for column in logarithms.T])
        life = 10.0 ** np.array([np.interp(y, y[places[1]], row) for row in rows.T])
        solved = np.zeros(life.shape, dtype=np.int8)
        solved[np.ix_(*places)] = 1
        life[np.ix_(*places)] = lives
        life[table["outcome"].values != "complete"] = np.nan
        dimensions = table["case"].dims
        about = {"long_name": f"life by {parameter} at the largest tension of the lower surface", "units": "cycles"}
        return {
            LIFE: (dimensions, life, about),
            "life_solved": (
                dimensions,
                solved,
                {"long_name": "1 where life is computed, 0 where it is interpolated", "units": "1"},
            ),
        }

    def _life(self, number: int, x: float, material: PadTest, parameter: str) -> float:
        """The life of a case at a place of its surface."""
        from ..fatigue import comparison, stress_cycle

        job = self.grid.job(number)
        settings = (*job.settings, ("output%states", "last_cycle"), ("output%history", "none"))
        with scene_handle(job.base, settings) as scene, reading(job.base, settings):
            handle = created("mfv_create", scene)
        with Case._of_handle(handle) as case:
            case.run()
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # `_with_flags` marks what is not resolved
                cycle = stress_cycle(case.result(), x, 0.0)
        return comparison.lives_of(material, cycle, (parameter,))[parameter]

    def with_boundaries(self, table: xarray.Dataset, found: Sequence[Crossing]) -> xarray.Dataset:
        """The table with the boundaries along the dimension `crossing`, those of a curve one after another."""
        order, curve = self._ordered(table, found)
        ordered = [found[number] for number in order]
        values = [[one.value if one.along == axis else one.fixed for one in ordered] for axis in (0, 1)]
        columns: dict[str, tuple[Any, str, str]] = {
            "boundary": (np.array([one.name for one in ordered], dtype=object), "1", "regime on one side of the boundary"),
            "boundary_curve": (np.array(curve, dtype=np.int32), "1", "number of the curve, from 1"),
            "boundary_along": (
                np.array([self.names[one.along] for one in ordered], dtype=object),
                "1",
                "axis along which it was found",
            ),
            "boundary_tolerance": (np.array([one.tolerance for one in ordered]), "1", "half the bracket, in the unit of that axis"),
            "boundary_resolved": (
                np.array([one.is_resolved for one in ordered], dtype=np.int8),
                "1",
                "0: the mesh does not resolve it",
            ),
        }
        for name, of_axis in zip(self.names, values):
            columns[f"boundary_{name}"] = (
                np.array(of_axis, dtype=float),
                table[name].attrs.get("units", "1"),
                f"{name} at the boundary",
            )
        for name in {*self.names} & {*SHORT}:
            table[name].attrs["long_name"] = SHORT[name][1]
        return table.assign(
            {name: ("crossing", of, {"units": unit, "long_name": meaning}) for name, (of, unit, meaning) in columns.items()}
        )

    def _ordered(self, table: xarray.Dataset, found: Sequence[Crossing]) -> tuple[list[int], list[int]]:
        """The numbers of the crossings in the order of their curves, and the numbers of these. A closed curve has its first point twice;
        a crossing next to a case that says nothing is a curve of its own."""
        order: list[int] = []
        curve: list[int] = []
        for name, samples in self.samples(table).items():
            at = {(one.along, *one.place): (number, one.value) for number, one in enumerate(found) if one.name == name}
            inside = _inside(np.vectorize(lambda one: one.value, otypes=[float])(samples))
            pairs = [
                pair
                for cell in boundaries.cells(self.values, inside, at)
                for pair in zip(cell.crossings[::2], cell.crossings[1::2])
            ]
            chains = boundaries.curves(pairs)
            joined = {number for chain in chains for number in chain}
            for chain in [*chains, *([number] for number, _ in at.values() if number not in joined)]:
                curve += [curve[-1] + 1 if curve else 1] * len(chain)
                order += chain
        return order, curve

    def attributes(self, contour: str) -> dict[str, Any]:
        """The attributes of a map: its axes, its column, its criteria."""
        return {
            "map_axes": list(self.names),
            "map_contour": contour,
            "map_stick_ratio": self.stick_ratio,
            "map_tolerance": self.tolerance,
        }


def _inside(values: NDArray[Any]) -> NDArray[Any]:
    """1 within a regime, 0 outside, NaN unknown, from the values of samples."""
    return np.where(np.isnan(values), np.nan, values >= 0.0)


def polygons(table: xarray.Dataset, name: str) -> list[list[tuple[float, float]]]:
    """The cells of a map, or their parts, that are within a regime, as polygons up to its boundaries; of failed cases all cells
    around them. `name`: of a regime, or 'yielding'. Partial slip is what the others leave: it has no polygons of its own."""
    names = list(table.attrs["map_axes"])
    axes = [table[one].values for one in names]
    if name == FAILED:
        fails = table["regime"].values == FAILED
        any_of_four = fails[:-1, :-1] | fails[1:, :-1] | fails[:-1, 1:] | fails[1:, 1:]
        x, y = axes
        return [[(x[i], y[j]), (x[i + 1], y[j]), (x[i + 1], y[j + 1]), (x[i], y[j + 1])] for i, j in zip(*np.nonzero(any_of_four))]
    if name == YIELDING:
        inside = _continued(table["yields"].values.astype(float))
    else:
        regime = table["regime"].values
        unknown = (FAILED,) if name == OPEN else (OPEN, FAILED)
        inside = np.where(np.isin(regime, unknown), np.nan, regime == name)
    at = {}
    for number in np.flatnonzero(table["boundary"].values == name):
        values = [float(table[f"boundary_{one}"].values[number]) for one in names]
        along = names.index(str(table["boundary_along"].values[number]))
        place = [
            int(np.searchsorted(axis, value, "right" if k != along else "left")) - 1
            for k, (axis, value) in enumerate(zip(axes, values))
        ]
        at[along, place[0], place[1]] = int(number), values[along]
    return [cell.polygon for cell in boundaries.cells(axes, inside, at)]


def _continued(inside: NDArray[Any]) -> NDArray[Any]:
    """An array of 1, 0 and NaN in which a NaN whose known neighbours all have one value has this value, too."""
    padded = np.pad(inside, 1, constant_values=np.nan)
    shape = inside.shape
    around = np.array([padded[i : i + shape[0], j : j + shape[1]] for i in range(3) for j in range(3)])
    lowest, highest = np.fmin.reduce(around), np.fmax.reduce(around)
    return np.where(np.isnan(inside) & (lowest == highest), lowest, inside)


def _fraction(name: str, value: float) -> float:
    """A number above 0 and at most 1. Raises InputError."""
    if not 0.0 < value <= 1.0:
        raise input_error(f"{name}={value:g}: must be above 0 and at most 1")
    return value


def _signs(inside: NDArray[Any]) -> NDArray[Any]:
    return np.where(inside, 1.0, -1.0)


def _samples(values: NDArray[Any], flags: Any = None, expected: Any = None, is_smooth: bool = False) -> NDArray[Any]:
    """An array of samples, in the shape of `values`."""
    found = np.empty(values.shape, dtype=object)
    for place in np.ndindex(*values.shape):
        where = (math.nan, math.nan) if expected is None else tuple(expected[place])
        found[place] = Sample(float(values[place]), is_smooth, where, flags is not None and bool(flags[place]))
    return found


def _unresolved(table: xarray.Dataset, column: str) -> NDArray[Any]:
    """Whether the mesh of a case does not resolve a column."""
    found: NDArray[Any] = np.vectorize(lambda names: column in names.split(), otypes=[bool])(table["unresolved"].values)
    return found


def _power(keys: Sequence[str]) -> float:
    """How the load at which everything slides depends on an axis: as its value for a tangential force, as its inverse for a normal force or a
    coefficient of friction; NaN for other keys."""
    powers = {"tangential_force": 1.0, "normal_force": -1.0, "mu": -1.0, "mu_static": -1.0}
    found = {powers.get(key.partition("%")[2], math.nan) for key in keys} - ({math.nan} if "friction%mu_static" in keys else set())
    return found.pop() if len(found) == 1 else math.nan
