"""Loads of a contact from finite-element results: `from_fe`, also `mfv.loads.from_fe`, and the command `mfv loads`."""

from .bulk import Bulk
from .contact_loads import ContactLoads, from_fe
from .edge_fits import Edge
from .record import NAMES

__all__ = ["NAMES", "Bulk", "ContactLoads", "Edge", "from_fe"]
