"""Scenes that the tests of the Python package share."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import mfv

PROJECT = Path(__file__).resolve().parents[2]

HALF_PLANE = mfv.Body.half_plane(shear_modulus=1.0, poisson_ratio=0.3)
DISK = mfv.Body.disk(0.25, rigid=True)
MESH = mfv.Mesh(nodes=61, half_width=0.01225)
PRESS = mfv.Step(normal_force=1.0e-3, friction=False)


def seeds(number: int) -> range:
    """Seeds of random scenes; with all run-time checks, which take several times as long, a quarter of them."""
    return range(0, number, 4 if "MFV_CHECKED" in os.environ else 1)


def cylinder(*steps: mfv.Step, **keys: Any) -> mfv.Scene:
    """A rigid cylinder on a half-plane under Coulomb's friction, without coupling of shear into pressure."""
    given: dict[str, Any] = {"mesh": MESH, "friction": mfv.Friction.coulomb(0.7), "coupling": "goodman", **keys}
    return mfv.Scene(HALF_PLANE, DISK, steps=steps, **given)
