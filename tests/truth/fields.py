"""What every output becomes when a problem is stated differently: mirrored, turned upside down, in other units.

A field that a table does not name has to stay what it is.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from fractions import Fraction

import numpy as np

import mfv

from .scales import Scales, other_side

GROUPS = ("state", "summary", "observables", "cycles", "patches")
#: Of lengths, forces and stresses alike, relative to the scale of the quantity.
TOLERANCE = 1.0e-8
#: The largest tension is searched for, and is at a place where two branches of a curve meet.
TENSION = 1.0e-6
#: Of quantities that are much smaller than their natural scale.
ROUND_OFF = 1.0e-11
#: What depends on how a problem is solved, not on the problem.
WORK = {
    "events", "leaps", "linear_solves", "largest_residual", "steps_done", "cycle_change", "change", "status", "step",
    "increment_traction_error", "increment_dissipation_error",
}  # fmt: skip
#: Numbers of nodes, which begin at the left end; and counts that an event at the very end of a step may change.
NUMBERS = {"first_node", "last_node", "stick_nodes", "slip_nodes"}
#: Places of values that occur at several places of a symmetric contact (test_load_extremes compares them with the states).
TIED = {"largest_shear_x", "largest_slip_range_x"} | {
    f"largest_{body}_interface_{traction}_x" for body in ("lower", "upper") for traction in ("tension", "shear")
}
#: Quantities that change their sign in the mirror image.
ODD = {
    "tangential_force", "shift", "shear", "slip", "moment", "rotation", "tangential_displacement",
    "upper_tangential_displacement", "contact_centre", "contact_centre_reversal", "contact_centre_return",
    "patch_shift_loading", "patch_shift_reversal", "patch_shift_return", "shift_drift", "rotation_drift",
    "lower_tension_x", "upper_tension_x", "contact_edge", "stick_edge",
    "largest_lower_tension_x", "largest_upper_tension_x", "largest_pressure_x",
} | {f"{side}_shear_intensity{end}" for side in ("left", "right") for end in ("", "_reversal", "_return")}  # fmt: skip
#: Positions: they change their sign when the picture is turned or mirrored, and move with the contact.
POSITIONS = {
    "contact_centre", "contact_centre_reversal", "contact_centre_return",
    "lower_tension_x", "upper_tension_x", "contact_edge", "stick_edge",
    "largest_lower_tension_x", "largest_upper_tension_x", "largest_pressure_x",
}  # fmt: skip
#: Fields of the patches, from left to right. (Those of the same name elsewhere are one number.)
OF_PATCHES = {
    "contact_left", "contact_right", "contact_length", "normal_force", "tangential_force", "peak_pressure", "peak_shear",
    "stick_zones", "stick_left", "stick_right", "stick_length",
} | {f"{side}_{of_edge}" for side in ("left", "right") for of_edge in (
    "normal_intensity", "shear_intensity", "slip_zone", "asymptotic_slip_zone", "edge_reach", "edge_exponent", "corner_intensity",
)}  # fmt: skip


def outputs(result: mfv.Result) -> dict[str, tuple[str, np.ndarray]]:
    """All fields: unit and values by group/name."""
    found = {}
    for group in GROUPS:
        part = getattr(result, group, None)
        for name in part or ():
            if name not in WORK | NUMBERS | TIED:
                found[f"{group}/{name}"] = part.unit(name), np.atleast_1d(np.asarray(part[name]))
    return found


def differences(
    first: mfv.Result,
    second: mfv.Result,
    change: Callable[[str, str, np.ndarray], tuple[str, np.ndarray]] = lambda name, unit, values: (name, values),
    common: bool = False,
    tolerance: float = TOLERANCE,
) -> dict[str, float]:
    """Relative differences beyond `tolerance` of what is in `first`, changed by `change`, from `second`, by name; `common`: only of what
    both have."""
    there, scales = outputs(second), Scales(second)
    found, expected = {}, set()
    for path, (unit, values) in outputs(first).items():
        group, name = path.split("/")
        to, changed = change(name, unit, values)
        expected.add(f"{group}/{to}")
        if f"{group}/{to}" not in there:
            if not common:
                found[path] = np.inf
            continue
        actual = there[f"{group}/{to}"][1]
        if changed.shape != actual.shape or not np.array_equal(np.isnan(changed), np.isnan(actual)):
            found[path] = np.inf
            continue
        ends = np.isfinite(changed)
        size = np.max(np.abs(actual[ends]), initial=scales.where_it_vanishes(name))
        error = np.max(np.abs(changed[ends] - actual[ends]), initial=0.0)
        if scales.is_closed and name.startswith("patch_shift"):  # that of the centre, which is compared
            continue
        if scales.is_closed and name.startswith(("contact_edge", "stick_edge", "contact_centre")):  # up to whole turns
            turns = np.round((changed[ends] - actual[ends]) / scales.around)
            error = np.max(np.abs(changed[ends] - actual[ends] - turns * scales.around), initial=0.0)
        if error > max(max(tolerance, TENSION if "tension" in name else 0.0) * size, ROUND_OFF * scales.natural(name)):
            found[path] = float(error / size) if size > 0.0 else np.inf
    if not common:
        found.update({path: np.inf for path in there if path not in expected})
    return found


def mirrored(name: str, unit: str, values: np.ndarray) -> tuple[str, np.ndarray]:
    """What a field is in the mirror image."""
    sign = -1.0 if name in ODD or is_edge_position(name) else 1.0
    return other_side(name), sign * values[::-1] if is_along_the_surface(name) else sign * values


def is_edge_position(name: str) -> bool:
    """Whether a field is the position of a left or right edge; others of an edge begin with its side."""
    return other_side(name) != name and not name.startswith(("left_", "right_"))


def is_along_the_surface(name: str) -> bool:
    return name in {
        "pressure", "shear", "gap", "slip", "friction_work", "normal_displacement", "tangential_displacement",
        "upper_normal_displacement", "upper_tangential_displacement", "x", "contact_edge", "stick_edge", "wear_depth",
    } | OF_PATCHES  # fmt: skip


def other_body(name: str) -> str:
    """The same of the other body."""
    if name in ("normal_displacement", "tangential_displacement"):
        return "upper_" + name
    if name in ("upper_normal_displacement", "upper_tangential_displacement"):
        return name.replace("upper_", "")
    if "lower" in name:
        return name.replace("lower", "upper")
    return name.replace("upper", "lower")


def exchanged(name: str, unit: str, values: np.ndarray) -> tuple[str, np.ndarray]:
    """What a field is with the picture turned upside down: x changes its sign, forces and motions of one body against the other
    do not."""
    turned = POSITIONS | {
        "patch_shift_loading", "patch_shift_reversal", "patch_shift_return",
        "tangential_displacement", "upper_tangential_displacement",
    }  # fmt: skip
    sign = -1.0 if name in turned or is_edge_position(name) or name.endswith("_y") else 1.0
    return other_body(other_side(name)), sign * values[::-1] if is_along_the_surface(name) else sign * values


def converter(length: float, stress: float) -> Callable[[str, str, np.ndarray], tuple[str, np.ndarray]]:
    """Values in other units of length and stress."""
    sizes = {"force": stress * length**2, "length": length, "1": 1.0, "radians": 1.0}

    def converted(name: str, unit: str, values: np.ndarray) -> tuple[str, np.ndarray]:
        factor = 1.0
        for base, power in re.findall(r"(/?[a-z1]+)(?:\^\(?([\d/]+)\)?)?", unit):
            factor *= sizes[base.lstrip("/")] ** (float(Fraction(power or "1")) * (-1 if base.startswith("/") else 1))
        return name, values * factor

    return converted
