"""From a coarse finite-element model to a life: loads and bulk stress of a pad of CalculiX, its sub-model, stress at the edge, life; made-up constants."""

from pathlib import Path

import numpy as np

import mfv
from mfv import Body, Friction, History, Mesh, Output, Scene, fatigue

# An aluminium pad of 75 mm on 952 elements, four across half the contact: bench/finite_element_pad.py wrote the files.
RESULT = Path(__file__).parent / "fe_pad/pad.frd"
RADIUS, MU = 75.0, 0.75
ALLOY = fatigue.StrainLife(74000.0, 1015.0, -0.11, 0.21, -0.52, 0.33)


def solved(table: dict[str, np.ndarray], nodes: int = 201) -> mfv.Result:
    """The sub-model: pressed by the first row, a cycle of the last two."""
    alloy = {"youngs_modulus": 74000.0, "poisson_ratio": 0.33}
    bodies = Body.half_plane(**alloy), Body.disk(RADIUS, elasticity="half_plane", **alloy)
    history = History.from_table(table, period=2, cycles=2)
    output = Output(history="steps", states="last_cycle")
    return Scene(
        *bodies, mesh=Mesh(nodes=nodes, refine="edges"), friction=Friction.coulomb(MU), history=history, output=output
    ).run(check=True)


def answer(result: mfv.Result) -> tuple[float, float, float]:
    """Largest tension of the cycle, Smith-Watson-Topper parameter, life."""
    peak = fatigue.smith_watson_topper(fatigue.stress_cycle(result, *fatigue.graded_points(result))).maximum.value
    return float(result.observables.largest_lower_tension), peak, fatigue.life(peak, ALLOY.smith_watson_topper)


if __name__ == "__main__":
    loads = mfv.loads.from_fe(RESULT, "UPPER_SURFACE", opposite="LOWER_SURFACE", centre=0.0)
    for at, time in enumerate(loads.t):
        bulk = f"{loads.lower_bulk.stress[at]:.1f} +- {loads.lower_bulk.error[at]:.1f}"
        print(f"time {time:g}: P {loads.P[at]:.2f}, Q {round(loads.Q[at], 2) + 0.0:.2f} N/mm, bulk stress {bulk} MPa")
    table = loads.table()
    middle, finer = answer(solved(table)), answer(solved(table, 401))
    off = [answer(solved(table | {"lower_bulk_stress": loads.lower_bulk.stress + s * loads.lower_bulk.error})) for s in (-1, 1)]
    print(f"{'':28}{'value':>12}{'mesh':>10}{'bulk stress':>14}")
    names = ("largest tension, MPa", "Smith-Watson-Topper, MPa", "life, cycles")
    for name, value, fine, low, high in zip(names, middle, finer, *off):
        print(f"{name:28}{value:12.4g}{abs(fine - value):10.1g}{0.5 * abs(high - low):14.1g}")
