"""The shared library: its path, and the C interface of include/mfv.h for ctypes."""

from __future__ import annotations

import ctypes
import functools
import itertools
import os
import struct
from collections.abc import Callable, Iterator
from ctypes import POINTER, c_char_p, c_double, c_int, c_int32, c_size_t, c_void_p
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .errors import LibraryNotFound
from .loads import MOTIONS

#: Size of the buffer for a text from the library; longer ones are truncated.
TEXT_SIZE = 16384

#: The largest number that a C int holds.
LARGEST_INTEGER = 2**31 - 1

#: The folder above the package: the source tree, or where the package is installed.
_ABOVE = Path(__file__).resolve().parents[2]

HOW_TO_BUILD = (
    f"type\n    cd {_ABOVE} && sh scripts/demo.sh    # builds it; or set MFV_LIBRARY to the path of libmfv.so"
    if (_ABOVE / "scripts/demo.sh").is_file()
    else "type\n    pip install .    # in the source tree, builds it; or set MFV_LIBRARY to the path of libmfv.so"
)


#: Controls of a motion in a step, in the order of their numbers: constant load, prescribed force or prescribed displacement.
CONTROLS = ("KEEP", "FORCE", "DISPLACEMENT")

#: What the values of a field are listed along, in the order of the numbers, and the dimensions in the result file.
ALONG: dict[str, tuple[str, ...]] = {
    "NOTHING": (),
    "NODES": ("x",),
    "RECORDS": ("record",),
    "COMPANIONS": ("companion_nodes",),
    "CYCLES": ("cycle",),
    "PATCHES": ("patch",),
}

#: A number for every motion.
_per_motion = c_double * len(MOTIONS)


class StepStructure(ctypes.Structure):
    """`mfv_step` of the header."""

    _fields_ = [
        ("size", c_size_t),
        ("target", _per_motion),
        ("steady_tolerance", c_double),
        ("control", c_int * len(MOTIONS)),
        *((name, c_int) for name in ("friction", "cycles", "relative")),
        ("unused", c_int * 2),
    ]

    #: Writes all members at once: `pack(step, 0, size, ...)`.
    pack = struct.Struct(f"@N{len(MOTIONS) + 1}d{len(MOTIONS) + 5}i").pack_into


class LoadsStructure(ctypes.Structure):
    """`mfv_loads` of the header."""

    _fields_ = [
        ("size", c_size_t),
        ("force", _per_motion),
        ("motion", _per_motion),
        ("dissipation", c_double),
        *((name, c_int) for name in ("contact_nodes", "stick_nodes", "slip_nodes", "events", "linear_solves")),
        ("unused", c_int),
    ]

    #: Reads all members at once: `unpack(loads)`.
    unpack = struct.Struct(f"@N{2 * len(MOTIONS) + 1}d6i").unpack_from


class ProgressStructure(ctypes.Structure):
    """`mfv_progress` of the header."""

    _fields_ = [
        ("size", c_size_t),
        ("fraction", c_double),
        *((name, c_int) for name in ("segment", "segments", "contact_nodes", "stick_nodes")),
        ("force", _per_motion),
        ("motion", _per_motion),
    ]

    #: Reads all members at once: `unpack(progress)`.
    unpack = struct.Struct(f"@Nd4i{2 * len(MOTIONS)}d").unpack_from


#: `mfv_observer` of the header.
OBSERVER = ctypes.CFUNCTYPE(c_int, POINTER(ProgressStructure), c_void_p)

_text, _length = c_char_p, POINTER(c_size_t)
_scene = _handle = _state = c_void_p
_handle_slot = POINTER(c_void_p)
_array = POINTER(c_double)

