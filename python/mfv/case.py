"""Cases in this process through the C interface: run, advance step by step, try and undo."""

from __future__ import annotations

import copy
import ctypes
import os
import struct
import threading
import weakref
from collections.abc import Iterator
from contextlib import contextmanager
from ctypes import POINTER, byref, c_int, c_int32, c_size_t, c_void_p
from operator import index
from types import TracebackType
from typing import TYPE_CHECKING, Any, Callable, NoReturn

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _html, errors, inputs
from ._library import (
    ALONG,
    CONTROLS,
    LARGEST_INTEGER,
    LoadsStructure,
    StepStructure,
    library,
    outcome_of,
    real_pointer,
    text_buffer,
    text_for,
    text_of,
    whole_text,
)
from ._observer import Observer
from .loads import MOTIONS, Derivative, Loads, Progress, Targets
from .result import Field, Result, Values
from .scene import Output, Scene, created

if TYPE_CHECKING:
    from typing_extensions import Self, Unpack

#: HDF5, which writes the result files, is in general not safe to call from two threads at once.
writing = threading.Lock()

#: Number of nodes from which, and friction laws for which, a single step may take so long that Ctrl-C must be able to stop it.
#: It then has an observer, which costs about 1 microsecond per increment.
MANY_NODES, LONG_LAWS = 400, ("weakening", "dahl")

#: Dimensions of fields by the library's code for them.
_DIMENSIONS = tuple(ALONG.values())

_KEEP, _FORCE, _DISPLACEMENT = range(len(CONTROLS))
_SIZE_OF_STEP = ctypes.sizeof(StepStructure)

#: A step without targets.
_NO_CONTROL: list[int] = [_KEEP] * len(MOTIONS)
_NO_TARGET: list[Any] = [0.0] * len(MOTIONS)

#: Motion and control by the name of a target.
_CONTROLLED = {
    **{motion.force: (number, _FORCE) for number, motion in enumerate(MOTIONS) if not motion.is_known},
    **{motion.displacement: (number, _DISPLACEMENT) for number, motion in enumerate(MOTIONS)},
}


def run(
    case: Scene | str | os.PathLike[str] | None = None,
    *,
    text: str | None = None,
    output: str | os.PathLike[str] | None = None,
    check: bool = False,
    progress: bool = False,
) -> Result:
    """Solve a case and return its result.

    `case`: a Scene or the path of a namelist file; or the namelist `text`. `output`: the result file to write; if omitted, none
    is written, also if &output names one. A run that ends early has a result with its `outcome`, `message` and last state;
    `check=True` raises the exception of the outcome instead, after writing. `progress`: show a progress bar (tqdm).
    Raises InputError for an invalid case, FileError if the result cannot be written (before solving if the directory is missing).
    """
    if output is not None:
        _check_directory(output)
    if (case is None) == (text is None):
        raise TypeError("mfv.run takes either a scene, or the path of a case, or text=")
    if text is not None:
        made = Case.from_text(text)
    elif isinstance(case, Scene):
        made = Case(case)
    else:
        assert case is not None
        made = Case.from_file(case)
    with made:
        if isinstance(case, Scene) and not case.steps and case.history is None:
            raise errors.input_error(f"{case.name}: at least one step is needed, such as steps=[Step(normal_force=500)]")
        made.run(progress=progress)
        if output is not None:
            made.write(output)
        made._raise_early_end(check)
        return made.result()


def _check_directory(output: str | os.PathLike[str]) -> None:
    """Raises FileError if the directory of a result does not exist."""
    directory = os.path.dirname(os.path.abspath(output))
    if not os.path.isdir(directory):
        raise errors.file_error(f"{os.fspath(output)}: cannot be written: {directory} does not exist or is not a directory")


class State:
    """A state saved with `Case.save`. It may outlive its case."""

    def __init__(self) -> None:
        """Do not call this; use `Case.save`."""
        self._handle = c_void_p()
        self._status = 0
        self._parameters: tuple[str, ...] = ()
        _freed_with(self, library().mfv_state_free, self._handle)

    def __reduce__(self) -> NoReturn:
        raise TypeError("a State belongs to this process and cannot be pickled or copied")


