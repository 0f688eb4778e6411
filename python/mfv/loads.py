"""What a case tells of itself: its loads and motions, and how far a run is."""

from __future__ import annotations

from typing import NamedTuple


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
    events: int  #: loads so far at which nodes changed their status
    linear_solves: int  #: so far


class Progress(NamedTuple):
    """What an observer is told after every increment of the load."""

    fraction: float  #: of this load segment
    segment: int  #: number of this part, from 1
    segments: int  #: how many there are
    contact_nodes: int
    stick_nodes: int
    normal_force: float  #: [force/length]
    tangential_force: float  #: [force/length]
    approach: float  #: [length]
    shift: float  #: [length]

    @property
    def done(self) -> float:
        """Part of the whole load history that is done."""
        return (self.segment - 1 + self.fraction) / max(self.segments, 1)
