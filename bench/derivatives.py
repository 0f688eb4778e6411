"""Derivatives through events (docs/theory.md) against central differences on random scenes, and their cost.

    python bench/derivatives.py [SCENES [FIRST]]

Each scene is run once with derivatives and twice more for every parameter. Printed for each: the largest difference over all
parameters, loads, motions, dissipation and tractions, each relative to its own size for a relative change of the parameter; and the
linear solves for derivatives of a parameter, over those of the run itself. Scenes of which a varied run has other events in another order are compared
as well, and marked.
"""

from __future__ import annotations

import sys
from typing import Any, NamedTuple

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

import mfv

Keys = dict[str, Any]
Steps = list[dict[str, Any]]

#: Relative variation of a parameter; truncation goes as its square, rounding as its inverse.
VARIATION = 1e-6
LOADS = ("normal_force", "tangential_force", "moment", "approach", "shift", "rotation", "dissipation")


class Outcome(NamedTuple):
    """What a comparison has found."""

    largest: float  #: relative difference
    parameter: str  #: with the largest difference
    parameters: int
    kinks: int  #: parameters whose variation changed the number of events or the final statuses
    events: int
    solves: float  #: for derivatives by parameter, over those of the run itself


def random_bodies(random: Generator) -> Keys:
    """Two bodies, of which at least one is elastic, and a mesh."""
    radius = 0.25
    keys: Keys = {"body(1)%shape": "half_plane", "body(2)%shape": "disk", "body(2)%radius": radius, "mesh%half_width": 0.02}
    kind = random.integers(7)
    if kind == 1:
        keys |= {"body(1)%shape": "disk", "body(1)%radius": 0.4}
    elif kind == 2:
        keys |= {"body(1)%shape": "hole", "body(1)%radius": 0.6}
    elif kind == 3:
        keys |= {"body(2)%shape": "power", "body(2)%coefficient": 2.0, "body(2)%exponent": 2.2}
        del keys["body(2)%radius"]
    elif kind == 4:
        keys |= {"body(2)%shape": "rounded_punch", "body(2)%half_width": 0.003, "body(2)%edge_radius": 0.1}
        del keys["body(2)%radius"]
    elif kind == 5:
        keys |= {"body(1)%shape": "hole", "body(1)%radius": 0.26, "mesh%normals": "radial", "mesh%half_width": 0.12}
    elif kind == 6:
        del keys["mesh%half_width"]
    keys |= {"body(1)%shear_modulus": 1.0, "body(1)%poisson_ratio": round(random.uniform(0.05, 0.45), 3)}
    if random.random() < 0.5:
        keys["body(2)%rigid"] = True
    else:
        keys |= {"body(2)%shear_modulus": round(random.uniform(0.3, 3.0), 3), "body(2)%poisson_ratio": 0.3}
    keys["mesh%nodes"] = int(random.integers(15, 32))
    return keys


def random_scene(number: int) -> tuple[Keys, Steps]:
    """The keys and the steps of a random scene."""
    random = np.random.default_rng(number)
    mu = round(random.uniform(0.2, 0.8), 3)
    keys = random_bodies(random) | {
        "scene%coupling": ("full", "full", "goodman", "none")[random.integers(4)],
        "friction%law": "coulomb",
        "friction%mu": mu,
        "solver%stepping": ("event", "event", "event", "nominal")[random.integers(4)],
        "solver%linear_solver": ("auto", "dgesv", "fft")[random.integers(3)],
        "output%history": "none",
        "output%states": "none",
    }
    half_width = keys.get("mesh%half_width", 0.02)
    stiffness = 2.4 * half_width**2  # of the order of the modulus times the curvature
    force = random.uniform(0.1, 0.4) * stiffness if "mesh%normals" not in keys else random.uniform(2e-4, 6e-4)
    steps: Steps = [{"normal_force": force, "friction": bool(random.random() < 0.8)}]
    if steps[0]["friction"] and random.random() < 0.5:
        steps[0]["tangential_force"] = mu * force * random.uniform(-0.4, 0.4)
    for _ in range(random.integers(1, 4)):
        steps.append(random_step(random, keys, mu, force))
    return keys, steps


def random_step(random: Generator, keys: Keys, mu: float, force: float) -> dict[str, Any]:
    """One more step of a scene under about this normal force."""
    kind = random.integers(6)
    shear = mu * force * random.uniform(-0.6, 0.6)
    if kind == 0:
        return {"tangential_force": shear, "normal_force": force * random.uniform(0.9, 1.3)}
    if kind == 1:
        return {"shift": force * mu * random.uniform(-1.0, 1.0)}
    if kind == 2:
        return {"tangential_force": abs(shear) + 0.1 * mu * force, "cycles": 1}
    if kind == 3 and "mesh%normals" not in keys:
        return {"rotation": 1e-4 * random.uniform(-1.0, 1.0), "tangential_force": shear}
    if kind == 4 and keys["body(1)%shape"] == "half_plane":
        return {"lower_bulk_stress": 0.01 * random.uniform(-1.0, 1.0), "tangential_force": 0.5 * shear}
    return {"tangential_force": shear}


def new_case(keys: Keys) -> mfv.Case:
    """The case with these keys."""
    groups: dict[str, list[str]] = {}
    for name, value in keys.items():
        group, key = name.split("%")
        written = {True: ".true.", False: ".false."}[value] if isinstance(value, bool) else repr(value)
        groups.setdefault(group, []).append(f"{key}={written}")
    return mfv.Case.from_text("\n".join(f"&{group.split('(')[0]} {', '.join(entries)} /" for group, entries in groups.items()))


