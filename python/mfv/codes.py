"""The coded quantities of a result: what `state/status` and `history/event_kind` mean (their `flag_meanings`)."""

from enum import IntEnum


class NodeStatus(IntEnum):
    """Status of a surface node. Slip and creep are those of the lower surface relative to the upper one."""

    OPEN = 0
    STICK = 1
    SLIP_RIGHT = 2  #: lower surface slips to the right: tau = -mu p
    SLIP_LEFT = 3  #: lower surface slips to the left: tau = +mu p
    FRICTIONLESS = 4  #: in contact while friction is off or absent
    CREEP_RIGHT = 5  #: bristles yield below the friction limit; lower surface creeps to the right
    CREEP_LEFT = 6  #: the same, to the left


class EventKind(IntEnum):
    """Event at the end of a load increment."""

    START = 0
    CLOSE = 1
    OPEN = 2
    SLIP_RIGHT = 3
    SLIP_LEFT = 4
    STICK = 5
    STEP_END = 6
    STOPPED = 7
    REVERSE = 8  #: a creeping node reverses
    WEAKENED = 9  #: the friction of a slipping node has reached its kinetic value
    CAUGHT = 10  #: a node satisfies its friction law again after a stress drop
    CAPPED = 11  #: a decreasing shear traction has reached the static limit, since the pressure falls faster
    DROPPED = 12  #: the end of a stress drop, at constant load
    INCREMENT = 13  #: the end of a large increment, in which events are not located
