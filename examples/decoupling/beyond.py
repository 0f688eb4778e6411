"""Pictures that go beyond the dissertation."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import analysis
import numpy as np
from drawing import BLACK, FORCE_RATIO, FRICTION, Drawn, letter, line, panels, stem
from matplotlib.axes import Axes
from sweeps import COUPLINGS, Table

#: How the bodies were brought together before the cycles.
BEGINNINGS = {
    "pressed_rough": "pressed with friction",
    "pressed_smooth": "pressed without friction",
    "overpressed": "pressed twice as hard before",
    "overloaded": r"sheared to $0.95\mu P$ before",
    "overloaded_back": r"sheared to $-0.95\mu P$ before",
}
LAWS = {
    "hole_050": "Coulomb, 0.7",
    "static_kinetic": "static 0.7 and kinetic 0.49",
    "weakening": "weakening, 0.7 to 0.49",
    "dahl": "Dahl, 0.7",
}
BETA = r"Dundurs' $\beta$"


def mindlin(table: Table) -> Drawn:
    """Two disks that are alike against the closed form."""
    picture, axes = panels(1, 2, (10.0, 4.3))
    ratio = np.geomspace(table["force_ratio"].min(), 0.99, 200)
    axes[0].loglog(ratio, analysis.mindlin_number(ratio), color=BLACK, linewidth=1.0, label="closed form (eq. 6.4, corrected)")
    for place, (nodes, rows) in enumerate(table.each("nodes_of_mesh")):
        exact = analysis.mindlin_number(rows["force_ratio"])
        label = f"mesh of {nodes} nodes"
        positive = rows["dissipation_number"] > 0.0
        line(axes[0], rows["force_ratio"][positive], rows["dissipation_number"][positive], place, label, linestyle="none")
        line(axes[1], rows["force_ratio"], 100.0 * np.abs(rows["dissipation_number"] / exact - 1.0), place, label)
    axes[0].set(title="dissipation", xlabel=FORCE_RATIO, ylabel=r"$D/(P^2 A)$")
    axes[1].set(title="error", xlabel=FORCE_RATIO, ylabel="difference from the closed form, %", yscale="log", xscale="log")
    letter(axes)
    axes[0].legend(fontsize=8.5)
    caption = "Two disks of one material and radius, where nothing couples: dissipation of a cycle against the closed form."
    return Drawn("mindlin", caption, picture, table.columns(["nodes_of_mesh", "force_ratio", "dissipation_number"]))


def small_force(table: Table) -> Drawn:
    """Local slopes of the dissipation over the lateral force, by mesh."""
    picture, axes = panels(1, 2, (11.0, 4.6))
    for place, (nodes, rows) in enumerate(table.each("nodes_of_mesh")):
        for coupling, dashes in (("full", "-"), ("none", "--")):
            curve = rows.where(coupling=coupling)
            where, slopes = analysis.local_slopes(curve["force_ratio"], curve["dissipation_number"])
            line(axes[0], where, slopes, place, linestyle=dashes, markerfacecolor=None if dashes == "-" else "white")
        full, none = rows.where(coupling="full"), rows.where(coupling="none")
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio = none["dissipation_number"] / full["dissipation_number"]
        line(axes[1], full["force_ratio"], ratio, place, f"{nodes}")
    for value in (3.0, 3.15):
        axes[0].axhline(value, color="0.6", linewidth=0.8, linestyle=":")
    axes[0].set(
        title="local slope: full coupling full lines, decoupled dashed",
        ylabel=r"$d\ln D/d\ln\tilde Q$",
        ylim=(2.7, 3.7),
    )
    axes[1].set(title="over-prediction", ylabel=r"$D_\mathrm{decoupled}/D_\mathrm{full}$", ylim=(1.0, 2.6))
    for ax in axes:
        ax.set(xlabel=FORCE_RATIO, xscale="log")
        ax.set_xticks([0.02, 0.05, 0.1, 0.2, 0.5], ["0.02", "0.05", "0.1", "0.2", "0.5"])
        ax.minorticks_off()
    letter(axes)
    axes[1].legend(fontsize=8.5, title="number of mesh nodes", title_fontsize=8.5)
    caption = (
        "Small lateral forces, mu = 0.7, beta = 0.286: slope of the dissipation from point to point by mesh, and the "
        "over-prediction. On meshes of fewer nodes only a few slip at the left end."
    )
    return Drawn(
        "small_force",
        caption,
        picture,
        table.columns(["nodes_of_mesh", "force_ratio", "coupling", "dissipation_number"]),
    )


def mismatch(table: Table) -> Drawn:
    """Dissipation and patch shift over Dundurs' beta of both signs."""
    ratios = table.values("force_ratio")
    picture, axes = panels(1, 2, (10.5, 4.4))
    for place, ratio in enumerate(ratios):
        reference = table.where(force_ratio=ratio, coupling="none")["dissipation_number"]
        rows = table.where(force_ratio=ratio, coupling="full")
        line(axes[0], rows["beta"], rows["dissipation_number"] / reference, place, rf"$\tilde Q={ratio:g}$")
        line(axes[1], rows["beta"], rows["patch_shift_return"], place, rf"$\tilde Q={ratio:g}$")
    axes[0].axhline(1.0, color="0.5", linewidth=0.8, linestyle="--", label="Goodman")
    axes[0].set(title="dissipation, full coupling", xlabel=BETA, ylabel=r"$D/D_\mathrm{decoupled}$")
    axes[1].set(title="shift of the contact at $Q$, full coupling", xlabel=BETA, ylabel="middle over half-width")
    letter(axes)
    axes[0].legend(fontsize=8)
    axes[1].legend(fontsize=9)
    caption = "Two disks of one radius, mu = 0.7, materials from beta = -0.5 to 0.5 at the same compliance A."
    names = [
        "beta",
        "force_ratio",
        "coupling",
        "dissipation_number",
        "patch_shift_return",
        "pressure_error_return",
        "shear_error_return",
    ]
    return Drawn("mismatch", caption, picture, table.columns(names))


