"""Draw the results of examples/hosts/newmark: a free decay with its quasi-static prediction, and Newton's residuals.

    python examples/hosts/draw_newmark.py PROGRAM [-o newmark_decay.png]

Needs numpy, matplotlib and the mfv package (for Mindlin's dissipation). PROGRAM is the built newmark.

The decay can be predicted. Friction is rate-independent: the dissipation of a half swing depends on its turning points, not on the
velocity. At a turning point the kinetic energy is zero, so the force does no net work between two of them: Q integrates to zero over
the half swing from (U0, Q0) to (U1, Q1). By Masing's rule U0 - U = 2 u(y), y = (Q0 - Q)/2, with the curve u(q) of first loading. With the dissipation
of a closed cycle between -y and y, D(y) = 4 y u(y) - 8 (integral of u over q from 0 to y), that is

    (Q0 - y) u(y) = D(y)/4,    Q1 = Q0 - 2 y,    U1 = U0 - 2 u(y),

and the half swing dissipates D(y)/2. For small forces u = q/K, K = 4 pi G/((kappa + 1) ln(2 d/a)) and
D = (kappa + 1) y^3/(12 pi G mu P), so that a whole swing takes Q0^2/(3 mu P ln(2 d/a)) off Q0: an amplitude falls as 1/(1 + c n),
not exponentially, 1/Q by 1/(3 mu P ln(2 d/a)) a swing.
"""

from __future__ import annotations

import argparse
import csv
import io
import subprocess
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import mfv

FORCE, MU, RADIUS, MODULUS = 1.0e-3, 0.7, 0.25, 1.0  # of newmark.c
DATUM = RADIUS
POISSON_RATIO = 0.5  # where pressure and shear do not couple, as in the closed forms
HALF_WIDTH = float(mfv.reference.hertz_half_width(FORCE, RADIUS, MODULUS, 3 - 4 * POISSON_RATIO))
LIMIT = MU * FORCE


def simulate(program: Path | str, *options: str) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray]]:
    """Columns of the program's table; with --verbose also those of its residuals."""
    done = subprocess.run([str(Path(program).resolve()), *options], capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(f"{program} {' '.join(options)}: {done.stderr}")
    return columns(done.stdout), columns(done.stderr)


def columns(text: str) -> dict[str, np.ndarray]:
    """Columns of a CSV text."""
    head, *rows = csv.reader(io.StringIO(text)) if text else [[]]
    return {name: np.array([float(row[i]) for row in rows]) for i, name in enumerate(head)}


def turning_points(table: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Turning points of the shift: the start, and the outer end of every time step in which the velocity changes its sign."""
    velocity, shift = table["shift_velocity"], table["shift"]
    places = [0]
    for i in np.flatnonzero(velocity[1:-1] * velocity[2:] < 0) + 1:
        places.append(i if (shift[i] - shift[i + 1]) * velocity[i] > 0 else i + 1)
    turns = {name: values[places] for name, values in table.items()}
    turns["energy"] = turns["kinetic"] + turns["potential"]
    return turns


def first_shift(force: float) -> float:
    """Shift on first loading, by Mindlin: mu times the difference of two approaches (Jaeger, Ciavarella)."""
    stuck = HALF_WIDTH * np.sqrt(1 - abs(force) / LIMIT)
    return np.sign(force) * MU * (approach(HALF_WIDTH) - approach(stuck))


def approach(half_width: float) -> float:
    """Approach of a rigid cylinder that makes a contact of this half-width."""
    return half_width**2 / (2 * RADIUS) * (np.log(2 * DATUM / half_width) + 0.5)


def dissipation(force: float) -> float:
    """Energy of a cycle between -force and force, by Mindlin."""
    return float(mfv.reference.mindlin_dissipation(force, FORCE, HALF_WIDTH, RADIUS, MU))


def predicted_turns(force: float, number: int) -> tuple[np.ndarray, np.ndarray]:
    """Forces and shifts of the turning points of a free decay from `force` on, by the equation above."""
    forces, shifts = [force], [first_shift(force)]
    for _ in range(number - 1):
        size, sign = abs(forces[-1]), np.sign(forces[-1])
        half_range = size
        for _ in range(100):
            half_range = size - dissipation(half_range) / (4 * first_shift(half_range))
        forces.append(sign * (size - 2 * half_range))
        shifts.append(shifts[-1] - sign * 2 * first_shift(half_range))
    return np.array(forces), np.array(shifts)


def draw_decay(ax: Axes, program: Path | str) -> None:
    """A free decay with the turning points predicted by quasi-static dissipation."""
    amplitude = 0.8
    table, _ = simulate(program, "--amplitude", str(amplitude), "--nodes", "201", "--periods", "15")
    turns = turning_points(table)
    number = len(turns["time"])
    _, shifts = predicted_turns(amplitude * LIMIT, number)
    scale = abs(shifts[0])
    ax.plot(table["time"], table["shift"] / scale, lw=1, label="Newmark")
    for side, label in ((0, "turning points by Mindlin's dissipation"), (1, None)):
        ax.plot(turns["time"][side::2], shifts[side::2] / scale, "o--", color="C3", ms=3.5, lw=0.8, label=label)
    ax.set(xlabel="time / period of small vibrations", ylabel="shift / first shift", title="Free decay", ylim=(-1.15, 1.45))
    ax.legend(loc="upper right", fontsize="small")


def draw_residuals(ax: Axes, program: Path | str) -> None:
    """Residuals of one large time step, with the tangent and with the initial stiffness."""
    step = ["--amplitude", "0", "--force", "0.5", "--steps", "1", "--periods", "1", "--verbose"]
    least = 1e-16  # in place of zero, on the logarithmic axis
    for nodes, marker in ((101, "s"), (401, "o")):
        _, newton = simulate(program, *step, "--nodes", str(nodes))
        ax.semilogy(
            newton["iteration"], np.maximum(newton["residual"], least), marker=marker, ms=4, label=f"tangent, {nodes} nodes"
        )
    _, initial = simulate(program, *step, "--nodes", "101", "--initial-stiffness")
    ax.semilogy(initial["iteration"], initial["residual"], "^-", ms=3, label="initial stiffness, 101 nodes")
    ax.set(xlabel="iteration", ylabel="residual / (mu P)", title="One large time step", xticks=range(0, 20, 4))
    ax.legend(loc="upper right", fontsize="small")


def main() -> None:
    """Read the options, draw."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=Path, help="the built newmark")
    parser.add_argument("-o", "--output", type=Path, default=Path("newmark_decay.png"))
    options = parser.parse_args()
    figure = Figure(figsize=(9.6, 3.8), layout="constrained")
    left, right = figure.subplots(1, 2, width_ratios=(1.5, 1))
    draw_decay(left, options.program)
    draw_residuals(right, options.program)
    figure.savefig(options.output, dpi=110)


if __name__ == "__main__":
    main()
