"""Figures 3.1 to 3.20 of the dissertation from the namelists beside this file, against closed forms where there are any.

    python examples/dissertation/draw.py [--only 3.12 ...] [--output FOLDER]

Prints a line of numbers for every figure. A namelist runs as it is with mfv_run; where a figure compares algorithms, meshes or a
range of coefficients, it is the base case, and keys of its text are varied here.
"""

from __future__ import annotations

import argparse
import re
from collections.abc import Callable, Iterable
from functools import cache, partial
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
import spence_coupled
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

import mfv
from mfv import NodeStatus
from mfv.drawing import CLOSED_FORM, MARKS, NUMBERS, STYLE

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
        raise ValueError(f"no &{group} group")
    body = found.group().rstrip()
    for key, value in keys.items():
        body, count = re.subn(rf"\b{key}\s*=\s*[^,\s]+", f"{key}={value}", body)
        if count == 0:
            body += f", {key}={value}"
    return f"{text[: found.start()]}{body} {text[found.end() :]}"


def conventional(text: str, load_step: float) -> mfv.Result:
    """The result of the conventional algorithm."""
    return mfv.run(text=varied(text, "solver", algorithm="'conventional'", load_step=load_step))


def contact_scale(force: float) -> tuple[float, float]:
    """Hertz's half-width and largest pressure."""
    half_width = float(mfv.reference.hertz_half_width(force, RADIUS, SHEAR_MODULUS, KAPPA))
    return half_width, 2.0 * force / (np.pi * half_width)


def panels(number: int, title: str) -> tuple[Figure, list[Axes]]:
    """A picture of 1200 x 900 with panels side by side, or one above the other when there are two."""
    picture = Figure(figsize=(8.0, 6.0), dpi=150, layout="constrained")
    picture.suptitle(title, fontsize=12)
    return picture, list(np.atleast_1d(picture.subplots(number, 1, sharex=True)))


def difference(values: np.ndarray, others: np.ndarray) -> float:
    """Largest difference over the largest of the others."""
    return float(np.nanmax(np.abs(values - others)) / np.nanmax(np.abs(others)))


def inner(result: mfv.Result, half_width: float, part: float = 0.9) -> np.ndarray:
    """Nodes within a part of the contact."""
    return np.abs(result.mesh.x) < part * half_width


def draw_nodes(ax: Axes, result: mfv.Result, values: np.ndarray, scale: tuple[float, float], label: str, **style: Any) -> None:
    """Values of the touching nodes over Hertz's half-width, filled where stuck or without friction, open where slipping."""
    touching, slips = result.state.status != NodeStatus.OPEN, np.isin(result.state.status, SLIPS)
    defaults: dict[str, Any] = dict(color=NUMBERS, marker="o", markersize=4.0, linewidth=0.8)
    style = defaults | style
    x, y = result.mesh.x[touching] / scale[0], values[touching] / scale[1]
    ax.plot(x, y, label=label, **style)
    x, y = result.mesh.x[slips] / scale[0], values[slips] / scale[1]
    ax.plot(x, y, **style | dict(linestyle="none", markerfacecolor="white"))


def draw_curve(
    ax: Axes, function: Callable[[np.ndarray], np.ndarray], scale: tuple[float, float], label: str, reach: float = 1.0
) -> None:
    """A closed form over |x| < reach a."""
    x = reach * scale[0] * np.sin(np.linspace(-0.5 * np.pi, 0.5 * np.pi, 801))
    ax.plot(x / scale[0], function(x) / scale[1], color=CLOSED_FORM, linewidth=1.2, label=label, zorder=1)


def draw_limit(ax: Axes, result: mfv.Result, scale: tuple[float, float]) -> None:
    """Friction limits of the touching nodes, static and, if different, kinetic."""
    touching = result.state.status != NodeStatus.OPEN
    coefficients = {r"$\pm\mu_s p$": (result.mesh.static_friction, "-"), r"$\pm\mu_k p$": (result.mesh.kinetic_friction, ":")}
    if np.array_equal(result.mesh.static_friction, result.mesh.kinetic_friction):
        coefficients = {r"$\pm\mu p$": (result.mesh.static_friction, "-")}
    for label, (coefficient, dashes) in coefficients.items():
        limit = (coefficient * result.state.pressure)[touching] / scale[1]
        for sign in (1.0, -1.0):
            ax.plot(
                result.mesh.x[touching] / scale[0],
                sign * limit,
                color="0.6",
                linewidth=0.7,
                linestyle=dashes,
                zorder=0,
                label=label if sign > 0 else None,
            )


