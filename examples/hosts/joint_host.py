"""A mass and a beam on frictional joints in time, with joint elements and with MFV itself as the joint: decay and frequency compared.

    python examples/hosts/joint_host.py [-o joint_host.png]

The joint: two equal steel cylinders, pressed, then sheared (N, mm, t, s; all per mm of thickness). The beam is hinged at both ends on
its neutral axis and held there between two pairs of such cylinders, at the distance ARM above and below: a rotation shifts both pairs
by ARM times the angle, in opposite directions, so that one of them is computed and counted twice. Newmark's method (average
acceleration, without numerical damping) with Newton's in every time step.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh

import mfv
from mfv import Body, Friction, Mesh, Output, Scene, Step, joint

Array = NDArray[np.float64]

YOUNGS_MODULUS, POISSON_RATIO, DENSITY = 210e3, 0.3, 7.85e-9  # steel: MPa, -, t/mm^3
RADIUS, MU = 100.0, 0.3
FORCES = 500.0, 400.0  # normal forces of the joints at the left and at the right end, N/mm
SPAN, HEIGHT, ELEMENTS, ARM = 400.0, 20.0, 8, 10.0  # of the beam, mm
NODES = 121  #: of the mesh of a joint, 110 of them in contact
#: Newton's method ends at this residual, relative to the sliding limit.
TOLERANCE = 1.0e-9


def half_width(normal_force: float) -> float:
    """Of the contact (Hertz): equal bodies have half the modulus of one, two radii half the radius."""
    modulus = YOUNGS_MODULUS / (2.0 * (1.0 + POISSON_RATIO))
    return float(mfv.reference.hertz_half_width(normal_force, 0.5 * RADIUS, 0.5 * modulus, 3.0 - 4.0 * POISSON_RATIO))


def scene(normal_force: float, nodes: int = NODES) -> Scene:
    """Two steel cylinders, pressed without friction. Equal bodies: shear and pressure do not couple."""
    steel = {"youngs_modulus": YOUNGS_MODULUS, "poisson_ratio": POISSON_RATIO}
    return Scene(
        Body.disk(RADIUS, **steel),
        Body.disk(RADIUS, **steel),
        friction=Friction.coulomb(MU),
        mesh=Mesh(nodes=nodes, half_width=1.1 * half_width(normal_force)),
        steps=[Step(normal_force=normal_force, friction=False)],
        output=Output(history="none", states="none"),  # any state can be restored
        length_unit="mm",
        force_unit="N",
    )


class Contact:
    """MFV with `start` and `update` of a joint element; a state is one of the case."""

    def __init__(self, pressed: Scene) -> None:
        self.case = pressed.contact()
        self.case.run(check=True)
        self.origin = self.case.loads.shift

    def start(self) -> mfv.State:
        return self.case.save()

    def update(self, state: mfv.State, displacement: float) -> tuple[float, float, mfv.State]:
        """Force, tangent at constant normal force, and the state there."""
        self.case.restore(state)
        self.case.advance(shift=self.origin + displacement, check=True)
        (aa, au), (ua, uu) = self.case.tangent()
        return self.case.loads.tangential_force, float(uu - ua * au / aa), self.case.save()


@dataclass
class Structure:
    """Masses and springs with joints: the joint i is displaced by arms[i] @ u, and pushes back by its force times counts[i]."""

    mass: Array
    stiffness: Array
    arms: Array
    count: float
    limit: float  #: force by which residuals are judged

    def reaction(self, models: Sequence[Any], states: list[Any], u: Array) -> tuple[Array, Array, list[Any]]:
        """Forces, their derivatives and the states of the joints at a displacement, from states."""
        updates = [model.update(state, float(arm @ u)) for model, state, arm in zip(models, states, self.arms)]
        force = self.stiffness @ u + self.count * sum(update[0] * arm for update, arm in zip(updates, self.arms))
        tangent = self.stiffness + self.count * sum(update[1] * np.outer(arm, arm) for update, arm in zip(updates, self.arms))
        return force, tangent, [update[2] for update in updates]

    def equilibrium(self, models: Sequence[Any], states: list[Any], load: Array, added: Array, u: Array) -> tuple[Array, list[Any]]:
        """Solve `added` u + reaction = load by Newton's method. Raises RuntimeError."""
        for _ in range(50):
            force, tangent, reached = self.reaction(models, states, u)
            residual = load - force - added @ u
            if np.max(np.abs(residual)) < TOLERANCE * self.limit:
                return u, reached
            u = u + np.linalg.solve(tangent + added, residual)
        raise RuntimeError("Newton's method did not converge")


class Motion(NamedTuple):
    time: Array
    displacement: Array  #: a row for each time


