"""Parameters of a scene from measured loops of tangential force and shift, with their uncertainty.

`fit` estimates keys of a scene (and the stiffness of the rig) from measured loops by least squares; `plan` predicts the uncertainty
that planned loops would leave; `simulate` makes synthetic loops. docs/identify.md has the method and its sources.
"""

from __future__ import annotations

from .estimate import Estimate, Fit
from .fitting import fit, plan, simulate
from .loop import Loop
from .priors import Priors, RigError
from .problem import RIG_STIFFNESS
from .reading import loops_of, read

__all__ = ["RIG_STIFFNESS", "Estimate", "Fit", "Loop", "Priors", "RigError", "fit", "loops_of", "plan", "read", "simulate"]
