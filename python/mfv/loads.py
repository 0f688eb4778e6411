"""The motions of the upper body, the bulk stresses and the interference, the loads of a case, the progress of a run."""

from __future__ import annotations

from importlib import import_module
from typing import Any, NamedTuple, TypedDict

import numpy as np
from numpy.typing import NDArray


class Motion(NamedTuple):
    """A motion of the upper body, a bulk stress or the interference, and its conjugate force: names of keys, fields, attributes."""

    displacement: str
    force: str
    #: Whether a step can prescribe its value only, not its force.
    is_known: bool = False

    @property
    def targets(self) -> tuple[str, ...]:
        """The quantities that a step can prescribe, the force first."""
        return (self.displacement,) if self.is_known else (self.force, self.displacement)


#: The motions in the order of the library (MFV_APPROACH, ...). What follows names the same, with types.
MOTIONS = (
    Motion("approach", "normal_force"),
    Motion("shift", "tangential_force"),
    Motion("rotation", "moment"),
    Motion("lower_bulk_stress", "lower_contraction", is_known=True),
    Motion("upper_bulk_stress", "upper_contraction", is_known=True),
    Motion("interference", "closing_force", is_known=True),
)


class Targets(TypedDict, total=False):
    """Targets of a step: of every motion at most one, its force or its displacement."""

    normal_force: float | None  #: P [force/length]
    approach: float | None  #: of the upper body [length]
    tangential_force: float | None  #: Q [force/length]
    shift: float | None  #: of the upper body to the right [length]
    moment: float | None  #: M [force], counterclockwise
    rotation: float | None  #: of the upper body [radians], counterclockwise
    lower_bulk_stress: float | None  #: uniform sigma_xx of the lower body [force/length^2], positive in tension
    upper_bulk_stress: float | None  #: the same of the upper body
    interference: float | None  #: by which one body is larger than its place [length]


class Loads(NamedTuple):
    """Loads and motions of the present state."""

    normal_force: float  #: P [force/length]
    tangential_force: float  #: Q [force/length], on the lower body to the right
    moment: float  #: M [force], counterclockwise, about the centre of rotation
    lower_contraction: float  #: area by which the shear tractions shorten the lower body [length^2], conjugate to its bulk stress
    upper_contraction: float  #: the same of the upper body
    closing_force: float  #: sum of the pressure along the surface [force/length], conjugate to the interference
    approach: float  #: of the upper body [length]
    shift: float  #: of the upper body to the right [length]
    rotation: float  #: of the upper body [radians], counterclockwise
    lower_bulk_stress: float  #: uniform sigma_xx of the lower body [force/length^2], positive in tension
    upper_bulk_stress: float  #: the same of the upper body
    interference: float  #: by which one body is larger than its place [length]
    dissipation: float  #: energy dissipated by friction so far [force]
    contact_nodes: int
    stick_nodes: int
    slip_nodes: int
    events: int  #: number of loads so far at which nodes changed their status
    linear_solves: int  #: so far


class Derivative(NamedTuple):
    """Derivatives of a state with respect to a parameter; units: of these over that of the parameter."""

    #: Of forces, motions and dissipation; `linear_solves`: those for derivatives so far; `events`: number of loads at which several
    #: nodes changed their status together, but would not at another value of the parameter, such as a moment in a symmetric
    #: contact: if it is not 0 the derivative is approximate. The other counts are 0.
    loads: Loads
    pressure: NDArray[np.float64]  #: of the nodes [force/length^2 over the parameter], an array (nodes,)
    shear: NDArray[np.float64]  #: the same of the shear traction


class Progress(NamedTuple):
    """The progress of a run, after a load increment."""

    fraction: float  #: of this load segment
    segment: int  #: number of this load segment, from 1
    segments: int  #: number of load segments
    contact_nodes: int
    stick_nodes: int
    normal_force: float  #: these as of Loads
    tangential_force: float
    moment: float
    lower_contraction: float
    upper_contraction: float
    closing_force: float
    approach: float
    shift: float
    rotation: float
    lower_bulk_stress: float
    upper_bulk_stress: float
    interference: float

    @property
    def done(self) -> float:
        """Completed fraction of the whole load history."""
        return (self.segment - 1 + self.fraction) / max(self.segments, 1)


def __getattr__(name: str) -> Any:
    """`from_fe`, which is loaded on first use."""
    if name == "from_fe":
        return import_module(".finite_elements", __package__).from_fe
    raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
