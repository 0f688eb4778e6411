"""The same problem stated differently, and whether the results agree: units, mirror image, order of bodies, split steps, solvers,
stepping, and the ways to run it."""

from __future__ import annotations

import os
import re
import subprocess
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

import mfv

from .fields import TOLERANCE, converter, differences, exchanged, mirrored
from .problem import Keys, Problem
from .scales import Scales

#: Loads by kind; targets that a step changes linearly.
FORCES = ("normal_force", "tangential_force")
LOADS = (
    *FORCES,
    "approach",
    "shift",
    "force_ratio",
    "moment",
    "rotation",
    "lower_bulk_stress",
    "upper_bulk_stress",
    "interference",
)
#: Loads that change their sign in the mirror image, and with the picture turned upside down.
ODD_LOADS = ("tangential_force", "shift", "force_ratio", "moment", "rotation")
TURNED_LOADS = ("moment", "rotation")
#: Powers of length and force in keys and columns; `coefficient` of a power depends on its exponent.
DIMENSIONS = {
    "radius": (1, 0), "half_width": (1, 0), "edge_radius": (1, 0), "datum": (1, 0), "period": (1, 0), "ends": (1, 0), "approach": (1, 0),
    "shift": (1, 0), "interference": (1, 0), "thickness": (1, 0), "weakening_distance": (1, 0), "x": (1, 0), "height": (1, 0),
    "shear_modulus": (-2, 1), "youngs_modulus": (-2, 1), "youngs_modulus_1": (-2, 1), "youngs_modulus_2": (-2, 1),
    "youngs_modulus_3": (-2, 1), "shear_modulus_12": (-2, 1), "compliances": (2, -1), "yield_strength": (-2, 1), "stiffness": (-3, 1),
    "normal_force": (-1, 1), "tangential_force": (-1, 1), "moment": (0, 1), "lower_bulk_stress": (-2, 1), "upper_bulk_stress": (-2, 1),
}  # fmt: skip
#: Of meshes that are made from edges, which round-off moves; of laws that are integrated with a tolerance.
ON_EDGES, OF_LAWS = 1.0e-5, 1.0e-3
#: Accuracy of large increments without a key.
DEFAULT_ACCURACY = 1.0e-3
#: Relative difference of meshes that count as one.
SAME_MESH = 1.0e-4
#: Error of the tractions over the accuracy that is allowed for them.
OVER_ACCURACY = 3.0

Differences = dict[str, float]


def in_other_units(problem: Problem, length: float, force: float) -> Problem:
    """The problem in other units."""

    def scaled(key: str, value: Any, keys: Keys, group: str) -> Any:
        powers = DIMENSIONS.get(key)
        if key == "coefficient":
            powers = (2, -1) if group == "wear" else (1 - keys["exponent"], 0)
        if key == "period" and group == "history":
            powers = None
        if powers is None:
            return value
        factor = length ** powers[0] * force ** powers[1]
        return [factor * item for item in value] if isinstance(value, list) else factor * value

    made = problem.copy()
    for group, keys in made.groups:
        keys.update({key: scaled(key, value, keys, group) for key, value in keys.items()})
    for table in made.tables.values():
        table.update({key: scaled(key, column, table, "") for key, column in table.items()})
    return made


def mirror_image(problem: Problem) -> Problem:
    made = problem.copy()
    _reflect(made)
    _change_signs(made, ODD_LOADS)
    for body in [*made.all("body"), *made.all("layer")]:
        if "axis_angle" in body:
            body["axis_angle"] = -body["axis_angle"]
        if "compliances" in body:
            odd = (3, 4, 9)
            body["compliances"] = [-value if place in odd else value for place, value in enumerate(body["compliances"])]
    return made


def upside_down(problem: Problem) -> Problem:
    """The lower body above the upper one; x changes its sign."""
    made = problem.copy()
    _reflect(made)
    _change_signs(made, TURNED_LOADS)
    bodies = [place for place, (group, _) in enumerate(made.groups) if group == "body"]
    made.groups[bodies[0]], made.groups[bodies[1]] = made.groups[bodies[1]], made.groups[bodies[0]]
    # Those of the first body come first.
    places = [place for place, (group, _) in enumerate(made.groups) if group == "layer"]
    turned = sorted((dict(keys, body=3 - keys["body"]) for keys in made.all("layer")), key=lambda keys: keys["body"])
    for place, keys in zip(places, turned):
        made.groups[place] = ("layer", keys)
    names = ("lower_bulk_stress", "upper_bulk_stress")
    for loads in made.loads():
        stresses = {name: loads.pop(name) for name in names if name in loads}
        loads.update({names[1 - names.index(name)]: value for name, value in stresses.items()})
    return made