#: Result and arguments of every function of the header.
SIGNATURES: dict[str, tuple[type, ...]] = {
    "mfv_version": (c_int, _text, c_size_t),
    "mfv_has_feature": (c_int, _text, POINTER(c_int)),
    "mfv_status_text": (c_int, c_int, _text, c_size_t, _text, c_size_t),
    "mfv_key_info": (c_int, _text, POINTER(c_int), _text, c_size_t, _text, c_size_t),
    "mfv_observable_info": (c_int, c_size_t, _text, c_size_t, _text, c_size_t, _text, c_size_t),
    "mfv_reference": (c_int, _text, c_size_t, _array, _array),
    "mfv_scene_create": (c_int, _handle_slot),
    "mfv_scene_from_text": (c_int, _text, _text, _handle_slot, _text, c_size_t),
    "mfv_scene_set_text": (c_int, _scene, _text, _text),
    "mfv_scene_set_real": (c_int, _scene, _text, c_double),
    "mfv_scene_set_reals": (c_int, _scene, _text, _array, c_size_t),
    "mfv_scene_set_integer": (c_int, _scene, _text, c_int),
    "mfv_scene_set_logical": (c_int, _scene, _text, c_int),
    "mfv_scene_remove": (c_int, _scene, _text),
    "mfv_scene_make_room": (c_int, _scene, _text),
    "mfv_scene_set_data": (c_int, _scene, _text, _text, c_size_t, c_size_t, _array),
    "mfv_scene_text": (c_int, _scene, _text, c_size_t, _length),
    "mfv_scene_free": (c_int, _handle_slot),
    "mfv_create": (c_int, _scene, _handle_slot, _text, c_size_t),
    "mfv_create_from_file": (c_int, _text, _handle_slot, _text, c_size_t),
    "mfv_create_from_text": (c_int, _text, _text, _handle_slot, _text, c_size_t),
    "mfv_copy": (c_int, _handle, _handle_slot),
    "mfv_free": (c_int, _handle_slot),
    "mfv_run": (c_int, _handle),
    "mfv_advance": (c_int, _handle, POINTER(StepStructure)),
    "mfv_message": (c_int, _handle, _text, c_size_t),
    "mfv_get_loads": (c_int, _handle, POINTER(LoadsStructure)),
    "mfv_tangent": (c_int, _handle, c_int, _array, _array),
    "mfv_differentiate": (c_int, _handle, _text),
    "mfv_derivative": (c_int, _handle, c_size_t, POINTER(LoadsStructure), c_size_t, _array, _array),
    "mfv_save": (c_int, _handle, _handle_slot),
    "mfv_restore": (c_int, _handle, _state),
    "mfv_state_free": (c_int, _handle_slot),
    "mfv_observe": (c_int, _handle, OBSERVER, c_void_p),
    "mfv_stop_when_set": (c_int, POINTER(ProgressStructure), c_void_p),
    "mfv_field_count": (c_int, _handle, _length),
    "mfv_field_path": (c_int, _handle, c_size_t, _text, c_size_t),
    "mfv_field_info": (
        c_int,
        *(_handle, _text, _length, POINTER(c_int), POINTER(c_int)),
        *(_text, c_size_t, _text, c_size_t),
    ),
    "mfv_attribute_name": (c_int, _handle, c_size_t, _text, c_size_t),
    "mfv_attribute": (c_int, _handle, _text, _text, c_size_t, _length),
    "mfv_copy_real": (c_int, _handle, _text, _array, c_size_t),
    "mfv_copy_integer": (c_int, _handle, _text, POINTER(c_int32), c_size_t),
    "mfv_stress": (c_int, _handle, c_int, c_int, c_size_t, *(_array,) * 5),
    "mfv_stress_under": (c_int, _handle, c_int, c_size_t, *(_array,) * 6, c_double, c_size_t, *(_array,) * 5),
    "mfv_write": (c_int, _handle, _text),
}


