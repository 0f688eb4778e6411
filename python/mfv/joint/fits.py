"""Fits of joint models to a backbone and to cycles."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._packages import needed
from .backbone import Backbone
from .measurement import Measurement
from .models import BoucWen, Iwan, Segalman, gauss_pair, number_of_cells

Array = NDArray[np.float64]

#: Cells of `iwan` begin at this part of the force at the end of the backbone.
LEAST = 0.01


def table(backbone: Backbone) -> Iwan:
    """The element that has the backbone exactly, linear between its points and beyond the last: a slider at every bend.

    With the points u_i and the slopes k_i up to them, the slider at u_i has the stiffness k_i - k_(i+1). A stiffness
    that increases by less than 1e-6 of the first one, as round-off can cause, counts as constant. Raises ValueError if it increases
    by more (use `Backbone.concave`, or `Masing`), or is constant everywhere, or if the backbone is in doubt.
    """
    slopes = backbone.trusted().stiffness
    drops = -np.diff(slopes)
    bends = drops > 1.0e-9 * slopes[0]
    rises = drops < -1.0e-6 * slopes[0]
    if np.any(rises):
        where = int(np.flatnonzero(rises)[0]) + 1
        raise ValueError(
            f"the stiffness increases at the displacement {backbone.displacement[where]:.6g}, from {slopes[where - 1]:.6g} to "
            f"{slopes[where]:.6g}: no springs and sliders in parallel have this backbone; use backbone.concave(), or Masing"
        )
    if not np.any(bends):
        raise ValueError("no slip: the stiffness of the backbone is constant, so there are no sliders; load it by a larger force")
    last = float(slopes[-1])
    return Iwan(drops[bends], backbone.displacement[1:-1][bends], last if last > 1.0e-9 * slopes[0] else 0.0)


def iwan(backbone: Backbone, cells: int | ArrayLike = 10) -> Iwan:
    """A parallel-series Iwan model with few sliders: two for each cell of the slider distribution of the concave backbone.

    The distribution is minus the second derivative of the backbone (Iwan 1966), at a measured one a slider at every bend. The two of a
    cell are the Gauss quadrature of it, so that force, stiffness and dissipation are those of the table at the edges of the cells,
    and no stiffness is negative. `cells`: their number, or their edges [length], increasing, such as the amplitudes that matter.
    Raises ValueError.
    """
    hull = backbone.concave()
    fine = table(hull)
    if np.ndim(cells) == 0:
        edges = _edges(hull, number_of_cells(cells))
    else:
        edges = np.asarray(cells, dtype=np.float64)
        if edges.ndim != 1 or not np.all(edges > 0.0) or not np.all(edges[1:] > edges[:-1]):
            raise ValueError("cells must be a number of them, or their edges: positive numbers that increase")
    pieces = []
    for members in np.split(np.arange(fine.slip.size), np.searchsorted(fine.slip, edges, side="right")):
        if members.size:
            pieces.append(gauss_pair(fine.slip[members], fine.stiffness[members]))
    slip, stiffness = (np.concatenate(values) for values in zip(*pieces))
    return Iwan(stiffness, slip, fine.elastic)


def _edges(backbone: Backbone, cells: int) -> Array:
    """Displacements that divide a backbone into cells, equally spaced in ln(Q/(F - Q)) between LEAST and 1 - LEAST of the force F at
    the end: small cells both at small forces and near sliding."""
    end = np.log(1.0 / LEAST - 1.0)
    forces = backbone.force[-1] / (1.0 + np.exp(np.linspace(end, -end, cells + 1)[1:-1]))
    return np.asarray(np.interp(forces, backbone.force, backbone.displacement))


def segalman(measured: Measurement) -> Segalman:
    """Segalman's four parameters: F_S and K_T of the backbone (its end and its beginning), chi and beta by least squares.

    The squares are of the logarithms of dissipation and secant stiffness, model over cycle, at the amplitudes of the cycles.
    Needs scipy. Raises ValueError, also if the backbone is in doubt.
    """
    amplitude, force, energy = _cycles(measured)
    start = float(np.polyfit(np.log(amplitude), np.log(energy), 1)[0]) - 3.0

    def model(unknowns: Array) -> Segalman:
        return Segalman(measured.sliding_force, float(measured.backbone.stiffness[0]), float(unknowns[0]), float(unknowns[1]))

    def misfit(unknowns: Array) -> Array:
        fitted = model(unknowns)
        return np.append(np.log(fitted.dissipation(amplitude) / energy), np.log(fitted.force(amplitude) / force))

    return model(_least_squares(misfit, [np.clip(start, -0.9, 2.0), 0.5], [-0.99, 0.0], [10.0, 1.0e3]))


def bouc_wen(measured: Measurement) -> BoucWen:
    """All five parameters of Bouc and Wen's model, thermodynamically admissible, by least squares of the same logarithms as
    `segalman`. Needs scipy. Raises ValueError."""
    amplitude, force, energy = _cycles(measured)

    def model(unknowns: Array) -> BoucWen:
        stiffness, sliding_force, exponent, elastic = (float(value) for value in np.exp(unknowns[:4]))
        return BoucWen(stiffness, sliding_force, exponent, float(unknowns[4]), elastic)

    def misfit(unknowns: Array) -> Array:
        at, reached, lost = np.log(np.maximum(np.array(model(unknowns).cycles())[:, 1:], np.finfo(float).tiny))
        u = np.log(amplitude)
        return np.append(np.interp(u, at, lost) - np.log(energy), np.interp(u, at, reached) - np.log(force))

    k, f = np.log(measured.backbone.stiffness[0]), np.log(measured.sliding_force)
    bounds = [k - 5.0, f - 5.0, np.log(0.1), k - 20.0, 0.5], [k + 5.0, f + 5.0, np.log(20.0), k + 1.0, 10.0]
    return model(_least_squares(misfit, [k, f, 0.0, k - 3.0, 0.6], *bounds))


def _cycles(measured: Measurement) -> tuple[Array, Array, Array]:
    """Displacement amplitudes, force amplitudes and dissipations. Raises ValueError if no cycle dissipates or the backbone is in
    doubt."""
    measured.backbone.trusted()
    cycles = [cycle for cycle in measured.cycles if cycle.slips]
    if len(cycles) < 2:
        raise ValueError("the fit needs two or more cycles that dissipate")
    columns = ((cycle.amplitude, cycle.force_amplitude, cycle.dissipation) for cycle in cycles)
    amplitude, force, energy = np.array(list(zip(*columns)))
    return amplitude, force, energy


def _least_squares(misfit: Callable[[Array], Array], start: Any, low: Any, high: Any) -> Array:
    """The unknowns of least squares. Raises ModuleNotFoundError without scipy, ValueError if they are not found."""
    found = needed("scipy.optimize").least_squares(misfit, start, bounds=(low, high))
    if not found.success:
        raise ValueError(f"the fit did not converge: {found.message}")
    return np.asarray(found.x)
