"""Figures 3.1 to 3.20 of the dissertation from the namelists beside this file, against closed forms where there are any.

    python examples/dissertation/draw.py [--only 3.12 ...] [--output FOLDER]

Prints a line of numbers for every figure. A namelist runs as it is with mfv_run; where a figure compares algorithms, meshes or a
range of coefficients, it is the base case, and keys of its text are varied here.
"""
from __future__ import annotations

import argparse
import re
from collections.abc import Callable, Iterable
from functools import partial
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import mfv
import spence_coupled
from mfv import NodeStatus
from mfv.plot import CLOSED_FORM, MARKS, NUMBERS, STYLE

HERE = Path(__file__).resolve().parent
OTHER = "#009E73"
RADIUS, SHEAR_MODULUS, KAPPA = 0.25, 1.0, 1.8
BETA = (KAPPA - 1.0) / (KAPPA + 1.0)
SLIPS = (NodeStatus.SLIP_LEFT, NodeStatus.SLIP_RIGHT)
OFF_BY = 0.1  # of the largest shear traction: what figure 3.19 marks as a bad solution
Drawn = tuple[Figure, str]


def text_of(name: str) -> str:
    """Text of the namelist of a figure, named as 3.1."""
    return (HERE / f"figure_3_{int(name.split('.')[1]):02d}.nml").read_text()


def varied(text: str, group: str, **keys: object) -> str:
    """A namelist with keys of its first group of that name changed or added; texts bring their quotes."""
    found = re.search(rf"&{group}\b[^/]*", text)
    if found is None:
        raise ValueError(f"there is no &{group}")
    body = found.group().rstrip()
    for key, value in keys.items():
        body, count = re.subn(rf"\b{key}\s*=\s*[^,\s]+", f"{key}={value}", body)
        if count == 0:
            body += f", {key}={value}"
    return f"{text[:found.start()]}{body} {text[found.end():]}"


def conventional(text: str, load_step: float) -> mfv.Result:
    """The result of the conventional algorithm."""
    return mfv.run(text=varied(text, "solver", algorithm="'conventional'", load_step=load_step))


def contact_scale(force: float) -> tuple[float, float]:
    """Hertz's half-width and largest pressure."""
    half_width = float(mfv.reference.hertz_half_width(force, RADIUS, SHEAR_MODULUS, KAPPA))
    return half_width, 2.0 * force / (np.pi * half_width)


def panels(number: int, title: str, **size: float) -> tuple[Figure, list[Axes]]:
    """A picture of 1200 x 900 with panels side by side, or one above the other when there are two."""
    picture = Figure(figsize=(8.0, 6.0), dpi=150, layout="constrained")
    picture.suptitle(title, fontsize=12)
    return picture, list(np.atleast_1d(picture.subplots(number, 1, **size)))


def difference(values: np.ndarray, others: np.ndarray) -> float:
    """Largest difference over the largest of the others."""
    return float(np.nanmax(np.abs(values - others)) / np.nanmax(np.abs(others)))


def inner(result: mfv.Result, half_width: float, part: float = 0.9) -> np.ndarray:
    """Nodes within a part of the contact."""
    return np.abs(result.mesh.x) < part * half_width


def draw_nodes(ax: Axes, result: mfv.Result, values: np.ndarray, scale: tuple[float, float], label: str, state=None,
               **style: object) -> None:
    """Values of the touching nodes over Hertz's half-width, filled where stuck or without friction, open where slipping."""
    state = state or result.state
    touching, slips = state.status != NodeStatus.OPEN, np.isin(state.status, SLIPS)
    style = dict(color=NUMBERS, marker="o", markersize=4.0, linewidth=0.8) | style
    x, y = result.mesh.x[touching] / scale[0], values[touching] / scale[1]
    ax.plot(x, y, label=label, **style)
    x, y = result.mesh.x[slips] / scale[0], values[slips] / scale[1]
    style |= dict(linestyle="none", markerfacecolor="white")
    ax.plot(x, y, label=f"{label}, slipping" if slips.any() else None, **style)


def draw_curve(ax: Axes, function: Callable[[np.ndarray], np.ndarray], scale: tuple[float, float], label: str, reach: float = 1.0) -> None:
    """A closed form over |x| < reach a."""
    x = reach * scale[0] * np.sin(np.linspace(-0.5 * np.pi, 0.5 * np.pi, 801))
    ax.plot(x / scale[0], function(x) / scale[1], color=CLOSED_FORM, linewidth=1.2, label=label, zorder=1)


