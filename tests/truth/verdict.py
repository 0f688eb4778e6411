"""The verdict of every number of a result: right, within its bar, flagged, not known, or a finding."""

from __future__ import annotations

import math
import re
from typing import NamedTuple

import numpy as np

import mfv
from mfv.codes import NodeStatus

from .fields import NUMBERS, TIED, WORK
from .problem import Problem
from .scales import Scales
from .truth import Truth

#: An error up to this part of the quantity (or of its natural scale) is right.
RIGHT = 0.01
#: An error within this many bars is as announced.
BARS = 3.0
#: Bars that are beyond this many of their own are counted.
STATISTIC = 2.0
#: Errors that are round-off.
ROUND_OFF = 1.0e-10
#: The truth is known if it is at least this many times better known than the error is large.
KNOWN = 3.0

WORDS = ("right", "within bars", "flagged", "unknown", "finding")
GROUPS = ("summary", "observables", "cycles", "patches")
#: What is not a number of the problem: counts of nodes and of work, numbers of cycles and blocks.
SKIPPED = WORK | NUMBERS | TIED | {"contact_nodes", "patch", "cycle", "cycles", "block", "friction_work"}
#: Zones, and gaps between them, narrower than this many intervals of the mesh are not resolved, as the descriptions of the numbers of
#: zones and patches say: statuses in them by names of numbers, of edges of the outermost ones, and of slip zones next to these.
NARROW = 2.0
_ZONES = {
    r"patches": tuple(status for status in NodeStatus if status != NodeStatus.OPEN),
    r"stick_(zones|left|right)|(left|right)_slip_zone": (NodeStatus.STICK, NodeStatus.CREEP_RIGHT, NodeStatus.CREEP_LEFT),
}
#: At nodes, as their descriptions say: right up to an interval.
COUNTED = {"observables/largest_pressure_x", "cycles/largest_pressure_x"}

_EDGES = r".*half_width|half_width_number|contact_(length|left|right|centre.*)|patch_shift.*|patches"
_STICK = r"stick_ratio|stick_(left|right|length|zones)|(left|right)_slip_zone"
#: Of edges of the contact, but for those of stick zones.
_EDGE_FIELDS = r"(left|right)_(.*_intensity|asymptotic_slip_zone|edge_reach)|steady_stick_length"
_TRACTIONS = r"peak_(pressure|shear)|(pressure|shear)_number"
_TENSION = r"(lower|upper)_tension(_x)?"
_TENSION_PLACE = r"(lower|upper)_tension_x"
_CYCLE = r"cycle_dissipation|dissipation_number|loss_factor|.*_force_work|.*stress_work|moment_work"
_MOTIONS = r"approach.*|shift.*|rotation.*|moment|.*_contraction|.*stiffness.*"
#: Names after "not resolved:" in a warning, and the quantities that follow from the one that is named; others stand for themselves.
NAMED = {
    "contact_half_width": r"(contact_)?half_width(_number)?|contact_(left|right|centre)",
    "contact_length": rf"contact_(length|left|right|centre)|patches|{_EDGE_FIELDS}",
    "stick_ratio": _STICK,
    "peak_pressure": r"peak_pressure|pressure_number",
    "peak_shear": r"peak_shear|shear_number",
    "tension": _TENSION,
    "lower_tension": r"lower_tension(_x)?",
    "upper_tension": r"upper_tension(_x)?",
    "tension at the left edge": _TENSION,
    "tension at the right edge": _TENSION,
    "approach": r"approach.*|rotation.*|moment",
    "shift": r"shift.*|.*_contraction",
    "extremes": r"(largest|smallest)_.*",
    "turning_points": r".*_(loading|reversal|return|amplitude|number)|stick_ratio_(lowest|highest)|patch_shift.*",
    "cycle_dissipation": _CYCLE,
    "tangential_stiffness": r"tangential_stiffness|stiffness_number",
    "stick_ratio_loading": r"stick_ratio_loading",
    "stick_ratio_reversal": r"stick_ratio_(reversal|lowest|highest)",
    "stick_ratio_return": r"stick_ratio_(return|lowest|highest)",
}
#: Other warnings of the library and the quantities that they name.
FLAGS = [
    (
        r"only \d+ nodes? (is|are) +in contact: half-width, stick ratio and tractions",
        f"{_EDGES}|{_STICK}|stick_ratio_.*|{_TRACTIONS}",
    ),
    (r"needs about .* (equal intervals|nodes in each patch)", f"{_TRACTIONS}|{_EDGES}"),
    (r"reaches the end of the surface", f"{_TRACTIONS}|{_TENSION}"),
    (r"no interval of the mesh ends at the corner", f"{_EDGES}|{_TRACTIONS}"),
    (r"rounded edges .* not resolved", f"{_STICK}|stick_ratio_.*|{_TRACTIONS}|{_TENSION}|dissipation|{_CYCLE}"),
    (r"largest relative residual", ".*"),
    (r"of the worn area is from cycles", r"worn_area|wear_depth"),
    (r"datum of the displacements|exceeds the datum", _MOTIONS),
]
#: Positions have the bars of the length and, of stick zones, of the stick ratio times the length of the contact.
_POSITION = r"contact_(left|right)"
_STICK_POSITION = r"stick_(left|right|length)"
#: What is not resolved if the forces of patches are not, which prescribe nothing.
_FORCES = {"patches/normal_force": "approach", "patches/tangential_force": "shift"}
#: Quantities that are equal to an observable of another name.
EQUAL = {
    "stick_ratio_lowest": "smallest_stick_ratio",
    "stick_ratio_highest": "largest_stick_ratio",
}


