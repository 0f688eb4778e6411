"""One case of a study, from its values to its saved results. Executors run it, in this process or in another."""

from __future__ import annotations

import contextlib
import ctypes
import dataclasses
import functools
import hashlib
import math
import os
import time
from collections.abc import Iterator, Sequence
from ctypes import byref, c_double, c_int, c_void_p
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import _datum, errors
from .._library import OBSERVER, library, library_version, text_buffer, text_for, text_of
from .._packages import require
from ..case import Case, writing
from ..result import Field
from ..scene import _scene_handle, _set_data, _set_key, _text_of_scene, created

#: Stands for the materials of both bodies; see mfv_scene_set_real in the header.
DUNDURS_BETA = "dundurs_beta"

#: Whole numbers that are saved for each case, and their meanings.
COUNTS = {
    "steps_done": "completed steps of the load history",
    "events": "loads at which nodes changed their status",
    "linear_solves": "linear solves",
}

#: Points of the load history at which cases are compared, and the tractions.
MOMENTS, TRACTIONS = ("loading", "reversal", "return"), ("pressure", "shear")

#: Fields that a comparison needs, those of the mesh first.
OF_MESHES = ("mesh/x", "mesh/width", "mesh/interval")
COMPARED = (*OF_MESHES, *(f"moments/{moment}/{traction}" for moment in MOMENTS for traction in TRACTIONS))

#: Keys that name files, with their groups.
FILE_KEYS = ("body(1)%file", "body(2)%file", "friction%mu_file")

#: What precedes the names of quantities in a warning about the mesh.
NOT_RESOLVED = "not resolved:"

_NAN = float("nan")


@dataclass(frozen=True)
class Base:
    """A base case: a namelist text, its name in messages, arrays in place of files, the paths of files."""

    text: str
    name: str
    data: tuple[tuple[str, str, Any], ...] = ()
    folder: str = ""


@dataclass(frozen=True)
class Job:
    """A case to be solved: its base, keys with their values, and the requested fields."""

    base: Base
    settings: tuple[tuple[str, Any], ...]
    fields: tuple[str, ...] = ()
    compared: bool = False
    result: str | None = None


@dataclass
class Solved:
    """The saved results of a case: status, message, counts, numbers, and arrays by the path of their field.

    `about`: the dimension of each field (as of mfv.result.Field), its unit and description.
    """

    status: int
    message: str
    counts: dict[str, int] = field(default_factory=lambda: dict.fromkeys((*COUNTS, "nodes"), 0))
    largest_residual: float = _NAN
    observables: list[float] = field(default_factory=list)
    arrays: dict[str, NDArray[Any]] = field(default_factory=dict)
    about: dict[str, tuple[str, str, str]] = field(default_factory=dict)
    #: Warnings, one per line; names of the observables that they call not resolved, separated by blanks.
    warnings: str = ""
    unresolved: str = ""
    #: 'yes' with error bars, 'none: ' and the reason without, empty if not requested; bars of the observables, NaN if
    #: not resolved, None for an observable without.
    error_estimate: str = ""
    bars: list[float | None] = field(default_factory=list)


@functools.cache
def observables() -> dict[str, tuple[str, str]]:
    """Unit, in terms of length and force, and description of every observable, by name."""
    found: dict[str, tuple[str, str]] = {}
    name, unit, description = text_buffer(), text_buffer(), text_buffer()
    arguments = (name, len(name), unit, len(unit), description, len(description))
    while library().mfv_observable_info(len(found), *arguments) == 0:
        found[text_of(name)] = text_of(unit), text_of(description)
    return found


def key_info(key: str) -> tuple[bool, str, str] | None:
    """Whether a key takes whole numbers, its unit and description; None for an unknown key."""
    is_integer, unit, description = c_int(), text_buffer(), text_buffer()
    status = library().mfv_key_info(text_for(key), byref(is_integer), unit, len(unit), description, len(description))
    return (bool(is_integer.value), text_of(unit), text_of(description)) if status == 0 else None