def draw_limit(ax: Axes, result: mfv.Result, scale: tuple[float, float], state=None) -> None:
    """Friction limits of the touching nodes, static and, where it is another, kinetic."""
    state = state or result.state
    touching = state.status != NodeStatus.OPEN
    coefficients = {r"$\pm\mu_s p$": (result.mesh.static_friction, "-"), r"$\pm\mu_k p$": (result.mesh.kinetic_friction, ":")}
    if np.array_equal(result.mesh.static_friction, result.mesh.kinetic_friction):
        coefficients = {r"$\pm\mu p$": (result.mesh.static_friction, "-")}
    for label, (coefficient, dashes) in coefficients.items():
        limit = (coefficient * state.pressure)[touching] / scale[1]
        for sign in (1.0, -1.0):
            ax.plot(result.mesh.x[touching] / scale[0], sign * limit, color="0.6", linewidth=0.7, linestyle=dashes, zorder=0,
                    label=label if sign > 0 else None)


def finish(ax: Axes, symbol: str, scale: str = "p_0", **legend: object) -> None:
    """Labels of a panel of tractions and its legend."""
    ax.set(xlabel="position $x/a$", ylabel=f"{'pressure' if symbol == 'p' else 'shear traction'} ${symbol}/{scale}$")
    ax.legend(**(dict(fontsize=9) | legend))


# Pressing: 3.1 to 3.4


def figure_3_01(name: str) -> Drawn:
    """Pressure under the cylinder against Hertz."""
    result = mfv.run(text=text_of(name))
    force = result.summary.normal_force
    scale = contact_scale(force)
    picture, (ax,) = panels(1, "3.1  Rigid cylinder pressed without friction")
    draw_curve(ax, lambda x: mfv.reference.hertz_pressure(x, force, scale[0]), scale, "Hertz, eq. 3.2")
    draw_nodes(ax, result, result.state.pressure, scale, "MFV", linestyle="none", markersize=6)
    finish(ax, "p")
    off = difference(result.state.pressure, mfv.reference.hertz_pressure(result.mesh.x, force, scale[0]))
    width = result.summary.contact_half_width / scale[0] - 1
    return picture, (f"{result.summary.contact_nodes} nodes in contact; half-width {width:+.1e} off eq. 3.1; "
                     f"pressure at most {off:.1e} p0 off Hertz")


def figure_3_02(name: str) -> Drawn:
    """Pressure under the flat punch."""
    result, half_width = mfv.run(text=text_of(name)), 0.4
    force = result.summary.normal_force
    scale = half_width, force / (2.0 * half_width)
    exact = partial(mfv.reference.flat_punch_pressure, normal_force=force, half_width=half_width)
    picture, (ax,) = panels(1, "3.2  Rigid flat punch pressed without friction")
    draw_curve(ax, exact, scale, "closed form, eq. 3.3", reach=0.997)
    draw_nodes(ax, result, result.state.pressure, scale, "MFV", linestyle="none")
    finish(ax, "p", r"\bar p")
    inside, x = inner(result, half_width), result.mesh.x
    off = difference(result.state.pressure[inside], exact(x[inside]))
    end = result.state.pressure[0] / exact(x[0]) - 1
    return picture, f"{result.summary.contact_nodes} nodes in contact; pressure at most {off:.1e} off eq. 3.3 inside 0.9 a, {end:+.1e} at the last node"


def figure_3_03(name: str, title: str = "3.3  Rigid cylinder pressed with friction, Goodman") -> Drawn:
    """Pressure and shear under the cylinder (3.3) or the flat punch (3.4) pressed with friction."""
    result = mfv.run(text=text_of(name))
    force, mu = result.summary.normal_force, result.scene.friction_coefficient
    if name == "3.3":
        scale = contact_scale(force)
        pressure, shear = mfv.reference.hertz_pressure, mfv.reference.spence_cylinder_shear
    else:
        scale = 0.4, force / 0.8
        pressure, shear = mfv.reference.flat_punch_pressure, mfv.reference.spence_flat_punch_shear
    reach = 1.0 if name == "3.3" else 0.995
    picture, (above, below) = panels(2, f"{title}, $\\mu$ = {mu:g}", sharex=True)
    draw_curve(above, lambda x: pressure(x, force, scale[0]), scale, "Hertz" if name == "3.3" else "eq. 3.3", reach)
    draw_nodes(above, result, result.state.pressure, scale, "MFV", linestyle="none", markersize=3)
    draw_curve(below, lambda x: shear(x, force, scale[0], mu, BETA), scale, "Spence", reach)
    draw_limit(below, result, scale)
    draw_nodes(below, result, result.state.shear, scale, "MFV", linestyle="none", markersize=3)
    for ax, symbol in ((above, "p"), (below, r"\tau")):
        finish(ax, symbol, "p_0" if name == "3.3" else r"\bar p", loc="upper left" if symbol != "p" else "best")
    inside = inner(result, scale[0])
    off = difference(result.state.shear[inside], shear(result.mesh.x[inside], force, scale[0], mu, BETA))
    exact = mfv.reference.spence_stick_ratio(mu, BETA)
    return picture, (f"{result.summary.contact_nodes} nodes; stick ratio {result.summary.stick_ratio:.4f}, Spence {exact:.4f}; "
                     f"shear inside 0.9 a at most {off:.1e} of its largest off Spence")


