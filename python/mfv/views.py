"""What of a load history is shown: which load over which displacement, and which part of the surface."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from . import plot
from .codes import NodeStatus
from .load_history import kept_states
from .result import Result


class Curve(NamedTuple):
    """Which load is drawn over which displacement, and the labels of the axes."""

    across: str
    up: str
    across_label: tuple[str, str]
    up_label: tuple[str, str]


TANGENTIAL = Curve("shift", "tangential_force", ("shift", "U"), ("tangential force", "Q"))
ROTATIONAL = Curve("rotation", "moment", ("rotation", "\N{GREEK SMALL LETTER PHI}"), ("moment", "M"))
NORMAL = Curve("approach", "normal_force", ("approach", "h"), ("normal force", "P"))


def curve_of(result: Result) -> Curve:
    """The load that tells most: the tangential force, else the moment, else the normal force."""
    states = result.steps or kept_states(result).steps

    def moves(name: str) -> bool:
        negligible = 1.0e-9 * max(abs(state.normal_force) for state in states)
        return all(name in state for state in states) and any(abs(state[name]) > negligible for state in states)

    if plot._has_friction(result) and moves("tangential_force"):
        return TANGENTIAL
    return ROTATIONAL if moves("moment") and moves("rotation") else NORMAL


def contact(result: Result) -> tuple[float, float]:
    """All that is in contact in any state and a quarter of its length on either side, as far as the mesh goes."""
    states = result.steps or kept_states(result).steps
    touched = np.any([state.status != NodeStatus.OPEN for state in states], axis=0)
    starts, ends = result.mesh.x - 0.5 * result.mesh.width, result.mesh.x + 0.5 * result.mesh.width
    if not touched.any():
        return float(starts[0]), float(ends[-1])
    left, right = starts[touched][0], ends[touched][-1]
    margin = 0.25 * (right - left)
    return float(max(starts[0], left - margin)), float(min(ends[-1], right + margin))
