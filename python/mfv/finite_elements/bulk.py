r"""The bulk stress of a body near the contact, from the stresses at the nodes of its surface.

The stress along the surface of a half-plane is that of its bulk and, outside the contact, -(2/pi) int q(s)/(x - s) ds by the shear traction q
(docs/theory.md); that of the upper body, on which -q acts from below, has the other sign. What remains at nodes beside the contact is fitted
by a constant.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .record import Array
from .traces import Traces


class Bulk(NamedTuple):
    """The bulk stress and its error, arrays (times,) [force/length^2]: the standard deviation of what remains at the nodes."""

    stress: Array
    error: Array


def bulk_stress(of_body: Traces, of_contact: Traces, edges: tuple[float, float], reach: tuple[float, float]) -> Bulk | None:
    """The bulk stress of the body of `of_body` under the forces of `of_contact`; None without stresses or nodes where they are wanted.

    `edges`: the outermost nodes in contact at any time [length]; nodes are used whose distance from it is between `reach` half-widths.
    """
    if of_body.stress is None:
        return None
    half = 0.5 * (edges[1] - edges[0])
    x = of_body.stress_x
    distance = np.maximum(edges[0] - x, x - edges[1])
    used = (distance > reach[0] * half) & (distance <= reach[1] * half)
    if np.sum(used) < 2:
        return None
    side = 1.0 if of_body.body == "lower" else -1.0
    loaded = (of_contact.x >= edges[0]) & (of_contact.x <= edges[1])
    by_contact = -side * 2.0 / np.pi * of_contact.shear[:, loaded] @ (1.0 / (x[None, used] - of_contact.x[loaded, None]))
    rest = of_body.stress[:, used] - by_contact
    return Bulk(rest.mean(axis=1), rest.std(axis=1, ddof=1))
