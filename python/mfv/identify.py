"""Parameters of a scene from measured loops of tangential force and shift, with their uncertainty.

`fit` estimates keys of a scene (and the stiffness of the rig) from measured loops by least squares; `plan` predicts the uncertainty
that planned loops would leave; `simulate` makes synthetic loops. docs/identify.md has the method and its sources.
"""

from __future__ import annotations

import copy
import dataclasses
import math
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from numbers import Integral, Real
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from . import tables
from ._datum import datums_of, with_datums
from ._packages import needed
from .errors import MfvError, input_error
from .loop_checks import doubts_about
from .scene import Output, Scene, Step
from .studies.axes import Axis

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from .case import Case

Array = NDArray[np.float64]

#: The parameter that is no key of the scene: stiffness of the rig, in series with the contact [force/length^2].
RIG_STIFFNESS = "rig_stiffness"

#: Names of the columns of a table of measured loops, in lower case, and what they stand for.
_COLUMNS = {
    "tangential_force": ("tangential_force", "q"),
    "shift": ("shift", "u"),
    "normal_force": ("normal_force", "p"),
    "test": ("test",),
}

#: Annotations of keys whose values are real numbers.
_REAL = ("float", "float | None", "Coefficient | None")

#: Half the step of the central differences, in the logarithm of a parameter (docs/identify.md has the measurements).
_DIFFERENCE = 0.05

#: A parameter whose logarithm has a larger standard error than this is reported as not determined; from about here on intervals are
#: too narrow (docs/verification.md).
_UNDETERMINED = 0.15

#: Two parameters with a larger correlation than this are reported as not separated.
_CORRELATED = 0.98

#: Largest factor between a parameter and its start value.
_FARTHEST = 1.0e4

#: Residual of rows that the model cannot reach since it slides, in ranges of the column.
_UNREACHED = 10.0


@dataclass
class Loop:
    """One test at a constant normal force: rows of tangential force [force/length] and shift [length] in the order of time.

    The shift is that of the upper body relative to the lower one, with the deformation of the rig between the sensors, from any
    origin. `drive`: the column that the test machine prescribes. `force_noise`, `shift_noise`: standard deviations of independent
    errors of the columns, in their units; if omitted, they are estimated from second differences; 0 for an exact column.
    `cycles_before`: number of cycles between the extremes of the driven column before the first row; 0 if the rows begin with the
    first tangential load. `pressed_with_friction`: whether friction acts while the bodies are brought together.
    Raises InputError.
    """

    tangential_force: Array
    shift: Array
    normal_force: float
    drive: Literal["tangential_force", "shift"] = "tangential_force"
    force_noise: float | None = None
    shift_noise: float | None = None
    cycles_before: int = 1
    pressed_with_friction: bool = True
    name: str = "loop"

    def __post_init__(self) -> None:
        self.tangential_force = np.array(self.tangential_force, dtype=float)
        self.shift = np.array(self.shift, dtype=float)
        pressing = np.atleast_1d(np.asarray(self.normal_force, dtype=float))
        rows = self.tangential_force.size
        if self.tangential_force.ndim != 1 or self.shift.shape != (rows,) or rows < 5:
            raise input_error(f"{self.name}: needs two columns of equal length with at least 5 rows, tangential_force and shift")
        if not (np.isfinite(self.tangential_force).all() and np.isfinite(self.shift).all() and np.isfinite(pressing).all()):
            raise input_error(f"{self.name}: the columns must be finite numbers; remove the rows with gaps")
        self.normal_force = float(pressing.mean())
        if not self.normal_force > 0.0 or np.std(pressing) > 0.05 * self.normal_force:
            raise input_error(
                f"{self.name}: the normal force must be positive and constant to 5 %; split the record where it changes"
            )
        if self.drive not in ("tangential_force", "shift"):
            raise input_error(f"{self.name}: drive must be 'tangential_force' or 'shift', not {self.drive!r}")
        if not isinstance(self.cycles_before, Integral) or self.cycles_before < 0:
            raise input_error(f"{self.name}: cycles_before must be a whole number of at least 0")
        if not all(noise is None or (isinstance(noise, Real) and noise >= 0.0) for noise in (self.force_noise, self.shift_noise)):
            raise input_error(f"{self.name}: force_noise and shift_noise must be numbers of at least 0")

    @classmethod
    def planned(
        cls,
        normal_force: float,
        amplitude: float,
        *,
        rows: int = 200,
        drive: Literal["tangential_force", "shift"] = "tangential_force",
        force_noise: float = 0.0,
        shift_noise: float = 0.0,
        cycles_before: int = 1,
        **others: Any,
    ) -> Loop:
        """A test to be made: one cycle of the driven column between +`amplitude` and -`amplitude` in about `rows` equal increments,
        after the first loading if `cycles_before` is 0. The other column is empty until `simulate` or `plan` computes it."""
        quarters = np.array([0.0, 1.0, 0.0, -1.0, 0.0, 1.0] if cycles_before == 0 else [1.0, 0.0, -1.0, 0.0, 1.0])
        count = quarters.size - 1
        driven = amplitude * np.interp(
            np.linspace(0.0, count, count * max(round(rows / count), 1) + 1), np.arange(count + 1), quarters
        )
        force, shift = (driven, np.zeros(driven.size)) if drive == "tangential_force" else (np.zeros(driven.size), driven)
        return cls(force, shift, normal_force, drive, force_noise, shift_noise, cycles_before, **others)

    @property
    def _driven(self) -> Array:
        return self.tangential_force if self.drive == "tangential_force" else self.shift

    def _with_noise(self) -> Loop:
        """The loop with the noise of both columns; estimated where it is not given. Raises InputError."""
        force = _estimated_noise(self.tangential_force) if self.force_noise is None else self.force_noise
        shift = _estimated_noise(self.shift) if self.shift_noise is None else self.shift_noise
        response, name = (shift, "shift_noise") if self.drive == "tangential_force" else (force, "force_noise")
        if response == 0.0:
            raise input_error(f"{self.name}: the column that is not driven has no noise; give {name}")
        return dataclasses.replace(self, force_noise=force, shift_noise=shift)