class Verdict(NamedTuple):
    """`word`: one of WORDS; relative error, bar (NaN without one) and uncertainty of the truth; the value and the true one."""

    word: str
    error: float
    bar: float
    uncertainty: float
    value: float
    true: float

    @property
    def holds(self) -> bool | None:
        """Whether the error is within twice the bar; None if there is no bar, the error is round-off, or the truth does not decide."""
        if not 0.0 < self.bar < math.inf or self.error < ROUND_OFF:
            return None
        if self.error + self.uncertainty <= STATISTIC * self.bar:
            return True
        return False if self.error - self.uncertainty > STATISTIC * self.bar else None


def quantities(result: mfv.Result) -> dict[str, np.ndarray]:
    """Every quantity that has a verdict, by group/name."""
    return {
        f"{group}/{name}": np.atleast_1d(np.asarray(part[name], dtype=float))
        for group in GROUPS
        for part in [getattr(result, group)]
        for name in part
        # Equal extremes occur in several rows.
        if name not in SKIPPED and not name.endswith("_row")
    }


def public_name(path: str) -> str:
    """The name by which warnings call a quantity; edges at the turning points of cycles have the names of those at the end."""
    name = re.sub(r"^((left|right)_.*)_(reversal|return)$", r"\1", path.split("/")[1])
    return "cycle_dissipation" if path == "cycles/dissipation" else name


def judge(problem: Problem, base: mfv.Result, truth: Truth) -> dict[str, Verdict]:
    """The verdict of every quantity of a complete run."""
    coarser, finer = quantities(truth.coarser), quantities(truth.finer)
    scales, limit = Scales(truth.finer), max(RIGHT, problem.accuracy(), problem.wear_tolerance())
    patterns = flagged_quantities(base)
    # Without shear the open surfaces of a period are under one tension, whose place is decided by round-off.
    is_uniform = problem.has("mesh", "period") and not np.any(base.state.shear)
    found = {}
    for path, values in quantities(base).items():
        group, name = path.split("/")
        there = [_aligned(group, base, result, fine.get(path)) for result, fine in ((truth.coarser, coarser), (truth.finer, finer))]
        if there[0] is None or there[1] is None or any(len(other) != len(values) for other in there):
            continue
        last = float(values[-1]) if len(values) else math.nan
        bar = bar_of(base, path, last)
        flagged = bar == math.inf or any(re.fullmatch(pattern, public_name(path)) for pattern in patterns)
        right = limit
        if path in COUNTED:
            right = max(limit, 1.05 * float(np.max(base.mesh.width)) / scales.half_width)
        size = np.nanmax(np.abs(there[1]), initial=0.0) if group == "patches" else 0.0
        found[path] = max(
            (
                _judge_one(
                    value,
                    closed_or(truth, path, one),
                    two,
                    scales.where_it_vanishes(name),
                    size,
                    right,
                    bar_of_row,
                    flagged or bar_of_row == math.inf,
                    name,
                )
                for row, (value, one, two) in enumerate(zip(values, *there))
                for bar_of_row in [_bar_of_row(base, path, row, value, last, bar)]
            ),
            key=lambda verdict: (WORDS.index(verdict.word), verdict.error),
            default=Verdict("right", 0.0, bar, 0.0, math.nan, math.nan),
        )
        found[path] = _but_for_narrow_zones(found[path], name, base, truth.finer)
        if is_uniform and found[path].word == "finding" and re.fullmatch(_TENSION_PLACE, name):
            found[path] = found[path]._replace(word="unknown")
    return found


