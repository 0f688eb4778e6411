"""Fit, plan and simulate loops."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._packages import needed
from ..errors import MfvError, input_error
from ..loop_checks import doubts_about
from ..scene import Scene
from ..studies.axes import Axis
from .estimate import Estimate, Fit
from .loop import Loop
from .path import about_spikes, path_of
from .priors import NAMES, Priors, RigError
from .problem import LEAST_ROWS, RIG_STIFFNESS, Problem

Array = NDArray[np.float64]

#: A row is not used if it is farther from the model than this many robust standard deviations, and its neighbours are not.
OUTLIER = 5.0

#: Systematic errors of more than this many standard errors are reported.
SIGNIFICANT = 3.0

#: What a systematic error does.
_ADVICE = {
    "lag": "the shift lags behind the force by {} (filters, or columns sampled one after the other)",
    "drift": "the loop does not close: the shift drifts in a cycle by {} of half its range (temperature, wear, creeping sensors)",
    "offset": "the zero of the force is offset by {} of half its range (load cell, or a mean force)",
    "slack": "slack (play) in series with the contact: where the force changes its sign the shift jumps by {} of half its range",
}


def fit(
    scene: Scene,
    loops: Loop | Sequence[Loop],
    free: Mapping[str, float | Axis],
    *,
    rig_stiffness: float = math.inf,
    priors: Priors = Priors(),  # noqa: B008  # it is frozen
) -> Fit:
    """Estimate parameters of a scene from measured loops.

    `free`: start values by key, such as {'friction%mu': 0.5, 'rig_stiffness': 1e4}; for keys that change together, a name with an
    Axis of the keys and one start value. All must be positive. `rig_stiffness` [force/length^2]: of what deforms in series with the
    contact, unless it is free. The steps of the scene are not used, nor `accuracy` and `stepping` of its solver: every loop presses
    with its normal force and follows the events of its driven column. Unknown besides are the origin of the shift of every loop; its
    lag, drift and offset as the `priors` permit, if it has at least LEAST_ROWS rows in both directions; and if the driven column is
    noisy, its extremes. Spikes are not used.
    Needs scipy. Raises InputError for invalid keys or start values, and for start values with which the contact slides too early.
    """
    prepared = [loop._prepared() for loop in _listed(loops)]
    problem = Problem(scene, [loop for loop, _ in prepared], [path for _, path in prepared], free, rig_stiffness, priors)
    problem.noise_is_given = all(None not in (loop.force_noise, loop.shift_noise) for loop in _listed(loops))
    start = problem.start()
    suspicions = [sentence for number in range(len(problem.loops)) for sentence in _suspicions(problem, number)]
    if not problem.reaches(start):
        raise input_error("; ".join([_ended_early(problem), *suspicions]))
    found = problem.solve(start)
    outliers = _outliers(problem, found.x)
    for used, far in zip(problem.is_used, outliers):
        used &= ~far
    if not problem.noise_is_given:
        problem.scale = _reduced(problem, found.x)
    if any(far.any() for far in outliers) or problem.scale != 1.0:
        found = problem.solve(found.x)
    reduced = _reduced(problem, found.x) * problem.scale
    estimate = problem.estimate(found.x, found.jac)
    rows = [problem.distances(found.x, number) for number in range(len(problem.loops))]
    warnings = suspicions + estimate.warnings + [sentence for _, path in prepared for sentence in path.warnings]
    warnings += [about_spikes(loop, far) for loop, far in zip(problem.loops, outliers) if far.any()]
    warnings += _about_the_rig(problem, found, estimate)
    warnings += _doubts(found, reduced, rows, problem)
    numbers = range(len(problem.loops))
    corrected = []
    for number, loop in enumerate(problem.loops):
        force, shift, _ = problem.corrected(found.x, number)
        corrected.append(dataclasses.replace(loop, tangential_force=force, shift=shift))
    fitted = dataclasses.replace(estimate, warnings=warnings)
    return Fit(
        **vars(fitted),
        loops=problem.loops,
        residuals=rows,
        curves=[problem.curves(found.x, number) or [] for number in numbers],
        corrected=corrected,
        chi_squared=reduced,
        _problem=problem,
        _x=found.x,
    )


def plan(
    scene: Scene,
    loops: Loop | Sequence[Loop],
    values: Mapping[str, float | Axis],
    *,
    rig_stiffness: float = math.inf,
    priors: Priors = Priors(),  # noqa: B008  # it is frozen
) -> Estimate:
    """The uncertainty of parameters that loops, measured or not, leave at the given values (inverse of the information matrix).

    `values` as `free` of `fit`. The loops must have their noise; their columns other than the driven one are not used, so that
    `Loop.planned` makes them. To see what a further test adds, give the measured loops too. Needs scipy. Raises InputError.
    """
    given = [loop._prepared()[0] for loop in _listed(loops)]
    made = simulate(scene, given, values, rig_stiffness=rig_stiffness)
    problem = Problem(scene, made, [path_of(loop) for loop in made], values, rig_stiffness, priors)
    problem.noise_is_given = True
    x = problem.start()
    return problem.estimate(x, problem.jacobian(x))


def simulate(
    scene: Scene,
    loops: Loop | Sequence[Loop],
    values: Mapping[str, float | Axis],
    *,
    rig_stiffness: float = math.inf,
    seed: int | None = None,
) -> list[Loop]:
    """The loops with the column that is not driven computed for the given values of parameters (as `free` of `fit`).

    With a `seed`, both columns have noise. Raises InputError.
    """
    random = None if seed is None else np.random.default_rng(seed)
    made = []
    exact = [dataclasses.replace(loop, force_noise=0.0, shift_noise=0.0) for loop in _listed(loops)]
    problem = Problem(scene, exact, [path_of(loop) for loop in exact], values, rig_stiffness, Priors())
    for number, loop in enumerate(_listed(loops)):
        response = problem.response(problem.start(), number)
        if response is None:
            raise input_error(_ended_early(problem))
        force, shift = (loop.tangential_force, response) if loop.drive == "tangential_force" else (response, loop.shift)
        if random is not None:
            force = force + (loop.force_noise or 0.0) * random.standard_normal(force.size)
            shift = shift + (loop.shift_noise or 0.0) * random.standard_normal(shift.size)
        made.append(dataclasses.replace(loop, tangential_force=force, shift=shift))
    return made


def _reduced(problem: Problem, x: Array) -> float:
    """Chi-squared over the degrees of freedom."""
    residuals = problem.residuals(x)
    return float(residuals @ residuals) / max(residuals.size - int(problem.active.sum()), 1)


def _outliers(problem: Problem, x: Array) -> list[NDArray[np.bool_]]:
    """Rows of every loop that are far from the model while their neighbours are not."""
    result = []
    for number, used in enumerate(problem.is_used):
        distance = np.abs(problem.distances(x, number))
        limit = OUTLIER * max(1.4826 * float(np.median(distance[used])), 1e-300)
        near = np.pad(np.where(used, distance, 0.0), 1)
        is_alone = np.maximum(near[:-2], near[2:]) < 0.6 * limit
        result.append(used & (distance > limit) & is_alone if distance.size >= LEAST_ROWS else np.zeros(distance.size, dtype=bool))
    return result


def _about_the_rig(problem: Problem, found: Any, estimate: Estimate) -> list[str]:
    """Sentences about systematic errors: those that were found, and those that were not looked for but are in the residuals."""
    sentences = []
    known = {(each.loop, each.name): (each.value, each.standard_error) for each in estimate.rig_errors}
    for number, loop in enumerate(problem.loops):
        if loop.shift.size < LEAST_ROWS or len(problem.paths[number].turns) < 2:
            continue
        for name in NAMES:
            is_unknown = (loop.name, name) in known
            if name == "offset" and not is_unknown:
                continue
            value, error = known[loop.name, name] if is_unknown else problem.score(found.x, found.jac, name, number)
            if abs(value) > SIGNIFICANT * error:
                size = RigError(loop.name, name, value, error).size
                sentences.append(f"{loop.name}: {_ADVICE[name].format(size)}" + _included(name, value, is_unknown))
    return sentences


def _included(name: str, value: float, is_unknown: bool) -> str:
    if is_unknown:
        return "; it is included in the fit"
    return f"; it is not included in the fit: give priors=Priors({name}={float(f'{2.0 * abs(value):.1g}'):g}), or remove its cause"


def _doubts(found: Any, reduced: float, residuals: list[Array], problem: Problem) -> list[str]:
    """Sentences about the quality of a fit."""
    tail = needed("scipy.special").chdtrc
    rows, unknowns = found.jac.shape
    freedom = rows - unknowns
    sentences = []
    if found.status <= 0:
        sentences.append("the least squares have not converged; choose other start values")
    if freedom <= 0:
        sentences.append(f"{rows} residuals do not determine {unknowns} unknowns")
    elif tail(freedom, reduced * freedom) < 1e-3:
        sentences.append(
            f"the model does not fit to within the noise (reduced chi-squared {reduced:.2f}); look at the residuals: "
            "standard errors do not include errors of the model"
        )
    for loop, all_values, used in zip(problem.loops, residuals, problem.is_used):
        values = all_values[used]
        correlation = float(np.sum(values[1:] * values[:-1]) / max(np.sum(values**2), 1e-300))
        if correlation > 0.2 + 3.0 / math.sqrt(values.size):
            sentences.append(
                f"{loop.name}: residuals of successive rows are correlated ({correlation:.2f}); standard errors are too small"
            )
    return sentences


def _suspicions(problem: Problem, number: int) -> list[str]:
    """Sentences about wrong units, signs or columns of a loop, by comparison with the contact at the start values."""
    loop = problem.loops[number]
    values = problem.start_values
    rig = float(values[problem.names.index(RIG_STIFFNESS)]) if RIG_STIFFNESS in problem.names else problem.rig_stiffness
    of_contact = math.nan
    try:
        with problem._scene_for(values, loop).contact() as contact:
            contact.run()
            before = contact.loads.shift
            force = 1e-3 * float(np.max(np.abs(loop.tangential_force)) or loop.normal_force)
            force = min(force, 1e-3 * loop.normal_force)
            if contact.advance(tangential_force=force) == "complete":
                of_contact = force / (contact.loads.shift - before)
    except MfvError:
        pass  # the fit reports it
    noise = (loop.force_noise or 0.0, loop.shift_noise or 0.0)
    turns = np.flatnonzero(np.diff(problem.paths[number].branch)).tolist()
    with_rig = 1.0 / (1.0 / of_contact + 1.0 / rig)
    return doubts_about(
        loop.name, loop.tangential_force, loop.shift, float(loop.normal_force), turns, noise, (of_contact, with_rig)
    )


def _ended_early(problem: Problem) -> str:
    """The message about values of the parameters with which the model does not reach all rows."""
    return (
        f"with these values of the parameters the model ends before the last row ({problem.early_end}); "
        "start with a larger coefficient of friction, or use drive='shift' for tests with gross sliding"
    )


def _listed(loops: Loop | Sequence[Loop]) -> list[Loop]:
    return [loops] if isinstance(loops, Loop) else list(loops)