def lead(keys: Keys, steps: Steps, parameters: tuple[str, ...] = ()) -> mfv.Case | None:
    """The case after all steps; None if it ends early."""
    is_chosen = "mesh%half_width" not in keys  # the mesh, by the steps of the case
    of_steps = {f"step({number})%{key}": value for number, step in enumerate(steps, 1) for key, value in step.items()}
    case = new_case(keys | of_steps if is_chosen else keys)
    case.differentiate(*parameters)
    if is_chosen:
        return case if case.run() == "complete" else None
    if all(case.advance(**step) == "complete" for step in steps):
        return case
    return None


def varied(keys: Keys, steps: Steps, name: str, change: float) -> mfv.Case | None:
    """The case after all steps with another value of a parameter."""
    keys, steps = dict(keys), [dict(step) for step in steps]
    if name.startswith("step("):
        number, key = name[len("step(") :].split(")%")
        steps[int(number) - 1][key] += change
    else:
        keys[name] += change
    return lead(keys, steps)


def parameters_of(keys: Keys, steps: Steps) -> dict[str, float]:
    """All parameters with their values."""
    no_parameter = ("mesh%", "friction%l", "solver%", "output%")
    found = {name: value for name, value in keys.items() if isinstance(value, float) and not name.startswith(no_parameter)}
    for number, step in enumerate(steps, 1):
        found |= {f"step({number})%{key}": value for key, value in step.items() if isinstance(value, float) and value != 0.0}
    return found


def vector(case: mfv.Case) -> NDArray[np.float64]:
    """All that is compared: loads, motions, dissipation and tractions."""
    return np.concatenate([[getattr(case.loads, name) for name in LOADS], case["state/pressure"], case["state/shear"]])


def sizes(case: mfv.Case, friction: float) -> NDArray[np.float64]:
    """The size of each of these."""
    loads, pressure = case.loads, np.asarray(case["state/pressure"])
    length = float(np.abs(case.x).max())
    slip = friction * abs(loads.approach)
    work = max(loads.dissipation, 1e-3 * friction * loads.normal_force * slip)
    of_loads = [loads.normal_force, friction * loads.normal_force, friction * loads.normal_force * length]
    of_motions = [abs(loads.approach), slip, slip / length, work]
    return np.concatenate([of_loads, of_motions, np.full(2 * pressure.size, pressure.max())])


def compared(number: int) -> Outcome | None:
    """The comparison of a scene; None if it ends early."""
    keys, steps = random_scene(number)
    parameters = parameters_of(keys, steps)
    case = lead(keys, steps, tuple(parameters))
    if case is None:
        return None
    plain = lead(keys, steps)
    assert plain is not None and plain.loads == case.loads, f"scene {number}: derivatives change the result"
    if "mesh%half_width" not in keys:  # the mesh is chosen for a key: hold it
        keys["mesh%nodes"], keys["mesh%half_width"] = case.x.size, 0.5 * float(case["mesh/interval"]) * case.x.size
    size = sizes(case, keys["friction%mu"])
    worst, culprit, kinks = 0.0, "", 0
    for name, derivative in case.derivatives.items():
        change = VARIATION * abs(parameters[name])
        ends = [varied(keys, steps, name, sign * change) for sign in (-1.0, 1.0)]
        if ends[0] is None or ends[1] is None:
            kinks += 1
            continue
        before, after = vector(ends[0]), vector(ends[1])
        found = np.concatenate([[getattr(derivative.loads, load) for load in LOADS], derivative.pressure, derivative.shear])
        difference = abs((after - before) / (2.0 * VARIATION) - found * abs(parameters[name])) / size
        kinks += any(
            end.loads.events != case.loads.events or not np.array_equal(end["state/status"], case["state/status"])
            for end in ends
            if end is not None
        )
        if difference.max() > worst:
            worst, culprit = float(difference.max()), name
    solves = derivative.loads.linear_solves / len(parameters) / case.loads.linear_solves
    return Outcome(worst, culprit, len(parameters), kinks, case.loads.events, solves)


def main() -> None:
    scenes, first = (int(word) for word in [*sys.argv[1:], "200", "1"][:2]) if len(sys.argv) != 2 else (int(sys.argv[1]), 1)
    outcomes = []
    for number in range(first, first + scenes):
        outcome = compared(number)
        if outcome is None:
            print(f"{number:4d} ends early")
            continue
        outcomes.append(outcome)
        print(
            f"{number:4d} {outcome.largest:.1e} {outcome.parameter:24s} {outcome.parameters:2d} parameters, "
            f"{outcome.kinks} with a kink, {outcome.events:4d} events, solves {outcome.solves:.2f}"
        )
    smooth = sorted(outcome.largest for outcome in outcomes if not outcome.kinks)
    print(f"{len(outcomes)} of {scenes} scenes complete, {sum(outcome.parameters for outcome in outcomes)} parameters")
    print(f"{len(smooth)} without kinks: largest difference {smooth[-1]:.1e}, median {smooth[len(smooth) // 2]:.1e}")
    solves = [outcome.solves for outcome in outcomes]
    print(f"solves for a parameter over those of the run: up to {max(solves):.2f}, mean {sum(solves) / len(solves):.2f}")


if __name__ == "__main__":
    main()