def _but_for_narrow_zones(verdict: Verdict, name: str, base: mfv.Result, fine: mfv.Result) -> Verdict:
    """The verdict of a finding if zones and gaps that the mesh of the base does not resolve explain it: a number without them is right,
    another one up to that of all zones is not known, nor is an edge that is that of one of the wide zones (of any if none is wide)."""
    statuses = next((found for names, found in _ZONES.items() if re.fullmatch(names, name)), None)
    if verdict.word != "finding" or statuses is None:
        return verdict
    widths = np.interp(fine.mesh.x, base.mesh.x, base.mesh.width)
    every, wide = _zones(fine, statuses, 0.0 * widths), _zones(fine, statuses, NARROW * widths)
    if len(every) == len(wide):
        return verdict
    if re.fullmatch(rf"{_STICK_POSITION}|.*_slip_zone", name):
        ends = [first if "left" in name else last - 1 for first, last in wide or every]
        along = fine.mesh.arc if name.endswith("_slip_zone") and "arc" in fine.mesh else fine.mesh.x
        places = along[ends]
        if name.endswith("_slip_zone"):
            edge = fine.observables.contact_centre + (0.5 if "right" in name else -0.5) * fine.observables.contact_length
            places = np.abs(edge - places)
        explains = any(abs(place - verdict.value) <= NARROW * widths[end] for place, end in zip(places, ends))
        return verdict._replace(word="unknown") if explains else verdict
    own = len(_zones(base, statuses, 0.0 * np.asarray(base.mesh.x)))
    if own == len(wide):
        return verdict._replace(word="right")
    return verdict._replace(word="unknown") if len(wide) < own < len(every) else verdict


def _zones(result: mfv.Result, statuses: tuple[NodeStatus, ...], narrow: np.ndarray) -> list[tuple[int, int]]:
    """First node, and that after the last one, of the runs of nodes with one of these statuses; gaps between them that are narrower
    than `narrow`, shape (nodes), are filled, then narrower runs omitted."""
    inside = np.isin(result.state.status, statuses)
    for held in (False, True):
        for first, last in _runs(inside):
            bounded = held or (first > 0 and last < len(inside))
            if inside[first] == held and bounded and np.sum(result.mesh.width[first:last]) < np.max(narrow[first:last]):
                inside[first:last] = not held
    return [(first, last) for first, last in _runs(inside) if inside[first]]


def _runs(values: np.ndarray) -> list[tuple[int, int]]:
    """First element, and that after the last one, of the runs of equal values."""
    ends = [0, *(np.flatnonzero(np.diff(values)) + 1), len(values)]
    return list(zip(ends[:-1], ends[1:]))


def closed_or(truth: Truth, path: str, one: float) -> float:
    """The value on the coarser mesh of the truth or, if there is one, the closed form, which it has to agree with."""
    return truth.closed.get(path, one)


def _aligned(group: str, base: mfv.Result, fine: mfv.Result, values: np.ndarray | None) -> np.ndarray | None:
    """Values of the cycles that the base has; of patches if they are as many."""
    if values is None or group != "cycles":
        return values
    places = [np.flatnonzero(fine.cycles.cycle == cycle) for cycle in base.cycles.cycle]
    if any(len(place) == 0 for place in places) or len(values) != len(fine.cycles.cycle):
        return None
    return values[np.concatenate(places)]


def _judge_one(
    value: float, one: float, two: float, natural: float, size: float, right: float, bar: float, flagged: bool, name: str
) -> Verdict:
    """The verdict of one number: `one`, `two`: on the fine meshes; `size`: largest of its kind."""
    if math.isnan(value):
        both = math.isnan(one) and math.isnan(two)
        return Verdict("right" if both else "flagged", 0.0, math.nan, 0.0, value, two)
    if math.isnan(one) or math.isnan(two):
        # A half-width is undefined where there are several patches, whose number has its own verdict; a loss factor of a loop that is
        # open by 1 % of its area, which on another mesh may be a little less.
        undefined = math.isnan(one) and math.isnan(two) and not flagged and not re.fullmatch(f"{_EDGES}|loss_factor", name)
        return Verdict("finding" if undefined else "unknown", math.inf, bar, 0.0, value, two)
    scale = max(abs(two), natural, size, 1e-300)
    error, uncertainty = abs(value - two) / scale, 2.0 * abs(two - one) / scale
    if re.fullmatch(r".*(tension|pressure|von_mises)_x", name):
        # Of two equal tensions at both edges one is the largest by round-off.
        error = min(error, abs(value + two) / scale)
        uncertainty = min(uncertainty, 2.0 * abs(two + one) / scale)
    relative_bar = bar / scale if math.isfinite(bar) else math.nan
    if error + uncertainty <= right or (error <= right and uncertainty <= right):
        word = "right"
    elif error + uncertainty <= BARS * relative_bar:
        word = "within bars"
    elif flagged:
        word = "flagged"
    elif uncertainty > error / KNOWN:
        word = "unknown"
    elif error - uncertainty > max(right, 0.0 if math.isnan(relative_bar) else BARS * relative_bar):
        word = "finding"
    else:
        word = "unknown"
    return Verdict(word, error, relative_bar, uncertainty, value, two)


