"""Models against MFV, cycle by cycle."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .measurement import Cycle, Measurement
from .models import Model

Array = NDArray[np.float64]

#: Displacements of each half of a cycle at which a model is evaluated: its dissipation is that of the trapezoidal rule, in error by
#: about 1/POINTS^2 of it.
POINTS = 200


class Assessment(NamedTuple):
    """Columns with a row for every cycle; errors are model over MFV minus 1, NaN of a cycle without slip."""

    amplitude: Array  #: of displacement [length]
    force_amplitude: Array  #: of MFV [force/length]
    dissipation: Array  #: of MFV [force]
    stiffness: Array  #: of MFV, secant [force/length^2]
    dissipation_error: Array
    stiffness_error: Array
    force_error: Array  #: largest difference of force at MFV's events, over the force amplitude
    warnings: tuple[str, ...] = ()  #: of the measurement

    def __str__(self) -> str:
        lines = ["   amplitude  dissipation     error    stiffness     error   force error"]
        for u, _, d, k, *errors in zip(*self[:-1]):
            de, ke, fe = (f"{round(100.0 * error, 2) + 0.0:.2f}%" for error in errors)  # 0.0: no negative zeros
            lines.append(f"{u:12.4e} {d:12.4e} {de:>9} {k:12.4e} {ke:>9} {fe:>13}")
        return "\n".join([*lines, *(f"warning: {text}" for text in self.warnings)])


def assess(model: Model, measured: Measurement) -> Assessment:
    """Drive a model by the displacements of all cycles, one after the other, and compare with MFV.

    The measurement may be another one than that of the fit: other amplitudes, another beginning, another normal force.
    """
    state = model.start()
    rows = []
    for cycle in measured.cycles:
        path, expected = _path(cycle)
        forces = np.empty(path.size)
        for i, displacement in enumerate(path.tolist()):
            forces[i], _, state = model.update(state, displacement)
        amplitude = cycle.force_amplitude
        dissipation = 0.5 * (forces[1:] + forces[:-1]) @ np.diff(path)
        errors = (
            dissipation / cycle.dissipation - 1.0 if cycle.slips else np.nan,
            0.5 * np.ptp(forces) / amplitude - 1.0,
            np.max(np.abs(forces - expected)) / amplitude,
        )
        rows.append((cycle.amplitude, amplitude, cycle.dissipation, cycle.stiffness, *errors))
    return Assessment(*np.array(rows).T)._replace(warnings=measured.warnings)


def _path(cycle: Cycle) -> tuple[Array, Array]:
    """Displacements of a cycle, at least POINTS for each half, among them those of MFV's events, and MFV's forces."""
    low = int(np.argmin(cycle.force))
    displacements, forces = [], []
    for half in (slice(0, low + 1), slice(low, None)):
        u, q = cycle.displacement[half], cycle.force[half]
        order = np.argsort(u, kind="stable")
        at = np.union1d(u, np.linspace(u[0], u[-1], POINTS))
        at = at if u[-1] > u[0] else at[::-1]
        displacements.append(at)
        forces.append(np.interp(at, u[order], q[order]))
    return np.concatenate(displacements), np.concatenate(forces)