def finish(picture: Figure, scale: str = "p_0") -> None:
    """Labels of the panels of tractions, pressure above, and one legend below them."""
    for ax, name in zip(picture.axes, (f"pressure $p/{scale}$", rf"shear traction $\tau/{scale}$")):
        ax.set_ylabel(name)
    picture.axes[-1].set_xlabel("position $x/a$")
    handles = {label: handle for ax in picture.axes for handle, label in zip(*ax.get_legend_handles_labels())}
    if len(picture.axes) > 1:
        handles["open: slipping"] = Line2D([], [], linestyle="none", marker="o", markerfacecolor="white", color="0.4")
    picture.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=3 if len(handles) > 4 else 4, fontsize=9)


# Pressing: 3.1 to 3.4


def figure_3_01(name: str) -> Drawn:
    """Pressure under the cylinder against Hertz."""
    result = mfv.run(text=text_of(name))
    force = result.summary.normal_force
    scale = contact_scale(force)
    picture, (ax,) = panels(1, "3.1  Rigid cylinder pressed without friction")
    draw_curve(ax, lambda x: mfv.reference.hertz_pressure(x, force, scale[0]), scale, "Hertz, eq. 3.2")
    draw_nodes(ax, result, result.state.pressure, scale, "MFV", linestyle="none", markersize=6)
    finish(picture)
    inside, exact = inner(result, scale[0]), mfv.reference.hertz_pressure(result.mesh.x, force, scale[0])
    off, last = (np.abs(result.state.pressure - exact)[nodes].max() / scale[1] for nodes in (inside, ~inside))
    width = result.summary.contact_half_width / scale[0] - 1
    return picture, (
        f"{result.summary.contact_nodes} nodes in contact; half-width {width:+.1e} off eq. 3.1; "
        f"pressure at most {off:.1e} p0 off Hertz inside 0.9 a, {last:.1e} p0 at the ends"
    )


def figure_3_02(name: str) -> Drawn:
    """Pressure under the flat punch."""
    result, half_width = mfv.run(text=text_of(name)), 0.4
    force = result.summary.normal_force
    scale = half_width, force / (2.0 * half_width)
    exact = partial(mfv.reference.flat_punch_pressure, normal_force=force, half_width=half_width)
    picture, (ax,) = panels(1, "3.2  Rigid flat punch pressed without friction")
    draw_curve(ax, exact, scale, "closed form, eq. 3.3", reach=0.997)
    draw_nodes(ax, result, result.state.pressure, scale, "MFV", linestyle="none")
    finish(picture, r"\bar p")
    inside, x = inner(result, half_width), result.mesh.x
    off = difference(result.state.pressure[inside], exact(x[inside]))
    end = result.state.pressure[0] / exact(x[0]) - 1
    return (
        picture,
        f"{result.summary.contact_nodes} nodes in contact; pressure at most {off:.1e} off eq. 3.3 inside 0.9 a, "
        f"{end:+.1e} at the last node",
    )


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
    picture, (above, below) = panels(2, f"{title}, $\\mu$ = {mu:g}")
    draw_curve(above, lambda x: pressure(x, force, scale[0]), scale, "Hertz" if name == "3.3" else "eq. 3.3", reach)
    draw_nodes(above, result, result.state.pressure, scale, "MFV", linestyle="none", markersize=3)
    draw_curve(below, lambda x: shear(x, force, scale[0], mu, BETA), scale, "Spence", reach)
    draw_limit(below, result, scale)
    draw_nodes(below, result, result.state.shear, scale, "MFV", linestyle="none", markersize=3)
    finish(picture, "p_0" if name == "3.3" else r"\bar p")
    inside = inner(result, scale[0])
    off = difference(result.state.shear[inside], shear(result.mesh.x[inside], force, scale[0], mu, BETA))
    exact = mfv.reference.spence_stick_ratio(mu, BETA)
    return picture, (
        f"{result.summary.contact_nodes} nodes; stick ratio {result.summary.stick_ratio:.4f}, Spence {exact:.4f}; "
        f"shear inside 0.9 a at most {off:.1e} of its largest off Spence"
    )


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
    fine = np.linspace(over[0], over[-1], 61)
    ax.plot(
        fine,
        [mfv.reference.spence_stick_ratio(BETA / value, BETA) for value in fine],
        color=CLOSED_FORM,
        label="Spence, Goodman, eq. 3.4",
    )
    ax.plot(
        fine,
        [spence_coupled.stick_ratio(BETA / value, BETA) for value in fine],
        "--",
        color=MARKS,
        linewidth=1,
        label="full coupling, integral equations (spence_coupled.py)",
    )
    ax.plot(over, ratios["goodman"], "o", color=NUMBERS, label="MFV, Goodman")
    ax.plot(over, ratios["full"], "s", color=OTHER, label="MFV, full coupling")
    ax.set(xlabel=r"$\beta/\mu$", ylabel="stick ratio $b/a$", ylim=(0, 1.05))
    ax.legend(fontsize=10)
    return picture, (
        f"{len(over)} coefficients; Goodman at most {np.abs(ratios['goodman'] - exact).max():.4f} off eq. 3.4, full "
        f"coupling at "
        f"most {np.abs(ratios['full'] - independent).max():.4f} off the integral equations; full lies below Goodman by "
        f"up to {np.max(exact - independent):.3f} (exact)"
    )


