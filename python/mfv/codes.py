"""The coded quantities of a result: what `state/status` and `history/event_kind` mean (their `flag_meanings`)."""

from enum import IntEnum


class NodeStatus(IntEnum):
    """What a surface node can be."""

    OPEN = 0
    STICK = 1
    SLIP_RIGHT = 2  #: slips to the right: tau = -mu p
    SLIP_LEFT = 3  #: slips to the left: tau = +mu p
    FRICTIONLESS = 4  #: in contact while friction is off or absent
    CREEP_RIGHT = 5  #: held by bristles below the friction limit, which give way to the right
    CREEP_LEFT = 6  #: the same, to the left


class EventKind(IntEnum):
    """What ended an increment of the load."""

    START = 0
    CLOSE = 1
    OPEN = 2
    SLIP_RIGHT = 3
    SLIP_LEFT = 4
    STICK = 5
    STEP_END = 6
    STOPPED = 7
    REVERSE = 8  #: a creeping node turns round
    WEAKENED = 9  #: a slipping node's friction has fallen to its last value
    CAUGHT = 10  #: a node that snapped is where its friction law holds again
    CAPPED = 11  #: shear traction on its way down has come to the static limit, because the pressure falls faster
    DROPPED = 12  #: the end of a stress drop, at the load at which it began
