"""The dataset of a study: an array for each quantity along the axes, errors against a reference, files."""

from __future__ import annotations

import functools
import math
import os
import re
import warnings
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .._packages import require

require("xarray", "h5netcdf")

import xarray
from numpy.typing import NDArray

from .._files import written
from .._library import library_version, outcome_of
from .axes import Coordinate, as_written
from .cases import COUNTS, DUNDURS_BETA, MOMENTS, NOT_RESOLVED, TRACTIONS, Solved, key_info, observables
from .plan import TITLE, Study, result_name

if TYPE_CHECKING:
    import pandas

#: Outcome of a case that has not been solved, and its status.
NOT_SOLVED, NO_STATUS = "not solved", -1

#: Dimensions of fields in the dataset.
DIMENSIONS = {"x": "node", "record": "record", "companion_nodes": "companion_node", "cycle": "cycle", "patch": "patch"}

#: Types of columns by the types of their values; numbers are float.
COLUMN_TYPES = {str: object, int: np.int32}

#: Between the warnings of a case. The column with names of columns that are not resolved; meaning of error bars.
BETWEEN, UNRESOLVED = " | ", "unresolved"
UNRESOLVED_MEANING = "columns that the mesh does not resolve, separated by blanks"
BAR = "estimated discretisation error, infinite if there is no limit, NaN if not resolved"

_NAN = float("nan")


def dataset_of(study: Study, keys: Sequence[str], solved: Sequence[Solved | None]) -> xarray.Dataset:
    """The dataset of a study from the saved results of its cases, in their order; None for an unsolved case.

    `keys`: the hashes of the cases, which name their result files.
    """
    units = study.units
    dimensions = [dimension.name for dimension in study.dimensions]
    coordinates: dict[str, Any] = {
        coordinate.name: (dimension.name, *_described(coordinate, units))
        for dimension in study.dimensions
        for coordinate in dimension.coordinates
        if coordinate.name != "row"
    }
    if len(study.bases) == 1:
        coordinates["base"] = study.bases[0].name
    columns = {
        name: (
            dimensions,
            np.array(values, dtype=COLUMN_TYPES.get(type(values[0]), float)).reshape(study.shape),
            {"units": _labelled(unit, units), "long_name": meaning},
        )
        for name, values, unit, meaning in _columns(study, keys, solved)
    }
    return xarray.Dataset(columns | _fields(study, solved), coordinates, _attributes(study, solved, units))


def frame_of(table: xarray.Dataset) -> pandas.DataFrame:
    """The dataset as a data frame, one row per case, without fields; logical values as 0 and 1."""
    if table["case"].ndim == 0:  # the mean over the only axis
        table = table.expand_dims("row")
    dimensions = table["case"].dims
    columns = [name for name in table.data_vars if table[name].dims == dimensions]
    coordinates = [name for name in table.coords if set(table[name].dims) <= set(dimensions)]
    frame: pandas.DataFrame = table[columns].to_dataframe().reset_index().sort_values("case", ignore_index=True)
    frame = frame[["case", *sorted(coordinates, key=lambda name: name != "base"), *columns[1:]]]
    table_of_cases: pandas.DataFrame = frame.astype({name: int for name in frame if frame[name].dtype == bool})
    return table_of_cases


def write(table: xarray.Dataset, path: str | os.PathLike[str]) -> None:
    """Write a dataset: as NetCDF (.nc, .h5), or as comma-separated values with one row per case (.csv). Raises OSError.

    In a CSV the names of columns have their units, such as 'shift [mm]', and a text that a spreadsheet would take for a formula has
    an apostrophe before it.
    """
    is_csv = Path(path).suffix.lower() == ".csv"
    # HDF5 can hang on a full disk, so the file is made in memory.
    content = _inert(_with_units(table)).to_csv(index=False).encode() if is_csv else bytes(table.to_netcdf(engine="h5netcdf"))
    try:
        with written(Path(path)) as part:
            part.write_bytes(content)
    except OSError as error:
        raise OSError(error.errno, f"{os.fspath(path)}: cannot be written: {error.strerror}") from error