@contextlib.contextmanager
def scene_handle(base: Base, settings: Sequence[tuple[str, Any]]) -> Iterator[c_void_p]:
    """A scene of the library from a base with keys set, freed afterwards; `mfv_create` reports errors in them. Raises InputError."""
    with _scene_handle(base.text, base.name) as handle:
        for file, dataset, values in base.data:
            _set_data(handle, file, dataset, values)
        # Dundurs' parameter is last, since it needs a complete scene.
        for key, value in sorted(settings, key=lambda setting: setting[0] == DUNDURS_BETA):
            if key != DUNDURS_BETA:
                library().mfv_scene_make_room(handle, text_for(key))
            _set_key(handle, key, value)
        yield handle


def base_text(base: Base) -> str:
    """The text of a base in the format of the library, without comments. Raises InputError."""
    with _scene_handle(base.text, base.name) as handle:
        return _text_of_scene(handle)


def case_text(base: Base, settings: Sequence[tuple[str, Any]]) -> str:
    """The case as a namelist text. Raises InputError."""
    with scene_handle(base, settings) as handle:
        return _text_of_scene(handle)


def check(base: Base, settings: Sequence[tuple[str, Any]]) -> None:
    """Raises InputError for an invalid case."""
    with scene_handle(base, settings) as handle, reading(base, settings):
        library().mfv_free(byref(created("mfv_create", handle)))


def datums_of_case(base: Base, settings: Sequence[tuple[str, Any]]) -> dict[str, float]:
    """The datums of a case, by key, that are defaults and depend on its loads or its mesh; none of an invalid case."""
    texts = [base.text, *(value for _, value in settings if isinstance(value, str))]
    if not any(shape in text.lower() for shape in _datum.SHAPES for text in texts):
        return {}
    try:
        with scene_handle(base, settings) as scene, reading(base, settings):
            handle = created("mfv_create", scene)
    except errors.InputError:
        return {}
    with Case._of_handle(handle) as case:
        return _datum.datums_of_case(case)


def digest(job: Job, base_digest: str) -> str:
    """A hash of everything that determines the results of a case: the base, the values, the contents of files, the version."""
    columns = tuple(one.name for one in dataclasses.fields(Solved))
    kept = (library_version(), columns, tuple(observables()), base_digest, _contents(job.settings), job.fields, job.compared)
    return hashlib.sha256(repr(kept).encode()).hexdigest()


def digest_of_base(base: Base, settings: Sequence[tuple[str, Any]]) -> str:
    """A hash of a base with its arrays and the settings that all its cases share. Raises InputError."""
    told = hashlib.sha256(base_text(base).encode())
    for file, dataset, values in base.data:
        told.update(repr((file, dataset, np.shape(values))).encode() + np.ascontiguousarray(values, dtype=float).tobytes())
    told.update(repr(_contents(settings)).encode())
    return told.hexdigest()


def _contents(settings: Sequence[tuple[str, Any]]) -> list[tuple[str, Any]]:
    """Keys with their values, and with the contents of the files that these name."""
    return [(key, _content(value) if key in FILE_KEYS and isinstance(value, str) else value) for key, value in settings]


@functools.lru_cache(maxsize=1024)
def _content_as_of(path: str, changed: int, size: int) -> str:
    return hashlib.sha256(Path(path).read_bytes()).hexdigest()


def _content(path: str) -> str:
    """The contents of a file; its name if it does not exist."""
    try:
        status = os.stat(path)
        return _content_as_of(path, status.st_mtime_ns, status.st_size)
    except OSError:
        return path


def solve(jobs: Sequence[Job]) -> tuple[float, list[Solved | None]]:
    """Solve cases in a worker process, as `solve_here` does."""
    _one_blas_thread_for_good()
    observables()  # load the library before the time is measured
    return solve_here(None, jobs)