def error_map(table: Table, fine: Table) -> Drawn:
    """Over-prediction of the dissipation by Goodman's approximation over beta and mu, for some lateral forces.

    The forces that `fine` has, where few nodes slip, are taken from there.
    """
    names = ["beta", "mu", "force_ratio", "nodes", "dissipation_ratio"]
    names += [f"{name}_{moment}" for name in ("pressure_error", "shear_error") for moment in ("loading", "reversal")]
    smaller, larger = fine.where(coupling="goodman"), table.where(coupling="goodman")
    larger = larger.between("force_ratio", smaller["force_ratio"].max() + 1e-3, 1.0)
    rows = Table(np.concatenate([part.rows[names] for part in (smaller, larger)]))
    ratios = np.unique(rows["force_ratio"])
    shown = [ratios[i] for i in np.unique(np.linspace(0, len(ratios) - 1, 6).round().astype(int))]
    picture, axes = panels(2, 3, (11.5, 7.0), sharex=True, sharey=True)
    levels = np.array([0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000])
    for ax, ratio in zip(axes, shown):
        filled = contours(ax, rows.where(force_ratio=ratio), levels)
        ax.set_title(rf"$\tilde Q = {ratio:g}$")
    for ax in axes[3:]:
        ax.set_xlabel(BETA)
    for ax in axes[::3]:
        ax.set_ylabel(FRICTION)
    letter(axes)
    bar = picture.colorbar(filled, ax=axes, ticks=levels, shrink=0.8, pad=0.02)
    bar.ax.set_yticklabels([f"{level:g} %" for level in levels])
    bar.set_label("dissipation of a cycle over-predicted by Goodman's approximation")
    caption = (
        "By how much Goodman's approximation (and full decoupling, which has the same dissipation) over-predicts the "
        "dissipation of a steady cycle. Two disks of one radius, pressed with friction. Meshes of "
        f"{larger['nodes'].max()} nodes, {smaller['nodes'].max()} at Q~ = {smaller['force_ratio'].max():g}, where few slip."
    )
    return Drawn("map", caption, picture, rows.columns(names), in_docs=True)


def contours(ax: Axes, rows: Table, levels: np.ndarray) -> Any:
    """Filled contours with labels; what is below the first level or beyond the last has the colour of its end."""
    from matplotlib.colors import LogNorm

    beta, mu = np.unique(rows["beta"]), np.unique(rows["mu"])
    error = 100.0 * (rows["dissipation_ratio"].reshape(len(beta), len(mu)).T - 1.0)
    error = np.clip(error, levels[0], levels[-1])
    norm = LogNorm(levels[0], levels[-1])
    filled = ax.contourf(beta, mu, error, levels=levels, norm=norm, cmap="cividis_r")
    lines = ax.contour(beta, mu, error, levels=levels[1:-1], colors="white", linewidths=0.6)
    ax.clabel(lines, fmt="%g %%", fontsize=8)
    return filled