def figure_3_07(name: str, body: str = "cylinder") -> Drawn:
    """Stick ratio over mu with full coupling."""
    coefficients = np.linspace(0.1, 1.0, 19)
    ratios = stick_ratios(text_of(name), coefficients, "full")
    exact = np.array([spence_coupled.stick_ratio(mu, BETA) for mu in coefficients])
    picture, (ax,) = panels(1, f"{name}  Stick ratio of the {body} pressed with friction, full coupling")
    fine = np.linspace(coefficients[0], coefficients[-1], 61)
    ax.plot(
        fine,
        [spence_coupled.stick_ratio(mu, BETA) for mu in fine],
        color=CLOSED_FORM,
        label="integral equations (spence_coupled.py)",
    )
    ax.plot(coefficients, ratios, "o", color=NUMBERS, label="MFV")
    ax.set(xlabel=r"coefficient of friction $\mu$", ylabel="stick ratio $b/a$", ylim=(0, 1.05))
    ax.legend(fontsize=10)
    off = ratios - exact
    return picture, (
        f"{len(coefficients)} coefficients; MFV {off.min():+.4f} to {off.max():+.4f} off the integral equations, "
        f"on average {off.mean():+.4f}"
    )


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
    sides = 0.5 * off * nodes
    return picture, f"{nodes} nodes; {len(force)} forces; at most {off:.4f} = {sides:.2f} nodes per side off Mindlin"


# Tractions of two algorithms: 3.9, 3.11 to 3.17


def figure_3_09(name: str) -> Drawn:
    """Two equal cylinders and the rigid cylinder on the half-plane that they map onto."""
    two, one = mfv.run(text=text_of(name)), mfv.run(text=text_of("3.11"))
    scale = contact_scale(one.summary.normal_force)
    picture, axes = panels(2, "3.9  Two equal cylinders ($R=0.5$, $G=2$) and a rigid one ($R=0.25$) on a half-plane ($G=1$)")
    for ax, quantity in zip(axes, ("pressure", "shear")):
        draw_nodes(
            ax,
            one,
            one.state[quantity],
            scale,
            "rigid cylinder on a half-plane",
            linestyle="none",
            markersize=6,
            marker="s",
            color=CLOSED_FORM,
        )
        draw_nodes(ax, two, two.state[quantity], scale, "two equal cylinders", linestyle="none", markersize=3)
    finish(picture)
    off = [difference(two.state[quantity], one.state[quantity]) for quantity in ("pressure", "shear")]
    return picture, (
        f"{two.summary.contact_nodes} and {one.summary.contact_nodes} nodes in contact; largest difference of the "
        f"pressure {off[0]:.1e}, "
        f"of the shear {off[1]:.1e} of the largest (disks are not half-planes: (a/R)^2 = {(scale[0] / 0.5) ** 2:.0e})"
    )