def released(structure: Structure, models: Sequence[Any], load: Array, step: float, steps: int) -> Motion:
    """Load a structure slowly, release it, and follow it by Newmark's method."""
    none = np.zeros_like(structure.mass)
    u, states = structure.equilibrium(models, [model.start() for model in models], load, none, np.zeros(load.size))
    velocity, acceleration = np.zeros(load.size), np.linalg.solve(structure.mass, -load)
    inertia = 4.0 / step**2 * structure.mass
    path = [u]
    for _ in range(steps):
        pushed = structure.mass @ (4.0 / step**2 * u + 4.0 / step * velocity + acceleration)
        new, states = structure.equilibrium(models, states, pushed, inertia, u)
        change = 2.0 / step * (new - u) - velocity
        acceleration = 2.0 / step * (change - velocity) - acceleration
        u, velocity = new, change
        path.append(u)
    return Motion(step * np.arange(steps + 1), np.array(path))


# --- the structures ---


def oscillator(period: float, stiffness: float) -> Structure:
    """A mass on the left joint, with this period as long as all sticks: `stiffness` of the joint."""
    mass = stiffness * (period / (2.0 * np.pi)) ** 2
    return Structure(np.array([[mass]]), np.zeros((1, 1)), np.ones((1, 1)), 1.0, MU * FORCES[0])


def beam() -> Structure:
    """Euler and Bernoulli's beam, a deflection and a rotation for each node, the ends hinged; a joint at either end."""
    size, bending = SPAN / ELEMENTS, YOUNGS_MODULUS * HEIGHT**3 / 12.0
    scale = np.diag([1.0, size, 1.0, size])
    k = np.array([[12, 6, -12, 6], [6, 4, -6, 2], [-12, -6, 12, -6], [6, 2, -6, 4]])
    m = np.array([[156, 22, 54, -13], [22, 4, 13, -3], [54, 13, 156, -22], [-13, -3, -22, 4]])
    stiffness, mass = np.zeros((2, 2 * ELEMENTS + 2, 2 * ELEMENTS + 2))
    for i in range(0, 2 * ELEMENTS, 2):
        stiffness[i : i + 4, i : i + 4] += bending / size**3 * scale @ k @ scale
        mass[i : i + 4, i : i + 4] += DENSITY * HEIGHT * size / 420.0 * scale @ m @ scale
    free = [i for i in range(2 * ELEMENTS + 2) if i not in (0, 2 * ELEMENTS)]
    arms = np.zeros((2, len(free)))
    arms[0, 0], arms[1, -1] = ARM, ARM
    return Structure(mass[np.ix_(free, free)], stiffness[np.ix_(free, free)], arms, 2.0, ARM * MU * FORCES[1])


def first_mode(structure: Structure, stiffness: Sequence[float]) -> tuple[float, Array]:
    """Angular frequency and shape, of unit mass, while all sticks: `stiffness` of each joint."""
    stuck = structure.stiffness + structure.count * (structure.arms.T * np.asarray(stiffness)) @ structure.arms
    squares, shapes = eigh(stuck, structure.mass)
    return float(np.sqrt(squares[0])), shapes[:, 0]


# --- what is compared ---


def decay(time: Array, coordinate: Array) -> tuple[Array, Array]:
    """Amplitudes, of a parabola through the largest points, and frequencies of the cycles of a decaying motion."""
    value = np.abs(coordinate)
    peaks = 1 + np.flatnonzero((value[1:-1] >= value[:-2]) & (value[1:-1] > value[2:]))
    low, top, high = value[peaks - 1], value[peaks], value[peaks + 1]
    amplitudes = top + (high - low) ** 2 / (8.0 * (2.0 * top - low - high))
    down = np.flatnonzero((coordinate[:-1] > 0.0) & (coordinate[1:] <= 0.0))
    crossed = time[down] + (time[down + 1] - time[down]) * coordinate[down] / (coordinate[down] - coordinate[down + 1])
    return amplitudes, 1.0 / np.diff(crossed)


def models_of(measured: joint.Measurement) -> dict[str, joint.Model]:
    """The models that are compared, by name."""
    return {
        "table": joint.table(measured.backbone),
        "Iwan, 40 cells": joint.iwan(measured.backbone, 40),
        "Iwan, 10 cells": joint.iwan(measured.backbone, 10),
        "Segalman": joint.segalman(measured),
        "Bouc and Wen": joint.bouc_wen(measured),
    }


class Comparison(NamedTuple):
    """A motion with a model in place of MFV: largest relative errors of amplitude and frequency, and how long it took."""

    name: str
    amplitudes: Array
    frequencies: Array
    amplitude_error: float
    frequency_error: float
    seconds: float


