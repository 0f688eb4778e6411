"""Fatigue from the stresses of a load cycle: multiaxial parameters with critical planes, critical distances, lives, short cracks.

From a result to a life: `graded_points` and `stress_cycle` give stresses over the last cycle; `smith_watson_topper` and others a map of a
parameter with its maximum; `averaged_cycle` its average over a critical distance; `life` with a `StrainLife` the cycles to initiation;
`edge_crack` whether a short crack arrests. Lives need scipy, rainflow counting pyLife (the extra `fatigue`).
"""

from .cracks import EdgeCrack, edge_crack, short_crack_threshold, stress_intensity
from .critical_distance import averaged_cycle, critical_length
from .lives import (
    Counted,
    Damage,
    StrainLife,
    count_cycles,
    fatemi_socie_damage,
    findley_damage,
    life,
    smith_watson_topper_damage,
)
from .parameters import (
    ParameterMap,
    Peak,
    Ruiz,
    crossland,
    crossland_constant,
    dang_van,
    dang_van_constant,
    fatemi_socie,
    findley,
    findley_constant,
    ruiz,
    smith_watson_topper,
)
from .stress_cycle import StressCycle, graded_points, last_cycle, stress_cycle

__all__ = [
    "Counted",
    "Damage",
    "EdgeCrack",
    "ParameterMap",
    "Peak",
    "Ruiz",
    "StrainLife",
    "StressCycle",
    "averaged_cycle",
    "count_cycles",
    "critical_length",
    "crossland",
    "crossland_constant",
    "dang_van",
    "dang_van_constant",
    "edge_crack",
    "fatemi_socie",
    "fatemi_socie_damage",
    "findley",
    "findley_constant",
    "findley_damage",
    "graded_points",
    "last_cycle",
    "life",
    "ruiz",
    "short_crack_threshold",
    "smith_watson_topper",
    "smith_watson_topper_damage",
    "stress_cycle",
    "stress_intensity",
]
