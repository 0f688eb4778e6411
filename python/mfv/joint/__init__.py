"""Joint elements: reduced models of a contact for programs of structural dynamics, fitted to its backbone and cycles.

`measure` computes backbone and cycles of growing amplitude of a scene, `from_loops` and `from_ring_down` take them from tests;
`table`, `iwan`, `segalman`, `bouc_wen` and `Masing` make models of them, `assess` compares a model with them cycle by
cycle. Every model has `start` and `update`, which give the force, the consistent tangent and the new state of a displacement;
`to_json` and `from_json` keep it in a file, `Iwan.c_source` is one in C.
Displacements are tangential displacements from the state after pressing [length], forces per unit thickness [force/length]; any
consistent units. See docs/joints.md.
"""

from __future__ import annotations

from .assessment import Assessment, assess
from .backbone import Backbone, mindlin_distribution, mindlin_shift
from .fits import bouc_wen, iwan, segalman, table
from .measurement import Cycle, Measurement, measure
from .models import BoucWen, Iwan, Masing, Model, Segalman, Update, from_json
from .records import RingDown, from_loops, from_ring_down, ring_down

__all__ = [
    "Assessment",
    "Backbone",
    "BoucWen",
    "Cycle",
    "Iwan",
    "Masing",
    "Measurement",
    "Model",
    "RingDown",
    "Segalman",
    "Update",
    "assess",
    "bouc_wen",
    "from_json",
    "from_loops",
    "from_ring_down",
    "iwan",
    "measure",
    "mindlin_distribution",
    "mindlin_shift",
    "ring_down",
    "segalman",
    "table",
]
