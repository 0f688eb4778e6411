"""Dissipation of small slip zones on equal and on refined meshes, against the closed form.

    python examples/microslip.py [-o PICTURE.png]

A rigid cylinder is pressed on a half-plane without friction and sheared by forces from 0.01 to 0.99 of the sliding limit. The right
picture has the width of the intervals at Q = 0.2 mu P.
"""

from __future__ import annotations

import argparse
import math

import numpy as np

import mfv
from mfv import Body, Friction, Mesh, Scene, Step, reference

MU, FORCE, RADIUS = 0.5, math.pi / 4, 1.0
HALF_WIDTH = float(reference.hertz_half_width(FORCE, RADIUS, 0.5, 3.0))
RATIOS = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 0.8, 0.95, 0.99)
MESHES = {
    "401 equal": {"nodes": 401},
    "150 refined": {"nodes": 150, "refine": "edges"},
    "300 refined": {"nodes": 300, "refine": "edges"},
}


def sheared(ratio: float, mesh: dict) -> mfv.Result:
    """Pressed, then sheared by `ratio` of the sliding limit."""
    return Scene(
        Body.half_plane(youngs_modulus=1.0, poisson_ratio=0.0),
        Body.disk(RADIUS, rigid=True),
        coupling="none",
        mesh=Mesh(gap="parabolic", **mesh),
        friction=Friction.coulomb(MU),
        steps=[Step(normal_force=FORCE, friction=False), Step(force_ratio=ratio)],
    ).run()


def error(ratio: float, mesh: dict) -> float:
    """Relative error of the dissipation; that of the first loading is a quarter of that of a cycle."""
    cycle = reference.mindlin_dissipation(ratio * MU * FORCE, FORCE, HALF_WIDTH, RADIUS, MU)
    return abs(4.0 * sheared(ratio, mesh).summary.dissipation / float(cycle) - 1.0)


def draw(errors: dict[str, list[float]], path: str) -> None:
    """Both pictures."""
    import matplotlib.pyplot as plt

    figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.6), layout="constrained")
    for name, values in errors.items():
        left.loglog(RATIOS, values, "o-", label=name)
        mesh = sheared(0.2, MESHES[name]).mesh
        right.semilogy(mesh.x / HALF_WIDTH, mesh.width / HALF_WIDTH, ".-", label=name)
    left.set(xlabel="tangential force over sliding limit, Q/(mu P)", ylabel="relative error of the dissipation")
    right.set(xlabel="position x/a", ylabel="width of the interval over a")
    left.legend()
    figure.savefig(path, dpi=120)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", help="picture")
    options = parser.parse_args()
    errors = {name: [error(ratio, mesh) for ratio in RATIOS] for name, mesh in MESHES.items()}
    print("Q/(mu P)  " + "  ".join(f"{name:>12}" for name in errors))
    for i, ratio in enumerate(RATIOS):
        print(f"{ratio:8g}  " + "  ".join(f"{np.format_float_scientific(values[i], 1):>12}" for values in errors.values()))
    if options.output:
        draw(errors, options.output)


if __name__ == "__main__":
    main()
