"""A coated specimen under a rubbing cylinder: tractions, stresses through the coating, and how its thickness changes the contact.

python examples/coating.py [PICTURE.png]
"""

from __future__ import annotations

import sys

import matplotlib.pyplot as plt
import numpy as np

import mfv
from mfv import Body, Friction, Layer, Mesh, Scene, Step

ALUMINIUM = {"youngs_modulus": 70e3, "poisson_ratio": 0.33}
#: As stiff as the specimen times this.
COATINGS = {"4 times as stiff": 4.0, "a quarter as stiff": 0.25}
FORCE, MU, RADIUS = 50.0, 0.3, 10.0


def rubbed(thickness: float, stiffness: float) -> mfv.Result:
    """Pressed, sheared to Q = 0.6 mu P and back, and twice around."""
    coating = {**ALUMINIUM, "youngs_modulus": stiffness * ALUMINIUM["youngs_modulus"]}
    layers = [Layer(thickness=thickness, **coating)] if thickness else None
    return Scene(
        Body.half_plane(**ALUMINIUM, layers=layers),
        Body.disk(RADIUS, rigid=True),
        mesh=Mesh(nodes=201),
        friction=Friction.coulomb(MU),
        steps=[Step(normal_force=FORCE), Step(force_ratio=0.6), Step(force_ratio=-0.6, cycles=2)],
    ).run(check=True)


def draw(path: str) -> None:
    bare = rubbed(0.0, 1.0)
    a = float(bare.observables.contact_half_width)
    thicknesses = a * np.geomspace(0.03, 10.0, 19)
    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(12.0, 3.8), layout="constrained")
    depths = np.linspace(1e-6, 1.2, 200) * a
    for number, (name, stiffness) in enumerate(COATINGS.items()):
        colour = f"C{number}"
        results = [rubbed(t, stiffness) for t in thicknesses]
        middle.semilogx(thicknesses / a, [r.observables.stick_ratio for r in results], "o-", color=colour, markersize=3, label=name)
        for traction, style, label in (("shear", "o-", f"{name}: shear"), ("tension", "s--", "tension")):
            values = [r.observables[f"largest_lower_interface_{traction}"] for r in results]
            right.loglog(thicknesses / a, values, style, color=colour, markersize=3, label=label)
        one = rubbed(0.3 * a, stiffness)
        below = mfv.stress.stress(one, np.full_like(depths, -0.5 * a), -depths)
        left.plot(below["sigma_xx"], depths / a, color=colour, label=f"σxx, {name}")
        left.plot(below["sigma_xy"], depths / a, "--", color=colour, label="σxy")
    left.axhline(0.3, color="0.7", linewidth=1)
    left.invert_yaxis()
    left.set(xlabel="stress [MPa]", ylabel="depth/a", title="Below x = -a/2, coating of 0.3 a")
    middle.axhline(float(bare.observables.stick_ratio), color="0.7", linewidth=1)
    middle.set(xlabel="thickness/a", ylabel="stick ratio", title="Stick ratio at Q = 0.6 μP")
    right.set(xlabel="thickness/a", ylabel="traction [MPa]", title="Largest at the interface")
    for axes in (left, middle, right):
        axes.legend(fontsize="small")
    figure.savefig(path, dpi=120)


if __name__ == "__main__":
    draw(sys.argv[1] if len(sys.argv) > 1 else "coating.png")