def rule_of_thumb(table: Table) -> Drawn:
    """Is there one parameter? The over-prediction over beta mu, over beta squared, and against the rule."""
    rows = table.where(coupling="goodman")
    rule = analysis.fitted_rule(table)
    picture, axes = panels(1, 3, (13.0, 4.4))
    ratio = rows.values("force_ratio")[-2]
    for place, (beta, curve) in enumerate(rows.where(force_ratio=ratio).each("beta")):
        if place % 2 == 0 and len(rows.values("beta")) > 6:
            continue
        excess = np.log(curve["dissipation_ratio"])
        line(axes[0], beta * curve["mu"], excess, place, rf"$\beta={beta:g}$")
        line(axes[1], curve["mu"], excess / beta**2, place, rf"$\beta={beta:g}$")
    inside = rows.between("beta", 0.0, rule.beta_limit).between("force_ratio", rule.ratio_limit, 1.0)
    for place, (force, curve) in enumerate(inside.each("force_ratio")):
        predicted = rule.ratio(curve["beta"], curve["mu"])
        over = 100.0 * (curve["dissipation_ratio"] - 1.0)
        line(axes[2], 100.0 * (predicted - 1.0), over, place, rf"$\tilde Q={force:g}$", linestyle="none")
    end = 100.0 * inside["dissipation_ratio"].max() - 100.0
    axes[2].plot([0.0, end], [0.0, end], color="0.5", linewidth=0.8)
    axes[0].set(
        title=rf"over $\beta\mu$: no one curve, $\tilde Q={ratio:g}$",
        xlabel=r"$\beta\mu$",
        ylabel=r"$\ln(D_\mathrm{Goodman}/D_\mathrm{full})$",
    )
    axes[1].set(
        title=rf"over $\beta^2$: nearly one, $\tilde Q={ratio:g}$",
        xlabel=FRICTION,
        ylabel=r"$\ln(D_\mathrm{Goodman}/D_\mathrm{full})/\beta^2$",
        ylim=(0.0, None),
    )
    axes[2].set(title="the rule", xlabel="over-prediction by the rule, %", ylabel="computed, %")
    letter(axes)
    for ax in axes:
        ax.legend(fontsize=8)
    c0, c1 = rule.coefficients
    caption = (
        f"What matters? ln(D_Goodman/D_full) = beta^2 ({c0:.2f} + {c1:.2f} mu^2), fitted for beta up to "
        f"{rule.beta_limit:g} and Q~ from {rule.ratio_limit:g} on; "
        f"it misses ln(D_Goodman/D_full) by {rule.largest_miss:.3f} at most."
    )
    return Drawn("rule_of_thumb", caption, picture, rows.columns(["beta", "mu", "force_ratio", "dissipation_ratio"]))


def traction_errors(table: Table) -> Drawn:
    """Errors of the tractions and shift of the contact over beta mu."""
    picture, axes = panels(1, 3, (13.0, 4.4))
    rows = table.between("mu", 0.2, 1.0)
    ratios = rows.values("force_ratio")
    columns = {
        "pressure": ("goodman", "pressure_error_reversal", 100.0, r"$L_1$ error of the pressure, %"),
        "shear traction": ("goodman", "shear_error_reversal", 100.0, r"$L_1$ error of the shear, %"),
        "shift of the contact": ("full", "patch_shift_reversal", 1.0, "middle over half-width, full coupling"),
    }
    for ax, (title, (coupling, column, scale, label)) in zip(axes, columns.items()):
        for place, i in enumerate(np.unique(np.linspace(0, len(ratios) - 1, 4).round().astype(int))):
            part = rows.where(coupling=coupling, force_ratio=ratios[i])
            line(
                ax,
                part["beta"] * part["mu"],
                scale * np.abs(part[column]),
                place,
                rf"$\tilde Q={ratios[i]:g}$",
                linestyle="none",
            )
        ax.set(title=title, xlabel=r"$\beta\mu$", ylabel=label)
    letter(axes)
    axes[0].legend(fontsize=8.5)
    caption = (
        "What Goodman's approximation leaves out of the tractions, at -Q in the steady cycle, mu from 0.2 to 1: the product "
        "beta mu tells it, but for the smallest forces, where the shear of the pressing remains."
    )
    names = [
        "beta",
        "mu",
        "force_ratio",
        "coupling",
        "pressure_error_reversal",
        "shear_error_reversal",
        "patch_shift_reversal",
    ]
    return Drawn("traction_errors", caption, picture, rows.columns(names), in_docs=True)


