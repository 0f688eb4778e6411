"""The motions of the upper body, the loads of a case, the progress of a run."""

from __future__ import annotations

from typing import NamedTuple, TypedDict


class Motion(NamedTuple):
    """A motion of the upper body and its conjugate force: the names of keys, fields and attributes."""

    displacement: str
    force: str


#: The motions in the order of the library (MFV_APPROACH, ...). What follows names the same, with types.
MOTIONS = (Motion("approach", "normal_force"), Motion("shift", "tangential_force"), Motion("rotation", "moment"))


class Targets(TypedDict, total=False):
    """Targets of a step: of every motion at most one, its force or its displacement."""

    normal_force: float | None  #: P [force/length]
    approach: float | None  #: of the upper body [length]
    tangential_force: float | None  #: Q [force/length]
    shift: float | None  #: of the upper body to the right [length]
    moment: float | None  #: M [force], counterclockwise
    rotation: float | None  #: of the upper body [radians], counterclockwise


class Loads(NamedTuple):
    """Loads and motions of the present state."""

    normal_force: float  #: P [force/length]
    tangential_force: float  #: Q [force/length], on the lower body to the right
    moment: float  #: M [force], counterclockwise, about the centre of rotation
    approach: float  #: of the upper body [length]
    shift: float  #: of the upper body to the right [length]
    rotation: float  #: of the upper body [radians], counterclockwise
    dissipation: float  #: energy dissipated by friction so far [force]
    contact_nodes: int
    stick_nodes: int
    slip_nodes: int
    events: int  #: number of loads so far at which nodes changed their status
    linear_solves: int  #: so far


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
    approach: float
    shift: float
    rotation: float

    @property
    def done(self) -> float:
        """Completed fraction of the whole load history."""
        return (self.segment - 1 + self.fraction) / max(self.segments, 1)
