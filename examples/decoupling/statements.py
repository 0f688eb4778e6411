"""What the dissertation says about its Figures 6.1 to 6.5, statement by statement, beside what is computed here."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import analysis
import numpy as np
from chapter_six import HALF_WIDTH
from sweeps import COUPLINGS, Table

import mfv

AGREES, PARTLY, DIFFERS, BEYOND = "agrees", "agrees in part", "differs", "not in the text"
#: What is zero to round-off, in parts of the largest traction.
ROUND_OFF = 1e-9
CASES = Path(__file__).resolve().parent / "cases"


@dataclass
class Statement:
    """One row: where it stands, what it says, its number, ours, the verdict and, where they differ, why."""

    section: str
    claim: str
    printed: str
    ours: str
    verdict: str
    why: str = ""


def agreed(condition: bool, otherwise: str = DIFFERS) -> str:
    """The verdict of a condition."""
    return AGREES if condition else otherwise


def span(values: np.ndarray, form: str = ".2f") -> str:
    """Smallest to largest."""
    return f"{np.nanmin(values):{form}} to {np.nanmax(values):{form}}"


def percent(values: np.ndarray) -> str:
    """Smallest to largest, in percent."""
    return f"{100 * np.nanmin(values):.1f} to {100 * np.nanmax(values):.1f} %"


def change(one: mfv.Group, other: mfv.Group) -> float:
    """Largest difference of the tractions of two states over the largest pressure."""
    scale = np.abs(other.pressure).max()
    return float(max(np.abs(one[name] - other[name]).max() for name in ("pressure", "shear")) / scale)


# Section 6.3: one cycle


def pressing(results: Mapping[str, mfv.Result]) -> list[Statement]:
    """After the normal force."""
    states = {name: result.steps[0] for name, result in results.items()}
    width = {name: state.contact_half_width for name, state in states.items()}
    shear = {name: state.shear for name, state in states.items()}
    odd = max(np.abs(shear[name] + shear[name][::-1]).max() / np.abs(shear[name]).max() for name in ("full", "goodman"))
    force = float(results["none"].summary.normal_force)
    at_8e7 = 2.0 * width["none"] * np.sqrt(8.0e7 / force)
    narrower = width["full"] / width["goodman"]
    return [
        Statement(
            "6.3",
            "P = 8.0e7 N makes the contact 2a = 0.022 R wide, 1.26 degrees",
            "0.022",
            f"{at_8e7 / 4.0:.4f} at 8.0e7 N; 0.022 R needs {force * (HALF_WIDTH / width['none']) ** 2:.3g} N, used here",
            agreed(abs(at_8e7 / 4.0 - 0.022) < 0.0006),
            "P is printed to one digit",
        ),
        Statement(
            "6.3",
            "pressed, the contact is a little narrower with full coupling",
            "-",
            f"{100 * (1 - narrower):.1f} % narrower",
            agreed(0.9 < narrower < 0.999),
        ),
        Statement(
            "6.3",
            "pressed, the shear is self-equilibrating and antisymmetric with full coupling and Goodman",
            "-",
            f"largest |tau(x) + tau(-x)| {odd:.0e} of the largest tau",
            agreed(odd < ROUND_OFF),
        ),
        Statement(
            "6.3",
            "pressed, decoupled bodies have no shear",
            "0",
            f"{np.abs(shear['none']).max():.0e}",
            agreed(not shear["none"].any()),
        ),
    ]


def cycling(results: Mapping[str, mfv.Result]) -> list[Statement]:
    """Under the lateral force."""
    full = results["full"].steps
    centre = [0.5 * (state.contact_left + state.contact_right) / HALF_WIDTH for state in full]
    unchanged = max(
        np.abs(
            state.pressure / results[name].steps[0].pressure.max()
            - results[name].steps[0].pressure / results[name].steps[0].pressure.max()
        ).max()
        for name in ("goodman", "none")
        for state in results[name].steps
    )
    none = results["none"].steps
    scale = np.abs(none[1].shear).max()
    mirrored = np.abs(none[1].shear + none[2].shear).max() / scale
    even = np.abs(none[1].shear - none[1].shear[::-1]).max() / scale
    again = {name: change(result.steps[4], result.steps[2]) for name, result in results.items()}
    early = change(full[3], full[1])
    return [
        Statement(
            "6.3",
            "the pressures of Goodman and the decoupled contact do not change under Q",
            "0",
            f"{unchanged:.0e} of the peak",
            agreed(unchanged < ROUND_OFF),
        ),
        Statement(
            "6.3",
            "under Q the contact with full coupling shifts to the left by 0.1a",
            "0.1",
            f"{-centre[1]:.3f}",
            agreed(abs(-centre[1] - 0.1) < 0.02),
        ),
        Statement(
            "6.3",
            "under -Q it shifts to the right by 0.2a",
            "0.2",
            f"{centre[2] - centre[1]:.3f}",
            agreed(abs(centre[2] - centre[1] - 0.2) < 0.04),
        ),
        Statement(
            "6.3",
            "decoupled, the shear is symmetric, and turned over under -Q",
            "-",
            f"{even:.0e}, {mirrored:.0e} of the largest tau",
            agreed(max(even, mirrored) < ROUND_OFF),
        ),
        Statement(
            "6.3",
            "under Q again full coupling has not the tractions of the first Q",
            "-",
            f"differs by {100 * early:.0f} % of the peak pressure",
            agreed(early > 0.05),
        ),
        Statement(
            "6.3",
            "state 5 (-Q again) is state 3: steady from the first reversal on",
            "the same",
            ", ".join(f"{COUPLINGS[name]} {value:.0e}" for name, value in again.items()) + " of the peak",
            agreed(max(again.values()) < ROUND_OFF),
        ),
    ]


def steady_loop(result: mfv.Result) -> tuple[np.ndarray, np.ndarray]:
    """Force over its amplitude, and shift less its linear part over the largest shift, on the way back of the last cycle."""
    history = result.history
    first, last = history.record[history.event_kind == mfv.EventKind.STEP_END][-3:-1]
    way = (history.record >= first) & (history.record <= last)
    force = history.tangential_force[way] / np.abs(history.tangential_force).max()
    return force[::-1], history.nonlinear_shift[way][::-1] / np.abs(history.shift).max()


def apart(one: mfv.Result, other: mfv.Result) -> float:
    """Largest difference of two steady loops on the way back, their middles laid on one another, over their width."""
    force = np.linspace(-1.0, 1.0, 401)
    curves = [np.interp(force, *steady_loop(result)) for result in (one, other)]
    centred = [curve - 0.5 * (curve[0] + curve[-1]) for curve in curves]
    return float(np.abs(centred[0] - centred[1]).max() / np.ptp(centred[0]))


def loops(table: Table, results: Mapping[str, mfv.Result]) -> list[Statement]:
    """Hysteresis."""
    decoupled, full = (apart(results[name], results["none"]) for name in ("goodman", "full"))
    first = table["first_cycle_dissipation"] / table["cycle_dissipation"]
    steady = dict(zip(table["coupling"], table["dissipation_number"]))
    same = abs(steady["goodman"] / steady["none"] - 1.0)
    errors = dict(zip(table["coupling"], table["shear_error_reversal"]))
    return [
        Statement(
            "6.3",
            "the first cycle differs from the steady one with full coupling and Goodman, not decoupled",
            "-",
            ", ".join(f"{COUPLINGS[name]} {value:.2f}" for name, value in zip(table["coupling"], first))
            + " times the steady dissipation",
            agreed(first[0] > 1.05 and first[1] > 1.05 and abs(first[2] - 1.0) < 1e-6),
        ),
        Statement(
            "6.3",
            "steady loops of Goodman and the decoupled contact are nearly identical and dissipate the same",
            "the same",
            f"dissipation to {same:.0e}; loops laid on one another differ by {100 * decoupled:.2f} % of their width (full coupling: "
            f"{100 * full:.0f} %)",
            agreed(same < ROUND_OFF and decoupled < 0.01),
        ),
        Statement(
            "6.3",
            "the shear of Goodman is quantitatively very similar to that of full coupling, the decoupled one is not",
            "-",
            f"L1 errors at -Q: {100 * errors['goodman']:.0f} % and {100 * errors['none']:.0f} %",
            agreed(errors["goodman"] < 0.15 and errors["none"] > errors["goodman"], PARTLY),
            "in shape yes; a third of the traction is not very similar",
        ),
    ]


# Section 6.4: over the lateral force


def dissipation_over_force(table: Table, small: Table) -> list[Statement]:
    """Figures 6.3a to d."""
    wide = table.between("force_ratio", 0.2, 1.0)
    spread = analysis.bodies_spread(wide.where(coupling="full"), "dissipation_number", ["force_ratio"], ("half_plane",))
    disks = analysis.bodies_spread(wide.where(coupling="full"), "dissipation_number", ["force_ratio"], ("half_plane", "hole"))
    none, goodman = table.where(coupling="none"), table.where(coupling="goodman")
    same = np.abs(goodman["dissipation_number"] / none["dissipation_number"] - 1.0).max()
    ratios = goodman["dissipation_ratio"]
    ratio_spread = analysis.bodies_spread(wide.where(coupling="goodman"), "dissipation_ratio", ["force_ratio"], ("half_plane",))
    again = float(table["cycle_change"].max())
    smallest_force, smallest = over_prediction(small)
    width = 2.0 * none["contact_half_width"]
    return [
        Statement(
            "6.4",
            "P makes the contact 0.088 m wide for all bodies",
            "0.088",
            f"{span(width, '.4f')} m decoupled",
            agreed(bool((np.abs(width - 0.088) < 1e-4).all())),
        ),
        Statement(
            "6.3, 6.4",
            "other bodies and forces too are steady after the first reversal: at least three of four cycles are",
            "-",
            f"tractions change by {again:.0e} of the largest over the last cycle, in {len(table)} cases",
            agreed(again < ROUND_OFF),
        ),
        Statement(
            "6.4",
            "without dimensions the dissipation of all bodies is one curve, whatever KR",
            "one curve",
            f"differs by {100 * spread:.2f} % at most (Q~ from 0.2 on), by {100 * disks:.3f} % among disks",
            agreed(spread < 0.02),
            "what differs is not KR but a/R = 0.011: a hole and a disk are not quite half-planes",
        ),
        *slopes(small),
        Statement(
            "6.4",
            "Goodman and full decoupling dissipate nearly the same",
            "nearly",
            f"the same to {same:.0e}",
            agreed(same < 1e-6),
        ),
        Statement(
            "6.4",
            "at every lateral force they dissipate more than full coupling",
            "-",
            f"at least {100 * (ratios.min() - 1):.1f} % more",
            agreed(bool((ratios > 1.0).all())),
        ),
        Statement(
            "6.4",
            "they over-predict by 20 % to 50 %",
            "20 to 50 %",
            f"{100 * (ratios.min() - 1):.0f} to {100 * (smallest.max() - 1):.0f} % over Q~ = {smallest_force:g} to 0.99; "
            f"50 % at Q~ = {where_half(small):.3f}",
            agreed(0.18 < ratios.min() - 1.0 < 0.22 and 1.4 < smallest.max() < 1.6, PARTLY),
            "20 % is the level from Q~ = 0.4 on; the upper end is that of the smallest force taken (here on 1200 nodes in "
            "contact), and has no limit there",
        ),
        Statement(
            "6.4",
            "the over-prediction does not depend on KR",
            "-",
            f"differs by {100 * ratio_spread:.2f} %",
            agreed(ratio_spread < 0.02),
        ),
    ]


def over_prediction(small: Table) -> tuple[float, np.ndarray]:
    """The smallest lateral force ratio, and D_decoupled/D_full over all of them, finest mesh."""
    rows = small.where(nodes_of_mesh=small["nodes_of_mesh"].max())
    full, none = rows.where(coupling="full"), rows.where(coupling="none")
    return float(full["force_ratio"].min()), none["dissipation_number"] / full["dissipation_number"]


def where_half(small: Table) -> float:
    """Lateral force ratio at which the decoupled contact dissipates half as much again, finest mesh."""
    rows = small.between("force_ratio", 0.03, 0.6)
    _, ratio = over_prediction(rows)
    return float(np.exp(np.interp(-1.5, -ratio, np.log(rows.values("force_ratio")))))


def slope_between(small: Table, nodes: int, coupling: str, low: float, high: float) -> float:
    """Slope of log D over log Q on one mesh."""
    rows = small.where(nodes_of_mesh=nodes, coupling=coupling).between("force_ratio", low, high)
    return analysis.slope(rows["force_ratio"], rows["dissipation_number"])


def slopes(small: Table) -> list[Statement]:
    """Slopes at small lateral forces, on the finest mesh."""
    finest, coarse = small["nodes_of_mesh"].max(), 165
    fits = {coupling: slope_between(small, finest, coupling, 0.05, 0.2) for coupling in ("full", "none")}
    few = {coupling: slope_between(small, coarse, coupling, 0.07, 0.1) for coupling in ("full", "none")}
    full = small.where(nodes_of_mesh=finest, coupling="full")
    where, local = analysis.local_slopes(full["force_ratio"], full["dissipation_number"])
    exact = analysis.slope(np.array([0.05, 0.1, 0.2]), analysis.mindlin_number(np.array([0.05, 0.1, 0.2])))
    limit = analysis.slope(np.array([1e-3, 2e-3]), analysis.mindlin_number(np.array([1e-3, 2e-3])))
    return [
        Statement(
            "6.4",
            "with full coupling the slope of log D over log Q is roughly 3.15 at small forces",
            "3.15",
            f"{fits['full']:.2f} over Q~ = 0.05 to 0.2; local slopes {span(local)}, least at {where[local.argmin()]:.2f}",
            agreed(abs(fits["full"] - 3.15) < 0.03),
            "there is no limit to find: the local slope falls to 3.22 and rises again below Q~ = 0.1 (meshes of 300 to 1200 "
            "nodes in contact agree). With 150 nodes in contact, of which 6 to 9 slip, it is "
            f"{few['full']:.2f} between 0.07 and 0.1, and {few['none']:.2f} decoupled: the printed 3.15 and 3.0 may be of such a mesh",
        ),
        Statement(
            "6.4",
            "with Goodman or full decoupling the slope is close to 3.0",
            "3.0",
            f"{fits['none']:.2f} over 0.05 to 0.2; closed form {exact:.2f}, {limit:.3f} at Q~ = 0.001",
            agreed(abs(fits["none"] - 3.0) < 0.1),
        ),
    ]


def stick_ratios(table: Table) -> list[Statement]:
    """Figures 6.3e and f."""
    full, goodman, none = (table.where(coupling=name) for name in COUPLINGS)
    loading = [rows["stick_ratio_loading"] for rows in (full, goodman, none)]
    ordered = bool((loading[0] <= loading[1] + 0.005).all() and (loading[1] <= loading[2] + 0.005).all())
    closed = np.abs(none["stick_ratio_loading"] - np.sqrt(1.0 - none["force_ratio"])).max()
    apart = max(np.abs(rows["stick_ratio_reversal"] - none["stick_ratio_reversal"]).max() for rows in (full, goodman))
    equal = np.abs(none["stick_ratio_loading"] - none["stick_ratio_reversal"]).max()
    spread = max(
        np.ptp([table.where(coupling=name, base=base)["stick_ratio_reversal"] for base in table.values("base")], axis=0).max()
        for name in COUPLINGS
    )
    return [
        Statement(
            "6.4",
            "on first loading full coupling sticks least, the decoupled contact most",
            "-",
            f"Q~ = {near(full, 'force_ratio'):g}: {near(full, 'stick_ratio_loading'):.3f}, "
            f"{near(goodman, 'stick_ratio_loading'):.3f}, "
            f"{near(none, 'stick_ratio_loading'):.3f}",
            agreed(ordered),
        ),
        Statement(
            "6.4",
            "decoupled, the stick ratio is the same both ways",
            "-",
            f"differs by {equal:.3f}; from sqrt(1 - Q~) by {closed:.3f}",
            agreed(equal < 0.01),
        ),
        Statement(
            "6.4",
            "on reversal the stick ratios are nearly the same for all couplings",
            "-",
            f"differ by {apart:.3f} at most",
            agreed(apart < 0.04),
        ),
        Statement("6.4", "stick ratios do not depend on KR", "-", f"differ by {spread:.3f} at most", agreed(spread < 0.03)),
    ]


def near(table: Table, column: str, force_ratio: float = 0.65) -> float:
    """A value of the first body at the lateral force nearest to one."""
    rows = table.where(base=table.values("base")[0])
    return float(rows[column][np.abs(rows["force_ratio"] - force_ratio).argmin()])


def traction_errors(table: Table) -> list[Statement]:
    """Figures 6.3g and h."""
    goodman, none = table.where(coupling="goodman"), table.where(coupling="none")
    pressure = goodman["pressure_error_reversal"]
    shear, first = goodman["shear_error_reversal"], goodman["shear_error_loading"]
    last = goodman.where(force_ratio=0.99)
    free = none["shear_error_loading"]
    shift = float(np.abs(table.where(coupling="full", force_ratio=0.99)["patch_shift_loading"]).mean())
    return [
        Statement(
            "6.4",
            "the error of the pressure rises with the lateral force from 0 to 23 %",
            "0 to 23 %",
            percent(pressure),
            agreed(abs(pressure.max() - 0.23) < 0.02 and pressure.min() < 0.02, PARTLY),
            f"at Q~ = 0 it is not 0: {100 * pressure.min():.0f} % remain from the pressing, the narrower contact",
        ),
        Statement(
            "6.4",
            "the error of the shear of Goodman rises to 35 %, then falls to 20 %",
            "35, 20 %",
            f"{100 * shear.max():.0f} % ({100 * first.max():.0f} % on first loading), then "
            f"{100 * last['shear_error_reversal'].mean():.0f} %",
            agreed(abs(shear.max() - 0.35) < 0.02, PARTLY),
            "why 35 % is not known: 0.320 on meshes of 30 to 310 nodes in contact; over Goodman's own shear it would be 0.34",
        ),
        Statement(
            "6.4",
            "the error of the shear of full decoupling falls from 100 % to 20 %",
            "100 to 20 %",
            f"{100 * free.max():.0f} to {100 * free.min():.0f} %",
            agreed(abs(free.max() - 1) < 0.05 and free.min() < 0.25),
        ),
        Statement(
            "6.4",
            "at a high lateral force both errors are 20 %, since the contact shifts by 0.1a",
            "20 %, 0.1",
            f"{percent(np.concatenate([last['shear_error_reversal'], none.where(force_ratio=0.99)['shear_error_reversal']]))}"
            f", shift {shift:.3f}",
            agreed(shift > 0.08, PARTLY),
            f"an ellipse shifted by {shift:.3f} a differs from itself by {100 * shifted_ellipse(shift):.0f} %: the rest is its "
            "shape",
        ),
    ]


def shifted_ellipse(shift: float) -> float:
    """L1 difference of an ellipse and the same one shifted, in half-widths, over its area."""
    x = np.linspace(-1.5, 1.5, 30001)
    ellipse = [np.sqrt(np.maximum(0.0, 1.0 - (x - s) ** 2)) for s in (0.0, shift)]
    return float(np.abs(ellipse[1] - ellipse[0]).sum() / ellipse[0].sum())


# Section 6.5: over the coefficient of friction


def over_friction(table: Table) -> list[Statement]:
    """Figure 6.4."""
    fits = {}
    for name in COUPLINGS:
        rows = table.where(coupling=name, base=table.values("base")[-1])
        fits[name] = analysis.slope(rows["mu"], rows["dissipation_number"])
    full = table.where(coupling="full", base=table.values("base")[-1])
    _, local = analysis.local_slopes(full["mu"], full["dissipation_number"])
    spread = analysis.bodies_spread(table.where(coupling="full"), "dissipation_number", ["mu"], ("half_plane",))
    goodman, none = table.where(coupling="goodman"), table.where(coupling="none")
    apart = np.abs(goodman["shear_error_reversal"] - none["shear_error_reversal"]).max()
    rising = all(
        bool((np.diff(rows[name]) > 0.0).all())
        for _, rows in goodman.each("base")
        for name in ("pressure_error_reversal", "shear_error_reversal")
    )
    sticks = {moment: np.ptp(full[f"stick_ratio_{moment}"]) for moment in ("loading", "reversal")}
    return [
        Statement(
            "6.5",
            "without dimensions one curve, whatever KR, over mu too",
            "one curve",
            f"differs by {100 * spread:.2f} %",
            agreed(spread < 0.02),
        ),
        Statement(
            "6.5",
            "the slope of log D over log mu is 2 for all couplings",
            "2",
            ", ".join(f"{COUPLINGS[name]} {value:.3f}" for name, value in fits.items())
            + f"; with full coupling locally {span(local)}",
            agreed(max(abs(value - 2.0) for value in fits.values()) < 0.01, PARTLY),
            "exactly 2 without the effect of shear on pressure; with it D falls behind mu^2 as mu grows",
        ),
        Statement(
            "6.5",
            "both errors rise with mu, and the decoupling does not matter for them at Q~ = 0.99",
            "-",
            f"shear errors of the two differ by {100 * apart:.1f} % points at most; rising: {'yes' if rising else 'no'}",
            agreed(rising and apart < 0.02),
        ),
        Statement(
            "6.5",
            "at a constant Q~ = 0.99 mu matters little (for the stick ratio)",
            "-",
            f"full coupling, stick ratio changes by {sticks['loading']:.3f} on loading, {sticks['reversal']:.3f} on reversal",
            agreed(max(sticks.values()) < 0.05),
            "small at Q~ = 0.99, where nearly nothing sticks",
        ),
    ]


def five_forces(table: Table) -> list[Statement]:
    """Figure 6.5."""
    goodman, none = table.where(coupling="goodman"), table.where(coupling="none")
    ratios = goodman["dissipation_ratio"]
    high = [goodman.where(force_ratio=ratio)["dissipation_ratio"] for ratio in (0.99, 0.93)]
    rising = all(bool((np.diff(curve) > -1e-3).all()) for curve in high)
    low = goodman.where(force_ratio=0.5)
    least = float(low["mu"][low["dissipation_ratio"].argmin()])
    errors = {moment: goodman[f"shear_error_{moment}"].max() for moment in ("loading", "reversal")}
    free_low, free_high = (none.where(force_ratio=ratio)["shear_error_reversal"] for ratio in (0.3, 0.99))
    pressure = goodman["pressure_error_reversal"].reshape(len(goodman.values("force_ratio")), -1)
    return [
        Statement(
            "6.5",
            "the over-prediction rises with mu at Q~ = 0.99 and 0.93",
            "-",
            f"{span(high[0])} and {span(high[1])}",
            agreed(rising),
        ),
        Statement(
            "6.5",
            "at low Q~ it is concave up",
            "-",
            f"Q~ = 0.5: least at mu = {least:.2f}, {span(low['dissipation_ratio'])}",
            agreed(0.05 < least < 1.0),
        ),
        Statement(
            "6.5",
            "D_Goodman/D_full is from 1.14 to 1.30 for the five lateral forces",
            "1.14 to 1.30",
            span(ratios, ".3f"),
            agreed(abs(ratios.min() - 1.14) < 0.02 and abs(ratios.max() - 1.30) < 0.04),
            "the lowest is at mu = 0.05, Q~ = 0.99",
        ),
        Statement(
            "6.4, 6.5",
            "20 % to 50 % there, 14 % to 30 % here: a contradiction?",
            "-",
            f"mu = 0.7: {span(goodman.where(mu=nearest(goodman, 'mu', 0.7))['dissipation_ratio'])} for Q~ from 0.3 on; all mu: "
            f"{span(ratios)}",
            agreed(ratios.argmin() in high_force_low_friction(goodman)),
            "none: 14 % is at small mu and high Q~, 50 % at mu = 0.7 and Q~ = 0.07, which the five forces leave out",
        ),
        Statement(
            "6.5",
            "errors of the pressure rise with mu and with Q~",
            "-",
            f"{percent(pressure)}",
            agreed(bool((np.diff(pressure, axis=0) > -2e-3).all() and (np.diff(pressure, axis=1) > -1e-3).all()), PARTLY),
            "with mu always; over Q~ not below mu = 0.2, where it hardly changes",
        ),
        Statement(
            "6.5",
            "the error of the shear of Goodman rises with mu to 35 %",
            "35 %",
            f"{100 * errors['loading']:.0f} % on loading, {100 * errors['reversal']:.0f} % on reversal",
            agreed(max(abs(error - 0.35) for error in errors.values()) < 0.025, PARTLY),
            "on first loading; more in the steady state",
        ),
        Statement(
            "6.5",
            "that of full decoupling falls with mu for low Q~ and rises for high Q~",
            "-",
            f"Q~ = 0.3: {100 * free_low[0]:.0f} to {100 * free_low[-1]:.0f} %; 0.99: {100 * free_high[0]:.0f} to "
            f"{100 * free_high[-1]:.0f} %",
            agreed(free_low[0] > free_low[-1] and free_high[0] < free_high[-1]),
        ),
    ]


def high_force_low_friction(table: Table) -> np.ndarray:
    """Rows near gross sliding with a coefficient of friction of the lower half."""
    return np.flatnonzero((table["force_ratio"] > 0.9) & (table["mu"] < np.median(table["mu"])))


def nearest(table: Table, column: str, value: float) -> float:
    """The value of a column nearest to one."""
    entries = np.array(table.values(column))
    return float(entries[np.abs(entries - value).argmin()])


# Sections 6.1, 6.6 and beyond


def dependence_on_history(table: Table) -> list[Statement]:
    """Shakedown."""
    spread = {}
    for coupling in COUPLINGS:
        rows = table.where(coupling=coupling).between("force_ratio", 0.1, 1.0)
        spread[coupling] = [analysis.bodies_spread(part, "dissipation_number", ["force_ratio"]) for _, part in rows.each("beta")]
    strong = table.where(coupling="full", force_ratio=table["force_ratio"].min(), beta=0.5)
    nothing = float(np.abs(strong["dissipation_number"]).max())
    plain = table.where(coupling="none", force_ratio=table["force_ratio"].min(), beta=0.5)["dissipation_number"].max()
    return [
        Statement(
            "6.1",
            "coupling is required to have a shakedown; tested here: does the steady state depend on what went before?",
            "-",
            "steady dissipation over five beginnings differs by "
            + "; ".join(
                f"{COUPLINGS[name]} {max(values):.0e}"
                if max(values) < 1e-3
                else f"{COUPLINGS[name]} {100 * values[0]:.0f} % (beta = 0.286), {100 * values[1]:.0f} % (0.5) of its mean"
                for name, values in spread.items()
            ),
            agreed(min(spread["full"]) > 0.05 and max(spread["goodman"] + spread["none"]) < 1e-6),
            "of five beginnings under a constant normal force only the effect of shear on pressure leaves a trace: the verdict "
            "is on that. Shakedown as such, slip that ceases, is another matter: see the flat punch",
        ),
        Statement(
            "6.1",
            "rounded bodies, beta = 0.5, mu = 0.7: a small cyclic force ends without slip",
            "-",
            f"Q~ = {strong['force_ratio'][0]:g}: D/(P^2 A) at most {nothing:.0e}, decoupled {plain:.0e}",
            BEYOND if nothing < 1e-4 * plain else DIFFERS,
        ),
    ]


def flat_punch() -> Statement:
    """Slip that ceases without an effect of shear on pressure."""
    text = (CASES / "flat_punch.nml").read_text(encoding="utf-8")
    cycles = {name: cycle_dissipations(mfv.run(text=text.replace("'goodman'", f"'{name}'"))) for name in COUPLINGS}
    later = max(np.abs(cycles[name][1:]).max() / cycles[name][0] for name in ("full", "goodman"))
    first = {
        COUPLINGS[name]: 0.0 if abs(energies[0]) < 1e-12 * cycles["full"][0] else energies[0] for name, energies in cycles.items()
    }
    return Statement(
        "6.1",
        "flat punch, mu = 0.3, Q = 0.5 mu P: does slip cease (shakedown) under Goodman's approximation too?",
        "-",
        "dissipation of the first cycle, J/m: "
        + ", ".join(f"{name} {energy:.3g}" for name, energy in first.items())
        + f"; of each later one at most {later:.0e} of that",
        BEYOND,
        "it does: the shear of the pressing is redistributed once. Where shear does not change the pressure the frictional "
        "Melan theorem holds (Klarbring, Ciavarella, Barber 2007)",
    )


def cycle_dissipations(result: mfv.Result) -> np.ndarray:
    """Of each cycle from the first arrival at Q on."""
    history = result.history
    return np.diff(history.dissipation[history.event_kind == mfv.EventKind.STEP_END][1::2])


def shapes_alone(table: Table) -> Statement:
    """Bodies of one material and two shapes."""
    goodman, none = (table.where(coupling=name) for name in ("goodman", "none"))
    wide = float(table["contact_half_width"].max()) / 4.0
    over = np.abs(goodman["dissipation_ratio"] - 1.0).max()
    shear = [100.0 * part["shear_error_reversal"].max() for part in (goodman, none)]
    return Statement(
        "6.1",
        "coupling by materials matters more than coupling by shapes (Flicek et al.)",
        "-",
        f"one material, two shapes, contacts up to a = {wide:.2f} R: dissipation to {100 * over:.1f} %, shear of Goodman to "
        f"{shear[0]:.0f} %; decoupled to {shear[1]:.0f} % at small Q~",
        agreed(over < 0.01),
        "the shear of the pressing is what is lacking then",
    )


def beyond(tables: Mapping[str, Table]) -> list[Statement]:
    """What the text does not say."""
    rows = tables["mindlin"].between("force_ratio", 0.2, 1.0)
    finest = rows.where(nodes_of_mesh=rows["nodes_of_mesh"].max())
    error = np.abs(finest["dissipation_number"] / analysis.mindlin_number(finest["force_ratio"]) - 1.0).max()
    full = tables["mismatch"].where(coupling="full")
    even = max(
        np.abs(curve["dissipation_number"] / curve["dissipation_number"][::-1] - 1.0).max() for _, curve in full.each("force_ratio")
    )
    odd = max(
        np.abs(curve["patch_shift_return"] + curve["patch_shift_return"][::-1]).max() for _, curve in full.each("force_ratio")
    )
    goodman = tables["map"].where(coupling="goodman")
    rule = analysis.fitted_rule(tables["map"])
    part = goodman.where(force_ratio=nearest(goodman, "force_ratio", 0.95))
    excess = np.log(part["dissipation_ratio"])
    scatter = analysis.scatter_about(part["beta"] * part["mu"], excess), analysis.scatter_about(part["beta"], excess)
    c0, c1 = rule.coefficients
    found = {key: here for key, here in analysis.thresholds(tables["threshold"]).items() if here.resolved}
    parts = np.array([here.patch_shift / analysis.edge_scale(*key) for key, here in found.items()])
    limits = np.array([here.force_ratio for here in found.values()])
    strong = [
        goodman.where(force_ratio=0.99).between("mu", 0.2, 1.0),
        tables["map"].where(coupling="full", force_ratio=0.99),
    ]
    strong[1] = strong[1].between("mu", 0.2, 1.0)
    product = strong[0]["beta"] * strong[0]["mu"]
    of_shear = goodman.between("mu", 0.2, 1.0).between("beta", 0.1, 0.5)
    traction_error, traction_product = of_shear["shear_error_reversal"], of_shear["beta"] * of_shear["mu"]
    over = goodman["dissipation_ratio"] - 1.0
    weak = goodman.where(force_ratio=goodman["force_ratio"].min()).between("mu", 0.2, 1.0).between("beta", 0.1, 0.5)
    meant = goodman.between("beta", 0.0, rule.beta_limit).between("force_ratio", rule.ratio_limit, 1.0)
    strong_mismatch, weak_mismatch = meant.between("beta", 0.2, 1.0), meant.between("beta", 0.0, 0.15)
    per_square = np.log(meant["dissipation_ratio"]) / meant["beta"] ** 2
    return [
        Statement(
            "beyond",
            "below which lateral force does nothing slip with full coupling?",
            "-",
            f"Q~ = {span(limits, '.3f')} in {len(found)} pairs of beta and mu that the mesh resolves; there the contact shifts "
            f"by {span(parts, '.1f')} times 2a exp(-arccot(mu)/epsilon)"
            if found
            else "not within the forces taken",
            BEYOND,
            "so that no power law holds at small forces: for beta = 0.286, mu = 0.7 the same 2.5 times "
            f"give a shift of {2.5 * analysis.edge_scale(2 / 7, 0.7):.0e} a, Q~ of some 0.001, for which no mesh "
            "here is fine enough",
        ),
        Statement(
            "eq. 6.4",
            "closed form of the dissipation of two disks that are alike",
            "-",
            f"differs by {100 * error:.2f} % at most, Q~ from 0.2 on, {finest['nodes_of_mesh'][0]} nodes",
            agreed(error < 0.01),
            "with the integrand corrected (docs/verification.md)",
        ),
        Statement(
            "6.6",
            "the decouplings almost always over-predict the dissipation",
            "-",
            f"more than full coupling in {np.count_nonzero(over > 0.0)} of {len(over)} cases of the map, from "
            f"{100 * over.min():.1f} % on",
            AGREES if (over > 0.0).all() else agreed(bool(np.mean(over > 0.0) > 0.9), PARTLY),
            "without limit where nothing slips",
        ),
        Statement(
            "beyond",
            "two disks of one radius: dissipation even in beta, patch shift odd",
            "-",
            f"to {even:.0e} and {odd:.0e}",
            BEYOND,
        ),
        Statement(
            "beyond",
            "is beta mu the one parameter of Goodman's error?",
            "-",
            f"no: about a curve over beta mu the scatter is {100 * scatter[0]:.0f} % of the spread, over beta "
            f"{100 * scatter[1]:.0f} %",
            BEYOND,
        ),
        Statement(
            "beyond",
            "what tells the errors of the tractions?",
            "-",
            f"beta mu: near gross sliding the error of the pressure is "
            f"{span(strong[0]['pressure_error_reversal'] / product)} beta mu, "
            f"that of the shear {span(strong[0]['shear_error_reversal'] / product)} beta mu, the shift of the contact "
            f"{span(np.abs(strong[1]['patch_shift_reversal']) / product)} beta mu half-widths (mu from 0.2 on). "
            f"At Q~ = {weak['force_ratio'].min():g} the error of the pressure is "
            f"{span(weak['pressure_error_reversal'] / (weak['beta'] * weak['mu']))} beta mu, or "
            f"{span(weak['pressure_error_reversal'] / weak['beta'] ** 2)} beta^2 (beta from 0.1 on); shear, all Q~: "
            f"{span(traction_error / traction_product)} beta mu",
            BEYOND,
            "the pressure starts from an error of the pressing, which beta mu does not tell",
        ),
        Statement(
            "beyond",
            "rule of thumb",
            "-",
            f"ln(D_Goodman/D_full) = beta^2 ({c0:.2f} + {c1:.2f} mu^2), |beta| <= {rule.beta_limit:g}, "
            f"Q~ >= {rule.ratio_limit:g}, to {rule.largest_miss:.3f}; of that logarithm it misses "
            f"{percent(rule.misses(strong_mismatch))} from beta = 0.2 on, {percent(rule.misses(weak_mismatch))} below. "
            f"The logarithm is {span(per_square)} beta^2",
            BEYOND,
            "below beta = 0.2 the rule is no correction: it may miss more than there is",
        ),
    ]


def fine_map(coarse: Table, fine: Table) -> Statement:
    """What the mesh of the map leaves open where few nodes slip."""
    rows = fine.where(coupling="goodman", mu=nearest(fine, "mu", 0.3))
    force = float(rows["force_ratio"][0])
    same = coarse.where(coupling="goodman", mu=rows["mu"][0], force_ratio=nearest(coarse, "force_ratio", force))
    listed = [
        f"beta = {beta:g}: {100 * (one - 1):.1f} and {100 * (two - 1):.1f} %"
        for beta, one, two in zip(rows["beta"], same["dissipation_ratio"], rows["dissipation_ratio"])
    ]
    return Statement(
        "beyond",
        f"over-prediction at Q~ = {force:g}, mu = {rows['mu'][0]:g}, on the mesh of the map and on a fine one",
        "-",
        f"{same['nodes'].max()} and {rows['nodes'].max()} nodes: " + "; ".join(listed),
        BEYOND,
        "the coarse one is not fine enough there below beta = 0.2; the picture has the fine one",
    )


def all_statements(tables: Mapping[str, Table], results: Mapping[str, mfv.Result], quick: bool) -> list[Statement]:
    """In the order of the text. The remarks are on the whole study: a quick one is without them."""
    statements = [
        shapes_alone(tables["shapes"]),
        *dependence_on_history(tables["shakedown"]),
        flat_punch(),
        *pressing(results),
        *cycling(results),
        *loops(tables["cyclic"], results),
        *dissipation_over_force(tables["lateral_force"], tables["small_force"]),
        *stick_ratios(tables["lateral_force"]),
        *traction_errors(tables["lateral_force"]),
        *over_friction(tables["friction"]),
        *five_forces(tables["ratios"]),
        *beyond(tables),
    ]
    if not quick:
        statements.append(fine_map(tables["map"], tables["map_fine"]))
    return [replace(statement, why="") for statement in statements] if quick else statements
