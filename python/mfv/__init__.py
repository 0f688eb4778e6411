"""MFV: two-dimensional frictional elastic contact by the Method of First Violation.

`Scene` with `Body`, `Layer`, `Mesh`, `Friction`, `Step`, `Solver` and `Output` defines bodies and loads; `run` solves it, `Case` advances
it step by step; `study` solves many cases; `read` reads a result file, `stress` computes stresses inside the bodies, `plot` draws
results, `animate` and `report` make animations and web pages, `compare` and `comparison_figure` compare two results,
`load_history` has intermediate states, `identify` estimates parameters from measured loops, `joint` makes elements for structures,
`fatigue` predicts lives, `template` commented cases, `reference` has closed forms. Reading and drawing do not need the shared library.
"""

from __future__ import annotations

import importlib
from pathlib import Path as _Path
from typing import TYPE_CHECKING, Any

from ._packages import check_required

if TYPE_CHECKING:
    from . import errors, reference, stress
    from ._library import has_feature, library_version
    from .case import Case, State, Trial, run
    from .codes import EventKind, NodeStatus
    from .errors import LibraryNotFound, MfvError, NotAResult
    from .loads import Derivative, Loads, Progress
    from .result import Group, Result, read
    from .scene import Body, Friction, History, Layer, Mesh, Output, Scene, Solver, Step, Wear
    from .studies import Axis, Study, study

check_required()

__all__ = [
    "Axis",
    "Body",
    "Case",
    "Derivative",
    "EventKind",
    "Friction",
    "Group",
    "History",
    "Layer",
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
    "surfaces",
]

#: Where the names are. Each module is loaded when one of its names is first used: none has to wait for what it does not need.
_MODULES = {
    "_library": ("has_feature", "library_version"),
    "case": ("Case", "State", "Trial", "run"),
    "codes": ("EventKind", "NodeStatus"),
    "errors": ("LibraryNotFound", "MfvError", "NotAResult"),
    "loads": ("Derivative", "Loads", "Progress"),
    "result": ("Group", "Result", "read"),
    "scene": ("Body", "Friction", "History", "Layer", "Mesh", "Output", "Scene", "Solver", "Step", "Wear"),
    "studies": ("Axis", "Study", "study"),
}
_HOMES = {name: module for module, names in _MODULES.items() for name in names}

#: Modules that are attributes of the package, besides these.
_ON_FIRST_USE = (
    "animate",
    "compare",
    "comparison_figure",
    "fatigue",
    "identify",
    "joint",
    "load_history",
    "plot",
    "profiles",
    "reference",
    "report",
    "stress",
    "surfaces",
    "template",
)


def __getattr__(name: str) -> Any:
    if name in _HOMES:
        value = getattr(importlib.import_module(f".{_HOMES[name]}", __name__), name)
    elif name in _ON_FIRST_USE or name in _MODULES:
        value = importlib.import_module(f".{name}", __name__)
    elif name == "__version__":
        value = _version()
    else:
        raise AttributeError(f"module 'mfv' has no attribute '{name}'")
    globals()[name] = value
    return value


def _version() -> str:
    """The version of the source tree, or of the installed package."""
    file = _Path(__file__).resolve().parents[2] / "VERSION"
    if file.is_file():
        return file.read_text().strip()
    from importlib.metadata import version  # here: it takes as long as half of numpy

    return version("mfv-contact")


def __dir__() -> list[str]:
    return sorted({*globals(), *_ON_FIRST_USE, *_MODULES, *_HOMES, "__version__"})
