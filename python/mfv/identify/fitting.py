"""Fit, plan and simulate loops."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._packages import needed
from ..errors import input_error
from ..scene import Scene
from ..studies.axes import Axis
from .estimate import Estimate, Fit
from .loop import Loop
from .problem import Problem

Array = NDArray[np.float64]


def fit(
    scene: Scene,
    loops: Loop | Sequence[Loop],
    free: Mapping[str, float | Axis],
    *,
    rig_stiffness: float = math.inf,
) -> Fit:
    """Estimate parameters of a scene from measured loops.

    `free`: start values by key, such as {'friction%mu': 0.5, 'rig_stiffness': 1e4}; for keys that change together, a name with an
    Axis of the keys and one start value. All must be positive. `rig_stiffness` [force/length^2]: of what deforms in series with the
    contact, unless it is free. The steps of the scene are not used, nor `accuracy` and `stepping` of its solver: every loop presses
    with its normal force and follows the events of its driven column. Unknown besides are the origin of the shift of every loop and,
    if the driven column is noisy, its extremes.
    Needs scipy. Raises InputError for invalid keys or start values, and for start values with which the contact slides too early.
    """
    optimize = needed("scipy.optimize")
    problem = Problem(scene, [loop._with_noise() for loop in _listed(loops)], free, rig_stiffness)
    problem.noise_is_given = all(None not in (loop.force_noise, loop.shift_noise) for loop in _listed(loops))
    start = problem.start()
    if not problem.reaches(start):
        raise input_error(_ended_early(problem))
    found = optimize.least_squares(problem.residuals, start, jac=problem.jacobian, x_scale="jac", xtol=1e-6, ftol=1e-9, max_nfev=60)
    residuals = problem.residuals(found.x)
    freedom = residuals.size - found.x.size
    reduced = float(residuals @ residuals) / max(freedom, 1)
    estimate = problem.estimate(found.x, found.jac, 1.0 if problem.noise_is_given else reduced)
    rows = [problem.distances(found.x, number) for number in range(len(problem.loops))]
    warnings = estimate.warnings + _doubts(found, residuals.size, freedom, reduced, rows, problem)
    curves = [problem.curves(found.x, number) or [] for number in range(len(problem.loops))]
    fitted = dataclasses.replace(estimate, warnings=warnings)
    return Fit(
        **vars(fitted), loops=problem.loops, residuals=rows, curves=curves, chi_squared=reduced, _problem=problem, _x=found.x
    )


def plan(
    scene: Scene,
    loops: Loop | Sequence[Loop],
    values: Mapping[str, float | Axis],
    *,
    rig_stiffness: float = math.inf,
) -> Estimate:
    """The uncertainty of parameters that loops, measured or not, leave at the given values (inverse of the information matrix).

    `values` as `free` of `fit`. The loops must have their noise; their columns other than the driven one are not used, so that
    `Loop.planned` makes them. To see what a further test adds, give the measured loops too. Needs scipy. Raises InputError.
    """
    given = [loop._with_noise() for loop in _listed(loops)]
    problem = Problem(scene, simulate(scene, given, values, rig_stiffness=rig_stiffness), values, rig_stiffness)
    problem.noise_is_given = True
    x = problem.start()
    return problem.estimate(x, problem.jacobian(x), 1.0)


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
    problem = Problem(scene, exact, values, rig_stiffness)
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


def _doubts(found: Any, rows: int, freedom: int, reduced: float, residuals: list[Array], problem: Problem) -> list[str]:
    """Sentences about the quality of a fit."""
    tail = needed("scipy.special").chdtrc
    sentences = []
    if found.status <= 0:
        sentences.append("the least squares have not converged; choose other start values")
    if freedom <= 0:
        sentences.append(f"{rows} residuals do not determine {found.x.size} unknowns")
    elif tail(freedom, reduced * freedom) < 1e-3:
        sentences.append(
            f"the model does not fit to within the noise (reduced chi-squared {reduced:.2f}); look at the residuals: "
            "standard errors do not include errors of the model"
        )
    for loop, values in zip(problem.loops, residuals):
        correlation = float(np.sum(values[1:] * values[:-1]) / max(np.sum(values**2), 1e-300))
        if correlation > 0.2 + 3.0 / math.sqrt(values.size):
            sentences.append(
                f"{loop.name}: residuals of successive rows are correlated ({correlation:.2f}); standard errors are too small"
            )
    return sentences


def _ended_early(problem: Problem) -> str:
    """The message about values of the parameters with which the model does not reach all rows."""
    return (
        f"with these values of the parameters the model ends before the last row ({problem.early_end}); "
        "start with a larger coefficient of friction, or use drive='shift' for tests with gross sliding"
    )


def _listed(loops: Loop | Sequence[Loop]) -> list[Loop]:
    return [loops] if isinstance(loops, Loop) else list(loops)
