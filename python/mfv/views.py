"""Views of a result for pictures, animations and pages: the load-displacement curve, the visible part of the surface.

Nothing here draws; `mfv.plot`, `mfv.animate`, `mfv.report` and `mfv.comparison_figure` do.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from .codes import NodeStatus
from .load_history import kept_states
from .result import Group, Result
from .stress import drawn_at, is_radial, surface


class Curve(NamedTuple):
    """Which load is drawn over which displacement, and the labels of the axes."""

    across: str
    up: str
    across_label: tuple[str, str]
    up_label: tuple[str, str]

    def values(self, result: Result) -> tuple[np.ndarray, np.ndarray]:
        """Displacements and loads, from the history or, without one, from the states."""
        if result.history:
            return result.history[self.across], result.history[self.up]
        across, up = (np.array([state[name] for state in result.steps]) for name in (self.across, self.up))
        return across, up


TANGENTIAL = Curve("shift", "tangential_force", ("shift", "U"), ("tangential force", "Q"))
ROTATIONAL = Curve("rotation", "moment", ("rotation", "\N{GREEK SMALL LETTER PHI}"), ("moment", "M"))
NORMAL = Curve("approach", "normal_force", ("approach", "h"), ("normal force", "P"))

#: Loads that a state is described by, with their symbols.
LOADS = (
    ("P", "normal_force"),
    ("Q", "tangential_force"),
    ("M", "moment"),
    ("lower \N{GREEK SMALL LETTER SIGMA}", "lower_bulk_stress"),
    ("upper \N{GREEK SMALL LETTER SIGMA}", "upper_bulk_stress"),
    ("interference", "interference"),
)


def curve_of(result: Result) -> Curve:
    """The most informative curve: of the tangential force, else of the moment, else of the normal force."""
    states = result.steps or kept_states(result).steps

    def moves(name: str) -> bool:
        negligible = 1.0e-9 * max(abs(state.normal_force) for state in states)
        return all(name in state for state in states) and any(abs(state[name]) > negligible for state in states)

    if has_friction(result) and moves("tangential_force"):
        return TANGENTIAL
    return ROTATIONAL if moves("moment") and moves("rotation") else NORMAL


def along_surface(result: Result) -> tuple[str, str, str]:
    """Name, symbol and unit of the places along the surface: x, with radial normals the angle."""
    return ("angle", "\N{GREEK SMALL LETTER THETA}", "degrees") if is_radial(result) else ("position", "x", result.mesh.unit("x"))


def intervals(result: Result) -> tuple[np.ndarray, np.ndarray]:
    """Both ends of the intervals of the nodes, as drawn."""
    places, half = drawn_at(result), 0.5 * drawn_at(result, result.mesh.width)
    return places - half, places + half


def contact(result: Result, states: Sequence[Group] = ()) -> tuple[float, float]:
    """The range of x (see `along_surface`) in contact in any of the states, with a quarter of its length on either side within the mesh.

    `states`: by default those of the result. Without contact: the whole mesh.
    """
    states = states or result.steps or kept_states(result).steps
    touched = np.any([state.status != NodeStatus.OPEN for state in states], axis=0)
    starts, ends = intervals(result)
    if not touched.any():
        return float(starts[0]), float(ends[-1])
    left, right = starts[touched][0], ends[touched][-1]
    margin = 0.25 * (right - left)
    return float(max(starts[0], left - margin)), float(min(ends[-1], right + margin))


def statuses(result: Result) -> np.ndarray:
    """The statuses that nodes have in any of the states in `steps`."""
    return np.unique([state.status for state in result.steps])


def has_friction(result: Result) -> bool:
    """Whether the tangential problem was solved; otherwise slip is NaN."""
    return not bool(np.isnan(result.state.slip).all())


def is_sheared(result: Result) -> bool:
    """Whether the load history has a tangential force above round-off."""
    if not has_friction(result) or not result.history:
        return False
    negligible = 1.0e-9 * np.max(np.abs(result.history.normal_force))
    return bool(np.any(np.abs(result.history.tangential_force) > negligible))


def friction_limits(result: Result) -> list[tuple[str, np.ndarray]]:
    """Coefficients of friction at the nodes with their index in formulas: one, "", or static and kinetic, "s" and "k"."""
    mesh = result.mesh
    if "static_friction" not in mesh:
        return []
    if np.array_equal(mesh.static_friction, mesh.kinetic_friction):
        return [("", mesh.static_friction)]
    return [("s", mesh.static_friction), ("k", mesh.kinetic_friction)]


def limit_of_friction(coefficient: np.ndarray, state: Group) -> np.ndarray:
    """The friction limit at the nodes in contact."""
    return np.where(state.status != NodeStatus.OPEN, coefficient * state.pressure, np.nan)


def heights(result: Result, state: Group) -> tuple[np.ndarray, np.ndarray]:
    """Heights of both surfaces: the lower one deformed from its own shape (with radial normals along the radius, from its circle), the
    upper one a gap above it."""
    x = result.mesh.x
    lower = (np.zeros_like(x) if is_radial(result) else surface(result, "lower", x)) - state.get(
        "normal_displacement", np.zeros_like(x)
    )
    return lower, np.where(np.isfinite(state.gap), lower + state.gap, np.nan)


def has_last_normal_force(result: Result, state: Group) -> bool:
    """Whether the normal force equals that of the last state, for which the closed form of the pressure holds."""
    return bool(np.isclose(state.normal_force, result.summary.normal_force, rtol=1.0e-9, atol=0.0))


def is_named(unit: str) -> bool:
    """Whether the user has named a unit."""
    return unit not in ("", "1") and "length" not in unit and "force" not in unit