def shakedown(table: Table) -> Drawn:
    """The steady dissipation by what went before."""
    picture, axes = panels(1, 2, (11.0, 4.8), sharey=True)
    for ax, (beta, rows) in zip(axes, table.each("beta")):
        for place, (base, curve) in enumerate(rows.where(coupling="full").each("base")):
            uncoupled = rows.where(coupling="none", base=base)["dissipation_number"]
            part = curve["dissipation_number"] / uncoupled
            style = dict(linestyle=":", markerfacecolor="none", markersize=6.0) if stem(base) == "overloaded_back" else {}
            line(ax, curve["force_ratio"], np.maximum(part, 0.0), place, BEGINNINGS[stem(base)], **style)
        ax.axhline(1.0, color="0.5", linewidth=0.8, linestyle="--", label="Goodman or decoupled, all five")
        ax.set(title=rf"full coupling, $\beta={beta:.3g}$", xlabel=FORCE_RATIO)
    axes[0].set(ylabel=r"$D/D_\mathrm{decoupled}$ of the steady cycle", ylim=(-0.03, 1.08))
    letter(axes)
    axes[1].legend(fontsize=8.5, loc="lower right")
    caption = (
        "The same cycles after five ways of bringing the bodies together, mu = 0.7: with full coupling the steady state "
        "remembers them; at beta = 0.5 nothing slips any more below a lateral force (frictional shakedown)."
    )
    names = ["base", "beta", "force_ratio", "coupling", "cycles", "cycle_change", "dissipation_number"]
    return Drawn("shakedown", caption, picture, table.columns(names), in_docs=True)


def threshold(table: Table) -> Drawn:
    """Below which lateral force nothing slips."""
    picture, axes = panels(1, 2, (11.0, 4.6))
    for place, (beta, rows) in enumerate(table.each("beta")):
        for dashes, (mu, curve) in zip(("-", "--", ":"), rows.each("mu")):
            decoupled = analysis.mindlin_number(curve["force_ratio"]) * (mu / analysis.MU) ** 2
            part = np.maximum(curve["dissipation_number"] / decoupled, 1e-6)
            line(
                axes[0],
                curve["force_ratio"],
                part,
                place,
                rf"$\beta={beta:g},\ \mu={mu:g}$",
                linestyle=dashes,
                markersize=2.5,
            )
    for (beta, mu), found in analysis.thresholds(table).items():
        place, scale = table.values("beta").index(beta), analysis.edge_scale(beta, mu)
        filling = {} if found.resolved else {"markerfacecolor": "white"}
        line(axes[1], np.array([scale]), np.array([found.patch_shift]), place, linestyle="none", **filling)
        axes[1].annotate(rf"$\mu={mu:g}$", (scale, found.patch_shift), (5, -9), textcoords="offset points", fontsize=8)
    reach = np.array([0.003, 0.06])
    axes[1].loglog(reach, 2.5 * reach, color="0.5", linewidth=0.8, label="2.5 times")
    axes[1].legend(fontsize=8.5)
    axes[0].set(
        title="full coupling",
        xlabel=FORCE_RATIO,
        ylabel=r"$D/D_\mathrm{decoupled}$ (1e-6: or less)",
        xscale="log",
        yscale="log",
    )
    axes[0].set_xticks([0.02, 0.05, 0.1, 0.2, 0.3], ["0.02", "0.05", "0.1", "0.2", "0.3"])
    axes[1].set_xticks([0.002, 0.005, 0.01, 0.02, 0.05], ["0.002", "0.005", "0.01", "0.02", "0.05"])
    for ax in axes:
        ax.tick_params(axis="x", which="minor", labelbottom=False)
    axes[1].set(
        title=r"where $D/D_\mathrm{decoupled}$ passes 0.001",
        xlabel=r"$2\,\exp(-\mathrm{arccot}(\mu)/\epsilon)$",
        ylabel="shift of the contact over its half-width",
    )
    letter(axes)
    axes[0].legend(fontsize=8)
    caption = (
        "Below a lateral force nothing slips any more with full coupling. A stuck edge carries pressure and shear as "
        "tan(eps ln(2a/r)), 2 pi eps = ln((1 + beta)/(1 - beta)): where the contact shifts by less than some 2.5 times the "
        "distance at which that is 1/mu, friction holds all of it. Open: that distance is less than two intervals of the mesh."
    )
    names = ["beta", "mu", "force_ratio", "dissipation_number", "patch_shift_return"]
    return Drawn("threshold", caption, picture, table.columns(names))


