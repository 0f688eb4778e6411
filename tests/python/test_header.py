"""include/mfv.h against its description in Python: functions, structures, enumerations; and that every function says since when."""

from __future__ import annotations

import ctypes
import re
from pathlib import Path

import pytest

import mfv
from mfv import _library
from mfv.loads import MOTIONS, Targets

HEADER = (Path(__file__).resolve().parents[2] / "include" / "mfv.h").read_text()

#: The header without comments, C++ and the list of statuses, which comes from another file.
CODE = re.sub(r"/\*.*?\*/|^\s*#.*?$", "", HEADER, flags=re.DOTALL | re.MULTILINE)

STRUCTURES = {
    "mfv_step": _library.StepStructure,
    "mfv_loads": _library.LoadsStructure,
    "mfv_progress": _library.ProgressStructure,
}

ENUMERATIONS = {
    "MFV_APPROACH": {
        **{f"MFV_{motion.displacement.upper()}": number for number, motion in enumerate(MOTIONS)},
        "MFV_MOTIONS": len(MOTIONS),
    },
    "MFV_KEEP": {f"MFV_{name}": number for number, name in enumerate(_library.CONTROLS)},
    "MFV_ALONG_NOTHING": {f"MFV_ALONG_{name}": number for number, name in enumerate(_library.ALONG)},
    "MFV_LOWER": {f"MFV_{name.upper()}": number for number, name in enumerate(mfv.stress.BODIES)},
    "MFV_SIGMA_XX": {
        **{f"MFV_{name.upper()}": number for number, name in enumerate(mfv.stress.NAMES)},
        "MFV_STRESS_COUNT": len(mfv.stress.NAMES),
    },
}

SCALARS = {
    "int": ctypes.c_int,
    "double": ctypes.c_double,
    "size_t": ctypes.c_size_t,
    "mfv_observer": _library.OBSERVER,
}

POINTERS = {
    "char *": ctypes.c_char_p,
    "void *": ctypes.c_void_p,
    "double *": ctypes.POINTER(ctypes.c_double),
    "int32_t *": ctypes.POINTER(ctypes.c_int32),
    "int *": ctypes.POINTER(ctypes.c_int),
    "size_t *": ctypes.POINTER(ctypes.c_size_t),
    **{f"{opaque} *": ctypes.c_void_p for opaque in ("mfv_scene", "mfv_case", "mfv_state")},
    **{f"{opaque} **": ctypes.POINTER(ctypes.c_void_p) for opaque in ("mfv_scene", "mfv_case", "mfv_state")},
    **{f"{name} *": ctypes.POINTER(structure) for name, structure in STRUCTURES.items()},
}


def as_ctypes(declaration: str) -> type:
    """The ctypes type of a C parameter."""
    kind = re.sub(r"\w+$", "", re.sub(r"\bconst\b", "", declaration).strip())
    return {**SCALARS, **POINTERS}[" ".join(kind.split())]


def prototypes() -> list[tuple[str, str, str]]:
    """Result type, name and parameters of every function."""
    return re.findall(r"^(int|double) (mfv_\w+)\(([^)]*)\);", CODE, flags=re.MULTILINE)


def members(body: str) -> list[tuple[str, type]]:
    """Names and types of the members of a structure."""
    lines = [line.strip() for line in body.replace("MFV_MOTIONS", str(len(MOTIONS))).split(";") if line.strip()]
    declared = [re.fullmatch(r"(\w+)\s+([\w\s,\[\]]+)", line).groups() for line in lines]
    return [member(kind, name.strip()) for kind, names in declared for name in names.split(",")]


def member(kind: str, declared: str) -> tuple[str, type]:
    """Name and type of a member, which may be an array."""
    name, length = re.fullmatch(r"(\w+)(?:\[(\d+)\])?", declared).groups()
    return name, SCALARS[kind] * int(length) if length else SCALARS[kind]


def names_of(structure: type[ctypes.Structure]) -> tuple[str, ...]:
    """Names of the members of a structure after its size, of every motion where there is an array of them."""
    of_motions = {
        "force": tuple(motion.force for motion in MOTIONS),
        "motion": tuple(motion.displacement for motion in MOTIONS),
    }
    return tuple(name for member, _ in structure._fields_[1:] for name in of_motions.get(member, (member,)))