def read(path: str | os.PathLike[str], **options: Any) -> list[Loop]:
    """The loops of a text file: columns Q, U and P (or tangential_force, shift, normal_force) under a line with their names, which may
    have units, as spreadsheets and programs write them (`mfv.tables`); a column `test` separates several tests. `options`: those of
    `loops_of`.

    Raises OSError, InputError.
    """
    columns = _names_of(options.get("columns"))
    optional = ["test", *(["normal_force"] if options.get("normal_force") is not None else [])]
    return _loops(tables.read_columns(path, columns, optional), **{"name": os.fspath(path), **options})


def loops_of(table: Any, **options: Any) -> list[Loop]:
    """The loops of a table: a mapping of columns, or a pandas.DataFrame.

    `columns`: names of columns (or for a file their numbers from 1) by their meaning, such as {'tangential_force': 'Fx', 'shift': 3}.
    `normal_force`: instead of a column P, force per thickness. `units`: units of columns by their meaning, if not in their names;
    numbers without any are taken as they are. `length_unit`, `force_unit` ('mm' and 'N'): those of the scene. `thickness`, in
    `length_unit`: divides columns that are forces. `sign`: factors of columns by their meaning, such as {'shift': -1}. Other options
    are those of every `Loop`. Raises InputError.
    """
    label = options.pop("name", "table")
    optional = ["test", *(["normal_force"] if options.get("normal_force") is not None else [])]
    return _loops(tables.columns_of(table, label, _names_of(options.get("columns")), optional), name=label, **options)


def _names_of(given: Mapping[str, str | int] | None) -> dict[str, Sequence[str] | int]:
    """Names of the columns of loops in lower case by their meaning. Raises InputError."""
    _check_meanings("columns", given)
    names: dict[str, Sequence[str] | int] = dict(_COLUMNS)
    for meaning, name in (given or {}).items():
        names[meaning] = name if isinstance(name, int) else (name.strip().lower(),)
    return names


def _check_meanings(option: str, given: Mapping[str, Any] | None) -> None:
    """Raises InputError for an option that is not a mapping of columns by their meaning."""
    for meaning in given or {}:
        if meaning not in _COLUMNS:
            raise input_error(f"{option}: '{meaning}' is not one of {', '.join(_COLUMNS)}")


def _loops(
    found: Mapping[str, tables.Column],
    *,
    name: str,
    columns: Mapping[str, str | int] | None = None,  # of `found`
    normal_force: float | None = None,
    units: Mapping[str, str] | None = None,
    length_unit: str = "mm",
    force_unit: str = "N",
    thickness: float | None = None,
    sign: Mapping[str, float] | None = None,
    **options: Any,
) -> list[Loop]:
    """The loops in columns by their meaning; options as in `loops_of`. Raises InputError."""
    for option, given in (("units", units), ("sign", sign)):
        _check_meanings(option, given)
    values = {}
    for meaning in ("tangential_force", "shift", "normal_force"):
        if meaning == "normal_force" and normal_force is not None:
            continue
        column = found[meaning]
        unit = (units or {}).get(meaning, column.unit)
        if meaning == "shift":
            scale = tables.factor(unit, length_unit) if unit else 1.0
        else:
            scale = _force_scale(column.label, unit or (force_unit if thickness else ""), length_unit, force_unit, thickness)
        values[meaning] = (sign or {}).get(meaning, 1.0) * scale * column.numbers()
    force, shift = values["tangential_force"], values["shift"]
    pressing = np.full(force.size, normal_force) if normal_force is not None else values["normal_force"]
    if "test" not in found:
        return [Loop(force, shift, pressing, name=name, **options)]  # type: ignore[arg-type]  # it takes the mean
    tests = np.asarray(found["test"].values)
    if "" in tests.tolist():
        raise input_error(f"{found['test'].label} has empty cells; give every row the name of its test")
    return [
        Loop(force[tests == test], shift[tests == test], pressing[tests == test], name=f"{name}: {test}", **options)
        for test in dict.fromkeys(tests.tolist())
    ]


