"""Figures 6.1 to 6.5 of the dissertation."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from drawing import (
    BLACK,
    BLUE,
    BODIES,
    CYCLE,
    DISSIPATION,
    FORCE_RATIO,
    FRICTION,
    ORANGE,
    Drawn,
    bodies_legend,
    coupled,
    letter,
    line,
    panels,
    stem,
)
from matplotlib.axes import Axes
from sweeps import COUPLINGS, Table

import mfv

#: Half-width by Hertz of the cases of the study, m.
HALF_WIDTH = 0.044
STATES = ("pressed by $P$", "$Q=0.65\\mu P$", "$-Q$", "$Q$", "$-Q$ again")
Results = Mapping[str, mfv.Result]


def figure_6_1(results: Results) -> Drawn:
    """Tractions after pressing and at the first four ends of the lateral force."""
    picture, axes = panels(5, 3, (10.0, 11.0), sharex=True, sharey=True)
    numbers: dict[str, np.ndarray] = {}
    for column, (coupling, result) in enumerate(results.items()):
        scale = 2.0 * float(result.summary.normal_force) / (np.pi * HALF_WIDTH)
        numbers.setdefault("x_over_a", result.mesh.x / HALF_WIDTH)
        for row, state in enumerate(result.steps[:5]):
            ax = axes[3 * row + column]
            draw_tractions(ax, result.mesh.x / HALF_WIDTH, state.pressure / scale, state.shear / scale)
            numbers[f"{coupling}_{row + 1}_pressure_over_p0"] = state.pressure / scale
            numbers[f"{coupling}_{row + 1}_shear_over_p0"] = state.shear / scale
            if column == 0:
                ax.set_ylabel(f"{STATES[row]}\n" + r"$p/p_0,\ \tau/p_0$")
        axes[column].set_title(COUPLINGS[coupling])
        axes[12 + column].set_xlabel("position $x/a$")
    axes[0].set_xlim(-1.3, 1.3)
    picture.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    caption = (
        "Figure 6.1: tractions of a rigid disk in an elastic hole of twice its radius, after pressing and at the first four "
        "ends of the cyclic lateral force, by coupling; p0 and a by Hertz. The dotted line is the middle of the contact."
    )
    return Drawn("figure_6_1", caption, picture, numbers)


def draw_tractions(ax: Axes, x: np.ndarray, pressure: np.ndarray, shear: np.ndarray) -> None:
    """Pressure and shear traction over the contact, with its middle."""
    inside = np.flatnonzero(pressure > 0.0)
    middle = 0.5 * (x[inside[0]] + x[inside[-1]])
    ax.axhline(0.0, color="0.8", linewidth=0.6)
    ax.axvline(middle, color="0.5", linewidth=0.8, linestyle=":", label="middle of the contact")
    ax.plot(x, pressure, color=BLUE, linewidth=1.4, label="pressure $p$")
    ax.plot(x, shear, color=ORANGE, linewidth=1.4, linestyle="--", label=r"shear traction $\tau$")


def figure_6_2(results: Results) -> Drawn:
    """Hysteresis loops, and their non-linear part."""
    picture, axes = panels(2, 3, (10.0, 6.4), sharex="row", sharey=True)
    scale = np.abs(results["none"].history.shift).max()
    numbers: dict[str, np.ndarray] = {}
    for column, (coupling, result) in enumerate(results.items()):
        history = result.history
        force = history.tangential_force / np.abs(history.tangential_force).max()
        loops = {"shift": history.shift / scale, "nonlinear_shift": history.nonlinear_shift / scale}
        steady = history.record >= record_of_steady(result)
        for row, (name, shift) in enumerate(loops.items()):
            ax = axes[3 * row + column]
            ax.plot(shift, force, color=CYCLE[column][0], linewidth=0.9, linestyle="--", label="until steady")
            ax.plot(shift[steady], force[steady], color=BLACK, linewidth=1.2, label="steady loop")
            ax.set_xlabel(r"$U/U_\mathrm{max}$" if row == 0 else r"$(U - Q/k)/U_\mathrm{max}$")
            numbers[f"{coupling}_{name}_over_largest"] = shift
        numbers[f"{coupling}_force_over_amplitude"] = force
        axes[column].set_title(COUPLINGS[coupling])
    axes[0].set_ylabel(r"$Q/Q_\mathrm{max}$")
    axes[3].set_ylabel(r"$Q/Q_\mathrm{max}$")
    axes[0].legend(loc="upper left", fontsize=9)
    caption = (
        "Figure 6.2: hysteresis loops, shift over the largest one of the decoupled contact (above), and their non-linear part "
        "(below): the shift less force over k, the stiffness right after a reversal, each coupling with its own."
    )
    return Drawn("figure_6_2", caption, picture, padded(numbers))


def record_of_steady(result: mfv.Result) -> int:
    """Record of the history at the beginning of the last cycle."""
    ends = result.history.record[result.history.event_kind == mfv.EventKind.STEP_END]
    return int(ends[-3])


def padded(columns: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Columns of one length, NaN where they end."""
    longest = max(map(len, columns.values()))
    return {
        name: np.pad(values.astype(float), (0, longest - len(values)), constant_values=np.nan) for name, values in columns.items()
    }