def _with_units(table: xarray.Dataset) -> pandas.DataFrame:
    """The dataset as a data frame whose columns have names with units."""
    return frame_of(table).rename(columns=lambda name: label(table, name))


def label(table: xarray.Dataset, name: str) -> str:
    """The name of a column with its unit, if it has one: 'shift [mm]'."""
    unit = table[name].attrs.get("units", "1") if name in table.variables else "1"
    return name if unit == "1" else f"{name} [{unit}]"


def _inert(frame: pandas.DataFrame) -> pandas.DataFrame:
    """The data frame with an apostrophe before texts, and names of columns, that begin like a formula of a spreadsheet: with =, +, -,
    @, a tab or a line end (OWASP, CSV injection)."""

    def quoted(value: Any) -> Any:
        return f"'{value}" if isinstance(value, str) and value.startswith(tuple("=+-@\t\r\n")) else value

    texts = {name: frame[name].map(quoted) for name in frame if frame[name].dtype.kind not in "biuf"}
    return frame.assign(**texts).rename(columns=quoted)


def _columns(study: Study, keys: Sequence[str], solved: Sequence[Solved | None]) -> list[tuple[str, list[Any], str, str]]:
    """Name, values, unit and meaning of every column."""
    there = [one or Solved(NO_STATUS, "", observables=[_NAN] * len(observables())) for one in solved]
    columns: list[tuple[str, list[Any], str, str]] = [
        ("case", list(range(1, len(there) + 1)), "1", "number of the case"),
        (
            "outcome",
            [outcome_of(one.status) if one.status >= 0 else NOT_SOLVED for one in there],
            "1",
            "outcome of the case",
        ),
        ("status", [one.status for one in there], "1", "code of the outcome, 0 for complete (mfv_status.def)"),
        ("message", [one.message for one in there], "1", "message of the outcome"),
        ("warnings", [one.warnings.replace("\n", BETWEEN) for one in there], "1", f"warnings, separated by{BETWEEN.rstrip()}"),
        (UNRESOLVED, [" ".join(_unresolved(study, number, there)) for number in range(len(there))], "1", UNRESOLVED_MEANING),
    ]
    if any(one.error_estimate for one in there):
        meaning = "'yes' with error bars, or why there are none"
        columns.append(("error_estimate", [one.error_estimate for one in there], "1", meaning))
    for name, meaning in {**COUNTS, "nodes": "number of mesh nodes"}.items():
        columns.append((name, [one.counts[name] for one in there], "1", meaning))
    residuals = [one.largest_residual for one in there]
    columns.append(("largest_residual", residuals, "1", "largest relative residual of the certificate"))
    for place, (name, (unit, meaning)) in enumerate(observables().items()):
        if study.observables is None or name in study.observables:
            columns.append((name, [one.observables[place] for one in there], unit, meaning))
            bars = [one.bars[place] if one.bars else None for one in there]
            if any(bar is not None for bar in bars):
                columns.append((f"{name}_error", [_NAN if bar is None else bar for bar in bars], unit, f"{BAR}: {meaning}"))
    if study.reference is not None:
        columns += _errors(study, there)
    if study.results is not None:
        folder = os.path.relpath(study.results, study.results_from) if study.results_from else os.fspath(study.results)
        files = [os.path.join(folder, result_name(key)) if one.counts["nodes"] else "" for key, one in zip(keys, there)]
        columns.append(("result_file", files, "1", "result file of the case"))
    return columns


def _unresolved(study: Study, place: int, solved: Sequence[Solved]) -> list[str]:
    """The columns of a case that the mesh, or that of its reference, does not resolve. `place`: from 0."""
    names = solved[place].unresolved.split()
    kept = [name for name in names if study.observables is None or name in study.observables]
    if study.reference is not None:
        reference = solved[study.number_of_reference(place + 1) - 1].unresolved.split()
        kept += ["dissipation_ratio"] * ("cycle_dissipation" in (*names, *reference))
    return kept


