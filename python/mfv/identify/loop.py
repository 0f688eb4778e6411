"""Measured and planned loops."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from numbers import Integral, Real
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from ..errors import input_error
from .columns import estimated_noise, far_from_neighbours
from .path import Path, path_of

Array = NDArray[np.float64]

#: A normal force that varies by more than this part of its mean is reported.
VARYING = 0.01


@dataclass
class Loop:
    """One test at a constant normal force: rows of tangential force [force/length] and shift [length] in the order of time.

    The shift is that of the upper body relative to the lower one, with the deformation of the rig between the sensors, from any
    origin. `drive`: the column that the test machine prescribes. `force_noise`, `shift_noise`: standard deviations of independent
    errors of the columns, in their units; if omitted, they are estimated from second differences; 0 for an exact column.
    `cycles_before`: number of cycles between the extremes of the driven column before the first row; 0 if the rows begin with the
    first tangential load. `pressed_with_friction`: whether friction acts while the bodies are brought together. `time`: of the rows,
    increasing, from any origin in any unit; without it rows are evenly spaced in time if the driven column is a smooth function of
    their number, otherwise the arc length of the driven column replaces it. `normal_force`: a number, or a column, of which the mean
    is kept; `normal_force_variation`: half its range over the mean, without noise. `notes`: remarks on the record, which become warnings
    of a fit. Raises InputError.
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
    time: Array | None = None
    normal_force_variation: float = 0.0
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        self.tangential_force = np.array(self.tangential_force, dtype=float)
        self.shift = np.array(self.shift, dtype=float)
        pressing = np.atleast_1d(np.asarray(self.normal_force, dtype=float))
        rows = self.tangential_force.size
        if self.tangential_force.ndim != 1 or self.shift.shape != (rows,) or rows < 5:
            raise input_error(f"{self.name}: needs two columns of equal length with at least 5 rows, tangential_force and shift")
        is_gap = ~(np.isfinite(self.tangential_force) & np.isfinite(self.shift))
        if is_gap.any() or not np.isfinite(pressing).all():
            where = f", the first is row {np.argmax(is_gap) + 1}" if is_gap.any() else ""
            raise input_error(f"{self.name}: the columns must be finite numbers; remove the rows with gaps{where}")
        pressing = pressing[~far_from_neighbours(pressing)[1]]
        self.normal_force = float(pressing.mean())
        if not self.normal_force > 0.0 or np.std(pressing) > 0.05 * self.normal_force:
            raise input_error(
                f"{self.name}: the normal force must be positive and constant to 5 %; split the record where it changes"
            )
        if pressing.size > 4:
            whole, noise = float(np.var(pressing)), estimated_noise(pressing) ** 2
            self.normal_force_variation = math.sqrt(2.0 * (whole - noise)) / self.normal_force if whole > 1.6 * noise else 0.0
        if self.time is not None:
            self.time = np.array(self.time, dtype=float)
            if self.time.shape != (rows,) or not (np.isfinite(self.time).all() and np.all(np.diff(self.time) > 0.0)):
                raise input_error(f"{self.name}: time must have {rows} finite numbers that increase, one for every row")
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

    @property
    def is_reversed(self) -> bool:
        """Whether the shift falls where the force grows."""
        force, shift = self.tangential_force - self.tangential_force.mean(), self.shift - self.shift.mean()
        return float(force @ shift) < 0.0

    def _prepared(self) -> tuple[Loop, Path]:
        """The loop with the sign of the shift that belongs to the force, and with the noise of both columns, estimated where it is not
        given; and the path of its driven column. Raises InputError."""
        loop = dataclasses.replace(self, shift=-self.shift) if self.is_reversed else self
        path = path_of(loop)
        path.warnings.extend(self.notes)
        if self.is_reversed:
            path.warnings.insert(
                0,
                f"{self.name}: shift and tangential force have opposite signs (the loop runs clockwise, it would produce energy): the "
                "sign of the shift is changed",
            )
        if self.normal_force_variation > VARYING:
            path.warnings.append(
                f"{self.name}: the normal force varies by {self.normal_force_variation:.1%} of its mean: mu and what depends on it are in "
                "error by about as much, which the intervals do not contain; control the normal force"
            )
        force_noise, shift_noise = path.noise
        response, name = (shift_noise, "shift_noise") if self.drive == "tangential_force" else (force_noise, "force_noise")
        if response == 0.0:
            raise input_error(f"{self.name}: the column that is not driven has no noise; give {name}")
        return dataclasses.replace(loop, force_noise=force_noise, shift_noise=shift_noise), path