def compare(
    structure: Structure, choices: dict[str, Sequence[Any]], mode: Array, load: Array, step: float, steps: int
) -> list[Comparison]:
    """Decay and frequency of a structure in the first mode for each choice of its joints, MFV the first."""
    rows: list[Comparison] = []
    for name, models in choices.items():
        begin = time.perf_counter()
        motion = released(structure, models, load, step, steps)
        taken = time.perf_counter() - begin
        amplitudes, frequencies = decay(motion.time, motion.displacement @ structure.mass @ mode)
        exact = rows[0] if rows else Comparison(name, amplitudes, frequencies, 0.0, 0.0, taken)
        count = min(amplitudes.size, exact.amplitudes.size), min(frequencies.size, exact.frequencies.size)
        errors = (
            float(np.max(np.abs(amplitudes[: count[0]] / exact.amplitudes[: count[0]] - 1.0))),
            float(np.max(np.abs(frequencies[: count[1]] / exact.frequencies[: count[1]] - 1.0))),
        )
        rows.append(Comparison(name, amplitudes, frequencies, *errors, taken))
    return rows


def choices_of(count: int) -> tuple[dict[str, Sequence[Any]], list[float]]:
    """Joints of a structure by the name of their model, MFV the first; and the stiffness of each while all sticks."""
    measured = [joint.measure(scene(force)) for force in FORCES[:count]]
    models = [models_of(each) for each in measured]
    choices: dict[str, Sequence[Any]] = {"MFV": [Contact(scene(force)) for force in FORCES[:count]]}
    choices |= {name: [each[name] for each in models] for name in models[0]}
    finer = [joint.measure(scene(force, 3 * NODES)).backbone for force in FORCES[:count]]
    choices[f"table, {3 * NODES} nodes"] = [joint.table(curve) for curve in finer]
    return choices, [float(each.backbone.stiffness[0]) for each in measured]


def compare_oscillator(periods: int = 12, steps: int = 60) -> list[Comparison]:
    """A mass with the period 1 ms on one joint, released at 0.8 mu P."""
    choices, stiffness = choices_of(1)
    structure = oscillator(1.0e-3, stiffness[0])
    mode = np.ones(1) / np.sqrt(structure.mass[0, 0])
    return compare(structure, choices, mode, np.array([0.8 * MU * FORCES[0]]), 1.0e-3 / steps, periods * steps)


def compare_beam(periods: int = 12, steps: int = 60) -> list[Comparison]:
    """The beam, bent by the inertia forces of its first mode so that the left joint would carry 0.7 mu P if all stuck, and released."""
    choices, stiffness = choices_of(2)
    structure = beam()
    frequency, mode = first_mode(structure, stiffness)
    bent = frequency**2 * structure.mass @ mode * 0.7 * MU * FORCES[0] / (stiffness[0] * abs(structure.arms[0] @ mode))
    return compare(structure, choices, mode, bent, 2.0 * np.pi / frequency / steps, periods * steps)


def described(title: str, rows: list[Comparison]) -> str:
    """A table."""
    first, last = rows[0].frequencies[0], rows[0].frequencies[-1]
    lines = [f"{title}: {rows[0].frequencies.size} cycles, from {first:.1f} to {last:.1f} Hz, amplitude down to "]
    lines[0] += f"{rows[0].amplitudes[-1] / rows[0].amplitudes[0]:.2f} of the first"
    lines += ["joint              amplitude  frequency   time"]
    for row in rows:
        lines.append(f"{row.name:18} {100 * row.amplitude_error:8.3f}% {100 * row.frequency_error:8.3f}%  {row.seconds:5.2f} s")
    return "\n".join(lines)


def main() -> None:
    parser = argparse.ArgumentParser(description="joint elements in a mass and a beam, compared with MFV")
    parser.add_argument("-o", "--output", help="picture to draw")
    options = parser.parse_args()
    both = {"A mass on a joint": compare_oscillator(), "A beam with two joints": compare_beam()}
    for title, rows in both.items():
        print(described(title, rows))
    if options.output:
        draw(both, options.output)


def draw(both: dict[str, list[Comparison]], path: str) -> None:
    """Amplitudes and frequencies of both structures over the cycles."""
    from matplotlib.figure import Figure

    picture = Figure(figsize=(9.6, 6.4), layout="constrained")
    for (title, rows), (left, right) in zip(both.items(), picture.subplots(2, 2)):
        for row in rows:
            style = {"color": "k", "linewidth": 2.5, "alpha": 0.35} if row is rows[0] else {"marker": ".", "linewidth": 0.8}
            left.semilogy(
                0.5 * np.arange(1, row.amplitudes.size + 1), row.amplitudes / rows[0].amplitudes[0], label=row.name, **style
            )
            right.plot(0.75 + np.arange(row.frequencies.size), row.frequencies, **style)
        left.set(title=title, xlabel="cycles", ylabel="amplitude over the first one")
        right.set(xlabel="cycles", ylabel="frequency, Hz")
        left.legend(fontsize="small")
    picture.savefig(path, dpi=110)


if __name__ == "__main__":
    main()
