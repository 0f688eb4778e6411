"""A study: its bases, its dimensions, and its cases, numbered from 1."""

from __future__ import annotations

import contextlib
import errno
import functools
import math
import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import h5py
import numpy as np

from .. import errors
from .._observer import progress_bar
from ..errors import input_error
from ..scene import Scene
from . import executors
from .axes import (
    Axis,
    Coordinate,
    Dimension,
    as_written,
    dimensions_of,
    fault,
    fault_of_key,
    fault_of_pair,
    numbered_group,
)
from .bases import Given, absolute, base_of, counts_of_groups, units_of, whole_paths
from .cases import FILE_KEYS, Base, Job, Solved, case_text, check, datums_of_case, digest, digest_of_base, observables
from .store import Store

if TYPE_CHECKING:
    import xarray

#: Columns of every study and dimensions of fields; axes cannot have these names.
TAKEN = ("case", "base", "outcome", "status", "message", "warnings", "unresolved", "error_estimate", "steps_done", "events",
         "linear_solves", "nodes", "largest_residual", "row", "node", "record", "cycle", "patch", "companion_node", "result_file")  # fmt: skip

#: Key of a case for error bars.
ERROR_ESTIMATE = "output%error_estimate"

#: Title of the table of a study.
TITLE = "Study over cases of frictional contact"

#: Suffixes of files that it can be written to: NetCDF, and comma-separated values.
SUFFIXES = (".nc", ".h5", ".csv")

#: Number of values of an axis that are checked before the start.
TRIED = 200


def study(
    base: Given | Sequence[Given] | Callable[[dict[str, Any]], Scene],
    axes: Any = None,
    *,
    observables: str | Iterable[str] | None = None,
    fields: str | Iterable[str] = (),
    reference: str | Mapping[str, Any] | None = None,
    results: str | os.PathLike[str] | None = None,
    error_estimate: bool = False,
    executor: str | Executor = "threads",
    workers: int | None = None,
    store: str | os.PathLike[str] | None = None,
    again: bool = False,
    progress: bool = False,
) -> xarray.Dataset:
    """Solve many cases that differ in some values; for the arguments see `Study` and `Study.run`."""
    planned = Study(
        base, axes, observables=observables, fields=fields, reference=reference, results=results, error_estimate=error_estimate
    )
    return planned.run(executor=executor, workers=workers, store=store, again=again, progress=progress)