def ending(result: mfv.Result) -> str:
    """Outcome of a run, with the loads if it ended early."""
    if result.outcome == "complete":
        return "complete"
    loads = result.summary
    return f"{result.outcome} at P = {loads.normal_force:.3g}, Q = {loads.tangential_force:.3g}"


def shown(picture: Figure, pairs: list[tuple[str, mfv.Result, dict]], scale: tuple[float, float]) -> None:
    """Pressure of several results in the upper panel, shear in the lower one, and what `finish` adds."""
    for ax, quantity in zip(picture.axes, ("pressure", "shear")):
        for label, result, style in pairs:
            draw_nodes(ax, result, result.state[quantity], scale, label, **style)
    finish(picture)


MFV = dict(color=NUMBERS, markersize=4)
CONVENTIONAL = dict(color=MARKS, marker="s", markersize=3, linewidth=0.6)


def figure_3_11(name: str) -> Drawn:
    """The Mindlin problem: both algorithms and the closed form."""
    result, other = mfv.run(text=text_of(name)), conventional(text_of(name), 0.05)
    force, q = result.summary.normal_force, result.summary.tangential_force
    scale = contact_scale(force)
    picture, (above, below) = panels(2, r"3.11  The Mindlin problem, $\mu$ = 0.7, Q = 0.4 $\mu$P")
    draw_curve(above, lambda x: mfv.reference.hertz_pressure(x, force, scale[0]), scale, "Hertz")
    draw_curve(below, lambda x: mfv.reference.mindlin_shear(x, q, force, scale[0], 0.7), scale, "Mindlin, eq. 3.8")
    pairs = [
        ("MFV", result, MFV | dict(linestyle="none", markersize=5)),
        (f"conventional ({ending(other)})", other, CONVENTIONAL | dict(linestyle="none", markersize=2)),
    ]
    shown(picture, pairs, scale)
    exact = mfv.reference.mindlin_shear(result.mesh.x, q, force, scale[0], 0.7)
    return picture, (
        f"{result.summary.contact_nodes} nodes, stick ratio {result.summary.stick_ratio:.4f}, Mindlin {np.sqrt(0.6):.4f}; "
        f"shear at most "
        f"{difference(result.state.shear, exact):.1e} of its largest off Mindlin; conventional {ending(other)}, shear "
        f"{difference(other.state.shear, result.state.shear):.1e} off MFV's; solves {result.summary.linear_solves} and "
        f"{other.summary.linear_solves}"
    )


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
    picture, (_, below) = panels(2, r"3.12  Static and kinetic friction (0.7, 0.42) in the Mindlin problem")
    pairs = [("MFV", result, MFV)]
    pairs += [
        (f"conventional, load step {step:g} ({ending(others[step])})", others[step], CONVENTIONAL | dict(color=colour))
        for step, colour in ((0.02, CLOSED_FORM), (0.002, MARKS))
    ]
    draw_limit(below, result, scale)
    shown(picture, pairs, scale)
    below.set_ylim(0.0, None)
    found = "; ".join(
        f"{step:g}: {difference(other.state.shear, result.state.shear):.1g}, {other.summary.stick_nodes} stuck, "
        f"{jumps(other.state.shear)} turns"
        for step, other in others.items()
    )
    return picture, (
        f"{result.summary.contact_nodes} nodes, MFV {result.summary.stick_nodes} stuck, {jumps(result.state.shear)} "
        f"turns, symmetric to "
        f"{symmetric(result.state.shear):.1e}; conventional by load step, off MFV by part of the largest shear: {found}"
    )


def farthest(text: str, steps: Iterable[float]) -> tuple[float, mfv.Result, str]:
    """The run of the conventional algorithm that progressed farthest, at the smallest load step, and a summary of all."""
    runs = {step: conventional(text, step) for step in steps}
    reached = max(runs, key=lambda step: (runs[step].summary.normal_force, runs[step].summary.tangential_force, -step))
    return reached, runs[reached], "; ".join(f"{step:g}: {ending(run)}" for step, run in runs.items())


