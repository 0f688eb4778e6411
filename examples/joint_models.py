"""Reduced models of a joint, fitted to two cylinders and compared with MFV, and where no such model predicts the dissipation.

    python examples/joint_models.py [-o PICTURE.png]

Two equal steel cylinders (N, mm, per mm of thickness), where shear and pressure do not couple: sliders of the Iwan model against the
closed form of Cattaneo and Mindlin, dissipation and stiffness of five models over the amplitude. Then a rigid cylinder on a
half-plane, Poisson's ratio 0.3, full coupling, pressed with and without friction: the same by Masing's rules.
"""

from __future__ import annotations

import argparse
import math
from typing import Any

import numpy as np

import mfv
from mfv import Body, Friction, Mesh, Scene, Step, joint

FORCE, RADIUS, MU = 500.0, 100.0, 0.3
STEEL = {"youngs_modulus": 210e3, "poisson_ratio": 0.3}
MODULUS = STEEL["youngs_modulus"] / (4.0 * (1.0 - STEEL["poisson_ratio"] ** 2))  # contact modulus m: 1/m = 2 (kappa + 1)/(4 G)
HALF_WIDTH = math.sqrt(FORCE * RADIUS / (math.pi * MODULUS))  # Hertz, relative radius RADIUS/2
#: Arguments of the closed forms of mfv.joint; the datum of disks is their radius.
CLOSED = FORCE, HALF_WIDTH, RADIUS, MODULUS, MU
RATIOS = (0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95)
COUPLED_RATIOS = (0.1, 0.2, 0.3, 0.5, 0.7, 0.9)


def cylinders(nodes: int = 300) -> Scene:
    """Two steel cylinders, pressed."""
    return Scene(
        Body.disk(RADIUS, **STEEL),
        Body.disk(RADIUS, **STEEL),
        friction=Friction.coulomb(MU),
        mesh=Mesh(nodes=nodes, refine="edges"),
        steps=[Step(normal_force=FORCE, friction=False)],
    )


def coupled(friction: bool, nodes: int = 300) -> Scene:
    """A rigid cylinder on a half-plane, pressed with or without friction."""
    return Scene(
        Body.half_plane(youngs_modulus=1.0, poisson_ratio=0.3),
        Body.disk(1.0, rigid=True),
        friction=Friction.coulomb(0.5),
        mesh=Mesh(nodes=nodes, refine="edges"),
        steps=[Step(normal_force=0.01, friction=friction)],
    )


def models_of(measured: joint.Measurement) -> dict[str, joint.Model]:
    """Five models by name."""
    return {
        "table": joint.table(measured.backbone),
        "Masing": joint.Masing.of(measured.backbone),
        "Iwan, 20 cells": joint.iwan(measured.backbone, 20),
        "Segalman": joint.segalman(measured),
        "Bouc and Wen": joint.bouc_wen(measured),
    }


def largest(values: np.ndarray) -> float:
    """Largest magnitude, in percent."""
    return 100.0 * float(np.max(np.abs(values)))


def described(assessed: dict[str, joint.Assessment]) -> str:
    """A table of the largest errors."""
    lines = ["model            dissipation  stiffness   force"]
    for name, found in assessed.items():
        errors = found.dissipation_error, found.stiffness_error, found.force_error
        lines.append(f"{name:17}" + "".join(f"{largest(values):9.2f}%" for values in errors))
    return "\n".join(lines)