class Study:
    """Cases that differ in some values: the varied keys, and the requested results."""

    def __init__(
        self,
        base: Given | Sequence[Given] | Callable[[dict[str, Any]], Scene],
        axes: Any = None,
        *,
        observables: str | Iterable[str] | None = None,
        fields: str | Iterable[str] = (),
        reference: str | Mapping[str, Any] | None = None,
        results: str | os.PathLike[str] | None = None,
        error_estimate: bool = False,
    ) -> None:
        """`base`: a Scene or the path of a case; several of them, which become the first axis, 'base'; or a function that returns
        a Scene for a dict with the value of every axis.

        `axes`: by name, the values of a key of the case ('friction%mu'), an Axis of keys that change together, or a mapping of
        these, which are zipped along one dimension. All combinations are solved, the last axis fastest. Or a table of cases:
        a pandas.DataFrame, or a list of mappings, with a column for each key. A key takes the place of those that it is an
        alternative to (shift that of tangential_force). 'dundurs_beta' varies the materials of both bodies.

        `observables`: names of the observables in the dataset; by default all. `fields`: paths of fields of each case, such
        as 'state/pressure'. `reference`: 'full', or an axis with one of its values, {'mesh%nodes': 1001}: the tractions of
        each case are compared with those of the case that is the same but for this. `results`: a folder for the result file
        of every case. `error_estimate`: error bars of the observables from coarser meshes, about twice the time; as
        error_estimate in &output of the base. Raises InputError for keys, names and factors that cannot be; OSError for a base that cannot be read.
        """
        self.makes_scenes: Callable[[dict[str, Any]], Scene] | None = base if callable(base) else None
        given = [] if callable(base) else [base] if isinstance(base, (Scene, str, os.PathLike, Base)) else list(base)
        if self.makes_scenes is None and not given:
            raise input_error("no base case given")
        self.bases = [base_of(one) for one in given]
        self._shared = [whole_paths(one) for one in self.bases]
        self._check_bases()
        is_made = isinstance(axes, list) and bool(axes) and all(isinstance(axis, Dimension) for axis in axes)
        self.dimensions = list(axes) if is_made else dimensions_of(axes, are_keys=self.makes_scenes is None)
        if len(self.bases) > 1:
            names = Coordinate("base", (), [one.name for one in self.bases])
            self.dimensions.insert(0, Dimension("base", [names]))
        if not self.dimensions:
            self.dimensions = [Dimension("row", [Coordinate("row", (), [0])])]
        self.observables = None if observables is None else _names(observables)
        #: Paths of the requested fields, with the positions of nodes if a field needs them.
        self.wanted_fields = tuple(dict.fromkeys([*_names(fields), "mesh/x"])) if fields else ()
        #: Folder of result files, and the folder to which their paths in the dataset are relative (None: as given).
        self.results = None if results is None else Path(results)
        self.results_from: Path | None = None
        self.error_estimate = error_estimate
        #: The text of the study and its file; the file of its table, and whether it saves result files.
        self.input, self.input_file, self.file, self.keeps_results = "", "", "", False
        self._is_checked = False
        #: The study whose axes have other values here; see `at`.
        self._origin: Study | None = None
        self._check_names()
        self._check_keys()
        #: Dimension and place of the reference.
        self.reference: tuple[int, int] | None = None
        if reference is not None:
            self.set_reference(reference)

    def __len__(self) -> int:
        return math.prod(self.shape)

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of values along each dimension."""
        return tuple(len(dimension) for dimension in self.dimensions)

    @property
    def coordinates(self) -> list[Coordinate]:
        """All axes."""
        return [coordinate for dimension in self.dimensions for coordinate in dimension.coordinates]

    @functools.cached_property
    def units(self) -> dict[str, str]:
        """The user's names of length and force. Raises InputError."""
        return units_of(self.job(1).base)

    def point(self, number: int) -> dict[str, Any]:
        """The values of the axes of case `number`, from 1, by their names. Raises ValueError."""
        places = self._places(number)
        return {
            coordinate.name: coordinate.values[place]
            for dimension, place in zip(self.dimensions, places)
            for coordinate in dimension.coordinates
            if coordinate.name != "row"
        }

    def describe(self, number: int) -> str:
        """The values of case `number` as text: base='hole.nml', friction%mu=0.3."""
        point = self.point(number)
        if len(self.bases) == 1:
            point = {"base": self.bases[0].name, **point}
        return ", ".join(f"{name}={as_written(value)}" for name, value in point.items())

    def text(self, number: int) -> str:
        """Case `number` as a namelist text, for mfv_run. Raises ValueError, InputError."""
        job = self.job(number)
        return case_text(job.base, job.settings)

    def job(self, number: int) -> Job:
        """Case `number`, ready to be solved. Raises ValueError."""
        job = self._job_as_given(number)
        datums = tuple((key, self._datum) for key in datums_of_case(job.base, job.settings))
        return replace(job, settings=job.settings + datums) if datums else job

    def _job_as_given(self, number: int) -> Job:
        """Case `number`, perhaps with a default datum that no other case has. Raises ValueError."""
        places = self._places(number)
        settings = [
            setting
            for dimension, place in zip(self.dimensions, places)
            for coordinate in dimension.coordinates
            for setting in coordinate.settings(place)
        ]
        if self.makes_scenes is not None:
            base = base_of(self.makes_scenes(self.point(number)))
            shared = whole_paths(base)
        else:
            which = places[0] if len(self.bases) > 1 else 0
            base, shared = self.bases[which], self._shared[which]
        named = {key: absolute(value, base) if key in FILE_KEYS else value for key, value in settings}
        bars = {ERROR_ESTIMATE: True} if self.error_estimate else {}
        return Job(base, tuple({**bars, **shared, **named}.items()), self.wanted_fields, self.reference is not None)

    @functools.cached_property
    def _datum(self) -> float:
        """The datum of all cases that would have one of their own loads or mesh: the largest of these, so that none is inside the
        contact."""
        if self._origin is not None:
            return self._origin._datum
        jobs = (self._job_as_given(number) for number in range(1, len(self) + 1))
        return max(datum for job in jobs for datum in datums_of_case(job.base, job.settings).values())

    def at(self, points: Mapping[str, Sequence[Any]]) -> Study:
        """The study of other cases: `points` has a list of values for each axis, all of one length. They have the datum of this study
        and are not checked one by one. Raises InputError."""
        axes = {one.name: Axis(one.keys, points[one.name], one.factors) for one in self.coordinates if one.keys}
        study = Study(self.bases, {"row": axes}, error_estimate=self.error_estimate)
        study._origin, study._is_checked = self, True
        return study

    def check(self) -> None:
        """Check every base, and every value with the first values of the others (only some values of long axes).

        Raises InputError, which names case and values, for an invalid one.
        """
        if self.makes_scenes is not None or self._is_checked:
            return
        first = [0] * len(self.shape)
        for along, length in enumerate(self.shape):
            for place in _tried(length):
                if along == 0 or place > 0:
                    self._try([*first[:along], place, *first[along + 1 :]], along)
        self._is_checked = True

    def run(
        self,
        *,
        executor: str | Executor = "threads",
        workers: int | None = None,
        store: str | os.PathLike[str] | None = None,
        again: bool = False,
        progress: bool = False,
    ) -> xarray.Dataset:
        """Solve the cases, and return the dataset. Keys and values are checked before (see `check`).

        `executor`: 'threads' of this process, 'processes', 'mpi' (mpi4py.futures), 'dask' (a cluster on this machine, or
        'dask:ADDRESS'), or any concurrent.futures.Executor. `workers`: how many; by default the number of processors.
        `store`: an SQLite file for solved cases; cases in it are not solved again.
        `again`: empty the store first. `progress`: show a progress bar (tqdm).
        An invalid case, or one that ends early, is in the dataset with its outcome and message.
        Raises InputError, FileError, and what an executor raises; KeyboardInterrupt within an increment with threads.
        """
        from .dataset import dataset_of  # here, since it imports xarray

        executors.check(executor, workers)
        self.check()
        if self.results is not None:
            self.results.mkdir(parents=True, exist_ok=True)

        with contextlib.nullcontext() if store is None else contextlib.closing(Store(store)) as kept:
            if kept is not None and again:
                kept.clear()
            names, jobs, solved = self._cases(kept)
            wanted = {
                name: job
                for name, job in jobs.items()
                if name not in solved or (job.result is not None and not os.path.exists(job.result))
            }
            if wanted:
                there = len(jobs) - len(wanted)
                with progress_bar(total=len(jobs), initial=there, unit="case", disable=None if progress else True) as bar:

                    def keep(name: str, one: Solved) -> None:
                        if kept is not None:
                            kept.write(name, one)
                        solved[name] = one
                        bar.update()

                    executors.solve_all(wanted, executor, workers, keep)
            return dataset_of(self, names, [solved.get(name) for name in names])

    def so_far(self, store: str | os.PathLike[str]) -> xarray.Dataset:
        """The dataset of the cases in a store; the others have the outcome 'not solved'. Raises FileError, OSError."""
        from .dataset import dataset_of  # here, since it imports xarray

        if not os.path.isfile(store):
            raise FileNotFoundError(errno.ENOENT, "no file of solved cases", os.fspath(store))
        with contextlib.closing(Store(store)) as kept:
            names, _, solved = self._cases(kept)
        return dataset_of(self, names, [solved.get(name) for name in names])

    def _cases(self, store: Store | None) -> tuple[list[str], dict[str, Job], dict[str, Solved]]:
        """The hashes of the cases in order, their jobs, and their saved results."""
        named = list(self._named_jobs())
        jobs = dict(named)
        return [name for name, _ in named], jobs, {} if store is None else store.read(jobs.keys())

    def _named_jobs(self) -> Iterator[tuple[str, Job]]:
        """The jobs of all cases by hash; equal cases share one."""
        digests = [digest_of_base(base, list(shared.items())) for base, shared in zip(self.bases, self._shared)]
        for number in range(1, len(self) + 1):
            job = self.job(number)
            if self.makes_scenes is not None:
                of_base = digest_of_base(job.base, job.settings)
                self._check_made(number, job.base)
            else:
                of_base = digests[self._places(number)[0] if len(self.bases) > 1 else 0]
            key = digest(job, of_base)
            yield (
                key,
                job if self.results is None else replace(job, result=str(self.results.resolve() / result_name(key))),
            )

    def _places(self, number: int) -> tuple[int, ...]:
        """The place of case `number` along each dimension. Raises ValueError."""
        if not 1 <= number <= len(self):
            raise ValueError(f"no case {number}; the cases are numbered from 1 to {len(self)}")
        return tuple(int(place) for place in np.unravel_index(number - 1, self.shape))

    def _number(self, places: Sequence[int]) -> int:
        return int(np.ravel_multi_index(tuple(places), self.shape)) + 1

    def number_of_reference(self, number: int) -> int:
        """The case that case `number` is compared with."""
        assert self.reference is not None
        along, place = self.reference
        places = list(self._places(number))
        places[along] = place
        return self._number(places)

    def _try(self, places: list[int], along: int) -> None:
        number = self._number(places)
        job = self.job(number)
        try:
            check(job.base, job.settings)
        except errors.InputError as error:
            first = sum(len(dimension.coordinates) for dimension in self.dimensions[:along])
            raise fault(f"case {number} ({self.describe(number)}): {error.message}", first, "values") from None

    def _check_made(self, number: int, base: Base) -> None:
        """Raises InputError if a scene has other units than the first."""
        if number == 1:
            self.units = units_of(base)
        elif units_of(base) != self.units:
            raise input_error(f"case {number} ({self.describe(number)}): the units of the scene differ from those of case 1")

    def _check_bases(self) -> None:
        """Raises InputError if bases have equal names, or other units than the first."""
        names = [base.name for base in self.bases]
        twice = next((name for name in names if names.count(name) > 1), None)
        if twice is not None:
            raise input_error(f"two bases have the name {twice}; give them different names (Scene(..., name=...))")
        for base in self.bases[1:]:
            if units_of(base) != units_of(self.bases[0]):
                first = self.bases[0].name
                raise input_error(
                    f"{base.name}: the units (length_unit, force_unit) differ from those of {first}; a study needs one system of units"
                )

    def _check_names(self) -> None:
        """Raises InputError for reserved and repeated names."""
        seen: set[str] = set()
        taken = {*TAKEN, *observables(), *(path.replace("/", "_") for path in self.wanted_fields)}
        for place, coordinate in enumerate(self.coordinates):
            name = coordinate.name
            is_ours = name in ("base", "row") and not coordinate.keys
            if not is_ours and (name in taken or "_error" in name or name == "dissipation_ratio"):
                raise fault(f"{name} is a column of every study; choose another name", place, "name")
            if name in seen:
                raise fault(f"{name} is the name of another axis; choose another name", place, "name")
            seen.add(name)
        for dimension in self.dimensions:
            is_alone = [dimension.name] == [coordinate.name for coordinate in dimension.coordinates]
            if not is_alone and dimension.name != "row" and dimension.name in taken | seen:
                raise input_error(f"{dimension.name}: this name is already in use; give the zipped axes another name")
        unknown = [name for name in self.observables or () if name not in observables()]
        if unknown:
            raise input_error(f"unknown observable {unknown[0]!r}; choose from {', '.join(observables())}")

    def _check_keys(self) -> None:
        """Raises InputError for keys that are unknown, have no group in a base, or are already varied."""
        counts = [counts_of_groups(base) for base in self.bases]
        seen: list[str] = []
        for place, coordinate in enumerate(self.coordinates):
            for key in coordinate.keys:
                why = fault_of_key(key) or self._missing_group(key, counts)
                for other in seen:
                    why = why or fault_of_pair(other, key)
                if why:
                    raise fault(why, place, "key")
                seen.append(key)

    def _missing_group(self, key: str, counts: Sequence[dict[str, int]]) -> str:
        """The error in the number of a key; empty if it is valid."""
        group, number = numbered_group(key)
        for base, count in zip(self.bases, counts):
            there = count.get(group, 0)
            if number is not None and not 1 <= number <= there:
                return f"'{key}': no &{group} {number} in {base.name}, which has {there}"
        return ""

    def set_reference(self, reference: str | Mapping[str, Any]) -> None:
        """The reference of the cases: see `Study`. Raises InputError."""
        wanted = {"scene%coupling": reference} if isinstance(reference, str) else reference
        if not isinstance(wanted, Mapping) or len(wanted) != 1:
            raise input_error("reference: must be one axis with one of its values, such as {'scene%coupling': 'full'}")
        ((name, value),) = wanted.items()
        for along, dimension in enumerate(self.dimensions):
            (first, *others) = dimension.coordinates
            if not others and (first.name == name or first.keys == (name.lower(),)) and value in first.values:
                self.reference = along, first.values.index(value)
                return
        raise input_error(
            f"reference={as_written(value)}: no axis varies '{name}' alone and has {as_written(value)} among its values; add one"
        )


def _names(names: str | Iterable[str]) -> list[str]:
    """One name or several as a list."""
    return [names] if isinstance(names, str) else list(names)


def result_name(key: str) -> str:
    """Name of the result file of a case, unique and independent of its number."""
    return f"{key[:16]}.h5"


def is_table(path: Path) -> bool:
    """Whether a file is the table of a study, as NetCDF."""
    if not path.is_file() or not h5py.is_hdf5(path):
        return False
    with h5py.File(path) as file:
        return bool(file.attrs.get("title", "") == TITLE)


def _tried(length: int) -> Iterable[int]:
    """Places along a dimension that are checked."""
    if length <= 5 * TRIED:
        return range(length)
    return sorted({round(place) for place in np.linspace(0, length - 1, TRIED + 2)})
