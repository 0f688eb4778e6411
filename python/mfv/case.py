"""Running cases in this process through the C interface."""

from __future__ import annotations

import ctypes
import os
import threading
import weakref
from ctypes import POINTER, byref, c_double, c_int, c_int32, c_size_t, c_void_p, create_string_buffer
from types import TracebackType

import numpy as np

from . import errors
from ._library import Control, Step, library, outcome_of, text_buffer, text_for, text_of
from .result import Field, Result, Values

#: HDF5, which writes the result files, is in general not safe to call from two threads at once.
_writing = threading.Lock()


def run(
    path: str | os.PathLike[str] | None = None,
    *,
    text: str | None = None,
    output: str | os.PathLike[str] | None = None,
    check: bool = False,
) -> Result:
    """Solve a case and return its result.

    The case is the namelist file at `path` or the namelist `text`. `output`: where to write the result file; without it
    none is written, whatever the &output group of the case says. A run that ends early is a result, with its `outcome`
    and `message` and the state up to there; `check=True` raises the exception of the outcome instead, after writing.
    Raises InputError for a case that cannot be used, FileError when the result could not be written.
    """
    if path is not None and text is None:
        case = Case.from_file(path)
    elif text is not None and path is None:
        case = Case.from_text(text)
    else:
        raise TypeError("mfv.run takes the path of a case or text=, one of them")
    with case:
        case.run()
        if output is not None:
            case.write(output)
        case._raise_early_end(check)
        return case.result()


