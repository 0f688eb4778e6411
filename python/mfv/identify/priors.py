"""Systematic errors of a rig: what is known about them before a fit."""

from __future__ import annotations

from dataclasses import dataclass, fields
from numbers import Real
from typing import NamedTuple

from ..errors import input_error


@dataclass(frozen=True)
class Priors:
    """Standard deviations, around 0, of the systematic errors of every loop, which are unknowns of a fit; 0 leaves one out.

    `lag`: of the shift behind the force [degrees of a cycle]; `drift`: of the shift in a cycle, over half its range; `offset`: of the
    zero of the force, over half its range, of loops with a prescribed shift or from the first loading; `slack`: play in series with
    the contact, which the shift jumps by where the force changes its sign, over half its range. Raises InputError.
    """

    lag: float = 1.0
    drift: float = 0.02
    offset: float = 0.05
    slack: float = 0.0

    def __post_init__(self) -> None:
        for each in fields(self):
            value = getattr(self, each.name)
            if isinstance(value, bool) or not isinstance(value, Real) or not 0.0 <= float(value) < float("inf"):
                raise input_error(f"{each.name}={value!r}: the width of a prior must be a finite number of at least 0")


class RigError(NamedTuple):
    """An estimated systematic error of a loop, in the units of `Priors`.

    `is_determined`: whether the loop, and not the prior alone, says something about it.
    """

    loop: str
    name: str
    value: float
    standard_error: float
    is_determined: bool = True

    @property
    def size(self) -> str:
        """Value and standard error with their unit."""
        factor, unit = (1.0, "degrees") if self.name == "lag" else (100.0, "%")
        return f"{factor * self.value:.2f} ± {factor * self.standard_error:.2g} {unit}"

    def __str__(self) -> str:
        return f"{self.name} {self.size if self.is_determined else 'not determined'}"


#: The systematic errors in the order of the unknowns.
NAMES = tuple(each.name for each in fields(Priors))