# Stick ratios: 3.5 to 3.8, 3.10


def stick_ratios(text: str, coefficients: Iterable[float], coupling: str) -> np.ndarray:
    """Stick ratios over the coefficient of friction."""
    base = varied(text, "scene", coupling=f"'{coupling}'")
    return np.array([mfv.run(text=varied(base, "friction", mu=mu)).summary.stick_ratio for mu in coefficients])


def figure_3_05(name: str, body: str = "cylinder") -> Drawn:
    """Stick ratio over beta/mu, with and without decoupling."""
    over = np.linspace(0.15, 2.4, 16)
    ratios = {coupling: stick_ratios(text_of(name), BETA / over, coupling) for coupling in ("goodman", "full")}
    exact = np.array([mfv.reference.spence_stick_ratio(BETA / value, BETA) for value in over])
    independent = np.array([spence_coupled.stick_ratio(BETA / value, BETA) for value in over])
    picture, (ax,) = panels(1, f"{name}  Stick ratio of the {body} pressed with friction, with and without decoupling")
    fine = np.linspace(over[0], over[-1], 200)
    ax.plot(fine, [mfv.reference.spence_stick_ratio(BETA / value, BETA) for value in fine], color=CLOSED_FORM, label="Spence, Goodman, eq. 3.4")
    ax.plot(over, independent, "--", color=MARKS, linewidth=1, label="full coupling, integral equations (spence_coupled.py)")
    ax.plot(over, ratios["goodman"], "o", color=NUMBERS, label="MFV, Goodman")
    ax.plot(over, ratios["full"], "s", color=OTHER, label="MFV, full coupling")
    ax.set(xlabel=r"$\beta/\mu$", ylabel="stick ratio $b/a$", ylim=(0, 1.05))
    ax.legend(fontsize=10)
    return picture, (f"{len(over)} coefficients; Goodman at most {np.abs(ratios['goodman'] - exact).max():.4f} off eq. 3.4, full coupling at "
                     f"most {np.abs(ratios['full'] - independent).max():.4f} off the integral equations; full lies below Goodman by "
                     f"up to {np.max(exact - independent):.3f} (exact)")


def figure_3_07(name: str, body: str = "cylinder") -> Drawn:
    """Stick ratio over mu with full coupling."""
    coefficients = np.linspace(0.1, 1.0, 19)
    ratios = stick_ratios(text_of(name), coefficients, "full")
    exact = np.array([spence_coupled.stick_ratio(mu, BETA) for mu in coefficients])
    picture, (ax,) = panels(1, f"{name}  Stick ratio of the {body} pressed with friction, full coupling")
    ax.plot(coefficients, exact, color=CLOSED_FORM, label="integral equations (spence_coupled.py)")
    ax.plot(coefficients, ratios, "o", color=NUMBERS, label="MFV")
    ax.set(xlabel=r"coefficient of friction $\mu$", ylabel="stick ratio $b/a$", ylim=(0, 1.05))
    ax.legend(fontsize=10)
    off = ratios - exact
    return picture, (f"{len(coefficients)} coefficients; MFV {off.min():+.4f} to {off.max():+.4f} off the integral equations, "
                     f"on average {off.mean():+.4f}")