def figure_3_13(name: str) -> Drawn:
    """Strong friction and full coupling: both algorithms."""
    text = text_of(name)
    result = mfv.run(text=text)
    step, other, line = farthest(text, (0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 0.005))
    scale = contact_scale(result.summary.normal_force)
    picture, _ = panels(2, r"3.13  Strong friction ($\mu$ = 3) and full coupling, pressed, then sheared")
    pairs = [("MFV", result, MFV), (f"conventional, load step {step:g}\n({ending(other)})", other, CONVENTIONAL)]
    shown(picture, pairs, scale)
    return picture, (
        f"MFV {result.summary.contact_nodes} nodes, {result.summary.stick_nodes} stuck, certificate "
        f"{result.certificate.largest:.0e}; "
        f"conventional by load step: {line}"
    )


def figure_3_14(name: str) -> Drawn:
    """Strong friction and full coupling: two meshes."""
    fine, coarse = mfv.run(text=text_of("3.13")), mfv.run(text=text_of(name))
    scale = contact_scale(fine.summary.normal_force)
    picture, _ = panels(2, r"3.14  Strong friction ($\mu$ = 3) and full coupling: two meshes")
    pairs = [
        (f"MFV, {run.summary.contact_nodes} nodes", run, style)
        for run, style in (
            (fine, MFV | dict(markersize=3)),
            (coarse, dict(color=CLOSED_FORM, marker="D", markersize=4, linestyle="--")),
        )
    ]
    shown(picture, pairs, scale)
    inside = inner(coarse, scale[0], 0.75)
    off = [
        difference(np.interp(coarse.mesh.x[inside], fine.mesh.x, fine.state[quantity]), coarse.state[quantity][inside])
        for quantity in ("pressure", "shear")
    ]
    return picture, (
        f"{fine.summary.contact_nodes} and {coarse.summary.contact_nodes} nodes; inside 0.75 a pressures differ by "
        f"{off[0]:.1e}, "
        f"shears by {off[1]:.1e} of the largest"
    )


def figure_3_15(name: str) -> Drawn:
    """Dahl's friction under the pressed cylinder: tractions and displacements."""
    result = mfv.run(text=text_of(name))
    coulomb = mfv.run(text=varied(varied(text_of("3.3"), "scene", coupling="'full'"), "friction", mu=0.3))
    explicit = mfv.run(text=varied(text_of(name), "solver", integration="'explicit'", load_step=0.005))
    step, other, line = farthest(text_of(name), (0.5, 0.2, 0.1, 0.05, 0.02, 0.01))
    scale = contact_scale(result.summary.normal_force)
    picture, (above, below) = panels(2, r"3.15  Cylinder pressed with Dahl's friction, $\sigma$ = 1000, $\gamma$ = 1, $\mu$ = 0.3")
    draw_nodes(above, result, result.state.pressure, scale, "MFV, pressure $p$", markersize=3)
    draw_nodes(above, result, result.state.shear, scale, r"MFV, shear traction $\tau$", markersize=3, color=OTHER)
    above.plot(
        coulomb.mesh.x / scale[0],
        coulomb.state.shear / scale[1],
        color=CLOSED_FORM,
        linewidth=0.9,
        label=r"$\tau$ with Coulomb's friction",
    )
    draw_limit(above, result, scale)
    above.set(ylabel="traction$/p_0$", xlim=(-1.1, 1.1), ylim=(-0.35, 1.7))
    above.legend(fontsize=9, ncols=2, loc="upper center")
    for quantity, symbol, colour in (("normal_displacement", "w", NUMBERS), ("tangential_displacement", "u", OTHER)):
        values = result.state[quantity]
        middle = values[np.argmin(np.abs(result.mesh.x))] if symbol == "w" else 0.0
        label = "$w - w(0)$, into the body" if symbol == "w" else "10 $u$, to the right"
        below.plot(
            result.mesh.x / scale[0],
            (values - middle) * (1 if symbol == "w" else 10) / scale[0],
            "o",
            markersize=3,
            color=colour,
            label=label,
        )
    below.set(xlabel="position $x/a$", ylabel="displacement$/a$")
    below.legend(fontsize=9)
    touching = result.state.status != NodeStatus.OPEN
    mobilised = np.abs(result.state.shear[touching]) / (0.3 * result.state.pressure[touching])
    return picture, (
        f"{result.summary.contact_nodes} nodes; shear antisymmetric to "
        f"{difference(-result.state.shear[::-1], result.state.shear):.0e}; "
        f"{np.sum(mobilised > 0.95)} nodes above 0.95 mu p, largest {mobilised.max():.3f}; Coulomb "
        f"{coulomb.summary.slip_nodes} slipping; "
        f"certificate {result.certificate.largest:.0e}; explicit integration with load step 0.005 "
        f"{difference(explicit.state.shear, result.state.shear):.1e} off; "
        f"conventional by load step: {line}, with {step:g} {difference(other.state.shear, result.state.shear):.1e} off"
    )


