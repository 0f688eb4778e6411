"""Wear of a cylinder on a flat: partial slip wears until the stick zone carries the load, gross slip widens a scar.

python examples/wear.py [PICTURE.png [ANIMATION.gif]]
"""

from __future__ import annotations

import sys

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.animation import FuncAnimation, PillowWriter

import mfv

FORCE, MU, RADIUS = 1.0e-3, 0.5, 1.0
PLANE = mfv.Body.half_plane(shear_modulus=1.0, poisson_ratio=0.3)
MODULUS = 2.0 / 0.7  # of the contact
HERTZ = np.sqrt(4.0 * FORCE * RADIUS / (np.pi * MODULUS))  # half-width
PRESSURE = 2.0 * FORCE / (np.pi * HERTZ)


def worn(*steps: mfv.Step, coefficient: float) -> mfv.Result:
    return mfv.Scene(
        PLANE,
        mfv.Body.disk(RADIUS, rigid=True),
        coupling="none",
        mesh=mfv.Mesh(nodes=201),
        friction=mfv.Friction.coulomb(MU),
        wear=mfv.Wear(coefficient=coefficient),
        steps=[mfv.Step(normal_force=FORCE), *steps],
        output=mfv.Output(history="steps"),
    ).run(check=True)


def cycle_ends(result: mfv.Result) -> list[mfv.Group]:
    """The states after the blocks of cycles."""
    return [state for state in result.steps if state.step == 3 and state.reversal % 2 == 0]


def worn_limit(x: np.ndarray) -> np.ndarray:
    """Pressure of a parabola that touches over the stick zone of Q = mu P/2 only, with sharp ends (Ciavarella and Hills 1999)."""
    edge = HERTZ * np.sqrt(0.5)
    part = np.pi * MODULUS * edge**2 / (4.0 * RADIUS)
    root = np.sqrt(np.maximum(edge**2 - x**2, 0.0))
    with np.errstate(divide="ignore"):
        return np.where(root > 0.0, 2.0 * part * root / (np.pi * edge**2) + (FORCE - part) / (np.pi * root), np.nan)


def draw(partial: mfv.Result, gross: mfv.Result, path: str) -> None:
    figure, (left, right) = plt.subplots(1, 2, figsize=(10.0, 4.0), layout="constrained")
    ends = cycle_ends(partial)
    shades = plt.get_cmap("viridis")
    for share in (0.0, 0.35, 0.6, 0.8, 1.0):
        state = ends[round(share * (len(ends) - 1))]
        left.plot(
            partial.mesh.x / HERTZ, state.pressure / PRESSURE, color=shades(0.9 * share), label=f"{state.reversal // 2:.1e} cycles"
        )
    x = np.linspace(-0.706, 0.706, 501) * HERTZ
    left.plot(x / HERTZ, worn_limit(x) / PRESSURE, "k--", label="closed form, fully worn")
    left.set(xlabel="x/a", ylabel="p/p0", title="Partial slip, Q = ±0.5 μP", ylim=(0.0, 2.5), xlim=(-1.2, 1.2))
    left.legend(fontsize="small")
    ends = cycle_ends(gross)
    volume = np.array([np.sum(state.wear_depth * gross.mesh.width) for state in ends])
    width = np.array([0.5 * state.contact_length for state in ends])
    cycles = np.array([state.reversal // 2 for state in ends])
    right.loglog(cycles, width / HERTZ, "o-", markersize=3, label="MFV")
    right.loglog(cycles, np.cbrt(1.5 * RADIUS * volume) / HERTZ, "k--", label="a = (3 R V/2)^(1/3)")
    right.set(xlabel="cycles", ylabel="half-width of the scar / a", title="Gross slip: every point slides over 4(U - U_e)")
    right.legend()
    figure.savefig(path, dpi=110)


def animate(gross: mfv.Result, path: str) -> None:
    ends = cycle_ends(gross)[:: max(1, len(cycle_ends(gross)) // 30)]
    figure, (top, bottom) = plt.subplots(2, 1, figsize=(5.0, 4.6), sharex=True, layout="constrained")
    (pressure,) = top.plot(gross.mesh.x / HERTZ, ends[0].pressure / PRESSURE)
    (depth,) = bottom.plot(gross.mesh.x / HERTZ, -ends[0].wear_depth)
    top.set(ylabel="p/p0", ylim=(0.0, 1.2))
    bottom.set(xlabel="x/a", ylabel="- depth of wear", ylim=(-1.05 * ends[-1].wear_depth.max(), 0.0))

    def show(number: int) -> list:
        state = ends[number]
        pressure.set_ydata(state.pressure / PRESSURE)
        depth.set_ydata(-state.wear_depth)
        top.set_title(f"{state.reversal // 2} cycles")
        return [pressure, depth]

    FuncAnimation(figure, show, len(ends)).save(path, PillowWriter(fps=6), dpi=70)


def main() -> None:
    partial = worn(mfv.Step(force_ratio=0.5), mfv.Step(force_ratio=-0.5, cycles=1000000), coefficient=0.1)
    gross = worn(mfv.Step(shift=2.0e-3), mfv.Step(shift=-2.0e-3, cycles=20000), coefficient=1.0e-3)
    for name, result in (("partial slip", partial), ("gross slip", gross)):
        print(f"{name}: {len(result.cycles.block)} cycles computed of {int(result.cycles.block.sum())}")
        print(f"  dissipation of the last over the first: {result.cycles.dissipation[-1] / result.cycles.dissipation[0]:.2g}")
    draw(partial, gross, sys.argv[1] if len(sys.argv) > 1 else "wear.png")
    if len(sys.argv) > 2:
        animate(gross, sys.argv[2])


if __name__ == "__main__":
    main()