def figure_3_10(name: str) -> Drawn:
    """Stick ratio over Q in the Mindlin problem."""
    result = mfv.run(text=text_of(name))
    limit = 0.7 * result.summary.normal_force
    force = np.array([state.tangential_force for state in result.steps[1:]])
    ratio = np.array([state.stick_ratio for state in result.steps[1:]])
    nodes = result.summary.contact_nodes
    picture, (ax,) = panels(1, "3.10  Stick ratio in the Mindlin problem")
    fine = np.linspace(0.0, 1.0, 400)
    ax.plot(fine, np.sqrt(1.0 - fine), color=CLOSED_FORM, label=r"Mindlin, $\sqrt{1-Q/(\mu P)}$")
    ax.plot(force / limit, ratio, "o", color=NUMBERS, label=f"MFV, {nodes} nodes in contact")
    ax.set(xlabel=r"tangential force $Q/(\mu P)$", ylabel="stick ratio $b/a$", ylim=(0, 1.05))
    ax.legend(fontsize=10)
    off = np.abs(ratio - np.sqrt(1.0 - force / limit)).max()
    return picture, f"{nodes} nodes; {len(force)} forces; at most {off:.4f} = {0.5 * off * nodes:.2f} nodes per side off Mindlin"


# Tractions of two algorithms: 3.9, 3.11 to 3.17


def figure_3_09(name: str) -> Drawn:
    """Two equal cylinders and the rigid cylinder on the half-plane that they map onto."""
    two, one = mfv.run(text=text_of(name)), mfv.run(text=text_of("3.11"))
    scale = contact_scale(one.summary.normal_force)
    picture, axes = panels(2, "3.9  Two equal cylinders ($R=0.5$, $G=2$) and a rigid one ($R=0.25$) on a half-plane ($G=1$)", sharex=True)
    for ax, symbol, quantity in zip(axes, ("p", r"\tau"), ("pressure", "shear")):
        draw_nodes(ax, one, one.state[quantity], scale, "rigid cylinder on a half-plane", linestyle="none", markersize=6, marker="s", color=CLOSED_FORM)
        draw_nodes(ax, two, two.state[quantity], scale, "two equal cylinders", linestyle="none", markersize=3)
        finish(ax, symbol, fontsize=8)
    off = [difference(two.state[quantity], one.state[quantity]) for quantity in ("pressure", "shear")]
    return picture, (f"{two.summary.contact_nodes} and {one.summary.contact_nodes} nodes in contact; largest difference of the pressure {off[0]:.1e}, "
                     f"of the shear {off[1]:.1e} of the largest (disks are not half-planes: (a/R)^2 = {(scale[0] / 0.5) ** 2:.0e})")


def ending(result: mfv.Result) -> str:
    """Outcome of a run, with the loads where it ended early."""
    if result.outcome == "complete":
        return "complete"
    loads = result.summary
    return f"{result.outcome} at P = {loads.normal_force:.3g}, Q = {loads.tangential_force:.3g}"


def shown(ax: Axes, pairs: list[tuple[str, mfv.Result, dict]], quantity: str, scale: tuple[float, float]) -> None:
    """A quantity of several results in one panel."""
    for label, result, style in pairs:
        draw_nodes(ax, result, result.state[quantity], scale, label, **style)


MFV = dict(color=NUMBERS, markersize=4)
CONVENTIONAL = dict(color=MARKS, marker="s", markersize=3, linewidth=0.6)


def figure_3_11(name: str) -> Drawn:
    """The Mindlin problem: both algorithms and the closed form."""
    result, other = mfv.run(text=text_of(name)), conventional(text_of(name), 0.05)
    force, q = result.summary.normal_force, result.summary.tangential_force
    scale = contact_scale(force)
    picture, (above, below) = panels(2, r"3.11  The Mindlin problem, $\mu$ = 0.7, Q = 0.4 $\mu$P", sharex=True)
    draw_curve(above, lambda x: mfv.reference.hertz_pressure(x, force, scale[0]), scale, "Hertz")
    draw_curve(below, lambda x: mfv.reference.mindlin_shear(x, q, force, scale[0], 0.7), scale, "Mindlin, eq. 3.8")
    pairs = [("MFV", result, MFV | dict(linestyle="none", markersize=5)),
             (f"conventional ({ending(other)})", other, CONVENTIONAL | dict(linestyle="none", markersize=2))]
    for ax, symbol, quantity in ((above, "p", "pressure"), (below, r"\tau", "shear")):
        shown(ax, pairs, quantity, scale)
        finish(ax, symbol, fontsize=8, loc="lower center")
    exact = mfv.reference.mindlin_shear(result.mesh.x, q, force, scale[0], 0.7)
    return picture, (f"{result.summary.contact_nodes} nodes, stick ratio {result.summary.stick_ratio:.4f}, Mindlin {np.sqrt(0.6):.4f}; shear at most "
                     f"{difference(result.state.shear, exact):.1e} of its largest off Mindlin; conventional {ending(other)}, shear "
                     f"{difference(other.state.shear, result.state.shear):.1e} off MFV's; solves {result.summary.linear_solves} and {other.summary.linear_solves}")