@functools.cache
def library() -> ctypes.CDLL:
    """The library, loaded when first needed, with the signatures of its functions. Raises LibraryNotFound."""
    path = find_library()
    try:
        loaded = ctypes.CDLL(path)
        for name, (result, *arguments) in SIGNATURES.items():
            function = getattr(loaded, name)
            function.restype = result
            function.argtypes = arguments
    except (OSError, AttributeError) as error:
        raise LibraryNotFound(None, f"the MFV library {path} cannot be used: {error}; {HOW_TO_BUILD}") from error
    return loaded


def find_library() -> str:
    """Path of the library: MFV_LIBRARY if set, else the first one found. Raises LibraryNotFound."""
    asked_for = os.environ.get("MFV_LIBRARY")
    if asked_for:
        if not Path(asked_for).is_file():
            raise LibraryNotFound(None, f"MFV_LIBRARY={asked_for}: no such file; set it to the path of libmfv.so")
        return str(Path(asked_for).resolve())
    found = next((str(path) for path in _usual_places() if path.is_file()), None)
    if found is None:
        from ctypes.util import find_library

        found = find_library("mfv")
    if not found:
        raise LibraryNotFound(None, f"the MFV library was not found; {HOW_TO_BUILD}")
    return found


def _usual_places() -> Iterator[Path]:
    """In the installed package, then in the builds of the source tree, the release build first."""
    package = Path(__file__).resolve().parent
    yield from sorted((package / "lib").glob("libmfv.*"))
    builds = package.parents[1] / "build"
    for directory in [builds / "release" / "lib", *sorted(builds.glob("*/lib"))]:
        yield from (directory / name for name in ("libmfv.so", "libmfv.dylib"))


def text_buffer() -> ctypes.Array[ctypes.c_char]:
    """A buffer for a text from the library."""
    return ctypes.create_string_buffer(TEXT_SIZE)


def text_of(buffer: ctypes.Array[ctypes.c_char]) -> str:
    """The text in a buffer."""
    return buffer.value.decode("utf-8", errors="replace")


def whole_text(call: Callable[..., object], *arguments: object) -> str:
    """A text of any length, from a function whose last arguments are a buffer, its size and the length."""
    length = c_size_t()
    call(*arguments, None, 0, ctypes.byref(length))
    buffer = ctypes.create_string_buffer(length.value + 1)
    call(*arguments, buffer, len(buffer), None)
    return text_of(buffer)


def text_for(text: str | os.PathLike[str]) -> bytes:
    """A text or path, encoded for the library."""
    encoded = os.fsencode(text)
    if b"\0" in encoded:
        raise ValueError("a text for the MFV library must not contain a null character")
    return encoded


@functools.cache
def statuses() -> tuple[tuple[int, str, str], ...]:
    """Code, outcome and explanation of every status of the library, from its own list."""
    found: list[tuple[int, str, str]] = []
    outcome, explanation = text_buffer(), text_buffer()
    for code in itertools.count():
        if library().mfv_status_text(code, outcome, len(outcome), explanation, len(explanation)) != 0:
            return tuple(found)
        found.append((code, text_of(outcome), text_of(explanation)))
    raise AssertionError("the list of statuses does not end")


def outcome_of(status: int) -> str:
    """The outcome of a status in words."""
    return statuses()[status][1]


def has_feature(feature: str) -> bool:
    """Whether the library was built with a feature, such as "hdf5": result files and matrix bodies from files.

    Raises ValueError for a feature that no version has.
    """
    there = c_int()
    if library().mfv_has_feature(text_for(feature), ctypes.byref(there)) != 0:
        raise ValueError(f"the MFV library has no feature '{feature}'")
    return bool(there.value)


def real_pointer(values: NDArray[np.float64]) -> ctypes._Pointer[c_double]:
    """A pointer to the numbers of a contiguous array; the array must outlive it."""
    return values.ctypes.data_as(POINTER(c_double))


def library_version() -> str:
    """Version of the library."""
    buffer = text_buffer()
    library().mfv_version(buffer, len(buffer))
    return text_of(buffer)
