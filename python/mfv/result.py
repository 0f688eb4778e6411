"""Results of runs and of result files."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from . import _html
from ._packages import require
from ._suggestions import suggestion
from .errors import MfvError, NotAResult

if TYPE_CHECKING:
    import h5py
    import xarray

    from .scene import Scene

Values = Any
"""Values of a quantity: an array of float64 or int32, or one such number."""

#: Groups and texts that every result has.
GROUPS = ("mesh", "scene", "state", "summary", "certificate")
TEXTS = ("mfv_version", "outcome", "message", "input")

#: Optional groups of a result; empty if absent.
OPTIONAL_GROUPS = ("history", "reference", "error_estimate", "sensitivity", "observables", "cycles", "patches")

#: Groups with coordinates of their own; elsewhere coordinates are repeated.
COORDINATES = {
    "mesh": ("x",),
    "history": ("record",),
    "error_estimate": ("companion_nodes",),
    "cycles": ("cycle",),
    "patches": ("patch",),
}

#: Groups of numbers, and of lists.
NUMBERS = ("summary", "certificate", "sensitivity", "observables", "scene")
LISTS = ("history", "cycles", "patches")

#: Observables whose error bars are those of numbers of the summary that have none of their own (docs/theory.md).
BARS = {
    "contact_left": "contact_length",
    "contact_right": "contact_length",
    "stick_left": "left_slip_zone",
    "stick_right": "right_slip_zone",
}

#: The group of the stresses of mfv_stress.
STRESS = "stress/"

#: The dimension along which `Result.to_xarray` stacks the steps.
STATE = "state"


class NoQuantity(MfvError, KeyError):
    """A group lacks a quantity."""


class NoAttribute(MfvError, AttributeError):
    """A group lacks a quantity."""


class Field(NamedTuple):
    """One quantity. `dimensions`: names of its dimensions, such as ("x",); () for a number."""

    values: Values
    unit: str
    description: str
    dimensions: tuple[str, ...] = ()


class Group(Mapping[str, Values]):
    """Named quantities, as attributes and items: `group.pressure` is `group["pressure"]`; `in` tests for a name.

    Coordinates are available in the same way, such as `result.state.x`, but are listed only in their own group.
    """

    def __init__(self, fields: Mapping[str, Field], coordinates: Mapping[str, Field] | None = None) -> None:
        """`coordinates`: the coordinates of the quantities by name, unless they are among the fields."""
        self._fields = dict(fields)
        self._coordinates = coordinates or {}

    def _along(self) -> set[str]:
        """Names of the coordinates."""
        return {name for field in self._fields.values() for name in field.dimensions if name in self._coordinates}

    def _field(self, name: str) -> Field:
        if name not in self._fields and name in self._along():
            return self._coordinates[name]
        if name not in self._fields:
            raise NoQuantity(None, f"no quantity '{name}'{_known(name, self)}")
        return self._fields[name]

    def __getitem__(self, name: str) -> Values:
        return self._field(name).values

    def __getattr__(self, name: str) -> Values:
        if name.startswith("_"):  # private and special names are never quantities
            raise AttributeError(name)
        if name in self:
            return self[name]
        raise NoAttribute(None, f"no quantity '{name}'{_known(name, self)}")

    def __setattr__(self, name: str, value: object) -> None:
        if not name.startswith("_") and name in self:
            raise AttributeError(f"'{name}' is a quantity of the result and cannot be set; copy its values instead")
        super().__setattr__(name, value)

    def __eq__(self, other: object) -> bool:
        """Whether all quantities have equal values; NaN equals NaN."""
        if not isinstance(other, Group):
            return NotImplemented
        return self.keys() == other.keys() and all(np.array_equal(self[name], other[name], equal_nan=True) for name in self)

    __hash__ = None  # type: ignore[assignment]  # as of every mapping

    def __iter__(self) -> Iterator[str]:
        return iter(self._fields)

    def __len__(self) -> int:
        return len(self._fields)

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._fields, *self._along()]

    def __repr__(self) -> str:
        lines = [
            f"  {name:24} {_short(field.values):>14} {field.unit:16} {field.description}" for name, field in self._fields.items()
        ]
        return "\n".join(["<mfv.Group", *lines]) + ">"

    def _repr_html_(self) -> str:
        rows = [(name, _short(field.values), _html.unit(field.unit), field.description) for name, field in self._fields.items()]
        return _html.table(rows, numbers=(1,))

    def to_xarray(self) -> xarray.Dataset:
        """The group as an xarray.Dataset with its coordinates; units and long_name as attributes. Needs xarray."""
        return _dataset(self._fields, self._coordinates)

    def dimensions(self, name: str) -> tuple[str, ...]:
        """Names of the dimensions of a quantity; () for a number. Raises NoQuantity."""
        return self._field(name).dimensions

    def unit(self, name: str) -> str:
        """Unit of a quantity."""
        return self._field(name).unit

    def description(self, name: str) -> str:
        """Description of a quantity."""
        return self._field(name).description


class Result:
    """A result: groups of quantities as attributes, `steps` with the state at the end of every step and reversal.

    `stresses`: the stresses that mfv_stress has written into the file, by state and body: `stresses["last/lower"]`.
    `attributes` are the texts of the result: title, outcome, message, input, ...
    """

    mesh: Group
    scene: Group
    state: Group
    summary: Group
    certificate: Group
    history: Group
    reference: Group
    error_estimate: Group
    sensitivity: Group
    observables: Group
    cycles: Group
    patches: Group
    compliance: Group
    steps: list[Group]
    stresses: dict[str, Group]
    attributes: dict[str, str]

    def __init__(
        self,
        groups: Mapping[str, Mapping[str, Field]],
        attributes: Mapping[str, str],
        source: Scene | None = None,
    ) -> None:
        """`groups` by path, those of the steps as steps/0001 and so on. `source`: the scene, if it has arrays, which the input
        among the attributes does not contain."""
        coordinates = {name: groups[path][name] for path, names in COORDINATES.items() if path in groups for name in names}
        steps = sorted((path for path in groups if path.startswith("steps/")), key=lambda path: int(path.split("/")[1]))
        self.steps = [Group(groups[path], coordinates) for path in steps]
        self.attributes = dict(attributes)
        self._source = source
        for name in OPTIONAL_GROUPS:
            setattr(self, name, Group({}))
        self.stresses = {path.removeprefix(STRESS): Group(group) for path, group in groups.items() if path.startswith(STRESS)}
        self._names = [path for path in groups if path not in steps and not path.startswith(STRESS)]
        for name in self._names:
            setattr(self, name, Group(groups[name], coordinates))

    @property
    def outcome(self) -> str:
        """Outcome of the run: 'complete', 'gross sliding', ..."""
        return self.attributes["outcome"]

    @property
    def message(self) -> str:
        """What was reached, or why the run ended early."""
        return self.attributes["message"]

    @property
    def title(self) -> str:
        """Title of the scene, or an empty text."""
        return self.attributes.get("title", "")

    @property
    def warnings(self) -> list[str]:
        """What is to be known before numbers are used: slip zones with few nodes, a model beyond its limits, ..."""
        return self.attributes.get("warnings", "").splitlines()

    @property
    def unresolved(self) -> list[str]:
        """Names of the observables that the mesh does not resolve; `warnings` say why."""
        return self.attributes.get("unresolved", "").split()

    def error_bar(self, name: str) -> float:
        """Estimated discretisation error of an observable, in its unit: NaN where it is not resolved, infinite where it has no limit.
        Raises ValueError for a result without error bars, with the reason; KeyError for counts and others that have none, with the
        observable whose bar counts."""
        if not self.error_estimate:
            reason = self.attributes.get("error_estimate", "run with error_estimate=True in Output, or mfv run --estimate")
            raise ValueError(f"no error bars: {reason.removeprefix('none: ')}")
        bars = [bar.removesuffix("_error") for bar in self.error_estimate if bar.endswith("_error")]
        if name not in bars:
            other = BARS.get(name)
            rule = (
                f"take that of {other}" if other in bars else "counts, prescribed loads and numbers derived from others have none"
            )
            is_known = name in self.summary or name in self.observables
            raise NoQuantity(
                None,
                f"'{name}' has no error bar of its own: {rule}" if is_known else f"no observable '{name}'{suggestion(name, bars)}",
            )
        return float(self.error_estimate[f"{name}_error"])

    def at(self, step: int | None = None) -> Group:
        """The last state, or `steps[step - 1]`. Raises ValueError if it does not exist."""
        if step is None:
            return self.state
        if not 1 <= step <= len(self.steps):
            raise ValueError(f"no state {step}: the result has {len(self.steps)} in /steps, numbered from 1")
        return self.steps[step - 1]

    def to_xarray(self) -> dict[str, xarray.Dataset]:
        """Every group that is not empty as an xarray.Dataset, by name; "steps" has all steps stacked along `state`, numbered
        from 1 as in the file. Units and long_name are attributes of the variables, texts of the result those of the
        datasets. `xarray.DataTree.from_dict` makes a tree of it. Needs xarray.
        """
        texts = {name: text for name, text in self.attributes.items() if name != "input"}
        datasets = {name: getattr(self, name).to_xarray() for name in self._names}
        if self.steps:
            datasets["steps"] = _stacked(self.steps)
        return {name: dataset.assign_attrs(texts) for name, dataset in datasets.items()}

    def __repr__(self) -> str:
        lines = [f"<mfv.Result {self.title}".rstrip(), *(f"  {name:14}{text}" for name, text in self._words())]
        return "\n".join(lines) + ">"

    def _repr_html_(self) -> str:
        return _html.table(self._words(), self.title)

    def _words(self) -> list[tuple[str, str]]:
        """The result in a few lines, each with its name."""
        amount = self._amount
        lines = [
            ("outcome", f"{self.outcome}: {self.message}"),
            ("nodes", f"{self.mesh.x.size}, {counts(self.summary)}"),
            ("normal", f"force {amount('normal_force')}, approach {amount('approach')}"),
            ("tangential", f"force {amount('tangential_force')}, shift {amount('shift')}"),
            ("certificate", f"largest relative residual {amount('largest_residual')}"),
            ("kept", kept(self)),
        ]
        return lines + [("warning", line) for line in self.warnings]

    def _amount(self, name: str) -> str:
        """A value of the summary with its unit."""
        unit = self.summary.unit(name)
        return f"{self.summary[name]:.6g}" + ("" if unit == "1" else f" {unit}")


def _known(name: str, group: Group) -> str:
    """The end of a message about an unknown quantity of a group."""
    return suggestion(name, group) if group else ": the group is empty"


def kept(result: Result) -> str:
    """The numbers of states and of history records, as text."""
    return f"{len(result.steps)} states in steps, {len(result.history.get('record', ()))} records in history"


def counts(loads: Group) -> str:
    """The node counts of a state, as text."""
    text = f"{loads.contact_nodes} in contact"
    if loads.stick_nodes + loads.slip_nodes > 0:
        text += f" ({loads.stick_nodes} stuck, {loads.slip_nodes} slipping)"
    return text


def doubt(result: Result, *names: str) -> str:
    """What follows a number if the mesh does not resolve one of these observables, by which it is known."""
    return " (not resolved)" if set(names) & set(result.unresolved) else ""


def is_last(result: Result, state: Group) -> bool:
    """Whether a state has the tractions of the last one."""
    return all(np.array_equal(state[name], result.state[name]) for name in ("pressure", "shear"))


def read(path: str | os.PathLike[str]) -> Result:
    """The result in a file. Raises OSError, NotAResult."""
    path = os.fspath(path)
    if os.path.exists(path) and not os.path.isfile(path) and not os.path.isdir(path):
        raise NotAResult(None, f"{path}: not a result file of MFV; it is a pipe or a device")
    with open(path, "rb"):  # raises OSError for a missing or unreadable file
        pass
    import h5py  # here: it takes a third of the time of numpy

    if not h5py.is_hdf5(path):
        why = "not a result file of MFV; it is not an HDF5 file"
        if os.fspath(path).endswith(".nml"):
            why = "a case, not a result; solve it first with 'mfv run', which writes the result"
        elif os.fspath(path).endswith(".csv"):
            why = "not a result; for the table of a study write NetCDF: 'mfv study STUDY.nml' gives STUDY.nc"
        raise NotAResult(None, f"{path}: {why}")
    try:
        with h5py.File(path, "r") as file:
            is_ours = "mfv_version" in file.attrs
            groups = _groups(file) if is_ours else {}
            texts = {name: str(value) for name, value in file.attrs.items()} if is_ours else {}
    except Exception as error:  # h5py and numpy raise exceptions of many types for a damaged file
        raise NotAResult(None, f"{path}: damaged, or not a result file of MFV: {error}") from error
    if not is_ours:
        raise NotAResult(None, f"{path}: an HDF5 file, but not a result file of MFV")
    missing = [f"the group {name}" for name in GROUPS if name not in groups]
    missing += [f"the attribute {name}" for name in TEXTS if name not in texts]
    if missing and "cases" in texts:
        raise NotAResult(None, f"{path}: the table of a study, not a result; 'mfv plot' draws it and 'mfv info' lists its columns")
    if missing:
        raise NotAResult(None, f"{path}: not a result file of MFV; missing: {', '.join(missing)}")
    if fault := _fault(groups):
        raise NotAResult(None, f"{path}: damaged: {fault}")
    return Result(groups, texts)


def _fault(groups: Mapping[str, Mapping[str, Field]]) -> str:
    """What is wrong with the values of the groups of a result; empty if they are numbers or arrays as they should be."""
    nodes = np.shape(groups["mesh"]["x"].values) if "x" in groups["mesh"] else ()
    if len(nodes) != 1:
        return "mesh/x is not a list"
    for path, group in groups.items():
        name = path.partition("/")[0]
        if name == "steps" and not path.removeprefix("steps/").isdecimal():
            return f"the group {path} is not that of a step"
        if path in ("state", *(path for path in groups if path.startswith("steps/"))) and not {"pressure", "shear"} <= group.keys():
            return f"{path} has no tractions"
        for field, (values, *_) in group.items():
            shape = np.shape(values)
            if name not in (*GROUPS, *OPTIONAL_GROUPS, "steps", "stress"):
                continue
            if np.asarray(values).dtype.kind not in "biuf":
                return f"{path}/{field} has no numbers"
            if path in NUMBERS and shape:
                return f"{path}/{field} is not one number"
            if path in LISTS and len(shape) != 1:
                return f"{path}/{field} is not a list"
            if path == "error_estimate" and len(shape) != ("_companion" in f"_{field}"):
                return f"{path}/{field} is not {'a list' if not shape else 'one number'}"
            is_along_nodes = (path == "mesh" and shape) or path == "state" or (name == "steps" and field in groups["state"])
            if is_along_nodes and shape != nodes:
                return f"{path}/{field} has not one value for each node"
    return ""


def _values_of(dataset: h5py.Dataset) -> Values:
    """The values of a dataset. Raises ValueError if its size exceeds what the file can contain, before memory is allocated.
    (Deflate compresses at most 1032 bytes to one.)"""
    if dataset.nbytes > 2**20 and dataset.size > 1032 * dataset.id.get_storage_size():
        raise ValueError(f"{dataset.name} has fewer values than its size")
    return dataset[()]


def _groups(file: h5py.File) -> dict[str, dict[str, Field]]:
    """All groups with datasets, by path, without repeated coordinates."""
    import h5py

    groups: dict[str, dict[str, Field]] = {}

    def add(group: h5py.Group) -> None:
        path, items = group.name.strip("/"), dict(group.items())
        scales = {item.id: name for name, item in items.items() if isinstance(item, h5py.Dataset) and item.is_scale}
        for name, item in items.items():
            if isinstance(item, h5py.Group):
                add(item)
            elif (path in COORDINATES and name in COORDINATES[path]) or path.startswith(STRESS) or item.id not in scales:
                groups.setdefault(path, {})[name] = _field(name, item, scales)

    add(file)
    return groups


def _field(name: str, dataset: h5py.Dataset, scales: Mapping[h5py.h5d.DatasetID, str]) -> Field:
    """A dataset by its name, with the names of the dimension `scales` of its group: HDF5 searches the whole file for the name of one."""
    attached = [d[0] for d in dataset.dims if len(d) > 0]
    dimensions = tuple(scales.get(scale.id) or scale.name.rsplit("/", 1)[1] for scale in attached)
    if dataset.id in scales:
        dimensions = (name,)
    unit, description = (str(dataset.attrs.get(attribute, "")) for attribute in ("units", "long_name"))
    return Field(_values_of(dataset), unit, description, dimensions)


def _dataset(fields: Mapping[str, Field], coordinates: Mapping[str, Field]) -> xarray.Dataset:
    """Fields with their coordinates."""
    require("xarray")
    import xarray

    known = {**coordinates, **fields}
    used = {dimension for field in fields.values() for dimension in field.dimensions if dimension in known}
    variables = {
        name: xarray.Variable(field.dimensions, field.values, {"units": field.unit, "long_name": field.description})
        for name, field in {**{name: known[name] for name in sorted(used)}, **fields}.items()
    }
    return xarray.Dataset(
        {name: variable for name, variable in variables.items() if name not in used},
        {name: variable for name, variable in variables.items() if name in used},
    )


def _stacked(steps: list[Group]) -> xarray.Dataset:
    """The steps in one dataset, along `state`."""
    require("xarray")
    import xarray

    numbers = xarray.Variable((STATE,), np.arange(1, len(steps) + 1), {"long_name": "number of the state in steps"})
    stacked = xarray.concat([step.to_xarray() for step in steps], dim=STATE, data_vars="all", combine_attrs="override")
    return stacked.assign_coords({STATE: numbers})


def _short(values: Values) -> str:
    """A value, or the size of an array."""
    return f"({values.size})" if isinstance(values, np.ndarray) else f"{values:.6g}"