def by_body(ax: Axes, table: Table, x: str, y: str, scale: float = 1.0, **style: Any) -> None:
    """A line for each pair of bodies."""
    for place, (base, rows) in enumerate(table.each("base")):
        line(ax, rows[x], scale * rows[y], place, BODIES[stem(base)], **style)


def by_body_and_coupling(ax: Axes, table: Table, x: str, y: str, **style: Any) -> None:
    """One colour a coupling; the bodies lie on one another."""
    for _, rows in table.each("base"):
        coupled(ax, rows, x, y, **style)


def figure_6_3(table: Table) -> Drawn:
    """Dissipation, stick ratios and errors of the tractions over the lateral force."""
    picture, axes = panels(3, 3, (12.5, 10.5))
    full, goodman, none = (table.where(coupling=name) for name in COUPLINGS)
    x = "force_ratio"
    by_body(axes[0], full, x, "cycle_dissipation", 1e-3)
    by_body(axes[1], full, x, "dissipation_number")
    by_body_and_coupling(axes[2], table, x, "dissipation_number")
    by_body(axes[3], goodman, x, "dissipation_ratio")
    by_body_and_coupling(axes[4], table, x, "stick_ratio_loading")
    by_body_and_coupling(axes[5], table, x, "stick_ratio_reversal")
    by_body(axes[6], goodman, x, "pressure_error_reversal", 100.0)
    for base, rows in goodman.each("base"):
        other = none.where(base=base)
        for moment, dashes in (("loading", ":"), ("reversal", "-")):
            line(axes[7], rows[x], 100.0 * rows[f"shear_error_{moment}"], 1, f"Goodman, {moment}", linestyle=dashes)
            line(axes[7], other[x], 100.0 * other[f"shear_error_{moment}"], 2, f"decoupled, {moment}", linestyle=dashes)
    axes[1].set(xscale="log", yscale="log")
    titles = {
        "full coupling": r"dissipation of a cycle $D$, kJ/m",
        "full coupling, no dimensions": DISSIPATION,
        "three couplings": DISSIPATION,
        "over-prediction": r"$D_\mathrm{Goodman}/D_\mathrm{full}$",
        "loading (first time at Q)": "stick ratio",
        "reversal (-Q, steady)": "stick ratio",
        "pressure, decoupled either way": r"$L_1$ error of the pressure, %",
        "shear traction": r"$L_1$ error of the shear, %",
    }
    finish_panels(axes[:8], titles, FORCE_RATIO)
    one_each(axes[2], 3)
    one_each(axes[7], 4)
    axes[8].axis("off")
    handles = axes[3].get_legend_handles_labels()
    axes[8].legend(*handles, loc="center", fontsize=11, title="panels a, b, d, g")
    caption = (
        r"Figure 6.3: five bodies and their common limit over the lateral force, mu = 0.7. What differs by KR in (a) is one "
        "curve without dimensions. Below Q~ = 0.1 few of the 150 nodes slip: (d) is to 10 % there. "
        "Errors of the tractions by eq. 6.6."
    )
    names = ["base", x, "coupling", "cycle_dissipation", "dissipation_number", "dissipation_ratio"]
    names += [
        f"{name}_{moment}"
        for name in ("stick_ratio", "patch_shift", "pressure_error", "shear_error")
        for moment in ("loading", "reversal", "return")
    ]
    return Drawn("figure_6_3", caption, picture, table.columns(names))


def finish_panels(axes: list[Axes], titles: Mapping[str, str], xlabel: str) -> None:
    """Titles, labels and letters."""
    for ax, (title, ylabel) in zip(axes, titles.items()):
        ax.set(title=title, xlabel=xlabel, ylabel=ylabel)
    letter(axes)


