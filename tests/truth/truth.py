"""The truth of a problem: the same on meshes at least six times finer, by other algorithms; and closed forms where there are any.

What two fine meshes do not agree upon is not known.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

import mfv
from mfv import reference

from .generate import compliance
from .problem import Problem

#: How much finer the meshes of the truth are. One more interval on the second: a tip or corner lies at a node, or between nodes.
FINER = (6, 8)
#: Accuracy of the large increments of the finer one of them.
ACCURACY = 1.0e-4
#: Tolerance of increments of Dahl's law, which both meshes would else share with the problem: a fifth of that by default.
FRICTION_TOLERANCE = 2.0e-5
#: Nodes up to which it has events, too.
MOST_FOR_EVENTS = 400
#: Nodes up to which the coarser one of them is solved with a matrix.
MOST_FOR_MATRIX = 10_000
#: Fewest intervals on the equal mesh in place of unequal ones.
EQUAL = 10


class Truth(NamedTuple):
    """Two results on fine meshes, the finer one last; values of closed forms by path, for the quantities that have one."""

    coarser: mfv.Result
    finer: mfv.Result
    closed: dict[str, float]


def truth_of(problem: Problem, base: mfv.Result) -> Truth:
    """The truth of a problem with its result on its own mesh. Raises InputError."""
    coarser, finer = fine_problems(problem, base)
    return Truth(coarser.run(), finer.run(), closed_forms(problem))


def fine_problems(problem: Problem, base: mfv.Result) -> tuple[Problem, Problem]:
    """The problem on two fine meshes. One is equal where the other is graded; one has large increments where they are possible."""
    fine = []
    for number in range(len(FINER)):
        made = problem.copy()
        made.one("output").update(states="steps", history="steps", error_estimate=False)
        _refine(made, base, number)
        _solve_otherwise(made, number)
        _fix_cycles(made, base)
        if made.has("wear"):
            made.one("wear").pop("tolerance", None)
            made.one("wear").update(block=1)
        fine.append(made)
    return fine[0], fine[1]


def _refine(made: Problem, base: mfv.Result, number: int) -> None:
    """`number`: 0 for the first mesh of the truth, 1 for the second, which is equal where the other is graded."""
    factor = FINER[number]
    keys = made.one("mesh")
    if "ends" in keys:
        ends = np.array(keys["ends"])
        parts = np.linspace(0, 1, factor, endpoint=False)
        keys["ends"] = [*(ends[:-1, None] + parts * np.diff(ends)[:, None]).ravel(), ends[-1]]
        return
    nodes = keys.get("nodes", len(base.mesh.x))
    if keys.get("refine") == "edges" and number == 1:
        del keys["refine"]
        factor = EQUAL
    keys["nodes"] = factor * nodes + number


def _fix_cycles(made: Problem, base: mfv.Result) -> None:
    """As many cycles as the base has, where they end when they are steady: on another mesh that may be one cycle sooner or later."""
    with_cycles = [keys for _, keys in made.groups if "cycles" in keys]
    done = int(base.observables.get("cycles", 0))
    if len(with_cycles) == 1 and done > 0 and with_cycles[0].pop("steady_tolerance", None) is not None:
        with_cycles[0]["cycles"] = done


def _solve_otherwise(made: Problem, number: int) -> None:
    """Another linear solver than the problem's, events; large increments on the second mesh under Coulomb's law."""
    keys = made.one("solver")
    keys.clear()
    if made.has("friction") and made.one("friction")["law"] == "dahl":
        keys["friction_tolerance"] = FRICTION_TOLERANCE
    keys["stepping"] = "event"
    if number == 0:
        # By default it is another one there, too, and needs no matrix.
        if made.one("mesh").get("nodes", 0) <= MOST_FOR_MATRIX:
            keys["linear_solver"] = "reduced"
    elif (
        made.one("mesh").get("nodes", 0) > MOST_FOR_EVENTS
        and made.has("friction")
        and made.one("friction")["law"] == "coulomb"
        and not _is_strained(made)
    ):
        keys.update(stepping="leap", accuracy=ACCURACY)


def _is_strained(made: Problem) -> bool:
    return any(key.endswith("bulk_stress") for loads in made.loads() for key in loads)


class _Form(NamedTuple):
    """Closed forms of a rigid indenter on a half-plane: half-width of P, peak pressure of P and a, stick ratio of Q, P and a."""

    half_width: Callable[[float, float, float], float]
    peak: Callable[[float, float], float] | None
    stick: Callable[[float, float, float, float], float]


def closed_forms(problem: Problem) -> dict[str, float]:
    """Values of summary and observables at the end of a press without friction, sheared once, for a rigid indenter."""
    form, loads = _form(problem), _loads(problem)
    if form is None or loads is None:
        return {}
    elastic = next(body for body in problem.all("body") if not body.get("rigid"))
    normal, tangential, mu = loads
    # Only (kappa + 1)/(4 G) matters.
    half_width = float(form.half_width(normal, 1.0 / compliance(elastic, problem.one("scene").get("plane", "strain")), 3.0))
    found = {"observables/contact_half_width": half_width, "summary/contact_half_width": half_width}
    if form.peak:
        found["observables/peak_pressure"] = float(form.peak(normal, half_width))
    if tangential:
        found["observables/stick_ratio"] = float(form.stick(abs(tangential), normal, mu, half_width))
    return {name: value for name, value in found.items() if math.isfinite(value)}


def _form(problem: Problem) -> _Form | None:
    """The closed forms of the shape; a disk only if its gap is a parabola."""
    bodies = problem.all("body")
    plane = [body for body in bodies if body["shape"] == "half_plane" and not body.get("rigid")]
    rigid = [body for body in bodies if body.get("rigid")]
    if len(plane) != 1 or len(rigid) != 1 or problem.has("mesh", "period") or problem.has("layer"):
        return None
    keys = rigid[0]
    if keys["shape"] == "disk" and problem.has("mesh", "gap") and problem.one("mesh")["gap"] == "parabolic":
        return _power(0.5 / keys["radius"], 2.0)
    if keys["shape"] == "power":
        return _power(keys["coefficient"], keys["exponent"])
    if keys["shape"] == "wedge":
        return _power(math.tan(math.radians(keys["angle"])), 1.0)
    if keys["shape"] != "rounded_punch":
        return None
    flat = keys["half_width"]
    return _Form(
        lambda p, g, k: reference.rounded_punch_half_width(p, flat, keys["edge_radius"], g, k),
        lambda p, a: np.max(reference.rounded_punch_pressure(np.linspace(0, a, 4001), p, a, flat)),
        lambda q, p, mu, a: reference.rounded_punch_stick_ratio(q, p, mu, a, flat),
    )


def _power(coefficient: float, exponent: float) -> _Form:
    return _Form(
        lambda p, g, k: reference.power_half_width(p, coefficient, exponent, g, k),
        (lambda p, a: np.nanmax(reference.power_pressure(np.linspace(0, a, 4001), p, a, exponent))) if exponent > 1 else None,
        lambda q, p, mu, a: reference.power_stick_ratio(q, p, mu, exponent),
    )


def _loads(problem: Problem) -> tuple[float, float, float] | None:
    """P, Q and mu of a press and one shear that the closed forms hold for: without the effect of shear on the normal problem, and
    pressed without shear."""
    steps = problem.all("step")
    friction = problem.one("friction") if problem.has("friction") else {}
    law, coupling = friction.get("law", "none"), problem.one("scene").get("coupling", "full")
    if problem.has("history") or problem.has("wear") or len(steps) not in (1, 2) or "normal_force" not in steps[0]:
        return None
    if law == "none":
        return (steps[0]["normal_force"], 0.0, 0.0) if len(steps) == 1 else None
    if law != "coulomb" or "mu" not in friction or (coupling == "full" and (len(steps) == 2 or steps[0].get("friction", True))):
        return None
    if len(steps) == 1:
        return steps[0]["normal_force"], 0.0, 0.0
    if (coupling != "none" and steps[0].get("friction", True)) or set(steps[1]) != {"tangential_force"}:
        return None
    return steps[0]["normal_force"], steps[1]["tangential_force"], friction["mu"]