class Case:
    """A case with its state, to be run or led step by step. Use it in a `with` statement or `close` it."""

    def __init__(self, handle: c_void_p) -> None:
        """Not to be called: see `from_file` and `from_text`."""
        self._handle = handle
        self._lock = threading.RLock()
        self._free = weakref.finalize(self, library().mfv_free, byref(handle))
        self._status = 0
        self._message = self._library_message()

    @classmethod
    def from_file(cls, path: str | os.PathLike[str]) -> Case:
        """The case in a namelist file. Raises InputError."""
        return cls(_created("mfv_create_from_file", text_for(path)))

    @classmethod
    def from_text(cls, text: str, name: str = "text") -> Case:
        """The case in a namelist text. `name`: what messages call it; files it names are looked for beside that.

        Raises InputError.
        """
        return cls(_created("mfv_create_from_text", text_for(text), text_for(name)))

    def __enter__(self) -> Case:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<mfv.Case {self.outcome}: {self.message}>" if self._handle else "<mfv.Case closed>"

    def close(self) -> None:
        """Free the case; using it afterwards raises BadHandle. Closing twice does no harm."""
        with self._lock:
            self._free()

    @property
    def outcome(self) -> str:
        """How the run has gone so far, in words: 'complete' while nothing has gone wrong."""
        return outcome_of(self._status)

    @property
    def message(self) -> str:
        """What was reached, or why not."""
        return self._message

    def run(self, *, check: bool = False) -> str:
        """Run the steps of the case that have not been run; return the outcome.

        `check`: raise the exception of an outcome that is not 'complete'.
        """
        return self._lead(check, "mfv_run")

    def advance(
        self,
        *,
        normal_force: float | None = None,
        approach: float | None = None,
        tangential_force: float | None = None,
        shift: float | None = None,
        moment: float | None = None,
        rotation: float | None = None,
        friction: bool = True,
        cycles: int = 0,
        steady_tolerance: float = 0.0,
        check: bool = False,
    ) -> str:
        """Lead the loads through one more step, whatever the steps of the case are; return the outcome.

        Targets are reached linearly from the loads now; a load without a target keeps what it has. Give `normal_force`
        [force/length] or `approach` [length], `tangential_force` or `shift` likewise, `moment` [force] or `rotation`
        [radians]. `friction`: whether it acts during this step. `cycles`: go to the targets and back this many times,
        ending early when two cycles in a row end with the same tractions to within `steady_tolerance` times the
        largest one (0: never). `check`: as for `run`.
        Raises BadArgument.
        """
        normal_control, normal_target = _control("normal_force", normal_force, "approach", approach)
        tangential_control, tangential_target = _control("tangential_force", tangential_force, "shift", shift)
        rotational_control, rotational_target = _control("moment", moment, "rotation", rotation)
        step = Step(
            size=ctypes.sizeof(Step),
            normal_target=normal_target,
            tangential_target=tangential_target,
            normal_control=normal_control,
            tangential_control=tangential_control,
            friction=bool(friction),
            cycles=cycles,
            rotational_target=rotational_target,
            rotational_control=rotational_control,
            steady_tolerance=steady_tolerance,
        )
        return self._lead(check, "mfv_advance", byref(step))

    def fields(self) -> list[str]:
        """Paths of the fields that the case has now, such as 'state/pressure'."""
        count, buffer = c_size_t(), text_buffer()
        with self._lock:
            self._call("mfv_field_count", byref(count))
            paths = []
            for index in range(count.value):
                self._call("mfv_field_path", index, buffer, len(buffer))
                paths.append(text_of(buffer))
        return paths

    def __getitem__(self, path: str) -> Values:
        """Values of the field at a path, copied now. Raises KeyError."""
        try:
            return self._field(path).values
        except errors.BadArgument as error:
            raise KeyError(str(error)) from None

    def result(self) -> Result:
        """Everything there is now, copied; it does not change when the case goes on."""
        groups: dict[str, dict[str, Field]] = {}
        with self._lock:
            for path in self.fields():
                group, name = path.rsplit("/", 1)
                groups.setdefault(group, {})[name] = self._field(path)
            attributes = {name: self._attribute(name) for name in self._attribute_names()}
        return Result(groups, attributes)

    def write(self, path: str | os.PathLike[str] | None = None) -> None:
        """Write the result file to `path`, or where the &output group of the case says. Raises FileError."""
        with _writing:
            self._call("mfv_write", None if path is None else text_for(path))

    def _field(self, path: str) -> Field:
        """The field at a path. Raises BadArgument."""
        count, is_integer, along = c_size_t(), c_int(), c_int()
        unit, description = text_buffer(), text_buffer()
        name = text_for(path)
        with self._lock:
            numbers = byref(count), byref(is_integer), byref(along)
            self._call("mfv_field_info", name, *numbers, unit, len(unit), description, len(description))
            values: Values
            if is_integer:
                values = np.empty(count.value, dtype=np.int32)
                self._call("mfv_copy_integer", name, values.ctypes.data_as(POINTER(c_int32)), count.value)
            else:
                values = np.empty(count.value, dtype=np.float64)
                self._call("mfv_copy_real", name, values.ctypes.data_as(POINTER(c_double)), count.value)
        return Field(values if along else values[0], text_of(unit), text_of(description))

    def _attribute_names(self) -> list[str]:
        """Names of the attributes of the result."""
        names: list[str] = []
        buffer = text_buffer()
        while library().mfv_attribute_name(self._handle, len(names), buffer, len(buffer)) == 0:
            names.append(text_of(buffer))
        return names

    def _attribute(self, name: str) -> str:
        """Text of an attribute, of any length."""
        length = c_size_t()
        self._call("mfv_attribute", text_for(name), None, 0, byref(length))
        buffer = create_string_buffer(length.value + 1)
        self._call("mfv_attribute", text_for(name), buffer, len(buffer), None)
        return text_of(buffer)

    def _lead(self, check: bool, function: str, *arguments: object) -> str:
        """Call what leads the loads; return the outcome. Raises for a bad call, and with `check` for an early end."""
        with self._lock:
            status = getattr(library(), function)(self._handle, *arguments)
            message = self._library_message()
            if status != 0 and errors.failures()[status] in (errors.BadHandle, errors.BadArgument):
                raise errors.failure(status, message)
            self._status, self._message = status, message
            self._raise_early_end(check)
            return self.outcome

    def _raise_early_end(self, check: bool) -> None:
        if check and self._status != 0:
            raise errors.failure(self._status, self._message)

    def _call(self, function: str, *arguments: object) -> None:
        """Call a function of the library on this case. Raises the exception of its status."""
        with self._lock:
            status = getattr(library(), function)(self._handle, *arguments)
            if status != 0:
                raise errors.failure(status, self._library_message())

    def _library_message(self) -> str:
        """The message of the last call; empty for a closed case."""
        buffer = text_buffer()
        with self._lock:
            library().mfv_message(self._handle, buffer, len(buffer))
        return text_of(buffer)


def _created(function: str, *arguments: bytes) -> c_void_p:
    """A handle from one of the functions that create it."""
    handle, message = c_void_p(), text_buffer()
    status = getattr(library(), function)(*arguments, byref(handle), message, len(message))
    if status != 0:
        raise errors.failure(status, text_of(message))
    return handle


def _control(
    force_name: str, force: float | None, displacement_name: str, displacement: float | None
) -> tuple[Control, float]:
    """What a step does with a load, and its target."""
    if force is not None and displacement is not None:
        raise TypeError(f"give {force_name} or {displacement_name}, not both")
    if force is not None:
        return Control.FORCE, force
    if displacement is not None:
        return Control.DISPLACEMENT, displacement
    return Control.KEEP, 0.0