def _reflect(made: Problem) -> None:
    """Change the sign of x of meshes, profiles and coefficients."""
    for group, keys in made.groups:
        if group == "mesh" and "ends" in keys:
            keys["ends"] = [-end for end in reversed(keys["ends"])]
    for file, table in made.tables.items():
        if file.startswith(("profile", "mu")):
            table.update({key: column[::-1] for key, column in table.items()})
            table["x"] = [-x for x in table["x"]]


def _change_signs(made: Problem, names: tuple[str, ...]) -> None:
    for loads in made.loads():
        for name in names:
            if name in loads:
                value = loads[name]
                loads[name] = [-item for item in value] if isinstance(value, list) else -value


def in_pieces(problem: Problem) -> Problem | None:
    """The problem with steps divided into two halves: those without cycles whose loads at the start are known. None if no step is."""
    made = problem.copy()
    made.groups = []
    names = ("normal_force", "tangential_force", "moment", "lower_bulk_stress", "upper_bulk_stress", "interference")
    known: dict[str, float] = dict.fromkeys(names, 0.0)
    for group, keys in problem.groups:
        targets = {key: value for key, value in keys.items() if key in LOADS}
        if group == "step" and not keys.get("cycles") and all(key in known for key in targets):
            half = {key: 0.5 * (known[key] + value) for key, value in targets.items()}
            made.groups.append(("step", {**keys, **half}))
        if group == "step":
            known = _loads_after(known, targets)
        made.groups.append((group, dict(keys)))
    return made if len(made.groups) > len(problem.groups) else None


def _loads_after(known: dict[str, float], targets: dict[str, float]) -> dict[str, float]:
    """Loads that are known after a step: under a prescribed motion its force is not."""
    after = {**known, **targets}
    for motion, force in (("approach", "normal_force"), ("shift", "tangential_force"), ("force_ratio", "tangential_force")):
        if motion in targets:
            after.pop(force, None)
            after.pop("force_ratio", None)
    for force, motion in (("normal_force", "approach"), ("tangential_force", "shift")):
        if force in targets:
            after.pop(motion, None)
    return after


def with_solver(problem: Problem) -> Problem:
    made = problem.copy()
    keys = made.one("solver")
    keys["linear_solver"] = "dgesv" if keys.get("linear_solver", "auto") != "dgesv" else "reduced"
    return made


def with_events(problem: Problem, base: mfv.Result) -> Problem | None:
    """Every event, where the problem has large increments or trial steps, by its keys or by default."""
    made = problem.copy()
    if not (made.has("solver", "accuracy") or made.has("solver", "stepping") or base.attributes["stepping"] == "leap"):
        return None
    keys = made.one("solver")
    keys.pop("accuracy", None)
    keys["stepping"] = "event"
    return made


def by_program(problem: Problem) -> mfv.Result:
    """The result of mfv_run. Raises RuntimeError if it does not write one."""
    with tempfile.TemporaryDirectory() as folder:
        problem.write(Path(folder))
        program = os.environ.get("MFV_RUN", "mfv_run")
        done = subprocess.run([program, "case.nml"], cwd=folder, capture_output=True, text=True)
        if not (Path(folder) / "case.h5").exists():
            raise RuntimeError(f"mfv_run returned {done.returncode}: {done.stderr.strip()}")
        return mfv.read(os.path.join(folder, "case.h5"))


def compared(base: mfv.Result, other: mfv.Result, tolerance: float, change: Any = None, common: bool = False) -> Differences:
    """Differences of two results; of runs that end early only whether they end alike, unless one is given up."""
    if base.outcome != "complete" or other.outcome != "complete":
        return _different_ends(base, other)
    given = {} if change is None else {"change": change}
    if _on_other_mesh(base, other, change):
        return {"mesh": np.inf}
    found = differences(base, other, tolerance=tolerance, common=common, **given)
    # Which of two equal values is the largest, and what is counted in intervals, is decided by round-off.
    decided = ("tension_x", "pressure_x", "von_mises_x", "von_mises_y", "interface_tension_y", "interface_shear_y", "_row")
    return {path: error for path, error in found.items() if not path.endswith(decided)}


def _different_ends(base: mfv.Result, other: mfv.Result) -> Differences:
    """The outcomes of two runs if they differ, unless the other one is given up, or one says that its bristles are too stiff."""
    if other.outcome in (base.outcome, "interrupted") or any("bristles are too stiff" in one.message for one in (base, other)):
        return {}
    return {f"outcome: {base.outcome} / {other.outcome}": np.inf}


