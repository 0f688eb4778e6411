"""A steel cylinder on a carbon fibre composite: tractions for fibres at several angles to the surface, and what the angle changes.

python examples/composite.py [PICTURE.png]
"""

from __future__ import annotations

import sys

import matplotlib.pyplot as plt
import numpy as np

import mfv
from mfv import Body, Friction, Mesh, Scene, Step

#: Along and across the fibres, and out of the plane, MPa.
COMPOSITE = {
    "youngs_modulus_1": 140e3,
    "youngs_modulus_2": 10e3,
    "youngs_modulus_3": 10e3,
    "poisson_ratio_12": 0.3,
    "poisson_ratio_13": 0.3,
    "poisson_ratio_23": 0.45,
    "shear_modulus_12": 5e3,
}
FORCE, MU = 50.0, 0.3
SHOWN = (0, 30, 60, 90)


def rubbed(angle: float) -> mfv.Result:
    """Pressed, sheared to Q = 0.6 mu P and back, and twice around."""
    return Scene(
        Body.half_plane(elasticity="orthotropic", axis_angle=angle, **COMPOSITE),
        Body.disk(10.0, youngs_modulus=210e3, poisson_ratio=0.3),
        mesh=Mesh(nodes=201),
        friction=Friction.coulomb(MU),
        steps=[Step(normal_force=FORCE), Step(force_ratio=0.6), Step(force_ratio=-0.6, cycles=2)],
    ).run(check=True)


def draw(results: dict[int, mfv.Result], path: str) -> None:
    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(12.0, 3.8), layout="constrained")
    for number, angle in enumerate(SHOWN):
        result, colour = results[angle], f"C{number}"
        left.plot(result.mesh.x, result.state.pressure, color=colour, label=f"{angle} degrees")
        left.plot(result.mesh.x, result.state.shear, "--", color=colour)
    left.set(xlabel="x [mm]", ylabel="p, τ (dashed) [MPa]", title="Tractions at Q = 0.6 μP")
    left.legend(fontsize="small")
    angles = np.array(list(results))
    found = [results[angle].observables for angle in angles]
    middle.plot(angles, [1e3 * one.cycle_dissipation for one in found], "o-", markersize=3)
    middle.set(xlabel="angle of the fibres [degrees]", ylabel="D [μJ/mm]", title="Dissipation of a cycle", ylim=(0, None))
    right.plot(angles, [one.largest_lower_tension for one in found], "o-", markersize=3, label="composite")
    right.plot(angles, [one.largest_upper_tension for one in found], "s-", markersize=3, label="steel")
    right.set(xlabel="angle of the fibres [degrees]", ylabel="σxx [MPa]", title="Largest tension along the surface")
    right.legend(fontsize="small")
    figure.savefig(path, dpi=120)


if __name__ == "__main__":
    draw({angle: rubbed(angle) for angle in range(0, 91, 5)}, sys.argv[1] if len(sys.argv) > 1 else "composite.png")