def symmetric(values: np.ndarray) -> float:
    """How far values are from symmetric about the middle, over the largest."""
    return difference(values[::-1], values)


def jumps(values: np.ndarray) -> int:
    """How often neighbouring increments change their sign: 3 or 4 for a smooth traction with two peaks, many for a ragged one."""
    increments = np.diff(values[np.abs(values) > 0.0])
    return int(np.sum(increments[1:] * increments[:-1] < 0.0))


def figure_3_12(name: str) -> Drawn:
    """Static and kinetic friction in the Mindlin problem, the conventional algorithm with several load steps."""
    text, steps = text_of(name), (0.2, 0.05, 0.02, 0.01, 0.005, 0.002)
    result, others = mfv.run(text=text), {step: conventional(text, step) for step in steps}
    scale = contact_scale(result.summary.normal_force)
    picture, (above, below) = panels(2, r"3.12  Static and kinetic friction (0.7, 0.42) in the Mindlin problem", sharex=True)
    pairs = [("MFV", result, MFV)]
    pairs += [(f"conventional, load step {step:g} ({ending(others[step])})", others[step], CONVENTIONAL | dict(color=colour))
              for step, colour in ((0.02, CLOSED_FORM), (0.002, MARKS))]
    for ax, quantity in ((above, "pressure"), (below, "shear")):
        shown(ax, pairs, quantity, scale)
    draw_limit(below, result, scale)
    below.set_ylim(0.0, None)
    finish(above, "p", fontsize=8, loc="lower center")
    finish(below, r"\tau", fontsize=8, loc="lower center", ncols=2)
    found = "; ".join(f"{step:g}: {difference(other.state.shear, result.state.shear):.1g}, {other.summary.stick_nodes} stuck, {jumps(other.state.shear)} turns"
                      for step, other in others.items())
    return picture, (f"{result.summary.contact_nodes} nodes, MFV {result.summary.stick_nodes} stuck, {jumps(result.state.shear)} turns, symmetric to "
                     f"{symmetric(result.state.shear):.1e}; conventional by load step, off MFV by part of the largest shear: {found}")


def farthest(text: str, steps: Iterable[float]) -> tuple[float, mfv.Result, str]:
    """Of runs of the conventional algorithm the one with the largest loads, with its load step, and a line about all."""
    runs = {step: conventional(text, step) for step in steps}
    reached = max(runs, key=lambda step: (runs[step].summary.normal_force, runs[step].summary.tangential_force))
    return reached, runs[reached], "; ".join(f"{step:g}: {ending(run)}" for step, run in runs.items())


def figure_3_13(name: str) -> Drawn:
    """Strong friction and full coupling: both algorithms."""
    text = text_of(name)
    result = mfv.run(text=text)
    step, other, line = farthest(text, (0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 0.005))
    scale = contact_scale(result.summary.normal_force)
    picture, (above, below) = panels(2, r"3.13  Strong friction ($\mu$ = 3) and full coupling, pressed, then sheared", sharex=True)
    pairs = [("MFV", result, MFV), (f"conventional, load step {step:g}\n({ending(other)})", other, CONVENTIONAL)]
    for ax, symbol, quantity in ((above, "p", "pressure"), (below, r"\tau", "shear")):
        shown(ax, pairs, quantity, scale)
        finish(ax, symbol, fontsize=8)
    return picture, (f"MFV {result.summary.contact_nodes} nodes, {result.summary.stick_nodes} stuck, certificate {result.certificate.largest:.0e}; "
                     f"conventional by load step: {line}")


def figure_3_14(name: str) -> Drawn:
    """Strong friction and full coupling: two meshes."""
    fine, coarse = mfv.run(text=text_of("3.13")), mfv.run(text=text_of(name))
    scale = contact_scale(fine.summary.normal_force)
    picture, (above, below) = panels(2, r"3.14  Strong friction ($\mu$ = 3) and full coupling: two meshes", sharex=True)
    pairs = [(f"MFV, {run.summary.contact_nodes} nodes", run, style) for run, style in
             ((fine, MFV | dict(markersize=3)), (coarse, dict(color=CLOSED_FORM, marker="D", markersize=4, linestyle="--")))]
    for ax, symbol, quantity in ((above, "p", "pressure"), (below, r"\tau", "shear")):
        shown(ax, pairs, quantity, scale)
        finish(ax, symbol, fontsize=8)
    inside = inner(coarse, scale[0])
    off = [difference(np.interp(coarse.mesh.x[inside], fine.mesh.x, fine.state[quantity]), coarse.state[quantity][inside])
           for quantity in ("pressure", "shear")]
    return picture, (f"{fine.summary.contact_nodes} and {coarse.summary.contact_nodes} nodes; inside 0.9 a pressures differ by {off[0]:.1e}, "
                     f"shears by {off[1]:.1e} of the largest")


