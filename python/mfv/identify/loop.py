"""Measured and planned loops."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from numbers import Integral, Real
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from ..errors import input_error
from .path import estimated_noise

Array = NDArray[np.float64]


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
        force = estimated_noise(self.tangential_force) if self.force_noise is None else self.force_noise
        shift = estimated_noise(self.shift) if self.shift_noise is None else self.shift_noise
        response, name = (shift, "shift_noise") if self.drive == "tangential_force" else (force, "force_noise")
        if response == 0.0:
            raise input_error(f"{self.name}: the column that is not driven has no noise; give {name}")
        return dataclasses.replace(self, force_noise=force, shift_noise=shift)