def laws(table: Table) -> Drawn:
    """Ratio of the dissipations under other laws of friction."""
    picture, axes = panels(1, 2, (11.0, 4.4))
    for place, (base, rows) in enumerate(table.each("base")):
        for coupling, dashes in (("goodman", "-"), ("none", "--")):
            curve = rows.where(coupling=coupling)
            label = LAWS[stem(base)] if coupling == "goodman" else None
            style = dict(linestyle=dashes, markerfacecolor=None if dashes == "-" else "white")
            line(axes[0], curve["force_ratio"], curve["dissipation_ratio"], place, label, **style)
            line(axes[1], curve["force_ratio"], 100.0 * curve["shear_error_return"], place, label, **style)
    axes[0].set(title="dissipation", xlabel=FORCE_RATIO, ylabel=r"$D/D_\mathrm{full}$")
    axes[1].set(title="shear traction", xlabel=FORCE_RATIO, ylabel=r"$L_1$ error of the shear at $Q$, %")
    letter(axes)
    axes[0].axhline(1.0, color="0.7", linewidth=0.8)
    axes[0].legend(fontsize=8.5, title="full lines Goodman, dashed decoupled", title_fontsize=8.5)
    caption = (
        "Other laws of friction, rigid disk in a hole, 75 nodes in contact. Where the coefficient falls, or bristles give way, "
        "Goodman and full decoupling no longer dissipate the same: the shear of the pressing matters."
    )
    names = [
        "base",
        "force_ratio",
        "coupling",
        "linear_solves",
        "dissipation_number",
        "dissipation_ratio",
        "pressure_error_return",
        "shear_error_return",
    ]
    return Drawn("laws", caption, picture, table.columns(names))


def stiffness(table: Table) -> Drawn:
    """Stiffness and loss factor, which joint models take from a contact."""
    picture, axes = panels(1, 3, (13.0, 4.2))
    rows = table.where(base=table.values("base")[-1])
    full = rows.where(coupling="full")
    for place, coupling in enumerate(COUPLINGS):
        curve = rows.where(coupling=coupling)
        line(
            axes[0],
            curve["force_ratio"],
            curve["tangential_stiffness"] / full["tangential_stiffness"],
            place,
            COUPLINGS[coupling],
        )
        line(axes[1], curve["force_ratio"], curve["secant_stiffness"] / full["secant_stiffness"], place)
        line(axes[2], curve["force_ratio"], curve["loss_factor"], place)
    axes[0].set(title="stiffness after a reversal", xlabel=FORCE_RATIO, ylabel="over that of full coupling")
    axes[1].set(title="stiffness from end to end", xlabel=FORCE_RATIO, ylabel="over that of full coupling")
    axes[2].set(title="loss factor", xlabel=FORCE_RATIO, ylabel=r"$D/(2\pi\,\frac{1}{2}Q U)$")
    letter(axes)
    axes[0].legend(fontsize=9)
    caption = "What a model of a joint takes from a contact, rigid disk on an elastic half-plane, mu = 0.7, beta = 0.286. In "
    caption += "two dimensions the displacements, and with them stiffness and loss factor, depend on the datum, R here."
    names = ["force_ratio", "coupling", "tangential_stiffness", "secant_stiffness", "loss_factor", "stiffness_number"]
    return Drawn("stiffness", caption, picture, rows.columns(names))


def draw_beyond(tables: Mapping[str, Table]) -> list[Drawn]:
    """All of them."""
    return [
        mindlin(tables["mindlin"]),
        small_force(tables["small_force"]),
        mismatch(tables["mismatch"]),
        error_map(tables["map"], tables["map_fine"]),
        rule_of_thumb(tables["map"]),
        traction_errors(tables["map"]),
        shakedown(tables["shakedown"]),
        threshold(tables["threshold"]),
        stiffness(tables["lateral_force"]),
        laws(tables["laws"]),
    ]