def figure_3_15(name: str) -> Drawn:
    """Dahl's friction under the pressed cylinder: tractions and displacements."""
    result = mfv.run(text=text_of(name))
    coulomb = mfv.run(text=varied(varied(text_of("3.3"), "scene", coupling="'full'"), "friction", mu=0.3))
    step, other, line = farthest(text_of(name), (0.5, 0.2, 0.1, 0.05, 0.02, 0.01))
    scale = contact_scale(result.summary.normal_force)
    picture, (above, below) = panels(2, r"3.15  Cylinder pressed with Dahl's friction, $\sigma$ = 1000, $\gamma$ = 1, $\mu$ = 0.3", sharex=True)
    draw_nodes(above, result, result.state.pressure, scale, "MFV, pressure $p$", markersize=3)
    draw_nodes(above, result, result.state.shear, scale, r"MFV, shear traction $\tau$", markersize=3, color=OTHER)
    above.plot(coulomb.mesh.x / scale[0], coulomb.state.shear / scale[1], color=CLOSED_FORM, linewidth=0.9, label=r"$\tau$ with Coulomb's friction")
    draw_limit(above, result, scale)
    above.set(ylabel="traction$/p_0$", xlim=(-1.1, 1.1))
    above.legend(fontsize=8, ncols=2, loc="upper right")
    for quantity, symbol, colour in (("normal_displacement", "w", NUMBERS), ("tangential_displacement", "u", OTHER)):
        values = result.state[quantity]
        middle = values[np.argmin(np.abs(result.mesh.x))] if symbol == "w" else 0.0
        label = "$w - w(0)$, into the body" if symbol == "w" else "10 $u$, to the right"
        below.plot(result.mesh.x / scale[0], (values - middle) * (1 if symbol == "w" else 10) / scale[0], "o", markersize=3, color=colour, label=label)
    below.set(xlabel="position $x/a$", ylabel="displacement$/a$")
    below.legend(fontsize=9)
    touching = result.state.status != NodeStatus.OPEN
    mobilised = np.abs(result.state.shear[touching]) / (0.3 * result.state.pressure[touching])
    return picture, (f"{result.summary.contact_nodes} nodes; shear antisymmetric to {difference(-result.state.shear[::-1], result.state.shear):.0e}; "
                     f"{np.sum(mobilised > 0.95)} nodes above 0.95 mu p, largest {mobilised.max():.3f}; Coulomb {coulomb.summary.slip_nodes} slipping; "
                     f"certificate {result.certificate.largest:.0e}; conventional by load step: {line}")


def figure_3_16(name: str, title: str = "3.16  Static and kinetic friction (0.7, 0.49), Goodman: pressed") -> Drawn:
    """Static and kinetic friction, pressed (3.16) and sheared (3.17), both algorithms."""
    text, steps = text_of(name), (0.2, 0.05, 0.02, 0.01, 0.005)
    result, others = mfv.run(text=text), {step: conventional(text, step) for step in steps}
    scale = contact_scale(result.summary.normal_force)
    picture, (above, below) = panels(2, title, sharex=True)
    pairs = [("MFV", result, MFV)]
    pairs += [(f"conventional, load step {step:g} ({ending(others[step])})", others[step], CONVENTIONAL | dict(color=colour))
              for step, colour in ((0.05, CLOSED_FORM), (0.005, MARKS))]
    draw_curve(above, lambda x: mfv.reference.hertz_pressure(x, result.summary.normal_force, scale[0]), scale, "Hertz")
    shown(above, pairs, "pressure", scale)
    draw_limit(below, result, scale)
    shown(below, pairs, "shear", scale)
    finish(above, "p", fontsize=8, loc="lower center")
    finish(below, r"\tau", fontsize=7, loc="upper left")
    found = "; ".join(f"{step:g}: {difference(other.state.shear, result.state.shear):.2f}, {other.summary.slip_nodes} slipping, {jumps(other.state.shear)} turns"
                      for step, other in others.items())
    return picture, (f"{result.summary.contact_nodes} nodes, MFV {result.summary.slip_nodes} slipping, {jumps(result.state.shear)} turns; conventional by load step, off MFV by "
                     f"part of the largest shear: {found}")


# A cycle: 3.18

