"""Parameters with their uncertainty."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .._packages import needed
from .loop import Loop
from .priors import RigError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Array = NDArray[np.float64]

#: A parameter whose logarithm has a larger standard error than this is reported as not determined; from about here on intervals
#: from standard errors are too narrow (docs/verification.md).
UNDETERMINED = 0.15


@dataclass(repr=False)
class Estimate:
    """Parameters with the covariance that measured or planned loops leave.

    `names`: of the parameters; `values` by name; `covariance`: in this order and in the units of the parameters;
    `standard_errors` by name, infinite where the loops have no information; `warnings`: sentences; `rig_errors`: lag, drift, offset
    and slack of every loop as far as they are unknowns; `sensitivities`: relative changes of the parameters by 0.1 degrees of lag
    and by 0.1 % of drift if these were not unknowns: a thin loop has large ones.
    """

    names: list[str]
    values: dict[str, float]
    covariance: Array
    degrees_of_freedom: int
    warnings: list[str]
    rig_errors: list[RigError] = field(default_factory=list)
    sensitivities: dict[str, dict[str, float]] = field(default_factory=dict)
    _profile: Callable[[str, float], dict[str, tuple[float, float]]] | None = field(default=None, repr=False, compare=False)

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
        """The confidence interval of a parameter, symmetric in its logarithm (Student's t); of one that is not determined, from the
        profile of chi-squared, which may have no upper limit. Another parameter's contains its values at those limits."""
        quantile = float(needed("scipy.special").stdtrit(self.degrees_of_freedom, 0.5 + 0.5 * level))
        relative = {each: error / self.values[each] for each, error in self.standard_errors.items()}
        with np.errstate(over="ignore"):
            factor = float(np.exp(quantile * relative[name]))
        low, high = self.values[name] / factor, self.values[name] * factor
        for each, error in relative.items():
            if self._profile is not None and UNDETERMINED < error < math.inf:
                limits = self._profile(each, quantile)[name]
                if each == name:
                    return limits
                low, high = min(low, limits[0]), max(high, limits[1])
        return low, high

    def __repr__(self) -> str:
        lines = [f"{'parameter':32} {'value':>11} {'std. error':>11}   95 % interval"]
        for name in self.names:
            low, high = self.interval(name)
            lines.append(f"{name:32} {self.values[name]:11.5g} {self.standard_errors[name]:11.2g}   {low:.4g} to {high:.4g}")
        for i, name in enumerate(self.names):
            lines += [f"correlation of {name} and {other}: {self.correlation[i, j]:.3f}" for j, other in enumerate(self.names[:i])]
        for loop in dict.fromkeys(each.loop for each in self.rig_errors):
            lines.append(f"{loop}: " + ", ".join(str(each) for each in self.rig_errors if each.loop == loop))
        for label, changes in self.sensitivities.items():
            shown = ", ".join(
                f"{name} by {change:+.2%}" if change < 9.0 else f"{name} more than tenfold" for name, change in changes.items()
            )
            lines.append(f"{label}, if not estimated, would change {shown}")
        return "\n".join([*lines, *(f"warning: {warning}" for warning in self.warnings)])


@dataclass(repr=False)
class Fit(Estimate):
    """The estimate from measured loops. `loops`: with their noise; `residuals`: of every loop, distances from the model in standard
    deviations, positive where the shift is larger; `curves`: the model, an array (2, n) of tangential force and shift for every
    branch of every loop; `corrected`: the loops without the estimated errors of the rig, as the curves; `chi_squared`: reduced by
    the degrees of freedom, 1 for a right model and right noise."""

    loops: list[Loop] = field(default_factory=list)
    residuals: list[Array] = field(default_factory=list)
    curves: list[list[Array]] = field(default_factory=list)
    corrected: list[Loop] = field(default_factory=list)
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
        active = problem.active
        unknowns = int(active.sum())
        walkers = 2 * unknowns + 2 if walkers is None else walkers

        def log_posterior(values: Array) -> float:
            x = np.zeros(centre.size)
            x[active] = values
            if np.max(np.abs(x[:count] - centre[:count])) > limit or not problem.reaches(x):
                return -math.inf
            residuals = problem.residuals(x)
            return -0.5 * float(residuals @ residuals)

        random = np.random.default_rng(seed)
        width = np.minimum(0.5 * problem.standard_errors(centre), 0.2)
        start = centre[active] + width * random.standard_normal((walkers, unknowns))
        sampler = emcee.EnsembleSampler(walkers, unknowns, log_posterior)
        sampler.random_state = np.random.RandomState(seed).get_state()
        sampler.run_mcmc(start, steps)
        return np.asarray(np.exp(sampler.get_chain(discard=steps // 5, flat=True)[:, :count]))

    def figure(self) -> Figure:
        """A picture with a column for every loop: measured rows and model, the same without the line of the stick stiffness, which
        hides a thin loop, and the residuals. Axes have the units of the scene."""
        from matplotlib import pyplot

        length, force_unit = self._problem.scene.length_unit, self._problem.scene.force_unit
        in_length = f" [{length}]" if length else ""
        in_force = f" [{force_unit}/{length}]" if length and force_unit else ""

        figure, axes = pyplot.subplots(
            3, len(self.loops), figsize=(4.2 * len(self.loops), 8.4), squeeze=False, layout="constrained"
        )
        for (above, middle, below), loop, residuals, branches in zip(axes.T, self.corrected, self.residuals, self.curves):
            force, shift = np.concatenate(branches, axis=1)
            steps = np.diff(branches[-1], axis=1)
            slope = next(step[1] / step[0] for step in steps.T if abs(step[0]) > 1e-6 * np.ptp(force))  # sticks after the reversal
            for ax, line in ((above, 0.0), (middle, slope)):
                ax.plot(loop.shift - line * loop.tangential_force, loop.tangential_force, ".", ms=3, label="measured")
                ax.plot(shift - line * force, force, "-", lw=1, label="model")
            below.plot(residuals, ".", ms=3)
            below.axhline(0.0, color="black", lw=0.6)
            above.set(title=loop.name, xlabel=f"shift U{in_length}", ylabel=f"tangential force Q{in_force}")
            middle.set(xlabel=f"U - {slope:.3g} Q{in_length}", ylabel=f"tangential force Q{in_force}")
            below.set(xlabel="row", ylabel="residual over standard deviation")
            above.legend(frameon=False)
            for ax in (above, middle):
                ax.locator_params(nbins=5)
                ax.ticklabel_format(axis="x", scilimits=(-2, 3))
        figure.suptitle("   ".join(f"{name} = {self.values[name]:.4g} ± {self.standard_errors[name]:.2g}" for name in self.names))
        return figure