def flagged(table: xarray.Dataset, name: str) -> xarray.DataArray:
    """For each case of a study, whether a column is in doubt: its mesh does not resolve it, or a warning is about more than the mesh.

    `table[name].where(~flagged(table, name))` has NaN in place of such values. Raises KeyError for an unknown column.
    """
    table[name]

    def is_flagged(warnings: str, unresolved: str) -> bool:
        return name in unresolved.split() or any(NOT_RESOLVED not in one for one in warnings.split(BETWEEN) if one)

    found: xarray.DataArray = xarray.apply_ufunc(
        is_flagged, table["warnings"], table[UNRESOLVED], vectorize=True, output_dtypes=[bool]
    )
    return found


def _errors(study: Study, solved: Sequence[Solved]) -> list[tuple[str, list[Any], str, str]]:
    """Differences of every case from its reference."""
    pairs = [(one, solved[study.number_of_reference(number) - 1]) for number, one in enumerate(solved, start=1)]
    columns: list[tuple[str, list[Any], str, str]] = []
    for moment in MOMENTS:
        for traction, words in zip(TRACTIONS, ("pressures", "shear tractions")):
            meaning = f"L1 difference of the {words} from the reference, relative to the reference, at the point {moment} of the load history (eq. 6.6)"
            values = [_traction_error(one, reference, moment, traction) for one, reference in pairs]
            columns.append((f"{traction}_error_{moment}", values, "1", meaning))
    ratios = [_dissipation_ratio(one, reference) for one, reference in pairs]
    columns.append(("dissipation_ratio", ratios, "1", "cycle_dissipation divided by that of the reference"))
    return columns


def _traction_error(one: Solved, reference: Solved, moment: str, traction: str) -> float:
    """Sum of the absolute differences divided by that of the reference (eq. 6.6). NaN if either case does not reach this point, if
    the traction of the reference is zero, or, except at the beginning of the cycles, if the numbers of cycles differ."""
    path = f"moments/{moment}/{traction}"
    if path not in one.arrays or path not in reference.arrays or not (moment == "loading" or _has_same_cycles(one, reference)):
        return _NAN
    here, there = _side_by_side(one, reference, path)
    total = float(np.abs(there).sum())
    return float(np.abs(here - there).sum()) / total if total > 0.0 else _NAN


def _side_by_side(one: Solved, reference: Solved, path: str) -> tuple[NDArray[Any], NDArray[Any]]:
    """The nodal forces of a traction in two cases on common intervals of the surface.

    Meshes with equal intervals and centres: their common intervals, zero beyond the narrower mesh. Others: intervals around the
    nodes of both meshes, with tractions linear between nodes and zero beyond the ends.
    """
    here, there = one.arrays[path], reference.arrays[path]
    interval, other = one.arrays["mesh/interval"][0], reference.arrays["mesh/interval"][0]
    if abs(interval - other) <= 1e-9 * other and (here.size - there.size) % 2 == 0:
        size = max(here.size, there.size)
        return _widened(here * one.arrays["mesh/width"], size), _widened(there * reference.arrays["mesh/width"], size)
    x = np.union1d(one.arrays["mesh/x"], reference.arrays["mesh/x"])
    width = np.gradient(x)
    here, there = (np.interp(x, kept.arrays["mesh/x"], kept.arrays[path], 0.0, 0.0) for kept in (one, reference))
    return here * width, there * width