#: Of every sub-figure the step whose end it shows.
SUB_FIGURES = (1, 2, 3, 4, 5, 6, 7, 8, 8, 9, 10, 11, 12, 13, 14, 15, 15, 16, 17, 18)


def figure_3_18(name: str) -> Drawn:
    """Shear through a cycle: twenty states."""
    result = mfv.run(text=text_of(name))
    q_max, a = 1.85e-4, contact_scale(result.summary.normal_force)[0]
    states = [result.steps[step - 1] for step in SUB_FIGURES]
    picture = Figure(figsize=(8.0, 6.0), dpi=150, layout="constrained")
    picture.suptitle(r"3.18  Shear traction $100\,\tau/G$ over $x/a$ in a cycle; slipping nodes red", fontsize=12)
    axes = picture.subplots(4, 5, sharex=True, sharey=True)
    for number, (ax, state) in enumerate(zip(axes.flat, states), start=1):
        touching, slips = state.status != NodeStatus.OPEN, np.isin(state.status, SLIPS)
        x, shear = result.mesh.x / a, 100.0 * state.shear
        for sign in (1.0, -1.0):
            ax.plot(x[touching], sign * 70.0 * state.pressure[touching], color="0.75", linewidth=0.6)
        ax.plot(x[touching], shear[touching], color=NUMBERS, marker="o", markersize=1.5, linewidth=0.7)
        ax.plot(x[slips], shear[slips], "o", color="red", markersize=2.2)
        rising = "" if number == 1 else r"$\leftarrow$" if 5 <= number <= 12 else r"$\rightarrow$"
        ax.set_title(f"({number})  {round(state.tangential_force / q_max, 3) + 0.0:g} $Q_{{max}}$ {rising}", fontsize=8)
        ax.tick_params(labelsize=8)
    steady = [difference(result.steps[-2].shear, states[11].shear), difference(result.steps[-1].shear, states[19].shear)]
    mirrored = np.abs(states[11].shear + states[19].shear[::-1]) / np.abs(states[11].shear).max()
    mean = mirrored.sum() / np.sum(np.abs(states[11].shear) / np.abs(states[11].shear).max())
    peaks = result.mesh.x[np.argmin(states[11].shear)] / a, result.mesh.x[np.argmax(states[19].shear)] / a
    return picture, (f"{result.summary.contact_nodes} nodes; max|tau_12(x) + tau_20(-x)|/max|tau| = {mirrored.max():.3f}, on average {mean:.3f}; peaks "
                     f"of (12) and (20) at x/a = {peaks[0]:+.3f}, {peaks[1]:+.3f}; a further cycle repeats (12) to {steady[0]:.0e} and (20) to {steady[1]:.0e}")


# Linear solves: 3.19 and 3.20

MESHES, LOAD_STEPS = (25, 50, 75, 100), (1.0, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 0.005)


def swept(text: str) -> dict[int, list[mfv.Result]]:
    """Results by nodes of the mesh, for every load step."""
    return {nodes: [mfv.run(text=varied(varied(text, "mesh", nodes=nodes), "solver", load_step=step)) for step in LOAD_STEPS] for nodes in MESHES}


def by_events(text: str) -> dict[int, mfv.Result]:
    """Results of event stepping by nodes of the mesh."""
    text = varied(text, "solver", algorithm="'mfv'", stepping="'event'")
    return {nodes: mfv.run(text=varied(text, "mesh", nodes=nodes)) for nodes in MESHES}


def solves(runs: Iterable[mfv.Result]) -> list[int]:
    """Linear solves of results."""
    return [int(run.summary.linear_solves) for run in runs]