def _force_scale(label: str, unit: str, length_unit: str, force_unit: str, thickness: float | None) -> float:
    """Forces per thickness of the scene per unit of a column. Raises InputError."""
    if not unit:
        return 1.0
    if tables.is_force(unit):
        if not thickness:
            raise input_error(
                f"{label}: is a force in {unit}, where the scene has forces per thickness; give the thickness in {length_unit}, "
                f"or the unit of the column if it is another, such as units={{'tangential_force': '{force_unit}/{length_unit}'}}"
            )
        return tables.factor(unit, force_unit) / thickness
    return tables.factor(unit, f"{force_unit}/{length_unit}")


@dataclass(repr=False)
class Estimate:
    """Parameters with the covariance that measured or planned loops leave.

    `names`: of the parameters; `values` by name; `covariance`: in this order and in the units of the parameters;
    `standard_errors` by name, infinite where the loops have no information; `warnings`: sentences.
    """

    names: list[str]
    values: dict[str, float]
    covariance: Array
    degrees_of_freedom: int
    warnings: list[str]

    @property
    def standard_errors(self) -> dict[str, float]:
        return dict(zip(self.names, np.sqrt(np.diag(self.covariance)).tolist()))

    @property
    def correlation(self) -> Array:
        """Correlations of the parameters; NaN where a standard error is infinite."""
        errors = np.sqrt(np.diag(self.covariance))
        with np.errstate(invalid="ignore"):
            return np.asarray(self.covariance / np.outer(errors, errors))

    def interval(self, name: str, level: float = 0.95) -> tuple[float, float]:
        """The confidence interval of a parameter, symmetric in its logarithm (Student's t)."""
        quantile = needed("scipy.special").stdtrit(self.degrees_of_freedom, 0.5 + 0.5 * level)
        relative = self.standard_errors[name] / self.values[name]
        with np.errstate(over="ignore"):
            factor = float(np.exp(quantile * relative))
        return self.values[name] / factor, self.values[name] * factor

    def __repr__(self) -> str:
        lines = [f"{'parameter':32} {'value':>11} {'std. error':>11}   95 % interval"]
        for name in self.names:
            low, high = self.interval(name)
            lines.append(f"{name:32} {self.values[name]:11.5g} {self.standard_errors[name]:11.2g}   {low:.4g} to {high:.4g}")
        for i, name in enumerate(self.names):
            lines += [f"correlation of {name} and {other}: {self.correlation[i, j]:.3f}" for j, other in enumerate(self.names[:i])]
        return "\n".join([*lines, *(f"warning: {warning}" for warning in self.warnings)])