def _widened(values: NDArray[Any], size: int) -> NDArray[Any]:
    """Values padded with zeros on both sides."""
    return values if values.size == size else np.pad(values, (size - values.size) // 2)


@functools.cache
def _place(observable: str) -> int:
    return list(observables()).index(observable)


def _has_same_cycles(one: Solved, other: Solved) -> bool:
    """Whether two cases have the same number of complete cycles, at least one."""
    here, there = (solved.observables[_place("cycles")] for solved in (one, other))
    return math.isfinite(here) and here == there


def _dissipation_ratio(one: Solved, reference: Solved) -> float:
    here, there = (solved.observables[_place("cycle_dissipation")] for solved in (one, reference))
    is_told = _has_same_cycles(one, reference) and math.isfinite(here) and abs(there) > 0.0
    return here / there if is_told else _NAN


def _fields(study: Study, solved: Sequence[Solved | None]) -> dict[str, Any]:
    """The requested fields that any case has, padded with NaN. mesh_x has the positions of fields at nodes."""
    fields: dict[str, Any] = {}
    dimensions = [dimension.name for dimension in study.dimensions]
    longest: dict[str, int] = {}
    for one in (one for one in solved if one is not None):
        for path, (along, _, _) in one.about.items():
            longest[along] = max(one.arrays[path].size, longest.get(along, 0))
    for path in study.wanted_fields:
        having = [(place, one) for place, one in enumerate(solved) if one is not None and path in one.arrays]
        if not having:
            warnings.warn(f"no case has the field '{path}'", stacklevel=2)
            continue
        along, unit, meaning = having[0][1].about[path]
        values = np.full((len(solved), longest[along]), np.nan)
        for place, one in having:
            values[place, : one.arrays[path].size] = one.arrays[path]
        about = {"units": unit, "long_name": meaning, "path": path}
        shape, names = (study.shape, dimensions)
        if along:
            shape, names = ((*shape, longest[along]), [*dimensions, DIMENSIONS[along]])
        fields[path.replace("/", "_")] = (names, values.reshape(shape), about)
    return fields


def _described(coordinate: Coordinate, units: dict[str, str]) -> tuple[Any, dict[str, str]]:
    """The values of an axis as an array, and their attributes."""
    array = _as_array(coordinate.values)
    if coordinate.name == "base":
        return array, {"long_name": "base case"}
    if not coordinate.keys:
        return array, {}
    if coordinate.keys[0] == DUNDURS_BETA:
        return array, {"units": "1", "long_name": "Dundurs' parameter beta, positive where the lower body couples more"}
    about = key_info(coordinate.keys[0])
    assert about is not None
    group, _, key = coordinate.keys[0].partition("%")
    return array, {
        "units": _labelled(about[1] or "1", units),
        "long_name": f"&{group.partition('(')[0]} {key}: {about[2]}",
    }


def _as_array(values: Sequence[Any]) -> NDArray[Any]:
    """The values of an axis as an array: numbers, texts, or, for others such as lists, their numbers from 1."""
    if all(isinstance(value, (bool, int, float)) for value in values):
        return np.array(values)
    if all(isinstance(value, (str, bool, int, float)) for value in values):
        return np.array([value if isinstance(value, str) else as_written(value) for value in values], dtype=object)
    return np.arange(1, len(values) + 1)


def _labelled(unit: str, units: dict[str, str]) -> str:
    """A unit in terms of length and force with the user's names of these."""
    return re.sub(r"\b(length|force)\b", lambda found: units[found[0]], unit)


def _attributes(study: Study, solved: Sequence[Solved | None], units: dict[str, str]) -> dict[str, Any]:
    """The attributes of the whole dataset."""
    outcomes = Counter(outcome_of(one.status) for one in solved if one is not None)
    attributes: dict[str, Any] = {"title": TITLE, "mfv_version": library_version()}
    if study.input:
        attributes["input"] = study.input
    for number, base in enumerate(study.bases, start=1):
        attributes |= {f"base_{number}": base.text, f"base_{number}_file": base.name}
    attributes |= {"length_unit": units["length"], "force_unit": units["force"]}
    attributes["cases_flagged"] = sum(bool(one.warnings) for one in solved if one is not None)
    attributes |= {"complete": int(None not in solved), "cases": len(solved), "cases_done": sum(outcomes.values())}
    return attributes | {f"cases_{outcome.replace(' ', '_')}": count for outcome, count in sorted(outcomes.items())}
