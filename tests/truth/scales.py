"""The natural scale of every quantity that may vanish by symmetry or at small loads, in one table.

An error is relative to the quantity itself or to this scale, whichever is larger.
"""

from __future__ import annotations

import math
import re

import numpy as np

import mfv
from mfv.stress import is_radial

#: Names of sides in those of fields.
SIDES = [("left", "right")]
#: Part of the natural scale below which a quantity that is positive, such as a dissipation, counts as zero.
NEGLIGIBLE = 1.0e-6
#: Coefficient of friction below which a tangential force is relative to the normal force.
SLIPPERY = 1.0e-3

#: Names of quantities and the attribute of `Scales` that is their scale; the first that matches counts.
_TABLE = [
    (r".*(left|right)|contact_centre.*|.*_edge|.*(tension|shear|pressure|von_mises)_[xy]|x|contact_length", "half_width"),
    (r".*slip_zone.*|.*_edge_reach|.*stick_length", "half_width"),
    (r".*_shear_intensity.*", "shear_intensity"),
    (r".*interface_(tension|shear)", "pressure"),
    (r".*stick_ratio.*|patch_shift.*|change|loss_factor|creepage_number|.*_edge_exponent", "one"),
    (r"dissipation_number", "friction_squared"),
    (r"shear_number", "friction"),
    (r"tangential_force|force_amplitude", "friction_force"),
    (r"normal_force|closing_force|closing_force_work", "normal_force"),
    (r"moment", "moment"),
    (r"shift|shift_drift|shift_amplitude|slip|largest_slip_range|.*tangential_displacement", "shift"),
    (r"approach|approach_drift|gap|.*normal_displacement", "approach"),
    (r"rotation|rotation_drift", "rotation"),
    (r"shear|peak_shear|largest_shear|.*tension|.*_bulk_stress", "shear"),
    (r"pressure|peak_pressure|largest_pressure|.*von_mises", "pressure"),
    (r".*_contraction.*", "contraction"),
    (r"friction_work", "work_per_length"),
    (r"dissipation|.*cycle_dissipation|.*_work", "work"),
    (r"creepage", "creepage"),
    (r"wear_depth", "approach"),
    (r"worn_area", "indented"),
]  # fmt: skip
#: Those that are positive where they are not zero: relative to themselves unless negligible.
_POSITIVE = (
    r"loss_factor|dissipation|dissipation_number|.*cycle_dissipation|peak_pressure|peak_shear|contact_length|"
    r"force_amplitude|shift_amplitude|friction_work|wear_depth|worn_area"
)


def other_side(name: str) -> str:
    """The same on the other side: left for right."""
    for left, right in SIDES:
        if left in name.split("_"):
            return name.replace(left, right)
        if right in name.split("_"):
            return name.replace(right, left)
    return name


class Scales:
    """Scales of a result: of the largest loads of its history, at the end of the steps."""

    def __init__(self, result: mfv.Result) -> None:
        summary, x = result.summary, result.mesh.x
        #: A pin that fits its bore neatly: the mesh covers the circle.
        self.is_closed = is_radial(result) and result.scene.lower_radius == result.scene.upper_radius
        self.around = float(np.sum(result.mesh.width))
        steps = [*result.steps, summary]
        self.one = 1.0
        length = float(summary.get("contact_length", math.nan))
        span = float(summary.get("contact_right", math.nan)) - float(summary.get("contact_left", math.nan))
        self.half_width = 0.5 * (max(span, length) if span > 0 else length if length > 0 else float(x[-1] - x[0]))
        friction = result.mesh.get("static_friction")
        mu = 0.0 if friction is None else float(np.max(friction))
        self.friction, self.friction_squared = mu, mu**2
        self.normal_force = max(
            abs(float(step[name])) for step in steps for name in ("normal_force", "closing_force") if name in step
        )
        self.friction_force = max(mu, SLIPPERY) * self.normal_force
        # A matrix has none.
        modulus = float(result.scene.get("contact_modulus", self.normal_force / max(abs(float(summary.approach)), 1e-300)))
        self.pressure = 2.0 * self.normal_force / (math.pi * self.half_width)
        bulk = max((abs(float(step[name])) for step in steps for name in step if name.endswith("bulk_stress")), default=0.0)
        self.shear = max(mu * self.pressure, bulk)
        self.shear_intensity = self.shear * math.sqrt(self.half_width)
        self.approach = self.normal_force / (math.pi * modulus)
        self.shift = max(mu * self.approach, bulk * self.half_width / (2.0 * modulus))
        self.rotation = self.approach / self.half_width
        self.moment = self.normal_force * self.half_width
        self.contraction = self.shift * self.half_width
        self.indented = self.approach * self.half_width
        self.work = mu * self.normal_force * self.shift
        self.work_per_length = self.work / self.half_width
        self.creepage = mu * self.half_width * abs(float(result.scene.get("curvature", 0.0)))

    def natural(self, name: str) -> float:
        """Scale of a quantity that can be zero; 0 if it has none."""
        return next((float(getattr(self, attribute)) for pattern, attribute in _TABLE if re.fullmatch(pattern, name)), 0.0)

    def where_it_vanishes(self, name: str) -> float:
        """The scale to which errors are relative if the quantity is smaller; a negligible part of the natural scale of those that are
        positive."""
        return self.natural(name) * (NEGLIGIBLE if re.fullmatch(_POSITIVE, name) else 1.0)