def figure_3_16(name: str, title: str = "3.16  Static and kinetic friction (0.7, 0.49), Goodman: pressed") -> Drawn:
    """Static and kinetic friction, pressed (3.16) and sheared (3.17), both algorithms."""
    text, steps = text_of(name), (0.2, 0.05, 0.02, 0.01, 0.005)
    result, others = mfv.run(text=text), {step: conventional(text, step) for step in steps}
    scale = contact_scale(result.summary.normal_force)
    picture, (above, below) = panels(2, title)
    pairs = [("MFV", result, MFV)]
    pairs += [
        (f"conventional, load step {step:g} ({ending(others[step])})", others[step], CONVENTIONAL | dict(color=colour))
        for step, colour in ((0.05, CLOSED_FORM), (0.005, MARKS))
    ]
    draw_curve(above, lambda x: mfv.reference.hertz_pressure(x, result.summary.normal_force, scale[0]), scale, "Hertz")
    draw_limit(below, result, scale)
    shown(picture, pairs, scale)
    found = "; ".join(
        f"{step:g}: {difference(other.state.shear, result.state.shear):.2f}, {other.summary.slip_nodes} slipping, "
        f"{jumps(other.state.shear)} turns"
        for step, other in others.items()
    )
    return picture, (
        f"{result.summary.contact_nodes} nodes, MFV {result.summary.slip_nodes} slipping, {jumps(result.state.shear)} "
        f"turns; conventional by load step, off MFV by "
        f"part of the largest shear: {found}"
    )


# A cycle: 3.18

#: The step whose end each sub-figure shows.
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
    return picture, (
        f"{result.summary.contact_nodes} nodes; max|tau_12(x) + tau_20(-x)|/max|tau| = {mirrored.max():.3f}, on average "
        f"{mean:.3f}; peaks "
        f"of (12) and (20) at x/a = {peaks[0]:+.3f}, {peaks[1]:+.3f}; a further cycle repeats (12) to {steady[0]:.0e} and "
        f"(20) to {steady[1]:.0e}"
    )


# Linear solves: 3.19 and 3.20

MESHES, LOAD_STEPS = (25, 50, 75, 100), tuple(1.0 / parts for parts in (1, 2, 4, 8, 12, 16, 24, 32, 48, 64, 96, 128))


class Sweep:
    """Runs on one mesh with all load steps, and that with event stepping."""

    def __init__(self, text: str, nodes: int) -> None:
        text = varied(text, "mesh", nodes=nodes)
        runs = [mfv.run(text=varied(text, "solver", load_step=step)) for step in LOAD_STEPS]
        self.event = mfv.run(text=varied(text, "solver", algorithm="'mfv'", stepping="'event'"))
        self.label = f"{self.event.summary.contact_nodes} nodes in contact"
        self.steps = np.array(LOAD_STEPS)
        self.solves = np.array([int(run.summary.linear_solves) for run in runs])
        self.ended = np.array([run.outcome != "complete" for run in runs])
        self.off = np.array([difference(run.state.shear, self.event.state.shear) for run in runs])
        self.bad = self.ended | (self.off > OFF_BY)


@cache
def sweeps(name: str, coupling: str) -> list[Sweep]:
    """The sweeps of a figure, by mesh."""
    return [Sweep(varied(text_of(name), "scene", coupling=f"'{coupling}'"), nodes) for nodes in MESHES]