def flat(structure: ctypes.Structure) -> list[float]:
    """The values of all members."""
    values = [getattr(structure, name) for name, _ in structure._fields_]
    return [one for value in values for one in (value if isinstance(value, ctypes.Array) else (value,))]


def test_functions_are_those_of_the_header() -> None:
    declared = {name: (SCALARS[kind], *map(as_ctypes, inside.split(","))) for kind, name, inside in prototypes()}
    assert len(declared) == len(re.findall(r"\bmfv_\w+\(", CODE)) > 40
    assert declared == _library.SIGNATURES


def test_structures_are_those_of_the_header() -> None:
    declared = dict(re.findall(r"typedef struct (\w+) \{(.*?)\} \w+;", CODE, flags=re.DOTALL))
    assert declared.keys() == STRUCTURES.keys()
    for name, structure in STRUCTURES.items():
        assert structure._fields_ == members(declared[name]), name
        assert structure._fields_[0] == ("size", ctypes.c_size_t)
    assert tuple(mfv.Loads._fields) == names_of(_library.LoadsStructure)[:-1]
    assert tuple(mfv.Progress._fields) == names_of(_library.ProgressStructure)
    assert set(Targets.__annotations__) == {name for motion in MOTIONS for name in motion.targets}


def test_structures_are_packed_as_they_are_laid_out() -> None:
    step = _library.StepStructure()
    values = list(range(1, len(flat(step)) + 1))
    step.pack(step, 0, *values)
    assert flat(step) == values
    for structure in (_library.LoadsStructure(), _library.ProgressStructure()):
        numbers = iter(range(len(flat(structure))))
        for name, kind in structure._fields_:
            if issubclass(kind, ctypes.Array):
                getattr(structure, name)[:] = [next(numbers) for _ in range(kind._length_)]
            else:
                setattr(structure, name, next(numbers))
        assert list(structure.unpack(structure)) == list(range(len(flat(structure))))


def test_the_size_of_a_structure_is_that_of_the_library() -> None:
    with mfv.Scene(mfv.Body.half_plane(shear_modulus=1.0, poisson_ratio=0.3), mfv.Body.disk(1.0, rigid=True)).contact() as case:
        function = _library.library().mfv_advance
        step = _library.StepStructure(size=ctypes.sizeof(_library.StepStructure))
        assert function(case._handle, ctypes.byref(step)) == 0
        sizes: list[int] = []
        case._observer._function = _library.OBSERVER(lambda progress, _: sizes.append(progress.contents.size) or 0)
        case.observe(lambda progress: None)
        case.advance(normal_force=1.0e-3)
        assert set(sizes) == {ctypes.sizeof(_library.ProgressStructure)}


def test_the_observer_is_that_of_the_header() -> None:
    result, inside = re.search(r"typedef (\w+) \(\*mfv_observer\)\(([^)]*)\);", CODE).groups()
    assert _library.OBSERVER._restype_ is SCALARS[result]
    assert list(_library.OBSERVER._argtypes_) == [as_ctypes(parameter) for parameter in inside.split(",")]


def test_enumerations_are_those_of_the_header() -> None:
    enumerations = re.findall(r"^enum \{(.*?)\};", CODE, flags=re.DOTALL | re.MULTILINE)
    declared: dict[str, dict[str, int]] = {}
    for body in enumerations:
        values: dict[str, int] = {}
        for item in body.split(","):
            name, _, value = (part.strip() for part in item.partition("="))
            values[name] = int(value) if value else len(values)
        declared[next(iter(values))] = values
    assert declared == ENUMERATIONS


def test_every_function_says_since_when() -> None:
    silent = []
    for _, name, _ in prototypes():
        before = HEADER[: re.search(rf"^\w+ {name}\(", HEADER, flags=re.MULTILINE).start()]
        comment = before[before.rindex("/*") :]
        if not re.search(r"Since\s+(\*\s+)?\d+\.\d+\.\d+\.", comment) or "\n\n" in comment.split("*/")[1]:
            silent.append(name)
    assert not silent


def test_a_feature_is_there_or_unknown() -> None:
    assert isinstance(mfv.has_feature("hdf5"), bool)
    with pytest.raises(ValueError, match="telepathy"):
        mfv.has_feature("telepathy")
