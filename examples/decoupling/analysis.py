"""Numbers that are drawn from the tables: slopes, errors against closed forms, the rule of thumb."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from sweeps import Table

import mfv

#: The cases of equal disks: P in N/m, relative radius in m, mu, compliance A = sum (kappa + 1)/(4 G) in m^2/N.
NORMAL_FORCE, RADIUS, MU, COMPLIANCE = 1.6726e8, 2.0, 0.7, 0.7 / 77e9


def slope(x: np.ndarray, y: np.ndarray) -> float:
    """Slope of a straight line through log y over log x."""
    return float(np.polyfit(np.log(x), np.log(y), 1)[0])


def local_slopes(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Slopes of log y over log x between points, and their positions."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.sqrt(x[1:] * x[:-1]), np.diff(np.log(np.maximum(y, 0.0))) / np.diff(np.log(x))


def mindlin_number(force_ratio: np.ndarray) -> np.ndarray:
    """Dissipation of a cycle over P^2 A by Cattaneo and Mindlin (eq. 6.4, corrected), mu = 0.7."""
    half_width = np.sqrt(2.0 * NORMAL_FORCE * COMPLIANCE * RADIUS / np.pi)
    energy = mfv.reference.mindlin_dissipation(force_ratio * MU * NORMAL_FORCE, NORMAL_FORCE, half_width, RADIUS, MU)
    return np.asarray(energy) / (NORMAL_FORCE**2 * COMPLIANCE)


def edge_scale(beta: float, mu: float) -> float:
    """Distance from the edge, over the half-width, within which a stuck contact carries more than 1/mu of pressure for a shear.

    Increments at a stuck edge are K r^(-1/2 + i epsilon), 2 pi epsilon = ln((1 + beta)/(1 - beta)) (Muskhelishvili's bonded
    punch, Johnson 1985, section 2.8): under a lateral force alone pressure over shear is tan(epsilon ln(2a/r)), which comes to
    1/mu at the distance given.
    """
    epsilon = np.log((1.0 + beta) / (1.0 - beta)) / (2.0 * np.pi)
    return float(2.0 * np.exp(-np.arctan(1.0 / mu) / epsilon))


@dataclass
class Threshold:
    """Onset of slip: lateral force ratio, shift of the contact over its half-width, and whether the mesh resolves it."""

    force_ratio: float
    patch_shift: float
    resolved: bool


def threshold(rows: Table, mu: float, part: float = 1e-3) -> Threshold | None:
    """Force at which the dissipation crosses a fraction of the decoupled one; None if it is not in the table."""
    decoupled = mindlin_number(rows["force_ratio"]) * (mu / MU) ** 2
    ratio = np.log(np.maximum(rows["dissipation_number"] / decoupled, 1e-6))
    above = np.flatnonzero(ratio > np.log(part))
    if above.size == 0 or above[0] == 0:
        return None
    place = slice(above[0] - 1, above[0] + 1)
    force = np.interp(np.log(part), ratio[place], np.log(rows["force_ratio"][place]))
    shift = np.interp(force, np.log(rows["force_ratio"][place]), np.abs(rows["patch_shift_return"][place]))
    interval = 2.0 * rows["mesh%half_width"][0] / rows["mesh%nodes"][0] / rows["contact_half_width"][0]
    return Threshold(float(np.exp(force)), float(shift), bool(edge_scale(rows["beta"][0], mu) > 2.0 * interval))


def thresholds(table: Table) -> dict[tuple[float, float], Threshold]:
    """Those of a table, by beta and mu."""
    found = {}
    for beta, rows in table.each("beta"):
        for mu, curve in rows.each("mu"):
            here = threshold(curve, mu)
            if here is not None:
                found[beta, mu] = here
    return found


def bodies_spread(table: Table, column: str, keys: list[str], leave_out: tuple[str, ...] = ()) -> float:
    """Largest difference of a column between bodies, over its mean over them, among rows that are the same otherwise."""
    bases = [base for base in table.values("base") if not any(name in base for name in leave_out)]
    curves = [table.where(base=base) for base in bases]
    for curve in curves[1:]:
        if any(not np.array_equal(curve[key], curves[0][key]) for key in keys):
            raise ValueError(f"{table.values('base')}: the bodies have other rows")
    values = np.array([curve[column] for curve in curves])
    return float(np.nanmax(np.ptp(values, axis=0) / np.abs(values.mean(axis=0))))


@dataclass
class Rule:
    """ln(D_Goodman/D_full) = beta^2 (c0 + c1 mu^2), fitted in its range of validity."""

    coefficients: np.ndarray
    beta_limit: float
    ratio_limit: float
    largest_miss: float

    def ratio(self, beta: np.ndarray, mu: np.ndarray) -> np.ndarray:
        """D_Goodman/D_full by the rule."""
        return np.asarray(np.exp(terms(beta, mu) @ self.coefficients))

    def misses(self, rows: Table) -> np.ndarray:
        """Relative error of the fit of ln(D_Goodman/D_full)."""
        return np.asarray(terms(rows["beta"], rows["mu"]) @ self.coefficients / np.log(rows["dissipation_ratio"]) - 1.0)


def terms(beta: np.ndarray, mu: np.ndarray) -> np.ndarray:
    """The terms of the rule, a column each."""
    square = np.asarray(beta) ** 2
    return np.stack([square, square * np.asarray(mu) ** 2], axis=-1)


def fitted_rule(table: Table, beta_limit: float = 0.3, ratio_limit: float = 0.5) -> Rule:
    """The rule of thumb from the map, with the largest difference from it in ln(D_Goodman/D_full)."""
    rows = table.where(coupling="goodman").between("beta", 0.0, beta_limit).between("force_ratio", ratio_limit, 1.0)
    matrix = terms(rows["beta"], rows["mu"])
    measured = np.log(rows["dissipation_ratio"])
    coefficients = np.linalg.lstsq(matrix, measured, rcond=None)[0]
    return Rule(coefficients, beta_limit, ratio_limit, float(np.abs(matrix @ coefficients - measured).max()))


def scatter_about(x: np.ndarray, y: np.ndarray, degree: int = 3) -> float:
    """Root mean square of y about its best polynomial in x, over the spread of y: 0 if y is a function of x, 1 if not."""
    fit = np.polyval(np.polyfit(x, y, degree), x)
    return float(np.sqrt(np.mean((y - fit) ** 2)) / np.std(y))