def draw_optimal(ax: Axes) -> None:
    """The largest load steps with good solutions of the conventional algorithm, and their solves."""
    chosen = [(sweep.steps[~sweep.bad][0], sweep.solves[~sweep.bad][0]) for sweep in sweeps("3.19", "goodman")]
    ax.loglog(*np.transpose(chosen), "--", color=NUMBERS, linewidth=2, label="conventional, largest good load steps")


def figure_3_19(name: str) -> Drawn:
    """Linear solves of the conventional algorithm over the load step."""
    picture, axes = panels(2, "3.19  Linear solves of the conventional algorithm, P = 0.004, $\\mu$ = 0.3")
    lines = []
    for ax, coupling in zip(axes, ("goodman", "full")):
        found = sweeps(name, coupling)
        for sweep, marker in zip(found, "osD^"):
            steps, solves, ended, bad = sweep.steps, sweep.solves, sweep.ended, sweep.bad
            ax.loglog(steps[~ended], solves[~ended], linewidth=0.8, color="0.5", zorder=1)
            ax.loglog(steps[~bad], solves[~bad], marker, color=NUMBERS, label=f"{sweep.label}" if coupling == "goodman" else None)
            ax.loglog(steps[bad & ~ended], solves[bad & ~ended], marker, color="red")
            ax.loglog(steps[ended], solves[ended], marker, color="red", markerfacecolor="white")
        ax.set(ylabel="linear solves", title={"goodman": "Goodman", "full": "full coupling"}[coupling])
        lines.append(
            f"{coupling}: {sum(sweep.ended.sum() for sweep in found)} of {len(MESHES) * len(LOAD_STEPS)} runs end early; "
            f"good load steps by mesh at most "
            f"{[f'1/{1 / sweep.steps[~sweep.bad].max():.0f}' if (~sweep.bad).any() else 'none' for sweep in found]}; off "
            f"MFV with 1/128 {[float(f'{sweep.off[-1]:.1g}') for sweep in found]}"
        )
    draw_optimal(axes[0])
    axes[1].plot([], [], "s", color="red", label=f"more than {OFF_BY:.0%} of the shear off MFV")
    axes[1].plot([], [], "s", color="red", markerfacecolor="white", label="ended early: cycling")
    axes[1].set_xlabel("load step, part of the load")
    picture.legend(loc="outside lower center", ncols=3, fontsize=9)
    return picture, "; ".join(lines)


def figure_3_20(name: str) -> Drawn:
    """Linear solves of MFV with nominal steps over the load step."""
    found = sweeps(name, "goodman")
    picture, (ax,) = panels(1, "3.20  Linear solves of MFV with nominal load steps, P = 0.004, $\\mu$ = 0.3, Goodman")
    for sweep, marker in zip(found, "osD^"):
        best = int(np.argmin(sweep.solves))
        ax.loglog(sweep.steps, sweep.solves, marker=marker, color=OTHER, linewidth=0.8, label=sweep.label)
        ax.loglog(
            sweep.steps[best], sweep.solves[best], "*", color=MARKS, markersize=14, label="fewest" if sweep is found[-1] else None
        )
        ax.axhline(
            sweep.event.summary.linear_solves,
            color=CLOSED_FORM,
            linestyle=":",
            label="event stepping, the same meshes" if sweep is found[-1] else None,
        )
    draw_optimal(ax)
    ax.set(xlabel="load step, part of the load", ylabel="linear solves")
    picture.legend(loc="outside lower center", ncols=3, fontsize=9)
    return picture, (
        f"all points one solution: shear at most {max(sweep.off.max() for sweep in found):.0e} of its largest off that of "
        f"event stepping; fewest solves "
        f"{[int(sweep.solves.min()) for sweep in found]}, with load step 1/128 "
        f"{[int(sweep.solves[-1]) for sweep in found]}, event stepping "
        f"{[int(sweep.event.summary.linear_solves) for sweep in found]}"
    )


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
    parser.add_argument(
        "--only", nargs="+", choices=FIGURES, default=list(FIGURES), metavar="3.N", help="figures to draw (default: all)"
    )
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