def one_each(ax: Axes, number: int, **more: Any) -> None:
    """A legend with every label once."""
    handles = dict(zip(*reversed(ax.get_legend_handles_labels())))
    ax.legend(list(handles.values())[:number], list(handles)[:number], fontsize=8.5, **more)


def figure_6_4(table: Table) -> Drawn:
    """Dissipation and errors of the tractions over the coefficient of friction."""
    picture, axes = panels(2, 2, (9.5, 8.0))
    full, goodman, none = (table.where(coupling=name) for name in COUPLINGS)
    by_body(axes[0], full, "mu", "cycle_dissipation", 1e-3)
    by_body_and_coupling(axes[1], table, "mu", "dissipation_number")
    by_body(axes[2], goodman, "mu", "pressure_error_reversal", 100.0)
    for base, rows in goodman.each("base"):
        line(axes[3], rows["mu"], 100.0 * rows["shear_error_reversal"], 1, COUPLINGS["goodman"])
        other = none.where(base=base)
        line(axes[3], other["mu"], 100.0 * other["shear_error_reversal"], 2, COUPLINGS["none"], linestyle="--")
    axes[1].set(xscale="log", yscale="log")
    mu = np.array([0.05, 1.0])
    axes[1].plot(mu, 0.5 * mu**2, color="0.5", linewidth=0.8, linestyle=":", label="slope 2")
    titles = {
        "full coupling": r"dissipation of a cycle $D$, kJ/m",
        "three couplings": DISSIPATION,
        "pressure, decoupled either way": r"$L_1$ error of the pressure, %",
        "shear traction": r"$L_1$ error of the shear, %",
    }
    finish_panels(axes, titles, FRICTION)
    one_each(axes[1], 4)
    one_each(axes[3], 2)
    bodies_legend(picture, axes[0])
    caption = "Figure 6.4: five bodies and their common limit over the coefficient of friction, Q = 0.99 mu P."
    names = [
        "base",
        "mu",
        "coupling",
        "cycle_dissipation",
        "dissipation_number",
        "dissipation_ratio",
        "pressure_error_loading",
        "shear_error_loading",
        "pressure_error_reversal",
        "shear_error_reversal",
    ]
    return Drawn("figure_6_4", caption, picture, table.columns(names))


def figure_6_5(table: Table) -> Drawn:
    """Over-prediction and errors of the tractions over the coefficient of friction, five lateral forces."""
    picture, axes = panels(1, 3, (13.0, 4.6))
    for place, (ratio, rows) in enumerate(table.where(coupling="goodman").each("force_ratio")):
        other = table.where(coupling="none", force_ratio=ratio)
        label = rf"$\tilde Q = {ratio:g}$"
        line(axes[0], rows["mu"], rows["dissipation_ratio"], place, label)
        line(axes[1], rows["mu"], 100.0 * rows["pressure_error_reversal"], place, label)
        line(axes[2], rows["mu"], 100.0 * rows["shear_error_reversal"], place, label)
        line(axes[2], other["mu"], 100.0 * other["shear_error_reversal"], place, linestyle="--", markerfacecolor="white")
    titles = {
        "over-prediction": r"$D_\mathrm{Goodman}/D_\mathrm{full}$",
        "pressure, decoupled either way": r"$L_1$ error of the pressure, %",
        "shear: Goodman full lines, decoupled dashed": r"$L_1$ error of the shear, %",
    }
    finish_panels(axes, titles, FRICTION)
    axes[1].legend(fontsize=9)
    caption = "Figure 6.5: rigid disk in an elastic hole of twice its radius, five lateral forces over the coefficient of friction."
    names = [
        "force_ratio",
        "mu",
        "coupling",
        "dissipation_number",
        "dissipation_ratio",
        "pressure_error_loading",
        "shear_error_loading",
        "pressure_error_reversal",
        "shear_error_reversal",
    ]
    return Drawn("figure_6_5", caption, picture, table.columns(names))


def draw_chapter(tables: Mapping[str, Table], results: Results) -> list[Drawn]:
    """All of them."""
    return [
        figure_6_1(results),
        figure_6_2(results),
        figure_6_3(tables["lateral_force"]),
        figure_6_4(tables["friction"]),
        figure_6_5(tables["ratios"]),
    ]