def histories() -> dict[str, tuple[joint.Measurement, dict[str, joint.Assessment]]]:
    """Cycles with full coupling after both beginnings, against Masing's rules on first loading and on the largest cycle."""
    found = {}
    for name, friction in (("pressed without friction", False), ("pressed with friction", True)):
        measured = joint.measure(coupled(friction), COUPLED_RATIOS, repeats=3)
        curves = {"first loading": measured.backbone, "largest cycle": measured.cycles[-1].backbone()}
        found[name] = (
            measured,
            {key: joint.assess(joint.Masing(curve.displacement, curve.force), measured) for key, curve in curves.items()},
        )
    return found


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", help="picture")
    options = parser.parse_args()
    measured = joint.measure(cylinders(), RATIOS)
    models = models_of(measured)
    assessed = {name: joint.assess(model, measured) for name, model in models.items()}
    print(
        f"two cylinders, {len(measured.cycles)} amplitudes: largest errors\n{described(assessed)}\n{models['Segalman']}\n{models['Bouc and Wen']}"
    )
    cases = histories()
    for name, (_, found) in cases.items():
        print(f"full coupling, {name}, Masing's rules on the curve of\n{described(found)}")
    ratios = [one.dissipation / two.dissipation for one, two in zip(*(cycles.cycles for cycles, _ in reversed(cases.values())))]
    print("dissipation with over without friction while pressing:", np.round(ratios, 3))
    if options.output:
        draw(measured, assessed, cases, options.output)


def draw(measured: joint.Measurement, assessed: dict[str, joint.Assessment], cases: Any, path: str) -> None:
    """Sliders, dissipation, and its error by model and by history."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.0, 7.2), layout="constrained")
    (sliders, energies), (errors, coupled_errors) = figure.subplots(2, 2)
    limit = MU * FORCE
    _distribution(sliders, measured.backbone)
    exact = mfv.reference.mindlin_dissipation(np.array(RATIOS) * limit, FORCE, HALF_WIDTH, 0.5 * RADIUS, MU)
    energies.loglog(RATIOS, exact, "0.6", linewidth=3, label="Mindlin")
    for name, found in assessed.items():
        energies.loglog(RATIOS, found.dissipation * (1.0 + found.dissipation_error), ".", label=name)
        if name not in ("table", "Masing"):
            errors.plot(RATIOS, 100.0 * found.dissipation_error, ".-", label=f"{name}, dissipation")
            errors.plot(RATIOS, 100.0 * found.stiffness_error, "--", color=errors.lines[-1].get_color(), label="stiffness")
    energies.set(
        xlabel="tangential force over sliding limit",
        ylabel="energy of a cycle, N mm/mm",
        title="Two cylinders: dissipation, slope 3 at small forces",
    )
    errors.set(xlabel="tangential force over sliding limit", ylabel="error, %", title="Two cylinders: errors of the models")
    for name, (_, by_curve) in cases.items():
        for curve, found in by_curve.items():
            style = "--" if "without" in name else "-"
            coupled_errors.plot(COUPLED_RATIOS, 100.0 * found.dissipation_error, f".{style}", label=f"{name}; {curve}")
    title = "Masing's rules with full coupling"
    coupled_errors.set(xlabel="tangential force over sliding limit", ylabel="error of dissipation, %", title=title)
    for ax in (sliders, energies, errors, coupled_errors):
        ax.legend(fontsize="x-small")
        ax.grid(alpha=0.3)
    figure.savefig(path, dpi=110)


def _distribution(ax: Any, backbone: joint.Backbone) -> None:
    """Slider density of MFV's backbone, the change of its slope over 15 cells, and of Cattaneo and Mindlin."""
    shifts, density, _ = joint.mindlin_distribution(np.linspace(0.0, 0.985, 300) * MU * FORCE, *CLOSED)
    edges = np.linspace(0.0, shifts[-1], 16)
    middles = 0.5 * (backbone.displacement[1:] + backbone.displacement[:-1])
    found = -np.diff(np.interp(edges, middles, backbone.stiffness)) / np.diff(edges)
    ax.stairs(found, 1.0e3 * edges, label="MFV's backbone, 15 cells", fill=True, alpha=0.4)
    ax.semilogy(1.0e3 * shifts, density, "k", linewidth=1, label="Cattaneo and Mindlin, closed form")
    ax.set(
        xlabel="displacement at which a slider slides, um",
        ylabel="density of stiffness, N/mm^2 per mm per mm",
        title="Two cylinders: slider distribution",
    )


if __name__ == "__main__":
    main()