def without_extremes(found: Differences) -> Differences:
    """Extremes are those of the ends of all steps, of which there are more where steps are split."""
    return {path: error for path, error in found.items() if not path.split("/")[-1].startswith(("largest_", "smallest_"))}


def _on_other_mesh(base: mfv.Result, other: mfv.Result, change: Any) -> bool:
    """Whether the meshes differ, which are made from edges: not every field then."""
    x = base.mesh.x if change is None else change("x", "length", base.mesh.x)[1]
    if len(x) != len(other.mesh.x):
        return True
    return bool(np.max(np.abs(np.abs(x) - np.abs(other.mesh.x))) > SAME_MESH * np.max(np.abs(other.mesh.x)))


def _accuracy_differences(base: mfv.Result, other: mfv.Result, accuracy: float) -> Differences:
    """Tractions and dissipation beyond three times the accuracy."""
    if base.outcome != "complete" or other.outcome != "complete":
        return _different_ends(base, other)
    if len(base.mesh.x) != len(other.mesh.x):
        return {}
    largest = max(np.max(other.state.pressure), np.max(np.abs(other.state.shear)))
    found = {f"state/{name}": np.max(np.abs(base.state[name] - other.state[name])) / largest for name in ("pressure", "shear")}
    work = float(other.summary.dissipation)
    scale = max(work, Scales(other).where_it_vanishes("dissipation"))
    found["summary/dissipation"] = abs(float(base.summary.dissipation) - work) / scale if scale > 0 else 0.0
    return {path: float(error) for path, error in found.items() if error > max(OVER_ACCURACY * accuracy, TOLERANCE)}


def accuracy_of(problem: Problem, base: mfv.Result) -> float:
    """That of large increments, also by default; zero without them."""
    return problem.accuracy() or (DEFAULT_ACCURACY if base.attributes["stepping"] == "leap" else 0.0)


def tolerance_of(problem: Problem, accuracy: float) -> float:
    """Of fields that only round-off should change."""
    law = problem.one("friction")["law"] if problem.has("friction") else "none"
    if law in ("weakening", "dahl"):
        return OF_LAWS
    return max(ON_EDGES if problem.has("mesh", "refine") else TOLERANCE, 0.1 * accuracy)


def beyond_accuracy(found: Differences, accuracy: float) -> Differences:
    """Without the work of friction up to the accuracy, which is its own: another solver follows events elsewhere."""
    work = re.compile(r".*/(friction_work|.*dissipation.*|loss_factor)")
    return {path: error for path, error in found.items() if not (work.fullmatch(path) and error <= accuracy)}


def relations(problem: Problem, base: mfv.Result, seed: int) -> dict[str, Callable[[], Differences]]:
    """The relations that apply, by name: each solves the problem again and returns what differs from `base`."""
    accuracy = accuracy_of(problem, base)
    tolerance = tolerance_of(problem, accuracy)
    plain = problem.copy()
    plain.one("output").update(error_estimate=False)
    rigid = any(body.get("rigid") for body in problem.all("body"))
    found: dict[str, Callable[[], Differences]] = {}
    length, stress = 10.0 ** np.random.default_rng(seed).uniform(-4, 4, 2)
    found["units"] = lambda: compared(
        base, in_other_units(plain, length, stress * length**2).run(), tolerance, converter(length, stress)
    )
    found["mirror image"] = lambda: compared(base, mirror_image(plain).run(), tolerance, mirrored)
    if not any(key in TURNED_LOADS for loads in problem.loads() for key in loads):
        found["order of bodies"] = lambda: compared(base, upside_down(plain).run(), tolerance, exchanged, common=rigid)
    pieces = in_pieces(plain)
    if pieces is not None and not problem.has("mesh", "refine"):
        # Other increments, each with the error that is allowed.
        of_pieces = max(tolerance, OVER_ACCURACY * accuracy)
        found["split steps"] = lambda: without_extremes(compared(base, pieces.run(), of_pieces))
    found["solver"] = lambda: beyond_accuracy(compared(base, with_solver(plain).run(), tolerance), accuracy)
    events = with_events(plain, base)
    if events is not None:
        # Rounding errors may change a block of cycles of wear by one.
        blocks = problem.has("wear") and bool(np.any(base.cycles.block > 1))
        allowed = max(accuracy, 0.1 * problem.wear_tolerance() if blocks else 0.0)
        found["stepping"] = lambda: _accuracy_differences(base, events.run(), allowed)
    found["Python"] = lambda: compared(base, plain.scene().run(), TOLERANCE)
    found["program"] = lambda: compared(base, by_program(plain), TOLERANCE)
    return found