def solve_here(stop: c_int | None, jobs: Sequence[Job]) -> tuple[float, list[Solved | None]]:
    """Solve cases in this process; the seconds that it took, and None for cases for which `stop` was set before they were done.

    Raises FileError where the result of a case cannot be written.
    """
    began = time.perf_counter()
    solved = [solve_unless(stop, job) for job in jobs]
    return time.perf_counter() - began, solved


def solve_unless(stop: c_int | None, job: Job) -> Solved | None:
    """Solve a case; None if `stop` has been set meanwhile. Raises FileError if its result cannot be written."""
    try:
        with scene_handle(job.base, job.settings) as scene, reading(job.base, job.settings):
            handle = created("mfv_create", scene)
    except errors.InputError as error:
        assert error.status is not None
        return Solved(error.status, error.message, observables=[_NAN] * len(observables()))
    with Case._of_handle(handle) as case:
        if stop is not None:
            library().mfv_observe(handle, ctypes.cast(library().mfv_stop_when_set, OBSERVER), byref(stop))
        status = library().mfv_run(handle)
        if stop is not None and stop.value != 0:
            return None
        if job.result is not None:
            case.write(job.result)
        return _kept(case, status, job)


def reading(base: Base, settings: Sequence[tuple[str, Any]]) -> contextlib.AbstractContextManager[Any]:
    """The lock while a case is created: HDF5, which reads matrix files, is not thread-safe."""
    has_matrix = "matrix" in base.text.lower() or any(str(value).lower() == "matrix" for _, value in settings)
    return writing if has_matrix else contextlib.nullcontext()


def _kept(case: Case, status: int, job: Job) -> Solved:
    """The saved results of a case after its run."""
    # The library caches the last group, so fields of one group are read together.
    counts = {name: int(case[f"summary/{name}"]) for name in COUNTS}
    solved = Solved(status, case._library_message(), counts, _real(case, b"summary/largest_residual"))
    solved.observables = [_real(case, path) for path in _observable_paths()]
    counts["nodes"] = case._count("mesh/x")
    solved.warnings = case._attribute("warnings")
    names = case._attribute("unresolved").split()
    there = [name for name, value in zip(observables(), solved.observables) if not math.isnan(value)]
    solved.unresolved = " ".join(name for name in there if name in names)
    solved.error_estimate = _attribute(case, "error_estimate")
    if solved.error_estimate:
        solved.bars = [_real(case, path, None) for path in _bar_paths()]
    for path in COMPARED if job.compared else ():
        found = _field(case, path)
        if found is not None:
            solved.arrays[path] = np.atleast_1d(found.values)
    for path in job.fields:
        found = _field(case, path)
        if found is not None:
            solved.arrays[path] = np.atleast_1d(found.values).astype(float)
            solved.about[path] = "".join(found.dimensions), found.unit, found.description
    return solved


@functools.cache
def _observable_paths() -> list[bytes]:
    return [text_for(f"observables/{name}") for name in observables()]


@functools.cache
def _bar_paths() -> list[bytes]:
    return [text_for(f"error_estimate/{name}_error") for name in observables()]


def _attribute(case: Case, name: str) -> str:
    """An attribute; empty if the case does not have it."""
    try:
        return case._attribute(name)
    except errors.BadArgument:
        return ""


def _real(case: Case, path: bytes, otherwise: Any = _NAN) -> Any:
    """A number; `otherwise` if the case does not have it."""
    value = c_double(_NAN)
    return value.value if library().mfv_copy_real(case._handle, path, byref(value), 1) == 0 else otherwise


def _field(case: Case, path: str) -> Field | None:
    """A field, if the case has it."""
    try:
        return case._field(path)
    except errors.BadArgument:
        return None


def one_blas_thread() -> Any:
    """Limit BLAS to one thread in this process, until the context that this returns ends: the study uses the processors, and its
    results are bit-identical."""
    require("threadpoolctl")
    import threadpoolctl

    library()  # threadpoolctl only sees loaded libraries
    return threadpoolctl.threadpool_limits(1, user_api="blas")


_one_blas_thread_for_good = functools.cache(one_blas_thread)
