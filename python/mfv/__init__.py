"""MFV: two-dimensional frictional elastic contact by the Method of First Violation.

`Scene` with `Body`, `Mesh`, `Friction`, `Step`, `Solver` and `Output` defines bodies and loads; `run` solves it, `Case` advances
it step by step; `study` solves many cases; `read` reads a result file, `stress` computes stresses inside the bodies, `plot` draws
results, `animate` and `report` make animations and web pages, `compare` and `comparison_figure` compare two results,
`load_history` has intermediate states, `identify` estimates parameters from measured loops, `joint` makes elements for structures,
`fatigue` predicts lives, `template` commented cases, `reference` has closed forms. Reading and drawing do not need the shared library.
"""

from __future__ import annotations

import importlib
from importlib.metadata import version as _installed_version
from pathlib import Path as _Path
from types import ModuleType

from ._packages import check_required

check_required()

from . import errors, reference, stress
from ._library import has_feature, library_version
from .case import Case, State, Trial, run
from .codes import EventKind, NodeStatus
from .errors import LibraryNotFound, MfvError, NotAResult
from .loads import Derivative, Loads, Progress
from .result import Group, Result, read
from .scene import Body, Friction, History, Mesh, Output, Scene, Solver, Step, Wear
from .studies import Axis, Study, study

__all__ = [
    "Axis",
    "Body",
    "Case",
    "Derivative",
    "EventKind",
    "Friction",
    "Group",
    "History",
    "LibraryNotFound",
    "Loads",
    "Mesh",
    "MfvError",
    "NodeStatus",
    "NotAResult",
    "Output",
    "Progress",
    "Result",
    "Scene",
    "Solver",
    "State",
    "Step",
    "Study",
    "Trial",
    "Wear",
    "errors",
    "has_feature",
    "library_version",
    "plot",
    "read",
    "reference",
    "run",
    "stress",
    "study",
]

_version_file = _Path(__file__).resolve().parents[2] / "VERSION"
__version__ = _version_file.read_text().strip() if _version_file.is_file() else _installed_version("mfv-contact")


#: Modules that are loaded on first use, so that matplotlib is loaded for drawing only.
_ON_FIRST_USE = (
    "animate",
    "compare",
    "comparison_figure",
    "fatigue",
    "identify",
    "joint",
    "load_history",
    "plot",
    "report",
    "template",
)


def __getattr__(name: str) -> ModuleType:
    if name in _ON_FIRST_USE:
        return importlib.import_module(f".{name}", __name__)
    raise AttributeError(f"module 'mfv' has no attribute '{name}'")


def __dir__() -> list[str]:
    return sorted({*globals(), *_ON_FIRST_USE})