def bar_of(base: mfv.Result, path: str, value: float) -> float:
    """Bar of a quantity with a value: NaN without one; infinite where MFV says that there is no limit or that it is not resolved,
    or why there is no bar at all."""
    name = path.split("/")[1]
    if str(base.attributes.get("error_estimate", "")).startswith("none"):
        return math.inf
    if path in _FORCES and _error_of(base, _FORCES[path]) == math.inf:
        return math.inf
    if path == "cycles/shift_drift":  # the difference of two shifts
        return 2.0 * _error_of(base, "shift")
    if re.fullmatch(r"contact_centre_(reversal|return)", name):
        shift = name.replace("contact_centre", "patch_shift")
        if base.observables.patches > 1:  # without a half-width
            return bar_of(base, "observables/contact_centre", math.nan)
        return bar_of(base, f"observables/{shift}", math.nan) * 0.5 * float(base.observables.contact_length)
    if re.fullmatch(f"{_POSITION}|{_STICK_POSITION}", name):
        return _bar_of_position(base, name)
    turning = re.fullmatch(r"(?:left|right)_slip_zone_(reversal|return)", name)
    if turning:
        return bar_of(base, f"observables/stick_ratio_{turning[1]}", math.nan) * float(base.observables.contact_length)
    if not name.endswith("_work"):
        return _error_of(base, EQUAL.get(name, public_name(path)))
    return _relative_to_dissipation(base, value)


def _relative_to_dissipation(base: mfv.Result, value: float) -> float:
    """The relative bar of the last cycle's dissipation times a value."""
    error, of = _error_of(base, "cycle_dissipation"), abs(float(base.observables.cycle_dissipation))
    return error * abs(value) / of if of > 0.0 else error


def _bar_of_row(base: mfv.Result, path: str, row: int, value: float, last: float, bar: float) -> float:
    """Cycles have the relative bar of the last one, at least; the dissipation of the first one has its own. `bar`: of the last one."""
    if not path.startswith("cycles/"):
        return bar
    if path == "cycles/dissipation" and row == 0:
        return max(bar, _error_of(base, "first_cycle_dissipation"))
    if path == "cycles/loss_factor" and math.isnan(last):
        return _relative_to_dissipation(base, value)
    return bar * max(1.0, abs(value / last)) if abs(last) > 0.0 else bar


def _error_of(base: mfv.Result, observable: str) -> float:
    """Bar of an observable: NaN without one, infinite where it has no limit or is not resolved."""
    if f"{observable}_error" not in base.error_estimate:
        return math.nan
    error = float(base.error_estimate[f"{observable}_error"])
    return error if math.isfinite(error) else math.inf


def _bar_of_position(base: mfv.Result, name: str) -> float:
    """Both edges may be in error by the bar of the length, in opposite directions."""
    bar = bar_of(base, "observables/contact_length", 1.0)
    if re.fullmatch(_STICK_POSITION, name):
        bar += bar_of(base, "observables/stick_ratio", 1.0) * float(base.summary.contact_length)
    return bar


def flagged_quantities(base: mfv.Result) -> list[str]:
    """Patterns of the names of quantities that the warnings of a result name."""
    warnings = base.attributes.get("warnings", "").splitlines()
    found = [names for text, names in FLAGS if any(re.search(text, warning) for warning in warnings)]
    for warning in warnings:
        for names in re.findall(r"not resolved: ([^;]*)", warning):
            # Nor is the place of what is not resolved.
            found += [NAMED.get(name, rf"{re.escape(name)}(_[xy])?") for name in names.split(", ")]
    return found