class Trial:
    """A trial of `Case.trial`: the case is restored at the end of the `with` statement unless the trial is accepted."""

    def __init__(self) -> None:
        self.accepted = False

    def accept(self) -> None:
        """Keep the new state, however the `with` statement ends."""
        self.accepted = True


class Case:
    """A case with its state, to run or to advance step by step. Use it in a `with` statement or `close` it.

    One thread at a time can use a case; others wait. Different cases can run in different threads concurrently.
    """

    def __init__(self, scene: Scene) -> None:
        """A case of a scene, which may be changed or deleted afterwards. Raises InputError."""
        with scene._handle() as built:
            self._adopt(created("mfv_create", built))
        #: The scene, if it has arrays, which the text of the result does not contain.
        self._scene: Scene | None = copy.deepcopy(scene) if scene.has_arrays else None

    @classmethod
    def from_file(cls, path: str | os.PathLike[str]) -> Case:
        """The case in a namelist file. Raises InputError."""
        return cls._of_handle(created("mfv_create_from_file", text_for(path)))

    @classmethod
    def from_text(cls, text: str, name: str = "text") -> Case:
        """The case in a namelist text. `name`: its name in messages; paths of files are relative to its directory.

        Raises InputError.
        """
        return cls._of_handle(created("mfv_create_from_text", text_for(text), text_for(name)))

    @classmethod
    def _of_handle(cls, handle: c_void_p) -> Case:
        case = cls.__new__(cls)
        case._adopt(handle)
        case._scene = None
        return case

    def _adopt(self, handle: c_void_p) -> None:
        """Own a handle, and prepare what every call needs."""
        self._handle = handle
        self._lock = threading.RLock()
        self._free = _freed_with(self, library().mfv_free, handle)
        self._status = 0
        self._observer = Observer(handle)
        self._advance = library().mfv_advance
        self._get_loads = library().mfv_get_loads
        self._complete = outcome_of(0)
        self._step = StepStructure()
        self._step_reference = byref(self._step)
        self._loads = LoadsStructure(size=ctypes.sizeof(LoadsStructure))
        self._loads_reference = byref(self._loads)
        self._spare_states: list[State] = []
        self._parameters: tuple[str, ...] = ()  # of the last differentiate; and those of the present state
        self._parameters_of_state: tuple[str, ...] = ()
        self._x = np.empty(0)
        self._is_long = self._count("mesh/x") >= MANY_NODES or self._attribute("friction_law") in LONG_LAWS

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<mfv.Case {self.outcome}: {self.message}>" if self._handle else "<mfv.Case closed>"

    def _repr_html_(self) -> str:
        if not self._handle:
            return _html.table([("case", "closed")])
        rows = [("outcome", f"{self.outcome}: {self.message}")]
        rows += [(name.replace("_", " "), f"{value:.6g}") for name, value in self.loads._asdict().items()]
        return _html.table(rows)

    def __copy__(self) -> Case:
        return self.copy()

    def __deepcopy__(self, memo: dict[int, Any]) -> Case:
        return self.copy()

    def __reduce__(self) -> NoReturn:
        raise TypeError("a Case belongs to this process and cannot be pickled; pickle its scene or its result")

    def copy(self) -> Case:
        """An independent case with the same scene, state and history, without the observer."""
        handle = c_void_p()
        with self._lock:
            self._call("mfv_copy", byref(handle))
            copied = Case._of_handle(handle)
            copied._scene, copied._status = self._scene, self._status
            copied._parameters, copied._parameters_of_state = self._parameters, self._parameters_of_state
        return copied

    def close(self) -> None:
        """Free the case; using it afterwards raises BadHandle. Closing twice is harmless."""
        with self._lock:
            self._observer.refuse_while_leading()
            self._free()

    @property
    def outcome(self) -> str:
        """Outcome so far: 'complete' unless the run has ended early. Also available after `close`."""
        return outcome_of(self._status)

    @property
    def message(self) -> str:
        """What was reached, or why the run ended early."""
        return self._attribute("message")

    def run(self, *, check: bool = False, progress: bool = False) -> str:
        """Run the remaining steps of the case; return the outcome.

        `check`: raise the exception of an outcome other than 'complete'. `progress`: show a progress bar (tqdm).
        KeyboardInterrupt and exceptions of an observer end the run with the outcome 'interrupted' and are raised again.
        """
        with self._lock, self._observer.bar(progress):
            return self._lead(check, True, library().mfv_run, self._handle)

    def advance(
        self,
        *,
        relative: bool = False,
        friction: bool | None = None,
        cycles: int = 0,
        steady_tolerance: float = 0.0,
        check: bool = False,
        **targets: Unpack[Targets],
    ) -> str:
        """Apply one more load step, independent of the steps of the case; return the outcome.

        Loads change linearly from their present values to the targets; a load without a target is constant. Prescribe
        `normal_force` [force/length] or `approach` [length], `tangential_force` or `shift` likewise, `moment` [force] or
        `rotation` [radians], `lower_bulk_stress` and `upper_bulk_stress` [force/length^2], `interference` [length].
        `relative`: targets are increments of the present loads. `friction`: whether friction acts during this step (None: it does, as for a Step). `cycles`:
        number of cycles to the targets and back; they end early when the tractions of two consecutive cycles differ by at most
        `steady_tolerance` times the largest one (0: never). `check`: as for `run`.
        Raises BadArgument.
        """
        control, target = _NO_CONTROL.copy(), _NO_TARGET.copy()
        for name, value in targets.items():
            try:
                motion, kind = _CONTROLLED[name]
            except KeyError:
                raise TypeError(f"advance() got an unexpected keyword argument {name!r}") from None
            if value is None:
                continue
            if control[motion] != _KEEP:
                raise TypeError(f"give {MOTIONS[motion].force} or {MOTIONS[motion].displacement}, not both")
            control[motion], target[motion] = kind, value
        turns = max(-LARGEST_INTEGER, min(index(cycles), LARGEST_INTEGER)) if cycles else 0
        with self._lock:
            try:  # one call in place of eleven: the largest cost of Python in a host program
                StepStructure.pack(
                    self._step,
                    0,
                    _SIZE_OF_STEP,
                    *target,
                    steady_tolerance,
                    *control,
                    1 if friction or friction is None else 0,
                    turns,
                    1 if relative else 0,
                    0,
                    0,
                )
            except struct.error:
                numbers = {
                    **{name: value for name, value in targets.items() if value is not None},
                    "steady_tolerance": steady_tolerance,
                }
                raise TypeError(f"targets and steady_tolerance must be numbers, not {_not_numbers(numbers)}") from None
            if turns > 0 or self._is_long or not self._observer.is_idle:
                watched = turns > 0 or self._is_long
                return self._lead(check, watched, self._advance, self._handle, self._step_reference)
            status = self._advance(self._handle, self._step_reference)
            if status == 0:
                self._status = 0
                return self._complete
            return self._ended(check, status)

    @property
    def loads(self) -> Loads:
        """Present loads and motions, without the cost of a field. Raises BadHandle."""
        with self._lock:
            if self._observer.is_leading:
                self._observer.refuse_while_leading()
            status = self._get_loads(self._handle, self._loads_reference)
            if status != 0:
                self._check(status)
            return Loads._make(LoadsStructure.unpack(self._loads)[1:-1])  # without the size and the unused members

    def tangent(self, direction: ArrayLike | None = None, *, motions: int = 2) -> NDArray[np.float64]:
        """Consistent tangent at the present state: an array (motions, motions), derivatives of normal force, tangential force
        (and moment) with respect to approach, shift (and rotation).

        The tangent of contact and friction depends on the direction of motion: `direction` has a number for every motion, such
        as (0, 1) for a shift to the right; if omitted, the direction of the last step is used, and nodes that were pressed without
        friction stick if the scene has friction. `motions`: 2, 3 with the rotation, or 6 with bulk stresses and interference.
        Raises BadArgument if the contact does not determine it.
        """
        towards = None
        if direction is not None:
            values = np.ascontiguousarray(direction, dtype=np.float64)
            if values.shape != (motions,):
                raise ValueError(f"direction must have {motions} numbers, not the shape {values.shape}")
            towards = real_pointer(values)
        tangent = np.empty((motions, motions))
        self._call("mfv_tangent", motions, towards, real_pointer(tangent))
        return tangent

    def differentiate(self, *parameters: str) -> None:
        """Derive all further states with respect to parameters, in place of those of an earlier call (none: stop).

        Real keys of &body and &friction, such as 'body(2)%radius' or 'friction%mu', before the first step; and targets of steps
        to come, such as 'step(2)%shift', or 'shift' for that of the next step. The state so far is taken to be independent of
        them. The derivatives are propagated through all events, at one linear solve for each event and parameter. The mesh and
        all other targets, also relative ones, are held. Raises BadArgument for an unknown or passed parameter, with large
        increments (accuracy), the conventional algorithm, wear, and friction laws other than Coulomb's.
        """
        with self._lock:
            self._call("mfv_differentiate", text_for(" ".join(parameters)))
            self._parameters = self._parameters_of_state = parameters

    @property
    def derivatives(self) -> dict[str, Derivative]:
        """Derivatives of the present state with respect to the parameters of `differentiate`, by their names there.

        Raises BadArgument if there are none, as after a step that ended early, or after `restore` of a state that was saved with
        other parameters; name targets again then, keys only before the first step.
        """
        found: dict[str, Derivative] = {}
        with self._lock:
            for number, name in enumerate(self._parameters):
                loads = LoadsStructure(size=ctypes.sizeof(LoadsStructure))
                pressure, shear = np.empty((2, self._count("mesh/x")))
                try:
                    self._call("mfv_derivative", number, byref(loads), pressure.size, real_pointer(pressure), real_pointer(shear))
                except errors.BadArgument as error:
                    if self._parameters_of_state is self._parameters:
                        raise
                    why = "the restored state was saved with other parameters than those of the last differentiate"
                    raise errors.BadArgument(error.status, f"{error} ({why})") from None
                found[name] = Derivative(Loads._make(LoadsStructure.unpack(loads)[1:-1]), pressure, shear)
        return found

    def save(self, state: State | None = None) -> State:
        """Save the present state for `restore`. `state`: overwrite this one, which avoids an allocation. Raises TypeError."""
        kept = State() if state is None else _checked_state(state)
        with self._lock:
            self._call("mfv_save", byref(kept._handle))
            kept._status, kept._parameters = self._status, self._parameters_of_state
        return kept

    def restore(self, state: State) -> None:
        """Restore a state of this case or of a copy; results afterwards are bit-identical.

        With history='none' and states='none' in &output any state can be restored in any order; otherwise only states of the
        load history that led to the present one. Derivatives are restored if the state was saved with the parameters of the last
        `differentiate`. Raises TypeError, BadArgument.
        """
        with self._lock:
            self._call("mfv_restore", _checked_state(state)._handle)
            self._status, self._parameters_of_state = state._status, state._parameters

    @contextmanager
    def trial(self) -> Iterator[Trial]:
        """Try steps and undo them: the end of the `with` statement restores the state at its beginning, also after an
        exception, unless the trial was accepted.

            with case.trial() as trial:
                case.advance(shift=1e-4)
                if case.loads.tangential_force < limit:
                    trial.accept()
        """
        trial = Trial()
        before = self.save(self._spare_states.pop() if self._spare_states else None)
        try:
            yield trial
        finally:
            if not trial.accepted:
                self.restore(before)
            self._spare_states.append(before)

    def observe(self, callback: Callable[[Progress], object] | None) -> None:
        """Call `callback` with the Progress after every load increment, in the thread that runs the case; None ends this. The
        callback must not use this case. If it returns a true value, the run ends with the outcome 'interrupted'; likewise if
        it raises an exception, which `run` or `advance` raises again.
        """
        if callback is not None and not callable(callback):
            raise TypeError(f"observe takes a function of the progress, or None, not {callback!r}")
        with self._lock:
            self._call("mfv_field_count", byref(c_size_t()))  # raises BadHandle for a closed case
            self._observer.tell(callback)

    def fields(self) -> list[str]:
        """Paths of the present fields, such as 'state/pressure'."""
        count, buffer = c_size_t(), text_buffer()
        with self._lock:
            self._call("mfv_field_count", byref(count))
            paths = []
            for index in range(count.value):
                self._call("mfv_field_path", index, buffer, len(buffer))
                paths.append(text_of(buffer))
        return paths

    def __contains__(self, path: object) -> bool:
        return path in self.fields()

    def __iter__(self) -> Iterator[str]:
        return iter(self.fields())

    def __getitem__(self, path: str) -> Values:
        """A copy of the values of the field at a path. Raises KeyError."""
        try:
            return self._field(path).values
        except errors.BadArgument as error:
            raise KeyError(str(error)) from None

    def values(self, path: str, out: NDArray[Any]) -> NDArray[Any]:
        """Copy the values of the field at a path into `out`, a contiguous array of float64 or int32 with the field's size,
        and return it, without an allocation. Raises TypeError, ValueError, BadArgument.
        """
        if not isinstance(out, np.ndarray):
            raise TypeError(f"out must be a numpy array, not {type(out).__name__}")
        if not (out.flags.c_contiguous and out.flags.writeable) or out.dtype not in (np.float64, np.int32):
            raise ValueError("out must be a contiguous, writable array of float64 or int32")
        if out.dtype == np.float64:
            self._call("mfv_copy_real", text_for(path), real_pointer(out), out.size)
        else:
            self._call("mfv_copy_integer", text_for(path), out.ctypes.data_as(POINTER(c_int32)), out.size)
        return out

    @property
    def x(self) -> NDArray[np.float64]:
        """Positions of the nodes, read-only; the same array until the mesh grows."""
        with self._lock:
            if self._count("mesh/x") != self._x.size:
                self._x = np.asarray(self["mesh/x"])
                self._x.flags.writeable = False
            return self._x

    def result(self) -> Result:
        """A copy of the present result; it does not change when the case advances."""
        groups: dict[str, dict[str, Field]] = {}
        with self._lock:
            for path in self.fields():
                group, name = path.rsplit("/", 1)
                groups.setdefault(group, {})[name] = self._field(path)
            attributes = {name: self._attribute(name) for name in self._attribute_names()}
        return Result(groups, attributes, self._scene)

    def write(self, path: str | os.PathLike[str] | None = None) -> None:
        """Write the result file to `path`; by default to the file of &output. Raises FileError."""
        with writing:
            self._call("mfv_write", None if path is None else text_for(path))

    def _field(self, path: str) -> Field:
        """The field at a path. Raises BadArgument."""
        count, is_integer, along = c_size_t(), c_int(), c_int()
        unit, description = text_buffer(), text_buffer()
        name = text_for(path)
        with self._lock:
            about = byref(count), byref(is_integer), byref(along)
            self._call("mfv_field_info", name, *about, unit, len(unit), description, len(description))
            values: Values = self.values(path, np.empty(count.value, np.int32 if is_integer else np.float64))
        dimensions = _DIMENSIONS[along.value]
        return Field(values if dimensions else values[0], text_of(unit), text_of(description), dimensions)

    def _count(self, path: str) -> int:
        """Number of values of the field at a path. Raises BadArgument."""
        count = c_size_t()
        self._call("mfv_field_info", text_for(path), byref(count), None, None, None, 0, None, 0)
        return count.value

    def _attribute_names(self) -> list[str]:
        """Names of the attributes of the result."""
        names: list[str] = []
        buffer = text_buffer()
        while library().mfv_attribute_name(self._handle, len(names), buffer, len(buffer)) == 0:
            names.append(text_of(buffer))
        return names

    def _attribute(self, name: str) -> str:
        """Text of an attribute, of any length."""
        with self._lock:
            return whole_text(self._call, "mfv_attribute", text_for(name))

    def _lead(self, check: bool, watched: bool, function: Callable[..., int], *arguments: object) -> str:
        """Call a function that changes the loads; return the outcome. Raises for a bad call, and with `check` for an early end.

        `watched`: whether it may take long, so that KeyboardInterrupt must be able to end it.
        """
        observer = self._observer
        if observer.is_idle and not watched:
            status = function(*arguments)
        else:
            status = observer.watch(function, *arguments) if watched or observer.is_wanted else observer.rest(function, *arguments)
        return self._ended(check, status)

    def _ended(self, check: bool, status: int) -> str:
        """The outcome of a status. Raises as `_lead` does."""
        if status != 0:
            self._check(status, (errors.BadHandle, errors.BadArgument, errors.InUse))
        self._status = status
        self._observer.raise_what_ended_it()
        self._raise_early_end(check)
        return outcome_of(status)

    def _raise_early_end(self, check: bool) -> None:
        if check and self._status != 0:
            raise errors.failure(self._status, self.message)

    def _call(self, function: str, *arguments: object) -> None:
        """Call a function of the library on this case. Raises the exception of its status."""
        with self._lock:
            self._observer.refuse_while_leading()
            self._check(getattr(library(), function)(self._handle, *arguments))

    def _check(self, status: int, kinds: tuple[type[errors.MfvError], ...] = (errors.MfvError,)) -> None:
        """Raise the exception of a status, if it is of these kinds."""
        if status != 0 and issubclass(errors.failures()[status], kinds):
            raise errors.failure(status, self._library_message())

    def _library_message(self) -> str:
        """The message of the last call; empty for a closed case."""
        buffer = text_buffer()
        library().mfv_message(self._handle, buffer, len(buffer))
        return text_of(buffer)


