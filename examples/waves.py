"""A wave that repeats on a half-plane: pressure up to full contact, and what part of the surface touches and sticks.

python examples/waves.py [PICTURE.png]
"""

from __future__ import annotations

import sys

import matplotlib.pyplot as plt
import numpy as np

import mfv
from mfv import Body, Friction, Mesh, Scene, Step, reference

WAVELENGTH, AMPLITUDE, MU = 1.0, 0.5e-3, 0.3
G, NU = 70e3 / (2 * 1.33), 0.33
FORM = (AMPLITUDE, WAVELENGTH, G, 3 - 4 * NU)
FULL = 2 * np.pi * AMPLITUDE * G / (1 - NU)  # force at which everything touches


def pressed(share: float, *steps: Step) -> mfv.Result:
    """Pressed to a share of the force of full contact, without coupling as the closed forms."""
    return Scene(
        Body.half_plane(shear_modulus=G, poisson_ratio=NU),
        Body.wave(AMPLITUDE, WAVELENGTH, rigid=True),
        coupling="none",
        mesh=Mesh(nodes=200, period=WAVELENGTH),
        friction=Friction.coulomb(MU),
        steps=[Step(normal_force=share * FULL, friction=False), *steps],
    ).run(check=True)


def draw(path: str) -> None:
    figure, (left, right) = plt.subplots(1, 2, figsize=(10.0, 3.8), layout="constrained")
    for number, share in enumerate((0.1, 0.4, 0.8, 1.3)):
        result = pressed(share)
        left.plot(result.mesh.x, result.state.pressure, ".", markersize=3, color=f"C{number}", label=f"P = {share:g} P*")
        left.plot(
            result.mesh.x, reference.wave_pressure(result.mesh.x, share * FULL, *FORM), "-", linewidth=0.8, color=f"C{number}"
        )
    left.set(xlabel="x [mm]", ylabel="p [MPa]", title="Pressure (lines: Westergaard)")
    left.legend(fontsize="small")
    shares = np.linspace(0.05, 0.99, 15)
    results = [pressed(share, Step(force_ratio=0.5)) for share in shares]
    fine = np.linspace(0.01, 0.999, 200)
    touching = 2 * reference.wave_half_width(fine * FULL, *FORM) / WAVELENGTH
    right.plot(shares, [one.observables.contact_length / WAVELENGTH for one in results], "o", markersize=4, label="touches")
    right.plot(fine, touching, "C0-", linewidth=0.8)
    right.plot(
        shares,
        [one.observables.contact_length * one.observables.stick_ratio / WAVELENGTH for one in results],
        "s",
        markersize=4,
        label="sticks at Q = 0.5 μP",
    )
    right.plot(fine, touching * reference.wave_stick_ratio(0.5 * MU * fine * FULL, fine * FULL, MU, *FORM), "C1-", linewidth=0.8)
    right.set(xlabel="P / P*", ylabel="part of the surface", title="Contact and stick zones (lines: closed forms)", ylim=(0, 1.05))
    right.legend(fontsize="small")
    figure.savefig(path, dpi=120)


if __name__ == "__main__":
    draw(sys.argv[1] if len(sys.argv) > 1 else "waves.png")
