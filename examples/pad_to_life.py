"""From a pad to a life: stick zone, stress at the trailing edge, wear and life of a pad, each with its error; all constants are made up."""

import numpy as np

import mfv
from mfv import Body, Friction, Mesh, Output, Scene, Step, Wear, fatigue

# An aluminium pad of 75 mm: peak pressure 157 MPa, Q = 0.6 mu P and a bulk stress of 92.7 MPa in phase.
RADIUS, PEAK, MU, RATIO, BULK = 75.0, 157.0, 0.75, 0.6, 92.7
ALLOY = fatigue.StrainLife(74000.0, 1015.0, -0.11, 0.21, -0.52, 0.33)
HALF_WIDTH = 4.0 * RADIUS * PEAK * (1.0 - 0.33**2) / 74000.0
WEAR = 1.0e-8  # mm^2/N


def solved(nodes: int, cycles: int = 2, wear: Wear | None = None) -> mfv.Result:
    alloy = {"youngs_modulus": 74000.0, "poisson_ratio": 0.33}
    press = Step(normal_force=0.5 * np.pi * HALF_WIDTH * PEAK, friction=False)
    pull, push = (Step(force_ratio=s * RATIO, lower_bulk_stress=s * BULK, cycles=n) for s, n in ((1, None), (-1, cycles)))
    mesh, friction, output = Mesh(nodes=nodes), Friction.coulomb(MU), Output(history="steps", states="last_cycle")
    bodies = Body.half_plane(**alloy), Body.disk(RADIUS, **alloy)
    return Scene(*bodies, mesh=mesh, friction=friction, steps=[press, pull, push], wear=wear, output=output).run(check=True)


def show(name: str, unit: str, coarse: float, fine: float) -> None:
    print(f"{name:28} {fine:10.4g} +- {abs(fine - coarse):.1g} {unit}")


if __name__ == "__main__":
    meshes = [solved(nodes) for nodes in (101, 201)]
    peaks = [fatigue.smith_watson_topper(fatigue.stress_cycle(r, *fatigue.graded_points(r))).maximum for r in meshes]
    lives = [fatigue.life(peak.value, ALLOY.smith_watson_topper) for peak in peaks]
    depths = [solved(101, 10000, Wear(coefficient=WEAR, tolerance=t)).observables.wear_depth for t in (0.01, 0.001)]
    show("stick zone over contact", "", *(r.summary.stick_ratio for r in meshes))
    show("largest tension", "MPa", *(r.observables.lower_tension for r in meshes))
    show("  at x", "mm", *(r.observables.lower_tension_x for r in meshes))
    show("wear after 10 000 cycles", "um", *(1000.0 * d for d in depths))
    show("Smith-Watson-Topper", "MPa", *(peak.value for peak in peaks))
    show("life at the hot spot", "cycles", *lives)