@dataclass(repr=False)
class Fit(Estimate):
    """The estimate from measured loops. `loops`: with their noise; `residuals`: of every loop, distances from the model in standard
    deviations, positive where the shift is larger; `curves`: the model, an array (2, n) of tangential force and shift for every
    branch of every loop; `chi_squared`: reduced by the degrees of freedom, 1 for a right model and right noise."""

    loops: list[Loop] = field(default_factory=list)
    residuals: list[Array] = field(default_factory=list)
    curves: list[list[Array]] = field(default_factory=list)
    chi_squared: float = math.nan
    _problem: Any = None
    _x: Any = None

    def sample(self, steps: int = 1000, *, walkers: int | None = None, spread: float = 10.0, seed: int = 0) -> Array:
        """Posterior samples, an array (samples, parameters) in the order of `names`; needs emcee.

        The prior is uniform in the logarithm of every parameter, up to the factor `spread` above and below the estimate. The first
        fifth of the `steps` of every walker is discarded. A step costs a simulation of all loops for every walker (by default two
        more than twice the unknowns). Raises ModuleNotFoundError.
        """
        emcee = needed("emcee")
        problem, centre = self._problem, self._x
        count = len(self.names)
        limit = math.log(spread)
        walkers = 2 * centre.size + 2 if walkers is None else walkers
        scale = 1.0 if problem.noise_is_given else self.chi_squared

        def log_posterior(x: Array) -> float:
            if np.max(np.abs(x[:count] - centre[:count])) > limit or not problem.reaches(x):
                return -math.inf
            residuals = problem.residuals(x)
            return -0.5 * float(residuals @ residuals) / scale

        random = np.random.default_rng(seed)
        width = np.minimum(0.5 * problem.standard_errors(centre), 0.2)
        start = centre + width * random.standard_normal((walkers, centre.size))
        sampler = emcee.EnsembleSampler(walkers, centre.size, log_posterior)
        sampler.random_state = np.random.RandomState(seed).get_state()
        sampler.run_mcmc(start, steps)
        return np.asarray(np.exp(sampler.get_chain(discard=steps // 5, flat=True)[:, :count]))

    def figure(self) -> Figure:
        """A picture with a column for every loop: measured rows and model, the same without the line of the stick stiffness, which
        hides a thin loop, and the residuals."""
        from matplotlib import pyplot

        figure, axes = pyplot.subplots(
            3, len(self.loops), figsize=(4.2 * len(self.loops), 8.4), squeeze=False, layout="constrained"
        )
        for (above, middle, below), loop, residuals, branches in zip(axes.T, self.loops, self.residuals, self.curves):
            force, shift = np.concatenate(branches, axis=1)
            steps = np.diff(branches[-1], axis=1)
            slope = next(step[1] / step[0] for step in steps.T if abs(step[0]) > 1e-6 * np.ptp(force))  # sticks after the reversal
            for ax, line in ((above, 0.0), (middle, slope)):
                ax.plot(loop.shift - line * loop.tangential_force, loop.tangential_force, ".", ms=3, label="measured")
                ax.plot(shift - line * force, force, "-", lw=1, label="model")
            below.plot(residuals, ".", ms=3)
            below.axhline(0.0, color="black", lw=0.6)
            above.set(title=loop.name, xlabel="shift U", ylabel="tangential force Q")
            middle.set(xlabel=f"U - {slope:.3g} Q", ylabel="tangential force Q")
            below.set(xlabel="row", ylabel="residual over standard deviation")
            above.legend(frameon=False)
            for ax in (above, middle):
                ax.locator_params(nbins=5)
                ax.ticklabel_format(axis="x", scilimits=(-2, 3))
        figure.suptitle("   ".join(f"{name} = {self.values[name]:.4g} ± {self.standard_errors[name]:.2g}" for name in self.names))
        return figure


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
    problem = _Problem(scene, [loop._with_noise() for loop in _listed(loops)], free, rig_stiffness)
    problem.noise_is_given = all(None not in (loop.force_noise, loop.shift_noise) for loop in _listed(loops))
    start = problem.start()
    suspicions = [sentence for loop in problem.loops for sentence in _suspicions(problem, loop)]
    if not problem.reaches(start):
        raise input_error("; ".join([_ended_early(problem), *suspicions]))
    found = optimize.least_squares(problem.residuals, start, jac=problem.jacobian, x_scale="jac", xtol=1e-6, ftol=1e-9, max_nfev=60)
    residuals = problem.residuals(found.x)
    freedom = residuals.size - found.x.size
    reduced = float(residuals @ residuals) / max(freedom, 1)
    estimate = problem.estimate(found.x, found.jac, 1.0 if problem.noise_is_given else reduced)
    rows = [problem.distances(found.x, number) for number in range(len(problem.loops))]
    warnings = suspicions + estimate.warnings + _doubts(found, residuals.size, freedom, reduced, rows, problem)
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
    problem = _Problem(scene, simulate(scene, given, values, rig_stiffness=rig_stiffness), values, rig_stiffness)
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
    problem = _Problem(scene, exact, values, rig_stiffness)
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


# --- the driven column: extremes and branches ---


@dataclass
class _Path:
    """The driven column as a path between levels. `levels`: distinct values of extremes, with `errors`, their standard errors;
    `turns`: index of the level at the end of every branch, the last branch included; `before`: levels passed before the first row;
    `branch`: of every row, from 0."""

    levels: Array
    errors: Array
    turns: list[int]
    before: list[int]
    branch: NDArray[np.int64]


def _estimated_noise(column: Array) -> float:
    """Standard deviation of independent errors, from the median of the second differences, which ignores the turning points
    (Gasser, Sroka and Jennen-Steinmetz 1986, made robust)."""
    differences = column[:-2] - 2.0 * column[1:-1] + column[2:]
    return 1.4826 * float(np.median(np.abs(differences - np.median(differences)))) / math.sqrt(6.0)


def _reversals(driven: Array, threshold: float) -> list[int]:
    """Rows of the extremes between which the column changes by more than a threshold."""
    found: list[int] = []
    low = high = 0
    direction = 0
    for row, value in enumerate(driven):
        low = row if value < driven[low] else low
        high = row if value > driven[high] else high
        if direction >= 0 and driven[high] - value > threshold:
            found += [high] if direction > 0 or driven[high] - driven[0] > threshold else []
            direction, low = -1, row
        elif direction <= 0 and value - driven[low] > threshold:
            found += [low] if direction < 0 or driven[0] - driven[low] > threshold else []
            direction, high = 1, row
    return found


def _with_ends(driven: Array, rows: list[int], threshold: float) -> list[int]:
    """Reversals, completed by those that the record begins shortly after or ends shortly behind: turns by more than a threshold."""
    if not rows:
        return rows
    first = int(np.argmax(np.abs(driven[: rows[0]] - driven[rows[0]]))) if rows[0] > 0 else 0
    last = rows[-1] + int(np.argmax(np.abs(driven[rows[-1] :] - driven[rows[-1]])))
    begins = abs(driven[0] - driven[first]) > threshold
    ends = abs(driven[-1] - driven[last]) > threshold
    return ([first] if begins else []) + rows + ([last] if ends else [])


def _path_of(loop: Loop) -> _Path:
    """The path of the driven column. Raises InputError."""
    driven = loop._driven
    noise = (loop.force_noise if loop.drive == "tangential_force" else loop.shift_noise) or 0.0
    amplitude = float(np.ptp(driven))
    rows = _with_ends(driven, _reversals(driven, max(8.0 * noise, 0.05 * amplitude)), max(8.0 * noise, 0.005 * amplitude))
    if amplitude <= 10.0 * noise:
        raise input_error(f"{loop.name}: the driven column changes by less than ten times its noise")
    ends = [0, *rows, driven.size - 1]
    branch = np.searchsorted(np.array(rows), np.arange(driven.size), side="left")
    extremes = [_level(driven, ends, number, noise) for number in range(1, len(ends))]
    if loop.cycles_before > 0:
        extremes.insert(0, _level(driven, ends, 0, noise))
    levels: list[list[tuple[float, float]]] = []
    index = []
    for value, error in extremes:
        near = [n for n, level in enumerate(levels) if abs(level[0][0] - value) <= max(4.0 * noise, 1e-9 * amplitude)]
        if not near:
            levels.append([])
        index.append(near[0] if near else len(levels) - 1)
        levels[index[-1]].append((value, error))
    errors = np.array([1.0 / math.sqrt(sum(1.0 / error**2 for _, error in level)) if noise else 0.0 for level in levels])
    weights = [[1.0 / error**2 if noise else 1.0 for _, error in level] for level in levels]
    means = np.array([np.average([value for value, _ in level], weights=weight) for level, weight in zip(levels, weights)])
    before: list[int] = []
    if loop.cycles_before > 0:
        first = index.pop(0)
        upper, lower = int(np.argmax(means)), int(np.argmin(means))
        rises = means[index[0]] > means[first]
        before = [upper, lower] * loop.cycles_before if rises else [lower, upper] * loop.cycles_before
    return _Path(means, errors, index, before, branch)


def _level(driven: Array, ends: list[int], number: int, noise: float) -> tuple[float, float]:
    """The value of the driven column at an end of a branch, and its standard error.

    The maximum of noisy rows is biased outwards. Instead, a corner, value + c1 |row - end| + c2 (row - end)^2, and a smooth
    maximum, value + c2 (row - end)^2 + c4 (row - end)^4, are fitted to a third of the branches on either side; the better one counts.
    """
    row = ends[number]
    if noise == 0.0:
        return float(driven[row]), 0.0
    reach = [max(3, (ends[n + 1] - ends[n]) // 3) for n in range(max(number - 1, 0), min(number + 1, len(ends) - 1))]
    reach = [0, *reach] if number == 0 else [*reach, 0] if number == len(ends) - 1 else reach
    window = np.arange(max(row - reach[0], 0), min(row + reach[1] + 1, driven.size))
    if window.size < 6:
        return float(driven[row]), noise
    best = (math.inf, 0.0, 0.0)
    shifts = (0.0,) if 0 in reach else np.linspace(-0.25, 0.25, 21) * max(min(reach), 4)
    for shift in shifts:
        distance = np.abs(window - row - shift) / window.size
        for powers in ((1, 2), (2, 4)):
            basis = np.stack([np.ones(window.size), *(distance**power for power in powers)], axis=1)
            coefficients = np.linalg.lstsq(basis, driven[window], rcond=None)[0]
            error = noise * math.sqrt(np.linalg.inv(basis.T @ basis)[0, 0])
            misfit = float(np.sum((driven[window] - basis @ coefficients) ** 2))
            best = min(best, (misfit, float(coefficients[0]), error))
    return best[1], best[2]


# --- the model ---


class _Problem:
    """Residuals of loops as a function of the unknowns.

    These are the logarithms of the parameters, then for every loop the origin of its shift over the range of the shift, and the
    levels of a noisy driven column as deviations from their estimates over their standard errors.
    """

    def __init__(self, scene: Scene, loops: list[Loop], free: Mapping[str, float | Axis], rig_stiffness: float) -> None:
        """Raises InputError."""
        if not free or not loops:
            raise input_error("give at least one loop and one free parameter such as {'friction%mu': 0.5}")
        pressed = copy.copy(scene)
        pressed.steps = [*scene.steps, Step(normal_force=max(loop.normal_force for loop in loops))]
        #: Default datums of wedges and power laws, which otherwise would be those of the normal force of every loop.
        self.datums = datums_of(pressed)
        self.scene, self.loops, self.rig_stiffness = with_datums(scene, self.datums), loops, rig_stiffness
        self.axes = {name: value if isinstance(value, Axis) else Axis(name, [value]) for name, value in free.items()}
        self.names = list(free)
        self.start_values = np.array([_start(name, axis) for name, axis in self.axes.items()])
        self.paths = [_path_of(loop) for loop in loops]
        self.ranges = [max(float(np.ptp(loop.shift)), 1e-300) for loop in loops]
        self.noise_is_given = False
        #: How the model ended before the last row at the last values with which it did.
        self.early_end = ""
        self._known: dict[tuple[Any, ...], list[Array] | None] = {}
        place = len(self.names)
        #: Places of the origin of the shift and of the levels of every loop among the unknowns.
        self.places: list[tuple[int, slice]] = []
        for path in self.paths:
            count = path.levels.size if path.errors.any() else 0
            self.places.append((place, slice(place + 1, place + 1 + count)))
            place += 1 + count
        self.count = place
        self._scene_for(self.start_values, loops[0])

    def start(self) -> Array:
        """The unknowns at the start values; the origins of the shift from the means of rows and model."""
        x = np.zeros(self.count)
        x[: len(self.names)] = np.log(self.start_values)
        for number, loop in enumerate(self.loops):
            if loop.drive == "tangential_force" and (branches := self.curves(x, number)):
                x[self.places[number][0]] = np.mean(loop.shift - self._interpolated(loop, branches, number)) / self.ranges[number]
            elif loop.drive == "shift":
                x[self.places[number][0]] = self._middle(number)
        return x

    def _middle(self, number: int) -> float:
        """About the origin of a prescribed shift, over its range: the middle of cycles, or where the first loading begins."""
        path, loop = self.paths[number], self.loops[number]
        middle = 0.5 * (path.levels.max() + path.levels.min()) if path.before else loop.shift[0]
        return float(middle) / self.ranges[number]

    def residuals(self, x: Array) -> Array:
        """All residuals: of the rows, of the levels, and of the origin of a prescribed shift.

        After sliding to both sides the contact does not depend on that origin; it is known to a range of the shift.
        """
        parts = [self.distances(x, number) for number in range(len(self.loops))]
        parts += [x[levels] for _, levels in self.places]
        prescribed = [number for number, loop in enumerate(self.loops) if loop.drive == "shift"]
        return np.concatenate([*parts, [x[self.places[number][0]] - self._middle(number) for number in prescribed]])

    def jacobian(self, x: Array) -> Array:
        """Central differences; one-sided where the other side slides."""
        here = self.residuals(x)
        columns = []
        for place in range(x.size):
            step = np.zeros(x.size)
            step[place] = _DIFFERENCE if place < len(self.names) else 1e-3 if place in {first for first, _ in self.places} else 0.5
            ahead, behind = ((x + sign * step if self.reaches(x + sign * step) else x) for sign in (1.0, -1.0))
            distance = ahead[place] - behind[place]
            columns.append((self.residuals(ahead) - self.residuals(behind)) / distance if distance > 0.0 else np.zeros(here.size))
        return np.stack(columns, axis=1)

    def reaches(self, x: Array) -> bool:
        """Whether the model reaches all rows; it does not with gross sliding under a prescribed force."""
        return all(self.curves(x, number) is not None for number in range(len(self.loops)))

    def distances(self, x: Array, number: int) -> Array:
        """Residuals of the rows of a loop: signed distances from the branch of the model in the plane of the columns, each over its
        standard deviation; vertical ones if the driven column is exact."""
        loop, path = self.loops[number], self.paths[number]
        force_noise, shift_noise = loop.force_noise or 0.0, loop.shift_noise or 0.0
        branches = self.curves(x, number)
        if branches is None:
            column, noise = (loop.shift, shift_noise) if loop.drive == "tangential_force" else (loop.tangential_force, force_noise)
            return np.full(column.size, _UNREACHED * np.ptp(column) / noise)
        result = np.empty(loop.shift.size)
        for branch, points in enumerate(branches):
            rows = path.branch == branch
            force, shift = loop.tangential_force[rows], loop.shift[rows]
            if loop.drive == "tangential_force" and force_noise == 0.0:
                result[rows] = (shift - _extended(force, points[0], points[1])) / shift_noise
            elif loop.drive == "shift" and shift_noise == 0.0:
                result[rows] = (_extended(shift, points[1], points[0]) - force) / force_noise
            else:
                scales = np.array([[force_noise or 1e-9 * np.ptp(points[0])], [shift_noise or 1e-9 * np.ptp(points[1])]])
                result[rows] = _signed_distance(np.stack([force, shift]) / scales, points / scales)
        return result

    def response(self, x: Array, number: int) -> Array | None:
        """The column of a loop that is not driven, by the model; None if it ends early."""
        branches = self.curves(x, number)
        return None if branches is None else self._interpolated(self.loops[number], branches, number)

    def _interpolated(self, loop: Loop, branches: list[Array], number: int) -> Array:
        result = np.empty(loop.shift.size)
        for branch, points in enumerate(branches):
            rows = self.paths[number].branch == branch
            driven, other = (0, 1) if loop.drive == "tangential_force" else (1, 0)
            result[rows] = _extended(loop._driven[rows], points[driven], points[other])
        return result

    def curves(self, x: Array, number: int) -> list[Array] | None:
        """The branches of a loop by the model, arrays (2, n) of tangential force and measured shift; None if it ends early."""
        loop, path = self.loops[number], self.paths[number]
        place, span = self.places[number]
        origin = x[place] * self.ranges[number]
        steps = x[: len(self.names)] - np.log(self.start_values)
        if np.max(np.abs(steps)) > math.log(_FARTHEST):
            self.early_end = f"{self.names[int(np.argmax(np.abs(steps)))]} is far from its start value"
            return None
        values = np.exp(x[: len(self.names)])
        levels = path.levels + path.errors * x[span] if span.stop > span.start else path.levels
        rig = values[self.names.index(RIG_STIFFNESS)] if RIG_STIFFNESS in self.names else self.rig_stiffness
        of_scene = [value for name, value in zip(self.names, values) if name != RIG_STIFFNESS]
        targets = levels if loop.drive == "tangential_force" else levels - origin
        # With a prescribed force, the stiffness of the rig does not change the state of the contact.
        key = (number, *of_scene, *targets, *([rig] if loop.drive == "shift" else []))
        if key not in self._known:
            if len(self._known) > 2000:
                self._known.clear()
            self._known[key] = self._solved(
                values, loop, [float(targets[n]) for n in [*path.before, *path.turns]], rig, len(path.turns)
            )
        contact = self._known[key]
        return None if contact is None else [np.stack([force, shift + force / rig + origin]) for force, shift in contact]

    def _scene_for(self, values: Array, loop: Loop) -> Scene:
        """The scene with values of the parameters, pressed with the force of a loop. Raises InputError."""
        scene = copy.copy(self.scene)
        for part in ("lower", "upper", "friction", "mesh", "solver"):
            setattr(scene, part, copy.copy(getattr(scene, part)))
        if scene.solver is not None:
            scene.solver.accuracy = scene.solver.stepping = None  # rows are interpolated between events
        scene.steps = [Step(normal_force=loop.normal_force, friction=loop.pressed_with_friction)]
        scene.output = Output(history="events", states="none")
        parts: dict[str, Any] = dict(scene._parts())
        for axis, value in zip(self.axes.values(), values):
            keys = [axis.keys] if isinstance(axis.keys, str) else list(axis.keys)
            for key, factor in zip(keys, axis.factors or [1.0] * len(keys)):
                group, _, name = key.partition("%")
                if key == RIG_STIFFNESS:
                    continue
                if group not in parts or group.startswith("step"):
                    raise input_error(
                        f"'{key}': no such parameter; free are keys of bodies, friction and mesh, and {RIG_STIFFNESS}"
                    )
                if parts[group]._group().__annotations__.get(name, "float") not in _REAL:
                    raise input_error(f"'{key}': cannot be estimated, since its values are not real numbers")
                try:
                    setattr(parts[group], name, float(value) * factor)
                except AttributeError as error:
                    raise input_error(f"'{key}': {error}") from None
        return scene

    def _solved(self, values: Array, loop: Loop, targets: list[float], rig: float, count: int) -> list[Array] | None:
        """Tangential force and shift of the contact along the last `count` branches to the targets; None if it ends early."""
        try:
            contact = self._scene_for(values, loop).contact()
        except MfvError as error:  # the least squares may try a value that is not permitted
            self.early_end = f"{loop.name}: {error}"
            return None
        with contact:
            contact.run()
            for target in targets:
                if loop.drive == "tangential_force":
                    contact.advance(tangential_force=target)
                else:
                    _advance_with_rig(contact, target, rig)
            if contact.outcome != "complete":  # it stays after an early end
                self.early_end = f"{loop.name}: {contact.message}"
                return None
            step = contact["history/step"]
            rows = np.stack([contact["history/tangential_force"], contact["history/shift"]])
        last = int(step[-1])
        ends = np.searchsorted(step, np.arange(last - count, last + 1), side="right")
        return [rows[:, ends[n] - 1 : ends[n + 1]] for n in range(count)]

    def standard_errors(self, x: Array) -> Array:
        """Standard errors of all unknowns."""
        jacobian = self.jacobian(x)
        return np.asarray(np.sqrt(np.diag(_inverse_information(jacobian)[0])))

    def estimate(self, x: Array, jacobian: Array, scale: float) -> Estimate:
        """The estimate at the unknowns; the covariance is multiplied by a scale."""
        covariance, lost = _inverse_information(jacobian)
        count = len(self.names)
        values = np.exp(x[:count])
        relative = scale * covariance[:count, :count]
        estimate = Estimate(
            self.names,
            dict(zip(self.names, values.tolist())),
            relative * np.outer(values, values),
            max(jacobian.shape[0] - x.size, 1),
            [],
        )
        if self.datums:
            estimate.warnings.append(
                f"the datum of the displacements, {max(self.datums.values()):.4g}, is the default for the largest normal force of the "
                f"scene and its loops: {RIG_STIFFNESS} is valid with it only; give datum to compare with other fits"
            )
        estimate.warnings += self._undetermined(estimate, np.sqrt(np.diag(relative)), lost[:count])
        return estimate

    def _undetermined(self, estimate: Estimate, relative: Array, lost: NDArray[np.bool_]) -> list[str]:
        """Sentences about what the loops do not determine."""
        sentences = []
        for name, error, is_lost in zip(self.names, relative, lost):
            if is_lost or not error <= _UNDETERMINED:
                low, high = estimate.interval(name)
                why = "the loops do not depend on it separately" if is_lost else f"95 % interval from {low:.3g} to {high:.3g}"
                sentences.append(f"{name} is not determined ({why}){self._advice(name, estimate.values)}")
        for i, name in enumerate(self.names):
            for j, other in enumerate(self.names[:i]):
                if abs(estimate.correlation[i, j]) > _CORRELATED:
                    sentences.append(
                        f"{other} and {name} are not separated (correlation {estimate.correlation[i, j]:.3f}): "
                        "fix one of them, or add a test that changes their effect differently"
                    )
        return sentences

    def _advice(self, name: str, values: Mapping[str, float]) -> str:
        """What would determine a coefficient of friction."""
        if name not in ("friction%mu", "friction%mu_static"):
            return ""
        ratio = max(np.max(np.abs(loop.tangential_force)) / loop.normal_force for loop in self.loops) / values[name]
        return (
            f": the loops reach Q/(mu P) = {ratio:.2g}; add a test with a larger force, best into gross sliding "
            "(mfv.identify.plan predicts what it determines)"
        )


def _advance_with_rig(contact: Case, target: float, rig: float) -> None:
    """Prescribe the sum of the shift and of the deformation of the rig."""
    if math.isinf(rig):
        contact.advance(shift=target)
        return
    before = contact.save()
    first = len(contact["history/step"]) - 1
    loads = contact.loads
    reached = loads.shift + loads.tangential_force / rig
    # The rig takes a part of the motion, so this goes beyond the target; between events the response is linear.
    if contact.advance(shift=loads.shift + target - reached) != "complete":
        return
    shift, force = contact["history/shift"][first:], contact["history/tangential_force"][first:]
    total = shift + force / rig
    order = 1.0 if target > reached else -1.0
    wanted = float(np.interp(order * target, order * total, shift))
    contact.restore(before)
    contact.advance(shift=wanted)


# --- numbers ---


def _extended(x: Array, points: Array, values: Array) -> Array:
    """Linear interpolation between points in either order, continued beyond the ends."""
    if points[0] > points[-1]:
        points, values = points[::-1], values[::-1]
    distinct = np.concatenate([[True], np.diff(points) > 1e-14 * np.ptp(points)])
    points, values = points[distinct], values[distinct]
    segment = np.clip(np.searchsorted(points, x) - 1, 0, points.size - 2)
    slope = np.diff(values) / np.diff(points)
    return np.asarray(values[segment] + slope[segment] * (x - points[segment]))


def _signed_distance(rows: Array, points: Array) -> Array:
    """Distance of rows (2, n) from a line through points (2, m) in a plane, its ends continued.

    Positive where the second coordinate of the rows is larger, for an increasing line.
    """
    step = np.diff(points, axis=1)
    length = np.hypot(step[0], step[1])
    kept = length > 1e-12 * length.max()
    origin, step, length = points[:, :-1][:, kept], step[:, kept], length[kept]
    along = step / length
    offset = rows[:, :, None] - origin[:, None, :]
    position = np.einsum("irk,ik->rk", offset, along)
    low = np.where(np.arange(length.size) == 0, -np.inf, 0.0)
    high = np.where(np.arange(length.size) == length.size - 1, np.inf, length)
    foot = np.clip(position, low, high)
    gap = offset - foot * along[:, None, :]
    nearest = np.argmin(np.einsum("irk,irk->rk", gap, gap), axis=1)
    row = np.arange(rows.shape[1])
    chosen = gap[:, row, nearest]
    direction = along[:, nearest] * np.where(along[0, nearest] + along[1, nearest] < 0.0, -1.0, 1.0)
    side = direction[0] * chosen[1] - direction[1] * chosen[0]
    return np.asarray(np.sign(side) * np.hypot(chosen[0], chosen[1]))


def _inverse_information(jacobian: Array) -> tuple[Array, NDArray[np.bool_]]:
    """The inverse of the information matrix, and which unknowns it does not determine; their variances are infinite."""
    norms = np.linalg.norm(jacobian, axis=0)
    scale = np.where(norms > 0.0, norms, 1.0)
    _, singular, directions = np.linalg.svd(jacobian / scale, full_matrices=False)
    is_null = singular < 1e-7 * singular[0]
    lost = (norms == 0.0) | np.any(np.abs(directions[is_null]) > 1e-3, axis=0)
    inverse = 1.0 / np.where(is_null, np.inf, singular)
    covariance = (directions.T * inverse**2) @ directions / np.outer(scale, scale)
    covariance[lost, lost] = np.inf
    return covariance, lost


def _doubts(found: Any, rows: int, freedom: int, reduced: float, residuals: list[Array], problem: _Problem) -> list[str]:
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


def _suspicions(problem: _Problem, loop: Loop) -> list[str]:
    """Sentences about wrong units, signs or columns of a loop, by comparison with the contact at the start values."""
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
    driven = loop._driven
    turns = _reversals(driven, max(8.0 * _estimated_noise(driven), 0.05 * float(np.ptp(driven))))
    with_rig = 1.0 / (1.0 / of_contact + 1.0 / rig)
    return doubts_about(
        loop.name, loop.tangential_force, loop.shift, float(loop.normal_force), turns, noise, (of_contact, with_rig)
    )


def _start(name: str, axis: Axis) -> float:
    """The start value of a parameter. Raises InputError."""
    values = list(axis.values)
    if len(values) != 1 or isinstance(values[0], bool) or not isinstance(values[0], (int, float)) or not 0.0 < values[0] < math.inf:
        raise input_error(f"'{name}': needs one positive start value, not {values if len(values) != 1 else values[0]!r}")
    return float(values[0])


def _ended_early(problem: _Problem) -> str:
    """The message about values of the parameters with which the model does not reach all rows."""
    return (
        f"with these values of the parameters the model ends before the last row ({problem.early_end}); "
        "start with a larger coefficient of friction, or use drive='shift' for tests with gross sliding"
    )


def _listed(loops: Loop | Sequence[Loop]) -> list[Loop]:
    return [loops] if isinstance(loops, Loop) else list(loops)