def case_of(result: Result, *, keeping_states: bool = False) -> Case:
    """The case of a result, before its load history. `keeping_states`: save states even if the result has none, and those of all
    turning points of a load history.

    Raises ValueError if the scene had arrays in memory and the result is from a file, which does not contain them; InputError.
    """
    if result._source is not None:
        scene = copy.deepcopy(result._source)
        if keeping_states and scene.history is not None:
            scene.output = scene.output or Output()
            scene.output.states = "reversals"
        elif keeping_states and scene.output is not None and scene.output.states == "none":
            scene.output.states = "steps"
        return Case(scene)
    text = result.attributes["input"]
    if missing := inputs.arrays_in_memory(text):
        raise ValueError(
            f"arrays of the scene ({', '.join(missing)}) were given in memory and are not in the file; "
            "use the result object of the run for stresses and intermediate states"
        )
    name = os.path.join(result.attributes["working_directory"], result.attributes["input_file"])
    return Case.from_text(inputs.keeping_states(text) if keeping_states else text, name)


def _checked_state(state: object) -> State:
    """Raises TypeError for what is not a State."""
    if not isinstance(state, State):
        raise TypeError(f"state must be a State, which Case.save returns, not {state!r}")
    return state


def _not_numbers(targets: dict[str, Any]) -> str:
    """The targets that are not numbers."""
    return ", ".join(f"{name}={value!r}" for name, value in targets.items() if not _is_number(value))


def _is_number(value: Any) -> bool:
    """Whether a structure of C takes a value as a double."""
    try:
        struct.pack("d", value)
    except struct.error:
        return False
    return True


def _freed_with(owner: object, free: Callable[..., object], handle: c_void_p) -> weakref.finalize[..., Any]:
    """Free a handle when its owner is deleted. At the end of the interpreter nothing is freed, since a thread may still use a
    case."""
    finalizer = weakref.finalize(owner, free, byref(handle))
    finalizer.atexit = False
    return finalizer
