"""A steel pin pressed into an aluminium lug: tractions under a load to and fro, stresses around the hole, and creep under a rotating load.

python examples/press_fit.py [PICTURE.png]
"""

from __future__ import annotations

import sys

import matplotlib.pyplot as plt
import numpy as np

import mfv
from mfv import Body, Friction, History, Mesh, Scene, Step

RADIUS, INTERFERENCE = 10.0, 0.02
#: Turning points of one turn of the load, and turns.
POINTS, TURNS = 36, 3


def fit(mu: float, steps: list[Step], nodes: int = 240, history: History | None = None) -> mfv.Result:
    """A pin in a hole of its radius."""
    return Scene(
        Body.hole(RADIUS, youngs_modulus=70e3, poisson_ratio=0.33),
        Body.disk(RADIUS, youngs_modulus=210e3, poisson_ratio=0.3),
        mesh=Mesh(nodes=nodes, normals="radial"),
        friction=Friction.coulomb(mu),
        steps=[Step(interference=INTERFERENCE), *steps],
        history=history,
    ).run(check=True)


def creep(mu: float, force: float) -> float:
    """Degrees by which a load that turns once counterclockwise turns the pin, which nothing else holds."""
    angle = np.linspace(0, 2 * np.pi, POINTS + 1)[1:]
    around = {"normal_force": force * np.cos(angle), "tangential_force": force * np.sin(angle)}
    turns = History(**around, moment=0.0, period=POINTS, cycles=TURNS)
    result = fit(mu, [Step(normal_force=force, moment=0.0)], 120, turns)
    return float(np.degrees(result.cycles.rotation_drift[-1]))


def draw(path: str) -> None:
    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(13.0, 4.2), layout="constrained")
    loaded = fit(0.15, [Step(normal_force=2500.0), Step(normal_force=-2500.0, cycles=2)])
    angle = np.degrees(loaded.mesh.arc / RADIUS)
    for number, name in enumerate(("pressed in", "P = 2500 N/mm")):
        state = loaded.steps[number]
        left.plot(angle, state.pressure, color=f"C{number}", label=f"pressure, {name}")
        left.plot(angle, state.shear, "--", color=f"C{number}", label="shear")
    left.plot(angle, 0.15 * state.pressure, ":", color="0.5", label="± friction limit")
    left.plot(angle, -0.15 * state.pressure, ":", color="0.5")
    left.set(xlabel="angle from the load [degrees]", ylabel="traction [MPa]", title="Tractions", xticks=range(-180, 181, 90))
    around = mfv.stress.grid(loaded, step=2)
    mfv.plot.stress_contours(around, middle, "sigma_thetatheta", colour_bar=True, axes="physical", units=("mm", "MPa"))
    middle.set_title("Hoop stress in the lug at P = 2500 N/mm", fontsize="medium")
    opens = np.pi * RADIUS * float(loaded.steps[0].pressure[0])
    loads = np.linspace(0.1, 1.3, 13)
    for mu in (0.1, 0.2, 0.3):
        right.plot(loads, [-creep(mu, load * opens) for load in loads], "o-", markersize=3, label=f"μ = {mu}")
    right.set(
        xlabel="rotating load over πRp₀",
        ylabel="degrees, against the load",
        title="Creep of the pin in one turn",
    )
    for axes in (left, right):
        axes.legend(fontsize="small")
    figure.savefig(path, dpi=120)


if __name__ == "__main__":
    draw(sys.argv[1] if len(sys.argv) > 1 else "press_fit.png")