def figure_3_19(name: str) -> Drawn:
    """Linear solves of the conventional algorithm over the load step."""
    picture, axes = panels(2, "3.19  Linear solves of the conventional algorithm, P = 0.004, $\\mu$ = 0.3", sharex=True)
    lines = []
    for ax, coupling in zip(axes, ("goodman", "full")):
        text = varied(text_of(name), "scene", coupling=f"'{coupling}'")
        runs, exact = swept(text), by_events(text)
        early = optimal = 0
        for nodes, marker in zip(MESHES, "osD^"):
            counts, shear = np.array(solves(runs[nodes])), exact[nodes].state.shear
            ends = np.array([run.outcome != "complete" for run in runs[nodes]])
            bad = ends | np.array([difference(run.state.shear, shear) > OFF_BY for run in runs[nodes]])
            steps, early = np.array(LOAD_STEPS), early + int(ends.sum())
            ax.loglog(steps, counts, linewidth=0.8, color="0.5", zorder=1)
            ax.loglog(steps[~bad], counts[~bad], marker, color=NUMBERS, label=f"{exact[nodes].summary.contact_nodes} nodes in contact")
            ax.loglog(steps[bad & ~ends], counts[bad & ~ends], marker, color="red")
            ax.loglog(steps[ends], counts[ends], marker, color="red", markerfacecolor="white")
            optimal = max(optimal, steps[~bad].max(initial=0.0))
        ax.plot([], [], "s", color="red", label=f"more than {OFF_BY:.0%} off MFV")
        ax.plot([], [], "s", color="red", markerfacecolor="white", label="ended early: cycling")
        ax.set(ylabel="linear solves", title={"goodman": "Goodman", "full": "full coupling"}[coupling])
        lines.append(f"{coupling}: {early} of {len(MESHES) * len(LOAD_STEPS)} runs ended early, largest good load step {optimal:g}, "
                     f"solves at 0.05 {[solves(runs[nodes])[LOAD_STEPS.index(0.05)] for nodes in MESHES]}")
    axes[1].set_xlabel("load step, part of the load")
    axes[0].legend(fontsize=8, loc="upper right")
    return picture, "; ".join(lines)


def figure_3_20(name: str) -> Drawn:
    """Linear solves of MFV with nominal steps over the load step."""
    text = text_of(name)
    runs, exact = swept(text), by_events(text)
    picture, (ax,) = panels(1, "3.20  Linear solves of MFV with nominal load steps, P = 0.004, $\\mu$ = 0.3, Goodman")
    off, stars = 0.0, {}
    for nodes, marker in zip(MESHES, "osD^"):
        counts, shear = solves(runs[nodes]), exact[nodes].state.shear
        off = max(off, *(difference(run.state.shear, shear) for run in runs[nodes]))
        best = int(np.argmin(counts))
        stars[int(exact[nodes].summary.contact_nodes)] = f"{counts[best]} at {LOAD_STEPS[best]:g}"
        ax.loglog(LOAD_STEPS, counts, marker=marker, color=NUMBERS, linewidth=0.8, label=f"{exact[nodes].summary.contact_nodes} nodes in contact")
        ax.loglog(LOAD_STEPS[best], counts[best], "*", color=MARKS, markersize=14)
        ax.axhline(exact[nodes].summary.linear_solves, color=OTHER, linestyle="--", linewidth=0.8)
    ax.plot([], [], "*", color=MARKS, markersize=14, linestyle="none", label="fewest")
    ax.plot([], [], "--", color=OTHER, label="event stepping, same meshes")
    ax.set(xlabel="load step, part of the load", ylabel="linear solves")
    ax.legend(fontsize=9)
    return picture, (f"all points one solution: shear differs by at most {off:.0e} of its largest from event stepping; fewest solves by nodes in contact "
                     f"{stars}; event stepping {solves(exact.values())}")


FIGURES: dict[str, Callable[[str], Drawn]] = {
    "3.1": figure_3_01,
    "3.2": figure_3_02,
    "3.3": figure_3_03,
    "3.4": partial(figure_3_03, title="3.4  Rigid flat punch pressed with friction, Goodman"),
    "3.5": figure_3_05,
    "3.6": partial(figure_3_05, body="flat punch"),
    "3.7": figure_3_07,
    "3.8": partial(figure_3_07, body="flat punch"),
    "3.9": figure_3_09,
    "3.10": figure_3_10,
    "3.11": figure_3_11,
    "3.12": figure_3_12,
    "3.13": figure_3_13,
    "3.14": figure_3_14,
    "3.15": figure_3_15,
    "3.16": figure_3_16,
    "3.17": partial(figure_3_16, title="3.17  Static and kinetic friction (0.7, 0.49), Goodman: pressed, then sheared"),
    "3.18": figure_3_18,
    "3.19": figure_3_19,
    "3.20": figure_3_20,
}


def main() -> None:
    parser = argparse.ArgumentParser(description="draws figures 3.1 to 3.20 of the dissertation")
    parser.add_argument("--only", nargs="+", choices=FIGURES, default=list(FIGURES), metavar="3.N", help="figures to draw, all unless told")
    parser.add_argument("--output", type=Path, default=HERE / "pictures", help="folder for the pictures")
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    for name in options.only:
        with matplotlib.rc_context(STYLE):
            picture, line = FIGURES[name](name)
            picture.savefig(options.output / f"figure_3_{int(name.split('.')[1]):02d}.png")
        print(f"{name}: {line}", flush=True)


if __name__ == "__main__":
    main()
