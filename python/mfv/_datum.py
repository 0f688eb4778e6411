"""Default datums that depend on the loads or the mesh of a case, and so differ between cases that are compared."""

from __future__ import annotations

import copy
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .case import Case
    from .scene import Scene

#: Shapes without a length: only next to them does a datum depend on the case.
SHAPES = ("wedge", "power")

_KEYS = {"lower": "body(1)%datum", "upper": "body(2)%datum"}


def datums_of_case(case: Case) -> dict[str, float]:
    """The datums of a case, by key, that are defaults and depend on its loads or its mesh."""
    flags = {body: f"scene/{body}_datum_of_case" for body in _KEYS}
    fields = case.fields()
    return {_KEYS[body]: float(case[f"scene/{body}_datum"]) for body, flag in flags.items() if flag in fields and case[flag]}


def datums_of(scene: Scene) -> dict[str, float]:
    """Those of a scene. Raises InputError."""
    if not {scene.lower.shape, scene.upper.shape} & set(SHAPES):
        return {}
    with scene.contact() as case:
        return datums_of_case(case)


def with_datums(scene: Scene, datums: dict[str, float]) -> Scene:
    """The scene with these datums as keys: they then stay when its loads or its mesh are changed."""
    scene = copy.copy(scene)
    for key, datum in datums.items():
        body = "lower" if key == _KEYS["lower"] else "upper"
        part = copy.copy(getattr(scene, body))
        part.datum = datum
        setattr(scene, body, part)
    return scene
